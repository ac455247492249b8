"""Many runs in one call: laws in scenarios with seeds and gains."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import cast

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, callback, flag, number, thread_count
from hrsafety._bounds import MOST_PATH_NUMBERS, MOST_TABLE_ROWS
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, Shown, SimulationError
from hrsafety.navigation.crowd.simulation import OWN_LAWS
from hrsafety.navigation.crowd.study import WorldStudy
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.laws.python_law import AnyLaw
from hrsafety.navigation.performance import check_weights
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.run_arguments import (
    Numbered,
    Progress,
    Seeds,
    checked_seeds,
    named_laws,
    named_scenarios,
    sets_of,
)
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.simulation import as_built, refuse_in_worlds
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.navigation.trajectory import Integrator
from hrsafety.navigation.warnings.units import of_scenarios
from hrsafety.plausibility import telling
from hrsafety.tables import Columns

__all__ = ["simulate_many"]


@telling(of_scenarios)
def simulate_many(
    scenarios: Scenario | World | Sequence[Scenario | World] | Mapping[str, Scenario | World],
    laws: AnyLaw | Sequence[AnyLaw] | Mapping[str, AnyLaw] | None = None,
    *,
    gains: npt.ArrayLike | Mapping[str, npt.ArrayLike] | None = None,
    seeds: Seeds | None = None,
    built: AsBuilt | None = None,
    paths: bool = False,
    weights: Sequence[float] = (1 / 3, 1 / 3, 1 / 3),
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
    stop_on_contact: bool = False,
    descent: bool = False,
    people_alone: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
) -> RunTable:
    """Run every law in every scenario with every seed and every gain set, on all cores.

    Each run has the bits of `simulate` and `evaluate`, on any number of threads. Point masses run side
    by side in vector lanes; two-wheel robots, robots as built and runs whose paths are kept run one by
    one on each core.

    Parameters
    ----------
    scenarios : Scenario or World, sequence of them, or mapping of str to them
        Where, scenarios or worlds of people that react; without names they are numbered.
    laws : law, sequence of laws, or mapping of str to law
        What drives the robot, in a world every robot: laws of the package and laws of your own
        (`PythonLaw`), which run on one thread; without names they are called by their class, those of
        one class numbered. ``None``: every robot of a world has its own, called ``"own"``.
    gains : array_like of shape (n, g), mapping, or None
        Gain sets in the order of ``GAIN_NAMES`` of the laws, or arrays by these names that broadcast,
        the missing ones taken from each law. ``None``: the gains of each law.
    seeds : int, iterable of int, or None
        Seeds of the measurement and of planners that draw, or their number: then 0, 1, 2 and so on.
        Each scenario is run with each of them; with its own when ``None``.
    built : AsBuilt or None
        How the robots are built, as for `simulate`.
    paths : bool
        Whether the path of every run is kept, once a control period: ``time``, ``position``,
        ``distance`` and first contacts, from which bands are made. At most 2e8 numbers (1.6 GB) if
        every run lasts until the time limit of its scenario.
    weights : sequence of float
        Weights of time, distance and energy in H.
    integrator, step, hold, stop_on_contact
        As for `simulate`.
    descent : bool
        Whether ``descent_share`` is computed; costs time. For point masses only.
    people_alone : bool
        Of worlds: whether their people are simulated without the robots, too; delays and detours of people
        need it.
    threads : int or None
        Number of threads, up to 1024; all cores when ``None``.
    progress : callable or None
        Called with (runs done, runs in all) about ten times a second.

    Returns
    -------
    RunTable
        One row for each (law, scenario, seed, gains) in this order, the gains fastest; of worlds with the social
        metrics, and a row for each robot.

    Raises
    ------
    InvalidParameterError
        If there is no scenario, law, seed or gain set, one is not valid, the laws differ in the names
        of the gains that are given, there would be more than ten million rows or paths beyond memory,
        or an option is out of range.
    ShapeError
        If gains does not have a column for each gain.
    SimulationError
        If the state of a run became non-finite; the message names law, scenario, seed and row.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from hrsafety import navigation as nav, scenarios
    >>> noisy = replace(scenarios.configuration("c1"), measurement=nav.Measurement(of="robot"))
    >>> laws = {"field": nav.VirtualForceField(), "Masoud": nav.Masoud()}
    >>> runs = nav.simulate_many({"c1": noisy}, laws, seeds=20)
    >>> len(runs), runs.select(law="field").success.runs
    (40, 20)

    Among people that react:

    >>> worlds = [scenarios.circle_crossing(case) for case in range(3)]
    >>> crowds = nav.simulate_many(worlds, nav.OptimalReciprocalCollisionAvoidance(), people_alone=True)
    >>> crowds.outcome.tolist(), bool((crowds.person_delay < 1.0).all())
    (['arrived', 'arrived', 'arrived'], True)
    """
    named = named_scenarios(scenarios)
    among_people = not isinstance(named, Numbered) and isinstance(next(iter(named.values())), World)
    drivers: dict[str, Law] = {"own": OWN_LAWS} if laws is None and among_people else named_laws(laws)
    sets = sets_of(drivers, gains)
    drawn = None if seeds is None else checked_seeds(seeds)
    if among_people:
        own = {
            "built": built,
            "paths": paths,
            "weights": check_weights(weights),
            "integrator": integrator,
            "step": step,
        }
        refuse_in_worlds(own | {"hold": hold, "stop_on_contact": stop_on_contact, "descent": descent})
        worlds = cast("Mapping[str, World]", named)
        crowds = WorldStudy(worlds, drivers, sets, drawn, flag("people_alone", people_alone))
        return crowds.run(thread_count(threads), callback("progress", progress))
    if flag("people_alone", people_alone):
        raise InvalidParameterError("people_alone", "be False for scenarios, whose people do not react", people_alone)
    places = cast("Mapping[str, Scenario]", named)
    robots = list(places.rows[:1] if isinstance(places, Numbered) else places.values())
    robot = as_built(robots, built, integrator, hold=hold)
    study = _Study(places, drivers, sets, drawn, robot, number("step", step))
    if flag("paths", paths):
        study.check_paths()
    # Only the loop of single runs keeps paths; a point mass has the same bits there.
    if paths and robot is None:
        robot = as_built(robots, AsBuilt(), integrator, hold=hold)
    if flag("descent", descent) and robot is not None:
        raise InvalidParameterError("descent", "be False for robots as built and runs with paths", descent)
    options: dict[str, object] = {"step": study.motion_step, "threads": thread_count(threads)}
    options |= {"stop_on_contact": flag("stop_on_contact", stop_on_contact)}
    if robot is None:
        options |= {"integrator": integrator, "hold": flag("hold", hold), "descent": descent, "lanes": None}
    else:
        options |= {"built": robot._native, "histories": paths}
    return study.run(check_weights(weights), options, callback("progress", progress))


@dataclass(frozen=True, slots=True)
class _Study:
    """Runs of a study: laws, scenarios and seeds."""

    scenarios: Mapping[str, Scenario]
    laws: Mapping[str, Law]
    sets: Sequence[Array]
    seeds: list[int] | None
    built: AsBuilt | None
    motion_step: float

    def __post_init__(self) -> None:
        """Refuse a table that would not fit into memory."""
        if self.rows > MOST_TABLE_ROWS:
            rule = f"hold at most {MOST_TABLE_ROWS} runs with their scenarios, seeds and gain sets"
            remedy = "split the call, or run a sweep, which writes to files"
            raise InvalidParameterError("laws", rule, Shown(f"{self.rows} runs"), remedy)

    @property
    def rows(self) -> int:
        """Number of runs."""
        return len(self.scenarios) * len(self.seeds or [0]) * sum(map(len, self.sets))

    def check_paths(self) -> None:
        """Refuse paths that would not fit into memory if a run lasted until its time limit."""
        places = self.scenarios.values()
        # The table has one length for all: the instants of the longest run, and the end.
        instants = max(each.time_limit / each.control_period for each in places) + 2.0
        numbers = self.rows * instants * (3 + max(len(each.obstacles) for each in places))
        if numbers > MOST_PATH_NUMBERS:
            rule = f"hold at most {MOST_PATH_NUMBERS:.3g} numbers if every run lasts until its time limit"
            remedy = "lower time_limit of the scenarios, keep the paths of fewer runs, or leave them out"
            found = f"{self.rows} runs of up to {instants:.4g} instants, {numbers:.3g} numbers"
            raise InvalidParameterError("paths", rule, Shown(found), remedy)

    def run(
        self, weights: tuple[float, float, float], options: dict[str, object], progress: Progress | None
    ) -> RunTable:
        natives, drawn = self._episodes()
        total, done, parts = len(natives) * sum(map(len, self.sets)), 0, []
        for (name, law), sets in zip(self.laws.items(), self.sets, strict=True):
            heard = None if progress is None else _shifted(progress, done, total)
            try:
                columns = _columns(natives, law, sets, weights, {**options, "progress": heard})
            except InvalidParameterError as error:
                raise self._naming_scenarios(error) from None
            except SimulationError as error:
                raise self._naming_run(error, name, sets, done) from None
            parts.append(_gains_fastest(columns))
            done += len(natives) * len(sets)
        return self._table(parts, drawn)

    def _episodes(self) -> tuple[Sequence[_hrsafety.Scenario] | _hrsafety.Scenarios, npt.NDArray[np.uint64]]:
        """Return every scenario with each of its seeds, and the seeds."""
        if isinstance(self.scenarios, Numbered):
            rows = self.scenarios.rows
            if self.seeds is None:
                return rows._native, rows.seeds
            return rows._native.reseeded(self.seeds), np.tile(np.array(self.seeds, dtype=np.uint64), len(rows))
        places = self.scenarios.values()
        if self.seeds is None:
            return [place._native for place in places], np.array([place.seed for place in places], dtype=np.uint64)
        natives = [place._native.reseeded(seed) for place in places for seed in self.seeds]
        return natives, np.tile(np.array(self.seeds, dtype=np.uint64), len(natives) // len(self.seeds))

    def _naming_scenarios(self, error: InvalidParameterError) -> InvalidParameterError:
        """Return an error that names the scenario instead of the episode, which is a scenario with a seed."""
        found = re.match(r"scenarios\[(\d+)\]", error.argument)
        if found is None or self.seeds is None:
            return error
        name = f"scenarios[{int(found[1]) // len(self.seeds)}]{error.argument[found.end() :]}"
        return InvalidParameterError(name, error.requirement, error.value, error.remedy)

    def _naming_run(self, error: SimulationError, law: str, sets: Array, before: int) -> SimulationError:
        """Return an error that names law, scenario, seed and row of the table, given the number of rows before the law.

        The core counts the runs of one law, episodes fastest.
        """
        if error.run is None:
            return error
        repeats = len(self.seeds or [0])
        gains, episode = divmod(error.run, len(self.scenarios) * repeats)
        name, scenario = list(self.scenarios.items())[episode // repeats]
        seed = scenario.seed if self.seeds is None else self.seeds[episode % repeats]
        row = before + episode * len(sets) + gains
        what = str(error).removesuffix(f" (run {error.run})")
        where = f"law {law!r}, scenario {name!r}, seed {seed}, row {row} of the table"
        return SimulationError(f"{what} ({where})", row)

    def _table(self, parts: list[Columns], seeds: npt.NDArray[np.uint64]) -> RunTable:
        """Return the columns of all laws, one below the other, with what each row is."""
        names = list(dict.fromkeys(name for law in self.laws.values() for name in law.GAIN_NAMES))
        for law, part in zip(self.laws.values(), parts, strict=True):
            wide = np.full((len(part["outcome"]), len(names)), np.nan)
            wide[:, [names.index(name) for name in law.GAIN_NAMES]] = part["gains"][:, : len(law.GAIN_NAMES)]
            part["gains"] = wide
        # Runs of one law may last longer than those of another: their histories are padded.
        for name in {"time", "position", "distance"} & set(parts[0]):
            longest = max(part[name].shape[1] for part in parts)
            for part in parts:
                part[name] = _padded(part[name], longest)
        rows = [len(part["outcome"]) for part in parts]
        episode = np.concatenate([part.pop("scenario_index") for part in parts])
        columns = {
            name: parts[0][name] if len(parts) == 1 else np.concatenate([part[name] for part in parts])
            for name in parts[0]
        }
        return RunTable(
            law_names=tuple(self.laws),
            scenario_names=self.scenarios.names if isinstance(self.scenarios, Numbered) else tuple(self.scenarios),
            laws=tuple(self.laws.values()),
            scenarios=self.scenarios.rows if isinstance(self.scenarios, Numbered) else tuple(self.scenarios.values()),
            gain_names=tuple(names),
            law_index=np.repeat(np.arange(len(rows)), rows),
            scenario_index=episode // (len(seeds) // len(self.scenarios)),
            seed=seeds[episode],
            built=self.built,
            motion_step=self.motion_step,
            **columns,  # type: ignore[arg-type]  # each under its own name
        )


def _columns(
    natives: Sequence[_hrsafety.Scenario] | _hrsafety.Scenarios,
    law: Law,
    sets: Array,
    weights: tuple[float, float, float],
    options: dict[str, object],
) -> Columns:
    """Return the columns of one law, the scenarios fastest."""
    if "built" not in options:
        return _hrsafety.simulate_batch(natives, law._native, sets, weights, **options)
    built = options.pop("built")
    own = [_with_gains(law, row) for row in sets] if law.GAIN_NAMES else [law]
    natively = [each._native for each in own]
    return _hrsafety.as_built_many(natives, natively, sets, built, weights, **options)  # type: ignore[arg-type]  # by name


def _with_gains(law: Law, gains: Array) -> Law:
    """Return the law with other gains, given in the order of ``GAIN_NAMES``."""
    return law.replaced(**dict(zip(law.GAIN_NAMES, gains.tolist(), strict=True)))


def _gains_fastest(columns: Columns) -> Columns:
    """Return columns whose scenarios vary fastest with the gains fastest."""
    rows, sets = len(columns["gain_index"]), int(columns["gain_index"][-1]) + 1
    if sets == 1:
        return columns
    order = np.arange(rows).reshape(sets, -1).T.ravel()
    return {name: values[order] for name, values in columns.items()}


def _padded(values: Array, longest: int) -> Array:
    """Return histories with so many instants, NaN after the last."""
    missing = [(0, 0), (0, longest - values.shape[1]), *[(0, 0)] * (values.ndim - 2)]
    return np.pad(values, missing, constant_values=np.nan)


def _shifted(progress: Progress, before: int, total: int) -> Progress:
    """Return a progress callback that counts the runs of the laws before."""
    return lambda done, _: progress(before + done, total)
