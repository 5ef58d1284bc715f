// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "decode/search/distinct_directions.hpp"

namespace tofsmith {

inline constexpr int max_cell_rank = 4;
/// More directions take too long to prove; a record could count 32767.
inline constexpr std::int32_t max_cell_directions = 16384;

/// A run of neighbouring directions that may win in a cell of the sphere, among which the score has
/// one peak; or, for a cell with several such runs or without a useful fit, where its records are.
struct CellRecord {
  static constexpr std::int16_t no_proof = 0x7fff;
  static constexpr std::uint16_t several = 0x8000;
  static constexpr double slack_unit = 1.0 / 16384;
  /// How far cells reach beyond their sides, in units of c (see CellTable).
  static constexpr double overlap = 2e-5;

  std::uint16_t first = 0;   ///< lowest direction of the run, in [0, M)
  std::uint16_t length = 0;  ///< directions after it, through M to 0; or several
  /// Winner after first, as a real number: x = [0] + sum_s [s] t_s, in units of the table. Cells of
  /// rank 3 hold their slack in the last one.
  std::array<std::int16_t, max_cell_rank> fit{};
  std::uint16_t unused = 0;  ///< fills the record
  /// In units of slack_unit: x is right wherever it is further than this from half-way between two
  /// directions; no_proof (only in lists): nowhere.
  std::int16_t slack = no_proof;

  bool is_list() const { return (length & several) != 0; }
  /// Of a list: index of its first record, and their number.
  std::uint32_t list_begin() const;
  std::uint32_t list_length() const { return length & (several - 1u); }
  static CellRecord list(std::uint32_t begin, std::uint32_t count);
};
static_assert(sizeof(CellRecord) == 16);

/// Which directions can be the closest one, for every cell of a cube map on the sphere of unit
/// vectors of rank 3 or 4: proven lists. Face 2 j + (q_j < 0) holds the vectors whose largest
/// component is j; its coordinates are c_s = q_s / |q_j| for the other s, in order, cut into G
/// roots each. The roots next to the curve, where most pixels are, are cut further into 2^b cells
/// each way, the first coordinate being the slowest; t_s in [-1, 1] is the place in a cell.
class CellTable {
 public:
  static bool serves(const DistinctDirections& directions);
  /// @param directions  with serves(directions)
  explicit CellTable(const DistinctDirections& directions);

  int rank() const { return rank_; }
  /// Roots along a side of a face are 2^root_bits; the cells of a cut one 2^cut_bits.
  int root_bits() const { return root_bits_; }
  int cut_bits() const { return cut_bits_; }
  /// Twice the place of a root's first cell, plus 1 where it is cut.
  std::span<const std::uint32_t> roots() const { return roots_; }
  std::span<const CellRecord> cells() const { return cells_; }
  std::span<const CellRecord> lists() const { return lists_; }
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
