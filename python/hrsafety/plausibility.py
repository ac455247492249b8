"""Warnings that travel with a result, and the ranges outside which a number is hardly what was meant.

A number can obey every rule of its argument and still be wrong: milliseconds given for seconds,
m/s^2 for g, grams for kilograms. `RANGES` holds, for each quantity, the range that people, robots and
coverings of this field have; a value outside gives a `ResultWarning`, which every result, table, page
and picture shows. Nothing is refused here and nothing is changed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

__all__ = ["RANGES", "Range", "ResultWarning", "implausible"]


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

    Examples
    --------
    >>> from hrsafety.plausibility import ResultWarning
    >>> print(ResultWarning("implausible", "heading", "heading is 90 rad, ..."))
    warning: heading is 90 rad, ...
    """

    code: str
    subject: str
    message: str

    def __str__(self) -> str:
        """Return the line that is printed."""
        return f"warning: {self.message}"


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
    "robot_max_acceleration": Range(
        0.01, 50.0, "m/s^2", "heavy trucks to what rubber tires hold several times over", "g or mm/s^2 given for m/s^2"
    ),
    "robot_max_angular_acceleration": Range(
        0.01, 2000.0, "rad/s^2", "heavy trucks to light two-wheel robots", "degrees given for radians"
    ),
    "control_period": Range(1e-4, 1.0, "s", "fastest servo loops to slow planners", "ms given for s"),
    "time_limit": Range(0.1, 86400.0, "s", "one evasion to one day", "ms given for s"),
    "arrival_tolerance": Range(1e-4, 5.0, "m", "accurate docking to large vehicles", "mm or cm given for m"),
    "floor_position": Range(-10000.0, 10000.0, "m", "the largest sites", "mm given for m"),
    "obstacle_size": Range(0.005, 1000.0, "m", "thin poles to long walls", "mm or cm given for m"),
    "person_radius": Range(0.1, 1.0, "m", "a child to a long step with room around it", "mm or cm given for m"),
    "person_speed": Range(
        0.0, 12.5, "m/s", "standing to the fastest sprinter ever timed", "mm/s or km/h given for m/s"
    ),
    "obstacle_speed": Range(0.0, 40.0, "m/s", "standing to road vehicles", "mm/s or km/h given for m/s"),
    "measurement_scale": Range(0.0, 1.0, "m", "exact to coarse radio positioning", "mm or cm given for m"),
    "latency": Range(0.0, 5.0, "s", "immediate to very slow networks", "ms given for s"),
    # ---- impact -----------------------------------------------------------------------------
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


def _implausible(values: Mapping[str, object], quantities: Mapping[str, str]) -> Iterable[ResultWarning]:
    for name, value in values.items():
        if value is None:
            continue
        least, most, unit, source, hint = RANGES[quantities.get(name, name)]
        numbers = np.atleast_1d(np.asarray(value, dtype=np.float64)).ravel()
        outside = np.flatnonzero((numbers < least) | (numbers > most))
        if len(outside):
            found = f"{float(numbers[outside[0]]):g} {unit}".rstrip()
            if numbers.size > 1:
                found += f" (element {outside[0]}, {len(outside)} of {numbers.size} outside)"
            message = f"{name} is {found}, outside the plausible {least:g} to {most:g} {unit}".rstrip()
            yield ResultWarning("implausible", name, f"{message} ({source}): {hint}?")
