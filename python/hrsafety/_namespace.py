"""Names of a package that stand in its sub-namespaces are found from the package, too."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import ModuleType

from hrsafety._words import meant

__all__ = ["names_below"]


def names_below(
    package: str, public: Sequence[str], below: Sequence[ModuleType]
) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """Return ``__getattr__`` and ``__dir__`` of a package.

    Parameters
    ----------
    package : str
        Its name.
    public : sequence of str
        Its ``__all__``, which is what ``dir`` shows.
    below : sequence of module
        Where names are looked for that the package does not have itself; each has an ``__all__``.

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

    def find(name: str) -> object:
        for module in below:
            if name in module.__all__:
                return getattr(module, name)
        message = f"module {package!r} has no attribute {name!r}"
        known = {*public, *(each for module in below for each in module.__all__)}
        question = None if name.startswith("__") else meant(name, known)
        # With its name the error stands as it is: Python adds no guess of its own.
        raise AttributeError(message if question is None else f"{message}; {question}", name=name)

    def shown() -> list[str]:
        return sorted(public)

    return find, shown
