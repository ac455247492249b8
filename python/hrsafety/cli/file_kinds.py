"""The files that commands read: how one is recognized and checked, and a file of each kind to start from."""

from __future__ import annotations

from collections.abc import Callable
from importlib import resources
from pathlib import Path

from hrsafety import arms, contact, program, scenarios
from hrsafety._arguments import meant
from hrsafety._keys import parsed
from hrsafety._records import dataclass
from hrsafety.cli import output
from hrsafety.cli.foam import file as foam_file
from hrsafety.cli.optimize import file as optimize_file
from hrsafety.cli.parsers import STARTERS
from hrsafety.cli.sweep import file as sweep_file
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.warnings import runs as run_warnings
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep.chunks import planned

__all__ = ["KINDS", "FileKind", "kind_of", "starter"]

Warnings = tuple[ResultWarning, ...]


@dataclass(frozen=True, slots=True)
class FileKind:
    """A kind of file.

    Attributes
    ----------
    title : str
        What it is called.
    command : str
        Command that reads it.
    telling : tuple of str
        Keys at the top of the file that no kind before it in the list has.
    check : callable
        Reads a file and returns its warnings.
    later : str
        What is checked only when the command runs; empty if nothing is.
    """

    title: str
    command: str
    telling: tuple[str, ...]
    check: Callable[[str], Warnings]
    later: str = ""


def _scenario(path: str) -> Warnings:
    scenario, law = scenarios.load(path)
    return tuple(dict.fromkeys((*scenario.warnings, *run_warnings.of_run(scenario, law))))


def _world(path: str) -> Warnings:
    return scenarios.load_world(path).warnings


def _foam(path: str) -> Warnings:
    foam_file.load(path)
    return ()


def _gains(path: str) -> Warnings:
    return output.warnings_of(*optimize_file.load(path).scenarios)


def _sweep(path: str) -> Warnings:
    found = sweep_file.load(path)
    return planned(found.design, found.study, chunk_rows=found.chunk_rows, least_chunks=0, threads=None).doubts()


def _cell(path: str) -> Warnings:
    return output.warnings_of(contact.load_cell(path).robot)


def _program(path: str) -> Warnings:
    found = program.load_program(path)
    return output.warnings_of(found.motion, found.motion.arm)


def _arm(path: str) -> Warnings:
    return output.warnings_of(arms.Arm.from_urdf(Path(path)))


KINDS = {
    "program": FileKind("robot program", "program", ("motion", "moves"), _program, "verdict of the contacts"),
    "contact": FileKind("contact cell", "contact", ("contacts", "coverings"), _cell, "plausibility of the contacts"),
    "sweep": FileKind("sweep", "sweep", ("axes", "design"), _sweep),
    "foam": FileKind("foam design", "foam", ("foams", "closing_speed"), _foam, "plausibility of the foams"),
    "gains": FileKind("gain study", "optimize", ("scenarios", "search"), _gains, "ranges of the search"),
    "world": FileKind("world", "ros", ("people", "sources", "map"), _world),
    "scenario": FileKind("scenario", "simulate", ("start", "goal", "obstacles"), _scenario),
}
"""Kinds by name, in the order in which they are recognized; ``hrsafety init`` has a file to start from of each."""

ARM = FileKind("arm", "arm", (), _arm)


def kind_of(path: str) -> FileKind:
    """Return the kind of a file, from its ending or its keys.

    Raises
    ------
    InvalidParameterError
        If no command reads such a file.
    """
    if Path(path).suffix.lower() == ".urdf":
        return ARM
    keys = parsed(Path(path))
    for kind in KINDS.values():
        if any(key in keys for key in kind.telling):
            return kind
    known = [key for kind in KINDS.values() for key in kind.telling]
    near = next((hint for hint in (meant(key, known) for key in keys) if hint), None)
    rule = f"have one of the keys {', '.join(known)}"
    raise InvalidParameterError(path, rule, Shown(", ".join(list(keys)[:5]) or "an empty file"), near)


def starter(word: str, path: str) -> str:
    """Return the text of a commented file to start from, which names itself by the path it is written to."""
    name = STARTERS[word]
    text = (resources.files("hrsafety.cli") / "data" / name).read_text(encoding="utf-8")
    return text.replace(f"examples/{name}", path)
