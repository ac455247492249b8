"""One run, recorded and scored."""

from __future__ import annotations

from collections.abc import Sequence

from hrsafety import _hrsafety
from hrsafety._arguments import flag, instance, number
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation import built
from hrsafety.navigation.laws.python_law import AnyLaw, as_law
from hrsafety.navigation.performance import Performance, check_weights
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import Integrator, Trajectory, without_obstacles

__all__ = ["evaluate", "simulate"]


def simulate(
    scenario: Scenario,
    law: AnyLaw,
    *,
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
    stop_on_contact: bool = False,
) -> Trajectory:
    """Run one robot from start to goal.

    Parameters
    ----------
    scenario : Scenario
        Robot, start, goal, obstacles.
    law : Law, callable or object
        What drives the robot; see `PythonLaw` for laws of your own.
    integrator : {"semi_implicit_euler", "rk4"}
        Velocity first and position with the new velocity, or Runge-Kutta of order 4 with the
        speed limit in every stage.
    step : float
        Motion step in s.
    hold : bool
        Whether the force is computed once a control period and held, as a sampled controller
        does; otherwise at every step (``"rk4"``: at every stage). With ``hold`` the step must
        divide the control period. A measurement needs ``hold``.
    stop_on_contact : bool
        Whether the run ends at the first contact.

    Returns
    -------
    Trajectory
        The run; a `BuiltTrajectory` for a `DifferentialDriveRobot`, which moves by
        semi-implicit Euler with a held force, as `simulate_built` does.

    Raises
    ------
    InvalidParameterError
        If the step is not positive and finite or does not divide the control period, or a
        word is unknown.
    SimulationError
        If the state became non-finite.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
    >>> run.outcome, round(run.arrival_time, 2), round(float(run.min_distance[0]), 3)
    ('arrived', 6.63, 0.536)
    """
    instance("scenario", scenario, Scenario)
    law = as_law(law)
    if isinstance(scenario.robot, DifferentialDriveRobot):
        _check_held(integrator, hold)
        return built.simulate_built(scenario, law, step=step, stop_on_contact=stop_on_contact)
    fields = _hrsafety.simulate(
        scenario._native,
        law._native,
        integrator,
        number("step", step),
        flag("hold", hold),
        flag("stop_on_contact", stop_on_contact),
    )
    return Trajectory(scenario=scenario, law=law, **fields)


def evaluate(
    scenario: Scenario,
    law: AnyLaw,
    weights: Sequence[float] = (1 / 3, 1 / 3, 1 / 3),
    *,
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
) -> Performance:
    """Run one robot and score it, Zeng (2011), section 5.6.

    ``H = k (w_T T*/T + w_D mean_i min(d_s,i / d_s,i*, 1) + w_E L*/L)`` with k = 0 after a
    contact or without arrival, ``d_s = d - rho_r - rho_obs`` and
    ``d_s* = r_2 - rho_r - rho_obs``. T* and L* come from the same law without obstacles.

    Parameters
    ----------
    scenario : Scenario
        Robot, start, goal, obstacles.
    law : Law, callable or object
        What drives the robot; see `PythonLaw` for laws of your own.
    weights : sequence of float
        Weights of time, distance and energy; not negative, sum 1.
    integrator, step, hold
        As for `simulate`.

    Returns
    -------
    Performance
        total, arrival_time, avoidance, energy_saving and both trajectories.

    Raises
    ------
    InvalidParameterError
        As `simulate`, or if the weights are negative or do not sum to 1.
    SimulationError
        If the state became non-finite.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> round(nav.evaluate(scenarios.configuration("c1"), nav.VirtualForceField()).total, 2)
    0.65
    """
    instance("scenario", scenario, Scenario)
    law = as_law(law)
    if isinstance(scenario.robot, DifferentialDriveRobot):
        _check_held(integrator, hold)
        return built.evaluate_built(scenario, law, weights, step=step)
    scores, run, nominal = _hrsafety.evaluate(
        scenario._native, law._native, check_weights(weights), integrator, number("step", step), flag("hold", hold)
    )
    return Performance(
        **scores,
        trajectory=Trajectory(scenario=scenario, law=law, **run),
        nominal=Trajectory(scenario=without_obstacles(scenario), law=law, **nominal),
    )


def _check_held(integrator: Integrator, hold: bool) -> None:
    """Refuse what a two-wheel robot cannot do."""
    if flag("hold", hold) is False:
        raise InvalidParameterError("hold", "be True for a DifferentialDriveRobot", hold)
    if integrator != "semi_implicit_euler":
        raise InvalidParameterError("integrator", 'be "semi_implicit_euler" for a DifferentialDriveRobot', integrator)
