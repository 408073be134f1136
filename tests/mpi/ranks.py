#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""examples/mpi with 1, 2 and 4 ranks finds what `mmbrdf fit` does in memory, and what is broken leaves nothing behind.

    ranks.py BUILD MPIRUN    exit status 77, with a line, where there is no MPI
"""

import csv
import io
import json
import os
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

RANKS = (1, 2, 4)  # of three files: one of four ranks has none
NOISE = 1e-12  # of the largest coefficient of a block: each number of ranks merges in another tree
SAMPLE = 1e-7  # the same where evidence is searched: sample_fit_tolerance
SAMPLE_U = 1e-6  # of u: ten times that
WHERE = (("10,0", "20,75"), ("30,0", "45,130"), ("60,0", "50,250"))  # no element is 0 here


class Programs:
    def __init__(self, build, mpirun, folder):
        self.program, self.mpirun, self.folder = build / "mmbrdf", mpirun, folder
        self.example = next(build.glob("**/example_mpi_fit"), None)

    def mmbrdf(self, *arguments):
        return subprocess.run([self.program, *arguments], check=True, stdout=subprocess.PIPE, text=True).stdout

    def mpi(self, ranks, *arguments):
        environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        command = [self.mpirun, "--oversubscribe", "-n", str(ranks), self.example, *arguments]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=False, timeout=100)

    def simulated(self):
        """Files of two wavelengths, one of which the last file alone has."""
        files = []
        for k, wavelength in enumerate(("532", "532", "633")):
            files.append(self.folder / f"run{k}.csv")
            grid = f"random:{400 + 50 * k}"
            noise = ["--noise", "speckle:0.01", "--seed", str(k + 1)]
            self.mmbrdf("simulate", "ptfe", "--wavelength", wavelength, "--grid", grid, *noise, "-o", files[-1])
        return files

    def uncertainties(self, model):
        """Of the elements at some geometries and both wavelengths."""
        result = []
        for incident, reflected in WHERE:
            where = ["-w", "532,633", "-i", incident, "-r", reflected]
            rows = csv.DictReader(io.StringIO(self.mmbrdf("evaluate", model, *where, "--uncertainty", "--format", "csv")))
            result += [float(value) for row in rows for name, value in row.items() if name.startswith("u_")]
        return result


def coefficients(model):
    return [block["coefficients"] for block in json.loads(model.read_text(encoding="utf-8"))["blocks"]]


def apart(found, expected):
    """In parts of the largest coefficient of a block."""
    return max(
        max(abs(a - b) for a, b in zip(x, y, strict=True)) / max(map(abs, y))
        for x, y in zip(found, expected, strict=True)
    )


def all_ranks_find_what_one_process_does(programs, files, options, tolerance):
    together = programs.folder / "all.csv"
    texts = [path.read_text(encoding="utf-8").splitlines(keepends=True) for path in files]
    together.write_text("".join(texts[0] + texts[1][1:] + texts[2][1:]), encoding="utf-8")
    memory = programs.folder / "memory.json"
    programs.mmbrdf("fit", together, "--uncertainty", "noise" if options else "sample", "-o", memory)
    expected, u = coefficients(memory), programs.uncertainties(memory)
    assert sum(map(len, expected)) > 100 and len(u) == 96 and min(u) > 0
    for ranks in RANKS:
        model = programs.folder / f"{ranks}.json"
        done = programs.mpi(ranks, *options, model, *files)
        assert done.returncode == 0, done.stderr
        assert f"1350 samples of 3 files by {ranks} ranks" in done.stdout, done.stdout
        off = apart(coefficients(model), expected)
        off_u = max(abs(a / b - 1) for a, b in zip(programs.uncertainties(model), u, strict=True))
        print(f"{ranks} ranks {' '.join(options)}: {off:.1e} of the largest coefficients, {off_u:.1e} of u")
        assert off <= tolerance and off_u <= SAMPLE_U
    return expected


def served(path, texts):
    """A file that is another one each time it is read: a pipe, replaced by a new one before the next reader comes."""

    def serve():
        for text in texts:
            with path.open("w", encoding="utf-8") as pipe:
                beside = path.with_suffix(".next")
                os.mkfifo(beside)
                beside.rename(path)
                pipe.write(text)

    os.mkfifo(path)
    threading.Thread(target=serve, daemon=True).start()


def is_refused(programs, ranks, arguments, message):
    """In a line, and nothing is written."""
    before = sorted(programs.folder.iterdir())
    done = programs.mpi(ranks, *arguments)
    told = [line for line in done.stderr.splitlines() if line.startswith("example_mpi_fit: ")]
    assert done.returncode != 0 and len(told) == 1 and message in told[0], done.stderr
    assert sorted(programs.folder.iterdir()) == before


def what_is_wrong_ends_all_ranks(programs, files):
    folder = programs.folder
    model, broken, changing = folder / "none.json", folder / "broken.csv", folder / "changing.csv"
    broken.write_text("wavelength_nm,theta_i_deg\n532,x\n", encoding="utf-8")
    text = files[0].read_text(encoding="utf-8")
    for options in ([], ["--noise-alone"]):
        is_refused(programs, 2, [*options, model, *files, broken], "broken.csv")
    for second, message in (
        (broken.read_text(encoding="utf-8"), "changing.csv"),
        (text.replace("\n532,", "\n700,"), "changing.csv: samples at 700 nm, of which round 1 had none"),
        (text.replace("\n532,1", "\n532,2"), "round 2 was of other samples than round 1, as many of them"),
    ):
        served(changing, [text, second])
        is_refused(programs, 2, [model, files[1], changing], message)
        changing.unlink()
    is_refused(programs, 2, files, "run0.csv: has samples, and would be overwritten")
    is_refused(programs, 1, [folder / "nowhere" / "none.json", broken], "there is no folder")  # said before all else
    assert files[0].read_text(encoding="utf-8") == text
    assert programs.mpi(2, "--noise", model, *files).returncode == 2


def main():
    build, mpirun = Path(sys.argv[1]).absolute(), sys.argv[2]
    with tempfile.TemporaryDirectory() as name:
        programs = Programs(build, mpirun, Path(name))
        if programs.example is None or not os.path.exists(mpirun):
            print("skipped: no MPI: ./dev packages clusters")
            return 77
        files = programs.simulated()
        sample = all_ranks_find_what_one_process_does(programs, files, [], SAMPLE)
        noise = all_ranks_find_what_one_process_does(programs, files, ["--noise-alone"], NOISE)
        assert apart(noise, sample) > 1e-3  # or one could pass for the other
        what_is_wrong_ends_all_ranks(programs, files)
    return 0


if __name__ == "__main__":
    sys.exit(main())
