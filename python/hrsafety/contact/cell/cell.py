"""Cells: a robot, its coverings and the contacts with people that are planned, as objects."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, fields, replace
from typing import Any

import numpy as np

from hrsafety import _keys as kind
from hrsafety._arguments import checked_text, count, instance, number, sequence
from hrsafety._records import dataclass
from hrsafety._words import meant
from hrsafety.contact.annex import annex_of
from hrsafety.contact.cell.robot import ContactRobot
from hrsafety.contact.cell.stops import separation_of
from hrsafety.contact.contact import Contact
from hrsafety.contact.covering import Covering
from hrsafety.contact.drive import Drive
from hrsafety.contact.materials import StressTable
from hrsafety.errors import InvalidParameterError
from hrsafety.standards.contact_limits import ContactLimit
from hrsafety.standards.limit_sets import LimitSet
from hrsafety.standards.sets import limits as limit_set

__all__ = [
    "MOST_CONTACTS",
    "MOST_COVERINGS",
    "NO_COVERING",
    "Cell",
    "PlannedContact",
    "checked_fit",
    "confirmed_of",
    "contact_of",
]

MOST_CONTACTS = 64
MOST_COVERINGS = 16
MOST_DRAWS = 10**7
FASTEST_PLANNED = 20.0
"""Largest planned speed in m/s."""
ALLOWED_CHANCE = 0.01
"""Chance of being too fast that is still within limits, unless the cell gives another one."""
NEVER_CONFIRMED = ("beyond_data", "invalid_numbers", "not_checked", "region_unknown", "unfinished")
"""Doubts that no confirmation removes: nothing is known there."""
NO_COVERING = "none"
"""Word for a bare contact where a file has a covering for all others."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PlannedContact:
    """A contact that is planned.

    Parameters
    ----------
    limit : ContactLimit
        Region and class with what it may bear.
    speed : float
        Planned speed of the robot's point towards the person, in m/s.
    covering : str or None
        Name of the covering; ``None``: bare.
    area : float or None
        Area of the bare contact in m^2; without it the pressure of a bare contact is not checked.
    covered_area : float or None
        What it touches of a flat covering, in m^2; ``None``: the area of the covering.

    Examples
    --------
    >>> from hrsafety import contact, standards
    >>> hand = standards.limits().contact("hand_finger", "transient")
    >>> contact.PlannedContact(limit=hand, speed=0.25, area=1e-4).covering is None
    True
    """

    limit: ContactLimit
    speed: float
    covering: str | None = None
    area: float | None = None
    covered_area: float | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        instance("limit", self.limit, ContactLimit)
        object.__setattr__(self, "speed", number("speed", self.speed))
        if not 0.0 < self.speed <= FASTEST_PLANNED:
            raise InvalidParameterError("speed", f"be above 0 and at most {FASTEST_PLANNED:g}", self.speed)
        if self.covering is not None:
            checked_text("covering", self.covering, "be the name of a covering")
        for name, shown in (("area", "contact_area"), ("covered_area", "covered_area")):
            given = getattr(self, name)
            if given is not None:
                object.__setattr__(self, name, area := number(shown, given))
                if not 0.0 < area < 10.0:
                    raise InvalidParameterError(shown, "be above 0 and below 10", area)


