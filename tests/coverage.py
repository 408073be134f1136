#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Conditions of the sources that no test made true, or none false: coverage.py BUILD_FOLDER [TEXT], from what clang counted.

A line for each: where, what never was, the condition, its line; of files whose path has TEXT in it. The parts of a || b are
conditions of their own.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

SOURCE = Path(__file__).parents[1]


def conditions(binary, counts):
    """(path, line, column, end of it) of each condition, and how often it was true and false."""
    command = ["llvm-cov", "export", f"-instr-profile={counts}", binary]
    exported = subprocess.run(command, capture_output=True, check=True).stdout
    for file in json.loads(exported)["data"][0]["files"]:
        path = os.path.normpath(file["filename"])
        for line, column, last_line, last_column, true, false, *_ in file["branches"]:
            yield (path, line, column, last_column if last_line == line else None), (true, false)


def main(build, text=""):
    counts = build / "counts.profdata"
    profiles = [str(path) for path in (build / "profiles").glob("*.profraw")]
    # What was killed, as some tests do, leaves counts that cannot be read.
    subprocess.run(["llvm-profdata", "merge", "-sparse", "-failure-mode=all", "-o", counts, *profiles], check=True)
    totals = {}
    for binary in (build / "libmmbrdf.so", build / "mmbrdf", *build.glob("python/mmbrdf/_mmbrdf*.so")):
        for place, (true, false) in conditions(binary, counts):
            before = totals.get(place, (0, 0))
            totals[place] = (before[0] + true, before[1] + false)
    rooms = tuple(f"{SOURCE / room}/" for room in ("include", "src", "apps", "interfaces", "python"))
    ours = {place: seen for place, seen in totals.items() if place[0].startswith(rooms) and text in place[0]}
    for (path, line, column, end), (true, false) in sorted(ours.items(), key=lambda one: one[0][:3]):
        if true and false:
            continue
        what = "never true" if false else "never false" if true else "never asked"
        shown = Path(path).read_text(encoding="utf-8").splitlines()[line - 1]
        print(f"{Path(path).relative_to(SOURCE)}:{line}: {what}: {shown[column - 1 : end and end - 1]}  |  {shown.strip()}")
    seen = sum((true > 0) + (false > 0) for true, false in ours.values())
    print(f"{seen} of {2 * len(ours)} outcomes of conditions were seen")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), *sys.argv[2:3])
