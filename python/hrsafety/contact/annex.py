"""Annex for the technical file of Regulation (EU) 2023/1230: what a cell assumes, and which function holds it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from types import MappingProxyType
from typing import Any

from hrsafety import _keys as kind
from hrsafety._arguments import checked_text, instance, sequence
from hrsafety._keys import Keys, checked, located
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.standards.robot_classes import RobotClass
from hrsafety.standards.robot_classes import robot_class as class_of_robot

__all__ = ["Annex", "Assumption", "Hazard", "annex_of"]

BLANK = ""
"""Mark of a missing entry; the page leaves a line for it."""
NOTE = (
    "Regulation (EU) 2023/1230 on machinery applies from 2027-01-20. This annex helps to fill the technical file; it "
    "is no assessment of conformity."
)
MACHINE = MappingProxyType(
    {
        "machine": "Machine",
        "maker": "Maker",
        "intended_use": "Intended use",
        "foreseeable_misuse": "Reasonably foreseeable misuse",
    }
)
"""Entries about the machine, with their titles."""
SOFTWARE = MappingProxyType(
    {
        "software": "Software",
        "safety_checksum": "Checksum of the safety configuration",
        "log_retention": "Retention of the logs of safety software",
    }
)
"""Entries about the software."""
CLOSING = MappingProxyType({"residual_risk": "Residual risk", "signatures": "Date and signatures"})


def _texts(owner: object, names: Sequence[str]) -> None:
    """Refuse what is no text; an empty one is a line to fill."""
    for name in names:
        if not isinstance(getattr(owner, name), str):
            raise InvalidParameterError(name, "be a text", getattr(owner, name))


@dataclass(frozen=True, kw_only=True, slots=True)
class Assumption:
    """A number or fact that a verdict rests on.

    Parameters
    ----------
    name, value : str
        In words, the value with its unit.
    held_by : str
        Safety function that holds it, with its performance level.
    verified : str
        How that was verified.
    broken_by : str
        What breaks it.

    Examples
    --------
    >>> from hrsafety import contact
    >>> contact.Assumption(name="speed of the tool", value="0.25 m/s", held_by="speed monitoring, PL d").verified
    ''
    """

    name: str
    value: str
    held_by: str = BLANK
    verified: str = BLANK
    broken_by: str = BLANK

    def __post_init__(self) -> None:
        """Check the texts."""
        checked_text("name", self.name, "be a name")
        _texts(self, ("value", "held_by", "verified", "broken_by"))


@dataclass(frozen=True, kw_only=True, slots=True)
class Hazard:
    """A hazard of contact with its class and what is done against it.

    Parameters
    ----------
    hazard : str
        In words.
    contact : str
        Class of contact.
    measures : str
        What is done.

    Examples
    --------
    >>> from hrsafety import contact
    >>> contact.Hazard(hazard="hand below the tool", contact="clamped", measures="pad of 20 mm").contact
    'clamped'
    """

    hazard: str
    contact: str = BLANK
    measures: str = BLANK

    def __post_init__(self) -> None:
        """Check the texts."""
        checked_text("hazard", self.hazard, "be a text")
        _texts(self, ("contact", "measures"))


@dataclass(frozen=True, kw_only=True, slots=True)
class Annex:
    """Annex of a cell or a program; what is not given is an empty line to fill.

    Parameters
    ----------
    said : mapping of str to str
        Texts by name, the keys of ``[annex]`` of a file.
    hazards : sequence of Hazard
        Of the contacts.
    assumptions : sequence of Assumption
        What the verdict rests on.
    limits : sequence of str
        Limits that were used, each to be compared with the own copy of its edition.
    hashes : mapping of str to str
        SHA-256 of files by name.
    robot_class : RobotClass or None
        Class by ISO 10218-1.

    Examples
    --------
    >>> from hrsafety import contact
    >>> annex = contact.Annex(said={"machine": "Loading station"}, limits=["chest, clamped: 140 N"])
    >>> annex.tables()[0][0]
    'Machine'
    """

    said: Mapping[str, str] = field(default_factory=dict)
    hazards: Sequence[Hazard] = ()
    assumptions: Sequence[Assumption] = ()
    limits: Sequence[str] = ()
    hashes: Mapping[str, str] = field(default_factory=dict)
    robot_class: RobotClass | None = None

    def __post_init__(self) -> None:
        """Check the parts."""
        for name in ("said", "hashes"):
            if not isinstance(getattr(self, name), Mapping):
                raise InvalidParameterError(name, "be texts by name", getattr(self, name))
        if self.robot_class is not None:
            instance("robot_class", self.robot_class, RobotClass)
        object.__setattr__(self, "said", checked("said", dict(self.said), _SAID))
        for name, part in (("hazards", Hazard), ("assumptions", Assumption)):
            rows = tuple(sequence(name, f"be of {part.__name__}", getattr(self, name)))
            for index, each in enumerate(rows):
                instance(f"{name}[{index}]", each, part)
            object.__setattr__(self, name, rows)
        limits = tuple(checked_text("limits", each, "be texts") for each in sequence("limits", "be texts", self.limits))
        object.__setattr__(self, "limits", limits)

    def fields(self) -> dict[str, Any]:
        """Return everything as JSON holds it.

        Returns
        -------
        dict
            By name; texts that nobody gave are empty.
        """
        names = ("name", "value", "held_by", "verified", "broken_by")
        found = self.robot_class
        return {
            "regulation": NOTE,
            **{name: self.said.get(name, BLANK) for name in (*MACHINE, *SOFTWARE, *CLOSING)},
            "hazards": [
                {name: getattr(each, name) for name in ("hazard", "contact", "measures")} for each in self.hazards
            ],
            "assumptions": [{name: getattr(each, name) for name in names} for each in self.assumptions],
            "limits": [{"limit": each, "compared_with": BLANK} for each in self.limits],
            "hashes": dict(self.hashes),
            "robot_class": None if found is None else {"result": found.result, "reasons": list(found.reasons)},
        }

    def tables(self) -> list[tuple[str, tuple[str, ...], list[tuple[str, ...]]]]:
        """Return what a page shows.

        Returns
        -------
        list of tuple
            Heading, titles and rows of each table, in their order.
        """
        said = self.said

        def texts(titles: Mapping[str, str]) -> list[tuple[str, ...]]:
            return [(title, said.get(name, BLANK)) for name, title in titles.items()]

        robot = self.robot_class
        machine = texts(MACHINE)
        if robot is not None:
            why = f" ({'; '.join(robot.reasons)})" if robot.reasons else ""
            machine.append(
                ("Class by ISO 10218-1:2025, to be compared with your copy", f"{robot.result}{why}".replace("_", " "))
            )
        hashes = [(f"SHA-256 of {name}", value) for name, value in self.hashes.items()]
        return [
            ("Machine", ("what", "text"), machine),
            (
                "Hazards of contact",
                ("hazard", "contact", "measures"),
                [(each.hazard, each.contact, each.measures) for each in self.hazards],
            ),
            (
                "Assumptions",
                ("assumption", "value", "safety function that holds it, PL", "verified how", "what breaks it"),
                [(each.name, each.value, each.held_by, each.verified, each.broken_by) for each in self.assumptions],
            ),
            ("Software", ("what", "text"), [*texts(SOFTWARE), *hashes]),
            ("Limits", ("limit", "compared with my copy, edition"), [(each, BLANK) for each in self.limits]),
            ("Closing", ("what", "text"), texts(CLOSING)),
        ]


_SAID: Keys = MappingProxyType(dict.fromkeys((*MACHINE, *SOFTWARE, *CLOSING), kind.word))
_HAZARD: Keys = MappingProxyType(dict.fromkeys(("hazard", "contact", "measures"), kind.word))
_ASSUMPTION: Keys = MappingProxyType(dict.fromkeys(("name", "value", "held_by", "verified", "broken_by"), kind.word))
_ANNEX: Keys = MappingProxyType(
    {**_SAID, "hazards": kind.tables, "assumptions": kind.tables, "robot_class": kind.table}
)
_CLASS: Keys = MappingProxyType({**dict.fromkeys(("mass", "speed", "force"), kind.number), "limited_by": kind.word})


def annex_of(
    table: Mapping[str, Any],
    *,
    hazards: Sequence[Hazard] = (),
    assumptions: Sequence[Assumption] = (),
    limits: Sequence[str] = (),
    hashes: Mapping[str, str] = MappingProxyType({}),
    robot_class: RobotClass | None = None,
    path: str = "annex",
) -> Annex:
    """Return the annex of a table of a file, with what was computed.

    An assumption of the file that has the name of a computed one adds what holds it; every other one is added.

    Parameters
    ----------
    table : mapping
        ``[annex]`` with ``[[annex.hazards]]`` and ``[[annex.assumptions]]``, and ``robot_class`` with the arguments of
        `standards.robot_class`.
    hazards, assumptions, limits, hashes, robot_class
        As found for the cell or the program.
    path : str
        What errors call the table.

    Returns
    -------
    Annex
        Checked.

    Raises
    ------
    InvalidParameterError
        If a key is unknown or no text; the message names it.

    Examples
    --------
    >>> from hrsafety import contact
    >>> contact.annex_of({"maker": "Example Ltd"}).said["maker"]
    'Example Ltd'
    """
    given = checked(path, table, _ANNEX)
    if "robot_class" in given:
        known_class = checked(f"{path}.robot_class", given.pop("robot_class"), _CLASS)
        with located(f"{path}.robot_class"):
            robot_class = class_of_robot(**known_class)
    own = [
        Hazard(**checked(f"{path}.hazards[{index}]", each, _HAZARD, required=("hazard",)))
        for index, each in enumerate(given.pop("hazards", []))
    ]
    rows = {each.name: each for each in assumptions}
    for index, each in enumerate(given.pop("assumptions", [])):
        told = checked(f"{path}.assumptions[{index}]", each, _ASSUMPTION, required=("name",))
        known = rows.get(told["name"])
        computed = {} if known is None else {name: getattr(known, name) for name in ("value", "held_by", "broken_by")}
        rows[told["name"]] = Assumption(**({"value": BLANK} | computed | told))
    return Annex(
        said=given,
        hazards=(*hazards, *own),
        assumptions=tuple(rows.values()),
        limits=limits,
        hashes=hashes,
        robot_class=robot_class,
    )
