"""Names of a package that are loaded when they are asked for, from its modules or its sub-namespaces."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Mapping, Sequence

import numpy as np  # noqa: F401  # with the package, not inside the native module: Ctrl-C while it is read is an interrupt

from hrsafety._calls import suggest
from hrsafety._words import meant

__all__ = ["names_of"]


def names_of(
    package: str, public: Sequence[str], places: Mapping[str, str], below: Sequence[str] = ()
) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """Return ``__getattr__`` and ``__dir__`` of a package.

    Parameters
    ----------
    package : str
        Its name.
    public : sequence of str
        Its ``__all__``, which ``dir`` shows; names without a place are sub-modules.
    places : mapping of str to str
        By the name of a module the public names that stand there, separated by blanks.
    below : sequence of str
        Modules where names are looked for that the package does not have itself; each has an ``__all__``.

    Returns
    -------
    tuple of two functions
        What to assign to ``__getattr__`` and ``__dir__``.

    Examples
    --------
    >>> import hrsafety.navigation as nav
    >>> nav.Camera is nav.sensing.Camera, "Camera" in dir(nav)
    (True, False)
    """
    where = {name: module for module, names in places.items() for name in names.split()}

    def find(name: str) -> object:
        if name in where:
            found = {name: getattr(importlib.import_module(where[name]), name)}
            suggest(found, found)
            value: object = found[name]
        elif name in public:
            value = importlib.import_module(f"{package}.{name}")
        else:
            return _found_below(package, public, below, name)
        # Found once: the next time Python does not ask.
        setattr(sys.modules[package], name, value)
        return value

    def shown() -> list[str]:
        return sorted(["__all__", *public])  # makers of documentation look for the list, too

    return find, shown


def _found_below(package: str, public: Sequence[str], below: Sequence[str], name: str) -> object:
    """Return what stands under a name in one of the modules, or say which name may have been meant."""
    message = f"module {package!r} has no attribute {name!r}"
    question = None
    if not name.startswith("__"):  # those are asked for by tools, and stand nowhere below
        try:  # a module, which `from package import module` asks for as well
            return importlib.import_module(f"{package}.{name}")
        except ModuleNotFoundError as error:
            if error.name != f"{package}.{name}":
                raise
        modules = [importlib.import_module(each) for each in below]
        for module in modules:
            if name in module.__all__:
                return getattr(module, name)
        question = meant(name, {*public, *(each for module in modules for each in module.__all__)})
    # With its name the error stands as it is: Python adds no guess of its own.
    raise AttributeError(message if question is None else f"{message}; {question}", name=name)
