"""``hrsafety optimize STUDY.toml``: what it finds and writes, how it stops and resumes, how it answers a bad file."""

from __future__ import annotations

import csv
import importlib.util
import inspect
import io
import json
import math
import re
import signal
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from api.cli_answers import error_line, written
from api.interrupting import LISTEN, needs_signals
from api.read_pages import page_of
from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.cli import examples, main, progress
from hrsafety.cli.optimize.file import load
from hrsafety.cli.parsers import parser

ROOT = Path(__file__).resolve().parents[3]
EXAMPLE = ROOT / "examples" / "gain_study.toml"
SMALL = """scenarios = ["c1", "c3"]
[law]
type = "virtual_force_field"
stabilizing = "off"
[search]
grid = [3, 3, 3, 3]
refinements = 1
survivors = 6
local_starts = 1
"""
NOISY = """start = [3.9, 0.6]
goal = [0.0, 0.6]
[[obstacles]]
type = "disc"
center = [2.45, 0.595]
radius = 0.1
critical_radius = 0.4
active_radius = 0.8
[measurement]
scale = 0.01
distribution = "gaussian"
"""
FEASIBILITY = 1e-6  # in the unit of a constraint: by how much a search may miss it
LIMIT = 60.0  # s, for a process that has been told to stop, on a loaded machine


