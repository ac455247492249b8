"""Bases on wheels below an arm: what moves with it when nobody holds the base."""

from __future__ import annotations

from hrsafety._arguments import finite, not_negative, pair, positive, word
from hrsafety._records import dataclass

__all__ = ["BASE_JOINTS", "RollingBase"]

BASE_JOINTS = ("base_x", "base_y", "base_turn")
"""Joints of a base that rolls: ahead, to its left, and its turn."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RollingBase:
    """A base on wheels below the root of a URDF.

    Masses of an arm on one that rolls are never larger than on one that stands still.

    Parameters
    ----------
    kind : {"differential", "omni"}
        Whether it moves along its heading and turns about its axle, or moves any way.
    mass : float
        Beside that of the root of the URDF, in kg.
    inertia : float or None
        About the vertical through the origin of the root, in kg m^2. ``None``: it is taken not to turn, which makes
        no mass smaller.
    axle : tuple of two floats
        Middle of the axle in the frame of the root in m, of a differential base.
    heading : float
        Direction ahead about the vertical, in rad from x.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range or the word is unknown.

    Examples
    --------
    >>> from hrsafety import arms
    >>> base = arms.RollingBase(kind="omni", mass=40.0)
    >>> arm = arms.Arm.example(base=base, armature=0.3)
    >>> f"{arm.iso_mass - arms.Arm.example().iso_mass:g} kg"
    '20 kg'
    """

    kind: str
    mass: float
    inertia: float | None = None
    axle: tuple[float, float] = (0.0, 0.0)
    heading: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        word("kind", self.kind, ("differential", "omni"))
        object.__setattr__(self, "mass", not_negative("mass", self.mass))
        if self.inertia is not None:
            object.__setattr__(self, "inertia", positive("inertia", self.inertia))
        object.__setattr__(self, "axle", pair("axle", self.axle))
        object.__setattr__(self, "heading", finite("heading", self.heading))

    @property
    def native(self) -> tuple[bool, float, float | None, list[float], float]:
        """Values that the core reads."""
        return self.kind == "omni", self.mass, self.inertia, list(self.axle), self.heading
