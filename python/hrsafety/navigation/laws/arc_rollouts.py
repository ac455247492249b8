"""A way through a place that is known from scans alone: guide, commands rolled out on arcs, verified plans."""

from __future__ import annotations

from dataclasses import field
from typing import ClassVar

from hrsafety import _hrsafety
from hrsafety._arguments import checked_seed, count, flag, instance
from hrsafety._records import dataclass
from hrsafety.navigation.laws.declared import Law, gain, law
from hrsafety.navigation.maps.unknown_map import UnknownMap

__all__ = ["ArcRollouts"]

MOST_NODES = 10_000_000


@law("arc_rollouts", plans=True)
@dataclass(frozen=True, kw_only=True, slots=True)
class ArcRollouts(Law):
    """Choice of a twist for a robot with two wheels that knows a place from the scans of its lidars alone.

    A guide searches the time to the goal over the cells of a rolling map; unknown ground can be passed, at a price.
    91 twists are tried, each rolled out on two arcs for as long as the robot needs to stop, and rated by the time to
    the goal from their ends and by their distance from known obstacles. The first twist is executed whose plan,
    the twist and braking after it, is verified by the exact swept distance of the outline to the points of occupied
    cells and to the front of the unknown; where none is, the plan before runs on until rest.

    It is a law like any other for robots with lidars, ``Robot(sensors=[Lidar()])`` of a world or
    ``AsBuilt(sensors=[Lidar(map=...)])`` of a scenario; on a robot of your own it runs in a `ScanController`. It is
    told poses and scans, not of obstacles, people and walls. A disc that moves in any direction drives along a course.

    In a static world the robot touches nothing, provided that every obstacle in a free cell lies within ``margin`` of
    the point of an occupied cell. **Not covered**: obstacles thinner than the distance of the beams, glass, obstacles
    outside the plane of the scan, people and other moving bodies, of which runs tell by the warning
    ``"movers_unwatched"``.

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
        If a number is out of range; when a run begins, if the robot has no lidar, is an outline that moves in any
        direction, or cannot stop within the map.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> walls = nav.StaticMap.from_polylines([[(1.5, -1.0), (1.5, 1.0)]])
    >>> robot = nav.DifferentialDriveRobot(max_turn_rate=2.0, max_turn_acceleration=6.0)
    >>> place = nav.Scenario(robot=robot, start=(0, 0), goal=(3, 0), walls=walls)
    >>> built = nav.robots.AsBuilt(sensors=[nav.Lidar(map=walls)])
    >>> nav.simulate(place, nav.ArcRollouts(), built=built).outcome
    'arrived'
    """

    MAPS_SCANS: ClassVar[bool] = True

    map: UnknownMap = field(default_factory=UnknownMap)
    margin: float = gain(0.03, unit="m", bounds=(0.01, 0.2))
    clearance: float = gain(0.06, unit="m", bounds=(0.0, 0.5))
    narrow_weight: float = gain(16.0, unit="", bounds=(0.0, 50.0))
    near_weight: float = gain(0.8, unit="", bounds=(0.0, 5.0))
    near_distance: float = gain(0.55, unit="m", bounds=(0.2, 1.5))
    unknown_weight: float = gain(0.3, unit="", bounds=(0.0, 5.0))
    beyond: float = gain(0.8, unit="s", bounds=(0.2, 5.0))
    replan: int = 3
    nodes: int = 4000
    verify: bool = True
    seed: int = 0
    _rollouts: _hrsafety.ArcRollouts = field(init=False, repr=False, compare=False)
    _native: _hrsafety.Law = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        rollouts = _hrsafety.ArcRollouts(
            map=instance("map", self.map, UnknownMap)._native,
            replan=count("replan", self.replan, most=10_000),
            nodes=count("nodes", self.nodes, most=MOST_NODES),
            verify=flag("verify", self.verify),
            seed=checked_seed("seed", self.seed),
            **self._as_numbers(*self.GAIN_NAMES),
        )
        self._set(_rollouts=rollouts, _native=_hrsafety.exploring_law(rollouts))
