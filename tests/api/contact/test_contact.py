"""Contact: what is refused, what the statuses say, margins along a run."""

from __future__ import annotations

import math
import pickle
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from api import contact_calls
from hrsafety import contact, impact, scenarios
from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError, ShapeError

FOAM = {"law": "gibson_ashby", "E": 3e5, "plateau": 15e3, "e_D": 0.9}
PAD: dict[str, Any] = {"material": FOAM, "thickness": 0.02, "shape": "flat", "area": 4e-3}
HIT: dict[str, Any] = {
    "robot_mass": 8.0,
    "body_mass": 40.0,
    "region": {"k": 25e3},
    "closing_speed": 0.5,
    "covering": PAD,
}
SPEED: dict[str, Any] = {
    "robot_mass": 8.0,
    "body_mass": 40.0,
    "region": {"k": 25e3},
    "covering": PAD,
    "limits": {"force": 280.0},
}


def changed(changes: dict[str, Any]) -> dict[str, Any]:
    """Return the collision with some changes; a dotted name changes the covering or its law."""
    given: dict[str, Any] = {**HIT, "covering": {**PAD, "material": dict(FOAM)}}
    for name, value in changes.items():
        *path, last = name.split(".")
        place = given
        for part in path:
            place = place[part]
        place[last] = value
    return given


BAD = [
    ({"robot_mass": 0.0}, "robot", "finite and positive"),
    ({"robot_mass": math.nan}, "robot", "finite and positive"),
    ({"body_mass": -1.0}, "body", "finite and positive"),
    ({"robot_damping": -1.0}, "damping", "not negative"),
    ({"closing_speed": math.inf}, "closing_speed", "finite"),
    ({"horizon": 0.0}, "horizon", "positive"),
    ({"horizon": 1e9}, "horizon", "at most 60"),
    ({"tolerance": 1e-2}, "tolerance", "1e-12 to 1e-3"),
    ({"stop": (0.0, 0.0)}, "stop.deceleration", "positive"),
    ({"stop": 1.0}, "stop", "a time and a deceleration"),
    ({"region": {"k": 0.0}}, "region.k", "positive"),
    ({"region": {"k": 1e4, "K3": 1.0}}, "region", "no keys but"),
    ({"region": {"k": 1e4, "n": 20.0}}, "region.n", "at most 10"),
    ({"covering": None, "region": None}, "covering", "be given, or the region yield"),
    ({"covering.thickness": 0.0}, "covering.thickness", "positive"),
    ({"covering.area": -1.0}, "covering.area", "positive"),
    ({"covering.shape": "round"}, "covering.shape", "one of"),
    ({"covering.shape": "sphere"}, "covering.area", "be None"),
    ({"covering.shape": "sphere", "covering.area": None}, "covering.radius", "be given"),
    ({"covering.colour": 1.0}, "covering", "no keys but"),
    ({"covering.damping": -1.0}, "covering.damping", "not negative"),
    ({"covering.damping": 1e-3}, "covering.damping", "too_small"),
    ({"covering.rate": (1.5, 0.0, 1.0)}, "covering.rate.base", r"within \[0, 1\]"),
    ({"covering.rate": (0.5, 0.6, 1.0)}, "covering.rate.slope", r"within \[0, 1\]"),
    ({"covering.rate": (0.5, 0.0, 0.0)}, "covering.rate.reference", "positive"),
    ({"covering.rate": (0.5, 0.0)}, "covering.rate", "3 numbers"),
    ({"covering.unloading": (0.0, 1.0)}, "covering.unloading.retained", "above 0 and at most 1"),
    ({"covering.unloading": (1.1, 1.0)}, "covering.unloading.retained", "above 0 and at most 1"),
    ({"covering.unloading": (0.5, 0.0)}, "covering.unloading.exponent", "positive"),
    ({"covering.bottom": (1.0, 1e7)}, "covering.bottoming.strain", "below 1"),
    ({"covering.bottom": (0.8, -1.0)}, "covering.bottoming.stiffness", "not negative"),
    ({"covering.material.law": "gibson"}, "material.law", "one of"),
    ({"covering.material.E": 0.0}, "covering.material.modulus", "positive"),
    ({"covering.material.E": 2e4}, "covering.material.plateau", "below the plateau's end"),
    ({"covering.material.e_D": 1.5}, "covering.material.lock", "at most 1"),
    ({"covering.material.D": 1.0}, "covering.material.D", "above 1"),
    ({"covering.material.x": 1.0}, "material", "no keys but"),
    ({"covering.material": {"law": "linear"}}, "material.E", "be given"),
    (
        {"covering.material": {"law": "table", "strain": [0, 0.1, 0.2], "stress": [0, 5, 4]}},
        "covering.material.stress[2]",
        "at least the value before it",
    ),
    (
        {"covering.material": {"law": "avalle", "A": 2e4, "E": 3e5, "m": 4.0, "B": 0.0, "n": 2.0}},
        "covering.material.law",
        "falls nowhere",
    ),
]


