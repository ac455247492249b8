from __future__ import annotations

import dataclasses
import itertools
import subprocess
import sys

import numpy as np
import pytest

from api.plotted import (
    DISC,
    LAW,
    PERSON,
    RECTANGLE,
    STATIONARY,
    WALKING,
    crowd,
    made_up_field,
    made_up_run,
    scene,
    touched,
)
from hrsafety import navigation as nav
from hrsafety import plotting
from hrsafety.errors import HrsafetyError, InvalidParameterError, ShapeError

matplotlib = pytest.importorskip("matplotlib")
Image = pytest.importorskip("PIL.Image")

from matplotlib.colors import to_hex  # noqa: E402  # needs the check above
from matplotlib.patches import Circle, Polygon  # noqa: E402  # needs the check above

from hrsafety.plotting import shapes, style  # noqa: E402  # needs the check above

ROUNDING = 1e-12  # sums and differences of a few numbers of order one
LOSS_ROUNDING = 1e-9  # the same sum of thousands of terms in another order


@pytest.fixture(scope="module")
def run() -> nav.Trajectory:
    return nav.simulate(scene(PERSON, DISC, RECTANGLE), LAW)


def every_figure() -> dict[str, object]:
    made_up = made_up_run(PERSON, DISC, RECTANGLE)
    field = made_up_field()
    return {
        "paths": plotting.paths([made_up, touched(made_up, 0, 2.0)], labels=["one", "two"]),
        "time_sequence": plotting.time_sequence(made_up, instants=5),
        "distances": plotting.distances([made_up, made_up]),
        "energy": plotting.energy([made_up, made_up]),
        "lyapunov": plotting.lyapunov(made_up),
        "layout": plotting.layout(made_up.scenario),
        "force_field": plotting.force_field(field, scene(DISC)),
        "potential_valley": plotting.potential_valley(field, scene(DISC)),
        "clearances": plotting.clearances({"off": [0.1, -0.1, 0.4]}),
        "outcomes": plotting.outcomes({"off": ["arrived", "stopped"]}),
    }


UNITS = {
    "paths": {"x (m)", "y (m)"},
    "time_sequence": {"x (m)", "y (m)"},
    "distances": {"time (s)", "distance (m)"},
    "energy": {"time (s)", "current (A)", "loss (J)"},
    "lyapunov": {"time (s)", "Lyapunov function V (N²)"},
    "layout": {"x (m)", "y (m)"},
    "force_field": {"x (m)", "y (m)", "total force (N)"},
    "potential_valley": {"x (m)", "y (m)", "Lyapunov function V (N²)"},
    "clearances": {"least clearance (m)", "share of runs"},
    "outcomes": {"share of runs"},
}


def test_every_axis_label_carries_its_unit():
    for name, figure in every_figure().items():
        shown = {label for axes in figure.axes for label in (axes.get_xlabel(), axes.get_ylabel())} - {""}
        assert shown == UNITS[name], name


def test_every_figure_is_drawn_without_a_warning_and_at_readme_width(tmp_path):
    for name, figure in every_figure().items():
        file = tmp_path / f"{name}.png"
        figure.savefig(file)
        with Image.open(file) as picture:
            assert picture.width == 1200, name
            assert 200 < picture.height < 1500, name


def test_scenes_have_equal_scales():
    for name in ("paths", "time_sequence", "layout", "force_field"):
        assert every_figure()[name].axes[0].get_aspect() == 1.0


def test_pictures_leave_the_settings_of_matplotlib_alone():
    before = matplotlib.rcParams.copy()
    every_figure()
    assert dict(matplotlib.rcParams) == dict(before)


def test_the_look_stays_when_a_figure_is_drawn_later():
    figure = plotting.lyapunov(made_up_run())
    figure.draw_without_rendering()
    assert {tick.get_fontsize() for tick in figure.axes[0].get_xticklabels()} == {style.FONT_SIZE - 0.5}


