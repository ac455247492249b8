"""The player: one file that loads nothing, says what happened, and can be used with keys, fingers and a reader."""

from __future__ import annotations

import base64
import json
import re
import subprocess
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from api.browsers import Tab, program, tab
from hrsafety import _replay as replay
from hrsafety import navigation as nav
from hrsafety import plotting, scenarios
from hrsafety._replay.packing import ABSENT, Scale, block
from hrsafety.cli import main
from hrsafety.datasets import Recording
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning

EVIL = '</script><script>alert("x")</script>&@@head@@'


def walkers(instants: int, count: int, **more: Any) -> replay.Replay:
    """Return people who walk in curves past a robot that drives straight."""
    draw = np.random.default_rng(1)
    time = 0.1 * np.arange(instants)
    heading = np.cumsum(draw.normal(0.0, 0.06, (instants, count)), axis=0) + draw.uniform(0.0, 6.28, count)
    steps = np.stack([np.cos(heading), np.sin(heading)], axis=-1) * draw.uniform(0.08, 0.16, count)[:, None]
    robot = replay.PlayedRobot(
        name="robot",
        position=np.stack([0.5 * time, 15.0 + 0.0 * time], axis=1),
        radius=0.3,
        speed=np.full(instants, 0.5),
        clearance=np.linspace(2.0, -0.05, instants),
        goal=(0.05 * instants, 15.0),
        tolerance=0.2,
    )
    given: dict[str, Any] = {
        "title": "Walkers",
        "time": time,
        "robots": [robot],
        "people": draw.uniform(0.0, 30.0, (count, 2)) + np.cumsum(steps, axis=0),
        "radius": np.full(count, 0.25),
    }
    return replay.Replay(**(given | more))


def page_of(shown: Any, folder: Path, name: str = "run.html") -> str:
    return plotting.player(shown, folder / name) and (folder / name).as_uri()


def decoded(page: str, name: str) -> np.ndarray[Any, Any]:
    """Return the numbers of a block, unpacked without the code that packed them."""
    found = re.search(rf'id="block-{name}" data-kind="(\w+)" data-rows="(\d+)" data-columns="(\d+)">([^<]*)<', page)
    assert found is not None
    kind, rows, columns = found[1], int(found[2]), int(found[3])
    raw = np.frombuffer(zlib.decompress(base64.b64decode(found[4]), -15), dtype=np.uint8)
    many = rows * columns
    steps = raw[:many].astype(np.int64)
    if kind != "u8":
        steps = steps + 256 * raw[many:].astype(np.int64)
    sums = np.cumsum(steps.reshape(columns, rows), axis=1).T
    wrapped = np.mod(sums, 256 if kind == "u8" else 65536)
    return np.where(wrapped >= 32768, wrapped - 65536, wrapped) if kind == "i16" else wrapped


def head_of(page: str) -> dict[str, Any]:
    found = re.search(r'<script type="application/json" id="head">(.*?)</script>', page)
    assert found is not None
    head: dict[str, Any] = json.loads(found[1])
    return head


@pytest.fixture(scope="module")
def opened() -> Iterator[Tab]:
    with tab() as browser:
        yield browser


@pytest.fixture
def browser(opened: Tab) -> Iterator[Tab]:
    opened.errors.clear()
    opened.size(1300, 900)
    yield opened
    assert opened.errors == []


# ---- the file -------------------------------------------------------------------------------


def test_a_thousand_instants_of_a_hundred_people_are_small() -> None:
    page = plotting.player(walkers(1000, 100))
    assert len(page.encode()) < 200_000
    assert page == plotting.player(walkers(1000, 100))


def test_nothing_is_loaded_from_anywhere_and_only_the_own_script_may_run() -> None:
    page = plotting.player(walkers(10, 2))
    rules = re.search(r'http-equiv="Content-Security-Policy" content="([^"]*)"', page)
    assert rules is not None
    assert rules[1].startswith("default-src 'none'; script-src 'sha256-")
    assert "unsafe" not in rules[1]
    assert not re.search(r"https?:|\bsrc=|@import|url\(|import\(|fetch\(|XMLHttp", page)


