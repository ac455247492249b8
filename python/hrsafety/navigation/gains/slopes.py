"""Slopes of a metric over the gains at one gain set."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, numbers, positive
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.navigation.batch import check_scenarios, simulate_batch
from hrsafety.navigation.gains.metrics import Metric, check_metric, metric_values
from hrsafety.navigation.laws.force_laws import Law, VirtualForceField
from hrsafety.navigation.laws.python_law import law_with_gains
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.navigation.trajectory import Integrator
from hrsafety.navigation.warnings import runs as run_warnings
from hrsafety.plausibility import ResultWarning

__all__ = ["GainGradient", "gain_gradient"]

# The slope is taken at the step and at these shares of it.
SHARES = (1.0, 0.5, 0.25)


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class GainGradient:
    """Slopes over each gain at the gains of a law.

    Attributes
    ----------
    law : Law
        The law at whose gains the slopes were taken.
    scenarios : tuple of Scenario
        Where.
    metric : str
        What the slopes are of.
    gain_names : tuple of str
        Names of the four gains.
    value : float
        Mean of the metric over the scenarios, in its unit.
    steps : ndarray, shape (4,)
        Largest difference step of each gain, in its unit.
    gradient : ndarray, shape (4,)
        Slope of the mean: metric unit per gain unit. NaN where a run of a difference touched
        an obstacle or did not arrive.
    scenario_gradient : ndarray, shape (4, scenarios)
        Slope in each scenario.
    error : ndarray, shape (4,)
        Largest change of the slope when the step is halved or quartered. Where it is as large
        as the slope, the slope has no meaning: the metric jumps or bends within the step.
    backward, forward : ndarray, shape (4,)
        Slopes of the mean below and above the gain; NaN below where the gain is smaller than
        its step.
    relative : ndarray, shape (4,)
        ``gradient * gain / value``: the limit of (C.3.1) to (C.3.4) for small changes.
    """

    law: Law
    scenarios: tuple[Scenario, ...]
    metric: str
    gain_names: tuple[str, ...]
    value: float
    steps: Array
    gradient: Array
    scenario_gradient: Array
    error: Array
    backward: Array
    forward: Array
    relative: Array

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why the numbers may not mean what they seem to: the first warning of each kind, and how many follow."""
        return run_warnings.of_scenes(self.scenarios, [self.law])


def gain_gradient(
    scenarios: Sequence[Scenario],
    law: Law | None = None,
    *,
    metric: Metric = "performance",
    relative_step: float = 0.01,
    steps: npt.ArrayLike | None = None,
    weights: Sequence[float] = (1 / 3, 1 / 3, 1 / 3),
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
    threads: int | None = None,
) -> GainGradient:
    """Return the slopes of a metric over the gains by central differences, with an error.

    ``(f(K + h) - f(K - h)) / (2 h)``; where the gain is smaller than its step, the difference
    ``(4 f(K + h/2) - f(K + h) - 3 f(K)) / h`` of the same order towards larger gains. The
    metrics are continuous in most places only: an obstacle is noticed one control period
    earlier or later, a minimum moves from one step to the next. So the slope is taken at three
    steps and ``error`` says by how much they disagree.

    Parameters
    ----------
    scenarios : sequence of Scenario
        Where.
    law : Law or None
        The law and its gains; ``None``: the default law.
    metric : str
        ``"performance"`` (H), ``"performance_arrival_time"``, ``"performance_avoidance"``,
        ``"performance_energy_saving"``, ``"arrival_time"`` in s, ``"energy"`` in J,
        ``"path_length"`` or ``"min_clearance"`` in m.
    relative_step : float
        Difference step as a share of the gain; for a gain that is 0 as a share of the largest
        value in appendix C.2 (50 N/m, 200 N/m, 500 N/m^2, 3 s).
    steps : array_like of shape (4,), or None
        Difference steps in the units of the gains, instead.
    weights : sequence of float
        Weights of time, distance and energy in H.
    integrator, step, hold
        As for `simulate`.
    threads : int or None
        As for `simulate_batch`.

    Returns
    -------
    GainGradient
        Slopes of the mean and in each scenario, one-sided slopes, errors.

    Raises
    ------
    InvalidParameterError
        If there is no scenario, the metric is unknown, a difference step is not positive and
        finite, or an option is out of range.
    ShapeError
        If steps is not (4,).
    SimulationError
        If the state of a run became non-finite.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> slopes = nav.gains.gain_gradient([scenarios.configuration("c1")], metric="arrival_time")
    >>> bool(slopes.gradient[0] < 0.0)  # a stronger attraction is faster
    True
    """
    scenes = check_scenarios(scenarios)
    law = VirtualForceField() if law is None else law
    law = law_with_gains(law)
    metric_name = check_metric("metric", metric)
    gains = np.array(law.gains)
    widths = _steps(law, relative_step, steps)
    offsets = np.array([0.0, *SHARES, *(-share for share in SHARES)])
    # Where the step leads below zero the points lie above the gain instead.
    one_sided = gains < widths
    sets = np.tile(gains, (len(gains), len(offsets), 1))
    for index, width in enumerate(widths):
        own = np.where(offsets < 0.0, offsets / -2.0, offsets) if one_sided[index] else offsets
        sets[index, :, index] += own * width
    table = simulate_batch(
        scenes,
        law,
        sets.reshape(-1, len(gains)),
        weights=weights,
        integrator=integrator,
        step=step,
        hold=hold,
        threads=threads,
    )
    found = _values(table, metric_name).reshape(len(gains), len(offsets), len(scenes))
    return _slopes(law, scenes, metric_name, widths, one_sided, found)


