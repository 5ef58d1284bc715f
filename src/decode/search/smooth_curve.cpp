// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/smooth_curve.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/shared/periodic.hpp"

namespace tofsmith {

namespace {

constexpr double pi = std::numbers::pi;
/// Relative amplitude in the upper quarter of a spectrum that indicates aliasing.
constexpr double hidden_share = 1e-6;
constexpr double fast_turn_rad = 10.0 * pi / 180.0;
constexpr double same_direction_rad = 1.0 * pi / 180.0;

Eigen::MatrixXcd spectrum_of(const Eigen::MatrixXd& columns) {
  const PeriodicTransform transform(static_cast<int>(columns.rows()));
  Eigen::MatrixXcd spectrum(transform.coefficients(), columns.cols());
  Eigen::VectorXcd one;
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    transform.forward(columns.col(j), one);
    spectrum.col(j) = one;
  }
  return spectrum;
}

Eigen::MatrixXd columns_of(const Eigen::MatrixXcd& spectrum, int rows) {
  const PeriodicTransform transform(rows);
  Eigen::MatrixXd columns(rows, spectrum.cols());
  Eigen::VectorXd one;
  for (Eigen::Index j = 0; j < spectrum.cols(); ++j) {
    transform.inverse(spectrum.col(j), one);
    columns.col(j) = one;
  }
  return columns;
}

bool falls_off(const Eigen::MatrixXcd& spectrum) {
  const Eigen::Index upper = spectrum.rows() / 4;
  if (upper < 1) return false;
  const double whole = spectrum.bottomRows(spectrum.rows() - 1).norm();
  return spectrum.bottomRows(upper).norm() <= hidden_share * whole;
}

Eigen::Index band_limit_of(const Eigen::VectorXd& power) {
  const Eigen::Index top = power.size() / 4;
  const double floor = power.tail(top).mean();
  double gain = 0.0, largest = 0.0;
  Eigen::Index limit = 0;
  for (Eigen::Index h = 1; h < power.size(); ++h) {
    gain += power[h] - 2.0 * floor;
    if (gain <= largest) continue;
    largest = gain;
    limit = h;
  }
  return limit;
}

bool falls_back(const RowMajorMatrix& curve) {
  const Eigen::VectorXd turn_rad = turns_of(curve);
  if (!(turn_rad.maxCoeff() > fast_turn_rad)) return false;
  const RowMajorMatrix units = curve.rowwise().normalized();
  for (Eigen::Index n = 0; n < curve.rows(); ++n)
    if (turn_rad[n] > fast_turn_rad) {
      const Eigen::RowVectorXd middle = units.row(n) + units.row((n + 1) % curve.rows());
      if (is_passed_slowly(middle.normalized(), turn_rad[n], units, turn_rad)) return true;
    }
  return false;
}

RowMajorMatrix direction_slopes(const RowMajorMatrix& points, const RowMajorMatrix& slopes) {
  const Eigen::VectorXd length2 = points.rowwise().squaredNorm();
  const Eigen::VectorXd along = points.cwiseProduct(slopes).rowwise().sum().cwiseQuotient(length2);
  const RowMajorMatrix across = slopes - along.asDiagonal() * points;
  return length2.cwiseSqrt().cwiseInverse().asDiagonal() * across;
}

}  // namespace

Eigen::VectorXd turns_of(const RowMajorMatrix& curve) {
  const Eigen::Index samples = curve.rows();
  Eigen::VectorXd turn_rad(samples);
  for (Eigen::Index n = 0; n < samples; ++n) {
    const auto from = curve.row(n), to = curve.row((n + 1) % samples);
    const double lengths = from.norm() * to.norm();
    turn_rad[n] = lengths > 0.0 ? std::acos(std::clamp(from.dot(to) / lengths, -1.0, 1.0)) : 0.0;
  }
  return turn_rad;
}

bool is_passed_slowly(const Eigen::RowVectorXd& unit, double turn, const RowMajorMatrix& units,
                      const Eigen::VectorXd& turn_rad) {
  const Eigen::Index samples = units.rows();
  const Eigen::VectorXd score = units * unit.transpose();
  for (Eigen::Index n = 0; n < samples; ++n)
    if (score[n] > std::cos(same_direction_rad) &&
        std::max(turn_rad[n], turn_rad[n > 0 ? n - 1 : samples - 1]) <= 0.5 * turn)
      return true;
  return false;
}

std::optional<SmoothCurve> SmoothCurve::of(const RowMajorMatrix& curve) {
  SmoothCurve smooth;
  smooth.rows_ = static_cast<int>(curve.rows());
  smooth.spectrum_ = spectrum_of(curve);
  const Eigen::VectorXd lengths = curve.rowwise().norm();
  constexpr double no_contrast = 1e-6;
  if (!falls_off(smooth.spectrum_) || lengths.minCoeff() <= no_contrast * lengths.maxCoeff() ||
      falls_back(curve))
    return std::nullopt;
  return smooth;
}

