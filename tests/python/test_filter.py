# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Measurements of the same depth may be added: what the filter gives is what decoders take."""

import numpy as np
import pytest

import tofsmith as ts

code = "hamiltonian-k4"


@pytest.fixture(scope="module")
def raw(camera):
    return ts.capture(ts.built_in_scene("table-top", 40, 30), code, camera, signal_e_per_s=1e5,
                      ambient_e_per_s=1e4, seed=5, frames=3)


def test_filtered_numbers_are_decoded_with_their_noise(camera, raw):
    decoder = ts.Decoder(code, camera)
    numbers, averaged = ts.Filter(code, camera).apply(raw[0])
    assert (numbers.shape, numbers.dtype) == (raw[0].shape, np.float32)
    assert (averaged.shape, averaged.dtype) == (raw[0].shape[:2], np.float32)
    assert np.median(averaged) > 10
    alone, filtered = decoder.decode(raw[0]), decoder.decode(numbers, averaged=averaged)
    gain = (alone.predicted_standard_deviation_m / filtered.predicted_standard_deviation_m) ** 2
    assert np.nanmedian(gain / averaged) == pytest.approx(1, abs=0.2)
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


def test_means_count_as_what_they_are_the_mean_of(camera, raw):
    filter = ts.Filter(code, camera, strength="light")
    mean = raw.mean(axis=0, dtype=np.float64).astype(np.float32)
    single = filter.apply(raw[0])[1]
    of_three = filter.apply(mean, averaged=np.full(mean.shape[:2], 3))[1]
    assert of_three.mean() == pytest.approx(3 * single.mean(), rel=0.3)
    with pytest.raises(ValueError, match="averaged"):
        filter.apply(mean, averaged=np.zeros(mean.shape[:2]))
    np.testing.assert_array_equal(filter.apply(mean, averaged=3.0)[1], of_three)
    with pytest.raises(ValueError, match=r"averaged.*\(H, W\)"):
        filter.apply(mean, averaged=[3.0])


def test_options_take_the_place_of_a_strength_s(camera):
    light = ts.Filter(code, camera, strength="light").options
    assert (light["windows"], light["slope_rounds"]) == (1, 0)
    changed = ts.Filter(code, camera, strength="light", options={"slope_rounds": 1}).options
    assert changed == {**light, "slope_rounds": 1}


def test_pixels_that_cannot_be_used_stay_as_they_are(camera):
    raw = np.full((20, 20, 4), 1000, np.float32)
    raw[5, 6, 2] = np.nan
    numbers, averaged = ts.Filter(code, camera).apply(raw)
    assert np.isnan(numbers[5, 6]).tolist() == [False, False, True, False]
    assert averaged[5, 6] == 1
    assert np.isfinite(np.delete(numbers.reshape(-1, 4), 5 * 20 + 6, axis=0)).all()


def test_means_by_hand_are_decoded_with_their_noise(camera, raw):
    decoder = ts.Decoder(code, camera)
    mean = raw.mean(axis=0, dtype=np.float64)
    single = decoder.decode(mean).predicted_standard_deviation_m
    threefold = decoder.decode(mean, averaged=np.full((30, 40), 3)).predicted_standard_deviation_m
    assert np.nanmax(np.abs(single / threefold / np.sqrt(3) - 1)) < 1e-2


@pytest.mark.parametrize("averaged, words", [
    (np.ones((40, 30)), r"averaged: got shape \(40, 30\); needs shape \(30, 40\)"),
    (np.zeros((30, 40)), "averaged: got 0; needs finite numbers > 0"),
])
def test_counts_that_cannot_be_are_refused(camera, raw, averaged, words):
    with pytest.raises(ValueError, match=words):
        ts.Decoder(code, camera).decode(raw[0], averaged=averaged)


def test_filtering_can_be_stopped(camera, raw):
    with pytest.raises(ts.Interrupted):
        ts.Filter(code, camera).apply(raw, progress=lambda share, step: False)


def test_static_scenes_add_up_over_frames(camera):
    scene = ts.built_in_scene("table-top", 40, 30)
    raw = ts.capture(scene, code, camera, signal_e_per_s=1e5, ambient_e_per_s=1e4, seed=5, frames=16)
    filter = ts.TimeFilter(code, camera)
    numbers, averaged = filter.add(raw)
    assert (numbers.shape, averaged.shape) == (raw.shape, raw.shape[:3])
    assert numbers[0].tobytes() == raw[0].astype(np.float32).tobytes()
    assert [np.median(n) for n in averaged[:3]] == pytest.approx([1, 2, 3], abs=0.01)
    assert averaged[15].mean() > 15.5
    filter.forget()
    planar = filter.add(np.moveaxis(raw[:8], 3, 1), layout="planar")
    rest = [filter.add(frame) for frame in raw[8:]]
    assert planar[0].tobytes() == numbers[:8].tobytes()
    assert rest[-1][0].tobytes() == numbers[15].tobytes()
    assert rest[-1][1].tobytes() == averaged[15].tobytes()
    in_space = ts.Filter(code, camera, strength="light")
    both = in_space.apply(numbers[15], averaged=averaged[15])[1]
    assert both.mean() > 8 * in_space.apply(raw[15])[1].mean()
    filter.forget()
    assert np.median(filter.add(raw[0], averaged=np.full((30, 40), 3))[1]) == 3
    assert np.median(filter.add(raw[1])[1]) == pytest.approx(4)
    with pytest.raises(ValueError, match="raw width = 20; must equal that of the frames before, 40"):
        filter.add(raw[0, :, :20])


def test_looking_ahead_adds_later_frames_and_gives_the_last_at_the_end(camera):
    scene = ts.built_in_scene("table-top", 40, 30)
    raw = ts.capture(scene, code, camera, signal_e_per_s=1e5, ambient_e_per_s=1e4, seed=5, frames=6)
    filter = ts.TimeFilter(code, camera, look_ahead=2)
    first = filter.add(raw[:2])
    assert (first[0].shape, first[1].shape) == ((0, 0, 0, 4), (0, 0, 0))
    one = filter.add(raw[2])
    assert (one[0].shape, one[1].shape) == ((1, 30, 40, 4), (1, 30, 40))
    assert np.median(one[1]) == pytest.approx(3, abs=0.01)
    middle, rest = filter.add(raw[3:]), filter.end()
    assert (len(middle[0]), len(rest[0])) == (3, 2)
    assert filter.end()[0].shape[0] == 0
    numbers = np.concatenate([one[0], middle[0], rest[0]])
    both_ways = ts.TimeFilter(code, camera, look_ahead=9)
    both_ways.add(raw)
    forwards = both_ways.end()
    both_ways.add(raw[::-1])
    backwards = both_ways.end()
    for there, back in zip(forwards, backwards):
        assert there.tobytes() == back[::-1].tobytes()
    assert np.median(forwards[1]) == pytest.approx(6, abs=0.05)
    # From frame 3 on two later frames are all that there are.
    assert numbers[:3].tobytes() != forwards[0][:3].tobytes()
    assert numbers[3:].tobytes() == forwards[0][3:].tobytes()
    with pytest.raises(ValueError, match="look_ahead"):
        ts.TimeFilter(code, camera, look_ahead=-1)
