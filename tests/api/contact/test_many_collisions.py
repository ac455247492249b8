"""Many contacts at once: each has the bits that it has alone, on any threads; why some have no end."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from api import contact_calls
from hrsafety import contact
from hrsafety.errors import InvalidParameterError

LOADS = ("release_time", "peak_force", "peak_force_time", "peak_covering_compression", "peak_pressure", "rebound_speed")
LAWS: dict[str, Any] = {
    "powers": contact.Rusch(a=15e3, p=0.43, b=2e5, q=4.3),
    "half powers": contact.Rusch(a=15e3, p=0.5, b=2e5, q=5.0),
    "linear": contact.Linear(modulus=2e5),
    "plateau": contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9),
    "table": contact.StressTable(strain=[0.0, 0.1, 0.6, 0.97], stress=[0.0, 15e3, 2e4, 1e6]),
}
SHAPES: dict[str, dict[str, Any]] = {
    "flat": {"area": 4e-3},
    "sphere": {"shape": "sphere", "radius": 0.08},
    "cylinder": {"shape": "cylinder", "radius": 0.05, "length": 0.1},
}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("region", [None, 25e3, {"k": 2e4, "k3": 1e7}], ids=["rigid", "spring", "cubic"])
def test_a_collision_with_rate_has_the_same_bits_alone(law: str, shape: str, region: Any) -> None:
    pad = contact.Covering(material=LAWS[law], thickness=0.02, rate=(0.05, 0.02, 0.1), **SHAPES[shape])
    draw = np.random.default_rng(7)
    # Neither a whole number of lanes nor one kind of step.
    masses, speeds = draw.uniform(1.0, 30.0, 77), draw.uniform(-0.01, 0.7, 77)
    given: dict[str, Any] = {"body_mass": 40.0, "region": region, "covering": pad, "tolerance": 1e-6, "horizon": 2.0}
    rows = contact_calls.batch(robot_mass=masses, closing_speed=speeds, threads=1, **given)
    others = contact_calls.batch(robot_mass=masses[::-1], closing_speed=speeds[::-1], threads=2, **given)
    assert set(rows.status) <= {"released", "no_impact"}
    for name in LOADS:
        np.testing.assert_array_equal(getattr(rows, name), getattr(others, name)[::-1])
    for row in range(0, 77, 19):
        alone = contact_calls.simulate(robot_mass=masses[row], closing_speed=speeds[row], head=False, **given)
        for name in LOADS:
            value = getattr(alone, name)
            np.testing.assert_array_equal(getattr(rows, name)[row], np.nan if value is None else value)


def test_rows_of_different_laws_beside_bad_ones_are_as_alone() -> None:
    pad = contact.Covering(material=LAWS["powers"], thickness=0.02, rate=(0.05, 0.02, 0.1), area=4e-3)
    exponents = np.array([0.43, 0.5, 0.43, -1.0, 0.7, 1.0, 0.43, 0.5, 0.43, 0.31])
    given: dict[str, Any] = {"robot_mass": 8.0, "body_mass": 40.0, "closing_speed": 0.4, "covering": pad}
    rows = contact_calls.batch(p=exponents, **given)
    assert rows.status.tolist() == ["released"] * 3 + ["invalid_p"] + ["released"] * 6
    for row, exponent in enumerate(exponents):
        alone = contact_calls.batch(p=[exponent], **given)
        np.testing.assert_array_equal(alone.peak_force[0], rows.peak_force[row])


def test_implausible_numbers_of_many_rows_are_counted() -> None:
    pad = contact.Covering(material=LAWS["linear"], thickness=0.02, area=4e-3)
    masses = np.linspace(2.0, 30.0, 50_001)
    given: dict[str, Any] = {"covering": pad, "region": 25e3, "limits": {"force": 280.0, "pressure": 1e6}}
    given["body_mass"] = 40.0
    assert contact_calls.allowed_speeds(robot_mass=masses, **given).warnings == ()
    masses[[7, 40_000]] = 1e9
    masses[9] = np.inf
    [found] = contact_calls.allowed_speeds(robot_mass=masses, **given).warnings
    assert "element 7, 2 of 50001" in found.message


def test_a_covering_that_cannot_bear_the_energy_says_so() -> None:
    law = contact.GibsonAshby(modulus=4e5, plateau=14e3, lock=0.64, exponent=0.6)
    pad = contact.Covering(material=law, thickness=0.03, area=5e-3, damping=20.0)
    hit = contact_calls.simulate(robot_mass=20.0, body_mass=50.0, closing_speed=1.7, covering=pad)
    assert hit.status == "unfinished"
    assert "limited energy up to its lock" in hit.warnings[0].message
    assert "larger tolerance" not in hit.warnings[0].message
    rows = contact_calls.batch(robot_mass=20.0, body_mass=50.0, closing_speed=[0.1, 1.7], covering=pad)
    assert rows.status.tolist() == ["released", "unfinished"]
    assert rows.warnings[0].message.startswith("1 of 2 rows: the solution did not come to its end")


def test_a_damper_that_is_too_fast_beside_a_backing_ends_without_a_panic() -> None:
    law = contact.GibsonAshby(modulus=339878.93, plateau=26314.07, lock=0.89912, exponent=0.61425)
    pad = contact.Covering(material=law, thickness=0.019106661, area=0.0031423644, damping=1.19214554)
    given: dict[str, Any] = {"robot_mass": 29.44593126, "body_mass": 54.86603947, "region": 10069.141}
    hit = contact_calls.simulate(closing_speed=1.0100077, covering=pad, tolerance=1e-3, **given)
    assert hit.status == "unfinished"
    assert "a damper that relaxes within microseconds" in hit.warnings[0].message


def test_why_a_row_has_no_end_is_told_from_its_own_numbers() -> None:
    law = contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9, exponent=1.0)
    pad = contact.Covering(material=law, thickness=0.02, area=4e-3)
    given: dict[str, Any] = {"robot_mass": 20.0, "body_mass": 50.0, "closing_speed": [0.1, 2.7], "covering": pad}
    rows = contact_calls.batch(exponent=[1.0, 0.6], **given)
    assert rows.status.tolist() == ["released", "unfinished"]
    assert "limited energy up to its lock" in rows.warnings[0].message
    assert "damper" not in rows.warnings[0].message


def test_a_flat_covering_has_no_half_width() -> None:
    with pytest.raises(InvalidParameterError, match=r"half_width must be None for shape 'flat'.*area"):
        contact.Covering(material=LAWS["linear"], thickness=0.02, area=4e-3, half_width=0.03)
