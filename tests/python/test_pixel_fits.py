# SPDX-License-Identifier: BSD-3-Clause
"""A BRDF in each pixel: as if each had been fitted alone."""

import copy
import os
import pickle
import threading

import numpy as np
import pytest

import mmbrdf
from mmbrdf import images

PIXELS = (3, 20)  # more than stand side by side, and not a multiple of that


@pytest.fixture(scope="module")
def grid():
    return mmbrdf.germer2017_grid()


@pytest.fixture(scope="module")
def values(ptfe, grid):
    """Of ptfe, brighter from pixel to pixel, with noise."""
    random = np.random.default_rng(1)
    exact = ptfe.evaluate(532, *grid)
    bright = np.linspace(0.5, 1.5, 60).reshape(*PIXELS, 1, 1, 1)
    return bright * exact + 0.002 * random.normal(size=(*PIXELS, *exact.shape))


@pytest.fixture(scope="module")
def prepared(grid):
    return images.PixelFit(532, grid)


@pytest.fixture(scope="module")
def models(prepared, values):
    return prepared.fit(values)


def alone(grid, values, **options):
    return mmbrdf.fit(mmbrdf.Dataset(532, *grid, values), uncertainty="noise", weights="none", **options)


def coefficients(model):
    return np.concatenate([block.coefficients.ravel() for block in model.blocks])


@pytest.mark.parametrize("pixel", [(0, 0), (1, 7), (2, 19)])
def test_a_pixel_has_the_coefficients_and_covariances_of_its_own_fit(grid, values, prepared, models, pixel):
    own = alone(grid, values[pixel])
    expected = coefficients(own.model)
    assert prepared.coefficients == len(expected) == 142
    assert np.abs(models.coefficients[pixel] - expected).max() < 1e-12 * np.abs(expected).max()
    for one, other in zip(models[pixel].blocks, own.model.blocks, strict=True):
        scale = np.sqrt(np.diag(other.covariance))
        off = (one.covariance - other.covariance) / np.outer(scale, scale)
        assert one.name == other.name
        assert np.abs(off).max() < 1e-8  # a difference of squares: rounding x samples x (f11 / noise)^2
    where = (45, 0, [0.0, 30.0], 180)
    np.testing.assert_allclose(
        models.evaluate(*where, pixel=pixel), own.model.evaluate(532, *where), rtol=0, atol=1e-12
    )
    np.testing.assert_allclose(
        models.evaluate_uncertainty(*where, pixel=pixel), own.model.evaluate_uncertainty(532, *where), rtol=1e-8
    )


def test_neighbours_and_threads_do_not_count(prepared, values, models):
    np.testing.assert_array_equal(prepared.fit(values[1, 7]).coefficients, models.coefficients[1, 7])
    np.testing.assert_array_equal(prepared.fit(values, threads=3).coefficients, models.coefficients)
    np.testing.assert_array_equal(prepared.fit(values[:, 3:]).variances, models.variances[:, 3:])


def test_single_precision_goes_in_as_the_numbers_it_has(prepared, values):
    single = values.astype(np.float32)
    np.testing.assert_array_equal(prepared.fit(single).coefficients, prepared.fit(single.astype(float)).coefficients)


def test_f11_alone_is_a_model_that_does_not_know_the_others(grid, values, models):
    only = images.PixelFit(532, grid, f11_only=True).fit(values[..., 0, 0])
    assert only.coefficients.shape[-1] == dict(models._fit.blocks)[models._fit.blocks[0][0]]
    np.testing.assert_allclose(
        only.coefficients, models.coefficients[..., : only.coefficients.shape[-1]], rtol=0, atol=1e-13
    )
    assert "22" in only[0, 0].not_measured
    assert np.isnan(only.evaluate(45, 0, 30, 180, pixel=(0, 0))[1, 1])


def test_weights_are_those_of_a_fit(grid, values):
    weights = np.broadcast_to(np.cos(np.radians(grid.theta_r_deg))[:, None, None], (1824, 4, 4))
    weighted = images.PixelFit(532, grid, weights=weights).fit(values[0, :2])
    plain = images.PixelFit(532, grid).fit(values[0, :2])
    assert np.abs(weighted.coefficients - plain.coefficients).max() > 1e-6
    again = images.PixelFit(532, grid, weights=2 * weights).fit(values[0, :2])
    np.testing.assert_allclose(again.coefficients, weighted.coefficients, rtol=0, atol=1e-13)
    np.testing.assert_allclose(again.variances, 2 * weighted.variances, rtol=1e-9)


