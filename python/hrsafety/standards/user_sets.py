"""Limit sets of the user, from TOML or CSV: every row names its source."""

from __future__ import annotations

import csv
import io
import os
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from hrsafety._arguments import meant, readable, word
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.standards.contact_limits import CERTAINTIES, CONTACTS, Quantity
from hrsafety.standards.limit_sets import MILLIMETER, SQUARE_CENTIMETER, LimitRow, LimitSet
from hrsafety.standards.shipped import SETS, shipped

__all__ = ["COLUMNS", "SUFFIXES", "load_limits", "template"]

COLUMNS = (
    *("region", "area", "contact", "force_N", "pressure_N_per_cm2"),
    *("spring_constant_N_per_mm", "effective_mass_kg", "source", "certainty"),
)
SUFFIXES = (".toml", ".csv")
MOST_BYTES = 2**22
MOST_ROWS = 10_000
LONGEST_WORD = 200
NOT_PERMITTED = "not_permitted"

_NEEDED = ("region", "contact", "source")
_HEADER = ("id", "title", "edition", "note", "base", "limits")
_SCALES = {
    "force_N": 1.0,
    "pressure_N_per_cm2": 1.0 / SQUARE_CENTIMETER,
    "spring_constant_N_per_mm": 1.0 / MILLIMETER,
    "effective_mass_kg": 1.0,
}
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


def load_limits(path: str | os.PathLike[str]) -> LimitSet:
    r"""Read a set of limits.

    Parameters
    ----------
    path : path-like
        A file in TOML or CSV with the columns of `template`. In TOML ``base`` names a set of the package whose rows the
        file changes: what a row leaves out is that of the base.

    Returns
    -------
    LimitSet
        The set. An empty force or pressure is not checked; ``not_permitted`` in place of a force
        means that contact is not permitted.

    Raises
    ------
    InvalidParameterError
        If the file cannot be read, a column is unknown, a row has no source, a number is not positive, two rows say
        the same, or more is allowed to a clamped part of the body than to a free one; the message names the row.

    Examples
    --------
    >>> from pathlib import Path
    >>> from hrsafety import standards
    >>> rows = "region,contact,force_N,source\nchest,transient,100,own tests of 2024\n"
    >>> _ = Path("own.csv").write_text(rows)
    >>> print(standards.load_limits("own.csv").contact("chest", "transient").status)
    limited
    """
    place = readable("path", path)
    if place.suffix.lower() not in SUFFIXES:
        raise InvalidParameterError("path", f"end in {' or '.join(SUFFIXES)}", str(path))
    size = place.stat().st_size
    if size > MOST_BYTES:
        raise InvalidParameterError(place.name, f"have at most {MOST_BYTES} bytes", size)
    try:
        text = place.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise InvalidParameterError(place.name, "be text in UTF-8", Shown(f"byte {error.start}")) from None
    try:
        header, rows = _toml(text) if place.suffix.lower() == ".toml" else ({}, _csv(text))
        found = tuple(_checked(rows))
        base = None
        if "base" in header:
            base = shipped(word("base", header["base"], SETS))
            found = tuple(_over(base, dict(zip((place for place, _ in rows), found, strict=True))))
        if header.get("id", place.stem) in SETS:
            raise InvalidParameterError(
                "id", "differ from those of the sets of the package", header.get("id", place.stem)
            )
    except InvalidParameterError as error:
        raise error.renamed(f"{place.name}: {error.argument}") from None
    return LimitSet(
        id=header.get("id", place.stem),
        title=header.get("title", place.name),
        edition=header.get("edition", "not given"),
        note=header.get("note", ""),
        rows=found,
        sources={} if base is None else base.sources,
    )


def template(kind: str = "csv") -> str:
    """Return a file with the columns of a limit set and no values.

    Parameters
    ----------
    kind : {"csv", "toml"}
        Format.

    Returns
    -------
    str
        Text to fill in.

    Examples
    --------
    >>> from hrsafety import standards
    >>> standards.template().split(",")[:3]
    ['region', 'area', 'contact']
    """
    if word("kind", kind, ("csv", "toml")) == "csv":
        return ",".join(COLUMNS) + "\n"
    lines = [
        "# Limits of contact. Every row needs a region, a contact and a source.",
        '# contact is "quasi_static" (clamped) or "transient". A force or pressure that is left out is not checked.',
        f'# force_N = "{NOT_PERMITTED}" says that this contact is not permitted at all.',
        f"# certainty is one of {', '.join(CERTAINTIES)}.",
        *('id = ""', 'title = ""', 'edition = ""'),
        f'# base = "{SETS[0]}"  # rows below stand over its rows; other ones are those of the base',
        *("", "# [[limits]]"),
        *(f"# {column} =" for column in COLUMNS),
    ]
    return "\n".join(lines) + "\n"


