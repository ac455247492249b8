"""Programs against numbers that were computed two ways."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from api.program.chains import chain, example, motion_of
from hrsafety import program, standards
from hrsafety.program.exposures import native_contact

_SHARED = Path(os.environ.get("HRSAFETY_SHARED", Path(__file__).resolve().parents[4] / "shared"))
CASES: dict[str, Any] = json.loads((_SHARED / "spec" / "program_cases.json").read_text(encoding="utf-8"))
SLOWER = 0.002
"""Share by which a retimed path may be slower than the closed form at 4,000 intervals."""


def limits(case: dict[str, Any]) -> dict[str, Any]:
    """Return the limits of the joints of a case."""
    return {name: np.atleast_1d(case[name]) for name in ("velocity", "acceleration")}


def check_time(found: program.Retimed, case: dict[str, Any]) -> None:
    assert found.status == "verified"
    assert found.largest_share <= 1.0 + 1e-6
    assert case["time"] * (1.0 - 1e-9) <= found.time <= case["time"] * (1.0 + SLOWER)


@pytest.mark.parametrize("case", [case for case in CASES["retime_closed"] if case["kind"] == "straight"])
def test_straight_moves(case: dict[str, Any]) -> None:
    arm = chain(len(case["move"]))
    motion = motion_of(arm, [[0.0] * len(case["move"]), case["move"]], **limits(case))
    check_time(motion.retimed(intervals=4000), case)


def test_a_slow_part_of_a_path() -> None:
    case = next(case for case in CASES["retime_closed"] if case["kind"] == "slow_zone")
    motion = motion_of(chain(1), [[0.0], case["move"]], **limits(case)).refined(4000)
    nodes = motion.curve.nodes / motion.curve.length * case["move"][0]
    middles = 0.5 * (nodes[:-1] + nodes[1:])
    first, last = case["zone"]
    caps = np.where((middles > first) & (middles < last), case["zone_speed"], np.inf)
    check_time(motion.retimed(path_speed=caps), case)


def test_a_corner_stops_and_a_blend_does_not() -> None:
    case = next(case for case in CASES["retime_closed"] if case["kind"] == "corner_stop")
    poses = [[0.0, 0.0], case["first"], np.add(case["first"], case["second"]).tolist()]
    check_time(motion_of(chain(2), poses, **limits(case)).retimed(intervals=4000), case)
    (case,) = CASES["retime_blend"]
    found = motion_of(chain(2), poses, [0.0, case["blend"]], **limits(case)).retimed(intervals=4000)
    assert found.time == pytest.approx(case["time"], rel=case["tolerance"])
    assert found.status == "verified"


def test_a_turn_with_a_limit_of_speed_at_the_tip() -> None:
    case = next(case for case in CASES["retime_closed"] if case["kind"] == "turning_2r")
    arm = chain(2, [case["l1"], case["l2"]])
    both = {name: [case[name]] * 2 for name in ("velocity", "acceleration")}
    motion = motion_of(arm, [[0.0, case["q2"]], [case["turn"], case["q2"]]], **both)
    everywhere = [(case["contact_speed"], -np.inf, np.inf)]
    contact = native_contact(arm, [], [], tcp=("link2", (case["l2"], 0.0, 0.0)), speeds=everywhere)
    found = motion.retimed(contact, intervals=4000)
    check_time(found, case)
    assert np.sqrt(found.squared_speed.max()) == pytest.approx(case["joint_speed"], rel=1e-6)


@pytest.mark.parametrize("case", CASES["retime_spline"])
def test_splines_through_waypoints(case: dict[str, Any]) -> None:
    motion = program.ArmMotion.from_waypoints(chain(6), case["waypoints"], knots=case["knots"], **limits(case))
    found = motion.retimed(intervals=4000)
    assert found.time == pytest.approx(case["time"], rel=case["tolerance"])
    assert found.time >= case["toppra_time"] * (1.0 - 1e-3)
    assert found.status == "verified"


@pytest.mark.parametrize("case", CASES["planar"])
def test_masses_of_planar_arms(case: dict[str, Any]) -> None:
    about = case["input"]
    arm = chain(2, [about["l1"], about["l2"]], [about["m_elbow"], about["m_tip"]])
    angle = about["q1"] + about["q2"] + about["phi_from_link2"]
    pose = np.array([[about["q1"], about["q2"]]])
    columns = [arm.velocity(pose, [rates], link="link2", point=(about["l2"], 0.0, 0.0))[0, :2] for rates in np.eye(2)]
    rates = np.linalg.solve(np.array(columns).T, [0.4 * np.cos(angle), 0.4 * np.sin(angle)])
    assert rates == pytest.approx(case["joint_rates_for_0_4_m_s"], rel=1e-9)
    contact = native_contact(arm, [], [], tcp=("link2", (about["l2"], 0.0, 0.0)))
    found = contact.masses(pose, rates[np.newaxis], body_masses=np.array([3.0]))
    assert found["speed"][0, 0] == pytest.approx(0.4, rel=1e-12)
    assert found["mass_along_motion"][0, 0] == pytest.approx(case["mass_along_motion"], rel=1e-9)
    assert found["mass_worst_normal"][0, 0] == pytest.approx(case["mass_worst_normal"], rel=1e-9)
    assert found["reduced_worst_normal"][0, 0, 0] == pytest.approx(case["reduced_worst_body_3kg"], rel=1e-9)
    assert found["mass_along_motion"][0, 0] <= found["mass_worst_normal"][0, 0] <= found["mass_energy"][0, 0] + 1e-9


# ---- the arm of examples along a straight line -----------------------------------------------------

(LINE,) = CASES["line"]
RULES = {
    "iso": ("iso", "motion"),
    "motion": ("directional", "motion"),
    "worst": ("directional", "worst"),
    "larger": ("larger", "motion"),
}


def line_task(rule: str) -> program.Program:
    """Return the program of the straight line with masses by a rule."""
    motion = program.ArmMotion.from_waypoints(example(), LINE["waypoints"], **limits(LINE))
    mass, direction = RULES[rule]
    free = {"clamped": False, "reason": "nothing behind"}
    return program.Program(
        motion=motion,
        points=[
            program.ContactPoint(name=f"point {place}", area=LINE["area"], **each)
            for place, each in enumerate(LINE["points"])
        ],
        segments=[
            program.Segment(start=0.0, end=1.0, regions=["hand_finger"]),
            program.Segment(start=0.0, end=1.0, regions=["chest"], **free),
        ],
        robot_mass=mass,
        direction=direction,
    )


def test_a_straight_line_of_the_example_arm() -> None:
    arm = example()
    start = arm.position(LINE["start"], link="tool")
    moves = [
        program.Move(kind="joint", to=LINE["start"]),
        program.Move(kind="linear", to=start + np.array(LINE["move"])),
    ]
    motion = program.ArmMotion.from_moves(arm, moves, **limits(LINE))
    length = motion.curve.length
    assert length == pytest.approx(np.linalg.norm(LINE["move"]), rel=1e-12)
    found = motion.curve.at(np.linspace(0.0, length, len(LINE["waypoints"])))[0]
    assert np.abs(found - LINE["waypoints"]).max() < 1e-8
    assert motion.warnings == ()


@pytest.mark.parametrize("rule", RULES)
def test_times_within_limits_of_contacts(rule: str) -> None:
    study = line_task(rule).report(intervals=LINE["intervals"])
    free, limited = study.times
    assert free.time == pytest.approx(LINE["time_robot_limits"], rel=LINE["tolerance_times"])
    assert limited.time == pytest.approx(LINE["time_contact"][rule], rel=LINE["tolerance_times"])
    assert {each.status for each in study.times} == {"verified"}


def test_masses_and_allowed_speeds_along_the_line() -> None:
    from hrsafety.program.runs import Runs

    runs = Runs(line_task("larger"), LINE["intervals"], None)
    rows, contact = runs.rows(runs.planned), runs.contact(runs.planned)
    places = np.linspace(0.0, 1.0, len(LINE["waypoints"]))
    joints, rates, _ = runs.motion.curve.at(places)
    masses = contact.masses(joints, rates, body_masses=np.zeros(0))
    allowed = contact.allowed(joints, rates, places, every=True)
    for expected in LINE["at"]:
        place = expected["waypoint"]
        point = next(index for index, each in enumerate(LINE["points"]) if each["link"] == expected["link"])
        assert masses["speed"][place, point] == pytest.approx(expected["path_speed"], rel=1e-9)
        for name in ("mass_along_motion", "mass_worst_normal", "mass_energy"):
            assert masses[name][place, point] == pytest.approx(expected[name], rel=1e-9), name
        for index, row in enumerate(rows):
            if row.point == point:
                name = f"{row.limit.region}/{row.limit.contact}"
                assert allowed["allowed"][place, index] == pytest.approx(expected["allowed"][name], rel=1e-9)
        governs = rows[int(allowed["governs"][place, point])]
        assert governs.label == expected["governs"]
        assert allowed["lowest"][place, point] == pytest.approx(expected["lowest"], rel=1e-9)


# ---- zones and scanner field -----------------------------------------------------------------------


@pytest.mark.parametrize("case", CASES["zones"])
def test_zones_are_the_fastest_ones(case: dict[str, Any]) -> None:
    from hrsafety import _hrsafety

    found = _hrsafety.program_zones(
        np.array(case["length"]), np.array(case["cap"]), count=case["zones"], step=case["step"]
    )
    assert found["status"] == "found"
    cells = [list(each) for each in zip(found["first"].tolist(), found["last"].tolist(), strict=True)]
    assert cells == [each["cells"] for each in case["found"]]
    assert found["speed"].tolist() == pytest.approx([each["speed"] for each in case["found"]])
    assert found["time"] == pytest.approx(case["time"], rel=1e-9)


@pytest.mark.parametrize("case", CASES["page1_separation"])
def test_two_distances_of_a_scanner_field(case: dict[str, Any]) -> None:
    rules = {name: case[name] for name in ("human_speed", "reaction_time", "deceleration", "intrusion", "uncertainty")}
    found = standards.field_distances(case["speed"], contact_speed=case["contact_speed"], **rules)
    assert found.stop == pytest.approx(case["stop"], rel=1e-9)
    assert found.slow_down == pytest.approx(case["slow_down"], rel=1e-9)
