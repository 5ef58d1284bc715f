// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// What the files of a format hold.
enum class FormatContent {
  one_waveform,  ///< a file per waveform
  all_columns,   ///< all waveforms side by side
  words,         ///< a memory whose words hold all outputs, exposures one after another
};

/// A way in which sources disagree about a format; the first of a format is the default.
struct FormatVariant {
  std::string name;
  std::string description;
};

/// A file format of waveforms and what its hardware holds. docs/formats.md has layouts and sources.
struct WaveformFormat {
  std::string name;         ///< "siglent-csv", ..
  std::string extension;    ///< ".csv", ..
  std::string description;  ///< one line
  FormatContent content = FormatContent::one_waveform;
  int least_points = 2;  ///< of a table
  int most_points = 1 << 20;
  int multiple_of = 1;      ///< points of a table
  std::int32_t levels = 0;  ///< of a point; 0: 2^bits, whatever bits are asked for
  int default_bits = 14;
  int most_bits = 16;         ///< of amplitude
  bool skips_points = false;  ///< a table of more points than the sample rate allows is played
  std::string trigger;        ///< where the trigger stands; empty: nowhere
  std::vector<FormatVariant> variants;
};

/// All formats.
const std::vector<WaveformFormat>& waveform_formats();
/// @throws std::invalid_argument that lists the formats, with the nearest one
const WaveformFormat& waveform_format(std::string_view name);
/// Index of a variant of the format; 0 for "". @throws std::invalid_argument that lists them
int variant_index(const WaveformFormat& format, std::string_view variant);

}  // namespace tofsmith
