"""``hrsafety foam DESIGN.toml``: which foams keep the limits, with a page and a picture."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hrsafety import impact
from hrsafety.cli import output, terminal
from hrsafety.cli.foam import report as foam_report
from hrsafety.cli.foam.curves import Remembered
from hrsafety.cli.foam.file import Array, FoamDesignFile, load
from hrsafety.cli.foam.found import LOADS, Check, CheckedFoam, FoundFoams, StiffnessRange
from hrsafety.plausibility import ResultWarning

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["design_file"]


def design_file(options: argparse.Namespace) -> None:
    """Judge the foams of a file, print the result and write the page.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety foam``.
    """
    output.planned_folder(options.out)
    output.require_page("foam")
    output.check_json(options)
    with output.located(options.design):
        described = load(options.design)
    place = output.folder(options.out)
    design = _design(described)
    curves = _Curves(
        upper=Remembered(design.upper) if design.limits.given().keys() - {"max_compression"} else None,
        lower=Remembered(design.lower),
    )
    found = _found(described, design, curves)
    report = foam_report.report_of(options.design, found)
    print(terminal.told(report))
    table = output.write_csv(place / "boundaries.csv", ["damping_N_s_per_m", *_COLUMNS], _rows(found))
    drawn = [("boundaries", _picture(found, design, curves), foam_report.CAPTION)]
    output.say_written(output.write_report(report, place, drawn, [table]), report, options)
    output.report_warnings(found.warnings, options.strict)


# ---- judging ----------------------------------------------------------------------------------------


def _design(file: FoamDesignFile) -> impact.FoamDesign:
    # Beyond its linear range no foam keeps a limit: the range is one, whether the file names it or not.
    most = min(file.limits.max_compression or math.inf, file.sought.linear_range)
    return impact.design_foam(
        file.manipulator,
        replace(file.limits, max_compression=most),
        closing_speed=file.closing_speed,
        thickness=file.sought.thickness,
        linear_range=file.sought.linear_range,
    )


class _Curves(NamedTuple):
    """Boundaries over the damping, for table and picture; ``None`` without a limit for them."""

    upper: Remembered | None
    lower: Remembered


def _found(file: FoamDesignFile, design: impact.FoamDesign, curves: _Curves) -> FoundFoams:
    return FoundFoams(
        file=file,
        upper=curves.upper(file.damping) if curves.upper else None,
        lower=curves.lower(file.damping),
        foams=tuple(_judged(design, name, foam) for name, foam in file.foams.items()),
        widest=_widest(file.damping, *design.stiffness_range(file.damping, file.margin)),
        feasibility=design.feasibility(file.damping, file.margin),
        warnings=_warnings(file, design),
    )


def _warnings(file: FoamDesignFile, design: impact.FoamDesign) -> tuple[ResultWarning, ...]:
    """Return the warnings of all numbers of the file, those of a foam with its place in it."""
    of_foams = [
        replace(each, subject=f"foams[{index}].{each.subject}", message=f"foams[{index}] ({name!r}): {each.message}")
        for index, (name, foam) in enumerate(file.foams.items())
        for each in foam.warnings
    ]
    return (*design.warnings, *file.limits.warnings, *file.sought.warnings, *of_foams)


def _widest(damping: Array, least: Array, largest: Array) -> StiffnessRange | None:
    """Return the widest range of stiffness, if there is one at any damping."""
    width = largest - least
    if np.isnan(width).all():
        return None
    index = int(np.nanargmax(width))
    if np.isinf(width[index]):
        # Nothing limits the stiffness: the range that begins first is the widest.
        index = int(np.nanargmin(np.where(np.isinf(width), least, np.nan)))
    return StiffnessRange(float(damping[index]), float(least[index]), float(largest[index]))


def _judged(design: impact.FoamDesign, name: str, foam: impact.Foam) -> CheckedFoam:
    left = design.margin(foam)
    checks, speeds = [], []
    for key, limit in design.limits.given().items():
        words, unit, scale, power = LOADS[key]
        margin = getattr(left, key)
        checks.append(
            Check(name=words, unit=unit, value=scale * limit * (1.0 - margin), limit=scale * limit, margin=margin)
        )
        # Loads are proportional to this power of the closing speed.
        speeds.append(design.closing_speed * (1.0 - margin) ** (-1.0 / power) if margin < 1.0 else math.inf)
    return CheckedFoam(
        name=name,
        foam=foam,
        accepted=design.accepts(foam),
        status=left.status,
        checks=tuple(checks),
        # The range of the foam itself binds as well; loads that never end leave no speed at all.
        max_closing_speed=min(*speeds, design.closing_speed / max(1.0 - left.linear_range, 1e-300)),
    )


# ---- files ------------------------------------------------------------------------------------------


_COLUMNS = ("upper_stiffness_N_per_m", "upper_status", "lower_stiffness_N_per_m", "lower_status")


def _rows(found: FoundFoams) -> Iterator[list[object]]:
    for index, damping in enumerate(found.file.damping):
        row: list[object] = [float(damping)]
        for boundary in (found.upper, found.lower):
            if boundary is None:
                row += ["", "no limit"]
            else:
                row += [float(boundary.stiffness[index]), str(boundary.status[index])]
        yield row


def _picture(found: FoundFoams, design: impact.FoamDesign, curves: _Curves) -> Figure:
    from hrsafety import plotting
    from hrsafety.plotting.impacts.boundaries import refined

    file = found.file
    damping = refined(file.damping, [curve for curve in curves if curve])
    return plotting.foam_boundaries(
        damping,
        curves.upper(damping) if curves.upper else None,
        curves.lower(damping),
        foams=file.foams,
        accepted={judged.name: judged.accepted for judged in found.foams},
        statuses={name: getattr(design.margin(foam), "status", "") for name, foam in file.foams.items()},
        results=[design],
        fitting=design.stiffness_range(damping, 0.0),
        upper_label="upper",
        lower_label="lower",
        title=file.title,
    )
