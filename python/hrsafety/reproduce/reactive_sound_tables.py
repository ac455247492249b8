"""Tables 1 and 2 and the formulas (9) and (10) of the source of 2019 beside the measured numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from hrsafety import reactive
from hrsafety.reproduce.cells import Cell, Tolerance
from hrsafety.reproduce.impact_cells import claim, listed, number
from hrsafety.reproduce.reactive_sound_study import LEVELS, NOISE, ROW, RUNS, Array, Place, SoundStudy, places

__all__ = ["cells"]

FORMULAS, MEANS, SCATTER = "avi2019 section 2", "avi2019 Table 1", "avi2019 Table 2"
INTERVAL = 1.96  # standard deviations of 95 %
# Standard deviation of a standard deviation from 100 normal measurements, as a share of it.
SAMPLING = Tolerance(INTERVAL / math.sqrt(2.0 * (RUNS - 1)), relative=True)
DIGITS = {"distance": 0.005, "angle": 0.05}  # half of the last printed digit of Table 1
_HEARD = (
    f"From {RUNS} full waveforms: noise of 0.5 to 8 kHz, white noise of {NOISE:g} of full scale at each microphone, "
    "10 bits, 4096 samples. The source names neither its sound nor its noise."
)
_WHOLE = (
    f"{_HEARD} Delays in whole samples, as (6) has them: an error of up to half a sample that all measurements share "
    "where there is little noise."
)
_OFFSET = "0.4 deg at every distance straight ahead: the source is mounted or aimed that much off."
_PLACED = (
    "Outside of what the printed scatter allows: an error that 100 measurements share, such as a source set up by "
    "hand, delays in whole samples, reflections. Fixes are exact, and the jitter has no such error."
)
_LEVEL = (
    "The jitter, a quarter of a sample, is one number for all places; the scatter of the source follows no single "
    "one, see section 2."
)
_FAR = (
    "Unexplained: jitter gives an angle that hardly depends on the distance, while the printed scatter grows "
    "eleven- to fourteenfold from 1 m to 4 m."
)
_TAIL = (
    "Single fixes are far off: the distance goes with the inverse of a curvature that the noise brings near zero. Such "
    "fixes tell it by their covariance; the source may have left them out."
)
_RIGHT = "The corrected formula is exact, see the page of equations."


def cells(study: SoundStudy) -> list[Cell]:
    """Return every cell of the part."""
    return [*_formulas(), *_trends(study), *_means(study), *_scatter(study)]


def _formulas() -> Iterator[Cell]:
    distance = np.array([place.distance for place in places()])
    bearing = np.radians([place.angle for place in places()])
    delay_12, delay_13 = ROW.delays(range=distance, bearing=bearing)
    fixes = reactive.locate_batch(ROW, delay_12=delay_12, delay_13=delay_13)
    usable = bearing != 0.0  # straight ahead dt13 vanishes, and (9) is far off in any case
    seen = reactive.sound.printed_range(ROW, delay_12=delay_12, delay_13=delay_13)
    off = np.abs(seen / distance - 1.0)
    yield claim(
        FORMULAS,
        "distance by (9)",
        "error at the places of Table 1",
        printed="the distance",
        measured=f"{100.0 * off[usable].min():.0f} % at least off the straight line, {100.0 * off.max():.0f} % at most",
        holds=bool((off < 0.01).all()),
        reason=f"Misprinted. {_RIGHT} Its largest error here: {np.abs(fixes.range - distance).max():.0e} m.",
    )
    for angle, pair in ((0.0, "12"), (30.0, "12"), (30.0, "23")):
        bias = reactive.sound.parallel_ray_bias(ROW, range=1.0, bearing=math.radians(angle), pair=pair)  # type: ignore[arg-type]  # a word of the table
        found = angle + math.degrees(float(bias))
        yield claim(
            FORMULAS,
            f"angle by (10), microphones {pair[0]} and {pair[1]}",
            f"at 1 m, {angle:g} deg",
            printed="the angle, 0.4 and 29.9 deg in Table 1",
            measured=f"{found:.1f} deg",
            holds=abs(found - angle) < 0.5,
            reason="Rays are not parallel at 1 m: the means of Table 1 cannot come from (10). The exact bearing can.",
        )


def _trends(study: SoundStudy) -> Iterator[Cell]:
    scatter = _deviations(study.jitter)[0].reshape(4, 3)
    yield claim(
        FORMULAS,
        "errors grow",
        "of the distance, with distance and angle",
        printed="they do",
        measured=f"{scatter[0, 0]:.3f} m at 1 m, 0 deg to {scatter[3, 2]:.2f} m at 4 m, 60 deg",
        holds=bool((np.diff(scatter, axis=0) > 0.0).all() and (np.diff(scatter, axis=1) > 0.0).all()),
    )
    printed = [place.deviation_distance for place in places()]
    curves = np.array([_deviations(study.waveforms[level])[0] for level in LEVELS])
    wanted = [_noise_for(curve, value) for curve, value in zip(curves.T, printed, strict=True)]
    known = [value for value in wanted if math.isfinite(value)]
    yield claim(
        FORMULAS,
        "noise that gives the printed scatter",
        "of the distance, twelve places",
        printed="one set-up",
        measured=f"{min(known):.3f} to {max(known):.3f} of full scale, {len(wanted) - len(known)} places beyond "
        f"{LEVELS[0]:g} to {LEVELS[-1]:g}",
        holds=len(known) == len(wanted) and max(known) < 1.2 * min(known),
        reason="No single signal-to-noise ratio fits all places.",
    )


def _noise_for(curve: Array, printed: float) -> float:
    """Return the level at which the scatter reaches the printed one first, NaN beyond the levels."""
    above = np.flatnonzero(curve >= printed)
    if len(above) == 0 or above[0] == 0:
        return math.nan
    place = int(above[0])
    share = math.log(printed / curve[place - 1]) / math.log(curve[place] / curve[place - 1])
    return float(LEVELS[place - 1] * (LEVELS[place] / LEVELS[place - 1]) ** share)


def _means(study: SoundStudy) -> Iterator[Cell]:
    variants = (("jitter", study.jitter), ("waveforms", study.waveforms[NOISE]), ("whole samples", study.whole_samples))
    means = {name: _averages(fixes) for name, fixes in variants}
    for index, place in enumerate(places()):
        for kind, (unit, printed, deviation) in _printed_means(place).items():
            column = 0 if kind == "distance" else 1
            cell = number(
                MEANS,
                place.name,
                f"{kind}, jitter",
                printed=printed,
                measured=means["jitter"][column][index],
                tolerance=Tolerance(INTERVAL * deviation / math.sqrt(RUNS) + DIGITS[kind], relative=False),
                unit=unit,
            )
            straight = kind == "angle" and place.angle == 0.0
            yield cell if cell.within else replace(cell, reason=_OFFSET if straight else _PLACED)
            for name, reason in (("waveforms", _HEARD), ("whole samples", _WHOLE)):
                measured = means[name][column][index]
                yield listed(
                    MEANS,
                    place.name,
                    f"{kind}, {name}",
                    printed=printed,
                    measured=measured,
                    unit=unit,
                    reason=reason,
                )


def _printed_means(place: Place) -> dict[str, tuple[str, float, float]]:
    return {
        "distance": ("m", place.mean_distance, place.deviation_distance),
        "angle": ("deg", place.mean_angle, place.deviation_angle),
    }


def _scatter(study: SoundStudy) -> Iterator[Cell]:
    jitter, heard = _deviations(study.jitter), _deviations(study.waveforms[NOISE])
    for index, place in enumerate(places()):
        for column, (kind, unit, printed) in enumerate(
            (("distance", "m", place.deviation_distance), ("angle", "deg", place.deviation_angle))
        ):
            cell = number(
                SCATTER,
                place.name,
                f"{kind}, jitter",
                printed=printed,
                measured=jitter[column][index],
                tolerance=SAMPLING,
                unit=unit,
            )
            far = kind == "angle" and place.distance == 4.0
            yield cell if cell.within else replace(cell, reason=_FAR if far else _LEVEL)
            notes = [_HEARD] if heard[column][index] < 3.0 * printed else [_HEARD, _TAIL]
            lost = int((~study.waveforms[NOISE].found[index]).sum())
            yield listed(
                SCATTER,
                place.name,
                f"{kind}, waveforms",
                printed=printed,
                measured=heard[column][index],
                unit=unit,
                reason=" ".join([*notes, f"{lost} of {RUNS} without a fix."] if lost else notes),
            )


def _averages(fixes: reactive.Fixes) -> tuple[Array, Array]:
    """Return means of distance in m and angle in deg, of the fixes that there are."""
    return np.nanmean(fixes.range, axis=1), np.degrees(np.nanmean(fixes.bearing, axis=1))


def _deviations(fixes: reactive.Fixes) -> tuple[Array, Array]:
    """Return standard deviations of distance in m and angle in deg, of the fixes that there are."""
    return np.nanstd(fixes.range, axis=1, ddof=1), np.degrees(np.nanstd(fixes.bearing, axis=1, ddof=1))
