"""Shares of runs with a contact under exact, noisy and late sensing: the part ``shares`` of measure_laws.py.

``python docs/measure_laws.py --only shares`` prints the tables, ``--write`` replaces what stands between
the two marks of docs/validation.md. Beside every row of shares stands what a random search over one
person's way finds within the same limits: the fastest robot at a contact.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hrsafety import navigation as nav
from hrsafety import scenarios
from page_tables import DOCS, head, line, shares

PAGE = DOCS / "validation.md"
MARKS = "tables of measure_shares.py"

SENSINGS: dict[str, nav.Measurement | None] = {
    "exact": None,
    "25 mm noise": nav.Measurement(scale=0.025),
    "25 mm noise, 0.1 s late": nav.Measurement(scale=0.025, latency=0.1),
}
"""Uniform errors of x and y of what moves, at every control period; velocities are their differences."""
FIELD_LAWS = ("New field", "Khatib", "Borenstein & Koren", "Masoud", "Ge & Cui")
"""Laws that look at regions; the others keep margins of their own."""
EXACTLY_SIZED = "New field, regions for exact sensing"
# Episodes of one cell; a step of these costs a hundred to ten thousand times one of the others.
CROWD_EPISODES = 1000
SLOW_CROWD_EPISODES = {("Extended RRT", 12): 100, ("Field D*", 3): 200, ("Field D*", 12): 100}
LEFT_OUT = ("Extended RRT, tuned", "Field D*, tuned")
"""Take 0.1 to 4 ms for a control step."""
ENCOUNTERS, SLOW_ENCOUNTERS = 1500, {"Field D*": 200}
WALKS, WALK_SEEDS, SLOW_WALK_SEEDS = ("parallel_human", "unpredictable_human"), 300, {"Field D*": 100}
KEPT, CHILDREN = 16, 8
DRAWN, ROUNDS = 512, 4
SEARCHED: dict[type[nav.Law], tuple[int, int]] = {
    nav.VirtualForceField: (1024, 12),
    nav.RapidlyExploringRandomTree: (1024, 12),
    nav.FieldDStar: (256, 4),
}
"""Ways that the adversary draws, then rounds in which each of the worst ways kept is changed so often."""

WAY, MIDDLE, SHALLOWEST = 10.0, (2.0, 8.0), math.radians(20.0)
SLOWEST, SPREAD, RADIUS = 0.5, 1.0, 0.4

Say = Callable[..., None]
Laws = Mapping[str, nav.Law]
Ways = np.ndarray
"""Rows of place on the robot's way in m, course in rad, speed in m/s, delay in s behind the robot."""


@dataclass(frozen=True)
class Condition:
    """What the people of single encounters may do, and what their regions are sized for."""

    fastest: float
    sized: float
    sized_for_sensing: bool = False

    @property
    def title(self) -> str:
        """Return the words above the table."""
        sensing = "the sensing of each column" if self.sized_for_sensing else "exact sensing"
        return (
            f"One person of up to {self.fastest:g} m/s, regions sized for {self.sized:g} m/s "
            f"(`max_speed={self.sized:g}`) and {sensing}."
        )


CONDITIONS = (Condition(1.0, 1.0), Condition(1.6, 1.0), Condition(1.6, 1.6), Condition(1.6, 1.6, True))
ROBOT = nav.HolonomicRobot()


def encounter(
    way: Sequence[float], condition: Condition, measurement: nav.Measurement | None, seed: int
) -> nav.Scenario:
    """Return a robot on a way of 10 m that one person crosses."""
    place, course, speed, delay = way
    velocity = (speed * math.cos(course), speed * math.sin(course))
    when = place / ROBOT.max_speed + delay
    start = (place - when * velocity[0], -when * velocity[1])
    person = nav.Human(start=start, velocity=velocity, radius=RADIUS, max_speed=condition.sized)
    return nav.Scenario(
        start=(0.0, 0.0),
        goal=(WAY, 0.0),
        obstacles=[person if condition.sized_for_sensing else sized_exactly(person)],
        robot=ROBOT,
        time_limit=60.0,
        rest_time=60.0,
        measurement=measurement,
        seed=seed,
    )


def sized_exactly(obstacle: nav.Human | nav.MovingDisc) -> nav.Human | nav.MovingDisc:
    """Return an obstacle that keeps the regions of exact sensing, whatever the scenario measures."""
    radii = nav.region_radii(ROBOT, replace(obstacle, active_radius=None, critical_radius=None))
    return replace(obstacle, **radii._asdict())


