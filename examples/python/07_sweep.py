# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Computes depth errors of several cameras and codes. A second run continues from the store."""

import tofsmith

sweep = """
camera = "paper-10f0"
set = ["samples=120"]
codes = ["square-k4", "hamiltonian-k4"]
trials = 100

[[axis]]
key = "light.peak_factor"
values = [5, 10, 15]
"""
results = tofsmith.run_sweep(sweep, "sweep.sqlite")
print(f"{results.finished} of {results.items} items, {len(results)} rows")
for peak_factor in (5, 10, 15):
    rows = results.where(code="hamiltonian-k4", **{"light.peak_factor": peak_factor})
    print(f"p = {peak_factor}: {rows['linear_mde_m'].mean() * 1e3:.0f} mm")
