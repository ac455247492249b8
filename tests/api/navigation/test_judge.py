"""Recorded robots judged: permit rules, contacts, assumptions, and that nobody who was not seen counts as safe."""

from __future__ import annotations

import json
import os
from pathlib import Path
from time import process_time
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import contact, datasets, io, standards
from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.metrics import Judgement, PermitRules, judge
from hrsafety.plausibility import unsafe_doubts

SHARED = Path(__file__).resolve().parents[3].parent / "shared"
FOLDER = Path(os.environ.get("HRSAFETY_SHARED", SHARED)) / "data" / "formats"


def expectations() -> list[Any]:
    place = FOLDER / "expected.json"
    if not place.is_file():
        return [pytest.param({}, marks=pytest.mark.skip(reason="needs the files of formats (HRSAFETY_SHARED)"))]
    return [pytest.param(each, id=each["file"]) for each in json.loads(place.read_text())["permit"]]


@pytest.mark.parametrize("entry", expectations())
def test_a_passing_is_judged_as_expected(entry: dict[str, Any]) -> None:
    call, within = entry["call"], entry["tolerance"]
    log = io.load_log(FOLDER / entry["file"], people=FOLDER / call["people"])
    rules = PermitRules(clearance=call["clearance"])
    found = judge(log, robot_radius=call["robot_radius"], person_radius=call["person_radius"], rules=rules)
    (passing,) = found.passings
    kinds = {
        "time": ("lead_time", "pass_time"),
        "distance": ("lead_distance",),
        "clearance": ("passing_clearance",),
        "lateral_acceleration": ("lateral_acceleration",),
        "turn": ("turn",),
    }
    for kind, names in kinds.items():
        for name in names:
            assert getattr(passing, name) == pytest.approx(entry[name], abs=within[kind]), name
    assert {name: word == "kept" for name, word in passing.kept.items()} == entry["kept"]
    assert found.warnings == ()


@pytest.mark.parametrize("entry", expectations())
@pytest.mark.parametrize(("begin", "end"), [(-1.0, 0.5), (-0.3, 0.3), (-0.5, 99.0), (0.2, 99.0), (-4.0, 99.0)])
def test_a_person_lost_while_the_robot_passes_keeps_no_rule(entry: dict[str, Any], begin: float, end: float) -> None:
    log = io.load_log(FOLDER / entry["file"], people=FOLDER / entry["call"]["people"])
    assert log.people is not None
    away = log.people.time_s - entry["pass_time"]
    seen = ~((away > begin) & (away < end))
    people = datasets.Recording(
        time_s=log.people.time_s[seen], person=log.people.person[seen], position=log.people.position[seen]
    )
    lost = SimpleNamespace(time=log.time, position=log.position, heading=log.heading, people=people)
    found = judge(lost, robot_radius=0.3)
    words = [word for each in found.passings for word in each.kept.values()]
    assert words
    assert "kept" not in words
    assert all(each.reason for each in found.passings)


def log_of(
    robot: Any, people: dict[Any, Any], *, step: float = 0.1, duration: float = 10.0, **more: Any
) -> SimpleNamespace:
    """Return a log of functions of time."""
    time = step * np.arange(round(duration / step) + 1)
    position = np.stack(np.broadcast_arrays(*robot(time)), axis=1).astype(float)
    heading = np.unwrap(np.arctan2(*np.gradient(position, axis=0).T[::-1])) + 0.0
    tracks = {name: np.stack(np.broadcast_arrays(*way(time)), axis=1).astype(float) for name, way in people.items()}
    rows = [
        (t, name, *place[k]) for k, t in enumerate(time) for name, place in tracks.items() if np.isfinite(place[k, 0])
    ]
    recording = None
    if rows:
        recording = datasets.Recording(
            time_s=[row[0] for row in rows],
            person=[row[1] for row in rows],
            position=[row[2:] for row in rows],
        )
    return SimpleNamespace(time=time, position=position, heading=heading, people=recording, **more)


