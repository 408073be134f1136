# SPDX-License-Identifier: BSD-3-Clause
"""One fit of many files, in this process or by the workers of a Dask cluster.

    archive = mmbrdf.distributed.fit(sorted(folder.glob("*.csv")), client, orders=(7, 4))
    archive.result.model.save("archive.json")

Each file becomes the state of a FitAccumulator, and states merge in a binary tree over the order of the files, which does
not depend on who computes what or when: the result has the same bits with any number of workers, and without Dask.
"""

from __future__ import annotations

import copy
import hashlib
import io
import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._arguments import two_orders
from ._calls import told_in_a_line
from ._files import replacing
from ._mmbrdf import FitAccumulator, FitResult, __version__, read_samples

if TYPE_CHECKING:
    import distributed

__all__ = ["ArchiveFit", "fit"]


class ArchiveFit(NamedTuple):
    """What fit() gives."""

    result: FitResult
    """Of all samples, as FitAccumulator.solve() gives it."""
    samples: int
    skipped: dict[str, str]
    """Files that could not be read, and why: with skip_broken=True alone."""


class _Kind(NamedTuple):
    """Of the accumulators."""

    basis: str
    orders: tuple[int, int]
    mapping: str
    as_printed: bool

    def empty(self) -> FitAccumulator:
        return FitAccumulator(self.basis, self.orders, mapping=self.mapping, as_printed=self.as_printed)

    def of(self, state: Any) -> FitAccumulator:
        return FitAccumulator.from_state(
            state, self.basis, self.orders, mapping=self.mapping, as_printed=self.as_printed
        )


class _Part(NamedTuple):
    """Of some of the files, in their order."""

    accumulator: FitAccumulator | None
    skipped: dict[str, str]


_READ = ("columns", "convention", "frame", "skip_incomplete")  # options of read_samples()


def _require_known(read: dict[str, Any]) -> None:
    for name in read:
        if name not in _READ:
            raise TypeError(f"fit() got {name!r}: not an option of it, nor of read_samples(): {', '.join(_READ)}")


