"""Absence is not clearance: who is lost while the robot is near leaves metrics open, and success is not claimed."""

from __future__ import annotations

import math
import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import datasets
from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.plausibility import unsafe_doubts

STEP = 0.1
RULES: dict[str, Any] = {"step": STEP, "goal": (6.0, 0.0), "robot_radius": 0.3}
PATH = np.linspace([0.0, 0.0], [6.0, 0.0], 61)
"""A robot at 1 m/s."""
FLAGS = {"arrived", "success", "frozen"}
SEEN = "contacts are counted where people are seen only"


def standing(*places: tuple[float, float]) -> np.ndarray:
    return np.repeat(np.array(places, dtype=float)[None], len(PATH), axis=0)


def codes(found: Any) -> list[str]:
    return [each.code for each in found.warnings]


def test_who_is_lost_while_the_robot_drives_over_the_place_is_no_success() -> None:
    people = standing((3.0, 0.0))
    people[22:38] = np.nan  # 1.6 s, in which the robot passes the place
    found = nav.metrics.evaluate(PATH, people, **RULES)
    assert found.arrived
    assert not found.success
    assert math.isnan(found.spl)
    assert math.isnan(found.min_clearance)
    assert math.isnan(found.max_closing_speed)
    (doubt,) = unsafe_doubts(found.warnings)
    assert doubt.code == "not_scored"
    assert "people[0] is not seen from 2.2 to 3.7 s and may have been touched" in doubt.message
    assert SEEN in doubt.message
    assert nav.metrics.evaluate(PATH, people, **RULES, simulated=True).success


def test_who_is_never_seen_is_no_success() -> None:
    found = nav.metrics.evaluate(PATH, np.full((61, 2, 2), np.nan), **RULES)
    assert not found.success
    assert "people[0] is never seen (1 more person is not seen at times)" in found.warnings[0].message
    unscored = {name for name, value in found.to_dict().items() if isinstance(value, float) and math.isnan(value)}
    assert {"min_clearance", "min_time_to_collision", "comfort_share", "personal_share", "social_work"} <= unscored
    assert found.path_length == pytest.approx(5.8)  # the way itself is known


def test_who_is_lost_for_good_beside_the_robot_is_a_doubt() -> None:
    people = standing((3.0, 0.0))
    people[25:] = np.nan
    (doubt,) = unsafe_doubts(nav.metrics.evaluate(PATH, people, **RULES).warnings)
    assert doubt.code == "not_scored"
    assert "people[0] may have been touched at" in doubt.message
    assert not nav.metrics.evaluate(PATH, people, **RULES, simulated=True).warnings
    # Whoever is lost far away has left before the robot comes there.
    people = standing((5.9, 3.0))
    people[5:] = np.nan
    found = nav.metrics.evaluate(PATH, people, **RULES)
    assert found.success
    assert not found.warnings


def test_a_short_gap_far_away_leaves_little_open() -> None:
    people = standing((3.0, 14.0), (3.0, 1.5))
    alone = nav.metrics.evaluate(PATH, people[:, 1:], **RULES)
    people[20:23, 0] = np.nan
    found = nav.metrics.evaluate(PATH, people, **RULES)
    assert found.success
    assert (found.min_clearance, found.personal_share) == (alone.min_clearance, alone.personal_share)
    # Nobody is on a collision course but, perhaps, who is not seen.
    assert math.isnan(found.min_time_to_collision)
    assert "min_time_to_collision is not scored" in found.warnings[0].message
    # With somebody on one the gap says nothing.
    people[:, 1] = PATH[::-1] + np.array([0.0, 0.1])
    found = nav.metrics.evaluate(PATH, people, **RULES)
    assert "not_scored" not in codes(found)


