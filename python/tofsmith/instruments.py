# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Uploads codes to waveform generators through PyVISA; see docs/instruments.md.

On Debian: ``apt install python3-pyvisa python3-pyvisa-py``. Required by upload() only.
"""

from __future__ import annotations

import functools
import re
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, NoReturn, Optional, Union, Unpack

from . import _check, _tofsmith
from ._camera import CameraLike
from ._check import Progress
from ._code import CodeLike, handles_of
from ._option_fields import ExportOptions, UploadOptions
from ._options import takes
from ._tofsmith import (
    AnswerCheck,
    GeneratorModel,
    Interrupted,
    UploadChannel,
    UploadScript,
    UploadStep,
    generator_models,
)
from ._visa_session import MESSAGE_BYTES, Session, printable


class ReadBackNumber(NamedTuple):
    """A requested number and the number read back from the instrument; channel 0: none."""

    channel: int
    quantity: str
    requested: float
    read_back: float


@dataclass(frozen=True)
class UploadReport:
    """Result of an upload.

    Attributes
    ----------
    address, vendor, model, serial, firmware : str
        VISA resource name, and the instrument's answer to ``*IDN?``.
    treated_as : str
        Name of the GeneratorModel.
    verified : bool
        All points and settings were read back and agree with the request.
    message : str
        One line, including settings that could not be read back.
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


@takes(UploadOptions)
def upload_script(
    code: CodeLike,
    camera: CameraLike,
    model: str,
    *,
    tables: Union[ExportOptions, Mapping[str, Any], None] = None,
    **options: Unpack[UploadOptions],
) -> UploadScript:
    """Returns the messages that upload() would send to a model, without connecting.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    model : str
        Name of one of generator_models().
    tables
        As in upload().
    **options
        As in UploadOptions.

    Raises
    ------
    ValueError
        Naming the points, rate, voltage or channel that the model does not support.
    """
    handles = handles_of(code, camera)
    given: dict[str, Any] = {**options, "tables": None if tables is None else dict(tables)}
    return _tofsmith.upload_script(*handles, _check.text(model, "model"), given)


@takes(UploadOptions)
def upload(
    code: CodeLike,
    camera: CameraLike,
    address: str,
    *,
    model: Optional[str] = None,
    timeout_s: float = 5.0,
    tables: Union[ExportOptions, Mapping[str, Any], None] = None,
    progress: Progress = None,
    **options: Unpack[UploadOptions],
) -> UploadReport:
    """Uploads a code to a generator, configures it, reads points and settings back and compares
    them.

    Outputs stay off unless `output_on=True`, and are switched off after a failure. Tested with
    simulated instruments only.

    Parameters
    ----------
    code : CodeSet, name of a family or file
    camera : Camera or its name
    address : str
        host, host:port or tcp://host:port (a socket; port 5025), vxi11://host, or a VISA resource
        name such as TCPIP::host::4000::SOCKET or USB0::0xF4EC::0x1102::SDG2X::INSTR.
    model : str, optional
        Treats the instrument as this model. None: from its answer to ``*IDN?``.
    timeout_s : float
        Timeout for an answer [s], plus one second per 100 kB of a block.
    progress : callable, optional
        Called before every message; returning False stops the upload.
    tables : dict, optional
        Options of export_waveforms(), such as {"samples": 500, "low_v": 0, "high_v": 2}.
    **options
        As in UploadOptions.

    Raises
    ------
    ValueError
        For an invalid option, or a code that the model does not support.
    OSError
        Naming the instrument, the step, the message sent, and the answers received and expected.
    ImportError
        If PyVISA is not installed.
    """
    resource_name = visa_resource_name(_check.text(address, "address"))
    seconds = _check.number(timeout_s, "timeout_s")
    if not 0 < seconds <= 3600:
        raise ValueError(f"timeout_s: got {seconds:g}; needs a number in (0, 3600]")
    progress = _check.progress(progress)
    to_script = functools.partial(upload_script, code, camera, tables=tables, **options)
    script = None if model is None else to_script(model)
    session = Session(resource_name, seconds)
    try:
        identity = session.identify()
        if script is None:
            script = to_script(_identified(identity, session))
        steps, numbers = _send(session, script, progress)
    finally:
        session.close()
    message = ("all points and settings read back and equal" if script.reads_back else
               "unverified: settings read back and equal, points not read back")
    if script.cannot_be_read_back:
        message += f"; nothing confirms {', '.join(script.cannot_be_read_back)}"
    vendor, name, serial, firmware = identity
    return UploadReport(resource_name, vendor, name, serial, firmware, script.model.name,
                        script.reads_back, message, script.channels, numbers, steps)