def test_contacts_are_told_apart_by_who_moved() -> None:
    toward = judge(log_of(lambda t: (t, 0 * t), {1: lambda t: (5 + 0 * t, 0.1)}), robot_radius=0.3)
    (touch,) = toward.contacts
    assert (touch.kind, touch.at_fault, touch.person) == ("toward", True, 1)
    reach = 0.55
    assert touch.begin == pytest.approx(5 - np.sqrt(reach**2 - 0.01), abs=1e-6)
    assert toward.counts["at_fault"] == toward.counts["moving_contact"] == toward.counts["contact"] == 1
    stood = judge(log_of(lambda t: (0 * t, 0 * t), {1: lambda t: (5 - t, 0.1)}), robot_radius=0.3)
    assert [each.kind for each in stood.contacts] == ["standing"]
    assert stood.counts["at_fault"] == 0
    away = judge(log_of(lambda t: (0.2 * t, 0 * t), {1: lambda t: (-4 + 1.2 * t, 0.1)}), robot_radius=0.3)
    assert away.contacts[0].kind == "away"


def test_a_contact_between_two_instants_is_found() -> None:
    crossing = {"fast": lambda t: (3.0 + 0 * t, 12.0 * (t - 3.05))}
    found = judge(log_of(lambda t: (t, 0 * t), crossing), robot_radius=0.1, person_radius=0.1)
    assert np.nanmin(found.clearance) > 0.0
    assert found.counts["contact"] == 1


def test_the_error_of_positions_decides_a_possible_contact() -> None:
    log = log_of(lambda t: (t, 0 * t), {1: lambda t: (5 + 0 * t, 0.56)})
    near = judge(log, robot_radius=0.3, pose_error=0.01, person_error=0.01)
    assert (near.counts["contact"], near.counts["possible_contact"]) == (0, 1)
    (touch,) = near.possible_contacts
    assert touch.earliest < 5.0 < touch.latest
    assert touch.clearance == pytest.approx(0.01, abs=1e-6)
    assert "possible_contact" in [each.code for each in near.warnings]
    far = judge(log, robot_radius=0.3, pose_error=0.004, person_error=0.004)
    assert far.counts["any"] - far.counts["violated_rule"] == 0


def test_walls_are_touched_between_instants_too() -> None:
    walls = nav.StaticMap.from_polylines([[(4.97, -1.0), (4.97, 1.0)], [(-2.0, 3.0), (12.0, 3.0)]])
    found = judge(log_of(lambda t: (2.0 * t - 3.0, 0 * t), {}), map=walls, robot_radius=0.05, step=0.1)
    assert [each.kind for each in found.contacts] == ["wall"]
    assert found.metrics.wall_contacts == 1
    assert found.metrics.wall_clearance < 0.0
    grid = nav.StaticMap.from_grid(np.zeros((40, 40), dtype=int), resolution=0.1, outside="unknown")
    outside = judge(log_of(lambda t: (t, 1.0 + 0 * t), {}), map=grid, robot_radius=0.3)
    assert "outside_map" in {each.reason for each in outside.not_judged}
    (doubt,) = [each for each in unsafe_doubts(outside.warnings) if each.code == "unknown_ground"]
    assert "the log leads" in doubt.message
    inside = judge(log_of(lambda t: (1.0 + 0.1 * t, 1.0 + 0 * t), {}), map=grid, robot_radius=0.3)
    assert "outside_map" not in {each.reason for each in inside.not_judged}
    assert "unknown_ground" not in {each.code for each in inside.warnings}


def test_without_people_nothing_is_judged() -> None:
    found = judge(log_of(lambda t: (t, 0 * t), {}), robot_radius=0.3)
    assert found.judged_share == 0.0
    assert "not_judged" in [each.code for each in found.warnings]


def test_a_jump_of_the_pose_is_not_bridged() -> None:
    log = log_of(
        lambda t: (t, np.where(t < 4.95, 0.0, 0.5)), {1: lambda t: (12.0 - 0 * t, 3.0)}, pose_jumps=((4.9, 5.0, 0.5),)
    )
    found = judge(log, robot_radius=0.3, shield=nav.Shield())
    assert found.metrics.max_speed == pytest.approx(1.0)
    assert found.scored in ((0.0, pytest.approx(4.9)), (pytest.approx(5.0), 10.0))
    assert "pose_jump" in {each.reason for each in found.not_judged}
    margin = next(each for each in found.assumptions if each.name == "margin")
    assert (margin.status, margin.most) == ("broken", 0.5)


