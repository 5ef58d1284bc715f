// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_decoder.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Returns true for planes of the kernel write_planes; bins come from the kernel match.
constexpr bool is_written(const PlaneDescription& described) {
  return described.is_of_every_decoder() && described.plane != DecodedPlane::bin;
}

/// Planes in the order of the arguments of write_planes.
constexpr auto written_planes = [] {
  std::array<DecodedPlane, std::ranges::count_if(plane_descriptions, is_written)> planes;
  std::size_t count = 0;
  for (const PlaneDescription& described : plane_descriptions)
    if (is_written(described)) planes[count++] = described.plane;
  return planes;
}();

}  // namespace

OpenNumbers::OpenNumbers(std::vector<float> numbers, int measurements, const NoiseRatios& noise)
    : measurements_(measurements), noise_(noise), numbers_(std::move(numbers)) {
  const auto each = static_cast<std::size_t>(measurements) + 1;
  for (std::size_t at = each - 1; at < numbers_.size(); at += each)
    averaged_.push_back(numbers_[at]);
}

RawView OpenNumbers::view() const {
  const auto pixels = static_cast<int>(averaged_.size());
  RawView view = RawView::interleaved(numbers_.data(), 1, pixels, measurements_);
  view.column_stride = measurements_ + 1;
  view.row_stride = pixels * view.column_stride;
  return marked_view(view, averaged_.data(), noise_);
}

DeviceTile::DeviceTile(const Device& device, const Decoder& decoder, bool use_doubles)
    : outputs_(parts_of(decoder).outputs),
      bin_count_(decoder.table().bin_count()),
      tables_(decoder, use_doubles && device.info().has_doubles),
      queue_(device),
      match_(queue_.kernel(decode_kernels, tables_.options, "match")),
      write_(queue_.kernel(decode_kernels, tables_.options, "write_planes")),
      gather_(queue_.kernel(decode_kernels, tables_.options, "gather_numbers")),
      scatter_(queue_.kernel(decode_kernels, tables_.options, "scatter_values")),
      words_(queue_.allocate(tables_.words.size() * sizeof(std::uint32_t))),
      opened_(queue_.allocate(sizeof(std::int32_t))) {
  queue_.upload(tables_.words.data(), words_.bytes, words_);
}

std::int64_t DeviceTile::bytes_per_pixel() const {
  constexpr std::int64_t words = 4;  // averaged, bin, and two entries of the open list
  return 4 * (outputs_.records().layout.measurements + words + std::ssize(written_planes));
}

const DeviceRaw& DeviceTile::reserve_planes(std::int64_t pixels, const NoiseRatios& noise) {
  raw_.reserve_planes(queue_, pixels, outputs_.records().layout.measurements, raw_float, noise);
  return raw_;
}

void DeviceTile::find_bins(const MatchParameters& parameters, const DeviceMemory& bins) const {
  queue_.run(match_, raw_.tile().pixels, parameters, raw_.tile(), &words_, raw_.numbers(), &bins,
             &opened_, &open_);
}

void DeviceTile::start_list_of_open() {
  constexpr std::int32_t none = 0;
  queue_.upload(&none, sizeof none, opened_);
  room(open_, 2 * raw_.tile().pixels * std::int64_t{sizeof(std::int32_t)});
}

void DeviceTile::decode(const DecodedView& wanted) {
  const std::int64_t of_words = raw_.tile().pixels * std::int64_t{sizeof(std::int32_t)};
  start_list_of_open();
  if (wanted.bin && (wanted.wants_bins_only() || tables_.is_coarse))
    find_bins(tables_.bins, *room(best_bins_, of_words));
  if (wanted.wants_bins_only()) return;

  room(bins_, of_words);
  find_bins(tables_.points, bins_);
  const OutputSteps steps = outputs_.steps_for(wanted);
  OutputParameters parameters = tables_.outputs;
  parameters.finds_confidence = steps.confidence ? 1 : 0;
  parameters.finds_residual = steps.residual ? 1 : 0;
  parameters.lobe_noise = raw_.noise().of_lobes;
  parameters.residual_noise = raw_.noise().of_residual;
  std::apply(
      [&](auto... planes) {
        queue_.run(write_, raw_.tile().pixels, parameters, raw_.tile(), &words_, raw_.numbers(),
                   raw_.averaged(), &bins_, &opened_, &open_, room_for(planes, wanted)...);
      },
      written_planes);
}

