#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks what the repository says of itself. Of the Markdown pages: linked files, linked headings, named files and
quoted tests exist; a picture may be one that a command of the page makes (`-o NAME`, or `savefig("NAME"`). Of pages, headers, sources and scripts: each `theory 4.7` is a numbered heading of docs/theory.md.

    check_links.py FOLDER    prints one line for each that does not, exit status 1
"""

import fnmatch
import re
import sys
from pathlib import Path

LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
NAMED_FILE = re.compile(r"`((?:\./)?(?:apps|cmake|docs|examples|include|materials|python|src|tests)/[\w./-]+\.\w+)`")
MADE = re.compile(r"(?:-o |savefig\(\")([\w.-]+\.png)")
CODE_BLOCK = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
CITATION = re.compile(r"\btheory(?:\s|//+|#)+([A-Z]?\d+(?:\.\d+)?)", re.IGNORECASE)
NUMBERED = re.compile(r"^#+ (\d+(?:\.\d+)?) ", re.MULTILINE)
TEST = re.compile(r"\b(?:TEST(?:_F)?|RC_GTEST(?:_FIXTURE)?_PROP)\(\s*(\w+),\s*(\w+)")
# `Suite.Name` or `Suite.*`, and where that is said, the file: "`A.B`, `C.*` in `tests/c.cpp`"
QUOTED_TEST = re.compile(r"`([A-Z]\w*\.[A-Z*][\w*]*)`(?=((?:,\s+`[A-Z]\w*\.[A-Z*][\w*]*`)*\s+in\s+`([\w./-]+\.cpp)`)?)")
SOURCES = ("apps", "examples", "include", "python", "src", "tests")


def without_code_blocks(page):
    return CODE_BLOCK.sub(lambda block: "\n" * block[0].count("\n"), page.read_text(encoding="utf-8"))


def anchors(page):
    """The names that #links may use: headings in lower case, without punctuation, hyphens for spaces."""
    headings = re.findall(r"^#+ (.+)$", without_code_blocks(page), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def tests_of(root):
    """The C++ tests as Suite.Name, by their file as pages name it."""
    files = sorted(root.glob("tests/**/*.cpp"))
    names = lambda file: {".".join(name) for name in TEST.findall(file.read_text(encoding="utf-8"))}
    return {file.relative_to(root).as_posix(): names(file) for file in files}


def wrong_links(page, root):
    made = set(MADE.findall(page.read_text(encoding="utf-8")))
    for number, line in enumerate(without_code_blocks(page).splitlines(), start=1):
        for target in LINK.findall(line):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            file = page.parent / name if name else page
            if not file.exists() and target not in made:
                yield number, f"{target}: no such file"
            elif anchor and anchor not in anchors(file):
                yield number, f"{target}: no such heading"
        for name in NAMED_FILE.findall(line):
            if not (root / name).exists():
                yield number, f"{name}: no such file"


def wrong_tests(page, tests):
    text = without_code_blocks(page)
    for found in QUOTED_TEST.finditer(text):
        name, _, file = found.groups()
        where = tests.get(file, set()) if file else set().union(*tests.values())
        if not fnmatch.filter(where, name):
            yield text.count("\n", 0, found.start()) + 1, f"{name}: no such test" + (f" in {file}" if file else "")


def wrong_citations(file, sections):
    text = file.read_text(encoding="utf-8")
    for found in CITATION.finditer(text):
        if found[1] not in sections:
            yield text.count("\n", 0, found.start()) + 1, f"theory {found[1]}: no such section"


def main(folder):
    root = Path(folder).resolve()
    pages = sorted([*root.glob("*.md"), *root.glob("docs/**/*.md")])
    sources = sorted(
        file for folder in SOURCES for end in ("cpp", "hpp", "py") for file in root.glob(f"{folder}/**/*.{end}")
    )
    theory = root / "docs" / "theory.md"
    sections = set(NUMBERED.findall(without_code_blocks(theory))) if theory.exists() else set()
    tests = tests_of(root)
    wrong = [(page, *problem) for page in pages for problem in [*wrong_links(page, root), *wrong_tests(page, tests)]]
    wrong += [(file, *problem) for file in pages + sources for problem in wrong_citations(file, sections)]
    for file, number, problem in wrong:
        print(f"{file.relative_to(root)}:{number}: {problem}")
    print(f"{len(pages)} pages, {len(sources)} sources, {len(wrong)} broken links")
    return 1 if wrong or not pages else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