@settings(max_examples=150, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), first=st.integers(1, 39), length=st.integers(1, 20))
def test_no_way_within_the_speed_changes_a_metric_that_is_scored(seed: int, first: int, length: int) -> None:
    """Fill the gap with some way that the person may have gone: what is scored is the same, success is not claimed."""
    rng = np.random.default_rng(seed)
    speed = rng.uniform(0.0, 1.6)
    heading = rng.uniform(-math.pi, math.pi) + np.cumsum(rng.normal(0.0, 0.3, 61))
    way = rng.uniform((0.0, -3.0), (6.0, 3.0)) + np.cumsum(
        speed * STEP * np.stack([np.cos(heading), np.sin(heading)], axis=1), axis=0
    )
    people = np.stack([way, way + np.array([0.0, 5.0])], axis=1)
    lost = people.copy()
    lost[first : first + length, 0] = np.nan
    rules = {**RULES, "groups": [0, 0] if rng.random() < 0.3 else ()}
    truth = nav.metrics.evaluate(PATH, people, **rules)
    scored = nav.metrics.evaluate(PATH, lost, **rules)
    if scored.success:
        assert truth.success
    counts = {"robot_on_person", "person_on_robot", "mutual_contacts", "people_blocked"}
    # Their values belong to all instants; the gap is told where it can matter.
    small = {"mean_clearance", *("force_on_people", "force_on_robot", "social_work")}
    for name, value in scored.to_dict().items():
        if name in counts | FLAGS or (isinstance(value, float) and math.isnan(value)):
            continue
        near = {"rel": 1e-2, "abs": 1e-5} if name in small else {"rel": 1e-9, "abs": 1e-9}
        assert getattr(truth, name) == pytest.approx(value, **near), name
    (table,) = (nav.metrics.evaluate_many([nav.metrics.Episode(position=PATH, people=lost, **rules)]),)
    assert table[0] == scored
    assert [each.split(": ", 1)[1] for each in map(str, table.warnings)] == [
        f"episodes[0]: {each.message}" for each in scored.warnings
    ]


def test_gaps_of_recordings_are_not_bridged() -> None:
    time_s = STEP * np.arange(61)
    rows = [(t, 1, *place) for t, place in zip(time_s, PATH, strict=True)]
    rows += [(t, 2, 3.0, 0.0) for t in time_s if not 2.15 < t < 3.75]
    rows += [(t, 3, 3.0, 4.0) for t in time_s]
    rows.sort()
    table = np.array(rows)
    recording = datasets.Recording(time_s=table[:, 0], person=table[:, 1].astype(int), position=table[:, 2:])
    assert recording.warnings == ()
    found = nav.metrics.evaluate(recording, robot=1, step=STEP, robot_radius=0.3)
    assert not found.success
    assert codes(found) == ["not_scored"]
    other = nav.metrics.evaluate(recording, robot=3, step=STEP, robot_radius=0.3)
    assert other.success
    assert codes(other) == []


def test_runs_know_who_is_absent() -> None:
    leaving = nav.Human.from_path([0.0, 1.0], [(3.0, 0.0), (3.0, 0.5)])
    run = nav.simulate(nav.Scenario(start=(0.0, 0.0), goal=(4.0, 0.0), obstacles=[leaving]), nav.VirtualForceField())
    assert "not_scored" not in codes(nav.metrics.evaluate(run))


def test_what_is_unseen_may_be_said() -> None:
    people = standing((3.0, 0.0))
    people[22:38] = np.nan
    away = np.zeros((61, 1), dtype=bool)
    episode = nav.metrics.Episode(position=PATH, people=people, unseen=away, **RULES)
    assert nav.metrics.evaluate(episode).success
    assert not pickle.loads(pickle.dumps(episode)).unseen.any()
    slow = nav.metrics.Episode(position=PATH, people=people + np.array([0.0, 1.0]), person_speed=0.1, **RULES)
    assert nav.metrics.evaluate(slow).success
    with pytest.raises(ShapeError, match="unseen"):
        nav.metrics.Episode(position=PATH, people=people, unseen=away[1:], **RULES)
    with pytest.raises(InvalidParameterError, match="unseen must be an array of truth values"):
        nav.metrics.Episode(position=PATH, people=people, unseen=np.zeros((61, 1)), **RULES)
    with pytest.raises(InvalidParameterError, match="simulated must be True or False"):
        nav.metrics.Episode(position=PATH, simulated=1, **RULES)
    for wrong in (-1.0, math.nan):
        with pytest.raises(InvalidParameterError, match="person_speed"):
            nav.metrics.Episode(position=PATH, person_speed=wrong, **RULES)


# ---- measured positions --------------------------------------------------------------------------


@settings(max_examples=40, deadline=None)
@given(row=st.integers(3, 57), away=st.floats(2.0, 50.0), who=st.sampled_from(["robot", "person"]))
def test_jumps_are_doubts(row: int, away: float, who: str) -> None:
    own, people = PATH.copy(), PATH[::-1, None] * (0.7, 1.0) + (0.0, 3.0)
    (own if who == "robot" else people)[row:] += (0.0, away)
    found = nav.metrics.evaluate(own, people, **RULES)
    name = "the robot" if who == "robot" else r"people[0]"
    (doubt,) = [each for each in found.warnings if each.code == "teleport"]
    assert doubt.message.startswith(f"speed of {name} after {(row - 1) * STEP:g} s is ")


