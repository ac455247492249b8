"""Native core of hrsafety; private, with `hrsafety.navigation` and `hrsafety.impact` as its faces.

The callers convert once and give every argument, in SI units and radians. A value out of range
raises `hrsafety.errors.InvalidParameterError`. Words are plain strings here: the core refuses an
unknown one and quotes its rule.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, NotRequired, Self, TypedDict, final

import numpy as np
import numpy.typing as npt

__all__ = [
    "CONTACT_SPEED",
    "DECIDED_OVERLAP",
    "Arm",
    "AsBuilt",
    "Burst",
    "Camera",
    "ConstrainedHead",
    "Controller",
    "Converter",
    "CrowdEnvironments",
    "CrowdEpisode",
    "CrowdModel",
    "CrowdPerson",
    "CrowdRobot",
    "CrowdSource",
    "CrowdWall",
    "CrowdWorld",
    "CylinderController",
    "DifferentialDriveRobot",
    "DifferentialKinematics",
    "DirectDrive",
    "EchoShape",
    "ErrorSource",
    "Estimator",
    "Foam",
    "Follower",
    "FollowerLayouts",
    "FollowerSteps",
    "GainProblem",
    "Guide",
    "Head",
    "HolonomicRobot",
    "Hunt",
    "Joint",
    "Law",
    "Lidar",
    "Manipulator",
    "Measurement",
    "MicrophoneArray",
    "Mover",
    "Obstacle",
    "OmniKinematics",
    "Plan",
    "ReferencePath",
    "Run",
    "Scenario",
    "Scenarios",
    "Sensor",
    "SetPoint",
    "Shield",
    "SkirtMotion",
    "SkirtScene",
    "SkirtSteps",
    "Slip",
    "Sonar",
    "StaticMap",
    "StoppingCurve",
    "Tracking",
    "TriOmniKinematics",
    "UltrasonicSkirt",
    "VirtualImpedance",
    "VirtualTorque",
    "Vision",
    "WheelDrive",
    "Yielding",
    "as_built_evaluate",
    "as_built_many",
    "as_built_simulate",
    "attraction_forces",
    "bare_forces",
    "burst_trial_delays",
    "cast_rays",
    "cell_distances",
    "check_takeover",
    "collision_feet",
    "collision_points",
    "contact_column",
    "contact_differential_mass",
    "contact_exceedance",
    "contact_holonomic_mass",
    "contact_names",
    "contact_rows",
    "contact_simulate",
    "contact_speed",
    "contact_thickness",
    "contact_words",
    "contiguous_level",
    "crowd_circle",
    "crowd_decisions",
    "crowd_metric_names",
    "crowd_metrics",
    "crowd_simulate",
    "crowd_world_metrics",
    "dashpots_in_series",
    "differential_wheels",
    "doppler_frequency",
    "drop_trajectory",
    "effective_one_joint",
    "effective_two_joints",
    "environment_words",
    "evaluate",
    "fit_open_loop",
    "fit_static",
    "fix_deviations",
    "fix_status_words",
    "foam_boundary",
    "foam_fastest",
    "foam_ratios",
    "follower_batch",
    "follower_layout",
    "follower_touching",
    "force_field",
    "force_terms",
    "front_hypervolume",
    "gain_front",
    "guard_distance",
    "guarded_law",
    "hic",
    "hic_of_pulse",
    "holonomic_wheels",
    "identify_direct_drive",
    "identify_foam",
    "impact_criteria",
    "impact_gradients",
    "impact_metrics",
    "impact_metrics_batch",
    "impact_parameter_names",
    "impact_point_speed",
    "impact_simulate",
    "impact_status_words",
    "impedance_forces",
    "jittered_sound_delays",
    "law_command",
    "likeness_curves",
    "locate_sounds",
    "lyapunov",
    "microphone_delays",
    "microphone_elevations",
    "moving_average",
    "nearest_inertia",
    "parallel_ray_bearings",
    "pd_gains",
    "printed_ranges",
    "record_burst",
    "recorded_metrics",
    "region_radii",
    "run_outcomes",
    "search_gains",
    "search_gains_globally",
    "separation_distances",
    "separation_speeds",
    "shield_speed_bound",
    "signal_shape",
    "simulate",
    "simulate_batch",
    "simulate_direct_drive",
    "skirt_closing_gap",
    "skirt_closing_radius",
    "skirt_directions",
    "skirt_least_sensors",
    "skirt_printed_gaps",
    "skirt_safe_distance",
    "skirt_states",
    "skirt_test",
    "sonar_mounts",
    "sonar_readings",
    "sound_delays",
    "speed_of_sound",
    "steady_gains",
    "stopping_segments",
    "track",
    "track_batch",
    "tube_inertia",
    "uniform_links",
    "urdf_joint_names",
    "vectors_to_world",
    "wheel_reference",
    "wheel_response",
]

CONTACT_SPEED: float
DECIDED_OVERLAP: float

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
    force: NotRequired[_Array]
    stabilizing: NotRequired[_Array]
    lyapunov: NotRequired[_Array]
    heading: _Array
    wheel_current: NotRequired[_Array]
    obstacle_position: NotRequired[_Array]
    distance: NotRequired[_Array]
    outcome: _Outcome
    arrival_time: float
    energy: float
    path_length: float
    min_clearance: _Array
    contact_time: _Array
    contact_speed: _Array
    contact_toward: npt.NDArray[np.bool_]
    contact_at_fault: npt.NDArray[np.bool_]
    contact_apart: npt.NDArray[np.bool_]
    map_contact_time: float
    map_contact_speed: float
    map_clearance: float
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
    contacts_toward: _Counts
    contacts_away: _Counts
    contacts_standing: _Counts
    contacts_at_fault: _Counts
    contacts_apart: _Counts
    wall_contacts: _Counts
    performance_total: _Array
    performance_arrival_time: _Array
    performance_avoidance: _Array
    performance_energy_saving: _Array
    descent_share: _Array
    force_evaluations: _Counts

class _EncounterFields(TypedDict):
    margin: _Array
    least_toward: _Array
    min_clearance: _Array
    contacts_toward: _Counts
    contacts_away: _Counts
    contacts_standing: _Counts
    wall_contacts: _Counts
    arrival_time: _Array
    top_speed: _Array
    end_time: _Array

class _PursuitFields(_EncounterFields):
    time: _Array
    position: _Array
    velocity: _Array
    person_position: _Array

@final
class Hunt:
    """A robot under a law, and the bounds of who pursues it."""

    def __new__(
        cls, scenario: Scenario, law: Law, built: AsBuilt, *, step: float, person_speed: float, free: float
    ) -> Self: ...
    def sweep(
        self,
        property: tuple[str, float],
        *,
        episodes: int,
        seed: int,
        threads: int | None,
        progress: Callable[[int, int], object] | None,
    ) -> _EncounterFields:
        """Return columns of episodes against random pursuers."""

    def worst(
        self,
        property: tuple[str, float],
        *,
        episodes: int,
        seed: int,
        threads: int | None,
        progress: Callable[[int, int], object] | None,
    ) -> tuple[list[float], float]:
        """Return the numbers of the worst pursuer that CMA-ES finds, and the margin against him."""

    def replay(self, *, seed: int, index: int, numbers: list[float] | None) -> _PursuitFields:
        """Return one episode again with its rows."""

@final
class HolonomicRobot:
    """Holonomic robot."""

    def __new__(cls, **given: object) -> Self: ...

@final
class DifferentialDriveRobot:
    """Differential-drive robot."""

    def __new__(cls, **given: object) -> Self: ...

@final
class Obstacle:
    """Obstacle."""

    @staticmethod
    def disc(**given: object) -> Obstacle:
        """Return a disc at rest."""

    @staticmethod
    def rectangle(**given: object) -> Obstacle:
        """Return a rectangle at rest."""

    @staticmethod
    def moving(
        motion: tuple[_Pair, _Pair, _Pair],
        stop: _Pair | None,
        radius: float,
        limits: tuple[float | None, float | None, float | None],
    ) -> Obstacle:
        """Return a disc with constant acceleration or a sudden stop."""

    def sized(self, critical_radius: float, active_radius: float) -> Obstacle:
        """Return the obstacle with the radii that a scenario has found."""

    @staticmethod
    def moving_rectangle(**given: object) -> Obstacle:
        """Return a rectangle with constant acceleration or a sudden stop."""

    @staticmethod
    def piecewise(**given: object) -> Obstacle:
        """Return a disc or a rectangle with piecewise constant acceleration."""

    @staticmethod
    def recorded(**given: object) -> Obstacle:
        """Return a disc or a rectangle that follows a recording."""

@final
class Measurement:
    """Measurement error."""

    def __new__(cls, *, scale: float, distribution: str, of: str, latency: float) -> Self: ...
    def error_bound(self) -> float:
        """Return the largest distance of a measured position from the one that is measured, in m."""

@final
class Scenario:
    """Scenario."""

    def __new__(
        cls,
        robot: HolonomicRobot | DifferentialDriveRobot,
        ends: tuple[_Pair, _Pair],
        obstacles: Sequence[Obstacle],
        rules: tuple[float, float, float, float, float],
        noise: tuple[Measurement | None, int],
    ) -> Self: ...
    def regions(self) -> list[tuple[float, float]]:
        """Return critical and active radius of every obstacle."""
    def point_mass(self) -> tuple[float, float, float, float, float]:
        """Return mass, radius, largest speed and acceleration of the point mass that a law drives."""
    def reseeded(self, seed: int) -> Self:
        """Return the same scenario with another seed."""

@final
class Scenarios:
    """Scenarios that crossed the boundary once."""

    def __new__(
        cls,
        ends: tuple[_Array, _Array],
        obstacles: tuple[_Array, _Array, _Array],
        person: bool,
        robot: HolonomicRobot | DifferentialDriveRobot,
        rules: tuple[float, float, float, float, float],
        seed: npt.NDArray[np.uint64],
    ) -> Self: ...
    @staticmethod
    def random_traffic(obstacles: int, robot: HolonomicRobot, seeds: Sequence[int]) -> Scenarios:
        """Return random traffic of a number of obstacles for each seed."""

    @staticmethod
    def random_crowd(people: int, robot: HolonomicRobot | DifferentialDriveRobot, seeds: Sequence[int]) -> Scenarios:
        """Return a random crowd of a number of people for each seed."""

    def __len__(self) -> int: ...
    def row(self, index: int) -> Scenario:
        """Return the scenario of a row."""

    def rows(self, indices: Sequence[int]) -> Scenarios:
        """Return the scenarios of some rows."""

    def reseeded(self, seeds: Sequence[int]) -> Scenarios:
        """Return every scenario with each of the seeds, those of a scenario together."""

    def seeds(self) -> list[int]:
        """Return the seed of every scenario."""

@final
class Law:
    """A law of any kind."""

    @staticmethod
    def python(begin: Callable[..., Callable[[dict[str, Any]], _Pair]], *, velocity: bool) -> Law:
        """Return a law in Python."""

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

    gain_names: list[str]
    gains: list[float]
    @staticmethod
    def named(name: str, **given: object) -> Law:
        """Return a law of the core's registry."""

