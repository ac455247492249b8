"""A way through a place that is known from scans alone: guide, commands rolled out on arcs, verified plans."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters, checked_seed, count, flag, instance
from hrsafety._records import dataclass
from hrsafety.navigation.maps.unknown_map import UnknownMap

__all__ = ["ArcRollouts"]

MOST_NODES = 10_000_000


@dataclass(frozen=True, kw_only=True, slots=True)
class ArcRollouts(Parameters):
    """Choice of a twist for a robot with two wheels that knows a place from its scans alone.

    A guide searches the time to the goal over the cells of a rolling map; unknown ground can be passed, at a price.
    91 twists are tried, each rolled out on two arcs for as long as the robot needs to stop, and rated by the time to
    the goal from their ends and by their distance from known obstacles. The first twist is executed whose plan,
    the twist and braking after it, is verified by the exact swept distance of the outline to the points of occupied
    cells and to the front of the unknown; where none is, the plan before runs on until rest.

    In a static world the robot touches nothing, provided that every obstacle in a free cell lies within ``margin`` of
    the point of an occupied cell. **Not covered**: obstacles thinner than the distance of the beams, glass, obstacles
    outside the plane of the scan, people and other moving bodies.

    Parameters
    ----------
    map : UnknownMap
        Rules of the map.
    margin : float
        Distance from everything known that plans keep, in m; it covers errors of map and pose.
    clearance : float
        Distance in m beyond the circle within the outline that the guide keeps from obstacles, where it can.
    narrow_weight : float
        Price of ground where the robot cannot turn, as a share of its time.
    near_weight : float
        Price of ground near obstacles, as a share of its time.
    near_distance : float
        Distance of the middle of the robot from obstacles within which ground counts as near, in m.
    unknown_weight : float
        Price of unknown ground, as a share of its time.
    beyond : float
        How much farther than to the robot times to the goal are searched, in s.
    replan : int
        Control periods between two searches.
    nodes : int
        Most nodes that a search settles in a control period; until it is done the plan before stands.
    verify : bool
        Whether plans are verified. Without it contacts are to be expected.
    seed : int
        Seed of the twists that are driven where the robot makes no progress.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.ArcRollouts(margin=0.05).map.reach
    6.0
    """

    map: UnknownMap = field(default_factory=UnknownMap)
    margin: Annotated[float, "m"] = 0.03
    clearance: Annotated[float, "m"] = 0.06
    narrow_weight: float = 16.0
    near_weight: float = 0.8
    near_distance: Annotated[float, "m"] = 0.55
    unknown_weight: float = 0.3
    beyond: Annotated[float, "s"] = 0.8
    replan: int = 3
    nodes: int = 4000
    verify: bool = True
    seed: int = 0
    _native: _hrsafety.ArcRollouts = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        names = ("margin", "clearance", "narrow_weight", "near_weight", "near_distance", "unknown_weight", "beyond")
        native = _hrsafety.ArcRollouts(
            map=instance("map", self.map, UnknownMap)._native,
            replan=count("replan", self.replan, most=10_000),
            nodes=count("nodes", self.nodes, most=MOST_NODES),
            verify=flag("verify", self.verify),
            seed=checked_seed("seed", self.seed),
            **self._as_numbers(*names),
        )
        self._set(_native=native)
