// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/waveforms/upload_script.hpp"
#include "tofsmith/waveforms/waveform_export.hpp"

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

/// Levels of the DAC of a 33500 or 33600, -32767 to 32767.
inline constexpr std::int32_t keysight_levels = 65535;

/// Returns an .arb file for a 33500 or 33600.
/// @param end_of_line  "\n" or "\r\n"
/// @throws std::invalid_argument if the waveform is invalid or does not have `keysight_levels`
std::string keysight_arb_text(const QuantizedWaveform& waveform,
                              std::string_view end_of_line = "\n");
/// Points for DATA:ARB:DAC: big-endian 16-bit numbers (the default of FORM:BORD).
/// @throws std::invalid_argument as keysight_arb_text()
std::vector<std::byte> keysight_dac_bytes(const QuantizedWaveform& waveform);

/// Header of an EasyWave CSV; sources disagree, see docs/formats.md.
enum class EasyWaveDialect {
  easywave,  ///< "data length", empty lines, rows counted from 1
  lenth,     ///< "data lenth", empty lines, rows by time [s]
  commas,    ///< "data length", lines with one comma, rows by time [s]
};

/// Returns five header lines, seven blank lines, "xpos,value", one row per point, CRLF.
/// @throws std::invalid_argument if the waveform is invalid
std::string easywave_csv(const QuantizedWaveform& waveform,
                         EasyWaveDialect dialect = EasyWaveDialect::easywave);
enum class WvdtPoints {
  bits14_little_endian,  ///< SDG800 to SDG5000: 14-bit two's complement, low byte first
  bits14_big_endian,     ///< high byte first
  bits16_little_endian,  ///< X series: 16-bit two's complement, low byte first
};

/// Settings and points of a WVDT command.
struct WvdtCommand {
  int channel = 1;            ///< >= 1
  std::string slot;           ///< "M50" for older generators; empty for the X series
  std::string name;           ///< letters, digits and _
  double frequency_hz = 0.0;  ///< repetition rate of the whole table
  double amplitude_vpp = 0.0;
  double offset_v = 0.0;
  double phase_deg = 0.0;
  std::vector<std::int16_t> points;  ///< in [-2^(bits - 1), 2^(bits - 1) - 1]
};

/// Requires 2^14 or 2^16 levels.
/// @throws std::invalid_argument if the waveform is invalid or has a different number of levels
WvdtCommand wvdt_command(const QuantizedWaveform& waveform, WvdtPoints points, int channel = 1);
/// Returns the text up to "WAVEDATA,", then the points, without block header or line end.
/// @throws std::invalid_argument if name, channel or points break a rule
std::vector<std::byte> wvdt_bytes(const WvdtCommand& command, WvdtPoints points);

/// 0 to 16382. (Some sources use 16383: docs/formats.md.)
inline constexpr std::int32_t tektronix_afg_levels = 16383;
inline constexpr std::int32_t tektronix_afg_full_levels = 16384;

/// Returns a .tfw file for AFG1000 to AFG31000: a header of 512 bytes with a preview, then the
/// points, without frequency and voltages.
/// @throws std::invalid_argument if the waveform is invalid or has more than 2^14 levels
std::vector<std::byte> tektronix_tfw(const QuantizedWaveform& waveform);
/// Returns a .wfm file ("MAGIC 1000") for AWG400 to AWG700, AWG5000 and AWG7000: points as
/// little-endian floats with a byte of markers. Marker 1 is the trigger of every period, marker 2
/// the first point.
/// @param end_of_line  "\r\n", "\n" or " \r\n"; sources disagree
/// @throws std::invalid_argument if the waveform is invalid
std::vector<std::byte> tektronix_wfm(const QuantizedWaveform& waveform,
                                     std::string_view end_of_line = "\r\n");

}  // namespace tofsmith
