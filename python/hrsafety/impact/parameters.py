"""Manipulators, foams, heads and joints, with the published sets."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import field

import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters, count, not_negative, number, pair, positive, square
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning, implausible

__all__ = [
    "FOAM_1",
    "FOAM_2",
    "FOAM_3",
    "MANIPULATOR_1",
    "MANIPULATOR_2",
    "ConstrainedHead",
    "Foam",
    "Head",
    "Manipulator",
]

THICKNESS = 0.0254
"""Thickness of the foams of the source, in m."""

LINEAR_RANGE = 0.02
LINEAR_SHARE = 0.8
"""Foam is linear up to 0.02 m in the source; thinner foam up to this share of its thickness at most."""


class _Part(Parameters):
    """A part of an impact: its numbers are examined when it is made, so that results only pass the doubts on."""

    __slots__ = ()

    def _check(self, native: Callable[..., object], owner: str) -> None:
        """Check mass, damping and stiffness of a mass on a spring, and doubt them."""
        names = ("mass", "damping", "stiffness")
        self._set(_native=native(**self._as_numbers(*names)))
        self._set(warnings=self._doubts(owner, **{name: f"{owner}_{name}" for name in names}))

    def _doubts(self, owner: str, **quantities: str) -> tuple[ResultWarning, ...]:
        """Return warnings of its own numbers; zero stiffness and damping are none rather than little."""
        values = {f"{owner}.{name}": getattr(self, name) or None for name in quantities}
        return implausible(values, {f"{owner}.{name}": quantity for name, quantity in quantities.items()})


@dataclass(frozen=True, kw_only=True, slots=True)
class Manipulator(_Part):
    """Manipulator as it is felt at the impact point, along the impact.

    Parameters
    ----------
    mass : float
        Effective mass M_r in kg.
    damping : float
        Effective damping C_r in N s/m.
    stiffness : float
        Effective stiffness K_r in N/m.

    Attributes
    ----------
    warnings : tuple of ResultWarning
        Numbers that are hardly what was meant; results pass them on.

    Raises
    ------
    InvalidParameterError
        If the mass is not finite and positive, or damping or stiffness is negative.

    Examples
    --------
    >>> from hrsafety import impact
    >>> impact.MANIPULATOR_1
    Manipulator(mass=9.6, damping=250.0, stiffness=20000.0)
    """

    mass: float
    damping: float
    stiffness: float
    warnings: tuple[ResultWarning, ...] = field(init=False, repr=False, compare=False)
    _native: _hrsafety.Manipulator = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._check(_hrsafety.Manipulator, "manipulator")

    @classmethod
    def from_joint(cls, *, inertia: float, damping: float, stiffness: float, lever_arm: float) -> Manipulator:
        """Return the effective manipulator of one joint (scenarios 1 and 2 of section 3.4).

        Parameters
        ----------
        inertia : float
            Inertia m about the joint, in kg m^2.
        damping, stiffness : float
            C_J in N m s/rad and K_J in N m/rad of the joint.
        lever_arm : float
            Distance l of the impact point from the joint, in m.

        Returns
        -------
        Manipulator
            M_r = m/l^2, C_r = C_J/l^2, K_r = K_J/l^2.

        Raises
        ------
        InvalidParameterError
            If a value is negative or not finite, or inertia or lever arm is zero.

        Examples
        --------
        >>> from hrsafety import impact
        >>> arm = impact.Manipulator.from_joint(inertia=0.059, damping=1.521, stiffness=121.68, lever_arm=0.078)
        >>> round(arm.mass, 2), round(arm.damping, 3), round(arm.stiffness, 3)
        (9.7, 250.0, 20000.0)
        """
        mass, effective_damping, effective_stiffness = _hrsafety.effective_one_joint(
            inertia=number("inertia", inertia),
            damping=number("damping", damping),
            stiffness=number("stiffness", stiffness),
            lever_arm=number("lever_arm", lever_arm),
        )
        return cls(mass=mass, damping=effective_damping, stiffness=effective_stiffness)

    @classmethod
    def from_two_joints(
        cls,
        *,
        mass_matrix: npt.ArrayLike,
        damping: npt.ArrayLike,
        stiffness: npt.ArrayLike,
        second_link: float,
        lever_arm: float,
        elbow: float = 0.0,
    ) -> Manipulator:
        """Return the effective manipulator of joints 2 and 3 (scenario 3 of section 3.4).

        With J = [a_2 cos(theta_3) + l_3, l_3] along the normal of link 3:
        M_r = 1/(J M^-1 J^T), K_r = 1/(J K^-1 J^T), C_r = K_r^2 J K^-1 C K^-1 J^T.

        Parameters
        ----------
        mass_matrix : array_like of shape (2, 2)
            Inertia matrix of joints 2 and 3 at this elbow, in kg m^2; symmetric and positive
            definite.
        damping, stiffness : array_like of shape (2,)
            C_2, C_3 in N m s/rad and K_2, K_3 in N m/rad.
        second_link : float
            Length a_2 of the second link, in m.
        lever_arm : float
            Distance l_3 of the impact point from joint 3, in m.
        elbow : float
            Angle theta_3 in rad; 0 is stretched.

        Returns
        -------
        Manipulator
            At the impact point, along the normal of link 3.

        Raises
        ------
        InvalidParameterError
            If the matrix is not positive definite, or a value is out of range.
        ShapeError
            If an array has another shape.

        Examples
        --------
        >>> from hrsafety import impact
        >>> arm = impact.Manipulator.from_two_joints(
        ...     mass_matrix=[[3.0, 1.0], [1.0, 0.6]], damping=(40.0, 10.0), stiffness=(8000.0, 2000.0),
        ...     second_link=0.43, lever_arm=0.4,
        ... )
        >>> round(arm.mass, 3), round(arm.stiffness, 1)
        (3.488, 6020.0)
        """
        mass, effective_damping, effective_stiffness = _hrsafety.effective_two_joints(
            mass_matrix=square("mass_matrix", mass_matrix, 2).tolist(),
            damping=pair("damping", damping),
            stiffness=pair("stiffness", stiffness),
            second_link=number("second_link", second_link),
            lever_arm=number("lever_arm", lever_arm),
            elbow=number("elbow", elbow),
        )
        return cls(mass=mass, damping=effective_damping, stiffness=effective_stiffness)


@dataclass(frozen=True, kw_only=True, slots=True)
class Head(_Part):
    """Head on a neck; the torso is infinitely heavy.

    Parameters
    ----------
    mass : float
        Mass M_h in kg.
    damping : float
        Damping C_h of the neck, in N s/m.
    stiffness : float
        Stiffness K_h of the neck, in N/m.

    Attributes
    ----------
    warnings : tuple of ResultWarning
        Numbers that are hardly what was meant; results pass them on.

    Raises
    ------
    InvalidParameterError
        If the mass is not finite and positive, or damping or stiffness is negative.

    Examples
    --------
    >>> from hrsafety import impact
    >>> impact.Head.minimum()
    Head(mass=4.4, damping=46.0, stiffness=3000.0)
    """

    mass: float
    damping: float
    stiffness: float
    warnings: tuple[ResultWarning, ...] = field(init=False, repr=False, compare=False)
    _native: _hrsafety.Head = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._check(_hrsafety.Head, "head")

    @classmethod
    def minimum(cls) -> Head:
        """Return the lightest and softest set, on the safe side for head acceleration."""
        return cls(mass=4.4, damping=46.0, stiffness=3000.0)

    @classmethod
    def maximum(cls) -> Head:
        """Return the heaviest and stiffest set, on the safe side for force and compression."""
        return cls(mass=5.3, damping=130.0, stiffness=5000.0)

    @classmethod
    def apparatus(cls) -> Head:
        """Return the undamped head of the experiments of chapter 4 of Zeng (2011)."""
        return cls(mass=4.4, damping=0.0, stiffness=4000.0)

    @classmethod
    def simulation(cls, row: int) -> Head:
        """Return the head of a simulation of Table 3.2 of Zeng (2011).

        Parameters
        ----------
        row : int
            1 to 4.

        Returns
        -------
        Head
            1 and 2: 4.4 kg on the stiff neck; 3: the minimum set; 4: the maximum set.

        Raises
        ------
        InvalidParameterError
            If there is no such row.

        Examples
        --------
        >>> from hrsafety import impact
        >>> impact.Head.simulation(1)
        Head(mass=4.4, damping=130.0, stiffness=5000.0)
        """
        if count("row", row) > 4:
            raise InvalidParameterError("row", "be 1, 2, 3 or 4", row)
        stiff = cls(mass=4.4, damping=130.0, stiffness=5000.0)
        return (stiff, stiff, cls.minimum(), cls.maximum())[row - 1]


@dataclass(frozen=True, kw_only=True, slots=True)
class ConstrainedHead(_Part):
    """Head that cannot move, for example against a wall.

    Head fields of results are NaN, there is no impact period, and the force grows like a ramp
    until the horizon.

    Attributes
    ----------
    warnings : tuple of ResultWarning
        None: it has no numbers.

    Examples
    --------
    >>> from hrsafety import impact
    >>> found = impact.metrics(
    ...     impact.MANIPULATOR_1, impact.FOAM_1, impact.ConstrainedHead(), closing_speed=0.25)
    >>> found.status, found.hic15
    ('constrained', nan)
    """

    warnings: tuple[ResultWarning, ...] = field(default=(), init=False, repr=False, compare=False)
    _native: _hrsafety.ConstrainedHead = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Build the native counterpart."""
        self._set(_native=_hrsafety.ConstrainedHead())