@pytest.mark.parametrize(("changes", "name", "rule"), BAD, ids=[f"{next(iter(each[0]))}-{each[2]}" for each in BAD])
def test_bad_numbers_are_refused_by_name(changes: dict[str, Any], name: str, rule: str) -> None:
    with pytest.raises(InvalidParameterError, match=rule) as caught:
        contact_calls.simulate(**changed(changes))
    assert caught.value.argument == name


@pytest.mark.parametrize(
    ("changes", "name"),
    [
        ({"limits": {"force": 0.0}}, "limits.force"),
        ({"limits": {"pressure": math.inf}}, "limits.pressure"),
        ({"limits": {"fource": 1.0}}, "limits"),
        ({"limits": SimpleNamespace(permitted=False, force=1.0, pressure=None)}, "limits"),
        ({"max_strain": 0.95}, "max_strain"),
        ({"area": 1e-4}, "area"),
        ({"covering": {**PAD, "bottom": (10.0, 0.0)}}, "max_strain"),
    ],
)
def test_bad_limits_are_refused_by_name(changes: dict[str, Any], name: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        contact_calls.allowed_speed(**{**SPEED, **changes})
    assert caught.value.argument == name


def test_rows_with_bad_numbers_say_which() -> None:
    found = contact_calls.batch(
        **{**HIT, "closing_speed": [0.5, 0.0, math.nan]}, thickness=[[0.02], [-1.0]], plateau=[[15e3], [15e3]]
    )
    assert found.status.tolist() == [
        ["released", "no_impact", "invalid_closing_speed"],
        ["invalid_thickness"] * 3,
    ]
    assert np.isfinite(found.peak_force).tolist() == [[True, False, False], [False] * 3]
    table = contact_calls.allowed_speeds(**SPEED, plateau=[15e3, 0.0])
    assert table.status.tolist() == ["closed_form", "invalid_plateau"]
    with pytest.raises(InvalidParameterError, match="did you mean"):
        contact_calls.batch(**HIT, thicknes=0.02)
    with pytest.raises(ShapeError):
        contact_calls.batch(**{**HIT, "closing_speed": [0.1, 0.2]}, thickness=[0.1, 0.2, 0.3])


def test_statuses() -> None:
    assert contact_calls.simulate(**{**HIT, "closing_speed": -1.0}).status == "no_impact"
    points = {"law": "table", "strain": [0.0, 0.1], "stress": [0.0, 1e3]}
    short = {"material": points, "thickness": 0.01, "area": 1e-3}
    with pytest.raises(InvalidParameterError, match="beyond_data"):
        contact_calls.simulate(**{**HIT, "covering": short})
    rows = contact_calls.batch(**{**HIT, "closing_speed": [1e-4, 0.5], "covering": short})
    assert rows.status.tolist() == ["horizon", "beyond_data"]
    assert np.isnan(rows.peak_force[1])
    assert "beyond_data" in {each.code for each in rows.warnings}
    heavy = contact_calls.allowed_speed(**{**SPEED, "robot_mass": math.inf, "body_mass": None})
    assert (heavy.speed, heavy.status) == (0.0, "unbounded_mass")
    bare = contact_calls.allowed_speed(robot_mass=8.0, region=25e3, limits={"pressure": 1e6})
    assert (bare.speed, bare.status, bare.governs) == (None, "not_checked", "nothing")
    assert bare.not_checked == ("force", "pressure")
    walking = contact_calls.allowed_speed(**SPEED, human_speed=100.0)
    assert walking.robot_speed == 0.0
    deep = contact.Covering(material=FOAM, thickness=0.05, shape="sphere", radius=0.009, half_width=0.01)
    assert deep.column(0.006).status == ("outside_paraboloid", "beyond_pad", "edge")
    with pytest.raises(InvalidParameterError, match="where the law ends"):
        deep.column(0.046)
    thin = contact_calls.thickness(**SPEED, speed=0.05)
    assert (thin.thickness, thin.status) == (0.0, "bare_is_enough")
    never = contact_calls.thickness(**SPEED, speed=1e3)
    assert (never.thickness, never.status) == (None, "none_up_to_1_m")


def test_supports_and_stops_are_solved_by_simulation() -> None:
    held = contact_calls.allowed_speed(**SPEED, robot_stiffness=2e4, robot_damping=200.0, stop=(0.01, 10.0))
    assert held.status == "monotone"
    assert held.speed is not None
    hit = contact_calls.simulate(
        **{**HIT, "closing_speed": held.speed}, robot_stiffness=2e4, robot_damping=200.0, stop=(0.01, 10.0)
    )
    assert held.governs == "strain"
    assert hit.peak_strain == pytest.approx(0.8, rel=1e-6)
    assert hit.peak_force is not None
    assert hit.peak_force < 280.0


def test_sensitivities_of_a_bare_contact_are_known() -> None:
    found = contact_calls.sensitivity(robot_mass=10.0, body_mass=40.0, region=75e3, limits={"force": 280.0})
    assert found == pytest.approx(
        {"force_limit": 1.0, "robot_mass": -0.4, "body_mass": -0.1, "stiffness": -0.5}, rel=1e-8
    )


def test_distributions_are_checked() -> None:
    given: dict[str, Any] = {"speed": 0.3, "region": 25e3, "limits": {"force": 140.0}, "draws": 2000}
    sure = contact_calls.probability(robot_mass=8.0, **given)
    assert sure.probability in (0.0, 1.0)
    for bad, rule in [
        ({"normal": [8.0, 4.0]}, "be positive but for a chance"),
        ({"lognormal": [-1.0, 1.0]}, "positive"),
        ({"uniform": [3.0, 2.0]}, "upper end above"),
        ({"triangular": [1.0, 5.0, 4.0]}, "most likely value"),
        ({"gauss": [1.0, 2.0]}, "be one of"),
        ({"normal": [1.0]}, "be 2 numbers"),
        ({}, "one distribution"),
    ]:
        with pytest.raises(InvalidParameterError, match=rule):
            contact_calls.probability(robot_mass=bad, **given)
    with pytest.raises(InvalidParameterError, match="be among"):
        contact_calls.probability(robot_mass=8.0, weight=3.0, **given)


def test_a_foam_from_tests_is_a_covering() -> None:
    fit = impact.Foam(stiffness=24_250.0, damping=0.0, thickness=0.0254, linear_range=0.02)
    pad = contact.Covering.from_foam(fit, tested_area=5e-3)
    given: dict[str, Any] = {"robot_mass": 4.4, "region": 60e3}
    free = contact_calls.allowed_speed(**given, body_mass=75.0, limits={"force": 260.0}, covering=pad)
    clamped = contact_calls.allowed_speed(**given, limits={"force": 130.0}, covering=pad)
    assert (round(free.speed or 0.0, 4), round(clamped.speed or 0.0, 4)) == (0.9705, 0.4716)
    # Twice the area is twice the stiffness and twice the damper; no strain beyond the tested one is allowed.
    double = contact.Covering.from_foam(impact.FOAM_1, tested_area=5e-3, area=1e-2)
    assert double.column(0.001).force == pytest.approx(2.0 * 24.3)
    assert double.damping == pytest.approx(2.0 * 71.9)
    heavy = contact_calls.allowed_speed(robot_mass=100.0, region=60e3, limits={"force": 1e5}, covering=pad)
    assert heavy.governs == "strain"
    assert heavy.covering_compression == pytest.approx(0.02)
    with pytest.raises(InvalidParameterError, match="moving_mass"):
        contact.Covering.from_foam(object(), tested_area=5e-3)


def test_a_base_whose_wheels_and_motors_weigh_nothing_is_a_lower_bound() -> None:
    leg = SimpleNamespace(region="lower_leg", contact="transient", permitted=True, force=260.0, pressure=1e8)
    leg = SimpleNamespace(**vars(leg), spring_constant=60e3, body_mass=75.0)
    base = contact.DifferentialBase(mass=20.0, inertia=0.8)
    (found,) = contact.contact_speed_limit(base, None, (0.2, 0.1), (0.8, 0.6), [leg], area=1e-3)
    assert [each.code for each in found.warnings] == ["no_motor_inertia"]
    run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
    around: dict[str, Any] = {"covering": None, "area": 1e-3, "robot_radius": 0.2, "person_radius": 0.4}
    doubted = contact.contact_margins(run, base=base, regions=[leg], **around)
    assert "no_motor_inertia" in [each.code for each in doubted.warnings]
    closing = np.nan_to_num(doubted.closing_speed) > 0.0
    assert closing.any()
    assert not (doubted.verdict[closing] == "within_limits").any()
    assert contact.HolonomicBase(mass=20.0, inertia=8e-7).warnings[0].subject == "base.inertia"


def test_materials_and_coverings_are_values() -> None:
    pad = contact.Covering(**PAD)
    assert pickle.loads(pickle.dumps(pad)) == pad
    table = contact.StressTable(strain=[0, 0.5], stress=[0, 1e4])
    assert pickle.loads(pickle.dumps(table)) == table
    assert len({table, contact.StressTable(strain=[0, 0.5], stress=[0, 1e4])}) == 1
    assert contact.Covering(**{**PAD, "material": table}).column(0.01).force == pytest.approx(40.0)


@pytest.mark.parametrize("kind", [contact.HolonomicBase, contact.DifferentialBase])
def test_margins_along_a_run(kind: Any) -> None:
    run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
    regions = [
        SimpleNamespace(
            region="lower_leg",
            contact=contact_class,
            permitted=True,
            force=force,
            pressure=1e8,
            spring_constant=60e3,
            body_mass=mass,
        )
        for contact_class, force, mass in (("transient", 260.0, 75.0), ("quasi_static", 130.0, math.inf))
    ]
    wheels = {"wheel_inertia": 1e-4, "wheel_radius": 0.08, "half_track": 0.2}
    base = kind(mass=4.4, inertia=0.1, **(wheels if kind is contact.DifferentialBase else {}))
    around: dict[str, Any] = {"base": base, "covering": None, "area": 1e-3}
    around |= {"robot_radius": 0.2, "person_radius": 0.4}
    found = contact.contact_margins(run, regions=regions, **around)
    present = np.isfinite(found.closing_speed)
    assert found.contact == "quasi_static"
    closing = present & (found.closing_speed > 0.0)
    # Nothing is said of the drive that presses on.
    assert {each.code for each in found.warnings if each.code != "implausible"} == {"drive_not_given"}
    assert set(found.verdict[closing].tolist()) == {"not_checked", "exceeds"}
    exceeds = found.verdict == "exceeds"
    assert (found.margin[exceeds] < 0.0).all()
    if kind is contact.HolonomicBase:
        limit = 130.0 / math.sqrt(4.4 * 60e3)
        assert (found.margin + found.closing_speed)[present] == pytest.approx(limit)
        driven = contact.contact_margins(
            run, regions=regions, drive=contact.Support(stiffness=1e4, stop=(0.1, 3.0)), **around
        )
        assert (driven.margin[present] < found.margin[present]).all()
        assert set(driven.verdict[closing].tolist()) == {"within_limits", "exceeds"}
        free = contact.contact_margins(run, regions=regions[:1], **around)
        assert set(free.verdict[closing].tolist()) == {"within_limits", "exceeds"}
    regions[0].permitted = False
    refused = contact.contact_margins(run, regions=regions, **around)
    assert closing.any()
    assert (refused.verdict[closing] == "not_permitted").all()
    assert len(found.columns()["margin_m_per_s"]) == found.margin.size


def test_a_foam_from_tests_is_linear_as_far_as_it_was_tested() -> None:
    time, compression = np.arange(0.0, 0.2, 0.001), np.linspace(0.0, 0.004, 9)
    drop = impact.identification.drop_trajectory(time, height=0.01, mass=1.5, stiffness=24e3, damping_ratio=0.1)
    fit = impact.identify_foam(24e3 * compression, compression, time, drop, 1.5)
    assert fit.largest_compression == max(0.004, -drop.min())
    assert fit.foam(4.4).linear_range == fit.largest_compression
    assert fit.foam(4.4, linear_range=0.01).linear_range == 0.01
    assert fit.foam(4.4, thickness=0.003).linear_range == pytest.approx(0.8 * 0.003)
    pad = contact.Covering.from_foam(fit.foam(4.4), tested_area=5e-3)
    assert pad.bottom[0] * pad.thickness == pytest.approx(fit.largest_compression)


def test_errors_are_some_tolerances_at_most_where_the_motion_turns_beside_a_plateau() -> None:
    covering = contact.Covering(
        material=contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9),
        thickness=0.02,
        area=4e-3,
        rate=(0.05, 0.02, 0.1),
    )
    speeds = np.concatenate([np.linspace(0.1799, 0.1806, 60), np.linspace(0.4976, 0.4983, 60)])

    def found(tolerance: float) -> contact.ContactBatch:
        return contact_calls.batch(
            robot_mass=8.0,
            body_mass=40.0,
            closing_speed=speeds,
            region=25e3,
            covering=covering,
            tolerance=tolerance,
        )

    coarse, exact = found(1e-6), found(1e-12)

    def most(name: str) -> float:
        return float(np.abs(getattr(coarse, name) / getattr(exact, name) - 1.0).max()) / 1e-6

    assert most("peak_force") < 1.0
    assert most("peak_covering_compression") < 10.0
    assert most("rebound_speed") < 10.0


