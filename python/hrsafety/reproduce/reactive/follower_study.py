"""Runs behind the follower's part of the page: every setting, every option, in many layouts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from hrsafety import reactive
from hrsafety._records import dataclass
from hrsafety.reactive import Follower, FollowerExperiment, FollowerLayouts, Sonar, VirtualImpedance
from hrsafety.reactive.follower.layouts import Kind
from hrsafety.reproduce import data

__all__ = ["KINDS", "LAWS", "SETTINGS", "FollowerStudy", "Variant", "run_study", "variants"]

KINDS: tuple[Kind, ...] = ("static", "one_dynamic", "two_dynamic")
SETTINGS = {"static": "two standing boxes", "one_dynamic": "one moving box", "two_dynamic": "two moving boxes"}
LAWS = ("conventional", "active")
LAYOUTS = 1000
BASE_LAYOUTS = 6000  # without any change: the rates that are compared with other evaluations
STATIC_LIMIT = 0.6  # mu_0 of experiment 2, in m/s

Found = Mapping[tuple[str, str], FollowerExperiment]


@dataclass(frozen=True, kw_only=True, slots=True)
class Variant:
    """One change of robot, law or layouts.

    Attributes
    ----------
    follower : Follower
        The robot.
    options : dict
        Options of the law.
    layouts : dict
        Options of the layouts.
    kinds : tuple of str
        Settings that it is run in.
    laws : tuple of str
        Laws that it is run with.
    """

    follower: Follower
    options: Mapping[str, object]
    layouts: Mapping[str, object]
    kinds: tuple[Kind, ...]
    laws: tuple[str, ...]


def variants() -> dict[str, Variant]:
    """Return every change that is examined, by its words."""
    return {entry["name"]: _variant(entry) for entry in data.table("follower")["variant"]}


def _variant(entry: Mapping[str, Any]) -> Variant:
    sonar, robot, law, layouts = (_options(entry.get(key, {})) for key in ("sonar", "robot", "law", "layouts"))
    return Variant(
        follower=Follower(sonar=Sonar(**sonar), **robot),
        options=law,
        layouts=layouts,
        kinds=tuple(entry.get("kinds", KINDS)),
        laws=tuple(entry.get("laws", LAWS)),
    )


def _options(given: Mapping[str, Any]) -> dict[str, Any]:
    return {key: tuple(value) if isinstance(value, list) else value for key, value in given.items()}


@dataclass(frozen=True, kw_only=True, slots=True)
class FollowerStudy:
    """All runs.

    Attributes
    ----------
    found : dict of str to dict
        By variant, then by setting and law.
    """

    found: Mapping[str, Found]

    @property
    def base(self) -> Found:
        """Runs without any change."""
        return self.found["as specified"]


def run_study(
    say: Callable[[str], object] | None = None, *, layouts: int = LAYOUTS, base_layouts: int = BASE_LAYOUTS
) -> FollowerStudy:
    """Run every variant."""
    found: dict[str, Found] = {}
    for name, variant in variants().items():
        if say is not None:
            say(f"follower: {name}")
        number = layouts if found else base_layouts
        found[name] = {(kind, law): _run(variant, kind, law, number) for kind in variant.kinds for law in variant.laws}
    return FollowerStudy(found=found)


def _run(variant: Variant, kind: str, law: str, layouts: int) -> FollowerExperiment:
    options: dict[str, object] = {"form": law}
    if kind == "static":
        options["speed_limit"] = STATIC_LIMIT
    options |= variant.options
    drawn = FollowerLayouts(kind=kind, **variant.layouts)  # type: ignore[arg-type]  # named options
    repulsion = VirtualImpedance(**options)  # type: ignore[arg-type]  # named options
    return reactive.experiment(drawn, repulsion, layouts=layouts, follower=variant.follower)
