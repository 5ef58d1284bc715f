# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the commands and options printed by `tofsmith --list-commands`."""

from __future__ import annotations

import json
import subprocess
from dataclasses import dataclass, field
from typing import Optional


@dataclass
class Entry:
    """A positional argument or an option."""

    names: list[str]
    description: str
    value: str = ""  # placeholder: TEXT, INT, ...
    rule: str = ""
    default: Optional[str] = None
    repeats: bool = False
    required: bool = False
    needs: list[str] = field(default_factory=list)
    excludes: list[str] = field(default_factory=list)
    for_experts: bool = False


@dataclass
class Command:
    words: list[str]  # ["sweep", "merge"]; [] is the program
    description: str
    subcommands: list[str]
    sections: dict[str, list[Entry]]
    footer: str  # printed after the options

    @property
    def name(self) -> str:
        return " ".join(["tofsmith", *self.words])

    @property
    def usage(self) -> str:
        positionals = [entry.names[0] + (" ..." if entry.repeats else "")
                       for entry in self.sections["Positionals"]]
        return " ".join([self.name, "[OPTIONS]", *positionals,
                         *(["[SUBCOMMAND]"] if self.subcommands else [])])


def entry_of(argument: dict) -> Entry:
    value, _, rule = argument.get("value", "").partition(":")
    return Entry(argument["names"], argument["help"], value, rule.removeprefix(value + " "),
                 argument.get("default"), argument.get("many", False),
                 argument.get("required", False), argument.get("needs", []),
                 argument.get("excludes", []), argument.get("for_experts", False))


def all_commands(tool: str) -> list[Command]:
    """Returns the program, then its commands, each followed by its subcommands."""
    text = subprocess.run([tool, "--list-commands"], check=True, capture_output=True, text=True,
                          timeout=60).stdout
    return [Command(command["words"], command["summary"], command["subcommands"],
                    {"Positionals": [entry_of(p) for p in command["positionals"]],
                     "Options": [e for e in options if not e.for_experts],
                     "For experts": [e for e in options if e.for_experts]},
                    command.get("example", ""))
            for command in json.loads(text)["commands"]
            for options in [[entry_of(o) for o in command["options"]]]]
