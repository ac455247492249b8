"""Designs that fill the space of the axes: Latin hypercubes, Sobol sequences, and those of Sobol indices."""

from __future__ import annotations

import functools
import inspect
import threading
import warnings
from abc import abstractmethod
from typing import Any, ClassVar

import numpy as np

from hrsafety._arguments import Array, checked_seed, count, flag
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, MissingExtraError
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep.designs import MOST_ROWS, Design
from hrsafety.sweep.strata import latin_shares

__all__ = ["LatinHypercube", "Saltelli", "Sobol"]

MOST_SOBOL_ROWS = 2**30
MOST_SOBOL_AXES = 21201
# Up to here a Latin hypercube is SciPy's, above it needs no memory for its permutations.
MOST_STORED_ROWS = 65536


def _stats() -> Any:
    """Return SciPy's module of quasi-random sequences."""
    try:
        from scipy.stats import qmc
    except ModuleNotFoundError:
        raise MissingExtraError("sampled designs need SciPy: pip install scipy") from None
    return qmc


def _engine(kind: str, axes: int, seed: int, **options: Any) -> Any:
    """Return one of SciPy's engines; its argument for the generator was renamed in SciPy 1.15."""
    make = getattr(_stats(), kind)
    name = "rng" if "rng" in inspect.signature(make.__init__).parameters else "seed"
    return make(axes, **{name: np.random.default_rng(seed)}, **options)


@dataclass(frozen=True, slots=True)
class _Sampled(Design):
    """Base of the designs that fill the space of the axes with a given number of rows."""

    size: int
    seed: int = 0

    def __post_init__(self) -> None:
        """Check the values."""
        Design.__post_init__(self)
        object.__setattr__(self, "size", count("size", self.size, most=MOST_ROWS))
        object.__setattr__(self, "seed", checked_seed("seed", self.seed))

    @abstractmethod
    def _shares(self, start: int, stop: int) -> Array:
        """Return rows in the unit cube."""

    def __len__(self) -> int:
        """Return the number of rows."""
        return self.size

    def _block(self, start: int, stop: int) -> Array:
        shares = self._shares(start, stop)
        return np.stack([axis.at(shares[:, index]) for index, axis in enumerate(self.axes)], axis=1)

    def settings(self) -> dict[str, Any]:
        """Return the fields for the manifest."""
        return {**Design.settings(self), "seed": self.seed}


@functools.lru_cache(maxsize=4)
def _latin_sample(axes: int, seed: int, size: int) -> Array:
    """Return a whole Latin hypercube of SciPy; kept, because its rows are asked for in ranges."""
    sample: Array = _engine("LatinHypercube", axes, seed).random(size)
    return sample


@dataclass(frozen=True, slots=True)
class LatinHypercube(_Sampled):
    """Random rows of which each falls into a stratum of its own on every axis.

    Up to 65,536 rows the design is that of ``scipy.stats.qmc.LatinHypercube`` with the same
    seed, which is kept in memory (8 bytes per row and axis). Longer ones come from keyed
    permutations that need no memory at all: every row can be computed by itself.

    Parameters
    ----------
    axes : sequence of Axis
        Ranges or values.
    size : int
        Number of rows.
    seed : int
        Which of the possible designs.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.
    MissingExtraError
        When rows are asked for, if SciPy is not installed and the design is not a long one.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import sweep
    >>> design = sweep.LatinHypercube([sweep.Axis(name="foam_damping", low=0.0, high=100.0)], 10, seed=1)
    >>> np.sort(design.rows()[:, 0] // 10.0).tolist()
    [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]
    """

    kind: ClassVar[str] = "latin_hypercube"

    def _shares(self, start: int, stop: int) -> Array:
        if self.size > MOST_STORED_ROWS:
            return latin_shares(self.size, len(self.axes), self.seed, start, stop)
        return _latin_sample(len(self.axes), self.seed, self.size)[start:stop]


