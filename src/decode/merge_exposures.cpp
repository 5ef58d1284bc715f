// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/shared/pixel_runs.hpp"
#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/merge_exposures.hpp"

namespace tofsmith {

namespace {

struct Taps {
  std::vector<double> black_level, gain_e_per_raw;
  double constant_variance_e2 = 0.0;  // mean over measurements
  SaturationLevels levels;

  explicit Taps(const DecodingTable& table)
      : black_level(table.black_level.begin(), table.black_level.end()),
        gain_e_per_raw(table.gain_e_per_raw.begin(), table.gain_e_per_raw.end()),
        constant_variance_e2(table.constant_variance_e2.mean()),
        levels(table) {}
};

class Bracket {
 public:
  Bracket(const Taps& taps, std::span<const double> exposures)
      : taps_(taps),
        exposures_(exposures),
        measurements_(taps.black_level.size()),
        raw_(exposures.size() * measurements_),
        averaged_(exposures.size()),
        usable_(exposures.size()) {}

  double* raw(std::size_t frame) { return raw_.data() + frame * measurements_; }
  void set_averaged(std::size_t frame, double averaged) { averaged_[frame] = averaged; }

  /// @param merged  K raw values
  /// @return number of averaged measurements of the shortest exposure with the same variance
  double merge(float* merged) {
    std::size_t shortest_clipped = exposures_.size();
    bool any = false;
    for (std::size_t f = 0; f < exposures_.size(); ++f) {
      const double* const numbers = raw(f);
      const bool valid = std::all_of(numbers, numbers + measurements_,
                                     [](double number) { return std::isfinite(number); });
      const bool clips = valid && std::any_of(numbers, numbers + measurements_,
                                              [&](double n) { return taps_.levels.clip(n); });
      usable_[f] = valid && !clips;
      any = any || usable_[f];
      if (clips &&
          (shortest_clipped == exposures_.size() || exposures_[f] < exposures_[shortest_clipped]))
        shortest_clipped = f;
    }
    if (any) return merge_usable(merged);
    for (std::size_t k = 0; k < measurements_; ++k)
      merged[k] = shortest_clipped < exposures_.size()
                      ? static_cast<float>(raw(shortest_clipped)[k])
                      : std::numeric_limits<float>::quiet_NaN();
    return 1.0;
  }

 private:
  double electrons(std::size_t frame, std::size_t k) {
    return (raw(frame)[k] - taps_.black_level[k]) * taps_.gain_e_per_raw[k];
  }

  double merge_usable(float* merged) {
    double all_exposure = 0.0;
    for (std::size_t f = 0; f < exposures_.size(); ++f)
      if (usable_[f]) all_exposure += exposures_[f];
    double shot_e2 = 0.0;
    for (std::size_t k = 0; k < measurements_; ++k) {
      double sum_e = 0.0;
      for (std::size_t f = 0; f < exposures_.size(); ++f)
        if (usable_[f]) sum_e += electrons(f, k);
      shot_e2 += std::abs(sum_e) / all_exposure / static_cast<double>(measurements_);
    }
    const double constant_e2 = taps_.constant_variance_e2;
    const bool noisy = shot_e2 + constant_e2 > 0.0;
    double all_weights = 0.0;
    sums_.assign(measurements_, 0.0);
    for (std::size_t f = 0; f < exposures_.size(); ++f) {
      if (!usable_[f]) continue;
      const double e = exposures_[f];
      const double weight =
          averaged_[f] * (noisy ? e * e / (e * shot_e2 + constant_e2) : e);  // 1 / variance
      all_weights += weight;
      for (std::size_t k = 0; k < measurements_; ++k) sums_[k] += weight / e * electrons(f, k);
    }
    for (std::size_t k = 0; k < measurements_; ++k)
      merged[k] = static_cast<float>(taps_.black_level[k] +
                                     sums_[k] / all_weights / taps_.gain_e_per_raw[k]);
    return all_weights * (noisy ? shot_e2 + constant_e2 : 1.0);
  }

