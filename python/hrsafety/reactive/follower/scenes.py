"""Surroundings of the robot that follows a sound: leader and obstacles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, Parameters, instance, pair, positive, sequence
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.reactive.sonar.echoes import Box, Cylinder, Echoing, Wall

__all__ = ["FollowerScene", "MovingObstacle", "SoundLeader"]


@dataclass(frozen=True, kw_only=True, slots=True)
class MovingObstacle(Parameters):
    """A shape that moves straight for a while, or stands.

    Parameters
    ----------
    shape : Box, Cylinder or Wall
        At its first place.
    velocity : tuple of float
        While it moves, in m/s.
    start, stop : float
        When it starts and stops, in s.

    Raises
    ------
    InvalidParameterError
        If a number is not finite, or it stops before it starts.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> box = reactive.Box(center=(3.0, 2.0), size=(0.8, 0.5))
    >>> reactive.MovingObstacle(shape=box, velocity=(0.0, -0.3), stop=10.0).velocity
    (0.0, -0.3)
    """

    shape: Echoing
    velocity: Pair = (0.0, 0.0)
    start: float = 0.0
    stop: float = np.inf
    _native: _hrsafety.Mover = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        if not isinstance(self.shape, Echoing):
            raise InvalidParameterError("shape", "be a Box, a Cylinder or a Wall", self.shape)
        self._set(velocity=pair("velocity", self.velocity))
        values = self._as_numbers("start", "stop")
        self._set(_native=_hrsafety.Mover(shape=self.shape._native, velocity=self.velocity, **values))


@dataclass(frozen=True, kw_only=True, slots=True)
class SoundLeader(Parameters):
    """The source of the sound: it goes from one place to another and stays there.

    Parameters
    ----------
    start, end : tuple of float
        In m.
    speed : float
        In m/s.
    size : tuple of float or None
        Sides of the box along x and y that the sonar sees, in m; invisible when ``None``.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.SoundLeader(start=(6.0, 0.0)).end
    (6.0, 0.0)
    """

    start: Pair
    end: Pair | None = None
    speed: float = 0.3
    size: Pair | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(start=_finite("start", self.start), speed=positive("speed", self.speed))
        self._set(end=self.start if self.end is None else _finite("end", self.end))
        if self.size is not None:
            self._set(size=_finite("size", self.size))
            if min(self.size) <= 0.0:
                raise InvalidParameterError("size", "be two finite and positive numbers", self.size)


def _finite(name: str, value: object) -> Pair:
    given = pair(name, value)
    if not np.all(np.isfinite(given)):
        raise InvalidParameterError(name, "be finite", value)
    return given


@dataclass(frozen=True, kw_only=True, slots=True)
class FollowerScene(Parameters):
    """Surroundings of the follower, which starts at the origin and looks along x.

    Parameters
    ----------
    leader : SoundLeader
        Source of the sound.
    obstacles : sequence of MovingObstacle, Box, Cylinder or Wall
        A bare shape stands.
    duration : float
        How long it is watched, in s.

    Raises
    ------
    InvalidParameterError
        If something is of the wrong kind, or the duration is not positive.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.FollowerScene(leader=reactive.SoundLeader(start=(3.0, 0.0)), duration=20.0).obstacles
    ()
    """

    leader: SoundLeader
    obstacles: Sequence[MovingObstacle | Echoing] = ()
    duration: float = 26.0

    def __post_init__(self) -> None:
        """Check the values."""
        instance("leader", self.leader, SoundLeader)
        rule = "be a sequence of MovingObstacle, Box, Cylinder and Wall"
        movers = []
        for each in sequence("obstacles", rule, self.obstacles):
            if not isinstance(each, MovingObstacle | Box | Cylinder | Wall):
                raise InvalidParameterError("obstacles", rule, each)
            movers.append(each if isinstance(each, MovingObstacle) else MovingObstacle(shape=each, stop=0.0))
        self._set(obstacles=tuple(movers), duration=positive("duration", self.duration))

    @property
    def movers(self) -> tuple[MovingObstacle, ...]:
        """The obstacles, those that stand with velocity 0."""
        return tuple(each for each in self.obstacles if isinstance(each, MovingObstacle))
