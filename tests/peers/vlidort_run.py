# SPDX-License-Identifier: BSD-3-Clause
"""VLIDORT itself over surfaces that are exports: Stokes vectors at the top of an atmosphere that is nearly none, and of one that
scatters and sends polarized light down from everywhere."""
import pathlib
import tempfile

import layer
import numpy as np
import peer

import mmbrdf

WAVELENGTH, STREAMS = 532, 8
SUNS, VIEWS, AZIMUTHS = np.array([0, 40, 80]), np.array([0, 30, 55, 75]), np.array([0, 35, 90, 150, 180, 250])
NONE, THICK = 1e-12, 0.3
OF_VLIDORT = np.array([1, -1, 1, -1])  # Q > 0 along the meridian plane, V > 0 right-handed
ALL = 2 * STREAMS - 1
ENDS_AFTER = 9  # it adds moments until those of I have been nothing twice, and f11 here has none beyond 7
DIGITS = 3e-9  # of ten that an export has, up to 5e-10 of an element; and an asymmetry of 0 it takes for 1e-9
ROTATED = 3e-8  # of light scattered once, exactly: it makes sines of cosines, so U in the plane of the sun has half the digits


def forward():
    """A lobe about the specular direction that is polarized and retarded in the scattering plane: all elements are there."""
    theta_i, phi_i, theta_r, phi_r = peer.geometries(82, 3000)
    lobe = np.sum(peer.direction(theta_i, phi_i + 180) * peer.direction(theta_r, phi_r), -1)
    matrix = np.array([[1, 0.3, 0, 0], [0.3, 0.9, 0, 0], [0, 0, 0.5, 0.6], [0, 0, -0.6, 0.5]]) * np.ones((3000, 1, 1))
    sideways = np.sin(np.radians(theta_i)) * np.sin(np.radians(theta_r)) * np.sin(np.radians(phi_r - phi_i))
    matrix[:, 0, 3], matrix[:, 3, 0] = 0.3 * sideways, -0.3 * sideways
    f11 = (0.2 + 1.5 * np.exp(3 * (lobe - 1))) / np.pi
    matrix *= f11[:, None, None]
    data = mmbrdf.Dataset(WAVELENGTH, theta_i, phi_i, theta_r, phi_r, matrix, frame="scattering_plane")
    return mmbrdf.fit(data, uncertainty="noise").model


def greek(electric, magnetic):
    """beta, alpha, zeta, delta, gamma, epsilon of l = 0, 1, 2 for the particles of layer.py."""
    size = abs(electric) ** 2 + abs(magnetic) ** 2
    product = electric * np.conj(magnetic) / size
    gamma = -np.sqrt(6) / 2 * (abs(electric) ** 2 - abs(magnetic) ** 2) / size
    even, turning = product.real, np.sqrt(6) * product.imag
    return [1, 0, 0, 2 * even, 0, 0, 3 * even, 0, 0, 1.5, 0, 0, 0.5, 3, 6 * even, even, gamma, turning]


def ask(words, model, layers, albedo, exact):
    """Stokes vectors (layer, sun, azimuth, view, 4) at the top; albedo -1: the surface is the export."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "surface.vlidort"
        angles = {"sun_deg": SUNS, "view_deg": VIEWS, "azimuth_deg": AZIMUTHS}
        model.export(file, "vlidort", wavelength_nm=WAVELENGTH, streams=STREAMS, **angles)
        rows = [[depth, scattering, albedo, exact, *greek(*dipoles)] for depth, scattering, *dipoles in layers]
        return peer.ask([*words, str(file)], rows).reshape(len(layers), len(SUNS), len(AZIMUTHS), len(VIEWS), 4)


def brdf(model):
    """Of cosines and azimuths of travel, as layer.py asks it."""

    def of_travel(mu_i, mu_r, phi):
        theta_i, theta_r = np.degrees(np.arccos(mu_i)), np.degrees(np.arccos(mu_r))
        return model.evaluate(WAVELENGTH, theta_i, 0, theta_r, np.degrees(phi) + 180, frame="sp")

    return of_travel


def solved(model, one, highest):
    """Stokes vectors (sun, azimuth, view, 4) of layer.py."""
    cosines, views, azimuths = np.cos(np.radians(SUNS)), np.cos(np.radians(VIEWS)), np.radians(AZIMUTHS - 180)
    found = [layer.radiance(brdf(model), one, STREAMS, sun, views, azimuths, highest) for sun in cosines]
    return np.array(found) * OF_VLIDORT


def reflected(model):
    """Of sunlight alone, without an atmosphere."""
    matrices = model.evaluate(WAVELENGTH, SUNS[:, None, None], 0, VIEWS, AZIMUTHS[:, None], frame="sp")
    return np.cos(np.radians(SUNS))[:, None, None, None] * matrices[..., 0] * OF_VLIDORT


def main():
    words = peer.command("MMBRDF_PEER_VLIDORT_RUN", "a program that runs VLIDORT over an export")
    rayleigh, retarding = (1, 0), (1, 0.3 + 0.4j)
    none, thick = [(NONE, 0.9, *rayleigh)], [(THICK, 0.9, *rayleigh), (THICK, 0.9, *retarding)]
    models = {"Lambertian": peer.lambertian(0.3), "ptfe-532": mmbrdf.material("ptfe-532"), "forward lobe": forward()}

    def judge(what, found, expected, limit):
        deviations = np.ravel((found - expected) / expected[..., :1])
        peer.judge("VLIDORT", what, deviations, limit, limit, "Stokes components", "I")

    for exact, how, highest, limit in ((1, "exact", ALL, ROTATED), (0, "by moments", ENDS_AFTER, DIGITS)):
        own, diffuser = (ask(words, models["Lambertian"], thick, albedo, exact) for albedo in (0.3, -1))
        judge(f"Lambertian, its own, first order {how}", diffuser, own, DIGITS)
        for name, model in models.items():
            expected = reflected(model) if exact else solved(model, none[0], highest)
            judge(f"{name}, no air, first order {how}", ask(words, model, none, -1, exact)[0], expected, DIGITS)
            expected = np.array([solved(model, one, highest) for one in thick])
            judge(f"{name} below 0.3, first order {how}", ask(words, model, thick, -1, exact), expected, limit)


main()
