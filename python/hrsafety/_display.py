"""How results show themselves: short in a terminal, as a table in a notebook, with units and warnings.

Fields and units are those that the documentation of the class describes: they are declared there once.
"""

from __future__ import annotations

import dataclasses
import inspect
import itertools
import math
import re
from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np

from hrsafety._records import generates

__all__ = ["displayed", "fields_with_units"]

Kind = TypeVar("Kind")

_UNITS = frozenset(
    (
        *("1/s", "rad/s^2", "rad/s", "rad", "N m s/rad", "N m/rad", "N m/A", "N s/m", "N/m^2", "N/m", "N m", "N"),
        *("kg m^2", "kg", "m/s^3", "m/s^2", "m/s", "m^2", "m", "ms", "s", "Pa", "J", "W", "Hz", "V", "A", "K", "px"),
        *("V s/rad", "V/rad", "pixels", "percent", "degrees", "g", "bytes"),
    )
)
# What stands behind "in", up to the end of the clause or the next "in".
_CLAUSE = r"(?:^|(?<=[ (,]))[Ii]n ([^.;:()]+?)(?=[.;:()]|,? in |$)"
_PARTS = r", (?:and |in )?| and (?:in )?| or (?:in )?"
_REST = r" (?:of|by|from|for|at|to|with|along|where|when) .*"
_ENTRY = r"^([\w, *]+?) : "

MOST_SHOWN = 6
"""Elements of a sequence that are shown; longer ones by size and range."""
LONGEST = 80
"""Letters of a value."""
_MOST_WARNINGS = 4


def displayed(kind: type[Kind]) -> type[Kind]:
    """Give a class of results a table for notebooks, and a short text if its own one would print whole arrays.

    Parameters
    ----------
    kind : type
        A dataclass or a named tuple whose documentation describes its fields.

    Returns
    -------
    type
        The same class.
    """
    changed: Any = kind
    changed._repr_html_ = _html
    made = generates(kind, "__repr__") or changed.__repr__.__module__ == "collections"
    if made and (hasattr(kind, "warnings") or _long(" ".join(map(str, getattr(kind, "__annotations__", {}).values())))):
        changed.__repr__ = _text
    return kind


def _long(annotations: str) -> bool:
    """Return whether fields of such types may print as more than a line."""
    if any(word in annotations for word in ("Array", "Trajectory", "Mapping")):
        return True
    return ", ...]" in annotations and re.search(r"tuple\[\w+, \.\.\.\]", annotations) is not None


_KNOWN: dict[type, dict[str, str]] = {}


def fields_with_units(kind: type) -> dict[str, str]:
    """Return the fields of a class of results with the units that its documentation names.

    Parameters
    ----------
    kind : type
        A dataclass or a named tuple.

    Returns
    -------
    dict of str to str
        Empty for a field without a unit.
    """
    if kind in _KNOWN:
        return _KNOWN[kind]
    if dataclasses.is_dataclass(kind):
        names = [field.name for field in dataclasses.fields(kind) if field.repr and not field.name.startswith("_")]
    else:
        names = list(getattr(kind, "_fields", ()))
    units = _documented(inspect.cleandoc(kind.__doc__ or ""))
    _KNOWN[kind] = {name: units.get(name, "") for name in names if name != "warnings"}
    return _KNOWN[kind]


def _documented(text: str) -> dict[str, str]:
    """Return the units that the entries of a docstring name: one for all of an entry, or one for each."""
    found: dict[str, str] = {}
    lines = text.splitlines()
    for number, line in enumerate(lines):
        entry = re.match(_ENTRY, line)
        if entry is None:
            continue
        names = [name.strip(" *") for name in entry[1].split(",")]
        rest = []
        for following in lines[number + 1 :]:
            if not following.startswith(" "):
                break
            rest.append(following.strip())
        found |= _of_entry(names, " ".join(rest))
    return found


def _of_entry(names: list[str], text: str) -> dict[str, str]:
    """Return the units of the names that one description is of: one for all, or one for each."""
    clauses = [
        [re.sub(_REST, "", part.strip()) for part in re.split(_PARTS, clause[1])]
        for clause in re.finditer(_CLAUSE, text)
    ]
    clauses = [clause for clause in clauses if clause[0] in _UNITS]
    if len(names) > 1 and clauses and len(clauses[0]) == len(names):
        return {name: part for name, part in zip(names, clauses[0], strict=True) if part in _UNITS}
    units = [part for clause in clauses for part in itertools.takewhile(_UNITS.__contains__, clause)]
    if len(units) == len(names):
        return dict(zip(names, units, strict=True))
    # Of several units none is shown rather than a wrong one.
    return dict.fromkeys(names, units[0]) if len(set(units)) == 1 else {}


