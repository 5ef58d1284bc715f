# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Every subcommand: documents, files, round trips, and reproducibility for equal seeds."""

import os
import pty
import shutil
import subprocess
import time
import unittest

import numpy as np

import command_line
from command_line import CommandLineTest

FAST = ("--trials", "1000")
SMALL = "scene.npy"
PAGE = b"<!doctype html>\n<title>The lab</title>\n"
LONG = ("evaluate", "sinusoid-k4", "--trials", "1000000000", "--threads", "1")


class Commands(CommandLineTest):
    def small_scene(self):
        """Writes a ramp of distances [m], 12 x 16 pixels."""
        truth = np.linspace(1.0, 4.0, 12 * 16).reshape(12, 16).astype(np.float32)
        np.save(self.path(SMALL), truth)
        return truth

    def simulate(self, *more, code="hamiltonian-k3", raw="raw.npy"):
        return self.do_json("simulate", SMALL, "--kind", "radial", "--code", code, "--signal",
                            "1e7", "--no-falloff", "-o", raw, *more)

    def decode(self, *more, code="hamiltonian-k3", raw="raw.npy", output="depth.npy"):
        return self.do_json("decode", raw, "--code", code, "-o", output, *more)

    def test_cameras_are_listed(self):
        cameras = {camera["name"]: camera for camera in self.do_json("cameras")}
        self.assertAlmostEqual(cameras["kinect-v2"]["range_m"], 18.737, places=3)
        text = self.do("cameras")
        for name, camera in cameras.items():
            self.assertIn(name, text)
            self.assertIn(camera["description"], text)

    def test_cameras_prints_a_template(self):
        self.write("mine.toml", self.do("cameras", "mlx75027"))
        code = self.do_json("cameras", "mlx75027")["code"]
        mine, built_in = (self.do_json("evaluate", code, *FAST, "--camera", camera)
                          for camera in ("mine.toml", "mlx75027"))
        self.assertEqual(mine, built_in)
        self.refuse(["cameras", "kinect-v1"], "kinect-v1", "did you mean kinect-v2?")

    def test_cameras_prints_the_raw_format(self):
        self.write("sensor.raw.toml", self.do("cameras", "arducam-tof", "--raw-format"))
        with open(self.path("dump.bin"), "wb") as dump:
            dump.write(bytes(2 * 4 * 240 * 180))
        found = self.do_json("decode", "dump.bin", "--raw-format", "sensor.raw.toml", "--camera",
                             "arducam-tof", "--code", "sinusoid-k4", "-o", "depth.npy")
        self.assertEqual((found["height"], found["width"]), (180, 240))
        self.refuse(["cameras", "kinect-v2", "--raw-format"], "interleaved", "arducam-tof")
        self.refuse(["cameras", "--raw-format"], "requires the NAME", code=2)

    def test_camera_keys_are_listed_with_unit_range_and_default(self):
        keys = {key["key"]: key for key in self.do_json("cameras", "--keys")}
        peak = keys["light.peak_factor"]
        self.assertEqual((peak["range"], peak["default"]), ("finite and >= 1", 15.0))
        self.assertEqual(keys["sensor.read_noise_e"]["unit"], "e")
        self.assertIn("hann", keys["light.impulse_response.f_max_hz"]["condition"])
        text = self.do("cameras", "--keys")
        for name, key in keys.items():
            self.assertIn(name, text)
            self.assertIn(key["help"], text)
        self.refuse(["cameras", "kinect-v2", "--keys"], "--keys", code=2)

    def test_keys_of_raw_formats_are_listed(self):
        keys = {key["key"]: key for key in self.do_json("cameras", "--raw-format", "--keys")}
        self.assertEqual(keys["rotate_deg"]["default"], 0)
        self.assertEqual(keys["negate_rows"]["words"], ["none", "even", "odd"])
        self.assertEqual(keys["frame_trailer_bytes"]["range"], "in [0, 1073741823]")
        self.assertIn("frame_trailer_bytes", self.do("cameras", "--raw-format", "--keys"))

    def test_a_simulated_frame_is_stored_with_its_camera(self):
        truth = self.small_scene()
        far = ("--set", "fundamental_frequency_hz=7.5e6")
        self.simulate(*far)
        found = self.decode()
        self.assertEqual(found["camera_source"],
                         "raw.camera.toml, next to raw.npy (--camera overrides it)")
        self.assertLess(np.abs(np.load(self.path("depth.npy")) - truth).max(), 0.05)
        self.decode(*far, "--camera", "paper-10f0", output="same.npy")
        self.assertEqual(self.bytes_of("depth.npy"), self.bytes_of("same.npy"))
        self.assertEqual(self.decode("--camera", "paper-10f0", output="near.npy")["camera_source"],
                         "paper-10f0")
        # The lens of the rendered scene is included.
        self.do("simulate", "ball", "--width", "32", "--height", "24", "--code", "hamiltonian-k3",
                "--signal", "1e7", "-o", "ball.npy", "--truth", "ball-z.npy")
        self.decode("--kind", "z", raw="ball.npy", output="z.npy")
        self.assertIn("fx_px", self.bytes_of("ball.camera.toml").decode())
        # Our own camera file is replaced, but not a foreign one.
        os.remove(self.path("raw.npy"))
        self.simulate()
        self.assertIn("15000000", self.bytes_of("raw.camera.toml").decode())
        os.remove(self.path("raw.npy"))
        self.write("raw.camera.toml", "fundamental_frequency_hz = 15e6\n")
        again = ["simulate", SMALL, "--code", "hamiltonian-k3", "-o", "raw.npy"]
        self.refuse(again, "raw.camera.toml: the file already exists")
        self.refuse([*again, "--camera", "raw.camera.toml"],
                    "raw.code.json: the file already exists")
        os.remove(self.path("raw.code.json"))
        self.do(*again, "--camera", "raw.camera.toml")
        self.assertEqual(self.bytes_of("raw.camera.toml"), b"fundamental_frequency_hz = 15e6\n")

    def test_codes_lists_families(self):
        names = [family["name"] for family in self.do_json("codes")]
        self.assertIn("hamiltonian-kK", names)
        self.assertIn("hamiltonian-kK", self.do("codes"))

    def test_codes_shows_one(self):
        document = self.do_json("codes", "hamiltonian-k4")
        self.assertEqual((document["measurements"], document["samples"]), (4, 240))
        self.assertEqual(len(document["per_measurement"]), 4)
        self.assertIn("|###", self.do("codes", "square-k4"))

    def test_codes_counts_the_measurements_read_out(self):
        pairs = ["hamiltonian-k4", "--set", "sensor.taps=2", "--set", "sensor.readout=difference"]
        document = self.do_json("codes", *pairs)
        self.assertEqual((document["taps"], document["measurements"]), (2, 4))
        self.assertEqual(len(document["per_measurement"]), 8)
        self.assertIn("4 measurements (differences of 8 tap values), 4 exposures",
                      self.do("codes", *pairs))
        self.assertEqual(self.do_json("codes", *pairs[:3])["measurements"], 8)

    def test_codes_are_read_back_from_a_table_of_waveforms(self):
        for code, settings in (("hamiltonian-k4", []), ("sinusoid-k4", []),
                               ("hamiltonian-k4", ["--set", "sensor.taps=2"])):
            self.do("codes", code, *settings, "-o", "w.csv", "--force")
            figures = [self.do_json("codes", name, *settings) for name in (code, "w.csv")]
            for key in ("exposures", "taps", "measurements", "coding_curve_rank"):
                self.assertEqual(figures[0][key], figures[1][key], (code, key))
            self.assertAlmostEqual(figures[0]["coding_curve_length"],
                                   figures[1]["coding_curve_length"],
                                   3 if code == "sinusoid-k4" else 6)  # sampled in the file
        self.write("odd.csv", "modulation_1,modulation_2,demodulation_1\n1,1,1\n1,1,0\n")
        self.refuse(["evaluate", "odd.csv"], "odd.csv",
                    "found 2 columns modulation_1, ... and 1 columns demod")
        self.write("odd.csv", "modulation_1,light\n1,1\n1,1\n")
        self.refuse(["evaluate", "odd.csv"], "odd.csv: found the column 'light'; expected time_s")
        self.write("odd.csv", "modulation_1,demodulation_1\n1,2\n1,0\n")
        self.refuse(["evaluate", "odd.csv"], "found 2; expected a gain in [0, 1]")
        self.write("odd.csv", "a,b\n1,2\n1,0\n")
        self.refuse(["evaluate", "odd.csv"], "measured table", ".csv with columns modulation_1")

    def test_scenes_are_listed(self):
        self.assertIn("table-top", self.do("scene").split())
        self.assertIn("table-top", self.do_json("scene")["scenes"])

    def test_a_scene_file_gives_every_image(self):
        self.write("s.toml", "[view]\nwidth_px = 41\nheight_px = 31\n[[sphere]]\n"
                   "centre_m = [0, 0, 20]\nradius_m = 8\nalbedo = 0.25\n")
        document = self.do_json("scene", "s.toml", "-o", "out", "--camera", "paper-10f0")
        self.assertAlmostEqual(document["nearest_m"], 12, 5)
        self.assertEqual(document["beyond_range_share"], 1)
        self.assertGreater(document["no_return_share"], 0.1)
        depth = np.load(self.path("out/depth.npy"))
        self.assertEqual(depth.shape, (31, 41))
        np.testing.assert_array_equal(np.load(self.path("out/beyond_range.npy")) == 1,
                                      np.isfinite(depth))
        self.assertEqual(np.load(self.path("out/albedo.npy"))[15, 20], 0.25)
        self.assertTrue((np.nan_to_num(np.load(self.path("out/z.npy"))) <=
                         np.nan_to_num(depth)).all())
        self.assertIn(b"Radial distance", self.bytes_of("out/preview.html"))
        self.assertIn("wraps", self.do("scene", "s.toml"))
        self.do("scene", "s.toml", "-o", "depth.npy")
        np.testing.assert_array_equal(np.load(self.path("depth.npy")), depth)

    def test_built_in_scenes_are_seen_through_the_lens(self):
        self.write("lens.toml", "fundamental_frequency_hz = 15e6\n[lens]\nfx_px = 40\n"
                   "fy_px = 40\ncx_px = 15.5\ncy_px = 11.5\n")
        document = self.do_json("scene", "wall", "--camera", "lens.toml", "-o", "wall.npy")
        self.assertEqual((document["height"], document["width"]), (24, 32))
        np.testing.assert_allclose(np.load(self.path("wall.npy"))[0, 0],
                                   0.5 * np.sqrt(1 + (15.5 / 40) ** 2 + (11.5 / 40) ** 2),
                                   rtol=1e-5)

    def test_depth_files_state_their_kind(self):
        self.do("simulate", "wall", "--code", "sinusoid-k4", "--signal", "1e7", "-o", "raw.npy")
        self.do("decode", "raw.npy", "-o", "radial.npz")
        self.do("decode", "raw.npy", "--kind", "z", "-o", "z.npz")
        median = [self.do_json("scene", name, "--camera", "raw.camera.toml")["median_m"]
                  for name in ("radial.npz", "z.npz")]
        self.assertAlmostEqual(median[0], median[1], 3)
        self.refuse(["scene", "radial.npz", "--kind", "z"], "radial.npz", "kind radial")

    def test_points_need_a_lens(self):
        self.do("simulate", "wall", "--width", "8", "--height", "6", "--code", "sinusoid-k4", "-o",
                "raw.npy")
        without_lens = ("--camera", "paper-10f0", "--code", "sinusoid-k4")
        self.refuse(["decode", "raw.npy", *without_lens, "-o", "p.ply"], "--view-deg", "[lens]",
                    code=2)
        self.do("decode", "raw.npy", "-o", "q.ply")  # raw.camera.toml has [lens]
        self.do("decode", "raw.npy", "--view-deg", "20", "-o", "r.ply")
        self.assertNotEqual(self.bytes_of("q.ply"), self.bytes_of("r.ply"))

    def test_options_take_units(self):
        self.do("simulate", "wall", "--width", "8", "--height", "6", "--code", "sinusoid-k4", "-o",
                "raw.npy")
        self.do("decode", "raw.npy", "--offset-m", "0.25", "-o", "a.npy")
        self.do("decode", "raw.npy", "--offset-m", "25cm", "-o", "b.npy")
        self.assertEqual(self.bytes_of("a.npy"), self.bytes_of("b.npy"))
        self.assertEqual(self.do_json("evaluate", "sinusoid-k4", "--trials", "1e3"),
                         self.do_json("evaluate", "sinusoid-k4", "--trials", "1000"))

    def test_unusual_numbers_are_noted(self):
        code, _, error = self.run_tool("evaluate", "sinusoid-k4", "--trials", "100", "--set",
                                       "exposure_s=20")
        self.assertEqual(code, 0)
        self.assertIn("note: paper-10f0: exposure_s = 20 s; most cameras have", error)

    def test_help_fits_the_terminal(self):
        for width in (60, 100):
            text = self.do("decode", "--help-all", env={**os.environ, "COLUMNS": str(width)})
            long_lines = [line for line in text.splitlines() if len(line) > width]
            self.assertLess(len(long_lines), 4, long_lines)  # single long words
            self.assertIn("Code and camera:", text)
            self.assertIn("Example: tofsmith decode raw.npy", text)
            self.assertNotRegex(text, "FLOAT|TEXT|\\{false\\}")

    def test_help_states_defaults_conditions_and_examples(self):
        for command, words in (
                ("evaluate", "(default: the camera's sensor.decoder)"),
                ("design", "(default: the camera's operating.multipath.weight, otherwise 0.2)"),
                ("require", "default effort of a design (in [0.01, 100]; default: 0.1; requires "
                 "--exact)"),
                ("export", "Example: tofsmith export hamiltonian-k4 --camera mine.toml --format")):
            self.assertIn(words, " ".join(self.do(command, "--help-all").split()), command)
        self.assertIn("\nFormats:\n", self.do("export", "--help"))

    def test_a_mesh_is_a_scene(self):
        self.write("m.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n")
        document = self.do_json("simulate", "m.obj", "--scale-m", "0.5", "--width", "40",
                                "--height", "30", "--code", "sinusoid-k4", "-o", "raw.npy",
                                "--truth", "depth.npy")
        self.assertEqual((document["height"], document["width"]), (30, 40))
        self.assertEqual(document["beyond_range_share"], 0)
        depth = np.load(self.path("depth.npy"))
        self.assertEqual(np.isfinite(depth).sum(axis=1).max(), 32)  # 80 % of the width

    def test_ambient_light_per_pixel(self):
        np.save(self.path("dark.npy"), np.full((8, 8), np.nan, np.float32))
        scale = np.ones((8, 8), np.float32)
        scale[:, 4:] = 3
        np.save(self.path("ambient.npy"), scale)
        self.do("simulate", "dark.npy", "--ambient-image", "ambient.npy", "--code", "sinusoid-k4",
                "--ambient", "1e7", "-o", "raw.npy")
        raw = np.load(self.path("raw.npy"))
        self.assertAlmostEqual(raw[:, 4:].mean() / raw[:, :4].mean(), 3, 1)

    def test_albedo_above_one_is_reported(self):
        np.save(self.path("flat.npy"), np.full((4, 5), 2.0, np.float32))
        picture = np.full((4, 5), 0.5, np.float32)
        np.save(self.path("picture.npy"), picture)
        look = ("scene", "flat.npy", "--image", "picture.npy")
        self.assertNotIn("note", self.do(*look))
        picture[1, 2] = 2706
        np.save(self.path("picture.npy"), picture)
        note = "note: the largest albedo of the image is 2706"
        self.assertIn(note, self.do(*look))
        self.assertIn(note, self.do("simulate", *look[1:], "--code", "sinusoid-k4", "-o", "r.npy"))

    def test_decode_reports_frames_without_any_depth(self):
        adc = ("--set", "sensor.adc_bits=12", "--set", "sensor.gain_e_per_dn=1")
        for value, more, words in ((np.nan, (), ("20 invalid", "NaN")),
                                   (0, (), ("20 no_return", "--layout")),
                                   (4095, adc, ("20 saturated", "reduce the exposure"))):
            np.save(self.path("none.npy"), np.full((4, 5, 4), value, np.float32))
            decode = ("decode", "none.npy", "--code", "sinusoid-k4", *more, "-o", "d.npy",
                      "--force")
            (note,) = [n for n in self.do_json(*decode)["notes"] if "no pixel has a depth" in n]
            for word in words:
                self.assertIn(word, note)
            self.assertIn(note, self.do(*decode))
        self.small_scene()
        self.simulate()
        self.assertFalse([n for n in self.decode()["notes"] if "no pixel" in n])

    def test_names_need_not_be_utf8(self):
        truth = self.small_scene()
        os.rename(os.fsencode(self.path(SMALL)), os.fsencode(self.directory) + b"/\xff.npy")
        document = self.do_json("simulate", b"\xff.npy", "--code", "sinusoid-k4", "-o", "raw.npy")
        self.assertEqual((document["height"], document["width"]), truth.shape)

    def test_help_and_version(self):
        self.assertRegex(self.do("--version"),
                         r"^tofsmith \d+\.\d+\.\d+ \(commit ([0-9a-f]{12}(\+dirty)?|unknown)\)\n"
                         r"built by \w+ [\d.]+, \w+, (static|shared) library\n"
                         r"kernels for (\w+ ?)+; this computer uses \w+\n"
                         r"with .+\n$")
        for command in ("demo", "codes", "design", "evaluate", "scene", "simulate", "decode",
                        "report"):
            self.assertIn(command, self.do("--help"))
            self.assertIn("--json", self.do(command, "--help") + self.do("--help"))
        code, out, error = self.run_tool()
        self.assertEqual((code, out), (2, b""))
        self.assertIn("Usage", error)

    def test_a_closed_pipe_is_handled(self):
        process = self.start("codes")
        process.stdout.close()
        self.assertIn(process.wait(timeout=60), (0, 1, -13))
        process.stderr.close()

    def test_a_full_disk_is_an_error(self):
        with open("/dev/full", "wb") as full:
            result = subprocess.run([command_line.TOOL, "codes"], stdout=full,
                                    stderr=subprocess.PIPE, timeout=60)
        self.assertEqual(result.returncode, 1)
        self.assertIn(b"standard output", result.stderr)

    def test_progress_is_drawn_on_a_terminal_and_cleared(self):
        controller, terminal = pty.openpty()
        process = subprocess.Popen([command_line.TOOL, "evaluate", "sinusoid-k4", "--trials",
                                    "200000"], stdout=subprocess.PIPE, stderr=terminal)
        os.close(terminal)
        drawn = b""
        try:
            while block := os.read(controller, 65536):
                drawn += block
        except OSError:  # the terminal is closed
            pass
        out, _ = process.communicate(timeout=60)
        os.close(controller)
        self.assertEqual(process.returncode, 0)
        self.assertNotIn(b"\r", out)
        lines = drawn.split(b"\r")
        self.assertIn(b"evaluating", drawn)
        self.assertTrue(all(len(line) < 80 for line in lines))
        self.assertEqual(lines[-1], b"")
        self.assertEqual(lines[-2].strip(), b"")


