"""Separation distances and speeds against the checked cases."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as some

from hrsafety import standards

PRINTED = 5e-13  # relative; the cases are printed with 13 digits
EXACT = 1e-12  # relative


def test_distances_and_speeds_of_the_cases(shared: Path) -> None:
    cases = json.loads((shared / "spec" / "contact_cases.json").read_text(encoding="utf-8"))["separation"]
    assert len(cases) == 12
    for case in cases:
        rules = dict(case["input"])
        distance = standards.separation_distance(**rules)
        assert distance == pytest.approx(case["distance"], rel=EXACT)
        speed = rules.pop("robot_speed")
        assert standards.separation_speed(distance, **rules) == pytest.approx(speed, rel=EXACT)
        allowed = standards.separation_speed(case["at_distance"], **rules)
        assert allowed == pytest.approx(case["allowed_speed"], rel=PRINTED * 10, abs=1e-14)


def test_worked_example() -> None:
    rules = {"target_speed": 0.3, "human_speed": 1.6, "reaction_time": 0.1, "deceleration": 3.0}
    rules |= {"intrusion": 0.2, "uncertainty": 0.1}
    assert standards.separation_distance(1.5, **rules) == pytest.approx(1.61, rel=EXACT)
    assert standards.separation_speed(1.0, **rules) == pytest.approx(0.9106939, abs=5e-8)


@pytest.mark.filterwarnings("ignore::hrsafety.plausibility.HrsafetyWarning")  # far away, people who stand
@given(
    speed=some.floats(0.01, 5.0),
    share=some.floats(0.0, 0.95),
    human_speed=some.floats(0.0, 3.0),
    reaction_time=some.floats(0.0, 1.0),
    deceleration=some.floats(0.1, 20.0),
    intrusion=some.floats(0.0, 1.5),
    uncertainty=some.floats(0.0, 0.5),
)
def test_speed_of_the_distance_is_the_speed(speed: float, share: float, **rules: float) -> None:
    rules["target_speed"] = share * speed
    distance = standards.separation_distance(speed, **rules)
    back = standards.separation_speed(distance, **rules)
    # The distance carries half a unit in its last place, which a flat curve turns into more of the speed.
    slope = rules["reaction_time"] + (rules["human_speed"] + speed) / rules["deceleration"]
    assert back == pytest.approx(speed, rel=EXACT, abs=4e-16 * distance / slope)
    further = standards.separation_distance(1.01 * speed, **rules)
    assert further > distance
