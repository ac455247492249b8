"""Contact: what a result says that may not mean what it seems to, and numbers that would be ignored."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from api import contact_calls
from hrsafety import contact, standards
from hrsafety.errors import InvalidParameterError

PAD = contact.Covering(material=contact.Linear(modulus=2e5), thickness=0.02, area=4e-3)
SOFT: dict[str, Any] = {"robot_mass": 100.0, "region": 1e3}
"""A quarter of its period takes half a second."""


def codes(result: Any) -> set[str]:
    return {each.code for each in result.warnings}


def test_a_chance_without_a_limit_is_refused() -> None:
    given: dict[str, Any] = {"speed": 5.0, "robot_mass": {"lognormal": [8.0, 0.2]}, "region": 75e3, "draws": 1000}
    with pytest.raises(InvalidParameterError, match="a limit to keep"):
        contact_calls.probability(**given)
    with pytest.raises(InvalidParameterError, match="area of the contact"):
        contact_calls.probability(**given, limits={"pressure": 1e6})
    found = contact_calls.probability(**given, limits={"force": 140.0})
    assert found.probability > 0.99
    assert found.not_checked == ("pressure",)
    assert "not_checked" in codes(found)


@pytest.mark.parametrize("name", ["damping", "robot_stiffness", "stop_time", "closing_speed", "rate_base", "radius"])
def test_a_chance_refuses_numbers_that_it_would_ignore(name: str) -> None:
    hit = contact.Contact(robot=8.0, region=25e3, covering=PAD)
    with pytest.raises(InvalidParameterError, match="no effect") as caught:
        hit.probability(0.4, {"force": 140.0}, **{name: 500.0})
    assert caught.value.argument == "uncertain"


def test_a_radius_that_varies_is_both_radii() -> None:
    ball: dict[str, Any] = {"material": contact.Linear(modulus=2e5), "thickness": 0.02, "shape": "sphere"}
    given: dict[str, Any] = {"speed": 0.4, "robot_mass": 8.0, "region": 25e3, "limits": {"force": 140.0}, "draws": 2000}
    covering = contact.Covering(**ball, radius=0.08)
    drawn = contact_calls.probability(**given, covering=covering, radius={"uniform": [0.0199999, 0.0200001]})
    single = contact_calls.allowed_speed(
        robot_mass=8.0, region=25e3, limits={"force": 140.0}, covering=contact.Covering(**ball, radius=0.02)
    )
    assert drawn.quantiles[1] == pytest.approx(single.speed, rel=1e-5)
    rows = contact_calls.allowed_speeds(
        robot_mass=8.0, region=25e3, limits={"force": 140.0}, covering=covering, radius=[0.02, 0.08]
    )
    assert rows.speed[0] == single.speed


@pytest.mark.parametrize(
    ("given", "name"),
    [
        ({"region": 25e3, "thickness": [0.01, 0.02]}, "thickness"),
        ({"region": 25e3, "region_exponent": [1.5, 2.0]}, "region_exponent"),
        ({"covering": PAD, "radius": [0.1, 0.2]}, "radius"),
        ({"covering": PAD, "force_limit": [1.0, 2.0]}, "force_limit"),
    ],
)
def test_batches_refuse_numbers_without_effect(given: dict[str, Any], name: str) -> None:
    with pytest.raises(InvalidParameterError, match="no effect") as caught:
        contact_calls.batch(robot_mass=8.0, closing_speed=0.3, **given)
    assert caught.value.value == name


def test_a_stiffness_by_name_makes_a_spring() -> None:
    found = contact_calls.batch(robot_mass=8.0, closing_speed=0.3, covering=PAD, stiffness=[1e4, 1e5])
    for row, k in enumerate((1e4, 1e5)):
        single = contact_calls.simulate(robot_mass=8.0, closing_speed=0.3, covering=PAD, region=k)
        assert found.peak_force[row] == single.peak_force


@pytest.mark.parametrize("name", ["force_limit", "pressure_limit", "max_strain"])
def test_a_missing_number_in_a_column_is_no_missing_limit(name: str) -> None:
    values = {"force_limit": 140.0, "pressure_limit": 1e6, "max_strain": 0.5}
    for column in ([values[name], math.nan], [math.nan], math.nan):
        found = contact_calls.allowed_speeds(robot_mass=8.0, region=25e3, covering=PAD, **{name: column})
        assert found.status.ravel()[-1] == f"invalid_{name}"
        assert np.isnan(found.speed.ravel()[-1])
        assert "invalid_numbers" in codes(found)


def test_a_law_is_checked_up_to_the_strain_of_each_row() -> None:
    falling = contact.Avalle(plateau=2e4, modulus=3e5, falloff=4.0, densification=0.0, exponent=2.0)
    pad = contact.Covering(material=falling, thickness=0.02, area=4e-3, bottom=(0.1, 1e7))
    found = contact_calls.allowed_speeds(
        robot_mass=8.0, region=25e3, limits={"force": 140.0}, covering=pad, bottoming_strain=[0.1, 0.8]
    )
    assert found.status[0] == "closed_form"
    assert found.status[1].startswith("invalid_")


def test_loads_that_rise_at_the_horizon() -> None:
    hit = contact_calls.simulate(**SOFT, closing_speed=0.5)
    assert (hit.status, hit.rising) == ("horizon", True)
    assert "rising_at_horizon" in codes(hit)
    assert "rising" in repr(hit)
    assert "longer horizon" in repr(hit)
    whole = contact_calls.simulate(**SOFT, closing_speed=0.5, horizon=5.0)
    assert not whole.rising
    assert whole.peak_force > 1.5 * hit.peak_force  # type: ignore[operator]  # both are known
    rows = contact_calls.batch(robot_mass=[100.0, 1.0], region=1e3, closing_speed=0.5)
    assert rows.rising.tolist() == [True, False]
    assert "1 of 2 rows" in repr(rows)
    assert rows.columns()["rising"].tolist() == [True, False]


def test_an_allowed_speed_says_that_its_simulation_ended_early() -> None:
    damped = contact.Covering(material=contact.Linear(modulus=2e3), thickness=0.05, area=1e-2, rate=(0.1, 0.0, 0.1))
    given: dict[str, Any] = {"robot_mass": 300.0, "region": 1e3, "limits": {"force": 140.0}, "covering": damped}
    early = contact_calls.allowed_speed(**given)
    assert "rising_at_horizon" in codes(early)
    late = contact_calls.allowed_speed(**given, horizon=10.0)
    assert "rising_at_horizon" not in codes(late)
    rows = contact_calls.allowed_speeds(**given)
    assert rows.rising.item()
    assert "rising_at_horizon" in codes(rows)


def test_a_covering_outside_its_model() -> None:
    ball: dict[str, Any] = {"material": contact.Linear(modulus=2e4), "thickness": 0.05, "shape": "sphere"}
    pad = contact.Covering(**ball, radius=0.009, half_width=0.01)
    hit = contact_calls.simulate(robot_mass=1.0, closing_speed=0.2, covering=pad, region=25e3)
    assert {"outside_paraboloid", "beyond_pad", "edge"} <= codes(hit)
    assert hit.peak_force is not None
    speed = contact_calls.allowed_speed(robot_mass=1.0, region=25e3, limits={"force": 5.0}, covering=pad)
    assert {"outside_paraboloid", "beyond_pad", "edge"} <= codes(speed)
    rows = contact_calls.batch(
        robot_mass=1.0, closing_speed=[1e-3, 0.2], covering=pad, region=25e3, radius=[[0.009], [1.0]]
    )
    assert rows.outside_paraboloid.tolist() == [[False, True], [False, False]]
    assert rows.edge.tolist() == [[True, True], [False, False]]
    speeds = contact_calls.allowed_speeds(
        robot_mass=1.0, region=25e3, limits={"force": 5.0}, covering=pad, radius=[0.009, 10.0]
    )
    assert speeds.outside_paraboloid.tolist() == [True, False]
    none = contact.Covering(material=contact.Linear(modulus=2e3), thickness=0.005, area=4e-3, bottom=(10.0, 0.0))
    through = contact_calls.simulate(robot_mass=8.0, closing_speed=0.5, covering=none, region=25e3)
    assert "beyond_thickness" in codes(through)


def test_numbers_in_other_units() -> None:
    limits = {"force": 280.0, "pressure": 380.0}
    found = contact_calls.allowed_speed(robot_mass=16.35, body_mass=0.6, region=75.0, limits=limits, area=1.0)
    assert [each.subject for each in found.warnings] == ["stiffness", "area", "pressure_limit"]
    thick = contact.Covering(material=contact.Linear(modulus=0.3), thickness=20.0, area=4e-3)
    hit = contact_calls.simulate(robot_mass=8.0, closing_speed=0.3, covering=thick, region=25e3)
    assert {each.subject for each in hit.warnings} >= {"modulus", "thickness"}
    fine = contact_calls.simulate(robot_mass=8.0, closing_speed=0.3, covering=PAD, region=25e3)
    assert fine.warnings == ()


@pytest.mark.parametrize("speed", [-1.0, float("nan"), float("inf")])
def test_a_person_who_walks_away_raises_no_speed(speed: float) -> None:
    given = {"robot_mass": 8.0, "region": 25e3, "limits": {"force": 140.0}}
    with pytest.raises(InvalidParameterError, match="human_speed must be finite and not negative"):
        contact_calls.allowed_speed(**given, human_speed=speed)
    still, met = (contact_calls.allowed_speed(**given, human_speed=each) for each in (0.0, 0.1))
    assert met.robot_speed == pytest.approx(still.robot_speed - 0.1)


def test_limits_that_are_not_checked() -> None:
    bare = contact_calls.allowed_speed(robot_mass=8.0, region=25e3, limits={"force": 140.0, "pressure": 1e6})
    assert bare.not_checked == ("pressure",)
    assert codes(bare) == {"not_checked", "drive_not_given"}
    thin = contact_calls.thickness(speed=0.05, robot_mass=8.0, region=25e3, limits={"force": 280.0}, covering=PAD)
    assert thin.not_checked == ("pressure",)
    rows = contact_calls.allowed_speeds(robot_mass=[8.0, 9.0], region=25e3, covering=PAD)
    assert rows.not_checked == ("force", "pressure")
    # Without a limit the strain governs, and nobody says that the covering is linear up to 0.8.
    assert codes(rows) == {"not_checked", "linear_beyond_half", "drive_not_given"}
    with pytest.raises(InvalidParameterError, match="on both sides"):
        contact_calls.sensitivity(robot_mass=8.0, region=25e3, limits={"pressure": 1e6})


def test_more_contacts_than_fit_are_refused_before_memory_is_taken() -> None:
    with pytest.raises(InvalidParameterError, match="at most"):
        contact_calls.batch(robot_mass=np.ones((100_000, 1)), closing_speed=np.full(100_000, 0.3), region=25e3)


def test_sensitivities_with_a_covering() -> None:
    given: dict[str, Any] = {"robot_mass": 8.0, "region": 25e3, "limits": {"force": 280.0}}
    found = contact_calls.sensitivity(**given, covering=PAD)
    assert set(found) >= {"robot_mass", "thickness", "modulus"}
    assert found["robot_mass"] == pytest.approx(-0.5, abs=1e-6)
    # p = 1 is the end of its range: the slope is from one side.
    power = contact.Covering(material=contact.Rusch(a=2e5, p=1.0, b=1e5, q=3.0), thickness=0.02, area=4e-3)
    one_sided = contact_calls.sensitivity(**given, covering=power)
    speeds = [
        contact_calls.allowed_speed(
            **given,
            covering=contact.Covering(material=contact.Rusch(a=2e5, p=p, b=1e5, q=3.0), thickness=0.02, area=4e-3),
        ).speed
        for p in (1.0, 0.999)
    ]
    assert one_sided["p"] == pytest.approx(math.log(speeds[0] / speeds[1]) / -math.log(0.999), rel=1e-2)


# ---- margins along a run ------------------------------------------------------------------------


def limit(**changes: Any) -> SimpleNamespace:
    given: dict[str, Any] = {
        "region": "lower_leg",
        "contact": "transient",
        "permitted": True,
        "force": 260.0,
        "pressure": 420e4,
        "spring_constant": 60e3,
        "body_mass": 75.0,
    }
    return SimpleNamespace(**given | changes)


def margins(places: Any, regions: list[SimpleNamespace], **options: Any) -> contact.ContactMargins:
    """Return the margins of a robot that moves along x with 0.1 m/s towards who stands at the places."""
    time = 0.1 * np.arange(len(places))
    run = SimpleNamespace(
        time=time,
        position=np.column_stack([0.1 * time, 0.0 * time]),
        velocity=np.tile([0.1, 0.0], (len(time), 1)),
        heading=0.0 * time,
        obstacle_position=np.array(places, dtype=float).reshape(len(time), 1, 2),
    )
    given = {"base": contact.HolonomicBase(mass=4.4, inertia=0.1), "covering": None, "area": 1e-3} | options
    return contact.contact_margins(run, regions=regions, robot_radius=0.2, person_radius=0.1, **given)


def test_bare_that_exceeds_the_limits_is_told() -> None:
    stiff = {"law": "rusch", "a": 1e6, "p": 0.1, "b": 1e3, "q": 2.0}
    case: dict[str, Any] = {"robot_mass": 2.0, "body_mass": None, "region": 25e3, "limits": {"force": 20.0}}
    flat = {"material": stiff, "area": 2e-5, "bottom": (0.9, 1e3)}
    bare = contact_calls.allowed_speed(**case)
    slow, fast = (contact_calls.thickness(**case, covering=flat, speed=share * bare.speed) for share in (0.9, 1.05))
    assert (slow.thickness, slow.status, slow.not_checked) == (0.0, "bare_is_enough", ("pressure",))
    assert (fast.thickness, fast.status) == (0.0, "bare_is_enough")
    rigid = contact_calls.thickness(**case | {"region": None}, covering=flat, speed=0.3 * bare.speed)
    told = [[warning.message for warning in each.warnings if warning.code == "bare_exceeds"] for each in (fast, rigid)]
    assert [f"is allowed {most:.4g} m/s" in text for most, [text] in zip((bare.speed, 0.0), told, strict=True)] == [
        True
    ] * 2
    assert "bare_exceeds" not in {warning.code for warning in slow.warnings}
    # The pressure of a bare contact is known with an area only.
    case["limits"] = {"force": 20.0, "pressure": 1e7}
    ball = {"material": stiff, "shape": "sphere", "radius": 0.1, "bottom": (0.9, 1e3)}
    both = [contact_calls.thickness(**case, covering=pad, speed=0.01) for pad in (flat, ball)]
    assert [each.status for each in both] == ["bare_is_enough"] * 2
    assert [each.not_checked for each in both] == [(), ("pressure",)]


STANDING = [(2.0, 0.0)] * 4


def test_a_limit_that_is_not_checked_is_not_kept() -> None:
    assert set(margins(STANDING, [limit()]).verdict.ravel()) == {"within_limits"}
    for regions, options in (
        ([limit(pressure=None)], {}),
        ([limit()], {"area": None}),
        ([limit(), limit(region="thigh_knee", force=None)], {}),
    ):
        found = margins(STANDING, regions, **options)
        assert set(found.verdict.ravel()) == {"not_checked"}
        assert "not_checked" in codes(found)
        assert (found.margin > 0.0).all()
    slow = margins(STANDING, [limit(force=1.0, pressure=None)])
    assert set(slow.verdict.ravel()) == {"exceeds"}


@pytest.mark.parametrize(
    ("covering", "code"),
    [
        ({"radius": 0.003, "shape": "sphere"}, "edge"),
        ({"radius": 0.08, "shape": "sphere", "half_width": 1e-3}, "beyond_pad"),
        ({"radius": 0.012, "shape": "sphere"}, "outside_paraboloid"),
    ],
)
def test_a_covering_outside_its_model_keeps_no_limit(covering: dict[str, Any], code: str) -> None:
    given = {"material": {"law": "linear", "E": 3e5}, "thickness": 0.02} | covering
    found = margins(STANDING, [limit()], covering=given, area=None)
    assert code in codes(found)
    assert set(found.verdict.ravel()) == {"not_checked"}
    leg = limit()
    case = {"region": leg.spring_constant, "body_mass": leg.body_mass, "limits": leg, "covering": given}
    drawn = contact_calls.probability(speed=0.01, robot_mass={"lognormal": [4.4, 0.1]}, draws=200, **case)
    assert (drawn.probability, code in codes(drawn)) == (0.0, True)
    sound = margins(STANDING, [limit()], covering=given | {"radius": 0.08, "half_width": None}, area=None)
    assert set(sound.verdict.ravel()) == {"within_limits"}


def test_who_appears_is_present_at_once() -> None:
    gone = (math.nan, math.nan)
    found = margins([gone, gone, (2.0, 0.0), (1.9, 0.0), (1.8, 0.0), gone], [limit()])
    assert found.verdict.ravel().tolist() == ["absent"] * 2 + ["exceeds"] * 3 + ["absent"]
    assert found.closing_speed.ravel()[2:5] == pytest.approx([1.1] * 3)
    lone = margins([gone, (2.0, 0.0), gone], [limit()])
    assert lone.verdict.ravel().tolist() == ["absent", "not_checked", "absent"]
    assert margins([(2.0, 0.0)], [limit()]).verdict.tolist() == [["not_checked"]]
    on_top = margins([(0.0, 0.0), (0.01, 0.0), (0.5, 0.0)], [limit()])
    assert "absent" not in on_top.verdict


def test_who_stands_still_from_the_touch_on_came_with_the_speed_before_it() -> None:
    # 1 m/s until the touch at the third instant: a speed of 0.5 m/s there would be within limits.
    found = margins([(0.52, 0.0), (0.42, 0.0), (0.32, 0.0), (0.32, 0.0), (0.32, 0.0)], [limit(force=400.0)])
    assert found.touching.ravel().tolist() == [False, False, True, True, True]
    assert found.closing_speed.ravel() == pytest.approx([1.1, 1.1, 1.1, 0.1, 0.1])
    assert found.verdict.ravel().tolist() == ["exceeds"] * 3 + ["within_limits"] * 2


def test_margins_carry_units_and_regions() -> None:
    found = margins(STANDING, [limit(), limit(region="hand", spring_constant=75e3, force=50.0, body_mass=math.inf)])
    assert found.region == "hand"
    assert list(found.columns())[:4] == ["t_s", "obstacle", "closing_speed_m_per_s", "robot_share_m_per_s"]
    with pytest.raises(InvalidParameterError, match="be known"):
        margins(STANDING, [limit(spring_constant=None)])


def test_a_low_robot_meets_no_knee() -> None:
    regions = [limit(), limit(region="thigh_knee", force=50.0)]
    assert margins(STANDING, regions).region == "thigh_knee"
    assert margins(STANDING, regions, cover_height=0.5).region == "thigh_knee"
    assert margins(STANDING, regions, cover_height=0.3).region == "lower_leg"
    with pytest.raises(InvalidParameterError, match="that the robot reaches"):
        margins(STANDING, regions[1:], cover_height=0.3)
    with pytest.raises(InvalidParameterError, match="cover_height"):
        margins(STANDING, regions, cover_height=0.0)


BASE = contact.HolonomicBase(mass=20.0, inertia=0.8)
LEG = standards.limits().contact("lower_leg", "quasi_static")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: contact.contact_speed_limit(20.0, None, (0.2, 0.0), (1.0, 0.0), [LEG]), "base must be a"),
        (
            lambda: contact.contact_speed_limit(BASE, None, (0.2, 0.0), (1.0, 0.0), [3.0]),
            r"regions\[0\] must be a limit",
        ),
        (lambda: contact.contact_speed_limit(BASE, None, (0.2, 0.0), (1.0, 0.0), LEG), "regions must be a sequence"),
        (
            lambda: contact.contact_margins(
                3.0, base=BASE, covering=None, regions=[LEG], robot_radius=0.2, person_radius=0.3
            ),
            "trajectory must be a run",
        ),
        (
            lambda: contact_calls.allowed_speed(robot_mass=8.0, limits={}, covering={}),
            "covering.material must be given",
        ),
        (lambda: contact_calls.allowed_speed(robot_mass=8.0, limits={}, region={"k3": 1e5}), "region.k must be given"),
    ],
)
def test_what_is_missing_or_of_another_kind_is_named(call: Callable[[], object], message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        call()
