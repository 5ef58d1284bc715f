// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/cell_table.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

/// log2 of the roots along a side of a face. More roots contain fewer directions but must fit into
/// the cache.
int root_bits_for(int rank, std::int32_t directions) {
  if (rank == 3) return directions <= 500 ? 6 : directions <= 4000 ? 7 : 8;
  return 4;
}
int cut_bits_for(int rank, std::int32_t directions) {
  if (rank == 3) return 0;
  return directions <= 500 ? 1 : 2;
}
/// Cells of long curves take longer to prove.
double cut_share_for(std::int32_t directions) { return directions <= 4000 ? 0.125 : 0.04; }

struct Root {
  CellBox box;
  std::vector<std::int32_t> winners;
  double closeness = 0.0;
};

std::array<std::size_t, max_cell_rank> child_index(std::array<std::size_t, max_cell_rank> index,
                                                   int part, int rank) {
  for (int s = 0; s + 1 < rank; ++s) {
    auto& i = index[static_cast<std::size_t>(s)];
    i = i << 1 | static_cast<std::size_t>(part >> s & 1);
  }
  return index;
}

/// `index` counts boxes of this size along each side.
void split(CellBuilder& builder, int rank, int face, const CellBox& box, int levels,
           std::array<std::size_t, max_cell_rank> index,
           const std::vector<std::int32_t>& candidates, int root_bits, std::vector<Root>& roots) {
  std::vector<std::int32_t> winners;
  builder.winners(box, candidates, winners);
  if (levels == 0) {
    auto at = static_cast<std::size_t>(face);
    for (int s = 0; s + 1 < rank; ++s) at = at << root_bits | index[static_cast<std::size_t>(s)];
    Root& root = roots[at];
    root.box = box;
    root.closeness = builder.closeness(box, winners);
    root.winners = std::move(winners);
    return;
  }
  for (int part = 0; part < 1 << (rank - 1); ++part) {
    split(builder, rank, face, box.child(part, rank), levels - 1, child_index(index, part, rank),
          winners, root_bits, roots);
  }
}

/// `at` counts cells, with the first coordinate slowest.
void cut(CellBuilder& builder, int rank, const CellBox& box, int levels,
         std::array<std::size_t, max_cell_rank> index, int cut_bits,
         const std::vector<std::int32_t>& winners, std::vector<CellRecord>* cells) {
  if (levels == 0) {
    std::size_t at = 0;
    for (int s = 0; s + 1 < rank; ++s) at = at << cut_bits | index[static_cast<std::size_t>(s)];
    builder.runs(box, winners, cells[at]);
    return;
  }
  std::vector<std::int32_t> of_child;
  for (int part = 0; part < 1 << (rank - 1); ++part) {
    const CellBox child = box.child(part, rank);
    builder.winners(child, winners, of_child);
    cut(builder, rank, child, levels - 1, child_index(index, part, rank), cut_bits, of_child,
        cells);
  }
}

}  // namespace

std::uint32_t CellRecord::list_begin() const {
  return static_cast<std::uint16_t>(fit[0]) |
         static_cast<std::uint32_t>(static_cast<std::uint16_t>(fit[1])) << 16;
}

CellRecord CellRecord::list(std::uint32_t begin, std::uint32_t count) {
  CellRecord record;
  record.length = static_cast<std::uint16_t>(several | count);
  record.fit[0] = static_cast<std::int16_t>(static_cast<std::uint16_t>(begin));
  record.fit[1] = static_cast<std::int16_t>(static_cast<std::uint16_t>(begin >> 16));
  return record;
}

bool CellTable::serves(const DistinctDirections& directions) {
  return (directions.rank() == 3 || directions.rank() == 4) &&
         directions.bin.back() < std::numeric_limits<std::uint16_t>::max() &&
         directions.count() <= max_cell_directions;
}

