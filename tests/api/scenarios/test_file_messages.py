"""What a message about a file or a word says besides the rule: what was meant and how it is written."""

from __future__ import annotations

import re
import resource
import subprocess
import sys
from pathlib import Path

import pytest

from hrsafety import datasets, io, scenarios
from hrsafety import navigation as nav
from hrsafety.cli import font_cache, main
from hrsafety.errors import InvalidParameterError
from hrsafety.scenarios.laws import LAWS, SHORT_NAMES, law_named

SCENE = "start = [3.9, 0.6]\ngoal = [0.0, 0.6]\n"
DISC = '[[obstacles]]\ntype = "disc"\ncenter = [2.45, 0.595]\nradius = 0.1\n'


def refused(tmp_path: Path, text: str) -> str:
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InvalidParameterError) as error:
        scenarios.load(path)
    return str(error.value)


MESSAGES = {
    "number in quotes": (
        SCENE + DISC.replace("0.1", '"0.1"'),
        "radius must be a number, got '0.1'; write it without quotes: 0.1",
    ),
    "flag in quotes": (SCENE + '[law]\ntype = "vff"\npass_behind = "False"\n', "; write it without quotes: false"),
    "pair in quotes": (SCENE.replace("[3.9, 0.6]", '"3.9, 0.6"'), "; write it without quotes: [3.9, 0.6]"),
    "integer with a point": ("seed = 1.0\n" + SCENE, "seed must be an integer of 64 bits, got 1.0; write 1"),
    "one table of several": (SCENE + DISC.replace("[[obstacles]]", "[obstacles]"), "; write [[obstacles]] with two"),
    "key": (SCENE + DISC.replace("radius", "raduis"), 'raduis must be one of the keys .*did you mean "radius"'),
    "key of the top": (SCENE + DISC + "time_limit = 5.0\n", "time_limit belongs to the top of the file"),
    "symbol of a gain": (SCENE + '[law]\ntype = "vff"\nK_5 = 3.0\n', "did you mean detour_gain?"),
    "kind of obstacle": (SCENE + DISC.replace('"disc"', '"person"'), "got 'person'; did you mean \"human\"?"),
    "law": (SCENE + '[law]\ntype = "masuod"\n', "got 'masuod'; did you mean \"masoud\"?"),
    "short law": (SCENE + '[law]\ntype = "orac"\n', "got 'orac'; did you mean \"orca\"?"),
    "word of the core": (SCENE + '[law]\ntype = "vff"\nstabilizing = "of"\n', "got 'of'; did you mean \"off\"?"),
    "unlike word": (SCENE + '[measurement]\nscale = 0.1\ndistribution = "normal"\n', "got 'normal'$"),
    "decimal comma": (SCENE + "heading = 0,5\n", "heading = 0,5; decimals need a point"),
    "unit": (SCENE + "time_limit = 30 s\n", "time_limit = 30 s; numbers have no units"),
    "colon": ("start: [3.9, 0.6]\n", "; keys and values are joined by ="),
    "round brackets": (SCENE.replace("[3.9, 0.6]", "(3.9, 0.6)"), "; arrays stand in brackets"),
    "no quotes": (SCENE + DISC.replace('"disc"', "disc"), "; texts stand in quotes"),
    "motion": (SCENE + '[[obstacles]]\ntype = "human"\nstart = [0, 1]\n', "velocity must be given, .*or give segments"),
}


