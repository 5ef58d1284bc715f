#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of README.md and the tutorial and updates their printed results and pictures.

    scripts/update_pages.py TOFSMITH      the program; PYTHONPATH contains the Python package

Blocks marked as `console` contain commands ("$ ...") and their results; blocks marked as `text`
contain the result of the preceding Python block. A line "..." in a result replaces omitted lines;
the number of lines above and below it is kept. The commands of a page run in one directory.
Requires matplotlib and takes about two minutes.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BLOCK = re.compile(r"^```(console|bash|toml|python|text)\n(.*?)^```$", re.M | re.S)


def run(command, directory, text=None):
    environment = os.environ | {"PATH": f"{TOOL.parent}:/usr/bin:/bin", "MPLBACKEND": "agg"}
    done = subprocess.run(command, input=text, cwd=directory, env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if done.returncode != 0:
        sys.exit(f"{text or command}\nended with exit status {done.returncode}:\n{done.stderr}")
    return done.stdout


def shortened(lines, shown):
    """Shortens `lines` like `shown`: keeps the same number of lines before and after "..."."""
    if "..." not in shown:
        return lines
    above = shown.index("...")
    below = len(shown) - above - 1
    return [*lines[:above], "...", *lines[len(lines) - below:]]


def console(text, directory):
    """Runs the commands of a block and returns the block with their results."""
    parts = re.split(r"^(\$ (?:.*\\\n)*.*\n)", text, flags=re.M)
    written = parts[0]
    for command, shown in zip(parts[1::2], parts[2::2], strict=True):
        shell_text = command.removeprefix("$ ").split(" #")[0]
        printed = run(["bash", "-e"], directory, shell_text).rstrip("\n").split("\n")
        lines = shortened([line.rstrip() for line in printed], shown.rstrip("\n").split("\n"))
        written += command + "".join(line + "\n" for line in lines if line or len(lines) > 1)
    return written


def update(page, directory):
    """Runs the blocks of a page in order and updates the results in it."""
    printed = ""

    def block(match):
        nonlocal printed
        language, text = match.groups()
        name = re.match(r"# (\S+\.(?:toml|py))\n", text)
        if language == "console":
            return f"```console\n{console(text, directory)}```"
        if language == "toml" or name:
            (Path(directory) / name[1]).write_text(text)
        elif language == "bash":
            run(["bash", "-e"], directory, text)
        elif language == "python":
            printed = run([sys.executable, "-B", "-"], directory, text)
        elif language == "text":
            return f"```text\n{printed}```"
        return match[0]

    page.write_text(BLOCK.sub(block, page.read_text()))


def draw_demo(scene, picture):
    """Draws depth and depth error of each code of a demo at medium light.

    scene    directory of scene.json and the .npy files that it names
    picture  file to write
    """
    import matplotlib
    matplotlib.use("agg")
    import numpy as np
    from matplotlib import pyplot

    document = json.loads((scene / "scene.json").read_text())
    decodings = document["captures"][1]["decodings"]
    true_m = np.load(scene / "true_depth.npy")
    figure, axes = pyplot.subplots(2, len(decodings), figsize=(9, 4.7), layout="constrained")
    limit_mm = 3e3 * decodings[1]["error"]["median_m"]
    for (top, bottom), decoding in zip(axes.T, decodings, strict=True):
        depth_m = np.load(scene / decoding["file"])
        shown = top.imshow(depth_m, vmin=true_m.min(), vmax=true_m.max())
        off = bottom.imshow(1e3 * (depth_m - true_m), cmap="RdBu", vmin=-limit_mm, vmax=limit_mm)
        top.set_title(decoding["code"])
        bottom.set_title(f"median error {1e3 * decoding['error']['median_m']:.1f} mm")
        for axis in (top, bottom):
            axis.set_axis_off()
    figure.colorbar(shown, ax=axes[0], label="depth (m)")
    figure.colorbar(off, ax=axes[1], label="error (mm)")
    figure.savefig(picture, dpi=100)


def main():
    images = ROOT / "docs" / "images"
    with tempfile.TemporaryDirectory() as directory:
        update(ROOT / "README.md", directory)
        run(["bash", "-e"], directory, "tofsmith demo")
        draw_demo(Path(directory) / "tofsmith-demo" / "scene", images / "demo.png")
    with tempfile.TemporaryDirectory() as directory:
        update(ROOT / "docs/tutorial.md", directory)
        shutil.copy(Path(directory) / "compared.png", images / "tutorial.png")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    TOOL = Path(sys.argv[1]).resolve()
    main()
