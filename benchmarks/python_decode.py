# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Speed of decoding from Python relative to the same call in C++, on VGA frames. Target: >= 0.95.

    PYTHONPATH=BUILD/python /usr/bin/python3 benchmarks/python_decode.py BUILD/benchmarks/benchmark_decode_call

Both decode the same frame alternately, on one thread, into planes of the caller. The result is the
median over the rounds of the ratio of CPU times.
"""

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import tofsmith


def main() -> None:
    program = sys.argv[1]
    tofsmith.set_threads(1)
    camera = tofsmith.Camera("paper-10f0", samples=960)
    scene = tofsmith.built_in_scene("table-top", 640, 480)
    for name in ("hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5"):
        raw = tofsmith.capture(scene, name, camera, signal_e_per_s=1e5, ambient_e_per_s=1e4)
        decoder = tofsmith.Decoder(name, camera)
        image = decoder.decode(raw)
        with tempfile.TemporaryDirectory() as directory:
            np.save(Path(directory) / "raw.npy", raw)
            cpp_s, python_s = [], []
            with subprocess.Popen(
                [program, Path(directory) / "raw.npy", name], stdin=subprocess.PIPE,
                stdout=subprocess.PIPE, text=True,
            ) as process:
                for _ in range(30):
                    process.stdin.write("go\n")
                    process.stdin.flush()
                    cpp_s.append(float(process.stdout.readline()))
                    start = time.process_time()
                    decoder.decode(raw, out=image)
                    python_s.append(time.process_time() - start)
                process.stdin.close()
        ratio = statistics.median(c / p for c, p in zip(cpp_s, python_s))
        print(f"{name}: Python {1e3 * min(python_s):.2f} ms, C++ {1e3 * min(cpp_s):.2f} ms a frame; "
              f"throughput {ratio:.3f}x of C++ (asked 0.95)")


if __name__ == "__main__":
    main()
