#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""One fit of many files while workers are killed: the archive of docs/scale.md.

    PYTHONPATH=build/release/python python3 apps/bench/archive.py FOLDER [--files N] [--rows N] [--noise-alone]

Makes files of random directions of ptfe with a noise of 0.6 % in FOLDER, fits them in this process, then by two workers
of which one is killed after a third and another after two thirds of the pieces, and compares what the two have found, bit by bit.
"""

import argparse
import os
import resource
import signal
import time
from pathlib import Path

import numpy as np
from distributed import Client, LocalCluster

import mmbrdf
from mmbrdf import distributed as archive

LIMIT_DEG = 75.0  # fitted are directions of the source to here


def write(path, rows, seed):
    random = np.random.default_rng(seed)
    theta_i, theta_r = np.degrees(np.arccos(random.uniform(np.cos(np.radians(LIMIT_DEG)), 1, (2, rows))))
    phi_r = random.uniform(0, 360, rows)
    angles = np.round([theta_i, theta_r, phi_r], 3)
    f11 = mmbrdf.material("ptfe").evaluate(532, angles[0], 0, angles[1], angles[2])[:, 0, 0]
    columns = np.column_stack([*angles, f11 * random.normal(1, 0.006, rows)])
    beside = path.with_suffix(".part")
    beside.write_text(
        "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,f11\n"
        + "532,%.3f,0,%.3f,%.3f,%.6f\n" * rows % tuple(columns.ravel())
    )
    beside.rename(path)


def largest_memory(*_):
    """MB of this process so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def by_workers(files, options):
    """The fit, the processes killed, and the memory of the workers that are left."""
    killed = []
    at = {len(files) // 3, 2 * len(files) // 3}
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:

        def killing(watched):
            for count, piece in enumerate(watched):
                if count in at:
                    at.discard(count)  # in the first round alone
                    killed.append(next(iter(client.run(os.getpid).values())))
                    os.kill(killed[-1], signal.SIGKILL)
                yield piece

        fitted = archive.fit(files, client, progress=killing, **options)
        return fitted, killed, max(client.run(largest_memory).values())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--files", type=int, default=1000)
    parser.add_argument("--rows", type=int, default=100_000, help="of each file")
    parser.add_argument("--noise-alone", action="store_true", help="uncertainty='noise': one round instead of four")
    wanted = parser.parse_args()
    options = {"orders": (7, 4)}
    if wanted.noise_alone:
        options["uncertainty"] = "noise"

    wanted.folder.mkdir(parents=True, exist_ok=True)
    files = [wanted.folder / f"{k:05d}.csv" for k in range(wanted.files)]
    for k, path in enumerate(files):
        if not path.exists():
            write(path, wanted.rows, seed=k)
    size = sum(path.stat().st_size for path in files)
    print(f"{len(files)} files, {size / 1e9:.2f} GB", flush=True)

    begun = time.perf_counter()
    plain = archive.fit(files, **options)
    print(
        f"in this process: {plain.samples} rows, {time.perf_counter() - begun:.0f} s, {largest_memory():.0f} MB",
        flush=True,
    )

    begun = time.perf_counter()
    fitted, killed, memory = by_workers(files, options)
    print(
        f"two workers, {len(killed)} killed: {fitted.samples} rows, {time.perf_counter() - begun:.0f} s, {memory:.0f} MB each"
    )
    same = fitted.result.model.to_json() == plain.result.model.to_json()
    print("the same bits" if same else "NOT the same bits")
    return 0 if same and len(killed) == 2 and fitted.samples == plain.samples else 1


if __name__ == "__main__":
    raise SystemExit(main())
