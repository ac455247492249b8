"""Warnings of the command line: where they are printed, in which color, and what --strict makes of them."""

from __future__ import annotations

import io
import sys

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
