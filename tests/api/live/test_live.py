"""A running world: the robot moves and decides as in a run, whatever is dragged, and only the own page may ask."""

from __future__ import annotations

import http.client
import json
import math
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

import numpy as np
import pytest

from api.browsers import tab
from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.errors import InvalidParameterError
from hrsafety.live import serve
from hrsafety.live.world import PERIOD, LiveWorld

FIELD = nav.VirtualForceField()
SAFE = nav.SafeNavigation(FIELD, shield=nav.Shield(), yielding=nav.Yielding())
HALL = Path(__file__).resolve().parents[3] / "python/hrsafety/cli/data/people_in_a_hall.toml"


def robot(law: Any = SAFE) -> nav.Robot:
    return nav.Robot(start=(0.0, 0.0), goal=(6.0, 0.0), law=law, arrival_tolerance=0.12)


def walkers(count: int) -> list[nav.Person]:
    draw = np.random.default_rng(1)
    places = draw.uniform((1.0, -4.0), (9.0, 4.0), (count, 2)).tolist()
    return [
        nav.Person(start=(x, y), route=[(x, -y), (x, y)], at_end="repeat", desired_speed=1.0, radius=0.2)
        for x, y in places
    ]


@contextmanager
def running(world: nav.World, pace: float = math.inf) -> Iterator[LiveWorld]:
    live = LiveWorld(world, pace=pace)
    thread = threading.Thread(target=live.run)
    thread.start()
    try:
        yield live
    finally:
        live.stop()
        thread.join(20.0)
        assert not thread.is_alive()


def until(live: LiveWorld, found: Any, limit: float = 20.0) -> dict[str, Any]:
    end = time.monotonic() + limit
    while True:
        with live.told:
            live.told.wait(0.2)
            state = json.loads(live.state) if live.state else {}
        if state and found(state):
            return state
        assert time.monotonic() < end, state


# ---- the world ------------------------------------------------------------------------------


def path_of(live: LiveWorld) -> np.ndarray[Any, Any]:
    return np.asarray(live.replay().robots[0].position)


@pytest.mark.parametrize("law", [FIELD, nav.OptimalReciprocalCollisionAvoidance(), SAFE], ids=lambda law: law.NAME)
def test_a_robot_alone_moves_as_in_a_run_bit_for_bit(law: nav.Law) -> None:
    with running(nav.World(robots=[robot(law)])) as live:
        until(live, lambda state: state["status"] == "arrived")
    run = nav.Run(nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), control_period=PERIOD), law)
    while not run.finished:
        run.step()
    expected, found = run.trajectory.position[::5][:-1], path_of(live)
    assert len(expected) > 100
    assert np.array_equal(found[: len(expected)], expected)


@pytest.mark.parametrize("law", [nav.OptimalReciprocalCollisionAvoidance(), SAFE], ids=lambda law: law.NAME)
def test_among_people_who_walk_on_it_moves_as_in_a_run(law: nav.Law) -> None:
    ways = [((0.0, 20.0), ((7.0, 0.3), (-3.0, 0.3))), ((0.0, 20.0), ((3.0, -4.0), (3.0, 6.0)))]
    people = [nav.Person(start=places[0], recording=(times, places), radius=0.3) for times, places in ways]
    with running(nav.World(people=people, robots=[robot(law)])) as live:
        until(live, lambda state: state["status"] == "arrived")
    bodies = [nav.Human.from_path(times, places, radius=0.3, max_speed=1.6) for times, places in ways]
    scene = nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), control_period=PERIOD, obstacles=bodies)
    run = nav.Run(scene, law)
    while not run.finished:
        run.step()
    expected, found = run.trajectory.position[::5][:-1], path_of(live)
    assert np.abs(found[: len(expected)] - expected).max() < 1e-9


