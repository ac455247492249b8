"""The summary page of ``hrsafety optimize``."""

from __future__ import annotations

import datetime
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from importlib import resources

from hrsafety import __version__
from hrsafety.cli import optimize_record
from hrsafety.cli.optimize_report import (
    METRIC_UNITS,
    MOST_PATHS,
    NOT_EVERYWHERE,
    GainReport,
    confidence_words,
    gain_words,
    scenario_table,
    scenario_words,
    search_words,
    set_table,
)
from hrsafety.reproduce.markup import figure, scroll

__all__ = ["html"]

GAIN_TITLES = ("K_1 (N/m)", "K_3 (N/m)", "K_5 (N/m^2)", "b (s)")
MOST_ROWS = 20  # scenarios that are listed unfolded
PictureBytes = tuple[str, bytes]


def html(report: GainReport, pictures: Mapping[str, PictureBytes]) -> str:
    """Return the page: style and pictures inside, nothing loaded from elsewhere.

    Parameters
    ----------
    report : GainReport
        What was found.
    pictures : mapping of str to (str, bytes)
        Caption and PNG of each picture by name.

    Returns
    -------
    str
        A complete HTML document.
    """
    style = resources.files("hrsafety.reproduce").joinpath("page.css").read_text(encoding="utf-8")
    title = escape(report.study.title)
    return "\n".join(
        [
            "<!DOCTYPE html>",
            '<html lang="en"><head><meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{title}</title>",
            f"<style>{style}</style></head><body><main>",
            f"<h1>{title}</h1>",
            *_answer(report),
            *_paths(report, pictures),
            *_flatness(report, pictures),
            *_history(report, pictures),
            *_front(report, pictures),
            *_settings(report),
            *_foot(report, pictures),
            "</main></body></html>\n",
        ]
    )


def _answer(report: GainReport) -> Iterator[str]:
    """Yield the best gains, what they reach in each scenario, and what others reach."""
    search, best = report.search, report.sets[0]
    unit = f" {METRIC_UNITS[report.objective]}".rstrip()
    yield f"<p>Scenarios: {escape(scenario_words(report.study))}. Search: {escape(search_words(search))}.</p>"
    look = "banner" if search.feasible else "banner no"
    gains, objective = escape(gain_words(best.law.gains)), escape(report.objective.replace("_", " "))
    reached = f"{objective} {best.value:.5f}{unit}{escape(confidence_words(search))}"
    if search.valid:
        doubt = "" if search.feasible else f" Not feasible: {NOT_EVERYWHERE}."
        yield f'<p class="{look}"><strong>Best gains: {gains}.</strong> {reached}.{doubt}</p>'
    else:
        yield (
            f'<p class="{look}"><strong>Not feasible: {escape(search.shortcoming)}.</strong> To mend it, '
            f"{escape(search.remedy)}. Everything below is of the nearest gain set, which is no result: "
            f"{gains}; {reached}.</p>"
        )
    yield (
        f"<p>{search.evaluations:,} gain sets were evaluated in {search.episodes:,} runs; {search.failures:,} of them "
        f"touched something or did not arrive somewhere, and count. It took {report.seconds:.2f} s"
        f"{' since it was resumed' if report.resumed else ''}.</p>"
    )
    yield _table(*set_table(report))
    yield f"<h2>{best.name.capitalize()} gains, scenario by scenario</h2>"
    header, rows = scenario_table(report)
    yield _table(header, rows[:MOST_ROWS])
    if len(rows) > MOST_ROWS:
        yield f"<details><summary>All {len(rows)} scenarios</summary>{_table(header, rows)}</details>"
    if any(scenario.measurement is not None for scenario in report.study.scenarios):
        yield "<p>These are single runs with the noise seed of the scenario; the objective is over all seeds.</p>"


def _paths(report: GainReport, pictures: Mapping[str, PictureBytes]) -> Iterator[str]:
    yield "<h2>Paths</h2>"
    yield from (figure(*pictures[f"paths-{name}"]) for name in report.study.names[:MOST_PATHS])
    if len(report.study.names) > MOST_PATHS:
        yield f"<p>Of {len(report.study.names)} scenarios the first {MOST_PATHS} are drawn.</p>"


def _flatness(report: GainReport, pictures: Mapping[str, PictureBytes]) -> Iterator[str]:
    """Yield how flat the optimum is and which gain matters."""
    found = report.flatness
    yield "<h2>How flat the optimum is, and which gain matters</h2>"
    share = 100.0 * found.near_best_share
    kept = "" if math.isnan(share) else f" {share:.0f} % of the best grid points are within this range of values."
    yield (
        f"<p>Within the ranges of this table one gain can change on its own and costs no more than "
        f"{100.0 * found.tolerance:g} % of the objective.{kept}</p>"
    )
    low, high = (report.search.settings.bounds[:, column] for column in (0, 1))
    average, largest = report.sensitivity.average_sensitivity(), report.sensitivity.largest_sensitivity()
    rows = [
        (
            GAIN_TITLES[index],
            f"{found.best_gains[index]:.4g}",
            f"{found.low[index]:.4g} to {found.high[index]:.4g}",
            f"{low[index]:g} to {high[index]:g}",
            *(_percent(float(values[index])) for values in (average, largest)),
        )
        for index in range(len(GAIN_TITLES))
    ]
    titles = ("Gain", "Best", "As good", "Bounds", "Sensitivity of mean H, average (%)", "largest (%)")
    yield _table((titles, ("",) * len(titles)), rows)
    yield figure(*pictures["flatness"])
    yield figure(*pictures["sensitivity"])


