"""Cells from the files of ``data``: place, unit, tolerance and reasons stand there, a call brings what was measured.

Every text of a file may name numbers and words of the call in braces, as `str.format` takes them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from hrsafety.reproduce import data
from hrsafety.reproduce.cells import PrintedValue, Tolerance
from hrsafety.reproduce.published import printed_figure

__all__ = ["Sheet", "tolerance_from"]

_NO_TABLES = ("printed", "texts", "tolerances")


class _Words(dict[str, Any]):
    """Words of a call, and the shared texts of the file with these words filled in."""

    def __init__(self, words: Mapping[str, Any], texts: Mapping[str, str]) -> None:
        super().__init__(words)
        self._texts = texts

    def __missing__(self, key: str) -> str:
        return self._texts[key].format_map(self)


def tolerance_from(entry: Mapping[str, float]) -> Tolerance:
    """Return a tolerance of a file, ``{relative = 0.05}`` or ``{absolute = 0.1}``."""
    ((kind, limit),) = entry.items()
    return Tolerance(limit, relative={"relative": True, "absolute": False}[kind])


class Sheet:
    """The cells of one file.

    Parameters
    ----------
    name : str
        File in the folder of data, without ending.
    """

    def __init__(self, name: str) -> None:
        content = data.table(name)
        self._texts: Mapping[str, str] = content.get("texts", {})
        self.tolerances = {key: tolerance_from(entry) for key, entry in content.get("tolerances", {}).items()}
        self._entries: dict[str, dict[str, Any]] = {
            key: {"table": table} | entry
            for table, group in content.items()
            if table not in _NO_TABLES
            for key, entry in group.items()
        }

    def number(
        self,
        key: str,
        measured: float,
        /,
        *,
        printed: Any = None,
        tolerance: Any = None,
        **words: object,
    ) -> PrintedValue:
        """Return a judged number; ``if_off`` of the file is its reason only where it is off."""
        filled = self._filled(key, words)
        cell = PrintedValue.compared(
            **filled.place,
            printed=float(filled.printed if printed is None else printed),
            measured=float(measured),
            tolerance=tolerance or self.tolerances[filled["tolerance"]],
            unit=filled["unit"],
        )
        return replace(cell, reason=filled.reason(cell.within))

    def claim(self, key: str, /, *, holds: bool, printed: Any = None, **words: object) -> PrintedValue:
        """Return a judged claim in words; ``measured`` of the file says what was found."""
        filled = self._filled(key, words)
        place: dict[str, Any] = {**filled.place, "printed": printed or filled.printed}
        cell = PrintedValue.listed(**place, unit=filled["unit"], reason=filled.reason(holds))
        return replace(cell, measured=filled["measured"], within=bool(holds))

    def listed(
        self, key: str, measured: float | str | None = None, /, *, printed: Any = None, **words: object
    ) -> PrintedValue:
        """Return a value beside another that is no judgment of the source, for example an experiment."""
        filled = self._filled(key, words)
        printed = filled.printed if printed is None else printed
        measured = filled["measured"] if measured is None else measured
        place: dict[str, Any] = {**filled.place, "printed": printed, "measured": measured}
        return PrintedValue.beside(**place, unit=filled["unit"], reason=filled.reason(None))

    def printed_only(self, key: str, /, *, printed: float | str, **words: object) -> PrintedValue:
        """Return a printed value that nothing is measured for."""
        filled = self._filled(key, words)
        return PrintedValue.listed(**filled.place, printed=printed, unit=filled["unit"], reason=filled.reason(None))

    def text(self, key: str, /, **words: object) -> str:
        """Return a shared text with words filled in."""
        return _Words(words, self._texts)[key] if key not in words else str(words[key])

    def _filled(self, key: str, words: Mapping[str, object]) -> _Filled:
        return _Filled(self._entries[key], _Words(words, self._texts))


class _Filled:
    """One entry of a file with the words of a call."""

    def __init__(self, entry: Mapping[str, Any], words: _Words) -> None:
        self._entry, self._words = entry, words

    def __getitem__(self, field: str) -> str:
        return str(self._entry.get(field, "")).format_map(self._words)

    @property
    def place(self) -> dict[str, str]:
        return {field: self[field] for field in ("table", "row", "column")}

    @property
    def printed(self) -> Any:
        """Printed value of the file, or the figure of the published text that it names."""
        if "figure" in self._entry:
            return printed_figure(*self["figure"].split("/"))
        given = self._entry.get("printed")
        return given.format_map(self._words) if isinstance(given, str) else given

    def reason(self, within: bool | None) -> str:
        return " ".join(filter(None, [self["reason"], "" if within else self["if_off"]]))
