"""The tree obeys its own rules: imports, names, glossary, docstrings."""

from __future__ import annotations

import ast
import dataclasses
import importlib
import inspect
import json
import pkgutil
import re
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import hrsafety
from api.glossary import identifiers
from api.namespaces import BELOW, places, public
from hrsafety import arms, contact, impact, reactive, standards
from hrsafety import navigation as nav

REPOSITORY = Path(__file__).resolve().parents[3]
PACKAGE = REPOSITORY / "python" / "hrsafety"
CORES = ("vff_core", "impact_core")
# Crates that `vff_core` gathers, each with those of them that it is built on.
PARTS_OF_A_CORE: dict[str, set[str]] = {
    "box_search": set(),
    "navigation_world": set(),
    "unknown_places": {"navigation_world"},
    "navigation_laws": {"navigation_world", "unknown_places"},
    "navigation_runs": {"box_search", "navigation_laws", "navigation_world", "unknown_places"},
}
PYTHON_CRATES = {"pyo3", "numpy", "pyo3-ffi"}
NATIVE = "hrsafety._hrsafety"
NATIVE_USERS = ("navigation", "impact", "reactive", "arms", "contact", "standards", "program", "gym")
COMPUTING = {
    *("simulate", "simulate_batch", "evaluate", "force_field", "force_terms", "lyapunov", "region_radii"),
    *("optimize_gains", "pareto_front", "gain_sensitivity", "gain_gradient"),
    *("calibrate_camera", "calibration_study", "observe", "track_positions"),
    *("track", "track_batch"),
}
COMPUTING_IMPACT = {"simulate", "simulate_direct_drive", "metrics", "metrics_batch", "gradients", "hic", "design_foam"}
COMPUTING_REACTIVE = {
    *("skirt_test", "skirt_run", "smallest_skirt"),
    *("locate", "locate_batch", "estimate_delays", "likeness", "record_burst", "jittered_fixes", "localize_bursts"),
}
VAGUE_NAMES = {"utils", "util", "common", "helpers", "helper", "misc", "types", "manager"}

SOURCES = sorted(PACKAGE.rglob("*.py"))


# ---- crates ---------------------------------------------------------------------------------


@cache
def cargo_metadata() -> dict[str, Any]:
    command = ["cargo", "metadata", "--format-version", "1", "--locked"]
    done = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=True)
    metadata: dict[str, Any] = json.loads(done.stdout)
    return metadata


