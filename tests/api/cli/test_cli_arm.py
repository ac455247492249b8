"""``hrsafety arm``: the table, the files, the words."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import pytest

pytest.importorskip("matplotlib")

from api.arms.arm_models import EXAMPLE  # needs the check above
from hrsafety import arms
from hrsafety.cli import examples, main, parsers

ARM = arms.Arm.example()


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(tmp_path)
    Path("robot.urdf").write_text(EXAMPLE, encoding="utf-8")
    return "robot.urdf"


def rows() -> list[dict[str, str]]:
    with Path("arm/masses.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_one_pose_has_the_masses_of_the_arm(robot: str, capsys: pytest.CaptureFixture[str]) -> None:
    asked = [
        "arm",
        robot,
        "--link",
        "tool",
        "--point",
        "0",
        "0",
        "0.05",
        "--joint",
        "elbow=1.4",
        "--joint",
        "shoulder=0.4",
    ]
    assert main([*asked, "--direction", "1", "1", "0"]) == 0
    shown = capsys.readouterr()
    assert "ISO mass       14.5 kg" in shown.out
    assert "warning: no motor inertia given" in shown.err
    (row,) = rows()
    place = {"link": "tool", "point": (0, 0, 0.05)}
    pose = {"elbow": 1.4, "shoulder": 0.4}
    for name, direction in {"x": (1, 0, 0), "u": (1, 1, 0)}.items():
        assert float(row[f"effective_mass_{name}_kg"]) == ARM.effective_mass(pose, direction=direction, **place).mass
    assert float(row["worst_mass_kg"]) == float(ARM.extremes(pose, **place).worst_mass)
    assert float(row["iso_mass_kg"]) == 14.5
    assert Path("arm/mass_ellipse.png").read_bytes().startswith(b"\x89PNG")
    assert "mass_ellipse" in Path("arm/summary.html").read_text(encoding="utf-8")


def test_poses_come_from_a_table(robot: str) -> None:
    Path("poses.csv").write_text("elbow,turn\n1.4,0.0\n0.9,0.5\n")
    assert main(["arm", robot, "--poses", "poses.csv", "--payload", "2", "--link", "tool"]) == 0
    found = rows()
    assert [row["elbow_rad"] for row in found] == ["1.4", "0.9"]
    assert found[0]["iso_mass_kg"] == "16.5"


def test_drawn_poses_repeat_and_motors_silence_the_warning(robot: str, capsys: pytest.CaptureFixture[str]) -> None:
    motors = [word for name in ARM.joint_names for word in ("--armature", f"{name}=0.3")]
    assert main(["arm", robot, "--samples", "3", "--seed", "4", "--strict", *motors]) == 0
    first = rows()
    assert len(first) == 4
    assert main(["arm", robot, "--samples", "3", "--seed", "4", "--strict", *motors]) == 0
    assert rows() == first
    assert capsys.readouterr().err == ""


def test_unbounded_is_a_word_and_inf(robot: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["arm", robot, "--joint", "elbow=0"]) == 0
    assert "unbounded" in capsys.readouterr().out
    assert rows()[0]["worst_mass_kg"] == "inf"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--joint", "elbwo=1"], '--joint must name joints that take a value: turn, .*did you mean "elbow"'),
        (["--joint", "elbow"], "--joint must be NAME=NUMBER, got 'elbow'"),
        (["--joint", "elbow=9"], r'joints\["elbow"\] must be from -2.8 to 2.8, got 9.0'),
        (["--link", "tol"], '--link must be one of .*did you mean "tool"'),
        (["--lock", "elbwo"], "--lock must name joints of the arm"),
        (["--payload", "2"], "--payload must come with --payload-link, or --link"),
        (["--payload", "-2", "--link", "tool"], "mass must be finite and not negative, got -2.0"),
        (["--direction", "0", "0", "0"], r"direction\[3\] must not be zero"),
        (["--poses", "none.csv"], "--poses must name a readable file"),
        (["--poses", "bad.csv"], "bad.csv: line 2: elbow must be a number, got 'nan'"),
        (["--strict", "--joint", "elbow=1"], "warnings with --strict: exit code 4"),
    ],
)
def test_what_is_wrong_is_named(robot: str, capsys: pytest.CaptureFixture[str], words: list[str], message: str) -> None:
    Path("bad.csv").write_text("elbow\nnan\n")
    assert main(["arm", robot, *words]) in {2, 4}
    assert re.search(message, capsys.readouterr().err)


def test_a_bad_urdf_is_named_with_its_element(robot: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path(robot).write_text(EXAMPLE.replace('<mass value="12"/>', '<mass value="-12"/>'))
    assert main(["arm", robot]) == 2
    assert 'robot.urdf: link "upper_arm".mass must be finite and not negative, got -12.0' in capsys.readouterr().err


def test_the_examples_of_the_help_are_understood() -> None:
    lines = [line.split() for line in examples.ARM.splitlines()]
    commands = [words[1:] for words in lines if words[:1] == ["hrsafety"]]
    assert len(commands) == 2
    for words in commands:
        assert parsers.parser().parse_args(words).command == "arm"