CellTable::CellTable(const DistinctDirections& directions)
    : rank_(directions.rank()),
      root_bits_(root_bits_for(rank_, directions.count())),
      cut_bits_(cut_bits_for(rank_, directions.count())),
      fit_unit_(std::max(8.0, directions.count() / 8.0) / 32767) {
  const int sides = rank_ - 1, faces = 2 * rank_, parts = 1 << sides;
  std::vector<Root> roots(static_cast<std::size_t>(faces) << (sides * root_bits_));
  std::vector<std::int32_t> all(static_cast<std::size_t>(directions.count()));
  std::iota(all.begin(), all.end(), 0);
  parallel_for(faces * parts, [&](std::int64_t i) {
    const int face = static_cast<int>(i) / parts, part = static_cast<int>(i) % parts;
    CellBuilder builder(directions, fit_unit_);
    std::array<std::size_t, max_cell_rank> index{};
    for (int s = 0; s < sides; ++s) index[static_cast<std::size_t>(s)] = part >> s & 1;
    split(builder, rank_, face, CellBox::face(face).child(part, rank_), root_bits_ - 1, index, all,
          root_bits_, roots);
  });

  std::vector<double> closeness;
  for (const Root& root : roots) closeness.push_back(root.closeness);
  const auto cuts = static_cast<std::size_t>(cut_share_for(directions.count()) *
                                             static_cast<double>(roots.size()));
  std::nth_element(closeness.begin(), closeness.begin() + static_cast<std::ptrdiff_t>(cuts),
                   closeness.end(), std::greater<>());
  const double least = cut_bits_ > 0 ? closeness[cuts] : 2.0;
  std::uint32_t cells = 0;
  for (const Root& root : roots) {
    const bool is_cut = root.closeness > least;
    roots_.push_back(cells << 1 | (is_cut ? 1u : 0u));
    cells += is_cut ? 1u << (sides * cut_bits_) : 1u;
  }

  std::vector<Runs> runs(cells);
  parallel_for_blocks(static_cast<std::int64_t>(roots.size()), 64, [&](IndexRange block) {
    CellBuilder builder(directions, fit_unit_);
    for (auto i = static_cast<std::size_t>(block.begin); i < static_cast<std::size_t>(block.end);
         ++i) {
      const std::size_t first = roots_[i] >> 1;
      const int levels = (roots_[i] & 1u) != 0 ? cut_bits_ : 0;
      cut(builder, rank_, roots[i].box, levels, {}, cut_bits_, roots[i].winners, &runs[first]);
    }
  });
  store(runs);
}

void CellTable::store(const std::vector<Runs>& runs) {
  // Without the few very steep fits, one bound suffices for all.
  std::vector<double> steep;
  for (const Runs& of_cell : runs)
    if (of_cell.size() == 1 && of_cell.front().slack != CellRecord::no_proof)
      steep.push_back(steepness(of_cell.front()));
  if (!steep.empty()) {
    const auto high =
        steep.begin() + static_cast<std::ptrdiff_t>(steep.size() - 1 - steep.size() / 1000);
    std::nth_element(steep.begin(), high, steep.end());
    steepest_fit_ = *high;
  }
  for (const Runs& of_cell : runs) {
    const CellRecord& run = of_cell.front();
    if (of_cell.size() == 1 && run.slack != CellRecord::no_proof &&
        steepness(run) <= steepest_fit_) {
      cells_.push_back(run);
      if (rank_ == 3) cells_.back().fit[3] = run.slack;
      continue;
    }
    cells_.push_back(CellRecord::list(static_cast<std::uint32_t>(lists_.size()),
                                      static_cast<std::uint32_t>(of_cell.size())));
    lists_.insert(lists_.end(), of_cell.begin(), of_cell.end());
  }
}

double CellTable::steepness(const CellRecord& run) const {
  double sum = 0.0;
  for (const std::int16_t value : run.fit) sum += std::abs(fit_unit_ * value);
  return sum;
}

