"""Pictures of a contact report as SVG that stands in the page."""

from __future__ import annotations

import html
import io
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from hrsafety.contact import Cell, ContactImpact, ContactStudy
from hrsafety.contact.cell.study import Curve, label_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["PARTS", "Drawing", "drawings", "svg_of"]

PARTS = ("force_over_time", "force_over_speed", "map", "speed_over_distance", "sensitivity")
"""Kinds of pictures."""

STRENGTHS = {"modulus": "modulus (Pa)", "plateau": "plateau stress (Pa)", "b": "stress b (Pa)"}
PAPER = (4.8, 3.3)
"""Size of a picture in inch: two of them side by side on A4 have letters of 7 points."""
SMALL = 9.5
CLASSES = {"quasi_static": "clamped", "transient": "free"}


class Drawing(NamedTuple):
    """A picture in the page.

    Attributes
    ----------
    name : str
        Anchor.
    part : str
        One of `PARTS`.
    path : str
        Where its numbers stand in report.json.
    caption : str
        What it shows.
    svg : str
        The picture.
    """

    name: str
    part: str
    path: str
    caption: str
    svg: str


def drawings(cell: Cell, study: ContactStudy) -> list[Drawing]:
    """Return the pictures of a report.

    Parameters
    ----------
    cell : Cell
        What was asked.
    study : ContactStudy
        What was found.

    Returns
    -------
    list of Drawing
        In the order of the page.
    """
    return list(_drawn(cell, study))


def _drawn(cell: Cell, study: ContactStudy) -> Iterator[Drawing]:
    from hrsafety import plotting

    pictures = plotting.contacts
    for index, curves in enumerate(study.fields["curves"]):
        region = curves["region"]
        impacts, lines = study.impacts[region], {line.label: line for line in study.curves.get(region, [])}
        for kind, labels in _families(cell, region).items():
            words = f"{region.replace('_', ' ')}, {CLASSES[kind]}".capitalize()
            limits = _limits(cell, region, kind)
            hits = {short: impacts[label] for label, short in labels.items() if label in impacts}
            if hits:
                path = f"curves[{index}].force_over_time"
                figure = _on_paper(pictures.contact_forces(_without_warnings(hits), limits=limits))
                caption = f"{words}: force over time at the planned speed"
                yield _drawing(f"time-{index}-{kind}", "force_over_time", path, caption, figure)
            over = {short: lines[label] for label, short in labels.items() if label in lines}
            if over:
                path = f"curves[{index}].force_over_speed"
                figure = _on_paper(_over_speed(over, limits, _planned(cell, region, kind)))
                caption = f"{words}: peak force over the closing speed"
                yield _drawing(f"speed-{index}-{kind}", "force_over_speed", path, caption, figure)
    yield from _of_governing(cell, study)
    if study.speeds is not None:
        figure = _on_paper(pictures.speed_over_distance(replace(study.speeds, warnings=())))
        caption = "Allowed speed of the robot over its distance to the person"
        yield _drawing("speed-over-distance", "speed_over_distance", "speed_over_distance", caption, figure)


def _of_governing(cell: Cell, study: ContactStudy) -> Iterator[Drawing]:
    from hrsafety import plotting

    found = study.fields["map"]
    if found is not None:
        pad = cell.coverings[found["covering"]]
        table = np.array([[np.nan if each is None else each for each in row] for row in found["speed"]])
        figure = plotting.contacts.speed_map(
            found["thickness"],
            found["strength"],
            table,
            quantity=STRENGTHS[found["number"]],
            wanted=found["planned_closing_speed"],
            own=(pad.thickness, getattr(pad.material, found["number"])),
        )
        figure.set_size_inches(*PAPER)
        caption = f"{_place(found)}: allowed closing speed over the covering; white: the planned speed"
        yield _drawing("map", "map", "map", caption, figure)
    found = study.fields["sensitivity"]
    if found is not None and found["values"]:
        values = {each["name"]: each["value"] for each in found["values"]}
        figure = _on_paper(plotting.contacts.contact_sensitivity(values))
        yield _drawing("sensitivity-bars", "sensitivity", "sensitivity.values", f"{_place(found)}: sensitivity", figure)


