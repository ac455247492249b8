"""Every picture of the package can be read: labels, legends, views, units."""

from __future__ import annotations

import dataclasses
import doctest
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

matplotlib = pytest.importorskip("matplotlib")

from api import namespaces  # noqa: E402  # needs the check above
from api.namespaces import public  # noqa: E402  # needs the check above
from hrsafety import impact, plotting, reactive, scenarios, sweep  # noqa: E402  # needs the check above
from hrsafety import navigation as nav  # noqa: E402  # needs the check above
from hrsafety.plausibility import ResultWarning  # noqa: E402  # needs the check above
from hrsafety.plotting import labels, notes, style  # noqa: E402  # needs the check above
from pictures import assert_readable, box_of, laid_out, legends_of, struck_labels  # noqa: E402  # needs the check above

DOUBT = ResultWarning("implausible", "heading", "heading is 90 rad, outside the plausible -6.28 to 6.28 rad")
LAW = nav.VirtualForceField()
BEST = nav.VirtualForceField(
    attractive_gain=4.3, repulsive_gain=20.3, detour_gain=240.7, gain_ratio=0.68, stabilizing="off"
)
WALLS = (
    nav.Rectangle(center=(2.0, 6.0), length=6.0, width=0.2),
    nav.Rectangle(center=(2.0, -6.0), length=6.0, width=0.2),
    nav.Disc(center=(2.0, 0.3), radius=0.2),
)


def walled() -> nav.Scenario:
    """Two walls far from the way, and a disc on it."""
    return nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), obstacles=WALLS)


def run_through(name: str, law: nav.Law = LAW) -> nav.Trajectory:
    return nav.simulate(scenarios.configuration(name), law)


def same_paths() -> Any:
    runs = [run_through("c4", dataclasses.replace(LAW, stabilizing=mode)) for mode in ("off", "capped")]
    return plotting.paths(runs, labels=["off", "capped"])


def crowded() -> nav.Trajectory:
    return nav.simulate(scenarios.random_crowd(12, seed=3), LAW)


def boundaries(manipulator: impact.Manipulator) -> Any:
    design = impact.design_foam(manipulator, impact.FoamLimits(), closing_speed=1.25)
    damping = np.linspace(0.0, 345.0, 60)
    foams = {"Foam 1": impact.FOAM_1, "Foam 2": impact.FOAM_2, "Foam 3": impact.FOAM_3}
    verdicts = {name: design.accepts(foam) for name, foam in foams.items()}
    return plotting.foam_boundaries(
        damping, design.upper(damping), design.lower(damping), foams=foams, accepted=verdicts
    )


def foam_map() -> Any:
    damping, stiffness = np.linspace(0.0, 200.0, 21), np.linspace(5e3, 70e3, 21)
    head = impact.Head.minimum()
    loads = impact.metrics_batch(
        manipulator=impact.MANIPULATOR_2,
        head=head,
        closing_speed=1.25,
        foam_stiffness=stiffness[:, None],
        foam_damping=damping,
    )
    foams = {"Foam 1": impact.FOAM_1, "Foam 2": impact.FOAM_2, "at the edge": impact.Foam(stiffness=7e4, damping=200.0)}
    acceleration = loads.peak_head_acceleration_g
    return plotting.foam_map(damping, stiffness, acceleration, quantity="peak (g)", limit=6.0, foams=foams)


def bump(foam: impact.Foam = impact.FOAM_1, head: impact.Head | None = None) -> impact.ImpactResponse:
    return impact.simulate(impact.MANIPULATOR_2, foam, head or impact.Head.minimum(), closing_speed=1.25, step=1e-4)


def histories() -> Any:
    foams = (impact.FOAM_1, impact.FOAM_3)
    limits = {"head_acceleration": 10.0}
    return plotting.impact_histories([bump(foam) for foam in foams], labels=["1", "3"], peaks=(0, 1), limits=limits)


def measured() -> Any:
    response = bump(head=impact.Head.apparatus())
    return plotting.measured_impact(
        response, peak_head_acceleration_g=[6.0, 6.2], impact_duration=[0.04, 0.05], max_compression=[0.011, 0.012]
    )


