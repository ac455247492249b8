"""Gray pictures in PGM."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._bounds import MOST_CELLS
from hrsafety.errors import InvalidParameterError, Shown

if TYPE_CHECKING:
    from io import BufferedReader
    from pathlib import Path

__all__ = ["Picture", "read_pgm"]

HEAD_BYTES = 1 << 16
PIECE = 1 << 24  # bytes that are read at once
BYTES_OF_NUMBER = 16  # of a gray value in words with what stands around it
# Between the words of the head stand blanks and comments that end with their line.
_GAP = rb"(?:\s|#[^\n\r]*[\n\r])+"
_HEAD = rb"(P[25])" + _GAP + rb"(\d{1,10})" + _GAP + rb"(\d{1,10})" + _GAP + rb"(\d{1,6})(?:\s|(?=#))"


class Picture(NamedTuple):
    """Gray values as they stand in a file."""

    values: npt.NDArray[np.uint8]
    """(rows, columns), first row on top."""
    gray: npt.NDArray[np.float64]
    """Gray value from 0 to 255 of each value that a file may hold."""


def read_pgm(path: Path) -> Picture:
    """Return the gray values of a picture."""
    try:
        with path.open("rb") as file:
            head = re.match(_HEAD, file.read(HEAD_BYTES))
            if head is None:
                file.seek(0)
                shown = Shown(f"{path.name}, which begins with {file.read(2)!r}")
                raise InvalidParameterError("image", "be a PGM picture, P2 or P5", shown)
            kind, (columns, rows, most) = head[1], map(int, head.groups()[1:])
            _check_head(path, rows, columns, most)
            size, cells = path.stat().st_size - head.end(), rows * columns
            if size > cells * (1 if kind == b"P5" else BYTES_OF_NUMBER) + HEAD_BYTES:
                raise _wrong_size(path, rows, columns, f"{size} bytes")
            file.seek(head.end())
            body = _rest(file, size)
    except OSError as error:
        raise InvalidParameterError("image", "be readable", Shown(f"{path.name} ({error.strerror})")) from None
    values = _bytes(path, body, rows, columns) if kind == b"P5" else _words(path, body, rows, columns)
    if values.size and int(values.max()) > most:
        shown = Shown(f"{int(values.max())} in {path.name}")
        raise InvalidParameterError("image", f"have gray values up to its maxval, {most}", shown)
    gray = np.arange(256.0)
    return Picture(
        values.astype(np.uint8, copy=False).reshape(rows, columns), gray if most == 255 else gray * (255.0 / most)
    )


def _rest(file: BufferedReader, size: int) -> memoryview:
    """Return what is left of a file, read in pieces, between which Ctrl-C is answered."""
    room = np.empty(size, dtype=np.uint8).data
    read = 0
    while count := file.readinto(room[read : read + PIECE]):
        read += count
    return room[:read]


def _check_head(path: Path, rows: int, columns: int, most: int) -> None:
    if not (rows and columns):
        raise InvalidParameterError("image", "have pixels", Shown(f"{columns} x {rows} in {path.name}"))
    if rows * columns > MOST_CELLS:
        shown = Shown(f"{columns} x {rows} in {path.name}")
        raise InvalidParameterError("image", f"have at most {MOST_CELLS} pixels", shown)
    if not 1 <= most <= 255:
        raise InvalidParameterError("image", "have a maxval from 1 to 255", Shown(f"{most} in {path.name}"))


def _wrong_size(path: Path, rows: int, columns: int, found: str) -> InvalidParameterError:
    rule = f"have the {columns} x {rows} = {rows * columns} gray values that its head says"
    return InvalidParameterError("image", rule, Shown(f"{found} in {path.name}"))


def _bytes(path: Path, body: memoryview, rows: int, columns: int) -> npt.NDArray[np.uint8]:
    if len(body) != rows * columns:
        raise _wrong_size(path, rows, columns, f"{len(body)} bytes")
    return np.frombuffer(body, dtype=np.uint8)


def _words(path: Path, body: memoryview, rows: int, columns: int) -> npt.NDArray[np.int64]:
    found = re.sub(rb"#[^\n\r]*", b"", body).split()
    if len(found) != rows * columns:
        raise _wrong_size(path, rows, columns, f"{len(found)}")
    wrong = next((each for each in found if not each.isdigit() or len(each) > 6), None)
    if wrong is not None:
        shown = Shown(f"{wrong[:20]!r} in {path.name}")
        raise InvalidParameterError("image", "have whole gray values", shown)
    return np.array([int(each) for each in found], dtype=np.int64)
