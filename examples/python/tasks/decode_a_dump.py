# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Decodes a raw dump with 12 bits and two modulation frequencies, four phases each."""

# %% The camera and its code. The dump is simulated here; use your own instead.
from pathlib import Path

import numpy as np

import tofsmith

code = "multifrequency-4x4-5x4"  # 80 and 100 MHz: 4 and 5 times 20 MHz, four phases each
camera = tofsmith.Camera("mlx75027", sensor={"adc_bits": 12, "gain_e_per_dn": 40.0})
scene = tofsmith.built_in_scene("table-top", 160, 120)
numbers = tofsmith.capture(scene, code, camera, signal_e_per_s=3e7, ambient_e_per_s=1e6)
numbers = np.clip(np.rint(numbers), -2048, 2047).astype("<i2")  # (H, W, 8)
np.moveaxis(numbers, 2, 0).tofile("dump.bin")  # eight images, one after another

# %% How the numbers are stored.
Path("dump.raw.toml").write_text('''
width = 160
height = 120
measurements = 8
bits = 12
signed = true
packing = "plain"
container_bits = 16
layout = "planar"
''')

# %% Depth and status of the pixels.
raw = tofsmith.read_raw("dump.bin", raw_format="dump.raw.toml")
image = tofsmith.Decoder(code, camera).decode(raw[0])
ok = image.status == tofsmith.PixelStatus.ok
error_mm = 1e3 * np.abs(image.depth_m - scene.depth_m)[ok]
print(f"{ok.mean():.1%} of the pixels are ok, median error {np.median(error_mm):.1f} mm")
tofsmith.write_depth("depth.png", image.depth_m, overwrite=True)
