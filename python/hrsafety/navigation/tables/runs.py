"""The table of many runs: a row for each, whatever made them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, count
from hrsafety._records import dataclass
from hrsafety._statistics import Share, wilson
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.bands import Band, along_the_way, over_time
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.metrics.declared import METRICS, WORLD_METRICS
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.scenario_arrays import Numbers, Scenarios
from hrsafety.navigation.tables.rows import RunRows
from hrsafety.navigation.warnings import runs as run_warnings
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Column, Columns, each, unit_suffix

__all__ = ["RunTable", "table_of_batch"]

# Columns of one number a run, with their units, in the order of the table.
_UNITS = {
    "outcome": "",
    "end_time": "s",
    "arrival_time": "s",
    "energy": "J",
    "path_length": "m",
    "min_clearance": "m",
    "entered_active": "",
    "contacts_moving": "",
    "contacts_toward": "",
    "contacts_away": "",
    "contacts_standing": "",
    "contacts_at_fault": "",
    "contacts_apart": "",
    "wall_contacts": "",
    "performance_total": "",
    "performance_arrival_time": "",
    "performance_avoidance": "",
    "performance_energy_saving": "",
    "descent_share": "",
    "force_evaluations": "",
}
# Columns of one number for each run and obstacle.
_OF_OBSTACLES = {"min_distance": "m", "contact_time": "s", "contact_speed": "m/s"}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class RunTable(RunRows):
    """Many runs, one a row: n runs, g gains, m obstacles, k instants.

    `simulate_many` orders the rows by law, scenario, seed and gains, the gains fastest;
    `simulate_batch` by gains and scenario, the scenarios fastest. Runs of worlds have a row for each robot, the robots
    fastest, and the social metrics: every one of ``nav.metrics.METRICS`` (of the robot) and of ``WORLD_METRICS`` (of
    its world) is an attribute and a column. What they do not have, such as energy and performance, is ``None``.

    Attributes
    ----------
    law_names, scenario_names : sequence of str
        Names of the laws and of the scenarios.
    laws, scenarios : sequence
        The laws and the scenarios or worlds by these names.
    gain_names : tuple of str
        Names of the gains; of several kinds of laws, those of all of them.
    law_index, scenario_index, gain_index : ndarray of int, shape (n,)
        Which law, which scenario and which gain set.
    robot : ndarray of int, shape (n,), or None
        Which robot of the world.
    seed : ndarray of int, shape (n,)
        Seed of each run.
    gains : ndarray, shape (n, g)
        Gains of each run; NaN where its law has no such gain.
    outcome : ndarray of str, shape (n,)
        ``"arrived"``, ``"collided"``, ``"timed_out"``, ``"stopped"``, and ``"diverged"`` where the state of a world was
        no longer finite before the robot arrived; such a run may have had a contact, too (``touched``). Contacts
        between robots change no outcome; they are counted for the whole world in ``robot_contacts``.
    end_time : ndarray, shape (n,)
        When the run or the world ended, in s.
    arrival_time : ndarray, shape (n,)
        In s; NaN without arrival.
    energy, path_length : ndarray, shape (n,)
        In J and m.
    min_distance : ndarray of shape (n, m), or None
        Least distance to each obstacle in m; infinite if it was never present, NaN beyond the
        obstacles of the row's scenario.
    min_clearance : ndarray, shape (n,)
        Least distance of the surfaces over all obstacles and the maps that law or sensors know, in m; infinite
        without any. In a world from people; from walls in ``wall_clearance``.
    entered_active : ndarray of int, shape (n,)
        Number of obstacles whose active region the robot entered.
    contacts_moving, contacts_standing : ndarray of int, shape (n,)
        Number of obstacles touched while the robot was moving (faster than 0.05 m/s at first
        contact), and while it stood; the maps count as one. In a world people and walls, up to the arrival.
    contacts_toward, contacts_away : ndarray of int, shape (n,)
        How many of those while moving it moved toward at the first touch, V.(o - P) > 0, and how many touched it
        from behind or from the side; their sum is ``contacts_moving``. See ``contact_toward`` of a `Trajectory`.
    contacts_at_fault : ndarray of int, shape (n,)
        Number of obstacles toward which the robot moved, faster than 0.05 m/s, at an instant of a contact from the
        first touch until the bodies first overlapped by 0.1 m; every contact with a map counts.
    contacts_apart : ndarray of int, shape (n,)
        Number of obstacles that appeared in the scene where the robot was, in none of the other numbers.
    wall_contacts : ndarray of int, shape (n,)
        Number of contacts with the maps, 1 or 0, or with the walls of a world, which the others but
        ``contacts_apart`` hold, too.
    performance_total : ndarray, shape (n,)
        H; 0 after a contact or without arrival.
    performance_arrival_time, performance_avoidance, performance_energy_saving : ndarray, shape (n,)
        H_T, H_D, H_E.
    descent_share : ndarray, shape (n,)
        Share of the control periods, begun and ended outside every critical region, over
        which the Lyapunov function did not grow; NaN unless asked for.
    force_evaluations : ndarray of int, shape (n,)
        Number of control periods.
    contact_time, contact_speed : ndarray of shape (n, m), or None
        First contact with each obstacle in s and the robot's speed then in m/s, NaN without; known of
        robots as built and of runs with paths.
    time : ndarray of shape (n, k), or None
        Instants in s: every control period and the end of the run, NaN after it; with paths only.
    position : ndarray of shape (n, k, 2), or None
        True positions of the robot at these instants, in m.
    distance : ndarray of shape (n, k, m), or None
        Distances to the obstacles at these instants, in m.
    built : AsBuilt or None
        How the robots are built.
    motion_step : float
        Motion step of the runs in s.
    values : mapping of str to ndarray, shape (n,)
        The social metrics by name; empty for scenarios.
    doubts : tuple of ResultWarning or None
        Warnings that were found when the runs of worlds ended.

    See Also
    --------
    Comparison : laws in the same episodes.
    hrsafety.plotting.repeated_paths : draws the paths of one law in one scenario.
    hrsafety.plotting.clearances : draws the distribution of the clearances.
    """

    law_names: tuple[str, ...]
    scenario_names: Sequence[str]
    laws: tuple[Law, ...]
    scenarios: Sequence[Any]
    gain_names: tuple[str, ...]
    law_index: npt.NDArray[np.int64]
    scenario_index: npt.NDArray[np.int64]
    gain_index: npt.NDArray[np.int64]
    seed: npt.NDArray[np.uint64]
    gains: Array
    outcome: npt.NDArray[np.str_]
    end_time: Annotated[Array, "s"]
    arrival_time: Annotated[Array, "s"]
    path_length: Annotated[Array, "m"]
    min_clearance: Annotated[Array, "m"]
    contacts_moving: npt.NDArray[np.int64]
    contacts_toward: npt.NDArray[np.int64]
    contacts_away: npt.NDArray[np.int64]
    contacts_standing: npt.NDArray[np.int64]
    contacts_at_fault: npt.NDArray[np.int64]
    contacts_apart: npt.NDArray[np.int64]
    wall_contacts: npt.NDArray[np.int64]
    # `X | Any`: None for worlds only.
    energy: Annotated[Array | Any, "J"] = None
    min_distance: Annotated[Array | Any, "m"] = None
    entered_active: npt.NDArray[np.int64] | Any = None
    performance_total: Array | Any = None
    performance_arrival_time: Array | Any = None
    performance_avoidance: Array | Any = None
    performance_energy_saving: Array | Any = None
    descent_share: Array | Any = None
    force_evaluations: npt.NDArray[np.int64] | Any = None
    contact_time: Annotated[Array | None, "s"] = None
    contact_speed: Array | None = None
    time: Annotated[Array | None, "s"] = None
    position: Annotated[Array | None, "m"] = None
    distance: Annotated[Array | None, "m"] = None
    motion_step: Annotated[float, "s"] = 0.01
    built: AsBuilt | None = None
    robot: npt.NDArray[np.int64] | Any = None
    values: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)
    doubts: tuple[ResultWarning, ...] | None = None

    def __getattr__(self, name: str) -> Any:
        """Return the column of a social metric."""
        # Pickling asks before there are values.
        if name in METRICS or name in WORLD_METRICS:
            found = object.__getattribute__(self, "values")
            if name in found:
                return found[name]
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why rows may not mean what they seem to: the first warning of each kind, and how many follow."""
        about = self._of_scenes() if self.doubts is None else self.doubts
        return (*about, *run_warnings.of_repeats(self))

    def _of_scenes(self) -> tuple[ResultWarning, ...]:
        if isinstance(self.scenarios, Scenarios):
            # What a sensor or a map leaves out is the same in all of them.
            rows = sorted({0, *self.scenarios.doubtful()})
            names = [f"scenarios[{self.scenario_names[row]}]" for row in rows]
            return run_warnings.of_runs(
                [self.scenarios[row] for row in rows], names, self.laws, self.built, self.motion_step
            )
        numbered = tuple(self.scenario_names) == tuple(map(str, range(len(self.scenarios))))
        names = [f"scenarios[{name if numbered else repr(name)}]" for name in self.scenario_names]
        return run_warnings.of_runs(self.scenarios, names, self.laws, self.built, self.motion_step)

    @property
    def success(self) -> Share:
        """Share of the runs that arrived without a contact, with its 95 % Wilson interval."""
        return wilson(int((self.outcome == "arrived").sum()), len(self))

    @property
    def contact(self) -> Share:
        """Share of the runs with a contact, those that diverged later included, with its 95 % Wilson interval."""
        return wilson(int(self.touched.sum()), len(self))

    @property
    def touched(self) -> npt.NDArray[np.bool_]:
        """Whether each run had a contact with an obstacle, a person or a wall, however it ended."""
        found: npt.NDArray[np.bool_] = (self.outcome == "collided") | (
            self.contacts_moving + self.contacts_standing > 0
        )
        return found

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, ready for a data frame.

        Returns
        -------
        dict of str to ndarray
            Law, scenario, seed, gains, outcome and the numbers of each run with their units;
            obstacles are numbered. The paths are not in it.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> table = nav.simulate_many(scenarios.configuration("c1"), nav.VirtualForceField()).columns()
        >>> list(table)[:4], round(float(table["min_distance_0_m"][0]), 3)
        (['law', 'scenario', 'seed', 'attractive_gain_N_per_m'], 0.536)
        """
        return self._columns(slice(None))

    def _telling(self) -> tuple[str, ...]:
        varied = () if self.gain_index.max(initial=0) == 0 else tuple(self._of_gains(slice(0)))
        found = ("outcome", "arrival_time_s", "min_clearance_m", "contacts_toward", "contacts_away")
        return ("law", "scenario", "seed", *varied, *found)

    def _columns(self, rows: slice) -> Columns:
        found = self._of_law(rows) | ({} if self.robot is None else {"robot": self.robot[rows]}) | self._of_gains(rows)
        for name, unit in _UNITS.items():
            if getattr(self, name) is not None:
                found[name + unit_suffix(unit)] = getattr(self, name)[rows]
        for metric in (*METRICS.values(), *WORLD_METRICS.values()) if self.values else ():
            found.setdefault(metric.name + unit_suffix(metric.unit), self.values[metric.name][rows])
        for name, unit in _OF_OBSTACLES.items():
            values = getattr(self, name)
            found |= {} if values is None else each(f"{name}_{{}}", values[rows], unit)
        return found

    # ---- bands ------------------------------------------------------------------------------

    @property
    def goal_distance(self) -> Array:
        """Distance e to the goal in m, shape (n, k), of the runs of one scenario with paths."""
        scenario, _, position, _ = self._paths()
        away: Array = np.hypot(*np.moveaxis(position - np.asarray(scenario.goal), -1, 0))
        return away

    def goal_band(self, share: float = 0.9) -> Band:
        """Return where a share of the runs lies: distance e to the goal over time.

        Parameters
        ----------
        share : float
            Share between the bounds, above 0 and at most 1; 1 for the extremes.

        Returns
        -------
        Band
            e in m over time in s.

        Raises
        ------
        InvalidParameterError
            If the share is not above 0 and at most 1, the runs are of several scenarios, or their
            paths were not kept.
        """
        scenario, time, _, _ = self._paths()
        return over_time(scenario, time, self.goal_distance, share)

    def distance_band(self, obstacle: int, share: float = 0.9) -> Band:
        """Return where a share of the runs lies: distance d to an obstacle over time.

        Parameters
        ----------
        obstacle : int
            Index of the obstacle.
        share : float
            As for `goal_band`.

        Returns
        -------
        Band
            d in m over time in s.

        Raises
        ------
        InvalidParameterError
            As `goal_band`, or if there is no such obstacle.
        """
        scenario, time, _, distance = self._paths()
        if count("obstacle", obstacle, least=0) >= distance.shape[2]:
            raise InvalidParameterError("obstacle", f"be an integer below {distance.shape[2]}", obstacle)
        return over_time(scenario, time, distance[:, :, obstacle], share)

    def path_band(self, share: float = 0.9) -> Band:
        """Return where a share of the paths lies beside the straight way.

        The offset of a path, positive to the left, is taken where the robot passes a station
        for the first time.

        Parameters
        ----------
        share : float
            As for `goal_band`.

        Returns
        -------
        Band
            Offset in m over the progress along the straight way in m.

        Raises
        ------
        InvalidParameterError
            As `goal_band`.
        """
        scenario, _, position, _ = self._paths()
        return along_the_way(scenario, position, share)

    def _paths(self) -> tuple[Scenario, Array, Array, Array]:
        """Return the one scenario with instants, positions and distances of its runs."""
        if self.time is None or self.position is None or self.distance is None:
            raise InvalidParameterError(
                "paths", "be kept for bands", Shown("a table without"), "simulate with paths=True"
            )
        if len(self.scenarios) != 1:
            remedy = f'select(scenario="{self.scenario_names[0]}") has the runs of one'
            raise InvalidParameterError("scenarios", "be one for bands", Shown(str(len(self.scenarios))), remedy)
        return self.scenarios[0], self.time, self.position, self.distance


def table_of_batch(
    scenarios: Sequence[Scenario],
    law: Law,
    columns: Mapping[str, Column],
    *,
    motion_step: float,
    seed: int | None = None,
) -> RunTable:
    """Return the native columns of a batch of one law as a table.

    Parameters
    ----------
    scenarios : sequence of Scenario
        Where, in the order of the batch.
    law : Law
        The law.
    columns : mapping of str to ndarray
        What the core returned, the scenarios fastest.
    motion_step : float
        Motion step of the runs in s.
    seed : int or None
        Seed of all runs; those of the scenarios when ``None``.

    Returns
    -------
    RunTable
        The runs; scenarios are named by their numbers.
    """
    rows = len(columns["outcome"])
    columns = {**columns, "gains": columns["gains"][:, : len(law.GAIN_NAMES)]}
    if seed is None and isinstance(scenarios, Scenarios):
        own = scenarios.seeds
    else:
        own = np.array([scene.seed if seed is None else seed for scene in scenarios], dtype=np.uint64)
    return RunTable(
        law_names=(type(law).__name__,),
        scenario_names=Numbers(len(scenarios))
        if isinstance(scenarios, Scenarios)
        else tuple(map(str, range(len(scenarios)))),
        laws=(law,),
        scenarios=scenarios if isinstance(scenarios, Scenarios) else tuple(scenarios),
        gain_names=law.GAIN_NAMES,
        law_index=np.zeros(rows, dtype=np.int64),
        seed=np.tile(own, rows // len(own)),
        motion_step=motion_step,
        **columns,  # type: ignore[arg-type]  # each under its own name
    )
