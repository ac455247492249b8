"""Sweep files: TOML in, a checked design and study out."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import MappingProxyType
from typing import Any

from hrsafety import _keys as kind
from hrsafety import impact, sweep
from hrsafety import navigation as nav
from hrsafety._arguments import meant
from hrsafety._keys import Keys, checked, located, parsed
from hrsafety._records import dataclass
from hrsafety.cli.foam import file as foam_file
from hrsafety.cli.optimize import file as optimize_file
from hrsafety.cli.study_laws import law_of_study
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.scenarios import laws
from hrsafety.sweep.impact_study import IMPACT_UNITS

__all__ = ["SweepFile", "load"]

_NAVIGATION = ("scenarios", "law", "safe", "run")
_IMPACT = ("manipulator", "foam", "head", "impact")
_TOP: Keys = MappingProxyType(
    {
        "title": kind.word,
        "chunk_rows": kind.integer,
        "outputs": kind.words,
        "show": kind.words,
        "design": kind.table,
        "axes": kind.tables,
        "scenarios": kind.words,
        "law": kind.table,
        "safe": kind.table,
        "run": kind.table,
        "manipulator": kind.table,
        "foam": kind.table,
        "head": lambda path, value: kind.word(path, value) if isinstance(value, str) else kind.table(path, value),
        "impact": kind.table,
    }
)
_DESIGN: Keys = MappingProxyType(
    {"kind": kind.word, "size": kind.integer, "seed": kind.integer, "scramble": kind.boolean}
)
_AXIS: Keys = MappingProxyType(
    {
        "name": kind.word,
        "from": kind.number,
        "to": kind.number,
        "points": kind.integer,
        "values": kind.numbers,
        "unit": kind.word,
        "scale": kind.word,
    }
)
_RUN: Keys = MappingProxyType(
    {
        "integrator": kind.word,
        "step": kind.number,
        "hold": kind.boolean,
        "stop_on_contact": kind.boolean,
        "weights": kind.triple,
    }
)
_LOADS: Keys = MappingProxyType(
    {"fields": kind.word, "horizon": kind.number, **dict.fromkeys(IMPACT_UNITS, kind.number)}
)
_FOAM: Keys = MappingProxyType(
    {"stiffness": kind.number, "damping": kind.number, "thickness": kind.number, "linear_range": kind.number}
)
_HEAD: Keys = MappingProxyType({"mass": kind.number, "damping": kind.number, "stiffness": kind.number})
_HEADS: dict[str, Callable[[], impact.Head | impact.ConstrainedHead]] = {
    "minimum": impact.Head.minimum,
    "maximum": impact.Head.maximum,
    "apparatus": impact.Head.apparatus,
    "constrained": impact.ConstrainedHead,
}
_DESIGNS = ("grid", "latin_hypercube", "sobol")
# What the page shows without being told.
_SHOWN = frozenset(
    {
        "performance_total",
        "arrival_time",
        "min_clearance",
        "contacts_moving",
        "contacts_standing",
        "peak_head_acceleration_g",
        "peak_contact_force",
        "max_compression",
    }
)


@dataclass(frozen=True, kw_only=True, slots=True)
class SweepFile:
    """Contents of a sweep file.

    Attributes
    ----------
    title : str
        Heading of the page.
    design : Grid, LatinHypercube or Sobol
        Which rows.
    study : ImpactStudy or NavigationStudy
        What is computed.
    chunk_rows : int or None
        Rows of the design in a chunk.
    show : tuple of str
        Columns that are drawn.
    """

    title: str
    design: sweep.Design
    study: sweep.Study
    chunk_rows: int | None
    show: tuple[str, ...]


@kind.top_level(_TOP)
def load(path: str, outputs: tuple[str, ...] | None = None) -> SweepFile:
    """Read a sweep file.

    Parameters
    ----------
    path : str
        The file, see ``examples/impact_sweep.toml`` and ``examples/gain_sweep.toml``. Names of
        scenario files in it are relative to it.
    outputs : tuple of str, or None
        Columns to keep instead of those that the file names.

    Returns
    -------
    SweepFile
        Checked.

    Raises
    ------
    InvalidParameterError
        If the file cannot be read, is not TOML, or a value breaks a rule; the message names the
        key.
    """
    place = Path(path)
    fields = checked("", parsed(place), _TOP, required=("axes",))
    if outputs is not None:
        fields["outputs"] = list(outputs)
        # The file may draw columns that are not kept this time.
        fields["show"] = [name for name in fields.get("show", []) if name in outputs]
    if "scenarios" in fields:
        _refuse(fields, _IMPACT, "not be given with scenarios")
        study: sweep.Study = _navigation(fields, place.parent)
    else:
        _refuse(fields, _NAVIGATION[1:], "be given with scenarios only")
        study = _impact(fields)
    axes = [_axis(f"axes[{index}]", table) for index, table in enumerate(fields["axes"])]
    design = _design(fields.get("design", {}), axes)
    drawn = [column.name for column in study.columns() if column.kind != "word"]
    for index, name in enumerate(fields.get("show", [])):
        kind.one_of(f"show[{index}]", name, drawn, listed=True)
    chosen = fields.get("show") or [name for name in drawn if name in _SHOWN] or drawn[:1]
    return SweepFile(
        title=fields.get("title", f"Sweep of {' and '.join(axis.name.replace('_', ' ') for axis in axes)}"),
        design=design,
        study=study,
        chunk_rows=fields.get("chunk_rows"),
        show=tuple(chosen),
    )


def _refuse(fields: dict[str, Any], names: tuple[str, ...], requirement: str) -> None:
    for name in names:
        if name in fields:
            raise InvalidParameterError(name, requirement, kind.shown(fields[name]))


def _axis(path: str, table: dict[str, Any]) -> sweep.Axis:
    given = checked(path, table, _AXIS, required=("name",))
    renamed = {{"from": "low", "to": "high"}.get(name, name): value for name, value in given.items()}
    try:
        return sweep.Axis(**renamed)
    except InvalidParameterError as error:
        own = {"low": "from", "high": "to"}.get(error.argument, error.argument)
        rule = error.requirement.replace("low = ", "from = ")
        raise InvalidParameterError(f"{path}.{own}", rule, error.value, error.remedy) from None


def _design(table: dict[str, Any], axes: list[sweep.Axis]) -> sweep.Design:
    given = checked("design", table, _DESIGN)
    name = given.pop("kind", "grid")
    kind.one_of("design.kind", name, _DESIGNS, listed=True)
    unknown = [key for key in given if name == "grid" or (key == "scramble" and name != "sobol")]
    if unknown:
        raise InvalidParameterError(f"design.{unknown[0]}", f"not be given for a {name}", given[unknown[0]])
    if name != "grid" and "size" not in given:
        raise InvalidParameterError("design.size", f"be given for a {name}", Shown("nothing"))
    with located("design"):
        if name == "grid":
            return sweep.Grid(tuple(axes))
        return (sweep.Sobol if name == "sobol" else sweep.LatinHypercube)(tuple(axes), **given)


def _navigation(fields: dict[str, Any], folder: Path) -> sweep.NavigationStudy:
    names, scenes, of_files = optimize_file.scenarios_of(fields["scenarios"], folder)
    stepping = checked("run", fields.get("run", {}), _RUN)
    own = laws.law_of(fields["law"]) if "law" in fields else None
    if "safe" in fields:
        own = laws.safe_of(own or nav.VirtualForceField(), fields["safe"])
    law = law_of_study(own, of_files)
    options: dict[str, Any] = {"law": law, "outputs": fields.get("outputs"), **stepping}
    return sweep.NavigationStudy(scenarios=scenes, names=names, **options)


def _impact(fields: dict[str, Any]) -> sweep.ImpactStudy:
    given = checked("impact", fields.get("impact", {}), _LOADS)
    options: dict[str, Any] = {name: given.pop(name) for name in ("fields", "horizon") if name in given}
    if "manipulator" in fields:
        options["manipulator"] = foam_file.manipulator_of(fields["manipulator"])
    if "foam" in fields:
        foam = checked("foam", fields["foam"], _FOAM)
        for name in ("stiffness", "damping"):
            if name not in foam:
                remedy = "numbers of a foam by themselves go below [impact]: foam_stiffness, foam_damping, thickness"
                raise kind.missing(f"foam.{name}", f"{remedy}, linear_range")
        with located("foam"):
            options["foam"] = impact.Foam(**foam)
    if "head" in fields:
        options["head"] = _head(fields["head"])
    return sweep.ImpactStudy(fixed=given, outputs=fields.get("outputs"), **options)


def _head(given: str | dict[str, Any]) -> impact.Head | impact.ConstrainedHead:
    if isinstance(given, str):
        if given not in _HEADS:
            rule = f"be a table or one of {', '.join(_HEADS)}"
            raise InvalidParameterError("head", rule, kind.shown(given), meant(given, _HEADS))
        return _HEADS[given]()
    numbers = checked("head", given, _HEAD, required=tuple(_HEAD))
    with located("head"):
        return impact.Head(**numbers)