def followers(kind: str, seed: int) -> Any:
    scene = reactive.FollowerLayouts(kind=kind).scene(seed)  # type: ignore[arg-type]  # words of a list
    laws = {form: reactive.VirtualImpedance(form=form) for form in ("conventional", "active")}  # type: ignore[arg-type]  # words
    return plotting.reactive.follower_runs(
        {name: reactive.follow(scene, law=law, seed=seed) for name, law in laws.items()}
    )


def sweep_of(axes: int) -> sweep.SweepResult:
    ends = {"detour_gain": (10.0, 250.0), "gain_ratio": (0.2, 0.8), "attractive_gain": (2.0, 8.0)}
    varying = [sweep.Axis(name=name, low=low, high=high) for name, (low, high) in list(ends.items())[:axes]]
    return sweep.run(sweep.Sobol(varying, 16), sweep.NavigationStudy(scenarios=scenarios.configuration("c1")))


def grid_map() -> Any:
    design = sweep.Grid(
        [
            sweep.Axis(name="foam_stiffness", low=5e3, high=60e3, points=6),
            sweep.Axis(name="foam_damping", low=0.0, high=150.0, points=5),
        ]
    )
    study = sweep.ImpactStudy(
        manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), fixed={"closing_speed": 1.25}
    )
    return plotting.sweep_map(sweep.run(design, study), "hic15")


def several_laws(scene: nav.Scenario) -> dict[str, nav.Trajectory]:
    laws = {"field": LAW, "Masoud": nav.Masoud(), "ORCA": nav.OptimalReciprocalCollisionAvoidance()}
    return {name: nav.simulate(scene, law) for name, law in laws.items()}


def field_of(name: str) -> tuple[nav.laws.ForceField, nav.Scenario]:
    scene = scenarios.configuration(name)
    x, y = np.meshgrid(np.linspace(0.5, 4.0, 36), np.linspace(-1.3, 2.4, 38))
    return nav.laws.force_field(LAW, scene, position=np.column_stack([x.ravel(), y.ravel()])), scene


def sensitivity() -> Any:
    return plotting.gain_sensitivity(
        nav.gain_sensitivity([scenarios.configuration(c) for c in ("c1", "c2", "c3")], BEST)
    )


def searched() -> nav.GainSearch:
    return nav.optimize_gains(
        [scenarios.configuration("c1")], grid=(3, 3, 3, 3), refinements=1, survivors=5, local_starts=2
    )


def flat() -> Any:
    return plotting.flatness(searched().flatness(5), marks={"published": ((4.3, 20.3, 240.7, 0.68), 0.706)})


def noisy() -> nav.RunTable:
    scene = dataclasses.replace(scenarios.configuration("c2"), measurement=nav.Measurement())
    return nav.simulate_many(scene, nav.VirtualForceField(side_hysteresis=3.0), seeds=20, paths=True)


def wheels() -> Any:
    tests = nav.robots.open_loop_tests(nav.robots.HOLONOMIC_WHEELS[0])
    return plotting.robots.wheel_identification(tests, nav.robots.identify_wheel(tests))


def fixes() -> Any:
    row = reactive.MicrophoneArray()
    delay_12, delay_13 = row.delays(range=[2.0, 3.0], bearing=0.5)
    truth = [reactive.locate(row, delay_12=a, delay_13=b) for a, b in zip(delay_12, delay_13, strict=True)]
    return plotting.reactive.sound_fixes(reactive.sound.jittered_fixes(row, range=[2.0, 3.0], bearing=0.5), truth)


def rates() -> Any:
    laws = ("conventional", "active")
    found = {law: reactive.experiment("one_dynamic", law, layouts=50).collision_rate for law in laws}  # type: ignore[arg-type]  # words
    return plotting.reactive.follower_rates({"one moving box": found}, marks={"one moving box": {"active": 0.3}})


