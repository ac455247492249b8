"""People who change their ids, have one row only, or are lost near a robot: doubts that reach every result."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import io, scenarios
from hrsafety import navigation as nav
from hrsafety.benchmarks import benchmark
from hrsafety.cli import main
from hrsafety.datasets import Recording
from hrsafety.plausibility import ResultWarning, unsafe_doubts

STEP, ROWS = 0.4, 60


def stream(people: int = 40, *, speed: float = 1.2, seed: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times, ids and places of people who walk along x, one after the other."""
    rng = np.random.default_rng(seed)
    time, who, place = [], [], []
    for person in range(people):
        instants = 3.0 * person + STEP * np.arange(ROWS)
        speeds, side = speed * rng.uniform(0.9, 1.1), rng.uniform(-1.0, 1.0)
        time.append(np.round(instants, 9))
        who.append(np.full(ROWS, person))
        place.append(np.stack([-12.0 + speeds * STEP * np.arange(ROWS), np.full(ROWS, side)], axis=1))
    return np.concatenate(time), np.concatenate(who), np.concatenate(place)


def recorded(time: np.ndarray, who: np.ndarray, place: np.ndarray) -> Recording:
    order = np.lexsort((who, time))
    return Recording(time_s=time[order], person=who[order], position=place[order])


def codes(found: object) -> set[str]:
    return {each.code for each in found.warnings}  # type: ignore[attr-defined]


def written(path: Path, recording: Recording) -> Path:
    rows = zip(recording.time_s.tolist(), recording.person.tolist(), *recording.position.T.tolist(), strict=True)
    path.write_text("t_s,ped_id,x_m,y_m\n" + "".join(f"{t!r},{p},{x!r},{y!r}\n" for t, p, x, y in rows))
    return path


# ---- ids that change -------------------------------------------------------------------------------


