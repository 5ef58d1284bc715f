// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "decode/search/direction_table.hpp"

namespace tofsmith {

inline constexpr int max_cell_rank = 4;
/// Limits construction time; records support up to 32767.
inline constexpr std::int32_t max_cell_directions = 16384;

/// Run of neighbouring directions that can be best in a cell, with one peak of the score, or the
/// location of several runs.
struct CellRecord {
  static constexpr std::int16_t no_proof = 0x7fff;
  static constexpr std::uint16_t several = 0x8000;
  static constexpr double slack_unit = 1.0 / 16384;
  /// Overlap of neighbouring cells, in c (see CellTable).
  static constexpr double overlap = 2e-5;

  std::uint16_t first = 0;   ///< lowest direction, in [0, M)
  std::uint16_t length = 0;  ///< directions after it (cyclic), or `several`
  /// Best direction relative to first: x = [0] + sum_s [s] t_s, in units of the table. For rank 3,
  /// the last entry is the slack.
  std::array<std::int16_t, max_cell_rank> fit{};
  std::uint16_t unused = 0;  ///< padding
  /// In units of slack_unit: x is correct if it is further than this from midpoints between
  /// directions; no_proof (only in lists): never.
  std::int16_t slack = no_proof;

  bool is_list() const { return (length & several) != 0; }
  /// First record and number of records.
  std::uint32_t list_begin() const;
  std::uint32_t list_length() const { return length & (several - 1u); }
  static CellRecord list(std::uint32_t begin, std::uint32_t count);
};
static_assert(sizeof(CellRecord) == 16);

/// Cube map on the sphere of unit vectors of rank 3 or 4. Each cell has a proven list of directions
/// that can be closest. Face 2 j + (q_j < 0) contains the vectors whose largest component is j. Its
/// coordinates c_s = q_s / |q_j| are divided into G roots each. Roots next to the curve, which
/// contain most pixels, are cut into 2^b cells per side, with the first coordinate slowest. t_s in
/// [-1, 1] is the position in a cell.
class CellTable {
 public:
  static bool serves(const DistinctDirections& directions);
  explicit CellTable(const DistinctDirections& directions);

  int rank() const { return rank_; }
  /// log2 of the roots per side of a face, and of the cells per side of a cut root.
  int root_bits() const { return root_bits_; }
  int cut_bits() const { return cut_bits_; }
  /// Twice the index of the first cell, plus 1 if the root is cut.
  std::span<const std::uint32_t> roots() const { return roots_; }
  std::span<const CellRecord> cells() const { return cells_; }
  std::span<const CellRecord> lists() const { return lists_; }
  /// Unit of CellRecord::fit [directions].
  double fit_unit() const { return fit_unit_; }
  /// Maximum sum of absolute coefficients of fits of cells with one run [directions].
  double steepest_fit() const { return steepest_fit_; }

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
