// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/scene_toml.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "io/image_limits.hpp"
#include "io/shared/read_file.hpp"
#include "io/text/field_toml.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/mesh_file.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith {

namespace {

constexpr double rad_per_deg = std::numbers::pi / 180.0;

void read_positive(TableReader& table, std::string_view key, double& number) {
  table.value(key, number);
  if (!(number > 0.0)) table.fail(key, fmt::format("found {}; expected a number > 0", number));
}

void read_share(TableReader& table, std::string_view key, double& number) {
  table.value(key, number);
  if (!(number >= 0.0 && number <= 1.0))
    table.fail(key, fmt::format("found {}; expected a number in [0, 1]", number));
}

/// Reports errors at the position of the file's name.
template <typename Read>
auto read_named_file(TableReader& table, std::string_view key, Read&& read) {
  std::string name;
  table.value(key, name);
  try {
    return read(table.resolve(key, name));
  } catch (const IoError& error) {
    table.fail(key, error.what());
  }
}

Eigen::Matrix3d read_rotation(TableReader& table) {
  Eigen::Vector3d angles_deg = Eigen::Vector3d::Zero();
  table.value("rotation_deg", angles_deg);
  const auto about = [&](int axis) {
    return Eigen::AngleAxisd(angles_deg[axis] * rad_per_deg, Eigen::Vector3d::Unit(axis));
  };
  return (about(2) * about(1) * about(0)).toRotationMatrix();
}

void read_texture_fields(TableReader& table, Texture& texture) {
  using Pattern = Texture::Pattern;
  constexpr std::array<std::string_view, 3> patterns = {"uniform", "checker", "stripes"};
  const bool is_image = table.contains("image");
  if (is_image) {
    table.refuse({"pattern", "other_albedo"}, "a pattern instead of an image");
    texture.pattern = Pattern::image;
    texture.albedo = 1.0;
    bool linear = false;
    table.value("linear", linear);
    texture.image = read_named_file(table, "image", [&](const std::filesystem::path& path) {
      return albedo_of_picture(read_albedo(path, linear ? Transfer::linear : Transfer::srgb),
                               path.string());
    });
  } else {
    table.refuse({"linear"}, "image");
    const auto pattern = table.required("pattern", "\"checker\"").find("pattern");
    texture.pattern = static_cast<Pattern>(pattern->word(patterns));
  }
  read_share(table, "albedo", texture.albedo);
  if (texture.pattern == Pattern::uniform) {
    table.refuse({"other_albedo", "period_m"}, "pattern = \"checker\" or \"stripes\"");
    return;
  }
  if (!is_image) {
    table.required("other_albedo", "0.2");
    read_share(table, "other_albedo", texture.other_albedo);
  }
  read_positive(table, "period_m", texture.period_m);
}

void read_surface(TableReader& table, Texture& texture) {
  if (table.contains("texture")) table.refuse({"albedo"}, "no texture");
  read_share(table, "albedo", texture.albedo);
  table.table("texture", texture, read_texture_fields);
}

Plane read_plane(TableReader& table) {
  Plane plane;
  table.required("point_m", "[0, 0, 2]").value("point_m", plane.point);
  table.required("normal", "[0, 0, -1]").value("normal", plane.normal);
  if (!(plane.normal.norm() > 0.0)) table.fail("normal", "has no length; expected a direction");
  plane.normal /= plane.normal.cwiseAbs().maxCoeff();
  return plane;
}

Box read_box(TableReader& table) {
  Box box;
  table.required("centre_m", "[0, 0, 2]").value("centre_m", box.centre);
  table.required("size_m", "[0.3, 0.5, 0.1]").value("size_m", box.size_m);
  if (!(box.size_m.minCoeff() > 0.0))
    table.fail("size_m", fmt::format("found {}; expected edges > 0", box.size_m.minCoeff()));
  box.rotation = read_rotation(table);
  return box;
}

Sphere read_sphere(TableReader& table) {
  Sphere sphere;
  table.required("centre_m", "[0, 0, 2]").value("centre_m", sphere.centre);
  read_positive(table.required("radius_m", "0.2"), "radius_m", sphere.radius_m);
  return sphere;
}

Capsule read_capsule(TableReader& table) {
  Capsule capsule;
  table.required("start_m", "[0, 0, 2]").value("start_m", capsule.start);
  table.required("end_m", "[0, 0.3, 2]").value("end_m", capsule.end);
  read_positive(table.required("radius_m", "0.05"), "radius_m", capsule.radius_m);
  return capsule;
}

Mesh read_placed_mesh(TableReader& table) {
  Mesh mesh;
  table.required("file", "\"hand.obj\"");
  mesh.triangles = read_named_file(table, "file", read_mesh);
  read_positive(table, "scale_m", mesh.scale_m);
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  table.value("position_m", position_m);
  mesh.mesh_to_world.linear() = read_rotation(table);
  mesh.mesh_to_world.translation() = position_m;
  return mesh;
}

void read_view(TableReader& table, PinholeView& view) {
  int width = view.width, height = view.height;
  table.value("width_px", width);
  table.value("height_px", height);
  for (const auto& [key, size] : {std::pair("width_px", width), std::pair("height_px", height)})
    if (size < 1 || static_cast<std::uint64_t>(size) > max_image_side)
      table.fail(key, fmt::format("found {}; expected 1 to {}", size, max_image_side));
  if (static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) > max_image_pixels)
    table.fail("height_px", fmt::format("found {} x {} pixels; expected at most {} in all", height,
                                        width, max_image_pixels));
  double angle_deg = 60.0;
  table.value("horizontal_angle_deg", angle_deg);
  if (!(angle_deg > 0.0 && angle_deg < 180.0))
    table.fail("horizontal_angle_deg",
               fmt::format("found {}; expected more than 0 and less than 180", angle_deg));
  view = PinholeView::centred(width, height, angle_deg * rad_per_deg);
  if (!table.contains("fx_px")) {
    table.refuse({"fy_px", "cx_px", "cy_px", "distortion_model", "distortion"}, "fx_px");
    return;
  }
  table.refuse({"horizontal_angle_deg"}, "no fx_px");
  read_positive(table, "fx_px", view.fx_px);
  view.fy_px = view.fx_px;
  read_positive(table, "fy_px", view.fy_px);
  table.value("cx_px", view.cx_px);
  table.value("cy_px", view.cy_px);
  FieldReader(table).part(Key("distortion", "Distortion of the lens"), view.distortion);
  try {
    view.validate();
  } catch (const InvalidArgument& error) {
    table.fail("distortion", fmt::format("found {}; {}", error.value(), error.rule()));
  }
}

