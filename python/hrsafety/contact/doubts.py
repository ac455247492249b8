"""Why a result about a contact may not mean what it seems to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety.contact.covering import Covering, shape_flags
from hrsafety.contact.materials import GibsonAshby, Linear, Rusch, StressTable
from hrsafety.plausibility import RANGES, ResultWarning, implausible

__all__ = ["Doubts", "counted", "covering_flags", "flagged", "implausible_numbers", "not_checked", "without_drive"]

Doubts = tuple[ResultWarning, ...]

_UNKNOWN = "the solution did not come to its end and nothing is known"
_FLAGS = {
    "invalid": ResultWarning("invalid_numbers", "status", "a number is invalid and nothing is known: see status"),
    "unfinished": ResultWarning("unfinished", "status", f"{_UNKNOWN}: a larger tolerance may help"),
    "beyond_data": ResultWarning(
        "beyond_data", "covering.material", "the covering is compressed by more than was measured: no load is known"
    ),
    "rising": ResultWarning(
        "rising_at_horizon",
        "horizon",
        "loads still rise at the horizon, and their peaks may be larger: a longer horizon shows them",
    ),
    "outside_paraboloid": ResultWarning(
        "outside_paraboloid",
        "covering.radius",
        "the covering is compressed by more than half of a radius, where the paraboloid of its gap does not hold",
    ),
    "beyond_pad": ResultWarning(
        "beyond_pad",
        "covering.half_width",
        "the contact is wider than the covering: forces and pressures are not known",
    ),
    "edge": ResultWarning(
        "edge", "covering.radius", "a radius is below a fifth of the thickness: the pressure of an edge is not covered"
    ),
    "linear_beyond_half": ResultWarning(
        "linear_beyond_half",
        "covering.material",
        "a linear covering is compressed by more than half of its thickness, where foams become much stiffer, and "
        "nothing says how far it was tested: give bottom with that strain, max_strain, or a law that stiffens",
    ),
    "beyond_thickness": ResultWarning(
        "beyond_thickness",
        "covering.thickness",
        "the covering is compressed by more than its thickness, which none can be: give it a backing",
    ),
}

_WITHOUT_DRIVE = ResultWarning(
    "drive_not_given",
    "drive",
    "a clamped contact is that of a robot without drive: one that is driven on until it has reacted and braked presses "
    "harder; a drive with stiffness and stop describes it",
)

_LINEAR_STRAIN = 0.5
"""Strain beyond which hardly any foam is linear, a choice of this project."""
_UNTOLD_STRAIN = 0.8
"""Strain of bottoming that was not stated: the default, and beyond."""
CAREFUL_ABOVE = frozenset({"robot_mass", "body_mass", "stiffness"})
CAREFUL_BELOW = frozenset({"force_limit", "pressure_limit"})
"""Numbers of which more, or less, than was meant certainly makes an allowed speed lower or a load larger."""

_QUANTITIES = {
    "robot_mass": "effective_mass",
    "body_mass": "body_mass",
    "closing_speed": "closing_speed",
    "horizon": "impact_time",
    "stiffness": "region_stiffness",
    "thickness": "covering_thickness",
    "area": "contact_area",
    "radius": "contact_radius",
    "second_radius": "contact_radius",
    "force_limit": "force_limit",
    "pressure_limit": "pressure_limit",
}


def flagged(flags: Mapping[str, Any], pad: Covering | None = None, numbers: Mapping[str, Any] | None = None) -> Doubts:
    """Return a warning for each flag that holds, with the number of rows where there are several.

    Of unfinished solutions the covering tells why they may be so, with the numbers of their rows.
    """
    found = []
    for name, flag in flags.items():
        rows = np.asarray(flag)
        held = int(np.count_nonzero(rows))
        if held:
            doubt = _unfinished(pad, numbers, rows) if name == "unfinished" and pad and numbers else _FLAGS[name]
            found.append(counted(doubt, rows))
    return tuple(found)


def counted(doubt: ResultWarning, held: npt.NDArray[np.bool_]) -> ResultWarning:
    """Return a doubt with the number of rows for which it holds, where there are several."""
    if held.ndim == 0:
        return doubt
    return replace(doubt, message=f"{int(np.count_nonzero(held))} of {held.size} rows: {doubt.message}")


def without_drive(numbers: Mapping[str, Any]) -> Doubts:
    """Return the doubt about clamped contacts of a robot whose drive is not described: it presses on.

    Parameters
    ----------
    numbers : mapping of str to float or ndarray
        Those of the contact, or of many; NaN or left out where they are not given.

    Returns
    -------
    tuple of ResultWarning
        One with the number of rows, or none.
    """
    stiffness, time = (np.asarray(numbers.get(name, np.nan)) for name in ("robot_stiffness", "stop_time"))
    held = np.isinf(np.asarray(numbers["body_mass"])) & ~((stiffness > 0.0) & ~np.isnan(time))
    return (counted(_WITHOUT_DRIVE, np.asarray(held)),) if held.any() else ()


def _unfinished(pad: Covering, numbers: Mapping[str, Any], held: npt.NDArray[np.bool_]) -> ResultWarning:
    """Return what may leave the solutions of these rows without their end."""

    def of_rows(name: str) -> npt.NDArray[np.float64]:
        found: npt.NDArray[np.float64] = np.broadcast_to(np.asarray(numbers[name], dtype=np.float64), held.shape)[held]
        return found

    causes = []
    if isinstance(pad.material, GibsonAshby):
        place = list(pad.material.keys.values()).index("exponent")
        if (of_rows(f"material_{place}") < 1.0).any():
            causes.append(
                "with an exponent below 1 the law stores a limited energy up to its lock, and a collision with more "
                "never turns: a thicker or larger covering, or a backing (bottom) from a strain below the lock, bears "
                "more"
            )
    if (of_rows("damping") > 0.0).any():
        causes.append(
            "a damper that relaxes within microseconds beside a stiff column may take too many steps: a larger one "
            "relaxes more slowly, and without any the loads are others"
        )
    doubt = _FLAGS["unfinished"]
    return replace(doubt, message=f"{_UNKNOWN}: {'; '.join(causes)}") if causes else doubt


def covering_flags(pad: Covering | None, depth: Any, numbers: Mapping[str, Any]) -> dict[str, Any]:
    """Return where the model of a covering does not hold at a compression; numbers may be arrays."""
    if pad is None:
        return {}
    radii = [numbers["radius"], numbers["second_radius"]]
    flags = shape_flags(depth, radii=radii, thickness=numbers["thickness"], half_width=pad.half_width)
    with np.errstate(invalid="ignore"):
        deep, whole = np.asarray(depth), np.asarray(numbers["thickness"])
        if isinstance(pad.material, Linear):
            untold = np.asarray(numbers["bottoming_strain"]) >= _UNTOLD_STRAIN
            flags["linear_beyond_half"] = (deep > _LINEAR_STRAIN * whole) & untold
        return {**flags, "beyond_thickness": deep > whole}


def implausible_numbers(pad: Covering | None, region: str, numbers: Mapping[str, Any]) -> Doubts:
    """Return a warning for every number of a contact that is hardly what was meant."""
    values = {name: numbers[name] for name in _QUANTITIES if not (name == "stiffness" and region == "power")}
    quantities = dict(_QUANTITIES)
    if pad is not None:
        law = pad.material
        for place, name in enumerate(law.keys.values()):
            # One of both numbers of a power law may be 0.
            if name in ("modulus", "plateau") or (isinstance(law, Rusch) and name in ("a", "b")):
                values[name], quantities[name] = numbers[f"material_{place}"], "covering_stress"
        if isinstance(law, GibsonAshby):
            names = list(law.keys.values())
            modulus, plateau = (np.asarray(numbers[f"material_{names.index(name)}"]) for name in ("modulus", "plateau"))
            with np.errstate(invalid="ignore", divide="ignore"):
                values["yield_strain"] = plateau / modulus
        if isinstance(law, StressTable):
            values["stress"], quantities["stress"] = float(np.max(law.stress)), "covering_stress"
            values["strain"], quantities["strain"] = float(np.max(law.strain)), "covering_strain"
    judged = {name: _judged(value, quantities.get(name, name)) for name, value in values.items()}
    return tuple(
        replace(each, safe_side=_careful(each.subject, judged[each.subject], quantities))
        for each in implausible(judged, quantities)
    )


def _careful(name: str, value: Any, quantities: Mapping[str, str]) -> bool:
    """Return whether every implausible value of a number makes the result the more careful one."""
    least, most = RANGES[quantities.get(name, name)][:2]
    if name in CAREFUL_ABOVE:
        return not np.any(np.asarray(value) < least)
    return name in CAREFUL_BELOW and not np.any(np.asarray(value) > most)


def _judged(value: Any, quantity: str) -> Any:
    """Return what of a number can be implausible: not what is 0, below 0, infinite or not given."""
    given = np.asarray(value, dtype=np.float64)
    if given.ndim:
        least, most = RANGES[quantity][:2]
        # Most arrays are plausible, and long.
        if not np.any((given > 0.0) & (given < least) | (given > most) & np.isfinite(given)):
            return None
    return np.where((given > 0.0) & np.isfinite(given), given, np.nan)


def not_checked(names: tuple[str, ...]) -> Doubts:
    """Return a warning for every limit that was not checked."""
    return tuple(
        ResultWarning(
            "not_checked",
            f"limits.{name}",
            f"the {name} is not checked: no limit is given{', or no area of contact' if name == 'pressure' else ''}",
        )
        for name in names
    )
