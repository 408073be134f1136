# SPDX-License-Identifier: BSD-3-Clause
"""Field radiometry: what a white plaque really reflects, and what that does to a target.

The radiance of a target is divided by that of a plaque, measured right after it under the same sun. That is the target's
reflectance factor only if the plaque is Lambertian with reflectance 1. It is neither: its factor depends on where the sun
stands and from where it is seen, and the sky adds light from everywhere. This computes it, with its uncertainty.

    python3 examples/python/plaque_correction.py
"""

import numpy as np

import mmbrdf

WAVELENGTH_NM = 633
VIEW_DEG = 10  # the radiometer looks 10 degrees off nadir, across the plane of the sun, so that it casts no shadow
SKY = 0.12  # share of the sky in the irradiance of the plaque
SCALE = 0.005  # standard uncertainty of the plaque's certified reflectance, relative: the same in all measurements
CERTIFIED = 0.985  # the plaque's own 8 degrees : hemisphere reflectance; the model scatters as it does, scaled to it


def plaque_factor(model: mmbrdf.Model, sun_zenith_deg: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Reflectance factor of the plaque under sun and sky, and its standard uncertainty: shape of sun_zenith_deg."""
    geometry = (sun_zenith_deg, 0, VIEW_DEG, 90)
    scale = CERTIFIED / mmbrdf.directional_hemispherical_reflectance(model, WAVELENGTH_NM, theta_i_deg=8)
    sun = np.pi * model.evaluate(WAVELENGTH_NM, *geometry)[..., 0, 0]
    u_sun = np.pi * model.evaluate_uncertainty(WAVELENGTH_NM, *geometry)[..., 0, 0]
    sky = mmbrdf.hemispherical_directional_reflectance(model, WAVELENGTH_NM, theta_r_deg=VIEW_DEG)
    u_sky = mmbrdf.hemispherical_directional_uncertainty(model, WAVELENGTH_NM, theta_r_deg=VIEW_DEG)
    factor = scale * ((1 - SKY) * sun + SKY * sky)
    # Both parts come from one fit: their errors are added as if they were the same one, which is the larger answer.
    of_fit = scale * ((1 - SKY) * u_sun + SKY * u_sky)
    return factor, np.hypot(of_fit, SCALE * factor)


def main() -> None:
    plaque = mmbrdf.material("ptfe")
    sun = np.array([10, 20, 30, 40, 50, 60, 70])
    factor, u = plaque_factor(plaque, sun)
    ratio = 0.30  # radiance of the target over that of the plaque
    print(f"{WAVELENGTH_NM} nm, seen from {VIEW_DEG} degrees, {SKY:.0%} of the light from the sky")
    print("sun zenith  plaque factor  standard unc.   target, plaque taken as 1   target, corrected")
    for angle, one, its_u in zip(sun, factor, u):
        print(f"{angle:7d} deg  {one:13.4f}  {its_u:13.4f}  {ratio:26.4f}  {ratio * one:11.4f} +- {ratio * its_u:.4f}")
    largest = np.abs(factor - 1).max()
    print(f"A plaque taken for a perfect diffuser is wrong by up to {largest:.1%} here.")

    # A radiometer that responds to polarization sees another factor: the light from the plaque is partly polarized.
    f = plaque.evaluate(WAVELENGTH_NM, 60, 0, VIEW_DEG, 90, frame="scattering_plane")
    print(
        f"Polarization of the plaque's light, sun at 60 degrees: {f[1, 0] / f[0, 0]:+.2%} across the scattering plane"
    )


if __name__ == "__main__":
    main()
