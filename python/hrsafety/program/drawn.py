"""Robots without a program: contacts of drawn motions, judged by the worst of them or by a quantile."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from hrsafety._arguments import Array, instance, number
from hrsafety._records import dataclass
from hrsafety.contact import Annex
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning, unsafe_doubts
from hrsafety.program.annexed import annex_of_task
from hrsafety.program.contacts import BLOCK, TaskContacts, Waypoints
from hrsafety.program.draws import LISTED, OUTSIDE, DrawnMotions, Quantile, quantiles_of
from hrsafety.program.judged import EVEN, JudgedExposure, fields_of, judged, named_doubts, robot_fields, shares_of
from hrsafety.program.task import ContactTask
from hrsafety.standards.verdicts import doubted, speed_verdict, strictest
from hrsafety.tables import Columns, Table

__all__ = ["DrawnProgram", "DrawnStudy", "PointMassesDrawn"]

LEAST_ACCEPTED = 0.9
SINGULAR = 10.0
"""A pose is near a singular one where the mass is above so many medians."""


class PointMassesDrawn(NamedTuple):
    """Directional masses of a point over drawn motions.

    Attributes
    ----------
    point : str
        Its name.
    quantiles : tuple of Quantile
        In kg.
    worst : float
        Largest one in kg.
    near_singular : float
        Share of draws with more than ten times the median.
    """

    point: str
    quantiles: tuple[Quantile, ...]
    worst: float
    near_singular: float


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class DrawnProgram(ContactTask):
    """A robot without a program: its contacts are judged over motions drawn within the limits of its joints.

    Parameters
    ----------
    motion : DrawnMotions
        The motions. Each is as fast as the joints and `tcp_speed` allow in its direction.
    accept_quantile : float or None
        Share of the motions, 0.9 to below 1, whose speed has to be allowed: the upper end of the interval of that
        quantile is held against the limit. ``None``: the worst drawn motion counts, and that others may be worse is a
        doubt.
    points, limits, coverings, strains, drive, robot_mass, direction, link, point, tcp_speed, confirmed, annex, title
        As for `Program`.
    segments : sequence of Segment
        Regions of the body within reach; they begin and end nowhere.
    separation : None
        Belongs to a path.
    given, files
        As for `Program`.

    Raises
    ------
    InvalidParameterError
        If a value is out of its range.

    Examples
    --------
    >>> from hrsafety import arms, program
    >>> gripper = arms.Payload("tool", 1.0)
    >>> arm = arms.Arm.example(armature=[1.2, 1.2, 1.0, 0.3, 0.3, 0.3], payload=gripper)
    >>> task = program.DrawnProgram(
    ...     motion=program.DrawnMotions(arm=arm, velocity=2.0, draws=2000),
    ...     points=[program.ContactPoint(name="gripper", link="tool", area=1e-4)],
    ...     segments=[program.Segment(regions=["chest"], clamped=False, reason="nothing behind")],
    ...     tcp_speed=0.1,
    ...     accept_quantile=0.99,
    ... )
    >>> task.report().verdict
    'within_limits'
    """

    motion: DrawnMotions
    accept_quantile: float | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        instance("motion", self.motion, DrawnMotions)
        if self.accept_quantile is not None:
            accepted = number("accept_quantile", self.accept_quantile)
            if not LEAST_ACCEPTED <= accepted < 1.0:
                rule = f"be at least {LEAST_ACCEPTED:g} and below 1"
                raise InvalidParameterError("accept_quantile", rule, self.accept_quantile)
            fewest = math.ceil(math.log(OUTSIDE) / math.log(accepted))
            if self.motion.draws < fewest:
                rule = f"be at least {fewest} for a quantile of {accepted:g} with its interval"
                raise InvalidParameterError("draws", rule, self.motion.draws)
            object.__setattr__(self, "accept_quantile", accepted)
        if self.separation is not None:
            raise InvalidParameterError("separation", "be left out without a program", self.separation)
        ContactTask.__post_init__(self)
        for place, each in enumerate(self.segments):
            for name, value in (("from", each.start), ("to", each.end)):
                if value is not None:
                    raise InvalidParameterError(f"segments[{place}].{name}", "be left out without a program", value)

    def report(self, *, threads: int | None = None) -> DrawnStudy:
        """Return whether drawn motions keep the limits.

        Parameters
        ----------
        threads : int or None
            Number of threads; all cores when ``None``. It changes no bit.

        Returns
        -------
        DrawnStudy
            Verdict, limits with quantiles, and masses.

        Raises
        ------
        InvalidParameterError
            If draws times limits are too many.
        """
        return study_of_draws(self, threads)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class DrawnStudy(Table):
    """Results of a robot without a program.

    Attributes
    ----------
    program : DrawnProgram
        What was asked.
    verdict : {"not_permitted", "exceeds", "not_checked", "within_limits"}
        That of its worst limit.
    rows : tuple of JudgedExposure
        Each limit with the drawn motion that uses it most, the hardest one first.
    shares : tuple of tuple of Quantile
        Of each row: planned speed over the allowed one.
    masses : tuple of PointMassesDrawn
        Of each point.
    annex : Annex
        For the technical file of Regulation (EU) 2023/1230.
    warnings : tuple of ResultWarning
        Of all results.
    fields : dict
        Every result by name, as report.json holds it.
    """

    program: DrawnProgram
    verdict: str
    rows: tuple[JudgedExposure, ...]
    shares: tuple[tuple[Quantile, ...], ...]
    masses: tuple[PointMassesDrawn, ...]
    annex: Annex
    warnings: tuple[ResultWarning, ...]
    fields: dict[str, Any]

    def columns(self) -> Columns:
        """Return one row for each limit.

        Returns
        -------
        dict of str to ndarray
            Point, region, class, verdict, and shares of the allowed speed: quantiles and the worst.
        """
        words = ("point", "segment", "region", "contact", "verdict")
        found: Columns = {name: np.array([each[name] for each in self.fields["rows"]], dtype=str) for name in words}
        for place, level in enumerate(LISTED):
            found[f"share_{100.0 * level:g}"] = np.array([each[place].value for each in self.shares])
        return found | {"share_worst": np.array([each.share for each in self.rows])}


def study_of_draws(program: DrawnProgram, threads: int | None) -> DrawnStudy:
    """Return the study of a robot without a program, see `DrawnProgram.report`."""
    joints, rates = program.motion.drawn()
    contacts = TaskContacts(program, joints, rates, [(0.0, 1.0)] * len(program.segments), threads)
    found = contacts.contact(None).masses(joints, rates, body_masses=np.zeros(0), threads=threads)
    if program.tcp_speed is not None:
        with np.errstate(divide="ignore"):
            rates = rates * np.minimum(1.0, program.tcp_speed / found["speed"][:, -1])[:, np.newaxis]
    size = len(joints)
    waypoints = Waypoints(np.full(size, np.nan), joints, rates, np.full(size, 0.5))
    rows, contact = contacts.rows(contacts.planned), contacts.contact(contacts.planned)
    if size * len(rows) > BLOCK:
        raise InvalidParameterError("draws", f"ask for at most {BLOCK} draws times limits", size * len(rows))
    masses = tuple(_masses(each.name, found[contacts.own][:, place]) for place, each in enumerate(program.points))
    doubts = () if program.accept_quantile is not None else (_only_drawn(size),)
    held = judged(contacts, waypoints, contact, rows, doubts)
    levels = LISTED if program.accept_quantile is None else (*LISTED, program.accept_quantile)
    (block,) = (each for _, each in shares_of(contacts, waypoints, contact, rows))
    told = [quantiles_of(each, levels) for each in block.T]
    if program.accept_quantile is not None:
        held = [_by_quantile(row, each[-1].high, program) for row, each in zip(held, told, strict=True)]
    order = sorted(range(len(held)), key=lambda at: (held[at].exposure.limit.permitted, -held[at].share))
    held, told = [held[at] for at in order], [told[at] for at in order]
    warnings = tuple(dict.fromkeys([*named_doubts(program, held), *doubts]))
    annex = annex_of_task(program, held, max((each.speed for each in held), default=0.0))
    own = [each for each in doubts if each.code not in program.confirmed]
    verdict = doubted(strictest(each.verdict for each in held) if held else "within_limits", own)
    return DrawnStudy(
        program=program,
        verdict=verdict,
        rows=tuple(held),
        shares=tuple(each[: len(LISTED)] for each in told),
        masses=masses,
        annex=annex,
        warnings=warnings,
        fields=_fields(contacts, program, verdict, held, told, masses) | {"annex": annex.fields()},
    )


def _only_drawn(size: int) -> ResultWarning:
    """Return the doubt that motions nobody drew may be worse."""
    worse = 100.0 * (1.0 - 0.05 ** (1.0 / size))
    message = (
        f"the worst of {size} drawn motions counts: with 95 % confidence up to {worse:.2g} % of all motions are worse: "
        "give the program, or accept_quantile"
    )
    return ResultWarning("motions_drawn", "motion", message)


def _masses(name: str, masses: Array) -> PointMassesDrawn:
    moving = masses[~np.isnan(masses)]
    if not len(moving):
        return PointMassesDrawn(name, (), 0.0, 0.0)
    quantiles = quantiles_of(moving, LISTED)
    near = float(np.mean(moving > SINGULAR * quantiles[0].value))
    return PointMassesDrawn(name, quantiles, float(moving.max()), near)


def _by_quantile(row: JudgedExposure, share: float, program: DrawnProgram) -> JudgedExposure:
    """Return a limit whose verdict is that of a share of the allowed speed."""
    checked = not any(each.code not in program.confirmed for each in unsafe_doubts(row.warnings))
    word = speed_verdict(share, 1.0 + EVEN, permitted=row.exposure.limit.permitted, checked=checked)
    return replace(row, verdict=word)


def _fields(
    contacts: TaskContacts,
    program: DrawnProgram,
    verdict: str,
    held: list[JudgedExposure],
    told: list[tuple[Quantile, ...]],
    masses: tuple[PointMassesDrawn, ...],
) -> dict[str, Any]:
    """Return every result by name."""
    codes = [code for row in held for code in dict.fromkeys(each.code for each in row.doubts)]
    rows = [
        fields_of(each, contacts) | {"share_worst": each.share, "shares": [one._asdict() for one in levels]}
        for each, levels in zip(held, told, strict=True)
    ]
    motion = program.motion
    return {
        "verdict": verdict,
        "accept_quantile": program.accept_quantile,
        "draws": motion.draws,
        "seed": motion.seed,
        "doubts": {code: codes.count(code) for code in sorted(set(codes))},
        "confirmed": dict(program.confirmed),
        "rows": rows,
        "masses": [each._asdict() | {"quantiles": [one._asdict() for one in each.quantiles]} for each in masses],
        "robot": robot_fields(program, motion.rates_most),
    }