def test_a_person_who_jumps_past_the_robot_is_lost() -> None:
    log = log_of(lambda t: (t, 0 * t), {1: lambda t: (6.0 + 0 * t, np.where(t < 5.95, 8.0, -2.0) - 0.5 * t)})
    found = judge(log, robot_radius=0.3)
    assert [set(each.kept.values()) for each in found.passings] == [{"not_judged"}]
    assert ("person_lost_nearby", 1) in [(each.reason, each.person) for each in found.not_judged]
    assert {"teleport", "person_lost_nearby"} <= {each.code for each in found.warnings}


@pytest.mark.parametrize("elsewhere", [(-999.0, -999.0), (60.0, 40.0)])
def test_a_person_whose_id_jumps_away_is_lost_as_one_without_rows(elsewhere: tuple[float, float]) -> None:
    time, place = 0.1 * np.arange(141), np.stack([0.07 * np.arange(141.0), np.zeros(141)], axis=1)
    walk = np.stack([9.0 - time, np.full(141, 0.65)], axis=1)
    away = (time > 2.95) & (time < 7.95)
    found = []
    for rows, seen in ((walk, ~away), (np.where(away[:, None], elsewhere, walk), np.ones(141, dtype=bool))):
        times, places = np.append(time[seen], time), np.concatenate([rows[seen], np.full((141, 2), 30.0)])
        order, who = np.argsort(times, kind="stable"), np.append(np.ones(seen.sum(), dtype=int), np.full(141, 2))
        people = datasets.Recording(time_s=times[order], person=who[order], position=places[order])
        log = SimpleNamespace(time=time, position=place, heading=0.0 * time, people=people)
        found.append(judge(log, robot_radius=0.3))
    gone, jumps = found
    assert jumps.judged_share == gone.judged_share < 0.95
    assert jumps.not_judged == gone.not_judged
    (passing,) = jumps.passings
    assert set(passing.kept.values()) == {"not_judged"}


def test_assumptions_of_a_shield() -> None:
    commands = np.array([(0.05 * k, 1.0, 0.0, 0.0) for k in range(200)])
    delay = SimpleNamespace(median=0.1, high=0.12, most=0.2)
    more = {
        "commands": commands,
        "delay": {"/people": delay},
        "people_topic": "/people",
        "people_time": 0.1 * np.arange(101),
    }
    log = log_of(lambda t: (t, 0 * t), {"runner": lambda t: (20.0 - 2.5 * t, 3.0)}, **more)
    shield = nav.laws.Shield(latency=0.5, velocity_error=0.1, person_acceleration=3.0)
    found = {each.name: each for each in judge(log, robot_radius=0.3, shield=shield, control_period=0.05).assumptions}
    assert (found["person_speed"].status, found["person_speed"].note) == ("broken", "person runner")
    assert found["person_speed"].most == pytest.approx(2.5, abs=1e-3)
    assert found["person_acceleration"].status == "held"
    assert found["latency"].status == "held"
    assert 0.2 < found["latency"].most <= 0.3 + 1e-6
    assert found["control_period"].status == "held"
    assert found["deceleration"].status == "not_measurable"
    assert found["velocity_tracking"].most == pytest.approx(0.0, abs=1e-6)
    late = judge(log, robot_radius=0.3, shield=nav.laws.Shield(latency=0.1), control_period=0.02)
    assert {each.name for each in late.assumptions if each.status == "broken"} == {
        *("person_speed", "latency", "control_period"),
    }
    assert late.counts["broken_assumption"] == 3


def test_margins_of_contact_take_a_judgement_as_a_run() -> None:
    found = judge(log_of(lambda t: (t, 0 * t), {1: lambda t: (5 + 0 * t, 0.1)}), robot_radius=0.3)
    base = contact.HolonomicBase(mass=30.0, inertia=1.0)
    leg = standards.limits().contact("lower_leg", "transient")
    margins = contact.contact_margins(
        found, base=base, covering=None, regions=[leg], robot_radius=0.3, person_radius=0.25
    )
    assert margins.touching.any()
    assert margins.closing_speed[40, 0] == pytest.approx(1.0, abs=0.01)


