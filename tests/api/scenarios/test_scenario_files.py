from __future__ import annotations

from pathlib import Path

import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.errors import InvalidParameterError

ROOT = Path(__file__).resolve().parents[3]

ROOM = "start = [4.0, 0.0]\ngoal = [0.0, 0.0]\n"
DISC = '[[obstacles]]\ntype = "disc"\ncenter = [2.0, 0.5]\nradius = 0.1\n'


DISC_ROOM = ROOM + DISC
HUMAN = ROOM + '[[obstacles]]\ntype = "human"\n'
LAW = ROOM + '[law]\ntype = "virtual_force_field"\n'
OBSTACLE = r"obstacles\[0\]"


def loaded(folder: Path, text: str | bytes) -> scenarios.ScenarioFile:
    path = folder / "scene.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return scenarios.load(path)


def test_a_file_with_start_and_goal_has_defaults_for_the_rest(tmp_path: Path) -> None:
    scenario, law = loaded(tmp_path, ROOM)
    assert scenario == nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0))
    assert law == nav.VirtualForceField()


def test_robot_may_have_two_wheels(tmp_path: Path) -> None:
    table = """
[robot]
type = "differential_drive"
wheel_span = 0.3
reference_speed_share = 0.8
wheel_inertia = [0.008, 0.006]
"""
    scenario, law = loaded(tmp_path, ROOM + table)
    robot = nav.DifferentialDriveRobot(wheel_span=0.3, reference_speed_share=0.8, wheel_inertia=(0.008, 0.006))
    assert scenario.robot == robot
    run = nav.simulate(scenario, law)
    assert run.outcome == "arrived"
    assert run.wheel_current.shape[1] == 2


def test_a_full_file_says_what_the_constructors_say(tmp_path: Path) -> None:
    (tmp_path / "walk.csv").write_text("t_s,x_m,y_m\n0,1,3\n2,1,5\n")
    text = f"""{ROOM}
control_period = 0.05
time_limit = 30
arrival_tolerance = 0.1
heading = 0.5
rest_time = 20
seed = 7
[robot]
type = "holonomic"
mass = 5
wheel_inertia = [0.01, 0.02, 0.03]
[measurement]
scale = 0.01
distribution = "gaussian"
of = "both"
[law]
type = "virtual_force_field"
attractive_gain = 4.3
stabilizing = "capped"
stabilizing_force_cap = 10
pass_behind = false
side_hysteresis = 3.0
{DISC}
[[obstacles]]
type = "rectangle"
center = [2, -2]
length = 1
width = 0.5
heading = 0.3
[[obstacles]]
type = "human"
start = [1, 1]
velocity = [1, 0]
stop = [3, 1]
radius = 0.35
max_speed = 1.2
[[obstacles]]
type = "human"
start = [1, 2]
segments = [{{ duration = 1, velocity = [1, 0] }}, {{ duration = 2, velocity = [1, 0], acceleration = [0, 1] }}]
[[obstacles]]
type = "human"
time = [0, 1]
position = [[1, 4], [2, 4]]
[[obstacles]]
type = "human"
path = "walk.csv"
active_radius = 2.1
critical_radius = 0.8
[[obstacles]]
type = "moving_disc"
center = [3, 4]
radius = 0.2
velocity = [0, -0.5]
acceleration = [0, 0.1]
"""
    scenario, law = loaded(tmp_path, text)
    expected = nav.Scenario(
        start=(4.0, 0.0),
        goal=(0.0, 0.0),
        robot=nav.HolonomicRobot(mass=5.0, wheel_inertia=(0.01, 0.02, 0.03)),
        control_period=0.05,
        time_limit=30.0,
        arrival_tolerance=0.1,
        heading=0.5,
        rest_time=20.0,
        seed=7,
        measurement=nav.Measurement(scale=0.01, distribution="gaussian", of="both"),
        obstacles=(
            nav.Disc(center=(2.0, 0.5), radius=0.1),
            nav.Rectangle(center=(2, -2), length=1, width=0.5, heading=0.3),
            nav.Human(start=(1, 1), velocity=(1, 0), stop=(3, 1), radius=0.35, max_speed=1.2),
            nav.Human.from_segments((1, 2), [(1, (1, 0), (0, 0)), (2, (1, 0), (0, 1))]),
            nav.Human.from_path([0, 1], [[1, 4], [2, 4]]),
            nav.Human.from_path([0, 2], [[1, 3], [1, 5]], active_radius=2.1, critical_radius=0.8),
            nav.MovingDisc(center=(3, 4), radius=0.2, velocity=(0, -0.5), acceleration=(0, 0.1)),
        ),
    )
    assert scenario == expected
    assert law == nav.VirtualForceField(
        attractive_gain=4.3, stabilizing="capped", stabilizing_force_cap=10.0, pass_behind=False, side_hysteresis=3.0
    )


