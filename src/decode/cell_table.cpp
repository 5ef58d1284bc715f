// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/cell_table.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "decode/cell_builder.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

/// Cells along a side of a face. Finer cells hold fewer directions, until they leave the cache.
int resolution_for(int rank, std::int32_t directions) {
  if (rank == 3) return directions <= 600 ? 64 : directions <= 4000 ? 128 : 256;
  return directions <= 4000 ? 16 : 32;
}

/// What one part of a face holds, until the whole table is put together.
struct Leaf {
  std::size_t cell;
  std::vector<CellRecord> runs;
};

/// Splits a box down to cells; `index` counts boxes of this size along each side.
void split(const CellBuilder& builder, int rank, int resolution, int face, const CellBox& box,
           int boxes, std::array<int, max_cell_rank> index,
           const std::vector<std::int32_t>& candidates, std::vector<Leaf>& leaves) {
  const std::vector<std::int32_t> winners = builder.winners(box, candidates);
  if (boxes == resolution) {
    auto cell = static_cast<std::size_t>(face);
    for (int s = 0; s + 1 < rank; ++s)
      cell = cell * static_cast<std::size_t>(resolution) +
             static_cast<std::size_t>(index[static_cast<std::size_t>(s)]);
    leaves.push_back({cell, builder.runs(box, winners)});
    return;
  }
  for (int part = 0; part < 1 << (rank - 1); ++part) {
    std::array<int, max_cell_rank> child{};
    for (int s = 0; s + 1 < rank; ++s)
      child[static_cast<std::size_t>(s)] = 2 * index[static_cast<std::size_t>(s)] + (part >> s & 1);
    split(builder, rank, resolution, face, box.child(part, rank), 2 * boxes, child, winners,
          leaves);
  }
}

CellBox face_box(int face) {
  CellBox box{.axis = face / 2};
  box.centre[static_cast<std::size_t>(face / 2)] = face % 2 != 0 ? -1.0 : 1.0;
  return box;
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
         directions.bin.back() < CellRecord::no_rival && directions.count() <= max_cell_directions;
}

CellTable::CellTable(const DistinctDirections& directions, const RivalSearch& rivals)
    : rank_(directions.rank()),
      resolution_(resolution_for(rank_, directions.count())),
      fit_unit_(std::max(8.0, directions.count() / 8.0) / 32767) {
  const CellBuilder builder(directions, rivals, fit_unit_);
  std::vector<std::int32_t> all(static_cast<std::size_t>(directions.count()));
  std::iota(all.begin(), all.end(), 0);

  // Parts of faces are independent work.
  const int parts = 1 << (rank_ - 1), faces = 2 * rank_;
  std::vector<std::vector<Leaf>> leaves(static_cast<std::size_t>(faces * parts));
  parallel_for(faces * parts, [&](std::int64_t i) {
    const int face = static_cast<int>(i) / parts, part = static_cast<int>(i) % parts;
    const CellBox whole = face_box(face);
    std::array<int, max_cell_rank> index{};
    for (int s = 0; s + 1 < rank_; ++s) index[static_cast<std::size_t>(s)] = part >> s & 1;
    split(builder, rank_, resolution_, face, whole.child(part, rank_), 2, index, all,
          leaves[static_cast<std::size_t>(i)]);
  });

  std::size_t cell_count = static_cast<std::size_t>(faces);
  for (int s = 0; s + 1 < rank_; ++s) cell_count *= static_cast<std::size_t>(resolution_);
  cells_.resize(cell_count);
  // Few cells have the steepest fits; without them one bound serves all.
  std::vector<double> steep;
  for (const auto& of_part : leaves)
    for (const Leaf& leaf : of_part)
      if (leaf.runs.size() == 1 && leaf.runs.front().slack != CellRecord::no_proof)
        steep.push_back(steepness(leaf.runs.front()));
  if (!steep.empty()) {
    const auto high =
        steep.begin() + static_cast<std::ptrdiff_t>(steep.size() - 1 - steep.size() / 100);
    std::nth_element(steep.begin(), high, steep.end());
    steepest_fit_ = *high;
  }
  for (const auto& of_part : leaves)
    for (const Leaf& leaf : of_part) {
      const CellRecord& run = leaf.runs.front();
      if (leaf.runs.size() == 1 && run.slack != CellRecord::no_proof &&
          steepness(run) <= steepest_fit_) {
        cells_[leaf.cell] = run;
        continue;
      }
      cells_[leaf.cell] = CellRecord::list(static_cast<std::uint32_t>(lists_.size()),
                                           static_cast<std::uint32_t>(leaf.runs.size()));
      lists_.insert(lists_.end(), leaf.runs.begin(), leaf.runs.end());
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
  auto cell = static_cast<std::size_t>(2 * axis + (unit[axis] < 0.0 ? 1 : 0));
  for (int j = 0; j < rank_; ++j) {
    if (j == axis) continue;
    const double place = (unit[j] / std::abs(unit[axis]) + 1.0) * 0.5 * resolution_;
    cell = cell * static_cast<std::size_t>(resolution_) +
           static_cast<std::size_t>(std::clamp(static_cast<int>(place), 0, resolution_ - 1));
  }
  const CellRecord& record = cells_[cell];
  if (!record.is_list()) return {&record, 1};
  return {&lists_[record.list_begin()], record.list_length()};
}

}  // namespace tofsmith
