"""Columns of text tables, read part by part without a loop over rows."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety.errors import FileError, Shown
from hrsafety.io.reader import Document

__all__ = ["MOST_ROWS", "Columns", "TableColumn", "read_columns", "short"]

Array = npt.NDArray[np.float64]
Bytes = npt.NDArray[np.uint8]
Flags = npt.NDArray[np.bool_]
Places = npt.NDArray[np.int64]

MOST_ROWS = 30_000_000
"""Rows of a table."""
PART = 2**20
"""Bytes that are examined together: they stay in the cache of the processor."""
LONGEST_WORD = 200
"""Longest name in letters."""
LONGEST_ABSENT = 4
ABSENT = (b"", b"na", b"n/a", b"null", b"none", b"?")
"""Cells, in small letters, that say that there is no number; beside ``nan``."""
_NEWLINE, _TAB, _BLANK, _QUOTE, _COMMENT = b'\n\t "#'
_TRUE_ABOVE = 2.0**53
"""Integers up to here are exact as floating-point numbers."""
_NUMERIC = np.zeros(256, dtype=np.bool_)
_NUMERIC[np.frombuffer(b"0123456789+-.", dtype=np.uint8)] = True


def short(text: str) -> str:
    """Return text cut to the length that a message can hold."""
    return text if len(text) <= 40 else f"{text[:37]}..."


class TableColumn(NamedTuple):
    """Column of a table.

    Attributes
    ----------
    place : int
        Which, from 0.
    name : str
        How errors call it.
    """

    place: int
    name: str


class Columns(NamedTuple):
    """Columns that were read.

    Attributes
    ----------
    numbers : ndarray, shape (n, k)
        NaN where a cell says that there is no number.
    ids : ndarray, shape (n,)
        Integers if all are, words otherwise; empty if none were asked for.
    words : ndarray of str, shape (n, w)
        Columns of text.
    lines : ndarray of int, shape (n,)
        Number of the line of each row, from 1.
    decimal : str
        Sign of decimals.
    """

    numbers: Array
    ids: npt.NDArray[Any]
    words: npt.NDArray[np.str_]
    lines: Places
    decimal: str


def read_columns(
    document: Document,
    *,
    delimiter: str,
    numbers: Sequence[TableColumn],
    ids: TableColumn | None = None,
    words: Sequence[TableColumn] = (),
    skip: int = 0,
    columns: int | None = None,
    comments: bool = True,
) -> Columns:
    """Return columns of a text table.

    Blank lines are no rows. Cells in double quotes may hold delimiters. Decimals have
    points, or commas where no comma divides cells, in all rows.

    Parameters
    ----------
    document : Document
        The file.
    delimiter : str
        One letter; a blank stands for any number of blanks and tabs.
    numbers, words : sequence of TableColumn
        Columns of numbers and of text.
    ids : TableColumn or None
        Column of ids.
    skip : int
        Lines before the first row.
    columns : int or None
        Cells in each row; ``None``: as many as in the first one.
    comments : bool
        Whether lines that begin with ``#`` are no rows.

    Raises
    ------
    FileError
        If a row has another number of cells (``unequal_rows``), a quote is not closed, a cell is no finite number
        (``unreadable_number``), or there are too many rows (``too_large``).
    """
    rows = document.plain.count(b"\n")
    if rows > MOST_ROWS:
        raise document.error("too_large", f"have at most {MOST_ROWS:,} rows", Shown(f"{rows:,}"), "cut it into parts")
    try:
        return _read(document, _Layout(delimiter, skip, columns, comments), numbers, ids, words, ".")
    except _CommaError:
        return _read(document, _Layout(delimiter, skip, columns, comments), numbers, ids, words, ",")


class _Layout(NamedTuple):
    """Rows and cells of a table, as `read_columns` takes them."""

    delimiter: str
    skip: int
    columns: int | None
    comments: bool


class _CommaError(Exception):
    """A number has a comma."""


def _read(
    document: Document,
    layout: _Layout,
    numbers: Sequence[TableColumn],
    ids: TableColumn | None,
    words: Sequence[TableColumn],
    decimal: str,
) -> Columns:
    values, names, texts, lines = [], [], [], []
    for part in _parts(document, layout):
        table, who = part.numbers_and_ids(numbers, ids, decimal)
        values.append(table)
        names.append(who)
        texts.append([part.words(each) for each in words])
        lines.append(part.lines)
    if not values:
        nothing = np.empty(0, dtype=np.int64)
        return Columns(np.empty((0, len(numbers))), nothing, np.empty((0, len(words)), dtype=np.str_), nothing, decimal)
    if ids is not None and len({each.dtype.kind for each in names}) > 1:
        # Words if any is one, all of them as they stand in the file.
        names = [part.words(ids) for part in _parts(document, layout)]
    return Columns(
        np.concatenate(values),
        np.concatenate(names) if ids is not None else np.empty(0, dtype=np.int64),
        np.stack([np.concatenate(each) for each in zip(*texts, strict=True)], axis=1)
        if words
        else np.empty((sum(map(len, lines)), 0), dtype=np.str_),
        np.concatenate(lines),
        decimal,
    )


def _parts(document: Document, layout: _Layout) -> Iterator[_Part]:
    """Yield the rows of a table in parts."""
    data, place, line = document.plain, 0, 1
    for _ in range(layout.skip):
        place = data.find(b"\n", place) + 1
        line += 1
        if place == 0:
            return
    while place < len(data):
        behind = data.find(b"\n", min(place + PART, len(data))) + 1
        body = data[place:behind] if behind else data[place:]
        part = _Part(document, body if body.endswith(b"\n") else body + b"\n", line, layout)
        if len(part.lines):
            layout = layout._replace(columns=part.count)
            yield part
        line += body.count(b"\n")
        place = behind or len(data)


class _Part:
    """Some rows of a table: where its cells begin and end in a buffer of bytes."""

    def __init__(self, document: Document, body: bytes, line: int, layout: _Layout) -> None:
        self.document, self.delimiter, columns = document, layout.delimiter, layout.columns
        self.buffer, self.lines = _without_blanks(np.frombuffer(body, dtype=np.uint8), line, comments=layout.comments)
        self._bytes = body if len(body) == len(self.buffer) else self.buffer.tobytes()
        self.count = columns or 0
        if len(self.lines) == 0:
            return
        starts, ends = self._divided()
        ends_row = self.buffer[ends] == _NEWLINE
        first_end = int(np.argmax(self.buffer == _NEWLINE))
        self.count = int(np.searchsorted(starts, first_end, "right")) if columns is None else columns
        regular = len(ends) == self.count * len(self.lines) and ends_row[self.count - 1 :: self.count].all()
        if not regular or self.delimiter == " ":
            self._check_counts(starts)
        self._stripped = _strip(self.buffer, self._bytes, starts, ends)
        self._starts, self._ends = starts.reshape(-1, self.count), ends.reshape(-1, self.count)

    def _check_counts(self, starts: Places) -> None:
        """Refuse rows with another number of cells."""
        newlines = np.flatnonzero(self.buffer == _NEWLINE)
        counts = np.diff(np.searchsorted(starts, newlines, "right"), prepend=0)
        wrong = np.flatnonzero(counts != self.count)
        if len(wrong):
            row, remedy = int(wrong[0]), None
            if self.delimiter == "," and counts[row] > self.count:
                remedy = "decimals need a point, not a comma, where commas divide the cells"
            raise self.error("unequal_rows", f"have {self.count} cells", int(counts[row]), remedy, row=row)

    def error(
        self, code: str, rule: str, value: object, remedy: str | None = None, *, row: int, name: str | None = None
    ) -> FileError:
        """Return an error about a row."""
        key = None if name is None else f"column {name}"
        return self.document.error(code, rule, value, remedy, line=int(self.lines[row]), key=key)

    def _divided(self) -> tuple[Places, Places]:
        """Return where cells begin and end."""
        buffer = self.buffer
        newline = buffer == _NEWLINE
        if self.delimiter == " ":
            divides = newline | (buffer == _BLANK) | (buffer == _TAB)
        else:
            divides = newline | (buffer == ord(self.delimiter))
        if b'"' in self._bytes:
            inside = (np.cumsum(buffer == _QUOTE, dtype=np.int64) & 1).astype(np.bool_)
            unclosed = np.flatnonzero(inside & newline)
            if len(unclosed):
                row = int(np.count_nonzero(newline[: unclosed[0]]))
                raise self.error("unreadable", "close each quote in its line", Shown("an open quote"), row=row)
            divides &= ~inside
        if self.delimiter == " ":
            before = np.concatenate([[True], divides[:-1]])
            return np.flatnonzero(~divides & before), np.flatnonzero(divides & ~before)
        ends = np.flatnonzero(divides)
        return np.concatenate([[0], ends[:-1] + 1]), ends

    def cell(self, row: int, column: int) -> str:
        """Return a cell as text."""
        return bytes(self.buffer[self._starts[row, column] : self._ends[row, column]]).decode("utf-8", "replace")

    def numbers(self, columns: Sequence[TableColumn], decimal: str) -> Array:
        """Return columns as numbers, NaN where a cell says that there is none."""
        table = self._values(columns, decimal)
        if table is None:
            raise self._unreadable(columns, decimal)
        return table

    def numbers_and_ids(
        self, columns: Sequence[TableColumn], ids: TableColumn | None, decimal: str
    ) -> tuple[Array, npt.NDArray[Any]]:
        """Return columns of numbers, and ids: integers if all are written as such, words otherwise."""
        if ids is None:
            return self.numbers(columns, decimal), np.empty(0, dtype=np.int64)
        if self._may_be_integers(ids):
            # All at once is fastest.
            table = self._values([*columns, ids], decimal)
            found = self._values([ids], decimal) if table is None else table[:, -1:]
            if found is not None and (np.abs(found) < _TRUE_ABOVE).all():
                whole = found[:, 0].astype(np.int64)
                if (whole == found[:, 0]).all():
                    return self.numbers(columns, decimal) if table is None else table[:, :-1], whole
        return self.numbers(columns, decimal), self.words(ids)

    def _may_be_integers(self, ids: TableColumn) -> bool:
        """Return whether ids begin like numbers, without zeros before them; refuse those that are empty or too long."""
        begin, end = self._starts[:, ids.place], self._ends[:, ids.place]
        width = end - begin
        bad = np.flatnonzero((width <= 0) | (width > LONGEST_WORD))
        if len(bad):
            rule, row = f"name somebody in 1 to {LONGEST_WORD} letters", int(bad[0])
            raise self.error("unreadable_number", rule, short(self.cell(row, ids.place)), row=row, name=ids.name)
        first = self.buffer[begin]
        padded = np.flatnonzero((first == ord("0")) & (width > 1))
        second = self.buffer[begin[padded] + 1]
        return bool(_NUMERIC[first].all() and not (_NUMERIC[second] & (second != ord("."))).any())

    def _values(self, columns: Sequence[TableColumn], decimal: str) -> Array | None:
        """Return columns as numbers, or none if a cell is no finite one."""
        index, order = self._order(columns)
        begin, end = self._starts[:, index].ravel(), self._ends[:, index].ravel()
        some = self._present(begin, end)
        if some.all():
            values = self._parsed(begin, end, decimal)
        else:
            values, found = np.full(len(begin), np.nan), self._parsed(begin[some], end[some], decimal)
            if found is None:
                return None
            values[some] = found
        if values is None or np.isinf(values).any():
            return None
        table = np.empty((len(self.lines), len(columns)))
        table[:, order] = values.reshape(len(self.lines), len(columns))
        return table

    @staticmethod
    def _order(columns: Sequence[TableColumn]) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """Return the places of columns from left to right, and which of the columns each of them is."""
        place = np.array([each.place for each in columns], dtype=np.intp)
        order = np.argsort(place, kind="stable")
        return place[order], order

    def words(self, column: TableColumn) -> npt.NDArray[np.str_]:
        """Return a column as text."""
        begin, end = self._starts[:, column.place], self._ends[:, column.place]
        width = np.minimum(end - begin, LONGEST_WORD)
        longest = max(int(width.max()), 1)
        letters = np.zeros((len(begin), longest), dtype=np.uint8)
        for place in range(longest):
            some = width > place
            letters[some, place] = self.buffer[begin[some] + place]
        different, index = np.unique(letters.view(f"S{longest}").ravel(), return_inverse=True)
        return np.array([each.decode("utf-8", "replace") for each in different.tolist()])[index.ravel()]

    def _present(self, begin: Places, end: Places) -> Flags:
        """Return which cells hold something else than the words for no number."""
        width = end - begin
        some: Flags = width > 0
        odd = np.flatnonzero(
            some & (width <= LONGEST_ABSENT) & ~_NUMERIC[self.buffer[np.minimum(begin, len(self.buffer) - 1)]]
        )
        for place in odd.tolist():
            if bytes(self.buffer[begin[place] : end[place]]).lower() in ABSENT:
                some[place] = False
        return some

    def _parsed(self, begin: Places, end: Places, decimal: str) -> Array | None:
        """Return cells as numbers, or none if one of them is none."""
        if len(begin) == 0:
            return np.empty(0)
        # The byte after each cell divides it from the next one.
        if len(begin) == self._starts.size and not self._stripped:
            inside = self._bytes.replace(self.delimiter.encode(), b" ")
        else:
            text = self.buffer.copy()
            text[end] = _BLANK
            change = np.zeros(len(text) + 1, dtype=np.int8)
            change[begin] += 1
            change[end + 1] -= 1
            inside = text[np.cumsum(change[:-1], dtype=np.int8).view(np.bool_)].tobytes()
        if decimal == ",":
            if b"." in inside:
                return None
            inside = inside.replace(b",", b".")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            try:
                found = np.fromstring(inside, sep=" ")
            except (ValueError, DeprecationWarning):
                return None
        return found if len(found) == len(begin) else None

    def _unreadable(self, columns: Sequence[TableColumn], decimal: str) -> Exception:
        """Return the error about the first cell that is no number, or what says that decimals may have commas."""
        index, order = self._order(columns)
        begin, end = self._starts[:, index].ravel(), self._ends[:, index].ravel()
        places = np.flatnonzero(self._present(begin, end))
        low, high = 0, len(places)
        while high - low > 1:
            middle = (low + high) // 2
            values = self._parsed(begin[places[low:middle]], end[places[low:middle]], decimal)
            if values is None or np.isinf(values).any():
                high = middle
            else:
                low = middle
        row, place = divmod(int(places[low]), len(columns))
        column = columns[int(order[place])]
        text = self.cell(row, column.place)
        remedy = None
        if "," in text and self.delimiter != "," and decimal == ".":
            return _CommaError()
        if "," in text and "." in text:
            remedy = "write it without a separator of thousands"
        elif decimal == "," and "." in text:
            remedy = "decimals need one sign in all rows, and others have commas"
        return self.error("unreadable_number", "be a finite number", short(text), remedy, row=row, name=column.name)


def _without_blanks(buffer: Bytes, line: int, *, comments: bool) -> tuple[Bytes, Places]:
    """Return rows without blank lines and, if they are no rows, comments, and the numbers of their lines."""
    ends = np.flatnonzero(buffer == _NEWLINE)
    starts = np.concatenate([[0], ends[:-1] + 1])
    first = buffer[starts]
    odd = np.flatnonzero((first == _NEWLINE) | (first == _COMMENT) | (first == _BLANK) | (first == _TAB))
    lines = np.arange(len(starts)) + line
    if len(odd) == 0:
        return buffer, lines
    inked = np.flatnonzero((buffer != _BLANK) & (buffer != _TAB))
    # The first byte of each of these rows that is no blank; of an empty one that is its end.
    place = inked[np.searchsorted(inked, starts[odd])]
    drop = np.zeros(len(starts), dtype=np.bool_)
    drop[odd] = (place == ends[odd]) | (comments & (buffer[place] == _COMMENT))
    if not drop.any():
        return buffer, lines
    change = np.zeros(len(buffer) + 1, dtype=np.int8)
    change[starts[drop]] += 1
    change[ends[drop] + 1] -= 1
    return buffer[np.cumsum(change[:-1], dtype=np.int8) == 0], lines[~drop]


def _strip(buffer: Bytes, data: bytes, starts: Places, ends: Places) -> bool:
    """Move the ends of cells inward over blanks, tabs and one pair of quotes; return whether there were any."""
    done = False
    for letters in ((_BLANK, _TAB), (_QUOTE,), (_BLANK, _TAB)):
        if not any(letter in data for letter in letters):
            continue
        done = True
        inner = np.zeros(256, dtype=np.bool_)
        inner[list(letters)] = True
        for places, step, offset in ((starts, 1, 0), (ends, -1, -1)):
            some = np.flatnonzero(starts < ends)
            while len(some):
                some = some[inner[buffer[places[some] + offset]]]
                places[some] += step
                some = some[starts[some] < ends[some]] if _QUOTE not in letters else some[:0]
    return done
