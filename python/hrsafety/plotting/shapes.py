"""Obstacles on axes: names, colors, bodies and regions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.obstacles.moving import Human, MovingDisc
from hrsafety.navigation.obstacles.moving_rectangle import Box, Mobile, MovingRectangle
from hrsafety.navigation.obstacles.standing import Rectangle
from hrsafety.navigation.replays import scanner_of
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.plotting import style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.patches import Patch

Array = npt.NDArray[np.float64]
Robot = HolonomicRobot | DifferentialDriveRobot

LEAST_SPEED = 0.02  # m/s, below which a robot that can move to any side points anywhere
MOST_COLORS = 6  # more obstacles than this cannot be told apart by color
NOTE = "region-note"
SCAN: style.Properties = {"linestyle": "none", "marker": ".", "markersize": 2.5, "color": "#1aa7ff"}
"""Look of the points of a scan, as players have it."""
_ARC_POINTS = 17


class Look(NamedTuple):
    """How one obstacle is shown."""

    name: str
    color: str


def kind(obstacle: Obstacle) -> str:
    """Return the word for an obstacle."""
    if isinstance(obstacle, Human):
        return "person"
    if isinstance(obstacle, MovingDisc):
        return "moving disc"
    if isinstance(obstacle, MovingRectangle):
        return "moving rectangle"
    return "rectangle" if isinstance(obstacle, Rectangle) else "disc"


def is_mobile(obstacle: Obstacle) -> bool:
    """Return whether an obstacle belongs to a class that can move."""
    return isinstance(obstacle, Mobile)


def looks(obstacles: Sequence[Obstacle]) -> list[Look]:
    """Return name and color of each obstacle; many obstacles share those of their kind."""
    kinds = [kind(obstacle) for obstacle in obstacles]
    many = len(obstacles) > MOST_COLORS
    total, seen = Counter(kinds), Counter[str]()
    stationary = moving = 0
    palette: Sequence[str]
    result = []
    for word in kinds:
        if word == "person":
            palette, index = style.PERSON_COLORS, seen[word]
        elif word.startswith("moving"):
            palette, index = style.MOVING_COLORS, moving
            moving += 1
        else:
            palette, index = style.STATIONARY_COLORS, stationary
            stationary += 1
        seen[word] += 1
        name = f"{word} {seen[word]}" if total[word] > 1 else word
        result.append(Look(name, palette[0] if many else palette[index % len(palette)]))
    return result


def first_position(obstacle: Obstacle) -> tuple[float, float] | None:
    """Return where an obstacle is at time 0, in m, or ``None`` if its recording does not hold that time."""
    if isinstance(obstacle, Mobile) and obstacle.path is not None:
        time, places = obstacle.path
        if not time[0] <= 0.0 <= time[-1]:
            return None
        x, y = np.asarray(places).T
        return float(np.interp(0.0, time, x)), float(np.interp(0.0, time, y))
    return obstacle.start if isinstance(obstacle, Human) else center(obstacle)


def center(obstacle: Obstacle) -> tuple[float, float]:
    """Return the center of a disc or rectangle, in m."""
    place: tuple[float, float] = obstacle.center  # type: ignore[attr-defined]  # all but people have one
    return place


def rectangle_outline(rectangle: Box, center: npt.ArrayLike, offset: float = 0.0) -> Array:
    """Return the points at a distance ``offset`` from the contour of a rectangle, shape (n, 2)."""
    arcs = []
    for quarter, (sign_x, sign_y) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        angle = np.linspace(0.0, np.pi / 2.0, _ARC_POINTS if offset > 0.0 else 1) + quarter * np.pi / 2.0
        corner = np.array([sign_x * rectangle.length, sign_y * rectangle.width]) / 2.0
        arcs.append(corner + offset * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    cosine, sine = np.cos(rectangle.heading), np.sin(rectangle.heading)
    turned: Array = np.concatenate(arcs) @ np.array([[cosine, sine], [-sine, cosine]])
    return turned + np.asarray(center, dtype=np.float64)


def body(obstacle: Obstacle, position: npt.ArrayLike, **look: Any) -> Patch:
    """Return the patch of an obstacle's body at a position in m."""
    from matplotlib.patches import Circle, Polygon

    if isinstance(obstacle, Box):
        return Polygon(rectangle_outline(obstacle, position), closed=True, **look)
    x, y = np.asarray(position, dtype=np.float64)
    return Circle((x, y), obstacle.radius, **look)  # type: ignore[attr-defined]  # round obstacles have one


def least_half_width(obstacle: Obstacle) -> float:
    """Return the radius of the largest disc about its center that fits into an obstacle, in m."""
    if isinstance(obstacle, Box):
        return 0.5 * min(obstacle.length, obstacle.width)
    radius: float = obstacle.radius  # type: ignore[attr-defined]  # round obstacles have one
    return radius


