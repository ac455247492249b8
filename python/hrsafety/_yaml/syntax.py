"""Grammar of the YAML that robots are configured with: text to nodes that know where they stand."""

from __future__ import annotations

import re
from typing import NoReturn

from hrsafety._yaml.nodes import BREAK, Node, Path, YamlText, key_path, resolved
from hrsafety.errors import FileError, Shown

__all__ = ["parsed"]

MOST_CHARACTERS = 1 << 22
MOST_DEPTH = 64
MOST_NODES = 200_000
_FORBIDDEN = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")
_GAP = re.compile(rf"(?:[ \t]+|{BREAK}|(?:(?<=[ \t\r\n])|\A)#[^\r\n]*)+")
_LINE_END = re.compile(rf"[ \t]*(?:(?<=[ \t])#[^\r\n]*)?(?={BREAK}|\Z)")
_MARKER = re.compile(r"^(?:---|\.\.\.)(?=\s|\Z)", re.MULTILINE)
_PROLOG = re.compile(rf"\ufeff?(?:[ \t]*(?:#[^\r\n]*)?{BREAK}|%[^\r\n]*{BREAK})*---(?=\s|\Z)")
_PLAIN = re.compile(r"(?:[^\s\-?:,\[\]{}#&*!|>'\"%@`]|[\-?:](?=\S))(?:[^\s:#]|:(?=\S)|(?<!\s)#|[ \t]++(?=[^\s#]))*+")
_PLAIN_MORE = re.compile(r"(?:[^\s:#]|:(?=\S)|(?<!\s)#|[ \t]++(?=[^\s#]))++")
_PLAIN_FLOW = re.compile(
    r"(?:[^\s\-?:,\[\]{}#&*!|>'\"%@`]|[\-:](?=[^\s,\[\]{}]))"
    r"(?:[^\s:#,\[\]{}]|:(?=[^\s,\[\]{}])|(?<!\s)#|[ \t]++(?=[^\s#,\[\]{}]))*+"
)
_PLAIN_FLOW_MORE = re.compile(r"(?:[^\s:#,\[\]{}]|:(?=[^\s,\[\]{}])|(?<!\s)#|[ \t]++(?=[^\s#,\[\]{}]))++")
_QUOTED = re.compile(r""""[^"\\]*+(?:\\.[^"\\]*+)*+"|'[^']*+(?:''[^']*+)*+'""", re.DOTALL)
_COLON = re.compile(r"[ \t]*:(?=\s|\Z)")
_COLON_FLOW = re.compile(r"[ \t]*:(?=[\s,\[\]{}]|\Z)")
_NAME = re.compile(r"[&*]([^\s,\[\]{}]+)")
_BLOCK_HEAD = re.compile(rf"[|>]([+-]?)([1-9]?)([+-]?)[ \t]*(?:(?<=[ \t])#[^\r\n]*)?(?:{BREAK}|\Z)")
_MORE_LINE = re.compile(rf"[ \t]*((?:{BREAK}[ \t]*)+)(?=\S)")
_FOLDED = re.compile(
    rf"\\{BREAK}((?:[ \t]*{BREAK})*)[ \t]*|[ \t]*{BREAK}((?:[ \t]*{BREAK})*)[ \t]*|[ \t]+"
    r"|\\(?:x([0-9a-fA-F]{2})|u([0-9a-fA-F]{4})|U([0-9a-fA-F]{8})|(.))",
    re.DOTALL,
)
_ESCAPES = dict(zip('0abt\tnvfre "/\\N_LP', '\0\a\b\t\t\n\v\f\r\x1b "/\\\x85\xa0\u2028\u2029', strict=True))


