# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Plots the depth error over the signal for three codes, as a figure of one column."""

# %% The camera and the levels of light.
import numpy as np

import tofsmith
from tofsmith import plot

camera = tofsmith.Camera("indoor", operating={
    "signal_e_per_s": np.geomspace(3e5, 3e7, 7).tolist(), "ambient_e_per_s": [1e6]})

# %% Error of each code at each level.
reports = [tofsmith.evaluate(code, camera, trials=1000)
           for code in ("sinusoid-k4", "square-k4", "hamiltonian-k4")]
for report in reports:
    print(f"{report.code}: {report.circular.geometric_mean_m * 1e3:.1f} mm")

# %% The figure.
figure = plot.depth_error_curves(reports, width="column")
figure.savefig("error_over_signal.pdf")
