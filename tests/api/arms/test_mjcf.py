"""Arms of MuJoCo's files: masses as MuJoCo has them, doubts, and what an arm does not hold."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from hrsafety import arms, program
from hrsafety.arms.mjcf import is_mjcf
from hrsafety.errors import InvalidParameterError, MissingExtraError

mujoco = pytest.importorskip("mujoco")

BODY = '<body name="{0}" pos="{1}" euler="{2}">{3}{4}</body>'
JOINT = '<joint name="{0}" type="{1}" axis="{2}" pos="{3}" armature="{4}" range="{5}"/>'
INERTIAL = '<inertial mass="{0}" pos="{1}" euler="{2}" diaginertia="{3}"/>'


def words(values: object) -> str:
    return " ".join(f"{each:.6g}" for each in np.ravel(values))


def chain(seed: int, equality: str = "") -> str:
    """Return a random arm with shifted joints, two of them in one body."""
    draw = np.random.default_rng(seed)
    inner = ""
    for place in reversed(range(4)):
        joints = ""
        for number in range(2 if place == 1 else 1):
            kind = "slide" if place == 2 else "hinge"
            axis, anchor = draw.normal(size=3), draw.uniform(-0.1, 0.1, 3) * (place > 0)
            joints += JOINT.format(f"j{place}{number}", kind, words(axis), words(anchor), 0.1 * place, "-1 1")
        size = draw.uniform(0.8, 1.0, 3) * 0.02
        own = INERTIAL.format(
            draw.uniform(1, 4), words(draw.uniform(-0.1, 0.1, 3)), words([0.2, 0.4, 0.6]), words(size)
        )
        euler = f"0 {0.5 * np.pi!r} 0" if place == 3 else words(draw.uniform(-1.5, 1.5, 3))
        inner = BODY.format(f"b{place}", words(draw.uniform(-0.3, 0.3, 3)), euler, joints + own, inner)
    return (
        f'<mujoco model="chain"><compiler angle="radian"/><worldbody>{inner}</worldbody>'
        f"<equality>{equality}</equality></mujoco>"
    )


@pytest.mark.parametrize("seed", range(5))
def test_masses_are_those_of_mujoco(seed: int) -> None:
    text = chain(seed)
    arm = arms.Arm.from_urdf(text)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    assert arm.joint_names == tuple(model.joint(each).name for each in range(model.njnt))
    assert arm.total_mass == pytest.approx(model.body_mass.sum(), rel=1e-12)
    # Two joints of one body have nothing between them.
    assert {each.code for each in arm.warnings} <= {"no_motor_inertia", "armature_suspicious", "link_without_mass"}
    draw = np.random.default_rng(seed + 100)
    for _ in range(5):
        pose, point, direction = draw.uniform(-0.9, 0.9, model.nq), draw.uniform(-0.2, 0.2, 3), draw.normal(size=3)
        data.qpos[:] = pose
        mujoco.mj_forward(model, data)
        body = model.body("b3").id
        place = data.xpos[body] + data.xmat[body].reshape(3, 3) @ point
        jacobian, full = np.zeros((3, model.nv)), np.zeros((model.nv, model.nv))
        mujoco.mj_jac(model, data, jacobian, None, place, body)
        full = mass_matrix(model, data, full)
        unit = direction / np.linalg.norm(direction)
        expected = 1.0 / (unit @ jacobian @ np.linalg.solve(full, jacobian.T) @ unit)
        found = arm.effective_mass(pose, link="b3", point=point, direction=direction)
        assert arm.position(pose, link="b3", point=point) == pytest.approx(place, abs=1e-12)
        assert float(found) == pytest.approx(expected, rel=1e-9)


def mass_matrix(model: object, data: object, full: np.ndarray) -> np.ndarray:
    """Return the mass matrix by accelerations: each is what a unit of acceleration asks of the joints."""
    for place in range(full.shape[0]):
        data.qvel[:] = 0.0
        data.qacc[:] = 0.0
        mujoco.mj_inverse(model, data)
        still = data.qfrc_inverse.copy()
        data.qacc[place] = 1.0
        mujoco.mj_inverse(model, data)
        full[:, place] = data.qfrc_inverse - still
    return full


def test_one_motor_inertia_for_all_joints_of_a_file_is_doubted_unless_others_are_given() -> None:
    link = "<body name='{0}'><joint name='j{0}' axis='0 0 1' armature='{1}'/><inertial pos='0.2 0 0' mass='1' "
    link += "diaginertia='0.02 0.02 0.02'/>{2}</body>"

    def doubts(*armature: float, **options: object) -> list[str]:
        inner = ""
        for number, value in enumerate(armature):
            inner = link.format(number, value, inner)
        arm = arms.Arm.from_urdf(f"<mujoco><worldbody>{inner}</worldbody></mujoco>", **options)  # type: ignore[arg-type]
        return [each.message for each in arm.warnings if "stable simulation" in each.message]

    assert len(doubts(0.1, 0.1, 0.1)) == 1
    assert doubts(0.1, 0.1, 0.2) == doubts(0.1, 0.1) == doubts(0.1, 0.1, 0.1, armature=0.3) == []


def test_motors_of_the_file_are_taken_unless_others_are_given() -> None:
    text = chain(1)
    assert dict(arms.Arm.from_urdf(text).armature)["j30"] == pytest.approx(0.3)
    assert dict(arms.Arm.from_urdf(text, armature={"j30": 0.7}).armature) == {"j30": 0.7}


def test_joints_that_follow_others() -> None:
    text = chain(2, '<joint joint1="j30" joint2="j00" polycoef="0.1 -0.5 0 0 0"/>')
    arm = arms.Arm.from_urdf(text)
    assert "j30" not in arm.joint_names
    assert len(arm.joint_names) == 4


def test_masses_of_shapes_filled_with_water_are_doubted() -> None:
    body = '<body name="b"><joint name="j" axis="0 0 1"/><geom type="box" size=".1 .1 .1" pos=".2 0 0"{0}/></body>'
    text = f"<mujoco><worldbody>{body}</worldbody></mujoco>"
    doubts = [each for each in arms.Arm.from_urdf(text.format("")).warnings if each.code == "density"]
    assert len(doubts) == 1
    assert not doubts[0].safe_side
    for given in (' mass="3"', ' density="2700"'):
        assert "density" not in {each.code for each in arms.Arm.from_urdf(text.format(given)).warnings}


@pytest.mark.parametrize(
    ("inside", "message"),
    [
        ('<body name="b"><freejoint/><geom size=".1"/></body>', "be a hinge or a slide"),
        ('<body name="b"><joint type="ball"/><geom size=".1"/></body>', "be a hinge or a slide"),
        ('<body name="b"><joint name="j" ref="0.5"/><geom size=".1"/></body>', "joint j: ref must be 0"),
        ("<body><joint/></body>", "MJCF that MuJoCo compiles"),
        ("<nothing/>", "MJCF that MuJoCo compiles"),
    ],
)
def test_what_an_arm_does_not_hold_is_refused(inside: str, message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        arms.Arm.from_urdf(f"<mujoco><worldbody>{inside}</worldbody></mujoco>")
    loop = chain(3, '<connect body1="b3" body2="b0" anchor="0 0 0"/>')
    with pytest.raises(InvalidParameterError, match="equality 1 must be lines of two joints"):
        arms.Arm.from_urdf(loop)


def test_without_mujoco_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(MissingExtraError, match=r"pip install hrsafety\[mjcf\]"):
        arms.Arm.from_urdf(chain(0))


def test_a_program_of_an_arm_of_mujoco(tmp_path: Path) -> None:
    (tmp_path / "arm.xml").write_text(chain(4), encoding="utf-8")
    (tmp_path / "task.toml").write_text(
        '[robot]\nurdf = "arm.xml"\n[motion]\nvelocity = 1.0\nacceleration = 4.0\n'
        '[[moves]]\nkind = "joint"\nto = [0.0, 0.0, 0.0, 0.0, 0.0]\n[[moves]]\nkind = "joint"\nto = { j00 = 0.5 }\n'
        '[[points]]\nname = "tip"\nlink = "b3"\narea = 4e-4\n'
        '[[segments]]\nfrom = "move 1"\nto = "move 2"\nregions = ["chest"]\nclamped = false\nreason = "open"\n',
        encoding="utf-8",
    )
    study = program.load_program(tmp_path / "task.toml").report(intervals=200)
    assert study.free.time == pytest.approx(0.75, rel=1e-3)


def test_comments_before_the_root_are_read_once() -> None:
    comments = "<?xml version='1.0'?>\n" + "<!-- a -->\n" * 1000
    assert not is_mjcf(f"{comments}<robot/>")
    assert not is_mjcf("<!-- <mujoco> --><robot/>")
    assert is_mjcf(f"{comments}<!DOCTYPE mujoco>\n<mujoco/>")
