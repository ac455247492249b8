"""``hrsafety contact``: which doubts turn a verdict, what says so, and the exit code."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

pytest.importorskip("matplotlib")
pytest.importorskip("jinja2")

from api import contact_calls
from hrsafety import contact, standards
from hrsafety.cli import exit_codes, main
from hrsafety.cli.cell import pictures
from hrsafety.contact import load_cell
from hrsafety.contact.cell.study import verdicts_of
from hrsafety.errors import InvalidParameterError

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
GOOD = """
speed = 0.1
contact_area = 1e-4
covering = "pad"
[robot]
mass = 8.0
[[coverings]]
name = "pad"
material = { law = "gibson_ashby", E = 3e5, plateau = 15e3, e_D = 0.9 }
thickness = 0.02
area = 4e-3
[[contacts]]
region = "chest"
contact = "transient"
"""
CLAMPED = GOOD.replace('"transient"', '"quasi_static"')
STOP = """
[separation]
max_speed = 1.5
reaction_time = 0.1
deceleration = 3.0
intrusion = 0.85
uncertainty = 0.1
"""
DRIVE = """
[drive]
reaction_time = 0.1
deceleration = 3.0
"""
Judged = Callable[..., tuple[int, dict[str, Any], str]]


@pytest.fixture
def judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Judged:
    """Return a function that makes a report, without pictures, and returns exit code, JSON and page."""
    monkeypatch.chdir(tmp_path)
    # They take three quarters of the time, and nothing here looks at them.
    monkeypatch.setattr(pictures, "drawings", lambda *_: [])

    def made(cell: str, *options: str) -> tuple[int, dict[str, Any], str]:
        Path("cell.toml").write_text(cell, encoding="utf-8")
        code = main(["contact", "cell.toml", "--out", "report", *options])
        report = json.loads(Path("report/report.json").read_text(encoding="utf-8"))
        return code, report, Path("report/report.html").read_text(encoding="utf-8")

    return made


def test_within_limits_is_green_and_code_0(judged: Judged, capsys: pytest.CaptureFixture[str]) -> None:
    code, report, page = judged(GOOD)
    assert (code, report["verdict"], report["doubts"]) == (0, "within_limits", {})
    assert report["verdicts"][0]["doubts"] == report["verdicts"][0]["reasons"] == []
    assert 'class="text word good"' in page
    shown = capsys.readouterr()
    assert shown.err == ""
    assert shown.out.splitlines()[-1] == "passed  within limits: 1 of 1 contact"


@pytest.mark.parametrize(
    ("stop", "doubt"),
    [
        (STOP.replace("deceleration = 3.0", "deceleration = 3000"), "implausible"),
        (STOP.replace("uncertainty = 0.1\n", ""), "taken_as_zero"),
        (STOP, None),
    ],
)
def test_a_doubt_about_the_separation_distance_turns_the_verdict(
    stop: str, doubt: str | None, judged: Judged, capsys: pytest.CaptureFixture[str]
) -> None:
    code, report, page = judged(GOOD + stop + "human_speed = 1.6\n")
    said = capsys.readouterr().out.splitlines()[-1]
    if doubt is None:
        assert (code, report["verdict"], report["speed_over_distance"]["doubts"]) == (0, "within_limits", [])
    else:
        assert (code, report["verdict"], report["speed_over_distance"]["doubts"]) == (5, "not_checked", [doubt])
        assert said == f"NOT CHECKED  the separation distance is not checked ({doubt}); exit code 5"
    assert (f", not checked ({(doubt or '').replace('_', ' ')})" in page) == (doubt is not None)


@pytest.mark.parametrize(("speed", "word"), [("5.0", "exceeds")])
def test_what_exceeds_is_red_and_code_3(
    speed: str, word: str, judged: Judged, capsys: pytest.CaptureFixture[str]
) -> None:
    code, report, page = judged(GOOD.replace("speed = 0.1", f"speed = {speed}"))
    assert (code, report["verdict"]) == (exit_codes.FAILED_RUN, word)
    assert 'class="text word bad"' in page
    assert capsys.readouterr().out.splitlines()[-1] == "FAILED  exceeds: 1 of 1 contact; exit code 3"
    code, report, _ = judged(GOOD.replace('"chest"', '"face"'))
    assert (code, report["verdict"]) == (exit_codes.FAILED_RUN, "not_permitted")


DOUBTS = {
    "pad of 20 m": ("thickness = 0.02", "thickness = 20.0", "implausible"),
    "robot of 8 g": ("mass = 8.0", "mass = 0.008", "implausible"),
    "speed in km/s": ("speed = 0.1", "speed = 1e-4", "implausible"),
    "pad on a finger": ('"chest"', '"hand_finger"', "covering_larger_than_part"),
    "linear to 0.8": (
        '{ law = "gibson_ashby", E = 3e5, plateau = 15e3, e_D = 0.9 }',
        '{ law = "linear", E = 3e4 }',
        "linear_beyond_half",
    ),
    "bare without area": ('contact_area = 1e-4\ncovering = "pad"', "", "not_checked"),
    "edge": ("area = 4e-3", 'shape = "sphere"\nradius = 0.003', "edge"),
    "own uncertainty": ("[robot]", "[uncertain]\nrobot_mass = { lognormal = 0.99 }\n[robot]", "probability"),
    "few draws": ("[robot]", "draws = 50\n[uncertain]\nrobot_mass = { lognormal = 0.01 }\n[robot]", "probability"),
    "chance unknown": (
        "area = 4e-3",
        "area = 4e-3\ndamping = 100.0\n[uncertain]\nrobot_mass = { lognormal = 0.1 }",
        "probability",
    ),
}


@pytest.mark.parametrize("name", DOUBTS)
def test_a_doubt_on_the_unsafe_side_is_not_within_limits(
    name: str, judged: Judged, capsys: pytest.CaptureFixture[str]
) -> None:
    old, new, doubt = DOUBTS[name]
    assert old in GOOD
    cell = GOOD.replace(old, new, 1)
    if name == "own uncertainty":
        cell = cell.replace("speed = 0.1", "speed = 0.5")
    code, report, page = judged(cell)
    row = report["verdicts"][0]
    assert (code, report["verdict"], row["verdict"]) == (exit_codes.NOT_CHECKED, "not_checked", "not_checked")
    assert doubt in row["doubts"]
    assert report["doubts"][doubt] == 1
    assert row["allowed_speed"] > row["planned_speed"]
    assert 'class="text word unsure"' in page
    assert 'class="text word good"' not in page
    assert re.search(rf"Doubts:</strong> .*{doubt.replace('_', ' ')}", page)
    shown = capsys.readouterr()
    assert shown.out.splitlines()[-1].startswith("NOT CHECKED  not checked: 1 of 1 contact (")
    assert shown.err.startswith("hrsafety: warning: ")


def test_a_doubt_changes_nothing_of_what_exceeds(judged: Judged) -> None:
    code, report, _ = judged(GOOD.replace('"chest"', '"hand_finger"').replace("speed = 0.1", "speed = 5.0"))
    assert (code, report["verdict"]) == (exit_codes.FAILED_RUN, "exceeds")
    assert report["doubts"] == {"covering_larger_than_part": 1}


def test_doubts_of_an_arm_reach_the_verdict(judged: Judged) -> None:
    inertia = 'ixx="1e-7" iyy="1e-7" izz="1e-7" ixy="0" ixz="0" iyz="0"'
    Path("light.urdf").write_text(
        '<robot name="light"><link name="root"/><link name="arm">'
        f'<inertial><mass value="1e-6"/><inertia {inertia}/></inertial></link>'
        '<joint name="turn" type="continuous"><parent link="root"/><child link="arm"/><axis xyz="0 0 1"/></joint>'
        "</robot>"
    )
    arm = 'urdf = "light.urdf"\nlink = "arm"\npoint = [0.5, 0.0, 0.0]\ndirection = [0.0, 1.0, 0.0]\n'
    code, report, _ = judged(GOOD.replace("mass = 8.0", arm + "poses = [{ turn = 0.0 }]"))
    assert (code, report["verdict"]) == (exit_codes.NOT_CHECKED, "not_checked")
    assert "implausible" in report["doubts"]


def test_a_doubt_about_many_contacts_stands_once(judged: Judged) -> None:
    regions = "".join(f'[[contacts]]\nregion = "{each}"\n' for each in ("chest", "pelvis", "thigh_knee"))
    cell = GOOD[: GOOD.index("[[contacts]]")].replace("thickness = 0.02", "thickness = 20.0") + regions
    _, report, _ = judged(cell)
    assert [row["verdict"] for row in report["verdicts"]] == ["not_checked"] * 6
    thick = [each for each in report["warnings"] if "thickness is 20 m" in each]
    assert len(thick) == 1
    assert thick[0].startswith("chest, quasi_static and 11 more: ")
    assert len(report["warnings"]) == len(set(report["warnings"])) == 2


# ---- drive --------------------------------------------------------------------------------------


def test_a_clamped_row_says_that_it_knows_no_drive(judged: Judged, capsys: pytest.CaptureFixture[str]) -> None:
    code, report, page = judged(CLAMPED)
    (row,) = report["verdicts"]
    assert (row["verdict"], row["doubts"]) == ("not_checked", ["drive_not_given"])
    assert (code, row["drive"]["holds_for"], row["drive"]["peak_force"]) == (5, "a robot without drive", None)
    assert "holds for a robot without drive" in page
    # The stop of the separation is that of another function: it is not taken over.
    assert judged(CLAMPED + STOP)[1]["verdicts"][0]["doubts"] == ["drive_not_given"]
    assert judged(CLAMPED + '[drive]\nmodel = "none"\n')[1]["verdicts"][0]["doubts"] == ["drive_not_given"]
    assert judged(CLAMPED + DRIVE)[1]["verdicts"][0]["verdict"] == "within_limits"
    confirmed = CLAMPED + '[confirmed]\ndrive_not_given = "moved by hand only, N. N."\n'
    assert judged(confirmed)[0] == 0
    assert "clamped contacts hold for a robot without drive" in capsys.readouterr().out
    assert judged(GOOD)[1]["verdicts"][0]["drive"] is None


def test_the_drive_of_the_cell_may_have_any_stiffness(judged: Judged) -> None:
    cell = CLAMPED.replace('"chest"', '"hand_finger"\narea_name = "palm"').replace("mass = 8.0", "mass = 16.5")
    code, report, page = judged(cell.replace("speed = 0.1", "speed = 0.25") + DRIVE)
    (row,) = report["verdicts"]
    assert (code, row["verdict"], row["doubts"]) == (exit_codes.FAILED_RUN, "exceeds", [])
    # The kinetic energy alone makes 60 N, a drive of 100 kN/m 892 N, a rigid one 1447 N.
    (result,) = report["results"]
    assert result["rows"][1]["peak_force"] == pytest.approx(60.0, abs=0.5)
    assert (row["drive"]["peak_force"], row["drive"]["stiffness"]) == (pytest.approx(1447.0, abs=1.0), "rigid")
    pad = contact.Covering(material=contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9), thickness=0.02, area=4e-3)
    driven = {
        "robot_mass": 16.5,
        "limits": standards.limits().contact("hand_finger", "quasi_static"),
        "covering": pad,
        "stop": (0.1, 3.0),
        "horizon": 2.0,
    }
    one = contact_calls.simulate(**driven, closing_speed=0.25, robot_stiffness=1e5)
    assert one.peak_force == pytest.approx(892.0, abs=1.0)
    # Up to the speed of the row all limits are kept with this drive, too.
    most = row["allowed_closing_speed"]
    assert row["drive"]["allowed_closing_speed"] == most < row["drive"]["kinetic_closing_speed"]
    assert 0.05 < most < 0.139
    slow = contact_calls.simulate(**driven, closing_speed=most, robot_stiffness=1e5)
    assert (slow.peak_force or 0.0) <= 140.0
    assert "1447" in page
    within = judged(cell.replace("speed = 0.1", f"speed = {0.999 * most}") + DRIVE)[1]["verdicts"][0]
    assert within["verdict"] == "within_limits"
    words = "a drive of any stiffness that reacts 0.1 s after the first touch and brakes at 3 m/s2"
    assert within["drive"]["holds_for"] == words


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    speed=st.floats(0.01, 0.4),
    mass=st.floats(1.0, 40.0),
    reaction=st.floats(0.005, 0.3),
    braking=st.floats(0.5, 20.0),
    stiffness=st.floats(3.0, 7.0),
    covering=st.booleans(),
)
def test_no_drive_presses_harder_than_the_row_says(
    speed: float, mass: float, reaction: float, braking: float, stiffness: float, *, covering: bool, tmp_path: Path
) -> None:
    path = tmp_path / "cell.toml"
    text = CLAMPED.replace("speed = 0.1", f"speed = {speed}").replace("mass = 8.0", f"mass = {mass}")
    text = text if covering else text.replace('covering = "pad"', 'covering = "none"')
    text += DRIVE.replace("reaction_time = 0.1", f"reaction_time = {reaction}").replace("3.0", f"{braking}")
    path.write_text(text)
    cell = load_cell(str(path))
    row = verdicts_of(cell)[0][0].verdict
    hit = contact_calls.simulate(
        robot_mass=mass,
        limits=cell.contacts[0].limit,
        covering=cell.coverings["pad"] if covering else None,
        closing_speed=speed,
        robot_stiffness=10.0**stiffness,
        stop=(reaction, braking),
        horizon=reaction + speed / braking + 1.0,
    )
    if row["drive"]["peak_force"] is None:
        # A collision that does not settle is not judged.
        assert row["verdict"] != "within_limits"
        return
    # Between the stiffnesses that are looked at a force may be a little larger.
    assert (hit.peak_force or 0.0) <= 1.01 * row["drive"]["peak_force"]
    if row["verdict"] == "within_limits":
        assert row["drive"]["peak_force"] <= cell.contacts[0].limit.force * (1 + 1e-9)


def test_a_stop_that_was_not_measured_from_this_speed_is_not_known(judged: Judged) -> None:
    stops = "[drive.stopping]\nspeed = [0.0, 0.05]\ntime = [0.0, 0.02]\ndistance = [0.0, 1e-3]\n"
    cell = CLAMPED + DRIVE.replace("deceleration = 3.0\n", "") + stops
    code, report, _ = judged(cell)
    (row,) = report["verdicts"]
    assert (code, row["verdict"], row["status"]) == (exit_codes.FAILED_RUN, "exceeds", "outside_table")
    assert (row["allowed_speed"], row["drive"]["peak_force"]) == (0.05, None)
    code, report, _ = judged(
        cell.replace("speed = 0.1", "speed = 0.04", 1).replace("reaction_time = 0.1", "reaction_time = 0.01")
    )
    assert (code, report["verdicts"][0]["verdict"]) == (0, "within_limits")


# ---- chance, confirmed doubts, areas ------------------------------------------------------------


def test_the_allowed_chance_is_a_setting(judged: Judged) -> None:
    code, report, page = judged(
        (EXAMPLES / "contact_arm.toml")
        .read_text()
        .replace('"cell_arm.urdf"', f'"{(EXAMPLES / "cell_arm.urdf").as_posix()}"')
    )
    row, chance = report["verdicts"][2], report["probability"][2]
    assert (row["region"], row["contact"]) == ("lower_arm_wrist", "quasi_static")
    assert chance["probability"] == pytest.approx(0.11, abs=0.005)
    assert (code, "probability" in row["doubts"], chance["allowed"]) == (exit_codes.NOT_CHECKED, True, 0.01)
    assert "more than the allowed 1 %" in page
    uncertain = GOOD.replace("[robot]", "[uncertain]\nrobot_mass = { lognormal = 0.99 }\n[robot]").replace(
        "0.1", "0.5", 1
    )
    assert judged(uncertain)[0] == exit_codes.NOT_CHECKED
    code, report, _ = judged("allowed_chance = 0.5\n" + uncertain)
    assert (code, report["inputs"]["allowed_chance"]) == (0, 0.5)
    upper = report["probability"][0]["interval"][1]
    assert judged(f"allowed_chance = {0.999 * upper}\n" + uncertain)[0] == exit_codes.NOT_CHECKED


def test_areas_may_be_uncertain_and_names_that_no_spread_is_for_are_refused(
    judged: Judged, capsys: pytest.CaptureFixture[str]
) -> None:
    uncertain = GOOD.replace("[robot]", "[uncertain]\nNAME = { uniform = 0.2 }\n[robot]")
    bare = uncertain.replace('covering = "pad"', "")
    for cell in (uncertain.replace("NAME", "area"), bare.replace("NAME", "area")):
        _, report, _ = judged(cell)
        assert report["probability"][0]["uncertain"] == ["area"]
    for name in ("speed", "human_speed", "seed", "limits"):
        Path("cell.toml").write_text(uncertain.replace("NAME", name), encoding="utf-8")
        assert main(["contact", "cell.toml", "--out", "refused"]) == exit_codes.ERROR
        assert f"uncertain.{name} must be a number of the contact" in capsys.readouterr().err


@pytest.mark.parametrize("share", ["0.0", "1.0", "-0.1", "nan", "5"])
def test_a_chance_is_a_share(share: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "cell.toml"
    path.write_text(f"allowed_chance = {share}\n" + GOOD)
    assert main(["contact", str(path), "--out", str(tmp_path / "report")]) == exit_codes.ERROR
    assert "allowed_chance must be above 0 and below 1" in capsys.readouterr().err


def test_a_confirmed_doubt_is_named_and_turns_nothing(judged: Judged) -> None:
    finger = GOOD.replace('"chest"', '"hand_finger"')
    reason = "only the back of the hand comes here, J. Doe"
    code, report, page = judged(finger + f'[confirmed]\ncovering_larger_than_part = "{reason}"\n')
    (row,) = report["verdicts"]
    assert (code, row["verdict"], row["doubts"]) == (0, "within_limits", [])
    assert row["confirmed"] == ["covering_larger_than_part"]
    assert report["confirmed"] == {"covering_larger_than_part": reason}
    assert reason in page
    assert judged(finger + '[confirmed]\nedge = "no edges"\n')[0] == exit_codes.NOT_CHECKED


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ('not_checked = "trust me"', "confirmed.not_checked must be left out: nothing is known there"),
        ('edge = " "', "confirmed.edge must say why the doubt does not hold here"),
        ("edge = true", "confirmed.edge must be"),
    ],
)
def test_what_cannot_be_confirmed(entry: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "cell.toml"
    path.write_text(GOOD + f"[confirmed]\n{entry}\n")
    assert main(["contact", str(path), "--out", str(tmp_path / "report")]) == exit_codes.ERROR
    assert words in capsys.readouterr().err


def test_the_area_of_a_contact_is_that_of_its_flat_covering(
    judged: Judged, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    finger = GOOD.replace('"chest"', '"hand_finger"').replace('"transient"', '"transient"\ncontact_area = 4e-4')
    code, report, _ = judged(finger)
    (row,) = report["verdicts"]
    assert (code, row["contact_area"], row["verdict"]) == (0, 4e-4, "within_limits")
    pad = load_cell("cell.toml").coverings["pad"]
    own = contact.Covering(material=pad.material, thickness=0.02, area=4e-4)
    limit = standards.limits().contact("hand_finger", "transient")
    assert row["allowed_speed"] == contact_calls.allowed_speed(robot_mass=8.0, limits=limit, covering=own).speed
    hit = contact_calls.simulate(robot_mass=8.0, closing_speed=0.1, limits=limit, covering=own)
    assert report["results"][0]["rows"][1]["peak_force"] == hit.peak_force
    capsys.readouterr()
    Path("cell.toml").write_text(finger.replace("area = 4e-3", 'shape = "sphere"\nradius = 0.08'))
    assert main(["contact", "cell.toml", "--out", str(tmp_path / "none")]) == exit_codes.ERROR
    assert "contacts[0].contact_area must be left out beside covering 'pad'" in capsys.readouterr().err


def test_what_is_taken_as_0_is_told(judged: Judged, capsys: pytest.CaptureFixture[str]) -> None:
    stop = STOP.replace("intrusion = 0.85\n", "").replace("uncertainty = 0.1\n", "")
    _, report, page = judged(GOOD + stop)
    assert report["speed_over_distance"]["taken_as_zero"] == ["intrusion", "uncertainty"]
    assert "No intrusion, no uncertainty given for the distance, taken as 0" in page
    assert "no intrusion and no uncertainty given" in capsys.readouterr().err
    _, report, page = judged(GOOD + STOP)
    assert report["speed_over_distance"]["taken_as_zero"] == []
    assert "taken as 0" not in page
    assert "stands still" in page


# ---- units --------------------------------------------------------------------------------------

NUMBER = re.compile(r"(?<![\w.])\d+\.?\d*(?:e-?\d+)?(?![\w.])")
UNITS = GOOD.replace('contact = "transient"\n', "") + STOP + DRIVE


def of_cell(text: str, path: Path) -> list[dict[str, Any]]:
    path.write_text(text)
    return [each.verdict for each in verdicts_of(load_cell(str(path)))[0]]


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(place=st.integers(0, len(NUMBER.findall(UNITS)) - 1), factor=st.sampled_from([1e3, 1e-3]))
def test_a_slip_of_a_unit_never_makes_a_contact_seem_better(place: int, factor: float, tmp_path: Path) -> None:
    slow = UNITS.replace("speed = 0.1", "speed = 0.05", 1)
    right = of_cell(slow, tmp_path / "cell.toml")
    assert {row["verdict"] for row in right} == {"within_limits"}
    match = list(NUMBER.finditer(slow))[place]
    slipped = slow[: match.start()] + repr(factor * float(match[0])) + slow[match.end() :]
    try:
        found = of_cell(slipped, tmp_path / "cell.toml")
    except InvalidParameterError:
        return
    for before, after in zip(right, found, strict=True):
        better = after["allowed_speed"] > before["allowed_speed"] or after["planned_speed"] < before["planned_speed"]
        driven = (before["drive"] or {}).get("peak_force")
        better |= driven is not None and (after["drive"]["peak_force"] or 0.0) < driven
        assert after["verdict"] != "within_limits" or not better
