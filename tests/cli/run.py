#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Replays transcripts: files of shell commands and what they are expected to print.

    # Text before the first command is a comment; so are lines that begin
    # with # between an empty line and a command.
    $ mmbrdf evaluate ptfe --wavelength 532 --incident 45,0 --reflected 30,180 --format csv
    wavelength_nm,theta_i_deg,...
    532,45,...

    # After an empty line again a comment.
    $ mmbrdf info nowhere.json
    mmbrdf: nowhere.json: no such file, and not a built-in model (ptfe, ...)
    [exit 1]

    ? test -d "$MMBRDF_DATA"
    $ mmbrdf fit "$MMBRDF_DATA/PTFE.data.csv" | head -1

$ COMMAND   Run by bash with pipefail; standard output and error together must be the lines that
            follow, and the exit status 0, or N where the last line is [exit N]. Of a command with
            a pipe, standard error follows standard output: which of them comes first is chance.
? COMMAND   If it fails, the rest of the file is skipped (exit status 77).
...         alone on a line: any number of lines, also none.

A line that differs is still equal if only its numbers and the width of its gaps differ, each number
by at most 1e-9 of its value or 1e-12. A number is a decimal literal that does not continue a word:
f11 and germer2017 hold none. Empty lines at the end of an output do not count.

Of a Markdown page, the code blocks that begin with a command are the transcript.
A code block that begins with a remark which is the name of a file, "# plaque.py" or "// tracer.cpp", is that
file, there when the commands below it run. Pictures that a page shows and that do not lie beside it are made by its
commands; --pictures FOLDER keeps them.

