"""Pictures of a program report as SVG that stands in the page."""

from __future__ import annotations

import numpy as np

from hrsafety.cli.cell.pictures import Drawing, svg_of
from hrsafety.program import ProgramStudy, Retimed
from hrsafety.program.zoned import way_of

__all__ = ["drawings"]


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
    from hrsafety import plotting

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

    figure = plotting.contacts.speed_over_path(
        way,
        {name: per_node * np.sqrt(run.squared_speed) for name, run in runs.items()},
        allowed=limit,
        zones=[(*along(each.first, each.last), each.speed) for each in zones],
        segments={
            study.program.segment_name(place): along(*study.program.span(place))
            for place in range(len(study.program.segments))
        },
    )
    caption = "Speed of the tool center point over its way; segments are shaded"
    return [
        Drawing("speed-over-path", "speed_over_path", "segments", caption, svg_of("speed-over-path", caption, figure))
    ]
