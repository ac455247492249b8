"""Warnings of scenarios that matter for the law that drives the robot."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from hrsafety._arguments import Array
from hrsafety.navigation.knowledge import late_cameras
from hrsafety.navigation.laws.force_laws import BorensteinKoren, GeCui, Khatib, Law, Masoud, VirtualForceField
from hrsafety.navigation.laws.safe_navigation import SafeNavigation
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.maps.unknown import over_unknown
from hrsafety.navigation.obstacles.standing import Disc, Rectangle
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.navigation.warnings.filters import of_filter
from hrsafety.navigation.warnings.scans import of_object, of_robot, unwatched
from hrsafety.navigation.warnings.scenarios import BELOW_SAFE, GOAL_IN_REGION, GOAL_NEAR_STOP, IN_CRITICAL_REGION
from hrsafety.navigation.warnings.shields import ASSUMES_LESS, maps_of, of_hidden_ways, of_order, of_shield, shield_of
from hrsafety.navigation.warnings.walls import unknown_walls
from hrsafety.plausibility import ResultWarning, gathered

__all__ = ["keeps_to_regions", "of_commands", "of_repeats", "of_run", "of_runs", "of_scenes", "of_way"]

UNKNOWN_MAP = "unknown_map"
"""Code of a law that does not know the walls of the laws that it is compared with."""
ONE_RUN = "one run says as much"
"""Remedy for repeats under a law that no noise reaches."""
MOST_TWINS = 100
"""So many pairs of scenes with runs of the same bits are compared."""


def of_run(
    scenario: Scenario, law: Law, built: AsBuilt | None = None, motion_step: float = 0.01
) -> tuple[ResultWarning, ...]:
    """Return the warnings of a scenario that matter for a law, and of sensors that see less than they must.

    Parameters
    ----------
    scenario : Scenario
        Where it runs.
    law : Law
        What drives the robot. Only the virtual force field brakes in critical regions, so their size
        says nothing about the other laws, nor about one that a shield keeps safe.
    built : AsBuilt or None
        How the robot is built; a point mass that knows everything when ``None``.
    motion_step : float
        Of the run, in s.

    Returns
    -------
    tuple of ResultWarning
        The warnings.
    """
    brakes = law.law if isinstance(law, SafeNavigation) and law.shield is None else law
    by_regions = isinstance(brakes, VirtualForceField)
    of_map: Iterable[ResultWarning] = (each for map in maps_of(law) for each in map.warnings)
    about_regions = () if by_regions else (BELOW_SAFE, IN_CRITICAL_REGION)
    about_regions = about_regions if keeps_to_regions(law) else (*about_regions, GOAL_NEAR_STOP)
    # A law that cannot reach a goal in a region is refused, so whatever runs can.
    of_scene = (each for each in scenario.warnings if each.code not in (*about_regions, GOAL_IN_REGION))
    if scenario.walls is not None:
        own = () if built is None else tuple(each.map for each in built.sensors if isinstance(each, Lidar))
        of_map = itertools.chain(of_map, scenario.walls.warnings, unknown_walls(scenario.walls, law, own))
    of_sensors = () if built is None else (*of_robot(scenario, law, built), *_late(scenario, built, by_regions))
    shield, walls = shield_of(law)
    measured = built is not None or scenario.measurement is not None
    things = scenario.obstacles
    stands = any(isinstance(each, Disc | Rectangle) for each in things)
    of_map = itertools.chain(of_map, unwatched(law, sum(not isinstance(each, Disc | Rectangle) for each in things)))
    # Contacts are counted with the walls of the scene, and with maps around the object.
    there = stands or scenario.walls is not None or any(maps_of(law, whole=False))
    of_map = itertools.chain(of_map, of_object(law, scenario.robot, built, scenario.time_limit, walls=there))
    of_rule = of_filter(law, measured=measured, walls=stands or scenario.walls is not None or any(maps_of(law)))
    if shield is None:
        return (*of_scene, *of_sensors, *of_map, *of_rule)
    return (
        *of_scene,
        *of_sensors,
        *of_map,
        *of_order(law),
        *of_shield(scenario, shield, built, motion_step, walls=walls),
        *of_hidden_ways(scenario, shield, maps_of(law)),
    )


def keeps_to_regions(law: object) -> bool:
    """Return whether a law is pushed away by active regions, without anything around it that takes over."""
    if isinstance(law, SafeNavigation):
        return law.foresight is None and not law._takes_over and keeps_to_regions(law.law)
    return isinstance(law, VirtualForceField | Masoud | GeCui | Khatib | BorensteinKoren)


def _late(scenario: Scenario, built: AsBuilt, by_regions: bool) -> Iterator[ResultWarning]:
    return late_cameras(scenario, built) if by_regions else iter(())


def of_way(law: Law, position: Array, walls: object) -> Iterator[ResultWarning]:
    """Warn of a run that leads over ground that was not observed, of all maps that its law knows and of the scene."""
    for map in _maps(law, walls):
        yield from over_unknown(map, position, "the run")


def _maps(law: Law, walls: object) -> list[StaticMap]:
    """Return the maps that a law knows, and that which the walls of a scene are: contacts count with both."""
    known = maps_of(law)
    if isinstance(walls, StaticMap) and not any(map is walls for map in known):
        known = [*known, walls]
    return known


def _straight_way(scenario: Scenario, law: Law) -> Iterator[ResultWarning]:
    """Warn of a straight way over ground that was not observed: a table has no positions to look at.

    A guide keeps to what is known, so only the ends count under one.
    """
    ends = np.array([scenario.start, scenario.goal])
    guided = isinstance(law, SafeNavigation) and law.guide is not None
    for map in _maps(law, scenario.walls):
        if not guided:
            yield from over_unknown(map, ends, "the straight way to the goal")
        elif map.unseen(ends).any():
            message = "start or goal lies on unknown ground: nobody has seen what stands there"
            yield ResultWarning("unknown_ground", "map", message)


def of_commands(law: Law, periods: int) -> Iterator[ResultWarning]:
    """Warn of control periods in which commands from outside took the place of a law with a shield."""
    if periods and shield_of(law)[0] is not None:
        message = (
            f"in {periods} control periods the robot was commanded from outside, past the shield of its law: nothing "
            "is proved for this run; give commands to a law in Python within the shield"
        )
        yield ResultWarning(ASSUMES_LESS, "command", message)


def of_runs(
    scenarios: Sequence[Scenario],
    names: Sequence[str],
    laws: Iterable[Law],
    built: AsBuilt | None = None,
    motion_step: float = 0.01,
) -> tuple[ResultWarning, ...]:
    """Return the warnings of many runs, the first of each kind with the number of the others.

    Parameters
    ----------
    scenarios : sequence of Scenario
        Where they run.
    names : sequence of str
        Their names, for the subjects.
    laws : iterable of Law
        What drives the robots.
    built : AsBuilt or None
        How they are built.
    motion_step : float
        Of the runs, in s.

    Returns
    -------
    tuple of ResultWarning
        One for each code, in the order in which they were found.
    """
    kept = list(laws)
    named = zip(names, scenarios, strict=True)
    found = (
        (
            name,
            [
                each
                for law in kept
                for each in (*of_run(scenario, law, built, motion_step), *_straight_way(scenario, law))
            ],
        )
        for name, scenario in named
    )
    return (*gathered(found, "scenarios"), *_of_maps(kept, built))


def _of_maps(laws: Sequence[Law], built: AsBuilt | None) -> Iterator[ResultWarning]:
    """Warn of laws that go through the walls of the others: a run counts contacts with the maps that it knows."""
    maps = [maps_of(law) for law in laws]
    seen = () if built is None else [getattr(sensor, "map", None) for sensor in built.sensors]  # that of a lidar
    for index, known in enumerate(maps):
        if any(wall not in (*known, *seen) for others in maps for wall in others):
            message = (
                f"laws[{index}] does not know the map of another law: its runs go through those walls, and no contact "
                "with them is counted; put it into nav.SafeNavigation with the same map="
            )
            yield ResultWarning(UNKNOWN_MAP, f"laws[{index}].map", message)
            return


def of_scenes(
    scenarios: Sequence[Scenario], laws: Iterable[Law], motion_step: float = 0.01
) -> tuple[ResultWarning, ...]:
    """Return the warnings of many runs in scenarios that have numbers for names, see `of_runs`."""
    return of_runs(scenarios, [f"scenarios[{index}]" for index in range(len(scenarios))], laws, None, motion_step)


def of_repeats(table: Any) -> Iterator[ResultWarning]:
    """Warn of runs that a `RunTable` holds more than once: shares and intervals count each of them.

    Parameters
    ----------
    table : RunTable
        Its runs.

    Yields
    ------
    ResultWarning
        With the code ``"same_runs"``: for seeds that change nothing, or that are given twice, and for scenes that are.
    """
    yield from _of_copies(table)
    keys = [table.law_index, table.scenario_index, table.gain_index, *([] if table.robot is None else [table.robot])]
    group = np.ravel_multi_index(keys, [int(each.max(initial=0)) + 1 for each in keys])
    _, first, group, counts = np.unique(group, return_index=True, return_inverse=True, return_counts=True)
    if not len(counts) or counts.max() == 1:
        return
    differs = table.outcome != table.outcome[first][group]
    for name in ("end_time", "path_length", "min_clearance"):
        own = getattr(table, name)
        there = own[first][group]
        differs |= (own != there) & ~(np.isnan(own) & np.isnan(there))
    alike = (np.bincount(group, weights=differs) == 0) & (counts > 1)
    order = np.lexsort((table.seed, group))
    again = (np.diff(group[order]) == 0) & (table.seed[order][1:] == table.seed[order][:-1])
    alike[group[order][1:][again]] = True
    if not alike.any():
        return
    row = first[alike][0]
    law, scene = table.law_names[table.law_index[row]], table.scenario_names[table.scenario_index[row]]
    more = f" ({alike.sum() - 1} more of this kind in these runs)" if alike.sum() > 1 else ""
    noise = getattr(table.scenarios[table.scenario_index[row]], "measurement", None)
    if np.flatnonzero(alike)[0] in group[order][1:][again]:
        why, remedy = "seeds are repeated", "give each run a seed of its own"
    elif noise is not None and noise.scale > 0.0:
        why = f"there is noise, but none of it reaches what {law} does, as of a law that ignores people"
        remedy = ONE_RUN
    else:
        why = "nothing there draws from the seeds"
        remedy = "a measurement with noise, or a scene that is drawn for each seed, makes them differ"
    message = (
        f"of the {counts[alike][0]} runs of {law} in {scene} some are the same run: {why}, and shares and intervals "
        f"count one run as many; {remedy}{more}"
    )
    yield ResultWarning("same_runs", "seeds", message)


def _of_copies(table: Any) -> Iterator[ResultWarning]:
    """Warn of scenes that are copies of others, by the runs in them that have the same bits."""
    if len(table.scenarios) < 2:
        return
    values = [table.end_time, table.path_length, table.min_clearance, table.law_index, table.gain_index]
    values += [] if table.robot is None else [table.robot]
    rows = np.column_stack([np.asarray(each, dtype=np.float64) for each in values]).view(np.uint64)
    order = np.lexsort(rows.T)
    scene = table.scenario_index[order]
    twins = np.flatnonzero((rows[order][1:] == rows[order][:-1]).all(axis=1) & (scene[1:] != scene[:-1]))
    # Mirrored scenes have such runs, too: whether scenes are copies, but for a seed that changes nothing, they tell.
    pairs = [(row, table.scenarios[scene[row]], table.scenarios[scene[row + 1]]) for row in twins[:MOST_TWINS].tolist()]
    copies = [row for row, one, other in pairs if _copied(one, other)]
    if copies:
        count = len(twins) if len(copies) == MOST_TWINS else len(copies)
        one, other = (table.scenario_names[scene[copies[0] + step]] for step in (0, 1))
        message = (
            f"scenarios {one} and {other} are copies of one scene with the same runs ({count} such pairs of "
            f"{len(table)} runs): shares and intervals count one run as many; draw each scene with a seed of its own"
        )
        yield ResultWarning("same_runs", "scenarios", message)


def _copied(one: Any, other: Any) -> bool:
    """Return whether two scenes differ in nothing but a seed, or cannot be told apart but have the same runs."""
    try:
        return bool(replace(one, seed=other.seed) == other)
    except (TypeError, ValueError):  # laws of users may hold arrays, which have no one answer
        return True
