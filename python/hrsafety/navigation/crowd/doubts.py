"""Whether the shields of robots in a world assume as much as the world has."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from hrsafety.navigation.crowd.agents import FASTEST_DRAWN, CrowdRobot, Person, Source
from hrsafety.navigation.laws.safe_navigation import SafeNavigation
from hrsafety.navigation.warnings.shields import Motion, Mover, of_surroundings
from hrsafety.plausibility import ResultWarning

__all__ = ["of_robots"]


def of_robots(
    people: Sequence[Person], sources: Sequence[Source], robots: Sequence[CrowdRobot], step: float, *, walls: bool
) -> tuple[ResultWarning, ...]:
    """Return the warnings of shields in a world, for each bound of a robot the one that is exceeded most.

    Parameters
    ----------
    people, sources, robots : sequence of Person, Source, CrowdRobot
        Who is in the world.
    step : float
        Its step in s, the control period of robots without one.
    walls : bool
        Whether there are any.

    Returns
    -------
    tuple of ResultWarning
        With the code ``"shield_assumes_less"``.
    """
    found: list[ResultWarning] = []
    for index, robot in enumerate(robots):
        law = robot.law
        if not isinstance(law, SafeNavigation) or law.shield is None:
            continue
        others = [each for each in _speeds(people, sources, robots) if each[0] != f"robots[{index}]"]
        fastest = max(others, key=lambda each: each[1], default=None)
        found += of_surroundings(
            law.shield,
            # Everybody decides anew at each step, for any velocity up to the largest speed.
            () if fastest is None else (Mover(*fastest, jump=2.0 * fastest[1]),),
            measurement=robot.measurement,
            motion=Motion(robot.robot, step if robot.control_period is None else robot.control_period, step),
            walls=walls,
            owner=f"robots[{index}].law.shield",
        )
    return tuple(found)


def _speeds(
    people: Iterable[Person], sources: Iterable[Source], robots: Iterable[CrowdRobot]
) -> Iterator[tuple[str, float]]:
    """Yield who is in a world, and the largest speed in m/s."""
    for index, person in enumerate(people):
        recorded = _recorded_speed(person)
        yield f"people[{index}]", _largest_speed(person) if recorded is None else recorded
    for index, source in enumerate(sources):
        yield f"sources[{index}]", _largest_speed(source)
    for index, robot in enumerate(robots):
        yield f"robots[{index}]", robot.robot.max_speed


def _largest_speed(owner: Person | Source) -> float:
    desired = FASTEST_DRAWN if owner.desired_speed is None else owner.desired_speed
    return desired * owner.model.max_speed_ratio if desired else 0.0


def _recorded_speed(person: Person) -> float | None:
    """Return the largest speed of a person who follows a recording, else ``None``."""
    if person.recording is None:
        return None
    time, places = person.recording
    steps = zip(time, time[1:], places, places[1:], strict=False)
    return max((math.dist(first, second) / (late - soon) for soon, late, first, second in steps), default=0.0)
