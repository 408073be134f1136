# SPDX-License-Identifier: BSD-3-Clause
"""Imaging polarimeters: a simulated one, whose states vary over the image, is the truth."""

import pickle

import numpy as np
import pytest

import mmbrdf
from mmbrdf import images

SHAPE = (6, 8)
DIALS = mmbrdf.dial_angles(5, 6.0, 61)


def relative(matrices, truth):
    return np.abs(matrices - truth).max(axis=(-2, -1)) / truth[..., 0, 0]


@pytest.mark.parametrize("dials", [None, DIALS], ids=["grid", "retarders"])
def test_matrices_come_back_from_the_instrument_of_each_pixel(dials):
    camera = images.simulate(SHAPE, dials_deg=dials, noise=0, seed=2)
    matrices = images.reduce(camera.stack, camera.instrument)
    assert matrices.dtype == np.float32 and matrices.shape == (*SHAPE, 4, 4)
    assert relative(matrices, camera.mueller).max() < 1e-5  # of single precision: 24 bits, condition 3 and 13
    one = camera.instrument.at(3, 4)
    frames = camera.stack[3, 4].astype(float)
    alone = one.reduce(frames.reshape(4, 4) if dials is None else frames)
    np.testing.assert_allclose(matrices[3, 4], alone, rtol=0, atol=1e-5 * alone[0, 0])


def test_one_instrument_for_all_pixels_has_the_bits_of_its_own_reduction(camera):
    instrument = camera.instrument.at(0, 0)
    expected = instrument.reduce(camera.stack.reshape(*SHAPE, 4, 4))
    np.testing.assert_array_equal(images.reduce(camera.stack, instrument), expected)
    np.testing.assert_array_equal(images.reduce(camera.stack, instrument, dark=0.0, progress=iter), expected)
    assert images.reduce(camera.stack.astype(float), instrument).dtype == float
    assert images.reduce((1000 * camera.stack).astype(np.uint16), instrument).dtype == np.float32


def test_dark_frames_saturation_and_masks(camera):
    instrument = camera.instrument
    matrices = images.reduce(camera.stack, instrument)
    dark = np.linspace(10, 11, SHAPE[1], dtype=np.float32) * np.ones((SHAPE[0], 1), np.float32)
    raw = camera.stack + dark[..., None]
    mask = np.ones(SHAPE, bool)
    mask[0, 1] = False
    raw[2, 3, 5] = 4095
    raw[5, 6, 7] = 4000  # at the limit
    reduced = images.reduce(raw, instrument, dark=dark, mask=mask, saturation=4000)
    bad = np.isnan(reduced).all(axis=(-2, -1))
    assert np.argwhere(bad).tolist() == [[0, 1], [2, 3], [5, 6]] and np.isnan(reduced).sum() == 48
    assert relative(reduced, matrices)[~bad].max() < 1e-4  # a dark signal ten times the readings takes digits
    raw[4, 4, 0] = np.inf
    assert np.isnan(images.reduce(raw, instrument)[4, 4]).all()


def masked(array, *places):
    """With these places masked, whatever stands beneath."""
    result = np.ma.masked_array(array, np.zeros(np.shape(array), bool))
    for place in places:
        result[place] = np.ma.masked
    return result


@pytest.mark.parametrize("of_each_pixel", [False, True])
def test_what_is_masked_is_unknown_and_never_the_number_beneath(camera, of_each_pixel):
    instrument = camera.instrument if of_each_pixel else camera.instrument.at(0, 0)
    stack = masked(camera.stack, (2, 3, 5), (0, 1))
    unknown = np.zeros(SHAPE, bool)
    unknown[2, 3] = unknown[0, 1] = True
    expected = np.where(unknown[..., None, None], np.nan, images.reduce(camera.stack, instrument))
    np.testing.assert_array_equal(images.reduce(stack, instrument), expected)
    np.testing.assert_array_equal(images.reduce(stack, instrument, progress=iter, saturation=99.0), expected)
    raw = masked((1000 * camera.stack).astype(np.uint16), (2, 3, 5), (0, 1))
    found = images.reduce(raw, instrument)
    assert found.dtype == np.float32 and (np.isnan(found).all(axis=(-2, -1)) == unknown).all()
    dark = masked(np.zeros(SHAPE), (2, 3), (0, 1))
    assert (np.isnan(images.reduce(camera.stack, instrument, dark=dark)).all(axis=(-2, -1)) == unknown).all()
    use = masked(np.ones(SHAPE, bool), (2, 3), (0, 1))
    assert (np.isnan(images.reduce(camera.stack, instrument, mask=use)).all(axis=(-2, -1)) == unknown).all()
    u = images.uncertainty(stack, instrument, {"shot": 1e-3})
    assert (np.isnan(u).any(axis=(-2, -1)) == unknown).all()
    matrices = masked(camera.mueller, (2, 3))
    if of_each_pixel:
        assert np.argwhere(np.isnan(images.readings(matrices, instrument)).all(axis=-1)).tolist() == [[2, 3]]


