// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/cell_builder.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace tofsmith {

namespace {
// In units of |q|, which is 1 to 2 on the cube: far above tie_tolerance and rounding.
constexpr double certain_loss = 1e-9;
// What rounding makes of a straight run.
constexpr double flat = 1e-13;
}  // namespace

CellBox CellBox::child(int part, int rank) const {
  CellBox box = *this;
  box.half = 0.5 * half;
  for (int j = 0, s = 0; j < rank; ++j)
    if (j != axis)
      box.centre[static_cast<std::size_t>(j)] += (part >> s++ & 1) != 0 ? box.half : -box.half;
  return box;
}

CellBuilder::CellBuilder(const DistinctDirections& directions, const RivalSearch& rivals,
                         double fit_unit)
    : directions_(&directions), rivals_(&rivals), rank_(directions.rank()), fit_unit_(fit_unit) {}

double CellBuilder::score(const Vector& q, std::int32_t n) const {
  const double* u = unit(n);
  double sum = 0.0;
  for (int j = 0; j < rank_; ++j) sum += q[static_cast<std::size_t>(j)] * u[j];
  return sum;
}

CellBuilder::Vector CellBuilder::corner(const CellBox& box, int part) const {
  Vector q = box.centre;
  for (int j = 0, s = 0; j < rank_; ++j)
    if (j != box.axis)
      q[static_cast<std::size_t>(j)] += (part >> s++ & 1) != 0 ? box.half : -box.half;
  return q;
}

std::int32_t CellBuilder::best(const Vector& q, const std::vector<std::int32_t>& candidates) const {
  std::int32_t found = candidates.front();
  double highest = score(q, found);
  for (const std::int32_t n : candidates) {
    const double s = score(q, n);
    if (s > highest) {
      highest = s;
      found = n;
    }
  }
  return found;
}

/// Of <q, difference> over a box and its overlap.
double CellBuilder::largest(const CellBox& box, const Vector& difference) const {
  const double half = box.half + CellTable::overlap;
  double sum = 0.0;
  for (int j = 0; j < rank_; ++j) {
    const double d = difference[static_cast<std::size_t>(j)];
    sum += box.centre[static_cast<std::size_t>(j)] * d + (j != box.axis ? half * std::abs(d) : 0.0);
  }
  return sum;
}

std::vector<std::int32_t> CellBuilder::winners(const CellBox& box,
                                               const std::vector<std::int32_t>& candidates) const {
  std::vector<std::int32_t> rivals{best(box.centre, candidates)};
  for (int part = 0; part < 1 << (rank_ - 1); ++part)
    rivals.push_back(best(corner(box, part), candidates));
  std::sort(rivals.begin(), rivals.end());
  rivals.erase(std::unique(rivals.begin(), rivals.end()), rivals.end());

  std::vector<std::int32_t> kept;
  for (const std::int32_t n : candidates) {
    const bool loses = std::any_of(rivals.begin(), rivals.end(), [&](std::int32_t m) {
      Vector difference{};
      for (int j = 0; j < rank_; ++j)
        difference[static_cast<std::size_t>(j)] = unit(n)[j] - unit(m)[j];
      return largest(box, difference) < -certain_loss;
    });
    if (!loses) kept.push_back(n);
  }
  return kept;
}

/// Whether no score of the box dips at n, below both neighbours' line.
bool CellBuilder::has_one_peak_at(const CellBox& box, std::int32_t n) const {
  const std::int32_t count = directions_->count();
  const double* before = unit(n > 0 ? n - 1 : count - 1);
  const double* after = unit(directions_->next(n));
  Vector bend{};
  for (int j = 0; j < rank_; ++j)
    bend[static_cast<std::size_t>(j)] = after[j] - 2 * unit(n)[j] + before[j];
  return largest(box, bend) <= flat;
}

std::vector<CellRecord> CellBuilder::runs(const CellBox& box,
                                          const std::vector<std::int32_t>& winners) const {
  constexpr std::int32_t bridged = 2;  // a step that skips one direction does not end a run
  const std::int32_t count = directions_->count();
  struct Run {
    std::int32_t first, length;
  };
  std::vector<Run> whole;
  for (const std::int32_t n : winners) {
    if (!whole.empty() && n - (whole.back().first + whole.back().length) <= bridged)
      whole.back().length = n - whole.back().first;
    else
      whole.push_back({n, 0});
  }
  Run& last = whole.back();
  if (whole.size() > 1 && whole.front().first + count - (last.first + last.length) <= bridged) {
    last.length = count + whole.front().first + whole.front().length - last.first;
    whole.erase(whole.begin());
  }

  std::vector<CellRecord> found;
  const auto keep = [&](std::int32_t begin, std::int32_t end) {
    CellRecord run;
    run.first = static_cast<std::uint16_t>(begin % count);
    run.length = static_cast<std::uint16_t>(end - begin);
    fit(box, run);
    const std::int32_t bin = rival(box, run);
    if (bin >= 0) run.rival = static_cast<std::uint16_t>(bin);
    found.push_back(run);
  };
  for (const Run& run : whole) {
    std::int32_t begin = run.first;
    const std::int32_t end = run.first + run.length;
    for (std::int32_t n = begin + 1; n < end; ++n) {
      if (n == begin || has_one_peak_at(box, n % count)) continue;
      keep(begin, n);
      begin = n + 1;
    }
    keep(begin, end);
  }
  return found;
}

