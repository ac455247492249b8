"""Comparisons of laws: the table against the batch, standings, comparisons, costs and what it refuses."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import pytest
from scipy import stats

from api.spoiled import names
from hrsafety import InvalidParameterError, ShapeError, scenarios, sweep
from hrsafety import navigation as nav
from hrsafety.navigation.comparison import Metric
from hrsafety.navigation.metrics import Mean, compare_paired, mean_interval, wilson

LAWS: dict[str, nav.Law] = {
    "field": nav.VirtualForceField(),
    "masoud": nav.Masoud(),
    "borenstein_koren": nav.BorensteinKoren(attractive_gain=4.0, repulsive_gain=0.7),  # too weak
    "reciprocal": nav.OptimalReciprocalCollisionAvoidance(),
    "tree": nav.RapidlyExploringRandomTree(draws=200),
}
CROWDS = {f"crowd {seed}": scenarios.random_traffic(4, seed=seed) for seed in range(12)}
SCENES = {"c1": scenarios.configuration("c1"), "c4": scenarios.configuration("c4"), **CROWDS}
C1 = SCENES["c1"]
SEEDS = (3, 2**64 - 1)
COLUMNS = {
    "outcome": "outcome",
    "arrival_time": "arrival_time",
    "energy": "energy",
    "path_length": "path_length",
    "min_clearance": "min_clearance",
    "min_distance": "min_distance",
    "moving_contacts": "contacts_moving",
    "performance_total": "performance_total",
}


@pytest.fixture(scope="module")
def result() -> nav.Comparison:
    return nav.compare(SCENES, LAWS, seeds=SEEDS)


def assert_same(one: nav.Comparison, other: nav.Comparison) -> None:
    for field in fields(nav.RunTable):
        first, second = getattr(one.runs, field.name), getattr(other.runs, field.name)
        if isinstance(first, np.ndarray):
            assert first.dtype == second.dtype, field.name
            assert first.tobytes() == second.tobytes(), field.name
        else:
            assert first == second


# ---- the table ------------------------------------------------------------------------------


def test_rows_are_laws_and_columns_are_scenarios_with_seeds(result: nav.Comparison) -> None:
    assert result.laws == tuple(LAWS)
    assert result.scenario_names == tuple(SCENES)
    assert result.scenario.tolist() == np.repeat(np.arange(len(SCENES)), 2).tolist()
    assert result.seed.tolist() == list(SEEDS) * len(SCENES)
    for name in COLUMNS:
        assert getattr(result, name).shape[:2] == (len(LAWS), 2 * len(SCENES))


@pytest.mark.parametrize("law", LAWS)
def test_every_column_has_the_bits_of_the_batch(result: nav.Comparison, law: str) -> None:
    episodes = [replace(scene, seed=seed) for scene in SCENES.values() for seed in SEEDS]
    table = nav.simulate_batch(episodes, LAWS[law])
    for name, column in COLUMNS.items():
        assert getattr(result, name)[result.laws.index(law)].tobytes() == getattr(table, column).tobytes(), name


def test_episode_is_that_of_its_scenario_and_seed(result: nav.Comparison) -> None:
    row, column = result.laws.index("tree"), 7
    scene = SCENES[result.scenario_names[result.scenario[column]]]
    run = nav.simulate(replace(scene, seed=int(result.seed[column])), LAWS["tree"])
    assert run.outcome == result.outcome[row, column]
    assert run.path_length == result.path_length[row, column]


def test_without_seeds_each_scenario_keeps_its_own() -> None:
    own = nav.compare(list(CROWDS.values()), {"tree": LAWS["tree"]})
    assert own.scenario_names == tuple(str(index) for index in range(len(CROWDS)))
    assert own.seed.tolist() == [scene.seed for scene in CROWDS.values()]
    again = nav.compare([CROWDS["crowd 5"]], {"tree": LAWS["tree"]}, seeds=[5])
    assert again.path_length[0, 0] == own.path_length[0, 5]


def test_no_number_of_threads_changes_a_bit(result: nav.Comparison) -> None:
    for threads in (1, 2):
        assert_same(result, nav.compare(SCENES, LAWS, seeds=SEEDS, threads=threads))


def test_options_are_those_of_the_batch() -> None:
    options: dict[str, Any] = {"weights": (1.0, 0.0, 0.0), "integrator": "rk4", "step": 0.005}
    table = nav.simulate_batch([C1], LAWS["masoud"], **options)
    found = nav.compare([C1], {"masoud": LAWS["masoud"]}, **options)
    assert found.performance_total[0].tobytes() == table.performance_total.tobytes()
    assert found.arrival_time[0].tobytes() == table.arrival_time.tobytes()
    assert found.arrival_time[0, 0] != nav.compare([C1], {"masoud": LAWS["masoud"]}).arrival_time[0, 0]


def test_progress_counts_the_runs_of_all_laws() -> None:
    calls: list[tuple[int, int]] = []
    nav.compare([C1], LAWS, seeds=3, progress=lambda *call: calls.append(call))
    assert calls[-1] == (3 * len(LAWS), 3 * len(LAWS))
    assert calls == sorted(calls)


def test_scenarios_with_different_numbers_of_obstacles_share_a_table(result: nav.Comparison) -> None:
    count = np.array([len(scene.obstacles) for scene in SCENES.values()])[result.scenario]
    given = np.isfinite(result.min_distance).sum(axis=2)
    assert (given == count).all()


# ---- standings and differences --------------------------------------------------------------


@pytest.mark.parametrize("law", LAWS)
def test_standing_counts_the_episodes(result: nav.Comparison, law: str) -> None:
    row = result.laws.index(law)
    standing = result.standing(law)
    arrived, touched = result.outcome[row] == "arrived", result.outcome[row] == "collided"
    assert standing.law == law
    assert standing.success == wilson(int(arrived.sum()), len(arrived))
    assert standing.contact == wilson(int(touched.sum()), len(arrived))
    assert standing.moving_contact == wilson(int((result.moving_contacts[row] > 0).sum()), len(arrived))
    assert standing.moving_contact.count <= standing.contact.count
    for name in ("arrival_time", "energy", "path_length"):
        assert getattr(standing, name) == mean_interval(getattr(result, name)[row, arrived])
    for name in ("min_clearance", "performance_total"):
        assert getattr(standing, name) == mean_interval(getattr(result, name)[row])
        assert getattr(standing, name).runs == len(arrived)


def test_standings_are_in_the_order_of_the_laws(result: nav.Comparison) -> None:
    assert [standing.law for standing in result.standings()] == list(LAWS)
    assert result.standings() == [result.standing(law) for law in LAWS]


def test_printed_comparison_shows_the_shares_of_each_law(result: nav.Comparison) -> None:
    title, header, *rows = repr(result).splitlines()[: 2 + len(LAWS)]
    assert f"{len(LAWS)} laws in {len(result.seed)} episodes" in title
    assert header.split()[:3] == ["law", "arrived,", "no"]
    for row, standing in zip(rows, result.standings(), strict=True):
        assert row.split()[0] == standing.law
        for share in (standing.success, standing.contact, standing.at_fault):
            assert f"{share.value:.1%} ({share.low:.1%} to {share.high:.1%})" in row
        assert (f"{standing.arrival_time.value:.2f}" == row.split()[-1]) == (standing.success.count > 0)


def test_laws_do_differ_here(result: nav.Comparison) -> None:
    standings = {standing.law: standing for standing in result.standings()}
    assert standings["borenstein_koren"].contact.count > standings["reciprocal"].contact.count
    assert standings["reciprocal"].success.value > 0.5


def test_difference_is_taken_episode_by_episode(result: nav.Comparison) -> None:
    one, other = result.laws.index("field"), result.laws.index("borenstein_koren")
    both = (result.outcome[[one, other]] == "arrived").all(axis=0)
    assert 0 < both.sum() < len(both)
    metrics: tuple[Metric, ...] = ("arrival_time", "energy", "path_length")
    for metric in metrics:
        values = getattr(result, metric)
        expected = mean_interval(values[one, both] - values[other, both])
        assert result.difference("field", "borenstein_koren", metric) == expected
    others: tuple[Metric, ...] = ("min_clearance", "performance_total")
    for metric in others:
        values = getattr(result, metric)
        assert result.difference("field", "borenstein_koren", metric) == mean_interval(values[one] - values[other])
    there, back = result.difference("field", "borenstein_koren"), result.difference("borenstein_koren", "field")
    assert there.value == -back.value
    assert result.difference("field", "field").value == 0.0


def test_contacts_are_compared_in_the_same_episodes(result: nav.Comparison) -> None:
    touched = result.outcome == "collided"
    one, other = result.laws.index("borenstein_koren"), result.laws.index("reciprocal")
    found = result.contacts_compared("borenstein_koren", "reciprocal")
    assert found.only_first == int((touched[one] & ~touched[other]).sum())
    assert found.only_second == int((touched[other] & ~touched[one]).sum())
    assert found == compare_paired(touched[one], touched[other])
    back = result.contacts_compared("reciprocal", "borenstein_koren")
    assert (back.only_first, back.only_second, back.p_value) == (found.only_second, found.only_first, found.p_value)


def test_law_that_never_arrives_has_no_mean_time() -> None:
    blocked = nav.Scenario(
        start=(4.0, 0.0), goal=(0.0, 0.0), obstacles=(nav.Disc(center=(2.0, 0.0), radius=0.3),), time_limit=3.0
    )
    standing = nav.compare([blocked], {"field": LAWS["field"]}).standing("field")
    assert standing.success.count == 0
    assert standing.arrival_time.runs == 0
    assert np.isnan([standing.arrival_time.value, standing.arrival_time.low, standing.energy.high]).all()
    assert standing.min_clearance.runs == 1


def test_scenarios_without_obstacles_have_no_clearance() -> None:
    standing = nav.compare(nav.Scenario(start=(4, 0), goal=(0, 0)), {"field": LAWS["field"]}).standing("field")
    assert standing.success.count == 1
    assert standing.min_clearance.runs == 0


def test_cost_of_a_step_is_a_time() -> None:
    for law in LAWS.values():
        cost = nav.metrics.step_cost(law, SCENES["crowd 1"], repeats=2)
        assert isinstance(cost, float)
        assert 0.0 < cost < np.inf


# ---- what is refused ------------------------------------------------------------------------

FIELD: dict[str, Any] = {"field": nav.VirtualForceField()}
BAD_CALLS: list[tuple[dict[str, Any], str]] = [
    ({"laws": {}}, "laws"),
    ({"laws": None}, "laws"),
    ({"laws": {1: nav.Masoud()}}, "names of laws"),
    ({"laws": [nav.Masoud(), None]}, "laws[1]"),
    ({"laws": {"a": None}}, "laws['a']"),
    ({"laws": {"a": nav.Masoud}}, "laws['a']"),
    ({"scenarios": []}, "scenarios"),
    ({"scenarios": {}}, "scenarios"),
    ({"scenarios": None}, "scenarios"),
    ({"scenarios": "c1"}, "scenarios"),
    ({"scenarios": [C1, None]}, "scenarios[1]"),
    ({"scenarios": {"a": "c1"}}, "scenarios['a']"),
    ({"seeds": []}, "seeds"),
    ({"seeds": 0}, "seeds"),
    ({"built": "wheels"}, "built"),
    ({"seeds": "12"}, "seeds"),
    ({"seeds": [0, -1]}, "seeds[1]"),
    ({"seeds": [1.0]}, "seeds[0]"),
    ({"seeds": [True]}, "seeds[0]"),
    ({"seeds": [2**64]}, "seeds[0]"),
    ({"weights": (1, 1, 1)}, "weights"),
    ({"integrator": "euler"}, "integrator"),
    ({"step": 0.0}, "scenarios[0].step"),
    ({"hold": 1}, "hold"),
    ({"threads": 0}, "threads"),
    ({"progress": 1}, "progress"),
]


@pytest.mark.parametrize(("change", "argument"), BAD_CALLS)
def test_bad_call_is_refused_by_name(change: dict[str, Any], argument: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.compare(**({"laws": FIELD, "scenarios": [C1]} | change))
    assert names(caught.value) == argument


def test_unknown_laws_and_metrics_are_refused(result: nav.Comparison) -> None:
    calls: list[tuple[Any, str]] = [
        (lambda: result.standing("unknown"), "law"),
        (lambda: result.difference("unknown", "field"), "first"),
        (lambda: result.difference("field", "unknown"), "second"),
        (lambda: result.difference("field", "masoud", "outcome"), "metric"),  # type: ignore[arg-type]  # refused
        (lambda: result.contacts_compared("field", None), "second"),  # type: ignore[arg-type]  # refused
    ]
    for call, argument in calls:
        with pytest.raises(InvalidParameterError) as caught:
            call()
        assert names(caught.value) == argument


@pytest.mark.parametrize(
    ("arguments", "argument"),
    [((None, C1), "law"), ((nav.Masoud(), None), "scenario"), ((nav.Masoud(), C1, 0), "repeats")],
)
def test_cost_of_nothing_is_refused(arguments: Any, argument: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.metrics.step_cost(*arguments[:2], repeats=arguments[2] if len(arguments) > 2 else 1)
    assert names(caught.value) == argument


# ---- statistics -----------------------------------------------------------------------------


@pytest.mark.parametrize(("count", "runs"), [(0, 1), (1, 1), (0, 200), (200, 200), (7, 200), (131, 1000), (1, 3)])
def test_share_has_the_interval_of_wilson(count: int, runs: int) -> None:
    share = wilson(count, runs)
    peer = stats.binomtest(count, runs).proportion_ci(0.95, method="wilson")
    assert (share.count, share.runs, share.value) == (count, runs, count / runs)
    assert (share.low, share.high) == pytest.approx((peer.low, peer.high), abs=1e-13)


@pytest.mark.parametrize(("first", "second"), [(0, 0), (1, 0), (6, 0), (5, 5), (3, 12), (40, 61), (900, 1100)])
def test_paired_outcomes_have_the_exact_p_value(first: int, second: int) -> None:
    generator = np.random.default_rng(1)
    order = generator.permutation(first + second + 50)
    one = np.repeat([True, False, True, False], [first, second, 20, 30])[order]
    other = np.repeat([False, True, True, False], [first, second, 20, 30])[order]
    found = compare_paired(one, other)
    assert (found.only_first, found.only_second) == (first, second)
    peer = stats.binomtest(first, first + second).pvalue if first + second else 1.0
    assert found.p_value == pytest.approx(peer, rel=1e-9)


def test_interval_of_a_mean_is_a_bootstrap() -> None:
    values = np.random.default_rng(2).gamma(2.0, 1.0, 60)
    found = mean_interval(values)
    assert found == mean_interval(values.tolist())
    assert found.value == values.mean()
    peer = stats.bootstrap(
        (values,), np.mean, n_resamples=20000, method="percentile", rng=np.random.default_rng(3)
    ).confidence_interval
    # 2000 resamples know the ends of the interval to a few percent of its width.
    assert (found.low, found.high) == pytest.approx((peer.low, peer.high), abs=0.06 * (peer.high - peer.low))
    assert mean_interval(values, seed=1) != found
    # More draws of the same kind: a narrower interval, by the root of their number.
    longer = mean_interval(np.tile(values, 16))
    assert longer.high - longer.low == pytest.approx((found.high - found.low) / 4.0, rel=0.1)


@pytest.mark.parametrize("runs", [2, 3, 5, 10, 40])
def test_interval_of_a_mean_covers_it_as_often_as_it_says(runs: int) -> None:
    generator = np.random.default_rng(4)
    found = [mean_interval(generator.normal(1.0, 2.0, runs), resamples=400) for _ in range(1000)]
    covered = sum(each.low <= 1.0 <= each.high for each in found) / 1000
    # Three deviations of the share are 2 %; the percentile interval alone covers 50, 73, 83 and 90 % of few runs.
    assert 0.92 < covered < 0.97


def test_interval_of_few_runs_is_as_wide_as_students() -> None:
    generator = np.random.default_rng(5)
    for runs in (3, 5, 10, 300):
        samples = generator.normal(0.0, 1.0, (200, runs))
        own = np.mean([found.high - found.low for found in map(mean_interval, samples)])
        half = stats.t.ppf(0.975, runs - 1) * samples.std(axis=1, ddof=1) / np.sqrt(runs)
        assert own == pytest.approx(2.0 * half.mean(), rel=0.06)


def test_means_of_few_runs_say_so() -> None:
    assert [each.code for each in mean_interval([1.0, 2.0, 3.0]).warnings] == ["few_runs"]
    assert "too few" in str(mean_interval([1.0, 2.0, 3.0]))
    assert mean_interval(np.arange(10.0)).warnings == ()
    assert mean_interval([]).warnings == ()


def test_equal_numbers_have_no_interval_to_be_relied_on() -> None:
    """Ten runs without a rare event of 10 % are as likely as not: [0, 0] covers its mean in two of three cases."""
    never = nav.metrics.mean_interval(np.zeros(10))
    assert (never.low, never.high) == (0.0, 0.0)
    assert [each.code for each in never.warnings] == ["few_runs"]
    assert "all 10 numbers are equal" in never.warnings[0].message
    assert nav.metrics.mean_interval([0.0] * 9 + [1.0]).warnings == ()


def test_interval_of_one_value_is_the_value() -> None:
    found = mean_interval([2.5])
    assert found == Mean(1, 2.5, 2.5, 2.5)
    assert str(found) == "2.5 (no interval), 1 run"
    assert "nothing is known" in found.warnings[0].message
    assert mean_interval([]).runs == 0


@pytest.mark.parametrize("ragged", [[[True], [True, False]], "yes", [None, True], [2, 0], [True, np.nan]])
def test_outcomes_that_are_none_are_named(ragged: object) -> None:
    for given, argument in (((ragged, [True, False]), "first"), (([True, False], ragged), "second")):
        with pytest.raises((InvalidParameterError, ShapeError)) as caught:
            compare_paired(*given)  # type: ignore[arg-type]  # refused
        assert names(caught.value) == argument


def test_statistics_refuse_what_is_no_sample() -> None:
    for count, runs, argument in ((0, 0, "runs"), (3, 2, "count"), (-1, 2, "count"), (1.0, 2, "count")):
        with pytest.raises(InvalidParameterError) as caught:
            wilson(count, runs)  # type: ignore[arg-type]  # refused
        assert names(caught.value) == argument
    with pytest.raises(ShapeError):
        compare_paired(np.array([True]), np.array([True, False]))
    with pytest.raises(ShapeError):
        mean_interval(3.0)
    with pytest.raises(InvalidParameterError):
        mean_interval([1.0], resamples=0)


# ---- seeds that change nothing ------------------------------------------------------------------


def same(table: nav.RunTable) -> list[str]:
    return [each.message for each in table.warnings if each.code == "same_runs"]


def test_runs_that_are_the_same_with_every_seed_are_told() -> None:
    noisy = replace(SCENES["c4"], measurement=nav.Measurement())
    field, tree = nav.VirtualForceField(), LAWS["tree"]
    (words,) = same(nav.simulate_many({"c1": C1, "noisy": noisy}, {"field": field}, seeds=5))
    assert words.startswith("of the 5 runs of field in c1 some are the same run")
    assert "more of this kind" not in words
    (words,) = same(nav.compare(SCENES, {"field": field, "masoud": nav.Masoud()}, seeds=2).runs)
    assert f"({2 * len(SCENES) - 1} more of this kind" in words
    # Seeds that are given twice, among others.
    assert len(same(nav.simulate_many(noisy, field, seeds=[1, 2, 1]))) == 1
    assert len(same(nav.simulate_many(noisy, field, seeds=[1] * 4))) == 1
    # One run of each, gains that differ, noise, and a planner that draws.
    for table in (
        nav.simulate_many(SCENES, [field, nav.Masoud()]),
        nav.simulate_many(C1, field, gains=np.array([[4.0, 3.0, 1.0, 2.0], [4.0, 4.0, 1.0, 2.0]])),
        nav.simulate_many(noisy, field, seeds=5),
        nav.simulate_many(C1, tree, seeds=3),
    ):
        assert same(table) == []


def test_copies_of_a_scene_are_told_whatever_their_names_and_seeds() -> None:
    field = nav.VirtualForceField()
    for copies in (
        [C1] * 4,
        [scenarios.random_traffic(3, seed=0) for _ in range(4)],
        [replace(C1, seed=seed) for seed in range(4)],
        {str(index): scenarios.circle_crossing(4) for index in range(4)},
        [replace(C1, measurement=nav.Measurement())] * 4,
    ):
        (words,) = same(nav.compare(copies, [field, nav.Masoud()]).runs)
        assert "copies of one scene" in words
        assert "(6 such pairs of 8 runs)" in words
    mirrored = replace(C1, start=(C1.start[0], -C1.start[1]), goal=(C1.goal[0], -C1.goal[1]))
    noisy = [replace(C1, measurement=nav.Measurement(of="both"), seed=seed) for seed in range(4)]
    for different in ([C1, mirrored], noisy, [scenarios.random_traffic(3, seed=seed) for seed in range(20)]):
        assert same(nav.compare(different, [field]).runs) == []


def test_laws_of_users_that_hold_arrays_are_no_error_and_told_in_doubt() -> None:
    @dataclass
    class Own:
        gains: np.ndarray

        def velocity(self, _: nav.Situation) -> tuple[float, float]:
            return 0.3, 0.0

    robots = [nav.Robot(start=(0.0, 0.0), goal=(1.0, 0.0), law=Own(np.ones(3))) for _ in range(2)]
    worlds = [nav.World(robots=[robot], time_limit=1.0) for robot in robots]
    assert len(same(nav.simulate_many(worlds))) == 1


def test_worlds_that_draw_nothing_are_told() -> None:
    def world(seed: int) -> nav.World:
        return scenarios.circle_crossing(seed, law=nav.VirtualForceField())

    assert same(nav.simulate_many([world(seed) for seed in range(3)])) == []
    assert len(same(nav.simulate_many(world(0), seeds=3))) == 1


def ahead(_situation: object) -> tuple[float, float]:
    """Return a velocity that no person changes."""
    return (-0.5, 0.0)


def test_a_law_that_ignores_people_is_the_cause_of_runs_that_are_the_same() -> None:
    noisy = replace(scenarios.configuration("c3"), measurement=nav.Measurement(scale=0.02))
    causes = {}
    for name, scene, seeds in (
        ("noise", noisy, 5),
        ("quiet", scenarios.configuration("c3"), 5),
        ("twice", noisy, [3, 3]),
    ):
        found = nav.simulate_many({"c3": scene}, {"own": ahead}, seeds=seeds).warnings
        (causes[name],) = [each.message for each in found if each.code == "same_runs"]
    assert "there is noise, but none of it reaches what own does" in causes["noise"]
    assert "makes them differ" not in causes["noise"]
    assert "nothing there draws from the seeds" in causes["quiet"]
    assert "seeds are repeated" in causes["twice"]
    axes = [sweep.Axis(name="seed", low=0, high=4, scale="integer")]
    (doubt,) = [
        each.message
        for each in sweep.run(sweep.Grid(axes), sweep.NavigationStudy(scenarios=noisy, law=ahead)).warnings
        if each.code == "same_runs"
    ]
    assert "a law that ignores people" in doubt


def test_a_mean_of_many_equal_numbers_is_not_said_to_be_of_few_runs() -> None:
    found = nav.compare({"c3": scenarios.configuration("c3")}, dict.fromkeys(("one", "two"), FIELD["field"]), seeds=12)
    assert str(found.difference("one", "two")) == "0 (0 to 0), 12 runs, all of them equal"
