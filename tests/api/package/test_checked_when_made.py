"""Objects are checked when they are made: what random arguments brought into them silently, or as foreign errors."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import HrsafetyError, InvalidParameterError, arms, contact, impact, reactive, standards, sweep
from hrsafety import gym as environments
from hrsafety import navigation as nav
from hrsafety.benchmarks.results import read_rows

NAN = math.nan
WORLD = nav.World(robots=[nav.Robot(start=(0.0, 0.0), goal=(3.0, 0.0))])
URDF = arms.Arm.example().urdf
SCENE = nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6))
RAGGED: Any = [[1.0], [2.0, 3.0]]

CASES: dict[str, tuple[str, Callable[[], Any]]] = {
    "modulus": ("material.modulus must be finite", lambda: contact.Linear(modulus=NAN)),
    "lock": ("material.lock must be finite", lambda: contact.GibsonAshby(modulus=1e5, plateau=1e4, lock=math.inf)),
    "strain": ("material.strain must be finite", lambda: contact.StressTable(strain=[0.0, NAN], stress=[0.0, 1.0])),
    "offset": ("base.offset must be finite", lambda: contact.DifferentialBase(mass=9.0, inertia=1.0, offset=NAN)),
    "center": ("center must be finite", lambda: arms.Payload("tool", 1.0, center=(NAN, 0.0, 0.0))),
    "inertia": ("inertia must be finite", lambda: arms.Payload("tool", 1.0, inertia=np.full((3, 3), NAN))),
    "payloads": ("payloads must be a tuple of Payload", lambda: arms.Arm(URDF, payloads=7)),
    "payload": ("payload.* must be a Payload", lambda: arms.Arm(URDF, payloads=(7,))),
    "armature": ("armature must be a tuple of pairs", lambda: arms.Arm(URDF, armature=(("elbow",),))),
    "locked": ("locked must be a tuple of names", lambda: arms.Arm(URDF, locked=7)),
    "world": ("world must be a World", lambda: environments.Task(world=7)),
    "area": ("area.low must be finite", lambda: environments.Task(world=WORLD, area=((NAN, 0.0), (1.0, 1.0), True))),
    "area of two": ("area must be .low, high, level.", lambda: environments.Task(world=WORLD, area=((0, 0), (1, 1)))),
    "render_mode": ("render_mode must be", lambda: environments.CrowdEnv(WORLD, render_mode="human")),
    "vector render_mode": ("render_mode must be", lambda: environments.CrowdVectorEnv(WORLD, render_mode="human")),
    "autoreset_mode": ("autoreset_mode must be", lambda: environments.CrowdVectorEnv(WORLD, autoreset_mode="never")),
    "clipped": (
        "clipped must be three",
        lambda: reactive.SoundRecording(samples=np.zeros((3, 4)), sample_rate=1e4, clipped=1),
    ),
    "path": (
        "path must be None, or as it was made, .*use from_path",
        lambda: nav.Human(start=(0, 0), velocity=(1, 0), path=3),
    ),
    "segments": (
        "segments must be None, or as it was made",
        lambda: nav.Human(start=(0, 0), velocity=(1, 0), segments=3),
    ),
    "segment of a person": (
        r"segments\[0\] must be .duration, velocity, acceleration.",
        lambda: nav.Human(start=(0, 0), velocity=(1, 0), segments=((1.0,),)),
    ),
    "time of a path": (
        "time must be an array of numbers",
        lambda: nav.MovingDisc(center=(0, 0), radius=0.2, velocity=(1, 0), path=(("a",), ("b",))),
    ),
    "path of a rectangle": (
        "path must be None, or as it was made, .*use from_path",
        lambda: nav.MovingRectangle(center=(0, 0), length=1, width=1, velocity=(1, 0), path=3),
    ),
    "segments of a rectangle": (
        "segments must be None, or as it was made",
        lambda: nav.MovingRectangle(center=(0, 0), length=1, width=1, velocity=(1, 0), segments=3),
    ),
    "set-point": ("segments must be a sequence", lambda: impact.SetPoint(segments=np.array(1.0))),
    "angle": ("angle must be finite", lambda: nav.robots.OpenLoopTest(command=1.0, time=[0.0, 1.0], angle=[0.0, NAN])),
    "discs": ("discs must be", lambda: nav.maps.StaticMap(discs=RAGGED)),
    "groups": (
        "groups must be",
        lambda: nav.metrics.Episode(position=[(0, 0), (1, 0)], step=0.1, goal=(1, 0), robot_radius=0.2, groups=RAGGED),
    ),
    "weights": (
        "weights must be three numbers",
        lambda: sweep.NavigationStudy(scenarios=[SCENE], weights=np.array(1.0)),
    ),
    "force": ("force must be a Quantity", lambda: standards.LimitRow("chest", None, "transient", force=NAN)),
    "quantity": (
        "pressure must be finite and positive",
        lambda: standards.LimitRow("chest", None, "transient", pressure=standards.Quantity(NAN, "certain", ())),
    ),
    "contact": ("contact must be one of", lambda: standards.LimitRow("chest", None, "slow")),
    "rows": (r"rows\[0\] must be a LimitRow", lambda: standards.LimitSet("a", "A", "1", "", (7,), {})),
    "swings": (
        "moving_mass must make at most 50000 rad of swing",
        lambda: impact.identify_foam(
            [10.0, 20.0, 30.0], [0.001, 0.002, 0.003], np.arange(0.0, 0.2, 1e-3), np.zeros(200), 2.7e-8
        ),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_wrong_argument_is_refused_at_once(name: str) -> None:
    words, make = CASES[name]
    with pytest.raises(HrsafetyError, match=words):
        make()


def test_rows_that_are_no_text_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "rows.csv"
    file.write_bytes(b"case,outcome\n\xff\xfe\n")
    with pytest.raises(InvalidParameterError, match=r"out must hold text in UTF-8 .*rows\.csv.*byte 13"):
        read_rows(file)


def test_motions_survive_a_copy() -> None:
    walk = nav.Human.from_path([0.0, 1.0], [(0.0, 0.0), (1.0, 0.0)])
    turn = nav.Human.from_segments((0.0, 0.0), [(1.0, (0.1, 0.0), (0.0, 0.0))])
    for each in (walk, turn):
        fields = {name: getattr(each, name) for name in ("start", "velocity", "radius", "path", "segments")}
        assert nav.Human(**fields) == each
