"""Models of people: how they decide where to walk."""

from __future__ import annotations

import math
from dataclasses import field, fields
from typing import ClassVar

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters, count, number, positive
from hrsafety._records import dataclass

__all__ = [
    "CollisionFreeSpeed",
    "Moussaid",
    "Pedestrian",
    "ReciprocalAvoidance",
    "SocialForce1995",
    "SocialForce2000",
]


class Pedestrian(Parameters):
    """Base of the models of people."""

    __slots__ = ()

    NAME: ClassVar[str]
    TITLE: ClassVar[str]  # words of legends
    cutoff: float | None
    _native: _hrsafety.CrowdModel

    def __post_init__(self) -> None:
        """Check the values."""
        names = [each.name for each in fields(self) if each.init and each.name != "cutoff"]  # type: ignore[arg-type]  # models are dataclasses
        counts = {"max_neighbors"} & set(names)
        values: dict[str, float] = {name: number(name, getattr(self, name)) for name in names if name not in counts}
        values |= {name: count(name, getattr(self, name), least=0, most=2**16) for name in counts}
        cutoff = None if self.cutoff is None else positive("cutoff", self.cutoff)
        self._set(**values, cutoff=cutoff)
        self._set(_native=_hrsafety.CrowdModel(self.NAME, **self.parameters))

    @property
    def parameters(self) -> dict[str, float]:
        """Its parameters by name, as the core takes them: a cutoff that is none is infinite."""
        values = {each.name: getattr(self, each.name) for each in fields(self) if each.init}  # type: ignore[arg-type]
        return values | {"cutoff": math.inf if self.cutoff is None else self.cutoff}

    @property
    def largest_step(self) -> float:
        """Largest step of the model in s; a world with a larger one splits it into equal parts."""
        return self._native.largest_step

    @property
    def max_speed_ratio(self) -> float:
        """Largest speed as a multiple of the desired one; infinite for a model without a bound."""
        return self._native.cap


@dataclass(frozen=True, kw_only=True, slots=True)
class SocialForce1995(Pedestrian):
    """Social force with elliptical potentials, Helbing and Molnar (1995).

    A neighbor repels with the exact gradient of ``V0 exp(-b/sigma)``, where b is half the minor axis of
    the ellipse along the way that the neighbor takes within ``step_time``. Those who meet exactly
    head-on pass on their right.

    Parameters
    ----------
    relaxation_time : float
        Time tau to reach the desired velocity, in s.
    strength : float
        V0 in m^2/s^2.
    range : float
        sigma in m.
    step_time : float
        Time of the way of neighbors, in s.
    wall_strength : float
        U0 of walls in m^2/s^2.
    wall_range : float
        R of walls in m.
    view_angle : float
        Half the angle of view phi in rad.
    behind : float
        Weight c of forces from out of view.
    cutoff : float or None
        Distance beyond which no person acts, in m; ``None``: everybody does.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.crowd.SocialForce1995().largest_step
    0.1
    """

    NAME: ClassVar[str] = "social_force_1995"
    TITLE: ClassVar[str] = "social force, 1995"

    relaxation_time: float = 0.5
    strength: float = 2.1
    range: float = 0.3
    step_time: float = 2.0
    wall_strength: float = 10.0
    wall_range: float = 0.2
    view_angle: float = math.radians(100.0)
    behind: float = 0.5
    cutoff: float | None = 5.0
    _native: _hrsafety.CrowdModel = field(init=False, repr=False, compare=False)


@dataclass(frozen=True, kw_only=True, slots=True)
class SocialForce2000(Pedestrian):
    """Social force with pressing and rubbing bodies, Helbing, Farkas and Vicsek (2000).

    Friction at walls brakes, as the source prints it. There is no bound of the speed.

    Parameters
    ----------
    relaxation_time : float
        Time tau to reach the desired velocity, in s.
    mass : float
        m in kg.
    strength : float
        A of people in N.
    range : float
        B in m.
    stiffness : float
        k in kg/s^2.
    friction : float
        kappa in kg/(m s).
    anisotropy : float
        lambda, the weight of what is behind; 1: directions do not matter.
    wall_strength : float
        A of walls in N.
    cutoff : float or None
        Distance beyond which no person acts, in m; ``None``: everybody does.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.crowd.SocialForce2000(anisotropy=0.5).largest_step
    0.01
    """

    NAME: ClassVar[str] = "social_force_2000"
    TITLE: ClassVar[str] = "social force, 2000"

    relaxation_time: float = 0.5
    mass: float = 80.0
    strength: float = 2000.0
    range: float = 0.08
    stiffness: float = 1.2e5
    friction: float = 2.4e5
    anisotropy: float = 1.0
    wall_strength: float = 2000.0
    cutoff: float | None = 2.5
    _native: _hrsafety.CrowdModel = field(init=False, repr=False, compare=False)


