# SPDX-License-Identifier: BSD-3-Clause
"""Tables as other programs write them, and what samples betray of themselves."""
import numpy as np
import pytest

import mmbrdf


@pytest.fixture(scope="module")
def data():
    return mmbrdf.simulate(mmbrdf.material("ptfe-532"), 532, mmbrdf.random_geometries(300, 1), speckle=0.006, seed=1)


def table(data):
    g = data.geometry
    return np.column_stack(
        [data.wavelength_nm, np.radians(g.theta_i_deg), g.phi_i_deg, g.theta_r_deg, g.phi_r_deg, np.pi * data.f11]
    )


def test_of_numpy_are_read_and_say_how(data, tmp_path):
    header = "wavelength_nm,theta_i_rad,phi_i_deg,theta_r_deg,phi_r_deg,brf"
    np.savetxt(tmp_path / "t.csv", table(data), delimiter=",", header=header)
    read = mmbrdf.read_samples(tmp_path / "t.csv")
    assert read.read_as == "names in a comment, f11 = brf / pi"
    assert np.allclose(read.f11, data.f11, rtol=1e-14)
    assert np.isnan(read.normalized[0, 1, 1])


def test_with_other_names_are_read_with_them(data, tmp_path):
    np.savetxt(tmp_path / "t.txt", table(data)[:3], header="nm AOI phi_i_deg theta_r_deg phi_r_deg BRF")
    with pytest.raises(OSError, match="columns wavelength_nm=NAME"):
        mmbrdf.read_samples(tmp_path / "t.txt")
    names = {"wavelength_nm": "nm", "theta_i_rad": "AOI"}
    read = mmbrdf.read_samples(tmp_path / "t.txt", columns=names)
    assert np.allclose(read.theta_i_deg, data.theta_i_deg[:3])
    with pytest.raises(ValueError, match="^convention 'other' is not one of germer2017, "):
        mmbrdf.read_samples(tmp_path / "t.txt", columns=names, convention="other")


def test_with_missing_values_are_refused_or_passed_over(tmp_path):
    rows = "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,f11\n532,0,0,10,0,NA\n532,0,0,20,0,0.3\n"
    (tmp_path / "t.csv").write_text(rows)
    with pytest.raises(OSError, match="t.csv:2: f11: 'NA': no value"):
        mmbrdf.read_samples(tmp_path / "t.csv")
    read = mmbrdf.read_samples(tmp_path / "t.csv", skip_incomplete=True)
    assert len(read) == 1 and read.read_as == "1 incomplete row passed over"


def test_betray_what_is_wrong_with_them(data):
    assert mmbrdf.inspect(data).findings == ()
    seen = mmbrdf.inspect(mmbrdf.Dataset(532, *data.geometry, np.pi * data.mueller))
    assert [one.fault for one in seen.findings] == ["scale of f11"]
    assert "multiplied by pi" in seen.findings[0].evidence
    assert 0 < seen.f11_residual < 0.05 and 0 <= seen.unsupported < 1
    with pytest.raises(ValueError, match="there are no samples"):
        mmbrdf.inspect(data[:0])
