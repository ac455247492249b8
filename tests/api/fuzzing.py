"""Calls that are right, files that are right, and values that break the rules of most arguments.

The package `fuzz` spoils them.
"""

from __future__ import annotations

import wave
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from hrsafety import arms, contact, datasets, impact, io, reactive, scenarios, standards, sweep
from hrsafety import navigation as nav

NAN, INF = float("nan"), float("inf")
SCENE = nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[nav.Disc(center=(2.45, 0.595), radius=0.1)])
SHORT = replace(SCENE, time_limit=0.6)
FIELD = nav.VirtualForceField()
ARRAY = reactive.MicrophoneArray()
TIME = np.linspace(0.0, 0.02, 21)
PULSE = 10.0 * np.sin(np.pi * TIME / 0.02)
FLIGHT = np.arange(0.0, 0.2, 1e-3)
DROP = impact.identification.drop_trajectory(
    FLIGHT, height=0.05, mass=1.54, stiffness=24250.0, damping_ratio=0.112, friction=2.0
)
PARTS: dict[str, Any] = {
    "manipulator": impact.MANIPULATOR_1,
    "foam": impact.FOAM_1,
    "head": impact.Head.minimum(),
    "closing_speed": 1.25,
}
SOUND: dict[str, Any] = {"range": 1.0, "bearing": 0.2}
BURST = reactive.Burst(duration=0.01)
HEARD = reactive.record_burst(BURST, ARRAY, **SOUND)
AXIS = sweep.Axis(name="foam_damping", low=0.0, high=100.0)
WALK = {"time_s": [0.0, 0.4, 0.8], "person": [7, 7, 7], "position": [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]]}
RECORDING = datasets.Recording(**WALK)
WEIGHED, LIMITS = arms.Arm.example(), standards.limits()
# All joints but two: a grid of ten values of six joints is a million poses.
STILL = dict.fromkeys(WEIGHED.joint_names[:4], 0.0)
POINT: dict[str, Any] = {"joints": np.zeros(6), "link": "tool", "point": (0.0, 0.0, 0.1), "threads": 1}
APART = {"reaction_time": 0.1, "deceleration": 3.0, "human_speed": 1.6, "intrusion": 0.2, "uncertainty": 0.1}
LEADER = reactive.FollowerLayouts(kind="static").scene(0)

PAD = contact.Covering(
    material=contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9), thickness=0.02, shape="flat", area=4e-3
)
TOUCH: dict[str, Any] = {"robot": 16.0, "body": 0.6, "region": 75e3}
HIT = contact.Contact(**TOUCH, covering=PAD)
BORNE = {"force": 280.0, "pressure": 3.8e6}
TRAP = nav.StaticMap.from_polylines([[(3.0, -1.5), (3.0, 1.5)], [(1.0, 1.5), (3.0, 1.5)], [(1.0, -1.5), (3.0, -1.5)]])
WALKER = nav.Person(start=(1.0, 2.0), route=[(3.0, 2.0)])
CROSSER = nav.Robot(start=(0.0, 0.0), goal=(3.0, 0.0))


def _crowd(**given: Any) -> nav.Trajectory:
    return nav.simulate(nav.World(**given))


def _scores(**given: Any) -> tuple[object, ...]:
    """Return the columns of the metrics of positions."""
    return tuple(nav.metrics.evaluate(**given).columns().items())


def _update(**told: Any) -> object:
    """Answer the second update of a new controller."""
    law = nav.SafeNavigation(FIELD, shield=nav.Shield(), yielding=nav.Yielding())
    controller = nav.Controller(law, nav.HolonomicRobot(), (5.0, 0.0), people=2)
    controller.update(0.0, (0.0, 0.0), (0.0, 0.0))
    return controller.update(**told)