def test_pictures_need_neither_pyplot_nor_matplotlib_before_a_call():
    code = (
        "import sys, hrsafety.plotting as p; assert 'matplotlib' not in sys.modules;"
        "p.clearances({'a': [0.1]}); assert 'matplotlib.pyplot' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_missing_matplotlib_is_named_with_the_extra_only_when_a_picture_is_asked_for(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(plotting.MissingExtraError, match=r"pip install matplotlib") as caught:
        plotting.layout(scene())
    assert isinstance(caught.value, HrsafetyError)
    assert isinstance(caught.value, ImportError)


# ---- paths and layout ---------------------------------------------------------------------------------


def test_each_run_has_one_path_with_a_marker_each_second():
    runs = [made_up_run(DISC, duration=5.5), made_up_run(DISC, duration=3.5)]
    axes = plotting.paths(runs).axes[0]
    full = [line for line in axes.get_lines() if len(line.get_xdata()) > 300]
    assert [len(line.get_xdata()) for line in full] == [551, 351]
    markers = [line for line in axes.get_lines() if isinstance(line.get_marker(), tuple)]
    assert len(markers) == 5 + 3
    x, y = runs[0].position[100]
    assert markers[0].get_xydata().tolist() == [[x, y]]


def test_region_of_a_disc_is_a_circle_of_the_radius():
    circles = [patch for patch in plotting.layout(scene(DISC)).axes[0].patches if isinstance(patch, Circle)]
    radii = {round(circle.radius, 3) for circle in circles if circle.center == DISC.center}
    assert radii == {0.1, 0.4, 0.8}


@pytest.mark.parametrize("heading", [0.0, 0.7])
def test_region_of_a_rectangle_is_a_contour_at_the_distance(heading):
    rectangle = nav.Rectangle(center=(2.3, 0.1), length=1.4, width=0.6, heading=heading, **STATIONARY)
    outline = shapes.rectangle_outline(rectangle, rectangle.center, 0.4) - np.array(rectangle.center)
    cosine, sine = np.cos(heading), np.sin(heading)
    own = outline @ np.array([[cosine, -sine], [sine, cosine]])
    beyond = own - np.clip(own, [-0.7, -0.3], [0.7, 0.3])
    assert np.abs(np.hypot(*beyond.T) - 0.4).max() < ROUNDING
    polygons = [patch for patch in plotting.layout(scene(rectangle)).axes[0].patches if isinstance(patch, Polygon)]
    assert len(polygons) == 5  # two regions, each filled and edged, and the body


def test_a_moving_obstacle_is_drawn_where_the_robot_came_closest():
    made_up = made_up_run(PERSON)
    place = made_up.obstacle_position[np.nanargmin(made_up.distance[:, 0]), 0]
    circles = [patch for patch in plotting.paths(made_up).axes[0].patches if isinstance(patch, Circle)]
    assert [circle.center for circle in circles if circle.radius == PERSON.radius] == [tuple(place)]
    assert [circle.radius for circle in circles if circle.center == tuple(place)].count(2.1) == 2


def test_a_person_who_never_came_near_is_a_dotted_path_only():
    far = nav.Human(start=(0.0, 9.0), velocity=(1.0, 0.0), **WALKING)
    figure = plotting.paths(made_up_run(far))
    assert not [patch for patch in figure.axes[0].patches if getattr(patch, "radius", None) == far.radius]
    assert figure.axes[0].get_ylim()[1] < 5.0


def test_of_few_moving_obstacles_each_is_in_view_unless_it_stays_far_away():
    for offset, shown in ((3.2, True), (40.0, False)):
        aside = nav.Human(start=(1.0, offset), velocity=(0.2, 0.0))
        run = nav.simulate(nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[aside]), LAW)
        (axes,) = plotting.paths(run).axes
        assert (axes.get_ylim()[1] > offset) == shown
        (close,) = plotting.paths(run, view="paths").axes
        assert close.get_ylim()[1] < offset


def test_contacts_and_ends_without_arrival_are_marked():
    made_up = touched(made_up_run(PERSON, DISC, arrived=False), 0, 2.0)
    figure = plotting.paths(made_up)
    crosses = [line for line in figure.axes[0].get_lines() if line.get_marker() == "X"]
    assert [line.get_xydata().tolist() for line in crosses] == [[made_up.position[200].tolist()]]
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "first contact" in words
    assert "end, not arrived" in words
    assert len([line for line in figure.axes[0].get_lines() if line.get_marker() == "s"]) == 1


