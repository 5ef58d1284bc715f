# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Runs every command of the how-to page, with the files it names, and checks that the stated output
files are written. Only long computations are shortened.

    howto_test.py TOFSMITH DOCS
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

DOCS = Path(sys.argv.pop(2)).resolve()
sys.path.insert(0, str(DOCS.parent / "tests" / "apps"))

import numpy as np  # noqa: E402

from bench_records import CAMERA, BenchRecordsTest  # noqa: E402
from command_line import TOOL  # noqa: E402
from sweep_text import sweep_text  # noqa: E402

SHORTER = {" design mine.toml ": " design mine.toml --exposures 3 ",
           " --exposures 3 --method factorize ": " --method factorize ",  # the target determines them
           " --method search": " --method search --exposures 1",
           " design ": " design --effort 0.01 --trials 1000 ",
           " --vary bandwidth ": " --vary bandwidth --trials 1000 --max-factor 2 ",
           " reproduce all ": " reproduce fig5 --fast ",
           " --bounces 1 ": " --bounces 1 --bounce-rays 16 ",
           " --average 30 ": " --average 2 "}
OPTICS = """[optics]
source_power_w = 0.5
wavelength_m = 940e-9
field_of_view_deg = [70, 55]
f_number = 1.2
pixel_pitch_m = 7e-6
quantum_efficiency = 0.3
filter_width_m = 30e-9
"""
SMALL = "--width 32 --height 24"
DUMP = """width = 32
height = 24
measurements = 4
bits = 16
layout = "interleaved"
"""


def commands_of(page):
    rows = re.findall(r"^\|[^|]*\|([^|]*)\|", (DOCS / page).read_text(), re.M)
    return [command for row in rows for command in re.findall(r"`([^`]+)`", row)]


def shortened(command):
    for long, short in SHORTER.items():
        command = command.replace(long, short)
    return command