def test_long_runs_stay_below_the_limit_and_keep_what_matters() -> None:
    draw = np.random.default_rng(2)
    count = 20_000
    gap = np.full(count, 1.0)
    gap[12_345] = -0.02
    robot = replay.PlayedRobot(
        name="robot", position=np.cumsum(draw.normal(0, 0.3, (count, 2)), 0), radius=0.3, clearance=gap
    )
    people = np.cumsum(draw.normal(0, 0.2, (count, 40, 2)), 0)
    touched = replay.Event(1234.5, "contact", "contact with person 3")
    shown = replay.Replay(title="long", time=0.1 * np.arange(count), robots=[robot], people=people, events=[touched])
    page = plotting.player(shown)
    assert len(page) <= 1_000_000
    assert decoded(page, "clearance0").min() == -20
    ticks = np.cumsum(decoded(page, "time"))
    assert 1_234_500 in ticks
    assert f"{len(ticks)} frames of {count} instants" in page


def test_positions_are_kept_to_a_millimeter_and_who_is_absent_stays_so() -> None:
    shown = walkers(200, 7)
    people = np.array(shown.people)
    people[50:80, 3] = np.nan
    people[:, 5] = np.nan
    page = plotting.player(walkers(200, 7, people=people))
    head = head_of(page)
    found = decoded(page, "people").reshape(200, 7, 2)
    absent = np.isnan(people[..., 0])
    assert ((found == ABSENT).all(axis=-1) == absent).all()
    places = found * head["people"][0] + head["people"][1:]
    assert np.abs(places - people)[~absent].max() <= 0.5001e-3
    assert (np.cumsum(decoded(page, "time")) == 100 * np.arange(200)).all()


@settings(max_examples=60, deadline=None)
@given(st.lists(st.lists(st.one_of(st.just(float("nan")), st.floats(-1e6, 1e6)), min_size=4, max_size=4), min_size=1))
def test_any_places_survive_packing(rows: list[list[float]]) -> None:
    places = np.array(rows).reshape(-1, 2, 2)
    scale = Scale.of(places)
    packed = block("x", scale.whole(places))
    sizes = f'data-rows="{packed.shape[0]}" data-columns="{packed.shape[1]}"'
    text = f'id="block-x" data-kind="{packed.kind}" {sizes}>{packed.text}<'
    found = decoded(text, "x").reshape(places.shape)
    absent = np.isnan(places).any(axis=-1)
    assert ((found == ABSENT).all(axis=-1) == absent).all()
    away = np.abs(found * scale.unit + scale.middle - places)[~absent]
    assert (away <= 0.5001 * scale.unit).all()


def test_no_frames_and_what_is_no_run_are_told() -> None:
    with pytest.raises(InvalidParameterError, match="frames"):
        plotting.player(walkers(5, 1, time=np.empty(0), people=np.empty((0, 1, 2)), robots=[]))
    with pytest.raises(InvalidParameterError, match="run must"):
        plotting.player(3)


def test_words_of_others_are_escaped() -> None:
    doubt = ResultWarning("x", "y", EVIL)
    event = replay.Event(0.1, "note", EVIL)
    shown = walkers(
        5, 1, title=EVIL, names=[EVIL], kinds=[EVIL], events=[event], warnings=[doubt], facts=[(EVIL, EVIL)]
    )
    page = plotting.player(shown)
    assert 'alert("x")' not in page
    assert head_of(page)["names"] == [EVIL]
    assert page.count("<script") == plotting.player(walkers(5, 1)).count("<script")


# ---- what results show ----------------------------------------------------------------------


def test_a_record_of_decisions_shows_verdicts_plans_and_reach() -> None:
    law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(person_speed=1.6))
    record = nav.metrics.record_safety(scenarios.configuration("c2"), law)
    page = plotting.player(record)
    head = head_of(page)
    ticks = np.cumsum(decoded(page, "time")) * head["tick"]
    codes = [head["verdicts"][code] for code in decoded(page, "verdict0").ravel()]
    said = {record.at(min(each, record.trajectory.time[-1])).status for each in ticks}
    assert said <= set(codes)
    assert decoded(page, "planLength0").min() >= 1
    assert decoded(page, "reach0").max() > 0


