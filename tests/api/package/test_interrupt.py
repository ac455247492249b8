"""Ctrl-C while the core works: batches, one huge record, a bootstrap, maps."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from api.interrupting import check_work_is_interrupted, needs_signals

IMPORTS = """
import numpy as np
from hrsafety import impact, navigation as nav
"""

# A robot without forces waits for its time limit in each of the long runs; the short runs arrive.
RUNS = """
scene = nav.Scenario(
    start=(3.9, 0.6), goal=(0.0, 0.6), time_limit=60.0, rest_time=60.0,
    obstacles=[nav.Human(start=(0.0, y), velocity=(0.01, 0.0)) for y in (-5.0, 5.0, 8.0)],
)
gains = np.tile({gains}, (400_000, 1))
"""
LONG, SHORT = RUNS.format(gains=(0.0, 0.0, 0.0, 0.0)), RUNS.format(gains=(3.0, 20.0, 17.0, 0.25))
SIMULATE = "nav.simulate_batch([scene], nav.VirtualForceField(), gains, {options})"

# A planner that thinks for tens of milliseconds at every step.
CROWDS = """
from hrsafety import scenarios
crowds = [scenarios.random_traffic(12, seed=seed) for seed in range(40)]
"""
PLANNED = "nav.simulate_batch(crowds, nav.FieldDStar(resolution=0.02), threads=2)"

# Wheels with controllers every millisecond.
WHEELS = """
from hrsafety import scenarios
scene, built = scenarios.configuration("c4"), nav.robots.AsBuilt(wheels=nav.robots.HOLONOMIC_WHEELS)
"""
WORLDS = "from hrsafety import scenarios\nworlds = [scenarios.circle_crossing(case) for case in range(20)]"
DRIVEN_AMONG_PEOPLE = "nav.simulate_many(worlds, nav.VirtualForceField(), seeds=1000, people_alone=True, threads=2)"
REPEATED = "nav.simulate_many(scene, nav.VirtualForceField(), seeds=100_000, built=built, threads=2)"

PARTS = "parts = (impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum())"
SPEEDS = "speeds = np.linspace(0.1, 2.0, 20_000_000)\n" + PARTS
BATCH = (
    "impact.metrics_batch(manipulator=parts[0], foam=parts[1], head=parts[2], closing_speed=speeds, threads=1{more})"
)
RECORD = "impact.simulate(*parts, closing_speed=1.25, duration=0.04, step=1e-9, method={method!r})"
JOINT = """
drive = impact.joints.DirectDrive(proportional=448.7, derivative=5.579)
"""
DRIVEN = """impact.joints.simulate_direct_drive(
        drive, impact.FOAM_1, impact.Head.apparatus(), closing_speed=1.25, duration=2500.0, step=1e-3)"""
DROP = """
time_ = np.arange(0.0, 0.4, 0.001)
drop = impact.identification.drop_trajectory(
    time_, height=0.05, mass=1.54, stiffness=24250.0, damping_ratio=0.112, friction=2.0
)
depth = np.linspace(0.0, 0.008, 17)
force = 24250.0 * depth + np.sin(np.arange(17.0))
"""
BOOTSTRAP = "impact.identify_foam(force, depth, time_, np.round(drop, 4), 1.54, bootstrap=200_000)"
STATIC = """
depth = np.linspace(0.0, 0.01, 2_000_000)
force = 24e3 * depth + np.sin(np.arange(len(depth)))
"""
SIGNALS = """
instants = np.arange(20_000_000) * 1e-6
signal = 30.0 * np.abs(np.sin(1e-4 * np.arange(20_000_000)))
"""
CELLS = "cells = np.random.default_rng(0).random((6000, 6000)) < 1e-4"
ROOM = """
corners = ((0.0, 0.0), (0.3, 0.0), (0.3, 0.3), (0.0, 0.3))
room = nav.StaticMap.from_polygons([[(x + i, y + j) for i, j in corners] for x in range(60) for y in range(60)])
places = np.random.default_rng(0).uniform(0.0, 60.0, (10_000_000, 2))
"""
WHEEL = """
wheel = nav.HOLONOMIC_WHEELS[0]
"""
TESTED = """
tests = nav.open_loop_tests(wheel, duration=2000.0, repeats=1)
"""
BOUNDARY = "impact.foam_stiffness_upper(parts[0], damping=np.linspace(0.0, 300.0, 400_000), closing_speed=1.25)"

SEEDS = "from hrsafety import scenarios\nseeds = range(1_000_000)"
LEARNERS = "from hrsafety import gym, scenarios\nworld = scenarios.circle_crossing(0)"

# Every piece of work takes many seconds, so the signal always arrives while it runs.
JOBS = {
    "long runs": (LONG, SIMULATE.format(options="threads=2")),
    "long runs, reported": (LONG, SIMULATE.format(options="threads=2, progress=lambda done, total: None")),
    "short runs": (SHORT, SIMULATE.format(options="threads=1, lanes=1")),
    "short runs, reported": (SHORT, SIMULATE.format(options="threads=1, lanes=1, progress=lambda done, total: None")),
    "planned runs": (CROWDS, PLANNED),
    "repeated runs": (WHEELS, REPEATED),
    "worlds of people": (WORLDS, DRIVEN_AMONG_PEOPLE),
    "impacts": (SPEEDS, BATCH.format(more="")),
    "impacts, reported": (SPEEDS, BATCH.format(more=", progress=lambda done, total: None")),
    "one impact, exact": (PARTS, RECORD.format(method="exact")),
    "one impact, stepped": (PARTS, RECORD.format(method="rk4")),
    "one joint": (JOINT, DRIVEN),
    "bootstrap": (DROP, BOOTSTRAP),
    "boundary": (PARTS, BOUNDARY),
    "head injury criteria": (SIGNALS, "[impact.hic(instants, signal) for _ in range(40)]"),
    "recorded impacts": (SIGNALS, "[impact.recorded_metrics(instants, signal) for _ in range(20)]"),
    "distances of cells": (CELLS, "[nav.maps.distance_transform(cells) for _ in range(20)]"),
    "a map of cells": (CELLS, "[nav.maps.StaticMap.from_grid(cells, resolution=0.05) for _ in range(40)]"),
    "distances of points": (ROOM, "room.clearance(places)"),
    "rays": (ROOM, "room.ray((0.65, 0.65), places[:, 0])"),
    "scenes of people drawn": (SEEDS, "[scenarios.random_crowd_batch(seeds, people=8) for _ in range(5)]"),
    "scenes of traffic drawn": (SEEDS, "[scenarios.random_traffic_batch(seeds, obstacles=8) for _ in range(5)]"),
    "environments made": (LEARNERS, "[gym.CrowdVectorEnv(world, num_envs=100_000).reset(seed=0) for _ in range(20)]"),
    "static tests": (STATIC, "[impact.fit_static(force, depth) for _ in range(1000)]"),
    "open-loop tests": (WHEEL, "[nav.open_loop_tests(wheel, duration=3000.0, repeats=1) for _ in range(100)]"),
    "wheel": (WHEEL + TESTED, "[nav.identify_wheel(tests) for _ in range(1000)]"),
}


@needs_signals
@pytest.mark.parametrize("job", JOBS)
def test_running_work_answers_ctrl_c(job: str, capsys: pytest.CaptureFixture[str]) -> None:
    preparation, work = JOBS[job]
    check_work_is_interrupted(IMPORTS + preparation, work, capsys)


# Python answers a signal between two of its own steps: the longest of them tells how late Ctrl-C may be answered.
TICKS = """
import signal, sys, time
import numpy as np
from hrsafety import navigation as nav, reactive
{preparation}
last, longest = time.thread_time(), 0.0
def tick(*_):
    global last, longest
    now = time.thread_time()
    last, longest = now, max(longest, now - last)
