"""Results as tables: columns by name, Polars, pandas, CSV.

A result that is a table derives from `Table` and says what its columns are; the formats are written
here, once. Names of columns carry their unit (``x_m``, ``vx_m_per_s``), as in the files of the command
line; a quantity without a unit has none. Summaries that are also the columns of a sweep
(`hrsafety.sweep`) keep the names of the sweep, whose units are beside them.
"""

from __future__ import annotations

import dataclasses
import importlib
import math
import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from hrsafety._calls import suggest
from hrsafety.errors import InvalidParameterError, MissingExtraError

if TYPE_CHECKING:
    from pathlib import Path

    import pandas
    import polars

    from hrsafety.plausibility import ResultWarning

__all__ = ["SHOWN_ROWS", "Column", "Columns", "Table", "each", "plane", "unit_suffix", "with_units", "write_csv"]

Column = npt.NDArray[Any]
Columns = dict[str, Column]
"""One-dimensional arrays of one length by name, in the order of the table."""

SHOWN_ROWS = 5
"""Rows that a table shows when it is printed."""
_SHOWN_COLUMNS = 8
_WARNING = ("code", "subject", "message", "safe_side")
SHOWN_WARNINGS = 4
"""Warnings that a table shows when it is printed."""


class Table:
    """Base of the results that are tables: `columns` is theirs, the formats are shared.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
    >>> run.to_polars().columns[:3]
    ['t_s', 'x_m', 'y_m']
    >>> run.to_csv("run.csv").read_text().split(",")[:3]
    ['t_s', 'x_m', 'y_m']
    """

    __slots__ = ()

    def columns(self) -> Columns:
        """Return one-dimensional columns by name.

        Returns
        -------
        dict of str to ndarray
            All of one length.
        """
        raise NotImplementedError

    def __repr__(self) -> str:
        """Return the first rows, how much more there is, and the warnings."""
        header, cells, title = self._shown()
        lines = [header, *cells]
        widths = [max(len(line[index]) for line in lines) for index in range(len(header))]
        rows = ["  ".join(cell.rjust(width) for cell, width in zip(line, widths, strict=True)) for line in lines]
        return "\n".join([title, *rows, *self._doubts()])

    def _repr_html_(self) -> str:
        """Return the first rows as a notebook shows them."""
        import html

        header, cells, title = self._shown()
        head = "".join(f"<th>{html.escape(name)}</th>" for name in header)
        body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in cells)
        doubts = "".join(f"<p>{html.escape(line)}</p>" for line in self._doubts())
        return f"<p>{html.escape(title)}</p><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{doubts}"

    def _doubts(self) -> list[str]:
        """Return the lines of the warnings that the result carries; of many the others are counted."""
        found = [str(each) for each in getattr(self, "warnings", ())]
        more = len(found) - SHOWN_WARNINGS
        return found if more <= 0 else [*found[:SHOWN_WARNINGS], f"and {more} more: see .warnings"]

    def _head(self) -> tuple[Columns, int]:
        """Return the columns of the first rows, and the number of all rows."""
        columns = self.columns()
        head = {name: values[:SHOWN_ROWS] for name, values in columns.items()}
        return head, len(next(iter(columns.values())))

    def _telling(self) -> tuple[str, ...]:
        """Return the columns that are printed before the others."""
        return ()

    def _shown(self) -> tuple[list[str], list[list[str]], str]:
        """Return header, cells and title of the part that is printed."""
        head, rows = self._head()
        telling = [name for name in self._telling() if name in head]
        header = [*telling, *(name for name in head if name not in telling)][:_SHOWN_COLUMNS]
        columns = [[_short(value) for value in head[name].tolist()] for name in header]
        title = f"{type(self).__name__}: {rows} rows, {len(head)} columns"
        if rows > SHOWN_ROWS or len(head) > len(header):
            title += f"; here {min(rows, SHOWN_ROWS)} rows and {len(header)} columns"
        return header, [list(row) for row in zip(*columns, strict=True)], title

    def to_polars(self) -> polars.DataFrame:
        """Return a Polars data frame.

        Returns
        -------
        polars.DataFrame
            The columns of ``columns()``.

        Raises
        ------
        MissingExtraError
            If Polars is not installed.
        """
        frame: polars.DataFrame = _library("polars", "Polars").DataFrame(
            {name: values.tolist() if values.dtype.kind == "U" else values for name, values in self.columns().items()}
        )
        return frame

    def to_pandas(self) -> pandas.DataFrame:
        """Return a pandas data frame.

        Returns
        -------
        pandas.DataFrame
            The columns of ``columns()``; ``attrs["warnings"]`` holds the warnings of the result, if it has
            any, as dictionaries of ``code``, ``subject`` and ``message``.

        Raises
        ------
        MissingExtraError
            If pandas is not installed.
        """
        frame: pandas.DataFrame = _library("pandas", "pandas").DataFrame(self.columns())
        doubts = [dataclasses.asdict(each) for each in getattr(self, "warnings", ())]
        if doubts:
            frame.attrs["warnings"] = doubts
        return frame

    def to_csv(self, path: str | os.PathLike[str]) -> Path:
        """Write a CSV file, whole or not at all.

        Numbers are written with all their digits. A cell is empty where there is no number, and
        ``inf`` where it is infinite; flags are ``true`` or ``false``. Warnings of the result are written
        first, into a second file beside it, ``runs.csv.warnings.csv`` for ``runs.csv``; where there are none,
        that of an earlier result is removed.

        Parameters
        ----------
        path : path-like
            The file; its folder must exist.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        InvalidParameterError
            If the path is none, its folder does not exist, or the place of the warnings is taken by a file
            of something else.
        """
        return write_with_warnings(path, [self.columns()], getattr(self, "warnings", ()))


