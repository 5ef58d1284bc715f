// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/cell_table.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "decode/search/cell_builder.hpp"
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

}  // namespace tofsmith