def test_a_way_through_a_wall_is_marked_as_a_contact():
    wall = nav.StaticMap.from_polylines([[(2.0, -2.0), (2.0, 2.0)]])
    scenario = nav.Scenario(start=(0.0, 0.0), goal=(4.0, 0.0), walls=wall)
    run = nav.simulate(scenario, nav.Masoud())
    assert run.outcome == "collided"
    assert np.isfinite(run.arrival_time)
    place = run.position[int(np.abs(run.time - run.map_contact_time).argmin())].tolist()
    for figure in (plotting.paths(run), plotting.comparison_paths({"straight on": run})):
        crosses = [line.get_xydata().tolist() for line in figure.axes[0].lines if line.get_marker() == "X"]
        assert [place] in crosses
        assert "first contact" in [text.get_text() for text in figure.legends[0].get_texts()]
    (axes,) = plotting.distances(run).axes
    (cross,) = [line for line in axes.lines if line.get_marker() == "X"]
    assert cross.get_xdata()[0] == pytest.approx(run.map_contact_time)
    (words,) = [text for text in axes.texts if "arrival" in text.get_text()]
    assert "after a contact" in words.get_text()
    assert words.get_color() == style.CONTACT_COLOR
    world = nav.World.of(scenario)
    robot = nav.Robot(start=(0.0, 0.0), goal=(4.0, 0.0), law=nav.Masoud())
    of_world = nav.simulate(dataclasses.replace(world, robots=[robot]))
    figure = plotting.crowds.crowd_paths(of_world)
    assert any(line.get_marker() == "X" for line in figure.axes[0].lines)


def test_regions_can_be_left_out():
    patches = plotting.paths(made_up_run(DISC), regions=False).axes[0].patches
    assert {round(patch.radius, 3) for patch in patches if isinstance(patch, Circle)} == {0.1, 0.12}


def test_layout_shows_the_way_of_one_second():
    axes = plotting.layout(scene(PERSON)).axes[0]
    arrows = [patch for patch in axes.patches if type(patch).__name__ == "FancyArrowPatch"]
    assert len(arrows) == 1
    assert np.asarray(arrows[0]._posA_posB).tolist() == [[0.6, 0.6], [1.6, 0.6]]


def test_layout_shows_recorded_people_only_if_they_are_there_at_time_zero():
    way = [[1.0, 2.0], [2.0, 2.0], [3.0, 2.5]]
    later, now = (nav.Human.from_path(np.array([0.0, 1.0, 2.0]) + begin, way, **WALKING) for begin in (0.5, -0.5))
    bodies = [
        [
            patch.center
            for patch in plotting.layout(scene(person)).axes[0].patches
            if getattr(patch, "radius", 0.0) == 0.4
        ]
        for person in (later, now)
    ]
    assert bodies == [[], [(1.5, 2.0)]]


def test_of_many_obstacles_the_moving_ones_have_numbers_instead_of_regions():
    made_up = made_up_run(*crowd(20))
    axes = plotting.paths(made_up).axes[0]
    met = [int(index) + 1 for index in np.flatnonzero(made_up.min_distance < 2.1)]
    assert 0 < len(met) < 20
    assert sorted(int(text.get_text()) for text in axes.texts) == met
    assert not [patch for patch in axes.patches if getattr(patch, "radius", 0.0) == 2.1]


def test_runs_of_different_scenes_are_not_drawn_together():
    with pytest.raises(InvalidParameterError, match=r"trajectories\[1\] must share goal and obstacles"):
        plotting.paths([made_up_run(DISC), made_up_run(RECTANGLE)])
    assert plotting.paths([made_up_run(DISC), made_up_run()]).axes


@pytest.mark.parametrize("function", [plotting.paths, plotting.distances, plotting.energy, plotting.lyapunov])
def test_wrong_runs_and_labels_are_named(function):
    with pytest.raises(InvalidParameterError, match="trajectories must hold at least one"):
        function([])
    with pytest.raises(InvalidParameterError, match="trajectories must be a Trajectory or a sequence"):
        function(3.0)
    with pytest.raises(InvalidParameterError, match=r"trajectories\[1\] must be a Trajectory, got str"):
        function([made_up_run(), "run"])
    with pytest.raises(InvalidParameterError, match="labels must be 1 strings"):
        function(made_up_run(), labels=["a", "b"])


# ---- time sequence ------------------------------------------------------------------------------------


