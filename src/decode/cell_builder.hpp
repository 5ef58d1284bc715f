// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "decode/cell_table.hpp"

namespace tofsmith {

/// A box on a face of the cube.
struct CellBox {
  int axis = 0;                                ///< of the face
  std::array<double, max_cell_rank> centre{};  ///< +-1 along the axis
  double half = 1.0;                           ///< of its sides

  /// Half number `part` of 2^(rank - 1) halves each way.
  CellBox child(int part, int rank) const;
};

/// Finds what can win in boxes, by proof: a score q.u_n - q.u_m is linear in q, so that its largest
/// value over a box stands at a corner.
class CellBuilder {
 public:
  /// @param fit_unit  of the records' fits
  CellBuilder(const DistinctDirections& directions, const RivalSearch& rivals, double fit_unit);

  /// Those of `candidates` that can win somewhere in a box, ascending.
  std::vector<std::int32_t> winners(const CellBox& box,
                                    const std::vector<std::int32_t>& candidates) const;
  /// The winners of a box as runs with one peak each.
  std::vector<CellRecord> runs(const CellBox& box, const std::vector<std::int32_t>& winners) const;

 private:
  using Vector = std::array<double, max_cell_rank>;
  using Place = Eigen::Matrix<double, max_cell_rank, 1>;  // 1, t_1, t_2 ..
  /// Of a box with its overlap.
  struct Corners {
    int count = 0;
    std::array<Vector, 8> q;
    std::array<Place, 8> place;
  };
  const double* unit(std::int32_t n) const { return directions_->unit.row(n).data(); }
  double score(const Vector& q, std::int32_t n) const;
  Vector corner(const CellBox& box, int part) const;
  std::int32_t best(const Vector& q, const std::vector<std::int32_t>& candidates) const;
  double largest(const CellBox& box, const Vector& difference) const;
  bool has_one_peak_at(const CellBox& box, std::int32_t n) const;
  Corners corners(const CellBox& box) const;
  template <typename Use>
  void for_each_crossing(const Corners& corners, std::int32_t n, double level,
                         const Use& use) const;
  double bias(const Vector& q, std::int32_t n) const;
  std::int32_t winner(const Vector& q, const CellRecord& run) const;
  void fit(const CellBox& box, CellRecord& run) const;
  double slack(const Corners& corners, const CellRecord& run) const;
  std::int32_t rival(const CellBox& box, const CellRecord& run) const;

  const DistinctDirections* directions_;
  const RivalSearch* rivals_;
  int rank_;
  double fit_unit_;
};

}  // namespace tofsmith
