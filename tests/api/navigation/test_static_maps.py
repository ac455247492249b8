"""Static maps from every source, plans through them, lidars among them, and what is refused."""

from __future__ import annotations

import copy
import itertools
import json
import math
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import ndimage

from hrsafety import navigation as nav
from hrsafety.errors import HrsafetyError, InvalidParameterError

YAML = """
image: room.pgm   # beside this file
resolution: 0.5
origin: [1.0, -2.0, {yaw}]
negate: {negate}
occupied_thresh: 0.65
free_thresh: 0.196
"""
# Gray values of 3 x 2 pixels, the first row on top: occupied, unknown, free; free, occupied, free.
PIXELS = [[0, 150, 254], [254, 10, 255]]


def served(folder: Path, *, yaw: float = 0.0, negate: int = 0, image: bytes | None = None) -> Path:
    """Write a map of the map server."""
    gray = np.array(PIXELS, dtype=np.uint8)
    if negate:
        gray = 255 - gray
    body = b"P5\n# made by hand\n3 2\n255\n" + gray.tobytes() if image is None else image
    (folder / "room.pgm").write_bytes(body)
    path = folder / "room.yaml"
    path.write_text(YAML.format(yaw=yaw, negate=negate), encoding="utf-8")
    return path


def shapes() -> nav.StaticMap:
    """Return the shapes of the check values."""
    lines = nav.StaticMap.from_polylines([[(0, 0), (6, 0), (6, 4)], [(1, 3), (3, 3)]])
    triangle = nav.StaticMap.from_polygons([[(3.5, 1), (4.5, 1), (4, 2)]])
    return lines + triangle + nav.StaticMap(discs=[(1.5, 1.5, 0.3), (5, 3, 0.2)])


def test_distances_rays_and_boundary_points_are_the_check_values() -> None:
    here = (3.315, 0.398)
    assert shapes().clearance(here) == pytest.approx(0.398, abs=1e-12)
    full = shapes().boundary_points(here, reach=2.0, kappa=1.0)
    np.testing.assert_allclose(full, [(3.315, 0), (3.5, 1), (1.756434, 1.344303)], atol=1e-6)
    np.testing.assert_allclose(shapes().boundary_points(here, reach=2.0), [(3.315, 0), (3.5, 1)], atol=1e-6)
    assert shapes().ray(here, -0.758425) == pytest.approx(0.578674, abs=5e-7)
    np.testing.assert_allclose(shapes().nearest(here), (3.315, 0.0))
    assert shapes().segment_clearance((2.0, 0.5), (5.0, 0.5)) == pytest.approx(0.5, abs=1e-12)
    assert shapes().segment_clearance((2.0, 1.5), (5.0, 1.5)) == 0.0


def test_many_points_are_asked_at_once() -> None:
    points = np.random.default_rng(1).uniform(-1.0, 7.0, (500, 2))
    found = shapes().clearance(points)
    assert found.shape == (500,)
    assert all(shapes().clearance(point) == value for point, value in zip(points, found, strict=True))
    away = np.hypot(*(shapes().nearest(points) - points).T)
    np.testing.assert_allclose(found[found > 0.0], away[found > 0.0], rtol=0.0, atol=1e-12)


def test_maps_are_values() -> None:
    whole = shapes() + nav.StaticMap.from_grid([[1, 0], [0, 1]], resolution=0.5, yaw=0.3)
    assert pickle.loads(pickle.dumps(whole)) == whole  # made here
    assert hash(whole) == hash(pickle.loads(pickle.dumps(whole)))  # made here
    assert whole != shapes()
    assert repr(shapes()) == "StaticMap(2 walls, 1 polygon, 2 discs, x 0 to 6 m, y 0 to 4 m)"
    assert repr(nav.StaticMap()) == "StaticMap(nothing)"
    assert nav.StaticMap().clearance((0.0, 0.0)) == math.inf
    assert nav.StaticMap().bounds is None
    assert whole.segments.shape[1] == 5


