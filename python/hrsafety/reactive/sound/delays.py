"""Delays between microphones from samples: mean square difference, correlation, GCC-PHAT."""

from __future__ import annotations

from typing import Annotated, Literal, NamedTuple

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, count, flag, instance, pair, word
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.reactive.sound.microphones import MicrophoneArray
from hrsafety.reactive.sound.recording import SoundRecording

__all__ = ["DelayMethod", "Delays", "Likeness", "estimate_delays", "likeness"]

DelayMethod = Literal["cross_correlation", "mean_square", "phase"]
METHODS = ("cross_correlation", "mean_square", "phase")
Options = tuple[str, list[float] | None, bool, int | None, int | None]


@displayed
class Delays(NamedTuple):
    """Delays of M2 and M3 against M1.

    Attributes
    ----------
    delay_12, delay_13 : float
        dt_12 and dt_13 in s, positive when M1 receives it first; NaN when a channel is constant.
    lag_12, lag_13 : int
        Lags of the best values, in whole samples; 0 when a channel is constant.
    coefficient_12, coefficient_13 : float
        Correlation coefficients of the channels at these lags, from -1 to 1.
    window_start : int
        First sample of the window that was compared.
    """

    delay_12: Annotated[float, "s"]
    delay_13: float
    lag_12: int
    lag_13: int
    coefficient_12: float
    coefficient_13: float
    window_start: int


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Likeness:
    """How alike M1 and another microphone are at every lag.

    Attributes
    ----------
    method : str
        What was compared, see `estimate_delays`.
    sample_rate : float
        In Hz.
    lags_12, lags_13 : ndarray of int
        Lags of M2 and M3 against M1, in samples.
    values_12, values_13 : ndarray
        Mean square difference (small is alike), mean product, or correlation of the phases.
    """

    method: str
    sample_rate: Annotated[float, "Hz"]
    lags_12: np.ndarray[tuple[int, ...], np.dtype[np.int64]]
    lags_13: np.ndarray[tuple[int, ...], np.dtype[np.int64]]
    values_12: Array
    values_13: Array

    @property
    def similarity_12(self) -> Array:
        """Similarity 1 / (mean square difference) of M1 and M2, by (5); only for that method."""
        return self._similarity(self.values_12)

    @property
    def similarity_13(self) -> Array:
        """Similarity 1 / (mean square difference) of M1 and M3, by (5); only for that method."""
        return self._similarity(self.values_13)

    def _similarity(self, values: Array) -> Array:
        if self.method != "mean_square":
            raise InvalidParameterError("method", 'be "mean_square" for a similarity', self.method)
        with np.errstate(divide="ignore"):
            return np.asarray(1.0 / values)


def estimate_delays(
    recording: SoundRecording,
    array: MicrophoneArray,
    *,
    method: DelayMethod = "cross_correlation",
    between_samples: bool = True,
    band: Pair | None = None,
    window: int | None = None,
    window_start: int | None = None,
) -> Delays:
    """Return how much later than M1 the microphones M2 and M3 receive a sound.

    Lags are signed and end two samples beyond what the spacing allows: ceil(l f_s / c) + 2 for M2,
    twice that for M3. Each channel is taken without its mean. With ``"mean_square"`` the mean of
    (x_1(k) - x_i(k + j))^2 over the overlap is smallest, corrected (5): its inverse, the similarity,
    would be 1/0 for equal signals. ``"cross_correlation"``, the mean of x_1(k) x_i(k + j) by FFT,
    finds the same lags, since sum (x - y)^2 = E_x + E_y - 2 R_xy, and is faster. ``"phase"`` is
    GCC-PHAT (Knapp and Carter, 1976).

    Parameters
    ----------
    recording : SoundRecording
        Samples of the microphones.
    array : MicrophoneArray
        The microphones; only lags that it can have are searched.
    method : str
        ``"cross_correlation"``, ``"mean_square"`` or ``"phase"``.
    between_samples : bool
        Whether a parabola through three values places the peak between samples; whole samples as in
        (6) otherwise.
    band : (float, float) or None
        For ``"phase"``: frequencies in Hz whose phases count; all of them when ``None``.
    window : int or None
        Samples that are compared, such as 4096, at most 4194304; all of them when ``None``.
    window_start : int or None
        First sample of the window; where the sound is loudest when ``None``.

    Returns
    -------
    Delays
        In s, with lags and correlation coefficients.

    Raises
    ------
    InvalidParameterError
        If an option is out of range, or the window not longer than the lags.
    KeyboardInterrupt
        Soon after Ctrl-C, at the latest when a transform has ended.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> row = reactive.MicrophoneArray()
    >>> heard = reactive.record_burst(reactive.Burst(duration=0.05), row, range=2.0, bearing=0.5)
    >>> found = reactive.estimate_delays(heard, row)
    >>> found.lag_12, found.lag_13
    (-65, -111)
    >>> fix = reactive.locate(row, delay_12=found.delay_12, delay_13=found.delay_13)
    >>> abs(fix.range - 2.0) < 0.02 and abs(fix.bearing - 0.5) < 0.001
    True
    """
    own, options = _checked(recording, array, method, between_samples, band, window, window_start)
    found = _hrsafety.sound_delays(array._native, own.samples, own.sample_rate, options)
    (delay_12, delay_13), (lag_12, lag_13) = found["delays"], found["lags"]
    first, second = found["likeness"]
    return Delays(delay_12, delay_13, lag_12, lag_13, first, second, found["start"])


