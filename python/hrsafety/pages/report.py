"""A report: facts, tables, pictures, verdict and warnings of a command, as a page and as JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from typing import Any, NamedTuple

import numpy as np

from hrsafety._records import dataclass
from hrsafety._words import unsigned_zero
from hrsafety.pages import Picture, written
from hrsafety.plausibility import ResultWarning, unsafe_doubts

__all__ = ["Report", "ReportCell", "ReportTable", "Section", "json_text"]


class ReportCell(NamedTuple):
    """A cell of a table with a look of its own on the page.

    Attributes
    ----------
    text : str
        What it says.
    look : str
        ``"good"``, ``"bad"`` or ``""``.
    small : str
        What the page adds in small letters.
    """

    text: str
    look: str = ""
    small: str = ""

    def __str__(self) -> str:
        """Return the text."""
        return self.text


@dataclass(frozen=True, kw_only=True, slots=True)
class ReportTable:
    """A table of the terminal and of the page.

    Attributes
    ----------
    headers : sequence of sequence of str
        Lines of titles; of several the last one has the units.
    rows : sequence of sequence
        Cells.
    left : tuple of int
        Columns of words.
    most : int or None
        Rows that are shown at once; the page folds the whole table below them.
    summary : str
        What the folded table is called; without `most` all of it is folded.
    printed : bool
        Whether the terminal shows it, too.
    more : str
        What the terminal says of the rows beyond `most`.
    """

    headers: Sequence[Sequence[str]]
    rows: Sequence[Sequence[object]]
    left: tuple[int, ...] = (0,)
    most: int | None = None
    summary: str = ""
    printed: bool = False
    more: str = ""

    @property
    def titles(self) -> list[str]:
        """Titles in one line, units in brackets."""
        *names, units = self.headers if len(self.headers) > 1 else (self.headers[0], [""] * len(self.headers[0]))
        words = [" ".join(filter(None, parts)) for parts in zip(*names, strict=True)]
        return [f"{name} ({unit})" if unit else name for name, unit in zip(words, units, strict=True)]


class Section(NamedTuple):
    """A part of a page.

    Attributes
    ----------
    heading : str
        Above it; none if empty.
    blocks : iterable of str, ReportTable or Picture
        Paragraphs, tables and pictures in their order.
    """

    heading: str
    blocks: Sequence[str | ReportTable | Picture]


@dataclass(frozen=True, kw_only=True, slots=True)
class Report:
    """Report of a command: facts, verdict, tables, pictures, warnings.

    Attributes
    ----------
    title : str
        Of the page.
    facts : sequence of (str, str)
        Inputs and results in a line each, by name.
    said : str
        Verdict in a sentence; empty without one.
    good : bool
        Whether it is a good one; doubts that may lie on the unsafe side make it unsure.
    advice : str
        What follows from the verdict.
    sections : sequence of Section
        Everything else.
    warnings : sequence of ResultWarning
        Of all results.
    warned : str
        Title above the warnings of the page.
    values : mapping
        Every value by name, for JSON.
    files : sequence of str
        Names of the files beside the page.
    source : str
        The file that was read, as given.
    made : str or None
        When it was made, as the page prints it; ``None``: now, empty: the page does not say, and is the same each time.
    sorts : bool
        Whether a click on a title sorts its table.
    """

    title: str
    facts: Sequence[tuple[str, str]] = ()
    said: str = ""
    good: bool = True
    advice: str = ""
    sections: Sequence[Section] = ()
    warnings: Sequence[ResultWarning] = ()
    warned: str = "Is this what was meant?"
    values: Mapping[str, Any] = field(default_factory=dict)
    files: Sequence[str] = ()
    source: str = ""
    made: str | None = None
    sorts: bool = False

    @property
    def printed(self) -> list[ReportTable]:
        """Tables that the terminal shows."""
        blocks = (block for section in self.sections for block in section.blocks)
        return [block for block in blocks if isinstance(block, ReportTable) and block.printed]

    @property
    def messages(self) -> list[str]:
        """Every different warning in words."""
        return list(dict.fromkeys(each.message for each in self.warnings))

    def page(self, template: str = "report.html", **content: object) -> str:
        """Return the page.

        Parameters
        ----------
        template : str
            File in the folder of templates.
        **content : object
            What it shows beside the report.

        Returns
        -------
        str
            A complete HTML document.
        """
        good = "unsure" if self.good and unsafe_doubts(self.warnings) else self.good
        shown = replace(
            self,
            facts=[(name, unsigned_zero(words)) for name, words in self.facts],
            said=unsigned_zero(self.said),
            sections=[Section(each.heading, [_unsigned(block) for block in each.blocks]) for each in self.sections],
        )
        when = {} if self.made is None else {"made": self.made}
        return written(template, title=self.title, report=shown, good=good, **when, **content)

    def json(self, *, sort: bool = False) -> str:
        """Return title, every value and the warnings as JSON, in their order or in that of their names.

        Without values by name these are the facts, the verdict and the tables.
        """
        tables = [
            {"heading": section.heading, "columns": block.titles, "rows": block.rows}
            for section in self.sections
            for block in section.blocks
            if isinstance(block, ReportTable)
        ]
        shown = {"source": self.source, "facts": dict(self.facts), "verdict": self.said, "tables": tables}
        return json_text({"title": self.title, **(self.values or shown), "warnings": self.messages}, sort=sort)


def _unsigned(block: Any) -> Any:
    """Return a block of a page without the sign of zeros in its words and cells."""
    if type(block) is str:  # not a player, which is a page
        return unsigned_zero(block)
    if not isinstance(block, ReportTable):
        return block

    def cell(value: object) -> object:
        if isinstance(value, ReportCell):
            return value._replace(text=unsigned_zero(value.text))
        return unsigned_zero(value) if isinstance(value, str) else value

    return replace(block, rows=[[cell(value) for value in row] for row in block.rows])


def json_text(values: Mapping[str, Any], *, sort: bool = False) -> str:
    """Return values as JSON: shortest floats that read back the same, null for what is not finite."""
    return json.dumps(_plain(values), indent=1, sort_keys=sort, ensure_ascii=False, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    """Return a value with nothing but what JSON has."""
    if isinstance(value, Mapping):
        return {str(name): _plain(entry) for name, entry in value.items()}
    if isinstance(value, (np.ndarray, np.generic)):
        return _plain(value.tolist())
    if isinstance(value, ReportCell):
        return str(value)
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
