"""Masses of a point of an arm, and the words that belong beside them."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np

from hrsafety._arguments import Array, word
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.arms.doubts import for_rule
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning

__all__ = ["RULES", "EffectiveMass", "Extremes", "PointMasses", "mass_by_rule"]

RULES = ("larger", "iso", "directional")


@displayed
class Extremes(NamedTuple):
    """The heaviest and the lightest direction of a point; leading axes are those of the poses and points.

    Attributes
    ----------
    worst_mass : ndarray (...)
        Largest effective mass in kg, inf where a direction is unbounded.
    worst_direction : ndarray (..., 3)
        Unit vector along it in world axes, its largest component positive.
    least_mass : ndarray (...)
        Least effective mass in kg.
    least_direction : ndarray (..., 3)
        Unit vector along it in world axes, its largest component positive.
    warnings : tuple of ResultWarning
        Why masses may not be what they seem.
    """

    worst_mass: Annotated[Array, "kg"]
    worst_direction: Array
    least_mass: Annotated[Array, "kg"]
    least_direction: Array
    warnings: tuple[ResultWarning, ...] = ()


@displayed
@dataclass(frozen=True, slots=True, eq=False)
class EffectiveMass:
    """Masses of a point of an arm for the person it hits, with the doubts about them.

    Parameters
    ----------
    mass : ndarray (...) or float
        In kg; inf where no motion of the joints moves the point along the direction. A number for one pose, point and
        direction.
    rule : {"directional", "larger", "iso"}
        Mass along the direction, or the larger one of that and the mass of ISO/TS 15066, or the latter.
    iso_mass : float
        Half of the moving mass plus the payload, in kg.
    warnings : tuple of ResultWarning
        Why the masses may not be what they seem: no motor inertia, links that are hardly real.

    Examples
    --------
    >>> from hrsafety import arms
    >>> arm = arms.Arm.example(armature=0.3)
    >>> found = arm.effective_mass({"elbow": 1.4}, link="tool", direction=(0, 0, 1))
    >>> float(found) == found.mass
    True
    """

    mass: Annotated[Array | float, "kg"]
    rule: str
    iso_mass: Annotated[float, "kg"]
    warnings: tuple[ResultWarning, ...]

    @property
    def unbounded(self) -> Array:
        """Whether no motion of the joints moves the point along the direction."""
        return np.isinf(self.mass)

    def __float__(self) -> float:
        """Return the mass of one pose, point and direction, in kg."""
        if np.ndim(self.mass):
            rule = "be that of one pose, point and direction to become a number"
            raise InvalidParameterError("mass", rule, np.shape(self.mass), "take .mass, an array")
        return float(self.mass)


@displayed
@dataclass(frozen=True, slots=True, eq=False)
class PointMasses:
    """All masses of a point of an arm: by direction, by ISO/TS 15066, and what to know about both.

    Parameters
    ----------
    position : ndarray (..., 3)
        The point in world axes, in m.
    direction : ndarray (..., 3)
        Unit vectors that were asked about.
    effective_mass : ndarray (...)
        Mass along them in kg, inf where it is unbounded.
    iso_mass : float
        Half of the moving mass plus the payload, in kg.
    extremes : Extremes
        The heaviest and the lightest direction.
    mobility : ndarray (..., 3, 3)
        L = J M^-1 J^T in 1/kg.
    warnings : tuple of ResultWarning
        Why the masses may not be what they seem: no motor inertia, links that are hardly real.

    Examples
    --------
    >>> from hrsafety import arms
    >>> arm = arms.Arm.example()
    >>> masses = arm.point_masses({"elbow": 1.4}, link="tool", direction=(0, 0, 1))
    >>> float(masses.robot_mass("larger")) == max(masses.effective_mass, masses.iso_mass)
    True
    """

    position: Annotated[Array, "m"]
    direction: Array
    effective_mass: Annotated[Array, "kg"]
    iso_mass: Annotated[float, "kg"]
    extremes: Extremes
    mobility: Array
    warnings: tuple[ResultWarning, ...]

    @property
    def unbounded(self) -> Array:
        """Whether no motion of the joints moves the point along the direction."""
        return np.isinf(self.effective_mass)

    def robot_mass(self, rule: str = "larger") -> EffectiveMass:
        """Return the mass of the robot by a rule.

        Parameters
        ----------
        rule : {"larger", "iso", "directional"}
            The larger one of both masses, that of ISO/TS 15066, or that along the direction.

        Returns
        -------
        EffectiveMass
            Masses in kg with the doubts that are left with this rule.
        """
        mass = mass_by_rule(rule, self.effective_mass, self.iso_mass)
        doubts = for_rule(self.warnings, rule, self.effective_mass, self.iso_mass)
        return EffectiveMass(mass if mass.ndim else float(mass), rule, self.iso_mass, doubts)

    def __str__(self) -> str:
        """Return both masses and the warnings."""
        shown = np.array2string(np.asarray(self.effective_mass), precision=6)
        lines = [f"effective mass  {shown} kg", f"ISO mass        {self.iso_mass:.6g} kg (M/2 + payload)"]
        return "\n".join([*lines, *(str(each) for each in self.warnings)])


def mass_by_rule(rule: str, directional: Array, iso: float) -> Array:
    """Return the mass of the robot by a rule, with the shape of the directional masses."""
    word("robot_mass", rule, RULES)
    if rule == "directional":
        return directional
    if rule == "iso":
        return np.full(np.shape(directional), iso)
    return np.asarray(np.maximum(directional, iso))
