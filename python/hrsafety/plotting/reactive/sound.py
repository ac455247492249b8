"""Sounds at three microphones: samples, likeness over lag, scattered fixes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.plotting import inputs, notes, style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hrsafety.reactive import Fix, Fixes, SoundRecording
    from hrsafety.reactive.sound import Likeness

__all__ = ["sound_burst", "sound_fixes", "sound_likeness"]

MILLI = 1000.0
MICROPHONES = ("M1, right", "M2, middle", "M3, left")
TRUE_LOOK: style.Properties = {"color": style.CONTACT_COLOR, "linewidth": 1.1, "linestyle": (0, (5, 3))}
DOT_ALPHA = 0.35
SIGMAS = 2.0
SIGMAS_IN_VIEW = 3.5


@notes.picture
def sound_burst(
    recording: SoundRecording,
    *,
    arrivals: Sequence[float] | None = None,
    span: tuple[float, float] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw the samples of three microphones over time.

    Parameters
    ----------
    recording : SoundRecording
        The samples.
    arrivals : sequence of float or None
        When the sound reaches M1, M2 and M3, in s from the first sample, drawn as dashed lines.
    span : (float, float) or None
        Part to show, in s from the first sample; all of it when ``None``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each microphone.

    Raises
    ------
    InvalidParameterError
        If this is no recording, the arrivals are not three or the span does not rise.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, reactive
    >>> heard = reactive.record_burst(
    ...     reactive.Burst(duration=0.05), reactive.MicrophoneArray(), range=2.0, bearing=0.5)
    >>> len(plotting.reactive.sound_burst(heard).axes)
    3
    """
    if not hasattr(recording, "samples") or not hasattr(recording, "sample_rate"):
        raise InvalidParameterError("recording", "be a SoundRecording", Shown(type(recording).__name__))
    if arrivals is not None and len(arrivals) != 3:
        raise InvalidParameterError("arrivals", "be three times", arrivals)
    if span is not None and not span[0] < span[1]:
        raise InvalidParameterError("span", "rise", span)
    first, last = span if span is not None else (0.0, recording.duration)
    shown = (recording.time >= first) & (recording.time <= last)
    figure = style.new_figure(5.6, title=title)
    panels = figure.subplots(3, 1, sharex=True, sharey=True)
    for index, axes in enumerate(panels):
        look = {"color": style.RUN_COLORS[index], "linewidth": 0.9}
        axes.plot(MILLI * recording.time[shown], recording.samples[index, shown], **look)
        if arrivals is not None:
            axes.axvline(MILLI * arrivals[index], label="arrival", **TRUE_LOOK)
        axes.set_title(MICROPHONES[index], loc="left", fontsize=style.SMALL_FONT_SIZE)
        axes.set_ylabel("share of scale")
    panels[-1].set_xlabel("time (ms)")
    panels[-1].set_xlim(MILLI * first, MILLI * last)
    if arrivals is not None:
        style.legend_below(figure, panels[0].get_legend_handles_labels()[0], columns=1)
    return figure


@notes.picture
def sound_likeness(
    curves: Mapping[str, Likeness],
    *,
    lags: tuple[float, float] | None = None,
    span: int | None = None,
    title: str | None = None,
) -> Figure:
    """Draw how alike two microphones are over the lag, each curve as a share of its largest value.

    Mean square differences are drawn as similarities, their inverse.

    Parameters
    ----------
    curves : mapping of str to Likeness
        Curves with their names.
    lags : (float, float) or None
        True lags of M2 and M3 in samples, drawn as dashed lines.
    span : int or None
        Lags to show on either side of the largest value of the first curve; all when ``None``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        One panel for M1 with M2, one for M1 with M3.

    Raises
    ------
    InvalidParameterError
        If there is no curve.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, reactive
    >>> row = reactive.MicrophoneArray()
    >>> heard = reactive.record_burst(reactive.Burst(duration=0.05), row, range=2.0, bearing=0.5)
    >>> curve = reactive.sound.likeness(heard, row, method="mean_square")
    >>> figure = plotting.reactive.sound_likeness({"similarity": curve})
    """
    inputs.some("curves", curves, "Likeness")
    figure = style.new_figure(5.8, title=title)
    for index, (axes, pair) in enumerate(zip(figure.subplots(2, 1), ("12", "13"), strict=True)):
        for place, (name, curve) in enumerate(curves.items()):
            where, values = _curve(curve, pair)
            # What is alike nowhere, as in silence, stays at 0.
            highest = float(values.max()) or 1.0
            axes.plot(where, values / highest, label=name, marker="." if span else None, **style.run_look(place))
        if lags is not None:
            axes.axvline(lags[index], label="true lag", **TRUE_LOOK)
        where, values = _curve(next(iter(curves.values())), pair)
        best = int(where[values.argmax()])
        axes.set_xlim((best - span, best + span) if span else (int(where[0]), int(where[-1])))
        axes.set_title(f"M1 with M{pair[1]}", loc="left", fontsize=style.SMALL_FONT_SIZE)
        axes.set_xlabel("lag (samples)")
        axes.set_ylabel("share of largest")
    handles, names = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=min(len(names), 3))
    return figure


