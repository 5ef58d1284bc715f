// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/result_document.hpp"

#include "io/documents/camera_document.hpp"
#include "io/text/field_json.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

using Json = nlohmann::ordered_json;

Json class_json(const DelayClass& its) {
  return {{"from_m", its.from_m},
          {"to_m", its.to_m},
          {"pixels", its.pixels},
          {"ratio", its.ratio},
          {"single_path_bias_m", its.bias_m[0]},
          {"single_path_error_m", its.error_m[0]},
          {"bias_m", its.bias_m[1]},
          {"error_m", its.error_m[1]},
          {"two_share", its.two_share},
          {"unresolved_share", its.unresolved_share}};
}

Json scene_json(const MultipathScene& scene) {
  Json document = {{"scene", scene.name},
                   {"code", scene.code},
                   {"signal_e_per_s", scene.light.signal_e_per_s},
                   {"reference_distance_m", scene.light.reference_distance_m},
                   {"ambient_e_per_s", scene.light.ambient_e_per_s},
                   {"delays", Json::array()},
                   {"all", class_json(scene.all)}};
  for (const DelayClass& its : scene.classes) document["delays"].push_back(class_json(its));
  return document;
}

}  // namespace

std::string multipath_document(const Camera& camera, const std::vector<MultipathErrorReport>& codes,
                               const MultipathErrorOptions& options, const MultipathScene* scene) {
  Json document = {{"version", TOFSMITH_VERSION},
                   {"seed", options.seed},
                   {"trials", options.trials},
                   {"ambient_e_per_s", options.ambient_e_per_s},
                   {"threshold", options.decoding.threshold},
                   {"camera", camera_document(camera)},
                   {"codes", Json::array()}};
  for (const MultipathErrorReport& code : codes) {
    Json entry = {{"code", code.code}, {"measurements", code.measurements}};
    if (!code.why_no_two_returns.empty()) entry["why_no_two_returns"] = code.why_no_two_returns;
    if (!code.why_no_tail.empty()) entry["why_no_tail"] = code.why_no_tail;
    for (const MultipathMaps& maps : code.maps) entry["signals"].push_back(fields_json(maps));
    document["codes"].push_back(std::move(entry));
  }
  if (scene) document["scene"] = scene_json(*scene);
  return document.dump(2);
}

}  // namespace tofsmith