std::span<const CellRecord> CellTable::runs(const double* unit) const {
  int axis = 0;
  for (int j = 1; j < rank_; ++j)
    if (std::abs(unit[j]) > std::abs(unit[axis])) axis = j;
  const int bits = root_bits_ + cut_bits_;
  std::size_t root = 2 * static_cast<std::size_t>(axis) + (unit[axis] < 0.0 ? 1 : 0);
  std::size_t cut = 0;
  for (int j = 0; j < rank_; ++j) {
    if (j == axis) continue;
    const double place = std::ldexp(unit[j] / std::abs(unit[axis]) + 1.0, bits - 1);
    const auto fine = static_cast<std::size_t>(std::clamp(place, 0.0, std::ldexp(1.0, bits) - 1.0));
    root = root << root_bits_ | fine >> cut_bits_;
    cut = cut << cut_bits_ | (fine & ((std::size_t{1} << cut_bits_) - 1));
  }
  const std::uint32_t word = roots_[root];
  const CellRecord& record = cells_[(word >> 1) + ((word & 1u) != 0 ? cut : 0)];
  if (!record.is_list()) return {&record, 1};
  return {&lists_[record.list_begin()], record.list_length()};
}

namespace {
// In units of |q|, 1 to 2 on the cube; much larger than tie_tolerance and rounding errors.
constexpr double certain_loss = 1e-9;
// Rounding error of a straight run; smaller than any lead that proves a result.
constexpr double flat = 2e-12;
// Longer runs are too curved for a linear fit with proof.
constexpr std::int32_t longest_proven_run = 40;
// Leads above this exclude ties.
constexpr double clear_lead = 5 * tie_tolerance;

template <typename Use>
void for_each_edge(int sides, const Use& use) {
  for (std::size_t from = 0; from < std::size_t{1} << sides; ++from)
    for (int s = 0; s < sides; ++s) {
      const std::size_t to = from | std::size_t{1} << s;
      if (to != from) use(from, to);
    }
}
}  // namespace

CellBox CellBox::face(int number) {
  CellBox box{.axis = number / 2};
  box.centre[static_cast<std::size_t>(number / 2)] = number % 2 != 0 ? -1.0 : 1.0;
  return box;
}

CellBox CellBox::child(int part, int rank) const {
  CellBox box = *this;
  box.half = 0.5 * half;
  for (int j = 0, s = 0; j < rank; ++j)
    if (j != axis)
      box.centre[static_cast<std::size_t>(j)] += (part >> s++ & 1) != 0 ? box.half : -box.half;
  return box;
}

CellBuilder::CellBuilder(const DistinctDirections& directions, double fit_unit)
    : directions_(&directions),
      rank_(directions.rank()),
      corner_count_(1 << (directions.rank() - 1)),
      count_(directions.count()),
      fit_unit_(fit_unit) {}

CellBuilder::Corners CellBuilder::corners_of(const CellBox& box) const {
  const double half = box.half + CellRecord::overlap;
  Corners corners;
  corners.axis = box.axis;
  corners.side = 2 * half;
  corners.lowest = box.centre;
  for (int j = 0; j < rank_; ++j)
    if (j != box.axis) corners.lowest[static_cast<std::size_t>(j)] -= half;
  for (int part = 0; part < corner_count_; ++part) {
    Place& place = corners.place[static_cast<std::size_t>(part)];
    place.setZero();
    place[0] = 1.0;
    for (int s = 0; s + 1 < rank_; ++s)
      place[s + 1] = ((part >> s & 1) != 0 ? half : -half) / box.half;
  }
  return corners;
}

CellBuilder::Scores CellBuilder::scores_at(const Corners& corners, std::int32_t n) const {
  const double* u = directions_->unit.row(n).data();
  Scores scores;
  scores[0] = 0.0;
  for (int j = 0; j < rank_; ++j) scores[0] += corners.lowest[static_cast<std::size_t>(j)] * u[j];
  std::size_t known = 1;
  for (int j = 0; j < rank_; ++j) {
    if (j == corners.axis) continue;
    const double step = corners.side * u[j];
    for (std::size_t i = 0; i < known; ++i) scores[known + i] = scores[i] + step;
    known *= 2;
  }
  return scores;
}

