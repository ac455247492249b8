"""Laws of the first category: they plan with the positions and velocities of now."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import ClassVar, Literal, get_args

from hrsafety import _hrsafety
from hrsafety._arguments import count, flag, not_negative, number, word
from hrsafety._bounds import MOST_DRAWS
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.laws.force_laws import Law

__all__ = [
    "FieldDStar",
    "OptimalReciprocalCollisionAvoidance",
    "RapidlyExploringRandomTree",
    "VelocityObstacle",
    "VelocitySelection",
]

# More than this per step would never end.

VelocitySelection = Literal["to_goal", "fastest", "time_and_risk"]


@dataclass(frozen=True, kw_only=True, slots=True)
class VelocityObstacle(Law):
    """Velocity obstacles of Fiorini and Shiller (1998).

    A velocity is free if the robot at that velocity touches nothing that keeps its own velocity,
    up to the horizon. Each control period the robot takes the best free velocity that it can
    reach within the period; the best one is found exactly, among the goal's direction, the edges
    of the velocity obstacles, the limits of speed and acceleration, and where they cross. The
    way that the robot covers while it changes its velocity is taken into account. If nothing is
    free with the margin, the margin is dropped; if nothing is free at all, the velocity with the
    latest contact is taken. The command is the force ``m (v* - V)/T_s``.

    Parameters
    ----------
    margin : float
        Distance that is kept between the surfaces, in m. The default is the search of appendix C of
        Zeng (2011) over c1, c2 and c4; it ends at the largest margin that is searched. Their score
        does not depend on a horizon of 3.1 s or more.
    horizon : float
        Contacts that are farther in the future do not count, in s; may be infinite.
    risk_weight : float
        Weight of the inverse time to contact in ``"time_and_risk"``, in s^2.
    sector : float
        Half of the sector around the goal's direction for ``"fastest"``, in rad, at most pi.
    selection : {"to_goal", "fastest", "time_and_risk"}
        Which free velocity is the best one: the largest component towards the goal; the largest
        speed within a sector around the goal's direction (both of Fiorini and Shiller 1998); the
        least sum of time to the goal and risk (Large, Laugier and Shiller 2005).

    Raises
    ------
    InvalidParameterError
        If a number is negative or not finite (the horizon may be infinite but not zero), or the
        selection is unknown.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> run = nav.simulate(scenarios.configuration("c1"), nav.VelocityObstacle())
    >>> run.outcome, round(float(run.min_clearance[0]), 2)
    ('arrived', 0.4)
    """

    GAIN_NAMES: ClassVar[tuple[str, ...]] = ("margin", "horizon", "risk_weight", "sector")
    GAIN_BOUNDS: ClassVar[Mapping[str, tuple[float, float]]] = MappingProxyType(
        {"margin": (0.0, 0.4), "horizon": (0.5, 20.0), "risk_weight": (0.0, 10.0), "sector": (0.2, 3.0)}
    )
    GAIN_UNITS: ClassVar[Mapping[str, str]] = MappingProxyType(
        {"margin": "m", "horizon": "s", "risk_weight": "s^2", "sector": "rad"}
    )

    margin: float = 0.4
    horizon: float = float("inf")
    risk_weight: float = 1.0
    sector: float = 1.0
    selection: VelocitySelection = "to_goal"
    _native: _hrsafety.Law = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        word("selection", self.selection, get_args(VelocitySelection))
        numbers = self._as_numbers(*self.GAIN_NAMES)
        # These two are not looked at by every selection, but by every search.
        not_negative("risk_weight", self.risk_weight)
        if not 0.0 <= self.sector <= math.pi:
            raise InvalidParameterError("sector", "be an angle from 0 to pi", self.sector)
        self._set(_native=_hrsafety.Law.velocity_obstacle(**numbers, selection=self.selection))


@dataclass(frozen=True, kw_only=True, slots=True)
class OptimalReciprocalCollisionAvoidance(Law):
    """Optimal reciprocal collision avoidance of van den Berg, Guy, Lin and Manocha (2011).

    Each obstacle forbids a half-plane of velocities, which keeps the robot clear of it for the
    time of the horizon; the permitted velocity nearest to the one straight to the goal is taken.
    Rectangles are never traded for people: where no velocity is permitted, the half-planes of
    people are violated as little as possible. The command is the force ``m (v* - V)/T_s``.

    Parameters
    ----------
    horizon : float
        Time within which no contact may come, in s. Horizon and margin are the search of appendix C
        of Zeng (2011) over c1, c2 and c4, for which a reach of 2.2 m or more makes no difference.
    margin : float
        Distance that is kept between the surfaces, in m. With the default the robot stops before
        the passage of c3; with 0.01 m and a horizon of 2 s it drives through.
    turn : float
        Angle by which the wanted velocity is turned to the left of the goal, in rad. Without it
        a robot that meets somebody head-on would only slow down.
    reach : float
        Obstacles whose surface is farther away are not looked at, in m.
    reciprocal : bool
        Whether others avoid the robot as it avoids them, so that each takes half of it. People
        of the scenarios do not give way: the default leaves all of it to the robot.

    Raises
    ------
    InvalidParameterError
        If a number is negative or not finite, or the horizon or the reach is zero.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> nav.simulate(scenarios.configuration("c2"), nav.OptimalReciprocalCollisionAvoidance()).outcome
    'arrived'
    """

    GAIN_NAMES: ClassVar[tuple[str, ...]] = ("horizon", "margin", "turn", "reach")
    GAIN_BOUNDS: ClassVar[Mapping[str, tuple[float, float]]] = MappingProxyType(
        {"horizon": (0.2, 8.0), "margin": (0.0, 0.4), "turn": (0.0, 0.5), "reach": (1.0, 10.0)}
    )
    GAIN_UNITS: ClassVar[Mapping[str, str]] = MappingProxyType(
        {"horizon": "s", "margin": "m", "turn": "rad", "reach": "m"}
    )

    horizon: float = 5.03
    margin: float = 0.4
    turn: float = 0.01
    reach: float = 5.0
    reciprocal: bool = False
    _native: _hrsafety.Law = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(reciprocal=flag("reciprocal", self.reciprocal))
        numbers = {name: number(name, getattr(self, name)) for name in self.GAIN_NAMES}
        self._set(**numbers)
        share = 0.5 if self.reciprocal else 1.0
        self._set(_native=_hrsafety.Law.reciprocal(**numbers, share=share))


@dataclass(frozen=True, kw_only=True, slots=True)
class RapidlyExploringRandomTree(Law):
    """Extended rapidly-exploring random tree of Bruce and Veloso (2002, 2006).

    A new tree grows at every control step: towards the goal, towards points of earlier paths, or
    anywhere. The robot drives at full speed towards a point a little ahead on the path, keeps to
    what is left of it while that is free and not longer than the new one, and checks that it can
    still stop. Moving obstacles block the way that they take within the horizon at their present
    velocity. The draws are those of the scenario's seed. None of the numbers is given by the
    source: those that a search can vary are the search of its appendix C over c1, c2 and c4 with
    eight draws each, the others are choices of this package.

    Parameters
    ----------
    step : float
        Length of an edge in m.
    goal_probability, waypoint_probability : float
        Probability of growing towards the goal, and towards a point of an earlier path.
    margin : float
        Distance kept from obstacles besides the radii, in m.
    horizon : float
        How long ahead moving obstacles block their way, in s.
    room : float
        How far points are drawn beyond start and goal, in m.
    look_ahead : float
        Distance along the path of the point that the robot heads for, in m.
    waypoints : int
        Number of points of earlier paths that are remembered.
    draws : int
        Points drawn for one tree.
    keeps_path : bool
        Whether the last path is kept while it is free and not longer.
    safety_draws : int
        Velocities tried when the wanted one leaves no room to stop; 0 drops the check.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range, or the probabilities add up to more than 1.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> nav.simulate(scenarios.configuration("c3"), nav.RapidlyExploringRandomTree()).outcome
    'arrived'
    """

    GAIN_NAMES: ClassVar[tuple[str, ...]] = (
        "step",
        "goal_probability",
        "waypoint_probability",
        "margin",
        "horizon",
        "room",
        "look_ahead",
    )
    GAIN_BOUNDS: ClassVar[Mapping[str, tuple[float, float]]] = MappingProxyType(
        {
            "step": (0.1, 0.5),
            "goal_probability": (0.05, 0.4),
            "waypoint_probability": (0.0, 0.6),
            "margin": (0.0, 0.4),
            "horizon": (0.0, 3.0),
            "room": (3.0, 3.0),
            "look_ahead": (0.05, 0.4),
        }
    )
    GAIN_UNITS: ClassVar[Mapping[str, str]] = MappingProxyType(
        {
            "step": "m",
            "goal_probability": "",
            "waypoint_probability": "",
            "margin": "m",
            "horizon": "s",
            "room": "m",
            "look_ahead": "m",
        }
    )

    step: float = 0.4158
    goal_probability: float = 0.3298
    waypoint_probability: float = 0.5008
    margin: float = 0.4
    horizon: float = 0.489
    room: float = 3.0
    look_ahead: float = 0.2612
    waypoints: int = 50
    draws: int = 2000
    keeps_path: bool = True
    safety_draws: int = 32
    _native: _hrsafety.Law = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        numbers = self._as_numbers(*self.GAIN_NAMES)
        self._set(
            waypoints=count("waypoints", self.waypoints, least=0),
            draws=count("draws", self.draws),
            keeps_path=flag("keeps_path", self.keeps_path),
            safety_draws=count("safety_draws", self.safety_draws, least=0),
        )
        for name in ("waypoints", "draws", "safety_draws"):
            if getattr(self, name) > MOST_DRAWS:
                raise InvalidParameterError(name, f"be at most {MOST_DRAWS}", getattr(self, name))
        native = _hrsafety.Law.random_tree(
            **numbers,
            waypoints=self.waypoints,
            draws=self.draws,
            keeps_path=self.keeps_path,
            safety_draws=self.safety_draws,
        )
        self._set(_native=native)


@dataclass(frozen=True, kw_only=True, slots=True)
class FieldDStar(Law):
    """Field D* of Ferguson and Stentz (2006): a path of least cost over a grid, repaired as things move.

    The path may cross cells in any direction. Cells into which an obstacle, grown by the radius
    of the robot and the margin, reaches now or within the horizon at its present velocity are
    blocked. The robot drives at full speed towards a point a little ahead on the path; without a
    way it waits. None of the numbers is given by the source: margin, horizon and look-ahead are the
    search of its appendix C over c1, c2 and c4, the others are choices of this package.

    Parameters
    ----------
    resolution : float
        Side of a cell in m.
    margin : float
        Distance kept from obstacles besides the radii, in m.
    horizon : float
        How long ahead moving obstacles block their way, in s.
    room : float
        How far the grid extends beyond start and goal, in m.
    look_ahead : float
        Distance along the path of the point that the robot heads for, in m.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range; when it runs, if the grid is too large.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> nav.simulate(scenarios.configuration("c3"), nav.FieldDStar()).outcome
    'arrived'
    """

    GAIN_NAMES: ClassVar[tuple[str, ...]] = ("resolution", "margin", "horizon", "room", "look_ahead")
    GAIN_BOUNDS: ClassVar[Mapping[str, tuple[float, float]]] = MappingProxyType(
        {
            "resolution": (0.1, 0.1),
            "margin": (0.0, 0.4),
            "horizon": (0.0, 3.0),
            "room": (3.0, 3.0),
            "look_ahead": (0.05, 0.4),
        }
    )
    GAIN_UNITS: ClassVar[Mapping[str, str]] = MappingProxyType(
        {"resolution": "m", "margin": "m", "horizon": "s", "room": "m", "look_ahead": "m"}
    )

    resolution: float = 0.1
    margin: float = 0.3175
    horizon: float = 0.2466
    room: float = 3.0
    look_ahead: float = 0.301
    _native: _hrsafety.Law = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(_native=_hrsafety.Law.field_d_star(**self._as_numbers(*self.GAIN_NAMES)))
