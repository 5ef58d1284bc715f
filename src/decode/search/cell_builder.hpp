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

struct CellBox {
  int axis = 0;                                ///< of the face
  std::array<double, max_cell_rank> centre{};  ///< +-1 along the axis
  double half = 1.0;                           ///< half of the side

  /// Whole face; number = 2 axis + (1 if negative).
  static CellBox face(int number);
  /// One of the 2^(rank - 1) boxes with half the side.
  CellBox child(int part, int rank) const;
};

/// Determines with proof which directions can be best in a box: a score difference q.u_n - q.u_m is
/// linear in q, so its maximum is at a corner. Boxes include their overlap. Use one builder per
/// thread.
class CellBuilder {
 public:
  CellBuilder(const DistinctDirections& directions, double fit_unit);

  /// Selects the `candidates` that can be best in a box, in ascending order.
  void winners(const CellBox& box, const std::vector<std::int32_t>& candidates,
               std::vector<std::int32_t>& kept);
  /// Divides the winners of a box into runs with one peak each.
  void runs(const CellBox& box, const std::vector<std::int32_t>& winners,
            std::vector<CellRecord>& found);
  /// Returns the best score at the centre of a box, for unit vectors.
  double closeness(const CellBox& box, const std::vector<std::int32_t>& candidates) const;

 private:
  static constexpr int max_corners = 8;
  using Scores = std::array<double, max_corners>;
  using Place = Eigen::Matrix<double, max_cell_rank, 1>;  // 1, t_1, t_2, ...
  struct Corners {
    int axis = 0;
    double side = 0.0;
    std::array<double, max_cell_rank> lowest{};
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
  std::vector<Scores> scores_;  // of the candidates
  std::vector<Scores> leads_;   // of n + 1 over n at the corners
};

}  // namespace tofsmith
