"""Checks of arguments for parameter classes and functions, and pickling by value."""

from __future__ import annotations

import dataclasses
import itertools
import math
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
import numpy.typing as npt

from hrsafety._bounds import MOST_COUNT, MOST_THREADS
from hrsafety._words import meant as meant  # for those who check arguments
from hrsafety.errors import InvalidParameterError, ShapeError, Shown

if TYPE_CHECKING:
    from os import PathLike
    from pathlib import Path

    from typing_extensions import TypeIs

Array = npt.NDArray[np.float64]
Pair = tuple[float, float]
Kind = TypeVar("Kind")
Each = TypeVar("Each")
Scalar = TypeVar("Scalar", np.float64, np.uint64)
Call = TypeVar("Call", bound=Callable[..., object])


LONGEST_SHOWN = 200
"""Characters of a path that a message shows."""


COPIED_AT_ONCE = 1 << 25
"""Bytes of a large array that are copied at once."""

MOST_AXES = 16
"""Axes of an array: NumPy lays at most 32 beside each other, of which results need some themselves."""

# Looked up once: studies construct parameters by the million.
assign = object.__setattr__


class Parameters:
    """Base of the frozen parameter classes.

    A subclass builds ``_native`` in ``__post_init__``; the native constructor checks every
    value, so an instance that exists is valid. Equality, hashing and printing use the public
    fields only.
    """

    __slots__ = ()

    def _set(self, **values: object) -> None:
        """Write fields of a frozen instance during construction."""
        for name, value in values.items():
            assign(self, name, value)

    def _converted(self, **values: object) -> None:
        """Write fields whose checked values are other objects than those given, which is seldom so."""
        for name, value in values.items():
            if value is not getattr(self, name):
                assign(self, name, value)

    def _as_numbers(self, *names: str) -> dict[str, float]:
        """Turn fields into floats, and return them by name."""
        values = {name: number(name, getattr(self, name)) for name in names}
        self._set(**values)
        return values

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle by public fields; the native counterpart is built again on load."""
        fields = {
            field.name: getattr(self, field.name)
            for field in dataclasses.fields(self)  # type: ignore[arg-type]  # subclasses are dataclasses
            if field.init
        }
        return _rebuild, (type(self), fields)


def _rebuild(kind: type, fields: dict[str, object]) -> object:
    return kind(**fields)


def number(name: str, value: object) -> float:
    """Return ``value`` as a float, or say what it should have been."""
    if type(value) is float:  # nearly always
        return value
    # What NumPy holds passes for a plain number whatever it is: durations in ns a billion times too large, words,
    # truth values, and complex numbers without their imaginary part; as scalars and as arrays without an axis.
    kind = getattr(getattr(value, "dtype", None), "kind", "f")
    if isinstance(value, (bool, str, bytes)) or kind in "bcmMOSU":
        raise InvalidParameterError(name, "be a number", value)
    refuse_masked(name, value)
    try:
        return float(value)  # type: ignore[arg-type]  # the failure is the check
    except (TypeError, ValueError, OverflowError):
        raise InvalidParameterError(name, "be a number", value) from None


def refuse_masked(name: str, value: object) -> None:
    """Refuse masked values: without their mask they would be numbers that were ruled out."""
    # Importing them takes longer than checking all arguments of a program; whoever has one has imported them.
    # Another thread may be importing them: until it has, nobody has one.
    kind = getattr(sys.modules.get("numpy.ma"), "MaskedArray", None)
    if kind is None or not isinstance(value, kind):
        return
    masked = int(np.count_nonzero(np.ma.getmaskarray(value)))
    if masked:
        shown = Shown(f"{masked} masked of {value.size}")
        raise InvalidParameterError(name, "have no masked values", shown, "leave them out with .compressed()")


def positive(name: str, value: object) -> float:
    """Return ``value`` as a finite float above zero, or say that it should have been."""
    given = number(name, value)
    if not 0.0 < given < np.inf:
        raise InvalidParameterError(name, "be finite and positive", value)
    return given


def not_negative(name: str, value: object) -> float:
    """Return ``value`` as a finite float that is not below zero, or say that it should have been."""
    given = number(name, value)
    if not 0.0 <= given < np.inf:
        raise InvalidParameterError(name, "be finite and not negative", value)
    return given


def finite(name: str, value: object) -> float:
    """Return ``value`` as a finite float, or say that it should have been."""
    given = number(name, value)
    if not math.isfinite(given):
        raise InvalidParameterError(name, "be finite", value)
    return given


def flag(name: str, value: object) -> bool:
    """Return ``value`` if it is a truth value, or say that it should have been."""
    if not isinstance(value, (bool, np.bool_)):
        raise InvalidParameterError(name, "be True or False", value)
    return bool(value)


def _is_whole(value: object) -> TypeIs[int | np.integer[Any]]:
    """Return whether ``value`` is an integer; to Python truth values are some, to NumPy durations are."""
    return isinstance(value, (int, np.integer)) and not isinstance(value, (bool, np.timedelta64))


def count(name: str, value: object, *, least: int = 1, most: int = MOST_COUNT) -> int:
    """Return ``value`` if it is an integer within the bounds, or say that it should have been."""
    if not _is_whole(value) or not least <= value <= most:
        # The largest count of all is no news to who gave a word.
        wide = most == MOST_COUNT and not (_is_whole(value) and value > most)
        rule = f"be an integer of at least {least}" if wide else f"be an integer from {least} to {most}"
        raise InvalidParameterError(name, rule, value)
    return int(value)


def thread_count(value: object) -> int | None:
    """Return the number of threads if a pool may have so many; ``None`` stands for all cores."""
    return None if value is None else count("threads", value, most=MOST_THREADS)


def whole_steps(name: str, duration: float, step: float, most: int) -> float:
    """Return how many steps a duration holds, not rounded; more than the bound are refused by name."""
    steps = duration / step if step > 0.0 else np.inf
    if not steps <= most:
        raise InvalidParameterError(name, f"be at most {most} steps of {step!r} s", duration)
    return steps


def checked_seed(name: str, value: object) -> int:
    """Return ``value`` if random numbers can start from it, or say what it should have been."""
    if not _is_whole(value) or not 0 <= value < 2**64:
        raise InvalidParameterError(name, "be an integer from 0 to 2**64 - 1", value)
    return int(value)


def word(name: str, value: object, words: Sequence[str]) -> str:
    """Return ``value`` if it is one of the words, or list them and name the nearest."""
    if not isinstance(value, str) or value not in words:
        shown = ", ".join(f'"{each}"' for each in words)
        raise InvalidParameterError(name, f"be one of {shown}", value, meant(value, words))
    return value


def checked_text(name: str, value: object, rule: str) -> str:
    """Return ``value`` if it is text that files and the cores can hold, or say what it should have been."""
    if not isinstance(value, str):
        raise InvalidParameterError(name, rule, value)
    try:
        value.encode()
    except UnicodeEncodeError:
        raise InvalidParameterError(name, "be text that UTF-8 can hold", value) from None
    return value


def readable(name: str, path: str | PathLike[str]) -> Path:
    """Return the path if a file stands there, or say what does and which file may have been meant."""
    from pathlib import Path  # for those who read files; it takes as long to load as all that a run needs

    rule = "name a readable file"
    try:
        path = Path(path)
    except TypeError:
        raise InvalidParameterError(name, rule, path) from None
    given = str(path) if len(str(path)) <= LONGEST_SHOWN else f"{str(path)[:LONGEST_SHOWN]}..."
    try:
        if path.is_file():
            return path
        if path.is_dir():
            raise InvalidParameterError(name, rule, given, "this is a folder")
        if path.exists():
            raise InvalidParameterError(name, rule, given, "this is no regular file")
        if path.is_symlink():
            raise InvalidParameterError(name, rule, given, "this is a link that leads to no file")
    except OSError as error:
        raise InvalidParameterError(name, rule, Shown(f"{given} ({error.strerror})")) from None
    raise InvalidParameterError(name, rule, given, _neighbour(path))


def _neighbour(path: Path) -> str:
    """Return which file beside a missing one may have been meant, else where it was looked for."""
    folder = path.parent
    try:
        if not folder.is_dir():
            return f"there is no folder {folder}"
        names = [each.name for each in itertools.islice(folder.iterdir(), 1000)]
    except (OSError, ValueError):
        return "it cannot be looked for"
    # Endings alone make names alike, and are no reason to ask.
    alike = [each for each in names if meant(path.stem, [type(path)(each).stem])]
    return meant(path.name, alike) or f"no such file in {folder.absolute()}"


def callback(name: str, value: Call | None) -> Call | None:
    """Return ``value`` if it can be called or is ``None``."""
    if value is not None and not callable(value):
        raise InvalidParameterError(name, "be callable or None", value)
    return value


def followed(items: Sequence[Each], progress: Callable[[int, int], object] | None) -> Iterator[Each]:
    """Yield elements and call ``progress`` with (done, all), at the start and whenever one is done."""
    told = callback("progress", progress)
    for done, each in enumerate(items):
        if told is not None:
            told(done, len(items))
        yield each
    if told is not None:
        told(len(items), len(items))


def with_article(noun: str) -> str:
    """Return a noun after ``a`` or ``an``, by its first letter."""
    return f"an {noun}" if noun[:1] in tuple("AEIOUaeiou") else f"a {noun}"


def instance(name: str, value: object, *kinds: type[Kind]) -> Kind:
    """Return ``value`` if it is of one of the kinds, or say that it should have been."""
    if not isinstance(value, kinds):
        words = " or ".join(kind.__name__ for kind in kinds)
        raise InvalidParameterError(name, f"be {with_article(words)}", value)
    return value


def sequence(name: str, rule: str, value: object) -> list[Any]:
    """Return the elements of ``value``, or say what it should have been."""
    if type(value) is list or type(value) is tuple:  # nearly always
        return list(value)
    if isinstance(value, (str, bytes)) or not isinstance(value, Iterable):
        raise InvalidParameterError(name, rule, value)
    try:
        return list(value)
    except TypeError:  # an array without an axis
        raise InvalidParameterError(name, rule, value) from None


def numbers(name: str, value: object, rule: str = "be a number or an array of numbers") -> Array:
    """Return ``value`` as a contiguous array; words, None and complex numbers are refused."""
    refuse_masked(name, value)
    if isinstance(value, (list, tuple)):
        for each in value:
            refuse_masked(name, each)
    try:
        array = np.asarray(value)
    except (TypeError, ValueError):
        raise InvalidParameterError(name, rule, value) from None
    if array.dtype.kind not in "fiu":
        raise InvalidParameterError(name, rule, value)
    if array.ndim > MOST_AXES:
        raise InvalidParameterError(name, f"have at most {MOST_AXES} axes", Shown(f"{array.ndim} axes"))
    # The cores read whole floats at their places in memory: other arrays are copied.
    whole = np.ascontiguousarray(array, dtype=np.float64).reshape(array.shape)
    return whole if whole.flags.aligned else whole.copy()


def own(array: npt.NDArray[Scalar]) -> npt.NDArray[Scalar]:
    """Return a copy that cannot change: what was checked stays, though the arrays of the user are filled again."""
    kept = np.empty(array.shape, array.dtype)
    if array.nbytes <= COPIED_AT_ONCE:
        kept[...] = array
    else:  # a long copy in parts, between which Ctrl-C is answered
        whole = array.flags.c_contiguous
        target, source = (kept.reshape(-1), array.reshape(-1)) if whole else (kept, array)
        step = max(len(source) * COPIED_AT_ONCE // array.nbytes, 1)
        for first in range(0, len(source), step):
            target[first : first + step] = source[first : first + step]
    kept.flags.writeable = False
    return kept


def empty(name: str, value: object, rule: str = "be an array of numbers") -> bool:
    """Return whether ``value`` holds nothing; rows of different lengths are refused."""
    try:
        return np.size(value) == 0  # type: ignore[arg-type]  # the failure is the check
    except (TypeError, ValueError):
        raise InvalidParameterError(name, rule, value) from None


def vector(name: str, value: object) -> Array:
    """Return ``value`` as a contiguous (n,) array, or say what it should have been."""
    array = numbers(name, value)
    if array.ndim != 1:
        raise ShapeError(name, "(n,)", array.shape)
    return array


def pair(name: str, value: object) -> Pair:
    """Return ``value`` as two floats, or say what it should have been."""
    if type(value) is tuple and len(value) == 2 and type(value[0]) is type(value[1]) is float:  # nearly always
        return value
    array = numbers(name, value, "be a pair (x, y) of numbers")
    if array.shape != (2,):
        raise ShapeError(name, "(2,)", array.shape)
    return (float(array[0]), float(array[1]))


def finite_pair(name: str, value: object) -> Pair:
    """Return ``value`` as two finite floats, or say what it should have been."""
    given = pair(name, value)
    if not np.isfinite(given).all():
        raise InvalidParameterError(name, "be two finite numbers", given)
    return given


def points(name: str, value: object) -> Array:
    """Return ``value`` as a contiguous (n, 2) array, or say what it should have been."""
    array = numbers(name, value, "be an array of numbers")
    if array.ndim != 2 or array.shape[1] != 2:
        raise ShapeError(name, "(n, 2)", array.shape)
    return array


def columns(**values: object) -> tuple[Array, ...]:
    """Return the values as contiguous arrays of one length, or name the one that is not."""
    arrays = {name: vector(name, value) for name, value in values.items()}
    first = next(iter(arrays.values()))
    for name, array in arrays.items():
        if array.shape != first.shape:
            raise ShapeError(name, f"({len(first)},)", array.shape)
    return tuple(arrays.values())


def square(name: str, value: object, size: int) -> Array:
    """Return ``value`` as a contiguous (size, size) array, or say what it should have been."""
    array = numbers(name, value)
    if array.shape != (size, size):
        raise ShapeError(name, f"({size}, {size})", array.shape)
    return array
