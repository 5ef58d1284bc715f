# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Writes shell completion for bash, zsh and fish from the output of `--list-commands`.

    tofsmith --list-commands | python3 make_completions.py DIRECTORY

Words that are no command, option or built-in name are completed as files.
"""

import json
import re
import sys
from pathlib import Path

HEAD = "# {shell} completion of tofsmith {version}, made by cmake/make_completions.py.\n"

# The kind of built-in name that an argument accepts in addition to a file.
NAMED = {"--camera": "camera", "CAMERA": "camera", "--code": "code", "CODE": "code",
         "--target": "code", "--depth": "scene", "--scene": "scene", "SCENE": "scene"}

# Options that each command has.
OWN = {"--help", "--help-all", "--version"}


def words_for(command, argument, names):
    """Returns the words to offer for an argument, which may also accept files."""
    if "choices" in argument:
        return argument["choices"]
    kind = next((NAMED[name] for name in argument["names"] if name in NAMED), None)
    if command["words"] == ["codes"] and argument["names"] == ["NAME"]:
        kind = "code"
    return names[kind] if kind else []


def one_line(text):
    return " ".join(text.split())


def valued(options):
    return [option for option in options if "value" in option]


def spelled(options):
    return " ".join(name for option in options for name in option["names"])


def bash(listing):
    """Returns the bash script, one function that finds the command and the words to offer."""
    paths, values, takes = [], [], []
    for command in listing["commands"]:
        path = " ".join(command["words"])
        plain = [word for argument in command["positionals"]
                 for word in words_for(command, argument, listing["names"])]
        paths.append(f'    "{path}") subcommands="{" ".join(command["subcommands"])}"'
                     f' options="{spelled(command["options"])}" names="{" ".join(plain)}" ;;')
        for option in valued(command["options"]):
            pattern = "|".join(f'"{path} {name}"' for name in option["names"])
            takes.append(pattern)
            words = words_for(command, option, listing["names"])
            if words:
                values.append(f'    {pattern}) names="{" ".join(words)}" ;;')
    program = listing["commands"][0]["options"]
    general = spelled(o for o in program if not OWN & set(o["names"]))
    general_takes = "|".join(f'*" {name}"' for o in valued(program) for name in o["names"])
    return HEAD.format(shell="bash", version=listing["version"]) + f"""
# Succeeds if the option $2 of command $1 has a value.
_tofsmith_takes_value() {{
  case "$1 $2" in
    {general_takes}|{'|'.join(takes)}) return 0 ;;
  esac
  return 1
}}

