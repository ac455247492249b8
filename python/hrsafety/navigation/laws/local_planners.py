"""Laws that run on robots: they choose a twist from what is around now, on the way to the goal."""

from __future__ import annotations

from hrsafety._records import dataclass
from hrsafety.navigation.laws.declared import gain, law
from hrsafety.navigation.laws.twists import LocalPlanner, Prediction

__all__ = ["DWB", "DynamicWindow", "PathIntegral", "RegulatedPurePursuit"]


@law("dynamic_window", "dwa", color="#DDCC77", plans=True)
@dataclass(frozen=True, kw_only=True, slots=True)
class DynamicWindow(LocalPlanner):
    """Dynamic window of Fox, Burgard and Thrun (1997), without smoothing.

    Of 11 speeds and 21 turn rates within reach in a control period, those are admissible with which the robot can
    still stop before the first contact on its arc. The best weighs the heading to the (local) goal, the distance that
    is free, and the speed. A robot with two wheels takes the twist up; any other keeps a heading for the law. Weights
    are recalled from the paper and were not checked against it.

    Parameters
    ----------
    heading : float
        Weight of the heading.
    dist : float
        Weight of the distance that is free.
    velocity : float
        Weight of the speed.
    acceleration : float
        Largest acceleration, which sets the window, in m/s^2.
    braking : float
        Deceleration with which a speed is admissible, in m/s^2.
    turn_acceleration : float
        Largest change of the turn rate, in rad/s^2.
    turn_braking : float
        Deceleration with which a turn rate is admissible, in rad/s^2.
    max_turn_rate : float
        Largest turn rate, in rad/s.
    prediction : {"static", "constant_velocity"}
        Whether people stand (``"static"``, as in Nav2) or keep their velocities (``"constant_velocity"``).

    Raises
    ------
    InvalidParameterError
        If a number is not finite or out of range, or a word is unknown.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> scene = nav.Scenario(start=(0, 0), goal=(4, 0.5), obstacles=[nav.Disc(center=(2, 0.6), radius=0.2)])
    >>> nav.simulate(scene, nav.DynamicWindow()).outcome
    'arrived'
    """

    heading: float = gain(2.0, unit="", bounds=(0.0, 5.0), symbol="h")
    dist: float = gain(0.2, unit="", bounds=(0.0, 5.0), symbol="d")
    velocity: float = gain(0.2, unit="", bounds=(0.0, 5.0), symbol="s")
    acceleration: float = gain(1.0, unit="m/s^2", bounds=(0.2, 5.0), symbol="a")
    braking: float = gain(1.0, unit="m/s^2", bounds=(0.2, 5.0), symbol="b")
    turn_acceleration: float = gain(3.0, unit="rad/s^2", bounds=(0.5, 10.0), symbol="alpha")
    turn_braking: float = gain(3.0, unit="rad/s^2", bounds=(0.5, 10.0), symbol="beta")
    max_turn_rate: float = gain(1.5, unit="rad/s", bounds=(0.3, 3.0), symbol="omega")
    prediction: Prediction = "static"