PICTURES: dict[str, Callable[[], Any]] = {
    "layout": lambda: plotting.layout(scenarios.configuration("c4")),
    "paths": lambda: plotting.paths([run_through("c4"), run_through("c4", BEST)], labels=["New", "New*"]),
    "paths on each other": same_paths,
    "paths in a crowd": lambda: plotting.paths(crowded(), regions=False),
    "paths between walls": lambda: plotting.paths(nav.simulate(walled(), LAW)),
    "time sequence": lambda: plotting.time_sequence(run_through("c4")),
    "distances": lambda: plotting.distances([run_through("c4"), run_through("c4", BEST)]),
    "distances in a crowd": lambda: plotting.distances(crowded()),
    "energy": lambda: plotting.energy([run_through("c4"), run_through("c4", BEST)]),
    "lyapunov": lambda: plotting.lyapunov([run_through("c1"), run_through("c1", BEST)]),
    "force field": lambda: plotting.force_field(*field_of("c3")),
    "valley": lambda: plotting.potential_valley(*field_of("c3"), term="repulsive"),
    "clearances": lambda: plotting.clearances({"off": [0.1, -0.1, 0.4], "on": [0.0, 0.05, 0.3]}),
    "outcomes": lambda: plotting.outcomes({"off": ["arrived", "stopped", "collided"]}),
    "comparison paths": lambda: plotting.comparison_paths(several_laws(scenarios.configuration("unpredictable_human"))),
    "comparison distances": lambda: plotting.comparison_distances(several_laws(scenarios.configuration("c2"))),
    "comparison sequence": lambda: plotting.comparison_sequence(
        several_laws(scenarios.configuration("c4")), [1.0, 2.0]
    ),
    "repeated paths": lambda: plotting.repeated_paths(noisy()),
    "repeated distances": lambda: plotting.repeated_distances(noisy()),
    "boundaries of manipulator 1": lambda: boundaries(impact.MANIPULATOR_1),
    "boundaries of manipulator 2": lambda: boundaries(impact.MANIPULATOR_2),
    "foam map": foam_map,
    "histories": histories,
    "measured": measured,
    "study": lambda: plotting.impact_study(
        [5.0, 10.0, 20.0],
        {"Foam 1": [5.9, 6.6, 7.1]},
        parameter="mass (kg)",
        limit=10.0,
        marks={"largest": (20.0, 7.1), "on the curve": (10.0, 6.6)},
    ),
    "gain sensitivity": sensitivity,
    "flatness": flat,
    "search history": lambda: plotting.search_history(searched()),
    "follower among standing boxes": lambda: followers("static", 3),
    "follower and one box": lambda: followers("one_dynamic", 3),
    "follower and two boxes": lambda: followers("two_dynamic", 3),
    "follower rates": rates,
    "impedance forces": lambda: plotting.reactive.impedance_forces({"active": reactive.VirtualImpedance()}),
    "skirt ring": lambda: plotting.reactive.skirt_ring(
        reactive.UltrasonicSkirt(), directions=reactive.skirt.MOTION_DIRECTIONS
    ),
    "skirt runs": lambda: plotting.reactive.skirt_runs({"to the north": reactive.skirt_run(direction="N")}),
    "skirt clearances": lambda: plotting.reactive.skirt_clearances(
        {"ideal": reactive.skirt_test(layouts=2)}, printed=0.775
    ),
    "sound fixes": fixes,
    "sweep parallel": lambda: plotting.sweep_parallel(sweep_of(3), "performance_total"),
    "sweep scatter": lambda: plotting.sweep_scatter(sweep_of(2), "performance_total"),
    "sweep map": grid_map,
    "wheel identification": wheels,
}


@pytest.mark.parametrize("name", PICTURES)
def test_picture_can_be_read(name: str) -> None:
    assert_readable(PICTURES[name]())


NO_FIGURES = ("MissingExtraError", "mcap", "player")
DRAWING = [name for name in public(plotting) if not name.startswith("animate") and name not in NO_FIGURES]


