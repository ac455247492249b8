"""Files spoiled at random: what an editor, a spreadsheet, a cut copy or a bad disk makes of a good one."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator

WORDS = (
    "nan",
    "inf",
    "-1",
    "0",
    "1e308",
    "1e-308",
    "2**3",
    "true",
    '""',
    '"x"',
    "[]",
    "[1]",
    "{}",
    "9" * 40,
    "1_0",
    "",
)
SIGNS = (
    "\0",
    "\x1b",
    "\ufeff",
    "é",
    "\u2028",
    '"',
    "'",
    "[",
    "]",
    "{",
    "}",
    "=",
    ",",
    ";",
    ".",
    "#",
    "\n",
    "\r",
    "\t",
    "-",
)


def spoiled(text: str, count: int, seed: int) -> Iterator[bytes]:
    """Yield the text with one or two faults each, as bytes."""
    draw = random.Random(seed)
    for _ in range(count):
        spoiling = text
        for _ in range(draw.choice((1, 1, 2))):
            spoiling = draw.choice(FAULTS)(spoiling, draw)
        content = spoiling.encode("utf-8", errors="surrogatepass")
        if draw.random() < 0.1:
            content = _bytes(content, draw)
        yield content


def _sign(text: str, draw: random.Random) -> str:
    at = draw.randrange(len(text) + 1)
    return text[:at] + draw.choice(SIGNS) + text[at + draw.randint(0, 2) :]


def _value(text: str, draw: random.Random) -> str:
    """Put an odd word in place of a number or text."""
    places = list(re.finditer(r'-?\d[\w.+-]*|"[^"\n]*"', text))
    if not places:
        return text
    place = draw.choice(places)
    return text[: place.start()] + draw.choice(WORDS) + text[place.end() :]


def _line(text: str, draw: random.Random) -> str:
    """Lose a line, write it twice or move it."""
    lines = text.splitlines(keepends=True)
    if not lines:
        return text
    taken = lines.pop(draw.randrange(len(lines)))
    for _ in range(draw.randint(0, 2)):
        lines.insert(draw.randint(0, len(lines)), taken)
    return "".join(lines)


def _cut(text: str, draw: random.Random) -> str:
    return text[: draw.randrange(len(text) + 1)]


def _name(text: str, draw: random.Random) -> str:
    """Change a letter of a name."""
    places = list(re.finditer(r"[a-z_]{3,}", text))
    if not places:
        return text
    at = draw.choice(places).start() + draw.randint(0, 2)
    return text[:at] + draw.choice("aexz_") + text[at + 1 :]


def _delimiter(text: str, draw: random.Random) -> str:
    return text.replace(",", draw.choice([";", "\t", " ", ",,"]), draw.choice([1, 3, -1]))


def _bytes(content: bytes, draw: random.Random) -> bytes:
    if draw.random() < 0.3:
        return content.decode("utf-8", errors="replace").encode("utf-16")
    at = draw.randrange(len(content) + 1)
    return content[:at] + bytes(draw.randrange(256) for _ in range(3)) + content[at + 1 :]


FAULTS = (_sign, _value, _value, _line, _cut, _name, _delimiter)
