"""A law that knows obstacles by echoes: what it sees, what it does not, and what the run says of it."""

from __future__ import annotations

import dataclasses
import math
import pickle
from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, reactive, scenarios
from hrsafety import navigation as nav

# An echo lies on the axis of its beam: straight ahead, only a side that is kept leads around it.
LAW = nav.VirtualForceField(side_hysteresis=3.05)
RING = nav.sensing.Ultrasonic.ring(16, 0.15, beam_width=0.4, max_speed=0.3)
BLIND = nav.sensing.Ultrasonic(mounts=[(0.0, 0.0, math.pi / 2)], beam_width=0.1, max_speed=0.0)
C1 = scenarios.configuration("c1")


def run(scenario: nav.Scenario, *sensors: nav.sensing.Ultrasonic, law: nav.Law = LAW) -> Any:
    return nav.simulate(scenario, law, built=nav.robots.AsBuilt(sensors=sensors))


@pytest.mark.parametrize("robot", [nav.HolonomicRobot(), nav.DifferentialDriveRobot()])
def test_the_field_passes_a_disc_by_its_echoes_alone(robot: Any) -> None:
    scene = dataclasses.replace(C1, robot=robot, heading=math.pi)
    found = run(scene, RING)
    assert found.outcome == "arrived"
    assert found.min_clearance.min() > 0.0
    assert found.sensing == ("exact", ("ultrasonic",))


def test_what_gives_no_echo_is_not_known() -> None:
    blind, free = run(C1, BLIND), run(dataclasses.replace(C1, obstacles=()), BLIND)
    assert blind.min_clearance.min() <= 0.0
    assert blind.position.tobytes() == free.position.tobytes()


def test_a_stepped_run_by_echoes_is_the_whole_run() -> None:
    built = nav.robots.AsBuilt(sensors=[RING])
    stepped = nav.Run(C1, LAW, built)
    while not stepped.finished:
        seen = stepped.step()
    assert seen.obstacle_position.shape == (16, 2)
    assert stepped.trajectory.position.tobytes() == run(C1, RING).position.tobytes()
    assert stepped.trajectory.sensing.obstacles == ("ultrasonic",)  # type: ignore[attr-defined]  # a run as built has sensing


@pytest.mark.parametrize("law", [nav.Khatib(), nav.VelocityObstacle(), nav.FieldDStar(), nav.VirtualImpedanceLaw()])
def test_other_laws_go_by_echoes_too(law: nav.Law) -> None:
    seen, blind = run(C1, RING, law=law), run(C1, BLIND, law=law)
    assert np.isfinite(seen.position).all()
    assert seen.position.tobytes() != blind.position.tobytes()


def test_the_speed_that_echoes_are_taken_to_have_counts_for_reciprocal_avoidance() -> None:
    # Somebody walks to where the robot goes.
    walker = nav.MovingDisc(center=(6.0, 0.0), velocity=(-0.5, 0.0), radius=0.3)
    scene = nav.Scenario(start=(0.0, 0.0), goal=(4.0, 0.1), obstacles=[walker], time_limit=20.0)
    law = nav.OptimalReciprocalCollisionAvoidance()
    found = {
        speed: run(scene, nav.sensing.Ultrasonic.ring(16, 0.2, assumed_speed=speed), law=law).min_clearance[0]
        for speed in (0.0, 0.5)
    }
    assert found[0.5] > found[0.0]


def test_sensing_names_every_sensor_that_told() -> None:
    camera = nav.sensing.Vision()
    scene = scenarios.configuration("c2")
    built = nav.robots.AsBuilt(robot_vision=camera, obstacle_vision=camera, sensors=[RING])
    assert nav.knowledge.sensing_of(scene, built) == ("camera", ("camera", "ultrasonic"))
    measured = dataclasses.replace(scene, measurement=nav.Measurement(of="both"))
    assert nav.knowledge.sensing_of(measured, nav.robots.AsBuilt()) == ("measurement", ("measurement",))
    assert nav.simulate(scene, LAW, built=built).sensing.robot == "camera"


def test_a_range_below_the_active_region_is_a_warning() -> None:
    short = nav.sensing.Ultrasonic(max_speed=1.0, most_range=0.9)
    regions = nav.knowledge.echo_regions(C1, short)
    assert regions.active_radius > regions.reach == pytest.approx(1.05)
    (warning,) = run(C1, RING, short).warnings
    assert warning.code == "region_beyond_range"
    assert warning.subject == "sensors[1].most_range"
    assert not run(C1, RING).warnings