def run_time_dependencies(crate: str) -> set[str]:
    """Return the names of everything that the crate is linked with."""
    metadata = cargo_metadata()
    packages = {package["id"]: package["name"] for package in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    waiting = [key for key in metadata["workspace_members"] if packages[key] == crate]
    assert len(waiting) == 1
    seen: set[str] = set()
    while waiting:
        for dependency in nodes[waiting.pop()]["deps"]:
            normal = any(kind["kind"] is None for kind in dependency["dep_kinds"])
            if normal and dependency["pkg"] not in seen:
                seen.add(dependency["pkg"])
                waiting.append(dependency["pkg"])
    return {packages[key] for key in seen}


@pytest.mark.parametrize("crate", CORES)
def test_core_knows_neither_python_nor_another_core(crate: str) -> None:
    assert run_time_dependencies(crate).isdisjoint(PYTHON_CRATES | (set(CORES) - {crate}) | {"hrsafety_py"})


def test_random_numbers_come_from_one_place() -> None:
    sources = (REPOSITORY / "crates").glob("*/src/**/*.rs")
    texts = {path: re.sub(r"(?s)#\[cfg\(test\)\].*", "", path.read_text("utf-8")) for path in sources}
    users = [path for path, text in texts.items() if "rand_chacha" in text and path.name != "tests.rs"]
    assert [path.relative_to(REPOSITORY).as_posix() for path in users] == ["crates/numeric/src/random.rs"]


def test_vectors_are_those_of_the_linear_algebra_library() -> None:
    assert "nalgebra" in run_time_dependencies("vff_core")
    own = [
        path for path in (REPOSITORY / "crates").rglob("*.rs") if re.search(r"struct Vec(tor)?[23]\b", path.read_text())
    ]
    assert own == []


def test_what_the_cores_share_knows_no_core() -> None:
    assert run_time_dependencies("numeric").isdisjoint(PYTHON_CRATES | set(CORES) | {"hrsafety_py"})


@pytest.mark.parametrize("crate", PARTS_OF_A_CORE)
def test_part_of_a_core_knows_those_below_alone(crate: str) -> None:
    assert run_time_dependencies(crate) & (set(PARTS_OF_A_CORE) | {*CORES}) == PARTS_OF_A_CORE[crate]


@pytest.mark.parametrize("crate", [*CORES, *PARTS_OF_A_CORE])
def test_core_is_free_of_python_in_its_tests_too(crate: str) -> None:
    package = next(entry for entry in cargo_metadata()["packages"] if entry["name"] == crate)
    assert {entry["name"] for entry in package["dependencies"]}.isdisjoint(PYTHON_CRATES)


def test_binding_crate_is_the_one_that_knows_python() -> None:
    assert {"pyo3", "vff_core"} <= run_time_dependencies("hrsafety_py")


def test_native_module_holds_nothing_but_the_binding() -> None:
    lines = (REPOSITORY / "crates/hrsafety_module/src/lib.rs").read_text(encoding="utf-8").splitlines()
    assert [line for line in lines if line and not line.startswith("//")] == ["use hrsafety_py as _;"]


@pytest.mark.parametrize("crate", [*CORES, *PARTS_OF_A_CORE, "numeric"])
def test_core_forbids_unsafe_code(crate: str) -> None:
    text = (REPOSITORY / "crates" / crate / "src" / "lib.rs").read_text(encoding="utf-8")
    assert re.search(r"^#!\[forbid\(unsafe_code\)\]", text, re.MULTILINE)


def test_no_example_stands_where_none_is_run() -> None:
    manifests = [path for path in (REPOSITORY / "crates").glob("*/Cargo.toml") if "doctest = false" in path.read_text()]
    assert len(manifests) > 5
    sources = [source for path in manifests for source in (path.parent / "src").rglob("*.rs")]
    assert [path for path in sources if re.search(r"^\s*//[/!] ```", path.read_text("utf-8"), re.MULTILINE)] == []


WORD_ARM = re.compile(r'"[^"]*"(?:\s*\|\s*"[^"]*")*(?:\s+if [^=]*)?\s*=>')
OTHER_ARM = re.compile(r"\n(?P<indent> *)(?:_|[a-z_]+) =>\s*(?P<answer>.{0,200})", re.DOTALL)


def silent_defaults(text: str) -> list[str]:
    """Return the arms that turn any other word into a choice, of matches that have an arm for a word."""
    found = []
    for arm in OTHER_ARM.finditer(text):
        # The arms of one match stand at one indent; it begins where the indent falls.
        before = text[: arm.start() + 1].split("\n")[:-1]
        indent, words = len(arm["indent"]), False
        for line in reversed(before):
            if line.strip() and len(line) - len(line.lstrip()) < indent:
                break
            words = words or bool(WORD_ARM.match(line.lstrip()) and len(line) - len(line.lstrip()) == indent)
        if words and not re.search(r"\bErr\(|Failure|\bunknown\(|\bpanic!\(", arm["answer"]):
            found.append(arm.group().strip().split("\n")[0])
    return found


def test_the_search_for_silent_defaults_finds_one() -> None:
    text = 'match word {\n    "a" => One,\n    "b" if near => Two,\n    _ => Three,\n}\n'
    assert silent_defaults(text) == ["_ => Three,"]
    assert silent_defaults(text.replace("_ => Three", "_ => return Err(refused())")) == []


def test_no_unknown_word_selects_a_branch() -> None:
    found = {path: silent_defaults(path.read_text("utf-8")) for path in (REPOSITORY / "crates").glob("*/src/**/*.rs")}
    assert len(found) > 500
    assert {path: arms for path, arms in found.items() if arms} == {}


@pytest.mark.parametrize("name", ["gains/problem.rs", "impact/history.rs", "laws.rs"])
def test_selections_of_the_binding_name_every_case(name: str) -> None:
    text = (REPOSITORY / "crates/hrsafety_py/src" / name).read_text(encoding="utf-8")
    assert not re.search(r"^\s*_ =>", text, re.MULTILINE)


def test_threads_come_from_one_place() -> None:
    sources = (REPOSITORY / "crates").glob("*/src/**/*.rs")
    users = [path for path in sources if re.search(r"\brayon\b|\bpar_\w+\(", path.read_text(encoding="utf-8"))]
    assert [path.relative_to(REPOSITORY).as_posix() for path in users] == ["crates/numeric/src/threads.rs"]


# ---- imports --------------------------------------------------------------------------------


def module_name(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@cache
def imported(path: Path) -> tuple[str, ...]:
    """Return every module that a source file imports, `from x import y` as x and as x.y."""
    return tuple(_imported(path))


def _imported(path: Path) -> Iterator[str]:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    package = module_name(path) if path.name == "__init__.py" else module_name(path).rpartition(".")[0]
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            name = ".".join([*base, *([node.module] if node.module else [])])
            yield name
            yield from (f"{name}.{alias.name}" for alias in node.names)


def inside(name: str, package: str) -> bool:
    return name == package or name.startswith(f"{package}.")


def test_native_module_is_imported_by_its_users_only() -> None:
    users = tuple(f"hrsafety.{user}" for user in NATIVE_USERS)
    others = [path for path in SOURCES if not any(inside(module_name(path), user) for user in users)]
    assert len(others) > 200
    assert [module_name(path) for path in others if any(inside(name, NATIVE) for name in imported(path))] == []


def other_users_imported(path: Path) -> list[str]:
    """Return what a module of one user of the native module imports of those that it may not know."""
    own = [user for user in NATIVE_USERS if inside(module_name(path), f"hrsafety.{user}")]
    if own == ["reactive"]:
        own.append("navigation")  # the experiments take sensors from there; nothing goes the other way
    if own == ["arms"]:
        own.append("standards")  # forces along a motion are held against limits; nothing goes the other way
    if own == ["contact"]:
        own += ["arms", "standards"]  # a study of a cell asks both for masses and limits; nothing goes the other way
    if own == ["program"]:
        own += [
            "arms",
            "contact",
            "standards",
        ]  # limits of contacts along the path of an arm; nothing goes the other way
    if own == ["gym"]:
        own.append("navigation")  # environments are made of its worlds; nothing goes the other way
    others = [f"hrsafety.{user}" for user in NATIVE_USERS if own and user not in own]
    return [name for name in imported(path) if any(inside(name, other) for other in others)]


def test_users_of_the_native_module_do_not_import_each_other() -> None:
    found = {module_name(path): other_users_imported(path) for path in SOURCES}
    assert {name: others for name, others in found.items() if others} == {}


def is_navigation(node: ast.expr) -> bool:
    """Return whether an expression is a module of the navigation package by its usual names."""
    return ast.unparse(node).split(".")[-1] in {"nav", "navigation", "simulation", "batch"}


@pytest.mark.parametrize("path", [path for path in SOURCES if "plotting" in path.parts], ids=module_name)
def test_plotting_computes_nothing(path: Path) -> None:
    # A picture may have the name of what it shows: plotting.force_field draws, it does not
    # compute. So the names count where they come from the navigation package.
    tree = ast.parse(path.read_text(encoding="utf-8"))
    assert not [
        name for name in imported(path) if inside(name, "hrsafety.navigation") and name.split(".")[-1] in COMPUTING
    ]
    used = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute) and is_navigation(node.value)}
    assert not used & COMPUTING
    assert not [name for name in imported(path) if inside(name, NATIVE)]


