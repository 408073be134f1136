#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What images, pixel fits and archives cost: the numbers of docs/scale.md.

    PYTHONPATH=build/release/python python3 apps/bench/images.py [--pixels N] [--rows N] [--only NAME]

Each line is the best of some runs, by the clock and by processor time: on a machine that has other work to do the latter
is what a core can. Dask is asked where it is installed.
"""

import argparse
import resource
import time

import numpy as np

import mmbrdf
from mmbrdf import images


def cpu():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def best(work, count, runs=3):
    """Of `count` things: how many a second, and a second of a processor."""
    walls, cpus = [], []
    for _ in range(runs):
        wall, used = time.perf_counter(), cpu()
        work()
        walls.append(time.perf_counter() - wall)
        cpus.append(cpu() - used)
    return count / min(walls), count / min(cpus)


def say(what, rates, unit="", scale=1.0):
    wall, core = (rate / scale for rate in rates)
    print(f"{what:58s} {wall:10.4g} {unit}/s   {core:10.4g} {unit}/s of a processor", flush=True)


def tiled(array, shape):
    rows, columns = -(-shape[0] // array.shape[0]), -(-shape[1] // array.shape[1])
    return np.ascontiguousarray(np.tile(array, (rows, columns, *[1] * (array.ndim - 2)))[: shape[0], : shape[1]])


def reductions(pixels):
    side = int(np.sqrt(pixels))
    shape = (side, side)
    camera = images.simulate((64, 64), seed=1)
    stack = tiled(camera.stack, shape)
    shared = camera.instrument.at(0, 0)
    own = images.PixelInstrument(tiled(camera.instrument.generator, shape), tiled(camera.instrument.analyzer, shape))
    count = side * side
    say("reduce, one instrument", best(lambda: images.reduce(stack, shared), count), "Mpixel", 1e6)
    images.reduce(stack, own)
    say("reduce, an instrument in each pixel", best(lambda: images.reduce(stack, own), count), "Mpixel", 1e6)
    say(
        "reduce, one instrument, dark frame and saturation",
        best(lambda: images.reduce(stack, shared, dark=stack[..., 0] * 0, saturation=9.0), count), "Mpixel", 1e6,
    )  # fmt: skip
    some = stack[: max(1, side // 4)]
    inverse = np.linalg.pinv(np.einsum("qi,pj->qpij", shared.analyzer, shared.generator).reshape(16, 16)).astype(
        np.float32
    )
    count = some.shape[0] * side
    say("the same in numpy: pixels @ inverse", best(lambda: some.reshape(-1, 16) @ inverse.T, count), "Mpixel", 1e6)
    matrices = images.reduce(some, shared)
    say("depolarization of float32", best(lambda: mmbrdf.depolarization(matrices), count), "Mpixel", 1e6)
    say("Lu-Chipman of float32", best(lambda: mmbrdf.lu_chipman(matrices, invalid="nan"), count), "Mpixel", 1e6)
    law = {"relative": 1e-3}
    few = some[:64]
    count = few.shape[0] * side
    say("uncertainties of matrices", best(lambda: images.uncertainty(few, shared, law), count), "Mpixel", 1e6)
    chunks(stack, shared)


def chunks(stack, instrument):
    try:
        import dask.array as da
    except ImportError:
        print("no Dask: ./dev packages clusters")
        return
    side, count = stack.shape[0], stack.shape[0] * stack.shape[1]
    out = np.empty((*stack.shape[:2], 4, 4), np.float32)
    for rows in (32, 128, 512):
        if rows > side:
            continue
        lazy = images.reduce(da.from_array(stack, chunks=(rows, side, 16)), instrument)
        size = f"{rows * side / 1e6:.2g} Mpixel"
        for workers in (1, 2):
            run = lambda: da.store(lazy, out, lock=False, scheduler="threads", num_workers=workers)  # noqa: E731
            say(f"Dask, {workers} threads, chunks of {size}", best(run, count), "Mpixel", 1e6)

        def one_by_one():
            for first in range(0, side, rows):
                out[first : first + rows] = images.reduce(stack[first : first + rows], instrument)

        say(f"chunks of {size} one after the other, without Dask", best(one_by_one, count), "Mpixel", 1e6)


def files(pixels):
    """From chunked files to chunked files: the stack is never whole in memory."""
    import tempfile

    try:
        import dask
        import dask.array as da
        import xarray
        import zarr  # noqa: F401
    except ImportError:
        print("no Dask and zarr: ./dev packages clusters")
        return
    side = int(np.sqrt(pixels)) // 64 * 64
    camera = images.simulate((64, 64), seed=1)
    strip = tiled(camera.stack, (64, side))
    instrument = camera.instrument.at(0, 0)
    plain = {"raw": {"compressor": None}}
    with tempfile.TemporaryDirectory() as name, dask.config.set(scheduler="threads", num_workers=2):
        rows = da.concatenate([da.from_array(strip, chunks=(64, side, 16))] * (side // 64)).rechunk((128, side, 16))
        raw = xarray.DataArray(rows, dims=["y", "x", "frame"], name="raw")
        raw.to_dataset().to_zarr(f"{name}/raw", encoding=plain)

        def run():
            stack = xarray.open_zarr(f"{name}/raw").raw
            mueller = images.reduce(stack, instrument).to_dataset()
            mueller.to_zarr(f"{name}/mueller", mode="w", encoding={"mueller": {"compressor": None}})

        say("from Zarr to Zarr, 2 threads, no compression", best(run, side * side), "Mpixel", 1e6)


def calibrations():
    camera = images.simulate((64, 64), seed=1)
    run = lambda: images.calibrate(camera.references, camera.stacks, wavelength_nm=532)  # noqa: E731
    say("calibrate each pixel, 54 references of 4 x 4 states", best(run, 64 * 64, 2), "pixel")
    dials = mmbrdf.dial_angles(5, 6.0, 61)
    camera = images.simulate((16, 32), dials_deg=dials, repeats=2, seed=1)
    run = lambda: images.calibrate(camera.references, camera.stacks, wavelength_nm=532, dials_deg=dials)  # noqa: E731
    say("calibrate each pixel, turning retarders, 2 x 61 readings", best(run, 16 * 32, 2), "pixel")


def fits():
    grid = mmbrdf.germer2017_grid()
    exact = mmbrdf.material("ptfe").evaluate(532, *grid).astype(np.float32)
    values = np.broadcast_to(exact, (960, *exact.shape)).copy()
    fit, only = images.PixelFit(532, grid), images.PixelFit(532, grid, f11_only=True)
    say("fits of 1824 geometries, 142 coefficients", best(lambda: fit.fit(values), 960), "pixel")
    f11 = np.ascontiguousarray(np.tile(values[..., 0, 0], (10, 1)))
    say("fits of f11 alone, 40 coefficients", best(lambda: only.fit(f11), 9600), "pixel")
    data = mmbrdf.Dataset(532, *grid, exact)
    say("one by one: mmbrdf.fit, uncertainty='noise'", best(lambda: mmbrdf.fit(data, uncertainty="noise"), 1), "pixel")


def archives():
    import tempfile
    from pathlib import Path

    from mmbrdf import distributed

    with tempfile.TemporaryDirectory() as name:
        paths = []
        for k in range(8):
            geometry = mmbrdf.random_geometries(20_000, seed=k)
            paths.append(Path(name) / f"{k}.csv")
            mmbrdf.simulate(mmbrdf.material("ptfe"), 532, geometry, speckle=0.01, seed=k).save(paths[-1])
        say("an archive, from CSV to one fit", best(lambda: distributed.fit(paths), 160_000, 2), "krow", 1e3)
        data = mmbrdf.read_samples(paths[0])

        def add():
            mmbrdf.FitAccumulator().add(data)

        say("of which to add the rows", best(add, 20_000), "krow", 1e3)
        say("and to read them", best(lambda: mmbrdf.read_samples(paths[0]), 20_000), "krow", 1e3)
        one, other = mmbrdf.FitAccumulator(), mmbrdf.FitAccumulator()
        one.add(data)
        other.add(data)
        say("merge two states", best(lambda: one.merge(other), 1), "")
        print(f"a state: {one.state().nbytes / 1024:.0f} KiB a wavelength")


def rounds(rows):
    """A fit of a sample, the rows 10 000 at a time as files would bring them; adding alone counts."""
    sums, more = mmbrdf.SampleFitAccumulator(), True
    in_all = 0.0
    while more:
        used = 0.0
        for part in range(-(-rows // 10_000)):
            geometry = mmbrdf.random_geometries(min(10_000, rows - 10_000 * part), seed=part)
            data = mmbrdf.simulate(mmbrdf.material("ptfe"), 532, geometry, speckle=0.006, seed=part)
            before = cpu()
            sums.add(data, threads=1)
            used += cpu() - before
        in_all += used
        state = sums.state().nbytes / 1024
        number = sums.round
        more = sums.next_round()
        print(f"round {number}: {rows / used / 1e3:8.3g} krow/s of a processor, a state {state:.0f} KiB", flush=True)
    before = cpu()
    sums.solve()
    print(f"all rounds: {rows / in_all / 1e3:.3g} krow/s; to solve {cpu() - before:.3g} s of a processor", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pixels", type=int, default=1 << 22)
    parser.add_argument("--only", choices=["reductions", "files", "calibrations", "fits", "archives", "rounds"])
    parser.add_argument("--rows", type=int, default=100_000)
    asked = parser.parse_args()
    if asked.only in (None, "reductions"):
        reductions(asked.pixels)
    if asked.only in (None, "files"):
        files(asked.pixels)
    if asked.only in (None, "calibrations"):
        calibrations()
    if asked.only in (None, "fits"):
        fits()
    if asked.only in (None, "archives"):
        archives()
    if asked.only in (None, "rounds"):
        rounds(asked.rows)
    print(f"largest memory: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB")


if __name__ == "__main__":
    main()
