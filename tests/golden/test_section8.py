"""Published configurations: figures of the specification's prototype, and region radii.

Scheme of all figures: force every 0.06 s and held, semi-implicit Euler with 0.01 s, no
stabilizing force, arrival at 0.12 m.
"""

from __future__ import annotations

import dataclasses
import math

import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios

TIME = 0.005  # relative: acceptance of the specification; figures are printed to 0.01 s or 0.001 s
DISTANCE = 0.002  # m: acceptance of the specification; figures are printed to 0.001 m
SCORE = 0.006  # H is printed to two decimals from T, d and L that are rounded as well
SCORE_3 = 0.001  # H printed to three decimals
ENERGY = 0.01  # J: printed to 0.01 J
RADIUS = 0.00005  # m: four printed decimals

NEW = nav.VirtualForceField(stabilizing="off")
NEW_STAR = nav.VirtualForceField(
    attractive_gain=4.3, repulsive_gain=20.3, detour_gain=240.7, gain_ratio=0.68, stabilizing="off"
)
LAWS = {"New": NEW, "New*": NEW_STAR}

RUNS = [
    ("New", "c1", 6.52, [0.488], 0.62),
    ("New", "c2", 8.40, [0.976], 0.47),
    ("New", "c3", 6.01, [0.515, 0.526], 0.70),
    ("New", "c4", 7.97, [1.100, 0.516, 0.566], 0.56),
    ("New*", "c1", 6.02, [0.551], 0.706),
    ("New*", "c2", 6.88, [0.942], 0.541),
    ("New*", "c3", 5.72, [0.549, 0.550], 0.746),
    ("New*", "c4", 7.03, [0.997, 0.571, 0.450], 0.541),
    ("New", "n1", 6.92, [0.439], 0.61),
    ("New", "n2", 8.33, [1.150], 0.49),
    ("New", "n3", 6.20, [0.338, 0.535], 0.70),
    ("New", "n4", 8.35, [1.215, 0.345, 0.492], 0.54),
]
CAPPED_10_N = [
    ("New", "c1", 6.633, [0.536]),
    ("New", "c3", 6.250, [0.549, 0.546]),
    ("New", "c4", 8.109, [1.147, 0.559, 0.606]),
    ("New*", "c1", 6.024, [0.557]),
    ("New*", "c2", 6.883, [0.949]),
    ("New*", "c3", 5.716, [0.551, 0.548]),
]
RADII = {
    "human": (nav.Human(start=(0.0, 0.0), velocity=(1.0, 0.0)), None, 0.7965, 2.0959, 2.4560),
    "disc": (nav.Disc(center=(0.0, 0.0), radius=0.1), None, 0.3665, 0.4330, 0.5813),
    "rectangle": (nav.Rectangle(center=(0.0, 0.0), length=1.4, width=0.6), 0.6, 0.2665, 0.6330, 0.7813),
    "robot": (nav.MovingDisc(center=(0.0, 0.0), radius=0.2, velocity=(0.5, 0.0)), None, 0.5315, 1.0251, 1.2794),
}


def variant(law: nav.VirtualForceField, **changes: object) -> nav.VirtualForceField:
    fields: dict[str, object] = dict(zip(nav.VirtualForceField.GAIN_NAMES, law.gains, strict=True))
    fields["stabilizing"] = "off"
    return nav.VirtualForceField(**(fields | changes))  # type: ignore[arg-type]  # keywords of the class


def assert_figures(run: nav.Trajectory, time: float, distances: list[float]) -> None:
    assert run.outcome == "arrived"
    assert run.arrival_time == pytest.approx(time, rel=TIME)
    assert run.min_distance.tolist() == pytest.approx(distances, abs=DISTANCE)


@pytest.mark.parametrize(("law", "name", "time", "distances", "score"), RUNS)
def test_configuration_gives_its_figures(
    law: str, name: str, time: float, distances: list[float], score: float
) -> None:
    result = nav.evaluate(scenarios.configuration(name), LAWS[law])
    assert_figures(result.trajectory, time, distances)
    tolerance = SCORE_3 if law == "New*" else SCORE
    assert result.total == pytest.approx(score, abs=tolerance)


