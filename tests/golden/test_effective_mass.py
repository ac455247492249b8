"""Effective masses against the checked cases of three implementations, to 1e-9."""

from __future__ import annotations

import json
import math
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import arms

TOLERANCE = 1e-9  # relative; the cases are printed with 13 digits
ALONG = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1), "d": (0.6, -0.48, 0.64)}


@pytest.fixture(scope="module")
def cases(shared: Path) -> dict[str, Any]:
    data: dict[str, Any] = json.loads((shared / "spec" / "contact_cases.json").read_text(encoding="utf-8"))
    return data["effective_mass"]


def robots() -> Path:
    """Return where the package of robot descriptions keeps its files."""
    pytest.importorskip("pinocchio", reason="pin and example-robot-data are not installed")
    spec = find_spec("pinocchio")
    assert spec is not None
    assert spec.origin is not None
    prefix = next(parent for parent in Path(spec.origin).parents if parent.name == "cmeel.prefix")
    return prefix / "share" / "example-robot-data" / "robots"


def arm_of(row: dict[str, Any], cases: dict[str, Any]) -> arms.Arm:
    if row["source"] == "text":
        return arms.Arm.from_urdf(cases["urdf"][row["robot"]], locked=row["locked"])
    return arms.Arm.from_urdf(robots() / row["source"].split()[1], locked=row["locked"])


@pytest.mark.parametrize("index", range(19))
def test_masses_of_a_case(index: int, cases: dict[str, Any]) -> None:
    row = cases["rows"][index]
    arm = arm_of(row, cases)
    place = {"link": row["link"], "point": row["point"], "check_limits": False}
    for name, direction in ALONG.items():
        found = arm.effective_mass(row["joints"], direction=direction, **place).mass
        expected = math.inf if row[f"mass_{name}"] is None else row[f"mass_{name}"]
        assert found == pytest.approx(expected, rel=TOLERANCE), name
    found = arm.extremes(row["joints"], **place)
    expected = math.inf if row["worst_mass"] is None else row["worst_mass"]
    assert float(found.worst_mass) == pytest.approx(expected, rel=TOLERANCE)
    assert float(found.least_mass) == pytest.approx(row["least_mass"], rel=TOLERANCE)
    if row["worst_direction"] is not None:
        assert abs(found.worst_direction @ row["worst_direction"]) == pytest.approx(1.0, abs=TOLERANCE)
    assert arm.position(row["joints"], **place) == pytest.approx(row["position"], abs=1e-12)
    assert arm.moving_mass == pytest.approx(row["moving_mass"], rel=TOLERANCE)
    assert arm.iso_mass == pytest.approx(row["iso_mass"], rel=TOLERANCE)


def test_all_cases_are_tested(cases: dict[str, Any]) -> None:
    assert len(cases["rows"]) == 19


def test_mass_of_the_table_is_half_the_moving_mass_and_the_tool(shared: Path) -> None:
    rows = json.loads((shared / "spec" / "contact_cases.json").read_text(encoding="utf-8"))["iso_table"]
    inertia = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    text = (
        f'<robot name="r"><link name="b"/><link name="a"><inertial><mass value="28.7"/>{inertia}</inertial></link>'
        '<joint name="j" type="continuous"><parent link="b"/><child link="a"/></joint></robot>'
    )
    arm = arms.Arm.from_urdf(text, payload=("a", 2.0))
    assert {row["robot_mass"] for row in rows} == {arm.iso_mass}


