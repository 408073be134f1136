#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A checker of links is only worth something if it finds the broken ones."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import check_links

# In two parts, so that the sections cited here are not looked for in the real page.
THEORY = "the" + "ory"


class Check(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write("docs/theory.md", "# Theory\n\n## 1 Axes\n\n### 1.2 Symmetries\n\n## Misprints\n")
        self.write(
            "tests/geometry/test_frame.cpp", "TEST(Frame, IsRight) {}\nRC_GTEST_PROP(Frame,\n    Turns, ()) {}\n"
        )
        self.write("tests/model/test_model.cpp", "TEST_F(Model, IsReciprocal) {}\n")

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def broken(self, text, name="README.md"):
        """What is found to be wrong in a page or source with this text."""
        self.write("README.md", "# A page\n")
        self.write(name, text)
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            status = check_links.main(str(self.root))
        *problems, count = printed.getvalue().splitlines()
        self.assertEqual(status, 1 if problems else 0)
        self.assertTrue(count.endswith(f", {len(problems)} broken links"))
        return problems

    def test_links_and_files_must_exist(self):
        self.assertEqual(self.broken("[a](docs/theory.md#12-symmetries) `tests/model/test_model.cpp`\n"), [])
        self.assertEqual(self.broken("\n[a](docs/none.md)\n"), ["README.md:2: docs/none.md: no such file"])
        self.assertEqual(
            self.broken("[a](docs/theory.md#none)\n"), ["README.md:1: docs/theory.md#none: no such heading"]
        )
        self.assertEqual(self.broken("`src/none.cpp`\n"), ["README.md:1: src/none.cpp: no such file"])

    def test_what_is_in_a_block_of_code_does_not_count(self):
        self.assertEqual(self.broken("```\n[a](none.md) `Frame.IsNone`\n```\n"), [])

    def test_a_picture_may_be_made_by_a_command_of_the_page(self):
        self.assertEqual(self.broken("```\n$ mmbrdf plot map ptfe -o a.png\n```\n![a](a.png)\n"), [])
        self.assertEqual(self.broken("![a](b.png)\n"), ["README.md:1: b.png: no such file"])
        self.assertEqual(self.broken("![a](c.png)\n", "docs/for/a.md"), ["docs/for/a.md:1: c.png: no such file"])

    def test_quoted_tests_must_exist(self):
        self.assertEqual(
            self.broken("`Frame.IsRight`, `Frame.Turns`, `Model.*` and `Model.Is*`, not `Model.powers`\n"), []
        )
        self.assertEqual(self.broken("\n\n`Frame.IsLeft`\n"), ["README.md:3: Frame.IsLeft: no such test"])
        self.assertEqual(self.broken("`Fram.*`\n"), ["README.md:1: Fram.*: no such test"])

    def test_quoted_tests_must_be_in_the_file_that_is_named(self):
        self.assertEqual(self.broken("`Frame.IsRight`, `Frame.*` in `tests/geometry/test_frame.cpp`\n"), [])
        wrong = "README.md:1: Frame.*: no such test in tests/model/test_model.cpp"
        self.assertEqual(self.broken("`Frame.*` in\n`tests/model/test_model.cpp`\n"), [wrong])
        self.assertEqual(self.broken("`Frame.*`, `Model.*` in `tests/model/test_model.cpp`\n"), [wrong])

    def test_cited_sections_must_be_numbered_headings(self):
        for name in ("README.md", "docs/formats.md", "include/a.hpp", "src/a/b.cpp", "tests/python/test_a.py"):
            self.assertEqual(self.broken(f"// {THEORY} 1.2, {THEORY.title()} 1.\n", name), [])
            self.assertEqual(self.broken(f"{THEORY} 1.3\n", name), [f"{name}:1: {THEORY} 1.3: no such section"])
            self.write(name, "")
        self.assertEqual(self.broken(f"# {THEORY} B3\n", "a.md"), [f"a.md:1: {THEORY} B3: no such section"])

    def test_a_citation_may_go_on_in_the_next_line(self):
        wrong = [f"src/a.hpp:1: {THEORY} 7.1: no such section"]
        self.assertEqual(self.broken(f"/// as in {THEORY}\n/// 7.1.\n", "src/a.hpp"), wrong)


if __name__ == "__main__":
    unittest.main()
