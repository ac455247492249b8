"""The mass of a point of an arm by direction, drawn where the point stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hrsafety._arguments import instance, numbers
from hrsafety.arms import PointMasses
from hrsafety.errors import ShapeError
from hrsafety.plotting import notes, style
from hrsafety.plotting.inputs import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["mass_ellipse"]

VIEWS = {"side view": (0, 2), "top view": (0, 1)}
AXES = ("x", "y", "z")
ELLIPSE_SHARE = 0.28  # of the width of the arm that the circle of the ISO mass has as its radius
MOST_RADII = 2.0  # radii of that circle at which an outline is cut off
LEAST_GAP = 0.27  # of the largest radius in view that circles of the scale are apart
SCALE_COLOR = "#A0A0A0"
ANGLES = np.linspace(0.0, 2.0 * np.pi, 721)


@notes.picture
def mass_ellipse(skeleton: object, masses: PointMasses, *, title: str | None = None) -> Figure:
    """Draw an arm from the side and from above with the mass of a point by direction.

    The radius of the ellipse along a direction is proportional to the square root of the effective mass along it, as
    the grey circles show in kg; the dashed circle is the mass of ISO/TS 15066 at the same scale.

    Parameters
    ----------
    skeleton : array_like (n, 2, 3)
        Lines of the arm in m, of `hrsafety.arms.Arm.skeleton`.
    masses : PointMasses
        Of one point in one pose.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture; the warnings of the masses stand below it.

    Raises
    ------
    ShapeError
        If there are several poses or points.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import arms, plotting
    >>> arm, pose = arms.Arm.example(), {"shoulder": 0.4, "elbow": 1.4}
    >>> masses = arm.point_masses(pose, link="tool", direction=(1, 0, 0))
    >>> figure = plotting.mass_ellipse(arm.skeleton(pose), masses)
    >>> figure.axes[0].get_xlabel()
    'x (m)'
    """
    lines = numbers("skeleton", skeleton)
    if lines.ndim != 3 or lines.shape[1:] != (2, 3):
        raise ShapeError("skeleton", "(n, 2, 3)", lines.shape)
    instance("masses", masses, PointMasses)
    if masses.mobility.shape != (3, 3):
        raise ShapeError("masses.mobility", "(3, 3)", masses.mobility.shape)
    figure = style.new_figure(5.6, title=title)
    panels = figure.subplots(1, len(VIEWS))
    places = np.concatenate([lines.reshape(-1, 3), masses.position[np.newaxis]])
    width = max(float(np.ptp(places, axis=0).max()), 1e-3)
    scale = ELLIPSE_SHARE * width / np.sqrt(masses.iso_mass)
    for axes, (name, plane) in zip(panels, VIEWS.items(), strict=True):
        _draw_view(axes, lines, masses, plane, scale)
        axes.set_title(name)
    return figure


def _add_scale(axes: Axes, center: Array, scale: float, most: float) -> None:
    """Draw circles of round masses around a point, whose numbers in kg stand in the legend."""
    from matplotlib.patches import Circle

    largest = (most / scale) ** 2
    decade = 10.0 ** np.floor(np.log10(largest))
    rounds = [step * size for size in (0.01 * decade, 0.1 * decade, decade) for step in (1.0, 2.0, 5.0)]
    shown: list[str] = []
    outside = (1.0 + LEAST_GAP) * most
    look: style.Properties = {"fill": False, "edgecolor": SCALE_COLOR, "linewidth": 0.7, "zorder": 1.2}
    for mass in reversed(rounds):
        radius = scale * np.sqrt(mass)
        if LEAST_GAP * most <= radius <= outside - LEAST_GAP * most:
            axes.add_patch(Circle((center[0], center[1]), radius, **look))
            outside = radius
            shown.insert(0, f"{mass:g}")
    axes.plot([], [], color=SCALE_COLOR, linewidth=0.7, label=f"scale: {', '.join(shown)} kg")


def _draw_view(axes: Axes, lines: Array, masses: PointMasses, plane: tuple[int, int], scale: float) -> None:
    chosen = list(plane)
    gaps = np.full((len(lines), 1, 2), np.nan)
    drawn = np.concatenate([lines[:, :, chosen], gaps], axis=1).reshape(-1, 2)
    axes.plot(drawn[:, 0], drawn[:, 1], color=style.NEUTRAL, lw=3.0, marker="o", ms=4, label="arm")
    center = masses.position[chosen]
    along = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)
    mobility = np.einsum("ni,ij,nj->n", along, masses.mobility[np.ix_(chosen, chosen)], along)
    bound = 1e-9 * np.linalg.eigvalsh(masses.mobility)[-1]
    with np.errstate(divide="ignore"):
        mass = np.where(mobility > bound, 1.0 / mobility, np.inf)
    radius = scale * np.sqrt(mass)
    most = MOST_RADII * scale * np.sqrt(masses.iso_mass)
    # What lies beyond the picture leaves a gap: a cut outline would look like a closed one.
    outline = center + along * np.where(radius <= most, radius, np.nan)[:, np.newaxis]
    largest = "unbounded" if np.isinf(mass).any() or mass.max() > 1e4 else f"{mass.max():.3g} kg"
    label = f"{mass.min():.3g} kg to {largest}"
    axes.plot(outline[:, 0], outline[:, 1], color=style.RUN_COLORS[0], label=label)
    _add_scale(axes, center, scale, most)
    circle = center + along * scale * np.sqrt(masses.iso_mass)
    look: style.Properties = {"color": style.CONTACT_COLOR, "ls": (0, (5, 2)), "lw": 1.3}
    axes.plot(circle[:, 0], circle[:, 1], label=f"ISO mass {masses.iso_mass:.3g} kg", **look)
    axes.plot(*center, color=style.RUN_COLORS[0], ls="", marker="o", ms=6, label="point")
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(f"{AXES[plane[0]]} (m)")
    axes.set_ylabel(f"{AXES[plane[1]]} (m)")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=1)
