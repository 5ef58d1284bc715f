// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "decode/search/cell_table.hpp"
#include "decode/search/distinct_directions.hpp"

namespace tofsmith {

/// A box on a face of the cube.
struct CellBox {
  int axis = 0;                                ///< of the face
  std::array<double, max_cell_rank> centre{};  ///< +-1 along the axis
  double half = 1.0;                           ///< of its sides

  /// The whole face 2 axis + (negative side).
  static CellBox face(int number);
  /// Number `part` of the 2^(rank - 1) boxes of half the side.
  CellBox child(int part, int rank) const;
};

/// Finds what can win in boxes, by proof: a score q.u_n - q.u_m is linear in q, so that its largest
/// value over a box stands at a corner. Boxes are taken with their overlap. Keeps work space: one
/// builder per thread.
class CellBuilder {
 public:
  /// @param fit_unit  of the records' fits
  CellBuilder(const DistinctDirections& directions, double fit_unit);

  /// Those of `candidates` that can win somewhere in a box, ascending.
  void winners(const CellBox& box, const std::vector<std::int32_t>& candidates,
               std::vector<std::int32_t>& kept);
  /// The winners of a box as runs with one peak each.
  void runs(const CellBox& box, const std::vector<std::int32_t>& winners,
            std::vector<CellRecord>& found);
  /// Score of the best of `candidates` at the centre of a box, of unit vectors.
  double closeness(const CellBox& box, const std::vector<std::int32_t>& candidates) const;

 private:
  static constexpr int max_corners = 8;
  using Scores = std::array<double, max_corners>;
  using Place = Eigen::Matrix<double, max_cell_rank, 1>;  // 1, t_1, t_2 ..
  struct Corners {
    int axis = 0;
    double side = 0.0;
    std::array<double, max_cell_rank> lowest{};  // the corner with the least coordinates
    std::array<Place, max_corners> place;
  };

  Corners corners_of(const CellBox& box) const;
  Scores scores_at(const Corners& corners, std::int32_t n) const;
  std::int32_t around(std::int32_t n) const { return n < count_ ? n : n - count_; }
  void split(const Corners& corners, std::int32_t first, std::int32_t last,
             std::vector<CellRecord>& found);
  void fit(const Corners& corners, std::span<const Scores> leads, CellRecord& run) const;
  double slack(const Corners& corners, std::span<const Scores> leads, const CellRecord& run) const;

  const DistinctDirections* directions_;
  int rank_;
  int corner_count_;
  std::int32_t count_;
  double fit_unit_;
  std::vector<Scores> scores_;  // of candidates
  std::vector<Scores> leads_;   // of n + 1 over n at the corners, along a run
};

}  // namespace tofsmith
