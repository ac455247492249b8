"""Pictures of a program report as SVG that stands in the page."""

from __future__ import annotations

import numpy as np

from hrsafety.cli.cell.pictures import Drawing
from hrsafety.pages.chart import ChartLine, line_chart
from hrsafety.program import ProgramStudy, Retimed
from hrsafety.program.zoned import way_of

__all__ = ["drawings"]

CAPTION = "Speed of the tool center point over its way; segments are shaded"
RUNS = (("#0072b2", ""), ("#009e73", "6 2"))
"""Looks of the runs: color and dashes."""


def drawings(study: ProgramStudy) -> list[Drawing]:
    """Return the speed of the tool center point over its way.

    Parameters
    ----------
    study : ProgramStudy
        What was found.

    Returns
    -------
    list of Drawing
        In the order of the page.
    """
    way = way_of(study.limited.motion, study.speeds)
    if not way[-1] > 0.0:
        return []
    nodes, tool = study.limited.motion.curve.nodes, study.speeds.tool
    per_node = np.concatenate([tool[:, 0], tool[-1:, -1]])
    runs: dict[str, Retimed] = {"as planned" if study.program.motion.log is None else "at robot limits": study.free}
    if study.limited.standstill < 0:
        runs["within limits of contacts"] = study.limited
    allowed = study.speeds.tool_allowed
    limit = np.concatenate([allowed[:1, 0], np.minimum(allowed[:-1, -1], allowed[1:, 0]), allowed[-1:, -1]])
    zones = () if study.zones is None or study.zones.percent else study.zones.zones

    def along(first: float, last: float) -> tuple[float, float]:
        return float(np.interp(first, nodes, way)), float(np.interp(last, nodes, way))

    drawn = {name: per_node * np.sqrt(run.squared_speed) for name, run in runs.items()}
    lines = [ChartLine(name, way, drawn[name], *look) for name, look in zip(drawn, RUNS, strict=False)]
    lines.append(ChartLine("allowed", way, limit, "#c00000", "5 3", 1.2))
    for index, each in enumerate(zones):
        ends = np.array(along(each.first, each.last))
        lines.append(ChartLine("" if index else "zone as typed", ends, np.full(2, each.speed), "#555", "", 2.6))
    top = max(float(values.max(initial=0.0)) for values in drawn.values())
    top = max([top, *(min(each.speed, 2.0 * top) for each in zones)])
    program = study.program
    picture = line_chart(
        "speed-over-path",
        CAPTION,
        lines,
        labels=("way of the tool center point (m)", "speed (m/s)"),
        ends=(float(way[-1]), 1.1 * top if top > 0.0 else 1.0),
        bands={program.segment_name(place): along(*program.span(place)) for place in range(len(program.segments))},
    )
    return [Drawing("speed-over-path", "speed_over_path", "segments", CAPTION, picture)]