def _history(report: GainReport, pictures: Mapping[str, PictureBytes]) -> Iterator[str]:
    """Yield the rounds of the grid and the local searches."""
    search = report.search
    yield "<h2>History</h2>"
    yield figure(*pictures["history"])
    if search.history:
        titles = ("Grid", "Gain sets", "Failed", "Best", "Worst survivor", *GAIN_TITLES)
        rows = [
            (
                str(index),
                f"{entry.evaluations:,}",
                f"{entry.failures:,}",
                f"{entry.best_value:.5f}",
                f"{entry.worst_survivor:.5f}",
                *(f"{axis[0]:.4g} to {axis[-1]:.4g}" for axis in entry.axes),
            )
            for index, entry in enumerate(search.history, start=1)
        ]
        yield _table((titles, ("",) * len(titles)), rows)
    if search.local:
        titles = ("Local search", "From", "To", *GAIN_TITLES, "Gain sets", "Ended")
        rows = [
            (
                str(index),
                f"{entry.start_value:.5f}",
                f"{entry.value:.5f}",
                *(f"{gain:.4g}" for gain in entry.gains),
                f"{entry.evaluations:,}",
                entry.status.replace("_", " "),
            )
            for index, entry in enumerate(search.local, start=1)
        ]
        listed = _table((titles, ("",) * len(titles)), rows)
        yield f"<details><summary>All {len(rows)} local searches</summary>{listed}</details>"


def _front(report: GainReport, pictures: Mapping[str, PictureBytes]) -> Iterator[str]:
    """Yield the front, if there is one."""
    front = report.front
    if front is None:
        return
    yield "<h2>Pareto front</h2>"
    names = " and ".join(name.replace("_", " ") for name in front.objectives)
    yield (
        f"<p>{len(front)} of {front.evaluations:,} gain sets are not beaten by another one in {escape(names)}. "
        f"Hypervolume over the ranges of the front: {front.hypervolume:.3f}.</p>"
    )
    if "front" not in pictures:
        return
    yield figure(*pictures["front"])
    titles = (*GAIN_TITLES, *(f"{name} ({METRIC_UNITS[name]})".replace(" ()", "") for name in front.objectives))
    rows = [
        (*(f"{gain:.4g}" for gain in gains), *(f"{value:.4f}" for value in values))
        for gains, values in zip(front.gains, front.values, strict=True)
    ]
    listed = _table((titles, ("",) * len(titles)), rows)
    yield f"<details><summary>All {len(rows)} gain sets of the front</summary>{listed}</details>"


def _settings(report: GainReport) -> Iterator[str]:
    yield "<h2>Settings</h2>"
    rows = [
        (name.replace("_", " "), _shown(value))
        for name, value in optimize_record.settings(report.study, report.search.settings).items()
    ]
    lines = "".join(
        f'<tr><th scope="row">{escape(name)}</th><td class="words">{escape(value)}</td></tr>' for name, value in rows
    )
    yield scroll(f"<table><tbody>{lines}</tbody></table>")


def _foot(report: GainReport, pictures: Mapping[str, PictureBytes]) -> Iterator[str]:
    made = datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC")
    files = ["results.json with every value", *(["front.csv"] if report.front is not None else [])]
    files += [f"{name}.png" for name in pictures]
    yield f"<p><small>hrsafety {escape(__version__)}, made {made} from {escape(report.path)}. "
    yield f"Beside this page: {escape(', '.join(files))}.</small></p>"


# ---- fragments --------------------------------------------------------------------------------------


def _table(header: tuple[Sequence[str], Sequence[str]], rows: Iterable[Sequence[str]]) -> str:
    """Return a table whose first column names the row."""
    titles = [f"{name} ({unit})" if unit else name for name, unit in zip(*header, strict=True)]
    lines = "".join(
        f'<tr><th scope="row">{escape(row[0])}</th>{"".join(f"<td>{escape(cell)}</td>" for cell in row[1:])}</tr>'
        for row in rows
    )
    looks = (' class="text"', *[""] * (len(titles) - 1))
    heads = "".join(f'<th scope="col"{look}>{escape(title)}</th>' for look, title in zip(looks, titles, strict=True))
    return scroll(f'<table class="wide"><thead><tr>{heads}</tr></thead><tbody>{lines}</tbody></table>')


def _percent(share: float) -> str:
    return f"{100.0 * share:.2f}" if math.isfinite(share) else "none"


def _shown(value: object) -> str:
    """Return a setting in words."""
    if value is None:
        return "none"
    if isinstance(value, dict):
        return "; ".join(f"{name} {_shown(entry)}" for name, entry in value.items())
    if hasattr(value, "tolist"):
        return _shown(value.tolist())
    if isinstance(value, (list, tuple)):
        return ", ".join(_shown(entry) for entry in value) or "none"
    return f"{value:g}" if isinstance(value, float) else str(value)
