"""Files of keys: TOML as read, and checks of its keys: each value has one kind, each table known keys."""

from __future__ import annotations

import datetime
import math
import re
import reprlib
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Any

from hrsafety._arguments import meant, readable
from hrsafety.errors import InvalidParameterError, ShapeError, Shown

__all__ = [
    "Keys",
    "Kind",
    "boolean",
    "canonical",
    "checked",
    "integer",
    "lines",
    "located",
    "missing",
    "number",
    "numbers",
    "one_of",
    "outline",
    "pair",
    "pairs",
    "parsed",
    "quoted",
    "segments",
    "shown",
    "table",
    "tables",
    "top_level",
    "triple",
    "unknown_key",
    "word",
    "words",
]

MOST_QUOTED = 80
"""Longest text that is shown whole and parsed as a number in quotes."""

UNKNOWN_KEY = Shown("an unknown key")

Kind = Callable[[str, Any], Any]
Keys = Mapping[str, Kind]


def shown(value: object) -> object:
    """Return a value as it goes into a message: short, whatever it is."""
    if isinstance(value, (float, Shown)) or (isinstance(value, str) and len(value) <= MOST_QUOTED):
        return value
    if isinstance(value, bool):
        return Shown("true" if value else "false")
    if isinstance(value, dict):
        return Shown("a table")
    if isinstance(value, datetime.date | datetime.time):
        return Shown("a date or time")
    if isinstance(value, int) and abs(value) >= 10**30:
        return Shown(f"an integer of {value.bit_length()} bits")
    if isinstance(value, list) and len(value) > 6:
        return Shown(f"an array of {len(value)} values")
    try:
        return Shown(reprlib.repr(value))
    except ValueError:
        return Shown("a number with too many digits")


def quoted(value: object) -> str | None:
    """Return how to write a number, truth value or array that was put in quotes; ``None`` for anything else."""
    if not isinstance(value, str) or len(value) > MOST_QUOTED:
        return None
    plain = value.strip().lower()
    for form in (plain, f"[{plain.strip('()')}]"):
        try:
            meaning = tomllib.loads(f"value = {form}")["value"]
        except (ValueError, RecursionError):
            continue
        if meaning != [] and not isinstance(meaning, str):
            return f"write it without quotes: {form}"
    return None


def join(path: str, key: str) -> str:
    """Return the path of a key in a table."""
    return f"{path}.{key}" if path else key


@contextmanager
def located(path: str) -> Iterator[None]:
    """Put the path of a table before the argument that an error names."""
    try:
        yield
    except InvalidParameterError as error:
        argument = join(path, error.argument)
        raise InvalidParameterError(argument, error.requirement, shown(error.value), error.remedy) from None
    except ShapeError as error:
        given = Shown(f"an array of shape {error.actual}")
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
            raise unknown_key(path, key, keys)
    values = {key: keys[key](join(path, key), value) for key, value in given.items()}
    for key in required:
        if key not in given:
            raise missing(join(path, key))
    return values


@contextmanager
def top_level(keys: Keys) -> Iterator[None]:
    """Say so where a key that belongs to the top of a file stands below a table."""
    try:
        yield
    except InvalidParameterError as error:
        table_path, _, key = error.argument.rpartition(".")
        if error.value != UNKNOWN_KEY or not table_path or key not in keys:
            raise
        remedy = f"{key} belongs to the top of the file, above the first table"
        raise InvalidParameterError(error.argument, error.requirement, error.value, remedy) from None


def unknown_key(path: str, key: str, keys: Iterable[str]) -> InvalidParameterError:
    """Return the error about a key that a table does not have."""
    rule = f"be one of the keys {', '.join(keys)}"
    return InvalidParameterError(join(path, reprlib.repr(key)[1:-1]), rule, UNKNOWN_KEY, meant(key, keys))


def missing(path: str, remedy: str | None = None) -> InvalidParameterError:
    """Return the error about a key that must be there."""
    return InvalidParameterError(path, "be given", Shown("nothing"), remedy)


