"""Maps of virtual forces and of the Lyapunov function."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.navigation.laws.forces import ForceField
from hrsafety.plotting import inputs, notes, shapes, style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap
    from matplotlib.figure import Figure
    from mpl_toolkits.mplot3d import Axes3D  # type: ignore[import-untyped]  # no stubs

    from hrsafety.navigation.scenario import Scenario

__all__ = ["force_field", "potential_valley"]

Array = npt.NDArray[np.float64]
ForceTerm = Literal["total", "attractive", "repulsive", "detour", "stabilizing"]

FORCE_TERMS = ("total", "attractive", "repulsive", "detour", "stabilizing")
MOST_ARROWS = 34  # in x or y; a finer grid is thinned
ARROW_LENGTH = 0.78  # of the spacing of the arrows
ARROW_QUANTILE = 0.99  # forces grow without bound towards a critical region: the color scale ends here
RIM_QUANTILE = 0.2  # so that the rim of a critical region is flat instead of showing the grid
LOW_QUANTILE = 0.005  # where a color scale begins, unless the decades are used up before
LEVELS = 25
SURFACE_ZOOM = 0.95
LOGARITHMIC_DECADES = 2.0  # below the highest value; the height of a surface is linear further down
INSIDE_COLOR = (0.78, 0.78, 0.78, 1.0)  # of critical regions, where nothing is defined
DECADES = 3.0  # most decades of a color scale
GRID_TOLERANCE = 1e-9  # m, below which coordinates of a grid are equal


class PointGrid(NamedTuple):
    """Axes of a rectangular grid, and the place of each point in it."""

    x: Array
    y: Array
    row: npt.NDArray[np.int64]
    column: npt.NDArray[np.int64]

    def arrange(self, values: Array) -> Array:
        """Return values of points as an array over (y, x)."""
        arranged = np.full((len(self.y), len(self.x), *values.shape[1:]), np.nan)
        arranged[self.row, self.column] = values
        return arranged


def checked_grid(field: ForceField) -> PointGrid:
    """Return the rectangular grid that the points of a field form."""
    position = checked_field(field).position
    rounded = np.round(position / GRID_TOLERANCE) * GRID_TOLERANCE
    x, column = np.unique(rounded[:, 0], return_inverse=True)
    y, row = np.unique(rounded[:, 1], return_inverse=True)
    complete = len(np.unique(row * len(x) + column)) == len(position) == len(x) * len(y)
    if not complete or min(len(x), len(y)) < 2:
        shown = f"{len(position)} points with {len(x)} different x and {len(y)} different y"
        raise InvalidParameterError("field.position", "form a complete grid of at least 2 x 2 points", shown)
    return PointGrid(x, y, row, column)


def checked_field(field: object) -> ForceField:
    """Return ``field`` if it is a force field with points."""
    if not isinstance(field, ForceField):
        raise InvalidParameterError("field", "be a ForceField", Shown(type(field).__name__))
    if len(field.position) == 0:
        raise InvalidParameterError("field", "hold at least one point", Shown("an empty field"))
    return field


@notes.picture
def force_field(
    field: ForceField,
    scenario: Scenario,
    *,
    term: ForceTerm = "total",
    obstacle_position: npt.ArrayLike | None = None,
    title: str | None = None,
) -> Figure:
    """Draw virtual forces as arrows: direction by the arrow, magnitude by color.

    All arrows have one length; the logarithmic color scale tells the magnitude in N. It ends
    at the 99 % quantile, since forces grow without bound towards a critical region, and
    covers at most three decades; pointed ends of the scale say that there is more. Of a grid
    with more than 34 points in a row only every second, third, ... point is drawn. Points
    without a force have no arrow.

    Parameters
    ----------
    field : ForceField
        Forces on a rectangular grid.
    scenario : Scenario
        Goal and obstacles, drawn with their regions.
    term : {"total", "attractive", "repulsive", "detour", "stabilizing"}
        Which force.
    obstacle_position : array_like, shape (m, 2), or None
        Where the obstacles were at the time of the field, in m; where they are at time 0 when
        ``None``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, with equal scales in m.

    Raises
    ------
    InvalidParameterError
        If the points form no rectangular grid, the term is unknown, or it is zero everywhere.
    ShapeError
        If there is not one position for each obstacle.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> scene = scenarios.configuration("c1")
    >>> x, y = np.meshgrid(np.linspace(-0.2, 4.0, 22), np.linspace(-0.4, 1.6, 11))
    >>> field = nav.laws.force_field(nav.VirtualForceField(), scene, position=np.column_stack([x.ravel(), y.ravel()]))
    >>> len(plotting.force_field(field, scene).axes)  # the map and its color scale
    2
    """
    from matplotlib.colors import LogNorm

    grid = checked_grid(field)
    scenario = inputs.checked_scenario(scenario)
    places = _checked_places(scenario, obstacle_position)
    if term not in FORCE_TERMS:
        raise InvalidParameterError("term", f"be one of {', '.join(FORCE_TERMS)}", term)
    stride = -(-max(len(grid.x), len(grid.y)) // MOST_ARROWS)
    force = grid.arrange(getattr(field, term))[::stride, ::stride].reshape(-1, 2)
    where = np.stack(np.meshgrid(grid.x[::stride], grid.y[::stride]), axis=-1).reshape(-1, 2)
    magnitude = np.hypot(*force.T)
    shown = np.isfinite(magnitude) & (magnitude > 0.0)
    if not shown.any():
        raise InvalidParameterError("field", f"hold a {term} force somewhere", Shown("zero or NaN everywhere"))
    spacing = stride * min(float(np.diff(grid.x).min()), float(np.diff(grid.y).min()))
    limits = _limits(grid, spacing / 2.0)
    figure = style.new_figure(
        style.scene_height(limits, legend_rows=2, titled=title is not None, color_bar=True),
        title=title,
        compressed=True,
    )
    axes = figure.subplots()
    style.frame_scene(axes, limits)
    _draw_scene(axes, scenario, places, filled=True)
    direction = force[shown] / magnitude[shown, np.newaxis] * (ARROW_LENGTH * spacing)
    look: style.Properties = {
        "angles": "xy",
        "scale_units": "xy",
        "scale": 1.0,
        "pivot": "mid",
        "width": 0.0032,
        "zorder": 5.0,
    }
    low, high = _color_limits(magnitude[shown], float(np.quantile(magnitude[shown], ARROW_QUANTILE)))
    arrows = axes.quiver(*where[shown].T, *direction.T, magnitude[shown], **look)
    arrows.set(cmap=_arrow_colors(), norm=LogNorm(low, high))
    bar = figure.colorbar(arrows, ax=axes, extend="both", pad=0.02, shrink=0.9)
    style.set_log_ticks(bar, low, high)
    bar.set_label(f"{term} force (N)")
    style.legend_below(figure, _scene_handles(scenario, places, limits), columns=5)
    return figure


def _scene_handles(scenario: Scenario, places: Array, limits: style.Limits) -> list[Artist]:
    """Return the legend of the obstacles that are present and, where it is in view, the goal."""
    from matplotlib.lines import Line2D

    star: style.Properties = {"marker": "*", "color": style.GOAL_COLOR, "markersize": 12, "linestyle": "none"}
    present = np.flatnonzero(np.isfinite(places).all(axis=1)).tolist()
    goal_in_view = all(low <= x <= high for x, (low, high) in zip(scenario.goal, limits, strict=True))
    goals = [Line2D([], [], label="goal", **star)] if goal_in_view else []
    return [*goals, *shapes.obstacle_handles(scenario.obstacles, regions=len(present) > 0, shown=present)]


def _checked_places(scenario: Scenario, obstacle_position: npt.ArrayLike | None) -> Array:
    """Return one position for each obstacle, shape (m, 2)."""
    count = len(scenario.obstacles)
    if obstacle_position is None:
        first = [shapes.first_position(obstacle) or (np.nan, np.nan) for obstacle in scenario.obstacles]
        return np.asarray(first, dtype=np.float64).reshape(count, 2)
    places = np.asarray(obstacle_position, dtype=np.float64)
    if places.shape != (count, 2):
        raise ShapeError("obstacle_position", f"({count}, 2)", places.shape)
    return places


def _limits(grid: PointGrid, margin: float) -> style.Limits:
    """Return the extent of a grid with a margin, in m."""
    x = (float(grid.x[0]) - margin, float(grid.x[-1]) + margin)
    return x, (float(grid.y[0]) - margin, float(grid.y[-1]) + margin)


def _draw_scene(axes: Axes, scenario: Scenario, places: Array, *, filled: bool) -> None:
    """Draw obstacles with the borders of their regions, and the goal."""
    for obstacle, look, place in zip(scenario.obstacles, shapes.looks(scenario.obstacles), places, strict=True):
        if np.isfinite(place).all():
            shapes.add(axes, shapes.region_patches(obstacle, place, look.color if filled else "black", filled=filled))
            shapes.add_obstacle(axes, obstacle, place, look.color, regions=False)
    axes.plot(*scenario.goal, "*", markersize=14, color=style.GOAL_COLOR, markeredgecolor="white", zorder=6.0)


def _arrow_colors() -> Colormap:
    """Return a color map that is dark enough for thin arrows on white at both ends."""
    from matplotlib import colormaps
    from matplotlib.colors import ListedColormap

    return ListedColormap(colormaps["plasma"](np.linspace(0.0, 0.82, 256)))


def _rim(values: Array) -> float:
    """Return a value over (y, x) that most points beside a critical region exceed, else the largest."""
    blank = np.pad(np.isnan(values), 1)
    beside = blank[:-2, 1:-1] | blank[2:, 1:-1] | blank[1:-1, :-2] | blank[1:-1, 2:]
    rim = values[beside & ~np.isnan(values)]
    return float(np.quantile(rim, RIM_QUANTILE)) if len(rim) else float(np.nanmax(values))


def _color_limits(values: Array, high: float) -> tuple[float, float]:
    """Return the ends of a logarithmic scale of few decades for positive values."""
    low = max(float(np.quantile(values, LOW_QUANTILE)), high / 10.0**DECADES)
    return (low, high) if low < high else (low / 2.0, low * 2.0)


@notes.picture
def potential_valley(
    field: ForceField,
    scenario: Scenario,
    *,
    term: Literal["potential", "repulsive"] = "potential",
    obstacle_position: npt.ArrayLike | None = None,
    title: str | None = None,
) -> Figure:
    """Draw the valley that leads around obstacles, as contours and as a surface.

    Critical regions, where the field is not defined, are blank, and grey tops of the surface. The
    color scale is logarithmic and covers at most three decades; the height of the surface is
    logarithmic over two, and linear below. Both end at a value that four of five grid points beside a
    critical region exceed, since the field grows without bound there; what is higher is drawn
    at the upper end, what is lower, or zero, at the lower end.

    Parameters
    ----------
    field : ForceField
        Field on a rectangular grid.
    scenario : Scenario
        Goal and obstacles.
    term : {"potential", "repulsive"}
        The Lyapunov function in N^2, or the magnitude of the repulsive force of all obstacles
        in N.
    obstacle_position : array_like, shape (m, 2), or None
        Where the obstacles were at the time of the field, in m; where they are at time 0 when
        ``None``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture.

    Raises
    ------
    InvalidParameterError
        If the points form no rectangular grid, the term is unknown, or it is zero everywhere.
    ShapeError
        If there is not one position for each obstacle.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> scene = scenarios.configuration("c1")
    >>> x, y = np.meshgrid(np.linspace(1.4, 3.6, 34), np.linspace(-0.4, 1.6, 31))
    >>> field = nav.laws.force_field(nav.VirtualForceField(), scene, position=np.column_stack([x.ravel(), y.ravel()]))
    >>> figure = plotting.potential_valley(field, scene, term="repulsive")
    """
    grid = checked_grid(field)
    scenario = inputs.checked_scenario(scenario)
    places = _checked_places(scenario, obstacle_position)
    if term not in {"potential", "repulsive"}:
        raise InvalidParameterError("term", "be potential or repulsive", term)
    values = grid.arrange(field.potential if term == "potential" else np.hypot(*field.repulsive.T))
    positive = values[np.isfinite(values) & (values > 0.0)]
    if len(positive) == 0:
        raise InvalidParameterError("field", f"hold a {term} term somewhere", Shown("zero or NaN everywhere"))
    low, high = _color_limits(positive, _rim(values))
    levels = np.geomspace(low, high, LEVELS)
    label = "Lyapunov function V (N²)" if term == "potential" else "repulsive force (N)"
    height = 1.4 + 3.4 * min(max(float(np.ptp(grid.y) / np.ptp(grid.x)), 0.7), 1.3)
    figure = style.new_figure(height + (0.4 if title is not None else 0.0), title=title)
    grid_of_axes = figure.add_gridspec(1, 2, width_ratios=(1.0, 1.0))
    _draw_contours(figure.add_subplot(grid_of_axes[0]), grid, values, levels)
    _draw_scene(figure.axes[0], scenario, places, filled=False)
    surface = figure.add_subplot(grid_of_axes[1], projection="3d")
    _draw_surface(surface, grid, values, levels)
    bar = figure.colorbar(figure.axes[0].collections[0], ax=figure.axes[:2], location="bottom", aspect=45, pad=0.03)
    style.set_log_ticks(bar, levels[0], levels[-1])
    bar.set_label(label)
    short = "V (N²)" if term == "potential" else "force (N)"
    surface.text2D(1.0, 0.9, short, transform=surface.transAxes, ha="right")
    return figure


def _draw_contours(axes: Axes, grid: PointGrid, values: Array, levels: Array) -> None:
    """Draw filled contours."""
    from matplotlib.colors import LogNorm

    style.frame_scene(axes, _limits(grid, 0.0))
    look: style.Properties = {
        "levels": levels,
        "norm": LogNorm(levels[0], levels[-1]),
        "extend": "both",
        "cmap": "viridis",
    }
    axes.contourf(grid.x, grid.y, np.maximum(values, levels[0] / 2.0), zorder=0.5, **look)
    axes.contour(grid.x, grid.y, values, levels=levels[::3], colors="white", linewidths=0.5, alpha=0.7, zorder=0.6)
    axes.grid(visible=False)


def _draw_surface(axes: Axes3D, grid: PointGrid, values: Array, levels: Array) -> None:
    """Draw a surface whose height is linear near zero and logarithmic beyond, with ticks of the values.

    A height that is logarithmic throughout would fall from the border of an active region without end, and show
    the grid as teeth of a curtain. Critical regions are grey tops: without them the walls would be torn where the
    grid meets their borders.
    """
    from matplotlib import colormaps

    low, high = np.log10(levels[[0, -1]])
    inside = np.isnan(values)
    filled = np.where(inside, levels[-1], np.clip(values, 0.0, levels[-1]))
    colors = colormaps["viridis"]((np.log10(np.maximum(filled, levels[0])) - low) / (high - low))
    cells = inside[:-1, :-1] & inside[1:, :-1] & inside[:-1, 1:] & inside[1:, 1:]
    colors[:-1, :-1][cells] = INSIDE_COLOR
    x, y = np.meshgrid(grid.x, grid.y)
    softening = levels[-1] / 10.0**LOGARITHMIC_DECADES
    look: style.Properties = {"rstride": 1, "cstride": 1, "linewidth": 0.0, "antialiased": False, "shade": True}
    axes.plot_surface(x, y, np.arcsinh(filled / softening), facecolors=colors, **look)
    ticks, names = style.log_ticks(softening, levels[-1])
    axes.set_zticks(np.arcsinh(np.array([0.0, *ticks]) / softening), ["0", *names])
    axes.locator_params(axis="x", nbins=4)
    axes.locator_params(axis="y", nbins=4)
    axes.set_xlabel("x (m)", labelpad=8.0)
    axes.set_ylabel("y (m)", labelpad=8.0)
    span = np.ptp(grid.x), np.ptp(grid.y)
    axes.set_box_aspect((span[0], span[1], 0.55 * max(span)), zoom=SURFACE_ZOOM)
    axes.view_init(elev=40.0, azim=-60.0)
