"""Warnings that travel with a result, and the ranges outside which a number is hardly what was meant.

A number can obey every rule of its argument and still be wrong: milliseconds given for seconds,
m/s^2 for g, grams for kilograms. `RANGES` holds, for each quantity, the range that people, robots and
coverings of this field have; a value outside gives a `ResultWarning`, which every result, table, page
and picture shows. Nothing is refused here and nothing is changed.
"""

from __future__ import annotations

import functools
import re
import sys
import threading
import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple, TypeVar

import numpy as np

from hrsafety._calls import suggest, suggesting
from hrsafety._records import dataclass
from hrsafety._words import meant
from hrsafety.errors import InvalidParameterError

__all__ = [
    "RANGES",
    "HrsafetyWarning",
    "ImplausibleWarning",
    "Range",
    "ResultWarning",
    "UnitWarning",
    "gathered",
    "implausible",
    "issue",
    "telling",
    "unsafe_doubts",
    "warn_implausible",
]


@dataclass(frozen=True, slots=True)
class ResultWarning:
    """Why a result may not mean what it seems to.

    Parameters
    ----------
    code : str
        Kind of doubt, one word for programs, for example ``"implausible"``.
    subject : str
        What it is about: an argument, with its owner and index (``"obstacles[2].critical_radius"``).
    message : str
        One sentence that names the value, the rule, and what would mend it.
    safe_side : bool
        Whether the result is certain to be the more careful one if the doubt is right. Any other doubt takes part in
        verdicts: ``"within_limits"`` becomes ``"not_checked"``.

    Examples
    --------
    >>> from hrsafety.plausibility import ResultWarning
    >>> print(ResultWarning("implausible", "heading", "heading is 90 rad, ..."))
    warning: heading is 90 rad, ...
    """

    code: str
    subject: str
    message: str
    safe_side: bool = False

    def __str__(self) -> str:
        """Return the line that is printed."""
        return f"warning: {self.message}"


def unsafe_doubts(warnings: Iterable[ResultWarning]) -> tuple[ResultWarning, ...]:
    """Return the warnings whose error may lie on the unsafe side: with any of them a verdict is not checked.

    Parameters
    ----------
    warnings : iterable of ResultWarning
        Of a result.

    Returns
    -------
    tuple of ResultWarning
        Those without `safe_side`, in their order.

    Examples
    --------
    >>> from hrsafety.plausibility import ResultWarning, unsafe_doubts
    >>> light = ResultWarning("implausible", "robot_mass", "robot_mass is 0.008 kg")
    >>> heavy = ResultWarning("implausible", "robot_mass", "robot_mass is 20000 kg", safe_side=True)
    >>> [doubt.message for doubt in unsafe_doubts([light, heavy])]
    ['robot_mass is 0.008 kg']
    """
    return tuple(doubt for doubt in warnings if not doubt.safe_side)


class HrsafetyWarning(UserWarning):
    """Category of every warning that the package issues through `warnings.warn`.

    Examples
    --------
    >>> import warnings
    >>> from hrsafety.plausibility import HrsafetyWarning
    >>> warnings.filterwarnings("ignore", category=HrsafetyWarning)  # a script that looks at `.warnings` itself
    """


class UnitWarning(HrsafetyWarning):
    """A number that is hardly meant in its unit, of which the result of the call carries a `ResultWarning`, too."""


class ImplausibleWarning(HrsafetyWarning):
    """A number that is hardly meant in its unit, given to a function whose answer is a plain number."""


F = TypeVar("F", bound=Callable[..., Any])
_PACKAGE = __name__.partition(".")[0]


