# SPDX-License-Identifier: BSD-3-Clause
"""Geometries and matrices that the program reads and writes as arrays of numpy."""

import os
import subprocess

import numpy as np
import pytest

COLUMNS = ["wavelength_nm", "theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg"]


def geometries(count):
    """Some at one wavelength, some at another, negative polar angles among them."""
    generator = np.random.default_rng(1)
    rows = generator.uniform(-80, 80, (count, 5))
    rows[:, 0] = np.where(np.arange(count) % 700 < 500, 532, 633)
    return rows


def write_csv(path, rows):
    np.savetxt(path, rows, "%.17g", delimiter=",", header=",".join(COLUMNS), comments="")


def matrices(path):
    return np.loadtxt(path, delimiter=",", skiprows=1, usecols=range(5, 21), ndmin=2).reshape(-1, 4, 4)


@pytest.mark.parametrize("count", [0, 1, 4095, 4096, 4097, 20000])
def test_binary_rows_are_the_numbers_of_the_text_whatever_the_threads(program, tmp_path, count):
    rows = geometries(count)
    np.save(tmp_path / "rows.npy", rows)
    write_csv(tmp_path / "rows.csv", rows)
    program("evaluate", "ptfe", "-g", "rows.csv", "-o", "out.csv", "--threads", 1)
    expected = matrices(tmp_path / "out.csv") if count > 0 else np.empty((0, 4, 4))
    for given in ["rows.csv", "rows.npy"]:
        for threads in [0, 1, 2, 5]:
            program("evaluate", "ptfe", "-g", given, "-o", "out.npy", "--threads", threads)
            found = np.load(tmp_path / "out.npy", mmap_mode="r" if count else None)
            assert found.shape == (count, 4, 4) and found.dtype == np.float64 and found.flags.c_contiguous
            np.testing.assert_array_equal(found, expected)


def test_text_is_the_same_whatever_the_threads(program, tmp_path):
    write_csv(tmp_path / "rows.csv", geometries(20000))
    program("evaluate", "ptfe", "-g", "rows.csv", "-o", "one.csv", "--threads", 1)
    for threads in [0, 2, 3, 16]:
        program("evaluate", "ptfe", "-g", "rows.csv", "-o", "more.csv", "--threads", threads)
        assert (tmp_path / "more.csv").read_bytes() == (tmp_path / "one.csv").read_bytes()


def test_rows_of_an_array_are_written_as_text_too(program, tmp_path):
    rows = geometries(3)
    np.save(tmp_path / "rows.npy", rows)
    write_csv(tmp_path / "rows.csv", rows)
    from_array = program("evaluate", "ptfe", "-g", "rows.npy").splitlines()
    from_text = program("evaluate", "ptfe", "-g", "rows.csv").splitlines()
    assert from_array[0] == from_text[0]
    for a, b in zip(from_array[1:], from_text[1:]):
        assert a.split(",")[5:] == b.split(",")[5:]
        assert [float(x) for x in a.split(",")[:5]] == [float(x) for x in b.split(",")[:5]]


@pytest.mark.parametrize("version", [(2, 0), (3, 0)])
def test_files_of_later_formats_hold_the_same_rows(program, tmp_path, version):
    rows = geometries(10)
    np.save(tmp_path / "first.npy", rows)
    with open(tmp_path / "later.npy", "wb") as file:
        np.lib.format.write_array(file, rows, version)
    program("evaluate", "ptfe", "-g", "first.npy", "-o", "expected.npy")
    program("evaluate", "ptfe", "-g", "later.npy", "-o", "found.npy")
    np.testing.assert_array_equal(np.load(tmp_path / "found.npy"), np.load(tmp_path / "expected.npy"))


