"""Results of a contact from all its numbers by name, as tables of cases hold them."""

from __future__ import annotations

from typing import Any

from hrsafety import contact

SUPPORTS = {"robot": "drive", "body": "support"}
OF_CONTACT = ("region", "covering", "area", "max_strain")


def made(given: dict[str, Any]) -> contact.Contact:
    """Return the contact of some numbers, which are taken out of them."""
    own: dict[str, Any] = {name: given.pop(name) for name in OF_CONTACT if name in given}
    for side, name in SUPPORTS.items():
        parts = {part: given.pop(f"{side}_{part}") for part in ("damping", "stiffness") if f"{side}_{part}" in given}
        if side == "robot" and given.get("stop") is not None:
            parts["stop"] = given.pop("stop")
        if parts:
            own[name] = contact.Support(**parts)
    given.pop("stop", None)
    mass = given.pop("body_mass", None)
    return contact.Contact(robot=given.pop("robot_mass"), body=mass, **own)


def allowed_speed(**given: Any) -> contact.AllowedSpeed:
    limits = given.pop("limits", None)
    return made(given).allowed_speed(limits, **given)


def simulate(**given: Any) -> contact.ContactImpact:
    limits, speed = given.pop("limits", None), given.pop("closing_speed")
    return _of(given, limits).simulate(speed, **given)


def thickness(**given: Any) -> contact.LeastThickness:
    limits, speed = given.pop("limits", None), given.pop("speed")
    if isinstance(given["covering"], dict):
        given["covering"] = {"thickness": 0.01, **given["covering"]}
    return made(given).thickness(speed, limits)


def sensitivity(**given: Any) -> dict[str, float]:
    limits = given.pop("limits", None)
    return made(given).sensitivity(limits)


def _of(given: dict[str, Any], limits: object) -> contact.Contact:
    """Return a contact whose body is that of a limit object, if there is one."""
    if limits is not None:
        given["body_mass"] = limits
    return made(given)


def _arrays(given: dict[str, Any]) -> dict[str, Any]:
    """Return numbers that may be arrays, taken out of those of a contact; its robot is any then."""
    supports = [f"{side}_{part}" for side in SUPPORTS for part in ("damping", "stiffness")]
    names = ("robot_mass", "body_mass", "area", "max_strain", *supports)
    found = {name: given.pop(name) for name in names if given.get(name) is not None}
    given["robot_mass"] = 1.0
    return found


def allowed_speeds(**given: Any) -> contact.AllowedSpeeds:
    limits, arrays = given.pop("limits", None), _arrays(given)
    return made(given).allowed_speeds(limits, **arrays, **given)


def batch(**given: Any) -> contact.ContactBatch:
    limits, speed, arrays = given.pop("limits", None), given.pop("closing_speed"), _arrays(given)
    return _of(given, limits).simulate_many(speed, **arrays, **given)


def probability(**given: Any) -> contact.Exceedance:
    limits, speed = given.pop("limits", None), given.pop("speed")
    masses = {name: given.pop(name) for name in ("robot_mass", "body_mass") if isinstance(given.get(name), dict)}
    given.setdefault("robot_mass", 1.0)
    return made(given).probability(speed, limits, **masses, **given)
