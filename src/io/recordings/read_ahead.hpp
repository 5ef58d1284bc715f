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

/// Rows first_row .. first_row + rows - 1 of a frame.
struct Band {
  int frame = 0;
  int first_row = 0;
  int rows = 0;
};

/// Frames first .. last - 1 from top to bottom, in bands of at most `rows` rows.
std::vector<Band> bands_of(int first, int last, int height, int rows);

/// Gives bands of a recording one after another and reads the next one meanwhile, in the memory of
/// two.
class ReadAhead {
 public:
  /// @param reader  outlives this
  ReadAhead(const RawFramesReader& reader, std::vector<Band> bands);
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  const std::vector<Band>& bands() const { return bands_; }
  /// The raw numbers of the next band, until the call after; none after the last.
  /// @throws IoError as RawFramesReader::read_rows()
  std::optional<RawView> next();

 private:
  void start();

  const RawFramesReader& reader_;
  std::vector<Band> bands_;
  std::size_t started_ = 0;  // bands whose reading has begun
  std::array<std::vector<std::byte>, 2> buffers_;
  std::future<RawView> coming_;  // last: its end waits for the buffer's last use
};

}  // namespace tofsmith
