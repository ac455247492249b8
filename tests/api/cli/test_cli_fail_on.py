"""Exit code 3: which ends of a run --fail-on names, and what the last line says in any case."""

from __future__ import annotations

from pathlib import Path

import pytest

from hrsafety.cli import main, verdict
from hrsafety.cli.parsers import parser
from hrsafety.errors import InvalidParameterError

ARRIVES = "start = [3.9, 0.6]\ngoal = [0.0, 0.6]\n"
TIMES_OUT = ARRIVES + "time_limit = 2.0\n"
# A person who walks through a robot that can hardly move away.
COLLIDES = """start = [0.0, 0.0]
goal = [4.0, 0.0]
[[obstacles]]
type = "human"
start = [3.0, 0.0]
velocity = [-1.0, 0.0]
stop = [-3.0, 0.0]
max_speed = 1.0
active_radius = 0.8
critical_radius = 0.7
[law]
type = "virtual_force_field"
stabilizing = "off"
repulsive_gain = 0.001
detour_gain = 0.001
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    return tmp_path / "scene.toml"


def ended(scene: Path, text: str, *options: str) -> int:
    scene.write_text(text)
    return main(["simulate", str(scene), *options])


def last_line(capsys: pytest.CaptureFixture[str]) -> str:
    return capsys.readouterr().out.splitlines()[-1]


@pytest.mark.parametrize("text", [ARRIVES, TIMES_OUT, COLLIDES], ids=["arrives", "times out", "collides"])
def test_without_the_option_every_run_exits_with_0(text: str, scene: Path) -> None:
    assert ended(scene, text) == 0


@pytest.mark.parametrize("words", ["timed_out", "timed-out", "timeout", "contact,timed_out", "not_arrived", "any"])
def test_a_time_out_that_is_named_is_code_3(words: str, scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert ended(scene, TIMES_OUT, "--fail-on", words) == 3
    assert last_line(capsys).startswith("FAILED  timed out after 2.00 s, ")


@pytest.mark.parametrize("words", ["contact", "collided", "any", "stopped,contact"])
def test_a_contact_that_is_named_is_code_3(words: str, scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert ended(scene, COLLIDES, "--fail-on", words) == 3
    line = last_line(capsys)
    assert line.startswith("FAILED  contact with obstacle 0 (Human) at ")
    assert line.endswith("exit code 3")


def test_other_ends_than_the_named_ones_do_not_fail(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert ended(scene, TIMES_OUT, "--fail-on", "contact,stopped") == 0
    assert "exit code 0 all the same" in last_line(capsys)
    assert ended(scene, ARRIVES, "--fail-on", "any") == 0
    assert last_line(capsys).startswith("passed  arrived after ")


def test_the_last_line_says_what_went_wrong_and_how_to_make_it_count(
    scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ended(scene, TIMES_OUT)
    line = last_line(capsys)
    assert line.startswith("NOTE    timed out after 2.00 s, ")
    assert line.endswith("exit code 0 all the same, --fail-on timed_out makes it 3")
    ended(scene, COLLIDES)
    assert "contact with obstacle 0 (Human)" in last_line(capsys)


def test_everything_is_written_before_the_command_fails(scene: Path) -> None:
    out = scene.parent / "out"
    assert ended(scene, TIMES_OUT, "--fail-on", "any", "--out", str(out)) == 3
    assert (out / "trajectory.csv").is_file()
    assert (out / "energy.png").is_file()


def test_runs_across_people_fail_alike(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # One person who walks onto the standing robot's place again and again.
    rows = [f"{k},{0.4 * k:.1f},{p},{-10.0 + 0.5 * ((k + 7 * p) % 40)},{0.1 * p}" for k in range(120) for p in range(3)]
    people = tmp_path / "people.csv"
    people.write_text("frame,t_s,ped_id,x_m,y_m\n" + "\n".join(rows) + "\n")
    options = ["simulate", "--people", str(people), "--runs", "3"]
    assert main(options) == 0
    without = last_line(capsys)
    assert " of 3 runs arrived without a contact" in without
    touched = int(without.split("contact, ")[1].split(" had one")[0])
    assert main([*options, "--fail-on", "contact"]) == (3 if touched else 0)
    # They jump back to where they came from: an end without a contact is not checked then.
    assert main([*options, "--fail-on", "any"]) == (5 if without.startswith("NOT CHECKED") else 3)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("contcat", 'did you mean "contact"?'),
        ("timedout", 'did you mean "timed_out"?'),
        ("contact,,any", "--fail-on must be among contact, moving_contact"),
        ("", "--fail-on must be among contact"),
        ("arrived", "got 'arrived'; did you mean \"not_arrived\"?"),
    ],
)
def test_an_unknown_word_is_an_error_with_the_near_one(text: str, message: str) -> None:
    with pytest.raises(InvalidParameterError) as error:
        verdict.failures_of(text)
    assert message in str(error.value)


def test_the_help_explains_every_word(capsys: pytest.CaptureFixture[str]) -> None:
    assert parser().parse_args(["simulate", "a.toml"]).fail_on is None
    assert main(["simulate", "--help"]) == 0
    text = capsys.readouterr().out
    assert all(word in text for word in verdict.FAILURES)
    assert "code 3" in text
