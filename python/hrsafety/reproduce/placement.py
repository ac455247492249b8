"""Which pictures stand beside which table of the page."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fnmatch import fnmatchcase

from hrsafety.reproduce.figures import Picture

__all__ = ["of_table", "unplaced"]

# Shell-style patterns of the names of pictures.
_PLACES: dict[str, tuple[str, ...]] = {
    "6.2": ("*-c1", "*-c1-*"),
    "6.3": ("*-c2", "*-c2-*", "figure-6.9-*"),
    "6.4": ("*-c3", "*-c3-*", "figure-6.12-*"),
    "6.5": ("*-c4", "*-c4-*"),
    "7.1": ("*-n1",),
    "7.2": ("*-n2",),
    "7.3": ("*-n3",),
    "7.4": ("*-n4",),
    "Section 7.5.5": ("*-multiple",),
    "Section C.2": ("gains-*",),
    "Section C.3": ("trend-*",),
    "Section 3.6": ("figure-3.1[0-2]-*",),
    "Section 3.7": ("figure-3.1[3-6]-*",),
    "Section 3.8": ("figure-3.17-*", "stop-*"),
    "Section 3.9": ("figure-3.1[89]-*",),
    "4.2": ("figure-4.*",),
    "Section A.2": ("direct-drive-*",),
    "avi2019 Table 2": ("sound_*",),
    "avi2019 experiments 2 and 3": ("follower_*",),
    "gussu2017 sensors": ("skirt-ring",),
    "gussu2017 Table 4": ("skirt-*",),
}


def of_table(table: str, pictures: Iterable[Picture]) -> list[Picture]:
    """Return the pictures that stand beside a table."""
    return [each for each in pictures if _place(each) == table]


def unplaced(pictures: Iterable[Picture], tables: Sequence[str]) -> list[Picture]:
    """Return the pictures that stand beside none of some tables."""
    return [each for each in pictures if _place(each) not in tables]


def _place(picture: Picture) -> str | None:
    for table, patterns in _PLACES.items():
        if any(fnmatchcase(picture.name, pattern) for pattern in patterns):
            return table
    return None
