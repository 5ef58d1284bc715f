// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/decode/decode_method.hpp"
#include "tofsmith/decode/depth_limits.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {

/// Steps between recorded frames and the numbers that are decoded.
struct FrameSteps {
  int average = 1;        ///< recorded frames per mean
  double averaged = 1.0;  ///< number of equal measurements averaged in each recorded number
  std::optional<TimeFilterOptions> time_filter;  ///< of the means; none: off
  const Filter* filter = nullptr;                ///< must outlive the pipeline; null: none
  bool keeps_filtered = false;                   ///< required for numbers() with a spatial filter
};

/// Host memory of a pipeline [bytes].
struct FrameMemory {
  double whole = 0.0;
  double row = 0.0;  ///< for each row submitted at a time
};

/// Averages, filters and decodes the frames of one recording: submit() until a frame is ready, then
/// decode() it. Created by FrameBackend::prepare().
///
/// Without filters, rows of consecutive frames may be submitted instead of whole frames. Not
/// thread-safe.
class FramePipeline {
 public:
  FramePipeline(const DepthDecoder& decoder, const FrameSteps& steps, int height, int width)
      : decoder_(decoder), steps_(steps), height_(height), width_(width) {}
  FramePipeline(const FramePipeline&) = delete;
  FramePipeline& operator=(const FramePipeline&) = delete;
  virtual ~FramePipeline() = default;

  const DepthDecoder& decoder() const { return decoder_; }
  const DecodingTable& table() const { return decoder_.table(); }
  const FrameSteps& steps() const { return steps_; }
  int height() const { return height_; }
  int width() const { return width_; }

  /// @param frames  number that will be submitted
  virtual FrameMemory memory(int frames) const = 0;

  /// Submits the next recorded frame.
  /// @param raw             valid until the next submit() or submit_end()
  /// @param completes_mean  true for the last frame of a mean
  /// @return whether a frame is ready
  /// @throws InvalidArgument if the measurements or sizes differ; IoError if the device fails
  virtual bool submit(const RawView& raw, bool completes_mean = true) = 0;
  /// Must be called after the last recorded frame. Completes a mean, or the next frame that waited
  /// for later ones.
  /// @return whether a frame is ready
  virtual bool submit_end() = 0;

  /// Filters and decodes the frame that is ready. May be called repeatedly.
  /// @param left_out  (H, W), or empty; see Filter::apply()
  /// @throws IoError if the device fails, Interrupted; some planes may have been written
  virtual void decode(const DecodedView& decoded, const Progress& progress = {},
                      const Image<std::uint8_t>& left_out = {}) = 0;
  /// Numbers before the spatial filter, valid until the next submit().
  virtual RawView measured() = 0;
  /// Numbers that are decoded, valid until the next submit() or decode(). A spatial filter requires
  /// FrameSteps::keeps_filtered.
  virtual RawView numbers(const Progress& progress = {}) = 0;
  /// FilteredFrame::deviation_factor() of the frame that was decoded last; empty without a spatial
  /// filter.
  virtual const Image<float>& deviation_factor() const = 0;

 private:
  const DepthDecoder& decoder_;
  FrameSteps steps_;
  int height_, width_;
};

/// A decoder and the CPU or OpenCL device that runs it. Thread-safe.
class FrameBackend {
 public:
  FrameBackend() = default;
  FrameBackend(const FrameBackend&) = delete;
  FrameBackend& operator=(const FrameBackend&) = delete;
  virtual ~FrameBackend() = default;

  virtual const DepthDecoder& decoder() const = 0;
  /// Name of the OpenCL device, or "cpu".
  virtual std::string device() const = 0;
  /// The backend must outlive the pipeline.
  /// @throws InvalidArgument if a step does not fit the decoder; IoError if the device fails
  virtual std::unique_ptr<FramePipeline> prepare(const FrameSteps& steps, int height,
                                                 int width) const = 0;
};

/// For OpenCL devices see frame_backend() (gpu.hpp).
std::unique_ptr<FrameBackend> cpu_backend(std::unique_ptr<const DepthDecoder> decoder);

/// Corrections of decoded planes.
struct PlaneCorrections {
  PixelMaps maps;                          ///< of whole frames, in addition to table().correction
  std::optional<MixedPixels> mixed;        ///< in whole frames; none: off
  std::optional<DepthLimits> limits = {};  ///< for restrict_depths()
};

/// Returns the planes that corrections require, in the order of DecodedPlane.
std::vector<DecodedPlane> planes_for(const PlaneCorrections& corrections,
                                     const DecodingTable& table);

/// Returns true if corrections or planes require FrameSteps::keeps_filtered with a spatial filter.
bool must_keep_filtered(const PlaneCorrections& corrections,
                        const std::vector<DecodedPlane>& planes);

/// Decodes the ready frame, or rows of it, and corrects its planes. With a spatial filter, the
/// pipeline keeps what must_keep_filtered() requires, and a frame with mixed pixels is filtered
/// again without them.
/// @param first_row, rows  submitted rows
/// @param decoded          planes whose first value belongs to the first row; null planes that
///                         planes_for() returns are computed in temporary memory
/// @throws as FramePipeline::decode()
void decode_frame(FramePipeline& pipeline, const PlaneCorrections& corrections, int first_row,
                  int rows, const DecodedView& decoded, const Progress& progress = {});

}  // namespace tofsmith
