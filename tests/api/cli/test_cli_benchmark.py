"""Benchmarks: protocols, resumption, the command line."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hrsafety import __version__
from hrsafety import navigation as nav
from hrsafety.benchmarks import benchmark, entry
from hrsafety.benchmarks.barn import barn_score
from hrsafety.benchmarks.protocol import Case
from hrsafety.benchmarks.results import Row, read_rows, row_text
from hrsafety.benchmarks.runs import _file
from hrsafety.benchmarks.suites import SUITES
from hrsafety.cli import main
from hrsafety.cli.parsers import SUITE_NAMES
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.laws import SafeNavigation


def test_names_of_the_command_line_are_those_of_the_suites() -> None:
    assert tuple(SUITES) == SUITE_NAMES


def test_entries() -> None:
    guarded = entry("orca+yielding+shield")
    assert guarded.parts == ("shield", "yielding")
    law = guarded.built(person_speed=1.0, preferred_speed=1.0)
    assert isinstance(law, SafeNavigation)
    assert entry("field").built(person_speed=1.0) == entry("field").law
    with pytest.raises(InvalidParameterError, match='did you mean "shield"'):
        entry("field+sheild")
    with pytest.raises(InvalidParameterError, match="laws"):
        entry("fild")


def test_the_draw_of_s5_is_that_of_the_protocol() -> None:
    case = Case(cases=[7], entry=entry("field"), person_speed=1.0, data=None, seed=1, threads=1)
    scene = SUITES["s5"].scene
    assert scene is not None
    place, _ = scene(case, 7)
    generator = np.random.default_rng(1)
    x, y = generator.uniform(2, 9, (2000, 12)), generator.uniform(-3, 3, (2000, 12))
    assert [each.center for each in place.obstacles] == [(x[7, k], y[7, k]) for k in range(12)]
    assert place.robot.max_speed == 1.0


def test_rows_are_kept_and_resumed(tmp_path: Path) -> None:
    first = benchmark("s4", ["orca"], cases=3, out=tmp_path)
    (file,) = tmp_path.glob(f"*-hrsafety{__version__}.csv")
    text = file.read_text(encoding="utf-8")
    file.write_text(text[:-20], encoding="utf-8")  # cut off within the last row
    assert len(read_rows(file)) == 2
    again = benchmark("s4", ["orca"], cases=5, out=tmp_path)
    assert [row.case for row in again.rows["orca"]] == [0, 1, 2, 3, 4]
    assert repr(list(again.rows["orca"][:3])) == repr(list(first.rows["orca"]))


def test_an_adversary_is_the_same_wherever_a_run_was_stopped(tmp_path: Path) -> None:
    whole = benchmark("adversary", ["orca"], cases=53)
    benchmark("adversary", ["orca"], cases=20, out=tmp_path)
    resumed = benchmark("adversary", ["orca"], cases=53, out=tmp_path)
    assert repr(list(resumed.rows["orca"])) == repr(list(whole.rows["orca"]))


def test_an_adversary_who_is_not_touched_at_fault_may_be_touched_and_hinder_the_arrival() -> None:
    rows = benchmark("adversary", ["field+shield"], cases=12).rows["field+shield"]
    assert all(row.at_fault == 0 for row in rows)
    assert any(row.contacts for row in rows)
    for row in rows:
        arrived = not np.isnan(row.arrival_time)
        expected = "collided" if row.contacts else "arrived" if arrived else "timed_out"
        assert row.outcome == expected


def test_rows_of_other_recordings_or_speeds_are_not_taken_for_these(tmp_path: Path) -> None:
    one, two, out = tmp_path / "one", tmp_path / "two", tmp_path / "out"
    for folder, shift in ((one, 0.0), (two, 0.5)):
        folder.mkdir()
        (folder / "people.csv").write_text(f"0,1,{shift},0", encoding="utf-8")
    settings = [(one, 1.6), (two, 1.6), (one, 1.6000000001)]
    names = {
        _file(out, SUITES["recordings"], entry("field"), {"person_speed": speed, "seed": 0, "data": folder})
        for folder, speed in settings
    }
    assert len(names) == 3


def test_errors_of_recorded_people_are_drawn_from_the_seed(shared: Path) -> None:
    data = shared / "data" / "pedestrians" / "zara01.csv"

    def clearances(seed: int | None, noise: float) -> list[float]:
        found = benchmark("recordings", ["orca"], data=data, cases=3, seed=seed, noise=noise)
        return [row.clearance for row in found.rows["orca"]]

    assert clearances(None, 0.02) == clearances(0, 0.02) != clearances(1, 0.02)
    assert clearances(0, 0.0) == clearances(1, 0.0)


@pytest.mark.parametrize(
    "line", ["x,arrived,1,1,0,0,0,1,nan", "0,arrived,1,1,-1,0,0,1,nan", "0,flown,1,1,0,0,0,1,nan", "0,arrived"]
)
def test_a_damaged_row_is_named(tmp_path: Path, line: str) -> None:
    benchmark("s4", ["orca"], cases=1, out=tmp_path)
    (file,) = tmp_path.glob("*.csv")
    file.write_text(f"{file.read_text(encoding='utf-8')}{line}\n", encoding="utf-8")
    with pytest.raises(InvalidParameterError, match="line 3"):
        benchmark("s4", ["orca"], cases=2, out=tmp_path)


def test_an_episode_that_two_runs_kept_counts_once(tmp_path: Path) -> None:
    benchmark("s4", ["orca"], cases=2, out=tmp_path)
    (file,) = tmp_path.glob("*.csv")
    text = file.read_text(encoding="utf-8")
    file.write_text(text + text.splitlines(keepends=True)[-1], encoding="utf-8")
    assert [row.case for row in benchmark("s4", ["orca"], cases=2, out=tmp_path).rows["orca"]] == [0, 1]


def test_shares_have_intervals() -> None:
    result = benchmark("s4", ["orca+shield+yielding"], cases=6)
    share = result.success("orca+shield+yielding")
    assert share.low < share.value <= share.high
    assert result.at_fault("orca+shield+yielding").value == 0.0


def test_the_command_prints_and_writes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "found"
    assert main(["benchmark", "s4", "--laws", "field", "--cases", "3", "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    assert "at fault %" in printed
    assert len(list(out.glob("*.html"))) == 1
    assert main(["benchmark", "recordings"]) == 2
    assert "--data" in capsys.readouterr().err


@pytest.mark.parametrize("changes", [{"suite": "s6"}, {"laws": []}, {"cases": 0}, {"person_speed": -1.0}])
def test_bad_calls(changes: dict[str, object]) -> None:
    given: dict[str, object] = {"suite": "s4", "laws": ["field"], "cases": 1} | changes
    with pytest.raises(InvalidParameterError):
        benchmark(**given)


BARN = Path(__file__).resolve().parents[4] / "shared" / "data" / "barn"


def test_gains_in_brackets() -> None:
    law = entry("field(attractive_gain=13)+guide+shield").law
    assert law == nav.VirtualForceField(attractive_gain=13)
    for word in ("field(atractive_gain=13)", "field(attractive_gain=x)", "field(attractive_gain=13", "orca(=1)"):
        with pytest.raises(InvalidParameterError, match="laws"):
            entry(word)


def test_barn_worlds_are_crossed_and_scored(tmp_path: Path) -> None:
    laws = ["field(attractive_gain=13)+guide+shield", "field"]
    result = benchmark("barn", laws, cases=4, data=BARN, out=tmp_path)
    assert result.success(laws[0]).value == 1.0
    assert result.mean_score(laws[0]) == 0.5
    assert result.accepted == {laws[0]: "99 / 0, score 0.495"}
    # Without a guide it stays in a local minimum or touches a wall, which is its own fault.
    for row in result.rows["field"]:
        assert row.outcome != "arrived"
        assert row.score == 0.0
        assert row.at_fault == row.contacts == (row.outcome == "collided")
    again = benchmark("barn", laws, cases=4, data=BARN, out=tmp_path)
    assert repr(again.rows) == repr({name: list(rows) for name, rows in result.rows.items()})
    with pytest.raises(InvalidParameterError, match="cases"):
        benchmark("barn", laws, cases=151, data=BARN)


@pytest.mark.parametrize(("time", "score"), [(5.0, 0.5), (20.0, 0.5), (40.0, 0.25), (80.0, 0.125), (99.0, 0.125)])
def test_the_score_is_that_of_the_challenge(time: float, score: float) -> None:
    row = Row(
        case=0, outcome="arrived", arrival_time=time, end_time=time, contacts=0, at_fault=0, apart=0, clearance=1.0
    )
    assert barn_score(row, 10.0).score == pytest.approx(score)
    assert barn_score(replace(row, outcome="collided"), 10.0).score == 0.0


def moving_worlds(place: Path) -> Path:
    file = place / "dynabarn.json"
    there = {"duration": 8.0, "keyframes": [[0.0, 5.0, -3.0], [6.0, 5.0, 3.0]]}
    back = {"duration": 4.0, "keyframes": [[0.0, 0.0, 3.0], [5.0, 0.0, -3.0]]}
    worlds = {str(number): ["there", "back"] for number in range(60)}
    file.write_text(json.dumps({"trajectories": {"there": there, "back": back}, "worlds": worlds}), encoding="utf-8")
    return file


def test_movers_of_dynabarn_follow_their_keyframes_in_a_loop(tmp_path: Path) -> None:
    case = Case(cases=[60], entry=entry("field"), person_speed=1.6, data=moving_worlds(tmp_path), seed=0, threads=1)
    scene = SUITES["dynabarn"].scene
    assert scene is not None
    place, law = scene(case, 60)
    assert isinstance(law, nav.VirtualForceField)
    run = nav.simulate(place, nav.VirtualForceField(), step=0.025)
    # One phase is 1.7 s; rounds of 8 s and 5 s.
    for index, period, speed, first in ((0, 8.0, 1.0, -3.0), (1, 5.0, -1.2, 3.0)):
        time = (run.time + 1.7) % period
        expected = first + speed * np.minimum(time, 6.0 if index == 0 else 5.0)
        off = np.abs(run.obstacle_position[:, index, 1] - expected)
        # At the end of a round, where the remainder is rounded, it may count to either round.
        assert np.sort(off)[-8] < 1e-4 if len(off) > 200 else (off < 1e-4).mean() > 0.95
    assert place.robot.max_acceleration == 10.0


def test_dynabarn_is_run_and_scored(tmp_path: Path) -> None:
    name = "field(attractive_gain=13)+yielding"
    result = benchmark("dynabarn", [name], cases=2, data=moving_worlds(tmp_path))
    assert result.success(name).value == 1.0
    assert 0.4 < result.mean_score(name) <= 0.5
    (tmp_path / "dynabarn.json").write_text('{"trajectories": {}, "worlds": {"0": ["nobody"]}}', encoding="utf-8")
    with pytest.raises(InvalidParameterError, match="trajectories by name"):
        benchmark("dynabarn3", [name], cases=1, data=tmp_path / "dynabarn.json")


@pytest.mark.parametrize("suite", ["circle_crossing", "circle_crossing_unseen", "antipodal", "corridor", "crossing"])
def test_suites_of_people_that_react_give_a_row_for_each_case(suite: str) -> None:
    found = benchmark(suite, ["orca+shield"], cases=2)
    rows = found.rows["orca+shield"]
    assert [row.case for row in rows] == [0, 1]
    assert {row.outcome for row in rows} <= {"arrived", "collided", "timed_out"}
    assert all(row.at_fault <= row.contacts for row in rows)


def test_rows_of_worlds_that_diverged_are_read_again(tmp_path: Path) -> None:
    row = Row(
        case=3,
        outcome="diverged",
        arrival_time=9.0,
        end_time=1.0,
        contacts=0,
        at_fault=0,
        apart=0,
        clearance=1.0,
        score=0.0,
    )
    file = tmp_path / "rows.csv"
    file.write_text(row_text([row], head=True), encoding="utf-8")
    assert read_rows(file) == [row]


def test_noise_and_delay_are_sensed_and_assumed_and_said(tmp_path: Path) -> None:
    settings = {"person_speed": 1.0, "data": None, "seed": 0, "threads": 1, "noise": 0.025, "latency": 0.1}
    case = Case(cases=[3], entry=entry("field+shield"), **settings)
    scene = SUITES["crowd"].scene
    assert scene is not None
    place, law = scene(case, 3)
    assert place.measurement == nav.Measurement(scale=0.025, latency=0.1)
    assert isinstance(law, SafeNavigation)
    assert law.shield.latency == 0.1
    assert law.shield.position_error == pytest.approx(np.hypot(0.025, 0.025))
    exact = benchmark("crowd", ["field"], cases=12, out=tmp_path)
    late = benchmark("crowd", ["field"], cases=12, noise=0.025, latency=0.1, out=tmp_path)
    assert len(list(tmp_path.iterdir())) == 2
    assert [row.clearance for row in exact.rows["field"]] != [row.clearance for row in late.rows["field"]]
    assert "exact sensing" in exact.conditions
    assert "+-0.025 m" in late.conditions
    assert "0.1 s late" in late.conditions


@pytest.mark.parametrize("suite", ["antipodal", "circle_crossing", "corridor"])
def test_robots_among_people_who_react_sense_as_told(suite: str) -> None:
    late = benchmark(suite, ["orca"], cases=2, noise=0.025, latency=0.1)
    assert repr(late.rows) != repr(benchmark(suite, ["orca"], cases=2).rows)


def test_sensing_of_a_protocol_is_not_changed() -> None:
    with pytest.raises(InvalidParameterError, match="latency must be 0 in adversary"):
        benchmark("adversary", ["field"], cases=1, latency=0.1)
    with pytest.raises(InvalidParameterError, match="noise must be 0 or above"):
        benchmark("s4", ["field"], cases=1, noise=-0.1)
