"""Forces at a state: what a law asks for, the terms of the virtual force field, its Lyapunov function."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, instance, number, numbers, pair, points
from hrsafety._display import displayed
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.navigation.laws.force_laws import Law, VirtualForceField
from hrsafety.navigation.laws.python_law import AnyLaw, as_law
from hrsafety.navigation.scenario import Scenario

__all__ = ["ForceField", "ForceTerms", "Lyapunov", "check_law", "command", "force_field", "force_terms", "lyapunov"]


@displayed
class ForceTerms(NamedTuple):
    """Virtual forces at one state, before the acceleration limit.

    Attributes
    ----------
    attractive : ndarray, shape (2,)
        F_a in N.
    repulsive, detour : ndarray, shape (n, 2)
        F_Lambda and F_psi of each obstacle in N; zero outside its active region.
    stabilizing : ndarray, shape (2,)
        F_L in N, in the mode of the law.
    total : ndarray, shape (2,)
        Commanded force in N: the sum, or the braking force inside a critical region, where
        every term is zero.
    region : ndarray of str, shape (n,)
        ``"free"``, ``"active"``, ``"critical"`` or ``"absent"`` for each obstacle; the laws of other
        authors know no critical region.
    side : ndarray of int, shape (n,)
        Side of the detour: +1 counter-clockwise, -1 clockwise, 0 when not active.
    omega : float
        Omega of (5.5.8), corrected, in N^2/s; NaN for the laws of other authors.
    """

    attractive: Annotated[Array, "N"]
    repulsive: Annotated[Array, "N"]
    detour: Annotated[Array, "N"]
    stabilizing: Annotated[Array, "N"]
    total: Annotated[Array, "N"]
    region: npt.NDArray[np.str_]
    side: npt.NDArray[np.int64]
    omega: float


@displayed
class ForceField(NamedTuple):
    """Virtual forces at many positions, summed over the obstacles.

    Attributes
    ----------
    position : ndarray, shape (n, 2)
        Where, in m.
    attractive, repulsive, detour, stabilizing, total : ndarray, shape (n, 2)
        Forces in N; NaN inside a critical region except ``total``, which brakes there.
    potential : ndarray, shape (n,)
        Lyapunov function V in N^2; NaN inside a critical region.
    """

    position: Annotated[Array, "m"]
    attractive: Annotated[Array, "N"]
    repulsive: Annotated[Array, "N"]
    detour: Annotated[Array, "N"]
    stabilizing: Annotated[Array, "N"]
    total: Annotated[Array, "N"]
    potential: Array


@displayed
class Lyapunov(NamedTuple):
    """Lyapunov function of the force field at one state.

    Attributes
    ----------
    value : float
        V in N^2.
    derivative : float
        dV/dt in N^2/s with the law's own stabilizing force; limits of the robot are ignored.
    omega : float
        Omega in N^2/s.
    """

    value: float
    derivative: float
    omega: float


def check_law(scenario: Scenario, law: Law, kind: type[Law] = VirtualForceField) -> None:
    """Refuse what is no scenario, or no law of the wanted kind."""
    instance("scenario", scenario, Scenario)
    instance("law", law, kind)


def _check_told(found: npt.ArrayLike, position: npt.ArrayLike, velocity: npt.ArrayLike) -> None:
    """Refuse the larger one of two finite arguments if what follows from them is not finite."""
    if np.isfinite(found).all():
        return
    given = {"position": np.asarray(position), "velocity": np.asarray(velocity)}
    name = max(given, key=lambda each: float(np.abs(given[each]).max(initial=0.0)))
    largest = float(np.abs(given[name]).max(initial=0.0))
    raise InvalidParameterError(name, "be so small that forces and their powers can be told", largest)


def command(
    law: AnyLaw,
    scenario: Scenario,
    *,
    position: Sequence[float] | Array,
    velocity: Sequence[float] | Array,
    time: float = 0.0,
) -> Array:
    """Return the force that any law asks for at one state, as at its first control step.

    Parameters
    ----------
    law : Law
        The law.
    scenario : Scenario
        Robot, goal and obstacles.
    position, velocity : array_like, shape (2,)
        State of the robot, in m and m/s.
    time : float
        When, in s; moving obstacles are where they are then.

    Returns
    -------
    ndarray, shape (2,)
        Force in N before the limits of the robot. A planner asks for ``m (v* - V)/T_s``, with
        its velocity v* and the control period T_s.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, the time is negative, or the law cannot work in the scenario.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> nav.laws.command(
    ...     nav.Masoud(), scenarios.configuration("c1"), position=(3.5, 0.6), velocity=(0.0, 0.0)
    ... ).round(3).tolist()
    [-17.5, 0.0]
    """
    instance("scenario", scenario, Scenario)
    law = as_law(law)
    state = pair("position", position), pair("velocity", velocity)
    found = np.array(_hrsafety.law_command(law._native, scenario._native, *state, number("time", time)))
    _check_told(found, *state)
    return found


def force_terms(
    law: Law,
    scenario: Scenario,
    *,
    position: Sequence[float] | Array,
    velocity: Sequence[float] | Array,
    time: float = 0.0,
) -> ForceTerms:
    """Return every virtual force at one state.

    The components of Masoud's force are (2.2.8) to (2.2.10), those of Ge and Cui's (2.2.11) to
    (2.2.15).

    Parameters
    ----------
    law : Law
        A law that is a sum of attraction and repulsion: `VirtualForceField`, `Masoud`, `GeCui`,
        `Khatib` or `BorensteinKoren`.
    scenario : Scenario
        Goal and obstacles.
    position, velocity : array_like, shape (2,)
        State of the robot, in m and m/s.
    time : float
        When, in s; moving obstacles are where they are then.

    Returns
    -------
    ForceTerms
        Attractive, repulsive, detour, stabilizing and total force, region and side.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, the time is negative, or the law is a planner.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> terms = nav.force_terms(
    ...     nav.VirtualForceField(), scenarios.configuration("c1"),
    ...     position=(2.95, 0.71), velocity=(-0.5, 0.1),
    ... )
    >>> terms.repulsive.round(3).tolist()
    [[28.788, 6.621]]

    Masoud's law pushes away and, always counterclockwise, around:

    >>> terms = nav.force_terms(
    ...     nav.Masoud(), scenarios.configuration("c1"), position=(2.95, 0.6), velocity=(0.0, 0.0)
    ... )
    >>> terms.repulsive.round(3).tolist(), terms.detour.round(3).tolist()
    ([[12.0, 0.12]], [[-0.18, 18.0]])
    """
    check_law(scenario, law, Law)
    state = pair("position", position), pair("velocity", velocity)
    found = ForceTerms(**_hrsafety.force_terms(law._native, scenario._native, *state, number("time", time)))
    _check_told(found.total, *state)
    return found


def force_field(
    law: VirtualForceField,
    scenario: Scenario,
    *,
    position: npt.ArrayLike,
    velocity: Sequence[float] | npt.ArrayLike = (0.0, 0.0),
    time: float = 0.0,
) -> ForceField:
    """Return the virtual forces at many positions, for maps and arrows.

    Parameters
    ----------
    law : VirtualForceField
        The law.
    scenario : Scenario
        Goal and obstacles.
    position : array_like, shape (n, 2)
        Positions of the robot in m.
    velocity : array_like, shape (2,) or (n, 2)
        Velocity of the robot there, in m/s.
    time : float
        When, in s.

    Returns
    -------
    ForceField
        Forces summed over the obstacles, and the Lyapunov function.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or the time is negative.
    ShapeError
        If the arrays do not fit together.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> field = nav.laws.force_field(
    ...     nav.VirtualForceField(), scenarios.configuration("c1"), position=[[3.5, 0.6], [3.0, 0.6]]
    ... )
    >>> field.total.shape
    (2, 2)
    """
    check_law(scenario, law)
    places = points("position", position)
    speeds = numbers("velocity", velocity, "be an array of numbers")
    if speeds.shape not in {(2,), places.shape}:
        raise ShapeError("velocity", f"(2,) or {places.shape}", speeds.shape)
    speeds = np.ascontiguousarray(np.broadcast_to(speeds, places.shape))
    fields = _hrsafety.force_field(law._native, scenario._native, places, speeds, number("time", time))
    found = ForceField(position=places, **fields)
    _check_told(found.total, places, speeds)
    return found


def lyapunov(
    law: VirtualForceField,
    scenario: Scenario,
    *,
    position: Sequence[float] | Array,
    velocity: Sequence[float] | Array,
    time: float = 0.0,
) -> Lyapunov:
    """Return the Lyapunov function (5.5.2) of the field and its derivative.

    ``V = K_1^2 |E|^2/2 + m K_1 |V|^2/2 + sum over active obstacles of K_3^2 L^2/2
    + m K_3 (r_2-d)^2/(d-r_3)^2 ddot^2/2 + K_5^2 psi^2/2 + m K_5 (r_2-d)^2 d Phidot^2/2`` and
    ``dV/dt = -b |v_L|^2 - v_L.F_L + Omega`` with the corrected Omega. The identity holds for
    discs as long as no side switches; on the face of a rectangle it does not.

    Parameters
    ----------
    law : VirtualForceField
        The law; its stabilizing force enters the derivative.
    scenario : Scenario
        Goal and obstacles.
    position, velocity : array_like, shape (2,)
        State of the robot, in m and m/s.
    time : float
        When, in s.

    Returns
    -------
    Lyapunov
        value, derivative, omega.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, or the position lies inside a critical region, where the
        function is not defined.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> state = nav.lyapunov(
    ...     nav.VirtualForceField(stabilizing="full"), scenarios.configuration("c1"),
    ...     position=(2.95, 0.71), velocity=(-0.5, 0.1),
    ... )
    >>> state.derivative <= 0
    True
    """
    check_law(scenario, law)
    state = pair("position", position), pair("velocity", velocity)
    found = Lyapunov(*_hrsafety.lyapunov(law._native, scenario._native, *state, number("time", time)))
    _check_told(found, *state)
    return found
