"""Ctrl-C for a child process: the program that it runs, the signal, and how soon it is answered."""

from __future__ import annotations

import signal
import subprocess
import sys
import time

import pytest

needs_signals = pytest.mark.skipif(
    sys.platform == "win32", reason="the signal cannot be sent to one process on Windows"
)

LISTEN = "import signal\nsignal.signal(signal.SIGINT, signal.default_int_handler)\n"
"""First lines of a child, which else ignores Ctrl-C if whoever started the tests does."""

WORK = """
import sys, time
{preparation}
# Names that are loaded when they are asked for: loading them is no part of the work, twice for those of namespaces.
for _ in range(2):
    for module in [module for name, module in list(sys.modules.items()) if name.startswith("hrsafety.")]:
        for name in getattr(module, "__all__", ()):
            getattr(module, name)
print("started", flush=True)
try:
    {work}
except KeyboardInterrupt:
    print("interrupted", time.monotonic(), flush=True)
else:
    print("finished", flush=True)
"""

# Time that the work is given to get going, in s.
WARM_UP = 0.7

# The promise is 0.2 s; the limit leaves room for a loaded machine and for the end of the
# interpreter, in s.
LIMIT = 2.0


def answer_to_ctrl_c(program: str, *arguments: str, word: str) -> float:
    """Send Ctrl-C to a program at work and return after how many seconds it told ``word``.

    The program writes ``started`` before its work, and a word and the monotonic time after it. It
    has to end by itself, without an error, within `LIMIT` of the signal.
    """
    process = subprocess.Popen(
        [sys.executable, "-c", LISTEN + program, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "started\n", process.communicate()
    time.sleep(WARM_UP)
    sent = time.monotonic()
    process.send_signal(signal.SIGINT)
    try:
        output, errors = process.communicate(timeout=LIMIT)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        pytest.fail(f"the process did not end within {LIMIT} s of the signal")
    words = output.split()
    assert words[:1] == [word], (output, errors)
    assert process.returncode == 0, errors
    return float(words[1]) - sent


def check_work_is_interrupted(preparation: str, work: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Check that work of many seconds raises `KeyboardInterrupt` soon after Ctrl-C, and tell how soon."""
    answer = answer_to_ctrl_c(WORK.format(preparation=preparation, work=work), word="interrupted")
    assert answer < LIMIT
    with capsys.disabled():
        print(f" [Ctrl-C answered in {1e3 * answer:.0f} ms]", end="")
