# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Writes manual pages from the output of `--list-commands`: tofsmith.1 and one per command.

    tofsmith --list-commands | python3 make_manual.py DIRECTORY
"""

import json
import sys
from pathlib import Path

EXIT_STATUS = (("0", "done"), ("1", "failed; the message states the reason"),
               ("2", "wrong usage"), ("130", "interrupted; finished files are kept"))
ENVIRONMENT = (("TOFSMITH_TARGET", "instruction set to use, such as AVX2, so that different "
                                   "machines give bit-identical results"),)

# Options that each command has.
OWN = {"--help", "--help-all", "--version"}


def escaped(text):
    """Escapes text for groff."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq").replace("`", "\\`")
    text = text.replace("^", "\\(ha").replace("~", "\\(ti")
    return "\n".join("\\&" + line if line.startswith(".") else line for line in text.split("\n"))


def bold(text):
    return f"\\fB{escaped(text)}\\fR"


def italic(text):
    return f"\\fI{escaped(text)}\\fR"


def page_name(words):
    return "-".join(["tofsmith", *words])


def term(head, text):
    return f".TP\n{head}\n{escaped(text) if text else '.'}\n"


def sentences(argument):
    """Returns the help of an argument and its accepted values."""
    kind, _, rule = argument.get("value", "").partition(":")
    found = [argument["help"].rstrip(".")] if argument["help"] else []
    if "choices" in argument:
        found.append("one of " + ", ".join(argument["choices"]))
    elif rule:
        found.append(rule if rule.startswith(kind) else f"{kind} {rule}")
    if argument.get("many"):
        found.append("one or several")
    if argument.get("required") and argument["names"][0].startswith("-"):
        found.append("must be given")
    if "default" in argument:
        found.append(f"default: {argument['default']}")
    return "; ".join(found) + "." if found else ""


def option_head(option):
    names = ", ".join(bold(name) for name in option["names"])
    if "value" not in option:
        return names
    return f"{names} {italic(option['value'].partition(':')[0])}"


def synopsis(command):
    parts = [bold(" ".join(["tofsmith", *command["words"]])), f"[{italic('OPTIONS')}]"]
    for argument in command["positionals"]:
        text = italic(argument["names"][0]) + (" ..." if argument["many"] else "")
        parts.append(text if argument["required"] else f"[{text}]")
    if command["subcommands"]:
        parts.append(f"[{italic('COMMAND')} ...]")
    return " ".join(parts)


def section(title, entries):
    return f".SH {title}\n" + "".join(entries) if entries else ""


def manual_page(command, listing):
    """Returns a page in man macros; `command` is an entry of listing["commands"]."""
    words, commands = command["words"], {tuple(c["words"]): c for c in listing["commands"]}
    program = commands[()]
    name = page_name(words)
    summary = command["summary"].rstrip(".").removeprefix("tofsmith ")
    subcommands = [commands[(*words, sub)] for sub in command["subcommands"]]
    example = command.get("example", "").removeprefix("Try: ").rstrip("\n")
    above = [page_name(words[:end]) for end in range(len(words))]
    below = [page_name(sub["words"]) for sub in subcommands]
    related = ",\n".join(f".BR {escaped(other)} (1)" for other in above + below)
    return "".join([
        f'.\\" Made by cmake/make_manual.py from what tofsmith says of itself.\n'
        f'.TH {escaped(name.upper())} 1 "" "tofsmith {listing["version"]}" "User Commands"\n',
        f".SH NAME\n{escaped(name)} \\- {escaped(summary)}\n",
        f".SH SYNOPSIS\n{synopsis(command)}\n",
        section("COMMANDS", [term(bold(" ".join(sub["words"])), sub["summary"])
                             for sub in subcommands]),
        section("ARGUMENTS", [term(italic(p["names"][0]), sentences(p))
                              for p in command["positionals"]]),
        section("OPTIONS", [term(option_head(o), sentences(o)) for o in command["options"]]),
        section("OPTIONS OF EVERY COMMAND", [
            term(option_head(o), sentences(o)) for o in program["options"]
            if words and not OWN & set(o["names"])]),
        section("NOTES", [f".nf\n{escaped(example)}\n.fi\n"] if example else []),
        section("EXIT STATUS", [term(bold(code), text + ".") for code, text in EXIT_STATUS]),
        section("ENVIRONMENT", [term(bold(name), text + ".") for name, text in ENVIRONMENT]),
        section("SEE ALSO", [related.replace(",\n.BR", " ,\n.BR") + "\n"] if related else []),
    ])


def main(directory):
    listing = json.load(sys.stdin)
    folder = Path(directory)
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.1"):
        old.unlink()
    for command in listing["commands"]:
        page = folder / f"{page_name(command['words'])}.1"
        page.write_text(manual_page(command, listing), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