def visa_resource_name(address: str) -> str:
    """Returns the VISA resource name of an address that upload() accepts.

    Raises
    ------
    ValueError
        For other texts.
    """
    if re.match(r"(TCPIP|USB|GPIB|ASRL|VXI|PXI)[\w/.-]*::\S", address, re.IGNORECASE | re.ASCII):
        return address
    if found := re.fullmatch(r"vxi11://(\w[\w.-]*)", address, re.ASCII):
        return f"TCPIP::{found[1]}::INSTR"
    found = re.fullmatch(r"(?:tcp://)?(\w[\w.-]*)(?::(\d{1,5}))?", address, re.ASCII)
    if found and 1 <= int(found[2] or 5025) <= 65535:
        return f"TCPIP::{found[1]}::{found[2] or 5025}::SOCKET"
    raise ValueError(
        f"address: got '{address}'; needs host, host:port, tcp://host:port, vxi11://host or a VISA "
        "resource name such as TCPIP::host::5025::SOCKET"
    )


def _identified(identity: Sequence[str], session: Session) -> str:
    """Returns the name of the supported model of an instrument."""
    vendor, name = identity[:2]
    try:
        model = _tofsmith.generator_model(name)
    except ValueError as error:
        session.fail(f"found the instrument {name} of {vendor}: {error} (--model NAME treats a "
                     "similar instrument as a supported one)")
    expected = (model.vendor, "Agilent" if model.vendor.startswith("Keysight") else model.vendor)
    if vendor[:7].lower() not in [known[:7].lower() for known in expected]:
        session.fail(f"found the instrument {name} of {vendor}; expected {name} of {model.vendor}")
    return model.name


def _send(
    session: Session, script: UploadScript, progress: Progress
) -> tuple[list[tuple[str, str, str]], list[ReadBackNumber]]:
    """Sends all messages. Switches the outputs off after a failure or an interrupt."""
    done: list[tuple[str, str, str]] = []
    numbers: list[ReadBackNumber] = []
    steps = script.steps
    may_be_on = False
    try:
        _clear_errors(session, script)
        for index, step in enumerate(steps):
            _report(progress, index / len(steps), step.what)
            may_be_on = may_be_on or step.switches_on
            line_end = b"\n" if step.line_end else b""
            session.send(step.message.encode() + step.data + line_end)
            time.sleep(step.pause_s)
            sent = step.message + (f"<{len(step.data)} bytes>" if step.data else "")
            done.append((step.what, sent, _answer(session, script, step, numbers)))
        session.expect_silence()
        _report(progress, 1.0, "done")
    except BaseException as error:
        try:
            for message in script.outputs_off:
                session.send_regardless(message.encode() + b"\n")
        except OSError:
            if may_be_on and isinstance(error, OSError):
                raise OSError(f"{error} OUTPUTS MAY BE ON: check the instrument") from None
        raise
    return done, numbers


def _report(progress: Progress, fraction: float, step: str) -> None:
    if progress is not None and progress(fraction, step) is False:
        raise Interrupted()


def _is_no_error(answer: str) -> bool:
    return re.match(r"[+-]?0,", answer) is not None


