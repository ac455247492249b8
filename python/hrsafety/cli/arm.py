"""``hrsafety arm ROBOT.urdf``: masses of a point of an arm by pose, with a picture of the mass ellipse."""

from __future__ import annotations

import argparse
import csv
import io
import math
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from hrsafety import arms
from hrsafety._arguments import Array, meant, readable
from hrsafety.cli import output, terminal
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.pages.report import Report, ReportTable, Section

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["show_arm"]

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
MOST_BYTES = 2**26
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


def show_arm(options: argparse.Namespace) -> None:
    """Print the masses of a point in every pose, and write table, picture and page.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety arm``.
    """
    output.check_targets(options)
    arm = _arm(options)
    link = arm.moved_links[-1] if options.link is None and arm.moved_links else options.link
    poses = _poses(arm, options)
    directions = dict(AXES)
    if options.direction is not None:
        directions["u"] = tuple(options.direction)
    place = {"link": link, "point": options.point, "check_limits": not options.no_limits}
    masses = arm.point_masses(poses[:, np.newaxis], direction=list(directions.values()), **place)
    report = Report(
        title=f"Masses of {arm.name}",
        facts=list(_facts(arm, options, link)),
        sections=[Section("Masses", [_table(masses, list(directions))])],
        warnings=masses.warnings,
        source=options.robot,
        made="",
    )
    print(terminal.told(report))
    folder = output.folder(options.out)
    tables = [_csv(arm, poses, masses, list(directions), folder)]
    written = output.write_report(report, folder, _draw(arm, poses, masses, place), tables, options=options)
    output.say_written(written, report, options)
    output.report_warnings(masses.warnings, options.strict)


def _arm(options: argparse.Namespace) -> arms.Arm:
    payload = None
    if options.payload is not None:
        link = options.payload_link or options.link
        if link is None:
            rule = "come with --payload-link, or --link"
            raise InvalidParameterError("--payload", rule, options.payload)
        payload = arms.Payload(link, options.payload, tuple(options.payload_center))
    armature = _pairs("--armature", options.armature)
    locked = options.lock or None
    with output.located(options.robot):
        try:
            return arms.Arm.from_urdf(
                Path(options.robot),
                payload=payload,
                armature=armature or None,
                locked=locked,
                repair_inertia=options.repair_inertia,
                type_plate_mass=options.type_plate,
            )
        except InvalidParameterError as error:
            named = {"locked": "--lock", "payload.link": "--payload-link", "path_or_text": "path"}
            named["type_plate_mass"] = "--type-plate"
            raise error.renamed(named.get(error.argument, error.argument)) from None


def _pairs(option: str, given: Sequence[str] | None) -> dict[str, float]:
    """Return values by name from words such as ``elbow=1.2``."""
    found: dict[str, float] = {}
    for word in given or ():
        name, sign, value = word.rpartition("=")
        if not sign or not name or not _NUMBER.fullmatch(value):
            raise InvalidParameterError(option, "be NAME=NUMBER", word)
        if name in found:
            raise InvalidParameterError(option, "name a joint once", name)
        found[name] = float(value)
    return found


def _poses(arm: arms.Arm, options: argparse.Namespace) -> Array:
    """Return the poses that were asked for: given ones, or the middle of the limits and drawn ones."""
    given = _pairs("--joint", options.joint)
    for name in given:
        if name not in arm.joint_names:
            rule = f"name joints that take a value: {', '.join(arm.joint_names)}"
            raise InvalidParameterError("--joint", rule, name, meant(name, arm.joint_names))
    if options.poses is not None:
        if given:
            raise InvalidParameterError("--joint", "not come with --poses", Shown(" ".join(options.joint)))
        return _read_poses(arm, Path(options.poses))
    limits = arm.limits
    middle = np.where(np.isfinite(limits).all(axis=1), limits.sum(axis=1) / 2.0, 0.0)
    first = np.array([[given.get(name, value) for name, value in zip(arm.joint_names, middle, strict=True)]])
    if given:
        return first
    link = arm.link_names[-1]
    drawn = arms.workspace(arm, link=link, samples=options.samples, seed=options.seed).joints
    return np.concatenate([first, drawn])