void CellBuilder::winners(const CellBox& box, const std::vector<std::int32_t>& candidates,
                          std::vector<std::int32_t>& kept) {
  const Corners corners = corners_of(box);
  scores_.clear();
  for (const std::int32_t n : candidates) scores_.push_back(scores_at(corners, n));

  // The best directions at the centre and at the corners exclude most others.
  const auto corner_count = static_cast<std::size_t>(corner_count_);
  std::array<std::size_t, max_corners + 1> leaders{};
  double best_sum = -1e300;
  for (std::size_t k = 0; k < scores_.size(); ++k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < corner_count; ++i) {
      if (scores_[k][i] > scores_[leaders[i + 1]][i]) leaders[i + 1] = k;
      sum += scores_[k][i];
    }
    if (sum <= best_sum) continue;
    best_sum = sum;
    leaders[0] = k;
  }
  const auto last = leaders.begin() + corner_count_ + 1;
  const auto loses_to = [&](const Scores& own, const Scores& other) {
    for (std::size_t i = 0; i < corner_count; ++i)
      if (!(own[i] - other[i] < -certain_loss)) return false;
    return true;
  };
  kept.clear();
  for (std::size_t k = 0; k < scores_.size(); ++k)
    if (std::none_of(leaders.begin(), last,
                     [&](std::size_t m) { return m != k && loses_to(scores_[k], scores_[m]); }))
      kept.push_back(candidates[k]);
}

double CellBuilder::closeness(const CellBox& box,
                              const std::vector<std::int32_t>& candidates) const {
  const Eigen::Map<const Eigen::VectorXd> centre(box.centre.data(), rank_);
  double best = -1.0;
  for (const std::int32_t n : candidates)
    best = std::max(best, directions_->unit.row(n).dot(centre) / centre.norm());
  return best;
}

void CellBuilder::runs(const CellBox& box, const std::vector<std::int32_t>& winners,
                       std::vector<CellRecord>& found) {
  constexpr std::int32_t bridged = 2;  // such gaps do not end a run
  const Corners corners = corners_of(box);
  found.clear();
  const auto end_of_group = [&](std::size_t k) {
    while (k + 1 < winners.size() && winners[k + 1] - winners[k] <= bridged) ++k;
    return k;
  };
  // The last run may continue at the first direction.
  const std::size_t front = end_of_group(0);
  const bool goes_on =
      front + 1 < winners.size() && winners.front() + count_ - winners.back() <= bridged;
  for (std::size_t k = goes_on ? front + 1 : 0; k < winners.size();) {
    const std::size_t end = end_of_group(k);
    const bool is_last = end + 1 == winners.size();
    split(corners, winners[k], goes_on && is_last ? winners[front] + count_ : winners[end], found);
    k = end + 1;
  }
}

/// Splits directions (indices up to 2 M) where the score may have a local minimum.
void CellBuilder::split(const Corners& corners, std::int32_t first, std::int32_t last,
                        std::vector<CellRecord>& found) {
  const auto corner_count = static_cast<std::size_t>(corner_count_);
  leads_.clear();
  Scores own = scores_at(corners, around(first));
  for (std::int32_t n = first; n < last; ++n) {
    const Scores next = scores_at(corners, around(n + 1));
    Scores lead{};
    for (std::size_t i = 0; i < corner_count; ++i) lead[i] = next[i] - own[i];
    leads_.push_back(lead);
    own = next;
  }
  const auto keep = [&](std::int32_t begin, std::int32_t end) {
    CellRecord run;
    run.first = static_cast<std::uint16_t>(around(begin));
    run.length = static_cast<std::uint16_t>(end - begin);
    fit(corners, std::span(leads_).subspan(static_cast<std::size_t>(begin - first), run.length),
        run);
    found.push_back(run);
  };
  std::int32_t begin = first;
  double dips = 0.0;
  for (std::int32_t n = first + 1; n < last; ++n) {
    if (n == begin) continue;
    const Scores& after = leads_[static_cast<std::size_t>(n - first)];
    const Scores& before = leads_[static_cast<std::size_t>(n - first - 1)];
    double dip = 0.0;
    for (std::size_t i = 0; i < corner_count; ++i) dip = std::max(dip, after[i] - before[i]);
    dips += dip;
    if (dips <= flat) continue;
    keep(begin, n);
    begin = n + 1;
    dips = 0.0;
  }
  keep(begin, last);
}