def sized_for_sensing(scenario: nav.Scenario) -> nav.Scenario:
    """Return a scenario with regions larger by what the speed of each obstacle and its sensing add."""

    def sized(obstacle: nav.Obstacle) -> nav.Obstacle:
        known = obstacle
        if isinstance(obstacle, (nav.Human, nav.MovingDisc)):
            known = replace(obstacle, max_speed=max(obstacle.max_speed or 0.0, math.hypot(*obstacle.velocity)))
        robot, period = scenario.robot, scenario.control_period
        before = nav.region_radii(robot, obstacle, period)
        after = nav.region_radii(robot, known, period, measurement=scenario.measurement)
        critical, active = (larger - smaller for larger, smaller in zip(after, before, strict=True))
        return replace(
            known,
            critical_radius=obstacle.critical_radius + critical,
            active_radius=obstacle.active_radius + active,
        )

    return replace(scenario, obstacles=tuple(map(sized, scenario.obstacles)))


def free_at_start(ways: Ways, distance: float = 2.0) -> np.ndarray:
    """Return which people are not near the robot at the start, farther than any critical region."""
    place, course, speed, delay = ways.T
    when = place / ROBOT.max_speed + delay
    return np.hypot(place - when * speed * np.cos(course), when * speed * np.sin(course)) > distance


def crossings(number: int, fastest: float) -> Ways:
    """Return ways that cross the middle of the robot's way about when it is there."""
    generator = np.random.Generator(np.random.PCG64(7))
    ways = np.empty((0, 4))
    while len(ways) < number:
        draw = generator.random((number, 5))
        course = SHALLOWEST + (math.pi - 2.0 * SHALLOWEST) * draw[:, 1] + math.pi * (draw[:, 2] < 0.5)
        columns = (
            MIDDLE[0] + (MIDDLE[1] - MIDDLE[0]) * draw[:, 0],
            course,
            SLOWEST + (fastest - SLOWEST) * draw[:, 3],
            SPREAD * (2.0 * draw[:, 4] - 1.0),
        )
        drawn = np.stack(columns, axis=1)
        ways = np.concatenate([ways, drawn[free_at_start(drawn)]])
    return ways[:number]


# ---- adversary ----------------------------------------------------------------------------------


def danger(law: nav.Law, scenes: Sequence[nav.Scenario]) -> np.ndarray:
    """Return the robot's speed at the contact of each scene in m/s; less than 0 is the clearance, negated."""
    table = nav.simulate_batch(scenes, law)
    found = -np.maximum(table.min_clearance, 1e-9)
    for index in np.flatnonzero(table.contacts_moving + table.contacts_standing):
        found[index] = np.nanmax(nav.simulate(scenes[index], law).contact_speed)
    return found


def adversary(law: nav.Law, condition: Condition, measurement: nav.Measurement | None) -> str:
    """Return the fastest contact that a random search over a person's way finds, or the least clearance."""
    drawn, rounds = SEARCHED.get(type(law), (DRAWN, ROUNDS))
    generator = np.random.Generator(np.random.PCG64(11))
    low = np.array([0.0, 0.0, 0.1, -6.0])
    high = np.array([WAY, 2.0 * math.pi, condition.fastest, 6.0])
    ways = low + (high - low) * generator.random((drawn, 4))
    found, seed = np.full(0, -np.inf), 0
    kept = np.empty((0, 4))
    for round_number in range(rounds + 1):
        ways = ways[free_at_start(ways)]
        scenes = [encounter(way, condition, measurement, seed + k) for k, way in enumerate(ways)]
        seed += len(scenes)
        found = np.concatenate([found, danger(law, scenes)])
        kept = np.concatenate([kept, ways])
        order = np.argsort(-found, kind="stable")[:KEPT]
        found, kept = found[order], kept[order]
        spread = 0.1 * 0.7**round_number * (high - low)
        ways = np.clip(
            np.repeat(kept, CHILDREN, axis=0) + spread * generator.normal(size=(KEPT * CHILDREN, 4)), low, high
        )
    if found[0] < 0.0:
        return f"none, {-found[0]:.2f} m"
    return f"{found[0]:.2f} m/s" if found[0] >= 0.005 else "stands"


# ---- tables -------------------------------------------------------------------------------------


def encounter_cell(name: str, law: nav.Law, condition: Condition, sensing: str) -> tuple[str, str]:
    """Return the shares of one law with one sensing, and what the adversary finds."""
    measurement = SENSINGS[sensing]
    ways = crossings(SLOW_ENCOUNTERS.get(name, ENCOUNTERS), condition.fastest)
    scenes = [encounter(way, condition, measurement, seed) for seed, way in enumerate(ways)]
    return shares(nav.simulate_batch(scenes, law)), adversary(law, condition, measurement)


