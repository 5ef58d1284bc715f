# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Mixed pixels are handled equally in memory and in recordings."""

import numpy as np
import pytest

import tofsmith as ts

code, camera = "hamiltonian-k5", "paper-10f0"
NEAR_M, FAR_M, EDGE = 3.0, 5.0, 16


@pytest.fixture(scope="module")
def raw():
    """Near surface on the left, far on the right, and a mixed column between them."""
    def seen(depth_m):
        scene = np.full((24, 33), depth_m, np.float32)
        return ts.capture(scene, code, camera, signal_e_per_s=1e5, ambient_e_per_s=1e4, falloff=False)
    near, far = seen(NEAR_M), seen(FAR_M)
    both = np.where(np.arange(33)[None, :, None] < EDGE, near, far)
    both[:, EDGE] = 0.6 * near[:, EDGE] + 0.4 * far[:, EDGE]
    return both


@pytest.mark.parametrize("mixed", ["label", "snap", "drop", None])
def test_filtered_frames_decode_like_recordings(raw, mixed, tmp_path):
    decoder = ts.Decoder(code, camera)
    np.save(tmp_path / "raw.npy", raw)
    decoder.decode_recording(tmp_path / "raw.npy", tmp_path / "depth.npz", filter="light",
                             mixed=mixed, outputs=["depth", "status"])
    expected = np.load(tmp_path / "depth.npz")
    for filter in ("light", {"strength": "light"}, ts.Filter(code, camera, strength="light")):
        found = decoder.decode(raw, filter=filter, mixed=mixed)
        np.testing.assert_array_equal(found.status, expected["status"].squeeze())
        np.testing.assert_array_equal(found.depth_m, expected["depth"].squeeze())
    assert (found.status == ts.PixelStatus.mixed).any() == (mixed is not None)


def test_rejects_unknown_names(raw):
    with pytest.raises(ValueError, match="mixed: .*label"):
        ts.Decoder(code, camera).decode(raw, mixed="near")
