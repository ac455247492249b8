"""Section D.4: the camera recovered from points, and the errors of positions that it measures."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

from hrsafety import navigation as nav
from hrsafety.reproduce.cells import Cell, Tolerance
from hrsafety.reproduce.impact_cells import claim, listed, number
from hrsafety.reproduce.published import printed_figure

__all__ = ["NOISES", "cells", "study"]

NOISES = (0.3, 0.5)
"""Standard deviations of a centroid coordinate in pixels."""
SEEDS = 200
TABLE = "Section D.4"
RECOVERED = Tolerance(1e-9, relative=True)
MILLI = 1e-3
ROUNDED = "Six digits are printed; the nearest rotation differs by {:.1e} and is used here."
SYNTHETIC = (
    "Neither points nor pixels are printed. 26 points of a grid over the workspace and above it, shown by the printed "
    "camera; picture and pixel size (1024 x 768, 4.65 um) are chosen."
)
ONE_CALIBRATION = (
    "Printed for one calibration from real pixels, whose noise is not stated; here {seeds} calibrations with Gaussian "
    "noise of {noise} pixel."
)
AT_MOST = (
    ONE_CALIBRATION + " Largest of all; the mean of their maxima is {mean:.1f} mm. A maximum of six times the mean, as "
    "printed, needs more than Gaussian noise: a marker that was badly placed or found."
)
NEW_PLACES = (
    "Printed for the calibration points; here patches at 0.3 and 1.4 m over the workspace, with centroids as noisy as "
    "the pixels of the calibration. The calibration alone is off by {bias:.1f} mm in the mean."
)


@cache
def study(noise: float) -> nav.sensing.CalibrationStudy:
    """Return calibrations of the printed camera with noise."""
    return nav.sensing.calibration_study(pixel_deviation_px=noise, seeds=SEEDS)


def cells() -> list[Cell]:
    """Return the cells of section D.4."""
    return [*_camera(), *_errors()]


def _figure(name: str) -> float:
    return printed_figure("D.4", name)


def _camera() -> Iterator[Cell]:
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
        yield number(
            TABLE,
            "Recovered from 26 exact points",
            column,
            printed=_figure(name),
            measured=measured,
            tolerance=RECOVERED,
            unit=unit,
            reason=SYNTHETIC if name == "focal_length" else "",
        )
    printed = np.array([[_figure(f"rotation_{row}{column}") for column in (1, 2, 3)] for row in (1, 2, 3)])
    off = float(np.abs(printed @ printed.T - np.eye(3)).max())
    moved = float(np.abs(np.array(found.rotation) - printed).max())
    yield claim(
        TABLE,
        "Recovered from 26 exact points",
        "R_cam",
        printed="a rotation matrix",
        measured=f"orthonormal to {off:.0e}",
        holds=off < 1e-6 and moved < 1e-6,
        reason=ROUNDED.format(moved),
    )


def _errors() -> Iterator[Cell]:
    for noise in NOISES:
        own = study(noise)
        words = {"seeds": SEEDS, "noise": noise, "mean": own.point_error.max(axis=1).mean() / MILLI}
        biased = NEW_PLACES.format(bias=own.place_bias.mean() / MILLI)
        for column, figure, value, reason in (
            ("mean error at the points", "mean_error", own.point_error.mean(), ONE_CALIBRATION.format(**words)),
            ("maximum error at the points", "max_error", own.point_error.max(), AT_MOST.format(**words)),
            ("mean error elsewhere", "mean_error", own.place_error.mean(), biased),
            ("maximum error elsewhere", "max_error", own.place_error.max(), "Largest of all patches and calibrations."),
        ):
            yield listed(
                TABLE,
                f"Noise of {noise} pixel",
                column,
                printed=_figure(figure) / MILLI,
                measured=float(value) / MILLI,
                unit="mm",
                reason=reason,
            )
