"""Maps in pictures of runs and plans."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.collections import LineCollection, PatchCollection

from hrsafety import navigation as nav
from hrsafety import plotting
from hrsafety.errors import HrsafetyError, InvalidParameterError

WALLS = nav.StaticMap.from_polylines([[(-1.0, -0.7), (5.0, -0.7)]])
THICK = nav.StaticMap.from_polylines([[(2.0, 0.8), (3.0, 0.8)]], radius=0.1)
SOLID = nav.StaticMap.from_polygons([[(1.0, 1.0), (1.5, 1.0), (1.25, 1.5)]]) + nav.StaticMap(discs=[(4.0, 1.2, 0.2)])
CELLS = nav.StaticMap.from_grid([[1, 0], [1, 1]], resolution=0.2, origin=(0.0, 1.0), yaw=0.3)


def run_by_lidar() -> nav.Trajectory:
    """Return a run whose robot knows walls by its lidar alone."""
    scenario = nav.Scenario(robot=nav.HolonomicRobot(), start=(0.0, 0.0), goal=(4.0, 0.0), obstacles=[])
    built = nav.robots.AsBuilt(sensors=[nav.Lidar(map=WALLS + THICK + SOLID + CELLS)])
    return nav.simulate(scenario, nav.VirtualForceField(), built=built)


def drawn(axes: Any) -> tuple[int, int, int]:
    """Return how many patches, lines and grids of a map stand on axes."""
    patches = sum(len(each.get_paths()) for each in axes.collections if isinstance(each, PatchCollection))
    lines = sum(len(each.get_segments()) for each in axes.collections if isinstance(each, LineCollection))
    return patches, lines, len(axes.images)


@pytest.mark.parametrize("picture", [plotting.paths, plotting.time_sequence], ids=["paths", "time_sequence"])
def test_the_map_of_a_lidar_stands_in_pictures_of_its_run(picture: Any) -> None:
    figure = picture(run_by_lidar())
    for axes in figure.axes:
        assert drawn(axes) == (3, 1, 1)
        # All of the map is in view, in equal scales.
        assert axes.get_xlim()[0] < -1.0
        assert axes.get_ylim()[0] < -0.7
    words = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert "map" in words


def test_cells_are_drawn_where_they_are() -> None:
    axes = plotting.paths(run_by_lidar()).axes[0]
    (image,) = axes.images
    (grid,) = CELLS.grids
    turned = image.get_transform() - axes.transData
    for row, column in np.argwhere(grid.occupied):
        middle = turned.transform((np.array([column, row]) + 0.5) * grid.resolution)
        assert CELLS.clearance(middle) == 0.0
    free = turned.transform((0.3, 0.1))
    assert CELLS.clearance(free) == pytest.approx(0.1)


def test_a_run_without_a_map_has_none_in_its_picture() -> None:
    scenario = nav.Scenario(robot=nav.HolonomicRobot(), start=(0.0, 0.0), goal=(4.0, 0.0), obstacles=[])
    figure = plotting.paths(nav.simulate(scenario, nav.VirtualForceField()))
    assert drawn(figure.axes[0]) == (0, 0, 0)


def test_a_plan_is_drawn_with_costs_paths_and_local_goals() -> None:
    trap = nav.StaticMap.from_polylines([[(1, 1.5), (3, 1.5), (3, -1.5), (1, -1.5)]])
    plan = nav.Guide().plan(trap, radius=0.2, start=(0, 0), goal=(5, 0))
    figure = plotting.runs.guide_plan(trap, plan, starts=[(2.6, 0.5), (0.0, 0.0)], title="Out of a trap")
    axes, scale = figure.axes
    assert scale.get_ylabel() == "cost to the goal (m)"
    longest = max((line.get_xydata() for line in axes.lines), key=len)
    assert tuple(longest[-1]) == plan.goal
    with pytest.raises(HrsafetyError, match=r"starts\[0\] must be a place with a plan"):
        plotting.runs.guide_plan(trap, plan, starts=[(3.0, 0.0)])
    with pytest.raises(HrsafetyError, match="plan must be a Plan"):
        plotting.runs.guide_plan(trap, trap)  # type: ignore[arg-type]  # what is tested


def test_what_a_robot_has_seen_is_drawn_and_animated(tmp_path: Path) -> None:
    walls = nav.StaticMap.from_polylines([[(1.5, -1.0), (1.5, 1.0)]], radius=0.03)
    scene = nav.Scenario(robot=nav.DifferentialDriveRobot(), start=(0, 0), goal=(2.4, 0), walls=walls)
    built = nav.robots.AsBuilt(sensors=[nav.Lidar(map=walls)])
    run = nav.Run(scene, nav.ArcRollouts(), built)
    with pytest.raises(InvalidParameterError, match="seen something"):
        plotting.runs.known_cells(run)
    run.step()
    (shown,) = plotting.runs.known_cells(run).axes[0].images
    occupied = (shown.get_array() == [47, 59, 74]).all(axis=2)
    cells = run.known_cells()
    assert cells is not None
    assert (occupied == (cells.kinds == 2)).all()
    file = plotting.runs.animate_known_cells(run, tmp_path / "map.gif", frames_per_second=2)
    assert file.stat().st_size > 1000
    assert run.outcome == "arrived"
    with pytest.raises(InvalidParameterError, match="under way"):
        plotting.runs.animate_known_cells(run, tmp_path / "more.gif")
    other = nav.Run(scene, nav.VirtualForceField(), built)
    other.step()
    with pytest.raises(InvalidParameterError, match="own map"):
        plotting.runs.known_cells(other)
