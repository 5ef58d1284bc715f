// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "decode/cell_record.hpp"
#include "decode/distinct_directions.hpp"
#include "decode/rival_search.hpp"

namespace tofsmith {

/// Which directions can be the closest one, for every cell of a cube map on the sphere of unit
/// vectors of rank 3 or 4: proven lists. Face 2 j + (q_j < 0) holds the vectors whose largest
/// component is j; its coordinates are c_s = q_s / |q_j| for the other s, in order, cut into G
/// roots each. The roots next to the curve, where most pixels are, are cut further into 2^b cells
/// each way, the first coordinate being the slowest; t_s in [-1, 1] is the place in a cell.
class CellTable {
 public:
  static bool serves(const DistinctDirections& directions);
  /// @param directions  with serves(directions)
  CellTable(const DistinctDirections& directions, const RivalSearch& rivals);

  int rank() const { return rank_; }
  /// Roots along a side of a face are 2^root_bits; the cells of a cut one 2^cut_bits.
  int root_bits() const { return root_bits_; }
  int cut_bits() const { return cut_bits_; }
  /// Twice the place of a root's first cell, plus 1 where it is cut.
  const std::uint32_t* roots() const { return roots_.data(); }
  const CellRecord* cells() const { return cells_.data(); }
  const CellRecord* lists() const { return lists_.data(); }
  /// Unit of CellRecord::fit, in directions.
  double fit_unit() const { return fit_unit_; }
  /// No fit of a cell with one run is steeper: the sum of its sizes, in directions.
  double steepest_fit() const { return steepest_fit_; }
  std::size_t bytes() const {
    return (cells_.size() + lists_.size()) * sizeof(CellRecord) +
           roots_.size() * sizeof(std::uint32_t);
  }

  /// The runs of the cell of a unit vector.
  std::span<const CellRecord> runs(const double* unit) const;

 private:
  using Runs = std::vector<CellRecord>;
  double steepness(const CellRecord& run) const;
  void store(const std::vector<Runs>& runs);

  int rank_;
  int root_bits_;
  int cut_bits_;
  double fit_unit_;
  double steepest_fit_ = 0.0;
  std::vector<std::uint32_t> roots_;
  std::vector<CellRecord> cells_;
  std::vector<CellRecord> lists_;
};

}  // namespace tofsmith
