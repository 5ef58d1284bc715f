// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_tile.hpp"

#include <type_traits>

#include "core/shared/pixel_runs.hpp"

namespace tofsmith {

namespace {

/// Numbers of pixels first .. first + count - 1 side by side, doubles as floats.
template <typename Number>
auto packed(const RawView& raw, std::int64_t first, std::int64_t count) {
  using Packed = std::conditional_t<std::is_same_v<Number, double>, float, Number>;
  std::vector<Packed> values(static_cast<std::size_t>(count * raw.measurements));
  for_each_run(raw, first, count, [&](const auto* from, std::int64_t length, std::int64_t done) {
    Packed* to = &values[static_cast<std::size_t>(done * raw.measurements)];
    for (std::int64_t i = 0; i < length; ++i)
      for (int k = 0; k < raw.measurements; ++k)
        *to++ = static_cast<Packed>(from[i * raw.column_stride + k * raw.measurement_stride]);
  });
  return values;
}

bool is_packed(const RawView& raw) {
  return raw.measurement_stride == 1 && raw.column_stride == raw.measurements &&
         raw.row_stride == raw.width * raw.column_stride;
}

template <typename Number>
constexpr RawNumber raw_number_of() {
  if (std::is_same_v<Number, std::uint16_t>) return raw_uint16;
  if (std::is_same_v<Number, std::uint8_t>) return raw_uint8;
  return std::is_same_v<Number, double> ? raw_rounded : raw_float;
}

}  // namespace

DeviceTile::DeviceTile(const Device& device, const Decoder& decoder, bool use_doubles)
    : outputs_(parts_of(decoder).outputs),
      tables_(decoder, use_doubles && device.info().has_doubles),
      queue_(device),
      match_(queue_.kernel(decode_kernels, tables_.options, "match")),
      write_(queue_.kernel(decode_kernels, tables_.options, "write_planes")),
      words_(queue_.allocate(tables_.words.size() * sizeof(std::uint32_t))),
      opened_(queue_.allocate(sizeof(std::int32_t))) {
  queue_.upload(tables_.words.data(), words_.bytes, words_);
}

std::int64_t DeviceTile::bytes_per_pixel() const {
  constexpr std::int64_t words = 11;  // averaged, bins, second peaks, open ones, planes
  return 4 * (outputs_.records().layout.measurements + words);
}

DeviceMemory* DeviceTile::reserve(DeviceMemory& memory, std::int64_t bytes) const {
  if (memory.bytes < static_cast<std::size_t>(bytes)) {
    memory = DeviceMemory();  // the smaller one goes first
    memory = queue_.allocate(static_cast<std::size_t>(bytes));
  }
  return &memory;
}

void DeviceTile::upload(const RawView& view, std::int64_t first, std::int64_t count) {
  tile_ = {.pixels = static_cast<int>(count),
           .pixel_stride = view.measurements,
           .measurement_stride = 1,
           .number = raw_float};
  std::visit(
      [&](const auto* data) {
        using Number = std::remove_cvref_t<decltype(*data)>;
        const auto upload_numbers = [&](const auto* numbers) {
          const std::int64_t bytes = count * view.measurements * std::int64_t{sizeof(*numbers)};
          queue_.upload(numbers, static_cast<std::size_t>(bytes), *reserve(raw_, bytes));
        };
        tile_.number = raw_number_of<Number>();
        if (is_packed(view) && !std::is_same_v<Number, double>)
          upload_numbers(data + first * view.measurements);
        else
          upload_numbers(packed<Number>(view, first, count).data());
      },
      view.data);
  has_averaged_ = view.averaged != nullptr;
  if (has_averaged_)
    queue_.upload(view.averaged + first, static_cast<std::size_t>(count) * sizeof(float),
                  *reserve_for(view.averaged, averaged_));
}

void DeviceTile::find_bins(const MatchParameters& parameters, const DeviceMemory& bins,
                           const DeviceMemory* second_peaks) const {
  queue_.run(match_, tile_.pixels, parameters, tile_, &words_, &raw_, second_peaks ? 1 : 0, &bins,
             second_peaks, &opened_, &open_);
}

void DeviceTile::decode(const DecodedView& wanted) {
  const std::int64_t of_words = tile_.pixels * std::int64_t{sizeof(std::int32_t)};
  constexpr std::int32_t none = 0;
  queue_.upload(&none, sizeof none, opened_);
  reserve(open_, 2 * of_words);
  if (wanted.bin && (wanted.wants_bins_only() || tables_.is_coarse))
    find_bins(tables_.bins, *reserve(best_bins_, of_words), nullptr);
  if (wanted.wants_bins_only()) return;

  reserve(bins_, of_words);
  const DeviceMemory* second_peaks =
      outputs_.needs_second_peaks(wanted) ? reserve(second_peaks_, of_words) : nullptr;
  find_bins(tables_.points, bins_, second_peaks);
  OutputParameters parameters = tables_.outputs;
  parameters.finds_confidence = second_peaks ? 1 : 0;
  queue_.run(write_, tile_.pixels, parameters, tile_, &words_, &raw_,
             has_averaged_ ? &averaged_ : nullptr, &bins_, second_peaks,
             reserve_for(wanted.depth_m, depth_), reserve_for(wanted.signal_e_per_s, signal_),
             reserve_for(wanted.ambient_e_per_s, ambient_),
             reserve_for(wanted.confidence, confidence_),
             reserve_for(wanted.predicted_standard_deviation_m, deviation_),
             reserve_for(wanted.status, status_));
}

void DeviceTile::fetch(const DecodedView& to) const {
  const auto fetch_plane = [&](const DeviceMemory& from, auto* plane) {
    if (plane)
      queue_.download(from, static_cast<std::size_t>(tile_.pixels) * sizeof(*plane), plane);
  };
  const bool has_best_bins = to.wants_bins_only() || tables_.is_coarse;
  fetch_plane(has_best_bins ? best_bins_ : bins_, to.bin);
  fetch_plane(depth_, to.depth_m);
  fetch_plane(signal_, to.signal_e_per_s);
  fetch_plane(ambient_, to.ambient_e_per_s);
  fetch_plane(confidence_, to.confidence);
  fetch_plane(deviation_, to.predicted_standard_deviation_m);
  fetch_plane(status_, to.status);
}

void DeviceTile::release() {
  for (DeviceMemory* memory : {&raw_, &averaged_, &bins_, &best_bins_, &second_peaks_, &open_,
                               &depth_, &signal_, &ambient_, &confidence_, &deviation_, &status_})
    *memory = DeviceMemory();
}

std::vector<std::int32_t> DeviceTile::open_pixels() const {
  std::int32_t count = 0;
  queue_.download(opened_, sizeof count, &count);
  std::vector<std::int32_t> pixels(static_cast<std::size_t>(count));
  if (count > 0) queue_.download(open_, pixels.size() * sizeof(std::int32_t), pixels.data());
  return pixels;
}

}  // namespace tofsmith
