// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/shared/periodic.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {
// Relative; omitted harmonics may cause such values where the response is 0.
constexpr double rounding = 1e-7;
}  // namespace

void sample_with_slope(const Eigen::VectorXcd& harmonics, Eigen::VectorXd& values,
                       Eigen::VectorXd& slope) {
  const Eigen::Index highest = harmonics.size() - 1;
  const auto points = static_cast<int>(4 * highest);
  Eigen::VectorXcd spectrum = Eigen::VectorXcd::Zero(2 * highest + 1);
  Eigen::VectorXcd slope_spectrum = spectrum;
  for (Eigen::Index n = 0; n <= highest; ++n) {
    const double turn = 2.0 * std::numbers::pi * static_cast<double>(n);
    spectrum[n] = harmonics[n] * static_cast<double>(points);
    slope_spectrum[n] = std::complex<double>(0.0, turn) * spectrum[n];
  }
  const PeriodicTransform transform(points);
  transform.inverse(spectrum, values);
  transform.inverse(slope_spectrum, slope);
}

double information_of_shape(const Eigen::VectorXd& shape, const Eigen::VectorXd& slope,
                            double signal_e, double other_e) {
  const double least = rounding * shape.maxCoeff();
  double sum = 0.0;
  for (Eigen::Index j = 0; j < shape.size(); ++j) {
    const double value = std::abs(shape[j]) < least ? least : shape[j];
    const double variance_e2 = signal_e * value + other_e;
    if (variance_e2 <= 0.0) return infinity;
    sum += std::pow(signal_e * slope[j], 2) / variance_e2;
  }
  return sum / static_cast<double>(shape.size());
}

PhotonInformation::PhotonInformation(const Eigen::VectorXcd& transfer, bool may_ring)
    : may_ring_(may_ring) {
  for (Eigen::Index n = 1; n < transfer.size(); ++n) {
    const double slope = 2.0 * std::numbers::pi * static_cast<double>(n) * std::abs(transfer[n]);
    largest_slope_power_ = std::max(largest_slope_power_, slope * slope);
  }
  sample_with_slope(transfer, response_, slope_);
}

double PhotonInformation::of_impulses(double signal_e, double other_e) const {
  return information_of_shape(response_, slope_, signal_e, other_e);
}

double PhotonInformation::of_ripple(double signal_e, double other_e, double peak_factor) const {
  const double min_e = other_e - signal_e * undershoot(peak_factor);
  if (min_e <= 0.0) return infinity;
  // The variance of values in [0, p] with mean mu <= 1 is at most mu (p - mu).
  const double mean = std::min(1.0, 0.5 * peak_factor);
  return signal_e * signal_e * largest_slope_power_ * mean * (peak_factor - mean) / min_e;
}

double PhotonInformation::largest(double signal_e, double other_e, double peak_factor) const {
  return std::min(of_impulses(signal_e, other_e), of_ripple(signal_e, other_e, peak_factor));
}

double PhotonInformation::undershoot(double peak_factor) const {
  const double least = response_.minCoeff();
  if (!may_ring_ || least >= -rounding * response_.maxCoeff()) return 0.0;
  // Light within its peak reaches at most p times the negative part.
  return std::min(-least, -peak_factor * response_.cwiseMin(0.0).mean());
}

namespace {

constexpr int min_points = 4096;
constexpr int cells = 64;

/// x and the largest integral of d times a derivative of the light at x, as corners of a concave
/// polygon that is nowhere too low.
struct Profile {
  std::vector<double> passed{0.0}, largest{0.0};

  void go_on(double more_passed, double more_gained) {
    passed.push_back(passed.back() + more_passed);
    largest.push_back(largest.back() + more_gained);
  }
};

/// Gates open where derivative / light is largest. Points are binned by this ratio, not sorted.
/// Gates open down to the edge of a bin are exact; in between, the curve is below both tangents.
Profile profile_of(const Eigen::ArrayXd& light, const Eigen::ArrayXd& derivative) {
  constexpr int half = 512;  // bins per sign
  const double width = 1.0 / static_cast<double>(light.size());
  const double scale =
      derivative.abs().sum() / light.sum();  // of ratios: half of the bins are below
  Profile profile;
  if (!(scale > 0.0)) {
    profile.go_on(light.sum() * width, 0.0);
    return profile;
  }
  const auto edge = [&](int bin) {
    const double share = 1.0 - static_cast<double>(bin) / half;
    return scale * share / (1.0 - std::abs(share));
  };
  struct Bin {
    double passed = 0.0, gained = 0.0;
  };
  std::vector<Bin> bins(2 * half);
  double steepest = 0.0, lowest = 0.0;
  for (Eigen::Index j = 0; j < light.size(); ++j) {
    const double ratio = derivative[j] / light[j];
    const double share = ratio / (scale + std::abs(ratio));
    Bin& bin = bins[std::min(static_cast<std::size_t>((1.0 - share) * half), bins.size() - 1)];
    bin.passed += light[j] * width;
    bin.gained += derivative[j] * width;
    steepest = std::max(steepest, ratio);
    lowest = std::min(lowest, ratio);
  }
  for (int j = 0; j < 2 * half; ++j) {
    const auto [passed, gained] = bins[static_cast<std::size_t>(j)];
    if (passed == 0.0) continue;
    const double above = std::min(edge(j), steepest), below = std::max(edge(j + 1), lowest);
    const double to_bend =
        above > below ? std::clamp((gained - below * passed) / (above - below), 0.0, passed)
                      : passed;
    profile.go_on(to_bend, above * to_bend);
    profile.go_on(passed - to_bend, gained - above * to_bend);
  }
  return profile;
}

/// Returns the largest value of gates and their complements, whose derivatives differ only in sign.
std::vector<double> largest_at(const Profile& profile, const std::vector<double>& x) {
  const auto at = [&](double passed) {
    const auto right = std::upper_bound(profile.passed.begin(), profile.passed.end(), passed);
    if (right == profile.passed.end()) return 0.0;
    const auto i = static_cast<std::size_t>(right - profile.passed.begin());
    const double share =
        (passed - profile.passed[i - 1]) / (profile.passed[i] - profile.passed[i - 1]);
    return std::max(0.0, std::lerp(profile.largest[i - 1], profile.largest[i], share));
  };
  std::vector<double> values;
  values.reserve(x.size());
  for (const double passed : x)
    values.push_back(std::max(at(passed), at(profile.passed.back() - passed)));
  return values;
}

}  // namespace

