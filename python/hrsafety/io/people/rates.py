"""How many frames a second has: what the file, the caller, the format or stored velocities say."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety.errors import Shown
from hrsafety.io.people.request import Request
from hrsafety.io.people.rows import Rows
from hrsafety.io.reader import Document
from hrsafety.plausibility import ResultWarning

__all__ = ["common_step", "frame_rate", "rate_of_velocities"]

Array = npt.NDArray[np.float64]

SAME_RATE = 0.002
"""Rates that differ by less, as a share, are the same: 30 and 29.97."""
CONTRADICTION = 0.05
MOST_SPREAD = 0.1
"""Stored velocities whose 10 and 90 % quantiles are further apart, as a share of the median, tell no rate."""
LEAST_SPEED = 0.2
NEED = "come with fps=, the frames per second, or step_s=, the time between rows of a person in s"


def _steps(rows: Rows) -> tuple[npt.NDArray[np.intp], Array, npt.NDArray[np.bool_]]:
    """Return the order by person and clock, the steps of the clock, and which are of one person."""
    order = np.argsort(rows.person, kind="stable")
    steps = np.diff(rows.clock[order])
    return order, steps, rows.person[order][1:] == rows.person[order][:-1]


def common_step(rows: Rows) -> float | None:
    """Return the median step of the clock between rows of a person, if anybody has two."""
    _, steps, same = _steps(rows)
    return float(np.median(steps[same])) if same.any() else None


def rate_of_velocities(rows: Rows) -> tuple[float, float] | None:
    """Return the frames per second that stored velocities tell, and the spread of what single rows say as a share.

    The median over consecutive triples of a person of ``|v_k| (f_{k+1} - f_{k-1})/|x_{k+1} - x_{k-1}|``.
    """
    if rows.velocity is None or len(rows.clock) < 3:
        return None
    order, _, same = _steps(rows)
    triple = np.flatnonzero(same[1:] & same[:-1]) + 1
    if len(triple) == 0:
        return None
    clock, place = rows.clock[order], rows.position[order]
    speed = np.hypot(*rows.velocity[order][triple].T)
    way = np.hypot(*(place[triple + 1] - place[triple - 1]).T)
    some = (speed > LEAST_SPEED) & (way > 0.0) & np.isfinite(speed)
    if not some.any():
        return None
    with np.errstate(over="ignore", invalid="ignore"):
        rates = (speed * (clock[triple + 1] - clock[triple - 1]))[some] / way[some]
        low, median, high = np.quantile(rates, (0.1, 0.5, 0.9)).tolist()
    if not np.isfinite(median) or median <= 0.0:
        return None
    near = min((round(median), round(median * 1.001) / 1.001), key=lambda each: abs(each - median))
    if near > 0 and abs(near / median - 1.0) <= SAME_RATE:
        median = float(near)
    return median, (high - low) / median


def frame_rate(document: Document, rows: Rows, request: Request) -> tuple[float, str, list[ResultWarning]]:
    """Return the frames per second, who says so, and what was assumed.

    Raises
    ------
    FileError
        If it is not given (``frame_rate_needed``), or the caller contradicts the file (``frame_rate_contradicts_file``)
        or its velocities (``frame_rate_contradicts_velocity``).
    """
    given = _given(document, rows, request)
    if rows.rate is not None:
        if given is not None and abs(given / rows.rate - 1.0) > SAME_RATE:
            rule = f"agree with the caller, who says {given:.10g} frames per second"
            found = Shown(f"{rows.rate:.10g} in the file")
            raise document.error("frame_rate_contradicts_file", rule, found, "leave out fps and step_s")
        return rows.rate, "file", []
    told = rate_of_velocities(rows)
    certain = told is not None and told[1] <= MOST_SPREAD
    if given is not None:
        if told is not None and certain and abs(given / told[0] - 1.0) > CONTRADICTION:
            rule = f"agree with the caller, who says {given:.10g} frames per second"
            found = Shown(f"velocities that fit {told[0]:.6g}")
            raise document.error("frame_rate_contradicts_velocity", rule, found, "leave out fps and step_s")
        return given, "argument", []
    if rows.rate_of_format is not None:
        return rows.rate_of_format, "format", [_assumed(document, rows.rate_of_format, f"as all {rows.format} files")]
    if told is not None and certain and rows.rate_from_velocity:
        return told[0], "stored velocities", [_assumed(document, told[0], "by which its velocities fit its positions")]
    raise document.error("frame_rate_needed", NEED, Shown("frames without a rate"), _proposal(rows, told, certain))


def _given(document: Document, rows: Rows, request: Request) -> float | None:
    if request.step_s is None:
        return request.fps
    step = common_step(rows)
    if step is None:
        raise document.error(
            "frame_rate_needed", "have somebody with two rows for step_s", Shown("nobody"), "give fps="
        )
    return step / request.step_s


def _assumed(document: Document, rate: float, why: str) -> ResultWarning:
    message = f"{document.name} does not tell its frame rate: {rate:.8g} frames per second, {why}; fps= confirms it"
    return ResultWarning("assumed", "frame_rate", message)


def _proposal(rows: Rows, told: Any, certain: bool) -> str | None:
    """Return what may be the rate."""
    if told is not None and certain:
        return f"fps={told[0]:.6g} fits the stored velocities"
    if rows.format == "trajnet":
        return "usual is step_s=0.4"
    return None
