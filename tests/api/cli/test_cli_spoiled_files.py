"""No command ever prints a traceback, whatever is in the file that it is given."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from api.spoiled_files import spoiled
from hrsafety import io, scenarios
from hrsafety.cli import main
from hrsafety.cli.foam import file as foam_file
from hrsafety.cli.optimize import file as optimize_file
from hrsafety.cli.sweep import file as sweep_file
from hrsafety.errors import HrsafetyError

ROOT = Path(__file__).resolve().parents[3]
EXAMPLES = ROOT / "examples"
SPOILED = 500
PEOPLE = "frame,t_s,ped_id,x_m,y_m\n" + "".join(
    f"{10 * k},{0.4 * k:.1f},{person},{-10.0 + 0.5 * k},{0.3 * person}\n" for k in range(40) for person in range(2)
)
TRACK = "t_s,x_m,y_m\n0.0,0.0,1.0\n0.4,0.5,1.0\n0.8,1.0,1.0\n"


def people(path: str) -> object:
    recording = io.load_people(path)
    return recording.warnings, scenarios.crossings(recording, runs=2)


READERS: dict[str, tuple[str, str, Callable[[str], object]]] = {
    "scenario": ("my_first_crossing.toml", "", scenarios.load),
    "foam design": ("foam_design.toml", "", foam_file.load),
    "gain study": ("gain_study.toml", "", optimize_file.load),
    "sweep of impacts": ("impact_sweep.toml", "", sweep_file.load),
    "sweep of gains": ("gain_sweep.toml", "", sweep_file.load),
    "people": ("people.csv", PEOPLE, people),
    "track": ("track.csv", TRACK, io.load_track),
}


@pytest.mark.parametrize("kind", READERS)
def test_a_spoiled_file_is_read_or_refused_in_one_sentence(kind: str, tmp_path: Path) -> None:
    name, text, read = READERS[kind]
    path = tmp_path / name
    messages = []
    for content in spoiled(text or (EXAMPLES / name).read_text(encoding="utf-8"), SPOILED, seed=len(kind)):
        path.write_bytes(content)
        try:
            read(str(path))
        except HrsafetyError as error:
            messages.append(str(error))
    assert len(messages) > SPOILED / 4
    assert all(10 < len(message) < 2000 for message in messages)


COMMANDS: dict[str, tuple[str, list[str]]] = {
    "scenario": (
        'start = [3.9, 0.6]\ngoal = [0.0, 0.6]\ntime_limit = 20.0\n[[obstacles]]\ntype = "disc"\n'
        'center = [2.45, 0.595]\nradius = 0.1\n[law]\ntype = "vo"\n',
        ["simulate", "FILE.toml"],
    ),
    "people": (PEOPLE, ["simulate", "--people", "FILE.csv", "--runs", "1"]),
}


@pytest.mark.parametrize("kind", COMMANDS)
def test_a_command_ends_with_a_code_and_one_line(kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text, words = COMMANDS[kind]
    argument = next(word for word in words if word.startswith("FILE"))
    path = tmp_path / argument
    for content in spoiled(text, SPOILED, seed=7):
        path.write_bytes(content)
        code = main([str(path) if word == argument else word for word in words])
        printed = capsys.readouterr()
        assert code in (0, 2)
        assert (code == 2) == printed.err.startswith("hrsafety: error: ")
        assert "Traceback" not in printed.err
        assert code == 0 or printed.err.count("\n") == 1
