#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Asks much of the program at once, and prints a table: run.py PROGRAM [--rows 10000000] [--processes 1000] [--threads 64]

rows       of samples into `fit --uncertainty noise`, of geometries through `evaluate`: time and largest memory
processes  of which half write one model and half evaluate it, 100 at once: each reads a whole one
threads    of `evaluate`: the same bytes as one
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

DIRECTIONS = """BEGIN {
  print "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg" more
  for (i = 0; i < rows; i++)
    print "532," i * 0.618034 % 75 ",0," i * 0.754878 % 75 "," i * 0.569840 % 360 values
}"""
NAMES = ",f11" + "".join(f",m{i}{j}" for i in "1234" for j in "1234" if i + j != "11")


def made(rows, samples):
    """A command that prints directions, or samples of an ideal depolarizer at them."""
    more, values = (NAMES, ",0.3" + ",0" * 15) if samples else ("", "")
    return ["awk", "-v", f"rows={rows}", "-v", f"more={more}", "-v", f"values={values}", DIRECTIONS]


def piped(rows, samples, command):
    """Seconds, largest resident memory in MB and the SHA-256 of what the command prints of so many rows."""
    begin = time.monotonic()
    source = subprocess.Popen(made(rows, samples), stdout=subprocess.PIPE)
    program = subprocess.Popen(command, stdin=source.stdout, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    source.stdout.close()
    digest = hashlib.sha256()
    while piece := program.stdout.read(1 << 20):
        digest.update(piece)
    _, status, usage = os.wait4(program.pid, 0)
    program.returncode = os.waitstatus_to_exitcode(status)
    source.wait()
    if program.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit {program.returncode}")
    return time.monotonic() - begin, usage.ru_maxrss / 1024, digest.hexdigest()


def line(what, rows, seconds, megabytes):
    print(f"| {what} | {rows} | {seconds:.1f} s | {megabytes:.0f} MB |", flush=True)


def many_processes(program, folder, count):
    """Seconds; every second one writes ptfe-532 or ptfe-633 over the same file, the others evaluate it."""
    target = folder / "model.json"
    subprocess.run([program, "convert", "ptfe-532", target], check=True, capture_output=True)
    question = ["--incident", "45,0", "--reflected", "30,180", "--format", "csv"]
    answers = {
        name: subprocess.run([program, "evaluate", name, *question], check=True, capture_output=True).stdout
        for name in ("ptfe-532", "ptfe-633")
    }

    def one(number):
        if number % 2:
            command = [program, "convert", f"ptfe-{(532, 633)[number // 2 % 2]}", target]
            return subprocess.run(command, capture_output=True).returncode == 0
        done = subprocess.run([program, "evaluate", target, *question], capture_output=True)
        return done.returncode == 0 and done.stdout in answers.values()

    begin = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(100) as pool:
        good = sum(pool.map(one, range(count)))
    left = [path.name for path in folder.iterdir() if path != target]
    if good != count or left:
        sys.exit(f"{count - good} of {count} processes failed; left behind: {left}")
    json.loads(target.read_text())
    return time.monotonic() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    for name, default in (("rows", 10**7), ("processes", 1000), ("threads", 64)):
        parser.add_argument(f"--{name}", type=int, default=default)
    options = parser.parse_args()
    program = options.program.resolve()
    print("| what | rows | time | memory |\n|---|---|---|---|")
    fit = [program, "fit", "-", "--uncertainty", "noise", "--orders", "3,2"]
    line("`fit --uncertainty noise --orders 3,2`", options.rows, *piped(options.rows, True, fit)[:2])
    evaluate = [program, "evaluate", "ptfe-532", "-g", "-", "--threads"]
    seconds, megabytes, alone = piped(options.rows, False, [*evaluate, "1"])
    line("`evaluate --threads 1`", options.rows, seconds, megabytes)
    seconds, megabytes, together = piped(options.rows, False, [*evaluate, str(options.threads)])
    line(f"`evaluate --threads {options.threads}`, the same bytes", options.rows, seconds, megabytes)
    if alone != together:
        sys.exit(f"{options.threads} threads print other bytes than one")
    with tempfile.TemporaryDirectory(prefix="mmbrdf-load-") as folder:
        seconds = many_processes(program, pathlib.Path(folder), options.processes)
    print(f"| {options.processes} processes on one file, 100 at once | | {seconds:.1f} s | |")


if __name__ == "__main__":
    main()
