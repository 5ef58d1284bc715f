// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "io/meshes/embree.hpp"
#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith {

template <typename Handle, void (*Release)(Handle)>
struct EmbreeRelease {
  void operator()(Handle handle) const { Release(handle); }
};
template <typename Handle, void (*Release)(Handle)>
using EmbreeOwner = std::unique_ptr<std::remove_pointer_t<Handle>, EmbreeRelease<Handle, Release>>;
using EmbreeDevice = std::shared_ptr<std::remove_pointer_t<RTCDevice>>;
using EmbreeScene = EmbreeOwner<RTCScene, rtcReleaseScene>;

/// @throws std::runtime_error
EmbreeDevice new_embree_device();

/// Intersects packets of rays with one mesh.
///
/// Embree works in single precision and only selects the triangle. Coordinates are relative to the
/// mesh's centre, in units of its size, and rays start where they reach its bounding sphere, so
/// that the accuracy does not depend on the position of mesh and camera.
class MeshCaster : public MeshSearch {
 public:
  /// @param mesh  must outlive the caster
  MeshCaster(const Mesh& mesh, EmbreeDevice device);

  void trace(std::span<const Ray> rays, std::span<NearestHit> nearest,
             std::int32_t shape) const override;

 private:
  /// World coordinates; the weights of corners b and c are gradient . (point - corner).
  struct Facet {
    Eigen::Vector3d corner, normal, gradient_b, gradient_c;
    std::uint32_t triangle;
  };
  Hit hit_facet(const Facet& facet, const Ray& ray, double share_b, double share_c) const;
  void build();

  EmbreeDevice device_;  ///< outlives scene_
  const Mesh* mesh_;
  std::vector<Facet> facets_;  ///< without triangles of zero area
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double radius_m_ = 0.0;  ///< of the bounding sphere about centre_
  EmbreeScene scene_;
};

}  // namespace tofsmith
