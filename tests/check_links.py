#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the Markdown pages of the repository: linked files, linked headings and named files exist.

    check_links.py FOLDER    prints one line for each that does not, exit status 1
"""

import re
import sys
from pathlib import Path

LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
NAMED_FILE = re.compile(r"`((?:\./)?(?:apps|cmake|docs|examples|include|materials|python|src|tests)/[\w./-]+\.\w+)`")
CODE_BLOCK = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)


def anchors(page):
    """The names that #links may use: headings in lower case, without punctuation, hyphens for spaces."""
    headings = re.findall(r"^#+ (.+)$", CODE_BLOCK.sub("", page.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def problems(page, root):
    text = CODE_BLOCK.sub(lambda block: "\n" * block[0].count("\n"), page.read_text(encoding="utf-8"))
    for number, line in enumerate(text.splitlines(), start=1):
        for target in LINK.findall(line):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            file = page.parent / name if name else page
            if not file.exists():
                yield f"{page.relative_to(root)}:{number}: {target}: no such file"
            elif anchor and anchor not in anchors(file):
                yield f"{page.relative_to(root)}:{number}: {target}: no such heading"
        for name in NAMED_FILE.findall(line):
            if not (root / name).exists():
                yield f"{page.relative_to(root)}:{number}: {name}: no such file"


def main():
    root = Path(sys.argv[1]).resolve()
    pages = sorted([*root.glob("*.md"), *root.glob("docs/*.md")])
    found = [problem for page in pages for problem in problems(page, root)]
    print(*found, f"{len(pages)} pages, {len(found)} broken links", sep="\n")
    return 1 if found or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
