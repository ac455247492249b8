"""Robots as built: the same laws, the same results where nothing is built, and clear refusals."""

from __future__ import annotations

import dataclasses
import math
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, scenarios
from hrsafety import navigation as nav
from hrsafety.navigation.laws.known import LAWS as DECLARED

LAW = nav.VirtualForceField(stabilizing="off")


def two_wheels(name: str, **changes: Any) -> nav.Scenario:
    """Return a configuration with a two-wheel robot that looks at its goal."""
    scene = scenarios.configuration(name)
    return dataclasses.replace(scene, **{"robot": nav.DifferentialDriveRobot(), "heading": math.pi} | changes)


@pytest.mark.parametrize("name", ["c1", "c4", "n2"])
@pytest.mark.parametrize("of", [None, "obstacles", "robot", "both"])
def test_ideal_robot_is_the_point_mass_bit_for_bit(name: str, of: Any) -> None:
    measurement = None if of is None else nav.Measurement(of=of)
    scene = dataclasses.replace(scenarios.configuration(name), measurement=measurement, seed=3)
    plain, built = nav.simulate(scene, LAW), nav.simulate(scene, LAW, built=nav.robots.AsBuilt())
    assert plain.wheel_speed is None
    assert list(built.columns())[: len(plain.columns())] == list(plain.columns())
    assert (plain.built, built.built) == (None, nav.robots.AsBuilt())
    for field in dataclasses.fields(plain):
        if field.name == "built":
            continue
        one, other = getattr(plain, field.name), getattr(built, field.name)
        if isinstance(one, np.ndarray):
            assert one.tobytes() == other.tobytes(), field.name
        elif field.name in ("wheel_speed", "energy_used", "reference_position", "seen_position"):
            assert one is None, field.name
            assert len(other) == len(plain.time), field.name
        else:
            assert one == other or (one != one and other != other), field.name


@pytest.mark.parametrize("name", ["n1", "n2", "n3", "n4", "multiple_obstacles"])
@pytest.mark.parametrize("wheels", [None, nav.robots.DIFFERENTIAL_WHEELS])
def test_two_wheel_robot_arrives_without_a_contact_outside_critical_regions(name: str, wheels: Any) -> None:
    scene = two_wheels(name)
    run = nav.simulate(scene, LAW, built=nav.robots.AsBuilt(wheels=wheels))
    assert run.outcome == "arrived"
    critical = [getattr(obstacle, "critical_radius", None) for obstacle in scene.obstacles]
    assert all(least > radius for least, radius in zip(run.min_distance, critical, strict=True) if radius)
    assert run.wheel_speed.shape == run.wheel_current.shape == (len(run.time), 2)
    assert np.ptp(run.heading) > 0.5
    assert run.energy == pytest.approx(run.energy_used[-1])


@pytest.mark.parametrize("law", DECLARED)
def test_every_law_drives_a_two_wheel_robot(law: str) -> None:
    # c3 is left out: the laws of other authors give up there as point masses, too.
    run = nav.simulate(two_wheels("n1", time_limit=20.0), DECLARED[law]())
    assert run.wheel_speed is not None
    assert np.isfinite(run.position).all()
    # The robot never moves sideways: its velocity lies along its heading.
    along = np.column_stack([np.cos(run.heading), np.sin(run.heading)])
    inner = run.velocity[:-1]
    assert np.abs(inner[:, 0] * along[:-1, 1] - inner[:, 1] * along[:-1, 0]).max() < 1e-12


def test_score_compares_with_the_free_run_of_the_same_robot() -> None:
    result = nav.evaluate(two_wheels("n1"), LAW)
    free = nav.simulate(dataclasses.replace(two_wheels("n1"), obstacles=()), LAW)
    assert result.nominal.arrival_time == free.arrival_time
    assert result.arrival_time == pytest.approx(free.arrival_time / result.trajectory.arrival_time)
    assert result.energy_saving == pytest.approx(free.energy / result.trajectory.energy)
    assert 0.0 < result.total < 1.0


def test_regions_of_a_two_wheel_robot_have_time_to_turn() -> None:
    disc = nav.Disc(center=(2.0, 0.6), radius=0.1)
    scene = nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[disc], robot=nav.DifferentialDriveRobot())
    assert scene.obstacles[0].active_radius == pytest.approx(0.5813, abs=5e-5)


BATCHES: dict[str, Callable[[nav.Scenario], object]] = {
    "simulate_batch": lambda scene: nav.simulate_batch([scenarios.configuration("c1"), scene], LAW),
    "optimize_gains": lambda scene: nav.optimize_gains([scenarios.configuration("c1"), scene], LAW),
    "gain_sensitivity": lambda scene: nav.gain_sensitivity([scenarios.configuration("c1"), scene], LAW),
}


@pytest.mark.parametrize("batch", BATCHES)
def test_batches_of_point_masses_refuse_a_two_wheel_robot(batch: str) -> None:
    with pytest.raises(InvalidParameterError, match="HolonomicRobot") as caught:
        BATCHES[batch](two_wheels("n1"))
    assert caught.value.argument == "scenarios[1].robot"


