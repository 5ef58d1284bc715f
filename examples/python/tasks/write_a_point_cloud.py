# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a filtered point cloud with your lens intrinsics."""

# %% The camera and its lens.
import tofsmith

lens = tofsmith.Lens(
    fx_px=141.0, fy_px=141.5, cx_px=79.2, cy_px=60.1, width_px=160, height_px=120,
    distortion_model="opencv", distortion=(-0.12, 0.03, 0.0, 0.0))
code = "hamiltonian-k4"
camera = tofsmith.Camera("indoor", lens=lens)

# %% A frame, which is simulated here. decode_recording() also reads your own file.
scene = tofsmith.built_in_scene("table-top", lens=camera.lens)
tofsmith.write_raw("raw.npy", tofsmith.capture(
    scene, code, camera, signal_e_per_s=3e6, ambient_e_per_s=1e6), overwrite=True)

# %% Filtered depth as points. Pixels without a reliable depth are omitted.
decoder = tofsmith.Decoder(code, camera)
result = decoder.decode_recording(
    "raw.npy", "points.ply", filter="normal", outputs=["depth", "amplitude", "deviation"],
    overwrite=True)
print(f"wrote points.ply with {', '.join(result.outputs)}")
