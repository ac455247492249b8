from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import hrsafety
from api.cli_answers import error_line
from hrsafety import io, plotting, reproduce, scenarios
from hrsafety import navigation as nav
from hrsafety.cli import main

ROOT = Path(__file__).resolve().parents[3]
SHARED = Path(os.environ.get("HRSAFETY_SHARED", ROOT.parent / "shared"))
PEDESTRIANS = SHARED / "data" / "pedestrians"
FIRST_CROSSING = ROOT / "examples" / "my_first_crossing.toml"
PRINTED = 0.005
"""Half a unit of the last of two printed digits."""

C1 = """start = [3.9, 0.6]
goal = [0.0, 0.6]
[[obstacles]]
type = "disc"
center = [2.45, 0.595]
radius = 0.1
critical_radius = 0.4
active_radius = 0.8
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "c1.toml"
    path.write_text(C1)
    return path


@pytest.fixture
def people(tmp_path: Path) -> Path:
    """Return a file with 40 people who walk along the x axis so densely that some meet the robot."""
    rows = []
    for person in range(40):
        for k in range(41):
            step = person + k
            rows.append((step, person, -10.0 + 0.5 * k, float(person % 5 - 2)))
    path = tmp_path / "people.csv"
    lines = ["frame,t_s,ped_id,x_m,y_m"]
    lines += [f"{step * 10},{step * 0.4:.3f},{person},{x},{y}" for step, person, x, y in sorted(rows)]
    path.write_text("\n".join(lines) + "\n")
    return path


def table(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_version_is_that_of_the_package(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"hrsafety {hrsafety.__version__}\n"


@pytest.mark.parametrize("command", ["reproduce", "simulate"])
def test_every_command_has_help_with_an_example(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([command, "--help"]) == 0
    text = capsys.readouterr().out
    assert "example" in text
    assert f"  hrsafety {command} " in text


def test_the_examples_of_the_help_are_understood() -> None:
    from hrsafety.cli import examples
    from hrsafety.cli.parsers import parser

    lines = [line.split() for line in (examples.REPRODUCE + examples.SIMULATE).splitlines()]
    commands = [words[1:] for words in lines if words[:1] == ["hrsafety"]]
    assert len(commands) == 6
    for words in commands:
        assert parser().parse_args(words).command == words[0]


def test_law_names_of_the_help_are_those_of_files() -> None:
    from hrsafety.cli import LAW_NAMES
    from hrsafety.scenarios.laws import LAWS

    assert [name.replace("-", "_") for name in LAW_NAMES] == list(LAWS)


@pytest.mark.parametrize("name", ["masoud", "velocity-obstacle", "field-d-star"])
def test_another_law_drives_the_robot(name: str, scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from hrsafety.scenarios.laws import LAWS

    assert main(["simulate", str(scene), "--law", name]) == 0
    text = capsys.readouterr().out
    run = nav.simulate(scenarios.configuration("c1"), LAWS[name.replace("-", "_")]())
    assert f"law            {name.replace('-', ' ')}, " in text
    assert f"arrival time   {run.arrival_time:.2f} s" in text


def test_simulate_prints_what_the_library_computes(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", str(scene), "--stabilizing", "off"]) == 0
    text = capsys.readouterr().out
    score = nav.evaluate(scenarios.configuration("c1"), nav.VirtualForceField(stabilizing="off"))
    run = score.trajectory
    assert "arrived without a contact" in text
    assert f"arrival time   {run.arrival_time:.2f} s" in text
    assert f"performance H  {score.total:.3f}" in text
    assert f"{run.min_distance[0]:.3f}" in text


def test_options_change_law_and_stepping(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--gains", "4.3", "20.3", "240.7", "0.68", "--stabilizing", "capped", "--integrator", "rk4"]
    assert main(["simulate", str(scene), *options, "--step", "0.02", "--no-hold"]) == 0
    text = capsys.readouterr().out
    law = nav.VirtualForceField(
        attractive_gain=4.3, repulsive_gain=20.3, detour_gain=240.7, gain_ratio=0.68, stabilizing="capped"
    )
    run = nav.simulate(scenarios.configuration("c1"), law, integrator="rk4", step=0.02, hold=False)
    assert f"arrival time   {run.arrival_time:.2f} s" in text
    assert "stabilizing force capped" in text
    assert "rk4, step 0.02 s, force at every step" in text


def test_stabilizing_off_overrides_the_cap_of_the_file(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    law = '[law]\ntype = "virtual_force_field"\nstabilizing = "capped"\nstabilizing_force_cap = 10.0\n'
    scene.write_text(C1 + law)
    assert main(["simulate", str(scene), "--stabilizing", "off"]) == 0
    assert "stabilizing force off" in capsys.readouterr().out


def test_simulate_writes_trajectory_and_pictures(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = scene.parent / "new" / "folder"
    assert main(["simulate", str(scene), "--out", str(out)]) == 0
    run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
    rows = table(out / "trajectory.csv")
    assert len(rows) == len(run.time)
    assert [float(row["t_s"]) for row in rows] == run.time.tolist()
    assert [float(row["distance_0_m"]) for row in rows] == run.distance[:, 0].tolist()
    names = {path.name for path in out.iterdir()}
    pictures = {"paths.png", "time_sequence.png", "distances.png", "energy.png"}
    assert names == {"trajectory.csv", "player.html", "summary.html"} | pictures
    printed = capsys.readouterr().out
    assert all(name in printed for name in names)


def test_the_example_scenario_runs_without_obstacle_contact(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", str(FIRST_CROSSING)]) == 0
    assert "arrived without a contact" in capsys.readouterr().out


def test_a_scenario_without_obstacles_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "empty.toml"
    path.write_text("start = [4.0, 0.0]\ngoal = [0.0, 0.0]\n")
    assert main(["simulate", str(path)]) == 0
    assert "arrived without a contact" in capsys.readouterr().out


def test_animate_writes_a_picture_that_moves(scene: Path) -> None:
    from PIL import Image

    movie = scene.parent / "films" / "run.gif"
    assert main(["simulate", str(scene), "--animate", str(movie)]) == 0
    with Image.open(movie) as image:
        assert image.n_frames > 10


def test_people_are_crossed_as_the_library_does(people: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = people.parent / "out"
    report = people.parent / "report" / "all.json"
    options = ["--runs", "3", "--stabilizing", "off", "--out", str(out), "--json", str(report)]
    assert main(["simulate", "--people", str(people), *options]) == 0
    crossings = scenarios.crossings(io.load_people(people), runs=3)
    summary = nav.simulate_batch([run.scenario for run in crossings], nav.VirtualForceField(stabilizing="off"))
    rows = table(out / "runs.csv")
    assert [row["outcome"] for row in rows] == summary.outcome.tolist()
    assert [float(row["start_time_s"]) for row in rows] == [run.start_time for run in crossings]
    assert [int(row["contacts_standing"]) for row in rows] == summary.contacts_standing.tolist()
    met = table(out / "people.csv")
    assert len(met) == int(np.isfinite(summary.min_distance).sum())
    for row in met:
        run = int(row["run"])
        column = crossings[run].people.index(int(row["ped_id"]))
        assert float(row["min_distance_m"]) == summary.min_distance[run, column]
    written = json.loads(report.read_text())
    assert written["contacts_moving"] == summary.contacts_moving.sum()
    assert len(written["runs"]) == 3
    assert len(written["people"]) == len(met)
    text = capsys.readouterr().out
    assert f"{summary.contacts_moving.sum()} with the robot moving" in text
    assert f"{summary.contacts_standing.sum()} with the robot standing" in text
    assert summary.contacts_standing.sum() != summary.contacts_moving.sum()
    shown = [line.split() for line in text.splitlines() if line.split()[:1] in (["0"], ["1"], ["2"])]
    assert [row[0] for row in shown] == ["0", "1", "2"]
    assert [int(row[3]) for row in shown] == summary.entered_active.tolist()
    assert [row[4] for row in shown] == summary.outcome.tolist()
    assert [int(row[7]) + int(row[8]) for row in shown] == summary.contacts_moving.tolist()
    assert [int(row[9]) for row in shown] == summary.contacts_standing.tolist()


@pytest.mark.parametrize("chosen", [0, 2, None])
def test_the_chosen_run_or_the_one_that_met_most_people_is_animated(
    chosen: int | None, people: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    seen: list[nav.Trajectory] = []

    def film(trajectory: nav.Trajectory, path: str, progress: object) -> Path:
        assert progress is None  # only a terminal is told
        seen.append(trajectory)
        return Path(path)

    monkeypatch.setattr(plotting, "animate", film)
    options = ["--runs", "4", "--stabilizing", "off", "--animate", str(people.parent / "run.gif")]
    options += [] if chosen is None else ["--animate-run", str(chosen)]
    assert main(["simulate", "--people", str(people), *options]) == 0
    crossings = scenarios.crossings(io.load_people(people), runs=4)
    summary = nav.simulate_batch([run.scenario for run in crossings], nav.VirtualForceField(stabilizing="off"))
    expected = int(np.argmax(summary.entered_active)) if chosen is None else chosen
    assert [trajectory.scenario for trajectory in seen] == [crossings[expected].scenario]
    assert f"animated run  {expected}" in capsys.readouterr().out


def test_evenly_spaced_runs_can_be_asked_for(people: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "--people", str(people), "--runs", "3", "--selection", "even"]) == 0
    crossings = scenarios.crossings(io.load_people(people), runs=3, selection="even")
    lines = capsys.readouterr().out.splitlines()
    assert all(
        any(line.split()[:2] == [str(k), f"{run.start_time:.1f}"] for line in lines) for k, run in enumerate(crossings)
    )


BAD_COMMANDS = {
    "no command": ([], "required: COMMAND"),
    "unknown command": (["fly"], "invalid choice: 'fly'"),
    "nothing to simulate": (["simulate"], "needs either a scenario file or --people"),
    "both": (["simulate", "SCENE", "--people", "PEOPLE"], "needs either a scenario file or --people"),
    "missing file": (
        ["simulate", "nowhere.toml"],
        "path must name a readable file, got 'nowhere.toml'; no such file in",
    ),
    "missing people": (
        ["simulate", "--people", "nowhere.csv"],
        "path must name a readable file, got 'nowhere.csv'; no such file in",
    ),
    "not a scenario": (["simulate", "PEOPLE"], "must be a TOML file"),
    "not people": (["simulate", "--people", "SCENE"], "line 1 must have a column for a time or a frame and an id"),
    "three gains": (["simulate", "SCENE", "--gains", "1", "2", "3"], "--gains must be 4 numbers: attractive_gain"),
    "mode of another law": (["simulate", "SCENE", "--law", "masoud", "--stabilizing", "off"], "--stabilizing must"),
    "gain word": (["simulate", "SCENE", "--gains", "1", "2", "3", "x"], "--gains: must be a number, got 'x'"),
    "negative gain": (["simulate", "SCENE", "--gains", "1", "2", "-3", "0.1"], "detour_gain must"),
    "nan gain": (["simulate", "SCENE", "--gains", "1", "2", "nan", "0.1"], "detour_gain must"),
    "unknown law": (["simulate", "SCENE", "--law", "astar"], "got 'astar'; did you mean \"dstar\"?"),
    "unknown mode": (["simulate", "SCENE", "--stabilizing", "on"], "invalid choice: 'on'"),
    "step zero": (["simulate", "SCENE", "--step", "0"], "step must"),
    "step does not divide": (["simulate", "SCENE", "--step", "0.025"], "step must"),
    "out is a file": (["simulate", "SCENE", "--out", "SCENE"], "--out must be a folder or not exist"),
    "out below a file": (["simulate", "SCENE", "--out", "SCENE/below"], "c1.toml"),
    "film of unknown kind": (["simulate", "SCENE", "--animate", "run.txt"], "must"),
    "runs with scenario": (["simulate", "SCENE", "--runs", "3"], "--runs goes with --people only"),
    "no runs": (["simulate", "--people", "PEOPLE", "--runs", "0"], "--runs must be an integer from 1 to 100000, got 0"),
    "many runs": (["simulate", "--people", "PEOPLE", "--runs", "9999"], "runs must be at most"),
    "film of no run": (
        ["simulate", "--people", "PEOPLE", "--runs", "2", "--animate-run", "2"],
        "--animate-run must be from 0 to 1, got 2",
    ),
    "unknown part": (["reproduce", "--only", "everything"], "only must be among"),
    "reproduce into file": (["reproduce", "--out", "SCENE"], "out must be a folder or not exist"),
}


@pytest.mark.parametrize(("words", "message"), BAD_COMMANDS.values(), ids=BAD_COMMANDS.keys())
def test_an_error_is_one_line_and_exit_code_2(
    words: list[str],
    message: str,
    scene: Path,
    people: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(scene.parent)
    before = {path.name for path in scene.parent.rglob("*")}
    names = {"SCENE": str(scene), "PEOPLE": str(people), "SCENE/below": f"{scene}/below"}
    assert main([names.get(word, word) for word in words]) == 2
    assert message in error_line(capsys)
    assert {path.name for path in scene.parent.rglob("*")} == before


def test_an_error_in_a_scenario_names_file_and_key(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene.write_text(C1.replace("radius = 0.1", "radius = -0.1"))
    assert main(["simulate", str(scene)]) == 2
    assert "c1.toml: obstacles[0].radius must" in error_line(capsys)


def test_ctrl_c_ends_quietly_with_130(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def interrupt(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(reproduce, "run", interrupt)
    assert main(["reproduce"]) == 130
    assert capsys.readouterr().err == ""


def test_reproduce_hands_over_its_options(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    seen: dict[str, object] = {}

    def record(out: str, only: list[str] | None, progress: object, executor: object) -> Path:
        seen.update(out=out, only=only, progress=callable(progress), pool=executor is not None)
        return Path(out, "summary.html")

    monkeypatch.setattr(reproduce, "run", record)
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    assert main(["reproduce", "--only", "tables-6", "--only", "figures-6", "--out", str(tmp_path)]) == 0
    assert seen == {"out": str(tmp_path), "only": ["tables-6", "figures-6"], "progress": True, "pool": True}
    assert main(["reproduce", "--only", "tables-6", "--out", str(tmp_path)]) == 0
    assert not seen["pool"]
    assert "summary.html" in capsys.readouterr().out


def test_a_closed_pipe_is_no_traceback(scene: Path) -> None:
    command = (
        f'"{sys.executable}" -c "from hrsafety.cli import main; raise SystemExit(main())" simulate "{scene}" | true'
    )
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=False, timeout=120)
    assert done.stderr == ""


@pytest.mark.parametrize("name", ["zara01", "zara03"])
def test_recorded_scenes_are_crossed_at_many_start_times(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = PEDESTRIANS / f"{name}.csv"
    if not path.is_file():
        pytest.skip(f"needs {path.name} of the pedestrian data (HRSAFETY_SHARED)")
    report = tmp_path / "report.json"
    assert main(["simulate", "--people", str(path), "--json", str(report)]) == 0
    runs = json.loads(report.read_text())["runs"]
    assert len(runs) >= 20
    assert sum(run["entered_active"] >= 5 for run in runs) > len(runs) / 2
    assert "center to center" in capsys.readouterr().out
