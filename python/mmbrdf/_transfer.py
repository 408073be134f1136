# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces as codes of radiative transfer that are Python packages take them."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._calls import told_in_a_line
from ._warnings import warn

if TYPE_CHECKING:
    from . import Model

# Signs of m12, m21 and m22 in a BRDF between linear polarizations, of which the first is incident.
_CHANNELS = {"f_ss": (1, 1, 1), "f_sp": (1, -1, -1), "f_ps": (-1, 1, -1), "f_pp": (-1, -1, 1)}

_Mode = Callable[[Any, Any], np.ndarray]


def _of_channel(m: np.ndarray, channel: str) -> np.ndarray:
    if channel == "f11":
        return m[..., 0, 0]
    if channel not in _CHANNELS:
        raise ValueError(f"channel = {channel!r}, must be f11, {', '.join(_CHANNELS)}")
    a, b, c = _CHANNELS[channel]
    return (m[..., 0, 0] + a * m[..., 0, 1] + b * m[..., 1, 0] + c * m[..., 1, 1]) / 2


@told_in_a_line("pythonic_disort_modes")
def pythonic_disort_modes(
    model: Model, wavelength_nm: float | None = None, *, streams: int, moments: int = 0, channel: str = "f11"
) -> list[_Mode]:
    """What pydisort of PythonicDISORT takes as BDRF_Fourier_modes: a function of (mu, mu_p) for each m.

        modes = mmbrdf.pythonic_disort_modes(ptfe, 532, streams=16)
        pydisort(..., NQuad=16, BDRF_Fourier_modes=modes)

    Each gives pi times the moment of the BRDF, shape (len(mu), len(mu_p)), at any cosines of the reflected and incident
    directions, exactly: weight 1 for each m, azimuth 0 is forward, so that the moment of phi_r - phi_i has the factor
    (-1)^m. The modes that the model has not are left out. Warns (ExtrapolationWarning) of the wavelength and the streams, and
    each function of the cosines that it is given, as Model.fourier_moments does.

    streams  NQuad, of both hemispheres together: even. It carries NQuad moments
    moments  how many to give, at most streams; 0: as many as there are and the quadrature carries, with a UserWarning if
             that leaves some out
    channel  f11, f_ss, f_sp, f_ps or f_pp, the first letter incident

    Raises ValueError for more moments than the quadrature carries, for a channel but f11 of a model that is not its own mirror
    image, whose sines have no place here, and as Model.fourier_moments does.
    """
    if streams < 2 or streams % 2:
        raise ValueError(f"streams = {streams}, must be even and at least 2, as NQuad of both hemispheres")
    if not 0 <= moments <= streams:
        raise ValueError(f"{moments} moments: a quadrature of {streams} streams carries 0 to {streams}")
    _of_channel(np.zeros((1, 4, 4)), channel)
    cosines = (np.polynomial.legendre.leggauss(streams // 2)[0] + 1) / 2
    present = model.fourier_moments(wavelength_nm, cosines, cosines).cosine.shape[2]
    if channel != "f11" and not model._is_its_own_mirror_image():
        raise ValueError(
            f"channel = {channel!r}: the model is not its own mirror image, and its sines of phi_r - phi_i have no place in "
            "PythonicDISORT"
        )
    if moments == 0 and present > streams:
        warn(
            f"{streams} of the model's {present} moments: a quadrature of {streams} streams carries no more, "
            f"{present - streams} are left out"
        )

    def mode(m: int) -> _Mode:
        def value(mu: Any, mu_p: Any) -> np.ndarray:
            reflected, incident = np.abs(np.atleast_1d(mu)).ravel(), np.abs(np.atleast_1d(mu_p)).ravel()
            cosine = model.fourier_moments(wavelength_nm, incident, reflected).cosine
            return (-1) ** m * np.pi * _of_channel(cosine[:, :, m], channel)

        return value

    return [mode(m) for m in range(min(present, moments or streams))]


@told_in_a_line("py6s_surface")
def py6s_surface(
    model: Model,
    wavelength_nm: float | None = None,
    *,
    sun_deg: float,
    view_deg: float,
    azimuth_deg: float,
    channel: str = "f11",
) -> dict[str, Any]:
    """What Py6S takes of a surface, by name: GroundReflectance.HomogeneousUserDefined(**py6s_surface(...)).

    sun_deg, view_deg  polar angles; azimuth_deg  phi_r - phi_i, 0 on the side of the sun
    channel            f11, or a quantity in sr^-1 of the model's matrices

    observed_reflectance and albedo are numbers; ro_sun_at_thetas and ro_sun_at_thetav arrays (13, 10), a row for each azimuth
    0 to 360 by 30, from that of the scene, of pi times the BRDF at the zeniths 0, 10 to 80, 85. Warns (ExtrapolationWarning) once of
    what in the scene and the tables is outside the fitted range. Raises ValueError as Model.export does.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "surface.6s")
        model.export(
            path,
            "6s",
            wavelength_nm=wavelength_nm,
            channel=channel,
            sun_deg=sun_deg,
            view_deg=view_deg,
            azimuth_deg=azimuth_deg,
        )
        with open(path, encoding="utf-8") as lines:
            rows = [[float(x) for x in line.split()] for line in list(lines)[3:]]
    turns, zeniths = np.meshgrid(range(0, 361, 30), [*range(0, 90, 10), 85], indexing="ij")
    for_sun, for_view = np.full(130, sun_deg), np.full(130, view_deg)
    model.evaluate(  # warns once
        wavelength_nm,
        np.concatenate([[sun_deg], for_sun, for_view]),
        0,
        np.concatenate([[view_deg], zeniths.ravel(), zeniths.ravel()]),
        np.concatenate([[azimuth_deg], azimuth_deg + turns.ravel(), turns.ravel() - azimuth_deg]),
    )
    return {
        "observed_reflectance": rows[27][0],
        "albedo": rows[26][0],
        "ro_sun_at_thetas": np.array(rows[:13]),
        "ro_sun_at_thetav": np.array(rows[13:26]),
    }
