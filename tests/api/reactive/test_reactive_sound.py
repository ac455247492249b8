"""Sound from Python: objects, refusals, batches, files of three channels."""

from __future__ import annotations

import copy
import dataclasses
import math
import pickle
import wave
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from api.spoiled import (
    INF,
    NAN,
    NOT_NEGATIVE,
    NUMBER,
    OPTIONAL_NOT_NEGATIVE,
    POSITIVE,
    WORD,
    names,
    refused,
    spoiled_calls,
)
from hrsafety import InvalidParameterError, ShapeError, reactive

ROW = reactive.MicrophoneArray()
SHORT = reactive.Burst(duration=0.05)
HEARD = reactive.record_burst(SHORT, ROW, range=2.0, bearing=0.5, noise=0.01)
DELAYS = {"delay_12": -6e-4, "delay_13": -1.1e-3}
PLACE = {"burst": SHORT, "array": ROW, "range": 2.0, "bearing": 0.5}
OTHER = (None, 1.0, "row", HEARD)
SEED = (-1, 1.5, True, "1", None, 2**64)
COUNT = (0, -1, 1.5, True, "1", None)
ARRAY = ("abc", None, {}, 1j, ["a"])

CALLS: dict[str, tuple[Callable[..., Any], dict[str, Any], dict[str, tuple[Any, ...]]]] = {
    "MicrophoneArray": (reactive.MicrophoneArray, {}, {"spacing": POSITIVE, "speed_of_sound": POSITIVE}),
    "Burst": (
        reactive.Burst,
        {},
        {
            "kind": WORD,
            "low": POSITIVE,
            "high": (*POSITIVE, 499.0, 500.0),
            "duration": (*POSITIVE, 1e9),
            "level": POSITIVE,
            "ramp": (*NOT_NEGATIVE, 0.3),
            "seed": SEED,
        },
    ),
    "Converter": (
        reactive.Converter,
        {},
        {"sample_rate": POSITIVE, "bits": (0, 1, 33, 2.5, True, "10")},
    ),
    "MicrophoneArray.delays": (
        ROW.delays,
        {"range": 1.0, "bearing": 0.0},
        {"range": (*ARRAY, NAN, INF, -1.0, [1.0, -1.0]), "bearing": (*ARRAY, NAN, INF)},
    ),
    "parallel_ray_bearing": (
        reactive.sound.parallel_ray_bearing,
        {"array": ROW, **DELAYS},
        {"array": OTHER, "pair": (*WORD, "21"), "delay_12": ARRAY, "delay_13": ARRAY},
    ),
    "parallel_ray_bias": (
        reactive.sound.parallel_ray_bias,
        {"array": ROW, "range": 1.0, "bearing": 0.0},
        {"array": OTHER, "pair": WORD, "range": (*ARRAY, -1.0), "bearing": ARRAY},
    ),
    "printed_range": (
        reactive.sound.printed_range,
        {"array": ROW, **DELAYS},
        {"array": OTHER, "delay_12": ARRAY, "delay_13": ARRAY},
    ),
    "locate": (
        reactive.locate,
        {"array": ROW, **DELAYS},
        {
            "array": OTHER,
            "delay_12": (*ARRAY, [1e-4]),
            "delay_13": (*ARRAY, [1e-4]),
            "arrival_deviation": NOT_NEGATIVE,
            "delay_covariance": (
                "ab",
                1.0,
                [[1.0, 2.0], [0.0, 1.0]],
                [[NAN, 0.0], [0.0, 1.0]],
                [[-1.0, 0.0], [0.0, 1.0]],
            ),
        },
    ),
    "locate_batch": (
        reactive.locate_batch,
        {"array": ROW, **DELAYS},
        {
            "array": OTHER,
            "delay_12": ARRAY,
            "arrival_deviation": NOT_NEGATIVE,
            "threads": (0, -1, 1.5, True, 1025),
            "progress": (1, "call"),
        },
    ),
    "record_burst": (
        reactive.record_burst,
        PLACE,
        {
            "burst": OTHER,
            "array": OTHER,
            "range": POSITIVE,
            "bearing": NUMBER,
            "converter": (1.0, "10 bits", ROW),
            "noise": NOT_NEGATIVE,
            "observer_speed": (*NUMBER, 340.0, -400.0),
            "source_speed": (*NUMBER, 340.0),
            "lead": (*NUMBER, -1.0, 1e9),
            "samples": tuple(value for value in COUNT if value is not None),
            "seed": SEED,
        },
    ),
    "doppler_frequency": (
        reactive.sound.doppler_frequency,
        {"frequency": 440.0},
        {"frequency": POSITIVE, "observer_speed": (*NUMBER, 341.0), "source_speed": NUMBER, "speed_of_sound": POSITIVE},
    ),
    "SoundRecording": (
        reactive.SoundRecording,
        {"samples": np.zeros((3, 4)), "sample_rate": 1.0},
        {
            "samples": (*ARRAY, np.zeros(3), np.zeros((2, 4)), np.zeros((3, 0)), np.full((3, 4), NAN)),
            "sample_rate": POSITIVE,
            "clipped": ((1, 2), (1, 2, -3), (1.5, 0, 0)),
        },
    ),
    "estimate_delays": (
        reactive.estimate_delays,
        {"recording": HEARD, "array": ROW},
        {
            "recording": (None, HEARD.samples, ROW),
            "array": OTHER,
            "method": WORD,
            "between_samples": (1, None, "yes"),
            "window": (0, 1.5, True, "1", 240, 10**7),
            "window_start": (0, -1, 1.5),
            "band": ((0.0, 1.0),),
        },
    ),
    "likeness": (
        reactive.sound.likeness,
        {"recording": HEARD, "array": ROW, "method": "phase"},
        {
            "recording": (None, HEARD.samples),
            "array": OTHER,
            "method": WORD,
            "band": ((1.0, 1.0), (2.0, 1.0), (-1.0, 5.0), (0.0, 60e3), 1.0, "ab", (NAN, 1.0)),
            "window": (240,),
            "window_start": (5,),
        },
    ),
    "jittered_fixes": (
        reactive.sound.jittered_fixes,
        {"array": ROW, "range": 1.0, "bearing": 0.0, "runs": 2},
        {
            "array": OTHER,
            "range": (*ARRAY, 0.0, NAN, [1.0, -1.0]),
            "bearing": (*ARRAY, INF),
            "runs": (*COUNT, 10**9),
            "arrival_deviation": NOT_NEGATIVE,
            "seed": SEED,
            "threads": (0, 1025),
        },
    ),
    "localize_bursts": (
        reactive.localize_bursts,
        {**PLACE, "runs": 1},
        {
            "burst": OTHER,
            "array": OTHER,
            "range": (*ARRAY, 0.0, NAN),
            "bearing": ARRAY,
            "runs": COUNT,
            "converter": (1.0,),
            "noise": OPTIONAL_NOT_NEGATIVE,
            "samples": (200, 1.5),
            "method": WORD,
            "seed": SEED,
            "threads": (0, 1025),
            "progress": (1,),
        },
    ),
    "read_recording": (
        reactive.read_recording,
        {"path": "three.wav"},
        {
            "path": (None, 1, "", "missing.wav", "\0", "."),
            "channels": ((0, 1), (0, 0, 1), (0, 1, -1), 3, "abc", (0, 1, 2.0)),
        },
    ),
}
# A rule that ties two arguments may name either; noise within a window or file is about its samples.
PARTNERS = {
    "low": {"high"},
    "high": {"low", "duration"},
    "range": {"bearing"},
    "samples": {"window", "lead"},
    "window": {"samples"},
    "method": {"band"},
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    write_wav(tmp_path / "three.wav", np.zeros((3, 10), dtype="<i2"))
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(("name", "argument", "values"), spoiled_calls(CALLS))
def test_bad_argument_is_refused_by_name(name: str, argument: str, values: Sequence[Any]) -> None:
    function, right, _ = CALLS[name]
    for value in values:
        with refused(value) as caught:
            function(**{**right, argument: value})
        assert names(caught.value).split("[")[0] in {argument} | PARTNERS.get(argument, set()), str(caught.value)


@pytest.mark.usefixtures("folder")
def test_right_arguments_are_accepted() -> None:
    for function, right, _ in CALLS.values():
        function(**right)


@pytest.mark.parametrize("thing", [ROW, SHORT, reactive.Burst.tone(440.0), reactive.Converter(bits=None)])
def test_parameters_are_values(thing: Any) -> None:
    assert pickle.loads(pickle.dumps(thing)) == thing == copy.deepcopy(thing)
    assert eval(repr(thing), dict(vars(reactive))) == thing
    with pytest.raises(AttributeError):
        setattr(thing, dataclasses.fields(thing)[0].name, 1.0)


def test_arrays_that_do_not_broadcast_are_named() -> None:
    with pytest.raises(ShapeError, match="delay_13 must have shape that broadcasts"):
        reactive.locate_batch(ROW, delay_12=np.zeros(3), delay_13=np.zeros(4))
    with pytest.raises(ShapeError, match="bearing must have shape"):
        ROW.delays(range=np.ones((2, 3)), bearing=np.zeros(2))


# ---- fixes ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("delay_12", "delay_13", "status"),
    [
        (NAN, 0.0, "no_delay"),
        (0.0, NAN, "no_delay"),
        (1.3e-3, 1.3e-3, "delay_too_long"),
        (0.0, 1.3e-3, "delay_too_long"),
        (INF, 0.0, "delay_too_long"),
        (1e-4, 2e-4, "no_curvature"),
        (1e-4, 1e-4, "no_curvature"),
    ],
)
def test_no_fix_is_nan_and_says_why(delay_12: float, delay_13: float, status: str) -> None:
    fix = reactive.locate(ROW, delay_12=delay_12, delay_13=delay_13)
    assert (fix.status, fix.found) == (status, False)
    assert all(math.isnan(value) for value in (fix.range, fix.bearing, *fix.position, fix.range_deviation))
    table = reactive.locate_batch(ROW, delay_12=[delay_12, -6e-4], delay_13=[delay_13, -1.1e-3])
    assert table.status.tolist() == [status, "fix"]
    assert np.isnan(table.covariance[0]).all()
    assert np.isfinite(table.covariance[1]).all()


