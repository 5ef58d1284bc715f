// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/scene_directory.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/json_text.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/float_image_file.hpp"
#include "tofsmith/io/read_file.hpp"

namespace tofsmith {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

std::string depth_file_name(const std::string& light, const std::string& code) {
  return fmt::format("{}-{}.npy", light, code);
}

Json error_json(const SceneError& e) {
  return {{"mean_m", e.mean_m},
          {"median_m", e.median_m},
          {"outlier_rate", e.outlier_rate},
          {"decoded_share", e.decoded_share},
          {"pixels", e.pixels},
          {"outlier_threshold_m", e.outlier_threshold_m}};
}

SceneError error_from_json(const nlohmann::json& json) {
  return {json.at("mean_m"),        json.at("median_m"), json.at("outlier_rate"),
          json.at("decoded_share"), json.at("pixels"),   json.at("outlier_threshold_m")};
}

}  // namespace

void write_scene_result(const fs::path& directory, const SceneResult& scene, OutputPolicy policy) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error)
    throw IoError(directory.string(), fmt::format("cannot create this directory ({}); expected a "
                                                  "writable place",
                                                  error.message()));
  write_float_image(directory / "true_depth.npy", scene.truth.depth_m, "depth", policy);
  write_float_image(directory / "albedo.npy", scene.truth.albedo, "albedo", policy);
  write_float_image(directory / "cosine.npy", scene.truth.cosine, "cosine", policy);
  Json document = {{"name", scene.name},
                   {"reference_distance_m", scene.reference_distance_m},
                   {"view",
                    {{"fx_px", scene.view.fx_px},
                     {"fy_px", scene.view.fy_px},
                     {"cx_px", scene.view.cx_px},
                     {"cy_px", scene.view.cy_px}}},
                   {"captures", Json::array()}};
  for (const SceneCapture& capture : scene.captures) {
    Json decodings = Json::array();
    for (const SceneDecoding& d : capture.decodings) {
      const std::string file = depth_file_name(capture.light, d.code);
      write_float_image(directory / file, d.depth_m, "depth", policy);
      decodings.push_back({{"code", d.code}, {"file", file}, {"error", error_json(d.error)}});
    }
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
  const nlohmann::json document = parse_json(read_text_file(path), path.string());
  try {
    SceneResult scene;
    scene.name = document.at("name");
    scene.reference_distance_m = document.at("reference_distance_m");
    scene.truth.depth_m = read_float_image(directory / "true_depth.npy", "depth");
    scene.truth.albedo = read_float_image(directory / "albedo.npy", "albedo");
    scene.truth.cosine = read_float_image(directory / "cosine.npy", "cosine");
    scene.truth.validate();
    const auto& view = document.at("view");
    scene.view = {view.at("fx_px"), view.at("fy_px"),    view.at("cx_px"),
                  view.at("cy_px"), scene.truth.width(), scene.truth.height()};
    for (const auto& entry : document.at("captures")) {
      SceneCapture capture{
          entry.at("light"), {entry.at("signal_e_per_s"), entry.at("ambient_e_per_s")}, {}};
      for (const auto& d : entry.at("decodings")) {
        const std::string file = d.at("file");
        if (fs::path(file).has_parent_path())
          throw std::invalid_argument("names a file outside its directory: " + file);
        capture.decodings.push_back({d.at("code"), read_float_image(directory / file, "depth"),
                                     error_from_json(d.at("error"))});
      }
      scene.captures.push_back(std::move(capture));
    }
    return scene;
  } catch (const nlohmann::json::exception& error) {
    throw IoError(
        path.string(),
        fmt::format("is no scene document of this version of tofsmith ({})", error.what()));
  } catch (const std::invalid_argument& error) {
    throw IoError(path.string(), error.what());
  }
}

}  // namespace tofsmith
