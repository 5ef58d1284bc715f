// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// Bounds that depend only on the number and the shares of the exposures. Thread-safe.
class CameraBounds {
 public:
  struct Level {
    double receiver_mae_m = 0.0, direct_tof_mae_m = 0.0;
  };

  /// @param camera  as for evaluate(), with albedo and neighbours; must outlive this object
  explicit CameraBounds(const Camera& camera) : camera_(camera) {}

  /// In the order of camera.operating.points(); the receiver's bound is 0 for rows.
  const std::vector<Level>& of(const CodeSet& code);

 private:
  const Camera& camera_;
  std::mutex mutex_;
  std::map<std::pair<int, std::vector<double>>, std::vector<Level>> levels_;  // and shares
};

/// Shares bounds between codes; same values as evaluate().
/// @param bounds  for the same camera
DepthErrorReport evaluate(const CodeSet& code, const Camera& camera, const EvaluateOptions& options,
                          CameraBounds& bounds, const Progress& progress);

}  // namespace tofsmith
