"""Names of a package that are loaded when they are asked for, from its modules or its sub-namespaces."""

from __future__ import annotations

import ast
import importlib
import sys
from collections.abc import Callable, Sequence

import numpy as np  # noqa: F401  # with the package, not inside the native module: Ctrl-C while it is read is an interrupt

from hrsafety._calls import suggest
from hrsafety._words import meant

__all__ = ["names_of"]


def names_of(
    package: str, below: Sequence[str] = ()
) -> tuple[list[str], Callable[[str], object], Callable[[], list[str]]]:
    """Return ``__all__``, ``__getattr__`` and ``__dir__`` of a package.

    Its names are those that it imports for type checkers, under ``if TYPE_CHECKING:`` in its own file: the one list
    of them. Type checkers take ``import name as name`` for a name of the package.

    Parameters
    ----------
    package : str
        Its name.
    below : sequence of str
        Modules where names are looked for that the package does not have itself; each has an ``__all__``.

    Returns
    -------
    tuple of a list and two functions
        Values of ``__all__``, ``__getattr__`` and ``__dir__``.

    Examples
    --------
    >>> import hrsafety.navigation as nav
    >>> nav.Camera is nav.sensing.Camera, "Camera" in dir(nav)
    (True, False)
    """
    where = _declared(package)
    public = sorted(where)

    def find(name: str) -> object:
        if name not in where:
            return _found_below(package, public, below, name)
        place = where[name]
        module = importlib.import_module(f"{package}.{name}" if place == package else place)
        found = {name: module if place == package else getattr(module, name)}
        suggest(found, found)
        # Found once: the next time Python does not ask.
        setattr(sys.modules[package], name, found[name])
        return found[name]

    def shown() -> list[str]:
        return sorted(["__all__", *public])  # makers of documentation look for the list, too

    return public, find, shown


def _declared(package: str) -> dict[str, str]:
    """Return the names that a package imports for type checkers, with the modules where they stand."""
    spec = sys.modules[package].__spec__
    read = getattr(spec and spec.loader, "get_source", None)
    source = read and read(package)
    if source is None:
        raise ImportError(f"{package} lists its names in its source file, which is not there", name=package)
    for block in ast.parse(source).body:
        if isinstance(block, ast.If) and isinstance(block.test, ast.Name) and block.test.id == "TYPE_CHECKING":
            imports = [each for each in block.body if isinstance(each, ast.ImportFrom)]
            return {alias.name: str(each.module) for each in imports for alias in each.names}
    raise ImportError(f"{package} imports no names for type checkers", name=package)


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
