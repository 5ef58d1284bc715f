#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Memory and throughput of long runs: a recording larger than memory, a sweep with many items, an
endless stream.

    load.py TOFSMITH recording [--gb 8] [--mb 512]     decoded with a memory limit
    load.py TOFSMITH sweep [--items 1e6]
    load.py TOFSMITH stream [--minutes 10]

Memory is the resident set; rates use wall-clock time on an idle machine. Exits with 1 if the halves
of a run differ by more than 10 % in memory or 25 % in rate.
"""

import argparse
import os
import resource
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time

import numpy as np

from pipe_latency import DESCRIPTION, HEIGHT, MEASUREMENTS, WIDTH, frame

CODE = ("--code", "sinusoid-k4", "--set", "fundamental_frequency_hz=15e6")


class Watched:
    """A process with samples of time, completed work and resident memory."""

    def __init__(self, command, done, limit_mb=None, period_s=2.0, **streams):
        def limit():
            if limit_mb:
                size = int(limit_mb * 2**20)
                resource.setrlimit(resource.RLIMIT_DATA, (size, size))

        self.done, self.period_s, self.samples = done, period_s, []
        self.begin = time.monotonic()
        self.process = subprocess.Popen(command, preexec_fn=limit, **streams)
        self.watcher = threading.Thread(target=self.watch, daemon=True)
        self.watcher.start()

    def resident_mb(self):
        with open(f"/proc/{self.process.pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20

    def watch(self):
        while self.process.returncode is None:
            try:
                self.samples.append((time.monotonic() - self.begin, self.done(),
                                     self.resident_mb()))
            except (OSError, IndexError, sqlite3.Error):
                pass  # not started yet, or already finished
            time.sleep(self.period_s)

    def finish(self):
        """Waits for the end. @return exit code, seconds and peak memory [MB]"""
        _, status, usage = os.wait4(self.process.pid, 0)
        self.process.returncode = os.waitstatus_to_exitcode(status)
        seconds = time.monotonic() - self.begin
        self.watcher.join()
        return self.process.returncode, seconds, usage.ru_maxrss / 1024


def halves(samples, unit):
    """Prints memory and rate of each tenth. @return True if both halves agree"""
    at = np.array([s for s in samples if s[2] > 0])[1:]
    if len(at) < 8:
        print("too short to say how it goes on")
        return True
    print(f"{'seconds':>8} {unit:>12} {'per second':>11} {'resident MB':>12}")
    for part in np.array_split(np.arange(len(at)), min(10, len(at) // 2)):
        begin, end = at[max(part[0] - 1, 0)], at[part[-1]]
        rate = (end[1] - begin[1]) / (end[0] - begin[0])
        print(f"{end[0]:8.0f} {end[1]:12.0f} {rate:11.1f} {end[2]:12.1f}")
    middle = len(at) // 2
    rates = [(h[-1, 1] - h[0, 1]) / (h[-1, 0] - h[0, 0]) for h in (at[:middle + 1], at[middle:])]
    memory = [h[:, 2].max() for h in (at[1:middle + 1], at[middle:])]
    print(f"second half over first: rate {rates[1] / rates[0]:.3f}, most memory "
          f"{memory[1] / memory[0]:.3f}")
    return abs(rates[1] / rates[0] - 1) < 0.25 and memory[1] / memory[0] < 1.1


def recording(tool, arguments, work):
    bytes_of_frame = frame()
    frames = max(int(arguments.gb * 1e9 / len(bytes_of_frame)), 1)
    path = os.path.join(work, "long.npy")
    header = np.lib.format.header_data_from_array_1_0(
        np.zeros((1, HEIGHT, WIDTH, MEASUREMENTS), "<u2"))
    header["shape"] = (frames, HEIGHT, WIDTH, MEASUREMENTS)
    planes = np.frombuffer(bytes_of_frame, "<u2").reshape(MEASUREMENTS, HEIGHT, WIDTH)
    pixels = np.ascontiguousarray(planes.transpose(1, 2, 0)).tobytes()
    with open(path, "wb") as file:
        np.lib.format.write_array_header_1_0(file, header)
        for _ in range(frames):
            file.write(pixels)
    out = os.path.join(work, "depth.npy")

    def done():
        hidden = [name for name in os.listdir(work) if name.startswith(".tofsmith-")]
        return os.path.getsize(os.path.join(work, hidden[0])) / (4 * WIDTH * HEIGHT)

    watched = Watched([tool, "--quiet", "decode", path, *CODE, "--stack", "-o", out], done,
                      arguments.mb)
    code, seconds, peak_mb = watched.finish()
    print(f"{os.path.getsize(path) / 1e9:.2f} GB, {frames} frames, under {arguments.mb:g} MB of "
          f"data: exit code {code}, {seconds:.0f} s, {frames / seconds:.1f} frames/s, peak "
          f"{peak_mb:.0f} MB resident")
    flat = halves(watched.samples, "frames")
    return (code == 0 and peak_mb <= arguments.mb and flat
            and np.load(out, mmap_mode="r").shape[0] == frames)


def sweep(tool, arguments, work):
    items = int(arguments.items)
    store = os.path.join(work, "s.sqlite")
    with open(os.path.join(work, "sweep.toml"), "w", encoding="ascii") as file:
        file.write(f"""set = ["samples=8"]
