// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/shared/depth_prior.hpp"
#include "simulate/shared/depth_information.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

/// Calls use(cell, mass, by_depth, part) for the cells of the range in which depth can be decoded:
/// with the probability of the cell, the derivative of the measurements with respect to depth, and
/// its component orthogonal to the derivatives with respect to signal and ambient light.
/// @param camera  the camera of `model`
/// @param cells  from default_cells_per_bin()
template <typename Use>
void for_each_depth_cell(const ForwardModel& model, const Camera& camera, Eigen::Index cells,
                         const Use& use) {
  Eigen::MatrixXd signal, slope;
  middles_and_slopes(
      model.correlation_table(static_cast<int>(2 * cells)) * model.exposure_s().asDiagonal(),
      signal, slope);
  const Eigen::VectorXd ambient =
      model.exposure_s().cwiseProduct(unknown_ambient_gain(model, camera));
  const Eigen::VectorXd masses = DepthPrior(camera).masses(cells);
  for (Eigen::Index j = 0; j < cells; ++j) {
    const Eigen::VectorXd by_depth = slope.row(j);
    const DepthPart<Eigen::VectorXd> part(by_depth, signal.row(j), ambient);
    if (part.length > 0.0)
      use(j, masses.size() > 0 ? masses[j] : 1.0 / static_cast<double>(cells), by_depth, part);
  }
}

}  // namespace tofsmith