def test_time_sequence_has_one_panel_for_each_instant():
    made_up = made_up_run(PERSON, DISC)
    assert len(plotting.time_sequence(made_up, instants=5).axes) == 5
    titles = [axes.get_title() for axes in plotting.time_sequence(made_up, instants=[0.0, 1.234, 5.5]).axes]
    assert titles == ["t = 0.00 s", "t = 1.23 s", "t = 5.50 s"]


def test_time_sequence_hides_who_is_absent():
    made_up = made_up_run(PERSON)
    before, after = plotting.time_sequence(made_up, instants=[0.5, 1.5]).axes
    bodies = [
        [patch for patch in axes.patches if isinstance(patch, Circle) and patch.radius == PERSON.radius]
        for axes in (before, after)
    ]
    assert [len(found) for found in bodies] == [0, 1]


@pytest.mark.parametrize("instants", [0, 25, True, [], [6.0], [-0.1], [np.nan], "now", [[1.0]]])
def test_instants_outside_the_run_are_refused(instants):
    with pytest.raises(InvalidParameterError, match="instants"):
        plotting.time_sequence(made_up_run(), instants=instants)


# ---- histories ----------------------------------------------------------------------------------------


def test_distances_keep_gaps_and_show_radii_in_the_color_of_the_obstacle():
    made_up = made_up_run(PERSON, DISC)
    axes = plotting.distances(made_up).axes[0]
    lines = {line.get_label(): line for line in axes.get_lines()}
    gap = np.isnan(np.asarray(lines["person, d"].get_ydata()))
    assert gap.sum() == 100
    assert np.array_equal(lines["goal, e"].get_ydata(), np.hypot(*(made_up.position - [0.0, 0.6]).T))
    level = {
        (float(line.get_ydata()[0]), line.get_linestyle()): to_hex(line.get_color())
        for line in axes.get_lines()
        if len(line.get_ydata()) == 2 and line.get_linestyle() != "-"
    }
    person, disc = (to_hex(lines[f"{name}, d"].get_color()) for name in ("person", "disc"))
    assert level == {(2.1, "--"): person, (0.8, ":"): person, (0.8, "--"): disc, (0.4, ":"): disc}


def test_arrival_is_marked_with_its_time():
    axes = plotting.distances(made_up_run(DISC)).axes[0]
    assert [text.get_text().strip() for text in axes.texts] == ["arrival 5.50 s"]
    assert not plotting.distances(made_up_run(DISC, arrived=False)).axes[0].texts


def test_of_many_obstacles_only_the_closest_have_names():
    made_up = made_up_run(*crowd(45))
    figure = plotting.distances(made_up)
    words = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    named = {int(word.split()[1].rstrip(",")) - 1 for word in words if word.startswith("person")}
    assert named == set(np.argsort(made_up.min_clearance)[:6].tolist())
    assert "others, d" in words


def test_accumulated_loss_ends_at_the_energy_of_the_run(run):
    for trajectory in (run, made_up_run()):
        loss = plotting.energy(trajectory).axes[-1].get_lines()[0].get_ydata()
        assert loss[0] == 0.0
        assert np.all(np.diff(loss) >= 0.0)
        assert loss[-1] == pytest.approx(trajectory.energy, rel=LOSS_ROUNDING)


def test_lyapunov_function_has_gaps_in_critical_regions():
    made_up = made_up_run()
    values = made_up.lyapunov.copy()
    values[200:260] = np.nan
    axes = plotting.lyapunov(dataclasses.replace(made_up, lyapunov=values)).axes[0]
    assert np.isnan(axes.get_lines()[0].get_ydata()).sum() == 60
    assert axes.get_yscale() == "log"
    assert "in a critical region" in [text.get_text() for text in axes.figure.legends[0].get_texts()]


def test_runs_with_nothing_to_show_are_drawn(tmp_path):
    absent = nav.Human.from_path([100.0, 101.0], [[0.0, 9.0], [1.0, 9.0]], **WALKING)
    alone = [made_up_run(), nav.simulate(scene(absent), LAW)]
    for made_up in alone:
        for function in (plotting.paths, plotting.time_sequence, plotting.distances, plotting.energy):
            function(made_up).savefig(tmp_path / "picture.png")
        undefined = dataclasses.replace(made_up, lyapunov=np.full(len(made_up.time), np.nan))
        plotting.lyapunov(undefined).savefig(tmp_path / "picture.png")
        plotting.layout(made_up.scenario).savefig(tmp_path / "picture.png")
    assert np.isinf(alone[1].min_distance[0])


