"""Exact derivatives of the loads of an impact."""

from __future__ import annotations

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, number, word
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.impact.criteria.declared import CRITERIA
from hrsafety.impact.criteria.loads import Doubts, ImpactMetrics, check_parts, check_speeds, judged, speed_warnings
from hrsafety.impact.parameters import ConstrainedHead, Foam, Head, Manipulator
from hrsafety.plausibility import telling

__all__ = ["ImpactGradients", "gradients"]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ImpactGradients:
    """Loads of an impact and their derivatives.

    Attributes
    ----------
    metrics : ImpactMetrics
        The loads.
    metric_names, parameter_names : tuple of str
        Rows and columns of the derivatives.
    values : ndarray of shape (metrics, parameters)
        Derivative of each load with respect to each parameter, in SI units, or g as the loads;
        NaN where a load has no derivative.
    parameters : ndarray of shape (parameters,)
        The parameters, in SI units; NaN where there is none.
    """

    metrics: ImpactMetrics
    metric_names: tuple[str, ...]
    parameter_names: tuple[str, ...]
    values: Array
    parameters: Array

    @property
    def warnings(self) -> Doubts:
        """Numbers that are hardly what was meant, see `ImpactMetrics.warnings`."""
        return self.metrics.warnings

    @property
    def relative(self) -> Array:
        """Percent by which each load grows with one percent of each parameter, of the shape of `values`."""
        loads = np.array([getattr(self.metrics, name) for name in self.metric_names])
        with np.errstate(divide="ignore", invalid="ignore"):
            share: Array = self.values * self.parameters / loads[:, np.newaxis]
        return share

    def of(self, metric: str) -> dict[str, float]:
        """Return the derivatives of one load.

        Parameters
        ----------
        metric : str
            Field of `ImpactMetrics`.

        Returns
        -------
        dict of str to float
            By parameter.

        Raises
        ------
        InvalidParameterError
            If there is no such load.
        """
        row = self.metric_names.index(word("metric", metric, self.metric_names))
        return dict(zip(self.parameter_names, self.values[row].tolist(), strict=True))


@telling()
def gradients(
    manipulator: Manipulator,
    foam: Foam,
    head: Head | ConstrainedHead,
    *,
    closing_speed: float,
    manipulator_speed: float | None = None,
    horizon: float | None = None,
) -> ImpactGradients:
    """Return the loads of an impact with exact derivatives with respect to every parameter.

    Derivatives follow the response itself, not differences of loads; of a load at a moving end,
    such as the impact period, too.

    Parameters
    ----------
    manipulator : Manipulator
        What hits.
    foam : Foam
        What is between.
    head : Head or ConstrainedHead
        What is hit.
    closing_speed : float
        v_c in m/s.
    manipulator_speed : float or None
        v_r in m/s. When ``None`` it is the closing speed, whose derivative then includes it.
    horizon : float or None
        As for `metrics`.

    Returns
    -------
    ImpactGradients
        Loads and derivatives.

    Raises
    ------
    InvalidParameterError
        If a speed is not finite or the horizon is not positive.

    Examples
    --------
    How much a stiffer foam raises the peak, in g per kN/m:

    >>> from hrsafety import impact
    >>> found = impact.gradients(
    ...     impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum(), closing_speed=1.25)
    >>> round(1e3 * found.of("peak_head_acceleration_g")["foam_stiffness"], 3)
    0.151

    One percent more speed is one percent more force:

    >>> round(float(found.relative[found.metric_names.index("peak_contact_force")][-2]), 9)
    1.0
    """
    check_parts(manipulator, foam, head)
    speed = number("closing_speed", closing_speed)
    own_speed = None if manipulator_speed is None else number("manipulator_speed", manipulator_speed)
    check_speeds(speed, own_speed)
    values, matrix = _hrsafety.impact_gradients(
        manipulator._native,
        foam._native,
        head._native,
        speed,
        own_speed,
        None if horizon is None else number("horizon", horizon),
    )
    doubts = manipulator.warnings + foam.warnings + head.warnings + speed_warnings(speed, own_speed)
    parameters = _hrsafety.impact_parameter_names()
    parts = {"manipulator": manipulator, "foam": foam, "head": head}
    given = {
        f"{owner}_{name}": float(getattr(part, name, np.nan))
        for owner, part in parts.items()
        for name in ("mass", "damping", "stiffness")
    }
    given |= {"closing_speed": speed, "manipulator_speed": speed if own_speed is None else own_speed}
    return ImpactGradients(
        metrics=judged(values, foam, doubts),
        metric_names=tuple(CRITERIA),
        parameter_names=tuple(parameters),
        values=matrix,
        parameters=np.array([given[name] for name in parameters]),
    )
