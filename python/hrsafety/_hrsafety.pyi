"""Native core of hrsafety; private, with `hrsafety.navigation` as its face.

The callers convert once and give every argument, in SI units and radians. A value out of range
raises `hrsafety.errors.InvalidParameterError`. Words are plain strings here: the core refuses an
unknown one and quotes its rule.
"""

from collections.abc import Callable, Sequence
from typing import Literal, Self, TypedDict, final

import numpy as np
import numpy.typing as npt

__all__ = [
    "DifferentialDriveRobot",
    "HolonomicRobot",
    "Measurement",
    "Obstacle",
    "Scenario",
    "VirtualForceField",
    "evaluate",
    "force_field",
    "force_terms",
    "lyapunov",
    "region_radii",
    "simulate",
    "simulate_batch",
]

_Pair = tuple[float, float]
_Triple = tuple[float, float, float]
_Segment = tuple[float, _Pair, _Pair]
_Array = npt.NDArray[np.float64]
_Counts = npt.NDArray[np.int64]
_Words = npt.NDArray[np.str_]
_Outcome = Literal["arrived", "collided", "timed_out", "stopped"]

class _TrajectoryFields(TypedDict):
    time: _Array
    position: _Array
    velocity: _Array
    force: _Array
    stabilizing: _Array
    lyapunov: _Array
    heading: _Array
    wheel_current: _Array
    obstacle_position: _Array
    distance: _Array
    outcome: _Outcome
    arrival_time: float
    energy: float
    path_length: float
    min_clearance: _Array
    contact_time: _Array
    contact_speed: _Array
    min_distance: _Array

class _ScoreFields(TypedDict):
    total: float
    arrival_time: float
    avoidance: float
    energy_saving: float

class _ForceTermsFields(TypedDict):
    attractive: _Array
    repulsive: _Array
    detour: _Array
    stabilizing: _Array
    total: _Array
    region: _Words
    side: _Counts
    omega: float

class _ForceFieldFields(TypedDict):
    attractive: _Array
    repulsive: _Array
    detour: _Array
    stabilizing: _Array
    total: _Array
    potential: _Array

class _BatchFields(TypedDict):
    gain_index: _Counts
    scenario_index: _Counts
    gains: _Array
    outcome: _Words
    end_time: _Array
    arrival_time: _Array
    energy: _Array
    path_length: _Array
    min_distance: _Array
    min_clearance: _Array
    entered_active: _Counts
    contacts_moving: _Counts
    contacts_standing: _Counts
    performance_total: _Array
    performance_arrival_time: _Array
    performance_avoidance: _Array
    performance_energy_saving: _Array
    descent_share: _Array
    force_evaluations: _Counts

@final
class HolonomicRobot:
    """Holonomic robot."""

    def __new__(
        cls,
        *,
        mass: float,
        radius: float,
        max_speed: float,
        max_acceleration: float,
        wheel_radius: float,
        winding_resistance: float,
        wheel_inertia: _Triple,
        wheel_viscous_friction: _Triple,
        wheel_static_friction: _Triple,
    ) -> Self: ...

@final
class DifferentialDriveRobot:
    """Differential-drive robot."""

    def __new__(
        cls,
        *,
        mass: float,
        radius: float,
        max_speed: float,
        max_acceleration: float,
        max_angular_acceleration: float,
    ) -> Self: ...

@final
class Obstacle:
    """Obstacle."""

    @staticmethod
    def disc(
        *,
        center: _Pair,
        radius: float,
        active_radius: float | None,
        critical_radius: float | None,
        max_speed: float | None,
    ) -> Obstacle:
        """Return a disc at rest."""

    @staticmethod
    def rectangle(
        *,
        center: _Pair,
        length: float,
        width: float,
        heading: float,
        active_radius: float | None,
        critical_radius: float | None,
        max_speed: float | None,
    ) -> Obstacle:
        """Return a rectangle at rest."""

    @staticmethod
    def moving(
        *,
        start: _Pair,
        velocity: _Pair,
        acceleration: _Pair,
        stop: _Pair | None,
        radius: float,
        active_radius: float | None,
        critical_radius: float | None,
        max_speed: float | None,
    ) -> Obstacle:
        """Return a disc with constant acceleration or a sudden stop."""

    @staticmethod
    def piecewise(
        *,
        start: _Pair,
        segments: Sequence[_Segment],
        radius: float,
        active_radius: float | None,
        critical_radius: float | None,
        max_speed: float | None,
    ) -> Obstacle:
        """Return a disc with piecewise constant acceleration."""

    @staticmethod
    def recorded(
        *,
        time: Sequence[float],
        position: Sequence[_Pair],
        radius: float,
        active_radius: float | None,
        critical_radius: float | None,
        max_speed: float | None,
    ) -> Obstacle:
        """Return a disc that follows a recording."""

@final
class Measurement:
    """Measurement error."""

    def __new__(cls, *, scale: float, distribution: str, of: str) -> Self: ...

@final
class Scenario:
    """Scenario."""

    def __new__(
        cls,
        *,
        robot: HolonomicRobot,
        start: _Pair,
        goal: _Pair,
        obstacles: Sequence[Obstacle],
        control_period: float,
        time_limit: float,
        arrival_tolerance: float,
        heading: float,
        rest_time: float,
        measurement: Measurement | None,
        seed: int,
    ) -> Self: ...

@final
class VirtualForceField:
    """Law."""

    def __new__(
        cls,
        *,
        gains: tuple[float, float, float, float],
        stabilizing: str,
        stabilizing_force_cap: float | None,
        stabilizing_momentum_cap: float | None,
        pass_behind: bool,
        side_hysteresis: float,
    ) -> Self: ...

def region_radii(
    robot: HolonomicRobot | DifferentialDriveRobot,
    obstacle: Obstacle,
    control_period: float,
    faced_side: float | None,
) -> tuple[float, float]:
    """Return critical and active radius of an obstacle for a robot."""

def simulate(
    scenario: Scenario,
    law: VirtualForceField,
    integrator: str,
    step: float,
    hold: bool,
    stop_on_contact: bool,
) -> _TrajectoryFields:
    """Run once and return the fields of a trajectory."""

def evaluate(
    scenario: Scenario,
    law: VirtualForceField,
    weights: _Triple,
    integrator: str,
    step: float,
    hold: bool,
) -> tuple[_ScoreFields, _TrajectoryFields, _TrajectoryFields]:
    """Return the parts of the score of a run, the run and the nominal run."""

def force_terms(
    law: VirtualForceField,
    scenario: Scenario,
    position: _Pair,
    velocity: _Pair,
    time: float,
) -> _ForceTermsFields:
    """Return every force term at one state."""

def force_field(
    law: VirtualForceField,
    scenario: Scenario,
    position: _Array,
    velocity: _Array,
    time: float,
) -> _ForceFieldFields:
    """Return forces and Lyapunov function at many states."""

def lyapunov(
    law: VirtualForceField,
    scenario: Scenario,
    position: _Pair,
    velocity: _Pair,
    time: float,
) -> tuple[float, float, float]:
    """Return the Lyapunov function, its derivative and Omega at one state."""

def simulate_batch(
    scenarios: Sequence[Scenario],
    law: VirtualForceField,
    gains: _Array,
    weights: _Triple,
    *,
    integrator: str,
    step: float,
    hold: bool,
    stop_on_contact: bool,
    descent: bool,
    threads: int | None,
    lanes: int | None,
    progress: Callable[[int, int], object] | None,
) -> _BatchFields:
    """Return summary columns of every gain set in every scenario."""
