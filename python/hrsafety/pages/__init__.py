"""HTML pages of the commands: one base template, one style sheet, nothing loaded from elsewhere.

Jinja2 fills the templates of the folder ``templates``; everything that is no template is escaped.
"""

from __future__ import annotations

import base64
import datetime
import importlib.metadata
import importlib.util
import math
import platform
from functools import cache
from typing import TYPE_CHECKING

from hrsafety import __version__
from hrsafety._records import dataclass
from hrsafety._words import unsigned_zero
from hrsafety.errors import MissingExtraError

if TYPE_CHECKING:
    from jinja2 import Environment

__all__ = ["DASH", "Picture", "require_jinja", "sentence", "share_words", "shown", "versions", "written"]

DASH = "\N{EN DASH}"


@dataclass(frozen=True, kw_only=True, slots=True)
class Picture:
    """One picture of a page.

    Attributes
    ----------
    name : str
        File name without ending, and where a link to it leads.
    caption : str
        What it shows.
    png : bytes
        The picture.
    """

    name: str
    caption: str
    png: bytes

    @property
    def data(self) -> str:
        """Address with the whole picture in it."""
        return f"data:image/png;base64,{base64.b64encode(self.png).decode('ascii')}"


def require_jinja(what: str) -> None:
    """Find out before long work that its page cannot be written.

    Parameters
    ----------
    what : str
        Command or option that writes a page.

    Raises
    ------
    MissingExtraError
        If Jinja2 is not installed.
    """
    if importlib.util.find_spec("jinja2") is None:
        raise MissingExtraError(f"{what} writes a page and needs Jinja2: pip install jinja2")


def written(template: str, **content: object) -> str:
    """Return a page: style and pictures inside, every text escaped.

    Parameters
    ----------
    template : str
        File in the folder of templates.
    **content : object
        What the template shows.

    Returns
    -------
    str
        A complete HTML document.
    """
    now = datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC")
    return _environment().get_template(template).render(**{"version": __version__, "made": now} | content)


def shown(value: object, spec: str = ".2f") -> str:
    """Return a number as text, a dash for one that is not finite, and words as they are."""
    if isinstance(value, str):
        return value
    if value is None or not math.isfinite(value):  # type: ignore[arg-type]  # what is no number fails here
        return DASH
    return unsigned_zero(format(value, spec))


def sentence(words: str) -> str:
    """Return words with a capital letter at the start."""
    return words[:1].upper() + words[1:]


def share_words(value: float, low: float, high: float) -> str:
    """Return a share and its interval in percent."""
    return f"{100.0 * value:.1f} % [{100.0 * low:.1f}, {100.0 * high:.1f}]"


def versions(*libraries: str) -> str:
    """Return the versions of Python and of libraries, and the machine, in a line."""
    names = [f"Python {platform.python_version()}", *(f"{name} {_version(name)}" for name in libraries)]
    return f"{', '.join(names)}; {platform.system()} {platform.machine()}"


def _version(name: str) -> str:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "(not installed)"


@cache
def _environment() -> Environment:
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("hrsafety.pages"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"shown": shown, "number": format, "sentence": sentence}
    return environment
