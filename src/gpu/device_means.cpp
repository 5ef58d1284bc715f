// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_means.hpp"

#include <cmath>
#include <limits>
#include <string>

namespace tofsmith {

DeviceMeans::DeviceMeans(const Device& device, std::optional<float> saturation_level)
    : queue_(device), clipped_(saturation_level.value_or(std::numeric_limits<float>::infinity())) {
  require(device.info().has_doubles, "device", device.info().name,
          "must have doubles for means of frames");
  const std::string options = "-DHAS_DOUBLES";
  add_to_sums_ = queue_.kernel(mean_kernels, options, "add_to_sums");
  write_means_ = queue_.kernel(mean_kernels, options, "write_means");
  gather_means_ = queue_.kernel(mean_kernels, options, "gather_means");
}

void DeviceMeans::add(const RawView& raw) {
  pixels_ = static_cast<std::int32_t>(raw.pixels());
  measurements_ = raw.measurements;
  frame_.upload_exactly(queue_, raw);
  reserve(queue_, sums_, raw.pixels() * measurements_ * std::int64_t{sizeof(double)});
  queue_.run(add_to_sums_, pixels_, frame_.tile(), frame_.numbers(), measurements_, clipped_,
             frames_ == 0 ? 1 : 0, &sums_);
  ++frames_;
}

void DeviceMeans::finish(double averaged) {
  frames_of_mean_ = frames_;
  frames_ = 0;
  result_.reserve_planes(queue_, pixels_, measurements_, raw_rounded);
  queue_.run(write_means_, pixels_, pixels_, measurements_, frames_of_mean_, clipped_,
             static_cast<float>(averaged * frames_of_mean_), &sums_, result_.numbers(),
             result_.averaged());
}

std::vector<double> DeviceMeans::numbers_of(const std::vector<std::int32_t>& pixels) {
  std::vector<double> numbers(pixels.size() * static_cast<std::size_t>(measurements_));
  const std::size_t bytes = numbers.size() * sizeof(double),
                    bytes_of_wanted = pixels.size() * sizeof(std::int32_t);
  queue_.upload(pixels.data(), bytes_of_wanted,
                *reserve(queue_, wanted_, static_cast<std::int64_t>(bytes_of_wanted)));
  reserve(queue_, gathered_, static_cast<std::int64_t>(bytes));
  queue_.run(gather_means_, std::ssize(pixels), pixels_, measurements_, frames_of_mean_, clipped_,
             &sums_, &wanted_, static_cast<std::int32_t>(pixels.size()), &gathered_);
  queue_.download(gathered_, bytes, numbers.data());
  return numbers;
}

std::vector<double> DeviceMeans::numbers() const {
  std::vector<double> numbers(static_cast<std::size_t>(pixels_) *
                              static_cast<std::size_t>(measurements_));
  queue_.download(sums_, numbers.size() * sizeof(double), numbers.data());
  for (double& sum : numbers)
    sum = std::isinf(sum) ? static_cast<double>(clipped_) : sum / frames_of_mean_;
  return numbers;
}

}  // namespace tofsmith
