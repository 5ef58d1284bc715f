# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Computes the depth error of a standard code on a built-in camera."""

import tofsmith

camera = tofsmith.Camera("paper-10f0")
for name in ("sinusoid-k4", "hamiltonian-k4"):
    report = tofsmith.evaluate(name, camera, trials=1000)
    error = report.linear
    print(f"{name}: {error.geometric_mean_m * 1e3:.1f} ± {error.geometric_mean_se_m * 1e3:.1f} mm")
    brightest = report.signal_e_per_s.argmax()
    print(f"  at S = {report.signal_e_per_s[brightest]:.3g} e/s: "
          f"{report.circular_mde_m[brightest] * 1e3:.1f} mm, no unbiased estimator below "
          f"{report.cramer_rao_mae_m[brightest] * 1e3:.1f} mm")
