"""What a result says of itself: a number that is missing needs a word why."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from typing import Any

import numpy as np

__all__ = ["missing_numbers", "says_why"]

_DEEPEST = 3
_WORDS = ("warnings", "status", "outcome", "governs")


def missing_numbers(result: object, path: str = "", depth: int = 0) -> set[str]:
    """Return the names of what is NaN in a result.

    Parameters
    ----------
    result : object
        What a function returned.
    path : str
        Its name.
    depth : int
        How deep it lies.

    Returns
    -------
    set of str
        Names from the outside in, with dots between them.
    """
    if isinstance(result, (float, np.floating)):
        return {path} if result != result else set()
    if isinstance(result, np.ndarray):
        return {path} if result.dtype.kind == "f" and np.isnan(result).any() else set()
    if depth >= _DEEPEST:
        return set()
    found: set[str] = set()
    for name, value in _parts(result):
        found |= missing_numbers(value, f"{path}.{name}" if path else name, depth + 1)
    return found


def _parts(result: object) -> Iterator[tuple[str, object]]:
    """Yield what a result is made of."""
    if isinstance(result, dict):
        yield from ((str(name), value) for name, value in result.items())
    elif hasattr(result, "_fields"):
        yield from zip(result._fields, result, strict=True)  # type: ignore[call-overload]  # a named tuple
    elif isinstance(result, (list, tuple)):
        yield from (("[]", value) for value in result[:50])
    elif dataclasses.is_dataclass(result):
        names = (field.name for field in dataclasses.fields(result))
        yield from ((name, getattr(result, name, None)) for name in names if not name.startswith("_"))


def says_why(result: Any) -> bool:
    """Return whether a result, or a part of it, has a status, an outcome or warnings."""
    parts = [result, *(value for _, value in _parts(result))]
    return any(np.size(getattr(part, word, ())) > 0 for part in parts for word in _WORDS)
