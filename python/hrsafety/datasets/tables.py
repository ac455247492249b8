"""Tables of recorded positions: strict comma-separated files with units in the header."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Sequence
from os import PathLike
from pathlib import Path

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import meant, positive, readable
from hrsafety._tracks import Ways
from hrsafety.datasets.recording import Recording
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.plausibility import ResultWarning, telling

__all__ = ["load_pedestrians", "load_track", "track_doubts"]

Array = npt.NDArray[np.float64]

PEDESTRIAN_COLUMNS = ("frame", "t_s", "ped_id", "x_m", "y_m")
FRAME_COLUMNS = ("frame", "ped_id", "x_m", "y_m")
TRACK_COLUMNS = ("t_s", "x_m", "y_m")
FRAMED_TRACK_COLUMNS = ("frame", "x_m", "y_m")

_INTEGER_COLUMNS = frozenset({"frame", "ped_id"})


@telling()
def load_pedestrians(path: str | PathLike[str], *, fps: float | None = None) -> Recording:
    r"""Read a table of recorded people.

    The file is comma-separated UTF-8 text with the columns ``frame`` (integer video frame, which
    may be left out), ``t_s`` (s), ``ped_id`` (integer), ``x_m`` and ``y_m`` (m) in any order and
    no others. Rows are sorted by time, then by id; all rows of a frame carry the same time, and
    time grows from frame to frame.

    Times that are numbers of frames are no seconds: with ``fps`` the time is ``frame / fps``. ``t_s`` may be
    missing then, or be the frame; a file whose ``t_s`` contradicts that is refused.

    Parameters
    ----------
    path : path-like
        The file.
    fps : float or None
        Frames per second of a file whose times are numbers of frames.

    Returns
    -------
    Recording
        Its rows.

    Raises
    ------
    InvalidParameterError
        If the file cannot be read or breaks a rule; the message names line and column.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import datasets
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     table = pathlib.Path(folder, "walk.csv")
    ...     _ = table.write_text("frame,t_s,ped_id,x_m,y_m\n0,0.0,7,0.0,1.0\n10,0.4,7,0.5,1.0\n")
    ...     timed = datasets.load_pedestrians(table).duration
    ...     _ = table.write_text("frame,ped_id,x_m,y_m\n0,7,0.0,1.0\n10,7,0.5,1.0\n")
    ...     timed, datasets.load_pedestrians(table, fps=25.0).duration
    (0.4, 0.4)
    """
    rate = None if fps is None else positive("fps", fps)
    readable("path", path)
    layouts = [PEDESTRIAN_COLUMNS, PEDESTRIAN_COLUMNS[1:], *([FRAME_COLUMNS] if rate else [])]
    columns, rows = _read(Path(path), layouts, _check_pedestrian_rows)
    table = np.array(rows, dtype=np.float64)
    time = table[:, 0 if columns == FRAME_COLUMNS else -4]
    if rate is not None:
        time = _timed(Path(path), columns, table, rate)
    return Recording(time_s=time, person=np.array([row[-3] for row in rows], dtype=np.int64), position=table[:, -2:])


def _timed(path: Path, columns: tuple[str, ...], table: Array, rate: float) -> Array:
    """Return the times of rows by their frames, or say that the times of the file are none of frames."""
    frames = table[:, 0]
    whole = (frames == np.floor(frames)).all()
    remedy = "leave out fps: the times of the file are taken as seconds then"
    if columns == PEDESTRIAN_COLUMNS[1:] and not whole:
        wrong = float(frames[frames != np.floor(frames)][0])
        raise InvalidParameterError(f"{path.name}, column t_s", "hold frames where fps is given", wrong, remedy)
    if columns == PEDESTRIAN_COLUMNS and not np.array_equal(table[:, 1], frames):
        passed = table[:, 1] - table[0, 1]
        off = np.abs(passed - (frames - frames[0]) / rate)
        # Times are rounded to some digits.
        if off.max() > 0.5 / rate:
            row = int(np.argmax(off))
            rule = f"be the frames divided by fps = {rate:g}"
            found = Shown(f"{passed[row]:g} s for {frames[row] - frames[0]:g} frames")
            raise InvalidParameterError(f"{path.name}, column t_s", rule, found, remedy)
    seconds: Array = frames / rate
    return seconds


def track_doubts(name: str, time: Array, position: Array, *, person: bool = True) -> tuple[ResultWarning, ...]:
    """Return the doubts about a recorded way; of a thing only those about its times."""
    ways = Ways(time, np.zeros(len(time), dtype=np.int64), position)
    remedy = "load_track(..., fps=), fps in a scenario file, or divide the times by the frames per second"
    smoothing = "datasets.Recording(...).smoothed(0.6) takes the noise out"
    found = ways.doubts(lambda _: name, moving=name, of_frames=f"give {remedy}", smoothing=smoothing)
    return tuple(each for each in found if person or each.subject == "time_s" or remedy in each.message)


def _doubts_of_track(path: str | PathLike[str], *, fps: float | None = None) -> Iterable[ResultWarning]:
    return track_doubts(Path(path).name, *load_track(path, fps=fps), person=False)


@telling(_doubts_of_track)
def load_track(path: str | PathLike[str], *, fps: float | None = None) -> tuple[Array, Array]:
    r"""Read the recorded way of one person or thing.

    The file is comma-separated UTF-8 text with the columns ``t_s`` (s, strictly increasing),
    ``x_m`` and ``y_m`` (m) in any order and no others. Times that are numbers of frames are no seconds: with ``fps``
    they are divided by it, and the column may be called ``frame``.

    Parameters
    ----------
    path : path-like
        The file.
    fps : float or None
        Frames per second of a file whose times are numbers of frames.

    Returns
    -------
    time : ndarray, shape (n,)
        Instants in s.
    position : ndarray, shape (n, 2)
        Positions in m.

    Raises
    ------
    InvalidParameterError
        If the file cannot be read or breaks a rule; the message names line and column.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import datasets
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     table = pathlib.Path(folder, "walk.csv")
    ...     _ = table.write_text("t_s,x_m,y_m\n0.0,0.0,1.0\n0.4,0.5,1.0\n")
    ...     time, position = datasets.load_track(table)
    >>> time.tolist()
    [0.0, 0.4]
    """
    rate = None if fps is None else positive("fps", fps)
    readable("path", path)
    layouts = [TRACK_COLUMNS, *([FRAMED_TRACK_COLUMNS] if rate else [])]
    table = np.array(_read(Path(path), layouts, _check_track_rows)[1], dtype=np.float64)
    time = table[:, 0].copy()
    if rate is not None:
        if (time != np.floor(time)).any():
            wrong = float(time[time != np.floor(time)][0])
            raise InvalidParameterError(
                f"{Path(path).name}, column t_s", "hold frames where fps is given", wrong, "leave out fps"
            )
        time = time / rate
    return time, table[:, 1:].copy()


Row = tuple[float, ...]
OrderCheck = Callable[[str, str, Row, Row], None]


def _check_pedestrian_rows(line: str, first: str, before: Row, row: Row) -> None:
    """Check the order of two rows (frame, t_s, ped_id, x_m, y_m); frame or t_s may be missing, the other is first."""
    if len(row) < len(PEDESTRIAN_COLUMNS):
        if row[0] < before[0]:
            remedy = f"sort the rows by {first}, then by ped_id"
            raise InvalidParameterError(
                f"{line}, column {first}", f"not be before {before[0]} of the row above", row[0], remedy
            )
        # Each instant is a frame.
        before, row = (before[0], *before), (row[0], *row)
    if row[0] < before[0]:
        raise InvalidParameterError(
            f"{line}, column frame", f"not be before frame {before[0]} of the row above", row[0]
        )
    if row[0] > before[0]:
        if not row[1] > before[1]:
            rule = f"be later than {before[1]}, the time of the frame before"
            raise InvalidParameterError(f"{line}, column t_s", rule, row[1])
        return
    if row[1] != before[1]:
        raise InvalidParameterError(f"{line}, column t_s", f"be {before[1]} as in the row of the same frame", row[1])
    if row[2] == before[2]:
        raise InvalidParameterError(f"{line}, column ped_id", "have one row for each instant", Shown(f"{row[2]} twice"))
    if row[2] < before[2]:
        raise InvalidParameterError(f"{line}, column ped_id", f"follow {before[2]} within the frame", row[2])


def _check_track_rows(line: str, first: str, before: Row, row: Row) -> None:
    """Check the order of two rows (t_s or frame, x_m, y_m)."""
    if not row[0] > before[0]:
        raise InvalidParameterError(f"{line}, column {first}", f"be later than {before[0]}, the time before", row[0])


def _read(path: Path, layouts: Sequence[tuple[str, ...]], check_order: OrderCheck) -> tuple[tuple[str, ...], list[Row]]:
    """Return the columns and rows of a table in one of the layouts, values in the order of its columns."""
    rows: list[Row] = []
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file, strict=True)
            header = next(reader, [])
            columns = _layout([name.strip() for name in header], layouts)
            order = _header(path, header, columns)
            for fields in reader:
                line = f"{path.name}, line {reader.line_num}"
                row = _row(line, fields, columns, order)
                if rows:
                    check_order(line, columns[0], rows[-1], row)
                rows.append(row)
    except UnicodeDecodeError as error:
        raise InvalidParameterError(
            path.name, "be UTF-8 text", Shown(f"byte {error.object[error.start]:#04x}")
        ) from None
    except csv.Error as error:
        raise InvalidParameterError(path.name, "be comma-separated text", Shown(str(error))) from None
    except OSError as error:
        raise InvalidParameterError("path", "name a readable file", Shown(f"{path} ({error.strerror})")) from None
    if not rows:
        raise InvalidParameterError(path.name, "hold at least one row", Shown("the header only"))
    return columns, rows


def _layout(names: list[str], layouts: Sequence[tuple[str, ...]]) -> tuple[str, ...]:
    """Return the columns that a header is meant to name: those with its first one, of as many names if there are."""
    for columns in layouts:
        if set(columns) == set(names):
            return columns
    missing = [columns for columns in layouts if len(columns) == len(names) and layouts[0][0] not in names]
    return missing[0] if missing else layouts[0]


DELIMITERS = {";": "semicolons", "\t": "tabs", "|": "bars", " ": "blanks"}
OTHER_UNITS = ("mm", "cm", "km", "ft", "in", "px", "pixel", "ms", "us", "min")


def _header(path: Path, header: list[str], columns: tuple[str, ...]) -> list[int]:
    """Return where each column stands."""
    names = [name.strip() for name in header]
    where = f"{path.name}, line 1"
    if not any(names):
        raise InvalidParameterError(where, f"name the columns {', '.join(columns)}", Shown("nothing"))
    _check_delimiter(where, names)
    if all(map(_is_number, names)):
        remedy = f"write {','.join(columns)} above it"
        raise InvalidParameterError(where, f"name the columns {', '.join(columns)}", Shown("numbers"), remedy)
    missing = [name for name in columns if name not in names]
    if len(missing) > 1 and not any(_renaming(name, names, columns) for name in missing):
        found = Shown(f"the columns {_listed(names)}")
        raise InvalidParameterError(where, f"name the columns {', '.join(columns)}", found, _written(missing, columns))
    for name in columns:
        if names.count(name) != 1:
            found = Shown(f"the columns {_listed(names)}" if name not in names else f"{names.count(name)} of them")
            raise InvalidParameterError(where, f"have one column {name}", found, _renaming(name, names, columns))
    for name in names:
        if name not in columns:
            rule = f"have no other columns than {', '.join(columns)}"
            raise InvalidParameterError(where, rule, name if name else Shown("one without a name"))
    return [names.index(name) for name in columns]


def _check_delimiter(where: str, names: list[str]) -> None:
    """Say so if a header is divided by something else than commas."""
    for delimiter, words in DELIMITERS.items():
        parts = names[0].split(delimiter)
        if len(names) == 1 and len(parts) > 1:
            found = Shown(f"{words} between the columns {_listed(parts)}")
            remedy = "write commas between the columns and points in the decimals"
            raise InvalidParameterError(where, "be separated by commas", found, remedy)


def _listed(names: list[str]) -> str:
    """Return the names that a header has, of a wide one the first few."""
    listed = ", ".join(_short(name.strip()) or "(blank)" for name in names[:12])
    return listed if len(names) <= 12 else f"{listed} and {len(names) - 12} more"


def _written(missing: list[str], columns: tuple[str, ...]) -> str:
    """Return what to do about columns by other names."""
    remedy = f"rename those that hold {', '.join(missing)}, in s and m"
    if "ped_id" in columns:
        remedy += ", or hand arrays to datasets.Recording"
        if "t_s" in missing:
            remedy += "; frames are no seconds: name them frame and give fps=, the frames per second"
    return remedy


def _renaming(name: str, names: list[str], columns: tuple[str, ...]) -> str | None:
    """Return which column may hold what is looked for, and whether it has the unit for it."""
    near = meant(name, [each for each in names if each not in columns])
    for each in names:
        stem, _, unit = each.lower().rpartition("_")
        if unit in OTHER_UNITS and stem == name.rpartition("_")[0]:
            return f"convert {_short(each)} to the unit of {name}"
    if name == "t_s" and any(each.lower().startswith("frame") for each in names):
        return "give fps=, the frames per second (--fps on the command line), if the file has frames and no times"
    return near


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _row(line: str, fields: list[str], columns: tuple[str, ...], order: list[int]) -> Row:
    if len(fields) != len(columns):
        remedy = None if fields else "remove the blank line"
        if len(fields) > len(columns) and all(map(_is_number, fields)):
            remedy = "decimals need a point, not a comma"
        raise InvalidParameterError(line, f"have {len(columns)} fields", len(fields), remedy)
    return tuple(_value(line, name, fields[index].strip()) for name, index in zip(columns, order, strict=True))


def _value(line: str, column: str, text: str) -> float:
    """Return one field as a number; an integer stays exact."""
    rule = "be an integer" if column in _INTEGER_COLUMNS else "be a finite number"
    try:
        if "_" in text:
            raise ValueError
        value = int(text) if column in _INTEGER_COLUMNS else float(text)
        if not abs(value) < 2**63:
            raise ValueError
    except ValueError:
        raise InvalidParameterError(f"{line}, column {column}", rule, _short(text), _as_number(text, rule)) from None
    return value


def _as_number(text: str, rule: str) -> str | None:
    """Return how to write a field that is nearly a number."""
    if text.count(",") == 1 and _is_number(text.replace(",", ".")):
        return f"write {_short(text.replace(',', '.'))}"
    if rule == "be an integer" and _is_number(text) and float(text).is_integer() and abs(float(text)) < 2**53:
        return f"write {int(float(text))}"
    return None


def _short(text: str) -> str:
    return text if len(text) <= 40 else f"{text[:37]}..."
