// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Returns the gain of both arms for waveforms that are constant within N cells:
///   chi[k] = D[k] conj(M[k]) G[k] / N,  G[k] = sum_j H(k + j N) sinc^2((k + j N) / N),
/// for k in [0, N/2], exact at the N bins. All ones without impulse responses.
Eigen::VectorXcd grid_transfer(const Camera& camera, int samples);

/// Returns the ratio of harmonic n of a correlation function to coefficient n mod N of its samples:
///   chi_n = shares[n] chi[n mod N] / N,  shares[n] = H(n) sinc^2(n / N) / G[n mod N],
/// for n = 0, 1, ... while above 1e-12. Only with impulse responses; otherwise functions are linear
/// between bins.
Eigen::VectorXcd harmonic_shares(const Camera& camera, int samples);

}  // namespace tofsmith
