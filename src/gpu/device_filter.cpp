// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_filter.hpp"

#include <algorithm>
#include <mutex>
#include <utility>

#include "decode/shared/marked_raw.hpp"
#include "gpu/device_decoder.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

constexpr auto weight_planes = static_cast<int>(half_window.size());

int planes_of_frame(const Filter::Plan& plan) { return before_plane(plan.measurements) + 1; }

}  // namespace

DeviceFrame::DeviceFrame(const Device& device, const Filter::Plan& plan, bool use_doubles)
    : plan_(plan),
      tables_(plan, fuses_products()),
      tile_(device, plan.decoder, use_doubles),
      parameters_(tables_.parameters),
      words_(queue().allocate(tables_.words.size() * sizeof(std::uint32_t))) {
  const auto kernel = [&](const char* name) { return queue().kernel(tables_.source, "", name); };
  read_light_ = kernel("read_light");
  find_hidden_noise_ = kernel("find_hidden_noise");
  find_energy_ = kernel("find_energy");
  weigh_similar_ = kernel("weigh_similar");
  add_similar_ = kernel("add_similar");
  write_raw_ = kernel("write_raw");
  take_depth_ = kernel("take_depth");
  find_slopes_ = kernel("find_slopes");
  split_ = kernel("split");
  add_along_slopes_ = kernel("add_along_slopes");
  compare_sums_ = kernel("compare_sums");
  keep_near_ = kernel("keep_near");
  keep_bright_ = kernel("keep_bright");
  find_own_light_ = kernel("find_own_light");
  leave_dark_ = kernel("leave_dark");
  find_own_amplitude_ = kernel("find_own_amplitude");
  add_slope_noise_ = kernel("add_slope_noise");
  write_filtered_ = kernel("write_filtered");
  queue().upload(tables_.words.data(), words_.bytes, words_);
}

int DeviceFrame::reach(const FilterOptions& options) {
  int similar = 0, along_slopes = slope_reach + own_light_reach;
  for (int window = 0; window < options.windows; ++window) {
    const int of_window = window_reach * window_step(window);
    similar += of_window + (window == 0 ? patch_reach : patch_reach - 1);
    along_slopes += of_window + (window == 0 ? 0 : std::max(compared_reach, line_reach));
  }
  return patch_reach + similar + options.slope_rounds * along_slopes +
         std::max(own_light_reach, lit_reach);
}

std::int64_t DeviceFrame::bytes(int rows, int width) const {
  const int step = window_step(plan_.options.windows - 1), k = plan_.measurements;
  const FilterGrid grid = FilterPlanes::grid_of(rows, width, step);
  const auto of_planes = static_cast<std::int64_t>(
      4 * (grid.floats(planes_of_frame(plan_)) + grid.floats(weight_planes)));
  // Raw numbers, factors, mask of excluded pixels, and two tiles of a decoder.
  return of_planes + std::int64_t{rows} * width * (4 * (k + 2) + 1 + 2 * tile_.bytes_per_pixel());
}

void DeviceFrame::resize(int rows, int width) {
  FilterParameters& p = parameters_;
  if (has_margins_ && p.height == rows && p.width == width) return;
  has_margins_ = false;  // until this has succeeded
  const FilterGrid grid =
      FilterPlanes::grid_of(rows, width, window_step(plan_.options.windows - 1));
  p.height = rows;
  p.width = width;
  p.stride = static_cast<int>(grid.stride);
  p.plane_floats = static_cast<int>(grid.plane_floats());
  p.origin = static_cast<int>(grid.origin());
  const auto bytes = [&](int planes) {
    return static_cast<std::int64_t>(sizeof(float) * grid.floats(planes));
  };
  queue().clear(*reserve(queue(), planes_, bytes(planes_of_frame(plan_))));
  queue().clear(*reserve(queue(), weights_, bytes(weight_planes)));
  has_margins_ = true;
}

void DeviceFrame::release() {
  tile_.release();
  raw_.release();
  has_margins_ = false;
  for (DeviceMemory* memory : {&planes_, &weights_, &left_out_, &factors_})
    *memory = DeviceMemory();
}

ResultParameters DeviceFrame::result(int set, int measured) const {
  return {.light = light(set),
          .measured = light(measured),
          .last_variance = plan_.last_variance(),
          .first_row = 0,
          .rows = parameters_.height};
}

void DeviceFrame::filter(const FrameSource& frame, int first_row, int rows,
                         const std::uint8_t* left_out, const StepDone& step_done) {
  const int windows = plan_.options.windows;
  const std::int64_t first = std::int64_t{first_row} * frame.raw.width,
                     pixels = std::int64_t{rows} * frame.raw.width;
  resize(rows, frame.raw.width);
  frame.bring(queue(), raw_, first, pixels);
  has_left_out_ = left_out != nullptr;
  if (has_left_out_)
    queue().upload(left_out + first, static_cast<std::size_t>(pixels),
                   *reserve(queue(), left_out_, pixels));

  read(0, FilterPlanes::usable, true);
  if (plan_.has_own_shot_noise)
    run(find_hidden_noise_, parameters_, raw_.averaged(), &planes_, light(0));
  int from = 0, to = 1;
  for (int window = 0; window < windows; ++window) {
    add_similar(from, to, window);
    std::swap(from, to);
    step_done();
  }
  for (int round = 0; round < plan_.options.slope_rounds; ++round) {
    if (round == 0) leave_dark(from, to);
    find_depth(from);
    read(to, FilterPlanes::signal, false);
    for (int window = 0; window < windows; ++window) {
      add_along_slopes(window == 0 ? to : from, to, from, window);
      step_done();
    }
    add_slope_noise(round);
  }
  read(to, FilterPlanes::usable, false);
  run(find_own_amplitude_, parameters_, result(from, to), &planes_);
  result_ = from;
}

