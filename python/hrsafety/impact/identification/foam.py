"""Foam parameters from static and drop tests (section A.1 of Zeng 2011)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Annotated, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, callback, checked_seed, columns, count, flag, number, positive, vector, word
from hrsafety._bounds import MOST_RESAMPLES, MOST_SWINGS
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.impact.parameters import THICKNESS, Foam, default_linear_range
from hrsafety.plausibility import ResultWarning, implausible, telling

__all__ = ["FoamFit", "StaticFit", "drop_trajectory", "fit_static", "identify_foam"]

Contact = Literal["unilateral", "attached"]
_CONTACTS = ("unilateral", "attached")
# Of what is fitted, in SI units; squares of more overflow.
MOST = 1e100
# Of what is dropped, in kg: with more the fit looks for bounces that there are not.
MOST_MASS = 1e6


class _Line(NamedTuple):
    stiffness: Annotated[float, "N/m"]
    force_offset: Annotated[float, "N"]
    covariance: Array
    interval: Array
    force_deviation: Annotated[float, "N"]
    degrees_of_freedom: int


@displayed
class StaticFit(_Line):
    """Fit of a line to a static test.

    Attributes
    ----------
    stiffness : float
        K_c in N/m, the slope.
    force_offset : float
        Force without compression in N; 0 where the line was forced through the origin.
    covariance : ndarray of shape (2, 2)
        Covariance of both.
    interval : ndarray of shape (2, 2)
        95 % confidence intervals of both.
    force_deviation : float
        Standard deviation of the residuals, in N.
    degrees_of_freedom : int
        Measurements less fitted numbers.
    warnings : tuple of ResultWarning
        Measurements or results that are hardly what was meant; no item of the tuple.
    """

    warnings: tuple[ResultWarning, ...] = ()


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FoamFit:
    """Foam parameters from static and drop tests.

    The order of the three parameters is stiffness, damping ratio, friction.

    Attributes
    ----------
    stiffness : float
        K_c in N/m.
    damping_ratio : float
        xi_c on the rig.
    friction : float
        Friction of the slide in N.
    drop_heights : ndarray of shape (drops,)
        Fitted heights of the drops in m.
    covariance : ndarray of shape (3, 3)
        Covariance of the three parameters.
    interval : ndarray of shape (3, 2)
        Confidence intervals of the three parameters.
    bootstrap_interval : ndarray of shape (3, 2) or None
        The same from resampled residuals, if asked for.
    force_deviation : float
        Standard deviation of the static residuals, in N.
    position_deviation : float
        Standard deviation of the drop residuals, in m.
    degrees_of_freedom : int
        Of the drop fit.
    iterations : int
        Steps that the drop fit took.
    warnings : tuple of ResultWarning
        Measurements or results that are hardly what was meant.
    largest_compression : float
        Largest compression in any of the tests, in m: nothing is known of more.
    """

    stiffness: Annotated[float, "N/m"]
    damping_ratio: float
    friction: Annotated[float, "N"]
    drop_heights: Annotated[Array, "m"]
    covariance: Array
    interval: Array
    bootstrap_interval: Array | None
    force_deviation: Annotated[float, "N"]
    position_deviation: Annotated[float, "m"]
    degrees_of_freedom: int
    iterations: int
    warnings: tuple[ResultWarning, ...] = ()
    largest_compression: Annotated[float, "m"] = math.inf

    def foam(self, moving_mass: float, *, thickness: float = THICKNESS, linear_range: float | None = None) -> Foam:
        """Return the foam with its damping scaled to a moving mass.

        Parameters
        ----------
        moving_mass : float
            Mass that the foam meets, in kg: the head's in an impact.
        thickness : float
            As for `Foam`, in m: that of the source's foam unless yours is given.
        linear_range : float or None
            As for `Foam`, in m; when ``None`` no more than `largest_compression`.

        Returns
        -------
        Foam
            With C_c = 2 xi sqrt(M K_c).
        """
        if linear_range is None:
            usual = default_linear_range(positive("thickness", thickness))
            linear_range = min(usual, self.largest_compression)
        return Foam.from_damping_ratio(
            stiffness=self.stiffness,
            damping_ratio=self.damping_ratio,
            moving_mass=moving_mass,
            thickness=thickness,
            linear_range=linear_range,
        )


def fit_static(static_force: npt.ArrayLike, static_compression: npt.ArrayLike, *, offset: bool = False) -> StaticFit:
    """Return the stiffness of a foam from a static test alone.

    f = K_c eps_c by linear regression, (A.1.2) of Zeng (2011). The compression counts from the
    rest under the slide's own weight, so that the line passes through the origin.

    Parameters
    ----------
    static_force, static_compression : array_like of shape (n,)
        In N and m, at least three.
    offset : bool
        Whether an unknown zero of the transducer is fitted too.

    Returns
    -------
    StaticFit
        Slope and offset with covariance and intervals.

    Raises
    ------
    InvalidParameterError
        If there are too few values, one is not finite, or all compressions are alike.
    ShapeError
        If the arrays are not one-dimensional and of one length.

    Examples
    --------
    >>> from hrsafety import impact
    >>> fit = impact.identification.fit_static([0.0, 24.0, 49.0, 72.0], [0.0, 0.001, 0.002, 0.003])
    >>> round(fit.stiffness), fit.interval[0].round().tolist()
    (24143, [23728.0, 24558.0])
    """
    force, compression = columns(static_force=static_force, static_compression=static_compression)
    _check_squares(static_force=force, static_compression=compression)
    found = StaticFit(**_hrsafety.fit_static(force, compression, flag("offset", offset)))
    found.warnings = _static_warnings(force, compression) + _foam_warnings(found.stiffness)
    return found


def _check_squares(**signals: Array) -> None:
    """Refuse numbers whose squares would overflow in the sums of a fit."""
    for name, values in signals.items():
        largest = float(np.abs(values).max(initial=0.0))
        if MOST < largest < np.inf:
            raise InvalidParameterError(name, f"be at most {MOST:g}, so that squares can be summed", largest)


def _check_swings(name: str, time: Array, what: str, mass: object, stiffness: float) -> None:
    """Refuse records in which a mass swings so often on its foam that each swing cannot be looked for.

    A value that breaks another rule is left to the core.
    """
    moving = number(what, mass)
    span = float(time[-1] - time[0]) if len(time) else 0.0
    if not (0.0 < moving < np.inf and 0.0 < stiffness < np.inf and 0.0 < span < np.inf):
        return
    if span * math.sqrt(stiffness / moving) > MOST_SWINGS:
        rule = f"make at most {MOST_SWINGS} rad of swing in the {span:g} s of {name}, on {stiffness:.3g} N/m"
        raise InvalidParameterError(what, rule, mass, "masses are in kg, stiffness is in N/m, times are in s")


def _extremes(values: Array) -> Array:
    return np.array([values.min(), values.max()])


def _static_warnings(force: Array, compression: Array) -> tuple[ResultWarning, ...]:
    values = {"static_force": _extremes(force), "static_compression": _extremes(compression)}
    return implausible(values, {"static_compression": "compression"})


def _foam_warnings(stiffness: float) -> tuple[ResultWarning, ...]:
    return implausible({"fitted stiffness": stiffness}, {"fitted stiffness": "foam_stiffness"})


def _drop_warnings(drops: list[tuple[Array, Array]], moving_mass: float, gravity: float) -> tuple[ResultWarning, ...]:
    found = implausible({"moving_mass": moving_mass, "gravity": gravity})
    for index, (time, position) in enumerate(drops):
        if len(time) < 2:
            continue
        names = {f"drop_time[{index}]": "drop_step", f"drop_position[{index}]": "drop_height"}
        steps = float(time[-1] - time[0]) / (len(time) - 1)
        found += implausible(dict(zip(names, (steps, _extremes(position)), strict=True)), names)
    return found


@telling()
def identify_foam(
    static_force: npt.ArrayLike,
    static_compression: npt.ArrayLike,
    drop_time: npt.ArrayLike | Sequence[npt.ArrayLike],
    drop_position: npt.ArrayLike | Sequence[npt.ArrayLike],
    moving_mass: float,
    *,
    gravity: float = 9.80665,
    confidence: float = 0.95,
    contact: Contact = "unilateral",
    bootstrap: int = 0,
    seed: int = 0,
    progress: Callable[[int, int], object] | None = None,
) -> FoamFit:
    """Return stiffness, damping ratio and friction of a foam from static and drop tests.

    The static test is a line, f = K_c eps. The drops are fitted as trajectories, not as
    differentiated samples: m y'' + C y' + K y = -(m g + f sign(y')) in contact, a fall with
    friction before it (section A.1 of Zeng 2011).

    Parameters
    ----------
    static_force, static_compression : array_like of shape (n,)
        In N and m.
    drop_time, drop_position : array_like of shape (k,), or a sequence of them
        One drop or several: times in s, heights above the surface of the foam in m, released
        at rest at the first sample.
    moving_mass : float
        Mass that is dropped, in kg.
    gravity : float
        In m/s^2.
    confidence : float
        Level of the intervals, between 0 and 1.
    contact : str
        ``"unilateral"``: the foam lets go when its force would become a pull. ``"attached"``: it holds the
        mass until its own undeformed surface is reached.
    bootstrap : int
        Number of resamplings for `FoamFit.bootstrap_interval`; 0 for none.
    seed : int
        Seed of the resampling.
    progress : callable or None
        Called now and then as ``progress(done, total)`` with numbers of resamplings.

    Returns
    -------
    FoamFit
        Parameters with covariance and intervals.

    Raises
    ------
    InvalidParameterError
        If a signal is too short, unsorted or not finite, or a number is out of range.
    ShapeError
        If arrays of a pair differ in length.
    SimulationError
        If the fit does not converge.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import impact
    >>> compression = np.linspace(0.0, 0.01, 11)
    >>> time = np.arange(0.0, 0.3, 0.001)
    >>> drop = impact.identification.drop_trajectory(
    ...     time, height=0.05, mass=1.54, stiffness=24250.0, damping_ratio=0.112, friction=2.0)
    >>> fit = impact.identify_foam(24250.0 * compression, compression, time, drop, 1.54)
    >>> round(fit.stiffness), round(fit.damping_ratio, 6), round(fit.friction, 6)
    (24250, 0.112, 2.0)
    """
    force, compression = columns(static_force=static_force, static_compression=static_compression)
    drops = _drops(drop_time, drop_position)
    _check_squares(static_force=force, static_compression=compression)
    if len(force) == len(compression) > 0:
        with np.errstate(all="ignore"):
            slope = float(force @ compression / (compression @ compression))
        for index, (time, _) in enumerate(drops):
            _check_swings(f"drop_time[{index}]", time, "moving_mass", moving_mass, slope)
    mass, pull = number("moving_mass", moving_mass), number("gravity", gravity)
    if MOST_MASS < mass < np.inf:
        raise InvalidParameterError("moving_mass", f"be at most {MOST_MASS:g} kg", moving_mass)
    doubts = _static_warnings(force, compression) if len(force) else ()
    doubts += _drop_warnings(drops, mass, pull)
    try:
        result = _hrsafety.identify_foam(
            force,
            compression,
            drops,
            moving_mass=mass,
            gravity=pull,
            confidence=number("confidence", confidence),
            attached=word("contact", contact, _CONTACTS) == "attached",
            bootstrap=count("bootstrap", bootstrap, least=0, most=MOST_RESAMPLES),
            seed=checked_seed("seed", seed),
            progress=callback("progress", progress),
        )
    except InvalidParameterError as error:
        # What made the fit fail is most often a unit.
        if not doubts or error.remedy is not None:
            raise
        raise InvalidParameterError(error.argument, error.requirement, error.value, doubts[0].message) from None
    deepest = max(float(compression.max()), *(-float(position.min()) for _, position in drops))
    return FoamFit(**result, warnings=doubts + _foam_warnings(result["stiffness"]), largest_compression=deepest)


def _drops(drop_time: object, drop_position: object) -> list[tuple[Array, Array]]:
    """Return pairs of arrays, one for each drop."""
    times, positions = _signals("drop_time", drop_time), _signals("drop_position", drop_position)
    if len(times) != len(positions):
        raise ShapeError("drop_position", f"of {len(times)} drops, as drop_time", (len(positions),))
    pairs = []
    for index, (time, position) in enumerate(zip(times, positions, strict=True)):
        if time.shape != position.shape:
            raise ShapeError(f"drop_position[{index}]", f"({len(time)},)", position.shape)
        pairs.append((time, position))
    return pairs


def _signals(name: str, value: object) -> list[Array]:
    """Return one signal, or a sequence of signals, as a list of arrays."""
    rule = "be a signal or a sequence of signals"
    if isinstance(value, np.ndarray) and value.ndim == 0:
        raise InvalidParameterError(name, rule, value)
    if isinstance(value, (str, bytes)) or not isinstance(value, (Sequence, np.ndarray)) or len(value) == 0:
        raise InvalidParameterError(name, rule, value)
    try:
        alone = np.ndim(value[0]) == 0
    except ValueError:  # rows of different lengths
        raise InvalidParameterError(name, rule, value) from None
    if alone:
        return [vector(name, value)]
    return [vector(f"{name}[{index}]", each) for index, each in enumerate(value)]


def drop_trajectory(
    time: npt.ArrayLike,
    *,
    height: float,
    mass: float,
    stiffness: float,
    damping_ratio: float,
    friction: float = 0.0,
    gravity: float = 9.80665,
    contact: Contact = "unilateral",
) -> Array:
    """Return the height of a mass that is dropped on foam.

    Parameters
    ----------
    time : array_like of shape (n,)
        In s, increasing; released at rest at the first.
    height : float
        Height of release above the surface of the foam, in m.
    mass : float
        In kg.
    stiffness : float
        K_c in N/m.
    damping_ratio : float
        xi_c = C_c / (2 sqrt(m K_c)).
    friction : float
        Friction of the slide in N.
    gravity : float
        In m/s^2.
    contact : str
        As for `identify_foam`.

    Returns
    -------
    ndarray of shape (n,)
        Height above the surface in m, negative in the foam.

    Raises
    ------
    InvalidParameterError
        If a value is out of range or the times are not sorted.

    Examples
    --------
    >>> from hrsafety import impact
    >>> impact.identification.drop_trajectory(
    ...     [0.0, 0.05], height=0.05, mass=1.54, stiffness=24250.0, damping_ratio=0.112).round(6).tolist()
    [0.05, 0.037742]
    """
    instants, spring = vector("time", time), number("stiffness", stiffness)
    _check_swings("time", instants, "mass", mass, spring)
    return _hrsafety.drop_trajectory(
        instants,
        height=number("height", height),
        mass=number("mass", mass),
        stiffness=spring,
        damping_ratio=number("damping_ratio", damping_ratio),
        friction=number("friction", friction),
        gravity=number("gravity", gravity),
        attached=word("contact", contact, _CONTACTS) == "attached",
    )
