"""Social metrics: what they take, what they refuse, what they look like."""

from __future__ import annotations

import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hrsafety import datasets
from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.navigation.metrics import declared

RULES: dict[str, Any] = {"step": 0.5, "goal": (6.0, 0.0), "robot_radius": 0.3}
PATH = np.linspace([0.0, 0.0], [6.0, 0.0], 13)
PEOPLE = np.stack([np.linspace([6.0, 1.0], [0.0, 1.0], 13), np.full((13, 2), (3.0, -2.0))], axis=1)


def refused(**changes: Any) -> str:
    given = {"position": PATH, "people": PEOPLE, **RULES, **changes}
    with pytest.raises((InvalidParameterError, ShapeError)) as caught:
        nav.metrics.Episode(**given)
    return str(caught.value).split(" ")[0]


def test_type_checkers_know_the_declared_names() -> None:
    assert list(declared.Measured.__annotations__) == list(nav.metrics.METRICS)
    assert list(declared.MeasuredWorld.__annotations__) == list(nav.metrics.WORLD_METRICS)
    kinds = {"N": "number", "K": "count", "F": "flag"}
    for table, names in (
        (declared.Measured, nav.metrics.METRICS),
        (declared.MeasuredWorld, nav.metrics.WORLD_METRICS),
    ):
        assert [kinds[kind] for kind in table.__annotations__.values()] == [each.kind for each in names.values()]


def test_documentation_lists_every_metric_with_its_unit() -> None:
    text = nav.metrics.EpisodeMetrics.__doc__ or ""
    for metric in nav.metrics.METRICS.values():
        assert f"    {metric.name} : " in text
        assert metric.unit in text
    assert "{metrics}" not in text


def test_an_array_an_episode_and_a_table_agree() -> None:
    episode = nav.metrics.Episode(position=PATH, people=PEOPLE, **RULES)
    found = nav.metrics.evaluate(episode)
    assert found == nav.metrics.evaluate(PATH, PEOPLE, **RULES)
    assert nav.metrics.evaluate_many([episode] * 3)[2] == found
    assert found.success is True
    assert found.arrival_time == 6.0
    assert found.min_clearance == pytest.approx(0.45)


def test_a_result_is_a_table_that_cannot_be_changed() -> None:
    found = nav.metrics.evaluate(PATH, PEOPLE, **RULES)
    columns = found.columns()
    assert columns["arrival_time_s"].tolist() == [6.0]
    assert len(columns) == len(nav.metrics.METRICS)
    assert "min_clearance = 0.45 m" in repr(found)
    assert pickle.loads(pickle.dumps(found)) == found
    with pytest.raises(AttributeError):
        found.success = False
    with pytest.raises(AttributeError, match="arival"):
        _ = found.arival_time  # type: ignore[attr-defined]  # wrong on purpose
    table = nav.metrics.evaluate_many([nav.metrics.Episode(position=PATH, **RULES)] * 4)
    assert table.success_share.value == 1.0
    assert len(table.columns()["mean_speed_m_per_s"]) == 4
    assert pickle.loads(pickle.dumps(table)) == table


def test_an_episode_keeps_copies() -> None:
    path = PATH.copy()
    episode = nav.metrics.Episode(position=path, **RULES)
    path[:] = 0.0
    assert nav.metrics.evaluate(episode).arrived
    with pytest.raises(ValueError, match="read-only"):
        episode.position[0, 0] = 1.0  # type: ignore[index,call-overload]
    again = pickle.loads(pickle.dumps(episode))
    assert nav.metrics.evaluate(again) == nav.metrics.evaluate(episode)