class ProgressLines(CommandLineTest):
    """Without a terminal, long commands report progress in plain lines."""

    def start_watched(self, *arguments):
        return subprocess.Popen([command_line.TOOL, *arguments], cwd=self.directory,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def test_long_commands_print_plain_lines_unless_quiet(self):
        watched = [self.start_watched(*LONG, *json) for json in ((), ("--json",))]
        quiet = [self.start_watched(*words) for words in (("--quiet", *LONG), (*LONG, "--quiet"))]
        for process in watched:
            first = process.stderr.readline()
            self.assertRegex(first, rb"^tofsmith: evaluating \d+ %  \w[^\r\x1b]*\n$")
        time.sleep(1)  # longer than the delay of the first line
        for process in (*watched, *quiet):
            self.assertEqual(self.interrupted(process),
                             "tofsmith: interrupted; nothing was written\n")

    def test_short_commands_print_no_progress(self):
        process = self.start_watched("evaluate", "sinusoid-k4", "--trials", "100", "--set",
                                  "samples=60", "--json")
        self.assertEqual(process.communicate(timeout=60)[1], b"")


class Lab(CommandLineTest):
    """`tofsmith lab` copies the installed page, or reports that it is missing."""

    def installed(self, *arguments):
        done = subprocess.run([self.path("usr/bin/tofsmith"), *arguments], cwd=self.directory,
                              capture_output=True, text=True, timeout=60)
        return done.returncode, done.stdout, done.stderr

    def setUp(self):
        super().setUp()
        os.makedirs(self.path("usr/bin"))
        os.makedirs(self.path("usr/share/tofsmith"))
        shutil.copy(command_line.TOOL, self.path("usr/bin/tofsmith"))

    def test_copies_the_installed_page_and_replaces_nothing(self):
        self.write("usr/share/tofsmith/lab.html", PAGE)
        self.assertEqual(self.installed("lab", "-o", "page.html")[0::2], (0, ""))
        self.assertEqual(self.bytes_of("page.html"), PAGE)
        self.write("page.html", "mine")
        code, out, error = self.installed("lab", "-o", "page.html")
        self.assertEqual((code, out), (1, ""))
        self.assertIn("--force", error)
        self.assertEqual(self.bytes_of("page.html"), b"mine")
        self.assertEqual(self.installed("lab", "-o", "page.html", "--force")[0], 0)
        self.assertEqual(self.bytes_of("page.html"), PAGE)

    def test_explains_how_to_build_a_missing_page(self):
        code, out, error = self.installed("lab", "-o", "page.html")
        self.assertEqual((code, out), (1, ""))
        self.assertIn("scripts/lab.sh", error)
        self.assertFalse(os.path.exists(self.path("page.html")))

    def test_an_empty_page_is_treated_as_missing(self):
        self.write("usr/share/tofsmith/lab.html", b"")
        self.assertEqual(self.installed("lab")[0], 1)
        self.assertFalse(os.path.exists(self.path("lab.html")))


if __name__ == "__main__":
    unittest.main()