/// Returns null for a plane that is not requested.
const DeviceMemory* DeviceTile::room_for(DecodedPlane plane, const DecodedView& wanted) {
  const std::size_t bytes = with_plane(
      plane, [](const auto* values) { return values ? sizeof(*values) : 0; }, wanted);
  DeviceMemory& memory = planes_[static_cast<std::size_t>(plane)];
  return bytes > 0 ? room(memory, raw_.tile().pixels * static_cast<std::int64_t>(bytes)) : nullptr;
}

void DeviceTile::fetch(const DecodedView& to) const {
  const auto fetch_plane = [&](const DeviceMemory& from, auto* plane) {
    if (plane)
      queue_.download(from, static_cast<std::size_t>(raw_.tile().pixels) * sizeof(*plane), plane);
  };
  const bool has_best_bins = to.wants_bins_only() || tables_.is_coarse;
  fetch_plane(has_best_bins ? best_bins_ : bins_, to.bin);
  if (to.bin)
    for (std::int64_t i = 0; i < raw_.tile().pixels; ++i)
      to.bin[i] = nearest_bin_of_row(to.bin[i], outputs_.constants().samples, bin_count_);
  for (const DecodedPlane written : written_planes)
    with_plane(
        written, [&](auto* values) { fetch_plane(*plane(written), values); }, to);
}

void DeviceTile::release() {
  raw_.release();
  for (DeviceMemory* memory : {&bins_, &best_bins_, &open_, &some_numbers_})
    *memory = DeviceMemory();
  planes_ = {};
}

std::vector<std::int32_t> DeviceTile::open_pixels() const {
  std::int32_t count = 0;
  queue_.download(opened_, sizeof count, &count);
  std::vector<std::int32_t> pixels(static_cast<std::size_t>(count));
  if (count > 0) queue_.download(open_, pixels.size() * sizeof(std::int32_t), pixels.data());
  return pixels;
}

std::vector<float> DeviceTile::open_numbers(const std::vector<std::int32_t>& open) {
  const auto each = static_cast<std::size_t>(outputs_.records().layout.measurements) + 1;
  std::vector<float> numbers(open.size() * each);
  if (open.empty()) return numbers;
  const std::size_t bytes = numbers.size() * sizeof(float);
  const DeviceMemory* const some = room(some_numbers_, static_cast<std::int64_t>(bytes));
  queue_.run(gather_, std::ssize(open), raw_.tile(), raw_.numbers(), raw_.averaged(), &open_,
             static_cast<std::int32_t>(open.size()), some);
  queue_.download(*some, bytes, numbers.data());
  return numbers;
}

void DeviceTile::put_depth(const std::vector<std::int32_t>& open, const std::vector<float>& depth_m,
                           const std::vector<float>& deviation_m) {
  const std::size_t bytes = open.size() * sizeof(float);
  const DeviceMemory* const some = room(some_numbers_, static_cast<std::int64_t>(bytes));
  const auto put = [&](const std::vector<float>& values, const DeviceMemory* plane) {
    queue_.upload(values.data(), bytes, *some);
    queue_.run(scatter_, std::ssize(open), &open_, static_cast<std::int32_t>(open.size()), some,
               plane);
  };
  put(depth_m, plane(DecodedPlane::depth));
  put(deviation_m, plane(DecodedPlane::deviation));
}

