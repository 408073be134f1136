# SPDX-License-Identifier: BSD-3-Clause
"""Fit goniometer data, look at what is left, and keep the model.

    python3 examples/python/fit_your_data.py [DATA.csv]

Without a file it makes data: a simulated measurement at the published geometries, with 1 % of speckle.
"""

import sys

import numpy as np

import mmbrdf


def example_data() -> mmbrdf.Dataset:
    """Arrays of your own become a Dataset in the same way."""
    ptfe = mmbrdf.material("ptfe")
    measured = mmbrdf.simulate(ptfe, 532, mmbrdf.germer2017_grid(), speckle=0.01, seed=1)
    return mmbrdf.Dataset(
        measured.wavelength_nm, *measured.geometry, measured.mueller, frame="xy"  # theta_i, phi_i, theta_r, phi_r
    )


def main(arguments: list[str]) -> None:
    data = mmbrdf.load(arguments[0]) if arguments else example_data()
    print(data)

    # Noise of speckle grows towards grazing angles: weights that say so, estimated from the data themselves.
    result = mmbrdf.fit(data, weights="estimated", name="my sample")
    print(result)
    for law in result.noise:
        print(f"noise at {law['wavelength_nm']:g} nm: {law['scale']:.4f} at normal incidence")

    # Does a simpler model do? Leave every third sample out and predict it.
    for orders in ((4, 2), (7, 4), (9, 6)):
        part = mmbrdf.fit(
            data[np.arange(len(data)) % 3 > 0], orders=orders, minimum_norm=True, uncertainty="noise"
        ).model
        left_out = mmbrdf.residuals(part, data[::3])[:, 1:, 1:]
        print(f"orders {orders}: rms of what was left out {np.sqrt((left_out**2).mean()):.5f}")

    # Where is the worst sample, and by how many of its own standard deviations is it off?
    worst = np.abs(result.residuals[:, 1, 1]).argmax()
    print(f"largest residual of m22: {result.residuals[worst, 1, 1]:+.4f} at theta_i {data.theta_i_deg[worst]:.0f}, "
          f"theta_r {data.theta_r_deg[worst]:.1f} degrees")  # fmt: skip

    result.model.save("my_sample.json")
    print("saved:", mmbrdf.load("my_sample.json"))


if __name__ == "__main__":
    main(sys.argv[1:])
