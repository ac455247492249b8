"""Rectangles on arcs and corners with hidden people against checked cases."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav

TOLERANCE = 1e-9


@pytest.fixture(scope="module")
def cases(shared: Path) -> dict[str, Any]:
    data: dict[str, Any] = json.loads((shared / "spec" / "unknown_places_cases.json").read_text(encoding="utf-8"))
    return data


@pytest.fixture(scope="module")
def robot(cases: dict[str, Any]) -> nav.robots.Footprint:
    sides = cases["footprint"]
    return nav.robots.Footprint.rectangle(2.0 * sides["half_length"], 2.0 * sides["half_width"])


def test_swept_distances_of_points(cases: dict[str, Any], robot: nav.robots.Footprint) -> None:
    for case in cases["footprint"]["sweep_point"]:
        found = robot.swept_distance([case["point"]], distance=case["s"], angle=case["phi"])
        assert found[0] == pytest.approx(case["distance"], abs=TOLERANCE)


def test_swept_distances_of_segments(cases: dict[str, Any], robot: nav.robots.Footprint) -> None:
    for case in cases["footprint"]["sweep_segment"]:
        found = robot.swept_distance([case["segment"]], distance=case["s"], angle=case["phi"])
        assert found[0] == pytest.approx(case["distance"], abs=TOLERANCE)


def test_rooms_ahead(cases: dict[str, Any], robot: nav.robots.Footprint) -> None:
    for case in cases["footprint"]["advancing"]:
        twist = {"velocity": case["v"], "turn_rate": case["w"], "depth": case["R"]}
        found = robot.room_ahead_distance([case["point"]], **twist)
        assert found[0] == pytest.approx(case["distance"], abs=TOLERANCE)


def test_speeds_past_corners(cases: dict[str, Any]) -> None:
    corner = cases["corner"]
    common = {
        "robot_radius": corner["rho"],
        "person_radius": corner["r"],
        "person_core": corner["core"],
        "margin": corner["margin"],
        "wall_thickness": corner["thickness"],
        "person_speed": corner["vh"],
        "latency": corner["L"],
        "control_period": corner["T"],
        "max_speed": corner["v_searched_up_to"],
    }
    for case in corner["states"]:
        given = common | {"deceleration": case["a"]}
        for edge in ("near", "far"):
            found = nav.laws.blind_corner_speed(case["w"], case["d"], edge=edge, **given)
            assert found == pytest.approx(case[f"v_{edge}"], abs=TOLERANCE)
        passing = min(case["v_pass"], corner["v_searched_up_to"])
        assert nav.laws.blind_corner_speed(case["w"], **given) == pytest.approx(passing, abs=TOLERANCE)


@pytest.mark.parametrize("seed", range(4))
def test_outlines_on_arcs_are_those_of_shapely(seed: int) -> None:
    from shapely import LineString, Point, Polygon, affinity

    generator = np.random.default_rng(seed)
    angles = np.sort(generator.uniform(0.0, 2.0 * math.pi, 6))
    hull = (
        Polygon(np.column_stack([0.4 * np.cos(angles), 0.3 * np.sin(angles)]))
        .convex_hull.union(Point(0.0, 0.0).buffer(0.05))
        .convex_hull.simplify(0.004)
    )
    outline = nav.robots.Footprint(tuple(hull.exterior.coords)[:-1])
    distance, angle = generator.uniform(-1.0, 1.0), generator.uniform(-3.0, 3.0)
    places = generator.uniform(-1.2, 1.2, (30, 4))
    found = outline.swept_distance(places, distance=distance, angle=angle)
    still = outline.distance(places[:, :2])
    poses = []
    for share in np.linspace(0.0, 1.0, 801):
        turned, radius = share * angle, distance / angle
        moved = affinity.rotate(hull, turned, origin=(0.0, 0.0), use_radians=True)
        poses.append(affinity.translate(moved, radius * math.sin(turned), radius * (1.0 - math.cos(turned))))
    for place, least, outside in zip(places, found, still, strict=True):
        wall = LineString([place[:2], place[2:]])
        sampled = min(pose.distance(wall) for pose in poses)
        assert least <= sampled + 1e-9
        assert sampled <= least + 0.005
        assert max(outside, 0.0) == pytest.approx(hull.distance(Point(place[:2])), abs=1e-9)
