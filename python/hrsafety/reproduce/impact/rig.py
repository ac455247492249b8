"""Arm and cylinder of the test rig of appendix A."""

from __future__ import annotations

from collections.abc import Iterator

from hrsafety import impact
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.impact.cases import published_lever_arm
from hrsafety.reproduce.published import printed_figure, printed_rows
from hrsafety.reproduce.sheets import Sheet

__all__ = ["arm", "cylinder"]

INCH = 0.0254


def _printed(name: str) -> float:
    return printed_figure("A.2", name)


def arm() -> Iterator[PrintedValue]:
    """Yield density, mass and inertia of the arm of the direct-drive manipulator."""
    sheet = Sheet("appendix_a")
    length, width, wall = 0.664, 0.0508, 0.003
    outer, inner = length * width**2, (length - wall) * (width - wall) ** 2
    yield sheet.number("tube_density", _printed("tube_mass") / (outer - inner))
    tube = impact.identification.tube_inertia(
        density=_printed("density"), length=length, width=width, height=width, wall=INCH / 16.0
    )
    yield sheet.number("tube_center", tube.inertia)
    yield sheet.number("tube_mass", tube.mass)
    offset = 0.502 - 0.644 / 2.0
    own = _printed("tube_inertia_center") + _printed("tube_mass") * offset**2
    other = _printed("tube_inertia_center") + _printed("tube_mass") * (0.502 - 0.664 / 2.0) ** 2
    disk = 1.497 * (0.0508**2 / 2.0 + 0.113**2)
    yield sheet.number("tube_joint", own, other=other)
    yield sheet.number("disk", disk)
    effective_mass = (other + disk) / published_lever_arm(1) ** 2
    yield sheet.number("arm_inertia", own + disk, other=other + disk, mass=effective_mass)
    yield sheet.number("arm_mass", _printed("inertia") / published_lever_arm(1) ** 2)


def cylinder() -> Iterator[PrintedValue]:
    """Yield the constants of the controller of the cylinder."""
    sheet, controller = Sheet("appendix_a"), impact.joints.CylinderController()
    for row in printed_rows("section A.3"):
        own = getattr(controller, row["figure"])
        name = row["figure"].replace("_", " ")
        yield sheet.number("cylinder", own, printed=row["value"], name=name, unit=row["unit"])
