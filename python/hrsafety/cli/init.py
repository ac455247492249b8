"""``hrsafety init``: a commented file to start from."""

from __future__ import annotations

import argparse

from hrsafety.cli import output
from hrsafety.cli.file_kinds import kind_of, starter
from hrsafety.cli.parsers import STARTERS
from hrsafety.errors import InvalidParameterError

__all__ = ["write_starter"]


def write_starter(options: argparse.Namespace) -> None:
    """Write a file to start from, never over another one, and say which command reads it.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety init``.
    """
    path = options.file or STARTERS[options.kind]
    place = output.target("FILE", path, (".toml",))
    if place.exists():
        raise InvalidParameterError("FILE", "not exist", path, "nothing is overwritten; give another name")
    print(f"wrote {output.write_text(place, starter(options.kind, path))}")
    shown = f'"{path}"' if " " in path else path
    print(f"next  hrsafety {kind_of(str(place)).command} {shown} --out {place.stem}")
