# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Decodes a raw frame from a file, which is simulated first."""

import numpy as np

import tofsmith

camera = tofsmith.Camera("paper-10f0")
scene = tofsmith.built_in_scene("table-top", width=160, height=120)
raw = tofsmith.capture(scene, "hamiltonian-k4", camera, signal_e_per_s=1e6, ambient_e_per_s=1e4)
tofsmith.write_raw("raw.npy", raw, overwrite=True)

decoder = tofsmith.Decoder("hamiltonian-k4", camera)  # reusable for all frames
image = decoder.decode(tofsmith.read_raw("raw.npy")[0])
error_m = np.abs(image.depth_m - scene.depth_m)
print(f"{np.mean(image.status == tofsmith.PixelStatus.ok):.1%} of the pixels are ok, "
      f"median error {np.nanmedian(error_m) * 1e3:.1f} mm")
tofsmith.write_depth("depth.npy", image.depth_m, overwrite=True)
points = tofsmith.points_m(image.depth_m, scene.lens)
tofsmith.write_points("depth.ply", points, {"confidence": image.confidence}, overwrite=True)
