// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "tofsmith/decode/decode_method.hpp"
#include "tofsmith/decode/depth_limits.hpp"
#include "tofsmith/decode/filter.hpp"
#include "tofsmith/decode/time_filter.hpp"

namespace tofsmith {

/// Processing steps between recorded frames and the numbers that are decoded.
struct FrameSteps {
  int average = 1;        ///< recorded frames per mean; 1: frames are not averaged
  double averaged = 1.0;  ///< number of equal measurements averaged in each recorded number
  std::optional<TimeFilterOptions> time_filter;  ///< temporal filter of the means; none: off
  const Filter* filter = nullptr;  ///< spatial filter; must outlive the pipeline; null: none
  bool keeps_filtered = false;     ///< required for numbers() with a spatial filter
};

/// Host memory that a pipeline needs [bytes].
struct FrameMemory {
  double whole = 0.0;  ///< independent of the rows submitted at a time
  double row = 0.0;    ///< for each row submitted at a time
};

/// Averages, filters and decodes the frames of one recording, one after another: submit() until a
/// frame is ready, then decode() it. Created by FrameBackend::prepare().
///
/// Without filters, the same rows of consecutive frames may be submitted instead of whole frames.
/// Not thread-safe.
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

  /// @param frames  number of frames that will be submitted
  virtual FrameMemory memory(int frames) const = 0;

  /// Submits the next recorded frame.
  /// @param raw             valid until the next submit() or submit_end()
  /// @param completes_mean  true for the last frame of a mean, and if frames are not averaged
  /// @return whether a frame is ready
  /// @throws std::invalid_argument if the measurements or sizes differ; IoError if the device fails
  virtual bool submit(const RawView& raw, bool completes_mean = true) = 0;
  /// Must be called after the last recorded frame. Completes a mean of fewer frames, or finishes
  /// the next frame that waited for later ones.
  /// @return whether a frame is ready
  virtual bool submit_end() = 0;

  /// Filters and decodes the frame that is ready. May be called repeatedly.
  /// @param left_out  (H, W), or empty; see Filter::apply()
  /// @throws Interrupted if `progress` requests it; IoError if the device fails. Some planes may
  ///         have been written.
  virtual void decode(const DecodedView& decoded, const Progress& progress = {},
                      const Image<std::uint8_t>& left_out = {}) = 0;
  /// Returns the numbers before the spatial filter, valid until the next submit().
  virtual RawView measured() = 0;
  /// Returns the numbers that are decoded, valid until the next submit() or decode(). With a
  /// spatial filter, requires FrameSteps::keeps_filtered; filters the frame unless decode() did.
  virtual RawView numbers(const Progress& progress = {}) = 0;

 private:
  const DepthDecoder& decoder_;
  FrameSteps steps_;
  int height_, width_;
};

/// A decoder and the processor that runs it: the CPU or an OpenCL device. Thread-safe.
class FrameBackend {
 public:
  FrameBackend() = default;
  FrameBackend(const FrameBackend&) = delete;
  FrameBackend& operator=(const FrameBackend&) = delete;
  virtual ~FrameBackend() = default;

  virtual const DepthDecoder& decoder() const = 0;
  /// Returns the name of the OpenCL device, or "cpu".
  virtual std::string device() const = 0;
  /// Returns a pipeline for frames of this size. The backend must outlive it.
  /// @throws std::invalid_argument if a step does not fit the decoder; IoError if the device fails
  virtual std::unique_ptr<FramePipeline> prepare(const FrameSteps& steps, int height,
                                                 int width) const = 0;
};

/// Returns the backend of the CPU. For OpenCL devices see frame_backend() (gpu.hpp).
std::unique_ptr<FrameBackend> cpu_backend(std::unique_ptr<const DepthDecoder> decoder);

/// Corrections of decoded planes.
struct PlaneCorrections {
  PixelMaps maps;                    ///< maps of whole frames, in addition to table().correction
  std::optional<MixedPixels> mixed;  ///< treatment of mixed pixels, in whole frames; none: off
  /// Limits for restrict_depths(); with a spatial filter they require FrameSteps::keeps_filtered.
  /// No value: any depth in the range.
  std::optional<DepthLimits> limits = {};
};

/// Decodes the ready frame, or rows of it, and corrects its planes. The plane `averaged` requires
/// FrameSteps::keeps_filtered if there is a spatial filter. If a filtered frame has mixed pixels,
/// it is filtered again without them, so that they do not affect their neighbours.
/// @param first_row, rows  the submitted rows
/// @param decoded          planes whose first value belongs to the first of the rows
/// @throws as FramePipeline::decode()
void decode_frame(FramePipeline& pipeline, const PlaneCorrections& corrections, int first_row,
                  int rows, const DecodedView& decoded, const Progress& progress = {});

}  // namespace tofsmith
