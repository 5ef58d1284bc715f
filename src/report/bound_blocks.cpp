// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/bound_blocks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "report/operating_map.hpp"

namespace tofsmith {

namespace {

using Bound = double PointDepthError::*;

/// How many times as large as a bound the circular error is; not a number where the bound says
/// nothing.
double times_bound(const PointDepthError& point, Bound bound) {
  const double bound_m = point.*bound, error_m = point.circular_mde_m.value;
  const bool says_something = bound_m > 0.0 && std::isfinite(bound_m) && error_m > 0.0;
  return says_something ? error_m / bound_m : std::numeric_limits<double>::quiet_NaN();
}

/// Geometric mean over the points where the bound says something.
std::string mean_times_bound(const DepthErrorReport& error, Bound bound) {
  double log_sum = 0.0;
  int count = 0;
  for (const PointDepthError& point : error.points) {
    const double times = times_bound(point, bound);
    if (std::isnan(times)) continue;
    log_sum += std::log(times);
    ++count;
  }
  return count > 0 ? fmt::format("{:.2f}", std::exp(log_sum / count)) : "no bound";
}

Table distance_table(std::span<const DepthErrorRow> codes, const std::vector<std::size_t>& order) {
  Table table{.id = "distance-to-bounds",
              .caption =
                  "How many times as large as a bound the circular error is (geometric mean over "
                  "the operating points). No estimator without bias comes below the Cramér-Rao "
                  "bound of its code, no code below the receiver bound of its camera, no receiver "
                  "below the direct time-of-flight bound of its light. They know no wrap and no "
                  "wrong lobe: where a code is little better than guessing, it may come below.",
              .columns = {{"code"},
                          {"error / Cramér-Rao", true},
                          {"error / receiver bound", true},
                          {"error / direct ToF bound", true}}};
  for (const std::size_t i : order) {
    const DepthErrorReport& error = *codes[i].error;
    table.rows.push_back({error.code, mean_times_bound(error, &PointDepthError::cramer_rao_mae_m),
                          mean_times_bound(error, &PointDepthError::receiver_bound_mae_m),
                          mean_times_bound(error, &PointDepthError::direct_tof_bound_mae_m)});
  }
  return table;
}

FigureText map_text(bool is_limited) {
  if (is_limited)
    return {.id = "bound-maps",
            .title = "Circular error over the receiver bound",
            .caption =
                "How many times as large as what no code on this camera can beat, in as many "
                "exposures."};
  return {.id = "bound-maps",
          .title = "Circular error over the Cramér-Rao bound",
          .caption =
              "How many times as large as the code itself allows: without impulse responses "
              "no bound holds for all codes."};
}

}  // namespace

std::vector<Block> bound_blocks(const Camera& camera, std::span<const DepthErrorRow> codes,
                                const std::vector<std::size_t>& order) {
  std::vector<Block> blocks{distance_table(codes, order)};
  const bool is_limited = camera.band_limited();
  const Bound bound =
      is_limited ? &PointDepthError::receiver_bound_mae_m : &PointDepthError::cramer_rao_mae_m;
  std::vector<HeatMap> maps;
  for (const std::size_t i : order) {
    HeatMap map = operating_map(camera.operating, *codes[i].error,
                                [&](const PointDepthError& p) { return times_bound(p, bound); });
    if (map.values.array().isFinite().any()) maps.push_back(std::move(map));
  }
  if (!maps.empty())
    blocks.push_back(operating_maps(map_text(is_limited), camera.operating, maps,
                                    {.label = "error / bound", .logarithmic = true}));
  return blocks;
}

}  // namespace tofsmith