# ---- fields -------------------------------------------------------------------------------------------


def test_arrows_point_along_the_force_and_color_tells_its_magnitude():
    field = made_up_field()
    figure = plotting.force_field(field, scene(DISC))
    arrows = next(found for found in figure.axes[0].collections if type(found).__name__ == "Quiver")
    magnitude = np.hypot(*field.total.T)
    shown = magnitude > 0.0
    assert 0 < shown.sum() < len(magnitude)
    assert np.array_equal(arrows.get_array(), magnitude[shown])
    length = np.hypot(arrows.U, arrows.V)
    assert np.ptp(length) < ROUNDING
    turn = arrows.U * field.total[shown, 1] - arrows.V * field.total[shown, 0]
    assert np.abs(turn / magnitude[shown]).max() < ROUNDING


def test_critical_regions_are_blank_in_the_valley():
    figure = plotting.potential_valley(made_up_field(), scene(DISC), term="potential")
    figure.draw_without_rendering()
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())
    axes = figure.axes[0]
    colors = []
    for place in ((2.45, 1.15), (1.0, 0.0)):  # inside the critical region beside the body; in the free region
        column, row = axes.transData.transform(place)
        colors.append(pixels[pixels.shape[0] - 1 - round(row), round(column), :3].tolist())
    assert colors[0] == [255, 255, 255]
    assert colors[1] != [255, 255, 255]
    assert [type(axes).__name__ for axes in figure.axes] == ["Axes", "Axes3D", "Axes"]


def test_real_fields_are_drawn():
    scenario = scene(DISC, RECTANGLE)
    x, y = np.meshgrid(np.linspace(-0.2, 4.2, 45), np.linspace(-1.0, 2.4, 35))
    field = nav.laws.force_field(LAW, scenario, position=np.column_stack([x.ravel(), y.ravel()]))
    for term in ("total", "attractive", "repulsive", "detour"):
        assert plotting.force_field(field, scenario, term=term).axes
    for term in ("potential", "repulsive"):
        assert plotting.potential_valley(field, scenario, term=term).axes


@pytest.mark.parametrize("function", [plotting.force_field, plotting.potential_valley])
def test_fields_that_cannot_be_drawn_are_refused(function):
    field = made_up_field()
    part = nav.laws.ForceField(*(values[:-1] for values in field))
    with pytest.raises(InvalidParameterError, match=r"field\.position must form a complete grid"):
        function(part, scene(DISC))
    twice = nav.laws.ForceField(*(np.concatenate([values[:-1], values[:1]]) for values in field))
    with pytest.raises(InvalidParameterError, match=r"field\.position must form a complete grid"):
        function(twice, scene(DISC))
    with pytest.raises(InvalidParameterError, match="field must hold at least one point"):
        function(nav.laws.ForceField(*(values[:0] for values in field)), scene(DISC))
    with pytest.raises(InvalidParameterError, match="field must be a ForceField"):
        function(None, scene(DISC))
    with pytest.raises(InvalidParameterError, match="scenario must be a Scenario"):
        function(field, None)
    with pytest.raises(InvalidParameterError, match="term must be"):
        function(field, scene(DISC), term="friction")
    with pytest.raises(ShapeError, match=r"obstacle_position must have shape \(1, 2\), got \(2,\)"):
        function(field, scene(DISC), obstacle_position=(1.0, 1.0))
    flat = made_up_field(hole=None)
    with pytest.raises(InvalidParameterError, match="field must hold a"):
        function(flat, scene(DISC), term="repulsive")


# ---- studies ------------------------------------------------------------------------------------------


def test_clearance_curve_tells_the_share_of_runs_with_contact():
    values = np.concatenate([np.full(3, -0.05), np.linspace(0.1, 0.5, 5), [np.inf, np.inf]])
    figure = plotting.clearances({"all": values})
    curve = next(line for line in figure.axes[0].get_lines() if len(line.get_xdata()) > 5)
    x, share = np.asarray(curve.get_xdata()), np.asarray(curve.get_ydata())
    assert share[x < 0.0].max() == 0.3
    assert share.max() == 0.8  # those who met nobody count, but are never reached
    assert figure.legends[0].get_texts()[0].get_text() == "all: 10 runs, 3 with contact"


