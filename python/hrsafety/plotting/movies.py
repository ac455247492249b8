"""Files of moving pictures: GIF through Pillow, MP4 through ffmpeg."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import positive
from hrsafety._bounds import MOST_FRAMES
from hrsafety.errors import HrsafetyError, InvalidParameterError
from hrsafety.plotting import style

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from PIL.Image import Image

Frame = npt.NDArray[np.uint8]

FASTEST_GIF = 50  # frames per second; viewers slow down anything faster
LAST_FRAME_TIME = 1.2  # s, for which the end of the run is held
GIF_TICK_MS = 10  # a GIF counts time in hundredths of a second
COLORS = 64
NEARLY_WHITE = 244  # pixels from here on are background to the palette
KEPT_COLORS = (style.RUN_COLORS[0], style.GOAL_COLOR, style.CONTACT_COLOR, style.PERSON_COLORS[0], "#000000", "#FFFFFF")


def drawn(figure: Figure, axes: Axes, rows: Iterable[int], shown: Callable[[int], Iterable[Artist]]) -> Iterator[Frame]:
    """Yield pictures, shape (height, width, 3), in which only what moves is drawn again.

    Parameters
    ----------
    figure : Figure
        With everything that does not move.
    axes : Axes
        Where what moves is drawn.
    rows : iterable of int
        Rows of the run, one for each picture.
    shown : callable
        Puts what moves where it is at a row, and returns its artists from back to front.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    empty = canvas.copy_from_bbox(figure.bbox)
    for row in rows:
        canvas.restore_region(empty)
        for artist in shown(row):
            axes.draw_artist(artist)
        yield np.array(canvas.buffer_rgba(), dtype=np.uint8)[:, :, :3]


def drawn_anew(figure: Figure, axes: Axes, rows: Iterable[int], draw: Callable[[int], object]) -> Iterator[Frame]:
    """Yield pictures as `drawn` does; ``draw`` draws what moves at a row, which is removed for the next picture."""
    artists: list[Artist] = []

    def shown(row: int) -> list[Artist]:
        for artist in artists:
            artist.remove()
        before = set(axes.get_children())
        draw(row)
        artists[:] = sorted(set(axes.get_children()) - before, key=lambda artist: float(artist.get_zorder()))
        return artists

    return drawn(figure, axes, rows, shown)


def checked_target(path: str | os.PathLike[str]) -> Path:
    """Return the path of an animation that can be written."""
    target = Path(path)
    suffix = target.suffix.lower()
    if suffix not in {".gif", ".mp4"}:
        raise InvalidParameterError("path", "end in .gif or .mp4", str(target))
    if not target.parent.is_dir():
        raise InvalidParameterError("path", "lie in a folder that exists", str(target))
    check_writer(target)
    return target


def check_writer(target: Path) -> None:
    """Say so if what writes a file of this kind is missing."""
    suffix = target.suffix.lower()
    if suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise style.MissingExtraError("an MP4 file needs the program ffmpeg, which was not found; a GIF file does not")
    if suffix == ".gif":
        try:
            import PIL  # noqa: F401  # the import is the check
        except ImportError:
            raise style.MissingExtraError("a GIF file needs Pillow: pip install pillow") from None


def checked_instants(target: Path, end: float, frames_per_second: float, speed: float) -> npt.NDArray[np.float64]:
    """Return the instants of a run that are shown before its end, in s.

    Parameters
    ----------
    target : Path
        The file; a GIF has a largest number of frames in a second.
    end : float
        When the run ends, in s.
    frames_per_second, speed : float
        Frames in a second of viewing time, and simulated time over viewing time.
    """
    rate, pace = positive("frames_per_second", frames_per_second), positive("speed", speed)
    if target.suffix.lower() == ".gif" and rate > FASTEST_GIF:
        raise InvalidParameterError("frames_per_second", f"be at most {FASTEST_GIF} for a GIF", frames_per_second)
    step = pace / rate
    if step == 0.0 or end > MOST_FRAMES * step:
        least = end * rate / MOST_FRAMES
        raise InvalidParameterError("speed", f"be at least {least:.3g} for at most {MOST_FRAMES} frames", speed)
    return np.arange(0.0, end, step)


