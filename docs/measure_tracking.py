"""Print the tables of the tracking laws, or write them into the page on tracking.

``python docs/measure_tracking.py`` prints, ``--write`` replaces what stands between the two
marks of docs/theory/tracking.md.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety import navigation as nav
from page_tables import DOCS, print_or_write

Array = npt.NDArray[np.float64]

PAGE = DOCS / "theory" / "tracking.md"
MARKS = "tables of measure_tracking.py"
PERIODS = (0.06, 0.01)
MAX_SPEED = 0.7
STARTS, POSES = 2000, 10_000
MILLIMETER = 1e-3
LEVELS = (0.3, 0.1, 0.01, MILLIMETER, 1e-4)
SMALL = 1e-5
WIDE = nav.DifferentialDriveRobot(max_speed=50.0, max_acceleration=1e6, max_angular_acceleration=1e9, wheel_span=0.01)
LAWS: dict[str, nav.tracking.Tracking] = {
    "full speed": nav.tracking.FullSpeedTracking(),
    "nonlinear": nav.tracking.NonlinearTracking(),
}
PRINTED: dict[str, nav.tracking.Tracking] = {
    "nonlinear, printed turn rate": nav.tracking.NonlinearTracking(reference_turn="printed"),
    "nonlinear, printed axes": nav.tracking.NonlinearTracking(error_frame="world"),
    "nonlinear, both as printed": nav.tracking.NonlinearTracking(error_frame="world", reference_turn="printed"),
}


def table(head: Sequence[str], rows: Iterator[Sequence[str]]) -> list[str]:
    """Return a table in Markdown."""
    return [f"| {' | '.join(head)} |", "|---" * len(head) + "|", *(f"| {' | '.join(row)} |" for row in rows), ""]


def spectral_radius(law: nav.tracking.Tracking, speed: float, turn: float, period: float) -> float:
    """Return the largest modulus of the eigenvalues of one simulated period, from central differences."""
    reference: nav.tracking.Reference = nav.tracking.LineReference(start=(0.0, 0.0), velocity=(speed, 0.0))
    if turn:
        reference = nav.tracking.CircleReference(
            center=(0.0, speed / turn), radius=speed / turn, speed=speed, start_angle=-math.pi / 2
        )

    def after(state: Array) -> Array:
        run = nav.tracking.track(
            reference, law, position=-state[:2], heading=-state[2], speed=speed, turn_rate=turn, robot=WIDE,
            control_period=period, step=period, duration=period,
        )  # fmt: skip
        x, y = run.reference_position[-1] - run.position[-1]
        cos, sin = math.cos(turn * period), math.sin(turn * period)
        return np.array([cos * x + sin * y, cos * y - sin * x, turn * period - run.heading[-1]])

    columns = [(after(SMALL * unit) - after(-SMALL * unit)) / (2.0 * SMALL) for unit in np.eye(3)]
    return float(np.abs(np.linalg.eigvals(np.stack(columns, axis=1))).max())


def radii() -> list[str]:
    """Return spectral radii of the linearized period."""
    cases = [(speed, 0.0) for speed in (0.1, 0.3, 0.63, 0.7)] + [(0.3, 2.0), (0.3, 5.0), (0.3, 20.0)]

    def rows() -> Iterator[list[str]]:
        for name, law in LAWS.items():
            for period in PERIODS:
                yield [name, f"{period:g}", *(f"{spectral_radius(law, *case, period):.3f}" for case in cases)]

    head = ["law", "period (s)", *(f"{speed:g} m/s, {turn:g} rad/s" for speed, turn in cases)]
    return ["Spectral radius of one control period, by speed and turn rate of the reference.", "", *table(head, rows())]


def starts(count: int, reach: float, seed: int) -> Array:
    """Return starts within a square with any heading and motion."""
    top = np.array((reach, reach, math.pi, MAX_SPEED, 5.0))
    return np.random.default_rng(seed).uniform(-top, top, (count, 5))


def lines(count: int, low: float, high: float, seed: int) -> list[nav.tracking.Reference]:
    """Return references in any direction at shares of the largest speed."""
    generator = np.random.default_rng(seed)
    speed = MAX_SPEED * generator.uniform(low, high, count)
    angle = generator.uniform(-math.pi, math.pi, count)
    return [
        nav.tracking.LineReference(start=(0.0, 0.0), velocity=(v * math.cos(a), v * math.sin(a)))
        for v, a in zip(speed, angle, strict=True)
    ]


def convergence() -> list[str]:
    """Return shares of random starts that do not converge, and how long the others take."""
    spreads = ((0.1, 0.9), (0.9, 0.9), (1.0, 1.0))

    def rows() -> Iterator[list[str]]:
        for name, law in (LAWS | PRINTED).items():
            for period in PERIODS:
                cells = []
                for low, high in spreads:
                    found = nav.tracking.track_batch(
                        lines(STARTS, low, high, 2), law, starts=starts(STARTS, 2.0, 1), levels=(MILLIMETER,),
                        control_period=period, duration=120.0,
                    ).settling_time[:, 0]  # fmt: skip
                    failed = int(np.isnan(found).sum())
                    longest = "-" if failed == STARTS else f"{np.nanmax(found):.1f}"
                    cells += [str(failed), longest]
                yield [name, f"{period:g}", *cells]

    named = [f"{low:g} to {high:g} V" if low < high else f"{high:g} V" for low, high in spreads]
    head = ["law", "period (s)", *(f"{words}, {name}" for name in named for words in ("not", "longest (s)"))]
    words = f"Of {STARTS} starts: how many are not below 1 mm at 120 s, and the longest time of the others to be there"
    return [f"{words} for good, by the speed of the reference.", "", *table(head, rows())]


def curves() -> list[str]:
    """Return errors on a circle after a minute."""
    cases = [(0.2, 0.5), (0.4, 1.0), (0.6, 1.0), (0.6, 2.0)]

    def error(law: nav.tracking.Tracking, speed: float, radius: float, period: float) -> float:
        circle = nav.tracking.CircleReference(center=(0.0, 0.0), radius=radius, speed=speed)
        start: dict[str, Any] = {"position": (radius, 0.0), "heading": math.pi / 2, "turn_rate": speed / radius}
        run = nav.tracking.track(circle, law, speed=speed, control_period=period, duration=60.0, **start)
        return float(run.error[-1000:].max())

    def rows() -> Iterator[list[str]]:
        for name, law in (LAWS | PRINTED).items():
            for period in PERIODS:
                found = [1000.0 * error(law, *case, period) for case in cases]
                yield [name, f"{period:g}", *("< 0.001" if each < 1e-3 else f"{each:.3g}" for each in found)]

    head = ["law", "period (s)", *(f"{speed:g} m/s on {radius:g} m" for speed, radius in cases)]
    words = "Largest error (mm) in the last 10 s of a minute on a circle that begins on it."
    return [words, "", *table(head, rows())]


def goals() -> list[str]:
    """Return rates of the convergence to a goal."""

    def rows() -> Iterator[list[str]]:
        for heading in (None, 0.7):
            law = nav.tracking.ExponentialTracking(goal_heading=heading)
            for period in PERIODS:
                found = nav.tracking.track_batch(
                    nav.tracking.LineReference(start=(0.0, 0.0)), law, starts=starts(POSES, 5.0, 3), levels=LEVELS,
                    control_period=period, duration=60.0, goal=(0.0, 0.0),
                )  # fmt: skip
                with np.errstate(divide="ignore"):  # a start below both
                    rates = np.log(np.divide(LEVELS[:-1], LEVELS[1:])) / np.diff(found.settling_time, axis=1)
                final = f"{1e6 * found.final_error.max():.2f}"
                longest = f"{found.settling_time[:, 3].max():.1f}"
                least = [f"{rate:.2f}" for rate in rates.min(axis=0)]
                yield ["any" if heading is None else f"{heading:g} rad", f"{period:g}", *least, longest, final]

    spans = [f"{high:g} to {low:g} m" for high, low in itertools.pairwise(LEVELS)]
    head = ["heading at the goal", "period (s)", *spans, "longest to 1 mm (s)", "largest at 60 s (µm)"]
    words = f"Goal phase from {POSES} poses within 5 m: least rate (1/s) between two distances."
    return [words, "", *table(head, rows())]


def page() -> str:
    """Return the tables."""
    return "\n" + "\n".join([*radii(), *convergence(), *curves(), *goals()])


if __name__ == "__main__":
    print_or_write(PAGE, {"tables": (MARKS, page)})
