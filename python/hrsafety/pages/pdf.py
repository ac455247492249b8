"""Pages as PDF: printed by a headless Chromium where there is one, else by WeasyPrint."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

from hrsafety.errors import HrsafetyError, MissingExtraError

__all__ = ["BROWSERS", "pdf_of", "require_pdf"]

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "msedge")
"""Programs that print a page, looked for on the path in this order."""
MOST_SECONDS = 120.0
REMEDY = "print the page in a browser, or pip install weasyprint"
_DATE = re.compile(rb"/(CreationDate|ModDate) \(D:\d{14}([^)]*)\)")
_FIXED = b"20000101000000"


def require_pdf(option: str) -> None:
    """Find out before long work that no PDF can be made.

    Parameters
    ----------
    option : str
        Option that asks for it.

    Raises
    ------
    MissingExtraError
        If there is neither a browser nor WeasyPrint.
    """
    if _browser() is None and importlib.util.find_spec("weasyprint") is None:
        raise MissingExtraError(
            f"{option} needs a headless Chromium (Chrome, Edge) on the path, or WeasyPrint: pip install weasyprint"
        )


def pdf_of(page: str) -> bytes:
    """Return a page as PDF on A4, the same bytes for the same page and printer.

    Parameters
    ----------
    page : str
        A complete HTML document.

    Returns
    -------
    bytes
        The PDF; its dates are fixed.

    Raises
    ------
    HrsafetyError
        If the browser fails.
    MissingExtraError
        If there is neither a browser nor WeasyPrint.
    """
    require_pdf("a PDF")
    made = _printed(page)
    return _DATE.sub(lambda found: b"/" + found[1] + b" (D:" + _FIXED + found[2] + b")", made)


def _printed(page: str) -> bytes:
    """Return what the browser prints, or WeasyPrint where there is no browser or it fails."""
    browser, other = _browser(), importlib.util.find_spec("weasyprint") is not None
    if browser is None:
        return _by_weasyprint(page)
    try:
        return _by_browser(browser, page)
    except HrsafetyError:
        if not other:
            raise
        return _by_weasyprint(page)


def _browser() -> str | None:
    return next((place for name in BROWSERS if (place := shutil.which(name))), None)


def _by_weasyprint(page: str) -> bytes:
    from weasyprint import HTML

    return bytes(HTML(string=page).write_pdf())


def _by_browser(browser: str, page: str) -> bytes:
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        source, printed = Path(folder) / "page.html", Path(folder) / "page.pdf"
        source.write_text(page, encoding="utf-8")
        command = [browser, "--headless", "--disable-gpu", "--no-pdf-header-footer"]
        # Tags carry numbers that differ from call to call.
        command.append("--disable-pdf-tagging")
        command.append(f"--user-data-dir={folder}/profile")
        if getattr(os, "geteuid", lambda: 1)() == 0:
            # Chromium has no sandbox for the superuser; the page is our own and loads nothing.
            command.append("--no-sandbox")
        command += [f"--print-to-pdf={printed}", source.as_uri()]
        try:
            told = subprocess.run(command, capture_output=True, timeout=MOST_SECONDS, check=False)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise HrsafetyError(f"{browser} printed no PDF ({error}); {REMEDY}") from None
        if not printed.exists():
            last = told.stderr.decode("utf-8", "replace").strip().rpartition("\n")[2]
            raise HrsafetyError(f"{browser} printed no PDF ({last}); {REMEDY}")
        return printed.read_bytes()
