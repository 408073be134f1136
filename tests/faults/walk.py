# SPDX-License-Identifier: BSD-3-Clause
"""Injected faults: each call to the system of some commands fails, is cut short or is interrupted, one at a time.

Whatever happens, an output is the old one or the new one as a whole, exit status 0 means the new one, any other is
explained in one line, and nothing else is left behind. Where the destructor of the JSON library or the
buffers of the standard streams find no memory the process is aborted: the rest holds there too, and the table has the
number, which may be one in twenty where a hundred allocations or more are tried.

    tests/faults/walk.py PROGRAM LIBRARY             about a minute: some of the calls
    tests/faults/walk.py PROGRAM LIBRARY --points N  at most N of each command and kind; 0: every one
"""

import argparse
import collections
import os
import pathlib
import signal
import subprocess
import sys
import tempfile

KINDS = {
    "write": ("error", "cut", "interrupted"),
    "read": ("error", "cut", "interrupted"),
    "close": ("error", "interrupted"),
    "fsync": ("error", "interrupted"),
    "rename": ("error",),
    "pthread_create": ("error",),
    "malloc": ("error",),
}
PREPARATION = """
simulate ptfe --grid random:60 -w 532 --noise speckle:0.01 -o data.csv
simulate ptfe --grid random:3000 -w 532 -o rows.csv
fit data.csv --orders 2,1 --basis germer2017 -o model.json
simulate model.json --grid random:4 --raw raw
calibrate raw/references.csv --film 1.4607,1.0,4.15,0.044 -o instrument.json
"""
COMMANDS = {
    "evaluate": ("evaluate model.json -g rows.csv --threads 3 -o out.csv", ["out.csv"]),
    "evaluate .npy": ("evaluate model.json -g rows.csv --threads 3 -o out.npy", ["out.npy"]),
    "fit": ("fit data.csv --orders 2,1 --basis germer2017 -o out.json", ["out.json"]),
    "fit --declare": ("fit data.csv --orders 2,1 --declare scale=0.3% -o out.json", ["out.json"], ["pthread_create"]),
    "convert": ("convert model.json out.json", ["out.json"]),
    "simulate": ("simulate model.json --grid random:50 -o out.csv", ["out.csv"]),
    "simulate --raw": ("simulate model.json --grid random:4 --raw out", ["out/references.csv", "out/raw.csv"]),
    "reduce": ("reduce raw/raw.csv --instrument instrument.json --solid-angle 1.114e-4 -o out.csv", ["out.csv"]),
    "analyze": ("analyze model.json -g data.csv -o out.csv", ["out.csv"]),
    "report": ("report model.json data.csv -o out.json", ["out.json"]),
}
OLD = b"old\n"


def run(program, line, folder, environment=None):
    return subprocess.run(
        [program, *line.split()],
        cwd=folder,
        env={**os.environ, **(environment or {})},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        timeout=120,
    )


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


class Walk:
    def __init__(self, program, library, folder):
        self.program, self.library, self.folder = program, library, folder
        self.points, self.aborts = collections.Counter(), collections.Counter()
        self.violations = []
        for line in PREPARATION.strip().splitlines():
            run(program, line, folder).check_returncode()
        self.inputs = contents(folder)

    def failing(self, line, call, at, how):
        environment = {"FAIL": f"{call}:{at}:{how}", "LD_PRELOAD": str(self.library)}
        return run(self.program, line, self.folder, environment)

    def count(self, line, call):
        count = self.folder.parent / "count"
        environment = {"FAIL": f"{call}:0:error", "FAIL_COUNT": str(count), "LD_PRELOAD": str(self.library)}
        run(self.program, line, self.folder, environment)
        return int(count.read_text())

    def put_old(self, outputs):
        for output in outputs:
            (self.folder / output).parent.mkdir(exist_ok=True)
            (self.folder / output).write_bytes(OLD)

    def wrong(self, name, result, outputs, new, printed):
        """What is wrong after a command; nothing if all is well."""
        there = contents(self.folder)
        found = {name: there.pop(name, None) for name in outputs}
        is_new, is_old = found == new, all(text == OLD for text in found.values())
        talk = [line for line in result.stderr.decode(errors="replace").splitlines() if ": warning: " not in line]
        talk = [line for line in talk if ": note: " not in line]
        if there != self.inputs:
            return f"left behind: {sorted(set(there) ^ set(self.inputs))}"
        if not is_new and not is_old:
            return "neither old nor new"
        if result.returncode == 0:
            return "" if is_new and result.stdout == printed else "exit status 0, but not all is there"
        if result.returncode == -signal.SIGABRT and b"std::bad_alloc" in result.stderr:
            self.aborts[name] += 1
            return ""
        if result.returncode != 1:
            return f"exit status {result.returncode}"
        if len(talk) != 1 or not talk[0].startswith("mmbrdf: "):
            return f"not explained in one line: {talk}"
        return "" if is_old or "is written" in talk[0] else "exit status 1, but the new one is there"

    def command(self, name, most):
        line, outputs, *only = COMMANDS[name]
        self.put_old(outputs)
        reference = run(self.program, line, self.folder)
        reference.check_returncode()
        new = {output: (self.folder / output).read_bytes() for output in outputs}
        for call, ways in KINDS.items():
            if only and call not in only[0]:
                continue
            calls = self.count(line, call)
            step = 1 if most == 0 else max(1, calls * len(ways) / most)
            for at in sorted({int(k * step) + 1 for k in range(int(calls / step))}):
                for how in ways:
                    self.put_old(outputs)
                    result = self.failing(line, call, at, how)
                    self.points[name, call] += 1
                    wrong = self.wrong(name, result, outputs, new, reference.stdout)
                    if not wrong and call == "pthread_create" and result.returncode != 0:
                        wrong = "the threads that there are did not do the work"
                    if wrong:
                        self.violations.append(f"{name}: {call} {at} {how}: {wrong}")
                        self.clean(outputs)
        self.clean(outputs, all_of_it=True)

    def clean(self, outputs, all_of_it=False):
        for path in self.folder.rglob("*"):
            name = str(path.relative_to(self.folder))
            if path.is_file() and name not in self.inputs and (all_of_it or name not in outputs):
                path.unlink()

    def table(self):
        print(f"{'':15}" + "".join(f"{call:>15}" for call in KINDS) + f"{'aborted':>15}{'violations':>15}")
        for name in COMMANDS:
            wrong = sum(violation.startswith(name + ": ") for violation in self.violations)
            print(
                f"{name:15}"
                + "".join(f"{self.points[name, call]:15}" for call in KINDS)
                + f"{self.aborts[name]:15}{wrong:15}"
            )
        print(f"{sum(self.points.values())} points, {len(self.violations)} violations")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("--points", type=int, default=12, help="of each command and kind [12]; 0: all")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as parent:
        folder = pathlib.Path(parent) / "here"
        folder.mkdir()
        walk = Walk(options.program.resolve(), options.library.resolve(), folder)
        for name in COMMANDS:
            walk.command(name, options.points)
    walk.table()
    print("\n".join(walk.violations[:100]))
    many = [name for name in COMMANDS if walk.aborts[name] * 20 > walk.points[name, "malloc"] >= 100]
    print("".join(f"{name}: aborted too often\n" for name in many), end="")
    return 1 if walk.violations or many else 0


if __name__ == "__main__":
    sys.exit(main())
