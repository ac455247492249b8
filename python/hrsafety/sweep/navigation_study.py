"""Runs of mobile robots for each row of a design: gains, limits, noise, obstacles, or any scene."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from types import MappingProxyType
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from hrsafety import navigation as nav
from hrsafety._arguments import Array, Pair, flag, instance, positive, sequence, word
from hrsafety._records import dataclass
from hrsafety.errors import HrsafetyError, InvalidParameterError, Shown, SimulationError
from hrsafety.navigation.batch import check_scenarios, gain_sets
from hrsafety.navigation.gains.worlds import doubts_of, runs_of_sets
from hrsafety.navigation.laws.known import LAWS
from hrsafety.navigation.laws.python_law import as_law
from hrsafety.navigation.obstacles.moving_rectangle import Mobile
from hrsafety.navigation.outcomes import OUTCOMES
from hrsafety.navigation.performance import check_weights
from hrsafety.navigation.simulation import refuse_in_worlds
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.navigation.warnings import runs as run_warnings
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep.axes import Column, checked_name
from hrsafety.sweep.designs import MOST_LOOKED_AT, Design, Grid
from hrsafety.sweep.studies import Cases, Found, Study, chosen, raised

__all__ = ["NavigationStudy"]

Scenes: TypeAlias = nav.Scenario | Sequence[nav.Scenario]
Place: TypeAlias = nav.Scenario | nav.World

# Scenes that exist at the same time: they are built block by block.
BLOCK = 1024

LAW_UNITS: Mapping[str, str] = MappingProxyType(
    {"stabilizing_force_cap": "N", "stabilizing_momentum_cap": "", "side_hysteresis": "rad"}
)
PART_UNITS: Mapping[str, Mapping[str, str]] = MappingProxyType(
    {
        "shield": {
            "person_speed": "m/s",
            "latency": "s",
            "position_error": "m",
            "velocity_error": "m/s",
            "person_acceleration": "m/s^2",
            "margin": "m",
            "wall_margin": "m",
            "position_tracking": "m",
            "reaction_time": "s",
            "person_deceleration": "m/s^2",
        },
        "yielding": {
            "clearance": "m",
            "horizon": "s",
            "time_weight": "s",
            "distance_weight": "",
            "comfort": "m",
            "goal_weight": "",
            "reach": "m",
        },
    }
)
"""Units of the numbers of parts around a law; an axis has the name of the part before that of the number."""
SCENE_UNITS: Mapping[str, str] = MappingProxyType(
    {
        "control_period": "s",
        "time_limit": "s",
        "arrival_tolerance": "m",
        "heading": "rad",
        "rest_time": "s",
        "seed": "",
        "measurement_scale": "m",
        "measurement_latency": "s",
        "robot_mass": "kg",
        "robot_radius": "m",
        "robot_max_speed": "m/s",
        "robot_max_acceleration": "m/s^2",
        "robot_max_deceleration": "m/s^2",
        "robot_max_turn_rate": "rad/s",
        "robot_max_turn_acceleration": "rad/s^2",
        "obstacle_speed": "m/s",
    }
)
_OF_SCENARIOS = ("entered_active", "force_evaluations")
_MEASURED = MappingProxyType({"measurement_scale": "scale", "measurement_latency": "latency"})
_REGIONS = ("critical_radius", "active_radius")
"""Columns of the regions of each obstacle, which `_hrsafety.Scenario.regions` has in this order."""
ALIKE = 1e-9
"""Regions that differ by less are of one size, in m."""
_OF_SCENES = ("rest_time", "obstacle_speed")
"""Columns and axes that only scenarios have."""
ROWS_NOT_LOOKED_AT = "rows_not_looked_at"
"""Code of scenes that were not examined for doubts."""
_FIRST = (
    Column(name="outcome", kind="word", words=tuple(OUTCOMES)),
    Column(name="end_time", unit="s"),
    Column(name="arrival_time", unit="s"),
    Column(name="energy", unit="J"),
    Column(name="path_length", unit="m"),
    Column(name="min_clearance", unit="m"),
)
_TELLING = ("outcome", "end_time", "path_length", "min_clearance")
"""Columns that tell runs apart, as `run_warnings.of_repeats` compares."""
SEEDS_LOOKED_AT, CASES_LOOKED_AT = 4, 4
_LAST = (
    Column(name="entered_active", kind="integer"),
    Column(name="contacts_moving", kind="integer"),
    Column(name="contacts_toward", kind="integer"),
    Column(name="contacts_away", kind="integer"),
    Column(name="contacts_standing", kind="integer"),
    Column(name="contacts_at_fault", kind="integer"),
    Column(name="contacts_apart", kind="integer"),
    Column(name="wall_contacts", kind="integer"),
    Column(name="performance_total"),
    Column(name="performance_arrival_time"),
    Column(name="performance_avoidance"),
    Column(name="performance_energy_saving"),
    Column(name="force_evaluations", kind="integer"),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class NavigationStudy(Study):
    """Runs of a robot under a law in one or several scenarios or worlds, as by `navigation.simulate_many`.

    Axes by name:

    - the gains of the law by its ``GAIN_NAMES``; of the virtual force field also
      ``stabilizing_force_cap``, ``stabilizing_momentum_cap``, ``side_hysteresis``;
    - of a law with a `Shield` or `Yielding` around it their numbers, as ``shield_latency``, ``shield_position_error``
      or ``yielding_clearance``;
    - ``control_period``, ``time_limit``, ``arrival_tolerance``, ``heading``, ``rest_time``,
      ``seed`` of the scenarios; ``measurement_scale`` (the noise is that of `Measurement`
      where a scenario has none) and ``measurement_latency`` (without noise where a scenario has none);
      ``robot_mass``, ``robot_radius``, ``robot_max_speed``, ``robot_max_acceleration``, ``robot_max_deceleration``,
      and of two wheels ``robot_max_turn_rate`` and ``robot_max_turn_acceleration``; ``obstacle_speed``, which every
      obstacle that walks straight takes on in its direction. Regions that were not given as radii are sized anew,
      and the doubt ``regions_differ`` names the axes that do so;
    - of worlds of one robot those of them that are gains, ``control_period``, ``time_limit``, ``arrival_tolerance``,
      ``heading``, ``seed``, ``measurement_scale``, ``measurement_latency`` and of the robot;
    - with ``scenario``, any others: the function builds the scene from them.

    Gains that vary alone run fastest. Scenes that differ from row to row are built one by one,
    and if gains differ from row to row as well, each row is a batch of its own: put the gains
    last in a grid.

    Parameters
    ----------
    scenarios : Scenario or World, sequence of them, or mapping of str to them
        Where, all of one kind; worlds have one robot, a step of their own, and none of the options below but
        ``weights``. With names that appear in the result if it is a mapping. Not with ``scenario``.
    law : Law, a law in Python, or None
        The law; the default one when ``None``. One in Python is recognized by its source text and what it holds.
    scenario : callable or None
        ``scenario(row) -> Scenario`` or a sequence of them, one for each of ``names``; row is a
        dict of the axes that are none of the law. It must be importable where rows are
        computed, and give the same for the same row.
    names : sequence of str or None
        Names of the scenarios.
    axis_units : mapping of str to str
        Units of axes that only ``scenario`` knows, if they are not given there.
    weights, integrator, step, hold, stop_on_contact
        As for `navigation.simulate_batch`.
    outputs : sequence of str or None
        Columns to keep; all when ``None``: ``outcome``, ``end_time``, ``arrival_time``,
        ``energy``, ``path_length``, ``min_clearance``, ``entered_active``,
        ``contacts_moving``, ``contacts_toward``, ``contacts_away``, ``contacts_standing``, ``contacts_at_fault``,
        ``contacts_apart``, ``wall_contacts``, the four of the performance,
        ``force_evaluations``, and, without ``scenario``, ``min_distance_0``, ``critical_radius_0``,
        ``active_radius_0`` and so on. Worlds have neither these nor ``entered_active``.

    Raises
    ------
    InvalidParameterError
        If an argument is of the wrong kind, or a name is unknown.

    Examples
    --------
    >>> from hrsafety import scenarios, sweep
    >>> study = sweep.NavigationStudy(scenarios={name: scenarios.configuration(name) for name in ("c1", "c3")})
    >>> result = sweep.run(sweep.Grid([sweep.Axis(name="detour_gain", values=[10.0, 17.0, 30.0])]), study)
    >>> result["scenario"].tolist()[:2], set(result["outcome"].tolist())
    (['c1', 'c3'], {'arrived'})
    """

    scenarios: tuple[Any, ...] = ()
    law: nav.Law = field(default_factory=nav.VirtualForceField)
    scenario: Callable[[dict[str, float]], Scenes] | None = None
    names: tuple[str, ...] | None = None
    axis_units: Mapping[str, str] = field(default_factory=dict)
    weights: tuple[float, float, float] = (1 / 3, 1 / 3, 1 / 3)
    integrator: str = "semi_implicit_euler"
    step: float = 0.01
    hold: bool = True
    stop_on_contact: bool = False
    outputs: tuple[str, ...] | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        law = nav.VirtualForceField() if self.law is None else as_law(self.law)
        scenes, names = self._checked_scenarios()
        if not isinstance(self.axis_units, Mapping):
            raise InvalidParameterError("axis_units", "be a mapping", self.axis_units)
        word("integrator", self.integrator, ("semi_implicit_euler", "rk4"))
        values = {
            "law": law,
            "scenarios": scenes,
            "names": names,
            "axis_units": dict(self.axis_units),
            "step": positive("step", self.step),
            "hold": flag("hold", self.hold),
            "stop_on_contact": flag("stop_on_contact", self.stop_on_contact),
            "weights": check_weights(self.weights),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)
        object.__setattr__(self, "outputs", chosen(self._possible(), self.outputs))

    def _checked_scenarios(self) -> tuple[tuple[nav.Scenario, ...], tuple[str, ...] | None]:
        """Return the scenarios and their names."""
        given: Any = self.scenarios
        names = self.names
        if isinstance(given, Mapping):
            if names is not None:
                raise InvalidParameterError("names", "be None when the scenarios have names", names)
            names, given = tuple(given), tuple(given.values())
        scenes = (given,) if isinstance(given, nav.Scenario | nav.World) else given
        scenes = tuple(sequence("scenarios", "be a sequence or a mapping of Scenario or World", scenes))
        kind = nav.World if scenes and isinstance(scenes[0], nav.World) else nav.Scenario
        for index, scene in enumerate(scenes):
            instance(f"scenarios[{index}]", scene, kind)
            if isinstance(scene, nav.World) and len(scene.robots) != 1:
                found = Shown(str(len(scene.robots)))
                raise InvalidParameterError(f"scenarios[{index}].robots", "be one, which the law drives", found)
        if kind is nav.World:
            own = {"integrator": self.integrator, "step": self.step, "hold": self.hold}
            refuse_in_worlds(own | {"stop_on_contact": self.stop_on_contact})
        elif scenes:
            check_scenarios(scenes)
        if self.scenario is not None and not callable(self.scenario):
            raise InvalidParameterError("scenario", "be callable or None", self.scenario)
        if (self.scenario is None) == (not scenes):
            raise InvalidParameterError("scenarios", "be given, or a function scenario instead of them", scenes)
        if names is None and len(scenes) > 1:
            names = tuple(str(index) for index in range(len(scenes)))
        if names is not None:
            names = tuple(sequence("names", "be a sequence of texts", names))
            if not names or not all(isinstance(name, str) for name in names) or len(set(names)) != len(names):
                raise InvalidParameterError("names", "be different texts, at least one", names)
            if scenes and len(names) != len(scenes):
                raise InvalidParameterError("names", f"be {len(scenes)}, one for each scenario", names)
        return scenes, names

    @property
    def cases(self) -> Cases | None:
        """The scenarios, if they have names or there are several."""
        return None if self.names is None else Cases("scenario", self.names)

    @property
    def _in_worlds(self) -> bool:
        """Whether people react to the robot."""
        return bool(self.scenarios) and isinstance(self.scenarios[0], nav.World)

    def _possible(self) -> tuple[Column, ...]:
        if self._in_worlds:
            return (*_FIRST, *(each for each in _LAST if each.name not in _OF_SCENARIOS))
        most = max((len(scene.obstacles) for scene in self.scenarios), default=0)
        of_each = (
            Column(name=f"{what}_{index}", unit="m") for what in ("min_distance", *_REGIONS) for index in range(most)
        )
        return (*_FIRST, *of_each, *_LAST)

    def columns(self) -> tuple[Column, ...]:
        """Return what is found for each row, without axes and scenarios."""
        return tuple(each for each in self._possible() if self.outputs is None or each.name in self.outputs)

    @property
    def _law_within(self) -> nav.Law:
        """The law without a shield and other parts around it."""
        return self.law.law if isinstance(self.law, nav.SafeNavigation) else self.law

    @property
    def _law_units(self) -> Mapping[str, str]:
        """Units of what else may vary of the law and of the parts around it."""
        own = LAW_UNITS if isinstance(self._law_within, nav.VirtualForceField) else {}
        parts = {
            f"{part}_{name}": unit
            for part, units in PART_UNITS.items()
            if isinstance(self.law, nav.SafeNavigation) and getattr(self.law, part) is not None
            for name, unit in units.items()
        }
        return {**own, **parts}

    def units(self, names: Sequence[str]) -> dict[str, str]:
        """Return the units of axes with these names, see `Study.units`."""
        known = {**self.law.GAIN_UNITS, **self._law_units}
        if self.scenario is None:
            known |= {name: unit for name, unit in SCENE_UNITS.items() if not self._in_worlds or name not in _OF_SCENES}
            for name in names:
                self._check_axis(name, tuple(known))
        else:
            known |= {checked_name("axis_units", name): unit for name, unit in self.axis_units.items()}
        return {name: known[name] for name in names if name in known}

    def _check_axis(self, name: str, known: tuple[str, ...]) -> None:
        """Raise unless the axis is known; where another law has it, the error names the law of the study."""
        if name not in known and any(name in (*law.GAIN_NAMES, *LAW_UNITS) for law in LAWS.values()):
            own = ", ".join((*self.law.GAIN_NAMES, *self._law_units)) or "none"
            rule = f"be an axis of the law {type(self._law_within).__name__}, whose axes are {own}"
            raise InvalidParameterError("name of an axis", rule, name)
        for part, units in PART_UNITS.items():
            if name not in known and name.removeprefix(f"{part}_") in units and name.startswith(part):
                rule = f"be an axis of a law with {part} around it"
                remedy = f"give law=SafeNavigation(..., {part}=...), in a file [safe.{part}]"
                raise InvalidParameterError("name of an axis", rule, name, remedy)
        word("name of an axis", name, known)

    def compute(self, rows: dict[str, Array], threads: int | None = None) -> Found:
        """Return the columns for some rows, see `Study.compute`."""
        total = len(next(iter(rows.values())))
        each = 1 if self.names is None else len(self.names)
        found = {column.name: np.empty((total, each), dtype=_computed(column)) for column in self.columns()}
        for part in self._batches(rows, each):
            if self._in_worlds:
                sets = gain_sets(part.law, part.gains)
                table = runs_of_sets(part.scenes, part.law, sets, self.weights, threads=threads)
                regions: list[list[Pair]] = []
            else:
                table = nav.simulate_batch(
                    part.scenes,
                    part.law,
                    part.gains,
                    weights=self.weights,
                    integrator=self.integrator,  # type: ignore[arg-type]  # one of its words, checked
                    step=self.step,
                    hold=self.hold,
                    stop_on_contact=self.stop_on_contact,
                    threads=threads,
                )
                regions = [scene._native.regions() for scene in part.scenes]
            for name, values in found.items():
                values[part.rows] = _values(table, regions, name).reshape(-1, each)[part.order]
        return {name: values.reshape(-1) for name, values in found.items()}

    def doubts(self, rows: dict[str, Array]) -> tuple[ResultWarning, ...]:
        """Return the warnings of the scenes of these rows, see `Study.doubts`."""
        others = [name for name in rows if name not in self.law.GAIN_UNITS]
        distinct = np.unique(np.stack([rows[name] for name in others], axis=1), axis=0) if others else np.empty((1, 0))
        # Rows of one law together: what a shield assumes is compared with the scenes of its own rows.
        of_laws: dict[tuple[float, ...], tuple[nav.Law, list[Any]]] = {}
        refused: list[InvalidParameterError] = []
        for row in distinct.tolist():
            values = dict(zip(others, row, strict=True))
            # A row that cannot be is an error of the chunk that computes it.
            try:
                law, made = self._law(values), self._scenes(values, len(self.names or [""]))
            except InvalidParameterError as error:
                refused.append(error)
                continue
            numbers = tuple(values[name] for name in others if name in self._law_units)
            of_laws.setdefault(numbers, (law, []))[1].extend(made)
        told: dict[tuple[str, str, bool], ResultWarning] = {}
        sized = self._of_regions({name: rows[name] for name in others})
        for law, scenes in of_laws.values():
            for each in self._of_law(law, scenes):
                told.setdefault((each.code, each.subject.rpartition(".")[2], each.safe_side), each)
        return (*_impossible(refused, len(distinct)), *told.values(), *sized)

    def _of_regions(self, rows: dict[str, Array]) -> Iterator[ResultWarning]:
        """Warn of axes of the scene that size regions, by the ends of each: rows differ by two things at once."""
        if self._in_worlds or self.scenario is not None:
            return
        first = {name: float(values.min()) for name, values in rows.items()}
        found: dict[str, str] = {}
        for name, values in rows.items():
            try:
                ends = [self._scenes({**first, name: end}, 1) for end in (first[name], float(values.max()))]
            except InvalidParameterError:  # an error of the chunk that computes it
                continue
            for case, (one, other) in enumerate(zip(*ends, strict=True)):
                for index, (low, high) in enumerate(zip(one._native.regions(), other._native.regions(), strict=True)):
                    if not np.allclose(low, high, rtol=0.0, atol=ALIKE):
                        where = f"{f'scenarios[{self.names[case]!r}].' if self.names else ''}obstacles[{index}]"
                        sizes = (f"{word} {low[k]:.4g} to {high[k]:.4g} m" for k, word in enumerate(_REGIONS))
                        found.setdefault(name, f"of {where} {', '.join(sizes)}")
        if found:
            name = next(iter(found))
            message = (
                f"regions are sized for {' and '.join(found)}, over {name} {found[name]}: rows differ by their regions "
                "as well, which are columns of the result; give obstacles a critical_radius and an active_radius to "
                "keep them"
            )
            yield ResultWarning("regions_differ", name, message)

    def _of_law(self, law: nav.Law, scenes: list[Any]) -> tuple[ResultWarning, ...]:
        """Return the warnings of scenes under a law."""
        if self._in_worlds:
            return doubts_of(scenes, law)
        words = [f"scenarios[{name!r}]" for name in self.names] if self.names else ["scenario"]
        return run_warnings.of_runs(scenes, words * (len(scenes) // len(words)), [law], None, self.step)

    def judged(self, design: Design) -> tuple[ResultWarning, ...]:
        """Return the doubts of a design before it runs, see `Study.judged`.

        A function makes any scene of a row: of few rows all are examined, of more some, and a doubt says so.
        """
        return (*self._of_scenes(design), *self._of_seeds(design))

    def _of_scenes(self, design: Design) -> tuple[ResultWarning, ...]:
        if self.scenario is None:
            return self.doubts(design.looked_at())
        rows, total = design.spread(MOST_LOOKED_AT, without=self.law.GAIN_UNITS)
        found = self.doubts(rows)
        looked_at = len(next(iter(rows.values())))
        if looked_at == total:
            return found
        message = (
            f"scenes are made by a function, and those of {looked_at} of {total} rows, spread over the design, were "
            "looked at for doubts: what scenario.warnings says of the others nobody has read"
        )
        return (*found, ResultWarning(ROWS_NOT_LOOKED_AT, "scenario", message))

    def _of_seeds(self, design: Design) -> Iterator[ResultWarning]:
        """Warn of a grid over seeds that change nothing, from runs with some seeds at both ends of the other axes."""
        if not isinstance(design, Grid) or "seed" not in design.names:
            return
        seeds = next(axis for axis in design.axes if axis.name == "seed").levels()
        first = seeds[:SEEDS_LOOKED_AT]
        words = self.names or ("the scenario",)
        few = slice(None) if self.scenarios == () else slice(CASES_LOOKED_AT)
        study = replace(
            self, scenarios=self.scenarios[few], names=None if self.names is None else self.names[few], outputs=_TELLING
        )
        alike = np.full(len(words[few]), len(seeds) > 1)
        for end in (0, -1):
            if not alike.any():
                return
            rows = {name: np.full(len(first), values[end]) for name, values in design.looked_at().items()}
            try:
                found = study.compute(rows | {"seed": first})
            except (InvalidParameterError, SimulationError):
                return  # an error of the chunk that computes it
            for values in found.values():
                runs = values.reshape(len(first), -1)
                alike &= ((runs == runs[0]) | ((runs != runs) & (runs[0] != runs[0]))).all(axis=0)
        if alike.any():
            where = words[few][int(np.argmax(alike))]
            more = f" (so in {alike.sum() - 1} more of the scenarios)" if alike.sum() > 1 else ""
            scene = study.scenarios[int(np.argmax(alike))] if study.scenarios else None
            own = getattr(scene, "measurement", None)
            why = "nothing there draws from it"
            remedy = "noise (measurement_scale), or a scene that is drawn for each seed, makes them differ"
            if "measurement_scale" in design.names or (own is not None and own.scale > 0.0):
                why = "noise is there, but none of it reaches the robot, as under a law that ignores people"
                remedy = run_warnings.ONE_RUN
            message = (
                f"the {len(seeds)} rows over seed in {where} are the same run: {why}, and shares and intervals count "
                f"one run as many; {remedy}{more}"
            )
            yield ResultWarning("same_runs", "seed", message)

    def _batches(self, rows: dict[str, Array], each: int) -> Iterator[_Batch]:
        """Yield calls that cover all rows: those that share everything but the gains run together."""
        gains = {name: rows[name] for name in rows if name in self.law.GAIN_UNITS} or None
        others = [name for name in rows if name not in self.law.GAIN_UNITS]
        if not others:
            yield _Batch(slice(None), list(self.scenarios), self.law, gains, slice(None))
            return
        keys = np.stack([rows[name] for name in others], axis=1)
        distinct, inverse = np.unique(keys, axis=0, return_inverse=True)
        order = np.argsort(inverse.reshape(-1), kind="stable")
        starts = np.searchsorted(inverse.reshape(-1)[order], np.arange(len(distinct) + 1))
        together = 1 if gains or set(others) & set(self._law_units) else max(BLOCK // each, 1)
        for first in range(0, len(distinct), together):
            last = min(first + together, len(distinct))
            members = order[starts[first] : starts[last]]
            values = [dict(zip(others, row, strict=True)) for row in distinct[first:last].tolist()]
            scenes = [scene for row in values for scene in self._scenes(row, each)]
            own = None if gains is None else {name: array[members] for name, array in gains.items()}
            places = inverse.reshape(-1)[members] - first if gains is None else slice(None)
            yield _Batch(members, scenes, self._law(values[0]), own, places)

    def _law(self, row: dict[str, float]) -> nav.Law:
        """Return the law of a row, its gains aside."""
        changes: dict[str, Any] = {name: value for name, value in row.items() if name in self._law_units}
        for part, units in PART_UNITS.items():
            own = {name: changes.pop(f"{part}_{name}") for name in units if f"{part}_{name}" in changes}
            if own:
                changes[part] = _replaced(getattr(self.law, part), part, own)
        return self.law.replaced(**changes) if changes else self.law

    def _scenes(self, row: dict[str, float], each: int) -> list[Any]:
        """Return the scenarios of a row."""
        values = {name: value for name, value in row.items() if name not in self._law_units}
        if self.scenario is None:
            change: Callable[[Any, Mapping[str, float]], Place] = _world_changed if self._in_worlds else _changed
            return [change(scene, values) for scene in self.scenarios]
        try:
            made = self.scenario(values)
        except HrsafetyError:
            raise
        except Exception as error:  # whatever a function raises: it is the cause of what is raised here
            raise raised(self.scenario, row, f"its row has the axes {', '.join(values) or 'none'}", error) from error
        scenes: list[Any] = list(made) if isinstance(made, Sequence) else [made]
        strange = next((scene for scene in scenes if not isinstance(scene, nav.Scenario)), None)
        if strange is not None:
            raise InvalidParameterError("scenario", f"return {each} Scenario", *_no_scenario(strange))
        if len(scenes) != each:
            raise InvalidParameterError("scenario", f"return {each} Scenario", Shown(f"{len(scenes)}"))
        return scenes


def _impossible(refused: Sequence[InvalidParameterError], rows: int) -> Iterator[ResultWarning]:
    """Warn of rows that cannot be run: the sweep ends with the error of the first."""
    if refused:
        message = (
            f"{len(refused)} of the {rows} rows that were looked at cannot be run, and end the sweep there: "
            f"{refused[0]}; leave such values out of the axes"
        )
        yield ResultWarning("invalid_numbers", refused[0].argument, message)


def _no_scenario(given: object) -> tuple[object, str | None]:
    """Return what an error shows of something that is no Scenario, and the advice for it."""
    if isinstance(given, nav.World):
        return Shown("a World"), "give worlds as scenarios=, with seed, time_limit and others as axes"
    return given, None


class _Batch(NamedTuple):
    """One call: which rows of the chunk it gives, and which rows of its table they are."""

    rows: npt.NDArray[np.int64] | slice
    scenes: list[Any]
    law: nav.Law
    gains: dict[str, Array] | None
    order: npt.NDArray[np.int64] | slice


def _values(table: RunTable, regions: Sequence[Sequence[Pair]], name: str) -> npt.NDArray[Any]:
    """Return a column of a table of runs, the scenes fastest, by its name in a sweep; both radii by scene, obstacle."""
    what, _, obstacle = name.rpartition("_")
    if what in _REGIONS:
        index, radius = int(obstacle), _REGIONS.index(what)
        own = [each[index][radius] if index < len(each) else math.nan for each in regions]
        return np.resize(own, len(table))
    found: npt.NDArray[Any] = table.min_distance[:, int(obstacle)] if what == "min_distance" else getattr(table, name)
    return found


def _computed(column: Column) -> np.dtype[Any]:
    """Return the type of a column as it is computed."""
    return np.dtype(f"U{max(map(len, column.words))}") if column.words else column.stored


def _changed(scene: nav.Scenario, values: Mapping[str, float]) -> nav.Scenario:
    """Return a scenario with some of its numbers replaced."""
    changes: dict[str, Any] = {}
    robot: dict[str, Any] = {}
    for name, value in values.items():
        if name == "seed":
            changes["seed"] = _whole("seed", value)
        elif name in _MEASURED:
            changes["measurement"] = _measured(scene.measurement, values)
        elif name == "obstacle_speed":
            changes["obstacles"] = tuple(_at_speed(obstacle, value) for obstacle in scene.obstacles)
        elif name.startswith("robot_"):
            robot[name.removeprefix("robot_")] = value
        else:
            changes[name] = value
    if robot:
        changes["robot"] = replace(scene.robot, **robot)
    return replace(scene, **changes)


def _world_changed(world: nav.World, values: Mapping[str, float]) -> nav.World:
    """Return a world with some of its numbers, and some of its robot, replaced."""
    changes: dict[str, Any] = {}
    own: dict[str, Any] = {}
    body: dict[str, Any] = {}
    (robot,) = world.robots
    for name, value in values.items():
        if name == "seed":
            changes["seed"] = _whole("seed", value)
        elif name == "time_limit":
            changes[name] = value
        elif name in _MEASURED:
            own["measurement"] = _measured(robot.measurement, values)
        elif name.startswith("robot_"):
            body[name.removeprefix("robot_")] = value
        else:
            own[name] = value
    if body:
        own["body"] = replace(robot.body, **body)
    return replace(world, robots=[replace(robot, **own)], **changes)


def _replaced(part: Any, prefix: str, values: Mapping[str, float]) -> Any:
    """Return a part with other numbers; an error names the axis."""
    try:
        return replace(part, **values)
    except InvalidParameterError as error:
        raise error.renamed(f"{prefix}_{error.argument}") from None


def _measured(given: nav.Measurement | None, values: Mapping[str, float]) -> nav.Measurement:
    """Return a measurement with the numbers of a row; late positions alone are not noisy."""
    own = {field: values[name] for name, field in _MEASURED.items() if name in values}
    made: nav.Measurement = _replaced(nav.Measurement(scale=0.0) if given is None else given, "measurement", own)
    return made


def _whole(name: str, value: float) -> int:
    if value != math.floor(value) or value < 0.0:
        raise InvalidParameterError(name, "be an integer that is not negative", value)
    return int(value)


def _at_speed(obstacle: nav.Obstacle, speed: float) -> nav.Obstacle:
    """Return an obstacle that walks straight at another speed; others as they are."""
    if not isinstance(obstacle, Mobile):
        return obstacle
    if obstacle.segments is not None or obstacle.path is not None:
        raise InvalidParameterError("obstacle_speed", "be an axis only where all obstacles walk straight", obstacle)
    own = math.hypot(*obstacle.velocity)
    if own == 0.0:
        return obstacle
    return replace(obstacle, velocity=(obstacle.velocity[0] * speed / own, obstacle.velocity[1] * speed / own))
