# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""tofsmith sweep under mpirun: any number of ranks gives the same bytes, a dead one loses nothing.

ranks_test.py TOOL [MPIRUN]; without MPIRUN the tool was built without MPI."""

import os
import random
import signal
import subprocess
import sys
import time
import unittest

from command_line import TOOL, CommandLineTest
from sweep_text import ITEMS, sweep_text

MPIRUN = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else None

SWEEP = sweep_text(4000)
LONG = sweep_text(100_000_000)  # must not end before it is killed


class RanksTest(CommandLineTest):
    def setUp(self):
        super().setUp()
        self.write("s.toml", SWEEP)

    def ranks(self, count, *arguments):
        """A job of so many ranks, with the ids of its processes. Tests may be root, and there may
        be fewer cores; the MPI library's own leaks are no concern of ours."""
        return subprocess.Popen(
            [MPIRUN, "--allow-run-as-root", "--oversubscribe", "-n", str(count), TOOL,
             "--quiet", *arguments],
            cwd=self.directory, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            env=self.environment())

    @staticmethod
    def environment():
        """Open MPI 5 complains about TCP on a machine without a network; ranks of one machine share
        memory."""
        options = os.environ.get("ASAN_OPTIONS", "")
        return {**os.environ, "ASAN_OPTIONS": options + ":detect_leaks=0", "OMPI_MCA_btl": "^tcp"}

    def finish(self, job, code=0):
        out, error = job.communicate(timeout=120)
        self.assertEqual(job.returncode, code, error)
        return out.decode(), error.decode()

    def export(self, store, *more):
        self.do("sweep", "s.toml", "--store", store, "--export", store + ".json", "--force", *more)
        return self.bytes_of(store + ".json")

    def status(self, store):
        return self.do_json("sweep", "s.toml", "--store", store, "--status")


