# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""tofsmith simulate with many scenes: the files do not depend on order, shards or interruptions."""

import json
import os
import time
import unittest

import numpy as np

from command_line import CommandLineTest

CODE = ("--code", "hamiltonian-k3", "--set", "samples=60")


class Datasets(CommandLineTest):
    def make_scenes(self, count=5, height=6):
        os.makedirs(self.path("scenes/sub"), exist_ok=True)
        for i in range(count):
            folder = "scenes/sub" if i % 2 else "scenes"
            np.save(self.path(f"{folder}/{i:03}.npy"), np.full((height, 8), 1.0 + i, np.float32))

    def simulate(self, output, *inputs):
        return self.do_json("simulate", *(inputs or ("scenes",)), *CODE, "-o", output)

    def content(self, folder):
        return {os.path.relpath(name, folder): self.bytes_of(name) for name in self.files()
                if name.startswith(folder + "/") and os.path.isfile(self.path(name))}

    def test_an_invalid_file_is_reported_without_affecting_others(self):
        self.make_scenes(3)
        self.write("scenes/broken.npy", "no array")
        code, _, error = self.run_tool("simulate", "scenes", *CODE, "-o", "set")
        self.assertEqual(code, 1)
        self.assertIn("1 of 4 scenes failed", error)
        self.assertIn("broken.npy", error)
        index = json.loads(self.bytes_of("set/index.json"))
        self.assertEqual(len(index["scenes"]), 3)
        self.assertEqual(index["failures"][0]["name"], "broken.npy")

    def test_an_interrupted_run_keeps_finished_frames(self):
        self.make_scenes(200, height=800)
        process = self.start("simulate", "scenes", *CODE, "-o", "set")
        while not any(name.endswith(".json") for name in self.files()):
            time.sleep(0.02)
            self.assertIsNone(process.poll())
        self.assertIn("finished files are kept in set", self.interrupted(process))
        kept = sum(name.endswith(".json") for name in self.content("set"))
        self.assertLess(kept, 200)
        document = self.simulate("set")
        self.assertEqual((document["written"], document["kept"]), (200 - kept, kept))

    def test_rejects_incompatible_options(self):
        self.make_scenes(2)
        np.save(self.path("one.npy"), np.ones((4, 4), np.float32))
        for arguments, words in (
                (["scenes", "--truth", "t.npy"], ["--truth"]),
                (["scenes", "--signal-range", "5"], ["--signal-range: found 5", "1e3:1e5"]),
                (["scenes", "--signal-range", "5:1"], ["--signal-range"]),
                (["scenes", "--signal-range", "1:5", "--signal", "3"], ["--signal-range"]),
                (["scenes", "--shard", "3/2"], ["--shard: found 3/2"]),
                (["one.npy", "--shard", "1/2"], ["--shard", "a folder"]),
                (["one.npy", "--ambient-range", "1:2"], ["--ambient-range", "a folder"]),
        ):
            self.refuse(["simulate", *arguments, *CODE, "-o", "out"], *words, code=2)


if __name__ == "__main__":
    unittest.main()