def telling(find: Callable[..., Iterable[ResultWarning]] | None = None, *, every: bool = False) -> Callable[[F], F]:
    """Make a function issue doubts about units as `UnitWarning`, at the line that called it.

    Once for each call of a user: not for calls within the package, whose own caller is told, and not in threads and
    processes of workers. The result carries the same doubts and others.

    Parameters
    ----------
    find : callable or None
        Returns the doubts from the arguments of the call; ``None``: those of the result.
    every : bool
        Whether all doubts on the unsafe side are issued, as `HrsafetyWarning`: of what runs without a result.

    Returns
    -------
    callable
        The decorator.

    Examples
    --------
    >>> import warnings
    >>> from hrsafety import impact
    >>> program = "impact.metrics(impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum(), closing_speed=1250.0)"
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     _ = eval(program, {"impact": impact})
    >>> [each.category.__name__ for each in caught]
    ['UnitWarning']
    """

    def decorate(function: F) -> F:
        asked = suggesting(function)

        @functools.wraps(function)
        def call(*args: Any, **kwargs: Any) -> Any:
            result = asked(*args, **kwargs)
            carried: Iterable[ResultWarning] = getattr(result, "warnings", ()) if find is None else ()
            if (carried or find) and _is_user(sys._getframe(1).f_globals.get("__name__", "")):
                found = carried if find is None else find(*args, **kwargs)
                found = tuple(found)
                for message in _kinds(each for each in found if each.code == "implausible"):
                    warnings.warn(message, UnitWarning, stacklevel=2)
                others = unsafe_doubts(each for each in found if every and each.code != "implausible")
                for message in _kinds(others):
                    warnings.warn(message, HrsafetyWarning, stacklevel=2)
            return result

        return call  # type: ignore[return-value]  # the same arguments and result

    return decorate


def _kinds(found: Iterable[ResultWarning]) -> Iterable[str]:
    """Return the first message of each kind: the others differ by indices only, and the result carries them."""
    kinds: dict[tuple[str, str], str] = {}
    for each in found:
        kinds.setdefault((each.code, re.sub(r"\d+", "", each.subject)), each.message)
    return dict.fromkeys(kinds.values())


def _is_user(module: object) -> bool:
    """Return whether code of a module is notified of doubts: outside of the package, and not at work for a pool."""
    if str(module).partition(".")[0] == _PACKAGE or threading.current_thread() is not threading.main_thread():
        return False
    process = sys.modules.get("multiprocessing.process")
    return process is None or process.parent_process() is None


_INDEX = re.compile(r"\[\d+\]")


def kind_of(doubt: ResultWarning) -> tuple[str, str]:
    """Return what a doubt shares with those of its kind: its code, and what it is about without indices."""
    return doubt.code, _INDEX.sub("", doubt.subject)


def gathered(found: Iterable[tuple[str, Iterable[ResultWarning]]], among: str) -> tuple[ResultWarning, ...]:
    """Return the first warning of each kind with the number of the others.

    Parameters
    ----------
    found : iterable of (str, iterable of ResultWarning)
        Names of results with their warnings.
    among : str
        What the results are of, in the plural.

    Returns
    -------
    tuple of ResultWarning
        One for each code and part that it is about, whatever its index, in the order in which they were found, with the
        name before subject and message.

    Examples
    --------
    >>> from hrsafety.plausibility import ResultWarning, gathered
    >>> doubt = ResultWarning("implausible", "heading", "heading is 90 rad")
    >>> print(*gathered([("first", [doubt]), ("second", [doubt])], "scenarios"))
    warning: first: heading is 90 rad (1 more of this kind in these scenarios)
    """
    first: dict[tuple[str, str], ResultWarning] = {}
    others: dict[tuple[str, str], int] = {}
    for name, told in found:
        for each in dict.fromkeys(told):
            kind = kind_of(each)
            if kind in first:
                others[kind] = others.get(kind, 0) + 1
                if first[kind].safe_side and not each.safe_side:
                    first[kind] = replace(first[kind], safe_side=False)
            else:
                first[kind] = replace(each, subject=f"{name}.{each.subject}", message=f"{name}: {each.message}")
    more = {kind: f" ({count} more of this kind in these {among})" for kind, count in others.items()}
    return tuple(replace(each, message=each.message + more.get(kind, "")) for kind, each in first.items())


class Range(NamedTuple):
    """Plausible values of one quantity.

    Attributes
    ----------
    least, most : float
        Ends of the range; a value on an end is plausible.
    unit : str
        Unit of both ends.
    source : str
        Where the range comes from.
    hint : str
        The mistake that most often leads outside.
    """

    least: float
    most: float
    unit: str
    source: str
    hint: str


