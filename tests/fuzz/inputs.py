"""One input by its number: which call, with which arguments, and how it was answered."""

from __future__ import annotations

import dataclasses
import random
import tempfile
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from api.fuzzing import CALLS
from fuzz.constructors import Right, constructors
from fuzz.programs import JUDGE, misnumbered
from fuzz.readers import damaged, readers
from fuzz.results import missing_numbers, says_why
from fuzz.values import spoiled
from hrsafety import HrsafetyError

__all__ = ["ANSWERS", "Inputs", "Outcome"]

ANSWERS = ("results", "errors", "escapes")
"""How a call is answered: with a result, an error of the package, or something else."""

# Of all inputs: calls of functions take milliseconds, constructors microseconds.
FUNCTION_SHARE, FILE_SHARE = 0.04, 0.02
# Functions whose documentation says where a result holds NaN, without a status beside it.
DOCUMENTED = frozenset({"metrics.evaluate", "crowd.simulate", "force_field"})
MOST_SHOWN = 2000


@dataclass(frozen=True, slots=True)
class Outcome:
    """How an input was answered.

    Attributes
    ----------
    target : int
        Number of the constructor, function or reader in `Inputs.names`.
    answer : str
        One of `ANSWERS`.
    told : str
        What came out, for an escape; else empty.
    shown : str
        The arguments or the content of the file, for an escape; else empty.
    """

    target: int
    answer: str
    told: str = ""
    shown: str = ""


class Inputs:
    """All inputs of a seed; each is made from the seed and its number alone.

    Parameters
    ----------
    seed : int
        Of the draws.
    folder : Path
        For the files that are damaged and read.
    part : str
        Only what has this in its name is called; all by default.
    """

    def __init__(self, seed: int, folder: Path, part: str = "") -> None:
        self.seed = seed
        made, self._files = constructors(), readers(folder)
        self._contents = {name: path.read_bytes() for name, (path, _) in self._files.items()}
        self._targets: dict[str, tuple[Callable[..., Any], Right]] = {**made, **CALLS}
        self._groups = (list(made), list(CALLS), list(self._files))
        self.names = [name for group in self._groups for name in group]
        self._chosen = [name for name in self.names if part in name] if part else []
        self._number = {name: index for index, name in enumerate(self.names)}
        # What is NaN in the answer to a right call, by function; found when it is needed.
        self._usual: dict[str, set[str]] = {}

    def target(self, draws: random.Random) -> str:
        """Return what is called."""
        if self._chosen:
            return draws.choice(self._chosen)
        share = draws.random()
        group = 2 if share < FILE_SHARE else 1 if share < FILE_SHARE + FUNCTION_SHARE else 0
        return draws.choice(self._groups[group])

    def answer(self, number: int, begun: Callable[[int], object] = lambda _target: None) -> Outcome:
        """Make one input and return how it was answered.

        Parameters
        ----------
        number : int
            Of the input.
        begun : callable
            Called with the number of the target before it is called.
        """
        draws = random.Random((self.seed << 48) ^ number)
        name = self.target(draws)
        target = self._number[name]
        begun(target)
        if name in self._files:
            path, reader = self._files[name]
            number_wise = name.startswith(JUDGE) and draws.random() < 0.5
            content = (misnumbered if number_wise else damaged)(self._contents[name], draws)
            path.write_bytes(content)
            try:
                return _answered(target, reader, {"path": path}, content, made=False)[0]
            finally:
                path.write_bytes(self._contents[name])
        function, right = self._targets[name]
        arguments = _spoiled(right, draws)
        outcome, result = _answered(target, function, arguments, arguments, made=name not in CALLS)
        silent = self._silent(name, result) if name in CALLS and result is not None else []
        if not silent:
            return outcome
        return Outcome(target, "escapes", f"silent NaN in {', '.join(silent)}", repr(arguments)[:MOST_SHOWN])

    def _silent(self, name: str, result: object) -> list[str]:
        """Return what is NaN in a result that does not say why, beside what always is."""
        found = missing_numbers(result)
        if not found or name in DOCUMENTED or says_why(result):
            return []
        if name not in self._usual:
            function, right = CALLS[name]
            self._usual[name] = missing_numbers(function(**right))
        return sorted(found - self._usual[name])


def _spoiled(right: Right, draws: random.Random) -> Right:
    """Return right arguments of which one to three are spoiled."""
    arguments = {key: value for key, value in right.items() if value is not ...}
    keys = list(right)
    for key in draws.sample(keys, min(len(keys), draws.choice((1, 1, 2, 3)))):
        arguments[key] = spoiled(right[key], draws)
    return arguments


def _answered(
    target: int, function: Callable[..., Any], given: Right, shown: object, *, made: bool
) -> tuple[Outcome, object]:
    """Call, and return how it was answered, and the result; ``made``: whether a parameter object comes out."""
    told = ""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            result = function(given["path"]) if isinstance(shown, bytes) else function(**given)
        empty = _fields_without_number(result) if made else []
        if not empty:
            return Outcome(target, "results"), result
        told = f"silent NaN in {', '.join(empty)}"
    except HrsafetyError as error:
        if str(error):
            return Outcome(target, "errors"), None
        told = "an error without a message"
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        told = f"{type(error).__name__}: {error}"
    return Outcome(target, "escapes", told, repr(shown)[:MOST_SHOWN]), None


def _fields_without_number(made: object) -> list[str]:
    """Return the fields of a parameter object that hold a NaN."""
    if not dataclasses.is_dataclass(made):
        return []
    values = ((field.name, getattr(made, field.name, None)) for field in dataclasses.fields(made))
    return [name for name, value in values if _has_nan(value)]


def _has_nan(value: object) -> bool:
    if isinstance(value, (float, np.floating)):
        return bool(value != value)
    if isinstance(value, np.ndarray):
        return value.dtype.kind == "f" and bool(np.isnan(value).any())
    return isinstance(value, (tuple, list)) and any(_has_nan(each) for each in value)


def in_new_folder(seed: int, part: str = "") -> tuple[tempfile.TemporaryDirectory[str], Inputs]:
    """Return the inputs of a seed and the folder of their files, to be cleaned up."""
    folder = tempfile.TemporaryDirectory(prefix="hrsafety-fuzz-")
    return folder, Inputs(seed, Path(folder.name), part)