@pytest.mark.parametrize("name", DRAWING)
def test_picture_of_the_example_can_be_read(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    draw, drawn = getattr(plotting, name), []
    places = [place for place in namespaces.places(plotting) if name in place.__all__]

    def keep(*args: Any, **options: Any) -> Any:
        drawn.append(draw(*args, **options))
        return drawn[-1]

    for place in places:
        monkeypatch.setattr(place, name, keep)
    known: dict[str, Any] = {}
    for example in doctest.DocTestParser().get_examples(draw.__doc__):
        exec(compile(example.source, name, "single"), known)
    assert len(drawn) > 0
    for figure in drawn:
        assert_readable(figure)


@pytest.mark.parametrize("draw", [plotting.comparison_paths, lambda runs: plotting.comparison_sequence(runs, [1.0])])
def test_comparison_shows_the_whole_scene(draw: Callable[[dict[str, nav.Trajectory]], Any]) -> None:
    assert_readable(draw(several_laws(walled())), WALLS)


@pytest.mark.parametrize("draw", [plotting.paths, plotting.time_sequence])
def test_runs_show_the_whole_scene(draw: Callable[[nav.Trajectory], Any]) -> None:
    assert_readable(draw(nav.simulate(walled(), LAW)), WALLS)


def test_view_of_paths_leaves_far_walls_out() -> None:
    figure = plotting.comparison_paths(several_laws(walled()), view="paths")
    assert figure.axes[0].get_ylim()[1] < 6.0
    assert figure.axes[0].get_ylim()[1] > 0.5


def test_instants_of_a_follower_that_waits_are_drawn_once() -> None:
    (axes, *_) = followers("static", 3).axes
    rings = [patch for patch in axes.patches if patch.get_fill() is False]
    places = np.array([ring.center for ring in rings])
    apart = np.hypot(*(places[:, np.newaxis] - places).T) + 9.0 * np.eye(len(places))
    assert apart.min() > rings[0].radius


def test_legend_of_a_follower_names_only_what_is_drawn() -> None:
    names = [text.get_text() for text in legends_of(followers("static", 3))[0].get_texts()]
    assert "standing obstacle" in names
    assert not any("moving" in name for name in names)


def test_paths_on_each_other_have_different_widths() -> None:
    widths = {handle.get_label(): handle.get_linewidth() for handle in legends_of(same_paths())[0].legend_handles}
    assert widths["off"] > widths["capped"] + 1.0


def test_uneven_axes_are_said() -> None:
    upper, lower = sensitivity().axes
    assert "logarithmic" in lower.get_xlabel()
    assert (lower.get_yscale() == "symlog") == ("logarithmic" in lower.get_ylabel())
    assert upper.get_ylabel() == "mean H"


def test_surface_of_a_valley_has_no_holes() -> None:
    surface = plotting.potential_valley(*field_of("c3"), term="repulsive").axes[1]
    (faces,) = surface.collections
    assert np.isfinite(np.asarray(faces._faces)).all()
    assert len(faces.get_facecolor()) == 35 * 37


def test_refined_damping_ends_curves_where_they_end() -> None:
    design = impact.design_foam(impact.MANIPULATOR_2, impact.FoamLimits(), closing_speed=1.25)
    coarse = np.linspace(0.0, 345.0, 24)
    fine = plotting.impacts.boundaries.refined(coarse, [design.lower])
    known = np.isfinite(design.lower(fine).stiffness)
    (end,) = np.flatnonzero(known[:-1] & ~known[1:])
    assert set(coarse) <= set(fine)
    assert fine[end + 1] - fine[end] < (coarse[1] - coarse[0]) / 200.0


def test_stars_and_limits_of_histories_are_in_the_legend() -> None:
    names = [text.get_text() for text in legends_of(histories())[0].get_texts()]
    assert names == ["1", "3", "largest within the impact period", "limit"]


def test_label_moves_away_from_a_curve_and_a_line_leads_to_it() -> None:
    figure = style.new_figure(3.0)
    axes = figure.subplots()
    axes.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0))
    for height in np.linspace(0.3, 0.7, 21):
        axes.plot([0.0, 1.0], [height, height])
    word = labels.label(axes, "in the middle", (0.5, 0.5))
    assert len(struck_labels(laid_out(figure))) > 0
    labels.clear_labels(figure, [word])
    assert struck_labels(laid_out(figure)) == []
    assert word.arrow_patch is not None
    assert word.arrow_patch.get_visible()


