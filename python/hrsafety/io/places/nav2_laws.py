"""Controllers of Nav2 as laws: which parameter of a file is which of a law."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import fields
from typing import Any

from hrsafety._arguments import meant
from hrsafety._records import dataclass
from hrsafety._yaml.documents import YamlSection
from hrsafety.errors import FileError, InvalidParameterError
from hrsafety.navigation.laws.local_planners import DWB, PathIntegral, RegulatedPurePursuit
from hrsafety.navigation.laws.twists import LocalPlanner
from hrsafety.plausibility import ResultWarning

__all__ = ["INFLATION", "Nav2Controller", "approaches_of", "changes", "controllers_of", "doubts_of", "ignored_of"]

Parameters = Mapping[str, YamlSection]
INFLATION = ("cost_scaling_factor", "inflation_radius")
"""Fields of laws that the local costmap gives."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Plugin:
    """How the parameters of a controller plugin become those of a law; most have the same names.

    Parameters
    ----------
    law : type
        The law.
    names : mapping of str to str
        Other names of parameters, by the keys of files.
    critics : mapping of str to str
        Fields that are 0 without the critic of this name.
    defaults : mapping
        Defaults of Nav2 that are not those of the law.
    """

    law: type[LocalPlanner]
    names: Mapping[str, str]
    critics: Mapping[str, str]
    defaults: Mapping[str, Any]


