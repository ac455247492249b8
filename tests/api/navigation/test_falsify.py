"""The search for a person against whom a law breaks a property."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.laws import SafeNavigation, Shield
from hrsafety.navigation.maps import StaticMap
from hrsafety.navigation.metrics import Pursuit, falsify

SCENE = nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), time_limit=10.0)
ORCA = nav.OptimalReciprocalCollisionAvoidance(horizon=2.0, margin=0.0)


def test_orca_is_at_fault_and_not_behind_a_shield() -> None:
    assert falsify(SCENE, ORCA, episodes=150, seed=2).broken
    guarded = falsify(SCENE, SafeNavigation(ORCA, shield=Shield()), episodes=150, seed=2)
    assert not guarded.broken
    assert guarded.share.value == 0.0


def test_a_shield_that_assumes_slow_people_breaks() -> None:
    law = SafeNavigation(ORCA, shield=Shield(person_speed=0.3))
    assert falsify(SCENE, law, episodes=200, seed=2).broken


def test_the_worst_episode_is_that_of_the_least_margin() -> None:
    found = falsify(SCENE, ORCA, episodes=60, seed=5)
    assert found.worst.least_toward == pytest.approx(found.margin.min(), abs=1e-12)
    speeds = np.linalg.norm(np.diff(found.worst.person_position, axis=0), axis=1) / np.diff(found.worst.time)
    assert speeds.max() <= 1.6 * (1 + 1e-9)


def test_threads_change_no_bit() -> None:
    one = falsify(SCENE, ORCA, episodes=24, seed=9, threads=1)
    two = falsify(SCENE, ORCA, episodes=24, seed=9, threads=2)
    assert np.array_equal(one.margin, two.margin)


def test_other_properties() -> None:
    assert falsify(SCENE, ORCA, "clearance", least=0.5, episodes=40).broken
    assert not falsify(SCENE, ORCA, "speed", episodes=10).broken
    assert falsify(SCENE, ORCA, "speed", most=0.3, episodes=10).broken
    assert not falsify(SCENE, SafeNavigation(ORCA, shield=Shield()), "arrival", episodes=5, person_speed=0.05).broken


def test_a_property_of_your_own() -> None:
    def never_backwards(pursuit: Pursuit) -> float:
        return float(pursuit.velocity[:, 0].min()) + 1e-9

    told: list[tuple[int, int]] = []
    found = falsify(SCENE, ORCA, never_backwards, episodes=10, progress=lambda *done: told.append(done))
    assert found.property_name == "own"
    assert len(found.margin) == len(found.min_clearance) == 10
    assert told[-1] == (10, 10)


def test_sensors_tell_of_the_person_as_in_a_run() -> None:
    law = SafeNavigation(ORCA, shield=Shield())
    blind = nav.robots.AsBuilt(sensors=[nav.sensing.Lidar(sees_obstacles=False)])
    assert falsify(SCENE, law, episodes=60, seed=2, built=blind).broken
    camera = nav.robots.AsBuilt(obstacle_vision=nav.sensing.Vision(delay=0.5))
    exact = falsify(SCENE, ORCA, episodes=20, seed=2)
    late = falsify(SCENE, ORCA, episodes=20, seed=2, built=camera)
    assert not np.array_equal(exact.margin, late.margin)


def test_the_own_place_is_measured_as_in_a_run() -> None:
    def found(of: str) -> object:
        measured = replace(SCENE, measurement=nav.Measurement(scale=0.05, latency=0.2, of=of))
        return falsify(measured, ORCA, episodes=20, seed=2).margin

    assert not np.array_equal(found("robot"), falsify(SCENE, ORCA, episodes=20, seed=2).margin)
    assert not np.array_equal(found("both"), found("obstacles"))


def test_every_episode_has_its_clearance_and_arrival() -> None:
    found = falsify(SCENE, SafeNavigation(ORCA, shield=Shield()), episodes=30, seed=2)
    arrived = ~np.isnan(found.arrival_time)
    assert 0 < arrived.sum() < 30
    assert np.array_equal(found.arrival_time[arrived], found.end_time[arrived])
    assert found.min_clearance.min() == found.min_clearance[np.argmin(found.min_clearance)] < found.margin.min()


def test_results_carry_the_warnings_of_a_run() -> None:
    found = falsify(SCENE, SafeNavigation(ORCA, shield=Shield(person_speed=1.0)), episodes=2, person_speed=1.6)
    assert "shield_assumes_less" in {each.code for each in found.warnings}


def test_every_contact_with_a_map_is_at_fault() -> None:
    def straight(situation: nav.Situation) -> object:
        return 20.0 * (situation.goal - situation.position) - 8.0 * situation.velocity

    walls = StaticMap.from_polylines([[(1.0, -1.0), (1.0, 1.0)]])
    found = falsify(SCENE, SafeNavigation(straight, map=walls), episodes=2, threads=1)
    assert (found.margin < 0.0).all()
    assert (found.min_clearance <= found.margin).all()


def test_a_margin_that_is_no_number_counts_for_nothing() -> None:
    with pytest.raises(InvalidParameterError, match="margin of the property in episode 0"):
        falsify(SCENE, ORCA, lambda _: float("nan"), episodes=3)
    with pytest.raises(InvalidParameterError, match="least"):
        falsify(SCENE, ORCA, "clearance", least=float("nan"), episodes=3)


def test_cma_es_finds_a_fault() -> None:
    assert falsify(SCENE, ORCA, method="cma_es", episodes=80, seed=1).broken


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"property": "safety"}, "property"),
        ({"method": "grid"}, "method"),
        ({"episodes": 0}, "episodes"),
        ({"person_speed": 0.0}, "person_speed"),
        ({"person_radius": -0.1}, "person_radius"),
        ({"property": lambda _: 1.0, "method": "cma_es"}, "method"),
    ],
)
def test_bad_calls(changes: dict[str, object], name: str) -> None:
    with pytest.raises(InvalidParameterError, match=name):
        falsify(SCENE, ORCA, **changes)


def test_a_person_who_turns_faster_than_a_shield_assumes_is_told() -> None:
    scene = nav.Scenario(start=(0, 0), goal=(6, 0), time_limit=12.0)

    def subjects(velocity_error: float) -> list[str]:
        shield = nav.Shield(velocity_error=velocity_error, person_acceleration=0.0)
        law = nav.SafeNavigation(nav.VirtualForceField(), shield=shield)
        return [each.subject for each in nav.falsify(scene, law, episodes=2).warnings]

    assert subjects(0.5) == ["shield.velocity_error"]
    assert subjects(3.2) == []