def one_of(path: str, value: str, words: Iterable[str], *, listed: bool = False) -> str:
    """Check a text that must be one of a few, and say which one is near."""
    known = tuple(words)
    if value not in known:
        rule = f"be one of {', '.join(known)}" if listed else f"be {' or '.join(known)}"
        raise InvalidParameterError(path, rule, shown(value), meant(value, known))
    return value


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def number(path: str, value: Any) -> float:
    """Check a number."""
    if not _is_number(value):
        raise InvalidParameterError(path, "be a number", shown(value), quoted(value))
    try:
        return float(value)
    except OverflowError:
        raise InvalidParameterError(path, "be a number that fits 64 bits", shown(value)) from None


def integer(path: str, value: Any) -> int:
    """Check an integer."""
    if not isinstance(value, int) or isinstance(value, bool) or abs(value) >= 2**64:
        raise InvalidParameterError(path, "be an integer of 64 bits", shown(value), quoted(value) or _rounded(value))
    return value


def boolean(path: str, value: Any) -> bool:
    """Check a truth value."""
    if not isinstance(value, bool):
        raise InvalidParameterError(path, "be true or false", shown(value), quoted(value))
    return value


def word(path: str, value: Any) -> str:
    """Check a text."""
    if not isinstance(value, str):
        remedy = f'write "{value}"' if _is_number(value) and len(repr(value)) < MOST_QUOTED else None
        raise InvalidParameterError(path, "be a text in quotes", shown(value), remedy)
    return value


def words(path: str, value: Any) -> list[str]:
    """Check an array of texts."""
    return [word(f"{path}[{index}]", entry) for index, entry in enumerate(_array(path, value, "texts in quotes"))]


def table(path: str, value: Any) -> dict[str, Any]:
    """Check a table."""
    if not isinstance(value, dict):
        form = "{ key = value, ... }" if path.endswith("]") else f"[{path}] above its keys"
        raise InvalidParameterError(path, "be a table", shown(value), f"write {form}")
    return value


def tables(path: str, value: Any) -> list[dict[str, Any]]:
    """Check an array of tables."""
    if isinstance(value, dict):
        remedy = f"write [[{path}]] with two brackets above each of them"
        raise InvalidParameterError(path, "be an array of tables", Shown("a single table"), remedy)
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


def lines(path: str, value: Any) -> list[list[tuple[float, float]]]:
    """Check an array of polylines, arrays of pairs of numbers."""
    return [pairs(f"{path}[{index}]", entry) for index, entry in enumerate(_array(path, value, "polylines"))]


_SEGMENT: Keys = MappingProxyType({"duration": number, "velocity": pair, "acceleration": pair})


def outline(path: str, value: Any) -> list[tuple[float, float]] | str | float:
    """Return the footprint of a robot: pairs, a text as Nav2 writes it, or a radius."""
    if isinstance(value, str):
        return value
    return number(path, value) if _is_number(value) else pairs(path, value)


def segments(path: str, value: Any) -> list[tuple[float, tuple[float, float], tuple[float, float]]]:
    """Check an array of segments {duration, velocity, acceleration = [0, 0]}."""
    motion = []
    for index, entry in enumerate(_array(path, value, "tables")):
        fields = checked(f"{path}[{index}]", entry, _SEGMENT, required=("duration", "velocity"))
        motion.append((fields["duration"], fields["velocity"], fields.get("acceleration", (0.0, 0.0))))
    return motion


def _array(path: str, value: Any, of: str) -> list[Any]:
    if not isinstance(value, list):
        raise InvalidParameterError(path, f"be an array of {of}", shown(value), _bracketed(value))
    return value


def _bracketed(value: Any) -> str | None:
    """Return how to write one entry where several may stand."""
    if isinstance(value, str):
        return quoted(value) or (f'write ["{value}"]' if len(value) <= MOST_QUOTED else None)
    return f"write [{value!r}]" if _is_number(value) and abs(value) < 1e30 else None


def _rounded(value: Any) -> str | None:
    """Return how to write an integer that has a decimal point."""
    whole = isinstance(value, float) and value.is_integer() and abs(value) < 2**53
    return f"write {int(value)}" if whole else None


