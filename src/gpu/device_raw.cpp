// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_raw.hpp"

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/shared/pixel_runs.hpp"

namespace tofsmith {

namespace {

/// Returns pixels without gaps; doubles become floats unless `exactly`.
template <bool exactly, typename Number>
auto packed(const RawView& raw, std::int64_t first, std::int64_t count) {
  using Packed = std::conditional_t<std::is_same_v<Number, double> && !exactly, float, Number>;
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

template <bool exactly, typename Number>
constexpr RawNumber raw_number_of() {
  if (std::is_same_v<Number, std::uint16_t>) return raw_uint16;
  if (std::is_same_v<Number, std::uint8_t>) return raw_uint8;
  if (std::is_same_v<Number, double>) return exactly ? raw_double : raw_rounded;
  return raw_float;
}

}  // namespace

DeviceMemory* reserve(const DeviceQueue& queue, DeviceMemory& memory, std::int64_t bytes) {
  if (memory.bytes < static_cast<std::size_t>(bytes)) {
    memory = DeviceMemory();
    memory = queue.allocate(static_cast<std::size_t>(bytes));
  }
  return &memory;
}

template <bool exactly>
void DeviceRaw::upload_numbers(const DeviceQueue& queue, const RawView& view, std::int64_t first,
                               std::int64_t count) {
  tile_ = {.pixels = static_cast<int>(count),
           .pixel_stride = view.measurements,
           .measurement_stride = 1,
           .number = raw_float};
  std::visit(
      [&](const auto* data) {
        using Number = std::remove_cvref_t<decltype(*data)>;
        const auto upload = [&](const auto* numbers) {
          const std::int64_t bytes = count * view.measurements * std::int64_t{sizeof(*numbers)};
          queue.upload(numbers, static_cast<std::size_t>(bytes), *reserve(queue, numbers_, bytes));
        };
        tile_.number = raw_number_of<exactly, Number>();
        if (is_packed(view) && tile_.number != raw_rounded)
          upload(data + first * view.measurements);
        else
          upload(packed<exactly, Number>(view, first, count).data());
      },
      view.data);
}

void DeviceRaw::upload(const DeviceQueue& queue, const RawView& view, std::int64_t first,
                       std::int64_t count) {
  upload_numbers<false>(queue, view, first, count);
  has_averaged_ = view.averaged != nullptr;
  noise_ = view.noise;
  const std::int64_t bytes = count * std::int64_t{sizeof(float)};
  if (has_averaged_)
    queue.upload(view.averaged + first, static_cast<std::size_t>(bytes),
                 *reserve(queue, averaged_, bytes));
}

void DeviceRaw::upload_exactly(const DeviceQueue& queue, const RawView& view) {
  upload_numbers<true>(queue, view, 0, view.pixels());
  has_averaged_ = false;
  noise_ = {};
}

void DeviceRaw::copy(const DeviceQueue& queue, const DeviceRaw& frame, int measurements,
                     std::int64_t first, std::int64_t count) {
  reserve_planes(queue, count, measurements, static_cast<RawNumber>(frame.tile_.number),
                 frame.noise_);
  const std::size_t bytes = static_cast<std::size_t>(count) * sizeof(float),
                    from = static_cast<std::size_t>(first) * sizeof(float),
                    plane = static_cast<std::size_t>(frame.tile_.pixels) * sizeof(float);
  for (std::size_t k = 0; k < static_cast<std::size_t>(measurements); ++k)
    queue.copy(frame.numbers_, k * plane + from, numbers_, k * bytes, bytes);
  queue.copy(frame.averaged_, from, averaged_, 0, bytes);
}

void DeviceRaw::reserve_planes(const DeviceQueue& queue, std::int64_t pixels, int measurements,
                               RawNumber number, const NoiseRatios& noise) {
  tile_ = {.pixels = static_cast<int>(pixels),
           .pixel_stride = 1,
           .measurement_stride = static_cast<int>(pixels),
           .number = number};
  has_averaged_ = true;
  noise_ = noise;
  const std::int64_t bytes = pixels * std::int64_t{sizeof(float)};
  reserve(queue, numbers_, bytes * measurements);
  reserve(queue, averaged_, bytes);
}

void DeviceRaw::release() {
  numbers_ = DeviceMemory();
  averaged_ = DeviceMemory();
}

DeviceMeans::DeviceMeans(const Device& device, const SaturationLevels& levels)
    : queue_(device), levels_(levels) {
  require(device.info().has_doubles, "device", device.info().name,
          "must support double precision for means of frames");
  const std::string options = "-DHAS_DOUBLES";
  add_to_sums_ = queue_.kernel(mean_kernels, options, "add_to_sums");
  write_means_ = queue_.kernel(mean_kernels, options, "write_means");
  gather_means_ = queue_.kernel(mean_kernels, options, "gather_means");
}

void DeviceMeans::add(const RawView& raw) {
  Sums& sums = sums_;
  sums.pixels = static_cast<std::int32_t>(raw.pixels());
  measurements_ = raw.measurements;
  frame_.upload_exactly(queue_, raw);
  reserve(queue_, sums.memory, raw.pixels() * measurements_ * std::int64_t{sizeof(double)});
  queue_.run(add_to_sums_, sums.pixels, frame_.tile(), frame_.numbers(), measurements_,
             levels_.lowest, levels_.highest, frames_ == 0 ? 1 : 0, &sums.memory);
  ++frames_;
}

void DeviceMeans::finish(double averaged) {
  Sums& sums = sums_;
  sums.frames = std::exchange(frames_, 0);
  result_.reserve_planes(queue_, sums.pixels, measurements_, raw_rounded);
  queue_.run(write_means_, sums.pixels, sums.pixels, measurements_, sums.frames, levels_.lowest,
             levels_.highest, static_cast<float>(averaged * sums.frames), &sums.memory,
             result_.numbers(), result_.averaged());
}

std::vector<double> DeviceMeans::open_numbers(const std::vector<std::int32_t>& pixels) {
  const Sums& sums = sums_;
  std::vector<double> numbers(pixels.size() * static_cast<std::size_t>(measurements_));
  const std::size_t bytes = numbers.size() * sizeof(double),
                    bytes_of_wanted = pixels.size() * sizeof(std::int32_t);
  queue_.upload(pixels.data(), bytes_of_wanted,
                *reserve(queue_, wanted_, static_cast<std::int64_t>(bytes_of_wanted)));
  reserve(queue_, gathered_, static_cast<std::int64_t>(bytes));
  queue_.run(gather_means_, std::ssize(pixels), sums.pixels, measurements_, sums.frames,
             levels_.lowest, levels_.highest, &sums.memory, &wanted_,
             static_cast<std::int32_t>(pixels.size()), &gathered_);
  queue_.download(gathered_, bytes, numbers.data());
  return numbers;
}

std::vector<double> DeviceMeans::numbers() const {
  const Sums& sums = sums_;
  std::vector<double> numbers(static_cast<std::size_t>(sums.pixels) *
                              static_cast<std::size_t>(measurements_));
  queue_.download(sums.memory, numbers.size() * sizeof(double), numbers.data());
  for (double& sum : numbers) sum = levels_.mean(sum, sums.frames);
  return numbers;
}

}  // namespace tofsmith
