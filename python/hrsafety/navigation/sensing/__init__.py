"""Sensing of robots: noise and latency, cameras, sonar, estimators, calibration."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.navigation.sensing.calibration import (
        CameraCalibration as CameraCalibration,
        calibrate_camera as calibrate_camera,
    )
    from hrsafety.navigation.sensing.calibration_trials import (
        CalibrationStudy as CalibrationStudy,
        calibration_points as calibration_points,
        calibration_study as calibration_study,
        patch_places as patch_places,
    )
    from hrsafety.navigation.sensing.camera import Camera as Camera, nearest_rotation as nearest_rotation
    from hrsafety.navigation.sensing.estimators import (
        AlphaBeta as AlphaBeta,
        Differences as Differences,
        Kalman as Kalman,
        TrackedPositions as TrackedPositions,
        track_positions as track_positions,
    )
    from hrsafety.navigation.sensing.lidar import Lidar as Lidar
    from hrsafety.navigation.sensing.measurement import Measurement as Measurement
    from hrsafety.navigation.sensing.odometry import Odometry as Odometry
    from hrsafety.navigation.sensing.robot_sensor import RobotSensor as RobotSensor
    from hrsafety.navigation.sensing.sound_localizer import SoundLocalizer as SoundLocalizer
    from hrsafety.navigation.sensing.ultrasonic import Ultrasonic as Ultrasonic
    from hrsafety.navigation.sensing.vision import (
        ColorPatch as ColorPatch,
        Observation as Observation,
        PositionNoise as PositionNoise,
        Vision as Vision,
        observe as observe,
    )
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
