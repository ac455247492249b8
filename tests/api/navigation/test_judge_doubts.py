"""Logs that contradict themselves or their map are doubted by ``judge``; noise, lag and closed doors are not."""

from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from hrsafety import datasets, io
from hrsafety import navigation as nav
from hrsafety.cli import main
from hrsafety.cli.exit_codes import NOT_CHECKED
from hrsafety.navigation.metrics import judge
from hrsafety.plausibility import unsafe_doubts

Array = npt.NDArray[np.float64]
TIME = np.arange(201) / 10
CODES = {"recording_in_wall", "people_off_map", "twist_disagrees"}


def told(log: Any, **given: Any) -> list[str]:
    return [each.code for each in unsafe_doubts(judge(log, robot_radius=0.2, **given).warnings) if each.code in CODES]


# ---- people and map ------------------------------------------------------------------------------


def corridor(*, outside: str = "unknown") -> nav.StaticMap:
    """Return a hall of 20 m by 6 m between blocks of 4 m."""
    cells = np.ones((70, 120), dtype=np.bool_)
    cells[20:50, 10:110] = False
    return nav.StaticMap.from_grid(cells, resolution=0.2, origin=(-2.0, -7.0), outside=outside)


def walkers(noise: float = 0.0) -> dict[str, Array]:
    generator = np.random.default_rng(1)
    ways = {f"p{lane}": np.stack([18.0 - 0.8 * TIME, 0.0 * TIME + lane - 1.9], axis=1) for lane in range(4)}
    return {name: way + noise * generator.standard_normal(way.shape) for name, way in ways.items()}


def among(people: dict[str, Array], **more: Any) -> SimpleNamespace:
    position = np.stack([1.0 + 0.8 * TIME, 0.0 * TIME + 2.0], axis=1)
    recording = datasets.Recording(
        time_s=np.repeat(TIME, len(people)),
        person=list(people) * len(TIME),
        position=np.stack(list(people.values()), axis=1).reshape(-1, 2),
    )
    return SimpleNamespace(time=TIME, position=position, heading=0.0 * TIME, people=recording, **more)


@pytest.mark.parametrize(
    ("changed", "codes"),
    [
        (lambda way: way[:, ::-1], {"recording_in_wall"}),
        (lambda way: way + np.array([0.0, 4.0]), {"recording_in_wall"}),
        (lambda way: way + np.array([0.0, 40.0]), {"people_off_map"}),
        (lambda way: 1000.0 * way, {"people_off_map"}),
    ],
    ids=["exchanged", "shifted", "another frame", "mm"],
)
def test_people_who_do_not_fit_the_map_are_doubted(changed: Any, codes: set[str]) -> None:
    people = {name: changed(way) for name, way in walkers().items()}
    assert codes <= set(told(among(people), map=corridor()))


def test_one_person_in_a_wall_is_named() -> None:
    people = walkers()
    people["p2"] = people["p2"] + np.array([0.0, 4.0])
    (doubt,) = (each for each in judge(among(people), robot_radius=0.2, map=corridor()).warnings if each.code in CODES)
    assert (doubt.code, doubt.subject, doubt.safe_side) == ("recording_in_wall", "people", False)
    assert "person p2 is within walls of the map in 201 of 201 rows" in doubt.message
    assert "x and y exchanged" in doubt.message


@pytest.mark.parametrize("noise", [0.0, 0.05, 0.15])
def test_noise_beside_walls_a_closed_door_and_a_visit_outside_are_no_doubt(noise: float) -> None:
    people = walkers(noise)
    people["p0"][:, 1] -= 1.0  # along the wall
    people["p3"][:8, 1] = 3.2  # out of a door that the map has closed
    assert told(among(people), map=corridor()) == []
    people["p1"][:150, 1] += 30.0  # one of four comes from outside
    assert told(among(people), map=corridor()) == []


def test_outside_of_a_map_without_limits_nothing_is_said() -> None:
    people = {name: way + np.array([0.0, 40.0]) for name, way in walkers().items()}
    assert told(among(people), map=corridor(outside="free")) == []
    assert told(among(people)) == []


