"""``hrsafety record FILE...``: measured contacts judged, printed, and written as a page."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hrsafety import records
from hrsafety.cli import output, terminal, verdict
from hrsafety.cli.output import decimal
from hrsafety.cli.prediction import above_prediction, planned_row, prediction_section
from hrsafety.contact import MeasurementPlan, PlannedMeasurement
from hrsafety.errors import InvalidParameterError
from hrsafety.pages.report import Report, ReportCell, ReportTable, Section
from hrsafety.plausibility import ResultWarning
from hrsafety.standards.verdicts import VERDICT_WORDS, strictest

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["KINDS", "judge_records"]

KINDS = {
    "head": "acceleration of a head",
    "force": "contact force",
    "pressure": "pressure of a foil, one frame each line",
}
"""Kinds of records."""
HEAD_LIMITS = ("peak_g", "hic15", "hic36", "clip_3ms_g")
_HEAD_TITLES = ("peak", "HIC15", "HIC36", "3 ms level")
_HEAD_UNITS = ("g", "", "", "g")
_CONTACTS = {
    True: "free: the largest force counts against the transient limit",
    False: "clamped: the peak and what lasts count against the quasi-static limit, 0.5 s against the transient one",
}
Loads = records.AccelerationRecord | records.ForceRecord | records.PressureRecord


class _Judged(NamedTuple):
    """A file with its loads and verdict."""

    path: str
    sha256: str
    loads: Loads
    verdict: str


def judge_records(options: argparse.Namespace) -> None:
    """Judge measured records and report.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety record``.
    """
    output.check_targets(options)
    limits, row = _limits(options), _row(options)
    if row is not None and not limits:
        limits = _limits_of(row, options)
    judged = [_judged(path, options, limits) for path in options.files]
    word, repeated = _verdict(judged, options, limits)
    plan = None if row is None else _filled(row, options, judged)
    report = _report(options, judged, word, repeated, limits, plan)
    print(terminal.told(report))
    written: list[Path] = []
    if options.out is not None:
        place = output.folder(options.out)
        written = output.write_report(report, place, _draw(judged, options, limits), [], options=options)
        if plan is not None:
            written.append(plan.to_csv(place / "plan.csv"))
    output.say_written(written, report, options)
    output.report_warnings(report.warnings, strict=False)
    verdict.leave(word, report.said)
    output.leave_if_strict(report.warnings, options.strict)


def _limits(options: argparse.Namespace) -> dict[str, float]:
    """Return the limits that are given, each one of the kind."""
    of_kind = {"head": HEAD_LIMITS, "force": ("transient", "quasi_static"), "pressure": ("pressure",)}
    every = [name for names in of_kind.values() for name in names]
    given = {name: getattr(options, name) for name in every if getattr(options, name) is not None}
    for name in given:
        if name not in of_kind[options.kind]:
            option = f"--{name.replace('_', '-')}"
            raise InvalidParameterError(
                option, f"go with records of its kind, not with --kind {options.kind}", given[name]
            )
    return given


def _judged(path: str, options: argparse.Namespace, limits: dict[str, float]) -> _Judged:
    """Return the loads of a file."""
    found = records.load(path, time=options.time)
    columns = None if options.columns is None else [each.strip() for each in options.columns.split(",")]
    sha256 = found.source.sha256
    if options.kind == "head":
        head = found.acceleration(
            columns, unit=options.unit, filter_class=options.filter, full_scale=options.full_scale
        )
        return _Judged(path, sha256, head, head.verdict(**limits) if limits else "not_checked")
    if options.kind == "force":
        device = None if options.device is None else records.load_device(options.device)
        column = None if columns is None else columns[0]
        force = found.force(column, unit=options.unit, device=device, region_spring=options.region_spring)
        kept = force.verdict(
            transient=limits.get("transient"), quasi_static=limits.get("quasi_static"), clamped=not options.free
        )
        return _Judged(path, sha256, force, kept)
    chosen = [name for name in found.columns if name != found.time_column] if columns is None else columns
    cells = np.column_stack([found.columns[name] for name in chosen])
    unit = options.unit if options.unit is not None and found.units[chosen[0]] is None else "Pa"
    if options.pitch is None or options.row is None or cells.shape[1] % options.row:
        rule = f"be given with --row, the cells of a row, which divides the {cells.shape[1]} columns"
        raise InvalidParameterError("--pitch", rule, options.pitch)
    frames = cells.reshape(len(cells), -1, options.row)
    foil = records.pressure(frames, pitch=options.pitch, unit=unit, full_scale=options.full_scale)
    kept = foil.verdict(limits["pressure"], patch=options.patch) if limits else "not_checked"
    return _Judged(path, sha256, foil, kept)


def _verdict(
    judged: list[_Judged], options: argparse.Namespace, limits: dict[str, float]
) -> tuple[str, list[tuple[str, records.Repetitions]]]:
    """Return the verdict of all records, and of the repetitions of each load that has a limit."""
    words = [each.verdict for each in judged]
    repeated = []
    if len(judged) > 1:
        uncertainty = _uncertainty(options)
        for name, load, limit in _pairs(options, limits):
            values = [getattr(each.loads, load) for each in judged]
            if any(value is None or not np.isfinite(value) for value in values):
                words.append("not_checked")
                continue
            found = records.repetitions(values, limit, device_uncertainty=uncertainty)
            repeated.append((name, found))
            words.append(found.verdict)
    return strictest(words), repeated


def _row(options: argparse.Namespace) -> PlannedMeasurement | None:
    """Return the row of the measurement plan that the records are about."""
    if options.predict is None:
        if options.plan_row is not None:
            raise InvalidParameterError("--plan-row", "come with --predict", options.plan_row)
        return None
    if options.kind == "head":
        raise InvalidParameterError("--predict", "go with --kind force or pressure", options.predict)
    row = planned_row(options.predict, options.plan_row, options.kind)
    if options.kind == "force" and options.free != (row.setup == "free"):
        rule = f"be {'left out' if options.free else 'given'}: the row of the plan is a {row.setup} contact"
        raise InvalidParameterError("--free", rule, options.free)
    return row


def _limits_of(row: PlannedMeasurement, options: argparse.Namespace) -> dict[str, float]:
    """Return the limit of a row of the plan for every load of its records: a clamped peak is held against it, too."""
    if row.limit is None:
        return {}
    names = ("pressure",) if options.kind == "pressure" else ("transient", "quasi_static")
    return dict.fromkeys(names[:1] if options.free else names, row.limit)


def _filled(row: PlannedMeasurement, options: argparse.Namespace, judged: list[_Judged]) -> MeasurementPlan:
    """Return a row of the measurement plan with what was measured."""
    load = "peak" if options.kind == "force" else "patch" if options.patch else "cell"
    values = [float(getattr(each.loads, load)) for each in judged]
    return MeasurementPlan(rows=(row,)).filled({0: values}, device_uncertainty=_uncertainty(options))


def _uncertainty(options: argparse.Namespace) -> float | None:
    """Return the standard uncertainty of the device: the option, or what its file says; ``None`` if neither does."""
    if options.uncertainty is not None:
        return float(options.uncertainty)
    return None if options.device is None else records.load_device(options.device).uncertainty


def _doubts(
    options: argparse.Namespace, repeated: list[tuple[str, records.Repetitions]], plan: MeasurementPlan | None
) -> Iterator[ResultWarning]:
    """Yield the doubt about an expanded uncertainty without that of the device."""
    if (repeated or (plan is not None and plan.rows[0].found)) and _uncertainty(options) is None:
        message = (
            "no uncertainty of the device is given and it is taken as 0: expanded uncertainties are too small; give "
            "--uncertainty with the standard one of its certificate, 0 if the records are exact, or --device"
        )
        yield ResultWarning("taken_as_zero", "uncertainty", message)


def _pairs(options: argparse.Namespace, limits: dict[str, float]) -> Iterator[tuple[str, str, float]]:
    """Give what is called how, the load, and the limit that it is held against."""
    for name, limit in limits.items():
        if name == "pressure":
            yield name, "patch" if options.patch else "cell", limit
        elif name == "quasi_static":
            if not options.free:
                yield name, name, limit
                yield "peak, quasi-static limit", "peak", limit
        else:
            yield name, name, limit


def _report(
    options: argparse.Namespace,
    judged: list[_Judged],
    word: str,
    repeated: list[tuple[str, records.Repetitions]],
    limits: dict[str, float],
    plan: MeasurementPlan | None,
) -> Report:
    warnings: list[ResultWarning] = [warning for each in judged for warning in each.loads.warnings]
    warnings.extend(_doubts(options, repeated, plan))
    sections = [Section("Records", [_table(judged)])]
    if repeated:
        rows = [
            (
                name,
                found.number,
                f"{found.mean:.4g}",
                f"{found.largest:.4g}",
                f"{found.expanded_uncertainty:.3g}",
                _with_unit(name, found.limit),
                _cell(found.verdict, found.reason.replace("_", " ")),
            )
            for name, found in repeated
        ]
        titles = ("load", "records", "mean", "largest", "expanded uncertainty", "limit", "verdict")
        sections.append(Section("Repetitions", [ReportTable(headers=[titles], rows=rows, left=(0, 6), printed=True)]))
    if plan is not None:
        sections.append(prediction_section(plan))
    more = {} if plan is None else {"prediction": {"cell": options.predict, **plan.fields()[0]}}
    shown = ", ".join(f"{name.replace('_', '-')} {_with_unit(name, limit)}" for name, limit in limits.items())
    if plan is not None and not _limits(options):
        shown = f"{shown}, those of the plan of {options.predict}" if shown else shown
    return Report(
        title=f"Measured records: {KINDS[options.kind]}",
        facts=[
            ("files", ", ".join(Path(each.path).name for each in judged)),
            ("limits", shown or "none given: nothing is checked"),
            *([("contact", _CONTACTS[options.free])] if options.kind == "force" else []),
            *(() if plan is None else above_prediction(plan, options.predict)),
            *([("filter", f"CFC {options.filter}")] if options.filter else []),
        ],
        said=VERDICT_WORDS[word],
        good=word == "within_limits",
        sections=sections,
        warnings=warnings,
        values={"verdict": word, "limits": limits, "records": [_values(each) for each in judged], **more},
        source=options.files[0],
        made="",
    )


def _with_unit(name: str, limit: float) -> str:
    """Return a limit with its unit, by the name of its load."""
    units = {**dict(zip(HEAD_LIMITS, _HEAD_UNITS, strict=True)), "pressure": "Pa"}
    return f"{limit:g} {units.get(name, 'N')}".rstrip()


def _cell(word: str, small: str = "") -> ReportCell:
    return ReportCell(VERDICT_WORDS[word], {"within_limits": "good", "exceeds": "bad"}.get(word, ""), small)


def _table(judged: list[_Judged]) -> ReportTable:
    """Return the loads of all records."""
    rows: list[tuple[object, ...]] = []
    for each in judged:
        loads = each.loads
        doubts = ", ".join(warning.code for warning in loads.warnings)
        name = Path(each.path).name
        if isinstance(loads, records.AccelerationRecord):
            numbers = [f"{getattr(loads, load):.4g}" for load in HEAD_LIMITS]
            rows.append((name, *numbers, decimal(loads.velocity_change), len(loads.hits), _cell(each.verdict), doubts))
        elif isinstance(loads, records.ForceRecord):
            static = "-" if loads.quasi_static is None else f"{loads.quasi_static:.4g}"
            numbers = [f"{loads.peak:.4g}", f"{loads.transient:.4g}", static]
            rows.append((name, *numbers, len(loads.contacts), _cell(each.verdict), doubts))
        else:
            numbers = [f"{loads.cell:.4g}", f"{loads.patch:.4g}", f"{loads.force:.4g}"]
            rows.append((name, *numbers, _cell(each.verdict), doubts))
    first = judged[0].loads
    names: tuple[str, ...]
    units: tuple[str, ...]
    if isinstance(first, records.AccelerationRecord):
        names = ("record", *_HEAD_TITLES, "velocity change", "hits", "verdict", "doubts")
        units = ("", *_HEAD_UNITS, "m/s", "", "", "")
    elif isinstance(first, records.ForceRecord):
        names = ("record", "peak", "transient", "quasi-static", "contacts", "verdict", "doubts")
        units = ("", "N", "N", "N", "", "", "")
    else:
        names = ("record", "largest cell", "mean over 1 cm2", "force", "verdict", "doubts")
        units = ("", "Pa", "Pa", "N", "", "")
    last = len(names) - 1
    return ReportTable(headers=[names, units], rows=rows, left=(0, last - 1, last), printed=True)


def _values(each: _Judged) -> dict[str, object]:
    """Return the numbers of a record for JSON, without its samples."""
    loads = each.loads
    names = [name for name in type(loads).__dataclass_fields__ if name not in ("time", "force", "signal_g", "warnings")]
    if isinstance(loads, records.PressureRecord):
        names.append("force")
    found = {name: getattr(loads, name) for name in names}
    found |= {"codes": [warning.code for warning in loads.warnings], "verdict": each.verdict}
    plain = {
        name: value.tolist()
        if isinstance(value, np.ndarray)
        else [part._asdict() for part in value]
        if name in ("hits", "contacts")
        else value
        for name, value in found.items()
    }
    return {"file": Path(each.path).name, "sha256": each.sha256} | plain


def _draw(
    judged: list[_Judged], options: argparse.Namespace, limits: dict[str, float]
) -> Iterator[tuple[str, Figure, str]]:
    """Yield the picture of the traces."""
    from hrsafety import plotting

    if options.kind == "pressure":
        return
    lines = {"peak limit": limits["peak_g"]} if "peak_g" in limits else {}
    if options.kind == "force":
        lines = {f"{name.replace('_', '-')} limit": limit for name, limit in limits.items()}
    traces = [each.loads for each in judged if not isinstance(each.loads, records.PressureRecord)]
    names = [Path(each.path).name for each in judged]
    figure = plotting.measured_records(traces, names=names, limits=lines)
    yield "traces", figure, "Traces without offset; contacts are shaded, stars are peaks."
