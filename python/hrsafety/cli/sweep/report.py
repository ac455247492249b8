"""The report of ``hrsafety sweep``."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence

import numpy as np

from hrsafety._bounds import MOST_ROWS_AT_ONCE
from hrsafety._words import some
from hrsafety.cli import output
from hrsafety.cli.sweep.file import SweepFile
from hrsafety.cli.sweep.summary import Summary, summarized
from hrsafety.pages import sentence
from hrsafety.pages.report import Report, ReportTable, Section
from hrsafety.sweep import Axis, Grid, NavigationStudy, SweepResult, SweepShares
from hrsafety.sweep.shares import SEED, levels_of

__all__ = ["report_of"]

_KINDS = {"grid": "grid", "latin_hypercube": "Latin hypercube", "sobol": "Sobol sequence"}
# More values than these are given as a count.
MOST_LISTED = 8
# Of more groups of rows the page has no shares, and says how to get them.
MOST_GROUPS = 24
# Outcomes that the page tells of even if no run had them.
_ALWAYS = ("arrived", "collided")
_CONTACTS = {
    "contacts_moving": "contact while it moves",
    "contacts_standing": "contact while it stands",
    "contacts_at_fault": "contact at fault",
}


def design_words(result: SweepResult) -> str:
    """Return the design in a line."""
    settings = result.design.settings()
    seed = f", seed {settings['seed']}" if "seed" in settings else ""
    cases = f", {some(len(result.cases), 'case')} each" if result.cases else ""
    return f"{_KINDS[settings['kind']]} of {some(settings['rows'], 'row', form=',')}{seed}{cases}"


def axis_words(axis: Axis) -> str:
    """Return the values of an axis in a line."""
    if axis.values is not None:
        if len(axis.values) <= MOST_LISTED:
            return ", ".join(f"{value:g}" for value in axis.values)
        return f"{some(len(axis.values), 'value')} from {min(axis.values):g} to {max(axis.values):g}"
    number = f"{some(axis.size, 'value')} " if axis.size is not None else ""
    scale = {"linear": "", "log": ", logarithmic", "integer": ", whole numbers"}[axis.scale]
    return f"{number}{axis.low:g} to {axis.high:g}{scale}"


def report_of(study: str, described: SweepFile, result: SweepResult, seconds: float) -> Report:
    """Return the report of a sweep.

    Parameters
    ----------
    study : str
        Its file, as given.
    described : SweepFile
        What was asked.
    result : SweepResult
        What was found.
    seconds : float
        How long the run took, in s.
    """
    summary = summarized(result)
    cases = f" ({', '.join(result.cases)})" if result.cases else ""
    chunks = some(result.chunk_count, "chunk", form=",")
    source = result.provenance
    shown = [each for each in summary.numbers if each.column.name in described.show]
    rest = [each for each in summary.numbers if each.column.name not in described.show]
    titles = ("quantity", "least", "mean", "largest", "without value")
    extremes = _extremes(summary, described.show)
    by = _groups(described, result)
    shares = None if by is None or _size(by) > MOST_GROUPS else result.shares("outcome", by)
    blocks: list[str | ReportTable] = [
        ReportTable(headers=[titles], rows=[(each.label, *each.numbers()) for each in shown], printed=True),
        *([ReportTable(headers=[titles], rows=[(each.label, *each.numbers()) for each in rest])] if rest else []),
        *(f"{sentence(each.label)}: {each.shares()}." for each in summary.words),
    ]
    settings = json.dumps(source["settings"], indent=1, ensure_ascii=False)
    return Report(
        title=described.title,
        facts=[
            ("study", study),
            *_law_facts(described),
            ("design", f"{design_words(result)}{cases}"),
            *(("axis", f"{axis.label}: {axis_words(axis)}") for axis in result.axes),
            ("rows", f"{len(result):,} in {chunks}, {seconds:.1f} s"),
            *((each.label, each.shares()) for each in summary.words),
            ("begun", f"{source['created']} with hrsafety {source['version']}, fingerprint {source['fingerprint']}"),
        ],
        said=f"{some(len(result), 'row', form=',')}",
        sections=[
            *([] if by is None else [Section("Outcomes", _outcomes(by, shares, result))]),
            Section("Columns", blocks),
            *([Section("Extremes", [extremes])] if extremes.rows else []),
            Section("Settings", [settings]),
        ],
        warnings=result.warnings if shares is None else shares.warnings,
        warned="Warnings",
        files=["sweep.json", "the folder chunks, read with hrsafety.sweep.open"],
        source=study,
    )


def _law_facts(described: SweepFile) -> list[tuple[str, str]]:
    """Return which law drives the robots, of a study with robots."""
    study = described.study
    return [("law", output.law_words(study.law))] if isinstance(study, NavigationStudy) else []


def _groups(described: SweepFile, result: SweepResult) -> dict[str, int] | None:
    """Return what makes groups of runs, each with its number of values; ``None`` if no run is drawn by chance."""
    kept = any(each.name == "outcome" for each in result.found)
    drawn = SEED in result.design.names or not isinstance(result.design, Grid)
    if not (isinstance(described.study, NavigationStudy) and kept and drawn):
        return None
    levels = {each.name: levels_of(each, result.design, MOST_ROWS_AT_ONCE) for each in result.axes if each.name != SEED}
    axes = {name: len(values) for name, values in levels.items() if values is not None and len(values) > 1}
    return axes | ({result.columns[len(result.axes)].name: len(result.cases)} if len(result.cases) > 1 else {})


def _size(by: dict[str, int]) -> int:
    return math.prod(by.values())


def _outcomes(by: dict[str, int], shares: SweepShares | None, result: SweepResult) -> list[str | ReportTable]:
    """Return the shares of the outcomes in each group of runs, or where they are to be had."""
    if shares is None:
        call = f'sweep.open(...).shares("outcome", by={list(by)})'
        return [f"The shares of the outcomes in {_size(by):,} groups of rows: {call}."]
    labels = {column.name: column.label for column in result.columns}
    occurring = set(shares.word[shares.count > 0].tolist())
    told = {
        word.replace("_", " "): _share_words(shares, word)
        for word in dict.fromkeys(shares.word.tolist())
        if word in occurring or word in _ALWAYS
    }
    note = "Share of the rows with these values that ended so, its 95 % Wilson interval, and the count."
    kept = {each.name for each in result.found}
    for name, title in _CONTACTS.items():
        if name in kept:
            told[title] = _share_words(result.shares(name, by), "some")
    if "contacts_at_fault" in kept:
        note += " A contact is at fault where the robot moves toward whom it touches."
    first = shares.word == shares.word[0]
    values = ([_shown(value) for value in shares.group[name][first].tolist()] for name in by)
    columns = (*values, [f"{rows:,}" for rows in shares.rows[first].tolist()], *told.values())
    titles = (*(labels[name] for name in by), "rows", *told)
    return [note, ReportTable(headers=[titles], rows=list(zip(*columns, strict=True)), left=(), printed=True)]


def _share_words(shares: SweepShares, word: str) -> list[str]:
    """Return the share of a word in each group with its interval, rounded outwards, and how many rows it is."""
    here = np.flatnonzero(shares.word == word)
    low, high = np.floor(shares.low[here] * 1000.0) / 10.0, np.ceil(shares.high[here] * 1000.0) / 10.0
    columns = (shares.share[here].tolist(), low.tolist(), high.tolist(), shares.count[here].tolist())
    return [
        f"{share:.1%} ({least:.1f}% to {most:.1f}%), {count:,}"
        for share, least, most, count in zip(*columns, strict=True)
    ]


def _extremes(summary: Summary, show: Sequence[str]) -> ReportTable:
    """Return where the columns that are drawn are least and largest."""
    drawn = [each for each in summary.numbers if each.column.name in show and each.finite]
    labels = {column.name: column.label for column in summary.result.columns}
    names = list(drawn[0].least_row) if drawn else []
    rows = [
        (each.label, word, f"{value:.5g}", *(_shown(row[name]) for name in names))
        for each in drawn
        for word, value, row in (("least", each.least, each.least_row), ("largest", each.largest, each.largest_row))
    ]
    return ReportTable(headers=[["quantity", "", "value", *(labels[name] for name in names)]], rows=rows, left=(0, 1))


def _shown(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