def test_left_is_positive_and_third_microphone_is_on_the_left() -> None:
    delay_12, delay_13 = ROW.delays(range=2.0, bearing=math.radians(40.0))
    assert delay_13 < delay_12 < 0.0  # M3 hears first, M1 last
    fix = reactive.locate(ROW, delay_12=float(delay_12), delay_13=float(delay_13))
    assert fix.bearing > 0.0
    assert fix.position[1] > 0.0
    x, y = fix.position
    assert math.hypot(x, y) == pytest.approx(2.0)


def test_batch_has_the_shape_of_its_delays_and_the_numbers_of_single_fixes() -> None:
    distance, bearing = np.array([[1.0], [2.5]]), np.array([-0.5, 0.0, 0.9])
    delay_12, delay_13 = ROW.delays(range=distance, bearing=bearing)
    table = reactive.locate_batch(ROW, delay_12=delay_12, delay_13=delay_13, threads=2)
    assert table.shape == (2, 3)
    assert len(table) == 2
    assert table.covariance.shape == (2, 3, 2, 2)
    assert table.position.shape == (2, 3, 2)
    for place in np.ndindex(2, 3):
        one = reactive.locate(ROW, delay_12=float(delay_12[place]), delay_13=float(delay_13[place]))
        assert (table.range[place], table.bearing[place]) == (one.range, one.bearing)
        assert np.array_equal(table.covariance[place], one.covariance)
        assert table.range_deviation[place] == one.range_deviation
        assert table.bearing_deviation[place] == one.bearing_deviation
    empty = reactive.locate_batch(ROW, delay_12=np.zeros((0, 2)), delay_13=0.0)
    assert empty.range.shape == (0, 2)