@dataclass(frozen=True, kw_only=True, slots=True)
class Moussaid(Pedestrian):
    """Behavioral model fitted to experiments, Moussaid et al. (2009), with groups (2010).

    Parameters
    ----------
    relaxation_time : float
        Time tau to reach the desired velocity, in s.
    strength : float
        A in m/s^2.
    gamma : float
        Range of the interaction per relative velocity.
    n, n_prime : float
        How narrow turning and slowing are.
    velocity_weight : float
        lambda, the weight of the relative velocity.
    side_bias : float
        epsilon, the bias to one side.
    wall_strength : float
        Push of walls in m/s^2.
    wall_range : float
        Range of walls in m.
    gaze : float
        beta_1 of groups, in 1/(s rad).
    cohesion, separation : float
        beta_2 and beta_3 of groups, in m/s^2.
    view_angle : float
        Half the angle of view phi of members of groups, in rad.
    contact_distance : float
        Distance d0 that members of groups keep, in m.
    cutoff : float or None
        Distance beyond which no person acts, in m; ``None``: everybody does.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.crowd.Moussaid(side_bias=0.0).max_speed_ratio
    1.3
    """

    NAME: ClassVar[str] = "moussaid"
    TITLE: ClassVar[str] = "Moussaïd"

    relaxation_time: float = 0.54
    strength: float = 4.5
    gamma: float = 0.35
    n: float = 2.0
    n_prime: float = 3.0
    velocity_weight: float = 2.0
    side_bias: float = 0.005
    wall_strength: float = 3.0
    wall_range: float = 0.1
    gaze: float = 4.0
    cohesion: float = 3.0
    separation: float = 1.0
    view_angle: float = math.pi / 2
    contact_distance: float = 0.55
    cutoff: float | None = 8.0
    _native: _hrsafety.CrowdModel = field(init=False, repr=False, compare=False)


@dataclass(frozen=True, kw_only=True, slots=True)
class CollisionFreeSpeed(Pedestrian):
    """Collision-free speed model, Tordeux, Chraibi and Seyfried (2016), with the numbers of JuPedSim.

    Parameters
    ----------
    time_gap : float
        T, the time gap to whoever is ahead, in s.
    strength : float
        a of people.
    range : float
        D of people, in m.
    wall_strength : float
        a of walls.
    wall_range : float
        D of walls, in m.
    cutoff : float or None
        Distance beyond which no person acts, in m; ``None``: everybody does.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.crowd.CollisionFreeSpeed(time_gap=0.5).max_speed_ratio
    1.0
    """

    NAME: ClassVar[str] = "collision_free_speed"
    TITLE: ClassVar[str] = "collision-free speed"

    time_gap: float = 1.0
    strength: float = 8.0
    range: float = 0.1
    wall_strength: float = 5.0
    wall_range: float = 0.02
    cutoff: float | None = 3.0
    _native: _hrsafety.CrowdModel = field(init=False, repr=False, compare=False)


@dataclass(frozen=True, kw_only=True, slots=True)
class ReciprocalAvoidance(Pedestrian):
    """People who avoid each other reciprocally, van den Berg et al. (2011), as RVO2 does it.

    Walls are never traded for people. Two people of this model never touch.

    Parameters
    ----------
    horizon : float
        Time without contact with others, in s.
    wall_horizon : float
        The same with walls, in s.
    max_neighbors : int
        How many of the nearest are avoided.
    margin : float
        Added to each radius, in m.
    cutoff : float or None
        Distance beyond which no person acts, in m; ``None``: everybody does.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.crowd.ReciprocalAvoidance(horizon=2.0).largest_step
    0.25
    """

    NAME: ClassVar[str] = "reciprocal_avoidance"
    TITLE: ClassVar[str] = "reciprocal avoidance"

    horizon: float = 5.0
    wall_horizon: float = 0.5
    max_neighbors: int = 10
    margin: float = 0.01
    cutoff: float | None = 10.0
    _native: _hrsafety.CrowdModel = field(init=False, repr=False, compare=False)