@pytest.mark.parametrize("path", [path for path in SOURCES if "plotting" in path.parts], ids=module_name)
def test_plotting_computes_no_impact(path: Path) -> None:
    called = {
        ast.unparse(node.func).split(".")[-1]
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and ast.unparse(node.func).startswith(("impact.", "hrsafety.impact."))
    }
    assert not called & COMPUTING_IMPACT
    assert not [
        name for name in imported(path) if inside(name, "hrsafety.impact") and name.split(".")[-1] in COMPUTING_IMPACT
    ]


@pytest.mark.parametrize("path", [path for path in SOURCES if "plotting" in path.parts], ids=module_name)
def test_plotting_computes_nothing_reactive(path: Path) -> None:
    called = {
        ast.unparse(node.func).split(".")[-1]
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and ast.unparse(node.func).startswith(("reactive.", "hrsafety.reactive."))
    }
    assert not called & COMPUTING_REACTIVE
    assert not [name for name in imported(path) if name.split(".")[-1] in COMPUTING_REACTIVE]


def test_importing_the_package_loads_no_optional_dependency() -> None:
    optional = {"matplotlib", "PIL", "scipy", "polars", "xarray", "dask", "distributed", "numba", "pandas"}
    optional |= {
        "ezdxf",
        "h5py",
        "rosbags",
        "foxglove",
        "yaml",
        "jinja2",
        "markupsafe",
        "rich",
        "shtab",
        "gymnasium",
        "pettingzoo",
        "rclpy",
    }
    parts = ("navigation", "impact", "reactive", "scenarios", "datasets", "plotting", "sweep", "cli")
    parts += ("arms", "contact", "standards", "benchmarks", "io", "zones", "ros")
    modules = ", ".join(["hrsafety", *(f"hrsafety.{part}" for part in parts)])
    code = f"import sys, {modules}; print(*sorted({optional} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


