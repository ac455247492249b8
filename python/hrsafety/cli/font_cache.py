"""A matplotlib cache of the commands: neither a stale list of fonts nor a private style gets into pictures."""

from __future__ import annotations

import importlib.metadata
import os
import sys
from pathlib import Path

__all__ = ["VARIABLE", "keep_apart"]

VARIABLE = "MPLCONFIGDIR"
"""Where matplotlib keeps its list of fonts and looks for settings."""


def keep_apart() -> None:
    """Give matplotlib a folder of its own in the user's cache, one for each version of it.

    Nothing happens if the user names a folder, matplotlib is loaded already or not installed, or
    the cache cannot be written; matplotlib then helps itself.
    """
    if os.environ.get(VARIABLE) or "matplotlib" in sys.modules:
        return
    try:
        version = importlib.metadata.version("matplotlib")
        folder = _caches() / "hrsafety" / f"matplotlib-{version}"
        folder.mkdir(parents=True, exist_ok=True)
    except (importlib.metadata.PackageNotFoundError, OSError, RuntimeError):
        return
    if os.access(folder, os.W_OK):
        os.environ[VARIABLE] = str(folder)


def _caches() -> Path:
    """Return the folder in which this system keeps the caches of its users."""
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
