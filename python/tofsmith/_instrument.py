# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Codes on waveform generators in the network; see docs/instruments.md."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import Progress
from ._code import CodeLike, code_of


@dataclass(frozen=True)
class GeneratorModel:
    """What a generator can do, as its data sheet says; what it answers decides.

    Attributes
    ----------
    name, vendor : str
    format : str
        Of waveform_formats(), whose points it takes.
    channels, min_points, max_points : int
    memories : int
        Tables at a time; 0: as many as fit.
    sample_rate_hz, max_repetition_hz, true_arb_rate_hz : float
        Most points per second, repetitions of a table per second (0: as the rate allows), and
        points per second that are all played (0: it cannot).
    min_vpp, max_vpp : float
        Into 50 ohm [V].
    """

    name: str
    vendor: str
    format: str
    channels: int
    sample_rate_hz: float
    max_repetition_hz: float
    true_arb_rate_hz: float
    min_points: int
    max_points: int
    memories: int
    min_vpp: float
    max_vpp: float


@dataclass(frozen=True)
class UploadChannel:
    """What a channel of a generator is given.

    Attributes
    ----------
    channel : int
    arm : str
        light or sensor.
    plays : str
        Name of the table that is played.
    stored : list of str
        Those in its memory.
    points, periods : int
        Of the table that is played.
    sample_rate_hz, repetition_hz, low_v, high_v : float
    """

    channel: int
    arm: str
    plays: str
    stored: list[str]
    points: int
    periods: int
    sample_rate_hz: float
    repetition_hz: float
    low_v: float
    high_v: float


@dataclass(frozen=True)
class UploadMessage:
    """A message to a generator: what it is for, its text, and the bytes behind it."""

    what: str
    message: str
    data: bytes


@dataclass(frozen=True)
class UploadScript:
    """Everything that is said to a generator for one upload, in order; str() is the text that
    `tofsmith upload --dry-run` prints.

    Attributes
    ----------
    model : str
    messages : list of UploadMessage
    channels : list of UploadChannel
    outputs_off : list of str
        Messages that make it safe.
    cannot_be_read_back : list of str
        What no answer confirms.
    text : str
    """

    model: str
    messages: list[UploadMessage]
    channels: list[UploadChannel]
    outputs_off: list[str]
    cannot_be_read_back: list[str]
    text: str

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True)
class ReadBackNumber:
    """A number that the instrument reads back, beside the one requested; channel 0: of none."""

    channel: int
    quantity: str
    requested: float
    read_back: float


@dataclass(frozen=True)
class UploadReport:
    """What an upload did.

    Attributes
    ----------
    address, vendor, model, serial, firmware : str
        Of the instrument, as it says.
    treated_as : str
        The GeneratorModel.
    verified : bool
        All points and settings were read back and are as requested.
    message : str
        One line, with what could not be read back.
    channels : list of UploadChannel
    numbers : list of ReadBackNumber
    steps : list of (what, sent, answer)
    """

    address: str
    vendor: str
    model: str
    serial: str
    firmware: str
    treated_as: str
    verified: bool
    message: str
    channels: list[UploadChannel]
    numbers: list[ReadBackNumber]
    steps: list[tuple[str, str, str]]


def generator_models() -> list[GeneratorModel]:
    """All models that upload() knows."""
    return [GeneratorModel(**values) for values in _tofsmith.generator_models()]


def upload_script(
    code: CodeLike, camera: CameraLike, model: str, **options: Any
) -> UploadScript:
    """What upload() would send to a model; connects to nothing.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    model : str
        One of generator_models().
    **options
        As of upload().

    Raises
    ------
    ValueError
        Naming what does not fit the model: points, rate, volts, channels.
    """
    camera = camera_of(camera)
    values = _tofsmith.upload_script(
        code_of(code, camera)._handle, camera._handle, _check.text(model, "model"), options
    )
    values["messages"] = [UploadMessage(**message) for message in values["messages"]]
    values["channels"] = [UploadChannel(**channel) for channel in values["channels"]]
    return UploadScript(**values)


def upload(
    code: CodeLike,
    camera: CameraLike,
    address: str,
    *,
    model: Optional[str] = None,
    timeout_s: float = 5.0,
    progress: Progress = None,
    **options: Any,
) -> UploadReport:
    """Plays a code on a generator in the network: loads it, sets it, reads it back and compares.
    Outputs stay off unless `output_on=True`. Tested on simulated instruments only.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    address : str
        host, host:port, tcp://host:port, vxi11://host or TCPIP::host::port::SOCKET (port 5025).
    model : str, optional
        Treat the instrument as this one of generator_models(); None: as it says.
    timeout_s : float
        Longest wait for an answer [s].
    progress : callable, optional
        When it stops the work, outputs are switched off.
    **options
        light_channel (1), sensor_channel (2; 0: none), exposure (1), tap (1), all (False: one
        pair); load_ohm (50), output_on (False), read_back (True), reset (True), true_arb (False),
        wave_header ("length"), settle_s (0.5), patience_s (20), filter ("step"); tables, a dict of
        options of export_waveforms(), such as {"samples": 500, "low_v": 0, "high_v": 2}.

    Raises
    ------
    ValueError
        For options that break a rule, or what does not fit the model.
    OSError
        Naming the instrument, the step, what was sent, what came and what was expected.
    """
    camera = camera_of(camera)
    seconds = _check.number(timeout_s, "timeout_s")
    if not 0 < seconds <= 3600:
        raise ValueError(f"timeout_s: got {seconds:g}; needs a number in (0, 3600]")
    values = _tofsmith.upload(
        code_of(code, camera)._handle,
        camera._handle,
        _check.text(address, "address"),
        None if model is None else _check.text(model, "model"),
        seconds,
        options,
        _check.progress(progress),
    )
    values["channels"] = [UploadChannel(**channel) for channel in values["channels"]]
    values["numbers"] = [ReadBackNumber(**number) for number in values["numbers"]]
    return UploadReport(**values)
