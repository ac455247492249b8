"""The summary page of ``hrsafety simulate``, of one run and of many runs across recorded people."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from hrsafety._records import dataclass
from hrsafety.pages import Picture, written
from hrsafety.plausibility import ResultWarning, unsafe_doubts

__all__ = ["PageTable", "html"]


@dataclass(frozen=True, kw_only=True, slots=True)
class PageTable:
    """A table of the terminal and of the page.

    Attributes
    ----------
    heading : str
        Above it on the page.
    headers : sequence of sequence of str
        Lines of titles; the last one has the units.
    rows : sequence of sequence
        Cells.
    left : tuple of int
        Columns of words.
    """

    heading: str
    headers: Sequence[Sequence[str]]
    rows: Sequence[Sequence[object]]
    left: tuple[int, ...]

    @property
    def titles(self) -> list[str]:
        """Titles in one line, units in brackets."""
        *names, units = self.headers
        words = [" ".join(filter(None, parts)) for parts in zip(*names, strict=True)]
        return [f"{name} ({unit})" if unit else name for name, unit in zip(words, units, strict=True)]


def html(
    *,
    source: str,
    said: str,
    good: bool,
    facts: Sequence[tuple[str, str]],
    table: PageTable,
    pictures: Mapping[Path, str],
    files: Sequence[Path],
    found: Sequence[ResultWarning],
    totals: str = "",
) -> str:
    """Return the page.

    Parameters
    ----------
    source : str
        The file that was simulated, as given.
    said : str
        In one sentence how the runs ended.
    good : bool
        Whether all arrived without a contact; doubts of `found` on the unsafe side make it unsure.
    facts : sequence of (str, str)
        What was simulated, and results of all runs.
    table : PageTable
        Obstacles or runs.
    pictures : mapping of Path to str
        Files of pictures and their captions.
    files : sequence of Path
        All files beside the page.
    found : sequence of ResultWarning
        Warnings.
    totals : str
        Lines about all runs.

    Returns
    -------
    str
        A complete HTML document.
    """
    return written(
        "simulate.html",
        title=f"Simulation of {Path(source).name}",
        warned=list(dict.fromkeys(map(str, found))),
        said=said,
        good="unsure" if good and unsafe_doubts(found) else good,
        facts=facts,
        heading=table.heading,
        titles=table.titles,
        rows=table.rows,
        left=(0, *table.left),
        totals=totals,
        pictures=[
            Picture(name=path.stem, caption=caption, png=path.read_bytes()) for path, caption in pictures.items()
        ],
        files=[path.name for path in files],
        source=source,
    )
