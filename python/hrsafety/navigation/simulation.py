"""One run, recorded and scored."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import count, flag, instance, number, sequence, word
from hrsafety._bounds import MOST_INTERVAL
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.laws.python_law import AnyLaw, as_law
from hrsafety.navigation.performance import Performance, check_weights
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import OPTIONAL_COLUMNS, Integrator, Trajectory, without_obstacles
from hrsafety.navigation.warnings.units import of_scenarios
from hrsafety.plausibility import telling

if TYPE_CHECKING:
    from hrsafety.navigation.crowd.world import World

__all__ = ["as_built", "evaluate", "refuse_in_worlds", "simulate"]

_OF_SCENARIOS: dict[str, Any] = {
    "built": None,
    "paths": False,
    "weights": (1 / 3, 1 / 3, 1 / 3),
    "integrator": "semi_implicit_euler",
    "step": 0.01,
    "hold": True,
    "stop_on_contact": False,
    "descent": False,
    "record": None,
    "every": 1,
}
"""Options that worlds do not have, and their defaults."""


def refuse_in_worlds(given: Mapping[str, object]) -> None:
    """Refuse options that worlds do not have.

    Parameters
    ----------
    given : mapping of str to object
        What the caller gave, by name.

    Raises
    ------
    InvalidParameterError
        If one is not the default.
    """
    for name, value in given.items():
        # Arrays have no single truth value.
        plain = isinstance(value, bool | int | float | str | tuple | np.generic)
        if value is not _OF_SCENARIOS[name] and not (plain and value == _OF_SCENARIOS[name]):
            remedy = "worlds have a step of their own, and run to their end"
            raise InvalidParameterError(name, "be left out for worlds", value, remedy)


@telling(of_scenarios)
def simulate(
    scenario: Scenario | World,
    law: AnyLaw | None = None,
    *,
    built: AsBuilt | None = None,
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
    stop_on_contact: bool = False,
    record: Sequence[str] | None = None,
    every: int = 1,
) -> Trajectory:
    """Run one robot from start to goal, or everybody in a world.

    A holonomic robot moves as a point mass; a two-wheel robot follows the point mass that the law drives.

    Parameters
    ----------
    scenario : Scenario or World
        Robot, start, goal, obstacles, measurement; or people that react, robots and walls, which take none of the
        options below.
    law : Law, callable, object or None
        What drives the robot, in a world every robot; see `PythonLaw` for laws of your own. ``None``: every robot
        of a world has its own.
    built : AsBuilt or None
        How the robot is built: wheels with controllers, cameras, the tracking of a two-wheel robot.
        ``None``: ideal wheels and what the scenario measures, as ``AsBuilt()`` says, whose run of a
        holonomic robot is the same bit for bit.
    integrator : {"semi_implicit_euler", "rk4"}
        Velocity first and position with the new velocity, or Runge-Kutta of order 4 with the
        speed limit in every stage.
    step : float
        Motion step in s.
    hold : bool
        Whether the force is computed once a control period and held, as a sampled controller
        does; otherwise at every step (``"rk4"``: at every stage). With ``hold`` the step must
        divide the control period. A measurement needs ``hold``, and so do a two-wheel robot and
        ``built``, which also need ``"semi_implicit_euler"``.
    stop_on_contact : bool
        Whether the run ends at the first contact.
    record : sequence of str or None
        Columns to keep besides time, position, velocity and heading, for long runs: ``"force"``,
        ``"stabilizing"``, ``"lyapunov"``, ``"wheel_current"``, ``"obstacle_position"``, ``"distance"``; all
        when ``None``. The others are ``None`` in the result, which pictures then refuse.
    every : int
        Motion steps from one kept row to the next, up to ten million; the start and the end are kept always.
        Distances, contacts and energy are those of all steps. This and ``record`` are for point masses.

    Returns
    -------
    Trajectory
        The run. Where a state of a world is no longer finite it ends, and ``diverged`` says when, and of which body.

    Raises
    ------
    InvalidParameterError
        If the step is not positive and finite or does not divide the control period, a word is
        unknown, an option does not suit the robot, a law cannot work in a world, or a record would not fit into memory.
    SimulationError
        If the state of a scenario became non-finite.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from hrsafety import navigation as nav, scenarios
    >>> run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
    >>> run.outcome, round(run.arrival_time, 2), round(float(run.min_distance[0]), 3)
    ('arrived', 6.63, 0.536)
    >>> two_wheels = replace(scenarios.configuration("n1"), robot=nav.DifferentialDriveRobot())
    >>> run = nav.simulate(
    ...     two_wheels, nav.VirtualForceField(), built=nav.robots.AsBuilt(wheels=nav.robots.DIFFERENTIAL_WHEELS)
    ... )
    >>> run.outcome, run.wheel_speed.shape[1]
    ('arrived', 2)

    One row a control period, without what can be computed again:

    >>> scene = scenarios.configuration("c1")
    >>> run = nav.simulate(scene, nav.VirtualForceField(), record=["distance"], every=6)
    >>> len(run.time), run.force is None, round(float(run.min_distance[0]), 3)
    (112, True, 0.536)

    A robot and a person who sees it meet head-on:

    >>> person = nav.Person(start=(6, 0.1), route=[(0, 0.1)], desired_speed=1.2)
    >>> robot = nav.Robot(start=(0, 0), goal=(6, 0))
    >>> world = nav.World(people=[person], robots=[robot])
    >>> nav.simulate(world, nav.OptimalReciprocalCollisionAvoidance()).outcome
    'arrived'
    """
    if not isinstance(scenario, Scenario):
        own = {"built": built, "integrator": integrator, "step": step, "hold": hold}
        own = {"built": built, "integrator": integrator, "step": step, "hold": hold}
        refuse_in_worlds(own | {"stop_on_contact": stop_on_contact, "record": record, "every": every})
        return _of_world(scenario, law)
    law = as_law(law)
    names, rows = _kept(record), count("every", every, most=MOST_INTERVAL)
    robot = as_built([scenario], built, integrator, hold=hold)
    if robot is not None:
        if record is not None or rows > 1:
            name, given = ("every", every) if record is None else ("record", record)
            rule = "be None for robots as built" if name == "record" else "be 1 for robots as built"
            raise InvalidParameterError(name, rule, given, "only the loop of point masses leaves out rows and columns")
        columns = _hrsafety.as_built_simulate(
            scenario._native,
            law._native,
            robot._native,
            step=number("step", step),
            stop_on_contact=flag("stop_on_contact", stop_on_contact),
        )
        return Trajectory(scenario=scenario, law=law, built=robot, motion_step=float(step), **columns)
    fields = _hrsafety.simulate(
        scenario._native,
        law._native,
        integrator=integrator,
        step=number("step", step),
        hold=flag("hold", hold),
        stop_on_contact=flag("stop_on_contact", stop_on_contact),
        record=names,
        every=rows,
    )
    return Trajectory(scenario=scenario, law=law, motion_step=float(step), **fields)


def _of_world(scenario: World, law: AnyLaw | None) -> Trajectory:
    """Return the run of a world."""
    # Here: runs of scenarios load nothing of it.
    from hrsafety.navigation.crowd import simulation
    from hrsafety.navigation.crowd.world import World

    instance("scenario", scenario, Scenario, World)
    return simulation.simulated([scenario if law is None else simulation.driven(scenario, as_law(law))], threads=1)[0]


def _kept(record: Sequence[str] | None) -> list[str]:
    """Return the names of the columns to keep of those that may be left out."""
    if record is None:
        return list(OPTIONAL_COLUMNS)
    names = sequence("record", "be a sequence of names of columns", record)
    return [word(f"record[{index}]", name, OPTIONAL_COLUMNS) for index, name in enumerate(names)]


@telling(of_scenarios)
def evaluate(
    scenario: Scenario | World,
    law: AnyLaw | None = None,
    weights: Sequence[float] = (1 / 3, 1 / 3, 1 / 3),
    *,
    built: AsBuilt | None = None,
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
) -> Performance:
    """Run one robot and score it, Zeng (2011), section 5.6.

    ``H = k (w_T T*/T + w_D mean_i min(d_s,i / d_s,i*, 1) + w_E L*/L)`` with k = 0 after a
    contact or without arrival, ``d_s = d - rho_r - rho_obs`` and
    ``d_s* = r_2 - rho_r - rho_obs``. T* and L* come from the same robot and law without
    obstacles and without errors of measurement.

    Parameters
    ----------
    scenario : Scenario or World
        Robot, start, goal, obstacles, measurement; or a world of one robot among people, whose ``d_s*`` is that of
        their active regions at the speeds that they want.
    law : Law, callable, object or None
        What drives the robot; see `PythonLaw` for laws of your own. ``None``: the robot of a world has its own.
    weights : sequence of float
        Weights of time, distance and energy; not negative, sum 1.
    built, integrator, step, hold
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
    if not isinstance(scenario, Scenario):
        refuse_in_worlds({"built": built, "integrator": integrator, "step": step, "hold": hold})
        return _score_of_world(scenario, law, check_weights(weights))
    law = as_law(law)
    robot = as_built([scenario], built, integrator, hold=hold)
    if robot is not None:
        parts, real, ideal = _hrsafety.as_built_evaluate(
            scenario._native, law._native, robot._native, check_weights(weights), step=number("step", step)
        )
        free = replace(without_obstacles(scenario), measurement=None, seed=0)
        return Performance(
            **parts,
            trajectory=Trajectory(scenario=scenario, law=law, built=robot, motion_step=float(step), **real),
            nominal=Trajectory(scenario=free, law=law, built=robot.seeing_all(law), motion_step=float(step), **ideal),
        )
    scores, run, nominal = _hrsafety.evaluate(
        scenario._native, law._native, check_weights(weights), integrator, number("step", step), flag("hold", hold)
    )
    return Performance(
        **scores,
        trajectory=Trajectory(scenario=scenario, law=law, motion_step=float(step), **run),
        nominal=Trajectory(scenario=without_obstacles(scenario), law=law, motion_step=float(step), **nominal),
    )


