"""Runs of the nine laws: batches against single runs, threads, lanes, seeds, free ways, ablations."""

from __future__ import annotations

import dataclasses
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, scenarios
from hrsafety import navigation as nav

LAWS: dict[str, nav.Law] = {
    "field": nav.VirtualForceField(),
    "masoud": nav.Masoud(),
    "ge_cui": nav.GeCui(),
    "khatib": nav.Khatib(),
    "khatib_printed": nav.Khatib(form="printed"),
    "borenstein_koren": nav.BorensteinKoren(),
    "velocity_obstacle": nav.VelocityObstacle(horizon=10.0),
    "velocity_obstacle_fastest": nav.VelocityObstacle(selection="fastest"),
    "velocity_obstacle_time_and_risk": nav.VelocityObstacle(selection="time_and_risk"),
    "reciprocal": nav.OptimalReciprocalCollisionAvoidance(),
    "random_tree": nav.RapidlyExploringRandomTree(draws=300),
    "field_d_star": nav.FieldDStar(resolution=0.2),
}
PLANNERS = tuple(LAWS)[6:]
C1, C2, C3, C4 = SCENES = [scenarios.configuration(name) for name in ("c1", "c2", "c3", "c4")]
# Noise, rectangles, people and crossing discs.
NOISY = replace(C4, measurement=nav.Measurement(scale=0.02, of="both"), seed=7)
TRAFFIC = scenarios.random_traffic(3, seed=1)
VARIED = [C1, C2, NOISY, TRAFFIC]

each_law = pytest.mark.parametrize("name", LAWS)
each_planner = pytest.mark.parametrize("name", PLANNERS)


def gain_sets(law: nav.Law, count: int) -> np.ndarray:
    """Return the law's own gains and random ones around them."""
    generator = np.random.default_rng(11)
    own = np.array(law.gains)
    spread = np.where(np.isfinite(own), own, 5.0) * generator.uniform(0.7, 1.2, (count - 1, len(own)))
    return np.vstack([own, spread])


def law_of(law: nav.Law, gains: np.ndarray) -> nav.Law:
    return law.replaced(**dict(zip(law.GAIN_NAMES, gains.tolist(), strict=True)))


def assert_same_bits(one: nav.RunTable, other: nav.RunTable) -> None:
    for column in dataclasses.fields(nav.RunTable):
        first, second = getattr(one, column.name), getattr(other, column.name)
        if not isinstance(first, np.ndarray):
            assert first == second, column.name  # the names of the gains, and what was run
        else:
            assert first.dtype == second.dtype, column.name
            assert first.tobytes() == second.tobytes(), column.name


# ---- batches --------------------------------------------------------------------------------


@each_law
def test_batch_rows_have_the_bits_of_single_runs(name: str) -> None:
    law = LAWS[name]
    gains = gain_sets(law, 4)
    table = nav.simulate_batch(VARIED, law, gains)
    assert len(table) == len(gains) * len(VARIED)
    for row in range(len(table)):
        scene, single = VARIED[table.scenario_index[row]], law_of(law, gains[table.gain_index[row]])
        score = nav.evaluate(scene, single)
        run = score.trajectory
        assert run.outcome == table.outcome[row]
        for metric in ("arrival_time", "energy", "path_length"):
            assert np.float64(getattr(run, metric)).tobytes() == getattr(table, metric)[row].tobytes(), (metric, row)
        assert run.min_distance.tobytes() == table.min_distance[row, : len(scene.obstacles)].tobytes()
        assert run.min_clearance.min() == table.min_clearance[row]
        for part in ("total", "arrival_time", "avoidance", "energy_saving"):
            column = getattr(table, f"performance_{part}")
            assert np.float64(getattr(score, part)).tobytes() == column[row].tobytes(), (part, row)


@each_law
def test_evaluated_run_is_the_simulated_one(name: str) -> None:
    one, other = nav.evaluate(NOISY, LAWS[name]).trajectory, nav.simulate(NOISY, LAWS[name])
    for column in ("time", "position", "velocity", "force", "distance"):
        assert getattr(one, column).tobytes() == getattr(other, column).tobytes()


@each_law
def test_neither_lanes_nor_threads_change_a_bit(name: str) -> None:
    gains = gain_sets(LAWS[name], 9)
    first = nav.simulate_batch(VARIED, LAWS[name], gains, lanes=1, threads=1)
    for lanes in (1, 4, 8, 16):
        for threads in (1, 2):
            assert_same_bits(first, nav.simulate_batch(VARIED, LAWS[name], gains, lanes=lanes, threads=threads))


