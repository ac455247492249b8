"""Loads of many impacts in one call, over all cores and vector lanes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import field, fields
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, callback, count, instance, numbers, positive, sequence, thread_count, word
from hrsafety._bounds import MOST_LANES
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.impact.criteria.declared import CRITERIA, CriterionValues, with_criteria
from hrsafety.impact.criteria.loads import Doubts
from hrsafety.impact.parameters import (
    LINEAR_RANGE,
    LINEAR_SHARE,
    THICKNESS,
    ConstrainedHead,
    Foam,
    Head,
    Manipulator,
)
from hrsafety.plausibility import implausible, telling
from hrsafety.tables import Columns, Table

__all__ = ["ImpactMetricsBatch", "metrics_batch"]

# More would only exhaust the system before it says no.

_MANIPULATOR = ("manipulator_mass", "manipulator_damping", "manipulator_stiffness")
_FOAM = ("foam_stiffness", "foam_damping", "linear_range")
_HEAD = ("head_mass", "head_damping", "head_stiffness")
STATUS_WORDS: tuple[str, ...] = (*_hrsafety.impact_status_words(), "invalid_thickness")
"""Every word that a status can be."""
_BEYOND, _BOTTOMED, _INVALID_THICKNESS = (
    STATUS_WORDS.index(each) for each in ("beyond_linear_range", "bottomed", "invalid_thickness")
)


@with_criteria("ndarray")
@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ImpactMetricsBatch(CriterionValues[Array], Table):
    """Loads of many impacts: the fields of `ImpactMetrics` as arrays of the broadcast shape.

    Criteria that were not asked for are NaN.

    Attributes
    ----------
    {criteria}
    beyond_linear_range : ndarray of bool
        Whether the compression leaves the linear range of the foam.
    bottomed : ndarray of bool
        Whether the compression is more than the thickness of the foam; no column, as the status says it.
    warnings : tuple of ResultWarning
        Numbers that are hardly what was meant, one warning for each argument.
    """

    beyond_linear_range: npt.NDArray[np.bool_]
    _status_code: npt.NDArray[np.uint8] = field(repr=False)
    _bottomed: npt.NDArray[np.bool_] = field(repr=False)
    _warnings: Doubts = ()

    @property
    def bottomed(self) -> npt.NDArray[np.bool_]:
        """Whether the compression is more than the thickness of the foam, whatever the status."""
        return self._bottomed

    @property
    def warnings(self) -> Doubts:
        """Numbers that are hardly what was meant, one warning for each argument."""
        return self._warnings

    @property
    def status(self) -> npt.NDArray[np.str_]:
        """Words of `ImpactMetrics.status`, and of rows that cannot be, all NaN.

        Those name the number that is bad, the first one if there are several:
        ``"invalid_head_mass"``, ``"invalid_closing_speed"`` and so on, ``"invalid_"`` and the
        argument of `metrics_batch`. ``"too_stiff"``: every number is possible by itself, but the
        system has a root that is too fast for the horizon.
        """
        return np.asarray(np.asarray(STATUS_WORDS)[self._status_code])

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of every field."""
        return self._status_code.shape

    def __len__(self) -> int:
        """Return the length of the first axis."""
        return len(self._status_code)

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, ready for a data frame.

        Returns
        -------
        dict of str to ndarray
            Every field flattened, and ``status``.

        Examples
        --------
        >>> from hrsafety import impact
        >>> table = impact.metrics_batch(
        ...     manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum(),
        ...     closing_speed=[0.4, 1.25],
        ... ).columns()
        >>> table["status"].tolist()
        ['released', 'released']
        """
        names = [each.name for each in fields(self) if not each.name.startswith("_")]
        return {**{name: getattr(self, name).ravel() for name in names}, "status": self.status.ravel()}


@telling()
def metrics_batch(
    *,
    manipulator: Manipulator | None = None,
    foam: Foam | None = None,
    head: Head | ConstrainedHead | None = None,
    closing_speed: npt.ArrayLike,
    manipulator_speed: npt.ArrayLike | None = None,
    manipulator_mass: npt.ArrayLike | None = None,
    manipulator_damping: npt.ArrayLike | None = None,
    manipulator_stiffness: npt.ArrayLike | None = None,
    foam_stiffness: npt.ArrayLike | None = None,
    foam_damping: npt.ArrayLike | None = None,
    linear_range: npt.ArrayLike | None = None,
    thickness: npt.ArrayLike | None = None,
    head_mass: npt.ArrayLike | None = None,
    head_damping: npt.ArrayLike | None = None,
    head_stiffness: npt.ArrayLike | None = None,
    horizon: float | None = None,
    fields: Literal["all", "peaks"] = "all",
    outputs: Sequence[str] | None = None,
    threads: int | None = None,
    lanes: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> ImpactMetricsBatch:
    """Return the loads of many impacts: every number may be an array, and all broadcast.

    A row with a bad number gives NaN and a status that names it; it never fails the batch.

    Parameters
    ----------
    manipulator : Manipulator or None
        Gives the manipulator's numbers that are not given separately.
    foam : Foam or None
        Likewise for the foam.
    head : Head, ConstrainedHead or None
        Likewise for the head.
    closing_speed : array_like
        v_c in m/s.
    manipulator_speed : array_like or None
        v_r in m/s; the closing speed when ``None``.
    manipulator_mass, manipulator_damping, manipulator_stiffness : array_like or None
        M_r in kg, C_r in N s/m, K_r in N/m.
    foam_stiffness, foam_damping : array_like or None
        K_c in N/m, C_c in N s/m.
    linear_range : array_like or None
        Compression lambda up to which the foam is linear, in m; as for `Foam` when neither it nor a
        foam is given. Rows in which it is above the thickness are ``"invalid_linear_range"``.
    thickness : array_like or None
        Thickness T_u of the foam, in m, see ``"bottomed"``. When neither it nor a foam is given 0.0254, or the
        linear range where that is more.
    head_mass, head_damping, head_stiffness : array_like or None
        M_h in kg, C_h in N s/m, K_h in N/m.
    horizon : float or None
        As for `metrics`.
    fields : str
        ``"all"``, or ``"peaks"`` for acceleration, force, compression and impact period only;
        the other fields are NaN then, and the call is faster.
    outputs : sequence of str or None
        Names of the criteria to compute; those of ``fields`` when ``None``, the status alone when empty.
        The others are NaN and are neither searched for nor kept. What is computed has the same bits as in a
        call for all criteria.
    threads : int or None
        Number of threads, up to 1024; all cores when ``None``. Never changes a bit.
    lanes : int or None
        1 for impacts one after the other, else groups of eight side by side, where the processor has vectors for
        them: 4 for vectors of at most four numbers (AVX2 or NEON), 8 or 16 for the widest (AVX-512); what suits the
        processor when ``None``. Never changes a bit.
    progress : callable or None
        Called now and then as ``progress(done, total)`` with numbers of impacts, and at the end.

    Returns
    -------
    ImpactMetricsBatch
        Arrays of the broadcast shape.

    Raises
    ------
    InvalidParameterError
        If a number is missing or is no number, an option is out of range, or a criterion is unknown or
        not among ``fields``.
    ShapeError
        If the arrays do not broadcast.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    A map over stiffness and damping of the foam:

    >>> import numpy as np
    >>> from hrsafety import impact
    >>> found = impact.metrics_batch(
    ...     manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), closing_speed=1.25,
    ...     foam_stiffness=np.linspace(5e3, 60e3, 12)[:, None], foam_damping=np.linspace(0.0, 150.0, 4),
    ... )
    >>> found.shape, found.peak_head_acceleration_g[0].round(3).tolist()
    ((12, 4), [2.598, 2.372, 2.922, 4.345])

    The same for two criteria only:

    >>> few = impact.metrics_batch(
    ...     manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum(),
    ...     closing_speed=[0.4, 1.25], outputs=["hic15", "peak_contact_force"],
    ... )
    >>> few.hic15.round(2).tolist(), few.clip_3ms_g.tolist()
    ([0.07, 1.15], [nan, nan])
    """
    asked = _asked(fields, outputs)
    constrained = isinstance(head, ConstrainedHead)
    given = _given_numbers(locals(), constrained)
    shape = _broadcast_shape(given)
    doubts = _doubts(given)
    thick = given.pop("thickness")
    possible = _possible(given, thick)
    result = _hrsafety.impact_metrics_batch(
        {name: _column(array, shape) for name, array in possible.items()},
        horizon=None if horizon is None else positive("horizon", horizon),
        outputs=[*asked, "max_compression"],  # tells whether the foam was crushed
        threads=_threads(threads),
        lanes=None if lanes is None else count("lanes", lanes, most=MOST_LANES),
        progress=callback("progress", progress),
    )
    columns = {name: values.reshape(shape) for name, values in result.items()}
    code = columns.pop("status_code")
    missing = np.broadcast_to(np.nan, shape)
    beyond = np.asarray(columns["max_compression"] > given["linear_range"])
    # Nothing is crushed that is linear.
    bottomed = np.asarray(columns["max_compression"] > thick) if beyond.any() else beyond
    if bottomed.any():
        code[bottomed & (code == _BEYOND)] = _BOTTOMED
    if not (np.isfinite(thick) & (thick > 0.0)).all():
        code[np.broadcast_to(~(np.isfinite(thick) & (thick > 0.0)), shape)] = _INVALID_THICKNESS
    return ImpactMetricsBatch(
        **{name: columns[name] if name in asked else missing for name in CRITERIA},
        beyond_linear_range=beyond,
        _status_code=code,
        _bottomed=bottomed,
        _warnings=doubts,
    )


def _asked(fields: str, outputs: Sequence[str] | None) -> tuple[str, ...]:
    """Return the names of the criteria to compute."""
    every = word("fields", fields, ("all", "peaks")) == "all"
    possible = tuple(name for name, criterion in CRITERIA.items() if every or criterion.is_peak)
    if outputs is None:
        return possible
    names = sequence("outputs", "be a sequence of names of criteria", outputs)
    return tuple(dict.fromkeys(word(f"outputs[{index}]", name, possible) for index, name in enumerate(names)))


def _given_numbers(arguments: dict[str, Any], constrained: bool) -> dict[str, Array]:
    """Return the arrays by name, filled up from the parameter objects."""
    kinds: dict[str, tuple[type, ...]] = {
        "manipulator": (Manipulator,),
        "foam": (Foam,),
        "head": (Head, ConstrainedHead),
    }
    for name, allowed in kinds.items():
        if arguments[name] is not None and not isinstance(arguments[name], allowed):
            instance(name, arguments[name], allowed[0])
    given = {"closing_speed": numbers("closing_speed", arguments["closing_speed"])}
    if arguments["manipulator_speed"] is not None:
        given["manipulator_speed"] = numbers("manipulator_speed", arguments["manipulator_speed"])
    for owner, names in (("manipulator", _MANIPULATOR), ("foam", _FOAM), ("head", _HEAD)):
        fixed = constrained and owner == "head"
        for name in names:
            value, attribute = arguments[name], name.removeprefix(f"{owner}_")
            if value is not None and fixed:
                raise InvalidParameterError(name, "be None for a constrained head", value)
            if value is not None:
                given[name] = numbers(name, value)
            elif arguments[owner] is not None and not fixed:
                given[name] = np.asarray(getattr(arguments[owner], attribute), dtype=np.float64)
            elif name != "linear_range" and not fixed:
                raise InvalidParameterError(name, f"be given, by itself or through {owner}", None)
    return given | _depths(arguments["linear_range"], arguments["thickness"], arguments["foam"])


def _depths(linear_range: npt.ArrayLike | None, thickness: npt.ArrayLike | None, foam: Foam | None) -> dict[str, Array]:
    """Return linear range and thickness, each from the other or from the foam where it is not given."""
    within = None if linear_range is None else numbers("linear_range", linear_range)
    if thickness is not None:
        thick = numbers("thickness", thickness)
    elif foam is not None:
        thick = np.asarray(foam.thickness)
    else:
        thick = np.asarray(THICKNESS) if within is None else np.maximum(THICKNESS, within)
    if within is None:
        most = LINEAR_RANGE if foam is None else foam.linear_range
        # The foam's own range holds for its own thickness.
        within = np.minimum(most, LINEAR_SHARE * thick) if thickness is not None else np.asarray(most)
    return {"linear_range": within, "thickness": thick}


def _possible(given: dict[str, Array], thickness: Array) -> dict[str, Array]:
    """Return the numbers with NaN where a row cannot be, which the core then names."""
    possible = dict(given)
    within = given["linear_range"]
    # A thickness that is NaN must not make a range possible.
    if not (within <= thickness).all():
        possible["linear_range"] = np.where(within <= thickness, within, np.nan)
    return possible


def _doubts(given: dict[str, Array]) -> Doubts:
    """Return what is doubtful; zero stiffness and no impact are not, rows that cannot be have a status."""
    values: dict[str, object] = {}
    for name, array in given.items():
        positive_only = name != "manipulator_speed" and bool(array.size) and not array.min() > 0.0
        values[name] = np.where(array > 0.0, array, np.nan) if positive_only else array
    return implausible(values)


def _broadcast_shape(given: dict[str, Array]) -> tuple[int, ...]:
    shape: tuple[int, ...] = ()
    for name, array in given.items():
        try:
            shape = np.broadcast_shapes(shape, array.shape)
        except ValueError:
            raise ShapeError(name, f"that broadcasts with {shape}", array.shape) from None
    return shape


def _column(array: Array, shape: tuple[int, ...]) -> Array | float:
    """Return one number for all impacts, or one for each."""
    if array.size == 1 and shape != (1,) * len(shape):
        return float(array.reshape(()))
    return np.ascontiguousarray(np.broadcast_to(array, shape)).reshape(-1)


def _threads(threads: int | None) -> int | None:
    return thread_count(threads)
