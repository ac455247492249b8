"""Zones that are designed hold against attacks, those that are too small are broken, and the verdict says how much."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import zones
from hrsafety.errors import InfeasibleError, InvalidParameterError
from hrsafety.plausibility import unsafe_doubts
from hrsafety.zones.field_design import needed_zone
from hrsafety.zones.polygons import area, distance_outside, inside

SMALL = zones.Conditions(
    footprint=0.22,
    max_speed=0.5,
    max_turn_rate=1.0,
    deceleration=2.5,
    reaction_time=0.15,
    error=0.02,
    beam_step=math.radians(0.5),
    command_fall=2.5,
    turn_command_fall=3.2,
    turn_deceleration=2.5 / 0.22,
)
CART = zones.Conditions(
    footprint=[(0.6, 0.3), (0.6, -0.3), (-0.2, -0.3), (-0.2, 0.3)],
    max_speed=1.0,
    min_speed=-0.4,
    max_turn_rate=1.0,
    deceleration=1.0,
    reaction_time=0.3,
    error=0.03,
    beam_step=math.radians(0.25),
    command_fall=1.0,
    turn_command_fall=1.5,
    turn_deceleration=1.5,
    build_up=0.2,
    scanner=(0.4, 0.0),
)
OMNI = replace(SMALL, footprint=((0.3, 0.2), (0.3, -0.2), (-0.3, -0.2), (-0.3, 0.2)), holonomic=True, max_turn_rate=0.5)


def circle(radius: float, **given: Any) -> zones.CollisionMonitor:
    zone = zones.MonitorPolygon(name="Stop", type="circle", action="stop", radius=radius, **given)
    return zones.CollisionMonitor(polygons=(zone,), source_timeout=0.15)


# ---- design --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "given", [SMALL, CART, OMNI, replace(SMALL, command_fall=None)], ids=["small", "cart", "omni", "drop"]
)
def test_own_zones_hold_against_attacks(given: zones.Conditions) -> None:
    found = zones.check(zones.design(given, ranges=2).monitor(), given, attacks=200, generations=1, seed=7)
    assert (found.verdict, found.broken.count, found.searched_broken) == ("holds", 0, 0)
    assert not found.warnings
    assert all(each.missing == 0.0 for each in found.shapes)


def test_zones_that_are_not_much_larger_than_needed_are_broken_when_they_shrink() -> None:
    still = replace(SMALL, max_turn_rate=0.0, error=0.0)
    (zone,) = zones.design(still, ranges=1).zones
    smaller = zone.corners - 0.05 * zone.corners / np.linalg.norm(zone.corners, axis=1, keepdims=True)
    shape = zones.MonitorPolygon(name="Stop", type="polygon", action="stop", corners=smaller)
    found = zones.check(
        zones.CollisionMonitor(polygons=(shape,), source_timeout=0.1), still, attacks=300, generations=8
    )
    assert found.verdict == "broken"
    assert found.shapes[0].missing == pytest.approx(0.05, abs=0.01)


def test_a_zone_reaches_as_far_as_its_closed_form() -> None:
    straight = replace(SMALL, max_turn_rate=0.0)
    zone = zones.design(straight, ranges=1).zones[-1]
    stop = zones.stopping_travel(0.5, deceleration=2.5, reaction_time=0.15)
    front = 0.22 + stop.travel + 1.6 * stop.time + 0.02
    depth = zones.leg_depth(0.06, distance=front, beam_step=straight.beam_step, points=4)
    # The turn rate that rounding may add, the drift of falling commands, and 4 mm between samples come on top.
    assert front + depth <= zone.extents[0] < front + depth + 0.03
    for commands, all_sides in (
        (zones.CommandRange(0.0, 0.5, 0.0, 0.0), True),
        (zones.CommandRange(0.0, 0.5, 0.0, 0.0), False),
    ):
        needed = needed_zone(straight, commands, min_points=4, faults_only=not all_sides)
        assert needed is not None
        assert inside(needed[0], np.array([front]), np.array([0.0]))[0]


def test_zones_of_all_sides_hold_the_others() -> None:
    straight = replace(CART, max_turn_rate=0.0, min_speed=0.0)
    mine, others = (zones.design(straight, faults_only=each).zones for each in (True, False))
    for first, second in zip(mine, others, strict=True):
        assert distance_outside(second.corners, first.corners).max() < 0.1  # both are cut to 16 corners
        assert area(second.corners) > 1.2 * area(first.corners)


def test_slower_zones_come_first_and_cover_every_command() -> None:
    found = zones.design(CART, ranges=3, turn_ranges=3)
    speeds = [max(abs(each.commands.linear_min), abs(each.commands.linear_max)) for each in found.zones]
    assert speeds == sorted(speeds)
    assert found.monitor().doubts(reaction_time=0.3, limits=None) == ()
    for command in ([1.0, 0.0, 1.0], [-0.4, 0.0, -1.0], [0.0, 0.0, 0.0], [1.0000001, 0.0, 0.0]):
        assert not found.monitor().uncovered(command)
    assert found.source_timeout <= CART.reaction_time


def test_a_speed_beyond_sight_is_refused_with_one_that_holds() -> None:
    fast = replace(CART, max_speed=2.5, beam_step=math.radians(0.5))
    with pytest.raises(InfeasibleError, match=r"a leg is not seen.* a max_speed of (\d\.\d+) m/s holds") as caught:
        zones.design(fast)
    speed = float(str(caught.value).split("max_speed of ")[1].split()[0])
    assert zones.design(replace(fast, max_speed=speed - 0.02))


def test_a_scanner_that_does_not_see_beside_the_robot_is_refused() -> None:
    with pytest.raises(InvalidParameterError, match="min_range must be at most"):
        zones.design(replace(CART, min_range=0.5))


def test_the_file_says_the_same_zones(tmp_path: Path) -> None:
    found = zones.design(OMNI, ranges=2)
    path = tmp_path / "cm.yaml"
    path.write_text(found.yaml(), encoding="utf-8")
    again = zones.load_monitor(path)
    assert not again.warnings
    assert again.source_timeout == pytest.approx(found.source_timeout, rel=1e-3)
    for mine, read in zip(found.monitor().polygons[0].ranges, again.polygons[0].ranges, strict=True):
        assert np.array_equal(mine.corners, read.corners)
        assert (mine.name, mine.linear_max, mine.direction_start_angle) == (
            read.name,
            read.linear_max,
            read.direction_start_angle,
        )


# ---- verdict -------------------------------------------------------------------------------------

DEFAULT = {
    "footprint": 0.22,
    "deceleration": 2.5,
    "reaction_time": 0.15,
    "error": 0.02,
    "beam_step": math.radians(0.5),
    "max_turn_rate": 0.0,
}


def test_the_default_zone_holds_for_people_who_stand_up_to_its_speed() -> None:
    """The margin of 0.08 m allows 0.289 m/s; the beams of a round body and the error leave little more."""
    rules = {**DEFAULT, "person_speed": 0.0, "attacks": 60}
    slow = zones.check(circle(0.3), max_speed=0.285, generations=1, **rules)
    assert slow.shapes[0].standing_speed == pytest.approx(0.288796, abs=1e-6)
    assert (slow.verdict, [each.code for each in slow.warnings]) == ("holds", ["slow_person"])
    assert zones.check(circle(0.3), max_speed=0.4, generations=3, **rules).verdict == "broken"


def test_the_default_zone_holds_at_no_speed_for_people_who_walk() -> None:
    found = zones.check(circle(0.3), max_speed=0.1, attacks=300, generations=0, **DEFAULT)
    assert found.verdict == "broken"
    (shape,) = found.shapes
    assert shape.walking_speed == 0.0
    stop = zones.stopping_travel(0.1, deceleration=2.5, reaction_time=0.15)
    needed = stop.travel + 1.6 * stop.time + 0.02
    assert shape.missing_front == pytest.approx(needed - 0.08, abs=0.01)
    again = zones.replay(found.monitor, found.conditions, found.worst.genes)
    assert again.contact_speed == found.worst.contact_speed > zones.reach.TOWARD
    assert again.contact_time == found.worst.contact_time


def test_a_circle_as_large_as_needed_holds() -> None:
    found = zones.check(circle(0.3), max_speed=0.3, attacks=50, generations=0, **DEFAULT)
    needed = found.shapes[0].needed
    assert needed is not None
    mended = zones.check(
        circle(float(np.linalg.norm(needed, axis=1).max())), found.conditions, attacks=150, generations=1
    )
    assert mended.verdict == "holds"


def test_commands_without_a_zone_are_not_covered() -> None:
    zone = zones.design(SMALL).monitor().polygons[0]
    part = zones.CollisionMonitor(polygons=(replace(zone, ranges=zone.ranges[1:]),), source_timeout=0.1)
    found = zones.check(part, SMALL, attacks=20, generations=0)
    assert found.uncovered
    assert [each.code for each in found.warnings] == ["uncovered_velocity"]
    assert found.verdict in {"broken", "not_covered"}
    name, command = found.uncovered[0]
    assert part.uncovered(command) == (name,)


def test_what_is_not_told_is_doubted() -> None:
    found = zones.check(circle(3.0), attacks=20, generations=0, footprint=0.3)
    (doubt,) = found.warnings
    assert doubt.code == "assumed"
    assert "max_speed 0.5" in doubt.message
    assert not doubt.safe_side
    assert "footprint" not in doubt.subject


def test_brakes_of_turns_that_are_not_told_are_doubted() -> None:
    untold = replace(SMALL, turn_deceleration=None)
    designed = zones.design(untold, ranges=1)
    checked = zones.check(designed.monitor(), untold, attacks=20, generations=0)
    for found in (untold, designed, checked):
        (doubt,) = unsafe_doubts(found.warnings)
        assert (doubt.code, doubt.subject) == ("assumed", "turn_deceleration")
    assert replace(untold, max_turn_rate=0.0).warnings == ()


@pytest.mark.parametrize(
    ("given", "subjects"),
    [
        ({"person_speed": 0.05}, ["person_speed"]),
        ({"person_speed": 0.0}, ["person_speed"]),
        ({"person_speed": 1.59}, ["person_speed"]),
        ({"deceleration": 18.0}, ["deceleration"]),
        ({"turn_deceleration": 143.0}, ["turn_deceleration"]),
        (
            {"turn_deceleration": 45.0, "footprint": 0.6},
            ["deceleration of turns at the farthest point of the footprint"],
        ),
        ({"beam_step": math.radians(0.00436)}, ["beam_step"]),
        # Brakes of good small robots, fast walkers, and the finest scanners of floors are what they are.
        ({"person_speed": 2.5}, []),
        ({"deceleration": 8.0}, []),
        ({"turn_deceleration": 40.0}, []),
        ({"turn_deceleration": 6.0, "footprint": 1.2}, []),
        ({"beam_step": math.radians(0.014)}, []),
        ({"beam_step": math.radians(1.0)}, []),
    ],
)
def test_people_brakes_and_beams_that_are_hardly_meant_are_doubted(given: dict[str, Any], subjects: list[str]) -> None:
    conditions = replace(SMALL, **given)
    assert [each.subject for each in unsafe_doubts(conditions.warnings)] == subjects
    if "footprint" not in given and "beam_step" not in given:
        found = zones.check(circle(3.0), conditions, attacks=5, generations=0)
        assert set(conditions.warnings) <= set(found.warnings)
        assert set(conditions.warnings) <= set(zones.design(conditions, ranges=1).warnings)


@pytest.mark.parametrize("reaction", [1e-9, 0.0002, 0.0019, 20.1, 150.0, 1e12])
def test_reactions_that_no_attack_can_follow_are_refused_at_once(reaction: float) -> None:
    given = replace(SMALL, reaction_time=reaction)
    genes = np.full((1, len(zones.GENES)), 0.5)
    for call in (
        lambda: zones.check(circle(1.0), given),
        lambda: zones.attack(circle(1.0), given, genes),
        lambda: zones.replay(circle(1.0), given, genes[0]),
    ):
        with pytest.raises(InvalidParameterError, match=r"reaction_time must be 0\.002 to 20 s .*ms"):
            call()


@pytest.mark.parametrize("reaction", [0.002, 20.0])
def test_reactions_at_the_ends_are_attacked(reaction: float) -> None:
    zones.attack(circle(0.3), replace(SMALL, reaction_time=reaction), np.full((1, len(zones.GENES)), 0.5))


def test_a_monitor_of_approach_alone_touches_who_walks() -> None:
    zone = zones.MonitorPolygon(
        name="Feet", type="circle", action="approach", radius=0.22, min_points=3, time_before_collision=2.0
    )
    found = zones.check(zones.CollisionMonitor(polygons=(zone,), source_timeout=0.1), SMALL, attacks=100, generations=0)
    assert found.verdict == "broken"
    assert not found.shapes


def test_the_same_seed_gives_the_same_attacks() -> None:
    first, second = (zones.check(circle(0.5), SMALL, attacks=60, generations=1, seed=3) for _ in range(2))
    assert first.worst.genes == second.worst.genes
    assert first.broken == second.broken


def test_a_mended_file_keeps_its_comments_and_holds(tmp_path: Path, shared: Path) -> None:
    path = shared / "data" / "formats" / "cfg_collision_monitor.yaml"
    rules = {"footprint": 0.22, "max_speed": 0.5, "max_turn_rate": 1.0, "deceleration": 2.5, "reaction_time": 0.3}
    rules |= {"error": 0.01, "beam_step": math.radians(0.25)}
    found = zones.check(path, attacks=40, generations=0, **rules)
    assert found.verdict == "broken"
    document = zones.mended(path, found)
    assert "source_timeout: 0.3   # a comment that a round trip keeps" in document.text
    before, after = path.read_text(encoding="utf-8").splitlines(), document.text.splitlines()
    changed = [old for old, new in zip(before, after, strict=True) if old != new]
    assert all("points:" in each or "source_timeout" in each or each.endswith("radius: 1.0") for each in changed)
    place = tmp_path / "mended.yaml"
    document.write(place)
    again = zones.check(place, attacks=60, generations=0, **rules)
    assert (again.verdict, again.broken.count) == ("holds", 0)
    assert all(each.missing == 0.0 for each in again.shapes)


@pytest.mark.parametrize(
    ("change", "argument"),
    [
        ({"min_speed": 0.1}, "min_speed"),
        ({"holonomic": True, "min_speed": -0.1}, "min_speed"),
        ({"reaction_time": 0.1, "scan_period": 0.1, "command_period": 0.05}, "reaction_time"),
        ({"beam_step": 1.5}, "beam_step"),
        ({"footprint": -0.1}, "footprint"),
        ({"footprint": [(0.0, 0.0), (1.0, 0.0), (0.2, 0.2), (0.0, 1.0)]}, "footprint"),
        ({"max_range": 0.0}, "max_range"),
        ({"deceleration": math.nan}, "deceleration"),
        ({"command_fall": 0.0}, "command_fall"),
    ],
)
def test_conditions_that_cannot_be_are_refused(change: dict[str, Any], argument: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        replace(SMALL, **change)
    assert caught.value.argument == argument


def test_implausible_conditions_are_doubted() -> None:
    assert [each.subject for each in replace(SMALL, reaction_time=150.0).warnings] == ["reaction_time"]
    # A leg that is thicker than any is seen sooner, and by more beams.
    assert [each.subject for each in replace(SMALL, leg_radius=0.3).warnings] == ["leg_radius"]
