// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/shared/whole_vectors.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Depths that are worked on together: a table of them has a multiple of so many rows.
constexpr int depth_block = widest_vector / 2;

/// Electrons of measurements, and of the light they are made of, per unit of signal (depths, K) and
/// of ambient light (K); slopes per period. As CramerRaoBound has them.
struct DepthElectrons {
  Eigen::MatrixXd signal, slope, shot;
  Eigen::VectorXd ambient, shot_ambient;
};

/// Cramer-Rao bounds of depth with signal and ambient light unknown, as DepthPart
/// (simulate/shared/depth_information.hpp) has them, of many depths at once: deviations [m]
/// (depths, lights), infinite where depth cannot be told from the others.
void eliminate_light(const DepthElectrons& electrons, const Eigen::VectorXd& constant_e2,
                     std::span<const OperatingPoint> lights, double range_m,
                     Eigen::MatrixXd& deviation_m);

/// The gradient of sum by_deviation deviation_m: adds to that by the electrons, and writes that by
/// the lights; infinite deviations have none.
///
/// sigma = range / |across|, and across is least over the shares of the other two columns:
///   d |across|^2 / 2 = <across, w (d depth - share d signal - share d ambient)>
///                      - sum across^2 / (2 variance) d variance.
void pull_back_elimination(const DepthElectrons& electrons, const Eigen::VectorXd& constant_e2,
                           std::span<const OperatingPoint> lights, double range_m,
                           const Eigen::MatrixXd& by_deviation, DepthElectrons& by_electrons,
                           std::span<OperatingPoint> by_lights);

}  // namespace tofsmith
