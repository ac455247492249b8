"""Columns of a sweep that look like arrays and are read where they are used."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from hrsafety.errors import MissingExtraError
from hrsafety.sweep.axes import Column

__all__ = ["LazyColumn", "dask_array"]

Values = npt.NDArray[Any]


class Chunks(Protocol):
    """Where the chunks are: a folder, which is pickled to workers that see it, or memory."""

    def read(self, index: int, names: tuple[str, ...]) -> dict[str, Values]: ...


class LazyColumn:
    """A column in the shape of its grid; a part of it is read from the chunks that hold it.

    Parameters
    ----------
    store : Folder or Memory
        Where the chunks are.
    column : Column
        Which.
    shape : tuple of int
        The last dimension is the fastest.
    chunk_rows : int
        Rows of the result in a chunk.
    """

    def __init__(self, store: Chunks, column: Column, shape: tuple[int, ...], chunk_rows: int) -> None:
        self._store, self._column, self._chunk_rows = store, column, chunk_rows
        self.shape = shape
        self.dtype = column.decoded(np.empty(0, dtype=column.stored)).dtype

    @property
    def ndim(self) -> int:
        """Number of dimensions."""
        return len(self.shape)

    def __getitem__(self, key: Any) -> Values:
        """Return a part: slices, whole numbers or arrays of them, one for each of the first dimensions."""
        keys = key if isinstance(key, tuple) else (key,)
        keys = (*keys, *[slice(None)] * (self.ndim - len(keys)))
        taken = [np.arange(size)[each] for size, each in zip(self.shape, keys, strict=True)]
        grid = np.ix_(*[np.atleast_1d(each) for each in taken])
        rows = np.ravel_multi_index(grid, self.shape)
        found = self._rows(np.asarray(rows).ravel())
        return found.reshape([len(each) for each in taken if each.ndim])

    def _rows(self, rows: npt.NDArray[np.intp]) -> Values:
        """Return rows by their numbers; each chunk is read once."""
        found = np.empty(len(rows), dtype=self._column.stored)
        chunks = rows // self._chunk_rows
        for index in np.unique(chunks):
            here = chunks == index
            stored = self._store.read(int(index), (self._column.name,))[self._column.name]
            found[here] = stored[rows[here] - index * self._chunk_rows]
        return self._column.decoded(found)


def dask_array(lazy: LazyColumn) -> Any:
    """Return a Dask array whose blocks hold about as many rows as a chunk, each one run of rows.

    Raises
    ------
    MissingExtraError
        If Dask is not installed.
    """
    try:
        import dask.array
    except ModuleNotFoundError:
        raise MissingExtraError('lazy arrays need Dask: pip install "dask[distributed]"') from None
    blocks = tuple(_blocks(lazy.shape, lazy._chunk_rows))
    from_array: Any = dask.array.from_array
    made: Any = from_array(lazy, chunks=blocks, asarray=False, meta=np.empty((0,) * lazy.ndim, lazy.dtype))
    return made


def _blocks(shape: tuple[int, ...], most: int) -> Iterable[int]:
    """Return the sides of a block: whole dimensions from the last one on, as many as fit."""
    sides, room = [], most
    for size in reversed(shape):
        side = max(min(size, room), 1)
        sides.append(side)
        room = room // size if side == size else 1
    return reversed(sides)