def test_a_run_is_scored_with_the_people_and_walls_of_its_scenario() -> None:
    scene = nav.Scenario(
        start=(4.0, 0.0),
        goal=(0.0, 0.0),
        obstacles=[
            nav.Human(start=(0.0, 1.5), velocity=(0.8, 0.0)),
            nav.Disc(center=(2.0, -1.5), radius=0.2),
            nav.MovingDisc(center=(2.0, 5.0), radius=0.2, velocity=(0.1, 0.0)),
        ],
    )
    run = nav.simulate(scene, nav.VirtualForceField())
    found = nav.metrics.evaluate(run)
    assert found.arrived
    step = float(run.time[1] - run.time[0])
    assert run.arrival_time <= found.arrival_time <= run.arrival_time + step
    assert found.path_length == pytest.approx(run.path_length, abs=0.01)
    assert found.min_clearance == pytest.approx(run.min_clearance[0], abs=0.01)
    assert found.wall_clearance == pytest.approx(run.min_clearance[1], abs=0.01)
    assert nav.metrics.evaluate_many([run])[0] == found
    assert nav.metrics.evaluate(run, max_speed=1.4).efficacy == pytest.approx(found.efficacy / 2.0)


def test_a_run_after_a_reference_has_no_scenario() -> None:
    run = nav.tracking.track(nav.tracking.LineReference(start=(0.0, 0.0)))
    with pytest.raises(InvalidParameterError, match="be a run in a scenario"):
        nav.metrics.evaluate(run)


def test_a_person_of_a_recording_is_taken_for_the_robot() -> None:
    time = np.repeat(np.arange(5.0), 2)
    person = np.tile([3, 8], 5)
    places = np.stack(
        [np.column_stack([np.arange(5.0), np.zeros(5)]), np.column_stack([np.arange(5.0), np.ones(5)])], 1
    )
    walk = datasets.Recording(time_s=time, person=person, position=places.reshape(-1, 2))
    found = nav.metrics.evaluate(walk, robot=3, step=0.4, robot_radius=0.25)
    assert found.arrived
    assert found.mean_speed == pytest.approx(1.0)
    assert found.min_clearance == pytest.approx(0.5)
    rows = np.column_stack([np.arange(5.0), np.arange(5.0), np.full(5, 0.8)])
    own = nav.metrics.evaluate(walk, robot=rows, step=0.5, robot_radius=0.25)
    assert own.min_clearance == pytest.approx(-0.3)
    with pytest.raises(InvalidParameterError, match="robot must be the id"):
        nav.metrics.evaluate(walk, robot=4, step=0.4, robot_radius=0.25)


def test_who_is_not_there_is_not_met() -> None:
    absent = np.full_like(PEOPLE, np.nan)
    found, alone = nav.metrics.evaluate(PATH, absent, **RULES, simulated=True), nav.metrics.evaluate(PATH, **RULES)
    assert found == alone
    assert found.min_clearance == np.inf
    assert np.isnan(found.mean_clearance)


def test_bad_values_are_named() -> None:
    assert refused(step=0.0) == "step"
    assert refused(goal=(np.nan, 0.0)) == "goal"
    assert refused(robot_radius=-0.1) == "robot_radius"
    assert refused(max_speed=0.0) == "max_speed"
    assert refused(arrival_tolerance=-1.0) == "arrival_tolerance"
    assert refused(period=(1.0, -1.0)) == "period[1]"
    assert refused(position=PATH[:-1]) == "people"
    assert refused(position=np.empty((0, 2))) == "position"
    assert refused(position=np.where(PATH == 3.0, np.inf, PATH)) == "position[6]"
    assert refused(people=np.where(PEOPLE == 1.0, np.inf, PEOPLE)) == "people[0,"
    assert refused(people=PEOPLE[:, 0]) == "people"
    assert refused(person_radius=[0.3]) == "person_radius"
    assert refused(person_radius=[0.3, 0.0]) == "person_radius[1]"
    assert refused(groups=[1]) == "groups"
    assert refused(groups=[1.5, 2.0]) == "groups"
    assert refused(people_without=PEOPLE) == "person_goals"
    assert refused(people_without=PEOPLE[:, :1], person_goals=np.zeros((2, 2))) == "people_without"
    assert refused(walls=[[(0.0, 0.0)]]) == "walls[0]"
    assert refused(shortest_length=-1.0) == "shortest_length"
    beside = {"people_without": PEOPLE, "person_goals": np.zeros((2, 2))}
    arrivals = np.ones((2, 3))
    assert refused(**beside, person_arrivals=arrivals) == "person_arrivals_without"
    both = beside | {"person_arrivals": arrivals, "person_arrivals_without": arrivals}
    assert refused(**both | {"person_arrivals": np.ones((2, 2))}) == "person_arrivals"
    assert refused(**both | {"person_arrivals_without": np.ones((3, 3))}) == "person_arrivals_without"
    assert refused(**both | {"person_arrivals": [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]}) == "person_arrivals[1]"
    assert refused(**both | {"person_arrivals": [[1.0, 0.0, 0.0], [1.0, np.nan, 0.0]]}) == "person_arrivals[1]"