@dataclasses.dataclass(frozen=True)
class Doubtful:
    """A result with warnings."""

    warnings: tuple[ResultWarning, ...]


@pytest.mark.parametrize("count", [1, 2, 5])
def test_warnings_stand_below_everything_else(count: int) -> None:
    figure = style.new_figure(3.0, title="A run")
    axes = figure.subplots()
    axes.plot([0.0, 1.0], [0.0, 1.0], label="x")
    axes.set(xlabel="time (s)", ylabel="distance (m)")
    style.legend_below(figure, axes.get_legend_handles_labels()[0], columns=1)
    found = tuple(dataclasses.replace(DOUBT, message=f"value {index} is 90 rad") for index in range(count))
    notes.add_warnings(figure, Doubtful(found))
    laid_out(figure)
    note = figure.texts[-1]
    lines = note.get_text().splitlines()
    assert lines[0] == "warning: value 0 is 90 rad"
    assert len(lines) == min(count, 3)
    assert box_of(note).y1 <= figure.legends[0].get_window_extent().y0
    assert box_of(note).y1 < box_of(axes.xaxis.label).y0
    assert_readable(figure)


def test_result_without_warnings_has_no_note() -> None:
    figure = style.new_figure(3.0)
    notes.add_warnings(figure, Doubtful(()), object(), None)
    assert figure.texts == []
    assert figure.get_figheight() == 3.0


@pytest.mark.parametrize(
    "draw", [plotting.paths, plotting.time_sequence, plotting.distances, plotting.energy, plotting.lyapunov]
)
def test_pictures_of_a_run_show_its_warnings(draw: Callable[[nav.Trajectory], Any]) -> None:
    class Suspect(nav.Trajectory):
        warnings = (DOUBT,)

    run = run_through("c2")
    suspect = Suspect(**{field.name: getattr(run, field.name) for field in dataclasses.fields(run) if field.init})
    assert any("heading is 90 rad" in text.get_text() for text in draw(suspect).texts)
    assert not any("warning" in text.get_text() for text in draw(run).texts)


@pytest.mark.parametrize("status", ["beyond_linear_range", "bottomed"])
def test_foam_beyond_the_model_is_marked_unlike_kept_limits(status: str) -> None:
    design = impact.design_foam(impact.MANIPULATOR_2, impact.FoamLimits(), closing_speed=1.25)
    damping, foams = np.linspace(0.0, 345.0, 24), {"thin": impact.FOAM_1, "thick": impact.FOAM_1}
    foams["thick"] = impact.Foam(stiffness=3e4, damping=150.0)
    figure = plotting.foam_boundaries(
        damping,
        design.upper(damping),
        design.lower(damping),
        foams=foams,
        accepted={"thin": True, "thick": True},
        statuses={"thin": status},
    )
    marks = {line.get_ydata()[0]: line for line in figure.axes[0].lines if len(line.get_xdata()) == 1}
    thin, thick = marks[24.3], marks[30.0]
    assert thin.get_marker() != thick.get_marker()
    assert thin.get_color() != thick.get_color()
    words = [text.get_text() for text in figure.axes[0].texts]
    assert words[0].startswith("thin: ")
    assert "fits" not in words[0]
    assert_readable(figure)


@pytest.mark.parametrize(
    ("stiffness", "status", "words", "marker"),
    [(12e3, "beyond_linear_range", "beyond the linear range", "^"), (5e3, "bottomed", "bottomed", "v")],
)
def test_response_beyond_the_linear_range_says_that_no_limit_is_kept(
    stiffness: float, status: str, words: str, marker: str
) -> None:
    soft = impact.simulate(
        impact.MANIPULATOR_2, impact.Foam(stiffness=stiffness, damping=20.0), impact.Head.minimum(), closing_speed=1.25
    )
    figure = plotting.impact_histories(soft)
    assert soft.metrics.status == status
    names = [text.get_text() for text in legends_of(figure)[0].get_texts()]
    assert names == [f"deepest, {words}: no limit counts as kept"]
    assert all(any(line.get_marker() == marker for line in axes.lines) for axes in figure.axes)
    assert_readable(figure)
