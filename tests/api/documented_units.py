"""Units that the documentation of a class names, entry by entry, to compare with those that its fields declare."""

from __future__ import annotations

import inspect
import itertools
import re

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


def documented_units(kind: type) -> dict[str, str]:
    """Return the units that the documentation of a class names; none where it names several for one field."""
    return _documented(inspect.cleandoc(kind.__doc__ or ""))


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
