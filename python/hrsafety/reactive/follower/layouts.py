"""Random layouts of the experiments with the follower."""

from __future__ import annotations

from dataclasses import field
from typing import Literal

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, Parameters, checked_seed, number, pair, word
from hrsafety._records import dataclass
from hrsafety.reactive.follower.scenes import FollowerScene, MovingObstacle, SoundLeader
from hrsafety.reactive.sonar.echoes import Box

__all__ = ["FollowerLayouts"]

Kind = Literal["tracking", "static", "one_dynamic", "two_dynamic"]
KINDS = ("tracking", "static", "one_dynamic", "two_dynamic")


@dataclass(frozen=True, kw_only=True, slots=True)
class FollowerLayouts(Parameters):
    """Random layouts of experiment 1 (tracking), 2 (static) and 3 (one or two moving boxes).

    - static: source at (6, 0); boxes of 0.5 x 1.0 m at x from 1.6 to 2.4 m and of 0.5 x 0.8 m at
      x from 3.4 to 4.2 m, both up to 0.6 m off the line; 40 s.
    - dynamic: leader from (1.2, 0) to (7.5, 0) at 0.3 m/s; a box of 0.8 x 0.5 m that crosses the
      line at x from 2.5 to 4 m, from either side, up to 2 s before or after the follower is due,
      drifting along the line at up to 0.2 m/s; 26 s.
    - two: another one of 0.5 x 0.2 m from the other side at x from 4.5 to 6.5 m.

    Parameters
    ----------
    kind : str
        ``"tracking"``, ``"static"``, ``"one_dynamic"`` or ``"two_dynamic"``.
    obstacle_speed : tuple of float
        Slowest and fastest speed of the moving boxes across the line, in m/s.
    size_factor : float
        Factor on all sides of all boxes; 0.1 takes the printed millimeters literally.
    leader_size : tuple of float or None
        Sides of the leader along x and y that the sonar sees, in m; invisible when ``None``.

    Raises
    ------
    InvalidParameterError
        If a number is out of range or the word unknown.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> scene = reactive.FollowerLayouts(kind="one_dynamic").scene(7)
    >>> len(scene.obstacles), scene.obstacles[0].shape.size
    (1, (0.8, 0.5))
    """

    kind: Kind
    obstacle_speed: Pair = (0.15, 0.5)
    size_factor: float = 1.0
    leader_size: Pair | None = None
    _native: _hrsafety.FollowerLayouts = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(
            kind=word("kind", self.kind, KINDS),
            obstacle_speed=pair("obstacle_speed", self.obstacle_speed),
            size_factor=number("size_factor", self.size_factor),
        )
        if self.leader_size is not None:
            self._set(leader_size=pair("leader_size", self.leader_size))
        self._set(
            _native=_hrsafety.FollowerLayouts(
                kind=self.kind,
                obstacle_speed=self.obstacle_speed,
                size_factor=self.size_factor,
                leader_size=self.leader_size,
            )
        )

    def scene(self, seed: int) -> FollowerScene:
        """Return the layout of a seed.

        Parameters
        ----------
        seed : int
            0, 1, 2 and so on.

        Returns
        -------
        FollowerScene
            Leader, boxes and length.

        Raises
        ------
        InvalidParameterError
            If the seed is negative.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> reactive.FollowerLayouts(kind="static").scene(0).leader.start
        (6.0, 0.0)
        """
        found = _hrsafety.follower_layout(self._native, checked_seed("seed", seed))
        rows = zip(*(found[name].tolist() for name in ("center", "size", "velocity", "start", "stop")), strict=True)
        movers = [
            MovingObstacle(
                shape=Box(center=tuple(center), size=tuple(size)), velocity=tuple(velocity), start=start, stop=stop
            )
            for center, size, velocity, start, stop in rows
        ]
        leader = SoundLeader(
            start=tuple(found["leader_start"]),
            end=tuple(found["leader_end"]),
            speed=found["leader_speed"] or 0.3,
            size=self.leader_size,
        )
        return FollowerScene(leader=leader, obstacles=movers, duration=found["duration"])
