// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "decode/distinct_directions.hpp"
#include "decode/rival_search.hpp"

namespace tofsmith {

inline constexpr int max_cell_rank = 4;
/// Directions a record can count.
inline constexpr std::int32_t max_cell_directions = 32767;

/// A run of neighbouring directions that may win in a cell of the sphere, among which the score has
/// one peak; or, for a cell with several such runs, where their records are.
struct CellRecord {
  static constexpr std::uint16_t no_rival = 0xffff;
  static constexpr std::uint16_t no_proof = 0xffff;
  static constexpr double slack_unit = 1.0 / 16384;
  static constexpr std::uint16_t several = 0x8000;

  std::uint16_t first = 0;   ///< lowest direction of the run, in [0, M)
  std::uint16_t length = 0;  ///< directions after it, through M to 0; or several
  /// Winner after first, as a real number: x = [0] + sum_s [s] t_s, in units of the table.
  std::array<std::int16_t, max_cell_rank> fit{};
  std::uint16_t rival = no_rival;  ///< bin that scores best outside the main lobe, at the centre
  /// x is right wherever it is further than this from half-way between two directions; no_proof:
  /// nowhere.
  std::uint16_t slack = no_proof;

  bool is_list() const { return (length & several) != 0; }
  /// Of a list: index of its first record, and their number.
  std::uint32_t list_begin() const;
  std::uint32_t list_length() const { return length & (several - 1u); }
  /// The rival in the record's last word; -1 where there is none.
  static std::int32_t rival_in(std::int32_t word) {
    const std::int32_t rival = word & 0xffff;
    return rival == no_rival ? -1 : rival;
  }
  static CellRecord list(std::uint32_t begin, std::uint32_t count);
};
static_assert(sizeof(CellRecord) == 16);

/// Which directions can be the closest one, for every cell of a cube map on the sphere of unit
/// vectors of rank 3 or 4: proven lists. Face 2 j + (q_j < 0) holds the vectors whose largest
/// component is j; its coordinates are c_s = q_s / |q_j| for the other s, in order, cut into G
/// cells each; t_s in [-1, 1] is the place in a cell. Cells reach `overlap` into their neighbours.
class CellTable {
 public:
  static bool serves(const DistinctDirections& directions);
  /// @param directions  with serves(directions)
  CellTable(const DistinctDirections& directions, const RivalSearch& rivals);

  /// How far cells reach beyond their sides, in units of c.
  static constexpr double overlap = 2e-5;

  int rank() const { return rank_; }
  int resolution() const { return resolution_; }
  const CellRecord* cells() const { return cells_.data(); }
  const CellRecord* lists() const { return lists_.data(); }
  /// Unit of CellRecord::fit, in directions.
  double fit_unit() const { return fit_unit_; }
  /// No fit of a cell with one run is steeper: the sum of its sizes, in directions.
  double steepest_fit() const { return steepest_fit_; }
  std::size_t bytes() const { return (cells_.size() + lists_.size()) * sizeof(CellRecord); }

  /// The runs of the cell of a unit vector.
  std::span<const CellRecord> runs(const double* unit) const;

 private:
  int rank_;
  int resolution_;  // G, a power of two
  double fit_unit_;
  double steepest_fit_ = 0.0;
  double steepness(const CellRecord& run) const;

  std::vector<CellRecord> cells_;
  std::vector<CellRecord> lists_;
};

}  // namespace tofsmith
