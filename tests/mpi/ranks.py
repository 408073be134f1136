#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""examples/mpi with 1, 2 and 4 ranks: the same coefficients, and a broken file leaves nothing behind.

    ranks.py BUILD MPIRUN    exit status 77, with a line, where there is no MPI
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

TOLERANCE = 1e-12  # of the largest coefficient: the ranks merge in another tree each


def coefficients(path):
    def numbers(value):
        if isinstance(value, dict):
            return [n for key in sorted(value) if key in ("blocks", "coefficients") for n in numbers(value[key])]
        if isinstance(value, list):
            return [n for one in value for n in numbers(one)]
        return [value] if isinstance(value, float | int) else []

    return numbers(json.loads(path.read_text(encoding="utf-8")))


def main():
    build, mpirun = Path(sys.argv[1]).absolute(), sys.argv[2]
    example = next(build.glob("**/example_mpi_fit"), None)
    if example is None or not os.path.exists(mpirun):
        print("skipped: no MPI: ./dev packages clusters")
        return 77
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files = []
        for k in range(5):
            files.append(folder / f"run{k}.csv")
            simulate = [
                "simulate",
                "ptfe",
                "--wavelength",
                "532" if k < 4 else "633",
                "--grid",
                f"random:{400 + 50 * k}",
            ]
            subprocess.run(
                [build / "mmbrdf", *simulate, "--noise", "speckle:0.01", "--seed", str(k + 1), "-o", files[-1]],
                check=True,
                stdout=subprocess.DEVNULL,
            )

        def run(ranks, model, paths):
            command = [mpirun, "--oversubscribe", "-n", str(ranks), example, model, *paths]
            return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)

        found = {}
        for ranks in (1, 2, 4):
            done = run(ranks, folder / f"{ranks}.json", files)
            assert done.returncode == 0, done.stderr
            assert f"of 5 files by {ranks} ranks" in done.stdout, done.stdout
            found[ranks] = coefficients(folder / f"{ranks}.json")
        largest = max(map(abs, found[1]))
        assert len(found[1]) > 100 and largest > 0
        for ranks in (2, 4):
            off = max(abs(a - b) for a, b in zip(found[1], found[ranks], strict=True))
            print(f"{ranks} ranks: {off / largest:.1e} of the largest coefficient")
            assert off <= TOLERANCE * largest
        broken = folder / "broken.csv"
        broken.write_text("wavelength_nm,theta_i_deg\n532,x\n", encoding="utf-8")
        done = run(2, folder / "none.json", [*files, broken])
        assert done.returncode != 0 and "broken.csv" in done.stderr, done.stderr
        assert not (folder / "none.json").exists()
    return 0


if __name__ == "__main__":
    sys.exit(main())