  const Taps& taps_;
  std::span<const double> exposures_;
  std::size_t measurements_;
  std::vector<double> raw_, averaged_, sums_;
  std::vector<char> usable_;
};

}  // namespace

void check_exposures(std::span<const double> exposures, const std::string& field) {
  require(exposures.size() >= 2, field, exposures.size(), "must be at least 2");
  for (const double e : exposures)
    require(std::isfinite(e) && e >= 1.0 && e <= 1e6, field, e,
            "each must be in [1, 1e6]: the ratio to the shortest exposure, which is the camera's "
            "exposure_s");
  require(*std::min_element(exposures.begin(), exposures.end()) == 1.0, field,
          *std::min_element(exposures.begin(), exposures.end()),
          "must contain 1: the shortest exposure, which is the camera's exposure_s");
}

void merge_exposures(std::span<const RawView> stored, std::span<const double> exposures,
                     const DecodingTable& table, MergedExposures& merged) {
  std::vector<std::vector<std::byte>> buffers(stored.size());
  std::vector<RawView> frames;
  for (std::size_t f = 0; f < stored.size(); ++f)
    frames.push_back(mark_raw(stored[f], table.marking, buffers[f]));
  check_exposures(exposures, "exposures");
  require_exposures(table, "merging exposures");
  require(frames.size() == exposures.size(), "frames", frames.size(),
          fmt::format("must be {}, one for each exposure", exposures.size()));
  const RawView& first = frames.front();
  for (const RawView& raw : frames)
    require(raw.height == first.height && raw.width == first.width &&
                raw.measurements == table.measurements(),
            "frame size", fmt::format("({}, {}, {})", raw.height, raw.width, raw.measurements),
            fmt::format("must be ({}, {}, {}), like the first frame and the table", first.height,
                        first.width, table.measurements()));
  const auto measurements = static_cast<std::size_t>(table.measurements());
  merged.values.frames = 1;
  merged.values.height = first.height;
  merged.values.width = first.width;
  merged.values.measurements = table.measurements();
  merged.values.values.resize(static_cast<std::size_t>(first.pixels()) * measurements);
  if (merged.averaged.height != first.height || merged.averaged.width != first.width)
    merged.averaged = Image<float>(first.height, first.width);

  const Taps taps(table);
  parallel_for(first.height, [&](std::int64_t row) {
    const std::int64_t from = row * first.width;
    const auto width = static_cast<std::size_t>(first.width);
    std::vector<double> numbers(frames.size() * width * measurements);
    for (std::size_t f = 0; f < frames.size(); ++f) {
      double* number = numbers.data() + f * width * measurements;
      const RawView& raw = frames[f];
      for_each_run(raw, from, first.width,
                   [&](const auto* pixel, std::int64_t length, std::int64_t) {
                     for (std::int64_t x = 0; x < length; ++x, pixel += raw.column_stride)
                       for (std::size_t k = 0; k < measurements; ++k, ++number)
                         *number = static_cast<double>(
                             pixel[static_cast<std::ptrdiff_t>(k) * raw.measurement_stride]);
                   });
    }
    Bracket bracket(taps, exposures);
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t at = static_cast<std::size_t>(from) + x;
      for (std::size_t f = 0; f < frames.size(); ++f) {
        std::copy_n(numbers.data() + (f * width + x) * measurements, measurements, bracket.raw(f));
        bracket.set_averaged(
            f, frames[f].averaged ? static_cast<double>(frames[f].averaged[at]) : 1.0);
      }
      merged.averaged.pixels[at] =
          static_cast<float>(bracket.merge(merged.values.values.data() + at * measurements));
    }
  });
}

RawView MergedExposures::view() const {
  return marked_view(
      RawView::interleaved(values.values.data(), values.height, values.width, values.measurements),
      averaged.pixels.data());
}

}  // namespace tofsmith
