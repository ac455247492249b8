"""The arena: episodes, how entries stand, what is kept, and its command."""

from __future__ import annotations

import shlex
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import arena, scenarios
from hrsafety import navigation as nav
from hrsafety.arena.episodes import METRICS
from hrsafety.arena.leaderboard import _against_best, _fronts
from hrsafety.cli import main
from hrsafety.errors import InvalidParameterError

LAWS = ["straight", "orca(horizon=2)", "straight+barrier"]
FEW: dict[str, Any] = {"scenes": ["frontal_approach", "join_group"], "seeds": 3, "people": ["not_reacting"]}


@pytest.fixture(scope="module")
def board() -> arena.Leaderboard:
    return arena.run(LAWS, **FEW, sensing=["exact", "noise_delay"])


def same(first: arena.Leaderboard, second: arena.Leaderboard) -> bool:
    """Return whether two hold the same bits."""
    return list(first.episodes) == list(second.episodes) and all(
        np.array_equal(values, second.episodes[cell][name], equal_nan=values.dtype.kind == "f")
        for cell, own in first.episodes.items()
        for name, values in own.items()
    )


def test_an_episode_is_the_run_of_its_world(board: arena.Leaderboard) -> None:
    law = nav.laws.BorensteinKoren(attractive_gain=50.0, repulsive_gain=0.0)
    found = board.episodes[arena.ArenaCell("straight", "not_reacting", "exact")]
    for seed in range(3):
        world = scenarios.social("join_group", seed, reacting=False)
        map = nav.StaticMap.from_polylines(world.walls) if world.walls else None
        run = nav.simulate(world, nav.SafeNavigation(law, map=map, guide=nav.maps.Guide()))
        end = found["end"][1, seed]
        assert (end == "success") == (run.outcomes == ("arrived",))
        if end == "success":
            assert found["arrival_time"][1, seed] == run.robot_arrival_time[0]
        assert (end == "by_robot") == (run.contacts_toward > 0)


def test_every_question_of_the_cards_is_answered_in_some_scene() -> None:
    found = arena.run(["straight"], seeds=1, people=["reacting", "not_reacting"])
    for metric in METRICS:
        known = np.stack([np.isfinite(cell[metric]) for cell in found.episodes.values()])
        assert known.any(), metric
    reacting, others = found.episodes.values()
    # Who does not notice the robot is not kept up by it.
    assert np.nanmax(np.abs(others["person_delay"])) == 0.0
    assert np.nanmax(np.abs(reacting["person_delay"])) > 0.0


def test_shares_add_up_and_straight_is_the_worst(board: arena.Leaderboard) -> None:
    for row in board.standings():
        parts = (row.success, row.by_robot, row.wall, row.by_person, row.late, row.lost)
        assert sum(each.value for each in parts) == pytest.approx(1.0)
        assert row.rank_low <= row.rank <= row.rank_high
        assert 0.0 <= row.front <= 1.0
        assert not row.time_ratio.runs or row.time_ratio.value > 0.5
    assert {each.cell.entry for each in board.standings()[:3]} == set(LAWS)
    assert board.standings()[2].cell.entry == "straight"
    codes = {each.code for each in board.warnings}
    assert {"few_runs", "filter_assumes_less"} <= codes


def test_bits_are_equal_resumed_in_an_executor_and_on_other_threads(board: arena.Leaderboard, tmp_path: Path) -> None:
    seen = {"sensing": ["exact", "noise_delay"]}
    arena.run(LAWS[:1], **{**FEW, "seeds": 2}, **seen, out=tmp_path)
    assert same(arena.run(LAWS, **FEW, **seen, out=tmp_path, threads=1), board)
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.npz")}
    assert same(arena.run(LAWS, **FEW, **seen, out=tmp_path), board)
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.npz")} == before
    with ThreadPoolExecutor(2) as executor:
        alone = arena.run(LAWS[2:], **FEW, executor=executor)
    cell = arena.ArenaCell(LAWS[2], "not_reacting", "exact")
    assert all(np.array_equal(alone.episodes[cell][name], board.episodes[cell][name]) for name in ("end",))


class Failing:
    """Raises, or asks for what is not finite, or drives on."""

    def velocity(self, situation: nav.Situation) -> tuple[float, float]:
        if situation.time > 2.0 and situation.position[0] > 0.5:
            raise ZeroDivisionError
        return 1.0, 0.0


def test_an_episode_in_which_a_law_fails_is_lost_and_named() -> None:
    found = arena.run({"mine": Failing(), "orca": "orca"}, **FEW)
    lost = {each.cell.entry: each.lost.value for each in found.standings()}
    assert lost == {"mine": 1.0, "orca": 0.0}
    (told,) = (each.message for each in found.warnings if each.code == "unfinished")
    assert "of mine are lost" in told
    assert "the law raised ZeroDivisionError" in told
    assert {each.cell.entry: each.by_robot.count for each in found.standings()}["mine"] == 0


