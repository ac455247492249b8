"""Laws in worlds of people with seeds and gains: what `simulate_many` does with worlds."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from typing import Any, NamedTuple

import numpy as np

from hrsafety._arguments import Array
from hrsafety._bounds import MOST_TABLE_ROWS
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.crowd.contacts import Contacts, contacts_of
from hrsafety.navigation.crowd.episodes import outcome_of
from hrsafety.navigation.crowd.performance import lone, scores
from hrsafety.navigation.crowd.scores import episodes_of, world_metrics
from hrsafety.navigation.crowd.simulation import driven, simulated
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.crowd.world_run import WorldRun
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.metrics.between import doubts_between
from hrsafety.navigation.metrics.declared import METRICS, WORLD_METRICS
from hrsafety.navigation.metrics.scores import MetricTable, table_of
from hrsafety.navigation.run_arguments import Progress
from hrsafety.navigation.simulation import simulate
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.plausibility import ResultWarning, gathered

__all__ = ["WorldStudy"]

NUMBERS_AT_ONCE = 2e7
"""Numbers of trajectories that are kept at a time: 160 MB. The metrics stay, the trajectories do not."""


class Job(NamedTuple):
    """A run: indices of its scenario, seed, law and gain set."""

    scenario: int
    seed: int
    law: int
    gains: int


@dataclass(frozen=True, slots=True)
class WorldStudy:
    """Runs of a study: laws, worlds and seeds.

    Parameters
    ----------
    worlds : mapping of str to World
        Where.
    laws : mapping of str to Law
        What drives every robot of a world.
    sets : sequence of ndarray
        Gain sets of each law.
    seeds : list of int or None
        Seeds of every world; its own when ``None``.
    people_alone : bool
        Whether the people are simulated without the robots, too.
    weights : tuple of float or None
        Weights of H, which is computed if they are given: every robot is run alone, too.
    """

    worlds: Mapping[str, World]
    laws: Mapping[str, Law]
    sets: Sequence[Array]
    seeds: list[int] | None
    people_alone: bool
    weights: tuple[float, float, float] | None = None
    _nominal: dict[tuple[int, int, int, int], Trajectory] = field(init=False, default_factory=dict)
    _places: tuple[World, ...] = field(init=False)
    _drivers: tuple[Law, ...] = field(init=False)
    _names: tuple[str, ...] = field(init=False)

    def __post_init__(self) -> None:
        """Refuse worlds without robots, and a table that would not fit into memory."""
        object.__setattr__(self, "_places", tuple(self.worlds.values()))
        object.__setattr__(self, "_drivers", tuple(self.laws.values()))
        numbered = tuple(self.worlds) == tuple(map(str, range(len(self.worlds))))
        shown = tuple(f"scenarios[{name if numbered else repr(name)}]" for name in self.worlds)
        object.__setattr__(self, "_names", shown)
        for name, world in zip(self._names, self._places, strict=True):
            if not world.robots:
                raise InvalidParameterError(f"{name}.robots", "hold a robot for the laws to drive", Shown("none"))
        each = len(self.seeds or [0]) * sum(map(len, self.sets))
        rows = each * sum(len(world.robots) for world in self._places)
        if rows > MOST_TABLE_ROWS:
            rule = f"hold at most {MOST_TABLE_ROWS} runs with their scenarios, seeds and gain sets"
            raise InvalidParameterError("laws", rule, Shown(f"{rows} runs"), "split the call")

    def run(self, threads: int | None, progress: Progress | None) -> RunTable:
        """Run everything.

        Parameters
        ----------
        threads : int or None
            Number of threads.
        progress : callable or None
            Progress callback ``(done, total)``.

        Returns
        -------
        RunTable
            A row for each robot of each run.

        Raises
        ------
        InvalidParameterError
            If a law cannot work in a world, or a record of one would not fit into memory.
        """
        jobs = self._jobs()
        total = len(self._places) * len(self.seeds or [0]) * sum(map(len, self.sets))
        rows: list[_Rows] = []
        done = 0
        while part := self._part(jobs):
            heard = None if progress is None else _shifted(progress, done, len(part), total)
            rows.append(self._rows(part, threads, heard))
            done += len(part)
        return self._table(rows)

    def _jobs(self) -> Iterator[Job]:
        # All laws of a world and a seed side by side: its people alone are simulated once.
        for scenario in range(len(self._places)):
            for seed in range(len(self.seeds or [0])):
                for law, sets in enumerate(self.sets):
                    yield from (Job(scenario, seed, law, gains) for gains in range(len(sets)))

    def _part(self, jobs: Iterator[Job]) -> list[Job]:
        """Return the next jobs, as many as fit into memory at once, at least one."""
        found: list[Job] = []
        numbers = 0.0
        for job in jobs:
            found.append(job)
            numbers += _numbers_of(self._places[job.scenario])
            if numbers > NUMBERS_AT_ONCE:
                break
        return found

    def _rows(self, part: Sequence[Job], threads: int | None, progress: Progress | None) -> _Rows:
        """Return the rows of some jobs."""
        worlds = [self._world(job) for job in part]
        alone = list(dict.fromkeys((job.scenario, job.seed) for job in part)) if self.people_alone else []
        first = {(job.scenario, job.seed): world for job, world in zip(part, worlds, strict=True)}
        try:
            given = [*worlds, *(replace(first[each], robots=()) for each in alone)]
            runs = simulated(given, threads=threads, progress=progress)
        except InvalidParameterError as error:
            raise self._renamed(error, part) from None
        without = dict(zip(alone, runs[len(part) :], strict=True))
        rows = _Rows.of(part, runs[: len(part)], without, threads)
        if self.weights is not None:
            own = [
                scores(each, self._alone(job, index, run.scenario), self.weights)
                for job, run in zip(part, runs, strict=False)
                for index, each in enumerate(run.robots)
            ]
            rows.values.update({f"performance_{name}": np.array([each[name] for each in own]) for name in own[0]})
        return rows

    def _alone(self, job: Job, robot: int, world: World) -> Trajectory:
        """Return the run of a robot of a world alone, under a law with a gain set; noise does not matter."""
        key = job.scenario, robot, job.law, job.gains
        if key not in self._nominal:
            alone = lone(world, robot)
            law = world.robots[robot].law
            self._nominal[key] = simulate(alone.scenario, law, built=alone.built, step=alone.step)
        return self._nominal[key]

    def _world(self, job: Job) -> World:
        """Return the world of a job with its seed, its robots under the law with its gains."""
        world, law = self._places[job.scenario], self._drivers[job.law]
        if law.GAIN_NAMES:
            law = law.replaced(**dict(zip(law.GAIN_NAMES, self.sets[job.law][job.gains].tolist(), strict=True)))
        seed = world.seed if self.seeds is None else self.seeds[job.seed]
        return replace(driven(world, law), seed=seed)

    def _renamed(self, error: InvalidParameterError, part: Sequence[Job]) -> InvalidParameterError:
        """Return an error that names the scenario instead of the run in its part."""
        found = re.match(r"worlds\[(\d+)\]", error.argument)
        if found is None or int(found[1]) >= len(part):
            return error
        return error.renamed(self._names[part[int(found[1])].scenario] + error.argument[found.end() :])

    def _warnings(self) -> tuple[ResultWarning, ...]:
        """Return the doubts about every world under every law, the first of each kind."""
        doubts = (
            (name, driven(world, law).warnings)
            for law in self._drivers
            for name, world in zip(self._names, self._places, strict=True)
        )
        return gathered(doubts, "scenarios")

    def _between(self, parts: Sequence[_Rows]) -> tuple[ResultWarning, ...]:
        """Return the doubts about what happened: contacts that no instant shows, people set back at walls."""
        runs = (
            (self._names[job[0]], doubts) for part in parts for job, doubts in zip(part.jobs, part.doubts, strict=True)
        )
        return gathered(runs, "runs")

    def _table(self, parts: Sequence[_Rows]) -> RunTable:
        """Return the rows in the order of laws, scenarios, seeds, gains and robots."""
        jobs = np.concatenate([part.jobs for part in parts])
        order = np.lexsort((jobs[:, 4], jobs[:, 3], jobs[:, 1], jobs[:, 0], jobs[:, 2]))
        scenario, seed, law, gain, robot = jobs[order].T
        values = {name: np.concatenate([part.values[name] for part in parts])[order] for name in parts[0].values}
        contacts = np.concatenate([part.contacts for part in parts])[order]
        names = list(dict.fromkeys(name for each in self._drivers for name in each.GAIN_NAMES))
        gains = np.full((len(order), len(names)), np.nan)
        for index, (each, sets) in enumerate(zip(self._drivers, self.sets, strict=True)):
            columns = np.array([names.index(name) for name in each.GAIN_NAMES], dtype=np.int64)
            rows = np.flatnonzero(law == index)
            gains[np.ix_(rows, columns)] = sets[gain[rows]][:, : len(columns)]
        if self.seeds is None:
            seeds = np.array([world.seed for world in self._places], dtype=np.uint64)[scenario]
        else:
            seeds = np.array(self.seeds, dtype=np.uint64)[seed]
        return RunTable(
            law_names=tuple(self.laws),
            scenario_names=tuple(self.worlds),
            laws=self._drivers,
            scenarios=self._places,
            gain_names=tuple(names),
            law_index=law,
            scenario_index=scenario,
            gain_index=gain,
            robot=robot,
            seed=seeds,
            gains=gains,
            outcome=np.concatenate([part.outcome for part in parts])[order],
            end_time=np.concatenate([part.end_time for part in parts])[order],
            contacts_toward=contacts[:, 0],
            contacts_away=contacts[:, 1],
            contacts_standing=contacts[:, 2],
            contacts_at_fault=contacts[:, 3],
            contacts_apart=contacts[:, 4],
            contacts_moving=contacts[:, 0] + contacts[:, 1],
            arrival_time=values["arrival_time"],
            path_length=values["path_length"],
            min_clearance=values["min_clearance"],
            wall_contacts=values["wall_contacts"],
            energy=values.pop("energy"),
            **{name: values.pop(name) for name in [each for each in values if each.startswith("performance_")]},  # type: ignore[arg-type]  # by name
            values=values,
            doubts=(*self._warnings(), *self._between(parts), *_of_robots(values["robot_contacts"][robot == 0])),
        )


def _of_robots(pairs: np.ndarray[Any, np.dtype[Any]]) -> Iterator[ResultWarning]:
    """Yield the doubt that robots touch each other, which no outcome shows; ``pairs`` of each run."""
    touched = int((pairs > 0).sum())
    if touched:
        yield ResultWarning(
            "robot_contacts",
            "runs",
            f"robots touch each other in {touched} of {len(pairs)} runs, which changes no outcome, success or contact "
            "of a robot: robot_contacts counts the pairs",
        )


def _numbers_of(world: World) -> float:
    """Return how many numbers the trajectories of a world may have."""
    coming = sum(source.rate for source in world.sources) * world.time_limit
    agents = 1.0 + len(world.people) + len(world.robots) + coming
    return 8.0 * agents * (world.time_limit / world.step + 1.0)


def _shifted(progress: Progress, before: int, here: int, total: int) -> Progress:
    """Return a progress callback that counts the runs before; worlds without robots do not count."""
    return lambda done, _: progress(before + min(done, here), total)


@dataclass(frozen=True, slots=True)
class _Rows:
    """Columns of some runs, a row for each robot; ``jobs`` are those of `Job` and the robot."""

    jobs: np.ndarray[Any, np.dtype[np.int64]]
    outcome: np.ndarray[Any, np.dtype[np.str_]]
    end_time: Array
    contacts: np.ndarray[Any, np.dtype[np.int64]]
    values: dict[str, np.ndarray[Any, np.dtype[Any]]]
    doubts: Sequence[tuple[ResultWarning, ...]]

    @classmethod
    def of(
        cls,
        part: Sequence[Job],
        runs: Sequence[WorldRun],
        without: Mapping[tuple[int, int], WorldRun],
        threads: int | None,
    ) -> _Rows:
        """Return the rows of runs."""
        robots = [(index, robot) for index, run in enumerate(runs) for robot in range(len(run.scenario.robots))]
        episodes = [
            each
            for job, run in zip(part, runs, strict=True)
            for each in episodes_of(run, without.get((job.scenario, job.seed)))
        ]
        table = table_of(episodes, threads=threads)
        ends = table.arrival_time.tolist()
        contacts = [contacts_of(each, time) for each, time in zip(episodes, ends, strict=True)]
        least = table.min_time_to_collision.tolist(), table.wall_clearance.tolist()
        owner = [index for index, _ in robots]
        worlds = [world_metrics(run).to_dict() for run in runs]
        values: dict[str, np.ndarray[Any, np.dtype[Any]]] = {name: getattr(table, name) for name in METRICS}
        values |= {name: np.array([each[name] for each in worlds])[owner] for name in WORLD_METRICS}
        values["energy"] = np.array([runs[index].robot_energy[robot] for index, robot in robots])
        return cls(
            jobs=np.array([(*part[index], robot) for index, robot in robots], dtype=np.int64),
            outcome=np.array(
                [
                    _outcome(contacts[row], int(table.wall_contacts[row]), runs[index], robot)
                    for row, (index, robot) in enumerate(robots)
                ]
            ),
            end_time=np.array([runs[index].time[-1] for index in owner]),
            contacts=_with_walls(contacts, table),
            values=values,
            doubts=[
                (*doubts_between(*each), *_of_people(runs[index]))
                for index, each in zip(owner, zip(episodes, ends, *least, strict=True), strict=True)
            ],
        )


def _with_walls(contacts: Sequence[Contacts], table: MetricTable) -> np.ndarray[Any, np.dtype[np.int64]]:
    """Return the numbers of contacts: a wall stands, so a robot that touches it has moved toward it, at fault."""
    found = np.array(contacts, dtype=np.int64).reshape(-1, len(Contacts._fields))
    for name in ("toward", "at_fault"):
        found[:, Contacts._fields.index(name)] += table.wall_contacts
    return found


def _outcome(contacts: Contacts, walls: int, run: WorldRun, robot: int) -> str:
    arrived = not np.isnan(run.robot_arrival_time[robot])
    touched = contacts.moving + contacts.standing + walls > 0
    return outcome_of(touched=touched, arrived=arrived, diverged=run.diverged is not None)


def _of_people(run: WorldRun) -> tuple[ResultWarning, ...]:
    """Return the doubts of a run but those of its world, which are told once, and its end, which is a column."""
    known = {*run.scenario.warnings}
    return tuple(doubt for doubt in run.warnings if doubt not in known and doubt.code != "unfinished")
