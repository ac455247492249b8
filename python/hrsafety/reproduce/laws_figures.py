"""Own pictures for Figures 5.11, 5.12, 6.19 and 6.20: every law with the same person."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety import navigation as nav
from hrsafety import plotting
from hrsafety.pages import Picture
from hrsafety.reproduce.figures import picture
from hrsafety.reproduce.laws_compared import COMPARED, FORCES, PLANNERS, Compared
from hrsafety.reproduce.laws_study import LawsStudy

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["CONTACT", "CONTACT_COLOR", "DASHED", "GOAL_COLOR", "PERSON_COLOR", "frame", "make"]

PERSON_COLOR, GOAL_COLOR, CONTACT_COLOR = "#D55E00", "#00795C", "#C00000"
DASHED = (0, (5, 1.8))
GROUPS = {"laws of virtual forces": FORCES, "laws that plan": PLANNERS}
INSTANTS = (1.0, 2.0, 2.5, 3.0, 4.0, 5.5)  # s
SHOWN = 15.0  # s, beyond which every law has arrived
PASSED = 10.0  # s, beyond which every distance only grows
VIEW = ((-0.4, 4.7), (-1.1, 4.3))
CONTACT: dict[str, Any] = {
    "marker": "X",
    "color": CONTACT_COLOR,
    "markersize": 9,
    "markeredgecolor": "white",
    "linestyle": "none",
}


def make(study: LawsStudy) -> list[Picture]:
    """Draw paths, distances and instants with the unpredictable person, and Figs 6.19 and 6.20."""
    walk = "a person who slows down to rest and walks off sideways"
    parallel = [study.parallel["new_vff"], study.parallel["masoud"]]
    labels = ["New VFF", "Masoud"]
    beside = "a person who walks parallel to the way of the robot (section 6.4.5); New VFF and Masoud"
    return [
        picture(
            "figure-5.11-paths",
            f"Paths with {walk} (as Fig. 5.11): nine laws with their default parameters; dots on the path of the "
            "person and of the robots each second, a cross at the first contact.",
            _paths(study),
        ),
        picture(
            "figure-5.11-instants",
            f"Nine laws at six instants with {walk} (as Fig. 5.11); discs have the size of robots and person, the "
            "circle is the critical region, drawn through are laws of virtual forces, dashed laws that plan.",
            _instants(study),
        ),
        picture(
            "figure-5.12-distances",
            f"Distance between the centers of robot and person over time (as Fig. 5.12), {walk}: nine laws with their "
            "default parameters. Below 0.6 m they touch. Lines end at the arrival.",
            _distances(study),
        ),
        picture(
            "unpredictable-contacts",
            f"{len(study.varied['new_vff'].contact)} varied walks of the unpredictable person: share of walks with a "
            "contact with its 95 % Wilson interval, and least distance of the centers (line: median, box: quartiles, "
            "whiskers: all walks; they touch at 0.6 m).",
            _contacts(study),
        ),
        picture("figure-6.19-paths", f"Paths (as Fig. 6.19): {beside}.", plotting.paths(parallel, labels=labels)),
        picture(
            "figure-6.20-distances",
            f"Distance to goal and person over time (as Fig. 6.20): {beside}.",
            plotting.distances(parallel, labels=labels),
        ),
    ]


def frame(axes: Axes) -> None:
    """Give axes the look of the page."""
    axes.grid(color="#E3E3E3", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _row(run: nav.Trajectory, instant: float) -> int:
    return min(int(np.searchsorted(run.time, instant)), len(run.time) - 1)


def _seconds(run: nav.Trajectory) -> list[int]:
    return [_row(run, float(second)) for second in np.arange(1.0, min(float(run.time[-1]), SHOWN), 1.0)]


def _paths(study: LawsStudy) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 5.6), layout="constrained")
    for axes, (title, group) in zip(figure.subplots(1, 2, sharey=True), GROUPS.items(), strict=True):
        _scene(axes, study.printed["new_vff"])
        for name, entry in group.items():
            _path(axes, study.printed[name], entry)
        longest = max((study.printed[name] for name in group), key=lambda run: float(run.time[-1]))
        _person(axes, longest)
        axes.set_title(title, fontsize=11)
        axes.legend(loc="upper left", frameon=False, fontsize=9)
        axes.label_outer()
    return figure


def _scene(axes: Axes, run: nav.Trajectory) -> None:
    """Frame the scene of section 5.7; mark start and goal."""
    frame(axes)
    axes.set_aspect("equal")
    axes.set_xlim(*VIEW[0])
    axes.set_ylim(*VIEW[1])
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.plot(*run.scenario.start, "o", color="black", markerfacecolor="white", markersize=7, zorder=2)
    axes.plot(*run.scenario.goal, "*", color=GOAL_COLOR, markersize=13, markeredgecolor="white", zorder=6)


def _path(axes: Axes, run: nav.Trajectory, entry: Compared) -> None:
    x, y = run.position.T
    axes.plot(x, y, color=entry.color, linewidth=1.6, label=entry.label, zorder=4)
    seconds = _seconds(run)
    axes.plot(x[seconds], y[seconds], "o", color=entry.color, markersize=3.5, zorder=4)
    if np.isfinite(run.contact_time[0]):
        row = _row(run, float(run.contact_time[0]))
        axes.plot(x[row], y[row], zorder=7, **CONTACT)


def _person(axes: Axes, run: nav.Trajectory) -> None:
    x, y = run.obstacle_position[:, 0].T
    axes.plot(x, y, ":", color=PERSON_COLOR, linewidth=1.8, label="person", zorder=3)
    seconds = _seconds(run)
    axes.plot(x[seconds], y[seconds], "o", color=PERSON_COLOR, markersize=3.5, zorder=3)


def _instants(study: LawsStudy) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 7.4), layout="constrained")
    for axes, instant in zip(figure.subplots(2, 3, sharex=True, sharey=True).flat, INSTANTS, strict=True):
        reference = max(study.printed.values(), key=lambda run: float(run.time[-1]))
        _scene(axes, reference)
        axes.label_outer()
        _disc(axes, reference.obstacle_position[_row(reference, instant), 0], 0.4, facecolor=PERSON_COLOR, alpha=0.85)
        _disc(axes, reference.obstacle_position[_row(reference, instant), 0], 0.8, fill=False, color=PERSON_COLOR)
        for name, entry in COMPARED.items():
            run, dashes = study.printed[name], "-" if name in FORCES else DASHED
            row = _row(run, instant)
            _disc(
                axes, run.position[row], 0.2, facecolor="none", edgecolor=entry.color, linestyle=dashes, linewidth=1.6
            )
            axes.plot(*run.position[: row + 1].T, color=entry.color, linestyle=dashes, linewidth=0.8, zorder=4)
        axes.set_title(f"t = {instant:g} s", fontsize=11)
    figure.legend(handles=_handles(), loc="outside lower center", ncols=5, frameon=False, fontsize=9)
    return figure


def _disc(axes: Axes, center: np.ndarray, radius: float, **look: Any) -> None:
    from matplotlib.patches import Circle

    axes.add_patch(Circle((float(center[0]), float(center[1])), radius, zorder=5, **look))


def _handles() -> list[Artist]:
    from matplotlib.lines import Line2D

    handles: list[Artist] = []
    for group, dashes in ((FORCES, "-"), (PLANNERS, DASHED)):
        handles += [
            Line2D([], [], color=entry.color, linestyle=dashes, linewidth=1.6, label=entry.label)  # type: ignore[arg-type]  # dashes may be a tuple
            for entry in group.values()
        ]
    look: dict[str, Any] = {"marker": "o", "markersize": 9, "linestyle": "none", "color": PERSON_COLOR}
    handles.append(Line2D([], [], label="person", **look))
    return handles


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
