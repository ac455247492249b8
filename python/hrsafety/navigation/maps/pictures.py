"""Gray pictures of maps, told by their contents: PGM, or PNG where Pillow is installed."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from hrsafety.errors import InvalidParameterError, MissingExtraError, Shown
from hrsafety.navigation.maps.pgm import GrayImage, check_size, read_pgm

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["read_picture"]

PNG = b"\x89PNG\r\n\x1a\n"
OTHERS = {b"\xff\xd8": "JPEG", b"BM": "BMP", b"GI": "GIF", b"P1": "PBM", b"P3": "PPM", b"P4": "PBM", b"P6": "PPM"}


def read_picture(path: Path) -> GrayImage:
    """Return the gray values of a picture."""
    try:
        with path.open("rb") as file:
            begin = file.read(len(PNG))
        if begin == PNG:
            return _read_png(path)
        if begin[:2] in (b"P2", b"P5"):
            return read_pgm(path)
    except OSError as error:
        raise InvalidParameterError("image", "be readable", Shown(f"{path.name} ({error.strerror or error})")) from None
    kind = OTHERS.get(begin[:2])
    found = f"{path.name}, a {kind} picture" if kind else f"{path.name}, which begins with {begin[:2]!r}"
    remedy = "convert it without loss: mogrify -format png" if kind else None
    raise InvalidParameterError("image", "be a PGM picture, P2 or P5, or a PNG picture", Shown(found), remedy)


def _read_png(path: Path) -> GrayImage:
    """Return the gray values of a PNG: as they are, of colors the mean."""
    try:
        from PIL import Image
    except ImportError:
        raise MissingExtraError(f"{path.name} is a PNG picture and needs Pillow: pip install pillow") from None
    broken = InvalidParameterError("image", "be a whole PNG picture", Shown(path.name))
    with path.open("rb") as file:
        head = file.read(24)
    if len(head) < 24:
        raise broken
    check_size(path, int.from_bytes(head[20:24]), int.from_bytes(head[16:20]))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # the size was checked
            with Image.open(path, formats=("PNG",)) as picture:
                picture.load()
                clear = "transparency" in picture.info
                known = picture.mode in ("L", "LA", "RGB", "RGBA", "I", "I;16", "I;16B") and not clear
                other = "L" if picture.mode == "1" and not clear else "RGBA"
                values = np.asarray(picture if known else picture.convert(other))
    except Image.DecompressionBombError:
        raise InvalidParameterError("image", "have at most 178956970 pixels as PNG", Shown(path.name)) from None
    except Exception:  # whatever a broken file makes of Pillow
        raise broken from None
    if values.ndim == 2:
        return GrayImage(values, 65535 if values.dtype.itemsize > 1 else 255)
    hidden = values[..., -1] < 255 if values.shape[2] in (2, 4) else None
    colors = values.shape[2] - (hidden is not None)
    return GrayImage(values[..., :colors].sum(axis=2, dtype=np.uint16), 255 * colors, hidden)
