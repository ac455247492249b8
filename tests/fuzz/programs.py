"""Programs of robots, measured records and arms that are right, to be damaged: each is judged, not read alone."""

from __future__ import annotations

import math
import random
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from hrsafety import arms, program, records
from hrsafety.arms.rolling import BASE_JOINTS

__all__ = ["JUDGE", "misnumbered", "programs"]

JUDGE = "judge"
"""First word of the names of what is judged: half of the damage is in numbers."""

NUMBER = re.compile(rb"(?<![A-Za-z_0-9.])-?\d+(?:\.\d+)?(?:e-?\d+)?(?![A-Za-z_0-9.])")
START = [0.0, 0.35, 1.45, -0.23, -1.57, 0.0]
HEAD = """[robot]
urdf = "example"
payload = { link = "tool", mass = 1.0, center = [0.0, 0.0, 0.06] }
armature = { turn = 1.2, shoulder = 1.2, elbow = 1.0, wrist_1 = 0.3, wrist_2 = 0.3, wrist_3 = 0.3 }
[motion]
velocity = 2.0
"""
ROLLING = HEAD.replace("[motion]", 'base = "differential"\nbase_mass = 60.0\nbase_inertia = 4.0\n[motion]')
REST = """[[points]]
name = "gripper"
link = "tool"
area = 4e-4
covering = "pad"
[[coverings]]
name = "pad"
material = { law = "linear", E = 5e5 }
thickness = 0.02
area = 4e-4
[drive]
model = "rigid"
reaction_time = 0.02
deceleration = 8.0
[[segments]]
regions = ["chest"]
human_speed = 0.1
"""
MOVES = """acceleration = 4.0
tcp_speed = 0.5
[zones]
count = 3
deceleration = 2.5
[[moves]]
kind = "joint"
to = [0.0, 0.35, 1.45, -0.23, -1.57, 0.0]
[[moves]]
name = "go"
kind = "joint"
to = { turn = 0.3 }
blend = 0.05
[[moves]]
kind = "linear"
to = [0.7, 0.3, 0.5]
dwell = 0.2
"""
MJCF = (
    '<mujoco><compiler angle="radian"/><worldbody><body name="a" pos="0 0 0.3"><joint name="i" axis="0 0 1" '
    'range="-2 2" armature="0.5"/><inertial mass="3" pos="0.1 0 0" diaginertia="0.02 0.03 0.03"/>'
    '<body name="b" pos="0.3 0 0" euler="0 0.3 0"><joint name="j" axis="0 1 0" range="-2 2" armature="0.2"/>'
    '<inertial mass="2" pos="0.1 0 0" diaginertia="0.01 0.02 0.02"/></body></body></worldbody></mujoco>'
)


def misnumbered(content: bytes, draws: random.Random) -> bytes:
    """Return content in which one to three numbers are others: other units, signs, sizes, or none at all."""
    for _ in range(draws.choice((1, 1, 2, 3))):
        found = list(NUMBER.finditer(content))
        if not found:
            return content
        chosen = draws.choice(found)
        value = float(chosen[0])
        kinds = (
            value * 1e3,
            value * 1e-3,
            math.degrees(value),
            -value,
            0.0,
            value + draws.gauss(0.0, 1.0),
            value * 1e200,
        )
        told = draws.choice([*(repr(each) for each in kinds), "nan", "inf", "", "1e-320", str(draws.getrandbits(70))])
        content = content[: chosen.start()] + told.encode() + content[chosen.end() :]
    return content


def programs(folder: Path) -> dict[str, tuple[Path, Callable[[Path], Any]]]:
    """Write a right file of each kind into a folder and return what judges it, by name."""
    texts = {
        "moves.toml": HEAD + MOVES + REST + 'from = "move 1"\nto = "move 3"\n',
        "log.toml": HEAD + 'acceleration = 4.0\nlog = "joints.csv"\n' + REST + "from = 0.0\nto = 1.0\n",
        "rolling.toml": ROLLING + 'acceleration = 4.0\nlog = "rolling.csv"\n' + REST + "from = 0.0\nto = 1.0\n",
        "drawn.toml": HEAD + "draws = 400\naccept_quantile = 0.95\n" + REST,
        "joints.csv": _joints(),
        "rolling.csv": _joints(driving=True),
        "arm_of_program.urdf": arms.Arm.example().urdf,
        "arm_of_program.xml": MJCF,
        "force.csv": _force(),
        "head.csv": _head(),
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "force_16.csv").write_bytes(_force().replace(",", ";").replace(".", ",").encode("utf-16"))
    (folder / "head.001").write_text(_channel(), encoding="utf-8")
    judged: dict[str, tuple[str, Callable[[Path], Any]]] = {
        "moves.toml": ("program", _judged),
        "log.toml": ("program", _judged),
        "drawn.toml": ("program", _judged),
        "rolling.toml": ("program", _judged),
        "joints.csv": ("program", lambda _path: _judged(folder / "log.toml")),
        "rolling.csv": ("program", lambda _path: _judged(folder / "rolling.toml")),
        "arm_of_program.urdf": ("arm", _arm),
        "arm_of_program.xml": ("arm", _arm),
        "force.csv": ("record", _pressed),
        "force_16.csv": ("record", _pressed),
        "head.csv": ("record", _hit),
        "head.001": ("record", _hit),
    }
    return {f"{JUDGE} {kind} {name}": (folder / name, call) for name, (kind, call) in judged.items()}


