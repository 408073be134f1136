# SPDX-License-Identifier: BSD-3-Clause
"""HTML pages as PDF, printed by Chromium or a browser of its kind."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
_OPTIONS = (
    "--headless --disable-gpu --no-first-run --disable-background-networking --disable-component-update --disable-sync"
).split()
_PATIENCE_S = 240


def browser() -> str | None:
    """MMBRDF_BROWSER, or the first that is installed."""
    chosen = os.environ.get("MMBRDF_BROWSER")
    return chosen or next((path for path in map(shutil.which, _NAMES) if path), None)


def required_browser() -> str:
    """Raises ValueError where there is none; asked before a page is made, which takes seconds."""
    program = browser()
    if program is None:
        raise ValueError(
            "PDF is printed by Chromium, which was not found: install chromium, or name a browser of its kind in "
            "MMBRDF_BROWSER; a report as .html can be printed by any browser"
        )
    return program


def printed(page: str, date: str) -> bytes:
    """The page as PDF, on the paper that its style names. ``date`` is that of the report, 2026-11-30T00:20:00+00:00, and becomes
    that of the file where SOURCE_DATE_EPOCH is set.

    Raises ValueError, in a line, where there is no browser, and where it makes no PDF.
    """
    program = required_browser()
    # A browser that is confined to a user's files (snap) sees no hidden or temporary folders, but those in its own.
    with tempfile.TemporaryDirectory(prefix="mmbrdf-report-") as folder:
        source, target = Path(folder) / "report.html", Path(folder) / "report.pdf"
        source.write_text(page, encoding="utf-8")
        command = [program, *_OPTIONS, f"--user-data-dir={folder}/profile", "--no-pdf-header-footer"]
        # Its sandbox does not run as root; the page has no scripts and loads nothing.
        command += ["--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else []
        command += [f"--print-to-pdf={target}", source.as_uri()]
        try:
            done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=_PATIENCE_S)
        except OSError as error:
            raise ValueError(f"PDF is printed by Chromium: {program}: {error.strerror}") from None
        except subprocess.TimeoutExpired:
            raise ValueError(f"PDF is printed by Chromium: {program} did not end within {_PATIENCE_S} s") from None
        if not target.exists():
            said = next(
                (line for line in reversed(done.stderr.splitlines()) if line.strip()), f"exit {done.returncode}"
            )
            raise ValueError(f"PDF is printed by Chromium: {program} made none: {said.strip()[:200]}")
        pdf = target.read_bytes()
    return _dated(pdf, date) if "SOURCE_DATE_EPOCH" in os.environ else pdf


def _dated(pdf: bytes, date: str) -> bytes:
    """With this date in place of now; of the same length, for a PDF has the places of its objects."""
    digits = re.sub(r"\D", "", date)[:14].encode()
    return re.sub(rb"(/(?:CreationDate|ModDate) \(D:)\d{14}", rb"\g<1>" + digits, pdf)
