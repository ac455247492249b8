"""Arguments of arms: values of joints by name, points, arrays that broadcast."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from hrsafety._arguments import Array, checked_text, meant, number, numbers, readable, sequence
from hrsafety.errors import InvalidParameterError, MissingExtraError, ShapeError, Shown

__all__ = [
    "Rows",
    "armature_of",
    "broadcast",
    "locked_of",
    "poses_of",
    "urdf_text",
    "vectors_of",
]

Rows = tuple[Array, list[int]]
MOST_BYTES = 2**25
"""Largest URDF that is read."""


def urdf_text(source: object) -> tuple[str, str]:
    """Return the text of a URDF, and what names it in messages: a file, or the text itself."""
    if isinstance(source, str) and source.lstrip("\ufeff \t\r\n").startswith("<"):
        return checked_text("path_or_text", source, "be the text of a URDF").lstrip("\ufeff \t\r\n"), ""
    if not isinstance(source, (str, os.PathLike)):
        raise InvalidParameterError("path_or_text", "be a path or the text of a URDF", source)
    path = readable("path_or_text", Path(source))
    size = path.stat().st_size
    if size > MOST_BYTES:
        raise InvalidParameterError(path.name, f"have at most {MOST_BYTES} bytes", size)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise InvalidParameterError(
            path.name, "be text in UTF-8", Shown(f"byte {error.start}: {error.reason}")
        ) from None
    if path.suffix.lower() == ".xacro":
        text = _expanded(path)
    return text.lstrip(), path.name


def _expanded(path: Path) -> str:
    """Return the URDF that the macros of a file make."""
    try:
        from xacrodoc import XacroDoc
    except ModuleNotFoundError:
        raise MissingExtraError(f"{path.name} holds macros and needs xacrodoc: pip install hrsafety[arms]") from None
    try:
        return str(XacroDoc.from_file(path, resolve_packages=False).to_urdf_string())
    except Exception as error:  # macros are programs, and may fail as any
        found = Shown(" ".join(f"{type(error).__name__}: {error}".split())[:200])
        raise InvalidParameterError(path.name, "hold macros that can be expanded", found) from None


def locked_of(given: object) -> tuple[str, ...]:
    """Return the names of locked joints."""
    if given is None:
        return ()
    found = (given,) if isinstance(given, str) else tuple(sequence("locked", "be names of joints", given))
    return tuple(checked_text("locked", name, "be names of joints") for name in found)


def armature_of(given: object, joint_names: Sequence[str], argument: str = "armature") -> tuple[tuple[str, float], ...]:
    """Return numbers such as motor inertias by joint from a mapping, a sequence in their order, or one number."""
    if given is None:
        return ()
    if isinstance(given, Mapping):
        rule = "have names as keys"
        return tuple(
            (checked_text(argument, name, rule), number(f"{argument}[{name!r}]", value))
            for name, value in given.items()
        )
    values = numbers(argument, given)
    if values.shape not in {(), (len(joint_names),)}:
        raise ShapeError(argument, f"({len(joint_names)},)", values.shape)
    every = np.broadcast_to(values, len(joint_names)).tolist()
    return tuple((name, number(f"{argument}[{name!r}]", each)) for name, each in zip(joint_names, every, strict=True))


def motors_of(
    given: object, argument: str = "armature", pair: str = "a joint and its motor inertia"
) -> tuple[tuple[str, float], ...]:
    """Return the numbers of pairs of a name and a number."""
    rule = f"be a tuple of pairs of {pair}"
    pairs = [sequence(argument, rule, each) for each in sequence(argument, rule, given)]
    if not all(len(each) == 2 and isinstance(each[0], str) for each in pairs):
        raise InvalidParameterError(argument, rule, given)
    return tuple((checked_text(argument, name, rule), number(f"{argument}[{name!r}]", each)) for name, each in pairs)


def poses_of(given: object, joint_names: tuple[str, ...], argument: str = "joints") -> Array:
    """Return poses as an array (..., n) in the order of the joints; joints that are not named are at 0."""
    count = len(joint_names)
    if given is None:
        return np.zeros(count)
    if not isinstance(given, Mapping):
        poses = numbers(argument, given)
        if poses.ndim == 0 or poses.shape[-1] != count:
            raise ShapeError(argument, f"(..., {count})", poses.shape)
        return poses
    columns = {}
    for name, value in given.items():
        if name not in joint_names:
            rule = f"name joints that take a value: {', '.join(joint_names)}"
            raise InvalidParameterError(argument, rule, name, meant(name, joint_names))
        columns[name] = numbers(f"{argument}[{name!r}]", value)
    shape = _common(argument, {name: column.shape for name, column in columns.items()})
    poses = np.zeros((*shape, count))
    for index, name in enumerate(joint_names):
        if name in columns:
            poses[..., index] = columns[name]
    return poses


def vectors_of(argument: str, given: object) -> Array:
    """Return vectors as an array (..., 3)."""
    vectors = numbers(argument, given)
    if vectors.ndim == 0 or vectors.shape[-1] != 3:
        raise ShapeError(argument, "(..., 3)", vectors.shape)
    return vectors


def _common(argument: str, shapes: Mapping[str, tuple[int, ...]]) -> tuple[int, ...]:
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        shown = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise InvalidParameterError(argument, "have shapes that broadcast together", Shown(shown)) from None


def broadcast(most: int, **arrays: Array) -> tuple[tuple[int, ...], list[Rows]]:
    """Return the shape of the result, and each array as rows with the distance of neighbors along every axis.

    Parameters
    ----------
    most : int
        Largest number of results.
    **arrays : ndarray
        Arrays by the names of the arguments; the last axis of each stays together.

    Returns
    -------
    tuple
        The shape, and for each array its numbers and its strides in rows.
    """
    shape = _common(" and ".join(arrays), {name: array.shape[:-1] for name, array in arrays.items()})
    results = math.prod(shape)
    if results > most:
        raise InvalidParameterError(" and ".join(arrays), f"ask for at most {most} results", results)
    return shape, [(array.ravel(), _strides(array.shape[:-1], len(shape))) for array in arrays.values()]


def _strides(shape: tuple[int, ...], axes: int) -> list[int]:
    """Return how many rows apart neighbors are along each axis of the result."""
    strides, rows = [], 1
    for length in reversed(shape):
        strides.append(rows if length > 1 else 0)
        rows *= length
    return [0] * (axes - len(shape)) + strides[::-1]
