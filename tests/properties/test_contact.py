"""Invariants of contact, and a plain solution with SciPy as oracle."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from api import contact_calls
from hrsafety import contact, impact

SETTINGS = settings(max_examples=40, deadline=None)
STEEP = contact.Rusch(a=1.5e4, p=0.5, b=2e5, q=5.0)
LAWS = (
    contact.Linear(modulus=2.3e5),
    contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9, exponent=1.5),
    contact.Rusch(a=15e3, p=0.5, b=2e5, q=5.0),
    contact.Avalle(plateau=2e4, modulus=3e5, falloff=0.0, densification=9e3, exponent=2.0),
    contact.StressTable(strain=[0.0, 0.05, 0.3, 0.6, 0.99], stress=[0.0, 6e3, 11e3, 30e3, 400e3]),
)
SHAPES: tuple[dict[str, Any], ...] = (
    {"shape": "flat", "area": 4e-3},
    {"shape": "sphere", "radius": 0.08},
    {"shape": "cylinder", "radius": 0.06, "length": 0.1},
)
law = st.sampled_from(LAWS)
shape = st.sampled_from(SHAPES)
mass = st.floats(1.0, 30.0)
body = st.sampled_from([0.6, 4.4, 40.0, None])
stiffness = st.floats(1e4, 1.5e5)
speed = st.floats(0.05, 0.8)
depth = st.floats(0.01, 0.04)


def reduced(robot: float, other: float | None) -> float:
    return robot if other is None else robot * other / (robot + other)


@SETTINGS
# It turns just behind the kink where the covering bottoms out.
@example(
    contact.Rusch(a=1.5e4, p=0.5, b=2e5, q=5.0), {"shape": "sphere", "radius": 0.08}, 3.25, 4.4, 83666.0, 0.5, 0.01
)
@given(law, shape, mass, body, stiffness, speed, depth)
def test_stored_energy_is_kinetic_energy_and_momentum_is_kept(
    material: contact.Material,
    shape: dict[str, Any],
    robot: float,
    other: float | None,
    k: float,
    v: float,
    thickness: float,
) -> None:
    pad = contact.Covering(material=material, thickness=thickness, **shape)
    hit = contact_calls.simulate(
        robot_mass=robot,
        body_mass=other,
        region=k,
        covering=pad,
        closing_speed=v,
        horizon=5.0,
        tolerance=1e-10,
        head=False,
    )
    if hit.status == "beyond_data":
        return
    assert hit.peak_covering_compression is not None
    assert hit.peak_force is not None
    stored = pad.column(hit.peak_covering_compression).energy + 0.5 * hit.peak_force**2 / k
    assert stored == pytest.approx(0.5 * reduced(robot, other) * v**2, rel=1e-8)
    if hit.status == "released":
        assert hit.rebound_speed == pytest.approx(v, rel=1e-7)
        if other is not None:
            assert hit.body_speed_end == pytest.approx(reduced(robot, other) / other * 2.0 * v, rel=1e-7)


@SETTINGS
@given(mass, st.sampled_from([4.4, 40.0]), st.floats(0.05, 1.0), st.floats(0.05, 0.3), st.sampled_from(LAWS[:4]))
def test_restitution_of_a_flat_covering(
    robot: float, other: float, retained: float, v: float, material: contact.Material
) -> None:
    pad = contact.Covering(material=material, thickness=0.05, area=0.02, unloading=(retained, 1.0), bottom=(10.0, 0.0))
    hit = contact_calls.simulate(
        robot_mass=robot, body_mass=other, covering=pad, closing_speed=v, horizon=5.0, tolerance=1e-10, head=False
    )
    assert hit.status == "released"
    assert hit.rebound_speed == pytest.approx(v * math.sqrt((1.0 + retained) / 2.0), rel=1e-6)


@SETTINGS
@given(law, shape, mass, body, stiffness, depth, st.sampled_from([(0.0, 0.0, 1.0), (0.05, 0.02, 0.1)]))
def test_peak_force_does_not_fall_with_the_speed(
    material: contact.Material,
    shape: dict[str, Any],
    robot: float,
    other: float | None,
    k: float,
    thickness: float,
    rate: tuple[float, float, float],
) -> None:
    pad = contact.Covering(material=material, thickness=thickness, rate=rate, **shape)
    found = contact_calls.batch(
        robot_mass=robot,
        body_mass=math.inf if other is None else other,
        region=k,
        covering=pad,
        closing_speed=np.linspace(0.05, 1.5, 30),
        tolerance=1e-8,
        horizon=5.0,
    )
    peaks = found.peak_force[np.isfinite(found.peak_force)]
    assert len(peaks) > 1
    assert (np.diff(peaks) >= -1e-6 * peaks[1:]).all()


@SETTINGS
@given(law, mass, body, stiffness, st.floats(50.0, 400.0))
def test_a_thicker_flat_covering_is_never_slower(
    material: contact.Material, robot: float, other: float | None, k: float, force: float
) -> None:
    pad = contact.Covering(material=material, thickness=0.02, area=4e-3)
    found = contact_calls.allowed_speeds(
        robot_mass=robot,
        body_mass=math.inf if other is None else other,
        region=k,
        limits={"force": force},
        covering=pad,
        thickness=np.geomspace(1e-3, 0.2, 50),
    )
    assert (np.diff(found.speed) >= -1e-12 * found.speed[1:]).all()


@SETTINGS
@given(law, shape, mass, body, stiffness, st.floats(50.0, 400.0), st.floats(0.2, 1.5))
def test_least_thickness_and_allowed_speed_undo_each_other(
    material: contact.Material,
    shape: dict[str, Any],
    robot: float,
    other: float | None,
    k: float,
    force: float,
    wanted: float,
) -> None:
    limits = {"force": force}
    pad: dict[str, Any] = {"material": material, **shape}
    found = contact_calls.thickness(
        speed=wanted, robot_mass=robot, body_mass=other, region=k, limits=limits, covering=pad
    )
    if found.status != "found":
        return
    pad["thickness"] = found.thickness
    back = contact_calls.allowed_speed(robot_mass=robot, body_mass=other, region=k, limits=limits, covering=pad)
    assert back.speed == pytest.approx(wanted, rel=1e-9)


@SETTINGS
@given(shape, st.floats(0.001, 0.7), st.floats(0.005, 0.04))
def test_linear_columns_have_closed_forms(shape: dict[str, Any], strain: float, thickness: float) -> None:
    modulus, d = 2.3e5, strain * thickness
    found = contact.Covering(material=LAWS[0], thickness=thickness, **shape).column(d)
    expected = {
        "flat": lambda: modulus * shape["area"] * strain,
        "sphere": lambda: math.pi * shape["radius"] * modulus * d**2 / thickness,
        "cylinder": lambda: 4 / 3 * shape["length"] * math.sqrt(2 * shape["radius"]) * modulus / thickness * d**1.5,
    }[shape["shape"]]()
    assert found.force == pytest.approx(expected, rel=1e-13)


def plain_solution(  # the equations as they are written, solved for d at every evaluation
    case: dict[str, Any], pad: contact.Covering, rate: tuple[float, float, float]
) -> tuple[float, float]:
    robot, other, k, v = (case[name] for name in ("robot_mass", "body_mass", "region", "closing_speed"))
    base, slope, reference = rate

    def factor(compression: float, closing: float) -> float:
        if closing <= 0.0:
            return 1.0
        return float((1.0 + closing / (pad.thickness * reference)) ** (base + slope * compression / pad.thickness))

    def force(total: float, closing: float) -> float:
        if total <= 0.0:
            return 0.0

        def excess(d: float) -> float:
            return pad.column(d).force * factor(d, closing) - k * (total - d)

        return k * (total - float(brentq(excess, 0.0, min(total, 0.8999 * pad.thickness), xtol=1e-16, rtol=1e-14)))

    def motion(_: float, y: Any) -> list[float]:
        f = force(y[0] - y[2], y[1] - y[3])
        return [y[1], -f / robot, y[3], f / other]

    def parted(_: float, y: Any) -> float:
        return float(y[0] - y[2]) if _ > 1e-4 else 1.0

    parted.terminal, parted.direction = True, -1  # type: ignore[attr-defined]  # as solve_ivp asks for
    found = solve_ivp(motion, (0.0, 0.5), [0.0, v, 0.0, 0.0], rtol=1e-9, atol=1e-12, events=parted, max_step=2e-3)
    forces = [force(y[0] - y[2], y[1] - y[3]) for y in found.y.T]
    place = int(np.argmax(forces))
    # A parabola through the largest samples.
    t, f = found.t[place - 1 : place + 2], np.array(forces[place - 1 : place + 2])
    a, b, c = np.polyfit(t - t[1], f, 2)
    return float(c - b * b / (4 * a)), float(found.y[3, -1] - found.y[1, -1])


@pytest.mark.parametrize("rate", [(0.0, 0.0, 1.0), (0.06, 0.03, 0.2)])
@pytest.mark.parametrize("seed", range(3))
def test_scipy_finds_the_same(seed: int, rate: tuple[float, float, float]) -> None:
    draw = np.random.default_rng(seed)
    law = LAWS[seed % 3]
    pad = contact.Covering(material=law, thickness=draw.uniform(0.015, 0.03), area=draw.uniform(2e-3, 6e-3), rate=rate)
    case = {
        "robot_mass": draw.uniform(2.0, 10.0),
        "body_mass": draw.uniform(2.0, 40.0),
        "region": draw.uniform(2e4, 8e4),
        "closing_speed": draw.uniform(0.3, 0.5),
    }
    hit = contact_calls.simulate(**case, covering=pad, tolerance=1e-10, horizon=0.5)
    peak, rebound = plain_solution(case, pad, rate)
    assert hit.peak_force == pytest.approx(peak, rel=1e-3)
    assert hit.rebound_speed == pytest.approx(rebound, rel=1e-6)


def test_the_linear_limit_is_the_exact_linear_solution() -> None:
    for manipulator, foam, head in [
        (impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum()),
        (impact.MANIPULATOR_1, impact.FOAM_3, impact.Head.maximum()),
        (impact.MANIPULATOR_2, impact.FOAM_1, impact.Head.apparatus()),
    ]:
        exact = impact.metrics(manipulator, foam, head, closing_speed=1.0)
        hit = contact_calls.simulate(
            robot_mass=manipulator.mass,
            robot_damping=manipulator.damping,
            robot_stiffness=manipulator.stiffness,
            body_mass=head.mass,
            body_damping=head.damping,
            body_stiffness=head.stiffness,
            covering={
                "material": contact.Linear(modulus=foam.stiffness * foam.thickness / 0.01),
                "thickness": foam.thickness,
                "area": 0.01,
                "damping": foam.damping,
                "bottom": (10.0, 0.0),
            },
            closing_speed=1.0,
            horizon=exact.impact_duration,
            tolerance=1e-12,
        )
        assert hit.peak_force == pytest.approx(exact.peak_contact_force, rel=1e-9)
        assert hit.peak_total_compression == pytest.approx(exact.max_compression, rel=1e-9)


def test_threads_and_rows_change_no_bit() -> None:
    pad = contact.Covering(material=LAWS[2], thickness=0.02, area=4e-3, rate=(0.05, 0.0, 0.1))
    speeds = np.linspace(0.1, 1.0, 700)
    found = [
        contact_calls.batch(
            robot_mass=8.0, body_mass=40.0, region=25e3, covering=pad, closing_speed=speeds, threads=threads
        ).peak_force
        for threads in (1, 2)
    ]
    assert np.array_equal(*found)
    single = contact_calls.simulate(
        robot_mass=8.0, body_mass=40.0, region=25e3, covering=pad, closing_speed=speeds[333]
    )
    assert single.peak_force == found[0][333]
    drawn = [
        contact_calls.probability(
            speed=0.4,
            robot_mass={"lognormal": [8.0, 0.2]},
            region=25e3,
            limits={"force": 140.0},
            draws=10_000,
            threads=threads,
        )
        for threads in (1, 2)
    ]
    assert drawn[0] == drawn[1]
