"""A goal in an active region: refused in every verb under a law that is pushed away from it, else reached."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from api.cli_answers import error_line, written
from hrsafety import navigation as nav
from hrsafety import scenarios, sweep
from hrsafety.cli import main
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.controller import Controller
from hrsafety.navigation.laws import SafeNavigation, Shield, Yielding
from hrsafety.navigation.maps import Guide, StaticMap
from hrsafety.navigation.metrics import falsify

FIELD = nav.VirtualForceField()
WALL = nav.Rectangle(center=(0.0, 0.5), length=1.0, width=0.2)
NEAR = nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), obstacles=[WALL], time_limit=30.0)
MAP = StaticMap.from_obstacles([WALL])
REFUSAL = "goal must lie outside the active region of every stationary obstacle"
FILE = """
start = [4.0, 0.0]
goal = [0.0, 0.0]
[[obstacles]]
type = "rectangle"
center = [0.0, 0.5]
length = 1.0
width = 0.2
"""


def _swept(law: nav.Law) -> object:
    study = sweep.NavigationStudy(scenarios=[NEAR], law=law)
    return sweep.run(sweep.Grid([sweep.Axis(name="detour_gain", values=[10.0, 20.0])]), study)


VERBS: dict[str, Callable[[nav.Law], object]] = {
    "simulate": lambda law: nav.simulate(NEAR, law),
    "simulate as built": lambda law: nav.simulate(NEAR, law, built=nav.robots.AsBuilt()),
    "evaluate": lambda law: nav.evaluate(NEAR, law),
    "simulate many": lambda law: nav.simulate_many(NEAR, law, seeds=2),
    "paths of many": lambda law: nav.simulate_many(NEAR, law, seeds=2, paths=True),
    "simulate batch": lambda law: nav.simulate_batch([NEAR], law),
    "compare": lambda law: nav.compare({"near": NEAR}, [nav.OptimalReciprocalCollisionAvoidance(), law]),
    "optimize gains": lambda law: nav.optimize_gains([NEAR], law),
    "run": lambda law: nav.Run(NEAR, law),
    "controller": lambda law: Controller(law, NEAR.robot, NEAR.goal, start=NEAR.start, obstacles=[WALL]),
    "first update": lambda law: Controller(law, NEAR.robot, NEAR.goal, obstacles=[WALL]).update(0.0, (4, 0), (0, 0)),
    "falsify": lambda law: falsify(NEAR, law, episodes=2),
    "sweep": _swept,
}
UNABLE = {
    "field": FIELD,
    "khatib": nav.Khatib(),
    "field behind a shield": SafeNavigation(FIELD, shield=Shield()),
}
ABLE = {
    "orca": nav.OptimalReciprocalCollisionAvoidance(margin=0.05),
    "velocity obstacle": nav.VelocityObstacle(margin=0.05),
    "field, shield, yielding": SafeNavigation(FIELD, shield=Shield(), yielding=Yielding()),
    "field, map, guide, shield": SafeNavigation(FIELD, map=MAP, guide=Guide(), shield=Shield()),
    "orca, shield": SafeNavigation(nav.OptimalReciprocalCollisionAvoidance(margin=0.05), shield=Shield()),
}


@pytest.mark.parametrize("verb", VERBS.values(), ids=VERBS.keys())
def test_every_verb_refuses_a_law_that_is_pushed_away(verb: Callable[[nav.Law], object]) -> None:
    with pytest.raises(InvalidParameterError, match=REFUSAL) as caught:
        verb(FIELD)
    assert "move it by" in str(caught.value)


@pytest.mark.parametrize("law", UNABLE.values(), ids=UNABLE.keys())
def test_laws_without_a_takeover_are_refused(law: nav.Law) -> None:
    with pytest.raises(InvalidParameterError, match=REFUSAL):
        nav.simulate(NEAR, law)


@pytest.mark.parametrize("law", ABLE.values(), ids=ABLE.keys())
def test_laws_that_know_no_regions_or_take_over_arrive(law: nav.Law) -> None:
    run = nav.simulate(NEAR, law)
    assert run.outcome == "arrived"
    assert run.min_clearance[0] > 0.0
    assert "goal_in_active_region" not in {each.code for each in run.warnings}
    assert list(nav.simulate_many(NEAR, law, seeds=2).outcome) == ["arrived", "arrived"]


@pytest.mark.parametrize("away", [0.21, 0.24, 0.26])
def test_a_shielded_law_arrives_from_a_start_near_a_wall(away: float) -> None:
    """The start is in the critical region of the wall, where the field alone brakes and never leaves."""
    scene = nav.Scenario(start=(0.0, 0.4 - away), goal=(3.0, 0.0), obstacles=[WALL], time_limit=30.0)
    assert nav.simulate(scene, FIELD).outcome == "stopped"
    for law in (ABLE["field, shield, yielding"], ABLE["field, map, guide, shield"]):
        run = nav.simulate(scene, law)
        assert run.outcome == "arrived"
        assert run.min_clearance[0] > 0.0


def test_a_goal_that_no_robot_reaches_ends_with_an_outcome() -> None:
    """The goal lies inside the wall: a shielded robot stands before it."""
    scene = nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.5), obstacles=[WALL], time_limit=20.0)
    run = nav.simulate(scene, ABLE["field, shield, yielding"])
    assert run.outcome in {"stopped", "timed_out"}
    assert run.min_clearance[0] > 0.0


def test_a_file_loads_and_is_refused_when_it_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = written(tmp_path / "near.toml", FILE)
    assert [each.code for each in scenarios.load(file).scenario.warnings] == ["goal_in_active_region"]
    assert main(["simulate", file]) != 0
    assert REFUSAL in error_line(capsys)
    assert main(["simulate", file, "--safe"]) == 0
    assert "arrived" in capsys.readouterr().out


def test_rows_of_arrays_are_refused_by_their_number() -> None:
    given: dict[str, Any] = {
        "start": (4.0, 0.0),
        "goal": (0.0, 0.0),
        "obstacle_position": np.array([[[9.0, 9.0]], [[0.0, 0.4]]]),
        "obstacle_radius": 0.1,
        "person": False,
    }
    scenes = nav.Scenarios.from_arrays(**given)
    assert [len(each.warnings) for each in scenes] == [0, 1]
    for many in (nav.simulate_many, nav.simulate_batch):
        with pytest.raises(InvalidParameterError, match=rf"scenarios\[1\]\.{REFUSAL}"):
            many(scenes, FIELD)
        table = many(scenes, ABLE["orca"])
        assert list(table.outcome) == ["arrived", "arrived"]
