"""The folder of a sweep: a manifest, and one checked file for each finished chunk."""

from __future__ import annotations

import contextlib
import dataclasses
import datetime
import json
import os
import platform
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._atomic import DAMAGE, create_file, only_writer, replacing
from hrsafety.errors import HrsafetyError, InvalidParameterError, StorageError
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep.axes import Column
from hrsafety.sweep.chunk_files import chunk_files
from hrsafety.sweep.identity import differences, fingerprint

__all__ = ["Folder", "Memory", "SweepError", "locked", "new_manifest"]

Stored = dict[str, npt.NDArray[Any]]

MANIFEST = "sweep.json"
CHUNKS = "chunks"
LOCK = ".lock"
# Format of a manifest by the files of its chunks.
FORMATS = {"npz": 1, "parquet": 2}
# Differences that an error names at most.
MOST_NAMED = 4


class SweepError(HrsafetyError):
    """A sweep cannot be continued: its folder is another one or damaged, a worker died, or a function raised."""


def new_manifest(
    settings: Mapping[str, Any], warnings: Iterable[ResultWarning] = (), store: str | None = None
) -> dict[str, Any]:
    """Return the manifest of a sweep that begins now; only ``settings`` is ever compared."""
    files = {} if store in {None, "npz"} else {"store": store}
    return {
        "format": FORMATS[store or "npz"],
        **files,
        "fingerprint": fingerprint(settings),
        "settings": dict(settings),
        "warnings": [dataclasses.asdict(each) for each in warnings],
        "created": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "environment": {"python": platform.python_version(), "numpy": np.__version__, "system": platform.platform()},
    }


class Memory:
    """Chunks of a sweep without a folder."""

    def __init__(self, manifest: Mapping[str, Any]) -> None:
        self.manifest = dict(manifest)
        self.chunks: dict[int, Stored] = {}

    def finished(self) -> list[int]:
        """Return the chunks that are there."""
        return sorted(self.chunks)

    def write(self, index: int, columns: Stored) -> None:
        """Keep a chunk."""
        self.chunks[index] = columns

    def read(self, index: int, names: tuple[str, ...]) -> Stored:
        """Return columns of a chunk."""
        return {name: self.chunks[index][name] for name in names}


