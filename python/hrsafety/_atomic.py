"""Files that are either written whole or not at all."""

from __future__ import annotations

import os
import struct
import tempfile
import threading
import time
import tokenize
import zipfile
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from hrsafety.errors import StorageError

__all__ = ["DAMAGE", "create_file", "only_writer", "replacing", "write_file"]

# What reading a damaged archive raises.
DAMAGE = (
    *(OSError, EOFError, ValueError, TypeError, KeyError, IndexError, AttributeError, SyntaxError, MemoryError),
    *(NotImplementedError, RuntimeError, OverflowError, struct.error, tokenize.TokenError),
    *(zipfile.BadZipFile, zlib.error),
)

# How often, and how long in s, a process waits for another one that removes a shared lock.
MOMENTS = 10
MOMENT = 0.02

# Folders that this process is writing into.
_WRITTEN: set[Path] = set()
_GUARD = threading.Lock()


def write_file(path: Path, content: bytes | str) -> Path:
    """Write a file in one step, so that a reader never sees half of it.

    Parameters
    ----------
    path : Path
        Where; its folder must exist.
    content : bytes or str
        What; text is encoded as UTF-8.

    Returns
    -------
    Path
        The same path.

    Raises
    ------
    OSError
        If the file cannot be written; nothing is left behind and an older file stays as it was.
    """
    with replacing(path) as file:
        file.write(content.encode("utf-8") if isinstance(content, str) else content)
    return path


@contextmanager
def replacing(path: Path, *, durable: bool = False) -> Iterator[BinaryIO]:
    """Open a file that takes the place of another when the block ends without an error.

    A link stays, and what it leads to is replaced. A device, such as ``/dev/stdout``, is written to as it comes.

    Parameters
    ----------
    path : Path
        Where; its folder must exist.
    durable : bool
        Whether the content is on the disk before the file gets its name, so that not even a
        power failure leaves a file that is there and damaged.

    Yields
    ------
    file
        Open for writing bytes.

    Raises
    ------
    OSError
        If the file cannot be written; nothing is left behind and an older file stays as it was.
    """
    if path.exists() and not (path.is_file() or path.is_dir()):
        try:
            with path.open("wb") as device:
                yield device
        except OSError as error:  # a full one fails a write, which knows no name
            error.filename = str(path)
            raise
        return
    if path.is_symlink():
        path = path.resolve()
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    except OSError as error:
        error.filename = str(path)
        raise
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            yield file
            if durable:
                file.flush()
                os.fsync(file.fileno())
        temporary.chmod(0o644)
        temporary.replace(path)
    except BaseException as error:
        temporary.unlink(missing_ok=True)
        # A full disk fails a write, which knows no name; the temporary name is no help.
        if isinstance(error, OSError) and error.errno is not None and error.filename in (None, name):
            error.filename = str(path)
        raise


def create_file(path: Path, content: str) -> None:
    """Write a file in one step unless it exists; of several processes one does.

    Parameters
    ----------
    path : Path
        Where; its folder must exist.
    content : str
        What, encoded as UTF-8; on the disk before the file gets its name.
    """
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content.encode("utf-8"))
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        try:
            os.link(temporary, path)
        except FileExistsError:
            return
        except OSError:  # a file system without links
            if not path.exists():
                temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def only_writer(lock: Path, error: Callable[[str], Exception], part: tuple[int, int] | None = None) -> Iterator[None]:
    """Keep other runs from writing what a lock stands for; the system frees it when a process dies.

    Parameters
    ----------
    lock : Path
        File that is locked, and removed at the end; its folder must exist.
    error : callable
        Makes the exception from a sentence when another run is writing.
    part : tuple of int, or None
        First and number of the parts that are written, if processes may share the rest; all when ``None``.

    Yields
    ------
    None
        While the file is locked.
    """
    own = lock.parent.resolve() / lock.name
    with _GUARD:
        # A lock of the system is one of the process: its own threads are told apart here.
        if own in _WRITTEN:
            raise error(f"another run of this process is writing into {lock.parent}")
        _WRITTEN.add(own)
    try:
        with _held(lock, part) as file:
            if file is None:
                what = "" if part is None else f" some of the chunks {part[0]}:{part[0] + part[1]}"
                raise error(f"another process is writing{what} into {lock.parent}")
            try:
                yield
            finally:
                # The file stays while other processes hold parts of it: they lock the same file. Of two that end
                # together neither would have all of it with its own part still held.
                _unlocked(file, part)
                if part is None or _locked(file, None):
                    with suppress(OSError):
                        lock.unlink()
    finally:
        _WRITTEN.discard(own)


@contextmanager
def _held(lock: Path, part: tuple[int, int] | None) -> Iterator[BinaryIO | None]:
    """Yield the locked file, ``None`` if another process holds it."""
    while True:
        with _opened(lock) as file:
            if not _locked_in_time(file, part):
                yield None
                return
            # Another run may have ended, and removed the file, since it was opened.
            if os.fstat(file.fileno()).st_nlink > 0:
                yield file
                return


def _opened(lock: Path) -> BinaryIO:
    try:
        return lock.open("wb")
    except OSError as error:
        remedy = "choose a folder that can be written"
        raise StorageError(lock, error, kept="all that was there", remedy=remedy) from None


def _locked_in_time(file: BinaryIO, part: tuple[int, int] | None) -> bool:
    """Lock a file as `_locked`; of a shared one a process that ends holds all for a moment, which is waited for."""
    locked = _locked(file, part)
    for _ in range(0 if part is None else MOMENTS):
        if locked:
            break
        time.sleep(MOMENT)
        locked = _locked(file, part)
    return locked


def _unlocked(file: BinaryIO, part: tuple[int, int] | None) -> None:
    """Free a part of a file; what is locked as a whole stays so until it is closed."""
    with suppress(ModuleNotFoundError, OSError):
        import fcntl

        if part is not None:
            fcntl.lockf(file, fcntl.LOCK_UN, part[1], part[0])


def _locked(file: BinaryIO, part: tuple[int, int] | None) -> bool:
    """Lock a file, or a part of it, until it is closed, where the system can; whether no other process holds it."""
    try:
        import fcntl
    except ModuleNotFoundError:  # files are still written whole or not at all
        return True
    try:
        # A byte stands for each part, which need not exist in the file; a length of 0 is all of them.
        first, length = (0, 0) if part is None else part
        fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB, length, first)
        return True
    except (BlockingIOError, PermissionError):
        return False
    except OSError:
        return True  # a file system without locks
