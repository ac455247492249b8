"""The printed numbers, as shipped with the package."""

from __future__ import annotations

import json
from typing import Any

from hrsafety.reproduce import data

__all__ = ["printed_figure", "printed_rows", "published_tables"]

Row = dict[str, Any]


def published_tables() -> dict[str, Any]:
    """Return the published tables that are compared with.

    Returns
    -------
    dict
        By key ``"zeng2011:<number>"``: ``title``, ``units`` where the table has any, and
        ``rows``, one dict of column to printed number each. A fresh copy in each call.

    Examples
    --------
    >>> from hrsafety import reproduce
    >>> reproduce.published_tables()["zeng2011:6.2"]["rows"][0]["T_arrive"]
    6.7
    """
    tables: dict[str, Any] = json.loads(data.printed_text())
    return tables


def printed_rows(number: str) -> list[Row]:
    """Return the rows of one table of Zeng (2011)."""
    rows: list[Row] = published_tables()[f"zeng2011:{number}"]["rows"]
    return rows


def printed_figure(section: str, figure: str) -> float:
    """Return a figure that stands in the text of a section of Zeng (2011)."""
    (row,) = (row for row in printed_rows(f"section {section}") if row["figure"] == figure)
    return float(row["value"])