@each_law
@pytest.mark.parametrize("options", [{"integrator": "rk4"}, {"step": 0.005}, {"stop_on_contact": True}])
def test_options_of_the_batch_are_those_of_the_run(name: str, options: dict[str, Any]) -> None:
    table = nav.simulate_batch([C3, TRAFFIC], LAWS[name], lanes=4, **options)
    for row, scene in enumerate((C3, TRAFFIC)):
        run = nav.simulate(scene, LAWS[name], **options)
        assert run.outcome == table.outcome[row]
        assert np.float64(run.path_length).tobytes() == table.path_length[row].tobytes()
        assert run.time[-1] == table.end_time[row]


@each_law
def test_columns_have_the_names_of_the_gains(name: str) -> None:
    law = LAWS[name]
    gains = gain_sets(law, 2)
    table = nav.simulate_batch([C1], law, gains)
    columns = table.columns()
    assert table.gain_names == law.GAIN_NAMES
    # Its columns stand between those that say which run it is and those that say what came of it.
    names = list(columns)
    shown = names[names.index("seed") + 1 : names.index("outcome")]
    assert len(shown) == len(law.GAIN_NAMES)
    for index, (gain, column) in enumerate(zip(law.GAIN_NAMES, shown, strict=True)):
        assert column.startswith(gain)
        assert columns[column].tolist() == gains[:, index].tolist()
    assert {len(values) for values in columns.values()} == {2}


@each_law
def test_gains_by_name_are_those_of_the_law_otherwise(name: str) -> None:
    law = LAWS[name]
    gain, value = law.GAIN_NAMES[0], 1.1 * law.gains[0]
    by_name = nav.simulate_batch([C1], law, {gain: [law.gains[0], value]})
    in_order = nav.simulate_batch([C1], law, np.array([law.gains, (value, *law.gains[1:])]))
    assert_same_bits(by_name, in_order)


# ---- commands -------------------------------------------------------------------------------


@each_law
def test_command_at_the_start_is_the_first_force_of_the_run(name: str) -> None:
    for scene in (*SCENES, TRAFFIC):
        force = nav.laws.command(LAWS[name], scene, position=scene.start, velocity=(0.0, 0.0))
        assert force.shape == (2,)
        assert force.tobytes() == nav.simulate(scene, LAWS[name]).force[0].tobytes()


@each_law
def test_command_knows_the_time(name: str) -> None:
    discs = [disc for disc in TRAFFIC.obstacles if isinstance(disc, nav.MovingDisc)]
    assert len(discs) == 3
    later = replace(TRAFFIC, obstacles=tuple(replace(disc, center=_moved(disc, 3.0)) for disc in discs))
    state: dict[str, Any] = {"position": (1.0, 0.2), "velocity": (0.3, 0.0)}
    force = nav.laws.command(LAWS[name], TRAFFIC, time=3.0, **state)
    assert force == pytest.approx(nav.laws.command(LAWS[name], later, **state), abs=1e-9)


def _moved(disc: nav.MovingDisc, time: float) -> tuple[float, float]:
    return (disc.center[0] + time * disc.velocity[0], disc.center[1] + time * disc.velocity[1])


@each_law
def test_command_does_not_depend_on_calls_before(name: str) -> None:
    state: dict[str, Any] = {"position": (3.2, 0.62), "velocity": (-0.4, 0.1)}
    first = nav.laws.command(LAWS[name], C1, **state)
    nav.laws.command(LAWS[name], C4, position=(3.0, 0.0), velocity=(0.0, 0.1))
    assert nav.laws.command(LAWS[name], C1, **state).tobytes() == first.tobytes()


def test_command_of_the_field_is_the_total_of_its_terms() -> None:
    state: dict[str, Any] = {"position": (2.95, 0.71), "velocity": (-0.5, 0.1)}
    for scene in SCENES:
        terms = nav.force_terms(nav.VirtualForceField(), scene, **state)
        assert nav.laws.command(nav.VirtualForceField(), scene, **state) == pytest.approx(terms.total, rel=1e-12)


@each_planner
def test_planner_never_wants_more_than_full_speed(name: str) -> None:
    for scene in (*SCENES, TRAFFIC):
        run = nav.simulate(scene, LAWS[name])
        wanted = run.velocity + run.force * scene.control_period / scene.robot.mass
        # The first row of each control period: there the force is computed.
        sampled = wanted[: -1 : round(scene.control_period / 0.01)]
        assert np.hypot(*sampled.T).max() <= scene.robot.max_speed * (1.0 + 1e-9)


