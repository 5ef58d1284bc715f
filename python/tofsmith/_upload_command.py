# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Runs `tofsmith upload`: the command line describes the upload as JSON on standard input."""

from __future__ import annotations

import json
import sys
from typing import Any

from ._camera import Camera
from ._code import CodeSet
from ._tofsmith import UploadChannel
from .instruments import UploadReport, upload, visa_resource_name


def _document(report: UploadReport, output_on: bool) -> dict[str, Any]:
    channels = []
    for channel in report.channels:
        numbers = {number.quantity: {"requested": number.requested, "read_back": number.read_back}
                   for number in report.numbers if number.channel == channel.channel}
        channels.append({key: getattr(channel, key) for key in vars(UploadChannel)
                          if not key.startswith("_")} | {"numbers": numbers})
    return {
        "instrument": {name: getattr(report, name) for name in
                       ("address", "vendor", "model", "serial", "firmware", "treated_as")},
        "verified": report.verified,
        "message": report.message,
        "output_on": output_on,
        "channels": channels,
        "steps": [dict(zip(("what", "sent", "answer"), step)) for step in report.steps],
    }


def _text(report: UploadReport, output_on: bool) -> str:
    lines = [f"{report.vendor} {report.model} {report.serial} at {report.address}:"]
    lines += [f"channel {c.channel}, {c.waveform}: {c.points} points, {c.periods} periods, "
              f"{c.sample_rate_hz / 1e6:.6g} MHz, {c.low_v:.4g} to {c.high_v:.4g} V"
              for c in report.channels]
    state = "on" if output_on else "off (--output-on switches them on)"
    return "\n".join([*lines, f"{report.message}.", f"Outputs are {state}."])


def _show_progress(fraction: float, step: str) -> None:
    """Shows progress in one line of a terminal, which is cleared at the end."""
    text = "" if fraction == 1 else f"uploading {100 * fraction:.0f} %  {step}"
    print(f"\r{text[:78]:78}\r", end="", file=sys.stderr, flush=True)


def _fail(problem: object, code: int) -> int:
    print(f"tofsmith: {problem}", file=sys.stderr)
    return code


def main() -> int:
    request = json.load(sys.stdin)
    options = request["options"]
    options["load_ohm"] = float(options["load_ohm"])
    shows_progress = sys.stderr.isatty() and not request["quiet"]
    try:
        visa_resource_name(options["address"])
    except ValueError as error:
        return _fail(f"--instrument: {error}", 2)
    try:
        report = upload(CodeSet.from_json(request["code"]), Camera.from_toml(request["camera"]),
                        progress=_show_progress if shows_progress else None, **options)
    except (ValueError, OSError, ImportError) as error:
        return _fail(error, 1)
    if request["json"]:
        print(json.dumps(_document(report, options["output_on"]), indent=2))
    else:
        print(_text(report, options["output_on"]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
