"""``hrsafety sweep STUDY.toml``: what it prints and writes, how it resumes, how it answers a bad file."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from api.cli_answers import error_line, written
from api.interrupting import LISTEN
from api.read_pages import page_of
from hrsafety import impact, scenarios, sweep
from hrsafety import navigation as nav
from hrsafety.cli import main
from hrsafety.cli.sweep.file import load

ROOT = Path(__file__).resolve().parents[3]
IMPACTS, GAINS = ROOT / "examples" / "impact_sweep.toml", ROOT / "examples" / "gain_sweep.toml"
PATIENCE = 60.0
FAST = """
head = "minimum"
axes = [
    { name = "foam_stiffness", from = 5e3, to = 6e4, points = 4 },
    { name = "foam_damping", values = [0.0, 50.0, 100.0] },
]
[manipulator]
mass = 49.4
damping = 111.0
stiffness = 14400.0
[impact]
closing_speed = 1.25
"""
CROSSING = """
scenarios = ["c1", "c2"]
axes = [{ name = "detour_gain", from = 10.0, to = 30.0, points = 3 }]
"""


def images(path: Path) -> int:
    return page_of(path / "summary.html").images


def test_example_of_impacts_writes_maps_table_and_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "tables" / "all.npz"
    assert main(["sweep", str(IMPACTS), "--out", str(tmp_path / "out"), "--table", str(table)]) == 0
    text = capsys.readouterr().out
    assert "grid of 3,660 rows" in text
    assert images(tmp_path / "out") == 2
    for path in re.findall(r"^wrote (.*)$", text, re.MULTILINE):
        assert Path(path).stat().st_size > 1000
    result = sweep.open(tmp_path / "out")
    with np.load(table) as columns:
        np.testing.assert_array_equal(columns["hic15"], result["hic15"])
    shown = re.search(r"^max compression \(m\) +(\S+) +(\S+) +(\S+) +(\d+)$", text, re.MULTILINE)
    assert shown is not None
    found = result["max_compression"]
    expected = [f"{value:.5g}" for value in (found.min(), found.mean(), found.max())]
    assert list(shown.groups()) == [*expected, "0"]


def test_example_of_gains_writes_an_overview(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["sweep", str(GAINS), "--out", str(out)]) == 0
    assert "3,072 in 1 chunk" in capsys.readouterr().out
    assert images(out) == 4
    result = sweep.open(out)
    assert result.cases == ("c1", "c2", "c3")
    best = f"{result['performance_total'].max():.5g}"
    assert f">{best}</td>" in (out / "summary.html").read_text(encoding="utf-8")


NOISY = """
scenarios = ["c2", "c3"]
axes = [
    { name = "detour_gain", values = [0.0, 60.0] },
    { name = "measurement_scale", values = [0.05] },
    { name = "seed", from = 0, to = 19, scale = "integer" },
]
"""


def test_shares_of_outcomes_stand_on_page_and_terminal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study = written(tmp_path / "study.toml", NOISY)
    assert main(["sweep", study, "--out", str(tmp_path / "out")]) == 0
    printed = capsys.readouterr()
    result = sweep.open(tmp_path / "out")
    table = result.shares("outcome", by=["detour_gain", "measurement_scale", "scenario"])
    assert re.search(r"^ *detour gain .*scenario +rows +arrived +collided", printed.out, re.MULTILINE)
    text = " ".join(page_of(tmp_path / "out" / "summary.html").texts)
    for gain, scene in ((0.0, "c2"), (0.0, "c3"), (60.0, "c2"), (60.0, "c3")):
        here = (table.group["detour_gain"] == gain) & (table.group["scenario"] == scene)
        collided = int(table.count[here & (table.word == "collided")][0])
        line = re.search(rf"^ *{gain:g} +{scene} +20 (.*)$", printed.out, re.MULTILINE)
        assert line is not None
        share = f"{collided / 20:.1%} ("
        assert share in line[1]
        assert f"), {collided}" in line[1]
        assert share in text
        at_fault = int(
            (result["contacts_at_fault"][(result["detour_gain"] == gain) & (result["scenario"] == scene)] > 0).sum()
        )
        assert line[1].endswith(f"), {at_fault}")
        rows = (result["detour_gain"] == gain) & (result["scenario"] == scene)
        counts = [int((result[f"contacts_{what}"][rows] > 0).sum()) for what in ("moving", "standing")]
        assert re.findall(r"\), (\d+)", line[1])[-3:-1] == [str(count) for count in counts]
    assert "contact while it moves" in printed.out
    assert "contact while it stands" in text
    assert (result["contacts_at_fault"] > 0).sum() < (result["outcome"] == "collided").sum()
    # Nobody diverges in a scenario, and 0 of 20 say up to 16.2 %, rounded outwards.
    assert "diverged" not in printed.out
    assert "0.0% (0.0% to 16.2%), 0" in printed.out
    assert "of another one of their group" not in printed.err


def test_of_many_groups_the_page_says_how_to_get_the_shares(tmp_path: Path) -> None:
    study = written(
        tmp_path / "study.toml", NOISY.replace("values = [0.0, 60.0]", "from = 0.0, to = 60.0, points = 13")
    )
    assert main(["sweep", study, "--out", str(tmp_path / "out")]) == 0
    text = " ".join(page_of(tmp_path / "out" / "summary.html").texts)
    call = re.search(r"in 26 groups of rows: sweep\.open\(\.\.\.\)\.shares\(\"outcome\", by=(\[.*?\])\)", text)
    assert call is not None
    assert call[1] == "['detour_gain', 'scenario']"


def test_shares_are_told_of_draws_only(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sweep", written(tmp_path / "study.toml", CROSSING), "--out", str(tmp_path / "grid")]) == 0
    assert "collided" not in capsys.readouterr().out.split("begun")[1]
    kept = NOISY.replace("axes", 'outputs = ["end_time"]\naxes', 1)
    assert main(["sweep", written(tmp_path / "study.toml", kept), "--out", str(tmp_path / "kept")]) == 0
    assert "Outcomes" not in " ".join(page_of(tmp_path / "kept" / "summary.html").texts)


def test_seeds_that_change_nothing_are_told_beside_the_shares(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    still = NOISY.replace("[0.05]", "[0.0]")
    study = written(tmp_path / "study.toml", still)
    assert main(["sweep", study, "--out", str(tmp_path / "out"), "--strict"]) == 4
    assert "are the same run" in capsys.readouterr().err
    assert "are the same run" in " ".join(page_of(tmp_path / "out" / "summary.html").texts)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (NOISY.replace("[0.05]", "[0.0]"), "are the same run"),
        (NOISY.replace("[0.05]", "[0.05, 500.0]"), "measurement"),
        (FAST.replace("5e3, to = 6e4", "5.0, to = 60.0"), "foam_stiffness"),
        (FAST.replace("axes = [", 'design = { kind = "sobol", size = 12 }\naxes = ['), "not a power of two"),
    ],
)
def test_validate_tells_the_doubts_of_a_dry_run(
    text: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = written(tmp_path / "study.toml", text)
    assert main(["sweep", study, "--dry-run"]) == 0
    told = capsys.readouterr().err
    assert words in told
    assert main(["validate", study]) == 0
    checked = capsys.readouterr()
    assert checked.err == told
    assert re.search(r"sweep file, \d+ warning", checked.out)
    assert main(["validate", study, "--strict"]) == 4


def test_validate_refuses_what_a_sweep_refuses_and_writes_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    study = written(tmp_path / "study.toml", CROSSING.replace("detour_gain", "detour_gian"))
    for command in (["sweep", study, "--dry-run"], ["validate", study]):
        assert main(command) == 2
        assert "detour_gian" in error_line(capsys)
    assert [each.name for each in tmp_path.iterdir()] == ["study.toml"]


def test_table_is_written_as_csv_whatever_the_case_of_its_ending(tmp_path: Path) -> None:
    file, table = written(tmp_path / "a.toml", FAST), tmp_path / "rows.CSV"
    assert main(["sweep", file, "--out", str(tmp_path / "out"), "--table", str(table)]) == 0
    lines = table.read_text(encoding="utf-8").splitlines()
    assert len(lines) == 1 + len(sweep.open(tmp_path / "out"))
    assert lines[0].startswith("foam_stiffness_N_per_m,foam_damping_N_s_per_m,")


def test_one_axis_gives_a_line_for_each_scenario(tmp_path: Path) -> None:
    assert main(["sweep", written(tmp_path / "a.toml", CROSSING), "--out", str(tmp_path / "out")]) == 0
    assert images(tmp_path / "out") == 5
    for name in ("arrival_time", "contacts_moving", "contacts_standing"):
        assert (tmp_path / "out" / f"lines_{name}.png").exists()


def test_file_says_what_the_call_would(tmp_path: Path) -> None:
    described = load(written(tmp_path / "a.toml", FAST))
    study = sweep.ImpactStudy(
        manipulator=impact.Manipulator(mass=49.4, damping=111.0, stiffness=14400.0),
        head=impact.Head.minimum(),
        fixed={"closing_speed": 1.25},
    )
    assert described.study == study
    assert described.design == sweep.Grid(
        (
            sweep.Axis(name="foam_stiffness", low=5e3, high=6e4, points=4),
            sweep.Axis(name="foam_damping", values=(0.0, 50.0, 100.0)),
        )
    )


def test_processes_give_the_same_result_and_a_second_call_computes_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = written(tmp_path / "a.toml", "chunk_rows = 3\n" + FAST)
    assert main(["sweep", file, "--out", str(tmp_path / "one"), "--threads", "1"]) == 0
    assert main(["sweep", file, "--out", str(tmp_path / "two"), "--workers", "1"]) == 0
    assert "in 4 chunks" in capsys.readouterr().out
    chunks = {path: path.stat().st_mtime_ns for path in (tmp_path / "two" / "chunks").iterdir()}
    for path in chunks:
        assert path.read_bytes() == (tmp_path / "one" / "chunks" / path.name).read_bytes()
    assert main(["sweep", file, "--out", str(tmp_path / "two")]) == 0
    assert {path: path.stat().st_mtime_ns for path in chunks} == chunks


def test_damaged_chunk_is_told_in_a_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, out = written(tmp_path / "a.toml", FAST), tmp_path / "out"
    assert main(["sweep", file, "--out", str(out)]) == 0
    (out / "chunks" / "chunk-00000000.npz").write_bytes(b"")
    capsys.readouterr()
    assert main(["sweep", file, "--out", str(out)]) == 0
    assert re.match(r"hrsafety: .*npz is damaged and is computed again\n", capsys.readouterr().err)


def test_ctrl_c_says_what_is_finished_and_the_same_call_goes_on(tmp_path: Path) -> None:
    slow = CROSSING.replace("points = 3", "points = 40000").replace('"c2"', '"c2", "c3"')
    file, out = written(tmp_path / "a.toml", "chunk_rows = 500\n" + slow), tmp_path / "out"
    command = [sys.executable, "-c", LISTEN + "import sys; from hrsafety.cli import main; sys.exit(main(sys.argv[1:]))"]
    command += ["sweep", file, "--out", str(out), "--threads", "1"]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + PATIENCE
    while not list(out.glob("chunks/chunk-*.npz")):
        assert child.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.005)
    child.send_signal(signal.SIGINT)
    _, errors = child.communicate(timeout=PATIENCE)
    assert child.returncode == 130
    assert re.fullmatch(
        r"hrsafety: sweep stopped with \d+ of 40000 rows finished; they are in .*, the same call.*\n", errors
    )
    assert 0 < len(sweep.open(out).finished) < 80


def test_unbalanced_sobol_design_is_told_on_terminal_and_page(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sampled = FAST.replace(", points = 4", "").replace("values = [0.0, 50.0, 100.0]", "from = 0.0, to = 100.0")
    told = "size of the Sobol design is {}, not a power of two"
    for size, wrong in ((8, False), (9, True)):
        file = written(tmp_path / f"{size}.toml", f"{sampled}[design]\nkind = 'sobol'\nsize = {size}\n")
        assert main(["sweep", file, "--out", str(tmp_path / str(size))]) == 0
        page = (tmp_path / str(size) / "summary.html").read_text(encoding="utf-8")
        assert (f"warning: {told.format(size)}" in capsys.readouterr().err) == wrong
        assert (f'<div class="banner no"><strong>Warnings</strong><ul><li>{told.format(size)}' in page) == wrong


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "axes must be given"),
        ("x = 1", "x must be one of the keys"),
        ("axes = 3", "axes must be an array of tables"),
        ("axes = []\n" + FAST.split("]\n", 1)[1], "design.axes must hold at least one"),
        (FAST.replace('"foam_damping"', '"foam"'), "name of an axis must be one of"),
        (FAST.replace("points = 4", "point = 4"), "axes[0].point must be one of the keys"),
        (FAST.replace("points = 4", "points = 1"), "axes[0].points must be an integer from 2 to"),
        (FAST.replace("to = 6e4", "to = 1e3"), "axes[0].to must be above from"),
        (FAST.replace("from = 5e3, ", ""), "axes[0].from must be given"),
        (FAST.replace('"minimum"', '"small"'), "head must be a table or one of minimum"),
        (FAST.replace('"minimum"', "3"), "head must be a table"),
        (FAST.replace("mass = 49.4", "mass = -1.0"), "manipulator.mass must be finite and positive"),
        (FAST.replace("closing_speed = 1.25", ""), "closing_speed must be an axis or among the fixed numbers"),
        (FAST.replace("closing_speed", "speed"), "impact.speed must be one of the keys"),
        ("outputs = ['hic99']\n" + FAST, "outputs must be one of"),
        ("show = ['status']\n" + FAST, "show[0] must be one of"),
        ("chunk_rows = 0\n" + FAST, "chunk_rows must be an integer of at least 1"),
        (FAST + "[design]\nkind = 'sobol'\n", "design.size must be given for a sobol"),
        (FAST + "[design]\nkind = 'random'\n", "design.kind must be one of grid"),
        (FAST + "[design]\nsize = 4\n", "design.size must not be given for a grid"),
        (FAST + "[design]\nkind = 'sobol'\nsize = 0\n", "design.size must be an integer from 1 to"),
        (FAST + "[run]\nstep = 0.01\n", "run must be given with scenarios only"),
        (FAST + "[foam]\ndamping = 50.0\n", "foam.stiffness must be given, got nothing; numbers of a foam"),
        (CROSSING + "[impact]\n", "impact must not be given with scenarios"),
        (CROSSING.replace('"c2"', '"c9"'), "scenarios[1] must be a scenario file or one of"),
        (CROSSING + "[run]\nstep = -1.0\n", "step must be finite and positive"),
        (CROSSING + "[law]\ntype = 'none'\n", "law.type must be"),
    ],
)
def test_bad_file_is_refused_naming_the_key(
    text: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = written(tmp_path / "a.toml", text)
    assert main(["sweep", file, "--out", str(tmp_path / "out")]) == 2
    line = error_line(capsys)
    assert f"{file}: {words}" in line
    assert not (tmp_path / "out").exists()


def test_bad_options_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, out = written(tmp_path / "a.toml", FAST), str(tmp_path / "out")
    for options, words in (
        (["--workers", "0"], "--workers must be at least 1"),
        (["--workers", "1", "--scheduler", "tcp://x"], "--workers must not be given with --scheduler"),
        (["--table", "a.xlsx"], "--table must end in .parquet or .npz or .csv"),
        (["--threads", "0"], "error: --threads must be an integer from 1 to 1024, got 0"),
    ):
        assert main(["sweep", file, "--out", out, *options]) == 2
        assert words in error_line(capsys)
    assert main(["sweep", str(tmp_path / "none.toml"), "--out", out]) == 2
    assert "path must name a readable file" in error_line(capsys)


def test_folder_of_another_sweep_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = str(tmp_path / "out")
    assert main(["sweep", written(tmp_path / "a.toml", FAST), "--out", out]) == 0
    capsys.readouterr()
    assert main(["sweep", written(tmp_path / "b.toml", FAST.replace("1.25", "1.5")), "--out", out]) == 2
    assert "holds another sweep: study.fixed.closing_speed is 1.25 there and 1.5 here" in error_line(capsys)


# ---- laws of scenario files -----------------------------------------------------------------------------

SCENE = """
start = [4.0, 0.0]
goal = [0.0, 0.0]
obstacles = [{ type = "disc", center = [2.0, 0.1], radius = 0.2, critical_radius = 0.5, active_radius = 0.9 }]
"""
VELOCITIES = '[law]\ntype = "velocity_obstacle"\n'
SHIELDED = SCENE + VELOCITIES + "[safe.shield]\n"
SEEDS = 'axes = [{ name = "seed", values = [1.0] }]\n'


def _study(folder: Path, scenes: list[str], text: str = "", axes: str = SEEDS) -> str:
    names = [Path(written(folder / f"scene_{index}.toml", scene)).name for index, scene in enumerate(scenes)]
    return written(folder / "study.toml", f"scenarios = {names}\n{axes}{text}")


def test_law_and_safe_of_a_scenario_file_are_swept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = _study(tmp_path, [SHIELDED, SHIELDED])
    study = load(file).study
    assert isinstance(study, sweep.NavigationStudy)
    assert study.law == scenarios.load(tmp_path / "scene_0.toml").law
    assert main(["sweep", file, "--out", str(tmp_path / "out")]) == 0
    assert re.search("^law +velocity obstacle", capsys.readouterr().out, re.MULTILINE)
    expected = nav.simulate(scenarios.load(tmp_path / "scene_0.toml").scenario, study.law).time[-1]
    assert sweep.open(tmp_path / "out")["end_time"].tolist() == [expected, expected]


@pytest.mark.parametrize(
    ("scenes", "text"),
    [
        ([SCENE, SCENE], ""),
        ([SCENE, SCENE + '[law]\ntype = "vff"\n'], ""),
        ([SCENE], '[law]\ntype = "masoud"\n[safe.shield]\n'),
        ([SCENE], "[safe.shield]\n"),
        ([SHIELDED], VELOCITIES + "[safe.shield]\n"),
    ],
)
def test_laws_that_agree_or_stand_in_one_place_are_taken(scenes: list[str], text: str, tmp_path: Path) -> None:
    law = load(_study(tmp_path, scenes, text)).study.law  # type: ignore[attr-defined]  # of robots
    assert isinstance(law, nav.SafeNavigation) == any("safe" in each for each in (*scenes, text))


@pytest.mark.parametrize(
    ("scenes", "text", "words"),
    [
        ([SHIELDED, SCENE], "", ("scene_0.toml", "scene_1.toml", "by default")),
        ([SHIELDED, SCENE + VELOCITIES], "", ("scene_0.toml", "scene_1.toml", "shield", "into the study")),
        ([SHIELDED], VELOCITIES, ("law must be", "scene_0.toml", "shield", "take [law] and [safe] out")),
        ([SCENE, SHIELDED], '[law]\ntype = "vff"\n', ("law must be", "scene_1.toml", "velocity obstacle")),
    ],
)
def test_no_law_of_a_file_is_left_out_in_silence(
    scenes: list[str], text: str, words: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for command in ("sweep", "optimize"):
        file = _study(tmp_path, scenes, text, SEEDS if command == "sweep" else "")
        assert main([command, file, "--out", str(tmp_path / "out")]) == 2
        line = error_line(capsys)
        if command == "sweep":
            assert all(each in line for each in words)
        assert not (tmp_path / "out").exists()


def test_gain_of_another_law_is_refused_naming_the_law(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = _study(tmp_path, [SHIELDED], axes='axes = [{ name = "detour_gain", values = [10.0] }]\n')
    assert main(["sweep", file, "--out", str(tmp_path / "out")]) == 2
    assert "be an axis of the law VelocityObstacle, whose axes are margin, horizon" in error_line(capsys)