/// By how much direction n + 1 beats direction n.
double CellBuilder::bias(const Vector& q, std::int32_t n) const {
  const std::int32_t count = directions_->count();
  return score(q, (n + 1) % count) - score(q, n % count);
}

/// The winner of a run, counted from its first direction.
std::int32_t CellBuilder::winner(const Vector& q, const CellRecord& run) const {
  std::int32_t at = 0;
  while (at < run.length && bias(q, run.first + at) > 0.0) ++at;
  return at;
}

CellBuilder::Corners CellBuilder::corners(const CellBox& box) const {
  CellBox reaching = box;
  reaching.half += CellTable::overlap;
  const double t = reaching.half / box.half;
  Corners found;
  found.count = 1 << (rank_ - 1);
  for (int part = 0; part < found.count; ++part) {
    const auto i = static_cast<std::size_t>(part);
    found.q[i] = corner(reaching, part);
    found.place[i].setZero();
    found.place[i][0] = 1.0;
    for (int s = 0; s + 1 < rank_; ++s) found.place[i][s + 1] = (part >> s & 1) != 0 ? t : -t;
  }
  return found;
}

/// Calls use(place) where <q, u_(n+1) - u_n> passes `level` on an edge of the box.
template <typename Use>
void CellBuilder::for_each_crossing(const Corners& corners, std::int32_t n, double level,
                                    const Use& use) const {
  for (int part = 0; part < corners.count; ++part)
    for (int s = 0; s + 1 < rank_; ++s) {
      const int other = part | 1 << s;
      if (other == part) continue;
      const auto from = static_cast<std::size_t>(part), to = static_cast<std::size_t>(other);
      const double at_from = bias(corners.q[from], n) - level,
                   at_to = bias(corners.q[to], n) - level;
      if ((at_from > 0.0) == (at_to > 0.0)) continue;
      const double t = at_from / (at_from - at_to);
      use(Place((1 - t) * corners.place[from] + t * corners.place[to]));
    }
}

/// Fits x to the borders of neighbours, where they cross the edges of the box: x = n + 1/2 there.
void CellBuilder::fit(const CellBox& box, CellRecord& run) const {
  if (run.length == 0) {
    run.slack = 0;
    return;
  }
  constexpr double weight_of_corner = 1e-4;  // corners only say which way x grows
  const Corners corners = this->corners(box);
  Eigen::Matrix<double, max_cell_rank, max_cell_rank> normal;
  normal.setIdentity();
  normal *= 1e-9;
  Place right = Place::Zero();
  const auto add = [&](const Place& place, double value, double weight) {
    normal += weight * place * place.transpose();
    right += weight * value * place;
  };
  for (int i = 0; i < corners.count; ++i) {
    const auto part = static_cast<std::size_t>(i);
    add(corners.place[part], winner(corners.q[part], run), weight_of_corner);
  }
  for (std::int32_t n = 0; n < run.length; ++n)
    for_each_crossing(corners, run.first + n, 0.0,
                      [&](const Place& place) { add(place, n + 0.5, 1.0); });

  const Place solution = normal.ldlt().solve(right) / fit_unit_;
  if (!(solution.cwiseAbs().maxCoeff() < 32767.0)) return;  // without proof
  for (std::size_t s = 0; s < max_cell_rank; ++s)
    run.fit[s] = static_cast<std::int16_t>(std::lround(solution[static_cast<Eigen::Index>(s)]));
  const double units = std::ceil(slack(corners, run) / CellRecord::slack_unit) + 1;
  if (units < CellRecord::no_proof) run.slack = static_cast<std::uint16_t>(units);
}

/// How far x gets from n + 1/2, at most, on the wrong side: where direction n + 1 does not clearly
/// beat n, x must be below, and above where n does not clearly beat n + 1. Both are convex parts of
/// the box, whose corners are the box's or lie on its edges.
double CellBuilder::slack(const Corners& corners, const CellRecord& run) const {
  constexpr double clear = 5 * tie_tolerance;
  double largest = 0.0;
  const auto x_at = [&](const Place& place) {
    double x = 0.0;
    for (std::size_t s = 0; s < max_cell_rank; ++s)
      x += fit_unit_ * run.fit[s] * place[static_cast<Eigen::Index>(s)];
    return x;
  };
  for (std::int32_t n = 0; n < run.length; ++n) {
    const double border = n + 0.5;
    for (const double level : {-clear, clear})
      for_each_crossing(corners, run.first + n, level, [&](const Place& place) {
        largest = std::max(largest, std::abs(x_at(place) - border));
      });
    for (int i = 0; i < corners.count; ++i) {
      const auto part = static_cast<std::size_t>(i);
      const double lead = bias(corners.q[part], run.first + n), x = x_at(corners.place[part]);
      if (lead < clear) largest = std::max(largest, x - border);
      if (lead > -clear) largest = std::max(largest, border - x);
    }
  }
  return largest;
}

/// The best bin outside the main lobe of the run's winner, for the centre of the box.
std::int32_t CellBuilder::rival(const CellBox& box, const CellRecord& run) const {
  const std::int32_t winner_bin = directions_->bin[static_cast<std::size_t>(
      (run.first + winner(box.centre, run)) % directions_->count())];
  double length2 = 0.0;
  for (const double component : box.centre) length2 += component * component;
  std::array<float, max_cell_rank> unit;
  for (std::size_t j = 0; j < unit.size(); ++j)
    unit[j] = static_cast<float>(box.centre[j] / std::sqrt(length2));
  return rivals_->rival(winner_bin, unit.data());
}

}  // namespace tofsmith
