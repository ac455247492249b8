"""Arguments that are nothing of their kind, numbers at the end of their range, folders that cannot be written."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from hrsafety import (
    InvalidParameterError,
    ShapeError,
    contact,
    datasets,
    impact,
    io,
    plausibility,
    reactive,
    scenarios,
    standards,
    sweep,
    tables,
)
from hrsafety import navigation as nav
from hrsafety._atomic import only_writer
from hrsafety.benchmarks import benchmark, entry
from hrsafety.errors import FolderInUseError, StorageError

LAW, SCENE = nav.VirtualForceField(), scenarios.configuration("c1")
HUGE = (0.3, 1.79e308)
WALK = datasets.Recording(time_s=[0.0, 20.0], person=[7, 7], position=[[-10, 1], [10, 1]])

REFUSED: dict[str, tuple[Callable[[], object], str]] = {
    "episodes of a number": (lambda: nav.crowd.episodes_of(1.0), "run"),
    "episodes without a number": (
        lambda: nav.crowd.episodes_of(nav.simulate(scenarios.circle_crossing(1)), 1.0),
        "without",
    ),
    "metrics of a number": (lambda: nav.crowd.world_metrics(1.0), "run"),
    "entry of a number": (lambda: entry(1.0), "laws"),
    "head of an array": (
        lambda: contact.Contact(robot=3.0, body=0.6, region=75e3).simulate(0.5, head=np.ones(2)),
        "head",
    ),
    "corridor beyond the world": (lambda: scenarios.corridor(5, length=1e101), "length"),
    "corridor of many cells": (lambda: scenarios.corridor(5, length=2.0**64), "length"),
    "wide corridor": (lambda: scenarios.corridor(5, width=1e300), "width"),
    "torus beyond the world": (lambda: scenarios.cross_torus(5, side=1e200), "side"),
    "skirt of next to nothing": (
        lambda: reactive.skirt.least_skirt_sensors(wheel_sensor_radius=0.33, sensor_radius=1e-320),
        "wheel_sensor_radius",
    ),
    "function of a huge velocity": (lambda: nav.lyapunov(LAW, SCENE, position=(2.95, 0.71), velocity=HUGE), "velocity"),
    "function of a huge position": (lambda: nav.lyapunov(LAW, SCENE, position=HUGE, velocity=(0.0, 0.0)), "position"),
    "command of a huge velocity": (
        lambda: nav.laws.command(LAW, SCENE, position=(2.95, 0.71), velocity=(1.79e308, 1.79e308)),
        "velocity",
    ),
    "turned infinity": (lambda: reactive.follower.rotate_to_world((np.inf, 0.0), 0.3), "vector"),
    "turned by infinity": (lambda: reactive.follower.rotate_to_world((1.0, 0.0), np.inf), "heading"),
    "echo from infinity": (lambda: reactive.follower.collision_point((0.0, 0.15), 0.0, np.inf), "reading"),
    "echo from nowhere": (lambda: reactive.follower.collision_point((0.0, np.nan), 0.0, 1.0), "sensor"),
    "echo at a huge place": (lambda: reactive.follower.collision_point((1.7e308, 0.0), 0.0, 1.7e308), "sensor"),
    "skirt that is none": (lambda: reactive.skirt.smallest_skirt(0.1, skirt=1.0), "skirt"),
    "motion that is none": (lambda: reactive.skirt.smallest_skirt(0.1, motion=1.0), "motion"),
    "unit that is none": (lambda: tables.unit_suffix(1.0), "unit"),
    "progress that is none": (lambda: nav.simulate_many(SCENE, LAW, progress="x"), "progress"),
    "integrator of nothing": (
        lambda: nav.simulate(SCENE, LAW, built=nav.robots.AsBuilt(), integrator=np.array([])),
        "integrator",
    ),
    "huge body": (
        lambda: contact.Contact(robot=8.0, body=standards.limits().contact("chest", "transient")).allowed_speeds(
            body_mass=10**400
        ),
        "body_mass",
    ),
    "spacing of nothing": (
        lambda: nav.sensing.patch_places(nav.sensing.Camera(), spacing=np.array([])),
        "spacing",
    ),
    "spacing next to nothing": (lambda: nav.sensing.patch_places(nav.sensing.Camera(), spacing=5e-324), "spacing"),
    "huge spacing": (lambda: nav.sensing.patch_places(nav.sensing.Camera(), spacing=10**400), "spacing"),
    "radius below nothing": (lambda: nav.Human(start=(0, 0), velocity=(1, 0)).contact_distance(-1.0), "robot_radius"),
    "huge radius": (lambda: nav.Human(start=(0, 0), velocity=(1, 0)).contact_distance(10**400), "robot_radius"),
    "huge length": (lambda: scenarios.crossings(WALK, length=10**400), "length"),
    "scene file of a number": (lambda: scenarios.load(1.0), "path"),
    "catalog of a number": (lambda: contact.load_materials(1.0), "path"),
    "limits of a number": (lambda: standards.load_limits(1.0), "path"),
    "people of a number": (lambda: io.load_people(1.0), "path"),
    "map of a number": (lambda: nav.StaticMap.from_map_server(1.0), "path"),
    "quantity that is none": (lambda: plausibility.implausible({"headng": 1.0}), "quantities"),
    "feet of infinity": (lambda: reactive.follower.collision_vector((np.inf, -1.0), (1.0, 1.0)), "one"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_no_function_can_use_is_refused_by_name(case: str) -> None:
    call, argument = REFUSED[case]
    with pytest.raises((InvalidParameterError, ShapeError)) as caught:
        call()
    assert caught.value.argument == argument


@pytest.mark.parametrize("length", [1e-3, 1e3, 1e6])
def test_thin_and_long_corridors_take_no_room(length: float) -> None:
    assert len(scenarios.corridor(50, length=length, width=1e-3).people) == 50


@pytest.mark.parametrize("ratio", [1e-300, 1e-15, 1e-12, 1e-9, 1e-6])
def test_foam_that_relaxes_at_once_lands_as_one_without_damping(ratio: float) -> None:
    time = np.linspace(0.0, 0.6, 601)
    given = {"height": 0.05, "mass": 1.54, "stiffness": 24250.0}
    hardly, never = (impact.identification.drop_trajectory(time, **given, damping_ratio=each) for each in (ratio, 0.0))
    assert hardly == pytest.approx(never, abs=max(1e-9, 1e3 * ratio))


def test_a_second_process_does_not_write_the_same_rows(tmp_path: Path) -> None:
    benchmark("s4", ["orca"], cases=1, out=tmp_path)
    (rows,) = tmp_path.glob("*.csv")
    kept = rows.read_bytes()
    program = (
        "import sys\nfrom pathlib import Path\nfrom hrsafety._atomic import only_writer\n"
        "from hrsafety.errors import FolderInUseError\n"
        "with only_writer(Path(sys.argv[1]), FolderInUseError):\n    print('held', flush=True)\n    sys.stdin.read()"
    )
    lock = rows.with_name(f".{rows.name}.lock")
    with subprocess.Popen(
        [sys.executable, "-c", program, str(lock)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"held\n"
        with pytest.raises(FolderInUseError, match="another process is writing"):
            benchmark("s4", ["orca"], cases=2, out=tmp_path)
        assert rows.read_bytes() == kept
        other.communicate()
    assert len(benchmark("s4", ["orca"], cases=2, out=tmp_path).rows["orca"]) == 2
    assert not lock.exists()
    with only_writer(lock, FolderInUseError), pytest.raises(FolderInUseError, match="of this process"):
        benchmark("s4", ["orca"], cases=3, out=tmp_path)


def test_folders_that_cannot_be_written_are_named(tmp_path: Path) -> None:
    file = tmp_path / "rows"
    file.write_text("")
    for place in (file, Path("/dev/null"), "a\0b", 3.0):
        with pytest.raises(InvalidParameterError) as caught:
            benchmark("s4", ["orca"], cases=1, out=place)  # type: ignore[arg-type]  # refused
        assert caught.value.argument == "out"
    with pytest.raises(StorageError, match="choose a folder that can be written"):
        benchmark("s4", ["orca"], cases=1, out=file / "below")
    if sys.platform == "linux":
        with pytest.raises(StorageError, match="cannot be written"):
            benchmark("s4", ["orca"], cases=1, out="/proc/self")


def test_first_estimate_of_a_process_is_no_start_up_time() -> None:
    program = """
import time
from hrsafety import impact, sweep
from hrsafety.navigation.crowd.simulation import simulated
study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())
axes = [sweep.Axis(name="closing_speed", low=0.2, high=2.0), sweep.Axis(name="foam_stiffness", low=1e4, high=5e4)]
found = [sweep.estimate(sweep.Sobol(axes, size=2**20), study) for _ in range(2)]
print(found[0].seconds / found[1].seconds, min(each.measured_rows for each in found))
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    ratio, rows = map(float, done.stdout.split())
    assert 0.2 < ratio < 5.0
    assert rows >= 1000


def test_estimates_of_slow_rows_end_in_time() -> None:
    from time import perf_counter, sleep

    def slow(speed: np.ndarray) -> dict[str, np.ndarray]:
        sleep(0.05 * len(speed))
        return {"found": speed}

    study = sweep.FunctionStudy(function=slow, results=["found"])
    begin = perf_counter()
    found = sweep.estimate(sweep.Grid([sweep.Axis(name="speed", low=0.2, high=2.0, points=10_000)]), study)
    assert perf_counter() - begin < 25.0
    assert found.seconds == pytest.approx(500.0, rel=0.3)