void DeviceFrame::write(int first_row, int rows, const DeviceRaw& to) {
  ResultParameters r = result(result_, 1 - result_);
  r.first_row = first_row;
  r.rows = rows;
  if (deviation_factors())
    reserve(queue(), factors_,
            std::int64_t{rows} * parameters_.width * std::int64_t{sizeof(float)});
  run(write_filtered_, parameters_, r, raw_.tile(), &words_, raw_.numbers(), raw_.averaged(),
      &planes_, to.numbers(), to.averaged(), deviation_factors());
}

void DeviceFrame::read(int set, FilterPlanes::Scalar usable, bool with_variance) const {
  run(read_light_, parameters_, raw_.tile(), &words_, raw_.numbers(), raw_.averaged(),
      has_left_out_ ? &left_out_ : nullptr, &planes_, light(set), int{usable},
      with_variance ? 1 : 0);
}

void DeviceFrame::add_similar(int from, int to, int window) const {
  const WindowVariances variances(window);
  const int reach_of_patch = window == 0 ? patch_reach : patch_reach - 1;
  const PatchScale scale(plan_.rank, reach_of_patch);
  const SimilarParameters w{
      .light = light(from),
      .to = light(to),
      .variance_in = variances.in,
      .variance_out = variances.out,
      .step = window_step(window),
      .patch_reach = reach_of_patch,
      .by = scale.by,
      .expected = scale.expected,
      .noise_limit = scale.noise_limit,
      .floor_share = window == 0 ? 0.0f : static_cast<float>(1.0 / plan_.options.trusted_pixels),
      .bias_share = plan_.bias_of(window).share,
      .bias_by_noise = plan_.bias_of(window).by_noise};
  run(find_energy_, parameters_, w, &planes_);
  run(weigh_similar_, parameters_, w, &planes_, &weights_);
  run(add_similar_, parameters_, w, &planes_, &weights_);
  if (window > 0 && plan_.options.slope_rounds > 0) run(keep_bright_, parameters_, w, &planes_);
}

void DeviceFrame::leave_dark(int set, int other) const {
  constexpr int is_own = FilterPlanes::signal;
  read(other, FilterPlanes::usable, false);
  run(find_own_light_, parameters_, result(set, other), &planes_, is_own);
  run(leave_dark_, parameters_, &planes_, is_own);
}

void DeviceFrame::find_depth(int from) {
  const DeviceRaw& raw = tile_.reserve_planes(std::int64_t{parameters_.height} * parameters_.width);
  run(write_raw_, parameters_, result(from, from), &words_, raw_.averaged(), &planes_,
      raw.numbers(), raw.averaged());
  float wanted = 0.0f;  // selects planes; nothing is fetched
  tile_.decode({.depth_m = &wanted, .deviation_m = &wanted});
  decide_open_pixels();
  run(take_depth_, parameters_, tile_.plane(DecodedPlane::depth),
      tile_.plane(DecodedPlane::deviation), &planes_);
}

void DeviceFrame::decide_open_pixels() {
  const std::vector<std::int32_t> open = tile_.open_pixels();
  if (open.empty()) return;
  const OpenNumbers numbers(tile_.open_numbers(open), plan_.measurements, {});
  std::vector<float> depth_m(open.size()), deviation_m(open.size());
  plan_.decoder.decode(numbers.view(),
                       {.depth_m = depth_m.data(), .deviation_m = deviation_m.data()});
  tile_.put_depth(open, depth_m, deviation_m);
}

void DeviceFrame::add_along_slopes(int light_set, int rest, int to, int window) const {
  const WindowVariances variances(window);
  const SlopeParameters w{.light = light(light_set),
                          .rest = light(rest),
                          .to = light(to),
                          .variance_in = variances.in,
                          .variance_out = variances.out,
                          .step = window_step(window),
                          .is_last = window + 1 == plan_.options.windows ? 1 : 0,
                          .is_balanced = window > 0 ? 1 : 0};
  if (window == 0) run(find_slopes_, parameters_, &planes_);
  run(split_, parameters_, w, &words_, &planes_);
  run(add_along_slopes_, parameters_, w, &words_, &planes_);
  if (window == 0) return;
  run(compare_sums_, parameters_, w, &words_, &planes_);
  run(keep_near_, parameters_, w, &planes_);
}

void DeviceFrame::add_slope_noise(int round) const {
  const SlopeNoise noise = slope_noise_of(plan_.options.windows, round);
  const SlopeNoiseParameters n{.variance = plan_.last_variance(),
                               .near_variance = WindowVariances(plan_.options.windows - 1).in,
                               .sum = noise.sum,
                               .sum_offset = noise.sum_offset,
                               .before = noise.before,
                               .before_offset = noise.before_offset,
                               .is_last = round + 1 == plan_.options.slope_rounds ? 1 : 0,
                               .has_near_share = plan_.options.windows > 1 ? 1 : 0};
  run(add_slope_noise_, parameters_, n, &planes_);
}

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
  plan_ = make_hidden<Plan>(device, filter, options);
}

const Device& DeviceFilter::device() const { return plan_->device; }

void DeviceFilter::apply(const RawView& raw, FilteredFrame& filtered, const Progress& progress,
                         const Image<std::uint8_t>& left_out) const {
  require_filterable(plan_of(plan_->filter), raw, left_out);
  const std::lock_guard lock(plan_->mutex);
  const MarkedRaw marked(raw, plan_of(plan_->filter).decoder.table().marking);
  plan_->run({.raw = marked.view()}, nullptr, {}, &filtered, progress, left_out);
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
