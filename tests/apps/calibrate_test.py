# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Calibrations from files to a camera, a table and maps that other commands take."""

import unittest

import numpy as np

from bench_records import CAMERA, RANGE_M, BenchRecordsTest


class Calibrate(BenchRecordsTest):
    def test_a_response_becomes_a_camera(self):
        self.record()
        document = self.do_json("calibrate", "impulse-response", "scope.csv")
        best = document["fits"][0]
        true_hz = np.sqrt(np.log(2)) / (2 * np.pi * 1.5e-9)
        self.assertEqual((document["excitation"], best["kind"]), ("pulse", "gaussian"))
        self.assertLess(abs(best["bandwidth_hz"]["value"] / true_hz - 1), 0.02)
        text = self.do("calibrate", "impulse-response", "scope.csv", "-o", "mine.toml",
                       "--report", "page.html")
        self.assertIn("next: tofsmith design mine.toml", text)
        self.assertIn("mine-response.csv", self.files())
        errors = self.do_json("evaluate", "hamiltonian-k3", "--camera", "mine.toml",
                              "--trials", "200")
        self.assertEqual(errors["camera"]["light"]["impulse_response"]["kind"], "file")
        self.do("calibrate", "impulse-response", "scope.csv", "-o", "fit.toml", "--as", "gaussian",
                "--arm", "sensor")
        self.assertIn("gaussian", self.bytes_of("fit.toml").decode())

    def test_bad_records_are_refused(self):
        command = ["calibrate", "impulse-response"]
        self.write("a.csv", "4,5\n1,7\n" * 20)
        self.refuse([*command, "a.csv"], "a.csv:1", "--decimal")
        self.write("b.csv", "t,v\n" + "".join(f"{i}.5,{i}\n" for i in range(30)) + "30.5,nan\n")
        self.refuse([*command, "b.csv"], "b.csv:32", "nan")
        self.write("c.csv", "".join(f"{i}.5,1.5\n" for i in range(30)))
        self.refuse([*command, "c.csv"], "longer than the camera's period", "--time-unit")
        self.record()
        self.refuse([*command, "scope.csv", "-o", "x.json"], ".toml", code=2)
        self.refuse([*command, "scope.csv", "--report", "scope.csv"], ".html", code=2)
        self.refuse(["calibrate"], "subcommand", code=2)
        self.refuse(["calibrate", "noise", "--darkk", "x"], "did you mean --dark?", code=2)

    def test_a_sweep_becomes_table_maps_and_camera(self):
        self.sweep()
        arguments = ["calibrate", "correlation", "sweep.npy", "--shifts", "shifts.txt",
                     "--shift-unit", "bin", "--camera", "camera.toml"]
        found = self.do_json(*arguments, "--table", "t.npz", "--offset-map", "o.npy", "--gain-map",
                             "g.npy", "-o", "fitted.toml", "--report", "page.html")
        self.assertEqual((found["samples"], found["measurements"]), (60, 4))
        self.assertEqual(found["dead_pixels"], 1)
        best = found["ideal_codes"][0]
        self.assertEqual(best["code"], "hamiltonian-k4")
        f_max = best["parameter_hz"]
        self.assertLess(abs(f_max["value"] - 75e6), 4 * f_max["standard_error"] + 1e6)
        self.assertTrue(np.isnan(np.load(self.path("o.npy"))[2, 3]))
        decoded = self.do_json("decode", "raw.npy", "--code", "t.npz", "--camera", "camera.toml",
                               "--offset-map", "o.npy", "--gain-map", "g.npy", "-o", "d.npy")
        self.assertEqual([n for n in decoded["notes"] if "not used" in n], [])
        depth = np.load(self.path("d.npy"))
        off = (depth - 0.0 + RANGE_M / 2) % RANGE_M - RANGE_M / 2
        self.assertLess(np.nanmedian(np.abs(off)), 0.05)
        self.do("design", "fitted.toml", "--method", "factorize", "--exposures", "3", "--trials",
                "1000", "--effort", "0.1", "-o", "designed")
        np.save(self.path("short.npy"), np.load(self.path("sweep.npy"))[:40])
        np.savetxt(self.path("some.txt"), np.arange(40))
        self.refuse(["calibrate", "correlation", "short.npy", "--shifts", "some.txt",
                     "--shift-unit", "bin", "--camera", "camera.toml"], "whole period", "missing")

    def swept(self, *, taps, difference=False, order=(0, 1, 2, 3), sign=1):
        """A camera.toml of four phases, its sweep with wiggle, and a frame of 64 delays."""
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

    def test_the_next_command_decodes_tables_of_any_taps_and_readout(self):
        for taps, difference in ((1, False), (2, False), (2, True)):
            truth = self.swept(taps=taps, difference=difference)
            text = self.do("calibrate", "correlation", "sweep.npy", "--shifts", "shifts.txt",
                           "--shift-unit", "bin", "--camera", "camera.toml", "--table", "t.npz",
                           "-o", "fitted.toml", "--force")
            line = next(line for line in text.splitlines() if "next: tofsmith decode" in line)
            command = line.removeprefix("next: tofsmith ").replace("RAW", "raw.npy").split()
            self.do(*command, "--force")
            self.assertLess(self.errors_m("depth.npy", truth).max(), 5e-3, (taps, difference))

    def test_direction_and_order_are_kept_by_the_camera_and_can_be_said(self):
        truth = self.swept(taps=2, difference=True, order=(0, 1, 3, 2), sign=-1)
        self.do("calibrate", "correlation", "sweep.npy", "--shifts", "shifts.txt", "--shift-unit",
                "bin", "--camera", "camera.toml", "--code", "sinusoid-k4", "-o", "fitted.toml")
        self.assertIn("[playback]", self.bytes_of("fitted.toml").decode())
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
        self.refuse([*said, "--order", "0,1,2"], "order")

    def test_reference_depth_becomes_a_corrected_table(self):
        self.write("camera.toml", "fundamental_frequency_hz = 60e6\n[sensor]\ntaps = 2\n"
                   'drain = false\nreadout = "difference"\n')
        range_m = 299792458 / 120e6
        random = np.random.default_rng(2)
        rows, columns = np.mgrid[0:48, 0:64]
        nominal = range_m * (np.arange(4)[:, None, None] + 0.5 + 0.5 * np.sin(
            rows / 9 + columns / 7)) / 4
        phase = 2 * np.pi * nominal / range_m
        error = 0.4 + 0.012 * np.cos(4 * phase + 1) + 0.005 * (2 * rows / 47 - 1)
        raw = 2e4 * np.cos(phase[..., None] - np.arange(4) * np.pi / 2)
        raw = raw + random.normal(size=raw.shape) * 100
        reference = (nominal - error) % range_m
        np.save(self.path("raw.npy"), raw.astype(np.float32))
        np.save(self.path("ref.npy"), np.where(columns < 32, reference, np.nan))
        command = ["calibrate", "correlation", "raw.npy", "--reference", "ref.npy", "--camera",
                   "camera.toml", "--table", "t.npz", "-o", "mine.toml"]
        self.refuse(command, "--code", code=2)
        text = self.do(*command, "--code", "sinusoid-k4", "--report", "page.html")
        page = self.bytes_of("page.html").decode()
        for word in ("error-over-depth", "taken off", "cos 4"):
            self.assertTrue(word in page, word)
        self.assertIn("next: tofsmith decode RAW --code t.npz --camera mine.toml", text)
        self.do("decode", "raw.npy", "--code", "t.npz", "--camera", "mine.toml", "--stack", "-o",
                "d.npy")
        off = (np.load(self.path("d.npy")) - reference + range_m / 2) % range_m - range_m / 2
        self.assertLess(np.median(np.abs(off[:, :, :32])), 2.5e-3)
        phases = [f"p{k}.npy" for k in range(4)]
        for k, name in enumerate(phases):
            np.save(self.path(name), raw[..., k].astype(np.float32))
        raw.transpose(0, 3, 1, 2).astype("<f4").tofile(self.path("raw.bin"))
        self.write("raw.toml", 'width = 64\nheight = 48\nmeasurements = 4\nbits = 32\n'
                   'numbers = "float"\n')
        for frames in (phases, ["raw.bin", "--raw-format", "raw.toml"]):
            said = [*command[:2], *frames, *command[3:], "--code", "sinusoid-k4", "--force"]
            said[said.index("t.npz")] = "u.npz"
            self.do(*said)
            one, other = np.load(self.path("t.npz")), np.load(self.path("u.npz"))
            for name in one.files:
                np.testing.assert_array_equal(one[name], other[name], name)
        self.refuse(["calibrate", "correlation", *phases], "--reference", code=2)
        np.save(self.path("ref.npy"), 1e3 * reference)
        self.refuse([*command, "--code", "sinusoid-k4", "--force"], "metres")
        np.save(self.path("small.npy"), raw[:, :20].astype(np.float32))
        self.refuse(["decode", "small.npy", "--code", "t.npz", "--camera", "mine.toml", "-o",
                     "e.npy"], "48 x 64")

    def test_pairs_of_frames_become_noise(self):
        self.flat_frames()
        command = ["calibrate", "noise", "1.npy", "2.npy", "3.npy", "--camera", "camera.toml"]
        found = self.do_json(*command, "--dark", "0.npy", "-o", "noisy.toml", "--report", "p.html")
        for key, truth in (("gain_e_per_dn", 8), ("read_noise_e", 30), ("black_level_dn", 100)):
            self.assertLess(abs(found[key]["value"] - truth), 4 * found[key]["standard_error"], key)
        self.assertIn("read_noise_e", self.bytes_of("noisy.toml").decode())
        self.refuse([*command, "--set", "sensor.taps=2", "--set", "sensor.readout=difference"],
                    "--code", code=2)
        self.refuse([*command, "--code", "sinusoid-k4"], "sensor.readout", code=2)
        self.refuse(["calibrate", "noise", "1.npy"], "--dark", code=2)

    def test_pairs_of_differences_become_noise_by_their_code(self):
        self.write("camera.toml", CAMERA.replace("read_noise_e",
                                                 'taps = 2\nreadout = "difference"\nread_noise_e'))
        np.save(self.path("scene.npy"), np.full((48, 48), 2.0, np.float32))
        for i, signal in enumerate(("0", "4e6", "1e7", "2e7")):
            self.do("simulate", "scene.npy", "--kind", "radial", "--code", "sinusoid-k4",
                    "--camera", "camera.toml", "--signal", signal, "--ambient", "0", "--frames",
                    "2", "--seed", str(i), "-o", f"{i}.npy")
        found = self.do_json("calibrate", "noise", "1.npy", "2.npy", "3.npy", "--dark", "0.npy",
                             "--camera", "camera.toml", "--code", "sinusoid-k4", "-o",
                             "noisy.toml", "--report", "p.html")
        for key, truth in (("gain_e_per_dn", 8), ("read_noise_e", 30)):
            self.assertLess(abs(found[key]["value"] - truth), 4 * found[key]["standard_error"], key)
        self.assertEqual(found["buckets"], 2)
        self.assertIn("black_level_dn = 100", self.bytes_of("noisy.toml").decode())

    def test_a_target_before_black_becomes_a_kernel_that_decode_takes_off(self):
        self.write("camera.toml", CAMERA)
        size, reach, black = 40, 39, 100.0
        v, u = np.mgrid[-reach:reach + 1, -reach:reach + 1]
        kernel = 1 / np.maximum(np.hypot(v, u), 3) ** 2
        kernel[reach, reach] = 0
        kernel *= 0.05 / kernel.sum()

        def seen(light):
            spread = np.zeros_like(light)
            for row, column in zip(*np.nonzero(light[..., 0])):
                part = kernel[reach - row:reach - row + size, reach - column:reach - column + size]
                spread += part[..., None] * light[row, column]
            return black + 0.95 * light + spread

        n = np.arange(4) / 4
        target = np.zeros((size, size, 4))
        target[18:23, 12:17] = 1500 * (1.2 + np.cos(2 * np.pi * (0.3 - n)))
        rng = np.random.default_rng(1)
        np.save(self.path("target.npy"), rng.normal(seen(target), 0.5, (32, size, size, 4)))
        found = self.do_json("calibrate", "stray-light", "target.npy", "--camera", "camera.toml",
                             "-o", "kernel.npy", "--report", "stray.html")
        total = found["total"]
        share = kernel[np.hypot(v, u) <= found["radius_px"][-1]].sum()
        self.assertLess(abs(total["value"] - share), 5 * total["standard_error"])
        self.assertIn("share-over-distance", self.bytes_of("stray.html").decode())
        # A dark wall beside a bright one.
        walls = np.empty((size, size, 4))
        walls[:, :15] = 1000 * (1.2 + np.cos(2 * np.pi * (0.2 - n)))
        walls[:, 15:] = 20 * (1.2 + np.cos(2 * np.pi * (0.6 - n)))
        np.save(self.path("walls.npy"), seen(walls).astype(np.float32))
        decode = ["decode", "walls.npy", "--code", "sinusoid-k4", "--camera", "camera.toml", "-o",
                  "d.npy", "--force"]
        errors = []
        for options in ([], ["--stray-light", "kernel.npy"]):
            self.do(*decode, *options)
            wall = np.load(self.path("d.npy"))[5:-5, 22:35]
            errors.append(abs(wall - 0.6 * RANGE_M).mean())
        self.assertGreater(errors[0], 0.1)
        self.assertLess(errors[1], 0.1 * errors[0])
        # A capture through such a lens is put right by the same kernel.
        np.save(self.path("scene.npy"), np.where(np.arange(40) < 20, 1.0, 4.0)[None].repeat(30, 0))
        frames = {}
        for name, options in (("plain", []), ("stray", ["--stray-light", "kernel.npy"])):
            self.do("simulate", "scene.npy", "--kind", "radial", "--code", "sinusoid-k4", "--camera",
                    "camera.toml", "--signal", "2e7", "-o", f"{name}.npy", *options)
            frames[name] = np.load(self.path(f"{name}.npy"))
        self.assertGreater(np.abs(frames["stray"] - frames["plain"]).max(), 20)
        errors = []
        for name, options in (("plain", []), ("stray", []),
                              ("stray", ["--stray-light", "kernel.npy"])):
            self.do("decode", f"{name}.npy", "--code", "sinusoid-k4", "-o", "d.npy", "--force",
                    *options)
            errors.append(abs(np.load(self.path("d.npy"))[:, 22:].mean() - 4.0))
        self.assertGreater(errors[1], 5 * max(errors[0], errors[2]))
        self.refuse(["simulate", "ball", "corner", "--code", "sinusoid-k4", "--stray-light",
                     "kernel.npy", "-o", "set"], "--stray-light", code=2)
        np.save(self.path("even.npy"), np.zeros((2, 2), np.float32))
        self.refuse([*decode, "--stray-light", "even.npy"], "even.npy: kernel size = 2 x 2")
        self.refuse([*decode, "--stray-light", "none.npy"], "none.npy")
        np.save(self.path("flat.npy"), np.full((1, 20, 20, 4), 300.0))
        self.refuse(["calibrate", "stray-light", "flat.npy", "--camera", "camera.toml"],
                    "at most a quarter")

    def test_frames_that_warm_up_become_drift_per_degree(self):
        degrees = np.linspace(20, 47, 10)
        warmer = (degrees - 20)[:, None, None, None]
        depth = np.linspace(1, 8, 36).reshape(1, 6, 6, 1) + 1e-3 * warmer
        signal = 1e5 * np.exp(-4e-3 * warmer)
        phase = 2 * np.pi * (depth / 9.9930819 - np.arange(4) / 4)
        light = signal * (1.2 + np.cos(phase))
        np.save(self.path("warm.npy"), np.random.default_rng(1).poisson(light).astype(np.float32))
        np.savetxt(self.path("degrees.txt"), degrees)
        command = ["calibrate", "temperature", "warm.npy", "--code", "sinusoid-k4", "--set",
                   "fundamental_frequency_hz=15e6", "--temperatures"]
        found = self.do_json(*command, "degrees.txt")
        for key, truth in (("offset_m_per_c", 1e-3), ("signal_per_c", -4e-3)):
            self.assertLess(abs(found[key]["value"] - truth), 5 * found[key]["standard_error"], key)
        self.do(*command, "degrees.txt", "--reference-c", "20", "-o", "warm.toml", "--report",
                "drift.html")
        self.assertIn("depth-over-temperature", self.bytes_of("drift.html").decode())
        np.save(self.path("last.npy"), np.load(self.path("warm.npy"))[9])
        decode = ["decode", "last.npy", "--code", "sinusoid-k4", "-o", "last.npz", "--force"]
        self.do(*decode, "--camera", "warm.toml", "--temperature", "47")
        cold = np.load(self.path("last.npz"))
        self.assertLess(abs(np.median(cold["depth"] - np.linspace(1, 8, 36).reshape(6, 6))), 3e-3)
        self.do(*decode, "--camera", "warm.toml")
        warm = np.load(self.path("last.npz"))
        self.assertAlmostEqual(float(np.median(warm["depth"] - cold["depth"])), 0.027, delta=2e-3)
        self.assertAlmostEqual(float(np.median(warm["signal"] / cold["signal"])),
                               float(np.exp(-4e-3 * 27)), delta=5e-3)
        self.refuse([*decode, "--temperature", "47"], "has no [temperature]", code=2)
        np.savetxt(self.path("few.txt"), degrees[:3])
        self.refuse([*command, "few.txt"], "one for each of the 10 frames")

    def test_perturbations_are_told_alone_and_together(self):
        arguments = ["evaluate", "hamiltonian-k3", "--trials", "200"]
        report = self.do_json(*arguments, "--perturb", "jitter=50ps,clock=5ns,droop=3%")
        names = [p["name"] for p in report["codes"][0]["robustness"]["perturbations"]]
        self.assertEqual(names, ["edge jitter 50 ps", "clock 5.13 ns", "droop 3 %",
                                 "all together"])
        self.do(*arguments, "--perturb", "droop=3%", "-o", "page.html")
        self.assertIn("robustness-ratios", self.bytes_of("page.html").decode())
        self.refuse([*arguments, "--perturb", "jiter=50ps"], "jitter=VALUE", code=2)
        self.refuse([*arguments, "--perturb", "jitter=50"], "with its unit", code=2)
        self.refuse([*arguments, "--perturb", "droop=300%"], "share in (0, 1)", code=2)
        self.refuse([*arguments, "--perturb", "droop=3%", "--robustness"], "choose one", code=2)
        self.refuse([*arguments, "--perturb", "clock=60ns"], "points per period")


if __name__ == "__main__":
    unittest.main()
