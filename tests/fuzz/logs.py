"""Logs of robots that are right, to be damaged: each format with few messages."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from api.robot_logs import FORMATS, ORIGIN, Scene, write_log, write_people
from hrsafety import io
from hrsafety import navigation as nav

__all__ = ["add_logs"]


def _judged(path: Path, **given: Any) -> Any:
    return nav.metrics.judge(io.load_log(path, **given), robot_radius=0.3)


def add_logs(folder: Path, found: dict[str, tuple[Path, Callable[[Path], Any]]]) -> None:
    """Write a right log of each format into a folder, and add what reads and judges it."""
    scene = Scene(duration=2.0, people=2)
    for kind in FORMATS:
        path = write_log(folder, scene, kind)
        if path.is_dir():
            path = next(each for each in path.iterdir() if each.suffix != ".yaml")
        found[f"load_log {kind}"] = (path, io.load_log)
    people = write_people(folder, scene, origin=float(ORIGIN))
    found["judge, people"] = (people, lambda path, log=folder / "tum.txt": _judged(log, people=path))
    found["judge, table"] = (folder / "table.txt", _judged)
