# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""tofsmith sweep keeps finished items after kills, full disks and concurrent runs.

    sweep_test.py TOOL [--kills N]     kills N times at random moments instead of a few times
"""

import io
import json
import os
import random
import sqlite3
import sys
import time
import unittest

import numpy as np

from command_line import CommandLineTest
from sweep_text import sweep_text

KILLS = 6
NOBODY = 65534

SWEEP = sweep_text(400)


class Sweep(CommandLineTest):
    def setUp(self):
        super().setUp()
        self.write("s.toml", SWEEP)

    def sweep(self, store, *more):
        return self.do_json("sweep", "s.toml", "--store", store, *more)

    def export(self, store, *more):
        self.do("sweep", "s.toml", "--store", store, "--export", store + ".json", "--force", *more)
        return self.bytes_of(store + ".json")

    def check_integrity(self, store):
        if os.path.exists(self.path(store)):
            connection = sqlite3.connect(self.path(store))
            try:
                self.assertEqual(connection.execute("PRAGMA integrity_check").fetchone(), ("ok",))
            finally:
                connection.close()

    def test_computes_stores_exports_and_reports(self):
        document = self.sweep("s.sqlite", "--export", "s.csv", "--export", "s.json", "--export",
                              "s.npz", "--report", "s.html")
        self.assertEqual((document["items"], document["finished"], document["computed"]),
                         (20, 20, 20))
        self.assertEqual(self.files(), ["s.csv", "s.html", "s.json", "s.npz", "s.sqlite", "s.toml"])
        table = np.genfromtxt(io.BytesIO(self.bytes_of("s.csv")), delimiter=",", names=True,
                              deletechars="", dtype=None, encoding="utf-8")
        exported = json.loads(self.bytes_of("s.json"))["codes"]
        arrays = np.load(self.path("s.npz"))
        np.testing.assert_array_equal(arrays["receiver_bound_mae_m"],
                                      table["receiver_bound_mae_m"])
        names = arrays["code_names"]
        codes = names.view(f"S{names.shape[1]}").ravel()[arrays["code_index"]]
        self.assertEqual([c.decode() for c in codes], list(table["code"]))
        for column in ("linear_mde_m", "circular_se_m", "cramer_rao_mae_m", "signal_e_per_s"):
            self.assertEqual(list(arrays[column]), list(table[column]), column)
            self.assertEqual(list(arrays[column]), [e["points"][0][column] for e in exported])
        self.assertEqual(list(arrays["light.peak_factor"]),
                         [e["settings"]["light.peak_factor"] for e in exported])
        self.assertIn(b"Depth error over light.peak_factor", self.bytes_of("s.html"))

        again = self.sweep("s.sqlite")
        self.assertEqual((again["finished"], again["computed"]), (20, 0))
        self.write("s.toml", SWEEP.replace("[12, 15]", "[12, 13, 15]"))
        status = self.sweep("s.sqlite", "--status")
        self.assertEqual((status["finished"], status["pending"], status["computed"]), (20, 10, 0))
        self.assertEqual(self.sweep("s.sqlite")["computed"], 10)
        self.assertEqual(self.export("s.sqlite"), self.export("new.sqlite"))

    def test_shards_merge_to_the_whole(self):
        computed = [self.sweep(f"{i}.sqlite", "--shard", f"{i}/3")["computed"] for i in (1, 2, 3)]
        self.assertEqual(sum(computed), 20)
        self.do("sweep", "merge", "all.sqlite", "3.sqlite", "1.sqlite", "2.sqlite")
        self.assertEqual(self.export("all.sqlite", "--status"), self.export("new.sqlite"))
        self.refuse(["sweep", "merge", "all.sqlite", "1.sqlite"], "all.sqlite")
        self.refuse(["sweep", "merge", "none.sqlite", "nowhere.sqlite"], "there is no such store")

    def test_a_kill_at_any_moment_loses_only_unfinished_items(self):
        self.write("s.toml", sweep_text(4000))
        whole = self.export("whole.sqlite")
        rounds, kills = 0, 0
        while kills < KILLS:
            rounds += 1
            store = f"killed{rounds}.sqlite"
            finished = 0
            while kills < KILLS:
                process = self.start("sweep", "s.toml", "--store", store)
                time.sleep(random.uniform(0.0, 0.4))
                process.kill()
                process.communicate()
                if process.returncode == 0:
                    break  # the run had already ended
                kills += 1
                if os.path.exists(self.path(store)) and os.path.getsize(self.path(store)) > 0:
                    self.check_integrity(store)
                    code, out, _ = self.run_tool("sweep", "s.toml", "--store", store, "--status",
                                                 "--json")
                    if code == 0:  # killed during its creation, it is not a store yet
                        now = json.loads(out)["finished"]
                        self.assertGreaterEqual(now, finished)
                        finished = now
            self.assertEqual(self.export(store), whole)
            self.check_integrity(store)
            self.assertFalse([name for name in self.files() if "-wal" in name])
        if kills > 6:
            print(f"{kills} kills of {rounds} sweeps", file=sys.stderr)

    def test_an_interrupted_run_keeps_finished_items(self):
        self.write("s.toml", sweep_text(100_000_000))
        process = self.start("sweep", "s.toml", "--store", "s.sqlite")
        self.wait_for("s.sqlite")
        time.sleep(0.3)
        self.assertEqual(self.interrupted(process),
                         "tofsmith: interrupted; finished items are kept in s.sqlite, and the same "
                         "command resumes from there\n")
        self.assertEqual(self.sweep("s.sqlite", "--status")["running"], 0)

    def as_reader(self):
        """Returns the options of a process without write access."""
        os.chmod(self.directory, 0o555)
        self.addCleanup(os.chmod, self.directory, 0o755)
        options = {"user": NOBODY, "group": NOBODY, "extra_groups": []} if os.getuid() == 0 else {}
        try:
            self.run_tool("--version", **options)
        except (OSError, PermissionError):
            self.skipTest("a user who may write nothing here cannot run the tool")
        return options

    def test_a_read_only_store_can_be_read(self):
        whole = self.export("s.sqlite")
        self.sweep("s.sqlite")
        # A killed process leaves its log next to the store.
        writer = sqlite3.connect(self.path("log.sqlite"))
        self.sweep("log.sqlite")
        writer.execute("SELECT count(*) FROM items").fetchone()  # the log stays while it is open
        self.write("s.toml", SWEEP.replace("[12, 15]", "[12, 13, 15]"))
        self.sweep("log.sqlite")
        self.assertIn("log.sqlite-wal", self.files())
        for name in ("log.sqlite", "log.sqlite-wal"):
            self.write("left-" + name, self.bytes_of(name))
        writer.close()
        reader = self.as_reader()
        for store, finished in (("s.sqlite", 20), ("left-log.sqlite", 30)):
            code, out, error = self.run_tool("sweep", "s.toml", "--store", store, "--status",
                                             "--json", **reader)
            self.assertEqual((code, error), (0, ""))
            self.assertEqual(json.loads(out)["finished"], finished)
        code, _, error = self.run_tool("sweep", "s.toml", "--store", "s.sqlite", **reader)
        self.assertEqual(code, 1)
        self.assertIn("--status", error)
        os.chmod(self.directory, 0o755)
        self.write("s.toml", SWEEP)
        self.assertEqual(self.export("s.sqlite"), whole)

    def test_rejects_invalid_requests(self):
        store = ["--store", "s.sqlite"]
        for arguments, words in (
                ([], ["SWEEP is required"]),
                (["s.toml"], ["--store is required"]),
                (["s.toml", *store, "--shard", "4/3"], ["--shard: found 4/3", "3/8"]),
                (["s.toml", *store, "--shard", "x"], ["--shard: found x"]),
                (["s.toml", *store, "--export", "x.xls"], ["x.xls", ".csv, .json or .npz"]),
                (["s.toml", *store, "--report", "x.pdf"], ["x.pdf", ".html"]),
                (["s.toml", *store, "--sttus"], ["did you mean --status?"]),
                (["merge"], ["OUT"]),
        ):
            self.refuse(["sweep", *arguments], *words, code=2)
        for arguments, words in (
                (["none.toml", *store], ["none.toml"]),
                (["s.toml", "--store", "s.toml"], ["s.toml", "is not an SQLite file"]),
                (["s.toml", *store, "--status"], ["s.sqlite", "there is no such store"]),
                (["s.toml", *store, "--export", "no/x.csv"], ["no"]),
        ):
            self.refuse(["sweep", *arguments], *words)
        self.write("big.toml", SWEEP.replace("count = 5", "count = 900000").replace(
            "[12, 15]", "[12, 13, 14, 15, 16, 17]"))
        self.refuse(["sweep", "big.toml", *store], "1.08e+07 items", "--yes", code=2)

    def test_a_store_requires_its_instruction_set(self):
        self.sweep("s.sqlite")
        environment = {**os.environ, "TOFSMITH_TARGET": "SCALAR"}
        code, _, error = self.run_tool("sweep", "s.toml", "--store", "s.sqlite", env=environment)
        self.assertEqual(code, 1)
        self.assertIn("this process uses SCALAR", error)
        self.do("sweep", "s.toml", "--store", "scalar.sqlite", env=environment)
        environment["TOFSMITH_TARGET"] = "ABACUS"
        code, _, error = self.run_tool("codes", env=environment)
        self.assertEqual(code, 2)
        self.assertIn("TOFSMITH_TARGET: dispatch target = ABACUS; must be", error)


if __name__ == "__main__":
    if "--kills" in sys.argv:
        at = sys.argv.index("--kills")
        KILLS = int(sys.argv[at + 1])
        del sys.argv[at:at + 2]
    unittest.main()
