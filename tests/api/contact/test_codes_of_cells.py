"""Codes that turn the row of a cell to not checked, each lifted by a confirmation and listed; the handed over parts."""

from __future__ import annotations

import json
import os
import tomllib
from pathlib import Path
from typing import Any

import pytest

from hrsafety import arms, contact
from hrsafety.errors import InvalidParameterError

_SHARED = Path(os.environ.get("HRSAFETY_SHARED", Path(__file__).resolve().parents[4] / "shared"))
CASES: dict[str, Any] = json.loads((_SHARED / "spec" / "program_cases.json").read_text(encoding="utf-8"))
EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
MOTORS = {"turn": 1.2, "shoulder": 1.2, "elbow": 1.0, "wrist_1": 0.3, "wrist_2": 0.3, "wrist_3": 0.3}


def toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{json.dumps(name)} = {toml(each)}" for name, each in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def cell_of(folder: Path, change: dict[str, Any], **more: Any) -> Path:
    """Write the example with motors, changed at dotted keys; a list is entered by name or place."""
    given = tomllib.loads((EXAMPLES / "contact_arm.toml").read_text(encoding="utf-8"))
    given["robot"]["armature"] = dict(MOTORS)
    given["robot"]["urdf"] = str(EXAMPLES / given["robot"]["urdf"])
    for path, value in change.items():
        *way, last = path.split(".")
        at = given
        for part in way:
            at = next(each for each in at if each.get("name") == part) if isinstance(at, list) else at[part]
        if value is None:
            del at[last]
        else:
            at[last] = value
    given |= more | {"draws": 1000}
    place = folder / "cell.toml"
    place.write_text("\n".join(f"{name} = {toml(value)}" for name, value in given.items()), encoding="utf-8")
    return place


def verdicts(path: Path) -> list[dict[str, Any]]:
    return contact.study(path).verdicts


@pytest.mark.parametrize("case", CASES["cells"], ids=lambda case: case["code"])
def test_codes_of_the_specification(case: dict[str, Any], tmp_path: Path) -> None:
    change, rows = dict(case["change"]), case["rows"]
    if rows.startswith("hand_finger"):
        # The pad itself, not the area that the example gives the finger.
        change["contacts"] = [{"region": "hand_finger", "speed": 0.1}]
    chosen = [
        each
        for each in verdicts(cell_of(tmp_path, change))
        if rows in (each["contact"], each["region"]) or rows.startswith(each["region"])
    ]
    assert chosen
    if "coverings.pad.thickness" in change:
        chosen = [each for each in chosen if each["covering"] == "pad"]
    for row in chosen:
        assert case["code"] in row["doubts"]
        assert row["verdict"] != "within_limits"


URDF = arms.Arm.example().urdf
GREEN: dict[str, Any] = {
    "speed": 0.02,
    "robot": {
        "urdf": "arm.urdf",
        "link": "tool",
        "direction": [1.0, 0.0, 0.0],
        "poses": [{"shoulder": 0.4, "elbow": 1.4}],
        "armature": MOTORS,
        "payload": {"link": "tool", "mass": 0.5},
    },
    "coverings": [
        {
            "name": "pad",
            "material": {"law": "gibson_ashby", "E": 3e5, "plateau": 15e3, "e_D": 0.9},
            "thickness": 0.02,
            "area": 4e-3,
        }
    ],
    "contacts": [{"region": "chest", "contact": "quasi_static", "covering": "pad"}],
    "drive": {"reaction_time": 0.02, "deceleration": 8.0},
}


