"""Program files: TOML in, a motion with the contacts that may happen along it out."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any

from hrsafety import _keys as kind
from hrsafety._keys import Keys, checked, located, missing, one_of, parsed
from hrsafety.arms import Arm
from hrsafety.arms.masses import RULES
from hrsafety.contact import drive_of
from hrsafety.contact.cell.file import coverings_of, limits_of_file
from hrsafety.contact.cell.robot import ARM_KEYS, arm_of
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.program.drawn import DrawnProgram
from hrsafety.program.draws import DrawnMotions
from hrsafety.program.exposures import ContactPoint, Segment
from hrsafety.program.motion import ArmMotion
from hrsafety.program.moves import Move
from hrsafety.program.program import Program
from hrsafety.program.task import DIRECTIONS, ZoneRules
from hrsafety.standards.sets import SETS

__all__ = ["load_program"]


def _by_joint(path: str, value: Any) -> Any:
    """Check one number for every joint, an array of them, or a table by joint."""
    if isinstance(value, dict):
        return {name: kind.number(f"{path}.{name}", each) for name, each in value.items()}
    return kind.numbers(path, value) if isinstance(value, list) else kind.number(path, value)


def _place(path: str, value: Any) -> Any:
    """Check a time or the name of a move."""
    return value if isinstance(value, str) else kind.number(path, value)


_TOP: Keys = MappingProxyType(
    {
        "title": kind.word,
        "limits": kind.word,
        "catalog": kind.word,
        "robot": kind.table,
        "motion": kind.table,
        "moves": kind.tables,
        "points": kind.tables,
        "segments": kind.tables,
        "coverings": kind.tables,
        "drive": kind.table,
        "zones": kind.table,
        "separation": kind.table,
        "confirmed": kind.table,
        "annex": kind.table,
    }
)
_OF_CELLS = ("poses", "samples", "seed", "mass_rule", "direction")
"""Keys of the robot of a cell that are others here."""
_ROBOT: Keys = MappingProxyType(
    {name: check for name, check in ARM_KEYS.items() if name not in _OF_CELLS} | {"direction": kind.word}
)
_MOTION: Keys = MappingProxyType(
    {
        "log": kind.word,
        "velocity": _by_joint,
        "acceleration": _by_joint,
        "tcp_speed": kind.number,
        "path_tolerance": kind.number,
        "draws": kind.integer,
        "seed": kind.integer,
        "accept_quantile": kind.number,
    }
)
_MOVE: Keys = MappingProxyType(
    {
        "kind": kind.word,
        "to": _by_joint,
        "link": kind.word,
        "blend": kind.number,
        "dwell": kind.number,
        "name": kind.word,
    }
)
_POINT: Keys = MappingProxyType(
    {
        "name": kind.word,
        "link": kind.word,
        "point": kind.triple,
        "area": kind.number,
        "radius": kind.number,
        "covering": kind.word,
    }
)
_SEGMENT: Keys = MappingProxyType(
    {
        "name": kind.word,
        "from": _place,
        "to": _place,
        "regions": kind.words,
        "clamped": kind.boolean,
        "reason": kind.word,
        "human_speed": kind.number,
    }
)
_ZONES: Keys = MappingProxyType(
    {"count": kind.integer, "step": kind.number, "percent": kind.number, "deceleration": kind.number}
)


@kind.top_level(_TOP)
def load_program(path: str | PathLike[str]) -> Program | DrawnProgram:
    r"""Read a program file.

    Parameters
    ----------
    path : path-like
        The file, see ``hrsafety init program``; paths in it are beside it.

    Returns
    -------
    Program or DrawnProgram
        Checked; the latter of a file without a path, which names `draws`.

    Raises
    ------
    InvalidParameterError
        If a file cannot be read or a value breaks a rule; the message names the key.

    Examples
    --------
    >>> from importlib import resources
    >>> from pathlib import Path
    >>> from hrsafety import program
    >>> data = resources.files("hrsafety.cli") / "data"
    >>> _ = Path("task.toml").write_text((data / "robot_program.toml").read_text())
    >>> task = program.load_program("task.toml")
    >>> [each.name for each in task.points]
    ['gripper', 'wrist']
    """
    if not isinstance(path, (str, PathLike)):
        raise InvalidParameterError("path", "be a path", path)
    place = Path(path)
    given = checked("", parsed(place), _TOP, required=("robot", "motion", "points", "segments"))
    read: dict[str, str] = {}
    limits = limits_of_file(given.get("limits", SETS[0]), place.parent, read)
    coverings, strains, _ = coverings_of(given, place.parent, read)
    robot = checked("robot", given["robot"], _ROBOT, required=("urdf",))
    with located("robot"):
        arm = arm_of(robot, place.parent)
        mass_rule = one_of("robot_mass", robot.get("robot_mass", "larger"), RULES)
        direction = one_of("direction", robot.get("direction", "motion"), DIRECTIONS)
    read["robot"] = arm.sha256
    more: dict[str, Any] = {
        name: given[name] for name in ("title", "separation", "confirmed", "annex") if name in given
    }
    more |= {name: robot[name] for name in ("link", "point") if name in robot}
    if "drive" in given:
        more["drive"] = drive_of(given["drive"])
    more |= {"limits": limits, "coverings": coverings, "strains": strains}
    more |= {"robot_mass": mass_rule, "direction": direction, "given": given, "files": read}
    more |= {"points": tuple(_points(given["points"])), "segments": tuple(_segments(given["segments"]))}
    if "draws" in given["motion"]:
        return _drawn(given, arm, more)
    motion, more["tcp_speed"] = _motion(given, arm, robot.get("link"), place.parent, read)
    if "zones" in given:
        rules = checked("zones", given["zones"], _ZONES, required=("deceleration",))
        if "step" in rules and "percent" in rules:
            raise InvalidParameterError("zones.percent", "be left out beside step", rules["percent"])
        more["zone_rules"] = ZoneRules(**rules)
    return Program(motion=motion, **more)


_OF_DRAWS = ("draws", "seed", "accept_quantile")


def _drawn(given: Mapping[str, Any], arm: Arm, more: dict[str, Any]) -> DrawnProgram:
    """Return a robot without a program."""
    values = checked("motion", given["motion"], _MOTION)
    for name in ("moves", "zones"):
        if name in given:
            raise InvalidParameterError(name, "be left out without a program", Shown("given"))
    for name in values:
        if name not in (*_OF_DRAWS, "velocity", "tcp_speed"):
            raise InvalidParameterError(f"motion.{name}", "be left out beside draws", values[name])
    of_task = {name: values[name] for name in ("tcp_speed", "accept_quantile") if name in values}
    motion = {name: values[name] for name in ("draws", "seed", "velocity") if name in values}
    with located("motion"):
        drawn = DrawnMotions(arm=arm, **motion)
    return DrawnProgram(motion=drawn, **of_task, **more)


def _motion(
    given: Mapping[str, Any], arm: Arm, link: str | None, folder: Path, read: dict[str, str]
) -> tuple[ArmMotion, float | None]:
    """Return the motion of a log or of moves, and the largest speed of the tool center point."""
    values = checked("motion", given["motion"], _MOTION)
    for name in _OF_DRAWS:
        if name in values:
            raise InvalidParameterError(f"motion.{name}", "come with draws, without a program", values[name])
    if "acceleration" not in values:
        raise missing("motion.acceleration", "one number, or a table by joint, in rad/s^2: no file of an arm has it")
    tcp_speed = values.pop("tcp_speed", None)
    if ("log" in values) == ("moves" in given):
        remedy = "give a recorded log, or moves"
        raise InvalidParameterError(
            "motion.log", "be given, or [[moves]] in its place, not both", values.get("log"), remedy
        )
    if "log" in values:
        log = values.pop("log")
        try:
            motion = ArmMotion.from_log(arm, folder / log, **values)
        except InvalidParameterError as error:
            own = error.argument.partition(".")[0] in _MOTION
            where = f"motion.{error.argument}" if own else f"motion.log: {error.argument}"
            raise error.renamed("motion.log" if error.argument == "path" else where) from None
        read["log"] = "" if motion.log is None else motion.log.sha256
        return motion, tcp_speed
    if "path_tolerance" in values:
        raise InvalidParameterError("motion.path_tolerance", "be left out beside [[moves]]", values["path_tolerance"])
    moves = []
    for place, entry in enumerate(given["moves"]):
        table = checked(f"moves[{place}]", entry, _MOVE, required=("kind", "to"))
        with located(f"moves[{place}]"):
            moves.append(Move(**table))
    try:
        return ArmMotion.from_moves(arm, moves, link=link, **values), tcp_speed
    except InvalidParameterError as error:
        if error.argument.startswith("moves"):
            raise
        raise error.renamed(f"motion.{error.argument}") from None


def _points(entries: list[dict[str, Any]]) -> list[ContactPoint]:
    found = []
    for place, entry in enumerate(entries):
        path = f"points[{place}]"
        values = checked(path, entry, _POINT, required=("name", "link"))
        with located(path):
            found.append(ContactPoint(**values))
    return found


def _segments(entries: list[dict[str, Any]]) -> list[Segment]:
    found = []
    for place, entry in enumerate(entries):
        path = f"segments[{place}]"
        values = checked(path, entry, _SEGMENT, required=("regions",))
        with located(path):
            found.append(Segment(start=values.pop("from", None), end=values.pop("to", None), **values))
    return found
