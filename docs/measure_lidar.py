"""Measure laws that know walls by a lidar alone: shares of bent corridors passed without a contact."""

from __future__ import annotations

import sys

import numpy as np

from hrsafety import navigation as nav
from hrsafety._statistics import Share, wilson

SEEDS = range(200)
WIDTH = 1.4
LENGTH = 9.0
LIDARS = {
    "3,600 beams": {"beams": 3600},
    "360 beams": {"beams": 360},
    "360 beams, ±30 mm": {"beams": 360, "range_noise": 0.03},
    "360 beams, ahead only": {"beams": 360, "field_of_view": np.pi},
}
LAWS = {
    "virtual force field": (nav.VirtualForceField(), {}),
    "Khatib": (nav.Khatib(), {}),
    "velocity obstacle": (nav.VelocityObstacle(), {"reach": 1.5, "kappa": 1.0}),
    "ORCA": (nav.OptimalReciprocalCollisionAvoidance(horizon=1.0), {"reach": 1.5, "kappa": 1.0}),
}


def corridor(seed: int) -> tuple[nav.StaticMap, nav.Scenario]:
    """Return a corridor with three bends, and the way through it."""
    random = np.random.default_rng(seed)
    x = np.array([-1.0, 2.0, 4.5, 7.0, LENGTH])
    y = np.concatenate([[0.0, 0.0], np.cumsum(random.uniform(-1.5, 1.5, 3))])
    middle = np.stack([x, y], axis=1)
    walls = [middle + np.array([0.0, side * WIDTH]) for side in (-0.5, 0.5)]
    goal = middle[-1] - (0.5 * (middle[-1] - middle[-2]) / np.hypot(*(middle[-1] - middle[-2])))
    ends = {"start": (0.0, 0.0), "goal": (float(goal[0]), float(goal[1]))}
    return nav.StaticMap.from_polylines(walls), nav.Scenario(robot=nav.HolonomicRobot(), obstacles=[], **ends)


def shares(law: nav.Law, options: dict[str, float]) -> tuple[Share, Share]:
    """Return the shares of corridors passed without a contact, and of those with one."""
    passed = touched = 0
    for seed in SEEDS:
        walls, scenario = corridor(seed)
        sensor = nav.Lidar(map=walls, **options)  # type: ignore[arg-type]  # numbers by name
        run = nav.simulate(scenario, law, built=nav.robots.AsBuilt(sensors=[sensor]))
        touches = bool(walls.clearance(run.position).min() <= scenario.robot.radius)
        touched += touches
        passed += run.outcome == "arrived" and not touches
    return wilson(passed, len(SEEDS)), wilson(touched, len(SEEDS))


def main() -> None:
    """Print the table."""
    print("| law | " + " | ".join(LIDARS) + " |")
    print("|---|" + "---|" * len(LIDARS))
    for name, (law, reach) in LAWS.items():
        cells = []
        for options in LIDARS.values():
            passed, touched = shares(law, {**options, **reach})
            cells.append(f"{100 * passed.value:.1f} / {100 * touched.value:.1f}")
        print(f"| {name} | " + " | ".join(cells) + " |")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
