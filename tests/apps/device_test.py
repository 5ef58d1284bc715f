# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""`decode --device` writes the same files; drivers are loaded on request only."""

import json
import os
import signal
import subprocess
import unittest

import command_line
from command_line import CommandLineTest


def devices():
    """Returns the OpenCL devices; an empty list if tofsmith was built without OpenCL."""
    listed = subprocess.run([command_line.TOOL, "decode", "--device", "list", "--json"],
                            capture_output=True, text=True)
    return json.loads(listed.stdout)["devices"] if listed.returncode == 0 else []


DEVICES = devices()
needs_device = unittest.skipUnless(DEVICES, "OpenCL finds no device: install pocl-opencl-icd")


def is_pocl():
    return "Portable" in DEVICES[0]["platform"]


class Device(CommandLineTest):
    def setUp(self):
        super().setUp()
        self.do("simulate", "table-top", "--code", "hamiltonian-k4", "--signal", "1e5", "--frames",
                "2", "-o", "raw.npy")

    def decode(self, device, *more, **options):
        return self.run_tool("decode", "raw.npy", "--code", "hamiltonian-k4", "--device", device,
                             *more, **options)

    def refusal(self, device, *more, code=1, **options):
        before = self.files()
        status, out, error = self.decode(device, *more, "-o", "d.npz", **options)
        self.assertEqual((status, out), (code, b""), error)
        self.assertEqual(self.files(), before)
        return error

    @needs_device
    def test_a_device_writes_the_same_files_as_the_cpu(self):
        # See tests/gpu/device_test.cpp for further combinations.
        for more in (("--average", "2", "--averaged", "3", "--memory-mb", "4"),
                     ("--filter", "strong", "--time-filter", "2", "--outputs", "averaged,bin"),
                     ("--average", "2", "--time-filter", "9", "--mixed", "label"),
                     # Time filters with look-ahead run on the CPU.
                     ("--time-filter", "9", "--look-ahead", "8", "--filter", "light")):
            for device in ("cpu", "auto", "0"):
                code, _, error = self.decode(device, *more, "-o", device + ".npz", "--force")
                self.assertEqual((code, error), (0, ""))
            frames = ("",) if "--average" in more else ("-0", "-1")
            for frame in frames:
                expected = self.bytes_of(f"cpu{frame}.npz")
                self.assertEqual(self.bytes_of(f"auto{frame}.npz"), expected)
                if DEVICES[0]["doubles"]:
                    self.assertEqual(self.bytes_of(f"0{frame}.npz"), expected, more)

    @needs_device
    def test_reports_the_device_used(self):
        code, out, _ = self.decode("0", "-o", "d.npz")
        self.assertEqual(code, 0)
        self.assertIn("device " + DEVICES[0]["name"], out.decode())
        code, out, _ = self.decode("0", "-o", "e.npz", "--json")
        self.assertEqual(json.loads(out)["device"], DEVICES[0]["name"])

    @needs_device
    def test_lists_devices_without_a_recording(self):
        self.assertIn("0  " + DEVICES[0]["name"], self.do("decode", "--device", "list"))

    @needs_device
    def test_drivers_are_loaded_only_if_a_device_is_requested(self):
        def loaded(device):
            error = self.decode(device, "-o", "d.npz", "--force",
                                env=dict(os.environ, LD_DEBUG="files"))[2]
            self.assertIn("libOpenCL", error)
            return "libpocl" in error or "libnvidia-opencl" in error or "Rusticl" in error

        self.assertFalse(loaded("cpu"))
        if is_pocl():
            self.assertTrue(loaded("0"))

    @needs_device
    def test_unknown_devices_are_rejected_with_the_known_ones(self):
        for name in ("7000", "no such"):
            self.assertIn("0 " + DEVICES[0]["name"], self.refusal(name))

    @needs_device
    def test_other_methods_are_rejected_on_a_device_and_decoded_by_auto(self):
        self.assertIn("zncc", self.refusal("0", "--method", "ml", code=2))
        self.assertEqual(self.decode("auto", "--method", "ml", "-o", "d.npz")[0], 0)

    @needs_device
    def test_a_driver_without_a_kernel_cache_is_rejected(self):
        if not is_pocl():
            self.skipTest("the driver keeps kernels elsewhere")
        self.write("file", "")
        for folder in (self.path("file/folder"), "/proc/none"):  # invalid also for root
            environment = dict(os.environ, POCL_CACHE_DIR=folder)
            self.assertIn("POCL_CACHE_DIR", self.refusal("0", env=environment))

    @needs_device
    def test_damaged_cached_kernels_never_give_wrong_results(self):
        """For some damage pocl returns an error, for other damage it ends the program."""
        if not is_pocl():
            self.skipTest("the driver keeps kernels elsewhere")
        os.mkdir(self.path("kernels"))
        environment = dict(os.environ, POCL_CACHE_DIR=self.path("kernels"))
        more = ("--stack", "-o", "a.npy", "--force")
        self.assertEqual(self.decode("0", *more, env=environment)[0], 0)
        expected = self.bytes_of("a.npy")
        kept = [name for name in self.files() if name.startswith("kernels/") and
                os.path.isfile(self.path(name))]
        self.assertGreater(len(kept), 1)
        for damage in (b"", b"not a kernel" * 100):
            for name in kept:
                self.write(name, damage)
            code = self.decode("0", *more, env=environment)[0]
            self.assertIn(code, (0, 1, -signal.SIGABRT))
            self.assertEqual(self.bytes_of("a.npy"), expected)
        self.assertEqual([name for name in self.files() if not name.startswith("kernels")],
                         ["a.npy", "raw.camera.toml", "raw.code.json", "raw.npy"])

    @needs_device
    def test_processes_share_a_device(self):
        more = ("--filter", "normal", "--frame", "0")
        self.assertEqual(self.decode("cpu", *more, "-o", "cpu.npz")[0], 0)
        started = [self.start("decode", "raw.npy", "--code", "hamiltonian-k4", "--device", "0", *more,
                              "-o", f"{i}.npz") for i in range(3)]
        for i, process in enumerate(started):
            self.assertEqual(process.communicate(timeout=60)[1], b"")
            self.assertEqual(process.returncode, 0)
            if DEVICES[0]["doubles"]:
                self.assertEqual(self.bytes_of(f"{i}.npz"), self.bytes_of("cpu.npz"))

    def test_without_drivers_devices_are_rejected_and_auto_uses_the_cpu(self):
        os.mkdir(self.path("none"))
        environment = dict(os.environ, OCL_ICD_VENDORS=self.path("none"))
        self.assertIn("OpenCL", self.refusal("gpu", env=environment))
        self.assertEqual(self.decode("auto", "-o", "d.npz", env=environment)[0], 0)


if __name__ == "__main__":
    unittest.main()