@pytest.mark.parametrize("options", [{"hold": False}, {"integrator": "rk4"}, {"step": 0.007}, {"step": -1.0}])
def test_options_that_a_two_wheel_robot_cannot_have_are_refused(options: dict[str, Any]) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.simulate(two_wheels("n1"), LAW, **options)
    assert caught.value.argument == next(iter(options))


@pytest.mark.parametrize(
    ("built", "argument"),
    [
        ({"wheels": nav.robots.HOLONOMIC_WHEELS}, "wheels"),
        ({"wheels": ()}, "wheels"),
        ({"robot_vision": nav.sensing.Vision()}, "measurement"),
    ],
)
def test_what_does_not_suit_the_scenario_is_refused(built: dict[str, Any], argument: str) -> None:
    scene = two_wheels("n1", measurement=nav.Measurement())
    with pytest.raises(InvalidParameterError) as caught:
        nav.simulate(scene, LAW, built=nav.robots.AsBuilt(**built))
    assert caught.value.argument == argument


@pytest.mark.parametrize(
    ("argument", "value"),
    [
        ("wheels", 3),
        ("wheels", [None, None]),
        ("kinematics", None),
        ("slip", 0.1),
        ("tracking", "fast"),
        ("robot_vision", True),
        ("obstacle_vision", 16.7),
        ("pose_fusion", (0.3, 0.1)),
    ],
)
def test_parts_of_another_kind_are_refused(argument: str, value: Any) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.robots.AsBuilt(**{argument: value})
    assert caught.value.argument.startswith(argument)


@pytest.mark.parametrize("field", ["position_share", "heading_share"])
@pytest.mark.parametrize("value", [-0.1, 1.1, math.nan, "1", None])
def test_shares_are_from_0_to_1(field: str, value: Any) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.robots.PoseFusion(**{field: value})
    assert caught.value.argument == field


def test_built_robot_is_a_value() -> None:
    built = nav.robots.AsBuilt(
        wheels=list(nav.robots.DIFFERENTIAL_WHEELS),
        tracking=nav.tracking.VirtualTorque(),
        robot_vision=nav.sensing.Vision(),
    )
    assert pickle.loads(pickle.dumps(built)) == built
    assert hash(built) == hash(dataclasses.replace(built))
    assert built != dataclasses.replace(built, slip=nav.robots.Slip(creep=0.01))


def test_wheels_with_controllers_lose_more_than_ideal_ones() -> None:
    # (D.3.1) adds feedback to the feed-forward that (D.3.2) counts alone.
    for scene, wheels in (
        (scenarios.configuration("c1"), nav.robots.HOLONOMIC_WHEELS),
        (two_wheels("n1"), nav.robots.DIFFERENTIAL_WHEELS),
    ):
        ideal = nav.simulate(scene, LAW, built=nav.robots.AsBuilt())
        real = nav.simulate(scene, LAW, built=nav.robots.AsBuilt(wheels=wheels))
        assert real.energy > ideal.energy
        assert real.arrival_time == pytest.approx(ideal.arrival_time, rel=0.01)


def test_creeping_wheels_do_not_mislead_a_robot_that_is_seen() -> None:
    built = nav.robots.AsBuilt(
        wheels=nav.robots.DIFFERENTIAL_WHEELS,
        slip=nav.robots.Slip(creep=0.05),
        robot_vision=nav.sensing.Vision(error=nav.sensing.PositionNoise(distribution="gaussian", scale=0.0032)),
    )
    run = nav.simulate(two_wheels("n3"), LAW, built=built)
    assert run.outcome == "arrived"
    assert not np.array_equal(run.seen_position, run.position)


@pytest.mark.parametrize("options", [{"hold": False}, {"integrator": "rk4"}])
@pytest.mark.parametrize("verb", [nav.simulate, nav.evaluate])
def test_robots_as_built_move_by_one_scheme(verb: Any, options: dict[str, Any]) -> None:
    with pytest.raises(InvalidParameterError, match="for a robot as built") as caught:
        verb(scenarios.configuration("c1"), LAW, built=nav.robots.AsBuilt(), **options)
    assert caught.value.argument == next(iter(options))


def test_score_of_a_robot_as_built_is_that_of_its_run() -> None:
    scene, built = two_wheels("n1"), nav.robots.AsBuilt(wheels=nav.robots.DIFFERENTIAL_WHEELS)
    found, run = nav.evaluate(scene, LAW, built=built), nav.simulate(scene, LAW, built=built)
    assert found.trajectory.position.tobytes() == run.position.tobytes()
    assert found.arrival_time == found.nominal.arrival_time / run.arrival_time
    assert found.total != nav.evaluate(scene, LAW).total
    with pytest.raises(InvalidParameterError, match="built must be an AsBuilt"):
        nav.simulate(scene, LAW, built="wheels")  # type: ignore[arg-type]  # refused
