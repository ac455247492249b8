"""The command ``hrsafety judge``: its words, page, JSON and exit codes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from api.robot_logs import Scene, write_log, write_people
from hrsafety.cli import main
from hrsafety.cli.exit_codes import ERROR, FAILED_RUN, NOT_CHECKED
from hrsafety.cli.judge import FAILURES
from hrsafety.navigation.metrics import METRICS


@pytest.fixture
def passing(tmp_path: Path) -> list[str]:
    """Return a log of a robot that passes somebody too near, and the people."""
    time = np.arange(121) / 10
    log, people = tmp_path / "robot.csv", tmp_path / "people.csv"
    log.write_text("\n".join(["t_s,x_m,y_m,yaw_rad", *(f"{t},{t},0,0" for t in time)]))
    people.write_text("\n".join(["t_s,ped_id,x_m,y_m", *(f"{t},ann,8,0.8" for t in time)]))
    return [str(log), "--people", str(people), "--radius", "0.3"]


def test_page_json_and_words(passing: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "judged"
    assert main(["judge", *passing, "--out", str(out), "--json", str(tmp_path / "found.json")]) == 0
    told = capsys.readouterr()
    assert told.out.splitlines()[-1].startswith("NOTE    no contact, 1 passing: 1 rule kept, 2 violated, 0 open")
    assert "warning" not in told.err
    page = (out / "summary.html").read_text()
    assert all(word in page for word in ("Rules of permission", "ann", "What is not judged", "violated", *METRICS))
    assert {each.name for each in out.iterdir()} == {
        "summary.html",
        "player.html",
        "judged.csv",
        "way.png",
        "moments.png",
    }
    found = json.loads((tmp_path / "found.json").read_text())
    assert found["counts"] == {"violated_rule": 2, "any": 2} | {
        word: 0 for word in FAILURES if word not in ("violated_rule", "any")
    }
    assert found["passings"][0]["person"] == "ann"
    assert set(found["metrics"]) == set(METRICS)


def test_exit_codes(passing: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["judge", *passing, "--fail-on", "contact"]) == 0
    assert main(["judge", *passing, "--fail-on", "contact,violated-rule"]) == FAILED_RUN
    assert "FAILED" in capsys.readouterr().out
    alone = [passing[0], "--radius", "0.3"]
    assert main(["judge", *alone]) == 0
    assert "NOT CHECKED" in capsys.readouterr().out
    assert main(["judge", *alone, "--fail-on", "any"]) == NOT_CHECKED
    for wrong, said in {
        ("--fail-on", "crash"): "--fail-on must be among",
        ("--offset", "people"): "--offset must be TOPIC=SECONDS",
        ("--radius", "-1"): "--radius",
        ("--frame", ""): "--frame must be a name",
    }.items():
        assert main(["judge", *passing, *wrong]) == ERROR
        assert said in capsys.readouterr().err
    assert main(["judge", passing[0]]) == ERROR
    assert "--radius must be known" in capsys.readouterr().err


def test_robot_and_shield_of_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = Scene()
    robot = tmp_path / "robot.toml"
    robot.write_text(
        "start = [0.0, 0.0]\ngoal = [5.0, 0.0]\n[robot]\nradius = 0.31\nmax_deceleration = 2.0\n"
        "[safe.shield]\nlatency = 0.2\n"
    )
    log = write_log(tmp_path, scene, "mcap")
    assert main(["judge", str(log), "--robot", str(robot), "--fail-on", "broken_assumption"]) == 0
    told = capsys.readouterr().out
    assert "radius 0.31 m" in told
    assert "latency" in told
    assert "no assumption can be broken" not in told
    people = write_people(tmp_path, scene, origin=0.0)
    table = write_log(tmp_path, scene, "table")
    assert main(["judge", str(table), "--people", str(people), "--radius", "0.3", "--goal", "9", "1"]) == 0


def test_map_and_settings_of_nav2(passing: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    settings, place = tmp_path / "nav2.yaml", tmp_path / "map.yaml"
    settings.write_text(
        "local_costmap: {local_costmap: {ros__parameters: {robot_radius: 0.4, footprint_padding: 0.0}}}\n"
    )
    cells = np.full((40, 160), 205, dtype=np.uint8)
    cells[10:30, :100] = 254
    cells[20, 60] = 0
    (tmp_path / "map.pgm").write_bytes(b"P5\n160 40\n255\n" + cells.tobytes())
    place.write_text(
        "image: map.pgm\nresolution: 0.1\norigin: [0.0, -2.0, 0.0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    call = ["judge", *passing[:3], "--params", str(settings), "--map", str(place)]
    assert main([*call, "--json", str(tmp_path / "found.json"), "--fail-on", "wall_contact"]) == FAILED_RUN
    found = json.loads((tmp_path / "found.json").read_text())
    assert found["robot_radius_m"] == pytest.approx(0.4, abs=0.01)
    assert [each["kind"] for each in found["contacts"]] == ["wall"]
    (outside,) = (each for each in found["not_judged"] if each["reason"] == "outside_map")
    assert outside["begin"] == pytest.approx(10.0, abs=0.11)
    assert "wall" in capsys.readouterr().out


LIMITS = "\nvelocity_smoother: {ros__parameters: {max_velocity: [0.5, 0.0, 2.0], max_accel: [2.5, 0.0, 3.2]}}\n"


@pytest.mark.parametrize("limits", ["", LIMITS], ids=["no limits", "limits"])
@pytest.mark.parametrize(
    "corners",
    ["[[.2, .2], [.2, .2], [.2, .2]]", "[[.1, .1], [.3, .1], [.3, .3], [.1, .3]]"],
    ids=["repeated", "origin"],
)
def test_a_footprint_of_settings_that_is_no_body_is_refused(
    passing: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str], corners: str, limits: str
) -> None:
    settings = tmp_path / "nav2.yaml"
    settings.write_text(
        f'local_costmap: {{local_costmap: {{ros__parameters: {{footprint: "{corners}"}}}}}}' + (limits or "\n")
    )
    call = ["judge", *passing[:3], "--params", str(settings)]
    assert main(call) == ERROR
    told = capsys.readouterr().err
    assert f"{settings}: footprint must" in told
    assert main([*call, "--radius", "0.4"]) == 0  # the footprint is not used


def test_only_limits_may_be_missing_in_settings(
    passing: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    settings = tmp_path / "nav2.yaml"
    shape = (
        'local_costmap: {local_costmap: {ros__parameters: {footprint: "[[.3, .2], [.3, -.2], [-.3, -.2], [-.3, .2]]"}}}'
    )
    call = ["judge", *passing[:3], "--params", str(settings)]
    for limits, said in (("\n", "radius 0.374"), (LIMITS, "footprint of 4 corners")):
        settings.write_text(shape + limits)
        assert main(call) == 0
        assert said in capsys.readouterr().out
    settings.write_text(shape + LIMITS.replace("2.5", "0.0"))
    assert main(call) == ERROR
    assert "max_acceleration" in capsys.readouterr().err


def test_columns_and_units_of_people_are_told_by_options(
    passing: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    people = tmp_path / "people.csv"
    rows = people.read_text().splitlines()[1:]
    call = ["judge", *passing]
    for header, given in (
        ("moment,who,east_of,north_of", ["--columns", "moment=t_s,who=id,east_of=x,north_of=y", "--unit", "m"]),
        ("t_s,ped_id,pos_x [m],pos_y [m]", []),
        ("t_s,ped_id,pos_x_(m),pos_y_(m)", []),
    ):
        people.write_text("\n".join([header, *rows]))
        assert main([*call, *given]) == 0
        assert "1 passing" in capsys.readouterr().out
    people.write_text("\n".join(["t_s,number,x_m,y_m", *rows]))
    assert main(call) == ERROR
    told = capsys.readouterr().err
    assert "name them with --columns, as in --columns 'number=id'" in told
    assert "columns=" not in told
    assert main([*call, "--columns", "number=id"]) == 0
    capsys.readouterr()
    assert main([*call, "--columns", "number"]) == ERROR
    assert "--columns must" in capsys.readouterr().err
    assert main(["judge", passing[0], "--radius", "0.3", "--columns", "number=id"]) == ERROR
    assert "--people must be a file of recorded people" in capsys.readouterr().err


def test_an_offset_is_named_as_the_option(
    passing: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    people = tmp_path / "people.csv"
    header, *rows = people.read_text().splitlines()
    people.write_text(
        "\n".join([header, *(f"{1000.0 + float(t)},{rest}" for t, rest in (r.split(",", 1) for r in rows))])
    )
    assert main(["judge", *passing]) == ERROR
    assert "give both the same clock, or --offset people=S" in capsys.readouterr().err
    assert main(["judge", *passing, "--offset", "people=-1000"]) == 0
    assert main(["judge", passing[0], "--radius", "0.3"]) == 0
    told = capsys.readouterr().err
    assert "name their topic or file: --people" in told
    assert "people=" not in told


def test_without_a_shield_there_is_no_assumption_to_break(
    passing: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    values = tmp_path / "found.json"
    people = tmp_path / "people.csv"
    noise = np.random.default_rng(2).normal(0.0, 0.02, (121, 2))
    rows = (f"{row / 10},ann,{8 + x},{0.8 + y}" for row, (x, y) in enumerate(noise))
    people.write_text("\n".join(["t_s,ped_id,x_m,y_m", *rows]))
    assert main(["judge", *passing, "--json", str(values)]) == 0
    assert "no assumption can be broken" in capsys.readouterr().out
    found = json.loads(values.read_text())
    error = next(each for each in found["assumptions"] if each["name"] == "position_error")
    assert (error["status"], error["limit"]) == ("not_assumed", None)
    assert error["most"] > 0.02
    assert found["counts"]["broken_assumption"] == 0
    assert main(["judge", *passing, "--fail-on", "broken_assumption"]) == ERROR
    assert "--fail-on must name broken_assumption only with a shield" in capsys.readouterr().err


def test_doubts_use_the_clock_and_the_ids_of_the_log(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A person is lost on the way of the robot and goes on under another id."""
    time = np.arange(121) / 10
    log, people = tmp_path / "robot.csv", tmp_path / "people.csv"
    log.write_text("\n".join(["t_s,x_m,y_m,yaw_rad", *(f"{t},{0.5 * t},0,0" for t in time)]))
    rows = [f"{t},{7 if t <= 8.0 else 19},{8.0 - 0.5 * t},1.0" for t in time if not 8.0 < t < 8.5]
    others = [f"{t},3,40,40" for t in time]
    people.write_text("\n".join(["t_s,ped_id,x_m,y_m", *rows, *others]))
    call = ["judge", str(log), "--people", str(people), "--radius", "0.3", "--time", "5", "12"]
    assert main(call) == 0
    told = capsys.readouterr().err
    assert "person 19 may have been touched at 6.5 s (1 more" in told
    assert "people[" not in told
    assert "simulated=" not in told
    assert "probably one person under two ids: 19 begins at 8.50 s" in told
    assert "from where 7 ended at 8.00 s" in told


