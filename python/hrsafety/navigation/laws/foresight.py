"""Foresight: a search through space and time among predicted people, whose first velocity is taken."""

from __future__ import annotations

from dataclasses import field

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters, count
from hrsafety._records import dataclass

__all__ = ["Foresight"]

MOST_STAGES = 50
"""Most stages of a search."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Foresight(Parameters):
    """Choice of the velocity that begins the cheapest way through space and time among predicted people.

    Positions and velocities of people are estimated from measurements with an error, that of the shield, and
    predicted at a constant velocity, along the walls of a map. A program over ``stages`` steps of ``step`` seconds
    tells what the rest of the way costs from every node of a grid around the robot: time, the risk of a contact and
    discomfort. The last velocity, rest, braking and 36 directions at three speeds are driven for the first step, and
    the cheapest one that the shield verifies is taken. The law within has no say; without a verified velocity the
    robot executes the rest of the plan that was verified last. A robot with two wheels drives toward them on arcs,
    also backwards. Bodies that are no discs are priced by the circles around them, and verified by their outlines.
    Beside walls a robot with a footprint keeps its outline off in the first step, narrow places are as dear as for the
    guide, and two wheels line up with gaps; without a shield it keeps the circle off walls.

    Parameters
    ----------
    stages : int
        Stages K of the program, from 2 to 50.
    step : float
        Time dt of a stage in s.
    clearance : float
        Distance y of the surfaces at which a contact counts by half, in m.
    risk_weight : float
        Cost of a certain contact, as a multiple of the time that it lasts.
    comfort : float
        Distance of the surfaces in m: farther away people cost nothing but risk.
    comfort_weight : float
        Cost of touching, as a multiple of the time, without the risk.
    change_weight : float
        Cost of another velocity than the last one, in s for a change by the largest speed.
    speed_weight : float
        Cost of being faster than the preferred speed, as a multiple of the time and of the excess over that speed.
    spread : float
        Growth of the uncertainty of predicted places, in m/s.
    acceleration : float
        Acceleration q of people that the estimate expects, in m/s^2.

    Raises
    ------
    InvalidParameterError
        If a number is negative or not finite, one that must be positive is zero, or there are too few or too many
        stages.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(), foresight=nav.Foresight())
    >>> nav.simulate(scenarios.random_traffic(12, seed=1), law).outcome
    'arrived'
    """

    stages: int = 12
    step: float = 0.4
    clearance: float = 0.08
    risk_weight: float = 40.0
    comfort: float = 0.4
    comfort_weight: float = 0.6
    change_weight: float = 0.1
    speed_weight: float = 0.5
    spread: float = 0.1
    acceleration: float = 1.0
    _native: _hrsafety.Foresight = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        names = ("step", "clearance", "risk_weight", "comfort", "comfort_weight")
        more = ("change_weight", "speed_weight", "spread", "acceleration")
        self._set(stages=count("stages", self.stages, least=2, most=MOST_STAGES))
        self._set(_native=_hrsafety.Foresight(stages=self.stages, **self._as_numbers(*names, *more)))
