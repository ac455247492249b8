"""Contacts: who moved toward whom, who is at fault, and what happens between two motion steps."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import gym
from hrsafety import navigation as nav
from hrsafety.navigation.crowd.contacts import contacts_of

ROBOT = nav.HolonomicRobot(radius=0.2, max_speed=3.0, max_acceleration=1000.0)
RULES = {"control_period": 0.01, "time_limit": 4.0, "arrival_tolerance": 0.05}
OPEN = {"active_clearance": 0.02, "critical_clearance": 0.01}
FAR = (50.0, 0.0)


class Driven:
    """A law that keeps a velocity from an instant on, and another one before."""

    def __init__(self, *legs: tuple[float, tuple[float, float]]) -> None:
        self.legs = legs

    def velocity(self, seen: nav.Situation) -> tuple[float, float]:
        """Return the velocity of the last leg that has begun."""
        return [velocity for begin, velocity in self.legs if begin <= seen.time + 1e-9][-1]


def always(*velocity: float) -> Driven:
    return Driven((0.0, velocity))  # type: ignore[arg-type]


def person(start: tuple[float, float], velocity: tuple[float, float], radius: float = 0.3) -> nav.MovingDisc:
    return nav.MovingDisc(center=start, velocity=velocity, radius=radius, **OPEN)


def scene(*obstacles: nav.Obstacle, **rules: float) -> nav.Scenario:
    return nav.Scenario(start=(0.0, 0.0), goal=FAR, obstacles=obstacles, robot=ROBOT, **(RULES | rules))


def kinds(run: nav.Trajectory | nav.RunTable) -> list[int]:
    names = ("toward", "away", "standing", "at_fault")
    return [int(np.sum(getattr(run, f"contacts_{name}"))) for name in names]


# ---- at fault --------------------------------------------------------------------------------


def test_who_is_touched_from_behind_while_retreating_and_walked_through_is_not_at_fault() -> None:
    place = scene(person((-2.0, 0.0), (1.6, 0.0)))
    run = nav.simulate(place, always(0.5, 0.0))
    # The person ends ahead of the robot: that is no fault of it.
    assert run.distance[-1, 0] > 1.0
    assert run.min_clearance[0] < -0.4
    assert (kinds(run), run.contact_toward.tolist(), run.contact_at_fault.tolist()) == ([0, 1, 0, 0], [False], [False])
    assert kinds(nav.simulate_batch([place], nav.laws.PythonLaw(function=always(0.5, 0.0)))) == [0, 1, 0, 0]


def test_a_robot_that_moves_into_somebody_is_at_fault_and_one_that_stands_is_not() -> None:
    place = scene(person((2.0, 0.0), (-0.5, 0.0)))
    assert kinds(nav.simulate(place, always(0.5, 0.0))) == [1, 0, 0, 1]
    assert kinds(nav.simulate(place, always(0.0, 0.0))) == [0, 0, 1, 0]
    # At 0.05 m/s and below it counts as standing.
    assert kinds(nav.simulate(place, always(0.049, 0.0))) == [0, 0, 1, 0]


def test_a_robot_that_turns_toward_somebody_who_overlaps_little_is_at_fault() -> None:
    # Touched from behind at about 0.94 s, overlapping by 0.1 m about 0.09 s later.
    place = scene(person((-1.5, 0.0), (1.6, 0.0)))
    first = nav.simulate(place, always(0.5, 0.0)).contact_time[0]
    assert kinds(nav.simulate(place, Driven((0.0, (0.5, 0.0)), (first + 0.03, (-0.5, 0.0))))) == [0, 1, 0, 1]
    assert kinds(nav.simulate(place, Driven((0.0, (0.5, 0.0)), (first + 0.15, (-0.5, 0.0))))) == [0, 1, 0, 0]


@settings(max_examples=60, deadline=None)
@given(
    angle=st.floats(-math.pi, math.pi),
    own=st.floats(0.06, 1.0),
    other=st.floats(0.0, 2.0),
    bearing=st.floats(-math.pi, math.pi),
    miss=st.floats(-0.45, 0.45),
)
def test_toward_and_at_fault_are_what_the_instants_of_a_run_show(
    angle: float, own: float, other: float, bearing: float, miss: float
) -> None:
    course = np.array([math.cos(angle), math.sin(angle)])
    aim = np.array([math.cos(bearing), math.sin(bearing)])
    start = 1.2 * aim + miss * np.array([-aim[1], aim[0]])
    place = scene(person(tuple(start), tuple(-other * aim)))
    run = nav.simulate(place, always(*(own * course)))
    overlap = 0.5 - run.distance[:, 0]
    touching = np.flatnonzero(overlap >= 0.0)
    assert kinds(run)[0] + kinds(run)[1] == (len(touching) > 0)
    if len(touching) == 0:
        return
    deep = np.flatnonzero(overlap >= 0.1)
    counted = touching[touching < (deep[0] if len(deep) else len(overlap))]
    ahead = np.einsum("ij,ij->i", run.velocity, run.obstacle_position[:, 0] - run.position)
    if np.abs(ahead[counted]).min(initial=1.0) < 1e-6:
        return  # sideways to rounding
    assert bool(run.contact_toward[0]) == (ahead[touching[0]] > 0.0)
    assert bool(run.contact_at_fault[0]) == bool((ahead[counted] > 0.0).any())


def test_an_adversary_who_walks_through_makes_nobody_at_fault() -> None:
    place = nav.Scenario(start=(0.0, 0.0), goal=(8.0, 0.0), time_limit=12.0, rest_time=12.0)
    law = nav.OptimalReciprocalCollisionAvoidance()
    found = nav.metrics.falsify(place, law, episodes=200)
    touched = found.min_clearance <= 0.0
    counts = found.contacts_toward + found.contacts_away + found.contacts_standing
    assert touched.sum() > 50
    assert np.array_equal(counts > 0, touched)
    assert found.contacts_away.sum() > found.contacts_toward.sum()
    # By the last instants of a contact three of four were at fault.
    assert found.share.value < 0.1
    assert ((found.margin < 0.0) <= touched).all()


# ---- between two motion steps ----------------------------------------------------------------

WALL = nav.maps.StaticMap.from_polylines([[(3.5, -2.0), (3.5, 2.0)]])
THROUGH = Driven((0.0, (2.5, 0.0)))


def walled() -> list[tuple[nav.Scenario, nav.AnyLaw]]:
    rules = RULES | {"control_period": 0.4, "time_limit": 8.0, "arrival_tolerance": 0.3}
    thin = nav.Rectangle(center=(3.5, 0.0), length=0.02, width=4.0, **OPEN)
    common = {"start": (0.0, 0.0), "goal": (7.0, 0.0), "robot": dataclasses.replace(ROBOT, max_speed=2.5), **rules}
    known = nav.SafeNavigation(THROUGH, map=WALL)
    return [(nav.Scenario(**common), known), (nav.Scenario(obstacles=[thin], **common), THROUGH)]


@pytest.mark.parametrize(("place", "law"), walled(), ids=["map", "rectangle"])
def test_a_robot_does_not_pass_a_thin_wall_between_two_motion_steps(place: nav.Scenario, law: nav.AnyLaw) -> None:
    run = nav.simulate(place, law, step=0.4)
    assert not np.any(np.abs(run.position[:, 0] - 3.5) < 0.2)
    assert (run.outcome, run.contacts_at_fault) == ("collided", 1)
    time = run.contact_time[0] if len(run.contact_time) else run.map_contact_time
    assert time == pytest.approx((3.3 - (0.01 if place.obstacles else 0.0)) / 2.5, abs=1e-6)
    stepped = nav.Run(place, law, step=0.4)
    while not stepped.finished:
        stepped.step()
    assert stepped.outcome == "collided"
    built = nav.simulate(place, law, built=nav.robots.AsBuilt(), step=0.4)
    many = nav.simulate_many([place], [law], step=0.4)
    assert (built.outcome, many.outcome.tolist()) == ("collided", ["collided"])
    ended = nav.simulate(place, law, step=0.4, stop_on_contact=True)
    assert ended.position[-1, 0] == pytest.approx(4.0)


@settings(max_examples=80, deadline=None)
@given(
    own=st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)),
    other=st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)),
    start=st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)),
    step=st.sampled_from([0.1, 0.25, 0.5, 1.0]),
)
def test_contacts_of_straight_ways_are_found_whatever_the_step(
    own: tuple[float, float], other: tuple[float, float], start: tuple[float, float], step: float
) -> None:
    if math.hypot(*start) < 0.55:
        return
    robot = dataclasses.replace(ROBOT, max_speed=5.0, max_acceleration=1e6)
    place = dataclasses.replace(scene(person(start, other), control_period=step), robot=robot)
    run = nav.simulate(place, always(*own), step=step)
    # Straight from the start on: the acceleration has no bound worth the name.
    way = np.array(other) - np.array(own)
    square = float(way @ way)
    share = min(max(-float(np.array(start) @ way) / square, 0.0), run.time[-1]) if square > 0.0 else 0.0
    least = float(np.linalg.norm(np.array(start) + share * way))
    if abs(least - 0.5) < 1e-6:
        return
    assert np.isfinite(run.contact_time[0]) == (least < 0.5)
    assert (run.min_clearance[0] <= 0.0) == (least < 0.5)
    if least < 0.5:
        along, across = float(np.array(start) @ way), float(np.array(start) @ np.array(start))
        first = (-along - math.sqrt(along * along - square * (across - 0.25))) / square
        assert first - 1e-6 <= run.contact_time[0] <= first + step + 1e-6
        speed = math.hypot(*own)
        ahead = float(np.array(own) @ (np.array(start) + first * way))
        if speed > 0.051 and abs(ahead) > 0.05 and step == 0.1:
            assert bool(run.contact_toward[0]) == (ahead > 0.0)


@pytest.mark.parametrize("step", [0.1, 0.5])
def test_lanes_find_the_contacts_that_single_runs_find(step: float) -> None:
    rng = np.random.default_rng(5)
    shape = (200, 4)
    position = np.stack([rng.uniform(1.0, 9.0, shape), rng.uniform(-3.0, 3.0, shape)], axis=-1)
    velocity = rng.normal(0.0, 4.0, (*shape, 2))
    rules = {"control_period": step, "time_limit": 15.0, "arrival_tolerance": 0.3}
    robot = nav.HolonomicRobot(radius=0.3, max_speed=1.0)
    many = nav.Scenarios.from_arrays(
        start=(0.0, 0.0),
        goal=(10.0, 0.0),
        obstacle_position=position,
        obstacle_velocity=velocity,
        obstacle_radius=0.3,
        person=False,
        robot=robot,
        **rules,
    )
    law = nav.VirtualForceField()
    table = nav.simulate_many(many, law, step=step)
    runs = [nav.simulate(place, law, step=step) for place in many]
    assert table.outcome.tolist() == [run.outcome for run in runs]
    assert np.array_equal(table.min_distance, [run.min_distance for run in runs])
    for name in ("toward", "away", "standing", "at_fault"):
        column = f"contacts_{name}"
        assert getattr(table, column).tolist() == [getattr(run, column) for run in runs], name
    hidden = [np.isfinite(run.contact_time) & ~(run.distance < 0.6).any(axis=0) for run in runs]
    assert sum(map(np.sum, hidden)) > (10 if step == 0.5 else 0)


def test_a_loop_that_begins_again_sweeps_nothing() -> None:
    loop = nav.MovingDisc.from_path(
        [0.0, 2.0, 2.000001, 4.0], [(2.0, 1.0), (2.0, 3.0), (-3.0, 0.0), (-3.0, 1.0)], radius=0.3, max_speed=1.0, **OPEN
    )
    run = nav.simulate(scene(loop, time_limit=3.0), always(0.2, 0.5), step=0.01)
    assert (run.outcome, run.contacts_moving + run.contacts_standing) == ("timed_out", 0)


# ---- people who appear where the robot is ----------------------------------------------------


def appearing(begin: float, after: tuple[float, float] = (0.0, 0.0)) -> nav.MovingDisc:
    """Return somebody who appears 0.3 m ahead of the start and leaves to the side, and comes back as is said."""
    time = [begin, begin + 1.0, begin + 2.0, begin + 3.0]
    return nav.MovingDisc.from_path(time, [(0.3, 0.0), (0.3, 3.0), after, after], radius=0.3, **OPEN)


def test_who_appears_where_the_robot_is_is_counted_apart() -> None:
    run = nav.simulate(scene(appearing(0.5, (30.0, 30.0))), always(0.2, 0.0))
    assert (run.contacts_apart, kinds(run), run.outcome) == (1, [0, 0, 0, 0], "timed_out")
    assert math.isnan(run.contact_time[0])
    assert run.min_clearance[0] < 0.0
    table = nav.simulate_batch([scene(appearing(0.5, (30.0, 30.0)))], nav.VirtualForceField(attractive_gain=0.1))
    assert (table.contacts_apart.tolist(), kinds(table)) == ([1], [0, 0, 0, 0])
    # Who is there from the start on is not, and who comes back is touched like anybody else.
    assert nav.simulate(scene(appearing(0.5, (0.5, 0.0))), always(0.2, 0.0)).outcome == "collided"


def test_people_of_a_world_who_appear_where_the_robot_is_are_counted_apart() -> None:
    own = np.linspace([0.0, 0.0], [2.0, 0.0], 41)
    path = np.full((41, 1, 2), np.nan)
    path[10:] = own[10:, None] + (0.1, 0.0)
    rules = {"step": 0.05, "goal": FAR, "robot_radius": 0.2, "person_radius": 0.3}
    found = contacts_of(nav.metrics.Episode(position=own, people=path, **rules), math.nan)
    assert found == (0, 0, 0, 0, 1)
    there = contacts_of(nav.metrics.Episode(position=own, people=own[:, None] + (0.1, 0.0), **rules), math.nan)
    assert there == (0, 0, 1, 0, 0)  # they overlap from the start on, where the robot stands


# ---- worlds, metrics, environments -----------------------------------------------------------


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_contacts_of_positions_are_those_of_fine_positions(seed: int) -> None:
    rng = np.random.default_rng(seed)
    own = np.cumsum(rng.normal(0.0, 0.3, (12, 2)), axis=0)
    people = np.cumsum(rng.normal(0.0, 0.6, (12, 3, 2)), axis=0) + rng.uniform(-2.0, 2.0, (3, 2))
    rules = {"goal": FAR, "robot_radius": 0.2, "person_radius": 0.2}
    coarse = nav.metrics.Episode(position=own, people=people, step=0.5, **rules)
    share = np.arange(500)[:, None, None] / 500

    def fine(path: np.ndarray) -> np.ndarray:
        steps = path[:-1] + share[..., None] * np.diff(path, axis=0) if path.ndim == 3 else None
        dense = path[:-1] + share * np.diff(path, axis=0) if steps is None else steps
        return np.concatenate([np.moveaxis(dense, 0, 1).reshape(-1, *path.shape[1:]), path[-1:]])

    dense = nav.metrics.Episode(position=fine(own), people=fine(people), step=0.001, **rules)
    found, expected = contacts_of(coarse, math.nan), contacts_of(dense, math.nan)
    touched = nav.metrics.evaluate(coarse)
    counts = touched.robot_on_person + touched.person_on_robot + touched.mutual_contacts
    assert (counts > 0) == (found.moving + found.standing > 0)
    assert (touched.min_clearance < 0.0) == (found.moving + found.standing > 0)
    gap = abs(nav.metrics.evaluate(dense).min_clearance)
    if gap > 1e-3:
        assert found.moving + found.standing == expected.moving + expected.standing
        assert (found.toward, found.away) == (expected.toward, expected.away)


def test_an_environment_ends_where_its_robot_passes_a_wall() -> None:
    robot = nav.Robot(
        start=(0.0, 0.0),
        goal=(9.0, 0.0),
        body=nav.HolonomicRobot(radius=0.1, max_speed=2.5, max_acceleration=1000.0),
        control_period=0.5,
    )
    ends = []
    for walls in ([], [[(3.0, -5.0), (3.0, 5.0)]]):
        world = nav.World(robots=[robot], walls=walls, step=0.5, time_limit=3.0)
        environment = gym.CrowdVectorEnv(world, num_envs=1, autoreset_mode="Disabled")
        environment.reset(seed=0)
        steps = [environment.step(np.array([[1.0, 0.0]], dtype=np.float32)) for _ in range(3)]
        ends.append([bool(step[2][0]) for step in steps])
    # At 1.25, 2.5 and 3.75 m.
    assert ends == [[False] * 3, [False, False, True]]


@pytest.mark.parametrize("speed", [1.0, 2.5])
def test_a_world_counts_a_wall_that_is_passed_between_its_instants(speed: float) -> None:
    own = np.arange(0.0, 6.0, 0.4 * speed)[:, None] * (1.0, 0.0)
    rules = {"step": 0.4, "goal": FAR, "robot_radius": 0.1}
    found = nav.metrics.evaluate(nav.metrics.Episode(position=own, walls=[[(2.9, -2.0), (2.9, 2.0)]], **rules))
    assert (found.wall_contacts, found.success, found.wall_clearance < 0.0) == (1, False, True)
