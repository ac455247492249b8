"""The result of a sweep in other formats: Polars, pandas, xarray, Parquet, NPZ, CSV."""

from __future__ import annotations

import itertools
import json
import os
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from hrsafety._atomic import replacing
from hrsafety.errors import MissingExtraError
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep.axes import Axis, Column
from hrsafety.sweep.designs import Design, Grid
from hrsafety.sweep.lazy_columns import LazyColumn, dask_array
from hrsafety.sweep.storage import SweepError
from hrsafety.tables import unit_suffix, write_with_warnings

if TYPE_CHECKING:
    import pandas
    import polars
    import xarray

__all__ = ["require_polars", "to_csv", "to_npz", "to_pandas", "to_parquet", "to_polars", "to_xarray"]

# Array of an NPZ file and metadata of a Parquet file that hold units and provenance.
NPZ_TEXT = "_hrsafety"
PARQUET_KEY = "hrsafety"


class Stored(Protocol):
    """Result that is written or counted: a `SweepResult`, which knows this module."""

    @property
    def design(self) -> Design: ...
    @property
    def axes(self) -> tuple[Axis, ...]: ...
    @property
    def cases(self) -> tuple[str, ...]: ...
    @property
    def columns(self) -> tuple[Column, ...]: ...
    @property
    def found(self) -> tuple[Column, ...]: ...
    @property
    def provenance(self) -> dict[str, Any]: ...
    @property
    def warnings(self) -> tuple[ResultWarning, ...]: ...
    @property
    def complete(self) -> bool: ...
    @property
    def finished(self) -> tuple[int, ...]: ...
    @property
    def chunk_count(self) -> int: ...
    def __len__(self) -> int: ...
    def selected(self, names: Sequence[str]) -> tuple[Column, ...]: ...
    def stored_chunks(self, columns: Sequence[Column]) -> Iterator[Mapping[str, npt.NDArray[Any]]]: ...
    def to_numpy(self, names: Sequence[str]) -> dict[str, npt.NDArray[Any]]: ...
    def lazy(self, column: Column, shape: tuple[int, ...]) -> LazyColumn: ...


def require_polars() -> Any:
    """Return Polars, or say how it is installed."""
    try:
        import polars
    except ModuleNotFoundError:
        raise MissingExtraError("this format needs Polars: pip install polars") from None
    return polars


def description(result: Stored, columns: Sequence[Column]) -> str:
    """Return units and provenance as JSON.

    Parameters
    ----------
    result : Stored
        The result.
    columns : sequence of Column
        Columns that are written.

    Returns
    -------
    str
        One object with ``units`` and ``provenance``.
    """
    units = {column.name: column.unit for column in columns}
    return json.dumps({"units": units, "provenance": result.provenance}, ensure_ascii=False)


def _schema(columns: Sequence[Column]) -> dict[str, Any]:
    pl = require_polars()
    kinds = {"number": pl.Float64, "integer": pl.Int64, "flag": pl.Boolean}
    return {each.name: pl.Enum(each.words) if each.words else kinds[each.kind] for each in columns}


def _frame(stored: Mapping[str, npt.NDArray[Any]], schema: Mapping[str, Any], columns: Sequence[Column]) -> Any:
    """Return a chunk as a data frame."""
    pl = require_polars()
    series = {}
    for column in columns:
        values = stored[column.name]
        if column.words:
            series[column.name] = pl.Series(list(column.words))[values.astype(np.uint32)].cast(schema[column.name])
        else:
            series[column.name] = pl.Series(values)
    return pl.DataFrame(series, schema=schema)


def to_polars(result: Stored, columns: Sequence[Column]) -> polars.DataFrame:
    """Return a data frame, see `SweepResult.to_polars`."""
    pl = require_polars()
    schema = _schema(columns)
    frames = [_frame(stored, schema, columns) for stored in result.stored_chunks(columns)]
    frame: polars.DataFrame = pl.concat([pl.DataFrame(schema=schema), *frames], rechunk=True)
    return frame


def to_pandas(result: Stored, columns: Sequence[Column]) -> pandas.DataFrame:
    """Return a data frame, see `SweepResult.to_pandas`."""
    try:
        import pandas
    except ModuleNotFoundError:
        raise MissingExtraError("this format needs pandas: pip install pandas") from None
    found = result.to_numpy([column.name for column in columns])
    words = {column.name: list(column.words) for column in columns if column.words}
    frame: pandas.DataFrame = pandas.DataFrame(
        {
            name: pandas.Categorical(values, categories=words[name]) if name in words else values
            for name, values in found.items()
        }
    )
    frame.attrs["units"] = {column.name: column.unit for column in columns}
    if result.warnings:
        frame.attrs["warnings"] = [asdict(each) for each in result.warnings]
    return frame


