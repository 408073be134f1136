# SPDX-License-Identifier: BSD-3-Clause
"""Where a report is written: links, modes, pipes and full devices."""

import os
import re
import stat

import pytest

from mmbrdf import _report


@pytest.fixture
def short_page():
    return "<p>theta_i ≤ 75°</p>\n"


def test_a_link_is_followed_and_the_mode_of_the_file_is_kept(short_page, tmp_path):
    target, link = tmp_path / "target.html", tmp_path / "link.html"
    target.write_text("earlier")
    target.chmod(0o640)
    link.symlink_to("target.html")
    _report.write(link, short_page)
    assert link.is_symlink() and target.read_text() == short_page
    assert stat.S_IMODE(target.stat().st_mode) == 0o640


def test_pipes_and_devices_are_written_into_and_not_replaced(short_page, tmp_path):
    pipe, null = tmp_path / "pipe", tmp_path / "null"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    _report.write(pipe, short_page)
    assert os.read(reader, 1000).decode() == short_page
    os.close(reader)
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    null.symlink_to("/dev/null")
    _report.write(null, short_page)
    assert null.is_symlink()


def test_the_error_of_a_full_device_names_the_path_that_was_given(short_page, tmp_path):
    full = tmp_path / "full.html"
    full.symlink_to("/dev/full")
    with pytest.raises(OSError, match=f"^{re.escape(str(full))}: cannot be written: No space left on device$"):
        _report.write(full, short_page)