def results(folder: Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    return content


def without_time(content: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in content.items() if name not in {"seconds", "study"}}


@pytest.fixture(scope="module")
def small_example(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """Run the shipped example with a small grid; return its folder and what it prints."""
    folder = tmp_path_factory.mktemp("gains")
    text = EXAMPLE.read_text(encoding="utf-8")
    for old, new in (
        ("grid = [11, 21, 21, 16]", "grid = [4, 5, 5, 4]"),
        ("refinements = 3", "refinements = 1"),
        ("survivors = 500", "survivors = 20"),
        ("local_starts = 20", "local_starts = 2"),
        ("grid = [8, 9, 9, 8]", "grid = [4, 4, 4, 4]"),
    ):
        assert old in text
        text = text.replace(old, new)
    path = written(folder / "small.toml", text)
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            f"from hrsafety.cli import main; exit(main({['optimize', path, '--out', str(folder)]}))",
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0
    assert all("the best gains lie on bounds" in line for line in done.stderr.splitlines())
    return folder, done.stdout


# ---- the example ------------------------------------------------------------------------------------


def test_example_is_the_search_that_is_the_default() -> None:
    study = load(str(EXAMPLE))
    assert study.names == ("c1", "c2", "c3")
    assert study.law == nav.VirtualForceField(stabilizing="off")
    defaults = {name: entry.default for name, entry in inspect.signature(nav.optimize_gains).parameters.items()}
    for name, value in study.search.items():
        if name not in {"bounds", "grid", "weights", "constraints"}:
            assert value == defaults[name], name
    assert study.search["weights"] == pytest.approx(defaults["weights"])
    assert study.search["grid"] == (11, 21, 21, 16)
    published = {"attractive_gain": 50.0, "repulsive_gain": 200.0, "detour_gain": 500.0, "gain_ratio": 3.0}
    assert study.search["bounds"] == {name: (0.0, high) for name, high in published.items()}
    assert study.search["constraints"] == ()
    assert study.compare["published optimum"] == (4.3, 20.3, 240.7, 0.68)


def test_example_writes_page_values_and_pictures(small_example: tuple[Path, str]) -> None:
    folder, text = small_example
    names = {"summary.html", "results.json", "front.csv", "flatness.png", "sensitivity.png", "history.png", "front.png"}
    names |= {f"paths-{name}.png" for name in ("c1", "c2", "c3")}
    assert {path.name for path in folder.iterdir()} == names | {"small.toml"}
    for name in names:
        assert f"wrote {folder / name}" in text


def test_page_is_whole_and_says_what_the_values_say(small_example: tuple[Path, str]) -> None:
    folder, _ = small_example
    text = (folder / "summary.html").read_text(encoding="utf-8")
    page = page_of(text)
    assert page.images == 7
    assert "http" not in text
    found, words = results(folder), " ".join(page.texts)
    assert f"{found['best_value']:.5f}" in words
    assert f"{found['evaluations']:,} gain sets" in words
    assert "Pareto front" in words
    for entry in found["gain_sets"]:
        assert entry["name"] in words
        assert f"{entry['value']:.5f}" in words
        for run in entry["scenarios"].values():
            assert f"{run['performance']:.4f}" in words


def test_values_are_those_of_the_library(small_example: tuple[Path, str]) -> None:
    folder, text = small_example
    found = results(folder)
    study = load(str(folder / "small.toml"))
    search = nav.optimize_gains(study.scenarios, study.law, **study.search)
    assert tuple(found["best_gains"].values()) == search.best.gains
    assert found["best_value"] == search.best_value
    assert (found["evaluations"], found["failures"]) == (search.evaluations, search.failures)
    assert [entry["best_value"] for entry in found["history"]] == [entry.best_value for entry in search.grids]
    assert [entry["value"] for entry in found["local"]] == [entry.best_value for entry in search.local]
    flatness = search.flatness()
    assert found["flatness"]["low"] == dict(zip(flatness.gain_names, flatness.low.tolist(), strict=True))
    assert f"objective      performance {search.best_value:.5f}" in text
    assert study.front is not None
    front = nav.gains.pareto_front(study.scenarios, study.law, bounds=study.search["bounds"], **study.front)
    assert found["front"]["values"] == front.values.tolist()
    with (folder / "front.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["arrival_time_s"]) for row in rows] == front.values[:, 0].tolist()
    assert [float(row["detour_gain_N_per_m2"]) for row in rows] == front.gains[:, 2].tolist()


def test_gain_sets_to_compare_with_have_the_same_objective(small_example: tuple[Path, str]) -> None:
    folder, _ = small_example
    best, optimum, _ = results(folder)["gain_sets"]
    law = nav.VirtualForceField(
        attractive_gain=4.3, repulsive_gain=20.3, detour_gain=240.7, gain_ratio=0.68, stabilizing="off"
    )
    runs = [nav.evaluate(scenarios.configuration(name), law) for name in ("c1", "c2", "c3")]
    assert optimum["value"] == pytest.approx(math.fsum(run.total for run in runs) / 3.0, rel=1e-12)
    assert [run["arrival_time_s"] for run in optimum["scenarios"].values()] == [
        run.trajectory.arrival_time for run in runs
    ]
    assert best["value"] > optimum["value"] - 0.01


def test_checkpoints_are_gone_when_the_search_is_done(small_example: tuple[Path, str]) -> None:
    folder, _ = small_example
    assert not list(folder.glob("*.checkpoint"))


# ---- studies of other kinds -------------------------------------------------------------------------


def test_metric_that_is_to_be_small_is_told_as_it_is(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = SMALL + '[objective]\nmetric = "arrival_time"\n'
    assert main(["optimize", written(tmp_path / "fast.toml", text), "--out", str(tmp_path / "out")]) == 0
    found = results(tmp_path / "out")
    (best,) = found["gain_sets"]
    times = [run["arrival_time_s"] for run in best["scenarios"].values()]
    assert found["best_value"] == -best["value"] < 0.0
    assert best["value"] == pytest.approx(np.mean(times))
    assert f"objective      arrival time {best['value']:.5f} s" in capsys.readouterr().out


def test_constraint_of_one_scenario_is_kept(tmp_path: Path) -> None:
    limit = '[[constraints]]\nmetric = "arrival_time"\nat_most = {}\nscenario = "c1"\n'
    times = []
    for bound in (9.0, 5.96):
        text = SMALL.replace("survivors = 6", "survivors = 20") + limit.format(bound)
        assert main(["optimize", written(tmp_path / f"{bound}.toml", text), "--out", str(tmp_path / str(bound))]) == 0
        found = results(tmp_path / str(bound))
        assert found["settings"]["constraints"] == [
            {"metric": "arrival_time", "at_least": None, "at_most": bound, "scenario": "c1"}
        ]
        assert found["feasible"] is True
        times.append(found["gain_sets"][0]["scenarios"]["c1"]["arrival_time_s"])
    assert times[0] > 5.96 >= times[1] - FEASIBILITY


def test_study_that_no_gain_set_can_meet_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    limit = '[[constraints]]\nmetric = "arrival_time"\nat_most = 1.0\n'
    assert main(["optimize", written(tmp_path / "fast.toml", SMALL + limit), "--out", str(tmp_path / "out")]) == 3
    found = results(tmp_path / "out")
    assert (found["status"], found["feasible"]) == ("infeasible", False)
    assert found["violation"] > 0.0
    assert found["best_gains"] is found["best_value"] is None
    assert found["gain_sets"][0]["name"] == "nearest"
    printed, errors = capsys.readouterr()
    assert "best gains     none: no gain set keeps all constraints" in printed
    assert "hrsafety: nothing feasible: no gain set keeps all constraints" in errors
    page = (tmp_path / "out" / "summary.html").read_text(encoding="utf-8")
    assert "Not feasible: no gain set" in page
    assert "To mend it, widen the bounds" in page
    assert "Best gains" not in page


def test_study_in_which_nothing_arrives_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = SMALL + "[bounds]\nattractive_gain = [0.0, 0.001]\n"
    assert main(["optimize", written(tmp_path / "slow.toml", text), "--out", str(tmp_path / "out")]) == 3
    assert "no gain set arrives without a contact everywhere" in capsys.readouterr().err
    found = results(tmp_path / "out")
    assert found["settings"]["require_arrival"] is found["settings"]["cap_ratios"] is True
    assert found["shortcoming"].startswith("no gain set arrives")
    assert "widen the bounds" in found["remedy"]


def test_arrival_can_be_left_out_of_a_study(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = SMALL + "[bounds]\nattractive_gain = [0.0, 0.001]\n[objective]\nrequire_arrival = false\n"
    assert main(["optimize", written(tmp_path / "slow.toml", text), "--out", str(tmp_path / "out")]) == 0
    found = results(tmp_path / "out")
    assert (found["status"], found["feasible"]) == ("found", False)
    assert "which the study allows" in capsys.readouterr().out
    assert "which the study allows" in (tmp_path / "out" / "summary.html").read_text(encoding="utf-8")


def test_scenario_files_and_noise_seeds_give_an_interval(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "disc.toml").write_text(NOISY, encoding="utf-8")
    text = SMALL.replace('"c1", "c3"', '"disc.toml"') + '[noise]\nseeds = 3\nrobustness = "lower_bound"\n'
    assert main(["optimize", written(tmp_path / "noisy.toml", text), "--out", str(tmp_path / "out")]) == 0
    found = results(tmp_path / "out")
    assert list(found["best_performance"]) == ["disc"]
    low, high = found["confidence"]["low"], found["confidence"]["high"]
    assert low <= found["confidence"]["mean"] <= high
    assert f"interval [{low:.5f}, {high:.5f}]" in capsys.readouterr().out
    assert "single runs with the noise seed" in (tmp_path / "out" / "summary.html").read_text(encoding="utf-8")


def test_global_method_has_its_own_budget_and_history(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = 'scenarios = ["c1"]\n[search]\nmethod = "differential_evolution"\nevaluations = 200\nseed = 3\n'
    assert main(["optimize", written(tmp_path / "global.toml", text), "--out", str(tmp_path / "out")]) == 0
    found = results(tmp_path / "out")
    assert found["history"] == []
    assert 0 < found["evaluations"] <= 260
    assert found["convergence"][-1][1] == pytest.approx(found["best_value"])
    assert "differential evolution" in capsys.readouterr().out


def test_many_scenarios_are_summed_up(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    names = [f"scene_{index}.toml" for index in range(23)]
    for index, name in enumerate(names):
        scene = NOISY[: NOISY.index("[measurement]")].replace("0.595", f"{0.5 + 0.01 * index}")
        (tmp_path / name).write_text(scene, encoding="utf-8")
    text = SMALL.replace('["c1", "c3"]', json.dumps(names))
    assert main(["optimize", written(tmp_path / "many.toml", text), "--out", str(tmp_path / "out")]) == 0
    printed = capsys.readouterr().out
    assert "scene_7 and 15 more" in printed
    assert "and 3 more scenarios in results.json" in printed
    found = results(tmp_path / "out")
    (best,) = found["gain_sets"]
    assert len(best["scenarios"]) == 23
    scores = [run["performance"] for run in best["scenarios"].values()]
    assert f"{min(scores):.4f}  {np.mean(scores):.4f}" in " ".join(printed.split("\n"))
    assert len(list((tmp_path / "out").glob("paths-*.png"))) == 8
    page = (tmp_path / "out" / "summary.html").read_text(encoding="utf-8")
    assert "Of 23 scenarios the first 8 are drawn." in page
    assert "All 23 scenarios" in page


def test_minimal_study_without_a_law_searches_without_stabilizing_force(tmp_path: Path) -> None:
    path = written(tmp_path / "minimal.toml", 'scenarios = ["c1"]\n')
    study = load(path)
    assert (study.law, study.front, study.compare, study.title) == (None, None, {}, "Gains")
    assert study.search == {"bounds": {}, "constraints": ()}


def test_law_of_a_scenario_file_is_searched_and_none_is_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = NOISY[: NOISY.index("[measurement]")]
    (tmp_path / "full.toml").write_text(scene + '[law]\ntype = "vff"\nstabilizing = "full"\ndetour_gain = 9.0\n')
    (tmp_path / "safe.toml").write_text(scene + "[safe.shield]\n")
    full, of_study = 'scenarios = ["full.toml"]\n', '[law]\ntype = "virtual_force_field"\nstabilizing = '
    for text in (full, full + of_study + '"full"\n'):
        law = load(written(tmp_path / "study.toml", text)).law
        assert law is not None
        assert law.stabilizing == "full"
    for text, words in (
        (full + of_study + '"off"\n', "law must be the law of the scenario file full.toml"),
        ('scenarios = ["safe.toml"]\n', "with nothing around it, got safe.toml with virtual force field"),
    ):
        assert main(["optimize", written(tmp_path / "study.toml", text), "--out", str(tmp_path / "out")]) == 2
        assert words in error_line(capsys)


# ---- stopping and continuing --------------------------------------------------------------------------

# Runs the command and tells on stdout how far the search is, and its best value, not finite at first.
INTERRUPTED = """
import contextlib, sys
from hrsafety import cli
from hrsafety.cli import progress

@contextlib.contextmanager
def told(**_):
    yield lambda stage, done, total, best: print(stage, done, total, best, flush=True)

progress.live = told
sys.exit(cli.main(sys.argv[1:]))
"""
LONG = SMALL.replace("[3, 3, 3, 3]", "[16, 16, 16, 16]").replace("survivors = 6", "survivors = 50")


@needs_signals
def test_ctrl_c_keeps_the_best_so_far_and_resume_ends_with_the_same_result(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, out = written(tmp_path / "long.toml", LONG), tmp_path / "out"
    arguments = ["optimize", path, "--out", str(out), "--threads", "1"]
    process = subprocess.Popen(
        [sys.executable, "-c", LISTEN + INTERRUPTED, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    begun = next(line for line in process.stdout if math.isfinite(float(line.split()[-1])))
    assert begun.startswith("grid 1 ")
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=LIMIT)
    assert process.returncode == 130, errors
    assert "hrsafety: interrupted; best of " in errors
    assert f"resume with: hrsafety optimize {path} --out {out} --resume" in errors
    assert {entry.name for entry in out.iterdir()} == {"best_so_far.json", "search.checkpoint"}
    so_far = json.loads((out / "best_so_far.json").read_text(encoding="utf-8"))
    assert so_far["interrupted"] is True
    assert 0 < so_far["evaluations"] < 2 * 16**4

    assert main(arguments) == 2
    line = error_line(capsys)
    assert f"--out must hold no unfinished search without --resume, got {out / 'search.checkpoint'}" in line
    assert "add --resume to continue it, or remove" in line
    assert "nothing" not in line
    assert main([*arguments, "--resume"]) == 0
    assert "since it was resumed" in capsys.readouterr().out
    assert main(["optimize", path, "--out", str(tmp_path / "whole")]) == 0
    assert "since it was resumed" not in capsys.readouterr().out
    resumed, whole = results(out), results(tmp_path / "whole")
    assert without_time(resumed) == without_time(whole)
    assert resumed["best_value"] >= so_far["best_value"]
    assert not {"search.checkpoint", "best_so_far.json"} & {entry.name for entry in out.iterdir()}


def test_resume_without_anything_to_resume_starts_afresh(tmp_path: Path) -> None:
    path = written(tmp_path / "small.toml", SMALL)
    for name, options in (("first", ["--resume"]), ("second", [])):
        assert main(["optimize", path, "--out", str(tmp_path / name), *options]) == 0
    assert without_time(results(tmp_path / "first")) == without_time(results(tmp_path / "second"))


def test_checkpoint_of_another_study_is_refused_with_the_setting_that_differs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = load(written(tmp_path / "small.toml", SMALL))
    kept = tmp_path / "kept.checkpoint"
    nav.optimize_gains(study.scenarios, study.law, **study.search, checkpoint=kept)
    other = 'checkpoint = "kept.checkpoint"\n' + SMALL.replace("survivors = 6", "survivors = 7")
    assert main(["optimize", written(tmp_path / "o.toml", other), "--out", str(tmp_path / "out"), "--resume"]) == 2
    line = error_line(capsys)
    assert "checkpoint must be of the same settings" in line
    assert "survivors" in line
    assert kept.exists()
    assert not (tmp_path / "out").exists()


# ---- progress ---------------------------------------------------------------------------------------


class Terminal(io.StringIO):
    """A text stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def test_progress_is_shown_as_lines_on_a_terminal_without_rich(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    monkeypatch.setattr(sys, "stderr", Terminal())
    with progress.live() as report:
        assert report is not None
        report("grid 1", 0, 81, math.nan)
        report("grid 1", 40, 81, 0.5)
        report("grid 1", 81, 81, 0.6)
        report("local", 1, 2, 0.61)
    lines = sys.stderr.getvalue().splitlines()  # type: ignore[attr-defined]  # a Terminal
    assert lines == [
        "grid 1: 0 of 81, nothing yet",
        "grid 1: 81 of 81, best 0.60000",
        "local: 1 of 2, best 0.61000",
    ]


def test_progress_is_a_bar_for_each_stage_with_rich(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("rich")
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", Terminal())
    with progress.live() as report:
        assert report is not None
        for stage in ("grid 1", "grid 2"):
            report(stage, 40, 81, 0.5)
            report(stage, 81, 81, 0.6)
    text = sys.stderr.getvalue()  # type: ignore[attr-defined]  # a Terminal
    assert re.search(r"grid 1 .*100%", text)
    assert re.search(r"grid 2 .*100%", text)
    assert "81/81" in text
    assert "best 0.60000" in text


def test_progress_is_silent_where_there_is_no_terminal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with progress.live() as report:
        assert report is None
    assert main(["optimize", written(tmp_path / "small.toml", SMALL), "--out", str(tmp_path / "out")]) == 0
    assert all("the best gains lie on bounds" in line for line in capsys.readouterr().err.splitlines())


# ---- bad files --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "named"),
    [
        (('scenarios = ["c1", "c3"]', ""), "scenarios must be given"),
        (('["c1", "c3"]', "[]"), "scenarios must name at least one scenario"),
        (('["c1", "c3"]', '["c1", "c9"]'), "scenarios[1] must be a scenario file or one of c1, "),
        (('["c1", "c3"]', '["c1", "c1"]'), "scenarios[1] must be a scenario that is not named before"),
        (('["c1", "c3"]', '"c1"'), "scenarios must be an array of texts"),
        (('["c1", "c3"]', '["bad_scene.toml"]'), "scenarios[0]: bad_scene.toml: goal must be given"),
        (("refinements = 1", "refinement = 1"), "search.refinement must be one of the keys method, grid"),
        (("refinements = 1", "refinements = -1"), "search.refinements must be"),
        (("refinements = 1", "refinements = 1.5"), "search.refinements must be an integer"),
        (("[3, 3, 3, 3]", "[3, 3, 3]"), "search.grid must be an array of 4 integers"),
        (("[3, 3, 3, 3]", "[3, 3, 0, 3]"), "search.grid[2] must be at least 1"),
        (("survivors = 6", "survivors = 0"), "search.survivors must be"),
        (("[search]", '[search]\nmethod = "luck"'), 'search.method must be one of "grid"'),
        (("[search]", "[search]\nevaluations = 100"), "search.evaluations must be None"),
        (('stabilizing = "off"', 'stabilizing = "of"'), "law.stabilizing must be"),
        (('stabilizing = "off"', "attractive_gain = 3.0"), "law.attractive_gain must be one of the keys type"),
        (("[search]", "[bounds]\nattractive_gain = [5.0, 1.0]\n[search]"), "bounds"),
        (("[search]", "[bounds]\nattractive_gain = [-5.0, 1.0]\n[search]"), "bounds"),
        (("[search]", "[bounds]\nK_1 = [0.0, 1.0]\n[search]"), "bounds.K_1 must be one of the keys attractive_gain"),
        (
            ("[search]", "[bounds]\nattractive_gain = 4.0\n[search]"),
            "bounds.attractive_gain must be an array of 2 numbers",
        ),
        (("[search]", '[objective]\nmetric = "beauty"\n[search]'), "objective.metric must be one of performance"),
        (
            ("[search]", "[objective]\nweights = [1.0, 2.0]\n[search]"),
            "objective.weights must be an array of 3 numbers",
        ),
        (("[search]", "[objective]\nweights = [1.0, -2.0, 1.0]\n[search]"), "objective.weights"),
        (("[search]", '[[constraints]]\nmetric = "energy"\n[search]'), "constraints[0]"),
        (("[search]", "[[constraints]]\nat_least = 1.0\n[search]"), "constraints[0].metric must be given"),
        (
            ("[search]", '[[constraints]]\nmetric = "energy"\nat_most = 4.0\nscenario = "c2"\n[search]'),
            "constraints[0].scenario must be one of c1, c3",
        ),
        (("[search]", "[noise]\nseeds = 0\n[search]"), "noise.seeds must be"),
        (("[search]", '[noise]\nseeds = 2\nrobustness = "best"\n[search]'), "noise.robustness must be"),
        (("[search]", "[run]\nstep = 0.0\n[search]"), "run.step must be"),
        (("[search]", "[run]\ntime_limit = 0.0\n[search]"), "run.time_limit must be"),
        (
            ("[search]", '[front]\nobjectives = ["energy"]\n[search]'),
            "front.objectives must name at least two different",
        ),
        (("[search]", '[front]\nobjectives = ["energy", "size"]\n[search]'), "front.objectives[1] must be one of"),
        (("[search]", "[front]\ngrid = [2, 2, 2, 0]\n[search]"), "front.grid[3] must be at least 1"),
        (("[search]", "[front]\nrefinements = -1\n[search]"), "front.refinements must be"),
        (("[search]", '[[compare]]\nname = "a"\n[search]'), "compare[0].attractive_gain must be given"),
        (("scenarios =", 'checkpoint = " "\nscenarios ='), "checkpoint must name a file"),
        (("[law]", "[law"), "must be a TOML file"),
    ],
)
def test_bad_file_is_answered_with_the_key_and_the_rule(
    change: tuple[str, str], named: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert change[0] in SMALL
    (tmp_path / "bad_scene.toml").write_text("start = [1.0, 0.0]\n", encoding="utf-8")
    path = written(tmp_path / "bad.toml", SMALL.replace(*change))
    assert main(["optimize", path, "--out", str(tmp_path / "out")]) == 2
    line = error_line(capsys)
    assert named in line
    assert "bad.toml" in line
    assert not (tmp_path / "out").exists()


def test_mistake_in_the_front_is_found_before_the_search(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(nav, "optimize_gains", lambda *_, **__: pytest.fail("the search has begun"))
    (tmp_path / "room.toml").write_text("start = [4.0, 0.0]\ngoal = [0.0, 0.0]\n", encoding="utf-8")
    text = SMALL.replace('"c1", "c3"', '"room.toml"') + '[front]\nobjectives = ["energy", "min_clearance"]\n'
    assert main(["optimize", written(tmp_path / "room_study.toml", text), "--out", str(tmp_path / "out")]) == 2
    assert "room_study.toml: front.objectives[1] must not be a clearance" in error_line(capsys)
    assert not (tmp_path / "out").exists()


def test_names_of_compared_gain_sets_are_unique(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    gains = "\n".join(f"{name} = 1.0" for name in nav.VirtualForceField.GAIN_NAMES)
    entry = f'[[compare]]\nname = "a"\n{gains}\n'
    path = written(tmp_path / "twice.toml", SMALL + 2 * entry)
    assert main(["optimize", path, "--out", str(tmp_path / "out")]) == 2
    assert "compare[1].name must be a name that no other gain set has, got 'a'" in error_line(capsys)


def test_missing_file_wrong_folder_and_bad_threads_are_clear(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["optimize", str(tmp_path / "none.toml"), "--out", str(tmp_path)]) == 2
    assert "path must name a readable file" in error_line(capsys)
    path, blocked = written(tmp_path / "small.toml", SMALL), written(tmp_path / "blocked", "")
    assert main(["optimize", path, "--out", blocked]) == 2
    assert "--out must be a folder or not exist" in error_line(capsys)
    assert main(["optimize", path, "--out", str(tmp_path / "out"), "--threads", "0"]) == 2
    assert "--threads must be" in error_line(capsys)


def test_help_has_an_example_and_the_example_is_complete(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["optimize", "--help"]) == 0
    assert "  hrsafety optimize " in capsys.readouterr().out
    lines = [line.split() for line in examples.OPTIMIZE.splitlines() if line.startswith("  hrsafety")]
    assert [parser().parse_args(words[1:]).resume for words in lines] == [False, True]
    keys = set(tomllib.loads(EXAMPLE.read_text(encoding="utf-8")))
    assert keys == {"title", "scenarios", "law", "bounds", "search", "objective", "run", "front", "compare"}
