"""Search for a person against whom a law breaks a property."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any, Literal, cast

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, callback, checked_seed, count, instance, number, positive, thread_count, word
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._statistics import Share, wilson
from hrsafety.errors import InvalidParameterError, Shown, SimulationError
from hrsafety.navigation.laws.python_law import AnyLaw, as_law
from hrsafety.navigation.obstacles.moving import MovingDisc
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.warnings import runs as run_warnings
from hrsafety.navigation.warnings.shields import ASSUMES_LESS, shield_of
from hrsafety.plausibility import ResultWarning, implausible, telling
from hrsafety.tables import Columns, Table

if TYPE_CHECKING:
    from hrsafety.navigation.crowd.world import World

__all__ = ["Falsification", "Pursuit", "falsify"]

Property = Literal["at_fault", "clearance", "arrival", "speed"]
Progress = Callable[[int, int], object]
MOST_EPISODES = 10_000_000
FAR = 1e4
"""Where the person stands in the scenario before the episodes place him, in m."""
COUNTS = ("contacts_toward", "contacts_away", "contacts_standing", "wall_contacts")
COLUMNS = ("margin", "min_clearance", "arrival_time", "end_time", *COUNTS)
"""Columns that are kept of every episode."""
EVERY, LASTING = 0.5, 4.0
"""Time between two encounters with people who were hidden, and how long each lasts, in s."""
ROOM = 0.3
"""Least distance of the surfaces at the start, in m."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Pursuit(Table):
    """One episode against a person who sees the robot; rows are control periods and the end.

    Parameters
    ----------
    time : ndarray, shape (n,)
        Instants in s.
    position, velocity : ndarray, shape (n, 2)
        True motion of the robot in m and m/s.
    person_position : ndarray, shape (n, 2)
        True position of the person in m.
    least_toward : float
        Least distance of the surfaces while the robot moved toward a person, faster than 0.05 m/s, up to the first
        overlap with them by 0.1 m, in m; infinite if it never did. Not above zero: it touched him at fault.
    min_clearance : float
        Least distance of the surfaces in m.
    arrival_time, end_time : float
        In s; NaN without arrival.
    top_speed : float
        Largest speed of the robot in m/s.
    contacts_toward, contacts_away, contacts_standing : int
        Numbers of obstacles, the person and maps among them, that it touched first while it moved toward them, while it
        moved but not toward them, and while it stood.
    wall_contacts : int
        1 if it touched a map, which the others hold, too.
    """

    time: Annotated[Array, "s"]
    position: Annotated[Array, "m"]
    velocity: Annotated[Array, "m/s"]
    person_position: Annotated[Array, "m"]
    least_toward: Annotated[float, "m"]
    min_clearance: Annotated[float, "m"]
    arrival_time: Annotated[float, "s"]
    end_time: Annotated[float, "s"]
    top_speed: Annotated[float, "m/s"]
    contacts_toward: int = 0
    contacts_away: int = 0
    contacts_standing: int = 0
    wall_contacts: int = 0

    def columns(self) -> Columns:
        """Return one-dimensional columns by name.

        Returns
        -------
        dict of str to ndarray
            Time, positions and velocities with their units.
        """
        return {
            "time_s": self.time,
            "x_m": self.position[:, 0],
            "y_m": self.position[:, 1],
            "vx_m_per_s": self.velocity[:, 0],
            "vy_m_per_s": self.velocity[:, 1],
            "person_x_m": self.person_position[:, 0],
            "person_y_m": self.person_position[:, 1],
        }


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Falsification:
    """Result of a search for a broken property.

    Parameters
    ----------
    property_name : str
        The property, ``"own"`` for one of your own.
    margin : ndarray, shape (n,)
        By how much it held in each episode, negative where it was broken; of CMA-ES the worst alone.
    min_clearance, arrival_time, end_time : ndarray, shape (n,)
        Least distance of the surfaces in m, and when the robot arrived and the episode ended, in s; NaN
        without arrival.
    contacts_toward, contacts_away, contacts_standing, wall_contacts : ndarray of int, shape (n,)
        Numbers of first contacts of each episode, as those of a `Pursuit`.
    episodes : int
        Episodes in all.
    person_radius : float
        Of the person, in m.
    worst : Pursuit
        The episode of the least margin.
    warnings : tuple of ResultWarning
        What is doubtful about the episodes, as for a run.
    """

    property_name: str
    margin: Array
    min_clearance: Annotated[Array, "m"]
    arrival_time: Array
    end_time: Array
    contacts_toward: npt.NDArray[np.int64]
    contacts_away: npt.NDArray[np.int64]
    contacts_standing: npt.NDArray[np.int64]
    wall_contacts: npt.NDArray[np.int64]
    episodes: int
    person_radius: Annotated[float, "m"]
    worst: Pursuit
    warnings: tuple[ResultWarning, ...]

    @property
    def broken(self) -> bool:
        """Whether an episode broke the property."""
        return bool(self.margin.min() < 0.0)

    @property
    def share(self) -> Share:
        """Share of the random episodes that broke it, with its 95 % Wilson interval."""
        return wilson(int((self.margin < 0.0).sum()), len(self.margin))


