"""Section D.4: the camera recovered from points, and the errors of positions that it measures."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

from hrsafety import navigation as nav
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.published import printed_figure
from hrsafety.reproduce.sheets import Sheet

__all__ = ["NOISES", "cells", "study"]

NOISES = (0.3, 0.5)
"""Standard deviations of a centroid coordinate in pixels."""
SEEDS = 200
SHEET = Sheet("built")
MILLI = 1e-3


@cache
def study(noise: float) -> nav.sensing.CalibrationStudy:
    """Return calibrations of the printed camera with noise."""
    return nav.sensing.calibration_study(pixel_deviation_px=noise, seeds=SEEDS)


def cells() -> list[PrintedValue]:
    """Return the cells of section D.4."""
    return [*_camera(), *_errors()]


def _figure(name: str) -> float:
    return printed_figure("D.4", name)


def _camera() -> Iterator[PrintedValue]:
    points = nav.sensing.calibration_points()
    found = nav.sensing.calibrate_camera(points, nav.sensing.Camera().project(points)).camera
    t_x, t_y, t_z = found.translation
    center_x, center_y = found.image_center_px
    for name, column, measured, unit in (
        ("focal_length", "f_cam", found.focal_length / MILLI, "mm"),
        ("radial_distortion", "k_rad", found.radial_distortion * MILLI**2, "1/mm^2"),
        ("horizontal_scale", "S_cam", found.horizontal_scale, "1"),
        ("center_x", "C_x", center_x, "pixel"),
        ("center_y", "C_y", center_y, "pixel"),
        ("translation_x", "T_x", t_x / MILLI, "mm"),
        ("translation_y", "T_y", t_y / MILLI, "mm"),
        ("translation_z", "T_z", t_z / MILLI, "mm"),
    ):
        why = SHEET.text("synthetic") if name == "focal_length" else ""
        yield SHEET.number("camera", measured, figure=name, column=column, unit=unit, why=why)
    printed = np.array([[_figure(f"rotation_{row}{column}") for column in (1, 2, 3)] for row in (1, 2, 3)])
    off = float(np.abs(printed @ printed.T - np.eye(3)).max())
    moved = float(np.abs(np.array(found.rotation) - printed).max())
    yield SHEET.claim("rotation", holds=off < 1e-6 and moved < 1e-6, off=off, moved=moved)


def _errors() -> Iterator[PrintedValue]:
    for noise in NOISES:
        own = study(noise)
        words = {"seeds": SEEDS, "noise": noise, "mean": own.point_error.max(axis=1).mean() / MILLI}
        words["bias"] = own.place_bias.mean() / MILLI
        for column, figure, value, reason in (
            ("mean error at the points", "mean_error", own.point_error.mean(), "one_calibration"),
            ("maximum error at the points", "max_error", own.point_error.max(), "at_most"),
            ("mean error elsewhere", "mean_error", own.place_error.mean(), "new_places"),
            ("maximum error elsewhere", "max_error", own.place_error.max(), "largest"),
        ):
            printed, why = _figure(figure) / MILLI, SHEET.text(reason, **words)
            yield SHEET.listed("error", float(value) / MILLI, printed=printed, noise=noise, column=column, why=why)
