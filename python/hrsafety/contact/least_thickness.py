"""Least thicknesses of coverings."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated

from hrsafety import _hrsafety
from hrsafety._arguments import positive
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.contact.bodies import body_of, contact_width_doubt, larger_than_part, touched_area
from hrsafety.contact.covering import Covering, Region, covering_of
from hrsafety.contact.doubts import Doubts, covering_flags, flagged, implausible_numbers, not_checked, without_drive
from hrsafety.contact.rows import TOLERANCE, contact_row, in_order, limits_of, missing_limits
from hrsafety.contact.simulation import known
from hrsafety.plausibility import ResultWarning, telling

__all__ = ["LeastThickness", "thickness"]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class LeastThickness:
    """Least thickness of a covering for a speed.

    Attributes
    ----------
    thickness : float or None
        In m; ``None`` if not even 1 m suffices. Coverings of 0.1 mm and more are looked at: 0 where one of 0.1 mm is
        enough, also where a contact without any is not, see ``warnings``.
    status : {"found", "bare_is_enough", "none_up_to_1_m"}
        What was found: bare is enough where a covering of 0.1 mm keeps the limits; where a contact without any does
        not, a warning says so (``bare_exceeds``). The strain counts: a thin pad may be slower than none.
    not_checked : tuple of str
        Limits that were not checked; they never count as kept. The pressure of a bare contact needs the area of a flat
        covering.
    warnings : tuple of ResultWarning
        As in `AllowedSpeed`.
    """

    thickness: Annotated[float | None, "m"]
    status: str
    not_checked: tuple[str, ...]
    warnings: Doubts


@telling()
def thickness(
    *,
    speed: float,
    robot_mass: float,
    region: Region | Mapping[str, object] | float | None = None,
    limits: object,
    covering: Covering | Mapping[str, object],
    body_mass: float | None = None,
    max_strain: float | None = None,
) -> LeastThickness:
    """Return the least thickness of a covering at which a closing speed is allowed.

    Parameters
    ----------
    speed : float
        Wanted closing speed in m/s.
    robot_mass, region, limits, body_mass, max_strain
        As for `allowed_speed`.
    covering : Covering or mapping
        Law and shape; its own thickness does not matter and may be absent from a mapping.

    Returns
    -------
    LeastThickness
        With its status.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range or contradicts a limit object, or the covering has a damper or a rate.

    Examples
    --------
    >>> from hrsafety import contact
    >>> pad = {"material": {"law": "linear", "E": 69690.0}, "shape": "flat", "area": 0.002481}
    >>> found = contact.thickness(
    ...     speed=1.064, robot_mass=6.709, body_mass=40.0, region=25e3, covering=pad,
    ...     limits={"force": 360.0, "pressure": 420e4},
    ... )
    >>> round(found.thickness, 6), found.status
    (0.051863, 'found')
    """
    if isinstance(covering, Mapping) and "thickness" not in covering:
        covering = {**covering, "thickness": 0.01}
    pad = covering_of(covering)
    speed = positive("speed", speed)
    body = body_of(limits, region, body_mass)
    shared, values = contact_row(
        robot_mass=robot_mass,
        body_mass=body.mass,
        region=body.region,
        covering=pad,
        tolerance=TOLERANCE,
        max_strain=max_strain,
        closing_speed=speed,
    )
    values |= limits_of(limits)
    value, status = _hrsafety.contact_thickness(shared, in_order(values))
    missing = missing_limits(values, bare=pad is None)
    doubts: list[ResultWarning] = []
    if status == "bare_is_enough" and pad is not None:
        bare, alone = contact_row(
            robot_mass=robot_mass,
            body_mass=body.mass,
            region=body.region,
            covering=None,
            tolerance=TOLERANCE,
            area=pad.area,
        )
        alone |= limits_of(limits)
        missing = missing_limits(alone, bare=True)
        rigid = shared["region"] == "rigid"
        most = 0.0 if rigid else _hrsafety.contact_speed(bare, in_order(alone))["speed"]
        if most < speed:
            doubts.append(_bare_exceeds(most))
    doubted = values | {"thickness": value if value > 0.0 else math.nan}
    depth = math.nan
    if value > 0.0:
        depth = _hrsafety.contact_speed(shared, in_order(doubted | {"closing_speed": math.nan}))["covering_compression"]
    larger, part = larger_than_part(pad, depth, doubted, limits)
    if larger and part is not None:
        doubts.append(contact_width_doubt(float(touched_area(pad, depth, doubted)), part))
    return LeastThickness(
        thickness=known(value),
        status=status,
        not_checked=missing,
        warnings=(
            *doubts,
            *not_checked(missing),
            *without_drive(values),
            *flagged(covering_flags(pad, depth, doubted)),
            *implausible_numbers(pad, str(shared["region"]), doubted),
        ),
    )


def _bare_exceeds(most: float) -> ResultWarning:
    """Return the doubt about a bare contact that is enough only as a covering of 0.1 mm; the speed it allows in m/s."""
    return ResultWarning(
        "bare_exceeds",
        "speed",
        "bare_is_enough says that a covering of 0.1 mm keeps the limits: a contact without any is allowed "
        f"{most:.4g} m/s only",
    )