class Folder:
    """Chunks of a sweep in a folder.

    Parameters
    ----------
    path : Path
        The folder; it holds a manifest.

    Raises
    ------
    SweepError
        If it holds none, or one of another format.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.manifest = _manifest(path / MANIFEST)
        self.files = chunk_files(self.manifest.get("store", "npz"), stored_columns(self.manifest["settings"]))

    @classmethod
    def prepared(cls, path: Path, manifest: Mapping[str, Any], *, resume: bool, store: str | None = None) -> Folder:
        """Return the folder of a sweep, new or to be resumed.

        Parameters
        ----------
        path : Path
            The folder.
        manifest : mapping
            Of the sweep that is about to run.
        resume : bool
            Whether a sweep that is there may be resumed.
        store : str or None
            Files of the chunks that are asked for; any when ``None``.

        Returns
        -------
        Folder
            With the manifest that was there first.

        Raises
        ------
        SweepError
            If the folder belongs to another sweep, or to any and resume is off.
        """
        # Chunks come after the manifest: whoever sees some sees it, too.
        if (path / CHUNKS).exists() and not (path / MANIFEST).exists():
            raise SweepError(f"{path} holds chunks but no {MANIFEST}: nothing tells which sweep they belong to")
        if (path / MANIFEST).exists():
            if not resume:
                raise SweepError(f"{path} holds a sweep already; resume it or choose another folder")
        else:
            chunk_files(store or "npz", ())
            create_file(path / MANIFEST, json.dumps(manifest, indent=1, ensure_ascii=False) + "\n")
        folder = cls(path)
        _same(path, folder.manifest, manifest)
        if store not in {None, folder.files.name}:
            raise SweepError(
                f"{path} holds chunks in {folder.files.name} files, not {store}; leave store out to resume"
            )
        (path / CHUNKS).mkdir(exist_ok=True)
        _settle(path)
        return folder

    def file(self, index: int) -> Path:
        """Return the file of a chunk."""
        return self.path / CHUNKS / f"chunk-{index:08d}{self.files.suffix}"

    def finished(self) -> list[int]:
        """Return the chunks whose files are there, unchecked."""
        found = (self.path / CHUNKS).glob(f"chunk-*{self.files.suffix}")
        names = (path.stem.removeprefix("chunk-") for path in found)
        return sorted(int(name) for name in names if name.isdecimal())

    def damaged(self, index: int) -> bool:
        """Return whether a chunk file is not what was written: every byte of it is read."""
        try:
            self.files.check(self.file(index))
            self.read(index, tuple(self.files.columns))
        except (*DAMAGE, SweepError):
            return True
        return False

    def write(self, index: int, columns: Stored) -> None:
        """Write a chunk: on the disk before it has its name."""
        try:
            with replacing(self.file(index), durable=True) as file:
                self.files.write(file, self._mark(index), columns)
        except OSError as error:
            kept = f"{len(self.finished())} finished chunks in {self.path}"
            remedy = "make room and run the same sweep again: it resumes there"
            raise StorageError(self.file(index), error, kept=kept, remedy=remedy) from None
        _settle(self.path / CHUNKS)

    def read(self, index: int, names: tuple[str, ...]) -> Stored:
        """Return columns of a chunk, their checksums compared.

        Raises
        ------
        SweepError
            If the file is missing, damaged, or of another sweep.
        """
        try:
            mark, found = self.files.read(self.file(index), names)
        except DAMAGE as error:
            raise SweepError(f"{self.file(index)} is damaged ({error}); run the sweep again to renew it") from None
        if mark != self._mark(index):
            raise SweepError(f"{self.file(index)} belongs to another chunk or sweep; run the sweep again to renew it")
        return found

    def _mark(self, index: int) -> str:
        return f"{self.manifest['fingerprint']} {index}"

    def clear_leftovers(self, chunks: range) -> None:
        """Remove temporary files of a run that was killed; these chunks must be locked."""
        for path in (self.path / CHUNKS).glob(".chunk-*"):
            number = path.name.split(".")[1].removeprefix("chunk-")
            if number.isdecimal() and int(number) in chunks:
                path.unlink(missing_ok=True)


@contextlib.contextmanager
def locked(path: Path, chunks: range | None = None) -> Iterator[None]:
    """Keep other runs from writing into a folder; the system frees it when a process dies.

    Parameters
    ----------
    path : Path
        The folder; made if it does not exist.
    chunks : range or None
        What is written, if other runs may write the rest; all when ``None``.

    Raises
    ------
    SweepError
        If another run is writing.
    InvalidParameterError
        If path is no folder.
    """
    if path.exists() and not path.is_dir():
        raise InvalidParameterError("out", "be a folder or not exist", str(path))
    path.mkdir(parents=True, exist_ok=True)
    part = None if chunks is None else (chunks.start, len(chunks))
    # A share without a chunk writes nothing.
    with contextlib.nullcontext() if chunks == range(0) else only_writer(path / LOCK, SweepError, part):
        yield


def _settle(folder: Path) -> None:
    """Bring the names of a folder to the disk, where the system can."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _manifest(path: Path) -> dict[str, Any]:
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise SweepError(f"{path.parent} holds no sweep: {path.name} is missing") from None
    except (OSError, ValueError) as error:
        raise SweepError(f"{path} cannot be read: {error}") from None
    known = isinstance(found, dict) and FORMATS.get(str(found.get("store", "npz"))) == found.get("format")
    if not known:
        formats = " or ".join(str(each) for each in FORMATS.values())
        raise SweepError(f"{path} is not the manifest of a sweep in format {formats}")
    manifest: dict[str, Any] = found
    if fingerprint(manifest.get("settings", {})) != manifest.get("fingerprint"):
        raise SweepError(f"{path} was changed: its settings do not have its fingerprint")
    return manifest


def _same(path: Path, there: Mapping[str, Any], asked: Mapping[str, Any]) -> None:
    """Raise unless a folder belongs to the sweep that is asked for, naming what differs."""
    if there["fingerprint"] == asked["fingerprint"]:
        return
    found = list(differences(there["settings"], json.loads(json.dumps(asked["settings"]))))
    named = [f"{name} is {_short(old)} there and {_short(new)} here" for name, old, new in found[:MOST_NAMED]]
    more = f", and {len(found) - MOST_NAMED} more" if len(found) > MOST_NAMED else ""
    raise SweepError(f"{path} holds another sweep: {'; '.join(named)}{more}")


def _short(value: object) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 60 else f"{text[:57]}..."


def stored_columns(settings: Mapping[str, Any]) -> tuple[Column, ...]:
    """Return all columns of a sweep from its settings."""
    return tuple(Column(**{**each, "words": tuple(each["words"])}) for each in settings["columns"])
