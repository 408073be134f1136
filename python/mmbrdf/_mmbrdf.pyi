# SPDX-License-Identifier: BSD-3-Clause
"""Types of the compiled part; what each does is in its docstring."""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Literal, Protocol, overload

import mmbrdf
import numpy as np
import xarray
from numpy.typing import ArrayLike, NDArray

__version__: str

class _Table(Protocol):
    """A pandas.DataFrame and the like."""

    def keys(self) -> Iterable[Any]: ...
    def __getitem__(self, name: Any, /) -> Any: ...

_Readings = str | os.PathLike[str] | Mapping[str, ArrayLike] | NDArray[np.void] | _Table

class Block:
    @property
    def name(self) -> str: ...
    @property
    def elements(self) -> list[str]: ...
    @property
    def modes(self) -> list[tuple[str, int, int, int, int]]: ...
    @property
    def coefficients(self) -> NDArray[np.float64]: ...
    @property
    def covariance(self) -> NDArray[np.float64] | None: ...
    @property
    def rank(self) -> int: ...
    @property
    def condition(self) -> float: ...

class DirectionSampler:
    def __init__(self, model: Model, wavelength_nm: float | None = None) -> None: ...
    def sample(
        self, theta_i_deg: ArrayLike, phi_i_deg: ArrayLike, u1: ArrayLike, u2: ArrayLike
    ) -> mmbrdf.SampledDirections: ...
    def pdf(
        self, theta_i_deg: ArrayLike, phi_i_deg: ArrayLike, theta_r_deg: ArrayLike, phi_r_deg: ArrayLike
    ) -> float | NDArray[np.float64]: ...
    def weight(
        self,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        pdf: ArrayLike,
        *,
        frame: str = ...,
        invalid: Literal["raise", "nan"] = ...,
    ) -> NDArray[np.float64]: ...

