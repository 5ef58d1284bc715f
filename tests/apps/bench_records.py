# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated calibration recordings of a camera."""

import numpy as np

from command_line import CommandLineTest
from writing_commands import CAMERA

RANGE_M = 299792458 / 2 / 15e6


class BenchRecordsTest(CommandLineTest):
    def record(self, sigma_ns=1.5):
        """Writes a Gaussian pulse like an oscilloscope with German settings."""
        t = np.arange(400) * 0.1
        rng = np.random.default_rng(1)
        v = np.exp(-((t - 20) / sigma_ns) ** 2 / 2) + 0.01 * rng.standard_normal(t.size)
        rows = "".join(f"{a:.2f};{b:.6f}\n".replace(".", ",") for a, b in zip(t, v))
        return self.write("scope.csv", "Scope;4711\nTime (ns);Volt\n" + rows)

    def sweep(self):
        """Writes a flat target at 61 delays, seen by 6 x 6 pixels."""
        self.write("camera.toml", CAMERA)
        frames = []
        for i in range(61):
            depth = np.full((6, 6), RANGE_M * ((i % 60) / 60 or 1), np.float32)
            np.save(self.path("scene.npy"), depth)
            self.do("simulate", "scene.npy", "--kind", "radial", "--code", "hamiltonian-k4",
                    "--no-falloff", "--camera", "camera.toml", "--signal", "3e7", "--ambient", "0",
                    "--seed", str(i), "-o", "raw.npy", "--force")
            frames.append(np.load(self.path("raw.npy")))
        frames = np.stack(frames)
        frames[:, 2, 3, :] = 7
        np.save(self.path("sweep.npy"), frames)
        np.savetxt(self.path("shifts.txt"), np.arange(61))

    def flat_frames(self):
        """Writes 0.npy to 3.npy: pairs of frames of a flat target, dark and with increasing light.
        """
        self.write("camera.toml", CAMERA)
        np.save(self.path("scene.npy"), np.full((32, 32), 2.0, np.float32))
        for i, ambient in enumerate(("0", "4e6", "1e7", "2e7")):
            self.do("simulate", "scene.npy", "--kind", "radial", "--code", "sinusoid-k4",
                    "--camera", "camera.toml", "--signal", "0", "--ambient", ambient, "--frames",
                    "2", "--seed", str(i), "-o", f"{i}.npy")
