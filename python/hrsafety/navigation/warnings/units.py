"""Doubts about units of the scenarios that a function is called with."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Mapping

from hrsafety.plausibility import ResultWarning

__all__ = ["of_scenarios"]

MOST_SCENES = 100
"""So many scenarios or worlds are examined when runs end; the warnings of a table look at all."""


def of_scenarios(*positional: object, **named: object) -> Iterator[ResultWarning]:
    """Yield doubts about units of the first scenarios of a call, which may be one, a sequence or a mapping.

    Parameters
    ----------
    *positional, **named
        Arguments of the call: scenarios are the first one, or named ``scenario`` or ``scenarios``.
    """
    scenarios = positional[0] if positional else named.get("scenario", named.get("scenarios"))
    given: Iterable[object] = ()
    if hasattr(scenarios, "unit_doubts"):
        given = (scenarios,)
    elif isinstance(scenarios, Mapping):
        given = scenarios.values()
    elif isinstance(scenarios, Iterable) and not isinstance(scenarios, Iterator):
        given = scenarios
    for each in itertools.islice(given, MOST_SCENES):
        yield from getattr(each, "unit_doubts", ())