def test_normalized_arrays_keep_f11_beside_the_divided_elements(program, tmp_path):
    np.save(tmp_path / "rows.npy", geometries(10))
    program("evaluate", "ptfe", "-g", "rows.npy", "-o", "f.npy", "--frame", "sp")
    program("evaluate", "ptfe", "-g", "rows.npy", "-o", "m.npy", "--frame", "sp", "--normalized")
    f, m = np.load(tmp_path / "f.npy"), np.load(tmp_path / "m.npy")
    expected = f / f[:, :1, :1]
    expected[:, 0, 0] = f[:, 0, 0]
    np.testing.assert_allclose(m, expected, rtol=1e-15, atol=1e-15)


def bad_arrays():
    rows = geometries(5)
    steep, behind, endless = rows.copy(), rows.copy(), rows.copy()
    steep[3, 3], behind[0, 0], endless[4, 2] = 91, -532, np.nan
    return {
        "float32": (rows.astype("<f4"), "numbers of type '<f4', expected '<f8'"),
        "big_endian": (rows.astype(">f8"), "numbers of type '>f8', expected '<f8'"),
        "integers": (np.zeros((3, 5), int), "numbers of type '<i8', expected '<f8'"),
        "fortran": (np.asfortranarray(rows), "in Fortran order, expected C order"),
        "four_columns": (rows[:, :4].copy(), "shape (5, 4), expected (rows, 5): wavelength_nm, theta_i_deg"),
        "one_dimension": (rows[0], "shape (5), expected (rows, 5)"),
        "steep": (steep, "row 4: theta_r_deg: 91 degrees; a polar angle is at most 90"),
        "behind": (behind, "row 1: wavelength_nm: -532: a wavelength must be positive"),
        "endless": (endless, "row 5: nan is not a finite azimuth"),
    }


def error_of(tmp_path, given):
    """The one line that is printed; nothing is written."""
    (tmp_path / "out.npy").write_text("older\n")
    before = sorted(os.listdir(tmp_path))
    done = subprocess.run(
        [os.environ["MMBRDF_PROGRAM"], "evaluate", "ptfe", "-g", given, "-o", "out.npy"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1 and done.stdout == "" and done.stderr.count("\n") == 1
    assert (tmp_path / "out.npy").read_text() == "older\n" and sorted(os.listdir(tmp_path)) == before
    return done.stderr


@pytest.mark.parametrize("name", bad_arrays())
def test_arrays_of_another_kind_are_refused_by_name(tmp_path, name):
    array, message = bad_arrays()[name]
    np.save(tmp_path / "rows.npy", array)
    assert error_of(tmp_path, "rows.npy").startswith(f"mmbrdf: rows.npy: {message}")


def test_the_first_wrong_row_is_named_also_before_one_that_cannot_be_read_or_is_not_there(tmp_path):
    rows = geometries(5000)
    rows[4500, 0] = 2e9  # read, but not evaluated
    rows[4600, 3] = 95  # not read
    np.save(tmp_path / "rows.npy", rows)
    message = "mmbrdf: rows.npy: row 4501: wavelength 2e+09 nm is more than a metre\n"
    assert error_of(tmp_path, "rows.npy") == message
    whole = (tmp_path / "rows.npy").read_bytes()
    (tmp_path / "rows.npy").write_bytes(whole[:-1])
    assert error_of(tmp_path, "rows.npy") == message


def test_files_that_end_early_or_late_are_refused(tmp_path):
    np.save(tmp_path / "rows.npy", geometries(5000))
    whole = (tmp_path / "rows.npy").read_bytes()
    for content, message in [
        (whole[:-1], "ends after 4999 of 5000 rows"),
        (whole + b"\0", "goes on behind its 5000 rows"),
        (whole[:100], "ends within the header of a .npy file"),
        (whole[:9], "ends within the header of a .npy file"),
        (b"", "does not begin as a .npy file does"),
        (b"wavelength_nm,theta_i_deg", "does not begin as a .npy file does"),
        (whole[:6] + b"\x09" + whole[7:], ".npy format 9, known are 1 to 3"),
        (whole.replace(b"shape", b"sharp"), "no 'shape' in the header of the .npy file"),
    ]:
        (tmp_path / "rows.npy").write_bytes(content)
        assert error_of(tmp_path, "rows.npy") == f"mmbrdf: rows.npy: {message}\n"
