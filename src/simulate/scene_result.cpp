// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/scene_result.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

void capture_and_decode(SceneResult& scene, std::span<const CodeSet> codes, const Camera& camera,
                        std::span<const NamedLight> lights, std::uint64_t seed,
                        const Progress& progress) {
  scene.captures.clear();
  std::vector<Decoder> decoders;
  for (const CodeSet& code : codes)
    decoders.emplace_back(make_decoding_table(ForwardModel(code, camera), camera));
  const ProgressParts parts(progress, codes.size() * lights.size());
  for (const NamedLight& light : lights) {
    SceneCapture capture_result{light.name, light.point, {}};
    for (std::size_t i = 0; i < codes.size(); ++i) {
      report(parts[scene.captures.size() * codes.size() + i], 0.0,
             fmt::format("{} at {} light", codes[i].name(), light.name));
      const CaptureOptions options{.signal_e_per_s = light.point.signal_e_per_s,
                                   .ambient_e_per_s = light.point.ambient_e_per_s,
                                   .reference_distance_m = scene.reference_distance_m,
                                   .seed = seed};
      const RawFrames raw = capture(scene.truth, codes[i], camera, options);
      SceneDecoding decoding{codes[i].name(), decoders[i].decode(raw).depth_m, {}};
      decoding.error = scene_error(decoding.depth_m, scene.truth, camera, DepthErrorKind::circular);
      capture_result.decodings.push_back(std::move(decoding));
    }
    scene.captures.push_back(std::move(capture_result));
  }
  report(progress, 1.0, "scene decoded");
}

double median_depth_m(const SceneImage& scene) {
  std::vector<double> depths;
  for (const float depth : scene.depth_m.pixels)
    if (std::isfinite(depth)) depths.push_back(depth);
  return depths.empty() ? 1.0 : median_of(std::move(depths));
}

}  // namespace tofsmith
