"""The recipes for additions: their files exist, their counts are right, and no other file has to be changed."""

from __future__ import annotations

import ast
import re
import subprocess
from collections.abc import Iterable
from functools import cache
from pathlib import Path

import pytest

from hrsafety import navigation as nav
from hrsafety.impact.criteria.declared import CRITERIA
from hrsafety.navigation.crowd import pedestrians
from hrsafety.navigation.laws.known import LAWS

MODELS_OF_PEOPLE = [getattr(pedestrians, name) for name in pedestrians.__all__ if name != "Pedestrian"]
REPOSITORY = Path(__file__).resolve().parents[3]
GUIDE = (REPOSITORY / "CONTRIBUTING.md").read_text(encoding="utf-8")
RECIPE = re.compile(r"^### (?P<title>[^\n]+?) \((?P<count>\d+) files\)\n(?P<text>.*?)(?=^##)", re.MULTILINE | re.DOTALL)
ITEM = re.compile(r"^\d+\. `([^`]+)`: ", re.MULTILINE)

MOST = {
    "A navigation law": 7,
    "A gain of a law": 6,
    "A sensor on a robot": 7,
    "A model of people": 7,
    "A social metric": 7,
    "A criterion of an impact": 8,
    "A reader of files": 5,
}
"""How many files an addition may touch."""


def recipes(text: str) -> dict[str, tuple[int, list[str]]]:
    """Return by title the number of files that a recipe promises, and the files."""
    return {each["title"]: (int(each["count"]), ITEM.findall(each["text"])) for each in RECIPE.finditer(text)}


def files_of(title: str) -> set[str]:
    return set(recipes(GUIDE)[title][1])


# ---- the recipes ----------------------------------------------------------------------------


def test_the_search_for_recipes_reads_titles_counts_and_files() -> None:
    text = "### A gain (2 files)\n\n1. `a/b.rs`: its field,\n   `not.this`.\n2. `c.md`: its row.\n\n"
    text += "### Another (1 files)\n\nx\n\n## End"
    assert recipes(text) == {"A gain": (2, ["a/b.rs", "c.md"]), "Another": (1, [])}


def test_there_is_a_recipe_for_each_addition() -> None:
    assert set(recipes(GUIDE)) == set(MOST)


@pytest.mark.parametrize("title", MOST)
def test_a_recipe_names_as_many_files_as_it_says_and_no_more_than_allowed(title: str) -> None:
    count, files = recipes(GUIDE)[title]
    assert len(files) == len(set(files)) == count <= MOST[title]


@pytest.mark.parametrize("title", MOST)
def test_every_file_of_a_recipe_exists(title: str) -> None:
    assert [name for name in files_of(title) if not (REPOSITORY / name).is_file()] == []


# ---- where names are written ----------------------------------------------------------------


def words_of_python(text: str) -> set[str]:
    """Return the words of names and strings of a module; documentation is none of them."""
    nodes = list(ast.walk(ast.parse(text)))
    prose = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    found: set[str] = set()
    for node in nodes:
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in prose:
            found |= set(re.findall(r"\w+", node.value))
        found |= {each for name in ("id", "attr", "name", "arg") if isinstance(each := getattr(node, name, None), str)}
    return found


def words_of(path: str, text: str) -> set[str]:
    """Return the words that have to be kept right: those of code, in a page of what is set as code."""
    if path.endswith((".py", ".pyi")):
        return words_of_python(text)
    if path.endswith(".rs"):
        text = re.sub(r"//[^\n]*", "", text.split("#[cfg(test)]\nmod tests {")[0])
    if path.endswith(".md"):
        text = " ".join(re.findall(r"^```.*?^```|`[^`\n]+`", text, re.MULTILINE | re.DOTALL))
    return set(re.findall(r"\w+", text))


