# SPDX-License-Identifier: BSD-3-Clause
"""What functions of many geometries or matrices take and give: their arrays, and the names of axes and units of their results."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from . import _mmbrdf

MATRIX = ("row", "column")
DIRECTIONS = ("theta_i_deg", "phi_i_deg", "theta_r_deg", "phi_r_deg")


class Signature(NamedTuple):
    """What a function takes and gives."""

    parameters: tuple[str, ...]
    """Names of arguments in their order."""
    arrays: Mapping[str, tuple[str, ...]]
    """Which of them are arrays, and the names of their last axes, which are not cut into chunks."""
    outputs: tuple[tuple[str, ...], ...] = ((),)
    """Names of the last axes of each result."""
    record: str | None = None
    """The named tuple of several results."""
    dtype: Any = float
    """Of the result; of several results one for all, or those of each."""
    units: str | None = None
    """Of the result; None: those of the argument."""
    meaning: str | None = None
    leading: bool = False
    """The first of the names in `outputs` is the first axis."""

    @property
    def dtypes(self) -> tuple[Any, ...]:
        return self.dtype if isinstance(self.dtype, tuple) else (self.dtype,) * len(self.outputs)


def _matrix(*outputs: tuple[str, ...], **more: Any) -> Signature:
    return Signature(("mueller",), {"mueller": MATRIX}, outputs, **more)


def _question(*outputs: tuple[str, ...], first: tuple[str, ...] = ("self",), **more: Any) -> Signature:
    names = ("wavelength_nm", *DIRECTIONS)
    return Signature((*first, *names), dict.fromkeys(names, ()), outputs, units="", **more)


def signatures() -> dict[str, Signature]:
    result: dict[str, Signature] = {}
    for q in _mmbrdf.quantities():
        more = ("stokes",) if q.takes_light else ()
        arrays: dict[str, tuple[str, ...]] = {"mueller": MATRIX} | ({"stokes": ("stokes",)} if more else {})
        units = None if q.unit == "sr^-1" else q.unit
        result[q.name] = Signature(("mueller", *more), arrays, ((),), units=units, meaning=q.meaning)
        slope = Signature(("mueller", *more), arrays, (MATRIX,), units="", meaning=f"derivatives of {q.name}")
        result[f"{q.name}_gradient"] = slope
    result["realizability_margin"] = result["eigenvalue_min"]
    result["realizability_margin_gradient"] = result["eigenvalue_min_gradient"]
    result["smallest_eigenvalue_gradient"] = _matrix(MATRIX, units="")
    result["diattenuation_vector"] = result["polarizance_vector"] = _matrix(("component",), units="")
    result["coherency_eigenvalues"] = _matrix(("eigenvalue",))
    result["coherency"] = _matrix(("coherency",), dtype=complex)
    result["realizable"] = _matrix((), dtype=bool, units="")
    result["retardance"] = _matrix((), units="degree")
    result["depolarization_power"] = _matrix((), units="")
    for name in ("exchanged", "mirrored", "nearest_realizable"):
        result[name] = _matrix(MATRIX)
    result["normalized"] = _matrix(MATRIX, units="")
    result["cloude_decomposition"] = _matrix(("part",), ("part", *MATRIX), record="CloudeDecomposition")
    result["lu_chipman"] = _matrix(*[MATRIX] * 3, record="LuChipman")
    result["symmetric_decomposition"] = _matrix(*[MATRIX] * 5, record="SymmetricDecomposition")
    result["co_and_cross_polarized"] = Signature(
        ("mueller_sp",), {"mueller_sp": MATRIX}, ((), (), (), ()), "PolarizedBrdf"
    )
    result["standard_uncertainty"] = Signature(
        ("gradient", "covariance"), {"gradient": MATRIX, "covariance": ("element", "element_2")}, units=""
    )
    result["change_frame"] = Signature(
        ("mueller", *DIRECTIONS, "from_frame", "to_frame"),
        {"mueller": MATRIX, **dict.fromkeys(DIRECTIONS, ())},
        (MATRIX,),
    )
    result["convert"] = Signature(("mueller", "from_convention", "to_convention"), {"mueller": MATRIX}, (MATRIX,))
    result["reflectance_factor"] = Signature(("f11",), {"f11": ()}, units="1", meaning="reflectance factor")
    for name, arguments in {"polarizer": ("azimuth_deg", "extinction"), "rotator": ("angle_deg",)}.items():
        result[name] = Signature(arguments, dict.fromkeys(arguments, ()), (MATRIX,), units="")
    arguments = ("retardance_deg", "azimuth_deg")
    for name in ("polarized_curve", "polarized_uncertainty"):
        result[name] = Signature(
            ("model", "wavelength_nm", "geometry"),
            dict.fromkeys(DIRECTIONS, ()),
            ((),) * 4,
            "PolarizedBrdf",
            units="sr-1",
        )
    result["retarder"] = Signature(arguments, dict.fromkeys(arguments, ()), (MATRIX,), units="")
    return result | _reflectances() | _methods()


def _reflectances() -> dict[str, Signature]:
    result = {}
    for way, end, stokes in (
        ("directional_hemispherical", "i", "stokes"),
        ("hemispherical_directional", "r", "analyzer"),
    ):
        angles = ("wavelength_nm", f"theta_{end}_deg", f"phi_{end}_deg")
        arrays: dict[str, tuple[str, ...]] = {**dict.fromkeys(angles, ()), stokes: ("stokes",)}
        for what in ("reflectance", "uncertainty"):
            result[f"{way}_{what}"] = Signature(("model", *angles, stokes), arrays, units="")
    for what in ("reflectance", "uncertainty"):
        result[f"bihemispherical_{what}"] = Signature(("model", "wavelength_nm"), {"wavelength_nm": ()}, units="")
    return result


def _methods() -> dict[str, Signature]:
    sampled = ("theta_i_deg", "phi_i_deg", "u1", "u2")
    weighted = (*DIRECTIONS, "pdf")
    return {
        "Model.evaluate": _question(MATRIX),
        "Model.evaluate_uncertainty": _question(MATRIX),
        "Model.reflectance_factor": _question(())._replace(units="1", meaning="reflectance factor"),
        "Model.reflectance_factor_uncertainty": _question(())._replace(units="1"),
        "Model.covariance": _question(("element", "element_2")),
        "Model.outside": _question((), dtype=np.uint8),
        "Model.estimable": _question((), dtype=bool),
        "Model.evaluate_draws": _question(("draw", *MATRIX), first=("self", "count", "seed"), leading=True),
        "Model.predict_readings": _question(MATRIX, MATRIX, (), record="Evaluation", dtype=(float, float, np.uint8)),
        "Model.analyze": _question(()),
        "Model._analyzed": _question(("number",)),
        "DirectionSampler.sample": Signature(
            ("self", *sampled), dict.fromkeys(sampled, ()), ((), (), ()), "SampledDirections", units=""
        ),
        "DirectionSampler.pdf": Signature(("self", *DIRECTIONS), dict.fromkeys(DIRECTIONS, ()), units="sr-1"),
        "DirectionSampler.weight": Signature(("self", *weighted), dict.fromkeys(weighted, ()), (MATRIX,), units=""),
        "Polarimeter.reduce": Signature(("self", "readings", "invalid"), {"readings": ()}, (MATRIX,)),
        "Polarimeter.covariance": Signature(("self", "variances"), {"variances": ()}, (("element", "element_2"),)),
        "Polarimeter.readings": Signature(("self", "mueller"), {"mueller": MATRIX}, ((),)),
    }
