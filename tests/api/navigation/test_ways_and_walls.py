"""People who walk through what stands, goals where they stop, and walls in all the forms that a place takes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.errors import InvalidParameterError, ShapeError

LINE = [(2.0, 1.0), (2.0, 3.0)]
TABLE = nav.Rectangle(center=(2.0, 2.0), length=0.6, width=0.6)
AHEAD = (0.0, 2.0)
STILL = (0.0, 0.0)
THROUGH: dict[str, nav.Human] = {
    "straight": nav.Human(start=AHEAD, velocity=(1.0, 0.0)),
    "stops behind it": nav.Human(start=AHEAD, velocity=(1.0, 0.0), stop=(4.0, 2.0)),
    "after the last segment": nav.Human.from_segments(AHEAD, [(1.0, (1.0, 0.0), STILL)]),
    "accelerates": nav.Human.from_segments((0.0, 2.0), [(9.0, (0.0, 0.0), (0.1, 0.0))]),
    "recorded": nav.Human.from_path([0.0, 4.0], [AHEAD, (4.0, 2.0)]),
}
PAST: dict[str, nav.Human] = {
    "beside": nav.Human(start=(0.0, 3.5), velocity=(1.0, 0.0)),
    "stops before it": nav.Human(start=AHEAD, velocity=(1.0, 0.0), stop=(1.0, 2.0)),
    "brakes before it": nav.Human.from_segments(AHEAD, [(1.0, (1.0, 0.0), STILL), (1.0, (1.0, 0.0), (-1.0, 0.0))]),
    "around": nav.Human.from_path([0.0, 2.0, 4.0], [AHEAD, (2.0, 3.5), (4.0, 2.0)]),
    "too late": nav.Human(start=(-70.0, 2.0), velocity=(1.0, 0.0)),
}
CODES = {"way_through_wall", "recording_in_wall"}


def in_file(folder: Path, person: nav.Human) -> nav.Scenario:
    """Return a scenario as a file describes it."""
    motion = f"start = {list(person.start)}\nvelocity = {list(person.velocity)}"
    if person.segments is not None:
        parts = [
            f"{{duration = {each}, velocity = {list(v)}, acceleration = {list(a)}}}" for each, v, a in person.segments
        ]
        motion = f"start = {list(person.start)}\nsegments = [{', '.join(parts)}]"
    if person.path is not None:
        motion = f"time = {list(person.path[0])}\nposition = {[list(place) for place in person.path[1]]}"
    if person.stop is not None:
        motion += f"\nstop = {list(person.stop)}"
    file = folder / "scene.toml"
    lines = [list(map(list, LINE))]
    file.write_text(f'start = [0, 0]\ngoal = [6, 0]\nwalls = {lines}\n[[obstacles]]\ntype = "human"\n{motion}\n')
    return scenarios.load(file).scenario


def places(folder: Path, person: nav.Human) -> dict[str, nav.Scenario | nav.World]:
    """Return places of all kinds in which a person meets a wall or a table."""
    ends: dict[str, Any] = {"start": (0.0, 0.0), "goal": (6.0, 0.0)}
    world: dict[str, Any] = {"robots": [nav.Robot(**ends)], "time_limit": 60.0}
    return {
        "table": nav.Scenario(**ends, obstacles=[TABLE, person]),
        "walls": nav.Scenario(**ends, obstacles=[person], walls=[LINE]),
        "map": nav.Scenario(**ends, obstacles=[person], walls=nav.StaticMap.from_polylines([LINE])),
        "file": in_file(folder, person),
        "world": nav.World(obstacles=[person], walls=[LINE], **world),
        "world with a map": nav.World(obstacles=[person], walls=nav.StaticMap.from_polylines([LINE]), **world),
        "world with a table": nav.World(obstacles=[TABLE, person], **world),
    }


@pytest.mark.parametrize("name", THROUGH)
def test_nobody_walks_through_what_stands_unnoticed(name: str, tmp_path: Path) -> None:
    for kind, place in places(tmp_path, THROUGH[name]).items():
        (found,) = [each for each in place.warnings if each.code in CODES]
        assert (found.code == "recording_in_wall") == (name == "recorded")
        assert not found.safe_side
        edge = 1.7 if "table" in kind else 2.0
        assert f"at ({edge:g}, 2) m at " in found.message
    run = nav.simulate(places(tmp_path, THROUGH[name])["table"], nav.VirtualForceField())
    assert CODES & {each.code for each in run.warnings}


def test_the_doubt_tells_when() -> None:
    (found,) = nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), obstacles=[THROUGH["straight"]], walls=[LINE]).warnings
    assert "at (2, 2) m at 2 s" in found.message


@pytest.mark.parametrize("name", PAST)
def test_who_passes_walls_is_no_doubt(name: str, tmp_path: Path) -> None:
    for place in places(tmp_path, PAST[name]).values():
        assert not CODES & {each.code for each in place.warnings}


def test_people_may_pass_through_each_other() -> None:
    other = nav.Human(start=(2.0, 2.0), velocity=(0.0, 0.0))
    scene = nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), obstacles=[THROUGH["straight"], other])
    assert not CODES & {each.code for each in scene.warnings}


@pytest.mark.parametrize("name", ["stops before it", "brakes before it"])
def test_a_goal_where_somebody_stops_is_a_doubt_under_laws_that_keep_to_regions(name: str) -> None:
    near = nav.Scenario(start=(6.0, 2.0), goal=(1.8, 3.0), obstacles=[PAST[name]])
    law = nav.VirtualForceField()
    shield, helped = nav.Shield(), nav.SafeNavigation(law, shield=nav.Shield(), yielding=nav.Yielding())
    for around, doubtful in ((law, True), (nav.SafeNavigation(law, shield=shield), True), (helped, False)):
        codes = {each.code for each in nav.simulate(near, around).warnings}
        assert ("goal_near_stop" in codes) == doubtful
    assert nav.simulate(near, law).outcome != "arrived"
    far = nav.Scenario(start=(6.0, 2.0), goal=(6.0, 3.0), obstacles=[PAST[name]])
    assert "goal_near_stop" not in {each.code for each in far.warnings}


SHAPES: list[Any] = [LINE, TABLE, nav.Disc(center=(2.0, -2.0), radius=0.5)]


def test_scenarios_take_the_walls_of_worlds() -> None:
    scene = nav.Scenario(start=(0.0, 2.0), goal=(6.0, 2.0), walls=SHAPES)
    assert isinstance(scene.walls, nav.StaticMap)
    assert scene.walls.clearance([(0.0, 2.0), (2.0, 2.9), (2.0, 0.0)]).tolist() == pytest.approx([1.7, 0.0, 1.0])
    run = nav.simulate(scene, nav.VirtualForceField())
    assert run.outcome == "collided"
    assert run.map_contact_time == pytest.approx(nav.simulate(scene, nav.Khatib()).map_contact_time, abs=1.0)
    assert nav.World.of(scene).walls == scene.walls
    with pytest.raises(InvalidParameterError, match="start must not be in contact with the walls"):
        nav.Scenario(start=(1.9, 2.0), goal=(6.0, 2.0), walls=SHAPES)


@pytest.mark.parametrize(
    "walls", [[[(0, 0)]], [[(0, 0), (float("nan"), 1)]], [[(0, 0), (1, 2, 3)]], [[1, 2]], ["ab"], 5, [[]]]
)
def test_both_refuse_the_same_walls_with_the_same_words(walls: Any) -> None:
    said = []
    for place in (
        lambda: nav.World(walls=walls),
        lambda: nav.Scenario(start=(2.0, 2.0), goal=(5.0, 5.0), walls=walls),
    ):
        with pytest.raises((InvalidParameterError, ShapeError)) as caught:
            place()
        said.append(str(caught.value))
    assert said[0] == said[1]


def test_files_of_scenarios_have_walls_that_the_law_knows(tmp_path: Path) -> None:
    file = tmp_path / "hall.toml"
    file.write_text("start = [0.0, 0.5]\ngoal = [6.0, 0.0]\nwalls = [[[2, -1], [2, 1]], [[3, 2], [4, 2]]]\n")
    scene, law = scenarios.load(file)
    assert scene.walls is not None
    assert [wall.points for wall in scene.walls.walls] == [((2, -1), (2, 1)), ((3, 2), (4, 2))]
    assert isinstance(law, nav.SafeNavigation)
    assert law.map is scene.walls
    run = nav.simulate(scene, law)
    assert run.outcome != "collided"
    assert "unknown_wall" not in {each.code for each in run.warnings}
    assert nav.simulate(scene, law.law).outcome == "collided"
    file.write_text("start = [0.0, 0.5]\ngoal = [6.0, 0.0]\nwalls = [[2, -1], [2, 1]]\n")
    with pytest.raises(InvalidParameterError, match=r"walls\[0\]\[0\] must be an array of 2 numbers"):
        scenarios.load(file)
