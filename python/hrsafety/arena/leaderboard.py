"""The arena: entries in standard scenes, with intervals, paired tests, ranks, and safety against time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from itertools import product
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np

from hrsafety import _keys as kind
from hrsafety import scenarios, sweep
from hrsafety._arguments import Array, callback, checked_text, count, sequence, word
from hrsafety._display import displayed
from hrsafety._keys import checked, parsed
from hrsafety._records import dataclass
from hrsafety._statistics import Mean, Share, compare_paired, mean_interval, wilson
from hrsafety.arena.certificates import certify_many
from hrsafety.arena.episodes import COLUMNS, ENDS, SENSINGS, ArenaStudy
from hrsafety.arena.ranking import Ranks, ranks
from hrsafety.benchmarks.entries import Entry, entry
from hrsafety.errors import InvalidParameterError
from hrsafety.io.places.nav2 import read_nav2
from hrsafety.navigation.laws.declared import Law
from hrsafety.navigation.laws.python_law import AnyLaw, as_law
from hrsafety.plausibility import ResultWarning
from hrsafety.scenarios.laws import law_of, safe_of
from hrsafety.sweep.running import Progress

__all__ = ["ArenaCell", "EntryStanding", "Leaderboard", "run"]

PEOPLE = ("reacting", "not_reacting")
FILES = (".toml", ".yaml", ".yml")
TASK, BLOCK = 50, 20
"""Episodes of a task, and seeds that are kept together."""
WAITING = 32
"""Tasks on their way to an executor or a cluster at once."""
MOST_SEEDS = 100_000
REPLICATES = 2000
"""How often seeds are drawn again for the fronts."""


@displayed
class ArenaCell(NamedTuple):
    """An entry under conditions.

    Attributes
    ----------
    entry : str
        Its name.
    people : {"reacting", "not_reacting"}
        Whether people notice the robot.
    sensing : {"exact", "noise", "noise_delay"}
        How people are measured.
    """

    entry: str
    people: str
    sensing: str


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class EntryStanding:
    """How an entry stands under conditions.

    Parameters
    ----------
    cell : ArenaCell
        Entry and conditions.
    success, by_robot, wall, by_person, late, lost : Share
        Shares of the episodes by their ends: without a contact and in time (a task done to 0.75 m); touched somebody
        toward whom it moved, at the first instant of contact; touched a wall; was touched otherwise; too late;
        diverged, or the law failed.
    time_ratio : Mean
        Arrival over that of the certificate, of successes.
    p_value : float
        Exact McNemar test of the successes against the entry with the best score under these conditions, after Holm;
        1 for that entry itself.
    rank, rank_low, rank_high : float
        Median and the 2.5 and 97.5 percentiles of the rank under these conditions, see `ranks`.
    front : float
        Share of the drawn seeds in which no other entry has both fewer contacts by the robot and less time; an episode
        that is lost counts as one with a contact.
    """

    cell: ArenaCell
    success: Share
    by_robot: Share
    wall: Share
    by_person: Share
    late: Share
    lost: Share
    time_ratio: Mean
    p_value: float
    rank: float
    rank_low: float
    rank_high: float
    front: float


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Leaderboard:
    """Episodes of entries in scenes, and how the entries stand.

    Parameters
    ----------
    scenes : tuple of str
        Names of the scenes.
    seeds : int
        Seeds 0 to one less than this of each.
    certificate : ndarray of shape (scenes, seeds)
        Earliest arrival in s.
    episodes : mapping of ArenaCell to mapping of str to ndarray of shape (scenes, seeds)
        Column by name: ``"end"``, ``"arrival_time"`` in s, ``"task_error"`` in m, and the metrics of the cards.
    warnings : tuple of ResultWarning
        What is doubtful.
    """

    scenes: tuple[str, ...]
    seeds: int
    certificate: Annotated[Array, "s"]
    episodes: Mapping[ArenaCell, Mapping[str, Any]]
    warnings: tuple[ResultWarning, ...]

    def standings(self) -> list[EntryStanding]:
        """Return how the entries stand, under each of the conditions by their ranks.

        Returns
        -------
        list of EntryStanding
            A row for each entry and conditions.
        """
        found: list[EntryStanding] = []
        for conditions in dict.fromkeys((cell.people, cell.sensing) for cell in self.episodes):
            found += sorted(self._compared(*conditions), key=lambda each: (each.rank, -each.success.value))
        return found

    def scores(self, cell: ArenaCell) -> dict[str, Share]:
        """Return the share of successes by scene."""
        won = self.episodes[cell]["end"] == "success"
        return {name: wilson(int(row.sum()), row.size) for name, row in zip(self.scenes, won, strict=True)}

    def _compared(self, people: str, sensing: str) -> Iterator[EntryStanding]:
        """Yield the entries under the same conditions."""
        cells = [cell for cell in self.episodes if (cell.people, cell.sensing) == (people, sensing)]
        ends = np.array([self.episodes[cell]["end"] for cell in cells])
        ratio = np.array([self.episodes[cell]["arrival_time"] / self.certificate for cell in cells])
        won = ends == "success"
        ratio[~won] = np.nan
        places = ranks(won.astype(np.int64))
        values = _against_best(won, places)
        # What happened in an episode that was lost is not known: it is no contact that was avoided.
        fronts = _fronts((ends == "by_robot") | (ends == "lost"), ratio)
        runs = won[0].size
        for row, cell in enumerate(cells):
            shares = {end: wilson(int((ends[row] == end).sum()), runs) for end in ENDS}
            yield EntryStanding(
                cell=cell,
                **shares,
                time_ratio=mean_interval(ratio[row][np.isfinite(ratio[row])]),
                p_value=float(values[row]),
                rank=float(places.median[row]),
                rank_low=float(places.low[row]),
                rank_high=float(places.high[row]),
                front=float(fronts[row]),
            )


def _against_best(won: Any, places: Ranks) -> Array:
    """Return the p values against the best entry, after Holm."""
    best = int(np.argmax(places.score))
    values = np.array([compare_paired(each.ravel(), won[best].ravel()).p_value for each in won])
    others = [row for row in np.argsort(values, kind="stable") if row != best]
    least = 0.0
    for place, row in enumerate(others):
        least = values[row] = min(1.0, max(least, values[row] * (len(others) - place)))
    values[best] = 1.0
    return values


def _fronts(touched: Any, ratio: Array) -> Array:
    """Return how often each entry is on the front of contacts by the robot and mean ratio of times."""
    entries, scenes, seeds = touched.shape
    generator = np.random.default_rng(0)
    counts = np.zeros(entries)
    known = np.isfinite(ratio)
    times = np.where(known, ratio, 0.0)
    for _ in range(REPLICATES):
        drawn = generator.integers(0, seeds, (scenes, seeds))
        rows = np.arange(scenes)[:, None], drawn
        contacts = touched[:, *rows].mean(axis=(1, 2))
        wins = known[:, *rows].sum(axis=(1, 2))
        mean = np.where(wins > 0, times[:, *rows].sum(axis=(1, 2)) / np.maximum(wins, 1), np.inf)
        no_worse = (contacts[:, None] <= contacts) & (mean[:, None] <= mean)
        better = (contacts[:, None] < contacts) | (mean[:, None] < mean)
        counts += ~(no_worse & better).any(axis=0) & np.isfinite(mean)
    return counts / REPLICATES


def run(
    laws: Sequence[str] | Mapping[str, str | AnyLaw],
    *,
    scenes: Sequence[str] | None = None,
    seeds: int = 20,
    people: Sequence[str] = PEOPLE,
    sensing: Sequence[str] = ("exact",),
    out: str | PathLike[str] | None = None,
    executor: Executor | None = None,
    client: Any = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Leaderboard:
    """Run entries through the standard scenes, seed after seed, and compare them.

    Every entry has a guide around walls; words build their shields with the true bounds: people of 1.8 m/s, the error
    and age of measurements, and the error of the robot's motion. With ``out`` finished tasks are kept, and the same or
    a larger call resumes there. The bits are the same for any number of threads, and on a Dask cluster.

    Parameters
    ----------
    laws : sequence of str, or mapping of str to str or law
        Words such as ``"orca+shield+yielding"`` or ``"straight+barrier(margin=0.2)"``; a TOML file with the tables
        ``[law]`` and ``[safe]`` of `hrsafety.scenarios.load`; a parameter file of Nav2, whose controllers are entries;
        or entries by name: those, laws, functions of a `Situation`, objects with ``velocity`` or ``force``, policies
        as `hrsafety.gym.PolicyLaw`.
    scenes : sequence of str or None
        Which of `hrsafety.scenarios.SOCIAL`; all when ``None``.
    seeds : int
        Seeds 0 to one less than this of every scene, at most 100,000.
    people : sequence of {"reacting", "not_reacting"}
        Whether people notice the robot.
    sensing : sequence of {"exact", "noise", "noise_delay"}
        How people are measured: exactly, to 25 mm in each coordinate, or so and 0.1 s late.
    out : path-like or None
        Folder in which finished tasks are kept.
    executor : concurrent.futures.Executor or None
        Where tasks are computed, see `hrsafety.sweep.run`.
    client : distributed.Client or None
        A client of a Dask cluster, instead of an executor.
    threads : int or None
        Threads of each task; all cores when ``None``, one with an executor or a client.
    progress : callable or None
        Called with (episodes done, episodes in all).

    Returns
    -------
    Leaderboard
        Episodes, and how the entries stand.

    Raises
    ------
    InvalidParameterError
        If a word is unknown, a number out of range, or nothing is named.
    SweepError
        If the folder holds other episodes under the same names.

    Examples
    --------
    >>> from hrsafety import arena
    >>> board = arena.run(["orca(horizon=2)", "straight"], scenes=["frontal_approach"], seeds=2, people=["reacting"])
    >>> [each.cell.entry for each in board.standings()]
    ['orca(horizon=2)', 'straight']
    """
    entries = _entries(laws)
    places = [word("scenes", each, scenarios.SOCIAL) for each in _named("scenes", scenes, scenarios.SOCIAL)]
    numbers = count("seeds", seeds, most=MOST_SEEDS)
    whom = [word("people", each, PEOPLE) for each in _named("people", people, PEOPLE)]
    seen = [word("sensing", each, tuple(SENSINGS)) for each in _named("sensing", sensing, tuple(SENSINGS))]
    cells = [ArenaCell(name, who, how) for name in entries for who in whom for how in seen]
    studies = {
        cell: ArenaStudy(entry=entries[cell.entry], reacting=cell.people == "reacting", sensing=cell.sensing)
        for cell in cells
    }
    folders = {cell: _folder(out, cell) for cell in cells}
    given = {"executor": executor, "client": client, "threads": threads}
    found = _episodes(studies, folders, places, numbers, given, callback("progress", progress))
    worlds = [scenarios.social(name, seed) for name in places for seed in range(numbers)]
    certified = [each.arrival_time for each in certify_many(worlds, threads=threads)]
    return Leaderboard(
        scenes=tuple(places),
        seeds=numbers,
        certificate=np.array(certified).reshape(len(places), numbers),
        episodes=found,
        warnings=tuple(_doubts(studies, found, places, numbers)),
    )


def _named(name: str, given: object, known: Sequence[str]) -> list[str]:
    """Return what is named, each once."""
    found = list(known) if given is None else sequence(name, f"be a list of {', '.join(known)}", given)
    if not found or len(set(map(str, found))) != len(found):
        raise InvalidParameterError(name, "name at least one, none of them twice", given)
    return found


def _entries(laws: object) -> dict[str, Entry]:
    """Return the entries by name."""
    if not isinstance(laws, Mapping):
        words = _named("laws", laws, ()) if laws else []
        laws = {checked_text("laws", each, "hold words such as orca+shield"): each for each in words}
    if not laws:
        raise InvalidParameterError("laws", "name at least one entry", laws)
    found: dict[str, Entry] = {}
    for name, given in laws.items():
        checked_text("laws", name, "have names")
        if isinstance(given, str) and given.lower().endswith(FILES):
            found |= {own: Entry(name=own, law=law, parts=()) for own, law in _of_file(name, Path(given)).items()}
        else:
            found[name] = entry(given) if isinstance(given, str) else Entry(name=name, law=as_law(given), parts=())
    return found


def _of_file(name: str, path: Path) -> dict[str, Law]:
    """Return the law of a TOML file, or those of the controllers of a parameter file of Nav2."""
    if path.suffix.lower() == ".toml":
        given = checked("", parsed(path), dict.fromkeys(("law", "safe"), kind.table), required=("law",))
        law = law_of(given["law"])
        return {name: safe_of(law, given["safe"]) if "safe" in given else law}
    return {f"{name}:{own}": law for own, law in read_nav2(path).laws.items()}


def _folder(out: str | PathLike[str] | None, cell: ArenaCell) -> Path | None:
    """Return where the episodes of a cell are kept."""
    if out is None:
        return None
    plain = "".join(each if each.isalnum() or each in "+=,.-_" else "_" for each in cell.entry)
    return Path(out) / plain / f"{cell.people}-{cell.sensing}"


def _episodes(
    studies: Mapping[ArenaCell, ArenaStudy],
    folders: Mapping[ArenaCell, Path | None],
    places: Sequence[str],
    seeds: int,
    given: Mapping[str, Any],
    told: Progress | None,
) -> dict[ArenaCell, dict[str, Any]]:
    """Return the episodes of all cells: blocks of seeds of each scene, so that a larger call adds to them.

    All cells go through a block before the next one, so that they share the plans of their guides.
    """
    rows: dict[ArenaCell, dict[str, list[Any]]] = {cell: {each.name: [] for each in COLUMNS} for cell in studies}
    blocks = [range(begin, min(seeds, begin + BLOCK)) for begin in range(0, seeds, BLOCK)]
    tasks = list(product(places, blocks, studies))

    def computed(task: tuple[str, range, ArenaCell]) -> Any:
        place, block, cell = task
        axes = ("scene", [scenarios.SOCIAL.index(place)]), ("seed", block)
        design = sweep.Grid(tuple(sweep.Axis(name=name, values=tuple(map(float, own))) for name, own in axes))
        folder = folders[cell]
        kept = None if folder is None else folder / f"{place}-{block.start}-{block.stop - 1}"
        return sweep.run(design, studies[cell], out=kept, chunk_rows=TASK, **given)

    # Elsewhere many are computed at once; here each has all cores.
    elsewhere = given["executor"] is not None or given["client"] is not None
    pool = ThreadPoolExecutor(WAITING) if elsewhere else None
    try:
        done = 0
        for (_, block, cell), result in zip(tasks, (pool.map if pool else map)(computed, tasks), strict=True):
            for name, own in rows[cell].items():
                own.append(np.asarray(result[name]))
            done += len(block)
            if told is not None:
                told(done, len(studies) * len(places) * seeds)
    finally:
        if pool is not None:
            pool.shutdown(wait=False, cancel_futures=True)
    shape = len(places), seeds
    return {
        cell: {name: np.concatenate(parts).reshape(shape) for name, parts in own.items()} for cell, own in rows.items()
    }


def _doubts(
    studies: Mapping[ArenaCell, ArenaStudy],
    found: Mapping[ArenaCell, Mapping[str, Any]],
    places: Sequence[str],
    seeds: int,
) -> Iterator[ResultWarning]:
    """Warn of what is doubtful in the scenes with their first seed, of episodes that are lost, and of few seeds."""
    numbers = [scenarios.SOCIAL.index(place) for place in places]
    first: dict[str, ResultWarning] = {}
    names: dict[str, dict[str, None]] = {}
    for cell, study in studies.items():
        for world in study.worlds(numbers, [0] * len(numbers)):
            for doubt in world.warnings:
                first.setdefault(doubt.code, doubt)
                names.setdefault(doubt.code, {})[cell.entry] = None
    for code, doubt in first.items():
        message = f"{', '.join(names[code])}: {doubt.message}"
        yield ResultWarning(code, doubt.subject, message, safe_side=doubt.safe_side)
    told: set[str] = set()
    for cell, own in found.items():
        lost = np.argwhere(own["end"] == "lost")
        if len(lost) and cell.entry not in told:
            told.add(cell.entry)
            place, seed = (int(each) for each in lost[0])
            why = studies[cell].why_lost(numbers[place], seed)
            message = f"{len(lost)} episodes of {cell.entry} are lost and count as no success; in the first one {why}"
            yield ResultWarning("unfinished", "end", message)
    if seeds < 10:
        yield ResultWarning("few_runs", "seeds", f"{seeds} seeds of each scene say little: ranks may change with more")
