"""Laws in worlds of people with seeds and gains: tables, comparisons, and what they refuse."""

from __future__ import annotations

import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, scenarios
from hrsafety import navigation as nav
from hrsafety.navigation.crowd import study
from hrsafety.navigation.crowd.contacts import contacts_of

RECIPROCAL = nav.OptimalReciprocalCollisionAvoidance()
FIELD = nav.VirtualForceField()
LAWS = {"reciprocal": RECIPROCAL, "field": FIELD}
CIRCLES = {f"case {case}": scenarios.circle_crossing(case) for case in range(3)}


class Constant:
    """A law that looks at nobody."""

    def __init__(self, speed: float) -> None:
        self.name, self.speed = f"{speed:g} m/s", speed

    def velocity(self, situation: nav.laws.Situation) -> np.ndarray:
        way = situation.goal - situation.position
        return self.speed * way / max(float(np.hypot(*way)), 1.0)


def assert_same(one: nav.RunTable, other: nav.RunTable) -> None:
    first, second = one.columns(), other.columns()
    assert list(first) == list(second)
    for name, column in first.items():
        assert column.dtype == second[name].dtype, name
        np.testing.assert_array_equal(column, second[name], err_msg=name)


# ---- the table ------------------------------------------------------------------------------


def test_rows_are_laws_worlds_and_seeds_with_the_bits_of_single_worlds() -> None:
    table = nav.simulate_many(CIRCLES, LAWS, seeds=[3, 2**64 - 1])
    assert table.law.tolist() == np.repeat(list(LAWS), 6).tolist()
    assert table.scenario.tolist() == np.tile(np.repeat(list(CIRCLES), 2), 2).tolist()
    assert table.seed.tolist() == [3, 2**64 - 1] * 6
    for row in (1, 9):
        world = CIRCLES[str(table.scenario[row])]
        robots = [replace(world.robots[0], law=LAWS[str(table.law[row])])]
        alone = nav.simulate_many([replace(world, robots=robots, seed=int(table.seed[row]))])
        for name in nav.metrics.METRICS:
            np.testing.assert_array_equal(table.values[name][row], alone.values[name][0], err_msg=name)


def test_every_robot_has_a_row_and_its_world_counts_once() -> None:
    world = scenarios.antipodal(6, law=RECIPROCAL, robots=2)
    table = nav.simulate_many([world], FIELD)
    assert table.robot.tolist() == [0, 1]
    run = nav.simulate(replace(world, robots=[replace(each, law=FIELD) for each in world.robots]))
    assert table.arrival_time.tolist() == run.robot_arrival_time.tolist()
    whole = nav.crowd.world_metrics(run)
    assert table.throughput.tolist() == [whole.throughput] * 2
    assert table.mean_person_speed.tolist() == [whole.mean_person_speed] * 2


def test_neither_threads_nor_parts_change_a_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    given: dict[str, Any] = {"seeds": 2, "people_alone": True}
    expected = nav.simulate_many(CIRCLES, LAWS, threads=1, **given)
    assert np.isfinite(expected.person_delay).all()
    for threads in (2, 7):
        assert_same(nav.simulate_many(CIRCLES, LAWS, threads=threads, **given), expected)
    monkeypatch.setattr(study, "NUMBERS_AT_ONCE", 1.0)
    assert_same(nav.simulate_many(CIRCLES, LAWS, **given), expected)


def test_gains_are_those_of_the_law() -> None:
    table = nav.simulate_many(CIRCLES["case 1"], {"field": FIELD}, gains={"detour_gain": [0.0, 17.0]})
    assert table.gain_index.tolist() == [0, 1]
    assert table.gains[:, table.gain_names.index("detour_gain")].tolist() == [0.0, 17.0]
    without = nav.simulate_many(CIRCLES["case 1"], {"field": FIELD.replaced(detour_gain=0.0)})
    assert table.arrival_time[0] == without.arrival_time[0] != table.arrival_time[1]
    both = nav.simulate_many(CIRCLES["case 1"], LAWS)
    assert np.isnan(both.gains[0, both.gain_names.index("detour_gain")])
    assert both.gains[1, both.gain_names.index("detour_gain")] == 17.0