def test_exchanged_ids_are_doubts() -> None:
    people = np.stack([PATH * (0.8, 1.0) + (0.0, side) for side in (2.0, 9.0)], axis=1)
    people[30:] = people[30:, ::-1].copy()
    (doubt,) = nav.metrics.evaluate(PATH, people, **RULES).warnings
    assert (doubt.code, doubt.subject) == ("identity_switch", "people[0] and people[1]")


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10_000), sigma=st.floats(0.015, 0.03))
def test_noise_is_a_doubt_and_smoothing_takes_it_away(seed: int, sigma: float) -> None:
    rng = np.random.default_rng(seed)
    own = np.linspace([0.0, 0.0], [4.6, 0.0], 231)  # 1 m/s at 50 Hz
    rules = {**RULES, "step": 0.02, "goal": (50.0, 0.0)}
    noisy = nav.metrics.Episode(position=own + rng.normal(0.0, sigma, own.shape), **rules)
    found, smooth = nav.metrics.evaluate(noisy), nav.metrics.evaluate(noisy.smoothed(0.6))
    assert codes(found) == ["noisy_positions"]
    assert found.path_length > 1.3 * 4.6
    assert found.max_acceleration > 50.0
    assert smooth.warnings == ()
    assert smooth.path_length == pytest.approx(4.6, rel=0.03)
    assert smooth.max_acceleration < 0.1 * found.max_acceleration
    assert nav.metrics.evaluate(own, **rules).warnings == ()


# ---- what metrics are of -------------------------------------------------------------------------


WALK = np.linspace([[0.0, 0.0]], [[10.0, 0.0]], 101)
AMONG = {"step": 0.1, "goal": (10.0, 0.0), "robot_radius": 0.3}


def doubted(result: Any) -> set[str]:
    return {each.code for each in unsafe_doubts(result.warnings)}


@settings(max_examples=25, deadline=None)
@given(tolerance=st.floats(10.1, 1e4), many=st.booleans())
def test_a_robot_that_has_arrived_at_once_is_doubted(tolerance: float, many: bool) -> None:
    own = WALK[:, 0]
    for options in ({"arrival_tolerance": tolerance}, {"goal": (0.1, 0.0)}):
        episode = nav.metrics.Episode(position=own, people=WALK + np.array([5.0, 0.0]), **AMONG | options)
        found = nav.metrics.evaluate_many([episode]) if many else nav.metrics.evaluate(episode)
        assert doubted(found) == ({"implausible"} if "arrival_tolerance" in options else {"not_scored"})


@pytest.mark.parametrize("factor", [1000.0, 100.0])
def test_people_in_another_unit_than_the_robot_are_doubted_though_they_stand(factor: float) -> None:
    stand = np.broadcast_to(factor * np.array([5.0, 0.0]), (101, 1, 2))
    episode = nav.metrics.Episode(position=WALK[:, 0], people=stand, **AMONG)
    for found in (nav.metrics.evaluate(episode), nav.metrics.evaluate_many([episode])):
        assert doubted(found) == {"implausible"}
        assert "another unit" in found.warnings[0].message


def test_metrics_of_a_world_carry_the_doubts_of_its_positions() -> None:
    def world(people: Any = WALK, **options: Any) -> set[str]:
        goals = [(10.0, 0.0)] * people.shape[1]
        return doubted(
            nav.metrics.evaluate_world(
                people, **{"person_goals": goals, "step": 0.1, "time_limit": 10.0, "robot_radius": 0.3, **options}
            )
        )

    beside = WALK + np.array([0.0, 5.0])
    lost = beside.copy()
    lost[40:60] = np.nan
    jump = WALK.copy()
    jump[50:, :, 1] = 30.0
    noisy = WALK + np.random.default_rng(1).normal(0.0, 0.05, WALK.shape)
    assert world() == world(robots=beside) == set()
    assert world(1000.0 * WALK) == world(step=100.0) == world(robots=beside, robot_radius=300.0) == {"implausible"}
    assert (
        world(np.nan * WALK) == world(robots=np.nan * beside) == world(robots=lost) - {"gap_in_track"} == {"not_scored"}
    )
    assert world(jump) == {"teleport"}
    assert world(noisy) == {"noisy_positions"}
    assert world(jump, simulated=True) == set()
    with pytest.raises(nav.InvalidParameterError, match="robot_radius must be finite"):
        world(robots=beside, robot_radius=np.nan)