def likeness(
    recording: SoundRecording,
    array: MicrophoneArray,
    *,
    method: DelayMethod = "cross_correlation",
    band: Pair | None = None,
    window: int | None = None,
    window_start: int | None = None,
) -> Likeness:
    """Return how alike M1 is to M2 and to M3 at every lag that `estimate_delays` searches.

    Parameters
    ----------
    recording : SoundRecording
        Samples of the microphones.
    array : MicrophoneArray
        The microphones.
    method, band, window, window_start
        As for `estimate_delays`.

    Returns
    -------
    Likeness
        Lags and values.

    Raises
    ------
    InvalidParameterError
        If an option is out of range, or the window not longer than the lags.
    KeyboardInterrupt
        Soon after Ctrl-C, at the latest when a transform has ended.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> row = reactive.MicrophoneArray()
    >>> heard = reactive.record_burst(reactive.Burst(duration=0.05), row, range=2.0, bearing=0.5)
    >>> curve = reactive.sound.likeness(heard, row, method="mean_square")
    >>> int(curve.lags_12[curve.values_12.argmin()]), len(curve.lags_12), len(curve.lags_13)
    (-65, 241, 481)
    """
    own, options = _checked(recording, array, method, True, band, window, window_start)
    found = _hrsafety.likeness_curves(array._native, own.samples, own.sample_rate, options)
    first, second = (np.arange(len(found[name])) - len(found[name]) // 2 for name in ("values_12", "values_13"))
    return Likeness(
        method=method,
        sample_rate=own.sample_rate,
        lags_12=first,
        lags_13=second,
        values_12=found["values_12"],
        values_13=found["values_13"],
    )


def _checked(
    recording: SoundRecording,
    array: MicrophoneArray,
    method: str,
    between_samples: bool,
    band: Pair | None,
    window: int | None,
    window_start: int | None,
) -> tuple[SoundRecording, Options]:
    instance("array", array, MicrophoneArray)
    options = delay_options(method, between_samples, band, window, window_start)
    return instance("recording", recording, SoundRecording), options


def delay_options(
    method: str, between_samples: bool, band: Pair | None, window: int | None, window_start: int | None
) -> Options:
    """Return how delays are found, as the core takes it."""
    chosen = word("method", method, METHODS)
    if band is not None and chosen != "phase":
        raise InvalidParameterError("band", 'be None unless the method is "phase"', band)
    if window_start is not None and window is None:
        raise InvalidParameterError("window_start", "be None without a window", window_start)
    return (
        chosen,
        None if band is None else list(pair("band", band)),
        flag("between_samples", between_samples),
        None if window is None else count("window", window),
        None if window_start is None else count("window_start", window_start, least=0),
    )
