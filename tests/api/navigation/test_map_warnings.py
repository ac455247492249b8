"""A law that does not know the walls of another one goes through them, and whoever compares the two is told so."""

from __future__ import annotations

from hrsafety import navigation as nav

WALL = nav.StaticMap.from_polylines([[(2.0, -3.0), (2.0, 3.0)]])
SCENE = nav.Scenario(start=(0.0, 0.0), goal=(4.0, 0.0), time_limit=40.0)
FIELD = nav.VirtualForceField()
GUIDED = nav.SafeNavigation(FIELD, map=WALL, guide=nav.Guide())


def unknown(laws: list[object], built: nav.robots.AsBuilt | None = None) -> list[str]:
    found = nav.simulate_many(SCENE, laws, built=built)
    return [each.subject for each in found.warnings if each.code == "unknown_map"]


def test_a_law_that_goes_through_the_walls_of_another_one_is_named() -> None:
    table = nav.simulate_many(SCENE, [GUIDED, FIELD])
    assert list(table.outcome) == ["arrived", "arrived"]  # the second one through the wall
    assert [each.subject for each in table.warnings] == ["laws[1].map"]
    assert "unknown_map" in {each.code for each in nav.compare([SCENE], [GUIDED, FIELD]).warnings}
    assert unknown([FIELD, GUIDED]) == ["laws[0].map"]


def test_laws_of_one_map_are_compared_without_a_warning() -> None:
    within = nav.SafeNavigation(nav.SafeNavigation(FIELD, map=WALL), guide=nav.Guide())
    assert unknown([GUIDED, within]) == []
    assert unknown([FIELD, nav.OptimalReciprocalCollisionAvoidance()]) == []


def test_a_lidar_in_the_map_makes_it_known_to_every_law() -> None:
    built = nav.robots.AsBuilt(sensors=[nav.Lidar(map=WALL)])
    assert unknown([GUIDED, FIELD], built) == []
