#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Transcripts are only worth something if run.py can tell right from wrong."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import run


class Replay(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "transcript.txt"

    def replay(self, text, *options, ending=".txt"):
        self.path = self.path.with_suffix(ending)
        self.path.write_text(text)
        self.printed = io.StringIO()
        with contextlib.redirect_stdout(self.printed):
            return run.main([str(self.path), "--programs", "/nowhere", *options])

    def test_expected_output_passes(self):
        self.assertEqual(self.replay("# why\n$ echo a; echo b >&2\na\nb\n"), 0)

    def test_errors_of_a_command_with_a_pipe_come_last(self):
        self.assertEqual(self.replay("$ { echo b >&2; sleep 0.2; echo a; } | cat\na\nb\n"), 0)
        self.assertEqual(self.replay("$ { echo b >&2; echo a; } 2>&1 | cat\nb\na\n"), 0)
        self.assertEqual(self.replay("$ false || echo b >&2; echo a\nb\na\n"), 0)

    def test_other_output_fails_and_is_shown_as_a_difference(self):
        self.assertEqual(self.replay("$ echo a; echo c\na\nb\n"), 1)
        self.assertIn("\n a\n-b\n+c\n", self.printed.getvalue())

    def test_missing_and_additional_lines_fail(self):
        self.assertEqual(self.replay("$ echo a\n"), 1)
        self.assertEqual(self.replay("$ true\na\n"), 1)

    def test_a_failure_is_not_forgotten_by_what_follows(self):
        self.assertEqual(self.replay("$ echo a\nb\n$ echo c\nc\n"), 1)
        self.assertEqual(self.replay("$ echo a\nb\n? false\n"), 1)

    def test_exit_status_is_checked(self):
        self.assertEqual(self.replay("$ false\n"), 1)
        self.assertEqual(self.replay("$ echo a; exit 3\na\n[exit 3]\n"), 0)
        self.assertEqual(self.replay("$ echo a\na\n[exit 3]\n"), 1)
        self.assertEqual(self.replay("$ false | cat\n[exit 1]\n"), 0)
        self.assertEqual(self.replay("$ mmbrdf-that-is-not-there 2>/dev/null\n[exit 127]\n"), 0)

    def test_numbers_may_differ_in_the_last_digits_only(self):
        self.assertEqual(self.replay("$ echo 'f11 = 0.30000000001, 2e-17'\nf11 =  0.3, -1e-17\n"), 0)
        self.assertEqual(self.replay("$ echo 0.300000001\n0.3\n"), 1)
        self.assertEqual(self.replay("$ echo 7296 rows\n7297 rows\n"), 1)
        self.assertEqual(self.replay("$ echo f12\nf11\n"), 1)
        self.assertEqual(self.replay("$ echo 1 2\n1\n"), 1)
        self.assertEqual(self.replay("$ echo 1 nan\n1 0\n"), 1)

    def test_an_ellipsis_is_any_number_of_lines(self):
        self.assertEqual(self.replay("$ seq 9\n1\n...\n5\n...\n9\n"), 0)
        self.assertEqual(self.replay("$ seq 9\n...\n"), 0)
        self.assertEqual(self.replay("$ seq 2\n1\n...\n2\n"), 0)
        self.assertEqual(self.replay("$ seq 9\n1\n...\n10\n"), 1)

    def test_comments_follow_an_empty_line(self):
        self.assertEqual(self.replay("$ echo '# a'; echo 'b'\n# a\nb\n\n# why\n\n$ echo '# c'\n# c\n\n# end\n"), 0)
        self.assertEqual(self.replay("$ echo a\na\n# not a comment\n"), 1)

    def test_files_stay_for_the_next_command_and_paths_have_names(self):
        self.assertEqual(self.replay("$ echo a > x\n$ cat x\na\n"), 0)
        self.assertEqual(self.replay('$ echo "$MMBRDF_SOURCE/x"\n$MMBRDF_SOURCE/x\n'), 0)

    def test_an_unmet_condition_skips_the_rest(self):
        self.assertEqual(self.replay("$ echo a\na\n? false\n$ echo a\nb\n"), run.SKIPPED)
        self.assertIn("skipped: ", self.printed.getvalue())
        self.assertEqual(self.replay("? true\n$ echo a\nb\n"), 1)

    def test_a_file_without_commands_fails(self):
        self.assertEqual(self.replay("mmbrdf info ptfe\n"), 1)

    def test_update_rewrites_what_differs_and_nothing_else(self):
        self.assertEqual(self.replay("# why\n$ seq 3\n...\n3\n\n# next\n$ echo a; false\nb\n", "--update"), 0)
        self.assertEqual(self.path.read_text(), "# why\n$ seq 3\n...\n3\n\n# next\n$ echo a; false\na\n[exit 1]\n")

    def test_of_a_page_blocks_that_begin_with_a_command_or_a_name_are_the_transcript(self):
        page = "```sh\nfalse\n```\n```python\n# a.py\nprint(2)\n```\nas in\n```\n$ python3 a.py\n{}\n$ ls\na.py\n```\n"
        self.assertEqual(self.replay(page.format(2), ending=".md"), 0)
        self.assertEqual(self.replay(page.format(3), ending=".md"), 1)
        self.assertEqual(self.replay("```python\n# a.py\n```\n", ending=".md"), 1)

    def test_pictures_of_a_page_are_made_and_kept(self):
        kept = self.path.parent / "kept"
        page = "```\n$ echo 1 >a.png; echo {}\n2\n```\n![a](a.png)\n{}"
        keep = ("--pictures", str(kept))
        self.assertEqual(self.replay(page.format(3, ""), *keep, ending=".md"), 1)
        self.assertFalse(kept.exists())
        self.assertEqual(self.replay(page.format(2, "![b](b.png)\n"), ending=".md"), 1)
        self.assertIn("no command makes b.png", self.printed.getvalue())
        (self.path.parent / "b.png").touch()
        self.assertEqual(self.replay(page.format(2, "![b](b.png)\n"), *keep, ending=".md"), 0)
        self.assertEqual([path.name for path in kept.iterdir()], ["a.png"])

    def test_update_rewrites_what_differs_in_a_page(self):
        page = "# A\n```python\n# a.py\nprint(2)\n```\n```\n$ python3 a.py\n{}\n$ echo 3; echo 4\n...\n4\n```\n"
        page += "and\n```\n$ echo 5\n{}\n```\n"
        self.assertEqual(self.replay(page.format(1, 1), "--update", ending=".md"), 0)
        self.assertEqual(self.path.read_text(), page.format(2, 5))


if __name__ == "__main__":
    unittest.main()
