"""Gray pictures in PGM, plain and raw."""

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

__all__ = ["GrayImage", "check_size", "read_pgm"]

HEAD_BYTES = 1 << 16
PIECE = 1 << 24  # bytes that are read at once
BYTES_OF_NUMBER = 16  # of a gray value in words with what stands around it
MOST_GRAY = 65535
# Between the words of the head stand blanks and comments that end with their line.
_GAP = rb"(?:\s|#[^\n\r]*[\n\r])+"
_HEAD = rb"(P[25])" + _GAP + rb"(\d{1,10})" + _GAP + rb"(\d{1,10})" + _GAP + rb"(\d{1,6})(?:\r\n|\s|(?=#))"


class GrayImage(NamedTuple):
    """Gray values as they stand in a file.

    Attributes
    ----------
    values : ndarray of int, shape (rows, columns)
        First row on top.
    most : int
        The value of white.
    hidden : ndarray of bool, shape (rows, columns), or None
        Where the picture is not opaque.
    spare : int
        Bytes after the last gray value.
    """

    values: npt.NDArray[np.integer]
    most: int
    hidden: npt.NDArray[np.bool_] | None = None
    spare: int = 0


def check_size(path: Path, rows: int, columns: int) -> None:
    """Refuse a picture without pixels or with too many, before memory is taken."""
    if not (rows and columns):
        raise InvalidParameterError("image", "have pixels", Shown(f"{columns} x {rows} in {path.name}"))
    if rows * columns > MOST_CELLS:
        shown = Shown(f"{columns} x {rows} in {path.name}")
        raise InvalidParameterError("image", f"have at most {MOST_CELLS} pixels", shown)


def read_pgm(path: Path) -> GrayImage:
    """Return the gray values of a picture; one byte each, or two, the higher one first, above 255."""
    with path.open("rb") as file:
        head = re.match(_HEAD, file.read(HEAD_BYTES))
        if head is None:
            file.seek(0)
            shown = Shown(f"{path.name}, which begins with {file.read(2)!r}")
            raise InvalidParameterError("image", "have the head of a PGM picture", shown)
        kind, (columns, rows, most) = head[1], map(int, head.groups()[1:])
        check_size(path, rows, columns)
        if not 1 <= most <= MOST_GRAY:
            raise InvalidParameterError(
                "image", f"have a maxval from 1 to {MOST_GRAY}", Shown(f"{most} in {path.name}")
            )
        begin, cells = head.end(), rows * columns
        needed = cells * (1 if most < 256 else 2)
        size = path.stat().st_size - begin
        if kind == b"P5" and size == needed - 1 and head[0].endswith(b"\r\n"):
            begin, size = begin - 1, needed  # a single CR ends the head, and the first pixel is the LF
        if kind == b"P2" and size > cells * BYTES_OF_NUMBER + HEAD_BYTES:
            raise _wrong_size(path, rows, columns, f"{size} bytes")
        file.seek(begin)
        body = _rest(file, min(size, needed) if kind == b"P5" else size)
    if kind == b"P2":
        values, spare = _words(path, body, rows, columns)
    else:
        if len(body) < needed:
            raise _wrong_size(path, rows, columns, f"{len(body) // (needed // cells)}")
        spare = size - needed
        values = np.frombuffer(body, dtype=np.uint8 if most < 256 else ">u2")
    if int(values.max()) > most:
        shown = Shown(f"{int(values.max())} in {path.name}")
        raise InvalidParameterError("image", f"have gray values up to its maxval, {most}", shown)
    return GrayImage(values.reshape(rows, columns), most, spare=spare)


def _rest(file: BufferedReader, size: int) -> memoryview:
    """Return what is left of a file, read in pieces, between which Ctrl-C is answered."""
    room = np.empty(size, dtype=np.uint8).data
    read = 0
    while count := file.readinto(room[read : read + PIECE]):
        read += count
    return room[:read]


def _wrong_size(path: Path, rows: int, columns: int, found: str) -> InvalidParameterError:
    rule = f"have the {columns} x {rows} = {rows * columns} gray values that its head says"
    return InvalidParameterError("image", rule, Shown(f"{found} in {path.name}"))


def _words(path: Path, body: memoryview, rows: int, columns: int) -> tuple[npt.NDArray[np.integer], int]:
    """Return gray values written as words, and how many bytes stand after them."""
    found = re.sub(rb"#[^\n\r]*", b"", body).split()
    if len(found) < rows * columns:
        raise _wrong_size(path, rows, columns, f"{len(found)}")
    needed, spare = found[: rows * columns], found[rows * columns :]
    wrong = next((each for each in needed if not each.isdigit() or len(each) > 5), None)
    if wrong is not None:
        shown = Shown(f"{wrong[:20]!r} in {path.name}")
        raise InvalidParameterError("image", "have whole gray values", shown)
    return np.array([int(each) for each in needed], dtype=np.int64), sum(map(len, spare))
