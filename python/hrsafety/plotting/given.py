"""Plain arguments of pictures that fail, checked by their annotations: words, numbers, arrays, mappings of them."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import numpy as np

from hrsafety._arguments import callback, count, finite, flag, instance, numbers, pair, sequence
from hrsafety.errors import InvalidParameterError

__all__ = ["check_given"]

Check = Callable[[str, Any], object]


def _word(name: str, value: Any) -> None:
    instance(name, value, str)


def _words(name: str, value: Any) -> None:
    for index, each in enumerate(sequence(name, "be a sequence of strings", value)):
        instance(f"{name}[{index}]", each, str)


def _array(name: str, value: Any) -> None:
    if np.isinf(numbers(name, value)).any():
        raise InvalidParameterError(name, "hold finite numbers, or NaN where there is none", value)


def _numbers(name: str, value: Any) -> None:
    for index, each in enumerate(sequence(name, "be a sequence of numbers", value)):
        finite(f"{name}[{index}]", each)


def _pair(name: str, value: Any) -> None:
    for index, each in enumerate(pair(name, value)):
        finite(f"{name}[{index}]", each)


def _integer(name: str, value: Any) -> None:
    count(name, value, least=-(2**31), most=2**31)


def _mapping(check: Check | None) -> Check:
    def checked(name: str, value: Any) -> None:
        instance(name, value, Mapping)  # type: ignore[type-abstract]  # whatever is one
        for key, each in value.items() if check is not None else ():
            check(f"{name}[{key!r}]", each)  # type: ignore[misc]  # not None here

    return checked


_CHECKS: dict[str, Check] = {
    "str": _word,
    "Sequence[str]": _words,
    "float": finite,
    "int": _integer,
    "bool": flag,
    "Sequence[float]": _numbers,
    "tuple[float, float]": _pair,
    "npt.ArrayLike": _array,
    "Callable[[int, int], object]": callback,
    "Mapping[str, float]": _mapping(finite),
    "Mapping[str, npt.ArrayLike]": _mapping(_array),
    "Mapping[str, Sequence[float]]": _mapping(_numbers),
    "Mapping[str, tuple[float, float]]": _mapping(_pair),
    "Mapping[str, str]": _mapping(_word),
    "Mapping[str, bool]": _mapping(flag),
    "Mapping[str, Mapping[str, float]]": _mapping(_mapping(finite)),
}


@cache
def _checks_of(function: Callable[..., object]) -> tuple[inspect.Signature, dict[str, tuple[Check, bool]]]:
    """Return the signature of a function, and the check of each parameter with whether it may be ``None``."""
    signature, found = inspect.signature(function), {}
    for name, parameter in signature.parameters.items():
        said = str(parameter.annotation)
        check = _CHECKS.get(said.removesuffix(" | None"))
        if check is None and said.startswith("Mapping["):
            check = _mapping(None)
        if check is not None:
            found[name] = (check, said.endswith(" | None"))
    return signature, found


def check_given(function: Callable[..., object], args: tuple[Any, ...], kwargs: Mapping[str, Any]) -> None:
    """Check the arguments of a call that failed, whose annotations are plain ones.

    Raises
    ------
    InvalidParameterError
        If one of them is not what its annotation says.
    """
    signature, checks = _checks_of(function)
    try:
        given = signature.bind(*args, **kwargs).arguments
    except TypeError:
        return
    for name, value in given.items():
        check, may_be_none = checks.get(name, (None, False))
        if check is not None and not (value is None and may_be_none):
            check(name, value)
