"""Class of a robot by ISO 10218-1:2025: what its manipulator can do by design."""

from __future__ import annotations

from typing import Annotated

from hrsafety._arguments import positive, word
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.plausibility import ResultWarning

__all__ = ["RobotClass", "robot_class"]

LARGEST_MASS = 10.0
"""Of the manipulator in kg."""
LARGEST_SPEED = 0.25
"""Of the tool in m/s."""
LARGEST_FORCE = 50.0
"""Of a contact in N."""
_LIMITS = {"mass": LARGEST_MASS, "speed": LARGEST_SPEED, "force": LARGEST_FORCE}
_SINGLE_SOURCE = ResultWarning(
    "single_source",
    "limits",
    "the three limits of class I stand in one public source only: compare them with your copy of the standard",
)


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class RobotClass:
    """Class of a robot.

    Attributes
    ----------
    result : {"I", "II", "not_established"}
        The class, or that something is missing to tell.
    reasons : tuple of str
        Why it is not class I: ``"mass"``, ``"speed"``, ``"force"``, ``"capability"``, or ``"not given: NAME, ..."``.
    warnings : tuple of ResultWarning
        ``single_source``.
    """

    result: str
    reasons: tuple[str, ...]
    warnings: tuple[ResultWarning, ...]


def robot_class(
    *,
    mass: Annotated[float | None, "kg"] = None,
    speed: Annotated[float | None, "m/s"] = None,
    force: Annotated[float | None, "N"] = None,
    limited_by: str | None = None,
) -> RobotClass:
    """Return the class of a robot by ISO 10218-1:2025.

    Class I needs at most 10 kg of each manipulator, 0.25 m/s of the tool and 50 N of force, by design and not by
    settings of the safety functions; every other robot is of class II.

    Parameters
    ----------
    mass : float or None
        Of the manipulator in kg.
    speed : float or None
        Largest one of the tool in m/s.
    force : float or None
        Largest one of a contact in N.
    limited_by : {"design", "settings"} or None
        What keeps speed and force there.

    Returns
    -------
    RobotClass
        Class and reasons.

    Raises
    ------
    InvalidParameterError
        If a number is not positive, or the word is unknown.

    Examples
    --------
    >>> from hrsafety import standards
    >>> standards.robot_class(mass=7.2, speed=0.25, force=50.0, limited_by="settings").reasons
    ('capability',)
    """
    given = {"mass": mass, "speed": speed, "force": force}
    numbers = {name: positive(name, value) for name, value in given.items() if value is not None}
    by = None if limited_by is None else word("limited_by", limited_by, ("design", "settings"))
    missing = [name for name in given if name not in numbers] + ([] if by else ["limited_by"])
    reasons = [name for name, value in numbers.items() if value > _LIMITS[name]]
    if by == "settings":
        reasons.append("capability")
    if missing:
        return RobotClass(
            result="not_established", reasons=(f"not given: {', '.join(missing)}",), warnings=(_SINGLE_SOURCE,)
        )
    return RobotClass(result="II" if reasons else "I", reasons=tuple(reasons), warnings=(_SINGLE_SOURCE,))
