"""Processes that work off inputs, watched from outside: a hang or an abort is an answer, too."""

from __future__ import annotations

import itertools
import multiprocessing
import resource
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import Any, NamedTuple

from fuzz.inputs import ANSWERS, in_new_folder

__all__ = ["Escape", "Tally", "worked_off"]

# Seconds after which a call counts as one that does not end, and bytes that a process may take.
PATIENCE = 60.0
MOST_MEMORY = 6 * 2**30
_POLL = 0.2
# Seconds that a process may take to start: it imports everything and writes its files.
_START = 300.0


class Escape(NamedTuple):
    """An input that was answered by something else than a result or an error of the package.

    Attributes
    ----------
    number : int
        Of the input.
    name : str
        Constructor, function or reader.
    told : str
        What came out.
    shown : str
        Arguments, or content of the file.
    """

    number: int
    name: str
    told: str
    shown: str

    @property
    def kind(self) -> str:
        """What escapes of one kind have in common: the target and the start of what came out."""
        return f"{self.name}: {self.told.split(':')[0][:80]}"


@dataclass(slots=True)
class Tally:
    """What came out so far.

    Attributes
    ----------
    counts : dict of str to list of int
        By constructor, function or reader: how many of each of `ANSWERS`.
    escapes : list of Escape
        What was answered by something else.
    done : int
        Inputs that are done.
    """

    counts: dict[str, list[int]] = field(default_factory=dict)
    escapes: list[Escape] = field(default_factory=list)
    done: int = 0


def _work(seed: int, part: str, span: range, counts: Any, state: Any, out: Connection) -> None:
    """Work off a span of inputs; ``state`` holds the number under way, its target and its start."""
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    folder, inputs = in_new_folder(seed, part)

    def begun(target: int) -> None:
        state[1], state[2] = target, time.monotonic()

    with folder:
        for number in span:
            state[0] = number
            outcome = inputs.answer(number, begun)
            counts[outcome.target * len(ANSWERS) + ANSWERS.index(outcome.answer)] += 1
            if outcome.told:
                out.send((number, inputs.names[outcome.target], outcome.told, outcome.shown))
    state[0] = span.stop


class _Worker:
    """A process with its span of inputs."""

    def __init__(self, seed: int, part: str, span: range, names: list[str]) -> None:
        self.span = span
        context = multiprocessing.get_context("spawn")
        self.counts = context.RawArray("q", len(names) * len(ANSWERS))
        self.state = context.RawArray("d", [span.start, 0, time.monotonic() + _START])
        self.messages, theirs = context.Pipe(duplex=False)
        arguments = (seed, part, span, self.counts, self.state, theirs)
        self.process = context.Process(target=_work, args=arguments, daemon=True)
        self.process.start()
        theirs.close()

    def received(self) -> Iterator[Escape]:
        """Yield what escaped since the last look."""
        try:
            while self.messages.poll():
                yield Escape(*self.messages.recv())
        except EOFError:
            return

    def failure(self) -> str:
        """Return how the process failed, and stop it; empty while it works or when it is done."""
        if not self.process.is_alive():
            return "" if self.state[0] >= self.span.stop else f"the process ended with code {self.process.exitcode}"
        if time.monotonic() - self.state[2] > PATIENCE:
            self.process.kill()
            self.process.join()
            return f"no answer after {PATIENCE:g} s"
        return ""


def worked_off(seed: int, part: str, first: int, count: int, workers: int, names: list[str]) -> Iterator[Tally]:
    """Work off inputs in processes and yield what came out, again and again until all is done.

    Parameters
    ----------
    seed, part : int, str
        Of the inputs.
    first, count : int
        Number of the first input, and how many.
    workers : int
        Processes.
    names : list of str
        `Inputs.names`.
    """
    bounds = [first + count * index // workers for index in range(workers + 1)]
    running = [_Worker(seed, part, range(*ends), names) for ends in itertools.pairwise(bounds)]
    ended: list[_Worker] = []
    escapes: list[Escape] = []
    try:
        while running:
            time.sleep(_POLL)
            for worker in list(running):
                failed = worker.failure()
                escapes += worker.received()
                if worker.process.is_alive():
                    continue
                running.remove(worker)
                ended.append(worker)
                if failed:
                    number = int(worker.state[0])
                    escapes.append(Escape(number, names[int(worker.state[1])], failed, ""))
                    running.append(_Worker(seed, part, range(number + 1, worker.span.stop), names))
            yield _tally([*ended, *running], escapes, names)
    finally:
        for worker in running:
            worker.process.kill()


def _tally(workers: list[_Worker], escapes: list[Escape], names: list[str]) -> Tally:
    """Return what all processes have counted."""
    each = len(ANSWERS)
    counts = {
        name: [sum(worker.counts[index * each + kind] for worker in workers) for kind in range(each)]
        for index, name in enumerate(names)
    }
    return Tally(counts, list(escapes), sum(map(sum, counts.values())))
