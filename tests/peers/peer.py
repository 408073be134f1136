# SPDX-License-Identifier: BSD-3-Clause
"""What the checks of other programs share; docs/interoperability.md says how to run them."""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import warnings

import numpy as np

import mmbrdf

warnings.simplefilter("ignore", mmbrdf.ExtrapolationWarning)  # peers are asked up to where tables state their error


def command(variable, what):
    """The words of the command that an environment variable holds; without it, one line, and the check ends as skipped."""
    if not os.environ.get(variable):
        print(f"skipped: set {variable} to {what}")
        sys.exit(0)
    return shlex.split(os.environ[variable])


def run(words, **options):
    """What the peer prints; what it says of its errors ends the check."""
    done = subprocess.run(words, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
    if done.returncode:
        sys.exit(f"{shlex.join(words)}: exit status {done.returncode}\n{done.stderr}")
    return done.stdout


def geometries(limit, count=1000):
    """Random pairs of directions up to `limit` degrees, uniform in projected solid angle as those by which exports measure
    their error: theta_i, phi_i, theta_r, phi_r in degrees."""
    random = np.random.default_rng(1)
    theta_i, theta_r = np.degrees(np.arcsin(np.sin(np.radians(limit)) * np.sqrt(random.uniform(0, 1, (2, count)))))
    phi_i, phi_r = random.uniform(-180, 180, (2, count))
    return theta_i, phi_i, theta_r, phi_r


def direction(theta, phi):
    """Unit vectors away from the sample, of shape (..., 3)."""
    theta, phi = np.radians(theta), np.radians(phi)
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)


def ask(words, rows):
    """Rows of numbers written to the peer's standard input as text, and its rows of numbers."""
    text = "\n".join(" ".join(f"{x:.17g}" for x in row) for row in rows) + "\n"
    return np.array([[float(x) for x in line.split()] for line in run(words, input=text).splitlines() if line.strip()])


def interpolation(note):
    """What the note of an export says of interpolation: limits of its rms and its largest error, as parts of f11, and up to
    which angle. Other geometries than its 4000 find an rms within a fifth of its own, and a largest error within twice."""
    rms, largest, limit = re.search(r"adds ([\d.e-]+) % of f11 \(rms; at most ([\d.e-]+) %\) up to ([\d.]+) deg", note).groups()
    return 1.2 * float(rms) / 100, 2 * float(largest) / 100, float(limit)


def judge(peer, what, deviations, rms, largest, of="geometries", part="f11"):
    """Prints how far the peer's answers are from ours, as parts of f11 or what `part` names, and fails beyond what the format
    resolves."""
    deviations = np.abs(np.asarray(deviations))
    found = np.sqrt(np.mean(deviations**2)), deviations.max()
    good = np.isfinite(found).all() and found[0] <= rms and found[1] <= largest
    print(f"mmbrdf {mmbrdf.__version__}, {peer}: {what}, {len(deviations)} {of}")
    print(f"deviation / {part}: rms {found[0]:.2e} (limit {rms:.2e}), largest {found[1]:.2e} (limit {largest:.2e})")
    if not good:
        print("beyond what the format resolves")
        sys.exit(1)


def lambertian(albedo):
    """A model whose f11 is albedo / pi."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "lambertian.csv"
        file.write_text(f"1, 1, 0, 0, 0, 0, 0, {2 * albedo!r}\n")
        return mmbrdf.load_model(file)
