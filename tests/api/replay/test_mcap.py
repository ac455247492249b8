"""Runs as MCAP files, read back by the format's own reader."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import _replay as replay
from hrsafety import navigation as nav
from hrsafety import plotting, scenarios
from hrsafety.cli import main
from hrsafety.errors import InvalidParameterError

LAW = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(), yielding=nav.Yielding())
SCHEMAS = {
    "/tf": "foxglove.FrameTransforms",
    "/robot": "foxglove.PoseInFrame",
    "/scene": "foxglove.SceneUpdate",
    "/map": "foxglove.Grid",
    "/scan": "foxglove.LaserScan",
    "/state": "hrsafety.State",
    "/events": "foxglove.Log",
}


def read(path: Path) -> tuple[dict[str, str], dict[str, list[tuple[float, Any]]]]:
    """Return the schemas of topics, and their messages with log times in s."""
    reader = pytest.importorskip("mcap.reader")
    decoder = pytest.importorskip("mcap_protobuf.decoder")
    schemas, found = {}, defaultdict(list)
    with path.open("rb") as file:
        for schema, channel, message in reader.make_reader(file).iter_messages():
            schemas[channel.topic] = schema.name
            if channel.message_encoding == "json":
                value = json.loads(message.data)
            else:
                value = decoder.DecoderFactory().decoder_for(channel.message_encoding, schema)(message.data)
            found[channel.topic].append((message.log_time / 1e9, value))
    return schemas, dict(found)


def scene() -> tuple[nav.Scenario, nav.StaticMap]:
    cells = np.zeros((60, 90), dtype=bool)
    cells[[0, -1]] = True
    known = nav.StaticMap.from_grid(cells, resolution=0.1, origin=(-1.0, -3.0))
    person = nav.Human(start=(4.0, -1.5), velocity=(-0.2, 0.6), radius=0.3)
    return nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), obstacles=[person]), known


def test_a_run_with_map_and_lidar_has_every_topic_with_its_schema(tmp_path: Path) -> None:
    place, known = scene()
    lidar = nav.Lidar(map=known, beams=60)
    built = nav.robots.AsBuilt(sensors=[lidar])
    run = nav.simulate(place, nav.VirtualForceField(), built=built)
    schemas, found = read(plotting.mcap(run, tmp_path / "run.mcap"))
    assert schemas == SCHEMAS
    (_, grid), *more = found["/map"]
    assert not more
    assert (grid.column_count, grid.cell_size.x, grid.pose.position.x) == (90, 0.1, -1.0)
    cells = np.frombuffer(grid.data, dtype=np.uint8).reshape(60, 90)
    assert ((cells == 100) == known.grids[0].occupied).all()
    when, scan = found["/scan"][10]
    row = int(np.abs(run.time - when).argmin())
    assert len(scan.ranges) == 60
    people = [(*run.obstacle_position[row, 0], 0.3)]
    assert np.allclose(scan.ranges, lidar.scan(run.position[row], float(run.heading[row]), people=people), atol=1e-9)


def test_places_states_and_people_are_those_of_the_run(tmp_path: Path) -> None:
    place, known = scene()
    law = nav.SafeNavigation(nav.VirtualForceField(), map=known, guide=nav.Guide(), shield=nav.Shield())
    record = nav.metrics.record_safety(place, law)
    run = record.trajectory
    schemas, found = read(plotting.mcap(record, tmp_path / "run.mcap"))
    assert schemas == {topic: name for topic, name in SCHEMAS.items() if topic != "/scan"}
    rows = [int(np.abs(run.time - when).argmin()) for when, _ in found["/robot"]]
    poses = np.array([[pose.pose.position.x, pose.pose.position.y] for _, pose in found["/robot"]])
    assert np.array_equal(poses, run.position[rows])
    moves = [message.transforms[0] for _, message in found["/tf"]]
    assert {(each.parent_frame_id, each.child_frame_id) for each in moves} == {("map", "robot")}
    words = {state["verdict"] for _, state in found["/state"]}
    assert words <= set(replay.record.VERDICTS)
    assert {each.status for each in record.decisions} <= words
    least = min(state["clearance"] for _, state in found["/state"])
    assert least == pytest.approx(min(run.min_clearance[0], run.map_clearance), abs=0.01)
    people = [(when, each) for when, update in found["/scene"] for each in update.entities if each.id == "person"]
    when, first = people[5]
    row = int(np.abs(run.time - when).argmin())
    (body,) = first.cylinders
    assert (body.pose.position.x, body.pose.position.y) == tuple(run.obstacle_position[row, 0])
    assert body.size.x == pytest.approx(0.6)
    names = {each.id for _, update in found["/scene"] for each in update.entities}
    assert names == {"robot", "person", "robot swept area", "robot path"}
    assert "arrived at the goal" in [message.message for _, message in found["/events"]]


def test_a_world_of_several_robots_has_a_topic_for_each(tmp_path: Path) -> None:
    robots = [
        nav.Robot(start=(0, 0), goal=(4, 0), law=nav.VirtualForceField()),
        nav.Robot(start=(4, 1), goal=(0, 1), law=nav.OptimalReciprocalCollisionAvoidance()),
    ]
    people = [nav.Person(start=(2, -3), route=[(2, 3)], at_end="leave", desired_speed=1.3)]
    world = nav.World(robots=robots, people=people, walls=[[(-1, 4), (5, 4)]], time_limit=8)
    schemas, found = read(plotting.mcap(nav.simulate(world), tmp_path / "world.mcap"))
    assert {"/robot_0", "/robot_1", "/tf", "/scene", "/state"} <= set(schemas)
    assert {state["robot"] for _, state in found["/state"]} == {"robot 0", "robot 1"}
    gone = [each.id for _, update in found["/scene"] for each in update.deletions]
    assert gone == ["person 0"]
    walls = [each for _, update in found["/scene"] for each in update.entities if each.id == "walls"]
    assert len(walls) == 1
    assert len(walls[0].lines) == 1


def test_who_is_lost_has_no_pose_and_what_is_not_judged_says_why(tmp_path: Path) -> None:
    time = 0.1 * np.arange(30) - 1.0
    place = np.stack([time, 0.0 * time], axis=1)
    place[10:20] = np.nan
    robot = replay.PlayedRobot(name="robot", position=place, radius=0.3, clearance=np.full(30, 0.5))
    lost = replay.UnjudgedTime(0.0, 1.0, "no pose")
    shown = replay.Replay(title="x", time=time, robots=[robot], not_judged=[lost])
    _, found = read(plotting.mcap(shown, tmp_path / "x.mcap"))
    assert len(found["/robot"]) == 20
    assert found["/robot"][0][0] == 0.0  # stamps are not negative
    silent = [state for _, state in found["/state"] if state["not_judged"]]
    assert {state["not_judged"] for state in silent} == {"no pose"}
    assert not any(state["clearance_known"] for state in silent)
    assert "robot" in {each.id for _, update in found["/scene"] for each in update.deletions}
    assert all(math.isfinite(pose.pose.position.x) for _, pose in found["/robot"])


def test_the_command_writes_it_and_says_what_is_missing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "scene.toml"
    file.write_text("start = [4.0, 0.0]\ngoal = [0.0, 0.0]\n")
    target = tmp_path / "new" / "run.mcap"
    assert main(["simulate", str(file), "--safe", "--mcap", str(target)]) == 0
    assert f"wrote {target}" in capsys.readouterr().out
    assert "/robot" in read(target)[0]
    assert main(["simulate", str(file), "--mcap", str(tmp_path / "run.bag")]) == 2
    assert "--mcap" in capsys.readouterr().err
    with pytest.raises(InvalidParameterError, match="run must"):
        plotting.mcap("nothing", tmp_path / "x.mcap")
    code = (
        "import sys; sys.modules['foxglove'] = None\n"
        "from hrsafety import navigation as nav, plotting, scenarios\n"
        "from hrsafety.errors import MissingExtraError\n"
        "try: plotting.mcap(nav.simulate(scenarios.configuration('c1'), nav.VirtualForceField()), 'x.mcap')\n"
        "except MissingExtraError as error: print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert done.stdout == "an MCAP file needs foxglove-sdk: pip install foxglove-sdk\n"
    assert not (tmp_path / "x.mcap").exists()


@pytest.mark.parametrize("name", ["c1", "n1", "multiple_obstacles"])
def test_every_kind_of_obstacle_is_written(name: str, tmp_path: Path) -> None:
    run = nav.simulate(scenarios.configuration(name), nav.VirtualForceField())
    _, found = read(plotting.mcap(run, tmp_path / "run.mcap"))
    assert len(found["/robot"]) > 50
