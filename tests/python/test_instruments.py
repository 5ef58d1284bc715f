# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Uploads through PyVISA to simulated generators on the loopback interface, with faults and hostile
answers."""

import random
import re
import socket
import subprocess
import sys
import threading
import time
import tracemalloc
from pathlib import Path

import pytest

import tofsmith as ts
from tofsmith import instruments

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from simulated_generator import FAULTS, SimulatedGenerator  # noqa: E402

MODELS = {"siglent": "SDG2042X", "keysight": "33522B", "tektronix": "AFG3022C"}
FAMILIES = list(MODELS)
#: 64 points at 240 MHz, without pauses.
QUICK = {"tables": {"samples": 16, "periods": 4}, "settle_s": 0, "patience_s": 0}
TARGET = ("hamiltonian-k3", "paper-10f0")


def generator(family, *fault):
    return SimulatedGenerator(family, MODELS[family], *fault)


def upload(address, timeout_s=5.0, progress=None, camera=TARGET[1], **options):
    pytest.importorskip("pyvisa_py", reason="pyvisa-py is not installed")
    return instruments.upload(TARGET[0], camera, address, timeout_s=timeout_s, progress=progress,
                              **QUICK | options)


def sent_points(script, channel):
    """Returns the bytes of the table of a script's channel."""
    (data,) = [s.data for s in script.steps if s.what == f"load {channel.waveform}"]
    return data[2 + int(data[1:2]):] if data[:1] == b"#" else data


def generates(simulated, report, script, output_on):
    """Returns whether a simulated generator outputs the requested waveforms."""
    for channel in report.channels:
        n = channel.channel
        keys = {"siglent": ("C{}:BSWV AMP", "C{}:BSWV OFST", "C{}:BSWV FRQ", "C{}:OUTP LOAD"),
                "keysight": ("SOUR{}:VOLT", "SOUR{}:VOLT:OFFS", "SOUR{}:FUNC:ARB:SRAT", "OUTP{}:LOAD"),
                "tektronix": ("SOUR{}:VOLT:AMPL", "SOUR{}:VOLT:OFFS", "SOUR{}:FREQ", "OUTP{}:IMP")}
        found = [simulated.number(key.format(n)) for key in keys[simulated.family]]
        rate_hz = channel.sample_rate_hz if simulated.family == "keysight" else channel.repetition_hz
        wanted = [channel.high_v - channel.low_v, (channel.high_v + channel.low_v) / 2, rate_hz, 50]
        tolerances = [2e-3, 2e-3, 2e-5 * rate_hz, 1]
        if any(abs(a - b) > t for a, b, t in zip(found, wanted, tolerances)):
            return False
        if simulated.is_on(n) != output_on or simulated.played(n) != sent_points(script, channel):
            return False
    return simulated.phases_locked or simulated.family != "siglent"  # other families do not confirm
                                                                     # it


@pytest.mark.parametrize("output_on", [False, True])
@pytest.mark.parametrize("family", FAMILIES)
def test_every_family_outputs_what_was_sent(family, output_on):
    fractions = []
    options = {"output_on": output_on, "exposure": 2, "all": family != "tektronix"}
    with generator(family) as simulated:
        report = upload(simulated.address, progress=lambda f, step: fractions.append(f), **options)
    assert report.verified and "equal" in report.message
    assert report.address == f"TCPIP::127.0.0.1::{simulated.address[10:]}::SOCKET"
    assert (report.model, report.treated_as) == (MODELS[family], MODELS[family].rstrip("BC"))
    assert [channel.waveform for channel in report.channels] == ["modulation_2", "demodulation_2"]
    script = instruments.upload_script(*TARGET, report.treated_as, **QUICK | options)
    assert generates(simulated, report, script, output_on)
    assert len(simulated.memory) == (3 if family == "tektronix" else 6)
    assert len(report.numbers) > 5
    for number in report.numbers:
        assert abs(number.read_back - number.requested) <= 1e-5 * abs(number.requested) + 1e-3
    assert fractions == sorted(fractions) and fractions[-1] == 1
    assert len(report.steps) == len(script.steps)


