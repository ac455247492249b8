"""Injury criteria and loads of an impact, on the continuous solution and on measured signals."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Annotated, ClassVar, Literal, NamedTuple, Self, get_args

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, columns, flag, instance, number, word
from hrsafety._display import displayed
from hrsafety.errors import InvalidParameterError
from hrsafety.impact.criteria.declared import LoadRow, with_criteria
from hrsafety.impact.criteria.doubts import SignalShape, issued, measurement_doubts, mirrored_doubt
from hrsafety.impact.parameters import ConstrainedHead, Foam, Head, Manipulator
from hrsafety.plausibility import RANGES, ResultWarning, implausible, telling

__all__ = [
    "HeadInjury",
    "ImpactMetrics",
    "MovingLevel",
    "average_3ms",
    "clip_3ms",
    "hic",
    "hic_of_pulse",
    "metrics",
]


STANDARD_GRAVITY = 9.80665
"""In m/s^2."""

Doubts = tuple[ResultWarning, ...]
PulseShape = Literal["half_sine", "square", "triangle"]


@displayed
@with_criteria("float")
class ImpactMetrics(LoadRow):
    """Loads of one impact, maxima over the impact period.

    The impact period runs from first contact to the first zero of the head acceleration. All
    maxima are found on the continuous solution, both ends included. g is 9.80665 m/s^2. The period
    is infinite without a zero within the horizon, and NaN for a constrained head; the criteria of
    3 ms are NaN if the period is shorter.

    Attributes
    ----------
    {criteria}
    status : str
        What the numbers mean. ``"released"``: the impact period ended within the horizon.
        ``"no_release"``: it did not, and maxima are over the horizon. ``"no_impact"``: the
        closing speed is not positive, nothing happens, all numbers are NaN. ``"constrained"``: the head cannot
        move, maxima are over the horizon, head fields are NaN. ``"beyond_linear_range"``:
        released, but the foam was compressed beyond the range in which it is linear, so that
        the true loads are higher. ``"bottomed"``: released, but the foam was compressed by more than
        it is thick, so that the manipulator itself has hit the head and the loads mean nothing.
    beyond_linear_range : bool
        Whether the compression leaves the linear range of the foam, whatever the status.
    bottomed : bool
        Whether the compression is more than the thickness of the foam, whatever the status. Like
        ``warnings`` no item of the tuple.
    warnings : tuple of ResultWarning
        Numbers that are hardly what was meant.
    """

    bottomed: bool = False
    warnings: Doubts = ()

    def _replace(self, /, **kwargs: object) -> Self:
        """Return the same loads with other fields; what is no item of the tuple is kept, or given, too."""
        kept = {name: kwargs.pop(name, getattr(self, name)) for name in ("bottomed", "warnings")}
        found = super()._replace(**kwargs)
        for name, value in kept.items():
            setattr(found, name, value)
        return found

    def __repr__(self) -> str:
        """Return the fields, and the warnings if there are any."""
        return with_warnings(super().__repr__(), self.warnings)


def with_warnings(text: str, warnings: Doubts) -> str:
    """Return the text of a result with what is doubtful about it."""
    if not warnings:
        return text
    return f"{text[:-1]}, warnings=({', '.join(repr(str(each)) for each in warnings)},))"


class _Window(NamedTuple):
    value: Annotated[float, "g"]
    start: Annotated[float, "s"]
    end: Annotated[float, "s"]


@displayed
class HeadInjury(_Window):
    """Head injury criterion of a signal, and the window that gives it.

    Attributes
    ----------
    value : float
        (t_2 - t_1) [mean of a in g over the window]^2.5, in s.
    start, end : float
        The window t_1, t_2, in s.
    warnings : tuple of ResultWarning
        What is doubtful about the signal; no item of the tuple.
    """

    UNITS: ClassVar[Mapping[str, str]] = {"value": "s"}
    warnings: Doubts = ()

    def __repr__(self) -> str:
        """Return the fields, and the warnings if there are any."""
        return with_warnings(super().__repr__(), self.warnings)


@displayed
class MovingLevel(_Window):
    """Level of a signal over 3 ms, and where it is reached.

    Attributes
    ----------
    value : float
        In g.
    start, end : float
        The 3 ms, in s.
    warnings : tuple of ResultWarning
        What is doubtful about the signal; no item of the tuple.
    """

    warnings: Doubts = ()

    def __repr__(self) -> str:
        """Return the fields, and the warnings if there are any."""
        return with_warnings(super().__repr__(), self.warnings)


# Faster ones would only overflow: loads go with up to the power 2.5 of the speed.
MOST_SPEED = 1e100
_LEAST_PLAUSIBLE, _MOST_PLAUSIBLE = RANGES["closing_speed"][:2]
# Steps of sampling in the longest window between samples, at least.
_STEPS_OF_WINDOW = 10.0
# Ends of the ranges of the mean step, the smallest and largest acceleration and the gained velocity.
_PLAUSIBLE_SIGNAL = tuple(
    RANGES[name][:2] for name in ("sampling_step", "head_acceleration_g", "head_acceleration_g", "head_velocity_gain")
)


def check_speeds(closing_speed: float, manipulator_speed: float | None = None) -> None:
    """Refuse speeds whose loads cannot be represented."""
    for name, speed in (("closing_speed", closing_speed), ("manipulator_speed", manipulator_speed)):
        if speed is not None and MOST_SPEED < abs(speed) < math.inf:
            raise InvalidParameterError(name, f"be at most {MOST_SPEED:g} m/s", speed)


def speed_warnings(closing_speed: float, manipulator_speed: float | None = None) -> Doubts:
    """Return what is doubtful about the speeds of an impact; without one there is nothing to doubt."""
    if manipulator_speed is None and (closing_speed <= 0.0 or _LEAST_PLAUSIBLE <= closing_speed <= _MOST_PLAUSIBLE):
        return ()
    closing = closing_speed if closing_speed > 0.0 else None
    return implausible({"closing_speed": closing, "manipulator_speed": manipulator_speed})


def judged(values: tuple[object, ...], foam: Foam, warnings: Doubts) -> ImpactMetrics:
    """Return the loads of a native row with what is known about the foam."""
    found = ImpactMetrics._make(values)
    if found.beyond_linear_range:
        found.bottomed = found.max_compression > foam.thickness
    if warnings:
        found.warnings = warnings
    return found


@telling()
def metrics(
    manipulator: Manipulator,
    foam: Foam,
    head: Head | ConstrainedHead,
    *,
    closing_speed: float,
    manipulator_speed: float | None = None,
    horizon: float | None = None,
) -> ImpactMetrics:
    """Return the loads of an impact from the exact linear solution.

    Parameters
    ----------
    manipulator : Manipulator
        What hits.
    foam : Foam
        What is between.
    head : Head or ConstrainedHead
        What is hit.
    closing_speed : float
        v_c = v_r(0) - v_h(0) in m/s. At most zero means that nothing happens.
    manipulator_speed : float or None
        v_r in m/s; the closing speed when ``None``, so that the head is at rest. It matters
        for the power of the manipulator only.
    horizon : float or None
        Longest time that is examined, in s; 0.2 when ``None``, 0.05 for a constrained head.

    Returns
    -------
    ImpactMetrics
        All maxima, and a status that says what they mean.

    Raises
    ------
    InvalidParameterError
        If a speed is not finite or the horizon is not positive.

    Examples
    --------
    >>> from hrsafety import impact
    >>> nominal = impact.metrics(
    ...     impact.MANIPULATOR_1, impact.Foam(stiffness=24250.0, damping=71.9), impact.Head.apparatus(),
    ...     closing_speed=1.25,
    ... )
    >>> round(nominal.peak_head_acceleration_g, 5), round(nominal.hic15, 5), nominal.status
    (6.56785, 1.37026, 'released')
    """
    if type(closing_speed) is not float:
        closing_speed = number("closing_speed", closing_speed)
    if manipulator_speed is not None and type(manipulator_speed) is not float:
        manipulator_speed = number("manipulator_speed", manipulator_speed)
    if horizon is not None and type(horizon) is not float:
        horizon = number("horizon", horizon)
    usual = manipulator_speed is None and _LEAST_PLAUSIBLE <= closing_speed <= _MOST_PLAUSIBLE
    if not usual:
        check_speeds(closing_speed, manipulator_speed)
    try:
        values = _hrsafety.impact_metrics(
            manipulator._native, foam._native, head._native, closing_speed, manipulator_speed, horizon
        )
    except (AttributeError, TypeError):
        # Classes are checked only when something went wrong: the call takes microseconds.
        check_parts(manipulator, foam, head)
        raise
    doubts = manipulator.warnings + foam.warnings + head.warnings
    if not usual:
        doubts += speed_warnings(closing_speed, manipulator_speed)
    return judged(values, foam, doubts)


def check_parts(manipulator: object, foam: object, head: object) -> None:
    """Say which of the three is not what it should be, if one is not."""
    instance("manipulator", manipulator, Manipulator)
    instance("foam", foam, Foam)
    if not isinstance(head, (Head, ConstrainedHead)):
        raise InvalidParameterError("head", "be a Head or a ConstrainedHead", head)


def hic(
    time: npt.ArrayLike, acceleration_g: npt.ArrayLike, window: float = 0.015, interpolate: bool = False
) -> HeadInjury:
    """Return the head injury criterion of a sampled signal.

    The maximum over t_1 < t_2, t_2 - t_1 <= window, of (t_2 - t_1) [mean of a over (t_1, t_2)]^2.5;
    windows with a negative mean count as 0. Takes time proportional to the samples in a window
    of constant sampling, and any sampling. A signal of which the larger part is negative, that is never positive,
    rests away from zero, has a flat top or too few samples in its peak is doubtful: the doubts are in ``warnings``,
    and those that may err on the unsafe side are issued as `HrsafetyWarning`, too.

    Parameters
    ----------
    time : array_like of shape (n,)
        Sample times in s, increasing.
    acceleration_g : array_like of shape (n,)
        Head acceleration in g.
    window : float
        Longest window in s: 0.015 for HIC15, 0.036 for HIC36.
    interpolate : bool
        False: windows begin and end at samples, the trapezoid rule between. True: the signal is
        piecewise linear and the window is free.

    Returns
    -------
    HeadInjury
        Value and window.

    Raises
    ------
    InvalidParameterError
        If there are less than two samples, time does not increase, a value is not finite, or without
        ``interpolate`` a step is longer than the window, as with milliseconds.
    ShapeError
        If the arrays are not one-dimensional and of one length.

    Examples
    --------
    A half sine of 5 ms and 100 g:

    >>> import numpy as np
    >>> from hrsafety import impact
    >>> time = np.linspace(0.0, 0.005, 2001)
    >>> round(impact.hic(time, 100.0 * np.sin(np.pi * time / 0.005), interpolate=True).value, 1)
    207.3
    """
    instants, signal = columns(time=time, acceleration_g=acceleration_g)
    width, free = number("window", window), flag("interpolate", interpolate)
    found = HeadInjury._make(_hrsafety.hic(instants, signal, width, free))
    shape = SignalShape.of(instants, signal, found[1:])
    doubts = signal_doubts(instants, shape)
    doubts += tuple(hic_doubts(instants, signal, shape, found.value, width, free))
    found.warnings = issued(merged(doubts))
    return found


def average_3ms(time: npt.ArrayLike, acceleration_g: npt.ArrayLike, width: float = 0.003) -> MovingLevel:
    """Return the largest moving average of a signal over 3 ms.

    Negative values count as such; what is doubtful about the signal is told as by `hic`.

    Parameters
    ----------
    time : array_like of shape (n,)
        Sample times in s, increasing; the signal is linear between them.
    acceleration_g : array_like of shape (n,)
        Head acceleration in g.
    width : float
        Length of the moving window in s.

    Returns
    -------
    MovingLevel
        Average in g and where.

    Raises
    ------
    InvalidParameterError
        If there are less than two samples, time does not increase, a value is not finite, or the signal
        is shorter than the window.
    ShapeError
        If the arrays are not one-dimensional and of one length.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import impact
    >>> time = np.linspace(0.0, 0.006, 61)
    >>> round(impact.criteria.average_3ms(time, 10.0 - np.abs(time - 0.003) / 0.0003).value, 9)
    7.5
    """
    return _moving_level(_hrsafety.moving_average, time, acceleration_g, width)


def clip_3ms(time: npt.ArrayLike, acceleration_g: npt.ArrayLike, width: float = 0.003) -> MovingLevel:
    """Return the level that a signal exceeds for 3 contiguous ms, which the average may be above.

    Parameters, returns and errors are those of `average_3ms`: ``width`` is how long the level is
    exceeded.

    Parameters
    ----------
    time, acceleration_g, width
        As for `average_3ms`.

    Returns
    -------
    MovingLevel
        Level in g and where.

    Raises
    ------
    InvalidParameterError, ShapeError
        As for `average_3ms`.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import impact
    >>> time = np.linspace(0.0, 0.006, 61)
    >>> round(impact.criteria.clip_3ms(time, 10.0 - np.abs(time - 0.003) / 0.0003).value, 9)
    5.0
    """
    return _moving_level(_hrsafety.contiguous_level, time, acceleration_g, width)


def _moving_level(
    level: Callable[[Array, Array, float], tuple[float, float, float]],
    time: npt.ArrayLike,
    acceleration_g: npt.ArrayLike,
    width: float,
) -> MovingLevel:
    instants, signal = columns(time=time, acceleration_g=acceleration_g)
    length = number("width", width)
    found = MovingLevel._make(level(instants, signal, length))
    shape = SignalShape.of(instants, signal, found[1:])
    doubts = signal_doubts(instants, shape)
    doubts += tuple(
        mirrored_doubt(
            "acceleration_g",
            f"the level over {length:g} s",
            max(found.value, 0.0),
            -shape.least,
            lambda: level(instants, -signal, length)[0],
        )
    )
    found.warnings = issued(merged(doubts), stacklevel=4)
    return found


class WholeLoads(NamedTuple):
    """Criteria over a whole record: head injury over 15 and 36 ms, and the level held for 3 ms in g."""

    hic15: float
    hic36: float
    clip_3ms_g: float


def whole_loads(time: Array, signal_g: Array) -> WholeLoads:
    """Return the criteria of a checked signal over all of it, without doubts; NaN for a level of less than 3 ms."""
    step = 1.5 * float(np.diff(time).max())
    fifteen, thirty_six = (_hrsafety.hic(time, signal_g, max(width, step), False)[0] for width in (0.015, 0.036))
    held = np.nan if time[-1] - time[0] < 0.003 else _hrsafety.contiguous_level(time, signal_g, 0.003)[0]
    return WholeLoads(max(fifteen, 0.0), max(thirty_six, 0.0), held)


def signal_doubts(time: Array, shape: SignalShape) -> Doubts:
    """Return what is doubtful about a sampled acceleration: its units, and how it was measured."""
    measured = tuple(measurement_doubts("acceleration_g", "g", shape))
    step = float(time[-1] - time[0]) / (len(time) - 1)
    values = (step, shape.least, shape.most, STANDARD_GRAVITY * shape.area)
    if all(low <= value <= high for value, (low, high) in zip(values, _PLAUSIBLE_SIGNAL, strict=True)):
        return measured  # nearly always, and far faster than building the sentences
    return measured + implausible(
        {
            "time": step,
            "acceleration_g": np.array(values[1:3]),
            "velocity that the head gains by acceleration_g": values[3],
        },
        {
            "time": "sampling_step",
            "acceleration_g": "head_acceleration_g",
            "velocity that the head gains by acceleration_g": "head_velocity_gain",
        },
    )


def hic_doubts(
    time: Array, acceleration_g: Array, shape: SignalShape, value: float, window: float, interpolate: bool
) -> Iterator[ResultWarning]:
    """Give what is doubtful about a head injury criterion: a push of the other sign, windows between coarse samples."""
    yield from mirrored_doubt(
        "acceleration_g",
        "the head injury criterion",
        value,
        max(-shape.least, 0.0) ** 2.5 * window,
        lambda: _hrsafety.hic(time, -acceleration_g, window, interpolate)[0],
    )
    if not interpolate and shape.longest_step > window / _STEPS_OF_WINDOW:
        message = (
            f"time has steps of up to {shape.longest_step:g} s, and windows of at most {window:g} s begin and end at "
            "samples: they are shorter than they may be, and the criterion is too low; sample faster, or interpolate"
        )
        yield ResultWarning("coarse_sampling", "time", message)


def merged(doubts: Doubts) -> Doubts:
    """Return the first doubt of each kind about each subject."""
    return tuple({(each.code, each.subject): each for each in reversed(doubts)}.values())[::-1] if doubts else ()


def hic_of_pulse(shape: PulseShape, peak_g: float, duration: float, window: float = 0.015) -> float:
    """Return the head injury criterion of a pulse of a known shape in closed form.

    Parameters
    ----------
    shape : {"half_sine", "square", "triangle"}
        Shape over the time; the triangle is symmetric.
    peak_g : float
        Peak in g.
    duration : float
        Length of the pulse in s.
    window : float
        Longest window in s.

    Returns
    -------
    float
        The criterion, in s.

    Raises
    ------
    InvalidParameterError
        If the shape is unknown, a value not finite, the peak negative, or a time not positive.

    Examples
    --------
    >>> from hrsafety import impact
    >>> [round(impact.criteria.hic_of_pulse(shape, 100.0, 0.005), 1) for shape in ("half_sine", "square", "triangle")]
    [207.3, 500.0, 123.2]
    """
    word("shape", shape, get_args(PulseShape))
    numbers = number("peak_g", peak_g), number("duration", duration), number("window", window)
    return _hrsafety.hic_of_pulse(shape, *numbers)