/// Fits x = n + 1/2 to the borders of neighbours on the edges of the box.
void CellBuilder::fit(const Corners& corners, std::span<const Scores> leads,
                      CellRecord& run) const {
  if (run.length == 0) {
    run.slack = 0;
    return;
  }
  constexpr double weight_of_corner = 1e-4;  // to determine the sign of the slope
  Eigen::Matrix<double, max_cell_rank, max_cell_rank> normal;
  normal.setIdentity();
  normal *= 1e-9;
  Place right = Place::Zero();
  const auto add = [&](const Place& place, double value, double weight) {
    normal.noalias() += (weight * place) * place.transpose();
    right += weight * value * place;
  };
  for (std::size_t i = 0; i < static_cast<std::size_t>(corner_count_); ++i) {
    const auto winner = std::count_if(leads.begin(), leads.end(),
                                      [i](const Scores& lead) { return lead[i] > 0.0; });
    add(corners.place[i], static_cast<double>(winner), weight_of_corner);
  }
  const bool is_short = run.length <= longest_proven_run;
  if (is_short)
    for (std::size_t n = 0; n < leads.size(); ++n) {
      const Scores& lead = leads[n];
      for_each_edge(rank_ - 1, [&](std::size_t from, std::size_t to) {
        if ((lead[from] > 0.0) == (lead[to] > 0.0)) return;
        const double t = lead[from] / (lead[from] - lead[to]);
        add((1 - t) * corners.place[from] + t * corners.place[to], static_cast<double>(n) + 0.5,
            1.0);
      });
    }

  const Place solution = normal.ldlt().solve(right) / fit_unit_;
  if (!(solution.cwiseAbs().maxCoeff() < 32767.0)) return;  // no proof
  for (std::size_t s = 0; s < max_cell_rank; ++s)
    run.fit[s] = static_cast<std::int16_t>(std::lround(solution[static_cast<Eigen::Index>(s)]));
  if (!is_short) return;
  const double units = std::ceil(slack(corners, leads, run) / CellRecord::slack_unit) + 1;
  if (units < CellRecord::no_proof) run.slack = static_cast<std::int16_t>(units);
}

/// Returns the maximum distance of x from n + 1/2 on the wrong side: x must be below where n + 1
/// does not clearly beat n, and above where n does not clearly beat n + 1. Both regions are convex,
/// with corners on the edges of the box.
double CellBuilder::slack(const Corners& corners, std::span<const Scores> leads,
                          const CellRecord& run) const {
  Place fit;
  for (std::size_t s = 0; s < max_cell_rank; ++s)
    fit[static_cast<Eigen::Index>(s)] = fit_unit_ * run.fit[s];
  Scores x_at_corner{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(corner_count_); ++i)
    x_at_corner[i] = fit.dot(corners.place[i]);
  double largest = 0.0;
  for (std::size_t n = 0; n < leads.size(); ++n) {
    const double border = static_cast<double>(n) + 0.5;
    const Scores& lead = leads[n];
    for (std::size_t i = 0; i < static_cast<std::size_t>(corner_count_); ++i) {
      if (lead[i] < clear_lead) largest = std::max(largest, x_at_corner[i] - border);
      if (lead[i] > -clear_lead) largest = std::max(largest, border - x_at_corner[i]);
    }
    for_each_edge(rank_ - 1, [&](std::size_t from, std::size_t to) {
      const double change = lead[to] - lead[from];
      if (std::max(lead[from], lead[to]) < -clear_lead ||
          std::min(lead[from], lead[to]) > clear_lead || change == 0.0)
        return;
      for (const double level : {-clear_lead, clear_lead}) {
        const double t = std::clamp((level - lead[from]) / change, 0.0, 1.0);
        const double x = x_at_corner[from] + t * (x_at_corner[to] - x_at_corner[from]);
        largest = std::max(largest, std::abs(x - border));
      }
    });
  }
  return largest;
}

}  // namespace tofsmith
