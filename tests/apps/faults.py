# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Checks every command that writes with failing system calls, kills, signals, concurrent processes
with the same output, and jumps of the clock.

    faults.py TOFSMITH SHIM [--seconds N] [--seed S] [NAME ...]    runs for N seconds, prints counts

Guarantees after a failed call: exit code 1 and a message (with the output, unless memory was
insufficient), or success if the call was optional; no partial file under its final name; earlier
files unchanged; no hidden file; and the same command, run again, gives the same bytes. After a
kill, a signal or insufficient memory, hidden files may remain; the next run removes them."""

import argparse
import collections
import errno
import os
import random
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time

from writing_commands import COMMANDS, make_inputs

ERRORS = {
    "write": (errno.ENOSPC, errno.EIO),
    "sync": (errno.EIO, errno.ENOSPC),
    "rename": (errno.EACCES, errno.ENOSPC, errno.EIO),
    "open": (errno.EACCES, errno.ENOSPC, errno.EROFS),
    "mkdir": (errno.EACCES, errno.ENOSPC),
    "mmap": (errno.ENOMEM,),
    "malloc": (errno.ENOMEM,),
}
DISK = ("write", "sync", "rename", "open", "mkdir")
HIDDEN = re.compile(r"(^|/)\.tofsmith-")
OF_SQLITE = re.compile(r"-(wal|shm|journal|lock)$")


class Broken(AssertionError):
    """A violated guarantee."""


def require(holds, *what):
    if not holds:
        raise Broken(" ".join(str(w) for w in what))


def is_whole(name, content):
    """Returns whether a file with times, which differs between runs, is complete."""
    if name.endswith(".html"):
        return content.rstrip().endswith(b"</html>")
    if name.endswith(".json"):
        return content.rstrip().endswith(b"}")
    return len(content) > 0


class Rig:
    """Runs commands in separate directories with copies of the inputs."""

    def __init__(self, tool, shim, work):
        self.tool, self.shim, self.work = tool, shim, work
        self.inputs = os.path.join(work, "inputs")
        os.mkdir(self.inputs)
        make_inputs(tool, self.inputs)
        self.there = self.snapshot(self.inputs)
        self.directory = os.path.join(work, "run")
        self.cleans = {}

    @staticmethod
    def snapshot(directory):
        found = {}
        for folder, _, files in os.walk(directory):
            for name in files:
                path = os.path.join(folder, name)
                with open(path, "rb") as file:
                    found[os.path.relpath(path, directory)] = file.read()
        return found

    def fresh(self, earlier=()):
        shutil.rmtree(self.directory, ignore_errors=True)
        shutil.copytree(self.inputs, self.directory)
        for name, content in dict(earlier).items():
            path = os.path.join(self.directory, name)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "wb") as file:
                file.write(content)

    def made(self):
        """Returns all files except the inputs, which must be unchanged."""
        found = self.snapshot(self.directory)
        for name, content in self.there.items():
            # Readers of a store may modify it.
            require(found.pop(name, None) == content or name.endswith(".sqlite"), name,
                    "is an input and was changed")
        return {name: content for name, content in found.items() if not OF_SQLITE.search(name)}

    def words(self, command, force):
        return [self.tool, "--quiet", *command.arguments, *(["--force"] if force else [])]

    def start(self, command, force=False, **settings):
        environment = {k: v for k, v in os.environ.items() if not k.startswith("TOFSMITH_")}
        environment["LD_PRELOAD"] = self.shim
        for key, value in settings.items():
            environment["TOFSMITH_FAULT_" + key.upper()] = str(value)
        return subprocess.Popen(self.words(command, force), cwd=self.directory, env=environment,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)

    def run(self, command, force=False, **settings):
        process = self.start(command, force, **settings)
        error = process.communicate(timeout=120)[1]
        return process.returncode, error.decode(errors="replace")

    def clean(self, command, force=False):
        """Returns the files of a run without faults, which of them differ between runs, its calls,
        and its duration. Reports contain the command line, so that --force matters."""
        if (command.name, force) not in self.cleans:
            counts = os.path.join(self.work, "counts")
            runs = []
            for _ in range(2):
                self.fresh()
                begin = time.monotonic()
                code, error = self.run(command, force, counts=counts)
                seconds = time.monotonic() - begin
                require(code == 0, "a clean run fails:", error)
                runs.append(self.made())
            with open(counts, encoding="utf-8") as file:
                calls = {line.split()[0]: int(line.split()[1]) for line in file}
            require(runs[0].keys() == runs[1].keys(), "two clean runs make different files")
            differ = {name for name in runs[0] if runs[0][name] != runs[1][name]}
            differ.update(command.timed)  # two runs may take equally long
            self.cleans[command.name, force] = (runs[0], differ, calls, seconds)
        return self.cleans[command.name, force]

    def check_files(self, command, earlier, after_kill, force=False):
        """Checks that no file is partial: each is either an earlier file or complete."""
        whole, differ, _, _ = self.clean(command, force)
        for name, content in self.made().items():
            if HIDDEN.search(name):
                require(after_kill, "a hidden file is left:", name)
            elif name in earlier and content == earlier[name]:
                pass
            elif name in whole:
                if name.endswith(".sqlite"):
                    continue  # it may be the journal of a store
                require(is_whole(name, content) if name in differ else content == whole[name],
                        "a part of a file:", name, f"({len(content)} of {len(whole[name])} bytes)")
            else:
                require(command.also and name.startswith(command.also), "an unknown file:", name)

    def check_rerun(self, command, force):
        whole, differ, _, _ = self.clean(command, force)
        before = self.made()
        code, error = self.run(command, force)
        found = self.made()
        if code == 1 and re.search("already exists", error):
            # Everything was completed: the command is rejected as after any complete run.
            require(whole.keys() <= before.keys(), "the same command does not go on:", error)
        else:
            require(code == 0, "the same command does not go on:", error)
        for name in found:
            require(not HIDDEN.search(name), "the next run leaves a hidden file:", name)
        for name, content in whole.items():
            require(name in found, "the next run does not make", name)
            if name.endswith(".sqlite"):
                with sqlite3.connect(os.path.join(self.directory, name)) as store:
                    require(store.execute("pragma integrity_check").fetchone() == ("ok",), name)
                store.close()
            elif name not in differ:
                require(found[name] == content, "the next run makes other bytes:", name)

    def earlier_files(self, command):
        whole, _, _, _ = self.clean(command)
        return {name: b"earlier\n" for name in whole
                if name in command.outputs and not name.endswith(".sqlite")}

    def fail(self, command, call, at, number, stays=False, over=False):
        """Runs with a failing call. @return its exit code"""
        earlier = self.earlier_files(command) if over else {}
        whole, differ, _, _ = self.clean(command, over)
        self.fresh(earlier)
        code, error = self.run(command, over, call=call, at=at, errno=number, stays=int(stays))
        if call == "malloc" and code == -signal.SIGABRT and "Fatal glibc error" in error:
            # If glibc cannot register a thread's destructor, it ends the process itself.
            require("out of memory" in error, "no message:", error)
            self.check_files(command, earlier, after_kill=True, force=over)
            self.check_rerun(command, over)
            return code
        require(code in (0, 1), "exit code", code, error)
        if "items failed" in error:  # exports contain finished items
            for name in self.made():
                require(not HIDDEN.search(name), "a hidden file is left:", name)
            self.check_rerun(command, True)
            return code
        # If no destructor can allocate memory, the process ends as if killed.
        self.check_files(command, earlier, after_kill=call not in DISK, force=over)
        if code == 0:
            found = self.made()
            for name, content in whole.items():
                require(name in found and (name in differ or name.endswith(".sqlite")
                                           or found[name] == content),
                        "success without", name)
            return code
        require(error.startswith("tofsmith: ") or "\ntofsmith: " in error, "no message:", error)
        if call in DISK:
            names = {*command.outputs, *whole,
                     *(word for word in command.arguments if "." in word)}
            require(any(name in error for name in names), "the message names no output:", error)
        self.check_rerun(command, over)
        return code

    def kill(self, command, call, at):
        self.fresh()
        code, _ = self.run(command, call=call, at=at, errno=0)
        self.check_files(command, {}, after_kill=True)
        self.check_rerun(command, False)
        return code

    def signal_after(self, command, number, seconds):
        """Sends a signal after `seconds`. @return the exit code; None if the run had ended"""
        self.fresh()
        process = self.start(command)
        time.sleep(seconds)
        if process.poll() is not None:
            process.communicate()
            return None
        process.send_signal(number)
        error = process.communicate(timeout=60)[1].decode(errors="replace")
        code = process.returncode
        if number == signal.SIGKILL:
            require(code in (-number, 0), "exit code", code)
        else:
            # Before main() has installed its handler, the default one applies.
            require(code in (0, 130, -number), "exit code", code, error)
        self.check_files(command, {}, after_kill=code != 0)
        if code != 0:
            self.check_rerun(command, False)
        return code

    def two_at_once(self, command):
        """Runs two processes with the same output: one completes, the other completes or is
        rejected."""
        self.fresh()
        pair = [self.start(command) for _ in range(2)]
        errors = [process.communicate(timeout=120)[1].decode(errors="replace") for process in pair]
        codes = [process.returncode for process in pair]
        require(0 in codes and set(codes) <= {0, 1}, "exit codes", codes, errors)
        self.check_files(command, {}, after_kill=False)
        whole, _, _, _ = self.clean(command)
        require(whole.keys() <= self.made().keys(), "a file is missing")

    def jump_clock(self, command):
        whole, differ, _, _ = self.clean(command)
        self.fresh()
        code, error = self.run(command, clock=86400)
        require(code == 0, "exit code", code, error)
        found = self.made()
        for name, content in whole.items():
            require(name in found and (name in differ or name.endswith(".sqlite")
                                       or found[name] == content), "other bytes:", name)


def each_fault(rig, command, rng, most_per_kind):
    """Yields (call, at, errno, stays, over), at most `most_per_kind` for each kind of call."""
    calls = rig.clean(command)[2]
    for call, numbers in ERRORS.items():
        count = calls[call]
        places = range(1, count + 1)
        if count > most_per_kind:
            places = sorted(rng.sample(places, most_per_kind))
        for at in places:
            if call in DISK:
                for number in numbers:
                    for stays in (False, True):
                        for over in (False, True):
                            yield call, at, number, stays, over
            else:
                yield call, at, numbers[0], False, rng.random() < 0.5


class Tally:
    def __init__(self):
        self.done = collections.Counter()
        self.broken = collections.Counter()
        self.first = {}

    def count(self, kind, command, what, action):
        self.done[kind] += 1
        try:
            return action()
        except (Broken, subprocess.TimeoutExpired) as problem:
            message = re.sub(r"\d+", "N", str(problem))[:100]
            self.broken[command.name, kind, message] += 1
            self.first.setdefault((command.name, kind, message), (what, str(problem)))
            return "broken"

    def report(self):
        lines = [f"{kind:24} {count:7}" for kind, count in sorted(self.done.items())]
        for key, count in self.broken.most_common():
            what, problem = self.first[key]
            lines.append(f"BROKEN {count:5} x {key[0]}: {key[1]}: {problem.strip()} "
                         f"(first: {what})")
        return "\n".join(lines)


def run_all(rig, commands, seconds, seed):
    """Repeats rounds over all commands until the time is over, with more faults in every round."""
    rng = random.Random(seed)
    tally = Tally()
    end = time.monotonic() + seconds
    signals = (signal.SIGKILL, signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT,
               signal.SIGHUP)
    done = collections.defaultdict(set)
    while time.monotonic() < end:
        for command in commands:
            most = 2 if command.is_slow else 40
            for fault in each_fault(rig, command, rng, most):
                if time.monotonic() > end:
                    return tally
                if fault[0] in DISK and fault in done[command.name]:
                    continue
                done[command.name].add(fault)
                if command.is_slow and rng.random() < 0.8:
                    continue
                code = tally.count("failed " + fault[0], command, fault,
                                   lambda f=fault: rig.fail(command, *f))
                tally.done[f"  exit code {code}"] += 1
            calls = rig.clean(command)[2]
            for call in DISK:
                places = range(1, calls[call] + 1)
                for at in rng.sample(places, min(len(places), 1 if command.is_slow else 6)):
                    tally.count("killed at a call", command, (call, at),
                                lambda c=call, a=at: rig.kill(command, c, a))
            for _ in range(2 if command.is_slow else 20):
                number = rng.choice(signals)
                after = rng.uniform(0, 1.1 * rig.clean(command)[3])
                kind = ("killed at a random time" if number == signal.SIGKILL
                        else "signal at a random time")
                if tally.count(kind, command, (number, after),
                               lambda n=number, a=after: rig.signal_after(command, n, a)) is None:
                    tally.done[kind] -= 1
                    tally.done["  done before"] += 1
            tally.count("two at once", command, (), lambda: rig.two_at_once(command))
            tally.count("clock jumps", command, (), lambda: rig.jump_clock(command))
    return tally


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tool")
    parser.add_argument("shim")
    parser.add_argument("names", nargs="*")
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    commands = [c for c in COMMANDS
                if not arguments.names or any(n in c.name for n in arguments.names)]
    with tempfile.TemporaryDirectory(prefix="tofsmith-faults-") as work:
        rig = Rig(os.path.abspath(arguments.tool), os.path.abspath(arguments.shim), work)
        tally = run_all(rig, commands, arguments.seconds, arguments.seed)
    print(tally.report())
    return 1 if tally.broken else 0


if __name__ == "__main__":
    sys.exit(main())
