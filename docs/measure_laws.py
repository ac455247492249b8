"""Print the comparison of all laws, or write it into the page on validation.

``python docs/measure_laws.py`` prints, ``--write`` replaces what stands between the marks of
docs/validation.md. ``--only comparison`` is the comparison with exact sensing, an hour on two cores, most of
it for the tuned random tree; ``--only shares``, which takes the tuned parameters from the page, is what
noise and delay make of the shares of contacts (measure_shares.py). Only the cost of a control step
depends on the machine. What is under way is told on the standard error.
"""

from __future__ import annotations

import functools
import math
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

import measure_shares
from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.navigation.metrics import Mean
from page_tables import DOCS, head, line, percent, print_or_write

MARKS = "tables of measure_laws.py"

NEW = "New field"
LAWS: dict[str, nav.Law] = {
    NEW: nav.VirtualForceField(),
    "Khatib": nav.Khatib(),
    "Borenstein & Koren": nav.BorensteinKoren(),
    "Masoud": nav.Masoud(),
    "Ge & Cui": nav.GeCui(),
    "Velocity obstacle": nav.VelocityObstacle(),
    "ORCA": nav.OptimalReciprocalCollisionAvoidance(),
    "Extended RRT": nav.RapidlyExploringRandomTree(),
    "Field D*": nav.FieldDStar(),
}
ABLATIONS: dict[str, nav.Law] = {
    f"{NEW}, without detour": nav.VirtualForceField(detour_gain=0.0),
    f"{NEW}, without repulsive": nav.VirtualForceField(repulsive_gain=0.0),
    f"{NEW}, without stabilizing": nav.VirtualForceField(stabilizing="off"),
}
# The source names no parameters for these: the search of its appendix C over these configurations,
# for a random tree over several draws of each. What breaks a symmetry or does not act with the default
# selection of velocities is not searched; what a grid would take an hour for is left to CMA-ES.
CONFIGURATIONS = ("c1", "c2", "c4")
TREE_DRAWS = range(8)
HELD: dict[str, dict[str, tuple[float, float]]] = {
    "Velocity obstacle": {"risk_weight": (1.0, 1.0), "sector": (1.0, 1.0)},
    "ORCA": {"turn": (0.01, 0.01)},
}
# Evaluations of the search over the configurations; 0: the grids of the source.
SEARCHED = {
    "Khatib": 0,
    "Borenstein & Koren": 0,
    "Velocity obstacle": 0,
    "ORCA": 0,
    "Extended RRT": 1000,
    "Field D*": 2000,
}
EVALUATIONS = 200
CROWDS = (3, 12)
TRAINING = range(1_000_000, 1_000_004)
TEST = range(1000)
SCENES = ("c1", "c2", "c3", "c4", "parallel_human", "unpredictable_human")
DRAWS = range(20)
TIMED, REPEATS = 8, 3
Tuned = tuple[nav.Law, float, float]


def say(*words: object) -> None:
    """Tell what is under way."""
    print(time.strftime("%H:%M:%S"), *words, file=sys.stderr, flush=True)


def parameters(law: nav.Law, names: Sequence[str]) -> str:
    """Return parameters by name."""
    return ", ".join(f"{name} {getattr(law, name):.4g}" for name in names)


def traffic(obstacles: int, seeds: range) -> list[nav.Scenario]:
    """Return random crossing obstacles, one scene for each seed."""
    return [scenarios.random_traffic(obstacles, seed=seed) for seed in seeds]


def source_search(name: str) -> nav.GainSearch:
    """Return the search of appendix C for a law whose parameters the source does not give."""
    law, evaluations = LAWS[name], SEARCHED[name]
    draws = TREE_DRAWS if isinstance(law, nav.RapidlyExploringRandomTree) else range(1)
    scenes = [replace(scenarios.configuration(each), seed=seed) for each in CONFIGURATIONS for seed in draws]
    bounds = HELD.get(name)
    if evaluations == 0:
        return nav.optimize_gains(scenes, law, bounds=bounds, threads=1)
    return nav.optimize_gains(scenes, law, bounds=bounds, method="cma_es", evaluations=evaluations, seed=0, threads=1)


