# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Measures several values per exposure: two buckets, their difference, and three taps."""

import numpy as np

import tofsmith

sensors = {
    "one tap": {"taps": 1},
    "two buckets": {"taps": 2},
    "two buckets, difference": {"taps": 2, "readout": "difference"},
}
for name, sensor in sensors.items():
    camera = tofsmith.Camera("paper-10f0", sensor=sensor)
    code = tofsmith.build_family("hamiltonian-k4", camera)
    error_m = tofsmith.evaluate(code, camera, trials=1000).circular.geometric_mean_m
    print(f"{name}: {code.exposures} exposures, {tofsmith.ForwardModel(code, camera).measurements} "
          f"measurements, {error_m * 1e3:.1f} mm")

# Three taps of one exposure, each open for a third of the period.
camera = tofsmith.Camera("paper-10f0", samples=120, sensor={"taps": 3})
third = np.arange(120) // 40
gates = (third[:, None] == np.arange(3)).astype(float)  # (N, K)
pulse = 3.0 * (third == 0)[:, None]  # (N, E), mean 1
code = tofsmith.CodeSet.from_arrays(pulse, gates, taps=3, name="three-gates")
report = tofsmith.evaluate(code, camera, trials=1000)
print(f"{report.code}: linear {report.linear.geometric_mean_m * 1e3:.4g} mm, "
      f"circular {report.circular.geometric_mean_m * 1e3:.4g} mm")