def test_what_is_lost_is_no_contact_that_was_avoided() -> None:
    lost = np.array([["lost", "success"]]), np.array([["by_robot", "success"]])
    cells = [arena.ArenaCell(name, "reacting", "exact") for name in ("lost", "touches")]
    episodes = {
        cell: {"end": end, "arrival_time": np.where(end == "success", time, np.nan)}
        for cell, end, time in zip(cells, lost, (10.0, 8.0), strict=True)
    }
    board = arena.Leaderboard(
        scenes=("frontal_approach",), seeds=2, certificate=np.ones((1, 2)), episodes=episodes, warnings=()
    )
    fronts = {each.cell.entry: each.front for each in board.standings()}
    assert fronts["lost"] < 1.0
    assert fronts["lost"] < fronts["touches"]


def test_tests_are_paired_and_corrected() -> None:
    rng = np.random.default_rng(5)
    won = rng.random((4, 5, 20)) < np.array([0.9, 0.8, 0.5, 0.9])[:, None, None]
    values = _against_best(won, arena.ranks(won.astype(float)))
    best = int(np.argmax(won.mean(axis=(1, 2))))
    assert values[best] == 1.0
    plain = [nav.metrics.compare_paired(each.ravel(), won[best].ravel()).p_value for each in won]
    others = sorted((value, row) for row, value in enumerate(plain) if row != best)
    corrected = np.maximum.accumulate([value * (3 - place) for place, (value, _) in enumerate(others)])
    for (_, row), value in zip(others, corrected, strict=True):
        assert values[row] == pytest.approx(min(1.0, value))


def test_the_front_holds_who_is_not_beaten_in_both() -> None:
    touched = np.zeros((3, 1, 10), dtype=bool)
    touched[2] = True
    ratio = np.stack([np.full((1, 10), value) for value in (1.5, 1.2, 1.4)])
    assert _fronts(touched, ratio).tolist() == [0.0, 1.0, 0.0]
    ratio[2] = 1.0
    assert _fronts(touched, ratio).tolist() == [0.0, 1.0, 1.0]
    ratio[1] = np.nan
    assert _fronts(touched, ratio).tolist() == [1.0, 0.0, 1.0]


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("laws", {"laws": []}),
        ("laws", {"laws": ["orca", "orca"]}),
        ("laws", {"laws": ["nobody"]}),
        ("scenes", {"scenes": ["nowhere"]}),
        ("seeds", {"seeds": 0}),
        ("people", {"people": []}),
        ("sensing", {"sensing": ["radar"]}),
    ],
)
def test_bad_arguments_are_named(name: str, given: dict[str, Any]) -> None:
    with pytest.raises(InvalidParameterError, match=name):
        arena.run(**{"laws": ["orca"], **FEW, **given})


def test_a_command_of_the_page_gives_its_row_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = "arena --laws straight straight+barrier --scenes join_group --seeds 2 --people not_reacting"
    assert main([*words.split(), "--out", str(tmp_path / "one")]) == 0
    page = (tmp_path / "one" / "arena.html").read_text(encoding="utf-8")
    command = (
        "hrsafety arena --laws straight+barrier --scenes join_group --seeds 2 --people not_reacting --sensing exact"
    )
    assert command in page
    assert main([*words.split(), "--out", str(tmp_path / "two")]) == 0
    assert (tmp_path / "two" / "arena.html").read_text(encoding="utf-8") == page
    assert main([*shlex.split(command)[1:], "--out", str(tmp_path / "row")]) == 0
    alone = (tmp_path / "row" / "arena.html").read_text(encoding="utf-8")
    made = next(line for line in page.splitlines() if command in line)
    assert made in alone
    assert "<script>" in page
    assert "http" not in page.replace("http-equiv", "")
    capsys.readouterr()
    assert main(["arena", "--laws", "nobody"]) == 2
    assert "--laws" in capsys.readouterr().err


def test_files_are_entries(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(
        '[law]\ntype = "orca"\nhorizon = 2.0\n[safe.filter]\ntype = "barrier"\nmargin = 0.1\n', encoding="utf-8"
    )
    file = str(tmp_path / "mine.toml")
    found = arena.run([file], **FEW)
    law = nav.OptimalReciprocalCollisionAvoidance(horizon=2.0)
    same_law = arena.run({file: nav.SafeNavigation(law, filter=nav.laws.Barrier(margin=0.1))}, **FEW)
    assert same(found, same_law)
    for text, name in (
        ('[law]\ntype = "orca"\n[safe.filter]\nmargin = 0.1\n', "safe.filter.type"),
        ('[law]\ntype = "orca"\n[safe.filter]\ntype = "barrier"\nrate = 0\n', "safe.filter.rate"),
        ('[law]\ntype = "orca"\n[safe.filter]\ntype = "barier"\n', "barrier"),
        ('[law]\ntype = "orca"\n[robot]\n', "robot"),
        ("[safe]\n", "law"),
    ):
        (tmp_path / "bad.toml").write_text(text, encoding="utf-8")
        with pytest.raises(InvalidParameterError, match=name):
            arena.run([str(tmp_path / "bad.toml")], **FEW)