# Filled below each heading by the part that uses it; wide on purpose.
RANGES: dict[str, Range] = {
    # ---- navigation -------------------------------------------------------------------------
    "heading": Range(-2 * np.pi, 2 * np.pi, "rad", "one turn either way", "degrees given for radians"),
    "robot_max_speed": Range(
        0.01, 10.0, "m/s", "slowest inspection robots to fast delivery robots", "mm/s or km/h given for m/s"
    ),
    "walking_speed": Range(
        0.01,
        4.0,
        "m/s",
        "people who wait to people who run slowly",
        "millimeters or pixels given for meters, or frames or milliseconds for seconds",
    ),
    "running_speed": Range(
        0.0,
        12.5,
        "m/s",
        "fastest sprint over 100 m",
        "ids that changed from one person to another, or a wrong position",
    ),
    "robot_mass": Range(0.05, 10000.0, "kg", "palm-sized robots to heavy industrial trucks", "g or t given for kg"),
    "robot_radius": Range(0.01, 5.0, "m", "palm-sized robots to heavy industrial trucks", "mm or cm given for m"),
    "nav2_radius": Range(0.08, 5.0, "m", "the smallest robots with Nav2 to heavy trucks", "mm or cm given for m"),
    "robot_max_acceleration": Range(
        0.01, 50.0, "m/s^2", "heavy trucks to what rubber tires hold several times over", "g or mm/s^2 given for m/s^2"
    ),
    "robot_max_angular_acceleration": Range(
        0.01, 2000.0, "rad/s^2", "heavy trucks to light two-wheel robots", "degrees given for radians"
    ),
    "robot_max_deceleration": Range(
        0.01, 50.0, "m/s^2", "heavy trucks to what rubber tires hold several times over", "g or mm/s^2 given for m/s^2"
    ),
    "base_deceleration": Range(
        0.01, 10.0, "m/s^2", "heavy trucks to locked wheels of rubber, about 1 g", "g or mm/s^2 given for m/s^2"
    ),
    "base_turn_deceleration": Range(
        0.01, 50.0, "rad/s^2", "heavy trucks to small robots that spin", "degrees given for radians"
    ),
    "base_rim_deceleration": Range(
        0.0, 20.0, "m/s^2", "wheels nearer to the center hold about 1 g", "degrees given for radians"
    ),
    "beam_step": Range(
        2e-4, np.pi / 4.0, "rad", "0.0115 degrees, finer than any scanner of floors", "radians given for degrees"
    ),
    "leg_radius": Range(0.02, 0.1, "m", "legs of children to thighs", "a diameter, mm or cm given for a radius in m"),
    "robot_max_turn_rate": Range(
        0.01, 20.0, "rad/s", "heavy trucks to small robots that spin", "degrees given for radians"
    ),
    "robot_max_turn_acceleration": Range(
        0.01, 2000.0, "rad/s^2", "heavy trucks to light two-wheel robots", "degrees given for radians"
    ),
    "control_period": Range(1e-4, 1.0, "s", "fastest servo loops to slow planners", "ms given for s"),
    "time_limit": Range(0.1, 86400.0, "s", "one evasion to one day", "ms given for s"),
    "arrival_tolerance": Range(1e-4, 5.0, "m", "accurate docking to large vehicles", "mm or cm given for m"),
    "floor_position": Range(-10000.0, 10000.0, "m", "the largest sites", "mm given for m"),
    "map_resolution": Range(0.005, 1.0, "m", "fine to coarse grids of floors", "mm, or cells per meter, given for m"),
    "plan_extent": Range(1.0, 5000.0, "m", "a small room to a large site", "another unit, or a drawing on paper"),
    "region_clearance": Range(0.0, 30.0, "m", "touching to the way of a fast truck", "mm or cm given for m"),
    "region_radius": Range(0.01, 30.0, "m", "a small disc to the way of a fast truck", "mm or cm given for m"),
    "obstacle_size": Range(0.005, 1000.0, "m", "thin poles to long walls", "mm or cm given for m"),
    "person_radius": Range(0.1, 1.0, "m", "a child to a long step with room around it", "mm or cm given for m"),
    "person_speed": Range(
        0.0, 12.5, "m/s", "standing to the fastest sprinter ever timed", "mm/s or km/h given for m/s"
    ),
    "expected_speed": Range(
        0.5, 12.5, "m/s", "a slow walk to the fastest sprinter ever timed", "another unit, or people at rest expected"
    ),
    "shield_latency": Range(0.0, 2.0, "s", "immediate to slow networks", "ms given for s"),
    "shield_margin": Range(0.0, 1.0, "m", "none to a whole step", "mm or cm given for m"),
    "pursuer_speed": Range(
        0.01, 12.5, "m/s", "hardly moving to the fastest sprinter ever timed", "mm/s or km/h given for m/s"
    ),
    "obstacle_speed": Range(0.0, 40.0, "m/s", "standing to road vehicles", "mm/s or km/h given for m/s"),
    "measurement_scale": Range(0.0, 1.0, "m", "exact to coarse radio positioning", "mm or cm given for m"),
    "lidar_range": Range(0.0, 500.0, "m", "touching to the farthest scanners", "mm or cm given for m"),
    "lidar_noise": Range(0.0, 0.5, "m", "exact to coarse sonars", "mm or cm given for m"),
    "mounting_offset": Range(-10.0, 10.0, "m", "within the largest trucks", "mm or cm given for m"),
    "latency": Range(0.0, 5.0, "s", "immediate to very slow networks", "ms given for s"),
    # ---- impact -----------------------------------------------------------------------------
    "manipulator_mass": Range(
        0.05, 1000.0, "kg", "one finger to a car-body robot, effective at a point", "grams given for kilograms"
    ),
    "manipulator_damping": Range(
        0.0, 1e5, "N s/m", "Table 3.1 of Zeng (2011) has 111 and 250", "N s/mm given for N s/m"
    ),
    "manipulator_stiffness": Range(
        100.0, 1e8, "N/m", "soft joint control to the links themselves", "N/mm or kN/m given for N/m"
    ),
    "foam_stiffness": Range(
        200.0,
        1e7,
        "N/m",
        "softer than any covering of Table 3.3 of Zeng (2011) to hard rubber",
        "N/mm or kN/m given for N/m",
    ),
    "foam_damping": Range(0.0, 1e4, "N s/m", "Table 3.3 of Zeng (2011) has 44 to 114", "N s/mm given for N s/m"),
    "thickness": Range(0.0005, 0.5, "m", "skin of rubber to an airbag", "millimeters given for meters"),
    "linear_range": Range(0.0002, 0.5, "m", "a part of the thickness", "millimeters given for meters"),
    "head_mass": Range(
        1.0, 12.0, "kg", "newborn to adult with helmet; 4.4 to 5.3 in Zeng (2011)", "grams given for kilograms"
    ),
    "head_damping": Range(0.0, 1e4, "N s/m", "46 to 130 in Zeng (2011)", "N s/mm given for N s/m"),
    "head_stiffness": Range(
        100.0, 1e7, "N/m", "3 to 5 kN/m in Zeng (2011), a clamped head", "N/mm or kN/m given for N/m"
    ),
    "closing_speed": Range(
        0.001,
        12.0,
        "m/s",
        "creeping robots to the fastest industrial arms meeting a runner",
        "mm/s or cm/s given for m/s",
    ),
    "manipulator_speed": Range(-12.0, 12.0, "m/s", "the fastest industrial arms", "mm/s or cm/s given for m/s"),
    "impact_time": Range(1e-4, 20.0, "s", "an impact takes milliseconds", "milliseconds given for seconds"),
    "sampling_step": Range(
        1e-8,
        0.00167,
        "s",
        "ISO 6487: ten samples per hertz of the class, CFC 60 at least",
        "milliseconds given for seconds",
    ),
    "head_acceleration_g": Range(-500.0, 500.0, "g", "far above skull fracture", "m/s^2 given for g"),
    "head_velocity_gain": Range(
        -10.0, 10.0, "m/s", "head forms of FMVSS 201 at 6.7 m/s, with rebound", "m/s^2 given for g"
    ),
    "apparent_head_mass": Range(
        1.0, 50.0, "kg", "peak force over peak acceleration; a head has 3 to 7 kg", "m/s^2 given for g, or kN for N"
    ),
    "contact_force": Range(-1e5, 1e5, "N", "far above what breaks a skull", "mN given for N"),
    "compression": Range(-0.5, 0.5, "m", "no covering is thicker", "millimeters given for meters"),
    "peak_head_acceleration_g": Range(0.1, 90.0, "g", "FMVSS 201 allows 80 g over 3 ms", "m/s^2 given for g"),
    "recorded_peak_g": Range(0.1, 500.0, "g", "touch to far above skull fracture", "V given for g, or m/s^2"),
    "peak_contact_force": Range(5.0, 2e4, "N", "touch to a limit of crash tests", "kN given for N"),
    "hic15": Range(0.01, 1000.0, "", "FMVSS 208 allows 700", "a window or an acceleration in another unit"),
    "hic36": Range(0.01, 1500.0, "", "FMVSS 208 allowed 1000", "a window or an acceleration in another unit"),
    "max_compression": Range(0.0002, 0.5, "m", "no covering is thicker", "millimeters given for meters"),
    "moving_mass": Range(0.01, 200.0, "kg", "slides of drop rigs", "grams given for kilograms"),
    "drop_height": Range(-0.5, 10.0, "m", "drop rigs", "millimeters given for meters"),
    "drop_step": Range(1e-7, 0.02, "s", "a bounce takes some 20 ms", "milliseconds given for seconds"),
    "static_force": Range(-1e5, 1e5, "N", "presses for foam", "mN given for N"),
    "gravity": Range(1.6, 25.0, "m/s^2", "Moon to Jupiter", "g or mm/s^2 given for m/s^2"),
    # ---- contact ----------------------------------------------------------------------------
    "effective_mass": Range(0.3, 10000.0, "kg", "the lightest arms to a heavy industrial truck", "g or t given for kg"),
    "body_mass": Range(0.05, 300.0, "kg", "a finger to a heavy person; ISO/TS 15066 has 0.6 to 75", "g given for kg"),
    "region_stiffness": Range(500.0, 1e7, "N/m", "ISO/TS 15066 has 10,000 to 150,000", "N/mm or kN/m given for N/m"),
    "drive_stiffness": Range(
        500.0, 1e9, "N/m", "soft impedance control to a rigid frame", "N/mm or kN/m given for N/m"
    ),
    "drive_force": Range(5.0, 1e5, "N", "the lightest arms to heavy industrial robots", "kN given for N"),
    # 0 is the first touch, which who asks passes over.
    "detection_force": Range(0.5, 2000.0, "N", "a skin for touch to heavy industrial robots", "kN given for N"),
    # A body region is smaller than a back; 1 cm^2, the area of many tests, must not pass as 1 m^2.
    "contact_area": Range(1e-6, 0.3, "m^2", "1 mm^2 to the back of a person", "mm^2 or cm^2 given for m^2"),
    "contact_radius": Range(1e-4, 100.0, "m", "an edge to nearly flat", "mm or cm given for m"),
    "covering_stress": Range(300.0, 1e10, "Pa", "the softest foams to hard plastics", "kPa or MPa given for Pa"),
    "covering_strain": Range(0.0, 1.0, "", "nothing is pressed to less than nothing", "percent given for shares"),
    "yield_strain": Range(0.002, 0.5, "", "plateau over modulus of foams, some 0.05", "kPa or MPa given for Pa"),
    "covering_thickness": Range(0.0005, 0.2, "m", "skin of rubber to thick cushions", "mm or cm given for m"),
    "force_limit": Range(5.0, 5000.0, "N", "ISO/TS 15066 has 65 to 440", "kN given for N"),
    "pressure_limit": Range(1e4, 1e8, "Pa", "ISO/TS 15066 has 1.1 to 6 MPa", "N/cm^2 or N/mm^2 given for Pa"),
    "person_distance": Range(0.0, 100.0, "m", "farther than any safety sensor sees", "mm or cm given for m"),
    "approach_speed": Range(
        0.0, 20.0, "m/s", "standing to twice the fastest industrial arms", "mm/s or cm/s given for m/s"
    ),
    "contact_speed": Range(0.0, 2.0, "m/s", "ISO/TS 15066 allows light robots some 1.5", "mm/s or cm/s given for m/s"),
    "load_force": Range(1.0, 1e5, "N", "touch to far above what breaks a skull", "kN given for N"),
    "peak_pressure": Range(1e4, 1e8, "Pa", "ISO/TS 15066 has 1.1 to 6 MPa", "kPa, N/cm^2 or N/mm^2 given for Pa"),
    "foil_pitch": Range(2e-4, 0.02, "m", "cells of foils have 0.6 to 10 mm", "mm or cm given for m"),
    "load_pressure": Range(1e3, 1e9, "Pa", "touch to hard plastics", "N/cm^2 or N/mm^2 given for Pa"),
    "reaction_time": Range(0.002, 5.0, "s", "one cycle of a fast control to very slow ones", "ms given for s"),
    "stopping_time": Range(0.0, 60.0, "s", "a fast truck that brakes gently", "ms given for s"),
    "stopping_distance": Range(0.0, 500.0, "m", "a fast truck that brakes gently", "mm or cm given for m"),
    # Both of the next are 0 where there is none, which who asks passes over.
    "intrusion": Range(0.008, 5.0, "m", "ISO 13855 has 8 mm to 1.2 m", "mm or cm given for m, or turned into m twice"),
    "position_uncertainty": Range(
        0.001, 5.0, "m", "the best scanners to coarse radio positioning", "mm or cm given for m, or turned into m twice"
    ),
    "robot_deceleration": Range(
        0.0, 25.0, "m/s^2", "heavy robots to more than twice gravity", "g or mm/s^2 given for m/s^2"
    ),
    "arm_reach": Range(0.02, 10.0, "m", "a finger to the largest industrial arms", "mm or cm given for m"),
    "arm_moving_mass": Range(0.0, 6000.0, "kg", "nothing to the heaviest industrial arms", "g or t given for kg"),
    "wheel_radius": Range(0.01, 1.0, "m", "casters to wheels of trucks", "mm or cm given for m"),
    "half_track": Range(0.02, 3.0, "m", "palm-sized robots to wide trucks", "mm or cm given for m"),
    "axle_offset": Range(0.0, 3.0, "m", "above the axle to a long truck", "mm or cm given for m"),
    "damping_ratio": Range(
        0.0, 10.0, "", "0.11 for the foams of Zeng (2011)", "a damping in N s/m given for its ratio"
    ),
}


