"""Chance that a speed is not allowed where inputs are uncertain."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Annotated, NamedTuple

from hrsafety import _hrsafety
from hrsafety._arguments import callback, checked_seed, count, number, positive, thread_count, word
from hrsafety._display import displayed
from hrsafety.contact.bodies import OWN, agreeing, contact_width_doubt, larger_than_part, spread_agrees, touched_area
from hrsafety.contact.doubts import Doubts, covering_flags, flagged, implausible_numbers, not_checked, without_drive
from hrsafety.contact.rows import Prepared, applying, in_order, missing_limits, row_name
from hrsafety.errors import InvalidParameterError

__all__ = ["Exceedance", "chance_of"]

MOST_DRAWS = 10**8
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


def chance_of(
    given: Prepared,
    speed: float,
    uncertain: Mapping[str, float | Mapping[str, object]],
    *,
    draws: int,
    seed: int,
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> Exceedance:
    """Return the chance that a closing speed is not allowed where numbers of a contact are uncertain."""
    shared, values, pad, limits, robot = given
    if pad is not None and (pad.damping > 0.0 or pad.rate[:2] != (0.0, 0.0)):
        raise InvalidParameterError("covering", "have neither damping nor rate for chances", pad)
    masses = {
        name: values[name] for name in ("robot_mass", "body_mass") if name == "robot_mass" or values[name] < math.inf
    }
    names = applying("chance", shared["region"], pad)
    inputs = []
    for name, value in {**masses, **uncertain}.items():
        place = row_name("uncertain", name, names)
        if isinstance(value, Mapping):
            kind, parts = _distribution(name, value)
            spread_agrees(name, kind, parts, getattr(limits, OWN.get(name, ""), None), limits)
            inputs.append((place, kind, parts))
            # The middle one of three, else the first: for what is implausible, and where a covering has its limits.
            values[place] = parts[1] if kind == "triangular" else parts[0]
        else:
            values[place] = positive(name, value)
            agreeing(name, value, getattr(limits, OWN.get(name, ""), None), limits)
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
    doubts = [*robot, *not_checked(missing), *without_drive(values)]
    doubts += implausible_numbers(pad, str(shared["region"]), values)
    if pad is not None:
        depth = _hrsafety.contact_speed(shared, in_order(values))["covering_compression"]
        doubts += flagged(covering_flags(pad, depth, values))
    else:
        depth = math.nan
    larger, part = larger_than_part(pad, depth, values, limits)
    if larger and part is not None:
        doubts.append(contact_width_doubt(pad, float(touched_area(pad, depth, values)), part))
    return Exceedance(**found, not_checked=missing, warnings=tuple(doubts))
