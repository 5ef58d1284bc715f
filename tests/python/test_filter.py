# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Filtered frames are accepted by decoders."""

import numpy as np
import pytest

import tofsmith as ts

code = "hamiltonian-k4"


@pytest.fixture(scope="module")
def raw(camera):
    return ts.capture(ts.built_in_scene("table-top", 40, 30), code, camera, signal_e_per_s=1e5,
                      ambient_e_per_s=1e4, seed=5, frames=3)


def test_filtered_values_are_decoded_with_their_noise(camera, raw):
    decoder = ts.Decoder(code, camera)
    numbers, averaged = ts.Filter(code, camera).apply(raw[0])
    assert (numbers.shape, numbers.dtype) == (raw[0].shape, np.float32)
    assert (averaged.shape, averaged.dtype) == (raw[0].shape[:2], np.float32)
    assert np.median(averaged) > 10
    alone, filtered = decoder.decode(raw[0]), decoder.decode(numbers, averaged=averaged)
    gain = (alone.deviation_m / filtered.deviation_m) ** 2
    assert np.nanmedian(gain / averaged) == pytest.approx(1, abs=0.2)
    of_three = ts.Filter(code, camera).apply(raw[0], averaged=3.0)[1]
    assert of_three.mean() == pytest.approx(3 * averaged.mean(), rel=0.5)
    with pytest.raises(ValueError, match=r"averaged.*\(H, W\)"):
        ts.Filter(code, camera).apply(raw[0], averaged=[3.0])
    once = ts.decode(raw[0], code, camera, filter="normal")
    assert once.depth_m.tobytes() == filtered.depth_m.tobytes()


def test_stacks_and_layouts_are_filtered_frame_by_frame(camera, raw):
    filter = ts.Filter(code, camera, strength="light")
    numbers, averaged = filter.apply(raw)
    planar = filter.apply(np.moveaxis(raw, 3, 1), layout="planar")
    assert numbers.tobytes() == planar[0].tobytes()
    assert averaged.tobytes() == planar[1].tobytes()
    for frame in range(3):
        alone = filter.apply(raw[frame])
        assert alone[0].tobytes() == numbers[frame].tobytes()
        assert alone[1].tobytes() == averaged[frame].tobytes()
    decoded = ts.Decoder(filter.table).decode(numbers, averaged=averaged)
    assert decoded.depth_m.shape == (3, 30, 40)


def test_options_override_a_strength(camera):
    light = ts.Filter(code, camera, strength="light").options
    assert (light["windows"], light["slope_rounds"]) == (1, 0)
    changed = ts.Filter(code, camera, strength="light", options={"slope_rounds": 1}).options
    assert changed == {**light, "slope_rounds": 1}


@pytest.mark.parametrize("averaged, words", [
    (np.ones((40, 30)), r"averaged: got shape \(40, 30\); needs shape \(30, 40\)"),
    (np.zeros((30, 40)), "averaged: got 0; needs finite numbers > 0"),
])
def test_rejects_invalid_counts(camera, raw, averaged, words):
    with pytest.raises(ValueError, match=words):
        ts.Decoder(code, camera).decode(raw[0], averaged=averaged)


def test_filtering_can_be_stopped(camera, raw):
    with pytest.raises(ts.Interrupted):
        ts.Filter(code, camera).apply(raw, progress=lambda share, step: False)


def test_time_filter_accepts_single_frames_and_stacks(camera, raw):
    filter = ts.TimeFilter(code, camera)
    numbers, averaged = filter.add(raw)
    assert (numbers.shape, averaged.shape) == (raw.shape, raw.shape[:3])
    filter.forget()
    planar = filter.add(np.moveaxis(raw[:2], 3, 1), layout="planar")
    rest = filter.add(raw[2])
    assert planar[0].tobytes() == numbers[:2].tobytes()
    assert rest[0].tobytes() == numbers[2].tobytes() and rest[1].tobytes() == averaged[2].tobytes()
    filter.forget()
    assert np.median(filter.add(raw[0], averaged=np.full((30, 40), 3))[1]) == 3
    with pytest.raises(ValueError, match="raw width = 20; must equal that of the previous frames, 40"):
        filter.add(raw[0, :, :20])


def test_look_ahead_returns_the_last_frames_at_the_end(camera, raw):
    filter = ts.TimeFilter(code, camera, look_ahead=2)
    first = filter.add(raw[:2])
    assert (first[0].shape, first[1].shape) == ((0, 0, 0, 4), (0, 0, 0))
    one = filter.add(raw[2])
    assert (one[0].shape, one[1].shape) == ((1, 30, 40, 4), (1, 30, 40))
    assert len(filter.end()[0]) == 2 and len(filter.end()[0]) == 0
    with pytest.raises(ValueError, match="look_ahead"):
        ts.TimeFilter(code, camera, look_ahead=-1)
