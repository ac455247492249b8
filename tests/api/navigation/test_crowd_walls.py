"""Nobody passes a wall, whatever a model decides; lines are passed where they are crossed; doors let people out."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import InvalidParameterError, scenarios
from hrsafety import navigation as nav
from hrsafety.errors import ShapeError
from hrsafety.gym.environments import OUTCOMES
from hrsafety.navigation.crowd.simulation import simulated
from hrsafety.navigation.outcomes import OUTCOMES as RUNS

MODELS = (
    nav.crowd.CollisionFreeSpeed(),
    nav.crowd.SocialForce2000(),
    nav.crowd.ReciprocalAvoidance(),
    nav.crowd.Moussaid(),
    nav.crowd.SocialForce1995(),
)
KEPT = 0.1
"""Share of the radius that a center keeps off walls."""
ROUND = 1e-9
"""Rounding of a distance in m."""


def of(model: nav.crowd.Pedestrian) -> str:
    return type(model).__name__


def codes(run: Any) -> list[str]:
    return [each.code for each in run.warnings]


def gaps(places: np.ndarray, wall: Any) -> np.ndarray:
    """Return distances of places from a wall, negative inside."""
    if isinstance(wall, nav.Disc):
        return np.hypot(*(places - wall.center).T) - wall.radius
    if isinstance(wall, nav.Rectangle):
        way = np.abs(places - wall.center) - (0.5 * wall.length, 0.5 * wall.width)
        return np.hypot(*np.maximum(way, 0.0).T) + np.minimum(way.max(axis=-1), 0.0)
    least = np.full(len(places), np.inf)
    for start, end in itertools.pairwise(wall):
        along = np.subtract(end, start)
        share = np.clip((places - start) @ along / (along @ along), 0.0, 1.0)
        least = np.minimum(least, np.hypot(*(places - start - share[:, None] * along).T))
    return least


def room(side: float) -> list[tuple[float, float]]:
    return [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side), (0.0, 0.0)]


@pytest.mark.parametrize("model", MODELS, ids=of)
@pytest.mark.parametrize("speed", [0.7, 1.34, 2.2, 50.0])
def test_one_person_does_not_walk_through_a_wall(model: nav.crowd.Pedestrian, speed: float) -> None:
    walker = nav.Person(start=(0, 0), route=[(6, 0)], model=model, desired_speed=speed)
    run = nav.simulate(nav.World(people=[walker], walls=[[(3, -5), (3, 5)]], time_limit=10.0))
    assert (run.obstacle_position[..., 0] <= 3.0 - KEPT * 0.25 + ROUND).all()
    assert np.isnan(run.person_arrival_time).all()


def test_people_who_would_walk_through_a_wall_are_counted_and_told() -> None:
    people = [nav.Person(start=(0, 0), route=[(6, 0)], model=nav.crowd.Moussaid(), desired_speed=1.34)]
    place = nav.World(people=people, walls=[[(3, -5), (3, 5)]], time_limit=10.0)
    run = nav.simulate(place)
    assert run.wall_rescues > 0
    assert codes(run) == ["wall_rescues"]
    assert f"{run.wall_rescues} times" in run.warnings[0].message
    assert not run.warnings[0].safe_side
    # A model that keeps people off walls is not doubted.
    kept = nav.simulate(replace(place, people=[replace(people[0], model=nav.crowd.CollisionFreeSpeed())]))
    assert (kept.wall_rescues, codes(kept)) == (0, [])
    # The tables of studies say so, too.
    robot = nav.Robot(start=(-9, -9), goal=(-9, -8))
    table = nav.simulate_many(replace(place, robots=[robot]), nav.VirtualForceField())
    assert [each.code for each in table.warnings] == ["wall_rescues"]


def test_the_velocity_loses_what_leads_into_the_wall() -> None:
    walker = nav.Person(start=(0, 0), route=[(6, 4)], model=nav.crowd.Moussaid(), desired_speed=1.34)
    run = nav.simulate(nav.World(people=[walker], walls=[[(1, -50), (1, 50)]], time_limit=5.0))
    held = run.obstacle_position[:, 0, 0] > 1.0 - KEPT * 0.25 - ROUND
    assert held.sum() > 10
    assert (run.obstacle_velocity[held, 0, 0] <= ROUND).all()
    assert (run.obstacle_velocity[held, 0, 1] > 0.0).any()


def test_bodies_that_push_each_other_too_fast_are_told() -> None:
    model = nav.crowd.SocialForce2000()
    people = [nav.Person(start=(x, 0), route=[(9, 0)], model=model) for x in (0.0, 0.02)]
    run = nav.simulate(nav.World(people=people, time_limit=3.0))
    assert run.max_person_speed > 12.5
    assert codes(run) == ["people_too_fast"]
    apart = [replace(person, start=(40.0 * index, 0.0)) for index, person in enumerate(people)]
    assert codes(nav.simulate(nav.World(people=apart, time_limit=3.0))) == []


@pytest.mark.parametrize("model", MODELS, ids=of)
def test_a_closed_room_stays_closed(model: nav.crowd.Pedestrian) -> None:
    generator = np.random.default_rng(48)
    places = generator.uniform(0.3, 4.7, (48, 2)).tolist()
    people = [nav.Person(start=tuple(place), route=[(12, 2.5)], model=model) for place in places]
    run = nav.simulate(nav.World(people=people, walls=[room(5.0)], time_limit=20.0))
    inside = (run.obstacle_position > KEPT * 0.25 - ROUND) & (run.obstacle_position < 5.0 - KEPT * 0.25 + ROUND)
    assert inside.all()


SIDE = 6.0


@st.composite
def walls_in_a_room(draw: st.DrawFn) -> list[Any]:
    """Draw what stands in a room: bars of the room as lines or blocks, and discs, blocks and lines inside."""
    if draw(st.booleans()):
        outer: list[Any] = [room(SIDE)]
    else:
        middle, thick = 0.5 * SIDE, draw(st.floats(0.01, 0.5))
        outer = [
            nav.Rectangle(center=(middle, -0.5 * thick), length=SIDE + 2 * thick, width=thick),
            nav.Rectangle(center=(middle, SIDE + 0.5 * thick), length=SIDE + 2 * thick, width=thick),
            nav.Rectangle(center=(-0.5 * thick, middle), length=thick, width=SIDE),
            nav.Rectangle(center=(SIDE + 0.5 * thick, middle), length=thick, width=SIDE),
        ]
    inner = st.floats(1.5, SIDE - 1.5)
    place = st.tuples(inner, inner)
    kinds = st.one_of(
        place.flatmap(lambda at: st.floats(0.005, 0.6).map(lambda size: nav.Disc(center=at, radius=size))),
        st.tuples(place, st.floats(0.01, 0.8), st.floats(0.01, 0.8)).map(
            lambda each: nav.Rectangle(center=each[0], length=each[1], width=each[2])
        ),
        st.lists(place, min_size=2, max_size=4, unique=True),
    )
    return [*outer, *draw(st.lists(kinds, max_size=4))]


@settings(deadline=None, max_examples=120)
@given(
    walls=walls_in_a_room(),
    model=st.sampled_from(MODELS),
    speed=st.floats(0.1, 200.0),
    step=st.sampled_from([0.01, 0.05, 0.25, 1.0]),
    radius=st.floats(0.1, 0.5),
    seed=st.integers(0, 2**32),
)
def test_nobody_passes_walls_of_any_kind(
    walls: list[Any], model: nav.crowd.Pedestrian, speed: float, step: float, radius: float, seed: int
) -> None:
    generator = np.random.default_rng(seed)
    starts = generator.uniform(0.6, SIDE - 0.6, (12, 2))
    free = np.all([gaps(starts, wall) > KEPT * radius for wall in walls], axis=0)
    people = [
        nav.Person(
            start=tuple(start.tolist()),
            route=[tuple(generator.uniform(-3.0 * SIDE, 4.0 * SIDE, 2).tolist()) for _ in range(2)],
            model=model,
            desired_speed=speed,
            radius=radius,
            at_end="repeat",
        )
        for start in starts[free]
    ]
    place = nav.World(people=people, walls=walls, step=step, time_limit=60.0 * step)
    run = nav.simulate(place)
    assert run.diverged is None
    flat = run.obstacle_position.reshape(-1, 2)
    assert ((flat > 0.0) & (flat < SIDE)).all()
    for wall in walls:
        assert (gaps(flat, wall) > KEPT * radius - ROUND).all(), wall


# ---- lines ------------------------------------------------------------------------------------------


def crossing(**traits: Any) -> nav.Trajectory:
    given = {"start": (0.0, 0.0), "route": [((4.0, -1.0), (4.0, 1.0))], "desired_speed": 1.0, "at_end": "leave"}
    return nav.simulate(nav.World(people=[nav.Person(**(given | traits))], time_limit=20.0))


@pytest.mark.parametrize("model", MODELS, ids=of)
def test_a_line_is_passed_where_the_center_crosses_it(model: nav.crowd.Pedestrian) -> None:
    run = crossing(model=model)
    x, y = run.person_arrival_position[0]
    assert 4.0 - ROUND <= x <= 4.0 + 0.066
    assert abs(y) < 1e-6
    # Before that nobody is told to have arrived, however near.
    assert np.nanmax(run.obstacle_position[:-1, 0, 0]) < 4.0


@pytest.mark.parametrize(("start", "y"), [((0.0, 3.0), 0.75), ((0.0, -0.4), -0.4), ((3.9, -3.0), -0.75)])
def test_people_go_to_the_nearest_point_that_leaves_room_for_the_body(start: tuple[float, float], y: float) -> None:
    assert crossing(start=start).person_arrival_position[0, 1] == pytest.approx(y, abs=0.08)


def test_lines_may_follow_each_other_within_a_step() -> None:
    lines = [((x, -1.0), (x, 1.0)) for x in (1.0, 1.001, 1.002)]
    run = crossing(route=[*lines, (2.0, 0.0)])
    assert (np.diff(run.obstacle_position[:, 0, 0]) > 0.0)[:-1].all()
    assert run.person_arrival_time[0] == pytest.approx(1.7, abs=0.06)
    again = crossing(route=lines[:2], at_end="repeat")
    assert np.nanmax(np.abs(again.obstacle_position[40:, 0, 0] - 1.0)) < 0.15


def test_a_narrow_line_is_aimed_at_in_its_middle() -> None:
    run = crossing(start=(0.0, 2.0), route=[((4.0, -0.1), (4.0, 0.1))])
    assert run.person_arrival_position[0, 1] == pytest.approx(0.0, abs=0.05)


@pytest.mark.parametrize(
    ("route", "message"),
    [
        ([((1, 2), (1, 2))], r"route\[0\] must have two ends apart"),
        ([(0, 0), ((1, 2), (float("nan"), 2))], r"route\[1\]\[1\]"),
        ([((1, 2), (1, 2, 3))], r"route\[0\]\[1\]"),
        ([((1, 2), (1, 2), (3, 4))], r"route\[0\]"),
        ([5], r"route\[0\] must be a point \(x, y\) or a line"),
    ],
)
def test_lines_that_are_none_are_refused(route: list[Any], message: str) -> None:
    with pytest.raises((InvalidParameterError, ShapeError), match=message):
        nav.Person(start=(0, 0), route=route)


# ---- doors ------------------------------------------------------------------------------------------


def out(door: float, model: nav.crowd.Pedestrian | None = None) -> float:
    """Return how many people are out of the room after a minute, on average."""
    worlds = [scenarios.bottleneck(60, door=door, model=model, seed=seed, time_limit=60.0) for seed in range(6)]
    runs = simulated(worlds)
    return float(np.mean([np.sum(~(run.obstacle_position[-1, :, 0] < 8.0)) for run in runs]))


def test_a_wider_door_lets_out_more() -> None:
    counts = [out(door) for door in (0.8, 1.2, 2.0, 3.0)]
    assert counts == sorted(counts)
    assert counts[-1] > 2.0 * counts[0]


@pytest.mark.parametrize("model", MODELS, ids=of)
def test_a_wide_door_lets_out_at_least_as_many_as_a_narrow_one(model: nav.crowd.Pedestrian) -> None:
    assert out(3.0, model) >= out(1.0, model)


# ---- goals and starts in walls ----------------------------------------------------------------------


def test_goals_and_starts_inside_walls_are_named() -> None:
    block = nav.Rectangle(center=(4.0, 0.0), length=2.0, width=2.0)
    robot = nav.Robot(start=(0, 0), goal=(4.0, 0.5))
    within = nav.Person(start=(3.5, 0.0), route=[(8, 0), (4.0, -0.5)])
    bound = replace(within, start=(-3, 0), route=[(4.0, 0.0)])
    place = nav.World(people=[within, bound], robots=[robot], walls=[block])
    assert [(each.code, each.subject) for each in place.warnings] == [
        ("start_in_wall", "people[0].start"),
        ("goal_in_wall", "people[0].route[1]"),
        ("goal_in_wall", "robots[0].goal"),
    ]
    assert "1 more of this kind" in place.warnings[1].message
    assert "walls[0]" in place.warnings[0].message
    only = nav.World(robots=[robot], walls=[block])
    assert [each.subject for each in only.warnings] == ["robots[0].goal"]
    # A body that touches the wall before it arrives does not get there either; one that arrives before does.
    near = replace(robot, goal=(4.0, 1.05), arrival_tolerance=0.1)
    assert [each.code for each in nav.World(robots=[near], walls=[block]).warnings] == ["goal_in_wall"]
    assert nav.World(robots=[replace(near, goal=(4.0, 1.3))], walls=[block]).warnings == ()
    assert nav.World(people=[replace(within, start=(0, 0), route=[(8, 0)])], walls=[block]).warnings == ()


# ---- one word list ----------------------------------------------------------------------------------


def test_outcomes_of_a_run_are_those_of_the_table() -> None:
    law = nav.VirtualForceField()
    laws = [law, nav.OptimalReciprocalCollisionAvoidance()]
    worlds = [scenarios.circle_crossing(case, law=each, visible=False) for case in range(12) for each in laws]
    # Somebody walks into a robot that stands.
    walker = nav.Person(start=(3, 0), route=[(-3, 0)], awareness=0.0)
    standing = nav.Robot(start=(0, 0), goal=(0.1, 0.0))
    worlds.append(nav.World(people=[walker], robots=[standing], time_limit=8.0))
    worlds.append(nav.World(people=[walker], robots=[replace(standing, goal=(9, 0))], time_limit=8.0))
    words = [nav.simulate(world).outcomes[0] for world in worlds]
    told = [nav.simulate_many(world, world.robots[0].law or nav.VirtualForceField()) for world in worlds[:-2]]
    assert words[:-2] == [table.outcome[0] for table in told]
    assert "collided" in words[:-2]
    # Who arrives is at the goal from the start; who does not is touched.
    assert words[-2:] == ["arrived", "collided"]


def test_worlds_and_environments_have_one_list_of_words() -> None:
    assert set(OUTCOMES) - {"running"} == set(RUNS) - {"stopped"}


def test_arrival_times_say_whose_they_are() -> None:
    run = nav.simulate(scenarios.circle_crossing(0, law=nav.OptimalReciprocalCollisionAvoidance()))
    assert run.person_arrival_time.shape == (5,)
    assert run.robot_arrival_time.shape == (1,)
    assert run.arrival_time == run.robot_arrival_time[0]
    many = nav.simulate(scenarios.antipodal(4, robots=2, law=nav.Khatib(), time_limit=1.0))
    with pytest.raises(AttributeError, match=r"2 robots has no 'arrival_time': take run.robots\[i\].arrival_time"):
        _ = many.arrival_time
    assert [each.arrival_time for each in many.robots] == pytest.approx(many.robot_arrival_time, nan_ok=True)
