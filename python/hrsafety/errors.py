"""Exceptions raised by the package.

Every error derives from `HrsafetyError`, so one ``except`` clause catches them all.
"""

from __future__ import annotations

import re

from hrsafety._words import meant

__all__ = [
    "FileError",
    "FolderInUseError",
    "HrsafetyError",
    "InfeasibleError",
    "InvalidParameterError",
    "MissingExtraError",
    "ShapeError",
    "SimulationError",
    "StorageError",
]


# A rule that lists words in quotes, as 'be "off", "capped" or "full"'.
_CHOICE = r'be (one of )?"'
_QUOTED = r'"([^"]+)"'

# A value that prints longer than this is cut: objects of many parameters would bury the rule.
LONGEST_SHOWN = 200

# A number at the end of a cut text, which may be half of one.
_HALF = r"(?<![\w.])[+-]?[\d.][\d.e+-]*$"
# Numbers of NumPy are shown as numbers.
_OF_NUMPY = r"\bnp\.(?:float|u?int)\d+\(([^()]*)\)"


class HrsafetyError(Exception):
    """Base class of every error this package raises on purpose."""


class InvalidParameterError(HrsafetyError, ValueError):
    """An argument breaks a rule.

    Parameters
    ----------
    argument : str
        Name of the argument (or of the file key).
    requirement : str
        The rule it must obey.
    value : object
        What was given.
    remedy : str or None
        What would mend it, if the rule does not say so already.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> try:
    ...     nav.HolonomicRobot(mass=-1.0)
    ... except nav.InvalidParameterError as error:
    ...     print(error)
    mass must be finite and positive, got -1.0
    """

    def __init__(self, argument: str, requirement: str, value: object, remedy: str | None = None) -> None:
        if remedy is None and isinstance(value, str) and re.match(_CHOICE, requirement):
            remedy = meant(value, re.findall(_QUOTED, requirement))
        super().__init__(argument, requirement, value, remedy)
        self.argument = argument
        self.requirement = requirement
        self.value = value
        self.remedy = remedy

    def renamed(self, argument: str) -> InvalidParameterError:
        """Return the same error under another name of its argument, as a file or a caller knows it."""
        return InvalidParameterError(argument, self.requirement, self.value, self.remedy)

    def __str__(self) -> str:
        """Return the sentence that names argument, rule, value and remedy."""
        shown = self.value if isinstance(self.value, Shown) else _words(self.value)
        sentence = f"{self.argument} must {self.requirement}, got {shown}"
        return sentence if self.remedy is None else f"{sentence}; {self.remedy}"


def _words(value: object) -> str:
    """Return a value as it is printed, cut when long; Python refuses to print integers of thousands of digits."""
    if isinstance(value, int) and abs(value) >= 10**40:
        return f"an integer of {value.bit_length()} bits"
    try:
        shown = repr(value)
    except Exception:  # of a class that cannot be printed, or nested too deeply: the rule is told in any case
        return f"an object of class {type(value).__name__}"
    if not isinstance(value, str):
        shown = re.sub(_OF_NUMPY, r"\1", shown)
    if len(shown) <= LONGEST_SHOWN:
        return shown
    return f"{re.sub(_HALF, '', shown[:LONGEST_SHOWN])}..."


