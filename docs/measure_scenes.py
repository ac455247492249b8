"""Certificates and pictures of the standard scenes.

``python docs/measure_scenes.py`` certifies the seeds 0 to 99 of all scenes and prints the table, ``--write`` replaces
what stands between the marks of docs/guides/standard_scenes.md. Both draw docs/images/standard_scenes.png.
"""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np

from hrsafety import arena, scenarios
from page_tables import DOCS, head, line, print_or_write

PAGE = DOCS / "guides" / "standard_scenes.md"
SEEDS = 100


def certificates() -> str:
    """Return how many seeds of each scene are certified, and when the robot of the certificate arrives."""
    rows = head("scene", f"certified, of {SEEDS} seeds", "earliest arrival in s", "median", "latest")
    for name in scenarios.SOCIAL:
        found = arena.certify_many(scenarios.social(name, seed) for seed in range(SEEDS))
        times = np.array([each.arrival_time for each in found if each.solvable])
        if len(times) < SEEDS:
            print(f"{name}: {[seed for seed, each in enumerate(found) if not each.solvable]} not certified")
        counted = len(times), *(f"{time:.1f}" for time in (times.min(), np.median(times), times.max()))
        rows.append(line(f"`{name}`", *counted))
    return "\n".join(rows) + "\n"


def picture() -> None:
    """Draw the scenes of seed 0 with the way of the certificate."""
    figure, axes = plt.subplots(5, 5, figsize=(16, 13))
    for name, place in zip(scenarios.SOCIAL, axes.flat, strict=True):
        world = scenarios.social(name, 0)
        robot, way = world.robots[0], arena.certify(world).path
        for wall in world.walls:
            place.plot(*np.transpose(wall), color="0.2", linewidth=1.5)
        for person in world.people:
            track = person.route if person.recording is None else person.recording[1]
            places = np.array([person.start, *track])
            place.plot(*places.T, color="#CC6677", linewidth=0.8, linestyle=":")
            place.add_patch(plt.Circle(person.start, person.radius, color="#CC6677"))
        place.plot(*way.T, color="#0072B2", linewidth=1.2)
        place.add_patch(plt.Circle(robot.start, robot.body.radius, color="#0072B2"))
        place.plot(*robot.goal, marker="x", color="#0072B2")
        place.set_title(name.replace("_", " "), fontsize=10)
        place.set_aspect("equal")
        place.set_xlim(-4.5, 14.5)
        place.set_ylim(-7.0, 7.0)
        place.tick_params(labelsize=7)
    figure.supxlabel("x in m")
    figure.supylabel("y in m")
    figure.tight_layout()
    figure.savefig(DOCS / "images" / "standard_scenes.png", dpi=90)


if __name__ == "__main__":
    parts = {"certificates": ("certificates of measure_scenes.py", certificates)}
    print_or_write(PAGE, parts)
    picture()
