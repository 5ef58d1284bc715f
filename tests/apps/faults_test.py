# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""A fixed sample of the faults in faults.py, for every command that writes. See scripts/faults.sh
for the complete test, which takes long."""

import os
import random
import signal
import sys
import tempfile
import unittest

SHIM = os.path.abspath(sys.argv.pop(2))
from command_line import TOOL  # noqa: E402  reads the other argument
from faults import DISK, Rig, each_fault  # noqa: E402
from writing_commands import COMMANDS  # noqa: E402

QUICK = [command for command in COMMANDS if not command.is_slow]


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        work = tempfile.TemporaryDirectory(prefix="tofsmith-test-")
        cls.addClassCleanup(work.cleanup)
        cls.rig = Rig(TOOL, SHIM, work.name)

    def test_a_failed_call_leaves_no_partial_files(self):
        for i, command in enumerate(QUICK):
            rng = random.Random(i)
            faults = list(each_fault(self.rig, command, rng, 40))
            chosen = rng.sample([f for f in faults if f[0] in DISK], 1)
            if i % 6 == 0:
                chosen.append(rng.choice([f for f in faults if f[0] == "malloc"]))
            for fault in chosen:
                with self.subTest(command=command.name, fault=fault):
                    self.rig.fail(command, *fault)

    def test_a_kill_leaves_no_partial_files(self):
        for i, command in enumerate(QUICK[::4]):
            rng = random.Random(i)
            call = rng.choice(("write", "sync", "rename"))
            at = rng.randint(1, max(self.rig.clean(command)[2][call], 1))
            with self.subTest(command=command.name, call=call, at=at):
                self.rig.kill(command, call, at)

    def test_missing_outputs_are_completed(self):
        for command in QUICK:
            renames = self.rig.clean(command)[2]["rename"]
            for at in range(2, min(renames, 5) + 1):
                with self.subTest(command=command.name, at=at):
                    self.rig.kill(command, "rename", at)

    def test_two_processes_can_use_one_output(self):
        for command in QUICK[::8]:
            with self.subTest(command=command.name):
                self.rig.two_at_once(command)

    def test_a_jumping_clock_changes_nothing(self):
        for command in QUICK[3::10]:
            with self.subTest(command=command.name):
                self.rig.jump_clock(command)

    def test_signals_leave_no_partial_files(self):
        rng = random.Random(1)
        for command, number in zip(QUICK[::7], (signal.SIGTERM, signal.SIGINT, signal.SIGHUP,
                                                signal.SIGKILL)):
            after = rng.uniform(0, self.rig.clean(command)[3])
            with self.subTest(command=command.name, signal=number, after=after):
                self.rig.signal_after(command, number, after)


if __name__ == "__main__":
    unittest.main()
