// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>

#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// The nearest surface met so far, and the index of the shape it belongs to.
struct NearestHit {
  Hit hit{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero(), 0.0};
  std::int32_t shape = -1;  ///< -1: none
};

/// Finds the nearest triangle of one mesh that rays meet.
/// @note immutable; trace() may be called by several threads
class MeshSearch {
 public:
  static constexpr std::size_t packet = 8;  ///< rays at a time, at most

  virtual ~MeshSearch() = default;
  /// Replaces what is farther than this mesh.
  /// @param rays     at most `packet`
  /// @param nearest  one per ray
  /// @param shape    the mesh's index
  virtual void trace(std::span<const Ray> rays, std::span<NearestHit> nearest,
                     std::int32_t shape) const = 0;
};

/// Makes the search of a mesh that outlives it. embree_search() of tofsmith/io is one; an empty one
/// tries every triangle.
using MeshSearchMaker = std::function<std::unique_ptr<const MeshSearch>(const Mesh& mesh)>;

}  // namespace tofsmith
