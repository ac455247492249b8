"""JSON: TrajNet++, one object a line, and SocNavData, one object a file."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety.datasets.robots import RecordedRobot
from hrsafety.errors import FileError, Shown
from hrsafety.io.cells import short
from hrsafety.io.people.rates import common_step
from hrsafety.io.people.request import Request
from hrsafety.io.people.rows import Rows
from hrsafety.io.reader import Document, Reader

__all__ = ["READERS"]

Array = npt.NDArray[np.float64]


def _is_trajnetpp(document: Document) -> bool:
    line = next((line.strip() for line in document.first_lines if line.strip()), "")
    return line.startswith("{") and ('"scene"' in line or '"track"' in line) and '"sequence"' not in line


def _is_socnav(document: Document) -> bool:
    return document.first_lines[0].lstrip()[:1] == "{" and '"sequence"' in document.text


def _unreadable(document: Document, error: Exception, line: int | None = None) -> FileError:
    if isinstance(error, json.JSONDecodeError):
        line = line if line is not None else error.lineno
        return document.error("unreadable", "be JSON", Shown(f"{error.msg} at column {error.colno}"), line=line)
    found = Shown(short(str(error)) if type(error) is ValueError else "brackets that are too deep")
    return document.error("unreadable", "be JSON of finite numbers", found, line=line)


def _constant(word: str) -> float:
    """Return what is no number of JSON, but is written by many: the place is unknown then."""
    if word != "NaN":
        raise ValueError(word)
    return math.nan


def _read_trajnetpp(document: Document, _request: Request) -> Rows:
    lines = document.plain.split(b"\n")
    filled = [place for place, line in enumerate(lines) if line.strip()]
    entries = _entries(document, lines, filled)
    scenes = [each["scene"] for each in entries if "scene" in each]
    tracks = [(each["track"], place + 1) for each, place in zip(entries, filled, strict=True) if "track" in each]
    observed = [
        (track, line) for track, line in tracks if _mapping(document, track, line).get("prediction_number") is None
    ]
    clock, ids, xs, ys = (
        [_key(document, track, key, line) for track, line in observed] for key in ("f", "p", "x", "y")
    )
    where = np.array([line for _, line in observed], dtype=np.int64)
    numbers = [_numbers(document, name, values, where) for name, values in (("f", clock), ("x", xs), ("y", ys))]
    person = _ids(document, ids, where)
    rate = None
    rows = Rows(
        clock=numbers[0],
        person=person,
        position=np.stack(numbers[1:], axis=1),
        lines=where,
        frames=True,
        unit="m",
        unit_fixed=False,
        format="trajnet++",
        details={"scenes": scenes, "predictions_left_out": len(tracks) - len(observed)},
    )
    told = {each.get("fps") for each in scenes if isinstance(each, dict)} - {None}
    if len(told) > 1:
        found = Shown(", ".join(str(each) for each in sorted(told, key=str)[:5]))
        raise document.error("frame_rate_contradicts_file", "have one fps in all scenes", found)
    if told:
        value = told.pop()
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < math.inf:
            raise document.error("unreadable_number", "have a positive fps in its scenes", short(str(value)), key="fps")
        step = common_step(rows)
        rate = float(value) * step if step else float(value)
        rows = replace(rows, rate=rate)
    return rows


def _entries(document: Document, lines: list[bytes], filled: list[int]) -> list[Any]:
    """Return the object of each line."""
    try:
        # All at once; where the lines are no objects the error is looked for.
        entries = json.loads(b"[" + b",".join(lines[place] for place in filled) + b"]", parse_constant=_constant)
        if len(entries) == len(filled) and all(isinstance(each, dict) for each in entries):
            return list(entries)
    except (ValueError, RecursionError):
        pass
    for place in filled:
        try:
            entry = json.loads(lines[place], parse_constant=_constant)
        except json.JSONDecodeError as error:
            raise _unreadable(document, error, place + 1) from None
        except (ValueError, RecursionError) as error:
            raise _unreadable(document, error, place + 1) from None
        if not isinstance(entry, dict):
            raise document.error("unreadable", "be an object of JSON", short(str(entry)), line=place + 1)
    raise document.error("unreadable", "hold one object of JSON in each line", Shown("others"))


def _mapping(document: Document, value: object, line: int) -> Mapping[str, Any]:
    if not isinstance(value, dict):
        raise document.error("unreadable", "have an object of JSON for track", short(str(value)), line=line)
    return value


def _key(document: Document, track: Mapping[str, Any], key: str, line: int) -> Any:
    if key not in track:
        raise document.error("unreadable", f"have the key {key} in each track", Shown("none"), line=line)
    return track[key]


def _numbers(document: Document, name: str, values: list[Any], lines: npt.NDArray[np.int64]) -> Array:
    """Return numbers of JSON, NaN for null."""
    plain = [math.nan if each is None else each for each in values]
    if all(type(each) in (int, float) for each in plain):
        try:
            found = np.array(plain, dtype=np.float64)
            if not np.isinf(found).any():
                return found
        except OverflowError:
            pass
    for value, line in zip(plain, lines.tolist(), strict=True):
        if type(value) not in (int, float) or (isinstance(value, int) and abs(value) > 2**1000) or math.isinf(value):
            raise document.error(
                "unreadable_number", "be a finite number", short(str(value)[:60]), line=line, key=f"key {name}"
            )
    raise document.error("unreadable_number", "be a finite number", Shown("others"), key=f"key {name}")


def _ids(document: Document, values: list[Any], lines: npt.NDArray[np.int64]) -> npt.NDArray[Any]:
    """Return ids of JSON: integers or words."""
    for value, line in zip(values, lines.tolist(), strict=True):
        good = (type(value) is int and abs(value) < 2**53) or (isinstance(value, str) and 0 < len(value) <= 200)
        if not good and not (type(value) is float and value.is_integer() and abs(value) < 2**53):
            rule = "name a person by an integer or a word"
            raise document.error("unreadable_number", rule, short(str(value)[:60]), line=line, key="id")
    if all(not isinstance(each, str) for each in values):
        return np.array([int(each) for each in values], dtype=np.int64)
    return np.array([str(each) for each in values], dtype=np.str_)


# ---- SocNavData ---------------------------------------------------------------------------------


def _read_socnav(document: Document, _request: Request) -> Rows:
    try:
        whole = json.loads(document.text, parse_constant=_constant)
    except (ValueError, RecursionError) as error:
        raise _unreadable(document, error) from None
    sequence = whole.get("sequence") if isinstance(whole, dict) else None
    if not isinstance(sequence, list):
        raise document.error("unreadable", "have a list", short(str(sequence)), key="sequence")
    for place, entry in enumerate(sequence):
        if not isinstance(entry, dict) or not isinstance(entry.get("people", []), list):
            raise document.error(
                "unreadable", "be an object with people", Shown(type(entry).__name__), key=f"sequence[{place}]"
            )
    time = _column(document, "timestamp", [(f"sequence[{place}]", each) for place, each in enumerate(sequence)])
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if len(back):
        rule = f"be later than {time[back[0]]:g}, that of the entry before"
        raise document.error("unreadable", rule, float(time[back[0] + 1]), key=f"sequence[{back[0] + 1}].timestamp")
    people = list(_people(document, sequence))
    index = np.array([place for place, _, _ in people], dtype=np.int64)
    entries = [(key, person) for _, key, person in people]
    ids = _ids(document, [person.get("id") for _, person in entries], np.zeros(len(entries), dtype=np.int64))
    position = np.stack([_column(document, axis, entries, absent=True) for axis in "xy"], axis=1).reshape(-1, 2)
    origin = float(time[index[0]]) if len(index) else 0.0
    details: dict[str, Any] = {"absent": _absent(index, ids, time - origin)}
    goal = sequence[0].get("goal") if sequence else None
    if isinstance(goal, dict) and "x" in goal:
        details["goal"] = tuple(float(_column(document, axis, [("sequence[0].goal", goal)])[0]) for axis in "xy")
    if isinstance(whole.get("grid"), dict):
        details["grid"] = whole["grid"]
    if sequence and isinstance(sequence[0].get("objects"), list):
        details["objects"] = sequence[0]["objects"]
    return Rows(
        clock=time[index],
        person=ids,
        position=position,
        frames=False,
        unit="m",
        format="socnavdata",
        walls=_walls(document, whole.get("walls", [])),
        robot=_robot(document, sequence, time - origin),
        details=details,
    )


def _people(document: Document, sequence: list[Any]) -> Iterator[tuple[int, str, Mapping[str, Any]]]:
    for place, entry in enumerate(sequence):
        for number, person in enumerate(entry.get("people", [])):
            key = f"sequence[{place}].people[{number}]"
            if not isinstance(person, dict):
                raise document.error("unreadable", "be an object", short(str(person)), key=key)
            yield place, key, person


def _column(
    document: Document, name: str, entries: list[tuple[str, Mapping[str, Any]]], *, absent: bool = False
) -> Array:
    """Return a number of each object; ``absent``: NaN and null say that it is unknown."""
    found = np.empty(len(entries))
    for place, (key, entry) in enumerate(entries):
        value = entry.get(name)
        if absent and name in entry and (value is None or value != value):
            value = math.nan
        elif type(value) not in (int, float) or not abs(value) < 1e300:  # type: ignore[arg-type]  # a number
            shown = Shown("none") if value is None else short(str(value)[:60])
            raise document.error("unreadable_number", "be a finite number", shown, key=f"{key}.{name}")
        found[place] = value
    return found


def _absent(index: npt.NDArray[np.int64], ids: npt.NDArray[Any], time: Array) -> list[tuple[Any, float, float]]:
    """Return who is not listed from which to which instant."""
    found = []
    for who in np.unique(ids).tolist():
        away = np.ones(len(time), dtype=np.bool_)
        away[index[ids == who]] = False
        edges = np.flatnonzero(np.diff(np.concatenate([[0], away.astype(np.int8), [0]])))
        found += [(who, float(time[a]), float(time[b - 1])) for a, b in edges.reshape(-1, 2).tolist()]
    return found


def _walls(document: Document, walls: object) -> tuple[Array, ...]:
    if not isinstance(walls, list):
        raise document.error("unreadable", "be a list of x1, y1, x2, y2", short(str(walls)), key="walls")
    found = []
    for place, wall in enumerate(walls):
        if not isinstance(wall, list) or len(wall) != 4 or not all(type(each) in (int, float) for each in wall):
            raise document.error("unreadable_number", "be x1, y1, x2, y2", short(str(wall)), key=f"walls[{place}]")
        if not all(abs(each) < 1e300 for each in wall):
            raise document.error("unreadable_number", "be finite", short(str(wall)), key=f"walls[{place}]")
        found.append(np.array(wall, dtype=np.float64).reshape(2, 2))
    return tuple(found)


def _robot(document: Document, sequence: list[Any], time: Array) -> RecordedRobot | None:
    seen = [(place, entry["robot"]) for place, entry in enumerate(sequence) if isinstance(entry.get("robot"), dict)]
    if not seen:
        return None
    entries = [(f"sequence[{place}].robot", robot) for place, robot in seen]
    shape = seen[0][1].get("shape")
    return RecordedRobot(
        time_s=time[[place for place, _ in seen]],
        position=np.stack([_column(document, axis, entries) for axis in "xy"], axis=1),
        heading=_column(document, "angle", entries),
        shape=shape if isinstance(shape, dict) else None,
    )


READERS = [
    Reader(
        name="trajnet++",
        title="TrajNet++: JSON lines of scenes and tracks",
        recognizes=_is_trajnetpp,
        read=_read_trajnetpp,
    ),
    Reader(
        name="socnavdata",
        title="SocNavData: JSON with sequence, people, robot, walls",
        recognizes=_is_socnav,
        read=_read_socnav,
    ),
]