class Model:
    @property
    def name(self) -> str: ...
    def renamed(self, name: str) -> Model: ...
    @property
    def family(self) -> str: ...
    @property
    def mapping(self) -> str: ...
    @property
    def as_printed(self) -> bool: ...
    @property
    def not_measured(self) -> list[str]: ...
    @property
    def powers(self) -> int: ...
    @property
    def orders(self) -> tuple[int, int]: ...
    @property
    def coefficient_count(self) -> int: ...
    @property
    def degrees_of_freedom(self) -> float: ...
    @property
    def blocks(self) -> list[Block]: ...
    @property
    def wavelengths_nm(self) -> tuple[float, ...]: ...
    @property
    def theta_i_max_deg(self) -> float | None: ...
    @property
    def theta_r_max_deg(self) -> float | None: ...
    @property
    def reflectance(self) -> dict[float, float]: ...
    @property
    def has_covariance(self) -> bool: ...
    @property
    def provenance(self) -> dict[str, str]: ...
    def save(self, path: str | os.PathLike[str]) -> None: ...
    def export(
        self,
        path: str | os.PathLike[str],
        format: str | None = None,
        *,
        wavelength_nm: ArrayLike | None = None,
        channel: str = "f11",
        error: float = 5e-4,
        streams: int = 0,
        moments: int = 0,
        sun_deg: ArrayLike | None = None,
        view_deg: ArrayLike | None = None,
        azimuth_deg: ArrayLike | None = None,
    ) -> str: ...
    def fourier_moments(
        self, wavelength_nm: float | None, mu_i: ArrayLike, mu_r: ArrayLike
    ) -> mmbrdf.FourierMoments: ...
    def _is_its_own_mirror_image(self) -> bool: ...
    def to_json(self) -> str: ...
    @staticmethod
    def from_json(text: str) -> Model: ...
    @overload
    def evaluate(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        frame: str = ...,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[False] = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[False] = ...,
        out: NDArray[np.float64] | None = ...,
    ) -> NDArray[np.float64]: ...
    @overload
    def evaluate(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        frame: str = ...,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[False] = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[False] = ...,
        out: NDArray[np.float64] | None = ...,
    ) -> NDArray[np.float64]: ...
    @overload
    def evaluate(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        frame: str = ...,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[False] = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[True],
    ) -> xarray.DataArray: ...
    @overload
    def evaluate(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        frame: str = ...,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[False] = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[True],
    ) -> xarray.DataArray: ...
    @overload
    def evaluate(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        frame: str = ...,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[True],
        terms: dict[str, float] | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[False] = ...,
        out: NDArray[np.float64] | None = ...,
    ) -> mmbrdf.Evaluation: ...
    @overload
    def evaluate(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        frame: str = ...,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[True],
        terms: dict[str, float] | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[False] = ...,
        out: NDArray[np.float64] | None = ...,
    ) -> mmbrdf.Evaluation: ...
    @overload
    def evaluate(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        frame: str = ...,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[True],
        terms: dict[str, float] | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[True],
    ) -> xarray.Dataset: ...
    @overload
    def evaluate(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        frame: str = ...,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[True],
        terms: dict[str, float] | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[True],
    ) -> xarray.Dataset: ...
    @overload
    def evaluate_uncertainty(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        frame: str = ...,
        as_printed: bool = ...,
        terms: dict[str, float] | None = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[False] = ...,
    ) -> NDArray[np.float64]: ...
    @overload
    def evaluate_uncertainty(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        frame: str = ...,
        as_printed: bool = ...,
        terms: dict[str, float] | None = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[False] = ...,
    ) -> NDArray[np.float64]: ...
    @overload
    def evaluate_uncertainty(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        frame: str = ...,
        as_printed: bool = ...,
        terms: dict[str, float] | None = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[True],
    ) -> xarray.DataArray: ...
    @overload
    def evaluate_uncertainty(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        frame: str = ...,
        as_printed: bool = ...,
        terms: dict[str, float] | None = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[True],
    ) -> xarray.DataArray: ...
    @overload
    def reflectance_factor(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[False] = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[False] = ...,
    ) -> float | NDArray[np.float64]: ...
    @overload
    def reflectance_factor(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[False] = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[False] = ...,
    ) -> float | NDArray[np.float64]: ...
    @overload
    def reflectance_factor(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[False] = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[True],
    ) -> xarray.DataArray: ...
    @overload
    def reflectance_factor(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[False] = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[True],
    ) -> xarray.DataArray: ...
    @overload
    def reflectance_factor(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[True],
        terms: dict[str, float] | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[False] = ...,
    ) -> mmbrdf.Evaluation: ...
    @overload
    def reflectance_factor(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[True],
        terms: dict[str, float] | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[False] = ...,
    ) -> mmbrdf.Evaluation: ...
    @overload
    def reflectance_factor(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[True],
        terms: dict[str, float] | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[True],
    ) -> xarray.Dataset: ...
    @overload
    def reflectance_factor(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        as_printed: bool = ...,
        threads: int | None = ...,
        uncertainty: Literal[True],
        terms: dict[str, float] | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[True],
    ) -> xarray.Dataset: ...
    @overload
    def reflectance_factor_uncertainty(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        as_printed: bool = ...,
        threads: int | None = ...,
        terms: dict[str, float] | None = ...,
        invalid: Literal["raise", "nan"] = ...,
    ) -> float | NDArray[np.float64]: ...
    @overload
    def reflectance_factor_uncertainty(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        as_printed: bool = ...,
        threads: int | None = ...,
        terms: dict[str, float] | None = ...,
        invalid: Literal["raise", "nan"] = ...,
    ) -> float | NDArray[np.float64]: ...
    @overload
    def covariance(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        frame: str = ...,
        as_printed: bool = ...,
        terms: dict[str, float] | None = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
    ) -> NDArray[np.float64]: ...
    @overload
    def covariance(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        frame: str = ...,
        as_printed: bool = ...,
        terms: dict[str, float] | None = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
    ) -> NDArray[np.float64]: ...
    @overload
    def outside(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        invalid: Literal["raise", "nan"] = ...,
    ) -> NDArray[np.uint8]: ...
    @overload
    def outside(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        invalid: Literal["raise", "nan"] = ...,
    ) -> NDArray[np.uint8]: ...
    @overload
    def estimable(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        as_printed: bool = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
    ) -> NDArray[np.bool_]: ...
    @overload
    def estimable(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        as_printed: bool = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
    ) -> NDArray[np.bool_]: ...
    @overload
    def analyze(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        frame: str = ...,
        as_printed: bool = ...,
        terms: dict[str, float] | None = ...,
        stokes: Sequence[float] | NDArray[np.float64] | None = ...,
        draws: int = ...,
        seed: int = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[False] = ...,
    ) -> dict[str, mmbrdf.Analyzed]: ...
    @overload
    def analyze(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        frame: str = ...,
        as_printed: bool = ...,
        terms: dict[str, float] | None = ...,
        stokes: Sequence[float] | NDArray[np.float64] | None = ...,
        draws: int = ...,
        seed: int = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[False] = ...,
    ) -> dict[str, mmbrdf.Analyzed]: ...
    @overload
    def analyze(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        frame: str = ...,
        as_printed: bool = ...,
        terms: dict[str, float] | None = ...,
        stokes: Sequence[float] | NDArray[np.float64] | None = ...,
        draws: int = ...,
        seed: int = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[True],
    ) -> xarray.Dataset: ...
    @overload
    def analyze(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        frame: str = ...,
        as_printed: bool = ...,
        terms: dict[str, float] | None = ...,
        stokes: Sequence[float] | NDArray[np.float64] | None = ...,
        draws: int = ...,
        seed: int = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
        as_xarray: Literal[True],
    ) -> xarray.Dataset: ...
    @overload
    def predict_readings(
        self,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        at_its_azimuth: bool = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
    ) -> mmbrdf.Evaluation: ...
    @overload
    def predict_readings(
        self,
        *,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        at_its_azimuth: bool = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
    ) -> mmbrdf.Evaluation: ...
    def evaluate_draws(
        self,
        count: int,
        seed: int,
        wavelength_nm: ArrayLike | None,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        *,
        frame: str = ...,
        as_printed: bool = ...,
        threads: int | None = ...,
        invalid: Literal["raise", "nan"] = ...,
    ) -> NDArray[np.float64]: ...
    def summary(self) -> str: ...
    def _repr_html_(self) -> str: ...

