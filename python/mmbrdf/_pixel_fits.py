# SPDX-License-Identifier: BSD-3-Clause
"""A BRDF in each pixel: many fits whose geometries are the same. mmbrdf.images shows it."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _mmbrdf
from ._arguments import nan_where_masked, two_orders, unmasked
from ._files import replacing
from ._mmbrdf import Model, __version__

if TYPE_CHECKING:
    import xarray

_ANGLES = ("theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg")


class PixelFit:
    """Fits to values at given geometries, prepared once: coefficients of a set of them are a product with one matrix.

    wavelength_nm  of all of them
    geometry       theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg: broadcast to (geometries,)
    basis, orders, mapping, minimum_norm  as for mmbrdf.fit, which germer2017 is not for: it turns samples
    weights        (geometries, 4, 4) of f11 and of m_ij; None: 1
    f11_only       f11 alone: the models do not know the others

    It can be pickled, without its matrix, which is made again from these, with the same bits. Raises ValueError for geometries that do not determine the model.
    """

    def __init__(
        self,
        wavelength_nm: float,
        geometry: Sequence[ArrayLike],
        basis: str = "isotropic",
        orders: tuple[int, int] = (7, 4),
        *,
        mapping: str = "lambert",
        weights: ArrayLike | None = None,
        f11_only: bool = False,
        minimum_norm: bool = False,
    ):
        if len(geometry) != 4:
            raise ValueError(f"geometry: {len(geometry)} arrays, expected {', '.join(_ANGLES)}")
        broadcast = np.broadcast_arrays(
            *[np.asarray(unmasked(name, angle), float) for name, angle in zip(_ANGLES, geometry)]
        )
        self.geometry = tuple(np.ascontiguousarray(angle.reshape(-1)) for angle in broadcast)
        count = len(self.geometry[0])
        self.weights = None if weights is None else np.asarray(unmasked("weights", weights), float)
        if self.weights is not None and self.weights.shape != (count, 4, 4):
            raise ValueError(f"weights: shape {self.weights.shape}, expected {(count, 4, 4)}")
        self.wavelength_nm, self.f11_only = float(wavelength_nm), bool(f11_only)
        self._basis, self._orders, self._mapping, self._minimum_norm = basis, two_orders(orders), mapping, minimum_norm
        self._prepared = self._influence(self.weights)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_prepared"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._prepared = self._influence(self.weights)

    def _influence(self, weights: NDArray[np.float64] | None) -> _mmbrdf._Influence:
        return _mmbrdf._Influence(
            self.wavelength_nm, *self.geometry, self._basis, self._orders, self._mapping, weights, self.f11_only, self._minimum_norm
        )  # fmt: skip

    @property
    def coefficients(self) -> int:
        """Of one pixel."""
        return self._prepared.coefficients

    @property
    def blocks(self) -> tuple[tuple[str, int], ...]:
        """Name and number of coefficients of each block, in their order."""
        return self._prepared.blocks

    def require_geometry(self, geometry: Sequence[ArrayLike]) -> None:
        """Raises ValueError unless these are the same geometries, and names the first that differs."""
        for name, own, angle in zip(_ANGLES, self.geometry, geometry, strict=True):
            other = np.broadcast_to(np.asarray(unmasked(name, angle), float), own.shape)
            different = np.flatnonzero(own != other)
            if len(different):
                g = int(different[0])
                raise ValueError(f"geometry: {name} of geometry {g} is {other[g]:g}, in the fit {own[g]:g}")

    def fit(
        self,
        values: ArrayLike,
        *,
        geometry: Sequence[ArrayLike] | None = None,
        threads: int = 0,
        progress: Callable[[Any], Any] | None = None,
    ) -> PixelModels:
        """Models of sets of values (..., geometries, 4, 4), or (..., geometries) of f11 alone, in sr^-1.

        Missing readings are nan, or masked: f11, or a whole matrix. Pixels that lack the same readings are fitted together, each such
        pattern with a matrix of its own; a pattern that does not determine the model is NaN. geometry, if it is given,
        must be that of the fit. What a pixel gives does not depend on the others, nor on threads.
        """
        if geometry is not None:
            self.require_geometry(geometry)
        array = nan_where_masked(values, float)
        if array.dtype != np.float32:
            array = np.asarray(array, float)
        core = (len(self.geometry[0]),) if self.f11_only else (len(self.geometry[0]), 4, 4)
        if array.shape[-len(core) :] != core:
            raise ValueError(f"values: shape {array.shape}, expected (..., {', '.join(map(str, core))})")
        shape = array.shape[: -len(core)]
        sets = np.ascontiguousarray(array.reshape(math.prod(shape), *core))
        coefficients, variances = self._fit(self._prepared, sets, threads)
        bad = np.flatnonzero(~np.isfinite(coefficients).all(axis=1))
        if len(bad):
            self._fit_patterns(sets, bad, coefficients, variances, threads, progress)
        return PixelModels(
            self, coefficients.reshape(*shape, self.coefficients), variances.reshape(*shape, len(self.blocks))
        )

    def _fit(
        self, prepared: _mmbrdf._Influence, sets: NDArray[Any], threads: int
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        each = 1 if self.f11_only else 16
        return (prepared.fit_float if sets.dtype == np.float32 else prepared.fit_double)(sets, each, threads)

    def _fit_patterns(
        self, sets: Any, bad: Any, coefficients: Any, variances: Any, threads: int, progress: Any
    ) -> None:
        missing = ~np.isfinite(sets[bad]) if self.f11_only else ~np.isfinite(sets[bad]).all(axis=(-2, -1))
        patterns, which = np.unique(missing, axis=0, return_inverse=True)
        numbers = range(len(patterns))
        for k in numbers if progress is None else progress(numbers):
            pixels = bad[which.ravel() == k]
            weights = np.ones((len(self.geometry[0]), 4, 4)) if self.weights is None else self.weights.copy()
            weights[patterns[k]] = 0
            try:
                prepared = self._influence(weights)
            except ValueError:  # they do not determine the model
                coefficients[pixels] = variances[pixels] = np.nan
                continue
            if prepared.coefficients != self.coefficients:
                coefficients[pixels] = variances[pixels] = np.nan
                continue
            some = sets[pixels].copy()
            some[:, patterns[k]] = 1
            coefficients[pixels], variances[pixels] = self._fit(prepared, some, threads)


class PixelModels:
    """Models of many pixels: what PixelFit.fit() gives. ``models[y, x]`` is the Model of one. They can be pickled."""

    def __init__(self, fit: PixelFit, coefficients: NDArray[np.float64], variances: NDArray[np.float64]):
        self._fit = fit
        self.coefficients = coefficients
        """(..., coefficients), in the order of the blocks; NaN of a pixel without a fit."""
        self.variances = variances
        """(..., blocks): s^2 by which the covariance that all pixels share is multiplied, of pixels without missing readings.
        NaN where no degree of freedom is left: the covariance of that block is not known."""

    @property
    def shape(self) -> tuple[int, ...]:
        return self.coefficients.shape[:-1]

    def __repr__(self) -> str:
        return f"<mmbrdf.images.PixelModels: {' x '.join(map(str, self.shape))} pixels, {self._fit.coefficients} coefficients>"

    def __getitem__(self, pixel: int | tuple[int, ...]) -> Model:
        place = pixel if isinstance(pixel, tuple) else (pixel,)
        coefficients, variances = self.coefficients[place], self.variances[place]
        if coefficients.ndim != 1:
            raise IndexError(f"pixel {place}: pixels have {len(self.shape)} axes")
        if not np.isfinite(coefficients).all():
            raise ValueError(f"pixel {place} has no fit: its readings are missing, or do not determine it")
        return self._fit._prepared.model(coefficients, variances, f"pixel {', '.join(map(str, place))}")

    def evaluate(
        self,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        pixel: int | tuple[int, ...],
        frame: str = "xy",
    ) -> NDArray[np.float64]:
        """As Model.evaluate() of one pixel."""
        model = self[pixel]
        return model.evaluate(self._fit.wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, frame=frame)

    def evaluate_uncertainty(
        self,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        pixel: int | tuple[int, ...],
        frame: str = "xy",
    ) -> NDArray[np.float64]:
        """As Model.evaluate_uncertainty() of one pixel."""
        model = self[pixel]
        return model.evaluate_uncertainty(
            self._fit.wavelength_nm, theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg, frame=frame
        )

    def to_xarray(self) -> xarray.Dataset:
        """All there is: to_netcdf() writes it, from_xarray() of what was read makes the same models."""
        import xarray

        fit = self._fit
        outer = ["y", "x"] if len(self.shape) == 2 else [f"axis_{k}" for k in range(len(self.shape))]
        names = np.repeat([name for name, _ in fit.blocks], [count for _, count in fit.blocks])
        data: dict[str, Any] = {
            "coefficients": ([*outer, "coefficient"], self.coefficients),
            "variances": ([*outer, "block"], self.variances),
            "block_of_coefficient": (["coefficient"], names.astype(str)),
        }
        data |= {name: (["geometry"], angle, {"units": "degree"}) for name, angle in zip(_ANGLES, fit.geometry)}
        if fit.weights is not None:
            data["weights"] = (["geometry", "row", "column"], fit.weights)
        how = {
            "basis": fit._basis, "orders": list(fit._orders), "mapping": fit._mapping, "wavelength_nm": fit.wavelength_nm,
            "f11_only": fit.f11_only, "minimum_norm": fit._minimum_norm,
        }  # fmt: skip
        return xarray.Dataset(data, attrs={"fit": json.dumps(how), "software": f"mmbrdf {__version__}"})

    def save(self, path: str | os.PathLike[str]) -> None:
        """One NetCDF file: wholly, or not at all."""
        with replacing(path) as beside:
            self.to_xarray().to_netcdf(beside)

    @staticmethod
    def from_xarray(data: xarray.Dataset) -> PixelModels:
        """Raises ValueError for what to_xarray() has not made."""
        if "fit" not in data.attrs or "coefficients" not in data:
            raise ValueError("not models of pixels: no coefficients, or no attribute 'fit'")
        how = json.loads(data.attrs["fit"])
        fit = PixelFit(
            how["wavelength_nm"],
            [data[name].values for name in _ANGLES],
            how["basis"],
            tuple(how["orders"]),
            mapping=how["mapping"],
            weights=data["weights"].values if "weights" in data else None,
            f11_only=how["f11_only"],
            minimum_norm=how["minimum_norm"],
        )
        coefficients, variances = data["coefficients"].values, data["variances"].values
        if coefficients.shape[-1] != fit.coefficients or variances.shape[-1] != len(fit.blocks):
            raise ValueError(
                f"coefficients: {coefficients.shape[-1]} in a pixel and {variances.shape[-1]} blocks, the fit has "
                f"{fit.coefficients} and {len(fit.blocks)}"
            )
        return PixelModels(fit, coefficients, variances)


def load_models(path: str | os.PathLike[str]) -> PixelModels:
    """What PixelModels.save() has written."""
    import xarray

    with xarray.open_dataset(path) as data:
        return PixelModels.from_xarray(data.load())
