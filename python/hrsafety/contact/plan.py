"""Plans of measurements on the finished machine: what to measure where, with which device, and what was found."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import checked_text, count, finite, instance, not_negative, number, sequence, vector, word
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.records.repeated import FEWEST, Repetitions, repetitions
from hrsafety.tables import Columns, Table

__all__ = ["LAYERS", "LOADS", "MeasurementPlan", "PlannedMeasurement"]

LOADS = {"force": "N", "pressure": "Pa"}
"""Loads that are measured, and their units."""
LAYERS = (
    "Damping layers of one maker: Shore A 10 +- 7, 30 +- 5 and 70 +- 5. Which one belongs to a region is told by the "
    "manual of the device; nothing is taken by itself."
)
MOST_REPETITIONS = 1000


@dataclass(frozen=True, kw_only=True, slots=True)
class PlannedMeasurement:
    """One measurement that is planned, with what was found.

    Parameters
    ----------
    place : str
        Point or segment of the robot that touches.
    region, contact : str
        Region of the body, and ``"transient"`` or ``"quasi_static"``.
    speed : float
        Speed of the robot in m/s.
    spring : float or None
        Spring of the device, that of the region, in N/m.
    limit : float or None
        Of the load, in its unit; ``None`` where none is known.
    load : {"force", "pressure"}
        In N or Pa.
    prediction : float or None
        What was computed, never tuned to what was measured.
    pose : mapping of str to float
        Values of the joints in rad, or m.
    direction : tuple of float or None
        Of the motion in world axes.
    payload : float
        In kg.
    covering : str or None
        ``None``: bare.
    damping_layer : str
        As the manual of the device names it for the region.
    repetitions : int
        How often.
    measured : tuple of float
        What was measured, in the unit of the load.
    device_uncertainty : float or None
        Standard uncertainty of the device in the unit of the load; ``None``: not known, nothing is accepted.

    Examples
    --------
    >>> from hrsafety import contact
    >>> row = contact.PlannedMeasurement(
    ...     place="tool", region="chest", contact="transient", speed=0.25, spring=25e3, limit=280.0
    ... )
    >>> row.setup, row.accept
    ('free', '')
    """

    place: str
    region: str
    contact: str
    speed: Annotated[float, "m/s"]
    spring: Annotated[float | None, "N/m"]
    limit: float | None
    load: str = "force"
    prediction: float | None = None
    pose: Mapping[str, float] | None = None
    direction: tuple[float, ...] | None = None
    payload: Annotated[float, "kg"] = 0.0
    covering: str | None = None
    damping_layer: str = ""
    repetitions: int = FEWEST
    measured: tuple[float, ...] = ()
    device_uncertainty: float | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        for name in ("place", "region"):
            checked_text(name, getattr(self, name), "be a name")
        word("contact", self.contact, ("transient", "quasi_static"))
        word("load", self.load, tuple(LOADS))
        made: dict[str, Any] = {
            "speed": not_negative("speed", self.speed),
            "payload": not_negative("payload", self.payload),
        }
        if self.device_uncertainty is not None:
            made["device_uncertainty"] = not_negative("device_uncertainty", self.device_uncertainty)
        for name in ("spring", "limit", "prediction"):
            if getattr(self, name) is not None:
                made[name] = number(name, getattr(self, name))
                if not made[name] >= 0.0:
                    raise InvalidParameterError(name, "not be negative, or None", getattr(self, name))
        if self.covering is not None:
            checked_text("covering", self.covering, "be the name of a covering")
        if not isinstance(self.damping_layer, str):
            raise InvalidParameterError("damping_layer", "be a text", self.damping_layer)
        if self.pose is not None and not isinstance(self.pose, Mapping):
            raise InvalidParameterError("pose", "be values by joint", self.pose)
        if self.direction is not None:
            made["direction"] = tuple(vector("direction", self.direction).tolist())
        count("repetitions", self.repetitions, most=MOST_REPETITIONS)
        loads = sequence("measured", "be numbers", self.measured)
        made["measured"] = tuple(finite(f"measured[{index}]", each) for index, each in enumerate(loads))
        for name, value in made.items():
            object.__setattr__(self, name, value)

    @property
    def setup(self) -> str:
        """``"clamped"`` or ``"free"``."""
        return "clamped" if self.contact == "quasi_static" else "free"

    @property
    def found(self) -> Repetitions | None:
        """Verdict of the measurements on the limit; ``None`` without any, or without a limit."""
        if not self.measured or self.limit is None:
            return None
        return repetitions(self.measured, self.limit, device_uncertainty=self.device_uncertainty)

    @property
    def accept(self) -> str:
        """``"accept"``, ``"reject"``, why it is not decided, or nothing before a measurement.

        Fewer measurements than were planned decide nothing but that a limit is exceeded.
        """
        found = self.found
        if found is None:
            return "no limit" if self.measured else ""
        if found.verdict == "exceeds":
            return "reject"
        if len(self.measured) < self.repetitions:
            return "too few"
        return "accept" if found.verdict == "within_limits" else found.reason.replace("_", " ")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class MeasurementPlan(Table):
    """A plan of measurements as a table.

    Parameters
    ----------
    rows : sequence of PlannedMeasurement
        In the order of the page.

    Examples
    --------
    >>> from hrsafety import contact
    >>> row = contact.PlannedMeasurement(
    ...     place="tool", region="chest", contact="transient", speed=0.25, spring=25e3, limit=280.0
    ... )
    >>> plan = contact.MeasurementPlan(rows=[row]).filled({0: [201.0, 197.0, 205.0]}, device_uncertainty=4.0)
    >>> plan.rows[0].accept
    'accept'
    """

    rows: tuple[PlannedMeasurement, ...]

    def __post_init__(self) -> None:
        """Check the rows."""
        rows = tuple(sequence("rows", "be planned measurements", self.rows))
        for index, each in enumerate(rows):
            instance(f"rows[{index}]", each, PlannedMeasurement)
        object.__setattr__(self, "rows", rows)

    def filled(
        self, measured: Mapping[int, Sequence[float] | npt.ArrayLike], *, device_uncertainty: float | None = None
    ) -> MeasurementPlan:
        """Return the plan with measurements, such as the loads of `records`.

        Parameters
        ----------
        measured : mapping of int to sequence of float
            Loads by the number of the row, in the unit of its load.
        device_uncertainty : float or None
            Standard uncertainty of the device in that unit; ``None``: not known, nothing is accepted.

        Returns
        -------
        MeasurementPlan
            With what the measurements mean: `PlannedMeasurement.accept`.

        Raises
        ------
        InvalidParameterError
            If there is no such row or a number is not finite.
        """
        rows = list(self.rows)
        for index, values in measured.items():
            if not 0 <= index < len(rows):
                raise InvalidParameterError("measured", f"have numbers of rows below {len(rows)}", index)
            loads = tuple(vector(f"measured[{index}]", values).tolist())
            rows[index] = replace(rows[index], measured=loads, device_uncertainty=device_uncertainty)
        return MeasurementPlan(rows=tuple(rows))

    def fields(self) -> list[dict[str, Any]]:
        """Return the rows as JSON holds them.

        Returns
        -------
        list of dict
            With the fields of `PlannedMeasurement`, ``setup``, ``unit``, ``expanded_uncertainty`` and ``accept``.
        """
        return [_fields(each) for each in self.rows]

    def columns(self) -> Columns:
        """Return one row for each measurement.

        Returns
        -------
        dict of str to ndarray
            Place, pose, speed, device, prediction, limit, measurements and what they mean; empty or NaN before.
        """
        most = max((max(each.repetitions, len(each.measured)) for each in self.rows), default=FEWEST)

        def words(of: Any) -> Any:
            return np.array([str(of(each)) for each in self.rows])

        def numbers(of: Any) -> Any:
            values = [of(each) for each in self.rows]
            return np.array([math.nan if each is None else each for each in values], dtype=np.float64)

        found: Columns = {
            "place": words(lambda row: row.place),
            "region": words(lambda row: row.region),
            "contact": words(lambda row: row.contact),
            "setup": words(lambda row: row.setup),
            "covering": words(lambda row: row.covering or "bare"),
            "pose": words(lambda row: " ".join(f"{name}={value:.6g}" for name, value in (row.pose or {}).items())),
            "direction": words(lambda row: " ".join(f"{value:.4g}" for value in row.direction or ())),
            "speed_m_per_s": numbers(lambda row: row.speed),
            "payload_kg": numbers(lambda row: row.payload),
            "spring_N_per_m": numbers(lambda row: row.spring),
            "damping_layer": words(lambda row: row.damping_layer),
            "repetitions": np.array([each.repetitions for each in self.rows], dtype=np.int64),
            "load": words(lambda row: row.load),
            "unit": words(lambda row: LOADS[row.load]),
            "prediction": numbers(lambda row: row.prediction),
            "limit": numbers(lambda row: row.limit),
        }
        for place in range(most):
            found[f"measured_{place + 1}"] = numbers(
                lambda row, place=place: row.measured[place] if place < len(row.measured) else None
            )
        found["expanded_uncertainty"] = numbers(
            lambda row: None if row.found is None else row.found.expanded_uncertainty
        )
        return found | {"accept": words(lambda row: row.accept)}


def _fields(row: PlannedMeasurement) -> dict[str, Any]:
    found = {each.name: getattr(row, each.name) for each in fields(row)}
    for name in ("direction", "measured"):
        found[name] = None if found[name] is None else list(found[name])
    found["pose"] = [{"joint": name, "value": value} for name, value in (row.pose or {}).items()]
    more = {"setup": row.setup, "unit": LOADS[row.load], "accept": row.accept}
    return found | more | {"expanded_uncertainty": None if row.found is None else row.found.expanded_uncertainty}
