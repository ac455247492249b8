"""The robot that follows a sound: its parameters, and what is recorded of a run."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, flag, instance, numbers
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.navigation.sensing.vision import Vision
from hrsafety.reactive.follower.scenes import FollowerScene
from hrsafety.reactive.sonar.echoes import Sonar
from hrsafety.tables import Columns, Table, each, plane

__all__ = [
    "FixDeviations",
    "Follower",
    "FollowerRun",
    "fix_deviations",
]

_DRIVE = ("mass", "body_radius", "wheel_base", "wheel_speed", "heading_gain", "least_speed")
_ATTRACTION = ("attraction_stiffness", "attraction_damping", "standoff")


@dataclass(frozen=True, kw_only=True, slots=True)
class Follower(Parameters):
    """Differential-drive robot that follows a sound.

    A virtual velocity V integrates (F_m + F_b)/M_s with the attraction
    F_m = K_r (X_r - X_s) - D_r V, (18) of Avi (2019); the wheels follow it with the turning speed
    gain * (angle of V - heading) and the speed ``|V| max(cos(angle of V - heading), 0)``. Between two
    bursts the target X_r stays where the last one put it. Body, sensors, gain and standoff are
    not in the source; the mass, the wheels and the attraction are.

    Parameters
    ----------
    sonar : Sonar
        Its ultrasonic sensors.
    obstacle_vision : Vision or None
        A camera that tells of the obstacles in place of the sonar: the impedance acts between the
        surface of the body and the nearest point of every obstacle that is within the range of the
        sonar, all around.
    mass : float
        M_s in kg.
    body_radius : float
        Radius of the disc that models the body, in m.
    wheel_base : float
        Distance between the wheels, in m.
    wheel_speed : float
        Largest speed of a wheel, and of the virtual velocity, in m/s.
    heading_gain : float
        In 1/s.
    least_speed : float
        Virtual speed below which the robot does not turn, in m/s.
    attraction_stiffness, attraction_damping : float
        K_r in N/m, D_r in N s/m.
    standoff : float
        Distance of the target from the source, in m.
    fix_interval : float
        Time between two bursts, in s.
    fix_noise : bool
        Range and bearing scatter as in Table 2 of Avi (2019), `fix_deviations`.
    mirrored_fixes : bool
        A source behind the microphones is taken for one in front.
    velocity_rule : str
        ``"integrated"``, or ``"reset"``: V starts every step from the velocity of the robot.
    integration : str
        ``"chord"``, as the source: the robot moves along the chord of the arc by the length of the arc;
        or ``"arc"``: along the exact arc, as the two-wheel robot of `hrsafety.navigation` does.
    step : float
        Control period in s.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.Follower(standoff=1.2).mass
    3.94
    """

    sonar: Sonar = field(default_factory=Sonar)
    obstacle_vision: Vision | None = None
    mass: float = 3.94
    body_radius: float = 0.25
    wheel_base: float = 0.41
    wheel_speed: float = 0.72
    heading_gain: float = 4.0
    least_speed: float = 0.02
    attraction_stiffness: float = 2.0
    attraction_damping: float = 1.0
    standoff: float = 0.9
    fix_interval: float = 2.0
    fix_noise: bool = True
    mirrored_fixes: bool = False
    velocity_rule: Literal["integrated", "reset"] = "integrated"
    integration: Literal["chord", "arc"] = "chord"
    step: float = 0.025
    _native: _hrsafety.Follower = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        values = self._as_numbers(*_DRIVE, *_ATTRACTION, "fix_interval", "step")
        stiffness, damping, standoff = (values[name] for name in _ATTRACTION)
        vision = self.obstacle_vision
        self._set(
            _native=_hrsafety.Follower(
                sonar=instance("sonar", self.sonar, Sonar)._native,
                obstacle_vision=None if vision is None else instance("obstacle_vision", vision, Vision)._native,
                drive=[values[name] for name in _DRIVE],
                attraction=(stiffness, damping, standoff),
                fix_interval=values["fix_interval"],
                fix_noise=flag("fix_noise", self.fix_noise),
                mirrored_fixes=flag("mirrored_fixes", self.mirrored_fixes),
                velocity_rule=str(self.velocity_rule),
                integration=str(self.integration),
                step=values["step"],
            )
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class FollowerRun(Table):
    """One run of the follower: a row for every control period, the last one at the end.

    Attributes
    ----------
    time : ndarray of shape (n,)
        In s.
    position, heading : ndarray of shape (n, 2), (n,)
        In m and rad.
    virtual_velocity : ndarray of shape (n, 2)
        V in m/s.
    wheel_speed : ndarray of shape (n, 2)
        (left, right) in m/s.
    target, source : ndarray of shape (n, 2)
        In m.
    attraction, repulsion : ndarray of shape (n, 2)
        F_m and F_b in N.
    readings : ndarray of shape (n, sensors)
        In m; infinite without an echo.
    clearance : ndarray of shape (n, obstacles)
        Distance between body and obstacles in m.
    shift : ndarray of shape (n, obstacles, 2)
        Obstacles from their first places, in m.
    contact_obstacle : int or None
        Index of the obstacle that was touched, also on the straight way between two periods: `clearance` shows the ends
        of it only.
    contact_bearing : float or None
        Direction of the touch from the front, counterclockwise, in rad.
    source_distance : float
        From the source at the end, in m.
    path_length, turning : float
        Way in m, and sum of all turns in rad.
    scene : FollowerScene
        What was around.
    follower : Follower
        The robot.
    """

    time: Annotated[Array, "s"]
    position: Annotated[Array, "m"]
    heading: Annotated[Array, "rad"]
    virtual_velocity: Annotated[Array, "m/s"]
    wheel_speed: Annotated[Array, "m/s"]
    target: Annotated[Array, "m"]
    source: Annotated[Array, "m"]
    attraction: Annotated[Array, "N"]
    repulsion: Annotated[Array, "N"]
    readings: Annotated[Array, "m"]
    clearance: Annotated[Array, "m"]
    shift: Annotated[Array, "m"]
    contact_obstacle: int | None
    contact_bearing: Annotated[float | None, "rad"]
    source_distance: Annotated[float, "m"]
    path_length: Annotated[float, "m"]
    turning: float
    scene: FollowerScene = field(repr=False)
    follower: Follower = field(repr=False)

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each control period.

        Returns
        -------
        dict of str to ndarray
            Units are in the names; sensors and obstacles are numbered.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> scene = reactive.FollowerScene(
        ...     leader=reactive.SoundLeader(start=(1.2, 0.0), end=(3.0, 0.0)),
        ...     obstacles=[reactive.Box(center=(1.5, 1.2), size=(0.5, 0.5))], duration=10.0,
        ... )
        >>> list(reactive.follow(scene).columns())[:4]
        ['t_s', 'x_m', 'y_m', 'heading_rad']
        """
        found = {"t_s": self.time, **plane("{}", self.position, "m"), "heading_rad": self.heading}
        found |= plane("virtual_v{}", self.virtual_velocity, "m/s")
        for index, side in enumerate(("left", "right")):
            found[f"wheel_{side}_m_per_s"] = self.wheel_speed[:, index]
        found |= plane("target_{}", self.target, "m") | plane("source_{}", self.source, "m")
        found |= plane("attraction_{}", self.attraction, "N") | plane("repulsion_{}", self.repulsion, "N")
        found |= each("reading_{}", self.readings, "m") | each("clearance_{}", self.clearance, "m")
        for index in range(self.shift.shape[1]):
            found |= plane(f"shift_{index}_{{}}", self.shift[:, index], "m")
        return found

    @property
    def body_radius(self) -> float:
        """Radius of the disc that models the body, in m."""
        return self.follower.body_radius

    @property
    def sonar(self) -> Sonar:
        """Ultrasonic sensors of the robot."""
        return self.follower.sonar

    @property
    def collided(self) -> bool:
        """Whether the robot touched an obstacle."""
        return self.contact_obstacle is not None

    @property
    def min_clearance(self) -> float:
        """Smallest distance between body and obstacles in m; infinite without obstacles."""
        return float(self.clearance.min(initial=np.inf))

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.time)