_DWB_CRITICS = {
    "BaseObstacle": "obstacle_scale",
    "PathDist": "path_dist_scale",
    "GoalDist": "goal_dist_scale",
    "PathAlign": "path_align_scale",
    "GoalAlign": "goal_align_scale",
}
_MPPI_CRITICS = {
    "CostCritic": "cost_weight",
    "GoalCritic": "goal_weight",
    "PathAlignCritic": "path_align_weight",
    "PathFollowCritic": "path_follow_weight",
    "PathAngleCritic": "path_angle_weight",
    "PreferForwardCritic": "prefer_forward_weight",
}
PLUGINS: Mapping[str, Plugin] = {
    "dwb_core::DWBLocalPlanner": Plugin(
        law=DWB,
        names={f"{critic}.scale": name for critic, name in _DWB_CRITICS.items()}
        | {"PathAlign.forward_point_distance": "forward_point_distance"},
        critics=_DWB_CRITICS,
        defaults={},
    ),
    "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController": Plugin(
        law=RegulatedPurePursuit, names={"max_linear_vel": "desired_linear_vel"}, critics={}, defaults={}
    ),
    "nav2_mppi_controller::MPPIController": Plugin(
        law=PathIntegral,
        names={f"{critic}.cost_weight": name for critic, name in _MPPI_CRITICS.items()},
        critics=_MPPI_CRITICS,
        defaults={"batch_size": 1000, "time_steps": 56, "model_dt": 0.05},
    ),
}
_SIDEWAYS = 0.5
"""Default of ``vy_max`` of MPPI in m/s, which counts for a robot that can drive sideways."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Nav2Controller:
    """A controller of a file.

    Parameters
    ----------
    name : str
        Its name.
    law : law
        The law.
    entries : mapping of str to YamlSection
        Entries of the file by the fields of the law that they gave.
    used : frozenset of str
        Keys that were looked at, below its name.
    path : tuple of str or int
        Keys below each other that lead to it.
    sections : frozenset of str
        Maps within it.
    off : frozenset of str
        Fields of the law whose critics are off.
    """

    name: str
    law: LocalPlanner
    entries: Mapping[str, YamlSection]
    used: frozenset[str]
    path: tuple[str | int, ...]
    sections: frozenset[str]
    off: frozenset[str]


def controllers_of(found: Mapping[str, Parameters], inflation: Mapping[str, float | None]) -> Iterator[Nav2Controller]:
    """Yield the controllers of a file by their parameters, with the inflation of the local costmap."""
    for name, parameters in found.items():
        entry = parameters["plugin"]
        # Older files join the parts of a name with a slash.
        plugin = PLUGINS.get(entry.text().replace("/", "::"))
        if plugin is None:
            raise entry.error(f"be one of {', '.join(PLUGINS)}", meant(entry.text(), PLUGINS), code="plugin")
        yield _controller(name, plugin, parameters, inflation)


def _controller(
    name: str, plugin: Plugin, parameters: Parameters, inflation: Mapping[str, float | None]
) -> Nav2Controller:
    kinds = {each.name: each.default for each in fields(plugin.law) if each.init}  # type: ignore[arg-type]  # a dataclass
    given: dict[str, Any] = dict(plugin.defaults)
    given |= {key: value for key, value in inflation.items() if value is not None and key in kinds}
    own_names = {field for key, field in plugin.names.items() if "." in key}
    used, entries = {"plugin"}, {}
    for key, entry in parameters.items():
        field = plugin.names.get(key, "" if key in own_names else key)
        if field not in kinds or field in inflation:
            continue
        given[field] = _value(entry, kinds[field])
        entries[field] = entry
        used.add(key)
    if plugin.law is PathIntegral:
        given["vy_max"] = _sideways(parameters, given)
        used.add("motion_model")
    off = frozenset(field for critic, field in plugin.critics.items() if not _is_on(critic, parameters, used))
    given |= dict.fromkeys(off, 0.0)
    try:
        law = plugin.law(**given)
    except InvalidParameterError as error:
        entry = entries.get(error.argument, parameters["plugin"])
        raise entry.error(error.requirement) from None
    path = tuple(parameters["plugin"].path)
    sections = {str(entry.path[-2]) for entry in parameters.values() if len(entry.path) == len(path) + 1}
    return Nav2Controller(
        name=name, law=law, entries=entries, used=frozenset(used), path=path[:-1], sections=frozenset(sections), off=off
    )


def doubts_of(controller: Nav2Controller) -> Iterator[ResultWarning]:
    """Yield doubts about what the file does not say of a controller."""
    law = controller.law
    if isinstance(law, DWB) and "max_speed_xy" not in controller.entries and law.max_speed_xy < law.max_vel_x:
        message = (
            f"no max_speed_xy for {controller.name}: {law.max_speed_xy:g} m/s is taken, less than max_vel_x, "
            f"{law.max_vel_x:g} m/s"
        )
        yield ResultWarning("assumed", "max_speed_xy", message)


def _value(entry: YamlSection, default: object) -> object:
    if isinstance(default, bool):
        return entry.flag()
    if isinstance(default, int):
        return entry.whole()
    return entry.text() if isinstance(default, str) else entry.number()


def _sideways(parameters: Parameters, given: Mapping[str, Any]) -> float:
    """Return the largest speed to the sides: none without a motion model that has one."""
    model = parameters.get("motion_model")
    return float(given.get("vy_max", _SIDEWAYS)) if model is not None and "Omni" in model.text() else 0.0


def _is_on(critic: str, parameters: Parameters, used: set[str]) -> bool:
    """Return whether a critic counts; a power other than 1 is refused."""
    listed, enabled = parameters.get("critics"), parameters.get(f"{critic}.enabled")
    power = parameters.get(f"{critic}.cost_power")
    if power is not None:
        used.add(f"{critic}.cost_power")
        if power.whole() != 1:
            raise power.error("be 1: costs are not raised to a power")
    for key in ("critics", f"{critic}.enabled"):
        if key in parameters:
            used.add(key)
    return (listed is None or critic in listed.texts()) and (enabled is None or enabled.flag())


def changes(controller: Nav2Controller, law: LocalPlanner) -> Iterator[tuple[tuple[str | int, ...], Any]]:
    """Yield what has to be changed in a file for another law of the same kind: keys below each other, and values."""
    plugin = next(each for each in PLUGINS.values() if each.law is type(law))
    written = {name: key for key, name in plugin.names.items()}
    base = controller.path
    for each in fields(law):  # type: ignore[arg-type]  # a dataclass
        name = each.name
        value = getattr(law, name) if each.init else None
        if not each.init or value == getattr(controller.law, name):
            continue
        if name == "prediction" or name in INFLATION:
            where = "the local costmap" if name in INFLATION else "no file of Nav2"
            raise InvalidParameterError(f"laws.{name}", f"be as it was read: it stands in {where}", value)
        if name in controller.off:
            raise InvalidParameterError(f"laws.{name}", "be 0 for a critic that the file switches off", value)
        entry = controller.entries.get(name)
        yield (tuple(entry.path) if entry is not None else (*base, *_parts(controller, written.get(name, name)))), value


def _parts(controller: Nav2Controller, key: str) -> tuple[str, ...]:
    """Return the keys below each other for a new parameter: below a map that is there, else with dots."""
    above, _, last = key.rpartition(".")
    return (above, last) if above and above in controller.sections else (key,)


# ---- what else a file says ---------------------------------------------------------------------------

_OF_APPROACH = ("time_before_collision", "simulation_time_step")


def approaches_of(monitor: Parameters) -> dict[str, dict[str, float]]:
    """Return the polygons of a collision monitor that slow the robot in time."""
    actions = {key.rpartition(".")[0]: each for key, each in monitor.items() if key.endswith(".action_type")}
    found: dict[str, dict[str, float]] = {}
    for name, action in actions.items():
        if action.text() == "approach":
            entries = {key: monitor[f"{name}.{key}"] for key in _OF_APPROACH if f"{name}.{key}" in monitor}
            for entry in entries.values():
                if not entry.number() > 0.0:
                    raise entry.error("be finite and positive")
            found[name] = {key: entry.number() for key, entry in entries.items()}
    return found


def ignored_of(
    nodes: Sequence[Parameters], controllers: tuple[Nav2Controller, ...] | FileError, of_robot: Set[str]
) -> Iterator[str]:
    """Yield the keys of controller server, local costmap and collision monitor that nothing uses, with their paths."""
    server, _, monitor = nodes
    used = {"controller_frequency", "controller_plugins"}
    used |= {f"{name}.{key}" for name in approaches_of(monitor) for key in (*_OF_APPROACH, "action_type")}
    for each in () if isinstance(controllers, FileError) else controllers:
        used |= {f"{each.name}.{key}" for key in each.used}
        critics = server.get(f"{each.name}.critics")
        known = next(plugin for plugin in PLUGINS.values() if plugin.law is type(each.law)).critics
        for critic in [] if critics is None else critics.texts():
            if critic not in known and critics is not None:
                yield f"{'.'.join(map(str, critics.path))}.{critic}"
    for parameters in nodes:
        for key, entry in parameters.items():
            if key not in used and key.rpartition(".")[2] not in of_robot:
                yield ".".join(map(str, entry.path))