@cache
def product() -> dict[str, set[str]]:
    """Return the words of every source file and page of the product; tests are none."""
    endings = (".rs", ".py", ".pyi", ".md", ".toml", ".html")
    names = ["crates/*/src/*", "python", "docs"]
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z", "--", *names]
    done = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=True)
    paths = [name for name in done.stdout.split("\0") if name.endswith(endings) and (REPOSITORY / name).is_file()]
    return {name: words_of(name, (REPOSITORY / name).read_text(encoding="utf-8")) for name in paths}


def lists_of(things: Iterable[set[str]], files: dict[str, set[str]]) -> set[str]:
    """Return the files that hold a name of each of some things."""
    each = list(things)
    return {path for path, words in files.items() if all(words & names for names in each)}


@cache
def rust_types() -> dict[str, str]:
    """Return by its name the Rust type of everything that is made by name."""
    pattern = re.compile(r"^impl Named for (\w+) \{\n    const NAME: &'static str = \"(\w+)\";", re.MULTILINE)
    texts = [path.read_text(encoding="utf-8") for path in (REPOSITORY / "crates").glob("*/src/**/*.rs")]
    return {name: kind for text in texts for kind, name in pattern.findall(text)}


def names_of(kind: type) -> set[str]:
    """Return how a law or a sensor may be called: in Python, in files, in Rust."""
    name = str(getattr(kind, "NAME"))  # noqa: B009  # of either kind
    return {kind.__name__, name, rust_types().get(name, name)}


def test_the_search_for_lists_finds_one() -> None:
    code = '"""GeCui."""\nCOLORS = {Masoud: 1, "khatib": 2}  # and GeCui\n'
    names = [{"Masoud", "masoud"}, {"Khatib", "khatib"}]
    assert lists_of(names, {"a.py": words_of("a.py", code)}) == {"a.py"}
    assert lists_of([*names, {"GeCui"}], {"a.py": words_of("a.py", code)}) == set()
    assert lists_of(names, {"a.rs": words_of("a.rs", "use Masoud; // Khatib\n")}) == set()
    assert lists_of(names, {"a.md": words_of("a.md", "`Masoud` and\n\n```\nKhatib\n```\n")}) == {"a.md"}
    assert lists_of(names, {"a.md": words_of("a.md", "Masoud and `Khatib`")}) == set()


def test_the_files_of_a_recipe_alone_have_all_laws() -> None:
    found = lists_of([names_of(law) for law in LAWS.values() if law is not nav.VirtualForceField], product())
    assert found <= files_of("A navigation law")


def test_the_files_of_a_recipe_alone_have_a_law_that_no_page_shows() -> None:
    names = names_of(nav.laws.VirtualImpedanceLaw)
    own = ("crates/navigation_laws/src/impedance/", "python/hrsafety/navigation/laws/impedance.py")
    found = {path for path, words in product().items() if words & names and not path.startswith(own)}
    assert found <= files_of("A navigation law")


def test_the_files_of_a_recipe_alone_have_all_criteria() -> None:
    assert lists_of([{name} for name in CRITERIA], product()) <= files_of("A criterion of an impact")


def test_the_files_of_a_recipe_alone_have_a_criterion_that_no_page_shows() -> None:
    found = {path for path, words in product().items() if "peak_power_foam" in words}
    assert found <= files_of("A criterion of an impact")


def test_the_files_of_a_recipe_alone_have_all_models_of_people() -> None:
    found = {
        path for path in lists_of([names_of(kind) for kind in MODELS_OF_PEOPLE], product()) if not path.endswith(".py")
    }
    measured = {"docs/validation.md", "docs/performance.md", "docs/limits.md"}
    assert found - measured <= files_of("A model of people")


def test_the_files_of_a_recipe_alone_have_all_social_metrics() -> None:
    found = {path for path, words in product().items() if "longest_without_progress" in words}
    assert found <= files_of("A social metric")


def test_the_files_of_a_recipe_alone_have_a_sensor() -> None:
    found = {path for path, words in product().items() if "Ultrasonic" in words}
    example = "python/hrsafety/navigation/robots/as_built.py"  # in the message about what is no sensor
    assert found - {example} <= files_of("A sensor on a robot")
