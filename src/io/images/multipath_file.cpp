// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/depth_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

namespace {

std::vector<double> list(const NpzReader& file, const std::filesystem::path& path,
                         const char* name) {
  const NpyArray array = file.read(name);
  if (array.axes() != 1)
    throw IoError(path.string(), fmt::format("array '{}': found shape {}; expected one axis", name,
                                             describe_shape(array.shape())));
  return array.to_doubles();
}

/// Estimates the background as the median.
void subtract_median(std::vector<double>& light) {
  const double median = median_of(light);
  for (double& bin : light) bin = std::max(bin - median, 0.0);
}

void check_bins(const std::vector<double>& light, const std::filesystem::path& path,
                std::size_t pixel) {
  for (std::size_t i = 0; i < light.size(); ++i)
    if (!(std::isfinite(light[i]) && light[i] >= 0.0))
      throw IoError(path.string(),
                    fmt::format("pixel {}, bin {}: found {}; expected a number >= 0 (subtract "
                                "background by --transient-background median, not by hand)",
                                pixel, i, light[i]));
}

template <typename Item>
NpyArray as_array(NpyShape shape, const std::vector<Item>& values) {
  return NpyArray::of<Item>(std::move(shape), values);
}

}  // namespace

MultipathReturns read_multipath_returns(const std::filesystem::path& path, int height, int width) {
  const NpzReader file(path);
  const std::vector<double> first = list(file, path, "first"),
                            distance_m = list(file, path, "distance_m"),
                            ratio = list(file, path, "ratio");
  const std::size_t pixels = static_cast<std::size_t>(height) * static_cast<std::size_t>(width);
  if (first.size() != pixels + 1)
    throw IoError(path.string(),
                  fmt::format("array 'first': found {} entries; expected {}, one more than the "
                              "scene's {} x {} pixels",
                              first.size(), pixels + 1, height, width));
  if (distance_m.size() != ratio.size())
    throw IoError(
        path.string(),
        fmt::format(
            "array 'ratio': found {} entries; expected {}, the number of entries of 'distance_m'",
            ratio.size(), distance_m.size()));
  MultipathReturns returns(height, width);
  returns.first.clear();
  for (const double at : first) {
    if (!(at >= 0.0 && at <= static_cast<double>(ratio.size()) && at == std::floor(at)))
      throw IoError(path.string(),
                    fmt::format("array 'first', entry {}: found {}; expected a whole number in "
                                "[0, {}]",
                                returns.first.size(), at, ratio.size()));
    returns.first.push_back(static_cast<std::int64_t>(at));
  }
  for (std::size_t i = 0; i < ratio.size(); ++i)
    returns.returns.push_back({static_cast<float>(distance_m[i]), static_cast<float>(ratio[i])});
  return returns;
}

std::vector<Transient> read_transients(const std::filesystem::path& path, int height, int width,
                                       const TransientFileOptions& options) {
  check_fields(options, "TransientFileOptions::");
  const NpyArray array = read_npy(path);
  const NpyShape& shape = array.shape();
  const auto rows = static_cast<std::size_t>(height), columns = static_cast<std::size_t>(width);
  const bool is_one = shape.size() == 1;
  if ((!is_one && !(shape.size() == 3 && shape[0] == rows && shape[1] == columns)) ||
      shape.back() == 0)
    throw IoError(path.string(),
                  fmt::format("found shape {}; expected one histogram (T,) or one for each of the "
                              "scene's pixels, ({}, {}, T)",
                              describe_shape(shape), height, width));
  const std::vector<double> values = array.to_doubles();
  const std::size_t bins = shape.back(), count = values.size() / bins;
  std::vector<Transient> transients(count);
  std::vector<double> sum(bins, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double>& light = transients[i].light;
    light.assign(values.begin() + static_cast<std::ptrdiff_t>(i * bins),
                 values.begin() + static_cast<std::ptrdiff_t>((i + 1) * bins));
    check_bins(light, path, i);
    if (options.background == TransientBackground::median) subtract_median(light);
    std::transform(light.begin(), light.end(), sum.begin(), sum.begin(), std::plus());
  }
  const double bin_m = 0.5 * speed_of_light_m_per_s * options.bin_s;
  const auto peak = std::max_element(sum.begin(), sum.end()) - sum.begin();
  const double first_m =
      options.origin == TransientOrigin::peak ? -bin_m * (static_cast<double>(peak) + 0.5) : 0.0;
  for (Transient& transient : transients) transient.bin_m = bin_m, transient.first_m = first_m;
  return transients;
}

void write_multipath_truth(const std::filesystem::path& path, const MultipathTruth& truth,
                           const SceneLight& light, OutputPolicy policy) {
  const auto height = static_cast<std::size_t>(truth.direct_m.height),
             width = static_cast<std::size_t>(truth.direct_m.width);
  NpzArrays arrays;
  arrays.emplace("depth_m", as_array({height, width}, truth.direct_m.pixels));
  arrays.emplace("direct_e_per_s", as_array({height, width}, truth.direct_e_per_s.pixels));
  arrays.emplace("first", as_array({truth.first.size()}, truth.first));
  arrays.emplace("distance_m", as_array({truth.distance_m.size()}, truth.distance_m));
  arrays.emplace("signal_e_per_s", as_array({truth.signal_e_per_s.size()}, truth.signal_e_per_s));
  std::vector<float> ratio;
  for (const MultipathReturn& later : light.returns.returns) ratio.push_back(later.ratio);
  arrays.emplace("ratio", as_array({ratio.size()}, ratio));
  if (light.tail)
    arrays.emplace("tail",
                   as_array({2}, std::vector<double>{light.tail->mean_delay_m, light.tail->ratio}));
  if (!light.transients.empty()) {
    const std::size_t bins = light.transients.front().light.size();
    std::vector<double> shares;
    for (const Transient& transient : light.transients)
      for (const double bin : transient.light) shares.push_back(bin / transient.total());
    arrays.emplace("transient", light.transients.size() == 1
                                    ? as_array({bins}, shares)
                                    : as_array({light.transients.size(), bins}, shares));
    arrays.emplace("transient_bin_m",
                   as_array({1}, std::vector<double>{light.transients.front().bin_m}));
    arrays.emplace("transient_first_m",
                   as_array({1}, std::vector<double>{light.transients.front().first_m}));
  }
  write_npz(path, arrays, policy);
}

}  // namespace tofsmith
