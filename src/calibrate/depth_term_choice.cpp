// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/depth_term_choice.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/statistics.hpp"

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

namespace {

constexpr int slabs = 4, checkers = 2;

/// Columns of the blocks with data, by frame and row.
using BlocksWithData = std::map<int, std::map<int, std::set<int>>>;

int block_count(const BlocksWithData& blocks) {
  int count = 0;
  for (const auto& [frame, rows] : blocks)
    for (const auto& [row, columns] : rows) count += static_cast<int>(columns.size());
  return count;
}

/// Position of a key in an ordered container.
template <typename Keys, typename Key>
int rank_of(const Keys& keys, const Key& key) {
  return static_cast<int>(std::distance(keys.begin(), keys.find(key)));
}

/// Colour of each sample on a checkerboard of blocks with data, so that both colours have data if
/// two blocks have. Blocks are an eighth of the image or smaller. The colour of samples without
/// weight is arbitrary.
std::vector<int> colours_of(const DepthFit& fit) {
  constexpr int enough_blocks = 8;
  int block_rows = 0, block_columns = 0;
  BlocksWithData blocks;
  for (int divisions = 8; block_rows * block_columns != 1; divisions *= 2) {
    block_rows = std::max(1, fit.height / divisions);
    block_columns = std::max(1, fit.width / divisions);
    blocks.clear();
    for (std::size_t i = 0; i < fit.samples.size(); ++i)
      if (const ReferenceSample& s = fit.samples[i]; fit.weight[static_cast<Eigen::Index>(i)] > 0.0)
        blocks[s.frame][s.row / block_rows].insert(s.column / block_columns);
    if (block_count(blocks) >= enough_blocks) break;
  }
  std::vector<int> colours;
  colours.reserve(fit.samples.size());
  for (const ReferenceSample& s : fit.samples) {
    const auto rows = blocks.find(s.frame);
    if (rows == blocks.end() || !rows->second.contains(s.row / block_rows)) {
      colours.push_back(0);
      continue;
    }
    const std::set<int>& columns = rows->second.at(s.row / block_rows);
    const int ranks = rank_of(blocks, s.frame) + rank_of(rows->second, s.row / block_rows) +
                      rank_of(columns, s.column / block_columns);
    colours.push_back(ranks % checkers);
  }
  return colours;
}

/// Cell of each sample: its colour and its quarter of the range.
std::vector<int> cells_of(const DepthFit& fit) {
  const auto at_m = each(fit.samples, [](const auto& s) { return s.reference_m; });
  std::array<double, slabs - 1> border_m{};
  for (int q = 1; q < slabs; ++q)
    border_m[static_cast<std::size_t>(q - 1)] = quantile_of(at_m, static_cast<double>(q) / slabs);
  std::vector<int> cell = colours_of(fit);
  for (std::size_t i = 0; i < cell.size(); ++i)
    cell[i] += checkers * static_cast<int>(std::ranges::count_if(
                              border_m, [&](double border) { return at_m[i] > border; }));
  return cell;
}

/// Samples that a fold holds out, and the others.
struct Fold {
  NormalSums out, kept;
};

std::vector<Fold> folds_of(const std::vector<NormalSums>& sums, bool by_range) {
  std::vector<Fold> folds;
  for (int fold = 0; fold < (by_range ? slabs : checkers); ++fold) {
    Fold parts;
    for (std::size_t c = 0; c < sums.size(); ++c) {
      const int its = static_cast<int>(c);
      ((by_range ? its / checkers : its % checkers) == fold ? parts.out : parts.kept).add(sums[c]);
    }
    if (parts.out.weight > 0.0 && parts.kept.weight > 0.0) folds.push_back(std::move(parts));
  }
  return folds;
}

/// Rms error on held-out samples; none without folds.
std::optional<double> held_out_rms_m(const std::vector<Fold>& folds, const TermChoice& choice) {
  if (folds.empty()) return {};
  const std::vector<int> columns = choice.columns();
  double left = 0.0, weight = 0.0;
  for (const Fold& fold : folds) {
    left += fold.out.left(columns, fold.kept.solve(columns));
    weight += fold.out.weight;
  }
  return std::sqrt(left / weight);
}

/// Terms that the depths of the reference cannot separate cancel each other and are larger than any
/// depth error.
bool is_plausible(const NormalSums& all, const TermChoice& choice, double range_m) {
  constexpr double largest_share = 0.1;
  return all.solve(choice.columns()).lpNorm<Eigen::Infinity>() < largest_share * range_m;
}

/// On targets of one albedo the signal is a function of depth. Terms in signal and depth would then
/// cancel each other and be wrong in other scenes.
bool signal_varies(const NormalSums& all, int highest_harmonic, int degree) {
  constexpr double least_share = 0.02;
  const std::vector<int> others = TermChoice{(1u << highest_harmonic) - 1u, degree, 0}.columns();
  const int signal = TermChoice{0, 0, 1}.columns().back();
  const NormalSums of_signal{all.gram, all.gram.col(signal), all.gram(signal, signal), all.weight};
  const auto left = [&](const std::vector<int>& columns) {
    return of_signal.left(columns, of_signal.solve(columns));
  };
  return left(others) > least_share * left({0});
}

/// Sets that are common in cameras: for k equally spaced phases, k and 2 k.
std::vector<unsigned> harmonic_sets(int highest) {
  const auto set = [](std::initializer_list<int> list) {
    unsigned bits = 0;
    for (const int h : list) bits |= 1u << (h - 1);
    return bits;
  };
  std::vector<unsigned> sets;
  for (const unsigned bits :
       {0u, set({1}), set({2}), set({3}), set({4}), set({1, 2}), set({2, 4}), set({3, 6}),
        set({4, 8}), set({1, 2, 3}), set({1, 2, 4}), set({1, 2, 3, 4}), set({2, 4, 6, 8}),
        set({1, 2, 3, 4, 8}), set({1, 2, 3, 4, 5, 6}), set({1, 2, 3, 4, 5, 6, 7, 8})})
    if (bits < (1u << highest)) sets.push_back(bits);
  return sets;
}

}  // namespace

