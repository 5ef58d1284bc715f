# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Calibrations from files to a camera, a table and maps for other commands."""

import unittest

import numpy as np

from bench_records import CAMERA, BenchRecordsTest


class Calibrate(BenchRecordsTest):

    def test_invalid_records_are_rejected(self):
        command = ["calibrate", "impulse-response"]
        self.write("a.csv", "4,5\n1,7\n" * 20)
        self.refuse([*command, "a.csv"], "a.csv:1", "--decimal")
        self.write("c.csv", "".join(f"{i}.5,1.5\n" for i in range(30)))
        self.refuse([*command, "c.csv"], "longer than the camera's period", "--time-unit")
        self.record()
        self.refuse([*command, "scope.csv", "-o", "x.json"], ".toml", code=2)
        self.refuse([*command, "scope.csv", "--report", "scope.csv"], ".html", code=2)
        self.refuse(["calibrate", "noise", "--darkk", "x"], "did you mean --dark?", code=2)

    def swept(self, *, taps, difference=False, order=(0, 1, 2, 3), sign=1):
        """Writes the camera.toml of a four-phase camera, a delay sweep with harmonic errors, and a
        frame of 64 delays."""
        self.write("camera.toml", "fundamental_frequency_hz = 60e6\nsamples = 60\n[sensor]\n"
                   f"taps = {taps}\ndrain = {'true' if taps == 1 else 'false'}\n"
                   + ('readout = "difference"\n' if difference else ""))

        def raw(delay_bin):
            phase = 2 * np.pi * (sign * delay_bin[:, None] / 60 - np.array(order) / 4)
            a = 1e5 * (1 + .6 * np.cos(phase) + .05 * np.cos(3 * phase))
            b = 2e5 - a
            return a - b if difference else a if taps == 1 else np.stack([a, b], 2).reshape(-1, 8)

        noise = np.random.default_rng(1)
        sweep = raw(np.arange(60.0))
        sweep = sweep[:, None, None, :] + noise.normal(size=(60, 6, 6, sweep.shape[1])) * 100
        np.save(self.path("sweep.npy"), sweep.astype(np.float32))
        np.savetxt(self.path("shifts.txt"), np.arange(60))
        delay_bin = np.linspace(2, 56, 64)
        np.save(self.path("raw.npy"), raw(delay_bin)[None].astype(np.float32))
        return delay_bin / 60 * 299792458 / 120e6

    def errors_m(self, depth, truth):
        range_m = 299792458 / 120e6
        return np.abs((np.load(self.path(depth))[0] - truth + range_m / 2) % range_m - range_m / 2)

    def test_tables_of_any_taps_and_readout_are_decoded(self):
        for taps, difference in ((1, False), (2, False), (2, True)):
            truth = self.swept(taps=taps, difference=difference)
            text = self.do("calibrate", "correlation", "sweep.npy", "--shifts", "shifts.txt",
                           "--shift-unit", "bin", "--camera", "camera.toml", "--table", "t.npz",
                           "-o", "fitted.toml", "--force")
            line = next(line for line in text.splitlines() if "next: tofsmith decode" in line)
            command = line.removeprefix("next: tofsmith ").replace("RAW", "raw.npy").split()
            self.do(*command, "--force")
            self.assertLess(self.errors_m("depth.npy", truth).max(), 5e-3, (taps, difference))
            document = self.do_json("calibrate", "correlation", "sweep.npy", "--shifts",
                                    "shifts.txt", "--shift-unit", "bin", "--camera", "camera.toml")
            self.assertIn(f"values span {document['swing']:.5g} raw numbers", text)

    def test_the_camera_file_marks_or_omits_values_that_nobody_gave(self):
        self.record()
        self.write("own.toml", "fundamental_frequency_hz = 15e6\n[sensor]\nread_noise_e = 7\n")
        def fitted(camera):
            self.do("calibrate", "impulse-response", "scope.csv", "--arm", "light", "--camera",
                    camera, "-o", "fitted.toml", "--force")
            lines = self.bytes_of("fitted.toml").decode().splitlines()
            return {line.split(" = ")[0]: line for line in lines if " = " in line}
        lines = fitted("own.toml")
        self.assertEqual(sorted(lines), ["fundamental_frequency_hz", "impulse_response", "name",
                                         "read_noise_e"])
        self.assertNotIn("not measured", "".join(lines.values()))
        lines = fitted("indoor")
        self.assertIn("# of the camera indoor, not measured", lines["source_power_w"])
        self.assertNotIn("not measured", lines["name"])

    def test_direction_and_order_are_stored_in_the_camera_or_given_as_options(self):
        truth = self.swept(taps=2, difference=True, order=(0, 1, 3, 2), sign=-1)
        self.do("calibrate", "correlation", "sweep.npy", "--shifts", "shifts.txt", "--shift-unit",
                "bin", "--camera", "camera.toml", "--code", "sinusoid-k4", "-o", "fitted.toml")
        self.assertIn("[playback]", self.bytes_of("fitted.toml").decode())
        self.assertIn('name = "camera"', self.bytes_of("fitted.toml").decode())
        self.do("decode", "raw.npy", "--code", "sinusoid-k4", "--camera", "fitted.toml", "-o",
                "d.npy")
        self.assertLess(self.errors_m("d.npy", truth).max(), 60e-3)       # its harmonics remain
        said = ["decode", "raw.npy", "--code", "sinusoid-k4", "--camera", "camera.toml", "-o",
                "d.npy", "--force"]
        self.do(*said, "--order", "0,1,3,2", "--reverse")
        plain = np.load(self.path("d.npy"))
        self.assertLess(np.ptp(np.unwrap((plain[0] - truth) * 2 * np.pi / 2.498)), 0.3)
        self.do(*said, "--order", "0,1,3,2", "--reverse", "--offset-m", "0.25")
        np.testing.assert_allclose((plain - np.load(self.path("d.npy"))) % 2.49827, 0.25, atol=1e-4)
        self.refuse([*said, "--order", "0,1,1,2"], "order", "once")

    def test_reference_depth_accepts_frames_in_every_format(self):
        self.write("camera.toml", "fundamental_frequency_hz = 60e6\n[sensor]\ntaps = 2\n"
                   'drain = false\nreadout = "difference"\n')
        nominal_m = np.linspace(0.1, 2.3, 4 * 48 * 64).reshape(4, 48, 64)
        phase = nominal_m * 240e6 * np.pi / 299792458
        raw = 2e4 * np.cos(phase[..., None] - np.arange(4) * np.pi / 2)
        raw = (raw + np.random.default_rng(2).normal(size=raw.shape) * 100).astype("<f4")
        np.save(self.path("raw.npy"), raw)
        np.save(self.path("ref.npy"), nominal_m - 0.05)
        phases = [f"p{k}.npy" for k in range(4)]
        for k, name in enumerate(phases):
            np.save(self.path(name), raw[..., k])
        raw.transpose(0, 3, 1, 2).tofile(self.path("raw.bin"))
        self.write("raw.toml", 'width = 64\nheight = 48\nmeasurements = 4\nbits = 32\n'
                   'numbers = "float"\n')
        tables = []
        for frames in (["raw.npy"], phases, ["raw.bin", "--raw-format", "raw.toml"]):
            command = ["calibrate", "correlation", *frames, "--reference", "ref.npy", "--camera",
                       "camera.toml", "--table", "t.npz", "-o", "mine.toml", "--force"]
            text = self.do(*command, "--code", "sinusoid-k4")
            self.assertIn("next: tofsmith decode RAW --code t.npz --camera mine.toml", text)
            tables.append(self.bytes_of("t.npz"))
        self.assertEqual(tables[1:], tables[:1] * 2)
        self.refuse(command, "--code", code=2)
        self.refuse(["calibrate", "correlation", *phases], "--reference", code=2)
        np.save(self.path("small.npy"), raw[:, :20])
        self.refuse(["decode", "small.npy", "--code", "t.npz", "--camera", "mine.toml", "-o",
                     "e.npy"], "48 x 64")

    def test_rejects_incompatible_options(self):
        self.write("camera.toml", CAMERA)
        np.save(self.path("raw.npy"), np.full((3, 20, 20, 4), 300.0, np.float32))
        np.save(self.path("even.npy"), np.zeros((2, 2), np.float32))
        np.savetxt(self.path("few.txt"), [20, 23])
        noise = ["calibrate", "noise", "raw.npy", "--camera", "camera.toml"]
        decode = ["decode", "raw.npy", "--code", "sinusoid-k4", "-o", "d.npy"]
        for arguments, word in (
                ([*noise, "--set", "sensor.taps=2", "--set", "sensor.readout=difference"], "--code"),
                ([*noise, "--code", "sinusoid-k4"], "sensor.readout"),
                (["calibrate", "noise", "raw.npy"], "--dark"),
                (["simulate", "ball", "corner", "--code", "sinusoid-k4", "--stray-light", "even.npy",
                  "-o", "set"], "--stray-light"),
                ([*decode, "--temperature", "47"], "has no [temperature]")):
            self.refuse(arguments, word, code=2)
        self.refuse([*decode, "--stray-light", "even.npy"], "even.npy: kernel size = 2 x 2")
        self.refuse([*decode, "--stray-light", "none.npy"], "none.npy")
        self.refuse(["calibrate", "stray-light", "raw.npy", "--camera", "camera.toml"],
                    "at most a quarter")
        self.refuse(["calibrate", "temperature", "raw.npy", "--code", "sinusoid-k4",
                     "--temperatures", "few.txt"], "one for each of the 3 frames")

    def test_temperatures_are_columns_of_one_file(self):
        np.save(self.path("raw.npy"), np.full((3, 20, 20, 4), 300.0, np.float32))
        self.write("c.csv", "frame,light,sensor,board\n0,20,21,22\n1,25,24,23\n2,30,26,24\n")
        calibrate = ["calibrate", "temperature", "raw.npy", "--code", "sinusoid-k4",
                     "--temperatures", "c.csv"]
        self.refuse(calibrate, "--light-column")
        self.refuse([*calibrate, "--sensor-column", "sensor"], "c.csv", "--light-column")
        self.refuse([*calibrate, "--sensor-column", "lens", "--light-column", "light"],
                    "no column lens")
        self.refuse([*calibrate, "--sensor-column", "light", "--light-column", "light"],
                    "is also the --light-column", code=2)
        self.refuse([*calibrate, "--sensor-column", "sensor", "--light-column", "light"],
                    "must be at least 6")
        self.refuse(["decode", "raw.npy", "--code", "sinusoid-k4", "-o", "d.npy",
                     "--sensor-temperature", "47"], "has no [temperature.sensor]", code=2)

    def test_perturbations_are_reported_separately_and_combined(self):
        arguments = ["evaluate", "hamiltonian-k3", "--trials", "200"]
        report = self.do_json(*arguments, "--perturb", "jitter=50ps,clock=5ns,droop=3%")
        names = [p["name"] for p in report["codes"][0]["robustness"]["perturbations"]]
        self.assertEqual(names, ["edge jitter 50 ps", "clock 5.13 ns", "droop 3 %",
                                 "all together"])
        self.do(*arguments, "--perturb", "droop=3%", "-o", "page.html")
        self.assertIn("\"id\":\"robustness\"", self.bytes_of("page.html").decode())
        self.refuse([*arguments, "--perturb", "jiter=50ps"], "jitter=VALUE", code=2)
        self.refuse([*arguments, "--perturb", "droop=300%"], "share in (0, 1)", code=2)
        self.refuse([*arguments, "--perturb", "droop=3%", "--robustness"], "cannot be combined", code=2)
        self.refuse([*arguments, "--perturb", "clock=60ns"], "points per period")


if __name__ == "__main__":
    unittest.main()