def write_with_warnings(
    path: str | os.PathLike[str], parts: Iterable[Columns], warnings: Iterable[ResultWarning]
) -> Path:
    """Write columns, in pieces one below the other, as a CSV file and the warnings beside it, see `Table.to_csv`."""
    place = _place(path)
    beside = place.with_name(f"{place.name}.warnings.csv")
    doubts = [dataclasses.astuple(each) for each in warnings]
    ours = not beside.exists() or _first_line(beside) == ",".join(_WARNING)
    if doubts and not ours:
        rule = f"leave {beside.name} to the warnings, which is a file of something else"
        raise InvalidParameterError("path", rule, str(place), "choose another name")
    # Rows never stand without the warnings of theirs.
    if doubts:
        columns = (np.array(words) for words in zip(*doubts, strict=True))
        write_csv(beside, dict(zip(_WARNING, columns, strict=True)))
    _write_parts(place, parts)
    if not doubts and ours:
        beside.unlink(missing_ok=True)
    return place


def write_csv(path: str | os.PathLike[str], columns: Columns) -> Path:
    """Write columns as a CSV file, whole or not at all, see `Table.to_csv`.

    Parameters
    ----------
    path : path-like
        The file; its folder must exist.
    columns : dict of str to ndarray
        One-dimensional, all of one length.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidParameterError
        If the path is none, or its folder does not exist.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety.tables import write_csv
    >>> path = write_csv("run.csv", {"t_s": np.array([0.0, 0.1]), "distance_m": np.array([np.nan, 0.3])})
    >>> path.read_text().splitlines()
    ['t_s,distance_m', '0.0,', '0.1,0.3']
    """
    place = _place(path)
    _write_parts(place, [columns])
    return place


def _write_parts(place: Path, parts: Iterable[Columns]) -> None:
    """Write columns that come in pieces, the header once."""
    # Runs are tables, and few of them are written.
    import csv
    import io

    from hrsafety._atomic import replacing

    with replacing(place) as file:
        text = io.TextIOWrapper(file, encoding="utf-8", newline="")
        writer = csv.writer(text, lineterminator="\n")
        for index, columns in enumerate(parts):
            if index == 0:
                writer.writerow(columns)
            writer.writerows(zip(*map(_cells, columns.values()), strict=True))
        text.flush()
        text.detach()


