"""Conditions under which zones must hold: robot, delays, scanner and people."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any

import numpy as np

from hrsafety._arguments import Pair, Parameters, finite, finite_pair, flag, not_negative, number, positive
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.plausibility import RANGES, ResultWarning, implausible
from hrsafety.standards.separation import slow_person
from hrsafety.zones.reach import RobotOutline, footprint_of

__all__ = ["Conditions"]

ASSUMED = {
    "footprint": 0.22,
    "max_speed": 0.5,
    "max_turn_rate": 2.0,
    "deceleration": 2.5,
    "reaction_time": 0.15,
    "error": 0.02,
    "beam_step": math.radians(0.5),
}
"""Robot of Nav2's default parameters, for what a check is not told."""

_QUANTITIES = {
    "max_speed": "robot_max_speed",
    "max_turn_rate": "robot_max_turn_rate",
    "deceleration": "base_deceleration",
    "turn_deceleration": "base_turn_deceleration",
    "deceleration of turns at the farthest point of the footprint": "base_rim_deceleration",
    "acceleration": "robot_max_acceleration",
    "reaction_time": "reaction_time",
    "person_speed": "person_speed",
    "error": "position_uncertainty",
    "supplement": "intrusion",
    "beam_step": "beam_step",
    "leg_radius": "leg_radius",
    "footprint": "robot_radius",
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Conditions(Parameters):
    """Robot, delays, scanner and people that zones must hold for.

    Parameters
    ----------
    footprint : float or array_like (n, 2)
        Radius in m about the base frame, or the corners of a convex body in m.
    max_speed : float
        Largest commanded speed in m/s; in every direction of a holonomic robot.
    max_turn_rate : float
        Largest commanded turn rate in rad/s, either way.
    deceleration : float
        Deceleration d of a stop in m/s^2 that the robot always reaches: loaded, on its worst floor. Velocity and turn
        rate brake together.
    reaction_time : float
        Largest time T in s from the instant at which a leg is in a zone until the robot begins to brake: period and age
        of the scan, period of the commands, processing, drive.
    error : float
        Largest error e of measured points in m.
    beam_step : float
        Angle q between beams of the scanner in rad.
    min_speed : float
        Largest speed backward in m/s, as a number that is not positive; not of a holonomic robot.
    holonomic : bool
        Whether the robot drives sideways.
    build_up : float
        Time t_b in s in which the deceleration rises to d.
    turn_deceleration : float or None
        Deceleration of turns in rad/s^2; ``None``: d at the farthest point of the footprint.
    acceleration : float or None
        Acceleration of the base in m/s^2; ``None``: d.
    command_fall, turn_command_fall : float or None
        Limit of falling commands in m/s^2 and rad/s^2, as a velocity smoother keeps it; ``None``: a command may drop at
        once, so that every zone must cover the largest speed.
    tracking_lag : float
        Lag of the base behind its commands in s, beyond the drive's share of T.
    scan_period, command_period : float or None
        In s; ``None``: T/3 and T/6. The rest of T lies half before and half behind the monitor.
    person_speed : float
        Largest speed u of people in m/s; 1.6 (ISO 13855) where nothing was measured.
    leg_radius : float
        Radius rho in m of the thinnest leg that must be seen.
    supplement : float
        Distance Z in m that is kept beyond: for what overhangs legs, reflectors, or a low floor clearance.
    scanner : tuple of float
        Place of the scanner in the base frame in m; it looks all around.
    min_range, max_range : float
        Of the scanner in m.

    Examples
    --------
    >>> from hrsafety import zones
    >>> robot = zones.Conditions(
    ...     footprint=0.22, max_speed=0.5, max_turn_rate=1.0, deceleration=2.5, reaction_time=0.15, error=0.02,
    ...     beam_step=0.0087,
    ... )
    >>> robot.person_speed
    1.6
    """

    footprint: Any
    max_speed: float
    max_turn_rate: float
    deceleration: float
    reaction_time: float
    error: float
    beam_step: float
    min_speed: float = 0.0
    holonomic: bool = False
    build_up: float = 0.0
    turn_deceleration: float | None = None
    acceleration: float | None = None
    command_fall: float | None = None
    turn_command_fall: float | None = None
    tracking_lag: float = 0.0
    scan_period: float | None = None
    command_period: float | None = None
    person_speed: float = 1.6
    leg_radius: float = 0.06
    supplement: float = 0.0
    scanner: Pair = (0.0, 0.0)
    min_range: float = 0.0
    max_range: float = 10.0

    def __post_init__(self) -> None:
        """Check every number, and what they are together."""
        footprint_of(self.footprint)
        if not isinstance(self.footprint, RobotOutline) and np.ndim(self.footprint):
            self._set(footprint=tuple(tuple(map(float, each)) for each in np.asarray(self.footprint)))
        for name in ("max_speed", "deceleration", "reaction_time", "beam_step", "leg_radius", "max_range"):
            self._set(**{name: positive(name, getattr(self, name))})
        for name in ("max_turn_rate", "error", "build_up", "tracking_lag", "person_speed", "supplement", "min_range"):
            self._set(**{name: not_negative(name, getattr(self, name))})
        for name in ("turn_deceleration", "acceleration", "command_fall", "turn_command_fall"):
            if getattr(self, name) is not None:
                self._set(**{name: positive(name, getattr(self, name))})
        for name in ("scan_period", "command_period"):
            if getattr(self, name) is not None:
                self._set(**{name: not_negative(name, getattr(self, name))})
        self._set(
            min_speed=finite("min_speed", self.min_speed),
            scanner=finite_pair("scanner", self.scanner),
            holonomic=flag("holonomic", self.holonomic),
        )
        self._check_together()

    def _check_together(self) -> None:
        if self.min_speed > 0.0:
            rule = "not be positive: it is the largest speed backward with its sign"
            raise InvalidParameterError("min_speed", rule, self.min_speed, f"write {-self.min_speed:g}, or 0 for none")
        if self.holonomic and self.min_speed != 0.0:
            raise InvalidParameterError(
                "min_speed", "be 0 of a holonomic robot", self.min_speed, "max_speed is that of every direction"
            )
        if self.beam_step > math.pi / 4.0:
            raise InvalidParameterError("beam_step", "be at most pi/4 rad", self.beam_step, "are these degrees?")
        if self.max_range <= self.min_range:
            raise InvalidParameterError("max_range", f"be above min_range ({self.min_range:g})", self.max_range)
        if self.scan_time + self.command_time > self.reaction_time * (1.0 + 1e-9):
            shown = Shown(f"{self.reaction_time:g} s with periods of {self.scan_time:g} s and {self.command_time:g} s")
            raise InvalidParameterError("reaction_time", "hold scan_period and command_period", shown)
        if not math.isfinite(self.max_speed / self.deceleration) or self.max_speed / self.deceleration > 3600.0:
            raise InvalidParameterError("deceleration", "stop the robot within an hour", self.deceleration)

    @classmethod
    def assumed(cls, **given: Any) -> tuple[Conditions, tuple[ResultWarning, ...]]:
        """Return conditions in which what is not given is that of Nav2's default robot, with a doubt that names it.

        Parameters
        ----------
        **given
            Parameters of `Conditions`; ``None`` counts as not given.

        Returns
        -------
        tuple of Conditions and tuple of ResultWarning
            The doubt ``assumed`` if anything was.
        """
        told = {name: value for name, value in given.items() if value is not None}
        names = [each.name for each in fields(cls)]
        for name in told:
            if name not in names:
                raise TypeError(f"Conditions has no parameter {name!r}")
        missing = {name: value for name, value in ASSUMED.items() if name not in told}
        found = cls(**{**missing, **told})
        if not missing:
            return found, ()
        words = ", ".join(f"{name} {value:.4g}" for name, value in missing.items())
        message = (
            f"not told, taken from the default robot of Nav2: {words} (SI units); a verdict needs those of the robot"
        )
        return found, (ResultWarning("assumed", ", ".join(missing), message),)

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Numbers that are hardly meant in their unit, slow people, and brakes of turns that were not told."""
        far = self.body.circumscribed
        # A robot that does not turn has a turn rate of 0.
        values = {name: getattr(self, name, None) or None for name in _QUANTITIES} | {"footprint": far}
        if self.turn_deceleration is not None and self.turn_deceleration <= RANGES["base_turn_deceleration"].most:
            values["deceleration of turns at the farthest point of the footprint"] = self.turn_deceleration * far
        found = (*implausible(values, _QUANTITIES), *slow_person("person_speed", self.person_speed, "zones"))
        if self.turn_deceleration is not None or self.max_turn_rate == 0.0:
            return found
        message = (
            "not told: turn_deceleration; turns are taken to brake with the velocity, by "
            f"{self.turn_braking:.4g} rad/s^2: a robot that turns on while it stops sweeps more ground; a verdict "
            "needs the one that was measured"
        )
        return (*found, ResultWarning("assumed", "turn_deceleration", message))

    def numbers(self) -> dict[str, object]:
        """Return every parameter by name, as given.

        Returns
        -------
        dict of str to object
            Of `Conditions`.
        """
        return {each.name: getattr(self, each.name) for each in fields(self)}

    @property
    def body(self) -> RobotOutline:
        """RobotOutline of the robot."""
        return footprint_of(self.footprint)

    @property
    def scan_time(self) -> float:
        """Period of the scans in s."""
        return self.reaction_time / 3.0 if self.scan_period is None else self.scan_period

    @property
    def command_time(self) -> float:
        """Period of the commands in s."""
        return self.reaction_time / 6.0 if self.command_period is None else self.command_period

    @property
    def scan_age(self) -> float:
        """Age of a scan when the monitor knows it, in s."""
        return max(0.0, 0.5 * (self.reaction_time - self.scan_time - self.command_time))

    @property
    def drive_delay(self) -> float:
        """Time in s from the monitor to the base."""
        return max(0.0, self.reaction_time - self.scan_time - self.command_time - self.scan_age)

    @property
    def drift_time(self) -> float:
        """Time in s within which the base may still obey commands older than the last one that passed."""
        return self.reaction_time - self.command_time + self.tracking_lag

    @property
    def turn_braking(self) -> float:
        """Deceleration of turns in rad/s^2."""
        found = self.turn_deceleration
        return self.deceleration / self.body.circumscribed if found is None else found

    @property
    def speeding(self) -> float:
        """Acceleration of the base in m/s^2."""
        return self.deceleration if self.acceleration is None else number("acceleration", self.acceleration)

    @property
    def slowest(self) -> float:
        """Least vx of a command in m/s."""
        return -self.max_speed if self.holonomic else self.min_speed
