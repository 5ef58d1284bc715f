// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

/// First screen of the report of a design: the best code and standard codes, error versus light,
/// waveforms, a scene, and the files with commands.
/// @param files  names in the directory of the report
Section design_front(const Camera& camera, const DesignResult& result,
                     const std::optional<SceneResult>& scene,
                     const std::vector<std::string>& files);

/// Targets (N, K) of a candidate, rotated to its origin of depth; empty without target.
Eigen::MatrixXd rotated_target(const Candidate& candidate);

/// @param best_code  code of the point cloud
Section scene_section(const SceneResult& scene, const Camera& camera, const std::string& best_code);

/// The scene at the middle light level with a standard code and the best code; none if either is
/// missing.
std::optional<Figure> before_after_figure(const SceneResult& scene, const Camera& camera,
                                          const std::string& best_code);

/// Range of true depths, with a margin.
ValueRange depth_range(const SceneImage& truth, const Camera& camera);

/// Decoded minus true depth; colours are clipped at the limit.
ImageReference error_reference(const SceneImage& truth, const Camera& camera, double limit_mm);

ColouredPoints cloud_of(const PinholeView& view, std::string title, const Image<float>& depth_m);

/// Formats as 100, 3.16e+03, 1e+07, like the texts of a design.
inline std::string level_text(double electrons_per_s) {
  return fmt::format("{:.3g}", electrons_per_s);
}

/// Formats in mm; "" if not finite.
inline std::string mm_text(double metres) {
  return std::isfinite(metres) ? fmt::format("{:.1f}", 1e3 * metres) : "";
}

struct DepthErrorRow {
  const DepthErrorReport* error = nullptr;
  std::string method;
  std::optional<Estimate> ratio = {};
};

/// @param best  index of the best code
/// @param with_curves  include error_by_signal()
Section depth_error_section(const Camera& camera, std::span<const DepthErrorRow> codes,
                            std::size_t best, bool with_curves);

/// Circular error versus signal at the middle ambient level, with the bounds of the first code.
Figure error_by_signal(const std::string& id, const Camera& camera,
                       std::span<const DepthErrorRow> codes);

}  // namespace tofsmith
