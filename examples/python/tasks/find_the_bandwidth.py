# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Finds the bandwidth for an error of 5 mm at 3 m in sunlight of 20 klx."""

# %% The camera, and its light at this distance.
import tofsmith

camera = tofsmith.Camera("indoor", optics={"source_power_w": 5.0}).at_distances(3, klux=20)
print(f"S = {camera.operating.signal_e_per_s[0]:.3g} e/s, "
      f"A = {camera.operating.ambient_e_per_s[0]:.3g} e/s")

# %% Smallest bandwidth for which an atlas code suffices; `exact=True` also designs codes.
found = tofsmith.find_requirements(
    camera, 5e-3, vary_power=False, vary_exposure=False, trials=5000)
print(f"this camera: {found.error_m * 1e3:.1f} mm with {found.code.name}")
(bandwidth,) = found.varied
if bandwidth.factor is None:
    print(f"no bandwidth suffices: {bandwidth.error_m * 1e3:.1f} mm at best")
else:
    print(f"{bandwidth.factor:.2f} times the bandwidth suffices, with {bandwidth.code.name}")
