"""Arc rollouts as the law of a robot in scenarios and worlds, and what brings them their scans and poses."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError

ROBOT = nav.DifferentialDriveRobot(
    max_speed=1.0,
    max_turn_rate=3.0,
    max_acceleration=2.0,
    max_turn_acceleration=6.0,
    footprint=nav.robots.Footprint.rectangle(0.5, 0.4),
)
ROOM = nav.StaticMap(
    walls=[([(-1, -2), (7, -2), (7, 2), (-1, 2), (-1, -2)], 0.02), ([(3, -2), (3, 0.3)], 0.05)],
    discs=[(5.0, 0.5, 0.3)],
)
LIDAR = nav.Lidar(map=ROOM, beams=360)
PERIOD = 0.05


def scene(**changed: Any) -> nav.Scenario:
    given: dict[str, Any] = {"start": (0.0, 0.0), "goal": (6.0, -1.0), "control_period": PERIOD, "walls": ROOM}
    return nav.Scenario(**{"robot": ROBOT, **given, **changed})


def built(*sensors: nav.sensing.RobotSensor) -> nav.robots.AsBuilt:
    return nav.robots.AsBuilt(sensors=sensors or (LIDAR,))


def world(*people: nav.Person, **robot: Any) -> nav.World:
    own = nav.Robot(
        start=(0.0, 0.0),
        goal=(6.0, -1.0),
        body=ROBOT,
        law=nav.ArcRollouts(),
        sensors=[replace(LIDAR, map=None)],
        **robot,
    )
    return nav.World(robots=[own], people=people, walls=ROOM, step=PERIOD, time_limit=40.0)


def test_a_run_is_what_a_scan_controller_does_that_is_told_the_same() -> None:
    run = nav.simulate(scene(), nav.ArcRollouts(), built=built(), step=PERIOD / 20, stop_on_contact=True)
    assert run.outcome == "arrived"
    assert run.map_clearance > 0.02
    controller = nav.ScanController(
        nav.ArcRollouts(), ROBOT, (6.0, -1.0), lidars=[LIDAR], arrival_tolerance=scene().arrival_tolerance
    )
    along = np.einsum("ij,ij->i", run.velocity, np.stack([np.cos(run.heading), np.sin(run.heading)], axis=1))
    samples = range(0, len(run.time) - 20, 20)
    assert len(samples) > 100
    for row in samples:
        pose = run.position[row], float(run.heading[row])
        command = controller.update(float(run.time[row]), *pose, [LIDAR.scan(*pose)])
        assert command.off_plan is None
        assert command.speed == pytest.approx(along[row + 20], abs=1e-12)
        assert command.status != "braking"


def test_the_core_reads_and_gives_back_their_gains() -> None:
    law = nav.ArcRollouts(margin=0.04, beyond=1.0)
    assert law._native.gains == list(law.gains)
    assert law._native.gain_names == list(law.GAIN_NAMES)


def test_every_verb_takes_them() -> None:
    scenes = [scene(), scene(goal=(6.0, 1.5))]
    law = nav.ArcRollouts()
    table = nav.simulate_many(scenes, law, built=built())
    runs = [nav.simulate(each, law, built=built()) for each in scenes]
    assert table.outcome.tolist() == ["arrived", "arrived"]
    assert table.arrival_time.tolist() == [run.arrival_time for run in runs]
    score = nav.evaluate(scenes[0], law, built=built())
    assert score.trajectory.arrival_time == runs[0].arrival_time
    # Alone it sees nothing, and drives straight on.
    assert score.nominal.arrival_time < runs[0].arrival_time
    assert score.nominal.path_length == pytest.approx(math.dist((0, 0), (6, -1)) - 0.12, abs=0.1)
    wider = nav.ArcRollouts(margin=0.1)
    compared = nav.compare(scenes, {"near": law, "wide": wider}, built=built())
    assert [each.success.value for each in compared.standings()] == [1.0, 1.0]
    far = [nav.simulate(each, wider, built=built()).map_clearance for each in scenes]
    assert all(one > run.map_clearance for one, run in zip(far, runs, strict=True))
    assert not nav.evaluate(world(), None).trajectory.contact_at_fault.any()


@pytest.mark.parametrize("heading", [0.0, 2.0])
def test_a_disc_that_moves_in_any_direction_finds_its_way_too(heading: float) -> None:
    disc = nav.HolonomicRobot(radius=0.25, max_speed=1.0, max_acceleration=2.0)
    place, sensed = scene(robot=disc, heading=heading), replace(LIDAR, mounting=(0.1, 0.05, 0.4))
    run = nav.simulate(place, nav.ArcRollouts(), built=built(sensed))
    assert run.outcome == "arrived"
    assert run.map_clearance > 0.01
    assert (run.heading == heading).all()
    ahead = nav.simulate(scene(robot=disc), nav.ArcRollouts(), built=built(sensed))
    assert run.arrival_time < 1.3 * ahead.arrival_time
    # Acceleration along the course and across it stays within the limit, so that the plan is what is driven.
    assert np.hypot(*np.diff(run.velocity[:-1], axis=0).T).max() <= 2.0 * 0.01 + 1e-9


def test_in_a_world_lidars_see_its_walls() -> None:
    run = nav.simulate(world())
    assert run.outcome == "arrived"
    assert run.robots[0].map_clearance > 0.0
    assert "movers_unwatched" not in {warning.code for warning in run.warnings}


def test_people_are_seen_as_what_stands_and_the_run_says_so() -> None:
    person = nav.Person(start=(2.0, 0.0), velocity=(0.0, 0.0), route=[(2.0, 0.001)], desired_speed=0.01)
    run = nav.simulate(world(person))
    doubt = [warning for warning in run.warnings if warning.code == "movers_unwatched"]
    assert [warning.subject for warning in doubt] == ["robots[0].law"]
    assert run.outcome == "arrived"
    walker = nav.Human(start=(2.0, 1.0), velocity=(0.0, -0.2), stop=(2.0, -1.0))
    told = nav.simulate(scene(obstacles=[walker]), nav.ArcRollouts(), built=built()).warnings
    assert "movers_unwatched" in {warning.code for warning in told}
    stands = nav.simulate(scene(obstacles=[nav.Disc(center=(1.5, 0.0), radius=0.2)]), nav.ArcRollouts(), built=built())
    assert stands.outcome == "arrived"
    assert stands.min_clearance[0] > 0.02
    assert {"movers_unwatched", "below_safe_radius"}.isdisjoint(warning.code for warning in stands.warnings)


def test_plans_that_are_not_verified_are_doubted() -> None:
    run = nav.simulate(scene(), nav.ArcRollouts(verify=False), built=built())
    assert "not_verified" in {warning.code for warning in run.warnings}


@pytest.mark.parametrize(
    ("scenario", "law", "robot", "message"),
    [
        (scene(), nav.ArcRollouts(), None, "hold a Lidar"),
        (scene(), nav.ArcRollouts(), nav.robots.AsBuilt(sensors=[nav.sensing.Odometry()]), "hold a Lidar"),
        (
            scene(robot=nav.HolonomicRobot(footprint=nav.robots.Footprint.rectangle(0.5, 0.4))),
            nav.ArcRollouts(),
            built(),
            "have two wheels",
        ),
        (scene(), nav.ArcRollouts(map=nav.UnknownMap(reach=0.8)), built(), "until it stops"),
    ],
)
def test_what_they_cannot_drive_is_refused(
    scenario: nav.Scenario, law: nav.ArcRollouts, robot: nav.robots.AsBuilt | None, message: str
) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        nav.simulate(scenario, law, built=robot)


def test_parts_around_them_and_goals_that_move_are_refused() -> None:
    with pytest.raises(InvalidParameterError, match="by themselves"):
        nav.SafeNavigation(nav.ArcRollouts(), shield=nav.Shield())
    leader = nav.Human(start=(3.0, 1.0), velocity=(0.1, 0.0), stop=(4.0, 1.0))
    ears = built(LIDAR, nav.sensing.SoundLocalizer(carrier=0))
    with pytest.raises(InvalidParameterError, match="moves"):
        nav.simulate(scene(obstacles=[leader]), nav.ArcRollouts(), built=ears)


@pytest.mark.parametrize("seed", range(4))
def test_with_late_and_noisy_scans_and_drifting_odometry_it_touches_nothing(seed: int) -> None:
    lidar = replace(LIDAR, range_noise=0.01, dropout=0.05, latency=2 * PERIOD)
    odometry = nav.sensing.Odometry(length_error=0.01, heading_error=math.radians(0.5))
    run = nav.simulate(
        replace(scene(), seed=seed, arrival_tolerance=0.3), nav.ArcRollouts(), built=built(lidar, odometry)
    )
    assert run.outcome == "arrived"
    assert run.map_clearance > 0.0
    assert run.seen_position is not None
    off = np.hypot(*(run.seen_position - run.position).T)
    assert 0.01 < off.max() < 0.2
    same = nav.simulate(
        replace(scene(), seed=seed, arrival_tolerance=0.3), nav.ArcRollouts(), built=built(lidar, odometry)
    )
    assert (same.position == run.position).all()


def test_a_late_lidar_shows_other_laws_what_stood_where_the_robot_was() -> None:
    late, law = replace(LIDAR, latency=0.3), nav.VirtualForceField()
    start = scene(start=(2.65, -0.5), goal=(2.0, 1.5), robot=nav.HolonomicRobot(radius=0.2))
    now, then = (nav.simulate(start, law, built=built(each)) for each in (LIDAR, late))
    # Until the first scan has come nothing is seen: the wall 0.4 m beside the start acts later.
    assert (now.force[0] != then.force[0]).any()
    assert now.outcome == then.outcome == "arrived"
    with pytest.raises(InvalidParameterError, match="latency"):
        nav.Lidar(latency=6.0)
    with pytest.raises(InvalidParameterError, match="length_error"):
        nav.sensing.Odometry(length_error=-0.1)


def codes(run: nav.Trajectory) -> set[str]:
    return {warning.code for warning in run.warnings}


@pytest.mark.parametrize("law", [nav.ArcRollouts(), nav.VirtualForceField()], ids=["rollouts", "field"])
def test_obstacles_that_no_lidar_sees_are_doubted(law: nav.Law) -> None:
    thing = scene(walls=None, obstacles=[nav.Disc(center=(2.0, 0.0), radius=0.3)], goal=(4.0, 0.0))
    blind, seeing = nav.Lidar(sees_obstacles=False), nav.Lidar()
    assert "obstacles_unseen" in codes(nav.simulate(thing, law, built=built(blind)))
    assert "obstacles_unseen" not in codes(nav.simulate(thing, law, built=built(blind, seeing)))
    person = nav.Person(start=(2.0, 0.0))
    robot = nav.Robot(start=(0.0, 0.0), goal=(4.0, 0.0), body=ROBOT, law=law, sensors=[blind])
    assert "obstacles_unseen" in {each.code for each in nav.World(people=[person], robots=[robot]).warnings}


def test_a_robot_that_never_drives_is_told_why() -> None:
    late = nav.simulate(scene(), nav.ArcRollouts(), built=built(replace(LIDAR, latency=0.4)))
    assert (late.path_length, late.outcome) == (0.0, "stopped")
    (doubt,) = (warning for warning in late.warnings if warning.code == "scans_too_late")
    assert doubt.safe_side
    noisy = scene(measurement=nav.Measurement(scale=0.025, of="both"))
    assert "pose_off_plan" in codes(nav.simulate(noisy, nav.ArcRollouts(), built=built()))
    drifting = nav.simulate(scene(), nav.ArcRollouts(), built=built(LIDAR, nav.sensing.Odometry()))
    assert {"pose_off_plan", "scans_too_late"}.isdisjoint(codes(drifting))


def test_scans_that_would_wait_in_too_many_numbers_are_refused() -> None:
    many = nav.Lidar(map=ROOM, beams=100_000, latency=5.0)
    with pytest.raises(InvalidParameterError, match="latency must be so short"):
        nav.simulate(scene(control_period=0.02), nav.ArcRollouts(), built=built(many))


def test_what_its_plans_do_not_cover_is_doubted() -> None:
    noisy = replace(LIDAR, range_noise=0.05)
    assert "scans_too_noisy" in codes(nav.simulate(scene(), nav.ArcRollouts(), built=built(noisy)))
    assert "scans_too_noisy" not in codes(nav.simulate(scene(), nav.ArcRollouts(margin=0.06), built=built(noisy)))
    wheel = nav.robots.WheelDrive(
        inertia=0.06, viscous_friction=0.4, static_friction=0.05, proportional_gain=100.0, derivative_gain=20.0
    )
    lagging = nav.robots.AsBuilt(wheels=[wheel, wheel], sensors=[LIDAR])
    assert "wheels_lag" in codes(nav.simulate(scene(), nav.ArcRollouts(), built=lagging))


def test_a_pose_that_drifts_is_doubted_under_any_law() -> None:
    law = nav.SafeNavigation(nav.VirtualForceField(), map=ROOM, guide=nav.Guide(), shield=nav.Shield())
    wrong = nav.sensing.Odometry(length_error=0.0, heading_error=0.01)
    disc = nav.HolonomicRobot(radius=0.2)
    for each, robot, sensors in ((law, disc, [wrong]), (nav.ArcRollouts(), ROBOT, [LIDAR, wrong])):
        run = nav.simulate(scene(robot=robot, time_limit=2.0), each, built=built(*sensors))
        (doubt,) = (warning for warning in run.warnings if warning.code == "pose_drifts")
        assert not doubt.safe_side
    exact = nav.sensing.Odometry(length_error=0.0)
    assert "pose_drifts" not in codes(nav.simulate(scene(robot=disc, time_limit=2.0), law, built=built(exact)))
    both = nav.robots.AsBuilt(robot_vision=nav.sensing.Vision(), sensors=[wrong])
    assert nav.knowledge.sensing_of(scene(), both).robot == "odometry"
