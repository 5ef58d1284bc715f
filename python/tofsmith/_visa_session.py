# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Messages to an instrument through PyVISA, and its answers."""

from __future__ import annotations

import functools
import re
import threading
import time
from collections.abc import Callable
from typing import Any, NoReturn, Optional

_BLOCK_BYTES_PER_S = 100e3  # added to the timeout of large messages or answers
# Read sockets in short steps of few bytes, so that an instrument which sends single bytes cannot
# exceed the timeout by much.
_SOCKET_STEP_S, _SOCKET_BYTES = 0.01, 1024
MESSAGE_BYTES = 65536


def printable(data: bytes | str, most: int = 60) -> str:
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


class Session:
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
        self._sent = printable(message.partition(b"\n")[0])
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
            self.fail(f"received '{printable(bytes(self._received))}' without a request; check "
                      "that no other program uses the instrument")

    def identify(self) -> list[str]:
        """Returns vendor, model, serial number and firmware."""
        self.send(b"*IDN?\n")
        answer = self.read_line()
        fields = [field.strip() for field in answer.removeprefix("*IDN ").split(",")]
        if len(fields) < 4 or not fields[0] or not fields[1] or not re.fullmatch(
                r"[ -~]+", answer):
            self.fail(f"found '{printable(answer)}'; expected vendor, model, serial number and "
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
                self.fail(f"found '{printable(bytes(self._received))}'; {problem}")
            if size is not None and size <= len(self._received):
                answer, self._received = bytes(self._received[:size]), self._received[size:]
                return answer
            left_s = start + limit_s + (size or 0) / _BLOCK_BYTES_PER_S - time.monotonic()
            if left_s <= 0:
                found = f"found '{printable(bytes(self._received))}'" if self._received else "no answer"
                self.fail(f"{found} within {limit_s:g} s; expected {expected}; check that the "
                          "instrument supports SCPI and this command and is still connected "
                          "(--timeout waits longer)")
            self._receive(MESSAGE_BYTES if size is None else size - len(self._received), left_s,
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
    if not end and len(data) > MESSAGE_BYTES:
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
