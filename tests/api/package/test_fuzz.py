"""Some thousand random inputs: only results and errors of the package come out, and a NaN is noticed."""

from __future__ import annotations

import dataclasses
import random
import subprocess
import sys
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import pytest

from api import fuzzing
from fuzz import inputs as drawn
from fuzz.constructors import constructors
from fuzz.inputs import Inputs
from fuzz.watching import worked_off

ROOT = Path(__file__).resolve().parents[3]
MADE = constructors()


@pytest.mark.parametrize("name", fuzzing.CALLS)
def test_the_calls_that_are_spoiled_are_right(name: str) -> None:
    function, arguments = fuzzing.CALLS[name]
    function(**arguments)


@pytest.mark.parametrize("name", MADE)
def test_the_constructors_that_are_spoiled_get_right_arguments(name: str) -> None:
    function, arguments = MADE[name]
    function(**{key: value for key, value in arguments.items() if value is not ...})


@pytest.fixture(scope="module")
def some(tmp_path_factory: pytest.TempPathFactory) -> Inputs:
    return Inputs(seed=20, folder=tmp_path_factory.mktemp("fuzz"))


def test_right_files_are_read(some: Inputs) -> None:
    for path, reader in some._files.values():
        reader(path)


def test_only_results_and_errors_of_the_package_come_out(some: Inputs) -> None:
    outcomes = [some.answer(number) for number in range(12_000)]
    assert [(each.told, each.shown) for each in outcomes if each.answer == "escapes"] == []
    answers = Counter(each.answer for each in outcomes)
    assert min(answers["results"], answers["errors"]) > 500
    assert len({each.target for each in outcomes}) > 0.95 * len(some.names)


@dataclasses.dataclass
class Silent:
    """Accepts anything."""

    value: object = 0.0


def test_a_nan_that_is_kept_and_a_foreign_error_are_escapes(some: Inputs, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(some, "target", lambda _draws: "impact.Foam")
    monkeypatch.setitem(some._targets, "impact.Foam", (Silent, {"value": 0.0}))
    monkeypatch.setattr(drawn, "spoiled", lambda _right, _draws: (1.0, float("nan")))
    assert "silent NaN in value" in some.answer(0).told
    monkeypatch.setitem(some._targets, "impact.Foam", (len, {"obj": 0.0}))
    assert some.answer(0).answer == "escapes"


def test_a_nan_in_a_result_without_a_word_is_an_escape(some: Inputs, monkeypatch: pytest.MonkeyPatch) -> None:
    def answer(value: float) -> dict[str, object]:
        return {"speed": [1.0, value], "time": float("nan")}

    def with_status(value: float) -> SimpleNamespace:
        return SimpleNamespace(speed=value, status="no_impact")

    for function, told in ((answer, "silent NaN in speed.[]"), (with_status, "")):
        monkeypatch.setitem(fuzzing.CALLS, "spoiled", (function, {"value": 0.0}))
        monkeypatch.setitem(some._targets, "spoiled", fuzzing.CALLS["spoiled"])
        monkeypatch.setitem(some._number, "spoiled", 0)
        monkeypatch.setattr(some, "target", lambda _draws: "spoiled")
        monkeypatch.setattr(drawn, "spoiled", lambda _right, _draws: float("nan"))
        some._usual.pop("spoiled", None)
        assert some.answer(0).told == told


def test_an_input_is_the_same_by_its_number(some: Inputs) -> None:
    target, right = some.names[0], {"x": 1.0, "y": (1.0, 2.0)}
    assert target in some._targets
    first, again = (repr(drawn._spoiled(right, random.Random(5))) for _ in range(2))
    assert first == again
    assert some.answer(77) == some.answer(77)


def test_processes_count_every_input(some: Inputs) -> None:
    *_, tally = worked_off(3, "", 100, 400, 2, some.names)
    assert tally.done == 400
    assert tally.escapes == []


def test_command_repeats_one_input(some: Inputs) -> None:
    command = [sys.executable, "-m", "tests.fuzz", "--seed", str(some.seed), "--only", "5"]
    found = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=60)
    outcome = some.answer(5)
    assert found.returncode == 0, found.stdout
    assert found.stdout.split("\n")[:2] == [some.names[outcome.target], f"{outcome.answer}"]