/// Level rows: the world's y axis is down.
Eigen::Matrix3d looking_along(const TableReader& table, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d across = Eigen::Vector3d::UnitY().cross(direction);
  if (!(direction.norm() > 0.0))
    table.fail("look_at_m", "is the position of the camera; expected another point");
  if (!(across.norm() > 1e-9 * direction.norm()))
    table.fail("look_at_m", "is directly above or below the camera; expected rotation_deg instead");
  Eigen::Matrix3d axes;
  axes.col(0) = across.normalized();
  axes.col(2) = direction.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

Eigen::Vector3d middle_of(const Plane& plane) { return plane.point; }
Eigen::Vector3d middle_of(const Box& box) { return box.centre; }
Eigen::Vector3d middle_of(const Sphere& sphere) { return sphere.centre; }
Eigen::Vector3d middle_of(const Capsule& capsule) { return 0.5 * (capsule.start + capsule.end); }
Eigen::Vector3d middle_of(const Mesh& mesh) { return mesh.mesh_to_world.translation(); }

Motion read_motion(TableReader& table, const Eigen::Vector3d& middle) {
  Motion motion{.turn_centre_m = middle};
  table.value("velocity_m_per_s", motion.velocity_m_per_s);
  Eigen::Vector3d turn_deg_per_s = Eigen::Vector3d::Zero();
  table.value("turn_deg_per_s", turn_deg_per_s);
  motion.turn_rad_per_s = rad_per_deg * turn_deg_per_s;
  if (!table.contains("turn_deg_per_s")) table.refuse({"turn_centre_m"}, "turn_deg_per_s");
  table.value("turn_centre_m", motion.turn_centre_m);
  return motion;
}

void read_camera(TableReader& table, StagedScene& scene) {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> look_at_m;
  table.value("position_m", position_m);
  table.value("look_at_m", look_at_m);
  if (look_at_m) table.refuse({"rotation_deg"}, "no look_at_m");
  scene.camera_to_world.translation() = position_m;
  scene.camera_to_world.linear() =
      look_at_m ? looking_along(table, *look_at_m - position_m) : read_rotation(table);
  scene.camera_motion = read_motion(table, position_m);
}

template <typename Read>
void read_shapes(TableReader& table, std::string_view key, StagedScene& scene, Read&& read) {
  table.tables(key, [&](TableReader& inner) {
    auto shape = read(inner);
    read_surface(inner, shape.texture);
    scene.shape_motions.push_back(read_motion(inner, middle_of(shape)));
    scene.shapes.push_back(std::move(shape));
  });
}

}  // namespace

