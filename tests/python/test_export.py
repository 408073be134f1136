# SPDX-License-Identifier: BSD-3-Clause
"""Models as tables of other programs."""
import numpy as np
import pytest

import mmbrdf


def test_a_table_is_read_back_as_the_model(tmp_path):
    model = mmbrdf.material("ptfe")
    path = tmp_path / "plaque.astm"
    written = model.export(path, wavelength_nm=[450, 532], channel="f_ss", error=0.01)
    assert written.startswith("f_ss in sr^-1 at 450 and 532 nm, polar angles of 0 to 90")
    data = mmbrdf.read_foreign(path)
    m = model.evaluate(data.wavelength_nm, *data.geometry, frame="sp")
    np.testing.assert_allclose(data.f11, mmbrdf.f_ss(m), rtol=1e-7)


def test_mitsuba_s_table_has_its_four_by_four_matrices(tmp_path):
    path = tmp_path / "plaque.bin"
    written = mmbrdf.material("ptfe-532").export(path, "pbsdf", error=0.01)
    assert "37 phi_d, 19 theta_d, 19 theta_h at 532 nm" in written
    m = np.memmap(path, np.float32, mode="r", offset=path.stat().st_size - 37 * 19 * 19 * 16 * 4)
    assert np.isfinite(m).all()


def test_what_a_format_cannot_hold_is_refused_and_nothing_written(tmp_path):
    model = mmbrdf.material("ptfe")
    with pytest.raises(ValueError, match="6 wavelengths: Mitsuba reads at most 5"):
        model.export(tmp_path / "x.pbsdf", wavelength_nm=[400, 450, 500, 550, 600, 650])
    with pytest.raises(ValueError, match="no format has this ending; there are pbsdf"):
        model.export(tmp_path / "x.txt")
    with pytest.raises(ValueError, match="no such format"):
        model.export(tmp_path / "x.txt", "oxygen")
    assert not list(tmp_path.iterdir())
