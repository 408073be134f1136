#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a call from Python costs beside the same call of the C++ library, in one run.

    PYTHONPATH=build/release/python apps/bench/python.py build/release/mmbrdf-bench

Both evaluate 1 048 576 geometries given as angles, in turn, into memory that is there. Times are of the processor, the
smallest of all rounds; with two threads on the wall.
"""

import json
import subprocess
import sys
import time

import mmbrdf

POINTS = 1 << 20
ROUNDS = 5


def library_ns(program: str, threads: int) -> float:
    name = f"^evaluate_isotropic/batch/angles/memory/{threads}(/|$)"
    printed = subprocess.run(
        [program, f"--benchmark_filter={name}", "--benchmark_format=json", "--benchmark_min_time=0.3"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    (run,) = json.loads(printed)["benchmarks"]
    return run["ns_per_evaluation"]


def python_ns(model: mmbrdf.Model, geometry: mmbrdf.Geometry, threads: int, out) -> float:
    clock = time.process_time if threads == 1 else time.perf_counter
    best = float("inf")
    for _ in range(15):
        begin = clock()
        model.evaluate(532, *geometry, threads=threads, out=out)
        best = min(best, clock() - begin)
    return best / POINTS * 1e9


def main() -> None:
    model = mmbrdf.material("ptfe")
    geometry = mmbrdf.random_geometries(POINTS, seed=1)
    out = model.evaluate(532, *geometry)
    print("threads  library ns  python ns  ratio")
    for threads in (1, 2):
        rounds = [(library_ns(sys.argv[1], threads), python_ns(model, geometry, threads, out)) for _ in range(ROUNDS)]
        library, python = (min(times) for times in zip(*rounds))
        print(f"{threads:7d}  {library:10.1f}  {python:9.1f}  {python / library:5.2f}")


if __name__ == "__main__":
    main()
