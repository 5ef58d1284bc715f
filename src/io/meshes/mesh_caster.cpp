// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/mesh_file.hpp"

// Embree 3 and 4 have different functions for ray packets.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "scene/shared/mesh_surface.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

template <typename Handle, void (*Release)(Handle)>
struct EmbreeRelease {
  void operator()(Handle handle) const { Release(handle); }
};
template <typename Handle, void (*Release)(Handle)>
using EmbreeOwner = std::unique_ptr<std::remove_pointer_t<Handle>, EmbreeRelease<Handle, Release>>;
using EmbreeDevice = std::shared_ptr<std::remove_pointer_t<RTCDevice>>;
using EmbreeScene = EmbreeOwner<RTCScene, rtcReleaseScene>;

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

/// Active rays are -1, inactive ones 0.
void intersect_coherent(const int* active, RTCScene scene, RTCRayHit8& packet) {
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect8(active, scene, &packet, &arguments);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(active, scene, &context, &packet);
#endif
}

/// Rounding errors, relative to the mesh's size.
constexpr double single_precision = 1e-6;

void throw_on_error(RTCDevice device, const char* what) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw std::runtime_error(fmt::format("Embree: {}: error {}", what, static_cast<int>(error)));
}

template <typename Item>
Item* new_buffer(RTCDevice device, RTCGeometry geometry, RTCBufferType type, RTCFormat format,
                 std::size_t items) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(Item), items);
  throw_on_error(device, "new buffer");
  return static_cast<Item*>(buffer);
}

EmbreeDevice new_embree_device() {
  EmbreeDevice device(rtcNewDevice(nullptr), [](RTCDevice made) {
    if (made) rtcReleaseDevice(made);
  });
  throw_on_error(device.get(), "new device");
  return device;
}

MeshCaster::MeshCaster(const Mesh& mesh, EmbreeDevice device)
    : device_(std::move(device)), mesh_(&mesh) {
  Eigen::AlignedBox3d bounds;
  for (std::size_t i = 0; i < mesh.triangles.triangles.size(); ++i) {
    const auto [a, b, c] = corners_in_world(mesh, i);
    const Eigen::Vector3d across = (b - a).cross(c - a);
    const double area = across.squaredNorm();
    if (!std::isnormal(area)) continue;
    facets_.push_back({a, across.normalized(), (c - a).cross(across) / area,
                       across.cross(b - a) / area, static_cast<std::uint32_t>(i)});
    bounds.extend(a).extend(b).extend(c);
  }
  if (facets_.empty()) return;
  centre_ = bounds.center();
  radius_m_ = 0.5 * bounds.diagonal().norm() * (1 + single_precision);
  // One thread, because the order of a parallel build would affect which of two triangles a ray
  // along their common edge hits.
  tbb::task_arena(1).execute([&] { build(); });
}

void MeshCaster::build() {
  const RTCDevice device = device_.get();
  const EmbreeOwner<RTCGeometry, rtcReleaseGeometry> geometry(
      rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  throw_on_error(device, "new geometry");
  const auto& vertices = mesh_->triangles.vertices;
  using Vertex = std::array<float, 3>;
  Vertex* vertex = new_buffer<Vertex>(device, geometry.get(), RTC_BUFFER_TYPE_VERTEX,
                                      RTC_FORMAT_FLOAT3, vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3f at =
        ((mesh_->mesh_to_world * (mesh_->scale_m * vertices[i]) - centre_) / radius_m_)
            .cast<float>();
    vertex[i] = {at.x(), at.y(), at.z()};
  }
  using Triangle = std::array<std::uint32_t, 3>;
  Triangle* triangle = new_buffer<Triangle>(device, geometry.get(), RTC_BUFFER_TYPE_INDEX,
                                            RTC_FORMAT_UINT3, facets_.size());
  for (std::size_t i = 0; i < facets_.size(); ++i)
    triangle[i] = mesh_->triangles.triangles[facets_[i].triangle];
  rtcCommitGeometry(geometry.get());

  scene_.reset(rtcNewScene(device));
  throw_on_error(device, "new scene");
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);  // no gaps between adjacent triangles
  rtcAttachGeometry(scene_.get(), geometry.get());
  rtcCommitScene(scene_.get());
  throw_on_error(device, "build");
}

