// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// Bounds at the operating points of a camera that depend only on the number of exposures of a
/// code; computed once for all codes. Not thread-safe.
class CameraBounds {
 public:
  struct Level {
    double receiver_mae_m = 0.0, direct_tof_mae_m = 0.0;
  };

  /// @param camera  as for evaluate(), with albedo and neighbours; must outlive this object
  explicit CameraBounds(const Camera& camera) : camera_(camera) {}

  /// Returns bounds in the order of camera.operating.points(); the receiver's is 0 for rows.
  const std::vector<Level>& of(int exposures);

 private:
  const Camera& camera_;
  std::map<int, std::vector<Level>> levels_;
};

/// As evaluate(), with bounds shared between codes; returns the same values.
/// @param bounds  for the same camera
DepthErrorReport evaluate(const CodeSet& code, const Camera& camera, const EvaluateOptions& options,
                          CameraBounds& bounds, const Progress& progress);

}  // namespace tofsmith