@final
class Yielding:
    """How a robot gives way."""

    def __new__(cls, **given: object) -> Self: ...
    clearance: float
    horizon: float
    time_weight: float
    distance_weight: float
    comfort: float
    goal_weight: float
    reach: float

@final
class Shield:
    """What the shield assumes."""

    def __new__(cls, **given: object) -> Self: ...
    def decide(
        self,
        limits: tuple[float, float, float, float],
        state: tuple[_Pair, _Pair],
        wanted: _Pair,
        people: list[tuple[_Pair, float, _Pair]],
    ) -> tuple[list[float], str, list[float]]:
        """Return the velocity that is commanded, the status, and the gap of wanted and commanded one."""

    def examine(
        self,
        limits: tuple[float, float, float, float],
        state: tuple[_Pair, _Pair],
        command: _Pair,
        others: list[tuple[_Pair, tuple[float, float, float], _Pair, _Pair]],
    ) -> tuple[float, list[Any]]:
        """Return the gap of the plan behind a command, its instants, and where the robot is at them."""

def guarded_law(law: Law, **given: object) -> Law:
    """Return the law with parts around it."""

def shield_speed_bound(gap: float, angle: float, deceleration: float, person_speed: float) -> float:
    """Return the largest speed at an angle to a person, NaN where there is no limit."""

@final
class CrowdModel:
    """A model of people."""

    def __new__(cls, name: str, **given: object) -> Self: ...
    @property
    def largest_step(self) -> float: ...
    @property
    def cap(self) -> float: ...
    @property
    def is_force(self) -> bool: ...

@final
class CrowdPerson:
    """A person at the start."""

    def __new__(cls, model: CrowdModel, **given: object) -> Self: ...

@final
class CrowdSource:
    """Where people come from."""

    def __new__(cls, model: CrowdModel, **given: object) -> Self: ...

@final
class CrowdRobot:
    """A robot at the start."""

    def __new__(
        cls,
        robot: HolonomicRobot | DifferentialDriveRobot,
        law: Law | None,
        measurement: Measurement | None,
        **given: object,
    ) -> Self: ...

@final
class CrowdWall:
    """What stands."""

    @staticmethod
    def polyline(points: Sequence[_Pair]) -> CrowdWall: ...
    @staticmethod
    def solid(obstacle: Obstacle) -> CrowdWall: ...

