"""Gain study files: TOML in, a checked search for gains out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from types import MappingProxyType
from typing import Any

from hrsafety import _keys as kind
from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety._arguments import meant
from hrsafety._keys import Keys, checked, located, parsed
from hrsafety._records import dataclass
from hrsafety.cli.output import law_words
from hrsafety.cli.study_laws import law_of_study
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.gains.metrics import METRICS
from hrsafety.scenarios import files, laws

__all__ = ["GainStudy", "load", "scenarios_of"]

Gains = tuple[float, ...]
GAIN_NAMES = nav.VirtualForceField.GAIN_NAMES


def _counts(path: str, value: Any) -> tuple[int, ...]:
    """Check an array of four positive integers."""
    if not isinstance(value, list) or len(value) != len(GAIN_NAMES):
        raise InvalidParameterError(path, f"be an array of {len(GAIN_NAMES)} integers", kind.shown(value))
    counts = tuple(kind.integer(f"{path}[{index}]", entry) for index, entry in enumerate(value))
    for index, entry in enumerate(counts):
        if entry < 1:
            raise InvalidParameterError(f"{path}[{index}]", "be at least 1", entry)
    return counts


_TOP: Keys = MappingProxyType(
    {
        "title": kind.word,
        "scenarios": kind.words,
        "checkpoint": kind.word,
        "law": kind.table,
        "bounds": kind.table,
        "search": kind.table,
        "objective": kind.table,
        "constraints": kind.tables,
        "noise": kind.table,
        "run": kind.table,
        "front": kind.table,
        "compare": kind.tables,
    }
)
_LAW: Keys = MappingProxyType(
    {name: check for name, check in laws.keys_of(nav.VirtualForceField).items() if name not in GAIN_NAMES}
)
_BOUNDS: Keys = MappingProxyType(dict.fromkeys(GAIN_NAMES, kind.pair))
_SEARCH: Keys = MappingProxyType(
    {
        "method": kind.word,
        "grid": _counts,
        "refinements": kind.integer,
        "survivors": kind.integer,
        "local_starts": kind.integer,
        "evaluations": kind.integer,
        "seed": kind.integer,
    }
)
_OBJECTIVE: Keys = MappingProxyType(
    {"metric": kind.word, "weights": kind.triple, "require_arrival": kind.boolean, "cap_ratios": kind.boolean}
)
_CONSTRAINT: Keys = MappingProxyType(
    {"metric": kind.word, "at_least": kind.number, "at_most": kind.number, "scenario": kind.word}
)
_NOISE: Keys = MappingProxyType({"seeds": kind.integer, "robustness": kind.word})
_RUN: Keys = MappingProxyType(
    {"integrator": kind.word, "step": kind.number, "hold": kind.boolean, "time_limit": kind.number}
)
_FRONT: Keys = MappingProxyType({"objectives": kind.words, "grid": _counts, "refinements": kind.integer})
_COMPARE: Keys = MappingProxyType({"name": kind.word, **dict.fromkeys(GAIN_NAMES, kind.number)})


@dataclass(frozen=True, kw_only=True, slots=True)
class GainStudy:
    """Contents of a gain study file.

    Attributes
    ----------
    title : str
        Heading of the page.
    names : tuple of str
        Names of the scenarios: of a configuration, or a file without its ending.
    scenarios : tuple of Scenario
        Where.
    law : VirtualForceField or None
        Mode and side rules; its gains are searched. ``None``: without stabilizing force, where the scenario files have
        no law either.
    search : dict
        Arguments of `hrsafety.navigation.optimize_gains` beyond scenarios and law.
    front : dict or None
        Arguments of `hrsafety.navigation.gains.pareto_front` that differ from those of the search;
        ``None``: no front is wanted.
    compare : dict of str to tuple
        Gain sets to show beside the best one, by name.
    checkpoint : Path or None
        Where unfinished work is kept; ``None``: in the output folder.
    """

    title: str
    names: tuple[str, ...]
    scenarios: tuple[nav.Scenario, ...]
    law: nav.VirtualForceField | None
    search: dict[str, Any]
    front: dict[str, Any] | None
    compare: dict[str, Gains] = field(default_factory=dict)
    checkpoint: Path | None = None

    @property
    def objective(self) -> str:
        """Name of the objective."""
        return str(self.search.get("objective", "performance"))


@kind.top_level(_TOP)
def load(path: str) -> GainStudy:
    """Read a gain study file.

    Parameters
    ----------
    path : str
        The file, see ``examples/gain_study.toml``. Names of files in it are relative to it.

    Returns
    -------
    GainStudy
        Every key known and every value of its kind; ranges are checked by the search itself.

    Raises
    ------
    InvalidParameterError
        If the file cannot be read, is not TOML, or a value breaks a rule; the message names the
        key.
    """
    place = Path(path)
    fields = checked("", parsed(place), _TOP, required=("scenarios",))
    names, scenes, of_files = scenarios_of(fields["scenarios"], place.parent)
    search = checked("search", fields.get("search", {}), _SEARCH)
    search |= checked("run", fields.get("run", {}), _RUN) | checked("noise", fields.get("noise", {}), _NOISE)
    search |= _objective(fields.get("objective", {}))
    search["bounds"] = checked("bounds", fields.get("bounds", {}), _BOUNDS)
    search["constraints"] = tuple(
        _constraint(f"constraints[{index}]", table, names) for index, table in enumerate(fields.get("constraints", []))
    )
    if "checkpoint" in fields and not fields["checkpoint"].strip():
        raise InvalidParameterError("checkpoint", "name a file", Shown("an empty text"))
    return GainStudy(
        title=fields.get("title", "Gains"),
        names=names,
        scenarios=scenes,
        law=_law(fields, of_files),
        search=search,
        front=_front(fields["front"]) if "front" in fields else None,
        compare=_compare(fields.get("compare", [])),
        checkpoint=place.parent / fields["checkpoint"] if "checkpoint" in fields else None,
    )


def _law(fields: dict[str, Any], of_files: Mapping[str, nav.Law | None]) -> nav.VirtualForceField | None:
    """Return the law, whose gains a study does not name: they are what is searched."""
    own = laws.law_of(checked("law", fields["law"], _LAW)) if "law" in fields else None
    if own is not None and not isinstance(own, nav.VirtualForceField):
        raise InvalidParameterError("law.type", "be virtual_force_field", fields["law"]["type"])
    for name, law in of_files.items():
        if law is not None and not isinstance(law, nav.VirtualForceField):
            rule = "have the virtual force field, whose gains are searched, with nothing around it"
            remedy = "nav.optimize_gains searches gains of any law, [safe] included; hrsafety sweep takes it as it is"
            raise InvalidParameterError("scenarios", rule, Shown(f"{name} with {law_words(law)}"), remedy)
    found = law_of_study(own, of_files, _without_gains)
    assert found is None or isinstance(found, nav.VirtualForceField)  # all are
    return found


def _without_gains(law: nav.Law) -> nav.Law:
    return law.replaced(**dict.fromkeys(law.GAIN_NAMES, 1.0))


def scenarios_of(
    given: list[str], folder: Path
) -> tuple[tuple[str, ...], tuple[nav.Scenario, ...], dict[str, nav.Law | None]]:
    """Return the scenarios with short names, published configurations and scenario files, and the laws of the files.

    A file without ``[law]`` and ``[safe]`` has the law ``None``.
    """
    if not given:
        raise InvalidParameterError("scenarios", "name at least one scenario", Shown("an empty array"))
    found: dict[str, nav.Scenario] = {}
    of_files: dict[str, nav.Law | None] = {}
    for index, word in enumerate(given):
        where = f"scenarios[{index}]"
        name = word if word in scenarios.CONFIGURATIONS else Path(word).stem
        if name in found:
            raise InvalidParameterError(where, "be a scenario that is not named before", word)
        if word in scenarios.CONFIGURATIONS:
            found[name] = scenarios.configuration(word)
        else:
            found[name], of_files[word] = _scenario_file(where, folder / word, word)
    return tuple(found), tuple(found.values()), of_files


def _scenario_file(where: str, path: Path, word: str) -> tuple[nav.Scenario, nav.Law | None]:
    if not path.is_file():
        known = ", ".join(scenarios.CONFIGURATIONS)
        near = meant(word, scenarios.CONFIGURATIONS) or f"there is no file {path}"
        raise InvalidParameterError(where, f"be a scenario file or one of {known}", word, near)
    try:
        described = files.load(path)
        return described.scenario, described.law if parsed(path).keys() & {"law", "safe"} else None
    except InvalidParameterError as error:
        raise error.renamed(f"{where}: {word}: {error.argument}") from None


def _objective(table: dict[str, Any]) -> dict[str, Any]:
    given = checked("objective", table, _OBJECTIVE)
    if "metric" in given:
        given["objective"] = _metric("objective.metric", given.pop("metric"))
    return given


def _metric(path: str, word: str) -> str:
    return kind.one_of(path, word, METRICS, listed=True)


def _constraint(path: str, table: dict[str, Any], names: tuple[str, ...]) -> nav.gains.GainConstraint:
    given = checked(path, table, _CONSTRAINT, required=("metric",))
    if "scenario" in given:
        name = kind.one_of(f"{path}.scenario", given["scenario"], names, listed=True)
        given["scenario"] = names.index(name)
    with located(path):
        return nav.gains.GainConstraint(**given)


def _front(table: dict[str, Any]) -> dict[str, Any]:
    given = checked("front", table, _FRONT)
    if "objectives" in given:
        words = [_metric(f"front.objectives[{index}]", word) for index, word in enumerate(given["objectives"])]
        if len(words) < 2 or len(set(words)) < len(words):
            raise InvalidParameterError(
                "front.objectives", "name at least two different metrics", Shown(", ".join(words))
            )
        given["objectives"] = tuple(words)
    return given


def _compare(tables: list[dict[str, Any]]) -> dict[str, Gains]:
    found: dict[str, Gains] = {}
    for index, table in enumerate(tables):
        path = f"compare[{index}]"
        given = checked(path, table, _COMPARE, required=tuple(_COMPARE))
        name = given.pop("name")
        if name in found or not name.strip():
            raise InvalidParameterError(
                f"{path}.name", "be a name that no other gain set has", name or Shown("an empty text")
            )
        with located(path):
            found[name] = nav.VirtualForceField(**given).gains
    return found
