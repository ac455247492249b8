"""Samples of three microphones, simulated or from a WAV file."""

from __future__ import annotations

import wave
from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import numpy as np

from hrsafety._arguments import Array, count, numbers, own, positive, sequence
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError, Shown

__all__ = ["SoundRecording", "read_recording"]

FRAMES_AT_ONCE = 1 << 20
"""Frames of a long recording that are examined between two looks at Ctrl-C."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SoundRecording:
    """Samples of M1, M2, M3.

    Parameters
    ----------
    samples : array_like of shape (3, n)
        One row for each microphone, in its order, as shares of full scale.
    sample_rate : float
        In Hz.
    clipped : tuple of int
        How many samples of each channel were beyond the converter's scale.

    Raises
    ------
    InvalidParameterError
        If a sample is not finite, there is none, or the rate is not positive.
    ShapeError
        If the samples are not (3, n).

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import reactive
    >>> reactive.SoundRecording(samples=np.zeros((3, 500)), sample_rate=48e3).duration
    0.010416666666666666
    """

    samples: Array
    sample_rate: float
    clipped: tuple[int, int, int] = (0, 0, 0)

    def __post_init__(self) -> None:
        """Check the values."""
        array = numbers("samples", self.samples, "be an array of numbers")
        if array.ndim != 2 or array.shape[0] != 3 or array.shape[1] == 0:
            raise ShapeError("samples", "(3, n)", array.shape)
        for channel in array:
            # In parts, between which Ctrl-C is answered.
            for first in range(0, len(channel), FRAMES_AT_ONCE):
                part = channel[first : first + FRAMES_AT_ONCE]
                if not np.isfinite(part).all():
                    raise InvalidParameterError("samples", "be finite", float(part[~np.isfinite(part)][0]))
        shares = tuple(count("clipped", each, least=0) for each in sequence("clipped", "be three counts", self.clipped))
        if len(shares) != 3:
            raise InvalidParameterError("clipped", "be three numbers", self.clipped)
        object.__setattr__(self, "samples", own(array))
        object.__setattr__(self, "sample_rate", positive("sample_rate", self.sample_rate))
        object.__setattr__(self, "clipped", shares)

    @property
    def time(self) -> Array:
        """Instants of the samples from the first one, in s."""
        return np.arange(self.samples.shape[1]) / self.sample_rate

    @property
    def duration(self) -> float:
        """Length in s."""
        return float(self.samples.shape[1]) / self.sample_rate


def read_recording(path: str | PathLike[str], *, channels: Sequence[int] = (0, 1, 2)) -> SoundRecording:
    """Read a recording of three microphones from a WAV file of whole numbers (PCM).

    Parameters
    ----------
    path : str or path-like
        The file; 8, 16, 24 or 32 bits, any rate.
    channels : sequence of int
        Which channels of the file are M1, M2 and M3 (M3 is the left one), counted from 0.

    Returns
    -------
    SoundRecording
        Samples as shares of full scale; samples at the ends of the scale count as clipped.

    Raises
    ------
    InvalidParameterError
        If the file cannot be read, is no WAV file of whole numbers, has fewer channels than asked
        for, no samples, or ends within them.

    Examples
    --------
    >>> import wave
    >>> import numpy as np
    >>> from hrsafety import reactive
    >>> with wave.open("three.wav", "wb") as file:
    ...     file.setnchannels(3)
    ...     file.setsampwidth(2)
    ...     file.setframerate(48000)
    ...     file.writeframes(np.arange(-6, 6, dtype="<i2").tobytes())
    >>> heard = reactive.read_recording("three.wav")
    >>> heard.samples.shape, (heard.samples[0] * 2**15).tolist()
    ((3, 4), [-6.0, -3.0, 0.0, 3.0])
    """
    chosen = _checked_channels(channels)
    file = _checked_path(path)
    try:
        with file.open("rb") as stream, wave.open(stream, "rb") as sound:
            parameters = sound.getparams()
            parts = list(iter(lambda: sound.readframes(FRAMES_AT_ONCE), b""))
    except (wave.Error, EOFError, RuntimeError) as error:
        # A chunk that says it is longer than the file makes the reader of chunks fail without a word.
        reason = str(error) or "the file ends within its header or a chunk"
        raise InvalidParameterError(file.name, "be a WAV file of whole numbers (PCM)", Shown(reason)) from None
    except OSError as error:
        raise InvalidParameterError("path", "name a readable file", Shown(f"{file} ({error.strerror})")) from None
    if max(chosen) >= parameters.nchannels:
        rule = f"have {max(chosen) + 1} channels or more"
        raise InvalidParameterError(file.name, rule, Shown(f"{parameters.nchannels}"))
    width = parameters.sampwidth
    frame, size = width * parameters.nchannels, sum(map(len, parts))
    frames = size // frame
    if parameters.nframes == 0 or frames == 0:
        raise InvalidParameterError(file.name, "hold samples", Shown("none"))
    if frames != parameters.nframes or size % frame:
        raise InvalidParameterError(
            file.name, f"hold the {parameters.nframes} frames of its header", Shown(f"{frames}")
        )
    if parameters.framerate <= 0:
        raise InvalidParameterError(file.name, "have a positive sample rate", Shown(f"{parameters.framerate}"))
    steps = float(2 ** (8 * width - 1))
    samples, ends, first = np.empty((3, frames)), np.zeros(3, dtype=np.int64), 0
    for data in parts:
        levels = _levels(data, width, file.name).reshape(-1, parameters.nchannels).T[chosen]
        ends += ((levels <= -steps) | (levels >= steps - 1.0)).sum(axis=1)
        samples[:, first : first + levels.shape[1]] = levels / steps
        first += levels.shape[1]
    return SoundRecording(
        samples=samples,
        sample_rate=float(parameters.framerate),
        clipped=(int(ends[0]), int(ends[1]), int(ends[2])),
    )


def _checked_channels(channels: Sequence[int]) -> list[int]:
    rule = "be three different numbers of channels, counted from 0"
    chosen = [count("channels", each, least=0) for each in sequence("channels", rule, channels)]
    if len(chosen) != 3 or len(set(chosen)) != 3:
        raise InvalidParameterError("channels", rule, channels)
    return chosen


def _checked_path(path: str | PathLike[str]) -> Path:
    if not isinstance(path, (str, PathLike)):
        raise InvalidParameterError("path", "be a path", path)
    try:
        file = Path(path)
        found = file.is_file()
    except (ValueError, TypeError, OSError):
        found = False
    if not found:
        raise InvalidParameterError("path", "name a readable file", str(path))
    return file


def _levels(data: bytes, width: int, name: str) -> Array:
    """Return whole numbers of 1 (unsigned), 2, 3 or 4 bytes, the lowest first."""
    raw = np.frombuffer(data, dtype=np.uint8)
    if width == 1:
        return raw.astype(np.float64) - 128.0
    if width not in (2, 3, 4):
        raise InvalidParameterError(name, "have 8, 16, 24 or 32 bits", Shown(f"{8 * width}"))
    # The bytes become the upper ones of 32 bits, which keeps the sign.
    padded = np.zeros((len(raw) // width, 4), dtype=np.uint8)
    padded[:, 4 - width :] = raw.reshape(-1, width)
    whole = padded.reshape(-1).view("<i4").astype(np.float64)
    return np.asarray(whole / float(2 ** (8 * (4 - width))))