class Dataset:
    def __init__(
        self,
        wavelength_nm: ArrayLike,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        mueller: ArrayLike,
        frame: str = "xy",
        uncertainty: ArrayLike | None = None,
    ) -> None: ...
    @property
    def wavelength_nm(self) -> NDArray[np.float64]: ...
    @property
    def theta_i_deg(self) -> NDArray[np.float64]: ...
    @property
    def phi_i_deg(self) -> NDArray[np.float64]: ...
    @property
    def theta_r_deg(self) -> NDArray[np.float64]: ...
    @property
    def phi_r_deg(self) -> NDArray[np.float64]: ...
    @property
    def f11(self) -> NDArray[np.float64]: ...
    @property
    def normalized(self) -> NDArray[np.float64]: ...
    @property
    def mueller(self) -> NDArray[np.float64]: ...
    @property
    def frame(self) -> NDArray[np.str_]: ...
    @property
    def as_measured(self) -> NDArray[np.float64]: ...
    @property
    def uncertainty(self) -> NDArray[np.float64] | None: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Dataset]: ...
    def __getitem__(self, which: object) -> Dataset: ...
    @property
    def wavelengths_nm(self) -> tuple[float, ...]: ...
    @property
    def read_as(self) -> str: ...
    @property
    def reduction(self) -> str: ...
    @property
    def geometry(self) -> mmbrdf.Geometry: ...
    def at_wavelengths(self, wavelength_nm: ArrayLike) -> Dataset: ...
    def save(self, path: str | os.PathLike[str]) -> None: ...
    def summary(self) -> str: ...
    def _repr_html_(self) -> str: ...

class FitResult:
    @property
    def model(self) -> Model: ...
    @property
    def residuals(self) -> NDArray[np.float64]: ...
    @property
    def rms(self) -> NDArray[np.float64]: ...
    @property
    def polarization_rms(self) -> float: ...
    @property
    def chi_squared_per_dof(self) -> dict[str, float]: ...
    @property
    def noise(self) -> list[dict[str, float]]: ...
    @property
    def warnings(self) -> list[str]: ...
    def summary(self) -> str: ...
    def _repr_html_(self) -> str: ...

class FitAccumulator:
    def __init__(
        self, basis: str = ..., orders: tuple[int, int] = ..., *, mapping: str = ..., as_printed: bool = ...
    ) -> None: ...
    def add(self, data: Dataset) -> None: ...
    def merge(self, other: FitAccumulator) -> None: ...
    def solve(
        self,
        *,
        powers: int | None = ...,
        reflectance: dict[float, float] | None = ...,
        minimum_norm: bool = ...,
        name: str = ...,
        attribution: str = ...,
    ) -> FitResult: ...
    @property
    def samples(self) -> int: ...
    def state(self) -> NDArray[np.float64]: ...
    @staticmethod
    def from_state(
        state: ArrayLike,
        basis: str = ...,
        orders: tuple[int, int] = ...,
        *,
        mapping: str = ...,
        as_printed: bool = ...,
    ) -> FitAccumulator: ...

class SampleFitAccumulator:
    def __init__(
        self,
        basis: str = ...,
        orders: tuple[int, int] = ...,
        *,
        mapping: str = ...,
        as_printed: bool = ...,
        weights: str | None = ...,
    ) -> None: ...
    def add(self, data: Dataset, *, threads: int = ...) -> None: ...
    def merge(self, other: SampleFitAccumulator) -> None: ...
    def next_round(self) -> bool: ...
    def solve(
        self,
        *,
        powers: int | None = ...,
        reflectance: dict[float, float] | None = ...,
        declared: dict[str, float] = ...,
        minimum_norm: bool = ...,
        name: str = ...,
        attribution: str = ...,
    ) -> FitResult: ...
    @property
    def round(self) -> int: ...
    @property
    def finished(self) -> bool: ...
    @property
    def samples(self) -> int: ...
    def state(self) -> NDArray[np.float64]: ...
    @staticmethod
    def from_state(
        state: ArrayLike,
        basis: str = ...,
        orders: tuple[int, int] = ...,
        *,
        mapping: str = ...,
        as_printed: bool = ...,
        weights: str | None = ...,
    ) -> SampleFitAccumulator: ...

class Aperture:
    @staticmethod
    def direction(theta_deg: float, phi_deg: float = 0.0) -> Aperture: ...
    @staticmethod
    def cone(theta_deg: float, phi_deg: float, half_angle_deg: float) -> Aperture: ...
    @staticmethod
    def annulus(theta_deg: float, phi_deg: float, inner_deg: float, outer_deg: float) -> Aperture: ...
    @staticmethod
    def ellipse(
        theta_deg: float, phi_deg: float, half_theta_deg: float, half_phi_deg: float, turn_deg: float = 0.0
    ) -> Aperture: ...
    @staticmethod
    def rectangle(
        theta_deg: float, phi_deg: float, half_theta_deg: float, half_phi_deg: float, turn_deg: float = 0.0
    ) -> Aperture: ...
    @staticmethod
    def ring(theta_min_deg: float, theta_max_deg: float) -> Aperture: ...
    @staticmethod
    def cap(theta_max_deg: float) -> Aperture: ...
    @staticmethod
    def hemisphere() -> Aperture: ...
    def without(self, port: Aperture) -> Aperture: ...
    @property
    def projected_solid_angle(self) -> float: ...
    @property
    def largest_theta_deg(self) -> float: ...

