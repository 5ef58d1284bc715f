#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Checks the prose of this repository: python3 scripts/check_prose.py [--list] [PROGRAM]

Fails if a folder contains more than 15 marked phrases per 10,000 words, phrases that make technical
English hard to read. Fails for sentences of more than 40 words and lines of more than 100
characters in Markdown and, with the path of the tofsmith program, for wider lines of help. Prose
means Markdown pages, comments and docstrings. `--list` prints every marked phrase.
"""

import ast
import io
import json
import os
import re
import subprocess
import sys
import tokenize
from collections import defaultdict
from pathlib import Path

MAX_RATE = 15  # marked phrases per 10,000 words
MAX_WORDS = 40  # per sentence
MAX_WIDTH = 100  # characters per line

# The pattern of each phrase, by the advice that replaces it.
MARKERS = {
    "write 'next to' or 'in addition to'": r"\bbeside\b",
    "name what the text, value or option does": r"\b(says|said|tells|told)\b",
    "write 'is' or 'is stored'": r"\b(stands|stood)\b",
    "give the number": r"\bso (many|far|large|much|few)\b",
    "repeat the noun": r"\bthose (of|that|which)\b",
    "name the thing": r"(?i)\bwhat (is|are|was|were|it|they|a|an|the|no|has|needs|can|may|must"
                      r"|follows|others|other|every)\b",
    "start with the subject": r"^(Of|What|Whether|Where|Also|Not|None|Nothing|Those|That)\b",
    "put the modifier first": r"\b(devices? of OpenCL|limit of band|sums? of measurements"
                              r"|codes? of the atlas|dumps? of)\b",
    "write 'is wrong'": r"\berrs?\b",
    "use a plain verb": r"\b(mend(s|ed)?|hangs on|goes? on|takes? for|left out|as it is"
                        r"|as they are|under way)\b",
    "write 'generate' or 'emit'": r"\b(play|plays|played|playable)\b",
    "write '...'": r"(?<!\.)\.\.(?!\.)(?=[ `]|$)",
    "write 'also' or 'its'": r"\b(likewise|of (its|their|one's|your) own)\b",
}
WORD = re.compile(r"[A-Za-z']+")


class Findings:
    """Counts words and marked phrases per folder and collects what breaks a rule."""

    def __init__(self):
        self.words = defaultdict(int)
        self.marked = defaultdict(list)
        self.faults = []

    def add_line(self, path, number, text):
        folder = path.split("/")[0] if "/" in path else "top"
        self.words[folder] += len(WORD.findall(text))
        for advice, pattern in MARKERS.items():
            for found in re.finditer(pattern, text):
                self.marked[folder].append(f"{path}:{number}: '{found[0]}': {advice}")

    def add_paragraph(self, path, number, text):
        for sentence in re.split(r"(?<=[.!?:;])\s+(?=[A-Z`*\[(])", text):
            words = len(WORD.findall(sentence))
            if words > MAX_WORDS:
                self.faults.append(
                    f"{path}:{number}: a sentence of {words} words, at most {MAX_WORDS}: "
                    f"'{sentence[:60].strip()} ...'")

    def add_width(self, place, text):
        if len(text) > MAX_WIDTH:
            self.faults.append(f"{place}: {len(text)} characters, at most {MAX_WIDTH}")


def without_code(text):
    """Replaces code, formulas and addresses of links by one word or nothing."""
    text = re.sub(r"`+[^`]*`+|\$[^$]*\$", "Code", text)
    return re.sub(r"\]\([^)]*\)|<[^>]*>", "", text)


def check_markdown(path, text, findings):
    paragraph, start, fenced = [], 0, False

    def finish():
        findings.add_paragraph(path, start, without_code(" ".join(paragraph)))
        paragraph.clear()

    for number, line in enumerate(text.splitlines(), 1):
        stripped = line.strip()
        if stripped.startswith(("```", "~~~", "$$")):
            if stripped.count("$$") != 2:  # two: a formula on one line
                fenced = not fenced
            finish()
            continue
        if fenced or line.startswith("    ") and not paragraph:
            continue
        findings.add_line(path, number, without_code(stripped))
        is_table = stripped.startswith("|")
        if re.match(r"\[[^]]*\]: ", stripped):  # the address of a link
            continue
        if not is_table and not re.search(r"^!\[|\]\(\S{40,}\)|https?://", stripped):
            findings.add_width(f"{path}:{number}", line)
        if not stripped or is_table or re.match(r"([-*+]|\d+\.|#+|>|<)\s*", stripped):
            finish()
        if is_table or not stripped or stripped.startswith(("#", "<")):
            continue
        if not paragraph:
            start = number
        paragraph.append(re.sub(r"^([-*+>]|\d+\.)\s+", "", stripped))
    finish()


def cpp_comments(text):
    """Yields the number and text of each line of a comment."""
    for number, line in enumerate(text.splitlines(), 1):
        found = re.search(r"(?:^|\s)(?://[/!]?<?|/\*\*|^ +\*(?!/)) ?(.*?)(?:\*/)?$", line)
        if found and "SPDX" not in line:
            yield number, found[1]


def python_comments(text):
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT and "SPDX" not in token.string:
            yield token.start[0], token.string.lstrip("#! ")
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)):
            docstring = ast.get_docstring(node)
            first = node.body[0].lineno if docstring else 0
            for offset, line in enumerate((docstring or "").splitlines()):
                yield first + offset, line.strip()


def shell_comments(text):
    for number, line in enumerate(text.splitlines(), 1):
        found = re.match(r"\s*# ?(?!!)(.*)", line)
        if found and "SPDX" not in line:
            yield number, found[1]


def check_comments(path, lines, findings):
    for number, text in lines:
        findings.add_line(path, number, without_code(text))


READERS = {".cpp": cpp_comments, ".hpp": cpp_comments, ".h": cpp_comments, ".cl": cpp_comments,
           ".js": cpp_comments, ".py": python_comments, ".sh": shell_comments,
           ".cmake": shell_comments}


def check_help(program, findings):
    listed = json.loads(subprocess.run([program, "--list-commands"], check=True, text=True,
                                       capture_output=True, timeout=60).stdout)
    for command in listed["commands"]:
        printed = subprocess.run([program, *command["words"], "--help"], check=True, text=True,
                                 capture_output=True, timeout=60,
                                 env={**os.environ, "COLUMNS": "100"}).stdout
        for line in printed.splitlines():
            findings.add_width(" ".join(["tofsmith", *command["words"], "--help"]), line)


def check_repository(root, findings):
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=root, check=True, capture_output=True,
                            text=True).stdout
    for path in filter(None, listed.split("\0")):
        suffix = ".cmake" if Path(path).name == "CMakeLists.txt" else Path(path).suffix
        if suffix not in (*READERS, ".md") or not (root / path).is_file():
            continue
        text = (root / path).read_text("utf-8")
        if suffix == ".md":
            check_markdown(path, text, findings)
        else:
            check_comments(path, READERS[suffix](text), findings)


def main(arguments):
    findings = Findings()
    check_repository(Path(__file__).resolve().parents[1], findings)
    programs = [argument for argument in arguments if argument != "--list"]
    for program in programs:
        check_help(program, findings)
    failed = bool(findings.faults)
    for folder, words in sorted(findings.words.items()):
        marked = findings.marked[folder]
        rate = 1e4 * len(marked) / max(words, 1)
        print(f"{folder:<12} {words:7d} words  {rate:5.1f} marked phrases per 10,000")
        # One phrase in a small folder is no habit.
        too_many = rate > MAX_RATE and len(marked) > 1
        failed |= too_many
        if too_many or "--list" in arguments:
            print(*marked, sep="\n")
    print(*findings.faults, sep="\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
