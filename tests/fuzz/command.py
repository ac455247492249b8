"""The command: random inputs to every public constructor, many functions and all readers of files.

Each input is made from the seed and its number alone, so that ``--only NUMBER`` repeats it. An answer is
right if it is a result, or an error of the package; a parameter object must hold no NaN, a result none
without a status or a warning, and an answer comes within seconds. Everything else is printed, and the exit
code is 1. A process that hangs or dies is noticed from outside and replaced.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections import Counter

from fuzz.inputs import ANSWERS, in_new_folder
from fuzz.watching import Tally, worked_off

__all__ = ["main"]

_REPORT = 60.0
# Escapes of one kind that are printed; all are counted.
_EXAMPLES = 2


def main(words: list[str] | None = None) -> int:
    """Work off the inputs and print the counts; 1 if anything was answered wrongly."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.fuzz", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--inputs", type=int, default=1_000_000, help="how many [%(default)s]")
    parser.add_argument("--seed", type=int, default=1, help="of the draws [%(default)s]")
    parser.add_argument("--first", type=int, default=0, help="number of the first input [%(default)s]")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1, help="processes [%(default)s]")
    parser.add_argument("--only", type=int, metavar="NUMBER", help="repeat one input in this process")
    parser.add_argument("--part", default="", help="call only what has this in its name, as in 'judge'")
    options = parser.parse_args(words)
    folder, inputs = in_new_folder(options.seed, options.part)
    with folder:
        if options.only is not None:
            outcome = inputs.answer(options.only, lambda target: print(inputs.names[target], flush=True))
            print(outcome.answer, outcome.told, outcome.shown, sep="\n")
            return int(outcome.answer == "escapes")
        return _watched(options, inputs.names)


def _watched(options: argparse.Namespace, names: list[str]) -> int:
    """Print what escapes as it comes, a line now and then, and the table at the end."""
    begin = shown = time.monotonic()
    told, tally = 0, Tally()
    kinds: Counter[str] = Counter()
    try:
        given = (options.seed, options.part, options.first, options.inputs, options.workers)
        for tally in worked_off(*given, names):
            for escape in tally.escapes[told:]:
                kinds[escape.kind] += 1
                if kinds[escape.kind] <= _EXAMPLES:
                    print(f"input {escape.number}: {escape.name}: {escape.told}: {escape.shown}", flush=True)
            told = len(tally.escapes)
            if time.monotonic() - shown > _REPORT:
                shown = time.monotonic()
                print(f"{tally.done:,} inputs in {shown - begin:.0f} s", file=sys.stderr, flush=True)
    except KeyboardInterrupt:
        print("stopped", file=sys.stderr)
    print(_table(tally))
    print("\n".join(f"{number:>8,} times {kind}" for kind, number in kinds.most_common()))
    seconds = time.monotonic() - begin
    print(f"{tally.done:,} inputs of seed {options.seed} from {options.first:,} in {seconds:.0f} s")
    print(f"{len(tally.escapes)} were answered by something else than a result or an error of the package")
    return int(bool(tally.escapes))


def _table(tally: Tally) -> str:
    """Return the counts of each constructor, function and reader."""
    width = max((len(name) for name in tally.counts), default=0)
    head = f"{'':{width}}" + "".join(f"{answer:>10}" for answer in ANSWERS)
    rows = [f"{name:{width}}" + "".join(f"{n:>10,}" for n in counts) for name, counts in tally.counts.items()]
    return "\n".join([head, *rows])
