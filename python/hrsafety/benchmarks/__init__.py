"""Benchmarks of laws by fixed protocols: many episodes, shares with intervals, resumable."""

from hrsafety._calls import suggest
from hrsafety.benchmarks.entries import Entry, entry
from hrsafety.benchmarks.protocol import Suite
from hrsafety.benchmarks.results import Result, Row
from hrsafety.benchmarks.runs import benchmark
from hrsafety.benchmarks.suites import SUITES

__all__ = ["SUITES", "Entry", "Result", "Row", "Suite", "benchmark", "entry"]

suggest(__all__, globals())
