"""``hrsafety contact``: the verdicts, the page and its numbers, the same bytes, what is refused."""

from __future__ import annotations

import html
import importlib.util
import json
import math
import os
import re
import shutil
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("matplotlib")
pytest.importorskip("jinja2")

from hrsafety import arms, contact, standards
from hrsafety.cli import main
from hrsafety.cli.cell import report as cell_report
from hrsafety.cli.cell.page import END_WORDS, THICKNESS_WORDS, rounded
from hrsafety.cli.file_kinds import starter
from hrsafety.cli.verdict import OF_VERDICTS
from hrsafety.contact import load_cell
from hrsafety.pages import pdf

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
ARM, BASE = EXAMPLES / "contact_arm.toml", EXAMPLES / "contact_base.toml"
SMALL = """
speed = 0.25
contact_area = 1e-4
covering = "pad"
[robot]
mass = 16.35
[[coverings]]
name = "pad"
material = { law = "gibson_ashby", E = 3e5, plateau = 15e3, e_D = 0.9 }
thickness = 0.02
area = 4e-3
[[contacts]]
region = "hand_finger"
[[contacts]]
region = "face"
speed = 0.05
"""
NUMBER = re.compile(r"\d")


class Numbers(HTMLParser):
    """Text of every `data` element by its path, and what of a page is outside of one."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[tuple[str, str, str]] = []
        self.open: tuple[str, str] | None = None
        self.links: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.links += [value for name, value in attrs if name in ("src", "href") and value]
        if tag == "data":
            self.open = (str(given["data-path"]), str(given["value"]))

    def handle_endtag(self, tag: str) -> None:
        if tag == "data":
            self.open = None

    def handle_data(self, data: str) -> None:
        if self.open is not None:
            self.found.append((*self.open, data))


Report = tuple[dict[str, Any], str]


def made(cell: str | Path, *options: str) -> Report:
    """Make a report in the folder of work and return its JSON and its page."""
    if isinstance(cell, str):
        Path("cell.toml").write_text(cell, encoding="utf-8")
        cell = Path("cell.toml")
    code = main(["contact", str(cell), "--out", "report", *options])
    report = json.loads(Path("report/report.json").read_text(encoding="utf-8"))
    assert code == OF_VERDICTS[report["verdict"]][1]
    return report, Path("report/report.html").read_text(encoding="utf-8")


@pytest.fixture
def judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Report]:
    """Return a function that makes a report and returns its JSON and its page."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    return made


@pytest.fixture(scope="module")
def examples(tmp_path_factory: pytest.TempPathFactory) -> dict[Path, Report]:
    """Return the reports of the arm and of the mobile base of the examples."""
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("SOURCE_DATE_EPOCH", raising=False)
        patch.chdir(tmp_path_factory.mktemp("examples"))
        return {cell: made(cell) for cell in (ARM, BASE)}


def test_speeds_of_the_specification(judged: Any, capsys: pytest.CaptureFixture[str]) -> None:
    report, page = judged(SMALL)
    found = {(row["region"], row["contact"]): row for row in report["verdicts"]}
    assert found["hand_finger", "quasi_static"]["allowed_speed"] == pytest.approx(0.36831, abs=5e-6)
    assert found["hand_finger", "quasi_static"]["governs"] == "force"
    bare = {row["contact"]: row["rows"][0]["allowed_closing_speed"] for row in report["results"][:2]}
    assert bare == pytest.approx({"transient": 1.344, "quasi_static": 0.126}, abs=5e-4)
    assert found["face", "transient"]["verdict"] == report["verdict"] == "not_permitted"
    assert found["face", "transient"]["allowed_speed"] is None
    assert "A measurement on the finished machine must confirm" in page
    assert "not permitted" in capsys.readouterr().out


def test_speeds_of_the_robot_of_the_source(examples: dict[Path, Report]) -> None:
    report, _ = examples[BASE]
    legs = {row["contact"]: row for row in report["verdicts"] if row["region"] == "lower_leg"}
    assert legs["transient"]["allowed_speed"] == pytest.approx(0.9705, abs=5e-5)
    assert legs["quasi_static"]["allowed_speed"] == pytest.approx(0.4716, abs=5e-5)
    assert (legs["transient"]["verdict"], legs["quasi_static"]["verdict"]) == ("within_limits", "exceeds")