def move(patch: Patch, position: npt.ArrayLike, angle: float = 0.0) -> None:
    """Put a patch on axes that was made at the origin at a position in m, turned by an angle in rad."""
    from matplotlib.patches import Circle
    from matplotlib.transforms import Affine2D

    x, y = np.asarray(position, dtype=np.float64)
    if isinstance(patch, Circle):
        patch.set_center((x, y))
    elif patch.axes is not None:
        patch.set_transform(Affine2D().rotate(angle).translate(x, y) + patch.axes.transData)


def region(obstacle: Obstacle, position: npt.ArrayLike, radius: float, **look: Any) -> Patch:
    """Return the patch of a region: a disc around the center, or the rounded contour of a rectangle."""
    from matplotlib.patches import Circle, Polygon

    if isinstance(obstacle, Box):
        return Polygon(rectangle_outline(obstacle, position, radius), closed=True, **look)
    x, y = np.asarray(position, dtype=np.float64)
    return Circle((x, y), radius, **look)


def robot(body: Robot, position: npt.ArrayLike, heading: float = 0.0, **look: Any) -> Patch:
    """Return the patch of a robot at a position in m and a heading in rad: its footprint, or its disc."""
    from matplotlib.patches import Circle, Polygon

    place = np.asarray(position, dtype=np.float64)
    if body.footprint is None:
        return Circle((place[0], place[1]), body.radius, **look)
    return Polygon(turned(body.footprint.corners, heading) + place, closed=True, **look)


def turned(points: npt.ArrayLike, angle: float) -> Array:
    """Return points, shape (n, 2), turned about the origin by an angle in rad."""
    cosine, sine = np.cos(angle), np.sin(angle)
    found: Array = np.asarray(points, dtype=np.float64) @ np.array([[cosine, sine], [-sine, cosine]])
    return found


def look_angle(run: Trajectory, row: int, robot: int = 0) -> float:
    """Return where a robot points at a row of a run, in rad; NaN for a disc that stands and can move to any side."""
    scene: Any = run.scenario
    body = scene.robots[robot].body if hasattr(scene, "robots") else scene.robot
    if isinstance(body, HolonomicRobot) and body.footprint is None:
        x, y = run.robots[robot].velocity[row]
        return float(np.arctan2(y, x)) if np.hypot(x, y) > LEAST_SPEED else float("nan")
    return float(run.robot_heading[row, robot])


def scan_of(run: Trajectory) -> Callable[[int], Array] | None:
    """Return what gives the points that the lidar of a robot hits at a row, shape (n, 2) in m; ``None`` without one."""
    lidar = scanner_of(run)
    if lidar is None:
        return None

    def points(row: int) -> Array:
        ranges = lidar.ranges(row)
        angles = run.heading[row] + np.linspace(lidar.start_angle, lidar.end_angle, len(ranges))
        hit = (ranges > 0.0) & (ranges < lidar.range_max)
        found: Array = run.position[row] + (ranges * np.stack([np.cos(angles), np.sin(angles)])).T[hit]
        return found

    return points


def scene_points(obstacles: Iterable[Obstacle]) -> list[Array]:
    """Return corners of boxes around everything that stands, so that a view can hold the whole scene."""
    return [
        np.asarray(body(each, center(each)).get_extents().get_points()) for each in obstacles if not is_mobile(each)
    ]


def region_radii(obstacle: Obstacle) -> tuple[float, float]:
    """Return active and critical radius of an obstacle that belongs to a scenario, in m."""
    return obstacle.active_radius, obstacle.critical_radius  # type: ignore[return-value]  # filled in by the scenario


def region_patches(obstacle: Obstacle, position: npt.ArrayLike, color: str, *, filled: bool = True) -> list[Patch]:
    """Return the patches of the active (light) and the critical (darker) region."""
    patches = []
    active, critical = region_radii(obstacle)
    shown = ((active, style.ACTIVE_ALPHA, "--", 1.0), (critical, style.CRITICAL_ALPHA, ":", 1.1))
    for radius, alpha, dashes, zorder in shown:
        if filled:
            face: style.Properties = {"facecolor": color, "alpha": alpha, "edgecolor": "none"}
            patches.append(region(obstacle, position, radius, zorder=zorder, **face))
        edge: style.Properties = {"edgecolor": color, "linestyle": dashes, "linewidth": 0.9, "alpha": 0.75}
        patches.append(region(obstacle, position, radius, fill=False, zorder=zorder + 0.05, **edge))
    return patches


