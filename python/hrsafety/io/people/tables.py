"""Tables with a header: any names of columns that are known, CITR and DUT."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety.errors import FileError, Shown
from hrsafety.io.cells import Cell, Columns, read_columns
from hrsafety.io.headers import DELIMITERS, LENGTHS, TIMES, Header, header_of
from hrsafety.io.people.request import Request
from hrsafety.io.people.rows import Rows
from hrsafety.io.reader import Document, Reader
from hrsafety.plausibility import ResultWarning

__all__ = ["READERS", "ROLES", "of_classes", "read_table"]

Array = npt.NDArray[np.float64]

_PEOPLE = ("ped", "pedestrian", "person", "agent", "track", "trajectory", "object", "obj", "human", "subject", "people")
ROLES = {
    "time": ("t", "time", "zeit", "timestamp", "timestamps", "timestep", "seconds", "sec", "elapsed", "unixtime"),
    "frame": ("frame", "frames", "frameid", "framenumber", "frameno", "framenr", "frameindex", "fr", "bild", "f"),
    "id": (
        *("id", "ids", "pid", "persid", "nummer", "personennummer", "name", *_PEOPLE),
        *(f"{each}{more}" for each in _PEOPLE for more in ("id", "ids", "no", "nr", "number", "index", "s")),
    ),
    "x": ("x", "posx", "xpos", "positionx", "xposition", "xcoord", "xcoordinate", "px", "xest", "centerx", "xcenter"),
    "y": ("y", "posy", "ypos", "positiony", "yposition", "ycoord", "ycoordinate", "py", "yest", "centery", "ycenter"),
    "vx": ("vx", "velx", "xvel", "velocityx", "xvelocity", "vxest"),
    "vy": ("vy", "vely", "yvel", "velocityy", "yvelocity", "vyest"),
    "lat": ("lat", "latitude", "breite"),
    "lon": ("lon", "lng", "long", "longitude", "laenge"),
    "label": ("label", "type", "class", "category", "agenttype", "objecttype"),
}
_CITR = ({"id", "frame", "label", "x_est", "y_est"}, {"frame", "id", "x", "y", "type"})
CLASS_NAMES = {"ped": "pedestrian", "peds": "pedestrian"}


def _names(document: Document) -> set[str]:
    header = header_of(document, {})
    return set() if header is None else {name.lower() for name in header.names}


def _is_citr(document: Document) -> bool:
    names = _names(document)
    return any(each <= names for each in _CITR) and names <= _CITR[0] | _CITR[1] | {"vx_est", "vy_est"}


def _is_table(document: Document) -> bool:
    header = header_of(document, {})
    return header is not None and len(header.names) > 1


def of_classes(
    labels: npt.NDArray[Any], request: Request, document: Document
) -> tuple[npt.NDArray[np.bool_], list[ResultWarning], dict[str, Any]]:
    """Return which rows are of the classes that are asked for, a warning about the others, and their counts."""
    wanted = {CLASS_NAMES.get(each.lower(), each.lower()) for each in request.classes}
    different, index = np.unique(labels, return_inverse=True)
    known = np.array(
        [CLASS_NAMES.get(each.lower(), each.lower()) in wanted for each in different.tolist()], dtype=np.bool_
    )
    kept = known[index.ravel()] if len(different) else np.zeros(0, dtype=np.bool_)
    if kept.all():
        return kept, [], {}
    counts = np.bincount(index.ravel(), minlength=len(different))
    others = {str(different[place]): int(counts[place]) for place in np.flatnonzero(~known)}
    if not kept.any():
        rule = f"hold rows of {', '.join(request.classes)}"
        raise document.error("no_rows", rule, Shown(f"rows of {', '.join(others)}"), "name the classes with classes=")
    words = ", ".join(f"{count} rows of {name}" for name, count in others.items())
    message = f"{document.name} has {words}, which are left out: classes= takes them as people, too"
    return kept, [ResultWarning("other_classes", "classes", message)], {"other_classes": others}


def read_table(document: Document, request: Request) -> Rows:
    """Return the rows of a table with a header."""
    header = header_of(document, ROLES, request.columns)
    if header is None:
        raise document.error(
            "ambiguous_columns", "have a header", Shown("numbers"), 'name the columns, columns="id frame x y"'
        )
    return rows_of(document, request, header, form="table")


def _read_citr(document: Document, request: Request) -> Rows:
    header = header_of(document, ROLES, request.columns)
    assert header is not None, "a header was recognized"
    if "label" not in header.place:
        raise _missing(document, header, ["label"])
    return rows_of(document, request, header, form="citr", unit="m")


def rows_of(document: Document, request: Request, header: Header, *, form: str, unit: str = "") -> Rows:
    """Return the rows of a table whose columns are known; ``unit``: of positions in all files of a format."""
    index, units = header.place, header.unit
    clock = "time" if "time" in index else "frame"
    missing = [each for each in (clock, "id", "x", "y") if each not in index]
    if {"x", "y"} & set(missing) and {"lat", "lon"} & set(index):
        found = Shown("latitude and longitude" if {"lat", "lon"} <= set(index) else "a latitude or longitude")
        remedy = "project them to meters first, for example to UTM"
        raise document.error("not_metric", "have positions in a plane, x and y", found, remedy, line=header.skip)
    if missing:
        raise _missing(document, header, missing)
    length = _unit_of_positions(document, header) or unit
    second = _unit_of_time(document, units[clock]) if clock == "time" else 1.0
    wanted = [clock, "x", "y", *(["vx", "vy"] if {"vx", "vy"} <= set(index) else [])]
    wanted += ["frame"] if clock == "time" and "frame" in index else []
    labeled = form == "citr"
    table = read_columns(
        document,
        delimiter=header.delimiter,
        skip=header.skip,
        columns=len(header.names),
        numbers=[Cell(index[each], header.names[index[each]]) for each in wanted],
        ids=Cell(index["id"], header.names[index["id"]]),
        words=[Cell(index["label"], "label")] if labeled else [],
    )
    notes: list[ResultWarning] = []
    details: dict[str, Any] = {"delimiter": DELIMITERS[header.delimiter], "decimal": table.decimal}
    which = np.ones(len(table.ids), dtype=np.bool_)
    if labeled:
        which, notes, counts = of_classes(table.words[:, 0], request, document)
        details |= counts
    velocity = table.numbers[which, 3:5] if "vx" in wanted else None
    if velocity is not None and not _same_units(units, length):
        velocity = None
    time, frames, rate = _clock(document, request, wanted, table, which, second)
    return Rows(
        clock=time,
        person=table.ids[which],
        position=table.numbers[which, 1:3],
        velocity=velocity,
        lines=table.lines[which],
        frames=frames,
        rate=rate,
        rate_from_velocity=form == "citr",
        unit=length,
        unit_guess=not length,
        format=form,
        notes=tuple(notes),
        details=details,
    )


def _clock(
    document: Document,
    request: Request,
    wanted: list[str],
    table: Columns,
    which: npt.NDArray[np.bool_],
    second: float,
) -> tuple[Array, bool, float | None]:
    """Return the clock of rows, whether it counts frames, and the frames per second if the file tells them."""
    clock = table.numbers[which, 0]
    asked = request.fps is not None or request.step_s is not None
    if wanted[0] == "frame":
        return clock, True, None
    time = clock * second if second != 1.0 else clock
    if not asked:
        return time, False, _rate_of_frames(table.numbers[which, -1], time) if wanted[-1] == "frame" else None
    if wanted[-1] == "frame":
        frames = table.numbers[which, -1]
        rate = _rate_of_frames(frames, time)
        if rate is not None and not np.array_equal(frames, clock):
            return frames, True, rate
        return frames, True, None
    whole = np.isfinite(clock) & (clock != np.floor(clock))
    if whole.any():
        row = int(np.flatnonzero(whole)[0])
        name = "fps" if request.fps is not None else "step_s"
        found = Shown(f"times in seconds, {clock[row]:g}")
        line = int(table.lines[which][row])
        raise document.error(
            "frame_rate_contradicts_file", f"hold frames where {name} is given", found, f"leave out {name}", line=line
        )
    return clock, True, None


def _rate_of_frames(frames: Array, time: Array) -> float | None:
    """Return the frames per second of a file that has both, if all rows agree on it."""
    span = np.ptp(time) if len(time) else 0.0
    if not span > 0.0 or not np.isfinite(span):
        return None
    rate = float(np.ptp(frames) / span)
    if not rate > 0.0 or not np.isfinite(rate):
        return None
    off = np.abs((frames - frames.min()) / rate - (time - time.min()))
    near = float(round(rate)) if round(rate) > 0 and abs(round(rate) / rate - 1.0) < 1e-4 else rate
    return near if bool((off <= 0.5 / rate).all()) else None


def _unit_of_positions(document: Document, header: Header) -> str:
    x, y = header.unit["x"], header.unit["y"]
    if x != y:
        raise document.error(
            "unit_needed", "have one unit of x and y", Shown(f"{x or 'none'} and {y or 'none'}"), line=header.skip
        )
    if x and x not in LENGTHS and x != "px":
        if x in {"deg", "rad", "°"}:
            raise document.error("not_metric", "have positions in a plane", Shown(f"x in {x}"), line=header.skip)
        rule = f"have positions in one of {', '.join(LENGTHS)}"
        raise document.error("unit_needed", rule, x, "convert them, or rename the column", line=header.skip)
    return x


def _unit_of_time(document: Document, unit: str) -> float:
    if unit and unit not in TIMES:
        raise document.error("unit_needed", f"have times in one of {', '.join(TIMES)}", unit, "rename the column")
    return TIMES[unit or "s"]


def _same_units(units: dict[str, str], length: str) -> bool:
    """Return whether velocities are in the unit of positions per second, which is taken if they have none."""
    return all(units[each] in {"", f"{length or 'm'}/s"} for each in ("vx", "vy"))


def _missing(document: Document, header: Header, missing: list[str]) -> FileError:
    """Return the error about columns that were not found."""
    words = {"frame": "a time or a frame", "id": "an id", "x": "x", "y": "y", "label": "a label"}
    rule = f"have a column for {' and '.join(words[each] for each in missing)}"
    listed = ", ".join(header.names[:12])
    found = Shown(f"the columns {listed}" if len(listed) < 200 else f"{len(header.names)} other columns")
    remedy = 'name them with columns=, as in columns={"number": "id"}'
    return document.error("ambiguous_columns", rule, found, remedy, line=header.skip)


READERS = [
    Reader(
        name="citr",
        title="CITR, DUT: id, frame, label, x_est, y_est, or frame, id, x, y, type",
        recognizes=_is_citr,
        read=_read_citr,
    ),
    Reader(name="table", title="any table with a header", recognizes=_is_table, read=read_table),
]
