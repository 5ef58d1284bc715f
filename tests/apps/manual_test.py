# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Manual pages and shell completions contain every command and option.

    manual_test.py TOOL MANUAL_DIRECTORY COMPLETION_DIRECTORY
"""

import os
import re
import shutil
import subprocess
import sys
import unittest

from command_line import CommandLineTest

MANUAL = os.path.abspath(sys.argv.pop(1))
COMPLETION = os.path.abspath(sys.argv.pop(1))

# Simulates what readline does before and after it calls the function.
COMPLETE_LINES = r"""
source "$1"
while IFS= read -r line; do
  read -ra COMP_WORDS <<<"${line//=/ = }"
  [[ $line == *[\ =] ]] && COMP_WORDS+=("")
  COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
  COMPREPLY=()
  _tofsmith
  echo "${COMPREPLY[*]}"
done
"""


class Manual(CommandLineTest):
    def commands(self):
        return self.do_json("--list-commands")["commands"]

    def test_the_listing_equals_help(self):
        for command in self.commands():
            text = self.do(*command["words"], "--help-all")
            for argument in command["options"] + command["positionals"]:
                for name in argument["names"]:
                    self.assertIn(name, text, command["words"])
            for option in re.findall(r"^  (?:-\w,)?(--[\w-]+)", text, re.MULTILINE):
                known = [name for o in command["options"] for name in o["names"]]
                self.assertIn(option, known, command["words"])

    def test_help_shows_few_options_and_mentions_further_ones(self):
        for command in self.commands():
            text = self.do(*command["words"], "--help")
            shown = set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", text, re.MULTILINE))
            usual = [o for o in command["options"] if not o.get("for_experts")]
            experts = [o for o in command["options"] if o.get("for_experts")]
            self.assertEqual(shown, {o["names"][-1] for o in usual}, command["words"])
            self.assertLessEqual(len(shown - {"--help", "--help-all"}), 20, command["words"])
            if experts:
                self.assertIn(f"{len(experts)} more options: " +
                              " ".join(["tofsmith", *command["words"], "--help-all"]), text)

    def test_the_listing_is_hidden(self):
        self.assertNotIn("--list-commands", self.do("--help"))
        code, _, error = self.run_tool("--list-comands")
        self.assertEqual(code, 2)
        self.assertNotIn("--list-commands", error)

    def test_every_command_has_a_page_with_its_options(self):
        pages = set()
        for command in self.commands():
            name = "-".join(["tofsmith", *command["words"]]) + ".1"
            pages.add(name)
            with open(os.path.join(MANUAL, name), encoding="utf-8") as file:
                text = file.read()
            self.assertIn("\\- ", text[text.index(".SH NAME"):])
            for argument in command["options"] + command["positionals"]:
                for option in argument["names"]:
                    self.assertIn(option.replace("-", "\\-"), text, name)
        self.assertEqual(pages, set(os.listdir(MANUAL)))

    @unittest.skipUnless(shutil.which("groff"), "groff is not installed")
    def test_pages_are_formatted_without_warnings(self):
        for name in sorted(os.listdir(MANUAL)):
            done = subprocess.run(["groff", "-Tutf8", "-ww", "-man", "-rLL=78n",
                                   os.path.join(MANUAL, name)], capture_output=True, check=True)
            self.assertEqual(done.stderr.decode(), "", name)


@unittest.skipUnless(shutil.which("bash"), "bash is not installed")
class Bash(CommandLineTest):
    def complete(self, *lines):
        done = subprocess.run(["bash", "-c", COMPLETE_LINES, "bash",
                               os.path.join(COMPLETION, "tofsmith")],
                              input="".join(line + "\n" for line in lines), cwd=self.directory,
                              capture_output=True, text=True, check=True)
        self.assertEqual(done.stderr, "")
        return [set(line.split(" ")) - {""} for line in done.stdout.split("\n")[:-1]]

    def test_every_command_and_option(self):
        commands = self.do_json("--list-commands")["commands"]
        lines = [" ".join(["tofsmith", *c["words"]]) for c in commands]
        for command, found in zip(commands, self.complete(*(line + " " for line in lines))):
            self.assertLessEqual(set(command["subcommands"]), found, command["words"])
        general = {"--json", "--force", "--quiet", "--threads"}
        for command, found in zip(commands, self.complete(*(line + " -" for line in lines))):
            options = {name for option in command["options"] for name in option["names"]}
            self.assertEqual(found, options | general, command["words"])

    def test_subcommands(self):
        self.assertEqual(self.complete("tofsmith cal", "tofsmith calibrate no",
                                       "tofsmith --threads 2 calibrate im"),
                         [{"calibrate"}, {"noise"}, {"impulse-response"}])

    def test_values(self):
        found = self.complete("tofsmith design --method ", "tofsmith design --method=se",
                              "tofsmith design --method = o", "tofsmith evaluate --camera pap",
                              "tofsmith evaluate hamil", "tofsmith simulate table",
                              "tofsmith decode x.npy --method=z")
        self.assertEqual(found[0], {"factorize", "optimize", "search", "frequencies", "best", "atlas"})
        self.assertEqual(found[1:3], [{"search"}, {"optimize"}])
        self.assertIn("paper-10f0", found[3])
        self.assertIn("hamiltonian-k4", found[4])
        self.assertEqual(found[5:], [{"table-top"}, {"zncc"}])

    def test_files_are_offered_with_names_and_if_no_name_matches(self):
        self.write("paper-mine.toml", "")
        self.write("data.npy", "")
        names, after = self.complete("tofsmith design --camera paper-",
                                     "tofsmith evaluate --camera paper-10f0 -o paper-")
        self.assertLessEqual({"paper-10f0", "paper-mine.toml"}, names)
        self.assertEqual(after, set())  # then readline itself offers files
        with open(os.path.join(COMPLETION, "tofsmith"), encoding="utf-8") as file:
            self.assertIn("complete -o bashdefault -o default", file.read())

    def test_a_value_is_not_mistaken_for_a_command(self):
        self.assertEqual(self.complete("tofsmith sweep --store merge --rep"), [{"--report"}])


class OtherShells(CommandLineTest):
    def check(self, shell, name):
        if not shutil.which(shell):
            self.skipTest(f"{shell} is not installed")
        done = subprocess.run([shell, "-n", os.path.join(COMPLETION, name)], capture_output=True,
                              text=True, check=True)
        self.assertEqual(done.stderr, "")

    def test_zsh_accepts_its_file(self):
        self.check("zsh", "_tofsmith")

    def test_fish_accepts_its_file(self):
        self.check("fish", "tofsmith.fish")


if __name__ == "__main__":
    unittest.main()