def _place(found: Mapping[str, Any]) -> str:
    covering = "bare" if found["covering"] is None else found["covering"]
    return f"{found['region'].replace('_', ' ')}, {CLASSES[found['contact']]}, {covering}"


def _on_paper(figure: Figure) -> Figure:
    """Return a figure at the size at which two stand side by side on A4, with its legend below."""
    axes = figure.axes[0]
    handles, labels = axes.get_legend_handles_labels()
    figure.set_size_inches(*PAPER)
    beside = axes.get_legend()
    if beside is not None:
        beside.remove()
        figure.legend(handles, labels, loc="outside lower center", ncols=2, frameon=False, fontsize=SMALL)
    return figure


def _families(cell: Cell, region: str) -> dict[str, dict[str, str]]:
    """Return by class of contact the curves of a chart: bare and coverings, long labels to short ones."""
    found: dict[str, dict[str, str]] = {}
    for planned in cell.contacts:
        limit = planned.limit
        if limit.region == region:
            area = "" if limit.area is None else f"{limit.area}, "
            for covering in (None, *cell.coverings):
                short = f"{area}{covering or 'bare'}"
                found.setdefault(limit.contact, {})[label_of(planned, covering)] = short
    return found


def _over_speed(lines: Mapping[str, Curve], limits: Mapping[str, float], planned: float) -> Figure:
    """Return peak forces over one axis of speeds: lines end where their own speeds end."""
    from hrsafety import plotting

    speeds = np.unique(np.concatenate([line.speed for line in lines.values()]))
    forces = {
        short: np.interp(speeds, line.speed, line.force, left=np.nan, right=np.nan) for short, line in lines.items()
    }
    return plotting.contacts.forces_over_speed(speeds, forces, limits=limits, planned=planned)


def _limits(cell: Cell, region: str, kind: str) -> dict[str, float]:
    limits = (each.limit for each in cell.contacts if (each.limit.region, each.limit.contact) == (region, kind))
    forces = [limit.force for limit in limits if limit.force is not None and limit.permitted]
    return {CLASSES[kind]: min(forces)} if forces else {}


def _planned(cell: Cell, region: str, kind: str) -> float:
    speeds = (each.speed for each in cell.contacts if (each.limit.region, each.limit.contact) == (region, kind))
    return max(speeds) + cell.human_speed


def _without_warnings(impacts: Mapping[str, ContactImpact]) -> dict[str, ContactImpact]:
    """Return collisions whose warnings stand on the page, not below each picture."""
    return {label: replace(impact, warnings=()) for label, impact in impacts.items()}


def _drawing(name: str, part: str, path: str, caption: str, figure: Figure) -> Drawing:
    return Drawing(name, part, path, caption, svg_of(name, caption, figure))


def svg_of(name: str, caption: str, figure: Figure) -> str:
    """Return a figure as an element of a page: the same bytes every time, and names that no other picture has."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    buffer = io.StringIO()
    canvas: Any = FigureCanvasSVG(figure)  # matplotlib types it in part
    with rc_context({"svg.hashsalt": name, "svg.fonttype": "none"}):
        # `savefig` draws twice, at first for the layout alone.
        canvas.print_svg(buffer, metadata={"Date": None, "Creator": None})
    text = buffer.getvalue()
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>\s*", "", text, flags=re.DOTALL)
    text = re.sub(r'\bid="', f'id="{name}-', text)
    text = re.sub(r'(xlink:href="|url\()#', rf"\1#{name}-", text)
    size = re.compile(r'width="[\d.]+pt" height="[\d.]+pt"|height="[\d.]+pt" viewBox|width="[\d.]+pt"')
    text = size.sub(lambda match: "viewBox" if match[0].endswith("viewBox") else "", text, count=2)
    return text.replace("<svg", f'<svg role="img" aria-label="{html.escape(caption)}"', 1).rstrip()