@pytest.mark.parametrize(("text", "message"), MESSAGES.values(), ids=MESSAGES.keys())
def test_a_scenario_file_is_told_what_was_meant(text: str, message: str, tmp_path: Path) -> None:
    pattern = message if ".*" in message or message.endswith("$") else re.escape(message)
    assert re.search(pattern, refused(tmp_path, text)), refused(tmp_path, text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("number;x_m;y_m\n", "line 1 must have a column for a time or a frame and an id, got the columns number, x_m"),
        ("frame,t_s,pedestriano,x_m,y_m\n", "have a column for an id, got .*; name them with columns="),
        ('t_s,ped_id,x_m,y_m\n"0,5",1,0,0\n', "column t_s must be a finite number, got '0,5'"),
        ("t_s,ped_id,x_m,y_m\n0,5,1,0,5,0,5\n", "have 4 cells, got 7; decimals need a point"),
        ("0,0.0,1,0,0,1,7\n", "be of a known format"),
        ("time,person,x,y\n0,1,0,0\n0.4,1,50,0\n", 'come with unit=, .*125 m/s as meters.*; give unit="cm" if'),
        ("t_s,ped_id,x_m,y_m\n1,1,0,0\n1,1,1,0\n", "have one position of a person at one instant"),
    ],
)
def test_a_table_is_told_its_delimiter_columns_and_numbers(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "people.csv"
    path.write_text(text)
    with pytest.raises(InvalidParameterError, match=message):
        io.load_people(path)


def test_a_missing_file_is_told_its_neighbor(tmp_path: Path) -> None:
    (tmp_path / "crossing.toml").write_text(SCENE)
    with pytest.raises(InvalidParameterError, match=r'did you mean "crossing\.toml"'):
        scenarios.load(tmp_path / "crosing.toml")
    with pytest.raises(InvalidParameterError, match="this is a folder"):
        scenarios.load(tmp_path)
    with pytest.raises(InvalidParameterError, match="there is no folder"):
        scenarios.load(tmp_path / "nowhere" / "scene.toml")


@pytest.mark.parametrize(("scale", "doubted"), [(1.0, False), (100.0, True), (1000.0, True)])
def test_a_recording_in_other_units_is_doubted(scale: float, doubted: bool) -> None:
    time = [0.4 * k for k in range(100) for _ in range(2)]
    walk = [[scale * 0.5 * k, scale * 2.0 * person] for k in range(100) for person in range(2)]
    recording = datasets.Recording(time_s=time, person=[0, 1] * 100, position=walk)
    assert bool(recording.warnings) == doubted
    if doubted:
        assert {100.0: "centimeters (unit cm)", 1000.0: "millimeters (unit mm)"}[scale] in recording.warnings[0].message
        with pytest.raises(InvalidParameterError, match=r"(centi|milli)meters"):
            scenarios.crossings(recording, runs=1)


def test_a_jump_of_one_person_is_doubted() -> None:
    position = [[0.5 * k + (20.0 if k > 5 else 0.0), 0.0] for k in range(10)]
    recording = datasets.Recording(time_s=[0.4 * k for k in range(10)], person=[7] * 10, position=position)
    assert recording.warnings[0].subject == "speed of person 7 after 2 s"


def test_times_in_milliseconds_end_in_an_error_and_not_in_memory() -> None:
    count = 2000
    recording = datasets.Recording(
        time_s=[400.0 * k for k in range(count)],
        person=[7] * count,
        position=[[-5.0 + 0.005 * k, 0.0] for k in range(count)],
    )
    with pytest.raises(InvalidParameterError, match="milliseconds"):
        scenarios.crossings(recording, runs=1)


@pytest.mark.parametrize("short", SHORT_NAMES)
def test_short_names_of_laws_are_taken_in_files(short: str, tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(f'{SCENE}[law]\ntype = "{short}"\n')
    assert type(scenarios.load(path).law) is LAWS[SHORT_NAMES[short]]


def test_names_of_laws_are_taken_as_they_are_written_in_running_text() -> None:
    for name in ("Field D*", "field-d-star", "FIELD_D_STAR", "d*"):
        assert law_named("law", name) is nav.FieldDStar
    assert not set(SHORT_NAMES) & set(LAWS)


def test_an_object_is_asked_for_with_the_right_article() -> None:
    with pytest.raises(InvalidParameterError, match="must be an Obstacle"):
        nav.Scenario(start=(1.0, 0.0), goal=(0.0, 0.0), obstacles=[1])  # type: ignore[list-item]  # what is tested


def error_of(words: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    assert main(words) == 2
    return capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["reproduce", "--only", "tables6"], "--only must be among .*got 'tables6'; did you mean \"tables-6\""),
        (["reproduce", "only", "tables-6"], "unrecognized arguments: only tables-6; did you mean --only"),
        (["simulat"], 'did you mean "simulate"'),
        (["simulate", "a.toml", "--stabilising", "off"], 'did you mean "--stabilizing"'),
        (["simulate", "a.toml", "--integrator", "RK4"], 'did you mean "rk4"'),
        (["simulate", "a.toml", "--gains", "1,2,3,4"], "write blanks between several numbers"),
        (["simulate", "a.toml", "--step", "0,01"], "decimals need a point"),
        (["simulate", "a.toml", "--step", "10ms"], "numbers have no units"),
        (["simulate", "a.toml", "--out", ""], "--out must name a file or folder, got ''"),
        (["foam", "a.toml", "--out", ""], "--out must name a file or folder"),
        (["optimize", "a.toml", "--out", ""], "--out must name a file or folder"),
        (["sweep", "a.toml", "--out", ""], "--out must name a file or folder"),
        (["reproduce", "--out", ""], "--out must name a file or folder"),
        (["sweep", "a.toml", "--table", "a.xlsx"], "--table must end in .parquet or .npz or .csv"),
        (["simulate", "--people", "a.csv", "--animate-run", "1"], "--animate-run must come with --animate FILE"),
    ],
)
def test_the_command_line_is_told_what_was_meant(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert re.search(message, error_of(words, capsys))


def test_what_cannot_be_animated_is_refused_before_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE)

    def run(*_: object, **__: object) -> None:
        raise AssertionError("the run began")

    monkeypatch.setattr(nav, "evaluate", run)
    monkeypatch.setattr("shutil.which", lambda _: None)
    assert "--animate must end in .gif or .mp4" in error_of(["simulate", str(scene), "--animate", "a.png"], capsys)
    assert "ffmpeg" in error_of(["simulate", str(scene), "--animate", "a.mp4"], capsys)


