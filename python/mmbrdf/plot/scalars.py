# SPDX-License-Identifier: BSD-3-Clause
"""A number of a Mueller matrix: its name in print, its frame, its values and their standard uncertainty."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np

import mmbrdf

from . import labels

if TYPE_CHECKING:
    from mmbrdf import Dataset
    from numpy.typing import NDArray

ELEMENTS = tuple(f"{row}{column}" for row in "1234" for column in "1234")

Asked = Union[str, Callable[[Any], Any]]
"""The name of a quantity, or a function of matrices (..., 4, 4)."""


class Scalar(NamedTuple):
    """``values`` takes matrices (..., 4, 4) in sr^-1 in the ``frame`` and gives (...), nan where there is no such number."""

    name: str
    label: str
    frame: str
    values: Callable[[NDArray[np.float64]], NDArray[np.float64]]


def scalar(asked: Asked, frame: str | None = None, stokes: Sequence[float] | None = None) -> Scalar:
    """What was asked for.

    "11" or "f11" is f11 in sr^-1, "12" ... "44" are the other elements divided by it, "reflectance_factor" is pi f11; all names of
    ``mmbrdf.quantities()``, which are of the frame sp, those of scattered light with its ``stokes``; or any function of
    matrices. ValueError for other names and frames.
    """
    if callable(asked):
        name = labels.plain(getattr(asked, "__name__", "value").replace("_", " "))
        return Scalar(name, name.replace("<lambda>", "value"), frame or "xy", asked)
    asked = "11" if asked == "f11" else asked
    if asked in ELEMENTS:
        return _element(asked, frame or "xy")
    if asked == "reflectance_factor":
        return Scalar(asked, r"reflectance factor $\pi f_{\mathrm{r},11}\;\mathrm{sr}$", frame or "xy", _factor)
    known = {each.name: each for each in mmbrdf.quantities()}
    if asked not in known:
        raise ValueError(
            f"quantity = {asked!r}: expected one of 11, 12, ..., 44, reflectance_factor, {', '.join(known)}"
        )
    if frame not in (None, "sp"):
        raise ValueError(f"quantity = {asked!r} is of the frame sp, not of {frame}")
    return _derived(known[asked], stokes)


def _element(name: str, frame: str) -> Scalar:
    row, column = (int(digit) - 1 for digit in name)
    if name == "11":
        return Scalar(name, labels.quantity(r"$f_{\mathrm{r},11}$", "sr^-1"), frame, lambda mueller: mueller[..., 0, 0])
    return Scalar(name, f"$m_{{{name}}}$", frame, lambda mueller: ratio(mueller[..., row, column], mueller[..., 0, 0]))


def ratio(numerator: Any, denominator: Any) -> NDArray[np.float64]:
    """nan or inf where it has no value, without a word."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(numerator / denominator)


