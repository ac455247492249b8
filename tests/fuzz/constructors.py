"""Right arguments for every public constructor; what has a default is taken from the signature."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

import hrsafety
from hrsafety import (
    arena,
    arms,
    contact,
    datasets,
    impact,
    plausibility,
    program,
    reactive,
    ros,
    scenarios,
    standards,
    sweep,
    zones,
)
from hrsafety import gym as environments
from hrsafety import navigation as nav
from hrsafety.navigation.trajectory import Divergence

__all__ = ["NO_CONSTRUCTORS", "constructors", "public_classes"]

Right = dict[str, Any]

# Classes that describe their parameters and are made by the package, not by its users.
NO_CONSTRUCTORS: dict[type, str] = {
    **dict.fromkeys(
        (arms.EffectiveMass, arms.MassHistory, arms.PointMasses, arms.Workspace), "made by functions of arms"
    ),
    **dict.fromkeys((nav.Trajectory, Divergence), "made by a run of a world"),
    **dict.fromkeys((nav.metrics.Falsification, nav.metrics.Pursuit), "made by falsify"),
    **dict.fromkeys((nav.metrics.SafetyDecision, nav.metrics.SafetyRecord), "made by record_safety"),
    nav.laws.ShieldDecision: "made by a shield",
    nav.laws.TwistChoice: "made by a law",
    **dict.fromkeys(
        (arena.Certificate, arena.Leaderboard, arena.Ranks, arena.EntryStanding), "made by functions of the arena"
    ),
    nav.laws.FilterDecision: "made by a filter",
    nav.laws.SafetyFilter: "the base of filters",
    nav.maps.Plan: "made by a map",
    **dict.fromkeys((standards.ContactLimit, standards.SpeedCurve), "made by functions of standards"),
    plausibility.ResultWarning: "made by the package",
    ros.Bridge: "needs a bus",
    **dict.fromkeys((ros.BusRecord, ros.Leg), "made by a bridge"),
    sweep.SweepResult: "made by run and open",
    sweep.Design: "the base of designs",
}

_FOAM = contact.Linear(modulus=1e5)
_PLANNED = contact.PlannedContact(limit=standards.limits().contact("chest", "transient"), speed=0.2)
_MEASUREMENT: Right = {
    **{"place": "tool", "region": "chest", "contact": "transient", "speed": 0.2},
    **{"spring": 25e3, "limit": 280.0},
}
_SWING = program.ArmMotion.from_waypoints(arms.Arm.example(), {"turn": [0.0, 0.5, 1.0]}, acceleration=4.0)
_BESIDE: Right = {"start": 0.0, "end": 1.0, "regions": ["chest"]}
_GRIPPER: Right = {"name": "gripper", "link": "tool", "area": 1e-4}
_MEASURED = contact.PlannedMeasurement(**_MEASUREMENT)
_SAMPLES = np.linspace(0.0, 1.0, 5)
_SQUARE = np.stack([_SAMPLES, np.zeros(5)], axis=1)
_WORLD = nav.World(robots=[nav.Robot(start=(0.0, 0.0), goal=(3.0, 0.0))])
_ZONE = zones.MonitorPolygon(name="Stop", type="circle", action="stop", radius=0.5)
_AXIS = sweep.Axis(name="foam_damping", low=0.0, high=100.0, points=4)
_SPEED = sweep.Axis(name="closing_speed", low=0.1, high=1.0, points=4)


def _idle(_situation: Any) -> Any:
    return np.zeros(2)


def _ahead(observation: Any) -> Any:
    return observation[:2]


def _doubled(x: Any) -> dict[str, Any]:
    return {"y": 2.0 * x}


# Arguments without a default.
REQUIRED: dict[Callable[..., Any], Right] = {
    zones.Conditions: {
        "footprint": 0.22,
        "max_speed": 0.5,
        "max_turn_rate": 1.0,
        "deceleration": 2.5,
        "reaction_time": 0.15,
        "error": 0.02,
        "beam_step": 0.01,
    },
    arms.Arm: {"urdf": arms.Arm.example().urdf},
    arms.Payload: {"link": "tool", "mass": 1.0},
    arms.RollingBase: {"kind": "omni", "mass": 40.0},
    contact.Assumption: {"name": "payload", "value": "2 kg"},
    contact.Avalle: {"plateau": 4e4, "modulus": 1e5, "falloff": 0.1, "densification": 1e3, "exponent": 3.0},
    contact.Cell: {"robot": contact.ContactRobot.of_mass(8.0), "contacts": [_PLANNED]},
    contact.Contact: {"robot": 8.0, "body": 40.0, "region": 25e3},
    nav.ScanController: {
        **{"rollouts": nav.ArcRollouts(), "robot": nav.DifferentialDriveRobot(), "goal": (3.0, 0.0)},
        "lidars": [nav.Lidar(beams=8)],
    },
    nav.Controller: {"law": nav.VirtualForceField(), "robot": nav.HolonomicRobot(), "goal": (3.0, 0.0)},
    contact.Covering: {"material": _FOAM, "thickness": 0.02, "area": 1e-3},
    contact.DifferentialBase: {"mass": 20.0, "inertia": 0.5},
    contact.Drive: {"reaction_time": 0.02, "deceleration": 8.0},
    contact.Hazard: {"hazard": "hand below the tool"},
    contact.MeasurementPlan: {"rows": [_MEASURED]},
    contact.PlannedMeasurement: _MEASUREMENT,
    contact.GibsonAshby: {"modulus": 1e5, "plateau": 1e4, "lock": 0.7},
    contact.HolonomicBase: {"mass": 20.0, "inertia": 0.5},
    contact.Linear: {"modulus": 1e5},
    contact.PlannedContact: {"limit": _PLANNED.limit, "speed": 0.2},
    contact.Region: {"k": 25e3},
    contact.Rusch: {"a": 1e4, "p": 0.5, "b": 1e5, "q": 4.0},
    contact.StressTable: {"strain": [0.0, 0.5, 0.8], "stress": [0.0, 1e4, 1e5]},
    datasets.Recording: {"time_s": [0.0, 0.4], "person": [7, 7], "position": [[0.0, 0.0], [0.5, 0.0]]},
    environments.CrowdEnv: {"world": _WORLD},
    environments.CrowdVectorEnv: {"world": _WORLD},
    environments.Task: {"world": _WORLD},
    impact.Foam: {"stiffness": 24e3, "damping": 50.0},
    impact.Head: {"mass": 4.4, "damping": 46.0, "stiffness": 3e3},
    impact.Joint: {
        "inertia": 0.06,
        "mechanical_stiffness": 1e3,
        "mechanical_damping": 0.0,
        "control_stiffness": 1e2,
        "control_damping": 1.0,
    },
    impact.Manipulator: {"mass": 9.6, "damping": 250.0, "stiffness": 2e4},
    impact.joints.DirectDrive: {"proportional": 300.0, "derivative": 10.0},
    nav.Disc: {"center": (1.0, 2.0), "radius": 0.3},
    nav.Human: {"start": (1.0, 2.0), "velocity": (0.4, 0.0)},
    nav.MovingDisc: {"center": (1.0, 2.0), "radius": 0.3, "velocity": (0.1, 0.0)},
    nav.MovingRectangle: {"center": (1.0, 2.0), "length": 0.6, "width": 0.4, "velocity": (0.1, 0.0)},
    nav.Rectangle: {"center": (1.0, 2.0), "length": 1.0, "width": 0.5},
    nav.Run: {"scenario": nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6)), "law": nav.VirtualForceField()},
    nav.Scenario: {"start": (3.9, 0.6), "goal": (0.0, 0.6), "obstacles": [nav.Disc(center=(2.0, 0.5), radius=0.1)]},
    nav.Robot: {"start": (0.0, 0.0), "goal": (3.0, 0.0)},
    nav.Person: {"start": (0.0, 0.0)},
    nav.Source: {"low": (0.0, 0.0), "high": (1.0, 1.0), "rate": 0.5, "route": [(5.0, 0.5)]},
    nav.gains.GainConstraint: {"metric": "min_clearance", "at_least": 0.1},
    nav.laws.PythonLaw: {"function": _idle},
    nav.laws.SafeNavigation: {"law": nav.VirtualForceField()},
    nav.metrics.Episode: {"position": _SQUARE, "step": 0.1, "goal": (1.0, 0.0), "robot_radius": 0.2},
    nav.robots.Footprint: {"corners": [(0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)]},
    nav.robots.OpenLoopTest: {"command": 0.3, "time": _SAMPLES, "angle": _SAMPLES**2},
    nav.robots.WheelDrive: {
        "inertia": 0.06,
        "viscous_friction": 0.4,
        "static_friction": 0.05,
        "proportional_gain": 100.0,
        "derivative_gain": 20.0,
    },
    nav.robots.WheelReference: {"angle": _SAMPLES, "speed": np.ones(5), "acceleration": np.zeros(5)},
    nav.sensing.AlphaBeta: {"position_gain": 0.5, "velocity_gain": 0.1},
    nav.sensing.ColorPatch: {"height": 0.1},
    nav.sensing.SoundLocalizer: {"carrier": 0},
    nav.tracking.CircleReference: {"center": (0.0, 0.0), "radius": 2.0, "speed": 0.5},
    nav.tracking.LineReference: {"start": (0.0, 0.0)},
    nav.tracking.PathReference: {"time": _SAMPLES, "position": _SQUARE, "velocity": np.zeros((5, 2))},
    program.ContactPoint: _GRIPPER,
    program.DrawnMotions: {"arm": arms.Arm.example(), "velocity": 2.0, "draws": 100},
    program.DrawnProgram: {
        "motion": program.DrawnMotions(arm=arms.Arm.example(), velocity=2.0, draws=100),
        "points": [program.ContactPoint(**_GRIPPER)],
        "segments": [program.Segment(regions=["chest"])],
    },
    program.Move: {"kind": "joint", "to": {"turn": 0.5}},
    program.Program: {
        "motion": _SWING,
        "points": [program.ContactPoint(**_GRIPPER)],
        "segments": [program.Segment(**_BESIDE)],
    },
    program.Segment: _BESIDE,
    program.ZoneRules: {"deceleration": 3.0},
    reactive.Box: {"center": (1.0, 2.0), "size": (0.3, 0.4)},
    reactive.Cylinder: {"center": (1.0, 2.0), "radius": 0.3},
    reactive.FollowerLayouts: {"kind": "static"},
    reactive.FollowerScene: {"leader": reactive.SoundLeader(start=(2.0, 0.0))},
    reactive.MovingObstacle: {"shape": reactive.Cylinder(center=(1.0, 2.0), radius=0.3)},
    reactive.SoundLeader: {"start": (2.0, 0.0)},
    reactive.FollowerSteps: {"scene": reactive.FollowerScene(leader=reactive.SoundLeader(start=(2.0, 0.0)))},
    reactive.SoundRecording: {"samples": np.zeros((3, 8)), "sample_rate": 48e3},
    reactive.Wall: {"start": (1.0, 2.0), "end": (2.0, 2.0)},
    standards.LimitRow: {"region": "chest", "area": None, "contact": "transient"},
    standards.LimitSet: {"id": "own", "title": "Own", "edition": "1", "note": "", "rows": (), "sources": {}},
    standards.StoppingData: {"speed": [0.0, 1.0], "time": [0.0, 0.1], "distance": [0.0, 0.1]},
    environments.PolicyLaw: {"policy": _ahead, "time_limit": 10.0},
    sweep.Axis: {"name": "x", "low": 0.0, "high": 1.0, "points": 4},
    sweep.Column: {"name": "x"},
    sweep.FunctionStudy: {"function": _doubled, "results": ["y"]},
    sweep.Grid: {"axes": [_AXIS, _SPEED]},
    sweep.ImpactStudy: {"manipulator": impact.MANIPULATOR_1, "foam": impact.FOAM_1, "head": impact.Head.minimum()},
    sweep.LatinHypercube: {"axes": [_AXIS], "size": 8},
    sweep.NavigationStudy: {"scenarios": [scenarios.configuration("c1")]},
    sweep.Saltelli: {"axes": [_AXIS], "size": 8},
    sweep.SearchProblem: {
        "axes": [_AXIS],
        "study": sweep.FunctionStudy(function=_doubled, results=["y"]),
        "objectives": {"y": "min"},
    },
    sweep.Sobol: {"axes": [_AXIS], "size": 8},
    zones.CollisionMonitor: {"polygons": [_ZONE]},
    zones.Conditions: {
        "footprint": 0.22,
        "max_speed": 0.5,
        "max_turn_rate": 1.0,
        "deceleration": 2.5,
        "reaction_time": 0.15,
        "error": 0.02,
        "beam_step": 0.0087,
    },
    zones.MonitorPolygon: {"name": "Stop", "type": "circle", "action": "stop", "radius": 0.5},
    zones.VelocityRange: {
        "name": "ahead",
        "corners": [(0.5, 0.3), (0.5, -0.3), (-0.3, 0.0)],
        "linear_min": 0.0,
        "linear_max": 0.5,
        "theta_min": -1.0,
        "theta_max": 1.0,
    },
}

# Other ways to make the same objects.
OTHER_WAYS: dict[str, tuple[Callable[..., Any], Right]] = {
    "ContactRobot.of_mass": (contact.ContactRobot.of_mass, {"mass": 8.0}),
    "ContactRobot.of_base": (
        contact.ContactRobot.of_base,
        {"base": contact.HolonomicBase(mass=20.0, inertia=0.5), "point": (0.2, 0.0), "normal": (1.0, 0.0)},
    ),
    "ContactRobot.of_arm": (contact.ContactRobot.of_arm, {"arm": arms.Arm.example(), "samples": 20}),
    "Manipulator.from_joint": (
        impact.Manipulator.from_joint,
        {"inertia": 0.06, "damping": 1.0, "stiffness": 100.0, "lever_arm": 0.1},
    ),
    "Foam.from_damping_ratio": (
        impact.Foam.from_damping_ratio,
        {"stiffness": 24e3, "damping_ratio": 0.1, "moving_mass": 1.5},
    ),
    "Human.from_path": (nav.Human.from_path, {"time": [0.0, 1.0], "position": [[0.0, 0.0], [1.0, 0.0]]}),
    "Human.from_segments": (
        nav.Human.from_segments,
        {"start": (0.0, 0.0), "segments": [(1.0, (0.1, 0.0), (0.0, 0.0))]},
    ),
    "MovingDisc.from_path": (
        nav.MovingDisc.from_path,
        {"time": [0.0, 1.0], "position": [[0.0, 0.0], [1.0, 0.0]], "radius": 0.2},
    ),
    "MovingRectangle.from_path": (
        nav.MovingRectangle.from_path,
        {"time": [0.0, 1.0], "position": [[0.0, 0.0], [1.0, 0.0]], "length": 0.6, "width": 0.4},
    ),
    "MovingRectangle.from_segments": (
        nav.MovingRectangle.from_segments,
        {"start": (0.0, 0.0), "segments": [(1.0, (0.1, 0.0), (0.0, 0.0))], "length": 0.6, "width": 0.4},
    ),
    "StaticMap.from_polylines": (nav.maps.StaticMap.from_polylines, {"polylines": [[(0.0, 0.0), (1.0, 0.0)]]}),
    "StaticMap.from_polygons": (
        nav.maps.StaticMap.from_polygons,
        {"polygons": [[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]]},
    ),
    "StaticMap.from_grid": (nav.maps.StaticMap.from_grid, {"occupied": np.eye(4, dtype=bool), "resolution": 0.1}),
    "AlphaBeta.from_deviations": (
        nav.sensing.AlphaBeta.from_deviations,
        {"acceleration": 1.0, "position": 0.003, "period": 0.06},
    ),
    "WheelReference.from_speed": (nav.robots.WheelReference.from_speed, {"speed": np.ones(5), "period": 1e-3}),
    "Scenarios.from_arrays": (
        nav.Scenarios.from_arrays,
        {"start": np.zeros((2, 2)), "goal": np.full((2, 2), 5.0), "obstacle_position": np.full((2, 1, 2), 2.5)},
    ),
}


def public_classes() -> Iterator[type]:
    """Yield every class that a public package names."""
    seen: set[type] = set()
    private = ("hrsafety.cli", "hrsafety.reproduce", "hrsafety.pages", "hrsafety.benchmarks", "hrsafety.plotting")
    names = ["hrsafety", *(module.name for module in pkgutil.walk_packages(hrsafety.__path__, "hrsafety."))]
    for name in names:
        place = Path(importlib.util.find_spec(name).origin or "")  # type: ignore[union-attr]  # the module is there
        if "._" in name or name.startswith(private) or (place.name != "__init__.py" and name.count(".") > 1):
            continue
        module = importlib.import_module(name)
        for each in getattr(module, "__all__", ()):
            found = getattr(module, each)
            if inspect.isclass(found) and found not in seen:
                seen.add(found)
                yield found


def _is_constructed(kind: type) -> bool:
    """Return whether users make objects of a class: its documentation then describes parameters."""
    documented = "Parameters\n    ---" in (kind.__doc__ or "")
    return documented and kind not in NO_CONSTRUCTORS and not issubclass(kind, Exception)


def constructors() -> dict[str, tuple[Callable[..., Any], Right]]:
    """Return every public constructor with right arguments, all parameters named.

    Returns
    -------
    dict of str to (callable, dict)
        By name. A parameter whose default is made anew for each object stands as ``...``, and
        is given only when it is spoiled.
    """
    found: dict[str, tuple[Callable[..., Any], Right]] = {}
    for kind in public_classes():
        if not _is_constructed(kind):
            continue
        right: Right = {}
        for parameter in inspect.signature(kind).parameters.values():
            if parameter.kind not in (parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL):
                given = repr(parameter.default) not in ("<factory>",) and parameter.default is not parameter.empty
                right[parameter.name] = parameter.default if given else ...
        name = f"{kind.__module__.split('.')[1]}.{kind.__name__}"
        found[name] = (kind, right | REQUIRED.get(kind, {}))
    return found | OTHER_WAYS
