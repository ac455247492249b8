"""Measure how real the models of people are: the tables of the validation page.

    HRSAFETY_RECORDINGS=FOLDER python docs/measure_people.py

prints the errors of predictions in zara01.csv and zara03.csv of the folder (the parameters are from the first half
of the windows of zara01), with the parameters of the sources and fitted ones, and the fundamental diagram. Without a
folder only the latter.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from hrsafety import io, scenarios
from hrsafety import navigation as nav

FITTED = {
    nav.crowd.CollisionFreeSpeed: ("time_gap", "strength", "range"),
    nav.crowd.Moussaid: ("relaxation_time", "strength", "gamma", "velocity_weight"),
    nav.crowd.SocialForce2000: ("relaxation_time", "strength", "range"),
    nav.crowd.SocialForce1995: ("relaxation_time", "strength", "range"),
    nav.crowd.ReciprocalAvoidance: ("horizon",),
}
DENSITIES = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0)
LENGTH, WIDTH, LIMIT, RADIUS = 20.0, 3.0, 40.0, 0.2
"""Of the corridor in m, its time in s, and of the people in m."""
SEEDS = 5
"""Corridors of each density, over which the speed is averaged."""
SHOWN = {"constant_velocity": "constant velocity (goal unknown)", "straight": "straight to the goal"}


def cells(errors: nav.crowd.PredictionErrors) -> str:
    """Return one-step, average and final errors in m."""
    return f"{errors.one_step:.3f} / {errors.average:.3f} / {errors.final:.3f}"


def predicted(folder: Path) -> None:
    """Print the errors of predictions."""
    one, other = (io.load_people(folder / f"{name}.csv") for name in ("zara01", "zara03"))
    fit = nav.crowd.prediction_errors("straight", one, part="first").windows
    held = nav.crowd.prediction_errors("straight", one, part="second").windows
    far = nav.crowd.prediction_errors("straight", other).windows
    names = (f"fit: zara01, {fit} windows", f"held out: zara01, {held} windows", f"held out: zara03, {far} windows")
    print(f"| people | parameters | {' | '.join(names)} |\n|---|---|---|---|---|")

    def line(shown: str, parameters: str, model: nav.crowd.Pedestrian | str) -> None:
        given = ((one, "first"), (one, "second"), (other, "all"))
        errors = [nav.crowd.prediction_errors(model, record, part=part) for record, part in given]  # type: ignore[arg-type]  # words of the table above
        print(f"| {shown} | {parameters} | {' | '.join(map(cells, errors))} |", flush=True)

    for word, shown in SHOWN.items():
        line(shown, "", word)
    for kind, chosen in FITTED.items():
        line(f"`{kind.__name__}`", "of the source", kind())
        found = nav.crowd.fit_people(kind(), one, chosen)
        values = ", ".join(f"`{name}` {value:.3g}" for name, value in found.values.items())
        line(f"`{kind.__name__}`", values, found.model)


def walked() -> None:
    """Print the fundamental diagram."""
    models = [(f"`{kind.__name__}`", kind()) for kind in FITTED]
    models.insert(1, ("`CollisionFreeSpeed(time_gap=0.5)`", nav.crowd.CollisionFreeSpeed(time_gap=0.5)))
    head = " | ".join(f"{density:g}" for density in DENSITIES)
    print(f"\n| people | {head} | rms |\n|{'---|' * (len(DENSITIES) + 2)}")
    reference = " | ".join(f"{speed:.2f}" for speed in nav.crowd.weidmann_speed(DENSITIES))
    print(f"| Weidmann 1993 | {reference} | |")
    for shown, model in models:
        worlds = [
            scenarios.corridor(
                round(density * LENGTH * WIDTH),
                length=LENGTH,
                width=WIDTH,
                two_way=False,
                model=model,
                radius=RADIUS,
                seed=seed,
                time_limit=LIMIT,
            )
            for density in DENSITIES
            for seed in range(SEEDS)
        ]
        found = nav.crowd.fundamental_diagram(worlds, width=WIDTH)
        speed, reference = (values.reshape(-1, SEEDS).mean(axis=1) for values in (found.speed, found.reference))
        rms = float(np.sqrt(np.mean((speed - reference) ** 2)))
        print(f"| {shown} | {' | '.join(f'{each:.2f}' for each in speed)} | {rms:.3f} |", flush=True)


def main() -> None:
    """Print the tables."""
    folder = os.environ.get("HRSAFETY_RECORDINGS")
    if folder:
        predicted(Path(folder))
    walked()


if __name__ == "__main__":
    main()
