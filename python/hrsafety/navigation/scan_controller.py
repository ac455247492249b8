"""A robot that knows scans and odometry alone: poses and scans come from outside, twists go out."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Annotated, Any, NamedTuple, NoReturn

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, count, instance, number, numbers, pair, positive, sequence
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError, SimulationError
from hrsafety.navigation.laws.arc_rollouts import ArcRollouts
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot
from hrsafety.navigation.sensing.lidar import Lidar, in_meters
from hrsafety.navigation.warnings.units import of_lidar
from hrsafety.plausibility import ResultWarning

__all__ = ["KnownCells", "LidarScan", "ScanCommand", "ScanController"]


SCAN_TIMEOUT = 0.3
"""A robot brakes after so many seconds without a scan."""
POSITION_TRACKING = 0.01
"""How far a robot may be from where its plan has it, in m."""


class LidarScan(NamedTuple):
    """Ranges of a lidar at an instant.

    Attributes
    ----------
    ranges : array_like of shape (beams,)
        In m: infinite, or ``range_max``, where nothing was hit, NaN where nothing is known.
    time : float or None
        When it was made in s; ``None``: at the update that tells of it.
    lidar : int
        Index among the lidars of the controller.
    """

    ranges: npt.ArrayLike
    time: float | None = None
    lidar: int = 0


@dataclass(frozen=True, kw_only=True, slots=True)
class ScanCommand:
    """Command of a robot with two wheels until the next update.

    Attributes
    ----------
    speed : float
        To have a control period from now, approached evenly, in m/s.
    turn_rate : float
        The same in rad/s.
    plan : tuple of (float, (float, float))
        Times from now in s, with speed in m/s and turn rate in rad/s, between which both change evenly: what to do
        without another update. It ends at rest.
    status : {"kept", "changed", "braking"}
        Whether the best twist is commanded, another one, or the plan before runs on until rest.
    arrived : bool
        Whether the goal was reached.
    time_to_go : float or None
        Time to the goal in s; ``None`` where no way is known.
    recovering : bool
        Whether the robot drives somewhere else, as it made no progress.
    blind : bool
        Whether no lidar told anything for too long: it brakes.
    off_plan : (float, float) or None
        Distance in m and angle in rad of the pose from where its plan has the robot, where they are more than the
        controller assumes: it brakes.
    forgotten : bool
        Whether the pose jumped, so that all that was seen before was forgotten.
    clock_set_back : bool
        Whether the update was not after the last one: it counted for nothing, and the robot brakes.
    ignored_scans : int
        Scans of the update that counted for nothing: too old, not newer than the last one of their lidar, or from an
        instant at which the pose is not known.
    unknown_beams : int
        Beams that read nothing at all in the scans that counted.
    scan_age : float
        Age of the scan of the lidar that told last the longest ago, in s; infinite before the first one.
    """

    speed: Annotated[float, "m/s"]
    turn_rate: Annotated[float, "rad/s"]
    plan: tuple[tuple[float, Pair], ...]
    status: str
    arrived: bool
    time_to_go: Annotated[float | None, "s"]
    recovering: bool
    blind: bool
    off_plan: Pair | None
    forgotten: bool
    clock_set_back: bool
    ignored_scans: int
    unknown_beams: int
    scan_age: Annotated[float, "s"]


class KnownCells(NamedTuple):
    """Cells of a rolling map at the last update.

    Attributes
    ----------
    kinds : ndarray of uint8, shape (rows, columns)
        0 unknown, 1 free, 2 occupied; rows along y.
    low : (float, float)
        Lowest corner in m.
    cell : float
        Side of a cell in m.
    way : ndarray, shape (n, 2)
        Places in m of the way of the guide from the robot on; empty where no way is known.
    """

    kinds: npt.NDArray[np.uint8]
    low: Pair
    cell: float
    way: Array


class ScanController:
    """A robot with two wheels in a place that it knows from its scans alone: poses and scans in, twists out.

    Every scan is entered with the pose of its own instant, found among the poses that were told: a scan that comes late
    loses nothing. Beams that read NaN tell nothing. Whatever is not as assumed makes the robot brake, and the command
    says why: no scan for ``scan_timeout``, a pose off the plan, a clock that is set back. After a pose that jumped all
    that was seen before is forgotten, as it was seen from elsewhere.

    **It knows nothing of people**: who moves is an obstacle where the last scan showed it, and may be driven into. What
    is thinner than the beams are apart, glass, and what is not in the plane of the scans are not covered either.

    Parameters
    ----------
    rollouts : ArcRollouts
        Choice of the twist.
    robot : DifferentialDriveRobot
        Speeds, accelerations and footprint; one without a footprint counts as a polygon of 16 sides around its disc.
    goal : (float, float)
        In the frame of the odometry, in m.
    lidars : sequence of Lidar
        Mounting, beams and ranges of each.
    control_period : float
        Time between updates in s.
    arrival_tolerance : float
        The robot has arrived this close to the goal, in m.
    scan_timeout : float
        After so many seconds without a scan of one of the lidars the robot stops.
    oldest_scan : float
        Scans that are older than this in s are ignored.
    position_tracking : float
        Largest distance in m of the robot from its plan until rest; plans keep so much more distance.
    heading_tracking : float
        Largest error in rad of its heading; plans keep the way of the farthest corner more distance.

    Raises
    ------
    InvalidParameterError
        If an argument is not valid, or the map is too small for the robot to stop within it.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import navigation as nav
    >>> robot = nav.DifferentialDriveRobot(max_turn_rate=2.0, max_turn_acceleration=5.0)
    >>> controller = nav.ScanController(nav.ArcRollouts(), robot, (3.0, 0.0), lidars=[nav.Lidar(beams=360)])
    >>> command = controller.update(0.0, (0.0, 0.0), 0.0, [np.full(360, np.inf)])
    >>> command.status, command.speed > 0.0
    ('kept', True)
    >>> controller.update(0.05, (0.0, 0.0), 0.0, [np.full(360, np.nan)]).unknown_beams
    360
    """

    __slots__ = ("_body", "_cell", "_goal", "_lidars", "_native", "_place", "_rollouts")

    def __init__(
        self,
        rollouts: ArcRollouts,
        robot: DifferentialDriveRobot,
        goal: npt.ArrayLike,
        *,
        lidars: Sequence[Lidar],
        control_period: float = 0.05,
        arrival_tolerance: float = 0.2,
        scan_timeout: float = SCAN_TIMEOUT,
        oldest_scan: float = 0.5,
        position_tracking: float = POSITION_TRACKING,
        heading_tracking: float = 0.03,
    ) -> None:
        self._rollouts = instance("rollouts", rollouts, ArcRollouts)
        self._cell = rollouts.map.cell
        self._place: Pair | None = None
        self._body = instance("robot", robot, DifferentialDriveRobot)
        self._lidars = tuple(
            instance(f"lidars[{index}]", lidar, Lidar)
            for index, lidar in enumerate(sequence("lidars", "be a sequence of lidars", lidars))
        )
        self._goal = pair("goal", goal)
        self._native = _hrsafety.ScanController(
            rollouts._rollouts,
            self._body._native,
            positive("control_period", control_period),
            [lidar._lidar for lidar in self._lidars],
            goal=self._goal,
            arrival_tolerance=number("arrival_tolerance", arrival_tolerance),
            scan_timeout=number("scan_timeout", scan_timeout),
            oldest_scan=number("oldest_scan", oldest_scan),
            position_tracking=number("position_tracking", position_tracking),
            heading_tracking=number("heading_tracking", heading_tracking),
        )

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Conditions of this controller that the guarantee does not cover."""
        found = []
        if not self._rollouts.verify:
            found.append(
                ResultWarning("not_verified", "verify", "plans are not verified: nothing keeps the robot from contact")
            )
        for index, lidar in enumerate(self._lidars):
            found += of_lidar(f"lidars[{index}]", lidar)
            outline, place = self._body.footprint, lidar.mounting[:2]
            inside = self._body.radius - math.hypot(*place) if outline is None else -float(outline.distance([place])[0])
            covered = max(0.0, inside)
            if lidar.range_min > covered:
                text = (
                    f"lidars[{index}] reads what is nearer than range_min, {lidar.range_min:.4g} m, as that far away, "
                    f"but the outline covers {covered:.4g} m around it only: it may touch what no beam tells of"
                )
                found.append(ResultWarning("blind_nearby", f"lidars[{index}].range_min", text))
        return tuple(found)

    def update(
        self,
        time: float,
        position: npt.ArrayLike | None,
        heading: float | None,
        scans: Iterable[LidarScan | npt.ArrayLike] = (),
    ) -> ScanCommand:
        """Tell pose and scans, and return what the robot is to do.

        Parameters
        ----------
        time : float
            Now, in s, of a monotonic clock.
        position : array_like of shape (2,), or None
            Where the odometry takes the robot to be, in m; ``None`` where that is not known: it brakes.
        heading : float or None
            Where it takes it to look, in rad.
        scans : iterable of LidarScan or array_like
            Scans that came since the last update: with lidar and instant, or ranges of the lidar of the same place,
            made now.

        Returns
        -------
        ScanCommand
            What to do until the next update.

        Raises
        ------
        InvalidParameterError
            If a value is not finite, a scan is later than the update or of another length, a range is negative or
            hardly in m. Nothing of the update counts then.
        """
        now = number("time", time)
        if (position is None) != (heading is None):
            missing = "position" if position is None else "heading"
            raise InvalidParameterError(missing, "be given together with the other of position and heading", None)
        pose = None if position is None or heading is None else (pair("position", position), number("heading", heading))
        self._place = None if pose is None else pose[0]
        told = [self._scan(index, scan, now) for index, scan in enumerate(sequence("scans", "be scans", scans))]
        fields: dict[str, Any] = self._native.update(now, pose, told)
        fields["plan"] = tuple((at, (rates[0], rates[1])) for at, rates in fields["plan"])
        return ScanCommand(**fields)

    def _scan(self, index: int, given: LidarScan | npt.ArrayLike, now: float) -> tuple[int, float, Array]:
        name = f"scans[{index}]"
        lidar, time, ranges = index, now, given
        if isinstance(given, LidarScan):
            lidar = count(f"{name}.lidar", given.lidar, least=0)
            time = now if given.time is None else number(f"{name}.time", given.time)
            ranges = given.ranges
        if lidar >= len(self._lidars):
            raise InvalidParameterError(f"{name}.lidar", f"be below {len(self._lidars)}, the number of lidars", lidar)
        found = np.ascontiguousarray(numbers(f"{name}.ranges", ranges))
        if found.shape != (self._lidars[lidar].beams,):
            raise ShapeError(f"{name}.ranges", f"({self._lidars[lidar].beams},)", found.shape)
        return lidar, time, in_meters(f"{name}.ranges", found, self._lidars[lidar])

    def restart(self, goal: npt.ArrayLike) -> None:
        """Forget everything, with a robot at rest and another goal.

        Parameters
        ----------
        goal : array_like of shape (2,)
            In m.
        """
        self._goal = pair("goal", goal)
        self._native.restart(self._goal)

    @property
    def known_cells(self) -> KnownCells:
        """Cells of the map at the last update."""
        low, kinds = self._native.cells()
        place = self._place
        way = np.empty((0, 2)) if place is None else self.way(place)
        return KnownCells(kinds, (low[0], low[1]), self._cell, way)

    def way(self, position: npt.ArrayLike) -> Array:
        """Return the way of the guide from a place on.

        Parameters
        ----------
        position : array_like of shape (2,)
            In m.

        Returns
        -------
        ndarray, shape (n, 2)
            Places in m, empty where no way is known.
        """
        return np.asarray(self._native.way(pair("position", position)), dtype=float).reshape(-1, 2)

    def __repr__(self) -> str:
        """Return goal and lidars."""
        return f"ScanController(goal={self._goal}, lidars={len(self._lidars)})"

    def __reduce__(self) -> NoReturn:
        """Refuse: what it has seen is not told."""
        raise SimulationError("a ScanController cannot be copied or pickled; make another with the same arguments")