def test_who_is_dragged_is_where_the_hand_is_and_walks_on_when_let_go() -> None:
    people = [nav.Person(start=(4.0, 2.0), route=[(4.0, -8.0)], desired_speed=1.0)]
    with running(nav.World(people=people, robots=[robot()]), pace=4.0) as live:
        until(live, lambda state: state["time"] > 0.5)
        live.change({"kind": "person", "number": 0, "place": [3.0, 3.0]})
        held = until(live, lambda state: state["held"] == [0])
        assert held["people"][0][1:3] == [3.0, 3.0]
        later = until(live, lambda state: state["time"] > held["time"] + 1.0)
        assert later["people"][0][1:3] == [3.0, 3.0]
        live.change({"kind": "person", "number": 0, "place": None})
        gone = until(live, lambda state: state["time"] > later["time"] + 2.0)
        assert gone["people"][0][2] < 2.0
        assert gone["held"] == []


def test_who_moves_as_told_goes_on_when_others_are_dragged() -> None:
    told = [
        nav.Human(start=(9.0, 2.0), velocity=(-1.0, 0.0)),
        nav.Human(start=(0.0, 3.0), velocity=(0.5, 0.0), stop=(0.5, 3.0)),
    ]
    world = nav.World(people=walkers(2), obstacles=told, robots=[robot()])
    with running(world, pace=4.0) as live:
        until(live, lambda state: state["time"] > 0.5)
        live.change({"kind": "person", "number": 0, "place": [-3.0, 3.0]})
        later = until(live, lambda state: state["time"] > 3.0)
    places = {number: (x, y) for number, x, y, _ in later["people"]}
    assert places[2] == pytest.approx((9.0 - later["time"], 2.0), abs=1e-3)
    assert places[3] == pytest.approx((0.5, 3.0), abs=1e-3)


@pytest.mark.parametrize("where", ["robot", "wall", "somebody"])
def test_people_may_be_dragged_onto_anything(where: str) -> None:
    with running(nav.World(people=walkers(3), robots=[robot(FIELD)], walls=[[(-1, 5), (7, 5)]]), pace=4.0) as live:
        state = until(live, lambda state: state["time"] > 0.5)
        for _ in range(12):
            state = json.loads(live.state)
            other = next(each for each in state["people"] if each[0] == 1)
            place = {"robot": state["robot"][:2], "wall": [2.0, 5.0], "somebody": other[1:3]}[where]
            live.change({"kind": "person", "number": 0, "place": [place[0] + 0.02, place[1]]})
            time.sleep(0.04)
        live.change({"kind": "person", "number": 0, "place": None})
        later = until(live, lambda now: now["time"] > state["time"] + 2.0)
    assert math.dist(later["robot"][:2], (0.0, 0.0)) < 3.0
    assert later["contacts"] > 0 or where != "robot"


def test_a_contact_stops_no_dragging() -> None:
    standing = nav.Person(start=(1.2, 0.0), radius=0.3)
    blind = nav.laws.PythonLaw(function=lambda _: (2.0, 0.0), name="ahead")
    with running(nav.World(people=[standing, *walkers(2)], robots=[robot(blind)]), pace=4.0) as live:
        until(live, lambda state: 0 in state["touching"])
        live.change({"kind": "person", "number": 1, "place": [-3.0, -3.0]})
        held = until(live, lambda state: state["held"] == [1])
        until(live, lambda state: state["time"] > held["time"] + 0.5)


def test_dragging_moves_nobody_else_by_itself() -> None:
    people = [*walkers(12)]
    with running(nav.World(people=people, robots=[robot()]), pace=8.0) as live:
        before = until(live, lambda state: state["time"] > 1.0)
        for step in range(20):
            live.change({"kind": "person", "number": 3, "place": [-5.0, 0.1 * step]})
            time.sleep(0.01)
        after = until(live, lambda state: state["time"] > before["time"] + 0.4)
    places = {number: (x, y) for number, x, y, _ in before["people"]}
    span = after["time"] - before["time"]
    for number, x, y, _ in after["people"]:
        if number != 3:
            assert math.dist((x, y), places[number]) <= 2.5 * span
    assert len(after["people"]) == len(before["people"])


