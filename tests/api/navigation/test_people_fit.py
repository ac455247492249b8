"""Models of people held against recordings and against the fundamental diagram."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, datasets, scenarios
from hrsafety import navigation as nav
from hrsafety.navigation.crowd.predictions import Windows

INTERVAL = 0.4


def recording_of(paths: dict[int, tuple[int, np.ndarray]]) -> datasets.Recording:
    """Return people by id: number of the first instant, and positions."""
    rows = sorted((first + k, who, *place) for who, (first, way) in paths.items() for k, place in enumerate(way))
    table = np.array(rows)
    return datasets.Recording(time_s=INTERVAL * table[:, 0], person=table[:, 1].astype(int), position=table[:, 2:])


def straight(y: float, speed: float = 1.2, instants: int = 40) -> np.ndarray:
    time = INTERVAL * np.arange(instants)
    return np.column_stack([speed * time, np.full(instants, y)])


WALK = recording_of({1: (0, straight(0.0)), 2: (4, straight(4.0, -1.0)), 5: (9, straight(9.0, 1.5, 12))})


def test_windows_are_those_of_people_who_are_there_all_through_them() -> None:
    # 20 instants each, every 4: of 40 instants from 0 on, and of 40 from 4 on; the third is there for 12 only.
    assert nav.crowd.prediction_errors("straight", WALK).windows == 6 + 6
    assert nav.crowd.prediction_errors("straight", WALK, part="first").windows == 1 + 2 + 2
    short = nav.crowd.prediction_errors("straight", WALK, seen=1.6, foretold=1.6, every=0.4)
    assert short.windows == 33 + 33 + 5


def test_no_window_is_partly_in_both_halves() -> None:
    # Windows start at 0, 4, ... 60; those of the first half, up to 28, end at 47.
    given: dict[str, Any] = {"recording": recording_of({1: (0, straight(0.0, instants=80))})}
    windows = Windows.of(**given, seen=3.2, foretold=4.8, every=1.6)
    halves = [list(windows.part(part).scored) for part in ("first", "second")]
    assert halves == [[7 + start for start in range(0, 32, 4)], [7 + start for start in (48, 52, 56, 60)]]
    covered = [{last + k for last in half for k in range(-7, 13)} for half in halves]
    assert covered[0].isdisjoint(covered[1])
    assert nav.crowd.prediction_errors("straight", **given, part="second").windows == 4
    # Windows that follow each other without overlap all belong to a half.
    apart = Windows.of(**given, seen=3.2, foretold=4.8, every=8.0)
    assert sum(len(apart.part(part).scored) for part in ("first", "second")) == len(apart.scored) == 4
    with pytest.raises(InvalidParameterError, match="recording must hold a window that shares no instant"):
        nav.crowd.prediction_errors("straight", WALK, part="second")


@pytest.mark.parametrize("model", ["constant_velocity", "straight"])
def test_people_who_walk_straight_are_foretold_exactly(model: Any) -> None:
    found = nav.crowd.prediction_errors(model, WALK)
    assert max(found.one_step, found.average, found.final) < 1e-9


def test_constant_velocity_does_not_know_the_goal_and_errors_are_distances() -> None:
    turns = straight(0.0, instants=60)
    turns[44:, 1] = turns[44:, 0] - turns[44, 0]
    turns[44:, 0] = turns[44, 0]
    found = nav.crowd.prediction_errors("constant_velocity", recording_of({1: (0, turns)}), part="second")
    # Windows from instants 36 and 40 on, seen up to 43 and 47: the first foretells the turn wrongly.
    ahead = np.arange(1, 13)
    apart = np.hypot(*(np.column_stack([0.48 * ahead, np.zeros(12)]) - (turns[44:56] - turns[43])).T)
    assert found.final == pytest.approx(apart[-1] / 2)
    assert found.average == pytest.approx(apart.mean() / 2)
    knows = nav.crowd.prediction_errors("straight", recording_of({1: (0, turns)}), part="second")
    assert knows.final < found.final


def test_people_react_to_everybody_who_is_present() -> None:
    # The other stands in the way; recorded people walk through each other.
    there = np.tile([[12.0, 0.02]], (40, 1))
    alone, met = recording_of({1: (0, straight(0.0))}), recording_of({1: (0, straight(0.0)), 2: (0, there)})
    model = nav.crowd.CollisionFreeSpeed()
    found = nav.crowd.prediction_errors(model, alone), nav.crowd.prediction_errors(model, met)
    assert found[0].average < 0.01
    assert found[1].average > 0.1


def test_a_fit_comes_near_the_parameter_that_made_the_recording() -> None:
    truth = nav.crowd.Moussaid(relaxation_time=1.6)
    people = [
        nav.Person(start=(0, y), route=[(30, y)], velocity=(0.0, 1.3), desired_speed=1.3, model=truth)
        for y in (0.0, 4.0, 9.0)
    ]
    run = nav.simulate(nav.World(people=people, time_limit=18.0))
    recorded = recording_of({k: (0, run.obstacle_position[::8, k]) for k in range(3)})
    given: dict[str, Any] = {"seen": 0.8, "foretold": 3.2, "evaluations": 60, "seed": 3}
    found = nav.crowd.fit_people(nav.crowd.Moussaid(), recorded, ["relaxation_time"], **given)
    assert found.fitted.average < 0.6 * found.start_fitted.average
    # Desired speeds are those that were seen, so the fit is not exact; the model starts at 0.54 s.
    assert 0.9 < found.values["relaxation_time"] < 2.4
    # Windows start at 0, 4, ... 36; those of the first half end at 25.
    assert (found.fitted.windows, found.held_out.windows) == (3 * 5, 3 * 3)
    assert found.model == replace(found.start, relaxation_time=found.values["relaxation_time"])
    assert found.columns()["windows_of"].tolist() == ["fit", "held out", "fit", "held out"]
    again = nav.crowd.fit_people(nav.crowd.Moussaid(), recorded, ["relaxation_time"], threads=1, **given)
    assert again.values == found.values
    assert again.held_out == found.held_out


def test_a_fit_tells_its_progress_and_keeps_to_bounds() -> None:
    told: list[tuple[int, int]] = []
    met = recording_of({1: (0, straight(0.0, instants=60)), 2: (0, straight(0.3, 1.0, 60))})
    found = nav.crowd.fit_people(
        nav.crowd.SocialForce2000(),
        met,
        ["strength"],
        bounds={"strength": (1900.0, 2100.0)},
        evaluations=25,
        progress=lambda done, total: told.append((done, total)),
    )
    assert 1900.0 * (1 - 1e-12) <= found.values["strength"] <= 2100.0 * (1 + 1e-12)
    assert found.fitted.average <= found.start_fitted.average
    assert told[-1] == (25, 25)


LONG = recording_of({1: (0, straight(0.0, instants=60)), 2: (4, straight(4.0, -1.0, 60))})
GAP = recording_of({1: (0, straight(0.0, instants=20)), 2: (0, straight(1.0, instants=60))})
HOLED = datasets.Recording(
    time_s=np.delete(GAP.time_s, 30), person=np.delete(GAP.person, 30), position=np.delete(GAP.position, 30, axis=0)
)
MISTAKES: dict[str, tuple[dict[str, Any], str]] = {
    "no parameter": ({"names": ["strenth"]}, r"names\[0\] must .*did you mean"),
    "twice": ({"names": ["strength", "strength"]}, "names must name parameters, each once"),
    "none": ({"names": []}, "names must name parameters"),
    "bounds": ({"bounds": {"strength": (3000.0, 4000.0)}}, r"bounds\['strength'\] must be positive and around"),
    "bounds of another": ({"bounds": {"range": (0.1, 1.0)}}, "bounds must"),
    "few evaluations": ({"evaluations": 10}, "evaluations must"),
    "a gap": ({"recording": HOLED}, "recording must have everybody at every interval"),
    "no multiple": ({"every": 0.5}, "every must be a multiple"),
    "too short": ({"recording": recording_of({1: (0, straight(0.0, instants=9))})}, "recording must hold two windows"),
    "seen": ({"seen": 0.4}, "seen must be at least two"),
    "radius": ({"radius": 0.0}, "radius must"),
    "model": ({"model": "straight"}, "model must be a Pedestrian"),
}


@pytest.mark.parametrize(("change", "words"), MISTAKES.values(), ids=MISTAKES)
def test_mistakes_are_named(change: dict[str, Any], words: str) -> None:
    given = {"model": nav.crowd.SocialForce2000(), "recording": LONG, "names": ["strength"], "evaluations": 20}
    with pytest.raises(InvalidParameterError, match=words):
        nav.crowd.fit_people(**given | change)


def test_values_that_are_not_finite_are_refused_and_not_averaged() -> None:
    for name, row in (("position", 25), ("time_s", 3)):
        values = getattr(WALK, name).copy()
        values[row] = np.nan
        parts = {"time_s": WALK.time_s, "person": WALK.person, "position": WALK.position, name: values}
        with pytest.raises(InvalidParameterError, match=rf"recording.{name}\[{row}\] must be finite"):
            nav.crowd.prediction_errors("constant_velocity", SimpleNamespace(**parts))
    with pytest.raises(InvalidParameterError, match="recording must have time_s, person and position"):
        nav.crowd.prediction_errors("straight", None)  # type: ignore[arg-type]  # wrong on purpose


def test_rows_by_person_have_the_windows_of_rows_by_time() -> None:
    order = np.lexsort((WALK.time_s, -WALK.person))
    rows = SimpleNamespace(time_s=WALK.time_s[order], person=WALK.person[order], position=WALK.position[order])
    assert rows.time_s[0] > WALK.time_s[0]
    for part in ("first", "all"):
        given = {"seen": 1.6, "foretold": 1.6, "part": part}
        assert nav.crowd.prediction_errors("straight", rows, **given).windows == (
            nav.crowd.prediction_errors("straight", WALK, **given).windows
        )


# ---- the fundamental diagram ----------------------------------------------------------------


def corridor(n: int, **changes: Any) -> nav.World:
    return scenarios.corridor(n, **{"length": 20.0, "two_way": False, "radius": 0.2, "time_limit": 20.0, **changes})


def single_file(n: int, end: float = 1e6) -> nav.World:
    model = nav.crowd.CollisionFreeSpeed(time_gap=1.0)
    people = [
        nav.Person(start=(20.0 * k / n, 0.0), route=[(end, 0)], radius=0.2, desired_speed=1.3, model=model)
        for k in range(n)
    ]
    return nav.World(people=people, period=(20.0, 0.0), time_limit=2.0)


def test_the_reference_is_that_of_weidmann() -> None:
    assert nav.crowd.weidmann_speed(5.4) == 0.0
    assert nav.crowd.weidmann_speed([1e-3])[0] == pytest.approx(1.34)
    assert nav.crowd.weidmann_speed(1.0) == pytest.approx(1.34 * (1 - np.exp(-1.913 * (1 - 1 / 5.4))))
    with pytest.raises(InvalidParameterError, match="density must be above 0"):
        nav.crowd.weidmann_speed([1.0, 6.0])


def test_collision_free_people_slow_down_as_measured_crowds_do() -> None:
    model = nav.crowd.CollisionFreeSpeed(time_gap=0.5)
    worlds = [corridor(n, model=model, time_limit=40.0, seed=seed) for n in (30, 60, 120, 180) for seed in range(4)]
    found = nav.crowd.fundamental_diagram(worlds)
    assert found.density[::4].tolist() == [0.5, 1.0, 2.0, 3.0]
    np.testing.assert_allclose(found.speed.reshape(4, 4).mean(axis=1), [1.18, 0.97, 0.68, 0.31], atol=0.06)
    assert found.rms < 0.13
    assert nav.crowd.fundamental_diagram(worlds, threads=1).speed.tolist() == found.speed.tolist()


def test_single_file_walks_at_the_speed_of_its_gap() -> None:
    for n in (4, 12, 20, 40):
        found = nav.crowd.fundamental_diagram([single_file(n)], width=1.0)
        assert found.speed[0] == pytest.approx(np.clip(20.0 / n - 0.4, 0.0, 1.3), abs=1e-9)


def test_worlds_without_a_diagram_are_refused() -> None:
    for world, words in (
        (scenarios.bottleneck(4), r"worlds\[0\].period must"),
        (corridor(0), r"worlds\[0\].people must"),
        (replace(corridor(3), people=()), r"worlds\[0\].people must"),
        (3, r"worlds\[0\] must be a World"),
        # Both ways the mean velocity is 0 at any density; half the width is twice the density.
        (corridor(40, two_way=True), r"worlds\[0\].people\[\d+\].route must lead to \+x"),
        (corridor(40, width=6.0), r"width must be the distance of the walls of worlds\[0\], 6 m"),
        (replace(single_file(4), people=[nav.Person(start=(0, 0))]), r"people\[0\].route must lead to \+x"),
        (replace(single_file(4, end=21.0), time_limit=9.0), r"people\[3\].route must lead farther .*an arrival at"),
    ):
        with pytest.raises(InvalidParameterError, match=words):
            nav.crowd.fundamental_diagram([world])  # type: ignore[list-item]  # wrong on purpose
    with pytest.raises(InvalidParameterError, match="worlds must hold at least one world"):
        nav.crowd.fundamental_diagram([])
