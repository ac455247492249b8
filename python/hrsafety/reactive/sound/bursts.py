"""Sounds that a leader sends, and what three microphones and a converter make of them."""

from __future__ import annotations

from dataclasses import field
from typing import Literal

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters, checked_seed, count, instance, number, word
from hrsafety._bounds import MOST_RUNS
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.reactive.sound.microphones import MicrophoneArray
from hrsafety.reactive.sound.recording import SoundRecording

__all__ = ["Burst", "Converter", "doppler_frequency", "record_burst"]

BurstKind = Literal["noise", "sweep", "tone"]
KINDS = ("noise", "sweep", "tone")
Place = tuple[float, float, float, float, float, float, int | None]


@dataclass(frozen=True, kw_only=True, slots=True)
class Burst(Parameters):
    """A sound of limited length: band-limited noise, a sweep, or a tone.

    The source names neither the sound nor its loudness. Band, level and ramp are chosen here: a band
    that its microphones (50 Hz to 18 kHz) pass, and a level that uses the converter well from 1 to
    4 m. A tone of 1 kHz has a wave of 0.34 m, shorter than the spacing of the microphones, so most
    of its fixes are a wave off.

    Parameters
    ----------
    kind : str
        ``"noise"``: Gaussian noise between two frequencies; ``"sweep"``: a frequency that rises
        evenly from one to the other; ``"tone"``: one frequency.
    low, high : float
        Lowest and highest frequency, in Hz; equal for a tone.
    duration : float
        In s. The default is 46000 samples at 100 kHz.
    level : float
        Root mean square at 1 m from the source, as a share of the converter's full scale.
    ramp : float
        Time over which the sound begins and ends, in s.
    seed : int
        Seed of the noise that the burst consists of, 0 <= seed < 2**64.

    Raises
    ------
    InvalidParameterError
        If a value is out of range, or the kind unknown.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.Burst.tone(1000.0, duration=0.1).kind
    'tone'
    """

    kind: BurstKind = "noise"
    low: float = 500.0
    high: float = 8000.0
    duration: float = 0.46
    level: float = 0.2
    ramp: float = 0.005
    seed: int = 0
    _native: _hrsafety.Burst = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        values = self._as_numbers("low", "high", "duration", "level", "ramp")
        kind = word("kind", self.kind, KINDS)
        self._set(_native=_hrsafety.Burst(kind=kind, seed=checked_seed("seed", self.seed), **values))

    @classmethod
    def tone(cls, frequency: float, *, duration: float = 0.46, level: float = 0.2, ramp: float = 0.005) -> Burst:
        """Return a burst of one frequency.

        Parameters
        ----------
        frequency : float
            In Hz.
        duration, level, ramp : float
            As for the class.

        Returns
        -------
        Burst
            Of the kind ``"tone"``.

        Raises
        ------
        InvalidParameterError
            If a value is out of range.
        """
        pitch = number("frequency", frequency)
        return cls(kind="tone", low=pitch, high=pitch, duration=duration, level=level, ramp=ramp)


@dataclass(frozen=True, kw_only=True, slots=True)
class Converter(Parameters):
    """Analog-to-digital converter with a scale from -1 to 1.

    Parameters
    ----------
    sample_rate : float
        In Hz.
    bits : int or None
        2 to 32; with ``None`` samples are neither rounded nor limited.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.Converter()
    Converter(sample_rate=100000.0, bits=10)
    """

    sample_rate: float = 100e3
    bits: int | None = 10
    _native: _hrsafety.Converter = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        rate = self._as_numbers("sample_rate")["sample_rate"]
        if self.bits is not None and count("bits", self.bits, least=2) > 32:
            raise InvalidParameterError("bits", "be 2 to 32 or None", self.bits)
        self._set(_native=_hrsafety.Converter(sample_rate=rate, bits=self.bits))