class HowTo(BenchRecordsTest):
    """Creates a file for each command that uses it: `name.ext` by make_name_ext."""

    def shell(self, command):
        environment = dict(os.environ, PATH=f"{os.path.dirname(TOOL)}:/usr/bin:/bin")
        done = subprocess.run(["bash", "-ec", command], cwd=self.directory, env=environment,
                              text=True, capture_output=True, timeout=200)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}\n{done.stderr}")
        self.assertNotIn("warning", done.stderr, command)

    def make_raw_npy(self, command):
        """Captures with the code that the command decodes; for a table, with hamiltonian-k4."""
        code = re.search(r"--code (\S+)", command)[1]
        code = "hamiltonian-k4" if "." in code else code
        settings = " ".join(re.findall(r"--(?:camera|set) \S+", command))
        self.shell(f"tofsmith simulate table-top {SMALL} --code {code} {settings} --signal 3e7 "
                   "--ambient 1e5 -o raw.npy --truth reference.npy --force")

    def make_reference_npy(self, _):
        pass  # created with raw.npy

    def make_p0_npy(self, command):
        self.make_raw_npy(command)
        for k, phase in enumerate(np.moveaxis(np.load(self.path("raw.npy")), 2, 0)):
            np.save(self.path(f"p{k}.npy"), phase)

    make_p1_npy = make_p2_npy = make_p3_npy = make_p0_npy

    def make_night_npy(self, _):
        self.shell(f"tofsmith simulate corner {SMALL} --code hamiltonian-k4 --frames 3 "
                   "-o night.npy")

    def make_warming_npy(self, _):
        self.shell(f"tofsmith simulate corner {SMALL} --code sinusoid-k4 --camera mine.toml --signal "
                   "3e7 --ambient 1e5 --frames 6 -o warming.npy")

    def make_degrees_txt(self, _):
        np.savetxt(self.path("degrees.txt"), 20 + 3 * np.arange(6))

    def make_dump_bin(self, command):
        self.make_raw_npy(command)
        np.load(self.path("raw.npy")).astype("<u2").tofile(self.path("dump.bin"))

    def make_sensor_raw_toml(self, _):
        self.write("sensor.raw.toml", DUMP)

    def make_table_csv(self, _):
        """Sawtooth functions, a third of a period apart."""
        n = np.arange(60)[:, None] / 60 + np.arange(3) / 3
        np.savetxt(self.path("table.csv"), n % 1, fmt="%.6f", delimiter=",")

    def make_table_npz(self, _):
        self.make_sweep_npy("")
        self.shell("tofsmith calibrate correlation sweep.npy --shifts shifts.txt --shift-unit bin "
                   "--camera mine.toml --table table.npz")

    def make_fppn_npy(self, _):
        np.save(self.path("fppn.npy"), np.full(np.load(self.path("raw.npy")).shape[:2], 0.02))

    def make_scope_csv(self, _):
        self.record()

    def make_sweep_npy(self, _):
        self.sweep()

    def make_shifts_txt(self, _):
        np.savetxt(self.path("shifts.txt"), np.arange(61) / 60 / 15e6)

    def make_mine_csv(self, _):
        self.shell("tofsmith codes hamiltonian-k4 -o mine.csv")

    def make_depth_npy(self, _):
        np.save(self.path("depth.npy"), np.full((24, 32), 2.0, np.float32))

    def make_kernel_npy(self, _):
        kernel = np.full((7, 7), 1e-3)
        np.save(self.path("kernel.npy"), kernel)

    def make_target_npy(self, _):
        target = np.full((24, 32, 4), 100.0)
        target[10:14, 12:16] += 3000 * np.array([1.0, 0.5, 0.2, 0.7])
        np.save(self.path("target.npy"), np.random.default_rng(1).normal(target, 5.0))

    def make_quads_npy(self, _):
        camera = "--camera mine.toml --set sensor.taps=2 --set sensor.readout=difference"
        for name, signal in (("quads", 0), ("quads1", "4e6"), ("quads2", "1e7")):
            self.shell(f"tofsmith simulate corner {SMALL} --code sinusoid-k4 {camera} --signal "
                       f"{signal} --ambient 0 --frames 2 -o {name}.npy")

    def make_quads1_npy(self, _):
        pass  # created with quads.npy

    make_quads2_npy = make_quads1_npy

    def make_dark_npy(self, _):
        self.flat_frames()
        os.rename(self.path("0.npy"), self.path("dark.npy"))
        for i in (1, 2, 3):
            os.rename(self.path(f"{i}.npy"), self.path(f"level{i}.npy"))

    def make_captures(self, _):
        os.mkdir(self.path("captures"))
        for i in (1, 2):
            np.save(self.path(f"captures/{i}.npy"), np.full((6, 8), 1.0 + i, np.float32))

    def make_sweep_toml(self, _):
        self.write("sweep.toml", sweep_text(200))

    def make_designed(self, _):
        """Designs once and copies the result for each command."""
        if not hasattr(HowTo, "designed"):
            HowTo.designed = tempfile.TemporaryDirectory(prefix="tofsmith-designed-")
            self.shell("tofsmith design --effort 0 --exposures 3 --trials 1000 --force -o "
                       + HowTo.designed.name)
        shutil.copytree(HowTo.designed.name, self.path("designed"))

    def prepare(self, command):
        written = set(re.findall(r"(?:-o|--truth|--table|--store|--export|>) ([^\s-]\S*)", command))
        named = dict.fromkeys(word.rstrip("/") for word in command.split())
        for word in [word for word in named if word not in written and "*" not in word]:
            make = getattr(self, "make_" + re.sub(r"\W", "_", word), None)
            if make:
                make(command)
            else:
                file = re.fullmatch(r"[a-z]\S*\.(npy|npz|csv|bin|txt)", word)
                self.assertIsNone(file, f"{command}: no test file for {word}")
        return written

    def test_every_command_runs(self):
        commands = commands_of("howto.md")
        self.assertGreater(len(commands), 25)
        for command in commands:
            with self.subTest(command):
                self.setUp()
                self.write("mine.toml", CAMERA + OPTICS)
                written = self.prepare(command)
                self.shell(shortened(command))
                for name in written:
                    self.assertTrue(os.path.exists(self.path(name)), f"{command}: no {name}")


if __name__ == "__main__":
    unittest.main()
