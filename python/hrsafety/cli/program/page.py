"""The page of a program report: every number is read from report.json and carries the path of its field."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from hrsafety.cli.cell.page import CONTACT_WORDS, LOOKS, numbers_in, paths_of, rounded
from hrsafety.cli.cell.pictures import Drawing
from hrsafety.cli.program.report import heaviest_held
from hrsafety.contact.plan import LAYERS
from hrsafety.standards.verdicts import VERDICT_WORDS

if TYPE_CHECKING:
    from hrsafety.pages.report import Report

__all__ = ["html"]


def html(
    report: Report, drawings: Sequence[Drawing], annex: Sequence[tuple[str, Sequence[str], Sequence[Sequence[str]]]]
) -> str:
    """Return the page.

    Parameters
    ----------
    report : Report
        With the values of report.json.
    drawings : sequence of Drawing
        Pictures.
    annex : sequence of tuple
        Heading, titles and rows of the tables of the annex.

    Returns
    -------
    str
        A complete HTML document without anything from elsewhere.
    """
    from markupsafe import Markup

    values = {**report.values, "warnings": report.messages}
    return report.page(
        "program.html",
        values=values,
        n=numbers_in(values),
        down=rounded(values, math.floor),
        up=rounded(values, math.ceil),
        drawings=drawings,
        layers=LAYERS,
        held=heaviest_held(values["rows"]),
        annex=annex,
        svg=Markup,
        verdict_words=VERDICT_WORDS,
        contact_words=CONTACT_WORDS,
        looks=LOOKS,
        inputs=list(paths_of(values["inputs"], "inputs")),
    )