def test_columns_start_with_what_a_row_is_and_hold_every_metric() -> None:
    table = nav.simulate_many(CIRCLES, RECIPROCAL)
    columns = table.columns()
    assert list(columns)[:4] == ["law", "scenario", "seed", "robot"]
    assert {
        "outcome",
        "end_time_s",
        "arrival_time_s",
        "min_clearance_m",
        "person_delay_s",
        "throughput_1_per_s",
    } <= set(columns)
    assert {len(column) for column in columns.values()} == {3}
    own = nav.simulate_many(scenarios.configuration("c1"), FIELD).columns()
    shared = {"law", "scenario", "seed", "outcome", "end_time_s", "arrival_time_s", "path_length_m", "min_clearance_m"}
    assert shared | {"contacts_moving", "contacts_standing", "contacts_at_fault"} <= set(own) & set(columns)
    assert pickle.loads(pickle.dumps(table)).columns().keys() == columns.keys()


def test_rows_are_selected_by_law_and_world() -> None:
    table = nav.simulate_many(CIRCLES, LAWS)
    chosen = table.select(law="field", scenario="case 2")
    assert (len(chosen), chosen.law.tolist(), chosen.scenario.tolist()) == (1, ["field"], ["case 2"])
    assert chosen.arrival_time[0] == table.arrival_time[5]
    with pytest.raises(InvalidParameterError, match="did you mean"):
        table.select(law="feild")


