"""Arm and cylinder of the test rig of appendix A."""

from __future__ import annotations

from collections.abc import Iterator

from hrsafety import impact
from hrsafety.reproduce.cells import Cell, Tolerance
from hrsafety.reproduce.impact_cases import published_lever_arm
from hrsafety.reproduce.impact_cells import FOAM_TOLERANCE, number
from hrsafety.reproduce.published import printed_figure, printed_rows

__all__ = ["arm", "cylinder"]

TWO_DIGITS = Tolerance(0.01, relative=True)
SAME = Tolerance(0.0, relative=False)  # taken over
INCH = 0.0254


def _printed(name: str) -> float:
    return printed_figure("A.2", name)


def arm() -> Iterator[Cell]:
    """Yield density, mass and inertia of the arm of the direct-drive manipulator."""
    length, width, wall = 0.664, 0.0508, 0.003
    outer, inner = length * width**2, (length - wall) * (width - wall) ** 2
    yield number(
        "Section A.2",
        "Tube",
        "density",
        printed=_printed("density"),
        measured=_printed("tube_mass") / (outer - inner),
        tolerance=TWO_DIGITS,
        unit="kg/m^3",
        reason="The printed formula with its own numbers; it takes one wall of 3 mm off each size. The rest uses the "
        "printed density, that of aluminum.",
    )
    tube = impact.identification.tube_inertia(
        density=_printed("density"), length=length, width=width, height=width, wall=INCH / 16.0
    )
    yield number(
        "Section A.2",
        "Tube",
        "inertia about its center",
        printed=_printed("tube_inertia_center"),
        measured=tube.inertia,
        tolerance=FOAM_TOLERANCE,
        unit="kg m^2",
        reason="Needs open ends and walls of 1/16 inch; the printed formula takes one wall off each size instead of "
        "two, with 3 mm.",
    )
    yield number(
        "Section A.2",
        "Tube",
        "mass",
        printed=_printed("tube_mass"),
        measured=tube.mass,
        tolerance=TWO_DIGITS,
        unit="kg",
        reason="The tube that has the printed density and inertia weighs more than the measured 0.5343 kg.",
    )
    offset = 0.502 - 0.644 / 2.0
    own = _printed("tube_inertia_center") + _printed("tube_mass") * offset**2
    other = _printed("tube_inertia_center") + _printed("tube_mass") * (0.502 - 0.664 / 2.0) ** 2
    disk = 1.497 * (0.0508**2 / 2.0 + 0.113**2)
    yield number(
        "Section A.2",
        "Tube",
        "inertia about the joint",
        printed=_printed("tube_inertia"),
        measured=own,
        tolerance=TWO_DIGITS,
        unit="kg m^2",
        reason=f"With the printed 0.644 m; with the tube's length of 0.664 m it is {other:.4f}.",
    )
    yield number(
        "Section A.2",
        "Disk",
        "inertia about the joint",
        printed=_printed("disk_inertia"),
        measured=disk,
        tolerance=TWO_DIGITS,
        unit="kg m^2",
    )
    yield number(
        "Section A.2",
        "Arm",
        "inertia m_dd",
        printed=_printed("inertia"),
        measured=own + disk,
        tolerance=TWO_DIGITS,
        unit="kg m^2",
        reason=f"With 0.664 m: {other + disk:.4f}, an effective mass of "
        f"{(other + disk) / published_lever_arm(1) ** 2:.2f} kg.",
    )
    yield number(
        "Section A.2",
        "Arm",
        "effective mass",
        printed=_printed("effective_mass"),
        measured=_printed("inertia") / published_lever_arm(1) ** 2,
        tolerance=FOAM_TOLERANCE,
        unit="kg",
        reason="0.059 / 0.078^2 is 9.70; the tables use 9.6.",
    )


def cylinder() -> Iterator[Cell]:
    """Yield the constants of the controller of the cylinder."""
    controller = impact.joints.CylinderController()
    for row in printed_rows("section A.3"):
        yield number(
            "Section A.3",
            "Control of the cylinder, (A.3.1)",
            row["figure"].replace("_", " "),
            printed=row["value"],
            measured=getattr(controller, row["figure"]),
            tolerance=SAME,
            unit=row["unit"],
            reason="A constant of the rig, the default of `CylinderController`; there is nothing to compute.",
        )
