"""The page of a contact report: every number is read from report.json and carries the path of its field."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from hrsafety.cli.cell.pictures import PARTS, Drawing
from hrsafety.cli.cell.report import at_path, left_out_words, to_thousandths
from hrsafety.contact.plan import LAYERS
from hrsafety.pages import DASH, shown
from hrsafety.standards.verdicts import VERDICT_WORDS

if TYPE_CHECKING:
    from markupsafe import Markup

    from hrsafety.pages.report import Report

__all__ = ["CONTACT_WORDS", "LOOKS", "html", "numbers_in", "paths_of", "rounded"]

STATUS_WORDS = {
    "closed_form": "exact from stored energy",
    "monotone": "by simulation",
    "several_crossings": "by simulation; loads fall again beyond: lowest speed taken",
    "unlimited_up_to_20": "no limit is reached up to 20 m/s",
    "unbounded_mass": "the robot cannot yield here",
    "not_checked": "no limit is checked",
    "unfinished": "a simulation did not end: nothing is known",
    "not_permitted": "not permitted",
    "ok": "with the drive",
    "threshold_above_limit": "the robot notices no force below the limit",
    "push_above_half_limit": "the drive alone presses too hard",
    "outside_table": "no stop was measured from a faster speed",
}
END_WORDS = {
    "released": "",
    "horizon": "pressed until the end of the simulation",
    "no_impact": "no impact",
    "unfinished": "the simulation did not end",
}
"""How a contact at the planned speed ended."""
THICKNESS_WORDS = {"found": "", "bare_is_enough": "bare is enough", "none_up_to_1_m": "none up to 1 m"}
LOOKS = {"not_permitted": "bad", "exceeds": "bad", "not_checked": "unsure", "within_limits": "good"}
"""Class of style of each verdict: red, yellow, green."""
CONTACT_WORDS = {"quasi_static": "clamped", "transient": "free (transient)"}


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
    annex = [each for each in annex if each[0] != "Limits"]  # part 2 has them, with room for the assessor
    by_part: dict[str, list[Drawing]] = {part: [] for part in PARTS}
    for each in drawings:
        by_part[each.part].append(each)
    return report.page(
        "cell.html",
        values=values,
        n=numbers_in(values),
        down=rounded(values, math.floor),
        up=rounded(values, math.ceil),
        numbered=_doubts(values),
        sources=_sources(values["limits"]["rows"]),
        drawn=by_part,
        svg=Markup,
        verdict_words=VERDICT_WORDS,
        status_words=STATUS_WORDS,
        end_words=END_WORDS,
        thickness_words=THICKNESS_WORDS,
        contact_words=CONTACT_WORDS,
        looks=LOOKS,
        left_out=left_out_words(values["not_judged"]),
        inputs=list(paths_of(values["inputs"], "inputs")),
        layers=LAYERS,
        annex=annex,
    )


def _doubts(values: Mapping[str, Any]) -> list[str]:
    """Return every reason why a limit does not count as kept once, then the warnings that say something else."""
    found = list(dict.fromkeys(reason for row in values["verdicts"] for reason in row["reasons"]))
    return [*found, *(each for each in values["warnings"] if not any(each.endswith(reason) for reason in found))]


def _sources(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return the short names of all sources of limits in the order of their use."""
    tags = (row[name] or () for row in rows for name in row if name.endswith("_sources"))
    return list(dict.fromkeys(tag for each in tags for tag in each))


def rounded(values: Mapping[str, Any], careful: Callable[[float], int]) -> Callable[[str], Markup]:
    """Return how a page shows a speed or distance in whole thousandths on its careful side."""
    number = numbers_in(values)

    def shown_on(path: str) -> Markup:
        return number(path, ".3f", rounding=lambda value: to_thousandths(value, careful))

    return shown_on


def numbers_in(values: Mapping[str, Any]) -> Callable[..., Markup]:
    """Return how a page shows a number of a report: with its path, words as they are."""
    from markupsafe import Markup, escape

    def number(
        path: str, spec: str = ".4g", scale: float = 1.0, rounding: Callable[[float], float] | None = None
    ) -> Markup:
        value = at_path(values, path)
        if value is None:
            words = DASH
        elif isinstance(value, (str, bool)):
            words = str(value).replace("_", " ") if spec else str(value)
        else:
            told = scale * value if rounding is None else rounding(value)
            words = shown(told, spec) if spec else repr(value)
        held = "" if value is None else value
        template = Markup('<data value="{}" data-path="{}" title="{}">{}</data>')
        return template.format(escape(held), escape(path), escape(path), escape(words))

    return number


def paths_of(value: Any, path: str) -> Iterator[str]:
    """Yield the path of every single value."""
    if isinstance(value, dict):
        for key in sorted(value):
            yield from paths_of(value[key], f"{path}.{key}")
    elif isinstance(value, list):
        for index, each in enumerate(value):
            yield from paths_of(each, f"{path}[{index}]")
    else:
        yield path
