"""Tables of the way of one person or thing: times and places, no ids."""

from __future__ import annotations

from collections.abc import Iterable
from os import PathLike
from pathlib import Path

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import positive
from hrsafety._tracks import Ways
from hrsafety.errors import Shown
from hrsafety.io.headers import LENGTHS
from hrsafety.io.people.tables import table_columns
from hrsafety.io.reader import Document
from hrsafety.plausibility import ResultWarning, telling

__all__ = ["load_track", "track_doubts"]

Array = npt.NDArray[np.float64]


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

    The file is a table as `load_people` reads it, without ids: the columns ``t_s`` (or ``frame``, with ``fps``),
    ``x_m`` and ``y_m`` by any of their names, with their units in the header, in the order of time.

    Parameters
    ----------
    path : path-like
        The file.
    fps : float or None
        Frames per second of a file whose times are numbers of frames.

    Returns
    -------
    time : ndarray, shape (n,)
        Instants in s, as they stand in the file.
    position : ndarray, shape (n, 2)
        Positions in m.

    Raises
    ------
    InvalidParameterError
        If the file cannot be read or breaks a rule; the message names line and column.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import io
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     table = pathlib.Path(folder, "walk.csv")
    ...     _ = table.write_text("t_s,x_m,y_m\n0.0,0.0,1.0\n0.4,0.5,1.0\n")
    ...     time, position = io.load_track(table)
    >>> time.tolist()
    [0.0, 0.4]
    """
    rate = None if fps is None else positive("fps", fps)
    document = Document(path)
    table = table_columns(document, single=True)
    clock, lines = table.clock, table.lines
    if len(clock) == 0:
        raise document.error("no_rows", "hold at least one row", Shown("none"))
    unknown = np.flatnonzero(np.isnan(clock) | np.isnan(table.position).any(axis=1) | table.unseen)
    if len(unknown):
        rule, found = (
            "have a time and a place in each row",
            "one marked as lost" if table.unseen[unknown[0]] else "none",
        )
        raise document.error("unreadable_number", rule, Shown(found), line=int(lines[unknown[0]]))
    column = f"column {table.clock_name}"
    if rate is not None:
        broken = np.flatnonzero(clock != np.floor(clock))
        if len(broken):
            rule, wrong = "hold frames where fps is given", float(clock[broken[0]])
            line = int(lines[broken[0]])
            raise document.error("frame_rate_contradicts_file", rule, wrong, "leave out fps", line=line, key=column)
    elif table.frames:
        raise document.error("frame_rate_needed", "come with fps=, the frames per second", Shown("frames"))
    back = np.flatnonzero(np.diff(clock) <= 0.0)
    if len(back):
        rule, row = f"be later than {clock[back[0]]}, the time before", int(back[0]) + 1
        raise document.error("order", rule, float(clock[row]), line=int(lines[row]), key=column)
    if table.unit not in LENGTHS:
        rule = f"name the unit of x and y in its header, one of {', '.join(LENGTHS)}"
        raise document.error("unit_needed", rule, Shown(table.unit or "none"), "write x_m and y_m", line=1)
    time = clock / rate if rate is not None else clock * table.second
    return time, table.position * LENGTHS[table.unit]
