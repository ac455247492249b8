"""Results that a player can play, and that notebooks show as one."""

from __future__ import annotations

from hrsafety._display import shown_html
from hrsafety._replay.record import Replay
from hrsafety.errors import HrsafetyError

__all__ = ["Played"]

NOTEBOOK_LIMIT = 400_000
"""Letters of a player in a notebook, which keeps every one that it shows."""


class Played:
    """Base of results that a player can play: `_replay` says what it shows, a notebook shows the player."""

    __slots__ = ()

    def _replay(self) -> Replay:
        """Return what a player shows."""
        raise NotImplementedError

    def _repr_html_(self) -> str:
        """Return the player, and below it what the result shows of itself."""
        from hrsafety._replay.page import player_page  # a notebook's

        below: str = getattr(super(), "_repr_html_", lambda: shown_html(self))()
        try:
            page = player_page(self._replay(), limit=NOTEBOOK_LIMIT)
        except HrsafetyError:  # nothing to play
            return below
        return page.framed() + below
