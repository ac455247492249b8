"""Cells made of objects: the same study as of their file, and nothing wrong gets in."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import arms, contact, standards
from hrsafety.contact.cell.study import numbers_of
from hrsafety.errors import HrsafetyError, InvalidParameterError

FILE = """
limits = "iso_ts_15066_2016"
speed = 0.2
contact_area = 1e-4
covering = "pad"
[robot]
mass = 8.0
[[coverings]]
name = "pad"
material = { law = "linear", E = 2e5 }
thickness = 0.02
area = 4e-3
max_strain = 0.4
[[contacts]]
region = "chest"
[[contacts]]
region = "hand_finger"
contact = "transient"
contact_area = 4e-4
[separation]
max_speed = 1.5
reaction_time = 0.1
deceleration = 3.0
intrusion = 0.2
uncertainty = 0.1
[uncertain]
robot_mass = { lognormal = 0.1 }
"""
LIMITS = standards.limits()
PAD = contact.Covering(material=contact.Linear(modulus=2e5), thickness=0.02, area=4e-3)
HAND = LIMITS.contact("hand_finger", "transient")


def planned(region: str, kind: str, **more: Any) -> contact.PlannedContact:
    return contact.PlannedContact(limit=LIMITS.contact(region, kind), speed=0.2, covering="pad", **more)


def made(**more: Any) -> contact.Cell:
    values: dict[str, Any] = {
        "robot": contact.ContactRobot.of_mass(8.0),
        "contacts": [
            planned("chest", "quasi_static", area=1e-4),
            planned("chest", "transient", area=1e-4),
            planned("hand_finger", "transient", covered_area=4e-4, area=1e-4),
        ],
        "coverings": {"pad": PAD},
        "strains": {"pad": 0.4},
        "separation": dict(max_speed=1.5, reaction_time=0.1, deceleration=3.0, intrusion=0.2, uncertainty=0.1),
        "uncertain": {"robot_mass": {"lognormal": 0.1}},
        "draws": 2000,
    }
    return contact.Cell(**(values | more))


def test_a_cell_of_objects_is_judged_as_its_file(tmp_path: Path) -> None:
    path = tmp_path / "cell.toml"
    path.write_text("draws = 2000\n" + FILE, encoding="utf-8")
    of_file, of_objects = contact.study(path), contact.study(made())
    assert json.dumps(numbers_of(of_file.fields)) == json.dumps(numbers_of(of_objects.fields))
    assert of_file.warnings == of_objects.warnings
    assert of_objects.verdict == "not_checked"  # a drive that pushes on exceeds the limits of the clamped chest
    assert [row["verdict"] for row in of_objects.verdicts] == ["not_checked", "within_limits", "within_limits"]


def test_a_study_is_a_table() -> None:
    found = contact.study(made())
    columns = found.columns()
    assert columns["region"].tolist() == ["chest", "chest", "hand_finger"]
    assert columns["allowed_speed_m_per_s"].tolist() == [row["allowed_speed"] for row in found.verdicts]
    assert columns["doubts"].tolist()[0] == ", ".join(found.verdicts[0]["doubts"]) == "drive_not_given"
    head = contact.PlannedContact(limit=LIMITS.contact("face", "transient"), speed=0.1)
    columns = contact.study(made(contacts=[head], uncertain={})).columns()
    assert columns["verdict"].tolist() == ["not_permitted"]
    assert math.isnan(columns["margin_m_per_s"][0])


def test_robots_of_objects_are_doubted_as_those_of_files() -> None:
    arm = contact.ContactRobot.of_arm(arms.Arm.example(), link="tool", samples=50)
    assert "no_motor_inertia" in [each.code for each in arm.warnings]
    assert arm.poses == 50
    base = contact.DifferentialBase(mass=20.0, inertia=0.8, offset=0.05)
    robot = contact.ContactRobot.of_base(base, point=(0.2, 0.1), normal=(0.8, 0.6))
    assert robot.mass == base.effective_mass((0.2, 0.1), (0.8, 0.6))
    assert [each.code for each in robot.warnings] == ["no_motor_inertia"]
    light = contact.study(made(robot=contact.ContactRobot.of_mass(0.01), uncertain={}))
    assert {row["verdict"] for row in light.verdicts} == {"not_checked"}


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("contacts", [], "contacts must be 1 to 64 planned contacts"),
        ("contacts", [HAND], r"contacts\[0\] must be a PlannedContact"),
        ("coverings", {}, r"contacts\[0\].covering must name a covering"),
        ("coverings", {"pad": None}, r"coverings\['pad'\] must be a Covering"),
        ("coverings", dict.fromkeys(map(str, range(17)), PAD), "coverings must be at most 16"),
        ("robot", 8.0, "robot must be a ContactRobot"),
        ("human_speed", -0.1, "human_speed must be at least 0"),
        ("human_speed", math.nan, "human_speed must be"),
        ("separation", {"max_speed": 1.0}, "separation.reaction_time must be given"),
        ("confirmed", {"not_checked": "J. Doe"}, "confirmed.not_checked must be left out"),
        ("confirmed", {"edge": " "}, "confirmed.edge must say why"),
        ("allowed_chance", 1.0, "allowed_chance must be above 0 and below 1"),
        ("draws", 0, "draws must be"),
        ("seed", -1, "seed must be"),
        ("uncertain", None, "uncertain must be a mapping"),
    ],
)
def test_a_wrong_cell_is_refused(name: str, value: object, words: str) -> None:
    with pytest.raises(InvalidParameterError, match=words):
        made(**{name: value})


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"speed": 0.0}, "speed must be above 0"),
        ({"speed": 21.0}, "speed must be above 0 and at most 20"),
        ({"area": -1.0}, "contact_area must be above 0"),
        ({"covered_area": 0.0}, "covered_area must be above 0"),
        ({"limit": "chest"}, "limit must be a ContactLimit"),
    ],
)
def test_a_wrong_contact_is_refused(more: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidParameterError, match=words):
        contact.PlannedContact(**({"limit": HAND, "speed": 0.2} | more))


def test_a_contact_touches_no_more_of_a_covering_than_there_is(tmp_path: Path) -> None:
    assert made(contacts=[planned("chest", "transient", covered_area=4e-3)]).contacts[0].covered_area == 4e-3
    with pytest.raises(InvalidParameterError, match=r"contacts\[0\].contact_area must be at most the area of covering"):
        made(contacts=[planned("chest", "transient", covered_area=5e-3)])
    path = tmp_path / "cell.toml"
    path.write_text(FILE.replace("contact_area = 4e-4", "contact_area = 5e-3"), encoding="utf-8")
    with pytest.raises(InvalidParameterError, match=r"contacts\[1\].contact_area must be at most .* \(0.004\)"):
        contact.load_cell(path)


def test_an_area_of_its_own_is_refused_beside_a_covering_that_is_not_flat() -> None:
    pad = contact.Covering(material=contact.Linear(modulus=2e5), thickness=0.02, shape="sphere", radius=0.05)
    with pytest.raises(InvalidParameterError, match=r"contacts\[2\].contact_area must be left out"):
        made(coverings={"pad": pad})


@settings(max_examples=25, deadline=None)
@given(
    mass=st.floats(0.5, 200.0),
    speed=st.floats(0.01, 3.0),
    kind=st.sampled_from(standards.CONTACTS),
    region=st.sampled_from(LIMITS.regions),
    human=st.floats(0.0, 2.0),
)
def test_no_contact_is_within_limits_above_its_allowed_speed(
    mass: float, speed: float, kind: str, region: str, human: float
) -> None:
    each = contact.PlannedContact(limit=LIMITS.contact(region, kind), speed=speed, area=1e-3)
    try:
        found = contact.study(
            contact.Cell(robot=contact.ContactRobot.of_mass(mass), contacts=[each], human_speed=human)
        )
    except HrsafetyError as error:
        pytest.fail(str(error))
    row = found.verdicts[0]
    if row["verdict"] == "within_limits":
        assert row["allowed_speed"] >= speed
        assert not row["doubts"]
    elif row["verdict"] == "exceeds":
        assert row["allowed_speed"] < speed


def test_an_area_on_the_pad_is_not_that_of_the_bare_contact(tmp_path: Path) -> None:
    path = tmp_path / "cell.toml"
    verdicts = []
    for area in ("1e-4", "4e-4"):
        path.write_text(FILE.replace("contact_area = 4e-4", f"contact_area = {area}"), encoding="utf-8")
        hand = contact.study(path).fields["results"][2]
        verdicts.append({row["covering"]: row["speed_pressure"] for row in hand["rows"]})
    assert verdicts[0][None] == verdicts[1][None]
    assert verdicts[0]["pad"] != verdicts[1]["pad"]


@pytest.mark.parametrize(
    ("rules", "doubts"),
    [
        ({"height": 0.3}, []),
        ({"intrusion": 0.85}, []),
        ({"intrusion": 0.2}, ["intrusion_too_short"]),
        ({}, ["taken_as_zero"]),
    ],
)
def test_a_field_that_is_reached_over_is_told(rules: dict[str, float], doubts: list[str]) -> None:
    values = {"max_speed": 1.5, "reaction_time": 0.1, "deceleration": 3.0, "uncertainty": 0.1} | rules
    harmless = [planned("hand_finger", "transient", area=1e-4, covered_area=4e-4)]
    more: dict[str, Any] = {"contacts": harmless, "separation": values, "uncertain": {}}
    found = contact.study(made(**more))
    assert found.fields["speed_over_distance"]["doubts"] == doubts
    assert found.verdict == ("not_checked" if doubts else "within_limits")
    assert [each.code for each in found.warnings][-len(doubts) or len(found.warnings) :] == doubts
    confirmed = {"intrusion_too_short": "a laser curtain, J. Doe", "taken_as_zero": "J. Doe"}
    assert contact.study(made(**more, confirmed=confirmed)).verdict == "within_limits"
    # A cell that is made of another one keeps what was given.
    again = made(**more | {"separation": made(**more).separation})
    assert contact.study(again).fields["distances"] == found.fields["distances"]


def test_a_robot_that_is_slower_than_its_contacts_is_refused() -> None:
    values = {"max_speed": 0.19, "reaction_time": 0.1, "deceleration": 3.0, "height": 0.3, "uncertainty": 0.1}
    with pytest.raises(
        InvalidParameterError, match=r"separation.max_speed must be at least the speed of every contact"
    ):
        made(separation=values)


@pytest.mark.parametrize(("stiffness", "told"), [(100.0, True), (1e3, False), (1e5, False)])
def test_a_drive_in_another_unit_is_doubted(stiffness: float, told: bool) -> None:
    drive = contact.Drive(model="elastic", stiffness=stiffness, reaction_time=0.06, deceleration=8.0)
    assert any("drive.stiffness" in each.subject for each in drive.doubts) == told
    clamped = contact.study(made(contacts=[planned("chest", "quasi_static", area=1e-4)], drive=drive, uncertain={}))
    assert ("implausible" in clamped.fields["doubts"]) == told


@pytest.mark.parametrize(
    ("slip", "told"),
    [
        ({"model": "push_limit", "push_limit": 0.06}, "drive.push_limit"),
        ({"model": "push_limit", "push_limit": 6.0, "gravity": "acts", "weight": 0.08}, "drive.weight"),
        ({"reaction_time": 0.02, "deceleration": 20.0, "detection_force": 0.03}, "drive.detection_force"),
        ({"model": "push_limit", "push_limit": 6.0, "gravity": "acts", "weight": 0.0}, None),
        ({"reaction_time": 0.02, "deceleration": 20.0, "detection_force": 0.0}, None),
    ],
)
def test_forces_of_a_drive_in_kilonewtons_keep_no_limit(slip: dict[str, Any], told: str | None) -> None:
    drive = contact.Drive(**slip)
    assert [each.subject for each in drive.doubts] == ([told] if told else [])
    slow = replace(planned("chest", "quasi_static", area=1e-4), speed=0.02, covering=None)
    found = contact.study(made(contacts=[slow], drive=drive, uncertain={}, separation=None))
    assert found.verdict == ("not_checked" if told else "within_limits")


def test_a_drive_may_stop_at_once(tmp_path: Path) -> None:
    path = tmp_path / "cell.toml"
    path.write_text(
        'speed = 0.05\ncontact_area = 1e-4\n[robot]\nmass = 6.0\n[[contacts]]\nregion = "chest"\n'
        "[drive]\nreaction_time = 0.02\ndeceleration = inf\n",
        encoding="utf-8",
    )
    found = contact.study(path)
    assert found.verdict == "within_limits"
    assert contact.load_cell(path).inputs["drive"]["deceleration"] == "unbounded"


def test_the_worst_of_few_drawn_poses_is_no_bound() -> None:
    arm = arms.Arm.example(armature=0.5, payload=arms.Payload("tool", 1.0))
    for samples, told in ((1, True), (999, True), (1000, False)):
        robot = contact.ContactRobot.of_arm(arm, link="tool", samples=samples)
        (found,) = [each for each in robot.warnings if each.code == "few_poses"] or (None,)
        assert (found is not None) == told
        assert found is None or not found.safe_side
    one = contact.ContactRobot.of_arm(arm, link="tool", poses=[[0.0, 0.4, 1.4, 0.0, 0.0, 0.0]])
    assert not [each for each in one.warnings if each.code == "few_poses"]


@pytest.mark.parametrize(
    ("load", "at", "told"),
    [([0.0, 10.0], 0.0, True), ([0.0, 10.0], 5.0, False), ([2.0], None, True), ([0.0, 1.0], 0.5, False)],
)
def test_stops_with_less_than_the_payload_are_told(load: list[float], at: float | None, told: bool) -> None:
    arm = arms.Arm.example(armature=0.5, payload=arms.Payload("tool", 5.0))
    robot = contact.ContactRobot.of_arm(arm, link="tool", poses=[[0.0, 0.4, 1.4, 0.0, 0.0, 0.0]])
    table = {"speed": [0.0, 0.5], "time": [[0.0] * len(load), [0.1] * len(load)], "load": load}
    table["distance"] = [[0.0] * len(load), [0.03] * len(load)]
    stops = standards.StoppingData(**table)
    drive = contact.Drive(reaction_time=0.02, stopping=stops, load=at)
    slow = replace(planned("chest", "quasi_static", area=1e-4), speed=0.02, covering=None)
    found = contact.study(made(robot=robot, contacts=[slow], drive=drive, uncertain={}, separation=None))
    assert found.verdicts[0]["doubts"] == (["lighter_load"] if told else [])
    rules = {"max_speed": 0.5, "reaction_time": 0.1, "height": 0.3, "uncertainty": 0.1, "stopping": table}
    rules |= {} if at is None else {"load": at}
    free = replace(planned("chest", "transient", area=1e-4), covering=None)
    found = contact.study(made(robot=robot, contacts=[free], uncertain={}, separation=rules))
    assert ("lighter_load" in [each.code for each in found.warnings]) == told
    assert found.verdict == ("not_checked" if told else "within_limits")
