// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/scene_toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/documents/shared/document_text.hpp"
#include "io/documents/shared/lens_document.hpp"
#include "io/shared/read_file.hpp"
#include "io/text/field_json.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/image_file.hpp"

namespace tofsmith {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// @param plane  suffix after the code's name: "", "-filtered", ...
std::string plane_file_name(const std::string& light, const std::string& code,
                            std::string_view plane = "") {
  return fmt::format("{}-{}{}.npy", file_name_of(light), file_name_of(code), plane);
}

Json error_json(const SceneError& e) {
  return {{"mean_m", e.mean_m},
          {"median_m", e.median_m},
          {"outlier_rate", e.outlier_rate},
          {"decoded_share", e.decoded_share},
          {"pixels", e.pixels},
          {"outlier_threshold_m", e.outlier_threshold_m}};
}

double share(const ValueReader& json, std::string_view member) {
  return json.member(member).number(0.0, 1.0, 1e-9);
}

SceneError error_from_json(const ValueReader& json) {
  const auto length_m = [&](std::string_view member) {
    return json.member(member).number(0.0, infinity, 0.0);
  };
  return {.mean_m = length_m("mean_m"),
          .median_m = length_m("median_m"),
          .outlier_rate = share(json, "outlier_rate"),
          .decoded_share = share(json, "decoded_share"),
          .pixels = json.member("pixels").integer(0, std::numeric_limits<int>::max()),
          .outlier_threshold_m = length_m("outlier_threshold_m")};
}

Image<float> read_image_plane(const fs::path& path, std::string_view what,
                              const SceneImage& truth) {
  Image<float> plane = read_float_image(path, what);
  if (plane.height != truth.height() || plane.width != truth.width())
    throw IoError(path.string(),
                  fmt::format("found {} x {} pixels; expected the {} x {} of true_depth.npy",
                              plane.height, plane.width, truth.height(), truth.width()));
  return plane;
}

SceneImage read_truth(const fs::path& directory) {
  SceneImage truth;
  truth.depth_m = read_float_image(directory / "true_depth.npy", "depth");
  truth.albedo = read_image_plane(directory / "albedo.npy", "albedo", truth);
  truth.cosine = read_image_plane(directory / "cosine.npy", "cosine", truth);
  try {
    truth.validate();
  } catch (const std::invalid_argument& error) {
    throw IoError(directory.string(), error.what());
  }
  return truth;
}

Image<float> read_plane_file(const ValueReader& json, std::string_view member,
                             std::string_view what, const fs::path& directory,
                             const SceneImage& truth) {
  const std::string file = json.member(member).text();
  if (fs::path(file).has_parent_path())
    json.member(member).mistyped("a file of the same directory");
  return read_image_plane(directory / file, what, truth);
}

SceneDecoding read_decoding(const ValueReader& json, const fs::path& directory,
                            const SceneImage& truth) {
  SceneDecoding decoding{.code = json.member("code").text(),
                         .depth_m = read_plane_file(json, "file", "depth", directory, truth),
                         .error = error_from_json(json.member("error"))};
  if (const auto filtered = json.optional_member("filtered"))
    decoding.filtered = {
        .depth_m = read_plane_file(*filtered, "file", "depth", directory, truth),
        .averaged = read_plane_file(*filtered, "averaged_file", "averaged", directory, truth),
        .error = error_from_json(filtered->member("error"))};
  return decoding;
}

Json write_decoding(const SceneDecoding& decoding, const std::string& light,
                    const fs::path& directory, OutputPolicy policy) {
  const std::string file = plane_file_name(light, decoding.code);
  write_float_image(directory / file, decoding.depth_m, "depth", policy);
  Json json = {{"code", decoding.code}, {"file", file}, {"error", error_json(decoding.error)}};
  if (!decoding.filtered) return json;
  const std::string filtered = plane_file_name(light, decoding.code, "-filtered");
  const std::string averaged = plane_file_name(light, decoding.code, "-averaged");
  write_float_image(directory / filtered, decoding.filtered->depth_m, "depth", policy);
  write_float_image(directory / averaged, decoding.filtered->averaged, "averaged", policy);
  json["filtered"] = {{"file", filtered},
                      {"averaged_file", averaged},
                      {"error", error_json(decoding.filtered->error)}};
  return json;
}

}  // namespace

void write_scene_result(const fs::path& directory, const SceneResult& scene, OutputPolicy policy) {
  make_output_directory(directory);
  std::error_code ignored;  // scene.json marks a complete scene
  if (policy == OutputPolicy::overwrite) fs::remove(directory / "scene.json", ignored);
  write_float_image(directory / "true_depth.npy", scene.truth.depth_m, "depth", policy);
  write_float_image(directory / "albedo.npy", scene.truth.albedo, "albedo", policy);
  write_float_image(directory / "cosine.npy", scene.truth.cosine, "cosine", policy);
  Json document = {{"name", scene.name},
                   {"reference_distance_m", scene.reference_distance_m},
                   {"view", lens_document(lens_of(scene.view))},
                   {"captures", Json::array()}};
  for (const SceneCapture& capture : scene.captures) {
    Json decodings = Json::array();
    for (const SceneDecoding& d : capture.decodings)
      decodings.push_back(write_decoding(d, capture.light, directory, policy));
    document["captures"].push_back({{"light", capture.light},
                                    {"signal_e_per_s", capture.point.signal_e_per_s},
                                    {"ambient_e_per_s", capture.point.ambient_e_per_s},
                                    {"decodings", std::move(decodings)}});
  }
  write_file_atomically(directory / "scene.json", document.dump(2), policy);
}

bool holds_scene_result(const fs::path& directory) { return fs::exists(directory / "scene.json"); }

SceneResult read_scene_result(const fs::path& directory) {
  const fs::path path = directory / "scene.json";
  const Document json = parse_json(read_text_file(path), path.string());
  const ValueReader document(json), view = document.member("view");
  SceneResult scene{.name = document.member("name").text(),
                    .truth = read_truth(directory),
                    .reference_distance_m = document.member("reference_distance_m").number()};
  scene.view = view_of(lens_from_json(view), scene.truth.width(), scene.truth.height());
  try {
    scene.view.validate();
  } catch (const std::invalid_argument& error) {
    view.fail(error.what());
  }
  for (const ValueReader& entry : document.member("captures").elements()) {
    SceneCapture capture{.light = entry.member("light").text(),
                         .point = {entry.member("signal_e_per_s").number(),
                                   entry.member("ambient_e_per_s").number()}};
    for (const ValueReader& decoding : entry.member("decodings").elements())
      capture.decodings.push_back(read_decoding(decoding, directory, scene.truth));
    scene.captures.push_back(std::move(capture));
  }
  return scene;
}

DesignedDirectory read_designed_directory(const fs::path& directory) {
  if (!fs::exists(directory / "design.json"))
    throw IoError(directory.string(),
                  "contains no design.json; expected a directory written by `tofsmith design -o` "
                  "or `tofsmith demo -o`");
  DesignedDirectory found{DesignDirectory(directory).read(), {}};
  if (holds_scene_result(directory / "scene")) found.scene = read_scene_result(directory / "scene");
  for (const fs::directory_entry& entry : fs::directory_iterator(directory))
    found.files.push_back(entry.path().filename().string());
  std::ranges::sort(found.files);
  return found;
}

}  // namespace tofsmith