def _numbers(path: str, value: Any, count: int) -> list[float]:
    if not isinstance(value, list) or len(value) != count or not all(map(_is_number, value)):
        remedy = quoted(value)
        if isinstance(value, list):
            remedy = next(filter(None, map(quoted, value)), None)
        raise InvalidParameterError(path, f"be an array of {count} numbers", shown(value), remedy)
    return numbers(path, value)


def canonical(value: Any, path: str = "") -> Any:
    """Return a value as JSON holds it: whole numbers are integers, however they were written."""
    if isinstance(value, Mapping):
        return {str(key): canonical(each, f"{path}.{key}" if path else str(key)) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [canonical(each, f"{path}[{index}]") for index, each in enumerate(value)]
    if isinstance(value, float):
        if not math.isfinite(value):
            raise InvalidParameterError(path, "be finite", value)
        return int(value) if value.is_integer() and abs(value) < 2**53 else value
    if value is None or isinstance(value, (bool, int, str)):
        return value
    raise InvalidParameterError(path, "be a number, a text, a truth value, an array or a table", shown(value))


# ---- files ---------------------------------------------------------------------------------------


def parsed(path: Path) -> dict[str, Any]:
    """Return the tables of a TOML file as read."""
    readable("path", path)
    text = ""
    try:
        text = path.read_bytes().decode("utf-8-sig")
        return tomllib.loads(text)
    except OSError as error:
        raise InvalidParameterError("path", "name a readable file", Shown(f"{path} ({error.strerror})")) from None
    except UnicodeDecodeError as error:
        raise InvalidParameterError(
            path.name, "be UTF-8 text", Shown(f"byte {error.object[error.start]:#04x} at offset {error.start}")
        ) from None
    except RecursionError:
        raise InvalidParameterError(path.name, "be a TOML file", Shown("brackets nested too deeply")) from None
    except ValueError as error:
        raise _not_toml(path, text, str(error)) from None


_LINE = re.compile(r"\(at line (\d+), column \d+\)")
# What stands where TOML wants something else, and what to write instead.
_HABITS = (
    (re.compile(r"=.*\d,\d+\s*($|#)"), "decimals need a point"),
    (re.compile(r"^\s*[\w.\-]+\s*:"), "keys and values are joined by ="),
    (re.compile(r"=\s*\("), "arrays stand in brackets [ ]"),
    (re.compile(r"=\s*[-+.\d]+\s*[A-Za-z]+"), "numbers have no units; they are SI and radians"),
    (re.compile(r"=\s*(True|False)\b"), "truth values are true and false"),
    (re.compile(r"=\s*[A-Za-z_./]+\s*($|#)"), "texts stand in quotes"),
)


def _not_toml(path: Path, text: str, reason: str) -> InvalidParameterError:
    """Return the error about a text that is not TOML, with the line and a habit that may be behind it."""
    if path.suffix.lower() == ".csv":
        reason, remedy = "a table (.csv)", "recorded people are given with --people"
        return InvalidParameterError(path.name, "be a TOML file", Shown(reason), remedy)
    if text.lstrip().startswith("<") or path.suffix.lower() in {".urdf", ".xacro"}:
        found, remedy = "XML", ""
        if path.suffix.lower() in {".urdf", ".xacro"} or "<robot" in text:
            found = "a robot model in XML"
            remedy = (
                "hrsafety arm reads a model (.urdf) by itself; cells and studies name it in a TOML file of their own"
            )
        return InvalidParameterError(path.name, "be a TOML file", Shown(found), remedy or None)
    place = _LINE.search(reason)
    lines = text.splitlines()
    line = lines[int(place[1]) - 1] if place and int(place[1]) <= len(lines) else ""
    found = f"an error: {reason}" + (f", {line.strip()[:60]}" if line.strip() else "")
    advised = next((advice for habit, advice in _HABITS if habit.search(line)), None)
    return InvalidParameterError(path.name, "be a TOML file", Shown(found), advised)
