"""Poses of a robot in text files: TUM, EuRoC, tables of odometry."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety.errors import Shown
from hrsafety.io.cells import TableColumn, read_columns
from hrsafety.io.headers import cells_of, delimiter_of, first_row, is_number
from hrsafety.io.logs.frames import rotations, unit_quaternions, yaw_of
from hrsafety.io.reader import Document
from hrsafety.plausibility import ResultWarning

__all__ = ["PoseTable", "form_of", "read_poses"]

_WORDS: Mapping[str, tuple[str, ...]] = {
    "time": ("t", "time", "timestamp", "stamp", "zeit", "sec", "secs"),
    "x": ("x", "tx", "px", "pos_x", "position_x", "pose_x", "x_pos", "p_rs_r_x"),
    "y": ("y", "ty", "py", "pos_y", "position_y", "pose_y", "y_pos", "p_rs_r_y"),
    "yaw": ("yaw", "theta", "heading", "psi", "phi", "orientation", "angle"),
    "v": ("v", "vx", "speed", "velocity", "v_x", "linear", "linear_x", "linear_velocity"),
    **{f"q{axis}": (f"q{axis}", f"q_{axis}", f"orientation_{axis}", f"q_rs_{axis}") for axis in "xyzw"},
    "yaw_rate": ("yaw_rate", "yawrate", "w", "omega", "wz", "angular", "angular_z", "turn_rate", "angular_velocity"),
}
_UNITS: Mapping[str, Mapping[str, float]] = {
    "time": {"s": 1.0, "sec": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9},
    "x": {"m": 1.0, "cm": 1e-2, "mm": 1e-3},
    "yaw": {"rad": 1.0, "deg": np.pi / 180.0},
    "v": {"m_s": 1.0, "mps": 1.0, "cm_s": 1e-2, "mm_s": 1e-3, "km_h": 1.0 / 3.6, "kmh": 1.0 / 3.6},
    "yaw_rate": {"rad_s": 1.0, "radps": 1.0, "deg_s": np.pi / 180.0, "degps": np.pi / 180.0},
}


class PoseTable(NamedTuple):
    """Rows of a file in their order.

    Attributes
    ----------
    form : str
        Name of the format.
    instants : ndarray of int, shape (n,)
        Times in ns.
    position, heading, twist : ndarray
        In m, rad, and m/s, m/s, rad/s with NaN where nothing is stored.
    lines : ndarray of int, shape (n,)
        Numbers of the lines.
    time_column : str
        How the column of times is called.
    warnings : tuple of ResultWarning
        What was assumed or left out.
    """

    form: str
    instants: npt.NDArray[np.int64]
    position: Array
    heading: Array
    twist: Array
    lines: npt.NDArray[np.int64]
    time_column: str
    warnings: tuple[ResultWarning, ...]


def form_of(document: Document) -> str | None:
    """Return which of the formats a text file has: ``"tum"``, ``"euroc"``, ``"odometry"``, or none of them."""
    _, row = first_row(document)
    if not row:
        raise document.error("no_rows", "hold poses", Shown("no row"))
    delimiter = delimiter_of(row)
    cells = cells_of(row, delimiter)
    if not is_number(cells[0]):
        return "odometry" if any(_meaning(each)[0] for each in cells) else None
    if len(cells) < 8:
        return None
    named = any("ns" in each for each in document.first_lines if each.startswith("#"))
    whole = delimiter != " " and cells[0].lstrip("-").isdigit()
    return "euroc" if whole and (named or len(cells[0]) > 11) else "tum"


def read_poses(document: Document, form: str) -> PoseTable:
    """Return the poses of a text file of a format.

    Raises
    ------
    FileError
        If it breaks the rules of the format.
    """
    if form == "odometry":
        return _odometry(document)
    return _with_quaternions(document, euroc=form == "euroc")


def _with_quaternions(document: Document, *, euroc: bool) -> PoseTable:
    _, row = first_row(document)
    delimiter = delimiter_of(row)
    columns = max(len(cells_of(row, delimiter)), 8)
    order = ["qw", "qx", "qy", "qz"] if euroc else ["qx", "qy", "qz", "qw"]
    numbers = [TableColumn(index, name) for index, name in enumerate(["time", "x", "y", "z", *order])]
    ids = TableColumn(0, "time") if euroc else None
    found = read_columns(document, delimiter=delimiter, numbers=numbers, ids=ids, columns=columns)
    table, lines = found.numbers, found.lines
    if euroc:
        table = table[:, [0, 1, 2, 3, 5, 6, 7, 4]]
        try:  # exactly: floating-point numbers end at 2**53
            instants = found.ids.astype(np.int64)
        except (ValueError, OverflowError):
            raise document.error("unreadable_number", "hold whole nanoseconds", Shown("others"), key="time") from None
    else:
        instants = _in_ns(document, lines, table[:, 0], 1.0)
    quaternion = unit_quaternions(table[:, 4:], document.name, (f"line {each}" for each in lines.tolist()))
    return _kept(
        document,
        "euroc" if euroc else "tum",
        (instants, table[:, 1:3], yaw_of(rotations(quaternion)), np.full((len(table), 3), np.nan)),
        (lines, np.asarray(np.isfinite(table).all(axis=1))),
        time_column="timestamp",
        told=(),
    )


def _in_ns(document: Document, lines: Any, time: Array, scale: float) -> npt.NDArray[np.int64]:
    """Return times in ns, or refuse those that no clock has."""
    with np.errstate(over="ignore"):
        found = np.where(np.isfinite(time), time, 0.0) * (1e9 * scale)
    wrong = ~(np.abs(found) < 2**62)
    if wrong.any():
        row = int(np.argmax(wrong))
        remedy = "name the unit in the name of the column: t_ns"
        line = int(lines[row])
        raise document.error("unreadable_number", "be a time in s", float(time[row]), remedy, line=line, key="time")
    return np.asarray(np.rint(found).astype(np.int64))


def _kept(
    document: Document,
    form: str,
    columns: tuple[npt.NDArray[np.int64], Array, Array, Array],
    rows: tuple[npt.NDArray[np.int64], npt.NDArray[np.bool_]],
    *,
    time_column: str,
    told: Sequence[ResultWarning],
) -> PoseTable:
    lines, whole = rows
    if not whole.any():
        raise document.error("no_rows", "hold poses", Shown("no row with numbers in all columns"))
    if not whole.all():
        missing = int((~whole).sum())
        message = f"{missing} of {len(whole)} poses are not finite and left out: the robot has no pose then"
        told = (*told, ResultWarning("missing_positions", "position", message))
    instants, position, heading, twist = columns
    kept = (instants[whole], position[whole], heading[whole], twist[whole], lines[whole])
    return PoseTable(form, *kept, time_column, tuple(told))


# ---- tables of odometry -------------------------------------------------------------------------------------


def _odometry(document: Document) -> PoseTable:
    number, header = first_row(document)
    delimiter = delimiter_of(header)
    titles = cells_of(header, delimiter)
    found: dict[str, tuple[int, str, float | None]] = {}
    for index, title in enumerate(titles):
        quantity, scale = _meaning(title)
        if quantity:
            if quantity in found:
                shown = Shown(f"{found[quantity][1]} and {title}")
                raise document.error("ambiguous_columns", f"have one column of {quantity}", shown, line=number + 1)
            found[quantity] = (index, title, scale)
    missing = [name for name in ("time", "x", "y") if name not in found]
    if missing:
        rule = "have columns of time, x and y (and yaw), such as t_s,x_m,y_m,yaw_rad"
        raise document.error("columns_needed", rule, Shown(", ".join(titles)[:200]), line=number + 1)
    names = list(found)
    numbers = [TableColumn(index, title) for index, title, _ in found.values()]
    read = read_columns(document, delimiter=delimiter, numbers=numbers, skip=number + 1, columns=len(titles))
    table, lines_of = read.numbers, read.lines
    if len(table) == 0:
        raise document.error("no_rows", "hold poses", Shown("a header only"))
    assumed = {"time": "s", "x": "m", "y": "m", "yaw": "rad", "v": "m/s", "yaw_rate": "rad/s"}
    unclear = [f"{found[name][1]} in {unit}" for name, unit in assumed.items() if name in found and not found[name][2]]
    told = []
    if unclear:
        message = f"units are taken as {', '.join(unclear)}: name them in the header, as t_s,x_m,y_m,yaw_rad does"
        told.append(ResultWarning("assumed", "columns", message))
    values = {name: table[:, index] * (found[name][2] or 1.0) for index, name in enumerate(names) if name != "time"}
    instants = _in_ns(document, lines_of, table[:, names.index("time")], found["time"][2] or 1.0)
    position = np.stack([values["x"], values["y"]], axis=1)
    yaw = values.get("yaw")
    if yaw is None and {"qx", "qy", "qz", "qw"} <= set(values):
        quaternion = np.stack([values[f"q{axis}"] for axis in "xyzw"], axis=1)
        places = (f"line {each}" for each in lines_of.tolist())
        yaw = yaw_of(rotations(unit_quaternions(quaternion, document.name, places)))
    heading, more = _heading(yaw, position, instants)
    nothing = np.full(len(position), np.nan)
    ahead = values.get("v", nothing)
    twist = [ahead, 0.0 * ahead, values.get("yaw_rate", nothing)]
    whole = np.isfinite(table[:, names.index("time")]) & np.isfinite(position).all(axis=1) & np.isfinite(heading)
    columns = (instants, position, heading, np.stack(twist, axis=1))
    return _kept(document, "odometry", columns, (lines_of, whole), time_column=found["time"][1], told=[*told, *more])


def _meaning(title: str) -> tuple[str, float | None]:
    """Return the quantity of a column and the size of its unit, None without one; empty words for what is not used."""
    plain = re.sub(r"[\s_\[\]()/.-]+", "_", title.lower()).strip("_").replace("_in_", "_")
    for quantity, words in _WORDS.items():
        units = _UNITS.get("x" if quantity == "y" else quantity, {})
        for word in words:
            if plain == word:
                return quantity, None
            unit = plain.removeprefix(f"{word}_")
            if unit != plain and unit in units:
                return quantity, units[unit]
    return "", None


def _heading(yaw: Array | None, position: Array, instants: Any) -> tuple[Array, tuple[ResultWarning, ...]]:
    """Return the headings, those of the way where the file has none."""
    if yaw is not None:
        return yaw, ()
    order = np.argsort(instants, kind="stable")
    ways = np.diff(position[order], axis=0)
    angle = np.arctan2(ways[:, 1], ways[:, 0])
    moves = np.hypot(*ways.T) > 1e-9
    last = np.maximum.accumulate(np.where(moves, np.arange(len(moves)), -1)) if len(moves) else np.empty(0, dtype=int)
    first = int(np.argmax(moves)) if moves.any() else 0
    along = np.where(last >= 0, angle[np.maximum(last, 0)], angle[first] if moves.any() else 0.0)
    found = np.zeros(len(position))
    found[order] = np.append(along[:1], along) if len(along) else 0.0
    message = "there is no column of yaw: the robot is taken to look where it goes, and never to drive backward"
    return found, (ResultWarning("assumed", "yaw", message),)
