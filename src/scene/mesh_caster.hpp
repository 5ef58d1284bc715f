// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// The nearest surface met so far, and the shape it belongs to.
struct NearestHit {
  Hit hit{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero(), 0.0};
  std::int32_t shape = -1;
};

template <typename Handle, void (*Release)(Handle)>
struct EmbreeRelease {
  void operator()(Handle handle) const { Release(handle); }
};
template <typename Handle, void (*Release)(Handle)>
using EmbreeOwner = std::unique_ptr<std::remove_pointer_t<Handle>, EmbreeRelease<Handle, Release>>;
using EmbreeDevice = EmbreeOwner<RTCDevice, rtcReleaseDevice>;
using EmbreeScene = EmbreeOwner<RTCScene, rtcReleaseScene>;

/// @throws std::runtime_error
EmbreeDevice new_embree_device();

/// One mesh, ready for packets of rays.
///
/// The hierarchy works in single precision: in coordinates about the mesh's own centre, in units
/// of its own size, and on rays that start where they reach it, so that neither the mesh's place
/// nor the camera's distance costs digits. It only names the triangle.
class MeshCaster {
 public:
  static constexpr std::size_t packet = 8;

  /// @param mesh  must outlive the caster
  MeshCaster(const Mesh& mesh, RTCDevice device);

  /// Replaces what is farther than this mesh.
  /// @param rays     at most `packet`
  /// @param nearest  one per ray
  /// @param shape    the mesh's index
  void trace(std::span<const Ray> rays, std::span<NearestHit> nearest, std::int32_t shape) const;

 private:
  /// A triangle of the world; weights of corners b and c are gradient . (point - corner).
  struct Facet {
    Eigen::Vector3d corner, normal, gradient_b, gradient_c;
    std::uint32_t triangle;
  };
  Hit hit_facet(const Facet& facet, const Ray& ray, double share_b, double share_c) const;
  void build(RTCDevice device);

  const Mesh* mesh_;
  std::vector<Facet> facets_;  ///< triangles without area are left out
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double radius_m_ = 0.0;  ///< of a sphere about centre_ that holds the mesh
  EmbreeScene scene_;
};

}  // namespace tofsmith
