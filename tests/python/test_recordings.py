# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Frames in memory are decoded as recordings are, with mixed pixels and depth limits."""

import numpy as np
import pytest

import tofsmith as ts

CODE = "multifrequency-4x4-5x4"
CAMERA = ts.Camera("paper-30x", fundamental_frequency_hz=20e6)
MIXED = ("hamiltonian-k5", "paper-10f0")
NEAR_M, FAR_M, EDGE = 3.0, 5.0, 16
LIMITS = {"min_depth_m": 1.0, "max_depth_m": 2.5}
PLANES = ["depth", "status"]


@pytest.fixture(scope="module")
def raw():
    scene = np.repeat(np.float32([[0.5, 1.2, 2.0, 3.5]]), 6, axis=0)
    return ts.capture(scene, CODE, CAMERA, signal_e_per_s=1e5, ambient_e_per_s=1e4, falloff=False)


def recorded(decoder, raw, directory, **options):
    """Decodes a recording of one frame."""
    np.save(directory / "raw.npy", raw)
    decoder.decode_recording(directory / "raw.npy", directory / "depth.npz", outputs=PLANES,
                             **options)
    planes = np.load(directory / "depth.npz")
    return ts.DepthImage(depth_m=planes["depth"].squeeze(), status=planes["status"].squeeze())


@pytest.mark.parametrize("method", ["zncc", "ml", "unwrap"])
def test_frames_are_decoded_as_recordings_are(raw, method, tmp_path):
    decoder = ts.Decoder(CODE, CAMERA, method=method)
    found = decoder.decode(raw, planes=PLANES, **LIMITS)
    assert found == recorded(decoder, raw, tmp_path, **LIMITS)
    assert (found.status[:, 0] == ts.PixelStatus.too_near).all()
    assert (found.status[:, 3] == ts.PixelStatus.too_far).all()
    assert np.isnan(found.depth_m[:, [0, 3]]).all()


def test_the_working_distance_of_the_camera_is_the_default(raw):
    camera = CAMERA.replace(operating={"working_distance_m": [1, 2.5]})
    by_camera = ts.Decoder(CODE, camera).decode(raw, planes=PLANES)
    assert by_camera == ts.Decoder(CODE, CAMERA).decode(raw, planes=PLANES, **LIMITS)
    anywhere = ts.Decoder(CODE, camera).decode(raw, min_depth_m=0, max_depth_m=camera.range_m)
    assert (anywhere.status == ts.PixelStatus.ok).all()


@pytest.mark.parametrize("limits, message", [
    ({"min_depth_m": "1"}, "min_depth_m: got str '1'; needs a number"),
    ({"max_depth_m": float("nan")}, "max_depth_m: got nan; needs a finite number"),
    ({"min_depth_m": 3.0, "max_depth_m": 2.0}, "min_depth_m = 3; must be below"),
])
def test_impossible_limits(raw, limits, message):
    with pytest.raises((TypeError, ValueError), match=message):
        ts.Decoder(CODE, CAMERA).decode(raw, **limits)


@pytest.fixture(scope="module")
def edge():
    """Near surface on the left, far on the right, and a mixed column between them."""
    def seen(depth_m):
        scene = np.full((24, 33), depth_m, np.float32)
        return ts.capture(scene, *MIXED, signal_e_per_s=1e5, ambient_e_per_s=1e4, falloff=False)
    near, far = seen(NEAR_M), seen(FAR_M)
    both = np.where(np.arange(33)[None, :, None] < EDGE, near, far)
    both[:, EDGE] = 0.6 * near[:, EDGE] + 0.4 * far[:, EDGE]
    return both


@pytest.mark.parametrize("mixed", ["label", "snap", "drop", None])
def test_filtered_frames_decode_like_recordings(edge, mixed, tmp_path):
    decoder = ts.Decoder(*MIXED)
    expected = recorded(decoder, edge, tmp_path, filter="light", mixed=mixed)
    for filter in ("light", {"strength": "light"}, ts.Filter(*MIXED, strength="light")):
        found = decoder.decode(edge, planes=PLANES, filter=filter, mixed=mixed)
        np.testing.assert_array_equal(found.status, expected.status)
        np.testing.assert_array_equal(found.depth_m, expected.depth_m)
    assert (found.status == ts.PixelStatus.mixed).any() == (mixed is not None)


def test_rejects_unknown_handling_of_mixed_pixels(edge):
    with pytest.raises(ValueError, match="mixed: .*label"):
        ts.Decoder(*MIXED).decode(edge, mixed="near")
