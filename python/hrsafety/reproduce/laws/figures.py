"""Own pictures for Figures 5.11, 5.12, 6.19 and 6.20: every law with the same person."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from hrsafety import navigation as nav
from hrsafety import plotting
from hrsafety.pages import Picture
from hrsafety.plotting.floor import CONTACT
from hrsafety.reproduce.figures import captioned
from hrsafety.reproduce.laws.compared import COMPARED, FORCES, PLANNERS
from hrsafety.reproduce.laws.study import LawsStudy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["CONTACT_COLOR", "DASHED", "GOAL_COLOR", "PERSON_COLOR", "frame", "make"]

PERSON_COLOR, GOAL_COLOR, CONTACT_COLOR = "#D55E00", "#00795C", "#C00000"
DASHED = (0, (5, 1.8))
GROUPS = {"laws of virtual forces": FORCES, "laws that plan": PLANNERS}
INSTANTS = (1.0, 2.0, 2.5, 3.0, 4.0, 5.5)  # s
PASSED = 10.0  # s, beyond which every distance only grows


def make(study: LawsStudy) -> list[Picture]:
    """Draw paths, distances and instants with the unpredictable person, and Figs 6.19 and 6.20."""
    walk = "a person who slows down to rest and walks off sideways"
    parallel = [study.parallel["new_vff"], study.parallel["masoud"]]
    labels = ["New VFF", "Masoud"]
    laws = {entry.label: study.printed[name] for name, entry in COMPARED.items()}
    beside = "a person who walks parallel to the way of the robot (section 6.4.5); New VFF and Masoud"
    return [
        captioned("figure-5.11-paths", plotting.comparison_paths(laws), walk=walk),
        captioned("figure-5.11-instants", plotting.comparison_sequence(laws, INSTANTS), walk=walk),
        captioned("figure-5.12-distances", _distances(study), walk=walk),
        captioned("unpredictable-contacts", _contacts(study), walks=len(study.varied["new_vff"].contact)),
        captioned("figure-6.19-paths", plotting.paths(parallel, labels=labels), beside=beside),
        captioned("figure-6.20-distances", plotting.distances(parallel, labels=labels), beside=beside),
    ]


def frame(axes: Axes) -> None:
    """Give axes the look of the page."""
    axes.grid(color="#E3E3E3", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _row(run: nav.Trajectory, instant: float) -> int:
    return min(int(np.searchsorted(run.time, instant)), len(run.time) - 1)


def _distances(study: LawsStudy) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 4.8), layout="constrained")
    for axes, (title, group) in zip(figure.subplots(1, 2, sharey=True), GROUPS.items(), strict=True):
        frame(axes)
        for name, entry in group.items():
            run = study.printed[name]
            axes.plot(run.time, run.distance[:, 0], color=entry.color, linewidth=1.6, label=entry.label, zorder=4)
            if np.isfinite(run.contact_time[0]):
                row = _row(run, float(run.contact_time[0]))
                axes.plot(run.time[row], run.distance[row, 0], zorder=7, **CONTACT)
        for height, words, color in (
            (0.6, "contact", CONTACT_COLOR),
            (0.8, "$r_3$", "#555555"),
            (2.1, "$r_2$", "#555555"),
        ):
            axes.axhline(height, color=color, linewidth=1.0, linestyle="--", zorder=2)
            below = height < 0.8
            place = height - 0.05 if below else height + 0.03
            look = {"color": color, "fontsize": 9, "ha": "right", "va": "top" if below else "bottom"}
            axes.text(PASSED - 0.1, place, words, **look)
        axes.set_xlim(0.0, PASSED)
        axes.set_ylim(0.0, 5.0)
        axes.set_title(title, fontsize=11)
        axes.set_xlabel("time (s)")
        axes.set_ylabel("distance between the centers, d (m)")
        axes.label_outer()
        axes.legend(frameon=False, fontsize=9, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=3)
    return figure


def _contacts(study: LawsStudy) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    shares, distances = figure.subplots(1, 2, sharey=True)
    names = list(COMPARED)
    places = np.arange(len(names))[::-1]
    for place, name in zip(places, names, strict=True):
        share, color = study.varied[name].touched, COMPARED[name].color
        look = {"color": color, "linewidth": 1.6, "linestyle": "-" if name in FORCES else DASHED}
        shares.plot([100 * share.low, 100 * share.high], [place, place], **look)
        shares.plot(100 * share.value, place, "o", color=color, markersize=6)
        shares.text(100 * share.high + 1.0, place, f"{share.count}", fontsize=9, va="center")
    _boxes(distances, [study.varied[name].least_distance for name in names], places)
    shares.set_yticks(places, [COMPARED[name].label for name in names])
    shares.set_xlabel("walks with a contact (%), number")
    shares.set_xlim(-1.0, 5.0 + max(100.0 * study.varied[name].touched.high for name in names))
    for axes in (shares, distances):
        frame(axes)
    return figure


def _boxes(axes: Axes, values: Sequence[np.ndarray], places: np.ndarray) -> None:
    axes.boxplot(
        list(values),
        positions=places.tolist(),
        orientation="horizontal",
        widths=0.5,
        whis=(0.0, 100.0),
        medianprops={"color": "black", "linewidth": 1.6},
        manage_ticks=False,
    )
    axes.axvline(0.6, color=CONTACT_COLOR, linestyle="--", linewidth=1.0)
    axes.set_xlabel("least distance between the centers (m)")
    axes.set_xlim(0.0, None)
