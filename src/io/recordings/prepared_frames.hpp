// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "decode/shared/saturation_level.hpp"
#include "io/recordings/read_ahead.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/filter.hpp"
#include "tofsmith/decode/merge_exposures.hpp"
#include "tofsmith/decode/stray_light.hpp"
#include "tofsmith/decode/time_filter.hpp"
#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith {

/// What is done to raw numbers before they are decoded.
struct Preparation {
  int average = 1;        ///< mean of so many consecutive frames, the last of those there are
  double averaged = 1.0;  ///< of how many measurements raw numbers are the mean as they are read
  std::optional<TimeFilterOptions> time_filter;  ///< of those means
  std::optional<FilterOptions> filter;           ///< of what comes of that
  bool filters_with_decoder = false;             ///< it is what decodes that filters
  bool find_mixed = false;                       ///< afterwards, in whole frames
  bool undistort = false;                        ///< last of all, in whole frames
  Image<float> stray_kernel;                     ///< of StrayLight, taken off first; empty: none
  std::vector<double> hdr;                       ///< exposures of frames that make one; empty: none
  FramesElsewhere elsewhere;                     ///< means and frames added in time; none: here
  bool wants_numbers = false;                    ///< of those that are elsewhere, here too

  bool needs_frames() const {
    return time_filter || filter || find_mixed || undistort || !stray_kernel.empty();
  }
  /// Whether frames of so many pixels are made or added up elsewhere.
  bool is_elsewhere(std::int64_t pixels) const {
    return (time_filter || average > 1) && elsewhere && elsewhere.takes(pixels);
  }
  /// Frames that come out of so many.
  int frames_of(int recorded) const { return (recorded + group() - 1) / group(); }
  /// Frames that one of those is made of.
  int group() const { return hdr.empty() ? average : static_cast<int>(hdr.size()); }
  /// What it takes beside the rows that are read [bytes], in all of a recording of so many frames
  /// and for each row under way.
  double frame_bytes(int recorded, int height, int width, int measurements) const;
  double row_bytes(int width, int measurements) const;

 private:
  double row_bytes_of_sums(int width, int measurements) const;
};

/// Sums of the same rows of frames after another.
class RowSums {
 public:
  /// @param levels  numbers that are clipped in one frame are clipped in the mean; numbers that are
  ///                not finite in one frame are NaN
  void start(const RawView& first, const SaturationLevels& levels);
  void add(const RawView& raw);
  /// The means, with how many measurements they are of, until the next start().
  /// @param averaged  of how many the numbers of one frame are
  RawView means(double averaged);

 private:
  int height_ = 0, width_ = 0, measurements_ = 0, frames_ = 0;
  SaturationLevels levels_;
  std::vector<double> sums_;  // interleaved; infinite where clipped
  std::vector<float> averaged_;
};

/// Bands to read for those that come out, of a recording of so many frames.
std::vector<Band> bands_to_read(const Preparation& preparation, int recorded,
                                const std::vector<Band>& bands);

/// Gives bands of frames as they are decoded: as they come, as means of several frames, filtered in
/// time and, on the way to the decoder, in space.
class PreparedFrames {
 public:
  /// The raw numbers of the next band, until the call after; none after the last.
  using Input = std::function<std::optional<RawView>()>;

  /// @param input     gives bands_to_read(); whole frames if there is a filter; for one in time all
  ///                  frames before the first, too, and those that the last looks ahead to
  /// @param table     outlives this
  /// @param recorded  frames that there are; of a stream the most an int holds
  PreparedFrames(Input input, const DecodingTable& table, const Preparation& preparation,
                 int recorded);

  /// How long next() takes, and decode(), where decoding alone takes 1: about.
  double effort() const {
    const int comparisons = time_filter_ ? 1 + preparation_.time_filter->look_ahead : 0;
    return (preparation_.group() > 1 ? 1.0 : 0.0) + comparisons;
  }
  double decode_effort() const {
    return preparation_.filter ? 9.0 * (preparation_.find_mixed ? 2.0 : 1.0) : 1.0;
  }
  /// The raw numbers of the next band, of frame `frame` of those that come out, until the call
  /// after; none after the last.
  /// @throws IoError as the input; Interrupted if progress says so
  std::optional<RawView> next(int frame, const Progress& progress);

  /// Memory for filtered numbers.
  FilteredFrame& filtered() { return filtered_; }

  /// Has numbers that next() gave decoded, filtered in space if there is a filter.
  /// @param statuses, decode  as decode_filtered() takes them
  void decode(
      const RawView& raw, const PixelStatus* statuses,
      const std::function<void(const RawView&, const UnfilteredPixels&, const Progress&)>& decode,
      const Progress& progress);

 private:
  std::optional<RawView> measured(int frame, const Progress& progress);
  std::optional<RawView> read();
  std::optional<RawView> bracketed(const Progress& progress);
  std::optional<RawView> added_up(int frame, const Progress& progress);
  RawView added_elsewhere(const RawView& raw);
  bool is_elsewhere(const RawView& raw);
  RawView frame_elsewhere(const RawView& raw) const;

  const DecodingTable& table_;
  Preparation preparation_;
  int recorded_;
  Input input_;
  RowSums sums_;
  std::vector<RawFrames> exposed_;  // of one group, as they were read
  MergedExposures merged_;
  std::optional<StrayLight> stray_light_;
  RawFrames clean_;              // of stray light
  std::vector<float> averaged_;  // of numbers that are read, unless of one
  std::optional<TimeFilter> time_filter_;
  int frames_read_ = 0, frames_added_ = 0;  // into time_filter_, and that came out of it
  bool has_ended_ = false;
  std::optional<bool> is_elsewhere_;  // once the first frame is there
  RawView frame_size_;                // of those that are added up elsewhere, no more
  std::optional<Filter> filter_;
  FilteredFrame filtered_;
};

}  // namespace tofsmith
