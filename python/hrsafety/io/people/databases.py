"""JuPedSim SQLite and HDF5 of the Juelich archive: trajectories with the geometry that people walk in."""

from __future__ import annotations

import io
import math
import sqlite3
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety.errors import FileError, MissingExtraError, Shown
from hrsafety.io.cells import short
from hrsafety.io.people.geometry import rings
from hrsafety.io.people.request import Request
from hrsafety.io.people.rows import Rows
from hrsafety.io.reader import Document, Reader

__all__ = ["READERS"]

Array = npt.NDArray[np.float64]

_SQLITE, _HDF5 = b"SQLite format 3\0", b"\x89HDF\r\n\x1a\n"
VERSIONS = (1, 2, 3)
_JOURNAL = slice(18, 20)
"""Bytes that say that changes stand in a second file."""
MOST_ROWS = 30_000_000
MOST_STEPS = 20_000
"""Times a thousand instructions of the database in one query."""


def _is_sqlite(document: Document) -> bool:
    return document.data.startswith(_SQLITE)


def _is_hdf5(document: Document) -> bool:
    return document.data.startswith(_HDF5)


# ---- SQLite -------------------------------------------------------------------------------------


def _read_sqlite(document: Document, _request: Request) -> Rows:
    beside = document.path.with_name(f"{document.name}-wal")
    if beside.is_file() and beside.stat().st_size > 0:
        rule = f"hold all of its rows: {beside.name} has some that are not in it yet"
        raise document.error("unreadable", rule, Shown("a log of changes"), "close the program that writes it")
    data = bytearray(document.data)
    data[_JOURNAL] = b"\x01\x01"
    connection = sqlite3.connect(":memory:")
    try:
        connection.deserialize(bytes(data))
        steps = iter(range(MOST_STEPS))
        connection.set_progress_handler(lambda: next(steps, None) is None, 100_000)
        return _of_database(document, connection)
    except (sqlite3.Error, sqlite3.Warning, OverflowError, UnicodeDecodeError, MemoryError) as error:
        raise document.error("unreadable", "be a database of JuPedSim", short(str(error))) from None
    finally:
        connection.close()


def _of_database(document: Document, connection: sqlite3.Connection) -> Rows:
    told = dict(connection.execute("SELECT key, value FROM metadata").fetchmany(1000))
    version = _number(document, told.get("version"), "metadata.version")
    if version not in VERSIONS:
        rule = f"be of version {', '.join(map(str, VERSIONS))}"
        raise document.error("unknown_version", rule, Shown(f"{version:g}"), key="metadata.version")
    rate = _number(document, told["fps"], "metadata.fps") if told.get("fps") is not None else None
    if rate is not None and not rate > 0.0:
        raise document.error("unreadable_number", "be positive", rate, key="metadata.fps")
    (count,) = connection.execute("SELECT count(*) FROM trajectory_data").fetchone()
    if count > MOST_ROWS:
        raise document.error("too_large", f"have at most {MOST_ROWS:,} rows", count)
    values = connection.execute("SELECT frame, id, pos_x, pos_y FROM trajectory_data").fetchall()
    table = _matrix(document, values, ("frame", "id", "pos_x", "pos_y"))
    _check_ids(document, table[:, 1])
    has = connection.execute("SELECT count(*) FROM sqlite_master WHERE name = 'geometry'").fetchone()[0]
    shapes = connection.execute("SELECT wkt FROM geometry").fetchmany(1000) if has else []
    return Rows(
        clock=table[:, 0],
        person=table[:, 1].astype(np.int64),
        position=table[:, 2:],
        frames=True,
        rate=rate,
        unit="m",
        format="jupedsim-sqlite",
        walls=_walls(document, [shape for (shape,) in shapes]),
        details={"version": int(version)},
    )


def _number(document: Document, value: object, key: str) -> float:
    try:
        found = float(value)  # type: ignore[arg-type]  # what is no number fails here
    except (TypeError, ValueError, OverflowError):
        found = math.nan
    if not math.isfinite(found):
        raise document.error("unreadable_number", "be a finite number", Shown(short(str(value))), key=key)
    return found