def test_covariance_of_delays_can_be_given() -> None:
    jitter = 2e-6
    matrix = jitter**2 * np.array([[2.0, 1.0], [1.0, 2.0]])
    one = reactive.locate(ROW, **DELAYS, arrival_deviation=jitter)
    other = reactive.locate(ROW, **DELAYS, delay_covariance=matrix)
    assert other.covariance == pytest.approx(one.covariance, rel=1e-12)


def test_progress_is_told_to_the_end() -> None:
    heard: list[tuple[int, int]] = []
    reactive.localize_bursts(
        SHORT, ROW, range=[1.0, 2.0], bearing=0.0, runs=3, progress=lambda done, total: heard.append((done, total))
    )
    assert heard[-1] == (6, 6)
    heard.clear()
    zeros = np.zeros(10_000)
    reactive.locate_batch(ROW, delay_12=zeros, delay_13=zeros, progress=lambda done, total: heard.append((done, total)))
    assert heard[-1] == (10_000, 10_000)


def test_bits_do_not_depend_on_threads() -> None:
    def table(threads: int | None) -> reactive.Fixes:
        return reactive.localize_bursts(
            SHORT, ROW, range=[1.0, 3.0], bearing=[0.2, -0.4], runs=9, noise=0.1, threads=threads
        )

    one = table(1)
    for threads in (2, 5, None):
        assert table(threads).range.tobytes() == one.range.tobytes()