@telling()
def falsify(
    scenario: Scenario | World,
    law: AnyLaw,
    property: Property | Callable[[Pursuit], float] = "at_fault",  # the word of the field
    *,
    method: Literal["random", "cma_es", "hidden"] = "random",
    episodes: int = 1000,
    least: float = 0.0,
    most: float | None = None,
    person_radius: float = 0.4,
    person_speed: float = 1.6,
    built: AsBuilt | None = None,
    seed: int = 0,
    step: float = 0.01,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Falsification:
    """Search for a person, who sees the robot, against whom a law breaks a property.

    One person is added to the scenario, at most as fast as is said. Random persons keep directions for
    0.35 s, circle and then dash, pursue with a lead, or feint; CMA-ES chooses the start, eight
    directions, the share of pursuit and the lead. The robot knows itself and everybody as in a run: as its
    sensors and the measurement of the scenario tell; every episode has noise of its own.

    Parameters
    ----------
    scenario : Scenario or World
        Where the robot goes, with whatever else there is; a world of one robot, in which the person keeps off walls and
        people react to him as to anybody. Worlds have a step of their own, and take random persons only.
    law : law
        What drives it.
    property : {"at_fault", "clearance", "arrival", "speed"} or callable
        What is to hold: the robot never moves toward a person whom it touches, from the first touch until the bodies
        first overlap by 0.1 m, and touches no map; surfaces never come
        nearer than ``least``; the robot arrives within the time limit; it is never faster than
        ``most``. Or a function of a `Pursuit` that returns a margin, negative where your property is
        broken (random persons only).
    method : {"random", "cma_es", "hidden"}
        How persons are chosen. ``"hidden"``: they are hidden by the map of a law whose shield reckons with `Unseen`
        people. The robot drives with nobody there; every 0.5 s somebody appears at the worst of 48 places where it
        does not see him, by a trial in which it does not react, and comes for it on the shortest way for 4 s. Contacts
        through walls do not count.
    episodes : int
        How many episodes; of hidden persons at most.
    least : float
        Least clearance in m.
    most : float or None
        Largest speed in m/s; that of the robot when ``None``.
    person_radius, person_speed : float
        Radius in m and largest speed in m/s of the person.
    built : AsBuilt or None
        How the robot is built, as for `simulate`.
    seed : int
        Seed of persons and noise.
    step : float
        Motion step in s.
    threads : int or None
        Number of threads; all cores when ``None``.
    progress : callable or None
        Called with (episodes done, episodes in all).

    Returns
    -------
    Falsification
        Margins, and the worst episode.

    Raises
    ------
    InvalidParameterError
        If a value is out of range, the law cannot work in the scenario, or your property returns no number.
    SimulationError
        If CMA-ES has no result.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> scene = nav.Scenario(start=(0, 0), goal=(6, 0), time_limit=12.0)
    >>> law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield())
    >>> nav.falsify(scene, law, episodes=20).broken
    False
    """
    if not isinstance(scenario, Scenario):
        given = property, method, least, most, person_radius, person_speed, built, step
        return _in_world(scenario, law, given, (episodes, seed, threads, progress))
    scene = scenario
    drives, own = as_law(law), callable(property)
    kind = "at_fault" if own else word("property", property, ("at_fault", "clearance", "arrival", "speed"))
    limit = _least(least) if kind == "clearance" else _most(most, scene) if kind == "speed" else 0.0
    how = word("method", method, ("random", "cma_es", "hidden"))
    if own and how != "random":
        raise InvalidParameterError("method", 'be "random" for a property of your own', method)
    size, fastest = positive("person_radius", person_radius), positive("person_speed", person_speed)
    pursued = _with_person(scene, size, fastest)
    robot = AsBuilt() if built is None else instance("built", built, AsBuilt)
    hunt = _hrsafety.Hunt(
        pursued._native,
        drives._native,
        robot._native,
        step=positive("step", step),
        person_speed=fastest,
        free=scene.robot.radius + size + ROOM,
    )
    runs, start = count("episodes", episodes, most=MOST_EPISODES), checked_seed("seed", seed)
    team, heard = thread_count(threads), callback("progress", progress)
    if callable(property):
        found, worst = _own(hunt, property, runs, start, heard)
    elif how == "cma_es":
        numbers, margin = hunt.worst((kind, limit), episodes=runs, seed=start, threads=team, progress=heard)
        if math.isnan(margin):
            raise SimulationError("the search for the worst person has no result")
        worst = _pursuit(hunt.replay(seed=start, index=0, numbers=numbers))
        found = {name: np.array([getattr(worst, name)]) for name in COLUMNS[1:]} | {"margin": np.array([margin])}
    elif how == "hidden":
        found, worst = _hidden(hunt, _unseen(drives), (kind, limit), runs, start)
    else:
        columns = hunt.sweep((kind, limit), episodes=runs, seed=start, threads=team, progress=heard)
        swept = cast(Mapping[str, Any], columns)
        found = {name: swept[name] for name in COLUMNS}
        worst = _pursuit(hunt.replay(seed=start, index=int(np.argmin(found["margin"])), numbers=None))
    return Falsification(
        property_name="own" if own else kind,
        **found,
        episodes=len(found["margin"]) if how == "hidden" else runs,
        worst=worst,
        person_radius=size,
        warnings=(
            *implausible({"person_radius": size, "person_speed": fastest}, {"person_speed": "pursuer_speed"}),
            *run_warnings.of_run(pursued, drives, robot, step),
            *run_warnings.of_way(drives, worst.position, pursued.walls),
            *_of_turns(drives, fastest),
            *(() if how == "hidden" else _of_walls(drives)),
        ),
    )


def _of_walls(law: object) -> Iterator[ResultWarning]:
    """Warn of persons who come through walls, where a shield takes walls to hide people."""
    shield, _ = shield_of(law)
    if shield is not None and shield.unseen is not None:
        message = (
            "persons walk through the walls of the map, but the shield takes people whom it does not see to keep off "
            'them: a fault says nothing about it; method="hidden" has persons who go around walls'
        )
        yield ResultWarning(ASSUMES_LESS, "shield.unseen", message)


def _unseen(law: object) -> _hrsafety.Unseen:
    """Return what the shield of a law assumes of people whom it does not see."""
    shield, _ = shield_of(law)
    if shield is None or shield.unseen is None:
        rule = "have a shield that reckons with people who are not seen"
        raise InvalidParameterError("law", rule, law, "Shield(unseen=Unseen())")
    return shield.unseen._native


def hidden_encounters(
    scenario: Scenario, law: AnyLaw, *, radius: float, speed: float, most: int, seed: int
) -> tuple[dict[str, Array], float]:
    """Return the columns of encounters with people who were hidden, evenly spread over a run with nobody there.

    Parameters
    ----------
    scenario : Scenario
        Where.
    law : law
        What drives the robot; its shield reckons with `Unseen` people.
    radius, speed : float
        Of the person, in m and m/s.
    most : int
        Most encounters.
    seed : int
        Of the starts.

    Returns
    -------
    columns : dict
        ``COLUMNS``, with the time in s and the start in m of each encounter, the largest speed in m/s with which the
        robot was at fault, and the control periods in which the person was neither seen nor reckoned with.
    arrival_time : float
        When the robot arrives with nobody there, in s; NaN if it does not.
    """
    drives = as_law(law)
    hunt = _hrsafety.Hunt(
        _with_person(scenario, radius, speed)._native,
        drives._native,
        AsBuilt()._native,
        step=0.01,
        person_speed=speed,
        free=scenario.robot.radius + radius + ROOM,
    )
    limit = ("at_fault", 0.0)
    found, places, alone = hunt.hidden(limit, _unseen(drives), every=EVERY, lasting=LASTING, most=most, seed=seed)
    columns = {name: np.array(found[name]) for name in (*COLUMNS, "fault_speed", "overlooked")}
    times = {"time": np.array([time for time, _ in places]), "start": np.array([start for _, start in places])}
    return columns | times, alone


def _hidden(
    hunt: _hrsafety.Hunt, unseen: _hrsafety.Unseen, limited: tuple[str, float], most: int, seed: int
) -> tuple[dict[str, Any], Pursuit]:
    """Return columns of encounters with people who were hidden, and the worst of them."""
    columns, places, _ = hunt.hidden(limited, unseen, every=EVERY, lasting=LASTING, most=most, seed=seed)
    if not places:
        raise SimulationError("nobody can hide in the map near the way of the robot")
    at = int(np.argmin(columns["margin"]))
    (time, start) = places[at]
    worst = _pursuit(hunt.hidden_replay(unseen, time=time, start=start, lasting=LASTING))
    return {name: columns[name] for name in COLUMNS}, worst


def _in_world(
    scenario: World, law: AnyLaw, given: tuple[Any, ...], runs: tuple[int, int, int | None, Progress | None]
) -> Falsification:
    """Search in a world of people who react."""
    # Here: searches in scenarios load nothing of it.
    from hrsafety.navigation.crowd.pursuits import falsified
    from hrsafety.navigation.crowd.world import World
    from hrsafety.navigation.simulation import refuse_in_worlds

    instance("scenario", scenario, Scenario, World)
    world = scenario
    if len(world.robots) != 1:
        raise InvalidParameterError("scenario.robots", "be one to be pursued", Shown(str(len(world.robots))))
    what, method, least, most, radius, speed, built, step = given
    refuse_in_worlds({"built": built, "step": step})
    if word("method", method, ("random", "cma_es")) != "random":
        raise InvalidParameterError("method", 'be "random" in a world', method)
    kind = "at_fault" if callable(what) else word("property", what, ("at_fault", "clearance", "arrival", "speed"))
    fastest = world.robots[0].body.max_speed * (1.0 + 1e-9)
    limit = _least(least) if kind == "clearance" else fastest if most is None else positive("most", most)
    size, pace = positive("person_radius", radius), positive("person_speed", speed)
    episodes, seed, threads, progress = runs
    pursued = falsified(
        world,
        as_law(law),
        (size, pace, world.robots[0].body.radius + size + ROOM),
        (count("episodes", episodes, most=MOST_EPISODES), checked_seed("seed", seed)),
        (thread_count(threads), callback("progress", progress)),
    )
    rows: dict[str, list[float]] = {name: [] for name in COLUMNS}
    worst, lowest = None, math.inf
    for index, (fields, doubts) in enumerate(pursued):
        pursuit = Pursuit(**fields)
        margin = number("margin of the property", what(pursuit)) if callable(what) else _margin(kind, pursuit, limit)
        if math.isnan(margin):
            name = f"margin of the property in episode {index}"
            raise InvalidParameterError(name, "be a number, negative where it is broken", margin)
        rows["margin"].append(margin)
        for name in COLUMNS[1:]:
            rows[name].append(getattr(pursuit, name))
        if worst is None or margin < lowest:
            worst, lowest, told = pursuit, margin, doubts
    assert worst is not None  # there is at least one episode
    return Falsification(
        property_name="own" if callable(what) else kind,
        **{name: np.array(values) for name, values in rows.items()},
        episodes=episodes,
        worst=worst,
        person_radius=size,
        warnings=(
            *implausible({"person_radius": size, "person_speed": pace}, {"person_speed": "pursuer_speed"}),
            *told,
            *_of_turns(as_law(law), pace),
        ),
    )


def _margin(kind: str, pursuit: Pursuit, limit: float) -> float:
    """Return by how much a property held, negative where it was broken, as the core has it."""
    if kind == "at_fault":
        # A touch without depth is one.
        return pursuit.least_toward if pursuit.least_toward > 0.0 else min(pursuit.least_toward, -1e-12)
    if kind == "clearance":
        return pursuit.min_clearance - limit
    if kind == "speed":
        return limit - pursuit.top_speed
    return 1.0 if not math.isnan(pursuit.arrival_time) else -1.0


def _of_turns(law: object, speed: float) -> Iterator[ResultWarning]:
    """Warn of a shield that knows velocities to less than a person changes his, who turns at once."""
    shield, _ = shield_of(law)
    if shield is not None and shield.velocity_error is not None and shield.velocity_error < 2.0 * speed:
        yield ResultWarning(
            ASSUMES_LESS,
            "shield.velocity_error",
            f"velocity_error of the shield is {shield.velocity_error:.4g}, but the person turns by up to "
            f"{2.0 * speed:.4g} m/s at once: a fault says nothing about the shield; give at least "
            f"velocity_error={2.0 * speed:.4g}",
        )


def _least(least: float) -> float:
    given = number("least", least)
    if not math.isfinite(given):
        raise InvalidParameterError("least", "be finite", least)
    return given


def _most(most: float | None, scenario: Scenario) -> float:
    return scenario.robot.max_speed * (1.0 + 1e-9) if most is None else positive("most", most)


def _with_person(scenario: Scenario, radius: float, speed: float) -> Scenario:
    """Return the scenario with one more person, placed by the episodes."""
    person = MovingDisc(center=(FAR, FAR), velocity=(speed, 0.0), radius=radius)
    return replace(scenario, obstacles=(*scenario.obstacles, person))


def _own(
    hunt: _hrsafety.Hunt, margin_of: Callable[[Pursuit], float], episodes: int, seed: int, heard: Progress | None
) -> tuple[dict[str, Any], Pursuit]:
    """Judge every episode by a function; return columns and the worst episode."""
    rows: dict[str, list[float]] = {name: [] for name in COLUMNS}
    worst, least = None, math.inf
    for index in range(episodes):
        pursuit = _pursuit(hunt.replay(seed=seed, index=index, numbers=None))
        margin = number("margin of the property", margin_of(pursuit))
        if math.isnan(margin):
            # Not below zero either: it would count as kept.
            what = f"margin of the property in episode {index}"
            raise InvalidParameterError(what, "be a number, negative where it is broken", margin)
        rows["margin"].append(margin)
        for name in COLUMNS[1:]:
            rows[name].append(getattr(pursuit, name))
        if worst is None or margin < least:
            worst, least = pursuit, margin
        if heard is not None:
            heard(index + 1, episodes)
    assert worst is not None  # there is at least one episode
    return {name: np.array(values) for name, values in rows.items()}, worst


def _pursuit(fields: Mapping[str, Any]) -> Pursuit:
    return Pursuit(
        time=fields["time"],
        position=fields["position"],
        velocity=fields["velocity"],
        person_position=fields["person_position"],
        least_toward=float(fields["least_toward"][0]),
        min_clearance=float(fields["min_clearance"][0]),
        arrival_time=float(fields["arrival_time"][0]),
        end_time=float(fields["end_time"][0]),
        top_speed=float(fields["top_speed"][0]),
        contacts_toward=int(fields["contacts_toward"][0]),
        contacts_away=int(fields["contacts_away"][0]),
        contacts_standing=int(fields["contacts_standing"][0]),
        wall_contacts=int(fields["wall_contacts"][0]),
    )
