"""The page on validation shows what the two-wheel robot does, to the digits it prints."""

from __future__ import annotations

import dataclasses
import math
import re
from pathlib import Path

import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "validation.md").read_text(encoding="utf-8")
ROW = re.compile(r"^\| two wheels, (\S+) \| ([\d.]+) \([\d.]+\) \| ([\d., ]+?) ?(?:\(.*\))? \| ([\d.]*)", re.MULTILINE)
LAW = nav.VirtualForceField(stabilizing="off")
NAMES = {"7.5.5": "multiple_obstacles"}


@pytest.mark.parametrize(("name", "time", "distances", "score"), ROW.findall(PAGE))
def test_page_shows_the_run(name: str, time: str, distances: str, score: str) -> None:
    scene = scenarios.configuration(NAMES.get(name, name))
    scene = dataclasses.replace(scene, robot=nav.DifferentialDriveRobot(), heading=math.pi)
    result = nav.evaluate(scene, LAW)
    run = result.trajectory
    assert run.outcome == "arrived"
    assert f"{run.arrival_time:.2f}" == time
    assert [f"{least:.3f}" for least in run.min_distance] == distances.split(", ")
    if score:
        assert f"{result.total:.2f}" == score


def test_page_has_every_configuration() -> None:
    assert [row[0] for row in ROW.findall(PAGE)] == ["n1", "n2", "n3", "n4", "7.5.5"]