def _matrix(document: Document, values: list[Any], names: tuple[str, ...]) -> Array:
    """Return rows of a query as numbers, NaN for null positions."""
    try:
        table = np.array(values, dtype=np.float64).reshape(-1, len(names))
    except (TypeError, ValueError, OverflowError):
        table = None
    if table is None or np.isinf(table).any():
        for row, cells in enumerate(values):
            for name, cell in zip(names, cells, strict=True):
                if cell is not None and (not isinstance(cell, int | float) or math.isinf(cell)):
                    place = f"trajectory_data, row {row + 1}, {name}"
                    raise document.error("unreadable_number", "be a finite number", Shown(short(str(cell))), key=place)
        raise document.error("unreadable_number", "hold numbers", Shown("others"), key="trajectory_data")
    return table


def _check_ids(document: Document, ids: Array) -> None:
    wrong = np.flatnonzero(~((ids == np.floor(ids)) & (np.abs(ids) < 2.0**53)))
    if len(wrong):
        where = f"trajectory_data, row {int(wrong[0]) + 1}, id"
        raise document.error("unreadable_number", "be an integer", float(ids[wrong[0]]), key=where)


def _walls(document: Document, shapes: list[object]) -> tuple[Array, ...]:
    found: list[Array] = []
    for shape in dict.fromkeys(shapes):
        if not isinstance(shape, str):
            raise document.error("unreadable", "be well-known text", Shown(short(str(shape))), key="geometry")
        try:
            found += rings(shape)
        except ValueError as error:
            raise document.error("unreadable", "be well-known text", Shown(short(str(error))), key="geometry") from None
    return tuple(found)


# ---- HDF5 ---------------------------------------------------------------------------------------


def _read_hdf5(document: Document, _request: Request) -> Rows:
    try:
        import h5py
    except ModuleNotFoundError:
        raise MissingExtraError(f"{document.name} is HDF5, which needs h5py: pip install 'hrsafety[hdf5]'") from None
    try:
        with h5py.File(io.BytesIO(document.data), "r") as file:
            return _of_hdf5(document, file)
    except FileError:
        raise
    except Exception as error:  # of a damaged file: the library raises errors of many kinds
        found = Shown(short(f"{type(error).__name__}: {error}"))
        raise document.error("unreadable", "be HDF5 of the Juelich archive", found) from None


def _of_hdf5(document: Document, file: Any) -> Rows:
    names = ("frame", "id", "x", "y")
    if "trajectory" not in file:
        raise document.error("unreadable", "have a dataset /trajectory", Shown(", ".join(list(file)[:5]) or "none"))
    data = file["trajectory"]
    absent = [each for each in names if each not in (data.dtype.names or ())]
    if absent:
        raise document.error(
            "unreadable", f"have fields {', '.join(names)}", Shown(f"no {absent[0]}"), key="/trajectory"
        )
    if data.size > MOST_ROWS:
        raise document.error("too_large", f"have at most {MOST_ROWS:,} rows", int(data.size))
    table = data[()].ravel()
    columns = np.stack([np.asarray(table[each], dtype=np.float64) for each in names], axis=1)
    if np.isinf(columns).any():
        row = int(np.flatnonzero(np.isinf(columns).any(axis=1))[0])
        raise document.error(
            "unreadable_number", "be finite", Shown("an infinite one"), key=f"/trajectory, row {row + 1}"
        )
    _check_ids(document, columns[:, 1])
    rate = data.attrs.get("fps", file.attrs.get("fps"))
    if rate is not None:
        rate = _number(document, np.asarray(rate).ravel()[0] if np.size(rate) == 1 else None, "/trajectory fps")
        if not rate > 0.0:
            raise document.error("unreadable_number", "be positive", rate, key="/trajectory fps")
    shape = file.attrs.get("wkt_geometry")
    if isinstance(shape, bytes):
        shape = shape.decode("utf-8", "replace")
    return Rows(
        clock=columns[:, 0],
        person=columns[:, 1].astype(np.int64),
        position=columns[:, 2:],
        frames=True,
        rate=rate,
        unit="m",
        format="juelich-hdf5",
        walls=() if shape is None else _walls(document, [shape if isinstance(shape, str) else str(shape)]),
    )


READERS = [
    Reader(name="jupedsim-sqlite", title="JuPedSim SQLite, versions 1 to 3", recognizes=_is_sqlite, read=_read_sqlite),
    Reader(name="juelich-hdf5", title="HDF5 of the Juelich archive", recognizes=_is_hdf5, read=_read_hdf5),
]
