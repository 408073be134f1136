# SPDX-License-Identifier: BSD-3-Clause
"""One fit of many files, in this process or by the workers of a Dask cluster.

    archive = mmbrdf.distributed.fit(sorted(folder.glob("*.csv")), client, orders=(7, 4))
    archive.result.model.save("archive.json")

Each file becomes the state of an accumulator, and states merge in a binary tree over the order of the files, which does
not depend on who computes what or when: the result has the same bits with any number of workers, and without Dask. A fit
of the sample goes over all files in up to four rounds.
"""

from __future__ import annotations

import copy
import hashlib
import io
import os
import uuid
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import CancelledError
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._arguments import two_orders
from ._calls import told_in_a_line
from ._files import identity, replacing
from ._mmbrdf import FitAccumulator, FitResult, SampleFitAccumulator, __version__, read_samples

if TYPE_CHECKING:
    import distributed

__all__ = ["ArchiveFit", "fit"]


class ArchiveFit(NamedTuple):
    """What fit() gives."""

    result: FitResult
    """Of all samples, as solve() of a SampleFitAccumulator gives it, or of a FitAccumulator."""
    samples: int
    skipped: dict[str, str]
    """Files that could not be read, and why: with skip_broken=True alone."""


_Accumulator = FitAccumulator | SampleFitAccumulator


class _Kind(NamedTuple):
    """Of the accumulators."""

    basis: str
    orders: tuple[int, int]
    mapping: str
    as_printed: bool
    uncertainty: str
    weights: str | None

    def _options(self) -> dict[str, Any]:
        options: dict[str, Any] = {"mapping": self.mapping, "as_printed": self.as_printed}
        return options if self.uncertainty == "noise" else {**options, "weights": self.weights}

    def empty(self) -> _Accumulator:
        one = FitAccumulator if self.uncertainty == "noise" else SampleFitAccumulator
        return one(self.basis, self.orders, **self._options())

    def of(self, state: Any) -> _Accumulator:
        one = FitAccumulator if self.uncertainty == "noise" else SampleFitAccumulator
        return one.from_state(state, self.basis, self.orders, **self._options())


class _Mark(NamedTuple):
    """Of a file, so that it is known again."""

    size: int
    changed_ns: int


class _Part(NamedTuple):
    """Of some of the files, in their order."""

    accumulator: _Accumulator | None
    read: dict[str, _Mark]
    skipped: dict[str, str]


class _Round(NamedTuple):
    """What is the same for all files."""

    kind: _Kind
    begun: str
    """What the rounds before have found: nothing in the first."""
    skip_broken: bool
    checkpoint: str | None
    options: dict[str, Any]
    threads: int


_READ = ("columns", "convention", "frame", "skip_incomplete")  # options of read_samples()


def _require_known(read: dict[str, Any]) -> None:
    for name in read:
        if name not in _READ:
            raise TypeError(
                f"distributed.fit: {name!r}: not an option of it, nor of read_samples(): {', '.join(_READ)}"
            )


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


def _require_lasting(paths: Sequence[str]) -> None:
    """Rounds read each file again, and of a pipe they would wait for ever."""
    for path in paths:
        if Path(path).is_fifo():
            raise ValueError(f"files: {path} is a pipe, which can be read once: save it, or take uncertainty='noise'")


def _saved_as(path: str, mark: _Mark, this: _Round) -> Path | None:
    """Another file for what was changed, or is read or fitted otherwise."""
    if this.checkpoint is None:
        return None
    key = repr((os.path.abspath(path), *mark, tuple(this.kind), this.begun, _canonical(this.options), __version__))
    return Path(this.checkpoint) / f"{hashlib.sha256(key.encode()).hexdigest()[:32]}.npy"


def _save(state: Any, path: Path) -> None:
    content = io.BytesIO()
    np.save(content, state)
    try:
        with replacing(path) as beside:
            beside.write_bytes(content.getvalue() + hashlib.sha256(content.getvalue()).digest())
    except OSError as error:  # of the folder, not of the file of samples
        raise OSError(f"checkpoint {path.parent}: {error.strerror or error}") from None


def _kept(path: Path | None, kind: _Kind) -> _Accumulator | None:
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


def _mark(path: str) -> _Mark:
    at = os.stat(path)
    return _Mark(at.st_size, at.st_mtime_ns)


def _read(path: str, mark: _Mark, begun: _Accumulator, this: _Round) -> tuple[_Accumulator, bool]:
    """And whether it was the same file all the while: otherwise the samples may be of two."""
    before = identity(path)
    result: Any = copy.deepcopy(begun)
    samples = read_samples(path, **this.options)
    if isinstance(result, SampleFitAccumulator):
        result.add(samples, threads=this.threads)
    else:
        result.add(samples)
    return result, identity(path) == before and _mark(path) == mark


