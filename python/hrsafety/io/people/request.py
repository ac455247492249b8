"""Arguments of a caller about a file of recorded people."""

from __future__ import annotations

import hashlib
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import flag, positive, word
from hrsafety._records import dataclass
from hrsafety._sources import Provenance
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.io.headers import LENGTHS
from hrsafety.io.reader import Document

__all__ = ["Request"]

Array = npt.NDArray[np.float64]
DEFAULTS = {"classes": ("pedestrian",), "relabel": False}


@dataclass(frozen=True, kw_only=True, slots=True)
class Request:
    """Arguments of `load_people`, checked.

    Attributes
    ----------
    format, fps, step_s, unit, scale, homography, columns, classes, relabel
        See `load_people`.
    beside : list of Document
        Other files that were read with the first one.
    path : str
        The file as it was given.
    """

    path: str
    format: str | None
    fps: float | None
    step_s: float | None
    unit: str | None
    scale: float | None
    homography: Any
    columns: Any
    classes: tuple[str, ...]
    relabel: bool
    beside: list[Document]

    @classmethod
    def checked(cls, path: str | PathLike[str], given: dict[str, Any]) -> Request:
        """Return arguments after a check of each.

        Raises
        ------
        InvalidParameterError
            If one is out of range, or two contradict each other.
        """
        found = dict(given)
        for name in ("fps", "step_s", "scale"):
            if found[name] is not None:
                found[name] = positive(name, found[name])
        if found["fps"] is not None and found["step_s"] is not None:
            raise InvalidParameterError("step_s", "be left out where fps is given", found["step_s"])
        if found["unit"] is not None:
            word("unit", found["unit"], list(LENGTHS))
        told = [name for name in ("unit", "scale", "homography") if found[name] is not None]
        if len(told) > 1:
            raise InvalidParameterError(told[1], f"be left out where {told[0]} is given", found[told[1]])
        classes = found["classes"]
        classes = (classes,) if isinstance(classes, str) else classes
        if not isinstance(classes, tuple | list | set | frozenset) or not all(
            isinstance(each, str) for each in classes
        ):
            raise InvalidParameterError("classes", "be words, the classes that are people", found["classes"])
        found["classes"] = tuple(classes)
        found["relabel"] = flag("relabel", found["relabel"])
        if found["format"] is not None and not isinstance(found["format"], str):
            raise InvalidParameterError("format", "be the name of a format", found["format"])
        return cls(path=str(path), beside=[], **found)

    def scale_of_unit(self) -> float | None:
        """Return the meters of a unit of the file, if the caller says it."""
        return LENGTHS[self.unit] if self.unit is not None else self.scale

    def matrix(self, document: Document) -> Array | None:
        """Return the homography as a matrix, read from a text file if it is the path of one.

        Raises
        ------
        InvalidParameterError
            If it is no invertible 3 by 3 matrix.
        """
        value = self.homography
        if value is None:
            return None
        if isinstance(value, str | PathLike):
            place = Path(value)
            file = Document(place if place.exists() else document.path.parent / place, "homography")
            self.beside.append(file)
            value = [line.replace(",", " ").split() for line in file.lines if line.strip()]
        rule = "be an invertible 3 by 3 matrix, or a text file with one"
        try:
            matrix = np.array(value, dtype=np.float64)
        except (TypeError, ValueError, OverflowError):
            raise InvalidParameterError("homography", rule, self.homography) from None
        if matrix.shape != (3, 3) or not np.isfinite(matrix).all():
            raise InvalidParameterError("homography", rule, Shown(f"{self.homography} of shape {matrix.shape}"))
        if abs(np.linalg.det(matrix / np.abs(matrix).max())) < 1e-300:
            raise InvalidParameterError("homography", rule, Shown("one with determinant 0"))
        return matrix

    def source(self, document: Document, form: str) -> Provenance:
        """Return where the recording came from."""
        files = sorted([document, *self.beside], key=lambda each: each.name)
        digest = document.sha256
        if len(files) > 1:
            digest = hashlib.sha256("".join(each.sha256 for each in files).encode()).hexdigest()
        names = ("format", "fps", "step_s", "unit", "scale", "homography", "columns", "classes", "relabel")
        told = {name: getattr(self, name) for name in names}
        told = {name: value for name, value in told.items() if value is not None and value != DEFAULTS.get(name)}
        return Provenance(path=self.path, format=form, sha256=digest, arguments=told)
