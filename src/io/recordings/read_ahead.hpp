// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <future>
#include <optional>
#include <vector>

#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

/// Rows first_row to first_row + rows - 1.
struct Band {
  int frame = 0;
  int first_row = 0;
  int rows = 0;
};

/// Returns bands of at most `rows` rows that cover the frames first to last - 1 from top to bottom.
std::vector<Band> bands_of(int first, int last, int height, int rows);

/// Reads the next band in the background. Needs memory for two bands.
class ReadAhead {
 public:
  /// @param reader  must outlive this object
  ReadAhead(const RawFramesReader& reader, std::vector<Band> bands);
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  const std::vector<Band>& bands() const { return bands_; }
  /// Returns the next band, valid until the next call; none after the last.
  /// @throws IoError as RawFramesReader::read_rows()
  std::optional<RawView> next();

 private:
  void start();

  const RawFramesReader& reader_;
  std::vector<Band> bands_;
  std::size_t started_ = 0;
  std::array<std::vector<std::byte>, 2> buffers_;
  std::future<RawView> coming_;  // last member: destroyed before the buffers
};

}  // namespace tofsmith
