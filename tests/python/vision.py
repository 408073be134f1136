# SPDX-License-Identifier: BSD-3-Clause
"""Colours as some people and some prints show them, and how far they are apart then."""

import numpy as np
from matplotlib.colors import to_rgb

# Machado, Oliveira and Fernandes, IEEE Trans. Vis. Comput. Graph. 15, 1291 (2009), severity 1, for linear sRGB.
DEUTERANOPIA = np.array(
    [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
)
PROTANOPIA = np.array(
    [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
)

# IEC 61966-2-1: linear sRGB to XYZ with the white of D65; its second row is the luminance, which grey prints keep.
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = TO_XYZ.sum(axis=1)
GREY = np.tile(TO_XYZ[1], (3, 1))

AS_SEEN = {"all cones": np.eye(3), "deuteranopia": DEUTERANOPIA, "protanopia": PROTANOPIA, "grey": GREY}


def cielab(rgb):
    """L*, a*, b* of linear sRGB, CIE 1976."""
    ratio = TO_XYZ @ np.clip(rgb, 0, 1) / WHITE
    f = np.where(ratio > (6 / 29) ** 3, np.cbrt(ratio), ratio * (29 / 6) ** 2 / 3 + 4 / 29)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def linear(color):
    """Linear sRGB of a colour of matplotlib."""
    coded = np.array(to_rgb(color))
    return np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)


def distance(one, other, seen):
    """Of two colours in CIELAB, as they are seen: 2.3 is just noticeable on large areas, thin lines need more."""
    return float(np.linalg.norm(cielab(AS_SEEN[seen] @ linear(one)) - cielab(AS_SEEN[seen] @ linear(other))))
