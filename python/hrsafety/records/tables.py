"""Tables of numbers as measuring devices write them: which lines are data, what separates them, names and units."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np

from hrsafety._arguments import Array
from hrsafety.errors import Shown
from hrsafety.io.reader import Document
from hrsafety.records.units import KNOWN, factor_of, plain

__all__ = ["DeviceTable", "read_table"]

_NUMBER = r"[+-]?(?:\d+{point}?\d*|{point}\d+)(?:[eE][+-]?\d+)?"
_CELL = r'[ \t]*"?[ \t]*{number}[ \t]*"?[ \t]*'
_BRACKETS = re.compile(r"^(.*?)[ \t]*[\[(]([^\[\]()]*)[\])][ \t]*$")
_QUOTIENT = re.compile(r"^(.*?\S)(?:[ \t]*/[ \t]*|[ \t]+in[ \t]+)(\S+)$")
_THOUSANDS = re.compile(r"^[+-]?\d{1,3}(?:\.\d{3})+,\d+$|^[+-]?\d{1,3}(?:,\d{3})+\.\d+$")
# Delimiter and decimal sign; of ways that read as much the first one counts.
_WAYS = ((";", "."), (";", ","), ("\t", "."), ("\t", ","), (",", "."), (None, "."), (None, ","))
_SAMPLED = 500


class DeviceTable(NamedTuple):
    """Numbers of a file with their names.

    Attributes
    ----------
    columns : dict of str to ndarray
        In SI units where the unit is known.
    units : list of str or None
        As they stand in the file.
    decimals : list of int
        Digits behind the point of the first column's numbers, at most, by column.
    header : list of str
        Lines above the data.
    delimiter : str or None
        ``None`` for blanks.
    decimal : str
        ``"."`` or ``","``.
    rows : int
        Lines of data.
    """

    columns: dict[str, Array]
    units: list[str | None]
    decimals: list[int]
    header: list[str]
    delimiter: str | None
    decimal: str
    rows: int


class _Layout(NamedTuple):
    """Longest run of lines of numbers."""

    first: int
    lines: int
    cells: int
    delimiter: str | None
    decimal: str


def read_table(document: Document) -> DeviceTable:
    """Return the longest run of lines of equally many numbers, with the names and units above it.

    Raises
    ------
    FileError
        ``no_numbers``, ``ambiguous_decimal``, ``thousands_separator``, ``unknown_unit``.
    """
    lines = document.lines
    # Of a long file a few lines tell which ways of writing occur.
    some = lines[:: len(lines) // _SAMPLED + 1]
    ways = [way for way in _WAYS if _run(some, *way).cells] if len(lines) > _SAMPLED else _WAYS
    found = max((_run(lines, *way) for way in ways), key=lambda each: each.lines, default=_Layout(0, 0, 0, None, "."))
    _refuse_thousands(document, found)
    if found.lines == 0:
        first = next((line for line in lines if line.strip()), "")
        rule = "hold lines of two or more numbers, separated by ; tab , or blanks"
        raise document.error("no_numbers", rule, Shown(repr(first[:60])))
    header = lines[: found.first]
    names, units = _titles(document, header, found)
    text = _clean(lines[found.first : found.first + found.lines], found)
    data = np.loadtxt(text, delimiter=found.delimiter, ndmin=2, comments=None)
    factors = np.array([1.0 if unit is None else factor_of(unit) for unit in units])
    return DeviceTable(
        columns={name: np.ascontiguousarray(data[:, place] * factors[place]) for place, name in enumerate(names)},
        units=units,
        decimals=_decimals(text, found),
        header=header,
        delimiter=found.delimiter,
        decimal=found.decimal,
        rows=found.lines,
    )


def _run(lines: list[str], delimiter: str | None, decimal: str) -> _Layout:
    """Return the longest run of lines of numbers with a delimiter and a decimal sign."""
    number = _NUMBER.replace("{point}", re.escape(decimal))
    cell = _CELL.replace("{number}", number)
    if delimiter is None:
        cell = f'"?{number}"?'
        pattern = re.compile(rf"[ \t]*{cell}(?:[ \t]+{cell})+[ \t]*")
    else:
        between = re.escape(delimiter)
        if delimiter == "\t":
            cell = cell.replace(r"\t", "")
        pattern = re.compile(rf"{cell}(?:{between}{cell})+(?:{between}[ \"]*)*")
    best = _Layout(0, 0, 0, delimiter, decimal)
    first = cells = 0
    for place, line in enumerate([*lines, ""]):
        own = _count(line, delimiter) if pattern.fullmatch(line) else 0
        if own != cells:
            if cells and place - first > best.lines:
                best = _Layout(first, place - first, cells, delimiter, decimal)
            first, cells = place, own
    return best


def _count(line: str, delimiter: str | None) -> int:
    """Return how many cells a line has, without empty ones at its end."""
    return len(line.split()) if delimiter is None else line.rstrip(f'{delimiter} \t"').count(delimiter) + 1


def _clean(lines: list[str], layout: _Layout) -> list[str]:
    """Return lines of numbers as NumPy reads them."""
    block = "\n".join(lines).replace('"', "")
    if layout.decimal == ",":
        block = block.replace(",", ".")
    cleaned = block.split("\n")
    if layout.delimiter is None:
        return cleaned
    end = f"{layout.delimiter} \t"
    return [line.rstrip(end) if line[-1] in end else line for line in cleaned]


def _decimals(text: list[str], layout: _Layout) -> list[int]:
    """Return the digits behind the point, at most, of each column, in the first and last lines."""
    most = [0] * layout.cells
    for line in (*text[:50], *text[-50:]):
        for place, cell in enumerate(line.split(layout.delimiter)):
            mantissa, _, power = cell.strip().lower().partition("e")
            digits = len(mantissa.partition(".")[2]) - int(power or 0)
            most[place] = max(most[place], digits)
    return most


def _cells(line: str, delimiter: str | None) -> list[str]:
    """Return the cells of a line without quotes, and without empty ones at its end."""
    parts = line.split() if delimiter is None else line.split(delimiter)
    found = [part.strip().strip('"').strip() for part in parts]
    while found and not found[-1]:
        found.pop()
    return found


def _titles(document: Document, header: list[str], layout: _Layout) -> tuple[list[str], list[str | None]]:
    """Return names and units of the columns."""
    unit_row: list[str] | None = None
    for above in range(len(header) - 1, -1, -1):
        cells = _cells(header[above], layout.delimiter)
        if len(cells) != layout.cells:
            continue
        if unit_row is None and all(plain(cell.strip("[]()")) for cell in cells if cell.strip("[]()-")) and any(cells):
            unit_row = [cell.strip("[]()-") for cell in cells]
            continue
        return _named(document, cells, unit_row, above + 1)
    _refuse_halves(document, header, layout)
    names = [f"column_{place}" for place in range(1, layout.cells + 1)]
    return names, [unit or None for unit in unit_row] if unit_row else [None] * layout.cells


def _named(
    document: Document, cells: list[str], unit_row: list[str] | None, line: int
) -> tuple[list[str], list[str | None]]:
    """Return names without the units in brackets, or as in "force / N" and "force in N", behind them, and these."""
    names: list[str] = []
    units: list[str | None] = []
    for place, cell in enumerate(cells):
        bracketed = _BRACKETS.match(cell)
        name, unit = bracketed.groups() if bracketed else _divided(cell)
        given = unit or (unit_row[place] if unit_row else "")
        if given and plain(given) is None:
            rule = f"have a unit that is known ({KNOWN})"
            remedy = "write the unit as one of them, or leave it out"
            raise document.error("unknown_unit", rule, given, remedy, line=line, key=f"column {name or place + 1}")
        name = name or f"column_{place + 1}"
        names.append(name if name not in names else f"{name}_{place + 1}")
        units.append(given or None)
    return names, units


def _divided(cell: str) -> tuple[str, str]:
    """Return the name and the unit of "force / N" or "force in N"; no unit where the quotient is one itself ("m/s")."""
    found = _QUOTIENT.match(cell)
    if found is None or plain(found[2]) is None or plain(found[1].split()[-1]) is not None:
        return cell, ""
    return found[1], found[2]


def _refuse_halves(document: Document, header: list[str], layout: _Layout) -> None:
    """Refuse commas between and within numbers: twice as many cells as names."""
    if layout.delimiter != ",":
        return
    for above in range(len(header) - 1, -1, -1):
        if 2 * len(_cells(header[above], ",")) == layout.cells:
            rule = "have as many numbers in a line as names above them"
            remedy = "write numbers with a decimal point, or separate them by ;"
            found = Shown(f"{layout.cells // 2} names and {layout.cells} numbers")
            raise document.error("ambiguous_decimal", rule, found, remedy, line=layout.first + 1)


def _refuse_thousands(document: Document, layout: _Layout) -> None:
    """Refuse numbers with both signs where lines of them are no data."""
    for place, line in enumerate(document.lines):
        if layout.first <= place < layout.first + layout.lines:
            continue
        for delimiter in (";", "\t", None):
            cells = _cells(line, delimiter)
            odd = next((cell for cell in cells if _THOUSANDS.match(cell)), None)
            if odd is not None and len(cells) > 1:
                rule = "have numbers without a separator of thousands"
                raise document.error("thousands_separator", rule, odd, "export without it", line=place + 1)