def write(target: Path, frames: Iterator[Frame], frames_per_second: float) -> None:
    """Write a GIF or MP4 file that appears under its name only when it is complete.

    Parameters
    ----------
    target : Path
        The file.
    frames : iterator of ndarray
        Its pictures.
    frames_per_second : float
        Pictures in a second.
    """
    with complete_or_absent(target) as partial:
        if target.suffix.lower() == ".gif":
            write_gif(partial, frames, frames_per_second)
        else:
            write_mp4(partial, frames, frames_per_second)


def counted(frames: Iterator[Frame], total: int, progress: Callable[[int, int], object] | None) -> Iterator[Frame]:
    """Yield the frames and report each one that was drawn."""
    for done, frame in enumerate(frames, start=1):
        if progress is not None:
            progress(done, total)
        yield frame


@contextmanager
def complete_or_absent(target: Path) -> Iterator[Path]:
    """Give a temporary path beside ``target`` that takes its name when all went well."""
    partial = target.with_name(f".{target.stem}.{os.getpid()}.partial{target.suffix}")
    try:
        yield partial
        partial.replace(target)
    except OSError as error:
        if error.errno is not None and error.filename in (None, str(partial), partial):
            error.filename = str(target)
        raise
    finally:
        with suppress(FileNotFoundError):
            partial.unlink()


def write_gif(path: Path, frames: Iterator[Frame], frames_per_second: float) -> None:
    """Write pictures with one palette and durations that keep time."""
    from PIL import Image

    pictures = [Image.fromarray(frame) for frame in frames]
    palette = _palette(pictures)
    indexed = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    ends = np.round(np.arange(1, len(indexed) + 1) * 1000.0 / frames_per_second / GIF_TICK_MS) * GIF_TICK_MS
    durations = [int(duration) for duration in np.diff(ends, prepend=0.0)]
    durations[-1] = int(LAST_FRAME_TIME * 1000.0)
    look: style.Properties = {"loop": 0, "optimize": True, "disposal": 1}
    indexed[0].save(path, save_all=True, append_images=indexed[1:], duration=durations, **look)


def _palette(pictures: Sequence[Image]) -> Image:
    """Return a picture with a palette for all pictures, made from a few of them."""
    from PIL import Image

    chosen = [pictures[i] for i in np.unique(np.linspace(0, len(pictures) - 1, 5).astype(int))]
    pixels = np.concatenate([np.asarray(picture).reshape(-1, 3) for picture in chosen])
    inked = pixels[pixels.min(axis=1) < NEARLY_WHITE]
    sheet = Image.fromarray(inked[np.newaxis])
    palette = sheet.quantize(colors=COLORS - len(KEPT_COLORS), method=Image.Quantize.MEDIANCUT)
    colors = np.array(palette.getpalette(), dtype=np.int64).reshape(-1, 3)[: COLORS - len(KEPT_COLORS)]
    kept = np.array([[int(color[i : i + 2], 16) for i in (1, 3, 5)] for color in KEPT_COLORS])
    palette.putpalette(np.concatenate([colors, kept]).ravel().tolist())
    return palette


def write_mp4(path: Path, frames: Iterator[Frame], frames_per_second: float) -> None:
    """Pipe pictures into ffmpeg."""
    first = next(frames)
    height, width = (size - size % 2 for size in first.shape[:2])  # the codec wants even numbers
    source = f"-f rawvideo -pix_fmt rgb24 -s {width}x{height} -r {frames_per_second:g} -i -"
    codec = "-an -c:v libx264 -crf 20 -pix_fmt yuv420p -movflags +faststart"
    command = ["ffmpeg", "-y", "-loglevel", "error", *source.split(), *codec.split(), str(path)]
    held = max(1, round(LAST_FRAME_TIME * frames_per_second))
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdin is not None
        assert process.stderr is not None
        with suppress(BrokenPipeError):  # ffmpeg tells why below
            last = first
            for last in _with_first(first, frames):
                process.stdin.write(np.ascontiguousarray(last[:height, :width]).tobytes())
            for _ in range(held):
                process.stdin.write(np.ascontiguousarray(last[:height, :width]).tobytes())
            process.stdin.close()
        reason = process.stderr.read().decode(errors="replace").strip()
    if process.returncode != 0:
        raise HrsafetyError(f"ffmpeg could not write {path.name}: {reason or f'exit status {process.returncode}'}")


def _with_first(first: Frame, rest: Iterator[Frame]) -> Iterator[Frame]:
    """Yield a picture that was taken already, then the rest."""
    yield first
    yield from rest
