"""Checks of the keys of a scenario file: each value has one kind, each table known keys."""

from __future__ import annotations

import reprlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from types import MappingProxyType
from typing import Any

from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = [
    "Keys",
    "Kind",
    "boolean",
    "checked",
    "integer",
    "located",
    "number",
    "numbers",
    "pair",
    "pairs",
    "segments",
    "shown",
    "table",
    "tables",
    "triple",
    "word",
    "words",
]

Kind = Callable[[str, Any], Any]
Keys = Mapping[str, Kind]


def shown(value: object) -> object:
    """Return a value as it goes into a message: short, whatever it is."""
    if isinstance(value, (bool, float)):
        return value
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, int) and abs(value) >= 10**30:
        return f"an integer of {value.bit_length()} bits"
    if isinstance(value, list) and len(value) > 6:
        return f"an array of {len(value)} values"
    try:
        return reprlib.repr(value)
    except ValueError:
        return "a number with too many digits"


def join(path: str, key: str) -> str:
    """Return the path of a key in a table."""
    return f"{path}.{key}" if path else key


@contextmanager
def located(path: str) -> Iterator[None]:
    """Put the path of a table before the argument that an error names."""
    try:
        yield
    except InvalidParameterError as error:
        short = isinstance(error.value, str) and len(error.value) <= 80
        value = error.value if short else shown(error.value)
        raise InvalidParameterError(join(path, error.argument), error.requirement, value) from None
    except ShapeError as error:
        given = f"an array of shape {error.actual}"
        raise InvalidParameterError(join(path, error.argument), f"have shape {error.expected}", given) from None


def checked(path: str, given: Any, keys: Keys, *, required: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return the values of a table, every key known and every value of its kind.

    Parameters
    ----------
    path : str
        Where the table stands in the file; empty for the file itself.
    given : dict
        As read.
    keys : mapping of str to Kind
        Known keys.
    required : tuple of str
        Keys that must be there.

    Returns
    -------
    dict
        Values, converted.

    Raises
    ------
    InvalidParameterError
        Naming the path of the key.
    """
    table(path, given)
    for key in given:
        if key not in keys:
            raise InvalidParameterError(
                join(path, reprlib.repr(key)[1:-1]), f"be one of the keys {', '.join(keys)}", "an unknown key"
            )
    for key in required:
        if key not in given:
            raise InvalidParameterError(join(path, key), "be given", "nothing")
    return {key: keys[key](join(path, key), value) for key, value in given.items()}


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def number(path: str, value: Any) -> float:
    """Check a number."""
    if not _is_number(value):
        raise InvalidParameterError(path, "be a number", shown(value))
    try:
        return float(value)
    except OverflowError:
        raise InvalidParameterError(path, "be a number that fits 64 bits", shown(value)) from None


def integer(path: str, value: Any) -> int:
    """Check an integer."""
    if not isinstance(value, int) or isinstance(value, bool) or abs(value) >= 2**64:
        raise InvalidParameterError(path, "be an integer of 64 bits", shown(value))
    return value


def boolean(path: str, value: Any) -> bool:
    """Check a truth value."""
    if not isinstance(value, bool):
        raise InvalidParameterError(path, "be true or false", shown(value))
    return value


def word(path: str, value: Any) -> str:
    """Check a text."""
    if not isinstance(value, str):
        raise InvalidParameterError(path, "be a text in quotes", shown(value))
    return value


def words(path: str, value: Any) -> list[str]:
    """Check an array of texts."""
    return [word(f"{path}[{index}]", entry) for index, entry in enumerate(_array(path, value, "texts in quotes"))]


def table(path: str, value: Any) -> dict[str, Any]:
    """Check a table."""
    if not isinstance(value, dict):
        raise InvalidParameterError(path, "be a table", shown(value))
    return value


def tables(path: str, value: Any) -> list[dict[str, Any]]:
    """Check an array of tables."""
    return [table(f"{path}[{index}]", entry) for index, entry in enumerate(_array(path, value, "tables"))]


def pair(path: str, value: Any) -> tuple[float, float]:
    """Check two numbers."""
    x, y = _numbers(path, value, 2)
    return (x, y)


def triple(path: str, value: Any) -> tuple[float, float, float]:
    """Check three numbers."""
    first, second, third = _numbers(path, value, 3)
    return (first, second, third)


def numbers(path: str, value: Any) -> list[float]:
    """Check an array of numbers."""
    return [number(f"{path}[{index}]", entry) for index, entry in enumerate(_array(path, value, "numbers"))]


def pairs(path: str, value: Any) -> list[tuple[float, float]]:
    """Check an array of pairs of numbers."""
    return [pair(f"{path}[{index}]", entry) for index, entry in enumerate(_array(path, value, "pairs [x, y]"))]


_SEGMENT: Keys = MappingProxyType({"duration": number, "velocity": pair, "acceleration": pair})


def segments(path: str, value: Any) -> list[tuple[float, tuple[float, float], tuple[float, float]]]:
    """Check an array of segments {duration, velocity, acceleration = [0, 0]}."""
    motion = []
    for index, entry in enumerate(_array(path, value, "tables")):
        fields = checked(f"{path}[{index}]", entry, _SEGMENT, required=("duration", "velocity"))
        motion.append((fields["duration"], fields["velocity"], fields.get("acceleration", (0.0, 0.0))))
    return motion


def _array(path: str, value: Any, of: str) -> list[Any]:
    if not isinstance(value, list):
        raise InvalidParameterError(path, f"be an array of {of}", shown(value))
    return value


def _numbers(path: str, value: Any, count: int) -> list[float]:
    if not isinstance(value, list) or len(value) != count or not all(map(_is_number, value)):
        raise InvalidParameterError(path, f"be an array of {count} numbers", shown(value))
    return numbers(path, value)
