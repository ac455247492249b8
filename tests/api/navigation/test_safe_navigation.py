"""Shield, yielding and safe navigation: check values, bad input, and that it is a law like any other."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.navigation.laws import SafeNavigation, Shield, Yielding, speed_bound
from hrsafety.navigation.maps import Guide, StaticMap

FIELD = nav.VirtualForceField()
# V_max, a_max, T, L, rho; V; wanted; o, r, e, v; gap; projection; distance of the projection.
PLANS = [
    (
        (0.7, 10.0, 0.06, 0.0, 0.3),
        (0.0, 0.0),
        (0.078256, 0.2163),
        ((0.560601, 0.553135), 0.4, 0.0, 1.0),
        -0.049887,
        0.219028,
    ),
    (
        (1.5, 10.0, 0.1, 0.1, 0.2),
        (0.661018, 0.561128),
        (-0.558781, 0.970084),
        ((-0.70091, 0.936106), 0.3, 0.0, 2.0),
        -0.023325,
        0.236326,
    ),
    (
        (1.0, 2.0, 0.05, 0.0, 0.3),
        (0.639862, 0.252829),
        (0.087349, 0.329504),
        ((0.24678, 0.777323), 0.4, 0.0, 2.0),
        -0.776913,
        None,
    ),
]
CLIPPED = [(0.078256, 0.2163), (-0.287114, 0.879004), (0.540811, 0.266575)]


@pytest.mark.parametrize("index", range(len(PLANS)))
def test_plans_of_the_specification(index: int) -> None:
    (fastest, most, period, latency, radius), velocity, wanted, (place, size, error, speed), gap, change = PLANS[index]
    shield = Shield(person_speed=speed, latency=latency, position_error=error)
    decision = shield.decide(
        wanted,
        velocity=velocity,
        people=[place],
        person_radius=size,
        radius=radius,
        max_speed=fastest,
        max_acceleration=most,
        control_period=period,
    )
    assert decision.wanted_gap == pytest.approx(gap, abs=2e-4)
    if change is None:
        assert decision.status == "braking"
        assert decision.velocity == pytest.approx([0.548453, 0.216711], abs=1e-6)
    else:
        assert decision.status == "changed"
        found = float(np.linalg.norm(decision.velocity - CLIPPED[index]))
        assert found == pytest.approx(change, abs=0.01 * fastest)
        assert decision.gap > 0.0


def test_the_closed_bound_is_that_of_the_specification() -> None:
    near = speed_bound(0.357869627, 0.879100347, deceleration=3.0, person_speed=1.0)
    assert near == pytest.approx(0.8455785603, abs=1e-9)
    still = speed_bound(0.861824121, 1.025294077, deceleration=10.0, person_speed=0.0)
    assert still == pytest.approx(5.7637409174, abs=1e-9)
    assert speed_bound(1.810287673, -2.027249685, deceleration=10.0, person_speed=1.6) == math.inf


def test_speeds_below_the_closed_bound_are_verified() -> None:
    generator = np.random.default_rng(4)
    fastest, most, period, radius, size, error, latency, speed = 1.2, 6.0, 0.08, 0.25, 0.3, 0.02, 0.05, 1.4
    shield = Shield(person_speed=speed, latency=latency, position_error=error)
    verified = 0
    for _ in range(300):
        away, angle = generator.uniform(0.8, 4.0), generator.uniform(-math.pi, math.pi)
        free = away - radius - 0.005 - size - error - speed * (latency + 2 * period) - 1.5 * fastest * period
        if free <= 0.0:
            continue
        bound = speed_bound(free, angle, deceleration=most, person_speed=speed)
        wanted = min(0.999 * bound, fastest, most * period)
        decision = shield.decide(
            (wanted * math.cos(angle), wanted * math.sin(angle)),
            velocity=(0.0, 0.0),
            people=[(away, 0.0)],
            person_radius=size,
            radius=radius,
            max_speed=fastest,
            max_acceleration=most,
            control_period=period,
        )
        assert decision.status == "kept"
        verified += 1
    assert verified > 100


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("person_speed", -0.1),
        ("latency", -1.0),
        ("position_error", math.nan),
        ("margin", -1e-3),
        ("wall_margin", math.inf),
    ],
)
def test_numbers_that_a_shield_refuses(name: str, value: float) -> None:
    with pytest.raises(InvalidParameterError, match=name):
        Shield(**{name: value})


def test_bounds_that_belong_together() -> None:
    with pytest.raises(InvalidParameterError, match="person_acceleration must be given with velocity_error"):
        Shield(velocity_error=0.1)
    with pytest.raises(InvalidParameterError, match="velocity_error"):
        Shield(velocity_error=-0.1, person_acceleration=1.0)
    with pytest.raises(InvalidParameterError, match="reaction_time must be given with person_deceleration"):
        Shield(person_deceleration=2.0)
    with pytest.raises(InvalidParameterError, match="person_deceleration"):
        Shield(reaction_time=0.3, person_deceleration=0.0)


def test_states_that_a_shield_refuses() -> None:
    shield = Shield()
    with pytest.raises(ShapeError, match="people"):
        shield.decide((0.1, 0.0), velocity=(0.0, 0.0), people=[(1.0, 2.0, 3.0)])
    with pytest.raises(InvalidParameterError, match="velocity must be finite"):
        shield.decide((0.1, 0.0), velocity=(math.nan, 0.0), people=[])
    with pytest.raises(InvalidParameterError, match="velocity must be finite and shorter"):
        shield.decide((0.1, 0.0), velocity=(0.1, 1e308), people=[])
    with pytest.raises(InvalidParameterError, match="control_period"):
        shield.decide((0.1, 0.0), velocity=(0.0, 0.0), people=[], control_period=0.0)
    with pytest.raises(InvalidParameterError, match="person_speed"):
        Shield(person_speed=None).decide((0.1, 0.0), velocity=(0.0, 0.0), people=[])


@pytest.mark.parametrize(
    ("name", "value"),
    [("clearance", -0.1), ("horizon", 0.0), ("time_weight", math.nan), ("comfort", 0.0), ("reach", 0.0)],
)
def test_numbers_that_yielding_refuses(name: str, value: float) -> None:
    with pytest.raises(InvalidParameterError, match=name):
        Yielding(**{name: value})


def test_a_known_velocity_permits_more() -> None:
    people, wanted = [(0.8, 0.0)], (0.6, 0.0)
    options = {"velocity": (0.3, 0.0), "people": people, "person_velocity": [(1.5, 0.0)]}
    worst = Shield().decide(wanted, **options)
    known = Shield(velocity_error=0.1, person_acceleration=1.0).decide(wanted, **options)
    assert worst.status == "changed"
    assert known.status == "kept"


def test_it_is_a_law_like_any_other() -> None:
    law = SafeNavigation(FIELD, shield=Shield(), yielding=Yielding())
    assert pickle.loads(pickle.dumps(law)) == law
    assert law.GAIN_NAMES == FIELD.GAIN_NAMES
    assert law.replaced(attractive_gain=4.0).gains[0] == 4.0
    assert law.replaced(preferred_speed=0.5).preferred_speed == 0.5
    scene = scenarios.random_traffic(12, seed=1)
    run = nav.simulate(scene, law)
    many = nav.simulate_many([scene], {"alone": FIELD, "safe": law}, stop_on_contact=True)
    assert many.select(law="safe").arrival_time[0] == run.arrival_time
    assert many.select(law="safe").contacts_at_fault[0] == 0
    stepped = nav.Run(scene, law)
    while not stepped.finished:
        stepped.step()
        assert stepped.trace is not None
        assert stepped.trace.status in {"kept", "changed", "braking"}
        assert math.hypot(*stepped.trace.command) <= scene.robot.max_speed * (1 + 1e-9)
    assert stepped.time == run.arrival_time
    assert nav.evaluate(scene, law).total > 0.0
    found = nav.optimize_gains([scenarios.configuration("c1")], law, grid=(2, 2, 1, 1), refinements=0, local_starts=0)
    assert isinstance(found.nearest, SafeNavigation)


def test_what_every_part_keeps_is_the_laws_own_command() -> None:
    # So fast that the law never asks for more.
    scene = nav.Scenario(start=(0.0, 0.0), goal=(4.0, 1.0), robot=nav.HolonomicRobot(max_speed=6.0))
    alone = nav.simulate(scene, FIELD)
    guarded = nav.simulate(scene, SafeNavigation(FIELD, shield=Shield()))
    assert np.array_equal(alone.position, guarded.position)
    assert np.array_equal(alone.force, guarded.force)


def test_a_law_in_python_is_shielded() -> None:
    scene = scenarios.random_traffic(12, seed=3)
    assert nav.simulate(scene, SafeNavigation(straight, shield=Shield())).contact_at_fault.sum() == 0


def test_a_preferred_speed_above_that_of_the_robot_is_refused() -> None:
    law = SafeNavigation(FIELD, preferred_speed=2.0)
    with pytest.raises(InvalidParameterError, match="preferred_speed must be at most the largest speed"):
        nav.simulate(scenarios.configuration("c1"), law)


def test_limits_of_speed_and_acceleration_are_kept() -> None:
    law = SafeNavigation(nav.OptimalReciprocalCollisionAvoidance(), shield=Shield(), yielding=Yielding())
    robot = nav.HolonomicRobot(max_speed=0.7, max_acceleration=3.0)
    run = nav.simulate(scenarios.random_traffic(12, seed=5, robot=robot), law)
    speed = np.linalg.norm(run.velocity, axis=1)
    assert speed.max() <= 0.7 * (1 + 1e-12)
    change = np.linalg.norm(np.diff(run.velocity[:-1], axis=0), axis=1)
    assert change.max() <= 3.0 * 0.01 * (1 + 1e-9)


def test_a_start_too_near_to_somebody_brakes_and_rests() -> None:
    person = nav.Human(start=(0.75, 0.0), velocity=(-1.0, 0.0), radius=0.4, critical_radius=0.61, active_radius=1.5)
    scene = nav.Scenario(start=(0.0, 0.0), goal=(5.0, 0.0), obstacles=(person,), time_limit=3.0)

    def ahead(situation: nav.Situation) -> object:
        return 20.0 * (situation.goal - situation.position)

    run = nav.simulate(scene, SafeNavigation(ahead, shield=Shield()))
    assert not run.contact_at_fault.any()
    assert run.contacts_standing == 1


def test_a_file_and_the_command_line_put_parts_around_a_law(tmp_path: Path) -> None:
    text = (
        "start = [0, 0]\ngoal = [3, 0]\n[safe]\npreferred_speed = 0.5\n"
        "[safe.shield]\nperson_speed = 1.0\n[safe.yielding]\n"
    )
    file = tmp_path / "scene.toml"
    file.write_text(text, encoding="utf-8")
    described = scenarios.load(file)
    assert isinstance(described.law, SafeNavigation)
    assert described.law.shield == Shield(person_speed=1.0)
    file.write_text(text.replace("person_speed", "people_speed"), encoding="utf-8")
    with pytest.raises(InvalidParameterError, match=r"safe\.shield\.people_speed.*did you mean .person_speed."):
        scenarios.load(file)


def test_a_robot_of_two_wheels_is_shielded() -> None:
    scene = nav.Scenario(
        start=(0.0, 0.0),
        goal=(4.0, 1.0),
        robot=nav.DifferentialDriveRobot(),
        obstacles=(nav.Human(start=(3.0, -1.0), velocity=(-0.3, 0.4)),),
    )
    run = nav.simulate(scene, SafeNavigation(FIELD, shield=Shield(), yielding=Yielding()))
    assert run.outcome == "arrived"


def test_the_guide_leads_out_of_a_trap() -> None:
    walls = StaticMap.from_polylines([[(1, 1.5), (3, 1.5), (3, -1.5), (1, -1.5)]])
    scene = nav.Scenario(start=(0.0, 0.0), goal=(5.0, 0.0), time_limit=60.0)
    alone = nav.simulate(scene, SafeNavigation(FIELD, map=walls, shield=Shield()))
    guided = nav.simulate(scene, SafeNavigation(FIELD, map=walls, guide=Guide(), shield=Shield()))
    assert alone.outcome != "arrived"
    assert guided.outcome == "arrived"
    clearance = walls.clearance(guided.position)
    assert clearance.min() > scene.robot.radius


def test_a_start_in_contact_with_the_map_is_refused() -> None:
    walls = StaticMap.from_polylines([[(0.1, -1), (0.1, 1)]])
    scene = nav.Scenario(start=(0.0, 0.0), goal=(5.0, 0.0))
    with pytest.raises(InvalidParameterError, match="start must be farther from the map"):
        nav.simulate(scene, SafeNavigation(FIELD, map=walls))


def test_a_goal_that_the_map_leaves_no_room_for_is_refused() -> None:
    walls = StaticMap.from_polylines([[(5.1, -1), (5.1, 1)]])
    scene = nav.Scenario(start=(0.0, 0.0), goal=(5.0, 0.0))
    for guide in (None, Guide()):
        with pytest.raises(InvalidParameterError, match="goal must be"):
            nav.simulate(scene, SafeNavigation(FIELD, map=walls, guide=guide))


def straight(situation: nav.Situation) -> object:
    return 20.0 * (situation.goal - situation.position) - 8.0 * situation.velocity


def test_what_reaches_out_of_the_map_is_not_known_by_it_alone() -> None:
    pillar = nav.Disc(center=(3.0, 0.0), radius=1.0)
    scene = nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), obstacles=(pillar,), time_limit=8.0)
    inside = StaticMap.from_polylines([[(3.0, -0.1), (3.0, 0.1)]])
    run = nav.simulate(scene, SafeNavigation(straight, map=inside, shield=Shield()))
    assert run.min_clearance.min() > 0.0
    # All of it in the map: the boundary points of the map stand for it.
    whole = StaticMap.from_obstacles([pillar])
    run = nav.simulate(scene, SafeNavigation(straight, map=whole, shield=Shield()))
    assert run.min_clearance.min() > 0.0


@pytest.mark.parametrize("law", [nav.FieldDStar(), nav.RapidlyExploringRandomTree()])
def test_planners_of_whole_paths_keep_out_of_the_map(law: nav.Law) -> None:
    # The end of the trap is farther away than boundary points are shown.
    walls = StaticMap.from_polylines([[(1, 1.5), (7, 1.5), (7, -1.5), (1, -1.5)]])
    scene = nav.Scenario(start=(0.0, 0.0), goal=(8.5, 0.0), time_limit=60.0)
    run = nav.simulate(scene, SafeNavigation(law, map=walls))
    assert run.outcome == "arrived"
    x, y = run.position.T
    assert not ((x > 2.0) & (x < 7.0) & (abs(y) < 1.5)).any()


def test_a_law_in_python_is_led_by_local_goals() -> None:
    walls = StaticMap.from_polylines([[(1, 1.5), (3, 1.5), (3, -1.5), (1, -1.5)]])
    scene = nav.Scenario(start=(0.0, 0.0), goal=(5.0, 0.0), time_limit=60.0)
    goals = []

    def led(situation: nav.Situation) -> object:
        goals.append(tuple(situation.goal.tolist()))
        return straight(situation)

    led_run = nav.simulate(scene, SafeNavigation(led, map=walls, guide=Guide(), shield=Shield(), takeover=False))
    assert led_run.outcome == "arrived"
    assert goals[0] != (5.0, 0.0)
    assert goals[-1] == (5.0, 0.0)
    # Parts within parts hand it on.
    goals.clear()
    inner = SafeNavigation(led, shield=Shield())
    assert nav.simulate(scene, SafeNavigation(inner, map=walls, guide=Guide())).outcome == "arrived"
    assert goals[0] != (5.0, 0.0)


def test_a_run_through_a_wall_is_a_contact_at_fault() -> None:
    walls = StaticMap.from_polylines([[(2.0, -1.0), (2.0, 1.0)]])
    scene = nav.Scenario(start=(0.0, 0.0), goal=(4.0, 0.0))
    through = SafeNavigation(straight, map=walls)
    run = nav.simulate(scene, through)
    assert run.outcome == "collided"
    touching = walls.clearance(run.position) <= scene.robot.radius
    assert run.map_contact_time == run.time[touching][0]
    assert run.map_contact_speed > 0.5
    # Motion steps are 7 mm long at most.
    assert -0.2 <= run.map_clearance < -0.19
    assert (run.contacts_moving, run.contacts_standing) == (1, 0)
    assert nav.simulate(scene, through, stop_on_contact=True).time[-1] == run.map_contact_time
    assert nav.evaluate(scene, through).total == 0.0
    table = nav.simulate_many(scene, [through], seeds=2)
    assert table.contacts_at_fault.tolist() == table.contacts_moving.tolist() == [1, 1]
    assert table.min_clearance.tolist() == [run.map_clearance] * 2
    # Whoever knows the map: a run that is stepped, robots as built, a lidar.
    blind = nav.Lidar(map=walls, beams=1, field_of_view=0.1, range_max=0.01)
    for law, built in ((through, nav.robots.AsBuilt()), (straight, nav.robots.AsBuilt(sensors=[blind]))):
        other = nav.simulate(scene, law, built=built)
        assert (other.outcome, other.map_contact_time) == ("collided", run.map_contact_time)


def test_the_least_clearance_from_a_map_is_that_of_every_motion_step() -> None:
    walls = StaticMap.from_polylines([[(1, 0.9), (3, 0.4), (3.5, 1.0)], [(1, -1.0), (2, -0.5), (4, -3.0)]])
    scene = nav.Scenario(start=(0.0, 0.0), goal=(4.0, 0.0))
    for law in (
        SafeNavigation(straight, map=walls),
        SafeNavigation(nav.OptimalReciprocalCollisionAvoidance(), map=walls),
    ):
        run = nav.simulate(scene, law)
        assert run.map_clearance == pytest.approx(walls.clearance(run.position).min() - scene.robot.radius, abs=1e-12)
        assert np.isnan(run.map_contact_time)
    assert nav.simulate(scene, FIELD).map_clearance == np.inf


def test_the_shield_reckons_with_the_age_of_what_a_camera_tells() -> None:
    person = nav.Human(start=(4.0, 0.05), velocity=(-1.0, 0.0), stop=(1.0, 0.05), max_speed=1.6)
    scene = nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), obstacles=(person,), time_limit=4.0)

    def run(latency: float, delay: float) -> nav.Trajectory:
        camera = nav.robots.AsBuilt(obstacle_vision=nav.sensing.Vision(period=0.06, delay=delay))
        return nav.simulate(scene, SafeNavigation(straight, shield=Shield(latency=latency)), built=camera)

    told, assumed, late = run(0.0, 0.3), run(0.3, 0.3), run(0.6, 0.3)
    assert told.position == pytest.approx(assumed.position, abs=1e-6)
    assert late.position[:, 0].max() < told.position[:, 0].max() - 0.01
    # Frames come late: without an age the robot would be as near as if it were told at once.
    assert told.position[:, 0].max() < run(0.0, 0.0).position[:, 0].max() - 0.01


@pytest.mark.parametrize("seed", [7_000_005, 7_000_006, 7_000_010, 7_000_011])
def test_a_robot_that_people_push_out_of_the_box_of_its_guide_comes_back(seed: int) -> None:
    scene = scenarios.random_traffic(12, seed=seed)
    guided = SafeNavigation(FIELD, guide=Guide(spacing=0.1), shield=Shield(person_speed=1.0), yielding=Yielding())
    assert nav.simulate(scene, guided).outcome == "arrived"
