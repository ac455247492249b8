"""Frozen dataclasses whose methods are generated on first use are those of the standard library."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
import re
import subprocess
import sys
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import field
from pathlib import Path
from typing import Any, ClassVar, Generic, TypeVar

import pytest

from hrsafety import _records

T = TypeVar("T")
Decorator = Callable[..., Callable[[type], Any]]


def plain(dataclass: Decorator) -> Any:
    @dataclass(frozen=True, kw_only=True, slots=True)
    class Plain:
        """Of numbers and a tuple."""

        COUNT: ClassVar[int] = 3
        first: float
        second: float = 2.0
        third: tuple[int, ...] = field(default_factory=tuple)
        hidden: int = field(default=4, init=False, repr=False, compare=False)

        def __post_init__(self) -> None:
            object.__setattr__(self, "second", self.second + 1.0)

    return Plain


def positional(dataclass: Decorator) -> Any:
    @dataclass(frozen=True, slots=True)
    class Positional:
        """By position."""

        first: float
        second: tuple[int, ...] = (1, 2)

    return Positional


def without_equality(dataclass: Decorator) -> Any:
    @dataclass(frozen=True, slots=True, eq=False, repr=False)
    class WithoutEquality:
        """The same as itself only."""

        first: float

    return WithoutEquality


def own_methods(dataclass: Decorator) -> Any:
    @dataclass(frozen=True, slots=True)
    class OwnMethods:
        """With a text and an equality of its own."""

        first: float

        def __repr__(self) -> str:
            return "mine"

        def __eq__(self, other: object) -> bool:
            return True

    return OwnMethods


def derived(dataclass: Decorator) -> Any:
    @dataclass(frozen=True, kw_only=True, slots=True)
    class Base(ABC, Generic[T]):
        """A base."""

        first: float = 1.0

        @abstractmethod
        def doubled(self) -> float: ...

    @dataclass(frozen=True, kw_only=True, slots=True)
    class Derived(Base[int]):
        """With one more, and another default."""

        second: str = "two"
        first: float = 5.0

        def doubled(self) -> float:
            return 2.0 * self.first

    with pytest.raises(TypeError, match="abstract"):
        Base()  # type: ignore[abstract]  # what is tested
    return Derived


SHAPES = [
    (plain, {"first": 1.0}),
    (positional, {"first": 1.0}),
    (without_equality, {"first": 1.0}),
    (own_methods, {"first": 1.0}),
    (derived, {}),
]
each_shape = pytest.mark.parametrize(("declare", "given"), SHAPES, ids=[declare.__name__ for declare, _ in SHAPES])


@each_shape
def test_everything_generated_is_that_of_the_standard_library(declare: Any, given: dict[str, Any]) -> None:
    ours, theirs = declare(_records.dataclass), declare(dataclasses.dataclass)
    assert inspect.signature(ours) == inspect.signature(theirs)
    assert (ours.__name__, ours.__qualname__.split(".")[-1]) == (theirs.__name__, theirs.__qualname__.split(".")[-1])
    assert (ours.__doc__, ours.__module__) == (theirs.__doc__, theirs.__module__)
    assert ours.__slots__ == theirs.__slots__
    assert ours.__match_args__ == theirs.__match_args__
    assert repr(ours.__dataclass_params__) == repr(theirs.__dataclass_params__)
    told = [
        [(each.name, each.type, each.default, each.kw_only) for each in dataclasses.fields(x)] for x in (ours, theirs)
    ]
    assert told[0] == told[1]
    assert (ours.__hash__ is object.__hash__) == (theirs.__hash__ is object.__hash__)
    first, second = ours(**given), theirs(**given)
    assert dataclasses.asdict(first) == dataclasses.asdict(second)
    assert hash(first) == hash(second) or ours.__hash__ is object.__hash__
    assert repr(first).split(" object")[0].split(".")[-1] == repr(second).split(" object")[0].split(".")[-1]
    assert (first == ours(**given)) == (second == theirs(**given))
    assert first != second or declare is own_methods


@each_shape
@pytest.mark.parametrize("name", ["first", "something_new"])
def test_nothing_can_be_changed(declare: Any, given: dict[str, Any], name: str) -> None:
    value = declare(_records.dataclass)(**given)
    with pytest.raises(dataclasses.FrozenInstanceError, match=f"cannot assign to field '{name}'"):
        setattr(value, name, 2.0)
    with pytest.raises(dataclasses.FrozenInstanceError, match=f"cannot delete field '{name}'"):
        delattr(value, name)
    assert not hasattr(value, "__dict__")


def test_wrong_arguments_are_refused_as_by_the_standard_library() -> None:
    for wrong in ({}, {"first": 1.0, "fourth": 2.0}, {"first": 1.0, "hidden": 2}):
        messages = []
        for dataclass in (_records.dataclass, dataclasses.dataclass):
            with pytest.raises(TypeError) as caught:
                plain(dataclass)(**wrong)
            messages.append(str(caught.value).rpartition(".")[2])
        assert messages[0] == messages[1]


@_records.dataclass(frozen=True, slots=True)
class Kept:
    """At the top of its module, so that it can be pickled."""

    first: float
    second: tuple[int, ...] = (1, 2)


def test_values_are_copied_pickled_and_replaced() -> None:
    value = Kept(1.0)
    for again in (copy.copy(value), copy.deepcopy(value), pickle.loads(pickle.dumps(value))):
        assert (again, hash(again)) == (value, hash(value))
    assert dataclasses.replace(value, first=2.0) == Kept(2.0)
    match value:
        case Kept(first, second):
            assert (first, second) == (1.0, (1, 2))


def test_each_is_generated_once_and_only_when_it_is_asked_for() -> None:
    kind = positional(_records.dataclass)
    waiting = [name for name, value in vars(kind).items() if isinstance(value, _records._OnFirstUse)]
    assert {"__init__", "__repr__", "__eq__", "__hash__", "__dataclass_fields__"} <= set(waiting)
    kind(1.0)
    assert inspect.isfunction(vars(kind)["__init__"])
    assert isinstance(vars(kind)["__repr__"], _records._OnFirstUse)
    made = kind.__init__
    kind(2.0)
    assert kind.__init__ is made


def test_threads_may_use_a_class_at_the_same_time() -> None:
    for _ in range(20):
        kind = plain(_records.dataclass)
        found: list[Any] = []
        started = threading.Barrier(4)

        def use(kind: Any = kind, found: list[Any] = found, started: threading.Barrier = started) -> None:
            started.wait()
            value = kind(first=1.0)
            found.append((repr(value).rpartition(".")[2], hash(value), value == kind(first=1.0)))

        threads = [threading.Thread(target=use) for _ in range(4)]
        for each in threads:
            each.start()
        for each in threads:
            each.join()
        assert len(found) == 4
        assert len(set(found)) == 1


def test_an_import_generates_few_methods() -> None:
    """Of the classes of the parts that compute, gains of laws and default values need some; the others wait."""
    code = """
import hrsafety._records as records
generate, made = records._Declared.made, []
records._Declared.made = lambda self, name: (made.append((self.kind.__name__, name)), generate(self, name))[1]
declare, declared = records._Declared.slotted, []
records._Declared.slotted = lambda self: (declared.append(self.kind.__name__), declare(self))[1]
from hrsafety import arms, contact, impact, navigation, reactive, standards
for package in (arms, contact, impact, navigation, reactive, standards):
    [getattr(package, name) for name in package.__all__]
for package in (navigation.crowd, navigation.gains, navigation.metrics, navigation.sensing):
    [getattr(package, name) for name in package.__all__]
print(len(declared), len(made), sorted(made))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    declared, made = done.stdout.split()[:2]
    assert int(declared) > 100
    assert int(made) < 0.2 * int(declared), done.stdout


def test_no_frozen_class_is_generated_by_the_import() -> None:
    """Frozen dataclasses with slots come from the one place that generates their methods on first use."""
    found = []
    for path in Path(_records.__file__).parent.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        declared = re.search(r"^@(dataclasses\.)?dataclass\(.*frozen=True.*slots=True", text, re.MULTILINE)
        if declared and "from hrsafety._records import dataclass" not in text:
            found.append(path.name)
    assert found == []
