// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "decode_output.hpp"
#include "status_counts.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/io/raw_frames_reader.hpp"

namespace tofsmith::apps {

/// Decodes rows of a frame, from `first_row` on, as decoders decode a frame.
using DecodeRows = std::function<void(const RawView& raw, int first_row, const DecodedView& decoded,
                                      const Progress& progress)>;

/// What came of a recording.
struct DecodeSummary {
  std::vector<StatusCounts> frames;  ///< of every finished frame, empty if statuses do not count
  std::int64_t pixels = 0;           ///< decoded, over all frames
  double seconds = 0.0;

  double frames_per_s() const { return static_cast<double>(frames.size()) / seconds; }
  double megapixels_per_s() const { return 1e-6 * static_cast<double>(pixels) / seconds; }
  StatusCounts total() const;
};

/// How many rows are read and decoded at a time so that all buffers together fit.
/// @throws IoError if a frame of this format, or a single row, takes more
int rows_at_a_time(const RawFramesReader& reader, const DecodeTarget& target, double memory_bytes);

/// Decodes the target's frames in bands of at most `rows` rows, in memory that does not grow with
/// their number.
/// @param summary  filled frame by frame, so that it tells what was finished when this throws
/// @throws IoError as reader and output; Interrupted if progress says so
void decode_frames(const RawFramesReader& reader, int rows, const DecodeRows& decode_rows,
                   DecodeOutput& output, const Progress& progress, DecodeSummary& summary);

}  // namespace tofsmith::apps
