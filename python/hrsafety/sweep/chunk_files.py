"""The files of chunks: NPZ, which numpy reads by itself, or Parquet."""

from __future__ import annotations

import json
import os
import zipfile
import zlib
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from hrsafety.errors import MissingExtraError
from hrsafety.sweep.axes import Column

__all__ = ["STORES", "ChunkFiles", "NpzFiles", "ParquetFiles", "chunk_files"]

Stored = dict[str, npt.NDArray[Any]]

# Member of an NPZ file, and key of the metadata of a Parquet file, that says which chunk of which sweep it is.
MARK = "_chunk"
PARQUET_KEYS = (b"hrsafety_chunk", b"hrsafety_checksums")
PIECE = 1 << 20
# Length of the record at the end of an archive without a comment.
END_RECORD = 22


class ChunkFiles(ABC):
    """How the columns of a chunk are kept in a file.

    Parameters
    ----------
    columns : sequence of Column
        All columns of the sweep.
    """

    name: str
    suffix: str

    def __init__(self, columns: Sequence[Column]) -> None:
        self.columns = {column.name: column for column in columns}

    @abstractmethod
    def write(self, file: BinaryIO, mark: str, stored: Mapping[str, npt.NDArray[Any]]) -> None:
        """Write a chunk: the same bytes for the same columns."""

    @abstractmethod
    def read(self, path: Path, names: Sequence[str]) -> tuple[str, Stored]:
        """Return the mark and columns of a chunk, their checksums compared.

        Raises
        ------
        Exception
            One of `hrsafety._atomic.DAMAGE` if the file is not what was written.
        """

    def check(self, path: Path) -> None:
        """Read every byte of a file; raise as `read` does if it is not what was written."""
        self.read(path, tuple(self.columns))


class NpzFiles(ChunkFiles):
    """Uncompressed NPZ archives, an array for each column."""

    name, suffix = "npz", ".npz"

    def write(self, file: BinaryIO, mark: str, stored: Mapping[str, npt.NDArray[Any]]) -> None:
        """Write a chunk, see `ChunkFiles.write`."""
        write_archive(file, {MARK: np.array(mark), **stored})

    def read(self, path: Path, names: Sequence[str]) -> tuple[str, Stored]:
        """Return the mark and columns of a chunk, see `ChunkFiles.read`."""
        found = read_archive(path, (MARK, *names))
        return str(found.pop(MARK)), found

    def check(self, path: Path) -> None:
        """Read every byte of a file, see `ChunkFiles.check`."""
        with path.open("rb") as file, zipfile.ZipFile(file) as archive:
            for name in archive.namelist():
                with archive.open(name) as member:
                    while member.read(PIECE):
                        pass
        super().check(path)


class ParquetFiles(ChunkFiles):
    """Parquet files, which other programs read: words as words, units and checksums as metadata."""

    name, suffix = "parquet", ".parquet"

    def __init__(self, columns: Sequence[Column]) -> None:
        super().__init__(columns)
        _pyarrow()

    def write(self, file: BinaryIO, mark: str, stored: Mapping[str, npt.NDArray[Any]]) -> None:
        """Write a chunk, see `ChunkFiles.write`."""
        pa, parquet = _pyarrow()
        checksums = {name: _checksum(values) for name, values in stored.items()}
        told = (mark, json.dumps(checksums))
        arrays = [_arrow(pa, self.columns[name], values) for name, values in stored.items()]
        fields = [
            pa.field(name, array.type, metadata={"units": self.columns[name].unit} if self.columns[name].unit else None)
            for name, array in zip(stored, arrays, strict=True)
        ]
        schema = pa.schema(fields, metadata=dict(zip(PARQUET_KEYS, told, strict=True)))
        # Measured: numbers are least, and fast, with their bytes regrouped; axes and words repeat.
        split = {
            name: "BYTE_STREAM_SPLIT" for name, array in zip(stored, arrays, strict=True) if array.type == pa.float64()
        }
        repeated = [name for name in stored if name not in split]
        parquet.write_table(
            pa.Table.from_arrays(arrays, schema=schema),
            file,
            compression="zstd",
            compression_level=1,
            use_dictionary=repeated,
            column_encoding=split,
        )

    def read(self, path: Path, names: Sequence[str]) -> tuple[str, Stored]:
        """Return the mark and columns of a chunk, see `ChunkFiles.read`."""
        pa, parquet = _pyarrow()
        try:
            table = parquet.read_table(path, columns=list(names), use_threads=False, partitioning=None)
        except pa.ArrowException as error:
            raise ValueError(f"no Parquet file: {error}") from None
        mark, text = (table.schema.metadata[key].decode("utf-8") for key in PARQUET_KEYS)
        checksums = json.loads(text)
        found = {name: _values(pa, self.columns[name], table.column(name)) for name in names}
        for name, values in found.items():
            if _checksum(values) != checksums[name]:
                raise ValueError(f"checksum of the column {name!r}")
        return mark, found


