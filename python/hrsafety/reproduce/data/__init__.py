"""Data of the reproduction: printed numbers, names, tolerances, reasons, captions."""

from __future__ import annotations

import tomllib
from functools import cache
from importlib import resources
from typing import Any

__all__ = ["caption", "printed_text", "table"]


@cache
def table(name: str) -> dict[str, Any]:
    """Return a TOML file of this folder; do not change it."""
    return tomllib.loads(_read(f"{name}.toml"))


def caption(key: str, /, **words: object) -> str:
    """Return what a picture shows, with words filled in."""
    return str(table("captions")[key]).format_map(words)


@cache
def printed_text() -> str:
    """Return the printed numbers as JSON."""
    return _read("published.json")


def _read(file: str) -> str:
    return resources.files("hrsafety.reproduce.data").joinpath(file).read_text(encoding="utf-8")
