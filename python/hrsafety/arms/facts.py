"""Facts about an arm that need no pose."""

from __future__ import annotations

from typing import Any

import numpy as np

from hrsafety._arguments import Array, Parameters
from hrsafety.arms import doubts
from hrsafety.arms.link_doubts import doubts_of_links
from hrsafety.arms.payload import Payload
from hrsafety.arms.rolling import BASE_JOINTS, RollingBase
from hrsafety.plausibility import ResultWarning

__all__ = ["Facts"]


class Facts(Parameters):
    """Base of an arm: names, limits and masses that no pose changes."""

    __slots__ = ()

    _facts: dict[str, Any]
    _doubts: tuple[ResultWarning, ...]
    armature: tuple[tuple[str, float], ...]
    payloads: tuple[Payload, ...]
    type_plate_mass: float | None
    mass_source: str
    link_masses: tuple[tuple[str, float], ...]
    base: RollingBase | str | None
    notes: tuple[ResultWarning, ...]

    @property
    def name(self) -> str:
        """Name in the URDF."""
        return str(self._facts["name"])

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Joints that take values, in the order of the file; locked ones are among them, mimic and fixed ones not."""
        return tuple(self._facts["joint_names"])

    @property
    def joint_kinds(self) -> tuple[str, ...]:
        """``"turning"`` (values in rad) or ``"sliding"`` (in m) for each joint."""
        return tuple(self._facts["joint_kinds"])

    @property
    def limits(self) -> Array:
        """Least and largest value of each joint (n, 2), infinite without limits."""
        return np.column_stack([self._facts["lower"], self._facts["upper"]])

    @property
    def free_joints(self) -> tuple[str, ...]:
        """Joints that are not locked."""
        return tuple(name for name, free in zip(self.joint_names, self._facts["free"], strict=True) if free)

    @property
    def base_joints(self) -> tuple[str, ...]:
        """Joints of a base that rolls."""
        rolls = isinstance(self.base, RollingBase)
        return tuple(name for name in self.joint_names if rolls and name in BASE_JOINTS)

    @property
    def link_names(self) -> tuple[str, ...]:
        """Links in the order of the file."""
        return tuple(self._facts["link_names"])

    @property
    def moved_links(self) -> tuple[str, ...]:
        """Links of the URDF that some joint moves."""
        below = [f"{name}_link" for name in self.base_joints]
        moved = zip(self.link_names, self._facts["moved"], strict=True)
        return tuple(name for name, moves in moved if moves and name not in below)

    @property
    def moving_mass(self) -> float:
        """Mass M of all links that some joint moves, locked or not, without payload, in kg."""
        return float(self._facts["moving_mass"])

    @property
    def total_mass(self) -> float:
        """Mass of all links, moved or not, without payload, in kg: to be compared with the type plate."""
        return float(self._facts["total_mass"])

    @property
    def reach(self) -> float:
        """Longest way from the first joint through the others to a link or its center of mass, in m."""
        return float(self._facts["reach"])

    @property
    def payload_mass(self) -> float:
        """Mass m_L of the payload in kg."""
        return float(self._facts["payload_mass"])

    @property
    def iso_mass(self) -> float:
        """Mass of the robot by ISO/TS 15066, M/2 + m_L, in kg: neither always above nor always below the others.

        M is that of all moving links, those of a base that rolls with them, or the mass of the type plate.
        """
        if self.mass_source == "type_plate" and self.type_plate_mass is not None:
            rolling = self.base.mass if isinstance(self.base, RollingBase) else 0.0
            return 0.5 * (self.type_plate_mass + rolling) + self.payload_mass
        return float(self._facts["iso_mass"])

    @property
    def suspicious_links(self) -> tuple[str, ...]:
        """Moving links whose radius of gyration is below 2 mm: their inertia is hardly real."""
        return tuple(self._facts["suspicious_links"])

    @property
    def links_without_mass(self) -> tuple[str, ...]:
        """Moving links with a shape but no ``inertial``, or one of no mass: every mass lacks what they weigh."""
        return tuple(self._facts["links_without_mass"])

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why masses may not be what they seem.

        A doubt about motor inertias stands here as one on the unsafe side. Where the mass of ISO/TS 15066 governs, it
        lies on the safe side, for no motor changes that mass: results that know the rule say so.
        """
        return self._doubts

    def _doubted(self) -> tuple[ResultWarning, ...]:
        facts, rolling = self._facts, isinstance(self.base, RollingBase)
        # Wheels have their motors in the mass of the base; the type plate is that of the arm.
        driven = tuple(name for name in self.free_joints if name not in self.base_joints)
        below = self.base.mass if isinstance(self.base, RollingBase) else 0.0
        plate = None if rolling and self.mass_source == "scaled" else self.type_plate_mass
        return (
            *doubts.doubts_of_motors(self.armature, facts, driven),
            *(each for each in doubts_of_links(facts) if self.base is None or each.code != "base_assumed_fixed"),
            *doubts.doubts_of_given(self.link_masses),
            *doubts.doubts_of_plate(self.total_mass - below, self.moving_mass - below, plate),
            *doubts.doubts_of_payloads(self.payloads, self.moving_mass),
            *doubts.doubts_of_reading(facts),
            *self.notes,
        )
