"""All laws by name. Modules are loaded when they are needed; here every law is loaded."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from hrsafety.navigation.laws import force_laws, impedance, local_planners, planners
from hrsafety.navigation.laws.declared import DECLARED, Law

__all__ = ["LAWS"]

_MODULES = [module.__name__ for module in (force_laws, impedance, planners, local_planners)]

LAWS: Mapping[str, type[Law]] = MappingProxyType(
    {law.NAME: law for module in _MODULES for law in DECLARED.values() if law.__module__ == module}
)
"""In the order of their declarations, whichever was loaded first."""
