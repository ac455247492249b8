"""Entries of the flat YAML files that describe maps: blocks, flow style, comments, quotes."""

from __future__ import annotations

import codecs
import re
from typing import TYPE_CHECKING, Any

from hrsafety.errors import InvalidParameterError, Shown

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["yaml_entries"]

MOST_BYTES = 1 << 20
_ENTRY = r"""(?:(\w+)\s*:(?:\s+(.*)|)|("\w+"|'\w+')\s*:\s*(.*))"""


def yaml_entries(file: Path) -> dict[str, Any]:
    """Return keys and values of a flat YAML file; a value is a word or a list of words."""
    found: dict[str, Any] = {}
    listed = pending = ""
    for index, line in enumerate(_text(file).splitlines(), start=1):
        bare = f"{pending} {_without_comment(line).strip()}".strip()
        if not bare or bare in ("---", "...") or bare.startswith("%"):
            continue
        pending = bare if _open(bare) else ""
        if pending:
            continue
        if bare.startswith("{") and bare.endswith("}"):
            for part in _parts(bare[1:-1]):
                _enter(file, found, part, index)
        elif bare.startswith("-") and listed:
            found[listed].append(_unquoted(bare[1:]))
        else:
            listed = _enter(file, found, bare, index)
    if pending:
        raise InvalidParameterError(file.name, "close every bracket", Shown(f"{pending[:80]!r}"))
    return found


def _text(file: Path) -> str:
    try:
        if file.stat().st_size > MOST_BYTES:
            raise InvalidParameterError("path", f"be a YAML file of at most {MOST_BYTES} bytes", file.name)
        raw = file.read_bytes()
        encoding = "utf-16" if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) else "utf-8-sig"
        return raw.decode(encoding)
    except (OSError, UnicodeDecodeError) as error:
        raise InvalidParameterError("path", "be a YAML file", Shown(f"{file.name} ({error})")) from None


def _enter(file: Path, found: dict[str, Any], text: str, line: int) -> str:
    """Add an entry; returns its key if a list is to follow on lines of its own."""
    match = re.fullmatch(_ENTRY, text.strip())
    if match is None:
        shown = Shown(f"{text.strip()[:80]!r} in line {line}")
        raise InvalidParameterError(f"{file.name}", "be lines 'key: value' of a map", shown)
    plain, value, quoted, beside = match.groups()
    key, value = _unquoted(plain or quoted), (value or beside or "").strip()
    if key in found:
        raise InvalidParameterError(key, f"stand once in {file.name}", Shown(f"another one in line {line}"))
    if value.startswith("[") and value.endswith("]"):
        found[key] = [_unquoted(each) for each in _parts(value[1:-1])]
    else:
        found[key] = _unquoted(value) if value else []
    return "" if value else key


def _open(text: str) -> bool:
    """Return whether a bracket is not closed yet."""
    bare = re.sub(r"'[^']*'|\"[^\"]*\"", "", text)
    return bare.count("[") + bare.count("{") > bare.count("]") + bare.count("}")


def _parts(text: str) -> list[str]:
    """Return what stands between commas outside of brackets and quotes; a last comma is allowed."""
    parts = re.findall(r"(?:'[^']*'|\"[^\"]*\"|\[[^\]]*\]|[^,])+", text)
    return [part for part in parts if part.strip()]


def _without_comment(line: str) -> str:
    return re.sub(r"""^((?:[^'"#]|'[^']*'|"[^"]*"|(?<=\S)#)*?)(?:(?:^|(?<=\s))#.*)?$""", r"\1", line)


def _unquoted(value: str) -> str:
    value = value.strip()
    return value[1:-1] if len(value) > 1 and value[0] == value[-1] and value[0] in "'\"" else value
