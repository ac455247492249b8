"""The law of a study whose scenario files may have laws of their own: none is left out in silence."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

from hrsafety import navigation as nav
from hrsafety.cli.output import law_words
from hrsafety.errors import InvalidParameterError, Shown

__all__ = ["law_of_study"]

L = TypeVar("L", bound=nav.Law)
_TABLES = "[law] and [safe]"
_REMEDY = f"write the same {_TABLES} into all of them"


def law_of_study(
    own: L | None, of_files: Mapping[str, nav.Law | None], compared: Callable[[nav.Law], nav.Law] = lambda law: law
) -> L | nav.Law | None:
    """Return the law of a study: its own, or that of its scenario files.

    Parameters
    ----------
    own : Law or None
        The law of the study file; ``None`` if it has none.
    of_files : mapping of str to Law or None
        The laws of its scenario files by their names; ``None`` for a file without the tables of a law. Configurations
        of the source have no law and are not among them.
    compared : callable
        Returns what of a law has to agree.

    Returns
    -------
    Law or None
        ``None`` if neither the study nor a file has one.

    Raises
    ------
    InvalidParameterError
        If a file has another law than the study or than another file.
    """
    told = {name: law for name, law in of_files.items() if law is not None}
    if not told:
        return own
    name, law = next(iter(told.items()))
    if own is not None:
        for name, law in told.items():
            if compared(law) != compared(own):
                rule = f"be the law of the scenario file {name} ({law_words(law)}), which has one of its own"
                remedy = f"take {_TABLES} out of one of the two files, or write the same into both"
                raise InvalidParameterError("law", rule, Shown(law_words(own)), remedy)
        return own
    for other, given in of_files.items():
        there = nav.VirtualForceField() if given is None else given
        if compared(there) != compared(law):
            default = " by default, as it has no [law]" if given is None else ""
            rule = f"have one law: {name} has {law_words(law)}"
            remedy = f"{_REMEDY}, or take them out and write them into the study"
            raise InvalidParameterError("scenarios", rule, Shown(f"{other} with {law_words(there)}{default}"), remedy)
    return law
