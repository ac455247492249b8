"""Own pictures for Figures 7.3 to 7.14 and F.1 to F.4: both robots, and how far runs spread."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from hrsafety import navigation as nav
from hrsafety import plotting, scenarios
from hrsafety.pages import Picture
from hrsafety.reproduce.built.runs import LAW, SEEDS, as_built, repeated, scene, score
from hrsafety.reproduce.data import caption
from hrsafety.reproduce.figures import Drawing, paths_and_distances, picture

__all__ = ["make"]

_ROBOTS = ("two wheels", "three omni-wheels")
_SCENES = {
    "n1": ("7.3", "7.4", "a stationary disc"),
    "n2": ("7.6", "7.7", "a person who comes the other way"),
    "n3": ("7.8", "7.9", "a disc and a rectangle"),
    "n4": ("7.10", "7.11", "a person, a disc and a rectangle"),
}
_SPREAD = {"c1": ("F.1", "F.2", "three omni-wheels"), "n1": ("F.3", "F.4", "two wheels")}
_INSTANTS = (0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0)


def make() -> list[Picture]:
    """Draw every picture."""
    return [picture(name, caption, draw()) for name, caption, draw in _pictures()]


def _pictures() -> Iterator[Drawing]:
    """Yield name, caption and drawing function of every picture."""
    for name in _SCENES:
        yield from _both_robots(name)
    yield from _multiple()
    for name in _SPREAD:
        yield from _spread(name)


def _both_robots(name: str) -> Iterator[Drawing]:
    """Yield paths and distances of both robots, and for n1 their energies."""
    paths, distances, words = _SCENES[name]
    runs = [score(name).trajectory, nav.simulate(scenarios.configuration(name), LAW)]
    where = f"configuration {name[1]} of chapter 7, {words}; New VFF, ideal wheels"
    yield from paths_and_distances(
        runs,
        labels=_ROBOTS,
        numbers=(paths, distances),
        name=name,
        where=where,
        whose=" of the two-wheel and of the holonomic robot",
    )
    if name == "n1":
        yield (
            "figure-7.5-energy-n1",
            caption("figure-7.5-energy-n1", where=where),
            partial(plotting.energy, runs, labels=_ROBOTS),
        )


def _multiple() -> Iterator[Drawing]:
    """Yield layout, sequence and distances of section 7.5.5."""
    run = score("multiple_obstacles").trajectory
    where = "a person, a disc and another robot (section 7.5.5)"
    yield (
        "figure-7.12-layout-multiple",
        caption("figure-7.12-layout-multiple", where=where),
        partial(plotting.layout, scene("multiple_obstacles")),
    )
    instants = [time for time in _INSTANTS if time < run.time[-1]]
    yield (
        "figure-7.13-sequence-multiple",
        caption("figure-7.13-sequence-multiple", where=where),
        partial(plotting.time_sequence, run, instants=[*instants, float(run.time[-1])]),
    )
    yield (
        "figure-7.14-distances-multiple",
        caption("figure-7.14-distances-multiple", where=where),
        partial(plotting.distances, run),
    )


def _spread(name: str) -> Iterator[Drawing]:
    """Yield the spread of paths and distances over many noisy runs."""
    paths, distances, words = _SPREAD[name]
    runs = repeated(name)
    scenario = scene(name)
    exact = nav.simulate(scenario, LAW, built=nav.robots.AsBuilt(wheels=as_built(scenario).wheels))
    where = (
        f"{SEEDS} runs of configuration {name[1]} with {words} as built and a camera with a mean error of 4 mm; dashed "
        "is the run without errors of measurement. Where robot, obstacle and goal lie on one line, the errors decide "
        "the side, and the band holds both"
    )
    yield (
        f"figure-{paths}-spread-paths-{name}",
        caption("spread-paths", figure=paths, where=where),
        partial(plotting.repeated_paths, runs, exact=exact),
    )
    yield (
        f"figure-{distances}-spread-distances-{name}",
        caption("spread-distances", figure=distances, where=where),
        partial(plotting.repeated_distances, runs, exact=exact),
    )
