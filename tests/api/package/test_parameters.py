"""Parameter classes behave like values."""

from __future__ import annotations

import copy
import dataclasses
import math
import pickle
from typing import Any

import numpy as np
import pytest

from api.namespaces import public
from hrsafety import impact
from hrsafety import navigation as nav

VALUES: list[tuple[Any, dict[str, Any]]] = [
    (nav.HolonomicRobot(), {"mass": 5.0}),
    (nav.DifferentialDriveRobot(), {"radius": 0.3}),
    (nav.VirtualForceField(stabilizing="capped", stabilizing_force_cap=10.0), {"gain_ratio": 0.3}),
    (nav.Measurement(scale=0.004, distribution="gaussian", of="both"), {"of": "robot"}),
    (nav.Disc(center=(2.45, 0.595), radius=0.1), {"radius": 0.2}),
    (nav.Rectangle(center=(2.3, 0.0), length=1.4, width=0.6, heading=0.3), {"heading": 0.4}),
    (nav.MovingDisc(center=(3.0, 4.0), radius=0.2, velocity=(0.0, -0.5), stop=(3.0, 0.0)), {"stop": None}),
    (nav.MovingDisc.from_path([0.0, 0.4], [[0.0, 0.0], [0.1, 0.0]], radius=0.2), {"radius": 0.3}),
    (nav.MovingRectangle(center=(3.0, 4.0), length=1.2, width=0.8, velocity=(0.0, -0.5)), {"heading": 0.4}),
    (nav.MovingRectangle.from_path([0.0, 0.4], [[0, 0], [0.1, 0]], length=1.2, width=0.8), {"width": 0.3}),
    (nav.Human(start=(0.6, 0.6), velocity=(1.0, 0.0), stop=(4.0, 0.6)), {"max_speed": 1.5}),
    (nav.Human.from_path([0.0, 0.4], [[0.0, 0.0], [0.5, 0.1]]), {"radius": 0.3}),
    (
        nav.Human.from_segments((0.6, 0.0), [(1.0, (1.0, 0.0), (0.0, 0.0))]),
        {"active_radius": 3.0, "critical_radius": 1.0},
    ),
    (
        nav.Scenario(
            start=(3.9, 0.6),
            goal=(0.0, 0.6),
            obstacles=[nav.Disc(center=(2.45, 0.595), radius=0.1), nav.Human(start=(0.6, 0.6), velocity=(0.0, 1.0))],
            measurement=nav.Measurement(),
            seed=2**64 - 1,
        ),
        {"seed": 1},
    ),
    (
        impact.Joint(
            inertia=0.059,
            mechanical_stiffness=1216.8,
            mechanical_damping=0.3,
            control_stiffness=121.68,
            control_damping=1.521,
        ),
        {"inertia": 0.06},
    ),
    (impact.MANIPULATOR_1, {"mass": 10.0}),
    (impact.Head.minimum(), {"damping": 0.0}),
    (impact.FOAM_1, {"linear_range": 0.015}),
    (impact.joints.DirectDrive(proportional=448.7, derivative=5.579), {"voltage_limit": math.inf}),
    (impact.SetPoint.accelerating(5.0, duration=0.05), {"feed_forward": True}),
    (impact.FoamLimits(), {"peak_head_acceleration_g": 8.0}),
    (impact.joints.CylinderController(), {"derivative": 0.0}),
]

each_value = pytest.mark.parametrize(("value", "change"), VALUES, ids=[type(value).__name__ for value, _ in VALUES])


@each_value
def test_pickle_gives_an_equal_value(value: Any, change: dict[str, Any]) -> None:
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
        again = pickle.loads(pickle.dumps(value, protocol))
        assert again == value
        assert again is not value
        assert type(again) is type(value)
    assert pickle.loads(pickle.dumps(dataclasses.replace(value, **change))) != value


@each_value
def test_copy_gives_an_equal_value(value: Any, change: dict[str, Any]) -> None:
    assert copy.deepcopy(value) == value
    assert copy.copy(value) == value
    assert dataclasses.replace(value, **change) != value


@each_value
def test_equal_values_have_equal_hashes(value: Any, change: dict[str, Any]) -> None:
    other = dataclasses.replace(value, **change)
    assert hash(dataclasses.replace(value)) == hash(value)
    assert len({value, dataclasses.replace(value), other}) == 2


@each_value
def test_printed_form_builds_the_value_again(value: Any, change: dict[str, Any]) -> None:
    assert "_native" not in repr(value)
    changed = dataclasses.replace(value, **change)
    for each in (value, changed):
        assert eval(repr(each), {**public(impact), **public(nav), "inf": math.inf}) == each
    assert repr(changed) != repr(value)


@each_value
def test_value_cannot_be_changed(value: Any, change: dict[str, Any]) -> None:
    name, new = next(iter(change.items()))
    with pytest.raises(dataclasses.FrozenInstanceError):
        setattr(value, name, new)
    with pytest.raises(dataclasses.FrozenInstanceError):
        delattr(value, name)
    with pytest.raises((AttributeError, TypeError)):
        value.something_new = 1


def test_given_sequences_are_copied() -> None:
    place = [2.45, 0.595]
    disc = nav.Disc(center=place, radius=0.1)
    place[0] = 9.0
    assert disc.center == (2.45, 0.595)


def test_values_of_another_class_are_not_equal() -> None:
    assert nav.HolonomicRobot() != nav.DifferentialDriveRobot()
    assert nav.Disc(center=(0, 0), radius=0.1) != nav.MovingDisc(center=(0, 0), radius=0.1, velocity=(0, 0))


def test_numbers_of_any_kind_are_accepted() -> None:
    assert nav.HolonomicRobot(mass=np.float32(4.0)) == nav.HolonomicRobot(mass=4)
    assert nav.Disc(center=np.array([1, 2]), radius=np.float64(0.1)) == nav.Disc(center=(1.0, 2.0), radius=0.1)


def test_same_scenario_and_law_give_the_same_bits_after_a_pickle() -> None:
    (scene,) = (value for value, _ in VALUES if isinstance(value, nav.Scenario))
    law = nav.VirtualForceField()
    first = nav.simulate(scene, law)
    again = nav.simulate(*pickle.loads(pickle.dumps((scene, law))))
    assert first.position.tobytes() == again.position.tobytes()