codes = ["sinusoid-k3"]
trials = 2
[[axis]]
key = "light.peak_factor"
from = 10
to = 20
count = {max(items // 1000, 1)}
[[axis]]
key = "signal_e_per_s"
from = 1e3
to = 1e6
count = {min(items, 1000)}
[[axis]]
key = "ambient_e_per_s"
values = [1e4]
""")

    def done():
        connection = sqlite3.connect(f"file:{store}?mode=ro", uri=True)
        try:
            return connection.execute(
                "select count(*) from items where status = 'finished'").fetchone()[0]
        finally:
            connection.close()

    watched = Watched([tool, "--quiet", "sweep", os.path.join(work, "sweep.toml"), "--store",
                       store], done, period_s=max(2.0, items / 2e4))
    code, seconds, peak_mb = watched.finish()
    print(f"{items} items: exit code {code}, {seconds:.0f} s, {items / seconds:.0f} items/s, peak "
          f"{peak_mb:.0f} MB resident, store {os.path.getsize(store) / 1e6:.0f} MB")
    return halves(watched.samples, "items") and code == 0


def stream(tool, arguments, work):
    description = os.path.join(work, "sensor.raw.toml")
    with open(description, "w", encoding="ascii") as file:
        file.write(DESCRIPTION)
    content, read = frame(), [0]
    watched = Watched([tool, "--quiet", "decode", "-", "--raw-format", description, *CODE, "-o",
                       "-"], lambda: read[0] / (4 * WIDTH * HEIGHT),
                      period_s=max(1.0, arguments.minutes), stdin=subprocess.PIPE,
                      stdout=subprocess.PIPE)

    def take():
        while part := os.read(watched.process.stdout.fileno(), 1 << 20):
            read[0] += len(part)

    taker = threading.Thread(target=take)
    taker.start()
    end = time.monotonic() + 60 * arguments.minutes
    frames = 0
    while time.monotonic() < end:
        watched.process.stdin.write(content)
        frames += 1
    watched.process.stdin.close()
    taker.join()
    code, seconds, peak_mb = watched.finish()
    print(f"{frames} frames through a pipe: exit code {code}, {seconds:.0f} s, "
          f"{frames / seconds:.1f} frames/s, peak {peak_mb:.0f} MB resident")
    return (halves(watched.samples, "frames") and code == 0
            and read[0] == frames * 4 * WIDTH * HEIGHT)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tool")
    parser.add_argument("what", choices=("recording", "sweep", "stream"))
    parser.add_argument("--gb", type=float, default=8)
    parser.add_argument("--mb", type=float, default=512)
    parser.add_argument("--items", type=float, default=1e6)
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--work", help="where the large files go")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="tofsmith-load-", dir=arguments.work) as work:
        run = {"recording": recording, "sweep": sweep, "stream": stream}[arguments.what]
        sys.exit(0 if run(os.path.abspath(arguments.tool), arguments, work) else 1)


if __name__ == "__main__":
    main()