def test_masked_chunks_are_unknown_too(camera):
    da = pytest.importorskip("dask.array")
    stack = masked(camera.stack, (2, 3, 5))
    for instrument in (camera.instrument, camera.instrument.at(0, 0)):
        lazy = images.reduce(da.from_array(stack, chunks=(3, 4, -1)), instrument, dark=da.zeros(SHAPE), saturation=99.0)
        np.testing.assert_array_equal(lazy.compute(), images.reduce(stack, instrument, dark=0.0, saturation=99.0))


def test_dark_frames_and_masks_count_alike_in_chunks(camera):
    da = pytest.importorskip("dask.array")
    instrument = camera.instrument.at(0, 0)
    row, dark = camera.stack[0], np.linspace(0.0, 0.01, camera.stack.shape[-1], dtype=np.float32)
    mask = np.arange(len(row)) % 2 == 0
    expected = images.reduce(row, instrument, dark=dark, mask=mask, saturation=99.0)
    assert np.isnan(expected).any()
    for given in (dark, da.from_array(dark, chunks=-1)):
        for lazy_mask in (mask, da.from_array(mask, chunks=2)):
            lazy = images.reduce(
                da.from_array(row, chunks=(3, -1)), instrument, dark=given, mask=lazy_mask, saturation=99.0
            )
            np.testing.assert_array_equal(lazy.compute(), expected)
    square = np.tile(camera.stack.reshape(-1, 16), (2, 1))[:16]  # as many pixels as frames: a mask is no dark frame
    mask = np.arange(16) % 3 == 0
    lazy = images.reduce(da.from_array(square, chunks=(4, -1)), instrument, mask=mask)
    np.testing.assert_array_equal(lazy.compute(), images.reduce(square, instrument, mask=mask))


def test_masked_readings_of_references_are_not_calibrated_with(camera, calibrated):
    stacks = masked(camera.stacks, (3, 1, 2, 0))
    for given in (stacks, list(stacks)):
        found = images.calibrate(camera.references, given, wavelength_nm=532, start=calibrated.start)
        assert np.argwhere(found.failure).tolist() == [[1, 2]] and images.FAILURES[found.failure[1, 2]] == "not finite"
    states = masked(camera.instrument.generator, (1, 2, 0, 0))
    partly = images.PixelInstrument(states, camera.instrument.analyzer)
    assert np.isnan(images.reduce(camera.stack, partly)[1, 2]).all()
    with pytest.raises(ValueError, match="^dials_deg: a part of it is masked; leave it out$"):
        images.simulate(SHAPE, dials_deg=masked(DIALS, (0, 0)))


def test_many_rows_are_worked_on_in_blocks_with_the_same_bits(camera, monkeypatch):
    whole = images.reduce(camera.stack, camera.instrument, dark=0.125)
    monkeypatch.setattr(images.reduction, "_ROWS_AT_ONCE", 2 * SHAPE[1])
    np.testing.assert_array_equal(images.reduce(camera.stack, camera.instrument, dark=0.125), whole)


def test_pixels_are_calibrated_within_their_uncertainties(camera, calibrated):
    assert not calibrated.failure.any()
    assert np.abs(calibrated.misfit.mean() - 1) < 0.05  # 700 degrees of freedom in each of 48 pixels: 0.8 %
    truth = camera.instrument
    # The scale of A to W is a convention: that of the first components of W, which have mean 1.
    scale = truth.generator[..., 0].mean(axis=-1)[..., None, None]
    for found, u, true in (
        (calibrated.generator, calibrated.u_generator, truth.generator / scale),
        (calibrated.analyzer, calibrated.u_analyzer, truth.analyzer * scale),
    ):
        off = (found - true) / u
        assert 0.9 < np.sqrt(np.mean(off**2)) < 1.1
        assert np.abs(off).max() < 5
    matrices = images.reduce(camera.stack, calibrated)
    assert np.sqrt(np.mean(relative(matrices, camera.mueller) ** 2)) < 5e-3  # noise of single frames
    wrong = images.reduce(camera.stack, calibrated.start)
    assert relative(wrong, camera.mueller).max() > 5 * relative(matrices, camera.mueller).max()