StagedScene parse_scene_toml(std::string_view text, std::string_view source_name,
                             std::span<const std::string> settings) {
  const Document document = parse_toml(text, source_name, settings);

  StagedScene scene;
  scene.view = PinholeView::centred(320, 240, std::numbers::pi / 3);
  TableReader table(document);
  table.table("view", scene.view, read_view);
  table.table("camera", scene, read_camera);
  read_shapes(table, "plane", scene, read_plane);
  read_shapes(table, "box", scene, read_box);
  read_shapes(table, "sphere", scene, read_sphere);
  read_shapes(table, "capsule", scene, read_capsule);
  read_shapes(table, "mesh", scene, read_placed_mesh);
  table.finish();
  if (scene.shapes.empty())
    throw IoError(source_name,
                  "found no shapes; expected [[plane]], [[box]], [[sphere]], [[capsule]] or "
                  "[[mesh]]");
  if (scene.shapes_are_still()) scene.shape_motions.clear();
  return scene;
}

StagedScene read_scene_toml(const std::filesystem::path& path,
                            std::span<const std::string> settings) {
  return parse_scene_toml(read_text_file(path, max_settings_file_bytes), path.string(), settings);
}

namespace {

namespace fs = std::filesystem;

constexpr int default_width = 320, default_height = 240;

enum class SceneKind { built_in, scene_file, mesh, depth_image };

SceneKind kind_of(const std::string& scene) {
  const std::vector<std::string> names = built_in_scene_names();
  if (std::find(names.begin(), names.end(), scene) != names.end()) return SceneKind::built_in;
  std::error_code ignored;
  if (!fs::exists(scene, ignored) && !fs::path(scene).has_extension()) {
    const std::string near = nearest_word(scene, names);
    throw IoError(scene.empty() ? "scene" : scene,
                  fmt::format("there is no such file and no built-in scene of that name ({}){}",
                              fmt::join(names, ", "),
                              near.empty() ? "" : fmt::format("; did you mean {}?", near)));
  }
  if (fs::path(scene).extension() == ".toml") return SceneKind::scene_file;
  return is_mesh_file(scene) ? SceneKind::mesh : SceneKind::depth_image;
}

void check_fields_fit(const SceneSource& source, SceneKind kind) {
  check_fields(source);
  require(kind == SceneKind::depth_image || source.image.empty(), "image", source.image,
          fmt::format("{} has its own albedo; an albedo image is only valid with a depth image",
                      source.scene));
  if (kind != SceneKind::mesh && source.scale_m)
    reject("scale_m", fmt::format("{}", *source.scale_m),
           "is only valid with a mesh; in a scene file, each [[mesh]] has its own scale_m");
  if (kind == SceneKind::built_in || kind == SceneKind::mesh) return;
  for (const auto& [field, value] :
       {std::pair("width", source.width), std::pair("height", source.height)})
    require(!value, field, value.value_or(0),
            kind == SceneKind::depth_image ? "a depth image has its own size"
                                           : "a scene file specifies its size in [view]");
}

/// Side of the images as specified, or for an optical axis in the middle.
int side_of_lens(std::optional<int> stated, double axis_px, int fallback) {
  constexpr double max_side = 16384;
  const double side = std::round(2.0 * axis_px + 1.0);
  return stated.value_or(side >= 1.0 && side <= max_side ? static_cast<int>(side) : fallback);
}

StagedScene staged_scene(const SceneSource& source, SceneKind kind,
                         const std::optional<Lens>& lens) {
  if (kind == SceneKind::scene_file) return read_scene_toml(source.scene);
  const bool has_pinhole = lens && lens->rays.empty() && !lens->frame_modes;
  const int width = source.width.value_or(
                has_pinhole ? side_of_lens(lens->width_px, lens->cx_px, default_width)
                            : default_width),
            height = source.height.value_or(
                has_pinhole ? side_of_lens(lens->height_px, lens->cy_px, default_height)
                            : default_height);
  StagedScene scene =
      kind == SceneKind::built_in
          ? built_in_scene(source.scene, width, height)
          : framed_mesh(read_mesh(source.scene), source.scale_m.value_or(1.0), width, height);
  if (lens && lens->rays.empty()) scene.view = view_of(lens, width, height);
  return scene;
}

void require_size(const Image<float>& picture, const std::string& file, const SceneImage& scene,
                  const std::string& scene_file) {
  if (picture.height == scene.height() && picture.width == scene.width()) return;
  throw IoError(file,
                fmt::format("is {} x {} pixels; expected {} x {}, the size of {}", picture.height,
                            picture.width, scene.height(), scene.width(), scene_file));
}

Transfer transfer_of(const SceneSource& source) {
  return source.linear_image ? Transfer::linear : Transfer::srgb;
}

LoadedScene depth_image(const SceneSource& source, const std::optional<Lens>& lens) {
  const Image<float> depth_m = read_depth(source.scene);
  LoadedScene scene{fs::path(source.scene).stem().string(),
                    SceneImage(depth_m.height, depth_m.width),
                    view_of(lens, depth_m.width, depth_m.height),
                    {}};
  scene.image.depth_m = depth_kind_of(source.scene, source.kind, DepthKind::z) == DepthKind::z
                            ? radial_from_z(depth_m, rays_of(lens, scene.view))
                            : depth_m;
  if (!source.image.empty()) {
    Image<float> picture = read_albedo(source.image, transfer_of(source));
    require_size(picture, source.image, scene.image, source.scene);
    for (const float value : picture.pixels)
      if (value > scene.brightest_albedo) scene.brightest_albedo = value;
    scene.image.albedo = albedo_of_picture(std::move(picture), source.image, scene.image.depth_m);
  }
  return scene;
}

LoadedScene load(const SceneSource& source, SceneKind kind, const std::optional<Lens>& lens) {
  if (kind == SceneKind::depth_image) return depth_image(source, lens);
  StagedScene staged = staged_scene(source, kind, lens);
  const StagedScene now = staged.at(source.time_s);
  SceneImage image = ray_cast(now.shapes, now.view, now.camera_to_world, embree_search());
  check_view(now, image);
  return {kind == SceneKind::built_in ? source.scene : fs::path(source.scene).stem().string(),
          std::move(image), staged.view, std::move(staged)};
}

}  // namespace

LoadedScene load_scene(const SceneSource& source, const std::optional<Lens>& lens) {
  const SceneKind kind = kind_of(source.scene);
  check_fields_fit(source, kind);
  try {
    LoadedScene scene = load(source, kind, lens);
    if (!source.ambient_image.empty()) {
      scene.image.ambient_scale = read_ambient_scale(source.ambient_image, transfer_of(source));
      require_size(scene.image.ambient_scale, source.ambient_image, scene.image, source.scene);
    }
    scene.image.validate();
    return scene;
  } catch (const std::invalid_argument& error) {  // the error is in a file, not in an argument
    throw IoError(source.scene, error.what());
  }
}

}  // namespace tofsmith
