"""Masses that are no data: each kind of them is told, and an ordinary arm is not doubted."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from api.arms.arm_models import EXAMPLE, INERTIA, INERTIAL, LINKS, TWO, joint, link, robot
from hrsafety import arms, standards
from hrsafety.arms.masses import RULES
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning, UnitWarning, unsafe_doubts

MOTORS = [1.2, 1.2, 1.0, 0.3, 0.3, 0.3]
ARM = arms.Arm.example(armature=MOTORS)
POSE = {"shoulder": 0.4, "elbow": 1.4, "wrist_2": 0.5}
PLACE = {"link": "tool", "direction": (1, 0, 0)}


def codes(arm: arms.Arm) -> list[str]:
    return [each.code for each in arm.warnings]


def doubt(arm: arms.Arm, code: str) -> ResultWarning:
    (found,) = [each for each in arm.warnings if each.code == code]
    return found


def scaled(text: str, factor: float, *names: str) -> str:
    """Return a URDF with some numbers times a factor."""

    def times(match: re.Match[str]) -> str:
        values = (repr(factor * float(each)) for each in match[2].split())
        return f'{match[1]}="{" ".join(values)}"'

    return re.sub(rf'({"|".join(names)})="([^"]*)"', times, text)


def inertial(mass: float, moments: tuple[float, float, float]) -> str:
    xx, yy, zz = moments
    inertia = f'<inertia ixx="{xx}" iyy="{yy}" izz="{zz}" ixy="0" ixz="0" iyz="0"/>'
    return f'<inertial><mass value="{mass}"/>{inertia}</inertial>'


def test_an_ordinary_arm_is_doubted_for_its_motors_only() -> None:
    assert codes(arms.Arm.example()) == ["no_motor_inertia"]
    assert codes(ARM) == []
    assert codes(arms.Arm.example(armature=MOTORS, payload=("tool", 5.0, (0, 0, 0.2)), type_plate_mass=33.0)) == []


# ---- masses of links ------------------------------------------------------------------------


def test_an_arm_without_inertials_has_no_mass_whatever_its_motors() -> None:
    bare = re.sub(r"<inertial>.*?</inertial>", "", EXAMPLE, flags=re.DOTALL)
    with pytest.raises(InvalidParameterError, match="give its links the masses"):
        arms.Arm.from_urdf(bare)
    arm = arms.Arm.from_urdf(bare, armature=MOTORS)
    assert arm.iso_mass == 0.0
    found = doubt(arm, "link_without_mass")
    assert not found.safe_side
    assert len(arm.warnings) == 1
    for rule in ("larger", "iso", "directional"):
        assert unsafe_doubts(arm.robot_mass(POSE, **PLACE, rule=rule).warnings)


def test_a_part_of_the_arm_without_a_mass_is_told() -> None:
    forearm = re.search(r'<link name="forearm">.*?</link>', EXAMPLE, flags=re.DOTALL)
    arm = arms.Arm.from_urdf(EXAMPLE.replace(forearm[0], '<link name="forearm"/>'), armature=MOTORS)
    assert "elbow moves a part of the arm without a mass" in doubt(arm, "link_without_mass").message


def test_small_shapes_without_a_mass_are_not_told() -> None:
    shape = "<collision><geometry><box size='{0} {0} {0}'/></geometry></collision>"
    joints = (joint("one", "base", "a"), joint("two", "a", "b", kind="fixed"))
    for edge, told in ((0.01, False), (0.1, True)):
        arm = arms.Arm.from_urdf(robot(link("a"), link("b", shape.format(edge)), *joints), armature=0.01)
        assert arm.links_without_mass == ("b",)
        assert codes(arm) == ["link_without_mass"] * told


def test_many_links_of_one_kind_of_doubt_are_one_doubt() -> None:
    tiny = inertial(1.5, (1e-9, 1e-9, 1e-9))
    names = [f"l{index}" for index in range(8)]
    chain = [joint(f"j{index}", ["base", *names][index], name) for index, name in enumerate(names)]
    arm = arms.Arm.from_urdf(robot(*(link(name, tiny) for name in names), *chain), armature=0.1)
    found = doubt(arm, "suspicious_link")
    assert "and 4 more have" in found.message
    assert arm.suspicious_links == tuple(names)
    assert not found.safe_side


def test_a_link_below_a_hundredth_of_the_mass_is_a_doubt_on_the_safe_side() -> None:
    speck = inertial(0.01, (1e-9, 1e-9, 1e-9))
    joints = (joint("one", "base", "a"), joint("two", "a", "b", kind="fixed"))
    arm = arms.Arm.from_urdf(robot(link("a"), link("b", speck), *joints), armature=0.1)
    assert doubt(arm, "suspicious_link").safe_side


def test_one_inertial_for_every_link_is_a_placeholder() -> None:
    same = re.sub(r"<inertial>.*?</inertial>", inertial(0.01, (0.01, 0.01, 0.01)), EXAMPLE, flags=re.DOTALL)
    for text in (same, same.replace('value="0.01"', 'value="4"')):
        arm = arms.Arm.from_urdf(text, armature=MOTORS)
        assert "one mass" in doubt(arm, "placeholder_inertial").message
        assert {each.code for each in unsafe_doubts(arm.warnings)} == {"placeholder_inertial"}


def test_centers_of_mass_on_every_joint_are_a_placeholder() -> None:
    """Filled-in origins: a third of the mass of the tool was missing."""
    for origin in ("", '<origin rpy="0 0 1"/>', '<origin xyz="0 0.0 0"/>'):
        bare = re.sub(r"<inertial>\s*<origin [^>]*/>", f"<inertial>{origin}", EXAMPLE)
        arm = arms.Arm.from_urdf(bare, armature=MOTORS)
        assert "their centers of mass where their joints are" in doubt(arm, "placeholder_inertial").message
    # One that is known, or links whose masses are links of their own, is another matter.
    one = re.sub(r"<inertial>\s*<origin [^>]*/>", "<inertial>", EXAMPLE, count=1)
    assert codes(arms.Arm.from_urdf(one, armature=MOTORS)) == []
    apart = re.sub(
        r'<link name="(\w+)">\s*<inertial>\s*(<origin [^>]*/>)(.*?)</inertial>',
        r'<link name="\1_mass"><inertial>\3</inertial></link><joint name="\1_mass" type="fixed">'
        r'<parent link="\1"/><child link="\1_mass"/>\2</joint><link name="\1">',
        EXAMPLE,
        flags=re.DOTALL,
    )
    arm = arms.Arm.from_urdf(apart, armature=MOTORS)
    assert codes(arm) == []
    assert arm.effective_mass(POSE, **PLACE).mass == pytest.approx(ARM.effective_mass(POSE, **PLACE).mass)


def test_four_equal_wheels_are_no_placeholder_but_a_base_that_rolls() -> None:
    wheels = [joint(f"w{index}", "base", f"l{index}") for index in range(4)]
    links = [link(f"l{index}", inertial(1.5, (0.012, 0.012, 0.015))) for index in range(4)]
    text = robot(*links, *wheels).replace('<link name="base">', f'<link name="base">{INERTIAL}')
    assert codes(arms.Arm.from_urdf(text, armature=0.1)) == ["base_assumed_fixed"]
    assert codes(arms.Arm.from_urdf(robot(*links, *wheels), armature=0.1)) == []
    rail = robot(link("a"), joint("one", "base", "a", '<limit lower="-20" upper="20"/>', "prismatic"))
    assert codes(arms.Arm.from_urdf(rail, armature=1.0)) == ["base_assumed_fixed"]


@pytest.mark.parametrize("name", ["front_left_wheel", "Caster_1", "rear_wheel_link"])
def test_wheels_are_told_however_they_are_mounted(name: str) -> None:
    """Locked, steered, on a spring, or with limits: by what they are called."""
    arm = (link("a"), joint("one", "base", "a"))
    for kind in ("fixed", "revolute"):
        limit = "" if kind == "fixed" else '<limit lower="-1e6" upper="1e6"/>'
        wheel = (link(name, inertial(1.5, (0.012, 0.012, 0.015))), joint("w", "base", name, limit, kind))
        assert "base_assumed_fixed" in codes(arms.Arm.from_urdf(robot(*arm, *wheel), armature=0.1))
    other = (link("wrist"), joint("w", "base", "wrist", kind="fixed"))
    assert "base_assumed_fixed" not in codes(arms.Arm.from_urdf(robot(*arm, *other), armature=0.1))


def test_three_equal_powers_of_ten_are_a_placeholder() -> None:
    for moment, told in ((1.0, True), (0.001, True), (0.0013, False)):
        parts = (link("a", inertial(3.0, (moment,) * 3)), link("b", inertial(4.0, (moment,) * 3)))
        text = robot(*parts, joint("one", "base", "a"), joint("two", "a", "b"))
        found = [each for each in codes(arms.Arm.from_urdf(text, armature=0.1)) if each == "placeholder_inertial"]
        assert len(found) == told


@pytest.mark.parametrize("factor", [1e-4, 0.02, 40.0])
def test_an_inertia_that_does_not_fit_the_shape_is_a_placeholder(factor: float) -> None:
    shape = "<visual><geometry><cylinder radius='0.05' length='0.5'/></geometry></visual>"
    moments = np.array([0.0858, 0.0858, 0.005])  # of a uniform cylinder of 4 kg
    for times, told in ((1.0, False), (factor, True)):
        text = robot(link("a", inertial(4.0, tuple(times * moments)) + shape), joint("one", "base", "a"))
        found = codes(arms.Arm.from_urdf(text, armature=0.1))
        assert ("placeholder_inertial" in found) is told


def test_collision_shapes_around_a_mesh_may_be_large() -> None:
    shape = "<collision><geometry><sphere radius='0.2'/></geometry></collision>"
    mesh = "<visual><geometry><mesh filename='a.stl'/></geometry></visual>"
    for beside, mass, told in (("", 3.0, True), (mesh, 3.0, False), (mesh, 0.3, True)):
        text = robot(link("a", inertial(mass, (0.03 * mass,) * 3) + shape + beside), joint("one", "base", "a"))
        assert ("density" in codes(arms.Arm.from_urdf(text, armature=0.1))) is told


def test_one_mass_for_every_link_is_a_placeholder_whatever_their_inertias() -> None:
    same = re.sub(r'<mass value="[^"]*"', '<mass value="1.0"', EXAMPLE)
    arm = arms.Arm.from_urdf(same, armature=MOTORS)
    assert "one mass (1 kg)" in doubt(arm, "placeholder_inertial").message
    one = re.sub(r'<mass value="[^"]*"', '<mass value="1.1"', same, count=1)
    assert "placeholder_inertial" not in codes(arms.Arm.from_urdf(one, armature=MOTORS))


@settings(max_examples=40, deadline=None)
@given(index=st.integers(0, 5), factor=st.floats(1e-7, 2e-3))
def test_a_link_without_the_mass_of_its_inertia_is_told(index: int, factor: float) -> None:
    """One link in t, or with a mass that nobody gave: half of it is missing in the mass of ISO/TS 15066."""
    places = [match for match in re.finditer(r'<mass value="([^"]*)"', EXAMPLE) if float(match[1]) > 1.0]
    place = places[index % len(places)]
    text = f"{EXAMPLE[: place.start(1)]}{factor * float(place[1])!r}{EXAMPLE[place.end(1) :]}"
    arm = arms.Arm.from_urdf(text, armature=MOTORS)
    missing = (ARM.moving_mass - arm.moving_mass) / ARM.moving_mass
    assert unsafe_doubts(arm.warnings) or missing < 0.15


def test_directions_in_degrees_are_told() -> None:
    turned = re.sub(r"(<origin [^>]*?)(/?>)", r'\1 rpy="0 90 0"\2', re.sub(r' rpy="[^"]*"', "", EXAMPLE))
    arm = arms.Arm.from_urdf(turned, armature=MOTORS)
    assert "rpy of" in doubt(arm, "implausible").message
    assert "degrees given for radians" in doubt(arm, "implausible").message
    quarter = turned.replace('"0 90 0"', '"0 -1.5707963267948966 6.28318530717958"')
    assert "implausible" not in codes(arms.Arm.from_urdf(quarter, armature=MOTORS))


def test_poses_in_degrees_are_told_where_no_limit_refuses_them() -> None:
    endless = arms.Arm.from_urdf(EXAMPLE.replace('type="revolute"', 'type="continuous"'), armature=MOTORS)
    for call in (endless.effective_mass, endless.robot_mass, endless.point_masses):
        found = call({"shoulder": 23.0, "elbow": 80.0}, **PLACE)
        assert [each.subject for each in unsafe_doubts(found.warnings)] == ["joints"]
        assert call({"shoulder": 0.4, "elbow": 1.4}, **PLACE).warnings == ()
    assert endless.extremes({"elbow": 80.0}, link="tool").warnings


def test_slides_in_millimeters_are_told() -> None:
    limits = '<limit lower="0" upper="800"/>'
    text = robot(link("a"), link("b"), joint("turn", "base", "a"), joint("slide", "a", "b", limits, "prismatic"))
    arm = arms.Arm.from_urdf(text, armature=0.1)
    for value, told in ((350.0, ["implausible"]), (0.35, [])):
        found = arm.effective_mass({"slide": value}, link="b", direction=(1, 0, 0))
        assert [each.code for each in unsafe_doubts(found.warnings) if each.subject == "joints"] == told


def test_lengths_in_millimeters_are_told() -> None:
    arm = arms.Arm.from_urdf(scaled(EXAMPLE, 1000.0, "origin xyz"), armature=1e4)
    assert "reach is 1" in doubt(arm, "implausible").message


# ---- type plate, payload, motors ------------------------------------------------------------


def test_the_type_plate_is_compared_with_all_links() -> None:
    assert ARM.total_mass == 29.0
    for plate, told in ((30.0, []), (40.0, ["mass_below_type_plate"]), (20.0, ["mass_above_type_plate"])):
        assert codes(arms.Arm.example(armature=MOTORS, type_plate_mass=plate)) == told
    light = arms.Arm.example(armature=MOTORS, type_plate_mass=400.0)
    assert codes(light) == ["mass_below_type_plate", "moving_mass_small"]
    for wrong in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(InvalidParameterError, match="type_plate_mass must be"):
            arms.Arm.example(type_plate_mass=wrong)


@pytest.mark.parametrize(
    ("payload", "subject"),
    [
        (("tool", 1200.0), "payload.mass"),
        (("tool", 0.002), "payload.mass"),
        (("tool", 2.0, (0, 0, 60.0)), "payload.center"),
        (("tool", 2.0, (0, 0, 6.0)), "payload.center"),
        (("tool", 2.0, (0, 0, 0.1), (9e3, 0, 0, 9e3, 0, 9e3)), "payload.inertia"),
        ([("tool", 2.0), ("tool", 1.0, (50.0, 0, 0))], "payload[1].center"),
    ],
)
def test_payloads_in_other_units_are_told(payload: object, subject: str) -> None:
    arm = arms.Arm.example(armature=MOTORS, payload=payload)
    assert [(each.code, each.subject) for each in arm.warnings] == [("implausible", subject)]
    assert arm.effective_mass(POSE, **PLACE).warnings == arm.warnings


def test_numbers_in_another_unit_are_issued_as_warnings_of_python() -> None:
    with pytest.warns(UnitWarning, match="payload of 1200 kg"):
        arms.Arm.from_urdf(EXAMPLE, armature=MOTORS, payload=("tool", 1200.0))
    with pytest.warns(UnitWarning, match="point is 60 m off its link"):
        ARM.effective_mass(POSE, **PLACE, point=(60.0, 0.0, 0.0))


def test_motor_inertias_on_the_side_of_the_rotor_do_not_silence_the_doubt() -> None:
    rotor = arms.Arm.example(armature=1e-4)
    assert codes(rotor) == ["armature_suspicious"]
    assert unsafe_doubts(rotor.effective_mass(POSE, **PLACE).warnings)
    one = arms.Arm.example(armature=[1e-4, *MOTORS[1:]])
    assert doubt(one, "armature_suspicious").subject == "armature['turn']"
    huge = arms.Arm.example(armature=1200.0)
    assert [(each.code, each.safe_side) for each in huge.warnings] == [("implausible", True)]


# ---- rules, results -------------------------------------------------------------------------


def test_missing_motors_count_where_the_directional_mass_may_govern() -> None:
    arm = arms.Arm.example()
    light, heavy = {"elbow": 2.5}, POSE
    along = {"link": "wrist_block_2", "direction": (0, 1, 0)}
    masses = [float(arm.effective_mass(pose, **along)) for pose in (light, heavy)]
    third = arm.iso_mass / 3
    for pose, mass in zip((light, heavy), masses, strict=True):
        by_rule = {rule: arm.robot_mass(pose, **along, rule=rule) for rule in RULES}
        unsafe = {rule: bool(unsafe_doubts(found.warnings)) for rule, found in by_rule.items()}
        assert unsafe == {"larger": mass >= third, "iso": False, "directional": True}
        assert arm.point_masses(pose, **along).robot_mass().warnings == arm.robot_mass(pose, **along).warnings
    unbounded = arm.effective_mass({"elbow": 0.0}, link="tool", direction=(0, 0, 1))
    assert unbounded.unbounded == (not unsafe_doubts(unbounded.warnings))


def test_results_carry_the_doubts_and_become_numbers_only_alone() -> None:
    arm = arms.Arm.example()
    one = arm.effective_mass(POSE, **PLACE)
    assert float(one) == one.mass
    assert "no motor inertia" in repr(one)
    assert "kg" in one._repr_html_()
    assert not isinstance(one, float)
    several = arm.effective_mass(np.zeros((2, 6)), **PLACE)
    with pytest.raises(InvalidParameterError, match=r"take \.mass"):
        float(several)
    assert [each.code for each in arm.extremes(POSE, link="tool").warnings] == ["no_motor_inertia"]
    far = ARM.effective_mass(POSE, link="tool", point=(60.0, 0, 0), direction=(0, 0, 1))
    assert [each.subject for each in far.warnings] == ["point"]


def test_verdicts_along_a_record_know_the_doubts_of_the_arm() -> None:
    time = np.linspace(0.0, 2.0, 41)
    joints = {"shoulder": 0.4 + 0.05 * time, "elbow": np.full(41, 1.4)}
    limit = standards.limits().contact("chest", "transient")
    words = {}
    for name, arm in {"known": ARM, "none": arms.Arm.example(), "rotor": arms.Arm.example(armature=1e-4)}.items():
        history = arms.along(arm, time, joints, link="tool", limit=limit, area=1e-4, robot_mass="directional")
        words[name] = set(history.verdict.tolist())
    assert words == {"known": {"within_limits"}, "none": {"not_checked"}, "rotor": {"not_checked"}}
    iso = arms.along(arms.Arm.example(), time, joints, link="tool", limit=limit, area=1e-4, robot_mass="iso")
    assert set(iso.verdict.tolist()) == {"within_limits"}
    assert [each.safe_side for each in iso.warnings] == [True]
    light = arms.Arm.from_urdf(scaled(EXAMPLE, 1e-3, "mass value", "ixx", "iyy", "izz"), armature=MOTORS)
    spoiled = arms.along(light, time, joints, link="tool", limit=limit, area=1e-4, robot_mass="iso")
    assert set(spoiled.verdict.tolist()) == {"not_checked"}


def test_records_and_limits_along_them_are_doubted() -> None:
    time = np.linspace(0.0, 2.0, 41)
    joints = {"shoulder": 0.4 + 0.05 * time, "elbow": np.full(41, 1.4)}
    chest, clamped = (standards.limits().contact("chest", kind) for kind in ("transient", "quasi_static"))
    given = {"link": "tool", "limit": chest, "area": 1e-4, "robot_mass": "iso"}
    sound = arms.along(ARM, time, joints, **given)
    assert (unsafe_doubts(sound.warnings), set(sound.verdict.tolist())) == ((), {"within_limits"})
    assert sound.margin == pytest.approx(1.0 - sound.force / min(280.0, 240.0))
    endless = arms.Arm.from_urdf(EXAMPLE.replace('type="revolute"', 'type="continuous"'), armature=MOTORS)
    degrees = {"shoulder": 23.0 + 30.0 * time, "elbow": np.full(41, 80.0)}
    for arm, instants, poses, more, code in (
        (ARM, time, joints, {"area": None}, "not_checked"),
        (ARM, time, joints, {"limit": clamped}, "drive_not_given"),
        (ARM, 1000.0 * time, joints, {}, "implausible"),
        (endless, time, degrees, {}, "implausible"),
    ):
        found = arms.along(arm, instants, poses, **given | more)
        assert [each.code for each in unsafe_doubts(found.warnings)] == [code]
        assert "within_limits" not in found.verdict.tolist()


# ---- inertias that no body has, other formats -----------------------------------------------

OFF = INERTIAL.replace('ixx="0.01"', 'ixx="0.022"')
WRONG = INERTIAL.replace('ixx="0.01"', 'ixx="0.04"')
ONE = joint("one", "base", "a")


def test_small_violations_are_projected_with_a_note() -> None:
    arm = arms.Arm.from_urdf(robot(link("a", OFF), ONE), armature=0.1)
    found = doubt(arm, "inertia_projected")
    assert found.safe_side
    assert "2.38 % of its trace" in found.message
    for moments in ("0.04", "-0.01"):
        text = robot(link("a", INERTIAL.replace('ixx="0.01"', f'ixx="{moments}"')), ONE)
        with pytest.raises(InvalidParameterError, match="repair_inertia = true"):
            arms.Arm.from_urdf(text)
        arm = arms.Arm.from_urdf(text, armature=0.1, repair_inertia=True)
        assert not doubt(arm, "inertia_projected").safe_side


def test_inertias_that_hardly_count_are_not_refused() -> None:
    speck = inertial(0.01, (1e-6, 1e-6, 9e-6))
    joints = (ONE, joint("two", "a", "b", kind="fixed"))
    arm = arms.Arm.from_urdf(robot(link("a"), link("b", speck), *joints), armature=0.1)
    assert doubt(arm, "inertia_projected").safe_side
    standing = robot(link("a"), ONE).replace('<link name="base">', f'<link name="base">{WRONG}')
    arm = arms.Arm.from_urdf(standing, armature=0.1)
    assert (codes(arm), doubt(arm, "inertia_ignored").safe_side) == (["inertia_ignored"], True)


def test_attributes_that_change_nothing_are_passed_over() -> None:
    axis = '<axis xyz="0 0 1" rpy="0 0 0"/><limit effort="1" velocity="1" k_velocity="0" command_effort="4"/>'
    inertia = INERTIAL.replace("/></inertial>", ' iyx="0" izx="0"/></inertial>')
    arm = arms.Arm.from_urdf(robot(link("a", inertia), joint("one", "base", "a", axis)), armature=0.1)
    plain = arms.Arm.from_urdf(robot(link("a"), ONE), armature=0.1)
    place = {"link": "a", "point": (0.4, 0, 0), "direction": (0, 1, 0)}
    assert arm.effective_mass(**place).mass == plain.effective_mass(**place).mass
    assert (codes(arm), doubt(arm, "attribute_ignored").safe_side) == (["attribute_ignored"], True)
    for spoiled in ('iyx="0.1"', 'units="g"', 'scale="2"'):
        with pytest.raises(InvalidParameterError):
            arms.Arm.from_urdf(robot(link("a", INERTIAL.replace("/></inertial>", f" {spoiled}/></inertial>")), ONE))


def test_foreign_blocks_with_undeclared_prefixes_are_passed_over() -> None:
    foreign = '<drake:proximity_properties drake:kind="a"><drake:mesh/></drake:proximity_properties>'
    text = TWO.replace("</robot>", f"<sensor:ray/>{foreign}</robot>")
    place = {"link": "b", "direction": (0, 1, 0)}
    found = arms.Arm.from_urdf(text).effective_mass(**place)
    assert found.mass == arms.Arm.from_urdf(TWO).effective_mass(**place).mass
    with pytest.raises(InvalidParameterError, match="expand"):
        arms.Arm.from_urdf(TWO.replace("</robot>", "<xacro:arm/><drake:ray/></robot>"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('<sdf version="1.9"><model name="m"/></sdf>', "this is SDF of Gazebo.*URDF"),
        ('<robot name="m"><group name="arm"/></robot>', "this is SRDF.*URDF"),
        (
            '<robot xmlns:xacro="http://ros.org/xacro"><xacro:include filename="a"/></robot>',
            "xacro .* > robot.urdf",
        ),
    ],
)
def test_other_formats_are_named_with_the_way_to_a_urdf(text: str, message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        arms.Arm.from_urdf(text)


def test_the_inertia_of_the_small_models_is_valid() -> None:
    assert INERTIA in LINKS[0]
    assert "inertia_projected" not in codes(arms.Arm.from_urdf(TWO))
