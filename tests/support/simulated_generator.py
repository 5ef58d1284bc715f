# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated waveform generator on the loopback interface.

It implements the commands of an upload from the manuals, independently of the code under test. Each
fault listed in FAULTS can be triggered once.
"""

import re
import socket
import threading

FAULTS = (
    "closes",            # closes the connection instead of processing a message
    "closes_midway",     # closes the connection in the middle of a message
    "closes_answering",  # closes the connection in the middle of an answer
    "hangs",             # stops processing
    "ignores",           # ignores a message
    "reports_error",     # and ignores the message
    "answers_garbage",
    "flips_answer_bit",
    "flips_bit_sent",    # in a received message
    "loses_byte_sent",   # in a received message
    "wrong_length",      # of a block in an answer
    "corrupts_point",    # of the stored points
    "truncates_points",  # of the stored points
    "other_value",       # stores another value of a setting
    "other_memory",      # stores points under another name
    "extra_line",
    "repeats_answer",
    "swallows_answer",
    "splits_answer",     # into single bytes: correct, only slow
)
VENDORS = {"siglent": "Siglent Technologies", "keysight": "Keysight Technologies",
           "tektronix": "TEKTRONIX"}
NUMBERS = {"keysight": ("FUNC:ARB:SRAT", "VOLT", "VOLT:OFFS", "LOAD"),
           "tektronix": ("FREQ", "VOLT:AMPL", "VOLT:OFFS", "PHAS:ADJ", "IMP")}
WORDS = {"keysight": ("FUNC:ARB", "FUNC:ARB:FILT", "FUNC", "VOLT:UNIT", ""),
         "tektronix": ("FUNC", "VOLT:UNIT", "")}


class SimulatedGenerator:
    """Serves one connection at a time, like many instruments. All text is Latin-1.

    Keys of `settings` are such as "SOUR1:VOLT" or "C1:BSWV AMP". `memory` maps names to points, for
    Keysight prefixed with the channel ("1M1_..."). Outputs are initially on.
    """

    def __init__(self, family, model, fault="", message=0, detail=0):
        self.family, self.model = family, model
        self.fault, self.fault_message, self.detail = fault, message, detail
        self.settings, self.memory, self.files, self.errors = {}, {}, {}, []
        self.messages, self.phases_locked = 0, False
        self.reset(on=True)
        self._received, self.closed, self._hangs, self._stops = "", False, False, False

    def __enter__(self):
        self._server = socket.create_server(("127.0.0.1", 0))
        self._server.settimeout(0.02)
        self.address = f"127.0.0.1:{self._server.getsockname()[1]}"
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *ignored):
        """Waits until all messages sent before the connection was closed are processed."""
        self._stops = True
        self._thread.join(20)
        self._server.close()

    def is_on(self, channel):
        key = f"C{channel}:OUTP" if self.family == "siglent" else f"OUTP{channel}"
        return self.settings[key] == "ON"

    def played(self, channel):
        """Returns the points of a channel as received."""
        n = channel
        if self.family == "siglent":
            arb, name = self.settings[f"C{n}:BSWV WVTP"] == "ARB", self.settings[f"C{n}:ARWV NAME"]
        elif self.family == "keysight":
            arb, name = self.settings[f"SOUR{n}:FUNC"] == "ARB", self.settings[f"SOUR{n}:FUNC:ARB"]
        else:
            name = self.settings[f"SOUR{n}:FUNC"]
            arb = name.startswith("USER")
        return self.memory.get(name, "").encode("latin-1") if arb else b""

    def number(self, key):
        return _number(self.settings.get(key, ""))

    def reset(self, on=False):
        self.memory = {} if self.family == "keysight" else self.memory
        self.phases_locked = False
        output = "ON" if on else "OFF"
        for n in (1, 2):
            if self.family == "siglent":
                self.settings |= {f"C{n}:OUTP": output, f"C{n}:OUTP LOAD": "50",
                                  f"C{n}:BSWV WVTP": "SINE", f"C{n}:ARWV NAME": "",
                                  f"C{n}:SRATE MODE": "DDS"}
                self.settings |= {f"C{n}:BSWV {key}": value for key, value in
                                  {"FRQ": "1000", "AMP": "4", "OFST": "0.5", "PHSE": "0"}.items()}
                continue
            self.settings |= {f"OUTP{n}": output, f"SOUR{n}:FUNC": "SIN", f"SOUR{n}:FUNC:ARB": "",
                              f"SOUR{n}:FUNC:ARB:FILT": "NORM"}
            for key in NUMBERS[self.family]:
                part = "OUTP" if key in ("LOAD", "IMP") else "SOUR"
                self.settings[f"{part}{n}:{key}"] = "50" if part == "OUTP" else "0.5"

    def _serve(self):
        while not self._stops:
            try:
                connection, _ = self._server.accept()
            except TimeoutError:
                continue
            self._received, self.closed = "", False
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            connection.settimeout(0.02)
            with connection:
                try:
                    self._talk(connection)
                except OSError:
                    pass

    def _talk(self, connection):
        while not self.closed:
            try:
                data = connection.recv(65536)
                # Otherwise the next message waits 40 ms for the acknowledgement.
                if hasattr(socket, "TCP_QUICKACK"):  # Linux
                    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_QUICKACK, 1)
            except TimeoutError:
                if self._stops:
                    return
                continue
            if not data:
                return
            answers = self.take(data.decode("latin-1")).encode("latin-1")
            size = 1 if self._strikes("splits_answer") else len(answers) or 1
            for begin in range(0, len(answers), size):
                connection.sendall(answers[begin:begin + size])

    def _strikes(self, fault):
        if self.fault != fault or self.messages < self.fault_message:
            return False
        self.fault = ""
        return True

    def take(self, text):
        """Processes the bytes of a connection; returns the answers."""
        if self._hangs:
            return ""
        at = self.detail % len(text)
        if len(text) > 4 and self._strikes("closes_midway"):
            self.closed, text = True, text[:at]
        elif len(text) > 4 and self._strikes("flips_bit_sent"):
            text = _flipped(text, at, self.detail)
        elif len(text) > 4 and self._strikes("loses_byte_sent"):
            text = text[:at] + text[at + 1:]
        self._received += text
        answers = ""
        while not self._hangs and not self.closed and (message := self._next()) is not None:
            answers += self._answer(message)
            self.messages += 1
        return answers

    def _next(self):
        """Returns the next message if it has arrived completely."""
        text = self._received
        wave = re.match(r"C\d:WVDT .{0,500}?WAVEDATA,", text, re.S)
        if self.family == "siglent" and re.match(r"C\d:WVDT ", text):
            if not wave:
                return None
            length = re.search(r"LENGTH,(\d+)", wave[0])  # if missing: everything received so far
            end = wave.end() + int(length[1]) if length else len(text)
            if len(text) < end:
                return None
            self._received = text[end:]
            return text[:end]
        end = text.find("\n")
        block = re.match(r"[^#\n]*#(\d)", text)
        if block:
            digits = text[block.end():block.end() + int(block[1])]
            if len(digits) < int(block[1]):
                return None
            size = int(digits) if digits.isdigit() else 0
            end = text.find("\n", block.end() + len(digits) + size)
        if end < 0:
            return None
        self._received = text[end + 1:]
        return text[:end]

    def _answer(self, message):
        if self._strikes("closes"):
            self.closed = True
            return ""
        if self._strikes("hangs"):
            self._hangs = True
            return ""
        if "?" not in message and self._strikes("ignores"):
            return ""
        if "?" not in message and self._strikes("reports_error"):
            self.errors.append('-222,"Data out of range"')
            return ""
        answer = self._obey(message)
        return self._spoiled(answer) if answer else ""

    def _spoiled(self, answer):
        if self._strikes("swallows_answer"):
            return ""
        if self._strikes("answers_garbage"):
            return "".join(chr((self.detail * (i + 7) >> 5) % 256) for i in range(len(answer))) + "\n"
        if self._strikes("flips_answer_bit"):
            return _flipped(answer, self.detail % len(answer), self.detail)
        if answer[0] == "#" and self._strikes("wrong_length"):
            last = int(answer[1]) + 1
            digit = (int(answer[last]) + 1 + self.detail % 9) % 10
            return f"{answer[:last]}{digit}{answer[last + 1:]}"
        if self._strikes("closes_answering"):
            self.closed = True
            return answer[:self.detail % len(answer)]
        if self._strikes("extra_line"):
            return answer + '0,"No error"\n'
        return answer * 2 if self._strikes("repeats_answer") else answer

    def _obey(self, message):
        if message == "*IDN?":
            return f"{VENDORS[self.family]},{self.model},SN0001,1.0.3\n"
        if message == "*RST":
            self.reset()
        elif message == "*OPC?":
            return "1\n"
        elif message == "*CLS":
            self.errors.clear()
        elif self.family == "siglent":
            return self._obey_siglent(message)
        elif message == "SYST:ERR?":
            return (self.errors.pop(0) if self.errors else '0,"No error"') + "\n"
        else:
            special = self._obey_keysight if self.family == "keysight" else self._obey_tektronix
            answer = special(message)
            return self._obey_setting(message) if answer is None else answer
        return ""

    def _obey_setting(self, message):
        """Handles a setting or a query in standard SCPI."""
        found = re.fullmatch(r"((?:SOUR|OUTP)[12]):?([A-Z:]*)(\?| .*)", message, re.S)
        known = found and found[2] in NUMBERS[self.family] + WORDS[self.family]
        if not known:
            self.errors.append('-113,"Undefined header"')
            return ""
        key = found[1] + (":" + found[2] if found[2] else "")
        if found[3] != "?":
            value = found[3][1:].replace("INF", "9.9E37").replace('"', "")
            if key.endswith("FUNC:ARB"):
                value = key[4] + value
                if value not in self.memory:
                    self.errors.append('+785,"Specified arb waveform does not exist"')
            self.settings[key] = self._value(value) if found[2] in NUMBERS[self.family] else value
            return ""
        if not found[2]:
            return "1\n" if self.settings[key] == "ON" else "0\n"
        if found[2] in NUMBERS[self.family]:
            return f"{self.number(key):+.14E}\n"
        value = self.settings[key]
        return f'"{value[1:]}"\n' if key.endswith("FUNC:ARB") else f"{value}\n"

    def _value(self, text):
        """Returns the number in a text, or another number for the fault `other_value`."""
        if not self._strikes("other_value"):
            return text
        return str(_number(text) * (0.9, 1.02, 0.0, -1.0, 1000.0)[self.detail % 5] or 0.25)

    def _store(self, name, points):
        if self._strikes("other_memory"):
            name += "X"
        if points and self._strikes("corrupts_point"):
            points = _flipped(points, self.detail % len(points), self.detail)
        if self._strikes("truncates_points"):
            points = points[:self.detail % (len(points) + 1) // 2 * 2]
        self.memory[name] = points

    def _obey_keysight(self, message):
        if found := re.match(r"SOUR([12]):DATA:ARB:DAC (\w*),#(\d)", message):
            self._store(found[1] + found[2], message[found.end() + int(found[3]):])
        elif found := re.fullmatch(r"SOUR([12]):DATA:VOL:CLE", message):
            self.memory = {k: v for k, v in self.memory.items() if k[0] != found[1]}
        elif found := re.fullmatch(r'SOUR([12]):DATA:ATTR:POIN\? "(.*)"', message):
            return f"{len(self.memory.get(found[1] + found[2], '')) // 2:+d}\n"
        elif found := re.fullmatch(r"MMEM:STOR:DATA([12]) (.*)", message):
            points = self.memory.get(self.settings[f"SOUR{found[1]}:FUNC:ARB"], "")
            lines = [str(int.from_bytes(points[i:i + 2].encode("latin-1"), "big", signed=True))
                     for i in range(0, len(points), 2)]
            self.files[found[2]] = ("File Format:1.10\nChecksum:0\nSample Rate:40000.0\n"
                                    f"Data Points:{len(lines)}\nData:\n" + "\n".join(lines) + "\n")
        elif found := re.fullmatch(r"MMEM:UPL\? (.*)", message):
            return _block(self.files.get(found[1], ""))
        elif found := re.fullmatch(r"MMEM:DEL (.*)", message):
            self.files.pop(found[1], None)
        elif message == "FUNC:ARB:SYNC":
            self.phases_locked = True
        elif message != "FORM:BORD NORM":
            return None
        return ""

    def _obey_tektronix(self, message):
        if found := re.match(r"TRAC:DATA EMEM,#(\d)", message):
            self._store("EMEM", message[found.end() + int(found[1]):])
        elif found := re.fullmatch(r"TRAC:COPY (USER\d),EMEM", message):
            self._store(found[1], self.memory.get("EMEM", ""))
        elif found := re.fullmatch(r"TRAC:COPY EMEM,(USER\d)", message):
            self.memory["EMEM"] = self.memory.get(found[1], "")
        elif message == "TRAC:POIN? EMEM":
            return f"{len(self.memory.get('EMEM', '')) // 2}\n"
        elif message == "TRAC:DATA? EMEM":
            return _block(self.memory.get("EMEM", ""))
        elif re.fullmatch(r"SOUR[12]:PHAS:INIT", message):
            self.phases_locked = True
        else:
            return None
        return ""

    def _obey_siglent(self, message):
        """Handles a Siglent message. There is no error queue; unknown messages are ignored."""
        if found := re.match(r"C[12]:WVDT WVNM,([^,]*),.*?WAVEDATA,", message, re.S):
            self._store(found[1], message[found.end():])
        elif found := re.fullmatch(r"WVDT\? USER,(.*)", message):
            if found[1] not in self.memory:
                return ""
            points = self.memory[found[1]]
            return (f"WVDT POS, WVNM, {found[1]}, LENGTH,{len(points)}B, TYPE,5, FREQ,1000, AMPL,4, "
                    f"OFST,0, PHASE,0, WAVEDATA,{points}\n")
        elif found := re.fullmatch(r"(C[12]:OUTP) (ON|OFF)", message):
            self.settings[found[1]] = found[2]
        elif found := re.fullmatch(r"(C[12]:(?:OUTP|ARWV|SRATE|BSWV)) (.*)", message):
            words = found[2].split(",")
            for key, value in zip(words[::2], words[1::2]):
                is_number = key in ("LOAD", "VALUE", "FRQ", "AMP", "OFST", "PHSE") and value != "HZ"
                self.settings[f"{found[1]} {key}"] = self._value(value) if is_number else value
        elif found := re.fullmatch(r"C([12]):(OUTP|ARWV|SRATE|BSWV)\?", message):
            return self._siglent_state(found[1], found[2])
        elif message == "MODE PHASELOCKED":  # the other spelling is rejected
            self.phases_locked = True
        elif message == "MODE?":
            return "MODE PHASE-LOCKED\n" if self.phases_locked else "MODE INDEPENDENT\n"
        return ""

    def _siglent_state(self, n, command):
        def get(key):
            return self.settings.get(f"C{n}:{command} {key}", "")

        def printed(key):  # numbers are printed with six digits
            return f"{self.number(f'C{n}:{command} {key}'):.6g}"

        if command == "OUTP":
            load = get("LOAD") if get("LOAD") == "HZ" else printed("LOAD")
            return f"C{n}:OUTP {self.settings[f'C{n}:OUTP']},LOAD,{load},PLRT,NOR\n"
        if command == "ARWV":
            return f"C{n}:ARWV INDEX,50,NAME,{get('NAME')}\n"
        if command == "SRATE":
            value = f",VALUE,{printed('VALUE')}Sa/s" if get("MODE") == "TARB" else ""
            return f"C{n}:SRATE MODE,{get('MODE')}{value}\n"
        return (f"C{n}:BSWV WVTP,{get('WVTP')},FRQ,{printed('FRQ')}HZ,PERI,0.001S,AMP,{printed('AMP')}V,"
                f"OFST,{printed('OFST')}V,HLEV,1V,PHSE,{printed('PHSE')}\n")


def _number(text):
    found = re.match(r"[+-]?(\d+\.?\d*|\.\d+)(E[+-]?\d+)?", text, re.I)
    return float(found[0]) if found else 0.0


def _block(data):
    return f"#{len(str(len(data)))}{len(data)}{data}\n"


def _flipped(text, at, detail):
    return text[:at] + chr(ord(text[at]) ^ 1 << (detail >> 16) % 8) + text[at + 1:]
