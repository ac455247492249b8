"""Warnings of the command line: where they are printed, in which color, and what --strict makes of them."""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path

import pytest

from hrsafety.cli import exit_codes, main, output
from hrsafety.cli.parsers import parser
from hrsafety.plausibility import ResultWarning

DEGREES = ResultWarning("implausible", "heading", "heading is 90 rad")
GRAMS = ResultWarning("implausible", "mass", "mass is 5000 kg,\nmore than a robot")


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def printed_on_terminal(monkeypatch: pytest.MonkeyPatch, **environment: str) -> str:
    screen = Terminal()
    monkeypatch.delenv("NO_COLOR", raising=False)
    for name, value in ({"TERM": "xterm"} | environment).items():
        monkeypatch.setenv(name, value)
    with monkeypatch.context() as patch:
        patch.setattr(sys, "stderr", screen)
        output.report_warnings([DEGREES], strict=False)
    return screen.getvalue()


def test_every_different_warning_is_one_line_on_stderr(capsys: pytest.CaptureFixture[str]) -> None:
    output.report_warnings([DEGREES, GRAMS, DEGREES], strict=False)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.splitlines() == [
        "hrsafety: warning: heading is 90 rad",
        "hrsafety: warning: mass is 5000 kg, more than a robot",
    ]


def test_warnings_are_yellow_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    assert printed_on_terminal(monkeypatch) == "\x1b[33mhrsafety: warning: heading is 90 rad\x1b[0m\n"


@pytest.mark.parametrize(("name", "value"), [("NO_COLOR", "1"), ("TERM", "dumb")])
def test_color_can_be_refused(name: str, value: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert printed_on_terminal(monkeypatch, **{name: value}) == "hrsafety: warning: heading is 90 rad\n"


def test_strict_leaves_with_code_4_only_after_warnings(capsys: pytest.CaptureFixture[str]) -> None:
    output.report_warnings([], strict=True)
    with pytest.raises(SystemExit) as left:
        output.report_warnings([DEGREES], strict=True)
    assert left.value.code == exit_codes.WARNED == 4
    assert "exit code 4" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["simulate", "foam", "optimize", "sweep"])
def test_commands_that_warn_know_strict(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert parser().parse_args([command, "a.toml", "--strict"]).strict
    assert not parser().parse_args([command, "a.toml"]).strict
    assert main([command, "--help"]) == 0
    assert "--strict" in capsys.readouterr().out


def test_help_lists_every_exit_code(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    text = capsys.readouterr().out
    for code, meaning in exit_codes.MEANINGS.items():
        assert f"{code:>3}  {meaning}" in text


PEOPLE = "frame,t_s,ped_id,x_m,y_m\n" + "".join(
    # One of them changes places with somebody 40 m away.
    f"{10 * k},{0.4 * k:.1f},{person},{0.5 * k - 10.0 + (40.0 if person == 2 and k > 30 else 0.0)},{0.3 * person}\n"
    for k in range(60)
    for person in range(3)
)


@pytest.mark.parametrize(("options", "code"), [([], 0), (["--strict"], 4), (["--strict", "--fail-on", "any"], None)])
def test_a_recording_that_is_doubted_warns_and_fails_with_strict(
    options: list[str], code: int | None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    people, report = tmp_path / "people.csv", tmp_path / "report.json"
    people.write_text(PEOPLE)
    ended = main(["simulate", "--people", str(people), "--runs", "1", "--json", str(report), *options])
    captured = capsys.readouterr()
    assert "hrsafety: warning: speed of person 2 after 12 s is 101.25 m/s" in captured.err
    assert "speed of person 2" in json.loads(report.read_text())["warnings"][0]
    # A run that failed comes before one that is not checked, and that before a warning.
    assert ended == (code if code is not None else 3 if captured.out.splitlines()[-1].startswith("FAILED") else 5)


@pytest.mark.parametrize("command", ["optimize", "sweep"])
def test_warnings_of_scenarios_reach_searches_and_sweeps(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    study = tmp_path / "study.toml"
    small = "[search]\ngrid = [1, 1, 1, 1]\nrefinements = 0\nsurvivors = 1\nlocal_starts = 0\n"
    axis = '[[axes]]\nname = "detour_gain"\nvalues = [10.0, 20.0]\n'
    study.write_text('scenarios = ["c1"]\n' + (small if command == "optimize" else axis))
    monkeypatch.setattr(output, "warnings_of", lambda *_: (DEGREES,))
    out = tmp_path / "out"
    assert main([command, str(study), "--out", str(out), "--strict"]) == 4
    assert "hrsafety: warning: heading is 90 rad" in capsys.readouterr().err
    assert (out / "summary.html").is_file()
