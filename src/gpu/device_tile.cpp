// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_tile.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

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
  view.averaged = averaged_.data();
  view.noise = noise_;
  view.is_marked = true;
  return view;
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
  OutputParameters parameters = tables_.outputs;
  parameters.finds_confidence = outputs_.needs_confidence(wanted) ? 1 : 0;
  parameters.finds_residual = outputs_.needs_residuals(wanted) ? 1 : 0;
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
    for (std::int64_t i = 0; i < raw_.tile().pixels; ++i) to.bin[i] = nearest_bin(to.bin[i]);
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

}  // namespace tofsmith
