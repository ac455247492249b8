"""Bad arguments of the searches for gains are refused, with an error that names them."""

from __future__ import annotations

import pickle
import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest

from api.spoiled import INF, NAN, POSITIVE, WORD, names, refused, spoiled_calls
from hrsafety import InvalidParameterError, scenarios
from hrsafety import navigation as nav

SCENE = scenarios.configuration("c1")
NOISY = replace(SCENE, measurement=nav.Measurement(scale=0.02))
TINY: dict[str, Any] = {"grid": (2, 2, 2, 2), "refinements": 0}

COUNT = (1.5, "2", None, True, NAN, -1, [], (1,))
SHARED: dict[str, tuple[Any, ...]] = {
    "scenarios": ([], SCENE, None, "c1", [None], [SCENE, nav.VirtualForceField()]),
    "law": (SCENE, "off", 3.0),
    "bounds": (
        {"attractive": (0.0, 1.0)},
        {"attractive_gain": 1.0},
        {"attractive_gain": (0.0, 1.0, 2.0)},
        {"attractive_gain": (1.0, 0.0)},
        {"attractive_gain": (-1.0, 1.0)},
        {"attractive_gain": (0.0, INF)},
        {"attractive_gain": (NAN, 1.0)},
        {"attractive_gain": "ab"},
        {"attractive_gain": None},
        [(0.0, 1.0)],
        [(0.0, 1.0)] * 3 + [(1.0, 0.0)],
        [0.0, 1.0, 2.0, 3.0],
        "abcd",
        5.0,
    ),
    "grid": (
        {"attractive": 3},
        {"attractive_gain": 0},
        {"attractive_gain": 2.0},
        {"attractive_gain": "3"},
        (3, 3, 3),
        (3, 3, 3, 0),
        (3, 3, 3, True),
        (1000, 1000, 1000, 1000),
        3,
        "3333",
    ),
    "refinements": COUNT,
    "weights": ((0.5, 0.5), (0.5, 0.5, 0.5), (NAN, 0.5, 0.5), "abc", None),
    "constraints": (
        None,
        5,
        "energy",
        nav.gains.GainConstraint(metric="energy", at_most=5.0),
        [None],
        ["energy"],
        [nav.gains.GainConstraint(metric="energy", at_most=5.0, scenario=1)],
    ),
    "seeds": (0, -1, 1.5, "2", True, 3),  # 3: nothing is measured with noise
    "seed": (*COUNT, 2**64),
    "robustness": (*WORD, "lower_bound"),  # the last: without seeds
    "integrator": WORD,
    "step": (*POSITIVE, 0.007),
    "hold": (None, 1, "yes"),
    "time_limit": tuple(value for value in POSITIVE if value is not None),
    "checkpoint": (5, b"file", [], True),
    "threads": (0, -1, 1.5, "2", NAN, 1025),
    "progress": (5, "print"),
}
OBJECTIVE = ("", "unknown", "H", 1, None, True, ("energy",))
BAD: dict[str, tuple[Any, dict[str, tuple[Any, ...]]]] = {
    "optimize_gains": (
        nav.optimize_gains,
        SHARED
        | {
            "survivors": (*COUNT, 0),
            "local_starts": COUNT,
            "method": (*WORD, "front", "nelder_mead"),
            "objective": OBJECTIVE,
            "evaluations": (100,),  # a grid has its own size
        },
    ),
    "pareto_front": (
        nav.gains.pareto_front,
        SHARED | {"objectives": ((), ("energy",), "energy", None, 5, ("energy", "unknown"), ("energy", None))},
    ),
}


@pytest.mark.parametrize(("name", "argument", "values"), spoiled_calls(BAD))
def test_bad_argument_is_refused_by_name(name: str, argument: str, values: Sequence[Any]) -> None:
    for value in values:
        with refused(value) as caught:
            BAD[name][0](**({"scenarios": [SCENE]} | TINY | {argument: value}))
        assert argument in re.split(r"[\[\].]+", names(caught.value)), repr(value)