def source_searches() -> dict[str, nav.GainSearch]:
    """Return all these searches, two at a time."""
    with ThreadPoolExecutor(2) as pool:
        return dict(zip(SEARCHED, pool.map(source_search, SEARCHED), strict=True))


def varied(name: str) -> list[str]:
    """Return the parameters of a law that are searched."""
    law = LAWS[name]
    bounds = dict(law.GAIN_BOUNDS) | HELD.get(name, {})
    return [gain for gain in law.GAIN_NAMES if bounds[gain][0] < bounds[gain][1]]


def searched_how(name: str, search: nav.GainSearch) -> str:
    """Return the grid of a search, or that it had none."""
    if SEARCHED[name]:
        return "CMA-ES"
    names = LAWS[name].GAIN_NAMES
    sizes = dict(zip(names, search.settings.grid, strict=True))
    return f"{len(search.grids)} of {' x '.join(str(sizes[gain]) for gain in varied(name))}"


def source_table(searches: dict[str, nav.GainSearch]) -> Iterator[str]:
    """Yield what the search of appendix C finds for them."""
    yield from head("", "grid", "gain sets", "best found", "H c1, c2, c4", "mean H", "each alone, at most 1 % less")
    for name, search in searches.items():
        flat = search.flatness()
        spans = dict(zip(flat.gain_names, zip(flat.low, flat.high, strict=True), strict=True))
        scores = np.reshape(search.best_performance, (len(CONFIGURATIONS), -1)).mean(axis=1)
        yield line(
            name,
            searched_how(name, search),
            f"{search.evaluations:,}",
            parameters(search.best, varied(name)),
            ", ".join(f"{score:.3f}" for score in scores),
            f"{search.best_value:.4f}",
            ", ".join(f"{gain} {spans[gain][0]:.3g} to {spans[gain][1]:.3g}" for gain in varied(name)),
        )
    yield ""


def tuned() -> dict[str, Tuned]:
    """Return the laws tuned with the same budget, two at a time."""
    with ThreadPoolExecutor(2) as pool:
        return dict(zip(LAWS, pool.map(tune, LAWS), strict=True))


def tune(name: str) -> Tuned:
    """Return a law tuned, with its mean H in training before and after."""
    scenes = [scene for obstacles in CROWDS for scene in traffic(obstacles, TRAINING)]
    law = LAWS[name]
    before = float(nav.simulate_batch(scenes, law, stop_on_contact=True, threads=1).performance_total.mean())
    search = nav.optimize_gains(
        scenes, law, method="cma_es", evaluations=EVALUATIONS, bounds=HELD.get(name), seed=0, threads=1
    )
    say("tuned", name)
    # Nobody would give up defaults for something worse.
    return (search.best, before, search.best_value) if search.best_value > before else (law, before, before)


def tuned_table(found: dict[str, Tuned]) -> Iterator[str]:
    """Yield the tuned parameters."""
    yield from head("", "tuned", "mean H in training, default", "tuned")
    for name, (law, before, after) in found.items():
        yield line(name, parameters(law, varied(name)), f"{before:.4f}", f"{after:.4f}")
    yield ""


def outcome(result: nav.Comparison, row: int, runs: np.ndarray) -> str:
    """Return time, clearance and H of one law in one scene, or what went wrong."""
    ends = result.outcome[row, runs]
    arrived = ends == "arrived"
    words = ""
    for end, shown in (("collided", "contact"), ("timed_out", "timed out"), ("stopped", "stopped")):
        count = int((ends == end).sum())
        if count == len(ends):
            return shown
        words += f", {shown} in {count} of {len(ends)}" if count else ""
    values = (each[row, runs] for each in (result.arrival_time, result.min_clearance, result.performance_total))
    seconds, clearance, score = values
    return f"{seconds[arrived].mean():.2f}; {clearance[arrived].mean():.3f}; {score.mean():.3f}{words}"


def scene_table(laws: dict[str, nav.Law]) -> Iterator[str]:
    """Yield every law in the scenes of the source."""
    say("scenes of the source")
    result = nav.compare({name: scenarios.configuration(name) for name in SCENES}, laws, seeds=DRAWS)
    yield from head("", *(name.replace("_human", " person") for name in SCENES))
    for row, name in enumerate(laws):
        yield line(name, *(outcome(result, row, result.scenario == index) for index in range(len(SCENES))))
    yield ""


