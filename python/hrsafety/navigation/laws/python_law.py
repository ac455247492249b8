"""A law of your own, written in Python."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from functools import partial
from types import MappingProxyType
from typing import Any, ClassVar, Protocol, TypeAlias, runtime_checkable

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, numbers
from hrsafety._records import dataclass
from hrsafety._words import nearest
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.laws.situation import Situation, fixed, point_mass_of, situation_of

__all__ = ["AnyLaw", "ForceLaw", "PythonLaw", "TwistLaw", "VelocityLaw", "as_law", "class_of", "law_with_gains"]

RULE = (
    "be a Law, a function that takes a Situation and returns a force in N, or an object with the method `command` "
    "(a force in N), `velocity` (a velocity in m/s) or `twist` (speed ahead in m/s and turn rate in rad/s)"
)
ANSWERS = {"command": "force", "velocity": "velocity", "twist": "twist"}
NUMBERS = {"force": ("x, y", "N"), "velocity": ("x, y", "m/s"), "twist": ("speed, turn rate", "m/s and rad/s")}


@runtime_checkable
class ForceLaw(Protocol):
    """An object that drives a robot by forces."""

    def command(self, situation: Situation, /) -> npt.ArrayLike:
        """Return the force in N that acts until the next sample, shape (2,)."""


@runtime_checkable
class VelocityLaw(Protocol):
    """An object that drives a robot by velocities."""

    def velocity(self, situation: Situation, /) -> npt.ArrayLike:
        """Return the velocity in m/s that the robot should have at the next sample, shape (2,)."""


@runtime_checkable
class TwistLaw(Protocol):
    """An object that drives a robot with two wheels by twists."""

    def twist(self, situation: Situation, /) -> npt.ArrayLike:
        """Return the speed ahead in m/s and the turn rate in rad/s until the next sample, shape (2,)."""


AnyLaw: TypeAlias = Law | ForceLaw | VelocityLaw | TwistLaw | Callable[[Situation], npt.ArrayLike]
"""Law that drives a robot: one of the package, or one of your own."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PythonLaw(Law):
    """A law of your own.

    It runs under the interpreter, a few ten microseconds per control period, on one thread: slow beside the
    laws of the package, which are compiled, and meant for ideas. Functions that take a law take
    what is given here directly and wrap it themselves.

    Parameters
    ----------
    function : callable or object
        A function that takes a `Situation` and returns a force in N; or an object with the method
        ``command(situation)``, which returns a force in N, ``velocity(situation)``, which returns
        the velocity in m/s to have at the next sample and becomes the force ``m (v* - V)/T_s``, or
        ``twist(situation)``, which returns speed ahead in m/s and turn rate in rad/s of a robot with two
        wheels. If it has the method ``start(situation, seed)``, that is called at the start of every run,
        with what is seen then and the seed of the scenario.
    name : str or None
        Name for messages; that of the function or of the object's class when ``None``.

    Raises
    ------
    InvalidParameterError
        If the function cannot be called and has none of the methods, or several of them; in a run, if a law that
        returns twists drives a robot without two wheels.

    Notes
    -----
    Wheels take up a twist as fast as the robot accelerates; of a turn rate no more than 1.5 rad in one control period.

    An object of several methods says which is ``asked``. It may say which walls it knows (``known_map``, a
    `StaticMap`), that it uses no regions of obstacles (``without_regions``), and what it doubts about its robot
    (``doubts_of(robot, sensors, time_limit)``, an iterable of `ResultWarning`): results carry that.

    A law that remembers something serves one run at a time, and forgets it in ``start``. Errors
    raised in it arrive unchanged, with a note of the time and of the run.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> def straight(situation):
    ...     return 4.0 * (situation.goal - situation.position) - 8.0 * situation.velocity
    >>> nav.simulate(scenarios.configuration("c1"), straight).outcome
    'collided'
    """

    GAIN_NAMES: ClassVar[tuple[str, ...]] = ()
    GAIN_BOUNDS: ClassVar[Mapping[str, tuple[float, float]]] = MappingProxyType({})
    GAIN_UNITS: ClassVar[Mapping[str, str]] = MappingProxyType({})

    function: object
    name: str | None = None
    _native: _hrsafety.Law = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        ask, answer = _method(self.function)
        name = _name(self.function) if self.name is None else self.name
        if not isinstance(name, str) or not name:
            raise InvalidParameterError("name", "be a word or None", self.name)
        self._set(name=name)
        start = getattr(self.function, "start", None)
        if start is not None and not callable(start):
            raise InvalidParameterError("start", "be a method start(situation, seed) of the law", start)
        begin = partial(_Episode, name, ask, start, answer)
        self._set(_native=_hrsafety.Law.python(begin, answer=answer))


