// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/frame_pipeline.hpp"
#include "tofsmith/decode/merge_exposures.hpp"
#include "tofsmith/decode/stray_light.hpp"
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

/// Number of windows of `exposures` consecutive exposures in a recording of whole frames.
constexpr int windows_of(int frames, int exposures) { return (frames - 1) * exposures + 1; }

/// Latest recording of each exposure of a code, in the order of the code.
class SlidingWindow {
 public:
  explicit SlidingWindow(int exposures) : exposures_(exposures) {}

  /// Replaces one exposure. All frames must have the same size and type. All exposures must have
  /// been taken before view().
  void take(const RawView& frame, int exposure);
  /// Valid until the next take().
  RawView view() const;

 private:
  int exposures_;
  RawView newest_;  // frame; its numbers are not used
  std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint16_t>,
               std::vector<std::uint8_t>>
      numbers_;
};

/// Steps before and after the FramePipeline.
struct Preparation {
  FrameSteps steps;
  bool find_mixed = false;    ///< after decoding, in whole frames
  bool undistort = false;     ///< last step, in whole frames
  Image<float> stray_kernel;  ///< of StrayLight, first step; empty: none
  std::vector<double> hdr;    ///< exposures of frames that are merged; empty: none
  int sliding = 0;            ///< exposures of a sliding window; 0: whole frames are decoded

  /// With sliding windows, the input returns each frame once per exposure, complete up to it.
  bool exposures_arrive = false;

  bool needs_frames() const {
    return steps.time_filter || steps.filter || find_mixed || undistort || !stray_kernel.empty() ||
           sliding > 0;
  }
  int frames_of(int recorded) const {
    return sliding > 0 ? windows_of(recorded, sliding) : (recorded + group() - 1) / group();
  }
  int first_recorded(int index) const { return sliding > 0 ? index / sliding : index * group(); }
  /// Frames that are submitted to the pipeline for `recorded` frames.
  int submitted_of(int recorded) const {
    return hdr.empty() && sliding == 0 ? recorded : frames_of(recorded);
  }
  /// A time filter needs one pipeline for each group of windows that share no exposure.
  int pipelines() const { return sliding > 0 && steps.time_filter ? sliding : 1; }
  int group() const { return hdr.empty() ? steps.average : static_cast<int>(hdr.size()); }
  /// Memory in addition to rows and pipeline.
  FrameMemory memory(int height, int width, int measurements) const;
};

std::vector<std::unique_ptr<FramePipeline>> prepare_pipelines(const FrameBackend& backend,
                                                              const Preparation& preparation,
                                                              int height, int width);

std::vector<Band> bands_to_read(const Preparation& preparation, int recorded,
                                const std::vector<Band>& bands);

/// Submits recorded frames, or sliding windows of exposures, to pipelines, without stray light and
/// with exposures merged.
class PreparedFrames {
 public:
  /// Returns the next band, valid until the next call; none after the last.
  using Input = std::function<std::optional<RawView>()>;

  /// @param input  returns bands_to_read(); whole frames if there is a filter, with a temporal
  ///   filter also all frames before the first and the look-ahead after the last
  /// @param pipelines  used in turn; must outlive this object
  /// @param recorded  number of recorded frames; for a stream the largest int
  PreparedFrames(Input input, const Preparation& preparation,
                 const std::vector<std::unique_ptr<FramePipeline>>& pipelines, int recorded);

  FramePipeline& pipeline() const { return *pipelines_[current_]; }
  /// Approximate time, relative to decoding without filters.
  double effort() const {
    const auto& time_filter = preparation_.steps.time_filter;
    const int comparisons = time_filter ? 1 + time_filter->look_ahead : 0;
    return (preparation_.group() > 1 ? 1.0 : 0.0) + comparisons;
  }
  double decode_effort() const {
    return preparation_.steps.filter ? 9.0 * (preparation_.find_mixed ? 2.0 : 1.0) : 1.0;
  }
  /// Submits bands until the next band of decoded frame `frame` is ready.
  /// @return false after the last
  /// @throws IoError as the input; Interrupted if `progress` requests it
  bool next(int frame, const Progress& progress);

 private:
  std::optional<RawView> read();
  std::optional<RawView> bracketed(const Progress& progress);
  std::optional<RawView> window(int index);
  std::optional<bool> submit_group(int frame, const Progress& progress);
  bool next_in_time(int frame, const Progress& progress);

  Preparation preparation_;
  const std::vector<std::unique_ptr<FramePipeline>>& pipelines_;
  std::size_t current_ = 0;
  int recorded_;
  Input input_;
  std::vector<RawFrames> exposed_;  // one group, as read
  MergedExposures merged_;
  std::optional<StrayLight> stray_light_;
  RawFrames clean_;                         // without stray light
  std::vector<float> averaged_;             // per input number; empty: 1
  int frames_read_ = 0, frames_ready_ = 0;  // submitted to and returned by the temporal filter
  bool has_ended_ = false;
  std::optional<SlidingWindow> window_;
  std::optional<RawView> newest_;  // frame whose exposures the window uses
  int next_exposure_ = 0;
};

}  // namespace tofsmith
