#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Adds codes designed by sweeps to an atlas, if they are better than the existing ones.

    collect.py ATLAS.txt SWEEP.json ...     exports of `tofsmith sweep` of scripts/atlas/*.toml
"""

import json
import os
import sys

HEAD = "tofsmith atlas 1"  # atlas_version of design.hpp
FUNDAMENTAL_HZ = 15e6  # of the cameras of the sweeps
PARTS = 100_000  # switching times are multiples of period / PARTS


def short(number):
    return format(number, ".6g")


def intervals(waveform):
    """Switching times in parts of the period. Drops empty intervals and joins adjacent ones."""
    if waveform["kind"] != "binary":
        sys.exit("a waveform that is not binary; the cameras of the atlas switch on and off")
    on = []
    for rise, fall in waveform["on"]:
        begin, end = round(rise * PARTS), round(fall * PARTS)
        if end > begin:
            on.append((begin % PARTS, begin % PARTS + min(end - begin, PARTS)))
    on.sort()
    joined = []
    for begin, end in on:
        if joined and begin <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(end, joined[-1][1]))
        else:
            joined.append((begin, end))
    while len(joined) > 1 and joined[-1][1] >= joined[0][0] + PARTS:
        last, first = joined.pop(), joined.pop(0)
        joined.append((last[0], max(last[1], first[1] + PARTS)))
    if joined and joined[-1][1] - joined[-1][0] >= PARTS:
        joined = [(0, PARTS)]
    return joined


def estimate(error):
    return f"{error['geometric_mean_m']:.5g} {error['geometric_mean_se_m']:.2g}"


def entry_of(item, axes):
    """Sorting key, error, and lines of an item of a sweep."""
    settings = {**axes, **item["settings"]}
    code = item["designed"]
    band_hz = settings.get("light.impulse_response.f_max_hz", 0)
    shortest_s = settings.get("sensor.shortest_pulse_s", 0)
    kind = settings["operating.error"]
    camera = (settings["sensor.taps"], settings["exposures"], settings["light.peak_factor"],
              band_hz / FUNDAMENTAL_HZ, round(shortest_s * FUNDAMENTAL_HZ, 9), kind)
    taps, exposures, peak, band, shortest, _ = camera
    lines = [f"code taps {taps:.0f} exposures {exposures:.0f} peak {short(peak)} bandwidth {short(band)} "
             f"shortest {short(shortest)} error {kind} linear_m {estimate(item['linear'])} "
             f"circular_m {estimate(item['circular'])}"]
    for e, light in enumerate(code["modulation"]):
        gates = code["demodulation"][e * code["taps"]:(e + 1) * code["taps"]]
        for name, waveform in [("light", light), *(("gate", gate) for gate in gates)]:
            lines.append(" ".join([name, *(f"{a} {b}" for a, b in intervals(waveform))]))
    return camera, item[kind]["geometric_mean_m"], lines


def read_atlas(path):
    """Entries by camera: error and lines."""
    entries = {}
    with open(path, encoding="utf-8") as file:
        head, *rest = file.read().splitlines()
    if head != HEAD:
        sys.exit(f"{path}:1: found \"{head}\"; expected \"{HEAD}\"")
    lines = []
    for line in rest:
        if line.startswith("code "):
            words = line.split()
            values = dict(zip(words[1:11:2], map(float, words[2:12:2])))
            kind = words[12]
            camera = (*values.values(), kind)
            error = float(words[words.index(f"{kind}_m") + 1])
            lines = [line]
            entries[camera] = (error, lines)
        elif line and not line.startswith("#"):
            lines.append(line)
    return entries


def error_in(lines, kind):
    """Error of a kind in the lines of an entry."""
    words = lines[0].split()
    return float(words[words.index(f"{kind}_m") + 1])


def shared(entries):
    """Each camera with the best code of all cameras with the same taps, exposures and bandwidth and
    at most the same peak. It supports these codes with the same errors."""
    best = {}
    for camera, (error, lines) in entries.items():
        taps, exposures, peak, band, shortest, kind = camera
        for other, (_, its_lines) in entries.items():
            if other[:2] + other[3:5] != (taps, exposures, band, shortest) or other[2] > peak:
                continue
            if error_in(its_lines, kind) < error:
                error, lines = error_in(its_lines, kind), its_lines
        words = lines[0].split()
        words[6], words[12] = short(peak), kind
        best[camera] = (error, [" ".join(words), *lines[1:]])
    return best


def main():
    path, exports = sys.argv[1], sys.argv[2:]
    entries = read_atlas(path)
    new = better = 0
    for export in exports:
        with open(export, encoding="utf-8") as file:
            document = json.load(file)
        for item in document["codes"]:
            camera, error, lines = entry_of(item, {})
            if camera in entries and entries[camera][0] <= error:
                continue
            new, better = new + (camera not in entries), better + (camera in entries)
            entries[camera] = (error, lines)
    entries = shared(entries)
    # The format is described in atlas.cpp.
    text = "\n".join([HEAD, *(line for camera in sorted(entries) for line in entries[camera][1])]) + "\n"
    with open(path + ".new", "w", encoding="utf-8") as file:
        file.write(text)
    os.replace(path + ".new", path)
    print(f"{path}: {len(entries)} codes, {len(text) / 1e6:.2f} MB; {new} new, {better} better")


if __name__ == "__main__":
    main()
