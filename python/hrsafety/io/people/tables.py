"""Tables with a header: any names of columns that are known, CITR and DUT."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety.errors import FileError, Shown
from hrsafety.io.cells import TableColumn, read_columns
from hrsafety.io.headers import DELIMITERS, LENGTHS, TIMES, Header, header_of
from hrsafety.io.people.request import Request
from hrsafety.io.people.rows import Rows, assumed, lost_rows
from hrsafety.io.reader import Document, Reader
from hrsafety.plausibility import ResultWarning

__all__ = ["READERS", "ROLES", "PeopleColumns", "of_classes", "rows_of", "table_columns"]

Array = npt.NDArray[np.float64]

_PEOPLE = ("ped", "pedestrian", "person", "agent", "track", "trajectory", "object", "obj", "human", "subject", "people")
ROLES = {
    "time": ("t", "time", "zeit", "timestamp", "timestamps", "timestep", "seconds", "sec", "elapsed", "unixtime"),
    "frame": ("frame", "frames", "frameid", "framenumber", "frameno", "framenr", "frameindex", "fr", "bild", "f"),
    "id": (
        *("id", "ids", "pid", "persid", "nummer", "personennummer", "name", *_PEOPLE),
        *(f"{each}{more}" for each in _PEOPLE for more in ("id", "ids", "no", "nr", "number", "index", "s")),
    ),
    "x": (
        "x",
        "posx",
        "xpos",
        "positionx",
        "xposition",
        "xcoord",
        "xcoordinate",
        "px",
        "xest",
        "centerx",
        "xcenter",
        "easting",
        "east",
        "utmx",
    ),
    "y": (
        "y",
        "posy",
        "ypos",
        "positiony",
        "yposition",
        "ycoord",
        "ycoordinate",
        "py",
        "yest",
        "centery",
        "ycenter",
        "northing",
        "north",
        "utmy",
    ),
    "vx": ("vx", "velx", "xvel", "velocityx", "xvelocity", "vxest"),
    "vy": ("vy", "vely", "yvel", "velocityy", "yvelocity", "vyest"),
    "lat": ("lat", "latitude", "breite"),
    "lon": ("lon", "lng", "long", "longitude", "laenge"),
    "label": ("label", "type", "class", "category", "agenttype", "objecttype"),
    "z": ("z", "posz", "zpos", "positionz", "zposition", "pz", "zest"),
    "width": ("w", "width", "boxwidth", "bbwidth", "bboxwidth"),
    "height": ("h", "height", "boxheight", "bbheight", "bboxheight"),
    "lost": ("lost", "islost", "missing", "ismissing", "outofview", "outofsight"),
    "occluded": ("occluded", "isoccluded", "hidden", "ishidden"),
    "predicted": ("predicted", "ispredicted", "interpolated", "isinterpolated", "extrapolated", "isextrapolated"),
    "seen": ("seen", "isseen", "visible", "isvisible", "detected", "isdetected", "valid", "isvalid"),
}
UNSEEN = ("lost", "occluded", "predicted", "seen")
"""Roles of columns that tell in which rows nobody was seen; ``seen`` tells the contrary."""
_FLAGS = {
    **dict.fromkeys(("1", "1.0", "true", "t", "yes", "y"), True),
    **dict.fromkeys(("0", "0.0", "false", "f", "no", "n"), False),
}
LEAST_RISE = 1.0
"""A coordinate that varies by less, in m or another unit of the file, may be a height."""
FLAT = 0.25
"""A coordinate in the plane varies by less than this share of z where z is no height."""
_CITR = ({"id", "frame", "label", "x_est", "y_est"}, {"frame", "id", "x", "y", "type"})
CLASS_NAMES = dict.fromkeys(("ped", "peds", "pedestrians", "person", "people", "human"), "pedestrian")
_OTHERS = {
    "car",
    "cars",
    "veh",
    "vehicle",
    "cart",
    "truck",
    "bus",
    "van",
    "robot",
    "bicycle",
    "bike",
    "biker",
    "cyclist",
}
"""Road users by whose name a column of a table is known to tell classes."""


def _names(document: Document) -> set[str]:
    header = header_of(document, {})
    return set() if header is None else {name.lower() for name in header.names}


def _is_citr(document: Document) -> bool:
    names = _names(document)
    return _CITR[0] <= names or names == _CITR[1]


def _is_table(document: Document) -> bool:
    header = header_of(document, ROLES)
    return header is not None and len(header.names) > 1 and header.names[0][:1] not in {"{", "["}


def _class(label: str) -> str:
    """Return the name of a class in small letters."""
    return CLASS_NAMES.get(label.strip().lower(), label.strip().lower())


def of_classes(
    labels: npt.NDArray[Any], request: Request, document: Document
) -> tuple[npt.NDArray[np.bool_], list[ResultWarning], dict[str, Any]]:
    """Return which rows are of the classes that are asked for, a warning about the others, and their counts."""
    wanted = {_class(each) for each in request.classes}
    different, index = np.unique(labels, return_inverse=True)
    known = np.array([_class(each) in wanted for each in different.tolist()], dtype=np.bool_)
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


def _read_table(document: Document, request: Request) -> Rows:
    return rows_of(document, request, form="table")


def _read_citr(document: Document, request: Request) -> Rows:
    return rows_of(document, request, form="citr", unit="m")


class PeopleColumns(NamedTuple):
    """Columns of a table by their meaning, in the units of the file.

    Attributes
    ----------
    clock, frame : ndarray, shape (n,)
        Times, or frames where there are none; frames, if there are both.
    clock_name : str
        Name of the first column.
    second : float
        Unit of times in s.
    frames : bool
        Whether the clock counts frames.
    person, position, velocity, label, lines : ndarray
        As in `Rows`; ``label`` holds words.
    unit : str
        Of positions; empty if the header names none.
    details : dict of str to object
        Delimiter and sign of decimals.
    unseen : ndarray of bool, shape (n,)
        Rows that the file marks as lost, occluded or predicted.
    notes : list of ResultWarning
        Doubts about what x and y are.
    """

    clock: Array
    frame: Array | None
    clock_name: str
    second: float
    frames: bool
    person: npt.NDArray[Any]
    position: Array
    velocity: Array | None
    label: npt.NDArray[np.str_] | None
    lines: npt.NDArray[np.int64]
    unit: str
    details: dict[str, Any]
    unseen: npt.NDArray[np.bool_]
    notes: list[ResultWarning]


def table_columns(
    document: Document, columns: object = None, *, labeled: bool = False, single: bool = False
) -> PeopleColumns:
    """Return the columns of a table by their meaning.

    Parameters
    ----------
    document : Document
        The file.
    columns : object
        Other names of its columns, see `load_people`.
    labeled : bool
        Whether there must be a column of classes.
    single : bool
        Whether there are no ids.

    Raises
    ------
    FileError
        If a column is missing or a cell is no number.
    """
    header = header_of(document, ROLES, columns)
    if header is None:
        remedy = "write t_s,x_m,y_m above it" if single else 'name the columns, columns="id frame x y"'
        raise document.error("ambiguous_columns", "have a header", Shown("numbers"), remedy, line=1)
    place, units = header.place, header.unit
    clock = "time" if "time" in place else "frame"
    needed = (clock, *(() if single else ("id",)), "x", "y", *(("label",) if labeled else ()))
    missing = [each for each in needed if each not in place]
    if {"x", "y"} & set(missing) and {"lat", "lon"} & set(place):
        found = Shown("latitude and longitude" if {"lat", "lon"} <= set(place) else "a latitude or longitude")
        remedy = "project them to meters first, for example to UTM"
        raise document.error("not_metric", "have positions in a plane, x and y", found, remedy, line=header.skip)
    if missing:
        raise _missing(document, header, missing)
    unit = _unit_of_positions(document, header)
    moving = {"vx", "vy"} <= set(place) and _same_units(units, unit)
    both = clock == "time" and "frame" in place
    more = [each for each in ("z",) if each in place]
    wanted = [clock, "x", "y", *(["vx", "vy"] if moving else []), *more, *(["frame"] if both else [])]
    marks = [each for each in UNSEEN if each in place]
    table = read_columns(
        document,
        delimiter=header.delimiter,
        skip=header.skip,
        columns=len(header.names),
        comments=header.delimiter == " ",  # elsewhere an id may begin like a comment
        numbers=[TableColumn(place[each], header.names[place[each]]) for each in wanted],
        ids=None if single else TableColumn(place["id"], header.names[place["id"]]),
        words=[TableColumn(place[each], each) for each in (*marks, "label") if each in place],
    )
    marked = [_marked(name, table.words[:, index]) for index, name in enumerate(marks)]
    unread = [header.names[place[name]] for name, rows in zip(marks, marked, strict=True) if rows is None]
    return PeopleColumns(
        clock=table.numbers[:, 0],
        frame=table.numbers[:, -1] if both else None,
        clock_name=header.names[place[clock]],
        second=_unit_of_time(document, units[clock]) if clock == "time" else 1.0,
        frames=clock == "frame",
        person=table.ids,
        position=table.numbers[:, 1:3],
        velocity=table.numbers[:, 3:5] if moving else None,
        label=table.words[:, -1] if "label" in place and (labeled or _tells_classes(table.words[:, -1])) else None,
        lines=table.lines,
        unit=unit,
        details={"delimiter": DELIMITERS[header.delimiter], "decimal": table.decimal},
        unseen=np.any(
            [np.zeros(len(table.lines), dtype=np.bool_), *(each for each in marked if each is not None)], axis=0
        ),
        notes=[
            *(_of_marks(document, name) for name in unread),
            *_of_boxes(document, header),
            *(_of_height(document, header, table.numbers[:, [1, 2, 5 if moving else 3]]) if more else ()),
        ],
    )


def _marked(role: str, cells: npt.NDArray[np.str_]) -> npt.NDArray[np.bool_] | None:
    """Return in which rows a column says that nobody was seen; ``None`` if it holds anything but true and false."""
    different, index = np.unique(cells, return_inverse=True)
    flags = [_FLAGS.get(each.strip().lower()) for each in different.tolist()]
    if None in flags:
        return None
    said = np.array(flags, dtype=np.bool_)[index.ravel()] if len(flags) else np.zeros(0, dtype=np.bool_)
    return ~said if role == "seen" else said


def _of_marks(document: Document, name: str) -> ResultWarning:
    """Return the doubt about a column that may mark rows in which nobody was seen, in words that are not known."""
    return assumed(
        "position",
        f"{name} of {document.name} holds more than true and false (1 and 0, yes and no): all rows count as sights; "
        f'write which are, or leave the column out, as columns={{"{name}": "-"}} does',
    )


def _of_boxes(document: Document, header: Header) -> Iterator[ResultWarning]:
    """Yield the doubt that x and y are those of the corner of a box."""
    if {"width", "height"} <= set(header.place) and "center" not in header.names[header.place["x"]].lower():
        yield assumed(
            "position",
            f"{document.name} has widths and heights of boxes: x and y are taken as where people stand, and are often "
            "the corner of a box; write the middle of its lower side, or leave the sizes out, as "
            f'columns={{"{header.names[header.place["width"]]}": "-"}} does',
        )


def _of_height(document: Document, header: Header, place: Array) -> Iterator[ResultWarning]:
    """Yield the doubt that one of x and y is the height, from x, y and z of all rows."""
    place = place[np.isfinite(place).all(axis=1)]
    if not len(place):
        return
    x, y, z = np.ptp(place, axis=0).tolist()
    if z > LEAST_RISE and min(x, y) < FLAT * z:
        least = "x" if x < y else "y"
        name, up = header.names[header.place[least]], header.names[header.place["z"]]
        message = (
            f"{up} of {document.name} varies by {z:.3g} and {name} by {min(x, y):.3g} only: {name} looks like the "
            f"height, and {up} like a coordinate in the plane; exchange them, as "
            f'columns={{"{name}": "{up}", "{up}": "{name}"}} does'
        )
        yield ResultWarning("implausible", "position", message)


def rows_of(document: Document, request: Request, *, form: str, unit: str = "", guess: bool = True) -> Rows:
    """Return the rows of a table.

    Parameters
    ----------
    document : Document
        The file.
    request : Request
        What the caller says.
    form : str
        Name of the format.
    unit : str
        Of positions in all files of the format; empty if the header names it.
    guess : bool
        Whether meters are assumed where nothing names a unit.
    """
    labeled = form == "citr"
    table = table_columns(document, request.columns, labeled=labeled)
    which, details = np.ones(len(table.clock), dtype=np.bool_), table.details
    notes = table.notes
    if table.label is not None:
        which, others, counts = of_classes(table.label, request, document)
        notes, details = [*others, *notes], details | counts
    lost = which & table.unseen
    if lost.any():
        notes, details = (
            [lost_rows(document, lost, table.lines, table.person), *notes],
            details | {"lost_rows": int(lost.sum())},
        )
        which &= ~lost
    clock, frames, rate = _clock(document, request, table)
    length = table.unit or unit
    every = bool(which.all())
    return Rows(
        clock=clock if every else clock[which],
        person=table.person if every else table.person[which],
        position=table.position if every else table.position[which],
        velocity=table.velocity if table.velocity is None or every else table.velocity[which],
        lines=table.lines if every else table.lines[which],
        frames=frames,
        rate=rate,
        rate_from_velocity=labeled,
        unit=length,
        unit_guess=guess and not length,
        format=form,
        notes=tuple(notes),
        details=details,
    )


def _tells_classes(labels: npt.NDArray[np.str_]) -> bool:
    """Return whether a column holds road users, and nothing else with the same name."""
    found = {_class(each) for each in np.unique(labels).tolist()}
    return bool(found & {"pedestrian", *_OTHERS})


def _clock(document: Document, request: Request, table: PeopleColumns) -> tuple[Array, bool, float | None]:
    """Return the clock of rows, whether it counts frames, and the frames per second if the file tells them."""
    clock, frame = table.clock, table.frame
    name = "fps" if request.fps is not None else "step_s" if request.step_s is not None else ""
    if table.frames:
        return clock, True, None
    time = clock * table.second if table.second != 1.0 else clock
    rate = None if frame is None else _rate_of_frames(frame, time)
    if not name:
        return time, False, rate
    if frame is not None and not np.array_equal(frame, clock, equal_nan=True):
        if rate is None:
            found = Shown(f"times in {table.clock_name} that are no frames divided by a rate")
            rule = f"agree with {name}"
            raise document.error(
                "frame_rate_contradicts_file", rule, found, f"leave out {name}: the times are taken then"
            )
        return frame, True, rate
    broken = np.flatnonzero(np.isfinite(clock) & (clock != np.floor(clock)))
    if len(broken):
        row = int(broken[0])
        raise document.error(
            "frame_rate_contradicts_file",
            f"hold frames where {name} is given",
            float(clock[row]),
            f"leave out {name}: the times of the file are taken as seconds then",
            line=int(table.lines[row]),
            key=f"column {table.clock_name}",
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
    Reader(name="table", title="any table with a header", recognizes=_is_table, read=_read_table),
]
