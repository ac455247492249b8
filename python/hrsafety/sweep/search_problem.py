"""Searches of other packages over the rows of a study: Optuna, cma, pymoo ask, this evaluates and tells."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import Any, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, count, numbers, word
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, MissingExtraError, ShapeError
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep.axes import Axis, Column
from hrsafety.sweep.designs import MOST_LOOKED_AT
from hrsafety.sweep.sampled_designs import LatinHypercube
from hrsafety.sweep.studies import Study, checked_study

__all__ = ["Generation", "SearchProblem"]

Goal = Literal["min", "max"]
MOST_AT_ONCE = 1_000_000
# The last share of the way along an axis; shares are below 1.
_LAST = float(np.nextafter(1.0, 0.0))


@displayed
class Generation(NamedTuple):
    """Points that a search asked for, and what they gave.

    Attributes
    ----------
    points : ndarray of shape (n, d)
        A column for each axis, in its unit.
    values : ndarray of shape (n, m)
        A column for each objective, in its unit; NaN where a point does not count.
    """

    points: Array
    values: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchProblem:
    """A study as the problem of a search: which axes may vary, and what is wanted.

    `step` asks an optimizer of another package for points, computes them in one call of the study, and tells it the
    values.

    Parameters
    ----------
    axes : sequence of Axis
        What varies.
    study : ImpactStudy, NavigationStudy, FunctionStudy
        What is computed. Of several cases of a row the worst one counts.
    objectives : mapping of str to {"min", "max"}
        Columns of numbers and which end is wanted.
    require : mapping of str to str or bool
        Words or flags that every case of a row must have, such as ``{"outcome": "arrived"}``. A row without them, or
        with an objective that is not finite, does not count: it is a failed trial to Optuna, and infinitely bad to cma
        and pymoo.

    Raises
    ------
    InvalidParameterError
        If a name is unknown to the study, or a column is of the wrong kind.

    Examples
    --------
    >>> from hrsafety import sweep
    >>> def cost(x, y):
    ...     return {"cost": (x - 1.0) ** 2 + y**2}
    >>> axes = [sweep.Axis(name=name, low=-2.0, high=2.0) for name in "xy"]
    >>> study = sweep.FunctionStudy(function=cost, results=["cost"])
    >>> problem = sweep.SearchProblem(axes=axes, study=study, objectives={"cost": "min"})
    >>> problem.evaluate([[0.75, 0.5], [0.5, 0.5]]).values.ravel().tolist()
    [0.0, 1.0]
    """

    axes: tuple[Axis, ...]
    study: Study
    objectives: Mapping[str, Goal]
    require: Mapping[str, str | bool] | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        checked_study(self.study)
        design = LatinHypercube(self.axes, MOST_LOOKED_AT)
        object.__setattr__(self, "axes", design.with_units(self.study.units(design.names)).axes)
        known = {column.name: column for column in self.study.columns()}
        goals = _mapping("objectives", self.objectives)
        if not goals:
            raise InvalidParameterError("objectives", "name at least one column", goals)
        for name, goal in goals.items():
            word("objectives", name, tuple(known))
            word(f"objectives[{name!r}]", goal, ("min", "max"))
            if known[name].kind not in ("number", "integer"):
                raise InvalidParameterError("objectives", "be columns of numbers", name, "put it into require")
        wanted = _mapping("require", {} if self.require is None else self.require)
        for name, value in wanted.items():
            _check_required(known[word("require", name, tuple(known))], value)
        object.__setattr__(self, "objectives", goals)
        object.__setattr__(self, "require", wanted)

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Doubts of the study about 64 points from all over the axes, as `run` finds them."""
        return self.study.judged(LatinHypercube(self.axes, MOST_LOOKED_AT))

    def evaluate(self, shares: npt.ArrayLike, *, threads: int | None = None) -> Generation:
        """Compute points in one call of the study.

        Parameters
        ----------
        shares : array_like, shape (n, d)
            Shares of the way along each axis on its scale, from 0 to 1.
        threads : int or None
            Number of threads; all cores when ``None``.

        Returns
        -------
        Generation
            Points and values in their units.

        Raises
        ------
        InvalidParameterError
            If a share is outside 0 to 1.
        ShapeError
            If there is not one column for each axis.
        """
        given = numbers("shares", shares)
        if given.ndim != 2 or given.shape[1] != len(self.axes):
            raise ShapeError("shares", f"(n, {len(self.axes)})", given.shape)
        if len(given) > MOST_AT_ONCE:
            raise InvalidParameterError("shares", f"be at most {MOST_AT_ONCE} points", len(given))
        if not ((given >= 0.0) & (given <= 1.0)).all():
            raise InvalidParameterError("shares", "be from 0 to 1", given[~((given >= 0.0) & (given <= 1.0))][0])
        inside = np.minimum(given, _LAST)
        points = np.stack([axis.at(inside[:, index]) for index, axis in enumerate(self.axes)], axis=1)
        if not len(points):
            return Generation(points, np.empty((0, len(self.objectives))))
        rows = {axis.name: points[:, index].copy() for index, axis in enumerate(self.axes)}
        found = self.study.compute(rows, threads)
        cases = {name: np.asarray(column).reshape(len(points), -1) for name, column in found.items()}
        values = np.stack(
            [
                cases[name].astype(np.float64).max(axis=1)
                if goal == "min"
                else cases[name].astype(np.float64).min(axis=1)
                for name, goal in self.objectives.items()
            ],
            axis=1,
        )
        counts = np.isfinite(values).all(axis=1)
        for name, wanted in (self.require or {}).items():
            counts &= (cases[name] == wanted).all(axis=1)
        return Generation(points, np.where(counts[:, None], values, np.nan))

    def step(self, optimizer: Any, *, size: int | None = None, threads: int | None = None) -> Generation:
        """Ask an optimizer for points, compute them, and tell it what they gave.

        Parameters
        ----------
        optimizer : optuna.Study, cma.CMAEvolutionStrategy or a pymoo Algorithm
            Optuna: ``optuna.create_study(directions=...)`` with one direction for each objective. cma: of as many
            variables as there are axes, within ``"bounds": [0, 1]``; it minimizes one objective. pymoo: set up with
            `pymoo_problem`.
        size : int or None
            Points to ask for; the others say it themselves, Optuna takes 32 when ``None``.
        threads : int or None
            Number of threads; all cores when ``None``.

        Returns
        -------
        Generation
            Points and values in their units, also when the optimizer minimizes the negative.

        Raises
        ------
        InvalidParameterError
            If the optimizer is of another package, or of other directions or variables.

        Examples
        --------
        >>> import optuna
        >>> from hrsafety import sweep
        >>> def cost(x):
        ...     return {"cost": (x - 1.0) ** 2}
        >>> study = sweep.FunctionStudy(function=cost, results=["cost"])
        >>> axes = [sweep.Axis(name="x", low=-2.0, high=2.0)]
        >>> problem = sweep.SearchProblem(axes=axes, study=study, objectives={"cost": "min"})
        >>> optuna.logging.set_verbosity(optuna.logging.WARNING)
        >>> search = optuna.create_study(sampler=optuna.samplers.TPESampler(seed=1))
        >>> for _ in range(4):
        ...     generation = problem.step(search, size=16)
        >>> search.best_value < 0.01
        True
        """
        packages = {each.__module__.partition(".")[0] for each in type(optimizer).__mro__}
        if size is not None:
            size = count("size", size, most=MOST_AT_ONCE)
        if "optuna" in packages and hasattr(optimizer, "ask"):
            return self._of_optuna(optimizer, size or 32, threads)
        if size is not None:
            raise InvalidParameterError("size", "be None: the optimizer has its own", size)
        if "cma" in packages and hasattr(optimizer, "ask"):
            return self._of_cma(optimizer, threads)
        if "pymoo" in packages and hasattr(optimizer, "ask"):
            return self._of_pymoo(optimizer, threads)
        kinds = "be an optuna.Study, a cma.CMAEvolutionStrategy or an Algorithm of pymoo"
        raise InvalidParameterError("optimizer", kinds, type(optimizer).__name__)

    def pymoo_problem(self) -> Any:
        """Return a problem of pymoo to set up one of its algorithms with.

        Returns
        -------
        pymoo.core.problem.Problem
            Of shares of the way along the axes. It minimizes: objectives that are wanted large are negative.

        Raises
        ------
        MissingExtraError
            If pymoo is not installed.
        """
        try:
            problem: Any = importlib.import_module("pymoo.core.problem").Problem
        except ModuleNotFoundError:
            raise MissingExtraError("a problem of pymoo needs pymoo: pip install pymoo") from None
        owner = self

        class Shares(problem):  # type: ignore[misc]  # known when it runs
            def __init__(self) -> None:
                super().__init__(n_var=len(owner.axes), n_obj=len(owner.objectives), xl=0.0, xu=1.0)

            def _evaluate(self, x: Array, out: dict[str, Any], *_given: object, **_named: object) -> None:
                out["F"] = owner._costs(owner.evaluate(x).values)

        return Shares()

    def _costs(self, values: Array) -> Array:
        """Return what is minimized: the values, negative where large ones are wanted, infinite where none counts."""
        signs = np.array([1.0 if goal == "min" else -1.0 for goal in self.objectives.values()])
        return np.where(np.isnan(values), np.inf, signs * values)

    def _of_optuna(self, study: Any, size: int, threads: int | None) -> Generation:
        optuna = importlib.import_module("optuna")
        told = [str(each.name).lower()[:3] for each in study.directions]
        if told != list(self.objectives.values()):
            raise InvalidParameterError("optimizer", f"have the directions {list(self.objectives.values())}", told)
        asked = {axis.name: optuna.distributions.FloatDistribution(0.0, 1.0) for axis in self.axes}
        trials = [study.ask(asked) for _ in range(size)]
        shares = [[trial.params[axis.name] for axis in self.axes] for trial in trials]
        generation = self.evaluate(shares, threads=threads)
        for trial, point, values in zip(trials, generation.points, generation.values, strict=True):
            for axis, value in zip(self.axes, point.tolist(), strict=True):
                trial.set_user_attr(axis.name, value)
            if np.isnan(values).any():
                study.tell(trial, state=optuna.trial.TrialState.FAIL)
            else:
                study.tell(trial, values.tolist())
        return generation

    def _of_cma(self, strategy: Any, threads: int | None) -> Generation:
        if len(self.objectives) != 1:
            raise InvalidParameterError("objectives", "be one for cma", list(self.objectives), "take Optuna or pymoo")
        asked = strategy.ask()
        generation = self.evaluate(asked, threads=threads)
        strategy.tell(asked, self._costs(generation.values)[:, 0].tolist())
        return generation

    def _of_pymoo(self, algorithm: Any, threads: int | None) -> Generation:
        asked = algorithm.ask()
        shares = asked.get("X")
        generation = self.evaluate(shares, threads=threads)
        static = importlib.import_module("pymoo.problems.static").StaticProblem
        evaluator = importlib.import_module("pymoo.core.evaluator").Evaluator
        evaluator().eval(static(algorithm.problem, F=self._costs(generation.values)), asked)
        algorithm.tell(infills=asked)
        return generation


def _mapping(name: str, value: object) -> dict[str, Any]:
    if not isinstance(value, Mapping):
        raise InvalidParameterError(name, "be a mapping of columns", value)
    return dict(value)


def _check_required(column: Column, value: object) -> None:
    """Find out whether a column can have a required value."""
    if column.kind == "word":
        word(f"require[{column.name!r}]", value, column.words)
    elif column.kind == "flag":
        if not isinstance(value, bool):
            raise InvalidParameterError(f"require[{column.name!r}]", "be True or False", value)
    else:
        raise InvalidParameterError("require", "name columns of words or flags", column.name)