def test_progress_counts_the_runs_and_not_the_people_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(study, "NUMBERS_AT_ONCE", 1.0)
    told: list[tuple[int, int]] = []
    nav.simulate_many(CIRCLES, LAWS, people_alone=True, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (6, 6)
    assert told == sorted(told)


# ---- how runs end ---------------------------------------------------------------------------


def test_contacts_tell_who_moved() -> None:
    stands = nav.Person(start=(2.0, 0.0))
    walks = nav.Person(start=(2.0, 3.0), recording=([0.0, 4.0], [(2.0, 3.0), (2.0, -1.0)]))

    def ram(situation: Any) -> Any:
        return 8.0 * (situation.goal - situation.position) - 8.0 * situation.velocity

    def rest(situation: Any) -> Any:
        return -8.0 * situation.velocity

    robot = nav.Robot(start=(0.0, 0.0), goal=(4.0, 0.0))
    run_over = nav.simulate_many(nav.World(people=[stands], robots=[robot], time_limit=8.0), ram)
    assert run_over.outcome.tolist() == ["collided"]
    assert (run_over.contacts_moving[0], run_over.contacts_standing[0], run_over.contacts_at_fault[0]) == (1, 0, 1)
    waiting = replace(robot, start=(2.0, 0.0))
    walked_into = nav.simulate_many(nav.World(people=[walks], robots=[waiting], time_limit=4.0), rest)
    assert walked_into.outcome.tolist() == ["collided"]
    found = walked_into.contacts_moving[0], walked_into.contacts_standing[0], walked_into.contacts_at_fault[0]
    assert found == (0, 1, 0)


def test_contacts_are_found_across_the_end_of_a_world_that_repeats_itself() -> None:
    position = np.column_stack([np.linspace(8.0, 9.9, 20), np.zeros(20)])
    people = np.full((20, 1, 2), (10.3, 0.0)) - (10.0, 0.0)
    episode = nav.metrics.Episode(
        position=position, step=0.1, goal=(20.0, 0.0), robot_radius=0.3, people=people, period=(10.0, 0.0)
    )
    assert nav.metrics.evaluate(episode).robot_on_person == 1
    assert contacts_of(episode, float("nan")) == (1, 0, 0, 1, 0)


def test_a_wall_that_is_touched_is_a_contact_at_fault() -> None:
    robot = nav.Robot(start=(0, 0), goal=(3, 0), law=RECIPROCAL)
    world = nav.World(robots=[robot], walls=[[(1.0, -2.0), (1.0, 2.0)]], time_limit=4.0)
    found = nav.simulate_many(world, lambda situation: 4.0 * (situation.goal - situation.position))
    assert found.outcome.tolist() == ["collided"]
    assert found.wall_contacts[0] == found.contacts_at_fault[0] == 1
    # A wall stands: whoever touches it has moved toward it.
    assert (found.contacts_toward[0], found.contacts_away[0], found.contacts_standing[0]) == (1, 0, 0)
    run = nav.simulate(found.scenarios[0], found.laws[0])
    assert run.wall_contacts == run.contacts_toward == 1
    assert run.outcome == "collided"
    assert run.position[np.searchsorted(run.time, run.map_contact_time), 0] > 0.8


def test_a_world_that_diverges_is_an_outcome() -> None:
    model = nav.crowd.SocialForce2000(stiffness=1e308)
    people = [nav.Person(start=(x, 5.0), route=[(9, 5)], model=model) for x in (0.0, 0.1)]
    robot = nav.Robot(start=(0, 0), goal=(9, 0))
    table = nav.simulate_many(nav.World(people=people, robots=[robot]), RECIPROCAL)
    assert table.outcome.tolist() == ["diverged"]
    assert table.success.count == 0
    fine = nav.World(robots=[replace(robot, law=RECIPROCAL)])
    scored = nav.simulate_many([fine, replace(fine, people=people)])
    assert (scored.law_names, scored.outcome.tolist()) == (("own",), ["arrived", "diverged"])


@pytest.mark.parametrize(("goal", "outcome"), [(1.8, "collided"), (9.0, "diverged")])
def test_a_contact_counts_although_the_world_diverges_later(goal: float, outcome: str) -> None:
    model = nav.crowd.SocialForce2000(stiffness=1e308)
    ways = ((-20.0, 20.0), (-8.0, -20.0))  # they meet after some seconds
    far = [nav.Person(start=(x, 20.0), route=[(end, 20.0)], model=model) for x, end in ways]
    stands = nav.Person(start=(1.0, 0.2), awareness=0.0)
    robot = nav.Robot(start=(0.0, 0.0), goal=(goal, 0.0))
    world = nav.World(people=[*far, stands], robots=[robot], time_limit=30.0)
    law = Constant(1.0)
    table = nav.simulate_many(world, law)
    run = nav.simulate(replace(world, robots=[replace(robot, law=law)]))
    assert run.diverged is not None
    assert f"warning: the world diverged at {run.diverged.time:g} s, person" in repr(run)
    assert table.outcome.tolist() == [outcome]
    assert table.touched.tolist() == [True]
    assert (table.success.count, table.contact.count, int(table.contacts_at_fault[0])) == (0, 1, 1)
    compared = nav.compare(world, {"blind": law, "rests": Constant(0.0)})
    standing = compared.standing("blind")
    assert (standing.success.count, standing.contact.count, standing.at_fault.count) == (0, 1, 1)
    assert standing.diverged.count == (outcome == "diverged")
    assert compared.contacts_compared("blind", "rests").only_first == 1


def test_doubts_of_the_shield_travel_with_the_table() -> None:
    law = nav.laws.SafeNavigation(RECIPROCAL, shield=nav.laws.Shield(person_speed=0.5))
    table = nav.simulate_many(CIRCLES, {"plain": RECIPROCAL, "shielded": law})
    # One for each number that is too small, whatever people and scenes there are.
    assert [(each.code, each.subject.rpartition(".")[2]) for each in table.warnings] == [
        ("shield_assumes_less", "person_speed"),
        ("shield_assumes_less", "margin"),
    ]
    assert "scenarios['case 0']" in table.warnings[0].message
    assert repr(table).count("2 more of this kind in these scenarios") == 2
    compared = nav.compare(list(CIRCLES.values()), law)
    assert compared.warnings[0].message.startswith("scenarios[0]")
    assert nav.simulate_many(CIRCLES, RECIPROCAL).warnings == ()


# ---- comparisons ----------------------------------------------------------------------------


def test_laws_are_compared_in_the_same_episodes() -> None:
    result = nav.compare(CIRCLES, LAWS, seeds=2, people_alone=True)
    assert isinstance(result, nav.Comparison)
    assert result.outcome.shape == (2, 6)
    assert result.seed.tolist() == [0, 1] * 3
    times = result.metric("arrival_time")
    both = (result.outcome == "arrived").all(axis=0)
    found = result.difference("field", "reciprocal", "arrival_time")
    assert found.runs == both.sum() > 0
    assert found.value == pytest.approx(np.mean(times[1, both] - times[0, both]))
    assert result.difference("field", "reciprocal", "min_clearance").runs == 6
    standing = result.standing("reciprocal")
    assert standing.success.count == (result.outcome[0] == "arrived").sum()
    assert standing.person_delay.value == pytest.approx(np.nanmean(result.metric("person_delay")[0]))
    assert result.contacts_compared("field", "reciprocal").p_value == 1.0
    assert [each.law for each in result.standings()] == list(LAWS)
    with pytest.raises(InvalidParameterError, match="metric must be"):
        result.difference("field", "reciprocal", "performance_total")


# ---- what is refused ------------------------------------------------------------------------

MISTAKES: dict[str, tuple[dict[str, Any], str]] = {
    "a scenario among worlds": ({"scenarios": [CIRCLES["case 0"], 3]}, r"scenarios\[1\] must be a World"),
    "nobody to drive": ({"scenarios": {"a": nav.World()}}, r"scenarios\['a'\].robots must hold a robot"),
    "step": ({"step": 0.02}, "step must be left out for worlds"),
    "paths": ({"paths": True}, "paths must be left out for worlds"),
    "built": ({"built": nav.robots.AsBuilt()}, "built must be left out for worlds"),
    "stop_on_contact": ({"stop_on_contact": True}, "stop_on_contact must be left out for worlds"),
    "no flag": ({"people_alone": 1}, "people_alone must be"),
    "seeds": ({"seeds": [-1]}, r"seeds\[0\] must"),
    "threads": ({"threads": 0}, "threads must"),
    "too many rows": ({"scenarios": list(CIRCLES.values()) * 4, "seeds": 10**6}, "laws must hold at most"),
    "too long": (
        {"scenarios": [CIRCLES["case 0"], scenarios.antipodal(20, law=FIELD, robots=1, time_limit=4e5)]},
        r"scenarios\[1\].time_limit must",
    ),
}


@pytest.mark.parametrize(("change", "words"), MISTAKES.values(), ids=MISTAKES)
def test_mistakes_are_named(change: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidParameterError, match=words):
        nav.simulate_many(**{"scenarios": list(CIRCLES.values()), "laws": RECIPROCAL, **change})


def test_scenarios_have_no_people_that_react() -> None:
    with pytest.raises(InvalidParameterError, match="people_alone must be False"):
        nav.simulate_many(scenarios.configuration("c1"), FIELD, people_alone=True)  # type: ignore[call-overload]  # wrong on purpose
    with pytest.raises(InvalidParameterError, match=r"scenarios\[1\] must be a Scenario"):
        nav.simulate_many([scenarios.configuration("c1"), CIRCLES["case 0"]], FIELD)  # type: ignore[list-item]  # wrong on purpose


def test_robots_that_touch_each_other_are_in_the_standing() -> None:
    robots = [
        nav.Robot(start=(0.0, 0.0), goal=(6.0, 0.0)),
        nav.Robot(start=(6.0, 0.1), goal=(0.0, 0.1)),
    ]
    found = nav.compare(nav.World(robots=robots), {"blind": Constant(1.0)})
    standing = found.standing("blind")
    assert (standing.success.count, standing.contact.count, standing.robot_contact.count) == (2, 0, 2)
    told = [warning for warning in found.runs.warnings if warning.code == "robot_contacts"]
    assert len(told) == 1
    assert "robots touch each other in 1 of 1 runs" in told[0].message


def test_options_of_scenarios_may_be_arrays_and_are_refused_by_name() -> None:
    world = CIRCLES["case 0"]
    assert len(nav.simulate_many(world, RECIPROCAL, weights=np.full(3, 1 / 3))) == 1
    with pytest.raises(InvalidParameterError, match="weights must be left out for worlds"):
        nav.simulate_many(world, RECIPROCAL, weights=np.array([1.0, 0.0, 0.0]))