Chosen choose(const DepthFit& fit, int highest_harmonic, int max_degree, bool prefer_few) {
  const std::vector<NormalSums> sums =
      sums_of(fit.terms, fit.error_m, fit.weight, cells_of(fit), slabs * checkers);
  struct Candidate {
    TermChoice choice;
    double near_m, far_m;
  };
  NormalSums all;
  for (const NormalSums& cell : sums) all.add(cell);
  const int max_signal = signal_varies(all, highest_harmonic, max_degree) ? max_error_signal : 0;
  const std::vector<Fold> near_folds = folds_of(sums, false), far_folds = folds_of(sums, true);
  std::vector<Candidate> candidates;
  for (const unsigned harmonics : harmonic_sets(highest_harmonic))
    for (int degree = 0; degree <= max_degree; ++degree)
      for (int signal = 0; signal <= max_signal; ++signal) {
        const TermChoice choice{harmonics, degree, signal};
        if (choice.size() > 1 && !is_plausible(all, choice, fit.range_m)) continue;
        candidates.push_back({choice, held_out_rms_m(near_folds, choice).value_or(0.0),
                              held_out_rms_m(far_folds, choice).value_or(0.0)});
      }
  const auto& near = *std::ranges::min_element(candidates, {}, &Candidate::near_m);
  const auto& far = *std::ranges::min_element(candidates, {}, &Candidate::far_m);
  // Use terms in the signal only if they improve the prediction; of the other terms, the most that
  // predict equally well, since omitting a term biases others.
  constexpr double shows = 1.01, as_well = 1.005;
  int signal = near.choice.signal;
  for (const Candidate& c : candidates)
    if (c.near_m <= shows * near.near_m) signal = std::min(signal, c.choice.signal);
  double least_m = std::numeric_limits<double>::infinity();
  for (const Candidate& c : candidates)
    if (c.choice.signal == signal) least_m = std::min(least_m, c.near_m);
  const bool is_few = prefer_few || near_folds.empty();
  const Candidate* best = nullptr;
  for (const Candidate& c : candidates)
    if (c.choice.signal == signal && c.near_m <= as_well * least_m &&
        (!best ||
         (is_few ? c.choice.size() < best->choice.size() : c.choice.size() > best->choice.size())))
      best = &c;
  return {.known = best->choice,
          .beyond = far.choice,
          .known_rms_m = held_out_rms_m(near_folds, best->choice),
          .beyond_rms_m = held_out_rms_m(far_folds, far.choice),
          .skipped_blocks = checkers - static_cast<int>(near_folds.size()),
          .skipped_parts = slabs - static_cast<int>(far_folds.size())};
}

}  // namespace tofsmith
