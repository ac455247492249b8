"""Calls with a keyword that there is not: which one may have been meant."""

from __future__ import annotations

import functools
import re
import sys
from collections.abc import Callable, Iterable
from types import FunctionType
from typing import Any, TypeVar

__all__ = ["suggest", "suggesting"]

_Called = TypeVar("_Called", bound=Callable[..., Any])
_UNKNOWN = re.compile(r"got an unexpected keyword argument '(\w+)'$")


def suggesting(function: _Called) -> _Called:
    """Return a function whose error about an unknown keyword names the nearest one that it has."""

    @functools.wraps(function)
    def called(*positional: Any, **named: Any) -> Any:
        try:
            return function(*positional, **named)
        except TypeError as error:
            here = error.__traceback__
            unknown = _UNKNOWN.search(str(error))
            # What is raised further down is none of this call.
            if unknown is None or here is None or here.tb_next is not None:
                raise
            import inspect  # for errors only

            from hrsafety._words import meant

            question = meant(unknown[1], [name for name in inspect.signature(function).parameters if name != "self"])
            if question is None:
                raise
            raise TypeError(f"{error}; {question}") from None

    return called  # type: ignore[return-value]  # it takes what the function takes


def suggest(names: Iterable[str], space: dict[str, Any]) -> None:
    """Make functions of a package suggest keywords, here and in the modules where they stand.

    Parameters
    ----------
    names : iterable of str
        Public names of the package.
    space : dict
        Its ``globals()``.
    """
    for name in names:
        value = space.get(name)
        if isinstance(value, FunctionType) and not hasattr(value, "__wrapped__"):
            # One function under its name: it is found again by it, as pickles do.
            space[name] = suggesting(value)
            setattr(sys.modules[value.__module__], value.__name__, space[name])
