"""``hrsafety init``, ``validate`` and ``info``."""

from __future__ import annotations

import importlib.metadata
from importlib import resources
from pathlib import Path

import pytest

import hrsafety
from hrsafety import sweep
from hrsafety.cli import exit_codes, main
from hrsafety.cli.file_kinds import KINDS
from hrsafety.cli.parsers import STARTERS

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
URDF = """<robot name="arm"><link name="base"/><link name="upper"><inertial><mass value="3"/>
<origin xyz="0.2 0 0"/><inertia ixx="0.01" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="10" velocity="1"/></joint></robot>
"""


@pytest.fixture(autouse=True)
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("kind", STARTERS)
def test_a_file_to_start_from_is_valid_and_names_itself(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["init", kind, "mine.toml"]) == 0
    found = KINDS["sweep" if kind == "run_sweep" else kind]
    written = capsys.readouterr().out.splitlines()
    assert written == ["wrote mine.toml", f"next  hrsafety {found.command} mine.toml --out mine"]
    text = Path("mine.toml").read_text(encoding="utf-8")
    assert kind == "contact" or f"hrsafety {found.command} mine.toml" in text
    assert "examples/" not in text.splitlines()[2]
    # The foams of the sweep of impacts are varied beyond what is closed, and its text says that there is a warning.
    doubted = "a warning says so" in text
    assert doubted == (kind == "sweep")
    assert main(["validate", "mine.toml", "--strict"]) == (exit_codes.WARNED if doubted else 0)
    answer = capsys.readouterr()
    assert answer.out.startswith(f"mine.toml: {found.title} file, {'1 warning' if doubted else 'valid'}")
    assert ("compress the foam by more than its thickness" in answer.err) == doubted


def test_the_sweep_of_runs_to_start_from_runs_without_a_doubt(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["init", "run_sweep"]) == 0
    assert capsys.readouterr().out.splitlines()[0] == "wrote run_sweep.toml"
    assert main(["sweep", "run_sweep.toml", "--out", "out", "--strict"]) == 0
    assert capsys.readouterr().err == ""
    result = sweep.open("out")
    assert len(result) == 2 * 100 * 4 * 2
    table = result.shares("outcome", by=["measurement_scale", "detour_gain", "scenario"])
    assert table.warnings == ()
    assert set(table.rows.tolist()) == {100}
    # The gain that is asked for matters: the groups differ by more than their intervals.
    collided = table.word == "collided"
    assert table.high[collided].min() < table.low[collided].max()


def test_files_to_start_from_are_the_examples() -> None:
    folder = resources.files("hrsafety.cli") / "data"
    shared = [name for name in STARTERS.values() if (EXAMPLES / name).exists()]
    assert len(shared) == len(STARTERS) - 1
    for name in shared:
        assert (folder / name).read_bytes() == (EXAMPLES / name).read_bytes(), name


def test_nothing_is_overwritten(capsys: pytest.CaptureFixture[str]) -> None:
    Path("my_first_crossing.toml").write_text("mine", encoding="utf-8")
    assert main(["init", "scenario"]) == exit_codes.ERROR
    assert "FILE must not exist" in capsys.readouterr().err
    assert Path("my_first_crossing.toml").read_text(encoding="utf-8") == "mine"


def test_every_example_is_valid(capsys: pytest.CaptureFixture[str]) -> None:
    files = sorted(str(path) for path in EXAMPLES.glob("*.toml"))
    assert main(["validate", *files]) == 0
    assert capsys.readouterr().out.count("\n") == len(files) >= 5


def test_every_file_is_checked_whatever_became_of_others(capsys: pytest.CaptureFixture[str]) -> None:
    Path("good.toml").write_text("start = [0.0, 0.0]\ngoal = [4.0, 0.0]\n", encoding="utf-8")
    Path("bad.toml").write_text("start = [0.0, 0.0]\ngoal = [4.0]\n", encoding="utf-8")
    Path("odd.toml").write_text("strat = [0.0, 0.0]\n", encoding="utf-8")
    assert main(["validate", "bad.toml", "odd.toml", "none.toml", "good.toml"]) == exit_codes.ERROR
    captured = capsys.readouterr()
    bad, odd, none = captured.err.splitlines()
    assert bad.startswith("hrsafety: error: bad.toml: goal must ")
    assert odd.startswith("hrsafety: error: odd.toml must have one of the keys")
    assert odd.endswith('did you mean "start"?')
    assert "none.toml" in none
    assert captured.out == "good.toml: scenario file, valid\n"


def test_warnings_count_with_strict(capsys: pytest.CaptureFixture[str]) -> None:
    Path("odd.toml").write_text("start = [0.0, 0.0]\ngoal = [4.0, 0.0]\nheading = 90.0\n", encoding="utf-8")
    assert main(["validate", "odd.toml"]) == 0
    captured = capsys.readouterr()
    assert captured.out == "odd.toml: scenario file, 1 warning\n"
    assert "heading" in captured.err
    assert main(["validate", "odd.toml", "--strict"]) == exit_codes.WARNED


def test_a_shield_that_assumes_less_counts(capsys: pytest.CaptureFixture[str]) -> None:
    person = '[[obstacles]]\ntype = "human"\nstart = [4.0, 3.0]\nvelocity = [-1.0, 0.0]\n'
    text = f"start = [0.0, 0.0]\ngoal = [4.0, 0.0]\n{person}[safe.shield]\nperson_speed = 0.5\n"
    Path("slow.toml").write_text(text, encoding="utf-8")
    assert main(["validate", "slow.toml", "--strict"]) == exit_codes.WARNED
    assert "give at least person_speed=1" in capsys.readouterr().err


def test_an_arm_is_checked_too(capsys: pytest.CaptureFixture[str]) -> None:
    Path("arm.urdf").write_text(URDF, encoding="utf-8")
    assert main(["validate", "arm.urdf"]) == 0
    assert capsys.readouterr().out.startswith("arm.urdf: arm file, ")
    Path("arm.urdf").write_text(URDF.replace('value="3"', 'value="-3"'), encoding="utf-8")
    assert main(["validate", "arm.urdf"]) == exit_codes.ERROR
    assert "-3" in capsys.readouterr().err


def test_info_names_versions_and_every_extra(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info"]) == 0
    shown = capsys.readouterr().out
    assert f"hrsafety       {hrsafety.__version__} in " in shown
    assert f"numpy {importlib.metadata.version('numpy')}" in shown
    offered = importlib.metadata.metadata("hrsafety").get_all("Provides-Extra") or []
    for extra in set(offered) - {"test", "dev", "docs", "all"}:
        assert f"\n{extra} " in shown, extra
    assert "test" not in {line.split(" ")[0] for line in shown.splitlines()}


@pytest.mark.parametrize(("command", "file"), [("simulate", "my_first_crossing.toml"), ("optimize", "gain_study.toml")])
def test_init_takes_the_command_for_its_file(
    command: str, file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["init", command]) == 0
    assert (tmp_path / file).exists()
