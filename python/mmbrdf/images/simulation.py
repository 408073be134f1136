# SPDX-License-Identifier: BSD-3-Clause
"""A camera whose truth is known."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _mmbrdf
from .._arguments import unmasked
from .calibration import Reference
from .instruments import PixelInstrument
from .matrices import readings


class Simulated(NamedTuple):
    """What simulate() gives: the truth of an imaging polarimeter and of a sample before it."""

    instrument: PixelInstrument
    mueller: NDArray[np.float64]
    """(y, x, 4, 4) of the sample."""
    references: tuple[Reference, ...]
    stacks: NDArray[np.float32]
    """(reference, y, x, frame), with noise."""
    stack: NDArray[np.float32]
    """(y, x, frame) of the sample, with noise."""


def _varying(shape: tuple[int, int], size: float, generator: np.random.Generator) -> NDArray[np.float64]:
    """A smooth number in each pixel, within about +-size."""
    y, x = np.meshgrid(np.linspace(-1, 1, shape[0]), np.linspace(-1, 1, shape[1]), indexing="ij")
    a, b, c, d = generator.normal(0, 0.4, 4)
    return np.asarray(size * (a * x + b * y + c * x * y + d * (x**2 - y**2)))


def _sample(shape: tuple[int, int]) -> NDArray[np.float64]:
    """Stripes and rings: a depolarizing retarder whose axis turns, with a diattenuation at edges."""
    y, x = np.meshgrid(np.linspace(-1, 1, shape[0]), np.linspace(-1, 1, shape[1]), indexing="ij")
    axis = np.degrees(np.arctan2(y, x)) / 2
    retarder = np.asarray(_mmbrdf.retarder(20 + 60 * np.hypot(x, y), axis))
    depolarizing = np.zeros((*shape, 4, 4))
    depolarizing[..., 0, 0] = 1
    for k, power in ((1, 0.9), (2, 0.85), (3, 0.8)):
        depolarizing[..., k, k] = power * (0.75 + 0.25 * np.cos(6 * x) * np.cos(4 * y))
    edge = np.exp(-(((np.hypot(x, y) - 0.6) / 0.1) ** 2))
    polarizing = (1 - 0.3 * edge)[..., None, None] * np.eye(4) + (0.6 * edge)[..., None, None] * np.asarray(
        _mmbrdf.polarizer(axis)
    )
    return np.asarray(depolarizing @ retarder @ polarizing * (0.3 + 0.5 * (np.cos(3 * x + y) + 1) / 2)[..., None, None])


def simulate(
    shape: tuple[int, int],
    *,
    dials_deg: ArrayLike | None = None,
    repeats: int = 18,
    noise: float = 1e-3,
    seed: int = 0,
) -> Simulated:
    """An imaging polarimeter whose retardances, azimuths and leakage vary over the image, its references, and a sample.

    dials_deg  (frame, 2): of two turning retarders; None: a grid of four states in each arm
    repeats    references of each kind: empty, polarizers and wafers of a grid; empty alone of retarders
    noise      relative standard deviation of each reading
    """
    if np.shape(shape) != (2,) or min(shape) < 1:
        raise ValueError(f"shape = {shape!r}, expected (y, x), each 1 or more")
    random = np.random.default_rng(seed)
    retardance, turn = 1 + _varying(shape, 0.02, random), _varying(shape, 1.0, random)
    leak = 1e-4 * (1 + _varying(shape, 1.0, random)) ** 2
    bright = 1 + _varying(shape, 0.2, random)

    behind = np.asarray(_mmbrdf.polarizer(0.0, leak))[:, :, None]

    def states(dials: NDArray[Any], of_plate: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Of generator and analyzer: a polarizer and behind it a plate at each dial; the analyzer mirrors it."""
        plate = np.asarray(_mmbrdf.retarder(of_plate * retardance[..., None], dials + turn[..., None]))
        return (plate @ (2 * behind[..., 0, None]))[..., 0], (behind[..., :1, :] @ plate)[..., 0, :]

    pairs = None
    if dials_deg is None:
        grid = np.array([-51.69, -15.12, 15.12, 51.69])
        generator, analyzer = states(grid, 131.81)
    else:
        turned = np.asarray(unmasked("dials_deg", dials_deg), float)
        generator, analyzer = states(turned[:, 0], 90.0)[0], states(turned[:, 1], 90.0)[1]
        pairs = np.stack([np.arange(len(turned))] * 2, axis=1)
    analyzer = analyzer * bright[..., None, None]
    instrument = PixelInstrument(generator, analyzer, pairs=pairs)
    references, matrices = _simulated_references(repeats if dials_deg is None else 0, max(2, repeats))

    def seen(mueller: NDArray[Any]) -> NDArray[np.float32]:
        exact = readings(np.broadcast_to(mueller, (*shape, 4, 4)), instrument)
        return np.asarray(exact * (1 + noise * random.normal(size=exact.shape)), np.float32)

    sample = _sample(shape)
    return Simulated(instrument, sample, references, np.stack([seen(m) for m in matrices]), seen(sample))


def _simulated_references(others: int, empty: int) -> tuple[tuple[Reference, ...], list[NDArray[np.float64]]]:
    references = [Reference("empty")] * (others or empty)
    matrices = [np.eye(4)] * len(references)
    for k in range(others):
        dial = 180 * k / others
        references.append(Reference("polarizer", dial))
        matrices.append(0.8 * np.asarray(_mmbrdf.polarizer(7.0 + dial, 1e-4)))
    film = (1.46, 0.1, 4.15 + 0.044j)
    for k in range(others):
        angle = 30 + 40 * k / others
        m = np.asarray(_mmbrdf.film_reflection(film, 532.0, angle))
        references.append(Reference("wafer", angle, 1 if m[0, 1] > 0 else -1, 1 if m[3, 2] > 0 else -1))
        matrices.append(m)
    return tuple(references), matrices
