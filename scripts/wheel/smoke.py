# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Tests an installed wheel with all its libraries in the current directory, and plots if matplotlib
is installed. Run by scripts/wheel/try.sh."""

import base64
import ctypes
import importlib.util
import pathlib
import zlib

# The system's C++ library must not conflict with the wheel's.
try:
    ctypes.CDLL("libstdc++.so.6")
except OSError:
    print("This system has no libstdc++.so.6")

has_matplotlib = importlib.util.find_spec("matplotlib") is not None
if has_matplotlib:  # its extensions use the system's libraries
    import matplotlib

    matplotlib.use("agg")
    import matplotlib.pyplot  # noqa: F401

import numpy as np

import tofsmith

assert "site-packages" in tofsmith.__file__, tofsmith.__file__
mapped = pathlib.Path("/proc/self/maps").read_text()
for library in ("libembree", "libtbb", "libhdf5", "libzip", "libOpenEXR", "libpng", "libsqlite3"):
    paths = {line.split()[-1] for line in mapped.splitlines() if f"/{library}" in line}
    assert paths, f"{library} is not loaded"
    assert any("_prefix/lib" in path for path in paths), f"{library} is loaded from {paths}"

camera = tofsmith.Camera("paper-10f0")
design = tofsmith.design(camera, effort=0, trials=1000)
code = design.winner.code
print("designed", code.name)

# Capture and decode a built-in scene, and a mesh (Embree) with the file formats of all libraries.
scene = tofsmith.built_in_scene("table-top", 64, 48)
raw = tofsmith.capture(scene, code, camera, signal_e_per_s=1e7, ambient_e_per_s=1e4, seed=1)
image = tofsmith.Decoder(code, camera).decode(raw)
ok = image.status == tofsmith.PixelStatus.ok
error_m = np.abs(image.depth_m - scene.depth_m)[ok]
assert ok.mean() > 0.9 and np.median(error_m) < 0.1, (ok.mean(), np.median(error_m))

pathlib.Path("square.obj").write_text("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n")
mesh = tofsmith.load_scene("square.obj", width=32, height=24)
assert np.isfinite(mesh.depth_m).any()

tofsmith.write_raw("raw.npz", raw)
assert np.array_equal(tofsmith.read_raw("raw.npz")[0], raw)
for name, tolerance_m in (("depth.exr", 0), ("depth.png", 1e-3)):
    tofsmith.write_depth(name, scene.depth_m)
    found = tofsmith.read_depth(name)
    assert np.nanmax(np.abs(found - scene.depth_m)) <= tolerance_m, name

# A compressed data set of 0, 1, ..., 11.
HDF5_FILE = (
    "c-rgqaB<`1lHy|K;9!7(|4^U-6*7Q|Ct9vP<?rDV#H8@Li9H(`S1<`7YlHzVCI&_Z1~xthAjMpiSbi90gBt^t!2L_tKY"
    "^XZ$iT>G!oa}9%*e<Hm1Bm|EKnMkII{=?qo9I3l&`=b&cPsF4`i_dUC+$S&BMUR1T+%_K`J=pfI69&SQr_ZSy&h~kR1a"
    "H!4if60X$odtY;VnqhJ(_f>AIEhyfLG$q5XNY}E=68C)FhFdX4-_`x7x&yd9C&c?>55XO+i?9MP_G20RVDcwAz"
)
pathlib.Path("raw.h5").write_bytes(zlib.decompress(base64.b85decode(HDF5_FILE)))
assert np.array_equal(tofsmith.read_raw("raw.h5").ravel(), np.arange(12))

pathlib.Path("sweep.toml").write_text(
    'camera = "paper-10f0"\ncodes = ["hamiltonian-k4"]\ntrials = 100\nseed = 1\n'
    '[[axis]]\nkey = "light.peak_factor"\nvalues = [5, 10]\n')
tofsmith.run_sweep("sweep.toml", "store.sqlite")

# C++ exceptions keep their types and messages.
for use, kind in ((lambda: tofsmith.read_raw("missing.npz"), OSError),
                  (lambda: tofsmith.Camera("paper-10f0", light={"peak_factor": -1}), ValueError),
                  (lambda: tofsmith.read_depth("sweep.toml"), (OSError, ValueError))):
    try:
        use()
    except kind as error:
        assert str(error)
    else:
        raise AssertionError(f"expected {kind}")

if has_matplotlib:
    from tofsmith import paper, plot

    plot.depth_maps({"decoded": image, "true": scene.depth_m}).savefig("depth.pdf")
    assert paper.reproduce("fig5", "paper", fast=True)["fig5"][0].verdict == "holds"
print("NumPy", np.__version__, "and matplotlib" if has_matplotlib else "without matplotlib")
