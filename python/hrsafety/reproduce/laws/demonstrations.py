"""Own pictures for Figures 2.5 and 2.6: the collinear condition and oscillation at an edge."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hrsafety import navigation as nav
from hrsafety.pages import Picture
from hrsafety.plotting.floor import CONTACT
from hrsafety.reproduce.figures import captioned
from hrsafety.reproduce.laws.compared import FORCES
from hrsafety.reproduce.laws.figures import GOAL_COLOR, PERSON_COLOR, frame
from hrsafety.reproduce.laws.study import LawsStudy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["make"]

DISC_COLOR = "#404040"
LONGEST = {"standing": 20.0, "walking": 10.0}  # s that are shown
OSCILLATION_TIME = 12.0  # s


def make(study: LawsStudy) -> list[Picture]:
    """Draw both demonstrations."""
    return [
        captioned("figure-2.5-collinear", _collinear(study)),
        captioned("figure-2.6-oscillation", _oscillation(study)),
    ]


def _collinear(study: LawsStudy) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 6.6), layout="constrained")
    panels = figure.subplots(2, 2, gridspec_kw={"height_ratios": (1.0, 1.6)})
    for column, case in enumerate(("standing", "walking")):
        above, below = panels[0, column], panels[1, column]
        for name, entry in FORCES.items():
            run: nav.Trajectory = getattr(study.demonstrations[name], case)
            shown = run.time <= LONGEST[case]
            above.plot(*run.position[shown].T, color=entry.color, linewidth=1.6, label=entry.label)
            below.plot(run.time[shown], run.position[shown, 0], color=entry.color, linewidth=1.6)
            if np.isfinite(run.contact_time[0]):
                row = int(np.searchsorted(run.time, run.contact_time[0]))
                above.plot(*run.position[row], zorder=7, **CONTACT)
                below.plot(run.time[row], run.position[row, 0], zorder=7, **CONTACT)
        _finish(above, below, getattr(study.demonstrations["khatib"], case), case)
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5, frameon=False, fontsize=9)
    return figure


def _finish(above: Axes, below: Axes, run: nav.Trajectory, case: str) -> None:
    """Draw obstacle and goal, and label the panels of one case."""
    from matplotlib.patches import Circle

    radius, color, words = (
        (0.1, DISC_COLOR, "a standing disc") if case == "standing" else (0.4, PERSON_COLOR, "a person")
    )
    shown = run.time <= LONGEST[case]
    place = run.obstacle_position[shown, 0]
    above.add_patch(Circle((float(place[0, 0]), float(place[0, 1])), radius, facecolor=color, alpha=0.85, zorder=3))
    if case == "walking":
        above.plot(*place.T, ":", color=color, linewidth=1.6)
    touching = radius + run.scenario.robot.radius
    below.fill_between(
        run.time[shown], place[:, 0] - touching, place[:, 0] + touching, color=color, alpha=0.2, linewidth=0
    )
    goal_x, goal_y = run.scenario.goal
    above.plot(goal_x, goal_y, "*", color=GOAL_COLOR, markersize=13, markeredgecolor="white", zorder=6)
    below.axhline(goal_x, color=GOAL_COLOR, linestyle="--", linewidth=1.2)
    above.set_title(words, fontsize=11)
    above.set_aspect("equal")
    above.set_xlim(-0.3, 6.3)
    above.set_ylim(-0.1, 2.3)
    above.set_xlabel("x (m)")
    above.set_ylabel("y (m)")
    below.set_xlabel("time (s)")
    below.set_ylabel("x (m)")
    below.set_xlim(0.0, LONGEST[case])
    for axes in (above, below):
        frame(axes)


def _oscillation(study: LawsStudy) -> Figure:
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle

    figure = Figure(figsize=(9.0, 9.6), layout="constrained")
    panels = figure.subplots(len(FORCES), 2, sharex="col", gridspec_kw={"width_ratios": (1.0, 1.5)})
    for (left, right), (name, entry) in zip(panels, FORCES.items(), strict=True):
        shown = study.demonstrations[name]
        run = shown.beside
        (x, y) = run.obstacle_position[0, 0]
        left.add_patch(Circle((x, y), 0.1, facecolor=DISC_COLOR, zorder=3))
        left.add_patch(Circle((x, y), 0.8, fill=False, linestyle="--", color="#555555", zorder=2))
        left.plot(*run.position.T, color=entry.color, linewidth=1.4, zorder=4)
        left.set_xlim(1.2, 3.7)
        left.set_aspect("equal")
        left.set_ylim(-0.35, 2.05)
        left.set_ylabel("y (m)")
        magnitude = np.hypot(*run.force.T)
        right.step(run.time, magnitude, where="post", color=entry.color, linewidth=1.0)
        right.set_xlim(0.0, OSCILLATION_TIME)
        right.set_ylim(0.0, None)
        right.set_ylabel("force (N)")
        words = f"{entry.label}: jump {shown.jump:.1f} N, edge crossed {shown.crossings} times"
        right.set_title(f"{words}, T {run.arrival_time:.1f} s", fontsize=10, loc="left")
        for axes in (left, right):
            frame(axes)
    panels[-1, 0].set_xlabel("x (m)")
    panels[-1, 1].set_xlabel("time (s)")
    return figure
