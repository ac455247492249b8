"""How results show themselves: short in a terminal, as a table in a notebook, with units and warnings.

Units are declared in the annotations of the fields, once; documentation says the same, and a test compares.
"""

from __future__ import annotations

import dataclasses
import inspect
import math
import re
from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np

from hrsafety._records import generates

__all__ = ["displayed", "fields_with_units", "shown_html"]

Kind = TypeVar("Kind")

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
        A dataclass or a named tuple whose fields declare their units.

    Returns
    -------
    type
        The same class.
    """
    changed: Any = kind
    changed._repr_html_ = shown_html
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
    """Return the fields of a class of results with the units that it declares for them.

    A unit stands in the annotation of its field, ``time: Annotated[float, "s"]``, or, where fields follow from a list
    of the native core, by their names in ``UNITS`` of the class.

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
    units: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        units |= {name: _unit_of(hint) for name, hint in inspect.get_annotations(base).items()}
        units |= base.__dict__.get("UNITS", {})
    _KNOWN[kind] = {name: units.get(name, "") for name in names if name != "warnings"}
    return _KNOWN[kind]


def _unit_of(hint: Any) -> str:
    """Return the unit that an annotation holds, empty without one; annotations are mostly text, as Python writes it."""
    if hasattr(hint, "__metadata__"):
        return str(hint.__metadata__[0])
    text = getattr(hint, "__forward_arg__", hint)
    return text.split("'")[-2] if isinstance(text, str) and text.startswith("Annotated[") else ""


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


def shown_html(result: object) -> str:
    """Return fields, values and units as a table, and the warnings."""
    import html  # a notebook's; it holds the names of all letters

    cells = "".join(
        "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in (name.replace("_", " "), value, unit)) + "</tr>"
        for name, value, unit in _rows(result)
    )
    doubts = "".join(f"<p>{html.escape(line)}</p>" for line in _warnings(result))
    return f"<p>{html.escape(type(result).__name__)}</p><table><tbody>{cells}</tbody></table>{doubts}"
