# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Every command that writes works with little memory, few files, a small stack, and without home
folder, temporary folder and a writable root."""

import os
import resource
import shutil
import signal
import subprocess
import tempfile
import unittest

from command_line import TOOL
from writing_commands import COMMANDS, make_inputs

MB = 2**20
LIMITS = {
    resource.RLIMIT_DATA: 300 * MB,  # allocated memory, not reserved addresses
    resource.RLIMIT_NOFILE: 32,
    resource.RLIMIT_STACK: 256 * 1024,
    resource.RLIMIT_CORE: 0,
}
BARE = {"PATH": "/usr/bin:/bin", "TMPDIR": "/nonexistent"}
QUICK = [command for command in COMMANDS if not command.is_slow]


def limited(limits):
    def limit():
        for kind, value in limits.items():
            resource.setrlimit(kind, (value, value))
    return limit


class Limits(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.work = tempfile.mkdtemp(prefix="tofsmith-test-")
        cls.addClassCleanup(shutil.rmtree, cls.work)
        cls.inputs = os.path.join(cls.work, "inputs")
        os.mkdir(cls.inputs)
        make_inputs(TOOL, cls.inputs)

    def setUp(self):
        self.directory = os.path.join(self.work, self.id())
        shutil.copytree(self.inputs, self.directory)

    def run_bare(self, arguments, limits, before=()):
        return subprocess.run([*before, TOOL, "--quiet", *arguments], cwd=self.directory, env=BARE,
                              preexec_fn=limited(limits), capture_output=True, text=True,
                              errors="replace", timeout=60, check=False)

    def test_all_limits_at_once(self):
        for command in QUICK:
            with self.subTest(command=command.name):
                done = self.run_bare([*command.arguments, "--force"], LIMITS)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                for name in command.outputs:
                    self.assertTrue(os.path.exists(os.path.join(self.directory, name)), name)

    def test_a_read_only_root(self):
        mounts = ["unshare", "--mount", "sh", "-c",
                  'mount --bind "$PWD" "$PWD" && mount -o remount,bind,ro / && cd "$PWD" && exec "$@"',
                  "sh"]
        if subprocess.run([*mounts, "true"], cwd=self.directory, capture_output=True,
                          check=False).returncode != 0:
            self.skipTest("needs root, to mount the root read-only")
        probe = subprocess.run([*mounts, "touch", "/tmp/.written"], cwd=self.directory,
                               capture_output=True, check=False)
        self.assertNotEqual(probe.returncode, 0)
        for command in QUICK:
            with self.subTest(command=command.name):
                done = self.run_bare([*command.arguments, "--force"], {}, mounts)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
        away = self.run_bare(["codes", "sinusoid-k4", "-o", "/c.npz"], {}, mounts)
        self.assertEqual(away.returncode, 1)
        self.assertRegex(away.stderr, r"^tofsmith: /c.npz: .*Read-only file system\n$")

    def test_insufficient_memory_is_reported(self):
        for megabytes in (16, 20, 24):
            done = self.run_bare(["simulate", "table-top", "--code", "sinusoid-k4", "--width",
                                  "1600", "--height", "1200", "-o", "raw.npy"],
                                 {resource.RLIMIT_DATA: megabytes * MB, resource.RLIMIT_CORE: 0})
            self.assertEqual((done.returncode, done.stderr), (1, "tofsmith: out of memory\n"))
            self.assertFalse(os.path.exists(os.path.join(self.directory, "raw.npy")))

    def test_a_file_size_limit_is_reported(self):
        done = self.run_bare(["codes", "sinusoid-k4", "-o", "c.html"],
                             {resource.RLIMIT_FSIZE: 100_000})
        self.assertEqual(done.returncode, 1)
        self.assertIn("c.html: cannot write: File too large", done.stderr)
        self.assertNotEqual(done.returncode, -signal.SIGXFSZ)
        self.assertEqual(set(os.listdir(self.directory)), set(os.listdir(self.inputs)))


if __name__ == "__main__":
    unittest.main()