def test_the_arm_of_the_examples(examples: dict[Path, Report]) -> None:
    report, page = examples[ARM]
    assert (EXAMPLES / "cell_arm.urdf").read_text() == arms.Arm.example().urdf
    arm = arms.Arm.example(payload=arms.Payload("tool", 2.0, center=(0.0, 0.0, 0.06)))
    masses = arm.effective_mass(
        {"shoulder": [0.4, 0.8, 0.2], "elbow": [1.4, 0.9, 1.9], "wrist_1": [0.0, 0.5, -0.3]},
        link="tool",
        direction=(1, 0, 0),
    )
    assert report["robot"]["directional_mass"] == masses.mass.max()
    assert report["robot"]["iso_mass"] == report["robot"]["mass"] == arm.iso_mass == 16.5
    assert report["audit"]["urdf_sha256"] == arm.sha256
    assert "no motor inertia given" in page
    assert len({row["region"] for row in report["verdicts"]}) == 4


def test_every_number_of_the_page_is_that_of_its_path(examples: dict[Path, Report]) -> None:
    for report, page in examples.values():
        reader = Numbers()
        reader.feed(page)
        assert len(reader.found) > 150
        for path, value, text in reader.found:
            held = cell_report.at_path(report, path)
            assert value == ("" if held is None else str(held)), path
            if isinstance(held, float) and not path.startswith("inputs"):
                scale = 1e-4 if "pressure" in path and "speed" not in path else 1.0
                scale = 1e-3 if path.endswith("spring_constant") else scale
                scale = 1e3 if path.endswith("least_thickness") else scale
                scale = 1e4 if path.endswith("contact_area") else scale
                assert float(text) == pytest.approx(scale * held, rel=2e-2, abs=6e-3), path
        named = re.findall(r'<span class="path">([a-z_.\[\]\d]+)</span></figcaption>', page)
        assert len(named) >= 6
        for path in named:
            assert cell_report.at_path(report, path)


def test_a_page_needs_nothing_from_elsewhere(examples: dict[Path, Report]) -> None:
    _, page = examples[ARM]
    reader = Numbers()
    reader.feed(page)
    assert [link for link in reader.links if not link.startswith("#")] == []
    assert not re.search(r"url\((?!#)|@import|<script", page)
    names = re.findall(r'\bid="([^"]+)"', page)
    assert len(names) == len(set(names))
    assert "@page { size: A4" in page
    for number in range(1, 13):
        assert re.search(rf"<h2>{number} ", page)


def test_the_first_page_says_how_fast_the_robot_may_run_at_each_region(judged: Any) -> None:
    report, page = judged(SMALL)
    hand, face = report["regions"]
    rows = [row for row in report["verdicts"] if row["region"] == "hand_finger"]
    assert hand["allowed_speed"] == min(row["allowed_speed"] for row in rows)
    assert report["verdicts"][hand["row"]]["allowed_speed"] == hand["allowed_speed"]
    assert (face["allowed_speed"], face["verdict"]) == (None, "not_permitted")
    first = page.partition("</section>")[0]
    # Rounded to nearest, 0.36831 would be 0.368, too; no more than what is allowed is ever shown.
    shown = re.search(r'data-path="regions\[0\].allowed_speed"[^>]*>([\d.]+)<', first)
    assert shown is not None
    assert hand["allowed_speed"] - 1e-3 < float(shown[1]) <= hand["allowed_speed"]
    assert "no speed" in first
    assert "Scanner field: none asked for" in first
    with_field = judged(SMALL + "[separation]\nmax_speed = 1.5\nreaction_time = 0.1\ndeceleration = 3.0\n")
    found = re.search(r'data-path="distances.stop"[^>]*>([\d.]+)<', with_field[1].partition("</section>")[0])
    assert found is not None
    assert with_field[0]["distances"]["stop"] <= float(found[1]) < with_field[0]["distances"]["stop"] + 1e-3


