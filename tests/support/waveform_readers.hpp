// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Readers of exported waveforms, to verify the writers.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "waveforms/siglent.hpp"

namespace tofsmith {

struct EasyWaveTable {
  double frequency_hz = 0.0;   ///< of the whole table
  double amplitude_vpp = 0.0;  ///< peak to peak
  double offset_v = 0.0;       ///< middle
  double phase_deg = 0.0;
  std::vector<double> volts;  ///< of every row, offset included
};

/// Reads all dialects, also with LF line ends.
/// @param file  name for error messages
/// @throws IoError "file:line: ..." for any other text
EasyWaveTable parse_easywave_csv(std::string_view text, std::string_view file);

/// Reads a command or a generator's answer to WVDT?. Fields may have any order and blanks; the data
/// may end with a line feed.
/// @throws IoError "place: byte N: ..." for any other content
WvdtCommand parse_wvdt(std::span<const std::byte> bytes, WvdtPoints points, std::string_view place);

struct KeysightArb {
  double sample_rate_hz = 0.0;
  double high_level_v = 0.0;         ///< of 32767
  double low_level_v = 0.0;          ///< of -32767
  int marker_point = 0;              ///< point at which the sync output becomes low; 0: missing
  std::vector<std::int16_t> points;  ///< from -32767 to 32767
};

/// @param file  name for error messages
/// @throws IoError "file:line: ..." for any other text
KeysightArb parse_keysight_arb(std::string_view text, std::string_view file);

/// @throws IoError for an incomplete point or a point below -32767
std::vector<std::int16_t> parse_keysight_dac_bytes(std::span<const std::byte> bytes,
                                                   std::string_view place);

/// Returns the points, 0 to 16383.
/// @throws IoError "file: byte N: ..." for any other content
std::vector<std::int32_t> parse_tektronix_tfw(std::span<const std::byte> bytes,
                                              std::string_view file);

struct TektronixWfm {
  double sample_rate_hz = 0.0;        ///< 0: the file has no CLOCK
  std::vector<float> values;          ///< from -1 to 1, full scale of the DAC
  std::vector<std::uint8_t> markers;  ///< bit 0: marker 1, bit 1: marker 2
};

/// @throws IoError "file: byte N: ..." for any other content
TektronixWfm parse_tektronix_wfm(std::span<const std::byte> bytes, std::string_view file);

/// A block at the beginning of `bytes`.
struct Ieee488Block {
  std::span<const std::byte> data;
  std::size_t size = 0;  ///< size of the block including its header
};

/// @param place  name for error messages, such as a file name
/// @throws IoError "place: byte N: ..." if there is no block or it is shorter than its length field
Ieee488Block parse_ieee488_block(std::span<const std::byte> bytes, std::string_view place);

}  // namespace tofsmith
