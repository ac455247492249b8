"""The one list of readers: what recognizes a file by its contents, and what reads it."""

from __future__ import annotations

import hashlib
import importlib
import re
from collections.abc import Callable
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any

from hrsafety._arguments import word
from hrsafety._records import dataclass
from hrsafety._sources import Provenance
from hrsafety._text import decoded, read_bytes
from hrsafety.errors import FileError
from hrsafety.plausibility import ResultWarning

__all__ = ["READERS", "Document", "Provenance", "Reader", "reader_of", "readers"]

READERS: dict[str, tuple[str, ...]] = {
    "people": (
        "hrsafety.io.people.databases",
        "hrsafety.io.people.hdf5",
        "hrsafety.io.people.scenes",
        "hrsafety.io.people.splines",
        "hrsafety.io.people.mocap",
        "hrsafety.io.people.juelich",
        "hrsafety.io.people.drones",
        "hrsafety.io.people.bare",
        "hrsafety.io.people.tables",
    ),
    "log": ("hrsafety.io.logs.load",),
    "map": ("hrsafety.io.places.maps",),
    "scene": ("hrsafety.io.places.scenes",),
}
"""Modules of the readers of each kind of file, in the order in which they are asked; each has a list ``READERS``."""

HEAD = 65536
"""Bytes by which a file is recognized."""


class Document:
    """A file as readers see it, read once.

    Parameters
    ----------
    path : path-like
        The file.
    argument : str
        Name of the argument that named it.
    """

    def __init__(self, path: str | PathLike[str], argument: str = "path") -> None:
        self.data = read_bytes(path, argument)
        self.path = Path(path)
        self.name = self.path.name
        self.warnings: list[ResultWarning] = []

    @property
    def head(self) -> bytes:
        """First bytes of the file."""
        return self.data[:HEAD]

    @cached_property
    def sha256(self) -> str:
        """Digest of the file in hexadecimal digits."""
        return hashlib.sha256(self.data).hexdigest()

    @cached_property
    def text(self) -> str:
        """The file as text; what was assumed of its encoding is added to ``warnings``."""
        text, told = decoded(self.data, self.name)
        self.warnings.extend(told)
        return text

    @cached_property
    def plain(self) -> bytes:
        """The text as UTF-8 without a mark, lines ended by line feeds."""
        text = self.text
        data = self.data if len(self.data) == len(text) and text.isascii() else text.encode("utf-8")
        return data.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in data else data

    @cached_property
    def first_lines(self) -> list[str]:
        """Lines of the first 64 KiB, by which files are recognized; of a longer file the last may be cut."""
        return self.plain[:HEAD].decode("utf-8", "replace").split("\n")

    @cached_property
    def lines(self) -> list[str]:
        """Lines of the text without their ends."""
        return re.split("\r\n?|\n", self.text)

    def error(
        self,
        code: str,
        rule: str,
        value: object,
        remedy: str | None = None,
        *,
        line: int | None = None,
        key: str | None = None,
    ) -> FileError:
        """Return an error about a place in the file.

        Parameters
        ----------
        code : str
            Kind of error.
        rule : str
            What must hold, after "must".
        value : object
            What stands there; `errors.Shown` for words.
        remedy : str or None
            What would mend it.
        line : int or None
            Number of the line, from 1.
        key : str or None
            Key, column or topic.
        """
        where = [self.name, *([f"line {line}"] if line is not None else []), *([key] if key is not None else [])]
        return FileError(", ".join(where), rule, value, remedy, code=code)


@dataclass(frozen=True, kw_only=True, slots=True)
class Reader:
    """A format: its name, what recognizes it and what reads it.

    Attributes
    ----------
    name : str
        What the argument ``format`` calls it.
    title : str
        What lists of formats say about it.
    recognizes : callable
        Returns from a `Document` whether it is of this format. Looks at contents, not at names.
    read : callable
        Returns what the file holds, from a `Document` and keywords of its kind; raises `FileError`.
    """

    name: str
    title: str
    recognizes: Callable[[Document], bool]
    read: Callable[..., Any]


def readers(kind: str) -> list[Reader]:
    """Return the readers of a kind of file in the order in which they are asked."""
    return [reader for module in READERS[kind] for reader in importlib.import_module(module).READERS]


def reader_of(kind: str, document: Document, form: str | None = None) -> Reader:
    """Return the reader of a file, by its contents or by the name that was given.

    Parameters
    ----------
    kind : str
        Key of `READERS`.
    document : Document
        The file.
    form : str or None
        Name of the format if the caller knows it.

    Raises
    ------
    FileError
        If no reader knows the file (``unknown_format``).
    InvalidParameterError
        If no reader has the name.
    """
    known = readers(kind)
    if form is not None:
        word("format", form, [reader.name for reader in known])
        return next(reader for reader in known if reader.name == form)
    for reader in known:
        if reader.recognizes(document):
            return reader
    first = document.head[:40].decode("utf-8", "replace")
    names = ", ".join(reader.name for reader in known)
    raise document.error("unknown_format", f"be of a known format ({names})", first, "name it with format=")
