// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/harmonic_fit.hpp"

#include <algorithm>
#include <cmath>

#include "core/shared/decompositions.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {

namespace {

Eigen::MatrixXd basis_at(const std::vector<double>& places, int harmonics) {
  Eigen::MatrixXd basis(static_cast<Eigen::Index>(places.size()), 2 * harmonics + 1);
  for (Eigen::Index f = 0; f < basis.rows(); ++f) {
    basis(f, 0) = 1.0;
    for (int n = 1; n <= harmonics; ++n) {
      const double angle = turn * n * places[static_cast<std::size_t>(f)];
      basis(f, n) = std::cos(angle);
      basis(f, harmonics + n) = std::sin(angle);
    }
  }
  return basis;
}

Eigen::MatrixXcd complex_of(const Eigen::MatrixXd& weights, int harmonics) {
  Eigen::MatrixXcd c(harmonics + 1, weights.cols());
  c.row(0) = weights.row(0).cast<std::complex<double>>();
  for (int n = 1; n <= harmonics; ++n)
    for (Eigen::Index k = 0; k < weights.cols(); ++k)
      c(n, k) = {0.5 * weights(n, k), -0.5 * weights(harmonics + n, k)};
  return c;
}

Eigen::MatrixXd weights_of(const Eigen::MatrixXcd& c) {
  const Eigen::Index harmonics = c.rows() - 1;
  Eigen::MatrixXd weights(2 * harmonics + 1, c.cols());
  weights.row(0) = c.row(0).real();
  weights.middleRows(1, harmonics) = 2 * c.bottomRows(harmonics).real();
  weights.bottomRows(harmonics) = -2 * c.bottomRows(harmonics).imag();
  return weights;
}

}  // namespace

HarmonicBasis::HarmonicBasis(const std::vector<double>& places, int harmonics)
    : harmonics_(harmonics), basis_(basis_at(places, harmonics)) {
  inverse_ = solve_symmetric(basis_.transpose() * basis_, basis_.transpose());
}

Eigen::MatrixXcd HarmonicBasis::coefficients(const Eigen::MatrixXd& values) const {
  return complex_of(inverse_ * values, harmonics_);
}

Eigen::MatrixXd HarmonicBasis::values(const Eigen::MatrixXcd& coefficients) const {
  return basis_ * weights_of(coefficients);
}

Eigen::MatrixXd curve_of(const Eigen::MatrixXcd& coefficients, int rows) {
  std::vector<double> places;
  for (int j = 0; j < rows; ++j) places.push_back(static_cast<double>(j) / rows);
  return basis_at(places, static_cast<int>(coefficients.rows()) - 1) * weights_of(coefficients);
}

Eigen::MatrixXcd advanced(Eigen::MatrixXcd coefficients, double shift) {
  for (Eigen::Index n = 1; n < coefficients.rows(); ++n)
    coefficients.row(n) *= std::polar(1.0, turn * static_cast<double>(n) * shift);
  return coefficients;
}

HarmonicFit::HarmonicFit(const Fundamentals& model, const ReferencePixels& pixels, int rows)
    : model_(model), pixels_(pixels) {
  constexpr int max_harmonic = 20;
  for (std::size_t f = 0; f < model.repetitions.size(); ++f)
    for (int h = 1; h <= max_harmonic && h * model.repetitions[f] < rows / 2; ++h)
      terms_.push_back({f, h});
  prior_.resize(columns());
  mean_contrast_ = Eigen::VectorXd::Zero(columns());
  for (std::size_t t = 0; t < terms_.size(); ++t)
    prior_.segment(2 * static_cast<Eigen::Index>(t), 2)
        .setConstant(1.0 / (terms_[t].harmonic * terms_[t].harmonic));
  for (std::size_t t = 0; t < terms_.size(); ++t)
    if (terms_[t].harmonic == 1)
      mean_contrast_[2 * static_cast<Eigen::Index>(t)] =
          1.0 / static_cast<double>(model.repetitions.size());
  deviation_ = Eigen::VectorXd::Zero(columns());
  weight_.assign(static_cast<std::size_t>(pixels.size()), 1.0);
}

void HarmonicFit::solve() {
  constexpr int rounds = 8;
  for (int round = 0; round < rounds; ++round) {
    weigh();
    const Sums sums = all_sums();
    const Eigen::VectorXd data = sums.moment.rowwise().sum() / misfit_;
    deviation_ += solve_symmetric(information_of(sums), data - prior_information() * deviation_);
  }
  estimate_errors();
}

std::size_t HarmonicFit::fundamental(std::size_t frequency) const {
  std::size_t term = 0;
  while (terms_[term].frequency != frequency) ++term;
  return term;
}

std::array<double, 2> HarmonicFit::standard_errors(std::size_t term) const {
  const auto at = 2 * static_cast<Eigen::Index>(term);
  return {std::sqrt(covariance_(at, at)), std::sqrt(covariance_(at + 1, at + 1))};
}

double HarmonicFit::contrast_error(std::size_t frequency) const {
  Eigen::VectorXd difference = -mean_contrast_;
  difference[2 * static_cast<Eigen::Index>(fundamental(frequency))] += 1.0;
  return std::sqrt(difference.dot(covariance_ * difference));
}

bool HarmonicFit::is_determined(std::size_t term) const {
  const auto at = 2 * static_cast<Eigen::Index>(term);
  const double real = terms_[term].harmonic == 1 ? 0.0 : posterior_[at];
  return std::max(real, posterior_[at + 1]) < 0.25 * prior_[at] * prior_[at];
}