def _read_poses(arm: arms.Arm, path: Path) -> Array:
    """Return poses from a table whose header names joints."""
    place = readable("--poses", path)
    if place.stat().st_size > MOST_BYTES:
        raise InvalidParameterError(str(path), f"have at most {MOST_BYTES} bytes", place.stat().st_size)
    try:
        rows = list(csv.reader(io.StringIO(place.read_text(encoding="utf-8-sig"), newline=""), strict=True))
    except (UnicodeDecodeError, csv.Error) as error:
        raise InvalidParameterError(str(path), "be CSV in UTF-8", Shown(str(error))) from None
    if len(rows) < 2:
        raise InvalidParameterError(str(path), "hold a header and poses", len(rows))
    header = [name.strip() for name in rows[0]]
    for name in header:
        if name not in arm.joint_names or header.count(name) > 1:
            rule = f"name each joint once, out of {', '.join(arm.joint_names)}"
            raise InvalidParameterError(f"{path}: header", rule, name, meant(name, arm.joint_names))
    poses = np.zeros((len(rows) - 1, len(arm.joint_names)))
    columns = [arm.joint_names.index(name) for name in header]
    for index, row in enumerate(rows[1:]):
        if len(row) != len(header):
            raise InvalidParameterError(f"{path}: line {index + 2}", f"have {len(header)} cells", len(row))
        for column, name, cell in zip(columns, header, row, strict=True):
            if not _NUMBER.fullmatch(cell.strip()):
                raise InvalidParameterError(f"{path}: line {index + 2}: {name}", "be a number", cell)
            poses[index, column] = float(cell)
    return poses


# ---- words --------------------------------------------------------------------------------------


def _facts(arm: arms.Arm, options: argparse.Namespace, link: str | None) -> Iterator[tuple[str, str]]:
    point = ", ".join(f"{each:g}" for each in options.point)
    yield "robot", f"{arm.name} ({options.robot}, SHA-256 {arm.sha256[:16]})"
    yield "joints", ", ".join(arm.joint_names)
    if arm.locked:
        yield "locked", ", ".join(arm.locked)
    yield "point", f"({point}) m on {link}"
    payload = f", payload {arm.payload_mass:g} kg" if arm.payloads else ""
    plate = "compare with the type plate" if arm.type_plate_mass is None else f"type plate {arm.type_plate_mass:g} kg"
    yield "all links", f"{arm.total_mass:g} kg ({plate})"
    yield "moving mass", f"{arm.moving_mass:g} kg{payload}"
    yield "ISO mass", f"{arm.iso_mass:g} kg (half of the moving mass, and the payload)"


def _mass(value: float) -> str:
    return "unbounded" if math.isinf(value) else f"{value:.3f}"


def _table(masses: arms.PointMasses, names: Sequence[str]) -> ReportTable:
    rows = []
    for index, position in enumerate(masses.position[:, 0]):
        along = [_mass(value) for value in masses.effective_mass[index]]
        extremes = [masses.extremes.least_mass[index, 0], masses.extremes.worst_mass[index, 0]]
        rows.append((index, *(f"{value:.3f}" for value in position), *along, *(_mass(each) for each in extremes)))
    header = ("pose", "x", "y", "z", *(f"along {name}" for name in names), "least", "worst")
    units = ("", "m", "m", "m", *("kg" for _ in names), "kg", "kg")
    return ReportTable(headers=(header, units), rows=rows, left=(), printed=True)


def _csv(arm: arms.Arm, poses: Array, masses: arms.PointMasses, names: Sequence[str], folder: Path) -> Path:
    units = ["rad" if kind == "turning" else "m" for kind in arm.joint_kinds]
    joints = [f"{name}_{unit}" for name, unit in zip(arm.joint_names, units, strict=True)]
    header = [*joints, "x_m", "y_m", "z_m", *(f"effective_mass_{name}_kg" for name in names)]
    header += ["least_mass_kg", "worst_mass_kg", "worst_x", "worst_y", "worst_z", "iso_mass_kg"]
    return output.write_csv(folder / "masses.csv", header, _rows(poses, masses))


def _draw(
    arm: arms.Arm, poses: Array, masses: arms.PointMasses, place: dict[str, object]
) -> Iterator[tuple[str, Figure, str]]:
    from hrsafety import plotting

    worst = int(np.argmax(masses.extremes.worst_mass[:, 0]))
    pose = poses[worst]
    one = arm.point_masses(pose, direction=(1.0, 0.0, 0.0), **place)  # type: ignore[arg-type]  # as in show_arm
    skeleton = arm.skeleton(pose, check_limits=bool(place["check_limits"]))
    figure = plotting.mass_ellipse(skeleton, one, title=f"{arm.name or 'arm'}, pose {worst}: mass by direction")
    yield "mass_ellipse", figure, "Mass by direction in the pose with the worst mass."


def _rows(poses: Array, masses: arms.PointMasses) -> Iterator[list[object]]:
    for index, pose in enumerate(poses):
        along = [value if math.isfinite(value) else "inf" for value in masses.effective_mass[index].tolist()]
        worst = float(masses.extremes.worst_mass[index, 0])
        row: list[object] = [*pose.tolist(), *masses.position[index, 0].tolist(), *along]
        row += [float(masses.extremes.least_mass[index, 0]), worst if math.isfinite(worst) else "inf"]
        yield [*row, *masses.extremes.worst_direction[index, 0].tolist(), masses.iso_mass]
