"""Settings of a running world: law and parts around it, speeds, sensing of the robot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from hrsafety._arguments import flag, number, word
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.agents import Robot
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.laws.safe_navigation import SafeNavigation
from hrsafety.navigation.laws.shield import Shield
from hrsafety.navigation.laws.yielding import Yielding
from hrsafety.navigation.maps.guide import Guide
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.scenarios.laws import LAWS, law_named

__all__ = ["RANGES", "LiveSettings", "laws"]

RANGES: Mapping[str, tuple[float, float]] = {
    "robot_speed": (0.05, 3.0),
    "people_speed": (0.0, 2.0),
    "person_speed": (0.2, 3.0),
    "noise": (0.0, 0.3),
    "delay": (0.0, 1.0),
    "range": (1.0, 30.0),
}
"""Smallest and largest value of each number, in the unit of its field."""
OWN = "own"
"""Law of the world's file, with its gains."""


def laws() -> list[str]:
    """Return the laws that can be chosen."""
    return [OWN, *sorted(LAWS)]


@dataclass(frozen=True, kw_only=True, slots=True)
class LiveSettings:
    """Settings of a running world.

    Parameters
    ----------
    law : str
        Name of the law; ``"own"``: that of the world's file.
    shield, yielding, guide : bool
        Which parts stand around it.
    robot_speed : float
        Preferred speed of the robot in m/s.
    people_speed : float
        Desired speeds of people over those of the file.
    person_speed : float
        Speed of people in m/s that the shield reckons with.
    noise : float
        Standard deviation of the places of people that are told to the robot, in m.
    delay : float
        Age of these places in s.
    range : float
        Distance up to which the robot sees people, in m.
    """

    law: str
    shield: bool
    yielding: bool
    guide: bool
    robot_speed: float
    people_speed: float = 1.0
    person_speed: float = 1.6
    noise: float = 0.0
    delay: float = 0.0
    range: float = 10.0

    @classmethod
    def of(cls, robot: Robot, walls: StaticMap) -> LiveSettings:
        """Return the settings that a world has by its file."""
        law = robot.law
        parts = law if isinstance(law, SafeNavigation) else None
        shield = None if parts is None else parts.shield
        speed = robot.body.max_speed if parts is None or parts.preferred_speed is None else parts.preferred_speed
        known = shield is not None and shield.person_speed is not None
        return cls(
            law=OWN,
            shield=shield is not None,
            yielding=parts is not None and parts.yielding is not None,
            guide=(parts is not None and parts.guide is not None) or walls.bounds is not None,
            robot_speed=min(max(speed, RANGES["robot_speed"][0]), RANGES["robot_speed"][1]),
            person_speed=shield.person_speed if known else 1.6,  # type: ignore[union-attr, arg-type]  # known
            range=min(max(robot.sensing_range, RANGES["range"][0]), RANGES["range"][1]),
        )

    def changed(self, name: str, value: object) -> LiveSettings:
        """Return the settings with one of them changed.

        Raises
        ------
        InvalidParameterError
            If there is no such one, or the value is out of its range.
        """
        if name == "law":
            return replace(self, law=word("law", value, laws()))
        change: Any
        if name in ("shield", "yielding", "guide"):
            change = {name: flag(name, value)}
            return replace(self, **change)
        if name not in RANGES:
            raise InvalidParameterError("name", "be one of the settings", name)
        low, high = RANGES[name]
        given = number(name, value)
        if not low <= given <= high:
            raise InvalidParameterError(name, f"be from {low:g} to {high:g}", value)
        change = {name: given}
        return replace(self, **change)

    def made(self, robot: Robot, walls: StaticMap, most: float) -> Law:
        """Return the law with the parts around it, for a robot that the law may drive so many m/s fast."""
        given: Any = robot.law
        own = given if isinstance(given, SafeNavigation) else None
        inner = (given if own is None else own.law) if self.law == OWN else law_named("law", self.law)()
        if inner is None:
            inner = law_named("law", "virtual_force_field")()
        shield = (own.shield if own is not None and own.shield is not None else Shield()) if self.shield else None
        if shield is not None:
            error = max(shield.position_error, 3.0 * self.noise)
            shield = replace(shield, person_speed=self.person_speed, position_error=error)
        known = walls if walls.bounds is not None else None
        return SafeNavigation(
            inner,
            map=known,
            guide=_part(self.guide and known is not None, None if own is None else own.guide, Guide),
            shield=shield,
            yielding=_part(self.yielding, None if own is None else own.yielding, Yielding),
            preferred_speed=self.robot_speed if self.robot_speed < most else None,
        )

    def shown(self, robot: Robot) -> dict[str, Any]:
        """Return the settings by name, with the law of the file by its own name."""
        inner: Any = robot.law.law if isinstance(robot.law, SafeNavigation) else robot.law
        values = {name: getattr(self, name) for name in ("law", "shield", "yielding", "guide", *RANGES)}
        # A law of one's own has a name that is none of a table.
        own = "virtual_force_field" if inner is None else getattr(inner, "NAME", None) or inner.name
        return values | {"own": own}


def _part(wanted: bool, own: Any, kind: Callable[[], Any]) -> Any:
    if not wanted:
        return None
    return kind() if own is None else own