def test_what_an_episode_has_is_not_given_again() -> None:
    episode = nav.metrics.Episode(position=PATH, **RULES)
    with pytest.raises(InvalidParameterError, match="step must be left out"):
        nav.metrics.evaluate(episode, step=0.1)
    with pytest.raises(InvalidParameterError, match="people must be None"):
        nav.metrics.evaluate(episode, PEOPLE)
    with pytest.raises(InvalidParameterError, match=r"episodes\[1\] must be an Episode or Trajectory"):
        nav.metrics.evaluate_many([episode, PATH])  # type: ignore[list-item]  # wrong on purpose


def test_a_world_counts_who_left() -> None:
    walk = PEOPLE.copy()
    walk[8:, 0] = np.nan
    found = nav.metrics.evaluate_world(
        walk,
        person_goals=[(2.5, 1.0), (0.0, 0.0)],
        step=0.5,
        time_limit=10.0,
        robots=np.stack([PATH, PATH[::-1]], axis=1),
        robot_radius=0.3,
    )
    assert found.throughput == pytest.approx(1.0 / 6.0)
    assert found.deadlocked_share == 0.5
    assert found.aggregated_time == pytest.approx(3.5 + 10.0)
    assert found.robot_contacts == 1
    known = nav.metrics.evaluate_world(
        walk,
        person_goals=[(9.0, 9.0), (0.0, 0.0)],
        person_arrival_time=[4.0, np.nan],
        step=0.5,
        time_limit=10.0,
    )
    assert known.aggregated_time == 4.0 + 10.0
    assert known.deadlocked_share == 0.5
    with pytest.raises(ShapeError, match=r"person_arrival_time .*\(2,\)"):
        nav.metrics.evaluate_world(
            walk, person_goals=np.zeros((2, 2)), person_arrival_time=[1.0], step=0.5, time_limit=10.0
        )
    with pytest.raises(ShapeError, match=r"person_goals .*\(2, 2\)"):
        nav.metrics.evaluate_world(walk, person_goals=[(2.5, 1.0)], step=0.5, time_limit=10.0)


def test_a_long_recording_is_an_episode() -> None:
    # Somebody passes another one in 100 s at 0.1 s; instants are not equal.
    time = np.cumsum(np.random.default_rng(1).uniform(0.2, 0.47, 300))
    places = [np.stack([sign * (0.1 * time - 5.0), 0.0 * time + side], axis=1) for sign, side in ((1, 0.0), (-1, 0.8))]
    both = datasets.Recording(
        time_s=np.repeat(time, 2), person=np.tile([1, 2], 300), position=np.stack(places, axis=1).reshape(-1, 2)
    )
    episode = nav.metrics.Episode.from_recording(both, 1, step=0.1, robot_radius=0.25)
    assert len(np.asarray(episode.position)) == int((time[-1] - time[0]) / 0.1) + 1
    found = nav.metrics.evaluate(both, robot=1, step=0.1, robot_radius=0.25)
    assert found.min_clearance == pytest.approx(0.3, abs=1e-4)
    with pytest.raises(InvalidParameterError, match="step must be at most"):
        nav.metrics.Episode.from_recording(both, 1, step=1e-9, robot_radius=0.25)


