"""Checkpoints of a search for gains: written whole, refused for other settings."""

from __future__ import annotations

import dataclasses
import io
import json
from collections.abc import Iterator
from contextlib import AbstractContextManager
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

import hrsafety
from hrsafety._atomic import DAMAGE, only_writer, write_file
from hrsafety.errors import FolderInUseError, InvalidParameterError, Shown, StorageError
from hrsafety.navigation.gains.settings import SearchSettings

__all__ = ["Checkpoint"]

# Changes with the meaning of what a checkpoint holds.
FORMAT = "hrsafety gain search 1"
# Larger arrays are compared by their digest.
SHOWN = 16


class Checkpoint:
    """A file that holds how far a search has come, and the settings that it belongs to.

    Parameters
    ----------
    path : str or path-like
        The file, an NPZ archive; its folder must exist.
    settings : SearchSettings
        Settings of the search.

    Raises
    ------
    InvalidParameterError
        If the path is not one, or its folder does not exist.
    """

    def __init__(self, path: str | PathLike[str], settings: SearchSettings) -> None:
        if not isinstance(path, (str, PathLike)):
            raise InvalidParameterError("checkpoint", "be a path or None", path)
        self.path = Path(path)
        if not self.path.parent.is_dir():
            raise InvalidParameterError("checkpoint", "be in a folder that exists", str(path))
        self.settings = dict(described("settings", settings))

    def alone(self) -> AbstractContextManager[None]:
        """Keep other searches from writing the same file."""
        return only_writer(self.path.with_name(f".{self.path.name}.lock"), FolderInUseError)

    def save(self, state: bytes) -> None:
        """Write the state of the search; an older file is replaced in one step."""
        content = io.BytesIO()
        about = {"format": FORMAT, "version": hrsafety.__version__, "settings": self.settings}
        np.savez(
            content,
            about=np.frombuffer(json.dumps(about).encode("utf-8"), dtype=np.uint8),
            state=np.frombuffer(state, dtype=np.uint8),
        )
        try:
            write_file(self.path, content.getvalue())
        except OSError as error:
            kept = f"{self.path} still holds the last state that was written" if self.path.exists() else "nothing"
            raise StorageError(
                self.path, error, kept=kept, remedy="make room and start the same search with the same checkpoint"
            ) from None

    def load(self) -> bytes | None:
        """Return the state in the file; ``None`` without a file.

        Raises
        ------
        InvalidParameterError
            If the file is not a checkpoint, or is one of other settings, which are named.
        """
        if not self.path.exists():
            return None
        try:
            content = self.path.read_bytes()
        except OSError as error:
            rule = f"be a readable file ({error.strerror})"
            raise InvalidParameterError("checkpoint", rule, str(self.path)) from None
        try:
            with np.load(io.BytesIO(content), allow_pickle=False) as archive:
                about: dict[str, Any] = json.loads(archive["about"].tobytes())
                state: bytes = archive["state"].tobytes()
            known, version, settings = about["format"], about["version"], dict(about["settings"])
        except DAMAGE:
            rule = "be a checkpoint of a gain search"
            remedy = "it is damaged or another file: remove it to start over"
            raise InvalidParameterError("checkpoint", rule, str(self.path), remedy) from None
        if known != FORMAT or version != hrsafety.__version__:
            raise InvalidParameterError(
                "checkpoint",
                f"be of version {hrsafety.__version__} of the package ({FORMAT})",
                Shown(f"{version} ({known})"),
            )
        self._compare(settings)
        return state

    def _compare(self, settings: dict[str, str]) -> None:
        for key in [*self.settings, *settings]:
            own, other = self.settings.get(key, "not given"), settings.get(key, "not given")
            if own != other:
                name = key.removeprefix("settings.")
                raise InvalidParameterError("checkpoint", f"be of the same settings: {name} is {own} now", other)


def described(name: str, value: object) -> Iterator[tuple[str, str]]:
    """Yield every number and word in a value, each with the path that leads to it."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        yield name, type(value).__name__
        for entry in dataclasses.fields(value):
            if not entry.name.startswith("_"):
                yield from described(f"{name}.{entry.name}", getattr(value, entry.name))
    elif isinstance(value, np.ndarray):
        yield name, array_words(value)
    elif isinstance(value, (tuple, list)):
        yield f"{name} (length)", str(len(value))
        for index, entry in enumerate(value):
            yield from described(f"{name}[{index}]", entry)
    elif callable(value):
        # Two callables of one name cannot be told apart.
        yield name, f"{getattr(value, '__module__', '')}.{getattr(value, '__qualname__', type(value).__qualname__)}"
    else:
        yield name, repr(value)


def array_words(array: np.ndarray[Any, np.dtype[Any]]) -> str:
    """Return the values of a small array, shape and digest of a large one."""
    if array.size <= SHOWN:
        return repr(array.tolist())
    import hashlib

    digest = hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()
    return f"array of shape {array.shape}, digest {digest[:16]}"