def test_rectangles_and_discs_become_a_map() -> None:
    table = nav.Rectangle(center=(2.0, 1.0), length=1.0, width=0.5, heading=math.pi / 2)
    there = nav.StaticMap.from_obstacles([table, nav.Disc(center=(-1.0, 0.0), radius=0.25)])
    np.testing.assert_allclose(there.clearance([(1.0, 1.0), (2.0, 3.0), (0.0, 0.0)]), [0.75, 1.5, 0.75], atol=1e-12)
    with pytest.raises(InvalidParameterError, match=r"obstacles\[0\] must be a Disc or Rectangle"):
        nav.StaticMap.from_obstacles([nav.Human(start=(0.0, 0.0), velocity=(1.0, 0.0))])  # type: ignore[list-item]  # wrong on purpose


@given(st.integers(0, 2**32 - 1), st.floats(0.0, 1.0), st.sampled_from([0.05, 0.1, 1.0]))
def test_the_distance_transform_is_that_of_scipy(seed: int, share: float, resolution: float) -> None:
    random = np.random.default_rng(seed)
    occupied = random.random(random.integers(1, 40, 2)) < share
    found = nav.maps.distance_transform(occupied, resolution=resolution)
    if not occupied.any():
        assert (found == np.inf).all()
        return
    # Their whole squares leave no room for rounding beyond the root and the product.
    expected = ndimage.distance_transform_edt(~occupied)
    np.testing.assert_allclose(found, expected * resolution, rtol=1e-15, atol=0.0)


@given(st.integers(0, 2**32 - 1))
def test_cells_are_the_map_of_their_squares(seed: int) -> None:
    random = np.random.default_rng(seed)
    occupied = random.random((5, 7)) < 0.4
    grid = nav.StaticMap.from_grid(occupied, resolution=0.25, origin=(-1.0, 0.5))
    corners = np.argwhere(occupied) * 0.25 + (0.5, -1.0)
    square = np.array([(0.0, 0.0), (0.25, 0.0), (0.25, 0.25), (0.0, 0.25)])
    squares = nav.StaticMap.from_polygons([corner[::-1] + square for corner in corners])
    points = random.uniform(-2.0, 3.0, (50, 2))
    np.testing.assert_allclose(grid.clearance(points), squares.clearance(points), rtol=0.0, atol=1e-12)


# ---- map server ----------------------------------------------------------------------------------


@pytest.mark.parametrize("negate", [0, 1])
def test_a_served_map_stands_where_its_file_says(tmp_path: Path, negate: int) -> None:
    there = nav.StaticMap.from_map_server(served(tmp_path, negate=negate))
    (cells,) = there.grids
    # Row 0 is the lowest, the last one of the image; unknown counts as occupied.
    assert cells.occupied.tolist() == [[False, True, False], [True, True, False]]
    assert there.clearance((1.25, -1.25)) == 0.0
    assert there.clearance((1.25, -1.75)) == 0.25
    assert nav.StaticMap.from_map_server(served(tmp_path), unknown="free").grids[0].occupied.sum() == 2
    assert there.bounds == ((1.0, -2.0), (2.0, -1.0))


def test_the_yaw_of_a_served_map_turns_it_around_its_corner(tmp_path: Path) -> None:
    there = nav.StaticMap.from_map_server(served(tmp_path, yaw=math.pi / 2))
    # The occupied cell (column 0, row 1) lies to the left of the corner now.
    assert there.clearance((0.25, -1.75)) == 0.0
    assert there.clearance((0.75, -1.75)) == pytest.approx(0.25, abs=1e-12)


def test_words_comments_and_another_maxval_are_read(tmp_path: Path) -> None:
    words = b"P2 # words\n3 2 # sizes\n100\n0 59 100 # top\n100\n4 100\n"
    there = nav.StaticMap.from_map_server(served(tmp_path, image=words))
    assert there.grids[0].occupied.tolist() == [[False, True, False], [True, True, False]]
    listed = YAML.format(yaw=0.0, negate=0).replace("origin: [1.0, -2.0, 0.0]", "origin:\n- 1.0\n- -2.0\n- 0.0")
    path = tmp_path / "listed.yaml"
    path.write_text("---\nmode: trinary\n" + listed.replace("room.pgm", '"room.pgm"'), encoding="utf-8")
    assert nav.StaticMap.from_map_server(path) == there


HEAD = b"P5\n3 2\n255\n"