# Calls that are right, and cheap enough to be made thousands of times.
CALLS: dict[str, tuple[Callable[..., Any], dict[str, Any]]] = {
    "HolonomicRobot": (nav.HolonomicRobot, {"mass": 10.0, "radius": 0.2, "max_speed": 1.0, "max_acceleration": 2.0}),
    "Disc": (nav.Disc, {"center": (1.0, 2.0), "radius": 0.3, "active_radius": None, "critical_radius": None}),
    "MovingDisc": (nav.MovingDisc, {"center": (1.0, 2.0), "velocity": (0.1, 0.0), "radius": 0.3}),
    "Rectangle": (nav.Rectangle, {"center": (1.0, 2.0), "length": 1.0, "width": 0.5}),
    "MovingRectangle": (
        nav.MovingRectangle,
        {"center": (1.0, 2.0), "length": 1.0, "width": 0.5, "velocity": (0.1, 0.0), "heading": 0.2},
    ),
    "Human": (nav.Human, {"start": (1.0, 2.0), "velocity": (0.4, 0.0), "stop": None, "radius": 0.3}),
    "Human.from_path": (nav.Human.from_path, {"time": [0.0, 1.0], "position": [[0.0, 0.0], [1.0, 0.0]]}),
    "Measurement": (nav.Measurement, {"scale": 0.01, "distribution": "uniform", "of": "both"}),
    "Scenario": (
        nav.Scenario,
        {
            "start": (3.9, 0.6),
            "goal": (0.0, 0.6),
            "obstacles": [nav.Disc(center=(2.0, 0.5), radius=0.1)],
            "control_period": 0.06,
            "time_limit": 60.0,
            "rest_time": 5.0,
            "seed": 0,
        },
    ),
    "VirtualForceField": (nav.VirtualForceField, {"attractive_gain": 1.0, "repulsive_gain": 2.0, "gain_ratio": 0.2}),
    "VelocityObstacle": (nav.VelocityObstacle, {"margin": 0.1, "horizon": 5.0, "selection": "to_goal"}),
    "FieldDStar": (nav.FieldDStar, {"resolution": 0.1, "margin": 0.1, "horizon": 0.2}),
    "RapidlyExploringRandomTree": (
        nav.RapidlyExploringRandomTree,
        {"step": 0.4, "draws": 100, "waypoints": 5, "safety_draws": 3},
    ),
    "Reciprocal": (nav.OptimalReciprocalCollisionAvoidance, {"horizon": 5.0}),
    "simulate": (nav.simulate, {"scenario": SHORT, "law": FIELD, "step": 0.01, "hold": True}),
    "simulate as built": (
        nav.simulate,
        {"scenario": SHORT, "law": FIELD, "step": 0.01, "built": nav.robots.AsBuilt()},
    ),
    "simulate_batch": (
        nav.simulate_batch,
        {
            "scenarios": [SHORT],
            "law": FIELD,
            "gains": [(3.0, 20.0, 17.0, 0.25)],
            "step": 0.01,
            "threads": 1,
            "lanes": None,
        },
    ),
    "simulate_many": (nav.simulate_many, {"scenarios": SHORT, "laws": FIELD, "seeds": 2, "paths": True, "threads": 1}),
    "command": (nav.laws.command, {"law": FIELD, "scenario": SHORT, "position": (3.0, 0.7), "velocity": (0.0, 0.1)}),
    "force_field": (nav.laws.force_field, {"law": FIELD, "scenario": SHORT, "position": [[3.0, 0.7], [2.0, 1.5]]}),
    "region_radii": (
        nav.region_radii,
        {"robot": nav.HolonomicRobot(), "obstacle": nav.Disc(center=(1.0, 0.0), radius=0.2), "control_period": 0.06},
    ),
    "Vision": (nav.sensing.Vision, {"period": 0.06, "delay": 0.1, "drop_probability": 0.1, "compensated": False}),
    "observe": (
        nav.sensing.observe,
        {"vision": nav.sensing.Vision(), "time": TIME, "position": np.zeros((21, 2)), "seed": 0, "stream": 0},
    ),
    "Camera": (nav.sensing.Camera, {"focal_length": 0.005, "image_size_px": (64, 48)}),
    "track": (
        nav.tracking.track,
        {
            "reference": nav.tracking.CircleReference(center=(0.0, 0.0), radius=2.0, speed=0.5),
            "position": (0.0, 0.0),
            "control_period": 0.06,
            "step": 0.01,
            "duration": 0.6,
        },
    ),
    "WheelReference.sine": (
        nav.robots.WheelReference.sine,
        {"speed": 1.0, "frequency": 0.5, "duration": 0.1, "period": 1e-3},
    ),
    "open_loop_tests": (
        nav.robots.open_loop_tests,
        {"drive": nav.robots.HOLONOMIC_WHEELS[0], "commands": [0.3], "repeats": 1, "duration": 0.1, "seed": 0},
    ),
    "Foam": (impact.Foam, {"stiffness": 24e3, "damping": 50.0}),
    "impact.simulate": (impact.simulate, {**PARTS, "duration": 0.01, "step": 1e-3, "method": "exact"}),
    "metrics": (impact.metrics, {**PARTS, "horizon": None}),
    "metrics_batch": (impact.metrics_batch, {**PARTS, "closing_speed": [0.5, 1.0], "threads": 1, "lanes": None}),
    "gradients": (impact.gradients, dict(PARTS)),
    "hic": (impact.hic, {"time": TIME, "acceleration_g": PULSE}),
    "channel_filter": (impact.criteria.channel_filter, {"time": FLIGHT, "signal": np.sin(FLIGHT), "channel_class": 60}),
    "hic_of_pulse": (impact.criteria.hic_of_pulse, {"shape": "half_sine", "peak_g": 50.0, "duration": 0.01}),
    "identify_foam": (
        impact.identify_foam,
        {
            "static_force": 24e3 * np.linspace(0.0, 0.008, 9),
            "static_compression": np.linspace(0.0, 0.008, 9),
            "drop_time": FLIGHT,
            "drop_position": DROP,
            "moving_mass": 1.54,
            "bootstrap": 0,
        },
    ),
    "Sonar": (reactive.Sonar, {"rays": 5, "beam_width": 0.5, "most_range": 3.0, "temperature": 20.0}),
    "Sonar.readings": (reactive.Sonar().readings, {"shapes": [], "poses": (0.0, 0.0, 0.0), "seed": 0}),
    "speed_of_sound": (reactive.sonar.speed_of_sound, {"temperature": 20.0}),
    "doppler_frequency": (
        reactive.sound.doppler_frequency,
        {"frequency": 1000.0, "speed_of_sound": 340.0, "observer_speed": 0.1},
    ),
    "skirt_safe_distance": (reactive.skirt.skirt_spacing, {"sensors": 9, "sensor_length": 0.046}),
    "UltrasonicSkirt": (reactive.UltrasonicSkirt, {"sensors": 9, "rays": 5, "firing_period": 0.02}),
    "skirt_test": (reactive.skirt_test, {"layouts": 1, "repeats": 1, "seed": 0, "threads": 1}),
    "experiment": (
        reactive.experiment,
        {"kind": "static", "law": "active", "layouts": 1, "touching": False, "first_seed": 0, "threads": 1},
    ),
    "FollowerLayouts": (reactive.FollowerLayouts, {"kind": "static"}),
    "follow": (reactive.follow, {"scene": LEADER, "law": reactive.VirtualImpedance(), "seed": 0}),
    "Burst": (reactive.Burst, {"duration": 0.01, "seed": 0}),
    "Converter": (reactive.Converter, {"sample_rate": 1e5, "bits": 10}),
    "record_burst": (reactive.record_burst, {"burst": BURST, "array": ARRAY, **SOUND, "samples": 2000, "seed": 0}),
    "estimate_delays": (reactive.estimate_delays, {"recording": HEARD, "array": ARRAY, "window": 500}),
    "locate": (reactive.locate, {"array": ARRAY, "delay_12": 1e-4, "delay_13": 2e-4, "arrival_deviation": 1e-6}),
    "locate_batch": (reactive.locate_batch, {"array": ARRAY, "delay_12": [1e-4], "delay_13": [2e-4], "threads": 1}),
    "jittered_fixes": (reactive.sound.jittered_fixes, {"array": ARRAY, **SOUND, "runs": 2, "seed": 0, "threads": 1}),
    "Payload": (arms.Payload, {"link": "tool", "mass": 1.0, "center": (0.0, 0.0, 0.1), "inertia": np.zeros((3, 3))}),
    "Arm.from_urdf": (
        arms.Arm.from_urdf,
        {"path_or_text": WEIGHED.urdf, "payload": ("tool", 1.0), "armature": {"elbow": 0.1}, "locked": ["turn"]},
    ),
    "Arm.effective_mass": (WEIGHED.effective_mass, POINT | {"direction": (1.0, 0.0, 0.0)}),
    "Arm.point_masses": (WEIGHED.point_masses, POINT | {"direction": (1.0, 0.0, 0.0)}),
    "nearest_inertia": (arms.nearest_inertia, {"inertia": np.diag([0.1, 0.1, 0.6])}),
    "Arm.velocity": (WEIGHED.velocity, POINT | {"rates": np.ones(6)}),
    "workspace": (
        arms.workspace,
        {"arm": WEIGHED, "link": "tool", "samples": 4, "grid": None, "seed": 0, "fixed": STILL},
    ),
    "along": (arms.along, {"arm": WEIGHED, "time": [0.0, 1.0, 2.0], "joints": np.zeros((3, 6)), "link": "tool"}),
    "limits": (standards.limits, {"name_or_path": "iso_ts_15066_2016"}),
    "LimitSet.contact": (LIMITS.contact, {"region": "chest", "contact": "transient", "area": "sternum"}),
    "ContactLimit.verdict": (LIMITS.contact("chest").verdict, {"force": 100.0, "pressure": 1e5}),
    "separation_distance": (standards.separation_distance, {"robot_speed": 1.0, **APART}),
    "separation_speed": (standards.separation_speed, {"distance": 1.0, **APART}),
    "speed_over_distance": (
        standards.speed_over_distance,
        {"distance": [0.5, 1.0], "contact_speed": 0.2, "max_speed": 1.0, **APART},
    ),
    "StoppingData": (
        standards.StoppingData,
        {"speed": [0.0, 1.0], "time": [0.0, 0.1], "distance": [0.0, 0.1], "load": 0.0, "extension": 0.0},
    ),
    "minimum_distance": (standards.minimum_distance, {"stopping_time": 0.3, "capability": 0.014, "height": None}),
    "random_crowd": (scenarios.random_crowd, {"people": 2, "seed": 0}),
    "random_traffic": (scenarios.random_traffic, {"obstacles": 2, "seed": 0}),
    "Recording": (datasets.Recording, dict(WALK)),
    "Recording.humans": (RECORDING.humans, {"start_time": 0.2, "duration": 1.0}),
    "Contact": (contact.Contact, {**TOUCH, "covering": PAD, "max_strain": 0.7, "drive": contact.Support()}),
    "Contact bare": (contact.Contact, {**TOUCH, "area": 1e-4}),
    "Contact.allowed_speed": (HIT.allowed_speed, {"limits": dict(BORNE), "human_speed": 0.1}),
    "Contact.allowed_speeds": (
        HIT.allowed_speeds,
        {"limits": dict(BORNE), "robot_mass": [8.0, 16.0], "thickness": [0.01, 0.02], "threads": 1},
    ),
    "Contact.simulate": (HIT.simulate, {"speed": 0.3, "horizon": 0.1}),
    "Contact.simulate_many": (HIT.simulate_many, {"speed": [0.3, 0.5], "body_mass": 0.6, "threads": 1}),
    "Contact.thickness": (HIT.thickness, {"speed": 0.8, "limits": dict(BORNE)}),
    "Contact.probability": (
        HIT.probability,
        {"speed": 0.8, "limits": dict(BORNE), "body_mass": 0.6, "draws": 200, "seed": 1},
    ),
    "Contact.sensitivity": (HIT.sensitivity, {"limits": dict(BORNE)}),
    "contact.contact_speed_limit": (
        contact.contact_speed_limit,
        {
            "base": contact.HolonomicBase(mass=20.0, inertia=0.8),
            "covering": None,
            "point": (0.2, 0.0),
            "normal": (1.0, 0.0),
            "regions": [LIMITS.contact("lower_leg")],
            "area": 1e-4,
        },
    ),
    "Covering.column": (PAD.column, {"compression": 0.01}),
    "crowd.decide": (
        nav.crowd.decide,
        {
            "model": nav.crowd.Moussaid(),
            "position": [(0.0, 0.0), (1.0, 0.0)],
            "velocity": [(0.0, 1.0), (0.0, 0.0)],
            "goal": [(5.0, 0.0), (1.0, 4.0)],
            "radius": 0.2,
            "desired_speed": 1.0,
            "walls": [nav.Disc(center=(2.0, 0.0), radius=0.1)],
            "step": 0.05,
        },
    ),
    "crowd.simulate": (_crowd, {"people": [WALKER], "robots": [CROSSER], "step": 0.05, "time_limit": 1.0, "seed": 0}),
    "metrics.evaluate": (
        _scores,
        {
            "run": np.stack([TIME, 0.0 * TIME], axis=1),
            "people": np.full((21, 1, 2), 1.5),
            "step": 0.1,
            "goal": (2.0, 0.0),
            "robot_radius": 0.2,
        },
    ),
    "Shield.decide": (
        nav.Shield().decide,
        {"wanted": (0.5, 0.0), "velocity": (0.1, 0.0), "people": [(2.0, 0.0)], "max_acceleration": 10.0},
    ),
    "Controller.update": (
        _update,
        {
            "time": 0.06,
            "position": (0.0, 0.0),
            "velocity": (0.1, 0.0),
            "people": {"a": (3.0, 0.0, 0.0, 0.0)},
            "gone": (),
        },
    ),
    "StaticMap.clearance": (TRAP.clearance, {"point": (0.0, 0.0)}),
    "StaticMap.ray": (TRAP.ray, {"start": (0.0, 0.0), "bearing": 0.1}),
    "StaticMap.boundary_points": (TRAP.boundary_points, {"point": (0.0, 0.0), "reach": 2.0, "kappa": 0.5}),
    "Guide.plan": (
        nav.Guide(spacing=0.2).plan,
        {"map": TRAP, "radius": 0.2, "start": (0.0, 0.0), "goal": (5.0, 0.0)},
    ),
    "Axis": (sweep.Axis, {"name": "x", "low": 0.0, "high": 1.0, "points": 4}),
    "LatinHypercube": (sweep.LatinHypercube, {"axes": [AXIS], "size": 8, "seed": 0}),
    "Sobol": (sweep.Sobol, {"axes": [AXIS], "size": 8, "seed": 0}),
    "Design.rows": (sweep.LatinHypercube([AXIS], 8).rows, {"start": 0, "stop": 4}),
}