def _leaf(path: str, before: _Mark | None, begun: _Accumulator, this: _Round) -> _Part:
    """Of one file. `before`: as it was in the first round, after which none is left out."""
    try:
        mark = _mark(path)
        if before is not None and mark != before:
            raise ValueError(f"{path}: changed since the first round over the files; fit again")
        saved = _saved_as(path, mark, this)
        accumulator, is_new = _kept(saved, this.kind), False
        if accumulator is None:
            accumulator, is_new = _read(path, mark, begun, this)
    except (OSError, ValueError) as error:
        text = str(error) if os.path.basename(path) in str(error) else f"{path}: {error}"
        if this.skip_broken and before is None:
            return _Part(None, {}, {path: text})
        raise OSError(text) from None
    if saved is not None and is_new:
        _save(accumulator.state(), saved)
    return _Part(accumulator, {path: mark}, {})


def _merged(first: _Part, second: _Part) -> _Part:
    read, skipped = {**first.read, **second.read}, {**first.skipped, **second.skipped}
    if first.accumulator is None or second.accumulator is None:
        return _Part(first.accumulator or second.accumulator, read, skipped)
    result: Any = copy.deepcopy(first.accumulator)  # what workers hold must not change
    result.merge(second.accumulator)
    return _Part(result, read, skipped)


def _tree(parts: Iterable[Any], merged: Callable[[Any, Any], Any]) -> Any:
    """Binary, over their order; no more parts at once than it has levels."""
    stack: list[tuple[int, Any]] = []
    for part in parts:
        stack.append((1, part))
        while len(stack) > 1 and stack[-1][0] == stack[-2][0]:
            (size, first), (_, second) = stack[-2:]
            stack[-2:] = [(2 * size, merged(first, second))]
    while len(stack) > 1:
        (size, first), (more, second) = stack[-2:]
        stack[-2:] = [(size + more, merged(first, second))]
    return stack[0][1]


def _there(
    client: distributed.Client,
    files: dict[str, _Mark | None],
    begun: _Accumulator,
    this: _Round,
    progress: Callable[[Any], Any] | None,
) -> _Part:
    """By workers, in the order of the tree: each merge goes before the files after it, and nothing is held here that is
    merged, so that workers have few states at once."""

    def sent(*task: Any, key: str | None = None) -> Any:
        return client.submit(*task, pure=False, fifo_timeout="0 ms", key=key)

    there = sent(this.kind.of, begun.state())  # of a worker that dies it is made again
    watched: Any = None
    if progress is not None:
        from distributed import as_completed

        watched = as_completed()

    def leaves() -> Iterator[Any]:
        for path, mark in files.items():
            name = f"_leaf-{os.path.basename(path)}-{uuid.uuid4().hex}"  # which Dask names if workers die of it
            leaf = sent(_leaf, path, mark, there, this, key=name)
            if watched is not None:
                watched.add(leaf)
            yield leaf

    root = _tree(leaves(), lambda first, second: sent(_merged, first, second))
    if progress is not None:
        for _ in progress(watched):
            pass
    try:
        result: _Part = root.result()
    except CancelledError:  # with the name of a piece
        raise ConnectionError("client: lost its scheduler; with checkpoint= another call continues") from None
    return result


def _of_all(
    files: dict[str, _Mark | None],
    begun: _Accumulator,
    this: _Round,
    client: distributed.Client | None,
    progress: Callable[[Any], Any] | None,
) -> _Part:
    """One round."""
    if client is None:
        each: Iterable[str] = files if progress is None else progress(list(files))
        part: _Part = _tree((_leaf(path, files[path], begun, this) for path in each), _merged)
        return part
    return _there(client, files, begun, this, progress)


def _goes_on(accumulator: SampleFitAccumulator, checkpoint: str | None) -> bool:
    try:
        return accumulator.next_round()
    except ValueError as error:
        if "of other samples" not in str(error):
            raise
        why = "a file was changed, but not its size and time"
        if checkpoint is not None:
            why += f", now or since its state was kept: empty {checkpoint}"
        raise ValueError(f"files: {error}: {why}") from None


def _rounds(
    paths: Sequence[str], this: _Round, client: distributed.Client | None, progress: Callable[[Any], Any] | None
) -> _Part:
    part = _of_all(dict.fromkeys(paths), this.kind.empty(), this, client, progress)
    if part.accumulator is None:
        raise ValueError(f"files: none of {len(paths)} can be read; the first: {next(iter(part.skipped.values()))}")
    skipped = part.skipped
    while isinstance(part.accumulator, SampleFitAccumulator) and _goes_on(part.accumulator, this.checkpoint):
        begun = part.accumulator
        this = this._replace(begun=hashlib.sha256(begun.state().tobytes()).hexdigest())
        part = _of_all(dict(part.read), begun, this, client, progress)
    return part._replace(skipped=skipped)