# ---- recordings -------------------------------------------------------------------------------------


def write_wav(path: Path, levels: np.ndarray, rate: int = 48_000) -> None:
    with wave.open(str(path), "wb") as file:
        file.setnchannels(levels.shape[0])
        file.setsampwidth(levels.dtype.itemsize)
        file.setframerate(rate)
        file.writeframes(levels.T.tobytes())


@pytest.mark.parametrize("kind", ["|u1", "<i2", "<i4"])
def test_recording_is_read_as_it_was_written(tmp_path: Path, kind: str) -> None:
    bits = 8 * np.dtype(kind).itemsize
    levels = np.random.default_rng(3).integers(-(2 ** (bits - 1)) + 1, 2 ** (bits - 1) - 1, (3, 500))
    levels[1, 7] = -(2 ** (bits - 1))
    levels[2, :2] = 2 ** (bits - 1) - 1
    write_wav(tmp_path / "a.wav", (levels + (128 if bits == 8 else 0)).astype(kind))
    heard = reactive.read_recording(tmp_path / "a.wav")
    assert heard.sample_rate == 48e3
    assert np.array_equal(heard.samples * 2.0 ** (bits - 1), levels)
    assert heard.clipped[1] >= 1
    assert heard.clipped[2] >= 2


def test_24_bits_and_other_channels_are_read(tmp_path: Path) -> None:
    levels = np.array([[0, 1, -1], [2**22, -(2**22), 5], [-(2**23), 2**23 - 1, 0], [7, 8, -9]])
    raw = levels.T.astype("<i4").reshape(-1, 1).view(np.uint8)[:, :3].tobytes()
    with wave.open(str(tmp_path / "b.wav"), "wb") as file:
        file.setnchannels(4)
        file.setsampwidth(3)
        file.setframerate(44_100)
        file.writeframes(raw)
    heard = reactive.read_recording(tmp_path / "b.wav", channels=(3, 0, 2))
    assert np.array_equal(heard.samples * 2.0**23, levels[[3, 0, 2]])
    assert heard.clipped == (0, 0, 2)