def as_law(law: object, name: str = "law") -> Law:
    """Return a law of the package as it is, and wrap one in Python."""
    if isinstance(law, Law):
        return law
    if isinstance(law, str):
        raise InvalidParameterError(name, RULE, law, class_of(law))
    try:
        return PythonLaw(function=law)
    except InvalidParameterError as error:
        raise error.renamed(name) from None


def class_of(word: str) -> str:
    """Return the advice which class a word means, as files and the command line name laws."""
    from hrsafety.navigation.laws.known import LAWS  # for errors only: all laws are loaded there

    words = {other: kind for known, kind in LAWS.items() for other in (known, *kind.OTHER_NAMES)}
    words["field"] = LAWS["virtual_force_field"]
    words |= {kind.__name__.lower(): kind for kind in LAWS.values()}
    name, *parts = word.lower().split("+")
    near = nearest(name, words)
    if near is None:
        return f"give an object such as nav.{LAWS['virtual_force_field'].__name__}()"
    made = f"nav.{words[near].__name__}()"
    said = f'"{word}" is a word of files and of the command line' if near == name and not parts else f'for "{word}"'
    return f"{said}: give {made if not parts else f'nav.SafeNavigation({made}, ...)'}"


def law_with_gains(law: object, name: str = "law") -> Law:
    """Return a law of the package that has gains, as a search needs it."""
    if isinstance(law, Law) and law.GAIN_NAMES:
        return law
    if isinstance(law, Law) or callable(law):
        raise InvalidParameterError(name, "be a Law with gains", law, "a law in Python has none to search")
    raise InvalidParameterError(name, "be a Law", law, class_of(law) if isinstance(law, str) else None)


def _method(function: object) -> tuple[Callable[[Situation], object], str]:
    """Return what is asked for every period, and what it returns."""
    if isinstance(function, type):
        raise InvalidParameterError("function", RULE, function, f"{function.__name__} is a class: make one of it first")
    methods = [each for each in ANSWERS if callable(getattr(function, each, None))]
    asked = getattr(function, "asked", None)
    if isinstance(asked, str) and asked in methods:
        methods = [asked]
    if len(methods) > 1:
        shown = " and ".join(f"`{each}`" for each in methods)
        raise InvalidParameterError("function", f"have one of the methods {shown}, not both", function)
    if methods:
        return getattr(function, methods[0]), ANSWERS[methods[0]]
    if callable(function):
        return function, "force"
    raise InvalidParameterError("function", RULE, function)


def _name(function: object) -> str:
    own = getattr(function, "name", None)
    if isinstance(own, str) and own:
        return own
    return str(getattr(function, "__name__", type(function).__name__))


class _Episode:
    """A law at work in one run: shows it every situation and checks what it returns."""

    def __init__(
        self,
        name: str,
        ask: Callable[[Situation], object],
        start: Callable[[Situation, int], object] | None,
        kind: str,
        robot: tuple[float, float, float, float, float],
        origin: Pair,
        goal: Pair,
        seed: int,
    ) -> None:
        self.name, self.ask, self.start, self.kind = name, ask, start, kind
        self.robot = point_mass_of(robot)
        self.origin, self.goal, self.seed = origin, fixed(goal), seed

    def __call__(self, fields: Mapping[str, Any], aim: Pair | None = None) -> Pair:
        situation = situation_of(fields, self.robot, self.goal if aim is None else fixed(aim))
        try:
            if self.start is not None:
                start, self.start = self.start, None
                start(situation, self.seed)
            answer = self.ask(situation)
        except Exception as error:
            error.add_note(f"raised by law {self.name!r} at t = {situation.time:.6g} s, {self._run()}")
            raise
        return self._checked(answer, situation.time)

    def _run(self) -> str:
        (x, y), goal = self.origin, self.goal
        return f"in the run from ({x:g}, {y:g}) to ({goal[0]:g}, {goal[1]:g}) with seed {self.seed}"

    def _checked(self, answer: object, time: float) -> Pair:
        """Return two finite numbers, or say which law returned something else, and when."""
        axes, unit = NUMBERS[self.kind]
        what = f"{self.kind} of law {self.name!r} at t = {time:.6g} s"
        array = numbers(what, answer, f"be two numbers ({axes}) in {unit}")
        if array.shape != (2,):
            raise ShapeError(what, "(2,)", array.shape)
        if not np.isfinite(array).all():
            raise InvalidParameterError(what, f"be finite, in {unit}", array.tolist())
        x, y = array.tolist()
        return x, y
