"""Pictures of several laws in one scenario show what the runs hold."""

from __future__ import annotations

import dataclasses
import itertools

import numpy as np
import pytest

from api.plotted import DISC, LAW, PERSON, RECTANGLE, crowd, made_up_run, touched
from hrsafety import benchmarks, plotting
from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError, ShapeError

pytest.importorskip("matplotlib")
Image = pytest.importorskip("PIL.Image")

from matplotlib.colors import to_rgb  # noqa: E402  # needs the check above
from matplotlib.patches import Circle  # noqa: E402  # needs the check above

from hrsafety.plotting import style  # noqa: E402  # needs the check above
from hrsafety.plotting.comparisons import law_looks  # noqa: E402  # needs the check above

LAWS: dict[str, nav.Law] = {
    "field": LAW,
    "Masoud": nav.Masoud(),
    "Ge & Cui": nav.GeCui(),
    "Khatib": nav.Khatib(),
    "Borenstein & Koren": nav.BorensteinKoren(),
    "velocity obstacles": nav.VelocityObstacle(),
    "ORCA": nav.OptimalReciprocalCollisionAvoidance(),
    "RRT": nav.RapidlyExploringRandomTree(),
    "Field D*": nav.FieldDStar(),
}
# Two colors nearer than this in the plane of lightness and one hue axis would be taken for one.
LEAST_DIFFERENCE = 0.05


def of_law(run: nav.Trajectory, law: nav.Law) -> nav.Trajectory:
    return dataclasses.replace(run, law=law)


def made_up_runs(*obstacles: nav.Obstacle) -> dict[str, nav.Trajectory]:
    return {
        name: of_law(made_up_run(*obstacles, duration=4.0 + 0.5 * k), law) for k, (name, law) in enumerate(LAWS.items())
    }


def lines_of_runs(axes: object, runs: dict[str, nav.Trajectory]) -> list[object]:
    lengths = {len(run.time) for run in runs.values()}
    return [line for line in axes.get_lines() if len(line.get_xdata()) in lengths and line.get_linestyle() != ":"]


def legend_words(figure: object) -> list[str]:
    legends = figure.legends + [axes.get_legend() for axes in figure.axes if axes.get_legend() is not None]
    return [text.get_text() for legend in legends for text in legend.get_texts()]


def three_episodes(outcomes: list[list[str]], faults: list[list[int]]) -> nav.Comparison:
    runs = nav.compare([made_up_run(DISC).scenario] * 3, {"first": LAW, "second": LAW}).runs
    columns = {"outcome": outcomes, "contacts_moving": faults, "contacts_at_fault": faults}
    return nav.Comparison(
        runs=dataclasses.replace(runs, **{name: np.ravel(values) for name, values in columns.items()})
    )


@pytest.fixture(scope="module")
def runs() -> dict[str, nav.Trajectory]:
    return made_up_runs(PERSON, DISC, RECTANGLE)


def test_units_are_on_the_axes_and_scenes_have_equal_scales(runs):
    for figure in (plotting.comparison_paths(runs), plotting.comparison_sequence(runs, [1.0])):
        assert (figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()) == ("x (m)", "y (m)")
        assert figure.axes[0].get_aspect() == 1.0
    axes = plotting.comparison_distances(runs).axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time (s)", "distance of the surfaces (m)")


def test_every_picture_is_drawn_without_a_warning_and_at_readme_width(runs, tmp_path):
    result = three_episodes([["arrived"] * 3, ["collided"] * 3], [[0] * 3, [1] * 3])
    figures = {
        "paths": plotting.comparison_paths(runs, regions=True, title="paths"),
        "distances": plotting.comparison_distances(runs),
        "sequence": plotting.comparison_sequence(runs, [0.0, 1.0, 2.0, 8.0]),
        "standings": plotting.comparison_standings(result),
        "crowd": plotting.comparison_paths({"field": made_up_run(*crowd(12))}),
    }
    for name, figure in figures.items():
        figure.savefig(tmp_path / f"{name}.png")
        with Image.open(tmp_path / f"{name}.png") as picture:
            assert picture.width == 1200, name
            assert 200 < picture.height < 1700, name


def test_every_law_has_its_path_and_its_name(runs):
    figure = plotting.comparison_paths(runs)
    paths = [line.get_xydata() for line in lines_of_runs(figure.axes[0], runs)]
    for path, run in zip(paths, runs.values(), strict=True):
        assert np.array_equal(path, run.position)
    assert legend_words(figure)[: len(LAWS)] == list(LAWS)


