// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Readers of exported waveforms, to verify the writers. They check nothing: missing text is read as
// NaN or as too few points.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "waveforms/generator_formats.hpp"

namespace tofsmith {

struct EasyWaveTable {
  double frequency_hz = 0.0;   ///< of the whole table
  double amplitude_vpp = 0.0;  ///< peak to peak
  double offset_v = 0.0;       ///< middle
  std::vector<double> volts;   ///< of every row, offset included
};

/// Reads all dialects.
EasyWaveTable parse_easywave_csv(std::string_view text);

WvdtCommand parse_wvdt(std::span<const std::byte> bytes, WvdtPoints points);

struct KeysightArb {
  double sample_rate_hz = 0.0;
  double high_level_v = 0.0;         ///< of 32767
  double low_level_v = 0.0;          ///< of -32767
  double marker_point = 0.0;         ///< point at which the sync output becomes low
  std::vector<std::int16_t> points;  ///< from -32767 to 32767
};

KeysightArb parse_keysight_arb(std::string_view text);

std::vector<std::int16_t> parse_keysight_dac_bytes(std::span<const std::byte> bytes);

/// Returns the points, 0 to 16383.
std::vector<std::int32_t> parse_tektronix_tfw(std::span<const std::byte> bytes);

struct TektronixWfm {
  double sample_rate_hz = 0.0;
  std::vector<float> values;          ///< from -1 to 1, full scale of the DAC
  std::vector<std::uint8_t> markers;  ///< bit 0: marker 1, bit 1: marker 2
};

TektronixWfm parse_tektronix_wfm(std::span<const std::byte> bytes);

/// Returns the data of the block at the beginning of `bytes`.
std::span<const std::byte> parse_ieee488_block(std::span<const std::byte> bytes);

/// A language of pattern_memory.hpp, which writes one word per line.
struct PatternSyntax {
  std::string_view begin;  ///< end of the text before the words
  std::string_view mark;   ///< text before the digits of each word
  int radix = 16;
};

struct PatternWords {
  int digits = 0;  ///< of the first word
  std::vector<std::uint64_t> words;
};

PatternWords parse_pattern(std::string_view text, const PatternSyntax& syntax);

}  // namespace tofsmith
