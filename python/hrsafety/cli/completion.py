"""Shell completion, written by shtab from the parser itself."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from typing import Any

from hrsafety.errors import MissingExtraError

__all__ = ["SHELLS", "PrintCompletion"]

SHELLS = ("bash", "zsh", "fish", "tcsh")
"""Shells that a completion is written for."""


class PrintCompletion(argparse.Action):
    """Option that prints the completion of the whole command line for a shell, and ends."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,  # noqa: ARG002  # argparse passes it
        values: str | Sequence[Any] | None,
        option_string: str | None = None,  # noqa: ARG002  # argparse passes it
    ) -> None:
        """Print and leave."""
        try:
            import shtab
        except ModuleNotFoundError:
            message = "--print-completion needs shtab: pip install shtab"
            raise MissingExtraError(message) from None
        _mark(parser, shtab)
        print(shtab.complete(parser, str(values)))
        parser.exit()


def _mark(parser: argparse.ArgumentParser, shtab: Any) -> None:
    """Tell which arguments are files, folders, laws and parts; the parser is not used for anything else afterwards."""
    from hrsafety.reproduce import PARTS
    from hrsafety.scenarios.laws import LAWS

    words = {"--law": tuple(name.replace("_", "-") for name in LAWS), "--only": PARTS}
    for action in _actions(parser):
        name = action.option_strings[0] if action.option_strings else ""
        metavar = str(action.metavar)
        if name in words:
            action.choices = words[name]
        elif metavar == "DIR":
            action.complete = shtab.DIRECTORY  # type: ignore[attr-defined]  # shtab reads it
        elif metavar == "FILE" or metavar.endswith((".toml", ".csv")):
            action.complete = shtab.FILE  # type: ignore[attr-defined]  # shtab reads it


def _actions(parser: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    """Yield every option and argument of a parser and of its commands."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command in action.choices.values():
                yield from _actions(command)
        else:
            yield action
