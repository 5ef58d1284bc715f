#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Time until the lab page shows results, in a headless Chromium without a GPU.

    lab_page.py build-lab/lab.html [--moves 20]

Times are wall-clock times on an idle machine. Prints each measured value with its target: the time
from opening the page to its first waveforms; the time from moving a slider to new waveforms and to
new errors of two codes at 25 light levels (medians of the moves); and one full evaluation in the
worker."""

import argparse
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "apps" / "lab"))
from lab_browser import HELPERS, browser_test  # noqa: E402

FIRST = """const done = arguments[0];
settled().then(() => done(performance.getEntriesByName('tofsmith picture')[0].startTime));"""

# Times in ms from each move to new waveforms and to new errors of both codes.
MOVES = """const [count, done] = arguments;
(async () => {
  const slider = document.querySelector('[data-key="light.peak_factor"] input[type=range]'), times = [];
  let hear = () => {};
  tofsmithLab.lab.listen((what, i) => hear(what, i));
  for (let move = 0; move < count; ++move) {
    const begin = performance.now(), seen = {code: new Set(), evaluation: new Set()}, at = {};
    await new Promise((resolve) => {
      hear = (what, i) => {
        if (!seen[what]) return;
        seen[what].add(i);
        if (seen[what].size === 2) at[what] ??= requestAnimationFrame(() => { at[what] = performance.now() - begin; if (what === 'evaluation') resolve(); });
      };
      slider.value = 300 + 15 * (move % 20);
      slider.dispatchEvent(new Event('input', {bubbles: true}));
    });
    times.push([at.code, at.evaluation]);
    await settled();
  }
  return times;
})().then(done, (error) => done(String(error)));"""

FULL = """const done = arguments[0], camera = tofsmithLab.lab.camera.toml, times = [];
(async () => {
  for (let i = 0; i < 5; ++i) {
    const begin = performance.now();
    await tofsmithLab.engine.call('evaluate', {camera, code: {name: 'hamiltonian-k4'}, trials: 20000, seed: 1});
    times.push(performance.now() - begin);
  }
  return times;
})().then(done, (error) => done(String(error)));"""


def main():
    """Runs the measurements and exits with an error if a target is missed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("page", type=Path)
    parser.add_argument("--moves", type=int, default=20)
    arguments = parser.parse_args()
    with browser_test.browser(1280, 900, False) as driver:
        driver.set_script_timeout(300)
        driver.get(arguments.page.resolve().as_uri())
        driver.execute_script(HELPERS)
        first = driver.execute_async_script(FIRST)
        moves = driver.execute_async_script(MOVES, arguments.moves)
        full = driver.execute_async_script(FULL)
    waveforms, errors = (statistics.median(one) for one in zip(*moves))
    megabytes = arguments.page.stat().st_size / 1e6
    missed = 0
    for name, value, asked, unit in (
            ("first picture", first, 1000, "ms"), ("slider to waveforms", waveforms, 100, "ms"),
            ("slider to first errors", errors, 100, "ms"),
            ("evaluation of 25 x 20000 trials", min(full), 1000, "ms"), ("page", megabytes, 8, "MB")):
        missed += value > asked
        print(f"{name:32} {value:8.1f} {unit}  asked: at most {asked}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
