# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""What `tofsmith COMMAND --help` says, taken apart."""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass, field
from typing import Optional

COLUMN = 30  # where CLI11 begins descriptions


@dataclass
class Entry:
    """A positional, an option or a subcommand."""

    names: list[str]
    description: str
    value: str = ""  # its placeholder: TEXT, INT, ..
    rule: str = ""
    default: Optional[str] = None
    repeats: bool = False
    required: bool = False
    needs: str = ""
    excludes: str = ""


@dataclass
class Command:
    words: list[str]  # ["sweep", "merge"]; [] is the tool itself
    description: str
    usage: str
    sections: dict[str, list[Entry]] = field(default_factory=dict)
    footer: list[str] = field(default_factory=list)  # what follows the options

    @property
    def name(self) -> str:
        return " ".join(["tofsmith", *self.words])


SPEC = re.compile(
    r"(?P<names>[^\s{]+)(?P<negates>\{false\})?"
    r"(?: (?P<value>[A-Z]+)(?::(?P<rule>.*?))?(?:(?<![<>])=(?P<default>[^=]*?))?)?"
    r"(?P<repeats> (?:\.\.\.|x \d+))?(?P<required> REQUIRED)?(?: Needs: (?P<needs>\S+))?"
    r"(?: Excludes: (?P<excludes>\S+))?")


def entry_of(spec: str, description: str) -> Entry:
    match = SPEC.fullmatch(spec)
    if not match:
        raise ValueError(f"cannot read {spec!r} in the help of a command")
    value = match["value"] or ""
    return Entry(match["names"].split(","), description, value,
                 re.sub(rf"^{value} ", "", match["rule"] or ""), match["default"],
                 bool(match["repeats"]), bool(match["required"]), match["needs"] or "",
                 match["excludes"] or "")


def split_help(text: str) -> tuple[list[str], dict[str, list[list[str]]], list[str]]:
    """The lines above the sections; of each section [specification, description]; the rest."""
    head: list[str] = []
    sections: dict[str, list[list[str]]] = {}
    footer: list[str] = []
    current: Optional[list[list[str]]] = None
    lines = text.splitlines()
    for number, line in enumerate(lines):
        if line in ("Positionals:", "Options:", "Subcommands:"):
            current = sections.setdefault(line[:-1], [])
        elif footer or (current is not None and re.match(r"\S", line)):
            footer.append(line)
        elif current is None:
            head.append(line)
        elif re.match(r"  \S", line):
            current.append([line[2:COLUMN].strip(), line[COLUMN:].strip()])
        elif line.strip():  # a long specification has the line above to itself
            current[-1] = [lines[number - 1].strip(), line.strip()]
    return head, sections, footer


def command_of(tool: str, words: list[str]) -> Command:
    text = subprocess.run([tool, *words, "--help"], check=True, capture_output=True, text=True,
                          timeout=60).stdout
    head, sections, footer = split_help(text)
    usage = next(line for line in head if line.startswith("Usage: ")).split(maxsplit=2)[2]
    command = Command(words, head[0], " ".join(["tofsmith", usage]), footer=footer)
    for title, pairs in sections.items():
        command.sections[title] = [entry_of(*pair) for pair in pairs]
    return command


def all_commands(tool: str, words: Optional[list[str]] = None) -> list[Command]:
    """The tool itself, then every command, each with its subcommands behind it."""
    command = command_of(tool, words or [])
    commands = [command]
    for entry in command.sections.get("Subcommands", []):
        commands += all_commands(tool, [*command.words, *entry.names])
    return commands
