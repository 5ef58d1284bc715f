// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// Bounds at the operating points of a camera that know of a code only how many exposures it has:
/// computed once for all codes that are judged on the camera. Not for several threads at a time.
class CameraBounds {
 public:
  struct Level {
    double receiver_mae_m = 0.0, direct_tof_mae_m = 0.0;
  };

  /// @param camera  as for evaluate(), with albedo and neighbours; must outlive this
  explicit CameraBounds(const Camera& camera) : camera_(camera) {}

  /// In the order of camera.operating.points(); the receiver's is 0 where the camera reads rows.
  const std::vector<Level>& of(int exposures);

 private:
  const Camera& camera_;
  std::map<int, std::vector<Level>> levels_;
};

/// evaluate() with bounds that are shared with other codes: the same figures.
/// @param bounds  of the same camera
DepthErrorReport evaluate(const CodeSet& code, const Camera& camera, const EvaluateOptions& options,
                          CameraBounds& bounds, const Progress& progress);

}  // namespace tofsmith
