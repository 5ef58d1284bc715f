# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""HDF5 files written by h5py are read like NumPy files."""

import numpy as np
import pytest

import tofsmith as ts

h5py = pytest.importorskip("h5py")


@pytest.mark.parametrize("kind", ["<u2", ">i2", "<i4", "<f4", ">f8"])
@pytest.mark.parametrize("options", [
    {}, {"chunks": True, "compression": "gzip", "shuffle": True},
    {"chunks": (1, 3, 2, 4)}, {"fletcher32": True}])
def test_frames_equal_the_array(tmp_path, kind, options):
    raw = np.arange(2 * 6 * 5 * 4).reshape(2, 6, 5, 4).astype(kind)
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.create_dataset("camera/quads", data=raw, **options)
        file.create_dataset("camera/temperature_c", data=[20.0, 21.0])
    assert np.array_equal(ts.read_raw(tmp_path / "a.h5"), raw.astype(np.float32))
    assert np.array_equal(ts.read_raw(tmp_path / "a.h5", dataset="/camera/quads"),
                          raw.astype(np.float32))


def test_recordings_decode_to_the_same_bytes(tmp_path):
    camera = ts.Camera("paper-10f0")
    raw = np.random.default_rng(1).poisson(500, (3, 8, 6, 4)).astype(np.uint16)
    np.save(tmp_path / "a.npy", raw)
    np.savez(tmp_path / "a.npz", dark=raw[:1] * 0, quads=raw)
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["quads"] = raw
        file["dark"] = raw[:1] * 0
    decoder = ts.Decoder("hamiltonian-k4", camera)
    decoder.decode_recording(tmp_path / "a.npy", tmp_path / "npy.npy", stack=True)
    for name in ("a.npz", "a.h5"):
        decoder.decode_recording(tmp_path / name, tmp_path / "out.npy", stack=True,
                                 dataset="quads", overwrite=True)
        assert (tmp_path / "out.npy").read_bytes() == (tmp_path / "npy.npy").read_bytes()
        with pytest.raises(OSError, match="dark.*quads"):
            decoder.decode_recording(tmp_path / name, tmp_path / "none.npy", stack=True)


def test_half_precision_decodes_like_single_precision(tmp_path):
    halves = np.linspace(-3e4, 3e4, 4 * 4 * 4).reshape(4, 4, 4).astype(np.float16)
    halves[0, 0] = [np.float16(6e-8), np.inf, -np.inf, np.nan]
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["raw"] = halves.astype(">f2")
    np.save(tmp_path / "a.npy", halves)
    np.savez(tmp_path / "a.npz", raw=np.asfortranarray(halves))
    for name in ("a.h5", "a.npy", "a.npz"):
        read = ts.read_raw(tmp_path / name)
        np.testing.assert_array_equal(read.reshape(halves.shape), halves.astype(np.float32))


def test_rejects_non_numeric_types(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["mask"] = np.zeros((4, 4, 4), bool)
        file["complex"] = np.zeros((4, 4, 4), np.complex64)
    with pytest.raises(OSError, match="no data set of numbers"):
        ts.read_raw(tmp_path / "a.h5")
