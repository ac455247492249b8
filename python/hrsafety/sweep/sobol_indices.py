"""Sobol indices: which share of the variance of a result each axis causes."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np

from hrsafety._arguments import Array, checked_seed, count, instance, number, word
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, MissingExtraError, Shown
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep.result import SweepResult
from hrsafety.sweep.sampled_designs import Saltelli

__all__ = ["SobolIndices", "sobol_indices"]

MOST_RESAMPLES = 100_000
# Beyond this width an interval does not tell an axis that matters from one that does not.
WIDEST = 0.2


@displayed
@dataclass(frozen=True, slots=True, kw_only=True)
class SobolIndices:
    """Sobol indices of one result, with intervals.

    Attributes
    ----------
    column : str
        The result whose variance is divided.
    axes : tuple of str
        Names of the axes.
    first : ndarray of shape (d,)
        Share of the variance that each axis causes alone.
    total : ndarray of shape (d,)
        Share that each axis causes alone and together with others; at least the first one, but for the error of
        sampling.
    first_interval, total_interval : ndarray of shape (d, 2)
        Lower and upper end by the bootstrap.
    confidence : float
        Probability that an interval covers the index.
    variance : float
        Of the result, in its unit squared.
    warnings : tuple of ResultWarning
        Doubts of the sweep, and intervals that are too wide to rank axes by.
    """

    column: str
    axes: tuple[str, ...]
    first: Annotated[Array, ""]
    total: Annotated[Array, ""]
    first_interval: Annotated[Array, ""]
    total_interval: Annotated[Array, ""]
    confidence: float
    variance: float
    warnings: tuple[ResultWarning, ...]


def sobol_indices(
    result: SweepResult, column: str, *, confidence: float = 0.95, resamples: int = 500, seed: int = 0
) -> SobolIndices:
    """Return first and total Sobol indices of a column of a sweep, by ``scipy.stats.sobol_indices``.

    The axes count as independent, and as evenly distributed on their scales: the indices hold for these ranges and no
    others.

    Parameters
    ----------
    result : SweepResult
        Complete, of a `Saltelli` design.
    column : str
        A number or a flag for each row; flags count as 0 and 1.
    confidence : float
        Probability that an interval covers the index, between 0 and 1.
    resamples : int
        Resamples of the bootstrap, 10 to 100,000.
    seed : int
        Of the bootstrap.

    Returns
    -------
    SobolIndices
        One index for each axis.

    Raises
    ------
    InvalidParameterError
        If the result is not complete or of another design, has several cases, or the column holds words, does not
        vary, or holds values that are not finite: a share of the variance of the rest would leave out just these rows.
    MissingExtraError
        If SciPy is not installed.

    Examples
    --------
    >>> from hrsafety import sweep
    >>> def stopping(speed, deceleration):
    ...     return {"distance": speed**2 / (2.0 * deceleration)}
    >>> study = sweep.FunctionStudy(function=stopping, results=["distance"])
    >>> axes = [sweep.Axis(name="speed", low=0.5, high=1.0), sweep.Axis(name="deceleration", low=2.0, high=2.2)]
    >>> found = sweep.sobol_indices(sweep.run(sweep.Saltelli(axes, 256), study), "distance")
    >>> found.axes, found.total.round(2).tolist()
    (('speed', 'deceleration'), [0.99, 0.01])
    """
    try:
        from scipy.stats import sobol_indices as of_values
    except ModuleNotFoundError:
        raise MissingExtraError("Sobol indices need SciPy: pip install scipy") from None
    instance("result", result, SweepResult)
    level = number("confidence", confidence)
    if not 0.0 < level < 1.0:
        raise InvalidParameterError("confidence", "be between 0 and 1", confidence)
    times = count("resamples", resamples, least=10, most=MOST_RESAMPLES)
    generator = np.random.default_rng(checked_seed("seed", seed))
    tables = _tables(result, column)

    def indices(of: Any) -> tuple[Array, Array]:
        values: dict[str, Any] = {name: table[..., of] for name, table in tables.items()}
        found = of_values(func=values, n=size)
        return found.first_order[:axes], found.total_order[:axes]

    size, axes = tables["f_A"].shape[-1], len(tables["f_AB"])
    if axes == 1:  # SciPy cannot have one alone
        tables["f_AB"] = np.repeat(tables["f_AB"], 2, axis=0)
    first, total = indices(slice(None))
    drawn = np.array([indices(generator.integers(size, size=size)) for _ in range(times)])
    tail = 0.5 * (1.0 - level)
    low, high = np.quantile(drawn, [tail, 1.0 - tail], axis=0)
    intervals = np.stack([low, high], axis=-1)
    width = float((intervals[1, :, 1] - intervals[1, :, 0]).max())
    doubts = result.warnings
    if width > WIDEST:
        message = (
            f"intervals of the total indices of {column!r} are up to {width:.2g} wide: do not rank axes whose "
            f"intervals overlap; take a larger size than {size}"
        )
        doubts = (*doubts, ResultWarning("wide_interval", column, message))
    return SobolIndices(
        column=column,
        axes=result.design.names,
        first=first,
        total=total,
        first_interval=intervals[0],
        total_interval=intervals[1],
        confidence=level,
        variance=float(np.var(np.concatenate([tables["f_A"], tables["f_B"]], axis=-1))),
        warnings=doubts,
    )


def _tables(result: SweepResult, column: str) -> dict[str, Array]:
    """Return the values over A, over B (each (1, n)), and over A with one axis of B, (axes, 1, n)."""
    design = result.design
    if not isinstance(design, Saltelli):
        raise InvalidParameterError("result", "be of a Saltelli design", design.kind)
    if not result.complete:
        done = Shown(f"{len(result.finished)} of {result.chunk_count} chunks")
        raise InvalidParameterError("result", "be complete", done, "run the same sweep again, it resumes")
    if result.cases:
        raise InvalidParameterError(
            "result", "have one case for each row", result.cases, "sweep one scenario at a time"
        )
    found = {each.name: each for each in result.found}
    word("column", column, tuple(found))
    if found[column].kind == "word":
        raise InvalidParameterError("column", "hold numbers or flags", column)
    values = result[column].astype(np.float64)
    bad = int(np.count_nonzero(~np.isfinite(values)))
    if bad:
        holes = Shown(f"{bad} of {len(values)} rows that are not")
        remedy = "narrow the axes, or take a column that every row has"
        raise InvalidParameterError(f"column {column!r}", "be finite in every row", holes, remedy)
    if np.ptp(values) == 0.0:
        raise InvalidParameterError(f"column {column!r}", "vary over the axes", float(values[0]))
    by_row = values.reshape(design.size, -1).T
    return {"f_A": by_row[:1], "f_B": by_row[1:2], "f_AB": by_row[2:, None]}
