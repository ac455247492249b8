"""Numbers of lidars and robots in other units are doubted wherever they are given."""

from __future__ import annotations

import math

import pytest

from hrsafety import navigation as nav

WRONG = {
    "angle_min": {"angle_min": -90.0},
    "mounting[2]": {"mounting": (0.2, 0.0, 90.0)},
    "mounting": {"mounting": (200.0, 0.0, 0.0)},
    "range_max": {"range_max": 12000.0},
    "range_noise": {"range_noise": 30.0},
}
WALLS = nav.StaticMap.from_polylines([[(5.0, -2.0), (5.0, 2.0)]])


@pytest.mark.parametrize("field", WRONG)
def test_units_of_a_lidar_are_doubted(field: str) -> None:
    lidar = nav.Lidar(**WRONG[field])  # type: ignore[arg-type]  # fields by name
    two_wheels = nav.DifferentialDriveRobot()
    scans = nav.ScanController(nav.ArcRollouts(), two_wheels, (3.0, 0.0), lidars=[lidar])
    assert (f"lidars[0].{field}", "implausible") in {(each.subject, each.code) for each in scans.warnings}
    law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield())
    told = nav.Controller(law, nav.HolonomicRobot(), (3.0, 0.0), lidar=lidar)
    assert (f"lidar.{field}", "implausible") in {(each.subject, each.code) for each in told.warnings}
    built = nav.robots.AsBuilt(sensors=[nav.Lidar(map=WALLS, **WRONG[field])])  # type: ignore[arg-type]  # by name
    scene = nav.Scenario(start=(0.0, 0.0), goal=(3.0, 0.0), walls=WALLS, time_limit=0.2)
    run = nav.simulate(scene, nav.VirtualForceField(), built=built)
    assert (f"sensors[0].{field}", "implausible") in {(each.subject, each.code) for each in run.warnings}


def test_a_heading_in_degrees_is_doubted_in_a_world() -> None:
    def doubts(heading: float) -> list[str]:
        robot = nav.Robot(start=(0.0, 0.0), goal=(3.0, 0.0), body=nav.DifferentialDriveRobot(), heading=heading)
        return [each.message for each in nav.World(robots=[robot]).warnings if each.code == "implausible"]

    assert doubts(math.tau) == []
    assert "degrees given for radians" in doubts(90.0)[0]


@pytest.mark.parametrize(
    "given",
    [{"person_radius": 0.025}, {"person_speed": 0.16}, {"control_period": 60.0}, {"arrival_tolerance": 120.0}],
    ids=lambda given: next(iter(given)),
)
def test_numbers_of_a_controller_are_doubted(given: dict[str, float]) -> None:
    law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield())
    made = nav.Controller(law, nav.HolonomicRobot(), (3.0, 0.0), **given)  # type: ignore[arg-type]  # options by name
    assert [each.subject for each in made.warnings if each.code == "implausible"] == list(given)


@pytest.mark.parametrize("name", ["latency", "position_error", "margin", "wall_margin", "position_tracking"])
def test_numbers_of_a_shield_in_other_units_are_doubted_on_the_safe_side(name: str) -> None:
    for value, doubted in ((0.05, False), (35.0, True)):
        shield = nav.Shield(**{name: value})  # type: ignore[arg-type]  # fields by name
        law = nav.SafeNavigation(nav.VirtualForceField(), shield=shield)
        run = nav.simulate(nav.Scenario(start=(0.0, 0.0), goal=(3.0, 0.0), time_limit=0.2), law)
        found = [each for each in run.warnings if each.code == "implausible"]
        assert [each.subject for each in found] == ([f"shield.{name}"] if doubted else [])
        assert all(each.safe_side for each in found)