def test_a_pixel_is_calibrated_as_it_would_be_alone(camera, calibrated):
    y, x = 2, 5
    alone = images.calibrate(camera.references, camera.stacks[:, y : y + 1, x : x + 1], wavelength_nm=532)
    for name in ("generator", "analyzer", "u_generator", "u_analyzer"):
        # Steps end below a thousandth of the standard uncertainties.
        u = getattr(calibrated, f"u_{name[-9:].lstrip('_')}" if not name.startswith("u_") else name)[y, x]
        assert np.abs((getattr(alone, name)[0, 0] - getattr(calibrated, name)[y, x]) / u).max() < 2e-3
    eager = alone.start.polarimeter  # of the one pixel: what mmbrdf.calibrate() gives of it
    assert np.abs((alone.generator[0, 0] - eager.generator) / alone.u_generator[0, 0]).max() < 2e-3
    assert np.abs((alone.analyzer[0, 0] - eager.analyzer) / alone.u_analyzer[0, 0]).max() < 2e-3
    full = alone.start.covariance
    np.testing.assert_allclose(
        np.concatenate([alone.u_generator[0, 0].ravel(), alone.u_analyzer[0, 0].ravel()]),
        np.sqrt(np.diag(full)),
        rtol=1e-2,
    )


def test_turning_retarders_are_calibrated_from_air_in_each_pixel():
    camera = images.simulate(SHAPE, dials_deg=DIALS, repeats=2, seed=3)
    found = images.calibrate(camera.references, camera.stacks, wavelength_nm=532, dials_deg=DIALS)
    assert not found.failure.any()
    matrices = images.reduce(camera.stack, found)
    assert np.sqrt(np.mean(relative(matrices, camera.mueller) ** 2)) < 5e-3
    alone = images.calibrate(camera.references, camera.stacks[:, 1:2, 1:2], wavelength_nm=532, dials_deg=DIALS)
    for k, (name, (value, u)) in enumerate(alone.start.retarders.items()):
        if u is None:
            continue
        assert abs(alone.retarders[0, 0, k] - value) < 0.02 * u + 1e-9, name
        assert alone.u_retarders[0, 0, k] == pytest.approx(u, rel=0.02), name


def test_failures_are_flagged_and_not_fatal(camera):
    stacks = camera.stacks.copy()
    stacks[3, 0, 0, 2] = np.nan
    stacks[:, 0, 1] = 0
    stacks[5:9, 0, 2] *= np.linspace(0.2, 5, 16)  # no instrument explains that
    mask = np.ones(SHAPE, bool)
    mask[5, 7] = mask[0, 1] = mask[0, 2] = False
    start = images.calibrate(camera.references, stacks, wavelength_nm=532, mask=mask).start
    mask[0, :] = True
    found = images.calibrate(camera.references, stacks, wavelength_nm=532, mask=mask, start=start)
    reasons = {tuple(place): images.FAILURES[found.failure[tuple(place)]] for place in np.argwhere(found.failure)}
    assert reasons.pop((0, 2)) in ("misfit", "no convergence")
    assert reasons == {(0, 0): "not finite", (0, 1): "not finite", (5, 7): "masked"}
    matrices = images.reduce(camera.stack, found)
    assert np.isnan(matrices[0, :3]).all() and np.isfinite(matrices[1:5]).all()
    with pytest.raises(ValueError, match=r"pixel \(5, 7\) is not calibrated: masked"):
        found.at(5, 7)


@pytest.mark.parametrize("hot", [60_000.0, 1e30, -1e30])
def test_a_hot_pixel_does_not_stop_the_others(camera, calibrated, hot):
    stacks = camera.stacks.copy()
    stacks[:, 1, 2] = hot
    stacks[:, 4, 4, 7] = hot
    found = images.calibrate(camera.references, stacks, wavelength_nm=532)
    assert np.argwhere(found.failure).tolist() == [[1, 2], [4, 4]]
    good = found.failure == 0
    # Steps end below a thousandth of the standard uncertainties, wherever they start.
    off = (found.generator - calibrated.generator)[good] / calibrated.u_generator[good]
    assert np.abs(off).max() < 2e-3
    assert np.isnan(images.reduce(camera.stack, found)[~good]).all()


def test_saturated_pixels_are_not_calibrated(camera, calibrated):
    stacks = camera.stacks.copy()
    stacks[3, 1, 2, 5] = 4095
    found = images.calibrate(camera.references, stacks, wavelength_nm=532, saturation=4000, start=calibrated.start)
    assert np.argwhere(found.failure).tolist() == [[1, 2]]
    assert images.FAILURES[found.failure[1, 2]] == "not finite" and np.isfinite(stacks).all()
    others = found.failure == 0
    np.testing.assert_array_equal(found.generator[others], calibrated.generator[others])