def _canonical(value: Any) -> str:
    """The same text of equal options, in whatever order they were given."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name!r}: {_canonical(value[name])}" for name in sorted(value)) + "}"
    return repr(value)


def _require_once(paths: Sequence[str]) -> None:
    """Twice the same samples would be a fit that is surer than it should be."""
    seen: dict[str, int] = {}
    for k, path in enumerate(paths):
        first = seen.setdefault(os.path.realpath(path), k)
        if first != k:
            raise ValueError(f"files: number {k} ({path}) is number {first} ({paths[first]}) again: leave one out")


def _saved_as(path: str, kind: _Kind, checkpoint: str | None, read: dict[str, Any]) -> Path | None:
    """Another file for what was changed, or is read or fitted otherwise. None: nothing is kept."""
    if checkpoint is None:
        return None
    at = os.stat(path)
    key = repr((os.path.abspath(path), at.st_size, at.st_mtime_ns, tuple(kind), _canonical(read), __version__))
    return Path(checkpoint) / f"{hashlib.sha256(key.encode()).hexdigest()[:32]}.npy"


def _save(state: Any, path: Path) -> None:
    content = io.BytesIO()
    np.save(content, state)
    with replacing(path) as beside:
        beside.write_bytes(content.getvalue() + hashlib.sha256(content.getvalue()).digest())


def _kept(path: Path | None, kind: _Kind) -> FitAccumulator | None:
    """What _save() has written; None if there is nothing, or something else."""
    if path is None:
        return None
    try:
        content = path.read_bytes()
        if hashlib.sha256(content[:-32]).digest() != content[-32:]:
            return None
        return kind.of(np.load(io.BytesIO(content[:-32])))
    except (OSError, ValueError, EOFError):
        return None


def _leaf(path: str, kind: _Kind, skip_broken: bool, checkpoint: str | None, options: dict[str, Any]) -> _Part:
    try:
        saved = _saved_as(path, kind, checkpoint, options)
        kept = _kept(saved, kind)
        if kept is not None:
            return _Part(kept, {})
        accumulator = kind.empty()
        accumulator.add(read_samples(path, **options))
        unchanged = saved == _saved_as(path, kind, checkpoint, options)
    except (OSError, ValueError) as error:
        text = str(error) if os.path.basename(path) in str(error) else f"{path}: {error}"
        if skip_broken:
            return _Part(None, {path: text})
        raise OSError(text) from None
    if saved is not None and unchanged:
        _save(accumulator.state(), saved)
    return _Part(accumulator, {})


def _merged(first: _Part, second: _Part) -> _Part:
    skipped = {**first.skipped, **second.skipped}
    if first.accumulator is None or second.accumulator is None:
        return _Part(first.accumulator or second.accumulator, skipped)
    result: FitAccumulator = copy.deepcopy(first.accumulator)  # what workers hold must not change
    result.merge(second.accumulator)
    return _Part(result, skipped)


def _here(parts: Iterable[_Part]) -> _Part:
    """The same tree, with as many states in memory as it has levels."""
    stack: list[tuple[int, _Part]] = []
    for part in parts:
        stack.append((1, part))
        while len(stack) > 1 and stack[-1][0] == stack[-2][0]:
            (size, first), (_, second) = stack[-2:]
            stack[-2:] = [(2 * size, _merged(first, second))]
    while len(stack) > 1:
        (size, first), (more, second) = stack[-2:]
        stack[-2:] = [(size + more, _merged(first, second))]
    return stack[0][1]


def _there(client: distributed.Client, leaves: Sequence[Any], progress: Callable[[Any], Any] | None) -> _Part:
    level = list(leaves)
    if progress is not None:
        from distributed import as_completed

        watched = as_completed(list(leaves))
    while len(level) > 1:
        pairs = [client.submit(_merged, a, b, pure=False) for a, b in zip(level[::2], level[1::2])]
        level = pairs + level[len(pairs) * 2 :]
    if progress is not None:
        for _ in progress(watched):
            pass
    result: _Part = level[0].result()
    return result


@told_in_a_line("distributed.fit")
def fit(
    files: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    client: distributed.Client | None = None,
    *,
    basis: str = "isotropic",
    orders: tuple[int, int] = (7, 4),
    mapping: str = "lambert",
    as_printed: bool = False,
    powers: int | None = None,
    reflectance: dict[float, float] | None = None,
    minimum_norm: bool = False,
    name: str = "",
    attribution: str = "",
    skip_broken: bool = False,
    checkpoint: str | os.PathLike[str] | None = None,
    progress: Callable[[Any], Any] | None = None,
    **read: Any,
) -> ArchiveFit:
    """Least squares of the samples of all files, as one FitAccumulator would fit them.

    files        of samples, as read_samples() takes them, each once, or one of them; its options (columns, frame, ...) may be given, too. Workers
                 must find them by the same names
    client       a distributed.Client; None: in this process, one file after the other
    skip_broken  files that cannot be read are left out, and named in the result; otherwise the first of them is an OSError
    checkpoint   a folder in which the state of each file is kept, whole or not at all: another call continues with what
                 is there, unless the file was changed, or is read or fitted with other options; a state that is
                 damaged is made again. Workers must find it, too
    progress     such as tqdm.tqdm, which is given what is gone through
    Other options are those of FitAccumulator and its solve().

    In memory are the samples of one file for each worker, and some states. Weights are 1, and uncertainties those of the
    noise. Raises OSError, naming the file, for one that is broken; ValueError for no files, one that is there twice, and as
    solve() does;
    TypeError for an option that there is not.
    """
    paths = [os.fspath(file) for file in ([files] if isinstance(files, str | os.PathLike) else files)]
    if not paths:
        raise ValueError("files: none")
    _require_once(paths)
    kind = _Kind(basis, two_orders(orders), mapping, as_printed)
    _require_known(read)
    if client is not None and not callable(getattr(client, "submit", None)):
        raise TypeError(f"client: expected a distributed.Client, not {type(client).__name__}")
    kind.empty()  # refuses what makes no sense before anything is read
    folder = None if checkpoint is None else os.path.abspath(os.fspath(checkpoint))
    if folder is not None:
        os.makedirs(folder, exist_ok=True)
    if client is None:
        each: Iterable[str] = paths if progress is None else progress(paths)
        part = _here(_leaf(path, kind, skip_broken, folder, read) for path in each)
    else:
        leaves = [client.submit(_leaf, path, kind, skip_broken, folder, read, pure=False) for path in paths]
        part = _there(client, leaves, progress)
    if part.accumulator is None:
        raise ValueError(f"files: none of {len(paths)} can be read; the first: {next(iter(part.skipped.values()))}")
    result = part.accumulator.solve(
        powers=powers, reflectance=reflectance, minimum_norm=minimum_norm, name=name, attribution=attribution
    )
    return ArchiveFit(result, part.accumulator.samples, part.skipped)