def test_missing_readings_are_fitted_by_their_pattern(grid, values, prepared, models):
    holes = values[0].copy()
    few, many = np.arange(0, 1824, 7), np.arange(1824)
    holes[3, few] = holes[8, few] = np.nan
    holes[5, few[:50], 2, 1] = np.nan  # one element stands for its matrix
    holes[6, many[:1800]] = np.nan  # too few are left
    found = prepared.fit(holes)
    good = [k for k in range(20) if k not in (3, 5, 6, 8)]
    np.testing.assert_array_equal(found.coefficients[good], models.coefficients[0, good])
    kept = np.delete(many, few)
    expected = coefficients(alone(mmbrdf.Geometry(*(angle[kept] for angle in grid)), holes[8, kept]).model)
    assert np.abs(found.coefficients[8] - expected).max() < 1e-12 * np.abs(expected).max()
    assert np.isfinite(found.coefficients[5]).all() and np.isnan(found.coefficients[6]).all()
    with pytest.raises(ValueError, match=r"pixel \(6,\) has no fit"):
        found[6]


@pytest.mark.parametrize("f11_only", [False, True])
def test_what_is_left_of_a_pixel_keeps_its_weights(ptfe, f11_only):
    where, random = mmbrdf.random_geometries(60, seed=3), np.random.default_rng(1)
    values = ptfe.evaluate(532, *where) + 0.01 * random.normal(size=(60, 4, 4))
    weights = random.uniform(0.1, 1, (60, 4, 4))
    values = values[:, 0, 0] if f11_only else values
    options = {"orders": (3, 2), "f11_only": f11_only}
    holes = values.copy()
    holes[::7] = np.nan
    found = images.PixelFit(532, where, weights=weights, **options).fit(holes)
    kept = np.arange(60) % 7 != 0
    expected = images.PixelFit(532, [angle[kept] for angle in where], weights=weights[kept], **options).fit(
        values[kept]
    )
    np.testing.assert_allclose(found.coefficients, expected.coefficients, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found.variances, expected.variances, rtol=1e-9)  # a difference of squares


def test_without_degrees_of_freedom_a_covariance_is_not_known(ptfe):
    where = mmbrdf.random_geometries(8, seed=3)  # as many as f11 has coefficients
    values = ptfe.evaluate(532, *where)
    found = images.PixelFit(532, where, orders=(3, 2)).fit(values)
    own = alone(where, values, orders=(3, 2)).model
    assert np.isfinite(found.coefficients).all() and found._fit.blocks[0] == ("11", 8)
    assert np.isnan(found.variances[0]) and (found.variances[1:] > 0).all()
    for model in (own, found[()]):
        assert model.blocks[0].covariance is None and model.blocks[1].covariance is not None
        with pytest.raises(ValueError, match="the covariance of block 11 is not known"):
            model.evaluate_uncertainty(532, 30, 0, 20, 50)


@pytest.mark.parametrize("weighted", [False, True])
def test_fits_and_their_models_can_be_sent(ptfe, weighted):
    where = mmbrdf.random_geometries(60, seed=3)
    weights = np.random.default_rng(1).uniform(0.5, 1, (60, 4, 4)) if weighted else None
    fit = images.PixelFit(532, where, orders=(3, 2), mapping="projected", weights=weights)
    values = ptfe.evaluate(532, *where) * np.linspace(1, 2, 5)[:, None, None, None]
    models = fit.fit(values)
    for own, found in [
        (pickle.loads(pickle.dumps(fit)), pickle.loads(pickle.dumps(models))),
        (copy.copy(fit), copy.deepcopy(models)),
    ]:
        again = own.fit(values)
        for one in (again, found):
            np.testing.assert_array_equal(one.coefficients, models.coefficients)
            np.testing.assert_array_equal(one.variances, models.variances)
            assert one[3].to_json() == models[3].to_json()
        assert own.blocks == fit.blocks and own.wavelength_nm == fit.wavelength_nm


def test_models_of_many_pixels_are_one_file(models, tmp_path):
    pytest.importorskip("xarray")
    pytest.importorskip("netCDF4")
    models.save(tmp_path / "models.nc")
    again = images.load_models(tmp_path / "models.nc")
    np.testing.assert_array_equal(again.coefficients, models.coefficients)
    np.testing.assert_array_equal(again.variances, models.variances)
    where = (45, 0, 30, 180)
    np.testing.assert_array_equal(again.evaluate(*where, pixel=(2, 3)), models.evaluate(*where, pixel=(2, 3)))
    assert [path.name for path in tmp_path.iterdir()] == ["models.nc"]


