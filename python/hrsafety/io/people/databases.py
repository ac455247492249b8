"""JuPedSim SQLite: trajectories with the geometry that people walk in."""

from __future__ import annotations

import math
import sqlite3
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety.errors import Shown
from hrsafety.io.cells import MOST_ROWS, short
from hrsafety.io.people.geometry import rings
from hrsafety.io.people.request import Request
from hrsafety.io.people.rows import Rows
from hrsafety.io.reader import Document, Reader

__all__ = ["READERS", "finite_number", "refuse_fractions", "walls_of"]

Array = npt.NDArray[np.float64]

_SQLITE = b"SQLite format 3\0"
VERSIONS = (1, 2, 3)
_JOURNAL = slice(18, 20)
"""Bytes that say that changes stand in a second file."""
MOST_STEPS = 20_000
"""Times a thousand instructions of the database in one query."""


def _is_sqlite(document: Document) -> bool:
    return document.data.startswith(_SQLITE)


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
    version = finite_number(document, told.get("version"), "metadata.version")
    if version not in VERSIONS:
        rule = f"be of version {', '.join(map(str, VERSIONS))}"
        raise document.error("unknown_version", rule, Shown(f"{version:g}"), key="metadata.version")
    rate = finite_number(document, told["fps"], "metadata.fps") if told.get("fps") is not None else None
    if rate is not None and not rate > 0.0:
        raise document.error("unreadable_number", "be positive", rate, key="metadata.fps")
    (count,) = connection.execute("SELECT count(*) FROM trajectory_data").fetchone()
    if count > MOST_ROWS:
        raise document.error("too_large", f"have at most {MOST_ROWS:,} rows", count)
    values = connection.execute("SELECT frame, id, pos_x, pos_y FROM trajectory_data").fetchall()
    table = _matrix(document, values, ("frame", "id", "pos_x", "pos_y"))
    refuse_fractions(document, table[:, 1], "trajectory_data")
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
        walls=walls_of(document, [shape for (shape,) in shapes]),
        details={"version": int(version)},
    )


def finite_number(document: Document, value: object, key: str) -> float:
    """Return a number that stands as such or as text."""
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


def refuse_fractions(document: Document, ids: Array, table: str) -> None:
    """Refuse ids that are no integers."""
    wrong = np.flatnonzero(~((ids == np.floor(ids)) & (np.abs(ids) < 2.0**53)))
    if len(wrong):
        where = f"{table}, row {int(wrong[0]) + 1}, id"
        raise document.error("unreadable_number", "be an integer", float(ids[wrong[0]]), key=where)


def walls_of(document: Document, shapes: list[Any]) -> tuple[Array, ...]:
    """Return the rings of well-known texts, each text once."""
    found: list[Array] = []
    for shape in dict.fromkeys(shapes):
        if not isinstance(shape, str):
            raise document.error("unreadable", "be well-known text", Shown(short(str(shape))), key="geometry")
        try:
            found += rings(shape)
        except ValueError as error:
            raise document.error("unreadable", "be well-known text", Shown(short(str(error))), key="geometry") from None
    return tuple(found)


READERS = [
    Reader(name="jupedsim-sqlite", title="JuPedSim SQLite, versions 1 to 3", recognizes=_is_sqlite, read=_read_sqlite),
]
