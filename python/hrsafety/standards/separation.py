"""Protective separation distance, its inverse, and the speed over the distance to a person."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, number, numbers, own, vector
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.plausibility import RANGES, ImplausibleWarning, ResultWarning, implausible, issue, warn_implausible
from hrsafety.tables import Columns, Table

__all__ = ["SpeedCurve", "StoppingData", "separation_distance", "separation_speed", "speed_over_distance"]

WALKING_SPEED = 1.6
"""Speed of a person in m/s whose speed is not measured."""
STANDING = 0.1
"""Below this speed, in m/s, a person stands rather than walks."""
BRAKED = (0.2, 1.05)
"""Way of a measured stop as a share of speed times time: half of it with a constant deceleration, all of it without."""
ROUNDED = 0.005
"""Measured times in s and distances in m are taken to be rounded to twice as much."""

_QUANTITIES = {
    "distance": "person_distance",
    "robot_speed": "approach_speed",
    "max_speed": "approach_speed",
    "contact_speed": "contact_speed",
    "target_speed": "contact_speed",
    "human_speed": "person_speed",
    "uncertainty": "position_uncertainty",
    "deceleration": "robot_deceleration",
}
_STOPS = {
    "stopping.speed": "approach_speed",
    "stopping.time": "stopping_time",
    "stopping.distance": "stopping_distance",
}
_NONE = ("intrusion", "uncertainty")
"""Distances of which 0 means that there is none."""


@dataclass(frozen=True, slots=True, eq=False)
class StoppingData(Parameters):
    """Measured stops: times and distances over speed, load and extension.

    Values in between are linear; outside the table nothing is known (``outside_table``). A distance of more than speed
    times time, or of less than a fifth of it, a stop of more than 25 m/s^2, and numbers as of ms, mm or mm/s are
    doubted (`doubts`) by all that takes these stops.

    Parameters
    ----------
    speed : array_like (n,)
        Speeds of the robot in m/s, increasing.
    time, distance : array_like (n,), (n, loads) or (n, loads, extensions)
        Stopping times in s and distances in m. They must not fall as the speed grows.
    load : array_like or float
        Payloads in kg, or shares of the largest one.
    extension : array_like or float
        Extensions of the arm in m, or shares of the largest one.

    Examples
    --------
    >>> from hrsafety import standards
    >>> stops = standards.StoppingData(speed=[0.0, 0.5, 1.0], time=[0.0, 0.2, 0.3], distance=[0.0, 0.05, 0.16])
    >>> rules = {"reaction_time": 0.1, "intrusion": 0.0, "uncertainty": 0.0}
    >>> found = standards.separation_distance(0.75, stopping=stops, **rules)
    >>> f"{found:.4f} m"
    '0.7400 m'
    """

    speed: Array
    time: Array
    distance: Array
    load: Array | float = 0.0
    extension: Array | float = 0.0

    def __post_init__(self) -> None:
        """Check the axes and the values."""
        axes = [np.atleast_1d(numbers(name, getattr(self, name))) for name in ("speed", "load", "extension")]
        for name, axis in zip(("speed", "load", "extension"), axes, strict=True):
            if axis.ndim != 1:
                raise ShapeError(name, "(n,)", axis.shape)
        shape = tuple(len(axis) for axis in axes)
        for name in ("time", "distance"):
            values = numbers(name, getattr(self, name))
            full = (*values.shape, *(1,) * (3 - values.ndim))
            if full != shape:
                raise ShapeError(name, str(shape), values.shape)
            self._set(**{name: own(values.reshape(shape))})
        self._set(speed=own(axes[0]), load=own(axes[1]), extension=own(axes[2]))
        self.curve(float(axes[1][0]), float(axes[2][0]))

    def curve(self, load: float | None = None, extension: float | None = None) -> _hrsafety.StoppingCurve:
        """Return the stops at one load and extension.

        Parameters
        ----------
        load, extension : float or None
            Within the table; needed where the table has more than one.

        Returns
        -------
        StoppingCurve
            For `separation_distance` and `separation_speed`.
        """
        values = {"load": load, "extension": extension}
        for name, value in values.items():
            axis = np.atleast_1d(getattr(self, name))
            if value is None:
                if len(axis) > 1:
                    raise InvalidParameterError(name, "be given: the stops were measured for several", Shown("none"))
                values[name] = float(axis[0])
        axes = [np.atleast_1d(getattr(self, name)).tolist() for name in ("speed", "load", "extension")]
        place = [number(name, value) for name, value in values.items()]
        return _hrsafety.StoppingCurve(axes, np.ravel(self.time), np.ravel(self.distance), *place)

    @property
    def doubts(self) -> tuple[ResultWarning, ...]:
        """Stops that no robot makes: odd numbers, a way beyond speed times time or hardly any of it, an odd time."""
        time, distance = np.asarray(self.time), np.asarray(self.distance)
        speed = np.broadcast_to(np.reshape(np.asarray(self.speed), (-1, 1, 1)), time.shape)
        least, most = (share * speed * time for share in BRAKED)
        long = distance - most - ROUNDED * (1.0 + speed)
        short = least - distance - ROUNDED
        sudden = speed - RANGES["robot_deceleration"].most * (time + ROUNDED)
        sudden = np.where((long > 0.0) | (short > 0.0), -1.0, sudden)  # told already
        words = (
            "a robot that brakes covers no more than speed times time: is the time too short, or the distance in "
            "another unit?",
            f"hardly {BRAKED[0]:g} of speed times time, where a steady brake takes half of it: is the distance in "
            "another unit, or the time longer than the stop?",
            f"a robot that brakes by {RANGES['robot_deceleration'].most:g} m/s^2 at most takes longer: is the time in "
            "another unit, or missing?",
        )
        named = {f"stopping.{name}": getattr(self, name) for name in ("speed", "time", "distance")}
        found = list(implausible(named, _STOPS))
        for beyond, why in zip((long, short, sudden), words, strict=True):
            held = (beyond > 0.0) & (speed > 0.0)
            if held.any():
                at = np.unravel_index(int(np.argmax(np.where(held, beyond, -np.inf))), held.shape)
                message = (
                    f"the stop from speed {speed[at]:g} m/s has time {time[at]:g} s and distance {distance[at]:g} m "
                    f"({np.count_nonzero(held)} of {held.size} such stops): {why}"
                )
                found.append(ResultWarning("stops_inconsistent", "stopping", message))
        return tuple(found)


def separation_distance(
    robot_speed: object,
    *,
    reaction_time: object,
    deceleration: object = None,
    human_speed: object = WALKING_SPEED,
    intrusion: object = None,
    uncertainty: object = None,
    target_speed: object = 0.0,
    stopping: StoppingData | None = None,
    load: float | None = None,
    extension: float | None = None,
) -> Any:
    """Return the protective separation distance of a robot and a person.

    S = v_h (T_r + (v - v_t)/a) + v T_r + (v^2 - v_t^2)/2a + C + Z. Arguments broadcast.

    Parameters
    ----------
    robot_speed : array_like
        Speed v of the robot towards the person in m/s, at least `target_speed`.
    reaction_time : array_like
        Time T_r before the robot begins to brake in s.
    deceleration : array_like or None
        Constant deceleration a in m/s^2; needed without `stopping`.
    human_speed : array_like
        Speed v_h of the person in m/s.
    intrusion : array_like or None
        Intrusion distance C in m; ``None`` is 0 and issues a warning.
    uncertainty : array_like or None
        Uncertainty Z = Z_d + Z_r of both positions in m; ``None`` is 0 and issues a warning.
    target_speed : array_like
        Speed v_t that the robot slows down to in m/s: 0 stops it before contact, an allowed contact speed does not.
    stopping : StoppingData or None
        Measured stops in place of `deceleration`. The whole stop counts, also with a target speed.
    load, extension : float or None
        Where to read them.

    Returns
    -------
    float or ndarray
        Distances S in m.

    Raises
    ------
    InvalidParameterError
        If a number is out of range, or a speed lies outside the measured stops.

    Warns
    -----
    ImplausibleWarning
        If a number is hardly meant in its unit, such as millimeters or milliseconds, or no robot makes a measured stop.
    HrsafetyWarning
        If intrusion or uncertainty is not given: the answer holds for none.

    Examples
    --------
    >>> from hrsafety import standards
    >>> rules = {"reaction_time": 0.1, "deceleration": 3.0, "intrusion": 0.2, "uncertainty": 0.1}
    >>> f"{standards.separation_distance(1.5, target_speed=0.3, **rules):.2f} m"
    '1.61 m'
    """
    taken, intrusion, uncertainty = _taken_as_none(intrusion, uncertainty, human_speed)
    rules = _rules(human_speed, reaction_time, intrusion, uncertainty, target_speed)
    speeds, rows, braking, shape = _rows("robot_speed", robot_speed, rules, deceleration, stopping)
    if stopping is None:
        found = _with_answer("robot_speed", speeds, _hrsafety.separation_distances(speeds, braking, rows))
    else:
        found = _stops(stopping).curve(load, extension).distances(speeds, rows)
    _warn(taken, stopping)
    warn_implausible(_doubted("robot_speed", speeds, rows, deceleration, braking), _QUANTITIES)
    return found.reshape(shape) if shape else float(found[0])


def separation_speed(
    distance: object,
    *,
    reaction_time: object,
    deceleration: object = None,
    human_speed: object = WALKING_SPEED,
    intrusion: object = None,
    uncertainty: object = None,
    target_speed: object = 0.0,
    stopping: StoppingData | None = None,
    load: float | None = None,
    extension: float | None = None,
) -> Any:
    """Return the largest speed that a distance to a person allows: the inverse of `separation_distance`.

    Parameters
    ----------
    distance : array_like
        Distance to the person in m.
    reaction_time, deceleration, human_speed, intrusion, uncertainty, target_speed, stopping, load, extension
        As for `separation_distance`.

    Returns
    -------
    float or ndarray
        Speeds in m/s: `target_speed` where the distance is too short for more, and never more than the largest
        measured one.

    Warns
    -----
    ImplausibleWarning, HrsafetyWarning
        As `separation_distance`.

    Examples
    --------
    >>> from hrsafety import standards
    >>> rules = {"reaction_time": 0.1, "deceleration": 3.0, "intrusion": 0.2, "uncertainty": 0.1}
    >>> f"{standards.separation_speed(1.0, target_speed=0.3, **rules):.7f} m/s"
    '0.9106939 m/s'
    """
    taken, intrusion, uncertainty = _taken_as_none(intrusion, uncertainty, human_speed)
    rules = _rules(human_speed, reaction_time, intrusion, uncertainty, target_speed)
    distances, rows, braking, shape = _rows("distance", distance, rules, deceleration, stopping)
    if stopping is None:
        found = _with_answer("distance", distances, _hrsafety.separation_speeds(distances, braking, rows))
    else:
        found, _ = _stops(stopping).curve(load, extension).speeds(distances, rows)
    _warn(taken, stopping)
    warn_implausible(_doubted("distance", distances, rows, deceleration, braking), _QUANTITIES)
    return found.reshape(shape) if shape else float(found[0])


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SpeedCurve(Table):
    """Allowed speed over the distance to a person.

    Parameters
    ----------
    distance : ndarray (n,)
        Distances in m.
    speed : ndarray (n,)
        Allowed speeds in m/s.
    mode : ndarray (n,) of str
        ``"contact"`` where the allowed contact speed is the larger one, else ``"separation"``.
    capped : ndarray (n,) of bool
        Whether the largest speed of the robot is what limits it.
    outside_table : ndarray (n,) of bool
        Whether the distance allows more than the largest measured speed, which is then the speed.
    status : str
        ``"permitted"`` where contact has an allowed speed, ``"not_permitted"`` where it has none.
    warnings : tuple of ResultWarning
        Numbers that are hardly meant in their unit, measured stops that no robot makes, and what was taken as 0 because
        it was not given.
    """

    distance: Annotated[Array, "m"]
    speed: Annotated[Array, "m/s"]
    mode: npt.NDArray[np.str_]
    capped: npt.NDArray[np.bool_]
    outside_table: npt.NDArray[np.bool_]
    status: str = field(default="permitted")
    warnings: tuple[ResultWarning, ...] = ()

    def columns(self) -> Columns:
        """Return the table as columns.

        Returns
        -------
        dict of str to ndarray
            Distance, speed, mode and both flags.
        """
        return {
            "distance_m": self.distance,
            "speed_m_per_s": self.speed,
            "mode": self.mode,
            "capped": self.capped,
            "outside_table": self.outside_table,
        }


def speed_over_distance(
    distance: object,
    *,
    contact_speed: float | None,
    max_speed: float,
    reaction_time: float,
    deceleration: float | None = None,
    human_speed: float = WALKING_SPEED,
    intrusion: float | None = None,
    uncertainty: float | None = None,
    target_speed: float = 0.0,
    stopping: StoppingData | None = None,
    load: float | None = None,
    extension: float | None = None,
) -> SpeedCurve:
    """Return the speed that is allowed at each distance: that of contact or that of separation, the larger one.

    Parameters
    ----------
    distance : array_like (n,)
        Distances to the person in m.
    contact_speed : float or None
        Allowed contact speed of the robot in m/s; ``None`` where contact is not permitted, such as with the head
        within reach. More than 2 m/s is a doubt.
    max_speed : float
        Largest speed of the robot in m/s.
    reaction_time, deceleration, human_speed, intrusion, uncertainty, target_speed, stopping, load, extension
        As for `separation_distance`; a target speed of `contact_speed` slows down to it instead of to rest.

    Returns
    -------
    SpeedCurve
        Speeds with the mode of each.

    Examples
    --------
    >>> from hrsafety import standards
    >>> curve = standards.speed_over_distance(
    ...     [0.2, 1.0, 5.0], contact_speed=0.25, max_speed=1.5, reaction_time=0.1, deceleration=3.0,
    ...     intrusion=0.0, uncertainty=0.0,
    ... )
    >>> curve.mode.tolist(), curve.capped.tolist()
    (['contact', 'separation', 'separation'], [False, False, True])
    """
    given = vector("distance", distance)
    most = number("max_speed", max_speed)
    if not 0.0 < most < np.inf:
        raise InvalidParameterError("max_speed", "be finite and positive", max_speed)
    contact = 0.0 if contact_speed is None else number("contact_speed", contact_speed)
    if not 0.0 <= contact < np.inf:
        raise InvalidParameterError("contact_speed", "be finite and not negative, or None", contact_speed)
    target = number("target_speed", target_speed)
    if target > contact:
        raise InvalidParameterError("target_speed", f"be at most contact_speed ({contact:g})", target_speed)
    taken, intrusion, uncertainty = _taken_as_none(intrusion, uncertainty, human_speed)
    rules = _rules(human_speed, reaction_time, intrusion, uncertainty, target)
    single: dict[str, object] = {name: number(name, each) for name, each in rules.items()}
    braked = None if deceleration is None else number("deceleration", deceleration)
    distances, rows, braking, _ = _rows("distance", given, single, braked, stopping)
    if stopping is None:
        apart = _with_answer("distance", distances, _hrsafety.separation_speeds(distances, braking, rows))
        beyond = np.zeros(len(given), dtype=bool)
    else:
        apart, beyond = _stops(stopping).curve(load, extension).speeds(distances, rows)
    speed = np.maximum(apart, contact)
    return SpeedCurve(
        distance=given,
        speed=np.minimum(speed, most),
        mode=np.where(apart > contact, "separation", "contact"),
        capped=speed > most,
        outside_table=beyond & (apart >= contact) & (speed <= most),
        status="not_permitted" if contact_speed is None else "permitted",
        warnings=(
            *taken,
            *(() if stopping is None else stopping.doubts),
            *implausible(
                {
                    "distance": given,
                    **single,
                    **{each: single[each] or None for each in _NONE},
                    "contact_speed": contact_speed,
                    "max_speed": most,
                    "deceleration": braked,
                },
                _QUANTITIES,
            ),
        ),
    )


def _doubted(
    name: str, given: Array, rows: dict[str, Array], deceleration: object, braking: Array
) -> dict[str, object]:
    """Return the numbers of an answer that may be implausible, by name: each once where all rows share it."""
    columns = {name: given, **rows} | ({} if deceleration is None else {"deceleration": braking})
    columns |= {each: np.where(columns[each] == 0.0, np.nan, columns[each]) for each in _NONE}
    return {key: float(each[0]) if len(each) and (each == each[0]).all() else each for key, each in columns.items()}


# ---- what is not given --------------------------------------------------------------------------


def _taken_as_none(intrusion: Any, uncertainty: Any, human_speed: object) -> tuple[tuple[ResultWarning, ...], Any, Any]:
    """Return doubts about what is taken as 0, and intrusion and uncertainty with 0 where they are not given."""
    found = []
    missing = [name for name, each in (("intrusion", intrusion), ("uncertainty", uncertainty)) if each is None]
    if missing:
        words = (
            f"no {' and no '.join(missing)} given, taken as 0 m: a distance with them is longer; give 0 where there is "
            "none"
        )
        found.append(ResultWarning("taken_as_zero", " and ".join(missing), words))
    walking = numbers("human_speed", human_speed)
    if walking.size and float(np.max(walking)) < STANDING:
        words = (
            f"human_speed is {float(np.max(walking)):g} m/s: people are taken to stand still, and a distance to "
            f"somebody who walks is longer; {WALKING_SPEED:g} m/s where nothing was measured"
        )
        found.append(ResultWarning("taken_as_zero", "human_speed", words))
    return tuple(found), 0.0 if intrusion is None else intrusion, 0.0 if uncertainty is None else uncertainty


def slow_person(name: str, speed: float, what: str) -> tuple[ResultWarning, ...]:
    """Return the doubt about people who are taken to be slower than ISO 13855 takes them.

    Parameters
    ----------
    name : str
        Of the speed.
    speed : float
        Of people in m/s.
    what : str
        What holds for them alone, in the plural.

    Returns
    -------
    tuple of ResultWarning
        ``slow_person``, or nothing.
    """
    if not speed < WALKING_SPEED:
        return ()
    words = (
        f"{name} is {speed:g} m/s: {what} hold for people who are no faster, and ISO 13855 has {WALKING_SPEED:g} m/s"
    )
    return (ResultWarning("slow_person", name, words),)


def lighter_load(
    subject: str, stopping: StoppingData, load: float | None, payload: float | None
) -> tuple[ResultWarning, ...]:
    """Return the doubt about stops that were measured with less than the robot carries.

    Parameters
    ----------
    subject : str
        Name of the stops.
    stopping : StoppingData
        Measured stops.
    load : float or None
        Where they are read.
    payload : float or None
        What the robot carries in kg; ``None`` where that is not known.

    Returns
    -------
    tuple of ResultWarning
        ``lighter_load``, or nothing: loads up to 1 may be shares of the largest one.
    """
    loads = np.atleast_1d(stopping.load)
    read = float(loads[0]) if load is None else load
    if payload is None or float(loads.max()) <= 1.0 or read >= payload:
        return ()
    words = (
        f"the stops are those with a load of {read:g} kg, and the robot carries {payload:g} kg: it may need longer; "
        "give stops with that load"
    )
    return (ResultWarning("lighter_load", subject, words),)


def _warn(taken: tuple[ResultWarning, ...], stopping: StoppingData | None) -> None:
    """Issue the doubts of a plain number, which carries none, at the caller of the function that returns it."""
    for doubt in taken:
        issue(doubt.message, stacklevel=3)
    for doubt in () if stopping is None else stopping.doubts:
        issue(doubt.message, ImplausibleWarning, stacklevel=3)


# ---- crossing the boundary ----------------------------------------------------------------------


def _stops(stopping: object) -> StoppingData:
    if not isinstance(stopping, StoppingData):
        raise InvalidParameterError("stopping", "be StoppingData", stopping)
    return stopping


def _with_answer(name: str, given: Array, found: Array) -> Array:
    """Return what was found; squares and quotients of extreme numbers leave the range of numbers."""
    empty = np.isnan(found)
    if empty.any():
        row = int(np.argmax(empty))
        label = name if len(given) == 1 else f"{name}[{row}]"
        raise InvalidParameterError(label, "have an answer with the other numbers", float(given[row]))
    return found


def _rules(
    human_speed: object, reaction_time: object, intrusion: object, uncertainty: object, target_speed: object
) -> dict[str, object]:
    """Return what a distance depends on beside the speed and the stop, by name."""
    return {
        "human_speed": human_speed,
        "reaction_time": reaction_time,
        "intrusion": intrusion,
        "uncertainty": uncertainty,
        "target_speed": target_speed,
    }


def _rows(
    name: str, value: object, rules: dict[str, object], deceleration: object, stopping: StoppingData | None
) -> tuple[Array, dict[str, Array], Array, tuple[int, ...]]:
    """Return all numbers as columns of one length, and the shape that they broadcast to."""
    if (deceleration is None) == (stopping is None):
        rule = "be given, or stopping in its place"
        raise InvalidParameterError("deceleration", rule, Shown("none") if deceleration is None else Shown("both"))
    given = {name: value, **rules, "deceleration": 1.0 if deceleration is None else deceleration}
    arrays = {key: numbers(key, each) for key, each in given.items()}
    try:
        spread = np.broadcast_arrays(*arrays.values())
    except ValueError:
        shown = ", ".join(f"{key} {array.shape}" for key, array in arrays.items() if array.ndim)
        raise InvalidParameterError(name, "broadcast with the other arguments", Shown(shown)) from None
    columns = {key: np.ascontiguousarray(array).ravel() for key, array in zip(arrays, spread, strict=True)}
    first, braking = columns.pop(name), columns.pop("deceleration")
    return first, columns, braking, spread[0].shape
