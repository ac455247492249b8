"""Many runs in one call: order of the rows, bits of the single runs, seeds, gains, paths, what is refused."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from api.spoiled import names
from hrsafety import InvalidParameterError, ShapeError, scenarios
from hrsafety import navigation as nav

NOISE = nav.Measurement(of="both")
PLACES = {name: replace(scenarios.configuration(name), measurement=NOISE, seed=9) for name in ("c1", "c4")}
FIELDS = {"full": nav.VirtualForceField(), "off": nav.VirtualForceField(stabilizing="off")}
GAINS = {"attractive_gain": [2.0, 3.0, 4.0], "gain_ratio": 0.3}
SEEDS = (4, 2**64 - 1)
C1 = PLACES["c1"]
LAW = nav.VirtualForceField()
TWO_WHEELS = replace(scenarios.configuration("n1"), robot=nav.DifferentialDriveRobot())


def assert_same_run(runs: nav.RunTable, row: int, single: nav.Performance) -> None:
    run, obstacles = single.trajectory, len(single.trajectory.min_distance)
    assert runs.outcome[row] == run.outcome
    assert runs.end_time[row] == run.time[-1]
    np.testing.assert_array_equal(runs.arrival_time[row], run.arrival_time)
    assert (runs.energy[row], runs.path_length[row]) == (run.energy, run.path_length)
    assert runs.min_distance[row, :obstacles].tobytes() == run.min_distance.tobytes()
    assert runs.min_clearance[row] == run.min_clearance.min()
    assert runs.contacts_moving[row] + runs.contacts_standing[row] == np.isfinite(run.contact_time).sum()
    parts = (runs.performance_arrival_time, runs.performance_avoidance, runs.performance_energy_saving)
    assert runs.performance_total[row] == single.total
    assert [part[row] for part in parts] == [single.arrival_time, single.avoidance, single.energy_saving]


# ---- order and bits ---------------------------------------------------------------------------


@pytest.mark.parametrize("paths", [False, True])
def test_rows_are_laws_scenarios_seeds_gains_and_have_the_bits_of_single_runs(paths: bool) -> None:
    runs = nav.simulate_many(PLACES, FIELDS, gains=GAINS, seeds=SEEDS, paths=paths)
    expected = list(itertools.product(FIELDS, PLACES, SEEDS, range(3)))
    assert len(runs) == len(expected)
    for row, (law, place, seed, index) in enumerate(expected):
        assert (runs.law[row], runs.scenario[row], runs.seed[row], runs.gain_index[row]) == (law, place, seed, index)
        attraction = GAINS["attractive_gain"][index]  # type: ignore[index]  # a list
        assert runs.gains[row].tolist() == [attraction, LAW.repulsive_gain, LAW.detour_gain, 0.3]
        driver = FIELDS[law].replaced(attractive_gain=attraction, gain_ratio=0.3)
        assert_same_run(runs, row, nav.evaluate(replace(PLACES[place], seed=seed), driver))


def test_one_law_has_the_bits_of_the_batch() -> None:
    sets = np.array([[2.0, 20.0, 17.0, 0.25], [3.0, 21.0, 17.0, 0.3], [4.0, 20.0, 10.0, 0.25]])
    batch = nav.simulate_batch(list(PLACES.values()), LAW, sets, descent=True)
    runs = nav.simulate_many(list(PLACES.values()), LAW, gains=sets, descent=True)
    assert runs.scenario_index.tolist() == [0, 0, 0, 1, 1, 1]
    for name in ("seed", "gains", "outcome", "min_distance", "performance_total", "descent_share", "gain_index"):
        one, other = getattr(batch, name), getattr(runs, name)
        assert one.reshape(3, 2, -1).swapaxes(0, 1).tobytes() == other.reshape(2, 3, -1).tobytes(), name


@pytest.mark.parametrize("built", [None, nav.robots.AsBuilt(wheels=nav.robots.DIFFERENTIAL_WHEELS)])
def test_two_wheel_robots_have_the_bits_of_single_runs(built: nav.robots.AsBuilt | None) -> None:
    laws: dict[str, nav.Law] = {"field": LAW, "Masoud": nav.Masoud()}
    noisy = replace(TWO_WHEELS, measurement=NOISE)
    for threads in (1, 3):
        runs = nav.simulate_many(noisy, laws, seeds=2, built=built, threads=threads)
        assert runs.law.tolist() == ["field", "field", "Masoud", "Masoud"]
        for row, (law, seed) in enumerate(itertools.product(laws, range(2))):
            single = nav.evaluate(replace(noisy, seed=seed), laws[law], built=built)
            assert_same_run(runs, row, single)
            assert runs.contact_time is not None
            assert runs.contact_time[row].tobytes() == single.trajectory.contact_time.tobytes()
        assert np.isnan(runs.gains[2:, 3]).all()  # Masoud has no gain of this name


def test_point_masses_and_two_wheel_robots_share_a_table() -> None:
    runs = nav.simulate_many({"point": C1, "wheels": TWO_WHEELS}, LAW)
    assert_same_run(runs, 0, nav.evaluate(C1, LAW))
    assert_same_run(runs, 1, nav.evaluate(TWO_WHEELS, LAW))


def test_paths_are_those_of_single_runs_and_end_with_them() -> None:
    places = [C1, scenarios.configuration("multiple_obstacles")]
    runs = nav.simulate_many(places, [LAW, nav.VirtualForceField(attractive_gain=1.0)], paths=True)
    assert runs.law_names == ("VirtualForceField", "VirtualForceField 2")
    assert runs.time is not None
    assert runs.position is not None
    assert runs.distance is not None
    for row in range(4):
        single = nav.simulate(runs.scenarios[runs.scenario_index[row]], runs.laws[runs.law_index[row]])
        inside = np.isfinite(runs.time[row])
        assert runs.time[row][inside][-1] == single.time[-1]
        kept = np.searchsorted(single.time, runs.time[row][inside])
        assert runs.position[row][inside].tobytes() == single.position[kept].tobytes()
        obstacles = single.distance.shape[1]
        np.testing.assert_array_equal(runs.distance[row][inside, :obstacles], single.distance[kept])
        assert np.isnan(runs.distance[row][:, obstacles:]).all()
    with pytest.raises(InvalidParameterError, match=r"scenarios must be one for bands, got 2; select"):
        runs.goal_band()
    alone = runs.select(law="VirtualForceField", scenario="1")
    assert alone.goal_band().low[0] > 0.0
    assert alone.select(law="VirtualForceField").time is not None
    with pytest.raises(InvalidParameterError, match="paths must be kept for bands"):
        nav.simulate_many(C1, LAW).path_band()


def test_seeds_are_those_of_the_scenarios_unless_given() -> None:
    assert nav.simulate_many(PLACES, LAW).seed.tolist() == [9, 9]
    assert nav.simulate_many(PLACES, LAW, seeds=3).seed.tolist() == [0, 1, 2] * 2
    assert nav.simulate_many(C1, LAW, seeds=iter([5, 3])).seed.tolist() == [5, 3]


def test_table_starts_with_what_each_row_is() -> None:
    runs = nav.simulate_many(PLACES, FIELDS, gains=GAINS, seeds=2)
    columns = list(runs.columns())
    assert columns[:4] == ["law", "scenario", "seed", "attractive_gain_N_per_m"]
    assert columns.index("outcome") == 7
    assert {"arrival_time_s", "min_clearance_m", "contacts_moving", "performance_total"} <= set(columns)
    shown = repr(runs).splitlines()
    head = f"RunTable: 24 rows, {len(columns)} columns; here 5 rows and 8 columns; outcomes: "
    assert shown[0] == head + "arrived 24"
    assert len(shown) == 7 + len(runs.warnings)
    assert shown[1].split() == columns[:8]
    assert shown[2].split()[:3] == ["full", "c1", "0"]
    assert runs._repr_html_().count("<tr>") == 6


def test_a_printed_table_of_single_gain_sets_says_how_the_runs_ended() -> None:
    telling = ["outcome", "arrival_time_s", "min_clearance_m", "contacts_toward", "contacts_away"]
    runs = nav.simulate_many(PLACES, LAW)
    assert repr(runs).splitlines()[1].split() == ["law", "scenario", "seed", *telling]
    assert repr(runs.select(scenario="c1")).splitlines()[1].split() == ["law", "scenario", "seed", *telling]


def test_names_are_shown_as_text_in_pages() -> None:
    page = nav.simulate_many({"<b>": C1}, LAW)._repr_html_()
    assert "&lt;b&gt;" in page
    assert "<b>" not in page


def test_progress_counts_to_the_end_over_all_laws() -> None:
    heard: list[tuple[int, int]] = []
    nav.simulate_many(PLACES, FIELDS, gains=GAINS, progress=lambda *call: heard.append(call))
    assert heard[-1] == (12, 12)
    assert heard == sorted(heard)


# ---- what is refused --------------------------------------------------------------------------

BAD_CALLS: list[tuple[dict[str, Any], str]] = [
    ({"scenarios": []}, "scenarios"),
    ({"scenarios": "c1"}, "scenarios"),
    ({"scenarios": [C1, None]}, "scenarios[1]"),
    ({"scenarios": {"a": LAW}}, "scenarios['a']"),
    ({"scenarios": {1: C1}}, "names of scenarios"),
    ({"laws": C1}, "laws"),
    ({"laws": [LAW, C1]}, "laws[1]"),
    ({"gains": {"unknown": [1.0]}}, "gains"),
    ({"gains": [[-1.0, 20.0, 17.0, 0.25]]}, "gains[0].attractive_gain"),
    ({"gains": [[3.0, 20.0, 17.0, 0.25]], "laws": [LAW, nav.Masoud()]}, "gains"),
    ({"seeds": 0}, "seeds"),
    ({"seeds": [-1]}, "seeds[0]"),
    ({"seeds": "12"}, "seeds"),
    ({"paths": 1}, "paths"),
    ({"paths": True, "descent": True}, "descent"),
    ({"paths": True, "integrator": "rk4"}, "integrator"),
    ({"built": nav.robots.AsBuilt(), "hold": False}, "hold"),
    ({"built": "wheels"}, "built"),
    ({"step": "fast"}, "step"),
    ({"threads": 0}, "threads"),
    ({"weights": (1, 1, 1)}, "weights"),
    ({"progress": 1}, "progress"),
]


@pytest.mark.parametrize(("change", "argument"), BAD_CALLS)
def test_bad_call_is_refused_by_name(change: dict[str, Any], argument: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.simulate_many(**({"scenarios": C1, "laws": LAW} | change))
    assert names(caught.value) == argument


def test_gains_without_a_column_each_are_refused() -> None:
    with pytest.raises(ShapeError):
        nav.simulate_many(C1, LAW, gains=[[1.0, 2.0]])


def test_laws_with_other_gains_say_which() -> None:
    with pytest.raises(InvalidParameterError, match=r'gain_ratio of "VirtualForceField" and .* of "Masoud"'):
        nav.simulate_many(C1, [LAW, nav.Masoud()], gains={"attractive_gain": [1.0]})


@pytest.mark.parametrize("options", [{}, {"paths": True}])
def test_errors_name_the_scenario_and_not_the_episode(options: dict[str, Any]) -> None:
    odd = replace(C1, control_period=0.05)
    with pytest.raises(InvalidParameterError) as caught:
        nav.simulate_many([C1, odd], LAW, seeds=3, step=0.02, **options)
    assert caught.value.argument == "scenarios[1].step"


def test_tables_beyond_memory_are_refused_before_they_are_made() -> None:
    sets = np.tile([3.0, 20.0, 17.0, 0.25], (1000, 1))
    with pytest.raises(InvalidParameterError, match="20000000 runs; split the call") as caught:
        nav.simulate_many([C1, C1], LAW, gains=sets, seeds=10_000)
    assert "at most 10000000 runs" in caught.value.requirement


def test_paths_beyond_memory_are_refused_before_they_are_made() -> None:
    """A run of c1 may last 1,002 instants, each with time, place and one distance: 4,008 numbers."""
    with pytest.raises(InvalidParameterError, match="lower time_limit of the scenarios") as caught:
        nav.simulate_many(C1, LAW, seeds=51_000, paths=True)
    assert caught.value.argument == "paths"
    assert "51000 runs of up to 1002 instants, 2.04e+08 numbers" in str(caught.value)
    # One scenario that may last long makes the table of all of them wide.
    with pytest.raises(InvalidParameterError, match=r"302 runs of up to 1\.667e\+05 instants"):
        nav.simulate_many([C1, replace(C1, time_limit=1e4)], LAW, seeds=151, paths=True)
    assert nav.simulate_many(C1, LAW, seeds=2, paths=True).position is not None


# ---- errors and names -------------------------------------------------------------------------


@pytest.mark.parametrize("paths", [False, True])
def test_an_error_of_a_run_names_law_scenario_seed_and_row(paths: bool) -> None:
    far = nav.Scenario(start=(0.0, 0.0), goal=(1e300, 0.0))
    wanted = r"non-finite at 0 s \(law 'b', scenario 'far', seed 7, row 9 of the table\)"
    laws: dict[str, nav.Law] = {"a": nav.Khatib(attractive_gain=0.0), "b": LAW}
    with pytest.raises(nav.SimulationError, match=wanted) as caught:
        nav.simulate_many({"c1": C1, "far": far}, laws, seeds=[7, 8, 9], paths=paths, threads=1)
    assert caught.value.run == 9
    sets = {"attractive_gain": [0.0, 3.0]}
    with pytest.raises(nav.SimulationError, match=r"scenario 'far', seed 0, row 3 of the table") as caught:
        nav.simulate_many({"c1": C1, "far": far}, LAW, gains=sets, paths=paths, threads=1)
    assert caught.value.run == 3
    with pytest.raises(nav.SimulationError, match=r"\(run 0\)") as caught:
        nav.simulate(far, LAW)
    assert caught.value.run == 0


def test_laws_in_python_never_take_the_name_of_another_law() -> None:
    """The second Masoud would be called as the law of the caller is: one of the two was lost."""
    mine = nav.PythonLaw(function=lambda situation: situation.goal - situation.position, name="Masoud 2")
    for laws in ([mine, nav.Masoud(), nav.Masoud()], [nav.Masoud(), nav.Masoud(), mine], [nav.Masoud(), mine] * 2):
        runs = nav.simulate_many(C1, laws)
        assert len(runs) == len(runs.law_names) == len(set(runs.law_names)) == len(laws)
    assert nav.simulate_many(C1, [mine, nav.Masoud(), nav.Masoud()]).law_names == ("Masoud 2", "Masoud", "Masoud 3")
