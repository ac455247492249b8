"""Print the laboratory data of the validation page from published trajectories.

    python docs/laboratory_data.py FOLDER

The folder has the unidirectional corridors ``uo-*.txt`` of the HERMES experiments (Zhang, Klingsch, Schadschneider and
Seyfried, Journal of Statistical Mechanics (2011) P06004; Forschungszentrum Juelich, ped.fz-juelich.de/database), for
example from ``datasets/HERMES/Corridor-1D`` of OpenTraj: number, frame (16 of them a second), x and y in cm. Density
and speed are taken in the middle 4 m of the corridor of 8 m, whose width is the second number of the name: people in
it over its area, and their mean velocity over half a second before and after, at each frame; both are averaged over
all frames whose density lies in one of the ranges of 0.2 people for each square meter. Where the exit is narrower than
the corridor, the third number of the name, its flow is that of the people from the first fifth to the fourth.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

FRAMES = 16
"""Of a second."""
HALF = 8
"""Frames on each side over which a velocity is taken."""
REACH = 200.0
"""Ends of the part that is looked at, in cm from the middle of the corridor."""
EXIT = 400.0
"""End of the corridor in cm from its middle."""
RANGE = 0.2
"""Width of the ranges of density, in 1/m^2."""


def instants(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Return density and mean speed at each frame of a file with somebody in the middle of the corridor."""
    rows = np.loadtxt(path)
    rows = rows[np.lexsort((rows[:, 1], rows[:, 0]))]
    who, frame, along = rows[:, 0], rows[:, 1].astype(int), rows[:, 3]
    speed = np.full(len(rows), np.nan)
    early, late = slice(None, -2 * HALF), slice(2 * HALF, None)
    whole = (who[early] == who[late]) & (frame[late] - frame[early] == 2 * HALF)
    speed[HALF:-HALF] = np.where(whole, (along[early] - along[late]) / 100.0 * FRAMES / (2 * HALF), np.nan)
    seen = (np.abs(along) < REACH) & ~np.isnan(speed)
    present = np.bincount(frame[seen])
    total = np.bincount(frame[seen], weights=speed[seen])
    width = float(path.stem.split("-")[2]) / 100.0
    some = present > 0
    return present[some] / (2.0 * REACH / 100.0 * width), total[some] / present[some]


def flow(path: Path) -> float:
    """Return how many people leave the corridor in a second, from the first fifth of them to the fourth."""
    rows = np.loadtxt(path)
    beyond = rows[rows[:, 3] < -EXIT]
    times = np.sort([beyond[beyond[:, 0] == who, 1].min() for who in np.unique(beyond[:, 0])]) / FRAMES
    first, last = int(0.2 * len(times)), int(0.8 * len(times))
    return float((last - first) / (times[last] - times[first]))


def main() -> None:
    """Print a line for each range of density, and for each exit."""
    parser = argparse.ArgumentParser(description="Speed over density in the laboratory.")
    parser.add_argument("folder", type=Path)
    files = sorted(parser.parse_args().folder.glob("uo-*.txt"))
    found = [instants(path) for path in files if path.stat().st_size]
    density, speed = (np.concatenate(each) for each in zip(*found, strict=True))
    print(f"# {len(found)} runs, {len(density)} instants")
    for number in range(int(density.max() / RANGE) + 1):
        inside = (density >= number * RANGE) & (density < (number + 1) * RANGE)
        if inside.any():
            print(f"({density[inside].mean():.2f}, {speed[inside].mean():.2f}),  # {inside.sum()} instants")
    for path in files:
        _, corridor, exit_ = path.stem.split("-")[1:]
        if path.stat().st_size and int(exit_) < int(corridor):
            print(f"({int(exit_) / 100:.2f}, {flow(path):.2f}),  # corridor of {int(corridor) / 100:.2f} m")


if __name__ == "__main__":
    main()
