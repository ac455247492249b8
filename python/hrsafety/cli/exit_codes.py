"""Exit codes of the commands, in one place."""

from __future__ import annotations

__all__ = ["CLOSED_PIPE", "DONE", "ERROR", "FAILED_RUN", "INTERRUPTED", "MEANINGS", "NOT_CHECKED", "WARNED"]

DONE = 0
CLOSED_PIPE = 1
ERROR = 2
FAILED_RUN = 3
WARNED = 4
NOT_CHECKED = 5
INTERRUPTED = 130

MEANINGS = {
    DONE: "done, whatever the outcome of the runs",
    CLOSED_PIPE: "the reader of the output closed it early",
    ERROR: "an error: one line on stderr says which, nothing was left half written",
    FAILED_RUN: "a run ended as --fail-on names, no gain set keeps the constraints, or a contact exceeds its limits or "
    "is not permitted; everything was written",
    WARNED: "there were warnings and --strict was given; everything was written",
    NOT_CHECKED: "a doubt may lie on the unsafe side: a contact is not checked, or no run ended as --fail-on names, "
    "but one may have; everything was written",
    INTERRUPTED: "stopped by Ctrl-C",
}
"""Meaning of each code, as ``hrsafety --help`` prints it."""
