"""Gain sets of one law in many scenarios, over all cores and vector lanes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, callback, count, flag, instance, number, numbers, sequence, thread_count
from hrsafety._bounds import MOST_LANES
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.laws.python_law import AnyLaw, as_law
from hrsafety.navigation.performance import check_weights
from hrsafety.navigation.robots.bodies import HolonomicRobot
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.scenario_arrays import Scenarios
from hrsafety.navigation.tables.runs import RunTable, table_of_batch
from hrsafety.navigation.trajectory import Integrator
from hrsafety.navigation.warnings.units import of_scenarios
from hrsafety.plausibility import telling

__all__ = ["check_scenarios", "check_threads", "gain_sets", "natives_of", "simulate_batch"]


@telling(of_scenarios)
def simulate_batch(
    scenarios: Sequence[Scenario],
    law: AnyLaw,
    gains: npt.ArrayLike | Mapping[str, npt.ArrayLike] | None = None,
    *,
    weights: Sequence[float] = (1 / 3, 1 / 3, 1 / 3),
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
    stop_on_contact: bool = False,
    descent: bool = False,
    threads: int | None = None,
    lanes: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> RunTable:
    """Run every gain set in every scenario: one call, all cores, same bits on any machine.

    `simulate_many` without its names and seeds, for one law and point masses, in the order in which
    searches score gain sets: the scenarios fastest.

    Parameters
    ----------
    scenarios : sequence of Scenario
        Where.
    law : Law, callable or object
        The law; its own gains are used when ``gains`` is ``None``. A law of your own has none, and runs
        on one thread; see `PythonLaw`.
    gains : array_like of shape (n, g), mapping, or None
        Gain sets in the order of ``GAIN_NAMES`` of the law, or arrays by these names
        that broadcast, the missing ones taken from the law.
    weights : sequence of float
        Weights of time, distance and energy in H.
    integrator, step, hold, stop_on_contact
        As for `simulate`.
    descent : bool
        Whether ``descent_share`` is computed; costs time.
    threads : int or None
        Number of threads, up to 1024; all cores when ``None``.
    lanes : int or None
        1 for runs one after the other; 4, 8 or 16 for runs side by side, in lanes of eight; chosen
        when ``None``. Never changes a bit of the result.
    progress : callable or None
        Called with (runs done, runs in all) about ten times a second.

    Returns
    -------
    RunTable
        One row for each (gains, scenario): row = gain_index * number of scenarios + scenario_index.

    Raises
    ------
    InvalidParameterError
        If there is no scenario or no gain set, a gain is negative or not finite, or an option
        is out of range.
    ShapeError
        If gains does not have a column for each gain of the law.
    SimulationError
        If the state of a run became non-finite.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> table = nav.simulate_batch(
    ...     [scenarios.configuration(name) for name in ("c1", "c2", "c3")],
    ...     nav.VirtualForceField(), {"attractive_gain": [2.0, 3.0, 4.0]},
    ... )
    >>> len(table), set(table.outcome.tolist())
    (9, {'arrived'})
    """
    scenes = check_scenarios(scenarios)
    law = as_law(law)
    check_threads(threads)
    if lanes is not None:
        count("lanes", lanes, most=MOST_LANES)
    columns = _hrsafety.simulate_batch(
        natives_of(scenes),
        law._native,
        gain_sets(law, gains),
        check_weights(weights),
        integrator=integrator,
        step=number("step", step),
        hold=flag("hold", hold),
        stop_on_contact=flag("stop_on_contact", stop_on_contact),
        descent=flag("descent", descent),
        threads=threads,
        lanes=lanes,
        progress=callback("progress", progress),
    )
    return table_of_batch(scenes, law, columns, motion_step=number("step", step))


def natives_of(scenes: Sequence[Scenario]) -> list[_hrsafety.Scenario] | _hrsafety.Scenarios:
    """Return what the core takes for scenarios: those of arrays in one piece."""
    return scenes._native if isinstance(scenes, Scenarios) else [scene._native for scene in scenes]


def check_scenarios(scenarios: Sequence[Scenario]) -> Sequence[Scenario]:
    """Return the scenarios if there is at least one and nothing else among them."""
    if isinstance(scenarios, Scenarios):
        scenes: Sequence[Scenario] = scenarios
        looked_at = list(scenarios[:1])  # all have the same robot
    else:
        scenes = looked_at = sequence("scenarios", "be a sequence of Scenario", scenarios)
    for index, scenario in enumerate(looked_at):
        if not isinstance(scenario, Scenario):
            instance(f"scenarios[{index}]", scenario, Scenario)
        if not isinstance(scenario.robot, HolonomicRobot):
            rule = "be a HolonomicRobot, since batches move point masses; `simulate_many` and worlds take two wheels"
            raise InvalidParameterError(f"scenarios[{index}].robot", rule, scenario.robot)
    if len(scenes) == 0:
        raise InvalidParameterError("scenarios", "hold at least one scenario", Shown("an empty list"))
    return scenes


def check_threads(threads: int | None) -> None:
    """Refuse a number of threads that is not a positive integer or exhausts the system."""
    thread_count(threads)


def gain_sets(law: Law, gains: npt.ArrayLike | Mapping[str, npt.ArrayLike] | None) -> Array:
    """Return the gain sets as a contiguous array, one a row.

    Parameters
    ----------
    law : Law
        Whose gains.
    gains : array_like, mapping or None
        As for `simulate_batch`.

    Returns
    -------
    ndarray, shape (n, g)
        Gains in the order of ``GAIN_NAMES``.

    Raises
    ------
    InvalidParameterError
        If a name is unknown or a value is no number.
    ShapeError
        If there is not a column for each gain.
    """
    if not law.GAIN_NAMES:
        if gains is not None:
            raise InvalidParameterError("gains", "be None for a law without gains", gains)
        return np.zeros((1, 1))  # the kernels take a gain set for every run
    if gains is None:
        return np.array([law.gains])
    if isinstance(gains, Mapping):
        unknown = sorted(set(gains) - set(law.GAIN_NAMES))
        if unknown:
            raise InvalidParameterError("gains", f"have keys among {', '.join(law.GAIN_NAMES)}", unknown[0])
        given = {**dict(zip(law.GAIN_NAMES, law.gains, strict=True)), **gains}
        columns = [numbers(f"gains[{name!r}]", given[name], "hold numbers") for name in law.GAIN_NAMES]
        try:
            columns = list(np.broadcast_arrays(*columns))
        except ValueError:
            shapes = tuple(len(column) if column.ndim else 1 for column in columns)
            raise ShapeError("gains", "arrays that broadcast", shapes) from None
        return np.ascontiguousarray(np.stack([column.ravel() for column in columns], axis=1))
    array = numbers("gains", gains, "be an array of numbers, a mapping or None")
    if array.ndim != 2 or array.shape[1] != len(law.GAIN_NAMES):
        raise ShapeError("gains", f"(n, {len(law.GAIN_NAMES)})", array.shape)
    return array