class FileError(InvalidParameterError):
    """A file breaks a rule of its format, or does not say what is needed to read it.

    Parameters
    ----------
    argument : str
        File with the place in it: ``"walk.csv, line 4, column x"``, ``"nav2.yaml, key robot_radius"``.
    requirement : str
        The rule it must obey.
    value : object
        What stands there.
    remedy : str or None
        What would mend it.
    code : str
        Kind of error for programs, for example ``"frame_rate_needed"``.

    Examples
    --------
    >>> from hrsafety.errors import FileError
    >>> print(FileError("walk.csv, line 4, column x", "be a finite number", "1.234,5", code="unreadable_number"))
    walk.csv, line 4, column x must be a finite number, got '1.234,5'
    """

    def __init__(
        self, argument: str, requirement: str, value: object, remedy: str | None = None, *, code: str = "unreadable"
    ) -> None:
        super().__init__(argument, requirement, value, remedy)
        self.code = code

    def renamed(self, argument: str) -> FileError:
        """Return the same error under another name of its argument."""
        return FileError(argument, self.requirement, self.value, self.remedy, code=self.code)

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by what the sentence is made of."""
        return _file_error, (self.argument, self.requirement, self.value, self.remedy, self.code)


def _file_error(argument: str, requirement: str, value: object, remedy: str | None, code: str) -> FileError:
    return FileError(argument, requirement, value, remedy, code=code)


class Shown(str):
    """Words in place of a value in a message, printed without quotes: what was found, not given."""

    __slots__ = ()


class ShapeError(HrsafetyError, ValueError):
    """An array argument has the wrong shape.

    Parameters
    ----------
    argument : str
        Name of the argument.
    expected : str
        Shape that is needed, for example ``"(n, 2)"``.
    actual : tuple of int
        Shape that was given.
    """

    def __init__(self, argument: str, expected: str, actual: tuple[int, ...]) -> None:
        super().__init__(argument, expected, actual)
        self.argument = argument
        self.expected = expected
        self.actual = actual

    def __str__(self) -> str:
        """Return the sentence that names argument, rule and shape."""
        return f"{self.argument} must have shape {self.expected}, got {self.actual}"


class InfeasibleError(HrsafetyError):
    """A search found nothing that keeps every constraint.

    Parameters
    ----------
    finding : str
        What was found instead.
    remedy : str
        What would mend it.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> from hrsafety.errors import InfeasibleError
    >>> search = nav.optimize_gains(
    ...     [scenarios.configuration("c1")], bounds={"attractive_gain": (0.0, 0.0)}, method="cma_es", evaluations=20
    ... )
    >>> try:
    ...     search.best
    ... except InfeasibleError as error:
    ...     print(error.finding)
    no gain set arrives without a contact everywhere; the nearest fails in 1 of 1 runs
    """

    def __init__(self, finding: str, remedy: str) -> None:
        super().__init__(finding, remedy)
        self.finding = finding
        self.remedy = remedy

    def __str__(self) -> str:
        """Return what was found and the remedy."""
        return f"{self.finding}; {self.remedy}"


class SimulationError(HrsafetyError):
    """A run could not be carried out, for example because its state became non-finite.

    Parameters
    ----------
    message : str
        What happened.
    run : int or None
        Which run of several, counted as the rows of their table are; ``None`` where there are no runs.
    """

    def __init__(self, message: str, run: int | None = None) -> None:
        super().__init__(message)
        self.run = run


class FolderInUseError(HrsafetyError):
    """Another run is writing the same files."""


class StorageError(HrsafetyError, OSError):
    """A file could not be written, for example because the disk is full.

    Parameters
    ----------
    path : path-like
        The file, or the folder that it should have gone into.
    error : OSError
        What the system said.
    kept : str
        What is on the disk and stays there.
    remedy : str
        How to resume.
    """

    def __init__(self, path: object, error: OSError, *, kept: str, remedy: str) -> None:
        super().__init__(error.errno, error.strerror or str(error), str(path))
        self.kept = kept
        self.remedy = remedy

    def __str__(self) -> str:
        """Return the sentence that names the file, the reason, what is kept and how to resume."""
        return f"{self.filename} cannot be written ({self.strerror}); kept: {self.kept}; {self.remedy}"

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by what the sentence is made of."""
        return _storage_error, (self.filename, self.errno, self.strerror, self.kept, self.remedy)


def _storage_error(path: str, errno: int, reason: str, kept: str, remedy: str) -> StorageError:
    return StorageError(path, OSError(errno, reason), kept=kept, remedy=remedy)


class MissingExtraError(HrsafetyError, ImportError):
    """An optional library is needed that is not installed."""