def implausible(values: Mapping[str, object], quantities: Mapping[str, str] | None = None) -> tuple[ResultWarning, ...]:
    """Return a warning for every value outside the plausible range of its quantity.

    Parameters
    ----------
    values : mapping of str to float or array
        Numbers by the name under which the caller gave them. NaN and ``None`` are passed over.
    quantities : mapping of str to str or None
        Key in `RANGES` of each name where it differs from the name.

    Returns
    -------
    tuple of ResultWarning
        In the order of ``values``; empty when all are plausible.

    Examples
    --------
    >>> from hrsafety.plausibility import implausible
    >>> [found.subject for found in implausible({"heading": 90.0})]
    ['heading']
    """
    return tuple(_implausible(values, quantities or {}))


def warn_implausible(
    values: Mapping[str, object], quantities: Mapping[str, str] | None = None, *, stacklevel: int = 3
) -> None:
    """Issue an `ImplausibleWarning` for every value outside the plausible range of its quantity.

    For functions that return numbers or arrays, which carry no warnings of their own.

    Parameters
    ----------
    values, quantities
        As for `implausible`.
    stacklevel : int
        Which caller the warnings point at: 3 is that of the function which calls this one.

    Examples
    --------
    >>> import warnings
    >>> from hrsafety.plausibility import warn_implausible
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     warn_implausible({"heading": 90.0})
    >>> caught[0].category.__name__
    'ImplausibleWarning'
    """
    for found in _implausible(values, quantities or {}):
        issue(found.message, ImplausibleWarning, stacklevel=stacklevel + 1)


