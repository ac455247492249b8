"""Contact of a robot with a part of a body, bare or through a covering: loads, allowed speeds, thicknesses, chances."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy.typing as npt

from hrsafety._arguments import not_negative, number, numbers, positive
from hrsafety._records import dataclass
from hrsafety.contact.bodies import body_of, knows, named
from hrsafety.contact.cell.robot import ContactRobot
from hrsafety.contact.chance import Exceedance, chance_of
from hrsafety.contact.covering import Covering, Region, covering_of
from hrsafety.contact.least_thickness import LeastThickness, thickness_of
from hrsafety.contact.materials import StressTable
from hrsafety.contact.rows import HORIZON, TOLERANCE, Prepared, contact_row, limits_of, mass_of, spring_of
from hrsafety.contact.sensitivities import sensitivities_of
from hrsafety.contact.simulation import ContactBatch, ContactImpact, impact_of, impacts_of
from hrsafety.contact.speed import AllowedSpeed, AllowedSpeeds, allowed_of, speeds_of
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import telling
from hrsafety.standards.contact_limits import ContactLimit
from hrsafety.standards.sets import looser_than_published

__all__ = ["Contact", "Support"]

_NO_LIMITS: Mapping[str, None] = MappingProxyType({"force": None, "pressure": None})
"""Limits of a collision: no load depends on them."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Support:
    """Support that holds a robot or a body in its place: a spring and a damper, of a robot's drive also its stop.

    Parameters
    ----------
    damping : float
        In N s/m.
    stiffness : float
        In N/m.
    stop : tuple of two floats or None
        When the set point of the robot begins to brake, in s, and its deceleration in m/s^2.

    Examples
    --------
    >>> from hrsafety import contact
    >>> contact.Support(stiffness=20e3, damping=200.0, stop=(0.01, 10.0)).stiffness
    20000.0
    """

    damping: float = 0.0
    stiffness: float = 0.0
    stop: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        for name in ("damping", "stiffness"):
            object.__setattr__(self, name, not_negative(name, getattr(self, name)))
        if self.stop is not None:
            if not isinstance(self.stop, (tuple, list)) or len(self.stop) != 2:
                raise InvalidParameterError("stop", "be a time and a deceleration", self.stop)
            stop = (not_negative("stop.time", self.stop[0]), positive("stop.deceleration", self.stop[1]))
            object.__setattr__(self, "stop", stop)


