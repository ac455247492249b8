"""Values that break the usual rules, and the check that an error names its argument."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pytest

from hrsafety import HrsafetyError, InvalidParameterError, ShapeError

NAN, INF = math.nan, math.inf

NOT_NUMBERS: tuple[Any, ...] = ("1.0", b"1", True, (1.0, 2.0), [], {}, object(), 1j)
NOT_FINITE = (NAN, INF, -INF)
NOT_PAIRS: tuple[Any, ...] = (
    "ab",
    "12",
    1.0,
    (1.0,),
    (1.0, 2.0, 3.0),
    (),
    [[1.0, 2.0]],
    ("x", "y"),
    ("1", "2"),
    {},
    object(),
)
BAD_POINTS: tuple[Any, ...] = (*NOT_PAIRS, (NAN, 0.0), (0.0, INF), (-INF, 0.0), (None, 1.0), None)

# What the words stand for: values that break the rule of an argument.
NUMBER = (*NOT_NUMBERS, *NOT_FINITE, None)
NOT_NEGATIVE = (*NUMBER, -1.0, -1e-300)
POSITIVE = (*NOT_NEGATIVE, 0.0, -0.0)
OPTIONAL_POSITIVE = tuple(value for value in POSITIVE if value is not None)
OPTIONAL_NOT_NEGATIVE = tuple(value for value in NOT_NEGATIVE if value is not None)
POINT = BAD_POINTS
OPTIONAL_POINT = tuple(value for value in BAD_POINTS if value is not None)
WHEELS = (
    (1.0,),
    (1.0, 2.0),
    (1.0, 2.0, 3.0, 4.0),
    "abc",
    1.0,
    None,
    (NAN, 1.0, 1.0),
    (1.0, "2", 1.0),
    (1.0, 1.0, -1.0),
    (INF, 1.0, 1.0),
)
WORD = ("", "unknown", "OFF", 1, None, True)


def spoiled(rules: Mapping[str, Mapping[str, Sequence[Any]]]) -> list[Any]:
    """Return a case (owner, argument, values that break a rule) for every argument."""
    return [
        pytest.param(owner, argument, values, id=f"{owner}-{argument}")
        for owner, arguments in rules.items()
        for argument, values in arguments.items()
    ]


def spoiled_calls(calls: Mapping[str, tuple[Any, ...]]) -> list[Any]:
    """Return the cases of calls whose last part says what breaks the rules of their arguments."""
    return spoiled({name: call[-1] for name, call in calls.items()})


@contextlib.contextmanager
def refused(value: Any) -> Iterator[pytest.ExceptionInfo[HrsafetyError]]:
    """Ask for an error about a value, as `pytest.raises` does; a failure tells which value it was."""
    try:
        with pytest.raises((InvalidParameterError, ShapeError)) as caught:
            yield caught
    except BaseException as failure:
        failure.add_note(f"the value was {value!r}")
        raise


def names(error: HrsafetyError) -> str:
    """Return the argument that the error is about, checked against its message."""
    assert isinstance(error, (InvalidParameterError, ShapeError))
    assert str(error).startswith(f"{error.argument} must ")
    assert ", got " in str(error)
    return error.argument