@given(allowed=st.floats(0.0, 20.0) | st.sampled_from([0.3, 0.1 + 0.2, 0.123, 1.1]), thousandths=st.integers(0, 20_000))
def test_speeds_are_rounded_down_and_distances_up(allowed: float, thousandths: int) -> None:
    down, up = (rounded({"speed": allowed}, each)("speed") for each in (math.floor, math.ceil))
    low, high = (float(str(each).partition(">")[2].partition("<")[0]) for each in (down, up))
    assert allowed - 1.001e-3 < low <= allowed + 1e-9
    assert allowed - 1e-9 <= high < allowed + 1.001e-3
    whole = rounded({"speed": thousandths / 1e3}, math.floor)("speed")
    assert f">{thousandths / 1e3:.3f}<" in whole


def test_each_doubt_stands_once_and_rows_name_it_by_number(examples: dict[Path, Report]) -> None:
    report, page = examples[ARM]
    for reason in {reason for row in report["verdicts"] for reason in row["reasons"]}:
        assert page.count(f"<li>{html.escape(reason, quote=False)}</li>") == 1
    assert "doubts 1, 2" in page
    assert "[1] [2]" in re.sub(r"\s+", " ", page)
    assert report["limits"]["sources"]["docstring"] in page


def test_a_chart_holds_the_coverings_of_one_class_of_contact(examples: dict[Path, Report]) -> None:
    _, page = examples[ARM]
    for kind in ("clamped", "free"):
        assert f"Hand finger, {kind}: force over time at the planned speed" in page
        assert f"Hand finger, {kind}: peak force over the closing speed" in page


PRINTER = """#!/bin/sh
for each in "$@"; do case $each in --print-to-pdf=*) target=${each#--print-to-pdf=};; esac; done
printf '%%PDF-1.4 /CreationDate (D:202601%08d+00)' "$$" >"$target"
"""


@pytest.mark.parametrize("browser", ["printer", *filter(shutil.which, pdf.BROWSERS[:1])])
def test_a_pdf_is_the_same_each_time(
    judged: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, browser: str
) -> None:
    if browser == "printer":  # its dates differ, as those of browsers do
        (tmp_path / browser).write_text(PRINTER)
        (tmp_path / browser).chmod(0o755)
        monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.setattr(pdf, "BROWSERS", (browser,))
    judged(SMALL, "--pdf")
    first = Path("report/report.pdf").read_bytes()
    assert first.startswith(b"%PDF-")
    page = Path("report/report.html").read_text()
    assert [pdf.pdf_of(page) for _ in range(3)] == [first] * 3


def test_a_pdf_that_nothing_can_print_says_what_is_missing(
    judged: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    judged(SMALL)
    shutil.rmtree("report")
    monkeypatch.setattr(pdf, "BROWSERS", ())
    found = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda each, *more: None if each == "weasyprint" else found(each, *more)
    )
    assert main(["contact", "cell.toml", "--out", "report", "--pdf"]) == 2
    assert "pip install weasyprint" in capsys.readouterr().err
    assert not Path("report").exists()