Hit MeshCaster::hit_facet(const Facet& facet, const Ray& ray, double share_b,
                          double share_c) const {
  const Eigen::Vector3d from_corner = ray.origin - facet.corner;
  double distance_m = -facet.normal.dot(from_corner) / facet.normal.dot(ray.direction);
  Eigen::Vector3d on_plane = from_corner + distance_m * ray.direction;
  double weight_b = facet.gradient_b.dot(on_plane), weight_c = facet.gradient_c.dot(on_plane);
  // True also for NaN: a triangle seen exactly edge-on.
  const bool grazed = !(weight_b >= -single_precision && weight_c >= -single_precision &&
                        weight_b + weight_c <= 1 + single_precision);
  if (grazed) weight_b = share_b, weight_c = share_c;
  weight_b = std::clamp(weight_b, 0.0, 1.0);
  weight_c = std::clamp(weight_c, 0.0, 1 - weight_b);
  const Eigen::Vector3d weights(1 - weight_b - weight_c, weight_b, weight_c);
  if (grazed) {
    // For grazing rays, the intersection with the plane may be far from the triangle.
    const auto [a, b, c] = corners_in_world(*mesh_, facet.triangle);
    const Eigen::Vector3d point = weights[0] * a + weights[1] * b + weights[2] * c;
    distance_m = ray.direction.dot(point - ray.origin);
  }
  return {distance_m, facet.normal, mesh_albedo(*mesh_, facet.triangle, weights)};
}

void MeshCaster::trace(std::span<const Ray> rays, std::span<NearestHit> nearest,
                       std::int32_t shape) const {
  TOFSMITH_ASSERT_LE(rays.size(), packet);
  if (facets_.empty()) return;
  alignas(32) std::array<int, packet> active{};
  RTCRayHit8 bundle;
  const double per_m = 1.0 / radius_m_;
  bool any = false;
  for (std::size_t lane = 0; lane < rays.size(); ++lane) {
    const Ray& ray = rays[lane];
    const Eigen::Vector3d to_centre = centre_ - ray.origin;
    const double along_m = to_centre.dot(ray.direction);
    const Eigen::Vector3d aside = along_m * ray.direction - to_centre;
    const double start_m = std::max(0.0, along_m - radius_m_);
    if (!(aside.squaredNorm() <= radius_m_ * radius_m_) || along_m < -radius_m_ ||
        start_m > nearest[lane].hit.distance_m)
      continue;
    const Eigen::Vector3d start = per_m * (aside + (start_m - along_m) * ray.direction);
    bundle.ray.org_x[lane] = static_cast<float>(start.x());
    bundle.ray.org_y[lane] = static_cast<float>(start.y());
    bundle.ray.org_z[lane] = static_cast<float>(start.z());
    bundle.ray.dir_x[lane] = static_cast<float>(ray.direction.x());
    bundle.ray.dir_y[lane] = static_cast<float>(ray.direction.y());
    bundle.ray.dir_z[lane] = static_cast<float>(ray.direction.z());
    bundle.ray.tnear[lane] = 0.0f;
    bundle.ray.tfar[lane] = std::numeric_limits<float>::infinity();
    bundle.ray.time[lane] = 0.0f;
    bundle.ray.mask[lane] = ~0u;
    bundle.ray.id[lane] = 0;
    bundle.ray.flags[lane] = 0;
    bundle.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    bundle.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    active[lane] = -1;
    any = true;
  }
  while (any) {
    intersect_coherent(active.data(), scene_.get(), bundle);
    any = false;
    for (std::size_t lane = 0; lane < rays.size(); ++lane) {
      if (!active[lane]) continue;
      active[lane] = 0;
      if (bundle.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
      const Hit hit = hit_facet(facets_[bundle.hit.primID[lane]], rays[lane],
                                static_cast<double>(bundle.hit.u[lane]),
                                static_cast<double>(bundle.hit.v[lane]));
      if (hit.distance_m > 0.0) {
        if (hit.distance_m < nearest[lane].hit.distance_m) nearest[lane] = {hit, shape};
        continue;
      }
      // The ray starts on this triangle or slightly behind it.
      bundle.ray.tnear[lane] = bundle.ray.tfar[lane] + static_cast<float>(single_precision);
      bundle.ray.tfar[lane] = std::numeric_limits<float>::infinity();
      bundle.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      active[lane] = -1;
      any = true;
    }
  }
}

}  // namespace

MeshSearchMaker embree_search() {
  return [device = EmbreeDevice()](const Mesh& mesh) mutable -> std::unique_ptr<const MeshSearch> {
    if (!device) device = new_embree_device();  // created on first use
    return std::make_unique<MeshCaster>(mesh, device);
  };
}

}  // namespace tofsmith
