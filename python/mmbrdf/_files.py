# SPDX-License-Identifier: BSD-3-Clause
"""Files that are written wholly or not at all, and those that must not change while they are read."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import stat
import uuid
from collections.abc import Iterator
from pathlib import Path


def said(error: Exception) -> str:
    """An error in a line: of the system, which file and what."""
    if isinstance(error, OSError) and error.filename and error.strerror:
        return f"{os.fspath(error.filename)}: {error.strerror}"
    return str(error)


def identity(path: str | os.PathLike[str]) -> tuple[int, ...]:
    """Another one when the file was replaced, or written into."""
    at = os.stat(path)
    return at.st_dev, at.st_ino, at.st_size, at.st_mtime_ns, at.st_ctime_ns


def digest(path: str | os.PathLike[str]) -> str:
    """SHA-256 of the file; empty of a pipe, whose content is gone once it was read."""
    if not stat.S_ISREG(os.stat(path).st_mode):
        return ""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def digest_of_what_was_read(path: str | os.PathLike[str], before: tuple[int, ...]) -> str:
    """The digest of a file whose identity was this before it was read. Raises ValueError if it is another file now."""
    result = digest(path)
    if result and identity(path) != before:
        raise ValueError(f"{os.fspath(path)}: changed while it was read: run it again")
    return result


@contextlib.contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A file to be written, which then takes the place of ``path``, through links and with its mode. Of an error nothing is left,
    whoever else writes the same: threads, and nodes on which processes have the same number."""
    target = Path(os.path.realpath(path))
    beside = target.with_name(f".mmbrdf-{uuid.uuid4().hex}")
    mode = _mode_of(target, path)
    try:
        open(beside, "xb").close()
    except OSError as error:
        raise OSError(error.errno, error.strerror, os.fspath(path)) from None
    try:
        yield beside
        with open(beside, "rb+") as whole:
            os.fsync(whole.fileno())
        if mode is not None:
            os.chmod(beside, mode)
        os.replace(beside, target)
    finally:
        beside.unlink(missing_ok=True)


def _mode_of(target: Path, path: str | os.PathLike[str]) -> int | None:
    """Of the file that is to be replaced; None: there is none."""
    if not target.exists():
        return None
    if not target.is_file():
        raise OSError(errno.EINVAL, "not a file that can be replaced", os.fspath(path))
    if not os.access(target, os.W_OK):
        raise OSError(errno.EACCES, os.strerror(errno.EACCES), os.fspath(path))
    return stat.S_IMODE(target.stat().st_mode)
