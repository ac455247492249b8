"""Exit codes of the commands, in one place."""

from __future__ import annotations

__all__ = ["CLOSED_PIPE", "DONE", "ERROR", "FAILED_RUN", "INTERRUPTED", "MEANINGS", "WARNED"]

DONE = 0
CLOSED_PIPE = 1
ERROR = 2
FAILED_RUN = 3
WARNED = 4
INTERRUPTED = 130

MEANINGS = {
    DONE: "done, whatever the outcome of the runs",
    CLOSED_PIPE: "the reader of the output closed it early",
    ERROR: "an error: one line on stderr says which, nothing was left half written",
    FAILED_RUN: "a run ended as --fail-on names, or no gain set keeps the constraints; everything was written",
    WARNED: "warnings and --strict was given, or doubts about runs that --fail-on judges; everything was written",
    INTERRUPTED: "stopped by Ctrl-C",
}
"""What each code means, as ``hrsafety --help`` prints it."""
