"""Recorded people, some of which react."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import checked_seed, instance, number, positive
from hrsafety._doubts import LateDoubts
from hrsafety.datasets import Recording
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.agents import Person, Robot
from hrsafety.navigation.crowd.pedestrians import Pedestrian
from hrsafety.navigation.crowd.world import World
from hrsafety.scenarios.placing import model_of

__all__ = ["with_recording"]

Array = npt.NDArray[np.float64]

RECORDED_RADIUS = 0.2
"""Radius of recorded people in m."""


def with_recording(
    recording: Recording,
    share: float,
    *,
    model: Pedestrian | None = None,
    robots: Sequence[Robot] = (),
    start_time: float | None = None,
    time_limit: float = 60.0,
    radius: float = RECORDED_RADIUS,
    awareness: float = 1.0,
    seed: int = 0,
) -> World:
    """Return recorded people, some of which react, with their recorded start, end and mean speed.

    Parameters
    ----------
    recording : Recording
        People over time.
    share : float
        The first share of those in view, from 0 to 1, reacts; the others follow the recording.
    model : Pedestrian or None
        Model of those who react; ``None``: `CollisionFreeSpeed`.
    robots : sequence of Robot
        Robots among them.
    start_time : float or None
        Instant of the recording at which the world starts, in s; ``None``: its first one.
    time_limit : float
        Longest simulated time in s.
    radius : float
        Of the people, in m.
    awareness : float
        Of those who react.
    seed : int
        Seed of the world.

    Returns
    -------
    World
        Those who react appear where and when they do in the recording, or where they are at the start, and
        leave at the end of their way.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range.

    Examples
    --------
    >>> from hrsafety import scenarios
    >>> from hrsafety.datasets import Recording
    >>> walk = Recording(time_s=[0, 0, 4, 4], person=[1, 2, 1, 2], position=[[0, 0], [5, 1], [5, 0], [0, 1]])
    >>> world = scenarios.with_recording(walk, 0.5)
    >>> [person.recording is None for person in world.people]
    [True, False]
    """
    instance("recording", recording, Recording)
    part = number("share", share)
    if not 0.0 <= part <= 1.0:
        raise InvalidParameterError("share", "be from 0 to 1", share)
    begin = float(recording.time_s[0]) if start_time is None else number("start_time", start_time)
    limit = positive("time_limit", time_limit)
    of = model_of(model)
    seen = []
    for who in recording.people().tolist():
        rows = recording.person == who
        time, position = recording.time_s[rows] - begin, recording.position[rows]
        if time[-1] > 0.0 and time[0] < limit:
            seen.append((time, position))
    reacting = round(part * len(seen))
    everybody = [
        _reacting(time, position, of, radius, awareness)
        # Who is in view at one instant only goes nowhere.
        if index < reacting and time[-1] > max(0.0, time[0])
        else Person(start=tuple(position[0].tolist()), recording=(time, position), radius=radius)
        for index, (time, position) in enumerate(seen)
    ]
    return World(
        people=everybody,
        robots=robots,
        seed=checked_seed("seed", seed),
        time_limit=limit,
        doubts=LateDoubts(lambda: recording.warnings),
    )


def _reacting(time: Array, position: Array, model: Pedestrian, radius: float, awareness: float) -> Person:
    """Return a person who walks from the recorded start to the recorded end at the recorded mean speed."""
    enters = max(0.0, float(time[0]))
    here = [float(np.interp(enters, time, position[:, axis])) for axis in (0, 1)]
    later = time > enters
    end = position[-1]
    places = np.vstack([here, position[later]])
    duration = float(time[-1]) - enters
    path = float(np.hypot(*np.diff(places, axis=0).T).sum())
    speed = path / duration
    way = end - here
    distance = float(np.hypot(*way))
    velocity = way / distance * speed if distance > 0.0 else np.zeros(2)
    return Person(
        start=(here[0], here[1]),
        route=[(float(end[0]), float(end[1]))],
        model=model,
        radius=radius,
        desired_speed=speed,
        velocity=(float(velocity[0]), float(velocity[1])),
        at_end="leave",
        awareness=awareness,
        enters=enters,
    )