@dataclass(frozen=True, slots=True)
class Sobol(_Sampled):
    """Rows of a scrambled Sobol sequence, those of ``scipy.stats.qmc.Sobol`` with the same seed.

    The sequence is balanced when the number of rows is a power of two; another number is accepted
    with a warning in ``warnings`` of design and result.

    Parameters
    ----------
    axes : sequence of Axis
        Ranges or values, at most 21201.
    size : int
        Number of rows, at most 2**30.
    seed : int
        Of the scrambling.
    scramble : bool
        Whether the sequence is scrambled; the plain one starts with a row of zeros.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.
    MissingExtraError
        When rows are asked for, if SciPy is not installed.

    Examples
    --------
    >>> from hrsafety import sweep
    >>> design = sweep.Sobol([sweep.Axis(name="foam_damping", low=0.0, high=100.0)], 8, scramble=False)
    >>> design.rows(2, 5).ravel().tolist()
    [75.0, 25.0, 37.5]
    """

    kind: ClassVar[str] = "sobol"
    scramble: bool = True

    def __post_init__(self) -> None:
        """Check the values."""
        _Sampled.__post_init__(self)
        flag("scramble", self.scramble)
        if self.size > MOST_SOBOL_ROWS:
            raise InvalidParameterError("size", "be at most 2**30 for a Sobol sequence", self.size)
        if len(self.axes) > MOST_SOBOL_AXES:
            raise InvalidParameterError("axes", f"be at most {MOST_SOBOL_AXES}", len(self.axes))

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Doubt that the sequence is not balanced, if its length is not a power of two."""
        below = 1 << (self.size.bit_length() - 1)
        if below == self.size:
            return ()
        above = f" or {2 * below}" if 2 * below <= MOST_SOBOL_ROWS else ""
        message = (
            f"size of the Sobol design is {self.size}, not a power of two: the rows do not fill the space evenly, so "
            f"means and shares over them are biased; take {below}{above} rows"
        )
        return (ResultWarning("unbalanced", "size", message),)

    def _shares(self, start: int, stop: int) -> Array:
        return _SEQUENCES.block((len(self.axes), self.seed, self.scramble), start, stop)

    def settings(self) -> dict[str, Any]:
        """Return the fields for the manifest."""
        return {**_Sampled.settings(self), "scramble": self.scramble}


@dataclass(frozen=True, slots=True)
class Saltelli(Design):
    """Rows from which `sobol_indices` finds how much of the variance each axis causes.

    Two independent tables A and B come from one scrambled Sobol sequence of twice the dimension. Row k of each is
    followed by row k of A with the values of one axis after the other from B: ``axes + 2`` rows for each of ``size``.

    Parameters
    ----------
    axes : sequence of Axis
        Ranges or values, at most 10600; independent of each other, each evenly distributed on its scale.
    size : int
        Rows of A: a power of two, at most 2**30.
    seed : int
        Of the scrambling.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.
    MissingExtraError
        When rows are asked for, if SciPy is not installed.

    Examples
    --------
    >>> from hrsafety import sweep
    >>> speed, mass = sweep.Axis(name="speed", low=0.1, high=1.0), sweep.Axis(name="mass", low=5.0, high=20.0)
    >>> design = sweep.Saltelli([speed, mass], 8)
    >>> a, b, speed_of_b, mass_of_b = design.rows(0, 4)
    >>> len(design), bool(speed_of_b[0] == b[0]), bool(speed_of_b[1] == a[1])
    (32, True, True)
    """

    size: int
    seed: int = 0
    kind: ClassVar[str] = "saltelli"

    def __post_init__(self) -> None:
        """Check the values."""
        Design.__post_init__(self)
        size = count("size", self.size, least=2, most=MOST_SOBOL_ROWS)
        if size & (size - 1):
            below = 1 << (size.bit_length() - 1)
            raise InvalidParameterError("size", "be a power of two", size, f"take {below} or {2 * below}")
        if 2 * len(self.axes) > MOST_SOBOL_AXES:
            raise InvalidParameterError("axes", f"be at most {MOST_SOBOL_AXES // 2}", len(self.axes))
        object.__setattr__(self, "size", size)
        object.__setattr__(self, "seed", checked_seed("seed", self.seed))

    def __len__(self) -> int:
        """Return the number of rows."""
        return self.size * (len(self.axes) + 2)

    def _block(self, start: int, stop: int) -> Array:
        axes, group = len(self.axes), len(self.axes) + 2
        first = start // group
        shares = _SEQUENCES.block((2 * axes, self.seed, True), first, -(-stop // group))
        both = [
            np.stack([axis.at(half[:, index]) for index, axis in enumerate(self.axes)], axis=1)
            for half in (shares[:, :axes], shares[:, axes:])
        ]
        rows = np.repeat(both[0][:, None], group, axis=1)
        rows[:, 1] = both[1]
        for index in range(axes):
            rows[:, 2 + index, index] = both[1][:, index]
        return rows.reshape(-1, axes)[start - first * group : stop - first * group]

    def settings(self) -> dict[str, Any]:
        """Return the fields for the manifest."""
        return {**Design.settings(self), "size": self.size, "seed": self.seed}


class _Sequences(threading.local):
    """The Sobol engine that was used last, one for each thread, so that the next draw costs nothing."""

    def __init__(self) -> None:
        self._key: tuple[int, int, bool] | None = None
        self._engine: Any = None

    def block(self, key: tuple[int, int, bool], start: int, stop: int) -> Array:
        """Return rows of the sequence with this number of axes, seed and scrambling."""
        if stop == start:
            return np.empty((0, key[0]))
        if key != self._key or self._engine.num_generated > start:
            axes, seed, scramble = key
            self._engine = _engine("Sobol", axes, seed, scramble=scramble)
            self._key = key
        if start > self._engine.num_generated:
            self._engine.fast_forward(start - self._engine.num_generated)
        with warnings.catch_warnings():
            # The balance depends on the whole design, not on the block that is asked for.
            warnings.filterwarnings("ignore", message="The balance properties of Sobol", category=UserWarning)
            sample: Array = self._engine.random(stop - start)
        return sample


_SEQUENCES = _Sequences()
