"""A measured record: columns of a device's file in SI units, and its loads."""

from __future__ import annotations

import zipfile
from os import PathLike
from pathlib import Path

import numpy as np

from hrsafety._arguments import Array, readable, sequence, word
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import FileError, Shown
from hrsafety.io.reader import Document, Provenance
from hrsafety.plausibility import ResultWarning
from hrsafety.records.accelerations import AccelerationRecord, acceleration
from hrsafety.records.forces import ForceDevice, ForceRecord, force
from hrsafety.records.iso_mme import channel as one_channel
from hrsafety.records.iso_mme import channels_of, is_channel
from hrsafety.records.tables import DeviceTable, read_table
from hrsafety.records.units import dimension_of, factor_of

__all__ = ["Record", "load"]

_TIMES = ("t", "time", "zeit", "temps", "tempo", "zeitstempel", "timestamp")
_GAP = 1.5


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Record:
    """Columns of a device's file.

    Attributes
    ----------
    columns : dict of str to ndarray, shape (n,)
        Numbers in SI units where the unit is known.
    units : dict of str to str or None
        As the file has them.
    codes : dict of str to str
        Channel codes of ISO-MME.
    time_column : str or None
        Column of times.
    header : tuple of str
        Lines above the numbers.
    delimiter : str or None
        Between cells; ``None`` for blanks.
    decimal : str
        Decimal sign.
    source : Provenance
        File, format and digest.
    warnings : tuple of ResultWarning
        What was assumed.
    """

    columns: dict[str, Array]
    units: dict[str, str | None]
    codes: dict[str, str]
    time_column: str | None
    header: tuple[str, ...]
    delimiter: str | None
    decimal: str
    source: Provenance
    warnings: tuple[ResultWarning, ...] = ()

    @property
    def time(self) -> Array:
        """Times in s.

        Raises
        ------
        FileError
            ``no_time``: if no column is one of times.
        """
        if self.time_column is None:
            raise FileError(
                Path(self.source.path).name,
                "have a column of times: named time or t, or with a unit of time",
                Shown(", ".join(self.columns)),
                "name the column, or give its unit",
                code="no_time",
            )
        return self.columns[self.time_column]

    def acceleration(
        self,
        columns: list[str] | None = None,
        *,
        unit: str | None = None,
        filter_class: int | None = None,
        full_scale: float | None = None,
    ) -> AccelerationRecord:
        """Return the loads of its accelerations, see `records.acceleration`.

        Parameters
        ----------
        columns : list of str or None
            One axis or three; ``None`` for all with a unit of acceleration.
        unit : {"m/s2", "g"} or None
            Of columns without a unit.
        filter_class : int or None
            As for `records.acceleration`.
        full_scale : float or None
            Of the channel, in m/s^2.

        Returns
        -------
        AccelerationRecord
            Loads and doubts.

        Raises
        ------
        FileError
            If there is no time, or not one axis or three.
        """
        chosen = self._chosen("acceleration", columns, unit, (1, 3))
        values = np.column_stack([self.columns[name] for name in chosen])
        return acceleration(
            self.time,
            values[:, 0] if len(chosen) == 1 else values,
            unit=unit if unit is not None and self.units[chosen[0]] is None else "m/s2",
            filter_class=filter_class,
            full_scale=full_scale,
        )

    def force(
        self,
        column: str | None = None,
        *,
        unit: str | None = None,
        device: ForceDevice | None = None,
        region_spring: float | None = None,
    ) -> ForceRecord:
        """Return its forces, see `records.force`.

        Parameters
        ----------
        column : str or None
            ``None`` for the one with a unit of force.
        unit : {"N", "kN", "daN", "lbf"} or None
            Of a column without a unit.
        device : ForceDevice or None
            As for `records.force`.
        region_spring : float or None
            As for `records.force`.

        Returns
        -------
        ForceRecord
            Contacts and doubts.

        Raises
        ------
        FileError
            If there is no time, or not one column.
        """
        (chosen,) = self._chosen("force", None if column is None else [column], unit, (1,))
        own = unit if unit is not None and self.units[chosen] is None else "N"
        return force(self.time, self.columns[chosen], unit=own, device=device, region_spring=region_spring)

    def _chosen(
        self, dimension: str, columns: list[str] | None, unit: str | None, numbers: tuple[int, ...]
    ) -> list[str]:
        """Return the columns of a dimension."""
        name = Path(self.source.path).name
        if columns is not None:
            chosen = [
                word("columns", each, list(self.columns)) for each in sequence("columns", "name columns", columns)
            ]
        else:
            known = [each for each, told in self.units.items() if told and dimension_of(told) == dimension]
            bare = [each for each in self.units if self.units[each] is None and each != self.time_column]
            chosen = known or (bare if unit is not None else [])
        if len(chosen) not in numbers:
            rule = f"have {' or '.join(map(str, numbers))} columns with a unit of {dimension}"
            found = Shown(f"{len(chosen)} of {', '.join(self.columns)}")
            raise FileError(name, rule, found, "name the columns, and give the unit", code="unit_needed")
        for each in chosen:
            told = self.units[each]
            if told is None and unit is None:
                rule = f"have a unit of {dimension}"
                raise FileError(f"{name}, column {each}", rule, Shown("none"), "give unit=", code="unit_needed")
            if told is not None and dimension_of(told) != dimension:
                raise FileError(f"{name}, column {each}", f"have a unit of {dimension}", told, code="unit_needed")
        return chosen


