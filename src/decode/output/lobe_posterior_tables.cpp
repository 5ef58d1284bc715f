// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/output/lobe_posterior.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/shared/whole_vectors.hpp"
#include "decode/search/chord_matcher.hpp"
#include "decode/search/smooth_curve.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

NoiseMetric::NoiseMetric(const RowMajorMatrix& noise_basis, const double* plane,
                         const double* variance_e2)
    : rank_(static_cast<int>(noise_basis.cols())) {
  // Smaller relative variances are rounding errors of noiseless directions.
  constexpr double least_share = 1e-12;
  std::array<double, max_pairs> factor;
  const auto at = [](int i, int j) { return static_cast<std::size_t>(i * (i + 1) / 2 + j); };
  for (int i = 0; i < rank_; ++i)
    for (int j = 0; j <= i; ++j) factor[at(i, j)] = 0.0;
  for (int k = 0; k < static_cast<int>(noise_basis.rows()); ++k) {
    const double* const row = noise_basis.row(k).data();
    for (int i = 0; i < rank_; ++i) {
      const double by = variance_e2[k] * row[i];
      for (int j = 0; j <= i; ++j) factor[at(i, j)] += by * row[j];
    }
  }
  // C = L L^T; the diagonal stores inverses.
  for (int j = 0; j < rank_; ++j) {
    double left = factor[at(j, j)];
    const double floor = least_share * left;
    for (int k = 0; k < j; ++k) left -= factor[at(j, k)] * factor[at(j, k)];
    const double inverse = factor[at(j, j)] = 1.0 / std::sqrt(std::max(left, floor));
    for (int i = j + 1; i < rank_; ++i) {
      double value = factor[at(i, j)];
      for (int k = 0; k < j; ++k) value -= factor[at(i, k)] * factor[at(j, k)];
      factor[at(i, j)] = value * inverse;
    }
  }
  // L^-1 in place
  for (int j = 0; j < rank_; ++j)
    for (int i = j + 1; i < rank_; ++i) {
      double value = factor[at(i, j)] * factor[at(j, j)];
      for (int k = j + 1; k < i; ++k) value += factor[at(i, k)] * factor[at(k, j)];
      factor[at(i, j)] = -value * factor[at(i, i)];
    }
  for (int i = 0; i < rank_; ++i) {
    along_[static_cast<std::size_t>(i)] = 0.0;
    for (int j = 0; j <= i; ++j) {
      double value = 0.0;
      for (int k = i; k < rank_; ++k) value += factor[at(k, i)] * factor[at(k, j)];
      metric_[at(i, j)] = value;
    }
  }
  double square = 0.0;
  for (int i = 0; i < rank_; ++i) {
    double white = 0.0;
    for (int j = 0; j <= i; ++j) white += factor[at(i, j)] * plane[j];
    square += white * white;
    for (int j = 0; j <= i; ++j) along_[static_cast<std::size_t>(j)] += factor[at(i, j)] * white;
  }
  length_ = std::sqrt(square);
}

/// Eigenvalues differ from the mean by at most sqrt(rank - 1) standard deviations.
double NoiseMetric::stretch() const {
  double trace = 0.0, squares = 0.0;
  for (int i = 0, at = 0; i < rank_; ++i)
    for (int j = 0; j <= i; ++j, ++at) {
      const double value = metric_[static_cast<std::size_t>(at)];
      if (i == j) trace += value;
      squares += (i == j ? 1.0 : 2.0) * value * value;
    }
  const double mean = trace / rank_;
  const double reach = std::sqrt((rank_ - 1) * std::max(0.0, squares / rank_ - mean * mean));
  return mean > reach ? std::sqrt((mean + reach) / (mean - reach))
                      : std::numeric_limits<double>::infinity();
}

double NoiseMetric::product(const double* u, const double* w) const {
  double sum = 0.0;
  for (int i = 0, at = 0; i < rank_; ++i)
    for (int j = 0; j <= i; ++j, ++at)
      sum += metric_[static_cast<std::size_t>(at)] *
             (i == j ? u[i] * w[i] : u[i] * w[j] + u[j] * w[i]);
  return sum;
}

double NoiseMetric::signal(const double* u) const {
  double sum = 0.0;
  for (int i = 0; i < rank_; ++i) sum += along_[static_cast<std::size_t>(i)] * u[i];
  return sum;
}