@pytest.mark.parametrize("strain", [0.5, 0.89, 0.91, 0.99, 0.9999])
def test_work_near_the_end_of_a_law_is_exact(strain: float) -> None:
    plateau, modulus, dense = 2e4, 3e5, 9e3
    law = {"law": "avalle", "A": plateau, "E": modulus, "m": 0.0, "B": dense, "n": 2.0}
    pad = contact.Covering(material=law, thickness=1.0, area=1.0, bottom=(0.8, 0.0))
    risen = plateau * strain + plateau**2 / modulus * math.expm1(-modulus / plateau * strain)
    densified = strain + 2.0 * math.log1p(-strain) + strain / (1.0 - strain)
    assert pad.column(strain).energy == pytest.approx(risen + dense * densified, rel=1e-10)


def test_a_pressure_beyond_a_table_is_no_limit_where_the_backing_lies_beyond_it() -> None:
    law = {"law": "table", "strain": [0.0, 0.3, 0.6], "stress": [0.0, 1e4, 3e4]}
    for bottom, known in ((0.8, False), (0.5, True)):
        pad = contact.Covering(material=law, thickness=0.02, shape="sphere", radius=0.08, bottom=(bottom, 1e7))
        found = contact_calls.allowed_speed(robot_mass=10.0, region=25e3, limits={"pressure": 1e6}, covering=pad)
        assert (found.speeds["pressure"] is not None) == known
        assert found.governs == ("pressure" if known else "strain")