All commands of a file run in one fresh folder, with the programs first on the PATH, then the Python that runs
this. MMBRDF_SOURCE is the source folder and MMBRDF_DATA the published data; in an output their paths are printed
as these names.
"""

import argparse
import difflib
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

SKIPPED = 77
NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?!\w)")
PIPE = re.compile(r"(?<!\|)\|(?!\|)")


PICTURE = re.compile(r"!\[[^\]]*\]\(([\w.-]+)\)")
PAGE_BLOCK = re.compile(r"^```\w*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE_BLOCK = re.compile(r"(?:#|//) (\w[\w-]*\.\w+)\n")


@dataclass
class Step:
    kind: str  # "$", "?", or of a page ">": a file to be written
    command: str
    expected: list = field(default_factory=list)  # output lines, [exit N] included
    after: list = field(default_factory=list)  # empty lines and comments before the next step


def steps_of_page(text):
    """The code blocks of a Markdown page that begin with a command, and those that are files."""
    steps = []
    for block in PAGE_BLOCK.findall(text):
        if block.startswith("$ "):
            steps += parse(block)[1]
        elif name := FILE_BLOCK.match(block):
            steps.append(Step(">", name[1], block.splitlines()))
    return steps


def parse(text):
    """The lines before the first step, and the steps."""
    before, steps = [], []
    for line in text.splitlines():
        if line[:2] in ("$ ", "? "):
            steps.append(Step(line[0], line[2:]))
        elif steps:
            steps[-1].expected.append(line)
        else:
            before.append(line)
    for step in steps:
        lines = step.expected
        tail = len(lines)
        while tail > 0 and (not lines[tail - 1] or lines[tail - 1].startswith("#")):
            tail -= 1
        while tail < len(lines) and lines[tail]:  # the output's own # lines, up to the empty one
            tail += 1
        step.expected, step.after = lines[:tail], lines[tail:]
    return before, steps


def page_with_steps(text, steps):
    """A page whose blocks of commands are these, in their order."""
    left = iter(step for step in steps if step.kind != ">")

    def block(found):
        here = [next(left) for _ in parse(found[1])[1]] if found[1].startswith("$ ") else []
        return found[0].replace(found[1], unparse([], here)) if here else found[0]

    return PAGE_BLOCK.sub(block, text)


def unparse(before, steps):
    lines = list(before)
    for step in steps:
        lines += [f"{step.kind} {step.command}", *step.expected, *step.after]
    return "\n".join(lines) + "\n"


def same_number(a, b):
    a, b = float(a), float(b)
    return abs(a - b) <= max(1e-9 * max(abs(a), abs(b)), 1e-12)


def same_line(expected, actual):
    if expected == actual:
        return True
    words_e, words_a = (" ".join(NUMBER.sub("#", line).split()) for line in (expected, actual))
    numbers_e, numbers_a = NUMBER.findall(expected), NUMBER.findall(actual)
    return (
        words_e == words_a
        and len(numbers_e) == len(numbers_a)
        and all(map(same_number, numbers_e, numbers_a))
    )


def same_output(expected, actual):
    if not expected:
        return not actual
    if expected[0] == "...":
        return any(same_output(expected[1:], actual[k:]) for k in range(len(actual) + 1))
    return bool(actual) and same_line(expected[0], actual[0]) and same_output(expected[1:], actual[1:])


class Shell:
    """Runs commands in one folder, and prints the paths of this machine as names."""

    def __init__(self, folder, programs, source):
        data = os.environ.get("MMBRDF_DATA") or str(source.parent / "shared/data/germer2017")
        self.folder = folder
        self.names = {data: "$MMBRDF_DATA", str(source): "$MMBRDF_SOURCE"}
        self.environment = {
            **os.environ,
            "LC_ALL": "C.UTF-8",
            "MMBRDF_DATA": data,
            "MMBRDF_SOURCE": str(source),
            "PATH": os.pathsep.join([str(programs), os.path.dirname(sys.executable), os.environ["PATH"]]),
        }

    def run(self, command):
        """Output lines, with [exit N] at the end unless N = 0."""
        done = subprocess.run(
            ["bash", "-o", "pipefail", "-c", command],
            cwd=self.folder,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE if PIPE.search(command) else subprocess.STDOUT,
        )
        text = (done.stdout + (done.stderr or b"")).decode(errors="replace")
        for path, name in self.names.items():
            text = text.replace(path, name)
        lines = text.rstrip("\n").split("\n") if text.strip("\n") else []
        return lines + ([f"[exit {done.returncode}]"] if done.returncode else [])


def print_difference(path, step, actual):
    shown = [next((e for e in step.expected if same_line(e, a)), a) for a in actual]
    print(f"{path}: unexpected output\n$ {step.command}")
    difference = difflib.unified_diff(step.expected, shown, "expected", "actual", lineterm="")
    print("\n".join(difference), end="\n\n")


def replay(path, options):
    """Exit status for one file: 0, 1 or SKIPPED."""
    text = path.read_text(encoding="utf-8")
    is_page = path.suffix == ".md"
    before, steps = ([], steps_of_page(text)) if is_page else parse(text)
    if not any(step.kind == "$" for step in steps):
        print(f"{path}: no command")
        return 1
    failed = skipped = unmade = False
    with tempfile.TemporaryDirectory(prefix="mmbrdf-cli-") as folder:
        shell = Shell(folder, options.programs.resolve(), options.source.resolve())
        for step in steps:
            if step.kind == ">":
                Path(folder, step.command).write_text("\n".join(step.expected) + "\n", encoding="utf-8")
                continue
            actual = shell.run(step.command)
            if step.kind == "?":
                if actual and actual[-1].startswith("[exit "):
                    print(f"skipped: {path.name} from here: {step.command}")
                    skipped = True
                    break
            elif not same_output(step.expected, actual):
                print_difference(path, step, actual)
                step.expected = actual
                failed = True
        for name in PICTURE.findall(text) if is_page and not skipped else ():
            if not Path(folder, name).is_file():
                if not (path.parent / name).is_file():
                    print(f"{path}: no command makes {name}")
                    unmade = True
            elif options.pictures and not failed:
                options.pictures.mkdir(parents=True, exist_ok=True)
                shutil.copy(Path(folder, name), options.pictures / name)
    if failed and options.update:
        path.write_text(page_with_steps(text, steps) if is_page else unparse(before, steps), encoding="utf-8")
        print(f"{path}: updated")
        failed = False
    return 1 if failed or unmade else SKIPPED if skipped else 0


def main(arguments=None):
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    here = Path(__file__).resolve().parents[2]
    parser.add_argument("transcripts", nargs="+", type=Path)
    parser.add_argument("--programs", type=Path, default=here / "build/release", help="folder of the built program")
    parser.add_argument("--source", type=Path, default=here, help="source folder")
    parser.add_argument("--update", action="store_true", help="write what the commands print into the transcripts")
    parser.add_argument("--pictures", type=Path, metavar="FOLDER", help="where pictures of pages are kept")
    options = parser.parse_args(arguments)
    results = [replay(path, options) for path in options.transcripts]
    return 1 if 1 in results else max(results)


if __name__ == "__main__":
    sys.exit(main())