def test_what_is_not_scored_of_a_run_is_told() -> None:
    scene = nav.Scenario(start=(0.0, 0.0), goal=(4.0, 0.0), obstacles=[], time_limit=20.0)
    wall = nav.StaticMap.from_polylines([[(2.0, -0.05), (2.0, 3.0)]])
    blind = nav.SafeNavigation(nav.VirtualForceField(attractive_gain=200.0), map=wall)
    run = nav.simulate(scene, blind)
    assert run.outcome == "collided"
    found = nav.metrics.evaluate(run)
    (doubt,) = found.warnings
    assert (doubt.code, found.wall_contacts) == ("not_scored", 0)
    assert f"touched it at {run.map_contact_time:.2f} s" in doubt.message
    walled = nav.metrics.evaluate(run, walls=[[(2.0, -0.05), (2.0, 3.0)]])
    assert (walled.warnings, walled.wall_contacts, walled.success) == ((), 1, False)
    assert [each.code for each in nav.metrics.evaluate_many([run]).warnings] == ["not_scored"]

    cart = nav.MovingRectangle(center=(2.0, 0.0), velocity=(-3.0, 0.0), length=0.5, width=3.0)
    met = nav.simulate(replace(scene, obstacles=[cart]), nav.VirtualForceField())
    touched = bool(np.isfinite(met.contact_time[0]))
    assert [each.code for each in nav.metrics.evaluate(met).warnings].count("not_scored") == touched
    assert touched


def test_doubts_of_what_an_episode_comes_from_reach_its_metrics() -> None:
    rows = [[0.0, 0.0], [4000.0, 0.0], [500.0, 0.0], [3500.0, 0.0]]
    millimeters = datasets.Recording(time_s=[0.0, 0.0, 0.4, 0.4], person=[1, 2, 1, 2], position=rows)
    episode = nav.metrics.Episode.from_recording(millimeters, 1, step=0.4, robot_radius=0.25)
    assert pickle.loads(pickle.dumps(episode)).warnings == episode.warnings == millimeters.warnings
    scored = [nav.metrics.evaluate(episode), nav.metrics.evaluate(millimeters, robot=1, step=0.4, robot_radius=0.25)]
    assert [[each.code for each in found.warnings] for found in scored] == [["implausible"]] * 2
    table = nav.metrics.evaluate_many([episode, nav.metrics.Episode(position=PATH, **RULES)])
    assert table[0].warnings == table.warnings
    assert "episodes[0]: median speed" in str(table.warnings[0])


def test_doubts_of_a_world_reach_its_metrics() -> None:
    law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(person_speed=0.1, margin=0.0125))
    robot = nav.Robot(start=(0, 0), goal=(4, 0), law=law)
    person = nav.Person(start=(4, 1), route=[(0, 1)], desired_speed=1.0)
    run = nav.simulate(nav.World(people=[person], robots=[robot], time_limit=1.0))
    assert len(run.warnings) == 1
    assert nav.crowd.world_metrics(run).warnings == run.warnings
    assert nav.metrics.evaluate(nav.crowd.episodes_of(run)[0]).warnings == run.warnings


def test_warnings_of_an_episode_are_warnings() -> None:
    assert refused(warnings=["doubtful"]) == "warnings[0]"


@pytest.mark.parametrize(
    ("given", "subject"),
    [
        ({"position": 1e3 * PATH, "people": 1e3 * PEOPLE, "goal": (6e3, 0.0)}, "speed of the robot"),
        ({"people": 100.0 * PEOPLE}, "speed of the people"),
        ({"step": 500.0}, "step"),
        ({"robot_radius": 300.0}, "robot_radius"),
        ({"person_radius": 25.0}, "person_radius"),
    ],
)
def test_positions_in_other_units_are_told(given: dict[str, Any], subject: str) -> None:
    episode = nav.metrics.Episode(**({"position": PATH, "people": PEOPLE, **RULES} | given))
    found = nav.metrics.evaluate(episode).warnings
    assert found[0].code == "implausible"
    assert found[0].subject == subject
    table = nav.metrics.evaluate_many([nav.metrics.Episode(position=PATH, people=PEOPLE, **RULES), episode])
    assert f"episodes[1].{subject}" in {each.subject for each in table.warnings}
    assert nav.metrics.evaluate(PATH, PEOPLE, **RULES).warnings == ()
