"""What is known of an arm without a pose."""

from __future__ import annotations

from typing import Any

import numpy as np

from hrsafety._arguments import Array, Parameters
from hrsafety.arms.masses import NO_MOTOR_INERTIA
from hrsafety.plausibility import ResultWarning

__all__ = ["Facts"]


class Facts(Parameters):
    """Base of an arm: names, limits and masses that no pose changes."""

    __slots__ = ()

    _facts: dict[str, Any]
    armature: tuple[tuple[str, float], ...]

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
    def link_names(self) -> tuple[str, ...]:
        """Links in the order of the file."""
        return tuple(self._facts["link_names"])

    @property
    def moved_links(self) -> tuple[str, ...]:
        """Links that some joint moves."""
        return tuple(name for name, moved in zip(self.link_names, self._facts["moved"], strict=True) if moved)

    @property
    def moving_mass(self) -> float:
        """Mass M of all links that some joint moves, locked or not, without payload, in kg."""
        return float(self._facts["moving_mass"])

    @property
    def payload_mass(self) -> float:
        """Mass m_L of the payload in kg."""
        return float(self._facts["payload_mass"])

    @property
    def iso_mass(self) -> float:
        """Mass of the robot by ISO/TS 15066, M/2 + m_L, in kg: neither always above nor always below the others."""
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
        """Why masses may not be what they seem."""
        found = []
        without = self._without_motors()
        if without:
            named = "" if without == self.free_joints else f" for {', '.join(without)}"
            found.append(ResultWarning("no_motor_inertia", "armature", NO_MOTOR_INERTIA.format(named)))
        for link in self.suspicious_links:
            message = f"link {link!r} has a radius of gyration below 2 mm: its inertia is hardly real"
            found.append(ResultWarning("suspicious_link", f"link[{link!r}]", message))
        for link in self.links_without_mass:
            message = f"link {link!r} has a shape but no mass: without what it weighs masses are too low"
            found.append(ResultWarning("link_without_mass", f"link[{link!r}]", message))
        return tuple(found)

    def _without_motors(self) -> tuple[str, ...]:
        """Return the joints of which nothing is known about the motor; a 0 beside other numbers is known."""
        if not self._facts["has_armature"]:
            return self.free_joints or self.joint_names
        named = {name for name, _ in self.armature}
        return tuple(name for name in self.free_joints if name not in named)