def test_siglent_accepts_three_headers_and_its_own_clock():
    for header in ("length", "plain", "minimal"):
        with generator("siglent") as simulated:
            report = upload(simulated.address, wave_header=header)
        script = instruments.upload_script(*TARGET, "SDG2042X", wave_header=header, **QUICK)
        assert report.verified and generates(simulated, report, script, False)
    with generator("siglent") as simulated:
        report = upload(simulated.address, camera=ts.Camera(TARGET[1], fundamental_frequency_hz=1e6),
                        true_arb=True, load_ohm=float("inf"), tables={"samples": 12})
    assert report.verified
    assert simulated.number("C1:SRATE VALUE") == report.channels[0].sample_rate_hz == 12e6
    assert simulated.settings["C1:SRATE MODE"] == "TARB"
    assert simulated.settings["C1:OUTP LOAD"] == "HZ"


@pytest.mark.parametrize("family", FAMILIES)
def test_points_without_read_back_are_unverified(family):
    with generator(family) as simulated:
        report = upload(simulated.address, read_back=False)
    assert not report.verified and report.message.startswith("unverified")
    script = instruments.upload_script(*TARGET, report.treated_as, read_back=False, **QUICK)
    assert generates(simulated, report, script, False)


def outcome(simulated, script, output_on, upload_to_it):
    """Returns "failed", or "verified" if the generator then outputs the requested waveforms."""
    fault = simulated.family, simulated.fault, simulated.fault_message, simulated.detail
    try:
        report = upload_to_it(simulated)
    except OSError as error:
        assert str(error).startswith("TCPIP::127.0.0.1::"), fault
        return "failed"
    assert report.verified and generates(simulated, report, script, output_on), fault
    return "verified"


def random_faults(family, faults, count, upload_to):
    """Returns the outcomes of uploads with one random fault each."""
    choice = random.Random(4)
    scripts = [instruments.upload_script(*TARGET, MODELS[family], output_on=on, **QUICK)
               for on in (False, True)]
    with generator(family) as simulated:
        upload(simulated.address, output_on=True)
    outcomes = []
    for run in range(count):
        at, on = choice.randrange(simulated.messages), run % 2 == 1
        faulty = generator(family, faults[run % len(faults)], at, choice.getrandbits(31))
        outcomes.append(outcome(faulty, scripts[on], on, lambda faulty, on=on: upload_to(faulty, on)))
    return outcomes


@pytest.mark.parametrize("family", FAMILIES)
def test_random_faults_never_verify_a_wrong_waveform(family):
    def upload_to(faulty, on):
        with faulty:
            return upload(faulty.address, timeout_s=0.1, output_on=on)

    faults = FAULTS[FAMILIES.index(family)::len(FAMILIES)]
    random_faults(family, faults, len(faults), upload_to)


class MemorySession(instruments.Session):
    """A connection to a simulated generator without network; answers arrive immediately or never.
    """

    simulated = None

    def __init__(self, resource_name, timeout_s):
        self.name, self.timeout_s, self._is_socket = resource_name, timeout_s, True
        self._received, self._sent, self.answers = bytearray(), "", ""

    def close(self):
        pass

    def send_regardless(self, message):
        if self.simulated.closed:
            self.fail("the connection is closed")
        self.answers += self.simulated.take(message.decode("latin-1"))

    def _receive(self, most, limit_s, line_end=None):
        if self.simulated.closed and not self.answers:
            self.fail("the connection is closed")
        self._received += self.answers.encode("latin-1")
        self.answers = ""


@pytest.mark.parametrize("family", FAMILIES)
def test_300_random_faults_without_network(family, monkeypatch):
    def upload_to(faulty, on):
        with monkeypatch.context() as patch:
            patch.setattr(instruments, "Session", MemorySession)
            patch.setattr(MemorySession, "simulated", faulty)
            return upload("127.0.0.1", timeout_s=0.002, output_on=on)

    outcomes = random_faults(family, FAULTS, 300, upload_to)
    assert outcomes.count("failed") > 150 and outcomes.count("verified") > 10


@pytest.mark.parametrize("fault", ["corrupts_point", "other_value", "answers_garbage",
                                   "swallows_answer", "extra_line"])
@pytest.mark.parametrize("family", FAMILIES)
def test_outputs_are_off_after_a_fault(family, fault):
    with generator(family, fault, 8, 77) as simulated:
        with pytest.raises(OSError):
            upload(simulated.address, timeout_s=0.2, output_on=True)
    assert not simulated.is_on(1) and not simulated.is_on(2)