STORES: dict[str, type[ChunkFiles]] = {each.name: each for each in (NpzFiles, ParquetFiles)}
"""Kinds of files by the word that ``store`` takes."""


def chunk_files(store: str, columns: Sequence[Column]) -> ChunkFiles:
    """Return how the chunks of a sweep are kept."""
    return STORES[store](columns)


def _pyarrow() -> tuple[Any, Any]:
    try:
        import pyarrow
        from pyarrow import parquet
    except ModuleNotFoundError:
        raise MissingExtraError("chunks in Parquet need pyarrow: pip install pyarrow") from None
    return pyarrow, parquet


def _checksum(values: npt.NDArray[Any]) -> int:
    return zlib.crc32(np.ascontiguousarray(values).view(np.uint8).data)


def _arrow(pa: Any, column: Column, values: npt.NDArray[Any]) -> Any:
    """Return a column for Arrow: words by their numbers, with the list of all words."""
    if not column.words:
        return pa.array(values)
    return pa.DictionaryArray.from_arrays(pa.array(values.astype(np.int32)), pa.array(column.words, pa.string()))


def _values(pa: Any, column: Column, chunked: Any) -> npt.NDArray[Any]:
    """Return a column of Arrow as it is stored."""
    array = chunked.combine_chunks()
    if isinstance(array, pa.ChunkedArray):  # more than one piece, or none
        array = pa.concat_arrays(array.chunks)
    if not column.words:
        found: npt.NDArray[Any] = array.to_numpy(zero_copy_only=False)
    else:
        number = {word: index for index, word in enumerate(column.words)}
        codes = np.array([number[word] for word in array.dictionary.to_pylist()], dtype=column.stored)
        found = codes[array.indices.to_numpy(zero_copy_only=False)]
    if found.dtype != column.stored:
        raise ValueError(f"type of the column {column.name!r}")
    return found


def write_archive(file: BinaryIO, columns: Mapping[str, npt.NDArray[Any]]) -> None:
    """Write arrays as an uncompressed NPZ archive: the same bytes for the same arrays."""
    with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        for name, array in columns.items():
            with archive.open(zipfile.ZipInfo(f"{name}.npy"), "w", force_zip64=True) as member:
                np.lib.format.write_array(member, array, allow_pickle=False)


def read_archive(path: Path, names: tuple[str, ...]) -> Stored:
    """Return arrays of an NPZ archive, every byte of them compared with its checksum."""
    found = {}
    with path.open("rb") as file, zipfile.ZipFile(file) as archive:
        for name in names:
            with archive.open(f"{name}.npy") as member:
                found[name] = np.lib.format.read_array(member, allow_pickle=False)
                if member.read(1):
                    raise ValueError("bytes behind an array")
        _check_end(file, archive)
    return found


def _check_end(file: BinaryIO, archive: zipfile.ZipFile) -> None:
    """Raise unless an archive fills its file: members at their places, nothing behind the end."""
    size = file.seek(0, os.SEEK_END)
    behind = len(archive.comment)
    file.seek(max(size - END_RECORD - behind, 0))
    first = min((member.header_offset for member in archive.infolist()), default=0)
    if behind or first or file.read(4) != b"PK\x05\x06":
        raise ValueError("bytes before or behind the archive")
