"""Own pictures for the figures of chapter 6: gain sets and stabilizing modes side by side.

The source draws its simulations beside its experiments. The experiment curves are not
available as numbers, so these pictures compare the two gain sets, and the stabilizing force
off and capped.
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety import navigation as nav
from hrsafety import plotting, scenarios
from hrsafety.pages import Picture
from hrsafety.reproduce.data import caption
from hrsafety.reproduce.measured import GAIN_SETS
from hrsafety.reproduce.names import GAIN_LABELS
from hrsafety.reproduce.ranking import BASELINE, Outcomes
from hrsafety.reproduce.study import MODES, NOISE_SCALE, SIDES, Key, LawComparisons

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["captioned", "make", "of_study", "picture"]

DOTS_PER_INCH = 120
SCENES = {
    "c1": "a stationary disc",
    "c2": "a person who comes the other way",
    "c3": "a disc and a rectangle",
    "c4": "a person, a disc and a rectangle",
}

STILL = ("c1", "c3")  # configurations without people: nothing is ever touched
COMPARED_MODES = ("off", "capped, 10 N", "capped, 0.1 m|V|/T_s")
# Numbers of the source's figures: paths and distances with several laws, and of the new law alone.
PATHS = {"c1": ("6.4", "6.6"), "c2": ("6.8", "6.8"), "c3": ("6.10", "6.13"), "c4": ("6.15", "6.17")}
DISTANCES = {"c1": ("6.5", "6.7"), "c2": ("6.9", "6.9"), "c3": ("6.11", "6.14"), "c4": ("6.16", "6.18")}


def make() -> list[Picture]:
    """Draw every picture."""
    return [picture(name, caption, draw()) for name, caption, draw in _pictures()]


def of_study(study: LawComparisons) -> list[Picture]:
    """Draw outcomes and clearances of the experiments with many runs."""
    pictures = []
    side = next(iter(SIDES))
    for experiment in dict.fromkeys(key.experiment for key in study.runs):
        groups = {
            f"{GAIN_LABELS[gains]}, {mode}": study.runs[Key(experiment, side, gains, mode)]
            for gains in GAIN_SETS
            for mode in MODES
        }
        runs = len(groups[f"{GAIN_LABELS['new_vff']}, {BASELINE}"].outcome)
        if runs == 1 or experiment.startswith(STILL):
            continue
        name = re.sub(r"[^a-z0-9]+", "-", experiment)
        words = f"{runs} runs, {experiment.replace('+-', '±')}"
        pictures.append(captioned(f"outcomes-{name}", _outcomes(groups), key="outcomes", words=words))
        for gains, label in GAIN_LABELS.items() if experiment.startswith("crowds") else ():
            drawn = plotting.clearances(
                {mode: study.runs[Key(experiment, side, gains, mode)].clearance for mode in MODES}
            )
            pictures.append(
                captioned(
                    f"clearances-{name}-{gains.replace('_', '-')}", drawn, key="clearances", label=label, words=words
                )
            )
    return pictures


def _outcomes(groups: Mapping[str, Outcomes]) -> Figure:
    return plotting.outcomes(
        {name: own.outcome for name, own in groups.items()},
        contacts_moving={name: own.moving.astype(np.int64) for name, own in groups.items()},
        contacts_standing={name: own.standing.astype(np.int64) for name, own in groups.items()},
    )


def captioned(name: str, figure: Figure, /, *, key: str = "", **words: object) -> Picture:
    """Return a figure as a picture with its caption of ``data/captions.toml``, by its name or another key."""
    return picture(name, caption(key or name, **words), figure)


def picture(name: str, caption: str, figure: Figure) -> Picture:
    """Return a figure as a picture of the page."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from PIL import Image  # comes with matplotlib

    # `savefig` draws twice, once for the layout alone, and packs pixels that are unpacked here again.
    figure.set_dpi(DOTS_PER_INCH)
    canvas: Any = FigureCanvasAgg(figure)  # matplotlib types it in part
    content = io.BytesIO()
    canvas.draw()
    drawn = Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
    # A palette makes a page of forty pictures small enough for a phone.
    drawn.quantize(256, dither=Image.Dither.NONE).save(content, format="png", optimize=True)
    return Picture(name=name, caption=caption, png=content.getvalue())


Drawing = tuple[str, str, Callable[[], "Figure"]]


def _law(gains: str, mode: str = "off") -> nav.VirtualForceField:
    parameters: dict[str, Any] = dict(zip(nav.VirtualForceField.GAIN_NAMES, GAIN_SETS[gains], strict=True))
    return nav.VirtualForceField(**parameters, **MODES[mode])


def _pictures() -> Iterator[Drawing]:
    """Yield name, caption and drawing function of every picture."""
    for name, words in SCENES.items():
        yield (
            f"figure-6.3-{name}",
            caption("layout", number=name[1], scene=words),
            partial(plotting.layout, scenarios.configuration(name)),
        )
    for name, words in SCENES.items():
        yield from _gain_sets(name, words)
        yield from _modes(name, words)
        if name == "c2":
            yield _measured_speed()
        if name == "c3":
            yield _valley()
    yield from _more()