@pytest.mark.parametrize("robot", ["panda", "ur5", "ur10"])
def test_random_poses_against_two_other_libraries(robot: str, cases: dict[str, Any]) -> None:
    pin = pytest.importorskip("pinocchio", reason="pin is not installed")
    mujoco = pytest.importorskip("mujoco", reason="mujoco is not installed")
    row = next(row for row in cases["rows"] if row["robot"] == robot)
    # Neither library folds a finger that mimics the other one: both fingers are locked.
    arm = arm_of(row, cases)
    oracle = pin.buildModelFromUrdf(str(robots() / row["source"].split()[1]))
    data = oracle.createData()
    frame = oracle.getFrameId(row["link"])
    draws = np.random.default_rng(6)
    other, state = _mujoco(mujoco, arm, row["link"])
    for _ in range(20):
        pose = dict(zip(arm.joint_names, draws.uniform(-1.5, 1.5, len(arm.joint_names)), strict=True))
        pose |= {name: 0.0 for name in arm.joint_names if name not in arm.free_joints}
        along = draws.normal(size=3)
        along /= np.linalg.norm(along)
        mobility = arm.mobility(pose, link=row["link"], check_limits=False)
        free = [index for index, name in enumerate(oracle.names[1:]) if name in arm.free_joints]
        values = np.array([pose.get(name, 0.0) for name in oracle.names[1:]])
        jacobian = pin.computeFrameJacobian(oracle, data, values, frame, pin.LOCAL_WORLD_ALIGNED)[:3, free]
        upper = pin.crba(oracle, data, values)
        masses = (np.triu(upper) + np.triu(upper, 1).T)[np.ix_(free, free)]
        expected = jacobian @ np.linalg.solve(masses, jacobian.T)
        scale = TOLERANCE * np.abs(expected).max()
        assert np.allclose(mobility, expected, rtol=0, atol=scale)
        third = _mobility(mujoco, other, state, pose, row["link"], arm.free_joints)
        assert np.allclose(mobility, third, rtol=0, atol=scale)
        found = arm.effective_mass(pose, link=row["link"], direction=along, check_limits=False).mass
        assert found == pytest.approx(1.0 / (along @ expected @ along), rel=TOLERANCE)


def _mujoco(mujoco: Any, arm: arms.Arm, link: str) -> tuple[Any, Any]:
    """Return the same arm in MuJoCo, without its meshes, which are not needed and not found."""
    import xml.etree.ElementTree as Xml

    root = Xml.fromstring(arm.urdf)
    for parent in root.iter("link"):
        for shape in [*parent.findall("visual"), *parent.findall("collision")]:
            parent.remove(shape)
    settings = Xml.SubElement(Xml.SubElement(root, "mujoco"), "compiler")
    settings.attrib.update({"fusestatic": "false", "balanceinertia": "false", "boundmass": "0", "boundinertia": "0"})
    model = mujoco.MjModel.from_xml_string(Xml.tostring(root, encoding="unicode"))
    assert mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, link) >= 0
    return model, mujoco.MjData(model)


def _mobility(
    mujoco: Any, model: Any, data: Any, pose: dict[str, float], link: str, free: tuple[str, ...]
) -> np.ndarray:
    for name, value in pose.items():
        data.qpos[model.joint(name).qposadr[0]] = value
    mujoco.mj_forward(model, data)
    masses = np.zeros((model.nv, model.nv))
    if hasattr(data, "qM"):  # until MuJoCo 3
        mujoco.mj_fullM(model, masses, data.qM)
    else:
        mujoco.mj_fullM(model, data, masses)
    jacobian = np.zeros((3, model.nv))
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, link)
    mujoco.mj_jac(model, data, jacobian, None, data.xpos[body], body)
    columns = [model.joint(name).dofadr[0] for name in free]
    return jacobian[:, columns] @ np.linalg.solve(masses[np.ix_(columns, columns)], jacobian[:, columns].T)