namespace {

constexpr double negligible = 40.0;
const double sqrt_two_pi = std::sqrt(2 * std::numbers::pi);

/// Mills ratio of the normal distribution, to 10 %.
double mills_ratio(double x) { return 2.0 / (x + std::sqrt(x * x + 8.0 / std::numbers::pi)); }

}  // namespace

void ChordMass::add(double c, double factor, bool is_inside) {
  if (!(c > 0.0)) return;
  const double square = 0.5 * c * c;
  if (square > peak_) {
    const double by = std::exp(peak_ - square);
    inside_ *= by;
    outside_ *= by;
    peak_ = square;
  }
  (is_inside ? inside_ : outside_) += factor * sqrt_two_pi / c * std::exp(square - peak_);
}

void ChordMass::add_chord(double from, double to, double cosine, bool is_inside) {
  const double sine2 = 1.0 - cosine * cosine;
  if (!(sine2 > 1e-14)) return add(std::max(from, to), 1.0, is_inside);
  // c(theta) = from cos(theta) + across sin(theta)
  const double sine = std::sqrt(sine2), across = (to - from * cosine) / sine;
  const bool is_within = across >= 0.0 && across * cosine <= from * sine;
  const double rho = std::hypot(from, across);
  const double largest = is_within ? rho : std::max(from, to);
  if (!(largest > 0.0) || 0.5 * largest * largest < peak_ - negligible) return;
  const double angle = std::atan2(sine, cosine), best = std::atan2(across, from);
  const auto past_end = [&](double c, double by) {
    add(c, std::min(1.0, mills_ratio(rho * std::sin(std::min(by, 1.5))) / (rho * angle)),
        is_inside);
  };
  if (!is_within) return from > to ? past_end(from, -best) : past_end(to, best - angle);
  const double both = std::erf(rho * best * std::numbers::sqrt2 / 2) +
                      std::erf(rho * (angle - best) * std::numbers::sqrt2 / 2);
  add(rho, 0.5 * both * sqrt_two_pi / (rho * angle), is_inside);
}

void ChordMass::add_ends(double from, double to, bool is_inside) {
  add(from, 0.5, is_inside);
  add(to, 0.5, is_inside);
}

double ChordMass::share_inside() const {
  const double whole = inside_ + outside_;
  return whole > 0.0 ? inside_ / whole : 1.0;
}

namespace {

/// Far from the lobe, the bound requires a lead larger by 1.22^2, because the curve is long there.
constexpr double far_sine = 1.22;

/// Turn between places of a smooth curve; chords deviate from it by at most 5e-5 rad.
constexpr double place_turn_rad = 0.02;
constexpr int max_places = 1 << 18;

int places_per_row(const RowMajorMatrix& curve) {
  if (!finely_sampled_curve(curve)) return 1;
  const double places = std::ceil(turns_of(curve).maxCoeff() / place_turn_rad);
  const auto most = std::max<Eigen::Index>(1, max_places / curve.rows());
  return static_cast<int>(std::clamp(places, 1.0, static_cast<double>(most)));
}

}  // namespace

LobePosterior::LobePosterior(const DecodingTable& table, const AmbientProjection& projection)
    : rows_(table.samples()),
      rank_(projection.rank()),
      places_per_row_(places_per_row(projection.curve)),
      places_(rows_ * places_per_row_),
      curve_(places_per_row_ > 1 ? RowMajorMatrix(interpolated(projection.curve, places_per_row_))
                                 : projection.curve),
      unit_(curve_.rowwise().normalized()),
      noise_basis_(projection.noise_basis),
      turn_rad_(turns_of(curve_)) {
  const auto has_contrast = [&](std::int32_t n) { return !curve_.row(n).isZero(0.0); };
  for (std::int32_t n = 0; n < places_; ++n)
    if (!has_contrast(n)) unit_.row(n).setZero();
  for (std::int32_t n = 0; n < places_; ++n) {
    const std::int32_t next = n + 1 < places_ ? n + 1 : 0;
    if (turn_rad_[n] > jump_turn_rad || has_contrast(n) != has_contrast(next))
      turn_rad_[n] = std::numeric_limits<double>::infinity();
  }
  sparse_ = make_nodes(sparse_step_rad);
  coarse_ = make_nodes(coarse_step_rad);
  fine_ = make_nodes(fine_step_rad);
  find_lobes();
  find_bounds();
}