@law("dwb", color="#661100", plans=True)
@dataclass(frozen=True, kw_only=True, slots=True)
class DWB(LocalPlanner):
    """DWB, the local planner of Nav2 that scores sampled twists by critics, by Nav2's names.

    Twists within reach in ``sim_time`` are followed; the least score without a contact wins. Distances are exact,
    those of Nav2 are of cells: commands are near Nav2's, not equal to them. ``RotateToGoal`` and ``Oscillation`` are
    left out, for goals have no heading.

    Parameters
    ----------
    max_vel_x : float
        Largest velocity forward, in m/s.
    max_vel_theta : float
        Largest turn rate, in rad/s.
    max_speed_xy : float
        Largest speed, in m/s.
    acc_lim_x : float
        Largest acceleration forward, in m/s^2.
    acc_lim_theta : float
        Largest rise of the turn rate, in rad/s^2.
    sim_time : float
        Length of a trajectory, in s.
    obstacle_scale : float
        Weight ``BaseObstacle.scale`` of what a gap costs.
    path_dist_scale : float
        Weight ``PathDist.scale`` of the distance from the way.
    goal_dist_scale : float
        Weight ``GoalDist.scale`` of the distance from the local goal.
    path_align_scale : float
        Weight ``PathAlign.scale`` of the distance of a point ahead from the way.
    goal_align_scale : float
        Weight ``GoalAlign.scale`` of the distance of a point ahead from one ahead of the local goal.
    forward_point_distance : float
        How far ahead those points are, in m.
    cost_scaling_factor : float
        How fast the cost of a gap falls, in 1/m.
    inflation_radius : float
        Distance of the center of the robot beyond which nothing costs, in m.
    min_vel_x : float
        Least velocity forward, in m/s.
    min_vel_y : float
        Least velocity to the left, in m/s.
    max_vel_y : float
        Largest velocity to the left, in m/s.
    min_speed_xy : float
        Slower twists that also turn slower than ``min_speed_theta`` are left out, in m/s.
    min_speed_theta : float
        See ``min_speed_xy``, in rad/s.
    acc_lim_y : float
        Largest acceleration to the left, in m/s^2.
    decel_lim_x : float
        Deceleration forward, negative, in m/s^2.
    decel_lim_y : float
        Deceleration to the left, not positive, in m/s^2.
    decel_lim_theta : float
        Fall of the turn rate, negative, in rad/s^2.
    linear_granularity : float
        Way of a step of a trajectory, at most, in m.
    angular_granularity : float
        Turn of a step of a trajectory, at most, in rad.
    vx_samples : int
        Velocities forward that are tried.
    vy_samples : int
        Velocities to the left that are tried.
    vtheta_samples : int
        Turn rates that are tried.
    prediction : {"static", "constant_velocity"}
        Whether people stand (``"static"``, as in Nav2) or keep their velocities (``"constant_velocity"``).

    Raises
    ------
    InvalidParameterError
        If a number is not finite or out of range, or a word is unknown.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> choice = nav.DWB(max_vel_x=0.5, max_speed_xy=0.5).choose(pose=(0, 0, 0), goal=(3, 0))
    >>> round(choice.forward, 2), choice.mode
    (0.5, 'track')
    """

    max_vel_x: float = gain(0.26, unit="m/s", bounds=(0.1, 2.0))
    max_vel_theta: float = gain(1.0, unit="rad/s", bounds=(0.3, 3.0))
    max_speed_xy: float = gain(0.26, unit="m/s", bounds=(0.1, 2.0))
    acc_lim_x: float = gain(2.5, unit="m/s^2", bounds=(0.2, 5.0))
    acc_lim_theta: float = gain(3.2, unit="rad/s^2", bounds=(0.5, 10.0))
    sim_time: float = gain(1.7, unit="s", bounds=(0.5, 3.0))
    obstacle_scale: float = gain(0.02, unit="", bounds=(0.0, 1.0))
    path_dist_scale: float = gain(32.0, unit="", bounds=(0.0, 100.0))
    goal_dist_scale: float = gain(24.0, unit="", bounds=(0.0, 100.0))
    path_align_scale: float = gain(32.0, unit="", bounds=(0.0, 100.0))
    goal_align_scale: float = gain(24.0, unit="", bounds=(0.0, 100.0))
    forward_point_distance: float = gain(0.1, unit="m", bounds=(0.0, 1.0))
    cost_scaling_factor: float = gain(3.0, unit="1/m", bounds=(0.5, 10.0))
    inflation_radius: float = gain(0.55, unit="m", bounds=(0.1, 2.0))
    min_vel_x: float = 0.0
    min_vel_y: float = 0.0
    max_vel_y: float = 0.0
    min_speed_xy: float = 0.0
    min_speed_theta: float = 0.0
    acc_lim_y: float = 0.0
    decel_lim_x: float = -2.5
    decel_lim_y: float = 0.0
    decel_lim_theta: float = -3.2
    linear_granularity: float = 0.05
    angular_granularity: float = 0.025
    vx_samples: int = 20
    vy_samples: int = 5
    vtheta_samples: int = 20
    prediction: Prediction = "static"


