# SPDX-License-Identifier: BSD-3-Clause
"""Models as objects: files, copies, views, and what is wrong with files."""

import copy
import json
import pickle

import numpy as np
import pytest

import mmbrdf


def test_built_in_models_are_there_by_name():
    assert mmbrdf.materials() == ["ptfe", "ptfe-351", "ptfe-532", "ptfe-633", "ptfe-1064"]
    with pytest.raises(ValueError, match="ptfe-532"):
        mmbrdf.material("teflon")


def test_a_person_can_read_what_a_model_is(ptfe):
    assert repr(ptfe) == "<mmbrdf.Model 'ptfe': isotropic, orders (7, 4), 284 coefficients, 351 to 1064 nm>"
    assert ptfe.orders == (7, 4) and ptfe.powers == 1 and ptfe.family == "isotropic" and ptfe.mapping == "lambert"
    assert ptfe.wavelengths_nm == (351, 532, 633, 1064)
    assert ptfe.theta_i_max_deg == pytest.approx(75) and ptfe.has_covariance
    assert set(ptfe.reflectance) == {351, 532, 633, 1064}
    assert "Germer" in ptfe.provenance["attribution"]


def test_blocks_show_the_coefficients_without_a_copy(ptfe, samples):
    assert sum(block.coefficients.size for block in ptfe.blocks) == ptfe.coefficient_count
    block = ptfe.blocks[0]
    assert block.name == "11" and block.coefficients.shape == (2, 40) and len(block.modes) == 40
    assert block.covariance is None and mmbrdf.fit(samples, uncertainty="noise").model.blocks[0].covariance.shape == (
        40,
        40,
    )
    assert np.shares_memory(block.coefficients, ptfe.blocks[0].coefficients)
    with pytest.raises(ValueError, match="read-only"):
        block.coefficients[0, 0] = 1


def test_blocks_outlive_the_model():
    coefficients = mmbrdf.material("ptfe-532").blocks[0].coefficients
    assert np.isfinite(coefficients).all()


def test_a_saved_model_is_the_same(ptfe, tmp_path):
    ptfe.save(tmp_path / "model.json")
    for same in (mmbrdf.load(tmp_path / "model.json"), mmbrdf.load(str(tmp_path / "model.json")),
                 mmbrdf.Model.from_json(ptfe.to_json()), pickle.loads(pickle.dumps(ptfe)), copy.deepcopy(ptfe), copy.copy(ptfe)):  # fmt: skip
        assert same == ptfe
        np.testing.assert_array_equal(same.evaluate(532, 45, 0, 30, 180), ptfe.evaluate(532, 45, 0, 30, 180))
    assert ptfe != mmbrdf.material("ptfe-532") and ptfe != "ptfe"


def test_published_coefficients_are_a_model(ptfe, tmp_path):
    published = mmbrdf.in_published_form(mmbrdf.material("ptfe-532"))
    published.save(tmp_path / "coefficients.csv")
    back = mmbrdf.load(tmp_path / "coefficients.csv")
    assert isinstance(back, mmbrdf.Model) and back.family == "germer2017" and back.name == "coefficients"
    np.testing.assert_allclose(
        back.evaluate(532, 45, 30, 30, 80), published.evaluate(532, 45, 30, 30, 80), rtol=0, atol=1e-15
    )


def test_samples_are_a_dataset(samples, tmp_path):
    samples.save(tmp_path / "samples.csv")
    assert isinstance(mmbrdf.load(tmp_path / "samples.csv"), mmbrdf.Dataset)


def test_files_that_cannot_be_read_are_os_errors(ptfe, tmp_path):
    with pytest.raises(FileNotFoundError):
        mmbrdf.load(tmp_path / "nowhere.json")
    with pytest.raises(FileNotFoundError):
        mmbrdf.read_samples(tmp_path / "nowhere.csv")
    with pytest.raises(IsADirectoryError):
        mmbrdf.load_model(tmp_path)
    with pytest.raises(OSError, match="folder/model.json"):
        ptfe.save(tmp_path / "no" / "folder/model.json")


def test_files_that_hold_something_else_are_os_errors_with_the_place(ptfe, tmp_path):
    broken = json.loads(ptfe.to_json())
    broken["blocks"][0]["coefficients"] = "many"
    (tmp_path / "broken.json").write_text(json.dumps(broken))
    with pytest.raises(OSError, match=r"broken\.json: .*coefficients"):
        mmbrdf.load(tmp_path / "broken.json")
    (tmp_path / "broken.csv").write_text(
        "wavelength_nm,theta_i_deg,phi_i_deg,theta_r_deg,phi_r_deg,f11\n532,x,0,0,0,1\n"
    )
    with pytest.raises(OSError, match=r"broken\.csv:"):
        mmbrdf.load(tmp_path / "broken.csv")
    (tmp_path / "empty").write_text("")
    with pytest.raises(OSError, match="empty"):
        mmbrdf.load(tmp_path / "empty")
    with pytest.raises(OSError):
        mmbrdf.Model.from_json("{}")


def test_a_projection_on_the_isotropic_basis_is_near(published):
    model = mmbrdf.load(published / "PTFE.532.coeff.csv")
    nearest = mmbrdf.projected_on_isotropic(model, (7, 4))
    assert nearest.family == "isotropic"
    f = [m.evaluate(532, 45, 0, [0, 30, 60], 180) for m in (model, nearest)]
    assert np.abs(f[0] - f[1]).max() < 0.01


def test_coefficients_of_blocks_are_those_of_the_file_power_by_power(tmp_path):
    model = mmbrdf.material("ptfe")
    model.save(tmp_path / "m.json")
    for block, saved in zip(model.blocks, json.loads((tmp_path / "m.json").read_text())["blocks"]):
        expected = np.reshape(saved["coefficients"], (model.powers + 1, len(saved["modes"])))
        np.testing.assert_array_equal(block.coefficients, expected)
