"""Motions of obstacles: recordings and segments as they are kept, and the native bodies that follow them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, Protocol

import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, number, numbers, pair, points, sequence
from hrsafety.errors import HrsafetyError, InvalidParameterError, ShapeError, Shown

__all__ = ["Path", "Segment", "frozen_path", "frozen_segments", "moving_body"]

Segment = tuple[float, Pair, Pair]
Path = tuple[tuple[float, ...], tuple[Pair, ...]]


class _Moving(Protocol):
    """An obstacle that may follow a recording or segments."""

    @property
    def path(self) -> Path | None: ...

    @property
    def segments(self) -> tuple[Segment, ...] | None: ...


def frozen_path(time: npt.ArrayLike, position: npt.ArrayLike) -> Path:
    """Check the shapes of a recording and freeze it."""
    instants = numbers("time", time, "be an array of numbers")
    places = points("position", position)
    if instants.ndim != 1:
        raise ShapeError("time", "(n,)", instants.shape)
    if len(places) != len(instants):
        raise ShapeError("position", f"({len(instants)}, 2)", places.shape)
    if len(instants) == 0:
        raise InvalidParameterError("time", "hold at least one sample", Shown("an empty array"))
    return tuple(instants.tolist()), tuple(map(tuple, places.tolist()))


def frozen_segments(segments: Iterable[tuple[float, Sequence[float], Sequence[float]]]) -> tuple[Segment, ...]:
    """Freeze a list of (duration, velocity, acceleration)."""
    frozen = []
    rule = "be (duration, velocity, acceleration)"
    for index, segment in enumerate(sequence("segments", "be a list of (duration, velocity, acceleration)", segments)):
        parts = sequence(f"segments[{index}]", rule, segment)
        if len(parts) != 3:
            raise InvalidParameterError(f"segments[{index}]", rule, segment)
        duration, velocity, acceleration = parts
        frozen.append(
            (
                number(f"segments[{index}].duration", duration),
                pair(f"segments[{index}].velocity", velocity),
                pair(f"segments[{index}].acceleration", acceleration),
            )
        )
    return tuple(frozen)


def moving_body(obstacle: _Moving, start: Pair, given: Mapping[str, Any]) -> _hrsafety.Obstacle:
    """Return the native body of an obstacle that follows the path or the segments that it was given.

    Parameters
    ----------
    obstacle : Human, MovingDisc or MovingRectangle
        Its ``path`` and ``segments`` are as the classmethods have made them.
    start : tuple of float
        Where segments begin, in m.
    given : mapping
        Outline and limits by name.
    """
    if obstacle.path is not None:
        time, position = _as_made("path", obstacle.path, 2)
        with _explained(lambda: frozen_path(time, position)):
            return _hrsafety.Obstacle.recorded(time=time, position=position, **given)
    segments = _as_made("segments", obstacle.segments, None)
    with _explained(lambda: frozen_segments(segments)):
        return _hrsafety.Obstacle.piecewise(start=start, segments=segments, **given)


def _as_made(name: str, value: object, length: int | None) -> Any:
    """Return what a classmethod has made of a motion: constructors take it for copies only."""
    tuples = isinstance(value, tuple) and all(isinstance(each, tuple) for each in value)
    if not tuples or (length is not None and len(value) != length):  # type: ignore[arg-type]  # a tuple
        raise InvalidParameterError(name, "be None, or as it was made", value, f"use from_{name}")
    return value


@contextmanager
def _explained(check: Callable[[], object]) -> Iterator[None]:
    """Let a check name what the native module could not read: a motion that was made here needs no second one."""
    try:
        yield
    except (TypeError, ValueError) as error:
        if not isinstance(error, HrsafetyError):
            check()
        raise
