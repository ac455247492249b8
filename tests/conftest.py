"""Settings that all tests share."""

from __future__ import annotations

import atexit
import gc
import os
import shutil
import tempfile
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings
from hypothesis.internal.conjecture import providers

# Pictures are drawn without a display, here and in every process that a test starts.
os.environ["MPLBACKEND"] = "Agg"
# Functions of peers are called a few times each: compiling them takes longer than they do.
os.environ["NUMBA_DISABLE_JIT"] = "1"
# The list of fonts in the home folder may be stale, and its settings are not those of the tests.
_MATPLOTLIB = tempfile.mkdtemp(prefix="hrsafety-matplotlib-")
os.environ["MPLCONFIGDIR"] = _MATPLOTLIB
atexit.register(shutil.rmtree, _MATPLOTLIB, ignore_errors=True)

# The same examples on every machine and in every run; a slow machine is not a failure.
settings.register_profile("repeatable", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("repeatable")
# Constants of whatever modules are loaded by then would be tried, too: examples would depend on the tests before.
if hasattr(providers, "_get_local_constants"):
    providers._get_local_constants = lambda: providers._local_constants

TESTS = Path(__file__).resolve().parent
REPOSITORY = TESTS.parent

# Files that take more than 4 s of one core; ``--fast`` leaves them out.
SLOW = {
    "api/cli": {
        "test_cli.py",
        "test_cli_contact.py",
        "test_cli_contact_verdicts.py",
        "test_cli_foam.py",
        "test_cli_optimize.py",
        "test_cli_program.py",
        "test_cli_spoiled_files.py",
        "test_cli_sweep.py",
        "test_cli_terminal.py",
        "test_cli_zones.py",
    },
    "api/contact": {"test_spoiled_files.py"},
    "api/gym": {"test_acceptance.py", "test_environments.py"},
    "api/io": {"test_people.py"},
    "api/live": {"test_live.py"},
    "api/navigation": {
        "test_contacts_between.py",
        "test_crowd_walls.py",
        "test_footprint_robots.py",
        "test_gain_interrupt.py",
        "test_gain_search.py",
        "test_hidden_people.py",
        "test_law_runs.py",
        "test_moving_rectangles.py",
        "test_region_adversary.py",
        "test_rollouts_as_law.py",
    },
    "api/package": {
        "test_declared.py",
        "test_fork.py",
        "test_fuzz.py",
        "test_interrupt.py",
        "test_structure.py",
        "test_subpackages.py",
        "test_warnings_travel.py",
    },
    "api/pages": {"test_reactive_follower_page.py", "test_report.py"},
    "api/plotting": {"test_animation.py", "test_degenerate_pictures.py", "test_pictures.py", "test_plotting.py"},
    "api/reactive": {"test_reactive_follower.py", "test_reactive_sound_interrupt.py"},
    "api/reproduce": {"test_reproduce.py", "test_reproduce_rows.py"},
    "api/ros": {"test_bridge.py"},
    "api/scenarios": {"test_arena.py", "test_doubtful_recordings.py"},
    "api/sweep": {"test_sweep_pools.py", "test_sweep_resume.py", "test_sweep_shares.py"},
    "api/zones": {"test_zones_that_hold.py"},
    "docs": {"test_documents.py", "test_gains_guide.py", "test_images.py", "test_notebooks.py"},
    "golden": {"test_gain_tables.py", "test_impact_exact.py", "test_impact_tables.py", "test_reciprocal.py"},
    "properties": {
        "test_compared_laws.py",
        "test_identification.py",
        "test_lyapunov.py",
        "test_pursued_robot.py",
        "test_tracking_convergence.py",
    },
}
_GONE = [f"{part}/{name}" for part, names in SLOW.items() for name in names if not (TESTS / part / name).is_file()]
if _GONE:
    raise pytest.UsageError(f"SLOW of tests/conftest.py names no files: {', '.join(_GONE)}")


def pytest_configure(config: pytest.Config) -> None:
    """Let results be made of implausible numbers: what tests ask of them is that they carry doubts.

    That the doubts are issued, too, is asked with ``pytest.warns``.
    """
    config.addinivalue_line("filterwarnings", "ignore::hrsafety.plausibility.UnitWarning")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option of the quick run."""
    parser.addoption("--fast", action="store_true", help="leave out the files that take more than 4 s")


def is_slow(path: Path) -> bool:
    """Return whether a file is a slow one; tests that a test makes in a folder of its own are none of ours."""
    part = path.parent.relative_to(TESTS).as_posix() if path.is_relative_to(TESTS) else ""
    return path.name in SLOW.get(part, ())


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave a slow file out of the quick run."""
    return True if is_slow(collection_path) and config.getoption("--fast") else None


def pytest_sessionstart() -> None:
    """Search for no garbage while tests are collected: all of it stays."""
    gc.disable()


def pytest_collection_finish() -> None:
    """Leave what was collected out of every later search for garbage."""
    gc.collect()
    gc.freeze()
    gc.enable()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the slow files, so that no core waits for one that another core began at last."""
    items.sort(key=lambda item: not is_slow(item.path))


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