@dataclass(frozen=True, kw_only=True, slots=True)
class Contact:
    """A contact of a robot with a part of a body.

    Parameters
    ----------
    robot : float or ContactRobot
        Mass in kg that the contact feels, inf where the robot cannot yield. The doubts of a `ContactRobot` are those of
        every result.
    body : float, ContactLimit or None
        Mass of the part of the body in kg; inf or ``None``: clamped. A limit object such as `standards.ContactLimit`
        knows mass, spring and class of its region, and the limits.
    region : Region, mapping, float or None
        Spring of the region; a number is k in N/m. ``None``: that of a limit object, else a rigid region.
    covering : Covering, mapping or None
        ``None``: bare.
    area : float or None
        Contact area in m^2 of a bare contact; without it its pressure is not checked.
    max_strain : float or None
        Largest strain of the covering, its e_b when ``None``.
    drive : Support or None
        What pushes the robot on, and how it stops.
    support : Support or None
        What holds the body.

    Notes
    -----
    A clamped contact holds for a robot without drive, unless `drive` describes one with stiffness and stop: the doubt
    ``drive_not_given`` says so.

    Examples
    --------
    >>> from hrsafety import contact, standards
    >>> hand = standards.limits().contact("hand_finger", "transient")
    >>> bare = contact.Contact(robot=16.35, body=hand, area=1e-4)
    >>> round(bare.allowed_speed().speed, 6), bare.allowed_speed().governs
    (1.343933, 'force')
    >>> own = contact.Contact(robot=16.35, body=0.6, region=75e3, area=1e-4)
    >>> own.allowed_speed({"force": 280.0, "pressure": 380e4}).speed == bare.allowed_speed().speed
    True
    """

    robot: float | ContactRobot
    body: Any = None
    region: Region | Mapping[str, object] | float | None = None
    covering: Covering | Mapping[str, object] | None = None
    area: float | None = None
    max_strain: float | None = None
    drive: Support | None = None
    support: Support | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        if not isinstance(self.robot, ContactRobot):
            object.__setattr__(self, "robot", mass_of("robot", number("robot", self.robot)))
        if self.body is not None and not knows(self.body):
            object.__setattr__(self, "body", mass_of("body", self.body))
        object.__setattr__(self, "covering", covering_of(self.covering))
        for name in ("drive", "support"):
            given = getattr(self, name)
            if given is not None and not isinstance(given, Support):
                raise InvalidParameterError(name, "be a Support", given)
        if self.support is not None and self.support.stop is not None:
            raise InvalidParameterError("support.stop", "be None: a body does not brake", self.support.stop)
        self._row(self.region, None, TOLERANCE)

    def _row(
        self, region: Any, body_mass: float | None, tolerance: float, **more: object
    ) -> tuple[dict[str, object], dict[str, float]]:
        drive, support = self.drive or Support(), self.support or Support()
        return contact_row(
            robot_mass=self.robot.mass if isinstance(self.robot, ContactRobot) else self.robot,
            body_mass=body_mass,
            region=region,
            covering=self.covering,
            tolerance=tolerance,
            area=self.area,
            max_strain=self.max_strain,
            robot_damping=drive.damping,
            robot_stiffness=drive.stiffness,
            body_damping=support.damping,
            body_stiffness=support.stiffness,
            stop=drive.stop,
            **more,
        )

    def _prepared(
        self,
        limits: object,
        *,
        given: Mapping[str, object] | None = None,
        tolerance: float = TOLERANCE,
        **more: object,
    ) -> Prepared:
        """Return the contact as the core reads it, with the limits that hold."""
        own = self.body if knows(self.body) else None
        limits = own if limits is None else limits
        source = limits if own is None or knows(limits) else own
        if own is not None and knows(limits) and limits is not own:
            for name in ("spring_constant", "body_mass"):
                if getattr(own, name) != getattr(limits, name):
                    rule = f"be of the region and class of body ({named(own)})"
                    raise InvalidParameterError("limits", rule, str(limits), "leave it out: body knows its limits")
        if own is not None and limits is not _NO_LIMITS:
            limits_of(own)  # what is not permitted is so with other limits, too
        arrays = given or {}
        body = body_of(source, self.region, None if own is not None else self.body, given=tuple(arrays))
        shared, values = self._row(spring_of(body.region, arrays), body.mass, tolerance, **more)
        doubts = self.robot.warnings if isinstance(self.robot, ContactRobot) else ()
        pad = covering_of(self.covering)
        if pad is not None and isinstance(pad.material, StressTable):
            doubts = (*doubts, *pad.material.warnings)
        if isinstance(limits, ContactLimit):
            doubts = (*doubts, *looser_than_published(limits))
        return Prepared(shared, values | limits_of(limits), pad, source, doubts)

    def _at_rest(self, what: str) -> None:
        """Refuse supports where a result comes from the stored energy alone."""
        for name in ("drive", "support"):
            if getattr(self, name) is not None:
                raise InvalidParameterError(name, f"be None for {what}", getattr(self, name))

    @telling()
    def allowed_speed(
        self,
        limits: object = None,
        *,
        human_speed: float = 0.0,
        horizon: float = HORIZON,
        tolerance: float = TOLERANCE,
    ) -> AllowedSpeed:
        """Return the closing speed at which the contact just keeps its limits.

        From the stored energy, mu v^2/2 = W_c + W_b, where nothing is lost; by simulation with rate, damper, supports
        or a stop.

        Parameters
        ----------
        limits : mapping, object or None
            ``force`` in N and ``pressure`` in Pa, of the class of contact, of which ``None`` is not checked, or a limit
            object such as `standards.ContactLimit`, which also knows spring, mass and class of its region. ``None``:
            those of the body.
        human_speed : float
            Speed of the person towards the robot in m/s, not negative: no person has to keep walking away.
        horizon : float
            Time in s after which a simulated collision is left alone.
        tolerance : float
            Relative tolerance of simulations.

        Returns
        -------
        AllowedSpeed
            A closing speed with the limit that governs.

        Raises
        ------
        InvalidParameterError
            If a number is out of its range or contradicts a limit object, or the contact is not permitted.

        Examples
        --------
        >>> from hrsafety import contact
        >>> hit = contact.Contact(robot=16.35, body=0.6, region=75e3, area=1e-4)
        >>> found = hit.allowed_speed({"force": 280.0, "pressure": 380e4})
        >>> round(found.speed, 6), found.governs
        (1.343933, 'force')
        """
        given = self._prepared(limits, tolerance=tolerance, horizon=positive("horizon", horizon))
        return allowed_of(given, human_speed)

    @telling()
    def allowed_speeds(
        self,
        limits: object = None,
        *,
        horizon: float = HORIZON,
        tolerance: float = TOLERANCE,
        threads: int | None = None,
        progress: Callable[[int, int], object] | None = None,
        **arrays: npt.ArrayLike,
    ) -> AllowedSpeeds:
        """Return many allowed speeds: a map over thickness and modulus, masses along a motion, a catalog.

        Parameters
        ----------
        limits, horizon, tolerance
            As for `allowed_speed`, the same for all rows.
        threads, progress
            As for `simulate_many`.
        **arrays : array_like
            As for `simulate_many`, and ``area`` (m^2), ``max_strain``, ``force_limit`` (N) and ``pressure_limit`` (Pa).
            Beside a limit object none that contradicts its own number.

        Returns
        -------
        AllowedSpeeds
            Arrays of the broadcast shape.

        Raises
        ------
        InvalidParameterError
            If a name is not known, an option out of range, or a number not that of a limit object.
        ShapeError
            If the arrays do not broadcast.

        Examples
        --------
        Which foam: a map over thickness and modulus.

        >>> from hrsafety import contact
        >>> pad = contact.Covering(material=contact.Linear(modulus=1e5), thickness=0.02, area=4e-3)
        >>> hit = contact.Contact(robot=8.0, body=40.0, region=25e3, covering=pad)
        >>> found = hit.allowed_speeds({"force": 280.0}, thickness=[[0.01], [0.02]], modulus=[5e4, 1e5])
        >>> found.speed.round(3).tolist(), found.governs[0].tolist()
        ([[0.588, 0.874], [0.733, 1.029]], ['strain', 'force'])
        """
        given = self._prepared(limits, given=arrays, tolerance=tolerance, horizon=positive("horizon", horizon))
        return speeds_of(given, arrays, threads, progress)

    @telling()
    def simulate(
        self,
        speed: float,
        *,
        horizon: float = HORIZON,
        head: bool | None = None,
        tolerance: float = TOLERANCE,
    ) -> ContactImpact:
        """Return the loads of a collision, from the first touch to the first loss of contact.

        Parameters
        ----------
        speed : float
            Closing speed v in m/s; none above 0 is ``"no_impact"``.
        horizon : float
            Time in s after which the collision is left alone.
        head : bool or None
            Whether to give the head injury criterion; for bodies below 10 kg when ``None``.
        tolerance : float
            Relative tolerance of the solution, from 1e-12 to 1e-3. Compressions, and speeds after the contact, may err
            by up to a hundred times as much where a covering turns just behind the start or the end of a plateau;
            forces mostly do not (of 2,000 random collisions one by 120 times).

        Returns
        -------
        ContactImpact
            Loads and motion.

        Raises
        ------
        InvalidParameterError
            If a number is out of its range, or the covering is compressed by more than its table holds
            (``beyond_data``); the message names it.

        Examples
        --------
        >>> from hrsafety import contact
        >>> hit = contact.Contact(robot=3.0, body=0.6, region=75e3).simulate(0.5)
        >>> hit.status, round(hit.peak_force, 2)
        ('released', 96.82)
        """
        closing = number("speed", speed)
        return impact_of(self._loaded(tolerance, horizon, closing_speed=closing), head)

    def _loaded(self, tolerance: float, horizon: float, **more: Any) -> Prepared:
        """Return the contact without its limits, which no load depends on."""
        return self._prepared(_NO_LIMITS, tolerance=tolerance, horizon=positive("horizon", horizon), **more)

    @telling()
    def simulate_many(
        self,
        speed: npt.ArrayLike,
        *,
        horizon: float = HORIZON,
        head: bool = False,
        tolerance: float = TOLERANCE,
        threads: int | None = None,
        progress: Callable[[int, int], object] | None = None,
        **arrays: npt.ArrayLike,
    ) -> ContactBatch:
        """Return the loads of many collisions over all cores; every number may be an array, and all broadcast.

        A row with a bad number is NaN with a status that names it; it never fails the batch.

        Parameters
        ----------
        speed : array_like
            Closing speeds in m/s.
        horizon, tolerance
            As for `simulate`, the same for all rows.
        head : bool
            Whether to give the head injury criterion, which takes longer than the collision.
        threads : int or None
            Number of threads; all cores when ``None``. Never changes a bit.
        progress : callable or None
            Called now and then as ``progress(done, total)``.
        **arrays : array_like
            Numbers that differ from row to row: ``robot_mass``, ``body_mass`` (inf is clamped), ``stiffness`` (of the
            region), ``thickness``, ``area``, ``radius``, ``damping``, supports such as ``robot_stiffness``, and the
            numbers of the law (``modulus``, ``plateau``, ...). One without effect, such as a thickness of no covering,
            is an error.

        Returns
        -------
        ContactBatch
            Arrays of the broadcast shape.

        Raises
        ------
        InvalidParameterError
            If a name is not known or an option out of range.
        ShapeError
            If the arrays do not broadcast.

        Examples
        --------
        >>> from hrsafety import contact
        >>> pad = contact.Covering(material=contact.Linear(modulus=2e5), thickness=0.02, area=4e-3)
        >>> hit = contact.Contact(robot=8.0, body=40.0, region=25e3, covering=pad)
        >>> hit.simulate_many([0.3, 0.6], thickness=[[0.01], [0.02]]).peak_force.round(1).tolist()
        [[106.9, 213.8], [96.1, 192.2]]
        """
        given = self._loaded(tolerance, horizon, given=arrays)
        return impacts_of(given, {"closing_speed": numbers("speed", speed), **arrays}, head, threads, progress)

    def thickness(self, speed: float, limits: object = None) -> LeastThickness:
        """Return the least thickness of the covering at which a closing speed is allowed.

        Parameters
        ----------
        speed : float
            Wanted closing speed in m/s.
        limits : mapping, object or None
            As for `allowed_speed`.

        Returns
        -------
        LeastThickness
            With its status; the thickness that the covering has does not matter.

        Raises
        ------
        InvalidParameterError
            If a number is out of its range or contradicts a limit object, or the covering has a damper or a rate.

        Examples
        --------
        >>> from hrsafety import contact
        >>> pad = contact.Covering(material=contact.Linear(modulus=69690.0), thickness=0.01, area=0.002481)
        >>> hit = contact.Contact(robot=6.709, body=40.0, region=25e3, covering=pad)
        >>> found = hit.thickness(1.064, {"force": 360.0, "pressure": 420e4})
        >>> round(found.thickness, 6), found.status
        (0.051863, 'found')
        """
        self._at_rest("a thickness")
        wanted, pad = positive("speed", speed), covering_of(self.covering)
        bare = replace(self, covering=None, area=None if pad is None else pad.area, max_strain=None)
        return thickness_of(self._prepared(limits, closing_speed=wanted), bare._prepared(limits), wanted)

    def probability(
        self,
        speed: float,
        limits: object = None,
        *,
        draws: int = 100_000,
        seed: int = 0,
        threads: int | None = None,
        progress: Callable[[int, int], object] | None = None,
        **uncertain: float | Mapping[str, object],
    ) -> Exceedance:
        """Return the chance that a closing speed is not allowed.

        Any number may be ``{"normal": [mean, s]}``, ``{"lognormal": [median, s]}``, ``{"uniform": [a, b]}`` or
        ``{"triangular": [a, c, b]}``. Normal numbers that are not positive are drawn again; a distribution of which
        more than 1e-6 is not positive is an error.

        Parameters
        ----------
        speed : float
            Closing speed in m/s.
        limits : mapping, object or None
            As for `allowed_speed`. Beside a limit object the middle of a distribution of one of its numbers may be off
            by at most its own spread.
        draws : int
            Number of draws, up to 1e8.
        seed : int
            The same seed gives the same bits for any number of threads.
        threads : int or None
            Number of threads; all cores when ``None``.
        progress : callable or None
            Called now and then as ``progress(done, total)`` with numbers of draws.
        **uncertain : float or mapping
            Numbers in the place of those of the contact by name, as for `allowed_speeds`: ``robot_mass``,
            ``body_mass``, ``stiffness``, ``force_limit``, ``thickness``, ...

        Returns
        -------
        Exceedance
            Share with its interval, and quantiles of the allowed speed.

        Raises
        ------
        InvalidParameterError
            If a number or a distribution is out of range or contradicts a limit object, a number has no effect, no
            limit is checked, or the covering has a damper or a rate.

        Examples
        --------
        >>> from hrsafety import contact
        >>> hit = contact.Contact(robot=3.52, region=58610.0)
        >>> found = hit.probability(
        ...     0.2621, robot_mass={"lognormal": [3.52, 0.2866]}, stiffness={"lognormal": [58610.0, 0.1044]},
        ...     force_limit={"lognormal": [148.1, 0.2275]}, draws=20_000,
        ... )
        >>> found.interval[0] < 0.21266 < found.interval[1]
        True
        """
        self._at_rest("a chance")
        given = self._prepared(limits, given=uncertain)
        more: dict[str, Any] = {"draws": draws, "seed": seed, "threads": threads, "progress": progress}
        return chance_of(given, speed, uncertain, **more)

    def sensitivity(self, limits: object = None) -> dict[str, float]:
        """Return d ln v/d ln x of the allowed speed for every number x that is given, the largest first.

        Parameters
        ----------
        limits : mapping, object or None
            As for `allowed_speed`.

        Returns
        -------
        dict of str to float
            By name; central differences. At a tie of two limits each side has its own slope, and this is the mean.

        Raises
        ------
        InvalidParameterError
            If a number is out of its range, or nothing limits the speed.

        Examples
        --------
        >>> from hrsafety import contact
        >>> found = contact.Contact(robot=10.0, region=75e3).sensitivity({"force": 280.0})
        >>> {name: round(value, 6) for name, value in found.items()}
        {'force_limit': 1.0, 'robot_mass': -0.5, 'stiffness': -0.5}
        """
        self._at_rest("a sensitivity")
        return sensitivities_of(self._prepared(limits, tolerance=1e-10))
