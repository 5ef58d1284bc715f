// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/shared/whole_vectors.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Number of depths per block; tables of depths have a multiple of this number of rows.
constexpr int depth_block = widest_vector / 2;

/// Electrons of the measurements, and of the light that contributes shot noise, per unit of signal
/// (depths, K) and of ambient light (K). Slopes are per period. As in CramerRaoBound.
struct DepthElectrons {
  Eigen::MatrixXd signal, slope, shot;
  Eigen::VectorXd ambient, shot_ambient;
};

/// Computes Cramer-Rao bounds of depth with unknown signal and ambient light for many depths at
/// once, as DepthPart (simulate/shared/depth_information.hpp): deviations [m] (depths, lights),
/// infinite if depth cannot be separated from signal and ambient light.
void eliminate_light(const DepthElectrons& electrons, const Eigen::VectorXd& constant_e2,
                     std::span<const OperatingPoint> lights, double range_m,
                     Eigen::MatrixXd& deviation_m);

/// Computes the gradient of sum by_deviation deviation_m. Adds the gradient with respect to the
/// electrons to `by_electrons` and overwrites `by_lights`. Infinite deviations do not contribute.
///
/// sigma = range / |across|, and |across| is minimal over the shares of the other two columns:
///   d |across|^2 / 2 = <across, w (d depth - share d signal - share d ambient)>
///                      - sum across^2 / (2 variance) d variance.
void pull_back_elimination(const DepthElectrons& electrons, const Eigen::VectorXd& constant_e2,
                           std::span<const OperatingPoint> lights, double range_m,
                           const Eigen::MatrixXd& by_deviation, DepthElectrons& by_electrons,
                           std::span<OperatingPoint> by_lights);

}  // namespace tofsmith
