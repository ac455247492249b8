"""Zones as YAML: parameters of a collision monitor with comments, and files whose polygons are made large enough."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from hrsafety._arguments import Array
from hrsafety._yaml.documents import YamlDocument, read_yaml
from hrsafety.zones.monitor_files import node_of
from hrsafety.zones.polygons import ANGLES, distance_outside, from_supports, supports, trimmed

__all__ = ["mended", "zone_text"]

CORNERS = 24
"""Most corners of a shape that is mended."""
ROUNDING = 5e-4
"""Distance in m that corners lose in files."""


def shown_corners(corners: Array) -> str:
    """Return corners as the collision monitor reads them."""
    return "[" + ", ".join(f"[{x:.4f}, {y:.4f}]" for x, y in corners) + "]"


def _reach(shape: Array | float) -> float:
    return shape if isinstance(shape, float) else float(np.linalg.norm(shape, axis=1).max())


def _rounded(radius: float) -> float:
    return float(np.ceil(1e3 * radius) / 1e3)


def zone_text(found: Any) -> str:
    """Return the parameters of a collision monitor with these zones.

    Parameters
    ----------
    found : ZoneSet
        Of `design`.

    Returns
    -------
    str
        YAML with comments.
    """
    given = found.conditions
    body = f"radius {given.footprint:g} m" if np.ndim(given.footprint) == 0 else f"{len(given.footprint)} corners"
    lines = [
        "# Zones that stop the robot before it touches a person who walks at most "
        f"{given.person_speed:g} m/s, made for:",
        f"#   footprint {body}, speed {given.slowest:g} to {given.max_speed:g} m/s",
        f"#   turn rate {given.max_turn_rate:g} rad/s, deceleration {given.deceleration:g} m/s^2",
        f"#   reaction {given.reaction_time:g} s, points true to {given.error:g} m",
        f"#   legs of radius {given.leg_radius:g} m or more, beams {np.degrees(given.beam_step):.4g} deg apart",
        "# Falling commands: "
        + (
            "no limit, so every zone covers the largest speed"
            if given.command_fall is None
            else f"at most {given.command_fall:g} m/s^2, which a velocity smoother before this node must keep"
        ),
        "collision_monitor:",
        "  ros__parameters:",
        '    base_frame_id: "base_footprint"',
        '    odom_frame_id: "odom"',
        '    cmd_vel_in_topic: "cmd_vel_smoothed"',
        '    cmd_vel_out_topic: "cmd_vel"',
        '    state_topic: "collision_monitor_state"',
        "    transform_tolerance: 0.1",
        f"    source_timeout: {found.source_timeout:.4g}  # s, period and age of a scan: part of the reaction",
        "    base_shift_correction: false  # the zones hold for points where the scan saw them",
        "    stop_pub_timeout: 2.0",
        '    polygons: ["Zones"]',
        "    Zones:",
        '      type: "velocity_polygon"',
        '      action_type: "stop"',
        f"      min_points: {found.min_points}",
        "      visualize: true",
        '      polygon_pub_topic: "zones"',
        f"      holonomic: {str(given.holonomic).lower()}",
        "      velocity_polygons: [" + ", ".join(f'"{each.name}"' for each in found.zones) + "]  # slowest first",
    ]
    for zone in found.zones:
        front, rear, left, right = zone.extents
        lines += [
            f"      {zone.name}:  # {front:.2f} m ahead, {rear:.2f} m behind, {left:.2f} m left, {right:.2f} m right",
            f'        points: "{shown_corners(zone.corners)}"',
        ]
        values = zone.commands._asdict()
        if not given.holonomic:
            values = {name: value for name, value in values.items() if not name.startswith("direction")}
        lines += [f"        {name}: {float(value)!r}" for name, value in values.items()]
    lines += ['    observation_sources: ["scan"]', "    scan:", '      type: "scan"', '      topic: "scan"']
    if given.min_range > 0.0:
        lines.append(f"      # the scanner must see from {given.min_range:g} m on")
    return "\n".join(lines) + "\n"


def mended(path: str | PathLike[str], found: Any) -> YamlDocument:
    """Return a file of a collision monitor with its stopping shapes made large enough, all else as it was.

    Each shape becomes the hull of itself and the one that its commands need; one around it that slows the robot or
    limits its speed grows with it and keeps its lead. ``source_timeout`` becomes at most the reaction time. Commands
    without a range, and shapes that would reach beyond sight, stay as they are.

    Parameters
    ----------
    path : path-like
        The file that was checked.
    found : ZoneCheck
        Of `check`.

    Returns
    -------
    YamlDocument
        With comments and order kept; its ``write`` writes it.

    Raises
    ------
    FileError
        If the file is no collision monitor.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import zones
    >>> robot = {"footprint": 0.22, "max_speed": 0.2, "max_turn_rate": 0.5, "deceleration": 2.5, "reaction_time": 0.15}
    >>> text = '''collision_monitor:
    ...   ros__parameters:
    ...     source_timeout: 0.1
    ...     polygons: [Stop]
    ...     Stop: {type: circle, action_type: stop, radius: 0.3}  # as delivered
    ...     observation_sources: [scan]
    ...     scan: {type: scan}
    ... '''
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder, "cm.yaml")
    ...     _ = file.write_text(text)
    ...     found = zones.check(file, attacks=50, generations=0, error=0.02, beam_step=0.0087, **robot)
    ...     print(zones.mended(file, found).text.splitlines()[4])
        Stop: {type: circle, action_type: stop, radius: 0.654}  # as delivered
    """
    document = read_yaml(Path(path))
    node = node_of(document.root)
    changes: dict[tuple[str | int, ...], Any] = {}
    for name, shape in grown_shapes(found).items():
        keys = (*node.path, *name.split("."))
        if isinstance(shape, float):
            changes[*keys, "radius"] = shape
            continue
        old = document.at(keys)["points"].plain
        flat = isinstance(old, list) and not (old and isinstance(old[0], list))
        new = shown_corners(shape) if isinstance(old, str) else shape.ravel().tolist() if flat else shape.tolist()
        changes[*keys, "points"] = new
    reaction = found.conditions.reaction_time
    if not 0.0 < found.monitor.source_timeout <= reaction:
        changes[*node.path, "source_timeout"] = reaction
        for name in found.monitor.sources:
            if "source_timeout" in node[name]:
                changes[*node.path, name, "source_timeout"] = reaction
    return document.changed(changes) if changes else document


def grown_shapes(found: Any) -> dict[str, Array | float]:
    """Return corners or radius of mended shapes by name: those that stop, then those that slow and lie around them."""
    circles = {zone.name for zone in found.monitor.polygons if zone.type == "circle"}
    grown = [each for each in found.shapes if each.needed is not None and each.missing > 0.0]
    shapes: dict[str, Array | float] = {}
    for each in grown:
        points = np.concatenate([each.corners, each.needed])
        shapes[each.name] = _rounded(_reach(each.needed)) if each.name in circles else trimmed(points, CORNERS)
    for zone in found.monitor.polygons:
        if zone.action not in ("slowdown", "limit"):
            continue
        if zone.type == "circle":
            held = [each for each in grown if _reach(each.corners) <= zone.radius]
            lead = max((_reach(shapes[each.name]) - _reach(each.corners) for each in held), default=0.0)
            if lead > 0.0:
                shapes[zone.name] = _rounded(zone.radius + lead)
            continue
        parts = [(f"{zone.name}.{each.name}", each.corners) for each in zone.ranges] or [(zone.name, zone.corners)]
        for name, corners in parts:
            if corners is None:  # a topic brings it
                continue
            held = [each for each in grown if distance_outside(corners, each.corners).max() <= ROUNDING]
            leads = [supports(shapes[each.name]) - supports(each.corners) for each in held]
            if leads:
                lead = np.maximum(np.max(leads, axis=0), 0.0)
                shapes[name] = trimmed(from_supports(ANGLES, supports(corners) + lead), CORNERS)
    return shapes
