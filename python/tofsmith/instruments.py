# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Uploads codes to waveform generators through PyVISA; see docs/instruments.md.

On Debian: ``apt install python3-pyvisa python3-pyvisa-py``. Required by upload() only.
"""

from __future__ import annotations

import functools
import re
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, NoReturn, Optional, Union, Unpack

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import Progress
from ._code import CodeLike, code_of
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

_BLOCK_BYTES_PER_S = 100e3  # added to the timeout of large messages or answers
# Read sockets in short steps of few bytes, so that an instrument which sends single bytes cannot
# exceed the timeout by much.
_SOCKET_STEP_S, _SOCKET_BYTES = 0.01, 1024
_MESSAGE_BYTES = 65536


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
    filter: str = "step",
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
    filter, tables
        As in upload().
    **options
        As in UploadOptions.

    Raises
    ------
    ValueError
        Naming the points, rate, voltage or channel that the model does not support.
    """
    camera = camera_of(camera)
    handle = code_of(code, camera)._handle
    given: dict[str, Any] = {
        **options, "filter": filter, "tables": None if tables is None else dict(tables)}
    return _tofsmith.upload_script(handle, camera._handle, _check.text(model, "model"), given)


@takes(UploadOptions)
def upload(
    code: CodeLike,
    camera: CameraLike,
    address: str,
    *,
    model: Optional[str] = None,
    timeout_s: float = 5.0,
    filter: str = "step",
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
    filter : {"step", "normal", "off"}
        Output filter of Keysight instruments.
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
    to_script = functools.partial(
        upload_script, code, camera, filter=filter, tables=tables, **options)
    script = None if model is None else to_script(model)
    session = _Session(resource_name, seconds)
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


def _printable(data: bytes | str, most: int = 60) -> str:
    text = data.decode("latin-1") if isinstance(data, bytes) else data
    shown = "".join(c if " " <= c <= "~" else f"\\x{ord(c):02x}" for c in text[:most])
    return shown if len(text) <= most else f"{shown}... ({len(text)} bytes)"


@functools.cache
def _visa_library() -> tuple[Any, Any]:
    """Returns PyVISA and its resource manager."""
    try:
        import pyvisa

        return pyvisa, pyvisa.ResourceManager()
    except (ImportError, ValueError) as error:  # ValueError: no VISA library
        raise ImportError(f"uploads need PyVISA ({error}); on Debian: apt install python3-pyvisa "
                          "python3-pyvisa-py") from None


class _Session:
    """Messages to an instrument and its answers, which have a timeout and a size limit."""

    def __init__(self, resource_name: str, timeout_s: float) -> None:
        self.name, self.timeout_s = resource_name, timeout_s
        self._received, self._sent, self._is_stuck = bytearray(), "", False
        self._visa, manager = _visa_library()
        try:
            self._resource = manager.open_resource(
                resource_name, open_timeout=int(timeout_s * 1000) + 1)
        except Exception as error:  # pyvisa-py raises plain Exception
            raise OSError(f"{resource_name}: cannot connect ({error}); check the address and that "
                          "the instrument is on") from None
        self._is_socket = resource_name.upper().endswith("::SOCKET")
        if self._is_socket:  # reads return the bytes that have arrived, even without line end
            attributes = self._visa.constants.ResourceAttribute
            self._resource.set_visa_attribute(attributes.suppress_end_enabled, False)

    def close(self) -> None:
        try:
            self._resource.close()
        except Exception:  # the connection was already broken
            pass

    def fail(self, problem: str) -> NoReturn:
        sent = f"sent '{self._sent}': " if self._sent else ""
        raise OSError(f"{self.name}: {sent}{problem}")

    def send(self, message: bytes) -> None:
        """Sends a message. Fails if there was an unexpected answer before."""
        self.expect_silence()
        self.send_regardless(message)

    def send_regardless(self, message: bytes) -> None:
        self._sent = _printable(message.partition(b"\n")[0])
        problems: list[Exception] = []

        def write() -> None:
            try:
                self._resource.write_raw(message)
            except Exception as error:
                problems.append(error)

        # pyvisa-py writes without timeout and would block if the instrument does not accept data.
        thread = threading.Thread(target=write, daemon=True)
        if not self._is_stuck:
            thread.start()
            thread.join(self.timeout_s + len(message) / _BLOCK_BYTES_PER_S)
            self._is_stuck = thread.is_alive()
        if self._is_stuck:
            self.fail("the instrument does not accept the message in time; is it on?")
        if problems:
            self.fail(f"cannot be sent ({problems[0]}); check the address and that the instrument "
                      "is on")

    def expect_silence(self) -> None:
        if self._is_socket:  # other interfaces deliver answers only on request
            self._receive(_SOCKET_BYTES, 0.0)
        self._received = self._received.lstrip(b"\r\n")
        if self._received:
            self.fail(f"received '{_printable(bytes(self._received))}' without a request; check "
                      "that no other program uses the instrument")

    def identify(self) -> list[str]:
        """Returns vendor, model, serial number and firmware."""
        self.send(b"*IDN?\n")
        answer = self.read_line()
        fields = [field.strip() for field in answer.removeprefix("*IDN ").split(",")]
        if len(fields) < 4 or not fields[0] or not fields[1] or not re.fullmatch(
                r"[ -~]+", answer):
            self.fail(f"found '{_printable(answer)}'; expected vendor, model, serial number and "
                      "firmware; check the address")
        return fields[:4]

    def read_line(self, more_s: float = 0.0) -> str:
        line = self._read(_line_size, "a line of text", more_s, line_end="\n")
        return line.rstrip(b"\r\n ").decode("latin-1")

    def read_block(self, max_bytes: int, more_s: float) -> bytes:
        """Returns the data of a definite-length block of IEEE 488.2."""
        block = self._read(lambda data: _block_size(data, max_bytes), "a block of data", more_s)
        return block[2 + int(block[1:2]):]

    def read_wave_data(self, points_bytes: int, more_s: float) -> tuple[str, bytes]:
        """Returns header and points of a Siglent's answer to WVDT?."""
        answer = self._read(lambda data: _wave_size(data, points_bytes), "a waveform", more_s)
        return answer[:-points_bytes].decode("latin-1"), answer[-points_bytes:]

    def _read(self, size_of: Callable[[bytearray], Optional[int]], expected: str, more_s: float,
              line_end: Optional[str] = None) -> bytes:
        """Receives an answer; size_of returns its size once the beginning is sufficient."""
        start, limit_s = time.monotonic(), self.timeout_s + more_s
        while True:
            self._received = self._received.lstrip(b"\r\n")
            try:
                size = size_of(self._received) if self._received else None
            except ValueError as problem:
                self.fail(f"found '{_printable(bytes(self._received))}'; {problem}")
            if size is not None and size <= len(self._received):
                answer, self._received = bytes(self._received[:size]), self._received[size:]
                return answer
            left_s = start + limit_s + (size or 0) / _BLOCK_BYTES_PER_S - time.monotonic()
            if left_s <= 0:
                found = f"found '{_printable(bytes(self._received))}'" if self._received else "no answer"
                self.fail(f"{found} within {limit_s:g} s; expected {expected}; check that the "
                          "instrument supports SCPI and this command and is still connected "
                          "(--timeout waits longer)")
            self._receive(_MESSAGE_BYTES if size is None else size - len(self._received), left_s,
                          line_end)

    def _receive(self, most: int, limit_s: float, line_end: Optional[str] = None) -> None:
        """Appends bytes that arrive within the time, if any."""
        status = self._visa.constants.StatusCode
        if self._is_socket:
            most, limit_s = min(most, _SOCKET_BYTES), min(limit_s, _SOCKET_STEP_S)
        try:
            if self._resource.read_termination != line_end:
                self._resource.read_termination = line_end
            self._resource.timeout = int(limit_s * 1000)
            with self._resource.ignore_warning(status.success_max_count_read):
                piece, _ = self._resource.visalib.read(self._resource.session, most)
            self._received += piece
        except Exception as error:  # from PyVISA or, for a broken connection, from the socket
            if getattr(error, "error_code", None) != status.error_timeout:
                self.fail(f"the connection failed ({error}); check the address and that the "
                          "instrument is on")


def _line_size(data: bytearray) -> Optional[int]:
    end = data.find(b"\n") + 1
    if not end and len(data) > _MESSAGE_BYTES:
        raise ValueError("expected a line of text")
    return end or None


def _block_size(data: bytearray, max_bytes: int) -> Optional[int]:
    header = re.match(rb"#(?:([1-9])(\d*))?", data)
    if not header or len(data) > 1 and not header[1]:
        raise ValueError("expected a block of data, '#' and its length")
    digits = int(header[1] or 9)
    if len(data) < 2 + digits:
        return None
    length = data[2:2 + digits]
    if not length.isdigit() or int(length) > max_bytes:
        raise ValueError(f"expected a block of at most {max_bytes} bytes")
    return 2 + digits + int(length)


def _wave_size(data: bytearray, points_bytes: int) -> Optional[int]:
    header, mark, _ = data[:1000].partition(b"WAVEDATA,")
    if not mark and (len(data) >= 1000 or b"\n" in data):
        raise ValueError("expected a header that ends with 'WAVEDATA,'")
    length = re.search(rb"LENGTH,\s*(\d{1,9})(K?)", header)
    if mark and length and int(length[1]) * (1024 if length[2] else 1) != points_bytes:
        raise ValueError(f"expected a LENGTH of {points_bytes} bytes")
    return len(header) + len(mark) + points_bytes if mark else None


def _identified(identity: Sequence[str], session: _Session) -> str:
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
    session: _Session, script: UploadScript, progress: Progress
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


def _clear_errors(session: _Session, script: UploadScript) -> None:
    session.send(b"*CLS\n")
    if not script.model.has_error_queue:
        return
    for _ in range(64):
        session.send(b"SYST:ERR?\n")
        if _is_no_error(session.read_line()):
            return
    session.fail("the error queue does not end; switch the instrument off and on")


def _answer(session: _Session, script: UploadScript, step: UploadStep,
            numbers: list[ReadBackNumber]) -> str:
    """Reads and checks the answer to a message and returns it as text."""
    line, data, difference = "", b"", ""
    if step.answer == "none":
        if script.model.has_error_queue:
            session.send(b"SYST:ERR?\n")
            error = session.read_line(step.more_s)
            if not _is_no_error(error):
                _fail(session, step, f"the instrument reports the error {_printable(error, 200)}")
        return ""
    if step.answer == "line":
        line = session.read_line(step.more_s)
    elif step.answer == "wave_data":
        line, data = session.read_wave_data(len(step.expected), step.more_s)
        difference = _difference(data, step.expected, "byte")
    elif step.answer == "block":
        data = session.read_block(len(step.expected) + _MESSAGE_BYTES, step.more_s)
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
    return f"<{len(data)} bytes>" if data else _printable(line, 200)


def _fail(session: _Session, step: UploadStep, problem: str) -> NoReturn:
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
    problem = f"{what}found '{_printable(found or answer, 200)}'; expected {expected}"
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