@notes.picture
def sound_fixes(
    fixes: Fixes,
    truth: Sequence[Fix],
    *,
    labels: Sequence[str] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw repeated fixes of sources seen from above, with the ellipses of two standard deviations.

    Parameters
    ----------
    fixes : Fixes
        One row for each source, one column for each measurement.
    truth : sequence of Fix
        Fixes from the exact delays of the sources, with their covariances.
    labels : sequence of str or None
        One name for each source; numbered when ``None``.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The robot's microphones at the bottom, looking up.

    Raises
    ------
    InvalidParameterError
        If the number of labels is wrong.
    ShapeError
        If there is not one row for each source.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting, reactive
    >>> row = reactive.MicrophoneArray()
    >>> delay_12, delay_13 = row.delays(range=[2.0, 3.0], bearing=0.5)
    >>> truth = [reactive.locate(row, delay_12=a, delay_13=b) for a, b in zip(delay_12, delay_13)]
    >>> fixes = reactive.sound.jittered_fixes(row, range=[2.0, 3.0], bearing=0.5)
    >>> figure = plotting.reactive.sound_fixes(fixes, truth)
    """
    if len(fixes.shape) != 2 or fixes.shape[0] != len(truth):
        raise ShapeError("fixes", f"({len(truth)}, n)", fixes.shape)
    names = inputs.checked_labels(labels, len(truth), stem="source")
    rings = [_ellipse(each, SIGMAS) for each in truth]
    seen = [_ellipse(each, SIGMAS_IN_VIEW) for each in truth]
    center = np.array([[0.0, 0.0]])
    limits = inputs.view_limits([center, *(np.stack([-ring[:, 1], ring[:, 0]], axis=1) for ring in seen)], margin=0.3)
    figure, axes = style.one_panel(style.scene_height(limits, legend_rows=2, titled=title is not None), title=title)
    for index, (ring, name) in enumerate(zip(rings, names, strict=True)):
        color = style.RUN_COLORS[index % len(style.RUN_COLORS)]
        places = fixes.position[index][fixes.found[index]]
        # Left is drawn on the left: the picture's x is -y of the robot.
        axes.plot(-places[:, 1], places[:, 0], ".", color=color, alpha=DOT_ALPHA, markersize=4.0)
        axes.plot(-ring[:, 1], ring[:, 0], label=name, **(style.run_look(index) | {"linewidth": 1.3}))
        x, y = truth[index].position
        axes.plot(-y, x, "+", color=color, markersize=9.0, markeredgewidth=1.6)
    axes.plot(0.0, 0.0, marker="s", color=style.NEUTRAL, markersize=5.0, linestyle="none", label="microphones")
    style.frame_scene(axes, limits)
    _label_sides(axes)
    handles, _ = axes.get_legend_handles_labels()
    style.legend_below(figure, [*handles, *_fix_handles()], columns=4)
    return figure


def _fix_handles() -> list[Artist]:
    """Return legend entries for what every source has."""
    from matplotlib.lines import Line2D

    look: style.Properties = {"color": style.NEUTRAL, "linestyle": "none"}
    return [
        Line2D([], [], marker=".", markersize=6.0, label="fix", **look),
        Line2D([], [], marker="+", markersize=9.0, markeredgewidth=1.6, label="true place", **look),
        Line2D([], [], color=style.NEUTRAL, linewidth=1.3, label=f"{SIGMAS:g} standard deviations"),
    ]


def _curve(curve: Likeness, pair: str) -> tuple[np.ndarray, np.ndarray]:
    where = curve.lags_12 if pair == "12" else curve.lags_13
    if curve.method == "mean_square":
        return where, curve.similarity_12 if pair == "12" else curve.similarity_13
    return where, curve.values_12 if pair == "12" else curve.values_13


def _ellipse(fix: Fix, deviations: float) -> np.ndarray:
    """Return points of the ellipse of range and bearing, as places (ahead, left) in m."""
    values, axes = np.linalg.eigh(fix.covariance)
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    circle = np.stack([np.cos(turn), np.sin(turn)])
    distance, angle = axes @ (deviations * np.sqrt(values)[:, np.newaxis] * circle)
    distance, angle = distance + fix.range, angle + fix.bearing
    return np.stack([distance * np.cos(angle), distance * np.sin(angle)], axis=1)


def _label_sides(axes: Axes) -> None:
    axes.set_xlabel("to the right (m)")
    axes.set_ylabel("ahead (m)")
