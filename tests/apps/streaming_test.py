# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Decoding of recordings of any size: pipes, stacks, notes, bounded memory, interrupts."""

import os
import pty
import signal
import subprocess
import time
import unittest

import numpy as np

import command_line
from command_line import CommandLineTest

MEMORY_LIMIT_MB = 512


class Streaming(CommandLineTest):
    def record(self, frames=3, dtype="u2"):
        """Writes frames of a ramp of distances, 30 x 40 pixels, as (F, H, W, K)."""
        np.save(self.path("scene.npy"),
                np.linspace(1, 4, 30 * 40).reshape(30, 40).astype(np.float32))
        self.do("simulate", "scene.npy", "--kind", "radial", "--code", "hamiltonian-k3",
                "--signal", "1e5", "--no-falloff", "--frames", str(frames), "--force", "-o",
                "sim.npy")
        raw = np.clip(np.load(self.path("sim.npy")), 0, 255 if dtype == "u1" else 65535)
        raw = raw.reshape(frames, 30, 40, 3).astype(dtype)
        np.save(self.path("raw.npy"), raw)
        return raw

    def pipe(self, *more):
        self.write("s.raw.toml", 'width = 40\nheight = 30\nmeasurements = 3\nbits = 16\n'
                   'layout = "interleaved"\n')
        return [command_line.TOOL, "decode", "-", "--raw-format", "s.raw.toml", "--code",
                "hamiltonian-k3", "--camera", "paper-10f0", *more, "-o", "-"]

    def test_frames_pass_through_a_pipe_one_by_one(self):
        raw = self.record()
        self.decode("--stack", "--outputs", "depth,status")
        depth, status = np.load(self.path("d.npy")), np.load(self.path("d-status.npy"))
        process = subprocess.Popen(self.pipe("--outputs", "depth,status"), cwd=self.directory,
                                   stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        for frame in range(3):  # each is output before the next one is sent
            process.stdin.write(raw[frame].tobytes())
            process.stdin.flush()
            out = process.stdout.read(30 * 40 * 5)
            np.testing.assert_array_equal(np.frombuffer(out[:4800], "<f4").reshape(30, 40),
                                          depth[frame])
            np.testing.assert_array_equal(np.frombuffer(out[4800:], "u1").reshape(30, 40),
                                          status[frame])
        process.stdin.write(raw[0].tobytes()[:100])
        out, error = process.communicate(timeout=60)
        self.assertEqual((process.returncode, out), (1, b""))
        self.assertIn("decoded 3 frames", error.decode())
        self.assertIn("found 100 bytes and the end; expected 7200 of frame 3", error.decode())

    def test_sliding_windows_are_those_of_files(self):
        raw = self.record()
        self.decode("--stack", output="frames.npy")
        document = self.do_json(*self.arguments("--sliding", "--stack", output="windows.npy"))
        self.assertTrue(document["sliding"])
        frames, windows = (np.load(self.path(f"{name}.npy")) for name in ("frames", "windows"))
        np.testing.assert_array_equal(windows[::3], frames)
        out = subprocess.run(self.pipe("--sliding"), cwd=self.directory, input=raw.tobytes(),
                             capture_output=True, check=True, timeout=60)
        self.assertEqual(out.stdout, windows.astype("<f4").tobytes())
        self.assertIn("decoded 7 frames", out.stderr.decode())
        for more in (("--average", "2"), ("--averaged", "2"), ("--hdr", "1,4,16")):
            self.refuse(self.arguments("--sliding", *more), more[0], "is not valid with sliding",
                        code=2)

    def test_a_pipe_can_be_interrupted_while_it_waits(self):
        process = subprocess.Popen(self.pipe(), cwd=self.directory, stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=10), 130)
        self.assertIn("decoded 0 frames", process.communicate()[1].decode())

    def test_a_pipe_excludes_files(self):
        self.record()
        self.write("s.raw.toml", "width = 40\nheight = 30\nmeasurements = 3\nbits = 16\n")
        code = ("--code", "hamiltonian-k3")
        self.refuse(["decode", "-", *code, "-o", "d.npy"], "-o -", code=2)
        self.refuse(["decode", "raw.npy", *code, "-o", "-"], "RAW -", code=2)
        self.refuse(["decode", "-", *code, "-o", "-"], "--raw-format", code=2)
        self.refuse(["decode", "-", "-", *code, "-o", "-"],
                    "cannot be combined with other input files", code=2)

    def arguments(self, *more, raw="raw.npy", output="d.npy"):
        return ["decode", raw, "--code", "hamiltonian-k3", "-o", output, *more]

    def decode(self, *more, **names):
        return self.do_json(*self.arguments(*more, **names))

    def sparse(self, name, shape, dtype, written=()):
        """Creates a large sparse file; `written` are (index, values) of its first axes."""
        np.lib.format.open_memmap(self.path(name), "w+", dtype, shape)
        array = np.load(self.path(name), mmap_mode="r+")
        for index, values in written:
            array[index] = values
        del array
        return name

    def peak_mb(self, *arguments):
        """Returns the peak resident memory of a command that succeeds; at least that of Python."""
        process = self.start(*arguments)
        out, error = process.stdout.read(), process.stderr.read()
        process.stdout.close()
        process.stderr.close()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual((process.returncode, error), (0, b""), out)
        return usage.ru_maxrss / 1000

    def test_bands_give_the_same_files(self):
        self.record()
        for extension in ("npy", "npz", "exr", "pfm", "png", "ply"):
            kind = ("--view-deg", "60", *(() if extension == "ply" else ("--kind", "z")))
            # The planes of a frame are kept in memory; the raw values are read in bands.
            few = ("--memory-mb", {"npy": "0.01", "npz": "0.012", "ply": "0.055"}.get(extension,
                                                                                       "0.017"))
            self.decode(*kind, "--outputs", "depth", output="whole." + extension)
            self.decode(*kind, "--outputs", "depth", *few, output="bands." + extension)
            for frame in range(3):
                self.assertEqual(self.bytes_of(f"whole-{frame}.{extension}"),
                                 self.bytes_of(f"bands-{frame}.{extension}"), extension)

    def test_rejects_invalid_filters_and_means(self):
        self.record(frames=5)
        ahead = ("--time-filter", "8")
        for more, words in ((("--filter", "light", "--filter-set", "window=1"),
                             ["did you mean windows?"]),
                            (("--filter", "light", "--filter-set", "windows"), ["KEY=VALUE"]),
                            (("--filter", "light", "--filter-set", "windows=1.5"),
                             ["windows: found 1.5; expected an integer"]),
                            ((*ahead, "--time-filter-set", "before_filter=maybe"),
                             ["before_filter: found maybe; expected true or false"]),
                            ((*ahead, "--time-filter-set", "max_differnce_sigma=3"),
                             ["did you mean max_difference_sigma?"]),
                            (("--look-ahead", "4"), ["--time-filter"]),
                            ((*ahead, "--look-ahead", "-1"), ["found -1; must be in [0, 1000]"]),
                            (("--average", "6"), ["--average = 6", "contains 5 frames"])):
            self.refuse(self.arguments(*more), *words, code=2)
        set_by_key = self.decode(*ahead, "--time-filter-set", "look_ahead=4", output="set.npy")
        self.assertEqual((set_by_key["time_filter"], set_by_key["look_ahead"]), (8, 4))
        self.decode(*ahead, "--look-ahead", "4")
        self.assertEqual(self.bytes_of("set-2.npy"), self.bytes_of("d-2.npy"))

    def test_filtering_respects_its_memory_limit(self):
        self.sparse("raw.npy", (1, 480, 640, 3), "u2")
        self.refuse(self.arguments("--filter", "strong", "--memory-mb", "20"), "to be filtered",
                    "--memory-mb allows more")
        plain = self.peak_mb(*self.arguments(output="plain.npy"))
        peak = self.peak_mb(*self.arguments("--filter", "strong", "--memory-mb", "60"))
        self.assertLess(peak, plain + 60)

    def test_only_requested_outputs_are_written(self):
        self.record()
        document = self.decode("--outputs", "signal", "--stack")
        self.assertNotIn("status", document)
        self.assertEqual(document["stack"], {"signal": "d-signal.npy"})
        self.assertNotIn("d.npy", self.files())
        document = self.decode("--outputs", "signal,confidence", output="d.npz")
        self.assertNotIn("status", document["frames"][0])
        self.assertEqual(set(np.load(self.path("d-0.npz")).files), {"signal", "confidence"})

    def test_the_document_contains_counts_and_sums(self):
        raw = self.record()
        raw[1, :15, :, 0] = 0
        raw[1, :15, :, 1:] = 0
        np.save(self.path("raw.npy"), raw)
        document = self.decode()
        self.assertEqual((document["frame_count"], document["height"], document["width"]),
                         (3, 30, 40))
        self.assertEqual([f["frame"] for f in document["frames"]], [0, 1, 2])
        self.assertEqual([f["output"] for f in document["frames"]],
                         ["d-0.npy", "d-1.npy", "d-2.npy"])
        for key in ("seconds", "frames_per_s", "megapixels_per_s"):
            self.assertGreater(document[key], 0)

        counts = [f["status"].get("no_return", 0) for f in document["frames"]]
        self.assertGreater(counts[1], 0.45 * 30 * 40)
        self.assertEqual(document["status"]["no_return"], sum(counts))
        self.assertEqual(sum(document["status"].values()), 3 * 30 * 40)

    def test_many_frames_are_summarized(self):
        raw = self.record(frames=2)
        self.assertEqual(len(self.do(*self.arguments()).splitlines()), 4)
        np.save(self.path("raw.npy"), np.repeat(raw, 15, axis=0))
        lines = self.do(*self.arguments(output="m.npy")).splitlines()
        self.assertEqual(len(lines), 6)
        self.assertIn("m-00.npy", lines[0])
        self.assertIn("27 more, up to m-29.npy", lines[3])
        self.assertRegex(lines[4], r"^30 frames of 30 x 40 in .* frames/s, .* Mpixel/s: ok ")

    def test_memory_is_independent_of_the_file_size(self):
        raw = self.record(frames=1)
        # 6 GB, of which one frame contains data
        self.sparse("large.npy", (2000, 500, 1000, 3), "u2",
                    [((1500, slice(30), slice(40)), raw[0])])
        peak = self.peak_mb(*self.arguments("--frame", "1500", raw="large.npy"))
        self.assertLess(peak, MEMORY_LIMIT_MB)
        self.do(*self.arguments(output="plain.npy"))
        np.testing.assert_array_equal(np.load(self.path("d.npy"))[:30, :40],
                                      np.load(self.path("plain.npy")))

    def test_memory_is_independent_of_the_frame_size(self):
        self.sparse("large.npy", (3, 8000, 1000), "f8")
        peak = self.peak_mb(*self.arguments("--layout", "planar", raw="large.npy"))
        self.assertLess(peak, 150)  # the frame has 192 MB
        self.assertEqual(np.load(self.path("d.npy")).shape, (8000, 1000))

    def test_rejects_formats_that_need_unbounded_memory(self):
        raw = self.record()
        few = ("--memory-mb", "0.03")
        self.refuse(self.arguments(*few, output="d.npz"), "d.npz", "30 x 40", "0.03 MB",
                    "--memory-mb", "--stack")
        np.save(self.path("fortran.npy"), np.asfortranarray(raw))
        self.refuse(self.arguments(*few, raw="fortran.npy"), "Fortran", ".npy in C order")
        error = self.refuse(self.arguments("--memory-mb", "0.000001"), "--memory-mb")
        self.assertNotIn(".npy is written", error)
        for value in ("0", "nan"):
            self.refuse(self.arguments("--memory-mb", value), "--memory-mb",
                        f"found {value}; must be in (0, 1000000000]", code=2)

    def test_small_bands_of_ml_give_whole_frames(self):
        raw = np.full((3, 300, 600, 3), 1000, "u2")
        raw[..., 0] = 4000
        np.save(self.path("raw.npy"), raw)
        self.decode("--method", "ml", "--outputs", "depth,status", output="d.npz")
        for frame in range(3):
            depth = np.load(self.path(f"d-{frame}.npz"))["depth"]
            np.testing.assert_array_equal(depth, np.full((300, 600), depth[0, 0]))

    def test_stacks_are_npy(self):
        self.record()
        self.refuse(self.arguments("--stack", output="d.npz"), "--stack", ".npy", code=2)
        self.write("d-signal.npy", "old")
        self.refuse(self.arguments("--stack", "--outputs", "depth,signal"), "d-signal.npy",
                    "--force")
        self.refuse(self.arguments("--outputs", "depth,signal"), "--outputs", "--stack", code=2)


