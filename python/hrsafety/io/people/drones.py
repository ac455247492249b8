"""Traffic seen from above: Stanford Drone, inD and rounD."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety.errors import Shown
from hrsafety.io.cells import Columns, TableColumn, read_columns
from hrsafety.io.headers import Header, first_row, header_of
from hrsafety.io.people.request import Request
from hrsafety.io.people.rows import Rows, assumed, lost_rows
from hrsafety.io.people.tables import of_classes
from hrsafety.io.reader import Document, Reader
from hrsafety.plausibility import ResultWarning

__all__ = ["READERS"]

Array = npt.NDArray[np.float64]

SDD_RATE = 30.0
_SDD = ("track", "xmin", "ymin", "xmax", "ymax", "frame", "lost", "occluded", "generated", "label")
_IND = ("trackId", "frame", "xCenter", "yCenter")


def _is_sdd(document: Document) -> bool:
    _, line = first_row(document)
    cells = line.split(None, 9)
    return len(cells) == 10 and cells[9].strip().startswith('"') and all(_is_whole(each) for each in cells[5:9])


def _is_whole(text: str) -> bool:
    return text.lstrip("+-").isdigit()


def _read_sdd(document: Document, request: Request) -> Rows:
    skip, _ = first_row(document)
    table = read_columns(
        document,
        delimiter=" ",
        skip=max(skip, 0),
        columns=10,
        numbers=[TableColumn(place, _SDD[place]) for place in (5, 1, 2, 3, 4, 6)],
        ids=TableColumn(0, "track"),
        words=[TableColumn(9, "label")],
    )
    which, notes, details = of_classes(table.words[:, 0], request, document)
    lost = which & (table.numbers[:, 5] != 0.0)
    if lost.any():
        notes = [lost_rows(document, lost, table.lines, table.ids), *notes]
        details = details | {"lost_rows": int(lost.sum())}
    which = which & ~lost
    box = table.numbers[which, 1:5]
    return Rows(
        clock=table.numbers[which, 0],
        person=table.ids[which],
        position=0.5 * (box[:, :2] + box[:, 2:]),
        lines=table.lines[which],
        frames=True,
        rate_of_format=SDD_RATE,
        unit="px",
        unit_fixed=False,
        flip=True,
        format="sdd",
        notes=tuple(notes),
        details=details,
    )


def _names(document: Document) -> list[str]:
    header = header_of(document, {})
    return [] if header is None else header.names


def _is_ind(document: Document) -> bool:
    names = _names(document)
    return set(_IND) <= set(names) or {"trackId", "initialFrame", "class"} <= set(names) or "frameRate" in names


def _table(document: Document, numbers: list[str], ids: str | None, words: list[str] | None = None) -> Columns:
    """Return named columns of one of the files."""
    header = header_of(document, {})
    names = [] if header is None else header.names
    wanted = [*numbers, *([ids] if ids else []), *(words or [])]
    absent = [each for each in wanted if each not in names]
    if header is None or absent:
        raise document.error("ambiguous_columns", f"have the column {', '.join(absent or wanted)}", Shown("none"))
    place = {each: TableColumn(_place(document, header, each), each) for each in wanted}
    return read_columns(
        document,
        delimiter=header.delimiter,
        skip=header.skip,
        columns=len(names),
        numbers=[place[each] for each in numbers],
        ids=place[ids] if ids else None,
        words=[place[each] for each in words or []],
    )


def _place(document: Document, header: Header, name: str) -> int:
    if header.names.count(name) > 1:
        found = Shown(str(header.names.count(name)))
        raise document.error("ambiguous_columns", f"have one column {name}", found, line=header.skip)
    return header.names.index(name)


def _read_ind(document: Document, request: Request) -> Rows:
    names = _names(document)
    if not set(_IND) <= set(names):
        rule = f"be the file of tracks, with the columns {', '.join(_IND)}"
        raise document.error(
            "ambiguous_columns", rule, Shown(document.name), "give NN_tracks.csv; the others are found beside it"
        )
    speeds = ["xVelocity", "yVelocity"] if {"xVelocity", "yVelocity"} <= set(names) else []
    table = _table(document, ["frame", "xCenter", "yCenter", *speeds], "trackId")
    which, notes, details = _of_people(document, request, table)
    return Rows(
        clock=table.numbers[which, 0],
        person=table.ids[which],
        position=table.numbers[which, 1:3],
        velocity=table.numbers[which, 3:5] if speeds else None,
        lines=table.lines[which],
        frames=True,
        rate=_rate(document, request),
        unit="m",
        format="ind",
        notes=tuple(notes),
        details=details,
    )


def _beside(document: Document, request: Request, name: str) -> Document | None:
    """Return another file of the same recording."""
    stem = document.name
    if "tracks" not in stem:
        return None
    place = document.path.with_name(stem.replace("tracks", name))
    if not place.is_file():
        return None
    found = Document(place)
    request.beside.append(found)
    return found


def _of_people(
    document: Document, request: Request, table: Columns
) -> tuple[npt.NDArray[np.bool_], list[ResultWarning], dict[str, Any]]:
    """Return which rows are of people, by the classes of the tracks."""
    meta = _beside(document, request, "tracksMeta")
    if meta is None:
        message = (
            f"{document.name} stands without its file of classes, NN_tracksMeta.csv: all tracks are taken as people"
        )
        return np.ones(len(table.ids), dtype=np.bool_), [assumed("classes", message)], {}
    told = _table(meta, [], "trackId", ["class"])
    label = dict(zip(told.ids.tolist(), told.words[:, 0].tolist(), strict=True))
    different, index = np.unique(table.ids, return_inverse=True)
    unknown = [each for each in different.tolist() if each not in label]
    if unknown:
        raise meta.error(
            "no_rows", f"have a row of each track of {document.name}", Shown(f"none of track {unknown[0]}")
        )
    labels = np.array([label[each] for each in different.tolist()], dtype=np.str_)
    return of_classes(labels[index.ravel()], request, document)


def _rate(document: Document, request: Request) -> float | None:
    meta = _beside(document, request, "recordingMeta")
    if meta is None:
        return None
    rates = _table(meta, ["frameRate"], None).numbers[:, 0]
    if len(rates) != 1 or not rates[0] > 0.0:
        found = Shown(", ".join(f"{each:g}" for each in rates[:5].tolist()) or "none")
        raise meta.error("frame_rate_needed", "have one positive frameRate", found)
    return float(rates[0])


READERS = [
    Reader(
        name="sdd",
        title="Stanford Drone: track, box, frame, lost, occluded, generated, label",
        recognizes=_is_sdd,
        read=_read_sdd,
    ),
    Reader(
        name="ind",
        title="inD, rounD: NN_tracks.csv beside NN_tracksMeta.csv and NN_recordingMeta.csv",
        recognizes=_is_ind,
        read=_read_ind,
    ),
]