_tofsmith() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
  # Readline splits --method=best into three words.
  if [[ $current == "=" ]]; then
    current=""
  elif [[ $previous == "=" ]]; then
    previous=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi

  local path="" subcommands="" options="" names="" i word
  _tofsmith_at "$path"
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${{COMP_WORDS[i]}}
    if [[ $word == -* ]]; then
      if [[ ${{COMP_WORDS[i + 1]}} != "=" ]] && _tofsmith_takes_value "$path" "$word"; then ((++i)); fi
    elif [[ " $subcommands " == *" $word "* ]]; then
      path="${{path:+$path }}$word"
      _tofsmith_at "$path"
    fi
  done

  if [[ $previous == -* ]] && _tofsmith_takes_value "$path" "$previous"; then
    names=""
    case "$path $previous" in
{chr(10).join(values)}
    esac
    mapfile -t COMPREPLY < <(compgen -W "$names" -- "$current")
  elif [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options {general}" -- "$current")
    return
  else
    mapfile -t COMPREPLY < <(compgen -W "$subcommands $names" -- "$current")
    [[ -z $path ]] && return
  fi
  # Offers files in addition to built-in names; without a match, readline offers files.
  if ((${{#COMPREPLY[@]}})) && [[ -n $current ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -f -- "$current")
  fi
}}

# Sets the words that can follow the command $1.
_tofsmith_at() {{
  case "$1" in
{chr(10).join(paths)}
  esac
}}

complete -o bashdefault -o default -F _tofsmith tofsmith
"""


def fish(listing):
    """Returns the fish script, one line with help for each command, option and positional."""

    def quoted(text):
        return "'" + one_line(text).replace("\\", "\\\\").replace("'", "\\'") + "'"

    lines = [HEAD.format(shell="fish", version=listing["version"])]
    summaries = {tuple(c["words"]): c["summary"] for c in listing["commands"]}
    for command in listing["commands"]:
        words = command["words"]
        here = [f"__fish_seen_subcommand_from {word}" for word in words]
        if command["subcommands"]:
            inner = [f"not __fish_seen_subcommand_from {' '.join(command['subcommands'])}"]
            for sub in command["subcommands"]:
                when = quoted("; and ".join(here + inner))
                flag = "-f " if not words else ""
                lines.append(f"complete -c tofsmith {flag}-n {when} -a {sub} "
                             f"-d {quoted(summaries[(*words, sub)])}")
        when = f" -n {quoted('; and '.join(here))}" if here else ""
        for option in command["options"]:
            if words and OWN & set(option["names"]):
                continue
            spelling = "".join(f" -l {n[2:]}" if n.startswith("--") else f" -s {n[1:]}"
                               for n in option["names"])
            value = ""
            if "value" in option:
                found = words_for(command, option, listing["names"])
                value = f" -r -a {quoted(' '.join(found))}" if found else " -r"
                if "choices" in option:
                    value = f" -x -a {quoted(' '.join(found))}"
            lines.append(f"complete -c tofsmith{when}{spelling}{value} -d {quoted(option['help'])}")
        for argument in command["positionals"]:
            found = words_for(command, argument, listing["names"])
            if found:
                lines.append(f"complete -c tofsmith{when} -a {quoted(' '.join(found))}")
    return "\n".join(lines) + "\n"


def zsh(listing):
    """Returns the zsh script, one function that calls _arguments for each command."""

    def quoted(text):
        return re.sub(r"([][:\\])", r"\\\1", one_line(text)).replace("'", "'\\''")

    def action(command, argument):
        found = " ".join(words_for(command, argument, listing["names"]))
        if "choices" in argument:
            return f":({found})"
        if argument["value"].startswith(("INT", "UINT", "FLOAT")):
            return ": "
        return f': _alternative "names\\:name\\:({found})" "files\\:file\\:_files"' if found else ":_files"

    def specification(command, option):
        names, value = option["names"], ""
        if "value" in option:
            value = f":{option['value'].partition(':')[0]}{action(command, option)}"
        text = f"[{quoted(option['help'])}]{value}"
        if len(names) == 1:
            return f"'*{names[0]}{text}'"
        return f"'*'{{{','.join(names)}}}'{text}'"

    def function(words):
        return "_".join(["_tofsmith", *words]).replace("-", "_")

    lines = ["#compdef tofsmith", HEAD.format(shell="zsh", version=listing["version"])]
    commands = {tuple(c["words"]): c for c in listing["commands"]}
    program = listing["commands"][0]
    for words, command in commands.items():
        options = [specification(command, o) for o in command["options"]]
        if words:
            options += [specification(program, o) for o in program["options"]
                        if not OWN & set(o["names"])]
        lines.append(f"{function(words)}() {{")
        if command["subcommands"]:
            lines += ["  local context state line", "  _arguments -C \\"]
            lines += [f"    {o} \\" for o in options]
            lines += ["    '1: :->first' '*:: :->rest'", "  case $state in", "    first)",
                      "      local -a commands=("]
            lines += [f"        '{sub}:{quoted(commands[(*words, sub)]['summary'])}'"
                      for sub in command["subcommands"]]
            lines += ["      )", "      _describe command commands"]
            if command["positionals"]:
                lines.append("      _files")
            lines += ["      ;;", "    rest)", "      case $line[1] in"]
            lines += [f"        {sub}) {function((*words, sub))} ;;" for sub in command["subcommands"]]
            lines += ["        *) _files ;;", "      esac", "      ;;", "  esac"]
        else:
            lines.append("  _arguments \\")
            lines += [f"    {o} \\" for o in options]
            for argument in command["positionals"]:
                many = "*" if argument["many"] else ""
                lines.append(f"    '{many}:{argument['names'][0]}{action(command, argument)}' \\")
            lines.append("    && return 0")
        lines += ["}", ""]
    return "\n".join(lines) + '\n_tofsmith "$@"\n'


def main(directory):
    listing = json.load(sys.stdin)
    folder = Path(directory)
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in {"tofsmith": bash, "_tofsmith": zsh, "tofsmith.fish": fish}.items():
        (folder / name).write_text(make(listing), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