def issue(message: str, category: type[HrsafetyWarning] = HrsafetyWarning, *, stacklevel: int = 2) -> None:
    """Issue a warning at a caller as `warnings.warn` does; functions that only pass calls on do not count.

    Parameters
    ----------
    message : str
        What is told.
    category : type
        Of the warning.
    stacklevel : int
        Which caller the warning points at: 2 is that of the function which calls this one.
    """
    level, counted, frame = 1, 1, sys._getframe()
    while frame.f_back is not None and counted < stacklevel:
        frame = frame.f_back
        level += 1
        counted += frame.f_globals.get("__name__") != suggesting.__module__
    warnings.warn(message, category, stacklevel=level)


def _implausible(values: Mapping[str, object], quantities: Mapping[str, str]) -> Iterable[ResultWarning]:
    for name, value in values.items():
        if value is None:
            continue
        quantity = quantities.get(name, name)
        if quantity not in RANGES:
            raise InvalidParameterError(
                "quantities", "name quantities of RANGES", quantity, meant(str(quantity), RANGES)
            )
        least, most, unit, source, hint = RANGES[quantity]
        # Most values are plausible, and most are one number: neither takes an array.
        if type(value) is float and not (value < least or value > most):
            continue
        numbers = np.asarray(value, dtype=np.float64)
        if numbers.size and numbers.min() >= least and numbers.max() <= most:
            continue
        numbers = numbers.ravel()
        outside = np.flatnonzero((numbers < least) | (numbers > most))
        if len(outside):
            found = f"{float(numbers[outside[0]]):g} {unit}".rstrip()
            if numbers.size > 1:
                found += f" (element {outside[0]}, {len(outside)} of {numbers.size} outside)"
            message = f"{name} is {found}, outside the plausible {least:g} to {most:g} {unit}".rstrip()
            yield ResultWarning("implausible", name, f"{message} ({source}): {hint}?")


suggest(__all__, globals())