# ---- formats ------------------------------------------------------------------------------------

Rows = list[tuple[str, Mapping[str, Any]]]


def _csv(text: str) -> Rows:
    """Return the rows by the words that name them."""
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    try:
        lines = [(reader.line_num, cells) for cells in reader if any(cell.strip() for cell in cells)]
    except csv.Error as error:
        raise InvalidParameterError(f"line {reader.line_num}", "be a row of CSV", Shown(str(error))) from None
    if not lines:
        raise InvalidParameterError("header", f"name columns out of {', '.join(COLUMNS)}", Shown("an empty file"))
    header = [cell.strip() for cell in lines[0][1]]
    _known("header", header)
    for column in _NEEDED:
        if column not in header:
            raise InvalidParameterError("header", f"have a column {column}", Shown(", ".join(header)))
    rows: Rows = []
    for number, cells in lines[1:]:
        if len(cells) != len(header):
            raise InvalidParameterError(f"line {number}", f"have {len(header)} cells", len(cells))
        given = {name: cell.strip() for name, cell in zip(header, cells, strict=True) if cell.strip()}
        rows.append((f"line {number}", given))
    return rows


def _toml(text: str) -> tuple[dict[str, str], Rows]:
    try:
        data = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise InvalidParameterError("file", "be TOML", Shown(str(error))) from None
    for key in data:
        if key not in _HEADER:
            raise InvalidParameterError(
                "file", f"have no other keys than {', '.join(_HEADER)}", key, meant(key, _HEADER)
            )
    header = {key: value for key, value in data.items() if key != "limits"}
    for key, value in header.items():
        if not isinstance(value, str) or not value.strip() or len(value) > LONGEST_WORD:
            raise InvalidParameterError(key, f"be text of at most {LONGEST_WORD} characters", value)
    tables = data.get("limits")
    if not isinstance(tables, list):
        remedy = f"below each [[limits]] stand {', '.join(_NEEDED)} and loads"
        if "base" in header:
            remedy += f"; those that differ from the base, or take {header['base']!r} itself in place of this file"
        rule = "be tables [[limits]], one for each limit"
        raise InvalidParameterError("limits", rule, Shown("none") if tables is None else tables, remedy)
    rows: Rows = []
    for index, table in enumerate(tables):
        if not isinstance(table, dict):
            raise InvalidParameterError(f"limits[{index}]", "be a table", table)
        _known(f"limits[{index}]", table)
        rows.append((f"limits[{index}]", table))
    return header, rows


def _known(place: str, names: Iterable[str]) -> None:
    seen: set[str] = set()
    for name in names:
        if name not in COLUMNS:
            rule = f"have no other columns than {', '.join(COLUMNS)}"
            raise InvalidParameterError(place, rule, name, meant(name, COLUMNS) or "columns carry their unit")
        if name in seen:
            raise InvalidParameterError(place, "have a column once", name)
        seen.add(name)


# ---- rows ---------------------------------------------------------------------------------------


def _checked(rows: Rows) -> Iterator[LimitRow]:
    if not rows:
        raise InvalidParameterError("file", "have rows", 0)
    if len(rows) > MOST_ROWS:
        raise InvalidParameterError("file", f"have at most {MOST_ROWS} rows", len(rows))
    found: dict[tuple[str, str | None, str], tuple[str, LimitRow]] = {}
    bodies: dict[tuple[str, str], tuple[float, str]] = {}
    spelled: dict[tuple[str, str], str] = {}
    for place, given in rows:
        row = _row(place, given)
        key = (row.region, row.area, row.contact)
        for kind, name in (("region", row.region), ("area", row.area or "")):
            other = spelled.setdefault((kind, name.casefold()), name)
            if other != name:
                raise InvalidParameterError(f"{place}: {kind}", f"be spelled as above ({other!r})", name)
        if key in found:
            raise InvalidParameterError(place, f"not say again what {found[key][0]} says", Shown(_named(row)))
        for name in ("spring_constant", "effective_mass"):
            quantity: Quantity | None = getattr(row, name)
            if quantity is None:
                continue
            value, other = bodies.setdefault((row.region, name), (quantity.value, place))
            if value != quantity.value:
                rule = f"be the same in all rows of {row.region} ({value:g} in {other})"
                raise InvalidParameterError(f"{place}: {name}", rule, quantity.value)
        found[key] = (place, row)
        of_both = [found.get((row.region, row.area, kind)) for kind in ("quasi_static", "transient")]
        if of_both[0] is not None and of_both[1] is not None:
            _ordered(place, of_both[0][1], of_both[1][1], "exchange both if they are mixed up")
        yield row