def record_burst(
    burst: Burst,
    array: MicrophoneArray,
    *,
    range: float,
    bearing: float,
    converter: Converter | None = None,
    noise: float = 0.0,
    observer_speed: float = 0.0,
    source_speed: float = 0.0,
    lead: float = 0.005,
    samples: int | None = None,
    seed: int = 0,
) -> SoundRecording:
    """Return what three microphones receive of a burst.

    Microphone i receives ``s(f (t - R_i / c)) / R_i`` with R_i in m: the pressure falls with 1/R, its
    power with 1/R^2. The factor f of all frequencies is that of `doppler_frequency`, common to the
    three microphones, so that motion does not change the delays; ranges are those at the arrival.

    Parameters
    ----------
    burst : Burst
        The sound.
    array : MicrophoneArray
        The microphones.
    range : float
        Distance from M2, in m.
    bearing : float
        In rad.
    converter : Converter or None
        Default 100 kHz and 10 bits.
    noise : float
        Standard deviation of the white Gaussian noise of each sample, as a share of full scale.
    observer_speed, source_speed : float
        Speeds of microphones and source, positive when they close the distance, in m/s.
    lead : float
        Time from the first sample to the first arrival, in s; negative when the record begins within
        the burst.
    samples : int or None
        Samples of each channel; those from ``lead`` before the burst to ``lead`` after it when
        ``None``.
    seed : int
        Seed of the noise, 0 <= seed < 2**64.

    Returns
    -------
    SoundRecording
        Samples of M1, M2, M3.

    Raises
    ------
    InvalidParameterError
        If a value is out of range, the source stands on a microphone, or the converter is too slow
        for the burst.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> heard = reactive.record_burst(
    ...     reactive.Burst(duration=0.05), reactive.MicrophoneArray(), range=2.0, bearing=0.5, noise=0.01)
    >>> heard.samples.shape, heard.sample_rate
    ((3, 6236), 100000.0)
    """
    own = instance("converter", converter, Converter) if converter is not None else Converter()
    place = hearing(range, bearing, observer_speed, source_speed, noise, lead, samples)
    found = _hrsafety.record_burst(
        instance("burst", burst, Burst)._native,
        instance("array", array, MicrophoneArray)._native,
        own._native,
        place,
        seed=checked_seed("seed", seed),
        run=0,
    )
    first, second, third = found["clipped"]
    return SoundRecording(
        samples=found["samples"],
        sample_rate=own.sample_rate,
        clipped=(first, second, third),
    )


def doppler_frequency(
    frequency: float, *, observer_speed: float = 0.0, source_speed: float = 0.0, speed_of_sound: float = 340.0
) -> float:
    """Return the frequency that a moving observer measures of a moving source.

    Corrected (1): f' = f (c + v_obs) / (c - v_src).

    Parameters
    ----------
    frequency : float
        f in Hz.
    observer_speed, source_speed : float
        v_obs and v_src in m/s, positive when they close the distance.
    speed_of_sound : float
        c in m/s.

    Returns
    -------
    float
        f' in Hz.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, or a speed is not below that of sound.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> round(reactive.sound.doppler_frequency(1000.0, observer_speed=0.72, source_speed=-0.3), 3)
    1001.234
    """
    return _hrsafety.doppler_frequency(
        number("frequency", frequency),
        speed_of_sound=number("speed_of_sound", speed_of_sound),
        observer_speed=number("observer_speed", observer_speed),
        source_speed=number("source_speed", source_speed),
    )


def hearing(
    range: float,
    bearing: float,
    observer_speed: float,
    source_speed: float,
    noise: float,
    lead: float,
    samples: int | None,
) -> Place:
    """Return where and how a burst is heard, as the core takes it."""
    return (
        number("range", range),
        number("bearing", bearing),
        number("observer_speed", observer_speed),
        number("source_speed", source_speed),
        number("noise", noise),
        number("lead", lead),
        None if samples is None else count("samples", samples, most=MOST_RUNS),
    )