def _values(table: RunTable, metric: str) -> Array:
    """Return the metric of each row; NaN after a contact or without arrival."""
    return np.where(table.outcome == "arrived", metric_values(table, metric), np.nan)


def _steps(law: Law, relative_step: float, steps: npt.ArrayLike | None) -> Array:
    gains = np.array(law.gains)
    if steps is None:
        # A gain that is zero has no scale of its own; one that the source does not search needs a step.
        largest = np.array([law.GAIN_BOUNDS[name][1] for name in law.GAIN_NAMES])
        widths = positive("relative_step", relative_step) * np.where(gains > 0.0, gains, largest)
    else:
        widths = numbers("steps", steps)
    if widths.shape != gains.shape:
        raise ShapeError("steps", f"({len(gains)},)", widths.shape)
    for index, width in enumerate(widths.tolist()):
        if not 0.0 < width < np.inf:
            raise InvalidParameterError(f"steps[{index}]", "be finite and positive", width)
    return widths


def _slopes(
    law: Law, scenes: Sequence[Scenario], metric: str, widths: Array, one_sided: npt.NDArray[np.bool_], found: Array
) -> GainGradient:
    """Return the slopes from the values at 0, h, h/2, h/4, and at minus these (or at half of them)."""
    shares = np.array(SHARES)[None, :, None]
    h = widths[:, None, None] * shares
    here, far, other = found[:, :1], found[:, 1 : 1 + len(SHARES)], found[:, 1 + len(SHARES) :]
    central = (far - other) / (2.0 * h)
    upward = (4.0 * other - far - 3.0 * here) / h
    slopes = np.where(one_sided[:, None, None], upward, central)
    means = slopes.mean(axis=2)
    gradient, value = means[:, 0], float(here[0, 0].mean())
    # A value of zero has no relative slope.
    relative = gradient * np.array(law.gains) / value if value else np.full(len(widths), np.nan)
    return GainGradient(
        law=law,
        scenarios=tuple(scenes),
        metric=metric,
        gain_names=law.GAIN_NAMES,
        value=value,
        steps=widths,
        gradient=gradient,
        scenario_gradient=slopes[:, 0],
        error=np.abs(means[:, 1:] - means[:, :1]).max(axis=1),
        backward=np.where(one_sided, np.nan, ((here[:, 0] - other[:, 0]) / h[:, 0]).mean(axis=1)),
        forward=((far[:, 0] - here[:, 0]) / h[:, 0]).mean(axis=1),
        relative=relative,
    )
