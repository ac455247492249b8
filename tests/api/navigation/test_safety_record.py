"""Decisions of the parts around a law, with the plans behind them, and their pictures."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from hrsafety import InvalidParameterError, plotting
from hrsafety import navigation as nav
from hrsafety.navigation.laws import SafeNavigation, Shield, Yielding
from hrsafety.navigation.maps import Guide, StaticMap
from hrsafety.navigation.metrics import SafetyRecord, record_safety

ROBOT = nav.HolonomicRobot(max_acceleration=0.8)
WALLS = StaticMap.from_polylines([[(1.0, 1.5), (3.0, 1.5), (3.0, -0.6)]])
SCENE = nav.Scenario(
    robot=ROBOT,
    start=(0.0, 0.0),
    goal=(5.0, 0.8),
    obstacles=[
        nav.Human(start=(5.2, -2.6), velocity=(-0.5, 0.3)),
        nav.MovingRectangle(center=(4.4, 3.2), velocity=(0.0, -0.35), stop=(4.4, 2.2), length=0.9, width=0.5),
        nav.Rectangle(center=(0.5, -2.5), length=1.0, width=0.4),
        nav.Disc(center=(5.5, -3.0), radius=0.2),
    ],
    time_limit=40.0,
)
SHIELD = Shield(person_speed=0.9, latency=0.05, position_error=0.01)
GUIDE = Guide(box=((-1.0, -4.0), (6.5, 3.5)))
LAW = SafeNavigation(nav.VirtualForceField(), map=WALLS, guide=GUIDE, shield=SHIELD, yielding=Yielding())


@pytest.fixture(scope="module")
def record() -> SafetyRecord:
    return record_safety(SCENE, LAW)


def test_the_run_is_that_of_simulate(record: SafetyRecord) -> None:
    run = nav.simulate(SCENE, LAW)
    np.testing.assert_array_equal(record.trajectory.position, run.position)
    assert record.trajectory.outcome == run.outcome == "arrived"
    every = round(SCENE.control_period / 0.01)
    places = [each.position for each in record.decisions]
    np.testing.assert_array_equal(places, run.position[:-1:every][: len(places)])
    assert record.law is LAW


def test_what_is_commanded_is_verified_unless_it_brakes(record: SafetyRecord) -> None:
    assert {each.status for each in record.decisions} >= {"kept", "changed"}
    for each in record.decisions:
        if each.status != "braking":
            assert each.margin > 0.0
        if each.status == "kept":  # as far as the robot can take it up
            change, whole = each.command - each.velocity, each.wanted - each.velocity
            assert np.hypot(*change) <= min(0.8 * 0.06, np.hypot(*whole)) + 1e-9
            assert abs(change[0] * whole[1] - change[1] * whole[0]) < 1e-9
    assert sum(record.shares.values()) == pytest.approx(1.0)
    assert repr(record).startswith(f"SafetyRecord({len(record.decisions)} decisions: ")


def test_margin_and_plan_are_those_of_the_shield() -> None:
    """With discs alone `Shield.decide` tells the gap of a command, and the way to rest has a closed form."""
    people = [nav.Human(start=(2.5, -2.0), velocity=(-0.2, 0.8), max_speed=0.9)]
    scene = nav.Scenario(robot=ROBOT, start=(0.0, 0.0), goal=(5.0, 0.0), obstacles=people)
    period, change = scene.control_period, 0.8 * scene.control_period
    for each in record_safety(scene, SafeNavigation(nav.Khatib(), shield=SHIELD)).decisions[::5]:
        same = SHIELD.decide(
            each.command,
            velocity=each.velocity,
            position=each.position,
            people=each.obstacle_position,
            max_acceleration=0.8,
        )
        if each.status != "braking":
            np.testing.assert_allclose(same.velocity, each.command, atol=1e-12)
            assert same.gap == pytest.approx(each.margin, abs=1e-6)
        speed = math.hypot(*each.command)
        periods = max(math.ceil(speed / change - 1e-9), 0)
        assert each.plan_time[-1] == pytest.approx((1 + periods) * period)
        way = 0.5 * period * (each.velocity + each.command) + 0.5 * periods * period * each.command
        np.testing.assert_allclose(each.plan_position[-1], each.position + way, atol=1e-12)
        np.testing.assert_array_equal(each.plan_position[0], each.position)
        assert each.obstacle_reach[0] == pytest.approx(0.01 + 0.9 * (0.05 + each.plan_time[-1]))


def test_a_rectangle_counts_by_its_outline(record: SafetyRecord) -> None:
    """The margin is not that of the disc around it: it may not be smaller than a bound from outside, nor larger."""
    alone = nav.Scenario(
        robot=ROBOT,
        start=(0.0, 0.0),
        goal=(5.0, 0.0),
        obstacles=[nav.MovingRectangle(center=(3.0, 2.0), velocity=(0.0, -0.1), length=0.9, width=0.5)],
    )
    first = record_safety(alone, SafeNavigation(nav.Khatib(), shield=SHIELD)).decisions[0]
    (x, y), rest = np.array([3.0, 2.0]) - [0.45, 0.25], first.plan_time[-1]
    reach = 0.01 + 0.9 * (0.05 + rest)
    assert first.margin == pytest.approx(math.hypot(x, y) - 0.2 - 0.005 - reach, abs=0.05)
    assert record.decisions[0].obstacle_reach[2:].tolist() == [0.0, 0.0]


def test_the_guide_is_told_of(record: SafetyRecord) -> None:
    first = record.decisions[0]
    np.testing.assert_allclose(first.path[0], SCENE.start)
    np.testing.assert_allclose(first.path[-1], SCENE.goal)
    assert first.local_goal is not None
    without = record_safety(SCENE, SafeNavigation(nav.VirtualForceField(), yielding=Yielding())).decisions[0]
    assert without.path.shape == (0, 2)
    assert math.isnan(without.margin)


def test_what_has_no_decisions_is_refused() -> None:
    with pytest.raises(InvalidParameterError, match="law must be a SafeNavigation"):
        record_safety(SCENE, nav.VirtualForceField())  # type: ignore[arg-type]  # what is tested
    wheels = nav.Scenario(robot=nav.DifferentialDriveRobot(), start=(0, 0), goal=(5, 0))
    with pytest.raises(InvalidParameterError, match="robot must be a HolonomicRobot"):
        record_safety(wheels, LAW)


def test_pictures_show_the_verdict_at_a_time(record: SafetyRecord, tmp_path: Path) -> None:
    changed = next(each for each in record.decisions if each.status == "changed")
    figure = plotting.runs.safety_decision(record, changed.time + 0.01, title="One decision")
    (words,) = [each.get_text() for each in figure.axes[0].texts]
    assert words.startswith(f"{changed.time:.2f} s: changed, margin {changed.margin:.2f} m")
    labels = {each.get_text() for each in figure.legends[0].get_texts()}
    assert labels >= {"path of the guide", "local goal", "until rest: changed", "reach of others by then"}
    assert record.at(changed.time) is changed
    for time in (-0.1, float(record.trajectory.time[-1]) + 0.1):
        with pytest.raises(InvalidParameterError, match="time must be from 0 to the end of the run"):
            plotting.runs.safety_decision(record, time)
    seen: list[tuple[int, int]] = []
    file = tmp_path / "decisions.gif"
    plotting.runs.animate_safety(
        record, file, frames_per_second=1, progress=lambda done, total: seen.append((done, total))
    )
    assert file.stat().st_size > 1000
    assert seen[-1] == (len(seen), len(seen))
