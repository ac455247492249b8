"""Findings of `hrsafety foam`: the foams of a file with their checks, and the boundaries."""

from __future__ import annotations

from typing import NamedTuple

from hrsafety import impact
from hrsafety._records import dataclass
from hrsafety.cli.foam.file import FoamDesignFile
from hrsafety.plausibility import ResultWarning

__all__ = ["KILO", "LOADS", "Check", "CheckedFoam", "FoundFoams", "StiffnessRange"]


KILO = 1000.0
LOADS = {
    "peak_head_acceleration_g": ("head acceleration", "g", 1.0, 1.0),
    "hic15": ("HIC15", "", 1.0, 2.5),
    "hic36": ("HIC36", "", 1.0, 2.5),
    "peak_contact_force": ("contact force", "N", 1.0, 1.0),
    "max_compression": ("compression", "mm", KILO, 1.0),
}
"""Fields of the limits: words, unit, how many of it an SI unit is, power of the closing speed."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Check:
    """One limit and what a foam makes of it.

    Attributes
    ----------
    name, unit : str
        Quantity and unit.
    value, limit : float
        In that unit.
    margin : float
        What is left of the limit, as a share of it; negative if it is exceeded.
    """

    name: str
    unit: str
    value: float
    limit: float
    margin: float

    @property
    def kept(self) -> bool:
        """Whether the limit is kept."""
        return self.margin >= 0.0


class StiffnessRange(NamedTuple):
    """Range of stiffness at one damping.

    Attributes
    ----------
    damping : float
        In N s/m.
    low, high : float
        In N/m.
    """

    damping: float
    low: float
    high: float


@dataclass(frozen=True, kw_only=True, slots=True)
class CheckedFoam:
    """A foam with its checks.

    Attributes
    ----------
    name : str
        As in the file.
    foam : Foam
        Its parameters.
    accepted : bool
        Whether all limits are kept, and the foam stays in its linear range.
    status : str
        See `FoamMargin.status`.
    checks : tuple of Check
        Each limit.
    max_closing_speed : float
        Largest closing speed in m/s at which this foam keeps all limits.
    """

    name: str
    foam: impact.Foam
    accepted: bool
    status: str
    checks: tuple[Check, ...]
    max_closing_speed: float

    @property
    def verdict(self) -> str:
        """Whether the foam fits, and if its model says nothing about that, why."""
        if self.accepted:
            return "fits"
        if self.status == "not_checked":
            return "not checked: see the warnings"
        why = {"bottomed": ": bottomed", "beyond_linear_range": ": beyond linear range"}
        return f"does not fit{why.get(self.status, '')}"


@dataclass(frozen=True, kw_only=True, slots=True)
class FoundFoams:
    """Findings about a design.

    Attributes
    ----------
    file : FoamDesignFile
        What was asked.
    upper, lower : FoamBoundary or None
        Boundaries over the range of damping; ``None`` without a limit for them.
    foams : tuple of Judged
        The foams.
    widest : Range or None
        Widest range of stiffness that keeps the margin, if any foam does.
    feasibility : FoamFeasibility
        Whether some foam of the range of damping fits with the margin, and up to which closing speed.
    warnings : tuple of ResultWarning
        Numbers of the file that are hardly what was meant.
    """

    file: FoamDesignFile
    upper: impact.FoamBoundary | None
    lower: impact.FoamBoundary | None
    foams: tuple[CheckedFoam, ...]
    widest: StiffnessRange | None
    feasibility: impact.FoamFeasibility
    warnings: tuple[ResultWarning, ...] = ()