def _clear_errors(session: Session, script: UploadScript) -> None:
    session.send(b"*CLS\n")
    if not script.model.has_error_queue:
        return
    for _ in range(64):
        session.send(b"SYST:ERR?\n")
        if _is_no_error(session.read_line()):
            return
    session.fail("the error queue does not end; switch the instrument off and on")


def _answer(session: Session, script: UploadScript, step: UploadStep,
            numbers: list[ReadBackNumber]) -> str:
    """Reads and checks the answer to a message and returns it as text."""
    line, data, difference = "", b"", ""
    if step.answer == "none":
        if script.model.has_error_queue:
            session.send(b"SYST:ERR?\n")
            error = session.read_line(step.more_s)
            if not _is_no_error(error):
                _fail(session, step, f"the instrument reports the error {printable(error, 200)}")
        return ""
    if step.answer == "line":
        line = session.read_line(step.more_s)
    elif step.answer == "wave_data":
        line, data = session.read_wave_data(len(step.expected), step.more_s)
        difference = _difference(data, step.expected, "byte")
    elif step.answer == "block":
        data = session.read_block(len(step.expected) + MESSAGE_BYTES, step.more_s)
        difference = _difference(data, step.expected, "byte")
    else:
        expected = step.expected.split()
        data = session.read_block(4096 + 16 * len(expected), step.more_s)
        difference = _difference(data.partition(b"\nData:")[2].split(), expected, "point")
    for check in step.checks:
        number, problem = _checked(line, check)
        if problem:
            _fail(session, step, problem)
        if number is not None and check.quantity:
            numbers.append(ReadBackNumber(check.channel, check.quantity, check.wanted, number))
    if difference:
        _fail(session, step, f"the waveform in the instrument differs from the one sent: {difference}. "
              "No output is active; try again (--no-read-back skips this check)")
    return f"<{len(data)} bytes>" if data else printable(line, 200)


def _fail(session: Session, step: UploadStep, problem: str) -> NoReturn:
    raise OSError(f"{session.name}: {step.what}: sent '{step.message}': {problem}")


def _difference(found: Sequence[Any], expected: Sequence[Any], unit: str) -> str:
    """Returns the first difference, or an empty text."""
    if found == expected:
        return ""
    if len(found) != len(expected):
        return f"found {len(found)} {unit}s; expected {len(expected)}"
    index = next(i for i, (a, b) in enumerate(zip(found, expected)) if a != b)
    return f"found {found[index]!r:.20} at {unit} {index}; expected {expected[index]!r}"


def _checked(line: str, check: AnswerCheck) -> tuple[Optional[float], str]:
    """Returns the number in an answer, if any, and a description of an error."""
    answer = line.upper().replace('"', "")
    # "C1:BSWV WVTP,ARB,FRQ,1000HZ" contains keys and values; "C1:OUTP ON,LOAD,50" an extra word.
    words = [word.strip() for word in (answer.partition(" ")[2] or answer).split(",")]
    found: Optional[str] = answer
    if check.field:
        found = next((b for a, b in zip(words, words[1:]) if a == check.field), None)
    elif ":OUTP " in answer:
        found = words[0]
    what = f"channel {check.channel} {check.quantity}: " if check.channel else ""
    key = f"{check.field} " if check.field else ""
    expected = key + (" or ".join(check.texts) or f"the number {check.wanted:.9g}")
    problem = f"{what}found '{printable(found or answer, 200)}'; expected {expected}"
    if found is None:
        return None, problem
    if check.texts:
        is_found = any(text in found if check.within else text == found for text in check.texts)
        return None, "" if is_found else problem
    number = re.fullmatch(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:E[+-]?\d+)?)(HZ|VPP|V|SA/S|S|OHM|DEG)?", found,
                          re.ASCII)
    if not number:
        return None, problem
    if not abs(float(number[1]) - check.wanted) <= check.tolerance:
        return None, problem + ", as sent: the instrument does not accept this value"
    return float(number[1]), ""