@pytest.mark.parametrize("family", FAMILIES)
def test_a_stopped_upload_leaves_outputs_off(family):
    def interrupt(fraction, step):
        if fraction > 0.5:
            raise KeyboardInterrupt

    stops = [(ts.Interrupted, lambda fraction, step, at=at: fraction < at) for at in (0, 0.3, 0.98)]
    for error, progress in stops + [(KeyboardInterrupt, interrupt)]:
        with generator(family) as simulated:
            with pytest.raises(error):
                upload(simulated.address, progress=progress, output_on=True)
        assert not simulated.is_on(1) and not simulated.is_on(2)


def test_errors_report_the_step_and_both_messages():
    with generator("keysight", "other_value", 0, 1) as simulated:
        with pytest.raises(OSError, match=re.escape(
                "check channel 1: sent 'OUTP1:LOAD?': channel 1 load_ohm: found "
                "'+5.10000000000000E+01'; expected the number 50, as sent: the instrument does not "
                "accept this value")):
            upload(simulated.address)
    with generator("keysight", "reports_error", 6, 1) as simulated:
        with pytest.raises(OSError, match=re.escape("reports the error -222,\"Data out of range\"")):
            upload(simulated.address)
    for family in FAMILIES:
        with generator(family, "corrupts_point", 0, 9) as simulated:
            with pytest.raises(OSError, match="differs from the one sent: found .*; expected"):
                upload(simulated.address)


class Hostile:
    """An instrument that answers its first messages like a Tektronix and then like `attack`."""

    def __init__(self, attack, answered=0):
        self.attack, self.answered = attack, answered

    def __enter__(self):
        self.server = socket.create_server(("127.0.0.1", 0))
        threading.Thread(target=self.serve, daemon=True).start()
        return f"127.0.0.1:{self.server.getsockname()[1]}"

    def __exit__(self, *ignored):
        self.server.close()

    def serve(self):
        simulated = generator("tektronix")
        connection, _ = self.server.accept()
        with connection:
            try:
                while simulated.messages < self.answered:
                    answer = simulated.take(connection.recv(65536).decode("latin-1"))
                    connection.sendall(answer.encode("latin-1"))
                self.attack(connection)
            except OSError:
                pass


def repeat(piece, pause_s=0.0):
    def attack(connection):
        while True:
            connection.sendall(piece)
            time.sleep(pause_s)
    return attack


def answer(text):
    def attack(connection):
        while connection.recv(65536):
            connection.sendall(text)
    return attack


ATTACKS = {
    "silence": lambda connection: time.sleep(5),
    "closes": lambda connection: None,
    "line without end": repeat(b"x" * 65536),
    "lines without end": repeat(b"0,No error\n" * 1000),
    "line ends without end": repeat(b"\n" * 65536),
    "trickling bytes": repeat(b"x", 0.002),
    "trickling line ends": repeat(b"\n", 0.002),
    "garbage": answer(bytes(range(256)) + b"\n"),
    "huge block": answer(b"#9999999999" + b"x" * 100000),
    "block with a trickling end": lambda connection: (
        connection.recv(65536), connection.sendall(b"#3128"), repeat(b"x", 0.05)(connection)),
    "block without length": answer(b"#0xxxx\n"),
    "errors without end": answer(b'-100,"Command error"\n'),
    "half an answer": answer(b"TEKTRONIX,AFG3"),
}


@pytest.mark.parametrize("answered", [0, 1, 30])  # until *IDN?, *CLS, reading points back
@pytest.mark.parametrize("attack", ATTACKS)
def test_hostile_answers_cause_no_hang_and_bounded_memory(attack, answered):
    with Hostile(ATTACKS[attack], answered) as address:
        tracemalloc.start()
        start = time.monotonic()
        with pytest.raises(OSError, match="TCPIP::127.0.0.1::"):
            upload(address, timeout_s=0.2)
        took_s, (_, peak_bytes) = time.monotonic() - start, tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert took_s < 8
    assert peak_bytes < 20e6


def test_an_instrument_that_accepts_no_data_does_not_block():
    with Hostile(lambda connection: time.sleep(30), 9) as address:
        start = time.monotonic()
        with pytest.raises(OSError, match="does not accept the message in time|within 0.2 s"):
            upload(address, timeout_s=0.2, tables={"samples": 131072}, model="AFG3252")
        assert time.monotonic() - start < 20