def test_regions_of_an_echo_are_those_of_a_disc_without_size() -> None:
    disc = nav.MovingDisc(center=(9.0, 9.0), velocity=(1.0, 0.0), radius=1e-12)
    robot = nav.HolonomicRobot()
    own = nav.knowledge.echo_regions(C1, nav.sensing.Ultrasonic(max_speed=1.0))
    expected = nav.region_radii(robot, disc, C1.control_period)
    assert own[:2] == pytest.approx(tuple(expected), abs=1e-9)


def test_the_nominal_run_of_a_score_sees_everything() -> None:
    score = nav.evaluate(C1, LAW, built=nav.robots.AsBuilt(sensors=[RING]))
    nominal: Any = score.nominal
    assert nominal.sensing == ("exact", ("exact",))
    assert 0.0 < score.total < 1.0


def test_arrays_are_values() -> None:
    assert pickle.loads(pickle.dumps(RING)) == RING
    assert nav.sensing.Ultrasonic.ring(4, 0.2).mounts[1] == pytest.approx((0.0, 0.2, math.pi / 2))


@pytest.mark.parametrize(
    ("options", "argument"),
    [
        ({"mounts": []}, "mounts"),
        ({"mounts": [(0.0, 0.0)]}, "mounts"),
        ({"beam_width": 4.0}, "beam_width"),
        ({"rays": 0}, "rays"),
        ({"most_range": 0.01}, "most_range"),
        ({"range_noise": -1.0}, "range_noise"),
        ({"firing": "sometimes"}, "firing"),
        ({"max_speed": -1.0}, "max_speed"),
        ({"assumed_speed": math.nan}, "assumed_speed"),
    ],
)
def test_bad_arrays_are_refused(options: dict[str, Any], argument: str) -> None:
    with pytest.raises(InvalidParameterError, match=argument):
        nav.sensing.Ultrasonic(**options)


def test_sensors_of_another_kind_are_refused() -> None:
    with pytest.raises(InvalidParameterError, match=r"sensors\[0\]"):
        nav.robots.AsBuilt(sensors=[reactive.Sonar()])  # type: ignore[list-item]  # what is tested


def follower_scene() -> reactive.FollowerScene:
    box = reactive.Box(center=(2.5, 1.5), size=(0.5, 0.5))
    moving = reactive.MovingObstacle(shape=box, velocity=(0.0, -0.3), stop=10.0)
    return reactive.FollowerScene(leader=reactive.SoundLeader(start=(1.2, 0.0), end=(6.0, 0.0)), obstacles=[moving])


def test_a_camera_drives_the_follower_in_place_of_its_sonar() -> None:
    exact = nav.sensing.Vision(error=nav.sensing.PositionNoise(scale=0.0))
    found = reactive.follow(follower_scene(), follower=reactive.Follower(obstacle_vision=exact))
    assert np.isinf(found.readings).all()
    assert not found.collided
    assert np.abs(found.repulsion).max() > 0.0
    sonar = reactive.follow(follower_scene())
    assert np.isfinite(sonar.readings).any()


def test_the_exact_arc_is_close_to_the_chord_of_the_source() -> None:
    chord = reactive.follow(follower_scene())
    arc = reactive.follow(follower_scene(), follower=reactive.Follower(integration="arc"))
    assert chord.position.tobytes() != arc.position.tobytes()
    assert np.abs(chord.position[:200] - arc.position[:200]).max() < 1e-2
    with pytest.raises(InvalidParameterError, match="integration"):
        reactive.Follower(integration="circle")  # type: ignore[arg-type]  # what is tested


@pytest.mark.parametrize("sensor", [nav.sensing.Lidar, nav.sensing.Ultrasonic])
def test_regions_of_what_is_read_are_sized_for_the_people_of_the_scene(sensor: Any) -> None:
    person = nav.Human(start=(4.0, 2.0), velocity=(0.0, -1.2), max_speed=1.2)
    scene = nav.Scenario(start=(0.0, 0.0), goal=(5.0, 0.0), obstacles=[person], time_limit=1.0)

    def told(**options: Any) -> list[str]:
        built = nav.robots.AsBuilt(sensors=[sensor(**options)])
        run = nav.simulate(scene, nav.VirtualForceField(), built=built)
        return [each.message for each in run.warnings if each.subject == "sensors[0].max_speed"]

    (message,) = told(max_speed=0.5)
    assert "obstacles[0] moves at up to 1.2 m/s" in message
    assert message.endswith("give max_speed=1.2")
    assert told(max_speed=1.2) == []
    if sensor is nav.sensing.Lidar:
        assert told(sees_obstacles=False) == []