@pytest.mark.parametrize("robot", ["panda", "ur5", "ur10"])
def test_masses_and_weights_are_those_of_pinocchio(robot: str, cases: dict[str, Any]) -> None:
    pin = pytest.importorskip("pinocchio", reason="pin is not installed")
    row = next(row for row in cases["rows"] if row["robot"] == robot)
    arm = arm_of(row, cases)
    oracle = pin.buildModelFromUrdf(str(robots() / row["source"].split()[1]))
    oracle.gravity.linear = np.array([0.0, 0.0, -9.80665])
    data = oracle.createData()
    frame = oracle.getFrameId(row["link"])
    draws = np.random.default_rng(8)
    count = 340
    poses = draws.uniform(-1.5, 1.5, (count, len(arm.joint_names)))
    poses[:, [name not in arm.free_joints for name in arm.joint_names]] = 0.0
    along, rates = draws.normal(size=(count, 3)), draws.normal(size=(count, len(arm.free_joints)))
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    place = {"link": row["link"], "check_limits": False}
    masses = arm.mass_matrix(poses, check_limits=False)
    weights = arm.gravity_torques(poses, check_limits=False)
    along_normal = arm.effective_mass(poses, direction=along, **place).mass
    mobility = arm.mobility(poses, **place)
    free = [index for index, name in enumerate(oracle.names[1:]) if name in arm.free_joints]
    every = np.zeros((count, len(arm.joint_names)))
    every[:, [name in arm.free_joints for name in arm.joint_names]] = rates
    velocity = arm.velocity(poses, every, **place)
    for index in range(count):
        values = np.array(
            [dict(zip(arm.joint_names, poses[index], strict=True)).get(name, 0.0) for name in oracle.names[1:]]
        )
        upper = pin.crba(oracle, data, values)
        expected = (np.triu(upper) + np.triu(upper, 1).T)[np.ix_(free, free)]
        assert np.allclose(masses[index], expected, rtol=0, atol=1e-12 * np.abs(expected).max())
        holding = pin.computeGeneralizedGravity(oracle, data, values)[free]
        assert np.allclose(-weights[index], holding, rtol=0, atol=1e-12 * max(1.0, np.abs(holding).max()))
        jacobian = pin.computeFrameJacobian(oracle, data, values, frame, pin.LOCAL_WORLD_ALIGNED)[:3, free]
        directional = 1.0 / (along[index] @ jacobian @ np.linalg.solve(expected, jacobian.T @ along[index]))
        # Rounding grows with the condition of the matrices.
        worse = np.linalg.cond(expected) * 1e-16 + 1e-12
        assert along_normal[index] == pytest.approx(directional, rel=worse)
        # Along the motion, worst normal, all kinetic energy.
        speed = np.linalg.norm(velocity[index])
        unit = velocity[index] / speed
        lowest = 1.0 / (unit @ mobility[index] @ unit)
        worst = unit @ np.linalg.solve(mobility[index], unit)
        most = rates[index] @ masses[index] @ rates[index] / speed**2
        assert lowest <= worst * (1.0 + 1e-9)
        assert worst <= most * (1.0 + 1e-9)


def test_an_inertia_that_is_repaired_lowers_no_mass() -> None:
    pin = pytest.importorskip("pinocchio", reason="pin is not installed")
    draws = np.random.default_rng(9)
    text = """<robot name="r"><link name="o"/><link name="a"><inertial><origin xyz="0.2 0.1 0"/><mass value="3"/>
    <inertia ixx="{}" ixy="0" ixz="0" iyy="{}" iyz="0" izz="{}"/></inertial></link><link name="b"><inertial>
    <origin xyz="0.1 0 0.1"/><mass value="2"/><inertia ixx=".02" ixy="0" ixz="0" iyy=".02" iyz="0" izz=".02"/>
    </inertial></link><joint name="one" type="continuous"><parent link="o"/><child link="a"/><axis xyz="0 0 1"/></joint>
    <joint name="two" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0.4 0 0" rpy="0.3 0.2 0"/>
    <axis xyz="0 1 0"/></joint></robot>"""
    for _ in range(50):
        least, middle = draws.uniform(0.01, 0.1, 2)
        moments = (least, middle, (least + middle) * draws.uniform(1.0, 1.2))
        given = text.format(*draws.permutation(moments))
        arm = arms.Arm.from_urdf(given)
        oracle = pin.buildModelFromXML(given)
        data = oracle.createData()
        frame = oracle.getFrameId("b")
        turns, along = draws.uniform(-3.0, 3.0, 2), draws.normal(size=3)
        along /= np.linalg.norm(along)
        # Continuous joints are cosine and sine there.
        values = np.stack([np.cos(turns), np.sin(turns)], axis=1).ravel()
        pin.framesForwardKinematics(oracle, data, values)
        point = data.oMf[frame].act(np.array([0.2, 0.1, 0.3]))
        whole = pin.computeFrameJacobian(oracle, data, values, frame, pin.LOCAL_WORLD_ALIGNED)
        away = point - data.oMf[frame].translation
        jacobian = whole[:3] + np.cross(whole[3:].T, away).T
        upper = pin.crba(oracle, data, values)
        masses = np.triu(upper) + np.triu(upper, 1).T
        before = 1.0 / (along @ jacobian @ np.linalg.solve(masses, jacobian.T @ along))
        found = arm.effective_mass(turns, link="b", point=(0.2, 0.1, 0.3), direction=along, check_limits=False).mass
        assert found >= before * (1.0 - 1e-9)
