"""Elements of XML files with the lines where they stand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from hrsafety.errors import Shown
from hrsafety.io.reader import Document

__all__ = ["Element", "root_element"]

MOST_DEPTH = 100
MOST_ELEMENTS = 1_000_000


@dataclass(slots=True)
class Element:
    """An element of an XML file.

    Attributes
    ----------
    tag : str
        Its name without the namespace.
    attributes : dict of str to str
        Those without a namespace.
    line : int
        Where it begins.
    text : str
        What stands in it outside of other elements.
    children : list of Element
        Elements in it.
    """

    tag: str
    attributes: dict[str, str]
    line: int
    text: str = ""
    children: list[Element] = field(default_factory=list)

    def all(self, tag: str) -> Iterator[Element]:
        """Yield the children of a name."""
        return (each for each in self.children if each.tag == tag)

    def first(self, *tags: str) -> Element | None:
        """Return the first child of a name, of that the first child of the next name, and so on."""
        found: Element | None = self
        for tag in tags:
            found = next(found.all(tag), None) if found is not None else None
        return found


def root_element(document: Document) -> Element:
    """Return the root element of an XML file.

    Parameters
    ----------
    document : Document
        The file.

    Raises
    ------
    FileError
        If the XML is not well-formed, defines entities, or has too many elements or too deep ones.
    """
    parser = expat.ParserCreate()
    parser.buffer_text = True
    top = Element("", {}, 0)
    open_ones = [top]
    count = 0

    def refused(rule: str, shown: str, remedy: str | None = None) -> Exception:
        return document.error("unreadable", rule, Shown(shown), remedy, line=parser.CurrentLineNumber)

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal count
        count += 1
        if len(open_ones) > MOST_DEPTH or count > MOST_ELEMENTS:
            raise refused(f"have at most {MOST_ELEMENTS} elements, {MOST_DEPTH} deep", "more")
        own = {name: value for name, value in attributes.items() if ":" not in name}
        element = Element(tag.rpartition(":")[2], own, parser.CurrentLineNumber)
        open_ones[-1].children.append(element)
        open_ones.append(element)

    def text(words: str) -> None:
        open_ones[-1].text += words

    def entity(*_: object) -> None:
        raise refused("define no entities", "one", "save it without a document type")

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda _tag: open_ones.pop()
    parser.CharacterDataHandler = text
    parser.EntityDeclHandler = entity
    try:
        parser.Parse(document.data, True)
    except expat.ExpatError as error:
        shown = Shown(expat.ErrorString(error.code))
        raise document.error("unreadable", "be well-formed XML", shown, line=error.lineno) from None
    except (LookupError, ValueError) as error:  # unknown encodings
        if isinstance(error, UnicodeError | LookupError) or "encoding" in str(error):
            raise document.error("unreadable", "be text of a known encoding", Shown(str(error))) from None
        raise
    return top.children[0]