def test_remedies_name_options(passing: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "map.pgm").write_bytes(b"P5\n40 40\n255\n" + bytes([254] * 800 + [205] * 800))
    place = tmp_path / "map.yaml"
    place.write_text(
        "image: map.pgm\nresolution: 1.0\norigin: [-20.0, -20.0, 0.0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    assert main(["judge", *passing, "--map", str(place)]) == 0
    assert "--unknown occupied keeps robots away" in capsys.readouterr().err
    assert main(["judge", *passing, "--map", str(place), "--unknown", "occupied", "--fail-on", "wall_contact"]) == 3
    noisy = tmp_path / "noisy.csv"
    noise = np.random.default_rng(1).normal(0.0, 0.05, (400, 2))
    rows = (f"{row / 50},1,{row / 50 + x},{y}" for row, (x, y) in enumerate(noise))
    noisy.write_text("\n".join(["t_s,ped_id,x_m,y_m", *rows]))
    capsys.readouterr()
    assert main(["people", "info", str(noisy)]) == 0
    assert "--smooth 0.6 takes the noise out" in capsys.readouterr().err
    assert main(["people", "info", str(noisy), "--smooth", "0.6"]) == 0
    assert "takes the noise out" not in capsys.readouterr().err
    assert main(["judge", passing[0], "--people", str(noisy), "--radius", "0.3"]) == 0
    told = capsys.readouterr().err
    assert "recording.smoothed" not in told
    assert "its errors hold the noise" in told
