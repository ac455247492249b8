"""Contents of files: bytes up to a bound, and text in the encodings that occur."""

from __future__ import annotations

import codecs
from os import PathLike

from hrsafety._arguments import readable
from hrsafety.errors import FileError, InvalidParameterError, Shown
from hrsafety.plausibility import ResultWarning

__all__ = ["MOST_BYTES", "decoded", "read_bytes"]

MOST_BYTES = 2**30
"""Largest file that is read."""
_MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"))


def read_bytes(path: str | PathLike[str], name: str = "path") -> bytes:
    """Return the contents of a file of at most 1 GiB.

    Parameters
    ----------
    path : path-like
        The file.
    name : str
        Argument that names it, for errors.

    Raises
    ------
    InvalidParameterError
        If there is no such file, or it cannot be read.
    FileError
        If it is larger than 1 GiB.
    """
    place = readable(name, path)
    try:
        with place.open("rb") as file:
            # One byte more than is read tells that there is more, also of files that grow.
            data = file.read(MOST_BYTES + 1)
    except OSError as error:
        raise InvalidParameterError(name, "name a readable file", Shown(f"{place} ({error.strerror})")) from None
    if len(data) > MOST_BYTES:
        found = Shown(f"{place.stat().st_size} bytes")
        raise FileError(place.name, "have at most 1 GiB", found, "cut it into parts", code="too_large")
    return data


def decoded(data: bytes, name: str) -> tuple[str, tuple[ResultWarning, ...]]:
    """Return bytes as text: UTF-8, UTF-16 with its mark, else Latin-1, which is told as ``assumed``.

    Line ends stay as they are: `Document.lines` divides the text at them.

    Parameters
    ----------
    data : bytes
        Contents of a file.
    name : str
        Name of the file.

    Returns
    -------
    text : str
        Without the mark.
    warnings : tuple of ResultWarning
        ``assumed`` for Latin-1.

    Raises
    ------
    FileError
        If the bytes are no text.
    """
    for mark, encoding in _MARKS:
        if data.startswith(mark):
            try:
                text = data[len(mark) :].decode(encoding)
            except UnicodeDecodeError as error:
                found = Shown(f"byte {error.object[error.start]:#04x} at {error.start + len(mark)}")
                raise FileError(name, f"be {encoding.upper()} as its first bytes say", found, code="no_text") from None
            return _without_null(text, name), ()
    try:
        return _without_null(data.decode("utf-8"), name), ()
    except UnicodeDecodeError as error:
        text = _without_null(data.decode("latin-1"), name)
        line = data.count(b"\n", 0, error.start) + 1
        message = f"{name} is no UTF-8 (line {line}, byte {data[error.start]:#04x}) and was read as Latin-1"
        return text, (ResultWarning("assumed", "encoding", message, safe_side=True),)


def _without_null(text: str, name: str) -> str:
    """Return text without null characters, which only binary files have."""
    place = text.find("\0")
    if place >= 0:
        line = text.count("\n", 0, place) + 1
        raise FileError(f"{name}, line {line}", "be text", Shown("a null character"), code="no_text")
    return text
