"""People whom the robot does not see: what a shield assumes of them."""

from __future__ import annotations

import math
from dataclasses import field

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters, count
from hrsafety._records import dataclass

__all__ = ["Unseen"]

MOST_BEAMS = 100_000


@dataclass(frozen=True, kw_only=True, slots=True)
class Unseen(Parameters):
    """People whom the robot does not see, for a shield that reckons with them.

    The shield stores where an unseen person can be: everywhere at first, then where no beam went, and wherever a person
    can have walked from there since. A plan is verified only if nobody from there can come ahead of the robot before it
    rests, so that a person who steps out from behind a corner meets a robot that rests or does not move toward that
    person. The shield needs the map whose walls hide people, and scans; in a run the law is not told of people behind
    walls, behind others or out of range.

    Assumptions: a person is a disc around a core that never overlaps a wall of the map and ends every beam that meets
    it; nobody is faster than ``person_speed`` of the shield; every wall that ends beams is in the map; the pose of the
    robot and its beams are as exact as the arguments say. People who crawl below the beams or sit behind glass, who
    come through doors that the map takes for walls, or out of nothing are not covered. Arrival is not guaranteed: the
    robot waits where unseen places are near its way, unless it may creep.

    Parameters
    ----------
    person_radius : float
        Largest radius of people in m.
    person_core : float
        Radius in m of the core of a person.
    cell : float
        Side of the cells in m, at most ``(person_core - pose_error)/(1 + sqrt 2)``. Smaller cells round less: the robot
        is faster at openings, for four times the work with half of the side.
    creep_speed : float
        Speed in m/s up to which a plan is verified against seen people only; 0: no such plans.
    sampling : float
        Time in s between the instants at which a plan is verified.
    pose_error, heading_error : float
        Largest error of the robot's own position in m and heading in rad; with an error of the heading far parts of
        beams empty no cells.
    range_error : float
        Largest error of a measured range in m.
    beams : int
        Beams of a scan in a run. They empty cells where they are less than a cell apart.
    range : float
        Range of the beams in m.
    field_of_view : float
        Angle in rad that the beams of a run divide. The space behind a robot that does not look all around stays
        unseen, and the robot hardly moves.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> shield = nav.Shield(unseen=nav.Unseen(person_radius=0.3, creep_speed=0.1))
    >>> shield.unseen.range
    8.0
    """

    person_radius: float = 0.4
    person_core: float = 0.15
    cell: float = 0.05
    creep_speed: float = 0.0
    sampling: float = 0.0125
    pose_error: float = 0.005
    heading_error: float = 0.0
    range_error: float = 0.0
    beams: int = 1440
    range: float = 8.0
    field_of_view: float = math.tau
    _native: _hrsafety.Unseen = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._as_numbers(*_NUMBERS)
        self._set(beams=count("beams", self.beams, most=MOST_BEAMS))
        self._set(_native=_hrsafety.Unseen(**{name: getattr(self, name) for name in (*_NUMBERS, "beams")}))


_NUMBERS = (
    *("person_radius", "person_core", "cell", "creep_speed", "sampling"),
    *("pose_error", "heading_error", "range_error", "range", "field_of_view"),
)
