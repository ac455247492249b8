"""``hrsafety validate FILE...``: whether files are what their commands read, without running anything."""

from __future__ import annotations

import argparse
import sys

from hrsafety.cli import exit_codes, output
from hrsafety.cli.file_kinds import Warnings, kind_of
from hrsafety.cli.terminal import styled
from hrsafety.errors import HrsafetyError

__all__ = ["validate_files"]


def validate_files(options: argparse.Namespace) -> None:
    """Check files, each whatever became of those before it.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety validate``.

    Raises
    ------
    SystemExit
        With code 2 if a file is invalid.
    """
    found: list[Warnings] = []
    for path in options.files:
        try:
            with output.located(path):
                found.append(_checked(path))
        except HrsafetyError as error:
            line = f"hrsafety: error: {' '.join(str(error).split())}"
            print(styled(line, "red", sys.stderr), file=sys.stderr, flush=True)
    output.report_warnings((each for of_file in found for each in of_file), strict=False)
    if len(found) < len(options.files):
        raise SystemExit(exit_codes.ERROR)
    output.leave_if_strict((each for of_file in found for each in of_file), options.strict)


def _checked(path: str) -> Warnings:
    """Check one file, and say what it is."""
    kind = kind_of(path)
    warnings = kind.check(path)
    count = len(warnings)
    words = f"{count} warning{'s' if count > 1 else ''}" if count else "valid"
    later = f"; {kind.later}: checked by hrsafety {kind.command}" if kind.later else ""
    print(f"{path}: {kind.title} file, {words}{later}", flush=True)
    return warnings