MainLobe LobePosterior::main_lobe(std::int32_t row) const {
  return {(lobe(row).left + 0.5) / places_per_row_, (lobe(row).right + 0.5) / places_per_row_};
}

LobePosterior::Window LobePosterior::lobe_window(std::int32_t row) const {
  return {row * places_per_row_ - lobe(row).left, lobe(row).left + lobe(row).right};
}

LobePosterior::Window LobePosterior::window_of(const RangePart& part) const {
  return {static_cast<std::int32_t>(std::lround(part.begin * places_)),
          static_cast<std::int32_t>(std::lround(part.length * places_))};
}

/// The part of a main lobe within a window that contains the row or is next to it.
LobePosterior::Window LobePosterior::lobe_within(std::int32_t row, const Window& allowed) const {
  const std::int32_t place = row * places_per_row_;
  std::int32_t after = (place - allowed.begin + places_) % places_;
  if (after > allowed.length + (places_ - allowed.length) / 2) after -= places_;
  const std::int32_t left = std::clamp(after, 0, lobe(row).left),
                     right = std::clamp(allowed.length - after, 0, lobe(row).right);
  return {place - left, left + right};
}

/// The lobe consists of the places along which the score of the row's own measurements decreases.
void LobePosterior::find_lobes() {
  constexpr double plateau = 1e-9;
  const auto longest =
      std::max<std::int32_t>(1, static_cast<std::int32_t>(max_lobe_share * places_));
  const auto fall = [&](std::int32_t place, std::int32_t step) {
    double last = 1.0;
    for (std::int32_t distance = 1; distance <= longest; ++distance) {
      const std::int32_t other = (place + step * distance + places_) % places_;
      const double score = unit_.row(place).dot(unit_.row(other));
      if (score > last + plateau) return distance - 1;
      last = score;
    }
    return longest;
  };
  lobes_.resize(static_cast<std::size_t>(rows_));
  parallel_for_blocks(rows_, 256, [&](IndexRange rows) {
    for (auto n = static_cast<std::int32_t>(rows.begin); n < rows.end; ++n)
      lobes_[static_cast<std::size_t>(n)] = {fall(n * places_per_row_, -1),
                                             fall(n * places_per_row_, +1)};
  });
}

LobePosterior::Nodes LobePosterior::make_nodes(double step) const {
  Nodes nodes{.step = step};
  std::vector<double> place;
  std::vector<Eigen::RowVectorXd> unit;
  double turned = std::numeric_limits<double>::infinity();
  for (std::int32_t n = 0; n < places_; ++n) {
    const std::int32_t next = n + 1 < places_ ? n + 1 : 0;
    const double turn = turn_rad_[n];
    if (turned + turn > step) {  // also at both ends of a jump
      place.push_back(n);
      unit.emplace_back(unit_.row(n));
      turned = 0.0;
    }
    turned += turn;
    if (!(turn > step) || std::isinf(turn)) continue;
    const int pieces = static_cast<int>(std::ceil(turn / step));
    for (int i = 1; i < pieces; ++i) {
      const double t = static_cast<double>(i) / pieces;
      place.push_back(n + t);
      unit.emplace_back(((1 - t) * curve_.row(n) + t * curve_.row(next)).normalized());
    }
    turned = std::numeric_limits<double>::infinity();
  }
  nodes.count = static_cast<int>(place.size());
  nodes.stride = rounded_up(nodes.count, nodes_per_block);
  const auto stride = static_cast<std::size_t>(nodes.stride);
  nodes.direction.assign(stride * static_cast<std::size_t>(rank_), 0.0f);
  nodes.centre.assign(stride, 0.0f);
  nodes.width.assign(stride, 0.0f);
  for (std::size_t i = 0; i < place.size(); ++i) {
    const double before = i > 0 ? place[i - 1] : place.back() - places_;
    const double after = i + 1 < place.size() ? place[i + 1] : place.front() + places_;
    const double begin = half_way(before, place[i]), end = half_way(place[i], after);
    nodes.centre[i] = static_cast<float>(0.5 * (begin + end));
    nodes.width[i] = static_cast<float>(end - begin);
    for (int j = 0; j < rank_; ++j)
      nodes.direction[static_cast<std::size_t>(j) * stride + i] = static_cast<float>(unit[i][j]);
  }
  return nodes;
}

