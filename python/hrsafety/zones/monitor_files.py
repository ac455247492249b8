"""Parameters of Nav2's collision monitor, read from YAML: every key checked, with its path and line in the message."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from hrsafety._arguments import Array
from hrsafety._words import meant
from hrsafety._yaml.documents import YamlDocument, YamlSection, read_yaml
from hrsafety.errors import FileError, InvalidParameterError, Shown
from hrsafety.plausibility import ResultWarning
from hrsafety.zones.monitor import ACTIONS, MOST_STEPS, TYPES, CollisionMonitor, MonitorPolygon, VelocityRange
from hrsafety.zones.polygons import checked
from hrsafety.zones.reach import footprint_of

__all__ = ["corners_of_text", "load_monitor", "monitor_of", "node_of"]

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_POINT = re.compile(rf"\[\s*({NUMBER})\s*,\s*({NUMBER})\s*\]")
_POINTS = re.compile(rf"\s*\[\s*{_POINT.pattern}(?:\s*,\s*{_POINT.pattern})*\s*,?\s*\]\s*")
MOST_CORNERS = 10_000
MOST_POINTS = 10**9
DEEPEST = 6
ROUND = 48

_RANGE = ("linear_min", "linear_max", "theta_min", "theta_max", "direction_start_angle", "direction_end_angle")
_POLYGON = (
    *("type", "action_type", "points", "radius", "min_points", "max_points", "trigger_consecutive_points"),
    *("release_consecutive_points", "slowdown_ratio", "linear_limit", "angular_limit", "time_before_collision"),
    *("simulation_time_step", "sources_names", "velocity_polygons", "holonomic", "footprint_topic"),
    *("polygon_sub_topic", "polygon_subscribe_transient_local", "visualize", "polygon_pub_topic", "enabled"),
)


def corners_of_text(text: str) -> Array | None:
    """Return corners (n, 2) from text such as ``"[[0.3, 0.2], [0.3, -0.2], ...]"``, ``None`` if it is none."""
    if len(text) > 100 * MOST_CORNERS or not _POINTS.fullmatch(text):
        return None
    return np.array([[float(x), float(y)] for x, y in _POINT.findall(text)])


def _word(keys: YamlSection, key: str, words: Sequence[str], default: str | None = None) -> str:
    """Return one of the words that are allowed."""
    if default is not None and key not in keys:
        return default
    found = keys[key].text()
    if found not in words:
        raise keys[key].error(f"be one of {', '.join(words)}", meant(found, words))
    return found


def _number(
    keys: YamlSection, key: str, default: float | None = None, *, least: float = -math.inf, above: bool = False
) -> float:
    """Return a number of at least a bound, or above it."""
    if default is not None and key not in keys:
        return default
    found = keys[key].number()
    if found < least or (above and found == least):
        raise keys[key].error(f"be {'above' if above else 'at least'} {least:g}")
    return found


def _whole(keys: YamlSection, key: str, default: int, least: int = 1) -> int:
    """Return a whole number of at least a bound."""
    if key not in keys:
        return default
    found = keys[key].whole()
    if not least <= found <= MOST_POINTS:
        raise keys[key].error(f"be from {least} to {MOST_POINTS}")
    return found


def _flag(keys: YamlSection, key: str, default: bool) -> bool:
    return keys[key].flag() if key in keys else default


def _names(keys: YamlSection, key: str) -> tuple[str, ...]:
    """Return a list of different names."""
    found = keys[key].texts()
    if len(set(found)) < len(found):
        raise keys[key].error("name each once")
    return tuple(found)


def _corners(keys: YamlSection, key: str = "points") -> Array:
    """Return a polygon from text such as ``"[[0.3, 0.2], ...]"``, a flat list or a list of pairs."""
    rule = 'be corners as "[[x, y], [x, y], ...]" or a flat list x, y, x, y, ...'
    value = keys[key].plain
    if isinstance(value, str):
        read = corners_of_text(value)
        if read is None:
            raise keys[key].error(rule)
        place = read
    elif isinstance(value, list) and len(value) <= 2 * MOST_CORNERS:
        pairs = all(isinstance(each, list) and len(each) == 2 for each in value)
        flat = [part.number() for each in keys[key].values() for part in (each.values() if pairs else [each])]
        if len(flat) % 2:
            raise keys[key].error(rule)
        place = np.array(flat, dtype=np.float64).reshape(-1, 2)
    else:
        raise keys[key].error(rule)
    try:
        return checked(key, place)
    except InvalidParameterError as error:
        raise FileError(keys[key].place, error.requirement, error.value, error.remedy, code="monitor") from None


def load_monitor(path: object, *, footprint: object = None) -> CollisionMonitor:
    """Read the parameters of a ``collision_monitor`` node from YAML.

    Parameters
    ----------
    path : path-like
        The file; other nodes in it are passed over.
    footprint : float or array_like (n, 2) or None
        Body of the robot in m, the shape of zones that a ``footprint_topic`` brings.

    Returns
    -------
    CollisionMonitor
        Its zones, with doubts in `warnings`.

    Raises
    ------
    InvalidParameterError
        If a key is missing or wrong; the message names the key with its path and line.

    Examples
    --------
    >>> from pathlib import Path
    >>> from hrsafety import zones
    >>> text = '''
    ... collision_monitor:
    ...   ros__parameters:
    ...     polygons: ["Stop"]
    ...     Stop: {type: circle, action_type: stop, radius: 0.5}
    ...     observation_sources: ["scan"]
    ...     scan: {type: scan, topic: scan}
    ... '''
    >>> _ = Path("cm.yaml").write_text(text)
    >>> zones.load_monitor("cm.yaml").polygons[0].radius
    0.5
    """
    document = read_yaml(path)  # type: ignore[arg-type]  # what is no path is refused there
    found = monitor_of(document, footprint=footprint)
    return replace(found, source=str(path))


def node_of(root: YamlSection) -> YamlSection:
    """Return the parameters of the node: those under its name, or of the only node that has polygons."""
    found = [each for each in _nodes(root, 0) if {"polygons", "observation_sources"} & set(each.keys())]
    named = [each for each in found if len(each.path) > 1 and str(each.path[-2]).endswith("collision_monitor")]
    chosen = named or found
    if len(chosen) != 1:
        shown = Shown(", ".join(".".join(map(str, each.path)) for each in chosen) or "none")
        remedy = "polygons stand under collision_monitor.ros__parameters"
        raise FileError(root.place, "hold the parameters of one collision_monitor", shown, remedy, code="monitor")
    return chosen[0]


def _nodes(section: YamlSection, depth: int) -> list[YamlSection]:
    """Return every ``ros__parameters`` in a file."""
    found = []
    if isinstance(section.plain, dict) and depth < DEEPEST:
        for key in section.keys():  # noqa: SIM118  # of YAML
            below = section[key]
            if isinstance(below.plain, dict):
                found += [below] if key == "ros__parameters" else _nodes(below, depth + 1)
    return found


def monitor_of(document: YamlDocument, *, footprint: object = None) -> CollisionMonitor:
    """Return the monitor whose parameters a document holds.

    Parameters
    ----------
    document : YamlDocument
        The file.
    footprint : float or array_like (n, 2) or None
        Body of the robot in m, the shape of zones that a ``footprint_topic`` brings.

    Returns
    -------
    CollisionMonitor
        Its zones, with doubts in `warnings`.
    """
    node = node_of(document.root)
    doubts = list(document.warnings)
    if not _flag(node, "enabled", True):
        raise node["enabled"].error("be true", "a monitor that is switched off passes every command")
    topics = [node[key].text() for key in ("cmd_vel_in_topic", "cmd_vel_out_topic") if key in node]
    if len(topics) == 2 and topics[0].strip("/") == topics[1].strip("/"):
        words = "be another topic than cmd_vel_in_topic"
        raise node["cmd_vel_out_topic"].error(words, "the robot obeys commands that no zone has looked at")
    sources = _sources(node, doubts)
    zones = []
    for name in _names(node, "polygons"):
        zone = _polygon(node[name], name, sources, footprint, doubts)
        if _flag(node[name], "enabled", True):
            zones.append(zone)
        else:
            doubts.append(
                ResultWarning(
                    "disabled",
                    *_told(node[name]["enabled"], "the zone is switched off and no part of the verdict"),
                    safe_side=True,
                )
            )
    if not zones:
        raise node["polygons"].error("name a zone that is enabled")
    return CollisionMonitor(
        polygons=tuple(zones),
        source_timeout=_timeout(node, sources),
        sources=sources,
        warnings=tuple(doubts),
        source=document.root.place,
    )


def _told(section: YamlSection, words: str) -> tuple[str, str]:
    """Return subject and message of a doubt about a key."""
    return ".".join(map(str, section.path)), f"{section.place}: {words}"


def _sources(node: YamlSection, doubts: list[ResultWarning]) -> tuple[str, ...]:
    """Return the names of the sources that are enabled; each stands in the file."""
    found = []
    for name in _names(node, "observation_sources"):
        keys = node[name]
        kind = _word(keys, "type", ("scan", "pointcloud", "range", "polygon", "costmap"), "scan")
        if not _flag(keys, "enabled", True):
            continue
        if kind != "scan":
            words = f"points of a {kind} are taken to be those of the scanner that is given"
            doubts.append(ResultWarning("not_modelled", *_told(keys["type"], words)))
        found.append(name)
    if not found:
        raise node["observation_sources"].error("name a source that is enabled")
    return tuple(found)


def _timeout(node: YamlSection, sources: Sequence[str]) -> float:
    """Return the longest silence that a source may have; 0 if one may be silent for good."""
    shared = _number(node, "source_timeout", 2.0, least=0.0)
    own = [_number(node[name], "source_timeout", shared, least=0.0) for name in sources]
    return 0.0 if 0.0 in own else max(own)


def _polygon(
    keys: YamlSection, name: str, sources: tuple[str, ...], footprint: object, doubts: list[ResultWarning]
) -> MonitorPolygon:
    """Return one zone."""
    kind, action = _word(keys, "type", TYPES), _word(keys, "action_type", ACTIONS)
    given: dict[str, Any] = {"name": name, "type": kind, "action": action}
    given["min_points"] = _whole(keys, "min_points", 4, 0)
    if "max_points" in keys:
        given["min_points"] = _whole(keys, "max_points", 3, 0) + 1
    for each in ("trigger_consecutive_points", "release_consecutive_points"):
        given[each] = _whole(keys, each, 1)
    for each in ("slowdown_ratio", "linear_limit", "angular_limit"):
        given[each] = _number(keys, each, 0.5, least=0.0)
    for each, default in (("time_before_collision", 2.0), ("simulation_time_step", 0.1)):
        given[each] = _number(keys, each, default, least=0.0, above=True)
    if given["time_before_collision"] > MOST_STEPS * given["simulation_time_step"]:
        raise keys["simulation_time_step"].error(f"divide time_before_collision into at most {MOST_STEPS} steps")
    if "sources_names" in keys:
        named = _names(keys, "sources_names")
        for each in named:
            if each not in sources:
                rule = f"be among the observation_sources that are enabled ({', '.join(sources)})"
                raise keys["sources_names"].error(rule, meant(each, sources))
        given["sources_names"] = named if set(named) != set(sources) else ()
    known = list(_POLYGON)
    if kind == "velocity_polygon":
        ranges, given["holonomic"] = _names(keys, "velocity_polygons"), _flag(keys, "holonomic", False)
        if not ranges:
            raise keys["velocity_polygons"].error("name at least one")
        given["ranges"] = tuple(_range(keys[each], each, given["holonomic"], doubts) for each in ranges)
        known += ranges
    elif "polygon_sub_topic" in keys and "points" not in keys and "radius" not in keys:
        given |= {"type": "polygon", "corners": _shapeless(keys["polygon_sub_topic"], doubts)}
    elif kind == "circle":
        given["radius"] = _number(keys, "radius", least=0.0, above=True)
    elif "points" in keys or action != "approach":
        given["corners"] = _corners(keys)
    elif footprint is None:
        given["corners"] = _shapeless(keys.get("footprint_topic") or keys, doubts)
    else:
        given["corners"] = _body_corners(footprint)
    _doubt_unknown(keys, known, doubts)
    return MonitorPolygon(**given)


def _shapeless(section: YamlSection, doubts: list[ResultWarning]) -> Array | None:
    """Doubt a zone whose shape a topic brings, and return none."""
    doubts.append(
        ResultWarning("shape_unknown", *_told(section, "a topic brings the shape: the zone is taken not to act"))
    )
    return None


def _body_corners(footprint: object) -> Array:
    """Return the corners of a body; those of a disc lie on it, as Nav2 publishes it."""
    body = footprint_of(footprint)
    if len(body.corners) > 1:
        return body.corners
    angles = np.arange(ROUND) * (2.0 * math.pi / ROUND)
    return body.rounding * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _range(keys: YamlSection, name: str, holonomic: bool, doubts: list[ResultWarning]) -> VelocityRange:
    """Return one range of a velocity polygon."""
    given = {each: _number(keys, each) for each in _RANGE[:4]}
    if holonomic:
        for each, default in zip(_RANGE[4:], (-math.pi, math.pi), strict=True):
            given[each] = _number(keys, each, default)
    for low, high in (("linear_min", "linear_max"), ("theta_min", "theta_max")):
        if given[low] > given[high]:
            raise keys[low].error(f"be at most {high} ({given[high]:g})")
    _doubt_unknown(keys, ("points", *_RANGE), doubts)
    return VelocityRange(name=name, corners=_corners(keys), **given)


def _doubt_unknown(keys: YamlSection, known: Sequence[str], doubts: list[ResultWarning]) -> None:
    for key in keys.keys():  # noqa: SIM118  # of YAML
        if key not in known:
            near = meant(key, known)
            words = f"the model does not know this key{f'; {near}' if near else ''}"
            doubts.append(ResultWarning("unknown_key", *_told(keys[key], words)))
