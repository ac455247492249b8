"""Tables 1 and 2 and the formulas (9) and (10) of the source of 2019 beside the measured numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from hrsafety import reactive
from hrsafety.reproduce.cells import PrintedValue, Tolerance
from hrsafety.reproduce.reactive.sound_study import LEVELS, NOISE, ROW, RUNS, Array, SoundPlace, SoundStudy, places
from hrsafety.reproduce.sheets import Sheet

__all__ = ["cells"]

SHEET = Sheet("reactive")
INTERVAL = 1.96  # standard deviations of 95 %
# Standard deviation of a standard deviation from 100 normal measurements, as a share of it.
SAMPLING = Tolerance(INTERVAL / math.sqrt(2.0 * (RUNS - 1)), relative=True)
DIGITS = {"distance": 0.005, "angle": 0.05}  # half of the last printed digit of Table 1


def cells(study: SoundStudy) -> list[PrintedValue]:
    """Return every cell of the part: formulas, Table 1, Table 2."""
    return [*_formulas(), *_trends(study), *_means(study), *_scatter(study)]


def _formulas() -> Iterator[PrintedValue]:
    distance = np.array([place.distance for place in places()])
    bearing = np.radians([place.angle for place in places()])
    delay_12, delay_13 = ROW.delays(range=distance, bearing=bearing)
    fixes = reactive.locate_batch(ROW, delay_12=delay_12, delay_13=delay_13)
    usable = bearing != 0.0  # straight ahead dt13 vanishes, and (9) is far off in any case
    off = np.abs(reactive.sound.printed_range(ROW, delay_12=delay_12, delay_13=delay_13) / distance - 1.0)
    yield SHEET.claim(
        "distance",
        holds=bool((off < 0.01).all()),
        least=100.0 * off[usable].min(),
        most=100.0 * off.max(),
        error=np.abs(fixes.range - distance).max(),
    )
    for angle, pair in ((0.0, "12"), (30.0, "12"), (30.0, "23")):
        bias = reactive.sound.parallel_ray_bias(ROW, range=1.0, bearing=math.radians(angle), pair=pair)  # type: ignore[arg-type]  # a word of the table
        found = angle + math.degrees(float(bias))
        yield SHEET.claim("angle", holds=abs(found - angle) < 0.5, pair=pair, angle=angle, found=found)


def _trends(study: SoundStudy) -> Iterator[PrintedValue]:
    scatter = _deviations(study.jitter)[0].reshape(4, 3)
    grow = bool((np.diff(scatter, axis=0) > 0.0).all() and (np.diff(scatter, axis=1) > 0.0).all())
    yield SHEET.claim("grow", holds=grow, near=scatter[0, 0], distant=scatter[3, 2])
    printed = [place.deviation_distance for place in places()]
    curves = np.array([_deviations(study.waveforms[level])[0] for level in LEVELS])
    wanted = [_noise_for(curve, value) for curve, value in zip(curves.T, printed, strict=True)]
    known = [value for value in wanted if math.isfinite(value)]
    yield SHEET.claim(
        "noise",
        holds=len(known) == len(wanted) and max(known) < 1.2 * min(known),
        least=min(known),
        most=max(known),
        low=LEVELS[0],
        high=LEVELS[-1],
        beyond=len(wanted) - len(known),
    )


def _noise_for(curve: Array, printed: float) -> float:
    """Return the level at which the scatter reaches the printed one first, NaN beyond the levels."""
    above = np.flatnonzero(curve >= printed)
    if len(above) == 0 or above[0] == 0:
        return math.nan
    place = int(above[0])
    share = math.log(printed / curve[place - 1]) / math.log(curve[place] / curve[place - 1])
    return float(LEVELS[place - 1] * (LEVELS[place] / LEVELS[place - 1]) ** share)


def _means(study: SoundStudy) -> Iterator[PrintedValue]:
    variants = (("jitter", study.jitter), ("waveforms", study.waveforms[NOISE]), ("whole samples", study.whole_samples))
    means = {name: _averages(fixes) for name, fixes in variants}
    heard = {"runs": RUNS, "noise": NOISE}
    for index, place in enumerate(places()):
        for column, (kind, (unit, printed, deviation)) in enumerate(_printed_means(place).items()):
            words = {"row": place.name, "kind": kind, "unit": unit}
            straight = kind == "angle" and place.angle == 0.0
            yield SHEET.number(
                "mean",
                means["jitter"][column][index],
                printed=printed,
                tolerance=Tolerance(INTERVAL * deviation / math.sqrt(RUNS) + DIGITS[kind], relative=False),
                why=SHEET.text("offset" if straight else "placed"),
                **words,
            )
            for name, reason in (("waveforms", "heard"), ("whole samples", "whole")):
                own, why = means[name][column][index], SHEET.text(reason, **heard)
                yield SHEET.listed("mean_heard", own, printed=printed, name=name, why=why, **words)


def _printed_means(place: SoundPlace) -> dict[str, tuple[str, float, float]]:
    return {
        "distance": ("m", place.mean_distance, place.deviation_distance),
        "angle": ("deg", place.mean_angle, place.deviation_angle),
    }


def _scatter(study: SoundStudy) -> Iterator[PrintedValue]:
    jitter, heard = _deviations(study.jitter), _deviations(study.waveforms[NOISE])
    for index, place in enumerate(places()):
        for column, (kind, unit, printed) in enumerate(
            (("distance", "m", place.deviation_distance), ("angle", "deg", place.deviation_angle))
        ):
            words = {"row": place.name, "kind": kind, "unit": unit}
            why = SHEET.text("far" if kind == "angle" and place.distance == 4.0 else "level")
            own = jitter[column][index]
            yield SHEET.number("scatter", own, printed=printed, tolerance=SAMPLING, why=why, **words)
            own, lost = heard[column][index], int((~study.waveforms[NOISE].found[index]).sum())
            notes = [SHEET.text("heard", runs=RUNS, noise=NOISE)]
            notes += [SHEET.text("tail")] if own >= 3.0 * printed else []
            notes += [f"{lost} of {RUNS} without a fix."] if lost else []
            yield SHEET.listed("scatter_heard", own, printed=printed, why=" ".join(notes), **words)


def _averages(fixes: reactive.Fixes) -> tuple[Array, Array]:
    """Return means of distance in m and angle in deg, of the fixes that there are."""
    return np.nanmean(fixes.range, axis=1), np.degrees(np.nanmean(fixes.bearing, axis=1))


def _deviations(fixes: reactive.Fixes) -> tuple[Array, Array]:
    """Return standard deviations of distance in m and angle in deg, of the fixes that there are."""
    return np.nanstd(fixes.range, axis=1, ddof=1), np.degrees(np.nanstd(fixes.bearing, axis=1, ddof=1))