@dataclass(frozen=True, kw_only=True, slots=True)
class Cell:
    """A robot, its coverings and the contacts that are planned, of a file or made of objects; `study` judges it.

    Parameters
    ----------
    robot : ContactRobot
        The robot with its masses.
    contacts : tuple of PlannedContact
        What is judged, 1 to 64.
    limits : LimitSet
        Set of the limits of the contacts.
    coverings : dict of str to Covering
        By name; each contact is also judged with those that it does not plan.
    strains : dict of str to float or None
        Largest strain of a covering, its e_b when ``None`` or absent.
    materials : dict of str to str
        Source of the material of a covering.
    human_speed : float
        Speed of the person towards the robot in m/s.
    drive : Drive or None
        What presses clamped contacts on; without it none of them is within limits.
    separation : dict or None
        Rules of the stop by name, as in a cell file; measured stops as a table of arrays.
    uncertain : dict
        Distributions by name: a spread around the number of each contact, or one of its own.
    draws, seed : int
        Of the chances.
    allowed_chance : float
        Chance of being too fast that is still within limits.
    confirmed : dict of str to str
        Doubts by code that were confirmed not to hold here, with reason and name.
    annex : dict
        Texts, hazards and assumptions of the annex for Regulation (EU) 2023/1230, see `contact.annex_of`.
    title : str
        Heading of the page.
    given : dict
        What a file holds, as read.
    files : dict of str to str
        SHA-256 of files that were read, by what they are.

    Attributes
    ----------
    inputs : dict
        Everything that was given or is a default, as JSON holds it.

    Examples
    --------
    >>> from hrsafety import contact, standards
    >>> hand = standards.limits().contact("hand_finger", "transient")
    >>> pad = contact.Covering(material=contact.Linear(modulus=2e5), thickness=0.02, area=4e-4)
    >>> cell = contact.Cell(
    ...     robot=contact.ContactRobot.of_mass(8.0),
    ...     contacts=[contact.PlannedContact(limit=hand, speed=0.25, covering="pad")],
    ...     coverings={"pad": pad},
    ... )
    >>> cell.limits.id
    'iso_ts_15066_2016'
    """

    robot: ContactRobot
    contacts: tuple[PlannedContact, ...]
    limits: LimitSet = field(default_factory=limit_set)
    coverings: Mapping[str, Covering] = field(default_factory=dict)
    strains: Mapping[str, float | None] = field(default_factory=dict)
    materials: Mapping[str, str] = field(default_factory=dict)
    human_speed: float = 0.0
    drive: Drive | None = None
    separation: Mapping[str, Any] | None = None
    uncertain: Mapping[str, Any] = field(default_factory=dict)
    draws: int = 100_000
    seed: int = 0
    allowed_chance: float = ALLOWED_CHANCE
    confirmed: Mapping[str, str] = field(default_factory=dict)
    annex: Mapping[str, Any] = field(default_factory=dict)
    title: str = "Contact of a robot with people"
    given: Mapping[str, Any] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)
    inputs: Mapping[str, Any] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        instance("robot", self.robot, ContactRobot)
        instance("limits", self.limits, LimitSet)
        checked_text("title", self.title, "be a text")
        mappings = ("coverings", "strains", "materials", "uncertain", "confirmed", "annex", "given", "files")
        for name in mappings:
            if not isinstance(getattr(self, name), Mapping):
                raise InvalidParameterError(name, "be a mapping", getattr(self, name))
        rule = f"be 1 to {MOST_CONTACTS} planned contacts"
        contacts = tuple(sequence("contacts", rule, self.contacts))
        if not 1 <= len(contacts) <= MOST_CONTACTS:
            raise InvalidParameterError("contacts", rule, len(contacts))
        if len(self.coverings) > MOST_COVERINGS:
            raise InvalidParameterError("coverings", f"be at most {MOST_COVERINGS}", len(self.coverings))
        for name, pad in self.coverings.items():
            instance(f"coverings[{name!r}]", pad, Covering)
        for index, each in enumerate(contacts):
            instance(f"contacts[{index}]", each, PlannedContact)
            checked_fit(f"contacts[{index}]", each.covering, each.covered_area, self.coverings)
        human_speed, chance = number("human_speed", self.human_speed), number("allowed_chance", self.allowed_chance)
        if not 0.0 <= human_speed < FASTEST_PLANNED:
            raise InvalidParameterError("human_speed", "be at least 0 and below 20", human_speed)
        if not 0.0 < chance < 1.0:
            raise InvalidParameterError("allowed_chance", "be above 0 and below 1", chance)
        count("draws", self.draws, most=MOST_DRAWS)
        count("seed", self.seed, least=0, most=2**63 - 1)
        made = {"contacts": contacts, "human_speed": human_speed, "allowed_chance": chance}
        made["separation"] = rules = separation_of(self.separation)
        fastest = max(each.speed for each in contacts)
        if rules is not None and rules["max_speed"] < fastest:
            rule = f"be at least the speed of every contact ({fastest:g})"
            raise InvalidParameterError("separation.max_speed", rule, rules["max_speed"])
        if self.drive is not None:
            made["drive"] = _pushing(instance("drive", self.drive, Drive), self.robot)
        made["confirmed"] = confirmed_of(self.confirmed)
        annex_of(self.annex)
        for name, value in made.items():
            object.__setattr__(self, name, value)
        object.__setattr__(self, "inputs", kind.canonical({**self.given, **self._defaults()}))

    def _defaults(self) -> dict[str, Any]:
        """Return what counts, whether it was given or is a default, as plain values."""
        found: dict[str, Any] = {
            "limits": self.limits.id,
            "human_speed": self.human_speed,
            "draws": self.draws,
            "seed": self.seed,
            "allowed_chance": self.allowed_chance,
            "contacts": [_input(each) for each in self.contacts],
            "coverings": [
                _numbers(name, pad) | {"max_strain": self.strains.get(name)} for name, pad in self.coverings.items()
            ],
            "robot": {**self.given.get("robot", {}), **self.robot.inputs},
        }
        more: dict[str, Any] = {"separation": self.separation, "uncertain": self.uncertain}
        more |= {"confirmed": self.confirmed, "annex": self.annex}
        if self.drive is not None:
            more["drive"] = self.drive.fields()
        return found | {name: value for name, value in more.items() if value}


