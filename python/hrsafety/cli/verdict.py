"""How runs ended: plainly on the last line, and as exit code 3 where ``--fail-on`` names it."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence

import numpy as np

from hrsafety import navigation as nav
from hrsafety._arguments import meant
from hrsafety.cli import output, terminal
from hrsafety.cli.exit_codes import FAILED_RUN, WARNED
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.outcomes import OUTCOMES
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.plausibility import ResultWarning, unsafe_doubts

__all__ = ["FAILURES", "counted", "end", "failures_of", "sentence"]

Counts = Mapping[str, int]

# Ends of a run that are neither an arrival nor a contact.
_SHORT_OF_GOAL = tuple(word for word in OUTCOMES if word not in {"arrived", "collided"})
FAILURES = ("contact", "moving_contact", *_SHORT_OF_GOAL, "not_arrived", "any")
"""Words of ``--fail-on``; the help says what each means."""
# First word of the last line and its look on a terminal.
_LOOKS = {"FAILED": "bold red", "passed": "green", "NOTE": "yellow"}
_OTHER_WORDS = {"collided": "contact", "collision": "contact", "timeout": "timed_out"}


def failures_of(text: str | None) -> tuple[str, ...]:
    """Return the words of ``--fail-on``, each checked.

    Parameters
    ----------
    text : str or None
        Words between commas, as given.

    Returns
    -------
    tuple of str
        Among `FAILURES`; empty without the option.

    Raises
    ------
    InvalidParameterError
        If a word is unknown or there is none.
    """
    if text is None:
        return ()
    found = []
    for given in text.split(","):
        plain = given.strip().lower().replace("-", "_")
        word = _OTHER_WORDS.get(plain, plain)
        if word not in FAILURES:
            near = meant(plain, [*FAILURES, *_OTHER_WORDS])
            raise InvalidParameterError("--fail-on", f"be among {', '.join(FAILURES)}, with commas", given, near)
        found.append(word)
    return tuple(dict.fromkeys(found))


def counted(runs: RunTable | nav.Trajectory) -> Counts:
    """Return in how many runs each failure happened."""
    outcome = np.asarray(runs.outcome)
    masks = {
        "contact": outcome == "collided",
        "moving_contact": np.asarray(runs.contacts_moving) > 0,
        **{word: outcome == word for word in _SHORT_OF_GOAL},
        "not_arrived": ~np.isfinite(runs.arrival_time),
        "any": outcome != "arrived",
    }
    return {word: int(np.sum(masks[word])) for word in FAILURES}


def sentence(said: str, counts: Counts, fail_on: Sequence[str], runs: int, doubts: int = 0) -> str:
    """Return the last line of a command: how the runs ended, and what the exit code makes of it.

    Parameters
    ----------
    said : str
        How they ended.
    counts : mapping of str to int
        Of `counted`.
    fail_on : sequence of str
        Of `failures_of`.
    runs : int
        How many there are.
    doubts : int
        Number of warnings whose error may lie on the unsafe side: with any of them nothing has passed.
    """
    named = [word for word in fail_on if counts[word]]
    if named:
        shares = ", ".join(word if runs == 1 else f"{word} in {counts[word]} of {runs} runs" for word in named)
        return f"FAILED  {said}; --fail-on {shares}: exit code {FAILED_RUN}"
    if not (counts["any"] or doubts):
        return f"passed  {said}"
    if doubts and (fail_on or not counts["any"]):
        told = "a warning says" if doubts == 1 else f"{doubts} warnings say"
        code = (
            f"exit code {WARNED}" if fail_on else f"exit code 0 all the same, --strict or --fail-on makes it {WARNED}"
        )
        return f"NOTE    not checked: {said}, and {told} why that may be wrong; {code}"
    happened = ",".join(word for word in ("contact", *_SHORT_OF_GOAL) if counts[word])
    note = "--fail-on does not name it" if fail_on else f"--fail-on {happened} makes it {FAILED_RUN}"
    return f"NOTE    {said}; exit code 0 all the same, {note}"


def end(said: str, counts: Counts, found: Sequence[ResultWarning], options: argparse.Namespace, runs: int) -> None:
    """Print warnings and the last line, and leave with the code that the options ask for.

    Parameters
    ----------
    said : str
        How the runs ended.
    counts : mapping of str to int
        Of `counted`.
    found : sequence of ResultWarning
        All warnings.
    options : argparse.Namespace
        Of ``hrsafety simulate``.
    runs : int
        How many there are.

    Raises
    ------
    SystemExit
        With code 3 if a failure that ``--fail-on`` names happened, else with code 4 if there are
        warnings and ``--strict`` is given, or warnings on the unsafe side and ``--fail-on`` is.
    """
    fail_on = failures_of(options.fail_on)
    doubts = len(unsafe_doubts(dict.fromkeys(found)))
    output.report_warnings(found, strict=False)
    print()
    last = sentence(said, counts, fail_on, runs, doubts)
    print(terminal.styled(last, _LOOKS[last.split()[0]], sys.stdout))
    if any(counts[word] for word in fail_on):
        raise SystemExit(FAILED_RUN)
    output.leave_if_strict(found, options.strict)
    if fail_on and doubts:
        raise SystemExit(WARNED)
