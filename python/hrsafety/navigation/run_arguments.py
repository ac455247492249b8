"""Arguments of calls with many runs: scenarios and laws by name, seeds, gain sets."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Mapping

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, checked_seed, count, instance, sequence
from hrsafety._bounds import MOST_SEEDS
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.batch import gain_sets
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.laws.python_law import ANSWERS, PythonLaw, as_law
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.scenario_arrays import Numbers, Scenarios

__all__ = ["Numbered", "Progress", "Seeds", "checked_seeds", "listed", "named_laws", "named_scenarios", "sets_of"]

Seeds = int | Iterable[int]
Progress = Callable[[int, int], object]


class Numbered(Mapping[str, Scenario]):
    """Scenarios from arrays by their numbers.

    Parameters
    ----------
    rows : Scenarios
        The scenarios.
    """

    __slots__ = ("names", "rows")

    def __init__(self, rows: Scenarios) -> None:
        self.rows = rows
        self.names = Numbers(len(rows))

    def __len__(self) -> int:
        """Return their number."""
        return len(self.rows)

    def __iter__(self) -> Iterator[str]:
        """Yield their numbers as words."""
        return iter(self.names)

    def __getitem__(self, name: str) -> Scenario:
        """Return the scenario of a number."""
        return self.rows[self.names.index(name)]


def named_scenarios(scenarios: object) -> Mapping[str, Scenario] | Mapping[str, World]:
    """Return the scenarios or worlds by name, at least one.

    Parameters
    ----------
    scenarios : Scenario or World, sequence or mapping
        As for `simulate_many`.

    Returns
    -------
    mapping of str to Scenario or World
        All of one kind; without names they are numbered.

    Raises
    ------
    InvalidParameterError
        If there is none, or one is of another kind.
    """
    if isinstance(scenarios, Scenarios):
        return Numbered(scenarios)
    rule = "be a Scenario or World, a sequence of them or a mapping of names to them"
    given = listed("scenarios", rule, [scenarios] if isinstance(scenarios, (Scenario, World)) else scenarios)
    if isinstance(given[0][2], World):
        return {key: instance(f"scenarios[{shown}]", each, World) for key, shown, each in given}
    return {key: instance(f"scenarios[{shown}]", each, Scenario) for key, shown, each in given}


def named_laws(laws: object) -> dict[str, Law]:
    """Return the laws by name, at least one.

    Parameters
    ----------
    laws : Law, sequence or mapping
        As for `simulate_many`.

    Returns
    -------
    dict of str to Law
        Without names they are called by their class, laws in Python by their own name, from the second
        of a name on with the next number that is free.

    Raises
    ------
    InvalidParameterError
        If there is none, or one is of another kind.
    """
    single = isinstance(laws, Law | str) or callable(laws) or any(hasattr(laws, each) for each in ANSWERS)
    given = listed("laws", "be a law, a sequence of laws or a mapping of names to laws", [laws] if single else laws)
    found = [(key, as_law(each, "laws" if single else f"laws[{shown}]")) for key, shown, each in given]
    if isinstance(laws, Mapping):
        return dict(found)
    named: dict[str, Law] = {}
    kinds: dict[str, int] = {}
    for _, law in found:
        kind = law.name if isinstance(law, PythonLaw) and law.name else type(law).__name__
        kinds[kind] = kinds.get(kind, 0) + 1
        name = kind if kinds[kind] == 1 else f"{kind} {kinds[kind]}"
        while name in named:  # a law of the caller may be called "Masoud 2"
            kinds[kind] += 1
            name = f"{kind} {kinds[kind]}"
        named[name] = law
    return named


def listed(argument: str, rule: str, given: object) -> list[tuple[str, str, object]]:
    """Return name, what an error calls it, and value of everything in a sequence or a mapping.

    Parameters
    ----------
    argument, rule : str
        Name of the argument, and what it must be.
    given : object
        The sequence or mapping.

    Returns
    -------
    list of (str, str, object)
        At least one.

    Raises
    ------
    InvalidParameterError
        If it is neither, or empty.
    """
    if isinstance(given, Mapping):
        words = {instance(f"names of {argument}", name, str): each for name, each in given.items()}
        found = [(name, repr(name), each) for name, each in words.items()]
    else:
        found = [(str(index), str(index), each) for index, each in enumerate(sequence(argument, rule, given))]
    if not found:
        raise InvalidParameterError(argument, "hold at least one", Shown("none"))
    return found


def checked_seeds(seeds: Seeds) -> list[int]:
    """Return the seeds as a list of integers, at least one.

    Parameters
    ----------
    seeds : int or iterable of int
        The seeds, or their number.

    Returns
    -------
    list of int
        The seeds.

    Raises
    ------
    InvalidParameterError
        If there is none, there are too many, or one is not an integer from 0 to 2**64 - 1.
    """
    if isinstance(seeds, (int, np.integer)):
        return list(range(count("seeds", seeds, most=MOST_SEEDS)))
    rule = "be a positive integer or hold integers from 0 to 2**64 - 1"
    # A range may be longer than memory.
    given = sequence("seeds", rule, itertools.islice(seeds, MOST_SEEDS + 1) if isinstance(seeds, range) else seeds)
    if len(given) > MOST_SEEDS:
        raise InvalidParameterError("seeds", f"hold at most {MOST_SEEDS} seeds", Shown("more"))
    checked = [checked_seed(f"seeds[{index}]", seed) for index, seed in enumerate(given)]
    if not checked:
        raise InvalidParameterError("seeds", "hold at least one seed", Shown("an empty list"))
    return checked


def sets_of(laws: Mapping[str, Law], gains: npt.ArrayLike | Mapping[str, npt.ArrayLike] | None) -> list[Array]:
    """Return the gain sets of each law.

    Parameters
    ----------
    laws : mapping of str to Law
        The laws by name.
    gains : array_like, mapping, or None
        As for `simulate_many`.

    Returns
    -------
    list of ndarray
        A row for each gain set, a column for each gain.

    Raises
    ------
    InvalidParameterError
        If gains are given and the laws differ in their names.
    """
    kinds = {law.GAIN_NAMES: name for name, law in laws.items()}
    if gains is not None and len(kinds) > 1:
        (one, first), (other, second) = list(kinds.items())[:2]
        found = f'{", ".join(one)} of "{first}" and {", ".join(other)} of "{second}"'
        remedy = "run the laws one by one, or give laws with other gains"
        raise InvalidParameterError("gains", "be None for laws with gains of different names", Shown(found), remedy)
    return [gain_sets(law, gains) for law in laws.values()]
