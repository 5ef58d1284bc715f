// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/pixel_alignment.hpp"

#include <algorithm>
#include <cmath>

#include "calibrate/harmonic_fit.hpp"
#include "core/shared/periodic.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
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
    parallel_for(static_cast<std::int64_t>(pixels.size()), [&](std::int64_t i) {
      const auto p = static_cast<std::size_t>(i);
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
