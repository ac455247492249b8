"""Many runs in one call, over all cores and vector lanes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, callback, count, flag, instance, number, numbers, sequence, thread_count
from hrsafety._bounds import MOST_LANES
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.navigation import run_warnings
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.laws.python_law import AnyLaw, as_law
from hrsafety.navigation.performance import check_weights
from hrsafety.navigation.robots.bodies import HolonomicRobot
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import Integrator
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Columns, Table

__all__ = ["BatchSummary", "simulate_batch"]

# More would only exhaust the system before it says no.


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BatchSummary(Table):
    """Summary columns of a batch, one row for each (gains, scenario).

    Rows run over the scenarios fastest: row = gain_index * number of scenarios +
    scenario_index.

    Attributes
    ----------
    gain_index, scenario_index : ndarray of int, shape (rows,)
        Which gain set and which scenario.
    gain_names : tuple of str
        Names of the gains of the law, in their order.
    gains : ndarray, shape (rows, g)
        K_1, K_3, K_5, b of the row.
    outcome : ndarray of str, shape (rows,)
        ``"arrived"``, ``"collided"``, ``"timed_out"``, ``"stopped"``.
    end_time : ndarray, shape (rows,)
        When the run ended, in s.
    arrival_time : ndarray, shape (rows,)
        In s; NaN without arrival.
    energy, path_length : ndarray, shape (rows,)
        In J and m.
    min_distance : ndarray, shape (rows, obstacles)
        Least distance to each obstacle in m; infinite if it was never present, NaN beyond the
        obstacles of the row's scenario.
    min_clearance : ndarray, shape (rows,)
        Least distance of the surfaces over all obstacles, in m; infinite without any.
    entered_active : ndarray of int, shape (rows,)
        Number of obstacles whose active region the robot entered.
    contacts_moving, contacts_standing : ndarray of int, shape (rows,)
        Number of obstacles touched while the robot was moving (faster than 0.05 m/s at first
        contact), and while it stood.
    performance_total : ndarray, shape (rows,)
        H; 0 after a contact or without arrival.
    performance_arrival_time, performance_avoidance, performance_energy_saving : ndarray, shape (rows,)
        H_T, H_D, H_E.
    descent_share : ndarray, shape (rows,)
        Share of the control periods, begun and ended outside every critical region, over
        which the Lyapunov function did not grow; NaN unless asked for.
    force_evaluations : ndarray of int, shape (rows,)
        Number of control periods.
    """

    gain_names: tuple[str, ...]
    gain_index: npt.NDArray[np.int64]
    scenario_index: npt.NDArray[np.int64]
    gains: Array
    outcome: npt.NDArray[np.str_]
    end_time: Array
    arrival_time: Array
    energy: Array
    path_length: Array
    min_distance: Array
    min_clearance: Array
    entered_active: npt.NDArray[np.int64]
    contacts_moving: npt.NDArray[np.int64]
    contacts_standing: npt.NDArray[np.int64]
    performance_total: Array
    performance_arrival_time: Array
    performance_avoidance: Array
    performance_energy_saving: Array
    descent_share: Array
    force_evaluations: npt.NDArray[np.int64]
    _ran: tuple[tuple[Scenario, ...], Law] | None = field(default=None, repr=False)

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why rows may not mean what they seem to: the first warning of each kind, and how many follow."""
        if self._ran is None:
            return ()
        scenes, law = self._ran
        return run_warnings.of_runs(scenes, [f"scenarios[{k}]" for k in range(len(scenes))], [law])

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.outcome)

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, ready for a data frame.

        Returns
        -------
        dict of str to ndarray
            Gains and distances are split into one column each.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> table = nav.simulate_batch([scenarios.configuration("c1")], nav.VirtualForceField()).columns()
        >>> round(float(table["min_distance_0"][0]), 3)
        0.536
        """
        table: Columns = {}
        for entry in fields(self):
            values = getattr(self, entry.name)
            if entry.name in ("gain_names", "_ran"):
                continue
            if entry.name == "gains":
                table |= {name: values[:, i] for i, name in enumerate(self.gain_names)}
            elif values.ndim == 2:
                table |= {f"{entry.name}_{i}": values[:, i] for i in range(values.shape[1])}
            else:
                table[entry.name] = values
        return table


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
) -> BatchSummary:
    """Run every gain set in every scenario: one call, all cores, same bits on any machine.

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
        Gain sets that are stepped side by side: 1, 4, 8 or 16; chosen when ``None``. Never
        changes a bit of the result.
    progress : callable or None
        Called with (runs done, runs in all) about ten times a second.

    Returns
    -------
    BatchSummary
        One row for each (gains, scenario).

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
        [scenario._native for scenario in scenes],
        law._native,
        _gain_sets(law, gains),
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
    if not law.GAIN_NAMES:
        columns["gains"] = columns["gains"][:, :0]
    return BatchSummary(gain_names=law.GAIN_NAMES, _ran=(tuple(scenes), law), **columns)


def check_scenarios(scenarios: Sequence[Scenario]) -> list[Scenario]:
    """Return the scenarios if there is at least one and nothing else among them."""
    scenes = sequence("scenarios", "be a sequence of Scenario", scenarios)
    for index, scenario in enumerate(scenes):
        instance(f"scenarios[{index}]", scenario, Scenario)
        if not isinstance(scenario.robot, HolonomicRobot):
            rule = "be a HolonomicRobot, since batches move point masses; `simulate` and `repeat` run the other kind"
            raise InvalidParameterError(f"scenarios[{index}].robot", rule, scenario.robot)
    if not scenes:
        raise InvalidParameterError("scenarios", "hold at least one scenario", Shown("an empty list"))
    return scenes


def check_threads(threads: int | None) -> None:
    """Refuse a number of threads that is not a positive integer or exhausts the system."""
    thread_count(threads)


def _gain_sets(law: Law, gains: npt.ArrayLike | Mapping[str, npt.ArrayLike] | None) -> Array:
    """Return the gain sets as a contiguous array, one a row."""
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
