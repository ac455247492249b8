"""Limits that a foam covering has to keep, and how far a foam is from them."""

from __future__ import annotations

from dataclasses import fields
from typing import Annotated, NamedTuple

from hrsafety._arguments import Parameters, instance, positive
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.impact.criteria.loads import ImpactMetrics
from hrsafety.plausibility import ResultWarning, implausible, unsafe_doubts

__all__ = ["FoamFeasibility", "FoamLimits", "FoamMargin"]


@dataclass(frozen=True, kw_only=True, slots=True)
class FoamLimits(Parameters):
    """Limits that a foam covering has to keep; ``None`` is no limit.

    Parameters
    ----------
    peak_head_acceleration_g : float or None
        In g.
    peak_contact_force : float or None
        In N.
    hic15, hic36 : float or None
        Head injury criterion.
    max_compression : float or None
        In m; the range in which the foam is linear.

    Raises
    ------
    InvalidParameterError
        If a limit is not finite and positive, or there is none at all.

    Examples
    --------
    >>> from hrsafety import impact
    >>> impact.FoamLimits(peak_contact_force=500.0).peak_head_acceleration_g
    10.0
    """

    peak_head_acceleration_g: float | None = 10.0
    peak_contact_force: float | None = None
    hic15: float | None = None
    hic36: float | None = None
    max_compression: float | None = 0.02

    def __post_init__(self) -> None:
        """Check the values."""
        for name in (each.name for each in fields(self)):
            value = getattr(self, name)
            self._set(**{name: None if value is None else positive(name, value)})
        if not self.given():
            raise InvalidParameterError("limits", "hold at least one limit", Shown("none"))

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Limits that are hardly what was meant."""
        given = self.given()
        return implausible(
            {f"limits.{name}": limit for name, limit in given.items()}, {f"limits.{name}": name for name in given}
        )

    def verdict(self, loads: ImpactMetrics) -> str:
        """Return what loads mean for these limits, doubts included.

        Parameters
        ----------
        loads : ImpactMetrics
            Computed, or measured as by `recorded_metrics`.

        Returns
        -------
        str
            ``"exceeds"`` if a limit is exceeded; ``"within_limits"`` only if every limit is kept, the impact ended
            within what was examined, the foam stayed in its linear range, and no doubt about loads or limits may err
            on the unsafe side; else ``"not_checked"``.

        Raises
        ------
        InvalidParameterError
            If the loads are none.

        Examples
        --------
        >>> import numpy as np
        >>> from hrsafety import impact
        >>> time = np.linspace(-0.02, 0.04, 601)
        >>> pulse = 8.0 * np.sin(np.pi * time / 0.02) * ((time > 0.0) & (time < 0.02))
        >>> limits = impact.FoamLimits(peak_head_acceleration_g=10.0, max_compression=None)
        >>> limits.verdict(impact.recorded_metrics(time, pulse))
        'within_limits'
        """
        instance("loads", loads, ImpactMetrics)
        given = {name: (getattr(loads, name), limit) for name, limit in self.given().items()}
        if any(load > limit for load, limit in given.values()):
            return "exceeds"
        known = all(load <= limit for load, limit in given.values())
        whole = loads.status == "released" and not loads.beyond_linear_range
        certain = not unsafe_doubts((*loads.warnings, *self.warnings))
        return "within_limits" if known and whole and certain else "not_checked"

    def given(self) -> dict[str, float]:
        """Return the limits that are set.

        Returns
        -------
        dict of str to float
            By name.
        """
        values = {each.name: getattr(self, each.name) for each in fields(self)}
        return {name: value for name, value in values.items() if value is not None}


class _Shares(NamedTuple):
    peak_head_acceleration_g: float
    peak_contact_force: float
    hic15: float
    hic36: float
    max_compression: float
    least: float


@displayed
class FoamMargin(_Shares):
    """Margin to each limit, as a share of it; negative if it is exceeded, NaN without a limit.

    Attributes
    ----------
    peak_head_acceleration_g, peak_contact_force, hic15, hic36, max_compression : float
        1 - load / limit.
    least : float
        The least of them, and of ``linear_range`` where that is negative: no limit is kept by foam that is
        compressed beyond its linear range.
    linear_range : float
        What is left of the foam's own linear range when it gives back, whether that is limited or not; minus
        infinity if it never does. Like ``status`` no item of the tuple.
    status : str
        ``"kept"``; ``"exceeded"``: a limit is; ``"beyond_linear_range"``: the foam is compressed beyond its linear
        range; ``"bottomed"``: by more than it is thick; ``"not_checked"``: all is kept, but a doubt about the numbers
        of the design or the foam may err on the unsafe side. What makes loads mean little comes first.
    """

    linear_range: float = 0.0
    status: str = "kept"


@displayed
class FoamFeasibility(NamedTuple):
    """Whether some foam keeps all limits with a margin, and if not how much slower the manipulator has to be.

    Attributes
    ----------
    feasible : bool
        Whether a foam exists at the closing speed of the design.
    max_closing_speed : float
        Largest closing speed at which one exists, in m/s.
    slow_down : float
        How much the closing speed has to be reduced, in m/s; 0 if feasible.
    damping, stiffness : float
        The foam that allows the largest closing speed, in N s/m and N/m; the stiffness is NaN where no
        foam does at any speed.
    """

    feasible: bool
    max_closing_speed: Annotated[float, "m/s"]
    slow_down: Annotated[float, "m/s"]
    damping: Annotated[float, "N s/m"]
    stiffness: Annotated[float, "N/m"]
