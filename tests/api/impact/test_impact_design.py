"""A foam design, its boundaries and its margins say the same as the loads themselves."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest

from hrsafety import impact

SPEED = 1.25
LIGHT, HEAVY = impact.Head.minimum(), impact.Head.maximum()
ALL_LIMITS = impact.FoamLimits(peak_contact_force=350.0, hic15=3.0, hic36=5.0)

# A boundary is closed in to neighbouring numbers; loads are good to 1e-11 of their size.
ROOT = 1e-9
# Golden-section search of a maximum finds its place to the square root of the rounding of its value.
PLACE = 1e-6


def design(**limits: float | None) -> impact.FoamDesign:
    return impact.design_foam(impact.MANIPULATOR_1, impact.FoamLimits(**limits), closing_speed=SPEED)


def loads(foam: impact.Foam, speed: float = SPEED) -> dict[str, float]:
    light = impact.metrics(impact.MANIPULATOR_1, foam, LIGHT, closing_speed=speed)
    heavy = impact.metrics(impact.MANIPULATOR_1, foam, HEAVY, closing_speed=speed)
    return {
        "peak_head_acceleration_g": light.peak_head_acceleration_g,
        "peak_contact_force": heavy.peak_contact_force,
        "hic15": light.hic15,
        "hic36": light.hic36,
        "max_compression": heavy.max_compression,
    }


@pytest.mark.parametrize("foam", [impact.FOAM_1, impact.FOAM_2, impact.FOAM_3])
def test_margin_is_the_share_that_the_loads_leave(foam: impact.Foam) -> None:
    whole = impact.design_foam(impact.MANIPULATOR_1, ALL_LIMITS, closing_speed=SPEED)
    margin = whole.margin(foam)
    expected = {name: 1.0 - value / ALL_LIMITS.given()[name] for name, value in loads(foam).items()}
    for name, value in expected.items():
        assert getattr(margin, name) == pytest.approx(value, abs=ROOT), name
    assert margin.least == min(margin[:-1])
    assert whole.accepts(foam) == (margin.least >= 0.0)


def test_margin_without_a_limit_is_not_a_number() -> None:
    margin = design(max_compression=None).margin(impact.FOAM_1)
    assert math.isnan(margin.max_compression)
    assert math.isnan(margin.hic15)
    assert margin.least == margin.peak_head_acceleration_g


@pytest.mark.parametrize(
    ("name", "limit"),
    [("peak_head_acceleration_g", 8.0), ("peak_contact_force", 400.0), ("hic15", 2.0), ("hic36", 3.0)],
)
def test_upper_boundary_meets_the_limit_that_it_names(name: str, limit: float) -> None:
    only = {each: None for each in ("peak_head_acceleration_g", "max_compression")} | {name: limit}
    found = design(**only).upper([[0.0, 71.9], [100.0, 150.0]])
    assert found.stiffness.shape == found.status.shape == found.holds_below.shape == (2, 2)
    assert set(found.limited_by.ravel().tolist()) == {name}
    assert len(found.crossings) == 4
    for damping, stiffness in zip(found.damping.flat, found.stiffness.flat, strict=True):
        foam = impact.Foam(stiffness=float(stiffness), damping=float(damping))
        assert loads(foam)[name] == pytest.approx(limit, rel=ROOT)


def test_combined_boundary_is_the_least_of_its_parts() -> None:
    damping = np.linspace(0.0, 200.0, 5)
    limits = {"peak_head_acceleration_g": 9.0, "peak_contact_force": 450.0, "hic15": 2.5}
    whole = design(**limits).upper(damping)
    none = dict.fromkeys((*limits, "max_compression"), None)
    parts = [design(**{**none, name: limit}).upper(damping).stiffness for name, limit in limits.items()]
    assert whole.stiffness == pytest.approx(np.min(parts, axis=0), rel=ROOT)
    names = np.array(list(limits))[np.argmin(parts, axis=0)]
    assert whole.limited_by.tolist() == names.tolist()


def test_boundaries_of_a_design_are_those_of_the_functions() -> None:
    damping = [0.0, 71.9]
    upper = impact.foam_stiffness_upper(impact.MANIPULATOR_1, damping=damping, closing_speed=SPEED)
    lower = impact.foam_stiffness_lower(impact.MANIPULATOR_1, damping=damping, closing_speed=SPEED)
    assert design().upper(damping).stiffness.tolist() == upper.stiffness.tolist()
    assert design().lower(damping).stiffness.tolist() == lower.stiffness.tolist()


def test_a_single_damping_gives_arrays_without_axes() -> None:
    found = design().upper(71.9)
    assert found.stiffness.shape == found.status.shape == ()
    assert len(found.crossings) == len(found.crossing_status) == 1


def test_absent_boundary_says_on_which_side_the_limits_hold() -> None:
    found = design().upper([71.9, 400.0])
    assert found.status.tolist() == ["local_maximum", "none"]
    assert found.holds_below.tolist() == [True, False]
    assert not found.holds_above.any()
    assert math.isnan(found.stiffness[1])
    assert found.limited_by[1] == ""
    assert found.crossings[1].size == 0


def test_constrained_head_is_designed_for_force_and_compression() -> None:
    limits = impact.FoamLimits(peak_head_acceleration_g=None, peak_contact_force=250.0)
    wall = impact.ConstrainedHead()
    held = impact.design_foam(impact.MANIPULATOR_1, limits, closing_speed=0.25, force_head=wall)
    for boundary, name, limit in (
        (held.upper(71.9), "peak_contact_force", 250.0),
        (held.lower(71.9), "max_compression", 0.02),
    ):
        if boundary.status != "none":
            foam = impact.Foam(stiffness=float(boundary.stiffness), damping=71.9)
            found = impact.metrics(impact.MANIPULATOR_1, foam, wall, closing_speed=0.25)
            assert getattr(found, name) == pytest.approx(limit, rel=ROOT)
    assert held.upper(71.9).status != "none"


def test_largest_closing_speed_is_where_the_boundaries_meet() -> None:
    speed = design().max_closing_speed(71.9)
    for factor, exists in ((1.0 - PLACE, True), (1.0 + PLACE, False)):
        there = impact.design_foam(impact.MANIPULATOR_1, impact.FoamLimits(), closing_speed=factor * speed)
        assert (float(there.upper(71.9).stiffness) >= float(there.lower(71.9).stiffness)) is exists


def test_largest_closing_speed_does_not_depend_on_that_of_the_design() -> None:
    other = impact.design_foam(impact.MANIPULATOR_1, ALL_LIMITS, closing_speed=0.4)
    same = impact.design_foam(impact.MANIPULATOR_1, ALL_LIMITS, closing_speed=2.0)
    assert other.max_closing_speed(50.0) == pytest.approx(same.max_closing_speed(50.0), rel=ROOT)


@pytest.mark.parametrize(("speed", "feasible"), [(1.25, True), (3.0, False)])
def test_feasibility_says_how_much_slower_the_impact_must_be(speed: float, feasible: bool) -> None:
    asked = impact.design_foam(impact.MANIPULATOR_1, impact.FoamLimits(), closing_speed=speed)
    found = asked.feasibility(np.linspace(0.0, 300.0, 7), margin=0.0)
    assert found.feasible is feasible
    assert found.slow_down == pytest.approx(max(0.0, speed - found.max_closing_speed))
    foam = impact.Foam(stiffness=found.stiffness, damping=found.damping)
    slower = impact.design_foam(
        impact.MANIPULATOR_1, impact.FoamLimits(), closing_speed=found.max_closing_speed * (1.0 - PLACE)
    )
    assert slower.accepts(foam)
    assert not impact.design_foam(
        impact.MANIPULATOR_1, impact.FoamLimits(), closing_speed=found.max_closing_speed * (1.0 + PLACE)
    ).accepts(foam)


def test_design_can_be_sent_to_another_process() -> None:
    again = pickle.loads(pickle.dumps(design()))
    assert again == design()
    assert again.margin(impact.FOAM_1) == design().margin(impact.FOAM_1)


def test_gradients_stand_beside_the_loads_they_belong_to() -> None:
    parts = (impact.MANIPULATOR_1, impact.FOAM_1, LIGHT)
    found = impact.gradients(*parts, closing_speed=SPEED, manipulator_speed=0.5)
    plain = impact.metrics(*parts, closing_speed=SPEED, manipulator_speed=0.5)
    assert found.metrics.status == plain.status
    assert found.metric_names == impact.ImpactMetrics._fields[: len(found.metric_names)]
    assert found.values.shape == (len(found.metric_names), len(found.parameter_names))
    step = 1e-4
    for name in ("foam_stiffness", "foam_damping"):
        value = getattr(impact.FOAM_1, name.removeprefix("foam_"))
        sides = impact.metrics_batch(
            manipulator=impact.MANIPULATOR_1,
            foam=impact.FOAM_1,
            head=LIGHT,
            closing_speed=SPEED,
            manipulator_speed=0.5,
            **{name: value * np.array([1.0 - step, 1.0 + step])},
        )
        for metric in found.metric_names:
            difference = np.diff(getattr(sides, metric))[0] / (2.0 * step * value)
            # Central differences of this step are good to about 1e-6.
            assert found.of(metric)[name] == pytest.approx(difference, rel=1e-4, abs=1e-9), (metric, name)
