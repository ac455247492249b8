"""Runs behind the follower's part of the page: every setting, every option, in many layouts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from hrsafety import reactive
from hrsafety.reactive import Follower, FollowerExperiment, FollowerLayouts, Sonar, VirtualImpedance
from hrsafety.reactive.follower.layouts import Kind

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


def _variant(
    *,
    sonar: Mapping[str, object] | None = None,
    robot: Mapping[str, object] | None = None,
    law: Mapping[str, object] | None = None,
    layouts: Mapping[str, object] | None = None,
    kinds: tuple[Kind, ...] = KINDS,
    laws: tuple[str, ...] = LAWS,
) -> Variant:
    follower = Follower(sonar=Sonar(**(sonar or {})), **(robot or {}))  # type: ignore[arg-type]  # named options
    return Variant(follower=follower, options=law or {}, layouts=layouts or {}, kinds=kinds, laws=laws)


def variants() -> dict[str, Variant]:
    """Return every change that is looked at, by its words."""
    dynamic, one, active = KINDS[1:], KINDS[1:2], LAWS[1:]
    return {
        "as specified": _variant(),
        "mirrored rear sensors": _variant(sonar={"rear": True}),
        "standoff 0.6 m": _variant(robot={"standoff": 0.6}, kinds=one),
        "standoff 1.2 m": _variant(robot={"standoff": 1.2}, kinds=one),
        "one ray per sensor": _variant(sonar={"rays": 1}),
        "virtual velocity reset every step": _variant(robot={"velocity_rule": "reset"}),
        "crossing at 0.15 to 0.25 m/s": _variant(layouts={"obstacle_speed": (0.15, 0.25)}, kinds=dynamic),
        "crossing at 0.25 to 0.35 m/s": _variant(layouts={"obstacle_speed": (0.25, 0.35)}, kinds=dynamic),
        "crossing at 0.35 to 0.5 m/s": _variant(layouts={"obstacle_speed": (0.35, 0.5)}, kinds=dynamic),
        "crossing at 0.5 to 0.8 m/s": _variant(layouts={"obstacle_speed": (0.5, 0.8)}, kinds=dynamic),
        "speed kept without echo": _variant(law={"outlives_gaps": True}),
        "norm of the rate instead of closing speed": _variant(law={"speed": "norm"}),
        "sources behind taken for ones in front": _variant(robot={"mirrored_fixes": True}),
        "sensors fired in turn": _variant(sonar={"firing": "in_turn"}),
        "with cross-talk": _variant(sonar={"firing": "cross_talk"}),
        "air at 25 C": _variant(sonar={"temperature": 25.0}),
        "boxes of 100 mm and 80 mm": _variant(layouts={"size_factor": 0.1}),
        "leader visible": _variant(layouts={"leader_size": (0.326, 0.352)}, kinds=dynamic),
        "(15) as printed": _variant(law={"rotation": "printed"}, kinds=dynamic, laws=active),
        "(16) as printed, start at (0, 0)": _variant(law={"world_start": (0.0, 0.0)}, kinds=one, laws=active),
        "(16) as printed, start at (-10, -10)": _variant(law={"world_start": (-10.0, -10.0)}, kinds=one, laws=active),
        "(16) as printed, start at (5, 5)": _variant(law={"world_start": (5.0, 5.0)}, kinds=one, laws=active),
        "(19-b) as printed": _variant(law={"form": "twice_scaled"}, laws=active),
        "(20) without its limit": _variant(law={"clamp": False}, laws=active),
    }


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
