"""Pictures of people that react and of robots among them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle
from PIL import Image

from hrsafety import navigation as nav
from hrsafety import plotting, scenarios
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.navigation.crowd import pedestrians
from hrsafety.plotting import style
from hrsafety.plotting.crowds import world_scenes
from pictures import assert_readable

MODELS_OF_PEOPLE = [getattr(pedestrians, name) for name in pedestrians.__all__ if name != "Pedestrian"]
LAW = nav.OptimalReciprocalCollisionAvoidance()


def crossed(case: int = 0, **options: Any) -> nav.Trajectory:
    return nav.simulate(scenarios.circle_crossing(case, law=LAW, **options))


def corridor(**options: Any) -> nav.Trajectory:
    robot = nav.Robot(start=(0.0, 1.5), goal=(9.0, 1.5), law=LAW)
    return nav.simulate(scenarios.corridor(10, robots=[robot], time_limit=8.0, **options))


def groups() -> nav.Trajectory:
    """Two groups and somebody alone, in front of a pillar, a box and a wall."""
    places = [(0.0, 0.0), (0.0, 0.6), (0.0, 2.0), (0.0, 2.6), (0.0, 4.0)]
    people = [
        nav.Person(start=place, route=[(6.0, place[1])], model=nav.crowd.Moussaid(), group=group)
        for place, group in zip(places, (0, 0, 7, 7, None), strict=True)
    ]
    walls = [nav.Disc(center=(3.0, 1.2), radius=0.3), nav.Rectangle(center=(3.0, 3.4), length=1.0, width=0.4)]
    return nav.simulate(nav.World(people=people, walls=[*walls, [(-1.0, -1.0), (7.0, -1.0)]], time_limit=6.0))


def mixed() -> nav.Trajectory:
    """All models, a recorded person, and somebody from a source, among three robots."""
    models = [kind() for kind in MODELS_OF_PEOPLE]
    people = [nav.Person(start=(0.0, 1.2 * k), route=[(6.0, 1.2 * k)], model=each) for k, each in enumerate(models)]
    path = ([0.0, 4.0], [(6.0, -1.0), (0.0, -1.0)])
    people.append(nav.Person(start=(6.0, -1.0), recording=path))
    source = nav.Source(low=(-1.0, -3.0), high=(0.0, -2.0), rate=0.5, route=[(6.0, -2.0)])
    robots = [nav.Robot(start=(3.0, y), goal=(3.0, 5.0 - y), law=LAW) for y in (-3.0, 6.5, 0.6)]
    return nav.simulate(nav.World(people=people, robots=robots, sources=[source], time_limit=8.0, step=0.05))


def nobody() -> nav.Trajectory:
    return nav.simulate(nav.World(time_limit=1.0))


def many_robots() -> nav.Trajectory:
    return nav.simulate(scenarios.antipodal(8, robots=8, law=LAW, time_limit=6.0))


def legend(figure: Any) -> list[str]:
    return [text.get_text() for each in figure.legends for text in each.get_texts()]


PICTURES: dict[str, Callable[[], Any]] = {
    "crossing": lambda: plotting.crowds.crowd_paths(crossed(visible=False), title="Circle"),
    "corridor": lambda: plotting.crowds.crowd_paths(corridor()),
    "groups": lambda: plotting.crowds.crowd_paths(groups(), color_by="group", at=2.0),
    "mixed": lambda: plotting.crowds.crowd_paths(mixed()),
    "bottleneck": lambda: plotting.crowds.crowd_paths(nav.simulate(scenarios.bottleneck(30, time_limit=5.0))),
    "many robots": lambda: plotting.crowds.crowd_paths(many_robots()),
    "nobody": lambda: plotting.crowds.crowd_paths(nobody()),
    "space and time": lambda: plotting.crowds.space_time(corridor(), title="Both ways"),
    "space and time, oblique": lambda: plotting.crowds.space_time(crossed(), along=(1.0, 1.0), origin=(0.0, -4.0)),
    "space and time, many robots": lambda: plotting.crowds.space_time(many_robots()),
    "space and time, nobody": lambda: plotting.crowds.space_time(nobody()),
    "fundamental diagram": lambda: plotting.crowds.fundamental_diagram(
        [0.5, 1.0, 2.0], {"a": [1.2, 1.0, np.nan], "b": [1.3, 1.3, 1.2]}, reference=[1.3, 1.1, 0.6], title="Corridor"
    ),
}


@pytest.mark.parametrize("name", PICTURES)
def test_picture_can_be_read(name: str) -> None:
    assert_readable(PICTURES[name]())


def test_everybody_is_where_he_is_at_the_instant() -> None:
    run = crossed()
    axes = plotting.crowds.crowd_paths(run, at=3.0).axes[0]
    drawn = [tuple(np.round(each.center, 9)) for each in axes.patches if isinstance(each, Circle)]
    row = int(np.abs(run.time - 3.0).argmin())
    for place in (*run.obstacle_position[row], run.robot_position[row, 0]):
        assert tuple(np.round(place, 9)) in drawn
    low, high = axes.get_xlim()
    assert low < run.obstacle_position[..., 0].min()
    assert run.obstacle_position[..., 0].max() < high


def test_the_instant_is_the_nearest_one_unless_given() -> None:
    run = crossed()
    gap = np.linalg.norm(run.obstacle_position - run.robot_position, axis=2).min(axis=1)
    nearest = run.time[gap.argmin()]
    assert plotting.crowds.crowd_paths(run).get_suptitle() == f"t = {nearest:.2f} s"
    assert plotting.crowds.crowd_paths(run, at=1.0, title="A").get_suptitle() == "A, t = 1.00 s"


def test_contacts_are_marked_and_in_the_legend() -> None:
    touched = next(run for case in range(20) if world_scenes.contacts(run := crossed(case, visible=False)))
    figure = plotting.crowds.crowd_paths(touched)
    assert "first contact" in legend(figure)
    row, robot = world_scenes.contacts(touched)[0]
    marks = [line.get_xydata()[0].tolist() for line in figure.axes[0].lines if line.get_marker() == "X"]
    assert touched.robot_position[row, robot].tolist() in marks
    assert "first contact" not in legend(plotting.crowds.crowd_paths(corridor()))


def test_colors_tell_models_or_groups() -> None:
    words = legend(plotting.crowds.crowd_paths(mixed()))
    assert [each for each in words if "person" in each or "Moussa" in each]
    for model in (*(kind.TITLE for kind in MODELS_OF_PEOPLE), "recorded person"):
        assert any(model in each for each in words)
    words = legend(plotting.crowds.crowd_paths(groups(), color_by="group"))
    assert {"group 0", "group 7", "no group", "wall"} <= set(words)
    assert not set(world_scenes.PEOPLE_COLORS) & set(style.RUN_COLORS)


def test_a_floor_that_repeats_shows_people_at_all_their_places() -> None:
    place = world_scenes.Floor(((-1.0, 11.0), (0.0, 3.0)), np.zeros(2), np.array([10.0, np.inf]))
    found = sorted(float(each[0]) for each in place.copies(np.array([9.5, 1.0]), 0.25))
    assert found == [-0.5, 9.5]
    np.testing.assert_allclose(place.wrapped(np.array([[23.0, 1.0], [-1.0, 5.0]])), [[3.0, 1.0], [9.0, 5.0]])
    path = place.path(np.array([[9.0, 1.0], [9.9, 1.0], [10.2, 1.0]]))
    np.testing.assert_allclose(path[:, 0], [9.0, 9.9, np.nan, 0.2])


def test_positions_over_time_have_the_colors_of_speeds() -> None:
    run = corridor()
    axes = plotting.crowds.space_time(run).axes[0]
    (lines,) = (each for each in axes.collections if isinstance(each, LineCollection))
    segments = np.array(lines.get_segments())
    values = np.asarray(lines.get_array())
    speed = np.hypot(run.obstacle_velocity[..., 0], run.obstacle_velocity[..., 1])
    assert values.max() <= speed.max() == lines.get_clim()[1]
    assert segments[..., 1].min() >= 0.0
    assert segments[..., 1].max() <= 10.0
    first = segments[0, 0]
    assert first.tolist() == [0.0, run.obstacle_position[0, 0, 0] % 10.0]
    assert values[0] == speed[0, 0]


def test_a_diagram_has_a_curve_for_each_model_and_the_reference() -> None:
    figure = plotting.crowds.fundamental_diagram([0.5, 1.0], {"a": [1.2, 1.0]}, reference=[1.3, 1.1])
    drawn = [line.get_xydata().tolist() for line in figure.axes[0].lines]
    assert drawn == [[[0.5, 1.3], [1.0, 1.1]], [[0.5, 1.2], [1.0, 1.0]]]
    assert legend(figure) == ["Weidmann 1993", "a"]
    for density, speeds, message in (
        ([1.0, 0.5], {"a": [1.0, 1.0]}, "density must be positive and increasing"),
        ([0.0, 0.5], {"a": [1.0, 1.0]}, "density must be positive and increasing"),
        ([0.5], {}, "speeds must be a mapping"),
        ([0.5], {"a": [np.inf]}, r"speeds\['a'\] must be finite or NaN"),
    ):
        with pytest.raises(InvalidParameterError, match=message):
            plotting.crowds.fundamental_diagram(density, speeds)
    with pytest.raises(ShapeError, match=r"speeds\['a'\]"):
        plotting.crowds.fundamental_diagram([0.5, 1.0], {"a": [1.0]})


def test_an_animation_holds_every_frame(tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    run = crossed(visible=False)
    options: dict[str, Any] = {"frames_per_second": 2, "progress": lambda *each: told.append(each), "title": "Circle"}
    path = plotting.crowds.animate_crowd(run, tmp_path / "crossing.gif", **options)
    frames = len(np.arange(0.0, run.time[-1], 0.5)) + 1
    assert told[-1] == (frames, frames)
    with Image.open(path) as picture:
        assert picture.n_frames <= frames
        assert picture.n_frames > 0.8 * frames
    assert plotting.crowds.animate_crowd(groups(), tmp_path / "g.gif", color_by="group", frames_per_second=1).is_file()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda run, _: plotting.crowds.crowd_paths(run, at=99.0), "at must be from 0 to the end of the run"),
        (lambda run, _: plotting.crowds.crowd_paths(run, color_by="grop"), "color_by must be"),
        (lambda run, _: plotting.crowds.crowd_paths(run, labels=["a", "b"]), "labels must be 1 strings"),
        (lambda run, _: plotting.crowds.crowd_paths(run.scenario), "run must be the Trajectory of a World"),
        (lambda run, _: plotting.crowds.space_time(run, along=(0.0, 0.0)), "along must be a direction"),
        (lambda run, path: plotting.crowds.animate_crowd(run, path / "a.avi"), "path must end in"),
        (lambda run, _: plotting.lyapunov(run), "trajectories must be the run of a scenario.*crowds"),
    ],
)
def test_bad_input_is_named(call: Callable[..., Any], message: str, tmp_path: Path) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        call(crossed(), tmp_path)