namespace {

constexpr std::int64_t max_tile_pixels = std::int64_t{1} << 24;

/// Calls `use` with the numbers of the open pixels, as one row.
template <typename Number, typename Use>
void with_open_numbers(const RawView& raw, std::int64_t first,
                       const std::vector<std::int32_t>& open, const Use& use) {
  const auto* data = std::get<const Number*>(raw.data);
  std::vector<Number> values;
  values.reserve(open.size() * static_cast<std::size_t>(raw.measurements));
  std::vector<float> averaged;
  for (const std::int32_t pixel : open) {
    const std::int64_t at = first + pixel, row = at / raw.width, column = at % raw.width;
    for (int k = 0; k < raw.measurements; ++k)
      values.push_back(
          data[row * raw.row_stride + column * raw.column_stride + k * raw.measurement_stride]);
    if (raw.averaged) averaged.push_back(raw.averaged[at]);
  }
  use(marked_view(
      RawView::interleaved(values.data(), 1, static_cast<int>(open.size()), raw.measurements),
      raw.averaged ? averaged.data() : nullptr, raw.noise));
}

}  // namespace

void DeviceOptions::validate() const { check_fields(*this, "DeviceOptions::"); }

DeviceDecoder::Plan::Plan(const Device& device_, const Decoder& decoder_,
                          const DeviceOptions& options_)
    : device(device_),
      decoder(decoder_),
      options(options_),
      tile(device, decoder, options.use_doubles) {
  const double most = std::min<double>(
      max_tile_pixels, double{std::numeric_limits<int>::max()} / decoder.measurements());
  tile_pixels = static_cast<std::int64_t>(
      std::clamp(0.5e6 * options.memory_mb / static_cast<double>(tile.bytes_per_pixel()),
                 static_cast<double>(min_tile_pixels), most));
}

std::int64_t DeviceDecoder::Plan::pixels_of_part(std::int64_t pixels) const {
  constexpr std::int64_t parts = 4;  // the first and last copy overlap no kernel
  const std::int64_t part = pixels <= 2 * min_overlapped_pixels
                                ? pixels
                                : std::max((pixels + parts - 1) / parts, min_overlapped_pixels);
  return std::min(part, tile_pixels);
}

void DeviceDecoder::Plan::start(DeviceTile& in, const FrameSource& frame, const FramePart& part,
                                const DecodedView& planes) {
  in.bring(frame, part.first, part.count);
  in.decode(planes);
  in.queue().flush();
}

std::int64_t DeviceDecoder::Plan::finish(DeviceTile& in, const FrameSource& frame,
                                         const FramePart& part, const DecodedView& decoded) const {
  const DecodedView planes = decoded.from(static_cast<std::size_t>(part.first));
  in.fetch(planes);
  const std::vector<std::int32_t> open = in.open_pixels();
  if (!open.empty()) decode_open_pixels_of(in, frame, part, open, planes);
  return std::ssize(open);
}

/// Reads the original numbers, because the device holds doubles as floats.
void DeviceDecoder::Plan::decode_open_pixels_of(DeviceTile& in, const FrameSource& frame,
                                                const FramePart& part,
                                                const std::vector<std::int32_t>& open,
                                                const DecodedView& planes) const {
  if (!frame.on_device)
    return std::visit(
        [&](const auto* data) {
          with_open_numbers<std::remove_cvref_t<decltype(*data)>>(
              frame.raw, part.first, open,
              [&](const RawView& numbers) { decode_open_pixels(numbers, open, planes); });
        },
        frame.raw.data);
  const int measurements = decoder.measurements();
  const OpenNumbers there(in.open_numbers(open), measurements, in.raw().noise());
  RawView view = there.view();
  std::vector<double> exact;
  if (frame.means) {
    std::vector<std::int32_t> in_frame = open;
    for (std::int32_t& pixel : in_frame) pixel += static_cast<std::int32_t>(part.first);
    exact = frame.means->open_numbers(in_frame);
    view = marked_view(
        RawView::interleaved(exact.data(), 1, static_cast<int>(open.size()), measurements),
        view.averaged, view.noise);
  }
  decode_open_pixels(view, open, planes);
}

