"""Numbers, pictures and evidence for robots that work near people.

`navigation` simulates mobile robots under virtual force fields among people and things and
scores how well and how safely they reach their goal. `impact` gives the loads of a foam-covered
manipulator that hits a head, and designs the foam; `reactive` follows a sound and avoids what
ultrasonic sensors see. `arms` reads arms from URDF and gives the masses of their points, `standards` holds
limits of contact and separation distances, `records` judges measured contacts, `program` finds how fast a robot
program may be beside people. `io` reads and writes the files of
others,
`zones` designs and attacks the zones of a collision monitor, `ros` puts people around a robot of ROS 2. Sub-modules
load on first use, so importing the package costs little more than importing numpy.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from hrsafety.errors import (
    HrsafetyError,
    InvalidParameterError,
    ShapeError,
    SimulationError,
)

if TYPE_CHECKING:
    from types import ModuleType

    from hrsafety import (
        arena,
        arms,
        benchmarks,
        cli,
        contact,
        datasets,
        gym,
        impact,
        io,
        live,
        navigation,
        pages,
        plausibility,
        plotting,
        program,
        reactive,
        records,
        reproduce,
        ros,
        scenarios,
        standards,
        sweep,
        zones,
    )

__all__ = [
    "HrsafetyError",
    "InvalidParameterError",
    "ShapeError",
    "SimulationError",
    "__version__",
    "arena",
    "arms",
    "benchmarks",
    "cli",
    "contact",
    "datasets",
    "gym",
    "impact",
    "io",
    "live",
    "navigation",
    "pages",
    "plausibility",
    "plotting",
    "program",
    "reactive",
    "records",
    "reproduce",
    "ros",
    "scenarios",
    "standards",
    "sweep",
    "zones",
]

__version__ = "0.1.0"

# The sub-modules, which alone are named in small letters.
_LAZY = frozenset(name for name in __all__ if name.islower() and name != "__version__")


def __getattr__(name: str) -> ModuleType:
    """Import a sub-module the first time it is asked for."""
    if name in _LAZY:
        return importlib.import_module(f"hrsafety.{name}")
    raise AttributeError(f"module 'hrsafety' has no attribute {name!r}")


def __dir__() -> list[str]:
    """List the public names, loaded or not."""
    return sorted(__all__)