def test_laws_have_colors_that_color_blind_people_tell_apart():
    colors = list(law_looks.LAW_COLORS.values())
    assert set(law_looks.LAW_COLORS) >= {type(law) for law in LAWS.values()}
    # Red and green seen as one: lightness and blue against yellow are left.
    seen = [np.array([0.3 * r + 0.6 * g + 0.1 * b, b - (r + g) / 2]) for r, g, b in map(to_rgb, colors)]
    assert all(np.hypot(*(one - other)) > LEAST_DIFFERENCE for one, other in itertools.combinations(seen, 2))


def test_color_belongs_to_the_kind_of_law_and_not_to_the_order(runs):
    backwards = dict(reversed(runs.items()))
    looks, others = law_looks.looks_of(runs), law_looks.looks_of(backwards)
    assert looks == others


def test_two_laws_of_one_kind_differ_in_their_line():
    run = made_up_run(DISC)
    looks = law_looks.looks_of({"with": of_law(run, LAW), "without": of_law(run, nav.VirtualForceField(detour_gain=0))})
    assert looks["with"]["color"] == looks["without"]["color"]
    assert looks["with"]["linestyle"] != looks["without"]["linestyle"]


def test_a_moving_obstacle_is_drawn_where_it_was(runs):
    axes = plotting.comparison_paths(runs).axes[0]
    run = law_looks.longest(runs)
    drawn = [patch for patch in axes.patches if isinstance(patch, Circle) and patch.radius == PERSON.radius]
    times = [float(text.get_text().removesuffix(" s")) for text in axes.texts]
    assert 1 < len(drawn) <= 6
    for patch, time in zip(drawn, times, strict=True):
        row = int(np.argmin(np.abs(run.time - time)))
        assert np.allclose(patch.center, run.obstacle_position[row, 0])


def test_contacts_and_ends_without_arrival_are_marked():
    run = made_up_run(PERSON, DISC)
    ended = dataclasses.replace(made_up_run(PERSON, DISC, arrived=False), law=nav.Masoud())
    assert "first contact" not in legend_words(plotting.comparison_paths({"field": run}))
    figure = plotting.comparison_paths({"field": touched(run, 0, 2.0), "Masoud": ended})
    assert {"first contact", "end, not arrived"} <= set(legend_words(figure))
    crosses = [line for line in figure.axes[0].get_lines() if line.get_marker() == "X"]
    assert [line.get_xydata()[0].tolist() for line in crosses] == [run.position[200].tolist()]


def test_distance_is_that_of_the_nearest_surfaces(runs):
    axes = plotting.comparison_distances(runs).axes[0]
    shown = [line.get_ydata() for line in lines_of_runs(axes, runs)]
    for line, run in zip(shown, runs.values(), strict=True):
        radii = np.array([PERSON.radius + 0.2, DISC.radius + 0.2, 0.2])
        assert np.array_equal(line, np.nanmin(run.distance - radii, axis=1))


def test_distance_to_a_chosen_obstacle(runs):
    axes = plotting.comparison_distances(runs, obstacle=1).axes[0]
    for line, run in zip(lines_of_runs(axes, runs), runs.values(), strict=True):
        assert np.array_equal(line.get_ydata(), run.distance[:, 1] - (DISC.radius + 0.2))


def test_an_arrival_is_named_where_it_is_in_view():
    beside_the_goal = dataclasses.replace(DISC, center=(0.8, 1.2))
    near, far = made_up_run(beside_the_goal), made_up_run(DISC)
    assert "arrival" in legend_words(plotting.comparison_distances({"field": near}))
    assert "arrival" not in legend_words(plotting.comparison_distances({"field": far}))


def test_a_run_that_lasts_much_longer_leaves_the_panel():
    quick, slow = made_up_run(DISC, duration=5.0), made_up_run(DISC, duration=60.0, arrived=False)
    several = {"a": quick, "b": of_law(quick, nav.Masoud()), "c": of_law(slow, nav.GeCui())}
    assert 5.0 < plotting.comparison_distances(several).axes[0].get_xlim()[1] <= 10.0


def test_sequence_shows_every_robot_at_the_instant_or_at_its_end(runs):
    radius = law_looks.longest(runs).scenario.robot.radius
    for axes, instant in zip(plotting.comparison_sequence(runs, [1.5, 7.0]).axes, (1.5, 7.0), strict=True):
        robots = [patch.center for patch in axes.patches if isinstance(patch, Circle) and patch.radius == radius]
        rows = [min(round(instant / 0.01), len(run.time) - 1) for run in runs.values()]
        assert np.allclose(robots, [run.position[row] for run, row in zip(runs.values(), rows, strict=True)])


