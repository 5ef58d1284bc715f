// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/instrument/upload.hpp"

namespace tofsmith {

/// The families' words, for a request that fits.
std::vector<UploadStep> siglent_steps(const GeneratorModel& model, const UploadRequest& request);
std::vector<UploadStep> keysight_steps(const UploadRequest& request);
std::vector<UploadStep> tektronix_steps(const UploadRequest& request);
/// Messages that switch outputs off.
std::vector<std::string> siglent_outputs_off(const UploadRequest& request);
std::vector<std::string> scpi_outputs_off(const UploadRequest& request);

/// A message without answer.
UploadStep message_step(std::string what, std::string message);
/// The same, which switches an output on.
UploadStep output_on(std::string message);
/// A question and its answer's checks.
UploadStep asked(std::string what, std::string message, std::vector<AnswerCheck> checks);

AnswerCheck number_check(int channel, std::string quantity, std::string field, double wanted,
                         double tolerance);
AnswerCheck word_check(int channel, std::string quantity, std::string field,
                       std::vector<std::string> texts, bool within = false);

/// Steps that set and check one channel, added to a script.
class ChannelSteps {
 public:
  ChannelSteps(std::vector<UploadStep>& steps, int channel) : steps_(steps), channel_(channel) {}
  void set(std::string_view what, std::string message);
  void ask(std::string message, std::vector<AnswerCheck> checks);

 private:
  std::vector<UploadStep>& steps_;
  int channel_;
};

/// Where scripts in plain SCPI (Keysight, Tektronix) begin: outputs off, reset.
void begin_scpi(std::vector<UploadStep>& steps, const UploadRequest& request);
/// Where they end: outputs still off; then on, if they shall be.
void end_scpi(std::vector<UploadStep>& steps, const UploadRequest& request);
/// A load as SCPI prints it [ohm]: infinity is 9.9e37.
double scpi_load_ohm(double load_ohm);

std::string text_of(std::span<const std::byte> bytes);

/// How far a frequency that an instrument reads back may be from the one requested [Hz].
double frequency_tolerance_hz(double frequency_hz, double relative);
inline constexpr double scpi_frequency_tolerance = 1e-6;  ///< relative; Keysight and Tektronix
inline constexpr double volt_tolerance_v = 1e-3;

/// A name in the generator's memory that no other points have: "M1_1F3A77C2".
std::string memory_name(const QuantizedWaveform& waveform);

/// Compares points with what was meant: "" or the first that differs.
template <typename Found, typename Wanted>
std::string points_problem(const Found& found, const Wanted& wanted);
std::string point_count_problem(std::size_t found, std::size_t wanted);
std::string point_problem(std::size_t index, long found, long wanted);

template <typename Found, typename Wanted>
std::string points_problem(const Found& found, const Wanted& wanted) {
  if (found.size() != wanted.size()) return point_count_problem(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    if (found[i] != wanted[i]) return point_problem(i, found[i], wanted[i]);
  return "";
}

}  // namespace tofsmith
