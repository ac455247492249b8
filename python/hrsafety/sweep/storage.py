"""The folder of a sweep: a manifest, and one checked file for each finished chunk."""

from __future__ import annotations

import contextlib
import dataclasses
import datetime
import json
import os
import platform
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from hrsafety._atomic import DAMAGE, only_writer, replacing
from hrsafety.errors import HrsafetyError, InvalidParameterError, StorageError
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep.axes import Column
from hrsafety.sweep.identity import differences, fingerprint

__all__ = ["Folder", "Memory", "SweepError", "locked", "new_manifest"]

Stored = dict[str, npt.NDArray[Any]]

MANIFEST = "sweep.json"
CHUNKS = "chunks"
LOCK = ".lock"
FORMAT = 1
# Member of a chunk file that says which chunk of which sweep it is; no column has such a name.
MARK = "_chunk"
PIECE = 1 << 20
# Length of the record at the end of an archive without a comment.
END_RECORD = 22
# Differences that an error names at most.
MOST_NAMED = 4


class SweepError(HrsafetyError):
    """A sweep cannot be resumed: its folder belongs to another one, is damaged, or a worker died."""


def new_manifest(settings: Mapping[str, Any], warnings: Iterable[ResultWarning] = ()) -> dict[str, Any]:
    """Return the manifest of a sweep that begins now; only ``settings`` is ever compared."""
    return {
        "format": FORMAT,
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

    @classmethod
    def prepared(cls, path: Path, manifest: Mapping[str, Any], *, resume: bool) -> Folder:
        """Return the folder of a sweep, new or to be resumed.

        Parameters
        ----------
        path : Path
            The folder.
        manifest : mapping
            Of the sweep that is about to run.
        resume : bool
            Whether a sweep that is there may be resumed.

        Returns
        -------
        Folder
            With the manifest that was there first.

        Raises
        ------
        SweepError
            If the folder belongs to another sweep, or to any and resume is off.
        """
        if (path / MANIFEST).exists():
            folder = cls(path)
            if not resume:
                raise SweepError(f"{path} holds a sweep already; resume it or choose another folder")
            _same(path, folder.manifest, manifest)
            (path / CHUNKS).mkdir(exist_ok=True)
            return folder
        if (path / CHUNKS).exists():
            raise SweepError(f"{path} holds chunks but no {MANIFEST}: nothing tells which sweep they belong to")
        text = json.dumps(manifest, indent=1, ensure_ascii=False) + "\n"
        with replacing(path / MANIFEST, durable=True) as file:
            file.write(text.encode("utf-8"))
        (path / CHUNKS).mkdir(exist_ok=True)
        _settle(path)
        return cls(path)

    def file(self, index: int) -> Path:
        """Return the file of a chunk."""
        return self.path / CHUNKS / f"chunk-{index:08d}.npz"

    def finished(self) -> list[int]:
        """Return the chunks whose files are there, unchecked."""
        names = (path.stem.removeprefix("chunk-") for path in (self.path / CHUNKS).glob("chunk-*.npz"))
        return sorted(int(name) for name in names if name.isdecimal())

    def damaged(self, index: int) -> bool:
        """Return whether a chunk file is not what was written: every byte of it is read."""
        try:
            with self.file(index).open("rb") as file, zipfile.ZipFile(file) as archive:
                for name in archive.namelist():
                    with archive.open(name) as member:
                        while member.read(PIECE):
                            pass
            self.read(index, tuple(each["name"] for each in self.manifest["settings"]["columns"]))
        except DAMAGE:
            return True
        except SweepError:
            return True
        return False

    def write(self, index: int, columns: Stored) -> None:
        """Write a chunk: on the disk before it has its name."""
        try:
            with replacing(self.file(index), durable=True) as file:
                write_archive(file, {MARK: self._mark(index), **columns})
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
            found = read_archive(self.file(index), (MARK, *names))
        except DAMAGE as error:
            raise SweepError(f"{self.file(index)} is damaged ({error}); run the sweep again to renew it") from None
        if str(found.pop(MARK)) != str(self._mark(index)):
            raise SweepError(f"{self.file(index)} belongs to another chunk or sweep; run the sweep again to renew it")
        return found

    def _mark(self, index: int) -> npt.NDArray[np.str_]:
        return np.array(f"{self.manifest['fingerprint']} {index}")

    def clear_leftovers(self) -> None:
        """Remove temporary files of a run that was killed; the folder must be locked."""
        for path in (self.path / CHUNKS).glob(".chunk-*"):
            path.unlink(missing_ok=True)


@contextlib.contextmanager
def locked(path: Path) -> Iterator[None]:
    """Keep other runs from writing into a folder; the system frees it when a process dies.

    Parameters
    ----------
    path : Path
        The folder; made if it does not exist.

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
    with only_writer(path / LOCK, SweepError):
        yield


def write_archive(file: BinaryIO, columns: Mapping[str, npt.NDArray[Any]]) -> None:
    """Write arrays as an uncompressed NPZ archive: the same bytes for the same arrays."""
    with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        for name, array in columns.items():
            with archive.open(zipfile.ZipInfo(f"{name}.npy"), "w", force_zip64=True) as member:
                np.lib.format.write_array(member, array, allow_pickle=False)


def read_archive(path: Path, names: tuple[str, ...]) -> Stored:
    """Return arrays of an NPZ archive, every byte of them compared with its checksum."""
    found = {}
    with path.open("rb") as file, zipfile.ZipFile(file) as archive:
        for name in names:
            with archive.open(f"{name}.npy") as member:
                found[name] = np.lib.format.read_array(member, allow_pickle=False)
                if member.read(1):
                    raise ValueError("bytes behind an array")
        _check_end(file, archive)
    return found


def _check_end(file: BinaryIO, archive: zipfile.ZipFile) -> None:
    """Raise unless an archive fills its file: members at their places, nothing behind the end."""
    size = file.seek(0, os.SEEK_END)
    behind = len(archive.comment)
    file.seek(max(size - END_RECORD - behind, 0))
    first = min((member.header_offset for member in archive.infolist()), default=0)
    if behind or first or file.read(4) != b"PK\x05\x06":
        raise ValueError("bytes before or behind the archive")


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
    if not isinstance(found, dict) or found.get("format") != FORMAT:
        raise SweepError(f"{path} is not the manifest of a sweep in format {FORMAT}")
    if fingerprint(found.get("settings", {})) != found.get("fingerprint"):
        raise SweepError(f"{path} was changed: its settings do not have its fingerprint")
    return found


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