def _rows(result: Any) -> list[tuple[str, str, str]]:
    """Return name, value and unit of each field."""
    return [(name, *_value(getattr(result, name), unit)) for name, unit in fields_with_units(type(result)).items()]


def _value(value: object, unit: str) -> tuple[str, str]:
    """Return a value as it is shown, with its unit if it has one."""
    if value is None or isinstance(value, (bool, np.bool_, str)):
        return _cut(str(value)), ""
    if isinstance(value, (int, float, np.number)):
        return _number(float(value)) if isinstance(value, (float, np.floating)) else str(value), unit
    if isinstance(value, np.ndarray):
        return _array(value), unit if value.dtype.kind in "fiu" else ""
    if isinstance(value, Mapping):
        inside = ", ".join(f"{key}: {_value(each, '')[0]}" for key, each in list(value.items())[:MOST_SHOWN])
        more = f", ... {len(value)} in all" if len(value) > MOST_SHOWN else ""
        return _cut(f"{inside}{more}" or "none"), unit
    if isinstance(value, (tuple, list)) and not hasattr(value, "_fields"):
        return _sequence(value), unit
    # Tables say in their first line which part of them would follow.
    return _cut(repr(value).splitlines()[0].split("; here ")[0]), ""


def _number(value: float) -> str:
    return "no value (NaN)" if math.isnan(value) else f"{value:.6g}"


def _array(values: np.ndarray[Any, Any]) -> str:
    """Return the elements of a small array, shape and range of another one."""
    if values.ndim <= 1 and values.size <= MOST_SHOWN:
        return _sequence(values.ravel().tolist()) if values.ndim else _value(values.item(), "")[0]
    shape = " x ".join(str(size) for size in values.shape)
    if values.dtype.kind not in "fiu":
        words = np.unique(values).tolist()
        return _cut(f"{shape}: {', '.join(str(each) for each in words[:MOST_SHOWN])}") if words else f"{shape}: none"
    finite = values[np.isfinite(values)]
    span = f"{finite.min():.6g} to {finite.max():.6g}" if finite.size else "no finite value"
    empty = int(np.isnan(values).sum()) if values.dtype.kind == "f" else 0
    infinite = values.size - finite.size - empty
    counts = ((infinite, "infinite"), (empty, "without value"))
    return f"{shape}: {span}" + "".join(f", {count} {what}" for count, what in counts if count)


def _sequence(values: tuple[Any, ...] | list[Any]) -> str:
    """Return the elements of a short sequence, the number and kind of a long one."""
    if len(values) <= MOST_SHOWN:
        return _cut(f"[{', '.join(_value(each, '')[0] for each in values)}]") if len(values) else "none"
    kinds = {type(each).__name__ for each in values}
    return f"{len(values)} of {' and '.join(sorted(kinds))}"


def _cut(text: str) -> str:
    """Return the first letters of a text."""
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def _warnings(result: object) -> list[str]:
    """Return the lines of the warnings that a result carries; of many the others are counted."""
    found = [str(each) for each in getattr(result, "warnings", ())]
    more = len(found) - _MOST_WARNINGS
    return found if more <= 0 else [*found[:_MOST_WARNINGS], f"and {more} more: see .warnings"]


def _text(result: object) -> str:
    """Return fields with units in a line, and the warnings."""
    shown = [(name, _quoted(getattr(result, name), value), unit) for name, value, unit in _rows(result)]
    fields = ", ".join(f"{name}={value}{unit and ' '}{unit}" for name, value, unit in shown)
    return "\n".join([f"{type(result).__name__}({fields})", *_warnings(result)])


def _quoted(value: object, shown: str) -> str:
    """Return words and short tuples of them as Python writes them, all else as it is shown."""
    words = isinstance(value, str) or (type(value) is tuple and all(isinstance(each, (str, int)) for each in value))
    return repr(value) if words and len(repr(value)) <= LONGEST else shown


def _html(result: object) -> str:
    """Return fields, values and units as a table, and the warnings."""
    import html  # a notebook's; it holds the names of all letters

    cells = "".join(
        "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in (name.replace("_", " "), value, unit)) + "</tr>"
        for name, value, unit in _rows(result)
    )
    doubts = "".join(f"<p>{html.escape(line)}</p>" for line in _warnings(result))
    return f"<p>{html.escape(type(result).__name__)}</p><table><tbody>{cells}</tbody></table>{doubts}"