UNALIGNED = np.frombuffer(b"x" + np.linspace(0.0, 1.0, 21).tobytes(), dtype=np.uint8)[1:].view(np.float64)

# Values that break the rules of most arguments.
EVIL: tuple[Any, ...] = (
    *(None, True, "", "to_goal", "abc", b"x", object(), (), [], {}, 1j, NAN, INF, -INF, 0, 0.0, -1, -1.0),
    *(1e-308, 1e-12, 1e200, 1e308, -1e308, 2**31, 2**53, 2**63, 2**64, 10**400, -(2**63)),
    *((1.0,), (NAN, 0.0), (1.0, 2.0), (1e308, -1e308), [[1.0, 2.0]], [[1.0], [2.0, 3.0]], ["a", "b"]),
    *(np.ones(3), np.zeros((0, 2)), np.full(21, NAN), np.arange(21), np.array("x"), np.array(1.0), UNALIGNED),
    *(np.array([1, "a"], dtype=object), np.float32(0.5), np.int8(3), np.datetime64(0, "s")),
)


def right_files(folder: Path) -> dict[Path, Callable[[Path], Any]]:
    """Write a file of each kind that the package reads, and return its readers."""
    sound = folder / "three.wav"
    with wave.open(str(sound), "wb") as file:
        file.setnchannels(3)
        file.setsampwidth(2)
        file.setframerate(48000)
        file.writeframes(np.arange(-60, 60, dtype="<i2").tobytes())
    scene = folder / "scene.toml"
    scene.write_text(
        'start = [4.0, 0.0]\ngoal = [0.0, 0.0]\n[[obstacles]]\ntype = "disc"\ncenter = [2.0, 0.5]\nradius = 0.1\n',
        encoding="utf-8",
    )
    people = folder / "people.csv"
    people.write_text("frame,t_s,ped_id,x_m,y_m\n0,0.0,7,0.0,1.0\n10,0.4,7,0.5,1.0\n", encoding="utf-8")
    checkpoint = folder / "search.checkpoint"
    options: dict[str, Any] = {"grid": (2, 1, 1, 1), "refinements": 0, "local_starts": 0, "threads": 1}
    nav.optimize_gains([SHORT], checkpoint=checkpoint, **options)
    return {
        sound: reactive.read_recording,
        scene: scenarios.load,
        people: io.load_people,
        checkpoint: lambda path: nav.optimize_gains([SHORT], checkpoint=path, **options),
    }