def test_uncertainties_are_the_scatter_of_repeated_frames():
    camera = images.simulate((40, 50), noise=0, seed=4)
    matrix = np.broadcast_to(camera.mueller[20, 30], (40, 50, 4, 4))
    random = np.random.default_rng(1)
    for instrument in (camera.instrument.at(0, 0), camera.instrument):
        exact = images.readings(matrix, instrument)
        law = {"relative": 0.01, "dark": 0.002}
        noisy = exact + random.normal(size=exact.shape) * np.sqrt((0.01 * exact) ** 2 + 0.002**2)
        u = images.uncertainty(exact, instrument, law)
        scatter = (images.reduce(noisy, instrument) - matrix) / u
        np.testing.assert_allclose(scatter.std(axis=(0, 1)), 1, atol=0.07)  # 2000 pixels: 1.6 %
        of_quantity = images.uncertainty(exact, instrument, law, quantity="depolarization")
        values = mmbrdf.depolarization(images.reduce(noisy, instrument))
        assert np.std((values - mmbrdf.depolarization(matrix[0, 0])) / of_quantity) == pytest.approx(1, abs=0.1)


@pytest.mark.parametrize("dials", [None, DIALS], ids=["grid", "retarders"])
def test_uncertainties_by_the_instrument_of_a_pixel_are_those_of_that_instrument_alone(dials):
    camera = images.simulate(SHAPE, dials_deg=dials, noise=0, seed=2)
    law = {"shot": 1e-4, "relative": 0.01}
    u = images.uncertainty(camera.stack, camera.instrument, law)
    for pixel in ((0, 0), (3, 4), (5, 7)):
        alone = images.uncertainty(camera.stack[pixel], camera.instrument.at(*pixel), law)
        np.testing.assert_allclose(u[pixel], alone, rtol=1e-5)  # of single precision


def test_images_are_analyzed_where_they_have_values(camera, calibrated):
    matrices = images.reduce(camera.stack, calibrated, mask=np.arange(8) > 0 * np.ones((6, 1)))
    found = images.quantities(matrices, ["depolarization", "purity"])
    assert np.isnan(found["purity"][:, 0]).all() and np.isfinite(found["depolarization"][:, 1:]).all()
    with pytest.raises(ValueError, match="quantity 'colour': expected one of"):
        images.quantities(matrices, ["colour"])


def test_instruments_can_be_sent_and_cut(camera, calibrated):
    copy = pickle.loads(pickle.dumps(calibrated))
    np.testing.assert_array_equal(images.reduce(camera.stack, copy), images.reduce(camera.stack, calibrated))
    part = calibrated[1:3, 2:7]
    assert part.shape == (2, 5)
    np.testing.assert_array_equal(
        images.reduce(camera.stack[1:3, 2:7], part), images.reduce(camera.stack, calibrated)[1:3, 2:7]
    )
    turning = images.simulate((3, 4), dials_deg=DIALS, noise=0, seed=2)  # read frame by frame
    whole = images.reduce(turning.stack, turning.instrument)
    np.testing.assert_array_equal(images.reduce(turning.stack[1:, :3], turning.instrument[1:, :3]), whole[1:, :3])


def test_rows_that_are_calibrated_apart_are_one_instrument(camera, calibrated):
    parts = [
        images.calibrate(camera.references, camera.stacks[:, rows], wavelength_nm=532, start=calibrated.start)
        for rows in (slice(0, 2), slice(2, 6))
    ]
    whole = images.join(parts)
    for name in ("generator", "analyzer", "u_generator", "misfit", "failure"):
        np.testing.assert_array_equal(getattr(whole, name), getattr(calibrated, name))
    with pytest.raises(ValueError, match="number 1 has 3 columns of 16 frames of 4 and 4 states, the first 8 columns"):
        images.join([calibrated, calibrated[:, 2:5]])


def test_instruments_of_other_states_are_not_joined(camera):
    whole = camera.instrument
    pairs = np.array([(p, q) for q in range(4) for p in range(4)])
    paired = images.PixelInstrument(whole.generator, whole.analyzer, pairs=pairs)
    turned = images.PixelInstrument(whole.generator, whole.analyzer, pairs=pairs[::-1])
    wide = images.PixelInstrument(whole.generator[:, :, [0, 1]], np.concatenate([whole.analyzer] * 2, axis=2))
    assert wide.frames == whole.frames
    for first, other, reason in [
        (whole, paired, "has other pairs of states than the first"),
        (paired, turned, "has other pairs of states than the first"),
        (
            whole,
            wide,
            "has 8 columns of 16 frames of 2 and 8 states, the first 8 columns of 16 frames of 4 and 4 states",
        ),
    ]:
        with pytest.raises(ValueError, match=f"^instruments: number 1 {reason}$"):
            images.join([first, other])
    assert images.join([paired, paired]).shape == (12, 8)


