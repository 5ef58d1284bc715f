// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/shared/whole_vectors.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Tables are padded to whole blocks.
constexpr int depth_block = widest_vector / 2;

/// Electrons and their shot noise per unit of signal (depths, K) and of ambient light (K); slopes
/// per period.
struct DepthElectrons {
  Eigen::MatrixXd signal, slope, shot;
  Eigen::VectorXd ambient, shot_ambient;
};

/// Computes Cramer-Rao bounds of depth with unknown light levels (see DepthPart): deviations [m]
/// (depths, lights), infinite if depth cannot be separated.
void eliminate_light(const DepthElectrons& electrons, const Eigen::VectorXd& constant_e2,
                     std::span<const OperatingPoint> lights, double range_m,
                     Eigen::MatrixXd& deviation_m);

/// Computes the gradient of sum by_deviation deviation_m: adds to `by_electrons`, overwrites
/// `by_lights`. Infinite deviations do not contribute.
///
/// sigma = range / |across|, and |across| is minimal over the shares:
///   d |across|^2 / 2 = <across, w (d depth - share d signal - share d ambient)>
///                      - sum across^2 / (2 variance) d variance.
void pull_back_elimination(const DepthElectrons& electrons, const Eigen::VectorXd& constant_e2,
                           std::span<const OperatingPoint> lights, double range_m,
                           const Eigen::MatrixXd& by_deviation, DepthElectrons& by_electrons,
                           std::span<OperatingPoint> by_lights);

}  // namespace tofsmith
