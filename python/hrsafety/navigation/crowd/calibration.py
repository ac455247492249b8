"""Parameters of a model of people from a recording."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from types import MappingProxyType

import numpy as np

from hrsafety._arguments import Array, callback, checked_seed, count, instance, pair, positive, sequence, thread_count
from hrsafety._arguments import word as checked_word
from hrsafety._bounds import MOST_EVALUATIONS
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.crowd.pedestrians import Pedestrian
from hrsafety.navigation.crowd.predictions import PredictionErrors, Windows, errors_of, of_recording
from hrsafety.navigation.metrics.episode import Recorded
from hrsafety.navigation.run_arguments import Progress
from hrsafety.plausibility import telling
from hrsafety.tables import Columns, Table

__all__ = ["PeopleFit", "fit_people"]

Costs = Callable[[Array], Array]

RANGE = 10.0
"""Factor by which a parameter may differ from the one of the model, both ways, where no bounds are given."""
SHARE, CROSSING = 0.6, 0.9
"""Weight of differences and share of coordinates that are changed, of differential evolution."""


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class PeopleFit(Table):
    """A model of people with parameters from a recording; made by `fit_people`.

    Attributes
    ----------
    model : Pedestrian
        With the parameters that were found.
    start : Pedestrian
        As it was given.
    values : mapping of str to float
        The parameters that were found, by name.
    fitted, held_out : PredictionErrors
        Errors of the model in the first half of the windows, from which the parameters are, and in the other.
    start_fitted, start_held_out : PredictionErrors
        The same of the model as it was given.
    evaluations : int
        How many sets of parameters were tried.
    """

    model: Pedestrian
    start: Pedestrian
    values: Mapping[str, float]
    fitted: PredictionErrors
    held_out: PredictionErrors
    start_fitted: PredictionErrors
    start_held_out: PredictionErrors
    evaluations: int

    def columns(self) -> Columns:
        """Return one-dimensional columns by name: the model as given and as found, in both halves.

        Returns
        -------
        dict of str to ndarray
            A row for each model and half.
        """
        rows = (self.start_fitted, self.start_held_out, self.fitted, self.held_out)
        return {
            "parameters": np.array(["given", "given", "found", "found"]),
            "windows_of": np.array(["fit", "held out"] * 2),
            "windows": np.array([row.windows for row in rows]),
            "one_step_m": np.array([row.one_step for row in rows]),
            "average_m": np.array([row.average for row in rows]),
            "final_m": np.array([row.final for row in rows]),
        }


@telling(of_recording)
def fit_people(
    model: Pedestrian,
    recording: Recorded,
    names: Sequence[str],
    *,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    seen: float = 3.2,
    foretold: float = 4.8,
    every: float = 1.6,
    radius: float = 0.2,
    evaluations: int = 400,
    seed: int = 0,
    threads: int | None = None,
    progress: Progress | None = None,
) -> PeopleFit:
    """Return a model of people with the parameters that foretell a recording best.

    The mean error over all instants that are foretold (`prediction_errors`) is minimized in the first half
    of the windows by differential evolution over the logarithms of the parameters; the other half is held
    out, without the windows that share an instant with one of the first half. People may be in both halves:
    another recording is the stricter test.

    Parameters
    ----------
    model : Pedestrian
        Where the search starts; the other parameters stay.
    recording : Recording
        People at equal instants; any object with ``time_s``, ``person`` and ``position``.
    names : sequence of str
        Parameters that are fitted, each positive.
    bounds : mapping of str to (low, high) or None
        Positive bounds of parameters; a tenth of the one of the model to ten times as much where not given.
    seen, foretold, every, radius
        As of `prediction_errors`.
    evaluations : int
        How many sets of parameters are tried at most, at least 20 for each parameter.
    seed : int
        Seed of the search.
    threads : int or None
        Number of threads; all cores when ``None``. Never changes a bit of the result.
    progress : callable or None
        Progress callback ``(done, total)``.

    Returns
    -------
    PeopleFit
        The model, and its errors in both halves.

    Raises
    ------
    InvalidParameterError
        If a name is no positive parameter of the model, bounds are not in order, or as `prediction_errors`.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import datasets, navigation as nav
    >>> time, person = np.repeat(0.4 * np.arange(60), 2), np.tile([1, 2], 60)
    >>> place = np.column_stack([1.2 * time, 0.8 * person])
    >>> walk = datasets.Recording(time_s=time, person=person, position=place)
    >>> found = nav.crowd.fit_people(nav.crowd.SocialForce2000(), walk, ["strength"], evaluations=20)
    >>> found.fitted.average <= found.start_fitted.average
    True
    """
    instance("model", model, Pedestrian)
    box = _box(model, names, bounds)
    windows = Windows.of(recording, seen=seen, foretold=foretold, every=every)
    tried = count("evaluations", evaluations, least=20 * len(box), most=MOST_EVALUATIONS)
    halves = windows.part("first"), windows.part("second")
    body, workers = positive("radius", radius), thread_count(threads)
    report = callback("progress", progress)

    def costs(points: Array) -> Array:
        models = [_with(model, list(box), point) for point in points]
        return np.array([each.average for each in errors_of(models, halves[0], radius=body, threads=workers)])

    generator = np.random.Generator(np.random.PCG64(checked_seed("seed", seed)))
    first = np.log([getattr(model, name) for name in box])
    best = _search(costs, first, np.log(list(box.values())), tried, generator, report)
    found = _with(model, list(box), best)
    errors = [errors_of([model, found], half, radius=body, threads=workers) for half in halves]
    return PeopleFit(
        model=found,
        start=model,
        values=MappingProxyType({name: getattr(found, name) for name in box}),
        fitted=errors[0][1],
        held_out=errors[1][1],
        start_fitted=errors[0][0],
        start_held_out=errors[1][0],
        evaluations=tried,
    )


def _with(model: Pedestrian, names: Sequence[str], logarithms: Array) -> Pedestrian:
    values = dict(zip(names, np.exp(logarithms).tolist(), strict=True))
    return replace(model, **values)  # type: ignore[type-var]  # every model is a dataclass


def _box(
    model: Pedestrian, names: Sequence[str], bounds: Mapping[str, tuple[float, float]] | None
) -> dict[str, tuple[float, float]]:
    """Return the bounds of each parameter by name."""
    known = [each.name for each in fields(model) if each.init and isinstance(getattr(model, each.name), float)]  # type: ignore[arg-type]  # a dataclass
    given = sequence("names", "be a sequence of names of parameters", [names] if isinstance(names, str) else names)
    chosen = [checked_word(f"names[{index}]", name, known) for index, name in enumerate(given)]
    if not chosen or len(set(chosen)) < len(chosen):
        raise InvalidParameterError("names", "name parameters, each once", list(given))
    for name in bounds or {}:
        checked_word("bounds", name, chosen)
    box = {}
    for name in chosen:
        value = getattr(model, name)
        if not 0.0 < value < math.inf:
            raise InvalidParameterError("names", "name positive parameters", Shown(f"{name} = {value:g}"))
        low, high = pair(f"bounds[{name!r}]", (bounds or {}).get(name, (value / RANGE, value * RANGE)))
        if not 0.0 < low <= value <= high:
            rule = f"be positive and around the value of the model, {value:g}"
            raise InvalidParameterError(f"bounds[{name!r}]", rule, (low, high))
        box[name] = (low, high)
    return box


def _search(
    costs: Costs, first: Array, box: Array, tried: int, generator: np.random.Generator, progress: Progress | None
) -> Array:
    """Return the best point of a box by differential evolution, a generation at a time."""
    size = min(max(10, 6 * len(first)), tried)
    low, high = box.T
    points = generator.uniform(low, high, (size, len(first)))
    points[0] = first
    values = costs(points)
    done = size
    while done < tried:
        if progress is not None:
            progress(done, tried)
        trials = np.array([_trial(points, values, row, generator) for row in range(min(size, tried - done))])
        trials = np.clip(trials, low, high)
        found = costs(trials)
        better = np.flatnonzero(found <= values[: len(trials)])
        points[better], values[better] = trials[better], found[better]
        done += len(trials)
    if progress is not None:
        progress(done, tried)
    best: Array = points[int(np.argmin(values))]
    return best


def _trial(points: Array, values: Array, row: int, generator: np.random.Generator) -> Array:
    """Return a point between another one and the best, moved by the difference of two."""
    one, two = generator.choice(np.delete(np.arange(len(points)), row), 2, replace=False)
    toward = points[row] + SHARE * (points[int(np.argmin(values))] - points[row])
    moved = toward + SHARE * (points[one] - points[two])
    changed = generator.random(len(moved)) < CROSSING
    changed[generator.integers(len(moved))] = True
    trial: Array = np.where(changed, moved, points[row])
    return trial