def to_csv(result: Stored, columns: Sequence[Column], path: str | os.PathLike[str]) -> Path:
    """Write a CSV file, see `SweepResult.to_csv`."""
    titles = {column.name: _title(column) for column in columns}
    # The header stands there before the first chunk does.
    header = {titles[column.name]: np.empty(0, dtype=column.stored) for column in columns}
    parts = (
        {titles[column.name]: column.decoded(stored[column.name]) for column in columns}
        for stored in result.stored_chunks(columns)
    )
    return write_with_warnings(path, itertools.chain([header], parts), result.warnings)


def _title(column: Column) -> str:
    """Return the name of a column with its unit, as in the files of the command line, not twice."""
    return column.name if column.name.endswith(f"_{column.unit}") else column.name + unit_suffix(column.unit)


def to_parquet(result: Stored, columns: Sequence[Column], path: Path) -> Path:
    """Write a Parquet file, see `SweepResult.to_parquet`."""
    pl = require_polars()
    from polars.io.plugins import register_io_source

    schema = _schema(columns)
    # Words pass as text and become an Enum behind the source: earlier releases lose it on the way.
    passed = {name: pl.String if isinstance(kind, pl.Enum) else kind for name, kind in schema.items()}

    def chunks(names: list[str] | None, predicate: Any, rows: int | None, _size: int | None) -> Iterator[Any]:
        left = rows
        for stored in result.stored_chunks(columns):
            frame = _frame(stored, passed, columns)
            frame = frame if names is None else frame.select(names)
            frame = frame if left is None else frame.head(left)
            left = None if left is None else left - len(frame)
            yield frame if predicate is None else frame.filter(predicate)

    lazy: Any = register_io_source(chunks, schema=passed)
    lazy = lazy.cast(schema)
    with replacing(path) as file:
        lazy.sink_parquet(file, metadata={PARQUET_KEY: description(result, columns)}, maintain_order=True)
    return path


def to_npz(result: Stored, columns: Sequence[Column], path: Path) -> Path:
    """Write an NPZ file, see `SweepResult.to_npz`."""
    with replacing(path) as file, zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        for column in columns:
            kind = column.decoded(np.empty(0, dtype=column.stored)).dtype
            header = {"descr": np.lib.format.dtype_to_descr(kind), "fortran_order": False, "shape": (len(result),)}
            with archive.open(zipfile.ZipInfo(f"{column.name}.npy"), "w", force_zip64=True) as member:
                np.lib.format.write_array_header_1_0(member, header)
                for stored in result.stored_chunks([column]):
                    member.write(np.ascontiguousarray(column.decoded(stored[column.name])).tobytes())
        with archive.open(zipfile.ZipInfo(f"{NPZ_TEXT}.npy"), "w") as member:
            np.lib.format.write_array(member, np.array(description(result, columns)), allow_pickle=False)
    return path


def to_xarray(result: Stored, columns: Sequence[Column], *, lazy: bool = False) -> xarray.Dataset:
    """Return a dataset, see `SweepResult.to_xarray`."""
    try:
        import xarray
    except ModuleNotFoundError:
        raise MissingExtraError("this format needs xarray: pip install xarray") from None
    if not result.complete:
        text = f"{len(result.finished)} of {result.chunk_count} chunks"
        raise SweepError(f"the sweep is not complete ({text}); run it again to resume")
    case = result.columns[len(result.axes)].name if result.cases else None
    lengths = [len(result.cases)] if result.cases else []
    coordinates: dict[str, Any] = {} if case is None else {case: ((case,), list(result.cases))}
    if isinstance(result.design, Grid):
        dimensions = [axis.name for axis in result.axes]
        shape = [*result.design.shape, *lengths]
        for axis in result.axes:
            coordinates[axis.name] = ((axis.name,), axis.levels(), _attributes(axis))
    else:
        dimensions, shape = ["row"], [len(result.design), *lengths]
        known = {column.name: column for column in result.columns}
        own = _arrays(
            result, [known[axis.name] for axis in result.axes], (shape[0], lengths[0] if lengths else 1), lazy
        )
        for axis in result.axes:
            coordinates[axis.name] = (("row",), own[axis.name][:, 0], _attributes(axis))
    along = (*dimensions, *([case] if case else []))
    found = _arrays(result, columns, tuple(shape), lazy)
    variables = {each.name: (along, found[each.name], _attributes(each)) for each in columns}
    return xarray.Dataset(variables, coords=coordinates, attrs={"provenance": json.dumps(result.provenance)})


def _arrays(result: Stored, columns: Sequence[Column], shape: tuple[int, ...], lazy: bool) -> dict[str, Any]:
    """Return columns in a shape, read at once or by Dask when they are used."""
    if lazy:
        return {column.name: dask_array(result.lazy(column, shape)) for column in columns}
    found = result.to_numpy([column.name for column in columns])
    return {name: values.reshape(shape) for name, values in found.items()}


def _attributes(named: Any) -> dict[str, str]:
    """Return the attributes of a variable, by the names that plots of xarray look for."""
    return {"units": named.unit or "", "long_name": named.name.replace("_", " ")}
