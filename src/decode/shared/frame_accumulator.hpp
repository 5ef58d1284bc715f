// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "decode/shared/marked_raw.hpp"
#include "tofsmith/decode/frame_pipeline.hpp"

namespace tofsmith {

class MeanOfRows {
 public:
  /// @param levels  values clipped in one frame are clipped in the mean
  explicit MeanOfRows(const SaturationLevels& levels) : levels_(levels) {}

  bool is_empty() const { return frames_ == 0; }
  void add(const RawView& raw);
  /// Returns the mean of the frames since the last call, valid until the next add().
  RawView finish(double averaged);

 private:
  void start(const RawView& first);

  SaturationLevels levels_;
  int height_ = 0, width_ = 0, measurements_ = 0, frames_ = 0;
  std::vector<double> sums_;  // infinite if clipped
  std::vector<float> averaged_;
};

class FrameAccumulator {
 public:
  FrameAccumulator(const DecodingTable& table, const FrameSteps& steps);

  FrameMemory memory(int recorded, int height, int width) const;
  std::optional<RawView> submit(const RawView& raw, bool completes_mean);
  std::optional<RawView> submit_end();

 private:
  std::optional<RawView> filtered(const RawView& frame);

  FrameSteps steps_;
  int measurements_;
  MeanOfRows mean_;
  std::optional<TimeFilter> time_filter_;
};

}  // namespace tofsmith
