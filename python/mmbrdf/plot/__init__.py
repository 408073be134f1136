# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of Mueller-matrix BRDFs, with matplotlib.

Every function returns ``(figure, axes)`` and draws into ``axes`` or ``figure`` if it is given one. None of them uses
pyplot: figures have no window, no global state, and need no display; save them with ``figure.savefig(path)``.

``wavelength_nm`` may be None for a model of one wavelength, or samples at one. TypeError is for what is not a model,
samples or a number where one is expected.

Pictures of the hemisphere are in projected direction cosines: a direction of detection (theta_r, phi_r) is at
x = sin(theta_r) cos(phi_r), y = sin(theta_r) sin(phi_r). The source is at azimuth 180 degrees unless it is said
otherwise, so light comes from the left, the plane of incidence is the horizontal line through the centre and forward
scattering is on the right.
"""
from .curves import in_plane_curves, polar_in_plane, subset_study
from .maps import depolarization_map, realizability_map
from .designs import plan
from .panels import hemisphere, residual_map
from .samples import directions, low_order_residuals, suspicious
from .spectrum import coefficient_spectrum

__all__ = [
    "coefficient_spectrum",
    "depolarization_map",
    "directions",
    "hemisphere",
    "in_plane_curves",
    "low_order_residuals",
    "plan",
    "polar_in_plane",
    "realizability_map",
    "residual_map",
    "subset_study",
    "suspicious",
]
