"""Arms from URDF: what is read, what is refused, what broadcasts."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import numpy as np
import pytest

from api.arms.arm_models import EXAMPLE, INERTIA, INERTIAL, LINKS, TWO, joint, link, robot
from hrsafety import arms, standards
from hrsafety.errors import InvalidParameterError, ShapeError

ARM = arms.Arm.example()
POSE = {"shoulder": 0.4, "elbow": 1.4, "wrist_2": 0.5}


def mass(arm: arms.Arm, *, link: str = "b", direction: object = (0, 1, 0), **options: object) -> float:
    return arm.effective_mass(options.pop("joints", None), link=link, direction=direction, **options).mass


# ---- reading --------------------------------------------------------------------------------


def test_a_link_on_one_joint_weighs_its_inertia_over_its_lever_squared() -> None:
    arm = arms.Arm.from_urdf(robot(link("a"), joint("one", "base", "a")))
    about_axis = 0.01 + 1.5 * 0.1**2
    assert mass(arm, link="a", point=(0.5, 0, 0)) == pytest.approx(about_axis / 0.25, rel=1e-14)
    assert mass(arm, link="a", point=(0.5, 0, 0), direction=(1, 0, 0)) == math.inf
    assert mass(arm, link="base") == math.inf


def test_a_file_and_its_text_are_the_same_arm(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(f"\ufeff{EXAMPLE}", encoding="utf-8")
    assert arms.Arm.from_urdf(path) == arms.Arm.from_urdf(EXAMPLE) == arms.Arm.from_urdf(str(path)) == ARM


def test_arms_are_pickled_by_value() -> None:
    arm = arms.Arm.example(payload=("tool", 2.0, (0, 0, 0.1)), armature={"elbow": 0.5}, locked=["wrist_3"])
    again = pickle.loads(pickle.dumps(arm))
    assert again == arm
    assert hash(again) == hash(arm)
    place = {"link": "tool", "direction": (0, 0, 1)}
    assert again.effective_mass(POSE, **place).mass == arm.effective_mass(POSE, **place).mass


def test_facts_of_the_example() -> None:
    assert ARM.joint_names == ("turn", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3")
    assert ARM.moving_mass == 29.0
    assert ARM.iso_mass == 14.5
    assert ARM.limits[2].tolist() == [-2.8, 2.8]
    assert ARM.moved_links == ARM.link_names[1:]
    assert [each.code for each in ARM.warnings] == ["no_motor_inertia"]
    assert "no motor inertia given" in str(ARM.point_masses(POSE, link="tool", direction=(1, 0, 0)))
    assert not arms.Arm.example(armature=0.3).warnings


def test_the_axis_is_x_by_default_and_its_length_does_not_matter() -> None:
    place = {"link": "a", "point": (0.0, 0.4, 0.1)}
    without, other = (
        arms.Arm.from_urdf(robot(link("a"), joint("one", "base", "a", axis)))
        for axis in ("", '<axis xyz="1e-200 0 0"/>')
    )
    assert mass(without, direction=(0, 0, 1), **place) == mass(other, direction=(0, 0, 7), **place)


def test_links_below_two_millimeters_are_suspicious() -> None:
    tiny = INERTIAL.replace(INERTIA, '<inertia ixx="1e-9" ixy="0" ixz="0" iyy="1e-9" iyz="0" izz="1e-9"/>')
    arm = arms.Arm.from_urdf(robot(link("a"), link("b", tiny), joint("one", "base", "a"), joint("two", "a", "b")))
    assert arm.suspicious_links == ("b",)
    assert [each.code for each in arm.warnings] == ["no_motor_inertia", "suspicious_link", "placeholder_inertial"]


def test_moving_links_with_a_shape_but_no_inertial_are_told() -> None:
    box = "<{0}><geometry><box size='.1 .1 .1'/></geometry></{0}>"
    joints = (joint("one", "base", "a"), joint("two", "a", "b", kind="fixed"))
    for shape in ("visual", "collision"):
        arm = arms.Arm.from_urdf(robot(link("a"), link("b", box.format(shape)), *joints))
        assert arm.links_without_mass == ("b",)
        assert [each.code for each in arm.warnings] == ["no_motor_inertia", "link_without_mass"]
        masses = arm.point_masses([0.0], link="a", point=(0.0, 0.4, 0.0), direction=(1, 0, 0))
        assert "link_without_mass" in [each.code for each in masses.warnings]
    frame = robot(link("a"), link("b", ""), *joints)  # as tools have
    seen = '<link name="base">' + box.format("visual")  # which no joint moves
    for text in (frame, frame.replace('<link name="base">', seen)):
        assert arms.Arm.from_urdf(text).links_without_mass == ()


# ---- options --------------------------------------------------------------------------------


def test_locked_joints_keep_their_value_and_their_mass() -> None:
    locked = arms.Arm.from_urdf(TWO, locked=["two"])
    assert locked.joint_names == ("one", "two")
    assert locked.free_joints == ("one",)
    assert locked.iso_mass == arms.Arm.from_urdf(TWO).iso_mass == 1.5
    straight = locked.position({"two": 0.0}, link="b", point=(0.2, 0, 0))
    assert not np.allclose(straight, locked.position({"two": 1.0}, link="b", point=(0.2, 0, 0)))
    # One rigid body about one axis: all its inertia over the squared lever.
    inertia = 2 * 0.01 + 1.5 * 0.1**2 + 1.5 * 0.4**2
    assert mass(locked, point=(0.2, 0, 0)) == pytest.approx(inertia / 0.25, rel=1e-13)


def test_a_joint_that_mimics_another_moves_as_if_it_were_geared_to_it() -> None:
    mimic = '<axis xyz="0 0 1"/><mimic joint="one" multiplier="-1" offset="0"/>'
    arm = arms.Arm.from_urdf(robot(*LINKS, joint("one", "base", "a"), joint("two", "a", "b", mimic)))
    assert arm.joint_names == ("one",)
    # The second link keeps its heading: its center is carried by the first joint alone, on a circle of 0.3 m.
    inertia = 0.01 + 1.5 * 0.1**2 + 1.5 * 0.3**2
    assert mass(arm, point=(0.1, 0, 0)) == pytest.approx(inertia / 0.3**2, rel=1e-13)
    locked = arms.Arm.from_urdf(arm.urdf, locked=["two"])
    assert mass(locked, point=(0.1, 0, 0)) == mass(arm, point=(0.1, 0, 0))
    assert mass(arms.Arm.from_urdf(arm.urdf, locked="one"), point=(0.1, 0, 0)) == math.inf


def test_payload_counts_once_in_each_mass() -> None:
    load = {"link": "tool", "mass": 2.0, "centre": (0, 0, 0.1)}
    loaded = arms.Arm.example(payload=load)
    assert loaded.iso_mass == 16.5
    assert loaded.payload_mass == 2.0
    place = {"link": "tool", "point": (0, 0, 0.1)}
    # A point mass at the point itself: the inverse of its mobility grows by the mass in every direction.
    grown = np.linalg.inv(loaded.mobility(POSE, **place)) - np.linalg.inv(ARM.mobility(POSE, **place))
    assert np.allclose(grown, 2.0 * np.eye(3), atol=1e-10)
    halves = arms.Arm.example(payload=[("tool", 1.0, (0, 0, 0.1)), arms.Payload("tool", 1.0, (0, 0, 0.1))])
    assert np.allclose(halves.mobility(POSE, **place), loaded.mobility(POSE, **place), rtol=1e-12, atol=1e-14)


def test_motor_inertia_is_given_by_name_in_order_or_for_all() -> None:
    names = {name: 0.2 for name in ARM.joint_names}
    given = [arms.Arm.example(armature=each) for each in (names, [0.2] * 6, 0.2)]
    assert given[0] == given[1] == given[2]
    assert given[0].warnings == ()


def test_motors_of_some_joints_do_not_hide_that_others_have_none() -> None:
    known = {name: 0.2 for name in ARM.joint_names[1:]}
    (warning,) = arms.Arm.example(armature=known).warnings
    assert warning.code == "no_motor_inertia"
    assert f"no motor inertia given for {ARM.joint_names[0]}: effective masses are lower bounds" in warning.message
    (warning,) = arms.Arm.example(armature=known | {ARM.joint_names[0]: 0.0}).warnings
    assert (warning.code, warning.safe_side) == ("armature_suspicious", False)
    assert arms.Arm.example(armature=known, locked=ARM.joint_names[:1]).warnings == ()
    nothing = {name: 0.0 for name in ARM.joint_names}
    assert [each.code for each in arms.Arm.example(armature=nothing).warnings] == ["no_motor_inertia"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"locked": ["elbwo"]}, r"locked must name joints of the arm, got 'elbwo'"),
        ({"locked": ["elbow", "elbow"]}, r"locked must name a joint once"),
        ({"locked": ["tool_mount"]}, r"locked must name joints that move"),
        ({"armature": {"elbow": -0.1}}, r'armature\["elbow"\] must be finite and not negative, got -0.1'),
        ({"armature": [0.1, 0.2]}, r"armature must have shape \(6,\)"),
        ({"payload": ("hand", 1.0)}, r"payload.link must name a link of the arm, got 'hand'"),
        ({"payload": ("base", 1.0)}, r"payload.link must name a link that a joint moves"),
        ({"payload": ("tool", -1.0)}, r"payload.mass must be finite and not negative"),
        ({"payload": ("tool", 1.0, (0, 0, 0), (1, 0, 0, 1, 0, 5))}, r"payload.inertia must have principal moments"),
        ({"payload": {"link": "tool"}}, r"payload must be a Payload"),
    ],
)
def test_bad_options_are_named(options: dict[str, object], message: str) -> None:
    with pytest.raises((InvalidParameterError, ShapeError), match=message):
        arms.Arm.example(**options)


# ---- refusals -------------------------------------------------------------------------------

MACRO = '<robot name="m" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arm/></robot>'
ONE = joint("one", "base", "a")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (MACRO, r"arm in line 1 must hold no macros of xacro, got '<xacro:arm>'; expand them first"),
        (robot(link("a"), ONE.replace("0.3 0 0", "${reach} 0 0")), r"origin in line 1 must hold no macros"),
        ("<xacro:robot/>", r"urdf must be well-formed XML.*expand xacro first"),
        ("<sdf/>", r"root element must be <robot>, got 'sdf'"),
        ("<!DOCTYPE x [<!ENTITY a 'a'>]><robot/>", r"without a document type"),
        (robot(link("a"), joint("one", "base", "a", kind="floating")), r'joint "one": type must be revolute.*floating'),
        (robot(link("a"), joint("one", "base", "a", kind="planar")), r'joint "one": type must be'),
        (robot(link("a"), joint("one", "base", "a", kind="ball")), r'joint "one": type must be "revolute"'),
        ("<robot/>", r"robot must have one link that is no child of a joint, got no link"),
        (robot(link("a")), r"got 2: base, a"),
        (robot(*LINKS, ONE, joint("two", "b", "a")), r'link "a" must be the child of one joint.*"one" and "two"'),
        (robot(*LINKS, joint("one", "a", "b"), joint("two", "b", "a")), r'link "a" must hang on the root, got a loop'),
        (robot(joint("one", "base", "a")), r'joint "one": child must be the name of a link, got \'a\''),
        (robot(link("a"), link("a"), ONE), r"link name must be the name of one link, got 'a'"),
        (robot(*LINKS, ONE, joint("one", "a", "b")), r"joint name must be the name of one joint"),
        (
            robot(link("a"), joint("one", "base", "a", '<axis xyz="0 0 0"/>')),
            r'joint "one": axis: xyz must not be zero',
        ),
        (robot(link("a"), joint("one", "base", "a", '<axis xyz="0 nan 1"/>')), r"axis: xyz must be a finite number"),
        (robot(link("a"), joint("one", "base", "a", '<axis xyz="0 1"/>')), r"axis: xyz must be three numbers"),
        (robot(link("a", INERTIAL.replace("1.5", "1e999")), ONE), r'link "a": inertial: mass: value must be a finite'),
        (robot(link("a", INERTIAL.replace("1.5", "-1.5")), ONE), r'link "a"\.mass must be finite and not negative'),
        (
            robot(link("a", INERTIAL.replace('ixx="0.01"', 'ixx="-0.01"')), ONE),
            r'link "a"\.inertia must be positive semi',
        ),
        (robot(link("a", INERTIAL.replace('ixx="0.01"', 'ixx="0.04"')), ONE), r'link "a"\.inertia must have principal'),
        (robot(link("a", INERTIAL.replace('ixy="0" ', "")), ONE), r'link "a": inertial: inertia: ixy must be given'),
        (robot(link("a", INERTIAL.replace("inertial", "inertal")), ONE), r'got \'inertal\'; did you mean "inertial"'),
        (robot(link("a", INERTIAL.replace("xyz", "xzy")), ONE), r"inertial: origin must have no other attributes"),
        (robot(link("a", INERTIAL * 2), ONE), r'link "a": inertial must stand there once, got 2'),
        (robot(link("a", ""), ONE), r'joint "one" must move an inertia of its own, got a singular mass matrix'),
        (
            robot(link("a", ""), link("b"), ONE, joint("two", "a", "b").replace("0.3 0 0", "0 0 0")),
            r'joint "(one|two)" must move an inertia of its own',
        ),
    ],
)
def test_what_cannot_be_an_arm_is_refused_by_name(text: str, message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        arms.Arm.from_urdf(text)


@pytest.mark.parametrize(
    ("one", "two", "message"),
    [
        ("two", "one", r'joint "one": mimic must not lead back to itself'),
        ("one", None, r'joint "one": mimic must not lead back to itself'),
        ("three", None, r'joint "one": mimic must name a joint, got \'three\''),
    ],
)
def test_mimics_that_lead_nowhere_are_refused(one: str, two: str | None, message: str) -> None:
    first = f'<axis xyz="0 0 1"/><mimic joint="{one}"/>'
    second = '<axis xyz="0 0 1"/>' if two is None else f'<axis xyz="0 0 1"/><mimic joint="{two}"/>'
    text = robot(*LINKS, joint("one", "base", "a", first), joint("two", "a", "b", second))
    with pytest.raises(InvalidParameterError, match=message):
        arms.Arm.from_urdf(text)


def test_a_file_is_named_before_its_element(tmp_path: Path) -> None:
    path = tmp_path / "bad.urdf"
    path.write_text(robot(link("a"), link("a"), ONE))
    with pytest.raises(InvalidParameterError, match=r"^bad\.urdf: link name must be"):
        arms.Arm.from_urdf(path)
    with pytest.raises(InvalidParameterError, match=r"path_or_text must name a readable file"):
        arms.Arm.from_urdf(tmp_path / "none.urdf")


def test_a_joint_without_inertia_is_mended_by_a_motor() -> None:
    arm = arms.Arm.from_urdf(robot(link("a", ""), ONE), armature={"one": 0.5})
    assert mass(arm, link="a", point=(0.5, 0, 0)) == pytest.approx(2.0, rel=1e-14)


# ---- values ---------------------------------------------------------------------------------


def test_values_outside_limits_are_errors_unless_told_otherwise() -> None:
    message = r'joints\["elbow"\] must be from -2.8 to 2.8, got 3.0; it is 2.000e-1 outside'
    with pytest.raises(InvalidParameterError, match=message):
        ARM.effective_mass({"elbow": 3.0}, link="tool", direction=(1, 0, 0))
    found = ARM.effective_mass({"elbow": 3.0}, link="tool", direction=(1, 0, 0), check_limits=False)
    assert found.mass > 0.0
    with pytest.raises(InvalidParameterError, match=r'joints\[1\]\["elbow"\] must be finite, got nan'):
        ARM.effective_mass({"elbow": [0.0, math.nan]}, link="tool", direction=(1, 0, 0), check_limits=False)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"link": "tol"}, r'link must be one of .*; did you mean "tool"'),
        ({"direction": (0, 0, 0)}, r"direction\[0\] must not be zero"),
        ({"direction": (0, 0, math.inf)}, r"direction\[0\] must be finite"),
        ({"direction": (0, 1)}, r"direction must have shape \(..., 3\)"),
        ({"point": (0, math.nan, 0)}, r"point\[0\] must be finite"),
        ({"joints": {"elbwo": 1.0}}, r'joints must name joints .* got \'elbwo\'; did you mean "elbow"'),
        ({"joints": [0.0] * 5}, r"joints must have shape \(..., 6\)"),
        ({"joints": np.zeros((2, 6)), "direction": np.ones((3, 3))}, r"broadcast together"),
        ({"threads": 0}, r"threads must be"),
        ({"check_limits": 1}, r"check_limits must be True or False"),
    ],
)
def test_bad_arguments_are_named(arguments: dict[str, object], message: str) -> None:
    right = {"joints": POSE, "link": "tool", "direction": (1, 0, 0)}
    with pytest.raises((InvalidParameterError, ShapeError), match=message):
        ARM.effective_mass(**(right | arguments))


def test_poses_points_and_directions_broadcast() -> None:
    draws = np.random.default_rng(3)
    poses = draws.uniform(-1.0, 1.0, (4, 1, 1, 6))
    points = draws.uniform(-0.1, 0.1, (3, 1, 3))
    directions = draws.normal(size=(2, 3))
    whole = ARM.effective_mass(poses, link="tool", point=points, direction=directions).mass
    assert whole.shape == (4, 3, 2)
    for pose, point, along in np.ndindex(4, 3, 2):
        where = {"link": "tool", "point": points[point, 0], "direction": directions[along]}
        one = ARM.effective_mass(poses[pose, 0, 0], **where).mass
        assert type(one) is float
        assert whole[pose, point, along] == one
    named = ARM.effective_mass({"elbow": [0.1, 0.2], "turn": 0.3}, link="tool", direction=(1, 0, 0)).mass
    assert named.shape == (2,)
    assert ARM.effective_mass(np.zeros((0, 6)), link="tool", direction=(1, 0, 0)).mass.shape == (0,)


def test_threads_change_no_bit() -> None:
    poses = np.random.default_rng(4).uniform(-1.0, 1.0, (5000, 6))
    found = [ARM.effective_mass(poses, link="tool", direction=(1, 2, 3), threads=each).mass for each in (1, 2, 3)]
    assert np.array_equal(found[0], found[1])
    assert np.array_equal(found[0], found[2])


def test_arms_of_more_axes_than_are_compiled_for() -> None:
    names = ["base", *(f"l{index}" for index in range(12))]
    chain = [joint(f"j{index}", names[index], names[index + 1]) for index in range(12)]
    arm = arms.Arm.from_urdf(robot(*(link(name) for name in names[1:]), *chain))
    short = arms.Arm.from_urdf(arm.urdf, locked=[f"j{index}" for index in range(2, 12)])
    bent = {f"j{index}": 0.1 * index for index in range(12)}
    assert 0.0 < mass(arm, link="l11", joints=bent) < mass(short, link="l11", joints=bent)


# ---- many poses -----------------------------------------------------------------------------


def test_masses_along_a_record_are_those_of_its_instants() -> None:
    time = np.linspace(0.0, 2.0, 201)
    joints = {"shoulder": 0.4 + 0.3 * np.sin(time), "elbow": np.full(201, 1.2)}
    limit = standards.limits().contact("chest", "transient")
    history = arms.along(ARM, time, joints, link="tool", point=(0, 0, 0.05), limit=limit)
    rates = {"shoulder": 0.3 * np.cos(time)}
    exact = ARM.velocity(joints, rates, link="tool", point=(0, 0, 0.05))
    assert np.allclose(history.velocity, exact, atol=1e-4)
    expected = ARM.effective_mass(joints, link="tool", point=(0, 0, 0.05), direction=exact).mass
    assert np.allclose(history.effective_mass, expected, rtol=1e-3)
    mu = 1.0 / (1.0 / history.robot_mass + 1.0 / 40.0)
    assert np.allclose(history.force, history.speed * np.sqrt(mu * 25e3), rtol=1e-12)
    assert np.allclose(history.margin, 1.0 - history.force / 280.0)
    assert history.worst == np.argmax(history.force)
    assert list(history.columns())[-3:] == ["force_N", "margin", "verdict"]


def test_rest_is_a_status_and_no_force() -> None:
    limit = standards.limits().contact("face", "transient")
    history = arms.along(ARM, [0.0, 1.0, 2.0], np.zeros((3, 6)), link="tool", limit=limit)
    assert history.status.tolist() == ["at_rest"] * 3
    assert history.force.tolist() == [0.0] * 3
    assert history.margin is None
    assert history.verdict.tolist() == ["not_permitted"] * 3
    with pytest.raises(InvalidParameterError, match=r"time\[2\] must exceed 1.0"):
        arms.along(ARM, [0.0, 1.0, 1.0], np.zeros((3, 6)), link="tool")


def test_workspaces_are_drawn_between_the_limits_and_repeat() -> None:
    found = arms.workspace(ARM, link="tool", samples=300, seed=5, fixed={"turn": 0.5})
    assert np.array_equal(
        found.joints, arms.workspace(ARM, link="tool", samples=300, seed=5, fixed={"turn": 0.5}).joints
    )
    assert (found.joints[:, 0] == 0.5).all()
    assert ((found.joints >= ARM.limits[:, 0]) & (found.joints <= ARM.limits[:, 1])).all()
    assert found.mass[found.worst] == max(found.mass)
    again = ARM.effective_mass(found.joints, link="tool", direction=found.direction)
    assert np.allclose(again.mass, found.mass, rtol=1e-9)
    grid = arms.workspace(ARM, link="tool", grid=3, fixed={"turn": 0.0, "wrist_1": 0.0, "wrist_2": 0.1, "wrist_3": 0.0})
    assert len(grid.mass) == 9
    with pytest.raises(InvalidParameterError, match=r"grid must give at most"):
        arms.workspace(ARM, link="tool", grid=100)


def test_the_larger_mass_is_the_default_and_both_are_shown() -> None:
    masses = ARM.point_masses(POSE, link="tool", direction=[(1, 0, 0), (0, 0, 1)])
    assert masses.robot_mass().mass.tolist() == np.maximum(masses.effective_mass, 14.5).tolist()
    assert masses.robot_mass("iso").mass.tolist() == [14.5, 14.5]
    assert masses.robot_mass("directional").mass.tolist() == masses.effective_mass.tolist()
    assert np.linalg.norm(masses.direction, axis=1).tolist() == [1.0, 1.0]
    with pytest.raises(InvalidParameterError, match=r'must be one of "larger", "iso", "directional"'):
        masses.robot_mass("largest")
