// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/sweep_pixels.hpp"

#include <fmt/format.h>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

Eigen::MatrixXd pixel_values(const RawFrames& raw, std::size_t pixel) {
  Eigen::MatrixXd values(raw.frames, raw.measurements);
  const auto stride = static_cast<std::size_t>(raw.measurements);
  for (int f = 0; f < raw.frames; ++f)
    for (int k = 0; k < raw.measurements; ++k)
      values(f, k) = raw.frame(f)[pixel * stride + static_cast<std::size_t>(k)];
  return values;
}

std::vector<std::size_t> live_pixels(const DelaySweep& sweep,
                                     const CorrelationCalibrationOptions& options,
                                     DeadPixels& dead) {
  std::vector<std::size_t> live;
  for (std::size_t p = 0; p < sweep.frames.pixels_per_frame(); ++p) {
    const Eigen::MatrixXd values = pixel_values(sweep.frames, p);
    if (!values.allFinite())
      ++dead.not_a_number;
    else if ((values.rowwise() - values.row(0)).isZero(0.0))
      ++dead.constant;
    else if (options.saturation_level &&
             values.maxCoeff() >= static_cast<double>(*options.saturation_level))
      ++dead.saturated;
    else
      live.push_back(p);
  }
  require(!live.empty(), "live pixels", 0,
          fmt::format("must be >= 1: {} not a number, {} constant, {} saturated", dead.not_a_number,
                      dead.constant, dead.saturated));
  return live;
}

Eigen::MatrixXd mean_curve(const RawFrames& raw, const std::vector<std::size_t>& live) {
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(raw.frames, raw.measurements);
  for (const std::size_t p : live) mean += pixel_values(raw, p);
  return mean / static_cast<double>(live.size());
}

double swing(const Eigen::MatrixXd& curve) {
  return (curve.rowwise() - curve.colwise().mean()).norm();
}

double mean_curve_variance(const RawFrames& raw, const DelayGroups& groups,
                           const std::vector<std::size_t>& live) {
  if (live.size() < enough_pixels) return 0.0;
  for (int f = 0; f < raw.frames; ++f)
    for (int other = f + 1; other < raw.frames; ++other) {
      if (groups.group_of_frame[static_cast<std::size_t>(f)] !=
          groups.group_of_frame[static_cast<std::size_t>(other)])
        continue;
      double sum = 0.0;
      for (int k = 0; k < raw.measurements; ++k) {
        RunningStatistics difference;
        for (const std::size_t p : live) {
          const std::size_t i =
              p * static_cast<std::size_t>(raw.measurements) + static_cast<std::size_t>(k);
          difference.add(static_cast<double>(raw.frame(f)[i]) -
                         static_cast<double>(raw.frame(other)[i]));
        }
        sum += 0.5 * difference.variance();
      }
      return sum / raw.measurements / static_cast<double>(live.size());
    }
  return 0.0;
}

}  // namespace tofsmith
