# SPDX-License-Identifier: BSD-3-Clause
"""Images whose axes have names, and those in chunks: what counts are names, and the bits are those of arrays."""

import numpy as np
import pytest

from mmbrdf import images

SHAPE = (6, 8)


def test_lazy_stacks_have_the_bits_of_the_eager_call(camera, calibrated):
    da = pytest.importorskip("dask.array", reason="no Dask: ./dev packages clusters")
    xarray = pytest.importorskip("xarray")
    chunked = da.from_array(camera.stack, chunks=(4, 3, 16))
    dark, mask = np.full(SHAPE, 0.01, np.float32), np.arange(48).reshape(SHAPE) != 11
    for instrument in (calibrated, calibrated.start):
        expected = images.reduce(camera.stack, instrument, dark=dark, mask=mask, saturation=1.2)
        lazy = images.reduce(chunked, instrument, dark=dark, mask=mask, saturation=1.2)
        assert isinstance(lazy, da.Array) and lazy.dtype == np.float32
        np.testing.assert_array_equal(lazy.compute(), expected)
    named = xarray.DataArray(
        chunked, {"x": np.arange(8.0)}, ["y", "x", "frame"], "raw", {"camera": "A", "units": "counts"}
    )
    result = images.reduce(named.transpose("frame", "y", "x"), calibrated)
    assert result.dims == ("y", "x", "row", "column") and result.attrs["camera"] == "A"
    np.testing.assert_array_equal(result.values, images.reduce(camera.stack, calibrated))
    np.testing.assert_array_equal(result.x, np.arange(8.0))
    u = images.uncertainty(named, calibrated.start, {"shot": 1e-4}, quantity="purity")
    expected = images.uncertainty(camera.stack, calibrated.start, {"shot": 1e-4}, quantity="purity")
    np.testing.assert_array_equal(u.values, expected)
    with pytest.raises(ValueError, match=r"stack: chunks \(8, 8\) cut the axis 'frame'"):
        images.reduce(chunked.rechunk((6, 8, 8)), calibrated)


@pytest.mark.parametrize("chunked", [False, True], ids=["numpy", "dask"])
def test_names_count_and_not_the_order_of_axes(chunked):
    xarray = pytest.importorskip("xarray")
    if chunked:
        pytest.importorskip("dask.array", reason="no Dask: ./dev packages clusters")
    side = (6, 6)  # whose axes can be mistaken
    camera = images.simulate(side, repeats=4, seed=5)
    raw = xarray.DataArray(camera.stack, {"x": np.arange(6.0)}, ["y", "x", "frame"])
    dark = xarray.DataArray(np.linspace(0, 0.01, 36, dtype=np.float32).reshape(side), dims=["y", "x"])
    mask = xarray.DataArray(np.arange(36).reshape(side) != 11, dims=["y", "x"])
    given = raw.chunk({"y": 4}) if chunked else raw
    single = camera.instrument.at(0, 0)
    for own in (camera.instrument, single):
        expected = images.reduce(camera.stack, own, dark=dark.values, mask=mask.values)
        for order in (["y", "x", "frame"], ["x", "y", "frame"], ["frame", "x", "y"], ["x", "frame", "y"]):
            outer = [name for name in order if name != "frame"]
            turned = given.transpose(*order)
            for one, other in (
                (dark, mask),
                (dark.T, mask.T),
                (dark.transpose(*outer).values, mask.transpose(*outer).values),
            ):
                found = images.reduce(turned, own, dark=one, mask=other)
                assert found.dims == (*outer, "row", "column")
                np.testing.assert_array_equal(found.transpose("y", "x", ...).values, expected)
                np.testing.assert_array_equal(found.x, np.arange(6.0))
            if chunked and own is camera.instrument:
                continue
            for quantity in (None, "purity"):
                u = images.uncertainty(turned, own, {"relative": 0.01}, quantity=quantity)
                assert u.dims == (*outer, *([] if quantity else ["row", "column"]))
                plain = images.uncertainty(camera.stack, own, {"relative": 0.01}, quantity=quantity)
                np.testing.assert_array_equal(u.transpose("y", "x", ...).values, plain)
    matrices = xarray.DataArray(camera.mueller, dims=["y", "x", "row", "column"])
    np.testing.assert_array_equal(
        images.readings(matrices.transpose("column", "x", "row", "y"), camera.instrument),
        images.readings(camera.mueller, camera.instrument),
    )
    np.testing.assert_array_equal(
        images.reduce(camera.stack, single, dark=dark.T, mask=mask.T), images.reduce(raw, single, dark=dark, mask=mask)
    )


def test_names_that_say_too_little_are_refused(camera, calibrated):
    xarray = pytest.importorskip("xarray")
    raw = xarray.DataArray(camera.stack, dims=["y", "x", "frame"])
    unknown = raw.rename(y="down", x="across")
    for ask in (images.reduce, lambda s, i: images.uncertainty(s, i, {"shot": 1.0})):
        with pytest.raises(
            ValueError, match=r"^stack: dimensions \('down', 'across', 'frame'\), expected 'y', 'x' and"
        ):
            ask(unknown, calibrated)
        ask(unknown, calibrated.start)
        with pytest.raises(
            ValueError, match=r"^stack: dimensions \('k', 'y', 'x'\): none is called 'frame': rename it"
        ):
            ask(raw.rename(frame="k").transpose("k", "y", "x"), calibrated.start)
    with pytest.raises(ValueError, match=r"^dark: dimensions \('down', 'x'\), those of the stack are"):
        images.reduce(raw, calibrated, dark=raw[..., 0].rename(y="down"))
    with pytest.raises(ValueError, match=r"^stacks: dimensions .*, expected reference, y, x, frame: rename them"):
        images.calibrate(camera.references, xarray.DataArray(camera.stacks), wavelength_nm=532)


def test_stacks_with_names_are_calibrated_in_any_order(camera, calibrated):
    xarray = pytest.importorskip("xarray")
    named = xarray.DataArray(camera.stacks, dims=["reference", "y", "x", "frame"])
    mask = xarray.DataArray(np.arange(48).reshape(SHAPE) != 11, dims=["y", "x"])
    options = {"wavelength_nm": 532, "start": calibrated.start}
    expected = images.calibrate(camera.references, camera.stacks, mask=mask.values, **options)
    for stacks in (
        named.transpose("x", "frame", "y", "reference"),
        [one.transpose("x", "y", "frame") for one in named],
    ):
        found = images.calibrate(camera.references, stacks, mask=mask.T, **options)
        np.testing.assert_array_equal(found.generator, expected.generator)
        np.testing.assert_array_equal(found.failure, expected.failure)


def test_stacks_go_from_chunked_files_to_chunked_files(camera, calibrated, tmp_path):
    pytest.importorskip("zarr", reason="no zarr: ./dev packages clusters")
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("dask.array", reason="no Dask: ./dev packages clusters")
    named = xarray.DataArray(camera.stack, dims=["y", "x", "frame"], name="raw", attrs={"camera": "A"})
    named.chunk({"y": 3}).to_dataset().to_zarr(tmp_path / "raw")
    images.reduce(xarray.open_zarr(tmp_path / "raw").raw, calibrated).to_dataset().to_zarr(tmp_path / "mueller")
    read = xarray.open_zarr(tmp_path / "mueller").mueller
    assert read.dims == ("y", "x", "row", "column") and read.attrs["camera"] == "A" and read.dtype == np.float32
    np.testing.assert_array_equal(read.values, images.reduce(camera.stack, calibrated))
