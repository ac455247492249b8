"""Ring, tables and shares of the skirt as the corrected source and another implementation give them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from hrsafety import reactive

BEARINGS = (150.0, 112.5, 67.5, 30.0, -7.5, -52.5, -90.0, -127.5, 187.5)
# A few roundings of an angle of some radians.
ROUNDING = 2e-15
# Half a unit of the last digit of a value with four, three or one decimals.
FOUR, THREE, ONE = 5e-5, 5e-4, 0.05

# Table 1 of the source: sensors 9 to 1, 0 for an obstacle; state 6 as corrected.
TABLE_1 = (
    ("000000000", "spin"),
    ("111111001", "S"),
    ("011111110", "E"),
    ("011111100", "SE"),
    ("111100111", "W"),
    ("111000111", "NW"),
    ("100011111", "N"),
    ("001111111", "NE"),
    ("111100011", "SW"),
    ("111111111", "keep"),
)
# Table 3: which direction a sensor that is triggered alone causes, sensors 1 to 9.
TABLE_3 = ("SE", "S", "S", "SW", "W", "NW", "N", "NE", "E")

# Another implementation, written without this one, made 4,000 tests of each kind.
OTHER_TESTS = 4000
# Thirteen shares are compared; among so many one is off by more than this in 3 of 100 cases.
STANDARD_ERRORS = 3.0
TABLE_4: dict[str, tuple[dict[str, Any], float, tuple[float | None, float | None, float]]] = {
    "ideal": ({}, 0.10, (0.966, 0.017, 0.017)),
    "best direction": ({"skirt": reactive.UltrasonicSkirt(policy="best_direction")}, 0.10, (0.966, 0.017, 0.017)),
    "low discs": ({"scene": reactive.SkirtScene(unseen_share=0.05)}, 0.20, (0.777, 0.147, 0.076)),
    "narrow beam": ({"skirt": reactive.UltrasonicSkirt(beam_width=math.radians(20.0))}, 0.10, (0.849, 0.059, 0.092)),
    "0.5 m/s": ({"motion": reactive.SkirtMotion(speed=0.5)}, 0.10, (0.284, None, 0.048)),
    "0.8 m/s": ({"motion": reactive.SkirtMotion(speed=0.8)}, 0.10, (0.001, None, 0.991)),
    "small discs": ({"scene": reactive.SkirtScene(disc_radius=(0.03, 0.15))}, 0.10, (0.879, 0.043, 0.077)),
}


def test_nine_sensors_stand_at_their_bearings_and_the_ring_closes() -> None:
    skirt = reactive.UltrasonicSkirt()
    assert np.allclose(skirt.bearings, np.radians(BEARINGS), rtol=0, atol=ROUNDING)
    assert np.degrees(skirt.gaps).round(9).tolist() == [37.5, 45.0, 37.5] * 3
    assert skirt.gaps.sum() == pytest.approx(2 * math.pi, abs=10 * ROUNDING)


def test_printed_spacing_does_not_close_the_ring() -> None:
    spacing = reactive.skirt.skirt_spacing()
    degrees = [math.degrees(gap) for gap in spacing[:3]]
    assert degrees == [pytest.approx(value, abs=ONE) for value in (37.5, 40.6, 43.7)]
    assert spacing.closing_correction == pytest.approx(0.939, abs=THREE)


def test_other_lengths_make_the_printed_spacing_fit() -> None:
    # a N L = 0.3888 m: by the length of a sensor, or by the radius on which the sensors lie.
    assert math.degrees(reactive.skirt.skirt_spacing(sensor_length=0.0635).printed_gap) == pytest.approx(37.5, abs=ONE)
    outside = reactive.skirt.skirt_spacing(sensor_radius=0.351, wheel_sensor_radius=0.351)
    assert math.degrees(outside.printed_gap) == pytest.approx(37.5, abs=ONE)
    assert outside.closing_correction * 9 * 0.046 == pytest.approx(
        2 * math.pi * (0.33 - 0.351 * 292.5 / 360), abs=1e-12
    )


def test_printed_equation_5_is_3_with_4() -> None:
    lengths = {"chassis_radius": 0.4, "sensor_radius": 0.37, "wheel_sensor_radius": 0.31, "sensor_length": 0.05}
    closed = reactive.skirt.skirt_spacing(9, correction=0.5, **lengths).printed_gap_closed
    again = reactive.skirt.skirt_spacing(9, wheel_gap=math.pi / 3 - closed, correction=0.5, **lengths).printed_gap
    assert again == pytest.approx(closed, abs=4e-15)


def test_safe_distance_follows_from_the_largest_gap() -> None:
    assert reactive.UltrasonicSkirt().meeting_distance == pytest.approx(0.6098, abs=FOUR)
    narrow = reactive.skirt.skirt_safe_distance(sensor_radius=0.33, gap=math.radians(37.5))
    assert narrow == pytest.approx(0.5276, abs=FOUR)
    # What the printed 0.666 m would need.
    outside = reactive.skirt.skirt_safe_distance(sensor_radius=0.3604, gap=math.radians(45.0))
    wider = reactive.skirt.skirt_safe_distance(sensor_radius=0.33, gap=math.radians(49.0))
    assert outside == pytest.approx(0.666, abs=THREE)
    assert wider == pytest.approx(0.666, abs=THREE)


def test_triggering_distances_are_consistent_unless_the_printed_ones_are_asked_for() -> None:
    assert reactive.UltrasonicSkirt().trigger_distances == pytest.approx([0.336] * 9, abs=1e-12)
    printed = reactive.UltrasonicSkirt(triggering="printed").trigger_distances
    assert printed == pytest.approx([1.002] * 4 + [0.319] + [0.336] * 4, abs=THREE)


def test_state_table_has_ten_of_512_patterns() -> None:
    assert [(state.pattern, state.action) for state in reactive.skirt.skirt_states()] == list(TABLE_1)
    skirt = reactive.UltrasonicSkirt(policy="table_only")
    listed = dict(TABLE_1)
    for bits in range(512):
        readings = np.where([bits >> sensor & 1 for sensor in range(9)], 3.0, 0.2)
        pattern = skirt.pattern(readings)
        assert pattern == format(bits, "09b")
        assert skirt.action(readings) == listed.get(pattern, "keep")


@pytest.mark.parametrize("policy", ["nearest", "best_direction"])
def test_one_sensor_alone_acts_as_in_table_3(policy: Any) -> None:
    skirt = reactive.UltrasonicSkirt(policy=policy)
    for sensor, expected in enumerate(TABLE_3):
        readings = np.full(9, 3.0)
        readings[sensor] = 0.2
        off = math.cos(reactive.skirt.MOTION_DIRECTIONS[skirt.action(readings)] - skirt.bearings[sensor])
        if policy == "nearest":
            assert skirt.action(readings) == expected
        else:
            # Away by more than 150 deg: eight directions leave gaps of up to 60 deg.
            assert off <= math.cos(math.radians(150.0)) + 1e-12


def test_motion_directions_are_those_of_table_3_with_a_mirrored_north_west() -> None:
    shares = {name: angle / math.pi for name, angle in reactive.skirt.MOTION_DIRECTIONS.items()}
    thirds = {"NW": 2 / 3, "NE": 1 / 3, "SW": 4 / 3, "SE": -1 / 3}
    assert shares == pytest.approx({"N": 0.5, "S": -0.5, "W": 1.0, "E": 0.0} | thirds, abs=ROUNDING)


@pytest.mark.parametrize("kind", TABLE_4)
def test_shares_agree_with_those_of_another_implementation(kind: str) -> None:
    changes, closely, expected = TABLE_4[kind]
    shares = reactive.skirt_test(layouts=100, **changes).shares(closely)
    for own, other in zip(shares, expected, strict=True):
        if other is None:
            continue
        variance = own.value * (1 - own.value) / own.runs + other * (1 - other) / OTHER_TESTS
        assert abs(own.value - other) < STANDARD_ERRORS * math.sqrt(variance), (own, other)


def test_state_table_alone_touches_in_nine_of_ten_tests() -> None:
    alone = reactive.skirt_test(reactive.UltrasonicSkirt(policy="table_only"), layouts=50)
    assert alone.shares().collides.low < 0.90 < alone.shares().collides.high
