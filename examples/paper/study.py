# SPDX-License-Identifier: BSD-3-Clause
"""The data of Germer (2017), or simulated ones in their place, the paper's fits, and the numbers it states."""
from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

import mmbrdf

WAVELENGTHS_NM = (351.0, 532.0, 633.0, 1064.0)
INCIDENT_DEG = (0.0, 15.0, 30.0, 45.0, 60.0, 75.0)
SUBSET_NM = 532.0
MANUFACTURER = {351: 0.976, 532: 0.984, 633: 0.984, 1064: 0.983}
"""Directional-hemispherical reflectance at normal incidence that the paper divides f11 by, section 4."""

SPECKLE = {351.0: 0.0045, 532.0: 0.0051, 633.0: 0.0070, 1064.0: 0.0112}
"""Noise of simulated data by wavelength: sigma / sqrt(cos(theta_i) / cos(theta_r)), as in the published data."""

PUBLISHED, ISOTROPIC = "germer2017", "isotropic"
ALL = "all wavelengths"


@dataclass
class Study:
    """Data sets and all fits to them; a fit is made when it is first asked for."""

    grid: mmbrdf.Dataset
    random: mmbrdf.Dataset
    simulated: bool
    folder: Path | None = None
    _fits: dict = field(default_factory=dict)

    def model(self, basis: str, wavelength_nm: float | str):
        """The fit to the grid at one wavelength in nm, or ``ALL``: at all of them, linear in the wavelength."""
        key = basis, wavelength_nm
        if key not in self._fits:
            several = wavelength_nm == ALL
            data = self.grid if several else self.grid.at_wavelengths([wavelength_nm])
            name = f"{basis}, {ALL if several else f'{wavelength_nm:g} nm'}"
            self._fits[key] = fit(data, basis, name, reflectance=MANUFACTURER if several else None)
        return self._fits[key]

    def parts(self, basis: str) -> list:
        """Fits to every third random direction. With the published basis at the azimuths as they are, as the paper's
        numbers show that it was done: theory.md, and the report beside the figures."""
        if ("parts", basis) not in self._fits:
            self._fits["parts", basis] = [
                fit(self.random[first::3], basis, f"{basis}, part {first + 1} of 3", as_printed=basis == PUBLISHED)
                for first in range(3)
            ]
        return self._fits["parts", basis]

    @cached_property
    def predictions(self) -> dict[str, np.ndarray]:
        """rms of what three ways to evaluate the fit to the grid leave of the random directions: (4, 4) each."""
        published, isotropic = (self.model(basis, SUBSET_NM) for basis in (PUBLISHED, ISOTROPIC))
        ways = {
            "germer2017, as printed": (published, True),
            "germer2017, turned": (published, False),
            "isotropic": (isotropic, False),
        }
        return {
            name: rms(mmbrdf.residuals(model, self.random, as_printed=printed))
            for name, (model, printed) in ways.items()
        }


def load(folder: Path | None) -> Study:
    """The published data in a folder, or simulated data where it has none. Raises OSError for files that are others."""
    if folder is not None and (folder / "PTFE.data.csv").exists():
        grid = _read(folder / "PTFE.data.csv", WAVELENGTHS_NM)
        random = _read(folder / "PTFE.data.random.csv", (SUBSET_NM,))
        return Study(grid, random, simulated=False, folder=folder)
    ptfe = mmbrdf.material("ptfe")
    grids = [
        mmbrdf.simulate(ptfe, wavelength, mmbrdf.germer2017_grid(), speckle=SPECKLE[wavelength], seed=seed)
        for seed, wavelength in enumerate(WAVELENGTHS_NM)
    ]
    grid = mmbrdf.Dataset(
        *(
            np.concatenate([getattr(each, name) for each in grids])
            for name in ("wavelength_nm", "theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg", "mueller")
        )
    )
    random = mmbrdf.simulate(ptfe, SUBSET_NM, mmbrdf.random_geometries(1760, seed=10), speckle=0.0093, seed=11)
    return Study(grid, random, simulated=True)


def _read(path: Path, wavelengths_nm: tuple[float, ...]):
    """Samples at these wavelengths."""
    data = mmbrdf.read_samples(path)
    if data.wavelengths_nm != wavelengths_nm:
        expected, found = (", ".join(f"{nm:g}" for nm in each) for each in (wavelengths_nm, data.wavelengths_nm))
        raise OSError(f"{path}: has samples at {found} nm, expected {expected} nm")
    return data


def fit(data, basis: str, name: str, *, reflectance=None, as_printed: bool = False):
    """A model of orders 7 and 4, as everywhere in the paper."""
    return mmbrdf.fit(
        data, basis=basis, orders=(7, 4), reflectance=reflectance, as_printed=as_printed, name=name, uncertainty="noise"
    ).model