def _ordered(place: str, clamped: LimitRow, free: LimitRow, remedy: str) -> None:
    """Refuse limits of a clamped part of the body above those of one that is free to give way."""
    for name in ("force", "pressure"):
        given, most = getattr(clamped, name), getattr(free, name)
        if given is not None and most is not None and given.value > most.value:
            unit = "N" if name == "force" else "Pa"
            rule = f"be at most as high for quasi_static as for transient ({most.value:g} {unit})"
            shown = Shown(f"{given.value:g} {unit}")
            raise InvalidParameterError(f"{place}: {name}", rule, shown, remedy)


def _over(base: LimitSet, own: Mapping[str, LimitRow]) -> Iterator[LimitRow]:
    """Yield the rows of a set with those of the user, by their places in the file, over them."""
    places = {(row.region, row.area, row.contact): place for place, row in own.items()}
    known = {(row.region, row.area, row.contact) for row in base.rows}
    for key, place in places.items():
        if key not in known:
            rule = f"be a row of {base.id}, which is the base"
            raise InvalidParameterError(place, rule, Shown(_named(own[place])), "columns() of the base lists its rows")
    bodies: dict[str, dict[str, Any]] = {}
    for row in own.values():
        given = {name: getattr(row, name) for name in ("spring_constant", "effective_mass")}
        bodies.setdefault(row.region, {}).update({name: each for name, each in given.items() if each is not None})
    merged: dict[tuple[str, str | None], LimitRow] = {}
    for row in base.rows:
        found = replace(row, **{name: each for name, each in bodies.get(row.region, {}).items() if getattr(row, name)})
        where = places.get((row.region, row.area, row.contact))
        if where is not None:
            mine = own[where]
            loads = {name: getattr(mine, name) or getattr(row, name) for name in ("force", "pressure")}
            found = replace(found, permitted=mine.permitted, **(loads if mine.permitted else dict.fromkeys(loads)))
        other = merged.setdefault((row.region, row.area), found)
        if other is not found:
            place = where or places.get((other.region, other.area, other.contact), base.id)
            clamped, free = sorted((other, found), key=lambda each: each.contact)
            _ordered(place, clamped, free, f"one of both is that of {base.id}: give the other row, too")
        yield found


def _named(row: LimitRow) -> str:
    return ", ".join(each for each in (row.region, row.area, row.contact) if each)


def _row(place: str, given: Mapping[str, Any]) -> LimitRow:
    words = {}
    for name in ("region", "area", "contact", "source", "certainty"):
        value = given.get(name)
        if value is None:
            if name in _NEEDED:
                raise InvalidParameterError(f"{place}: {name}", "be given", Shown("nothing"))
            continue
        if not isinstance(value, str) or not value.strip() or len(value) > LONGEST_WORD or not value.isprintable():
            raise InvalidParameterError(f"{place}: {name}", f"be text of at most {LONGEST_WORD} characters", value)
        words[name] = value.strip()
    word(f"{place}: contact", words["contact"], CONTACTS)
    certainty = word(f"{place}: certainty", words.get("certainty", "not_stated"), CERTAINTIES)
    permitted = given.get("force_N") != NOT_PERMITTED
    if not permitted and given.get("pressure_N_per_cm2") is not None:
        rule = f"be left out where contact is {NOT_PERMITTED}"
        raise InvalidParameterError(f"{place}: pressure_N_per_cm2", rule, given["pressure_N_per_cm2"])
    numbers = {
        name: Quantity(_positive(f"{place}: {name}", given[name]) * scale, certainty, (words["source"],))
        for name, scale in _SCALES.items()
        if given.get(name) is not None and (permitted or name != "force_N")
    }
    return LimitRow(
        words["region"],
        words.get("area"),
        words["contact"],
        permitted,
        force=numbers.get("force_N"),
        pressure=numbers.get("pressure_N_per_cm2"),
        spring_constant=numbers.get("spring_constant_N_per_mm"),
        effective_mass=numbers.get("effective_mass_kg"),
    )


def _positive(name: str, given: object) -> float:
    """Return a number of a cell or a key that is finite and above zero."""
    number = given
    if isinstance(given, str) and _NUMBER.fullmatch(given):
        number = float(given)
    if isinstance(number, bool) or not isinstance(number, (int, float)):
        raise InvalidParameterError(name, "be a number", given)
    if not 0.0 < number < 1e300:
        raise InvalidParameterError(name, "be finite and positive", given)
    return float(number)