RowMajorMatrix SmoothCurve::at(double offset, bool as_slopes) const {
  Eigen::MatrixXcd spectrum = spectrum_;
  for (Eigen::Index k = 0; k < spectrum.rows(); ++k) {
    const double turn = 2 * pi * static_cast<double>(k) / rows_;
    spectrum.row(k) *= std::polar(1.0, turn * offset);
    if (as_slopes) spectrum.row(k) *= std::complex<double>(0.0, turn);
  }
  if (rows_ % 2 == 0) {
    auto nyquist = spectrum.row(spectrum.rows() - 1);
    nyquist = as_slopes ? Eigen::RowVectorXcd::Zero(nyquist.size()).eval()
                        : nyquist.real().cast<std::complex<double>>().eval();
  }
  return columns_of(spectrum, rows_);
}

Eigen::MatrixXd interpolated(const Eigen::MatrixXd& columns, int factor) {
  const auto rows = static_cast<int>(columns.rows());
  const Eigen::MatrixXcd spectrum = spectrum_of(columns);
  Eigen::MatrixXcd fine_spectrum = Eigen::MatrixXcd::Zero(rows * factor / 2 + 1, columns.cols());
  fine_spectrum.topRows(spectrum.rows()) = static_cast<double>(factor) * spectrum;
  if (rows % 2 == 0) fine_spectrum.row(rows / 2) *= 0.5;
  Eigen::MatrixXd fine = columns_of(fine_spectrum, rows * factor);
  // Rows of the input keep their exact values.
  for (Eigen::Index n = 0; n < rows; ++n) fine.row(n * factor) = columns.row(n);
  return fine;
}

Eigen::MatrixXd without_noise_above_band_limit(const Eigen::MatrixXd& columns) {
  constexpr Eigen::Index fewest_rows = 32;
  constexpr double largest_noise = 6.0;
  if (columns.rows() < fewest_rows || !columns.allFinite()) return columns;
  Eigen::MatrixXcd spectrum = spectrum_of(columns);
  const Eigen::Index limit = band_limit_of(spectrum.rowwise().squaredNorm());
  if (falls_off(spectrum) || limit == 0 || 2 * limit >= spectrum.rows()) return columns;
  spectrum.bottomRows(spectrum.rows() - limit - 1).setZero();
  const Eigen::MatrixXd kept = columns_of(spectrum, static_cast<int>(columns.rows()));
  const Eigen::ArrayXXd removed = (columns - kept).array();
  const bool is_noise =
      removed.abs().maxCoeff() <= largest_noise * std::sqrt(removed.square().mean());
  return is_noise ? kept : columns;
}

DepthPolynomials::DepthPolynomials(const SmoothCurve& curve) {
  const double node = 0.25 * std::numbers::sqrt3;  // Chebyshev nodes are +-node and 0
  const RowMajorMatrix here = curve.points(0.0), before = curve.points(-node),
                       after = curve.points(node);
  const RowMajorMatrix middle = direction_slopes(here, curve.slopes(0.0)),
                       left = direction_slopes(before, curve.slopes(-node)),
                       right = direction_slopes(after, curve.slopes(node));
  const Eigen::VectorXd length = here.rowwise().norm();
  const Eigen::VectorXd scale = length.cwiseInverse();
  slope = scale.asDiagonal() * middle;
  bend = (0.5 / node * scale).asDiagonal() * (right - left);
  asymmetry = (0.5 / (node * node) * scale).asDiagonal() * (right + left - 2.0 * middle);
  const Eigen::VectorXd length_before = before.rowwise().norm().cwiseProduct(scale),
                        length_after = after.rowwise().norm().cwiseProduct(scale);
  growth = 0.5 / node * (length_after - length_before);
  growth_change = 0.5 / (node * node) * ((length_after + length_before).array() - 2.0);
}

double DepthPolynomials::maximum(double g, double b, double c) {
  if (!(b < 0.0)) return 0.0;
  double t = std::clamp(-g / b, -1.0, 1.0);
  for (int step = 0; step < 2; ++step) {
    const double curvature = b + 2.0 * c * t;
    if (!(curvature < 0.0)) break;
    t = std::clamp(t - (g + t * (b + t * c)) / curvature, -1.0, 1.0);
  }
  return t;
}

std::optional<SmoothCurve> finely_sampled_curve(const RowMajorMatrix& curve) {
  constexpr double widest_turn_rad = 16.0 * pi / 180.0;
  if (turns_of(curve).maxCoeff() > widest_turn_rad) return std::nullopt;
  return SmoothCurve::of(curve);
}

std::optional<DepthPolynomials> depth_polynomials(const RowMajorMatrix& curve) {
  const std::optional<SmoothCurve> smooth = finely_sampled_curve(curve);
  if (!smooth) return std::nullopt;
  return DepthPolynomials(*smooth);
}

double interpolation_error(const SmoothCurve& curve) {
  const DepthPolynomials polynomials(curve);
  const Eigen::ArrayXd turn2 = turns_of(curve.points(0.0)).array().square();
  // Limited, because the curve may almost stop.
  const Eigen::ArrayXd curvature = turn2.max(0.25 * turn2.mean());
  double largest = 0.0;
  for (const double offset : {-0.5, -0.25, 0.25, 0.5}) {
    const RowMajorMatrix points = curve.points(offset);
    const RowMajorMatrix derivative =
        polynomials.slope + offset * polynomials.bend + offset * offset * polynomials.asymmetry;
    const Eigen::ArrayXd left = points.cwiseProduct(derivative).rowwise().sum();
    largest = std::max(largest, (left.abs() / curvature).maxCoeff());
  }
  return largest;
}

}  // namespace tofsmith