@law("regulated_pure_pursuit", "rpp", "pure_pursuit", color="#6699CC", plans=True)
@dataclass(frozen=True, kw_only=True, slots=True)
class RegulatedPurePursuit(LocalPlanner):
    """Regulated pure pursuit of Macenski et al. (2023), by Nav2's names.

    The robot drives on the circle to a carrot ahead on its way, slower on tight curves, near obstacles and before the
    end, and stands where the next second leads into a contact. It does not lead around anything: a guide does.
    Distances are exact, those of Nav2 are of cells: commands are near Nav2's, not equal to them.

    Parameters
    ----------
    desired_linear_vel : float
        Speed on a free, straight way, in m/s.
    lookahead_dist : float
        Distance of the carrot, in m.
    lookahead_time : float
        The same as a time, for ``use_velocity_scaled_lookahead_dist``, in s.
    curvature_lookahead_dist : float
        Distance of the point that gives the curvature, for ``use_fixed_curvature_lookahead``, in m.
    rotate_to_heading_angular_vel : float
        Turn rate in place, in rad/s.
    rotate_to_heading_min_angle : float
        Bearing of the carrot beyond which the robot turns in place, in rad.
    max_angular_accel : float
        Largest change of that turn rate, in rad/s^2.
    min_approach_linear_velocity : float
        Least speed near the end of the way, in m/s.
    approach_velocity_scaling_dist : float
        A shorter way slows the robot, in m.
    regulated_linear_scaling_min_radius : float
        Tighter curves slow the robot, in m.
    regulated_linear_scaling_min_speed : float
        Least speed on curves and near obstacles, in m/s.
    cost_scaling_dist : float
        Nearer obstacles slow the robot, in m.
    cost_scaling_gain : float
        By which factor.
    min_lookahead_dist : float
        Least distance of a carrot by time, in m.
    max_lookahead_dist : float
        Largest distance of a carrot by time, in m.
    inflation_radius : float
        Distance of the center of the robot beyond which obstacles do not slow it, in m.
    max_allowed_time_to_collision_up_to_carrot : float
        How far ahead contacts are looked for, in s.
    use_velocity_scaled_lookahead_dist : bool
        Whether the carrot is a time ahead.
    use_fixed_curvature_lookahead : bool
        Whether a point of its own gives the curvature.
    use_regulated_linear_velocity_scaling : bool
        Whether curves slow the robot.
    use_cost_regulated_linear_velocity_scaling : bool
        Whether obstacles slow it.
    use_rotate_to_heading : bool
        Whether it turns in place to a carrot at the side.
    use_collision_detection : bool
        Whether it stands where the next second leads into a contact.
    allow_reversing : bool
        Whether it drives back to a carrot behind it; not beside ``use_rotate_to_heading``.
    prediction : {"static", "constant_velocity"}
        Whether people stand (``"static"``, as in Nav2) or keep their velocities (``"constant_velocity"``).

    Raises
    ------
    InvalidParameterError
        If a number is not finite or out of range, or a word is unknown.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> scene = nav.Scenario(start=(0, 0), goal=(3, 1), obstacles=[])
    >>> nav.simulate(scene, nav.RegulatedPurePursuit()).outcome
    'arrived'
    """

    desired_linear_vel: float = gain(0.5, unit="m/s", bounds=(0.25, 2.0))
    lookahead_dist: float = gain(0.6, unit="m", bounds=(0.2, 2.0))
    lookahead_time: float = gain(1.5, unit="s", bounds=(0.3, 3.0))
    curvature_lookahead_dist: float = gain(0.6, unit="m", bounds=(0.2, 2.0))
    rotate_to_heading_angular_vel: float = gain(1.8, unit="rad/s", bounds=(0.3, 3.0))
    rotate_to_heading_min_angle: float = gain(0.785, unit="rad", bounds=(0.1, 3.0))
    max_angular_accel: float = gain(3.2, unit="rad/s^2", bounds=(0.5, 10.0))
    min_approach_linear_velocity: float = gain(0.05, unit="m/s", bounds=(0.01, 0.3))
    approach_velocity_scaling_dist: float = gain(0.6, unit="m", bounds=(0.1, 2.0))
    regulated_linear_scaling_min_radius: float = gain(0.9, unit="m", bounds=(0.1, 3.0))
    regulated_linear_scaling_min_speed: float = gain(0.25, unit="m/s", bounds=(0.01, 0.25))
    cost_scaling_dist: float = gain(0.6, unit="m", bounds=(0.3, 2.0))
    cost_scaling_gain: float = gain(1.0, unit="", bounds=(0.1, 1.0))
    min_lookahead_dist: float = 0.3
    max_lookahead_dist: float = 0.9
    inflation_radius: float = 0.55
    max_allowed_time_to_collision_up_to_carrot: float = 1.0
    use_velocity_scaled_lookahead_dist: bool = False
    use_fixed_curvature_lookahead: bool = False
    use_regulated_linear_velocity_scaling: bool = True
    use_cost_regulated_linear_velocity_scaling: bool = True
    use_rotate_to_heading: bool = True
    use_collision_detection: bool = True
    allow_reversing: bool = False
    prediction: Prediction = "static"