def test_goal_law_parts_and_speeds_are_changed_while_it_runs() -> None:
    with running(nav.World(people=walkers(4), robots=[robot()], walls=[[(0, 5), (9, 5)]]), pace=4.0) as live:
        live.change({"kind": "goal", "place": [1.0, -2.0]})
        until(live, lambda state: state["goal"] == [1.0, -2.0] and state["status"] == "arrived")
        live.change({"kind": "goal", "place": [5.0, 5.05]})
        assert "wall" in until(live, lambda state: state["refused"])["refused"]
        for name, value in (("law", "khatib"), ("shield", False), ("yielding", False), ("noise", 0.1), ("delay", 0.3)):
            live.change({"kind": "setting", "name": name, "value": value})
            found = until(live, lambda state, name=name, value=value: state["settings"][name] == value)
            assert found["refused"] == ""
        live.change({"kind": "setting", "name": "robot_speed", "value": 0.2})
        live.change({"kind": "goal", "place": [6.0, -2.0]})
        slow = until(live, lambda state: state["settings"]["robot_speed"] == 0.2)
        speeds = [
            until(live, lambda state, after=slow["time"] + 1.0 + k: state["time"] > after)["speed"] for k in range(3)
        ]
        assert max(speeds) <= 0.2 + 1e-6
        assert json.loads(live.state)["status"] is None  # no shield: nothing is promised
        live.change({"kind": "pause", "on": True})
        still = until(live, lambda state: state["paused"])
        time.sleep(0.3)
        assert json.loads(live.state)["time"] == still["time"]
        live.change({"kind": "pause", "on": False})
        live.change({"kind": "restart"})
        until(live, lambda state: state["time"] < still["time"] and not state["paused"])


@pytest.mark.parametrize(
    "wish",
    [
        {},
        {"kind": "fly"},
        {"kind": "goal", "place": [1.0]},
        {"kind": "goal", "place": [math.nan, 0.0]},
        {"kind": "goal", "place": "here"},
        {"kind": "person", "number": 99, "place": [0.0, 0.0]},
        {"kind": "person", "number": 0, "place": [1e300, 0.0]},
        {"kind": "person", "number": True, "place": [0.0, 0.0]},
        {"kind": "setting", "name": "robot_speed", "value": 1e9},
        {"kind": "setting", "name": "law", "value": "magic"},
        {"kind": "setting", "name": "__class__", "value": 1},
        {"kind": "setting", "name": "shield", "value": "yes"},
    ],
    ids=str,
)
def test_what_cannot_be_is_refused_in_words_and_the_world_goes_on(wish: dict[str, Any]) -> None:
    with running(nav.World(people=walkers(2), robots=[robot()]), pace=8.0) as live:
        live.change(wish)
        told = until(live, lambda state: state["refused"])
        until(live, lambda state: state["time"] > told["time"] + 0.3)


def test_fifty_people_are_told_twenty_times_a_second() -> None:
    with running(nav.World(people=walkers(50), robots=[robot()])) as live:
        begin = time.perf_counter()
        until(live, lambda state: state["time"] > 10.0)
        took = time.perf_counter() - begin
    assert took < 10.0  # as fast as it can, on a busy machine


def test_an_outline_is_told_and_touches_by_itself() -> None:
    outline = nav.robots.Footprint.rectangle(0.8, 0.3)
    body = nav.DifferentialDriveRobot(footprint=outline)
    # Beside the robot, within the circle around it.
    person = nav.Person(start=(0.0, 0.4), radius=0.2)
    wall = [(-5.0, -0.3), (5.0, -0.3)]
    world = nav.World(
        people=[person], robots=[nav.Robot(body, start=(0.0, 0.0), goal=(4.0, 0.0), law=SAFE)], walls=[wall]
    )
    live = LiveWorld(world)
    assert [tuple(each) for each in live.scene()["footprint"]] == list(outline.corners)
    assert live._away(np.array([0.0, 0.4])) == pytest.approx(0.25)
    assert live._wall_gap() == pytest.approx(0.15)
    with running(world) as moving:
        until(moving, lambda state: state["time"] > 0.2)
        assert moving._contacts == 0
        played = moving.replay().robots[0]
    assert tuple(played.footprint) == outline.corners
    assert played.heading is not None