def test_a_run_without_a_record_claims_no_verdict(browser: Tab, tmp_path: Path) -> None:
    law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield())
    browser.open(page_of(nav.simulate(scenarios.configuration("c2"), law), tmp_path))
    assert browser.value("document.getElementById('word').textContent") == "No verdict recorded"


def test_without_a_shield_nothing_was_verified() -> None:
    law = nav.SafeNavigation(nav.VirtualForceField(), yielding=nav.Yielding())
    page = plotting.player(nav.metrics.record_safety(scenarios.configuration("c2"), law))
    words = {head_of(page)["verdicts"][code] for code in decoded(page, "verdict0").ravel()}
    assert words <= {"not recorded", "taken over"}
    assert 'id="block-plan0"' not in page


def test_contacts_of_a_run_are_events_with_their_places() -> None:
    wall = nav.Disc(center=(2.0, 0.0), radius=0.4, active_clearance=0.02, critical_clearance=0.01)
    run = nav.simulate(
        nav.Scenario(start=(0, 0), goal=(6, 0), obstacles=[wall]),
        nav.VirtualForceField(repulsive_gain=0.01, detour_gain=0.01),
    )
    assert run.outcome == "collided"
    found = head_of(plotting.player(run))["events"]
    when, kind, words, place = found[0]
    assert when == pytest.approx(run.contact_time[0], abs=1e-3)
    assert kind == "fault"
    assert "at fault" in words
    assert abs(np.hypot(place[0] - 2.0, place[1]) - 0.4) < 0.02


def test_unknown_ground_of_a_map_is_shown_as_unknown() -> None:
    cells = np.zeros((40, 60), dtype=bool)
    cells[10, 10:20] = True
    known = nav.StaticMap.from_grid(cells, resolution=0.1, origin=(-1.0, -2.0))
    run = nav.simulate(nav.Scenario(start=(0, 0), goal=(3, 0)), nav.SafeNavigation(nav.VirtualForceField(), map=known))
    page = plotting.player(run)
    rows, columns, side, *_, limits = head_of(page)["ground"]["grids"][0]
    assert (rows, columns, side) == (40, 60, 0.1)
    assert limits == known.grids[0].limits
    assert (decoded(page, "grid0").reshape(40, 60) == 1).sum() == 10


def test_worlds_and_recordings_can_be_played() -> None:
    world = nav.simulate(scenarios.bottleneck(10, time_limit=3))
    assert len(head_of(plotting.player(world))["radius"]) == 10
    walk = Recording(
        time_s=[0.0, 0.4, 0.8, 9.0, 9.4], person=[7, 7, 7, 9, 9], position=[[0, 0], [0.4, 0], [1, 0], [4, 4], [4, 5]]
    )
    page = plotting.player(walk)
    head = head_of(page)
    assert head["names"] == ["7", "9"]
    assert head["notJudged"] == [[0.8, 9.0, "nobody is recorded"]]
    absent = (decoded(page, "people") == ABSENT)[:, ::2]
    assert absent.tolist() == [[False, True]] * 3 + [[True, False]] * 2


def test_notebooks_show_the_player_in_a_frame_of_its_own() -> None:
    shown = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())._repr_html_()
    assert shown.startswith('<iframe sandbox="allow-scripts" ')
    assert "<table>" in shown.rpartition("</iframe>")[2]


# ---- in a browser ---------------------------------------------------------------------------


def test_it_is_ready_soon_and_the_robot_is_where_it_was(browser: Tab, tmp_path: Path) -> None:
    address = page_of(walkers(1000, 100), tmp_path)
    browser.open(address)
    assert browser.value("performance.now()") < 2000
    assert browser.data("robot") == "0.000,15.000"
    browser.open("about:blank", state=None)
    browser.open(f"{address}#t=12.4")
    assert browser.data("frame") == "124"
    assert browser.data("robot") == "6.200,15.000"
    browser.value("location.hash = '#t=12.45'; 1")
    browser.wait("document.body.dataset.time === '12.450'")
    assert browser.data("robot") == "6.225,15.000"  # straight between two frames


def test_the_page_can_be_read_without_driving_the_browser(tmp_path: Path) -> None:
    address = f"{page_of(walkers(100, 3), tmp_path)}#t=2.4"
    options = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'profile'}"]
    command = [program(), *options, "--virtual-time-budget=5000", "--dump-dom", address]
    found = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True).stdout
    body = re.search(r"<body[^>]*>", found)
    assert body is not None
    for name, value in (("state", "ready"), ("frame", "24"), ("robot", "1.200,15.000")):
        assert f'data-{name}="{value}"' in body[0]