def _score_of_world(scenario: World, law: AnyLaw | None, weights: tuple[float, float, float]) -> Performance:
    """Return the score of the robot of a world."""
    # Here: runs of scenarios load nothing of it.
    from hrsafety.navigation.crowd.performance import lone, scores
    from hrsafety.navigation.crowd.world import World

    instance("scenario", scenario, Scenario, World)
    if len(scenario.robots) != 1:
        raise InvalidParameterError("scenario.robots", "be one to be scored", Shown(str(len(scenario.robots))))
    run = _of_world(scenario, law)
    alone = lone(scenario, run.robot)
    nominal = simulate(alone.scenario, run.law, built=alone.built, step=alone.step)
    return Performance(**scores(run, nominal, weights), trajectory=run, nominal=nominal)


def as_built(
    scenarios: Sequence[Scenario], built: AsBuilt | None, integrator: Integrator, *, hold: bool
) -> AsBuilt | None:
    """Return how robots are built that are not plain point masses; ``None`` for point masses.

    Parameters
    ----------
    scenarios : sequence of Scenario
        Whose robots.
    built : AsBuilt or None
        What the caller gave.
    integrator, hold
        As for `simulate`; robots as built move by semi-implicit Euler under a held force.

    Returns
    -------
    AsBuilt or None
        ``AsBuilt()`` for two-wheel robots without a description of their own.

    Raises
    ------
    InvalidParameterError
        If ``built`` is of another kind, or the options do not suit such robots.
    """
    kinds = [each.robot for each in scenarios]
    wheels = any(isinstance(robot, DifferentialDriveRobot) for robot in kinds)
    if built is None and not wheels and all(robot.footprint is None for robot in kinds):
        return None
    robot = AsBuilt() if built is None else instance("built", built, AsBuilt)
    whose = "a robot as built"
    if built is None:
        whose = "a DifferentialDriveRobot" if wheels else "a robot with a footprint"
    if flag("hold", hold) is False:
        raise InvalidParameterError("hold", f"be True for {whose}", hold)
    if not isinstance(integrator, str) or integrator != "semi_implicit_euler":
        raise InvalidParameterError("integrator", f'be "semi_implicit_euler" for {whose}', integrator)
    return robot