def _first_line(place: Path) -> str:
    with place.open(encoding="utf-8", errors="replace") as file:
        return file.readline().rstrip()


def _short(value: object) -> str:
    """Return a cell as it is printed: six digits are enough to look at."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _place(path: object) -> Path:
    from pathlib import Path

    if not isinstance(path, (str, os.PathLike)) or not isinstance(os.fspath(path), str) or not os.fspath(path):
        raise InvalidParameterError("path", "be the path of a file", path)
    place = Path(os.fspath(path))
    if not place.parent.is_dir():
        raise InvalidParameterError("path", "lie in a folder that exists", str(place), f"make {place.parent} first")
    return place


def _cells(values: Column) -> list[object]:
    """Return the cells of a column as the CSV file shows them."""
    if values.dtype.kind == "b":
        return ["true" if value else "false" for value in values.tolist()]
    if values.dtype.kind == "f":
        return ["" if math.isnan(value) else value for value in values.tolist()]
    return list(values.tolist())


def _library(module: str, name: str) -> Any:
    """Return an optional library."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError:
        raise MissingExtraError(f"this format needs {name}: pip install {module}") from None


# ---- columns from arrays ----------------------------------------------------------------------------


def unit_suffix(unit: str) -> str:
    """Return a unit as the end of a column's name.

    Parameters
    ----------
    unit : str
        For example ``"N/m^2"``; empty without one.

    Returns
    -------
    str
        For example ``"_N_per_m2"``; empty without a unit.

    Examples
    --------
    >>> from hrsafety.tables import unit_suffix
    >>> unit_suffix("m/s"), unit_suffix("N/m^2"), unit_suffix("")
    ('_m_per_s', '_N_per_m2', '')
    """
    if not isinstance(unit, str):
        raise InvalidParameterError("unit", "be the text of a unit", unit)
    words = unit.replace("^", "").replace("/", "_per_").replace("*", "_").replace(" ", "_")
    return f"_{words}" if words else ""


def plane(name: str, values: Column, unit: str) -> Columns:
    """Return the x and y columns of vectors in the plane.

    Parameters
    ----------
    name : str
        With a brace pair for the coordinate: ``"force_{}"``, ``"v{}"``.
    values : ndarray, shape (n, 2)
        The vectors.
    unit : str
        Their unit.

    Returns
    -------
    dict of str to ndarray
        Two columns.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety.tables import plane
    >>> list(plane("v{}", np.zeros((3, 2)), "m/s"))
    ['vx_m_per_s', 'vy_m_per_s']
    """
    return {f"{name.format(axis)}{unit_suffix(unit)}": values[:, index] for index, axis in enumerate("xy")}


def each(name: str, values: Column, unit: str = "") -> Columns:
    """Return a column for each column of a matrix, numbered.

    Parameters
    ----------
    name : str
        With a brace pair for the number: ``"current_{}"``.
    values : ndarray, shape (n, k)
        The matrix.
    unit : str
        Unit of its numbers.

    Returns
    -------
    dict of str to ndarray
        k columns.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety.tables import each
    >>> list(each("current_{}", np.zeros((3, 2)), "A"))
    ['current_0_A', 'current_1_A']
    """
    return {f"{name.format(index)}{unit_suffix(unit)}": values[:, index] for index in range(values.shape[1])}


def with_units(result: object, units: Mapping[str, str]) -> Columns:
    """Return one-dimensional attributes of a result under their names with units.

    Parameters
    ----------
    result : object
        What has the attributes.
    units : mapping of str to str
        Unit of each attribute that is wanted; empty without one. The time is called ``t``.

    Returns
    -------
    dict of str to ndarray
        A column for each attribute.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> from hrsafety.tables import with_units
    >>> reference = nav.robots.WheelReference.sine(duration=1.0)
    >>> list(with_units(reference, {"angle": "rad", "speed": "rad/s"}))
    ['angle_rad', 'speed_rad_per_s']
    """
    return {
        f"{'t' if name == 'time' else name}{unit_suffix(unit)}": getattr(result, name) for name, unit in units.items()
    }


suggest(__all__, globals())