def checked_fit(path: str, covering: str | None, covered_area: float | None, coverings: Mapping[str, Covering]) -> None:
    """Refuse a contact whose covering is not there, is smaller than the contact, or has an area by its shape.

    Parameters
    ----------
    path : str
        Name of the contact in messages.
    covering : str or None
        Name of its covering.
    covered_area : float or None
        Area that takes the place of that of the covering.
    coverings : mapping
        Those that there are.
    """
    if covering is None:
        return
    if covering not in coverings:
        rule = f"name a covering ({', '.join(coverings) or 'none is given'}) or be {NO_COVERING!r}"
        raise InvalidParameterError(f"{path}.covering", rule, covering, meant(covering, coverings))
    if covered_area is not None and coverings[covering].shape != "flat":
        rule = f"be left out beside covering {covering!r}, whose area follows from its shape"
        raise InvalidParameterError(f"{path}.contact_area", rule, covered_area)
    pad = coverings[covering].area
    if covered_area is not None and pad is not None and covered_area > pad:
        rule = f"be at most the area of covering {covering!r} ({pad:g}): nothing touches more of it than there is"
        raise InvalidParameterError(f"{path}.contact_area", rule, covered_area, "give the covering its whole area")


def _pushing(drive: Drive, robot: ContactRobot) -> Drive:
    """Return a drive whose joint torques are a push limit: the largest one in the poses of its arm."""
    if drive.joint_torques is None:
        return drive
    if robot.push_limit is None:
        rule = "be left out for a robot that is no arm from URDF made with them"
        raise InvalidParameterError("drive.joint_torques", rule, dict(drive.joint_torques), "give push_limit")
    return drive.with_push_limit(robot.push_limit)


def confirmed_of(table: Mapping[str, Any]) -> dict[str, str]:
    """Return reasons by code; what was not checked at all cannot be confirmed."""
    found = {}
    for code, reason in table.items():
        path = f"confirmed.{code}"
        if code in NEVER_CONFIRMED:
            raise InvalidParameterError(path, "be left out: nothing is known there", code, "give what is missing")
        found[code] = kind.word(path, reason)
        if not found[code].strip():
            raise InvalidParameterError(path, "say why the doubt does not hold here, and who says so", reason)
    return found


def contact_of(cell: Cell, planned: PlannedContact, covering: str | None) -> Contact:
    """Return a planned contact bare or with a covering: a flat one over the area that the contact gives itself."""
    robot, limit = cell.robot.mass, planned.limit
    if covering is None:
        return Contact(robot=robot, body=limit, area=planned.area)
    pad = cell.coverings[covering]
    if planned.covered_area is not None and pad.shape == "flat":
        pad = replace(pad, area=planned.covered_area)
    return Contact(robot=robot, body=limit, covering=pad, max_strain=cell.strains.get(covering))


def _input(planned: PlannedContact) -> dict[str, Any]:
    return {
        "region": planned.limit.region,
        "area_name": planned.limit.area,
        "contact": planned.limit.contact,
        "speed": planned.speed,
        "covering": planned.covering,
        "contact_area": planned.area,
        "covered_area": planned.covered_area,
    }


def _numbers(name: str, pad: Covering) -> dict[str, Any]:
    """Return everything that a covering is, defaults included."""
    law = pad.material
    if isinstance(law, StressTable):
        numbers: dict[str, Any] = {"strain": np.asarray(law.strain).tolist(), "stress": np.asarray(law.stress).tolist()}
    else:
        numbers = dict(zip(law.keys.values(), law.numbers, strict=True))
    shape = {each.name: getattr(pad, each.name) for each in fields(pad) if each.name != "material"}
    return {"name": name, "material": {"law": law.law, **numbers}, **shape}
