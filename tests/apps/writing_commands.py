# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Every command that writes files, on inputs small enough to run in a moment."""

import dataclasses
import os
import subprocess

import numpy as np

CAMERA = """fundamental_frequency_hz = 15e6
exposure_s = 0.004
samples = 60
[light]
impulse_response = { kind = "hann", f_max_hz = 75e6 }
[sensor]
impulse_response = { kind = "hann", f_max_hz = 75e6 }
read_noise_e = 30
adc_bits = 12
gain_e_per_dn = 8
black_level_dn = 100
[operating]
signal_e_per_s = [1e6]
ambient_e_per_s = [1e5]
"""
SWEEP = """set = ["samples=60"]
codes = ["sinusoid-k4"]
trials = 10

[[axis]]
key = "light.peak_factor"
values = [12, 15]
"""


@dataclasses.dataclass(frozen=True)
class Command:
    name: str
    arguments: tuple
    outputs: tuple  # created files and directories
    is_slow: bool = False  # takes a second or more
    timed: tuple = ()  # outputs that contain computing times, so that two runs may differ
    also: str = ""  # beginning of paths of further files that may exist


def _command(line, *outputs, name=None, **more):
    words = tuple(line.split())
    return Command(name or " ".join(w for w in words[:2] if w[0] != "-" and "." not in w)
                   + " " + outputs[0], words, outputs, **more)


_CAMERA = "--camera camera.toml"
COMMANDS = (
    _command(f"codes sinusoid-k4 {_CAMERA} -o c.code.json", "c.code.json"),
    _command(f"codes sinusoid-k4 {_CAMERA} -o c.npz", "c.npz"),
    _command(f"codes square-k4 {_CAMERA} -o c.csv", "c.csv"),
    _command(f"codes square-k4 {_CAMERA} -o c.html", "c.html"),
    _command(f"evaluate sinusoid-k4 {_CAMERA} --trials 10 -o e.csv", "e.csv"),
    _command(f"evaluate sinusoid-k4 {_CAMERA} --trials 10 -o e.json", "e.json"),
    _command(f"evaluate sinusoid-k4 {_CAMERA} --trials 10 -o e.html", "e.html"),
    _command("scene flat.npy -o s.exr", "s.exr"),
    _command("scene flat.npy -o s.png", "s.png"),
    _command("scene flat.npy -o look", "look"),
    _command(f"simulate flat.npy --code sinusoid-k4 {_CAMERA} -o raw.npy --truth t.pfm", "raw.npy",
             "t.pfm"),
    _command(f"simulate flat.npy --code sinusoid-k4 {_CAMERA} --frames 3 -o raw.npz", "raw.npz",
             "raw.code.json", "raw.camera.toml"),
    _command(f"simulate scenes --code sinusoid-k4 {_CAMERA} -o set", "set"),
    _command(f"decode frames.npy --code sinusoid-k4 {_CAMERA} -o d.npy --stack "
             "--outputs depth,signal", "d.npy", "d-signal.npy"),
    _command(f"decode frames.npy --code sinusoid-k4 {_CAMERA} -o d.pfm", "d-0.pfm", "d-1.pfm"),
    _command(f"decode frames.npy --code sinusoid-k4 {_CAMERA} --frame 0 -o d.npz", "d.npz"),
    _command(f"decode frames.npy --code sinusoid-k4 {_CAMERA} --frame 0 -o d.exr", "d.exr"),
    _command(f"decode frames.npy --code sinusoid-k4 {_CAMERA} --frame 0 -o d.png", "d.png"),
    _command(f"decode frames.npy --code sinusoid-k4 {_CAMERA} --frame 0 --view-deg 60 -o d.ply",
             "d.ply"),
    _command(f"decode frames.npy --code sinusoid-k4 {_CAMERA} --frame 0 --filter light "
             "--view-deg 60 -o d.pcd", "d.pcd"),
    _command(f"export square-k4 {_CAMERA} --format csv --samples 60 --no-loss -o bench", "bench"),
    _command(f"export square-k4 {_CAMERA} --format keysight-arb --samples 60 --no-loss -o bench",
             "bench", name="export keysight-arb"),
    _command(f"export square-k4 {_CAMERA} --format c-header --samples 60 --no-loss -o w.h", "w.h"),
    _command("sweep sweep.toml --store s.sqlite --export s.csv --export s.npz --report s.html",
             "s.sqlite", "s.csv", "s.npz", "s.html", timed=("s.html",)),
    _command("sweep merge both.sqlite one.sqlite two.sqlite", "both.sqlite"),
    _command(f"calibrate impulse-response scope.csv {_CAMERA} -o c.toml --report c.html", "c.toml",
             "c-response.csv", "c.html"),
    _command(f"calibrate noise dark.npy bright.npy brighter.npy {_CAMERA} -o c.toml "
             "--report c.html", "c.toml", "c.html", name="calibrate noise"),
    _command(f"calibrate temperature warm.npy --temperatures degrees.txt --code sinusoid-k4 "
             f"{_CAMERA} -o c.toml --report c.html", "c.toml", "c.html"),
    _command(f"calibrate stray-light target.npy {_CAMERA} -o kernel.npy --report c.html",
             "kernel.npy", "c.html"),
    _command(f"calibrate correlation sweep.npy --shifts shifts.txt --shift-unit bin {_CAMERA} "
             "--code hamiltonian-k4 --table t.npz --offset-map o.npy --gain-map g.npy -o c.toml "
             "--report c.html", "c.toml", "t.npz", "o.npy", "g.npy", "c.html"),
    _command("report designed -o page.html", "page.html"),
    _command(f"design {_CAMERA} --method factorize --exposures 3 --effort 0.01 --trials 1000 -o d",
             "d", is_slow=True, also="d/finished/"),
    _command(f"require {_CAMERA} --error 20mm --vary power --no-map --exact --effort 0.01 "
             "--trials 1000 -o need", "need", is_slow=True),
    _command(f"demo {_CAMERA} --effort 0.01 --trials 1000 --width 8 --height 6 -o out", "out",
             is_slow=True, also="out/"),
)


