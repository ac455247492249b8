"""Masses along motions of real arms against pinocchio, to 1e-9, and one below the other."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import _hrsafety, arms

POSES = 1000
BODY = 4.4  # kg
ROBOTS = {
    "ur5": ("ur_description/urdf/ur5_robot.urdf", "tool0"),
    "xarm7": ("xarm_description/urdf/xarm7.urdf", "link_eef"),
    "z1": ("z1_description/urdf/z1.urdf", "gripperMover"),
}


def masses(arm: arms.Arm, link: str, point: np.ndarray, poses: np.ndarray, rates: np.ndarray) -> dict[str, Any]:
    none: dict[str, Any] = {name: np.zeros(0) for name in ("energy", "body_mass", "human_speed", "speed")}
    none |= {name: np.zeros(0) for name in ("first", "last")}
    none |= {name: np.zeros(0, dtype=np.int64) for name in ("point", "table")}
    rule = {"rule": "larger", "direction": "worst", "iso_mass": 10.0}
    contact = _hrsafety.ProgramContact(
        arm._native, links=[link], points=point[np.newaxis], limits=none, tables=[], **rule
    )
    found: dict[str, Any] = contact.masses(poses, rates, body_masses=np.array([BODY]), check_limits=False)
    return found


@pytest.mark.filterwarnings("ignore::hrsafety.plausibility.HrsafetyWarning")  # what is doubtful in these files
@pytest.mark.parametrize("name", list(ROBOTS))
def test_masses_of_real_arms(name: str) -> None:
    pin = pytest.importorskip("pinocchio", reason="pin and example-robot-data are not installed")
    spec = find_spec("pinocchio")
    assert spec is not None
    assert spec.origin is not None
    prefix = next(parent for parent in Path(spec.origin).parents if parent.name == "cmeel.prefix")
    file, link = ROBOTS[name]
    path = prefix / "share" / "example-robot-data" / "robots" / file
    model = pin.buildModelFromUrdf(str(path))
    arm = arms.Arm.from_urdf(path, armature=0.3)
    model.armature = np.full(model.nv, 0.3)
    assert list(model.names)[1:] == list(arm.joint_names)
    data, frame = model.createData(), model.getFrameId(link)
    random = np.random.default_rng(48)
    poses, rates = random.uniform(-1.5, 1.5, (2, POSES, model.nv))
    point = np.array([0.05, -0.02, 0.1])
    found = masses(arm, link, point, poses, rates)
    along, worst, energy = (found[f"mass_{kind}"][:, 0] for kind in ("along_motion", "worst_normal", "energy"))
    assert (along <= worst).all()
    assert (worst <= energy).all()
    for index in range(0, POSES, 20):
        jacobian = pin.computeFrameJacobian(model, data, poses[index], frame, pin.LOCAL_WORLD_ALIGNED)
        lever = data.oMf[frame].rotation @ point
        jacobian = jacobian[:3] + np.cross(jacobian[3:].T, lever).T
        upper = pin.crba(model, data, poses[index])
        inertia = np.triu(upper) + np.triu(upper, 1).T
        mobility = jacobian @ np.linalg.solve(inertia, jacobian.T)
        velocity = jacobian @ rates[index]
        speed = np.linalg.norm(velocity)
        unit = velocity / speed
        assert found["speed"][index, 0] == pytest.approx(speed, rel=1e-12)
        assert along[index] == pytest.approx(1 / (unit @ mobility @ unit), rel=1e-9)
        assert worst[index] == pytest.approx(unit @ np.linalg.solve(mobility, unit), rel=1e-9)
        assert energy[index] == pytest.approx(rates[index] @ inertia @ rates[index] / speed**2, rel=1e-9)
        body = unit @ np.linalg.solve(mobility + np.eye(3) / BODY, unit)
        assert found["reduced_worst_normal"][index, 0, 0] == pytest.approx(body, rel=1e-9)