@displayed
class FixDeviations(NamedTuple):
    """Scatter of a fix.

    Attributes
    ----------
    range, bearing : ndarray
        Standard deviations in m and rad.
    """

    range: Annotated[Array, "m"]
    bearing: Annotated[Array, "rad"]


def fix_deviations(range: npt.ArrayLike, bearing: npt.ArrayLike) -> FixDeviations:
    """Return the scatter of a fix: Table 2 of Avi (2019), bilinear, its edges outside the table.

    Parameters
    ----------
    range : array_like, shape (n,)
        Distance of the source in m.
    bearing : array_like, shape (n,)
        Its direction from the front, in rad; the sign does not matter.

    Returns
    -------
    FixDeviations
        Standard deviations of range and bearing.

    Raises
    ------
    InvalidParameterError
        If an argument is not made of finite numbers.
    ShapeError
        If the two are not of one length.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.follower.fix_deviations([3.0, 3.5], [0.0, 0.0]).range.round(3).tolist()
    [0.09, 0.285]
    """
    distances, angles = numbers("range", range), numbers("bearing", bearing)
    if distances.ndim != 1:
        raise ShapeError("range", "(n,)", distances.shape)
    if angles.shape != distances.shape:
        raise ShapeError("bearing", f"({len(distances)},)", angles.shape)
    for name, array in (("range", distances), ("bearing", angles)):
        if not np.all(np.isfinite(array)):
            raise InvalidParameterError(name, "be finite", array)
    return FixDeviations(**_hrsafety.fix_deviations(distances, angles))
