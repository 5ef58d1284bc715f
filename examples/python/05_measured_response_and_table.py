# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Uses a measured impulse response instead of a model, and a measured table instead of a code.

Both measurements are simulated here. Read your own with read_impulse_response() and
read_measured_table().
"""

import numpy as np

import tofsmith

# Impulse response of the light: rises immediately and rings for 8 ns.
step_s = 0.25e-9
time_s = np.arange(48) * step_s
response = np.exp(-time_s / 1.5e-9) * (1 + 0.3 * np.cos(2 * np.pi * time_s / 2e-9))
measured = {"kind": "file", "samples": response, "time_step_s": step_s}
camera = tofsmith.Camera("paper-10f0", light={"impulse_response": measured})
error_m = tofsmith.evaluate("square-k4", camera, trials=1000).circular.geometric_mean_m
print(f"square-k4 behind the measured response: {error_m * 1e3:.1f} mm")

# A delay sweep of 200 steps over the whole range, with small random errors.
truth = tofsmith.ForwardModel("square-k4", camera)
n, k = np.mgrid[:200, :4]
table = truth.correlation_table(200) + 1e-4 * np.sin(1.7 * n * n + k)
decoder = tofsmith.Decoder(tofsmith.DecodingTable.of_measured(table, camera))
depth_m = np.linspace(1, 9, 50)
raw = truth.expected_electrons(depth_m / camera.bin_m, 1e5, 1e4).astype(np.float32)
found_m = decoder.decode(raw[None], planes=["depth_m"]).depth_m[0]
print(f"decoded by the measured table: off by {np.abs(found_m - depth_m).max() * 1e3:.1f} mm at "
      "most")
