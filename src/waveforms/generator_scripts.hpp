// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/waveforms/upload_script.hpp"

namespace tofsmith {

/// '#', number of digits, length, data (IEEE 488.2).
/// @throws std::invalid_argument beyond 999999999 bytes
std::vector<std::byte> ieee488_block(std::span<const std::byte> data);

/// Steps for a request that fits the model.
std::vector<UploadStep> siglent_steps(const GeneratorModel& model, const UploadRequest& request);
std::vector<UploadStep> keysight_steps(const UploadRequest& request);
std::vector<UploadStep> tektronix_steps(const UploadRequest& request);
std::vector<std::string> siglent_outputs_off(const UploadRequest& request);
std::vector<std::string> scpi_outputs_off(const UploadRequest& request);

std::string script_heading(const GeneratorModel& model, const std::vector<std::string>& names);
std::string script_messages(const UploadScript& script);

UploadStep message_step(std::string what, std::string message);
UploadStep output_on(std::string message);
UploadStep asked(std::string what, std::string message, std::vector<AnswerCheck> checks);

AnswerCheck number_check(int channel, std::string quantity, std::string field, double wanted,
                         double tolerance);
AnswerCheck word_check(int channel, std::string quantity, std::string field,
                       std::vector<std::string> texts, bool within = false);

/// Appends steps that set and check one channel.
class ChannelSteps {
 public:
  ChannelSteps(std::vector<UploadStep>& steps, int channel) : steps_(steps), channel_(channel) {}
  void set(std::string_view what, std::string message);
  void ask(std::string message, std::vector<AnswerCheck> checks);

 private:
  std::vector<UploadStep>& steps_;
  int channel_;
};

/// Standard SCPI (Keysight, Tektronix): outputs off, reset.
void begin_scpi(std::vector<UploadStep>& steps, const UploadRequest& request);
/// Checks that outputs are off; switches them on if requested.
void end_scpi(std::vector<UploadStep>& steps, const UploadRequest& request);
/// Infinity is 9.9e37 [ohm].
double scpi_load_ohm(double load_ohm);

std::string text_of(std::span<const std::byte> bytes);
std::string upper(std::string text);
/// Lower-case hexadecimal digits, as from `sha256sum`.
std::string sha256_hex(std::span<const std::byte> bytes);

/// Tolerance of a frequency that was read back [Hz].
double frequency_tolerance_hz(double frequency_hz, double relative);
inline constexpr double scpi_frequency_tolerance = 1e-6;  ///< relative; Keysight and Tektronix
inline constexpr double volt_tolerance_v = 1e-3;

/// Depends on the points: "M1_1F3A77C2".
std::string memory_name(const QuantizedWaveform& waveform);

}  // namespace tofsmith