class Interrupts(CommandLineTest):
    """A long recording in a sparse file."""

    def start_long(self, *more):
        np.lib.format.open_memmap(self.path("raw.npy"), "w+", "u2", (3000, 600, 800, 3))
        return self.start("decode", "raw.npy", "--code", "hamiltonian-k3", "-o", "d.npy", *more)

    def test_finished_frames_are_kept_and_counted(self):
        process = self.start_long()
        self.wait_for("d-0002.npy")
        error = self.interrupted(process)
        self.assertTrue(error.endswith("tofsmith: interrupted\n"), error)
        done = [name for name in self.files() if name.startswith("d-")]
        self.assertIn(f"decoded {len(done)} of 3000 frames; their files are kept", error)
        for name in done:
            self.assertEqual(np.load(self.path(name)).shape, (600, 800))

    def test_no_partial_stack_is_left(self):
        process = self.start_long("--stack")
        while not [name for name in self.files() if ".tofsmith" in name]:
            time.sleep(0.05)
        error = self.interrupted(process)
        self.assertIn("with --stack, files are written only after all frames are decoded", error)
        self.assertTrue(error.endswith("tofsmith: interrupted\n"), error)
        self.assertEqual(self.files(), ["raw.npy"])

    def test_a_file_that_shrinks_causes_an_error(self):
        process = self.start_long()
        self.wait_for("d-0000.npy")
        os.truncate(self.path("raw.npy"), 600 * 800 * 3 * 2)
        out, error = (text.decode() for text in process.communicate(timeout=60))
        self.assertEqual((process.returncode, out), (1, ""), error)
        self.assertIn("the file ends here", error)
        self.assertIn("of 3000 frames", error)
        self.assertIn("d-0000.npy", self.files())

    def test_a_terminal_shows_rate_and_remaining_time(self):
        controller, terminal = pty.openpty()
        np.lib.format.open_memmap(self.path("raw.npy"), "w+", "u2", (3000, 600, 800, 3))
        process = subprocess.Popen([command_line.TOOL, "decode", "raw.npy", "--code",
                                    "hamiltonian-k3", "--camera", "paper-10f0", "-o", "d.npy",
                                    "--stack"],
                                   cwd=self.directory, stdout=subprocess.PIPE, stderr=terminal)
        os.close(terminal)
        drawn = b""
        while b" left" not in drawn:
            drawn += os.read(controller, 65536)
        process.send_signal(signal.SIGINT)
        try:
            while block := os.read(controller, 65536):
                drawn += block
        except OSError:  # the terminal is closed
            pass
        process.communicate(timeout=60)
        os.close(controller)
        self.assertRegex(drawn.decode(), r"decoding +\d+ %  frame \d+ of 3000, [\d.]+ frames/s, "
                                         r"[\d.]+ Mpixel/s, \d+ \w+ left")
        self.assertIn(b"\r" + b" " * 79 + b"\rtofsmith: decoded", drawn)


if __name__ == "__main__":
    unittest.main()