def test_summary_of_a_batch_can_be_drawn_as_it_is():
    summary = nav.simulate_batch([scene(DISC), scene(PERSON)], LAW, {"attractive_gain": [3.0, 4.0]})
    clearances = plotting.clearances({"batch": summary})
    assert clearances.legends[0].get_texts()[0].get_text().startswith("batch: 4 runs")
    outcomes = plotting.outcomes({"batch": summary})
    assert sum(bar.get_width() for bar in outcomes.axes[0].patches) == pytest.approx(1.0, abs=ROUNDING)


def test_bars_of_outcomes_fill_the_whole_and_split_contacts():
    words = {"off": ["arrived", "collided", "collided", "stopped"], "full": ["arrived"] * 3 + ["timed_out"]}
    moving = {"off": [0, 2, 0, 0], "full": [0] * 4}
    standing = {"off": [0, 1, 1, 0], "full": [0] * 4}
    axes = plotting.outcomes(words, contacts_moving=moving, contacts_standing=standing).axes[0]
    bars = {container.get_label(): [bar.get_width() for bar in container] for container in axes.containers}
    assert bars == {
        "arrived": [0.25, 0.75],
        "timed out": [0.0, 0.25],
        "stopped": [0.25, 0.0],
        "contact, robot standing": [0.25, 0.0],
        "contact, robot moving": [0.25, 0.0],
    }


def test_wrong_groups_are_named():
    with pytest.raises(InvalidParameterError, match="clearances must be a mapping"):
        plotting.clearances([0.1, 0.2])
    with pytest.raises(InvalidParameterError, match="an empty mapping"):
        plotting.clearances({})
    with pytest.raises(InvalidParameterError, match=r"clearances\['a'\] must be numbers without NaN"):
        plotting.clearances({"a": [0.1, np.nan]})
    with pytest.raises(InvalidParameterError, match="at least one finite"):
        plotting.clearances({"a": [np.inf]})
    with pytest.raises(ShapeError, match=r"clearances\['a'\]"):
        plotting.clearances({"a": [[0.1]]})
    with pytest.raises(InvalidParameterError, match=r"outcomes\['a'\] must hold only .*, got 'lost'"):
        plotting.outcomes({"a": ["arrived", "lost"]})
    with pytest.raises(InvalidParameterError, match="contacts_standing must be given together"):
        plotting.outcomes({"a": ["arrived"]}, contacts_moving={"a": [0]})
    with pytest.raises(InvalidParameterError, match="contacts_moving must hold the group 'a'"):
        plotting.outcomes({"a": ["arrived"]}, contacts_moving={}, contacts_standing={})
    with pytest.raises(ShapeError, match=r"contacts_moving\['a'\]"):
        plotting.outcomes({"a": ["arrived"]}, contacts_moving={"a": [0, 1]}, contacts_standing={"a": [0]})


# ---- the real thing -----------------------------------------------------------------------------------


def test_real_runs_are_drawn_by_every_function(tmp_path, run):
    figures = [
        plotting.paths([run, nav.evaluate(run.scenario, LAW).nominal], labels=["run", "free"]),
        plotting.time_sequence(run),
        plotting.distances(run),
        plotting.energy(run),
        plotting.lyapunov(run),
    ]
    for index, figure in enumerate(figures):
        figure.savefig(tmp_path / f"{index}.png")
    assert len(list(tmp_path.iterdir())) == len(figures)


def test_colors_of_runs_and_obstacles_can_be_told_apart():
    colors = [*style.RUN_COLORS[:3], *style.PERSON_COLORS[:2], *style.STATIONARY_COLORS[:2]]
    rgb = np.array([matplotlib.colors.to_rgb(color) for color in colors])
    # What a person without green-sensitive cones sees, by the matrix of Vienot et al. (1999) on linear light.
    linear = rgb**2.2
    mixed = linear @ np.array([[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1.0]]).T
    seen = np.clip(mixed, 0.0, 1.0) ** (1.0 / 2.2)
    nearest = min(float(np.abs(first - second).max()) for first, second in itertools.combinations(seen, 2))
    assert nearest > 0.08
