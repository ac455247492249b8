"""Environments of CrowdNav."""

from __future__ import annotations

import configparser
import math
import re
from collections.abc import Callable
from typing import Annotated, Any, TypeVar

import numpy as np

from hrsafety._arguments import Pair, checked_seed, instance, meant
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import FileError, InvalidParameterError, Shown
from hrsafety.io.reader import Document, Provenance
from hrsafety.navigation.crowd.agents import Person, Robot
from hrsafety.navigation.crowd.pedestrians import Pedestrian, ReciprocalAvoidance
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.laws.python_law import AnyLaw
from hrsafety.navigation.robots.bodies import HolonomicRobot
from hrsafety.plausibility import ResultWarning

__all__ = ["CrowdNavScene", "is_crowdnav", "read_crowdnav"]

MOST_PEOPLE = 1000
SCENES = ("circle_crossing", "square_crossing", "mixed")
DRAWS = 1000
"""Places that are drawn for one person before there is no room."""
_TRUTH = {**dict.fromkeys(("1", "yes", "true", "on"), True), **dict.fromkeys(("0", "no", "false", "off"), False)}
T = TypeVar("T")


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class CrowdNavScene:
    """Settings of the environment of CrowdNav.

    Attributes
    ----------
    step, time_limit : float
        In s.
    people : int
        How many.
    scene : {"circle_crossing", "square_crossing", "mixed"}
        What is tested.
    circle_radius, square_width : float
        In m.
    person_radius, person_speed : float
        In m and m/s.
    person_policy : str
        How people decide in CrowdNav.
    robot_radius, robot_speed : float
        In m and m/s.
    robot_seen : bool
        Whether people notice the robot.
    attributes_drawn : bool
        Whether radii and speeds of people are drawn, 0.3 to 0.5 m and 0.5 to 1.5 m/s.
    discomfort_distance : float
        Room between people where they start, in m.
    warnings : tuple of ResultWarning
        ``drawn_attributes`` if those are drawn: they are not the numbers of the file; ``assumed`` for the encoding.
    source : Provenance
        The file.
    """

    step: Annotated[float, "s"]
    time_limit: Annotated[float, "s"]
    people: int
    scene: str
    circle_radius: Annotated[float, "m"]
    square_width: Annotated[float, "m"]
    person_radius: Annotated[float, "m"]
    person_speed: Annotated[float, "m/s"]
    person_policy: str
    robot_radius: Annotated[float, "m"]
    robot_speed: Annotated[float, "m/s"]
    robot_seen: bool
    attributes_drawn: bool
    discomfort_distance: Annotated[float, "m"]
    warnings: tuple[ResultWarning, ...]
    source: Provenance

    def world(self, case: int, *, law: AnyLaw | None = None, model: Pedestrian | None = None) -> World:
        """Return a case: people who cross a circle or a square, and the robot from (0, -R) to (0, R).

        Parameters
        ----------
        case : int
            Number of the case and seed.
        law : Law, callable, object or None
            Law of the robot; ``None``: it stands.
        model : Pedestrian or None
            Model of the people; ``None``: `ReciprocalAvoidance`.

        Returns
        -------
        World
            Starts are drawn by the rule of CrowdNav with numbers of this package. Without a model, people of another
            policy than orca are doubted: ``behavior_not_available``.

        Raises
        ------
        InvalidParameterError
            If an argument is out of range, the scene is mixed, or so many people find no room.
        """
        of = ReciprocalAvoidance() if model is None else instance("model", model, Pedestrian)
        if self.scene == "mixed":
            raise InvalidParameterError("scene", "be circle_crossing or square_crossing", self.scene)
        random = np.random.default_rng(checked_seed("case", case))
        ends = [((0.0, -self.circle_radius), (0.0, self.circle_radius), self.robot_radius)]
        people = []
        for index in range(self.people):
            radius, speed = self.person_radius, self.person_speed
            if self.attributes_drawn:
                speed, radius = float(random.uniform(0.5, 1.5)), float(random.uniform(0.3, 0.5))
            start, goal = self._way(random, ends, index, radius, speed)
            ends.append((start, goal, radius))
            awareness = 1.0 if self.robot_seen else 0.0
            people.append(
                Person(start=start, route=[goal], model=of, radius=radius, desired_speed=speed, awareness=awareness)
            )
        doubts = self.warnings
        if model is None and self.person_policy != "orca":
            message = f"people decide by reciprocal avoidance, not by the policy {self.person_policy} of the file"
            doubts = (*doubts, ResultWarning("behavior_not_available", "policy", message))
        body = HolonomicRobot(radius=self.robot_radius, max_speed=self.robot_speed)
        robot = Robot(body, start=ends[0][0], goal=ends[0][1], law=law, heading=0.5 * math.pi)
        return World(
            people=people, robots=[robot], step=self.step, time_limit=self.time_limit, seed=case, doubts=doubts
        )

    def _way(
        self, random: np.random.Generator, ends: list[tuple[Pair, Pair, float]], index: int, radius: float, speed: float
    ) -> tuple[Pair, Pair]:
        """Return start and goal of a person, apart from those of others."""
        for _ in range(DRAWS):
            start, goal = _circle(random, self.circle_radius, speed)
            if self.scene == "square_crossing":
                start, goal = _square(random, self.square_width)
            if all(
                math.dist(place, other) >= radius + size + self.discomfort_distance
                for first, last, size in ends
                for place, other in ((start, first), (start, last) if self.scene == SCENES[0] else (goal, last))
            ):
                return start, goal
        rule = "find room in the scene"
        raise InvalidParameterError("human_num", rule, self.people, f"there is room for {index}")


