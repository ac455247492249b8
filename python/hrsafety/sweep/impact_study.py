"""Studies of impacts: loads on a head for each row of a design."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from types import MappingProxyType
from typing import Any, Literal

import numpy as np

from hrsafety import impact
from hrsafety._arguments import Array, number, positive, with_article, word
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.impact.batch import STATUS_WORDS
from hrsafety.impact.criteria.declared import CRITERIA
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep.axes import Column
from hrsafety.sweep.designs import Design
from hrsafety.sweep.studies import Found, Study, chosen

__all__ = ["IMPACT_UNITS", "ImpactStudy"]

_PARTS = {"mass": "kg", "damping": "N s/m", "stiffness": "N/m"}
IMPACT_UNITS: Mapping[str, str] = MappingProxyType(
    {
        "closing_speed": "m/s",
        "manipulator_speed": "m/s",
        **{f"manipulator_{part}": unit for part, unit in _PARTS.items()},
        "foam_stiffness": "N/m",
        "foam_damping": "N s/m",
        "linear_range": "m",
        "thickness": "m",
        **{f"head_{part}": unit for part, unit in _PARTS.items()},
    }
)
_PEAKS = tuple(Column(name=each.name, unit=each.unit) for each in CRITERIA.values() if each.is_peak)
_OTHERS = tuple(Column(name=each.name, unit=each.unit) for each in CRITERIA.values() if not each.is_peak)
_FLAGS = (Column(name="beyond_linear_range", kind="flag"), Column(name="status", kind="word", words=STATUS_WORDS))
_INVALID, _NO_IMPACT = "invalid_", "no_impact"
# Rows whose numbers are checked before a sweep runs: about a tenth of a second.
MOST_CHECKED = 65536


@dataclass(frozen=True, slots=True, kw_only=True)
class ImpactStudy(Study):
    """Loads of impacts of a foam-covered manipulator on a head, as by `impact.metrics_batch`.

    Axes are the numbers of ``metrics_batch`` by their names: ``closing_speed``,
    ``manipulator_speed``, ``manipulator_mass``, ``manipulator_damping``,
    ``manipulator_stiffness``, ``foam_stiffness``, ``foam_damping``, ``linear_range``, ``thickness``,
    ``head_mass``, ``head_damping``, ``head_stiffness``.

    Parameters
    ----------
    manipulator : Manipulator or None
        Gives the numbers of the manipulator that are no axes.
    foam : Foam or None
        Likewise for the foam.
    head : Head, ConstrainedHead or None
        Likewise for the head.
    fixed : mapping of str to float
        Numbers by the names above that are the same in all rows, for example
        ``{"closing_speed": 1.25}``.
    fields : {"all", "peaks"}
        ``"peaks"`` leaves out the criteria that need the course of the acceleration; faster.
    horizon : float or None
        As for `impact.metrics`, in s.
    outputs : sequence of str or None
        Columns to keep; all when ``None``. Without ``"status"`` nothing tells the values of a foam that
        bottomed from the others.

    Raises
    ------
    InvalidParameterError
        If an argument is of the wrong kind, or a name is unknown.

    Examples
    --------
    >>> from hrsafety import impact, sweep
    >>> study = sweep.ImpactStudy(
    ...     manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum(),
    ...     outputs=["peak_head_acceleration_g"],
    ... )
    >>> speeds = sweep.Grid([sweep.Axis(name="closing_speed", values=[0.4, 1.25])])
    >>> sweep.run(speeds, study)["peak_head_acceleration_g"].round(3).tolist()
    [1.961, 6.128]
    """

    manipulator: impact.Manipulator | None = None
    foam: impact.Foam | None = None
    head: impact.Head | impact.ConstrainedHead | None = None
    fixed: Mapping[str, float] = field(default_factory=dict)
    fields: Literal["all", "peaks"] = "all"
    horizon: float | None = None
    outputs: tuple[str, ...] | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        kinds: dict[str, tuple[type, ...]] = {
            "manipulator": (impact.Manipulator,),
            "foam": (impact.Foam,),
            "head": (impact.Head, impact.ConstrainedHead),
        }
        for name, allowed in kinds.items():
            if getattr(self, name) is not None and not isinstance(getattr(self, name), allowed):
                words = " or ".join(kind.__name__ for kind in allowed)
                raise InvalidParameterError(name, f"be {with_article(words)}", getattr(self, name))
        word("fields", self.fields, ("all", "peaks"))
        if self.horizon is not None:
            object.__setattr__(self, "horizon", positive("horizon", self.horizon))
        if not isinstance(self.fixed, Mapping):
            raise InvalidParameterError("fixed", "be a mapping of names to numbers", self.fixed)
        for name in self.fixed:
            word("fixed", name, tuple(IMPACT_UNITS))
        object.__setattr__(self, "fixed", {name: number(name, value) for name, value in self.fixed.items()})
        object.__setattr__(self, "outputs", chosen(self._possible(), self.outputs))

    def _possible(self) -> tuple[Column, ...]:
        return (*_PEAKS, *(_OTHERS if self.fields == "all" else ()), *_FLAGS)

    def columns(self) -> tuple[Column, ...]:
        """Return what is found for each row, without the axes."""
        return tuple(each for each in self._possible() if self.outputs is None or each.name in self.outputs)

    def units(self, names: Sequence[str]) -> dict[str, str]:
        """Return the units of axes with these names, see `Study.units`."""
        for name in names:
            word("name of an axis", name, tuple(IMPACT_UNITS))
            if name in self.fixed:
                raise InvalidParameterError("fixed", "not name an axis of the design", name)
        # One row tells whether anything is missing or contradicts the head.
        self.compute({name: np.ones(1) for name in names}, threads=1)
        return {name: IMPACT_UNITS[name] for name in names}

    def compute(self, rows: dict[str, Array], threads: int | None = None) -> Found:
        """Return the columns for some rows, see `Study.compute`."""
        given: dict[str, Any] = {**self.fixed, **rows}
        if "closing_speed" not in given:
            remedy = "name it below [impact] of a file, or in fixed"
            raise InvalidParameterError(
                "closing_speed", "be an axis or among the fixed numbers", Shown("nothing"), remedy
            )
        found = self._batch(given, threads).columns()
        return {column.name: found[column.name] for column in self.columns()}

    def doubts(self, rows: dict[str, Array]) -> tuple[ResultWarning, ...]:
        """Return numbers that are hardly what was meant, and foams that are too thin, see `Study.doubts`."""
        found = self._batch({**self.fixed, **rows}, 1)
        pressed = found.bottomed
        if not pressed.any():
            return found.warnings
        told = found.status[pressed] == "bottomed"
        words = "" if not told.any() else ", which the status bottomed tells" + ("" if told.all() else " of some")
        message = (
            f"{np.count_nonzero(pressed)} of the {len(pressed)} rows that were looked at compress the foam by more "
            "than its thickness: true loads are higher than computed; leave out rows whose max_compression is above "
            f"the thickness{words}"
        )
        return (*found.warnings, ResultWarning("bottomed", "status", message))

    def judged(self, design: Design) -> tuple[ResultWarning, ...]:
        """Return the doubts of a design before it runs, with rows that cannot be, see `Study.judged`."""
        return (*self.doubts(design.looked_at()), *self._impossible(design))

    def _impossible(self, design: Design) -> Iterator[ResultWarning]:
        """Warn of rows with a number that no part can have: they have a status, and no loads."""
        rows = design.sampled(MOST_CHECKED)
        given: dict[str, Any] = {**self.fixed, **rows}
        quick = replace(self, fields="peaks", outputs=("status",))
        status = quick._batch(given, None).status
        # Bodies that stand at a distance are a row of zero speed; those that part are hardly meant.
        parting = (status == _NO_IMPACT) & (np.asarray(given["closing_speed"]) < 0.0)
        bad = np.flatnonzero(np.char.startswith(status, _INVALID) | parting)
        if not len(bad):
            return
        name = "closing_speed" if parting[bad[0]] else str(status[bad[0]]).removeprefix(_INVALID)
        own = given.get(name)
        value = "impossible"
        if own is not None:
            value = f"{float(np.broadcast_to(own, status.shape)[bad[0]]):g} {IMPACT_UNITS[name]}"
        of = "the {} rows" if len(status) == len(design) else "{} rows that were looked at"
        rule = "; it has to lie within the thickness" if name == "linear_range" else ""
        message = (
            f"{len(bad)} of {of.format(len(status))} cannot be and have no loads, only a status such as "
            f"{status[bad[0]]}: {name} is {value} in the first of them{rule}; leave such values out"
        )
        yield ResultWarning("invalid_numbers", name, message)

    def _batch(self, given: dict[str, Any], threads: int | None) -> impact.ImpactMetricsBatch:
        return impact.metrics_batch(
            manipulator=self.manipulator,
            foam=self.foam,
            head=self.head,
            horizon=self.horizon,
            fields=self.fields,
            outputs=None if self.outputs is None else [name for name in self.outputs if name in CRITERIA],
            threads=threads,
            **given,
        )