def _require_fitting(uncertainty: str, weights: str | None, declared: dict[str, float] | None) -> None:
    if uncertainty not in ("sample", "noise"):
        raise ValueError(f"uncertainty {uncertainty!r}: must be 'sample' or 'noise'")
    if uncertainty == "noise" and weights not in (None, "none"):
        raise ValueError(f"weights {weights!r}: with uncertainty='noise' files are fitted with weights='none' alone")
    if uncertainty == "noise" and declared:
        raise ValueError("declared: errors are declared of a sample, with uncertainty='sample'")


def _refusal(accumulator: _Accumulator, options: dict[str, Any]) -> str:
    try:
        accumulator.solve(**options)
    except ValueError as error:
        return str(error)
    return ""


def _require_solvable(empty: _Accumulator, options: dict[str, Any]) -> None:
    """What is wrong with options by themselves is said before anything is read: not by the end of all rounds."""
    try:
        refusal = _refusal(empty, options)
    except TypeError as error:
        raise TypeError(str(error).replace(f"{type(empty).__name__}.solve", "distributed.fit")) from None
    if refusal != _refusal(empty, {}):  # that nothing was added yet
        raise ValueError(refusal)


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
    uncertainty: str = "sample",
    declared: dict[str, float] | None = None,
    weights: str | None = None,
    minimum_norm: bool = False,
    name: str = "",
    attribution: str = "",
    skip_broken: bool = False,
    checkpoint: str | os.PathLike[str] | None = None,
    progress: Callable[[Any], Any] | None = None,
    **read: Any,
) -> ArchiveFit:
    """The fit of the samples of all files, as mmbrdf.fit() of all of them in memory.

    files        of samples, as read_samples() takes them, each once, or one of them; its options (columns, frame, ...) may be given, too. Workers
                 must find them by the same names
    client       a distributed.Client; None: in this process, one file after the other
    uncertainty  'sample': that of a real sample, as a SampleFitAccumulator has it, in up to four rounds over the files;
                 where it cannot be had it is that of the noise, and FitResult.warnings says why. 'noise': of the noise
                 alone, as a FitAccumulator has it, in one round and with weights of 1
    declared     as mmbrdf.fit() takes it
    weights      with 'sample' 'none' or 'speckle'; None: 'speckle' with the isotropic basis, else 'none'
    skip_broken  files that cannot be read are left out, and named in the result; otherwise the first of them is an OSError.
                 A file that was read in the first round and is changed or gone in a later one is an OSError
    checkpoint   a folder in which the state of each file is kept for each round, whole or not at all: another call
                 continues with what is there, unless the file was changed, or is read or fitted with other options; a
                 state that is damaged is made again. Workers must find it, too
    progress     such as tqdm.tqdm, which is given what is gone through in each round
    Other options are those of the accumulator and its solve().

    In memory are the samples of one file for each worker, and some states. Raises OSError, naming the file, for one that
    is broken; ValueError for no files, one that is there twice, and as solve() does; TypeError for an option that there is
    not.
    """
    paths = [os.fspath(file) for file in ([files] if isinstance(files, str | os.PathLike) else files)]
    if not paths:
        raise ValueError("files: none")
    _require_once(paths)
    _require_fitting(uncertainty, weights, declared)
    if uncertainty == "sample":
        _require_lasting(paths)
    kind = _Kind(basis, two_orders(orders), mapping, as_printed, uncertainty, weights)
    _require_known(read)
    if client is not None and not callable(getattr(client, "submit", None)):
        raise TypeError(f"client: expected a distributed.Client, not {type(client).__name__}")
    if getattr(client, "asynchronous", False):
        raise ValueError("client: is asynchronous, and would not be waited for: take a Client without that")
    options: dict[str, Any] = {"powers": powers, "reflectance": reflectance, "minimum_norm": minimum_norm}
    if uncertainty == "sample":
        options["declared"] = declared or {}
    options |= {"name": name, "attribution": attribution}
    _require_solvable(kind.empty(), options)
    folder = None if checkpoint is None else os.path.abspath(os.fspath(checkpoint))
    if folder is not None:
        os.makedirs(folder, exist_ok=True)
    this = _Round(kind, "", skip_broken, folder, read, threads=0 if client is None else 1)
    accumulator, _, skipped = _rounds(paths, this, client, progress)
    assert accumulator is not None
    return ArchiveFit(accumulator.solve(**options), accumulator.samples, skipped)
