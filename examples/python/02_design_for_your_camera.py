# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Designs codes for your camera. The search is shortened: omit `optimize` for a full search."""

import tofsmith

camera = tofsmith.Camera(
    name="mine",
    fundamental_frequency_hz=20e6,
    exposure_s=0.1,
    samples=120,
    light={"peak_factor": 6, "impulse_response": {"kind": "lowpass", "cutoff_hz": 100e6}},
    sensor={"impulse_response": {"kind": "lowpass", "cutoff_hz": 100e6}, "read_noise_e": 10},
    operating={"signal_e_per_s": [1e4, 1e5], "ambient_e_per_s": [1e4]},
)
result = tofsmith.design(
    camera,
    method="optimize",
    exposures=[3],
    trials=1000,
    optimize={"starts": 2, "steps_per_start": 40, "hops": 0, "refinement_steps": 40,
              "polish_steps": 20, "pool_trials": 1000},
)
for candidate in result.by_ranking_error():
    print(f"{candidate.code.name}: {candidate.ranking_error_m * 1e3:.1f} mm ({candidate.method})")
tofsmith.write_code("mine.code.json", result.winner.code, overwrite=True)
