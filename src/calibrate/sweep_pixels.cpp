// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/sweep_pixels.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibrate/harmonic_fit.hpp"
#include "core/shared/periodic.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

constexpr double same = 0.02;  // relative to a step

/// Median step between distinct delays.
double usual_step(std::vector<double> sorted) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] - sorted[i - 1] > 1e-9) steps.push_back(sorted[i] - sorted[i - 1]);
  return steps.empty() ? 0.0 : median_of(std::move(steps));
}

}  // namespace

DelayGroups delay_groups(const std::vector<double>& delay_periods) {
  DelayGroups groups;
  if (delay_periods.empty()) return groups;
  std::vector<double> sorted = delay_periods;
  std::ranges::sort(sorted);
  groups.span_periods = sorted.back() - sorted.front();
  const double tolerance = same * usual_step(sorted);

  std::vector<std::size_t> order(delay_periods.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  // Positions just below 1 are equivalent to 0.
  const auto place_of = [&](std::size_t i) {
    const double place = wrap(delay_periods[i], 1.0);
    return place > 1.0 - tolerance ? place - 1.0 : place;
  };
  std::ranges::sort(order, {}, place_of);
  groups.group_of_frame.resize(delay_periods.size());
  for (const std::size_t i : order) {
    if (groups.place.empty() || place_of(i) - groups.place.back() > tolerance) {
      groups.place.push_back(place_of(i));
      groups.repeats.push_back(0);
    }
    groups.group_of_frame[i] = groups.count() - 1;
    ++groups.repeats.back();
  }
  for (double& place : groups.place) place = std::max(0.0, place);

  const double step = 1.0 / groups.count();
  double strayed = 0.0;
  for (int g = 0; g < groups.count(); ++g)
    strayed = std::max(
        strayed, std::abs(groups.place[static_cast<std::size_t>(g)] - groups.place[0] - g * step));
  groups.equal_steps = strayed <= same * step;
  groups.from_zero = groups.equal_steps && groups.place[0] <= same * step;
  return groups;
}

void require_whole_period(const DelayGroups& groups) {
  constexpr int min_groups = 8;
  require(groups.count() >= min_groups, "delays", groups.count(),
          fmt::format("must be at least {} different delays within the period", min_groups));
  std::vector<double> gaps;
  for (int g = 0; g < groups.count(); ++g) {
    const auto i = static_cast<std::size_t>(g);
    const double next = g + 1 < groups.count() ? groups.place[i + 1] : 1.0 + groups.place[0];
    gaps.push_back(next - groups.place[i]);
  }
  const double usual = median_of(gaps);
  const auto widest = std::ranges::max_element(gaps) - gaps.begin();
  const double gap = gaps[static_cast<std::size_t>(widest)];
  if (gap <= 2.5 * usual) return;
  const double begin = groups.place[static_cast<std::size_t>(widest)] + usual;
  const double end = groups.place[static_cast<std::size_t>(widest)] + gap - usual;
  require(false, "delays",
          fmt::format("{:.4g} periods long in steps of {:.4g}", groups.span_periods, usual),
          fmt::format("must cover a whole period without a gap: delays from {:.4g} to {:.4g} "
                      "periods are missing, {:.0f} more steps",
                      begin, end, std::max(1.0, std::round(gap / usual) - 1)));
}

Eigen::MatrixXd within_groups(const Eigen::MatrixXd& x, const DelayGroups& groups) {
  const Eigen::MatrixXd means = group_means(x, groups);
  Eigen::MatrixXd rest = x;
  for (Eigen::Index f = 0; f < x.rows(); ++f)
    rest.row(f) -= means.row(groups.group_of_frame[static_cast<std::size_t>(f)]);
  return rest;
}

double sweep_time(int frame, int frames) {
  return frames > 1 ? static_cast<double>(frame) / (frames - 1) - 0.5 : 0.0;
}

Eigen::MatrixXd group_means(const Eigen::MatrixXd& curve, const DelayGroups& groups) {
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(groups.count(), curve.cols());
  for (Eigen::Index f = 0; f < curve.rows(); ++f)
    means.row(groups.group_of_frame[static_cast<std::size_t>(f)]) += curve.row(f);
  for (Eigen::Index g = 0; g < means.rows(); ++g)
    means.row(g) /= groups.repeats[static_cast<std::size_t>(g)];
  return means;
}

SweepDrift sweep_drift(const Eigen::MatrixXd& curve, const DelayGroups& groups,
                       double noise_variance) {
  SweepDrift drift;
  const Eigen::Index frames = curve.rows(), columns = curve.cols();
  drift.correction = Eigen::MatrixXd::Zero(frames, columns);
  if (!groups.has_repeats()) return drift;

  Eigen::MatrixXd light_shape(frames, columns), level_shape(frames, columns);
  Eigen::MatrixXd corrected = curve;
  Eigen::Vector2d change = Eigen::Vector2d::Zero();
  Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();
  double left = 0.0;
  for (int round = 0; round < 4; ++round) {
    Eigen::MatrixXd signal = group_means(corrected, groups);
    signal.rowwise() -= signal.colwise().mean().eval();
    for (Eigen::Index f = 0; f < frames; ++f) {
      const double t = sweep_time(static_cast<int>(f), static_cast<int>(frames));
      light_shape.row(f) = t * signal.row(groups.group_of_frame[static_cast<std::size_t>(f)]);
      level_shape.row(f).setConstant(t);
    }
    Eigen::MatrixXd shapes(curve.size(), 2);
    const Eigen::MatrixXd light = within_groups(light_shape, groups);
    const Eigen::MatrixXd level = within_groups(level_shape, groups);
    const Eigen::MatrixXd seen = within_groups(curve, groups);
    shapes << light.reshaped(), level.reshaped();
    inverse = (shapes.transpose() * shapes).inverse();
    if (!inverse.allFinite()) return drift;
    change = inverse * (shapes.transpose() * seen.reshaped());
    left = (seen.reshaped() - shapes * change).squaredNorm();
    corrected = curve - change[0] * light_shape - change[1] * level_shape;
  }
  const auto repeated = static_cast<double>((frames - groups.count()) * columns);
  if (noise_variance == 0.0) {
    constexpr double min_values = 3.0;  // in addition to the two fitted changes
    if (repeated < 2 + min_values) return drift;
    noise_variance = left / (repeated - 2);
  }
  drift.known = true;
  drift.light = {change[0], std::sqrt(noise_variance * inverse(0, 0))};
  drift.level = {change[1], std::sqrt(noise_variance * inverse(1, 1))};
  drift.significant = std::abs(drift.light.value) > 3 * drift.light.standard_error ||
                      std::abs(drift.level.value) > 3 * drift.level.standard_error;
  if (drift.significant) drift.correction = change[0] * light_shape + change[1] * level_shape;
  return drift;
}

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

namespace {

/// Sum over measurements of c conj(C) for each harmonic.
Eigen::VectorXcd products(const Eigen::MatrixXcd& pixel, const Eigen::MatrixXcd& common) {
  Eigen::VectorXcd s = pixel.cwiseProduct(common.conjugate()).rowwise().sum();
  s[0] = 0.0;
  return s;
}

double energy(const Eigen::MatrixXcd& common) {
  return common.bottomRows(common.rows() - 1).squaredNorm();
}

/// Least squares common curve for given delays and gains.
Eigen::MatrixXcd common_curve(const std::vector<Eigen::MatrixXcf>& pixels,
                              const PixelAlignment& alignment) {
  Eigen::MatrixXcd sum = Eigen::MatrixXcd::Zero(pixels.front().rows(), pixels.front().cols());
  Eigen::MatrixXcd level = sum.topRows(1);
  double weight = 0.0;
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    const Eigen::MatrixXcd c = pixels[p].cast<std::complex<double>>();
    sum += alignment.gain[p] * advanced(c, -alignment.delay_periods[p]);
    level += c.topRows(1);
    weight += alignment.gain[p] * alignment.gain[p];
  }
  sum /= weight;
  sum.topRows(1) = level / static_cast<double>(pixels.size());
  return sum;
}

}  // namespace

