# SPDX-License-Identifier: BSD-3-Clause
"""Images by other packages: their matrices and Lu-Chipman factors beside ours, and how much longer they take on one core."""
import contextlib
import io
import os
import sys
import time

import numpy as np
import peer

import mmbrdf
from mmbrdf import images

SHAPE = (388, 516)  # of libmpMuelMat's own camera
ROUNDS = 5


def best(work):
    """The least time of some calls, in seconds, and what the last one gave."""
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        result = work()
        times.append(time.perf_counter() - start)
    return min(times), result


def compare(name, what, theirs, ours, rest):
    """`theirs` and `ours` give matrices."""
    theirs()
    ours()
    (their_time, they), (our_time, we) = best(theirs), best(ours)
    they, we = (np.asarray(m, float).reshape(-1, 16) for m in (they, we))
    peer.judge(name, what, ((they - we) / we[:, :1]).ravel(), rest, 50 * rest, "elements", "M11")
    pixels = SHAPE[0] * SHAPE[1]
    print(
        f"a pixel: {1e9 * their_time / pixels:.0f} ns, mmbrdf {1e9 * our_time / pixels:.0f} ns; {their_time / our_time:.1f} times\n"
    )


def scene():
    """Stack, the instrument of all pixels, and one in each."""
    camera = images.simulate(SHAPE, seed=1)
    shared = camera.instrument.at(SHAPE[0] // 2, SHAPE[1] // 2)
    return camera.stack.astype(np.float32), shared, camera.instrument


def polanalyser(folder):
    sys.path.append(folder)
    from mueller import calcMueller  # without the package, which wants OpenCV for what is not asked here

    stack, shared, _ = scene()
    # All generator states of the first analyzer state first, as ours.
    psg, psa = np.zeros((2, stack.shape[-1], 4, 4))  # of states alone it takes the first component for all four
    psg[..., 0] = np.tile(shared.generator, (len(shared.analyzer), 1))
    psa[:, 0] = np.repeat(shared.analyzer, len(shared.generator), axis=0)
    frames = np.ascontiguousarray(np.moveaxis(stack, -1, 0))  # as it wants them
    compare(
        "polanalyser", "calcMueller, one instrument",
        lambda: calcMueller(frames, psg, psa), lambda: images.reduce(stack, shared), 1e-6,
    )  # fmt: skip


def libmpmuelmat(folder):
    sys.path.append(folder)
    with contextlib.redirect_stdout(io.StringIO()):
        import libmpMuelMat

    os.chdir(folder)  # it looks for its library from where it is called

    def columns(matrices):  # column after column, though its pages speak of C's order
        return np.ascontiguousarray(np.swapaxes(matrices, -1, -2)).reshape(*SHAPE, 16)

    def back(flat):
        return np.swapaxes(np.reshape(flat, (*SHAPE, 4, 4)), -1, -2)

    stack, _, own = scene()
    readings = columns(stack.astype(float).reshape(*SHAPE, 4, 4))
    a, w = columns(own.analyzer), columns(np.swapaxes(own.generator, -1, -2))
    compare(
        "libmpMuelMat", "compute_MM_AIW, an instrument in each pixel",
        lambda: back(libmpMuelMat.compute_MM_AIW(a, readings, w)[0]), lambda: images.reduce(stack, own), 1e-6,
    )  # fmt: skip
    matrices = images.reduce(stack, own).astype(float)
    matrices /= matrices[..., :1, :1]
    flat = columns(matrices)
    compare(
        "libmpMuelMat", "Lu-Chipman, depolarizer",
        lambda: back(libmpMuelMat.compute_MM_polar_LuChipman(flat)[2]), lambda: mmbrdf.lu_chipman(matrices).depolarizer, 1e-8,
    )  # fmt: skip


def main():
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})  # all on one core, whatever their threads
    folders = {name: os.environ.get(f"MMBRDF_PEER_{name.__name__.upper()}") for name in (polanalyser, libmpmuelmat)}
    if not any(folders.values()):
        print("skipped: set MMBRDF_PEER_POLANALYSER or MMBRDF_PEER_LIBMPMUELMAT to their folders")
    for check, folder in folders.items():
        if folder:
            check(folder)


main()
