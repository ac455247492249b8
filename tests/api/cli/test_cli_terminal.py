"""Tables, colors, progress and completion of the command line, with and without rich and shtab."""

from __future__ import annotations

import importlib.util
import io
import re
import subprocess
import sys
from pathlib import Path

import pytest

from api.cli_answers import written
from hrsafety.cli import exit_codes, main, parsers, progress, terminal
from hrsafety.cli.completion import SHELLS

pytest.importorskip("rich")

ESCAPE = re.compile(r"\x1b\[[0-9;]*m")
HEADERS = (("foam", "stiffness"), ("", "kN/m"))
ROWS = [("Foam [1]", "24.30"), ("Foam 2", "13.80")]
PLAIN = "foam      stiffness\n               kN/m\n--------  ---------\nFoam [1]      24.30\nFoam 2        13.80"
FOAMS = Path(__file__).resolve().parents[3] / "examples" / "foam_design.toml"


class Terminal(io.StringIO):
    """A text stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def on_screen(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    """Put a terminal behind standard output and errors; in the test itself, or pytest takes it away again."""
    shown = Terminal()
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "120")
    monkeypatch.setattr(sys, "stdout", shown)
    monkeypatch.setattr(sys, "stderr", shown)
    return shown


def without(monkeypatch: pytest.MonkeyPatch, package: str) -> None:
    found = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name, *more: None if name == package else found(name, *more)
    )


def words(text: str) -> list[str]:
    """Return the words of a table, sorted, without what only draws it."""
    return sorted(word for word in re.split(r"[\s\u2500-\u257f-]+", ESCAPE.sub("", text)) if word)


def test_a_pipe_gets_plain_text(capsys: pytest.CaptureFixture[str]) -> None:
    assert not terminal.can_draw(sys.stdout)
    assert terminal.table(HEADERS, ROWS, left=(0,)) == PLAIN
    assert capsys.readouterr().out == ""


def test_a_terminal_without_rich_gets_plain_text(monkeypatch: pytest.MonkeyPatch) -> None:
    on_screen(monkeypatch)
    without(monkeypatch, "rich")
    assert terminal.table(HEADERS, ROWS, left=(0,)) == PLAIN
    assert terminal.styled("word", "red", sys.stdout) == "word"


def test_rich_draws_the_same_words_in_color(monkeypatch: pytest.MonkeyPatch) -> None:
    on_screen(monkeypatch)
    drawn = terminal.table(HEADERS, ROWS, left=(0,))
    assert ESCAPE.search(drawn)
    assert words(drawn) == words(PLAIN)
    assert terminal.styled("word", "red", sys.stdout) == "\x1b[31mword\x1b[0m"


def test_no_color_leaves_the_table_and_takes_every_escape(monkeypatch: pytest.MonkeyPatch) -> None:
    on_screen(monkeypatch)
    monkeypatch.setenv("NO_COLOR", "1")
    drawn = terminal.table(HEADERS, ROWS, left=(0,))
    assert "\x1b" not in drawn
    assert "\u2500" in drawn
    assert words(drawn) == words(PLAIN)
    assert terminal.styled("word", "red", sys.stdout) == "word"


def test_a_dumb_terminal_gets_plain_text(monkeypatch: pytest.MonkeyPatch) -> None:
    on_screen(monkeypatch)
    monkeypatch.setenv("TERM", "dumb")
    assert terminal.table(HEADERS, ROWS, left=(0,)) == PLAIN


def test_a_narrow_terminal_loses_no_cell(monkeypatch: pytest.MonkeyPatch) -> None:
    on_screen(monkeypatch)
    monkeypatch.setenv("COLUMNS", "14")
    assert words(terminal.table(HEADERS, ROWS, left=(0,))) == words(PLAIN)


def test_a_command_says_the_same_on_a_terminal_and_in_a_pipe(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    screen = on_screen(monkeypatch)
    text = FOAMS.read_text(encoding="utf-8")
    assert "points = 139" in text
    path = written(tmp_path / "coarse.toml", text.replace("points = 139", "points = 9"))
    assert main(["foam", path, "--out", str(tmp_path / "a")]) == 0
    piped = io.StringIO()
    monkeypatch.setattr(sys, "stdout", piped)
    assert main(["foam", path, "--out", str(tmp_path / "a")]) == 0
    assert words(screen.getvalue()) == words(piped.getvalue())
    assert "\x1b" in screen.getvalue()
    assert "\x1b" not in piped.getvalue()


def test_errors_are_red_on_a_terminal_and_plain_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = on_screen(monkeypatch)
    assert main(["foam", "no_such_file.toml"]) == 2
    assert screen.getvalue().startswith("\x1b[31mhrsafety: error: path must name a readable file")
    command = [sys.executable, "-m", "hrsafety", "foam", "no_such_file.toml"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("hrsafety: error: path must name a readable file")


def test_bars_end_where_the_work_is_interrupted(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = on_screen(monkeypatch)

    def interrupted() -> None:
        with progress.live() as report:
            assert report is not None
            report("grid 1", 10, 20, None)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert "50%" in screen.getvalue()


# ---- completion -------------------------------------------------------------------------------------


def completion(shell: str, capsys: pytest.CaptureFixture[str]) -> str:
    pytest.importorskip("shtab")
    assert main(["--print-completion", shell]) == 0
    return capsys.readouterr().out


@pytest.mark.parametrize("shell", SHELLS)
def test_completion_names_commands_options_and_laws(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    text = completion(shell, capsys)
    for word in ("reproduce", "simulate", "foam", "optimize", "sweep", "fail-on", "velocity-obstacle", "tables-6"):
        assert word in text
    assert all(law in text for law in parsers.LAW_NAMES)


def test_bash_takes_the_completion_and_offers_commands(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    file = tmp_path / "completion.bash"
    file.write_text(completion("bash", capsys), encoding="utf-8")
    ask = f"source {file}; COMP_WORDS=(hrsafety f); COMP_CWORD=1; _shtab_hrsafety; echo ${{COMPREPLY[@]}}"
    done = subprocess.run(["bash", "-c", ask], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["foam"]


def test_unknown_shell_is_refused_with_the_choice(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--print-completion", "zhs"]) == 2
    assert "did you mean" in capsys.readouterr().err


def test_missing_shtab_names_its_extra(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setitem(sys.modules, "shtab", None)
    assert main(["--print-completion", "bash"]) == 2
    assert "pip install shtab" in capsys.readouterr().err


def test_the_rest_works_without_shtab_and_rich(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("shtab", "rich"):
        monkeypatch.setitem(sys.modules, name, None)
    assert main(["simulate", str(FOAMS.with_name("my_first_crossing.toml"))]) == 0
    assert "passed" in capsys.readouterr().out


def test_a_report_of_contacts_shows_how_far_its_map_is(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    screen = on_screen(monkeypatch)
    assert main(["contact", str(FOAMS.parent / "contact_arm.toml"), "--out", str(tmp_path)]) == exit_codes.NOT_CHECKED
    assert "map of allowed speeds" in screen.getvalue()
