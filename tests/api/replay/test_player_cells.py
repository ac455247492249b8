"""Cells that a robot keeps, in a player: those of the run at every frame, never freer than they are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from api.browsers import tab
from api.replay.test_player import decoded, head_of, page_of
from hrsafety import _replay as replay
from hrsafety import navigation as nav
from hrsafety import plotting
from hrsafety._replay import cells as packing
from hrsafety.errors import InvalidParameterError

WALLS = nav.StaticMap.from_polylines([[(1.5, -1.0), (1.5, 1.0)]], radius=0.03)
SCENE = nav.Scenario(robot=nav.DifferentialDriveRobot(), start=(0, 0), goal=(2.4, 0), walls=WALLS)
BUILT = nav.robots.AsBuilt(sensors=[nav.Lidar(map=WALLS)])
CORRIDOR = nav.StaticMap.from_polylines([[(0, 0), (4, 0), (4, 3), (2.6, 3), (2.6, 1.4), (0, 1.4), (0, 0)]], radius=0.05)
SEEN_FROM = nav.Scenario(start=(0.6, 0.7), goal=(3.3, 2.6), control_period=0.1, time_limit=2.5)


def driving() -> nav.Run:
    return nav.Run(SCENE, nav.ArcRollouts(map=nav.UnknownMap(reach=3.0)), BUILT)


def reckoning() -> nav.Run:
    unseen = nav.Unseen(person_radius=0.3, beams=360)
    law = nav.SafeNavigation(nav.VirtualForceField(), map=CORRIDOR, guide=nav.Guide(), shield=nav.Shield(unseen=unseen))
    return nav.Run(SEEN_FROM, law)


class Shown:
    """The cells of a robot in a page, frame by frame."""

    def __init__(self, page: str, robot: int = 0) -> None:
        head = head_of(page)
        self.grid = head["robots"][robot]["cells"]["grid"]
        self.begin = head["robots"][robot]["cells"]["begin"]
        self.time = head["start"] + head["tick"] * np.cumsum(decoded(page, "time"))
        self.changes = decoded(page, f"cells{robot}")
        self.frame = np.cumsum(self.changes[:, 0])

    def at(self, frame: int) -> np.ndarray[Any, Any]:
        return after(self.changes[self.frame <= frame], *self.grid[:2])

    def kind(self, frame: int, places: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        """Return the kinds of the cells around places: 0 outside of the grid."""
        rows, columns, side, x, y, _ = self.grid
        column, row = np.floor((places - (x, y)) / side).astype(int).T
        inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
        return np.where(inside, self.at(frame)[np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)], 0)


def after(changes: np.ndarray[Any, Any], rows: int, columns: int) -> np.ndarray[Any, Any]:
    cells = np.zeros((rows, columns), dtype=np.uint8)
    for _, row, first, length, kind in changes.tolist():
        assert first + length <= columns
        cells[row, first : first + length] = kind
    return cells


def test_the_map_is_that_of_the_run_at_every_frame() -> None:
    shown, run, compared = Shown(plotting.player(driving())), driving(), 0
    while not run.finished:
        run.step()
        cells = run.known_cells()
        assert cells is not None
        frame = int(np.argmin(np.abs(shown.time - run.time)))
        if abs(shown.time[frame] - run.time) < 1e-3:
            row, column = np.indices(cells.kinds.shape)
            centers = cells.low + cells.cell * (np.stack([column, row], axis=-1).reshape(-1, 2) + 0.5)
            assert (shown.kind(frame, centers) == cells.kinds.ravel()).all()
            assert (shown.at(frame) > 0).sum() == (cells.kinds > 0).sum()
            compared += 1
    assert compared > 20
    assert not shown.at(0).any()  # before its first scan it knows nothing
    assert set(np.unique(shown.at(len(shown.time) - 1))) == {0, 1, 2}


def test_the_belief_is_that_of_the_run() -> None:
    page, run, compared = plotting.player(reckoning()), reckoning(), 0
    shown = Shown(page)
    assert head_of(page)["robots"][0]["cells"]["belief"]
    while not run.finished:
        places = run.unseen_places()
        frame = int(np.argmin(np.abs(shown.time - run.time)))
        if abs(shown.time[frame] - run.time) < 1e-3:
            assert (shown.kind(frame, places) == 3).all()
            assert (shown.at(frame) == 3).sum() == len(places)
            compared += 1
        run.step()
    assert compared > 10


def test_nothing_is_shown_where_nothing_was_recorded() -> None:
    def plain() -> nav.Run:
        return nav.Run(SCENE, nav.VirtualForceField(), BUILT)

    run = plain()
    page = plotting.player(run)
    assert (
        page == plotting.player(run.trajectory) == plotting.player(nav.simulate(SCENE, run.trajectory.law, built=BUILT))
    )
    assert "cells" not in head_of(page)["robots"][0]
    with pytest.raises(InvalidParameterError, match="under way"):
        plotting.player(run)
    started = driving()
    while started.time < 0.5:
        started.step()
    begun = started.time
    shown = Shown(plotting.player(started))
    assert shown.time[shown.begin - 1] < begun - 1e-3 < shown.time[shown.begin]
    assert shown.frame[0] == shown.begin
    assert 'id="block-cells0"' not in plotting.player(started.trajectory)
    blind = nav.Run(SCENE, nav.ArcRollouts(), nav.robots.AsBuilt(sensors=[nav.Lidar(map=WALLS, dropout=1.0)]))
    assert not Shown(plotting.player(blind)).at(10).any()  # a map in which nothing was seen, which is no free floor


def test_each_robot_of_a_world_has_its_own() -> None:
    robots = [
        nav.Robot(start=(0, -2), goal=(2.4, -2), law=nav.VirtualForceField()),
        nav.Robot(start=(0, 0), goal=(2.4, 0), body=SCENE.robot, law=nav.ArcRollouts(), sensors=[nav.Lidar()]),
    ]
    page = plotting.player(nav.Run(nav.World(robots=robots, walls=WALLS, time_limit=1.0)))
    assert [each.get("cells", {}).get("belief") for each in head_of(page)["robots"]] == [None, False]
    assert (Shown(page, 1).at(10) == 2).any()


def drifting(seed: int, instants: int) -> tuple[replay.PlayedCells, list[np.ndarray[Any, Any]]]:
    """Return windows of cells that move, and the cells of each on a floor that holds them."""
    draw = np.random.default_rng(seed)
    low, size = draw.integers(0, 12, (instants, 2)), draw.integers(0, 9, (instants, 2))
    size[-1] = 3
    kinds = [draw.integers(0, 4, shape).astype(np.uint8) for shape in size.tolist()]
    floors = []
    for (column, row), each in zip(low.tolist(), kinds, strict=True):
        floor = np.zeros((24, 24), dtype=np.uint8)
        floor[row : row + each.shape[0], column : column + each.shape[1]] = each
        floors.append(floor)
    time = np.arange(instants, dtype=float)
    return replay.PlayedCells(time, 0.1, 0.1 * low - 3.0, size, kinds.__getitem__), floors


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 6), st.sampled_from([1, 2, 4]))
def test_any_cells_survive_packing_and_coarse_ones_are_never_freer(seed: int, instants: int, many: int) -> None:
    cells, floors = drifting(seed, instants)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(packing, "MOST_CELLS", 24**2 / many**2 if many > 1 else 10**6)
        found = packing.cells_of("cells", cells, cells.time)
    assert found is not None
    (rows, columns, side, x, y, _), packed = found[0]["grid"], found[1]
    ratio = round(side / 0.1)
    sizes = f'data-rows="{packed.shape[0]}" data-columns="{packed.shape[1]}"'
    changes = decoded(f'id="block-cells" data-kind="u16" {sizes}>{packed.text}<', "cells")
    first = np.round((np.array([y, x]) + 3.0) / 0.1).astype(int)
    for frame, floor in enumerate(floors):
        shown = after(changes[np.cumsum(changes[:, 0]) <= frame], rows, columns)
        held = np.zeros((rows * ratio, columns * ratio), dtype=np.uint8)
        part = floor[first[0] :, first[1] :][: held.shape[0], : held.shape[1]]
        held[: part.shape[0], : part.shape[1]] = part
        parts = held.reshape(rows, ratio, columns, ratio)
        assert held.sum() == floor.sum()
        assert ((shown == 1) == (parts == 1).all(axis=(1, 3))).all()
        assert ((shown == 3) == (parts == 3).any(axis=(1, 3))).all()
        if ratio == 1:
            assert (shown == held).all()


def test_cells_are_coarser_where_they_would_be_too_large_and_the_page_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = driving()._replay()
    fine = plotting.player(shown)
    assert len(fine) - len(plotting.player(driving().trajectory)) < 60_000
    assert "<dt>cells that are known from scans, robot</dt><dd>0.05 m</dd>" in fine
    monkeypatch.setattr(packing, "MOST_LETTERS", 2_000)
    page = plotting.player(shown)
    side = head_of(page)["robots"][0]["cells"]["grid"][2]
    assert side > 0.05
    assert f"<dd>{side:g} m, the worst of {side / 0.05:.0f} by {side / 0.05:.0f} cells of the robot</dd>" in page
    text = page.partition('id="block-cells0"')[2].partition(">")[2].partition("<")[0]
    assert len(text) <= 2_000


@pytest.mark.parametrize("width", [420, 1300])
def test_the_floor_has_the_colors_of_the_cells_and_a_key_hides_them(tmp_path: Path, width: int) -> None:
    address = page_of(driving(), tmp_path)
    page = (tmp_path / "run.html").read_text(encoding="utf-8")
    shown, (left, low, right, top) = Shown(page), head_of(page)["view"]
    frame = int(np.searchsorted(shown.time, 1.0))
    _, _, side, x, y, _ = shown.grid
    with tab(width, 900) as browser:
        browser.open(f"{address}#t={shown.time[frame]:.2f}")
        assert browser.value("document.documentElement.scrollWidth") <= width
        wide, high = browser.value("[floor.clientWidth, floor.clientHeight]")
        scale = min(wide / (right - left), high / (top - low))

        def colors(kind: int) -> np.ndarray[Any, Any]:
            """Return the colors of the floor in the middles of cells of a kind, away from the way of the robot."""
            row, column = np.nonzero(shown.at(frame) == kind)
            places = np.stack([column, row], axis=1) * side + (x + 0.5 * side, y + 0.5 * side)
            inside = (places > (left + 0.3, low + 0.3)).all(axis=1) & (places < (right - 0.3, top - 0.3)).all(axis=1)
            places = places[inside & (np.abs(places[:, 1]) > 0.5)][::7]
            pixels = np.round(
                [wide / 2, high / 2] + (places - [(left + right) / 2, (low + top) / 2]) * [scale, -scale]
            ).astype(int)
            read = f"""(() => {{ const ink = floor.getContext('2d');
                return {pixels.tolist()}.map(([x, y]) => [...ink.getImageData(x, y, 1, 1).data].slice(0, 3)); }})()"""
            return np.array(browser.value(read))

        free, unknown = colors(1), colors(0)
        assert (free == 255).all(axis=1).mean() > 0.8  # lines of the floor lie over it
        assert (unknown == 255).all(axis=1).mean() < 0.05
        before = browser.value("floor.toDataURL()")
        browser.press("m")
        browser.wait(f"floor.toDataURL() !== {before!r}")
        assert browser.value("document.getElementById('known').getAttribute('aria-pressed')") == "false"
        assert (colors(0) == 255).all(axis=1).mean() > 0.8
        browser.press("m")
        browser.wait(f"floor.toDataURL() === {before!r}")
        browser.press("End")
        browser.value(f"location.hash = '#t={shown.time[frame]:.2f}'; 1")
        browser.wait(f"floor.toDataURL() === {before!r}")  # the way back
        assert browser.errors == []