BAD_FILES = {
    "empty": ("", "start must be given, got nothing"),
    "no goal": ("start = [0, 0]\n", "goal must be given, got nothing"),
    "unknown top key": (ROOM + "gaol = 1\n", "gaol must be one of the keys start, goal, .*, got an unknown key"),
    "unknown robot key": (ROOM + "[robot]\nwieght = 1\n", r"robot\.wieght must be one of the keys"),
    "unknown law key": (LAW + "K1 = 1\n", r"law\.K1 must be one of the keys"),
    "unknown measurement key": (ROOM + "[measurement]\nsigma = 1\n", r"measurement\.sigma must be one of"),
    "unknown obstacle key": (DISC_ROOM + "colour = 1\n", OBSTACLE + r"\.colour must be one of the keys"),
    "unknown obstacle type": (
        ROOM + '[[obstacles]]\ntype = "wall"\n',
        OBSTACLE + r"\.type must be disc or .*'wall'",
    ),
    "no obstacle type": (ROOM + "[[obstacles]]\nradius = 1\n", OBSTACLE + r"\.type must be given"),
    "obstacle type number": (
        ROOM + "[[obstacles]]\ntype = 1\n",
        OBSTACLE + r"\.type must be a text in quotes, got 1",
    ),
    "unknown law": (
        ROOM + '[law]\ntype = "astar"\n',
        r"law\.type must be virtual_force_field or masoud or .*, got 'astar'",
    ),
    "no law type": (ROOM + "[law]\ngain_ratio = 1\n", r"law\.type must be given"),
    "unknown robot": (
        ROOM + '[robot]\ntype = "car"\n',
        r"robot\.type must be holonomic or differential_drive, got 'car'",
    ),
    "no radius": (ROOM + '[[obstacles]]\ntype = "disc"\ncenter = [1, 1]\n', OBSTACLE + r"\.radius must be given"),
    "second radius": (
        DISC_ROOM + DISC.replace("0.1", "-0.1"),
        r"obstacles\[1\]\.radius must be .*positive.*, got -0.1",
    ),
    "radius text": (DISC_ROOM.replace("0.1", '"0.1"'), OBSTACLE + r"\.radius must be a number, got '0.1'"),
    "radius true": (DISC_ROOM.replace("0.1", "true"), OBSTACLE + r"\.radius must be a number, got true"),
    "radius nan": (DISC_ROOM.replace("0.1", "nan"), OBSTACLE + r"\.radius must be .*finite.*, got nan"),
    "radius date": (DISC_ROOM.replace("0.1", "2020-01-01"), OBSTACLE + r"\.radius must be a number"),
    "radius huge": (
        DISC_ROOM.replace("0.1", "0x" + "f" * 5000),
        OBSTACLE + r"\.radius must be a number that fits",
    ),
    "center scalar": (
        DISC_ROOM.replace("[2.0, 0.5]", "2.0"),
        OBSTACLE + r"\.center must be an array of 2 numbers",
    ),
    "center of three": (
        DISC_ROOM.replace("[2.0, 0.5]", "[1, 2, 3]"),
        OBSTACLE + r"\.center must be an array of 2",
    ),
    "center of texts": (
        DISC_ROOM.replace("[2.0, 0.5]", '["1", "2"]'),
        OBSTACLE + r"\.center must be an array of 2",
    ),
    "start true": ("start = [true, 1]\ngoal = [5, 5]\n", "start must be an array of 2 numbers"),
    "start inf": ("start = [inf, 1]\ngoal = [5, 5]\n", "start.* must .*finite"),
    "obstacles table": (
        ROOM + "[obstacles]\ntype = 1\n",
        "obstacles must be an array of tables, got a single table; write",
    ),
    "obstacles numbers": (ROOM + "obstacles = [1]\n", r"obstacles\[0\] must be a table, got 1"),
    "robot number": (ROOM + "robot = 1\n", "robot must be a table, got 1"),
    "seed float": (ROOM + "seed = 1.5\n", "seed must be an integer"),
    "seed negative": (ROOM + "seed = -1\n", "seed must be an integer from 0"),
    "key of another robot": (
        ROOM + "[robot]\nwheel_span = 0.3\n",
        r"robot\.wheel_span must be one of the keys",
    ),
    "two wheels": (
        ROOM + '[robot]\ntype = "differential_drive"\nwheel_inertia = [1, 2, 3]\n',
        r"robot\.wheel_inertia must be an array of 2 numbers",
    ),
    "wheels": (ROOM + "[robot]\nwheel_inertia = [1, 2]\n", r"robot\.wheel_inertia must be an array of 3 numbers"),
    "mass": (ROOM + "[robot]\nmass = 0\n", r"robot\.mass must be .*positive.*, got 0"),
    "noise": (ROOM + "[measurement]\nscale = -1\n", r"measurement\.scale must"),
    "distribution": (ROOM + '[measurement]\ndistribution = "normal"\n', r"measurement\.distribution must"),
    "gain": (LAW + "detour_gain = -1\n", r"law\..*detour_gain.* must"),
    "stabilizing": (LAW + 'stabilizing = "on"\n', r"law\.stabilizing must"),
    "pass_behind": (LAW + "pass_behind = 1\n", r"law\.pass_behind must be true"),
    "regions": (DISC_ROOM + "active_radius = 0.3\ncritical_radius = 0.4\n", OBSTACLE + r"\.active_radius must"),
    "time limit": (ROOM + "time_limit = 0\n", "time_limit must"),
    "start on goal": ("start = [0, 0]\ngoal = [0, 0]\n", "must"),
    "start in obstacle": (DISC_ROOM.replace("[2.0, 0.5]", "[4.0, 0.1]"), "start must"),
    "no velocity": (
        HUMAN + "start = [1, 1]\n",
        OBSTACLE + r"\.velocity must be given",
    ),
    "two motions": (
        HUMAN + "start = [1, 1]\ntime = [0]\nposition = [[0, 0]]\n",
        OBSTACLE + r"\.start must be one of the keys",
    ),
    "time only": (HUMAN + "time = [0]\n", OBSTACLE + r"\.position must be given"),
    "time lengths": (
        HUMAN + "time = [0, 1]\nposition = [[0, 0]]\n",
        OBSTACLE + r"\.position must have shape \(2, 2\), got an array of shape \(1, 2\)",
    ),
    "time backward": (
        HUMAN + "time = [1, 0]\nposition = [[0, 0], [1, 1]]\n",
        OBSTACLE + r"\.time.* must",
    ),
    "time empty": (HUMAN + "time = []\nposition = []\n", OBSTACLE + r"\..* must"),
    "position": (
        HUMAN + "time = [0, 1]\nposition = [[0, 0], [1]]\n",
        OBSTACLE + r"\.position\[1\] must be an array of 2 numbers",
    ),
    "segment": (
        HUMAN + "start = [1, 1]\nsegments = [{ duration = 1 }]\n",
        OBSTACLE + r"\.segments\[0\]\.velocity must be given",
    ),
    "segment duration": (
        HUMAN + "start = [1, 1]\nsegments = [{ duration = -1, velocity = [0, 0] }]\n",
        OBSTACLE + r"\.segments\[0\].* must",
    ),
    "segment key": (
        HUMAN + "start = [1, 1]\nsegments = [{ length = 1 }]\n",
        OBSTACLE + r"\.segments\[0\]\.length must be one of the keys",
    ),
    "no segment": (
        HUMAN + "start = [1, 1]\nsegments = []\n",
        OBSTACLE + r"\.segments",
    ),
    "stop behind": (
        HUMAN + "start = [1, 1]\nvelocity = [1, 0]\nstop = [0, 1]\n",
        OBSTACLE + r"\.stop must",
    ),
    "no recording": (
        HUMAN + 'path = "nowhere.csv"\n',
        OBSTACLE + r"\.path must name a readable file",
    ),
    "bad recording": (
        HUMAN + 'path = "scene.toml"\n',
        OBSTACLE + r"\.path: scene\.toml, line 1 must have a column for a time or a frame and x and y",
    ),
    "disc without radius": (
        ROOM + '[[obstacles]]\ntype = "moving_disc"\ncenter = [1, 1]\nvelocity = [1, 0]\n',
        OBSTACLE + r"\.radius must be given",
    ),
    "not toml": ("start = 4.0 0.6\n", r"scene\.toml must be a TOML file, got an error: .*line"),
    "key twice": (ROOM + "start = [1, 1]\n", r"scene\.toml must be a TOML file"),
    "not utf-8": (b"start = [4.0, 0.0]\n# caf\xe9\n", r"scene\.toml must be UTF-8 text, got byte 0xe9"),
    "binary": (bytes(range(256)), r"scene\.toml must be"),
    "deep brackets": (ROOM + "heading = " + "[" * 100_000, r"scene\.toml must be a TOML file"),
    "deep tables": (ROOM + "[law" + ".a" * 3000 + "]\nb = 1\n", r"law\.type must be given"),
    "huge array": (
        ROOM + "heading = [" + "[1, 2], " * 20_000 + "]\n",
        "heading must be a number, got an array of 20000",
    ),
    "huge decimal": (ROOM + "heading = " + "9" * 5000 + "\n", "must"),
    "long key": (ROOM + "a" * 5000 + " = 1\n", "must be one of the keys"),
    "array of huge": (ROOM + "heading = [0x" + "f" * 5000 + "]\n", "heading must be a number"),
}
LONGEST_MESSAGE = 500
"""Messages must be readable on a terminal, whatever stands in the file."""


@pytest.mark.parametrize(("text", "message"), BAD_FILES.values(), ids=BAD_FILES.keys())
def test_a_bad_file_is_an_error_that_names_the_key(tmp_path: Path, text: str | bytes, message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message) as caught:
        loaded(tmp_path, text)
    assert len(str(caught.value)) < LONGEST_MESSAGE


@pytest.mark.parametrize("name", ["missing.toml", "", "."])
def test_what_is_not_a_file_cannot_be_loaded(tmp_path: Path, name: str) -> None:
    with pytest.raises(InvalidParameterError, match="path must name a readable file"):
        scenarios.load(tmp_path / name)


def test_the_example_file_arrives() -> None:
    scenario, law = scenarios.load(ROOT / "examples" / "my_first_crossing.toml")
    assert nav.simulate(scenario, law).outcome == "arrived"