BestShift best_shift(const Eigen::VectorXcd& s) {
  const auto harmonics = static_cast<int>(s.size()) - 1;
  const int points = std::max(16, 8 * harmonics);
  const PeriodicTransform transform(points);
  Eigen::VectorXcd spectrum = Eigen::VectorXcd::Zero(transform.coefficients());
  for (int n = 1; n <= harmonics; ++n) spectrum[n] = std::conj(s[n]);
  Eigen::VectorXd values;
  transform.inverse(spectrum, values);
  Eigen::Index best = 0;
  values.maxCoeff(&best);
  double shift = static_cast<double>(best) / points;
  const auto sums = [&](double at) {
    Eigen::Vector3d v = Eigen::Vector3d::Zero();  // value, slope, curvature
    for (int n = 1; n <= harmonics; ++n) {
      const std::complex<double> term = s[n] * std::polar(1.0, -turn * n * at);
      v[0] += term.real();
      v[1] += turn * n * term.imag();
      v[2] -= turn * n * turn * n * term.real();
    }
    return v;
  };
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d v = sums(shift);
    if (!(v[2] < 0.0)) break;
    const double step = std::clamp(-v[1] / v[2], -0.5 / points, 0.5 / points);
    shift += step;
    if (std::abs(step) < 1e-12) break;
  }
  return {circular_difference(shift, 0.0, 1.0), sums(shift)[0]};
}

PixelAlignment align_pixels(const std::vector<Eigen::MatrixXcf>& pixels, const Progress& progress) {
  constexpr int rounds = 8;
  PixelAlignment alignment{.delay_periods = std::vector<double>(pixels.size(), 0.0),
                           .gain = std::vector<double>(pixels.size(), 1.0)};
  alignment.common = common_curve(pixels, alignment);
  if (pixels.size() == 1) return alignment;
  for (int round = 0; round < rounds; ++round) {
    report(progress, static_cast<double>(round) / rounds, "align pixels");
    const std::vector<double> before = alignment.delay_periods;
    const double common_energy = energy(alignment.common);
    parallel_for_indices(pixels.size(), [&](std::size_t p) {
      const BestShift best =
          best_shift(products(pixels[p].cast<std::complex<double>>(), alignment.common));
      alignment.delay_periods[p] = best.shift;
      alignment.gain[p] = best.value / common_energy;
    });
    double delay = 0.0, gain = 0.0;
    for (std::size_t p = 0; p < pixels.size(); ++p) {
      delay += alignment.delay_periods[p];
      gain += alignment.gain[p];
    }
    const auto count = static_cast<double>(pixels.size());
    double change = 0.0;
    for (std::size_t p = 0; p < pixels.size(); ++p) {
      alignment.delay_periods[p] -= delay / count;
      alignment.gain[p] /= gain / count;
      change = std::max(change, std::abs(alignment.delay_periods[p] - before[p]));
    }
    alignment.common = common_curve(pixels, alignment);
    if (change < 1e-9) break;
  }
  return alignment;
}

}  // namespace tofsmith
