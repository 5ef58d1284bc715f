// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/response_peaks.hpp"

#include <algorithm>

namespace tofsmith {

std::vector<ResponsePeak> peaks_of(const ImpulseResponse& response, double noise_rms) {
  constexpr double lowest = 0.15, deepest_valley = 0.7;
  const std::vector<double>& h = response.samples;
  std::vector<std::size_t> maxima;
  for (std::size_t i = 1; i + 1 < h.size(); ++i)
    if (h[i] > h[i - 1] && h[i] >= h[i + 1]) maxima.push_back(i);
  std::ranges::sort(maxima, std::greater{}, [&](std::size_t i) { return h[i]; });
  std::vector<std::size_t> kept;
  for (const std::size_t i : maxima) {
    if (!kept.empty() && h[i] < std::max(lowest, 5 * noise_rms) * h[kept.front()]) break;
    const auto is_apart = [&](std::size_t other) {
      const auto [first, last] = std::minmax(i, other);
      const auto begin = h.begin() + static_cast<std::ptrdiff_t>(first);
      const auto end = h.begin() + static_cast<std::ptrdiff_t>(last);
      return *std::min_element(begin, end) < deepest_valley * h[i];
    };
    if (std::ranges::all_of(kept, is_apart)) kept.push_back(i);
  }
  std::vector<ResponsePeak> peaks;
  for (const std::size_t i : kept)
    peaks.push_back(
        {(static_cast<double>(i) - static_cast<double>(kept.front())) * response.time_step_s,
         h[i] / h[kept.front()]});
  return peaks;
}

}  // namespace tofsmith
