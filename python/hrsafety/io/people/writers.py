"""Writers of recorded people, for the formats that others read."""

from __future__ import annotations

import json
import sqlite3
import warnings
from collections.abc import Callable
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import flag, instance, positive, word
from hrsafety._atomic import write_file
from hrsafety.datasets.recording import Recording
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.io.people.geometry import polygon_text
from hrsafety.plausibility import HrsafetyWarning
from hrsafety.tables import write_csv

__all__ = ["write_people"]

Array = npt.NDArray[np.float64]
Frames = npt.NDArray[np.int64]

ON_FRAME = 1e-3
"""An instant lies on a frame if it is so near, as a share of the time between two."""
MOST_FRAMES = 2**53


def write_people(
    recording: Recording,
    path: str | PathLike[str],
    *,
    format: str | None = None,  # the word of the field
    fps: float | None = None,
    renumber: bool = False,
) -> Path:
    """Write recorded people for another program, whole or not at all.

    Numbers keep all their digits, times begin at 0. What a format cannot hold is told as `HrsafetyWarning`.

    Parameters
    ----------
    recording : Recording
        People.
    path : path-like
        The file; its folder must exist.
    format : str or None
        ``table`` (CSV: frame, t_s, ped_id, x_m, y_m, and velocities if they are stored), ``petrack`` (text, also for
        PedPy), ``jupedsim-sqlite`` (version 2, with rings of walls as geometry), ``trajnet++``, ``socnavdata`` (JSON
        with walls and the robot); ``None``: by the ending, .csv, .txt, .sqlite, .ndjson, .json.
    fps : float or None
        Frames per second of formats that count frames, if the recording does not tell them.
    renumber : bool
        Whether people get the numbers 1, 2, ... in the order of their ids, for formats that have numbers only.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range, an instant lies between two frames, or an id is no number where one is needed.

    Examples
    --------
    >>> from hrsafety import io
    >>> from hrsafety.datasets import Recording
    >>> walk = Recording(time_s=[0.0, 0.4], person=[7, 7], position=[[0, 0], [0.5, 0]])
    >>> io.write_people(walk, "walk.txt").read_text().splitlines()[-1]
    '7 1 0.5 0.0'
    >>> io.load_people("walk.txt").position.tolist()
    [[0.0, 0.0], [0.5, 0.0]]
    """
    instance("recording", recording, Recording)
    try:
        place = Path(path)
    except TypeError:
        raise InvalidParameterError("path", "be the path of a file", path) from None
    form = _form(place, format)
    rate = None if fps is None else positive("fps", fps)
    if flag("renumber", renumber):
        recording = _numbered(recording)
    write, holds = _WRITERS[form]
    content = write(recording, rate)
    if not place.parent.is_dir():
        raise InvalidParameterError("path", "lie in a folder that exists", str(place), f"make {place.parent} first")
    if isinstance(content, dict):
        write_csv(place, content)
    else:
        write_file(place, content)
    _tell(recording, form, holds)
    return place


def _form(place: Path, given: object) -> str:
    if given is not None:
        return word("format", given, list(_WRITERS))
    form = _ENDINGS.get(place.suffix.lower())
    if form is None:
        rule = f"end with one of {', '.join(_ENDINGS)}, or come with format="
        raise InvalidParameterError("path", rule, str(place))
    return form


def _numbered(recording: Recording) -> Recording:
    _, index = np.unique(recording.person, return_inverse=True)
    person = index.ravel() + 1
    order = np.lexsort((person, recording.time_s))
    velocity = None if recording.velocity is None else recording.velocity[order]
    return replace(recording, person=person[order], position=recording.position[order], velocity=velocity)


def _tell(recording: Recording, form: str, holds: set[str]) -> None:
    """Say what the format has no place for."""
    lost = ["velocities"] if recording.velocity is not None and "velocity" not in holds else []
    lost += ["robot"] if recording.robot is not None and "robot" not in holds else []
    walls = [wall for wall in recording.walls if "walls" not in holds or ("rings" in holds and len(wall) < 3)]
    lost += ["walls"] if walls else []
    if lost:
        message = f"{form} holds no {', no '.join(lost)}: what the recording has of them is not in the file"
        warnings.warn(message, HrsafetyWarning, stacklevel=3)


