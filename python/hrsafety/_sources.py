"""Where something was read from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Any

from hrsafety._display import displayed
from hrsafety._records import dataclass

__all__ = ["Provenance"]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class Provenance:
    """Where something was read from.

    Attributes
    ----------
    path : str
        The file or folder as it was given.
    format : str
        Name of the reader, or of the columns of a file that has no header.
    sha256 : str
        Digest of the file, in hexadecimal digits; of several files, that of their digests in the order of their names.
    arguments : mapping of str to object
        What the caller said beside the file, only what differs from the defaults.
    """

    path: str
    format: str
    sha256: str
    arguments: Mapping[str, Any] = field(default_factory=dict)
