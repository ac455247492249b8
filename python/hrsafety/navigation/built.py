"""Runs of robots as built."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from hrsafety import _hrsafety
from hrsafety._arguments import Array, flag, instance, number
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.laws.python_law import AnyLaw, as_law
from hrsafety.navigation.performance import Performance, check_weights
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import Trajectory, without_obstacles
from hrsafety.tables import Columns, each, plane

__all__ = ["BuiltTrajectory", "evaluate_built", "simulate_built"]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BuiltTrajectory(Trajectory):
    """One run of a robot as built: a `Trajectory` with what its motors and its controller know.

    Attributes
    ----------
    scenario, law, time, position, velocity, force, stabilizing, lyapunov
        As for `Trajectory`.
    obstacle_position, distance, outcome, arrival_time, path_length
        As for `Trajectory`.
    min_distance, min_clearance, contact_time, contact_speed
        As for `Trajectory`.
    heading : ndarray, shape (n,)
        Heading in rad; it counts whole turns.
    wheel_current : ndarray, shape (n, w)
        Mean motor currents in A over the step that ends at the row.
    energy : float
        Electrical loss of the motors, in J: with wheels that have controllers, of their currents.
    wheel_speed : ndarray, shape (n, w)
        Wheel speeds in rad/s.
    energy_used : ndarray, shape (n,)
        Electrical loss up to each row, in J.
    reference_position : ndarray, shape (n, 2)
        Position of the point mass that the law drives, in m.
    seen_position : ndarray, shape (n, 2)
        Position of the robot as the law knows it since the last sample, in m.
    """

    wheel_speed: Array
    energy_used: Array
    reference_position: Array
    seen_position: Array

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each instant.

        Returns
        -------
        dict of str to ndarray
            Those of `Trajectory`, then what motors and controller know.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> run = nav.built.simulate_built(scenarios.configuration("c1"), nav.VirtualForceField())
        >>> list(run.columns())[-4:]
        ['reference_x_m', 'reference_y_m', 'seen_x_m', 'seen_y_m']
        """
        found = Trajectory.columns(self) | each("wheel_{}_speed", self.wheel_speed, "rad/s")
        found |= {"energy_used_J": self.energy_used, **plane("reference_{}", self.reference_position, "m")}
        return found | plane("seen_{}", self.seen_position, "m")


def simulate_built(
    scenario: Scenario,
    law: AnyLaw,
    built: AsBuilt | None = None,
    *,
    step: float = 0.01,
    stop_on_contact: bool = False,
) -> BuiltTrajectory:
    """Run one robot as built from start to goal.

    The law is asked once a control period, with the positions as measured, and its force is held. A
    holonomic robot moves as a point mass; a two-wheel robot follows one. With ideal motion and
    exact sensing the run of a holonomic robot is that of `simulate`, bit for bit.

    Parameters
    ----------
    scenario : Scenario
        Robot, start, goal, obstacles, measurement.
    law : Law, callable or object
        What drives the robot; see `PythonLaw` for laws of your own.
    built : AsBuilt or None
        How the robot is built; ``AsBuilt()`` when ``None``.
    step : float
        Motion step in s, which divides the control period.
    stop_on_contact : bool
        Whether the run ends at the first contact.

    Returns
    -------
    BuiltTrajectory
        The run.

    Raises
    ------
    InvalidParameterError
        If the step is not positive and finite or does not divide the control period, or an
        argument is of another kind.
    SimulationError
        If the state became non-finite.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from hrsafety import navigation as nav, scenarios
    >>> scene = replace(scenarios.configuration("n1"), robot=nav.DifferentialDriveRobot())
    >>> run = nav.built.simulate_built(scene, nav.VirtualForceField())
    >>> run.outcome, run.wheel_speed.shape[1]
    ('arrived', 2)
    """
    law, built = _checked(scenario, law, built)
    fields = _hrsafety.built_simulate(
        scenario._native,
        law._native,
        built._native,
        step=number("step", step),
        stop_on_contact=flag("stop_on_contact", stop_on_contact),
    )
    return BuiltTrajectory(scenario=scenario, law=law, **fields)


def evaluate_built(
    scenario: Scenario,
    law: AnyLaw,
    weights: Sequence[float] = (1 / 3, 1 / 3, 1 / 3),
    built: AsBuilt | None = None,
    *,
    step: float = 0.01,
) -> Performance:
    """Run one robot as built and score it as `evaluate` does.

    T* and L* come from the same robot and law without obstacles and without measurement errors.

    Parameters
    ----------
    scenario : Scenario
        Robot, start, goal, obstacles, measurement.
    law : Law, callable or object
        What drives the robot; see `PythonLaw` for laws of your own.
    weights : sequence of float
        Weights of time, distance and energy; not negative, sum 1.
    built : AsBuilt or None
        How the robot is built; ``AsBuilt()`` when ``None``.
    step : float
        As for `simulate_built`.

    Returns
    -------
    Performance
        total, arrival_time, avoidance, energy_saving and both trajectories.

    Raises
    ------
    InvalidParameterError
        As `simulate_built`, or if the weights are negative or do not sum to 1.
    SimulationError
        If the state became non-finite.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from hrsafety import navigation as nav, scenarios
    >>> scene = replace(scenarios.configuration("n1"), robot=nav.DifferentialDriveRobot())
    >>> 0.0 < nav.built.evaluate_built(scene, nav.VirtualForceField()).total < 1.0
    True
    """
    law, built = _checked(scenario, law, built)
    scores, run, nominal = _hrsafety.built_evaluate(
        scenario._native, law._native, built._native, check_weights(weights), step=number("step", step)
    )
    free = replace(without_obstacles(scenario), measurement=None, seed=0)
    return Performance(
        **scores,
        trajectory=BuiltTrajectory(scenario=scenario, law=law, **run),
        nominal=BuiltTrajectory(scenario=free, law=law, **nominal),
    )


def _checked(scenario: Scenario, law: AnyLaw, built: AsBuilt | None) -> tuple[Law, AsBuilt]:
    instance("scenario", scenario, Scenario)
    return as_law(law), AsBuilt() if built is None else instance("built", built, AsBuilt)