def _factor(mueller: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(mmbrdf.reflectance_factor(1.0)) * mueller[..., 0, 0]


def _derived(quantity: mmbrdf.Quantity, stokes: Sequence[float] | None) -> Scalar:
    function = getattr(mmbrdf, quantity.name)
    light: tuple[Any, ...] = ()
    if quantity.takes_light:
        if stokes is None:
            raise ValueError(f"quantity = {quantity.name!r} needs stokes, the incident light in the frame sp")
        light = (stokes,)
    return Scalar(
        quantity.name,
        labels.quantity(
            SYMBOLS.get(quantity.name, quantity.name.removesuffix("_deg").replace("_", " ")), quantity.unit
        ),
        "sp",
        lambda mueller: np.asarray(function(mueller, *light, invalid="nan")),
    )


SYMBOLS = {
    "f_ss": r"$f_\mathrm{ss}$",
    "f_sp": r"$f_\mathrm{sp}$",
    "f_ps": r"$f_\mathrm{ps}$",
    "f_pp": r"$f_\mathrm{pp}$",
    "depolarization": "Gil–Bernabeu depolarization parameter",
    "eigenvalue_min": r"smallest coherency eigenvalue $/\,f_{\mathrm{r},11}$",
    "scattered_S1": r"scattered $S_1$",
    "scattered_S2": r"scattered $S_2$",
    "scattered_S3": r"scattered $S_3$",
    "scattered_S4": r"scattered $S_4$",
}


_STEP = 1e-5
"""Of numerical derivatives, relative to f11: their error is 1e-10 of the value for what is smooth."""


def gradient(values: Callable[[Any], Any], mueller: NDArray[np.float64]) -> NDArray[np.float64]:
    """Derivatives (..., 4, 4) of a number of matrices (..., 4, 4)."""
    step = _STEP * np.abs(mueller[..., 0, 0])
    result = np.empty_like(mueller)
    for row, column in np.ndindex(4, 4):
        ends = []
        for sign in (1, -1):
            moved = mueller.copy()
            moved[..., row, column] += sign * step
            ends.append(values(moved))
        result[..., row, column] = ratio(ends[0] - ends[1], 2 * step)
    return result


def model_uncertainty(asked: Scalar, model, wavelength_nm, geometry, terms=None) -> NDArray[np.float64]:
    """Standard uncertainty in first order of a model's number. ValueError for a model without a covariance."""
    if not model.has_covariance:
        raise ValueError("the model has no covariance, and so no uncertainty")
    mueller = model.evaluate(wavelength_nm, *geometry, frame=asked.frame)
    result = np.full(mueller.shape[0], np.nan)
    for some in np.array_split(np.arange(len(result)), 1 + len(result) // 2000):
        where = [np.broadcast_to(angle, result.shape)[some] for angle in geometry]
        covariance = model.covariance(wavelength_nm, *where, frame=asked.frame, terms=terms)
        result[some] = propagated(gradient(asked.values, mueller[some]), covariance)
    return result


def propagated(slopes: NDArray[np.float64], covariance: NDArray[np.float64]) -> NDArray[np.float64]:
    """The root of slopes (n, 4, 4) covariance (n, 16, 16) slopes. Elements without a slope need not be known."""
    flat = slopes.reshape(len(slopes), 16)
    used = np.where(flat[:, :, None] * flat[:, None, :] != 0, covariance, 0)
    return np.sqrt(np.maximum(np.einsum("ni,nij,nj->n", flat, used, flat), 0))


def sample_uncertainty(asked: Scalar, data: Dataset) -> NDArray[np.float64]:
    """Standard uncertainty of a number of measured matrices, from those of their elements, which count as independent.

    ValueError for samples without uncertainties.
    """
    if data.uncertainty is None:
        raise ValueError("the samples have no uncertainties: those of their noise are needed beside a model's")
    where = data.theta_i_deg, data.phi_i_deg, data.theta_r_deg, data.phi_r_deg
    measured = data.normalized * 1.0
    measured[:, 0, 0] = data.f11

    def of_elements(elements: NDArray[np.float64]) -> NDArray[np.float64]:
        mueller = elements * elements[:, :1, :1]
        mueller[:, 0, 0] = elements[:, 0, 0]
        return asked.values(in_frame(mueller, where, asked.frame))

    slopes = gradient(of_elements, measured)
    return np.sqrt(np.where(slopes != 0, (slopes * data.uncertainty) ** 2, 0).sum(axis=(1, 2)))


def measured_in(data: Dataset, frame: str) -> NDArray[np.float64]:
    """Matrices of samples in a frame; as they were measured, if that was in this frame."""
    mueller = in_frame(data.mueller, data.geometry, frame)
    own = data.frame == frame
    if frame != "xy" and own.any():
        f11 = data.f11[own, None, None]
        mueller[own] = f11 * data.as_measured[own]
    return mueller


def in_frame(mueller: NDArray[np.float64], where: Sequence[Any], frame: str) -> NDArray[np.float64]:
    """Matrices of the frame xy in another."""
    return mueller if frame == "xy" else mmbrdf.change_frame(mueller, *where, "xy", frame)