def rms(residuals: np.ndarray) -> np.ndarray:
    """Root mean square over the samples, (N, 4, 4) to (4, 4)."""
    return np.sqrt(np.mean(np.square(residuals), axis=0))


def pooled(by_element: np.ndarray, elements: str | None = None) -> float:
    """Root mean square over elements, given as "12,21"; without them over the 15 that are divided by f11."""
    chosen = np.ones((4, 4), bool) if elements is None else np.zeros((4, 4), bool)
    chosen[0, 0] = False
    for element in elements.split(",") if elements else ():
        chosen[int(element[0]) - 1, int(element[1]) - 1] = True
    return float(np.sqrt(np.mean(np.square(by_element[chosen]))))


def rms_table(study: Study):
    """Rows (basis, fit, wavelength in nm, (4, 4) rms of the residuals: f11 in sr^-1, others divided by f11)."""
    for basis in (PUBLISHED, ISOTROPIC):
        for kind in ("one wavelength", ALL):
            left = []
            for wavelength in WAVELENGTHS_NM:
                model = study.model(basis, ALL if kind == ALL else wavelength)
                left.append(mmbrdf.residuals(model, study.grid.at_wavelengths([wavelength])))
                yield basis, kind, f"{wavelength:g}", rms(left[-1])
            yield basis, kind, "351-1064", rms(np.concatenate(left))


def reflectance_table(study: Study):
    """Rows (basis, fit, wavelength in nm, DHR at 0, 8, 45, 60, 75 degrees, BHR, standard uncertainty of the first)."""
    for basis in (PUBLISHED, ISOTROPIC):
        for kind in ("one wavelength", ALL):
            for wavelength in WAVELENGTHS_NM:
                model = study.model(basis, ALL if kind == ALL else wavelength)
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)
                    values = [
                        float(mmbrdf.directional_hemispherical_reflectance(model, wavelength, theta_i_deg=theta))
                        for theta in (0, 8, 45, 60, 75)
                    ]
                    values += [
                        float(mmbrdf.bihemispherical_reflectance(model, wavelength)),
                        float(mmbrdf.directional_hemispherical_uncertainty(model, wavelength)),
                    ]
                yield basis, kind, f"{wavelength:g}", values


def subset_numbers(parts: list, reference) -> dict[str, float]:
    """The three numbers of section 5, in percent: at theta_i = 45 and theta_r = -60 ... 60 degrees in steps of 1.

    mean_distance and largest_distance are of |mean of the parts / reference - 1|, over angles and the four curves;
    deviation is the mean of the parts' standard deviation, with one degree of freedom less than parts, by reference.
    """
    geometry = mmbrdf.in_plane(45.0, np.arange(-60.0, 61.0))
    thick = np.array(mmbrdf.polarized_curve(reference, SUBSET_NM, geometry))
    thin = np.array([mmbrdf.polarized_curve(part, SUBSET_NM, geometry) for part in parts])
    distance = np.abs(thin.mean(axis=0) / thick - 1)
    return {
        "mean_distance": 100 * float(distance.mean()),
        "largest_distance": 100 * float(distance.max()),
        "deviation": 100 * float((thin.std(axis=0, ddof=1) / thick).mean()),
    }


def depolarization_around(model, wavelength_nm: float, theta_r_deg: float = 75.0, steps: int = 72):
    """Azimuths of detection in degrees, and Gil and Bernabeu's parameter there at normal incidence."""
    phi_r_deg = np.arange(steps) * 360 / steps
    return phi_r_deg, mmbrdf.depolarization(model.evaluate(wavelength_nm, 0.0, 180.0, theta_r_deg, phi_r_deg))


def fourfold_amplitude(model, wavelength_nm: float, theta_r_deg: float = 75.0) -> float:
    """Amplitude of cos(4 phi_r) in the depolarization parameter at normal incidence: 0 for an isotropic sample."""
    phi_r_deg, values = depolarization_around(model, wavelength_nm, theta_r_deg)
    return float(2 * np.abs(np.mean(values * np.exp(-4j * np.radians(phi_r_deg)))))


def largest_coefficient_difference(model, published) -> float:
    """Largest difference between coefficients of two models with the same modes."""

    def by_mode(each):
        return {
            tuple(mode): np.atleast_2d(block.coefficients)[:, place]
            for block in each.blocks
            for place, mode in enumerate(block.modes)
        }

    ours, theirs = by_mode(model), by_mode(published)
    if ours.keys() != theirs.keys():
        raise ValueError("the models have different modes")
    return float(max(np.abs(ours[mode] - theirs[mode]).max() for mode in ours))
