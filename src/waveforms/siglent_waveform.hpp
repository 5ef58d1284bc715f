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

/// How the header of an EasyWave CSV is spelled; sources disagree, see docs/formats.md.
enum class EasyWaveDialect {
  easywave,  ///< "data length", empty lines, rows counted from 1
  lenth,     ///< "data lenth", empty lines, rows by time [s]
  commas,    ///< "data length", lines of one comma, rows by time [s]
};

/// The CSV that EasyWave and the generators of Siglent's SDG series load: five lines of header,
/// seven blank lines, "xpos,value", one row per point, CRLF.
/// @throws std::invalid_argument if the waveform is invalid
std::string easywave_csv(const QuantizedWaveform& waveform,
                         EasyWaveDialect dialect = EasyWaveDialect::easywave);
/// How points stand in a WVDT command.
enum class WvdtPoints {
  bits14_little_endian,  ///< SDG800 .. SDG5000: two's complement of 14 bits, low byte first
  bits14_big_endian,     ///< the same, high byte first
  bits16_little_endian,  ///< X series: two's complement of 16 bits, low byte first
};

/// Settings and points of a WVDT command.
struct WvdtCommand {
  int channel = 1;             ///< >= 1
  std::string slot;            ///< "M50" of older generators; empty for the X series
  std::string name;            ///< of the waveform, letters, digits and _
  double frequency_hz = 0.0;   ///< of the whole table
  double amplitude_vpp = 0.0;  ///< peak to peak
  double offset_v = 0.0;       ///< middle
  double phase_deg = 0.0;
  std::vector<std::int16_t> points;  ///< signed: -2^(bits - 1) .. 2^(bits - 1) - 1
};

/// The command for a waveform of 2^14 or 2^16 levels.
/// @throws std::invalid_argument if the waveform is invalid or has other levels
WvdtCommand wvdt_command(const QuantizedWaveform& waveform, WvdtPoints points, int channel = 1);
/// The command's bytes: text up to "WAVEDATA,", then the points, without block header or end of
/// line.
/// @throws std::invalid_argument if name, channel or points break a rule
std::vector<std::byte> wvdt_bytes(const WvdtCommand& command, WvdtPoints points);

}  // namespace tofsmith
