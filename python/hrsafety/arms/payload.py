"""Payload of an arm."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from hrsafety._arguments import Parameters, checked_text, finite, not_negative, numbers
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["Payload", "payloads_of"]

Triple = tuple[float, float, float]
Matrix = tuple[Triple, Triple, Triple]
_ZERO: Triple = (0.0, 0.0, 0.0)
_KEYS = ("link", "mass", "center", "inertia")


@dataclass(frozen=True, slots=True)
class Payload(Parameters):
    """A rigid body that a link carries: a tool, a workpiece, or both.

    Parameters
    ----------
    link : str
        Name of the link.
    mass : float
        Mass in kg.
    center : array_like (3,)
        Center of mass in the frame of the link, in m.
    inertia : array_like (3, 3) or (6,)
        Inertia about the center of mass along the axes of the link in kg m^2, as a matrix or as
        ``ixx, ixy, ixz, iyy, iyz, izz``; zero for a point mass.

    Examples
    --------
    >>> from hrsafety import arms
    >>> arms.Payload("tool0", 2.0, center=(0.0, 0.0, 0.1)).mass
    2.0
    """

    link: str
    mass: float
    center: Triple = _ZERO
    inertia: Matrix = (_ZERO, _ZERO, _ZERO)

    def __post_init__(self) -> None:
        """Check everything that does not need the arm."""
        checked_text("link", self.link, "be the name of a link")
        self._set(mass=not_negative("mass", self.mass))
        center = numbers("center", self.center)
        if center.shape != (3,):
            raise ShapeError("center", "(3,)", center.shape)
        self._set(center=tuple(finite("center", each) for each in center.tolist()))
        given = numbers("inertia", self.inertia)
        if given.shape == (6,):
            xx, xy, xz, yy, yz, zz = given
            given = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        if given.shape != (3, 3):
            raise ShapeError("inertia", "(3, 3) or (6,)", given.shape)
        self._set(inertia=tuple(tuple(finite("inertia", float(each)) for each in row) for row in given))


def payloads_of(given: object) -> tuple[Payload, ...]:
    """Return payloads from one or several of them, each a `Payload`, a mapping or a tuple of its fields."""
    if given is None:
        return ()
    several = isinstance(given, Sequence) and not isinstance(given, (str, bytes)) and not _is_row(given)
    if several:
        return tuple(_payload(f"payload[{index}]", each) for index, each in enumerate(given))  # type: ignore[arg-type, var-annotated]  # a sequence
    return (_payload("payload", given),)


def _is_row(given: Sequence[object]) -> bool:
    """Return whether a sequence holds the fields of one payload."""
    return len(given) > 0 and isinstance(given[0], str)


def _payload(name: str, given: object) -> Payload:
    if isinstance(given, Payload):
        return given
    rule = "be a Payload, a mapping with link, mass, center and inertia, or a tuple of them"
    if isinstance(given, Mapping):
        fields = {"center" if key == "centre" else key: value for key, value in given.items()}
        if not {"link", "mass"} <= fields.keys() <= set(_KEYS):
            raise InvalidParameterError(name, rule, given)
    elif isinstance(given, Sequence) and not isinstance(given, (str, bytes)) and 2 <= len(given) <= len(_KEYS):
        fields = dict(zip(_KEYS, given, strict=False))
    else:
        raise InvalidParameterError(name, rule, given)
    try:
        return Payload(**fields)
    except InvalidParameterError as error:
        raise error.renamed(f"{name}.{error.argument}") from None
