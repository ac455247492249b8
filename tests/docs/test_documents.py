"""Everything that a reader can copy runs: blocks of the documents, docstrings, examples."""

from __future__ import annotations

import doctest
import importlib
import os
import pkgutil
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import hrsafety
from make_images import makers

REPOSITORY = Path(__file__).resolve().parents[2]
DOCUMENTS = [REPOSITORY / "README.md", *sorted((REPOSITORY / "docs").rglob("*.md"))]
EXAMPLES = [*sorted((REPOSITORY / "examples").glob("*.py")), REPOSITORY / "examples" / "ppo" / "learned_law.py"]
MODULES = sorted(entry.name for entry in pkgutil.walk_packages(hrsafety.__path__, "hrsafety."))

BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
RECORDINGS = ("zara01.csv", "zara03.csv")

# Parts that need all the extras between them, and nothing else that is installed here.
REPRODUCED = ("tables-6", "impact", "wheels", "camera")
WITH_THESE_ONLY = """
import importlib.metadata as metadata, re, sys

def closure(names):
    found, open_ = set(), list(names)
    while open_:
        name = re.sub(r"[-_.]+", "-", open_.pop()).lower()
        if name in found:
            continue
        found.add(name)
        for line in metadata.requires(name) or []:
            if "extra ==" not in line:
                try:
                    open_.append(metadata.distribution(re.match(r"[\\w.-]+", line)[0]).metadata["Name"])
                except metadata.PackageNotFoundError:
                    pass
    return found

extras = set(sys.argv[1].split(","))
named = [re.match(r"[\\w.-]+", line)[0] for line in metadata.requires("hrsafety")
         if any(f"extra == '{extra}'" in line.replace('"', "'") for extra in extras)]
allowed = closure(["hrsafety", "numpy", *named])
for module, owners in metadata.packages_distributions().items():
    if not any(re.sub(r"[-_.]+", "-", owner).lower() in allowed for owner in owners):
        sys.modules[module] = None
from hrsafety import reproduce
print(reproduce.run("out", only=sys.argv[2].split(",")).name)
"""

# A reader does not wait longer than this for an example, in s.
PATIENCE = 300.0


def blocks(document: Path) -> list[str]:
    return BLOCK.findall(document.read_text(encoding="utf-8"))


def title(path: Path) -> str:
    return path.relative_to(REPOSITORY).as_posix()


def lay_out(text: str, folder: Path, request: pytest.FixtureRequest) -> None:
    """Put the recordings that the text reads into the folder it runs in."""
    for name in RECORDINGS:
        if name in text:
            shared: Path = request.getfixturevalue("shared")
            shutil.copy(shared / "data" / "pedestrians" / name, folder)


def run_python(*arguments: str, folder: Path) -> str:
    done = subprocess.run(
        [sys.executable, "-W", "error", *arguments],
        cwd=folder,
        env={**os.environ, "MPLBACKEND": "Agg"},
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert done.returncode == 0, f"{done.stdout}\n{done.stderr}"
    return done.stdout


def files_of_the_tree() -> set[str]:
    """Return what stands in the root, and what stands in the folders that are read or run here."""
    found = [path for path in REPOSITORY.iterdir() if path.is_file()]
    for folder in ("docs", "examples", "python"):
        found += [path for path in (REPOSITORY / folder).rglob("*") if "__pycache__" not in path.parts]
    return {title(path) for path in found}


@pytest.fixture(scope="module", autouse=True)
def nothing_is_left_in_the_tree() -> Iterator[None]:
    """Fail if what a reader can copy wrote elsewhere than into the folder that it runs in."""
    before = files_of_the_tree()
    yield
    assert files_of_the_tree() - before == set()


# The gallery and other pages that save pictures run where these are looked at, in test_images.py; the search for gains
# where what it prints is, in test_gains_guide.py. Both run all blocks in order, with warnings as errors.
ELSEWHERE = {f"docs/{page}" for page in ("guides/gains.md", *makers().values())}
READ = [path for path in DOCUMENTS if blocks(path) and title(path) not in ELSEWHERE]


@pytest.mark.parametrize("document", READ, ids=title)
def test_python_blocks_run_in_order(document: Path, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    code = "\n\n".join(blocks(document))
    lay_out(code, tmp_path, request)
    (tmp_path / "document.py").write_text(code, encoding="utf-8")
    run_python("document.py", folder=tmp_path)


@pytest.mark.parametrize("name", [name for name in MODULES if not name.endswith("._hrsafety")])
def test_docstring_examples_print_what_they_say(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    module = importlib.import_module(name)
    result = doctest.testmod(module, optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
    assert result.failed == 0


@pytest.mark.parametrize("example", EXAMPLES, ids=title)
def test_example_runs(example: Path, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    recording = RECORDINGS[0] if "recorded" in example.name else ""
    lay_out(recording, tmp_path, request)
    run_python(str(example), *filter(None, [recording]), folder=tmp_path)


def test_there_are_documents_and_examples_to_run() -> None:
    assert sum(len(blocks(document)) for document in DOCUMENTS) >= 10
    assert EXAMPLES


def test_every_link_between_documents_leads_somewhere() -> None:
    broken = []
    for document in DOCUMENTS:
        text = re.sub(r"^```.*?^```$", "", document.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
        for target in re.findall(r"\]\(([^)\s#]+)[^)]*\)", text):
            if not re.match(r"[a-z]+:", target) and not (document.parent / target).exists():
                broken.append(f"{title(document)}: {target}")
    assert not broken


def test_continuous_check_calls_the_test_command_of_the_readme() -> None:
    readme = (REPOSITORY / "README.md").read_text(encoding="utf-8")
    command = re.search(r"^```sh\n(make test)\n```$", readme, re.MULTILINE)
    assert command is not None
    script = (REPOSITORY / ".ci" / "run").read_text(encoding="utf-8")
    assert re.search(rf"^{re.escape(command.group(1))}\b", script, re.MULTILINE)


def extras_of_the_first_command(document: str) -> str:
    text = (REPOSITORY / document).read_text(encoding="utf-8")
    (extras,) = set(re.findall(r'pip install "\.\[([a-z,]+)\]"', text))
    return extras


# Pages that name the same extras are one case.
@pytest.mark.parametrize(
    "extras", sorted({extras_of_the_first_command(page) for page in ("README.md", "docs/start.md")})
)
def test_extras_of_the_first_command_are_enough_to_reproduce(extras: str, tmp_path: Path) -> None:
    printed = run_python("-c", WITH_THESE_ONLY, extras, ",".join(REPRODUCED), folder=tmp_path)
    assert printed.split() == ["summary.html"]


def test_no_page_installs_the_package_from_an_index() -> None:
    """It is on none: pages install it from its source tree."""
    found = [
        f"{title(document)}: {line.strip()}"
        for document in DOCUMENTS
        for line in document.read_text(encoding="utf-8").splitlines()
        if re.search(r"pip install ['\"]?hrsafety\b", line)
    ]
    assert found == []


def test_modes_of_environments_are_called_as_in_the_code() -> None:
    vector = pytest.importorskip("gymnasium.vector")
    words = {mode.value for mode in vector.AutoresetMode}
    text = (REPOSITORY / "docs" / "guides" / "gymnasium.md").read_text(encoding="utf-8")
    line = next(line for line in text.splitlines() if "`autoreset_mode`" in line)
    assert words <= set(re.findall(r'"(\w+)"', line))
    assert not re.search("|".join(mode.name for mode in vector.AutoresetMode if mode.name != mode.value), text)
