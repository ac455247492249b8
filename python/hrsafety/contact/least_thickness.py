"""Least thicknesses of coverings."""

from __future__ import annotations

import math
from typing import Annotated

from hrsafety import _hrsafety
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.contact.bodies import contact_width_doubt, larger_than_part, touched_area
from hrsafety.contact.doubts import Doubts, covering_flags, flagged, implausible_numbers, not_checked, without_drive
from hrsafety.contact.rows import Prepared, in_order, missing_limits
from hrsafety.contact.simulation import known
from hrsafety.plausibility import ResultWarning

__all__ = ["LeastThickness", "thickness_of"]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class LeastThickness:
    """Least thickness of a covering for a speed.

    Attributes
    ----------
    thickness : float or None
        In m; ``None`` if not even 1 m suffices. Coverings of 0.1 mm and more are examined: 0 where one of 0.1 mm is
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


def thickness_of(given: Prepared, bare: Prepared, speed: float) -> LeastThickness:
    """Return the least thickness of a covering at which a closing speed is allowed, beside the contact without it."""
    shared, values, pad, limits, robot = given
    value, status = _hrsafety.contact_thickness(shared, in_order(values))
    missing = missing_limits(values, bare=pad is None)
    doubts: list[ResultWarning] = [*robot]
    if status == "bare_is_enough" and pad is not None:
        missing = missing_limits(bare.values, bare=True)
        rigid = shared["region"] == "rigid"
        most = 0.0 if rigid else _hrsafety.contact_speed(bare.shared, in_order(bare.values))["speed"]
        if most < speed:
            doubts.append(_bare_exceeds(most))
    doubted = values | {"thickness": value if value > 0.0 else math.nan}
    depth = math.nan
    if value > 0.0:
        depth = _hrsafety.contact_speed(shared, in_order(doubted | {"closing_speed": math.nan}))["covering_compression"]
    larger, part = larger_than_part(pad, depth, doubted, limits)
    if larger and part is not None:
        doubts.append(contact_width_doubt(pad, float(touched_area(pad, depth, doubted)), part))
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
