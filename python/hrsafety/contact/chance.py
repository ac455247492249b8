"""Chance that a speed is not allowed where inputs are uncertain."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Annotated, NamedTuple

from hrsafety import _hrsafety
from hrsafety._arguments import callback, checked_seed, count, number, positive, thread_count, word
from hrsafety._display import displayed
from hrsafety.contact.bodies import (
    agreeing,
    body_of,
    contact_width_doubt,
    larger_than_part,
    spread_agrees,
    touched_area,
)
from hrsafety.contact.covering import Covering, Region, covering_of
from hrsafety.contact.doubts import Doubts, covering_flags, flagged, implausible_numbers, not_checked, without_drive
from hrsafety.contact.rows import (
    TOLERANCE,
    applying,
    contact_row,
    in_order,
    limits_of,
    missing_limits,
    row_name,
    spring_of,
)
from hrsafety.errors import InvalidParameterError

__all__ = ["Exceedance", "probability"]

MOST_DRAWS = 10**8
_OWN = {"stiffness": "spring_constant", "body_mass": "body_mass", "force_limit": "force", "pressure_limit": "pressure"}
"""What a limit object knows of the numbers that may be uncertain."""
_COUNTS = {"normal": 2, "lognormal": 2, "uniform": 2, "triangular": 3}


@displayed
class Exceedance(NamedTuple):
    """Chance that a speed is not allowed.

    Attributes
    ----------
    probability : float
        Share of draws in which the allowed speed is below the speed.
    interval : tuple of two floats
        95 % interval after Clopper and Pearson.
    quantiles : tuple of three floats
        Allowed speeds that 5, 50 and 95 % of the draws stay below, in m/s.
    exceeded, draws : int
        Counts.
    not_checked : tuple of str
        Limits that were not checked; they never count as kept.
    warnings : tuple of ResultWarning
        That they were not, implausible numbers, and a covering outside its model with the values in the middle.
    """

    probability: float
    interval: tuple[float, float]
    quantiles: Annotated[tuple[float, float, float], "m/s"]
    exceeded: int
    draws: int
    not_checked: tuple[str, ...]
    warnings: Doubts


def _distribution(name: str, given: Mapping[str, object]) -> tuple[str, list[float]]:
    """Return the word and the numbers of a distribution."""
    if not isinstance(given, Mapping) or len(given) != 1:
        raise InvalidParameterError(name, 'be a number or one distribution such as {"lognormal": [10.0, 0.2]}', given)
    ((kind, values),) = given.items()
    word(name, kind, tuple(_COUNTS))
    if not isinstance(values, (tuple, list)) or len(values) != _COUNTS[kind]:
        raise InvalidParameterError(f"{name}.{kind}", f"be {_COUNTS[kind]} numbers", values)
    return kind, [number(f"{name}.{kind}", value) for value in values]


def probability(
    *,
    speed: float,
    robot_mass: float | Mapping[str, object],
    body_mass: float | Mapping[str, object] | None = None,
    region: Region | Mapping[str, object] | float | None = None,
    limits: object = None,
    covering: Covering | Mapping[str, object] | None = None,
    area: float | Mapping[str, object] | None = None,
    max_strain: float | Mapping[str, object] | None = None,
    draws: int = 100_000,
    seed: int = 0,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
    **uncertain: float | Mapping[str, object],
) -> Exceedance:
    """Return the chance that a closing speed is not allowed.

    Any input may be ``{"normal": [mean, s]}``, ``{"lognormal": [median, s]}``, ``{"uniform": [a, b]}`` or
    ``{"triangular": [a, c, b]}``. Normal numbers that are not positive are drawn again; a distribution of
    which more than 1e-6 is not positive is an error.

    Parameters
    ----------
    speed : float
        Closing speed in m/s.
    robot_mass, body_mass : float or mapping
        As for `allowed_speed`, or uncertain. Beside a limit object the middle of a distribution of one of its numbers
        may be off by at most its own spread.
    region, limits, covering
        As for `allowed_speed`; their uncertain numbers are given by name.
    area, max_strain : float or mapping or None
        As for `allowed_speed`, or uncertain.
    draws : int
        Number of draws, up to 1e8.
    seed : int
        The same seed gives the same bits for any number of threads.
    threads : int or None
        Number of threads; all cores when ``None``.
    progress : callable or None
        Called now and then as ``progress(done, total)`` with numbers of draws.
    **uncertain : float or mapping
        Numbers by name, as for `allowed_speeds`: ``stiffness``, ``force_limit``, ``thickness``, ...

    Returns
    -------
    Exceedance
        Share with its interval, and quantiles of the allowed speed.

    Raises
    ------
    InvalidParameterError
        If a number or a distribution is out of range or contradicts a limit object, a number has no effect, no limit
        is checked, or the covering has a damper or a rate.

    Examples
    --------
    >>> from hrsafety import contact
    >>> found = contact.probability(
    ...     speed=0.2621, robot_mass={"lognormal": [3.52, 0.2866]}, stiffness={"lognormal": [58610.0, 0.1044]},
    ...     force_limit={"lognormal": [148.1, 0.2275]}, draws=20_000,
    ... )
    >>> found.interval[0] < 0.21266 < found.interval[1]
    True
    """
    pad = covering_of(covering)
    if pad is not None and (pad.damping > 0.0 or pad.rate[:2] != (0.0, 0.0)):
        raise InvalidParameterError("covering", "have neither damping nor rate for chances", pad)
    if isinstance(area, Mapping):
        uncertain, area = {"area": area, **uncertain}, None
    if isinstance(max_strain, Mapping):
        uncertain, max_strain = {"max_strain": max_strain, **uncertain}, None
    given = {"robot_mass": robot_mass, **uncertain}
    body = body_of(limits, region, None if isinstance(body_mass, Mapping) else body_mass, given=tuple(uncertain))
    if body_mass is not None or body.mass not in (None, math.inf):
        given["body_mass"] = body.mass if body_mass is None else body_mass
    shared, values = contact_row(
        robot_mass=1.0,
        body_mass=None,
        region=spring_of(body.region, uncertain),
        covering=pad,
        tolerance=TOLERANCE,
        area=area,
        max_strain=max_strain,
    )
    values |= limits_of(limits)
    names = applying("chance", shared["region"], pad)
    inputs = []
    for name, value in given.items():
        place = row_name("uncertain", name, names)
        if isinstance(value, Mapping):
            kind, parts = _distribution(name, value)
            spread_agrees(name, kind, parts, getattr(limits, _OWN.get(name, ""), None), limits)
            inputs.append((place, kind, parts))
            # The middle one of three, else the first: for what is implausible, and where a covering has its limits.
            values[place] = parts[1] if kind == "triangular" else parts[0]
        else:
            values[place] = positive(name, value)
            agreeing(name, value, getattr(limits, _OWN.get(name, ""), None), limits)
    missing = missing_limits(values, bare=pad is None)
    found = _hrsafety.contact_exceedance(
        shared,
        in_order(values),
        inputs,
        speed=positive("speed", speed),
        draws=count("draws", draws, most=MOST_DRAWS),
        seed=checked_seed("seed", seed),
        threads=thread_count(threads),
        progress=callback("progress", progress),
    )
    found |= {name: tuple(found[name]) for name in ("interval", "quantiles")}
    doubts = [*not_checked(missing), *without_drive(values), *implausible_numbers(pad, str(shared["region"]), values)]
    if pad is not None:
        depth = _hrsafety.contact_speed(shared, in_order(values))["covering_compression"]
        doubts += flagged(covering_flags(pad, depth, values))
    else:
        depth = math.nan
    larger, part = larger_than_part(pad, depth, values, limits)
    if larger and part is not None:
        doubts.append(contact_width_doubt(float(touched_area(pad, depth, values)), part))
    return Exceedance(**found, not_checked=missing, warnings=tuple(doubts))
