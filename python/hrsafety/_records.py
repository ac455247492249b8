"""Frozen dataclasses whose methods are generated when they are first used.

The decorator of the standard library writes and compiles up to six functions for each class. Of the two hundred
classes of this package a program uses a few; for all of them that was more than half of the time of an import.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from hrsafety._calls import suggesting

__all__ = ["dataclass", "generates"]

Kind = TypeVar("Kind", bound=type)

if TYPE_CHECKING:  # the same decorator for type checkers, which know that of the standard library
    from dataclasses import dataclass
else:

    def dataclass(**options: bool) -> Callable[[Kind], Kind]:
        """Make a class a dataclass as that of the standard library does, later where that is possible.

        Parameters
        ----------
        **options : bool
            Those of `dataclasses.dataclass`. Without ``frozen`` and ``slots`` it is called at once.

        Returns
        -------
        function
            The decorator.
        """
        if options.get("frozen") and options.get("slots"):
            return lambda kind: _Declared(kind, options).slotted()
        return dataclasses.dataclass(**options)


def generates(kind: type, name: str) -> bool:
    """Return whether a method of a class is generated, not written."""
    found = next((each.__dict__[name] for each in kind.__mro__ if name in each.__dict__), None)
    return isinstance(found, _OnFirstUse) or hasattr(found, "__wrapped__")


class _Declared:
    """A class as it was declared, of which the standard library makes a dataclass when it is used."""

    def __init__(self, kind: type, options: dict[str, bool]) -> None:
        self.kind = kind
        self.options = options

    def slotted(self) -> Any:
        """Return the class with slots for its fields, and with everything else that is generated on first use."""
        space = self._space()
        hints = space.get("__annotations__", {})
        names = [name for name, hint in hints.items() if not str(hint).startswith(("ClassVar", "typing.ClassVar"))]
        for name in names:
            space.pop(name, None)  # its default
        taken = {name for base in self.kind.__mro__[1:-1] for name in base.__dict__.get("__slots__", ())}
        space["__slots__"] = tuple(name for name in names if name not in taken)
        for name in self._generated(space):
            space[name] = _OnFirstUse(self, name)
        made = type(self.kind)(self.kind.__name__, self.kind.__bases__, {**_SHARED, **space})
        made.__qualname__ = self.kind.__qualname__
        return made

    def _space(self) -> dict[str, Any]:
        space = dict(self.kind.__dict__)
        space.pop("__dict__", None)
        space.pop("__weakref__", None)
        return space

    def _generated(self, space: dict[str, Any]) -> list[str]:
        """Return the names that the standard library would put into the class."""
        names = ["__dataclass_fields__", "__dataclass_params__", "__match_args__", "__init__"]
        if self.options.get("repr", True):
            names.append("__repr__")
        if self.options.get("eq", True):
            names.append("__eq__")
            if space.get("__hash__") is None:
                space.pop("__hash__", None)  # of a class with an `__eq__` of its own
                names.append("__hash__")
        return [name for name in names if name not in space]

    def made(self, name: str) -> Any:
        """Return what the standard library puts into the class under a name."""
        wanted = _OPTIONS.get(name)
        options = {**self.options, **{each: each == wanted for each in ("init", "repr", "eq", "match_args")}}
        copy = type(self.kind)(self.kind.__name__, self.kind.__bases__, self._space())
        copy.__qualname__ = self.kind.__qualname__
        made = dataclasses.dataclass(**options)(copy).__dict__[name]
        if name == "__init__":
            made = suggesting(made)
        if name == "__dataclass_params__":
            for each, value in {"init": True, "repr": True, "eq": True, **self.options}.items():
                if hasattr(made, each):
                    setattr(made, each, value)
        return made


# The option of the standard decorator that asks for a name; the fields come without one.
_OPTIONS = {"__init__": "init", "__repr__": "repr", "__eq__": "eq", "__hash__": "eq", "__match_args__": "match_args"}


class _OnFirstUse:
    """An attribute of a class that is generated on first use."""

    __slots__ = ("declared", "name")

    def __init__(self, declared: _Declared, name: str) -> None:
        self.declared = declared
        self.name = name

    def __get__(self, value: object, owner: type) -> Any:
        kind = next((each for each in owner.__mro__ if each.__dict__.get(self.name) is self), None)
        made = self.declared.made(self.name)
        if kind is not None:  # else another thread was faster
            setattr(kind, self.name, made)
        bind = getattr(type(made), "__get__", None)
        return made if bind is None else bind(made, value, owner)


def _assigned(_self: object, name: str, _value: object) -> None:
    raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")


def _deleted(_self: object, name: str) -> None:
    raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")


def _state(self: Any) -> list[Any]:
    return [getattr(self, each.name) for each in dataclasses.fields(self)]


def _set_state(self: Any, state: list[Any]) -> None:
    for each, value in zip(dataclasses.fields(self), state, strict=True):
        object.__setattr__(self, each.name, value)


_SHARED = {"__setattr__": _assigned, "__delattr__": _deleted, "__getstate__": _state, "__setstate__": _set_state}