def test_rejects_other_and_absent_instruments():
    with SimulatedGenerator("keysight", "34465A") as simulated:
        with pytest.raises(OSError, match="found the instrument 34465A of Keysight"):
            upload(simulated.address)
    assert simulated.is_on(1)  # nothing was changed
    with SimulatedGenerator("tektronix", "SDG2042X") as simulated:
        with pytest.raises(OSError, match="expected SDG2042X of Siglent Technologies"):
            upload(simulated.address)
    with SimulatedGenerator("keysight", "34465A") as simulated:
        assert upload(simulated.address, model="33522").treated_as == "33522"
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    with pytest.raises(OSError, match=f"TCPIP::127.0.0.1::{port}::SOCKET: .*check the address"):
        upload(f"127.0.0.1:{port}", timeout_s=0.5)


def test_addresses_become_visa_resource_names():
    name = instruments.visa_resource_name
    assert name("sdg") == "TCPIP::sdg::5025::SOCKET"
    assert name("10.0.0.7:4000") == name("tcp://10.0.0.7:4000") == "TCPIP::10.0.0.7::4000::SOCKET"
    assert name("tcp://bench-1.local") == "TCPIP::bench-1.local::5025::SOCKET"
    assert name("vxi11://10.0.0.7") == "TCPIP::10.0.0.7::INSTR"
    for visa in ("TCPIP0::10.0.0.7::inst0::INSTR", "USB0::0xF4EC::0x1102::SDG2X::INSTR",
                 "GPIB0::10::INSTR", "ASRL/dev/ttyUSB0::INSTR", "tcpip::h::5025::socket"):
        assert name(visa) == visa
    for bad in ("", ":5025", "host:", "host:0", "host:65536", "host:5025x", "http://host", "tcp://",
                "a b", "-host", "host/5025", "::1", "vxi11://", "vxi11://h:1", "TCPIP::"):
        with pytest.raises(ValueError, match="needs host, host:port"):
            name(bad)


def test_upload_script_equals_the_command(cli):
    more = {"exposure": 2, "tables": {"samples": 12, "low_v": 0, "high_v": 2}}
    options = ["--camera", TARGET[1], "--exposure", "2", "--samples", "12", "--volts", "0,2"]
    for model in ("SDG2042X", "33522", "AFG3252"):
        done = subprocess.run([cli, "upload", TARGET[0], "--dry-run", "--model", model, *options],
                              capture_output=True, text=True, check=True)
        script = instruments.upload_script(*TARGET, model, **more)
        assert str(script) == done.stdout
        assert [c.waveform for c in script.channels] == ["modulation_2", "demodulation_2"]
        assert sum(len(step.data) for step in script.steps) > 0
        assert script.model.name in {m.name for m in instruments.generator_models()}
    whole = instruments.upload_script(*TARGET, "33522", all=True)
    assert [len(channel.stored) for channel in whole.channels] == [3, 3]


def test_missing_pyvisa_is_reported_with_its_package():
    for hidden in ("pyvisa", "pyvisa_py"):
        code = (f"import sys; sys.modules['{hidden}'] = None\n"
                "from tofsmith import instruments\n"
                f"instruments.upload_script(*{TARGET}, '33522', **{QUICK})\n"
                f"try: instruments.upload(*{TARGET}, '127.0.0.1')\n"
                "except ImportError as error: print(error)")
        done = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True)
        assert "apt install python3-pyvisa python3-pyvisa-py" in done.stdout, done.stderr


refusals = [
    ({"model": "SDG1"}, "must be one of"),
    ({"exposre": 1}, "did you mean exposure?"),
    ({"exposure": 9}, "exposure = 9; must be at most 4"),
    ({"light_channel": 0, "sensor_channel": 0}, "sensor_channel = 0"),
    ({"filter": "none"}, "filter = none; must be step, normal or off"),
    ({"tables": {"bits": 99}}, "bits"),
]


@pytest.mark.parametrize("options, message", refusals, ids=[r[1][:30] for r in refusals])
def test_rejects_bad_options_by_name_before_connecting(options, message):
    options = {"model": "33522"} | options
    kind = TypeError if "exposre" in options else ValueError
    with pytest.raises(kind, match=re.escape(message)):
        instruments.upload_script("square-k4", "paper-10f0", **options)
    with pytest.raises(kind, match=re.escape(message)):
        instruments.upload("square-k4", "paper-10f0", "127.0.0.1:1", **options)


def test_rejects_bad_arguments_by_name():
    for arguments, message in (({"address": "http://x"}, "tcp://host:port"),
                               ({"address": "x", "timeout_s": 0}, "timeout_s: got 0; needs a number")):
        with pytest.raises(ValueError, match=re.escape(message)):
            instruments.upload("square-k4", "paper-10f0", **arguments)
