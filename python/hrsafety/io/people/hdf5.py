"""HDF5 of the Juelich archive, read in a process of its own: damaged files make the library crash or never end."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
from typing import Any

import numpy as np

from hrsafety.errors import MissingExtraError, Shown
from hrsafety.io.cells import MOST_ROWS, short
from hrsafety.io.people.databases import finite_number, refuse_fractions, walls_of
from hrsafety.io.people.request import Request
from hrsafety.io.people.rows import Rows
from hrsafety.io.reader import Document, Reader

__all__ = ["READERS"]

_MAGIC = b"\x89HDF\r\n\x1a\n"
FIELDS = ("frame", "id", "x", "y")
PATIENCE, BYTES_PER_SECOND = 10.0, 1e7
"""Time in s after which a file is given up, beside that for its bytes."""

_READ = """
import io, json, sys
import h5py, numpy
said, columns = {}, b""
try:
    with h5py.File(io.BytesIO(sys.stdin.buffer.read()), "r") as file:
        if "trajectory" not in file:
            raise ValueError("no dataset /trajectory")
        data = file["trajectory"]
        absent = [each for each in FIELDS if each not in (data.dtype.names or ())]
        if absent:
            raise ValueError(f"no field {absent[0]} in /trajectory")
        if data.size > MOST or data.size * data.dtype.itemsize > 2**32:
            raise ValueError(f"{data.size} rows in /trajectory")
        rate = data.attrs.get("fps", file.attrs.get("fps"))
        said["rate"] = None if rate is None else str(numpy.asarray(rate).ravel()[0]) if numpy.size(rate) == 1 else ""
        shape = file.attrs.get("wkt_geometry")
        said["walls"] = shape.decode("utf-8", "replace") if isinstance(shape, bytes) else shape and str(shape)
        table = data[()].ravel()
        columns = numpy.stack([numpy.asarray(table[each], dtype=float) for each in FIELDS], axis=1).tobytes()
except Exception as error:
    said = {"error": f"{type(error).__name__}: {error}"}
sys.stdout.buffer.write(json.dumps(said).encode() + b"\\n" + columns)
"""


def _is_hdf5(document: Document) -> bool:
    return document.data.startswith(_MAGIC)


def _read_hdf5(document: Document, _request: Request) -> Rows:
    if importlib.util.find_spec("h5py") is None:
        raise MissingExtraError(f"{document.name} is HDF5, which needs h5py: pip install 'hrsafety[hdf5]'")
    said, content = _read_apart(document)
    table = np.frombuffer(content, dtype=np.float64).reshape(-1, len(FIELDS))
    infinite = np.flatnonzero(np.isinf(table).any(axis=1))
    if len(infinite):
        where = f"/trajectory, row {int(infinite[0]) + 1}"
        raise document.error("unreadable_number", "be finite", Shown("an infinite number"), key=where)
    refuse_fractions(document, table[:, 1], "/trajectory")
    rate = None if said["rate"] is None else finite_number(document, said["rate"], "/trajectory, fps")
    if rate is not None and not rate > 0.0:
        raise document.error("unreadable_number", "be positive", rate, key="/trajectory, fps")
    return Rows(
        clock=table[:, 0],
        person=table[:, 1].astype(np.int64),
        position=table[:, 2:],
        frames=True,
        rate=rate,
        unit="m",
        format="juelich-hdf5",
        walls=() if not said["walls"] else walls_of(document, [said["walls"]]),
    )


def _read_apart(document: Document) -> tuple[dict[str, Any], bytes]:
    """Return what another process found in the file: its attributes, and the columns of its rows."""
    program = f"FIELDS, MOST = {FIELDS!r}, {MOST_ROWS}\n{_READ}"
    rule, patience = "be HDF5 of the Juelich archive", PATIENCE + len(document.data) / BYTES_PER_SECOND
    try:
        done = subprocess.run(
            [sys.executable, "-c", program], input=document.data, capture_output=True, timeout=patience, check=False
        )
    except subprocess.TimeoutExpired:
        found = Shown(f"a file that the library does not read within {patience:.0f} s")
        raise document.error("unreadable", rule, found) from None
    head, _, content = done.stdout.partition(b"\n")
    try:
        said: dict[str, Any] = json.loads(head)
    except ValueError:
        raise document.error("unreadable", rule, Shown("a file that crashes the library")) from None
    if "error" in said:
        raise document.error("unreadable", rule, Shown(short(" ".join(said["error"].split()))))
    return said, content


READERS = [
    Reader(name="juelich-hdf5", title="HDF5 of the Juelich archive", recognizes=_is_hdf5, read=_read_hdf5),
]