def test_what_happened_can_be_kept() -> None:
    with running(nav.World(people=walkers(3), robots=[robot()]), pace=8.0) as live:
        until(live, lambda state: state["time"] > 1.0)
        live.change({"kind": "person", "number": 1, "place": [-2.0, 0.0]})
        until(live, lambda state: state["held"])
    kept = live.replay()
    assert (np.diff(kept.time) > 0.0).all()
    assert kept.people is not None
    assert kept.people.shape[1] == 3
    with pytest.raises(InvalidParameterError, match="one robot"):
        LiveWorld(nav.World(people=walkers(2)))


# ---- the server -----------------------------------------------------------------------------


@dataclass
class Served:
    """A served world."""

    address: str = ""
    told: threading.Event = field(default_factory=threading.Event)
    thread: threading.Thread | None = None

    @property
    def port(self) -> int:
        found = urlsplit(self.address).port
        assert found is not None
        return found

    @property
    def token(self) -> str:
        return parse_qs(urlsplit(self.address).query)["token"][0]

    def say(self, address: str) -> None:
        self.address = address
        self.told.set()


@contextmanager
def served(world: nav.World | None = None, grace: float = 0.5) -> Iterator[Served]:
    found = Served()
    given = scenarios.load_world(HALL) if world is None else world
    options: dict[str, Any] = {"browser": False, "said": found.say, "grace": grace}
    found.thread = threading.Thread(target=serve, args=(given,), kwargs=options)
    found.thread.start()
    assert found.told.wait(20.0)
    yield found
    # Whoever looked has gone: it ends by itself.
    found.thread.join(20.0)
    assert not found.thread.is_alive()


def ask(
    of: Served, path: str, *, method: str = "GET", headers: dict[str, str] | None = None, body: bytes | None = None
) -> tuple[int, bytes]:
    line = http.client.HTTPConnection("127.0.0.1", of.port, timeout=10)
    try:
        line.request(method, path, body=body, headers=headers or {})
        answer = line.getresponse()
        return answer.status, answer.read()
    finally:
        line.close()


@contextmanager
def states(of: Served) -> Iterator[Iterator[dict[str, Any]]]:
    line = http.client.HTTPConnection("127.0.0.1", of.port, timeout=10)
    line.request("GET", f"/states?token={of.token}")
    answer = line.getresponse()
    assert answer.status == 200
    assert answer.getheader("Content-Type") == "text/event-stream"

    def each() -> Iterator[dict[str, Any]]:
        while True:
            text = answer.readline()
            if text.startswith(b"data: "):
                yield json.loads(text[6:])

    try:
        yield each()
    finally:
        line.close()
        answer.close()


def test_only_the_own_page_may_ask() -> None:
    with served() as world, states(world) as told:
        next(told)
        right = f"/?token={world.token}"
        assert ask(world, right)[0] == 200
        assert ask(world, right, headers={"Host": f"localhost:{world.port}"})[0] == 200
        own = f"http://127.0.0.1:{world.port}"
        for path, headers in (
            ("/", {}),
            ("/?token=", {}),
            ("/?token=x", {}),
            (f"/?token={world.token}x", {}),
            ("/?token=%C3%A4", {}),
            (right, {"Host": "evil.example"}),
            (right, {"Host": f"evil.example:{world.port}"}),
            (right, {"Origin": "http://evil.example"}),
            (right, {"Origin": "null"}),
            (right, {"Origin": f"http://localhost:{world.port + 1}"}),
            ("/states", {"Origin": own}),
        ):
            assert ask(world, path, headers=headers)[0] == 403, (path, headers)
        wishes = f"/wishes?token={world.token}"
        assert ask(world, wishes, method="POST", body=b'{"kind": "pause", "on": false}')[0] == 204
        foreign = {"Origin": "http://evil.example"}
        assert ask(world, wishes, method="POST", body=b'{"kind": "restart"}', headers=foreign)[0] == 403
        assert ask(world, "/wishes", method="POST", body=b"{}")[0] == 403
        for body in (b"", b"[]", b"nonsense", b"\xff\xfe", b"[" * 9000):
            assert ask(world, wishes, method="POST", body=body)[0] == 400
        assert ask(world, wishes, method="POST", body=b" " * 20_000)[0] == 413
        assert ask(world, wishes, method="POST", headers={"Content-Length": "-1"})[0] == 413
        assert ask(world, f"/etc/passwd?token={world.token}")[0] == 404
        assert next(told)["time"] >= 0.0