def _circle(random: np.random.Generator, radius: float, speed: float) -> tuple[Pair, Pair]:
    angle = random.uniform(0.0, 2.0 * math.pi)
    x, y = np.array((math.cos(angle), math.sin(angle))) * radius + random.uniform(-0.5, 0.5, 2) * speed
    return (float(x), float(y)), (float(-x), float(-y))


def _square(random: np.random.Generator, width: float) -> tuple[Pair, Pair]:
    side = 1.0 if random.random() < 0.5 else -1.0
    (x, u), (y, v) = random.uniform(0.0, 0.5 * width, 2), random.uniform(-0.5 * width, 0.5 * width, 2)
    return (float(side * x), float(y)), (float(-side * u), float(v))


def is_crowdnav(document: Document) -> bool:
    """Return whether a file holds settings of CrowdNav."""
    return all(re.search(rb"(?m)^\[%s\]" % name, document.head) for name in (b"env", b"sim", b"humans"))


def read_crowdnav(document: Document) -> CrowdNavScene:
    """Return the settings of an environment of CrowdNav; see `load_scene`."""
    settings = _Settings(document)
    drawn = settings.value("env", "randomize_attributes", _truth, "true or false", default=False)
    doubts = list(document.warnings)
    if drawn:
        message = "randomize_attributes draws radii and speeds of people: those of the file are not theirs"
        doubts.append(ResultWarning("drawn_attributes", "randomize_attributes", message))
    return CrowdNavScene(
        step=settings.positive("env", "time_step"),
        time_limit=settings.positive("env", "time_limit"),
        people=settings.value("sim", "human_num", _people, f"an integer from 0 to {MOST_PEOPLE}"),
        scene=settings.word("sim", "test_sim", SCENES),
        circle_radius=settings.positive("sim", "circle_radius"),
        square_width=settings.positive("sim", "square_width"),
        person_radius=settings.positive("humans", "radius"),
        person_speed=settings.positive("humans", "v_pref"),
        person_policy=settings.value("humans", "policy", str, "a word", default="orca"),
        robot_radius=settings.positive("robot", "radius"),
        robot_speed=settings.positive("robot", "v_pref"),
        robot_seen=settings.value("robot", "visible", _truth, "true or false"),
        attributes_drawn=drawn,
        discomfort_distance=settings.value("reward", "discomfort_dist", _not_negative, "not negative", default=0.2),
        warnings=tuple(doubts),
        source=Provenance(path=str(document.path), format="crowdnav", sha256=document.sha256),
    )


class _Settings:
    """Sections of an INI file with checked values."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.found = configparser.ConfigParser(interpolation=None, inline_comment_prefixes=("#", ";"))
        try:
            self.found.read_string(document.text, document.name)
        except configparser.Error as error:
            lines = getattr(error, "lineno", None) or next((line for line, _ in getattr(error, "errors", ())), None)
            shown = Shown(str(error).splitlines()[0][:120])
            raise document.error("unreadable", "be sections of 'key = value'", shown, line=lines) from None

    def value(self, section: str, key: str, read: Callable[[str], T], rule: str, *, default: T | None = None) -> T:
        """Return a value, or say what it should be."""
        if not self.found.has_option(section, key):
            if default is not None:
                return default
            keys = list(self.found[section]) if self.found.has_section(section) else []
            guess = meant(key, keys)
            raise self.error(section, None, f"hold {key}", Shown(", ".join(keys) or "nothing"), guess, "missing_key")
        given = self.found.get(section, key)
        try:
            return read(given)
        except (ValueError, KeyError):
            raise self.error(section, key, f"be {rule}", given) from None

    def positive(self, section: str, key: str) -> float:
        return self.value(section, key, _positive, "finite and positive")

    def word(self, section: str, key: str, words: tuple[str, ...]) -> str:
        given = self.value(section, key, str, "")
        if given not in words:
            raise self.error(section, key, f"be one of {', '.join(words)}", given, meant(given, words))
        return given

    def error(
        self, section: str, key: str | None, rule: str, shown: Any, remedy: str | None = None, code: str = "unreadable"
    ) -> FileError:
        """Return an error with the line of a key."""
        place, line = "", None
        for number, text in enumerate(self.document.lines, start=1):
            head = re.match(r"\s*\[([^\]]*)\]", text)
            place = head[1] if head else place
            if place == section and (key is None or re.match(rf"\s*{key}\s*[=:]", text, re.IGNORECASE)):
                line = number
                break
        name = section if key is None else f"{section}.{key}"
        return self.document.error(code, rule, shown, remedy, line=line, key=name)


def _truth(word: str) -> bool:
    return _TRUTH[word.lower()]


def _people(word: str) -> int:
    if not (re.fullmatch(r"\d{1,5}", word, re.ASCII) and int(word) <= MOST_PEOPLE):
        raise ValueError
    return int(word)


def _positive(word: str) -> float:
    value = float(word)
    if not 0.0 < value < 1e9:
        raise ValueError
    return value


def _not_negative(word: str) -> float:
    value = float(word)
    if not 0.0 <= value < 1e9:
        raise ValueError
    return value
