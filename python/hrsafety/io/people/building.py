"""The recording that rows of a file make: units and clock known, sorted, each row once."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._tracks import plausible_unit
from hrsafety.datasets.recording import Recording
from hrsafety.datasets.row_checks import FARTHEST, LONGEST
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.io.headers import LENGTHS
from hrsafety.io.people.rates import frame_rate
from hrsafety.io.people.request import Request
from hrsafety.io.people.rows import Rows, assumed
from hrsafety.io.reader import Document
from hrsafety.plausibility import ResultWarning

__all__ = ["recording_of"]

Array = npt.NDArray[np.float64]

UNIT_DOUBTS = {"implausible", "teleport", "identity_switch", "gap_in_track", "noisy_positions"}
"""Doubts that a file without a unit must pass."""


def _line(rows: Rows, row: int) -> int | None:
    return None if rows.lines is None else int(rows.lines[row])


def recording_of(document: Document, rows: Rows, request: Request) -> Recording:
    """Return the recording of the rows of a file, see `_recording_of`; numbers that overflow are out of range."""
    with np.errstate(over="ignore", invalid="ignore"):
        return _recording_of(document, rows, request)


def _recording_of(document: Document, rows: Rows, request: Request) -> Recording:
    """Return the recording of the rows of a file: units and clock known, sorted, equal rows once.

    Raises
    ------
    FileError
        If the file does not say what is needed, or contradicts itself or the caller.
    """
    notes, details = [*document.warnings, *rows.notes], dict(rows.details)
    rows, notes = _without_missing(document, rows, notes, details)
    if len(rows.clock) == 0:
        raise document.error("no_rows", "hold at least one row of a person", Shown("none"))
    rows, repeated = _sorted(document, rows)
    if repeated:
        told = f"{repeated} {'rows are' if repeated > 1 else 'row is'} there twice and counted once"
        notes.append(ResultWarning("repeated_rows", "person", f"{document.name}: {told}", safe_side=True))
        details["repeated_rows"] = details.get("repeated_rows", 0) + repeated
    rate, rate_from = None, None
    if rows.frames:
        rate, rate_from, told_rate = frame_rate(document, rows, request)
        notes += told_rate
        time = (rows.clock - rows.clock[0]) / rate
        origin = float(rows.clock[0]) / rate
    else:
        rate, rate_from = rows.rate, "file" if rows.rate is not None else None
        time, origin = rows.clock - rows.clock[0], float(rows.clock[0])
    position, velocity, scale, guessed = _in_meters(document, rows, request, time)
    _check_range(document, rows, time, position)
    if guessed:
        details["unit"] = "m"
    elif rows.unit in LENGTHS and scale is not None:
        details.setdefault("unit", rows.unit)
    try:
        made = Recording(
            time_s=time,
            person=rows.person,
            position=position,
            velocity=velocity,
            walls=rows.walls,
            robot=rows.robot,
            frame_rate=rate,
            frame_rate_from=rate_from,
            time_origin=origin,
            source=request.source(document, rows.format),
            details=details,
            notes=tuple(notes),
        )
    except InvalidParameterError as error:
        row = re.search(r"\[(\d+)\]$", error.argument)
        line = _line(rows, int(row[1])) if row else None
        raise document.error("unreadable_number", error.requirement, error.value, error.remedy, line=line) from None
    if not guessed:
        return made
    doubt = next((each for each in made.warnings if each.code in UNIT_DOUBTS), None)
    if doubt is not None:
        raise unit_needed(document, made, doubt.message)
    note = assumed("unit", f"{document.name} names no unit of positions: meters, with which all speeds are plausible")
    return replace(made, notes=(*made.notes, note))


def _check_range(document: Document, rows: Rows, time: Array, position: Array) -> None:
    """Refuse places and times that are nowhere on the floor."""
    for values, most, rule in ((np.abs(position).max(axis=1), FARTHEST, "m away"), (np.abs(time), LONGEST, "s long")):
        far = np.flatnonzero(~(values <= most))
        if len(far):
            row = int(far[0])
            found = Shown(f"{values[row]:g} of person {rows.person[row]}")
            raise document.error("unreadable_number", f"be at most {most:g} {rule}", found, line=_line(rows, row))


def _without_missing(
    document: Document, rows: Rows, notes: list[ResultWarning], details: dict[str, Any]
) -> tuple[Rows, list[ResultWarning]]:
    """Return the rows that have a position, and say how many do not."""
    wrong = np.flatnonzero(~np.isfinite(rows.clock))
    if len(wrong):
        place = _line(rows, int(wrong[0]))
        raise document.error("unreadable_number", "have a time or frame in each row", Shown("none"), line=place)
    missing = np.isnan(rows.position[:, 0]) | np.isnan(rows.position[:, 1])
    if not missing.any():
        return rows, notes
    first = int(np.flatnonzero(missing)[0])
    where = f"line {_line(rows, first)}, " if rows.lines is not None else ""
    message = (
        f"{int(missing.sum())} rows of {document.name} have no position ({where}person {rows.person[first]}): the "
        "people are taken to go straight on in between, and are away before and after it"
    )
    details["unknown_rows"] = int(missing.sum())
    return _of(rows, ~missing), [*notes, ResultWarning("missing_positions", "position", message)]


def _of(rows: Rows, which: npt.NDArray[Any]) -> Rows:
    """Return some of the rows."""
    return replace(
        rows,
        clock=rows.clock[which],
        person=rows.person[which],
        position=rows.position[which],
        velocity=None if rows.velocity is None else rows.velocity[which],
        lines=None if rows.lines is None else rows.lines[which],
    )


def _order(rows: Rows) -> npt.NDArray[np.intp]:
    """Return the order by time, then by id; rows that are nearly in it are sorted faster by one key."""
    clock, person = rows.clock, rows.person
    if person.dtype.kind == "i" and (clock[1:] >= clock[:-1]).all():
        span = int(person.max()) - int(person.min()) + 1
        if span < 2**62 // len(clock):
            instant = np.concatenate([[0], np.cumsum(clock[1:] > clock[:-1])])
            return np.argsort(instant * span + (person - person.min()), kind="stable")
    return np.lexsort((person, clock))


def _sorted(document: Document, rows: Rows) -> tuple[Rows, int]:
    """Return the rows by time, then by id, each once, and how many were there twice."""
    same_time = rows.clock[1:] == rows.clock[:-1]
    later = (rows.clock[1:] > rows.clock[:-1]) | (same_time & (rows.person[1:] > rows.person[:-1]))
    if not later.all():
        rows = _of(rows, _order(rows))
        same_time = rows.clock[1:] == rows.clock[:-1]
    twice = np.flatnonzero(same_time & (rows.person[1:] == rows.person[:-1])) + 1
    if len(twice) == 0:
        return rows, 0
    apart = (rows.position[twice] != rows.position[twice - 1]).any(axis=1)
    if apart.any():
        row = int(twice[apart][0])
        lines = [_line(rows, each) for each in (row - 1, row)]
        known = [each for each in lines if each is not None]
        word = "frame" if rows.frames else "time"
        places = " and ".join(f"({x:.10g}, {y:.10g})" for x, y in rows.position[row - 1 : row + 1].tolist())
        found = Shown(f"person {rows.person[row]} at {places} in {word} {rows.clock[row]:.10g}")
        remedy = f"line {min(known)} has the other position" if known else None
        rule = "have one position of a person at one instant"
        raise document.error("two_positions_at_one_instant", rule, found, remedy, line=max(known, default=None))
    keep = np.ones(len(rows.clock), dtype=np.bool_)
    keep[twice] = False
    return _of(rows, keep), len(twice)


def _in_meters(
    document: Document, rows: Rows, request: Request, time: Array
) -> tuple[Array, Array | None, float | None, bool]:
    """Return positions in m, velocities in m/s, the scale, and whether meters were guessed."""
    scale, matrix, stated = request.scale_of_unit(), request.matrix(document), LENGTHS.get(rows.unit)
    given = next((name for name in ("unit", "scale", "homography") if getattr(request, name) is not None), None)
    agrees = scale is not None and stated is not None and abs(scale / stated - 1.0) < 1e-9
    if given is not None and stated is not None and rows.unit_fixed and not agrees:
        rule = f"agree with {given}: its positions are in {rows.unit}"
        remedy = f"leave out {given}, or correct the file"
        raise document.error("unit_contradicts_file", rule, getattr(request, given), remedy)
    guessed = False
    flip = np.array([1.0, -1.0]) if rows.flip else np.ones(2)
    if matrix is not None:
        return (*_mapped(document, rows, matrix), None, False)
    if scale is None:
        scale = stated
    if scale is None and rows.unit not in {"", "px"}:
        rule = f"have positions in one of {', '.join(LENGTHS)}"
        raise document.error("unit_needed", rule, rows.unit, "give scale=, the meters of one such unit")
    if scale is None and rows.unit == "px":
        rule = "come with scale=, the meters of a pixel, or homography="
        raise document.error("scale_needed", rule, Shown("positions in pixels and no scale"))
    if scale is None and rows.unit_guess:
        scale, guessed = 1.0, True
    if scale is None:
        raise unit_needed(document, Recording(time_s=time, person=rows.person, position=rows.position))
    velocity = None if rows.velocity is None else rows.velocity * (scale * flip)
    return rows.position * (scale * flip), velocity, scale, guessed


def _mapped(document: Document, rows: Rows, matrix: Array) -> tuple[Array, Array | None]:
    """Return positions through a homography; stored velocities are lost."""
    places = np.column_stack([rows.position, np.ones(len(rows.position))]) @ matrix.T
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        found: Array = places[:, :2] / places[:, 2:]
    bad = np.flatnonzero(~np.isfinite(found).all(axis=1) | (places[:, 2] * places[0, 2] <= 0.0))
    if len(bad):
        where = Shown(f"({rows.position[bad[0], 0]:g}, {rows.position[bad[0], 1]:g}) on the other side of its horizon")
        raise InvalidParameterError("homography", f"map all positions of {document.name} to the floor", where)
    return found, None


def unit_needed(document: Document, as_meters: Recording, why: str = "") -> Exception:
    """Return the error about a file that names no unit, with the unit that makes speeds plausible."""
    speed = as_meters.median_speed()
    fitting = plausible_unit(speed)
    found = f"no unit; median speed {speed:.4g} m/s as meters"
    if why:
        found += f" ({why})"
    remedy = 'give unit="m", "cm" or "mm", or scale='
    if fitting is not None:
        found += f", {speed * LENGTHS[fitting]:.3g} m/s as {fitting}" if fitting != "m" else ""
        remedy = f'give unit="{fitting}" if that is right'
    return document.error("unit_needed", "come with unit=, the unit of positions", Shown(found), remedy)