def _frames(recording: Recording, fps: float | None) -> tuple[Frames, float]:
    """Return the frame of each row, from 0, and the frames per second."""
    known = recording.frame_rate
    rate = fps or known
    if fps is not None and known is not None and abs(fps / known - 1.0) > 1e-6:
        raise InvalidParameterError("fps", f"be left out, or that of the recording, {known:.10g}", fps)
    remedy = "give fps=, the frames per second, or write a table, which has times"
    if rate is None:
        period = recording.sampling_period
        if not period > 0.0:
            raise InvalidParameterError("fps", "be given for a recording without a frame rate", None, remedy)
        rate = 1.0 / period
        rate = float(round(rate)) if round(rate) > 0 and abs(round(rate) / rate - 1.0) < 1e-6 else rate
    exact = (recording.time_s - recording.time_s[0]) * rate
    if not exact[-1] < MOST_FRAMES:
        raise InvalidParameterError("fps", f"make at most {MOST_FRAMES} frames", rate)
    frames = np.rint(exact)
    off = np.abs(exact - frames)
    if off.max() > ON_FRAME:
        row = int(np.argmax(off))
        rule = f"have all rows on frames, {rate:.6g} of them a second"
        raise InvalidParameterError("recording", rule, Shown(f"one at {recording.time_s[row]:.10g} s"), remedy)
    return frames.astype(np.int64), rate


def _integers(recording: Recording, form: str) -> list[int]:
    """Return the ids as numbers."""
    if recording.person.dtype.kind == "U":
        found = Shown(f"the id {str(recording.person[0])!r}")
        raise InvalidParameterError("recording", f"name people by numbers for {form}", found, "give renumber=True")
    return list(recording.person.tolist())


def _table(recording: Recording, fps: float | None) -> dict[str, npt.NDArray[Any]]:
    columns: dict[str, npt.NDArray[Any]] = {}
    if fps is not None or recording.frame_rate is not None:
        columns["frame"] = _frames(recording, fps)[0]
    x, y = recording.position.T
    columns |= {"t_s": recording.time_s, "ped_id": recording.person, "x_m": x, "y_m": y}
    if recording.velocity is not None:
        columns |= {"vx_m_per_s": recording.velocity[:, 0], "vy_m_per_s": recording.velocity[:, 1]}
    return columns


def _petrack(recording: Recording, fps: float | None) -> str:
    frames, rate = _frames(recording, fps)
    rows = zip(_integers(recording, "petrack"), frames.tolist(), *recording.position.T.tolist(), strict=True)
    head = [f"# framerate: {rate!r} fps", "# id frame x/m y/m"]
    return "\n".join([*head, *(f"{who} {frame} {x!r} {y!r}" for who, frame, x, y in rows), ""])


def _sqlite(recording: Recording, fps: float | None) -> bytes:
    frames, rate = _frames(recording, fps)
    heading = _headings(recording)
    rows = zip(
        frames.tolist(),
        _integers(recording, "jupedsim-sqlite"),
        *recording.position.T.tolist(),
        np.cos(heading).tolist(),
        np.sin(heading).tolist(),
        strict=True,
    )
    rings = [ring for ring in recording.walls if len(ring) > 2]
    connection = sqlite3.connect(":memory:")
    try:
        run = connection.execute
        run(
            "CREATE TABLE trajectory_data (frame INTEGER NOT NULL, id INTEGER NOT NULL, pos_x REAL NOT NULL, "
            "pos_y REAL NOT NULL, ori_x REAL NOT NULL, ori_y REAL NOT NULL)"
        )
        run("CREATE TABLE metadata(key TEXT NOT NULL UNIQUE PRIMARY KEY, value TEXT NOT NULL)")
        run("CREATE TABLE geometry(hash INTEGER NOT NULL, wkt TEXT NOT NULL)")
        run("CREATE TABLE frame_data(frame INTEGER NOT NULL, geometry_hash INTEGER NOT NULL)")
        connection.executemany("INSERT INTO trajectory_data VALUES(?, ?, ?, ?, ?, ?)", rows)
        x, y = recording.position.T
        told = {"version": "2", "fps": repr(rate), "xmin": x.min(), "xmax": x.max(), "ymin": y.min(), "ymax": y.max()}
        connection.executemany("INSERT INTO metadata VALUES(?, ?)", [(key, str(value)) for key, value in told.items()])
        if rings:
            run("INSERT INTO geometry VALUES(?, ?)", (1, polygon_text(rings[0], rings[1:])))
            connection.executemany(
                "INSERT INTO frame_data VALUES(?, 1)", [(each,) for each in np.unique(frames).tolist()]
            )
        run("CREATE UNIQUE INDEX geometry_hash on geometry(hash)")
        run("CREATE INDEX frame_id_idx ON trajectory_data(frame, id)")
        connection.commit()
        return connection.serialize()
    finally:
        connection.close()


