#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the golden files in this folder according to docs/formats.md, without tofsmith.
The waveform has 8 points in a period of 5 MHz, from -0.5 V to 1.5 V, and the name modulation_1.
"""

import os
import struct

HERE = os.path.dirname(os.path.abspath(__file__))
LOW, HIGH, RATE = -0.5, 1.5, 40e6


def codes(levels):
    """Returns the ends, the middle and their neighbours of the range of a point."""
    top = levels - 1
    return [0, top, top // 2, 1, top - 1, 0, top // 3, top]


def write(name, content):
    with open(os.path.join(HERE, name), "wb") as file:
        file.write(content if isinstance(content, bytes) else content.encode())


def volts(code, levels):
    return LOW + (HIGH - LOW) * code / (levels - 1)


def easywave():
    levels = 1 << 14
    for name, spelling, blank in (("easywave", "data length", ""), ("lenth", "data lenth", ""),
                                  ("commas", "data length", ",")):
        lines = [f"{spelling},8", "frequency,5000000.000000000", "amp,2.000000000",
                 "offset,0.500000000", "phase,0.000000000"] + [blank] * 7 + ["xpos,value"]
        for j, code in enumerate(codes(levels)):
            x = str(j + 1) if name == "easywave" else f"{j / RATE:.9e}"
            lines.append(f"{x},{volts(code, levels):.9g}")
        write(f"siglent_{name}.csv", "".join(line + "\r\n" for line in lines))


def wvdt():
    settings = ("FREQ,{:.9f},AMPL,2.000000000,OFST,0.500000000,PHASE,0.000000000,WAVEDATA,")
    points = [code - (1 << 15) for code in codes(1 << 16)]
    write("siglent_16.wvdt", b"C1:WVDT WVNM,modulation_1," + settings.format(5e6).encode() +
          struct.pack("<8h", *points))
    points = [code - (1 << 13) & 0x3fff for code in codes(1 << 14)] * 64
    head = b"C1:WVDT M50,WVNM,modulation_1,TYPE,5,LENGTH,1KB," + settings.format(5e6 / 64).encode()
    write("siglent_14_little.wvdt", head + struct.pack("<512H", *points))
    write("siglent_14_big.wvdt", head + struct.pack(">512H", *points))


def keysight():
    points = [code - 32767 for code in codes(65535)]
    lines = ["File Format:1.10", "Checksum:0", "Channel Count:1", "Sample Rate:40000000.000000000",
             "High Level:1.500000000", "Low Level:-0.500000000", "Marker Point:4",
             'Data Type:"short"', 'Filter:"off"', "Data Points:8", "Data:"]
    write("keysight.arb", "".join(f"{line}\n" for line in lines + points))


def tektronix():
    points = codes(16383)
    picture = b"".join(struct.pack("BB", p >> 6, p >> 6) for p in points)
    header = struct.pack(">10s6x3I", b"TEKAFG3000", 20050114, len(points), 1) + picture
    write("tektronix.tfw", header.ljust(512, b"\0") + struct.pack(">8H", *points))
    records = b""
    for j, code in enumerate(codes(1 << 14)):
        markers = (1 if j < 4 else 0) | (2 if j == 0 else 0)
        records += struct.pack("<fB", 2 * code / ((1 << 14) - 1) - 1, markers)
    write("tektronix.wfm", b"MAGIC 1000\r\n#240" + records + b"CLOCK 4.0000000000e+07\r\n")


def memories():
    """Two exposures of three words: light in bit 0, taps in bits 1 and 2, trigger in bit 3."""
    words = [0b1011, 0b1001, 0b0100, 0b1101, 0b1010, 0b0001]
    fields = ["bit 0: light", "bit 1: tap_1", "bit 2: tap_2", "bit 3: trigger",
              "word of point j of exposure e (both from 0): e * 3 + j"]

    def top(mark):
        return "".join(f"{mark} {line}\n" for line in ["two lines", "for people"] + fields)

    constants = [("WORD_BITS", 4), ("WORDS", 6), ("POINTS_PER_EXPOSURE", 3),
                 ("LIGHT_FIRST_BIT", 0), ("LIGHT_BITS", 1), ("TAP_1_FIRST_BIT", 1),
                 ("TAP_1_BITS", 1), ("TAP_2_FIRST_BIT", 2), ("TAP_2_BITS", 1),
                 ("TRIGGER_FIRST_BIT", 3), ("TRIGGER_BITS", 1)]
    write("pattern.coe", top(";") + "memory_initialization_radix=16;\n"
          "memory_initialization_vector=\n" + ",\n".join(f"{w:x}" for w in words) + ";\n")
    write("pattern.mif", top("--") + "DEPTH = 6;\nWIDTH = 4;\nADDRESS_RADIX = UNS;\n"
          "DATA_RADIX = HEX;\nCONTENT\nBEGIN\n" +
          "".join(f"{a} : {w:X};\n" for a, w in enumerate(words)) + "END;\n")
    write("pattern.mem", top("//") + "".join(f"{w:x}\n" for w in words))
    write("pattern.sv", top("//") + "package pattern_pkg;\n" +
          "".join(f"  localparam int {n} = {v};\n" for n, v in constants) +
          "  localparam logic [3:0] PATTERN [0:5] = '{\n" +
          ",\n".join(f"    4'h{w:x}" for w in words) + "\n  };\nendpackage\n")
    write("pattern.vhd", top("--") +
          "library ieee;\nuse ieee.std_logic_1164.all;\n\npackage pattern_pkg is\n" +
          "".join(f"  constant {n} : natural := {v};\n" for n, v in constants) +
          "  type pattern_t is array (0 to 5) of std_logic_vector(3 downto 0);\n"
          "  constant PATTERN : pattern_t := (\n" +
          ",\n".join(f'    {a} => "{w:04b}"' for a, w in enumerate(words)) +
          "\n  );\nend package pattern_pkg;\n")
    write("pattern.h", top("//") + "#ifndef PATTERN_H\n#define PATTERN_H\n\n#include <stdint.h>\n\n"
          + "".join(f"#define PATTERN_{n} {v}\n" for n, v in constants) +
          "\nstatic const uint8_t pattern[6] = {\n" + ",\n".join(f"    0x{w:x}u" for w in words) +
          "\n};\n\n#endif\n")


easywave()
wvdt()
keysight()
tektronix()
memories()