/// Returns the place at half of the turn, so that one node represents places with the same
/// direction.
double LobePosterior::half_way(double from, double to) const {
  const auto part = [&](std::int32_t n) {
    const double turn = turn_rad_[((n % places_) + places_) % places_];
    return std::min(turn, std::numbers::pi) * (std::min(to, n + 1.0) - std::max(from, 1.0 * n));
  };
  const auto first = static_cast<std::int32_t>(std::floor(from));
  double whole = 0.0, before = 0.0;
  for (std::int32_t n = first; n < to; ++n) whole += part(n);
  if (whole > 0.0)
    for (std::int32_t n = first; n < to; ++n) {
      const double here = part(n), start = std::max(from, 1.0 * n);
      if (before + here >= 0.5 * whole)
        return start + (std::min(to, n + 1.0) - start) * (0.5 * whole - before) / here;
      before += here;
    }
  return 0.5 * (from + to);
}

/// Computes the scores of all nodes once per block of rows, which saves time for fine tables.
void LobePosterior::find_bounds() {
  constexpr double most_products = 5e8;
  const double products = static_cast<double>(rows_) * coarse_.stride * rank_;
  const auto rows_per_block = static_cast<std::int32_t>(std::ceil(products / most_products));
  bounds_.resize(static_cast<std::size_t>(rows_));
  parallel_for_blocks((rows_ + rows_per_block - 1) / rows_per_block, 16, [&](IndexRange blocks) {
    Eigen::RowVectorXf score(coarse_.stride);
    for (auto block = static_cast<std::int32_t>(blocks.begin); block < blocks.end; ++block)
      find_bounds(block * rows_per_block, std::min((block + 1) * rows_per_block, rows_), score);
  });
}

/// Computes the sine of the smallest angle to places outside the main lobe. For far places it
/// includes far_sine and margins for the spacing of nodes and the distance to the middle row.
void LobePosterior::find_bounds(std::int32_t begin, std::int32_t end, Eigen::RowVectorXf& score) {
  const Nodes& nodes = coarse_;
  const double reach = max_lobe_share * places_, half_range = 0.5 * places_;
  const auto angle_of = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
  const auto sine_of = [](double angle) {
    return std::sin(std::clamp(angle, 0.0, 0.5 * std::numbers::pi));
  };
  const auto score_of = [&](std::int32_t from, std::int32_t to) {
    return unit_.row(from).dot(unit_.row((to % places_ + places_) % places_));
  };
  const std::int32_t middle = (begin + end) / 2 * places_per_row_;

  std::int32_t left = places_, right = places_;
  for (std::int32_t n = begin; n < end; ++n) {
    left = std::min(left, lobe(n).left + middle - n * places_per_row_);
    right = std::min(right, lobe(n).right + n * places_per_row_ - middle);
  }
  const double edge =
      std::max(score_of(middle, middle - left - 1), score_of(middle, middle + right + 1));
  score.setZero();
  for (int j = 0; j < rank_; ++j)
    score +=
        static_cast<float>(unit_(middle, j)) *
        Eigen::Map<const Eigen::RowVectorXf>(
            nodes.direction.data() + static_cast<std::ptrdiff_t>(j) * nodes.stride, nodes.stride);
  double far = -1.0;
  for (int i = 0; i < nodes.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    double after = static_cast<double>(nodes.centre[at]) - middle;
    if (after > half_range) after -= places_;
    if (after < -half_range) after += places_;
    const double beyond = after > 0.0 ? after - right : -after - left;
    if (beyond < 0.5 * static_cast<double>(nodes.width[at])) continue;
    if (beyond <= reach && score[i] <= edge) continue;
    far = std::max(far, static_cast<double>(score[i]));
  }

  for (std::int32_t n = begin; n < end; ++n) {
    const std::int32_t place = n * places_per_row_;
    const double own_edge = std::max(score_of(place, place - lobe(n).left - 1),
                                     score_of(place, place + lobe(n).right + 1));
    const double margin =
        0.5 * nodes.step + (end - begin > 1 ? angle_of(score_of(place, middle)) : 0.0);
    const double sine =
        std::min(sine_of(angle_of(own_edge)), sine_of(angle_of(far) - margin) / far_sine);
    bounds_[static_cast<std::size_t>(n)] = {std::sqrt(1.0 - sine * sine), sine};
  }
}

}  // namespace tofsmith
