# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Designs a code for three taps at 80 MHz and exports it for a Siglent generator."""

# %% The camera.
import tofsmith

arm = {"impulse_response": {"kind": "lowpass", "cutoff_hz": 300e6}}
camera = tofsmith.Camera(
    name="three-taps",
    fundamental_frequency_hz=80e6,
    samples=96,
    light={"peak_factor": 4, **arm},
    sensor={"taps": 3, **arm},
    operating={"signal_e_per_s": [1e6], "ambient_e_per_s": [1e5], "error": "circular"},
)

# %% A short search. Omit `effort` and `trials` for a full one.
result = tofsmith.design(camera, exposures=[2], effort=0.01, trials=1000)
for candidate in result.by_ranking_error()[:4]:
    print(f"{candidate.code.name}: {candidate.ranking_error_m * 1e3:.1f} mm ({candidate.method})")
code = result.winner.code

# %% One table per waveform, and a camera with the waveforms that the generator outputs. A table
# contains two periods, because a Siglent SDG6022X repeats tables at most 50 million times a second.
exported = tofsmith.export_waveforms(
    code, camera, "siglent", "siglent-wvdt16", sample_rate_hz=2.4e9, periods=2, samples=24,
    overwrite=True)
print(f"{len(exported.files)} files in siglent")
tofsmith.write_code("three-taps.code.json", code, overwrite=True)
