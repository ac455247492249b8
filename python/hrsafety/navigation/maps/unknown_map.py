"""Map of a place that a robot knows from its scans alone."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters
from hrsafety._records import dataclass

__all__ = ["UnknownMap"]


@dataclass(frozen=True, kw_only=True, slots=True)
class UnknownMap(Parameters):
    """Rules of a rolling map: square cells around the robot, filled by its scans and moved with it.

    A beam passes every cell before its end and hits the last one. Of 40 pieces of evidence of a cell all are scaled to
    39 before the next one counts, so that old evidence, and with it the drift of the odometry, is forgotten. A cell is
    occupied if enough beams ended in it, free if beams passed, and else unknown: **what nobody has seen is not free**.

    Parameters
    ----------
    cell : float
        Side of a cell in m.
    reach : float
        Distance from the robot within which beams count, in m.
    hit_share : float
        Share of hits in all evidence of a cell from which on it is occupied; a larger one forgets what is there.
    least_hits : float
        Least hits of an occupied cell.

    Raises
    ------
    InvalidParameterError
        If a number is out of range, or the window would have more than 1,024 cells along a side.

    See Also
    --------
    ArcRollouts : Finds its way in such a map.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.UnknownMap(reach=8.0).cell
    0.05
    """

    cell: Annotated[float, "m"] = 0.05
    reach: Annotated[float, "m"] = 6.0
    hit_share: float = 0.1
    least_hits: float = 2.0
    _native: _hrsafety.UnknownMap = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        names = ("cell", "reach", "hit_share", "least_hits")
        self._set(_native=_hrsafety.UnknownMap(**self._as_numbers(*names)))
