"""How runs ended: plainly on the last line, and as exit code where ``--fail-on`` asks for one."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from hrsafety import navigation as nav
from hrsafety._arguments import meant
from hrsafety.cli import output, terminal
from hrsafety.cli.exit_codes import DONE, FAILED_RUN, NOT_CHECKED
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.outcomes import OUTCOMES
from hrsafety.plausibility import ResultWarning, unsafe_doubts

if TYPE_CHECKING:
    from hrsafety.navigation.tables.runs import RunTable

__all__ = ["FAILURES", "LOOKS", "OF_VERDICTS", "counted", "end", "failures_of", "leave", "sentence"]

Counts = Mapping[str, int]

# Ends of a run that are neither an arrival nor a contact.
_SHORT_OF_GOAL = tuple(word for word in OUTCOMES if word not in {"arrived", "collided"})
FAILURES = ("contact", "moving_contact", *_SHORT_OF_GOAL, "not_arrived", "any")
"""Words of ``--fail-on``; the help says what each means."""
LOOKS = MappingProxyType({"FAILED": "bold red", "NOT CHECKED": "bold yellow", "NOTE": "yellow", "passed": "green"})
"""First words of the last line and their looks on a terminal."""
OF_VERDICTS = MappingProxyType(
    {
        "not_permitted": ("FAILED", FAILED_RUN),
        "exceeds": ("FAILED", FAILED_RUN),
        "not_checked": ("NOT CHECKED", NOT_CHECKED),
        "within_limits": ("passed", DONE),
    }
)
"""First word of the last line and exit code of each verdict on limits."""
_SUMMED = ("moving_contact", "not_arrived", "any")
_OTHER_WORDS = {"collided": "contact", "collision": "contact", "timeout": "timed_out"}


def failures_of(text: str | None, words: Sequence[str] = FAILURES) -> tuple[str, ...]:
    """Return the words of ``--fail-on``, each checked.

    Parameters
    ----------
    text : str or None
        Words between commas, as given.
    words : sequence of str
        Those of the command.

    Returns
    -------
    tuple of str
        Among the words; empty without the option.

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
        if word not in words:
            near = meant(plain, [*words, *(_OTHER_WORDS if words is FAILURES else ())])
            raise InvalidParameterError("--fail-on", f"be among {', '.join(words)}, with commas", given, near)
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


def sentence(said: str, counts: Counts, fail_on: Sequence[str], runs: int, doubts: Sequence[ResultWarning] = ()) -> str:
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
    doubts : sequence of ResultWarning
        Those whose error may lie on the unsafe side: with any of them nothing is passed.
    """
    named = [word for word in fail_on if counts[word]]
    if named:
        shares = ", ".join(word if runs == 1 else f"{word} in {counts[word]} of {runs} runs" for word in named)
        return f"FAILED  {said}; --fail-on {shares}: exit code {FAILED_RUN}"
    if doubts and (fail_on or not counts["any"]):
        codes = ", ".join(dict.fromkeys(doubt.code for doubt in doubts))
        code = f"exit code {NOT_CHECKED}" if fail_on else f"exit code 0 all the same, --fail-on makes it {NOT_CHECKED}"
        return f"NOT CHECKED  {said}, but with doubts that may lie on the unsafe side ({codes}); {code}"
    if not counts["any"]:
        return f"passed  {said}"
    happened = ",".join(word for word in counts if word not in _SUMMED and counts[word])
    note = "--fail-on does not name it" if fail_on else f"--fail-on {happened} makes it {FAILED_RUN}"
    return f"NOTE    {said}; exit code 0 all the same, {note}"


def end(
    said: str,
    counts: Counts,
    found: Sequence[ResultWarning],
    options: argparse.Namespace,
    runs: int,
    words: Sequence[str] = FAILURES,
) -> None:
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
    words : sequence of str
        Words of ``--fail-on`` of the command.

    Raises
    ------
    SystemExit
        With code 3 if a failure that ``--fail-on`` names happened, else with code 5 if ``--fail-on`` is given and a
        doubt may lie on the unsafe side, else with code 4 if there are warnings and ``--strict`` is given.
    """
    fail_on = failures_of(options.fail_on, words)
    output.report_warnings(found, strict=False)
    print()
    doubts = unsafe_doubts(found)
    last = sentence(said, counts, fail_on, runs, doubts)
    look = next(look for word, look in LOOKS.items() if last.startswith(word))
    print(terminal.styled(last, look, sys.stdout))
    if any(counts[word] for word in fail_on):
        raise SystemExit(FAILED_RUN)
    if doubts and fail_on:
        raise SystemExit(NOT_CHECKED)
    output.leave_if_strict(found, options.strict)


def leave(word: str, said: str) -> None:
    """Print a verdict on limits as the last line, and leave with its code unless everything is within limits.

    Parameters
    ----------
    word : str
        Verdict, one of `hrsafety.standards.verdicts.VERDICTS`.
    said : str
        The same in a sentence.

    Raises
    ------
    SystemExit
        With code 3 if a limit is exceeded or a contact not permitted, with code 5 if one is not checked.
    """
    first, code = OF_VERDICTS[word]
    last = f"{first}  {said}" + ("" if code == DONE else f"; exit code {code}")
    print()
    print(terminal.styled(last, LOOKS[first], sys.stdout), flush=True)
    if code != DONE:
        raise SystemExit(code)
