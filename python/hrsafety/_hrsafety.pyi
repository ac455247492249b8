"""Native core of hrsafety; private, with `hrsafety.navigation` and `hrsafety.impact` as its faces.

The callers convert once and give every argument, in SI units and radians. A value out of range
raises `hrsafety.errors.InvalidParameterError`. Words are plain strings here: the core refuses an
unknown one and quotes its rule.
"""

from collections.abc import Callable, Sequence
from typing import Any, Literal, Self, TypedDict, final

import numpy as np
import numpy.typing as npt

__all__ = [
    "ConstrainedHead",
    "CylinderController",
    "DifferentialDriveRobot",
    "DirectDrive",
    "Foam",
    "GainProblem",
    "Head",
    "HolonomicRobot",
    "Joint",
    "Law",
    "Manipulator",
    "Measurement",
    "Obstacle",
    "Scenario",
    "SetPoint",
    "contiguous_level",
    "drop_trajectory",
    "effective_one_joint",
    "effective_two_joints",
    "evaluate",
    "fit_open_loop",
    "fit_static",
    "foam_boundary",
    "foam_fastest",
    "foam_ratios",
    "force_field",
    "force_terms",
    "front_hypervolume",
    "gain_front",
    "hic",
    "hic_half_sine",
    "hic_square",
    "hic_triangle",
    "identify_direct_drive",
    "identify_foam",
    "impact_gradient_names",
    "impact_gradients",
    "impact_metrics",
    "impact_metrics_batch",
    "impact_point_speed",
    "impact_simulate",
    "impact_status_words",
    "law_command",
    "lyapunov",
    "moving_average",
    "pd_gains",
    "recorded_metrics",
    "region_radii",
    "search_gains",
    "search_gains_globally",
    "simulate",
    "simulate_batch",
    "simulate_direct_drive",
    "stopping_segments",
    "tube_inertia",
    "uniform_links",
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
class Law:
    """A law of any kind."""

    @staticmethod
    def virtual_force_field(
        *,
        gains: tuple[float, ...],
        stabilizing: str,
        stabilizing_force_cap: float | None,
        stabilizing_momentum_cap: float | None,
        pass_behind: bool,
        side_hysteresis: float,
    ) -> Law:
        """Return the virtual force field."""

    @staticmethod
    def masoud(*, attractive_gain: float, repulsive_gain: float, detour_gain: float) -> Law:
        """Return the circulating repulsion."""

    @staticmethod
    def ge_cui(*, attractive_gain: float, repulsive_gain: float, gain_ratio: float) -> Law:
        """Return the dynamic potential field."""

    @staticmethod
    def khatib(*, attractive_gain: float, repulsive_gain: float, gain_ratio: float, printed: bool) -> Law:
        """Return the artificial potential field."""

    @staticmethod
    def borenstein_koren(*, attractive_gain: float, repulsive_gain: float, attracted_inside: bool) -> Law:
        """Return the virtual force of Borenstein and Koren."""

    @staticmethod
    def velocity_obstacle(*, margin: float, horizon: float, risk_weight: float, sector: float, selection: str) -> Law:
        """Return velocity obstacles."""

    @staticmethod
    def reciprocal(*, horizon: float, margin: float, turn: float, reach: float, share: float) -> Law:
        """Return optimal reciprocal collision avoidance."""

    @staticmethod
    def field_d_star(*, resolution: float, margin: float, horizon: float, room: float, look_ahead: float) -> Law:
        """Return the path of least cost over a grid."""

    @staticmethod
    def random_tree(
        *,
        step: float,
        goal_probability: float,
        waypoint_probability: float,
        margin: float,
        horizon: float,
        room: float,
        look_ahead: float,
        waypoints: int,
        draws: int,
        keeps_path: bool,
        safety_draws: int,
    ) -> Law:
        """Return the extended random tree."""

def region_radii(
    robot: HolonomicRobot | DifferentialDriveRobot,
    obstacle: Obstacle,
    control_period: float,
    faced_side: float | None,
) -> tuple[float, float]:
    """Return critical and active radius of an obstacle for a robot."""

def simulate(
    scenario: Scenario,
    law: Law,
    integrator: str,
    step: float,
    hold: bool,
    stop_on_contact: bool,
) -> _TrajectoryFields:
    """Run once and return the fields of a trajectory."""

def evaluate(
    scenario: Scenario,
    law: Law,
    weights: _Triple,
    integrator: str,
    step: float,
    hold: bool,
) -> tuple[_ScoreFields, _TrajectoryFields, _TrajectoryFields]:
    """Return the parts of the score of a run, the run and the nominal run."""

def law_command(law: Law, scenario: Scenario, position: _Pair, velocity: _Pair, time: float) -> tuple[float, float]:
    """Return the force that a law asks for at one state."""

def force_terms(
    law: Law,
    scenario: Scenario,
    position: _Pair,
    velocity: _Pair,
    time: float,
) -> _ForceTermsFields:
    """Return every force term at one state."""

def force_field(
    law: Law,
    scenario: Scenario,
    position: _Array,
    velocity: _Array,
    time: float,
) -> _ForceFieldFields:
    """Return forces and Lyapunov function at many states."""

def lyapunov(
    law: Law,
    scenario: Scenario,
    position: _Pair,
    velocity: _Pair,
    time: float,
) -> tuple[float, float, float]:
    """Return the Lyapunov function, its derivative and Omega at one state."""

def simulate_batch(
    scenarios: Sequence[Scenario],
    law: Law,
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

# ---- gains ----------------------------------------------------------------------------------

_Flags = npt.NDArray[np.bool_]
_Bounded = tuple[str, float | None, float | None, int | None]
_Progress = Callable[[str, int, int, float], object]
_Save = Callable[[bytes], object]

class _EvaluationFields(TypedDict):
    values: _Array
    violation: _Array
    failed: _Flags

class _CandidateFields(TypedDict):
    gains: _Array
    value: float
    violation: float
    failed: bool

class _RoundFields(TypedDict):
    axes: list[_Array]
    increments: _Array
    evaluations: int
    failures: int
    best_value: float
    violation: float
    best_gains: _Array
    survivor_low: _Array
    survivor_high: _Array
    worst_survivor: float

class _LocalFields(TypedDict):
    start: _Array
    start_value: float
    gains: _Array
    value: float
    violation: float
    evaluations: int
    status: str

class _SearchFields(TypedDict):
    best: _CandidateFields
    rounds: list[_RoundFields]
    local: list[_LocalFields]
    top: _Array
    top_values: _Array
    top_violation: _Array
    evaluations: int
    failures: int
    interrupted: bool

class _GlobalFields(TypedDict):
    best: _CandidateFields
    history: _Array
    evaluations: int
    failures: int
    interrupted: bool

class _FrontFields(TypedDict):
    points: _Array
    values: _Array
    evaluations: int
    failures: int
    interrupted: bool

@final
class GainProblem:
    """Function of the gains over scenarios: objectives to maximize and margins that must not be negative."""

    def __new__(
        cls,
        *,
        scenarios: Sequence[Scenario],
        law: Law,
        weights: _Triple,
        integrator: str,
        step: float,
        hold: bool,
        seeds: Sequence[int],
        lower_bound_factor: float | None,
        objectives: Sequence[str | None],
        constraints: Sequence[_Bounded],
        scorer: Callable[[list[_BatchFields]], tuple[_Array, _Array]] | None,
        scorer_constraints: int,
        lanes: int | None,
    ) -> Self: ...
    def evaluate(self, points: _Array, *, threads: int | None) -> _EvaluationFields:
        """Values as maximized, violations and failures of gain sets."""

def search_gains(
    problem: GainProblem,
    lower: Sequence[float],
    upper: Sequence[float],
    *,
    shape: Sequence[int],
    refinements: int,
    survivors: int,
    keep: int,
    local_starts: int,
    threads: int | None,
    state: bytes | None,
    save: _Save | None,
    progress: _Progress | None,
) -> _SearchFields:
    """Coarse-to-fine grids, then local searches from their best points."""

def search_gains_globally(
    problem: GainProblem,
    lower: Sequence[float],
    upper: Sequence[float],
    *,
    method: str,
    evaluations: int,
    islands: int,
    seed: int,
    threads: int | None,
    state: bytes | None,
    save: _Save | None,
    progress: _Progress | None,
) -> _GlobalFields:
    """Global search with a budget."""

def gain_front(
    problem: GainProblem,
    lower: Sequence[float],
    upper: Sequence[float],
    *,
    shape: Sequence[int],
    refinements: int,
    threads: int | None,
    state: bytes | None,
    save: _Save | None,
    progress: _Progress | None,
) -> _FrontFields:
    """Gain sets that no other one beats in every objective."""

def front_hypervolume(values: Sequence[float], objectives: int, reference: Sequence[float]) -> float:
    """Volume between points, all objectives maximized, and a reference below them."""

# ---- impact ---------------------------------------------------------------------------------

_Row = tuple[
    float,
    float,
    float,
    float,
    float,
    float,
    float,
    float,
    float,
    float,
    float,
    float,
    str,
    bool,
]
_Triplet = Sequence[float | _Array]
_Limits = Sequence[tuple[str, float, Head | ConstrainedHead]]

class _ResponseFields(TypedDict):
    time: _Array
    contact_force: _Array
    head_acceleration: _Array
    head_position: _Array
    head_velocity: _Array
    manipulator_position: _Array
    manipulator_velocity: _Array
    compression: _Array
    release_times: _Array
    touch_times: _Array

class _BoundaryFields(TypedDict):
    stiffness: _Array
    status: list[str]
    limited_by: list[str]
    crossings: tuple[_Array, ...]
    crossing_status: list[list[str]]
    holds_below: _Flags
    holds_above: _Flags

class _FastestFields(TypedDict):
    closing_speed: _Array
    stiffness: _Array

class _FoamFitFields(TypedDict):
    stiffness: float
    damping_ratio: float
    friction: float
    drop_heights: _Array
    covariance: _Array
    interval: _Array
    bootstrap_interval: _Array | None
    force_deviation: float
    position_deviation: float
    degrees_of_freedom: int
    iterations: int

class _StaticFitFields(TypedDict):
    stiffness: float
    force_offset: float
    covariance: _Array
    interval: _Array
    force_deviation: float
    degrees_of_freedom: int

class _OpenLoopFields(TypedDict):
    acceleration: float
    decay: float
    covariance: _Array
    interval: _Array
    residual_deviation: float

class _DirectDriveFields(TypedDict):
    command_gain: float
    friction_offset: float
    decay: float
    torque_constant: float
    viscous_friction: float
    static_friction: float
    covariance: _Array
    interval: _Array
    decay_interval: _Array

class _DriveRunFields(TypedDict):
    time: _Array
    manipulator_position: _Array
    manipulator_velocity: _Array
    head_position: _Array
    head_velocity: _Array
    head_acceleration: _Array
    contact_force: _Array
    compression: _Array
    command: _Array
    requested_command: _Array
    peak_head_acceleration: float
    peak_contact_force: float
    max_compression: float
    impact_duration: float
    saturated_from: float
    saturated_time: float

@final
class Joint:
    """Elastic joint under control."""

    def __new__(
        cls,
        *,
        inertia: float,
        mechanical_stiffness: float,
        mechanical_damping: float,
        control_stiffness: float,
        control_damping: float,
    ) -> Self: ...
    @property
    def stiffness(self) -> float:
        """Reduced stiffness."""

    @property
    def damping(self) -> float:
        """Reduced damping."""

    def model_error(self, omega: _Array) -> _Array:
        """Return the error of the reduced joint at frequencies."""

@final
class Manipulator:
    """Manipulator at the impact point."""

    def __new__(cls, *, mass: float, damping: float, stiffness: float) -> Self: ...

@final
class Head:
    """Head on a neck."""

    def __new__(cls, *, mass: float, damping: float, stiffness: float) -> Self: ...

@final
class ConstrainedHead:
    """Head that cannot move."""

    def __new__(cls) -> Self: ...

@final
class Foam:
    """Foam covering."""

    def __new__(cls, *, stiffness: float, damping: float, thickness: float, linear_range: float) -> Self: ...

@final
class SetPoint:
    """Motion of the manipulator's set-point."""

    def __new__(cls, *, segments: Sequence[_Pair], feed_forward: bool) -> Self: ...

@final
class DirectDrive:
    """Direct-drive joint with its controller."""

    def __new__(
        cls,
        *,
        inertia: float,
        lever_arm: float,
        torque_constant: float,
        amplifier_gain: float,
        viscous_friction: float,
        static_friction: float,
        voltage_limit: float,
        proportional: float,
        derivative: float,
    ) -> Self: ...
    def linear(self) -> _Triple:
        """Return mass, damping and stiffness without friction and limit."""

@final
class CylinderController:
    """Controller of the pneumatic cylinder."""

    def __new__(
        cls,
        *,
        acceleration_gain: float,
        velocity_gain: float,
        proportional: float,
        derivative: float,
        sample_time: float,
    ) -> Self: ...
    def command(
        self,
        *,
        desired_position: float,
        desired_velocity: float,
        desired_acceleration: float,
        position: float,
        velocity: float,
    ) -> float:
        """Return the command of the valve."""

def effective_one_joint(*, inertia: float, damping: float, stiffness: float, lever_arm: float) -> _Triple:
    """Return effective mass, damping and stiffness of one joint."""

def effective_two_joints(
    *,
    mass_matrix: Sequence[Sequence[float]],
    damping: _Pair,
    stiffness: _Pair,
    second_link: float,
    lever_arm: float,
    elbow: float,
) -> _Triple:
    """Return effective mass, damping and stiffness of two joints."""

def impact_point_speed(rates: _Pair, *, second_link: float, lever_arm: float, elbow: float) -> float:
    """Return the speed of the impact point of two joints."""

def uniform_links(*, mass: _Pair, length: _Pair, elbow: float) -> list[list[float]]:
    """Return the mass matrix of two uniform links."""

def impact_metrics(
    manipulator: Manipulator,
    foam: Foam,
    head: Head | ConstrainedHead,
    closing_speed: float,
    manipulator_speed: float | None,
    horizon: float | None,
) -> _Row:
    """Return numbers, status and whether the foam leaves its linear range."""

def impact_gradient_names() -> tuple[list[str], list[str]]:
    """Return names of the rows and columns of the derivatives."""

def impact_gradients(
    manipulator: Manipulator,
    foam: Foam,
    head: Head | ConstrainedHead,
    closing_speed: float,
    manipulator_speed: float | None,
    horizon: float | None,
) -> tuple[_Row, _Array]:
    """Return the row of metrics and the matrix of their derivatives."""

def impact_status_words() -> list[str]:
    """Return the words of the codes in a batch."""

def impact_metrics_batch(
    *,
    manipulator: _Triplet,
    foam: _Triplet,
    head: _Triplet | None,
    closing_speed: float | _Array,
    manipulator_speed: float | _Array | None,
    horizon: float | None,
    peaks_only: bool,
    threads: int | None,
    lanes: int | None,
    progress: Callable[[int, int], object] | None,
) -> dict[str, npt.NDArray[Any]]:
    """Return columns of metrics, those that were asked for."""

def stopping_segments(*, manipulator_speed: float, detection: float, rest: float) -> list[_Pair]:
    """Return the segments of a stop after detection."""

def impact_simulate(
    manipulator: Manipulator,
    foam: Foam,
    head: Head | ConstrainedHead,
    *,
    closing_speed: float,
    manipulator_speed: float | None,
    duration: float,
    step: float,
    runge_kutta: bool,
    unilateral: bool,
    as_printed: bool,
    set_point: SetPoint,
) -> tuple[_ResponseFields, _Row]:
    """Return columns of the response, and the row of its metrics."""

def foam_boundary(
    manipulator: Manipulator,
    limits: _Limits,
    damping: _Array,
    *,
    closing_speed: float,
    horizon: float | None,
    upper: bool,
) -> _BoundaryFields:
    """Return the upper or lower boundary at each damping."""

def foam_ratios(
    manipulator: Manipulator,
    limits: _Limits,
    foam: Foam,
    *,
    closing_speed: float,
    horizon: float | None,
) -> list[float]:
    """Return the ratio of each quantity to its limit for a foam."""

def foam_fastest(
    manipulator: Manipulator,
    limits: _Limits,
    damping: _Array,
    *,
    closing_speed: float,
    horizon: float | None,
) -> _FastestFields:
    """Return the largest closing speed at each damping, and the stiffness that allows it."""

def hic(time: _Array, acceleration_g: _Array, window: float, interpolate: bool) -> _Triple:
    """Return value, start and end of the head injury criterion of a signal."""

def moving_average(time: _Array, acceleration_g: _Array, width: float) -> _Triple:
    """Return value, start and end of the largest moving average of a signal."""

def contiguous_level(time: _Array, acceleration_g: _Array, width: float) -> _Triple:
    """Return value, start and end of the level that a signal exceeds without a break."""

def recorded_metrics(
    time: _Array,
    acceleration_g: _Array,
    *,
    contact_force: _Array | None,
    compression: _Array | None,
    manipulator_velocity: _Array | None,
    start: float | None,
    linear_range: float,
) -> _Row:
    """Return numbers, status and whether the foam leaves its linear range, of a recorded impact."""

def hic_half_sine(peak_g: float, duration: float, window: float) -> float:
    """Return the head injury criterion of a half sine."""

def hic_square(peak_g: float, duration: float, window: float) -> float:
    """Return the head injury criterion of a square pulse."""

def hic_triangle(peak_g: float, duration: float, window: float) -> float:
    """Return the head injury criterion of a triangle."""

def identify_foam(
    static_force: _Array,
    static_compression: _Array,
    drops: Sequence[tuple[_Array, _Array]],
    *,
    moving_mass: float,
    gravity: float,
    confidence: float,
    attached: bool,
    bootstrap: int,
    seed: int,
) -> _FoamFitFields:
    """Return stiffness, damping ratio and friction from static and drop tests."""

def fit_static(static_force: _Array, static_compression: _Array, intercept: bool) -> _StaticFitFields:
    """Return the stiffness of a foam from a static test."""

def drop_trajectory(
    time: _Array,
    *,
    height: float,
    mass: float,
    stiffness: float,
    damping_ratio: float,
    friction: float,
    gravity: float,
    attached: bool,
) -> _Array:
    """Return the height of a mass that is dropped on foam."""

def fit_open_loop(time: _Array, angle: _Array) -> _OpenLoopFields:
    """Return acceleration and decay of an open-loop test."""

def identify_direct_drive(
    voltage: _Array,
    acceleration: _Array,
    decay: _Array,
    inertia: float,
    amplifier_gain: float,
) -> _DirectDriveFields:
    """Return constants of a direct-drive joint from open-loop tests."""

def pd_gains(
    *,
    stiffness: float,
    damping: float,
    lever_arm: float,
    torque_constant: float,
    viscous_friction: float,
    amplifier_gain: float,
) -> _Pair:
    """Return proportional and derivative gain for a wanted stiffness and damping."""

def tube_inertia(*, density: float, length: float, width: float, height: float, wall: float) -> _Pair:
    """Return mass and inertia of a rectangular tube."""

def simulate_direct_drive(
    drive: DirectDrive,
    foam: Foam,
    head: Head,
    *,
    closing_speed: float,
    manipulator_speed: float,
    duration: float,
    step: float,
) -> _DriveRunFields:
    """Return histories of a direct-drive joint in an impact."""
