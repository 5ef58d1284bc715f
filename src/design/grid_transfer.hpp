// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// What both arms of a camera leave of waveforms that are held over the cells of a grid of N:
///   chi[k] = D[k] conj(M[k]) G[k] / N,  G[k] = sum_j H(k + j N) sinc^2((k + j N) / N),
/// k = 0 .. N/2, exact at the N bins. All ones without impulse responses.
Eigen::VectorXcd grid_transfer(const Camera& camera, int samples);

}  // namespace tofsmith
