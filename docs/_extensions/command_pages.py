# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Writes generated/commands with a page per command, from the help texts of the tool, and the keys
of these files to generated/camera_keys.md and generated/raw_format_keys.md."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

from command_help import Command, Entry, all_commands


def plain(text: str) -> str:
    """Escapes Markdown, except for code in backticks."""
    parts = text.split("`")
    parts[::2] = [re.sub(r"([\\*_<>\[\]#|~^$])", r"\\\1", part) for part in parts[::2]]
    return "`".join(parts)


def sentence(text: str) -> str:
    """Capitalizes a text that begins with a word."""
    return text[0].upper() + text[1:] if re.match(r"[a-z]{2,}\b|a ", text) else text


def rule_of(entry: Entry) -> str:
    """Describes the valid values in words."""
    between = re.fullmatch(r"in \[(.*) - (.*)\]", entry.rule)
    if between:
        return f"From {between[1]} to {between[2]}."
    if entry.rule.startswith("{"):
        return "One of " + ", ".join(f"`{word}`" for word in entry.rule[1:-1].split(",")) + "."
    if not entry.rule or entry.rule in entry.description:
        return ""
    return f"Must be {plain(entry.rule.lower())}."


def facts_of(entry: Entry) -> str:
    facts = []
    if entry.required:
        facts.append("Required.")
    facts.append(rule_of(entry))
    if entry.default is not None:
        facts.append(f"Default: `{entry.default}`.")
    if entry.repeats and "repeatable" not in entry.description:
        facts.append("Takes several.")
    if entry.needs:
        facts.append("Requires " + " and ".join(f"`{name}`" for name in entry.needs) + ".")
    if entry.excludes:
        facts.append("Not with " + " or ".join(f"`{name}`" for name in entry.excludes) + ".")
    return " ".join(filter(None, facts))


def option_of(entry: Entry) -> str:
    signature = ", ".join(entry.names)
    if entry.names[0].startswith("-"):
        signature += f" {entry.value}".rstrip()
    body = "\n\n".join(filter(None, [plain(sentence(entry.description)), facts_of(entry)]))
    return f"````{{option}} {signature}\n{body}\n````\n"


def section_of(command: Command, level: int) -> str:
    text = [f"{'#' * level} {command.name}\n", plain(command.description) + "\n",
            f"```text\n{command.usage}\n```\n", f"```{{program}} {command.name}\n```\n"]
    for title, entries in command.sections.items():
        shown = [option_of(entry) for entry in entries
                 if not {"--help", "--help-all"} & set(entry.names)]
        if shown:
            text += [f"**{title}**\n", *shown]
    if command.footer and command.words:
        text.append("\n".join(["```text", command.footer.strip("\n"), "```\n"]))
    return "\n".join(text)


def front_page(tool: Command, pages: list[Command]) -> str:
    rows = "\n".join(f"| [{page.name}]({page.words[0]}.md) | {plain(page.description)} |"
                     for page in pages)
    names = "\n".join(page.words[0] for page in pages)
    return f"""# Commands

{plain(tool.description)} These pages are generated from `tofsmith COMMAND --help-all`; `--help`
shows only the common options.

| command | does |
|---|---|
{rows}

Exit codes: 0 done, 1 failed, 2 wrong usage, 130 interrupted (finished work is kept). The options
below apply to all commands. The environment variable `TOFSMITH_TARGET` selects the instruction set,
so that different machines give bit-identical results.

{section_of(tool, 2)}
```{{toctree}}
:hidden:

{names}
```
"""


def write_pages(tool: str, folder: Path) -> list[str]:
    """Writes one page per command with its subcommands. Returns the names of the pages."""
    first, *rest = all_commands(tool)
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.md"):
        old.unlink()
    pages = [command for command in rest if len(command.words) == 1]
    for page in pages:
        below = [command for command in rest if command.words[0] == page.words[0]][1:]
        text = "\n".join([section_of(page, 1), *(section_of(command, 2) for command in below)])
        (folder / f"{page.words[0]}.md").write_text(text)
    (folder / "index.md").write_text(front_page(first, pages))
    return [page.words[0] for page in pages]


def camera_key_row(key: dict) -> str:
    words = ", ".join(f"`{word}`" for word in key.get("words", []))
    facts = "; ".join(filter(None, [
        words, key["range"], key["condition"] and f"only with `{key['condition']}`",
        key["example"] and f"required, such as `{key['example']}`"]))
    name = key["key"].rpartition(".")[2]
    has_default = key["default"] is not None and not key["example"]
    default = f"`{json.dumps(key['default'])}`" if has_default else ""
    help_text = plain(key["help"])
    return f"| `{name}` | {help_text} | {key['unit']} | {facts} | {default} |"


def keys_page(tool: str, title: str, file: str, options: list[str]) -> str:
    """Returns the keys listed by `tofsmith cameras OPTIONS`, one Markdown table per table of the
    file."""
    keys = json.loads(subprocess.run([tool, "cameras", *options, "--json"], check=True,
                                     capture_output=True, text=True).stdout)
    head = "\n| key | meaning | unit | values | default |\n|---|---|---|---|---|"
    lines = [f"# {title}\n", f"All keys of a {file}, as `tofsmith cameras {' '.join(options)}` "
             "prints them.", head]
    for table in [{"key": ""}] + [key for key in keys if key["type"] == "table"]:
        if table["key"]:
            lines += [f"\n## [{table['key']}]\n", plain(table["help"]) + ".", head]
        lines += [camera_key_row(key) for key in keys
                  if key["type"] != "table" and key["key"].rpartition(".")[0] == table["key"]]
    return "\n".join(lines) + "\n"


def write_generated_pages(tool: str, folder: Path) -> None:
    write_pages(tool, folder / "commands")
    (folder / "camera_keys.md").write_text(
        keys_page(tool, "Camera keys", "[camera file](../cameras.md)", ["--keys"]))
    (folder / "raw_format_keys.md").write_text(
        keys_page(tool, "Raw format keys", "[raw format](../raw_formats.md)",
                  ["--raw-format", "--keys"]))


def setup(app):
    app.add_config_value("tofsmith_tool", "tofsmith", "env")
    app.connect("builder-inited", lambda app: write_generated_pages(
        app.config.tofsmith_tool, Path(app.srcdir) / "generated"))
    return {"version": "1", "parallel_read_safe": True}
