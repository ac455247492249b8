"""Positions measured now and then, late and with errors."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Literal, NamedTuple

import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, count, flag, instance
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.sensing.camera import Camera
from hrsafety.navigation.sensing.estimators import Differences, Estimator, checked_estimator, measured_path

__all__ = ["ColorPatch", "Observation", "PositionError", "PositionNoise", "Vision", "observe"]


@dataclass(frozen=True, kw_only=True, slots=True)
class PositionNoise(Parameters):
    """Errors that are added to x and y of a position.

    Parameters
    ----------
    scale : float
        Standard deviation of x and y each, or half width for ``"uniform"``, in m. The default has
        the mean error of 4 mm of section D.4 of Zeng (2011); uniform with 0.025 m is the worst
        case.
    distribution : {"gaussian", "uniform"}
        Kind of error. A Gaussian error is drawn again beyond 8 standard deviations.

    Raises
    ------
    InvalidParameterError
        If the scale is negative or not finite, or the word is unknown.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.sensing.PositionNoise().scale
    0.0032
    """

    scale: float = 0.0032
    distribution: Literal["gaussian", "uniform"] = "gaussian"
    _native: _hrsafety.ErrorSource = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._as_numbers("scale")
        self._set(_native=_hrsafety.ErrorSource.plane(scale=self.scale, distribution=self.distribution))


@dataclass(frozen=True, kw_only=True, slots=True)
class ColorPatch(Parameters):
    """Errors of a color patch that a camera sees: its centroid has noise, the camera's errors stay.

    The patch at (x, y, height) is projected, noise is added to its pixel, and the position is
    reconstructed with what is believed about the camera (section D.5 of Zeng 2011). A patch outside
    the picture gives a lost frame.

    Parameters
    ----------
    height : float
        Height of the patch above the floor in m. The source gives none; a shoulder is at 1.4 m.
    centroid_deviation_px : float
        Standard deviation of each coordinate of the centroid, in pixels.
    camera : Camera
        The camera as it is.
    believed : Camera or None
        The camera as it was calibrated; ``None``: exactly as it is.

    Raises
    ------
    InvalidParameterError
        If a number is not finite or the deviation is negative.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.sensing.ColorPatch(height=0.3).centroid_deviation_px
    0.5
    """

    height: float
    centroid_deviation_px: float = 0.5
    camera: Camera = field(default_factory=Camera)
    believed: Camera | None = None
    _native: _hrsafety.ErrorSource = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._as_numbers("height", "centroid_deviation_px")
        instance("camera", self.camera, Camera)
        believed = self.camera if self.believed is None else instance("believed", self.believed, Camera)
        native = _hrsafety.ErrorSource.patch(
            camera=self.camera._native,
            believed=believed._native,
            height=self.height,
            centroid_deviation=self.centroid_deviation_px,
        )
        self._set(_native=native)


PositionError = PositionNoise | ColorPatch


@dataclass(frozen=True, kw_only=True, slots=True)
class Vision(Parameters):
    """How the position of a body is measured during a run.

    Frames are exposed at whole multiples of the period and known a delay later; some give nothing.
    The velocity is estimated; nothing else is known. Until the first frame is known, what moves is taken to
    be absent: results carry the warning ``"unseen_at_start"`` where the robot may be unable to stop then.
    Defaults are the vision of the source (section 6.2.2 and appendix D.4 of Zeng 2011); it states neither
    delay nor lost frames.

    Parameters
    ----------
    period : float
        Time between two exposures in s; 16.7 frames per second.
    delay : float
        Time from an exposure until its position is known, in s.
    error : PositionNoise or ColorPatch
        Error of a measured position.
    drop_probability : float
        Probability that a frame gives no position, at least 0 and below 1.
    estimator : Differences, AlphaBeta or Kalman
        How position and velocity follow from measured positions.
    compensated : bool
        Whether the position is moved on from its exposure to the present with the velocity; it goes
        on for as long as frames are lost.

    Raises
    ------
    InvalidParameterError
        If a value is out of its range or of another kind.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> vision = nav.sensing.Vision(delay=0.05, estimator=nav.sensing.Kalman(), compensated=True)
    >>> round(1.0 / vision.period, 1)
    16.7
    """

    period: float = 1.0 / 16.7
    delay: float = 0.0
    error: PositionError = field(default_factory=PositionNoise)
    drop_probability: float = 0.0
    estimator: Estimator = field(default_factory=Differences)
    compensated: bool = False
    _native: _hrsafety.Vision = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        numbers = self._as_numbers("period", "delay", "drop_probability")
        self._set(compensated=flag("compensated", self.compensated))
        if not isinstance(self.error, PositionError):
            raise InvalidParameterError("error", "be a PositionNoise or a ColorPatch", self.error)
        native = _hrsafety.Vision(
            **numbers,
            error=self.error._native,
            estimator=checked_estimator(self.estimator)._native,
            compensated=self.compensated,
        )
        self._set(_native=native)


@displayed
class Observation(NamedTuple):
    """Measurements by a camera of a body on a known path, and what is known of it when.

    Attributes
    ----------
    exposed : ndarray of shape (frames,)
        Times of the exposures in s.
    measured : ndarray of shape (frames, 2)
        Measured positions in m; NaN for lost frames.
    position, velocity : ndarray of shape (n, 2)
        Estimates at the n times of the path, in m and m/s; NaN while nothing is known.
    measured_at : ndarray of shape (n,)
        Exposure of the last frame in each estimate, in s; NaN while nothing is known.
    """

    exposed: Annotated[Array, "s"]
    measured: Annotated[Array, "m"]
    position: Annotated[Array, "m"]
    velocity: Annotated[Array, "m/s"]
    measured_at: Annotated[Array, "s"]


def observe(
    vision: Vision, time: npt.ArrayLike, position: npt.ArrayLike, *, seed: int = 0, stream: int = 0
) -> Observation:
    """Return what is measured and known of a body on a known path.

    Parameters
    ----------
    vision : Vision
        How it is measured.
    time : array_like of shape (n,)
        Times of the path in s, rising, from zero or later.
    position : array_like of shape (n, 2)
        True positions in m, joined by straight lines.
    seed : int
        Seed of errors and lost frames, below 2^64.
    stream : int
        Which body: 0 the robot, 1 and on the obstacles, below 2^63.

    Returns
    -------
    Observation
        Frames and estimates.

    Raises
    ------
    InvalidParameterError
        If the times do not rise or are negative, or a number is not finite or out of range.
    ShapeError
        If a shape is wrong.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import navigation as nav
    >>> time = np.arange(101) * 0.01
    >>> vision = nav.sensing.Vision(delay=0.1, error=nav.sensing.PositionNoise(scale=0.0))
    >>> seen = nav.sensing.observe(vision, time, np.column_stack([1.2 * time, 0.0 * time]))
    >>> seen.velocity[-1].round(6).tolist()
    [1.2, 0.0]
    """
    instance("vision", vision, Vision)
    instants, places = measured_path(time, position, lost=False)
    if len(instants) and instants[0] < 0.0:
        raise InvalidParameterError("time", "not be negative", float(instants[0]))
    bounds = (("seed", seed, 2**64), ("stream", stream, 2**63))
    for name, value, bound in bounds:
        if count(name, value, least=0) >= bound:
            raise InvalidParameterError(name, f"be below {bound}", value)
    return Observation(**vision._native.observe(instants, places, int(seed), int(stream)))
