"""Shares of words in groups of the rows of a sweep, against counts by hand and the Wilson interval."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from hrsafety import InvalidParameterError, impact, scenarios, sweep
from hrsafety import navigation as nav
from hrsafety.navigation.metrics import wilson
from hrsafety.sweep import shares as module

GAIN = sweep.Axis(name="gain", values=[3.0, 1.0, 2.0])
SEED = sweep.Axis(name="seed", low=0, high=19, scale="integer")
SPEED = sweep.Axis(name="speed", low=0.5, high=1.0, points=2)
WORDS = ("good", "bad", "never")


def drawn(seed: np.ndarray, gain: np.ndarray, speed: np.ndarray | None = None) -> dict[str, np.ndarray]:
    """Return words, flags and counts that hang on seed and gain."""
    bad = (seed * 7 + gain * 3) % 5 < gain
    more = np.zeros_like(seed) if speed is None else speed
    return {
        "end": np.where(bad, "bad", "good"),
        "touched": bad,
        "contacts": np.where(bad, seed, 0.0).astype(int),
        "time": seed + gain + more,
    }


STUDY = sweep.FunctionStudy(
    function=drawn,
    results=[
        sweep.Column(name="end", kind="word", words=WORDS),
        sweep.Column(name="touched", kind="flag"),
        sweep.Column(name="contacts", kind="integer"),
        sweep.Column(name="time", unit="s"),
    ],
)
RESULT = sweep.run(sweep.Grid([GAIN, SEED]), STUDY, chunk_rows=7)


def codes(table: sweep.SweepShares) -> list[str]:
    """Return the codes of the doubts of a table."""
    return [each.code for each in table.warnings]


def test_shares_are_those_counted_by_hand() -> None:
    table = RESULT.shares("end", by=["gain"])
    rows = zip(table.group["gain"], table.word, table.count, table.rows, strict=True)
    for row, (gain, word, count, of) in enumerate(rows):
        here = RESULT["gain"] == gain
        assert (count, of) == (int((RESULT["end"][here] == word).sum()), 20)
        expected = wilson(int(count), int(of))
        assert (table.share[row], table.low[row], table.high[row]) == (expected.value, expected.low, expected.high)
    assert table.group["gain"].tolist() == [1.0] * 3 + [2.0] * 3 + [3.0] * 3
    assert table.word.tolist() == [*WORDS] * 3
    assert list(table.columns()) == ["gain", "end", "count", "rows", "share", "low", "high"]
    assert table.warnings == ()


def test_what_never_happened_has_an_upper_end() -> None:
    table = RESULT.shares("end")
    never = table.word == "never"
    assert table.count[never].tolist() == [0]
    assert table.high[never] == pytest.approx(wilson(0, 60).high)
    assert table.count.sum() == len(RESULT)


def test_flags_and_counts() -> None:
    flags, counts = RESULT.shares("touched", by=["gain"]), RESULT.shares("contacts", by=["gain"])
    assert flags.word.tolist()[:2] == ["no", "yes"]
    assert counts.word.tolist()[:2] == ["none", "some"]
    # A bad row of seed 0 has 0 contacts.
    for gain in (1.0, 2.0, 3.0):
        here = RESULT["gain"] == gain
        some = (counts.group["gain"] == gain) & (counts.word == "some")
        assert counts.count[some].tolist() == [int((RESULT["contacts"][here] > 0).sum())]
        yes = (flags.group["gain"] == gain) & (flags.word == "yes")
        assert flags.count[yes].tolist() == [int(RESULT["touched"][here].sum())]


def test_groups_of_two_axes_and_of_samples() -> None:
    grid = sweep.run(sweep.Grid([GAIN, SPEED, SEED]), STUDY)
    table = grid.shares("touched", by=["speed", "gain"])
    assert [(a, b) for a, b in zip(table.group["speed"], table.group["gain"], strict=True)][::2] == list(
        itertools.product([0.5, 1.0], [1.0, 2.0, 3.0])
    )
    sampled = sweep.run(sweep.LatinHypercube([GAIN, SEED], 90, seed=1), STUDY)
    assert sampled.shares("end", by=["gain"]).rows.tolist() == [30] * 9
    by_seed = sampled.shares("end", by=["seed"])
    assert by_seed.group["seed"].tolist() == [float(seed) for seed in range(20) for _ in WORDS]
    assert by_seed.rows[:: len(WORDS)].tolist() == [int((sampled["seed"] == seed).sum()) for seed in range(20)]


def test_unfinished_groups_are_there_and_nothing_is_known_of_them(tmp_path: Path) -> None:
    part = sweep.run(sweep.Grid([GAIN, SEED]), STUDY, out=tmp_path / "part", chunk_rows=10, chunks="0:3")
    table = part.shares("end", by=["gain"])
    # The first axis is slowest, and its values stand in the order given: gain 3 is whole, 1 by half, 2 is missing.
    assert table.rows[:: len(WORDS)].tolist() == [10, 0, 20]
    missing = table.group["gain"] == 2.0
    assert np.isnan(table.share[missing]).all()
    assert (table.low[missing].tolist(), table.high[missing].tolist()) == ([0.0] * 3, [1.0] * 3)
    assert codes(table) == ["incomplete"]


def test_seeds_that_are_counted_twice_in_a_group_are_doubted() -> None:
    grid = sweep.run(sweep.Grid([GAIN, SPEED, SEED]), STUDY, chunk_rows=11)
    pooled = grid.shares("end", by=["gain"])
    assert codes(pooled) == ["repeated_seeds"]
    assert "60 of 120 rows" in pooled.warnings[0].message
    assert pooled.warnings[0].message.endswith("group by speed, too")
    assert not pooled.warnings[0].safe_side
    assert grid.shares("end", by=["gain", "speed"]).warnings == ()
    few = sweep.run(sweep.LatinHypercube([sweep.Axis(name="gain", low=1.0, high=3.0), SEED], 40), STUDY)
    assert few.shares("end").warnings[0].message.endswith("give each row a seed of its own")


NOISE = sweep.Axis(name="measurement_scale", values=[0.02, 0.05])
TENTH = sweep.Axis(name="seed", low=0, high=9, scale="integer")


def navigation(names: Sequence[str], **options: object) -> sweep.NavigationStudy:
    """Return a study of configurations of the source."""
    return sweep.NavigationStudy(scenarios={name: scenarios.configuration(name) for name in names}, **options)


def test_scenarios_are_groups_and_pooling_them_is_doubted() -> None:
    runs = sweep.run(sweep.Grid([NOISE, TENTH]), navigation(["c2", "c3"]))
    table = runs.shares("outcome", by=["scenario", "measurement_scale"])
    for row in range(len(table.word)):
        scene, scale = table.group["scenario"][row], table.group["measurement_scale"][row]
        here = (runs["scenario"] == scene) & (runs["measurement_scale"] == scale)
        assert table.rows[row] == here.sum() == 10
        assert table.count[row] == (runs["outcome"][here] == table.word[row]).sum()
    assert "repeated_seeds" not in codes(table)
    assert "repeated_seeds" in codes(runs.shares("outcome", by=["measurement_scale"]))
    gains = sweep.Sobol([sweep.Axis(name="detour_gain", low=10.0, high=90.0)], 8)
    pooled = sweep.run(gains, navigation(["c2", "c3"])).shares("outcome")
    assert [each.message for each in pooled.warnings if each.code == "repeated_seeds"] == [
        "8 of 16 rows have the row of the design of another one of their group: runs of one row of the design are "
        "alike, and intervals that count each of them may be too narrow; group by scenario, too"
    ]


def test_the_doubts_of_the_sweep_travel_and_are_not_told_twice() -> None:
    still = sweep.run(sweep.Grid([TENTH]), navigation(["c1"]))
    assert codes(still.shares("outcome")) == [each.code for each in still.warnings] == ["same_runs"]


def test_runs_that_are_the_same_are_found_where_no_look_before_the_sweep_found_them() -> None:
    # Only four of the scenarios are looked at before it runs; the fifth draws nothing.
    noisy = [
        nav.Scenario(
            robot=scene.robot,
            start=scene.start,
            goal=scene.goal,
            obstacles=scene.obstacles,
            measurement=nav.Measurement(scale=0.02),
        )
        for scene in [scenarios.configuration("c2")] * 4
    ]
    study = sweep.NavigationStudy(scenarios=[*noisy, scenarios.configuration("c1")])
    runs = sweep.run(sweep.Grid([TENTH]), study)
    assert "same_runs" not in [each.code for each in runs.warnings]
    table = runs.shares("outcome", by=["scenario"])
    (doubt,) = [each for each in table.warnings if each.code == "same_runs"]
    assert doubt.message.startswith("9 of 50 rows are the same run")


def test_rows_of_a_saltelli_design_are_not_independent() -> None:
    axes = [sweep.Axis(name="detour_gain", low=10.0, high=90.0), sweep.Axis(name="gain_ratio", low=0.1, high=1.0)]
    study = navigation(["c2"])
    (doubt,) = [
        each for each in sweep.run(sweep.Saltelli(axes, 4), study).shares("outcome").warnings if each.subject == "by"
    ]
    assert doubt.code == "repeated_seeds"
    assert doubt.message.startswith("12 of 16 rows have the base row of another one")
    assert doubt.message.endswith("take a Sobol design or a Latin hypercube for shares")
    assert "repeated_seeds" not in codes(sweep.run(sweep.Sobol(axes, 16), study).shares("outcome"))


def test_repeats_are_looked_for_in_the_first_rows_only(monkeypatch: pytest.MonkeyPatch) -> None:
    grid = sweep.run(sweep.Grid([GAIN, SPEED, SEED]), STUDY, chunk_rows=11)
    monkeypatch.setattr(module, "MOST_COMPARED", 50)
    assert "20 of the first 50 rows" in grid.shares("end", by=["gain"]).warnings[0].message


@pytest.mark.parametrize(
    ("name", "by", "rule"),
    [
        ("time", (), "name must be a column of words, flags or counts \\(end, touched, contacts\\)"),
        ("ent", (), 'did you mean "?end'),
        ("gain", (), "name must be one of"),
        ("end", ["gian"], 'did you mean "?gain'),
        ("end", "gain", "by must be names of axes"),
        ("end", ["gain", "gain"], "by must be different names"),
        ("end", ["touched"], "by must be one of"),
        ("end", 3, "by must be names of axes"),
    ],
)
def test_bad_input_names_the_rule(name: str, by: Sequence[str], rule: str) -> None:
    with pytest.raises(InvalidParameterError, match=rule):
        RESULT.shares(name, by=by)


def test_axes_without_levels_and_too_many_groups_are_refused() -> None:
    axes = [
        sweep.Axis(name="gain", low=1.0, high=3.0, points=4),
        sweep.Axis(name="seed", low=0, high=9e6, scale="integer"),
    ]
    sampled = sweep.run(sweep.LatinHypercube(axes, 8), STUDY)
    with pytest.raises(InvalidParameterError, match=r"name axes with levels.*gain.*give the axis values"):
        sampled.shares("end", by=["gain"])
    with pytest.raises(InvalidParameterError, match="by must make at most 10000000 rows"):
        sampled.shares("end", by=["seed"])


def test_counts_below_zero_and_names_of_the_table_are_refused() -> None:
    def given(share: np.ndarray) -> dict[str, np.ndarray]:
        return {"left": -share.astype(int), "count": share > 0.0}

    study = sweep.FunctionStudy(
        function=given, results=[sweep.Column(name="left", kind="integer"), sweep.Column(name="count", kind="flag")]
    )
    result = sweep.run(sweep.Grid([sweep.Axis(name="share", values=[0.0, 2.0])]), study)
    with pytest.raises(InvalidParameterError, match=r"none of them below 0.*left with -2"):
        result.shares("left")
    with pytest.raises(InvalidParameterError, match="name must not be that of a column of the table"):
        result.shares("count")
    with pytest.raises(InvalidParameterError, match="by must not have the name of another column"):
        result.shares("left", by=["share"])


def test_impacts_have_shares_of_their_status_and_tables_carry_the_doubts(tmp_path: Path) -> None:
    foam = sweep.Axis(name="foam_stiffness", values=[500.0, 20000.0])
    speeds = sweep.Axis(name="closing_speed", low=0.2, high=2.0, points=10)
    study = sweep.ImpactStudy(
        manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), fixed={"foam_damping": 70.0, "thickness": 0.02}
    )
    result = sweep.run(sweep.Grid([foam, speeds]), study)
    table = result.shares("status", by=["foam_stiffness"])
    assert table.count.sum() == 20
    assert table.warnings == result.warnings != ()
    table.to_csv(tmp_path / "shares.csv")
    assert (tmp_path / "shares.csv.warnings.csv").read_text().splitlines()[1].startswith(result.warnings[0].code)


def test_printed_shares_have_both_ends_of_their_intervals() -> None:
    axes = [sweep.Axis(name=name, values=[0.01, 0.02]) for name in ("measurement_scale", "measurement_latency")]
    seeds = sweep.Axis(name="seed", low=0, high=4, scale="integer")
    study = sweep.NavigationStudy(scenarios={name: scenarios.configuration(name) for name in ("c2", "n2")})
    shown = repr(
        sweep.run(sweep.Grid([*axes, seeds]), study).shares("outcome", by=[each.name for each in axes] + ["scenario"])
    )
    assert all(name in shown.split() for name in ("share", "low", "high"))


def test_robots_that_no_sweep_runs_are_refused_with_the_study() -> None:
    scene = nav.Scenario(start=(0.0, 0.0), goal=(2.0, 0.0), robot=nav.DifferentialDriveRobot())
    with pytest.raises(InvalidParameterError, match=r"scenarios\[0\].robot must be a HolonomicRobot"):
        sweep.NavigationStudy(scenarios=scene)


def test_every_number_of_a_shield_that_is_too_small_is_told() -> None:
    law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(position_error=0.001))
    axes = [
        sweep.Axis(name="measurement_scale", values=[0.05]),
        sweep.Axis(name="measurement_latency", values=[0.1]),
        sweep.Axis(name="seed", values=[0.0, 1.0]),
    ]
    found = sweep.run(
        sweep.Grid(axes), sweep.NavigationStudy(scenarios=scenarios.configuration("c2"), law=law)
    ).warnings
    subjects = {each.subject.rpartition(".")[2] for each in found if each.code == "shield_assumes_less"}
    assert {"position_error", "latency"} <= subjects