def changed(given: dict[str, Any], change: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(json.dumps(given))
    for path, value in change.items():
        *way, last = path.split(".")
        at: Any = found
        for part in way:
            at = at[int(part)] if isinstance(at, list) else at.setdefault(part, {})
        if value is None:
            del at[last]
        else:
            at[last] = value
    return found


def judged(folder: Path, given: dict[str, Any], urdf: str = URDF) -> dict[str, Any]:
    (folder / "arm.urdf").write_text(urdf, encoding="utf-8")
    place = folder / "cell.toml"
    place.write_text("\n".join(f"{name} = {toml(value)}" for name, value in given.items()), encoding="utf-8")
    found = contact.study(place)
    assert len(found.verdicts) == 1
    return found.verdicts[0] | {"all": found.fields}


@pytest.mark.parametrize(
    ("code", "change"),
    [
        ("drive_not_given", {"drive": None}),
        ("drive_not_given", {"drive": {"model": "none"}}),
        ("no_motor_inertia", {"robot.armature": None}),
        ("tool_without_mass", {"robot.payload": None}),
        ("armature_suspicious", {"robot.armature": 5e-5, "robot.robot_mass": "directional"}),
        ("mass_below_type_plate", {"robot.type_plate_mass": 40.0}),
        ("moving_mass_small", {"robot.type_plate_mass": 80.0}),
        ("covering_larger_than_part", {"contacts.0.region": "hand_finger", "coverings.0.area": 5e-3}),
        ("implausible", {"coverings.0.thickness": 0.5}),
        ("implausible", {"robot.payload": {"link": "tool", "mass": 1.0, "center": [0.0, 0.0, 60.0]}}),
        ("implausible", {"drive.reaction_time": 20.0, "speed": 1e-4}),
        ("probability", {"uncertain": {"robot_mass": {"lognormal": 0.9}}, "draws": 2000, "speed": 0.13}),
    ],
)
def test_a_code_turns_a_green_cell_and_a_confirmation_turns_it_back(
    code: str, change: dict[str, Any], tmp_path: Path
) -> None:
    assert judged(tmp_path, GREEN)["verdict"] == "within_limits"
    row = judged(tmp_path, changed(GREEN, change))
    assert (row["verdict"], code in row["doubts"]) == ("not_checked", True)
    assert row["all"]["doubts"][code] == 1
    lifted = changed(GREEN, change | {"confirmed": dict.fromkeys(row["doubts"], "measured on 2026-03-02, N. N.")})
    row = judged(tmp_path, lifted)
    assert (row["verdict"], code in row["confirmed"]) == ("within_limits", True)
    assert code in row["all"]["confirmed"]
    assert f"confirmed: {code.replace('_', ' ')}" in [each["name"] for each in row["all"]["annex"]["assumptions"]]


def test_sources_of_masses_reach_the_cell(tmp_path: Path) -> None:
    own = judged(tmp_path, GREEN)["all"]["robot"]
    plate = judged(tmp_path, changed(GREEN, {"robot.type_plate_mass": 30.0, "robot.mass_source": "type_plate"}))
    assert plate["all"]["robot"]["iso_mass"] == 15.0 + 0.5
    scaled = judged(tmp_path, changed(GREEN, {"robot.type_plate_mass": 30.0, "robot.mass_source": "scaled"}))
    assert scaled["all"]["robot"]["total_mass"] == pytest.approx(30.0)
    rolling = {"robot.base": "omni", "robot.base_mass": 60.0}
    found = judged(tmp_path, changed(GREEN, rolling))["all"]["robot"]
    assert found["held_mass"] == pytest.approx(own["directional_mass"])
    assert found["directional_mass"] <= found["held_mass"]
    assert found["iso_mass"] == pytest.approx(0.5 * (own["total_mass"] + 60.0) + 0.5)
    for change, words in (
        ({"robot.mass_source": "scaled"}, "robot.type_plate_mass"),
        ({"robot.base": "omni"}, "robot.base_mass"),
        ({"robot.base_mass": 3.0}, "robot.base_mass"),
        ({"robot.base": "rail"}, "robot.base"),
        ({"robot.link_masses": {arms.Arm.example().moved_links[1]: 1.0}}, "link_masses"),
    ):
        with pytest.raises(InvalidParameterError, match=words):
            judged(tmp_path, changed(GREEN, change))


@pytest.mark.parametrize(
    ("rule", "mass", "doubted"), [("directional", 60.0, True), ("larger", 60.0, False), ("iso", 1.0, False)]
)
def test_a_base_that_may_be_held_is_doubted_where_that_is_heavier(
    rule: str, mass: float, doubted: bool, tmp_path: Path
) -> None:
    change = {"robot.base": "omni", "robot.base_mass": mass, "robot.robot_mass": rule}
    row = judged(tmp_path, changed(GREEN, change))
    assert ("base_may_be_held" in row["doubts"]) == doubted
    robot = row["all"]["robot"]
    assert (robot["held_mass"] > robot["mass"]) == (doubted or rule == "iso")


def test_links_without_inertials_have_given_masses(tmp_path: Path) -> None:
    start = URDF.index("<inertial>", URDF.index('<link name="forearm"') if '<link name="forearm"' in URDF else 0)
    end = URDF.index("</inertial>", start) + len("</inertial>")
    name = URDF[URDF.rindex('<link name="', 0, start) + len('<link name="') :].split('"')[0]
    bare = URDF[:start] + URDF[end:]
    given = changed(GREEN, {"robot.link_masses": {name: 4.0}, "robot.robot_mass": "directional"})
    row = judged(tmp_path, given, bare)
    assert "estimated_inertia" in row["doubts"]
    iso = judged(tmp_path, changed(given, {"robot.robot_mass": "iso"}), bare)
    assert "estimated_inertia" not in iso["doubts"]


def test_joint_torques_are_a_push_limit(tmp_path: Path) -> None:
    torques = dict.fromkeys(MOTORS, 2.0)
    row = judged(tmp_path, changed(GREEN, {"drive": {"model": "push_limit", "joint_torques": torques}}))
    push = row["all"]["robot"]["push_limit"]
    arm = arms.Arm.example(armature=MOTORS, payload=GREEN["robot"]["payload"])
    alone = contact.push_limit_of_torques(
        arm, {"shoulder": 0.4, "elbow": 1.4}, torques, link="tool", direction=(1.0, 0.0, 0.0)
    )
    assert push == pytest.approx(alone)
    assert row["drive"]["static_force"] == pytest.approx(push)


def test_plan_annex_and_distances_are_handed_over(tmp_path: Path) -> None:
    more = {
        "separation": {
            "max_speed": 1.0,
            "reaction_time": 0.12,
            "deceleration": 2.5,
            "intrusion": 0.2,
            "uncertainty": 0.1,
        },
        "annex": {
            "maker": "Example Ltd",
            "robot_class": {"mass": 18.4, "speed": 1.0, "force": 150.0, "limited_by": "settings"},
            "assumptions": [{"name": "payload", "held_by": "tool coding, PL d", "verified": "test 7"}],
            "hazards": [{"hazard": "hand below the tool", "contact": "clamped", "measures": "pad"}],
        },
    }
    fields = judged(tmp_path, changed(GREEN, more))["all"]
    (row,) = fields["plan"]
    assert (row["spring"], row["limit"], row["setup"]) == (25000.0, 140.0, "clamped")
    assert row["prediction"] == fields["verdicts"][0]["drive"]["peak_force"]
    annex = fields["annex"]
    assert annex["maker"] == "Example Ltd"
    assert annex["robot_class"] == {"result": "II", "reasons": ["mass", "speed", "force", "capability"]}
    (payload,) = [each for each in annex["assumptions"] if each["name"] == "payload"]
    assert (payload["held_by"], payload["verified"], payload["value"]) == (
        "tool coding, PL d",
        "test 7",
        "at most 0.5 kg",
    )
    assert fields["distances"]["stop"] == pytest.approx(1.452)
    assert fields["distances"]["contact_speed"] == fields["verdicts"][0]["allowed_speed"]
    with pytest.raises(InvalidParameterError, match=r"annex\.makr"):
        judged(tmp_path, changed(GREEN, {"annex": {"makr": "x"}}))


def test_a_plan_is_filled_by_measurements() -> None:
    def row(**more: Any) -> contact.PlannedMeasurement:
        given: dict[str, Any] = {"place": "tool", "region": "chest", "contact": "quasi_static", "speed": 0.2}
        return contact.PlannedMeasurement(**(given | {"spring": 25e3, "limit": 140.0} | more))

    plan = contact.MeasurementPlan(rows=[row(), row(), row(), row(), row(repetitions=5), row(limit=None)])
    cases = [case for case in CASES["acceptance"]]
    filled = plan.filled({index: case["values"] for index, case in enumerate(cases)}, device_uncertainty=4.0)
    filled = filled.filled({4: [100.0, 101.0, 102.0], 5: [1.0, 2.0, 3.0]})
    words = [each.accept for each in filled.rows]
    assert words == ["accept", "inside uncertainty", "reject", "too few", "too few", "no limit"]
    columns = filled.columns()
    assert columns["measured_1"].tolist()[:2] == [121.0, 131.0]
    assert columns["expanded_uncertainty"].tolist()[0] == pytest.approx(cases[0]["expanded_uncertainty"], rel=1e-9)
    assert [each.accept for each in plan.rows] == [""] * 6
    with pytest.raises(InvalidParameterError, match="measured"):
        plan.filled({9: [1.0]})
