"""Velocity commands: which of those that came is executed at an instant, and what was wrong with the others."""

from __future__ import annotations

import math
from collections import Counter, deque
from collections.abc import Callable

from hrsafety.ros.base import STANDING, Limits, PlanarTwist

__all__ = ["LATE", "SILENT", "Commands"]

SILENT = 0.5
"""The base brakes after so many seconds without a command."""
LATE = 0.2
"""Commands older than so many seconds are executed, and counted."""
_AHEAD = 1e-3
"""A stamp may be so many seconds ahead of the clock, for it is rounded."""
_ROUNDING = 1e-6

_WORDS = {
    "command_not_finite": "a velocity command is not finite: it counts as none",
    "command_out_of_order": "a velocity command is older than one before it: ignored",
    "command_late": f"a velocity command is more than {LATE:g} s old: executed, and counted",
    "command_from_future": (
        "a velocity command has a stamp later than the clock: taken as without one; "
        "does its node have use_sim_time set to true?"
    ),
    "command_clipped": "a velocity command is beyond the limits of the robot: cut to them",
    "command_timeout": f"no velocity command for {SILENT:g} s: the robot brakes",
}


class Commands:
    """Commands in the order in which they come.

    Parameters
    ----------
    limits : Limits
        Of the base.
    delay : float
        Time from hearing a command until it is executed, in s.
    tell : callable
        Called with a text about the first one of each kind that is counted.
    """

    __slots__ = ("_coming", "_heard", "_limits", "_silent", "_stamp", "_tell", "_twist", "counts", "delay")

    def __init__(self, limits: Limits, delay: float, tell: Callable[[str], None]) -> None:
        self._limits = limits
        self._tell = tell
        self.delay = delay
        self.counts: Counter[str] = Counter()
        self.forget()

    def forget(self) -> None:
        """Forget all commands: the base is to stand until the next one."""
        self._coming: deque[tuple[float, PlanarTwist]] = deque()
        self._twist = STANDING
        self._heard: float | None = None
        self._stamp = -math.inf
        self._silent = False

    def _count(self, code: str) -> None:
        self.counts[code] += 1
        if self.counts[code] == 1:
            self._tell(_WORDS[code])

    def received(self, given: tuple[float, float, float], stamp: float | None, now: float) -> bool:
        """Take a command, and return whether it answers what was published at this instant.

        Parameters
        ----------
        given : tuple of float
            Speeds ahead and to the left in m/s, and turn rate in rad/s.
        stamp : float or None
            When it was made, in s; ``None`` without one.
        now : float
            Present time in s.

        Returns
        -------
        bool
            Whether it counts, and was made now or later or does not say.
        """
        if not all(map(math.isfinite, given)):
            self._count("command_not_finite")
            return False
        if stamp is not None and stamp > now + _AHEAD:
            self._count("command_from_future")
            stamp = None
        if stamp is not None:
            if stamp < self._stamp:
                self._count("command_out_of_order")
                return False
            self._stamp = stamp
            if now - stamp > LATE + _ROUNDING:
                self._count("command_late")
        twist, beyond = self._limits.within(PlanarTwist(*given))
        if beyond:
            self._count("command_clipped")
        self.counts["commands"] += 1
        self._coming.append((now + self.delay, twist))
        self._heard, self._silent = now, False
        return stamp is None or stamp >= now - _ROUNDING

    def next_change(self) -> float:
        """Return when another twist is to be executed at the latest without another command, in s."""
        coming = self._coming[0][0] if self._coming else math.inf
        silent = math.inf if self._heard is None or self._silent else self._heard + SILENT
        return min(coming, silent)

    def at(self, now: float) -> PlanarTwist:
        """Return the twist to execute from an instant on, in s: none after a silence."""
        while self._coming and self._coming[0][0] <= now + _ROUNDING:
            self._twist = self._coming.popleft()[1]
        if self._heard is not None and not self._silent and now >= self._heard + SILENT - _ROUNDING:
            self._silent = True
            self._count("command_timeout")
        return STANDING if self._silent or self._heard is None else self._twist

    @property
    def silent(self) -> bool:
        """Whether the base brakes since no command has come for too long, or none at all."""
        return self._silent or self._heard is None
