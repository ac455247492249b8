"""Pictures of sensing draw what they are given; the camera of the source is reproduced."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from hrsafety import InvalidParameterError, ShapeError, plotting, reproduce
from hrsafety import navigation as nav
from hrsafety.reproduce.built import camera_figures, camera_tables

TIME = np.arange(201) * 0.01
PATH = np.column_stack([TIME, 0.2 * TIME])
VELOCITY = np.tile([1.0, 0.2], (len(TIME), 1))


@pytest.fixture(scope="module")
def study() -> nav.sensing.CalibrationStudy:
    return nav.sensing.calibration_study(seeds=3)


def test_errors_are_drawn_in_millimeters_at_each_height(study: nav.sensing.CalibrationStudy) -> None:
    figure = plotting.robots.calibration_errors(study, title="errors")
    picture, low, high, bar = figure.axes
    assert bar.get_ylabel() == "mean error (mm)"
    for axes, height in ((low, 0.3), (high, 1.4)):
        own = study.places[:, 2] == height
        drawn = axes.collections[0]
        assert np.array_equal(drawn.get_offsets(), study.places[own, :2])
        assert np.asarray(drawn.get_array()) == pytest.approx(1e3 * study.place_error.mean(axis=0)[own])
        assert f"{height:g} m" in axes.get_title(loc="left")
    assert picture.yaxis_inverted()
    assert len(picture.lines[0].get_xdata()) == 20
    assert len(picture.lines[1].get_xdata()) == 6


def test_errors_need_places() -> None:
    empty = nav.sensing.calibration_study(seeds=1, places=np.empty((0, 3)))
    with pytest.raises(InvalidParameterError, match="places"):
        plotting.robots.calibration_errors(empty)


def test_velocities_are_drawn_beside_the_true_ones() -> None:
    seen = [
        nav.sensing.observe(nav.sensing.Vision(estimator=each), TIME, PATH)
        for each in (nav.sensing.Differences(), nav.sensing.Kalman())
    ]
    figure = plotting.robots.velocity_estimates(TIME, VELOCITY, seen, labels=["plain", "filter"])
    for component, axes in enumerate(figure.axes):
        true, *lines = axes.get_lines()
        assert np.array_equal(true.get_ydata(), VELOCITY[:, component])
        for line, each in zip(lines, seen, strict=True):
            assert np.array_equal(line.get_ydata(), each.velocity[:, component], equal_nan=True)
    assert [line.get_label() for line in figure.axes[0].get_lines()] == ["true", "plain", "filter"]
    assert len(plotting.robots.velocity_estimates(TIME, VELOCITY, seen[0]).axes) == 2


def test_wrong_input_of_velocities_is_refused() -> None:
    seen = nav.sensing.observe(nav.sensing.Vision(), TIME, PATH)
    with pytest.raises(InvalidParameterError, match="observations"):
        plotting.robots.velocity_estimates(TIME, VELOCITY, [])
    with pytest.raises(InvalidParameterError, match="labels"):
        plotting.robots.velocity_estimates(TIME, VELOCITY, seen, labels=["one", "two"])
    with pytest.raises(ShapeError, match="velocity"):
        plotting.robots.velocity_estimates(TIME, VELOCITY[:-1], seen)
    with pytest.raises(ShapeError, match="observations"):
        plotting.robots.velocity_estimates(TIME[:-1], VELOCITY[:-1], seen)


def test_camera_of_the_source_is_recovered_and_its_errors_stand_beside() -> None:
    cells = camera_tables.cells()
    judged = [cell for cell in cells if cell.within is not None]
    assert len(judged) == 9
    assert all(cell.within for cell in judged)
    errors = {(cell.row, cell.column): cell for cell in cells if cell.within is None}
    assert len(errors) == 8
    assert all(cell.printed in (4.0, 25.0) and cell.reason for cell in errors.values())
    half = errors["Noise of 0.5 pixel", "mean error at the points"]
    assert half.measured == pytest.approx(1e3 * camera_tables.study(0.5).point_error.mean())


def test_printed_figures_of_the_camera_are_its_defaults() -> None:
    rows = {row["figure"]: row for row in reproduce.published_tables()["zeng2011:section D.4"]["rows"]}
    camera = nav.sensing.Camera()
    assert rows["focal_length"]["value"] == pytest.approx(1e3 * camera.focal_length)
    assert rows["radial_distortion"]["value"] == pytest.approx(1e-6 * camera.radial_distortion)
    printed = np.array([[rows[f"rotation_{i}{j}"]["value"] for j in (1, 2, 3)] for i in (1, 2, 3)])
    assert nav.sensing.nearest_rotation(printed) == pytest.approx(np.array(camera.rotation), abs=1e-15)
    assert all(row["unit"] for row in rows.values())
    assert rows["points"]["value"] == len(nav.sensing.calibration_points())


def test_page_of_the_camera_is_made(tmp_path: Path) -> None:
    page = reproduce.run(tmp_path, only="camera").read_text(encoding="utf-8")
    assert 'id="camera"' in page
    made = {picture.name for picture in camera_figures.make()}
    assert made == {path.stem for path in (tmp_path / "figures").glob("*.png")}
    values = json.loads((tmp_path / "tables.json").read_text(encoding="utf-8"))
    assert {value["table"] for value in values} == {"Section D.4"}