def make_inputs(tool, directory):
    def run(*arguments):
        subprocess.run([tool, "--quiet", *arguments], cwd=directory, check=True,
                       stdout=subprocess.DEVNULL)

    def save(name, array):
        np.save(os.path.join(directory, name), array)

    def write(name, text):
        with open(os.path.join(directory, name), "w", encoding="utf-8") as file:
            file.write(text)

    write("camera.toml", CAMERA)
    write("sweep.toml", SWEEP)
    rng = np.random.default_rng(1)
    depth = np.linspace(1, 3, 48, dtype=np.float32).reshape(6, 8)
    save("flat.npy", depth)
    os.mkdir(os.path.join(directory, "scenes"))
    save("scenes/a.npy", depth)
    save("scenes/b.npy", depth + 1)
    run("simulate", "flat.npy", "--code", "sinusoid-k4", "--camera", "camera.toml", "--frames", "2",
        "-o", "frames.npy")
    for shard, name in (("1/2", "one"), ("2/2", "two")):
        run("sweep", "sweep.toml", "--store", f"{name}.sqlite", "--shard", shard)
    t = np.arange(200) * 0.2
    pulse = np.exp(-((t - 20) / 1.5) ** 2 / 2) + 0.01 * rng.standard_normal(t.size)
    write("scope.csv", "Time (ns),Volt\n" + "".join(f"{a:.2f},{b:.6f}\n" for a, b in zip(t, pulse)))
    for name, mean_e in (("dark", 0), ("bright", 4e3), ("brighter", 8e3)):
        counts = rng.poisson(mean_e, (2, 16, 16, 4)) + 30 * rng.standard_normal((2, 16, 16, 4))
        save(f"{name}.npy", np.round(100 + counts / 8).astype(np.float32))
    degrees = np.linspace(20, 47, 6)
    write("degrees.txt", "".join(f"{d}\n" for d in degrees))
    phase = 2 * np.pi * ((2 + 1e-3 * degrees)[:, None, None, None] / 9.993 - np.arange(4) / 4)
    light = np.broadcast_to(1e4 * (1.2 + np.cos(phase)), (6, 4, 4, 4))
    save("warm.npy", (100 + rng.poisson(light) / 8).astype(np.float32))
    rows, columns = np.mgrid[-15:16, -15:16]
    distance = np.hypot(rows, columns)
    halo = np.where(distance < 2, 3000.0, 30 / (1 + distance) ** 2)
    save("target.npy", (100 + halo[None, :, :, None] + 0.1 * rng.standard_normal((2, 31, 31, 4)))
         .astype(np.float32))
    bins = np.arange(61)
    angle = 2 * np.pi * (bins[:, None, None, None] / 60 - np.arange(4) / 4)
    table = 500 + 400 * np.cos(angle) + rng.standard_normal((61, 3, 3, 4))
    save("sweep.npy", table.astype(np.float32))
    np.savetxt(os.path.join(directory, "shifts.txt"), bins)
    run("design", "--camera", "camera.toml", "--method", "factorize", "--exposures", "3",
        "--effort", "0.01", "--trials", "1000", "-o", "designed")