def test_every_key_does_what_it_says(browser: Tab, tmp_path: Path) -> None:
    events = [
        replay.Event(3.0, "contact", "contact with person 1", (1.5, 15.0)),
        replay.Event(7.0, "arrival", "arrived"),
    ]
    away = [replay.UnjudgedTime(5.0, 6.0, "person lost nearby")]
    browser.open(page_of(walkers(100, 5, events=events, not_judged=away), tmp_path))
    steps = [
        *(("ArrowRight", False, "0.100"), ("ArrowRight", True, "1.100"), ("ArrowLeft", False, "1.000")),
        *(("ArrowLeft", True, "0.000"), ("n", False, "3.000"), ("n", False, "5.000"), ("n", False, "7.000")),
        *(("n", False, "7.000"), ("p", False, "5.000"), ("P", False, "3.000"), ("End", False, "9.900")),
        *(("ArrowRight", False, "9.900"), ("Home", False, "0.000"), ("ArrowLeft", True, "0.000")),
    ]
    for key, shift, time in steps:
        browser.press(key, shift=shift)
        assert browser.data("time") == time, key
    browser.value("location.hash = '#t=5.5'; 1")
    browser.wait("document.body.dataset.time === '5.500'")
    assert "person lost nearby" in browser.value("document.getElementById('unjudged').innerText")
    for key, node in (("f", "follow"), ("l", "labels")):
        browser.press(key)
        assert browser.value(f"document.getElementById({node!r}).getAttribute('aria-pressed')") == "true"
    browser.press("?")
    assert browser.value("document.getElementById('keys').open")
    browser.press("?")
    assert not browser.value("document.getElementById('keys').open")
    browser.press("Home")
    browser.press(" ")
    assert browser.data("playing") == "yes"
    browser.wait("+document.body.dataset.time > 0.3")
    browser.press(" ")
    stopped = browser.data("time")
    assert browser.data("playing") == "no"
    assert browser.data("time") == stopped
    before = browser.value("document.getElementById('floor').toDataURL()")
    browser.press("+")
    browser.wait(f"document.getElementById('floor').toDataURL() !== {json.dumps(before)}")
    browser.press("0")


def test_buttons_slider_and_table_seek(browser: Tab, tmp_path: Path) -> None:
    browser.open(page_of(walkers(100, 3, events=[replay.Event(4.0, "note", "something")]), tmp_path))
    browser.value("document.getElementById('on').click(); 1")
    assert browser.data("frame") == "1"
    browser.value("const s = document.getElementById('seek'); s.value = 50; s.dispatchEvent(new Event('input')); 1")
    assert browser.data("time") == "5.000"
    said = browser.value("document.getElementById('seek').getAttribute('aria-valuetext')")
    assert said == "5.00 s of 9.90 s"
    browser.value("document.querySelector('table.events button').click(); 1")
    assert browser.data("time") == "4.000"


def test_everything_has_a_name_and_can_be_read(browser: Tab, tmp_path: Path) -> None:
    doubt = ResultWarning("x", "y", "people may not be what they seem")
    browser.open(page_of(walkers(100, 3, events=[replay.Event(4.0, "note", "x")], warnings=[doubt]), tmp_path))
    unnamed = """[...document.querySelectorAll('button, select, input, canvas[role]')].filter((each) =>
        !(each.getAttribute('aria-label') || each.innerText || (each.labels && each.labels.length))).length"""
    assert browser.value(unnamed) == 0
    faint = """(() => {
        const parts = (color) => color.match(/[\\d.]+/g).map(Number);
        const one = (v) => (v / 255 <= 0.03928 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4);
        const light = (c) => 0.2126 * one(c[0]) + 0.7152 * one(c[1]) + 0.0722 * one(c[2]);
        const back = (node) => {
            for (; node; node = node.parentElement) {
                const c = parts(getComputedStyle(node).backgroundColor);
                if (c.length < 4 || c[3] > 0.5) return c.slice(0, 3);
            }
            return [255, 255, 255];
        };
        const found = [];
        for (const node of document.querySelectorAll('body *')) {
            const text = [...node.childNodes].some((each) => each.nodeType === 3 && each.textContent.trim());
            if (!text || !node.offsetParent || ['SCRIPT', 'STYLE', 'OPTION'].includes(node.tagName)) continue;
            const a = light(parts(getComputedStyle(node).color).slice(0, 3)), b = light(back(node));
            const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
            if (ratio < 4.5) found.push(node.tagName + ' ' + node.id + ' ' + ratio.toFixed(2));
        }
        return found;
    })()"""
    for verdict in range(5):
        browser.value(f"document.getElementById('verdict').className = 'v{verdict}'; 1")
        assert browser.value(faint) == []