def test_the_same_cell_gives_the_same_bytes(judged: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    first = judged(SMALL)
    assert "date" not in first[0]
    assert judged(SMALL.replace("0.25", "2.5e-1").replace("16.35", "1635e-2")) == first
    dated, page = judged(SMALL, "--date", "2026-03-31")
    assert dated["date"] == "2026-03-31"
    assert "2026-03-31" in page
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    assert judged(SMALL)[0]["date"] == "1970-01-02"
    other = judged(SMALL.replace("0.25", "0.26"))[0]
    assert other["audit"]["inputs_sha256"] != first[0]["audit"]["inputs_sha256"]
    assert other["audit"]["limits_sha256"] == first[0]["audit"]["limits_sha256"]


def test_a_limit_that_is_not_checked_is_not_kept(judged: Any) -> None:
    report, page = judged(SMALL.replace('covering = "pad"\n', "").replace("contact_area = 1e-4\n", ""))
    hand = report["verdicts"][1]
    assert (hand["covering"], hand["verdict"]) == (None, "not_checked")
    assert hand["allowed_speed"] > hand["planned_speed"]
    assert "pressure is not checked" in page


def test_an_edge_or_a_law_without_data_is_not_kept(judged: Any) -> None:
    edge = SMALL.replace("area = 4e-3", 'shape = "sphere"\nradius = 0.003')
    assert "edge" in " ".join(judged(edge)[0]["warnings"])
    assert all(row["verdict"] != "within_limits" for row in judged(edge)[0]["verdicts"])
    table = "material = { law = 'table', strain = [0, 0.05], stress = [0, 1e3] }"
    short = re.sub(r"material = .*", table, SMALL).replace(
        "area = 4e-3", "area = 4e-3\nbottom = [0.04, 0.0]\nmax_strain = 0.04"
    )
    report, _ = judged(short)
    assert report["results"][0]["rows"][1]["peak_force"] is None
    assert report["verdicts"][0]["verdict"] != "within_limits"


def test_a_contact_that_is_not_wholly_checked_gives_no_speed_over_distance(judged: Any) -> None:
    bare = SMALL.replace('covering = "pad"\n', "").replace("contact_area = 1e-4\n", "")
    bare = bare.split("[[contacts]]")[0] + '[[contacts]]\nregion = "hand_finger"\ncontact = "quasi_static"\n'
    stop = "[separation]\nmax_speed = 1.5\nreaction_time = 0.1\ndeceleration = 3.0\n"
    for speed, word in (("0.05", "not_checked"), ("0.9", "exceeds")):
        report, page = judged(bare.replace("speed = 0.25", f"speed = {speed}") + stop)
        assert report["verdict"] == word
        # The force allows some speed, but nobody knows whether the pressure does.
        assert report["verdicts"][0]["allowed_speed"] > 0.1
        assert report["speed_over_distance"]["contact"] == "not_permitted"
        assert report["speed_over_distance"]["speed"][0] == 0.0
        assert "the robot must stand before it" in page


def test_a_class_of_contact_that_is_not_judged_is_named(judged: Any, capsys: pytest.CaptureFixture[str]) -> None:
    report, page = judged(SMALL)
    assert report["not_judged"] == []
    assert "not judged" not in (page + capsys.readouterr().out).lower()
    head = SMALL.split("[[contacts]]")[0]
    planned = {"hand_finger": "transient", "chest": "transient", "lower_leg": "quasi_static", "thigh_knee": None}
    rows = [
        f'[[contacts]]\nregion = "{region}"\n' + (f'contact = "{kind}"\n' if kind else "")
        for region, kind in planned.items()
    ]
    report, page = judged(head + "".join(rows))
    assert [(each["region"], each["contact"]) for each in report["not_judged"]] == [
        ("hand_finger", "quasi_static"),
        ("chest", "quasi_static"),
        ("lower_leg", "transient"),
    ]
    words = "being clamped: hand_finger, chest; free contact: lower_leg"
    assert f"not judged     {words}\n" in capsys.readouterr().out
    assert words.replace("_", " ") in page.split("<h2>")[0]


STOPS = """
[separation]
max_speed = 1.5
reaction_time = 0.1
human_speed = 1.6
intrusion = 0.0
uncertainty = 0.0
load = 5.0
[separation.stopping]
speed = [0.0, 0.5, 1.0]
load = [0.0, 10.0]
time = [[0.0, 0.0], [0.2, 0.3], [0.3, 0.5]]
distance = [[0.0, 0.0], [0.05, 0.07], [0.16, 0.25]]
"""


def test_measured_stops_take_the_place_of_a_deceleration(judged: Any) -> None:
    report, page = judged(SMALL + STOPS)
    curve = report["speed_over_distance"]
    stops = standards.StoppingData(**curve["rules"]["stopping"])
    for distance, speed in ((0.9, 0.5), (1.5, 1.0)):
        rules = {"reaction_time": 0.1, "intrusion": 0.0, "uncertainty": 0.0}
        least = standards.separation_distance(speed, stopping=stops, load=5.0, **rules)
        within = [each for place, each in zip(curve["distance"], curve["speed"], strict=True) if place < least]
        assert within[-1] <= speed, distance
        assert within[-1] > speed - 0.05
    # Nothing is known of stops from more than 1 m/s, whatever the robot can do.
    assert max(curve["speed"]) == 1.0
    assert curve["outside_table"][-1]
    assert not curve["outside_table"][0]
    assert "the largest one at which a stop was measured" in page
    assert "measured time and distance of a stop" in page
    assert not any("v²/2a" in row["equation"] for row in report["equations"])
    assert report["speed_over_distance"]["doubts"] == []
    # Times of another load, shorter than the way takes.
    report, page = judged(SMALL + STOPS.replace("0.3]", "0.03]").replace("0.5]]", "0.05]]"))
    assert report["speed_over_distance"]["doubts"] == ["stops_inconsistent"]
    assert "no more than speed times time" in page


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("load = 5.0\n", "", "separation.load must be given: the stops were measured for several"),
        ("load = 5.0", "load = 50.0", "separation.load must be within the measured stops"),
        ("load = 5.0", "load = 5.0\ndeceleration = 3.0", "separation.deceleration must be given, or stopping in its"),
        ("speed = [0.0, 0.5, 1.0]", "", "separation.stopping.speed"),
        ("speed = [0.0, 0.5, 1.0]", "speed = [0.0, 0.5]", "separation.stopping.time must have shape (2, 2, 1)"),
        ("[0.2, 0.3]", '[0.2, "x"]', "separation.stopping.time[1][1] must be a number"),
        ("[0.2, 0.3]", "[0.2]", "separation.stopping.time"),
        ("[separation.stopping]", "[separation.stoping]", 'did you mean "stopping"?'),
        (STOPS[STOPS.index("[separation.stopping]") :], "", "give it, or the table of measured stops"),
        (STOPS[STOPS.index("[separation.stopping]") :], "deceleration = 3.0", "separation.load must stand beside"),
    ],
)
def test_measured_stops_that_are_refused(
    old: str, new: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cell = tmp_path / "cell.toml"
    assert old in STOPS
    cell.write_text(SMALL + STOPS.replace(old, new, 1))
    assert main(["contact", str(cell), "--out", str(tmp_path / "report")]) == 2
    assert words in capsys.readouterr().err


def test_the_file_to_start_from_shows_measured_stops_that_hold(judged: Any) -> None:
    text = starter("contact", "cell.toml")
    assert "# [separation.stopping]" in text
    begin, end = text.index("# load = 5.0"), text.index("# How uncertain")
    lines = [line.removeprefix("# ") for line in text[begin:end].splitlines()]
    lines = [line for line in lines if not line.startswith("load")]
    stops = "\n".join(lines)
    report, _ = judged(text[:begin].replace("deceleration = 3.0", "") + stops + "\n" + text[end:])
    assert report["speed_over_distance"]["rules"]["stopping"]["speed"] == [0, 0.5, 1, 1.5]


def test_doubts_stand_beside_every_covering_thickness_map_and_chance(judged: Any) -> None:
    ball = re.sub(r"material = .*", 'material = { law = "linear", E = 4e4 }', SMALL).replace("0.25", "0.6")
    ball = ball.replace("area = 4e-3", 'shape = "sphere"\nradius = 0.02')
    ball = ball.replace("thickness = 0.02", "thickness = 0.05")
    ball = ball.replace("[robot]", "[uncertain]\nrobot_mass = { lognormal = 0.1 }\n[robot]", 1)
    report, page = judged(ball)
    deep = "the covering is compressed by more than half of a radius"
    bare, covered = report["results"][0]["rows"]
    assert bare["reasons"] == bare["least_thickness_reasons"] == []
    assert covered["least_thickness_status"] == "found"
    for reasons in (covered["reasons"], covered["least_thickness_reasons"], report["probability"][0]["reasons"]):
        assert any(reason.startswith(deep) for reason in reasons)
    assert any(deep in reason for reason in report["map"]["reasons"])
    assert deep in page.partition("Of the map of allowed speeds:")[2]


def test_a_robot_that_cannot_yield(judged: Any) -> None:
    base = SMALL.replace(
        "mass = 16.35", 'base = "differential"\nmass = 20.0\ninertia = 0.8\npoint = [0, 0]\nnormal = [0, 1]'
    )
    report, page = judged(base)
    assert report["robot"]["mass"] == "unbounded"
    clamped = report["verdicts"][0]
    assert (clamped["allowed_speed"], clamped["verdict"], clamped["status"]) == (0.0, "exceeds", "unbounded_mass")
    assert ">unbounded</data> kg" in page


def test_the_pose_behind_the_mass_of_an_arm_is_named(judged: Any, capsys: pytest.CaptureFixture[str]) -> None:
    arm = f'urdf = "{(EXAMPLES / "cell_arm.urdf").as_posix()}"\n'
    judged(SMALL.replace("mass = 16.35", arm + "poses = [{ elbow = 1.5 }]"))
    assert "worst pose     turn 0, shoulder 0, elbow 1.5, " in capsys.readouterr().out
    report, _ = judged(SMALL.replace("mass = 16.35", arm + "samples = 20"))
    shown = capsys.readouterr().out
    assert f"elbow {report['robot']['pose'][2]['value']:.4g}, " in shown
    assert "of 20 drawn between the limits of the joints; poses in [robot] names those that occur" in shown


def test_the_robot_has_its_own_share_of_the_speed(judged: Any) -> None:
    # The finger touches 4 cm2 of the pad and can give way.
    cell = SMALL.replace('region = "hand_finger"', 'region = "hand_finger"\ncontact_area = 4e-4\ncontact = "transient"')
    still = judged(cell)[0]["verdicts"][0]
    met = judged("human_speed = 0.5\n" + cell)[0]["verdicts"][0]
    assert met["allowed_closing_speed"] == still["allowed_closing_speed"]
    assert met["allowed_speed"] == pytest.approx(still["allowed_speed"] - 0.5)
    assert (still["verdict"], met["verdict"]) == ("within_limits", "exceeds")


def test_spreads_are_around_the_number_of_each_region(judged: Any) -> None:
    cell = SMALL.replace('covering = "pad"\n', "").replace(
        "[robot]",
        "[uncertain]\nstiffness = { lognormal = 0.2 }\n"
        "robot_mass = { lognormal = 0.1 }\nforce_limit = { lognormal = 0.15 }\n[robot]",
        1,
    )
    cell = cell.replace("contact_area = 1e-4", "contact_area = 1e-2\ndraws = 40_000")
    report, _ = judged(cell.replace("speed = 0.25", "speed = 0.12"))
    row = report["probability"][0]
    limit = standards.limits().contact("hand_finger", "quasi_static")
    sigma = math.sqrt(0.15**2 + (0.1**2 + 0.2**2) / 4)
    exact = 0.5 * math.erfc(
        -(math.log(0.12 * math.sqrt(16.35 * limit.spring_constant) / limit.force)) / sigma / math.sqrt(2)
    )
    assert row["interval"][0] < exact < row["interval"][1]
    assert report["probability"][3]["reason"] == "not permitted"


def test_materials_of_a_catalog_and_limits_of_a_file(judged: Any, capsys: pytest.CaptureFixture[str]) -> None:
    Path("foams.toml").write_text(
        '[[materials]]\nname = "grey"\nsource = "press, sheet 4"\n'
        'law = "gibson_ashby"\nE = 3e5\nplateau = 15e3\ne_D = 0.9\n'
    )
    Path("own.csv").write_text("region,contact,force_N,source\nhand_finger,quasi_static,100,own tests\n")
    cell = re.sub(r"material = .*", 'material = "grey"', 'catalog = "foams.toml"\nlimits = "own.csv"\n' + SMALL)
    cell = cell.split("[[contacts]]")[0] + '[[contacts]]\nregion = "hand_finger"\ncontact = "quasi_static"\n'
    report, page = judged(cell)
    assert report["verdict"] == "not_checked"
    assert "spring constant" in report["verdicts"][0]["reasons"][0]
    told = capsys.readouterr().err
    assert "no spring constant or no mass of the region" in told
    assert 'base = "iso_ts_15066_2016"' in told
    assert set(report["audit"]["files_sha256"]) == {"catalog", "limits"}
    assert "press, sheet 4" in page


def test_names_cannot_break_the_page(judged: Any) -> None:
    name = '<b>$x_1$ & \\"pad\\"'
    report, page = judged(SMALL.replace('"pad"', f'"{name}"'))
    assert report["verdicts"][0]["covering"] == '<b>$x_1$ & "pad"'
    assert "<b>" not in page


def test_a_report_is_not_written_over_that_of_another_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    slow = SMALL.split("[[contacts]]")[0] + '[[contacts]]\nregion = "chest"\ncontact = "transient"\n'
    for name in ("one.toml", "two.toml"):
        Path(name).write_text(slow, encoding="utf-8")
    place = Path("report/report.json")
    code = main(["contact", "one.toml"])
    assert code != 2
    # The same file again, changed or not.
    Path("one.toml").write_text(slow.replace("0.25", "0.2"), encoding="utf-8")
    assert main(["contact", "one.toml"]) == code
    before = place.read_bytes()
    capsys.readouterr()
    assert main(["contact", "two.toml"]) == 2
    told = capsys.readouterr().err
    assert "--out must be given where report holds another report, got that of hrsafety contact one.toml" in told
    assert "--out DIR" in told
    assert place.read_bytes() == before
    assert main(["contact", "two.toml", "--out", "other"]) == main(["contact", "two.toml", "--out", "report"]) == code
    assert json.loads(place.read_bytes())["audit"]["command"] == "hrsafety contact two.toml"
    for text in ("{}", "no JSON", "[1]"):
        place.write_text(text, encoding="utf-8")
        assert main(["contact", "two.toml"]) == 2
        assert place.read_text(encoding="utf-8") == text


def test_a_file_to_start_from(judged: Any, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["contact", "--init", "mine.toml"]) == 0
    report, _ = judged(Path("mine.toml"))
    assert report["verdict"] == "within_limits"
    assert main(["contact", "--init", "mine.toml"]) == 2
    assert "nothing is overwritten" in capsys.readouterr().err
    assert main(["contact", "absent.toml"]) == 2
    assert "--init" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("speed = 0.25", "speed = 0", "contacts[0].speed must be above 0"),
        ("speed = 0.25", "speed = nan", "contacts[0].speed must be above 0"),
        ("speed = 0.25", "sped = 0.25", 'did you mean "speed"?'),
        ("mass = 16.35", "mass = -1", "robot.mass must be finite and positive"),
        ("mass = 16.35", 'urdf = "gone.urdf"', "robot.urdf must name a readable file"),
        ("thickness = 0.02", "thickness = 0", "coverings[0].covering.thickness must be finite and positive"),
        ("plateau = 15e3", "platau = 15e3", 'did you mean "plateau"?'),
        ("plateau = 15e3", "plateau = 15e6", "coverings[0]"),
        ('covering = "pad"', 'covering = "pat"', "contacts[0].covering must name a covering (pad)"),
        ('region = "face"', 'region = "fase"', "contacts[1].region"),
        ("contact_area = 1e-4", "contact_area = -1", "contacts[0].contact_area must be above 0"),
        ("[robot]", "[uncertain]\nforce_limit = { lognormal = [1, 2] }\n[robot]", "each region has its own"),
        ("[robot]", "[uncertain]\nrobot_mas = { lognormal = [1, 2] }\n[robot]", "robot_mas"),
        ("[robot]", "[uncertain]\nrobot_mass = { normal = 0.9 }\n[robot]", "be positive but for a chance"),
        (
            "[robot]",
            "[separation]\nmax_speed = 1\nreaction_time = 0.1\ndeceleration = 0\n[robot]",
            "separation.deceleration",
        ),
        ("[[coverings]]", "[coverings]", "write [[coverings]]"),
    ],
)
def test_what_is_refused(old: str, new: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cell = tmp_path / "cell.toml"
    assert old in SMALL
    cell.write_text(SMALL.replace(old, new, 1))
    assert main(["contact", str(cell), "--out", str(tmp_path / "report")]) == 2
    assert words in capsys.readouterr().err
    assert not (tmp_path / "report").exists()


def test_a_date_is_a_date(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cell = tmp_path / "cell.toml"
    cell.write_text(SMALL)
    assert main(["contact", str(cell), "--out", str(tmp_path / "report"), "--date", "31.3.2026"]) == 2
    assert "--date must be a date" in capsys.readouterr().err


def test_every_example_loads() -> None:
    for path in EXAMPLES.glob("contact_*.toml"):
        cell = load_cell(str(path))
        assert all(isinstance(pad, contact.Covering) for pad in cell.coverings.values())


def test_the_words_of_the_table_of_results_say_what_they_mean(judged: Any) -> None:
    values, page = judged(SMALL)
    rows = [row for result in values["results"] for row in result["rows"]]
    assert "found" not in re.findall(r"<small>([^<]*)</small>", page)
    assert "horizon" not in re.findall(r"<small>([^<]*)</small>", page)
    assert {row["end"] for row in rows} <= {None, *END_WORDS}
    assert "found" in {row["least_thickness_status"] for row in rows} <= {None, *THICKNESS_WORDS}
