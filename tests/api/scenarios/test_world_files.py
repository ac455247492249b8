from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.errors import InvalidParameterError

ROOT = Path(__file__).resolve().parents[3]
ROOM = "start = [0.0, 0.0]\ngoal = [8.0, 0.0]\n"
PERSON = "[[people]]\nstart = [6.0, 0.2]\n"


def loaded(folder: Path, text: str) -> nav.World:
    path = folder / "world.toml"
    path.write_text(text)
    return scenarios.load_world(path)


def test_a_full_file_says_what_the_constructors_say(tmp_path: Path) -> None:
    text = f"""{ROOM}
walls = [[[-1, 2], [9, 2]], [[-1, -2], [9, -2], [9, 0]]]
step = 0.025
control_period = 0.1
time_limit = 30
arrival_tolerance = 0.25
heading = 0.5
seed = 7
[robot]
type = "differential_drive"
radius = 0.25
[measurement]
scale = 0.01
[law]
type = "orca"
[[obstacles]]
type = "disc"
center = [4, 1]
radius = 0.2
[[people]]
start = [6, 0.2]
route = [[0, 0.2], [[0, 1], [0, 2]]]
model = "social_force_1995"
radius = 0.3
desired_speed = 1.2
velocity = [-1, 0]
at_end = "repeat"
awareness = 0.5
enters = 2
group = 3
[[sources]]
low = [7, -1]
high = [8, 1]
rate = 0.4
arrivals = "regular"
route = [[0, 0]]
distracted_share = 0.2
"""
    robot = nav.Robot(
        start=(0.0, 0.0),
        goal=(8.0, 0.0),
        law=nav.OptimalReciprocalCollisionAvoidance(),
        body=nav.DifferentialDriveRobot(radius=0.25),
        control_period=0.1,
        arrival_tolerance=0.25,
        heading=0.5,
        measurement=nav.Measurement(scale=0.01),
    )
    person = nav.Person(
        start=(6, 0.2),
        route=[(0, 0.2), ((0, 1), (0, 2))],
        model=nav.crowd.SocialForce1995(),
        radius=0.3,
        desired_speed=1.2,
        velocity=(-1, 0),
        at_end="repeat",
        awareness=0.5,
        enters=2,
        group=3,
    )
    source = nav.Source(low=(7, -1), high=(8, 1), rate=0.4, arrivals="regular", route=[(0, 0)], distracted_share=0.2)
    world = loaded(tmp_path, text)
    assert (world.robots, world.people, world.sources) == ((robot,), (person,), (source,))
    assert (world.step, world.time_limit, world.seed) == (0.025, 30.0, 7)
    assert [type(wall) for wall in world.walls] == [tuple, tuple, nav.Disc]


def test_every_scenario_file_is_a_world_with_the_same_people() -> None:
    path = ROOT / "examples" / "my_first_crossing.toml"
    world, scenario = scenarios.load_world(path), scenarios.load(path).scenario
    assert len(world.people) == 3
    assert len(world.walls) == 2
    run = nav.simulate(world)
    still = nav.simulate(scenario, lambda _: np.zeros(2))
    same = np.isin(np.round(still.time, 6), np.round(run.time, 6))
    moving = [index for index, each in enumerate(scenario.obstacles) if not isinstance(each, (nav.Disc, nav.Rectangle))]
    rows = min(len(run.time), int(same.sum()), 100)
    np.testing.assert_allclose(
        run.obstacle_position[:rows], still.obstacle_position[same][:rows, moving], atol=1e-6, equal_nan=True
    )


def test_steps_divide_control_periods(tmp_path: Path) -> None:
    world = loaded(tmp_path, ROOM + "control_period = 0.12\n" + PERSON)
    assert world.step == pytest.approx(0.04)
    assert loaded(tmp_path, ROOM).step == 0.05


PGM = "P2\n8 4\n255\n" + "0 " * 8 + ("0 " + "254 " * 6 + "0 ") * 2 + "0 " * 8
YAML = "image: hall.pgm\nresolution: 1.0\norigin: [-1, -2, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"


def test_a_map_is_what_stands_and_what_the_law_knows(tmp_path: Path) -> None:
    (tmp_path / "hall.pgm").write_text(PGM)
    (tmp_path / "hall.yaml").write_text(YAML)
    text = 'start = [0.5, 0.0]\ngoal = [5.0, 0.0]\nmap = "hall.yaml"\nwalls = [[[3, 0.5], [3, 1]]]\n'
    world = loaded(
        tmp_path,
        text + "[robot]\nmax_speed = 0.5\n[safe.shield]\n[[people]]\nstart = [5.0, 0.5]\nroute = [[0.5, 0.5]]\n",
    )
    assert isinstance(world.walls, nav.StaticMap)
    assert world.walls.clearance((1.0, 0.0)) == pytest.approx(1.0)
    assert world.walls.clearance((3.0, 0.4)) == pytest.approx(0.1)
    law = world.robots[0].law
    assert isinstance(law, nav.SafeNavigation)
    assert law.map == world.walls
    assert not [each for each in world.warnings if each.code == "unknown_wall"]
    with pytest.raises(InvalidParameterError, match="map must"):
        loaded(tmp_path, text.replace("hall.yaml", "hell.yaml"))
    with pytest.raises(InvalidParameterError, match=r"walls\[0\]"):
        loaded(tmp_path, text.replace("[[[3, 0.5], [3, 1]]]", "[[[3, 0.5], [3, 0.5]]]"))


def test_what_means_nothing_is_said(tmp_path: Path) -> None:
    assert [each.code for each in loaded(tmp_path, ROOM + "rest_time = 3\n").doubts] == ["not_used"]


@pytest.mark.parametrize(
    ("text", "argument"),
    [
        (PERSON + "root = [[1, 2]]\n", "people[0].root"),
        (PERSON + 'model = "social_force"\n', "people[0].model"),
        (PERSON + "route = [1, 2]\n", "people[0].route[0]"),
        (PERSON + "route = 1\n", "people[0].route"),
        (PERSON + "radius = -1\n", "people[0].radius"),
        ("[[people]]\nradius = 0.2\n", "people[0].start"),
        ("[[sources]]\nlow = [0, 0]\nhigh = [1, 1]\nrate = 1\n", "sources[0].route"),
        ("walls = [[1, 2]]\n", "walls[0][0]"),
        ("step = 0\n", "step"),
        ("control_period = 0.1\nstep = 0.03\n", "robots[0].control_period"),
        ('[[obstacles]]\ntype = "moving_rectangle"\nlength = 1\nwidth = 1\ncenter = [3, 3]\nvelocity = [1, 0]\n', ""),
        (PERSON + "walls = []\n", "people[0].walls"),
    ],
)
def test_bad_worlds_name_the_key(text: str, argument: str, tmp_path: Path) -> None:
    with pytest.raises(InvalidParameterError) as failure:
        loaded(tmp_path, ROOM + text)
    assert failure.value.argument == (argument or "obstacles[0].type")
