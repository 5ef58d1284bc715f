# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Depth error over many cameras and codes, kept in a store that a second run goes on with."""

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