# ---- names ----------------------------------------------------------------------------------


def tracked_files() -> list[Path]:
    """Return the files of the repository: tracked, or new and not ignored."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
    done = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=True)
    return [path for name in done.stdout.split("\0") if name and (path := REPOSITORY / name).is_file()]


def test_no_module_has_a_vague_name() -> None:
    words = {path: path.relative_to(REPOSITORY).with_suffix("").parts for path in tracked_files()}
    assert not [path for path, parts in words.items() if {part.lower().lstrip("_") for part in parts} & VAGUE_NAMES]


def test_no_file_names_a_place_of_one_machine() -> None:
    # Spelled in two halves, so that this file does not find itself.
    places = ["/" + "work/", "/" + "tmp/", "/" + "root/", "/" + "home/", "../" + "shared", "C:" + "\\Users"]
    pattern = re.compile("|".join(rf"(?<![\w.]){re.escape(place)}" for place in places))
    found = []
    for path in tracked_files():
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        found += [f"{path.relative_to(REPOSITORY)}: {match.group()}" for match in pattern.finditer(text)]
    assert not found


def test_failing_random_cases_are_written_where_they_are_committed() -> None:
    """proptest writes them beside the tests and the sources of a crate, unless it is told not to."""
    sources = (REPOSITORY / "crates").rglob("*.rs")
    assert not [path for path in sources if "failure_persistence" in path.read_text(encoding="utf-8")]
    folder = "crates/vff_core"
    places = [f"{folder}/tests/proptest-regressions/lanes.txt", f"{folder}/proptest-regressions/laws/law.txt"]
    command = ["git", "check-ignore", "--no-index", *places]
    assert subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=False).stdout == ""
    command = ["git", "ls-files", "--others", "--exclude-standard", "--", "*proptest-regressions*"]
    assert subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=True).stdout == ""


def test_nothing_is_left_to_fill_in() -> None:
    marks = ["TO" + "DO", "FIX" + "ME", "FILL" + "ME", "X" * 3]
    pattern = re.compile(r"\b(" + "|".join(marks) + r")\b")
    texts = [path for path in tracked_files() if path.suffix in {".py", ".pyi", ".rs", ".md", ".toml", ".rst"}]
    assert not [str(path.relative_to(REPOSITORY)) for path in texts if pattern.search(path.read_text(encoding="utf-8"))]


# ---- glossary -------------------------------------------------------------------------------


def fields_of(kind: Any) -> list[str]:
    """Return the public fields of a dataclass or named tuple."""
    if dataclasses.is_dataclass(kind):
        names = [field.name for field in dataclasses.fields(kind)]
    else:
        names = list(getattr(kind, "_fields", ()))
    return [name for name in names if not name.startswith("_")]


def public_fields() -> list[tuple[str, str]]:
    """Return (class, field) for every public record of the packages that compute."""
    packages = (nav, impact, contact, reactive, arms, standards)
    kinds = {name: kind for module in packages for name, kind in public(module).items()}
    return [(name, field) for name, kind in kinds.items() if inspect.isclass(kind) for field in fields_of(kind)]


def test_public_fields_are_in_the_glossary() -> None:
    fields = public_fields()
    assert len(fields) > 1500
    assert [f"{kind}.{field}" for kind, field in fields if field not in identifiers()] == []


# ---- docstrings -----------------------------------------------------------------------------

# Modules whose public names users call. Examples stand where a call makes sense on its own.
DOCUMENTED = (
    *(place.__name__.removeprefix("hrsafety.") for package in BELOW for place in places(package)),
    "scenarios",
    "datasets",
    "reproduce",
    "sweep",
    "tables",
    "errors",
)
NEEDS_NO_EXAMPLE = {
    "reproduce",  # runs for minutes
}


def public_names(module: ModuleType) -> Iterator[tuple[str, Any]]:
    for name in module.__all__:
        value = getattr(module, name)
        if getattr(value, "__module__", "").startswith("hrsafety"):
            yield f"{module.__name__.removeprefix('hrsafety.')}.{name}", value


def documented(kind: str) -> list[Any]:
    found: dict[str, Any] = {}
    for name in DOCUMENTED:
        module = importlib.import_module(f"hrsafety.{name}")
        found |= {path: value for path, value in public_names(module)}
    test = inspect.isclass if kind == "class" else inspect.isfunction
    return [pytest.param(value, id=path) for path, value in found.items() if test(value)]


def sections(docstring: str) -> dict[str, str]:
    """Split a numpydoc docstring into its sections."""
    parts = re.split(r"^([A-Z][A-Za-z ]+)\n-{3,}\n", inspect.cleandoc(docstring), flags=re.MULTILINE)
    return {"Summary": parts[0], **dict(zip(parts[1::2], parts[2::2], strict=True))}


def described(section: str) -> set[str]:
    """Return the names that a section describes."""
    lines = [line for line in section.splitlines() if line and not line.startswith(" ")]
    return {name.strip(" *") for line in lines for name in line.split(" : ")[0].split(",")}


@pytest.mark.parametrize("function", documented("function"))
def test_public_function_describes_parameters_result_and_use(function: Any) -> None:
    found = sections(function.__doc__ or "")
    signature = inspect.signature(function)
    assert found["Summary"].strip().splitlines()[0].endswith(".")
    assert set(signature.parameters) <= described(found.get("Parameters", ""))
    if signature.return_annotation not in {None, "None"}:
        assert found.keys() & {"Returns", "Yields"}
    if function.__module__.split(".")[1] not in NEEDS_NO_EXAMPLE:
        assert ">>> " in found.get("Examples", "")


@pytest.mark.parametrize("kind", documented("class"))
def test_public_class_describes_its_fields(kind: Any) -> None:
    found = sections(kind.__doc__ or "")
    assert found["Summary"].strip()
    assert set(fields_of(kind)) <= described(found.get("Parameters", "")) | described(found.get("Attributes", ""))


@pytest.mark.parametrize("kind", documented("class"))
def test_public_method_has_a_docstring(kind: Any) -> None:
    methods = [name for name in vars(kind) if not name.startswith("_") and inspect.isroutine(getattr(kind, name))]
    assert not [name for name in methods if not (getattr(kind, name).__doc__ or "").strip()]


def test_every_module_can_be_imported_and_says_what_it_is() -> None:
    for entry in pkgutil.walk_packages(hrsafety.__path__, "hrsafety."):
        if entry.name != NATIVE:
            assert (importlib.import_module(entry.name).__doc__ or "").strip(), entry.name