void DeviceDecoder::Plan::decode_from(FrameDone& done, const FrameSource& frame,
                                      const DecodedView& planes, const Progress& progress) {
  const std::int64_t all = frame.pixels(), at_a_time = pixels_of_part(all);
  if (all - done.pixels > at_a_time && !other_tile)
    other_tile = std::make_unique<DeviceTile>(device, decoder, options.use_doubles);
  std::int64_t next = done.pixels;
  std::optional<FramePart> pending;
  for (DeviceTile *here = &tile, *there = other_tile.get(); next < all || pending;
       std::swap(here, there)) {
    const std::optional<FramePart> before = std::exchange(pending, std::nullopt);
    if (next < all) {
      pending = FramePart{next, std::min(all - next, at_a_time)};
      start(*here, frame, *pending, planes);
      next += pending->count;
    }
    if (!before) continue;
    done.by_decoder += finish(*there, frame, *before, planes);
    done.pixels = before->first + before->count;
    report(progress, static_cast<double>(done.pixels) / static_cast<double>(all), "decoding");
  }
}

std::int64_t DeviceDecoder::Plan::decode_all(const FrameSource& frame, const DecodedView& planes,
                                             const Progress& progress) {
  FrameDone done;
  while (done.pixels < frame.pixels()) {
    const std::int64_t before = tile_pixels;
    try {
      decode_from(done, frame, planes, progress);
    } catch (const OutOfDeviceMemory&) {
      if (before <= min_tile_pixels) throw;
      tile.release();
      other_tile.reset();
      const std::int64_t tried = std::min(before, frame.pixels() - done.pixels);
      tile_pixels = std::max(tried / 2, min_tile_pixels);
    }
  }
  return done.by_decoder;
}

std::int64_t DeviceDecoder::Plan::decode_what_is_there(const DecodedView& planes) {
  tile.decode(planes);
  tile.fetch(planes);
  const std::vector<std::int32_t> open = tile.open_pixels();
  if (!open.empty())
    decode_open_pixels(
        OpenNumbers(tile.open_numbers(open), decoder.measurements(), tile.raw().noise()).view(),
        open, planes);
  return std::ssize(open);
}

void DeviceDecoder::Plan::decode_open_pixels(const RawView& numbers,
                                             const std::vector<std::int32_t>& open,
                                             const DecodedView& decoded) const {
  DepthImage image(decoded.planes(), 1, static_cast<int>(open.size()));
  decoder.decode(numbers, DecodedView::of(image));
  for_each_plane(
      [&](const auto& from, auto* to) {
        if (to)
          for (std::size_t i = 0; i < open.size(); ++i) to[open[i]] = from.pixels[i];
      },
      image, decoded);
}

DeviceDecoder::DeviceDecoder(const Device& device, const Decoder& decoder,
                             const DeviceOptions& options) {
  options.validate();
  plan_ = make_hidden<Plan>(device, decoder, options);
}

const Device& DeviceDecoder::device() const { return plan_->device; }

std::int64_t DeviceDecoder::decode(const RawView& stored, const DecodedView& decoded,
                                   const Progress& progress) const {
  require_frame(stored, plan_->decoder.measurements());
  const MarkedRaw marked(stored, plan_->decoder.table().marking);
  const RawView& raw = marked.view();
  const std::lock_guard lock(plan_->mutex);
  return plan_->decode_all({.raw = raw}, decoded, progress);
}

std::int64_t DeviceDecoder::decode_source(const FrameSource& frame, const Device& its_device,
                                          const DecodedView& decoded,
                                          const Progress& progress) const {
  require(&its_device.state() == &device().state(), "decoder's device", device().info().name,
          "must be the device of the frame, or a copy of it");
  require_frame(frame.raw, plan_->decoder.measurements());
  const std::lock_guard lock(plan_->mutex);
  return plan_->decode_all(frame, decoded, progress);
}

}  // namespace tofsmith