def test_threads_that_save_at_once_do_not_disturb_each_other(models, tmp_path):
    pytest.importorskip("xarray")
    pytest.importorskip("netCDF4")
    together, failed = threading.Barrier(4), []

    def save():
        together.wait()
        try:
            for _ in range(3):
                models.save(tmp_path / "models.nc")
        except Exception as error:  # what a library says of a file that is gone
            failed.append(error)

    threads = [threading.Thread(target=save) for _ in range(4)]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert failed == [] and [path.name for path in tmp_path.iterdir()] == ["models.nc"]
    np.testing.assert_array_equal(images.load_models(tmp_path / "models.nc").coefficients, models.coefficients)


def test_models_are_saved_through_links_and_keep_the_mode_of_the_file(models, tmp_path):
    pytest.importorskip("xarray")
    pytest.importorskip("netCDF4")
    target, link = tmp_path / "target.nc", tmp_path / "link.nc"
    target.write_text("earlier")
    target.chmod(0o640)
    link.symlink_to("target.nc")
    models.save(link)
    assert link.is_symlink() and target.stat().st_mode & 0o777 == 0o640
    np.testing.assert_array_equal(images.load_models(target).coefficients, models.coefficients)
    with pytest.raises(FileNotFoundError) as missing:
        models.save(tmp_path / "no" / "models.nc")
    assert missing.value.filename == os.fspath(tmp_path / "no" / "models.nc")
    with pytest.raises(OSError, match="not a file that can be replaced"):
        models.save(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link.nc", "target.nc"]


def test_masked_readings_are_missing_and_masked_geometries_are_refused(grid, prepared, values):
    hidden = np.ma.masked_array(values[0, :3], np.zeros(values[0, :3].shape, bool))
    hidden[1, 7] = np.ma.masked
    missing = values[0, :3].copy()
    missing[1, 7] = np.nan
    np.testing.assert_array_equal(prepared.fit(hidden).coefficients, prepared.fit(missing).coefficients)
    angles = np.ma.masked_array(grid.theta_r_deg, np.arange(len(grid.theta_r_deg)) == 5)
    for call, name in (
        (lambda: images.PixelFit(532, (*grid[:2], angles, grid[3])), "theta_r_deg"),
        (lambda: prepared.require_geometry((*grid[:2], angles, grid[3])), "theta_r_deg"),
        (lambda: images.PixelFit(532, grid, weights=np.ma.masked_less(np.zeros((len(grid[0]), 4, 4)), 1)), "weights"),
    ):
        with pytest.raises(ValueError, match=f"^{name}: a part of it is masked; leave it out$"):
            call()


def test_no_pixels_are_no_models(prepared, values):
    for some, shape in ((values[:0], (0, 20)), (values[:, :0], (3, 0)), (values[0, :0], (0,))):
        none = prepared.fit(some)
        assert none.shape == shape and none.coefficients.shape == (*shape, 142)
        assert none.variances.shape == (*shape, len(prepared.blocks))


@pytest.mark.parametrize("orders", [(2,), (2, 1, 0), 3, (2.5, 1), "74"], ids=str)
def test_orders_are_two_whole_numbers(grid, orders):
    with pytest.raises(ValueError, match=r"^orders = .*, expected two whole numbers: of f11, and of the others$"):
        images.PixelFit(532, grid, orders=orders)


def test_what_does_not_fit_is_named(grid, values, prepared):
    with pytest.raises(ValueError, match=r"values: shape \(3, 20, 1823, 4, 4\), expected \(\.\.\., 1824, 4, 4\)"):
        prepared.fit(values[:, :, 1:])
    other = [angle.copy() for angle in grid]
    other[2][17] += 0.5
    with pytest.raises(ValueError, match="geometry: theta_r_deg of geometry 17 is "):
        prepared.fit(values, geometry=other)
    with pytest.raises(ValueError, match="germer2017 turns samples"):
        images.PixelFit(532, grid, "germer2017")
    with pytest.raises(ValueError, match="expected theta_i_deg, phi_i_deg"):
        images.PixelFit(532, grid[:3])
    with pytest.raises(ValueError, match=r"weights: shape \(1824,\), expected \(1824, 4, 4\)"):
        images.PixelFit(532, grid, weights=np.ones(1824))
