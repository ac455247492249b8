"""Laws of the first category: they plan with the positions and velocities of now."""

from __future__ import annotations

import math
from typing import Literal, get_args

from hrsafety._arguments import count, flag, instance, not_negative, word
from hrsafety._bounds import MOST_DRAWS
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.pedestrians import Moussaid, Pedestrian
from hrsafety.navigation.laws.declared import Law, gain, law

__all__ = [
    "FieldDStar",
    "OptimalReciprocalCollisionAvoidance",
    "RapidlyExploringRandomTree",
    "SocialForce",
    "VelocityObstacle",
    "VelocitySelection",
]

# More than this per step would never end.

VelocitySelection = Literal["to_goal", "fastest", "time_and_risk"]


@law("velocity_obstacle", "vo", "velocity_obstacles", color="#999933", plans=True)
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

    margin: float = gain(0.4, unit="m", bounds=(0.0, 0.4))
    horizon: float = gain(float("inf"), unit="s", bounds=(0.5, 20.0))
    risk_weight: float = gain(1.0, unit="s^2", bounds=(0.0, 10.0))
    sector: float = gain(1.0, unit="rad", bounds=(0.2, 3.0))
    selection: VelocitySelection = "to_goal"

    def __post_init__(self) -> None:
        """Check the values."""
        word("selection", self.selection, get_args(VelocitySelection))
        self._as_numbers(*self.GAIN_NAMES)
        # These two are not examined by every selection, but by every search.
        not_negative("risk_weight", self.risk_weight)
        if not 0.0 <= self.sector <= math.pi:
            raise InvalidParameterError("sector", "be an angle from 0 to pi", self.sector)
        self._make(selection=self.selection)


@law("optimal_reciprocal_collision_avoidance", "orca", "rvo2", color="#CC6677", plans=True)
@dataclass(frozen=True, kw_only=True, slots=True)
class OptimalReciprocalCollisionAvoidance(Law):
    """Optimal reciprocal collision avoidance of van den Berg, Guy, Lin and Manocha (2011).

    Each obstacle forbids a half-plane of velocities, which keeps the robot clear of it for the
    time of the horizon; the permitted velocity nearest to the one straight to the goal is taken.
    Rectangles that stand are never traded for people: where no velocity is permitted, the half-planes of
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
        a robot that meets a person head-on would only slow down.
    reach : float
        Obstacles whose surface is farther away are not examined, in m.
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

    horizon: float = gain(5.03, unit="s", bounds=(0.2, 8.0))
    margin: float = gain(0.4, unit="m", bounds=(0.0, 0.4))
    turn: float = gain(0.01, unit="rad", bounds=(0.0, 0.5))
    reach: float = gain(5.0, unit="m", bounds=(1.0, 10.0))
    reciprocal: bool = False

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(reciprocal=flag("reciprocal", self.reciprocal))
        self._make(share=0.5 if self.reciprocal else 1.0)


@law("rapidly_exploring_random_tree", "rrt", "tree", color="#882255", plans=True)
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

    step: float = gain(0.4158, unit="m", bounds=(0.1, 0.5))
    goal_probability: float = gain(0.3298, unit="", bounds=(0.05, 0.4), symbol="p_g")
    waypoint_probability: float = gain(0.5008, unit="", bounds=(0.0, 0.6), symbol="p_w")
    margin: float = gain(0.4, unit="m", bounds=(0.0, 0.4))
    horizon: float = gain(0.489, unit="s", bounds=(0.0, 3.0))
    room: float = gain(3.0, unit="m", bounds=(3.0, 3.0))
    look_ahead: float = gain(0.2612, unit="m", bounds=(0.05, 0.4))
    waypoints: int = 50
    draws: int = 2000
    keeps_path: bool = True
    safety_draws: int = 32

    def __post_init__(self) -> None:
        """Check the values."""
        self._as_numbers(*self.GAIN_NAMES)
        self._set(
            waypoints=count("waypoints", self.waypoints, least=0),
            draws=count("draws", self.draws),
            keeps_path=flag("keeps_path", self.keeps_path),
            safety_draws=count("safety_draws", self.safety_draws, least=0),
        )
        for name in ("waypoints", "draws", "safety_draws"):
            if getattr(self, name) > MOST_DRAWS:
                raise InvalidParameterError(name, f"be at most {MOST_DRAWS}", getattr(self, name))
        self._make(
            waypoints=self.waypoints, draws=self.draws, keeps_path=self.keeps_path, safety_draws=self.safety_draws
        )


@law("field_d_star", "dstar", "d_star", "field_dstar", color="#AA4499", plans=True)
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

    resolution: float = gain(0.1, unit="m", bounds=(0.1, 0.1))
    margin: float = gain(0.3175, unit="m", bounds=(0.0, 0.4))
    horizon: float = gain(0.2466, unit="s", bounds=(0.0, 3.0))
    room: float = gain(3.0, unit="m", bounds=(3.0, 3.0))
    look_ahead: float = gain(0.301, unit="m", bounds=(0.05, 0.4))


@law("social_force", "sfm", color="#777777", plans=True)
@dataclass(frozen=True, kw_only=True, slots=True)
class SocialForce(Law):
    """A robot that walks as a person of a model does, on its way to the goal.

    The model decides on an acceleration, or a velocity, as it does for people; walls push as they push people. The
    speed is at most that of the robot. With a map its boundary points are the walls.

    Parameters
    ----------
    people_weight : float
        Weight of the pushes of others.
    speed_share : float
        Desired speed as a share of the largest one, at most 1.
    model : model of people or str
        Any of `nav.crowd`, or the name of one with its defaults.

    Raises
    ------
    InvalidParameterError
        If a number is not positive, the share is above 1, or the model is none.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> scene = nav.Scenario(start=(0, 0), goal=(4, 0), obstacles=[nav.Disc(center=(2, 0.3), radius=0.2)])
    >>> nav.simulate(scene, nav.SocialForce()).outcome
    'arrived'
    """

    people_weight: float = gain(1.0, unit="", bounds=(0.1, 5.0))
    speed_share: float = gain(1.0, unit="", bounds=(0.2, 1.0))
    model: Pedestrian | str = Moussaid()

    def __post_init__(self) -> None:
        """Check the values."""
        given = self.model
        if isinstance(given, str):
            known = {kind.NAME: kind for kind in Pedestrian.__subclasses__()}
            given = known[word("model", given, list(known))]()
        model = instance("model", given, Pedestrian)
        self._set(model=model)
        self._make(model=model.NAME, **model.parameters)
