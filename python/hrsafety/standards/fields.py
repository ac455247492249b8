"""Distances for the field of a scanner: where a robot has to stop, and where it has to slow down to a contact speed."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import Annotated

from hrsafety._arguments import not_negative, positive
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import HrsafetyWarning, ResultWarning
from hrsafety.standards.guards import LEAST_INTRUSION, minimum_distance
from hrsafety.standards.separation import (
    STANDING,
    WALKING_SPEED,
    StoppingData,
    separation_distance,
    slow_person,
    speed_over_distance,
)

__all__ = ["FieldDistances", "field_distances"]

TERMS = ("person", "reaction", "braking", "intrusion", "uncertainty")
"""Terms of a distance: what the person walks, what the robot moves before and while it brakes, C and Z."""


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class FieldDistances:
    """Two distances for the field of a scanner with their terms.

    Attributes
    ----------
    stop : float
        S(v, 0) in m: the robot stands before it is reached.
    slow_down : float or None
        S(v, v_allowed) in m: it has slowed down to the allowed contact speed; ``None`` where contact has none.
    robot_speed, contact_speed : float
        v and v_allowed in m/s; the latter at most v, 0 where contact has none.
    stop_terms, slow_down_terms : dict of str to float
        Terms by name: ``"person"``, ``"reaction"``, ``"braking"``, ``"intrusion"``, ``"uncertainty"``.
    said : str
        What was taken as 0, in words; empty if nothing was.
    warnings : tuple of ResultWarning
        As those of a `SpeedCurve`.
    """

    stop: Annotated[float, "m"]
    slow_down: Annotated[float | None, "m"]
    robot_speed: Annotated[float, "m/s"]
    contact_speed: Annotated[float, "m/s"]
    stop_terms: dict[str, float]
    slow_down_terms: dict[str, float]
    said: str
    warnings: tuple[ResultWarning, ...]


def field_distances(
    robot_speed: float,
    *,
    contact_speed: float | None,
    reaction_time: float,
    deceleration: float | None = None,
    human_speed: float = WALKING_SPEED,
    intrusion: float | None = None,
    uncertainty: float | None = None,
    height: float | None = None,
    capability: float | None = None,
    stopping: StoppingData | None = None,
    load: float | None = None,
    extension: float | None = None,
) -> FieldDistances:
    """Return the distances from which on a robot has to stop, or to slow down to the speed of an allowed contact.

    Parameters
    ----------
    robot_speed : float
        Speed v of the robot towards the person in m/s.
    contact_speed : float or None
        Allowed contact speed in m/s; ``None`` where contact is not permitted or not checked.
    reaction_time, deceleration, human_speed, intrusion, uncertainty, stopping, load, extension
        As for `separation_distance`.
    height, capability : float or None
        Height of the field above the floor in m and what its sensors detect in m, as for `minimum_distance`; the
        intrusion distance follows from them, and is not given beside them.

    Returns
    -------
    FieldDistances
        Both distances with their terms; with doubts where the intrusion distance is shorter than that of any field, or
        people are slower than ISO 13855 has them.

    Raises
    ------
    InvalidParameterError
        If a number is out of range, or the speed lies outside the measured stops.

    Examples
    --------
    >>> from hrsafety import standards
    >>> found = standards.field_distances(
    ...     1.0, contact_speed=0.25, reaction_time=0.12, deceleration=2.5, height=0.3, uncertainty=0.1
    ... )
    >>> f"{found.stop:.3f} m, {found.slow_down:.4f} m"
    '2.332 m, 2.1595 m'
    """
    speed = positive("robot_speed", robot_speed)
    target = 0.0 if contact_speed is None else min(not_negative("contact_speed", contact_speed), speed)
    brakes = {"deceleration": deceleration, "stopping": stopping, "load": load, "extension": extension}
    intrusion = intrusion_of_field(intrusion, height, capability)
    added = {"intrusion": intrusion or 0.0, "uncertainty": uncertainty or 0.0}
    told = speed_over_distance(  # checks all numbers, and finds their doubts
        [1.0],
        contact_speed=target,
        max_speed=speed,
        reaction_time=reaction_time,
        human_speed=human_speed,
        intrusion=intrusion,
        uncertainty=uncertainty,
        **brakes,  # type: ignore[arg-type]  # as they were given
    )

    def terms(to: float) -> dict[str, float]:
        def way(human: float, reaction: float) -> float:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", HrsafetyWarning)
                return float(
                    separation_distance(
                        speed,
                        reaction_time=reaction,
                        human_speed=human,
                        intrusion=0.0,
                        uncertainty=0.0,
                        target_speed=to,
                        **brakes,  # type: ignore[arg-type]  # as they were given
                    )
                )

        braking = way(0.0, 0.0)
        moved = way(0.0, reaction_time)
        walked = way(human_speed, reaction_time)
        return dict(zip(TERMS, (walked - moved, moved - braking, braking, *added.values()), strict=True))

    stops, slows = terms(0.0), terms(target)
    zero = [name for name, value in added.items() if value == 0.0]
    return FieldDistances(
        stop=sum(stops.values()),
        slow_down=None if contact_speed is None else sum(slows.values()),
        robot_speed=speed,
        contact_speed=target,
        stop_terms=stops,
        slow_down_terms={} if contact_speed is None else slows,
        said=", ".join(f"no {name}" for name in zero) + (" given" if zero else ""),
        warnings=(*told.warnings, *_doubts(intrusion, human_speed)),
    )


def intrusion_of_field(intrusion: float | None, height: float | None, capability: float | None) -> float | None:
    """Return the intrusion distance in m: as it is given, or that of a field at a height.

    Parameters
    ----------
    intrusion, height, capability : float or None
        As for `field_distances`.

    Returns
    -------
    float or None
        ``None`` where nothing is given.

    Raises
    ------
    InvalidParameterError
        If both are given, a capability stands without a height, or the field lies too high or too low.
    """
    if height is None:
        if capability is not None:
            raise InvalidParameterError("capability", "stand beside the height of the field", capability)
        return intrusion
    if intrusion is not None:
        raise InvalidParameterError("intrusion", "not be given beside the height of the field: it follows", intrusion)
    return minimum_distance(1.0, capability=capability, height=height).intrusion


def _doubts(intrusion: float | None, human_speed: float) -> Iterator[ResultWarning]:
    """Yield doubts about numbers that make a field too short: nobody reaches over it, or people who are slow."""
    if intrusion is not None and intrusion < LEAST_INTRUSION:
        words = (
            f"intrusion is {intrusion:g} m: somebody reaches over a scanner field by {LEAST_INTRUSION:g} m and more, "
            "and its distances are too short; give the height of the field in its place"
        )
        yield ResultWarning("intrusion_too_short", "intrusion", words)
    if human_speed >= STANDING:  # people who stand are doubted where the distance is computed
        yield from slow_person("human_speed", human_speed, "distances")
