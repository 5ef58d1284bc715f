// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/filter/filter_planes.hpp"

#include "decode/filter/lit_kernel.hpp"

namespace tofsmith {

namespace {
float* room_for(std::size_t floats, std::vector<float>& buffer) {
  if (buffer.size() < floats) buffer.resize(floats);
  return buffer.data();
}
}  // namespace

PairWeights StripBuffers::weights(const FilterGrid& grid, const FilterStrip& strip,
                                  bool with_shifts) {
  return {.weight = room_for(weight_floats(grid, strip), weight),
          .shifted = with_shifts ? room_for(weight_floats(grid, strip), shifted) : nullptr,
          .scratch = room_for(scratch_floats(grid, strip), scratch),
          .stride = weight_stride(grid)};
}

std::unique_ptr<StripBuffers> StripBufferPool::take() {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) return std::make_unique<StripBuffers>();
  std::unique_ptr<StripBuffers> buffers = std::move(free_.back());
  free_.pop_back();
  return buffers;
}

void StripBufferPool::give_back(std::unique_ptr<StripBuffers> buffers) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(buffers));
}

FilterGrid FilterPlanes::grid_of(int height, int width, int largest_step) {
  FilterGrid grid{.height = height, .width = width};
  grid.margin = margin_columns(largest_step);
  grid.rows_above = margin_rows(largest_step);
  grid.stride = whole_vectors(width + grid.margin);
  return grid;
}

std::size_t FilterPlanes::floats(const FilterGrid& grid, int measurements) {
  return grid.floats(scalars + light_sets * measurements);
}

void FilterPlanes::resize(int height, int width, int measurements_, int largest_step) {
  const FilterGrid wanted = grid_of(height, width, largest_step);
  const bool fits = grid.height == height && grid.width == width && grid.margin == wanted.margin &&
                    measurements == measurements_;
  if (fits) return;
  grid = wanted;
  measurements = measurements_;
  storage.assign(floats(grid, measurements), 0.0f);
  averaged = Image<float>(height, width, 1.0f);
  lit_points.clear();
  for (const WindowStep& step : lit_bar_points())
    lit_points.push_back(step.rows * grid.stride + step.columns);
}

void FilterPlanes::reserve_deviation_factors(bool are_wanted) {
  if (!are_wanted)
    deviation_factor = {};
  else if (deviation_factor.height != grid.height || deviation_factor.width != grid.width)
    deviation_factor = Image<float>(grid.height, grid.width, 1.0f);
}

FilteredFrame::FilteredFrame() : planes_(make_hidden<FilterPlanes>()) {}

int FilteredFrame::height() const { return planes_->grid.height; }
int FilteredFrame::width() const { return planes_->grid.width; }
const Image<float>& FilteredFrame::averaged() const { return planes_->averaged; }
const Image<float>& FilteredFrame::deviation_factor() const { return planes_->deviation_factor; }

RawView FilteredFrame::view() const {
  const FilterPlanes& p = *planes_;
  return {.data = p.measurements > 0 ? p.light(p.result, 0) : nullptr,
          .height = p.grid.height,
          .width = p.grid.width,
          .measurements = p.measurements,
          .row_stride = p.grid.stride,
          .column_stride = 1,
          .measurement_stride = p.grid.plane_floats(),
          .averaged = p.averaged.pixels.data(),
          .noise = p.noise,
          .is_marked = true};
}

RawFrames FilteredFrame::values() const {
  const RawView raw = view();
  RawFrames frames{.frames = 1,
                   .height = raw.height,
                   .width = raw.width,
                   .measurements = raw.measurements,
                   .values = {}};
  frames.values.resize(frames.pixels_per_frame() * static_cast<std::size_t>(raw.measurements));
  copy_pixels(raw, 0, raw.pixels(), frames.values.data());
  return frames;
}

}  // namespace tofsmith
