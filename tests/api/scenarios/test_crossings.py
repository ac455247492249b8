from __future__ import annotations

import math
import os
import pickle
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from hrsafety import io, scenarios
from hrsafety import navigation as nav
from hrsafety.datasets import Recording
from hrsafety.errors import InvalidParameterError
from hrsafety.scenarios.recorded_people import Selection

SHARED = Path(os.environ.get("HRSAFETY_SHARED", Path(__file__).resolve().parents[3].parent / "shared"))
PEDESTRIANS = SHARED / "data" / "pedestrians"
ROUNDING = 1e-9
"""Room for the rounding of times of some minutes."""


def stream(people: int = 30, every: float = 1.0, speed: float = 1.25) -> Recording:
    """People who walk from (-10, y) to (10, y), one after the other, y in -1, 0, 1."""
    rows = []
    for person in range(people):
        for k in range(int(20.0 / speed / 0.4) + 1):
            rows.append((person * every + 0.4 * k, person, -10.0 + speed * 0.4 * k, float(person % 3 - 1)))
    rows.sort()
    time, ids, x, y = map(np.array, zip(*rows, strict=True))
    return Recording(time_s=time, person=ids, position=np.stack([x, y], axis=1))


def test_crossings_go_straight_across_the_flow_through_its_center() -> None:
    runs = scenarios.crossings(stream(), runs=5, length=6.0)
    for run in runs:
        assert run.scenario.start == pytest.approx((0.0, -3.0), abs=0.1)
        assert run.scenario.goal == pytest.approx((0.0, 3.0), abs=0.1)


def test_crossings_begin_and_end_outside_the_bulk_of_the_flow() -> None:
    recording = stream()
    flow = recording.main_flow()
    run = scenarios.crossings(recording, runs=1)[0]
    for place in (run.scenario.start, run.scenario.goal):
        assert math.dist(place, flow.center) == pytest.approx(2.0 * flow.spread + 0.8)


@pytest.mark.parametrize("selection", ["busiest", "even"])
def test_start_times_are_sorted_different_and_never_in_a_contact(selection: Selection) -> None:
    recording = stream(40)
    runs = scenarios.crossings(recording, runs=8, selection=selection, length=2.0)
    starts = [run.start_time for run in runs]
    assert starts == sorted(set(starts))
    for run in runs:
        place = np.array(run.scenario.start)
        for person in recording.people():
            time, position = recording.track(int(person))
            if time[0] <= run.start_time <= time[-1]:
                there = [np.interp(run.start_time, time, position[:, axis]) for axis in (0, 1)]
                assert math.dist(there, place) > 0.6


def test_busiest_start_times_keep_their_distance() -> None:
    starts = [run.start_time for run in scenarios.crossings(stream(40), runs=6, spacing=5.0)]
    assert min(np.diff(starts)) >= 5.0 - ROUNDING


def test_busiest_start_times_meet_at_least_the_traffic_of_even_ones() -> None:
    recording = stream(40)
    busiest = scenarios.crossings(recording, runs=6, selection="busiest")
    even = scenarios.crossings(recording, runs=6, selection="even")
    assert sum(run.traffic for run in busiest) >= sum(run.traffic for run in even)


def test_an_even_start_in_a_contact_is_moved_to_the_next_free_instant() -> None:
    recording = stream(40)
    runs = scenarios.crossings(recording, runs=20, selection="even", length=2.0)
    moved = [run for run in runs if run.start_time != run.planned_time]
    assert moved
    for run in moved:
        steps = (run.start_time - run.planned_time) / 0.4
        assert steps == pytest.approx(round(steps), abs=1e-6)
        assert steps > 0


def test_traffic_counts_the_people_who_come_near_an_undisturbed_robot() -> None:
    recording = stream(1)
    run = scenarios.crossings(recording, runs=1, length=4.0)[0]
    assert run.traffic == 1
    assert run.people == (0,)


def test_everybody_in_view_during_a_run_is_an_obstacle() -> None:
    recording = stream(20)
    for run in scenarios.crossings(recording, runs=4, time_limit=10.0):
        assert run.people == tuple(recording.present(run.start_time, duration=10.0).tolist())
        assert len(run.scenario.obstacles) == len(run.people)
        assert run.scenario.time_limit == run.scenario.rest_time == 10.0


def test_people_of_a_crossing_have_the_fields_asked_for() -> None:
    runs = scenarios.crossings(stream(), runs=1, person_radius=0.3, critical_radius=0.7, active_radius=1.5)
    for person in runs[0].scenario.obstacles:
        assert isinstance(person, nav.Human)
        assert (person.radius, person.critical_radius, person.active_radius) == (0.3, 0.7, 1.5)


def test_crossings_can_be_pickled() -> None:
    run = scenarios.crossings(stream(), runs=1)[0]
    assert pickle.loads(pickle.dumps(run)) == run
    assert {field.name for field in fields(run)} == {"start_time", "planned_time", "traffic", "people", "scenario"}


@pytest.mark.parametrize(
    ("options", "argument"),
    [
        ({"runs": 0}, "runs"),
        ({"runs": 2.0}, "runs"),
        ({"runs": True}, "runs"),
        ({"runs": 1000}, "runs"),
        ({"runs": 1000, "selection": "even"}, "runs"),
        ({"selection": "quiet"}, "selection"),
        ({"spacing": 0.0}, "spacing"),
        ({"length": -1.0}, "length"),
        ({"length": float("nan")}, "length"),
        ({"length": 1000.0}, "recording"),
        ({"time_limit": 0.0}, "time_limit"),
        ({"time_limit": float("inf")}, "time_limit"),
        ({"person_radius": "a"}, "person_radius"),
        ({"critical_radius": -1.0}, "critical_radius"),
        ({"active_radius": 0.5}, "active_radius"),
    ],
)
def test_bad_options_of_crossings_are_errors(options: dict[str, object], argument: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        scenarios.crossings(stream(), **options)  # type: ignore[arg-type]  # bad on purpose
    assert caught.value.argument == argument


def test_only_a_recording_can_be_crossed() -> None:
    with pytest.raises(InvalidParameterError, match="recording must be a Recording"):
        scenarios.crossings([1, 2, 3])  # type: ignore[arg-type]  # bad on purpose


MANY = 5
RUNS = 24


@pytest.mark.parametrize("name", ["zara01", "zara03"])
def test_most_crossings_of_recorded_scenes_meet_many_people(name: str) -> None:
    path = PEDESTRIANS / f"{name}.csv"
    if not path.is_file():
        pytest.skip(f"needs {path.name} of the pedestrian data (HRSAFETY_SHARED)")
    runs = scenarios.crossings(io.load_people(path), runs=RUNS)
    assert len({run.start_time for run in runs}) == RUNS
    table = nav.simulate_batch([run.scenario for run in runs], nav.VirtualForceField(stabilizing="off"))
    assert np.count_nonzero(table.entered_active >= MANY) > RUNS // 2
    assert set(table.outcome.tolist()) <= {"arrived", "collided", "timed_out"}


def test_a_short_recording_tells_how_many_runs_it_holds() -> None:
    time = np.arange(0.0, 12.0, 0.4)
    places = np.stack([0.5 * time - 3.0, np.full(len(time), 4.0)], axis=1)
    short = Recording(time_s=time, person=np.ones(len(time), dtype=np.int64), position=places)
    with pytest.raises(InvalidParameterError, match=r"runs must be at most (\d+),.* got 24; ask for \1, or"):
        scenarios.crossings(short)
