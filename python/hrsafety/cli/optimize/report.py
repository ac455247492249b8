"""The report of ``hrsafety optimize``."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from hrsafety import navigation as nav
from hrsafety._words import some
from hrsafety.cli.optimize import record as optimize_record
from hrsafety.cli.optimize.file import GainStudy
from hrsafety.cli.optimize.found import METRIC_UNITS, MOST_COLUMNS, MOST_PATHS, NOT_EVERYWHERE, FoundGains, gain_words
from hrsafety.cli.output import decimal
from hrsafety.pages import Picture, sentence
from hrsafety.pages.report import Report, ReportTable, Section

__all__ = ["report_of"]

GAIN_TITLES = ("K_1 (N/m)", "K_3 (N/m)", "K_5 (N/m^2)", "b (s)")
MOST_ROWS = 20  # scenarios that are listed at once
Rows = list[tuple[str, ...]]


def report_of(found: FoundGains, pictures: Mapping[str, Picture]) -> Report:
    """Return the report of a search.

    Parameters
    ----------
    found : FoundGains
        What was found.
    pictures : mapping of str to Picture
        Those of the page by name.
    """
    search, study, best = found.search, found.study, found.sets[0]
    reached = f"{found.objective.replace('_', ' ')} {_value(found)}{confidence_words(search)}"
    return Report(
        title=study.title,
        facts=list(_facts(found, reached)),
        said=f"best gains: {gain_words(best.law.gains)}" if search.valid else f"not feasible: {search.shortcoming}",
        good=search.valid and search.feasible,
        advice=_advice(found, reached),
        sections=list(_sections(found, pictures)),
        warnings=search.warnings,
        values=optimize_record.values(found),
        source=found.path,
    )


def _value(found: FoundGains) -> str:
    return f"{found.sets[0].value:.5f} {METRIC_UNITS[found.objective]}".rstrip()


def _facts(found: FoundGains, reached: str) -> Iterator[tuple[str, str]]:
    search, study, best = found.search, found.study, found.sets[0]
    since = " since it was resumed" if found.resumed else ""
    yield "study", found.path
    yield "scenarios", scenario_words(study)
    yield "search", search_words(search)
    yield (
        "counted",
        f"{search.evaluations:,} gain sets, {search.failures:,} of them with a contact or without arrival; "
        f"{some(search.episodes, 'run', form=',')} in {found.seconds:.2f} s{since}",
    )
    if search.valid:
        yield "best gains", gain_words(best.law.gains)
    else:
        yield "best gains", f"none: {search.shortcoming}"
        yield "remedy", search.remedy
        yield "nearest gains", gain_words(best.law.gains)
    yield "objective", reached
    if search.valid and not search.feasible:
        yield "not feasible", NOT_EVERYWHERE


def _advice(found: FoundGains, reached: str) -> str:
    search = found.search
    if not search.valid:
        return f"To mend it, {search.remedy}. Everything below is of the nearest gain set, which is no result."
    return f"{sentence(reached)}." + ("" if search.feasible else f" Not feasible: {NOT_EVERYWHERE}.")


def _sections(found: FoundGains, pictures: Mapping[str, Picture]) -> Iterator[Section]:
    search, study, front, flatness = found.search, found.study, found.front, found.flatness
    count = len(study.names)
    noise = "These are single runs with the noise seed of the scenario; the objective is over all seeds."
    noisy = any(scenario.measurement is not None for scenario in study.scenarios)
    yield Section("Gain sets", [set_table(found)])
    name = found.sets[0].name
    yield Section(f"{name} gains, scenario by scenario", [scenario_table(found), *([noise] if noisy else [])])
    paths = [pictures[f"paths-{name}"] for name in study.names[:MOST_PATHS]]
    rest = [f"Of {some(count, 'scenario')} the first {len(paths)} are drawn."] if count > len(paths) else []
    yield Section("Paths", [*paths, *rest])
    near = flatness.near_best_share
    share = (
        "" if math.isnan(near) else f" {100.0 * near:.0f} % of the best grid points are within this range of values."
    )
    told = (
        "Within the ranges of this table one gain can change on its own and costs no more than "
        f"{100.0 * flatness.tolerance:g} % of the objective.{share}"
    )
    titles: tuple[str, ...] = ("gain", "best", "as good", "bounds", "sensitivity of mean H, average (%)", "largest (%)")
    flat = ReportTable(headers=[titles], rows=_flat_rows(found))
    yield Section(
        "How flat the optimum is, and which gain matters",
        [told, flat, pictures["flatness"], pictures["sensitivity"]],
    )
    history: list[str | ReportTable | Picture] = [pictures["history"]]
    if search.grids:
        titles = ("grid", "gain sets", "failed", "best", "worst survivor", *GAIN_TITLES)
        history.append(ReportTable(headers=[titles], rows=_history_rows(search)))
    if search.local:
        titles = ("local search", "from", "to", *GAIN_TITLES, "gain sets", "ended")
        summary = f"All {len(search.local)} local searches"
        history.append(ReportTable(headers=[titles], rows=_local_rows(search), summary=summary))
    yield Section("History", history)
    if front is not None:
        names = " and ".join(name.replace("_", " ") for name in front.objectives)
        told = (
            f"{len(front)} of {front.evaluations:,} gain sets are not beaten by another one in {names}. Hypervolume "
            f"over the ranges of the front: {front.hypervolume:.3f}."
        )
        rows = ReportTable(
            headers=[_front_titles(front)], rows=_front_rows(front), summary=f"All {len(front)} gain sets of the front"
        )
        drawn: list[ReportTable | Picture] = [pictures["front"], rows] if "front" in pictures else []
        yield Section("Pareto front", [told, *drawn])
    settings = [
        (name.replace("_", " "), _shown(value))
        for name, value in optimize_record.settings(study, search.settings).items()
    ]
    yield Section("Settings", [ReportTable(headers=[("setting", "value")], rows=settings, left=(0, 1))])


def scenario_words(study: GainStudy) -> str:
    """Return the names of the scenarios, of many the first ones."""
    more = len(study.names) - MOST_PATHS
    names = ", ".join(study.names[:MOST_PATHS])
    return f"{names} and {more} more" if more > 0 else names


def search_words(search: nav.GainSearch) -> str:
    """Return how a search went about it, in one line."""
    settings = search.settings
    if settings.method != "grid":
        return f"{settings.method.replace('_', ' ')}, {search.evaluations:,} gain sets"
    grid = " x ".join(str(count) for count in settings.grid)
    return (
        f"grid {grid}, {some(settings.refinements, 'refinement')} to the {settings.survivors} best, "
        f"{len(search.local)} local searches"
    )


def confidence_words(search: nav.GainSearch) -> str:
    """Return what fresh noise says about the best value; empty without noise."""
    if search.confidence is None:
        return ""
    found = search.confidence
    return (
        f"; with {found.seeds} fresh seeds {found.mean:.5f}, {100.0 * found.level:g} % interval "
        f"[{found.low:.5f}, {found.high:.5f}]"
    )


def set_table(found: FoundGains) -> ReportTable:
    """Return the gain sets with their objectives and scores."""
    several = len(found.study.names) > MOST_COLUMNS
    scenarios = ("least H", "mean H") if several else tuple(f"H {name}" for name in found.study.names)
    names = ("gains", "K_1", "K_3", "K_5", "b", found.objective, *scenarios)
    units = ("", "N/m", "N/m", "N/m^2", "s", METRIC_UNITS[found.objective], *("" for _ in scenarios))
    rows = []
    for entry in found.sets:
        total = entry.scores.performance_total
        shown = (total.min(), total.mean()) if several else total
        gains = (f"{gain:.3f}" for gain in entry.law.gains)
        rows.append((entry.name, *gains, f"{entry.value:.5f}", *(f"{score:.4f}" for score in shown)))
    return ReportTable(headers=(names, units), rows=rows, printed=True)


def scenario_table(found: FoundGains) -> ReportTable:
    """Return the runs of the best gain set, or the nearest without one."""
    first = f"{found.sets[0].name} gains in"
    names = (first, "outcome", "arrival", "energy", "path", "clearance", "H", "H_T", "H_D", "H_E")
    units = ("", "", "s", "J", "m", "m", "", "", "", "")
    table = found.sets[0].scores
    lengths = (table.arrival_time, table.energy, table.path_length)
    shares = (table.performance_arrival_time, table.performance_avoidance, table.performance_energy_saving)
    rows = [
        (
            name,
            str(table.outcome[index]),
            *(decimal(float(column[index])) for column in lengths),
            decimal(float(table.min_clearance[index]), 3),
            *(f"{column[index]:.4f}" for column in (table.performance_total, *shares)),
        )
        for index, name in enumerate(found.study.names)
    ]
    return ReportTable(
        headers=(names, units),
        rows=rows,
        left=(0, 1),
        most=MOST_ROWS,
        summary=f"All {some(len(rows), 'scenario')}",
        printed=True,
        more=f"and {len(rows) - MOST_ROWS} more scenarios in results.json",
    )


def _flat_rows(found: FoundGains) -> Rows:
    """Return each gain with the range that is as good, its bounds and its sensitivity."""
    flat, bounds = found.flatness, found.search.settings.bounds
    average, largest = found.sensitivity.average_sensitivity(), found.sensitivity.largest_sensitivity()
    return [
        (
            title,
            f"{flat.best_gains[index]:.4g}",
            f"{flat.low[index]:.4g} to {flat.high[index]:.4g}",
            f"{bounds[index, 0]:g} to {bounds[index, 1]:g}",
            *(_percent(float(values[index])) for values in (average, largest)),
        )
        for index, title in enumerate(GAIN_TITLES)
    ]


def _history_rows(search: nav.GainSearch) -> Rows:
    return [
        (
            str(index),
            f"{entry.evaluations:,}",
            f"{entry.failures:,}",
            f"{entry.best_value:.5f}",
            f"{entry.worst_survivor:.5f}",
            *(f"{axis[0]:.4g} to {axis[-1]:.4g}" for axis in entry.axes),
        )
        for index, entry in enumerate(search.grids, start=1)
    ]


def _local_rows(search: nav.GainSearch) -> Rows:
    return [
        (
            str(index),
            f"{entry.start_value:.5f}",
            f"{entry.best_value:.5f}",
            *(f"{gain:.4g}" for gain in entry.best_gains),
            f"{entry.evaluations:,}",
            entry.status.replace("_", " "),
        )
        for index, entry in enumerate(search.local, start=1)
    ]


def _front_titles(front: nav.gains.ParetoFront) -> tuple[str, ...]:
    return (*GAIN_TITLES, *(f"{name} ({METRIC_UNITS[name]})".replace(" ()", "") for name in front.objectives))


def _front_rows(front: nav.gains.ParetoFront) -> Rows:
    return [
        (*(f"{gain:.4g}" for gain in gains), *(f"{value:.4f}" for value in values))
        for gains, values in zip(front.gains, front.values, strict=True)
    ]


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
