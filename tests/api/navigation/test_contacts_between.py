"""Contacts that no instant shows are told: people who pass through a robot between two of them."""

from __future__ import annotations

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.benchmarks import benchmark
from hrsafety.navigation.metrics.between import CONTACT_BETWEEN, touched_between

STEP = 0.25


def episode(seed: int, period: tuple[float, float] = (0.0, 0.0)) -> nav.metrics.Episode:
    """Return a robot among people that all move by large steps, one of whom is absent for a while."""
    rng = np.random.default_rng(seed)
    walk = np.cumsum(rng.normal(0.0, 0.6, (20, 4, 2)), axis=0) + rng.uniform(-3.0, 3.0, (4, 2))
    walk[5:9, 3] = np.nan
    own = np.cumsum(rng.normal(0.0, 0.3, (20, 2)), axis=0)
    return nav.metrics.Episode(
        position=own, step=STEP, goal=(50.0, 0.0), robot_radius=0.2, people=walk, person_radius=0.2, period=period
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


def test_a_short_step_shows_the_contact_and_needs_no_warning() -> None:
    time = np.linspace(0.0, 1.0, 101)
    own, person = np.outer(time, (2.0, 0.0)), np.array((2.0, 0.1)) - np.outer(time, (2.0, 0.0))
    rules = {"goal": (9.0, 0.0), "robot_radius": 0.2, "person_radius": 0.2}
    fine = nav.metrics.evaluate(own, person[:, None], step=0.01, **rules)
    coarse = nav.metrics.evaluate(own[::100], person[::100, None], step=1.0, **rules)
    assert (fine.mutual_contacts, fine.warnings) == (1, ())
    assert coarse.mutual_contacts + coarse.robot_on_person + coarse.person_on_robot == 0
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
    for found in (nav.simulate_many(worlds, law), nav.crowd.crowd_batch(worlds)):
        assert [each.code for each in found.warnings] == [CONTACT_BETWEEN]
    result = benchmark("circle_crossing", ["orca"], cases=32)
    assert [each.code for each in result.warnings] == [CONTACT_BETWEEN]
    assert "orca 1 of 32" in str(result.warnings[0])
