"""The packages, their sub-namespaces, and all public names of both."""

from __future__ import annotations

from types import ModuleType
from typing import Any

from hrsafety import arms, contact, impact, io, plotting, reactive, standards, zones
from hrsafety import navigation as nav

BELOW = {
    nav: ("crowd", "gains", "laws", "maps", "metrics", "robots", "sensing", "tracking"),
    impact: ("criteria", "identification", "joints"),
    arms: (),
    standards: (),
    contact: (),
    io: (),
    zones: (),
    reactive: ("follower", "skirt", "sonar", "sound"),
    plotting: ("arms", "comparisons", "gains", "impacts", "reactive", "robots", "runs", "sweeps"),
}


def places(package: ModuleType) -> list[ModuleType]:
    """Return a package and its sub-namespaces."""
    return [package, *(getattr(package, name) for name in BELOW[package])]


def public(package: ModuleType) -> dict[str, Any]:
    """Return all public names of a package and its sub-namespaces with what they stand for."""
    found = {name: getattr(place, name) for place in places(package) for name in place.__all__}
    return {name: value for name, value in found.items() if not isinstance(value, ModuleType)}