# ---- poses and twists ----------------------------------------------------------------------------


def driven(lag: int = 0, noise: float = 0.0, stop: bool = False) -> SimpleNamespace:
    """Return a robot on a winding way whose speed goes up and down, with its own twists."""
    generator = np.random.default_rng(2)
    time = np.arange(401) / 20
    speed, turn = 0.5 + 0.3 * np.sin(time), 0.6 * np.sin(0.7 * time)
    if stop:
        speed, turn = np.where(time > 4.0, 0.0, speed), np.where(time > 4.0, 0.0, turn)
    heading = np.concatenate([[0.0], np.cumsum(0.05 * 0.5 * (turn[1:] + turn[:-1]))])
    way = speed[:, None] * np.stack([np.cos(heading), np.sin(heading)], axis=1)
    position = np.concatenate([[[0.0, 0.0]], np.cumsum(0.05 * 0.5 * (way[1:] + way[:-1]), axis=0)])
    twist = np.roll(np.stack([speed, 0.0 * speed, turn], axis=1), lag, axis=0)
    twist += noise * generator.standard_normal(twist.shape)
    return SimpleNamespace(
        time=time,
        position=position + 0.1 * noise * generator.standard_normal(position.shape),
        heading=heading,
        twist=twist,
        people=None,
    )


@pytest.mark.parametrize(
    "given", [{}, {"lag": 5}, {"lag": -3}, {"noise": 0.05}, {"lag": 4, "noise": 0.05}, {"stop": True}], ids=str
)
def test_twists_of_the_poses_are_no_doubt(given: dict[str, Any]) -> None:
    log = driven(**given)
    assert told(log) == []
    log.twist[:, :2] *= 1.12  # wheels that are a little smaller
    assert told(log) == []
    log.twist[:, 0] *= -1.0  # backward: the speed is the same
    assert told(log) == []
    log.twist[:] = np.nan
    assert told(log) == []


@pytest.mark.parametrize("noise", [0.0, 0.05])
@pytest.mark.parametrize(
    ("scale", "count"),
    [
        ((0.0, 0.0), 2),
        ((1.0, 0.0), 1),
        ((0.0, 1.0), 1),
        ((1e3, 1.0), 1),
        ((3.6, 1.0), 1),
        ((1.0, 57.3), 1),
        ((2.0, 2.0), 2),
        ((1.0, -1.0), 1),
    ],
)
def test_twists_of_another_unit_or_none_are_doubted(scale: tuple[float, float], count: int, noise: float) -> None:
    log = driven(noise=noise)
    log.twist[:] *= (scale[0], scale[0], scale[1])
    assert told(log) == ["twist_disagrees"] * count


def test_time_stamps_that_are_doubled_are_doubted_with_both_medians() -> None:
    log = driven()
    log.time = 2.0 * log.time
    first, second = (each for each in judge(log, robot_radius=0.2).warnings if each.code in CODES)
    assert first.subject == "log.twist"
    assert "the speed of the log is 0.5" in first.message
    assert "where its poses have 0.2" in first.message
    assert "turn rate" in second.message


def test_a_robot_that_rests_is_not_compared() -> None:
    log = driven()
    log.position[:], log.heading[:] = log.position[0], 0.0
    log.twist[:] = 0.02
    assert told(log) == []


def test_the_command_does_not_pass_what_contradicts_itself(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log, people = tmp_path / "robot.csv", tmp_path / "people.csv"
    people.write_text("\n".join(["t_s,ped_id,x_m,y_m", *(f"{t},1,8,3" for t in TIME)]))
    for speed, code in ((0.5, 0), (0.0, NOT_CHECKED), (50.0, NOT_CHECKED)):
        rows = [f"{t},{0.5 * t},0,0,{speed}" for t in TIME]
        log.write_text("\n".join(["t_s,x_m,y_m,yaw_rad,v_mps", *rows]))
        assert math.isnan(io.load_log(log).twist[0, 2])
        call = ["judge", str(log), "--people", str(people), "--radius", "0.2", "--fail-on", "contact"]
        assert main(call) == code
        assert ("twist_disagrees" in capsys.readouterr().out) == (code != 0)