@pytest.mark.parametrize(
    ("image", "message"),
    [
        (
            b"P6\n3 2\n255\n" + b"0" * 18,
            "image must be a PGM picture, P2 or P5, or a PNG picture, got room.pgm, a PPM picture",
        ),
        (b"", "be a PGM picture"),
        (b"P5 3 2", "have the head of a PGM picture"),
        (b"\xff\xd8\xff\xe0", "got room.pgm, a JPEG picture; convert it without loss"),
        (b"\x89PNG\r\n\x1a\n broken", "be a whole PNG picture, got room.pgm"),
        (HEAD + b"12345", "the 3 x 2 = 6 gray values that its head says, got 5 in room.pgm"),
        (b"P2\n3 2\n255\n1 2 3 4 5", "6 gray values that its head says, got 5 in room.pgm"),
        (b"P2\n3 2\n255\n1 2 3 4 5 x", "whole gray values"),
        (b"P2\n3 2\n9\n1 2 3 4 5 10", "gray values up to its maxval, 9, got 10"),
        (b"P5\n3 2\n65535\n" + b"0" * 11, "6 gray values that its head says, got 5 in room.pgm"),
        (b"P5\n3 2\n65536\n" + b"0" * 12, "maxval from 1 to 65535, got 65536"),
        (b"P5\n0 2\n255\n", "have pixels, got 0 x 2"),
        (b"P5\n99999999 99999999\n255\n", "at most 268435456 pixels"),
    ],
)
def test_pictures_that_are_no_map_are_refused(tmp_path: Path, image: bytes, message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        nav.StaticMap.from_map_server(served(tmp_path, image=image))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("image: room.pgm", "", "image must stand in room.yaml, got nothing"),
        ("room.pgm", "../room.pgm", "image must lie in the folder of the YAML file"),
        ("room.pgm", "/etc/hostname", "image must lie in the folder"),
        ("room.pgm", "rom.pgm", 'did you mean "room.pgm"'),
        ("resolution: 0.5", "resolution: 0", "resolution must be finite and positive"),
        ("resolution: 0.5", "resolution: half", "resolution must be a number"),
        ("free_thresh: 0.196", "free_thresh: 0.7", "0 <= free_thresh < occupied_thresh <= 1, got free_thresh 0.7"),
        ("[1.0, -2.0, 0.0]", "[1.0, -2.0]", "origin must be three numbers"),
        ("[1.0, -2.0, 0.0]", "[1.0, -2.0, nan]", "origin must be finite"),
        ("negate: 0", "negate: 2", "negate must be 0 or 1"),
        ("negate: 0", "mode: row", 'mode must be "trinary", "scale" or "raw", got .row.; did you mean "raw"'),
        ("negate: 0", "resolution: 0.1", "resolution must stand once in room.yaml, got another one in line"),
        ("negate: 0", "- what", "be lines 'key: value' of a map"),
    ],
)
def test_files_that_are_no_map_are_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = served(tmp_path)
    path.write_text(path.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    with pytest.raises(InvalidParameterError, match=message):
        nav.StaticMap.from_map_server(path)


# ---- BARN ----------------------------------------------------------------------------------------


def test_worlds_of_barn_are_read_and_named(shared: Path) -> None:
    file = shared / "data" / "barn" / "barn_even.json"
    data = json.loads(file.read_text(encoding="utf-8"))
    (world,) = (each for each in data["worlds"] if each["id"] == 12)
    there = nav.StaticMap.from_barn(file, 12)
    assert there == nav.StaticMap.from_barn(data, 12)
    assert len(there.discs) == world["n"]
    assert there.discs[0][:2] == pytest.approx(np.array(world["cyl_mm"][0]) / 1000.0)
    path = np.array(world["path_cells"]) * 0.15 + (-4.575, 5.075)
    assert there.clearance(path).min() == pytest.approx(world["path_min_clearance_m"], abs=6e-4)
    with pytest.raises(InvalidParameterError, match="world must be the number of a world in the file, got 13"):
        nav.StaticMap.from_barn(data, 13)
    with pytest.raises(InvalidParameterError, match="cylinder_radius_m and worlds"):
        nav.StaticMap.from_barn({"worlds": []}, 0)


# ---- guide ---------------------------------------------------------------------------------------

TRAP = nav.StaticMap.from_polylines([[(1, 1.5), (3, 1.5), (3, -1.5), (1, -1.5)]])


def trap_plan() -> nav.maps.Plan:
    """Return the plan of the check values."""
    guide = nav.maps.Guide(margin=0.05, box=((-2, -4), (6, 4)))
    return guide.plan(TRAP, radius=0.2, start=(0, 0), goal=(5, 0))


def test_costs_in_the_trap_are_the_check_values() -> None:
    cost = trap_plan().cost([(0, 0), (2.6, 0.5), (3.5, 1.9)])
    np.testing.assert_allclose(cost, (7.2675, 8.1187, 2.4501), atol=5e-5)
    assert math.isnan(trap_plan().cost((50.0, 0.0)))


def test_paths_and_local_goals_keep_away_from_the_map() -> None:
    plan = trap_plan()
    path = plan.path((2.6, 0.5))
    assert tuple(path[0]) == (2.6, 0.5)
    assert tuple(path[-1]) == (5.0, 0.0)
    assert all(TRAP.segment_clearance(*ends) >= 0.25 - 1e-9 for ends in itertools.pairwise(path))
    goal = plan.local_goal((2.6, 0.5))
    assert goal is not None
    assert not goal.is_goal
    assert goal.cost_to_go < plan.cost((2.6, 0.5))
    assert TRAP.segment_clearance((2.6, 0.5), goal.point) >= 0.25 - 1e-9
    assert plan.local_goal((50.0, 0.0)) is None
    assert plan.path((50.0, 0.0)).shape == (0, 2)


@pytest.mark.parametrize("again", [lambda plan: pickle.loads(pickle.dumps(plan)), copy.copy, copy.deepcopy])
def test_a_plan_is_made_again_where_it_is_pickled_or_copied(again: Callable[[nav.maps.Plan], nav.maps.Plan]) -> None:
    plan = trap_plan()
    other, points = again(plan), np.array([(0, 0), (2.6, 0.5), (3.5, 1.9), (50.0, 0.0)])
    assert other == plan
    np.testing.assert_array_equal(other.cost(points), plan.cost(points))
    np.testing.assert_array_equal(other.path((2.6, 0.5)), plan.path((2.6, 0.5)))
    assert len(pickle.dumps(plan)) < 10_000


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"spacing": 0.0}, "spacing must be finite and positive"),
        ({"margin": -0.1}, "margin must be finite and not negative"),
        ({"look_ahead": math.nan}, "look_ahead must be finite and positive"),
        ({"takeover_window": 0.0}, "takeover_window must be finite and positive"),
        ({"takeover_progress": -1.0}, "takeover_progress must be finite and positive"),
        ({"box": ((1, 0), (0, 1))}, "upper corner of box must lie above"),
        ({"box": ((1, 0), (math.inf, 1))}, "upper corner of box must be finite"),
        ({"box": (1, 0, 2)}, "box must be a pair of corners"),
    ],
)
def test_guides_out_of_range_are_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        nav.maps.Guide(**options).plan(TRAP, radius=0.2, start=(0, 0), goal=(5, 0))


