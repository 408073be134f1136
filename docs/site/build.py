#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Builds the documentation site: the pages of docs/, the headers by Doxygen and the Python package, with Sphinx.

    build.py --programs build/release --output build/docs

The site is then OUTPUT/html/index.html. What a page shows and the repository does not hold, a picture, is made by the commands of
that page, which must print what the page says. Exit status 77 where Sphinx, MyST, its theme or Doxygen are not installed.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
SKIPPED = 77
LINK = re.compile(r"(\]\()([^)\s]+)(\))")
CODE = re.compile(r"(^```.*?^```$|^~~~.*?^~~~$|`[^`\n]*`)", re.MULTILINE | re.DOTALL)
HEADER = re.compile(r"^`(\w+/\w+\.hpp)`$")
PICTURE = re.compile(r"!\[[^\]]*\]\(([^)\s]+)\)")
ROOT_PAGES = {
    "README.md": "readme.md",
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
    "web/mmbrdf/README.md": "javascript.md",
}

# The order of the pages, and their captions; every page of docs/ is in one of them.
CONTENTS = {
    "I have …": [
        "for/remote_sensing",
        "for/goniometer",
        "for/renderer",
        "for/polarimeter",
        "for/paper",
        "for/scatmech",
    ],
    "Guides": [
        "gallery",
        "python",
        "cpp",
        "javascript",
        "explorer",
        "interfaces",
        "uncertainty",
        "polarimeter",
        "scale",
        "formats",
    ],
    "Reference": [
        "conventions",
        "theory",
        "reference/python",
        "reference/plot",
        "reference/images",
        "reference/distributed",
        "headers/index",
        "paper",
        "interoperability",
    ],
    "The project": ["readme", "reliability", "performance", "packages", "development", "contributing", "changelog"],
}


def missing_tools() -> list[str]:
    modules = {"sphinx": "python3-sphinx", "myst_parser": "python3-myst-parser", "furo": "furo"}
    missing = [package for module, package in modules.items() if not importlib.util.find_spec(module)]
    return missing + ([] if shutil.which("doxygen") else ["doxygen"])


def staged_name(path: Path) -> str:
    """Where a file of the repository is in the site's sources."""
    name = path.relative_to(SOURCE).as_posix()
    if name in ROOT_PAGES:
        return ROOT_PAGES[name]
    return name.removeprefix("docs/") if name.startswith("docs/") else f"files/{name}"


def with_links(text: str, page: Path, stage: Path) -> str:
    """The text of a page with links as they are in the site, and one for each name of a header. Linked files of the repository
    are copied beside the pages."""
    here = Path(staged_name(page)).parent

    def link(found: re.Match) -> str:
        name, hash_, anchor = found[2].partition("#")
        if re.match(r"[a-z]+:", found[2]) or not name:
            return found[0]
        target = (page.parent / name).resolve()
        if not target.exists():  # a picture that the page makes
            return found[0]
        staged = staged_name(target)
        if staged.startswith("files/"):
            (stage / staged).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(target, stage / staged)
        return found[1] + os.path.relpath(staged, here) + hash_ + anchor + found[3]

    def header(found: re.Match) -> str:
        is_one = (SOURCE / "include/mmbrdf" / found[1]).exists()
        return f"[{found[0]}]({os.path.relpath('headers/' + found[1], here)[:-4]}.md)" if is_one else found[0]

    parts = CODE.split(text)
    return "".join(HEADER.sub(header, part) if k % 2 else LINK.sub(link, part) for k, part in enumerate(parts))


def staged_text(page: Path, stage: Path) -> str:
    text = with_links(page.read_text(encoding="utf-8"), page, stage)
    return re.sub(r"^```\n(?=\$ )", "```console\n", text, flags=re.MULTILINE)


def made_pictures(page: Path) -> list[str]:
    """Those that a page shows and its commands make."""
    return [name for name in PICTURE.findall(page.read_text(encoding="utf-8")) if not (page.parent / name).exists()]


