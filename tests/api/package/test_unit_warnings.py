"""Doubts about units are also issued as warnings of Python: once, at the line of the user, and filterable."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import datasets, impact, io, scenarios
from hrsafety import navigation as nav
from hrsafety.plausibility import HrsafetyWarning, UnitWarning

FIELD = nav.VirtualForceField()
PERSON = {"start": (6.0, 3.0), "velocity": (-0.5, 0.0)}


def scene(**fields: Any) -> nav.Scenario:
    return nav.Scenario(**{"start": (0.0, 0.0), "goal": (4.0, 0.0), "time_limit": 20.0, **fields})


DEGREES = scene(heading=90.0)
MILLIMETERS = scene(
    goal=(40.0, 0.0),
    obstacles=[nav.Human(start=(20.0, 400.0), velocity=(0.0, 0.0), critical_radius=80.0, active_radius=210.0)],
)
PATH = np.linspace([0.0, 0.0], [6.0, 0.0], 61)
RECORDED = datasets.Recording(
    time_s=np.repeat(10.0 * np.arange(50), 2),
    person=np.tile([1, 2], 50),
    position=np.stack([np.repeat(0.5 * np.arange(50), 2), np.tile([0.0, 3.0], 50)], axis=1),
)
ARM, FOAM, HEAD = impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum()

CALLS: dict[str, tuple[Callable[[], Any], str]] = {
    "a run": (lambda: nav.simulate(DEGREES, FIELD), "heading is 90 rad"),
    "a run by keywords": (lambda: nav.simulate(scenario=DEGREES, law=FIELD), "heading is 90 rad"),
    "many runs by keywords": (lambda: nav.simulate_many(scenarios=[DEGREES], laws=FIELD), "heading is 90 rad"),
    "radii": (lambda: nav.simulate(MILLIMETERS, FIELD), r"obstacles\[0\].critical_radius is 80 m"),
    "a score": (lambda: nav.evaluate(DEGREES, FIELD), "heading is 90 rad"),
    "many runs": (lambda: nav.simulate_many([scene(), DEGREES], FIELD), "heading is 90 rad"),
    "a batch": (lambda: nav.simulate_batch([DEGREES], FIELD), "heading is 90 rad"),
    "a comparison": (lambda: nav.compare([DEGREES], [FIELD]), "heading is 90 rad"),
    "metrics": (
        lambda: nav.metrics.evaluate(PATH, step=0.1, goal=(6.0, 0.0), robot_radius=300.0),
        "robot_radius is 300 m",
    ),
    "many metrics": (
        lambda: nav.metrics.evaluate_many(
            [nav.metrics.Episode(position=PATH, step=100.0, goal=(6.0, 0.0), robot_radius=0.3)]
        ),
        "step is 100 s",
    ),
    "an impact": (lambda: impact.simulate(ARM, FOAM, HEAD, closing_speed=1250.0), "closing_speed is 1250 m/s"),
    "loads": (lambda: impact.metrics(ARM, FOAM, HEAD, closing_speed=1250.0), "closing_speed is 1250 m/s"),
    "many loads": (
        lambda: impact.metrics_batch(manipulator=ARM, foam=FOAM, head=HEAD, closing_speed=[1250.0, 1.0]),
        "closing_speed is 1250",
    ),
    "a search for a person": (
        lambda: nav.falsify(scene(), FIELD, episodes=2, person_radius=4e-4, person_speed=1.6e-3),
        "person_radius is 0.0004 m",
    ),
    "a world that is scored": (
        lambda: nav.metrics.evaluate_world(
            1000.0 * PATH[:, None], person_goals=[(6000.0, 0.0)], step=0.1, time_limit=10.0
        ),
        "median speed of people is 1000 m/s",
    ),
    "a grid": (
        lambda: nav.StaticMap.from_grid(np.eye(3, dtype=bool), resolution=50.0, yaw=90.0),
        "resolution is 50 m",
    ),
    "clearances": (
        lambda: nav.simulate(
            scene(obstacles=[nav.Disc(center=(200.0, 4.0), radius=0.1, active_clearance=80.0)]), FIELD
        ),
        r"obstacles\[0\].active_clearance is 80 m",
    ),
    "gradients": (lambda: impact.gradients(ARM, FOAM, HEAD, closing_speed=1250.0), "closing_speed is 1250 m/s"),
}


@pytest.mark.parametrize("name", CALLS)
def test_a_doubt_about_units_is_issued_once_at_the_line_of_the_user(name: str) -> None:
    call, message = CALLS[name]
    with pytest.warns(UnitWarning, match=message) as caught:
        result = call()
    assert len({str(each.message) for each in caught}) == len(caught)
    assert {Path(each.filename) for each in caught} == {Path(__file__)}
    assert issubclass(UnitWarning, HrsafetyWarning)
    # The result carries what was issued; those of many runs name the run, and count the others.
    carried = " ".join(doubt.message for doubt in result.warnings)
    assert all(str(each.message) in carried for each in caught)


def test_one_mistake_in_many_obstacles_is_issued_once() -> None:
    discs = [nav.Rectangle(center=(50.0, 5.0 + 3.0 * k), length=1.0, width=1.0, heading=90.0) for k in range(30)]
    crowded = scene(obstacles=discs)
    with pytest.warns(UnitWarning) as caught:
        run = nav.simulate(crowded, FIELD)
    assert len(caught) == 1
    assert len([each for each in run.warnings if each.code == "implausible"]) == 30


@pytest.mark.parametrize(
    "call",
    [
        lambda: nav.Run(DEGREES, FIELD),
        lambda: nav.Run(scenario=DEGREES),
        lambda: RECORDED.humans(0.0, duration=100.0),
        lambda: nav.crowd.prediction_errors("constant_velocity", RECORDED, seen=20.0, foretold=40.0, every=20.0),
        lambda: nav.simulate_batch([each.scenario for each in scenarios.crossings(RECORDED, runs=1)], FIELD),
    ],
)
def test_what_is_made_of_doubtful_numbers_says_so(call: Callable[[], Any]) -> None:
    with pytest.warns(UnitWarning) as caught:
        call()
    assert {Path(each.filename) for each in caught} == {Path(__file__)}


def test_environments_say_what_is_doubtful_in_their_world() -> None:
    gym = pytest.importorskip("hrsafety.gym")
    person = nav.Person(start=(900.0, 0.0), route=[(0.0, 0.0)], radius=250.0)
    robot = nav.Robot(start=(0.0, 0.0), goal=(4.0, 3.0))
    world = nav.World(people=[person], robots=[robot], time_limit=2.0)
    for make in (
        lambda: gym.CrowdEnv(world),
        lambda: gym.CrowdEnv(world=world),
        lambda: gym.CrowdVectorEnv(world, num_envs=2),
    ):
        with pytest.warns(UnitWarning, match="radius is 250 m") as caught:
            make()
        assert {Path(each.filename) for each in caught} == {Path(__file__)}


def test_a_file_of_frames_says_so_when_it_is_read(tmp_path: Path) -> None:
    path = tmp_path / "people.csv"
    rows = [f"{10 * k},{person},{0.5 * k},{3.0 * person}" for k in range(30) for person in (1, 2)]
    path.write_text("\n".join(["t_s,ped_id,x_m,y_m", *rows]), encoding="utf-8")
    with pytest.warns(UnitWarning, match="fps="):
        io.load_people(path)


@pytest.mark.parametrize(
    "call",
    [
        lambda: nav.simulate(scene(obstacles=[nav.Human(**PERSON)]), FIELD),
        lambda: nav.simulate_many([scene()], FIELD),
        lambda: impact.metrics(ARM, FOAM, HEAD, closing_speed=1.0),
        lambda: scenarios.crossings(RECORDED, runs=1),
    ],
)
def test_right_numbers_and_doubts_of_another_kind_are_silent(call: Callable[[], Any]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        call()


def test_doubts_can_be_filtered() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", HrsafetyWarning)
        assert nav.simulate(DEGREES, FIELD).warnings[0].code == "implausible"
    with warnings.catch_warnings():
        warnings.simplefilter("error", HrsafetyWarning)
        with pytest.raises(UnitWarning, match="heading"):
            nav.simulate(DEGREES, FIELD)


def test_threads_of_workers_are_silent() -> None:
    found: list[Any] = []

    def work() -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            try:
                found.append(nav.simulate(DEGREES, FIELD).outcome)
            except Warning as warning:
                found.append(warning)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert found == ["arrived"]


def test_the_decorated_function_is_the_documented_one() -> None:
    assert nav.simulate.__name__ == "simulate"
    assert nav.simulate.__module__ == "hrsafety.navigation.simulation"
    assert "Scenario" in str(nav.simulate.__wrapped__.__annotations__)
