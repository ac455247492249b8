"""Regions, implausible numbers and closed ways: what a scenario refuses and what it warns of."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.errors import InvalidParameterError

LAW = nav.VirtualForceField()
MEASURED = nav.Measurement()
ENDS: dict[str, Any] = {"start": (3.9, 0.6), "goal": (0.0, 0.6)}


def scene(*obstacles: nav.Obstacle, **fields: Any) -> nav.Scenario:
    return nav.Scenario(obstacles=obstacles, **ENDS | fields)


def codes(scenario: nav.Scenario) -> list[str]:
    return [each.code for each in scenario.warnings]


def box(side: float, gap: float = 0.0) -> list[nav.Obstacle]:
    """Four walls around (0, 0); the right one leaves a gap."""
    regions = {"critical_radius": 0.3, "active_radius": 0.4}
    half, length = 0.5 * side, side + 0.2
    return [
        nav.Rectangle(center=(0, half), length=length, width=0.2, **regions),
        nav.Rectangle(center=(0, -half), length=length, width=0.2, **regions),
        nav.Rectangle(center=(-half, 0), length=0.2, width=length, **regions),
        nav.Rectangle(center=(half, -0.5 * gap), length=0.2, width=length - gap, **regions),
    ]


@pytest.mark.parametrize(
    ("obstacle", "message"),
    [
        (
            nav.Disc(center=(2.0, 0.0), radius=0.1, critical_radius=0.25, active_radius=0.8),
            r"obstacles\[1\]\.critical_radius must be at least 0\.3 m, where the robot \(radius 0\.2 m\) touches "
            r"obstacles\[1\] \(Disc\), got 0\.25; leave it out, or give the 0\.3665 m of region_radii or more",
        ),
        (
            nav.Human(start=(0, 0), velocity=(1, 0), critical_radius=0.0, active_radius=2.1),
            r"at least 0\.6 m, .* touches obstacles\[1\] \(Human\), got 0\.0; .* 0\.7965 m",
        ),
        (
            nav.Rectangle(center=(2, 3), length=1, width=1, critical_radius=0.19, active_radius=1.0),
            r"at least 0\.2 m, .* touches obstacles\[1\] \(Rectangle\), got 0\.19",
        ),
        (
            nav.MovingDisc(center=(2, 3), radius=0.2, velocity=(1, 0), critical_radius=0.3, active_radius=1.0),
            r"at least 0\.4 m, .* touches obstacles\[1\] \(MovingDisc\), got 0\.3",
        ),
    ],
)
def test_a_critical_region_in_which_they_touch_already_is_refused(obstacle: nav.Obstacle, message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        scene(nav.Disc(center=(2, -3), radius=0.1), obstacle)


def test_the_contact_distance_itself_is_accepted_with_a_warning() -> None:
    disc = nav.Disc(center=(2.0, 0.0), radius=0.1, critical_radius=0.3, active_radius=0.8)
    assert codes(scene(disc)) == ["region_below_safe"]


def test_ends_near_an_obstacle_name_it_with_distance_and_remedy() -> None:
    disc = nav.Disc(center=(3.9, 0.4), radius=0.1)
    message = (
        r"start must not be in contact with an obstacle: at least 0\.3 m from the center of obstacles\[0\] \(Disc\), "
        r"got \(3\.9, 0\.6\); it is 0\.2 m away, move it by 0\.1 m or more"
    )
    with pytest.raises(InvalidParameterError, match=message):
        scene(disc)
    wall = nav.Rectangle(center=(0.0, 1.5), length=1.0, width=1.0, active_radius=0.8, critical_radius=0.4)
    message = (
        r"goal must lie outside the active region of every stationary obstacle: at least 0\.8 m from the contour of "
        r"obstacles\[1\], got \(0\.0, 0\.6\); it is 0\.4 m away, move it by 0\.4 m or more"
    )
    near = scene(nav.Human(start=(1, 5), velocity=(1, 0)), wall)
    assert codes(near) == ["goal_in_active_region"]
    # Laws that keep to regions are pushed away from such a goal; the others do not know of it.
    for run in (nav.simulate, nav.evaluate, nav.Run):
        with pytest.raises(InvalidParameterError, match=message):
            run(near, LAW)
    for many in (nav.simulate_many, nav.simulate_batch):
        with pytest.raises(InvalidParameterError, match=r"scenarios\[0\]\.goal must lie outside"):
            many([near], LAW)
    guarded = nav.SafeNavigation(LAW, shield=nav.Shield(), yielding=nav.Yielding())
    for law in (nav.OptimalReciprocalCollisionAvoidance(margin=0.05), guarded):
        run = nav.simulate(near, law)
        assert run.outcome == "arrived"
        assert run.min_clearance[1] > 0.0
        assert "goal_in_active_region" not in {each.code for each in run.warnings}


def test_the_published_configurations_warn_of_nothing_and_with_noise_of_the_regions_of_people() -> None:
    for name in scenarios.CONFIGURATIONS:
        found = scenarios.configuration(name)
        assert found.warnings == (), name
        assert repr(found).count("warning") == 0
    noisy = replace(scenarios.configuration("c4"), measurement=MEASURED)
    (warning,) = noisy.warnings
    assert (warning.code, warning.subject) == ("region_below_safe", "obstacles[0].critical_radius")
    assert "critical_radius of obstacles[0] (Human) is 0.8 m, below the 0.8319 m" in warning.message
    assert repr(noisy).endswith(str(warning))


def test_every_result_carries_the_warnings_that_matter_for_its_law() -> None:
    noisy = replace(scenarios.configuration("c2"), measurement=MEASURED)
    run = nav.simulate(noisy, LAW)
    assert [each.code for each in run.warnings] == ["region_below_safe"]
    assert nav.evaluate(noisy, LAW).warnings == run.warnings
    assert nav.simulate(noisy, LAW, built=nav.robots.AsBuilt()).warnings == run.warnings
    assert [each.code for each in nav.simulate_many(noisy, LAW, seeds=2).warnings] == [
        each.code for each in run.warnings
    ]
    # A law that knows no critical region does not depend on its size.
    assert nav.simulate(noisy, nav.Khatib()).warnings == ()
    batch = nav.simulate_batch([scenarios.configuration("c1"), noisy, noisy], LAW)
    one, copies = batch.warnings
    assert copies.code == "same_runs"
    assert one.subject == "scenarios[1].obstacles[0].critical_radius"
    assert "1 more of this kind" in one.message
    assert set(batch.columns()) >= {"outcome", "energy_J"}
    assert not any("warning" in name or name.startswith("_") for name in batch.columns())
    (compared,) = nav.compare({"noisy": noisy}, [LAW, nav.Khatib()], seeds=[1, 2]).warnings
    assert compared.subject == "scenarios['noisy'].obstacles[0].critical_radius"
    assert nav.compare(noisy, nav.Khatib()).warnings == ()


def test_somebody_faster_than_the_regions_are_sized_for() -> None:
    (warning,) = scene(nav.Human(start=(0.0, 3.0), velocity=(1.6, 0.0))).warnings
    assert warning.code == "region_below_safe"
    assert "1.6 m/s at which it moves, above the 1 m/s of max_speed); give max_speed=1.6" in warning.message
    assert scene(nav.Human(start=(0.0, 3.0), velocity=(1.6, 0.0), max_speed=1.6)).warnings == ()
    recorded = nav.Human.from_path([0.0, 1.0], [[0, 3], [1.5, 3]])
    assert codes(scene(recorded)) == ["region_below_safe"]


@pytest.mark.parametrize(
    ("shape", "contact"),
    [
        (lambda **regions: nav.Disc(center=(2, 0), radius=0.1, **regions), 0.35),
        (lambda **regions: nav.MovingDisc(center=(2, 0), radius=0.1, velocity=(0, 1), **regions), 0.35),
        (lambda **regions: nav.Human(start=(2, 0), velocity=(0, 1), **regions), 0.65),
        (lambda **regions: nav.Human.from_path([0, 1], [[2, 0], [2, 1]], **regions), 0.65),
        (lambda **regions: nav.Human.from_segments((2, 0), [(1, (0, 1), (0, 0))], **regions), 0.65),
        (lambda **regions: nav.Rectangle(center=(2, 0), length=0.2, width=0.2, **regions), 0.25),
        (lambda **given: nav.MovingRectangle(center=(2, 0), length=0.2, width=0.2, velocity=(0, 1), **given), 0.25),
    ],
)
def test_clearances_are_measured_between_the_surfaces_of_every_shape(shape: Any, contact: float) -> None:
    robot = nav.HolonomicRobot(radius=0.25)
    given = shape(critical_clearance=0.2, active_clearance=1.0)
    (placed,) = scene(given, robot=robot).obstacles
    assert (placed.critical_radius, placed.active_radius) == pytest.approx((contact + 0.2, contact + 1.0))
    (larger,) = replace(scene(given, robot=robot), robot=nav.HolonomicRobot(radius=0.3)).obstacles
    assert larger.critical_radius == pytest.approx(contact + 0.25)
    (half,) = scene(shape(critical_clearance=0.1), robot=robot).obstacles
    assert half.active_radius == nav.region_radii(robot, given).active_radius
    with pytest.raises(InvalidParameterError, match="critical_radius must be None where active_clearance is given"):
        shape(critical_radius=0.9, active_clearance=1.0)
    with pytest.raises(InvalidParameterError, match=r"active_clearance must be larger than critical_clearance, 0\.5 m"):
        shape(critical_clearance=0.5, active_clearance=0.5)
    with pytest.raises(InvalidParameterError, match="critical_clearance must be finite and not negative"):
        shape(critical_clearance=-0.1)


def test_a_scenario_file_takes_clearances(tmp_path: Path) -> None:
    file = tmp_path / "clear.toml"
    file.write_text(
        "start = [4, 0]\ngoal = [0, 0]\n[[obstacles]]\ntype = 'disc'\ncenter = [2, 1]\nradius = 0.1\n"
        "critical_clearance = 0.1\nactive_clearance = 0.6\n"
    )
    disc = scenarios.load(file).scenario.obstacles[0]
    assert (disc.critical_radius, disc.active_radius) == pytest.approx((0.4, 0.9))


def test_implausible_numbers_are_named() -> None:
    assert [each.subject for each in scene(heading=90.0).warnings] == ["heading"]
    quick = scene(robot=nav.HolonomicRobot(max_speed=1e12))
    assert [each.subject for each in quick.warnings] == ["robot.max_speed"]
    runner = nav.Human(start=(1, 5), velocity=(0, 1), max_speed=1600.0)
    assert "obstacles[0].max_speed" in [each.subject for each in scene(runner).warnings]
    assert [each.subject for each in scene(measurement=nav.Measurement(scale=25.0)).warnings] == ["measurement.scale"]
    assert scene().warnings == ()


def test_a_goal_beyond_the_time_limit() -> None:
    (warning,) = scene(goal=(-500.0, 0.6)).warnings
    assert warning.code == "goal_out_of_reach"
    assert "give time_limit=720" in warning.message
    assert scene(goal=(-500.0, 0.6), time_limit=720.0).warnings == ()


@pytest.mark.parametrize("ends", [((3.0, 0.0), (0.0, 0.0)), ((0.0, 0.0), (3.0, 0.0))])
def test_a_closed_box_around_start_or_goal(ends: tuple[nav.obstacles.Pair, nav.obstacles.Pair]) -> None:
    start, goal = ends
    closed = nav.Scenario(start=start, goal=goal, obstacles=box(3.0))
    assert codes(closed) == ["closed_in"]
    words = "standing obstacles leave no way from start to goal for a robot of radius 0.2 m; move start, goal or"
    assert closed.warnings[0].message.startswith(words)
    assert nav.simulate(closed, LAW).outcome != "arrived"
    # The top wall covers 0.2 m of the gap: 0.3 m is too narrow for the robot, 0.5 m is not.
    assert codes(nav.Scenario(start=start, goal=goal, obstacles=box(3.0, gap=0.5))) == ["closed_in"]
    assert codes(nav.Scenario(start=start, goal=goal, obstacles=box(3.0, gap=0.7))) == []


@pytest.mark.parametrize(
    ("thing", "depth"),
    [
        (nav.Disc(center=(0.05, 0.0), radius=0.4, critical_radius=0.7, active_radius=0.9), 0.55),
        (nav.Human(start=(0.0, 0.1), velocity=(0.0, 0.0), radius=0.4), 0.5),
        (nav.Rectangle(center=(0.2, 0.0), length=0.8, width=0.6), 0.4),
        (nav.Rectangle(center=(0.0, 0.3), length=0.8, width=0.4, heading=0.3), None),
    ],
)
def test_a_goal_inside_something_that_stands_is_told_to_planners(thing: nav.Obstacle, depth: float | None) -> None:
    place = nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), obstacles=[thing], time_limit=15.0)
    for law in (
        nav.OptimalReciprocalCollisionAvoidance(),
        nav.VelocityObstacle(),
        nav.RapidlyExploringRandomTree(),
        nav.FieldDStar(),
    ):
        run = nav.simulate(place, law)
        told = [each for each in run.warnings if each.code == "closed_in"]
        if depth is None:  # 0.105 m: the robot arrives within its tolerance of 0.12 m
            assert not told
            continue
        assert run.outcome != "arrived"
        assert [each.subject for each in told] == ["goal"]
        assert f"goal lies {depth:g} m within obstacles[0]" in told[0].message
        assert f"move it by {depth:g} m" in told[0].message


def test_a_ring_of_discs_closes_a_way_and_is_never_seen_where_there_is_a_gap() -> None:
    angles = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)

    def ring(size: float, skipped: int) -> nav.Scenario:
        places = [(1.5 * np.cos(angle), 1.5 * np.sin(angle)) for angle in angles[skipped:]]
        regions = {"critical_radius": size + 0.2, "active_radius": size + 0.3}
        return nav.Scenario(
            start=(4.0, 0.0), goal=(0.0, 0.0), obstacles=[nav.Disc(center=p, radius=size, **regions) for p in places]
        )

    # Neighbors are 0.776 m apart: a robot of 0.4 m passes between discs of a radius below 0.188 m.
    assert "closed_in" in codes(ring(0.3, 0))
    assert "closed_in" not in codes(ring(0.18, 0))
    assert "closed_in" not in codes(ring(0.3, 2))


def test_a_start_in_the_critical_region_of_something_that_stands() -> None:
    near = scene(nav.Disc(center=(3.9, 0.25), radius=0.1, critical_radius=0.4, active_radius=0.8))
    assert codes(near) == ["start_in_critical_region"]
    assert nav.simulate(near, LAW).outcome == "stopped"


def test_warnings_are_found_when_first_asked_for() -> None:
    crowd = scenarios.configuration("c4")
    assert replace(crowd)._warnings is None
    found = crowd.warnings
    assert crowd.warnings is found


def test_many_runs_carry_what_their_sensors_do_not_see() -> None:
    place = scenarios.configuration("c1")
    short = nav.robots.AsBuilt(sensors=[nav.sensing.Ultrasonic(most_range=0.5), nav.sensing.Ultrasonic()])
    (alone,) = nav.simulate(place, LAW, built=short).warnings
    assert alone.code == "region_beyond_range"
    assert nav.evaluate(place, LAW, built=short).warnings == (alone,)
    for paths in (False, True):
        runs = nav.simulate_many({"c1": place, "again": place}, LAW, built=short, paths=paths)
        assert runs.built is short
        found, copies = runs.warnings
        assert copies.code == "same_runs"
        assert (found.code, found.subject) == (alone.code, f"scenarios['c1'].{alone.subject}")
        assert found.message == f"scenarios['c1']: {alone.message} (1 more of this kind in these scenarios)"
        assert runs.select(scenario="again").warnings[0].message == f"scenarios['again']: {alone.message}"
    (compared,) = nav.compare(place, [LAW, nav.Khatib()], built=short).warnings
    assert compared.message == f"scenarios[0]: {alone.message}"
    assert nav.simulate_many(place, LAW, built=nav.robots.AsBuilt(sensors=[nav.sensing.Ultrasonic()])).warnings == ()


def test_regions_of_what_speeds_up_are_too_small() -> None:
    faster = nav.MovingDisc(center=(5.0, 0.05), radius=0.3, velocity=(-0.1, 0.0), acceleration=(-1.0, 0.0))
    scene = nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), obstacles=[faster], time_limit=12.0)
    run = nav.simulate(scene, nav.VirtualForceField())
    assert run.contact_at_fault.any()
    (doubt,) = run.warnings
    assert doubt.code == "region_below_safe"
    assert "12.1 m/s that it reaches by time_limit" in doubt.message
    for sized in (replace(faster, max_speed=12.1), replace(faster, acceleration=(0.0, 0.0))):
        found = replace(scene, obstacles=[sized]).warnings
        assert "region_below_safe" not in {each.code for each in found}


@pytest.mark.parametrize(("goal", "doubted"), [((4.0, 0.0), False), ((4.6, 0.0), False), ((4.8, 0.0), True)])
def test_a_goal_in_the_walls_is_doubted(goal: tuple[float, float], doubted: bool) -> None:
    # The robot of 0.2 m touches the wall at x = 5 before it is within 0.12 m of what lies beyond 4.92 m.
    walls = nav.StaticMap.from_polylines([[(5.0, -2.0), (5.0, 2.0)]])
    there = nav.Scenario(start=(0.0, 0.0), goal=(goal[0] + 0.15, 0.0), walls=walls)
    assert ("goal_in_wall" in codes(there)) == doubted


def test_a_recorded_person_who_is_not_seen_for_long_is_doubted_in_scenes_made_by_hand() -> None:
    time = np.arange(0.0, 12.0, 0.1)
    seen = (time < 3.0) | (time > 7.0)
    way = np.stack([9.0 - time, 0.0 * time + 3.0], axis=1)
    found = []
    for rows in (seen, np.ones(len(time), dtype=bool)):
        person = nav.Human.from_path(time[rows], way[rows])
        by_hand = scene(person)
        agent = nav.Person(start=tuple(way[0]), recording=(time[rows], way[rows]))
        worlds = nav.World.of(by_hand), nav.World(people=[agent], robots=[nav.Robot(**ENDS)])
        found.append([codes(by_hand).count("gap_in_track"), *(codes(each).count("gap_in_track") for each in worlds)])
    assert found == [[1, 1, 1], [0, 0, 0]]
    (doubt,) = [
        each for each in scene(nav.Human.from_path(time[seen], way[seen])).warnings if each.code == "gap_in_track"
    ]
    assert not doubt.safe_side
    assert doubt.message.startswith("obstacles[0] is not seen for 4.2 s")
    told = scene(nav.Human.from_path(time[seen], way[seen]), doubts=[doubt])
    assert codes(told) == ["gap_in_track"]