def test_a_plain_client_sees_twenty_states_a_second_and_what_it_wished() -> None:
    with served(nav.World(people=walkers(50), robots=[robot()])) as world, states(world) as told:
        first = next(told)
        begin, number = time.perf_counter(), 0
        while time.perf_counter() - begin < 3.0:
            state, number = next(told), number + 1
        assert state["time"] - first["time"] > 1.0
        assert number > 15  # on a busy machine
        wish = json.dumps({"kind": "goal", "place": [2.0, 2.0]}).encode()
        assert ask(world, f"/wishes?token={world.token}", method="POST", body=wish)[0] == 204
        assert any(next(told)["goal"] == [2.0, 2.0] for _ in range(60))


def test_it_listens_on_this_machine_only_and_ends_with_its_page() -> None:
    command = [sys.executable, "-m", "hrsafety", "play", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        world = Served(address=process.stdout.readline().strip())
        assert world.address.startswith("http://127.0.0.1:")
        with states(world) as told:
            next(told)
        assert process.wait(20.0) == 0


def test_people_and_the_goal_are_dragged_in_a_browser() -> None:
    with served(grace=4.0) as world, tab() as browser:
        for width, height in ((1300, 900), (420, 900)):
            browser.size(width, height)
            browser.open(world.address)
            browser.wait("+document.body.dataset.time > 0.3")
            assert browser.value("document.documentElement.scrollWidth") <= width
            box = browser.value(
                "(() => { const b = document.getElementById('floor').getBoundingClientRect();"
                " return [b.left, b.top, b.width, b.height]; })()"
            )
            view = json.loads(browser.value("document.getElementById('scene').textContent"))["view"]
            scale = min(box[2] / (view[2] - view[0]), box[3] / (view[3] - view[1]))

            def pixel(x: float, y: float, box: Any = box, view: Any = view, scale: float = scale) -> Any:
                middle = (view[0] + view[2]) / 2, (view[1] + view[3]) / 2
                across = box[0] + box[2] / 2 + (x - middle[0]) * scale
                return across, box[1] + box[3] / 2 - (y - middle[1]) * scale

            goal = tuple(map(float, browser.data("goal").split(",")))
            browser.drag(pixel(*goal), pixel(8.0, -2.0))
            browser.wait("Math.hypot(...document.body.dataset.goal.split(',').map((v, k) => v - [8, -2][k])) < 0.1")
            browser.value("document.getElementById('floor').focus(); 1")
            for key in ("n", "ArrowUp"):
                browser.press(key)
            browser.wait("document.getElementById('said').textContent.includes('Person')")
            browser.press("g")
            browser.press("ArrowLeft")
            browser.wait("+document.body.dataset.goal.split(',')[0] < 7.85")
            browser.value("document.getElementById('pause').click(); 1")
            browser.wait("document.body.dataset.paused === 'yes'")
            browser.value("document.getElementById('pause').click(); 1")
            browser.wait("document.body.dataset.paused === 'no'")
            browser.value("document.getElementById('shield').click(); 1")
            browser.wait("document.getElementById('word').textContent === 'No shield' || document.body.dataset.status")
            browser.value("document.getElementById('shield').click(); 1")
            assert browser.errors == []