@law("path_integral", "mppi", color="#AA4466", plans=True)
@dataclass(frozen=True, kw_only=True, slots=True)
class PathIntegral(LocalPlanner):
    """Model predictive path integral control (MPPI) of Williams et al. (2017), with critics after Nav2's.

    Samples of controls around the plan are followed and weighed by what they cost; their mean is the new plan. Draws
    are Philox4x32-10 of seed, call, sample and step, so that any number of threads gives the same bits. Left out of
    Nav2: smoothing of the plan, ConstraintCritic, GoalAngle, Twirling, occupancy of the path, retries and delays.
    Distances are exact, those of Nav2 are of cells: commands are near Nav2's, not equal to them.

    Parameters
    ----------
    vx_max : float
        Largest velocity forward, in m/s.
    wz_max : float
        Largest turn rate, in rad/s.
    vx_std : float
        Standard deviation of the draws forward, in m/s.
    wz_std : float
        Standard deviation of the drawn turn rates, in rad/s.
    temperature : float
        The lower, the more the best samples count.
    gamma : float
        Weight of the change of the plan.
    cost_weight : float
        Weight of what gaps cost.
    goal_weight : float
        Weight of the distance from the goal, near it.
    path_align_weight : float
        Weight of the distance from the way.
    path_follow_weight : float
        Weight of how far the last pose is from one farther on the way.
    path_angle_weight : float
        Weight of where the last pose looks.
    prefer_forward_weight : float
        Weight of driving back.
    vx_min : float
        Least velocity forward, in m/s.
    vy_max : float
        Largest velocity to both sides; 0: none is drawn, in m/s.
    ax_max : float
        Largest acceleration forward and back, in m/s^2.
    ay_max : float
        Largest acceleration to both sides, in m/s^2.
    az_max : float
        Largest change of the turn rate, in rad/s^2.
    vy_std : float
        Standard deviation of the draws to both sides, in m/s.
    model_dt : float
        Length of a step, in s.
    cost_scaling_factor : float
        How fast the cost of a gap falls, in 1/m.
    inflation_radius : float
        Distance of the center of the robot beyond which nothing costs, in m.
    batch_size : int
        Samples of a call.
    time_steps : int
        Steps of a sample.
    prediction : {"static", "constant_velocity"}
        Whether people stand (``"static"``, as in Nav2) or keep their velocities (``"constant_velocity"``).

    Raises
    ------
    InvalidParameterError
        If a number is not finite or out of range, or a word is unknown.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> choice = nav.PathIntegral(vx_max=1.0).choose(pose=(0, 0, 0), goal=(4, 0), seed=3)
    >>> choice.mode, choice.plan.shape
    ('track', (28, 3))
    """

    vx_max: float = gain(0.5, unit="m/s", bounds=(0.2, 2.0))
    wz_max: float = gain(1.9, unit="rad/s", bounds=(0.3, 3.0))
    vx_std: float = gain(0.2, unit="m/s", bounds=(0.02, 1.0))
    wz_std: float = gain(0.4, unit="rad/s", bounds=(0.05, 1.5))
    temperature: float = gain(0.3, unit="", bounds=(0.05, 2.0))
    gamma: float = gain(0.015, unit="", bounds=(0.0, 0.2))
    cost_weight: float = gain(3.81, unit="", bounds=(0.0, 20.0))
    goal_weight: float = gain(5.0, unit="", bounds=(0.0, 20.0))
    path_align_weight: float = gain(10.0, unit="", bounds=(0.0, 40.0))
    path_follow_weight: float = gain(5.0, unit="", bounds=(0.0, 20.0))
    path_angle_weight: float = gain(2.2, unit="", bounds=(0.0, 10.0))
    prefer_forward_weight: float = gain(5.0, unit="", bounds=(0.0, 20.0))
    vx_min: float = -0.35
    vy_max: float = 0.0
    ax_max: float = 3.0
    ay_max: float = 3.0
    az_max: float = 3.5
    vy_std: float = 0.2
    model_dt: float = 0.1
    cost_scaling_factor: float = 3.0
    inflation_radius: float = 0.55
    batch_size: int = 256
    time_steps: int = 28
    prediction: Prediction = "static"
