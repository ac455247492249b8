"""Files that are either written whole or not at all."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

__all__ = ["write_file"]


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
    data = content.encode("utf-8") if isinstance(content, str) else content
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        temporary.chmod(0o644)
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    return path