def test_mean_score_of_the_optimum_is_that_of_the_prototype() -> None:
    scores = [nav.evaluate(scenarios.configuration(name), NEW_STAR).total for name in ("c1", "c2", "c3")]
    assert math.fsum(scores) / 3.0 == pytest.approx(0.664, abs=SCORE_3)


@pytest.mark.parametrize(("law", "time"), [("New", 5.53), ("New*", 5.51)])
def test_free_run_takes_its_time(law: str, time: float) -> None:
    nominal = nav.evaluate(scenarios.configuration("c1"), LAWS[law]).nominal
    assert nominal.arrival_time == pytest.approx(time, rel=TIME)


def test_free_run_along_x_loses_its_energy() -> None:
    nominal = nav.evaluate(scenarios.configuration("c1"), NEW).nominal
    assert nominal.energy == pytest.approx(2.79, abs=ENERGY)


def test_parallel_human_takes_its_time() -> None:
    run = nav.simulate(scenarios.configuration("parallel_human"), NEW)
    assert run.outcome == "arrived"
    assert run.arrival_time == pytest.approx(6.67, rel=TIME)


@pytest.mark.parametrize(("pass_behind", "time", "distance"), [(True, 8.45, 1.276), (False, 9.82, 1.190)])
def test_unpredictable_human_sees_the_pass_behind_rule(pass_behind: bool, time: float, distance: float) -> None:
    run = nav.simulate(scenarios.configuration("unpredictable_human"), variant(NEW, pass_behind=pass_behind))
    assert_figures(run, time, [distance])


@pytest.mark.parametrize(("offset", "time"), [(1e-6, 8.45), (-1e-6, 7.40)])
def test_unpredictable_human_sees_the_side(offset: float, time: float) -> None:
    collinear = scenarios.configuration("unpredictable_human")
    shifted = dataclasses.replace(collinear, start=(4.0, offset), goal=(0.0, offset))
    assert nav.simulate(shifted, NEW).arrival_time == pytest.approx(time, rel=TIME)


@pytest.mark.parametrize(("pass_behind", "time"), [(True, 10.33), (False, 8.32)])
def test_multiple_obstacles_see_the_pass_behind_rule(pass_behind: bool, time: float) -> None:
    run = nav.simulate(scenarios.configuration("multiple_obstacles"), variant(NEW, pass_behind=pass_behind))
    assert run.outcome == "arrived"
    assert run.arrival_time == pytest.approx(time, rel=TIME)


def test_held_trapezoid_moves_the_human_run_as_measured() -> None:
    run = nav.simulate(scenarios.configuration("c2"), NEW, integrator="rk4", hold=True)
    assert_figures(run, 8.431, [0.9715])


def test_force_that_is_not_held_moves_the_disc_run_as_measured() -> None:
    run = nav.simulate(scenarios.configuration("c1"), NEW, hold=False)
    assert_figures(run, 6.471, [0.495])


@pytest.mark.parametrize(("law", "name", "time", "distances"), CAPPED_10_N)
def test_cap_of_10_newton_gives_its_figures(law: str, name: str, time: float, distances: list[float]) -> None:
    capped = variant(LAWS[law], stabilizing="capped", stabilizing_force_cap=10.0)
    assert_figures(nav.simulate(scenarios.configuration(name), capped), time, distances)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("name", ["c1", "c2", "c3", "c4"])
def test_momentum_cap_of_a_tenth_changes_little(law: str, name: str) -> None:
    scenario = scenarios.configuration(name)
    off = nav.simulate(scenario, LAWS[law])
    capped = nav.simulate(scenario, variant(LAWS[law], stabilizing="capped", stabilizing_momentum_cap=0.1))
    assert capped.arrival_time == pytest.approx(off.arrival_time, rel=0.01)
    assert abs(capped.min_distance - off.min_distance).max() < 0.025


@pytest.mark.parametrize("kind", RADII)
def test_region_radii_are_those_of_the_table(kind: str) -> None:
    obstacle, side, critical, holonomic, nonholonomic = RADII[kind]
    for robot, active in ((nav.HolonomicRobot(), holonomic), (nav.DifferentialDriveRobot(), nonholonomic)):
        radii = nav.region_radii(robot, obstacle, faced_side=side)
        assert radii.critical_radius == pytest.approx(critical, abs=RADIUS)
        assert radii.active_radius == pytest.approx(active, abs=RADIUS)
