"""Files that are either written whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

__all__ = ["replacing", "write_file"]


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
        # A full disk fails a write, which knows no name; the temporary name helps nobody.
        if isinstance(error, OSError) and error.errno is not None and error.filename in (None, name):
            error.filename = str(path)
        raise
