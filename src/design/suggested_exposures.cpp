// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/suggested_exposures.hpp"

#include <algorithm>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

int useful_harmonics(const Camera& camera) {
  if (!camera.band_limited()) return 0;
  const int highest = 4 * camera.samples;
  const Eigen::VectorXcd transfer = camera.transfer(highest);
  // A Hann response equals this value at its f_max, up to rounding.
  constexpr double end_of_band = (1.0 - 1e-9) / 25.0;
  int last = 1;
  while (last < highest && std::abs(transfer[last + 1]) >= end_of_band) ++last;
  return last;
}

std::vector<int> suggested_exposures(const Camera& camera, DesignMethod method) {
  const std::size_t listed = camera.exposure_s.each_s.size();
  const std::size_t ordered = camera.playback ? camera.playback->order.size() : 0;
  if (listed > 0 || ordered > 0) return {static_cast<int>(std::max(listed, ordered))};
  const int taps = camera.sensor.taps;
  if (method == DesignMethod::factorize) return {3, 4, 5};
  if (method == DesignMethod::search) return {1, 2};
  if (taps >= 3) return {1, 2, 3};
  if (taps == 2) return {2, 3, 4};
  const int harmonics = useful_harmonics(camera);
  if (harmonics == 0 || harmonics > 15) return {4, 5, 6};
  return {3, 4, 5};
}

}  // namespace tofsmith