def test_standings_are_the_shares_and_their_intervals():
    result = three_episodes([["arrived", "arrived", "collided"], ["collided"] * 3], [[0, 0, 0], [1, 0, 1]])
    left, right, places = plotting.comparison_standings(result).axes
    success, contact, at_fault = [
        [line.get_xdata().tolist() for line in axes.get_lines() if line.get_marker() == "o"]
        for axes in (left, right, right)
    ]
    assert success == [[2 / 3, 0.0]]
    assert contact == at_fault == [[1 / 3, 1.0], [0.0, 2 / 3]]
    ends = left.collections[0].get_segments()
    standing = result.standing("first").success
    assert np.allclose([end[0] for end in ends[0]], [standing.low, standing.high])
    assert [label.get_text() for label in left.get_yticklabels()] == ["first", "second"]
    ranks = next(line for line in places.get_lines() if line.get_marker() == "D")
    assert ranks.get_xdata().tolist() == [1.0, 2.0]


@pytest.mark.parametrize("draw", [plotting.comparison_paths, plotting.comparison_distances])
@pytest.mark.parametrize("bad", [{}, [made_up_run(DISC)], None, {"field": "a run"}])
def test_what_is_not_a_mapping_of_runs_is_refused(draw, bad):
    with pytest.raises(InvalidParameterError, match="runs"):
        draw(bad)


def test_runs_of_different_scenes_are_refused_by_name():
    with pytest.raises(InvalidParameterError, match=r"runs\['other'\].*obstacles"):
        plotting.comparison_paths({"field": made_up_run(DISC), "other": made_up_run(PERSON)})


@pytest.mark.parametrize("obstacle", [-1, 3, 1.0, True, "disc"])
def test_an_obstacle_that_is_not_there_is_refused(runs, obstacle):
    with pytest.raises(InvalidParameterError, match="obstacle"):
        plotting.comparison_distances(runs, obstacle=obstacle)


def test_distances_need_an_obstacle():
    with pytest.raises(InvalidParameterError, match="among obstacles"):
        plotting.comparison_distances({"field": made_up_run()})


@pytest.mark.parametrize("times", [[], [-0.1], [100.0], [np.nan], list(range(25))])
def test_instants_outside_the_runs_are_refused(runs, times):
    with pytest.raises(InvalidParameterError, match="times"):
        plotting.comparison_sequence(runs, times)


def test_instants_must_be_a_sequence_of_numbers(runs):
    with pytest.raises(ShapeError, match="times"):
        plotting.comparison_sequence(runs, 2.0)
    with pytest.raises(InvalidParameterError, match="times"):
        plotting.comparison_sequence(runs, "soon")


def test_only_a_comparison_has_standings():
    with pytest.raises(InvalidParameterError, match="Comparison"):
        plotting.comparison_standings({"field": 1.0})


def test_pictures_of_laws_leave_contact_and_obstacle_colors_alone():
    used = {color.upper() for color in law_looks.LAW_COLORS.values()}
    others = {style.CONTACT_COLOR, style.GOAL_COLOR, style.PERSON_COLORS[0], style.STATIONARY_COLORS[0]}
    assert not used & {color.upper() for color in others}


def test_the_standings_of_a_benchmark_are_drawn_like_those_of_a_comparison():
    ends = {"first": ["arrived", "collided", "arrived"], "second": ["collided", "timed_out", "collided"]}
    rows = {
        name: [
            benchmarks.Row(
                case=case,
                outcome=word,
                arrival_time=1.0,
                end_time=2.0,
                contacts=int(word == "collided"),
                at_fault=0,
                apart=0,
                clearance=0.1,
            )
            for case, word in enumerate(words)
        ]
        for name, words in ends.items()
    }
    result = benchmarks.Result(suite="crowd", rows=rows)
    left, _, places = plotting.comparison_standings(result).axes
    (success,) = [line.get_xdata().tolist() for line in left.get_lines() if line.get_marker() == "o"]
    assert success == [2 / 3, 0.0]
    assert [label.get_text() for label in left.get_yticklabels()] == ["first", "second"]
    ranks = next(line for line in places.get_lines() if line.get_marker() == "D")
    assert ranks.get_xdata().tolist() == [1.0, 2.0]
