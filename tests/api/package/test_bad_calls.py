"""Bad arguments of functions give an error that names the argument; nothing else escapes."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

from api.spoiled import (
    INF,
    NAN,
    NUMBER,
    OPTIONAL_NOT_NEGATIVE,
    OPTIONAL_POSITIVE,
    POINT,
    POSITIVE,
    WORD,
    names,
    refused,
    spoiled_calls,
)
from hrsafety import InvalidParameterError, arms, reactive
from hrsafety import navigation as nav

SCENE = nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[nav.Disc(center=(2.45, 0.595), radius=0.1)])
LAW = nav.VirtualForceField()

CALLS: dict[str, tuple[Callable[..., Any], dict[str, Any], dict[str, tuple[Any, ...]]]] = {
    "region_radii": (
        nav.region_radii,
        {"robot": nav.HolonomicRobot(), "obstacle": nav.Rectangle(center=(2, 0), length=1.4, width=0.6)},
        {
            "robot": (None, "robot", nav.Disc(center=(0, 0), radius=1.0)),
            "obstacle": (None, nav.HolonomicRobot(), (1.0, 2.0)),
            "control_period": POSITIVE,
            "faced_side": OPTIONAL_POSITIVE,
            "latency": OPTIONAL_NOT_NEGATIVE,
            "position_error": OPTIONAL_NOT_NEGATIVE,
            "measurement": (0.025, "uniform", nav.HolonomicRobot()),
        },
    ),
    "simulate": (
        nav.simulate,
        {"scenario": SCENE, "law": LAW},
        {
            "scenario": (None, LAW, "c1"),
            "law": (None, SCENE, "vff"),
            "integrator": WORD,
            "step": (*POSITIVE, 0.007, 0.04, 0.07, 1e-320),
            "hold": (None, 1, "yes"),
            "stop_on_contact": (None, 1, "yes"),
        },
    ),
    "evaluate": (
        nav.evaluate,
        {"scenario": SCENE, "law": LAW},
        {
            "scenario": (None, LAW),
            "law": (None, SCENE),
            "weights": (
                (),
                (1.0,),
                (0.5, 0.5),
                (0.5, 0.5, 0.5),
                (1.5, -0.5, 0.0),
                (NAN, 0.5, 0.5),
                "abc",
                None,
                1.0,
                ("a", 0, 0),
            ),
            "integrator": WORD,
            "step": (*POSITIVE, 0.007),
            "hold": (None, 1, "yes"),
        },
    ),
    "simulate_batch": (
        nav.simulate_batch,
        {"scenarios": [SCENE], "law": LAW},
        {
            "scenarios": ([], [None], [LAW], 5, "abc", None, SCENE),
            "law": (None, SCENE),
            "gains": (
                np.empty((0, 4)),
                [1.0, 2.0, 3.0, 4.0],
                [[1.0, 2.0, 3.0]],
                [[1.0, 2.0, 3.0, NAN]],
                [[1.0, 2.0, 3.0, -1.0]],
                [[1.0, INF, 3.0, 1.0]],
                [["a", "b", "c", "d"]],
                "abc",
                {"attractive": [1.0]},
                {"attractive_gain": [1.0, 2.0], "detour_gain": [1.0, 2.0, 3.0]},
                {"attractive_gain": ["a"]},
                {"attractive_gain": []},
                object(),
            ),
            "weights": ((0.5, 0.5), (0.5, 0.5, 0.5), (NAN, 0.5, 0.5)),
            "integrator": WORD,
            "step": (*POSITIVE, 0.007),
            "threads": (0, -1, 1.5, "2", NAN, 1025, 10**9),
            "lanes": (0, 3, -8, 1.5, "8"),
            "progress": (5, "print"),
            "descent": (None, 1, "yes"),
        },
    ),
    **{
        name: (
            function,
            {"law": LAW, "scenario": SCENE, "position": (3.0, 0.7), "velocity": (-0.5, 0.0)},
            {
                "law": (None, SCENE),
                "scenario": (None, LAW),
                "position": POINT,
                "velocity": POINT,
                "time": (*NUMBER, -1.0),
            },
        )
        for name, function in (("force_terms", nav.force_terms), ("lyapunov", nav.lyapunov))
    },
    "force_field": (
        nav.laws.force_field,
        {"law": LAW, "scenario": SCENE, "position": [[3.0, 0.7], [2.0, 1.5]]},
        {
            "law": (None, SCENE),
            "scenario": (None, LAW),
            "position": (
                (3.0, 0.7),
                [[1.0, 2.0, 3.0]],
                "ab",
                None,
                [[NAN, 0.0]],
                [[0.0, INF]],
                [["a", "b"]],
                [[1.0, 2.0], [1.0]],
            ),
            "velocity": ((1.0,), (NAN, 0.0), [[0.0, 0.0]] * 3, "ab", None, [[0.0, 0.0], [INF, 0.0]], 1.0),
            "time": (*NUMBER, -1.0),
        },
    ),
}


@pytest.mark.parametrize(("name", "argument", "values"), spoiled_calls(CALLS))
def test_bad_argument_of_a_function_is_refused_by_name(name: str, argument: str, values: Sequence[Any]) -> None:
    function, right, _ = CALLS[name]
    for value in values:
        with refused(value) as caught:
            function(**{**right, argument: value})
        # The argument may be found inside another: gains[2].gain_ratio, scenarios[0].step.
        assert argument in re.split(r"[\[\].]+", names(caught.value)), repr(value)


def test_faced_side_is_for_rectangles_only() -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.region_radii(nav.HolonomicRobot(), nav.Disc(center=(0, 0), radius=0.1), faced_side=0.6)
    assert names(caught.value) == "faced_side"


def test_lyapunov_function_is_not_defined_in_a_critical_region() -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.lyapunov(LAW, SCENE, position=(2.7, 0.595), velocity=(0.0, 0.0))
    assert names(caught.value) == "position"


def test_measurement_needs_a_held_force() -> None:
    noisy = nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), measurement=nav.Measurement())
    with pytest.raises(InvalidParameterError):
        nav.simulate(noisy, LAW, hold=False)


@pytest.mark.parametrize(
    ("build", "argument"),
    [
        (lambda word: reactive.VirtualImpedance(form=word), "form"),
        (lambda word: dataclasses.replace(nav.HOLONOMIC_WHEELS[0], feedback=word), "feedback"),
        (lambda word: arms.Arm.from_urdf(f"<robot name='{word}'></robot>"), "path_or_text"),
        (lambda word: arms.Arm(f"<robot name='{word}'></robot>"), "urdf"),
        (lambda word: arms.Arm.example(locked=[word]), "locked"),
        (lambda word: arms.Arm.example(armature={word: 1.0}), "armature"),
        (lambda word: arms.Payload(link=word, mass=1.0), "link"),
    ],
)
def test_text_that_no_file_can_hold_is_refused_by_name(build: Any, argument: str) -> None:
    with pytest.raises(InvalidParameterError, match="be text that UTF-8 can hold") as caught:
        build("\ud800")
    assert names(caught.value) == argument
