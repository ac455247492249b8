"""Settings that all tests share."""

from __future__ import annotations

import atexit
import os
import shutil
import tempfile
from pathlib import Path

import pytest
from hypothesis import settings

# Pictures are drawn without a display, here and in every process that a test starts.
os.environ["MPLBACKEND"] = "Agg"
# The list of fonts in the home folder may be stale, and its settings are not those of the tests.
_MATPLOTLIB = tempfile.mkdtemp(prefix="hrsafety-matplotlib-")
os.environ["MPLCONFIGDIR"] = _MATPLOTLIB
atexit.register(shutil.rmtree, _MATPLOTLIB, ignore_errors=True)

# The same examples on every machine and in every run; a slow machine is not a failure.
settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")

REPOSITORY = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="session")
def repository() -> Path:
    """Return the root of the source tree."""
    return REPOSITORY


@pytest.fixture(scope="session")
def shared() -> Path:
    """Return the folder with recorded data, or skip the test without it."""
    folder = Path(os.environ.get("HRSAFETY_SHARED", REPOSITORY.parent / "shared"))
    if not (folder / "data").is_dir():
        pytest.skip("recorded data not found; HRSAFETY_SHARED names its folder")
    return folder
