# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""python3 -m tofsmith.paper, which `tofsmith reproduce` runs."""

import argparse
import json
import sys
from dataclasses import asdict

try:
    import matplotlib  # noqa: F401
except ImportError as error:
    sys.exit(f"tofsmith: reproduce needs matplotlib, which {sys.executable} cannot import ({error}). On "
             "Debian: apt install python3-matplotlib. Elsewhere: pip install matplotlib")

import tofsmith
from tofsmith.paper import Finding, UsageError, items, reproduce


def parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(
        "tofsmith reproduce", allow_abbrev=False,
        epilog="`tofsmith reproduce --help` describes the options.")
    made.add_argument("names", nargs="+", metavar="FIGURE", help="all, " + ", ".join(items))
    for flag in ("--fast", "--force", "--json"):
        made.add_argument(flag, action="store_true")
    made.add_argument("--seed", type=int, default=1)
    made.add_argument("--threads", type=int, default=0)
    made.add_argument("--mesh")
    made.add_argument("-o", "--output", default="tofsmith-reproduce")
    return made


def show(name: str, findings: list[Finding], kept: bool) -> None:
    print(f"{name}: {items[name]}{' (finished before)' if kept else ''}")
    for finding in findings:
        print(f"  {finding.verdict}: {finding.statement}\n    {finding.measured}", flush=True)


def main(arguments: list[str] | None = None) -> int:
    """Runs the command and returns its exit code."""
    given = parser().parse_args(arguments)
    try:
        tofsmith.set_threads(given.threads)
        made = reproduce(given.names, given.output, fast=given.fast, seed=given.seed, mesh=given.mesh,
                         overwrite=given.force, on_item=None if given.json else show)
    except (UsageError, OSError) as error:
        print(f"tofsmith: {error}", file=sys.stderr)
        return 2 if isinstance(error, UsageError) else 1
    except (KeyboardInterrupt, tofsmith.Interrupted):
        print("tofsmith: interrupted; finished figures are kept", file=sys.stderr)
        return 130
    index = f"{given.output}/index.html"
    if given.json:
        fields = [{"name": name, "title": items[name], "findings": [asdict(one) for one in findings]}
                  for name, findings in made.items()]
        print(json.dumps({"seed": given.seed, "fast": given.fast, "output": index, "items": fields},
                         indent=1))
    else:
        print(f"report: {index}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
