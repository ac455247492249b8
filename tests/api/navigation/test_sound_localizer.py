"""A robot that follows a sound in any scenario and world: where it goes, and what it refuses."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hrsafety import InvalidParameterError
from hrsafety import navigation as nav

EXACT = nav.sensing.SoundLocalizer(carrier=0, noise_scale=0.0, burst_interval=0.1)
LEADER = nav.Person(start=(1.5, 0.0), route=[(6.0, 3.0)], desired_speed=0.5)


def world(*sensors: nav.sensing.RobotSensor, **options: object) -> nav.World:
    body = options.pop("body", nav.HolonomicRobot())
    robot = nav.Robot(body, start=(0, 0), goal=(9, 9), sensors=sensors, **options)  # type: ignore[arg-type]
    return nav.World(people=[LEADER], robots=[robot], time_limit=25.0)


@pytest.mark.parametrize("body", [nav.HolonomicRobot(), nav.DifferentialDriveRobot()])
@pytest.mark.parametrize("law", [nav.laws.VirtualImpedanceLaw(reach=0.3), nav.VirtualForceField(side_hysteresis=3.05)])
def test_a_robot_ends_at_the_standoff_from_who_carries_the_sound(body: object, law: nav.Law) -> None:
    run = nav.simulate(world(EXACT, body=body, law=law))
    apart = math.dist(run.position[-1], (6.0, 3.0))
    assert run.min_clearance.min() > 0.0
    # A law that keeps off people stays farther away than the standoff, but not where its own goal is.
    assert 0.85 < apart < 1.8
    assert run.sensing.obstacles == ("exact",)


def test_without_the_sound_it_goes_to_its_own_goal() -> None:
    followed, alone = (nav.simulate(world(*sensors, law=nav.laws.VirtualImpedanceLaw())) for sensors in ([EXACT], []))
    assert math.dist(alone.position[-1], (9.0, 9.0)) < 0.5 < math.dist(followed.position[-1], (9.0, 9.0))


def test_a_shield_around_the_law_follows_too() -> None:
    safe = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield())
    run = nav.simulate(world(EXACT, law=safe))
    assert run.min_clearance.min() > 0.0
    assert math.dist(run.position[-1], (6.0, 3.0)) < 1.8
    assert not [each for each in run.warnings if each.code == "shield_sees_less"]


def test_a_scenario_with_a_carrier_follows_and_nobody_else_is_asked() -> None:
    leader = nav.Human(start=(1.5, 0.0), velocity=(0.4, 0.0), stop=(4.0, 0.0), radius=0.3)
    far = nav.Disc(center=(20.0, 20.0), radius=0.3)
    scene = nav.Scenario(start=(0, 0), goal=(0, 8), obstacles=[leader, far], time_limit=15.0)
    built = nav.robots.AsBuilt(sensors=[EXACT])
    run = nav.simulate(scene, nav.laws.VirtualImpedanceLaw(reach=0.3), built=built)
    assert 2.0 < run.position[-1, 0] < 4.0
    assert abs(run.position[-1, 1]) < 0.5


def test_scatter_is_that_of_the_seed_and_grows_with_its_factor() -> None:
    noisy = nav.sensing.SoundLocalizer(carrier=0, noise_scale=1.0, burst_interval=0.1)
    law = nav.laws.VirtualImpedanceLaw()
    first, again, exact = (nav.simulate(world(each, law=law)) for each in (noisy, noisy, EXACT))
    assert first.position.tobytes() == again.position.tobytes() != exact.position.tobytes()


def test_a_stepped_run_is_the_whole_run() -> None:
    place = world(EXACT, law=nav.laws.VirtualImpedanceLaw())
    stepped = nav.Run(place)
    while not stepped.finished:
        stepped.step()
    assert np.array_equal(stepped.trajectory.position, nav.simulate(place).position)


@pytest.mark.parametrize("law", [nav.RapidlyExploringRandomTree(), nav.FieldDStar()])
def test_a_law_that_plans_its_whole_way_is_refused(law: nav.Law) -> None:
    with pytest.raises(InvalidParameterError, match="law must head for a goal that moves"):
        nav.simulate(world(EXACT, law=law))


def test_bad_options_are_refused_by_name() -> None:
    for name, value in {"carrier": -1, "standoff": -0.1, "noise_scale": math.nan}.items():
        with pytest.raises(InvalidParameterError, match=name):
            nav.sensing.SoundLocalizer(**{"carrier": 0, name: value})  # type: ignore[arg-type]
    with pytest.raises(InvalidParameterError, match="burst_interval must be finite and positive"):
        nav.sensing.SoundLocalizer(carrier=0, burst_interval=0.0)
    with pytest.raises(InvalidParameterError, match="carrier must be the index"):
        nav.simulate(world(nav.sensing.SoundLocalizer(carrier=7), law=nav.laws.VirtualImpedanceLaw()))