@final
class CrowdWorld:
    """A world."""

    def __new__(
        cls,
        people: Sequence[CrowdPerson],
        robots: Sequence[CrowdRobot],
        sources: Sequence[CrowdSource],
        walls: Sequence[CrowdWall],
        **given: object,
    ) -> Self: ...
    def nearest_walls(self, places: Sequence[_Pair]) -> list[tuple[float, int]]: ...

def crowd_simulate(
    worlds: Sequence[CrowdWorld], *, threads: int | None, progress: Callable[[int, int], object] | None
) -> list[dict[str, Any]]: ...
def crowd_circle(seed: int, people: int) -> list[_Pair]: ...
def crowd_decisions(
    model: CrowdModel,
    position: _Array,
    velocity: _Array,
    goal: _Array,
    sizes: _Array,
    **given: object,
) -> dict[str, _Array]: ...
def region_radii(
    robot: HolonomicRobot | DifferentialDriveRobot,
    obstacle: Obstacle,
    control_period: float,
    faced_side: float | None,
    latency: float | None,
    position_error: float | None,
    measurement: Measurement | None,
) -> tuple[float, float]:
    """Return critical and active radius of an obstacle for a robot."""

def run_outcomes() -> list[tuple[str, str]]:
    """Return the words for how a run can end, and what they say."""

def simulate(
    scenario: Scenario,
    law: Law,
    **given: object,
) -> _TrajectoryFields:
    """Run once and return the fields of a trajectory, those that are kept."""

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
    scenarios: Sequence[Scenario] | Scenarios, law: Law, gains: _Array, weights: _Triple, **given: object
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

    def __new__(cls, **given: object) -> Self: ...
    def evaluate(self, points: _Array, *, threads: int | None) -> _EvaluationFields:
        """Values as maximized, violations and failures of gain sets."""

def search_gains(
    problem: GainProblem, lower: Sequence[float], upper: Sequence[float], **given: object
) -> _SearchFields:
    """Coarse-to-fine grids, then local searches from their best points."""

def search_gains_globally(
    problem: GainProblem, lower: Sequence[float], upper: Sequence[float], **given: object
) -> _GlobalFields:
    """Global search with a budget."""

def gain_front(problem: GainProblem, lower: Sequence[float], upper: Sequence[float], **given: object) -> _FrontFields:
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

    def __new__(cls, **given: object) -> Self: ...
    inertia: float
    mechanical_stiffness: float
    mechanical_damping: float
    control_stiffness: float
    control_damping: float
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

    def __new__(cls, **given: object) -> Self: ...
    mass: float
    damping: float
    stiffness: float

@final
class Head:
    """Head on a neck."""

    def __new__(cls, **given: object) -> Self: ...
    mass: float
    damping: float
    stiffness: float

@final
class ConstrainedHead:
    """Head that cannot move."""

    def __new__(cls) -> Self: ...

@final
class Foam:
    """Foam covering."""

    def __new__(cls, **given: object) -> Self: ...
    stiffness: float
    damping: float
    thickness: float
    linear_range: float

@final
class SetPoint:
    """Motion of the manipulator's set-point."""

    def __new__(cls, *, segments: Sequence[_Pair], feed_forward: bool) -> Self: ...

@final
class DirectDrive:
    """Direct-drive joint with its controller."""

    def __new__(cls, **given: object) -> Self: ...
    inertia: float
    lever_arm: float
    torque_constant: float
    amplifier_gain: float
    viscous_friction: float
    static_friction: float
    voltage_limit: float
    proportional: float
    derivative: float
    def linear(self) -> _Triple:
        """Return mass, damping and stiffness without friction and limit."""

@final
class CylinderController:
    """Controller of the pneumatic cylinder."""

    def __new__(cls, **given: object) -> Self: ...
    acceleration_gain: float
    velocity_gain: float
    proportional: float
    derivative: float
    sample_time: float
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

def effective_one_joint(**given: object) -> _Triple:
    """Return effective mass, damping and stiffness of one joint."""

def effective_two_joints(**given: object) -> _Triple:
    """Return effective mass, damping and stiffness of two joints."""

def impact_point_speed(rates: _Pair, *, second_link: float, lever_arm: float, elbow: float) -> float:
    """Return the speed of the impact point of two joints."""

def dashpots_in_series(damping: _Pair, *, second_link: float, lever_arm: float, elbow: float) -> float:
    """Return the damping of two joints with their dashpots in series."""

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

def impact_criteria() -> list[tuple[str, str, str, str, bool]]:
    """Return name, label, unit and symbol of each criterion, and whether peaks alone give it."""

def impact_parameter_names() -> list[str]:
    """Return the names of the columns of the derivatives."""

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
    given: Mapping[str, float | _Array],
    *,
    horizon: float | None,
    outputs: Sequence[str],
    threads: int | None,
    lanes: int | None,
    progress: Callable[[int, int], object] | None,
) -> dict[str, npt.NDArray[Any]]:
    """Return columns of metrics, those that are asked for by their names."""

def stopping_segments(*, manipulator_speed: float, detection: float, rest: float) -> list[_Pair]:
    """Return the segments of a stop after detection."""