def encounter_table(laws: Laws, condition: Condition, say: Say) -> Iterator[str]:
    """Yield every law against one person who crosses its way."""
    yield from head("", "runs", *(title for name in SENSINGS for title in (name, "worst found")))
    for name, law in laws.items():
        if condition != CONDITIONS[0] and condition.fastest == condition.sized and name not in FIELD_LAWS:
            continue
        cells = [cell for sensing in SENSINGS for cell in encounter_cell(name, law, condition, sensing)]
        say("encounters,", condition.title, name)
        yield line(name, SLOW_ENCOUNTERS.get(name, ENCOUNTERS), *cells)
    yield ""


@functools.lru_cache(maxsize=8)
def crowds(obstacles: int, runs: int, sensing: str, exactly: bool) -> tuple[nav.Scenario, ...]:
    """Return random obstacles with one sensing, for all laws."""
    scenes = [scenarios.random_traffic(obstacles, seed=seed) for seed in range(runs)]
    if exactly:
        scenes = [replace(scene, obstacles=tuple(map(sized_exactly, scene.obstacles))) for scene in scenes]
    return tuple(replace(scene, measurement=SENSINGS[sensing]) for scene in scenes)


def crowd_cell(name: str, law: nav.Law, obstacles: int, sensing: str) -> str:
    """Return the shares of one law among random obstacles with one sensing."""
    runs = SLOW_CROWD_EPISODES.get((name, obstacles), CROWD_EPISODES)
    return shares(nav.simulate_batch(crowds(obstacles, runs, sensing, name == EXACTLY_SIZED), law))


def crowd_title(obstacles: int) -> str:
    """Return the words above the table of a crowd."""
    return (
        f"Crowds of {obstacles}: discs of 0.3 to 1.0 m/s, regions sized for the speed of each and the sensing of each "
        "column."
    )


def crowd_table(laws: Laws, obstacles: int, say: Say) -> Iterator[str]:
    """Yield every law among random obstacles."""
    yield from head("", "runs", *SENSINGS)
    for name, law in laws.items():
        cells = [crowd_cell(name, law, obstacles, sensing) for sensing in SENSINGS]
        say("crowds of", obstacles, name)
        yield line(name, SLOW_CROWD_EPISODES.get((name, obstacles), CROWD_EPISODES), *cells)
    yield ""


def walk_cell(name: str, law: nav.Law, walk: str, sensing: str) -> str:
    """Return the shares of one law in a walk of section 5.7 with one sensing."""
    exact, seeds = scenarios.configuration(walk), range(SLOW_WALK_SEEDS.get(name, WALK_SEEDS))
    return shares(nav.simulate_batch([replace(exact, measurement=SENSINGS[sensing], seed=k) for k in seeds], law))


def walk_table(laws: Laws, say: Say) -> Iterator[str]:
    """Yield every law in the two walks of section 5.7."""
    titles = (f"{walk.replace('_human', ' person')}, {name}" for walk in WALKS for name in SENSINGS)
    yield from head("", "runs", *titles)
    for name, law in laws.items():
        cells = [walk_cell(name, law, walk, sensing) for walk in WALKS for sensing in SENSINGS]
        say("section 5.7", name)
        yield line(name, SLOW_WALK_SEEDS.get(name, WALK_SEEDS), *cells)
    yield ""


def tuned(laws: Laws, page: str) -> dict[str, nav.Law]:
    """Return the laws with the tuned parameters that the page prints."""
    found: dict[str, nav.Law] = {}
    table = page.partition("| tuned | mean H in training")[2]
    for name, cell in re.findall(r"^\| ([^|]+?) \| ([^|]+?) \| \d", table.partition("\n\n")[0], re.MULTILINE):
        pairs = (each.rsplit(" ", 1) for each in cell.split(", "))
        law: nav.Law = laws[name]
        if f"{name}, tuned" not in LEFT_OUT:
            found[f"{name}, tuned"] = replace(law, **{gain: float(value) for gain, value in pairs})  # type: ignore[type-var]  # laws
    return found


def tables(laws: Laws, ablations: Laws, say: Say) -> str:
    """Return all tables of shares."""
    every = {**laws, EXACTLY_SIZED: laws["New field"], **ablations, **tuned(laws, PAGE.read_text(encoding="utf-8"))}
    parts: list[tuple[str, Iterator[str]]] = [
        (condition.title, encounter_table(laws, condition, say)) for condition in CONDITIONS
    ]
    for obstacles in (3, 12):
        parts.append((crowd_title(obstacles), crowd_table(every, obstacles, say)))
    title = "Walks of section 5.7: person of up to 1.0 m/s, regions of the source (0.8 and 2.1 m)."
    parts.append((title, walk_table(laws, say)))
    lines = [entry for words, rows in parts for entry in (words, "", *rows)]
    return "\n" + "\n".join(lines) + "\n"
