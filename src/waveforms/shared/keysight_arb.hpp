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

/// What the DAC of a 33500 or 33600 takes: -32767 .. 32767.
inline constexpr std::int32_t keysight_levels = 65535;

/// What an .arb file says.
struct KeysightArb {
  double sample_rate_hz = 0.0;
  double high_level_v = 0.0;         ///< of 32767
  double low_level_v = 0.0;          ///< of -32767
  int marker_point = 0;              ///< where the sync output goes low; 0: not said
  std::vector<std::int16_t> points;  ///< -32767 .. 32767
};

/// A waveform of `keysight_levels` levels as the text that a 33500 or 33600 loads.
/// @param end_of_line  "\n" or "\r\n"
/// @throws std::invalid_argument if the waveform is invalid or has other levels
std::string keysight_arb_text(const QuantizedWaveform& waveform,
                              std::string_view end_of_line = "\n");
/// @param file  what errors call it
/// @throws IoError "file:line: .." for what it does not understand
KeysightArb parse_keysight_arb(std::string_view text, std::string_view file);

/// The points as DATA:ARB:DAC takes them: big-endian 16-bit numbers (the default of FORM:BORD), for
/// a block of ieee488_block.hpp.
/// @throws std::invalid_argument as keysight_arb_text()
std::vector<std::byte> keysight_dac_bytes(const QuantizedWaveform& waveform);
/// @throws IoError if the bytes are no whole points or one is below -32767
std::vector<std::int16_t> parse_keysight_dac_bytes(std::span<const std::byte> bytes,
                                                   std::string_view place);

}  // namespace tofsmith
