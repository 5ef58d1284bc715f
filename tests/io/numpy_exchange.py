# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""The NumPy side of npy_test.cpp: `check` its files, or `write` files for it."""

import io
import itertools
import pathlib
import sys

import numpy as np

TYPES = ["i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", "f4", "f8"]


def counting_arrays():
    arrays = {name: np.arange(24, dtype="<" + name).reshape(2, 3, 4) for name in TYPES}
    arrays["scalar"] = np.float64(0)[()].reshape(())
    arrays["empty"] = np.zeros((0, 5))
    arrays["line"] = np.arange(12345, dtype="<f4")
    return arrays


def assert_same(found, expected, name):
    assert found.dtype == expected.dtype, f"{name}: {found.dtype} instead of {expected.dtype}"
    np.testing.assert_array_equal(found, expected, err_msg=name)


def check(directory):
    for file in directory.glob("*.npy"):
        expected = counting_arrays()[file.name.split(".")[0]]
        assert_same(np.load(file), expected, file.name)
        by_numpy = io.BytesIO()
        np.save(by_numpy, expected)
        assert file.read_bytes() == by_numpy.getvalue(), f"{file.name}: other bytes than NumPy's"
    for name in ["stored.npz", "deflated.npz"]:
        with np.load(directory / name) as archive:
            assert set(archive.files) == set(counting_arrays())
            for entry, expected in counting_arrays().items():
                assert_same(archive[entry], expected, f"{name}: {entry}")


def write(directory):
    arrays = counting_arrays()
    for name, byte_order, memory_order, version in itertools.product(
        TYPES, "<>", "CF", [(1, 0), (2, 0), (3, 0)]
    ):
        array = np.asarray(arrays[name].astype(byte_order + name), order=memory_order)
        label = f"{name}.{'le' if byte_order == '<' else 'be'}.{memory_order}.{version[0]}.npy"
        with open(directory / label, "wb") as file:
            np.lib.format.write_array(file, array, version=version)
    for name in ["scalar", "empty", "line"]:
        np.save(directory / f"{name}.npy", arrays[name])
    np.savez(directory / "stored.npz", **arrays)
    np.savez_compressed(directory / "deflated.npz", **arrays)


if __name__ == "__main__":
    {"check": check, "write": write}[sys.argv[1]](pathlib.Path(sys.argv[2]))
