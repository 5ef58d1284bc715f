// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/read_ahead.hpp"

#include <algorithm>
#include <utility>

namespace tofsmith {

std::vector<Band> bands_of(int first, int last, int height, int rows) {
  std::vector<Band> bands;
  for (int frame = first; frame < last; ++frame)
    for (int row = 0; row < height; row += rows)
      bands.push_back({frame, row, std::min(rows, height - row)});
  return bands;
}

ReadAhead::ReadAhead(const RawFramesReader& reader, std::vector<Band> bands)
    : reader_(reader), bands_(std::move(bands)) {
  start();
}

void ReadAhead::start() {
  if (started_ == bands_.size()) return;
  const Band band = bands_[started_];
  std::vector<std::byte>& buffer = buffers_[started_ % 2];
  ++started_;
  coming_ = std::async(std::launch::async, [this, band, &buffer] {
    return reader_.read_rows(band.frame, band.first_row, band.rows, buffer);
  });
}

std::optional<RawView> ReadAhead::next() {
  if (!coming_.valid()) return std::nullopt;
  const RawView view = coming_.get();
  start();
  return view;
}

}  // namespace tofsmith