@unittest.skipIf(MPIRUN is None, "built without MPI")
class Ranks(RanksTest):
    def test_any_number_of_ranks_gives_the_same_bytes(self):
        whole = self.export("alone.sqlite")
        for count in (1, 2, 4):
            store = f"{count}.sqlite"
            out, error = self.finish(self.ranks(count, "sweep", "s.toml", "--store", store,
                                                "--threads", "1"))
            self.assertEqual(error, "")
            self.assertEqual(out.count("\n"), 1)  # rank 0 alone speaks
            self.assertIn(f"{ITEMS} items: {ITEMS} finished", out)
            self.assertEqual(self.export(store, "--status"), whole)

    def processes_of(self, job):
        """The ranks by number: the children of mpirun."""
        found = {}
        for name in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open(f"/proc/{name}/stat", encoding="utf-8", errors="replace") as file:
                    parent = file.read().rsplit(")", 1)[1].split()[1]
                if int(parent) != job.pid:
                    continue
                with open(f"/proc/{name}/environ", "rb") as file:
                    variables = dict(v.split(b"=", 1) for v in file.read().split(b"\0") if b"=" in v)
                if b"OMPI_COMM_WORLD_RANK" in variables:
                    found[int(variables[b"OMPI_COMM_WORLD_RANK"])] = int(name)
            except (FileNotFoundError, ProcessLookupError, PermissionError):
                pass
        return found

    def start_long(self, store):
        """A job of three ranks that is in the midst of its work."""
        self.write("s.toml", LONG)
        job = self.ranks(3, "sweep", "s.toml", "--store", store, "--threads", "1")
        for _ in range(1200):
            self.assertIsNone(job.poll(), job.stderr.read() if job.poll() is not None else "")
            if os.path.exists(self.path(store)):
                code, out, _ = self.run_tool("sweep", "s.toml", "--store", store, "--status")
                if code == 0 and b" running" in out:
                    return job
            time.sleep(0.05)
        self.fail("the sweep did not start")

    def test_one_rank_merges(self):
        for part in "12":
            self.do("sweep", "s.toml", "--store", part + ".sqlite", "--shard", part + "/2")
        out, error = self.finish(
            self.ranks(3, "sweep", "merge", "all.sqlite", "1.sqlite", "2.sqlite"))
        self.assertEqual((out.count("merged"), error), (1, ""))
        self.assertEqual(self.status("all.sqlite")["finished"], ITEMS)

    def test_a_dead_rank_ends_the_job_and_loses_only_unfinished_items(self):
        for rank in (0, 2):
            store = f"killed{rank}.sqlite"
            job = self.start_long(store)
            time.sleep(random.uniform(0.0, 0.3))
            os.kill(self.processes_of(job)[rank], signal.SIGKILL)
            job.communicate(timeout=60)
            self.assertNotEqual(job.returncode, 0)
            finished = self.status(store)["finished"]
            self.assertLess(finished, ITEMS)
            self.write("s.toml", sweep_text(2000))  # others: quick to compute
            out, _ = self.finish(self.ranks(2, "sweep", "s.toml", "--store", store))
            self.assertIn(f"{ITEMS} finished", out)
            self.write("s.toml", LONG)
            self.assertEqual(self.status(store)["finished"], finished)

    def test_resumes_to_the_bytes_of_an_uninterrupted_run(self):
        self.write("s.toml", sweep_text(100000))
        whole = self.export("whole.sqlite")
        job = self.ranks(3, "sweep", "s.toml", "--store", "s.sqlite", "--threads", "1")
        for _ in range(1200):
            if job.poll() is not None or os.path.exists(self.path("s.sqlite")):
                break
            time.sleep(0.02)
        time.sleep(random.uniform(0.0, 0.2))
        found = self.processes_of(job)
        if found:
            os.kill(found[max(found)], signal.SIGKILL)
        job.communicate(timeout=60)
        out, error = self.finish(self.ranks(2, "sweep", "s.toml", "--store", "s.sqlite"))
        self.assertIn(f"{ITEMS} finished", out, error)
        self.assertEqual(self.export("s.sqlite", "--status"), whole)

    def test_an_interrupt_of_any_rank_ends_the_job_cleanly(self):
        for rank in (0, 1):
            store = f"interrupted{rank}.sqlite"
            job = self.start_long(store)
            os.kill(self.processes_of(job)[rank], signal.SIGTERM)
            _, error = job.communicate(timeout=60)
            self.assertIn(f"tofsmith: interrupted; finished items are kept in {store}, and the same "
                          "command goes on from there\n", error.decode())
            self.assertEqual(self.status(store)["running"], 0)

    def test_what_fails_on_rank_0_is_reported_once(self):
        _, error = self.finish(self.ranks(3, "sweep", "none.toml", "--store", "s.sqlite"), code=1)
        self.assertEqual(error.count("tofsmith: none.toml: there is no such file"), 1)

    def test_ranks_of_other_instruction_sets_are_refused(self):
        # One program for all ranks: the mpirun of Debian 13 (Open MPI 5) crashes on several.
        script = f"""[ "$OMPI_COMM_WORLD_RANK" = 0 ] || export TOFSMITH_TARGET=SCALAR
            exec {TOOL} sweep s.toml --store s"""
        job = subprocess.Popen(
            [MPIRUN, "--allow-run-as-root", "--oversubscribe", "-n", "2", "sh", "-c", script],
            cwd=self.directory, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            env=self.environment())
        _, error = self.finish(job, code=1)
        self.assertRegex(error, r"tofsmith: rank 1 on \S+ uses SCALAR, and rank 0 on \S+ uses ")
        self.assertIn("TOFSMITH_TARGET", error)
        self.assertEqual(self.files(), ["s.toml"])


@unittest.skipIf(MPIRUN is not None, "built with MPI")
class WithoutMpi(RanksTest):
    def test_several_processes_are_refused(self):
        code, _, error = self.run_tool("sweep", "s.toml", "--store", "s.sqlite",
                                       env={**os.environ, "OMPI_COMM_WORLD_SIZE": "2"})
        self.assertEqual(code, 1)
        self.assertIn("built without MPI", error)
        self.assertIn("--shard i/n", error)
        self.do("sweep", "s.toml", "--store", "s.sqlite",
                env={**os.environ, "OMPI_COMM_WORLD_SIZE": "1"})


if __name__ == "__main__":
    unittest.main()
