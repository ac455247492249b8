"""Motions that a two-wheel robot can follow: lines, circles, sampled paths."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, NamedTuple

import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, Parameters, instance, pair, points, vector
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import ShapeError
from hrsafety.navigation.trajectory import Trajectory

__all__ = ["CircleReference", "LineReference", "PathReference", "Reference", "ReferenceMotion"]


@displayed
class ReferenceMotion(NamedTuple):
    """Motion of a reference at n instants.

    Attributes
    ----------
    position, velocity, acceleration : ndarray, shape (n, 2)
        In m, m/s and m/s^2.
    """

    position: Annotated[Array, "m"]
    velocity: Annotated[Array, "m/s"]
    acceleration: Annotated[Array, "m/s^2"]


class _Motion(Parameters):
    """Base of the references."""

    __slots__ = ()
    _native: _hrsafety.ReferencePath

    def at(self, time: npt.ArrayLike) -> ReferenceMotion:
        """Return the motion at instants.

        Parameters
        ----------
        time : array_like, shape (n,)
            Instants in s.

        Returns
        -------
        ReferenceMotion
            Position, velocity and acceleration.
        """
        return ReferenceMotion(**self._native.at(vector("time", time)))


@dataclass(frozen=True, kw_only=True, slots=True)
class LineReference(_Motion):
    """Reference at constant velocity, or at rest.

    Parameters
    ----------
    start : tuple of float
        Position (x, y) at time 0, in m.
    velocity : tuple of float
        Velocity in m/s.

    Raises
    ------
    InvalidParameterError
        If a number is not finite.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.tracking.LineReference(start=(1.0, 0.0), velocity=(0.5, 0.0)).at([2.0]).position.tolist()
    [[2.0, 0.0]]
    """

    start: Pair
    velocity: Pair = (0.0, 0.0)
    _native: _hrsafety.ReferencePath = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        values = {"start": pair("start", self.start), "velocity": pair("velocity", self.velocity)}
        self._set(**values, _native=_hrsafety.ReferencePath.line(**values))


@dataclass(frozen=True, kw_only=True, slots=True)
class CircleReference(_Motion):
    """Reference on a circle at constant speed.

    Parameters
    ----------
    center : tuple of float
        Center (x, y) in m.
    radius : float
        Radius in m.
    speed : float
        Speed in m/s, counter-clockwise; clockwise when negative.
    start_angle : float
        Direction of the start as seen from the center, in rad.

    Raises
    ------
    InvalidParameterError
        If a number is not finite or the radius is not positive.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.tracking.CircleReference(center=(0.0, 0.0), radius=2.0, speed=0.5).at([0.0]).velocity.tolist()
    [[-0.0, 0.5]]
    """

    center: Pair
    radius: float
    speed: float
    start_angle: float = 0.0
    _native: _hrsafety.ReferencePath = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        center = pair("center", self.center)
        values = self._as_numbers("radius", "speed", "start_angle")
        self._set(center=center, _native=_hrsafety.ReferencePath.circle(center=center, **values))


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PathReference(_Motion):
    """Reference through samples of position and velocity, cubic between them.

    It stands before the first sample and after the last.

    Parameters
    ----------
    time : array_like, shape (n,)
        Instants in s, strictly increasing.
    position, velocity : array_like, shape (n, 2)
        Samples in m and m/s.

    Raises
    ------
    InvalidParameterError
        If there is no sample, a number is not finite or time does not grow.
    ShapeError
        If the arrays do not fit together.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> path = nav.tracking.PathReference(time=[0.0, 2.0], position=[[0, 0], [1, 0]], velocity=[[0, 0], [0, 0]])
    >>> path.at([1.0]).velocity.tolist()
    [[0.75, 0.0]]
    """

    time: Annotated[Array, "s"]
    position: Annotated[Array, "m"]
    velocity: Annotated[Array, "m/s"]
    _native: _hrsafety.ReferencePath = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        values = {
            "time": vector("time", self.time).copy(),
            "position": points("position", self.position).copy(),
            "velocity": points("velocity", self.velocity).copy(),
        }
        for name in ("position", "velocity"):
            if len(values[name]) != len(values["time"]):
                raise ShapeError(name, f"({len(values['time'])}, 2)", values[name].shape)
        self._set(**values, _native=_hrsafety.ReferencePath.samples(**values))
        for array in values.values():
            array.setflags(write=False)

    @classmethod
    def from_run(cls, trajectory: Trajectory) -> PathReference:
        """Return the motion of a simulated robot, resampled nowhere.

        Parameters
        ----------
        trajectory : Trajectory
            The run.

        Returns
        -------
        PathReference
            A reference that moves as the robot did and then stands.

        Raises
        ------
        InvalidParameterError
            If ``trajectory`` is not a `Trajectory`.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> run = nav.simulate(scenarios.configuration("n1"), nav.VirtualForceField())
        >>> nav.tracking.PathReference.from_run(run).time.shape == run.time.shape
        True
        """
        run = instance("trajectory", trajectory, Trajectory)
        return cls(time=run.time, position=run.position, velocity=run.velocity)


Reference = LineReference | CircleReference | PathReference
"""The references."""