@pytest.mark.parametrize("law", [{"shot": -1.0}, {"dark": -0.1}, {"relative": -1e-3}, {"shot": np.nan}])
def test_noise_that_cannot_be_is_refused(camera, law):
    with pytest.raises(ValueError, match=rf"^noise: {next(iter(law))} = .*, must be (0 or more|finite)$"):
        images.uncertainty(camera.stack, camera.instrument, law)


@pytest.mark.parametrize("level", [np.nan, np.full(SHAPE, 4000.0), "4000"], ids=["nan", "array", "text"])
def test_a_saturation_that_is_no_number_is_refused_in_a_line(camera, level):
    for ask in (
        lambda: images.reduce(camera.stack, camera.instrument, saturation=level),
        lambda: images.calibrate(camera.references, camera.stacks, wavelength_nm=532, saturation=level),
    ):
        with pytest.raises(
            (TypeError, ValueError),
            match=r"^(images\.\w+: saturation: expected a number, not|saturation = nan, must be finite)",
        ):
            ask()
    found = images.reduce(camera.stack, camera.instrument, saturation=np.inf)
    np.testing.assert_array_equal(found, images.reduce(camera.stack, camera.instrument))


def test_uncertainties_do_not_have_the_units_of_readings(camera):
    xarray = pytest.importorskip("xarray")
    attributes = {"units": "counts", "long_name": "raw", "camera": "A"}
    raw = xarray.DataArray(camera.stack, dims=["y", "x", "frame"], attrs=attributes)
    for quantity in (None, "purity", "f_ss"):
        u = images.uncertainty(raw, camera.instrument, {"shot": 1e-4}, quantity=quantity)
        assert u.attrs == {"long_name": f"standard uncertainty of {quantity or 'mueller'}", "camera": "A"}
    assert raw.attrs == attributes


def test_small_slips_are_refused_in_a_line(camera):
    with pytest.raises(TypeError, match=r"^names: expected a list of them, not 'purity': give \['purity'\]$"):
        images.quantities(camera.mueller, "purity")
    for shape in ((0, 3), (3,), (2, -1)):
        with pytest.raises(ValueError, match=r"^shape = \(.*\), expected \(y, x\), each 1 or more$"):
            images.simulate(shape)


@pytest.mark.parametrize("lazy", [False, True])
@pytest.mark.parametrize("ask", [images.reduce, lambda *of: images.uncertainty(*of, {"shot": 1e-4})])
def test_a_stack_of_complex_numbers_does_not_lose_a_part_of_them(camera, ask, lazy):
    stack = camera.stack.astype(complex)
    if lazy:
        stack = pytest.importorskip("dask.array", reason="no dask: ./dev packages clusters").from_array(
            stack, chunks=(3, 8, -1)
        )
    with pytest.raises(TypeError, match="^stack: expected real numbers, not complex128$"):
        ask(stack, camera.instrument.at(0, 0))


def test_shapes_that_do_not_fit_are_named(camera, calibrated):
    with pytest.raises(ValueError, match="the last axis has 15 frames, the instrument 16"):
        images.reduce(camera.stack[..., :15], calibrated)
    with pytest.raises(ValueError, match=r"axes y, x are \(5, 8\), those of the instrument \(6, 8\)"):
        images.reduce(camera.stack[:5], calibrated)
    with pytest.raises(ValueError, match=r"dark: shape \(8,\), expected a number"):
        images.reduce(camera.stack, calibrated, dark=np.zeros(8))
    with pytest.raises(ValueError, match=r"mask: float64 of shape \(6, 8\), expected truth values"):
        images.reduce(camera.stack, calibrated, mask=np.ones(SHAPE))
    with pytest.raises(TypeError, match="instrument: expected a Polarimeter"):
        images.reduce(camera.stack, "instrument.json")
    with pytest.raises(ValueError, match="with 53 references"):
        images.calibrate(camera.references[1:], camera.stacks, wavelength_nm=532)
    with pytest.raises(ValueError, match="noise: read: expected dark, shot or relative"):
        images.uncertainty(camera.stack, calibrated, {"read": 1.0})
