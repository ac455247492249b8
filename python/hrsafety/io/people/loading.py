"""`load_people`: recorded people in any known layout."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any

import numpy.typing as npt

from hrsafety.datasets.recording import Recording
from hrsafety.errors import Shown
from hrsafety.io.people.building import recording_of
from hrsafety.io.people.request import Request
from hrsafety.io.reader import Document, reader_of
from hrsafety.plausibility import telling

__all__ = ["load_people"]


@telling()
def load_people(
    path: str | PathLike[str],
    *,
    format: str | None = None,  # the word of the field
    fps: float | None = None,
    step_s: float | None = None,
    unit: str | None = None,
    scale: float | None = None,
    homography: npt.ArrayLike | str | PathLike[str] | None = None,
    columns: str | Sequence[str] | Mapping[str, str] | None = None,
    classes: str | Sequence[str] = ("pedestrian",),
    relabel: bool = False,
) -> Recording:
    r"""Read recorded people in any layout that researchers publish, recognized by the contents of the file.

    Time 0 is the first row that is kept; ids are those of the file. What the file does not say is asked for; what was
    taken from evidence is told as ``assumed`` in `Recording.warnings`, beside everything else that is doubtful.

    Parameters
    ----------
    path : path-like
        The file. Of inD it is ``NN_tracks.csv``; the others are found beside it.
    format : str or None
        ``eth``, ``ucy``, ``trajnet``, ``trajnet++``, ``sdd``, ``ind``, ``petrack``, ``jupedsim-text``,
        ``jupedsim-sqlite``, ``juelich-hdf5``, ``atc``, ``thor``, ``thor-magni``, ``citr``, ``socnavdata``, ``table``,
        ``columns`` (bare numbers); ``None``: by the contents.
    fps : float or None
        Units of the frame column per second.
    step_s : float or None
        Instead of ``fps``: time in s between two rows of a person.
    unit : {"m", "cm", "mm", "km"} or None
        Of the positions, if the file does not say it.
    scale : float or None
        Instead of ``unit``: meters of a unit of the positions, for example of a pixel.
    homography : array_like, shape (3, 3), path-like or None
        Instead of ``scale``: matrix H from pixels to meters, ``X = H (x, y, 1)/w``, or a text file with it.
    columns : str, sequence of str, mapping or None
        Names of the columns of a table, ``"id frame x_cm y_cm"``, or of some of them, ``{"number": "id"}``; ``"-"``
        leaves one out.
    classes : str or sequence of str
        Which road users are taken, of files that have several.
    relabel : bool
        Whether two people who exchange their ids (``identity_switch``) exchange them again.

    Returns
    -------
    Recording
        With ``source``, ``frame_rate`` and, if the file has them, ``velocity``, ``walls`` and ``robot``.

    Raises
    ------
    FileError
        If the file cannot be read, does not say what is needed, or contradicts itself or an argument; the message
        names file, line, rule and value.
    InvalidParameterError
        If an argument is out of range.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import io
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     table = pathlib.Path(folder, "walk.csv")
    ...     _ = table.write_text("Zeit [s];Person;X [cm];Y [cm]\n0,0;7;0;100\n0,4;7;50;100\n")
    ...     walk = io.load_people(table)
    >>> walk.source.format, walk.duration, walk.position.tolist()
    ('table', 0.4, [[0.0, 1.0], [0.5, 1.0]])
    """
    given: dict[str, Any] = {
        "format": format,
        "fps": fps,
        "step_s": step_s,
        "unit": unit,
        "scale": scale,
        "homography": homography,
    }
    given |= {"columns": columns, "classes": classes, "relabel": relabel}
    request = Request.checked(path, given)
    document = Document(path)
    if not document.data or document.data.isspace():
        raise document.error("no_rows", "hold at least one row of a person", Shown("an empty file"))
    reader = reader_of("people", document, request.format)
    recording = recording_of(document, reader.read(document, request), request)
    return recording.relabeled() if request.relabel else recording
