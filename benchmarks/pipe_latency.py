#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Latency of `tofsmith decode - -o -`: time from the last byte written of a frame to the last byte
read of its depth. VGA, four measurements of 12 bits stored in 16. For comparison, the time to
send the same bytes through `cat` and read the same number back, the cost of the pipes.

    pipe_latency.py TOFSMITH [FRAMES]
"""

import os
import subprocess
import sys
import tempfile
import threading
import time

import numpy as np

WIDTH, HEIGHT, MEASUREMENTS = 640, 480, 4
ASKED_MS = 5.0
DESCRIPTION = f"""width = {WIDTH}
height = {HEIGHT}
measurements = {MEASUREMENTS}
bits = 12
"""


def frame():
    random = np.random.default_rng(1)
    phase = np.linspace(0, 2 * np.pi, WIDTH)[None, :] + np.zeros((HEIGHT, 1))
    planes = [2000 + 1500 * np.cos(phase - k * np.pi / 2) + random.normal(0, 20, phase.shape)
              for k in range(MEASUREMENTS)]
    return np.stack(planes).astype("<u2").tobytes()


def read_exactly(descriptor, size):
    while size > 0:
        part = os.read(descriptor, min(size, 1 << 20))
        if not part:
            raise EOFError
        size -= len(part)


def latencies(command, answer_bytes, frames):
    """Seconds from the last byte of a frame to that of its answer, for one frame at a time (F)."""
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, bufsize=0)
    content, waits, written = frame(), [], []
    for _ in range(frames):
        def send():
            view = memoryview(content)
            while view:
                view = view[os.write(process.stdin.fileno(), view):]
            written.append(time.perf_counter())

        sender = threading.Thread(target=send)
        sender.start()
        read_exactly(process.stdout.fileno(), answer_bytes(content))
        end = time.perf_counter()
        sender.join()
        waits.append(end - written[-1])
    process.stdin.close()
    process.wait()
    return np.array(waits[3:])


def main():
    tool, frames = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 200
    with tempfile.NamedTemporaryFile("w", suffix=".raw.toml") as description:
        description.write(DESCRIPTION)
        description.flush()
        decode = latencies([tool, "decode", "-", "--raw-format", description.name, "--code",
                            "sinusoid-k4", "-o", "-"], lambda _: 4 * WIDTH * HEIGHT, frames)
    pipe = latencies(["cat"], len, frames)
    print(f"{'ms':<10}{'median':>8}{'99 %':>8}")
    for name, waits in (("decode", decode), ("cat", pipe)):
        print(f"{name:<10}{1e3 * np.median(waits):8.2f}{1e3 * np.quantile(waits, 0.99):8.2f}")
    print(f"asked: below {ASKED_MS} ms; median {1e3 * np.median(decode):.2f} ms, ratio "
          f"{1e3 * np.median(decode) / ASKED_MS:.2f}")


if __name__ == "__main__":
    main()
