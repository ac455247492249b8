"""Channels of the text format of ISO/TS 13499: files of one channel, folders and archives of several."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from hrsafety._arguments import Array
from hrsafety._text import MOST_BYTES, decoded
from hrsafety.errors import FileError, Shown
from hrsafety.io.reader import Document
from hrsafety.records.units import KNOWN, factor_of, plain

__all__ = ["Channel", "channels_of", "is_channel"]

_VALUE = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|NOVALUE")
_MOST_FILES = 10_000


class Channel(NamedTuple):
    """A channel.

    Attributes
    ----------
    name, code : str
        Of the channel.
    unit : str or None
        As in the file.
    time, values : ndarray, shape (n,)
        In SI units; NaN where there is no value.
    header : dict of str to str
        Everything above the numbers.
    """

    name: str
    code: str
    unit: str | None
    time: Array
    values: Array
    header: dict[str, str]


def is_channel(text: str) -> bool:
    """Return whether a text is a channel."""
    return bool(re.search(r"^Channel code[ \t]*:", text, re.MULTILINE))


def channels_of(path: Path) -> list[Channel]:
    """Return the channels of a folder or an archive.

    Raises
    ------
    FileError
        If there are none, or one cannot be read.
    """
    if path.is_dir():
        places = sorted(place for place in path.rglob("*") if place.is_file())
        if len(places) > _MOST_FILES:
            raise FileError(path.name, f"hold at most {_MOST_FILES} files", len(places), code="too_large")
        texts = ((place.name, Document(place).text) for place in places if place.suffix.lower() != ".zip")
        found = [channel(text, name) for name, text in texts if is_channel(text)]
    else:
        found = [channel(text, name) for name, text in _unpacked(path) if is_channel(text)]
    if not found:
        raise FileError(path.name, "hold channels of ISO-MME", Shown("none"), code="no_numbers")
    return found


def _unpacked(path: Path) -> list[tuple[str, str]]:
    """Return the texts of an archive."""
    try:
        with zipfile.ZipFile(path) as archive:
            entries = [entry for entry in archive.infolist() if not entry.is_dir()]
            size = sum(entry.file_size for entry in entries)
            if size > MOST_BYTES or len(entries) > _MOST_FILES:
                found = Shown(f"{len(entries)} files of {size} bytes")
                raise FileError(path.name, "hold at most 1 GiB", found, "cut it into parts", code="too_large")
            return [(entry.filename, decoded(archive.read(entry), entry.filename)[0]) for entry in entries]
    except (zipfile.BadZipFile, OSError, RuntimeError, NotImplementedError, EOFError, ValueError) as error:
        if isinstance(error, FileError):
            raise
        raise FileError(path.name, "be an archive that can be unpacked", Shown(str(error)), code="unreadable") from None


def channel(text: str, name: str) -> Channel:
    """Return the channel of a text.

    Raises
    ------
    FileError
        ``no_time`` without first time or interval, ``no_numbers``, ``unknown_unit``.
    """
    lines = re.split("\r\n?|\n", text)
    header: dict[str, str] = {}
    begin = len(lines)
    for place, line in enumerate(lines):
        if _VALUE.fullmatch(line.strip()):
            begin = place
            break
        key, colon, value = line.partition(":")
        if colon:
            header.setdefault(key.strip(), value.strip())
    cells = [line.strip() for line in lines[begin:]]
    while cells and not cells[-1]:
        cells.pop()
    for place, cell in enumerate(cells):
        if not _VALUE.fullmatch(cell):
            rule = "hold a number or NOVALUE in each line of data"
            raise FileError(f"{name}, line {begin + place + 1}", rule, cell[:60], code="unreadable_number")
    if not cells:
        raise FileError(name, "hold numbers below its header", Shown("none"), code="no_numbers")
    values = np.array([np.nan if cell == "NOVALUE" else float(cell) for cell in cells])
    told = header.get("Unit", "")
    unit = None if told in {"", "1", "-", "NOVALUE"} else told
    if unit is not None and plain(unit) is None:
        rule = f"be a unit that is known ({KNOWN})"
        raise FileError(f"{name}, key Unit", rule, unit, code="unknown_unit")
    return Channel(
        name=header.get("Name of the channel", "") or header.get("Channel code", name),
        code=header.get("Channel code", ""),
        unit=unit,
        time=_times(header, len(values), name),
        values=values * (1.0 if unit is None else factor_of(unit)),
        header=header,
    )


def _times(header: dict[str, str], samples: int, name: str) -> Array:
    """Return the times of a channel in s."""
    if header.get("Reference channel", "implicit").lower() not in {"implicit", "novalue", ""}:
        rule = "have an implicit time: sample i at first time + i interval"
        remedy = "export the channel with first time and sampling interval"
        raise FileError(f"{name}, key Reference channel", rule, header["Reference channel"], remedy, code="no_time")
    found = []
    for key in ("Time of first sample", "Sampling interval"):
        try:
            number = float(header.get(key, ""))
        except ValueError:
            number = np.nan
        if not np.isfinite(number) or (key == "Sampling interval" and not number > 0.0):
            rule = "be a number of s" + (" above 0" if key == "Sampling interval" else "")
            raise FileError(f"{name}, key {key}", rule, header.get(key, Shown("nothing")), code="no_time")
        found.append(number)
    return np.asarray(found[0] + found[1] * np.arange(samples))
