"""``hrsafety info``: what is installed, what is missing, and what the machine offers."""

from __future__ import annotations

import argparse
import importlib.metadata
import os
import platform
import re
from collections.abc import Iterator
from pathlib import Path

import hrsafety
from hrsafety._words import some
from hrsafety.cli import terminal
from hrsafety.pages.report import Report, ReportTable, Section

__all__ = ["print_info"]

_REQUIREMENT = re.compile(r"^([A-Za-z0-9._-]+)(?:\[[^]]*\])?\s*([^;]*)(?:;\s*(.*))?$")
_OF_EXTRA = re.compile(r"extra\s*==\s*['\"]([^'\"]+)['\"]")
# Extras of those who work on the package itself.
_OWN = frozenset({"test", "dev", "docs", "all"})


def print_info(_options: argparse.Namespace) -> None:
    """Print versions, machine and optional extras with what each of them still needs.

    Parameters
    ----------
    _options : argparse.Namespace
        Of ``hrsafety info``, which has none.
    """
    rows = [(extra, ", ".join(has) or "-", ", ".join(lacks) or "-", _command(lacks)) for extra, has, lacks in _extras()]
    table = ReportTable(
        headers=[("extra", "installed", "missing", "to install")], rows=rows, left=(0, 1, 2, 3), printed=True
    )
    print(terminal.told(Report(title="hrsafety", facts=list(_facts()), sections=[Section("Extras", [table])])))


def _facts() -> Iterator[tuple[str, str]]:
    numpy = importlib.metadata.version("numpy")
    yield "hrsafety", f"{hrsafety.__version__} in {Path(hrsafety.__file__).parent}"
    yield "python", f"{platform.python_version()}, numpy {numpy}"
    yield "machine", f"{platform.system()} {platform.machine()}, {some(_cores(), 'core')} for this process"


def _cores() -> int:
    """Return the cores that this process may use, which are fewer than the machine has in many containers."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _command(lacks: list[str]) -> str:
    return f"pip install {' '.join(lacks)}" if lacks else "-"


def _extras() -> Iterator[tuple[str, list[str], list[str]]]:
    """Yield each extra with the packages that are there, and those that are missing."""
    packages: dict[str, list[str]] = {}
    for line in importlib.metadata.requires("hrsafety") or ():
        parts = _REQUIREMENT.match(line)
        extra = _OF_EXTRA.search(line)
        if parts and extra and extra[1] not in _OWN:
            packages.setdefault(extra[1], []).append(parts[1])
    for name, needed in packages.items():
        versions = {package: _version(package) for package in needed}
        has = [f"{package} {version}" for package, version in versions.items() if version]
        yield name, has, [package for package, version in versions.items() if not version]


def _version(name: str) -> str | None:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None
