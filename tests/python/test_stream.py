# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Frames of a stream decode like frames of files."""

import io
import os
import threading

import numpy as np
import pytest

import tofsmith as ts

frames, height, width = 3, 6, 5
raw = np.random.default_rng(5).poisson(600, (frames, height, width, 4)).astype("<u2")


@pytest.fixture
def decoder():
    return ts.Decoder("hamiltonian-k4", "paper-10f0")


@pytest.fixture
def layout(tmp_path):
    path = tmp_path / "s.raw.toml"
    path.write_text(f"width = {width}\nheight = {height}\nmeasurements = 4\nbits = 16\n"
                    'layout = "interleaved"\n')
    return path


class Read:
    """A stream that supports only read() and returns partial data."""

    def __init__(self, data):
        self.data = io.BytesIO(data)

    def read(self, count):
        return self.data.read(min(count, 7))


def test_frames_equal_those_of_the_decoder(decoder, layout):
    whole = decoder.decode(raw)
    for source in (io.BytesIO(raw.tobytes()), Read(raw.tobytes())):
        taken = []
        done = decoder.decode_stream(source, taken.append, raw_format=layout,
                                     outputs=["depth", "status", "bin"])
        assert (done.frames, done.height, done.width) == (frames, height, width)
        assert sum(done.statuses.values()) == raw[..., 0].size
        assert np.array_equal(np.stack([t["depth"] for t in taken]), whole.depth_m, equal_nan=True)
        assert np.array_equal(np.stack([t["status"] for t in taken]), whole.status)
        assert taken[0]["bin"].dtype == np.int32


def test_file_objects_receive_the_bytes_of_the_command(decoder, layout, tmp_path):
    (tmp_path / "dump.bin").write_bytes(raw.tobytes())
    options = {"raw_format": layout, "filter": "normal", "offset_m": 0.25, "kind": "z",
               "view_deg": 60}
    sink = io.BytesIO()
    decoder.decode_stream(io.BytesIO(raw.tobytes()), sink, **options)
    decoder.decode_recording(tmp_path / "dump.bin", tmp_path / "d.npy", stack=True, **options)
    assert sink.getvalue() == np.load(tmp_path / "d.npy").tobytes()


def test_sliding_windows_are_those_of_recordings(decoder, layout, tmp_path):
    (tmp_path / "dump.bin").write_bytes(raw.tobytes())
    taken = []
    done = decoder.decode_stream(io.BytesIO(raw.tobytes()), taken.append, raw_format=layout,
                                 outputs=["depth"], sliding=True)
    assert done.frames == (frames - 1) * 4 + 1
    decoder.decode_recording(tmp_path / "dump.bin", tmp_path / "d.npy", stack=True,
                             raw_format=layout, sliding=True)
    assert np.array_equal(np.stack([t["depth"] for t in taken]), np.load(tmp_path / "d.npy"),
                          equal_nan=True)


def test_each_frame_is_returned_before_the_next_is_read(decoder, layout):
    """Simulates a camera that sends a frame only after the previous one was decoded."""
    read_end, write_end = os.pipe()
    came = threading.Semaphore(1)

    def send():
        with os.fdopen(write_end, "wb", buffering=0) as camera:
            for frame in raw:
                assert came.acquire(timeout=60)
                camera.write(frame.tobytes())

    sender = threading.Thread(target=send)
    sender.start()
    with os.fdopen(read_end, "rb") as source:
        done = decoder.decode_stream(source, lambda planes: came.release(), raw_format=layout)
    sender.join()
    assert done.frames == frames


def test_exposures_are_read_in_whole_groups(decoder, layout):
    taken = []
    decoder.decode_stream(io.BytesIO(raw.tobytes()), taken.append, raw_format=layout, hdr=(1, 2, 4))
    numbers, averaged = ts.merge_exposures(raw, (1, 2, 4), "hamiltonian-k4", "paper-10f0")
    whole = decoder.decode(numbers, averaged=averaged)
    assert np.array_equal(taken[0]["depth"], whole.depth_m, equal_nan=True)
    with pytest.raises(OSError, match="found 1 frame and the end; expected 2"):
        decoder.decode_stream(io.BytesIO(raw.tobytes()), taken.append, raw_format=layout,
                              hdr=(1, 2))
    assert len(taken) == 2


def test_false_stops(decoder, layout):
    done = decoder.decode_stream(io.BytesIO(raw.tobytes()), lambda planes: False,
                                 raw_format=layout)
    assert done.frames == 1


class Wrong(io.RawIOBase):
    def __init__(self, count):
        self.count = count

    def readable(self):
        return True

    def readinto(self, buffer):
        return self.count


def failing(planes):
    raise LookupError("of the sink")


@pytest.mark.parametrize("source, sink, error, text", [
    (io.BytesIO(raw.tobytes()[:-3]), print, OSError, "frame 2, counted from 0"),
    (io.BytesIO(b""), print, OSError, "found 0 bytes and the end"),
    (Wrong(None), print, ValueError, "source: got None"),
    (Wrong(10**6), print, ValueError, "source: got 1000000 bytes"),
    (io.StringIO("a" * 10000), print, ValueError, "needs bytes"),
    (3, print, TypeError, "source: got int 3"),
    (io.BytesIO(raw.tobytes()), 3, TypeError, "sink: got int 3"),
    (io.BytesIO(raw.tobytes()), failing, LookupError, "of the sink"),
])
def test_read_and_write_errors_are_reported(decoder, layout, source, sink, error, text):
    with pytest.raises(error) as caught:
        decoder.decode_stream(source, sink, raw_format=layout)
    assert text in str(caught.value)