def make_pictures(page: Path, stage: Path, options: argparse.Namespace) -> bool:
    """Runs the commands of a page that makes pictures, and keeps these. False if they do not print what the page says."""
    wanted, folder = made_pictures(page), (stage / staged_name(page)).parent
    if not wanted:
        return True
    kept = [options.pictures / page.stem / name for name in wanted] if options.pictures else []
    newest = max(page.stat().st_mtime, (options.programs / "mmbrdf").stat().st_mtime)
    if kept and all(picture.exists() and picture.stat().st_mtime > newest for picture in kept):
        for picture in kept:
            shutil.copy(picture, folder)
        return True
    command = [sys.executable, SOURCE / "tests/cli/run.py", page, "--pictures", folder]
    command += ["--programs", options.programs, "--source", SOURCE]
    done = subprocess.run([str(part) for part in command], text=True, capture_output=True)
    said = "failed" if done.returncode else f"{len(wanted)} pictures"
    print(f"{page.relative_to(SOURCE)}: {said}\n{done.stdout}{done.stderr}", end="", flush=True)
    return done.returncode == 0


def contents(stage: Path) -> str:
    listed = [name for names in CONTENTS.values() for name in names]
    there = {path.relative_to(stage).with_suffix("").as_posix() for path in stage.rglob("*.md")}
    there = {name for name in there if not name.startswith(("headers/", "files/"))} | {"headers/index"}
    if there - {"index"} != set(listed):
        sys.exit(f"error: docs/site/build.py: CONTENTS and pages differ: {sorted((there - {'index'}) ^ set(listed))}")
    toctree = "```{{toctree}}\n:hidden:\n:caption: {}\n\n{}\n```\n"
    return "\n".join(toctree.format(caption, "\n".join(names)) for caption, names in CONTENTS.items())


REFERENCE = {
    "python": "# mmbrdf for Python\n\nWhat `help(mmbrdf)` says of everything; [python.md](../python.md) is the guide.\n\n"
    "```{eval-rst}\n.. automodule:: mmbrdf\n```\n",
    "plot": "# mmbrdf.plot\n\nPictures; the [gallery](../gallery.md) shows them.\n\n"
    "```{eval-rst}\n.. automodule:: mmbrdf.plot\n```\n",
    "images": "# mmbrdf.images\n\nCameras; [scale.md](../scale.md#images) is the guide.\n\n"
    "```{eval-rst}\n.. automodule:: mmbrdf.images\n```\n",
    "distributed": "# mmbrdf.distributed\n\nArchives of files; [scale.md](../scale.md#archives) is the guide.\n\n"
    "```{eval-rst}\n.. automodule:: mmbrdf.distributed\n```\n",
}


def stage_pages(stage: Path, options: argparse.Namespace) -> None:
    import headers

    shutil.rmtree(stage, ignore_errors=True)
    pages = [*sorted((SOURCE / "docs").rglob("*.md")), *(SOURCE / name for name in ROOT_PAGES)]
    for page in pages:
        target = stage / staged_name(page)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(staged_text(page, stage), encoding="utf-8")
    for picture in (SOURCE / "docs").rglob("*.png"):
        shutil.copy(picture, stage / staged_name(picture))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        if not all(pool.map(lambda page: make_pictures(page, stage, options), pages)):
            sys.exit("error: commands of a page do not print what it says")
    (stage / "reference").mkdir()
    for name, text in REFERENCE.items():
        (stage / "reference" / f"{name}.md").write_text(text, encoding="utf-8")
    include = SOURCE / "include"
    headers.Pages(include, headers.doxygen(include, stage.parent / "doxygen")).write(stage / "headers")
    with open(stage / "index.md", "a", encoding="utf-8") as index:
        index.write("\n" + contents(stage))


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", type=Path, default=SOURCE / "build/release", help="folder of the built program")
    parser.add_argument("--output", type=Path, default=SOURCE / "build/docs")
    parser.add_argument("--pictures", type=Path, help="where tests/cli/run.py has left the pictures of each page")
    options = parser.parse_args(arguments)
    if missing := missing_tools():
        print(f"skipped: the site needs {', '.join(missing)}: ./dev packages docs")
        return SKIPPED
    options.programs, output = options.programs.resolve(), options.output.resolve()
    os.environ["PYTHONPATH"] = os.pathsep.join(
        filter(None, [str(options.programs / "python"), os.environ.get("PYTHONPATH")])
    )
    os.environ["MPLBACKEND"] = "Agg"
    stage_pages(output / "pages", options)
    command = [sys.executable, "-m", "sphinx", "-b", "html", "-W", "--keep-going", "-q", "-j", "auto"]
    command += [
        "-c",
        str(SOURCE / "docs/site"),
        "-d",
        str(output / "doctrees"),
        str(output / "pages"),
        str(output / "html"),
    ]
    shutil.rmtree(output / "html", ignore_errors=True)
    if subprocess.run(command).returncode:
        return 1
    print(f"the site: {output / 'html/index.html'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
