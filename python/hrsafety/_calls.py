"""Calls with a keyword that there is not: which one may have been meant."""

from __future__ import annotations

import functools
import re
import sys
from collections.abc import Callable, Iterable
from enum import Enum
from types import FunctionType
from typing import Any, TypeVar

__all__ = ["suggest", "suggesting"]

_PACKAGE = f"{__name__.partition('.')[0]}."
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

            question = meant(
                unknown[1],
                [name for name in inspect.signature(function).parameters if name not in ("self", "cls", "_cls")],
            )
            if question is None:
                raise
            raise TypeError(f"{error}; {question}") from None

    return called  # type: ignore[return-value]  # it takes what the function takes


def suggest(names: Iterable[str], space: dict[str, Any]) -> None:
    """Make functions, constructors and methods of a package suggest keywords, in the modules where they stand as well.

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
        elif isinstance(value, type) and not issubclass(value, (BaseException, Enum)):
            for each in value.__mro__:
                if each.__module__.startswith(_PACKAGE):
                    _suggest_in(each)


def _suggest_in(kind: type) -> None:
    """Make the constructor and the public methods of a class suggest keywords; those of data classes do already."""
    for name, value in list(vars(kind).items()):
        function = value.__func__ if isinstance(value, (classmethod, staticmethod)) else value
        public = not name.startswith("_") or name in ("__init__", "__new__")
        if public and isinstance(function, FunctionType) and not hasattr(function, "__wrapped__"):
            made = suggesting(function)
            setattr(kind, name, made if value is function else type(value)(made))
