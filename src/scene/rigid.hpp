// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

/// @throws std::invalid_argument unless the pose is finite and preserves lengths and handedness
inline void require_rigid(const Eigen::Isometry3d& pose, std::string_view field) {
  const Eigen::Matrix3d turn = pose.linear();
  const Eigen::Vector3d shift = pose.translation();
  const std::string name(field);
  require(shift.allFinite(), name + ".translation", shift.transpose(), "must be finite");
  const double skew = (turn.transpose() * turn - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  require(skew < 1e-6, name + ".rotation", skew,
          "must have orthonormal columns (deviation shown)");  // also fails for NaN
  require(turn.determinant() > 0.0, name + ".rotation", turn.determinant(),
          "must not mirror (determinant shown)");
}

}  // namespace tofsmith