GateInformation::GateInformation(const Eigen::VectorXcd& transfer) {
  const Eigen::Index highest = transfer.size() - 1;
  const auto points = static_cast<int>(std::max<Eigen::Index>(min_points, 4 * highest));
  const PeriodicTransform transform(points);
  Eigen::VectorXcd spectrum = Eigen::VectorXcd::Zero(transform.coefficients());
  spectrum.head(highest + 1) = transfer * static_cast<double>(points);
  const auto next_derivative = [&] {
    Eigen::VectorXd values;
    transform.inverse(spectrum, values);
    for (Eigen::Index n = 0; n <= highest; ++n)
      spectrum[n] *= std::complex<double>(0.0, 2.0 * std::numbers::pi * static_cast<double>(n));
    return Eigen::ArrayXd(values.array());
  };
  response_ = next_derivative();
  slope_ = next_derivative();
  curvature_ = next_derivative();
  response_ = response_.max(rounding * response_.maxCoeff());
}

double GateInformation::at_any_depth(double signal_e, double ambient_e, double other_e2) const {
  if (signal_e <= 0.0) return 0.0;
  const Profile profile = profile_of(signal_e * response_ + ambient_e, signal_e * slope_);
  double largest = 0.0;
  for (std::size_t i = 1; i < profile.passed.size(); ++i) {
    const double slope = profile.largest[i], passed = profile.passed[i];
    for (const double x : {passed, profile.passed.back() - passed})
      if (x + other_e2 > 0.0) largest = std::max(largest, slope * slope / (x + other_e2));
  }
  return largest;
}

double GateInformation::mean_over_depths(double signal_e, double ambient_e, double other_e2) const {
  if (signal_e <= 0.0) return 0.0;
  const Eigen::ArrayXd light = signal_e * response_ + ambient_e;
  const Profile slopes = profile_of(light, signal_e * slope_);
  const Profile curvatures = profile_of(light, signal_e * curvature_);
  const double all = slopes.passed.back();
  std::vector<double> middle, width, weight;
  for (int j = 0; j < cells; ++j) {
    const double begin = std::pow(j / static_cast<double>(cells), 2) * all;
    const double end = std::pow((j + 1) / static_cast<double>(cells), 2) * all;
    middle.push_back(0.5 * (begin + end));
    width.push_back(end - begin);
    weight.push_back(1.0 / (middle.back() + other_e2));
  }
  std::vector<double> steepest = largest_at(slopes, middle);
  for (double& z : steepest) z *= z;
  std::vector<double> risen{0.0};  // upper limit of z, starting at x = 0
  const std::vector<double> curvature = largest_at(curvatures, middle);
  for (std::size_t j = 0; j < cells; ++j)
    risen.push_back(risen.back() + 2.0 * curvature[j] * width[j]);

  const auto mean_between = [&](std::size_t a, std::size_t b) {
    double gained = 0.0, taken = 0.0;
    for (std::size_t j = a; j < b; ++j) {
      const double here = 0.5 * (risen[j] + risen[j + 1]);
      const double slope = std::sqrt(std::min({steepest[j], here - risen[a], risen[b] - here}));
      gained += slope * weight[j] * width[j];
      taken += width[j] / slope;
    }
    return gained / taken;
  };
  // The mean changes little: search every `step`-th cell, then around the largest.
  constexpr std::size_t step = 4;
  double largest = 0.0;
  std::size_t best_a = 0, best_b = cells;
  const auto look = [&](std::size_t a, std::size_t b) {
    const double mean = mean_between(a, b);
    if (mean <= largest) return;
    largest = mean;
    best_a = a;
    best_b = b;
  };
  for (std::size_t a = 0; a < cells; a += step)
    for (std::size_t b = a + step; b <= cells; b += step) look(a, b);
  const std::size_t around_a = best_a, around_b = best_b;
  for (std::size_t a = around_a - std::min(around_a, step); a <= around_a + step; ++a)
    for (std::size_t b = std::max(a + 1, around_b - step);
         b <= std::min<std::size_t>(cells, around_b + step); ++b)
      look(a, b);
  return largest;
}

}  // namespace tofsmith
