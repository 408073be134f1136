#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of web/ as it was last built by `./dev test web`, against the program of this build.

    run.py module|page PROGRAM ROOT     exit status 77, with a reason, where there is nothing to test
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

SKIPPED = 77


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def main():
    which, program, root = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    web = root / "web"
    built = web / ("mmbrdf/dist/mmbrdf_module.wasm" if which == "module" else "dist/index.html")
    node = shutil.which("node")
    if not node:
        skip("no Node: ./dev test web installs what it needs")
    if not built.exists():
        skip(f"no {built.relative_to(root)}: ./dev test web builds it")
    if which == "page" and not (web / "node_modules/playwright-core").exists():
        skip("no web/node_modules: ./dev test web installs them")
    sources = [file for folder in ("include", "src", "web/mmbrdf") for file in (root / folder).rglob("*.?pp")]
    if max(file.stat().st_mtime for file in sources) > built.stat().st_mtime:
        skip(f"{built.relative_to(root)} is older than the library: ./dev test web builds it anew")
    tests = sorted((web / ("mmbrdf" if which == "module" else "explorer") / "test").glob("*.test.mjs"))
    environment = {**os.environ, "MMBRDF_PROGRAM": program}
    sys.exit(subprocess.run([node, "--test", *map(str, tests)], env=environment, check=False).returncode)


if __name__ == "__main__":
    main()
