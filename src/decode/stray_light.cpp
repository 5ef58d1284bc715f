// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/shared/periodic.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/stray_light.hpp"

namespace tofsmith {

namespace {

constexpr int max_rounds = 60;
constexpr double converged = 1e-6;  // relative to the largest light

}  // namespace

struct StrayLight::Plan {
  PaddedConvolution convolution;
  int height, width;
};

StrayLight::StrayLight(Image<float> kernel) : kernel_(std::move(kernel)) {
  require(kernel_.height % 2 == 1 && kernel_.width % 2 == 1, "kernel size",
          fmt::format("{} x {}", kernel_.height, kernel_.width),
          "must be odd, with the pixel itself in the middle");
  for (const float value : kernel_.pixels)
    require(std::isfinite(value) && value >= 0.0F, "kernel", value,
            "each must be finite and >= 0: a share of a pixel's light");
  share_ = std::accumulate(kernel_.pixels.begin(), kernel_.pixels.end(), 0.0);
  require(share_ < 0.5, "sum of the kernel", share_,
          "must be < 0.5: the share of light that is scattered");
}

const StrayLight::Plan& StrayLight::plan_of(int height, int width) {
  if (!plan_ || plan_->height != height || plan_->width != width)
    plan_ = make_hidden<Plan>(Plan{{kernel_, height, width}, height, width});
  return *plan_;
}

double StrayLight::memory_bytes(int height, int width, int measurements) const {
  return PaddedConvolution::bytes(kernel_, height, width) * (1.0 + measurements) +
         16.0 * height * width * measurements;
}

Image<float> StrayLight::scatter(const Image<float>& light) {
  const Plan& plan = plan_of(light.height, light.width);
  Image<float> seen = plan.convolution.apply(light);
  for (std::size_t i = 0; i < seen.pixels.size(); ++i)
    seen.pixels[i] += static_cast<float>(1.0 - share_) * light.pixels[i];
  return seen;
}

Image<float> StrayLight::gather(const Image<float>& seen) {
  return gathered(plan_of(seen.height, seen.width), seen);
}

Image<float> StrayLight::gathered(const Plan& plan, const Image<float>& seen) const {
  Image<float> light = seen;
  const auto direct = static_cast<float>(1.0 / (1.0 - share_));
  for (int round = 0; round < max_rounds; ++round) {
    const Image<float> stray = plan.convolution.apply(light);
    float change = 0.0F, largest = 0.0F;
    for (std::size_t i = 0; i < light.pixels.size(); ++i) {
      const float next = direct * (seen.pixels[i] - stray.pixels[i]);
      change = std::max(change, std::abs(next - light.pixels[i]));
      largest = std::max(largest, std::abs(next));
      light.pixels[i] = next;
    }
    if (static_cast<double>(change) <= converged * static_cast<double>(largest)) break;
  }
  return light;
}

void StrayLight::remove(const RawView& stored, const DecodingTable& table, RawFrames& clean) {
  const MarkedRaw marked(stored, table.marking);
  const RawView& raw = marked.view();
  require(raw.measurements == table.measurements(), "measurements", raw.measurements,
          fmt::format("must be {}, like the table's", table.measurements()));
  const Plan& plan = plan_of(raw.height, raw.width);
  const auto measurements = static_cast<std::size_t>(raw.measurements);
  clean.frames = 1;
  clean.height = raw.height;
  clean.width = raw.width;
  clean.measurements = raw.measurements;
  clean.values.resize(static_cast<std::size_t>(raw.pixels()) * measurements);
  copy_pixels(raw, 0, raw.pixels(), clean.values.data());
  const SaturationLevels levels(table);
  const float highest = std::nextafter(levels.highest, -INFINITY),
              lowest = std::nextafter(levels.lowest, INFINITY);
  const auto unknown = static_cast<float>(RawMarking().saturated_above);
  parallel_for(raw.measurements, [&](std::int64_t measurement) {
    const auto k = static_cast<std::size_t>(measurement);
    const auto black = static_cast<float>(table.black_level[measurement]);
    // Unknown light scatters none; saturated pixels scatter at least their measured light.
    Image<float> seen(raw.height, raw.width);
    for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
      const float number = clean.values[i * measurements + k];
      seen.pixels[i] = std::abs(number) < unknown ? number - black : 0.0F;
    }
    const Image<float> light = gathered(plan, seen);
    for (std::size_t i = 0; i < light.pixels.size(); ++i) {
      float& number = clean.values[i * measurements + k];
      if (std::isfinite(number) && !levels.clip(number))
        number = std::clamp(black + light.pixels[i], lowest, highest);
    }
  });
}

}  // namespace tofsmith