@dataclass(frozen=True, kw_only=True, slots=True)
class Foam(_Part):
    """Foam covering of the manipulator: spring and damper, linear up to a compression.

    Parameters
    ----------
    stiffness : float
        K_c in N/m.
    damping : float
        C_c in N s/m.
    thickness : float
        Thickness T_u without load, in m.
    linear_range : float or None
        Compression lambda up to which the foam is linear, in m, at most the thickness; the smaller of
        0.02 m and 0.8 of the thickness when ``None``.

    Attributes
    ----------
    warnings : tuple of ResultWarning
        Numbers that are hardly what was meant; results pass them on.

    Raises
    ------
    InvalidParameterError
        If stiffness or damping is negative, thickness or linear range not positive, or the linear range
        above the thickness.

    Examples
    --------
    >>> from hrsafety import impact
    >>> impact.FOAM_1
    Foam(stiffness=24300.0, damping=71.9, thickness=0.0254, linear_range=0.02)

    Thinner foam is linear over less:

    >>> impact.Foam(stiffness=24300.0, damping=71.9, thickness=0.01).linear_range
    0.008
    """

    stiffness: float
    damping: float
    thickness: float = THICKNESS
    linear_range: float = None  # type: ignore[assignment]  # a number as soon as it is made
    warnings: tuple[ResultWarning, ...] = field(init=False, repr=False, compare=False)
    _native: _hrsafety.Foam = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        if self.linear_range is None:
            self._set(linear_range=default_linear_range(number("thickness", self.thickness)))
        names = ("stiffness", "damping", "thickness", "linear_range")
        self._set(_native=_hrsafety.Foam(**self._as_numbers(*names)))
        own = {"stiffness": "foam_stiffness", "damping": "foam_damping"}
        doubts = self._doubts("foam", **own, thickness="thickness", linear_range="linear_range")
        if self.stiffness == 0.0:
            doubts += implausible({"foam.stiffness": 0.0}, {"foam.stiffness": "foam_stiffness"})
        self._set(warnings=doubts)

    @classmethod
    def from_damping_ratio(
        cls,
        *,
        stiffness: float,
        damping_ratio: float,
        moving_mass: float,
        thickness: float = THICKNESS,
        linear_range: float | None = None,
    ) -> Foam:
        """Return the foam whose damping is scaled to a moving mass, C_c = 2 xi sqrt(M K_c).

        Parameters
        ----------
        stiffness : float
            K_c in N/m.
        damping_ratio : float
            xi_c, as it is identified on a drop rig.
        moving_mass : float
            Mass M that the foam meets, in kg: the head's in an impact.
        thickness, linear_range : float
            As for the class.

        Returns
        -------
        Foam
            With the scaled damping.

        Raises
        ------
        InvalidParameterError
            If a value is negative or not finite, or the mass is zero.

        Examples
        --------
        >>> from hrsafety import impact
        >>> foam = impact.Foam.from_damping_ratio(stiffness=24250.0, damping_ratio=0.11, moving_mass=4.4)
        >>> round(foam.damping, 1)
        71.9
        """
        ratio = not_negative("damping_ratio", damping_ratio)
        product = positive("moving_mass", moving_mass) * not_negative("stiffness", stiffness)
        damping = 2.0 * ratio * math.sqrt(product)
        within = {} if linear_range is None else {"linear_range": linear_range}
        return cls(stiffness=stiffness, damping=damping, thickness=thickness, **within)


def default_linear_range(thickness: float) -> float:
    """Return the compression up to which foam of a thickness is linear when none is given."""
    return min(LINEAR_RANGE, LINEAR_SHARE * thickness)


MANIPULATOR_1 = Manipulator(mass=9.6, damping=250.0, stiffness=20_000.0)
"""Direct-drive arm, 0.078 m from its joint (Table 3.1 of Zeng 2011)."""

MANIPULATOR_2 = Manipulator(mass=49.4, damping=111.0, stiffness=14_400.0)
"""Puma 560, 0.5 m from its first joint (Table 3.1)."""

FOAM_1 = Foam(stiffness=24_300.0, damping=71.9)
"""Foam of Table 3.3 that suits both manipulators."""

FOAM_2 = Foam(stiffness=13_800.0, damping=43.8)
"""Foam of Table 3.3 that is too soft for Manipulator 2; the stiffness was most likely 13.48 kN/m."""

FOAM_3 = Foam(stiffness=60_600.0, damping=113.6)
"""Foam of Table 3.3 that is too stiff for both."""
