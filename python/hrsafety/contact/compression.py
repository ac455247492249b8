"""Compression tests of coverings: force over way, or stress over strain, of a table as a material."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from hrsafety._arguments import Array, positive, word
from hrsafety.contact.materials import StressTable
from hrsafety.errors import FileError, Shown
from hrsafety.io.cells import TableColumn, read_columns
from hrsafety.io.headers import cells_of, delimiter_of, first_row, is_number
from hrsafety.io.reader import Document
from hrsafety.plausibility import ResultWarning, issue

__all__ = ["load_compression_test"]

_WORDS: Mapping[str, tuple[str, ...]] = {
    "strain": ("strain", "compression_strain", "dehnung", "stauchung"),
    "way": (
        *("displacement", "deflection", "compression", "deformation", "stroke", "position", "crosshead"),
        *("crosshead_displacement", "extension", "way", "weg", "standardweg"),
    ),
    "stress": ("stress", "compressive_stress", "pressure", "spannung", "druckspannung"),
    "force": ("force", "load", "standardforce", "kraft", "standardkraft"),
}
_UNITS: Mapping[str, Mapping[str, float]] = {
    "strain": {"1": 1.0, "m_m": 1.0, "mm_mm": 1.0, "percent": 0.01, "%": 0.01},
    "way": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6},
    "stress": {"pa": 1.0, "kpa": 1e3, "mpa": 1e6, "n_mm2": 1e6, "n_cm2": 1e4},
    "force": {"n": 1.0, "kn": 1e3, "mn": 1e-3, "dan": 10.0},
}
_AXES: Mapping[str, tuple[str, str]] = {"strain": ("strain", "way"), "stress": ("stress", "force")}
"""Quantities of which a table has one for each axis."""
_WITH_UNIT = re.compile(r"^(?P<name>.*?)\s*(?:\[(?P<a>.*)\]|\((?P<b>.*)\)|/(?P<c>.*)|\s+in\s+(?P<d>.*))$")
HEADER_WITHIN = 30
"""Lines among which a header is looked for: presses write titles above it."""
POINTS = 128
"""Points of a material at most: means of the rows between even strains."""
UNLOADED = 0.02
"""Share of the largest strain, and of the largest stress, up to which a specimen counts as unloaded."""
ROUGH = 0.05
"""Share of the largest stress by which the stress may fall while a specimen is pressed: noise."""
LOADED, RELEASED = 0.3, 0.15
"""Shares of the largest strain: a loading goes beyond the first one, and the next begins below the second."""
SHALLOW = 0.02
"""Strain that no test of a covering ends below: percent or another unit was meant."""


class _Column(NamedTuple):
    """Column of a table with the size of its unit."""

    place: int
    title: str
    scale: float


def load_compression_test(
    path: str | os.PathLike[str],
    *,
    thickness: float | None = None,
    area: float | None = None,
    loading: Literal["first", "last"] | None = None,
) -> StressTable:
    r"""Read a compression test: a loading from rest to its largest strain becomes a material.

    Parameters
    ----------
    path : path-like
        A text table with a header, whose names carry their unit: ``strain_%`` (``strain_1`` for shares) or
        ``displacement_mm``, and ``stress_kPa`` or ``force_N``; units may stand in brackets or in a row of their own.
        Other columns are left out, and so are lines of titles above the header; a warning says which line was taken.
    thickness, area : float or None
        Of the specimen before the test, in m and m^2; for columns of displacement and force.
    loading : {"first", "last"} or None
        Which loading counts of a specimen that was pressed several times: the first one is the stiffest, the last one
        that of a pad in use. ``None``: there is one.

    Returns
    -------
    StressTable
        At most 128 points, each the mean of the rows around it. It holds for the speed of the test: foams are stiffer
        in a quick collision, see ``rate`` of a `Covering`.

    Raises
    ------
    FileError
        If the file is no such table, or holds several loadings and it is not said which counts, or the test does not
        begin unloaded, or its stress falls while it is pressed.
    InvalidParameterError
        If a size is missing or not positive.

    Examples
    --------
    >>> from pathlib import Path
    >>> from hrsafety import contact
    >>> rows = "displacement_mm,force_N\n0,0\n1,40\n2,60\n6,90\n12,200\n"
    >>> _ = Path("press.csv").write_text(rows)
    >>> foam = contact.load_compression_test("press.csv", thickness=0.02, area=0.01)
    >>> foam.strain.round(3).tolist(), foam.stress.round(1).tolist()
    ([0.0, 0.05, 0.1, 0.3, 0.6], [0.0, 4000.0, 6000.0, 9000.0, 20000.0])
    """
    found = compression_test(path, thickness, area, loading)
    for told in found.warnings:
        issue(told.message, stacklevel=3)
    return found


def compression_test(
    path: str | os.PathLike[str], thickness: float | None = None, area: float | None = None, loading: str | None = None
) -> StressTable:
    """Return the material of a compression test as `load_compression_test` does, whose doubts only it carries."""
    if loading is not None:
        word("loading", loading, ("first", "last"))
    document = Document(path)
    columns, skip, delimiter, titles = _columns(document)
    chosen = []
    for (name, other), size, given in zip(_AXES.values(), ("thickness", "area"), (thickness, area), strict=True):
        column = columns.get(name) or columns.get(other)
        if column is None:
            raise _without(document, titles, name, other)
        divisor = 1.0
        if name not in columns:
            if given is None:
                raise document.error(
                    "size_needed", f"come with the {size} of the specimen", Shown(column.title), f"{size}="
                )
            divisor = positive(size, given)
        chosen.append(column._replace(scale=column.scale / divisor))
    numbers = [TableColumn(each.place, each.title) for each in chosen]
    table = read_columns(document, delimiter=delimiter, numbers=numbers, skip=skip, columns=len(titles)).numbers
    table = table[np.isfinite(table).all(axis=1)] * [each.scale for each in chosen]
    if len(table) < 2:
        raise document.error("no_rows", "hold at least two rows of numbers", len(table))
    doubts: tuple[ResultWarning, ...] = ()
    if (line := _header(document)) != first_row(document)[0]:
        told = f"{document.name}: line {line + 1} is taken as the header, and the lines above it are left out"
        # What stands above a header that names both axes holds no numbers of the test.
        doubts = (ResultWarning("header_below_titles", "material", told, safe_side=True),)
    # Presses count down or up, and pull is the positive direction of many.
    strain, stress = (each if abs(each.max()) >= abs(each.min()) else -each for each in table.T)
    return replace(_material(document, *_loading(document, strain, stress, loading)), warnings=doubts)


def _loading(document: Document, strain: Array, stress: Array, which: str | None) -> tuple[Array, Array]:
    """Return the rows of a loading, from rest to its largest strain."""
    largest = float(strain.max())
    if not SHALLOW <= largest < 1.0:
        remedy = "check the unit of its column and the thickness of the specimen"
        raise document.error("strain", f"have a largest strain of at least {SHALLOW:g} and below 1", largest, remedy)
    found = _loadings(strain, largest)
    if len(found) > 1 and which is None:
        remedy = 'give loading: "last" is a pad in use, "first" the stiffest'
        raise document.error("several_loadings", "hold one loading", len(found), remedy)
    start, most = found[0 if which == "first" else -1]
    strain, stress = strain[start : most + 1], stress[start : most + 1]
    if strain[0] > UNLOADED * strain[-1] or abs(stress[0]) > UNLOADED * stress.max():
        shown = Shown(f"strain {strain[0]:.3g} with {stress[0]:.3g} Pa")
        raise document.error(
            "preloaded", "begin unloaded, at strain 0 and stress 0", shown, "take off what it begins at"
        )
    pressed = strain > 0.0
    return strain[pressed], stress[pressed]


def _loadings(strain: Array, largest: float) -> list[tuple[int, int]]:
    """Return where each loading begins, at rest, and where it is deepest."""
    beyond, released = strain > LOADED * largest, strain < RELEASED * largest
    # What is between both shares belongs to what was before.
    last = np.maximum.accumulate(np.where(beyond | released, np.arange(len(strain)), 0))
    change = np.diff(np.concatenate([[0], beyond[last], [0]]))
    begins, ends = np.flatnonzero(change > 0).tolist(), np.flatnonzero(change < 0).tolist()
    found = []
    for rest, begin, end in zip([0, *ends], begins, ends, strict=False):
        start = rest + int(np.argmin(strain[rest : begin + 1]))
        found.append((start, begin + int(np.argmax(strain[begin:end]))))
    return found


def _material(document: Document, strain: Array, stress: Array) -> StressTable:
    """Return the rows of a loading as points."""
    bins = np.minimum((POINTS * strain / strain[-1]).astype(np.int64), POINTS - 1) if len(strain) > POINTS else None
    if bins is not None:
        rows = np.bincount(bins, minlength=POINTS)
        there = rows > 0
        sums = (np.bincount(bins, each, minlength=POINTS)[there] for each in (strain, stress))
        strain, stress = (each / rows[there] for each in sums)
    raised = np.maximum.accumulate(np.maximum(stress, 0.0))
    if (raised - stress).max() > ROUGH * raised[-1] or not (np.diff(strain) > 0.0).all():
        worst = int(np.argmax(raised - stress))
        shown = Shown(f"{stress[worst]:.4g} Pa at strain {strain[worst]:.3g} after {raised[worst]:.4g} Pa")
        raise document.error(
            "not_rising", "have a stress that does not fall while it is pressed", shown, "smooth it first"
        )
    return StressTable(strain=np.append(0.0, strain), stress=np.append(0.0, raised))


# ---- header -------------------------------------------------------------------------------------


def _columns(document: Document) -> tuple[dict[str, _Column], int, str, list[str]]:
    """Return the columns that are known, the lines before the rows, the delimiter, and the titles of all columns."""
    number = _header(document)
    header = document.first_lines[number] if number >= 0 else ""
    titles, skip, delimiter = _titles(document, number)
    if number < 0 or is_number(titles[0]):
        raise document.error("columns_needed", "have a header, such as displacement_mm,force_N", Shown(header[:80]))
    found: dict[str, _Column] = {}
    for place, title in enumerate(titles):
        quantity, scale = _meaning(title)
        if not quantity:
            continue
        if scale is None:
            remedy = f"add one of {', '.join(_UNITS[quantity])} to its name, as {title}_{next(iter(_UNITS[quantity]))}"
            raise document.error("unit_needed", "name the unit of each column", title, remedy, line=number + 1)
        if quantity in found:
            shown = Shown(f"{found[quantity].title} and {title}")
            raise document.error("ambiguous_columns", f"have one column of {quantity}", shown, line=number + 1)
        found[quantity] = _Column(place, title, scale)
    return found, skip, delimiter, titles


def _titles(document: Document, number: int) -> tuple[list[str], int, str]:
    """Return the titles of a line with the units of a row below it, the lines up to the rows, and the delimiter."""
    header = document.first_lines[number] if number >= 0 else ""
    delimiter = delimiter_of(header)
    titles, skip = cells_of(header, delimiter), number + 1
    units = cells_of(document.first_lines[skip] if skip < len(document.first_lines) else "", delimiter)
    if len(units) != len(titles) or any(is_number(each) for each in units):
        return titles, skip, delimiter
    return (
        [f"{title} [{unit}]" if unit else title for title, unit in zip(titles, units, strict=True)],
        skip + 1,
        delimiter,
    )


def _header(document: Document) -> int:
    """Return the line of the header, from 0: the first one that names both axes, with units before without."""
    first, _ = first_row(document)
    named = []
    for number, line in enumerate(document.first_lines[:HEADER_WITHIN]):
        titles = cells_of(line, delimiter_of(line))
        if len(titles) > 1 and all(is_number(each) for each in titles):
            break
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        told = [_meaning(each) for each in _titles(document, number)[0]]
        if all({quantity for quantity, scale in told if scale} & set(axis) for axis in _AXES.values()):
            return number
        known = {_meaning(each)[0] or _unknown(each)[0] for each in titles}
        if all(known & set(axis) for axis in _AXES.values()):
            named.append(number)
    return named[0] if named else first


def _without(document: Document, titles: list[str], name: str, other: str) -> FileError:
    """Return the error about an axis without a column: its unit is not known, or nothing has its name."""
    for title in titles:
        quantity, unit = _unknown(title)
        if quantity in (name, other):
            rule = f"have {title!r} in a unit that is known: {', '.join(_UNITS[quantity])}"
            return document.error("unit_unknown", rule, unit, line=_header(document) + 1)
    rule = f"have a column with its unit that is called {', '.join((*_WORDS[name], *_WORDS[other]))}"
    remedy = "if this line is a title and the header stands below it, delete the lines above the header"
    return document.error("columns_needed", rule, Shown(", ".join(titles)[:200]), remedy, line=_header(document) + 1)


def _unknown(title: str) -> tuple[str, str]:
    """Return the quantity of a column whose unit is not known, and that unit; nothing of any other."""
    found = _WITH_UNIT.match(title)
    quantity, _ = _meaning(found["name"]) if found else ("", None)
    if found is None or not quantity or _meaning(title)[0]:
        return "", ""
    return quantity, next(part for part in found.groups()[1:] if part is not None).strip()


def _meaning(title: str) -> tuple[str, float | None]:
    """Return the quantity of a column and the size of its unit, ``None`` without one."""
    title = re.sub(r"\s*[\[(]\s*-\s*[\])]", "_1", title)
    plain = re.sub(r"[\s\[\]()/.\-^*]+", "_", title.lower().replace("²", "2")).strip("_").replace("_in_", "_")
    plain = re.sub(r"_(mm|cm)_2$", r"_\g<1>2", plain)
    for quantity, names in _WORDS.items():
        for name in names:
            if plain == name:
                return quantity, None
            unit = plain.removeprefix(f"{name}_")
            if unit != plain and unit in _UNITS[quantity]:
                return quantity, _UNITS[quantity][unit]
    return "", None