def _judged(path: Path) -> Any:
    """Judge a program: no number of a limit is missing where it is kept."""
    task = program.load_program(path)
    study = task.report(intervals=60) if isinstance(task, program.Program) else task.report()
    for row in study.rows:
        if math.isnan(row.share) or math.isnan(row.speed) or math.isnan(row.allowed_speed):
            raise AssertionError(f"a limit without a number: {row.verdict}")
    return study.verdict


def _arm(path: Path) -> Any:
    """Ask an arm for the masses of its last link."""
    arm = arms.Arm.from_urdf(path)
    if not arm.moved_links:
        return None
    low, high = (np.clip(each, -3.0, 3.0) for each in arm.limits.T)
    found = arm.extremes(np.clip(0.5 * (low + high), *arm.limits.T), link=arm.moved_links[-1])
    numbers = [arm.iso_mass, arm.total_mass, float(found.worst_mass), float(found.least_mass)]
    if any(math.isnan(each) or each < 0.0 for each in numbers):
        raise AssertionError(f"masses {numbers}")
    return arm.warnings


def _pressed(path: Path) -> Any:
    found = records.load(path).force()
    word = found.verdict(transient=280.0, quasi_static=140.0)
    if word == "within_limits" and not (found.peak <= 280.0 and found.transient <= 280.0):
        raise AssertionError(f"peak {found.peak} {word}")
    return word


def _hit(path: Path) -> Any:
    found = records.load(path).acceleration(filter_class=None)
    word = found.verdict(peak_g=80.0, hic15=700.0)
    if word == "within_limits" and not (found.peak_g <= 80.0 and found.hic15 <= 700.0):
        raise AssertionError(f"peak {found.peak_g} {word}")
    return word


def _joints(driving: bool = False) -> str:
    time = np.arange(0.0, 1.0 + 1e-9, 0.02)
    names = (*arms.Arm.example().joint_names, *(BASE_JOINTS if driving else ()))
    rows = [START[:] for _ in time]
    for row, each in zip(rows, time.tolist(), strict=True):
        row[0] = 0.2 - 0.2 * math.cos(math.pi * each)
        if driving:
            angle = 0.3 * row[0]
            row += [2.0 * math.sin(angle), 2.0 - 2.0 * math.cos(angle), angle]
    lines = [",".join(f"{value:.6f}" for value in (one, *row)) for one, row in zip(time, rows, strict=True)]
    return "\n".join([",".join(["time", *names]), *lines]) + "\n"


def _force() -> str:
    time = np.arange(0.0, 0.9, 2e-3)
    values = np.where((time > 0.1) & (time < 0.2), 90.0 * np.sin(np.pi * (time - 0.1) / 0.1), 0.0)
    rows = "\n".join(f"{one:.4f},{each:.4f}" for one, each in zip(time, values, strict=True))
    return f"Test,pad 3\ntime [s],force [N]\n{rows}\n"


def _head() -> str:
    time = np.arange(0.0, 0.06, 1e-4)
    values = np.where((time > 0.02) & (time < 0.03), 60.0 * np.sin(np.pi * (time - 0.02) / 0.01), 0.0)
    rows = "\n".join(f"{1e3 * one:.2f}\t{each:.4f}" for one, each in zip(time, values, strict=True))
    return f"t\ta\nms\tg\n{rows}\n"


def _channel() -> str:
    times = np.arange(600)
    values = np.where((times >= 200) & (times < 300), 600.0 * np.sin(np.pi * (times - 200) / 100), 0.0)
    head = {
        "Channel code": "11HEAD000000ACXA",
        "Unit": "m/s2",
        "Reference channel": "implicit",
        "Time of first sample": "0.0",
        "Sampling interval": "0.0001",
        "Number of samples": "600",
    }
    return "\n".join([*(f"{name} :{each}" for name, each in head.items()), *(f"{each:.4f}" for each in values)]) + "\n"