Eigen::MatrixXd HarmonicFit::prior_information() const {
  constexpr double known = 1e-3;
  Eigen::MatrixXd information = mean_contrast_ * mean_contrast_.transpose() / (known * known);
  information.diagonal() += prior_.cwiseAbs2().cwiseInverse();
  return information;
}

Eigen::MatrixXd HarmonicFit::information_of(const Sums& sums) const {
  return sums.gram / misfit_ + prior_information();
}

Eigen::MatrixXd HarmonicFit::functions(double depth_m) const {
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(model_.measurements(), columns());
  for (std::size_t t = 0; t < terms_.size(); ++t)
    for (int i = 0; i < model_.measurements(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (model_.frequency[k] != terms_[t].frequency) continue;
      const double phase_rad =
          std::arg(model_.harmonic[k]) + model_.phase_rad(terms_[t].frequency, depth_m);
      const std::complex<double> value =
          std::polar(2 * std::abs(model_.harmonic[k]), terms_[t].harmonic * phase_rad);
      values(i, 2 * static_cast<Eigen::Index>(t)) = value.real();
      values(i, 2 * static_cast<Eigen::Index>(t) + 1) = -value.imag();
    }
  return values;
}

HarmonicFit::PixelTerms HarmonicFit::terms_of(Eigen::Index pixel) const {
  const DecodingTable& table = model_.table;
  const double depth_m = pixels_.depth_m[static_cast<std::size_t>(pixel)];
  Eigen::MatrixXd design = functions(depth_m);
  Eigen::MatrixXd light(model_.measurements(), 2);
  light.col(0) = table.exposure_s.cwiseProduct(model_.at(depth_m) + design * deviation_);
  light.col(1) = table.exposure_s.cwiseProduct(table.ambient_gain);
  const bool sees_ambient = light.col(1).norm() > 1e-9 * table.exposure_s.norm();
  if (!sees_ambient) light.conservativeResize(Eigen::NoChange, 1);
  const Eigen::VectorXd electrons = pixels_.electrons.col(pixel);
  const double signal = least_squares(light, electrons)[0];
  if (!(signal > 0.0)) return {};
  const double mean_shot = table.shot().mean();
  const Eigen::VectorXd variance_e2 =
      (table.exposure_s * (signal * mean_shot) +
       table.exposure_s.cwiseProduct(table.shot_ambient()) * table.hidden_ambient_e_per_s +
       table.shot_dark() + table.constant_variance_e2)
          .cwiseMax(1.0);
  const Eigen::VectorXd scale = variance_e2.cwiseSqrt().cwiseInverse();
  light = scale.asDiagonal() * light;
  const Eigen::MatrixXd rest = complement_of(light);
  design = rest.transpose() * (scale.cwiseProduct(signal * table.exposure_s)).asDiagonal() * design;
  return {std::move(design), rest.transpose() * scale.cwiseProduct(electrons), true};
}

template <typename Add>
void HarmonicFit::for_each_pixel(const Add& add) const {
  parallel_for_blocks(pixels_.size(), block_size, [&](IndexRange range) {
    for (Eigen::Index p = range.begin; p < range.end; ++p) add(p, range.begin / block_size);
  });
}

HarmonicFit::Sums HarmonicFit::all_sums() const {
  const auto blocks = static_cast<std::size_t>((pixels_.size() + block_size - 1) / block_size);
  std::vector<Sums> parts(blocks, {Eigen::MatrixXd::Zero(columns(), columns()),
                                   Eigen::MatrixXd::Zero(columns(), pixels_.tiles)});
  for_each_pixel([&](Eigen::Index p, std::int64_t block) {
    const auto at = static_cast<std::size_t>(p);
    if (weight_[at] == 0.0) return;
    const PixelTerms pixel = terms_of(p);
    if (!pixel.is_valid) return;
    Sums& sums = parts[static_cast<std::size_t>(block)];
    sums.gram.noalias() += weight_[at] * pixel.design.transpose() * pixel.design;
    sums.moment.col(pixels_.tile[at]).noalias() +=
        weight_[at] * pixel.design.transpose() * pixel.residual;
  });
  for (std::size_t b = 1; b < parts.size(); ++b) {
    parts[0].gram += parts[b].gram;
    parts[0].moment += parts[b].moment;
  }
  return std::move(parts[0]);
}

void HarmonicFit::weigh() {
  constexpr double reach = 4.0;
  std::vector<double> size(static_cast<std::size_t>(pixels_.size()), INFINITY);
  for_each_pixel([&](Eigen::Index p, std::int64_t) {
    const PixelTerms pixel = terms_of(p);
    if (pixel.is_valid && pixel.residual.size() > 0)
      size[static_cast<std::size_t>(p)] =
          pixel.residual.squaredNorm() / static_cast<double>(pixel.residual.size());
  });
  misfit_ = std::max(1.0, median_of(size));
  for (std::size_t p = 0; p < size.size(); ++p) {
    const double u = std::sqrt(size[p] / misfit_) / reach;
    weight_[p] = u < 1.0 ? std::pow(1.0 - u * u, 2) : 0.0;
  }
}

void HarmonicFit::estimate_errors() {
  const Sums sums = all_sums();
  const Eigen::MatrixXd inverse =
      solve_symmetric(information_of(sums), Eigen::MatrixXd::Identity(columns(), columns()));
  const Eigen::MatrixXd spread = inverse * sums.moment / misfit_;
  const auto used = static_cast<double>((sums.moment.colwise().squaredNorm().array() > 0).count());
  const double freedom = std::max(1.0, used - static_cast<double>(columns()));
  covariance_ = spread * spread.transpose() * (used / freedom);
  posterior_ = inverse.diagonal();
}

}  // namespace tofsmith
