"""Scenario files: TOML in, a checked scenario and its law out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from hrsafety import _keys as kind
from hrsafety import navigation as nav
from hrsafety._display import displayed
from hrsafety._keys import Keys, checked, located, parsed
from hrsafety.errors import InvalidParameterError
from hrsafety.io.people.tracks import load_track, track_doubts
from hrsafety.navigation.maps.outlines import checked_shapes, standing
from hrsafety.navigation.obstacles.moving_rectangle import Mobile
from hrsafety.scenarios.laws import law_of, safe_of

__all__ = ["TOP", "ScenarioFile", "load", "read_scenario"]


@displayed
class ScenarioFile(NamedTuple):
    """Contents of a scenario file.

    Attributes
    ----------
    scenario : Scenario
        Robot, start, goal, obstacles, rules of the run.
    law : Law
        The law of the table ``[law]``; the default law without that table.
    """

    scenario: nav.Scenario
    law: nav.Law


TOP: Keys = MappingProxyType(
    {
        "start": kind.pair,
        "goal": kind.pair,
        "control_period": kind.number,
        "time_limit": kind.number,
        "arrival_tolerance": kind.number,
        "heading": kind.number,
        "rest_time": kind.number,
        "seed": kind.integer,
        "walls": kind.lines,
        "robot": kind.table,
        "obstacles": kind.tables,
        "measurement": kind.table,
        "law": kind.table,
        "safe": kind.table,
    }
)
_ROBOT: dict[str, kind.Kind] = {
    "type": kind.word,
    "mass": kind.number,
    "radius": kind.number,
    "footprint": kind.outline,
    "max_speed": kind.number,
    "max_acceleration": kind.number,
    "max_deceleration": kind.number,
    "wheel_radius": kind.number,
    "winding_resistance": kind.number,
}
_WHEELS = ("wheel_inertia", "wheel_viscous_friction", "wheel_static_friction")
_ROBOTS: Mapping[str, tuple[type[nav.HolonomicRobot] | type[nav.DifferentialDriveRobot], Keys]] = MappingProxyType(
    {
        "holonomic": (nav.HolonomicRobot, {**_ROBOT, **dict.fromkeys(_WHEELS, kind.triple)}),
        "differential_drive": (
            nav.DifferentialDriveRobot,
            {
                **_ROBOT,
                **dict.fromkeys(_WHEELS, kind.pair),
                "max_angular_acceleration": kind.number,
                "max_turn_rate": kind.number,
                "max_turn_acceleration": kind.number,
                "reference_speed_share": kind.number,
                "wheel_span": kind.number,
            },
        ),
    }
)
_MEASUREMENT: Keys = MappingProxyType(
    {"scale": kind.number, "distribution": kind.word, "of": kind.word, "latency": kind.number}
)
_REGIONS: dict[str, kind.Kind] = {
    "active_radius": kind.number,
    "critical_radius": kind.number,
    "active_clearance": kind.number,
    "critical_clearance": kind.number,
    "max_speed": kind.number,
}
_ROUND: dict[str, kind.Kind] = {"type": kind.word, "radius": kind.number, **_REGIONS}
_DISC: Keys = MappingProxyType({**_ROUND, "center": kind.pair})
_BOX: dict[str, kind.Kind] = {
    "type": kind.word,
    "length": kind.number,
    "width": kind.number,
    "heading": kind.number,
    **_REGIONS,
}
_RECTANGLE: Keys = MappingProxyType({**_BOX, "center": kind.pair})


@kind.top_level(TOP)
def load(path: str | PathLike[str]) -> ScenarioFile:
    r"""Read a scenario file.

    The file is TOML. At its top stand ``start`` and ``goal`` (required, [x, y] in m) and
    ``control_period``, ``time_limit``, ``arrival_tolerance``, ``heading``, ``rest_time``,
    ``seed`` of `Scenario`, and ``walls``, an array of polylines, each an array of points [x, y] in m, which the law
    knows. Tables, all optional:

    - ``[robot]`` with ``type``, ``"holonomic"`` when left out or ``"differential_drive"``, and the
      fields of `HolonomicRobot` or `DifferentialDriveRobot`; ``footprint`` is an array of corners [x, y] in m, a text
      as Nav2 writes it, or a radius in m;
    - ``[[obstacles]]``, each with ``type`` and the fields of its class: ``"disc"``,
      ``"rectangle"``, ``"moving_disc"``, ``"moving_rectangle"``, ``"human"``. The motion of the last
      three is either ``velocity`` with ``stop`` (not a person: or ``acceleration``), or ``segments``, an array
      of ``{duration, velocity, acceleration}``, or a recording: ``time`` and ``position``
      arrays, or ``path``, a CSV file with the columns t_s, x_m, y_m, relative to the scenario
      file, with ``fps`` if its times are numbers of frames;
    - ``[measurement]`` with the fields of `Measurement`;
    - ``[safe]``, which puts parts around the law: ``preferred_speed``, ``takeover`` and
      ``critical_distance`` of `SafeNavigation`, and the tables ``[safe.shield]`` and ``[safe.yielding]`` or
      ``[safe.foresight]`` with the fields of `Shield`, `Yielding` and `Foresight`, or ``[safe.filter]`` with ``type``,
      such as ``"barrier"``, and the fields of that filter;
    - ``[law]`` with ``type``, the name of a law such as ``"virtual_force_field"`` or a short name such as
      ``"vff"``, and the fields of its class. An unknown name is an error that lists all.

    Parameters
    ----------
    path : path-like
        The file.

    Returns
    -------
    ScenarioFile
        Scenario and law.

    Raises
    ------
    InvalidParameterError
        If the file cannot be read, is not UTF-8 or not TOML, a key is unknown or missing, or a
        value breaks a rule; the message names the key, as in ``obstacles[1].radius``.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import scenarios
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder, "empty_room.toml")
    ...     _ = file.write_text("start = [4.0, 0.0]\ngoal = [0.0, 0.0]\n")
    ...     scenarios.load(file).scenario.goal
    (0.0, 0.0)
    """
    if not isinstance(path, (str, PathLike)):
        raise InvalidParameterError("path", "be a path", path)
    place = Path(path)
    return read_scenario(parsed(place), place.parent)


def read_scenario(described: Mapping[str, Any], folder: Path) -> ScenarioFile:
    """Return what the tables of a scenario file describe.

    Parameters
    ----------
    described : mapping
        The tables as read.
    folder : Path
        Where recordings lie that it names.

    Returns
    -------
    ScenarioFile
        Scenario and law.
    """
    fields = checked("", described, TOP, required=("start", "goal"))
    law = law_of(fields.pop("law", {"type": "virtual_force_field"}))
    if "safe" in fields:
        law = safe_of(law, fields.pop("safe"))
    if "walls" in fields:
        with located(""):
            fields["walls"] = known = standing(checked_shapes("walls", fields["walls"]))
        law = law.replaced(map=known) if isinstance(law, nav.SafeNavigation) else nav.SafeNavigation(law, map=known)
    if "robot" in fields:
        fields["robot"] = _robot(fields["robot"])
    if "measurement" in fields:
        given = checked("measurement", fields["measurement"], _MEASUREMENT)
        with located("measurement"):
            fields["measurement"] = nav.Measurement(**given)
    listed = fields.pop("obstacles", [])
    recorded = [isinstance(table, dict) and "path" in table for table in listed]
    obstacles = [_obstacle(f"obstacles[{index}]", table, folder) for index, table in enumerate(listed)]
    doubts = [
        doubt
        for index, (each, read) in enumerate(zip(obstacles, recorded, strict=True))
        if read and isinstance(each, Mobile) and each.path is not None
        for doubt in track_doubts(f"obstacles[{index}]", *map(np.array, each.path), person=isinstance(each, nav.Human))
    ]
    with located(""):
        return ScenarioFile(nav.Scenario(obstacles=tuple(obstacles), doubts=doubts, **fields), law)


def _robot(table: dict[str, Any]) -> nav.HolonomicRobot | nav.DifferentialDriveRobot:
    name = kind.word("robot.type", table.get("type", "holonomic"))
    kind.one_of("robot.type", name, _ROBOTS)
    robot, keys = _ROBOTS[name]
    given = checked("robot", table, keys)
    given.pop("type", None)
    with located("robot"):
        return robot(**given)


def _obstacle(path: str, table: dict[str, Any], folder: Path) -> nav.Obstacle:
    if "type" not in table:
        raise kind.missing(f"{path}.type", f"write one of {', '.join(_OBSTACLES)}")
    word = kind.word(f"{path}.type", table["type"])
    if word.lower() in _EVERYDAY:
        rule, remedy = f"be {' or '.join(_OBSTACLES)}", f'did you mean "{_EVERYDAY[word.lower()]}"?'
        raise InvalidParameterError(f"{path}.type", rule, word, remedy)
    kind.one_of(f"{path}.type", word, _OBSTACLES)
    return _OBSTACLES[word](path, table, folder)


def _disc(path: str, table: dict[str, Any], _folder: Path) -> nav.Obstacle:
    given = checked(path, table, _DISC, required=("center", "radius"))
    del given["type"]
    with located(path):
        return nav.Disc(**given)


def _rectangle(path: str, table: dict[str, Any], _folder: Path) -> nav.Obstacle:
    given = checked(path, table, _RECTANGLE, required=("center", "length", "width"))
    del given["type"]
    with located(path):
        return nav.Rectangle(**given)


def _human(path: str, table: dict[str, Any], folder: Path) -> nav.Obstacle:
    return _moving(path, table, folder, nav.Human, place="start", outline=_ROUND)


def _moving_disc(path: str, table: dict[str, Any], folder: Path) -> nav.Obstacle:
    return _moving(path, table, folder, nav.MovingDisc, place="center", outline=_ROUND, required=("radius",))


def _moving_rectangle(path: str, table: dict[str, Any], folder: Path) -> nav.Obstacle:
    body, required = nav.MovingRectangle, ("length", "width")
    return _moving(path, table, folder, body, place="center", outline=_BOX, required=required)


def _moving(
    path: str,
    table: dict[str, Any],
    folder: Path,
    body: type[Mobile],
    *,
    place: str,
    outline: Mapping[str, kind.Kind],
    required: tuple[str, ...] = (),
) -> nav.Obstacle:
    """Return a body that walks straight, in segments, or as recorded."""
    known: dict[str, kind.Kind]
    needed: tuple[str, ...]
    if "path" in table:
        known, needed = {**outline, "path": kind.word, "fps": kind.number}, ("path",)
    elif "time" in table or "position" in table:
        known, needed = {**outline, "time": kind.numbers, "position": kind.pairs}, ("time", "position")
    elif "segments" in table:
        known, needed = {**outline, place: kind.pair, "segments": kind.segments}, (place, "segments")
    else:
        known = {**outline, place: kind.pair, "velocity": kind.pair, "stop": kind.pair}
        if body is not nav.Human:
            known["acceleration"] = kind.pair
        needed = (place, "velocity")
    if "velocity" in needed and "velocity" not in table and place in table:
        raise kind.missing(f"{path}.velocity", "or give segments, time and position, or path")
    given = checked(path, table, known, required=(*needed, *required))
    del given["type"]
    if "path" in given:
        given["time"], given["position"] = _track(path, folder / given.pop("path"), given.pop("fps", None))
    with located(path):
        if "time" in given:
            return body.from_path(given.pop("time"), given.pop("position"), **given)
        if "segments" in given:
            return body.from_segments(given.pop(place), given.pop("segments"), **given)
        return body(**given)


def _track(path: str, file: Path, fps: float | None) -> tuple[object, object]:
    """Read a recording that an obstacle refers to."""
    try:
        return load_track(file, fps=fps)
    except InvalidParameterError as error:
        if error.argument == "fps":
            raise error.renamed(f"{path}.fps") from None
        argument = f"{path}.path" if error.argument == "path" else f"{path}.path: {error.argument}"
        raise error.renamed(argument) from None


_EVERYDAY = {"person": "human", "pedestrian": "human", "circle": "disc", "box": "rectangle", "wall": "rectangle"}
_OBSTACLES: MappingProxyType[str, Callable[[str, dict[str, Any], Path], nav.Obstacle]] = MappingProxyType(
    {
        "disc": _disc,
        "rectangle": _rectangle,
        "moving_disc": _moving_disc,
        "moving_rectangle": _moving_rectangle,
        "human": _human,
    }
)
