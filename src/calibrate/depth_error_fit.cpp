// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/depth_error_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

constexpr int field_begin = 1 + 2 * max_error_harmonic, signal_begin = field_begin + field_terms;

int field_size(int degree) { return (degree + 1) * (degree + 2) / 2 - 1; }

std::string power_name(const char* name, int power) {
  if (power == 0) return "";
  return power == 1 ? std::string(name) : fmt::format("{}^{}", name, power);
}

/// Factorization with columns of unit size. A small constant on the diagonal regularizes columns
/// that a part of the range cannot separate.
struct ScaledFactor {
  Eigen::VectorXd scale;
  Eigen::LDLT<Eigen::MatrixXd> factor;

  explicit ScaledFactor(Eigen::MatrixXd gram) {
    constexpr double apart = 1e-11;
    scale = gram.diagonal().array().max(1e-300).sqrt().inverse();
    gram = (scale.asDiagonal() * gram * scale.asDiagonal()).eval();
    gram.diagonal().array() += apart;
    factor.compute(gram);
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const {
    return scale.cwiseProduct(factor.solve(scale.cwiseProduct(right)));
  }
};

}  // namespace

std::vector<int> TermChoice::columns() const {
  std::vector<int> chosen = {0};
  for (int h = 0; h < max_error_harmonic; ++h)
    if ((harmonics >> h) & 1u) chosen.insert(chosen.end(), {1 + 2 * h, 2 + 2 * h});
  for (int i = 0; i < field_size(degree); ++i) chosen.push_back(field_begin + i);
  for (int i = 0; i < signal; ++i) chosen.push_back(signal_begin + i);
  return chosen;
}

std::string error_term_name(int column) {
  if (column == 0) return "offset";
  if (column < field_begin)
    return fmt::format("{} {}", column % 2 == 1 ? "cos" : "sin", (column + 1) / 2);
  if (column >= signal_begin) return power_name("log signal", column - signal_begin + 1);
  int degree = 1;
  while (field_begin + field_size(degree) <= column) ++degree;
  const int i = column - field_begin - field_size(degree - 1);
  const std::string row = power_name("row", degree - i), other = power_name("column", i);
  return row + (row.empty() || other.empty() ? "" : " ") + other;
}

void fill_error_terms(double phase_rad, double row, double column, double log_signal,
                      double* terms) {
  *terms++ = 1.0;
  for (int h = 1; h <= max_error_harmonic; ++h) {
    *terms++ = std::cos(h * phase_rad);
    *terms++ = std::sin(h * phase_rad);
  }
  for (int degree = 1; degree <= max_error_degree; ++degree)
    for (int i = 0; i <= degree; ++i) {
      double product = 1.0;
      for (int j = 0; j < degree - i; ++j) product *= row;
      for (int j = 0; j < i; ++j) product *= column;
      *terms++ = product;
    }
  double power = 1.0;
  for (int j = 0; j < max_error_signal; ++j) *terms++ = power *= log_signal;
}

DepthErrorTerms terms_of(const TermChoice& choice, const Eigen::VectorXd& coefficient) {
  DepthErrorTerms terms;
  int harmonics = 0;
  for (int h = 1; h <= max_error_harmonic; ++h)
    if ((choice.harmonics >> (h - 1)) & 1u) harmonics = h;
  terms.harmonic_m = Eigen::VectorXd::Zero(2 * harmonics);
  terms.field_m = Eigen::VectorXd::Zero(field_size(choice.degree));
  terms.signal_m = Eigen::VectorXd::Zero(choice.signal);
  const std::vector<int> columns = choice.columns();
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const int at = columns[k];
    const double value = coefficient[static_cast<Eigen::Index>(k)];
    if (at == 0)
      terms.offset_m = value;
    else if (at < field_begin)
      terms.harmonic_m[at - 1] = value;
    else if (at < signal_begin)
      terms.field_m[at - field_begin] = value;
    else
      terms.signal_m[at - signal_begin] = value;
  }
  return terms;
}

void NormalSums::add(const NormalSums& other) {
  gram += other.gram;
  moment += other.moment;
  square += other.square;
  weight += other.weight;
}

Eigen::VectorXd NormalSums::solve(const std::vector<int>& columns) const {
  return ScaledFactor(gram(columns, columns)).solve(moment(columns));
}

double NormalSums::left(const std::vector<int>& columns, const Eigen::VectorXd& coefficient) const {
  const Eigen::VectorXd product = gram(columns, columns) * coefficient;
  return std::max(0.0, square - 2.0 * coefficient.dot(moment(columns)) + coefficient.dot(product));
}

std::vector<NormalSums> sums_of(const Eigen::MatrixXd& terms, const Eigen::VectorXd& error_m,
                                const Eigen::VectorXd& weight, const std::vector<int>& cell,
                                int cells) {
  constexpr std::int64_t block = 8192;
  const auto count = static_cast<std::int64_t>(terms.cols());
  const auto blocks = static_cast<std::size_t>((count + block - 1) / block);
  std::vector<std::vector<NormalSums>> parts(blocks);
  parallel_for_blocks(count, block, [&](IndexRange range) {
    std::vector<NormalSums> sums(static_cast<std::size_t>(cells));
    for (int c = 0; c < cells; ++c) {
      std::vector<Eigen::Index> of_cell;
      for (Eigen::Index i = range.begin; i < range.end; ++i)
        if (cell[static_cast<std::size_t>(i)] == c && weight[i] > 0.0) of_cell.push_back(i);
      if (of_cell.empty()) continue;
      NormalSums& sum = sums[static_cast<std::size_t>(c)];
      const Eigen::MatrixXd x = terms(Eigen::all, of_cell);
      const Eigen::VectorXd w = weight(of_cell), y = error_m(of_cell);
      const Eigen::MatrixXd weighted = x * w.asDiagonal();
      sum.gram.noalias() = weighted * x.transpose();
      sum.moment.noalias() = weighted * y;
      sum.square = w.dot(y.cwiseAbs2());
      sum.weight = w.sum();
    }
    parts[static_cast<std::size_t>(range.begin / block)] = std::move(sums);
  });
  std::vector<NormalSums> sums(static_cast<std::size_t>(cells));
  for (const auto& part : parts)
    for (std::size_t c = 0; c < sums.size(); ++c) sums[c].add(part[c]);
  return sums;
}

Eigen::VectorXd tile_errors(const Eigen::MatrixXd& terms, const std::vector<int>& columns,
                            const Eigen::VectorXd& slope, const Eigen::VectorXd& influence,
                            const std::vector<int>& tile, int tiles) {
  const auto size = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(size, tiles);
  Eigen::VectorXd x(size);
  for (Eigen::Index i = 0; i < terms.cols(); ++i) {
    if (slope[i] == 0.0 && influence[i] == 0.0) continue;
    x = terms.col(i)(columns);
    gram.selfadjointView<Eigen::Lower>().rankUpdate(x, slope[i]);
    scores.col(tile[static_cast<std::size_t>(i)]) += influence[i] * x;
  }
  gram = gram.selfadjointView<Eigen::Lower>();
  int used = 0;
  for (int t = 0; t < tiles; ++t) used += scores.col(t).squaredNorm() > 0.0;
  const double freedom = std::max(1.0, static_cast<double>(used) - static_cast<double>(size));
  const ScaledFactor factor(gram);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(size);
  for (int t = 0; t < tiles; ++t) variance += factor.solve(scores.col(t)).cwiseAbs2();
  return (variance * (static_cast<double>(used) / freedom)).cwiseSqrt();
}

}  // namespace tofsmith