@settings(max_examples=25, deadline=None)
@given(rows=st.integers(2, 12), seed=st.integers(0, 100))
def test_ids_that_change_every_few_rows_are_doubted(rows: int, seed: int) -> None:
    time, who, place = stream(seed=seed)
    number = np.tile(np.arange(ROWS), who[-1] + 1)
    assert codes(recorded(time, who, place)) == set()
    assert "broken_tracks" in codes(recorded(time, 1000 * who + number // rows, place))


@settings(max_examples=25, deadline=None)
@given(share=st.floats(0.2, 1.0), seed=st.integers(0, 100))
def test_people_with_one_row_are_doubted(share: float, seed: int) -> None:
    time, who, place = stream(seed=seed)
    changed = np.random.default_rng(seed).random(len(who)) < share
    found = recorded(time, np.where(changed, 10_000 + np.arange(len(who)), who), place)
    assert "single_row" in codes(found)


def test_two_streams_that_meet_are_no_broken_tracks() -> None:
    time, who, place = stream(60)
    back = who % 2 == 1
    place[back, 0] *= -1.0
    assert codes(recorded(time, who, place)) == set()


def test_recorded_scenes_are_broken_by_less_than_half(shared: Path) -> None:
    for name in ("zara01", "zara03"):
        assert io.load_people(shared / f"data/pedestrians/{name}.csv").warnings == ()


# One person may stand within 3 cm.
@pytest.mark.parametrize(
    ("factor", "people"), [(1e-3, 40), *((factor, people) for factor in (1.0 / 111_000.0, 1e-6) for people in (1, 40))]
)
def test_kilometers_and_degrees_are_doubted(factor: float, people: int) -> None:
    time, who, place = stream(people)
    found = recorded(time, who, factor * place).warnings
    assert [each.code for each in found] == ["implausible"]
    assert "degrees" in found[0].message


def test_one_person_who_stands_is_not_doubted() -> None:
    time = STEP * np.arange(50)
    sway = 0.01 * np.sin(time)[:, None] * (1.0, 0.3)
    for place in (np.zeros((50, 2)), sway):
        assert recorded(time, np.zeros(50, dtype=int), place).warnings == ()


# ---- doubts of a recording reach what is made of it ------------------------------------------------


@pytest.fixture
def doubtful() -> Recording:
    """Return people whose ids change every second row."""
    time, who, place = stream()
    return recorded(time, 1000 * who + np.tile(np.arange(ROWS), who[-1] + 1) // 2, place)


def test_doubts_of_a_recording_reach_runs_tables_and_worlds(doubtful: Recording) -> None:
    scenes = [each.scenario for each in scenarios.crossings(doubtful, runs=3)]
    law = nav.Khatib()
    results = [
        nav.simulate(scenes[0], law),
        nav.simulate_batch(scenes, law),
        nav.simulate_many(scenes, [law]),
        nav.simulate(replace(scenes[0], seed=3), law),
        scenarios.with_recording(doubtful, 0.5),
        nav.simulate(scenarios.with_recording(doubtful, 0.5, time_limit=1.0)),
    ]
    for result in results:
        assert "broken_tracks" in {each.code for each in unsafe_doubts(result.warnings)}


def test_doubts_that_are_none_are_refused() -> None:
    for make in (
        lambda given: nav.Scenario(start=(0, 0), goal=(3, 0), doubts=given),
        lambda given: nav.World(doubts=given),
    ):
        with pytest.raises(nav.InvalidParameterError, match=r"doubts\[0\] must be a ResultWarning"):
            make(["doubt"])
        with pytest.raises(nav.InvalidParameterError, match="doubts must be a sequence of warnings"):
            make(7)
    doubt = ResultWarning("implausible", "people", "they are cows")
    assert nav.Scenario(start=(0, 0), goal=(3, 0), doubts=[doubt]).warnings == (doubt,)


def test_a_benchmark_tells_the_doubts_of_its_recordings(doubtful: Recording, tmp_path: Path) -> None:
    result = benchmark("recordings", ["khatib"], cases=3, data=written(tmp_path / "walk.csv", doubtful))
    assert "broken_tracks" in {each.code for each in unsafe_doubts(result.warnings)}


# ---- people who are lost near a robot --------------------------------------------------------------


def test_somebody_who_is_lost_near_the_way_is_doubted_and_nothing_passes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    time, who, place = stream()
    seen = (place[:, 0] < 1.0) | (who % 2 == 0)  # the middle of the ways is at 2 m
    lost = recorded(time[seen], who[seen], place[seen])
    assert main(["simulate", "--people", str(written(tmp_path / "lost.csv", lost)), "--runs", "6"]) in (0, None)
    out = capsys.readouterr()
    assert "may have been touched" in out.err
    assert "\npassed" not in out.out


@settings(max_examples=30, deadline=None)
@given(ahead=st.floats(0.7, 1.5), side=st.floats(-0.4, 0.4), appears=st.booleans())
def test_who_vanishes_or_appears_within_reach_of_the_robot_is_doubted(ahead: float, side: float, appears: bool) -> None:
    law = nav.Khatib()
    alone = nav.simulate(nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0)), law)
    row = len(alone.time) // 2
    instant, (x, y) = float(alone.time[row]), alone.position[row]
    # Seen for a second, far from the robot but for the last (first) place.
    time = instant + (0.2 * np.arange(6) if appears else -0.2 * np.arange(6)[::-1])
    way = np.linspace((x + ahead, y + side), (x + ahead, y + side + 1.0), 6)
    place = way if appears else way[::-1]
    walk = Recording(
        time_s=np.append(time, time[-1] + 100.0), person=[7] * 6 + [9], position=np.vstack([place, [(50.0, 50.0)]])
    )
    assert [each.code for each in walk.lost_near(alone, start_time=0.0)] == ["lost_nearby"]
    away = replace(alone, position=alone.position + np.array([0.0, 40.0]))
    assert walk.lost_near(away, start_time=0.0) == ()


def test_somebody_whose_id_changes_is_not_lost_unless_the_robot_is_in_between() -> None:
    law = nav.Khatib()
    alone = nav.simulate(nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0)), law)
    time = np.arange(0.0, alone.time[-1], 0.2)
    place = np.stack([time, np.full(len(time), 1.5)], axis=1)
    ids = np.arange(len(time)) // 4
    beside = Recording(
        time_s=np.append(time, 90.0), person=np.append(ids, 99), position=np.vstack([place, [(50.0, 50.0)]])
    )
    found = beside.lost_near(alone, start_time=0.0)
    # Only the last one, who is lost while the robot arrives.
    assert all("more people" not in each.message for each in found)


def test_an_arrival_after_the_end_of_the_recording_is_doubted() -> None:
    run = nav.simulate(nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0)), nav.Khatib())
    walk = Recording(time_s=[0.0, 1.0], person=[7, 7], position=[[50.0, 50.0], [51.0, 50.0]])
    assert [each.code for each in walk.lost_near(run, start_time=0.0)] == ["recording_ended"]
    with pytest.raises(nav.InvalidParameterError, match="person_radius"):
        walk.lost_near(run, start_time=0.0, person_radius=-1.0)


def test_the_command_names_each_doubt_once(capsys: pytest.CaptureFixture[str], shared: Path) -> None:
    main(["simulate", "--people", str(shared / "data/pedestrians/zara01.csv"), "--runs", "6"])
    lines = [line for line in capsys.readouterr().err.splitlines() if "warning:" in line]
    assert len(lines) < 4


def test_doubts_of_a_recording_are_looked_for_when_asked_and_pickled_without_it(doubtful: Recording) -> None:
    scene = scenarios.crossings(doubtful, runs=1)[0].scenario
    world = scenarios.with_recording(doubtful, 0.0, time_limit=0.1)
    assert doubtful._warnings is None
    assert pickle.loads(pickle.dumps(scene)).warnings == scene.warnings
    assert pickle.loads(pickle.dumps(world)).warnings == world.warnings
    assert "broken_tracks" in codes(scene)
    assert isinstance(pickle.loads(pickle.dumps(scene)).doubts, tuple)
