"""``hrsafety program``: the answer, the page and its numbers, the same bytes, files, what is refused."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("matplotlib")
pytest.importorskip("jinja2")

from api.spoiled_files import spoiled
from hrsafety import program
from hrsafety.cli import exit_codes, main
from hrsafety.cli.cell.report import at_path
from hrsafety.cli.file_kinds import starter
from hrsafety.cli.verdict import OF_VERDICTS
from hrsafety.errors import HrsafetyError

EXAMPLE = starter("program", "robot_program.toml")
GRIPPER = 'payload = { link = "wrist_block_3", mass = 2.0 }\n'
SMALL = f"""
[robot]
urdf = "example"
{GRIPPER}armature = {{ turn = 1.2, shoulder = 1.2, elbow = 1.0, wrist_1 = 0.3, wrist_2 = 0.3, wrist_3 = 0.3 }}
[motion]
velocity = 2.0
acceleration = 4.0
[[moves]]
kind = "joint"
to = {{ turn = 0.0, shoulder = 0.35, elbow = 1.45, wrist_1 = -0.23, wrist_2 = -1.5708, wrist_3 = 0.0 }}
[[moves]]
name = "go"
kind = "joint"
to = {{ turn = 0.3 }}
blend = 0.05
[[moves]]
kind = "joint"
to = {{ elbow = 1.3 }}
[[points]]
name = "gripper"
link = "tool"
area = 1e-4
[[segments]]
from = "move 1"
to = "move 3"
regions = ["chest"]
clamped = false
reason = "open space behind"
"""
SPOILED = 2000


class Numbers(HTMLParser):
    """Values of every `data` element by its path, and links to anything else."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[tuple[str, str]] = []
        self.links: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.links += [value for name, value in attrs if name in ("src", "href") and value]
        if tag == "data":
            self.found.append((str(given["data-path"]), str(given["value"])))


