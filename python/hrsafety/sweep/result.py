"""The result of a sweep: named columns with units, read chunk by chunk."""

from __future__ import annotations

import html
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import flag, sequence, word
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep import exports
from hrsafety.sweep.axes import Axis, Column
from hrsafety.sweep.designs import Design, Grid
from hrsafety.sweep.lazy_columns import LazyColumn
from hrsafety.sweep.sampled_designs import LatinHypercube, Saltelli, Sobol
from hrsafety.sweep.shares import SweepShares, counted
from hrsafety.sweep.storage import Folder, Memory, stored_columns

if TYPE_CHECKING:
    import pandas
    import polars
    import xarray

__all__ = ["SweepResult", "open"]

Values = npt.NDArray[Any]


class SweepResult:
    """The columns of a sweep, one row for each row of the design and each case.

    Rows stand in the order of the design; the cases of a row (the scenarios of a
    `NavigationStudy`) follow each other. Nothing is read before it is asked for, then chunk by
    chunk, and checksums are compared on the way. Made by `run` and `open`.

    Parameters
    ----------
    store : object
        Where the chunks are.

    Examples
    --------
    >>> from hrsafety import impact, sweep
    >>> study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())
    >>> result = sweep.run(sweep.Grid([sweep.Axis(name="closing_speed", values=[0.4, 1.25])]), study)
    >>> result.axes[0].label, result["peak_contact_force"].round(1).tolist()
    ('closing speed (m/s)', [97.8, 305.8])
    """

    def __init__(self, store: Folder | Memory) -> None:
        self._store = store
        settings = store.manifest["settings"]
        self._columns = stored_columns(settings)
        axes = [Axis(**{**each, "values": _tuple(each["values"])}) for each in settings["design"]["axes"]]
        self._design = _design(settings["design"], axes)
        self._chunk_rows: int = settings["chunk_rows"]

    # ---- what it is ---------------------------------------------------------------------------------

    @property
    def columns(self) -> tuple[Column, ...]:
        """All columns: axes, cases, what was found."""
        return self._columns

    @property
    def axes(self) -> tuple[Axis, ...]:
        """Varied axes, with units."""
        return self._design.axes

    @property
    def design(self) -> Design:
        """Which rows were run."""
        return self._design

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why the result may not mean what it seems to; empty when there is no doubt."""
        of_study = (ResultWarning(**each) for each in self._store.manifest.get("warnings", ()))
        return (*self._design.warnings, *of_study, *self._unfinished())

    def _unfinished(self) -> Iterator[ResultWarning]:
        """Doubt numbers of a part of the rows: the hardest cases may be those that are not there yet."""
        done, whole = len(self.finished), self.chunk_count
        if done < whole:
            message = (
                f"{done} of {whole} chunks are finished: rows, extremes and shares are of these only; run the same "
                "sweep again, it resumes"
            )
            yield ResultWarning("incomplete", "chunks", message)

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column by name; empty without one."""
        return {column.name: column.unit for column in self._columns}

    @property
    def cases(self) -> tuple[str, ...]:
        """Cases of each row of the design, for example the scenarios; empty for one."""
        cases = self._store.manifest["settings"]["cases"]
        return tuple(cases[1]) if cases else ()

    @property
    def found(self) -> tuple[Column, ...]:
        """The columns that are neither axes nor cases."""
        return self._columns[len(self.axes) + bool(self.cases) :]

    @property
    def provenance(self) -> dict[str, Any]:
        """Version, settings with seed, fingerprint, time, environment, warnings, and how many chunks there are."""
        manifest = dict(self._store.manifest)
        parts = {"finished": len(self.finished), "of": self.chunk_count}
        doubts = [asdict(each) for each in self.warnings]
        return {"version": manifest["settings"]["version"], **manifest, "warnings": doubts, "chunks": parts}

    @property
    def folder(self) -> Path | None:
        """Where the chunks are; ``None`` in memory."""
        return self._store.path if isinstance(self._store, Folder) else None

    @property
    def finished(self) -> tuple[int, ...]:
        """Numbers of the chunks that are there."""
        return tuple(index for index in self._store.finished() if index < self.chunk_count)

    @property
    def chunk_count(self) -> int:
        """Number of chunks of the whole sweep."""
        return -(-len(self._design) // self._chunk_rows)

    @property
    def complete(self) -> bool:
        """Whether all chunks are there."""
        return len(self.finished) == self.chunk_count

    def __len__(self) -> int:
        """Return the number of rows that are there."""
        last = self.chunk_count - 1
        finished = self.finished
        rows = len(finished) * self._chunk_rows
        if finished and finished[-1] == last:
            rows -= self.chunk_count * self._chunk_rows - len(self._design)
        return rows * max(len(self.cases), 1)

    def __repr__(self) -> str:
        """Return design, size and names."""
        doubts = "".join(f"; {warning}" for warning in self.warnings)
        state = "" if self.complete else f", {len(self.finished)} of {self.chunk_count} chunks"
        names = ", ".join(column.name for column in self._columns)
        return f"SweepResult({self._design.kind}, {len(self)} rows{state}: {names}{doubts})"

    def _repr_html_(self) -> str:
        """Return design, size, columns with units, and warnings as a notebook shows them; no chunk is read."""
        title = f"SweepResult: {repr(self).split('(', 1)[1].split(':', 1)[0]}"
        kinds = {axis.name: "axis" for axis in self.axes}
        if self.cases:
            kinds[self.columns[len(self.axes)].name] = "case"
        rows = "".join(
            "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in cells) + "</tr>"
            for cells in ((each.name, kinds.get(each.name, each.kind), each.unit) for each in self.columns)
        )
        doubts = "".join(f"<p>{html.escape(str(each))}</p>" for each in self.warnings)
        head = "<thead><tr><th>column</th><th>kind</th><th>unit</th></tr></thead>"
        return f"<p>{html.escape(title)}</p><table>{head}<tbody>{rows}</tbody></table>{doubts}"

    # ---- numbers ------------------------------------------------------------------------------------

    def chunks(self, names: Iterable[str] | None = None) -> Iterator[dict[str, Values]]:
        """Yield the columns of each finished chunk, one after the other.

        Parameters
        ----------
        names : iterable of str or None
            Columns to read; all when ``None``.

        Yields
        ------
        dict of str to ndarray
            By name; words as text.

        Raises
        ------
        InvalidParameterError
            If a name is unknown.
        SweepError
            If a file is damaged.
        """
        chosen = self.selected(names)
        for stored in self.stored_chunks(chosen):
            yield {column.name: column.decoded(stored[column.name]) for column in chosen}

    def selected(self, names: Iterable[str] | None = None) -> tuple[Column, ...]:
        """Return the columns with these names, all when ``None``."""
        if names is None:
            return self._columns
        known = {column.name: column for column in self._columns}
        return tuple(known[word("names", name, tuple(known))] for name in sequence("names", "be names", names))

    def stored_chunks(self, columns: Iterable[Column]) -> Iterator[dict[str, Values]]:
        """Yield columns of each finished chunk as they are stored: words by their numbers."""
        names = tuple(column.name for column in columns)
        for index in self.finished:
            yield self._store.read(index, names)

    def __getitem__(self, name: str) -> Values:
        """Return one column.

        Raises
        ------
        InvalidParameterError
            If the name is unknown.
        """
        return self.to_numpy([name])[name]

    def to_numpy(self, names: Iterable[str] | None = None) -> dict[str, Values]:
        """Return whole columns by name; words as text.

        Parameters
        ----------
        names : iterable of str or None
            Columns; all when ``None``.

        Returns
        -------
        dict of str to ndarray
            Each of the length of the result.
        """
        chosen = self.selected(names)
        merged = {column.name: np.empty(len(self), dtype=column.stored) for column in chosen}
        start = 0
        for stored in self.stored_chunks(chosen):
            stop = start + (len(next(iter(stored.values()))) if stored else 0)
            for name, values in stored.items():
                merged[name][start:stop] = values
            start = stop
        return {column.name: column.decoded(merged[column.name]) for column in chosen}

    def shares(self, name: str, by: Iterable[str] = ()) -> SweepShares:
        """Return how often each word of a column occurs in groups of the rows, with 95 % Wilson intervals.

        Every group has a row for each word, so also for what never happened, whose upper end tells how often it may.

        Parameters
        ----------
        name : str
            A column of words or flags, or of counts: of these the share of rows with none and with some. ``"collided"``
            of ``"outcome"`` leaves out contacts of worlds that diverged later; the columns of contacts have them.
        by : iterable of str
            Axes with levels (of a grid, or with values or whole numbers in a sample) and the column of the cases: rows
            with the same values are a group. All rows are one without any.

        Returns
        -------
        SweepShares
            A table: a row for each group and word.

        Raises
        ------
        InvalidParameterError
            If a column is unknown or cannot be counted, or an axis has no levels.
        SweepError
            If a file is damaged.

        Examples
        --------
        >>> from hrsafety import scenarios, sweep
        >>> noise = sweep.Axis(name="measurement_scale", values=[0.02, 0.05])
        >>> seeds = sweep.Axis(name="seed", low=0, high=49, scale="integer")
        >>> study = sweep.NavigationStudy(scenarios=scenarios.configuration("c2"))
        >>> table = sweep.run(sweep.Grid([noise, seeds]), study).shares("outcome", by=["measurement_scale"])
        >>> arrived = table.word == "arrived"
        >>> table.group["measurement_scale"][arrived].tolist(), table.rows[arrived].tolist()
        ([0.02, 0.05], [50, 50])
        """
        return counted(self, name, by)

    # ---- other formats ------------------------------------------------------------------------------

    def to_polars(self, names: Iterable[str] | None = None) -> polars.DataFrame:
        """Return a Polars data frame; words are an ``Enum``.

        Parameters
        ----------
        names : iterable of str or None
            Columns; all when ``None``.

        Returns
        -------
        polars.DataFrame
            A row for each row of the result.

        Raises
        ------
        MissingExtraError
            If Polars is not installed.
        """
        return exports.to_polars(self, self.selected(names))

    def to_pandas(self, names: Iterable[str] | None = None) -> pandas.DataFrame:
        """Return a pandas data frame; words are categories.

        Parameters
        ----------
        names : iterable of str or None
            Columns; all when ``None``.

        Returns
        -------
        pandas.DataFrame
            A row for each row of the result; ``attrs["units"]`` holds the unit of each column, and
            ``attrs["warnings"]`` the warnings, if there are any, as dictionaries.

        Raises
        ------
        MissingExtraError
            If pandas is not installed.
        """
        return exports.to_pandas(self, self.selected(names))

    def to_csv(self, path: str | os.PathLike[str], names: Iterable[str] | None = None) -> Path:
        """Write a CSV file, chunk by chunk, with units in the header, ``closing_speed_m_per_s``.

        Cells and the second file for warnings are those of `Table.to_csv` (`hrsafety.tables`).

        Parameters
        ----------
        path : path-like
            The file; replaced in one step when it is complete.
        names : iterable of str or None
            Columns; all when ``None``.

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
        return exports.to_csv(self, self.selected(names), path)

    def lazy(self, column: Column, shape: tuple[int, ...]) -> LazyColumn:
        """Return a column that is read where it is used, in the shape of its dimensions."""
        return LazyColumn(self._store, column, shape, self._chunk_rows * max(len(self.cases), 1))

    def to_xarray(self, names: Iterable[str] | None = None, *, lazy: bool = False) -> xarray.Dataset:
        """Return an xarray dataset with units and provenance.

        A grid has a dimension for each axis, and one for the cases. Other designs have the
        dimension ``row``, with the axes as coordinates along it.

        Parameters
        ----------
        names : iterable of str or None
            Columns that are neither axes nor cases; all of them when ``None``.
        lazy : bool
            Whether variables are Dask arrays, read block by block when they are computed (extra
            ``distributed``); results that do not fit into memory need it.

        Returns
        -------
        xarray.Dataset
            Units are the attribute ``units`` of each variable.

        Raises
        ------
        SweepError
            If the sweep is not complete.
        MissingExtraError
            If xarray is not installed, or Dask for lazy variables.
        """
        flag("lazy", lazy)
        chosen = self.found if names is None else self.selected(names)
        for column in chosen:
            word("names", column.name, [each.name for each in self.found])
        return exports.to_xarray(self, chosen, lazy=lazy)

    def to_parquet(self, path: str | os.PathLike[str], names: Iterable[str] | None = None) -> Path:
        """Write a Parquet file, chunk by chunk, through Polars.

        Units and provenance are the metadata ``hrsafety`` of the file, as JSON.

        Parameters
        ----------
        path : path-like
            The file; replaced in one step when it is complete.
        names : iterable of str or None
            Columns; all when ``None``.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        MissingExtraError
            If Polars is not installed.
        """
        return exports.to_parquet(self, self.selected(names), Path(path))

    def to_npz(self, path: str | os.PathLike[str], names: Iterable[str] | None = None) -> Path:
        """Write an uncompressed NPZ file, chunk by chunk: an array for each column.

        Units and provenance are the text array ``_hrsafety``, as JSON.

        Parameters
        ----------
        path : path-like
            The file; replaced in one step when it is complete.
        names : iterable of str or None
            Columns; all when ``None``.

        Returns
        -------
        Path
            The file.
        """
        return exports.to_npz(self, self.selected(names), Path(path))

    def shape(self) -> tuple[int, ...]:
        """Return the shape of a column of a grid: its axes, then the cases if there are any.

        Raises
        ------
        InvalidParameterError
            If the design is no grid.
        """
        if not isinstance(self._design, Grid):
            raise InvalidParameterError("design", "be a grid", self._design.kind)
        return (*self._design.shape, *([len(self.cases)] if self.cases else []))


def _design(settings: Mapping[str, Any], axes: Sequence[Axis]) -> Design:
    """Return the design that a manifest describes."""
    if settings["kind"] == Grid.kind:
        return Grid(tuple(axes))
    if settings["kind"] == LatinHypercube.kind:
        return LatinHypercube(tuple(axes), settings["rows"], settings["seed"])
    if settings["kind"] == Saltelli.kind:
        return Saltelli(tuple(axes), settings["size"], settings["seed"])
    return Sobol(tuple(axes), settings["rows"], settings["seed"], settings["scramble"])


def _tuple(values: list[float] | None) -> tuple[float, ...] | None:
    return None if values is None else tuple(values)


def open(folder: str | os.PathLike[str]) -> SweepResult:
    """Return the result of a sweep from its folder, complete or not.

    Parameters
    ----------
    folder : path-like
        The ``out`` of `run`.

    Returns
    -------
    SweepResult
        Of the chunks that are there.

    Raises
    ------
    SweepError
        If the folder holds no sweep.

    Examples
    --------
    >>> from hrsafety import impact, sweep
    >>> study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())
    >>> speeds = sweep.Grid([sweep.Axis(name="closing_speed", low=0.2, high=2.0, points=10)])
    >>> made = sweep.run(speeds, study, out="speeds")
    >>> sweep.open("speeds").complete
    True
    """
    if not isinstance(folder, (str, os.PathLike)) or not isinstance(os.fspath(folder), str):
        raise InvalidParameterError("folder", "be the path of a folder", folder)
    return SweepResult(Folder(Path(folder)))