def add_regions(axes: Axes, obstacle: Obstacle, position: npt.ArrayLike, color: str, *, filled: bool = True) -> None:
    """Draw the regions of an obstacle; of one that covers all of the view a note takes the place."""
    patches = region_patches(obstacle, position, color, filled=filled)
    parts = len(patches) // 2
    corners = np.array([(x, y) for x in axes.get_xlim() for y in axes.get_ylim()]) - np.asarray(position)
    if isinstance(obstacle, Box):
        sides = 0.5 * np.array([obstacle.length, obstacle.width])
        corners = np.maximum(np.abs(turned(corners, -obstacle.heading)) - sides, 0.0)
    farthest = float(np.hypot(*corners.T).max())
    covering = []
    for name, each, radius in zip(
        ("active", "critical"), (patches[:parts], patches[parts:]), region_radii(obstacle), strict=True
    ):
        if farthest < radius:
            covering.append(name)
        else:
            add(axes, each)
    if covering and not any(each.get_gid() == NOTE for each in axes.texts):
        words = f"all of this is in the {' and '.join(covering)} region of a {kind(obstacle)}"
        look: style.Properties = {"ha": "right", "va": "top", "fontsize": style.SMALL_FONT_SIZE, "zorder": 8.0}
        back = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.5}
        axes.text(0.99, 0.99, words, transform=axes.transAxes, color=style.NEUTRAL, bbox=back, gid=NOTE, **look)


def add(axes: Axes, patches: Iterable[Patch]) -> None:
    """Add patches without changing the view."""
    for patch in patches:
        axes.add_patch(patch)


def add_obstacle(
    axes: Axes, obstacle: Obstacle, position: npt.ArrayLike, color: str, *, regions: bool, edge: str | None = None
) -> None:
    """Draw an obstacle, and its regions if wanted, at a position in m."""
    if not np.all(np.isfinite(np.asarray(position, dtype=np.float64))):
        return
    if regions:
        add_regions(axes, obstacle, position, color)
    zorder = 3.2 if is_mobile(obstacle) else 3.0
    look: style.Properties = {
        "facecolor": color,
        "edgecolor": edge or "white",
        "linewidth": 1.6 if edge else 0.8,
        "zorder": zorder,
    }
    add(axes, [body(obstacle, position, **look)])


def add_robot(
    axes: Axes,
    scenario: Scenario,
    position: npt.ArrayLike,
    color: str,
    *,
    heading: float = 0.0,
    filled: bool = True,
    **more: Any,
) -> None:
    """Draw the robot at a position in m and a heading in rad."""
    face = color if filled else "none"
    look: style.Properties = {
        "facecolor": face,
        "edgecolor": "white" if filled else color,
        "linewidth": 1.0,
        "zorder": 4.0,
    }
    axes.add_patch(robot(scenario.robot, position, heading, **(look | more)))


def add_start_and_goal(axes: Axes, scenario: Scenario, starts: Iterable[tuple[float, float]] | None = None) -> None:
    """Draw where runs start, the goal and its tolerance circle."""
    from matplotlib.patches import Circle

    for x, y in starts or [scenario.start]:
        axes.plot(x, y, "o", markersize=7, markerfacecolor="white", markeredgecolor="black", zorder=5.7)
    look: style.Properties = {"facecolor": style.GOAL_COLOR, "alpha": 0.25, "zorder": 2.0}
    axes.add_patch(Circle(scenario.goal, scenario.arrival_tolerance, **look))
    axes.plot(*scenario.goal, "*", markersize=13, color=style.GOAL_COLOR, markeredgecolor="white", zorder=6.0)


def start_and_goal_handles() -> list[Artist]:
    """Return legend entries for start and goal."""
    from matplotlib.lines import Line2D

    start: style.Properties = {"marker": "o", "markerfacecolor": "white", "markeredgecolor": "black", "markersize": 7}
    goal: style.Properties = {"marker": "*", "color": style.GOAL_COLOR, "markersize": 12}
    return [
        Line2D([], [], linestyle="none", label="start", **start),
        Line2D([], [], linestyle="none", label="goal, tolerance", **goal),
    ]


def obstacle_handles(
    obstacles: Sequence[Obstacle], *, regions: bool, shown: Sequence[int] | None = None
) -> list[Artist]:
    """Return legend entries for the obstacles, all or those with certain indices, and their regions."""
    from matplotlib.patches import Patch

    entries: dict[str, str] = {}
    for index, (obstacle, look) in enumerate(zip(obstacles, looks(obstacles), strict=True)):
        if shown is None or index in shown:
            entries.setdefault(look.name if len(obstacles) <= MOST_COLORS else kind(obstacle), look.color)
    handles: list[Artist] = [Patch(facecolor=color, label=name) for name, color in entries.items()]
    if regions and obstacles:
        looks_of_regions = (("active region, $r_2$", style.ACTIVE_ALPHA, "--"), ("critical region, $r_3$", 0.45, ":"))
        for name, alpha, dashes in looks_of_regions:
            face: style.Properties = {"facecolor": (0.25, 0.25, 0.25, alpha), "linestyle": dashes}
            handles.append(Patch(edgecolor=style.NEUTRAL, label=name, **face))
    return handles
