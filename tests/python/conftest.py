# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the Python package share."""

import functools
import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import mmbrdf


@pytest.fixture(scope="session")
def ptfe():
    return mmbrdf.material("ptfe")


@pytest.fixture(scope="session")
def samples(ptfe):
    """Simulated at the published geometries, with noise: 1824 samples at 532 nm."""
    return mmbrdf.simulate(ptfe, 532, mmbrdf.germer2017_grid(), speckle=0.01, seed=1)


@pytest.fixture(scope="session")
def anisotropic():
    """A model that depends on the azimuth of the source, in f11 and in what is divided by it."""
    geometry = mmbrdf.random_geometries(2000, seed=3)
    turned = np.sin(np.radians(geometry.theta_i_deg)) ** 2 * np.cos(2 * np.radians(geometry.phi_i_deg))
    mueller = np.diag([0.3, 0.1, 0.1, 0.0]) + 0.1 * turned[:, None, None] * np.diag([1.0, 0.0, 0.0, 0.0])
    return mmbrdf.fit(mmbrdf.Dataset(532, *geometry, mueller), "anisotropic", (2, 2), name="brushed").model


@pytest.fixture
def printed_by(tmp_path):
    """Runs a command in a folder of its own; returns what it prints."""

    def run(*command):
        done = subprocess.run(list(map(str, command)), cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.fixture
def program(printed_by):
    """Runs the program with some arguments; returns what it prints."""
    return functools.partial(printed_by, os.environ["MMBRDF_PROGRAM"])


@pytest.fixture(scope="session")
def published():
    """The folder of the published data; skips the test where there is none."""
    for folder in (os.environ.get("MMBRDF_DATA"), Path(__file__).parents[3] / "shared/data/germer2017"):
        if folder and (Path(folder) / "PTFE.data.csv").is_file():
            return Path(folder)
    pytest.skip("the published data are not here: set MMBRDF_DATA")


@pytest.fixture
def random_matrices():
    """Realizable matrices (5, 7, 4, 4) that depolarize, with M11 of about 1: mixtures of five random Jones matrices."""
    random = np.random.default_rng(1)
    to_mueller = np.array([[1, 0, 0, 1], [1, 0, 0, -1], [0, 1, 1, 0], [0, 1j, -1j, 0]])
    matrices = np.zeros((5, 7, 4, 4))
    for _ in range(5):
        jones = random.normal(size=(5, 7, 2, 2)) + 1j * random.normal(size=(5, 7, 2, 2))
        product = np.einsum("...ij,...kl->...ikjl", jones, jones.conj()).reshape(5, 7, 4, 4)
        matrices += np.real(to_mueller @ product @ np.linalg.inv(to_mueller)) / 20
    return matrices


@pytest.fixture(scope="session")
def data(ptfe):
    """A measurement without noise, so that every cell is known."""
    return mmbrdf.simulate(ptfe, 532, mmbrdf.germer2017_grid())


@pytest.fixture(scope="session")
def camera():
    """Four states in each arm, and 54 references with noise of 0.1 %."""
    return mmbrdf.images.simulate((6, 8), seed=1)


@pytest.fixture(scope="session")
def calibrated(camera):
    return mmbrdf.images.calibrate(camera.references, camera.stacks, wavelength_nm=532)


@pytest.fixture(scope="session")
def ring():
    """1200 samples at 532 nm, mirror images among them, that two azimuths and five angles of the source have."""
    theta_i, phi_i, theta_r, turn = (
        axis.ravel()
        for axis in np.meshgrid([0, 15, 30, 45, 60], [0, 40], [10, 25, 40, 55, 70], np.arange(7.5, 360, 15))
    )
    lot = np.random.default_rng(1).permutation(len(turn))  # else each third would have a third of the azimuths
    geometry = (theta_i[lot], phi_i[lot], theta_r[lot], (phi_i + turn)[lot])
    return mmbrdf.simulate(mmbrdf.material("ptfe"), 532, geometry, speckle=0.01, seed=3)


@pytest.fixture
def told(ring, program, tmp_path):
    """Runs a command of the program on those samples in data.csv, and reads the JSON that it prints."""
    ring.save(tmp_path / "data.csv")
    return lambda *command: json.loads(program(*command, "--format", "json"))
