"""Words, files and poses that are not what was meant are answered with what is."""

from __future__ import annotations

import inspect
import pickle
from collections.abc import Callable
from enum import Enum
from functools import partial
from pathlib import Path
from types import FunctionType

import pytest

from api.namespaces import BELOW, places
from hrsafety import arms, benchmarks, datasets, plausibility, scenarios, sweep, tables
from hrsafety import gym as environments
from hrsafety import navigation as nav
from hrsafety.benchmarks import benchmark
from hrsafety.cli import main
from hrsafety.errors import InvalidParameterError

SCENE = scenarios.configuration("c1")
PACKAGES = (
    *(place for package in BELOW for place in places(package)),
    *(scenarios, datasets, sweep, benchmarks, environments, tables, plausibility),
)


@pytest.mark.parametrize(
    ("call", "meant"),
    [
        (lambda: nav.simulate(SCENE, nav.Masoud(), stp=0.1), "step"),
        (lambda: nav.compare([SCENE], nav.Masoud(), sedes=3), "seeds"),
        (lambda: nav.Scenario(strat=(0, 0), goal=(1, 1)), "start"),
        (lambda: nav.VirtualForceField(atractive_gain=3.0), "attractive_gain"),
        (lambda: nav.Human(start=(0, 0), velocty=(1, 0)), "velocity"),
        (lambda: nav.metrics.falsify(SCENE, nav.Masoud(), person_sped=1.0), "person_speed"),
        (lambda: scenarios.random_traffic(3, sead=2), "seed"),
        (lambda: sweep.NavigationStudy(scenarios=SCENE, lav=3), "law"),
        (lambda: benchmark("s4", case=3), "cases"),
    ],
)
def test_an_unknown_keyword_is_answered_with_the_nearest(call: Callable[[], object], meant: str) -> None:
    with pytest.raises(TypeError, match=f'got an unexpected keyword argument .*; did you mean "{meant}"'):
        call()


def test_a_keyword_error_of_somebody_else_and_one_without_a_near_word_stay_as_they_are() -> None:
    def law(situation: nav.Situation) -> tuple[float, float]:
        return law(situation, stp=1)  # type: ignore[call-arg]  # on purpose

    with pytest.raises(TypeError, match=r"law\(\) got an unexpected keyword argument 'stp'\n"):
        nav.simulate(SCENE, law)
    with pytest.raises(TypeError, match=r"'qqq'$"):
        nav.simulate(SCENE, nav.Masoud(), qqq=1)
    assert pickle.loads(pickle.dumps(nav.simulate)) is nav.simulate
    assert inspect.signature(nav.simulate).parameters["step"].default == 0.01


@pytest.mark.parametrize(
    ("word", "advice"),
    [
        (
            "orca",
            r'"orca" is a word of files and of the command line: give nav.OptimalReciprocalCollisionAvoidance\(\)',
        ),
        ("field", r"give nav.VirtualForceField\(\)"),
        ("orka", r"give nav.OptimalReciprocalCollisionAvoidance\(\)"),
        ("VirtualForceField", r"give nav.VirtualForceField\(\)"),
        ("orca+shield", r"give nav.SafeNavigation\(nav.OptimalReciprocalCollisionAvoidance\(\), ...\)"),
        ("??", r"give an object such as nav.VirtualForceField\(\)"),
    ],
)
def test_the_word_of_a_law_names_its_class(word: str, advice: str) -> None:
    calls = (
        lambda: nav.simulate(SCENE, word),
        lambda: nav.compare([SCENE], word),
        lambda: nav.simulate_many([SCENE], [word]),
        lambda: nav.metrics.falsify(SCENE, word),
        lambda: nav.Run(SCENE, word),
    )
    for call in calls:
        with pytest.raises(InvalidParameterError, match=advice):
            call()


@pytest.mark.parametrize(("word", "near"), [("orka", "orca"), ("feild", "field"), ("masud", "masoud")])
def test_an_unknown_law_of_a_suite_is_answered_with_the_nearest(word: str, near: str) -> None:
    with pytest.raises(InvalidParameterError, match=f'did you mean "{near}"'):
        benchmark("s4", [word])


def test_a_robot_model_in_place_of_a_toml_file_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "own.urdf"
    file.write_text('<?xml version="1.0"?>\n<robot name="own"></robot>\n', encoding="utf-8")
    for command in ("simulate", "contact", "sweep", "optimize"):
        assert main([command, str(file)]) == 2
        told = capsys.readouterr().err
        assert "got a robot model in XML; hrsafety arm reads a model (.urdf) by itself" in told
        assert told.count("own.urdf") == 1
    assert main(["arm", str(file)]) == 2
    assert capsys.readouterr().err.count("own.urdf") == 1


def test_a_pose_in_degrees_is_answered_with_radians_and_not_with_the_check_off() -> None:
    arm = arms.Arm.example()
    pose = [0.0] * len(arm.joint_names)
    pose[0] = 90.0
    with pytest.raises(InvalidParameterError, match=r"joints are in rad, .*: 90.0 degrees are 1.5708 rad") as caught:
        arm.position(pose, link=arm.link_names[-1])
    assert "check_limits" not in str(caught.value)
    pose[0] = 500.0
    with pytest.raises(InvalidParameterError, match="check_limits=False"):
        arm.position(pose, link=arm.link_names[-1])


def public_callables() -> dict[str, Callable[..., object]]:
    """Return functions, constructors and methods of all public namespaces by name."""
    found: dict[str, Callable[..., object]] = {}
    for package in PACKAGES:
        for name in getattr(package, "__all__", ()):
            value = getattr(package, name)
            if isinstance(value, type):
                if issubclass(value, (BaseException, Enum)):
                    continue
                found.setdefault(f"{value.__module__}.{value.__qualname__}", value)
                for each, member in vars(value).items():
                    if not each.startswith("_") and isinstance(member, (FunctionType, classmethod, staticmethod)):
                        call = getattr(value, each)
                        bound = partial(call, object()) if isinstance(member, FunctionType) else call
                        found.setdefault(f"{value.__module__}.{value.__qualname__}.{each}", bound)
            elif isinstance(value, FunctionType):
                found.setdefault(f"{value.__module__}.{name}", value)
    return found


def test_every_public_call_answers_an_unknown_keyword_with_the_nearest() -> None:
    checked = 0
    for name, call in public_callables().items():
        try:
            parameters = inspect.signature(call).parameters.values()
        except (TypeError, ValueError):
            continue
        named = [each.name for each in parameters if each.kind in (each.KEYWORD_ONLY, each.POSITIONAL_OR_KEYWORD)]
        long = [each for each in named if len(each) > 4]
        if not long or any(each.kind is each.VAR_KEYWORD for each in parameters):
            continue
        typed = long[-1][:2] + long[-1][3:]
        if typed in named:
            continue
        with pytest.raises(TypeError) as caught:
            call(**{typed: 1.0})
        assert "did you mean" in str(caught.value), name
        checked += 1
    assert checked > 500