def paths_and_distances(
    runs: Sequence[nav.Trajectory],
    *,
    labels: Sequence[str],
    numbers: tuple[str, str],
    name: str,
    where: str,
    whose: str = "",
    relation: str = "as",
) -> Iterator[Drawing]:
    """Yield paths and distances of runs through one scene."""
    paths, distances = numbers
    yield (
        f"figure-{paths}-paths-{name}",
        caption("paths", whose=whose, relation=relation, figure=paths, where=where),
        partial(plotting.paths, runs, labels=labels),
    )
    yield (
        f"figure-{distances}-distances-{name}",
        caption("distances", relation=relation, figure=distances, where=where),
        partial(plotting.distances, runs, labels=labels),
    )


def _gain_sets(name: str, words: str) -> Iterator[Drawing]:
    """Yield paths and distances with both gain sets."""
    scenario = scenarios.configuration(name)
    runs = [nav.simulate(scenario, _law(gains)) for gains in GAIN_SETS]
    labels = [GAIN_LABELS[gains] for gains in GAIN_SETS]
    where = f"configuration {name[1]}, {words}; gains as in Table 6.1 and optimized (*), stabilizing force off"
    yield from paths_and_distances(
        runs, labels=labels, numbers=(PATHS[name][0], DISTANCES[name][0]), name=f"{name}-gains", where=where
    )


def _modes(name: str, words: str) -> Iterator[Drawing]:
    """Yield paths and distances with the stabilizing force off and capped."""
    scenario = scenarios.configuration(name)
    runs = [nav.simulate(scenario, _law("new_vff", mode)) for mode in COMPARED_MODES]
    where = f"configuration {name[1]}, {words}; New VFF, stabilizing force off and capped"
    if name == "c4":
        where += " (lines of decreasing width, because the paths lie on each other)"
    yield from paths_and_distances(
        runs,
        labels=COMPARED_MODES,
        numbers=(PATHS[name][1], DISTANCES[name][1]),
        name=f"{name}-stabilizing",
        where=where,
        relation="in place of",
    )


def _valley() -> Drawing:
    """Return the repulsive force between the two obstacles of configuration 3."""
    scenario = scenarios.configuration("c3")
    x, y = np.meshgrid(np.linspace(0.6, 4.0, 137), np.linspace(-1.3, 2.4, 149))
    field = nav.laws.force_field(
        _law("new_vff"), scenario, position=np.column_stack([x.ravel(), y.ravel()]), velocity=(-0.7, 0.0)
    )
    return (
        "figure-6.12-valley",
        caption("figure-6.12-valley"),
        partial(plotting.potential_valley, field, scenario, term="repulsive"),
    )


def _measured_speed() -> Drawing:
    """Return the speed of the walking person as a camera would measure it."""
    scenario = scenarios.configuration("c2")
    run = nav.simulate(scenario, _law("new_vff"))

    def draw() -> Figure:
        periods = np.arange(0.0, run.time[-1], scenario.control_period)
        true = np.interp(periods, run.time, run.obstacle_position[:, 0, 0])
        error = np.random.default_rng(scenario.seed).uniform(-NOISE_SCALE, NOISE_SCALE, len(periods))
        measured = np.diff(true + error) / scenario.control_period
        return _speed_figure(periods[1:], measured, np.diff(true) / scenario.control_period)

    return "figure-6.9-measured-speed", caption("figure-6.9-measured-speed"), draw


def _speed_figure(time: np.ndarray, measured: np.ndarray, true: np.ndarray) -> Figure:
    """Draw measured and true velocity over time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    axes = figure.subplots()
    axes.step(time, measured, where="pre", color="#D55E00", linewidth=1.0, label="measured")
    axes.step(time, true, where="pre", color="black", linewidth=1.8, label="true")
    axes.set_xlabel("time (s)")
    axes.set_ylabel("velocity of the person along x (m/s)")
    axes.set_xlim(0.0, float(time[-1]))
    axes.grid(color="#E3E3E3", linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)
    figure.legend(frameon=False, loc="outside lower center", ncols=2)
    return figure


def _more() -> Iterator[Drawing]:
    """Yield what the source describes in words: sequences, energy, Lyapunov function."""
    for name in ("c2", "c4"):
        run = nav.simulate(scenarios.configuration(name), _law("new_vff"))
        yield (
            f"sequence-{name}",
            caption("sequence", number=name[1]),
            partial(plotting.time_sequence, run),
        )
    for name, words in SCENES.items():
        scenario = scenarios.configuration(name)
        runs = [nav.simulate(scenario, _law("new_vff", mode)) for mode in COMPARED_MODES]
        yield (
            f"lyapunov-{name}",
            caption("lyapunov", number=name[1], scene=words),
            partial(plotting.lyapunov, runs, labels=COMPARED_MODES),
        )
    for name in ("c1", "c4"):
        scenario = scenarios.configuration(name)
        both = [nav.simulate(scenario, _law(gains)) for gains in GAIN_SETS]
        yield (
            f"energy-{name}",
            caption("energy", number=name[1]),
            partial(plotting.energy, both, labels=[GAIN_LABELS[gains] for gains in GAIN_SETS]),
        )