@pytest.mark.parametrize(
    ("ends", "message"),
    [
        (((0, 0), (3.1, 0)), "goal must be at least the radius of the robot, 0.2 m, away from the map"),
        (((2.9, 0), (5, 0)), "start must be at least the radius"),
        (((0, 0), (math.nan, 0)), "goal must be finite"),
    ],
)
def test_ends_without_a_plan_are_refused(ends: tuple[Any, Any], message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        nav.Guide().plan(TRAP, radius=0.2, start=ends[0], goal=ends[1])


def test_no_way_and_too_many_nodes_are_refused_before_memory_is_taken() -> None:
    closed = TRAP + nav.StaticMap.from_polylines([[(1, -1.5), (1, 1.5)]])
    with pytest.raises(InvalidParameterError, match="goal must be reachable from the start"):
        nav.Guide().plan(closed, radius=0.2, start=(2, 0), goal=(5, 0))
    with pytest.raises(InvalidParameterError, match="spacing must give at most 16777216 nodes"):
        nav.Guide(spacing=1e-7).plan(TRAP, radius=0.2, start=(0, 0), goal=(5, 0))


# ---- lidar ---------------------------------------------------------------------------------------

ROOM = nav.StaticMap.from_polylines([[(-2, -1), (2, -1), (2, 1), (-2, 1), (-2, -1)]])


def test_a_scan_has_the_ranges_of_rays() -> None:
    lidar = nav.Lidar(map=ROOM, beams=181, field_of_view=math.pi, range_max=1.5)
    scan = lidar.scan((0.3, 0.2), 0.4)
    np.testing.assert_allclose(scan, np.minimum(ROOM.ray((0.3, 0.2), lidar.bearings + 0.4), 1.5), atol=1e-12)
    points = lidar.points((0.3, 0.2), 0.4, scan)
    assert len(points) == (scan < 1.5).sum()
    np.testing.assert_allclose(ROOM.clearance(points), 0.0, atol=1e-12)
    person = lidar.scan((0.3, 0.2), 0.0, people=[(1.0, 0.2, 0.25)])
    assert person[90] == pytest.approx(0.45, abs=1e-12)
    noisy = nav.Lidar(map=ROOM, range_noise=0.01)
    assert (noisy.scan((0, 0), seed=1) != noisy.scan((0, 0), seed=2)).any()
    assert (noisy.scan((0, 0), seed=1) == noisy.scan((0, 0), seed=1)).all()


def corridor() -> nav.StaticMap:
    """Return a bent corridor."""
    return nav.StaticMap.from_polylines(
        [[(-1, -0.7), (2, -0.7), (5, 1.3), (9, 1.3)], [(-1, 0.7), (1.5, 0.7), (4.5, 2.7), (9, 2.7)]]
    )


@pytest.mark.parametrize(
    ("law", "options"),
    [
        (nav.VirtualForceField(), {}),
        (nav.Khatib(), {}),
        (nav.OptimalReciprocalCollisionAvoidance(horizon=1.0), {"reach": 1.5, "kappa": 1.0}),
    ],
    ids=lambda each: type(each).__name__,
)
def test_a_law_goes_through_a_corridor_by_lidar_alone(law: nav.Law, options: dict[str, Any]) -> None:
    scenario = nav.Scenario(robot=nav.HolonomicRobot(), start=(0.0, 0.0), goal=(8.0, 2.0), obstacles=[])
    walls = corridor()
    built = nav.robots.AsBuilt(sensors=[nav.Lidar(map=walls, beams=720, **options)])
    run = nav.simulate(scenario, law, built=built)
    assert run.outcome == "arrived"
    assert walls.clearance(run.position).min() > 0.2
    assert run.sensing.obstacles == ("lidar",)
    # Without the lidar the straight way leads through a wall.
    blind = nav.simulate(scenario, law)
    assert walls.clearance(blind.position).min() < 0.2


def test_people_are_seen_only_if_the_lidar_sees_them() -> None:
    person = nav.Human(start=(2.0, 0.05), velocity=(0.0, 0.0), radius=0.3)
    scenario = nav.Scenario(robot=nav.HolonomicRobot(), start=(0.0, 0.0), goal=(4.0, 0.0), obstacles=[person])
    seen, unseen = (
        nav.simulate(scenario, nav.VirtualForceField(), built=nav.robots.AsBuilt(sensors=[lidar]))
        for lidar in (nav.Lidar(beams=720), nav.Lidar(sees_obstacles=False))
    )
    assert seen.min_clearance[0] > 0.0
    assert unseen.min_clearance[0] <= 0.0


def test_a_range_below_the_active_region_is_a_warning() -> None:
    scenario = nav.Scenario(robot=nav.HolonomicRobot(), start=(0.0, 0.0), goal=(4.0, 0.0), obstacles=[])
    short = nav.robots.AsBuilt(sensors=[nav.Lidar(range_max=0.4)])
    (warning,) = nav.simulate(scenario, nav.VirtualForceField(), built=short).warnings
    assert warning.code == "region_beyond_range"
    assert "range_max" in str(warning)


def test_what_is_nearer_than_the_least_range_is_doubtful_beside_a_smaller_robot() -> None:
    scenario = nav.Scenario(robot=nav.HolonomicRobot(radius=0.2), start=(0.0, 0.0), goal=(4.0, 0.0), obstacles=[])
    for least, codes in ((0.2, []), (0.3, ["blind_nearby"])):
        built = nav.robots.AsBuilt(sensors=[nav.Lidar(range_min=least)])
        run = nav.simulate(scenario, nav.VirtualForceField(), built=built)
        assert [each.code for each in run.warnings] == codes


def test_a_world_that_a_file_numbers_twice_is_refused() -> None:
    world = {"id": 6, "cyl_mm": [[0, 0]]}
    with pytest.raises(InvalidParameterError, match="name every world once"):
        nav.StaticMap.from_barn({"cylinder_radius_m": 0.1, "worlds": [world, world]}, 6)
    with pytest.raises(InvalidParameterError, match="world"):
        nav.StaticMap.from_barn({"cylinder_radius_m": 0.1, "worlds": [world | {"id": [1]}]}, 6)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"beams": 0}, "beams must be an integer from 1 to 100000"),
        ({"beams": 10**9}, "beams must be an integer from 1 to 100000"),
        ({"field_of_view": 7.0}, "field_of_view must be above 0 and at most a whole turn"),
        ({"range_min": 2.0, "range_max": 1.0}, "range_max must be above range_min"),
        ({"range_noise": math.nan}, "range_noise must be finite and not negative"),
        ({"kappa": 1.5}, "kappa must be above 0 and at most 1"),
        ({"influence": 0.0}, "influence must be finite and positive"),
        ({"reach": -1.0}, "reach must be finite and positive"),
        ({"map": [(0, 0)]}, "map must be a StaticMap"),
    ],
)
def test_lidars_out_of_range_are_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        nav.Lidar(**options)


