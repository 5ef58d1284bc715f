# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Filtering and decoding on an OpenCL device; skipped without one."""

import io
import pickle

import numpy as np
import pytest

import tofsmith as ts


@pytest.fixture(scope="module")
def decoders():
    """Two decoders, on the CPU and on the first device."""
    try:
        return ts.Decoder("hamiltonian-k4", "paper-10f0"), ts.Decoder(
            "hamiltonian-k4", "paper-10f0", device="0")
    except OSError as error:
        pytest.skip(str(error))


def raw_frames():
    return np.random.default_rng(1).poisson(3000, (2, 30, 40, 4)).astype(np.uint16)


def test_a_device_gives_the_same_planes_as_the_cpu(decoders):
    here, there = decoders
    assert here.device == "cpu" and there.device != "cpu"
    raw = raw_frames()
    expected, found = here.decode(raw), there.decode(raw)
    np.testing.assert_array_equal(found.status, expected.status)
    np.testing.assert_allclose(found.depth_m, expected.depth_m, rtol=2e-6)
    np.testing.assert_array_equal(there.decode(raw, planes=["bin"]).bin,
                                  here.decode(raw, planes=["bin"]).bin)


def test_options_of_recordings_and_streams_reach_a_device(decoders, tmp_path):
    """See tests/gpu/device_test.cpp for other combinations."""
    raw = np.concatenate([raw_frames(), raw_frames()]).astype("<u2")
    np.save(tmp_path / "raw.npy", raw)
    (tmp_path / "s.raw.toml").write_text("width = 40\nheight = 30\nmeasurements = 4\nbits = 16\n"
                                         'layout = "interleaved"\n')
    steps = {"average": 2, "time_filter": {"max_frames": 8}, "filter": "light", "mixed": "label"}
    streamed = [[], []]
    for name, decoder, frames in zip(("here", "there"), decoders, streamed):
        decoder.decode_recording(tmp_path / "raw.npy", tmp_path / f"{name}.npy", stack=True,
                                 outputs=["depth", "averaged"], **steps)
        decoder.decode_stream(io.BytesIO(raw.tobytes()), frames.append, outputs=["depth"],
                              raw_format=tmp_path / "s.raw.toml", **steps)
    for plane in ("", "-averaged"):
        np.testing.assert_allclose(np.load(tmp_path / f"there{plane}.npy"),
                                   np.load(tmp_path / f"here{plane}.npy"), rtol=1e-5)
    assert len(streamed[0]) == len(streamed[1]) == 2
    for expected, found in zip(*streamed):
        np.testing.assert_allclose(found["depth"], expected["depth"], rtol=1e-5)


def test_a_filter_can_use_another_device(decoders):
    here = ts.Filter("hamiltonian-k4", "paper-10f0")
    there = ts.Filter("hamiltonian-k4", "paper-10f0", device="0")
    assert (here.device, there.device) == ("cpu", decoders[1].device)
    raw = raw_frames()
    for found, expected in zip(there.apply(raw, averaged=2.0), here.apply(raw, averaged=2.0)):
        np.testing.assert_allclose(found, expected, rtol=1e-5)
    for decoder in decoders:
        np.testing.assert_allclose(decoder.decode(raw, filter=there).depth_m,
                                   decoders[0].decode(raw, filter=here).depth_m, rtol=1e-5)
    with pytest.raises(OSError, match="expected one of 0 "):
        ts.Filter("hamiltonian-k4", "paper-10f0", device="7000")


def test_a_pickled_decoder_keeps_its_device(decoders):
    there = decoders[1]
    assert pickle.loads(pickle.dumps(there)).device == there.device


def test_rejects_unsupported_devices_and_methods(decoders):
    with pytest.raises(OSError, match="expected one of 0 "):
        ts.Decoder("hamiltonian-k4", "paper-10f0", device="7000")
    with pytest.raises(ValueError, match="must be zncc"):
        ts.Decoder("hamiltonian-k4", "paper-10f0", method="ml", device="0")
    assert ts.Decoder("hamiltonian-k4", "paper-10f0", method="ml", device="auto").device == "cpu"


def test_auto_decodes_with_and_without_a_device():
    raw = raw_frames()
    expected = ts.Decoder("hamiltonian-k4", "paper-10f0").decode(raw)
    found = ts.Decoder("hamiltonian-k4", "paper-10f0", device="auto").decode(raw)
    np.testing.assert_array_equal(found.status, expected.status)