def test_moments_are_apart_and_worst_first() -> None:
    found = judge(
        log_of(lambda t: (t, 0 * t), {k: lambda t, k=k: (k + 0 * t, 1.0 + 0.1 * k) for k in (2, 5, 8)}),
        robot_radius=0.3,
    )
    assert [each.person for each in found.moments][:3] == [2, 5, 8]
    assert np.diff(sorted(each.time for each in found.moments)).min() >= 2.0 - 1e-9
    missing = [each.missing for each in found.moments]
    assert missing == sorted(missing, reverse=True)
    assert judge(log_of(lambda t: (t, 0 * t), {}), robot_radius=0.3).moments == ()


def test_noise_makes_a_swerve_unmeasurable() -> None:
    rng = np.random.default_rng(1)
    log = log_of(lambda t: (t, 0 * t), {1: lambda t: (9.0 - 0 * t, 1.5)})
    log.heading = rng.normal(0.0, 0.5, len(log.time))
    (passing,) = judge(log, robot_radius=0.3).passings
    assert passing.no_swerve in ("not_measurable", "violated")


def test_ten_minutes_with_fifty_people_take_few_seconds() -> None:
    rng, time = np.random.default_rng(3), 0.1 * np.arange(6001)
    turns = np.cumsum(rng.normal(0.0, 0.1, (len(time), 51)), axis=0)
    ways = np.cumsum(0.1 * np.stack([np.cos(turns), np.sin(turns)], axis=2), axis=0) + rng.uniform(
        -9.0, 9.0, (1, 51, 2)
    )
    places = 12.0 - np.abs((ways + 12.0) % 48.0 - 24.0)
    people = datasets.Recording(
        time_s=np.repeat(time, 50), person=np.tile(np.arange(50), len(time)), position=places[:, 1:].reshape(-1, 2)
    )
    log = SimpleNamespace(time=time, position=places[:, 0], heading=turns[:, 0], people=people)
    begin = process_time()
    found = judge(log, robot_radius=0.3)
    assert process_time() - begin < 20.0  # nothing grows with the square of the people
    assert found.counts["contact"] > 0


def test_what_judge_refuses() -> None:
    log = log_of(lambda t: (t, 0 * t), {})
    with pytest.raises(InvalidParameterError, match="robot_radius must be known"):
        judge(log)
    with pytest.raises(InvalidParameterError, match="load_log"):
        judge("log.bag", robot_radius=0.3)  # type: ignore[arg-type]
    with pytest.raises(InvalidParameterError, match="rules must be a PermitRules"):
        judge(log, robot_radius=0.3, rules={})  # type: ignore[arg-type]
    with pytest.raises(InvalidParameterError, match="lead_time must be finite and positive"):
        PermitRules(lead_time=-1.0)
    with pytest.raises(InvalidParameterError, match="step must leave at most"):
        judge(log_of(lambda t: (t, 0 * t), {1: lambda t: (t, t)}, duration=100.0), robot_radius=0.3, step=1e-6)


@settings(max_examples=60, deadline=None)
@given(
    speed=st.floats(0.2, 1.5),
    offset=st.floats(-2.5, 2.5),
    pace=st.floats(-1.5, 1.5),
    gap=st.tuples(st.floats(0.0, 12.0), st.floats(0.1, 12.0)),
)
def test_losing_sight_of_people_never_makes_a_rule_kept(
    speed: float, offset: float, pace: float, gap: tuple[float, float]
) -> None:
    def judged(hidden: bool) -> Judgement:
        def way(t: Any) -> Any:
            lost = hidden & (t >= gap[0]) & (t <= gap[0] + gap[1])
            return np.where(lost, np.nan, 8.0 + pace * t), offset

        return judge(log_of(lambda t: (speed * t, 0 * t), {1: way}, duration=12.0), robot_radius=0.3)

    whole, part = judged(hidden=False), judged(hidden=True)
    violated = {name for each in whole.passings for name, word in each.kept.items() if word == "violated"}
    nearest = np.nanmin(whole.clearance) if whole.clearance.size else np.inf
    if part.clearance.size and np.nanmin(part.clearance, initial=np.inf) > nearest + 1e-6 and part.passings:
        # The nearest instant is hidden: what was violated there is not kept now.
        kept = {name for each in part.passings for name, word in each.kept.items() if word == "kept"}
        assert not (violated & kept & {"passing_clearance"}) or part.judged_share < 1.0
    assert part.counts["contact"] <= whole.counts["contact"] + 1