signal.signal(signal.SIGALRM, tick)
signal.setitimer(signal.ITIMER_REAL, 0.005, 0.005)
last = time.thread_time()
{work}
signal.setitimer(signal.ITIMER_REAL, 0)
tick()
print(longest)
"""
SERVED = """
import pathlib
rows = columns = 14_000
pathlib.Path("m.yaml").write_text(
    "image: m.pgm\\nresolution: 0.1\\norigin: [0, 0, 0]\\noccupied_thresh: 0.65\\nfree_thresh: 0.2\\nnegate: 0")
with open("m.pgm", "wb") as file:
    file.write(b"P5 %d %d 255\\n" % (columns, rows))
    file.write(bytes([254]) * (rows * columns))
from hrsafety.navigation.maps.map_server import read_map_server
"""
RECORDED = """
import wave
with wave.open("long.wav", "wb") as file:
    file.setnchannels(3); file.setsampwidth(2); file.setframerate(48000)
    file.writeframes(bytes(6 * 30_000_000))
"""


@needs_signals
@pytest.mark.parametrize(
    ("preparation", "work"),
    [
        (SERVED, "read_map_server('m.yaml')"),
        (RECORDED, "reactive.read_recording('long.wav')"),
    ],
    ids=["map server", "recording"],
)
def test_no_step_of_reading_a_large_file_takes_long(preparation: str, work: str, tmp_path: Path) -> None:
    program = TICKS.format(preparation=preparation, work=work)
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 0.2
