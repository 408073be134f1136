# SPDX-License-Identifier: BSD-3-Clause
"""libbsdf's lbconv on ASTM and Zemax text: its .ddr has pi f at directions about the specular ray."""
import pathlib
import tempfile

import numpy as np
import peer

import mmbrdf

WAVELENGTH = 532
DIGITS = 1e-5  # .ddr has six


def read_ddr(text):
    """Incident polar angles, azimuths and polar angles about the specular ray in degrees, and the values over them."""
    words = iter(" ".join(line for line in text.splitlines() if not line.startswith(";;")).split())
    axes = {}
    for word in words:
        if word in ("sigma", "phi", "theta"):
            axes[word] = np.array([float(next(words)) for _ in range(int(next(words)))])
        if word == "def":
            break
    shape = [len(axes[name]) for name in ("sigma", "phi", "theta")]
    values = np.array([float(next(words)) for _ in range(int(np.prod(shape)))]).reshape(shape)
    return axes["sigma"], axes["phi"], axes["theta"], values


def check(convert, version, ending, format):
    model = mmbrdf.material("ptfe")
    with tempfile.TemporaryDirectory() as folder:
        table, made = pathlib.Path(folder) / f"ptfe.{ending}", pathlib.Path(folder) / "ptfe.ddr"
        rms, largest, limit = peer.interpolation(model.export(table, format, wavelength_nm=WAVELENGTH))
        peer.run(convert + [str(table), str(made)])
        sigma, phi, theta, values = read_ddr(made.read_text())
    i, j, k = np.meshgrid(*map(np.arange, values.shape), indexing="ij")
    about = peer.direction(theta[k], phi[j])  # z is the specular ray, azimuth 0 points to the normal
    c, s = np.cos(np.radians(sigma[i])), np.sin(np.radians(sigma[i]))
    out = np.stack([c * about[..., 0] - s * about[..., 2], about[..., 1], s * about[..., 0] + c * about[..., 2]], -1)
    theta_r = np.degrees(np.arccos(np.clip(out[..., 2], -1, 1)))
    # Nodes crowd about the specular ray: each is drawn by its projected solid angles, as geometries() draws directions.
    weight = np.sin(2 * np.radians(sigma[i])) * np.sin(np.radians(theta[k])) * np.gradient(theta)[k] * out[..., 2]
    weight = np.where((theta_r <= limit) & (sigma[i] <= limit), weight, 0).ravel()
    chosen = np.random.default_rng(1).choice(weight.size, 1000, replace=False, p=weight / weight.sum())
    theta_i, theta_r = sigma[i].ravel()[chosen], theta_r.ravel()[chosen]
    phi_r = np.degrees(np.arctan2(out[..., 1], out[..., 0])).ravel()[chosen]
    f11 = model.evaluate(WAVELENGTH, theta_i, 0, theta_r, phi_r)[:, 0, 0]
    deviations = values.ravel()[chosen] / np.pi / f11 - 1
    peer.judge(version, f"{format} to .ddr, f11", deviations, rms + DIGITS, largest + DIGITS)


def main():
    convert = peer.command("MMBRDF_PEER_LBCONV", "libbsdf's lbconv")
    version = peer.run(convert + ["--version"]).strip().removeprefix("Version: ")
    check(convert, version, "astm", "astm")
    check(convert, version, "bsdf", "zemax")


main()
