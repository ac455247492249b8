"""The arena: standard scenes of social navigation, what is asked in each, which can be solved, and how laws fare."""

from hrsafety._calls import suggest
from hrsafety.arena.cards import CARDS, task_error
from hrsafety.arena.certificates import Certificate, certify, certify_many
from hrsafety.arena.leaderboard import ArenaCell, Leaderboard, EntryStanding, run
from hrsafety.arena.ranking import Ranks, ranks

__all__ = [
    "CARDS",
    "ArenaCell",
    "Certificate",
    "EntryStanding",
    "Leaderboard",
    "Ranks",
    "certify",
    "certify_many",
    "ranks",
    "run",
    "task_error",
]

suggest(__all__, globals())