def load(path: str | PathLike[str], *, time: str | None = None) -> Record:
    r"""Return the record of a device's file.

    Text in columns is read as devices write it: the longest run of lines of equally many numbers, separated by ``;``,
    tabs, commas or blanks, with a decimal point or comma, names and units above. ISO-MME is read from a channel, a
    folder or an archive.

    Parameters
    ----------
    path : path-like
        File, or folder of ISO-MME channels.
    time : str or None
        Column of times in s, where the file does not tell.

    Returns
    -------
    Record
        Columns in SI units.

    Raises
    ------
    FileError
        With the place and a ``code``: ``no_numbers``, ``ambiguous_decimal``, ``thousands_separator``,
        ``unknown_unit``, ``gap`` for a step of more than 1.5 steps, ``no_time``, ``not_increasing``.

    Examples
    --------
    >>> from pathlib import Path
    >>> from hrsafety import records
    >>> _ = Path("run.csv").write_text("Time [ms];Force [N]\n0,0;0,5\n0,5;12,25\n1,0;140,0\n")
    >>> found = records.load("run.csv")
    >>> found.time.tolist(), found.columns["Force"].tolist()
    ([0.0, 0.0005, 0.001], [0.5, 12.25, 140.0])
    """
    place = Path(path)
    if place.is_dir() or zipfile.is_zipfile(place):
        return _of_channels(place, time)
    document = Document(readable("path", path))
    if is_channel(document.text):
        return _of_channels(place, time, document)
    table = read_table(document)
    names = list(table.columns)
    chosen = word("time", time, names) if time is not None else _time_column(table)
    columns = dict(table.columns)
    if chosen is not None:
        columns[chosen] = _even(document, columns[chosen], table, names.index(chosen))
    return Record(
        columns=columns,
        units=dict(zip(names, table.units, strict=True)),
        codes={},
        time_column=chosen,
        header=tuple(table.header),
        delimiter=table.delimiter,
        decimal=table.decimal,
        source=Provenance(path=str(path), format="table", sha256=document.sha256),
        warnings=tuple(document.warnings),
    )


def _time_column(table: DeviceTable) -> str | None:
    """Return the column of times: by its unit, or by its name."""
    for name, unit in zip(table.columns, table.units, strict=True):
        if unit is not None and dimension_of(unit) == "time":
            return name
    named = [name for name in table.columns if name.lower().replace("_", " ").split(" ")[0] in _TIMES]
    return named[0] if named else None


def _even(document: Document, time: Array, table: DeviceTable, place: int) -> Array:
    """Return times on their even grid where they were rounded to their last digit; refuse gaps."""
    if len(time) < 3:
        return time
    steps = np.diff(time)
    step = float(time[-1] - time[0]) / (len(time) - 1)
    line = len(table.header) + 2
    if not steps.min() > 0.0:
        worst = int(np.argmin(steps))
        rule = "increase from line to line"
        raise document.error("not_increasing", rule, float(time[worst + 1]), line=line + worst, key="column of times")
    unit = table.units[place]
    digit = 10.0 ** -table.decimals[place] * (1.0 if unit is None else factor_of(unit))
    even = time[0] + step * np.arange(len(time))
    # The first and the last time are rounded, too.
    if np.abs(time - even).max() <= digit * (1.0 + 1e-6):
        return np.asarray(even)
    usual = float(np.median(steps))
    if steps.max() > _GAP * usual:
        worst = int(np.argmax(steps))
        rule = f"have no gap of more than {_GAP:g} steps of {usual:.6g} s"
        remedy = "cut the record at the gap"
        raise document.error("gap", rule, float(steps[worst]), remedy, line=line + worst, key="column of times")
    return time


def _of_channels(path: Path, time: str | None, document: Document | None = None) -> Record:
    """Return the record of ISO-MME channels that share their times."""
    found = [one_channel(document.text, document.name)] if document else channels_of(path)
    first = found[0]
    for each in found[1:]:
        if len(each.time) != len(first.time) or np.abs(each.time - first.time).max() > 1e-9:
            rule = f"have the times of channel {first.name}"
            raise FileError(
                f"{path.name}, channel {each.name}",
                rule,
                Shown(f"{len(each.time)} samples from {each.time[0]:g} s"),
                "load channels of other times one by one",
                code="different_times",
            )
    names = [each.name if [other.name for other in found].count(each.name) == 1 else each.code for each in found]
    columns = {"time": first.time} | dict(zip(names, (each.values for each in found), strict=True))
    units: dict[str, str | None] = {"time": "s"}
    units.update(zip(names, (each.unit for each in found), strict=True))
    sha256 = document.sha256 if document else ""
    if time is not None:
        word("time", time, ["time"])
    return Record(
        columns=columns,
        units=units,
        codes=dict(zip(names, (each.code for each in found), strict=True)),
        time_column="time",
        header=tuple(f"{key}: {value}" for key, value in first.header.items()),
        delimiter=None,
        decimal=".",
        source=Provenance(path=str(path), format="iso_mme", sha256=sha256),
    )