def _small_files() -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))


@pytest.mark.parametrize(("option", "name"), [("--out", "trajectory.csv"), ("--animate", "run.gif")])
def test_a_write_that_fails_names_its_file(option: str, name: str, tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE)
    target = tmp_path / "out" if option == "--out" else tmp_path / name
    done = subprocess.run(
        [sys.executable, "-m", "hrsafety", "simulate", str(scene), option, str(target)],
        preexec_fn=_small_files,
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert done.returncode == 2
    full = target / name if option == "--out" else target
    assert done.stderr.endswith(f"hrsafety: error: {full}: File too large\n")
    assert not list(tmp_path.rglob(f"*{name}*"))


def test_a_full_standard_output_is_named(tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE)
    with open("/dev/full", "w") as full:  # noqa: PTH123  # a device, not a path of ours
        done = subprocess.run(
            [sys.executable, "-m", "hrsafety", "simulate", str(scene)],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
            timeout=120,
        )
    assert done.returncode == 2
    assert done.stderr == "hrsafety: error: standard output: No space left on device\n"


def test_commands_keep_a_matplotlib_cache_of_their_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "modules", {name: each for name, each in sys.modules.items() if name != "matplotlib"})
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv(font_cache.VARIABLE, "chosen")
    font_cache.keep_apart()
    assert font_cache.os.environ[font_cache.VARIABLE] == "chosen"
    monkeypatch.delenv(font_cache.VARIABLE)
    font_cache.keep_apart()
    chosen = Path(font_cache.os.environ[font_cache.VARIABLE])
    assert chosen.parent == tmp_path / "hrsafety"
    assert chosen.name.startswith("matplotlib-")
    assert chosen.is_dir()