def parsed(source: YamlText) -> Node:
    """Return the first document of a text.

    Parameters
    ----------
    source : YamlText
        Block and flow maps and lists, plain, quoted and block scalars, comments, anchors and aliases.

    Returns
    -------
    Node
        What the document holds; ``value`` is ``None`` if it holds nothing.

    Raises
    ------
    FileError
        If a line breaks a rule of YAML, a key stands twice, something outside of this subset is used (tags, merges,
        keys that are no words), or it is nested deeper than 64 or holds more than 200,000 values.
    """
    return _Parser(source).document()


class _Parser:
    """Descent through one document; the place is that of the next character."""

    def __init__(self, source: YamlText) -> None:
        self.source = source
        if len(source.text) > MOST_CHARACTERS:
            shown = Shown(f"{len(source.text)}")
            raise FileError(source.name, f"be YAML of at most {MOST_CHARACTERS} characters", shown, code="too_large")
        bad = _FORBIDDEN.search(source.text)
        if bad is not None:
            raise source.error(bad.start(), "hold no control characters")
        prolog = _PROLOG.match(source.text)
        self.at = prolog.end() if prolog else int(source.text.startswith("\ufeff"))
        end = _MARKER.search(source.text, self.at)
        self.text = source.text[: end.start()] if end else source.text
        self.anchors: dict[str, Node] = {}
        self.end_of_key = self.nodes = self.depth = self.depth_of_flow = 0

    def document(self) -> Node:
        root = self.block((), -1, compact=True)
        self.skip()
        if self.at < len(self.text):
            self.fail("be lines 'key: value' of a map, or items of a list, below each other")
        return root

    # ---- places ----------------------------------------------------------------------------------

    def fail(self, requirement: str, at: int | None = None, remedy: str | None = None) -> NoReturn:
        raise self.source.error(self.at if at is None else at, requirement, remedy)

    def column(self) -> int:
        return self.at - self.source.line_start(self.at)

    def skip(self) -> bool:
        """Advance to the next content; returns whether it stands in another line."""
        before = self.at
        if match := _GAP.match(self.text, self.at):
            self.at = match.end()
        return self.source.line(before) != self.source.line(self.at)

    def peek(self) -> str:
        return self.text[self.at : self.at + 1]

    def take(self, pattern: re.Pattern[str]) -> re.Match[str] | None:
        if match := pattern.match(self.text, self.at):
            self.at = match.end()
        return match

    def is_item(self) -> bool:
        return self.peek() == "-" and self.text[self.at + 1 : self.at + 2] in ("", " ", "\t", "\r", "\n")

    def counted(self, size: int) -> None:
        self.nodes += size
        if self.nodes > MOST_NODES:
            self.fail(f"hold at most {MOST_NODES} values")

    def no_tabs(self) -> None:
        begin = self.source.line_start(self.at)
        if "\t" in self.text[begin : self.at]:
            self.fail("be indented by blanks", begin, "replace the tabs by blanks")

    def deeper(self) -> None:
        self.depth += 1
        if self.depth > MOST_DEPTH:
            self.fail(f"be nested at most {MOST_DEPTH} deep")

    # ---- blocks ----------------------------------------------------------------------------------

    def block(self, path: Path, indent: int, *, compact: bool = False, under_key: bool = False) -> Node:
        """Return the value that stands here or in the lines below that are indented more."""
        empty = Node(self.source, path, self.at)
        self.counted(1)
        crossed = self.skip()
        anchor = self.anchor()
        if anchor:
            empty.start = empty.stop = self.at
            compact = crossed = self.skip()
        aside = self.at < len(self.text) and (not crossed or self.column() > indent)
        beside = under_key and self.at < len(self.text) and self.column() == indent and self.is_item()
        if not (aside or beside):
            self.at = empty.stop
            return self.named(anchor, empty)
        found = Node(self.source, path, self.at)
        allowed = crossed or compact or indent < 0
        self.deeper()
        if self.is_item():
            self.check_block(allowed)
            self.items(found)
        elif (key := self.key()) is not None:
            self.check_block(allowed)
            self.entries(found, key)
        else:
            if crossed or indent < 0:
                self.no_tabs()
            found = self.scalar_or_flow(found, indent)
        self.depth -= 1
        return self.named(anchor, found)

    def check_block(self, allowed: bool) -> None:
        if not allowed:
            self.fail("hold one 'key: value'", remedy="text with ': ' or a leading '- ' needs quotes")
        self.no_tabs()

    def items(self, found: Node) -> None:
        column, values = self.column(), list[Node]()
        while True:
            self.at += 1
            values.append(self.block((*found.path, len(values)), column, compact=True))
            found.stop = self.at
            if not self.goes_on(column) or not self.is_item():
                break
        self.at = found.stop
        found.value = values

    def entries(self, found: Node, first: str) -> None:
        column, values = self.column(), dict[str, Node]()
        key: str | None = first
        while key is not None:
            self.new_key(found, values, key)
            self.at = self.end_of_key
            values[key] = self.block((*found.path, key), column, under_key=True)
            found.stop = self.at
            if not self.goes_on(column):
                break
            key = self.key()
            if key is None:
                self.fail("be lines 'key: value' of a map")
        self.at = found.stop
        found.value = values

    def goes_on(self, column: int) -> bool:
        """Advance to the next content; returns whether it stands in the column of a block, and not left of it."""
        before = self.at
        crossed = self.skip()
        if self.at >= len(self.text) or (crossed and self.column() < column):
            return False
        if not crossed:
            self.at = before
            self.fail("end after its value")
        self.no_tabs()
        if self.column() > column:
            self.fail("be indented as the lines above")
        return True

    def key(self) -> str | None:
        """Return the key of a map if one stands here; the place stays."""
        begin = self.at
        if self.peek() == "?" and self.text[begin + 1 : begin + 2] in ("", " ", "\n", "\r", "\t"):
            self.fail("have plain keys, not '? key'")
        match = self.take(_QUOTED) if self.peek() in ("'", '"') else self.take(_PLAIN)
        colon = match is not None and _COLON.match(self.text, self.at)
        self.at = begin
        if not match or not colon:
            return None
        self.end_of_key = colon.end()
        return self.unquoted(match) if match[0][0] in "'\"" else match[0].rstrip(" \t")

    def new_key(self, found: Node, values: dict[str, Node], key: str) -> None:
        if key in values:
            where = self.source.line(values[key].start)
            raise FileError(
                f"{self.source.name}, line {self.source.line(self.at)}, {key_path((*found.path, key))}",
                f"stand once in {self.source.name}",
                Shown(f"another one in line {self.source.line(self.at)}, after that of line {where}"),
                code="repeated_key",
            )
        if key == "<<":
            self.fail("hold no merges ('<<')", remedy="write the values of the map here")

    # ---- scalars, flow ---------------------------------------------------------------------------

    def named(self, anchor: str, found: Node) -> Node:
        if anchor:
            self.anchors[anchor] = found
        if found.value.__class__ in (dict, list):
            found.size = 1 + sum(each.size for each in found.children())
        return found

    def anchor(self) -> str:
        if self.peek() == "!":
            self.fail("hold no tags ('!')", remedy="quotes make text, and a decimal point makes a float")
        if self.peek() != "&":
            return ""
        match = self.take(_NAME)
        if match is None:
            self.fail("name its anchor after '&'")
        begin = self.at
        if _GAP.match(self.text, self.at) is None and self.at < len(self.text) and self.peek() not in ",]}":
            self.fail("have a blank after the name of its anchor")
        line = self.source.line(begin)
        self.skip()
        if self.peek() in ("&", "*"):
            self.fail("have one anchor or alias")
        if self.peek() == "!":
            self.fail("hold no tags ('!')")
        if self.source.line(self.at) == line and self.key() is not None and self.depth_of_flow == 0:
            self.fail("have no anchor before a key", begin, "put it after the colon")
        self.at = begin
        return match[1]

    def aliased(self, path: Path) -> Node:
        match = self.take(_NAME)
        origin = self.anchors.get(match[1]) if match else None
        if match is None or origin is None:
            self.fail("name an anchor that stands above it", self.at if match is None else match.start())
        self.counted(origin.size)
        found = Node(self.source, path, match.start())
        found.value, found.text, found.quoted, found.size = origin.value, origin.text, origin.quoted, origin.size
        found.stop, found.alias = self.at, True
        return found

    def scalar_or_flow(self, found: Node, indent: int) -> Node:
        """Return a value that begins here and is no block map or list."""
        flow = self.depth_of_flow > 0
        sign = self.peek()
        if sign == "*":
            found = self.aliased(found.path)
        elif sign in ("[", "{"):
            self.depth_of_flow += 1
            self.flow_list(found) if sign == "[" else self.flow_map(found)
            self.depth_of_flow -= 1
        elif sign in ("'", '"'):
            match = self.take(_QUOTED)
            if match is None:
                self.fail("close its quotes")
            found.value = found.text = self.unquoted(match)
            found.quoted = True
        elif sign in ("|", ">") and not flow:
            self.block_scalar(found, indent)
            return found
        else:
            found.text = self.plain(indent)
            found.value = resolved(found.text)
        found.stop = self.at
        if not flow:
            if _COLON.match(self.text, self.at):
                self.fail("have plain words as keys, and one key in a line", found.start)
            if not _LINE_END.match(self.text, self.at):
                self.fail("end after its value")
        return found

    def plain(self, indent: int) -> str:
        flow = self.depth_of_flow > 0
        match = self.take(_PLAIN_FLOW if flow else _PLAIN)
        if match is None:
            self.fail("be a value, or have quotes around it")
        parts = [match[0].rstrip(" \t")]
        self.at = match.start() + len(parts[0])
        while gap := _MORE_LINE.match(self.text, self.at):
            column = gap.end() - self.source.line_start(gap.end())
            blank = self.text[self.source.line_start(gap.end()) : gap.end()]
            if not flow and (column <= indent or len(blank) - len(blank.lstrip(" ")) <= indent):
                break
            more = (_PLAIN_FLOW_MORE if flow else _PLAIN_MORE).match(self.text, gap.end())
            if more is None or more[0].startswith("#"):
                break
            if not flow and _COLON.match(self.text, more.end()):
                self.fail("be indented as the lines above, or be quoted", gap.end())
            breaks = len(re.findall(BREAK, gap[1]))
            line = more[0].rstrip(" \t")
            parts.append(("\n" * (breaks - 1) or " ") + line)
            self.at = more.start() + len(line)
        return "".join(parts)

    def block_scalar(self, found: Node, indent: int) -> None:
        """Read lines of text after '|' or '>'."""
        begin, folded, indent = self.at, self.peek() == ">", max(indent, 0)
        head = self.take(_BLOCK_HEAD)
        if head is None or (head[1] and head[3]):
            self.fail("have '|' or '>' alone, or with '-' or '+'", begin)
        chomp = head[1] or head[3]
        least = indent + int(head[2]) if head[2] else None
        lines: list[str] = []
        stop = self.at
        for match in re.compile(rf"([ ]*)([^\r\n]*)({BREAK}|\Z)").finditer(self.text, self.at):
            blanks, rest = len(match[1]), match[2]
            if match.start() == len(self.text):
                break
            if not rest and (least is None or blanks <= least):
                lines += [""] if match[3] else []
                continue
            if least is None:
                least = blanks if blanks > indent else len(self.text)
            if blanks < least:
                break
            lines.append(match[1][least:] + rest)
            stop = match.end(2)
        kept = len(lines)
        while kept and not lines[kept - 1]:
            kept -= 1
        ended = self.text[stop : stop + 1] in ("\r", "\n")
        body = _folded(lines[:kept]) if folded else "\n".join(lines[:kept])
        tail = "" if chomp == "-" or not (kept or chomp) else "\n" if ended and kept else ""
        if chomp == "+":
            tail += "\n" * (len(lines) - kept)
        found.value = found.text = body + tail
        found.quoted = True
        self.at = found.stop = stop

    def flow_list(self, found: Node) -> None:
        begin, values = self.at, list[Node]()
        self.at += 1
        while not self.closed("]", begin):
            values.append(self.flow_value((*found.path, len(values))))
            self.comma("]")
        found.value = values

    def flow_map(self, found: Node) -> None:
        begin, values = self.at, dict[str, Node]()
        self.at += 1
        while not self.closed("}", begin):
            place = self.at
            match = self.take(_QUOTED) if self.peek() in ("'", '"') else self.take(_PLAIN_FLOW)
            if match is None:
                self.fail("have plain words as keys")
            quoted = match[0][0] in "'\""
            key = self.unquoted(match) if quoted else match[0].rstrip(" \t")
            self.at, after = place, self.at
            self.new_key(found, values, key)
            self.at = after
            if self.take(re.compile(r"[ \t]*:") if quoted else _COLON_FLOW):
                empty = self.at
                self.skip()
                if self.peek() in (",", "}"):
                    values[key] = Node(self.source, (*found.path, key), empty)
                    self.counted(1)
                else:
                    values[key] = self.flow_value((*found.path, key))
            else:
                self.skip()
                if self.peek() not in (",", "}"):
                    self.fail("have ': ' after a key")
                values[key] = Node(self.source, (*found.path, key), after)
                self.counted(1)
            self.comma("}")
        found.value = values

    def flow_value(self, path: Path) -> Node:
        anchor = self.anchor()
        self.skip()
        self.counted(1)
        self.deeper()
        if anchor and self.peek() in (",", "]", "}"):
            found = Node(self.source, path, self.at)
        else:
            found = self.scalar_or_flow(Node(self.source, path, self.at), -1)
        self.depth -= 1
        return self.named(anchor, found)

    def closed(self, bracket: str, begin: int) -> bool:
        self.skip()
        if self.at >= len(self.text):
            self.fail("close every bracket", begin)
        if self.peek() != bracket:
            return False
        self.at += 1
        return True

    def comma(self, bracket: str) -> None:
        self.skip()
        if self.peek() == ",":
            self.at += 1
        elif self.at < len(self.text) and self.peek() != bracket:
            self.fail("have commas between the values in brackets")

    def unquoted(self, match: re.Match[str]) -> str:
        body, double = match[0][1:-1], match[0][0] == '"'
        if not double:
            body = body.replace("\\", "\\\\").replace("''", "'")

        def one(part: re.Match[str]) -> str:
            escaped, breaks, x, u, long, letter = part.groups()
            if escaped is not None:
                return "\n" * len(re.findall(BREAK, escaped))
            if breaks is not None:
                return "\n" * len(re.findall(BREAK, breaks)) or " "
            code = x or u or long
            if code is not None and (int(code, 16) > 0x10FFFF or 0xD800 <= int(code, 16) < 0xE000):
                self.fail("have escapes of characters that exist", match.start())
            if code is not None:
                return chr(int(code, 16))
            if letter is None:
                return part[0]
            if letter not in _ESCAPES:
                self.fail(f"have no unknown escape {part[0]!r} in double quotes", match.start(), "write \\\\ for \\")
            return _ESCAPES[letter]

        return _FOLDED.sub(one, body)


def _folded(lines: list[str]) -> str:
    """Return lines of a folded scalar: one break between lines of words is a blank; indented lines stay."""
    found, breaks, before = "", 0, ""
    for line in lines:
        if not line:
            breaks += 1
            continue
        if found or breaks:
            own = before[:1] in (" ", "\t") or line[:1] in (" ", "\t")
            first = not found
            found += "\n" * (breaks if first else breaks + 1 if own else breaks) or ("" if first else " ")
        found, breaks, before = found + line, 0, line
    return found
