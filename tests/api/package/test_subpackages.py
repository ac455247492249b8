"""Every sub-package is reachable from the package, without an import of its own."""

from __future__ import annotations

import pkgutil
import subprocess
import sys

import pytest

import hrsafety

MODULES = [module for module in pkgutil.iter_modules(hrsafety.__path__) if not module.name.startswith("_")]
NAMES = sorted(module.name for module in MODULES if module.ispkg)


@pytest.mark.parametrize("name", NAMES)
def test_sub_package_is_reachable(name: str) -> None:
    code = f"import hrsafety; assert hrsafety.{name}.__name__ == 'hrsafety.{name}'"
    subprocess.run([sys.executable, "-c", code], check=True)
    assert name in hrsafety.__all__
    assert name in dir(hrsafety)
    assert name in hrsafety._LAZY
