"""Contacts that others measured beside what the models say: the tables of docs/validation.md."""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hrsafety import contact, standards
from page_tables import DOCS, head, line, print_or_write

PAGE = DOCS / "validation.md"
CASES = json.loads((DOCS.parent / "tests" / "golden" / "contact_cases.json").read_text(encoding="utf-8"))
MEASURED: dict[str, dict[str, Any]] = {case["id"]: case for case in CASES["validation"]}
PARTS = ("allowed speeds", "measured contacts")
ARM_MASS = 16.35
"""M/2 + m_L of an arm of 28.7 kg with a tool of 2 kg, in kg."""
ROBOT, DUMMY, CHILD = 133.0, 81.5, 15.0
"""Masses of the mobile robot, the adult dummy and the child dummy, in kg."""


def power_covering(exponent: float, force: float, speed: float, mass: float) -> contact.Covering:
    """Return the covering whose peak force is proportional to a power of the speed, through one measurement."""
    law = exponent / (2.0 - exponent)
    depth = 0.5 * mass * speed**2 * (law + 1.0) / force
    strength = force / depth**law
    material: contact.Material = contact.Linear(modulus=strength)
    if law != 1.0:
        material = contact.Rusch(a=0.0, p=1.0, b=strength, q=law)
    return contact.Covering(material=material, thickness=1.0, area=1.0, bottom=(10.0, 0.0))


def deviation(model: float, measured: float) -> str:
    """Return by how much a model is off, in percent."""
    return f"{100.0 * (model / measured - 1.0):+.1f} %"


def speeds() -> Iterator[str]:
    """Yield the rows of bare allowed speeds by region."""
    yield from head("region", "free, m/s", "governs", "clamped, m/s", "governs")
    limits = standards.limits()
    for region in limits.regions:
        cells: list[str] = []
        for kind in ("transient", "quasi_static"):
            limit = limits.contact(region, kind)
            if not limit.permitted:
                cells += ["not permitted", ""]
                continue
            found = contact.Contact(robot=ARM_MASS, body=limit, area=1e-4).allowed_speed()
            cells += [f"{found.speed:.3f}", found.governs]
        yield line(region, *cells)


def measured() -> Iterator[str]:
    """Yield the rows of measured contacts beside the models."""
    yield from head("contact", "quantity", "measured", "model", "deviation")
    yield from legs()
    yield from children()
    hand = MEASURED["clamped_hand"]
    for stated, safe in zip(hand["iso_speed"], hand["measured_safe_speed_at_two_places"], strict=True):
        mass = (140.0 / stated) ** 2 / 75e3
        found = contact.Contact(robot=mass, region=75e3).allowed_speed({"force": 140.0}).speed or math.nan
        what = f"clamped hand, {mass:.1f} kg by M/2 + m_L"
        yield line(what, "safe speed, m/s", f"{safe:.2f}", f"{found:.2f}", deviation(found, safe))


def legs() -> Iterator[str]:
    """Yield the rows of the robot against the legs of an adult dummy."""
    case = MEASURED["mobile_adult_legs"]
    mass = ROBOT * DUMMY / (ROBOT + DUMMY)
    (slow, fast), (low, high) = case["speeds"][:2], case["peak_force_N"][:2]
    exponent = math.log(high / low) / math.log(fast / slow)
    fastest = case["speeds"][2]
    peaks, times = case["peak_force_N"][2:], case["time_of_peak_ms"]
    mean = sum(peaks) / len(peaks)
    for name, power in (("one power law through the two slower ones", exponent), ("a linear covering", 1.0)):
        covering = power_covering(power, low, slow, mass)
        bumped = contact.Contact(robot=ROBOT, body=DUMMY, covering=covering)
        hit = bumped.simulate(fastest, horizon=2.0)
        force = hit.peak_force or math.nan
        what = f"adult legs at {fastest} m/s, {name}"
        yield line(what, "peak force, N", f"{mean:.0f}", f"{force:.0f}", deviation(force, mean))
        if power != 1.0:
            first = bumped.simulate(slow, horizon=2.0)
            instant, seen = 1e3 * (hit.peak_force_time or math.nan), sum(times[2:]) / len(peaks)
            scaled = times[0] * instant / (1e3 * (first.peak_force_time or math.nan))
            yield line(what, "time of the peak, ms", f"{seen:.0f}", f"{instant:.0f}", deviation(instant, seen))
            name = f"time of the peak in proportion to that at {slow} m/s, ms"
            yield line(what, name, f"{seen:.0f}", f"{scaled:.0f}", deviation(scaled, seen))
    for speed, seen in zip(
        *(MEASURED["mobile_adult_legs_iso"][name] for name in ("speeds", "measured_N")), strict=True
    ):
        hit = contact.Contact(robot=ROBOT, body=75.0, region=60e3).simulate(speed)
        force = hit.peak_force or math.nan
        what = f"adult legs at {speed} m/s, spring of the lower leg without the bumper"
        yield line(what, "peak force, N", seen, f"{force:.0f}", deviation(force, seen))


def children() -> Iterator[str]:
    """Yield the rows of the robot against a child dummy: a line through the slowest one."""
    chest, leg = MEASURED["mobile_child_chest"], MEASURED["mobile_child_legs"]
    for what, cases, peaks in (
        ("child chest", chest["speeds_133"], chest["peak_133_N"]),
        ("child chest, robot of 60 kg", chest["speeds_60"], chest["peak_60_N"]),
        ("child legs", leg["speeds"], leg["peak_force_N"]),
    ):
        mass = 60.0 if "60" in what else ROBOT
        stiffness = (peaks[0] / cases[0]) ** 2 * (mass + CHILD) / (mass * CHILD)
        for speed, seen in zip(cases[1:], peaks[1:], strict=True):
            hit = contact.Contact(robot=mass, body=CHILD, region=stiffness).simulate(speed, horizon=2.0)
            force = hit.peak_force or math.nan
            name = f"{what} at {speed} m/s, a line through {cases[0]} m/s"
            yield line(name, "peak force, N", seen, f"{force:.0f}", deviation(force, seen))


def table(part: str) -> str:
    """Return one table as it stands on the page."""
    return "\n" + "\n".join(speeds() if part == PARTS[0] else measured()) + "\n\n"


if __name__ == "__main__":
    print_or_write(PAGE, {part: (f"{part} of {Path(__file__).name}", functools.partial(table, part)) for part in PARTS})
