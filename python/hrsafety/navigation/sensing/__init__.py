"""What robots know: noise and latency, cameras, sonar, estimators, calibration."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.navigation.sensing.calibration import CameraCalibration, calibrate_camera
    from hrsafety.navigation.sensing.calibration_trials import (
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

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.navigation.sensing.calibration": "CameraCalibration calibrate_camera",
            "hrsafety.navigation.sensing.calibration_trials": (
                "CalibrationStudy calibration_points calibration_study patch_places"
            ),
            "hrsafety.navigation.sensing.camera": "Camera nearest_rotation",
            "hrsafety.navigation.sensing.estimators": ("AlphaBeta Differences Kalman TrackedPositions track_positions"),
            "hrsafety.navigation.sensing.lidar": "Lidar",
            "hrsafety.navigation.sensing.measurement": "Measurement",
            "hrsafety.navigation.sensing.robot_sensor": "RobotSensor",
            "hrsafety.navigation.sensing.ultrasonic": "Ultrasonic",
            "hrsafety.navigation.sensing.vision": "ColorPatch Observation PositionNoise Vision observe",
        },
    )
