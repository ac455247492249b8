"""The arena: standard scenes of social navigation, which of them can be solved, and what is asked in each."""

from hrsafety._calls import suggest
from hrsafety.arena.cards import CARDS, task_error
from hrsafety.arena.certificates import Certificate, certify, certify_many
from hrsafety.arena.ranking import Ranks, ranks

__all__ = ["CARDS", "Certificate", "Ranks", "certify", "certify_many", "ranks", "task_error"]

suggest(__all__, globals())
