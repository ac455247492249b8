"""What robots know: noise and latency, cameras, sonar, estimators, calibration."""

from hrsafety.navigation.sensing.calibration import CameraCalibration, calibrate_camera
from hrsafety.navigation.sensing.calibration_study import (
    CalibrationStudy,
    calibration_points,
    calibration_study,
    patch_places,
)
from hrsafety.navigation.sensing.camera import Camera, nearest_rotation
from hrsafety.navigation.sensing.estimators import AlphaBeta, Differences, Kalman, TrackedPositions, track_positions
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.navigation.sensing.measurement import Measurement
from hrsafety.navigation.sensing.robot_sensor import RobotSensor
from hrsafety.navigation.sensing.ultrasonic import Ultrasonic
from hrsafety.navigation.sensing.vision import ColorPatch, Observation, PositionNoise, Vision, observe

__all__ = [
    "AlphaBeta",
    "CalibrationStudy",
    "Camera",
    "CameraCalibration",
    "ColorPatch",
    "Differences",
    "Kalman",
    "Lidar",
    "Measurement",
    "Observation",
    "PositionNoise",
    "RobotSensor",
    "TrackedPositions",
    "Ultrasonic",
    "Vision",
    "calibrate_camera",
    "calibration_points",
    "calibration_study",
    "nearest_rotation",
    "observe",
    "patch_places",
    "track_positions",
]
