// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/multipath_error.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();
constexpr std::array delay_edges_m = {0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 1e9};

void sum_multipath_light(MultipathScene& scene, const MultipathReturns& returns) {
  scene.multipath_ratio = {scene.truth.height(), scene.truth.width(), no_value};
  scene.multipath_delay_m = scene.multipath_ratio;
  for (int row = 0; row < scene.truth.height(); ++row)
    for (int column = 0; column < scene.truth.width(); ++column) {
      const double direct_m = scene.truth.depth_m(row, column);
      if (!std::isfinite(direct_m)) continue;
      double ratio = 0.0, delay_m = 0.0;
      for (const MultipathReturn& later : returns.of(row, column)) {
        ratio += later.ratio;
        delay_m += later.ratio * (later.distance_m - direct_m);
      }
      scene.multipath_ratio(row, column) = static_cast<float>(ratio);
      if (ratio > 0.0) scene.multipath_delay_m(row, column) = static_cast<float>(delay_m / ratio);
    }
}

DelayClass class_of(const MultipathScene& scene, double from_m, double to_m) {
  DelayClass found{.from_m = from_m, .to_m = to_m};
  found.bias_m.assign(scene.decodings.size(), 0.0);
  found.error_m = found.bias_m;
  std::vector<std::int64_t> decoded(scene.decodings.size(), 0);
  std::int64_t two = 0, unresolved = 0;
  for (std::size_t i = 0; i < scene.multipath_delay_m.size(); ++i) {
    const double delay_m = scene.multipath_delay_m.pixels[i];
    if (!(delay_m >= from_m && delay_m < to_m)) continue;
    ++found.pixels;
    found.ratio += scene.multipath_ratio.pixels[i];
    two += scene.returns.pixels[i] == ReturnStatus::two;
    unresolved += scene.returns.pixels[i] == ReturnStatus::unresolved;
    for (std::size_t d = 0; d < scene.decodings.size(); ++d) {
      const double error_m = scene.decodings[d].error_m.pixels[i];
      if (!std::isfinite(error_m)) continue;
      ++decoded[d];
      found.bias_m[d] += error_m;
      found.error_m[d] += std::abs(error_m);
    }
  }
  if (found.pixels == 0) return found;
  const auto pixels = static_cast<double>(found.pixels);
  found.ratio /= pixels;
  found.two_share = static_cast<double>(two) / pixels;
  found.unresolved_share = static_cast<double>(unresolved) / pixels;
  for (std::size_t d = 0; d < decoded.size(); ++d) {
    found.bias_m[d] /= static_cast<double>(decoded[d]);
    found.error_m[d] /= static_cast<double>(decoded[d]);
  }
  return found;
}

}  // namespace

MultipathScene multipath_scene(std::string name, const SceneImage& truth, const PinholeView& view,
                               const MultipathReturns& returns, const CodeSet& code,
                               const Camera& camera, const CaptureOptions& light,
                               const MultipathOptions& decoding, const Progress& progress) {
  MultipathScene scene{
      .name = std::move(name), .code = code.name(), .truth = truth, .view = view, .light = light};
  returns.validate(truth, camera.range_m());
  sum_multipath_light(scene, returns);
  const DecodingTable table = make_decoding_table(ForwardModel(code, camera), camera);
  const TwoReturnDecoder two_return(table, decoding);
  SceneLight scene_light;
  scene_light.returns = returns;
  const ProgressParts parts(progress, 2);
  const RawFrames raw = capture(truth, scene_light, code, camera, light, parts[0]);
  const auto add = [&](const char* method, Image<float> depth_m) {
    Image<float> error_m = depth_difference_m(depth_m, truth, camera, DepthErrorKind::circular);
    scene.decodings.push_back({method, std::move(depth_m), std::move(error_m)});
  };
  add("single-path", Decoder(table).decode(raw).depth_m);
  DepthImage decoded = two_return.decode(raw, 0, parts[1]);
  add("two-return", std::move(decoded.depth_m));
  scene.returns = std::move(decoded.returns);
  for (std::size_t i = 0; i + 1 < delay_edges_m.size(); ++i)
    if (DelayClass its = class_of(scene, delay_edges_m[i], delay_edges_m[i + 1]); its.pixels > 0)
      scene.classes.push_back(std::move(its));
  scene.all = class_of(scene, 0.0, delay_edges_m.back());
  return scene;
}

}  // namespace tofsmith
