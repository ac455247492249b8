"""Millions of random inputs to constructors, functions and readers; see `fuzz.command`.

Run it from the root of the source tree with ``make fuzz``, or ``python -m tests.fuzz --inputs 10000000 --seed 1``.
"""