def _trajnetpp(recording: Recording, fps: float | None) -> str:
    frames, rate = _frames(recording, fps)
    ids = _integers(recording, "trajnet++")
    people, counts = np.unique(recording.person, return_counts=True)
    step = max(round(recording.sampling_period * rate), 1) if recording.sampling_period > 0.0 else 1
    scene = {
        "id": 0,
        "p": people[np.argmax(counts)].item(),
        "s": int(frames[0]),
        "e": int(frames[-1]),
        "fps": rate / step,
    }
    rows = zip(frames.tolist(), ids, *recording.position.T.tolist(), strict=True)
    tracks = (f'{{"track": {{"f": {f}, "p": {p}, "x": {x!r}, "y": {y!r}}}}}' for f, p, x, y in rows)
    return "\n".join([json.dumps({"scene": scene}), *tracks, ""])


def _socnav(recording: Recording, fps: float | None) -> str:
    if fps is not None:
        raise InvalidParameterError("fps", "be left out for socnavdata, which has times", fps)
    heading = _headings(recording)
    instants, begin = np.unique(recording.time_s, return_index=True)
    robot = recording.robot
    moments = {float(each): dict[str, Any](timestamp=float(each), people=[], objects=[]) for each in instants}
    ends = [*begin.tolist()[1:], len(recording)]
    for first, last, moment in zip(begin.tolist(), ends, list(moments.values()), strict=True):
        rows = slice(first, last)
        given = zip(
            recording.person[rows].tolist(), recording.position[rows].tolist(), heading[rows].tolist(), strict=True
        )
        moment["people"] = [{"id": who, "x": x, "y": y, "angle": angle} for who, (x, y), angle in given]
    if robot is not None:
        goal = recording.details.get("goal")
        for time, (x, y), angle in zip(
            robot.time_s.tolist(), robot.position.tolist(), robot.heading.tolist(), strict=True
        ):
            moment = moments.setdefault(time, {"timestamp": time, "people": [], "objects": []})
            moment["robot"] = {"x": x, "y": y, "angle": angle, **({"shape": dict(robot.shape)} if robot.shape else {})}
            if goal is not None:
                moment["goal"] = {"type": "go-to", "human": None, "x": goal[0], "y": goal[1]}
    walls = [wall for each in recording.walls for wall in _edges(each)]
    whole = {"walls": walls, "sequence": [moments[time] for time in sorted(moments)]}
    return json.dumps(whole, allow_nan=False)


def _edges(points: Array) -> list[list[float]]:
    """Return the lines between points, of a ring also that from the last one to the first."""
    ends = np.roll(points, -1, axis=0) if len(points) > 2 else points[1:]
    return [[*first, *last] for first, last in zip(points.tolist(), ends.tolist(), strict=False)]


def _headings(recording: Recording) -> Array:
    """Return the directions of motion in rad, 0 of those who stand."""
    velocity = np.nan_to_num(recording.motion().velocity)
    found: Array = np.arctan2(velocity[:, 1], velocity[:, 0])
    return found


_WRITERS: dict[str, tuple[Callable[[Recording, float | None], Any], set[str]]] = {
    "table": (_table, {"velocity"}),
    "petrack": (_petrack, set()),
    "jupedsim-sqlite": (_sqlite, {"walls", "rings"}),
    "trajnet++": (_trajnetpp, set()),
    "socnavdata": (_socnav, {"walls", "robot"}),
}
"""Writer of each format, and what its file holds beside positions."""
_ENDINGS = {
    ".csv": "table",
    ".txt": "petrack",
    ".sqlite": "jupedsim-sqlite",
    ".db": "jupedsim-sqlite",
    ".ndjson": "trajnet++",
    ".json": "socnavdata",
}
