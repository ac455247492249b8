"""Contacts that no instant shows are counted and told: people who pass through a robot between two of them."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.benchmarks import benchmark
from hrsafety.navigation.metrics.between import CONTACT_BETWEEN, touched_between, walls_between
from hrsafety.plausibility import gathered

STEP = 0.25


def episode(seed: int, period: tuple[float, float] = (0.0, 0.0)) -> nav.metrics.Episode:
    """Return a robot among people that all move by large steps, one of whom is absent for a while."""
    rng = np.random.default_rng(seed)
    walk = np.cumsum(rng.normal(0.0, 0.6, (20, 4, 2)), axis=0) + rng.uniform(-3.0, 3.0, (4, 2))
    walk[5:9, 3] = np.nan
    own = np.cumsum(rng.normal(0.0, 0.3, (20, 2)), axis=0)
    return nav.metrics.Episode(
        position=own,
        step=STEP,
        goal=(50.0, 0.0),
        robot_radius=0.2,
        people=walk,
        person_radius=0.2,
        period=period,
        simulated=True,
    )


def finely(given: nav.metrics.Episode) -> int:
    """Return who touches the robot at 2,000 places between instants, and at none of them."""
    own, people = np.asarray(given.position), np.asarray(given.people)
    share = np.linspace(0.0, 1.0, 2001)[:, None, None]
    found = 0
    for person in range(people.shape[1]):
        gaps = []
        for start in range(len(own) - 1):
            ways = [people[start, person] - own[start], people[start + 1, person] - own[start + 1]]
            gaps.append(np.linalg.norm(ways[0] + share[:, 0] * (ways[1] - ways[0]), axis=1) - 0.4)
        between, shown = np.nanmin(np.array(gaps)), np.nanmin(np.linalg.norm(people[:, person] - own, axis=1)) - 0.4
        found += bool(between < 0.0 <= shown)
    return found


@pytest.mark.parametrize("seed", range(30))
def test_who_passes_through_is_found_as_by_small_steps(seed: int) -> None:
    given = episode(seed)
    scores = nav.metrics.evaluate(given)
    found = touched_between(given, scores.arrival_time, scores.min_time_to_collision).people
    assert found == finely(given)
    assert (CONTACT_BETWEEN in [each.code for each in scores.warnings]) == (found > 0)


def test_the_draws_have_both_cases() -> None:
    found = [finely(episode(seed)) for seed in range(30)]
    assert 0 in found
    assert max(found) > 0


def test_a_contact_between_instants_counts_and_a_short_step_shows_it_without_a_warning() -> None:
    time = np.linspace(0.0, 1.0, 101)
    own, person = np.outer(time, (2.0, 0.0)), np.array((2.0, 0.1)) - np.outer(time, (2.0, 0.0))
    rules = {"goal": (9.0, 0.0), "robot_radius": 0.2, "person_radius": 0.2}
    fine = nav.metrics.evaluate(own, person[:, None], step=0.01, **rules)
    coarse = nav.metrics.evaluate(own[::100], person[::100, None], step=1.0, **rules)
    assert (fine.mutual_contacts, fine.warnings) == (1, ())
    assert (coarse.mutual_contacts, coarse.robot_on_person + coarse.person_on_robot, coarse.success) == (1, 0, False)
    assert coarse.min_clearance == pytest.approx(fine.min_clearance, abs=1e-3)
    assert coarse.warnings[0].safe_side
    assert [each.code for each in coarse.warnings] == [CONTACT_BETWEEN]
    assert "by up to 0.3 m" in str(coarse.warnings[0])


def test_an_edge_where_the_world_repeats_is_no_way_through_it() -> None:
    rules = {"step": 1.0, "goal": (9.0, 9.0), "robot_radius": 0.2, "person_radius": 0.2, "period": (10.0, 0.0)}
    people = [[[9.8, 0.0]], [[10.3, 0.0]]]
    assert nav.metrics.evaluate([[5.0, 0.0], [5.0, 0.0]], people, **rules).warnings == ()
    assert len(nav.metrics.evaluate([[0.05, 1.0], [0.05, -1.0]], people, **rules).warnings) == 1


def test_tables_and_suites_tell_of_it() -> None:
    law = nav.OptimalReciprocalCollisionAvoidance()
    worlds = [scenarios.circle_crossing(case, law=law) for case in (31, 32)]
    for found in (nav.simulate_many(worlds, law), nav.simulate_many(worlds)):
        assert [each.code for each in found.warnings] == [CONTACT_BETWEEN]
    result = benchmark("circle_crossing", ["orca"], cases=32)
    assert [each.code for each in result.warnings] == [CONTACT_BETWEEN]
    assert "orca 1 of 32" in str(result.warnings[0])


def walled(seed: int) -> nav.metrics.Episode:
    """Return a robot that goes by large steps among a polyline, a thin disc and a thin rectangle."""
    rng = np.random.default_rng(seed)
    walls = [
        rng.uniform(-3.0, 3.0, (3, 2)),
        nav.Disc(center=tuple(rng.uniform(-3.0, 3.0, 2).tolist()), radius=0.05),
        nav.Rectangle(
            center=tuple(rng.uniform(-3.0, 3.0, 2).tolist()), length=0.3, width=0.1, heading=rng.uniform(-3, 3)
        ),
    ]
    own = np.cumsum(rng.normal(0.0, 0.6, (15, 2)), axis=0)
    return nav.metrics.Episode(position=own, walls=walls, step=1.0, goal=(50.0, 0.0), robot_radius=0.15)


def steps_through(given: nav.metrics.Episode) -> int:
    """Return the steps with a wall at one of 2,000 places in between, and at neither end."""
    rules = {"walls": given.walls, "step": 1.0, "goal": (50.0, 0.0), "robot_radius": 0.15}

    def least(places: np.ndarray) -> float:
        return float(nav.metrics.evaluate(places, **rules).wall_clearance)

    def alone(*places: np.ndarray) -> float:
        return min(least(np.array([place, place])) for place in places)

    steps = itertools.pairwise(np.asarray(given.position))
    return sum(least(np.linspace(a, b, 2001)) < 0.0 <= alone(a, b) for a, b in steps)


def test_walls_within_steps_are_found_as_by_small_steps() -> None:
    found = []
    for seed in range(40):
        scores = nav.metrics.evaluate(walled(seed))
        found.append(walls_between(walled(seed), scores.arrival_time, scores.wall_clearance).people)
        assert found[-1] == steps_through(walled(seed))
        assert (CONTACT_BETWEEN in [each.code for each in scores.warnings]) == (found[-1] > 0)
    assert 0 < sum(map(bool, found)) < len(found)


def test_a_table_tells_what_each_of_its_episodes_tells() -> None:
    rules = {"position": np.zeros((3, 2)), "step": 0.5, "goal": (9.0, 0.0), "robot_radius": 0.3}
    near = {"people": [[[2.0, 0.1]], [[0.0, 0.1]], [[-2.0, 0.1]]]}
    odd = (
        {"step": 500.0},
        {"robot_radius": 300.0},
        {"person_radius": [25.0], **near},
        {"person_radius": [1e-3], **near},
    )
    both = {"people": [[[-20.0, 0.1]], [[20.0, 0.1]], [[20.0, 0.1]]]}
    far = ({"people": [[[0.0, 3.0]], [[8.0, 3.0]], [[x, 3.0]]]} for x in (12.6, 12.4))
    episodes = [
        *(episode(seed) for seed in range(30)),
        *(episode(seed, (5.0, 0.0)) for seed in range(30)),
        *(walled(seed) for seed in range(40)),
        *(nav.metrics.Episode(**{**rules, "simulated": True, **given}) for given in (*odd, *far, near, both)),
    ]
    alone = [(f"episodes[{index}]", nav.metrics.evaluate(each).warnings) for index, each in enumerate(episodes)]
    expected = gathered(alone, "episodes")
    assert sorted(map(str, nav.metrics.evaluate_many(episodes).warnings)) == sorted(map(str, expected))
    assert {each.code for each in expected} == {CONTACT_BETWEEN, "implausible"}
    assert {len(found) for _, found in alone} == {0, 1, 2}


def test_a_contact_that_no_kept_row_of_a_run_shows_is_told() -> None:
    disc = nav.Disc(center=(2.0, 0.2), radius=0.1, active_radius=0.5, critical_radius=0.35)
    person = nav.Human(start=(2.0, 1.9), velocity=(0.0, -0.6), radius=0.3, active_radius=1.2, critical_radius=0.7)
    for obstacle in (disc, person):
        scene = nav.Scenario(start=(0.0, 0.0), goal=(4.0, 0.0), obstacles=[obstacle], time_limit=20.0)
        runs = [
            nav.simulate(scene, lambda seen: 5.0 * (np.array(seen.goal) - seen.position), every=k) for k in (1, 2000)
        ]
        assert np.isfinite([run.contact_time[0] for run in runs]).all()
        every, few = map(nav.metrics.evaluate, runs)
        assert not every.success
        assert [each.subject for each in few.warnings if each.code == CONTACT_BETWEEN][:1] == ["every"]
        assert "obstacles[0] at" in str(next(each for each in few.warnings if each.subject == "every"))


@pytest.mark.parametrize("touched", [0, 1])
def test_an_outline_that_touches_one_of_several_people_is_counted(touched: int) -> None:
    outline = nav.robots.Footprint.rectangle(0.8, 0.5)
    places = [(0.0, 5.0), (0.0, 6.0)]
    places[touched] = (2.0, 0.0)
    robot = nav.Robot(nav.DifferentialDriveRobot(footprint=outline), start=(0.0, 0.0), goal=(4.0, 0.0))
    world = nav.World(people=[nav.Person(start=place) for place in places], robots=[robot], time_limit=10.0)
    run = nav.simulate(world, lambda seen: 20.0 * (seen.goal - seen.position) - 40.0 * seen.velocity)
    assert (run.outcome, run.contacts_at_fault) == ("collided", 1)