# ---- free ways and seeds --------------------------------------------------------------------


@each_law
def test_robot_without_obstacles_arrives(name: str) -> None:
    for start, goal in (((3.9, 0.6), (0.0, 0.6)), ((-1.0, -2.0), (1.5, 2.0))):
        scene = nav.Scenario(start=start, goal=goal)
        run = nav.simulate(scene, LAWS[name])
        assert run.outcome == "arrived"
        way = np.hypot(goal[0] - start[0], goal[1] - start[1]) - scene.arrival_tolerance
        assert way - 1e-9 <= run.path_length < 1.2 * way + 0.1
        assert run.arrival_time >= way / scene.robot.max_speed
        assert nav.evaluate(scene, LAWS[name]).arrival_time == 1.0


@each_law
def test_only_the_tree_looks_at_the_seed(name: str) -> None:
    own = nav.simulate(TRAFFIC, LAWS[name])
    same = nav.simulate(replace(TRAFFIC), LAWS[name])
    other = nav.simulate(replace(TRAFFIC, seed=TRAFFIC.seed + 1), LAWS[name])
    assert own.position.tobytes() == same.position.tobytes()
    assert (own.position.tobytes() == other.position.tobytes()) == (name != "random_tree")


def test_every_seed_gives_the_tree_another_path() -> None:
    runs = [nav.simulate(replace(C4, seed=seed), LAWS["random_tree"]) for seed in (0, 1, 2, 2**64 - 1)]
    assert len({run.position.tobytes() for run in runs}) == 4


@each_planner
def test_gain_that_a_planner_cannot_work_with_is_named(name: str) -> None:
    law = LAWS[name]
    gains = np.tile(np.array(law.gains), (3, 1))
    gains[2, law.GAIN_NAMES.index("margin")] = -0.01
    with pytest.raises(InvalidParameterError) as caught:
        nav.simulate_batch(SCENES, law, gains)
    assert caught.value.argument == "gains[2].margin"


# ---- ablations ------------------------------------------------------------------------------

STATES: list[dict[str, Any]] = [
    {"position": (2.95, 0.71), "velocity": (-0.5, 0.1)},
    {"position": (2.9, 0.5), "velocity": (-0.3, -0.2)},
]
FULL = nav.VirtualForceField(stabilizing="full", detour_gain=40.0)


@pytest.mark.parametrize("state", STATES)
def test_field_without_a_term_has_the_others_unchanged(state: dict[str, Any]) -> None:
    whole = nav.force_terms(FULL, C1, **state)
    assert whole.region.tolist() == ["active"]
    for term in (whole.attractive, whole.repulsive, whole.detour, whole.stabilizing):
        assert np.abs(term).max() > 1e-3
    gains = {"attractive": "attractive_gain", "repulsive": "repulsive_gain", "detour": "detour_gain"}
    for gone, gain in gains.items():
        less: dict[str, Any] = {gain: 0.0}
        terms = nav.force_terms(replace(FULL, stabilizing="off", **less), C1, **state)
        assert not getattr(terms, gone).any()
        for kept in set(gains) - {gone}:
            assert getattr(terms, kept).tobytes() == getattr(whole, kept).tobytes()
        assert not terms.stabilizing.any()
        assert terms.total == pytest.approx(
            terms.attractive + terms.repulsive.sum(axis=0) + terms.detour.sum(axis=0), rel=1e-12
        )


@pytest.mark.parametrize("state", STATES)
def test_field_without_stabilizing_lacks_just_that(state: dict[str, Any]) -> None:
    whole, without = (nav.force_terms(replace(FULL, stabilizing=mode), C1, **state) for mode in ("full", "off"))
    for kept in ("attractive", "repulsive", "detour"):
        assert getattr(whole, kept).tobytes() == getattr(without, kept).tobytes()
    assert not without.stabilizing.any()
    assert whole.total - without.total == pytest.approx(whole.stabilizing, rel=1e-9)
    assert whole.omega == without.omega


def test_field_without_repulsion_and_detour_drives_into_the_obstacle() -> None:
    assert nav.simulate(C1, FULL).outcome == "arrived"
    assert nav.simulate(C1, replace(FULL, repulsive_gain=0.0, detour_gain=0.0, stabilizing="off")).outcome != "arrived"