def shown(mean: Mean, digits: int) -> str:
    """Return a mean with its interval."""
    if math.isnan(mean.value):
        return "-"
    return f"{mean.value:.{digits}f} ({mean.low:.{digits}f} to {mean.high:.{digits}f})"


def cost(law: nav.Law, scenes: Sequence[nav.Scenario]) -> float:
    """Return microseconds of one core for a control step: the least of some timed batches."""
    best = math.inf
    for _ in range(REPEATS):
        begin = time.process_time()
        steps = int(nav.simulate_batch(scenes, law, threads=1).force_evaluations.sum())
        best = min(best, (time.process_time() - begin) / steps)
    return 1e6 * best


def crowds(laws: dict[str, nav.Law], obstacles: int) -> nav.Comparison:
    """Return all laws among the same random obstacles."""
    scenes = {str(seed): scene for seed, scene in zip(TEST, traffic(obstacles, TEST), strict=True)}
    return nav.compare(scenes, laws, progress=lambda done, runs: say("crowds of", obstacles, "-", done, "of", runs))


def crowd_table(laws: dict[str, nav.Law], result: nav.Comparison, obstacles: int) -> Iterator[str]:
    """Yield shares and means of every law among random obstacles."""
    timed = traffic(obstacles, TEST[:TIMED])
    kinds = ("success (%)", "contact (%)", "moving toward (%)", "moving away (%)")
    yield from head("", "runs", *kinds, "T (s)", "clearance (m)", "E (J)", "H", "step (µs)")
    for name in laws:
        each = result.standing(name)
        found = (each.success, each.contact, each.toward_contact, each.away_contact)
        yield line(
            name,
            each.success.runs,
            *(percent(share.count, share.runs) for share in found),
            shown(each.arrival_time, 2),
            shown(each.min_clearance, 3),
            shown(each.energy, 2),
            shown(each.performance_total, 3),
            f"{cost(laws[name], timed):.2f}",
        )
    yield ""


def paired_table(laws: dict[str, nav.Law], results: Sequence[nav.Comparison]) -> Iterator[str]:
    """Yield each law beside the new field with its own kind of parameters, episode by episode."""
    titles = [title for n in CROWDS for title in (f"contacts, {n}", f"p, {n}", f"difference of H, {n}")]
    yield from head("", *titles)
    for name in laws:
        other = f"{NEW}, tuned" if name.endswith(", tuned") else NEW
        if name == other:
            continue
        cells = []
        for result in results:
            touched = result.contacts_compared(name, other)
            chance = f"{touched.p_value:.1g}" if touched.p_value >= 1e-4 else "< 1e-4"
            cells += [f"{touched.only_first} : {touched.only_second}", chance, shown(result.difference(name, other), 3)]
        yield line(name, *cells)
    yield ""


def page() -> str:
    """Return the tables."""
    begin = time.monotonic()
    say("search of appendix C")
    searches = source_searches()
    found = tuned()
    laws = LAWS | ABLATIONS
    laws |= {f"{name}, tuned": law for name, (law, _, _) in found.items()}
    results = [crowds(laws, obstacles) for obstacles in CROWDS]
    parts = [
        (
            "Search of appendix C for the laws whose gains the source does not give.",
            source_table(searches),
        ),
        (f"Parameters after {EVALUATIONS} evaluations of CMA-ES, the same for every law.", tuned_table(found)),
        ("Scenes of the source: T (s); least clearance of the surfaces (m); H.", scene_table(laws)),
    ]
    for obstacles, result in zip(CROWDS, results, strict=True):
        words = f"Crowds of {obstacles}: shares and means with 95 % intervals."
        parts.append((words, crowd_table(laws, result, obstacles)))
    words = "Each law beside the new field, default beside default and tuned beside tuned, in the same episodes."
    parts.append((words, paired_table(laws, results)))
    lines = [entry for words, rows in parts for entry in (words, "", *rows)]
    say(f"{(time.monotonic() - begin) / 60:.1f} minutes")
    return "\n" + "\n".join(lines) + "\n"


if __name__ == "__main__":
    shares = functools.partial(measure_shares.tables, LAWS, ABLATIONS, say)
    print_or_write(DOCS / "validation.md", {"comparison": (MARKS, page), "shares": (measure_shares.MARKS, shares)})
