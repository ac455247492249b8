"""Drives that press a clamped part: bounds, what never makes a speed larger, sources of a push, wrong input."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import arms, contact, standards
from hrsafety.errors import InvalidParameterError

FOAM = contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9)
PAD = contact.Covering(material=FOAM, thickness=0.02, area=4e-3)
LIMIT = {"force": 140.0}
BRAKES = {"reaction_time": 0.02, "deceleration": 8.0}
numbers = {
    "mass": st.floats(1.0, 40.0),
    "speed": st.floats(0.02, 0.5),
    "region": st.floats(1e4, 1.5e5),
    "reaction": st.floats(0.0, 0.1),
    "brakes": st.floats(0.5, 20.0),
    "relative": st.floats(-2.0, 2.0),
}


@settings(max_examples=60, deadline=None)
@given(**numbers, detection=st.sampled_from([0.0, 20.0, 60.0]))
def test_no_spring_presses_harder_than_its_bound(
    mass: float, speed: float, region: float, reaction: float, brakes: float, relative: float, detection: float
) -> None:
    stiffness = region * 10.0**relative
    stop = {"reaction_time": reaction, "deceleration": brakes, "detection_force": detection}
    hit = contact.Contact(robot=mass, region=region)
    drive = contact.Drive(model="elastic", stiffness=stiffness, **stop)
    found = contact.driven_loads(hit, speed, drive)
    if found.status != "ok":
        return
    b, way = stiffness / (region + stiffness), drive.path(speed)
    kinetic = speed * math.sqrt(region * mass * (1.0 - b))
    bound = region * b * way + kinetic if detection == 0.0 else detection + region * b * way + kinetic * (2.0 - b)
    assert found.force <= bound * (1.0 + 1e-6)
    every = contact.driven_loads(hit, speed, contact.Drive(**stop))
    assert found.force <= every.force * (1.02 if detection else 1.0 + 1e-6)


@settings(max_examples=20, deadline=None)
@given(**numbers, detection=st.sampled_from([0.0, 30.0]))
def test_exact_pieces_are_the_equation_of_motion(
    mass: float, speed: float, region: float, reaction: float, brakes: float, relative: float, detection: float
) -> None:
    hit = contact.Contact(robot=mass, region=region)
    drive: dict[str, Any] = {
        **{"model": "elastic", "stiffness": region * 10.0**relative, "detection_force": detection},
        **{"reaction_time": reaction, "deceleration": brakes},
    }
    exact = contact.driven_loads(hit, speed, contact.Drive(**drive))
    # A push limit that is never reached asks for the simulation.
    moved = contact.driven_loads(hit, speed, contact.Drive(**drive, push_limit=1e9))
    if exact.status == moved.status == "ok":
        assert moved.force == pytest.approx(exact.force, rel=1e-6)


def test_a_contact_that_is_lost_comes_back() -> None:
    # A soft drive that goes on far: the second touch presses harder than the first one.
    hit = contact.Contact(robot=10.0, region=75e3)
    drive = contact.Drive(model="elastic", stiffness=5e3, reaction_time=0.5, deceleration=1.0)
    found = contact.driven_loads(hit, 0.3, drive)
    first = hit.simulate(0.3).peak_force or 0.0
    assert found.force > 1.5 * first
    assert found.force > 5e3 * 75e3 / 80e3 * drive.path(0.3)


@settings(max_examples=12, deadline=None)
@given(
    model=st.sampled_from(["any_stiffness", "rigid", "push_limit"]),
    mass=st.floats(2.0, 30.0),
    covered=st.booleans(),
    change=st.sampled_from(["reaction_time", "deceleration", "detection_force", "mass"]),
    factor=st.floats(1.05, 3.0),
)
def test_slower_drives_and_heavier_robots_never_allow_more(
    model: str, mass: float, covered: bool, change: str, factor: float
) -> None:
    brakes = {"reaction_time": 0.02, "deceleration": 8.0, "detection_force": 20.0}
    worse = dict(brakes)
    if change in brakes:
        worse[change] = brakes[change] * (1.0 / factor if change == "deceleration" else factor)
    heavier = mass * factor if change == "mass" else mass
    more: dict[str, Any] = {"push_limit": 50.0} if model == "push_limit" else {}
    if model == "push_limit":
        brakes = worse = {}

    def allowed(of: float, stop: dict[str, float]) -> float:
        hit = contact.Contact(robot=of, region=75e3, covering=PAD if covered else None)
        found = contact.driven_speed(hit, contact.Drive(model=model, **stop, **more), LIMIT)
        return math.inf if found.speed is None else found.speed

    assert allowed(heavier, worse) <= allowed(mass, brakes) * (1.0 + 1e-4)


def test_allowed_speeds_keep_their_limits() -> None:
    for pad in (None, PAD):
        hit = contact.Contact(robot=12.0, region=75e3, covering=pad)
        for drive in (
            contact.Drive(**BRAKES),
            contact.Drive(**BRAKES, detection_force=30.0),
            contact.Drive(model="rigid", **BRAKES, detection_force=30.0),
            contact.Drive(model="push_limit", push_limit=50.0),
            contact.Drive(model="elastic", stiffness=1e5, damping=50.0, **BRAKES),
            contact.Drive(model="elastic", stiffness=1e5, push_limit=40.0, **BRAKES),
        ):
            found = contact.driven_speed(hit, drive, LIMIT)
            assert found.speed is not None
            assert contact.driven_loads(hit, found.speed, drive).force <= 140.0 * (1.0 + 1e-6)
            assert contact.driven_loads(hit, 1.02 * found.speed, drive).force > 140.0


@pytest.mark.parametrize(("model", "stiffness"), [("any_stiffness", None), ("elastic", 1000.0)])
@pytest.mark.parametrize("covered", [False, True])
def test_no_slower_speed_exceeds_a_limit_where_a_force_has_to_be_noticed(
    model: str, stiffness: float | None, covered: bool
) -> None:
    # A gentle touch is noticed late, and presses harder than a faster one that is noticed at once.
    material = contact.GibsonAshby(modulus=6e5, plateau=41e3, lock=0.9)
    pad = contact.Covering(material=material, thickness=0.022, shape="flat", area=9.6e-4)
    hit = contact.Contact(robot=41.2, region=25e3, covering=pad if covered else None)
    drive = contact.Drive(
        model=model, stiffness=stiffness, reaction_time=0.025, deceleration=21.0, detection_force=40.0
    )
    found = contact.driven_speed(hit, drive, LIMIT).speed
    assert found is not None
    assert found > 0.0
    for slower in found * np.geomspace(0.4, 1.0, 12):
        assert contact.driven_loads(hit, float(slower), drive).force <= 140.0 * (1.0 + 1e-4)
    if model == "any_stiffness" and covered:
        faster = [contact.driven_loads(hit, found * factor, drive).force for factor in (1.6, 2.4)]
        assert faster[0] > 140.0 > faster[1]


def test_a_push_limit_is_never_exceeded_at_rest() -> None:
    hit = contact.Contact(robot=12.0, region=75e3)
    strong = contact.Drive(model="elastic", stiffness=1e6, damping=3e3, reaction_time=0.2, deceleration=1.0)
    weak = contact.Drive(
        model="elastic", stiffness=1e6, damping=3e3, push_limit=40.0, reaction_time=0.2, deceleration=1.0
    )
    pushed = contact.Drive(model="push_limit", push_limit=40.0)
    assert contact.driven_loads(hit, 0.1, strong).force > 1000.0
    assert contact.driven_loads(hit, 0.1, weak).force <= contact.driven_loads(hit, 0.1, pushed).force * (1 + 1e-6)


def test_statuses() -> None:
    hit = contact.Contact(robot=12.0, region=75e3)
    stops = standards.StoppingData(speed=[0.0, 0.1, 0.2], time=[0.0, 0.01, 0.02], distance=[0.0, 1e-5, 2e-5])
    for drive, status, speed in (
        (contact.Drive(**BRAKES, detection_force=150.0), "threshold_above_limit", 0.0),
        (contact.Drive(model="push_limit", push_limit=71.0), "push_above_half_limit", 0.0),
        (contact.Drive(model="push_limit", push_limit=60.0, gravity="acts"), "push_above_half_limit", 0.0),
        (contact.Drive(model="none"), "drive_not_given", None),
        (contact.Drive(model="rigid", reaction_time=0.0, stopping=stops), "outside_table", 0.2),
    ):
        found = contact.driven_speed(hit, drive, LIMIT)
        assert (found.status, found.speed) == (status, speed)
    beyond = contact.driven_loads(hit, 0.3, contact.Drive(reaction_time=0.0, stopping=stops))
    assert (beyond.status, beyond.force) == ("outside_table", math.inf)
    assert [each.code for each in contact.driven_speed(hit, contact.Drive(model="none"), LIMIT).warnings][-1] == (
        "drive_not_given"
    )
    odd = standards.StoppingData(speed=[0.0, 1.0], time=[0.0, 0.03], distance=[0.0, 0.16])
    pressed = contact.driven_speed(hit, contact.Drive(reaction_time=0.1, stopping=odd), LIMIT)
    assert ("stops_inconsistent", "drive.stopping") in [(each.code, each.subject) for each in pressed.warnings]
    left = contact.Drive(model="rigid", **BRAKES, path_left=1e-3)
    assert contact.driven_loads(hit, 2.0, left).force == pytest.approx(75.0)


def test_many_masses_are_each_as_alone() -> None:
    masses = np.array([[4.0, 12.0], [0.5, np.inf]])
    for pad, drive in ((None, contact.Drive(**BRAKES)), (PAD, contact.Drive(model="rigid", **BRAKES))):
        hit = contact.Contact(robot=1.0, region=75e3, covering=pad)
        found = contact.driven_speeds(hit, drive, masses, LIMIT)
        for mass, speed in zip(masses.ravel(), found.ravel(), strict=True):
            alone = contact.driven_speed(contact.Contact(robot=mass, region=75e3, covering=pad), drive, LIMIT)
            assert speed == pytest.approx(math.inf if alone.speed is None else alone.speed, rel=1e-9)
    many = np.geomspace(1.0, 50.0, 300)
    hit = contact.Contact(robot=1.0, region=75e3, covering=PAD)
    drive = contact.Drive(model="push_limit", push_limit=20.0)
    speeds = contact.driven_speeds(hit, drive, many, LIMIT)
    for index in (0, 100, 250):
        alone = contact.driven_speed(contact.Contact(robot=many[index], region=75e3, covering=PAD), drive, LIMIT)
        assert alone.speed is not None
        assert 0.95 * alone.speed < speeds[index] <= alone.speed


def test_joint_torques_bound_the_push_in_motion() -> None:
    arm = arms.Arm.example(armature=0.5)
    torques = dict.fromkeys(arm.free_joints, 100.0)
    pose = {"shoulder": 0.4, "elbow": 1.4, "wrist_1": 0.3}
    along = np.array([0.6, 0.0, 0.8])
    found = contact.push_limit_of_torques(arm, pose, torques, link="tool", direction=along)
    # No torques within the limits push harder along the direction while the arm moves freely.
    mass = float(arm.effective_mass(pose, link="tool", direction=along))
    rates = np.stack([arm.velocity(pose, {name: 1.0}, link="tool") for name in arm.free_joints], axis=-1)
    matrix, weight = arm.mass_matrix(pose), arm.gravity_torques(pose)
    draws = np.random.default_rng(3).choice([-100.0, 100.0], (500, len(torques)))
    pushes = mass * along @ rates @ np.linalg.solve(matrix, (draws + weight).T)
    assert 0.5 * found < pushes.max() <= found * (1.0 + 1e-9)
    many = contact.push_limit_of_torques(
        arm, np.array([[0.0] * 6, [0.0, 0.4, 1.4, 0.3, 0.0, 0.0]]), torques, link="tool", direction=along
    )
    assert many[1] == pytest.approx(found)
    with pytest.raises(InvalidParameterError, match="joint_torques"):
        contact.push_limit_of_torques(arm, pose, {"elbow": 1.0}, link="tool", direction=along)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({}, "reaction_time"),
        ({"reaction_time": 0.1}, "deceleration must be given"),
        ({"reaction_time": -0.1, "deceleration": 1.0}, "reaction_time"),
        ({"reaction_time": 0.1, "deceleration": 0.0}, "deceleration must be positive"),
        ({**BRAKES, "detection_force": -1.0}, "detection_force"),
        ({**BRAKES, "stiffness": 1e5}, "stiffness must be left out"),
        ({**BRAKES, "model": "elastic"}, "stiffness must be given"),
        ({**BRAKES, "path_left": 0.1}, "path_left must be left out"),
        ({**BRAKES, "gravity": "acts"}, "gravity must be 'compensated'"),
        ({"model": "push_limit"}, "push_limit must be given"),
        ({"model": "push_limit", "push_limit": 5.0, "weight": 3.0}, "weight must come with"),
        ({"model": "push_limit", "push_limit": 5.0, "joint_torques": {"a": 1.0}}, "joint_torques must be left out"),
        ({"model": "stiff"}, "model must be"),
        ({**BRAKES, "load": 3.0}, "load must stand beside"),
        ({**BRAKES, "reacton_time": 0.1}, "an unknown key"),
    ],
)
def test_a_wrong_drive_is_refused(more: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidParameterError, match=words) as refused:
        contact.drive_of(more)
    assert str(refused.value).startswith("drive")


def test_contacts_that_no_drive_presses_are_refused() -> None:
    drive = contact.Drive(**BRAKES)
    for hit in (
        contact.Contact(robot=12.0, body=40.0, region=75e3),
        contact.Contact(robot=12.0, region=75e3, drive=contact.Support(stiffness=1e4)),
        contact.Contact(robot=12.0, region=contact.Region(k=75e3, k3=1e9)),
    ):
        with pytest.raises(InvalidParameterError):
            contact.driven_speed(hit, drive, LIMIT)