class Polarimeter:
    def __init__(self, generator: ArrayLike, analyzer: ArrayLike, pairs: ArrayLike | None = None) -> None: ...
    @property
    def generator(self) -> NDArray[np.float64]: ...
    @property
    def analyzer(self) -> NDArray[np.float64]: ...
    @property
    def pairs(self) -> NDArray[np.int64] | None: ...
    @property
    def determined(self) -> NDArray[np.bool_]: ...
    @property
    def rank(self) -> int: ...
    @property
    def condition(self) -> float: ...
    def readings(self, mueller: ArrayLike) -> NDArray[np.float64]: ...
    @overload  # type: ignore[misc]
    def reduce(
        self, readings: NDArray[np.float32], invalid: Literal["raise", "nan"] = "raise"
    ) -> NDArray[np.float32]: ...
    @overload
    def reduce(self, readings: ArrayLike, invalid: Literal["raise", "nan"] = "raise") -> NDArray[np.float64]: ...
    def covariance(self, variances: ArrayLike) -> NDArray[np.float64]: ...
    def summary(self) -> str: ...
    def _repr_html_(self) -> str: ...

class _PixelInverses:
    def __init__(self, generators: ArrayLike, analyzers: ArrayLike, like: Polarimeter, threads: int = ...) -> None: ...
    @property
    def pixels(self) -> int: ...
    def reduce(self, readings: ArrayLike, first: int = ..., threads: int = ...) -> NDArray[np.float32]: ...

class _Cameras:
    def __init__(
        self,
        references: Sequence[tuple[str, float, int, int]],
        generators: int,
        analyzers: int,
        wavelength_nm: float,
        noise: tuple[float, float, float],
        dial_sense: int,
        fit_polarizer_phase: bool,
        dials_deg: ArrayLike | None,
        retardance_deg: float,
        polarizer_near_deg: float | None,
        fit_extinction: bool,
        fit_diattenuation: bool,
        fit_drift: bool,
    ) -> None: ...
    def start(self, mean: ArrayLike) -> Calibration: ...
    def calibrate(
        self, start: Calibration, readings: ArrayLike, threads: int, most_misfit: float
    ) -> dict[str, NDArray[np.float64]]: ...

