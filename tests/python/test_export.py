# SPDX-License-Identifier: BSD-3-Clause
"""Models as tables of other programs."""
import json

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


@pytest.mark.parametrize("name, wavelength_told", [("zemax", 532), ("rgl", None)])
def test_optical_design_and_renderers_read_the_model_back(tmp_path, name, wavelength_told):
    model = mmbrdf.material("ptfe-532")
    path = tmp_path / "plaque.bsdf"
    assert "interpolation adds" in model.export(path, name, error=0.01)
    data = mmbrdf.read_foreign(path, wavelength_nm=wavelength_told)
    np.testing.assert_allclose(data.f11, model.evaluate(532, *data.geometry)[:, 0, 0], rtol=1e-6, atol=1e-5)


def test_metrology_reads_matrices_with_uncertainties(tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    model = mmbrdf.material("ptfe-532")
    path = tmp_path / "plaque.brdf"
    written = model.export(path)
    assert written.startswith("2286 geometries at 532 nm, values in sr^-1 between 37 pairs of states")
    file = json.loads(path.read_text())
    assert file["metadata"]["timestamp"] == "1970-01-01T00:00:00+00:00"
    columns = {name: np.array(column["values"]) for name, column in file["data"].items()}
    unpolarized = (columns["polarization_i"] == [1, 0, 0, 0]).all(axis=1)
    geometry = [columns[name][unpolarized] for name in ["theta_i", "phi_i", "theta_r", "phi_r"]]
    u = model.evaluate_uncertainty(532, *geometry)[:, 0, 0]
    np.testing.assert_allclose(columns["uBRDF"][unpolarized], u, rtol=1e-3)
    data = mmbrdf.read_foreign(path)
    matrices = data.f11[:, None, None] * data.normalized
    np.testing.assert_allclose(matrices, model.evaluate(532, *data.geometry), atol=1e-7)


def test_daylight_simulation_has_means_over_patches(tmp_path):
    path = tmp_path / "plaque.xml"
    assert "the width of the patches adds" in mmbrdf.material("ptfe-532").export(path)
    numbers = path.read_text().split("<ScatteringData>")[1].split("</ScatteringData>")[0].split()
    table = np.array(numbers, float).reshape(145, 145)
    np.testing.assert_allclose(table, table.T, rtol=1e-6)  # f11 is reciprocal


def test_what_a_format_cannot_hold_is_refused_and_nothing_written(tmp_path):
    model = mmbrdf.material("ptfe")
    with pytest.raises(ValueError, match="6 wavelengths: Mitsuba reads at most 5"):
        model.export(tmp_path / "x.pbsdf", wavelength_nm=[400, 450, 500, 550, 600, 650])
    with pytest.raises(ValueError, match="no format has this ending; there are pbsdf"):
        model.export(tmp_path / "x.txt")
    with pytest.raises(ValueError, match="zemax and rgl have this ending"):
        model.export(tmp_path / "x.bsdf")
    with pytest.raises(ValueError, match="a Klems XML file has one wavelength"):
        model.export(tmp_path / "x.xml")
    with pytest.raises(ValueError, match="no such format"):
        model.export(tmp_path / "x.txt", "oxygen")
    assert not list(tmp_path.iterdir())


def scaled(model, factor):
    """f11 times a factor."""
    text = json.loads(model.to_json())
    text.pop("posterior", None)
    for block in text["blocks"]:
        block.pop("covariance", None)
        if "11" in block["elements"]:
            block["coefficients"] = (factor * np.array(block["coefficients"])).tolist()
    return text


def test_a_black_model_has_tables_without_errors_and_one_fitted_at_the_normal_too(tmp_path):
    black = mmbrdf.Model.from_json(json.dumps(scaled(mmbrdf.material("ptfe-532"), 0)))
    written = black.export(tmp_path / "black.astm")
    assert "adds 0 % of f11 (rms; at most 0 %) up to 75 degrees" in written
    text = scaled(mmbrdf.material("ptfe-532"), 1)
    for fitted, compared in [(0, 30), (3, 3)]:
        text["validity"]["theta_i_max_deg"] = fitted
        of_few = mmbrdf.Model.from_json(json.dumps(text))
        assert f"up to {compared} degrees" in of_few.export(tmp_path / "normal.astm")
