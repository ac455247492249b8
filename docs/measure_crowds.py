"""Measure how laws fare among people that react: the tables of the guide to crowds.

    python docs/measure_crowds.py RECORDING.csv

prints contacts in 24 crossings of a recording in which everybody reacts, and rows of 500 cases of the circle
crossing, with people who see the robot and people who do not. Without a recording only the latter.
"""

from __future__ import annotations

import sys

import numpy as np

from hrsafety import datasets, scenarios
from hrsafety import navigation as nav
from hrsafety.benchmarks import entry

CASES = 500
MODELS = (
    nav.crowd.CollisionFreeSpeed,
    nav.crowd.SocialForce2000,
    nav.crowd.ReciprocalAvoidance,
    nav.crowd.Moussaid,
    nav.crowd.SocialForce1995,
)
ENTRIES = ("field", "field+shield", "orca", "orca+shield", "velocity_obstacle", "velocity_obstacle+shield")
PERSON_SPEED = 1.0
"""What the shield assumes of people, in m/s: as fast as people of the circle crossing walk."""


def share(flags: np.ndarray) -> str:
    """Return a share in percent with its 95 % interval."""
    found = nav.metrics.wilson(int(flags.sum()), len(flags))
    return f"{100 * found.value:.1f} ({100 * found.low:.1f} to {100 * found.high:.1f})"


def row(word: str, visible: bool) -> str:
    """Return a row of the table."""
    law = entry(word).built(person_speed=PERSON_SPEED)
    worlds = [scenarios.circle_crossing(case, law=law, visible=visible) for case in range(CASES)]
    table = nav.crowd.crowd_batch(worlds, people_alone=True)
    contacts = table.robot_on_person + table.person_on_robot + table.mutual_contacts > 0
    seen = "yes" if visible else "no"
    cells = [
        word,
        seen,
        share(table.success),
        share(contacts),
        share(table.robot_on_person > 0),
        f"{np.nanmean(table.arrival_time):.2f}",
        f"{np.mean(table.min_clearance):.2f}",
        f"{np.nanmean(table.person_delay):.2f}",
    ]
    return "| " + " | ".join(cells) + " |"


def encounters(model: nav.crowd.Pedestrian, recording: datasets.Recording) -> str:
    """Return how many of 24 crossings have a contact with the standing and with the moving robot."""
    standing = moving = 0
    for crossing in scenarios.crossings(recording, runs=24):
        scene = crossing.scenario
        law = nav.OptimalReciprocalCollisionAvoidance()
        robot = nav.crowd.CrowdRobot(start=scene.start, goal=scene.goal, law=law, robot=scene.robot)
        world = scenarios.with_recording(
            recording, 1.0, model=model, robots=[robot], start_time=crossing.start_time, radius=0.4
        )
        run = nav.crowd.simulate_crowd(world)
        gap = np.hypot(*np.moveaxis(run.position - run.robot_position, -1, 0)) - run.radius - scene.robot.radius
        speed = np.hypot(*run.robot_velocity[:, 0].T)
        touched = np.nanmin(np.where(np.isnan(gap), np.inf, gap), axis=1) < 0.0
        standing += bool((touched & (speed <= 0.05)).any())
        moving += bool((touched & (speed > 0.05)).any())
    return f"| `{type(model).__name__}` | {standing} | {moving} |"


def main() -> None:
    """Print the tables."""
    if len(sys.argv) > 1:
        recording = datasets.load_pedestrians(sys.argv[1])
        print("| people | contacts with the standing robot, of 24 | with the moving robot |\n|---|---|---|")
        for kind in MODELS:
            print(encounters(kind(), recording), flush=True)
    names = ("law", "seen", "success %", "contact %", "robot on person %", "time s", "least gap m", "delay of people s")
    print(f"| {' | '.join(names)} |\n|{'---|' * len(names)}")
    for visible in (True, False):
        for word in ENTRIES:
            print(row(word, visible), flush=True)


if __name__ == "__main__":
    main()