@pytest.fixture
def reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., tuple[dict[str, Any], str]]:
    """Return a function that makes a report and returns its JSON and its page."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)

    def made(text: str, *options: str) -> tuple[dict[str, Any], str]:
        Path("task.toml").write_text(text, encoding="utf-8")
        code = main(["program", "task.toml", "--out", "report", *options])
        report = json.loads(Path("report/report.json").read_text(encoding="utf-8"))
        assert code == OF_VERDICTS[report["verdict"]][1]
        return report, Path("report/report.html").read_text(encoding="utf-8")

    return made


def test_the_example_answers_in_three_sentences(reported: Any, capsys: pytest.CaptureFixture[str]) -> None:
    report, page = reported(EXAMPLE)
    out = capsys.readouterr().out
    assert len(report["answer"]) == 3
    for sentence in report["answer"]:
        assert sentence in out
        assert sentence in page
    times = {each["name"]: each["time"] for each in report["times"]}
    bare, padded = times["within limits of contacts, bare"], times["within limits of contacts, pad"]
    assert times["at robot limits"] < padded < bare
    assert times["with typed zones"] >= padded
    assert report["distances"]["stop"] > report["distances"]["slow_down"] > 0.0
    costs = [each["cost"] for each in report["segments"]]
    assert costs == sorted(costs, reverse=True)
    assert "No limits of jerk and torque" in page
    assert report["plan"]
    assert {each["status"] for each in report["times"]} == {"verified"}


def test_a_path_that_does_not_return_says_so(reported: Any) -> None:
    report, page = reported(SMALL)
    assert report["answer"][-1].startswith("The path ends in another pose than it starts in")
    assert report["answer"][-1] in page


def test_doubts_name_point_and_region(reported: Any, capsys: pytest.CaptureFixture[str]) -> None:
    pad = (
        '[[coverings]]\nname = "edge"\nmaterial = { law = "gibson_ashby", E = 4e5, plateau = 20e3, e_D = 0.85 }\n'
        'thickness = 0.01\nshape = "cylinder"\nradius = 0.02\nlength = 0.3\n'
    )
    text = SMALL.replace("area = 1e-4", 'area = 1e-4\ncovering = "edge"').replace('"chest"', '"hand_finger"') + pad
    reported(text)
    told = capsys.readouterr().err
    assert "gripper, hand_finger, transient: the contact is" in told
    assert "give the length of the covering that it touches" in told


def test_every_number_of_the_page_is_that_of_its_path(reported: Any) -> None:
    report, page = reported(EXAMPLE)
    parser = Numbers()
    parser.feed(page)
    assert len(parser.found) > 100
    for path, value in parser.found:
        held = at_path(report, path)
        assert value == ("" if held is None else str(held)), path
    assert [link for link in parser.links if not link.startswith("#")] == []


def test_the_same_file_gives_the_same_bytes(reported: Any) -> None:
    reported(SMALL)
    files = sorted(Path("report").iterdir())
    names = [path.name for path in files]
    assert names == ["joint_log.csv", "measurement_plan.csv", "report.html", "report.json", "waypoints.csv"]
    first = [path.read_bytes() for path in files]
    reported(SMALL)
    assert [path.read_bytes() for path in files] == first
    dated, page = reported(SMALL, "--date", "2026-03-31")
    assert dated["date"] == "2026-03-31"
    assert "2026-03-31" in page


def test_a_robot_without_a_program_is_judged_by_a_quantile(reported: Any) -> None:
    head, rest = SMALL.split("[motion]")
    points = rest[rest.index("[[points]]") :].replace('from = "move 1"\nto = "move 3"\n', "")
    motion = "[motion]\nvelocity = 2.0\ndraws = 2000\ntcp_speed = 0.1\n"
    report, page = reported(head + motion + points)
    assert report["verdict"] == "not_checked"
    assert report["warnings"][0].startswith("the worst of 2000 drawn motions counts")
    first = [path.read_bytes() for path in sorted(Path("report").iterdir())]
    reported(head + motion + points)
    assert [path.read_bytes() for path in sorted(Path("report").iterdir())] == first
    assert "made 20" not in page
    report, page = reported(head + motion + "accept_quantile = 0.99\n" + points)
    assert report["verdict"] == "within_limits"
    assert all(sentence in page for sentence in report["answer"])
    assert [each["level"] for each in report["rows"][0]["shares"]] == [0.5, 0.95, 0.99, 0.99]


def test_the_annex_says_what_the_verdict_rests_on(reported: Any) -> None:
    own = '[annex]\nmaker = "Example Ltd"\n[[annex.assumptions]]\nname = "payload"\nheld_by = "payload switch, PL d"\n'
    report, page = reported(SMALL + own)
    annex = report["annex"]
    assert annex["maker"] == "Example Ltd"
    assert [(each["contact"], each["hazard"]) for each in annex["hazards"]] == [
        ("free", "contact with chest by gripper in segment 1")
    ]
    held = {each["name"]: each for each in annex["assumptions"]}
    assert held["payload"]["held_by"] == "payload switch, PL d"
    assert held["nobody is clamped in segment 1"]["value"] == "open space behind"
    assert "280 N" in annex["limits"][0]["limit"]
    assert annex["hashes"]["robot"] == report["robot"]["sha256"]
    for words in ("Example Ltd", "payload switch, PL d", "Residual risk", "compared with my copy"):
        assert words.lower() in page.lower()


def test_records_fill_a_row_of_the_plan(reported: Any, capsys: pytest.CaptureFixture[str]) -> None:
    bare, _ = reported(SMALL)
    # A small area is one of pressure, with that of the bare contact.
    (row,) = bare["plan"]
    assert row["load"] == "pressure"
    assert row["prediction"] <= row["limit"] * (1.0 + 1e-3)
    report, _ = reported(SMALL.replace("area = 1e-4", "area = 6e-4"))
    rows = report["plan"]
    assert rows[0]["load"] == "force"
    for number in (1, 2, 3):
        time = np.arange(0.0, 0.8, 5e-4)
        force = np.where(time < 0.05, 0.0, (60.0 + number) * np.exp(-(((time - 0.08) / 0.01) ** 2)))
        lines = [f"{one:.4f},{each:.6f}" for one, each in zip(time, force, strict=True)]
        Path(f"run_{number}.csv").write_text("t [s],F [N]\n" + "\n".join(lines) + "\n", encoding="utf-8")
    files = [f"run_{number}.csv" for number in (1, 2, 3)]
    command = ["record", *files, "--kind", "force", "--transient", "280", "--free", "--predict", "task.toml"]
    command += ["--uncertainty", "1"]
    capsys.readouterr()
    assert main([*command, "--plan-row", "1", "--json", "filled.json"]) == 0
    filled = json.loads(Path("filled.json").read_text(encoding="utf-8"))["prediction"]
    for name in ("place", "region", "speed", "prediction", "limit"):
        assert filled[name] == rows[0][name]
    assert filled["measured"] == pytest.approx([61.0, 62.0, 63.0], rel=0.02)
    assert filled["accept"] == "accept"
    assert "is above the predicted" not in capsys.readouterr().out


def test_the_joint_log_is_read_again_and_keeps_its_limits(reported: Any) -> None:
    report, _ = reported(SMALL)
    Path("log.toml").write_text(
        re.sub(r"\[\[moves\]\].*?(?=\[\[points\]\])", "", SMALL, flags=re.DOTALL)
        .replace("[motion]", '[motion]\nlog = "report/joint_log.csv"')
        .replace('from = "move 1"\nto = "move 3"', "from = 0.0\nto = 0.5"),
        encoding="utf-8",
    )
    task = program.load_program("log.toml")
    planned = next(each["time"] for each in report["times"] if each["name"].endswith("bare"))
    assert task.motion.log.time[-1] == pytest.approx(planned)
    whole = SMALL.replace('from = "move 1"\nto = "move 3"', f"from = 0.0\nto = {float(task.motion.log.time[-1])!r}")
    text = re.sub(r"\[\[moves\]\].*?(?=\[\[points\]\])", "", whole, flags=re.DOTALL)
    again, _ = reported(text.replace("[motion]", '[motion]\nlog = "report/joint_log.csv"'))
    assert again["times"][0]["name"] == "as recorded"
    worst = max(1.0 / row["scale"] for row in again["rows"])
    assert worst <= 1.01


def test_waypoints_and_zones_are_told(reported: Any) -> None:
    report, page = reported(SMALL + "\n[zones]\ndeceleration = 2.5\ncount = 3\nstep = 0.02\n")
    header, *lines = Path("report/waypoints.csv").read_text(encoding="utf-8").splitlines()
    assert header.startswith("t_s,s,point,vx_m_per_s")
    assert len(lines) > 1000
    assert 1 <= len(report["zones"]["zones"]) <= 3
    assert all(abs(row["speed"] / 0.02 - round(row["speed"] / 0.02)) < 1e-9 for row in report["zones"]["zones"])
    assert "Zones as typed into the pendant" in page


def test_what_is_unknown_is_not_green(reported: Any, capsys: pytest.CaptureFixture[str]) -> None:
    slow = SMALL.replace("velocity = 2.0", "velocity = 0.02")
    assert reported(slow)[0]["verdict"] == "within_limits"
    report, page = reported(slow.replace("area = 1e-4", "radius = 0.004"))
    assert report["verdict"] == "not_checked"
    assert report["doubts"] == {"estimated_area": 1}
    assert "estimated area" in page
    assert capsys.readouterr().out.splitlines()[-1].endswith("exit code 5")
    lifted = slow.replace("area = 1e-4", "radius = 0.004") + '[confirmed]\nestimated_area = "measured, J. Doe"\n'
    report, page = reported(lifted)
    assert report["verdict"] == "within_limits"
    assert "measured, J. Doe" in page
    report, page = reported(slow.replace('regions = ["chest"]', 'regions = ["chest", "face"]'))
    assert report["verdict"] == "not_permitted"
    assert report["times"][-1]["time"] is None
    assert not Path("report/joint_log.csv").exists() or "not permitted" in page


@pytest.mark.parametrize(
    ("before", "after", "message"),
    [
        ("acceleration = 4.0\n", "", "motion.acceleration must be given"),
        ("acceleration = 4.0", "acceleration = -4.0", "motion.acceleration.turn must be above 0, got -4.0"),
        ("velocity = 2.0", "velocity = { trun = 2.0 }", "motion.velocity must name joints of the arm"),
        ("blend = 0.05", "blend = 0.2", "moves[1].blend must be at most half of this move and of the next one"),
        ('link = "tool"', 'link = "tol"', "points[0].link must be a link of the arm"),
        ('regions = ["chest"]', 'regions = ["chset"]', "segments[0].regions must name regions"),
        ('regions = ["chest"]\n', "", "segments[0].regions must be given"),
        ('reason = "open space behind"\n', "", "segments[0].reason must say why nobody can be clamped"),
        ('to = "move 3"', 'to = "move 9"', "segments[0].to must name a move"),
        ("area = 1e-4", "area = 0.0", "points[0].area must be"),
        ("area = 1e-4", "area = nan", "points[0].area must be"),
        ("to = { turn = 0.3 }", "to = { turn = 30.0 }", "moves[1].to must"),
        ('kind = "joint"\nto = { elbow = 1.3 }', 'kind = "arc"\nto = { elbow = 1.3 }', "moves[2].kind must be"),
        ("[motion]", '[motion]\nlog = "no.csv"', "motion.log must be given, or [[moves]] in its place"),
        ("[motion]", "[zones]\ncount = 3\n[motion]", "zones.deceleration must be given"),
        ("[motion]", '[robot.drive]\nmodel = "x"\n[motion]', "robot.drive must be one of the keys"),
        ("[[moves]]\nkind", "[[moves]]\nspeed = 1.0\nkind", "moves[0].speed must be one of the keys"),
    ],
)
def test_bad_files_name_key_value_rule_and_remedy(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], before: str, after: str, message: str
) -> None:
    assert before in SMALL
    path = tmp_path / "task.toml"
    path.write_text(SMALL.replace(before, after, 1), encoding="utf-8")
    assert main(["program", str(path), "--out", str(tmp_path / "out")]) == exit_codes.ERROR
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"hrsafety: error: {path}: {message}")
    assert not (tmp_path / "out").exists()


def test_a_spoiled_file_is_read_or_refused_in_one_sentence(tmp_path: Path) -> None:
    path = tmp_path / "task.toml"
    messages, read = [], 0
    for number, content in enumerate(spoiled(SMALL.replace(GRIPPER, ""), SPOILED, seed=3)):
        path.write_bytes(content)
        try:
            task = program.load_program(path)
            read += 1
            if number % 10 == 0:
                study = task.report(intervals=60)
                assert study.verdict in OF_VERDICTS
                assert not np.isnan([each.share for each in study.rows]).any()
        except HrsafetyError as error:
            messages.append(str(error))
    assert read > SPOILED / 20
    assert len(messages) > SPOILED / 4
    assert all(10 < len(message) < 2000 for message in messages)
