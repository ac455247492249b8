"""Floor plans of CAD programs: DXF in text."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from io import StringIO
from typing import Any, NamedTuple

from hrsafety._arguments import Pair, flag, meant, not_negative, sequence, word
from hrsafety.errors import FileError, InvalidParameterError, MissingExtraError, Shown
from hrsafety.io.places.curves import arc_points, bulge_points
from hrsafety.io.places.drawing import UNITS, FloorPlan, check_size
from hrsafety.io.reader import Document
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.plausibility import ResultWarning

__all__ = ["is_dxf", "read_dxf"]

BINARY = b"AutoCAD Binary DXF"
SAME = 1e-6
"""A line continues where another one ends if its start is at most so far away, in m."""
MOST_BULGE = 1e6
MOST_STREAMED = 1 << 27
MOST_EXPANDED = 100_000
"""Entities with those of blocks, some kilobytes each."""
MOST_NESTED = 16
"""Blocks within blocks."""
_INSUNITS = {1: "inch", 2: "ft", 4: "mm", 5: "cm", 6: "m"}
_READ = frozenset(("LINE", "LWPOLYLINE", "POLYLINE", "VERTEX", "ARC", "CIRCLE"))
_PLACE = (8, 67)
"""Groups of the layer and of the space, paper or model."""
_WIDTHS = (40, 41, 43)
_CLOSED, _SURFACE, _SPLINE_FRAME = 1, 16 | 64, 16
_BEGIN = re.compile(rb"\A(?:\xef\xbb\xbf)?(?:\s*999[ \t]*\r?\n[^\n]*\n)*\s*0[ \t]*\r?\n[ \t]*SECTION[ \t]*\r?\n")


class Group(NamedTuple):
    """A pair of a DXF file: its code, its value, and the line of the value."""

    code: int
    value: str
    line: int


class Entity(NamedTuple):
    """An entity with its groups."""

    kind: str
    line: int
    groups: list[Group]

    def text(self, code: int, default: str) -> str:
        """Return the first value under a code."""
        return next((each.value for each in self.groups if each.code == code), default)


def is_dxf(document: Document) -> bool:
    """Return whether a file is DXF, in text or binary."""
    return _BEGIN.match(document.head) is not None or document.head.startswith(BINARY)


def read_dxf(
    document: Document,
    *,
    unit: str | None = None,
    layers: Iterable[str] | None = None,
    blocks: bool = False,
    radius: float = 0.0,
) -> StaticMap:
    """Return the walls of a DXF file; see `load_map`."""
    thickness = not_negative("radius", radius)
    expands = flag("blocks", blocks)
    if document.head.startswith(BINARY):
        raise document.error("unreadable", "be DXF in text", Shown("binary DXF"), "save it as DXF in text (ASCII)")
    check_size(document, MOST_STREAMED)
    drawing = FloorPlan(document, thickness)
    walls = _Walls(drawing, _scale(drawing, unit))
    entities = _entities(document, _expanded(document) if expands else document.text)
    for entity in entities if layers is None else _on_layers(entities, layers):
        walls.add(entity)
    walls.end()
    hint = "blocks=True reads what INSERT places" if drawing.skipped["INSERT"] else ""
    return drawing.map('unit="m", "cm", "mm", "inch" or "ft"', hint)


def _expanded(document: Document) -> str:
    """Return the text of a file with its blocks replaced by what they hold, by ezdxf."""
    try:
        import ezdxf.document
    except ImportError:
        raise MissingExtraError(f"the blocks of {document.name} need ezdxf: pip install 'hrsafety[plans]'") from None
    check_size(document)
    for _ in _groups(document, document.text):  # errors in the file's own lines come first
        pass
    read: Any = ezdxf.document.Drawing.read
    stream = StringIO()
    try:
        drawing = read(StringIO(document.text, newline=None))
        space = drawing.modelspace()
        for _ in range(MOST_NESTED):
            for insert in space.query("INSERT"):
                block = insert.block()
                size = insert.mcount * (len(block) if block is not None else 0)
                if len(space) + size > MOST_EXPANDED:
                    rule = f"hold at most {MOST_EXPANDED} entities with its blocks"
                    raise document.error("too_large", rule, Shown(f"{len(space) + size}"))
                for part in insert.multi_insert() if insert.mcount > 1 else (insert,):
                    for entity in part.virtual_entities():
                        space.add_entity(entity)
                space.delete_entity(insert)
        drawing.write(stream)
    except FileError:
        raise
    except Exception as error:  # whatever a broken file makes of ezdxf
        shown = Shown(str(error)[:120] or type(error).__name__)
        raise document.error("unreadable", "have blocks that ezdxf reads", shown) from None
    return stream.getvalue()


def _groups(document: Document, text: str) -> Iterator[Group]:
    """Yield the pairs of lines of a file up to its end."""
    lines = enumerate(StringIO(text, newline=None), start=1)
    number = 0
    for number, line in lines:
        code, value = line.strip(), next(lines, (0, ""))[1].strip()
        if not re.fullmatch(r"-?\d{1,4}", code, re.ASCII):
            raise document.error("unreadable", "be the number of a group, as every second line", code, line=number)
        yield Group(int(code), value, number + 1)
        if code == "0" and value == "EOF":
            return
    raise document.error("unreadable", "end with 0 and EOF", Shown("the end of the file"), line=number)


def _scale(drawing: FloorPlan, unit: str | None) -> float:
    """Return the meters of a unit, as told or as $INSUNITS says."""
    told = None if unit is None else word("unit", unit, tuple(UNITS))
    value, named = "0", False
    for group in _groups(drawing.document, drawing.document.text):
        if named or (group.code, group.value) == (2, "ENTITIES"):
            value = group.value if named else value
            break
        named = (group.code, group.value) == (9, "$INSUNITS")
    said = _INSUNITS.get(int(value)) if re.fullmatch(r"\d{1,3}", value, re.ASCII) else None
    if told is None and said is None:
        remedy = 'say it: unit="mm", for example'
        raise drawing.error("unit_needed", "say its unit", Shown(f"$INSUNITS {value}"), remedy, key="$INSUNITS")
    if told is not None and said is not None and told != said:
        message = f"unit={told!r} counts, though $INSUNITS of {drawing.document.name} says {said}"
        drawing.doubts.append(ResultWarning("unit_contradicts_file", "unit", message))
    return UNITS[told or said or "m"]


def _entities(document: Document, text: str) -> Iterator[Entity]:
    """Yield the entities of the section of that name; vertices stay behind their polyline."""
    section, begins = "", False
    entity: Entity | None = None
    for group in _groups(document, text):
        if begins and group.code == 2:
            section = group.value
        begins = (group.code, group.value) == (0, "SECTION")
        if group.code == 0:
            if entity is not None:
                yield entity
            entity = Entity(group.value, group.line, []) if section == "ENTITIES" and group.value != "ENDSEC" else None
            section = "" if group.value == "ENDSEC" else section
        elif entity is not None and (entity.kind in _READ or group.code in _PLACE):
            entity.groups.append(group)
    if section:
        raise document.error("unreadable", "end every section with ENDSEC", Shown(f"{section} without"))


def _on_layers(entities: Iterable[Entity], layers: Iterable[str]) -> Iterator[Entity]:
    """Yield the entities on some layers; vertices are on that of their polyline."""
    given = sequence("layers", "be names of layers", layers)
    wanted = {each.casefold() if isinstance(each, str) else "" for each in given}
    known: set[str] = set()
    inside = False
    for entity in entities:
        if entity.kind not in ("VERTEX", "SEQEND"):
            name = entity.text(8, "0")
            known.add(name)
            inside = name.casefold() in wanted
        if inside:
            yield entity
    missing = wanted - {each.casefold() for each in known}
    if missing or not wanted:
        shown = ", ".join(sorted(known)[:20]) or "none"
        guess = meant(min(missing), [each.casefold() for each in known]) if missing else None
        raise InvalidParameterError("layers", f"be names of layers with entities, which are {shown}", given, guess)


class _Walls:
    """Walls of entities, one after the other."""

    def __init__(self, drawing: FloorPlan, scale: float) -> None:
        self.drawing = drawing
        self.scale = scale
        self.open_polyline: tuple[Entity, list[Entity]] | None = None
        self.chain: list[Pair] = []
        self.chain_line = 0

    def add(self, entity: Entity) -> None:
        """Add the walls of an entity, or count it as skipped."""
        kind = entity.kind
        if kind == "VERTEX" and self.open_polyline is not None:
            self.open_polyline[1].append(entity)
            return
        if kind == "SEQEND":
            self.polyline(entity)
            return
        if self.open_polyline is not None:
            rule = "end the vertices of a POLYLINE with SEQEND"
            raise self.drawing.error("unreadable", rule, Shown(kind), line=entity.line)
        if entity.text(67, "0") == "1":
            self.drawing.skipped[f"{kind} on paper"] += 1
        elif kind == "LINE":
            self.line(entity, self.place(entity, 10), self.place(entity, 11))
        elif kind == "LWPOLYLINE":
            self.lightweight(entity)
        elif kind in ("ARC", "CIRCLE"):
            self.arc(entity)
        elif kind == "POLYLINE":
            self.open_polyline = (entity, [])
        else:
            self.drawing.skipped[kind] += 1

    def line(self, entity: Entity, first: Pair, last: Pair) -> None:
        """Begin a wall, or let the one before continue along a line that begins where it ended."""
        if first == last:
            self.drawing.skipped["LINE without length"] += 1
            return
        if not self.chain or math.dist(self.chain[-1], first) > SAME:
            self.end_chain()
            self.chain, self.chain_line = [first], entity.line
        closes = len(self.chain) > 2 and math.dist(self.chain[0], last) <= SAME
        self.chain.append(self.chain[0] if closes else last)
        if closes:
            self.end_chain()

    def end_chain(self) -> None:
        """Add the wall of the lines before."""
        if self.chain:
            self.drawing.add("LINE", self.chain, line=self.chain_line)
        self.chain = []

    def end(self) -> None:
        """Add what is left at the end."""
        if self.open_polyline is not None:
            entity = self.open_polyline[0]
            raise self.drawing.error("unreadable", "end its vertices with SEQEND", Shown("none"), line=entity.line)
        self.end_chain()

    def lightweight(self, entity: Entity) -> None:
        """Add a polyline whose vertices stand in its groups."""
        corners: list[tuple[float, float, float]] = []
        for group in entity.groups:
            if group.code == 10:
                corners.append((self.number(group), math.nan, 0.0))
            elif group.code in (20, 42) and corners:
                x, y, bulge = corners[-1]
                corners[-1] = (x, self.number(group), bulge) if group.code == 20 else (x, y, self.number(group))
        self.outline(entity, corners, [entity])

    def polyline(self, end: Entity) -> None:
        """Add a polyline whose vertices were entities of their own."""
        if self.open_polyline is None:
            self.drawing.skipped[end.kind] += 1
            return
        entity, vertices = self.open_polyline
        self.open_polyline = None
        if self.flags(entity) & _SURFACE:
            self.drawing.skipped["POLYLINE of a surface"] += 1
            return
        corners = [
            (self.value(each, 10), self.value(each, 20), self.value(each, 42, 0.0))
            for each in vertices
            if not self.flags(each) & _SPLINE_FRAME
        ]
        self.outline(entity, corners, [entity, *vertices])

    def outline(self, entity: Entity, corners: list[tuple[float, float, float]], parts: list[Entity]) -> None:
        """Add a polyline of corners, each with the bulge of what follows, as thick as its widest part."""
        side = self.side(entity)
        if side == 0.0:
            return
        self.end_chain()
        ways = [*corners, *corners[:1]] if self.flags(entity) & _CLOSED else corners
        widths = [self.number(group) for part in parts for group in part.groups if group.code in _WIDTHS]
        width = max((abs(each) for each in widths), default=0.0) * self.scale
        self.drawing.add(entity.kind, self.bent(entity, ways, side), width=width, line=entity.line)

    def bent(self, entity: Entity, corners: list[tuple[float, float, float]], side: float) -> Iterator[Pair]:
        """Yield the points of a polyline in m."""
        before: tuple[Pair, float] | None = None
        for x, y, bulge in corners:
            if not math.isfinite(y):
                raise self.drawing.error("unreadable", "have x and y of every vertex", Shown("no y"), line=entity.line)
            if abs(bulge) > MOST_BULGE:
                rule = f"have bulges of at most {MOST_BULGE:g}"
                raise self.drawing.error("unreadable", rule, bulge, line=entity.line)
            place = (side * x * self.scale, y * self.scale)
            if before is None:
                yield place
            else:
                yield from bulge_points(before[0], place, side * before[1])
            before = place, bulge

    def arc(self, entity: Entity) -> None:
        """Add an arc or a circle."""
        side = self.side(entity)
        if side == 0.0:
            return
        self.end_chain()
        x, y = self.place(entity, 10)
        radius = self.value(entity, 40) * self.scale
        if radius < 0.0:
            raise self.drawing.error("unreadable", "have a radius that is not negative", radius, line=entity.line)
        start, sweep = 0.0, 2.0 * math.pi
        if entity.kind == "ARC":
            start = math.radians(self.value(entity, 50))
            turn = (math.radians(self.value(entity, 51)) - start) % (2.0 * math.pi)
            sweep = turn or 2.0 * math.pi
        points = ((side * u, v) for u, v in arc_points((x, y), radius, start, sweep))
        self.drawing.add(entity.kind, points, line=entity.line, ring=sweep == 2.0 * math.pi)

    # ---- groups ----------------------------------------------------------------------------------

    def side(self, entity: Entity) -> float:
        """Return 1, -1 for entities that are drawn from below, 0 for tilted ones, which are skipped."""
        normal = [self.value(entity, code, default) for code, default in ((210, 0.0), (220, 0.0), (230, 1.0))]
        if abs(normal[0]) < SAME and abs(normal[1]) < SAME and normal[2]:
            return math.copysign(1.0, normal[2])
        self.drawing.skipped[f"{entity.kind} that is tilted"] += 1
        return 0.0

    def flags(self, entity: Entity) -> int:
        value = self.value(entity, 70, 0.0)
        return int(value)

    def place(self, entity: Entity, code: int) -> Pair:
        return self.value(entity, code) * self.scale, self.value(entity, code + 10) * self.scale

    def value(self, entity: Entity, code: int, default: float | None = None) -> float:
        group = next((each for each in entity.groups if each.code == code), None)
        if group is not None:
            return self.number(group)
        if default is None:
            rule = f"have a group {code} in its {entity.kind}"
            raise self.drawing.error("unreadable", rule, Shown("none"), line=entity.line)
        return default

    def number(self, group: Group) -> float:
        try:
            value = float(group.value)
        except ValueError:
            value = math.nan
        if not abs(value) < 1e15:
            raise self.drawing.error("unreadable_number", "be a finite number", group.value, line=group.line)
        return value
