"""``hrsafety people``: what a file of recorded people holds, and the same people for another program."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import pytest

from api.recorded_files import people_files, walk
from hrsafety import io
from hrsafety.cli import main

OPTIONS = {"fps": "--fps", "step_s": "--step-s", "unit": "--unit", "scale": "--scale"}


def words(call: dict[str, object]) -> list[str]:
    return [word for name, value in call.items() for word in (OPTIONS[name], str(value))]


def test_every_layout_is_shown_and_converted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recording = walk(rows=12)
    for form, (path, call) in people_files(tmp_path, recording).items():
        assert main(["people", "info", str(path), *words(call), "--json", str(tmp_path / "info.json")]) == 0
        told = capsys.readouterr().out
        assert f"format         {form.partition(',')[0]}\n" in told
        assert "people         4, 48 rows" in told
        values = json.loads((tmp_path / "info.json").read_text())
        assert values["rows"] == 48
        assert values["duration_s"] == pytest.approx(recording.duration, abs=1e-5)
        assert len(values["sha256"]) == 64
        out = tmp_path / "out.csv"
        assert main(["people", "convert", str(path), str(out), *words(call)]) == 0
        assert io.load_people(out).duration == pytest.approx(recording.duration, abs=1e-5)
        capsys.readouterr()


def test_what_a_file_does_not_say_is_asked_for_by_the_option(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "people.txt"
    path.write_text("0 4 0.0 0.6\n10 4 0.5 0.6\n10 9 4.5 1.7\n20 4 1.0 0.6\n20 9 4.0 1.7\n")
    refused = {
        "info people.txt": "must come with fps=",
        "info people.txt --fps 0": "--fps must be finite and positive",
        "info people.txt --fps 25 --step-s 0.4": "--step-s must be left out where fps is given",
        "info people.txt --fps 25 --unit inch": '--unit must be one of "m"',
        "info people.txt --fps 25 --columns a=": "--columns must be NAME=MEANING",
        "convert people.txt people.xyz --fps 25": "OUT must end with one of .csv",
        "convert people.txt people.csv --fps 25 --to petrak": 'did you mean "petrack"?',
        "convert people.txt nowhere/people.csv --fps 25": "OUT must lie in a folder that exists",
        "convert people.txt people.json --fps 25 --out-fps 25": "--out-fps must be left out for socnavdata",
    }
    for line, message in refused.items():
        given = [str(path) if word == "people.txt" else word for word in shlex.split(line)]
        if given[0] == "convert":
            given[2] = str(tmp_path / given[2])
        assert main(["people", *given]) == 2
        assert message in capsys.readouterr().err
    assert main(["people", "info", str(path), "--step-s", "0.4"]) == 0


def test_doubts_are_printed_once_and_strict_counts_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "people.csv"
    path.write_text("t_s,id,x_m,y_m\n" + "".join(f"{10 * k},1,{0.5 * k},0\n" for k in range(12)))
    assert main(["people", "info", str(path), "--strict"]) == 4
    told = capsys.readouterr().err
    assert told.count("look like frames") == 1
    assert "give the frames per second, --fps F" in told
    assert main(["people", "info", str(path), "--fps", "25", "--strict"]) == 0


def test_robots_cross_people_of_any_layout(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = "".join(f"{10 * k} {who} {-30.0 + 0.4 * k} {9 * who}\n" for k in range(150) for who in (1, 2))
    path = tmp_path / "people.txt"
    path.write_text(rows)
    assert main(["simulate", "--people", str(path), "--step-s", "0.4", "--runs", "1"]) == 0
    assert "2 people in 59.6 s" in capsys.readouterr().out
    assert main(["simulate", str(path), "--unit", "m"]) == 2
    assert "--unit goes with --people only" in capsys.readouterr().err
