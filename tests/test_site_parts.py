#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the site is made of: comments of headers, docstrings, links."""

import sys
import tempfile
import unittest
from pathlib import Path

SITE = Path(__file__).resolve().parents[1] / "docs/site"
sys.path.insert(0, str(SITE))
import build  # noqa: E402
import docstrings  # noqa: E402
import headers  # noqa: E402

HEADER = """// SPDX-License-Identifier: BSD-3-Clause
/// What it is:
///     a = b
#pragma once

struct One {
  double first = 0;  ///< of the first,
                     ///< and more
  double second = 0;
  /// Of the third.
  template <class Real>
  void third();
};
"""


class Comments(unittest.TestCase):
    def setUp(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "a.hpp")
            path.write_text(HEADER)
            self.header = headers.Header(path)

    def test_that_begins_the_file(self):
        self.assertEqual(self.header.first(), "What it is:\n    a = b")

    def test_behind_a_declaration_with_the_lines_below(self):
        self.assertEqual(self.header.comment(7), "of the first,\nand more")

    def test_of_the_member_before_is_not_that_of_the_next(self):
        self.assertEqual(self.header.comment(9), "")

    def test_above_a_template(self):
        self.assertEqual(self.header.comment(12), "Of the third.")

    def test_keep_indented_lines_and_are_no_html(self):
        self.assertEqual(headers.markdown("a < b:\n    c < d\ne"), "a \\< b:\n\n~~~text\n    c < d\n~~~\n\ne")


class Docstrings(unittest.TestCase):
    def process(self, text):
        lines = text.split("\n")
        docstrings.process_docstring(None, "function", "f", None, None, lines)
        return lines

    def test_paragraphs_have_no_markup_but_code(self):
        self.assertEqual(self.process("*args of `x_`, y_"), ["\\*args of ``x_``, y\\_", ""])

    def test_code_may_go_on_in_the_next_line(self):
        self.assertEqual(self.process("As ``a\nb`` is."), ["As ``a b`` is.", ""])

    def test_columns_stay_as_they_are(self):
        shown = [".. code-block:: text", "", "   frame    of *both*", ""]
        self.assertEqual(self.process("One.\n\nframe    of *both*"), ["One.", "", *shown])

    def test_fields_without_a_word_have_none(self):
        self.assertEqual(self.process("Alias for field number 3"), [])

    def test_types_are_those_of_python(self):
        self.assertEqual(docstrings.simple("(self: mmbrdf._mmbrdf.Model, a: object, b: Optional[int] = None)"), "(a, b: int | None = None)")


class Pages(unittest.TestCase):
    def test_each_page_is_in_the_contents_once(self):
        listed = [name for names in build.CONTENTS.values() for name in names]
        generated = {"headers/index", *(f"reference/{name}" for name in build.REFERENCE)}
        pages = {p.relative_to(build.SOURCE / "docs").with_suffix("").as_posix() for p in (build.SOURCE / "docs").rglob("*.md")}
        roots = {Path(name).stem for name in build.ROOT_PAGES.values()}
        self.assertEqual(len(listed), len(set(listed)))
        self.assertEqual(set(listed), (pages - {"index"}) | roots | generated)

    def test_each_module_that_is_imported_by_its_name_has_a_page_in_the_reference(self):
        modules = {p.stem for p in (build.SOURCE / "python/mmbrdf").iterdir() if p.is_dir() or p.suffix == ".py"}
        private = {name for name in modules if name.startswith("_")}
        self.assertEqual(modules - private - {"report"}, set(build.REFERENCE) - {"python"})  # report is a function, too

    def test_links_lead_to_pages_and_to_copies_of_files(self):
        page = build.SOURCE / "docs/for/a.md"
        with tempfile.TemporaryDirectory() as folder:
            stage = Path(folder)
            write = lambda text: build.with_links(text, page, stage)
            self.assertEqual(write("[a](../formats.md#text)"), "[a](../formats.md#text)")
            self.assertEqual(write("[a](../../README.md)"), "[a](../readme.md)")
            self.assertEqual(write("[a](https://a.b/c) `[a](../../README.md)`"), "[a](https://a.b/c) `[a](../../README.md)`")
            self.assertEqual(write("[a](../../include/mmbrdf.h)"), "[a](../files/include/mmbrdf.h)")
            self.assertTrue((stage / "files/include/mmbrdf.h").exists())
            self.assertEqual(write("`model/batch.hpp`"), "[`model/batch.hpp`](../headers/model/batch.md)")
            self.assertEqual(write("`model/none.hpp`"), "`model/none.hpp`")


if __name__ == "__main__":
    unittest.main()
