"""Mobile robots among people and things: laws, scenarios, runs, scores."""

from hrsafety.errors import HrsafetyError, InvalidParameterError, ShapeError, SimulationError
from hrsafety.navigation.arena import ArenaResult, Standing, arena, step_cost
from hrsafety.navigation.batch import BatchSummary, simulate_batch
from hrsafety.navigation.built import AsBuilt, BuiltTrajectory, PoseFusion, evaluate_built, simulate_built
from hrsafety.navigation.calibration import CameraCalibration, calibrate_camera
from hrsafety.navigation.calibration_study import (
    CalibrationStudy,
    calibration_points,
    calibration_study,
    patch_places,
)
from hrsafety.navigation.camera import Camera, nearest_rotation
from hrsafety.navigation.estimators import AlphaBeta, Differences, Kalman, TrackedPositions, track_positions
from hrsafety.navigation.forces import ForceField, ForceTerms, Lyapunov, command, force_field, force_terms, lyapunov
from hrsafety.navigation.gain_changes import GainSensitivity, gain_sensitivity
from hrsafety.navigation.gain_confidence import Confidence
from hrsafety.navigation.gain_front import pareto_front
from hrsafety.navigation.gain_results import Flatness, GainSearch, LocalSearch, ParetoFront, SearchRound
from hrsafety.navigation.gain_search import optimize_gains
from hrsafety.navigation.gain_settings import GainConstraint, SearchSettings
from hrsafety.navigation.gain_slopes import GainGradient, gain_gradient
from hrsafety.navigation.impedance_law import VirtualImpedanceLaw
from hrsafety.navigation.kinematics import DifferentialKinematics, OmniKinematics, Slip
from hrsafety.navigation.laws import BorensteinKoren, GeCui, Khatib, Law, Masoud, VirtualForceField
from hrsafety.navigation.obstacles import Disc, Human, MovingDisc, Obstacle, Rectangle
from hrsafety.navigation.planners import (
    FieldDStar,
    OptimalReciprocalCollisionAvoidance,
    RapidlyExploringRandomTree,
    VelocityObstacle,
)
from hrsafety.navigation.references import CircleReference, LineReference, PathReference, Reference, ReferenceMotion
from hrsafety.navigation.repeated import Band, Repeated, repeat
from hrsafety.navigation.robots import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.scenario import Measurement, Regions, Scenario, region_radii
from hrsafety.navigation.simulation import evaluate, simulate
from hrsafety.navigation.tracking import TrackingRun, TrackingSummary, track, track_batch
from hrsafety.navigation.tracking_laws import (
    ExponentialTracking,
    FullSpeedTracking,
    NonlinearTracking,
    Tracking,
    Twist,
    VirtualTorque,
)
from hrsafety.navigation.trajectory import Performance, Trajectory
from hrsafety.navigation.vision import ColorPatch, Observation, PositionNoise, Vision, observe
from hrsafety.navigation.wheel_tests import OpenLoopTest, WheelFit, identify_wheel, open_loop_tests
from hrsafety.navigation.wheels import (
    DIFFERENTIAL_WHEELS,
    HOLONOMIC_WHEELS,
    WheelDrive,
    WheelReference,
    WheelRun,
    follow_wheel,
)

__all__ = [
    "DIFFERENTIAL_WHEELS",
    "HOLONOMIC_WHEELS",
    "AlphaBeta",
    "ArenaResult",
    "AsBuilt",
    "Band",
    "BatchSummary",
    "BorensteinKoren",
    "BuiltTrajectory",
    "CalibrationStudy",
    "Camera",
    "CameraCalibration",
    "CircleReference",
    "ColorPatch",
    "Confidence",
    "Differences",
    "DifferentialDriveRobot",
    "DifferentialKinematics",
    "Disc",
    "ExponentialTracking",
    "FieldDStar",
    "Flatness",
    "ForceField",
    "ForceTerms",
    "FullSpeedTracking",
    "GainConstraint",
    "GainGradient",
    "GainSearch",
    "GainSensitivity",
    "GeCui",
    "HolonomicRobot",
    "HrsafetyError",
    "Human",
    "InvalidParameterError",
    "Kalman",
    "Khatib",
    "Law",
    "LineReference",
    "LocalSearch",
    "Lyapunov",
    "Masoud",
    "Measurement",
    "MovingDisc",
    "NonlinearTracking",
    "Observation",
    "Obstacle",
    "OmniKinematics",
    "OpenLoopTest",
    "OptimalReciprocalCollisionAvoidance",
    "ParetoFront",
    "PathReference",
    "Performance",
    "PoseFusion",
    "PositionNoise",
    "RapidlyExploringRandomTree",
    "Rectangle",
    "Reference",
    "ReferenceMotion",
    "Regions",
    "Repeated",
    "Scenario",
    "SearchRound",
    "SearchSettings",
    "ShapeError",
    "SimulationError",
    "Slip",
    "Standing",
    "TrackedPositions",
    "Tracking",
    "TrackingRun",
    "TrackingSummary",
    "Trajectory",
    "Twist",
    "VelocityObstacle",
    "VirtualForceField",
    "VirtualImpedanceLaw",
    "VirtualTorque",
    "Vision",
    "WheelDrive",
    "WheelFit",
    "WheelReference",
    "WheelRun",
    "arena",
    "calibrate_camera",
    "calibration_points",
    "calibration_study",
    "command",
    "evaluate",
    "evaluate_built",
    "follow_wheel",
    "force_field",
    "force_terms",
    "gain_gradient",
    "gain_sensitivity",
    "identify_wheel",
    "lyapunov",
    "nearest_rotation",
    "observe",
    "open_loop_tests",
    "optimize_gains",
    "pareto_front",
    "patch_places",
    "region_radii",
    "repeat",
    "simulate",
    "simulate_batch",
    "simulate_built",
    "step_cost",
    "track",
    "track_batch",
    "track_positions",
]