class _Influence:
    def __init__(
        self,
        wavelength_nm: float,
        theta_i_deg: ArrayLike,
        phi_i_deg: ArrayLike,
        theta_r_deg: ArrayLike,
        phi_r_deg: ArrayLike,
        basis: str,
        orders: tuple[int, ...],
        mapping: str,
        weights: ArrayLike | None,
        f11_only: bool,
        minimum_norm: bool,
    ) -> None: ...
    @property
    def coefficients(self) -> int: ...
    @property
    def geometries(self) -> int: ...
    @property
    def blocks(self) -> tuple[tuple[str, int], ...]: ...
    def fit_float(
        self, values: NDArray[np.float32], each: int, threads: int
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def fit_double(
        self, values: NDArray[np.float64], each: int, threads: int
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def model(self, coefficients: ArrayLike, variances: ArrayLike, name: str) -> Model: ...

class Calibration:
    @property
    def wavelength_nm(self) -> float: ...
    @property
    def polarimeter(self) -> Polarimeter: ...
    @property
    def covariance(self) -> NDArray[np.float64] | None: ...
    @property
    def scale_uncertainty(self) -> float: ...
    @property
    def polarizer_offset_deg(self) -> float: ...
    @property
    def extinction(self) -> float: ...
    @property
    def retarders(self) -> dict[str, tuple[float, float | None]] | None: ...
    @property
    def film_thickness_um(self) -> float: ...
    @property
    def figure_of_merit(self) -> float: ...
    @property
    def figure_of_merit_by_kind(self) -> dict[str, float]: ...
    @property
    def figure_of_merit_by_element(self) -> NDArray[np.float64]: ...
    @property
    def references(self) -> tuple[mmbrdf.CalibrationReference, ...]: ...
    @property
    def generator_uncertainty(self) -> NDArray[np.float64] | None: ...
    @property
    def analyzer_uncertainty(self) -> NDArray[np.float64] | None: ...
    @property
    def film_misfit_deg(self) -> float: ...
    @property
    def generator_condition(self) -> float: ...
    @property
    def analyzer_condition(self) -> float: ...
    @property
    def singular_ratio(self) -> float: ...
    @property
    def identifiability(self) -> float: ...
    @property
    def chi_squared(self) -> float: ...
    @property
    def degrees_of_freedom(self) -> int: ...
    @property
    def provenance(self) -> dict[str, str]: ...
    def save(self, path: str | os.PathLike[str]) -> None: ...
    def summary(self) -> str: ...
    def _repr_html_(self) -> str: ...

class Goniometer:
    def __init__(
        self,
        seed: int = 0,
        *,
        relative_noise: float = 0.001,
        speckle: float = 0.0,
        dials_deg: ArrayLike | None = None,
        retardance_deg: float = 90.0,
    ) -> None: ...
    @property
    def polarimeter(self) -> Polarimeter: ...
    @property
    def solid_angle(self) -> float: ...
    @property
    def film(self) -> tuple[complex, float, complex]: ...
    def write_references(
        self, path: str | os.PathLike[str], wavelength_nm: float, count: int = 18, seed: int = 0
    ) -> None: ...
    def write_raw(
        self,
        path: str | os.PathLike[str],
        model: Model,
        wavelength_nm: float,
        geometry: Sequence[ArrayLike],
        seed: int = 0,
    ) -> None: ...

@overload
def average(
    model: Model,
    wavelength_nm: float | None,
    source: Aperture,
    receiver: Aperture,
    tolerance: float = 1e-10,
    *,
    uncertainty: Literal[False] = ...,
) -> tuple[NDArray[np.float64], float, bool]: ...
@overload
def average(
    model: Model,
    wavelength_nm: float | None,
    source: Aperture,
    receiver: Aperture,
    tolerance: float = 1e-10,
    *,
    uncertainty: Literal[True],
    terms: dict[str, float] | None = None,
) -> mmbrdf.Evaluation: ...
def average_uncertainty(
    model: Model,
    wavelength_nm: float | None,
    source: Aperture,
    receiver: Aperture,
    *,
    terms: dict[str, float] | None = None,
) -> NDArray[np.float64]: ...
@overload
def bihemispherical_reflectance(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    *,
    uncertainty: Literal[False] = ...,
    invalid: Literal["raise", "nan"] = ...,
    as_xarray: Literal[False] = ...,
) -> float | NDArray[np.float64]: ...
@overload
def bihemispherical_reflectance(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    *,
    uncertainty: Literal[False] = ...,
    invalid: Literal["raise", "nan"] = ...,
    as_xarray: Literal[True],
) -> xarray.DataArray: ...
@overload
def bihemispherical_reflectance(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    *,
    uncertainty: Literal[True],
    terms: dict[str, float] | None = None,
    invalid: Literal["raise", "nan"] = ...,
    as_xarray: Literal[False] = ...,
) -> mmbrdf.Evaluation: ...
@overload
def bihemispherical_reflectance(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    *,
    uncertainty: Literal[True],
    terms: dict[str, float] | None = None,
    invalid: Literal["raise", "nan"] = ...,
    as_xarray: Literal[True],
) -> xarray.Dataset: ...
@overload
def bihemispherical_uncertainty(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    *,
    terms: dict[str, float] | None = None,
    by_term: Literal[False] = ...,
    invalid: Literal["raise", "nan"] = ...,
) -> float | NDArray[np.float64]: ...
@overload
def bihemispherical_uncertainty(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    *,
    terms: dict[str, float] | None = None,
    by_term: Literal[True],
    invalid: Literal["raise", "nan"] = ...,
) -> dict[str, float | NDArray[np.float64]]: ...
def budget(parts: dict[str, ArrayLike], degrees_of_freedom: dict[str, float] = {}) -> mmbrdf.Budget: ...
def calibrate(
    references: _Readings,
    *,
    columns: dict[str, str] = {},
    film: tuple[complex, float, complex] | None = None,
    dial_sense: int = 1,
    extinction: float = 0.0,
    refine: bool = True,
    fit_polarizer_phase: bool = False,
    noise: dict[str, float] = {"relative": 0.001},
    saturation: float = ...,
    dials_deg: ArrayLike | None = None,
    retardance_deg: float = 90.0,
    polarizer_near_deg: float | None = None,
) -> Calibration: ...
def change_frame(
    mueller: ArrayLike,
    theta_i_deg: ArrayLike,
    phi_i_deg: ArrayLike,
    theta_r_deg: ArrayLike,
    phi_r_deg: ArrayLike,
    from_frame: str,
    to_frame: str,
    *,
    invalid: Literal["raise", "nan"] = ...,
) -> NDArray[np.float64]: ...
def cloude_decomposition(mueller: ArrayLike, *, invalid: str = "raise") -> mmbrdf.CloudeDecomposition: ...
def co_and_cross_polarized(mueller_sp: ArrayLike) -> mmbrdf.PolarizedBrdf: ...
def co_and_cross_polarized_gradients() -> mmbrdf.PolarizedBrdf: ...
def coherency(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.complex128]: ...
def coherency_eigenvalues(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def certified(
    model: Model,
    wavelength_nm: ArrayLike,
    reflectance: ArrayLike,
    u: ArrayLike,
    theta_i_deg: ArrayLike = 8.0,
) -> Model: ...
@overload
def compare(
    model: Dataset,
    other: Dataset,
    wavelength_nm: ArrayLike | None = None,
    geometry: Sequence[ArrayLike] | None = None,
    *,
    theta_max_deg: float | None = None,
    terms: dict[str, float] | None = None,
    match_deg: float | None = None,
    partners: Sequence[str] = (),
) -> mmbrdf.Comparison: ...
@overload
def compare(
    model: Model,
    other: Dataset | Model,
    wavelength_nm: ArrayLike | None = None,
    geometry: Sequence[ArrayLike] | None = None,
    *,
    as_printed: bool = False,
    theta_max_deg: float | None = None,
    terms: dict[str, float] | None = None,
) -> mmbrdf.Comparison: ...
def condition_number(states: ArrayLike) -> float: ...
def convert(mueller: ArrayLike, from_convention: str, to_convention: str) -> NDArray[np.float64]: ...
def degree_of_polarization(
    mueller: ArrayLike, stokes: ArrayLike, *, invalid: str = "raise"
) -> float | NDArray[np.float64]: ...
def degree_of_polarization_gradient(
    mueller: ArrayLike, stokes: ArrayLike, *, invalid: str = "raise"
) -> NDArray[np.float64]: ...
def depolarization(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def depolarization_gradient(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def depolarization_power(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def depolarization_ratio(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def depolarization_ratio_gradient(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def dial_angles(ratio: float, step_deg: float, frames: int) -> NDArray[np.float64]: ...
def diattenuation(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def diattenuation_gradient(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def diattenuation_vector(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
@overload
def directional_hemispherical_reflectance(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    theta_i_deg: ArrayLike = 0.0,
    phi_i_deg: ArrayLike = 0.0,
    stokes: ArrayLike | None = None,
    *,
    uncertainty: Literal[False] = ...,
    invalid: Literal["raise", "nan"] = ...,
    as_xarray: Literal[False] = ...,
) -> float | NDArray[np.float64]: ...
@overload
def directional_hemispherical_reflectance(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    theta_i_deg: ArrayLike = 0.0,
    phi_i_deg: ArrayLike = 0.0,
    stokes: ArrayLike | None = None,
    *,
    uncertainty: Literal[False] = ...,
    invalid: Literal["raise", "nan"] = ...,
    as_xarray: Literal[True],
) -> xarray.DataArray: ...
@overload
def directional_hemispherical_reflectance(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    theta_i_deg: ArrayLike = 0.0,
    phi_i_deg: ArrayLike = 0.0,
    stokes: ArrayLike | None = None,
    *,
    uncertainty: Literal[True],
    terms: dict[str, float] | None = None,
    invalid: Literal["raise", "nan"] = ...,
    as_xarray: Literal[False] = ...,
) -> mmbrdf.Evaluation: ...
@overload
def directional_hemispherical_reflectance(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    theta_i_deg: ArrayLike = 0.0,
    phi_i_deg: ArrayLike = 0.0,
    stokes: ArrayLike | None = None,
    *,
    uncertainty: Literal[True],
    terms: dict[str, float] | None = None,
    invalid: Literal["raise", "nan"] = ...,
    as_xarray: Literal[True],
) -> xarray.Dataset: ...
@overload
def directional_hemispherical_uncertainty(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    theta_i_deg: ArrayLike = 0.0,
    phi_i_deg: ArrayLike = 0.0,
    stokes: ArrayLike | None = None,
    *,
    terms: dict[str, float] | None = None,
    by_term: Literal[False] = ...,
    invalid: Literal["raise", "nan"] = ...,
) -> float | NDArray[np.float64]: ...
@overload
def directional_hemispherical_uncertainty(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    theta_i_deg: ArrayLike = 0.0,
    phi_i_deg: ArrayLike = 0.0,
    stokes: ArrayLike | None = None,
    *,
    terms: dict[str, float] | None = None,
    by_term: Literal[True],
    invalid: Literal["raise", "nan"] = ...,
) -> dict[str, float | NDArray[np.float64]]: ...
def eigenvalue_min(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def eigenvalue_min_gradient(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def entropy(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def entropy_gradient(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def exchanged(mueller: ArrayLike) -> NDArray[np.float64]: ...
def f_pp(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def f_pp_gradient(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def f_ps(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def f_ps_gradient(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def f_sp(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def f_sp_gradient(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def f_ss(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def f_ss_gradient(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def film_reflection(
    film: tuple[complex, float, complex], wavelength_nm: float, theta_i_deg: ArrayLike
) -> NDArray[np.float64]: ...
def fit(
    data: Dataset,
    basis: str = "isotropic",
    orders: tuple[int, int] = (7, 4),
    *,
    mapping: str = "lambert",
    powers: int | None = None,
    reflectance: dict[float, float] | None = None,
    uncertainty: str = "sample",
    declared: dict[str, float] = ...,
    weights: str | None = None,
    covariance: str = "residuals",
    minimum_norm: bool = False,
    as_printed: bool = False,
    instrument: Calibration | None = None,
    name: str = "",
    attribution: str = "",
) -> FitResult: ...
def germer2017_grid() -> mmbrdf.Geometry: ...
@overload
def hemispherical_directional_reflectance(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    theta_r_deg: ArrayLike = 0.0,
    phi_r_deg: ArrayLike = 0.0,
    analyzer: ArrayLike | None = None,
    *,
    uncertainty: Literal[False] = ...,
    invalid: Literal["raise", "nan"] = ...,
    as_xarray: Literal[False] = ...,
) -> float | NDArray[np.float64]: ...
@overload
def hemispherical_directional_reflectance(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    theta_r_deg: ArrayLike = 0.0,
    phi_r_deg: ArrayLike = 0.0,
    analyzer: ArrayLike | None = None,
    *,
    uncertainty: Literal[False] = ...,
    invalid: Literal["raise", "nan"] = ...,
    as_xarray: Literal[True],
) -> xarray.DataArray: ...
@overload
def hemispherical_directional_reflectance(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    theta_r_deg: ArrayLike = 0.0,
    phi_r_deg: ArrayLike = 0.0,
    analyzer: ArrayLike | None = None,
    *,
    uncertainty: Literal[True],
    terms: dict[str, float] | None = None,
    invalid: Literal["raise", "nan"] = ...,
    as_xarray: Literal[False] = ...,
) -> mmbrdf.Evaluation: ...
@overload
def hemispherical_directional_reflectance(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    theta_r_deg: ArrayLike = 0.0,
    phi_r_deg: ArrayLike = 0.0,
    analyzer: ArrayLike | None = None,
    *,
    uncertainty: Literal[True],
    terms: dict[str, float] | None = None,
    invalid: Literal["raise", "nan"] = ...,
    as_xarray: Literal[True],
) -> xarray.Dataset: ...
@overload
def hemispherical_directional_uncertainty(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    theta_r_deg: ArrayLike = 0.0,
    phi_r_deg: ArrayLike = 0.0,
    analyzer: ArrayLike | None = None,
    *,
    terms: dict[str, float] | None = None,
    by_term: Literal[False] = ...,
    invalid: Literal["raise", "nan"] = ...,
) -> float | NDArray[np.float64]: ...
@overload
def hemispherical_directional_uncertainty(
    model: Model,
    wavelength_nm: ArrayLike | None = None,
    theta_r_deg: ArrayLike = 0.0,
    phi_r_deg: ArrayLike = 0.0,
    analyzer: ArrayLike | None = None,
    *,
    terms: dict[str, float] | None = None,
    by_term: Literal[True],
    invalid: Literal["raise", "nan"] = ...,
) -> dict[str, float | NDArray[np.float64]]: ...
def ideal_polarimeter(retardance_deg: float, azimuths_deg: ArrayLike) -> Polarimeter: ...
def ideal_states(generator: Sequence[str], analyzer: Sequence[str] | None = None) -> Polarimeter: ...
def in_plane(theta_i_deg: float, theta_r_deg: ArrayLike) -> mmbrdf.Geometry: ...
def in_published_form(model: Model) -> Model: ...
def _limit_threads(most: int) -> int: ...
def load_instrument(path: str | os.PathLike[str]) -> Calibration: ...
def load_model(path: str | os.PathLike[str]) -> Model: ...
def lu_chipman(mueller: ArrayLike, *, invalid: str = "raise") -> mmbrdf.LuChipman: ...
def material(name: str) -> Model: ...
def materials() -> list[str]: ...
def mirror_pairs(data: Dataset) -> mmbrdf.MirrorPairs: ...
def mirrored(mueller: ArrayLike) -> NDArray[np.float64]: ...
def model_diagnostics(
    model: Model, wavelength_nm: float | None = None, theta_max_deg: float = 90.0
) -> mmbrdf.ModelDiagnostics: ...
def nearest_realizable(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def normalized(mueller: ArrayLike) -> NDArray[np.float64]: ...
def optimal_angles(retardance_deg: float, states: int) -> NDArray[np.float64]: ...
def orientation_deg(
    mueller: ArrayLike, stokes: ArrayLike, *, invalid: str = "raise"
) -> float | NDArray[np.float64]: ...
def orientation_deg_gradient(
    mueller: ArrayLike, stokes: ArrayLike, *, invalid: str = "raise"
) -> NDArray[np.float64]: ...
def outliers(diagnostics: mmbrdf.SampleDiagnostics, threshold: float = 5.0) -> tuple[mmbrdf.Outlier, ...]: ...
def polarizance(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def polarizance_gradient(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def polarizance_vector(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
@overload
def polarized_curve(
    model: Model,
    wavelength_nm: float | None,
    geometry: Sequence[ArrayLike],
    *,
    as_printed: bool = False,
    uncertainty: Literal[False] = ...,
    invalid: Literal["raise", "nan"] = ...,
) -> mmbrdf.PolarizedBrdf: ...
@overload
def polarized_curve(
    model: Model,
    wavelength_nm: float | None,
    geometry: Sequence[ArrayLike],
    *,
    as_printed: bool = False,
    uncertainty: Literal[True],
    terms: dict[str, float] | None = None,
    invalid: Literal["raise", "nan"] = ...,
) -> mmbrdf.Evaluation: ...
def polarized_uncertainty(
    model: Model,
    wavelength_nm: float | None,
    geometry: Sequence[ArrayLike],
    *,
    as_printed: bool = False,
    terms: dict[str, float] | None = None,
    invalid: Literal["raise", "nan"] = ...,
) -> mmbrdf.PolarizedBrdf: ...
def polarizer(azimuth_deg: ArrayLike, extinction: ArrayLike = 0.0) -> NDArray[np.float64]: ...
def projected_on_isotropic(model: Model, orders: tuple[int, int] = (7, 4)) -> Model: ...
def purity(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def purity_gradient(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def quantities() -> tuple[mmbrdf.Quantity, ...]: ...
def random_geometries(count: int, seed: int, theta_max_deg: float = 75.0) -> mmbrdf.Geometry: ...
def inspect(data: Dataset) -> mmbrdf.Inspection: ...
def read_foreign(path: str | os.PathLike[str], wavelength_nm: ArrayLike | None = None) -> Dataset: ...
def read_samples(
    path: str | os.PathLike[str],
    *,
    columns: dict[str, str] = {},
    skip_incomplete: bool = False,
    frame: str | None = None,
    convention: str = "germer2017",
) -> Dataset: ...
def realizability_margin(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def realizability_margin_gradient(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def realizable(mueller: ArrayLike, *, invalid: str = "raise") -> bool | NDArray[np.bool_]: ...
def reduce(
    raw: _Readings,
    instrument: Calibration | Polarimeter,
    *,
    solid_angle: float,
    columns: dict[str, str] = {},
    noise: dict[str, float] = {"relative": 0.001},
    saturation: float = ...,
) -> Dataset: ...
@overload
def reflectance_factor(f11: xarray.DataArray) -> xarray.DataArray: ...
@overload
def reflectance_factor(f11: ArrayLike) -> float | NDArray[np.float64]: ...
def report_json(
    model: Model,
    name: str,
    wavelength_nm: Sequence[float] | None = None,
    data: Dataset | None = None,
    data_name: str = "samples",
    terms: dict[str, float] | Sequence[str] | None = None,
) -> str: ...
def residuals(model: Model, data: Dataset, *, as_printed: bool = False) -> NDArray[np.float64]: ...
def retardance(mueller: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def retarder(retardance_deg: ArrayLike, azimuth_deg: ArrayLike = 0.0) -> NDArray[np.float64]: ...
def rotating_retarders(
    dials_deg: ArrayLike,
    *,
    retardance_deg: ArrayLike = 90.0,
    offset_deg: ArrayLike = 0.0,
    polarizer_deg: ArrayLike = 0.0,
    diattenuation: ArrayLike = 0.0,
    extinction: float = 0.0,
) -> Polarimeter: ...
def rotator(angle_deg: ArrayLike) -> NDArray[np.float64]: ...
def sample_diagnostics(result: FitResult, data: Dataset) -> mmbrdf.SampleDiagnostics: ...
def scattered_S1(mueller: ArrayLike, stokes: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def scattered_S1_gradient(mueller: ArrayLike, stokes: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def scattered_S2(mueller: ArrayLike, stokes: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def scattered_S2_gradient(mueller: ArrayLike, stokes: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def scattered_S3(mueller: ArrayLike, stokes: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def scattered_S3_gradient(mueller: ArrayLike, stokes: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def scattered_S4(mueller: ArrayLike, stokes: ArrayLike, *, invalid: str = "raise") -> float | NDArray[np.float64]: ...
def scattered_S4_gradient(mueller: ArrayLike, stokes: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def plan(
    designs: dict[str, Sequence[ArrayLike]],
    *,
    like: Model | None = None,
    wavelength_nm: float | None = None,
    noise: float | None = None,
    targets: Sequence[str] = (),
) -> mmbrdf.Plan: ...
def choose(
    count: int,
    candidates: Sequence[ArrayLike],
    *,
    design: Sequence[ArrayLike] | None = None,
    like: Model | None = None,
    wavelength_nm: float | None = None,
    noise: float | None = None,
    targets: Sequence[str] = (),
) -> NDArray[np.int64]: ...
def select(
    data: Dataset,
    basis: str = "isotropic",
    *,
    mapping: str = "lambert",
    orders_f11: tuple[int, int] | None = None,
    orders_other: tuple[int, int] | None = None,
    powers: tuple[int, int] | None = None,
    folds: int = 3,
    random_folds: bool = False,
    seed: int = 1,
    leave_out: str | None = None,
    reflectance: dict[float, float] | None = None,
    weights: str = "none",
) -> mmbrdf.Selection: ...
def simulate(
    model: Model, wavelength_nm: ArrayLike, geometry: Sequence[ArrayLike], *, speckle: float = 0.0, seed: int = 0
) -> Dataset: ...
def smallest_eigenvalue_gradient(mueller: ArrayLike, *, invalid: str = "raise") -> NDArray[np.float64]: ...
def standard_uncertainty(gradient: ArrayLike, covariance: ArrayLike) -> float | NDArray[np.float64]: ...
def subsets(
    data: Dataset,
    basis: str = "isotropic",
    orders: tuple[int, int] = (7, 4),
    *,
    k: int = 3,
    random: bool = False,
    splits: int = 1,
    seed: int = 0,
    wavelength_nm: float | None = None,
    theta_i_deg: float = 45.0,
    theta_r_deg: ArrayLike | None = None,
    mapping: str = "lambert",
    as_printed: bool = False,
    weights: str = "none",
    reference: Model | None = None,
) -> mmbrdf.Subsets: ...
def symmetric_decomposition(mueller: ArrayLike, *, invalid: str = "raise") -> mmbrdf.SymmetricDecomposition: ...
def symmetry_tests(
    data: Dataset, orders: tuple[int, int] = (7, 4), *, mapping: str = "lambert"
) -> mmbrdf.SymmetryTests: ...
