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

/// What harmonic n of a correlation function has of coefficient n mod N of its samples at the N
/// bins:
///   chi_n = shares[n] chi[n mod N] / N,  shares[n] = H(n) sinc^2(n / N) / G[n mod N],
/// n = 0 .. as far as more than 1e-12 is left. Only of cameras whose arms are limited: without
/// responses functions are straight between bins.
Eigen::VectorXcd harmonic_shares(const Camera& camera, int samples);

}  // namespace tofsmith