@pytest.mark.parametrize("evaluations", [0, -1, 1.5, "9", True])
@pytest.mark.parametrize("method", ["differential_evolution", "cma_es"])
def test_budget_of_a_global_search_is_a_count(method: Any, evaluations: Any) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.optimize_gains([SCENE], method=method, evaluations=evaluations)
    assert caught.value.argument == "evaluations"


def test_a_lower_bound_needs_two_seeds() -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.optimize_gains([NOISY], seeds=1, robustness="lower_bound", **TINY)
    assert caught.value.argument == "seeds"


def test_a_clearance_needs_an_obstacle() -> None:
    scenes = [SCENE, replace(SCENE, obstacles=())]
    limit = nav.gains.GainConstraint(metric="min_clearance", at_least=0.1)
    second = replace(limit, scenario=1)
    for options, name in (
        ({"objective": "min_clearance"}, "objective"),
        ({"constraints": [limit]}, "constraints[0]"),
        ({"constraints": [replace(limit, scenario=0), second]}, "constraints[1]"),
    ):
        with pytest.raises(InvalidParameterError) as caught:
            nav.optimize_gains(scenes, **(TINY | options))
        assert caught.value.argument == name
    found = nav.optimize_gains(scenes, constraints=[replace(limit, scenario=0)], **TINY)
    assert found.best_performance.shape == (2,)


def test_noise_needs_a_held_force() -> None:
    with pytest.raises(InvalidParameterError):
        nav.optimize_gains([NOISY], hold=False, **TINY)


CONSTRAINT: dict[str, tuple[Any, ...]] = {
    "metric": (*WORD, "total", ("energy",)),
    "at_least": (NAN, INF, "1", True, (1.0,)),
    "at_most": (NAN, -INF, "1", False, [1.0]),
    "scenario": (-1, 1.0, "0", True),
}


@pytest.mark.parametrize(
    ("argument", "value"), [(name, value) for name, values in CONSTRAINT.items() for value in values]
)
def test_bad_constraint_is_refused_by_name(argument: str, value: Any) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.gains.GainConstraint(**({"metric": "energy", "at_most": 5.0} | {argument: value}))
    assert names(caught.value) == argument


def test_constraint_needs_a_bound_and_bounds_in_order() -> None:
    for bounds in ({}, {"at_least": 2.0, "at_most": 1.0}):
        with pytest.raises(InvalidParameterError) as caught:
            nav.gains.GainConstraint(metric="energy", **bounds)  # type: ignore[arg-type]  # numbers only
        assert caught.value.argument == "at_least"


def test_constraints_are_compared_and_pickled_by_value() -> None:
    one = nav.gains.GainConstraint(metric="energy", at_least=1, at_most=5, scenario=2)
    assert pickle.loads(pickle.dumps(one)) == one
    assert hash(one) == hash(nav.gains.GainConstraint(metric="energy", at_least=1.0, at_most=5.0, scenario=2))
    assert isinstance(one.at_least, float)


def test_row_of_a_front_that_does_not_exist_is_refused() -> None:
    front = nav.gains.pareto_front([SCENE], objectives=("arrival_time", "energy"), grid=(3, 3, 3, 3), refinements=0)
    assert front.law(0).gains == tuple(front.gains[0])
    for index in (len(front), -1, 0.5):
        with pytest.raises(InvalidParameterError) as caught:
            front.law(index)  # type: ignore[arg-type]  # bad on purpose
        assert caught.value.argument == "index"


@pytest.mark.parametrize(
    ("argument", "values"),
    [("points", (1, 0, 2.5, "9", None)), ("tolerance", POSITIVE), ("threads", (0, "2"))],
)
def test_bad_argument_of_flatness_is_refused(argument: str, values: tuple[Any, ...]) -> None:
    search = nav.optimize_gains([SCENE], local_starts=0, **TINY)
    for value in values:
        with pytest.raises(InvalidParameterError) as caught:
            search.flatness(**{argument: value})
        assert caught.value.argument == argument
