# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Computes waveforms that approximate given correlation functions."""

import numpy as np

import tofsmith

camera = tofsmith.Camera("paper-10f0", samples=120)
depth = np.arange(120) / 120
shift = np.arange(3) / 3
triangle = np.abs(2 * ((depth[:, None] + shift) % 1) - 1)  # (N, K), three of them
result = tofsmith.design(
    camera, method="factorize", target=triangle, normalize=True, trials=1000,
    factorize={"random_starts": 3, "max_iterations": 4, "refined": 4},
)
for candidate in result.by_ranking_error():
    print(f"{candidate.code.name}: {candidate.ranking_error_m * 1e3:.1f} mm; {candidate.message}")
    for report in candidate.per_measurement:
        print(f"  rms distance from the target {report.residual_rms:.2g}, {report.edges} edges")
