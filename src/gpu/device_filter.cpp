// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <mutex>

#include "decode/shared/marked_raw.hpp"
#include "gpu/device_decoder_plan.hpp"
#include "gpu/device_filter.hpp"
#include "gpu/device_frame.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Output rows per band.
constexpr int min_band_rows = 16;

class FilteredRows {
 public:
  FilteredRows(const Filter::Plan& plan, const RawView& raw, FilteredFrame& frame)
      : planes_(planes_of(frame)) {
    planes_.resize(raw.height, raw.width, raw.measurements, 1);
    planes_.reserve_deviation_factors(plan.options.slope_rounds > 0);
    planes_.noise = plan.noise_ratios();
    planes_.result = 0;
  }

  void fetch(const DeviceFrame& frame, const DeviceRaw& from, int first_row, int rows) {
    const DeviceQueue& queue = frame.queue();
    const auto width = static_cast<std::size_t>(planes_.grid.width),
               pixels = width * static_cast<std::size_t>(rows),
               measurements = static_cast<std::size_t>(planes_.measurements);
    numbers_.resize(pixels * measurements);
    queue.download(*from.numbers(), numbers_.size() * sizeof(float), numbers_.data());
    queue.download(*from.averaged(), pixels * sizeof(float), &planes_.averaged(first_row, 0));
    if (const DeviceMemory* factors = frame.deviation_factors())
      queue.download(*factors, pixels * sizeof(float), &planes_.deviation_factor(first_row, 0));
    const float* row_of_numbers = numbers_.data();
    for (int k = 0; k < planes_.measurements; ++k)
      for (int row = first_row; row < first_row + rows; ++row, row_of_numbers += width)
        std::copy_n(row_of_numbers, width, planes_.light(0, k) + row * planes_.grid.stride);
  }

 private:
  FilterPlanes& planes_;
  std::vector<float> numbers_;
};

}  // namespace

struct DeviceFilter::Plan {
  Plan(const Device& device_, const Filter& filter_, const DeviceOptions& options_)
      : device(device_),
        filter(filter_),
        options(options_),
        frame(device, plan_of(filter), options.use_doubles) {}

  /// Returns the output rows per band that fit into memory.
  int rows_at_a_time(const RawView& raw) const;
  std::int64_t run(const FrameSource& source, DeviceDecoder::Plan* after,
                   const DecodedView& decoded, FilteredFrame* filtered, const Progress& progress,
                   const Image<std::uint8_t>& left_out);
  std::int64_t run_band(const FrameSource& source, IndexRange rows, DeviceDecoder::Plan* after,
                        const DecodedView& decoded, FilteredRows* filtered,
                        const Progress& progress, const Image<std::uint8_t>& left_out);

  Device device;
  const Filter& filter;
  DeviceOptions options;
  std::mutex mutex;  // for the members below
  DeviceFrame frame;
  DeviceRaw result;
  double memory_share = 1.0;
};

int DeviceFilter::Plan::rows_at_a_time(const RawView& raw) const {
  const double memory = memory_share * 1e6 * options.memory_mb;
  const auto bytes = [&](int rows) { return static_cast<double>(frame.bytes(rows, raw.width)); };
  if (bytes(raw.height) <= memory) return raw.height;
  const double of_row = bytes(2) - bytes(1), of_none = bytes(1) - of_row;
  const double rows = (memory - of_none) / of_row - 2.0 * DeviceFrame::reach(filter.options());
  return static_cast<int>(std::clamp(rows, double{min_band_rows}, double(raw.height)));
}

std::int64_t DeviceFilter::Plan::run_band(const FrameSource& source, IndexRange rows,
                                          DeviceDecoder::Plan* after, const DecodedView& decoded,
                                          FilteredRows* filtered, const Progress& progress,
                                          const Image<std::uint8_t>& left_out) {
  const RawView& raw = source.raw;
  const int reach = DeviceFrame::reach(filter.options());
  const auto first = static_cast<int>(rows.begin), count = static_cast<int>(rows.end) - first;
  const int from = std::max(0, first - reach),
            to = std::min(raw.height, static_cast<int>(rows.end) + reach);
  const FilterOptions& steps = filter.options();
  const double all_steps = steps.windows * (1 + steps.slope_rounds) + 1;
  int done = 0;
  frame.filter(source, from, to - from, left_out.empty() ? nullptr : left_out.pixels.data(), [&] {
    if (!progress) return;
    frame.queue().finish();
    report(progress, ++done / all_steps, "filtering");
  });
  const std::int64_t pixels = std::int64_t{count} * raw.width;
  if (!after) result.reserve_planes(frame.queue(), pixels, raw.measurements);
  const NoiseRatios noise = plan_of(filter).noise_ratios();
  const DeviceRaw& out = after ? after->tile.reserve_planes(pixels, noise) : result;
  frame.write(first - from, count, out);
  frame.queue().finish();
  if (filtered) filtered->fetch(frame, out, first, count);
  const std::size_t first_pixel =
      static_cast<std::size_t>(first) * static_cast<std::size_t>(raw.width);
  return after ? after->decode_what_is_there(decoded.from(first_pixel)) : 0;
}

