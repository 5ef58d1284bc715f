// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <variant>

#include "decode/ambient_projection.hpp"
#include "decode/raw_scale.hpp"
#include "decode/search/arc_search.hpp"
#include "decode/search/cell_search.hpp"
#include "decode/search/circle_search.hpp"
#include "decode/search/tile_projection.hpp"
#include "tofsmith/core/image.hpp"

namespace tofsmith {

/// Vector of a pixel without ambient light, q = V^T y'.
struct PlaneVector {
  double length = 0.0;    ///< |q| [e]; 0 if a rounding error, NaN if a raw value is not finite
  double residual = 0.0;  ///< |P y'| / |q|, >= 1
  std::array<double, max_measurements> unit;  ///< (rank)
};

class ExactProjection {
 public:
  ExactProjection(const DecodingTable& table, const AmbientProjection& projection)
      : scale_(table), basis_(projection.basis), ambient_(projection.ambient.stableNormalized()) {}

  const RawScale& scale() const { return scale_; }
  int measurements() const { return static_cast<int>(basis_.rows()); }
  int rank() const { return static_cast<int>(basis_.cols()); }

  double electrons(double raw, int measurement) const { return scale_.electrons(raw, measurement); }
  void project(const double* raw, PlaneVector& vector) const;

 private:
  RawScale scale_;
  RowMajorMatrix basis_;     // V (K, rank)
  Eigen::VectorXd ambient_;  // a / |a| (K), or 0
};

/// Finds the bins whose directions match pixels best. Single precision proves most bins; double
/// precision decides the others.
class BinMatcher {
 public:
  /// @param for_few  true if there are too few pixels to amortize a table of cells
  BinMatcher(const DecodingTable& table, const AmbientProjection& projection, bool for_few = false);
  BinMatcher(const BinMatcher&) = delete;
  BinMatcher& operator=(const BinMatcher&) = delete;

  const ExactProjection& exact() const { return exact_; }
  const TileProjection& projection() const { return projection_; }
  const DirectionTable& directions() const { return directions_; }
  using Search = std::variant<std::monostate, CircleSearch, CellSearch>;
  const Search& search() const { return search_; }
  const ArcSearch& arcs() const { return arcs_; }

  /// Fills a tile with the pixels of a view. Bins are -1 if a raw value is NaN or infinite.
  /// @param pixels       1 ... pixels_per_tile
  /// @param for_outputs  see TileProjection::project()
  void match(const RawView& view, std::int64_t first, int pixels, bool for_outputs,
             PixelTile& tile) const;
  /// Matches vectors in tile.plane, which are considered exact; -1 if one is not finite.
  void match_plane(PixelTile& tile) const;

 private:
  bool search(PixelTile& tile) const;
  bool is_precise(const PixelTile& tile, int pixel) const;
  void decide(const RawView& view, std::int64_t first, int pixel, PixelTile& tile) const;
  std::int32_t choose(const double* unit, double tie) const;

  Search make_search(bool for_few) const;
  double min_distance() const;

  DirectionTable directions_;
  ArcSearch arcs_;
  DistinctDirections distinct_;
  Search search_;
  TileProjection projection_;
  ExactProjection exact_;
};

}  // namespace tofsmith