@pytest.mark.parametrize("width", [420, 1300])
def test_nothing_is_wider_than_the_window_and_focus_is_seen(browser: Tab, tmp_path: Path, width: int) -> None:
    browser.size(width, 900)
    browser.open(page_of(walkers(100, 3, events=[replay.Event(4.0, "note", "x" * 10)]), tmp_path))
    assert browser.value("document.documentElement.scrollWidth") <= width
    browser.press("Tab")
    assert browser.value("getComputedStyle(document.activeElement).outlineWidth") == "3px"


def test_it_never_plays_by_itself_and_says_in_words_what_it_shows(browser: Tab, tmp_path: Path) -> None:
    browser.reduced_motion()
    browser.open(page_of(walkers(100, 3), tmp_path))
    assert browser.data("playing") == "no"
    assert "Clearance" in browser.value("document.getElementById('now').textContent")


def test_without_a_way_to_unpack_the_tables_tell(tmp_path: Path) -> None:
    with tab() as browser:
        browser.send("Page.addScriptToEvaluateOnNewDocument", source="delete window.DecompressionStream")
        browser.open(page_of(walkers(100, 3), tmp_path), state="table")
        assert "cannot unpack" in browser.value("document.getElementById('trouble').innerText")
        assert browser.value("[...document.querySelectorAll('details')].every((each) => each.open)")
        assert browser.value("document.querySelectorAll('table.states tbody tr').length") == 40


def test_the_page_of_a_command_holds_a_player_that_plays(browser: Tab, tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(
        "start = [4.0, 0.6]\ngoal = [0.0, 0.6]\n[[obstacles]]\ntype = 'human'\n"
        "start = [2.0, -1.0]\nvelocity = [0.0, 0.5]\n"
    )
    assert main(["simulate", str(scene), "--safe", "--out", str(tmp_path / "out")]) == 0
    browser.open((tmp_path / "out" / "summary.html").as_uri(), state=None)
    assert browser.value("document.querySelector('iframe').getAttribute('sandbox')") == "allow-scripts"
    page = (tmp_path / "out" / "player.html").read_text(encoding="utf-8")
    assert head_of(page)["robots"][0]["decided"]
    assert browser.value("document.querySelector('iframe').srcdoc").strip() == page.strip()


def test_fingers_move_and_zoom_the_floor(tmp_path: Path) -> None:
    with tab(420, 900, touch=True) as browser:
        browser.open(page_of(walkers(100, 3), tmp_path))
        picture = "document.getElementById('floor').toDataURL()"
        before = browser.value(picture)
        for kind, points in (
            ("touchStart", [(150, 200), (250, 200)]),
            ("touchMove", [(100, 200), (300, 200)]),
            ("touchEnd", []),
        ):
            touches = [{"x": x, "y": y, "id": index} for index, (x, y) in enumerate(points)]
            browser.send("Input.dispatchTouchEvent", type=kind, touchPoints=touches)
        browser.wait(f"{picture} !== {json.dumps(before)}")
        assert browser.errors == []


def test_a_robot_that_nobody_sees_has_no_place(browser: Tab, tmp_path: Path) -> None:
    shown = walkers(50, 2)
    lost = np.array(shown.robots[0].position)
    lost[20:] = np.nan
    robot = replay.PlayedRobot(name="robot", position=lost, radius=0.3)
    browser.open(page_of(walkers(50, 2, robots=[robot]), tmp_path) + "#t=3")
    assert browser.data("robot") == ""
    assert "not known" in browser.value("document.getElementById('state').innerText")
