"""Programs judged: verdicts, doubts, cycle times, zones, and what must hold of all of them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from api.program.chains import chain, example, motion_of, sines, task
from hrsafety import arms, contact, program, standards
from hrsafety.errors import InvalidParameterError

START = {"turn": -0.6, "shoulder": 0.35, "elbow": 1.45, "wrist_1": -0.23, "wrist_2": -1.5708, "wrist_3": 0.0}
DRIVE = {"model": "any_stiffness", "reaction_time": 0.02, "deceleration": 20.0}
FREE = {"clamped": False, "reason": "nothing stands behind"}
PAD = contact.Covering(
    material=contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9), thickness=0.02, shape="flat", area=4e-4
)


def turning(speed: float = 2.0) -> program.ArmMotion:
    """Return the motion of the example arm that turns by a radian."""
    arm = example()
    poses = [START, START | {"turn": 0.4}]
    moves = [program.Move(kind="joint", to=pose) for pose in poses]
    return program.ArmMotion.from_moves(arm, moves, velocity=speed, acceleration=4.0)


def segment(motion: program.ArmMotion, *regions: str, **more: Any) -> program.Segment:
    """Return a segment over the whole path."""
    names = list(motion.marks)
    ends = {"start": names[0], "end": names[-1]} if names else {"start": 0.0, "end": motion.curve.length}
    return program.Segment(regions=regions, **(ends | more))


def of(motion: program.ArmMotion, *segments: program.Segment, **more: Any) -> program.Program:
    return task(motion, segments=segments, **({"drive": contact.Drive(**DRIVE)} | more))


# ---- verdicts --------------------------------------------------------------------------------------


def test_a_slow_program_with_a_drive_keeps_its_limits() -> None:
    motion = turning(0.02)
    study = of(motion, segment(motion, "hand_finger")).report(intervals=200)
    assert study.verdict == "within_limits"
    assert study.warnings == ()
    assert {row.exposure.how for row in study.rows} == {"contact", "drive"}
    assert all(row.scale == 1.0 for row in study.rows)
    assert study.times[0].time == pytest.approx(study.times[1].time, rel=1e-9)


def test_no_clamped_limit_is_kept_without_a_drive_and_confirmed_lifts_the_doubt() -> None:
    motion = turning(0.02)
    of_hand = segment(motion, "hand_finger")
    study = of(motion, of_hand, drive=None).report(intervals=200)
    assert study.verdict == "not_checked"
    assert study.fields["doubts"] == {"drive_not_given": 1}
    words = {row.exposure.limit.contact: row.verdict for row in study.rows}
    assert words == {"quasi_static": "not_checked", "transient": "within_limits"}
    confirmed = of(motion, of_hand, drive=None, confirmed={"drive_not_given": "tests of 2026-03-02, J. Doe"})
    assert confirmed.report(intervals=200).verdict == "within_limits"


def test_head_is_not_permitted_and_allows_no_motion() -> None:
    motion = turning(0.02)
    study = of(motion, segment(motion, "face", **FREE)).report(intervals=200)
    assert study.verdict == "not_permitted"
    assert study.limited.status == "standstill"
    assert study.times[1].time is None
    assert study.segments[0].limited == math.inf
    assert study.plan.rows == ()


def test_parts_without_segment_are_not_checked() -> None:
    motion = motion_of(chain(2), [[0, 0], [0.5, 0.5], [1.0, 0.0]], velocity=0.01, acceleration=1.0)
    arm_point = [program.ContactPoint(name="tip", link="link2", area=1e-4)]
    part = program.Segment(start="move 1", end="move 2", regions=["chest"], **FREE)
    study = program.Program(motion=motion, points=arm_point, segments=[part]).report(intervals=200)
    assert study.verdict == "not_checked"
    assert "path_without_segment" in study.fields["doubts"]
    rest = program.Segment(start="move 3", end="move 3", regions=[], reason="behind the fence")
    whole = program.Program(motion=motion, points=arm_point, segments=[part, rest])
    assert whole.uncovered == 0.0
    codes = {each.code for each in whole.report(intervals=200).warnings}
    assert "path_without_segment" not in codes


def test_a_fillet_gives_an_area_with_a_doubt() -> None:
    motion = turning(0.02)
    rounded = [program.ContactPoint(name="edge", link="tool", radius=0.005)]
    study = of(motion, segment(motion, "chest", **FREE), points=rounded).report(intervals=200)
    row = study.rows[0]
    limit = standards.limits().contact("chest", "transient")
    assert row.exposure.area == pytest.approx(2 * math.pi * 0.005 * limit.force / limit.spring_constant)
    assert [each.code for each in row.doubts] == ["estimated_area"]
    assert study.verdict == "not_checked"


def test_without_an_area_the_pressure_is_not_checked() -> None:
    motion = turning(0.02)
    bare = [program.ContactPoint(name="edge", link="tool")]
    study = of(motion, segment(motion, "chest", **FREE), points=bare).report(intervals=200)
    assert study.verdict == "not_checked"
    assert "not_checked" in study.fields["doubts"]


def test_missing_motors_are_doubted_where_the_directional_mass_counts() -> None:
    moves = [program.Move(kind="joint", to=pose) for pose in (START, START | {"turn": 0.4})]
    arm = arms.Arm.example(payload=arms.Payload("tool", 2.0))
    motion = program.ArmMotion.from_moves(arm, moves, velocity=0.02, acceleration=4.0)
    free = segment(motion, "chest", **FREE)
    assert of(motion, free, robot_mass="directional").report(intervals=200).verdict == "not_checked"
    assert of(motion, free, robot_mass="iso").report(intervals=200).verdict == "within_limits"


def test_areas_are_named_with_or_without_their_side() -> None:
    motion = turning(0.02)
    study = of(motion, segment(motion, "back of the hand", **FREE)).report(intervals=200)
    assert study.rows[0].exposure.limit.region == "hand_finger"
    with pytest.raises(InvalidParameterError, match=r"segments\[0\].regions must name regions.*chset.*did you mean"):
        of(motion, segment(motion, "chset"))


def test_a_recorded_program_is_judged_by_its_own_speeds() -> None:
    time, joints = turning(0.2).retimed().sampled()
    for scale, verdict in ((1.0, "within_limits"), (0.05, "exceeds")):
        motion = program.ArmMotion.from_log(example(), time=scale * time, joints=joints, acceleration=4.0)
        part = program.Segment(start=0.0, end=scale * time[-1], regions=["chest"], **FREE)
        study = of(motion, part).report(intervals=200)
        assert study.verdict == verdict
        assert study.times[0].name == "as recorded"
        assert study.times[0].time == pytest.approx(scale * time[-1])
        assert study.fastest == pytest.approx(0.2 / scale * 0.874, rel=0.02)


# ---- what must hold --------------------------------------------------------------------------------


def test_order_of_cycle_times() -> None:
    motion = turning()
    zones = program.ZoneRules(deceleration=2.5, count=4, step=0.01)
    study = of(motion, segment(motion, "hand_finger"), zone_rules=zones, coverings={"pad": PAD}).report(intervals=400)
    times = {each.name: each.time for each in study.times}
    bare, padded = times["within limits of contacts, bare"], times["within limits of contacts, pad"]
    assert times["at robot limits"] <= padded < bare <= times["with typed zones"]
    assert study.zones.run.largest_share <= 1.0 + 1e-6
    assert sum(each.cost for each in study.segments) == pytest.approx(bare - times["at robot limits"])
    assert all(each.speed == pytest.approx(round(each.speed / 0.01) * 0.01) for each in study.zones.zones)


def test_zones_in_percent_of_the_speed_of_joints() -> None:
    motion = turning()
    rules = program.ZoneRules(deceleration=2.5, count=3, percent=1.0)
    study = of(motion, segment(motion, "chest", **FREE), zone_rules=rules).report(intervals=400)
    assert study.zones.status == "found"
    assert study.zones.percent
    assert all(0.0 < each.speed <= 100.0 for each in study.zones.zones)
    assert study.zones.run.time >= study.limited.time * (1.0 - 1e-9)
    coarse = program.ZoneRules(deceleration=2.5, count=3, percent=50.0)
    blocked = of(motion, segment(motion, "hand_finger"), zone_rules=coarse).report(intervals=400)
    assert blocked.zones.status == "not_permitted"
    assert blocked.times[-1].time is None


@pytest.mark.parametrize("seed", range(6))
def test_random_programs_keep_every_limit_and_more_exposure_never_shortens_them(seed: int) -> None:
    draw = np.random.default_rng(seed)
    arm = example()
    middle = np.array(list(START.values()))
    motion = program.ArmMotion.from_waypoints(
        arm, middle + 0.4 * sines(6, seed)[:5], velocity=[2.0, 2.0, 2.5, 3.0, 3.0, 3.0], acceleration=6.0
    )
    gripper = program.ContactPoint(name="gripper", link="tool", area=1e-4)
    elbow = program.ContactPoint(name="elbow", link="upper_arm", point=(0.0, -0.14, 0.6), area=4e-4)
    half = program.Segment(start=0.0, end=float(draw.uniform(0.3, 0.7)), regions=["chest"], **FREE)
    whole = program.Segment(start=0.0, end=1.0, regions=["chest"], **FREE)
    both = program.Segment(start=0.0, end=1.0, regions=["chest", "hand_finger"], **FREE)
    direction = ("motion", "worst")[seed % 2]
    tasks = [
        program.Program(motion=motion, points=points, segments=[part], direction=direction, robot_mass="directional")
        for points, part in (([gripper], half), ([gripper], whole), ([gripper], both), ([gripper, elbow], both))
    ]
    times = []
    for each in tasks:
        study = each.report(intervals=300)
        assert study.limited.status == "verified"
        assert study.limited.largest_share <= 1.0 + 1e-6
        times.append(study.limited.time)
    assert times == sorted(times)


@pytest.mark.parametrize("seed", range(4))
def test_finer_intervals_and_reversed_paths_take_as_long(seed: int) -> None:
    arm, poses = chain(6), sines(6, seed)
    limits = {"velocity": 2.0, "acceleration": 5.0}
    motion = program.ArmMotion.from_waypoints(arm, poses, **limits)
    time = motion.retimed(intervals=2000).time
    assert motion.retimed(intervals=4000).time == pytest.approx(time, rel=5e-3)
    back = program.ArmMotion.from_waypoints(arm, poses[::-1], **limits).retimed(intervals=2000).time
    assert back == pytest.approx(time, rel=1e-9)
    quick = program.ArmMotion.from_waypoints(arm, poses, velocity=1e3, acceleration=5.0).retimed().time
    quicker = program.ArmMotion.from_waypoints(arm, poses, velocity=1e3, acceleration=20.0).retimed().time
    assert quick == pytest.approx(2.0 * quicker, rel=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_moves_and_logs_take_as_long_backwards(seed: int) -> None:
    draw = np.random.default_rng(seed)
    poses = np.array(list(START.values())) + draw.uniform(-0.4, 0.4, (4, 6))
    blends = [0.0, *draw.choice([0.0, 0.05, 0.1], 2), 0.0]
    legs = [
        program.Move(kind="joint", to=dict(zip(START, pose, strict=True)), blend=blend)
        for pose, blend in zip(poses.tolist(), blends, strict=True)
    ]
    there, back = (
        program.ArmMotion.from_moves(example(), each, velocity=2.0, acceleration=4.0) for each in (legs, legs[::-1])
    )
    limited = [of(each, segment(each, "hand_finger")).report(intervals=400).limited.time for each in (there, back)]
    assert limited[1] == pytest.approx(limited[0], rel=1e-9)
    time, joints = there.retimed().sampled(0.02)
    logs = [
        program.ArmMotion.from_log(example(), time=instants, joints=values, acceleration=4.0).retimed(intervals=400)
        for instants, values in ((time, joints), (time[-1] - time[::-1], joints[::-1]))
    ]
    assert logs[1].time == pytest.approx(logs[0].time, rel=1e-9)


@pytest.mark.parametrize("seed", range(10))
def test_logs_keep_limits_of_joints_between_their_samples(seed: int) -> None:
    run = program.ArmMotion.from_waypoints(chain(4), sines(4, seed), velocity=1.5, acceleration=4.0).retimed()
    assert run.status == "verified"
    assert run.largest_share <= 1.0 + 1e-6
    time, joints = run.sampled(0.002)
    rates = np.abs(np.diff(joints, axis=0)) / np.diff(time)[:, np.newaxis]
    assert rates[:-1].max() <= 1.5 * (1.0 + 1e-6)
    gains = np.abs(np.diff(joints[:-1], n=2, axis=0)) / 0.002**2
    assert gains.max() <= 4.0 * (1.0 + 1e-3)


def test_toppra_finds_no_faster_way() -> None:
    toppra = pytest.importorskip("toppra")
    from toppra import algorithm, constraint

    toppra.setup_logging("ERROR")
    for seed in range(3):
        poses = sines(6, seed)
        path = toppra.SplineInterpolator(np.linspace(0.0, 1.0, len(poses)), poses, bc_type="not-a-knot")
        bounds = [
            constraint.JointVelocityConstraint(np.full((6, 2), [-2.0, 2.0])),
            constraint.JointAccelerationConstraint(
                np.full((6, 2), [-5.0, 5.0]), discretization_scheme=constraint.DiscretizationType.Interpolation
            ),
        ]
        oracle = algorithm.TOPPRA(bounds, path, gridpoints=np.linspace(0.0, 1.0, 1001), solver_wrapper="seidel")
        theirs = oracle.compute_trajectory(0.0, 0.0).duration
        motion = program.ArmMotion.from_waypoints(chain(6), poses, velocity=2.0, acceleration=5.0)
        ours = motion.retimed(intervals=2000).time
        assert theirs * (1.0 - 2e-3) <= ours <= theirs * 1.01


def test_a_worse_drive_or_a_smaller_area_is_never_faster() -> None:
    motion = turning()
    hand = segment(motion, "hand_finger")

    def time(area: float = 4e-4, **drive: Any) -> float:
        points = [program.ContactPoint(name="gripper", link="tool", area=area)]
        made = of(motion, hand, drive=contact.Drive(**(DRIVE | drive)), points=points)
        return made.report(intervals=200).limited.time

    usual = time()
    assert time(reaction_time=0.05) > usual
    assert time(deceleration=5.0) > usual
    assert time(detection_force=40.0) > usual
    assert time(area=2e-5) > usual


def test_stops_of_an_empty_gripper_do_not_hold_for_a_loaded_one() -> None:
    motion = turning(0.02)
    payload = motion.arm.payload_mass
    assert payload > 0.0
    loads = {"load": [0.0, 10.0], "time": [[0.0] * 2, [0.1] * 2], "distance": [[0.0] * 2, [0.03] * 2]}
    stops = standards.StoppingData(speed=[0.0, 0.5], **loads)
    for load, told in ((0.0, True), (payload, False)):
        drive = contact.Drive(reaction_time=0.02, stopping=stops, load=load)
        study = of(motion, segment(motion, "hand_finger"), drive=drive).report(intervals=200)
        assert [each.code for each in study.warnings] == (["lighter_load"] if told else [])
        assert study.verdict == ("not_checked" if told else "within_limits")


def test_a_person_who_walks_takes_the_speed_off() -> None:
    motion = turning()
    standing = of(motion, segment(motion, "chest", **FREE)).report(intervals=200)
    walking = of(motion, segment(motion, "chest", human_speed=0.1, **FREE)).report(intervals=200)
    assert walking.rows[0].allowed_speed == pytest.approx(standing.rows[0].allowed_speed - 0.1)
    running = of(motion, segment(motion, "chest", human_speed=5.0, **FREE)).report(intervals=200)
    assert running.limited.status == "standstill"
    assert running.verdict == "exceeds"


def test_the_plan_has_what_governs_in_each_segment() -> None:
    motion = turning()
    study = of(motion, segment(motion, "hand_finger", name="pick")).report(intervals=200)
    (row,) = study.plan.rows
    assert row.place == "pick, gripper"
    assert row.spring == 75e3
    assert row.speed == pytest.approx(study.rows[0].allowed_speed, rel=0.05)
    assert row.prediction <= 140.0 * (1.0 + 1e-3)
    assert row.limit == 140.0


def test_rates_of_a_covering_count_by_the_slower_neighbor() -> None:
    motion = turning()
    pad = contact.Covering(
        material=contact.Linear(modulus=2e5),
        thickness=0.02,
        area=4e-4,
        rate=(0.1, 0.0, 1.0),
        bottom=(0.6, 1e7),
    )
    part = segment(motion, "hand_finger", **FREE)
    points = [program.ContactPoint(name="gripper", link="tool", covering="pad")]
    study = of(motion, part, points=points, coverings={"pad": pad}).report(intervals=200)
    row = study.rows[0]
    mass = max(row.masses["mass_along_motion"], example().iso_mass)
    exact = contact.Contact(robot=mass, body=row.exposure.limit, covering=pad).allowed_speed().speed
    assert 0.93 * exact <= row.allowed_speed <= exact * (1.0 + 1e-9)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"points": []}, "points must name one point"),
        ({"points": [program.ContactPoint(name="a", link="hand")]}, r"points\[0\].link must be a link of the arm"),
        (
            {"points": [program.ContactPoint(name="a", link="base")]},
            r"points\[0\].link must be a link that a joint moves .*got 'base'",
        ),
        ({"points": [program.ContactPoint(name="a", link="tool", covering="pad")]}, r"points\[0\].covering must name"),
        ({"segments": []}, "segments must be 1 to"),
        ({"link": "nowhere"}, "link must be"),
        ({"tcp_speed": -1.0}, "tcp_speed must be above 0"),
        ({"robot_mass": "light"}, "robot_mass must be"),
        ({"direction": "up"}, "direction must be"),
        ({"confirmed": {"not_checked": "me"}}, "confirmed.not_checked must be left out"),
        ({"separation": {"reaction_time": 0.1}}, "separation.deceleration must be given"),
        ({"segments": [program.Segment(start="b", end="move 2", regions=["chest"])]}, r"segments\[0\].from must name"),
        ({"segments": [program.Segment(start=0.0, end=1.0, regions=["chest"])]}, r"segments\[0\].from must name"),
        (
            {"segments": [program.Segment(start="move 2", end="move 1", regions=["chest"])]},
            r"segments\[0\].to must lie",
        ),
    ],
)
def test_programs_that_are_refused(more: dict[str, Any], message: str) -> None:
    motion = turning()
    given = {"segments": [segment(motion, "chest")]} | more
    with pytest.raises(InvalidParameterError, match=message):
        task(motion, **given)


@pytest.mark.parametrize("kind", ["differential", "omni"])
def test_a_parked_base_that_rolls_away_is_lighter(kind: str) -> None:
    motors = dict(zip(START, [1.2, 1.2, 1.0, 0.3, 0.3, 0.3], strict=True))
    fixed = arms.Arm.example(armature=motors, base="fixed")
    rolling = arms.Arm.example(armature=motors, base=arms.RollingBase(kind=kind, mass=60.0, inertia=4.0))
    place = fixed.position(list((START | {"turn": -0.3}).values()), link="tool")
    moves = [
        program.Move(kind="joint", to=START),
        program.Move(kind="joint", to={"turn": -0.3}),
        program.Move(kind="linear", to=place - [0.0, 0.0, 0.1]),
    ]
    limits = {"velocity": dict.fromkeys(START, 1.0), "acceleration": dict.fromkeys(START, 4.0)}
    studies = []
    for arm in (fixed, rolling):
        motion = program.ArmMotion.from_moves(arm, moves, **limits)
        gripper = [program.ContactPoint(name="gripper", link="tool", area=1e-4)]
        part = program.Segment(start="move 1", end="move 3", regions=["chest"], **FREE)
        task = program.Program(motion=motion, points=gripper, segments=[part], robot_mass="directional")
        studies.append(task.report(intervals=300))
    held, free = studies
    assert free.free.time == pytest.approx(held.free.time, rel=1e-4)
    masses = [np.nanmean(each.columns()["mass_along_motion_kg"]) for each in studies]
    assert masses[1] < masses[0]
    assert free.limited.time < held.limited.time
    assert rolling.iso_mass == pytest.approx(fixed.iso_mass + 30.0 + 0.5 * (fixed.total_mass - fixed.moving_mass))
    row = max(free.fields["rows"], key=lambda each: each["mass_along_motion"])
    assert row["mass_if_base_stands"] >= row["mass_along_motion"]
