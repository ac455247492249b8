"""Foam design files: TOML in, a checked manipulator, limits, range of damping and foams out."""

from __future__ import annotations

import math
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety import _keys as kind
from hrsafety import impact
from hrsafety._keys import Keys, checked, located, parsed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.impact.design import DEFAULT_MARGIN, check_margin

__all__ = ["FoamDesignFile", "load", "manipulator_of"]

Array = npt.NDArray[np.float64]

DEFAULT_DAMPING = (0.0, 300.0, 121)
MOST_POINTS = 2000

_TOP: Keys = MappingProxyType(
    {
        "title": kind.word,
        "closing_speed": kind.number,
        "margin": kind.number,
        "thickness": kind.number,
        "linear_range": kind.number,
        "manipulator": kind.table,
        "limits": kind.table,
        "damping": kind.table,
        "foams": kind.tables,
    }
)
_MANIPULATOR: Keys = MappingProxyType({"mass": kind.number, "damping": kind.number, "stiffness": kind.number})
_JOINT: Keys = MappingProxyType(
    {"inertia": kind.number, "damping": kind.number, "stiffness": kind.number, "lever_arm": kind.number}
)
_LIMITS: Keys = MappingProxyType(
    {
        "peak_head_acceleration_g": kind.number,
        "peak_contact_force": kind.number,
        "hic15": kind.number,
        "hic36": kind.number,
        "max_compression": kind.number,
    }
)
_DAMPING: Keys = MappingProxyType({"from": kind.number, "to": kind.number, "points": kind.integer})
_FOAM: Keys = MappingProxyType(
    {
        "name": kind.word,
        "stiffness": kind.number,
        "damping": kind.number,
        "thickness": kind.number,
        "linear_range": kind.number,
    }
)


@dataclass(frozen=True, kw_only=True, slots=True)
class FoamDesignFile:
    """Contents of a foam design file.

    Attributes
    ----------
    title : str
        Heading of the page.
    manipulator : Manipulator
        As felt at the impact point.
    limits : FoamLimits
        What must be kept.
    closing_speed : float
        In m/s.
    margin : float
        Share of every limit that advice leaves.
    sought : Foam
        Thickness and linear range of the foam that is looked for.
    damping : ndarray, shape (n,)
        Foam damping that is examined, in N s/m.
    foams : dict of str to Foam
        Foams to judge, by name.
    """

    title: str
    manipulator: impact.Manipulator
    limits: impact.FoamLimits
    closing_speed: float
    margin: float
    sought: impact.Foam
    damping: Array
    foams: dict[str, impact.Foam]


@kind.top_level(_TOP)
def load(path: str) -> FoamDesignFile:
    """Read a foam design file.

    Parameters
    ----------
    path : str
        The file, see ``examples/foam_design.toml``.

    Returns
    -------
    FoamDesignFile
        Checked.

    Raises
    ------
    InvalidParameterError
        If the file cannot be read, is not TOML, or a value breaks a rule; the message names the
        key.
    """
    fields = checked("", parsed(Path(path)), _TOP, required=("closing_speed", "manipulator"))
    speed = fields["closing_speed"]
    if not (math.isfinite(speed) and speed > 0.0):
        raise InvalidParameterError("closing_speed", "be finite and positive", speed)
    kept = _limits(fields.get("limits"))
    return FoamDesignFile(
        title=fields.get("title", "Foam covering"),
        manipulator=manipulator_of(fields["manipulator"]),
        limits=kept,
        closing_speed=speed,
        margin=check_margin(fields.get("margin", DEFAULT_MARGIN)),
        sought=impact.Foam(
            stiffness=1e4,
            damping=0.0,
            **{name: fields[name] for name in ("thickness", "linear_range") if name in fields},
        ),
        damping=_damping(fields.get("damping", {})),
        foams=_foams(fields.get("foams", [])),
    )


def manipulator_of(table: dict[str, Any]) -> impact.Manipulator:
    """Return the manipulator of a table: as felt at the impact point, or a joint and a lever arm."""
    if "inertia" in table or "lever_arm" in table:
        joint = checked("manipulator", table, _JOINT, required=tuple(_JOINT))
        with located("manipulator"):
            return impact.Manipulator.from_joint(**joint)
    given = checked("manipulator", table, _MANIPULATOR, required=tuple(_MANIPULATOR))
    with located("manipulator"):
        return impact.Manipulator(**given)


def _limits(table: dict[str, Any] | None) -> impact.FoamLimits:
    """Return the default limits without a table, else only those that the table names."""
    if table is None:
        return impact.FoamLimits()
    given = checked("limits", table, _LIMITS)
    unset = dict.fromkeys(("peak_head_acceleration_g", "max_compression"))
    with located("limits"):
        return impact.FoamLimits(**{**unset, **given})


def _damping(table: dict[str, Any]) -> Array:
    given = checked("damping", table, _DAMPING)
    low, high, points = (given.get(name, default) for name, default in zip(_DAMPING, DEFAULT_DAMPING, strict=True))
    if not (math.isfinite(low) and low >= 0.0):
        raise InvalidParameterError("damping.from", "be finite and not negative", low)
    if not (math.isfinite(high) and high > low):
        raise InvalidParameterError("damping.to", f"be finite and above damping.from = {low:g}", high)
    if not 2 <= points <= MOST_POINTS:
        raise InvalidParameterError("damping.points", f"be from 2 to {MOST_POINTS}", points)
    return np.linspace(low, high, points)


def _foams(tables: list[dict[str, Any]]) -> dict[str, impact.Foam]:
    foams: dict[str, impact.Foam] = {}
    for index, table in enumerate(tables):
        path = f"foams[{index}]"
        given = checked(path, table, _FOAM, required=("name", "stiffness", "damping"))
        name = given.pop("name")
        if name in foams or not name.strip():
            raise InvalidParameterError(
                f"{path}.name", "be a name that no other foam has", name or Shown("an empty text")
            )
        with located(path):
            foams[name] = impact.Foam(**given)
    return foams
