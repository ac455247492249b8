"""Paths of logs and moves: what they follow, where they stop, and what is refused."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from api.program.chains import chain, example, motion_of, sines
from hrsafety import arms, program
from hrsafety.errors import HrsafetyError, InvalidParameterError

POSE = {"turn": 0.0, "shoulder": 0.35, "elbow": 1.45, "wrist_1": -0.23, "wrist_2": -1.5708, "wrist_3": 0.0}


def log_of(motion: program.ArmMotion, step: float = 0.004) -> tuple[np.ndarray, np.ndarray]:
    """Return the joint log of a motion at the limits of its joints."""
    return motion.retimed().sampled(step)


def test_a_log_comes_back_as_it_was() -> None:
    arm = chain(3)
    motion = motion_of(arm, [[0.0] * 3, [1.0, 0.4, -0.3], [0.2, 1.0, 0.8]], [0.0, 0.2], velocity=1.5, acceleration=3.0)
    time, joints = log_of(motion)
    found = program.ArmMotion.from_log(arm, time=time, joints=joints, velocity=1.5, acceleration=3.0)
    assert found.residual <= 1e-3
    assert found.stops == ()
    assert found.retimed().time == pytest.approx(motion.retimed().time, rel=0.01)
    assert np.abs(found.curve.at(found.place)[0] - joints).max() <= 1e-3


def test_standstill_of_a_log_is_a_dwell() -> None:
    time = np.arange(0.0, 3.0, 0.004)
    ramp = 0.5 - 0.5 * np.cos(np.pi * np.clip(time, 0.0, 1.0))
    values = np.where(time < 1.5, ramp, 1.0 + 0.5 - 0.5 * np.cos(np.pi * np.clip(time - 1.5, 0.0, 1.0)))
    found = program.ArmMotion.from_log(
        chain(1), time=time, joints=values[:, np.newaxis], acceleration=1e3, velocity=100.0
    )
    assert len(found.dwells) == 3
    # The slow starts and ends of the ramps stand, too.
    assert found.dwells[1] == pytest.approx(0.5, abs=0.12)
    assert found.retimed().time < time[-1]
    assert found.place[0] == 0.0
    assert found.place[-1] == pytest.approx(found.curve.length)


@pytest.mark.parametrize("velocity", [3.0, 100.0, 1e3, 1e6])
def test_a_slow_part_is_followed_whatever_velocity_a_file_has(velocity: float) -> None:
    time = np.arange(0.0, 12.0, 0.01)
    slow, fast = (np.clip(each, 0.0, 1.0) for each in (time / 4.0, time / 1.5 - 4.0))
    ramp = 0.3 * (1.0 - np.cos(np.pi * slow)) + 0.75 * (1.0 - np.cos(np.pi * fast))
    joints = np.column_stack([ramp, 0.3 * np.sin(np.pi * slow) ** 2])
    found = program.ArmMotion.from_log(chain(2), time=time, joints=joints, velocity=velocity, acceleration=8.0)
    places = np.linspace(0.0, found.curve.length, 4000)
    apart = np.abs(joints[:, np.newaxis] - found.curve.at(places)[0]).max(axis=2).min(axis=1)
    assert apart.max() <= 5e-3
    # The robot stands for 2 s between both and for 4.5 s behind them.
    assert found.dwells[1] == pytest.approx(2.0, abs=0.3)
    assert found.dwells[2] == pytest.approx(4.5, abs=0.2)


def test_a_log_stops_where_it_turns_back() -> None:
    time = np.arange(0.0, 2.0, 0.004)
    values = 0.5 * np.sin(np.pi * time)[:, np.newaxis]
    found = program.ArmMotion.from_log(chain(1), time=time, joints=values, velocity=2.0, acceleration=10.0)
    assert len(found.stops) == 2
    assert found.curve.at(found.curve.nodes[list(found.stops)])[0] == pytest.approx(np.array([[0.5], [-0.5]]), abs=1e-3)


def test_noise_below_the_tolerance_makes_no_stops() -> None:
    time = np.arange(0.0, 2.0, 0.004)
    noise = 1e-4 * np.random.default_rng(0).standard_normal((len(time), 2))
    values = np.column_stack([time, 0.3 * time**2]) + noise
    found = program.ArmMotion.from_log(chain(2), time=time, joints=values, velocity=3.0, acceleration=10.0)
    assert found.stops == ()
    assert found.residual <= 1e-3


@pytest.mark.parametrize("seed", range(5))
def test_random_logs_are_followed(seed: int) -> None:
    arm = chain(4)
    motion = program.ArmMotion.from_waypoints(arm, sines(4, seed), velocity=1.0, acceleration=2.0)
    time, joints = log_of(motion, 0.01)
    found = program.ArmMotion.from_log(
        arm, time=time, joints=joints, velocity=1.0, acceleration=2.0, path_tolerance=1e-3
    )
    assert np.abs(found.curve.at(found.place)[0] - joints).max() <= 1e-3 * (1.0 + 1e-9)
    assert (np.diff(found.place) >= 0.0).all()


@pytest.mark.parametrize("decimal", [".", ","])
def test_logs_are_read_from_tables(tmp_path: Path, decimal: str) -> None:
    lines = ["zeit [ms];joint1 [deg];other;joint2"]
    lines += [f"{4.0 * k:.1f};{k:.3f};0;{0.001 * k:.4f}".replace(".", decimal) for k in range(60)]
    path = tmp_path / "log.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    found = program.ArmMotion.from_log(chain(2), path, acceleration=5.0)
    assert found.log.time[-1] == pytest.approx(59 * 0.004)
    assert found.log.joints[-1] == pytest.approx([np.radians(59.0), 0.059])
    assert len(found.log.sha256) == 64


GOOD = "time,joint1,joint2\n" + "".join(f"{0.01 * k:.2f},{0.01 * k:.3f},{0.02 * k:.3f}\n" for k in range(30))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            GOOD.replace("joint2", "wrist"),
            r"log.csv must have a column for each joint: joint2, got time, joint1, wrist",
        ),
        (GOOD.replace("0.29,0.290", "0.29,29.0"), r"log.csv, column joint1 must be within 7 rad.*degrees\?"),
        (GOOD.replace("0.20,0.200", "0.10,0.200"), r"line 22.*column of times must increase"),
        ("time,joint1,joint2\n0,0,0\n", r"log.csv, column of times must hold 3 to"),
    ],
)
def test_logs_that_are_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "log.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InvalidParameterError, match=message):
        program.ArmMotion.from_log(chain(2), path, acceleration=5.0)


def test_a_log_that_stands_is_refused() -> None:
    with pytest.raises(InvalidParameterError, match="hold a motion"):
        program.ArmMotion.from_log(chain(1), time=np.arange(50) * 0.01, joints=np.ones((50, 1)), acceleration=5.0)


# ---- moves -----------------------------------------------------------------------------------------


def test_linear_moves_keep_the_orientation_and_the_line() -> None:
    arm = example()
    start = arm.position(POSE, link="tool")
    target = start + np.array([0.1, -0.2, -0.15])
    moves = [program.Move(kind="joint", to=POSE), program.Move(kind="linear", to=target, name="go")]
    motion = program.ArmMotion.from_moves(arm, moves, acceleration=5.0)
    places = np.linspace(0.0, motion.curve.length, 333)
    joints = motion.curve.at(places)[0]
    line = start + np.outer(places / motion.curve.length, target - start)
    assert np.abs(arm.position(joints, link="tool") - line).max() < 1e-8
    axes = [arm.position(joints, link="tool", point=axis) - arm.position(joints, link="tool") for axis in np.eye(3)]
    assert max(np.abs(axis - axis[0]).max() for axis in axes) < 1e-7
    assert motion.marks["go"] == (0.0, motion.curve.length)


def test_moves_go_on_where_they_do_not_turn() -> None:
    arm = chain(2)
    straight = motion_of(arm, [[0.0, 0.0], [0.5, 0.5], [1.0, 1.0]], velocity=1.0, acceleration=2.0)
    assert straight.stops == ()
    turned = motion_of(arm, [[0.0, 0.0], [0.5, 0.5], [1.0, 1.01]], velocity=1.0, acceleration=2.0)
    assert len(turned.stops) == 1
    dwelt = [
        program.Move(kind="joint", to=[0.0, 0.0], dwell=0.1),
        program.Move(kind="joint", to=[0.5, 0.5], dwell=0.2),
        program.Move(kind="joint", to=[1.0, 1.0], dwell=0.3),
    ]
    found = program.ArmMotion.from_moves(arm, dwelt, velocity=1.0, acceleration=2.0)
    assert found.dwells == (0.1, 0.2, 0.3)
    run = found.retimed()
    assert run.time == pytest.approx(2 * (0.5 + 0.5) + 0.6, rel=1e-6)
    time, joints = run.sampled(0.01)
    assert (np.abs(joints[(time > 1.11) & (time < 1.29)] - 0.5) < 1e-9).all()
    assert joints[-1] == pytest.approx([1.0, 1.0])


def test_a_blend_keeps_the_tangents_and_both_halves_may_meet() -> None:
    arm = chain(2)
    motion = motion_of(arm, [[0, 0], [1, 0], [1, 1], [0, 1]], [0.0, 0.5, 0.5], velocity=1.0, acceleration=2.0)
    assert motion.stops == ()
    assert motion.curve.length == pytest.approx(3.0)
    ends = motion.curve.nodes[1:-1]
    before = np.searchsorted(motion.curve.nodes, ends) - 1
    for derivative in (0, 1):
        left = motion.curve.at(ends, before)[derivative]
        assert motion.curve.at(ends)[derivative] == pytest.approx(left, abs=1e-12)
    middle = motion.curve.at(np.array([1.0]))[0]
    assert middle[0] == pytest.approx([0.875, 0.125])
    assert motion.marks["move 2"] == (0.0, 1.0)


@pytest.mark.parametrize(
    ("moves", "message"),
    [
        ([{"to": [0, 0]}], "moves must be 2 to"),
        ([{"to": [0, 0]}, {"to": [0, 0]}], r"moves\[1\].to must lead somewhere"),
        ([{"to": {"joint1": 0.0}}, {"to": [1, 0]}], r"moves\[0\].to must hold every joint.*give joint2 in rad"),
        ([{"to": [0, 0]}, {"to": {"joint9": 1.0}}], r"moves\[1\].to must name joints of the arm.*joint9.*did you mean"),
        ([{"to": [0, 0]}, {"to": [1, 0], "blend": 0.6}, {"to": [1, 1]}], r"moves\[1\].blend must be at most half"),
        ([{"to": [0, 0]}, {"to": [1, 0], "blend": 0.1}], r"moves\[1\].blend must be left out of the last move"),
        ([{"to": [0, 0]}, {"to": [100, 0]}], r"moves\[1\].to"),
        ([{"to": [0, 0]}, {"to": [1, 0, 0]}], r"moves\[1\].to"),
        ([{"kind": "linear", "to": [0, 0, 0]}, {"to": [1, 0]}], r"moves\[0\].kind must be 'joint'"),
        ([{"to": [0, 0], "name": "a"}, {"to": [1, 0], "name": "a"}], r"moves\[1\].name"),
        ([{"to": [0.3, 0.5]}, {"kind": "linear", "to": [0.3, 0.0, 0.2]}], r"moves\[1\].to must stay.*no_solution"),
        ([{"to": [0.3, 0.5]}, {"kind": "linear", "to": [900.0, 0, 0]}], r"moves\[1\].to must be within 20 m.*mm"),
    ],
)
def test_moves_that_are_refused(moves: list[dict[str, object]], message: str) -> None:
    made = [program.Move(**({"kind": "joint"} | each)) for each in moves]  # type: ignore[arg-type]  # of a file
    with pytest.raises(HrsafetyError, match=message):
        program.ArmMotion.from_moves(chain(2), made, acceleration=2.0)


@pytest.mark.parametrize("joints", [2, 3])
def test_a_line_that_few_joints_cannot_draw_says_so(joints: int) -> None:
    """Three joints about one axis keep no orientation off their plane."""
    moves = [
        program.Move(kind="joint", to=[0.3, 0.5, 0.2][:joints]),
        program.Move(kind="linear", to=[0.3, 0.0, 0.2]),
    ]
    rule = rf"no_solution.*the arm has {joints} joints that move, and to keep an orientation on any line takes 6"
    with pytest.raises(HrsafetyError, match=rule):
        program.ArmMotion.from_moves(chain(joints), moves, acceleration=2.0)


def test_a_line_near_a_singular_pose_is_doubted() -> None:
    arm = example()
    pose = POSE | {"wrist_2": 1e-4}
    start = arm.position(pose, link="tool")
    moves = [program.Move(kind="joint", to=pose), program.Move(kind="linear", to=start + np.array([0.0, 0.0, -0.01]))]
    (doubt,) = program.ArmMotion.from_moves(arm, moves, acceleration=5.0).warnings
    assert doubt.code == "near_singular"
    assert not doubt.safe_side


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        ({"acceleration": 0.0}, "acceleration.joint1 must be above 0"),
        ({"acceleration": [1.0, np.nan]}, "acceleration.joint2"),
        ({"acceleration": {"joint1": 1.0}}, "acceleration.joint2 must be given"),
        ({"acceleration": {"joint1": 1.0, "joint2": 1.0, "elbow": 1.0}}, "acceleration must name joints of the arm"),
        ({"acceleration": 1.0, "velocity": np.inf}, "velocity.joint1 must be finite"),
        ({"acceleration": 1.0, "velocity": -1.0}, "velocity.joint1 must be finite and above 0"),
        ({"acceleration": None}, "acceleration must be given"),
    ],
)
def test_limits_of_joints_that_are_refused(limits: dict[str, object], message: str) -> None:
    with pytest.raises(InvalidParameterError, match=re.escape(message)):
        motion_of(chain(2), [[0, 0], [1, 1]], **limits)


def test_velocities_of_the_urdf_hold_where_none_are_given() -> None:
    assert motion_of(chain(2), [[0, 0], [1, 1]], acceleration=np.inf).velocity.tolist() == [2.0, 2.0]
    assert motion_of(chain(2), [[0, 0], [1, 1]], acceleration=np.inf).retimed().time == pytest.approx(0.5, rel=2e-3)
    arm = type(chain(2)).from_urdf(chain(2).urdf.replace(' velocity="2"', ""))
    with pytest.raises(InvalidParameterError, match=r"velocity must be given: the URDF has no limit.*joint1"):
        motion_of(arm, [[0, 0], [1, 1]], acceleration=1.0)


@pytest.mark.parametrize(
    ("step", "gain", "codes"),
    [
        (1.0, 4.0, ["coarse_log"]),
        (0.2, 4.0, ["coarse_log"]),
        (0.2, 0.5, []),
        (0.02, 4.0, []),
        (0.008, np.inf, []),
        (0.1, np.inf, ["coarse_log"]),
    ],
)
def test_logs_too_coarse_to_show_every_swing_are_doubted(step: float, gain: float, codes: list[str]) -> None:
    time = np.arange(0.0, 8.0 + 1e-9, step)
    poses = np.column_stack([0.25 * (1.0 - np.cos(np.pi * time / 4.0)), np.zeros(len(time))])
    motion = program.ArmMotion.from_log(chain(2), time=time, joints=poses, acceleration=gain, velocity=2.0)
    assert [each.code for each in motion.warnings if each.code == "coarse_log"] == codes
    assert not any(each.safe_side for each in motion.warnings)
    # The same samples with a jump of time among them: what happened in it nobody saw.
    jumped = np.where(time > 4.0, time + 2.0, time)
    late = program.ArmMotion.from_log(chain(2), time=jumped, joints=poses, acceleration=4.0, velocity=2.0)
    assert "coarse_log" in [each.code for each in late.warnings]


def test_logs_that_begin_in_motion_are_doubted() -> None:
    time = np.arange(0.0, 2.0, 0.004)
    poses = np.column_stack([0.5 - 0.5 * np.cos(np.pi * time / 2.0), np.zeros(len(time))])
    for cut, codes in ((slice(None), []), (slice(100, None), ["log_in_motion"]), (slice(None, 300), ["log_in_motion"])):
        motion = program.ArmMotion.from_log(chain(2), time=time[cut], joints=poses[cut], acceleration=4.0, velocity=2.0)
        assert [each.code for each in motion.warnings] == codes


@pytest.mark.parametrize(
    ("before", "after", "locked", "message"),
    [
        (
            'name="wrist_3" type="revolute">',
            'name="wrist_3" type="revolute"><mimic joint="turn"/>',
            None,
            "follow turn",
        ),
        (
            'name="wrist_3" type="revolute"',
            'name="wrist_3" type="fixed"',
            None,
            "not move: the joint is locked or fixed",
        ),
        ("", "", "wrist_3", "not move: the joint is locked or fixed"),
    ],
)
def test_joints_of_a_log_that_the_arm_holds_are_refused(
    tmp_path: Path, before: str, after: str, locked: str | None, message: str
) -> None:
    text = example().urdf.replace(before, after) if before else example().urdf
    arm = type(example()).from_urdf(text, locked=locked)
    names = example().joint_names
    time = np.arange(0.0, 1.0, 0.01)
    poses = np.tile([0.0, 0.35, 1.45, -0.23, -1.57, 0.0], (len(time), 1))
    for column, moved in ((0, True), (5, False)):
        joints = poses.copy()
        joints[:, column] = 0.1 - 0.1 * np.cos(np.pi * time)
        if moved and "mimic" in after:
            joints[:, 5] = joints[:, 0]
        rows = [",".join(f"{value:.6f}" for value in (one, *row)) for one, row in zip(time, joints, strict=True)]
        (tmp_path / "log.csv").write_text("\n".join([",".join(["time", *names]), *rows]), encoding="utf-8")
        if moved:
            assert program.ArmMotion.from_log(arm, tmp_path / "log.csv", acceleration=4.0, velocity=2.0).log is not None
        else:
            with pytest.raises(InvalidParameterError, match=f"log.csv, column wrist_3 must {message}"):
                program.ArmMotion.from_log(arm, tmp_path / "log.csv", acceleration=4.0, velocity=2.0)


@pytest.mark.parametrize(("far", "codes"), [(1.2, []), (60.0, ["implausible"])])
def test_degrees_of_joints_without_limits_are_doubted(far: float, codes: list[str]) -> None:
    free = arms.Arm.from_urdf(re.sub(r' (lower|upper)="[^"]*"', "", example().urdf.replace("revolute", "continuous")))
    start = dict.fromkeys(free.joint_names, 0.3)
    moves = [program.Move(kind="joint", to=start), program.Move(kind="joint", to={"elbow": far})]
    time = np.linspace(0.0, 4.0, 1001)
    swing = 0.5 * far * (1.0 - np.cos(0.5 * np.pi * time))
    found = (
        program.ArmMotion.from_moves(free, moves, acceleration=4.0),
        program.ArmMotion.from_waypoints(free, {"elbow": [0.0, 0.5 * far, far]}, acceleration=4.0),
        program.ArmMotion.from_log(free, time=time, joints={"elbow": swing}, acceleration=4.0, velocity=100.0),
    )
    for motion in found:
        assert [each.code for each in motion.warnings] == codes
        assert all("elbow is at 60 rad: degrees given for radians?" in each.message for each in motion.warnings)