# ---- bad maps ------------------------------------------------------------------------------------

BAD = {
    "crossing polygon": (
        lambda: nav.StaticMap.from_polygons([[(0, 0), (1, 1), (1, 0), (0, 1)]]),
        r"polygons\[0\].points",
    ),
    "two corners": (lambda: nav.StaticMap.from_polygons([[(0, 0), (1, 1)]]), "three points at least, got 2"),
    "no length": (
        lambda: nav.StaticMap.from_polylines([[(1, 1), (1, 1)]]),
        r"polylines\[0\].points must have two different",
    ),
    "not a number": (lambda: nav.StaticMap.from_polylines([[(1, 1), (1, math.nan)]]), "point 1 must be finite"),
    "negative radius": (lambda: nav.StaticMap.from_polylines([[(1, 1), (2, 1)]], radius=-1), "radius must be"),
    "disc without size": (lambda: nav.StaticMap(discs=[(1, 1, 0)]), r"discs\[0\].radius must be finite and positive"),
    "flat grid": (lambda: nav.StaticMap.from_grid([1, 0], resolution=0.1), "occupied must have shape"),
    "half occupied": (lambda: nav.StaticMap.from_grid([[0, 2]], resolution=0.1), "got 2 in row 0, column 1"),
    "shares": (lambda: nav.StaticMap.from_grid([[0.0, 0.5]], resolution=0.1), "got an array of float64"),
    "no resolution": (
        lambda: nav.StaticMap.from_grid([[0, 1]], resolution=0.0),
        "resolution must be finite and positive",
    ),
    "kappa": (lambda: shapes().boundary_points((0, 0), reach=1.0, kappa=0.0), "kappa must be above 0 and at most 1"),
    "point": (lambda: shapes().clearance((0, math.inf)), "point must be finite"),
    "bearing": (lambda: shapes().ray((0, 0), math.nan), "bearing must be finite"),
}


@pytest.mark.parametrize("name", BAD)
def test_maps_out_of_range_are_refused(name: str) -> None:
    call, message = BAD[name]
    with pytest.raises(HrsafetyError, match=message):
        call()


def test_a_huge_grid_is_refused_before_its_memory_is_taken() -> None:
    # A view of one cell: the array itself takes no memory.
    huge = np.broadcast_to(np.zeros((1, 1), dtype=np.bool_), (2**15, 2**14))
    with pytest.raises(InvalidParameterError, match="at most 268435456 cells, got 536870912"):
        nav.StaticMap.from_grid(huge, resolution=0.1)