def test_burst_through_a_file_is_located(tmp_path: Path) -> None:
    heard = reactive.record_burst(
        SHORT, ROW, range=1.5, bearing=-0.3, noise=0.002, converter=reactive.Converter(bits=16)
    )
    write_wav(tmp_path / "c.wav", np.round(heard.samples * 2**15).astype("<i2"), 100_000)
    read = reactive.read_recording(str(tmp_path / "c.wav"))
    assert np.array_equal(read.samples, heard.samples)
    found = reactive.estimate_delays(read, ROW, window=4096)
    fix = reactive.locate(ROW, delay_12=found.delay_12, delay_13=found.delay_13)
    assert fix.range == pytest.approx(1.5, abs=0.02)
    assert fix.bearing == pytest.approx(-0.3, abs=0.002)


def _cut(path: Path, length: int) -> None:
    path.write_bytes(path.read_bytes()[:length])


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda path: path.write_bytes(b""), "must be a WAV file of whole numbers"),
        (lambda path: path.write_bytes(b"RIFF1234WAVEfmt"), "must be a WAV file of whole numbers"),
        (lambda path: path.write_text("time,angle\n1,2\n" * 10), "must be a WAV file of whole numbers"),
        (lambda path: _cut(path, 60), "must hold the 10 frames of its header, got 2"),
        (lambda path: _cut(path, 44), "must hold samples, got none"),
        (lambda path: write_wav(path, np.zeros((2, 10), dtype="<i2")), "must have 3 channels or more, got 2"),
        (lambda path: write_wav(path, np.zeros((3, 0), dtype="<i2")), "must hold samples, got none"),
    ],
)
def test_bad_file_is_refused_with_its_reason(tmp_path: Path, spoil: Callable[[Path], Any], message: str) -> None:
    path = tmp_path / "d.wav"
    write_wav(path, np.zeros((3, 10), dtype="<i2"))
    spoil(path)
    with pytest.raises(InvalidParameterError, match=message):
        reactive.read_recording(path)


def test_floating_point_wav_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "e.wav"
    write_wav(path, np.zeros((3, 10), dtype="<i4"))
    data = bytearray(path.read_bytes())
    data[20:22] = (3).to_bytes(2, "little")  # format tag of floats
    path.write_bytes(bytes(data))
    with pytest.raises(InvalidParameterError, match="unknown format: 3"):
        reactive.read_recording(path)


def test_silent_channel_has_no_delay_and_no_fix() -> None:
    samples = HEARD.samples.copy()
    samples[2] = 0.1
    found = reactive.estimate_delays(reactive.SoundRecording(samples=samples, sample_rate=100e3), ROW)
    assert math.isfinite(found.delay_12)
    assert math.isnan(found.delay_13)
    assert math.isnan(found.coefficient_13)
    assert reactive.locate(ROW, delay_12=found.delay_12, delay_13=found.delay_13).status == "no_delay"


def test_loud_burst_is_clipped_and_counted() -> None:
    loud = reactive.record_burst(reactive.Burst(duration=0.05, level=2.0), ROW, range=1.0, bearing=0.0)
    assert min(loud.clipped) > 100
    assert loud.samples.max() == 511 / 512
    assert loud.samples.min() == -1.0
    assert reactive.record_burst(SHORT, ROW, range=1.0, bearing=0.0).clipped == (0, 0, 0)


def test_similarity_is_the_inverse_of_the_mean_square() -> None:
    curve = reactive.sound.likeness(HEARD, ROW, method="mean_square")
    assert np.array_equal(curve.similarity_12, 1.0 / curve.values_12)
    same = reactive.SoundRecording(samples=np.stack([HEARD.samples[0]] * 3), sample_rate=100e3)
    equal = reactive.sound.likeness(same, ROW, method="mean_square")
    assert equal.values_13.min() == 0.0
    assert equal.similarity_13[240] == math.inf
    with pytest.raises(InvalidParameterError, match="method"):
        _ = reactive.sound.likeness(HEARD, ROW).similarity_12