std::int64_t DeviceFilter::Plan::run(const FrameSource& source, DeviceDecoder::Plan* after,
                                     const DecodedView& decoded, FilteredFrame* filtered,
                                     const Progress& progress,
                                     const Image<std::uint8_t>& left_out) {
  const RawView& raw = source.raw;
  std::optional<FilteredRows> wanted;
  if (filtered) wanted.emplace(plan_of(filter), raw, *filtered);
  std::int64_t left_open = 0;
  for (std::int64_t first = 0; first < raw.height;) {
    const int rows = rows_at_a_time(raw);
    const IndexRange band{first, std::min<std::int64_t>(raw.height, first + rows)};
    const auto height = static_cast<double>(raw.height);
    const Progress here = !progress ? Progress() : [&](double fraction, std::string_view step) {
      const double done =
          static_cast<double>(band.begin) + fraction * static_cast<double>(band.end - band.begin);
      return progress(done / height, step);
    };
    try {
      left_open +=
          run_band(source, band, after, decoded, wanted ? &*wanted : nullptr, here, left_out);
      first = band.end;
    } catch (const OutOfDeviceMemory&) {
      if (rows <= min_band_rows) throw;
      frame.release();
      result.release();
      if (after) after->tile.release();
      memory_share *= 0.5;
      continue;
    }
    report(progress, static_cast<double>(first) / height, "filtering");
  }
  return left_open;
}

DeviceFilter::DeviceFilter(const Device& device, const Filter& filter,
                           const DeviceOptions& options) {
  options.validate();
  plan_ = std::make_unique<Plan>(device, filter, options);
}
DeviceFilter::~DeviceFilter() = default;
DeviceFilter::DeviceFilter(DeviceFilter&&) noexcept = default;
DeviceFilter& DeviceFilter::operator=(DeviceFilter&&) noexcept = default;

const Device& DeviceFilter::device() const { return plan_->device; }

void DeviceFilter::apply(const RawView& raw, FilteredFrame& filtered, const Progress& progress,
                         const Image<std::uint8_t>& left_out) const {
  require_filterable(plan_of(plan_->filter), raw, left_out);
  const std::lock_guard lock(plan_->mutex);
  const MarkedRaw marked(raw, plan_of(plan_->filter).decoder.table().marking);
  plan_->run({.raw = marked.view()}, nullptr, {}, &filtered, progress, left_out);
}

FilteredFrame DeviceFilter::apply(const RawFrames& raw, int frame, const Progress& progress) const {
  FilteredFrame filtered;
  apply(view_of_frame(raw, frame), filtered, progress);
  return filtered;
}

std::int64_t DeviceFilter::decode(const RawView& raw, const DeviceDecoder& decoder,
                                  const DecodedView& decoded, FilteredFrame* filtered,
                                  const Progress& progress,
                                  const Image<std::uint8_t>& left_out) const {
  const MarkedRaw marked(raw, plan_of(plan_->filter).decoder.table().marking);
  return decode_source({.raw = marked.view()}, device(), decoder, decoded, filtered, progress,
                       left_out);
}

std::int64_t DeviceFilter::decode_source(const FrameSource& frame, const Device& its_device,
                                         const DeviceDecoder& decoder, const DecodedView& decoded,
                                         FilteredFrame* filtered, const Progress& progress,
                                         const Image<std::uint8_t>& left_out) const {
  require_filterable(plan_of(plan_->filter), frame.raw, left_out);
  require(&its_device.state() == &device().state(), "filter's device", device().info().name,
          "must be the device of the frame, or a copy of it");
  require(&decoder.device().state() == &device().state(), "decoder's device",
          decoder.device().info().name, "must be the device of the filter, or a copy of it");
  require(decoder.plan_->decoder.measurements() == frame.raw.measurements, "decoder's measurements",
          decoder.plan_->decoder.measurements(), "must equal those of the frame");
  const std::scoped_lock lock(plan_->mutex, decoder.plan_->mutex);
  return plan_->run(frame, decoder.plan_.get(), decoded, filtered, progress, left_out);
}

}  // namespace tofsmith