def impact_simulate(
    manipulator: Manipulator, foam: Foam, head: Head | ConstrainedHead, **given: object
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

def signal_shape(
    time: _Array, values: _Array, rest: float, window: tuple[float, float]
) -> tuple[float, float, float, float, float, float, float, int, int, float, _Triple]:
    """Return features of a signal, and the area of the push around a window."""

def moving_average(time: _Array, acceleration_g: _Array, width: float) -> _Triple:
    """Return value, start and end of the largest moving average of a signal."""

def contiguous_level(time: _Array, acceleration_g: _Array, width: float) -> _Triple:
    """Return value, start and end of the level that a signal exceeds without a break."""

def recorded_metrics(time: _Array, acceleration_g: _Array, **given: object) -> tuple[_Row, tuple[float, ...]]:
    """Return numbers, status and whether the foam leaves its linear range, of a recorded impact, and of all of it."""

def hic_of_pulse(shape: str, peak_g: float, duration: float, window: float) -> float:
    """Return the head injury criterion of a pulse of a known shape."""

def identify_foam(
    static_force: _Array, static_compression: _Array, drops: Sequence[tuple[_Array, _Array]], **given: object
) -> _FoamFitFields:
    """Return stiffness, damping ratio and friction from static and drop tests."""

def fit_static(static_force: _Array, static_compression: _Array, intercept: bool) -> _StaticFitFields:
    """Return the stiffness of a foam from a static test."""

def drop_trajectory(time: _Array, **given: object) -> _Array:
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

def pd_gains(**given: object) -> _Pair:
    """Return proportional and derivative gain for a wanted stiffness and damping."""

def tube_inertia(**given: object) -> _Pair:
    """Return mass and inertia of a rectangular tube."""

def simulate_direct_drive(drive: DirectDrive, foam: Foam, head: Head, **given: object) -> _DriveRunFields:
    """Return histories of a direct-drive joint in an impact."""

@final
class TriOmniKinematics:
    """Platform with three omni-wheels."""

    def __new__(cls, *, wheel_radius: float, wheel_width: float, chassis_radius: float) -> Self: ...
    def wheel_speeds(self, velocity: _Array, yaw_rate: _Array) -> _Array:
        """Return wheel speeds of velocities and yaw rates, row by row."""

    def body_velocity(self, wheel_speeds: _Array) -> tuple[_Array, _Array]:
        """Return velocities and yaw rates of wheel speeds, row by row."""

@final
class UltrasonicSkirt:
    """Ring of sensors with its decisions."""

    def __new__(
        cls,
        *,
        chassis_radius: float,
        sensor_inset: float,
        sensors: int,
        layout: str,
        wheel_gap: float,
        safe_distance: float | None,
        triggering: str,
        policy: str,
        beam_width: float,
        rays: int,
        least_range: float,
        most_range: float,
        range_noise: float,
        firing_period: float,
    ) -> Self: ...
    def bearings(self) -> list[float]:
        """Return the bearings of the sensors, in rad."""

    def gaps(self) -> list[float]:
        """Return the gaps between sensors counterclockwise, in rad."""

    def normal_distances(self, readings: _Array, safe_distance: float, triggering: str) -> _Array:
        """Return normal distances d1 to d8 and their limits, in m."""

    def trigger_distances(self) -> list[float]:
        """Return the triggering distances, in m."""

    def meeting_distance(self) -> float:
        """Return where the beams beside the largest gap meet, in m from the center."""

    def pattern(self, readings: _Array) -> int:
        """Return the bits of the sensors that are triggered."""

    def action(self, readings: _Array) -> str:
        """Return what is done."""

@final
class SkirtScene:
    """How discs are laid out."""

    def __new__(
        cls,
        *,
        obstacles: int,
        disc_radius: _Pair,
        course_distance: _Pair,
        course_offset: float,
        half_size: float,
        start_clearance: float,
        spacing: float,
        unseen_share: float,
    ) -> Self: ...

@final
class SkirtMotion:
    """How the robot moves."""

    def __new__(cls, *, speed: float, acceleration: float, spin_rate: float, duration: float) -> Self: ...

class _SkirtTestFields(TypedDict):
    direction: npt.NDArray[np.str_]
    min_clearance: _Array
    contact_time: _Array
    nearest_seen: npt.NDArray[np.bool_]

class _SkirtRunFields(TypedDict):
    time: _Array
    position: _Array
    heading: _Array
    velocity: _Array
    yaw_rate: _Array
    readings: _Array
    action: npt.NDArray[np.str_]
    disc_center: _Array
    disc_radius: _Array
    disc_seen: npt.NDArray[np.bool_]
    min_clearance: float
    contact_time: float

def skirt_directions() -> list[tuple[str, float]]:
    """Return words and angles in rad of the motion directions."""

def skirt_states() -> list[tuple[list[int], str]]:
    """Return the rows of the state table: sensors that see an obstacle, and the action."""

def skirt_closing_gap(*, sensors: int, wheel_gap: float) -> float:
    """Return the gap between sensors of a ring that closes, in rad."""

def skirt_closing_radius(
    *,
    sensors: int,
    wheel_gap: float,
    gap: float,
    sensor_radius: float,
    wheel_sensor_radius: float,
    sensor_length: float,
    correction: float,
) -> float:
    """Return the radius of the chassis that the printed (1) closes, in m."""

def skirt_printed_gaps(
    *,
    sensors: int,
    wheel_gap: float,
    chassis_radius: float,
    sensor_radius: float,
    wheel_sensor_radius: float,
    sensor_length: float,
    correction: float,
) -> _Triple:
    """Return the gaps by the printed (3) and (5) in rad, and the factor with which (3) closes the ring."""

def skirt_least_sensors(*, wheel_sensor_radius: float, sensor_radius: float) -> _Pair:
    """Return the least number of sensors by (6), and the next multiple of three."""

def skirt_safe_distance(*, sensor_radius: float, gap: float) -> float:
    """Return the distance from the center at which the beams beside a gap in rad meet, in m."""

def skirt_test(
    skirt: UltrasonicSkirt,
    scene: SkirtScene,
    motion: SkirtMotion,
    *,
    layouts: int,
    repeats: int,
    seed: int,
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> _SkirtTestFields:
    """Return the rows of the avoidance test."""

@final
class SkirtSteps:
    """A test under way."""

    def __new__(
        cls,
        skirt: UltrasonicSkirt,
        scene: SkirtScene,
        motion: SkirtMotion,
        *,
        index: int,
        repeats: int,
        seed: int,
    ) -> Self: ...
    @property
    def time(self) -> float:
        """Time of the firings so far."""

    @property
    def finished(self) -> bool:
        """Whether it has ended."""

    def percept(self) -> dict[str, Any]:
        """Return the fields of what the skirt decides by."""

    def step(self, *, action: str | None) -> None:
        """Advance by one firing period."""

    def run(self) -> None:
        """Run to the end."""

    def recorded(self) -> _SkirtRunFields:
        """Return the fields of the test so far."""

# ---- sound ----------------------------------------------------------------------------------

_SoundPlace = tuple[float, float, float, float, float, float, int | None]
_DelayOptions = tuple[str, list[float] | None, bool, int | None, int | None]

class _SoundDelayFields(TypedDict):
    delay_12: _Array
    delay_13: _Array

class _SoundBearingFields(TypedDict):
    bearing: _Array

class _SoundRangeFields(TypedDict):
    range: _Array

class _FixFields(TypedDict):
    range: _Array
    bearing: _Array
    covariance: _Array
    curvature: _Array
    status_code: npt.NDArray[np.uint8]

class _HeardFields(TypedDict):
    samples: _Array
    clipped: list[int]

class _FoundDelayFields(TypedDict):
    delays: list[float]
    lags: list[int]
    likeness: list[float]
    start: int

class _LikenessFields(TypedDict):
    values_12: _Array
    values_13: _Array

@final
class MicrophoneArray:
    """Row of three microphones."""

    def __new__(cls, *, spacing: float, speed_of_sound: float) -> Self: ...

@final
class Burst:
    """A sound of limited length; its waveform is made when it is heard first."""

    def __new__(cls, **given: object) -> Self: ...

@final
class Converter:
    """Analog-to-digital converter."""

    def __new__(cls, *, sample_rate: float, bits: int | None) -> Self: ...

def fix_status_words() -> list[str]:
    """Return the words of the codes of fixes."""

def microphone_delays(array: MicrophoneArray, range: _Array, bearing: _Array) -> _SoundDelayFields:
    """Return exact delays of M2 and M3 against M1."""

def parallel_ray_bearings(array: MicrophoneArray, pair: str, delay_12: _Array, delay_13: _Array) -> _SoundBearingFields:
    """Return bearings by parallel rays from the delays of one pair."""

def microphone_elevations(array: MicrophoneArray, range: _Array, bearing: _Array) -> dict[str, _Array]:
    """Return the angles at the three microphones between the row and sources."""

def printed_ranges(array: MicrophoneArray, delay_12: _Array, delay_13: _Array) -> _SoundRangeFields:
    """Return ranges by the printed formula."""

def locate_sounds(
    array: MicrophoneArray,
    delay_12: _Array,
    delay_13: _Array,
    *,
    covariance: Sequence[float],
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> _FixFields:
    """Return fixes from delays; the covariance of the delays is variance, covariance, variance."""

def doppler_frequency(frequency: float, *, speed_of_sound: float, observer_speed: float, source_speed: float) -> float:
    """Return the frequency that is heard by and from something that moves."""

def record_burst(
    burst: Burst, array: MicrophoneArray, converter: Converter, place: _SoundPlace, *, seed: int, run: int
) -> _HeardFields:
    """Return samples of three microphones that receive a burst."""

def sound_delays(
    array: MicrophoneArray, samples: _Array, sample_rate: float, options: _DelayOptions
) -> _FoundDelayFields:
    """Return delays of M2 and M3 against M1 from samples."""

def likeness_curves(
    array: MicrophoneArray, samples: _Array, sample_rate: float, options: _DelayOptions
) -> _LikenessFields:
    """Return likeness over lag from samples."""

def jittered_sound_delays(
    array: MicrophoneArray, sources: Sequence[tuple[float, float]], **given: object
) -> _SoundDelayFields:
    """Return delays with jitter of the arrivals, the runs of a source side by side."""

def burst_trial_delays(
    burst: Burst,
    array: MicrophoneArray,
    converter: Converter,
    places: Sequence[_SoundPlace],
    options: _DelayOptions,
    **given: object,
) -> _SoundDelayFields:
    """Return delays from full waveforms, the runs of a source side by side."""

# ---- follower ----

@final
class EchoShape:
    """Shape that echoes."""

    @staticmethod
    def rectangle(*, center: _Pair, size: _Pair, angle: float) -> EchoShape: ...
    @staticmethod
    def disc(*, center: _Pair, radius: float) -> EchoShape: ...
    @staticmethod
    def wall(*, start: _Pair, end: _Pair) -> EchoShape: ...

@final
class Mover:
    """Obstacle that moves or stands."""

    def __new__(cls, *, shape: EchoShape, velocity: _Pair, start: float, stop: float) -> Self: ...

@final
class Sonar:
    """Ultrasonic sensors of the follower."""

    def __new__(
        cls,
        *,
        forward: float,
        spacing: float,
        fan: float,
        beam_width: float,
        rays: int,
        least_range: float,
        most_range: float,
        range_noise: float,
        temperature: float,
        assumed_temperature: float,
        firing: str,
        rear: bool,
    ) -> Self: ...

@final
class VirtualImpedance:
    """Repulsion from collision vectors."""

    def __new__(
        cls,
        *,
        form: str,
        stiffness: float,
        damping: float,
        safe_distance: float,
        speed_limit: float,
        reference_stiffness: float,
        reference_damping: float,
        clamp: bool,
        speed: str,
        filter_time: float,
        largest_rate: float,
        outlives_gaps: bool,
        pairing_gap: float,
        pairing_share: float,
        rotation: str,
        translated_by: _Pair | None,
    ) -> Self: ...

@final
class Follower:
    """The robot and its ear."""

    def __new__(
        cls,
        *,
        sonar: Sonar,
        obstacle_vision: Vision | None,
        drive: Sequence[float],
        attraction: _Triple,
        fix_interval: float,
        fix_noise: bool,
        mirrored_fixes: bool,
        velocity_rule: str,
        integration: str,
        step: float,
    ) -> Self: ...

@final
class FollowerLayouts:
    """How random layouts are drawn."""

    def __new__(cls, *, kind: str, obstacle_speed: _Pair, size_factor: float, leader_size: _Pair | None) -> Self: ...

def sonar_mounts(sonar: Sonar) -> dict[str, _Array]:
    """Return positions (m) and axes (rad) of the sensors on the robot."""

def sonar_readings(
    sonar: Sonar, shapes: list[EchoShape], poses: _Array, *, seed: int, noise: bool
) -> dict[str, _Array]:
    """Return readings (m) of all sensors at poses (x, y, heading), one after the other."""

def cast_rays(shapes: list[EchoShape], origins: _Array, angles: _Array) -> dict[str, _Array]:
    """Return distances (m) along rays to the first shape; infinite without one."""

def speed_of_sound(temperature: float) -> float:
    """Return the speed of sound in m/s at a temperature in degrees Celsius."""

def impedance_forces(law: VirtualImpedance, distance: _Array, speed: _Array) -> dict[str, Any]:
    """Return spring and damper parts (N) at distances (m) and speeds (m/s), and the two scales."""

def attraction_forces(offset: _Array, velocity: _Array, *, stiffness: float, damping: float) -> dict[str, _Array]:
    """Return the attraction in N towards offsets in m, for velocities in m/s."""

def collision_feet(one: _Array, other: _Array, *, form: str) -> dict[str, _Array]:
    """Return feet of perpendiculars from the origin on the lines, or segments, between points."""

def collision_points(sensor: _Array, angle: _Array, reading: _Array) -> dict[str, _Array]:
    """Return points of echoes: sensors (m), angles of their axes (rad) and readings (m)."""

def vectors_to_world(vector: _Array, heading: _Array, rotation: str) -> dict[str, _Array]:
    """Return vectors of the robot in the directions of the world, by headings in rad."""

def fix_deviations(range: _Array, bearing: _Array) -> dict[str, _Array]:
    """Return standard deviations of range (m) and bearing (rad) of a fix, by Table 2."""

def follower_layout(layouts: FollowerLayouts, seed: int) -> dict[str, Any]:
    """Return boxes, leader and length of the layout of a seed."""

@final
class FollowerSteps:
    """A run of the follower under way."""

    def __new__(
        cls,
        follower: Follower,
        law: VirtualImpedance,
        obstacles: list[Mover],
        *,
        seed: int,
        leader_start: _Pair,
        leader_end: _Pair,
        leader_speed: float,
        leader_size: _Pair | None,
        duration: float,
    ) -> Self: ...
    @property
    def time(self) -> float:
        """Time of the control periods so far."""

    @property
    def finished(self) -> bool:
        """Whether it has ended."""

    def percept(self) -> dict[str, Any]:
        """Return the fields of what the law decides by."""

    def step(self, *, force: _Pair | None) -> None:
        """Advance by one control period."""

    def run(self) -> None:
        """Run to the end."""

    def recorded(self) -> dict[str, Any]:
        """Return the fields of the run so far."""

def follower_touching(
    follower: Follower, layouts: FollowerLayouts, *, first: int, count: int, threads: int | None
) -> list[int]:
    """Return the first seeds in whose layouts the robot without repulsion touches an obstacle."""

def follower_batch(
    follower: Follower,
    law: VirtualImpedance,
    layouts: FollowerLayouts,
    seeds: list[int],
    *,
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> dict[str, Any]:
    """Return the ends of the runs through the layouts of seeds."""

@final
class AsBuilt:
    """How a robot is built."""

    def __new__(
        cls,
        *,
        wheels: Sequence[WheelDrive] | None,
        kinematics: OmniKinematics,
        slip: Slip,
        tracking: Tracking | VirtualTorque,
        sensors: Sequence[Sensor],
        position_share: float,
        heading_share: float,
        mark_distance: float,
    ) -> Self: ...

@final
class Run:
    """A run under way."""

    def __new__(
        cls, scenario: Scenario, law: Law | None, built: AsBuilt, *, step: float, stop_on_contact: bool
    ) -> Self: ...
    @property
    def time(self) -> float:
        """Present time, or when the run ended."""

    @property
    def outcome(self) -> Literal["arrived", "collided", "timed_out", "stopped"] | None:
        """How it ended, if it has."""

    @property
    def trace(self) -> tuple[_Pair, _Pair, bool, str] | None:
        """What parts around the law did in the last control period, if there are any."""

    def situation(self) -> dict[str, Any]:
        """Return the fields of what the controller sees."""

    def step(self, *, force: _Pair | None, velocity: _Pair | None) -> None:
        """Advance by one control period."""

    def recorded(self, *, motors: bool) -> dict[str, Any]:
        """Return the fields of the trajectory so far."""

@final
class Controller:
    """A law on a robot."""

    def __new__(cls, scenario: Scenario, law: Law, lidar: Lidar | None, latency: float) -> Self: ...
    def update(
        self,
        time: float,
        robot: tuple[_Pair, _Pair] | None,
        heading: float,
        *,
        seen: list[tuple[int, _Pair, _Pair, float | None]],
        gone: list[int],
        scan: _Array | None,
    ) -> dict[str, Any]:
        """Return the fields of what the robot is to do."""

    def present(self) -> list[bool]:
        """Return who is there, as far as is known."""

def as_built_simulate(
    scenario: Scenario,
    law: Law,
    built: AsBuilt,
    *,
    step: float,
    stop_on_contact: bool,
) -> dict[str, Any]:
    """Return the fields of a run of a robot as built."""

def as_built_evaluate(
    scenario: Scenario,
    law: Law,
    built: AsBuilt,
    weights: tuple[float, float, float],
    *,
    step: float,
) -> tuple[dict[str, float], dict[str, Any], dict[str, Any]]:
    """Return the score of a run of a robot as built, the run and the nominal run."""

def as_built_many(
    scenarios: Sequence[Scenario] | Scenarios,
    laws: Sequence[Law],
    gains: _Array,
    built: AsBuilt,
    weights: _Triple,
    *,
    step: float,
    stop_on_contact: bool,
    histories: bool,
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> dict[str, Any]:
    """Return the columns of runs of every law in every scenario."""

class _EstimateFields(TypedDict):
    position: _Array
    velocity: _Array
    measured_at: _Array

class _TrackFields(_EstimateFields):
    covariance: _Array

class _ObservationFields(_EstimateFields):
    exposed: _Array
    measured: _Array

_Rotation = tuple[_Triple, _Triple, _Triple]

@final
class Camera:
    """Camera."""

    def __new__(
        cls,
        *,
        focal_length: float,
        radial_distortion: float,
        horizontal_scale: float,
        image_center: _Pair,
        pixel_size: _Pair,
        image_size: tuple[int, int],
        rotation: _Rotation,
        translation: _Triple,
    ) -> Self: ...
    def position(self) -> _Triple:
        """Where the camera is."""

    def project(self, points: _Array) -> _Array:
        """Pixels of points; NaN for those without an image."""

    def contains(self, pixels: _Array) -> list[bool]:
        """Whether pixels lie in the picture."""

    def reconstruct(self, pixels: _Array, heights: _Array) -> _Array:
        """Points at known heights that pixels show; NaN where there is none."""

    def linearize(self, parameters: Sequence[float], points: _Array) -> tuple[_Array, _Array]:
        """Pixels of points with other parameters than those of this camera, and derivatives."""

    def turned(self, parameters: Sequence[float]) -> _Rotation:
        """Rotation matrix after the turn among parameters."""

@final
class Estimator:
    """Estimator of position and velocity."""

    @staticmethod
    def differences() -> Estimator:
        """Backward differences."""

    @staticmethod
    def alpha_beta(*, position_gain: float, velocity_gain: float) -> Estimator:
        """Constant gains."""

    @staticmethod
    def kalman(*, acceleration_deviation: float, position_deviation: float, speed_deviation: float) -> Estimator:
        """Kalman filter."""

    def track(self, time: _Array, position: _Array) -> _TrackFields:
        """Estimates at measured positions; rows of the covariance are position, both, velocity."""

@final
class ErrorSource:
    """Error of measured positions."""

    @staticmethod
    def plane(*, distribution: str, scale: float) -> ErrorSource:
        """Return an error that is added to x and y."""

    @staticmethod
    def patch(*, camera: Camera, believed: Camera, height: float, centroid_deviation: float) -> ErrorSource:
        """Centroid of a color patch."""

@final
class Vision:
    """Vision of one body."""

    def __new__(
        cls,
        *,
        period: float,
        delay: float,
        error: ErrorSource,
        drop_probability: float,
        estimator: Estimator,
        compensated: bool,
    ) -> Self: ...
    def observe(self, time: _Array, position: _Array, seed: int, stream: int) -> _ObservationFields:
        """Frames of a body on a known path, and what is known at the times of the path."""

@final
class Sensor:
    """Sensor of a robot, of any kind."""

    @staticmethod
    def robot_camera(vision: Vision) -> Sensor:
        """Sees the robot."""

    @staticmethod
    def obstacle_camera(vision: Vision) -> Sensor:
        """Sees the obstacles that move."""

    @staticmethod
    def named(name: str, **given: object) -> Sensor:
        """Return a sensor on a robot of the core's list."""

    def sight(self, scenario: Scenario) -> _Triple:
        """Critical and active radius of what it reads, and how far it reads, in m."""

    @staticmethod
    def lidar(lidar: Lidar) -> Sensor:
        """Rides on the robot."""

# ---- static maps ----------------------------------------------------------------------------

_Occupied = npt.NDArray[np.bool_]

@final
class StaticMap:
    """What stands still."""

    def __new__(
        cls,
        *,
        polylines: Sequence[tuple[_Array, float]],
        polygons: Sequence[_Array],
        discs: _Array,
        grids: Sequence[tuple[_Occupied, float, _Pair, float, bool]],
    ) -> Self: ...
    def knows(self, points: _Array) -> list[bool]:
        """Return whether something is known of points (n, 2)."""

    def clearance(self, points: _Array) -> _Array:
        """Return distances of points (n, 2), zero inside, in m."""

    def segment_clearance(self, start: _Pair, end: _Pair) -> float:
        """Return the least distance of the points of a segment, in m."""

    def nearest(self, points: _Array) -> _Array:
        """Return nearest boundary points (n, 2) in m; NaN without shapes."""

    def ray(self, start: _Pair, bearings: Sequence[float]) -> list[float]:
        """Return distances along bearings in m, infinite where nothing is hit."""

    def boundary_points(self, position: _Pair, reach: float, kappa: float) -> _Array:
        """Return boundary points (n, 2) that a law sees, in m."""

    def segments(self) -> _Array:
        """Return ends and radii (n, 5), in m."""

    def bounds(self) -> tuple[_Pair, _Pair] | None:
        """Return lower and upper corner in m."""

def cell_distances(occupied: _Occupied, resolution: float) -> _Array:
    """Distances of cells of a side from the nearest occupied one."""

@final
class Guide:
    """Options of the guide."""

    def __new__(
        cls, *, spacing: float, margin: float, look_ahead: float, bounds: tuple[_Pair, _Pair] | None
    ) -> Self: ...
    @property
    def spacing(self) -> float: ...
    @property
    def margin(self) -> float: ...
    @property
    def look_ahead(self) -> float: ...
    @property
    def bounds(self) -> tuple[_Pair, _Pair] | None: ...
    def plan(self, map: StaticMap, radius: float, start: _Pair, goal: _Pair) -> Plan:
        """Return the plan of a robot of a radius in m."""

def check_takeover(progress: float | None, window: float | None) -> None:
    """Check when a takeover begins."""

@final
class Plan:
    """Plan through a map."""

    def cost(self, points: _Array) -> _Array:
        """Return costs at points (n, 2) in m, NaN without a plan there."""

    def local_goal(self, position: _Pair) -> tuple[_Pair, float, bool] | None:
        """Return place, cost-to-go and whether it is the goal."""

    def path(self, position: _Pair) -> _Array:
        """Return the path to the goal (n, 2), in m."""

@final
class Lidar:
    """Lidar on a robot."""

    def __new__(
        cls,
        *,
        map: StaticMap | None,
        beams: int,
        field_of_view: float,
        range_min: float,
        range_max: float,
        range_noise: float,
        sees_obstacles: bool,
        kappa: float,
        influence: float,
        reach: float | None,
        max_speed: float,
    ) -> Self: ...
    def bearings(self) -> list[float]:
        """Return angles of the beams, in rad."""

    def scan(self, pose: _Triple, discs: _Array, seed: int) -> list[float]:
        """Return ranges from (x, y, heading) among discs (n, 3), in m."""

    def points(self, pose: _Triple, ranges: Sequence[float]) -> _Array:
        """Return points (n, 2) that a scan hit, in m."""

    def regions(self, scenario: Scenario) -> _Pair:
        """Return critical and active radius of a boundary point, in m."""

def steady_gains(*, acceleration_deviation: float, position_deviation: float, period: float) -> _Pair:
    """Steady gains of a Kalman filter."""

# ---- two-wheel robot ------------------------------------------------------------------------

@final
class Tracking:
    @staticmethod
    def full_speed(**given: object) -> Tracking: ...
    @staticmethod
    def nonlinear(**given: object) -> Tracking: ...
    @staticmethod
    def exponential(**given: object) -> Tracking: ...

@final
class VirtualTorque:
    def __new__(cls, **given: object) -> Self: ...
    torque_gain: float
    damping_ratio: float
    backward: bool
    @staticmethod
    def gain_for(robot: DifferentialDriveRobot, frequency: float) -> float: ...
    def torque(self, heading: float, force: _Pair) -> float: ...
    def command(
        self,
        robot: DifferentialDriveRobot,
        *,
        force: _Pair,
        heading: float,
        speed: float,
        turn_rate: float,
        control_period: float,
    ) -> _Pair: ...

class _ReferenceFields(TypedDict):
    position: _Array
    velocity: _Array
    acceleration: _Array

@final
class ReferencePath:
    @staticmethod
    def line(*, start: _Pair, velocity: _Pair) -> ReferencePath: ...
    @staticmethod
    def circle(*, center: _Pair, radius: float, speed: float, start_angle: float) -> ReferencePath: ...
    @staticmethod
    def samples(*, time: _Array, position: _Array, velocity: _Array) -> ReferencePath: ...
    def at(self, time: _Array) -> _ReferenceFields: ...

class _FollowedFields(TypedDict):
    time: _Array
    position: _Array
    heading: _Array
    speed: _Array
    turn_rate: _Array
    commanded_speed: _Array
    commanded_turn_rate: _Array
    reference_position: _Array
    reference_velocity: _Array
    goal_phase: npt.NDArray[np.bool_]

def track(
    reference: ReferencePath, tracking: Tracking, robot: DifferentialDriveRobot, **given: object
) -> _FollowedFields: ...

class _FollowedColumns(TypedDict):
    final_error: _Array
    max_error: _Array
    final_heading: _Array
    path_length: _Array
    settling_time: _Array

def track_batch(
    references: Sequence[ReferencePath], tracking: Tracking, robot: DifferentialDriveRobot, **given: object
) -> _FollowedColumns: ...

class _WheelPreset(TypedDict):
    inertia: float
    viscous_friction: float
    static_friction: float
    model: _Triple
    proportional_gain: float
    derivative_gain: float
    feedback: Literal["observer", "observed_speed", "differences"]
    observer_poles: _Pair
    encoder_counts: float
    gear_ratio: float
    amplifier_gain: float
    winding_resistance: float
    back_emf: float
    current_limit: float
    supply_voltage: float
    period: float

class _WheelFields(TypedDict):
    angle: _Array
    speed: _Array
    read_angle: _Array
    known_angle: _Array
    known_speed: _Array
    current: _Array
    voltage: _Array
    ideal_current: _Array
    energy: float
    ideal_energy: float

@final
class WheelDrive:
    def __new__(cls, **given: object) -> Self: ...
    def open_loop_angles(self, *, command: float, start_angle: float, periods: int) -> _Array: ...
    def follow(
        self,
        *,
        angle: _Array,
        speed: _Array,
        acceleration: _Array,
        start_angle: float,
        start_speed: float,
    ) -> _WheelFields: ...

@final
class OmniKinematics:
    def __new__(cls, **given: object) -> Self: ...
    wheel_radius: float
    center_distance: float
    def wheel_speeds(self, velocity: _Array, heading: _Array) -> _Array: ...
    def body_velocity(self, speeds: _Array, heading: _Array) -> _Array: ...

@final
class DifferentialKinematics:
    def __new__(cls, **given: object) -> Self: ...
    wheel_radius: float
    span: float
    def wheel_speeds(self, motion: _Array) -> _Array: ...
    def body_velocity(self, speeds: _Array) -> _Array: ...
    def world_velocity(self, speeds: _Array, heading: _Array) -> _Array: ...

@final
class Slip:
    def __new__(cls, **given: object) -> Self: ...
    creep: float
    grip: float
    def ground_speeds(self, rim_speed: _Array, *, start: float, period: float) -> _Array: ...

def holonomic_wheels() -> list[_WheelPreset]: ...
def differential_wheels() -> list[_WheelPreset]: ...
def wheel_reference(speed: _Array, period: float) -> tuple[_Array, _Array]: ...
def wheel_response(time: _Array, *, dynamics: _Triple, current: float) -> _Array: ...

# ---- arms -----------------------------------------------------------------------------------

_Rows = tuple[_Array, list[int]]
_Vector3 = tuple[float, float, float]
_Load = tuple[str, float, _Vector3, tuple[_Vector3, _Vector3, _Vector3]]

@final
class Arm:
    """An arm on a base that stands still."""

    def __new__(
        cls,
        urdf: str,
        payloads: Sequence[_Load],
        armature: Sequence[tuple[str, float]],
        locked: Sequence[str],
        repair_inertia: bool,
    ) -> Self: ...
    def facts(self) -> dict[str, Any]:
        """Return what is known of the arm without a pose."""
    def effective_mass(self, given: Mapping[str, object], directions: _Rows) -> _Array:
        """Return effective masses along directions."""
    def point_states(self, given: Mapping[str, object]) -> dict[str, _Array]:
        """Return positions, mobilities, heaviest and lightest directions of points."""
    def velocities(self, given: Mapping[str, object], rates: _Rows) -> _Array:
        """Return velocities of points for rates of all joints."""

def urdf_joint_names(urdf: str) -> list[str]:
    """Return the names of the joints of a URDF that take values."""

def nearest_inertia(inertia: Sequence[Sequence[float]]) -> tuple[list[list[float]], float]:
    """Return the nearest inertia that a rigid body can have, and by how much of its trace a given one misses that."""

def bare_forces(closing_speed: _Array, robot_mass: _Array, body_mass: float, stiffness: float) -> _Array:
    """Return contact forces of closing speeds on a linear region without a covering."""

# ---- metrics of crowds ----------------------------------------------------------------------

@final
class CrowdEpisode:
    """One robot among people."""

    def __new__(cls, **given: object) -> Self: ...

def crowd_metric_names() -> tuple[list[tuple[str, Any, str, str]], list[tuple[str, Any, str, str]]]:
    """Return name, kind, unit and meaning of each metric of a robot, and of a world."""

def crowd_metrics(
    episodes: Sequence[CrowdEpisode], threads: int | None, progress: Callable[[int, int], object] | None
) -> tuple[dict[str, npt.NDArray[Any]], dict[str, _Array]]:
    """Return a column of each metric, and of extremes that tell which episodes need a closer look."""

def crowd_world_metrics(**given: object) -> dict[str, npt.NDArray[Any]]:
    """Return the metrics of a world, in columns of one row."""

# ---- environments for learners --------------------------------------------------------------

def environment_words() -> tuple[list[str], float, float]:
    """Return words for states of an episode, the bound of observations and the range of the lidar."""

@final
class CrowdEnvironments:
    """Environments side by side."""

    def __new__(cls, world: CrowdWorld, count: int, seed: int, threads: int | None, **given: object) -> Self: ...
    def size(self) -> int:
        """Return how many numbers an observation has."""

    def reset(
        self, seeds: Sequence[int | None], mask: npt.NDArray[np.bool_], arrays: Mapping[str, npt.NDArray[Any]]
    ) -> None:
        """Start episodes, where the mask says so if there is one."""

    def step(self, actions: _Array, arrays: Mapping[str, npt.NDArray[Any]]) -> None:
        """Step all of them, into arrays of the caller."""

    def places(
        self, index: int
    ) -> tuple[tuple[_Pair, float], list[tuple[_Pair, float]], list[tuple[_Pair, float]]] | None:
        """Return positions and radii of the robot, the people and the other robots of one of them."""

# ---- separation -----------------------------------------------------------------------------

@final
class StoppingCurve:
    """Measured stops at one load and extension."""

    def __new__(
        cls, axes: Sequence[Sequence[float]], time: _Array, distance: _Array, load: float, extension: float
    ) -> Self: ...
    def distances(self, robot_speed: _Array, rows: Mapping[str, _Array]) -> _Array:
        """Return distances for robots that stop as measured."""
    def speeds(self, distance: _Array, rows: Mapping[str, _Array]) -> tuple[_Array, npt.NDArray[np.bool_]]:
        """Return speeds that distances allow, and whether more might be allowed beyond the table."""

def separation_distances(robot_speed: _Array, deceleration: _Array, rows: Mapping[str, _Array]) -> _Array:
    """Return distances with a constant deceleration."""

def separation_speeds(distance: _Array, deceleration: _Array, rows: Mapping[str, _Array]) -> _Array:
    """Return speeds that distances allow with a constant deceleration."""

def guard_distance(
    stopping_time: float, capability: float | None, height: float | None
) -> tuple[float, float, float, float]:
    """Return the least distance of a guard, the first result, the speed of approach and the intrusion distance."""

# ---- contact ---------------------------------------------------------------------------------

def contact_names() -> list[str]: ...
def contact_words() -> tuple[list[str], list[str], list[str]]: ...
def contact_rows(
    kind: str,
    shared: dict[str, Any],
    numbers: Sequence[float | npt.NDArray[np.float64]],
    rows: int,
    *,
    gravity: float | None,
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> dict[str, Any]: ...
def contact_simulate(shared: dict[str, Any], numbers: Sequence[float], *, gravity: float | None) -> dict[str, Any]: ...
def contact_speed(shared: dict[str, Any], numbers: Sequence[float]) -> dict[str, Any]: ...
def contact_thickness(shared: dict[str, Any], numbers: Sequence[float]) -> tuple[float, str]: ...
def contact_column(
    shared: dict[str, Any], numbers: Sequence[float], compression: float
) -> tuple[float, float, float, tuple[float, float] | None]: ...
def contact_exceedance(
    shared: dict[str, Any],
    numbers: Sequence[float],
    inputs: Sequence[tuple[str, str, Sequence[float]]],
    *,
    speed: float,
    draws: int,
    seed: int,
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> dict[str, Any]: ...
def contact_holonomic_mass(
    *, mass: float, inertia: float, point: tuple[float, float], direction: tuple[float, float]
) -> float: ...
def contact_differential_mass(
    *,
    mass: float,
    inertia: float,
    drive: tuple[float, float, float, float],
    point: tuple[float, float],
    direction: tuple[float, float],
) -> float: ...
