// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith {

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

}  // namespace tofsmith
