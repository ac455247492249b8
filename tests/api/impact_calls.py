"""Every function and class of the impact part with right arguments, and values that spoil each."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from api.spoiled import (
    INF,
    NAN,
    NOT_NEGATIVE,
    NUMBER,
    OPTIONAL_POSITIVE,
    POSITIVE,
    WORD,
)
from hrsafety import impact

HEAD = impact.Head.minimum()
TIME = np.linspace(0.0, 0.02, 21)
PULSE = 10.0 * np.sin(np.pi * TIME / 0.02)
PARTS = {"manipulator": impact.MANIPULATOR_1, "foam": impact.FOAM_1, "head": HEAD, "closing_speed": 1.25}
BAD_PARTS: dict[str, tuple[Any, ...]] = {
    "manipulator": (None, impact.FOAM_1, "M1", 9.6),
    "foam": (None, impact.MANIPULATOR_1, "Foam 1", {}),
    "head": (None, impact.FOAM_1, 4.4, ()),
    "closing_speed": NUMBER,
}
OPTIONAL_NUMBER = tuple(value for value in NUMBER if value is not None)
LEVELS = {"mass": POSITIVE, "damping": NOT_NEGATIVE, "stiffness": NOT_NEGATIVE}
SIGNAL = (
    (),
    [1.0],
    1.0,
    None,
    "abc",
    [[1.0, 2.0]],
    np.full(21, NAN),
    np.where(TIME > 0.01, INF, TIME),
    TIME[:-1],
    ["a"] * 21,
    1j * TIME,
)
UNSORTED = (TIME[::-1], np.zeros(21), [*TIME[:5], *TIME[4:20]])
DROP_TIME = np.arange(0.0, 0.2, 1e-3)
DROP = 0.05 - 0.5 * 9.8 * DROP_TIME**2

DESIGN = impact.design_foam(impact.MANIPULATOR_1, impact.FoamLimits(), closing_speed=1.25)

Call = tuple[Callable[..., Any], dict[str, Any], dict[str, tuple[Any, ...]]]

CALLS: dict[str, Call] = {
    "Joint": (
        impact.Joint,
        {
            "inertia": 0.06,
            "mechanical_stiffness": 1e3,
            "mechanical_damping": 0.0,
            "control_stiffness": 1e2,
            "control_damping": 1.0,
        },
        {
            **dict.fromkeys(("inertia", "mechanical_stiffness", "control_stiffness"), POSITIVE),
            **dict.fromkeys(("mechanical_damping", "control_damping"), NOT_NEGATIVE),
        },
    ),
    "Manipulator": (impact.Manipulator, {"mass": 9.6, "damping": 250.0, "stiffness": 2e4}, LEVELS),
    "Head": (impact.Head, {"mass": 4.4, "damping": 46.0, "stiffness": 3e3}, LEVELS),
    "Head.simulation": (impact.Head.simulation, {"row": 1}, {"row": (0, 5, -1, 1.0, "1", None, True)}),
    "Foam": (
        impact.Foam,
        {"stiffness": 24e3, "damping": 71.9},
        {
            "stiffness": NOT_NEGATIVE,
            "damping": NOT_NEGATIVE,
            "thickness": POSITIVE,
            "linear_range": OPTIONAL_POSITIVE,
        },
    ),
    "Foam.from_damping_ratio": (
        impact.Foam.from_damping_ratio,
        {"stiffness": 24e3, "damping_ratio": 0.1, "moving_mass": 4.4},
        {"stiffness": NOT_NEGATIVE, "damping_ratio": NOT_NEGATIVE, "moving_mass": POSITIVE},
    ),
    "Manipulator.from_joint": (
        impact.Manipulator.from_joint,
        {"inertia": 0.06, "damping": 1.5, "stiffness": 120.0, "lever_arm": 0.08},
        {"inertia": POSITIVE, "damping": NOT_NEGATIVE, "stiffness": NOT_NEGATIVE, "lever_arm": POSITIVE},
    ),
    "Manipulator.from_two_joints": (
        impact.Manipulator.from_two_joints,
        {
            "mass_matrix": [[3.0, 1.0], [1.0, 0.6]],
            "damping": (40.0, 10.0),
            "stiffness": (8e3, 2e3),
            "second_link": 0.43,
            "lever_arm": 0.4,
        },
        {
            "mass_matrix": (
                np.eye(3),
                1.0,
                None,
                "ab",
                [[1.0, 2.0], [2.0, 1.0]],
                [[1.0, 0.0], [0.5, 1.0]],
                [[NAN, 0.0], [0.0, 1.0]],
                [[-1.0, 0.0], [0.0, -1.0]],
                np.zeros((2, 2)),
            ),
            "damping": ((1.0,), 1.0, (-1.0, 1.0), (NAN, 1.0), "ab", None),
            "stiffness": ((1.0,), 1.0, (-1.0, 1.0), (INF, 1.0), (0.0, 1.0), "ab", None),
            "second_link": POSITIVE,
            "lever_arm": POSITIVE,
            "elbow": NUMBER,
        },
    ),
    "metrics": (
        impact.metrics,
        PARTS,
        {**BAD_PARTS, "manipulator_speed": OPTIONAL_NUMBER, "horizon": OPTIONAL_POSITIVE},
    ),
    "simulate": (
        impact.simulate,
        PARTS,
        {
            **BAD_PARTS,
            "manipulator_speed": OPTIONAL_NUMBER,
            "duration": POSITIVE,
            "step": (*POSITIVE, 1e-300),
            "method": WORD,
            "contact": WORD,
            "equations": WORD,
        },
    ),
    "metrics_batch": (
        impact.metrics_batch,
        PARTS,
        {
            "manipulator": ("M1", impact.FOAM_1, 9.6, None),
            "foam": ("Foam 1", impact.MANIPULATOR_1, None),
            "head": ("head", impact.FOAM_1, None),
            "closing_speed": ("fast", None, ["a"], 1j, object(), [[1.0], [1.0, 2.0]]),
            "manipulator_speed": ("fast", ["a"], 1j),
            "foam_stiffness": ("soft", [None], [True]),
            "head_mass": ("soft", [None]),
            "horizon": OPTIONAL_POSITIVE,
            "fields": WORD,
            "threads": (0, -1, 1.5, "2", NAN, True, 1025, 10**9),
            "lanes": (0, 3, -8, 1.5, "8"),
            "progress": (3, "bar", ()),
        },
    ),
    "hic": (
        impact.hic,
        {"time": TIME, "acceleration_g": PULSE},
        {
            "time": (*SIGNAL, *UNSORTED),
            "acceleration_g": SIGNAL,
            "window": POSITIVE,
            "interpolate": (None, 1, "yes"),
        },
    ),
    **{
        function.__name__: (
            function,
            {"time": TIME, "acceleration_g": PULSE},
            {"time": (*SIGNAL, *UNSORTED), "acceleration_g": SIGNAL, "width": POSITIVE},
        )
        for function in (impact.criteria.average_3ms, impact.criteria.clip_3ms)
    },
    "hic_of_pulse": (
        impact.criteria.hic_of_pulse,
        {"shape": "square", "peak_g": 100.0, "duration": 0.005},
        {"shape": WORD, "peak_g": NOT_NEGATIVE, "duration": POSITIVE, "window": POSITIVE},
    ),
    "pd_gains": (
        impact.identification.pd_gains,
        {"stiffness": 20e3, "damping": 250.0, "lever_arm": 0.078, "torque_constant": 0.27},
        {
            "stiffness": NOT_NEGATIVE,
            "damping": NOT_NEGATIVE,
            "lever_arm": POSITIVE,
            "torque_constant": POSITIVE,
            "viscous_friction": NOT_NEGATIVE,
            "amplifier_gain": POSITIVE,
        },
    ),
    "identify_foam": (
        impact.identify_foam,
        {
            "static_force": [0.0, 24.0, 48.0, 72.0],
            "static_compression": [0.0, 1e-3, 2e-3, 3e-3],
            "drop_time": DROP_TIME,
            "drop_position": DROP,
            "moving_mass": 1.54,
        },
        {
            "static_force": ((), [1.0], None, "abc", [1.0, 2.0], [NAN] * 4),
            "static_compression": ([1.0], None, "abc", [1.0, 2.0], [INF] * 4, np.zeros(4)),
            "drop_time": ((), [0.0], None, "abc", DROP_TIME[::-1], 5.0, {}, [DROP_TIME, DROP_TIME]),
            "drop_position": ((), [0.0], None, "abc", DROP[:-1], np.full(200, NAN), 5.0, [DROP, DROP]),
            "moving_mass": POSITIVE,
            "gravity": POSITIVE,
            "confidence": (*POSITIVE, 1.0, 2.0),
            "contact": WORD,
            "bootstrap": (-1, 1.5, None, "10", True),
            "seed": (-1, 1.5, None, "10", True, 2**64),
        },
    ),
    "fit_open_loop": (
        impact.identification.fit_open_loop,
        {"time": TIME, "angle": TIME**2},
        {"time": (*SIGNAL, *UNSORTED), "angle": SIGNAL},
    ),
    "identify_direct_drive": (
        impact.identification.identify_direct_drive,
        {
            "voltage": [0.3, 0.6, 1.0],
            "acceleration": [0.5, 1.5, 3.7],
            "decay": [0.1, 0.15],
            "inertia": 0.059,
        },
        {
            "voltage": ((), [1.0], None, [0.3, 0.6], [NAN] * 3, [0.3, 0.3, 0.3]),
            "acceleration": ((), [1.0], None, [0.3, 0.6], [NAN] * 3),
            "decay": ((), None, [NAN], "a"),
            "inertia": POSITIVE,
            "amplifier_gain": POSITIVE,
        },
    ),
    "DirectDrive": (
        impact.joints.DirectDrive,
        {"proportional": 448.7, "derivative": 5.579},
        {
            **dict.fromkeys(("inertia", "lever_arm", "torque_constant", "amplifier_gain"), POSITIVE),
            **dict.fromkeys(("proportional", "derivative", "viscous_friction", "static_friction"), NOT_NEGATIVE),
            "voltage_limit": (NAN, 0.0, -1.0, "5", None),
        },
    ),
    "simulate_direct_drive": (
        impact.joints.simulate_direct_drive,
        {
            "drive": impact.joints.DirectDrive(proportional=448.7, derivative=5.579),
            "foam": impact.FOAM_1,
            "head": HEAD,
            "closing_speed": 1.25,
        },
        {
            "drive": (None, impact.MANIPULATOR_1),
            "foam": (None, HEAD),
            "head": (None, impact.ConstrainedHead()),
            "closing_speed": POSITIVE,
            "manipulator_speed": OPTIONAL_NUMBER,
            "duration": POSITIVE,
            "step": (*POSITIVE, 1e-300),
        },
    ),
    "tube_inertia": (
        impact.identification.tube_inertia,
        {"density": 2700.0, "length": 0.664, "width": 0.05, "height": 0.05, "wall": 0.0016},
        {
            **dict.fromkeys(("density", "length", "width", "height"), POSITIVE),
            "wall": (*POSITIVE, 0.03),
        },
    ),
    "drop_trajectory": (
        impact.identification.drop_trajectory,
        {"time": DROP_TIME, "height": 0.05, "mass": 1.54, "stiffness": 24e3, "damping_ratio": 0.1},
        {
            "time": ((), None, "abc", DROP_TIME[::-1], [NAN, 1.0]),
            "height": NOT_NEGATIVE,
            "mass": POSITIVE,
            "stiffness": POSITIVE,
            "damping_ratio": NOT_NEGATIVE,
            "friction": NOT_NEGATIVE,
            "gravity": POSITIVE,
            "contact": WORD,
        },
    ),
}

LIMIT = tuple(value for value in POSITIVE if value is not None)
DAMPING = (None, "soft", [None], [-1.0], [71.9, NAN], INF)

CALLS |= {
    "SetPoint": (
        impact.SetPoint,
        {"segments": ((0.0, 5.0), (0.05, 0.0))},
        {
            "segments": (
                None,
                5.0,
                "ab",
                (1.0, 2.0),
                ((0.0,),),
                ((0.0, 1.0, 2.0),),
                ((-1.0, 5.0),),
                ((0.1, 1.0), (0.0, 2.0)),
                ((0.0, NAN),),
                ((INF, 0.0),),
                (("a", "b"),),
            ),
            "feed_forward": (None, 1, "yes"),
        },
    ),
    "SetPoint.accelerating": (
        impact.SetPoint.accelerating,
        {"acceleration": 5.0, "duration": 0.05},
        {"acceleration": NUMBER, "duration": POSITIVE, "feed_forward": (None, 1, "yes")},
    ),
    "SetPoint.stopping": (
        impact.SetPoint.stopping,
        {"manipulator_speed": 0.25},
        {"manipulator_speed": NUMBER, "detection": NOT_NEGATIVE, "rest": (*POSITIVE, 0.004, 0.001)},
    ),
    "simulate with a set-point": (
        impact.simulate,
        {**PARTS, "set_point": impact.SetPoint.accelerating(5.0, duration=0.05)},
        {"set_point": (1.0, "stop", ((0.0, 5.0),))},
    ),
    "gradients": (
        impact.gradients,
        PARTS,
        {**BAD_PARTS, "manipulator_speed": OPTIONAL_NUMBER, "horizon": OPTIONAL_POSITIVE},
    ),
    "foam_stiffness_upper": (
        impact.foam_stiffness_upper,
        {"manipulator": impact.MANIPULATOR_1, "damping": [71.9], "closing_speed": 1.25},
        {
            "manipulator": (None, impact.FOAM_1),
            "damping": DAMPING,
            "closing_speed": POSITIVE,
            "head": ("head", impact.FOAM_1),
            "peak_head_acceleration_g": LIMIT,
            "peak_contact_force": LIMIT,
            "hic15": LIMIT,
            "hic36": LIMIT,
            "horizon": OPTIONAL_POSITIVE,
        },
    ),
    "foam_stiffness_lower": (
        impact.foam_stiffness_lower,
        {"manipulator": impact.MANIPULATOR_1, "damping": [71.9], "closing_speed": 1.25},
        {
            "manipulator": (None, impact.FOAM_1),
            "damping": DAMPING,
            "closing_speed": POSITIVE,
            "head": ("head", impact.FOAM_1),
            "max_compression": POSITIVE,
            "horizon": OPTIONAL_POSITIVE,
        },
    ),
    "FoamLimits": (
        impact.FoamLimits,
        {},
        dict.fromkeys(("peak_head_acceleration_g", "peak_contact_force", "hic15", "hic36", "max_compression"), LIMIT),
    ),
    "design_foam": (
        impact.design_foam,
        {"manipulator": impact.MANIPULATOR_1, "limits": impact.FoamLimits(), "closing_speed": 1.25},
        {
            "manipulator": (None, impact.FOAM_1),
            "limits": (None, {}, 10.0),
            "closing_speed": POSITIVE,
            "acceleration_head": ("head", impact.ConstrainedHead()),
            "force_head": ("head", impact.FOAM_1),
            "horizon": OPTIONAL_POSITIVE,
        },
    ),
    **{
        f"FoamDesign.{name}": (
            getattr(DESIGN, name),
            {"damping": 71.9},
            {"damping": (*DAMPING, ()) if name == "feasibility" else DAMPING},
        )
        for name in ("upper", "lower", "max_closing_speed", "feasibility")
    },
    **{
        f"FoamDesign.{name}": (getattr(DESIGN, name), {"foam": impact.FOAM_1}, {"foam": (None, "Foam 1", HEAD)})
        for name in ("margin", "accepts")
    },
}

RATES = ((1.0,), 1.0, None, "ab", (NAN, 1.0), (1.0, INF), (1.0, 2.0, 3.0))

CALLS |= {
    "impact_point_speed": (
        impact.joints.impact_point_speed,
        {"rates": (0.2, 0.1), "second_link": 0.43, "lever_arm": 0.4},
        {"rates": RATES, "second_link": NOT_NEGATIVE, "lever_arm": POSITIVE, "elbow": NUMBER},
    ),
    "dashpots_in_series": (
        impact.joints.dashpots_in_series,
        {"damping": (40.0, 10.0), "second_link": 0.43, "lever_arm": 0.4},
        {
            "damping": (*RATES, (0.0, 1.0), (1.0, -1.0)),
            "second_link": NOT_NEGATIVE,
            "lever_arm": POSITIVE,
            "elbow": NUMBER,
        },
    ),
    "uniform_links": (
        impact.joints.uniform_links,
        {"mass": (3.0, 2.0), "length": (0.43, 0.4)},
        {
            "mass": (*RATES, (0.0, 1.0), (1.0, -1.0)),
            "length": (*RATES, (0.0, 1.0), (1.0, -1.0)),
            "elbow": NUMBER,
        },
    ),
    "fit_static": (
        impact.identification.fit_static,
        {"static_force": [0.0, 24.0, 49.0, 72.0], "static_compression": [0.0, 1e-3, 2e-3, 3e-3]},
        {
            "static_force": ((), [1.0], None, "abc", [1.0, 2.0], [NAN] * 4),
            "static_compression": ([1.0], None, "abc", [1.0, 2.0], [INF] * 4, np.zeros(4)),
            "offset": (None, 1, "yes"),
        },
    ),
    "CylinderController": (
        impact.joints.CylinderController,
        {},
        {
            **dict.fromkeys(("acceleration_gain", "velocity_gain", "proportional", "derivative"), NOT_NEGATIVE),
            "sample_time": POSITIVE,
        },
    ),
    "CylinderController.command": (
        impact.joints.CylinderController().command,
        {"desired_position": 0.1, "desired_velocity": 1.0, "position": 0.1, "velocity": 1.0},
        dict.fromkeys(("desired_position", "desired_velocity", "desired_acceleration", "position", "velocity"), NUMBER),
    ),
    "recorded_metrics": (
        impact.recorded_metrics,
        {"time": TIME, "acceleration_g": PULSE},
        {
            "time": (*SIGNAL, *UNSORTED),
            "acceleration_g": SIGNAL,
            **dict.fromkeys(
                ("contact_force", "compression", "manipulator_velocity"),
                tuple(value for value in SIGNAL if value is not None),
            ),
            "start": (*OPTIONAL_NUMBER, -1.0, 0.02, 1.0),
            "linear_range": OPTIONAL_POSITIVE,
        },
    ),
}
