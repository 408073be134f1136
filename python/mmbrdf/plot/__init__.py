# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of Mueller-matrix BRDFs, with matplotlib.

Every function returns ``(figure, axes)`` and draws into ``axes`` or ``figure`` if it is given one. None of them uses
pyplot: figures have no window, no global state, and need no display; save them with ``figure.savefig(path)``.

``width_cm`` makes a figure as wide as a column of a journal, 8 or 17 cm, with fonts of 6 to 8 points; without it figures suit a
screen. What differs within a picture is told apart without red and green and in grey prints. ``python3 -m mmbrdf.plot KIND MODEL
-o FILE`` draws most of them.

``wavelength_nm`` may be None for a model of one wavelength, or samples at one. TypeError is for what is not a model,
samples or a number where one is expected.

Pictures of the hemisphere are in projected direction cosines: a direction of detection (theta_r, phi_r) is at
x = sin(theta_r) cos(phi_r), y = sin(theta_r) sin(phi_r). The source is at azimuth 180 degrees unless it is said
otherwise, so light comes from the left, the plane of incidence is the horizontal line through the centre and forward
scattering is on the right. A ring is the source, which is the retro direction, too; a cross the specular direction; a dashed
circle the end of the fitted polar angles. Hatched is what has no value.
"""
from .. import _calls
from .budgets import anisotropy, uncertainty_parts
from .curves import in_plane_curves, polar_in_plane, subset_study
from .designs import plan
from .instruments import calibration
from .maps import depolarization_map, map, realizability_map
from .multiples import by_wavelength, residuals
from .panels import hemisphere, residual_map
from .reflectances import reflectance_against_angle, reflectance_against_wavelength, reflectance_factor
from .samples import directions, low_order_residuals, suspicious
from .spectrum import coefficient_spectrum

__all__ = [
    "anisotropy",
    "by_wavelength",
    "calibration",
    "coefficient_spectrum",
    "depolarization_map",
    "directions",
    "hemisphere",
    "in_plane_curves",
    "low_order_residuals",
    "map",
    "plan",
    "polar_in_plane",
    "realizability_map",
    "reflectance_against_angle",
    "reflectance_against_wavelength",
    "reflectance_factor",
    "residual_map",
    "residuals",
    "subset_study",
    "suspicious",
    "uncertainty_parts",
]

_calls.tell_in_a_line(globals(), __all__, "plot")
