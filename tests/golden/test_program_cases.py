"""Masses along a path, retimed motions and zones against the checked cases."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import _hrsafety, arms, contact, standards

TOLERANCE = 1e-9  # relative
INTERVALS = 4000
ABOVE = 0.002  # relative; times of 4,000 intervals above the closed form

LINK = """<link name="{name}"><inertial><origin xyz="{x} 0 0"/><mass value="{mass}"/><inertia ixx="0" ixy="0" ixz="0"
iyy="0" iyz="0" izz="0"/></inertial></link>"""
PLANAR = """<robot name="planar"><link name="base"/>{one}{two}
<joint name="j1" type="continuous"><parent link="base"/><child link="one"/><axis xyz="0 0 1"/></joint>
<joint name="j2" type="continuous"><parent link="one"/><child link="two"/><origin xyz="{l1} 0 0"/><axis xyz="0 0 1"/>
</joint></robot>"""


@pytest.fixture(scope="module")
def cases(shared: Path) -> dict[str, Any]:
    data: dict[str, Any] = json.loads((shared / "spec" / "program_cases.json").read_text(encoding="utf-8"))
    return data


def planar(l1: float, l2: float, m_elbow: float, m_tip: float) -> arms.Arm:
    one = LINK.format(name="one", x=l1, mass=m_elbow)
    two = LINK.format(name="two", x=l2, mass=m_tip)
    return arms.Arm.from_urdf(PLANAR.format(one=one, two=two, l1=l1))


def row(point: int = 0, **given: float) -> dict[str, float]:
    """Return a row of limits, without a limit where none is given."""
    values = {"energy": math.inf, "body_mass": math.inf, "human_speed": 0.0, "speed": math.inf, "table": -1}
    return {"point": point, **values, "first": -math.inf, "last": math.inf, **given}


def touching(arm: arms.Arm, points: list[tuple[str, list[float]]], rows: list[dict[str, float]], **rule: Any) -> Any:
    kinds = {"point": np.int64, "table": np.int64}
    limits = {name: np.array([each[name] for each in rows], dtype=kinds.get(name, float)) for name in row()}
    given = {"rule": "directional", "direction": "motion", "iso_mass": 1.0, **rule}
    places = np.array([place for _, place in points], dtype=float)
    links = [link for link, _ in points]
    return _hrsafety.ProgramContact(arm._native, links=links, points=places, limits=limits, tables=[], **given)


def line(*rows: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """Return straight legs between rows of joint values over their chords."""
    values = np.array(rows, dtype=float)
    lengths = np.linalg.norm(np.diff(values, axis=0), axis=1)
    coefficients = np.zeros((len(lengths), 4, values.shape[1]))
    coefficients[:, 0] = values[:-1]
    coefficients[:, 1] = np.diff(values, axis=0) / lengths[:, None]
    return np.concatenate([[0.0], np.cumsum(lengths)]), coefficients


def retimed(
    s: np.ndarray, coefficients: np.ndarray, parts: list[int], stops: list[int], **limits: Any
) -> dict[str, Any]:
    s, coefficients = _hrsafety.program_refine(s, coefficients, np.array(parts))
    for name in ("velocity", "acceleration"):
        limits[name] = np.array(limits[name], dtype=float)
    found = _hrsafety.program_retime(s, coefficients, stops=np.array(stops, dtype=np.int64), **limits)
    assert found["status"] == "verified"
    assert found["largest_share"] <= 1 + 1e-6
    assert found["time"] == found["t"][-1]
    return found


@pytest.mark.parametrize("index", range(5))
def test_masses_of_planar_arms(index: int, cases: dict[str, Any]) -> None:
    case = cases["planar"][index]
    given = case["input"]
    arm = planar(given["l1"], given["l2"], given["m_elbow"], given["m_tip"])
    tip = touching(arm, [("two", [given["l2"], 0.0, 0.0])], [])
    joints = np.array([[given["q1"], given["q2"]]])
    rates = np.array([case["joint_rates_for_0_4_m_s"]])
    found = tip.masses(joints, rates, body_masses=np.array([3.0]))
    assert found["speed"][0, 0] == pytest.approx(0.4, rel=TOLERANCE)
    angle = given["q1"] + given["q2"] + given["phi_from_link2"]
    assert found["velocity"][0, 0] == pytest.approx([0.4 * math.cos(angle), 0.4 * math.sin(angle), 0.0], abs=1e-11)
    assert found["mass_along_motion"][0, 0] == pytest.approx(case["mass_along_motion"], rel=TOLERANCE)
    assert found["mass_worst_normal"][0, 0] == pytest.approx(case["mass_worst_normal"], rel=TOLERANCE)
    assert found["reduced_worst_normal"][0, 0, 0] == pytest.approx(case["reduced_worst_body_3kg"], rel=TOLERANCE)


@pytest.mark.parametrize("index", range(6))
def test_closed_forms(index: int, cases: dict[str, Any]) -> None:
    case = dict(cases["retime_closed"][index])
    kind, expected = case["kind"], case["time"]
    limits = {name: np.atleast_1d(case[name]) for name in ("velocity", "acceleration")}
    parts, stops = [INTERVALS], []
    if kind in ("straight", "slow_zone"):
        s, coefficients = line([0.0] * len(case["move"]), case["move"])
        if kind == "slow_zone":
            middle = (np.arange(INTERVALS) + 0.5) / INTERVALS
            low, high = case["zone"]
            limits["path_speed"] = np.where((middle > low) & (middle < high), case["zone_speed"], np.inf)
    elif kind == "turning_2r":
        arm = planar(case["l1"], case["l2"], 1.0, 1.0)
        s, coefficients = line([0.0, case["q2"]], [case["turn"], case["q2"]])
        limits = {name: np.repeat(values, 2) for name, values in limits.items()}
        limits["contact"] = touching(arm, [("two", [case["l2"], 0.0, 0.0])], [row(speed=case["contact_speed"])])
    else:
        assert kind == "corner_stop"
        first, second = np.array(case["first"]), np.array(case["second"])
        s, coefficients = line([0.0, 0.0], first, first + second)
        parts, stops = [INTERVALS // 2] * 2, [INTERVALS // 2]
    found = retimed(s, coefficients, parts, stops, **limits)
    assert expected * (1 - TOLERANCE) <= found["time"] <= expected * (1 + ABOVE)
    if kind == "turning_2r":
        speed = np.sqrt(found["x"][INTERVALS // 2])
        assert speed == pytest.approx(case["joint_speed"], rel=1e-6)
        assert found["reason"][INTERVALS // 2] == 2


def test_blend(cases: dict[str, Any]) -> None:
    (case,) = cases["retime_blend"]
    first, second, blend = np.array(case["first"]), np.array(case["second"]), case["blend"]
    along, across = (each / np.linalg.norm(each) for each in (first, second))
    before, after = np.linalg.norm([first, second], axis=1) - blend
    coefficients = np.zeros((3, 4, 2))
    coefficients[0, 1] = along
    # A quadratic curve with its middle control point in the corner, over a length of two blends.
    coefficients[1, :3] = [first - blend * along, along, (across - along) / (4 * blend)]
    coefficients[2, :2] = [first + blend * across, across]
    s = np.cumsum([0.0, before, 2 * blend, after])
    limits = {name: case[name] for name in ("velocity", "acceleration")}
    found = retimed(s, coefficients, [1600, 1600, 800], [], **limits)
    assert found["time"] == pytest.approx(case["time"], rel=case["tolerance"])


@pytest.mark.parametrize("index", range(2))
def test_splines(index: int, cases: dict[str, Any]) -> None:
    case = cases["retime_spline"][index]
    knots = np.array(case["knots"])
    coefficients = _hrsafety.program_spline(knots, np.array(case["waypoints"]))
    limits = {name: case[name] for name in ("velocity", "acceleration")}
    found = retimed(knots, coefficients, [INTERVALS // 5] * 5, [], **limits)
    assert found["time"] == pytest.approx(case["time"], rel=1e-4)
    assert found["time"] == pytest.approx(case["toppra_time"], rel=case["tolerance"])


class Line:
    """An arm with a payload on a straight line, and the limits of its points."""

    def __init__(self, case: dict[str, Any]) -> None:
        load = case["payload"]
        payload = arms.Payload(load["link"], load["mass"], load["center"])
        self.case = case
        self.arm = arms.Arm.example(payload=payload, armature=case["armature"])
        assert list(self.arm.joint_names) == case["joints"]
        self.names = [name.split("/") for name in case["exposed"]]
        book = standards.limits()
        self.limits = [book.contact(region, kind) for region, kind in self.names]
        self.waypoints = np.array(case["waypoints"])
        self.knots = np.linspace(0.0, 1.0, len(self.waypoints))
        self.coefficients = _hrsafety.program_spline(self.knots, self.waypoints)

    def rows(self) -> list[dict[str, float]]:
        """Return a row for each point and limit, with the energy that mu v^2/2 gives for any mass."""
        found = []
        for point in range(len(self.case["points"])):
            for (_, kind), limit in zip(self.names, self.limits, strict=True):
                mass = math.inf if kind == "quasi_static" else limit.body_mass
                hit = contact.Contact(robot=2.0, body=limit, area=self.case["area"])
                reduced = 1 / (1 / 2.0 + 1 / mass)
                energy = reduced * hit.allowed_speed().speed ** 2 / 2
                found.append(row(point, energy=energy, body_mass=mass))
        return found

    def contact(self, rule: str) -> Any:
        rules = {"motion": ("directional", "motion"), "worst": ("directional", "worst")}
        rule, direction = rules.get(rule, (rule, "motion"))
        points = [(each["link"], each["point"]) for each in self.case["points"]]
        masses = {"rule": rule, "direction": direction, "iso_mass": self.case["iso_mass"]}
        return touching(self.arm, points, self.rows(), **masses)


@pytest.fixture(scope="module")
def on_line(cases: dict[str, Any]) -> Line:
    (case,) = cases["line"]
    return Line(case)


@pytest.mark.filterwarnings("ignore::hrsafety.plausibility.HrsafetyWarning")  # no drive is given
def test_masses_and_speeds_along_a_line(on_line: Line) -> None:
    case = on_line.case
    rates = np.vstack([on_line.coefficients[:, 1], np.zeros(6)])
    waypoints = sorted({each["waypoint"] for each in case["at"]})
    places = (on_line.waypoints[waypoints], rates[waypoints])
    all_rows = on_line.contact("larger")
    masses = all_rows.masses(*places, body_masses=np.array([np.inf]))
    speeds = all_rows.allowed(*places, on_line.knots[waypoints], every=True)
    for each in case["at"]:
        place = waypoints.index(each["waypoint"])
        point = case["points"].index({name: each[name] for name in ("link", "point")})
        assert masses["speed"][place, point] == pytest.approx(each["path_speed"], rel=TOLERANCE)
        for name in ("along_motion", "worst_normal", "energy"):
            assert masses[f"mass_{name}"][place, point] == pytest.approx(each[f"mass_{name}"], rel=TOLERANCE)
        allowed = speeds["allowed"][place].reshape(3, 3)[point]
        assert allowed == pytest.approx([each["allowed"][name] for name in case["exposed"]], rel=TOLERANCE)
        assert speeds["lowest"][place, point] == pytest.approx(each["lowest"], rel=TOLERANCE)
        governs = case["exposed"][speeds["governs"][place, point] - 3 * point]
        assert each["governs"].startswith(governs + "/")


@pytest.mark.filterwarnings("ignore::hrsafety.plausibility.HrsafetyWarning")  # no drive is given
def test_times_along_a_line(on_line: Line) -> None:
    case = on_line.case
    parts = [case["intervals"] // (len(on_line.waypoints) - 1)] * (len(on_line.waypoints) - 1)
    limits = {name: case[name] for name in ("velocity", "acceleration")}
    free = retimed(on_line.knots, on_line.coefficients, parts, [], **limits)
    assert free["time"] == pytest.approx(case["time_robot_limits"], rel=case["tolerance_times"])
    for rule, expected in case["time_contact"].items():
        found = retimed(on_line.knots, on_line.coefficients, parts, [], **limits, contact=on_line.contact(rule))
        assert found["time"] == pytest.approx(expected, rel=case["tolerance_times"])
        assert found["time"] >= free["time"]


@pytest.mark.parametrize("index", range(2))
def test_zones(index: int, cases: dict[str, Any]) -> None:
    case = cases["zones"][index]
    lengths, caps = np.array(case["length"]), np.array(case["cap"])
    found = _hrsafety.program_zones(lengths, caps, count=case["zones"], step=case["step"])
    assert found["status"] == "found"
    cells = np.stack([found["first"], found["last"]], axis=1)
    assert cells.tolist() == [each["cells"] for each in case["found"]]
    assert found["speed"] == pytest.approx([each["speed"] for each in case["found"]], rel=TOLERANCE)
    assert found["time"] == pytest.approx(case["time"], rel=TOLERANCE)
