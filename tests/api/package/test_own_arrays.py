"""What was checked stays: parameter objects do not change with arrays that their maker fills again."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

from fuzz.constructors import constructors
from hrsafety import HrsafetyError, standards
from hrsafety import navigation as nav


def _array(value: Any) -> np.ndarray | None:
    """Return numbers as an array of their own; None for what is none."""
    if not isinstance(value, (list, tuple, np.ndarray)):
        return None
    try:
        array = np.array(value)
    except ValueError:
        return None
    return array if array.ndim and array.size and array.dtype.kind in "fiub" else None


def _from_arrays(function: Any, right: dict[str, Any]) -> tuple[Any, list[np.ndarray]]:
    """Return an object made with arrays wherever its constructor takes them, and the arrays."""
    given = {key: value for key, value in right.items() if value is not ...}
    arrays = []
    for key, value in given.items():
        array = _array(value)
        if array is None:
            continue
        try:
            function(**given | {key: array})
        except HrsafetyError:
            continue
        given[key] = array
        arrays.append(array)
    return function(**given), arrays


def _state(made: object) -> object:
    try:
        return pickle.dumps(made)
    except HrsafetyError:
        return repr(made)


CASES = {
    name: case for name, case in constructors().items() if any(_array(each) is not None for each in case[1].values())
}


@pytest.mark.parametrize("name", CASES)
def test_objects_keep_their_numbers(name: str) -> None:
    made, arrays = _from_arrays(*CASES[name])
    before, shown = _state(made), repr(made)
    for array in arrays:
        array[...] = ~array if array.dtype == bool else array + array.dtype.type(1)
    assert (_state(made), repr(made)) == (before, shown)


def test_scenes_of_arrays_are_those_of_their_making() -> None:
    position = np.full((3, 1, 2), 2.5)
    scenes = nav.Scenarios.from_arrays(start=np.zeros((3, 2)), goal=(5.0, 0.0), obstacle_position=position)
    first = scenes[0]
    position[...] = 0.0
    assert scenes[0] == first
    assert pickle.loads(pickle.dumps(scenes))[2] == scenes[2]


def test_measured_stops_are_not_writable() -> None:
    stops = standards.StoppingData(speed=[0.0, 1.0], time=[0.0, 0.2], distance=[0.0, 0.1])
    with pytest.raises(ValueError, match="read-only"):
        stops.distance[1] = 0.0
