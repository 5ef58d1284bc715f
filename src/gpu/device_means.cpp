// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_means.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace tofsmith {

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
