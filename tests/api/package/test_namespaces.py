"""Names of the packages: the daily ones at the top, the others one level below and still found from the top."""

from __future__ import annotations

import ast
import importlib
import pickle
import pkgutil
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from api.namespaces import BELOW, places
from hrsafety import arms, contact, impact, plotting, reactive, standards
from hrsafety import navigation as nav
from hrsafety.navigation.laws.known import LAWS

PLACES = [pytest.param(package, name, id=f"{package.__name__}.{name}") for package in BELOW for name in BELOW[package]]
PACKAGES = [pytest.param(package, id=package.__name__) for package in BELOW]
FIRST_NAVIGATION = """
    HolonomicRobot DifferentialDriveRobot Disc MovingDisc Rectangle Human Regions region_radii Scenario Measurement
    VirtualForceField Masoud GeCui Khatib BorensteinKoren VelocityObstacle RapidlyExploringRandomTree FieldDStar
    OptimalReciprocalCollisionAvoidance force_terms ForceTerms lyapunov Lyapunov simulate Trajectory evaluate
    Performance simulate_batch optimize_gains GainSearch gain_sensitivity
"""
FIRST_IMPACT = """
    Joint Manipulator Head ConstrainedHead Foam FOAM_1 FOAM_2 FOAM_3 MANIPULATOR_1 MANIPULATOR_2 simulate
    ImpactResponse metrics ImpactMetrics metrics_batch foam_stiffness_upper foam_stiffness_lower FoamBoundary
    design_foam FoamDesign identify_foam FoamFit hic HeadInjury
"""


def used_by_readers(package: ModuleType) -> set[str]:
    """Return the names of a package that guides and examples use."""
    short = "nav" if package is nav else package.__name__.removeprefix("hrsafety.")
    root = Path(__file__).resolve().parents[3]
    pages = [root / "README.md", *(root / "docs").rglob("*.md"), *(root / "examples").rglob("*.py")]
    blocks = [each.read_text(encoding="utf-8") for each in pages if each.suffix == ".py"]
    for page in pages[: len(pages) - len(blocks)]:
        blocks += re.findall(r"^```python$(.*?)^```$", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    used = {name for block in blocks for name in re.findall(rf"(?<![\w.]){short}\.([A-Za-z]\w*)\b(?!=)", block)}
    return {name for name in used if hasattr(package, name)}  # others are fields and files: the blocks run


@pytest.mark.parametrize("package", PACKAGES)
def test_dir_of_a_package_shows_the_names_that_guides_and_examples_use(package: ModuleType) -> None:
    assert set(BELOW[package]) <= set(package.__all__)
    assert sorted({*dir(package)} - {"__all__"}) == sorted(package.__all__)
    modules = {each.name for each in pkgutil.iter_modules(package.__path__)}
    assert used_by_readers(package) - modules <= {*dir(package)}


def test_examples_that_are_read_use_many_names() -> None:
    shown = {"SafeNavigation", "StaticMap", "Guide", "Shield", "Yielding", "Lidar", "Controller", "falsify"}
    assert shown <= used_by_readers(nav) & set(dir(nav))


@pytest.mark.parametrize(("package", "name"), PLACES)
def test_names_of_a_namespace_are_found_from_the_package(package: ModuleType, name: str) -> None:
    namespace = importlib.import_module(f"{package.__name__}.{name}")
    assert getattr(package, name) is namespace
    assert namespace.__all__
    for each in namespace.__all__:
        # `nav.evaluate` scores a law in a scenario, `nav.metrics.evaluate` a run of any origin.
        if (name, each) != ("metrics", "evaluate"):
            assert getattr(package, each) is getattr(namespace, each), each


@pytest.mark.parametrize(
    ("package", "name"),
    [*((nav, each) for each in FIRST_NAVIGATION.split()), *((impact, each) for each in FIRST_IMPACT.split())],
)
def test_names_that_others_build_on_stand_at_the_top(package: ModuleType, name: str) -> None:
    assert name in package.__all__
    assert hasattr(package, name)


@pytest.mark.parametrize(
    ("package", "asked", "meant"),
    [
        (nav, "Camra", "Camera"),
        (nav, "simulat", "simulate"),
        (impact, "tube_inertai", "tube_inertia"),
        (reactive, "UltrasonicSkrit", "UltrasonicSkirt"),
        (plotting, "sound_fix", "sound_fixes"),
    ],
)
def test_unknown_name_says_which_was_meant(package: ModuleType, asked: str, meant: str) -> None:
    message = f"module '{package.__name__}' has no attribute '{asked}'; did you mean \"{meant}\"?"
    with pytest.raises(AttributeError) as caught:
        getattr(package, asked)
    assert str(caught.value) == message
    assert not hasattr(package, "__wrapped__")
    with pytest.raises(ImportError):
        exec(f"from {package.__name__} import {asked}")


def test_moved_names_are_pickled_by_the_place_where_they_stand() -> None:
    for value in (nav.robots.Slip(), nav.sensing.Camera(), nav.tracking.LineReference(start=(0.0, 0.0))):
        again = pickle.loads(pickle.dumps(value))
        assert again == value
        assert repr(again) == repr(value)
        assert type(value).__module__.startswith("hrsafety.navigation.")


# ---- names that are loaded when they are asked for ----------------------------------------------------

COMPUTING = (nav, impact, reactive, contact, arms, standards)
LOADED_LATER = [plotting, *(each for package in COMPUTING for each in places(package))]
each_later = pytest.mark.parametrize("package", LOADED_LATER, ids=lambda each: each.__name__)


@each_later
def test_a_package_lists_its_names_once(package: ModuleType) -> None:
    """The names that type checkers see are those of run time, in the modules that they name."""
    assert package.__file__
    source = Path(package.__file__).read_text(encoding="utf-8")
    assert source.count("__all__") == 1
    (block,) = (each for each in ast.parse(source).body if isinstance(each, ast.If))
    listed = [(alias, node.module) for node in block.body if isinstance(node, ast.ImportFrom) for alias in node.names]
    assert sorted(alias.name for alias, _ in listed) == package.__all__
    for alias, module in listed:
        # Without `as` a type checker takes the name for an import of the module's own.
        assert alias.asname == alias.name
        value = getattr(package, alias.name)
        there = f"{module}.{alias.name}"
        assert value is (
            sys.modules[there] if module == package.__name__ else getattr(sys.modules[str(module)], alias.name)
        )


def test_a_package_without_its_source_says_why_it_has_no_names(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(type(nav.__spec__.loader), "get_source", lambda *_: None)
    with pytest.raises(ImportError, match="lists its names in its source file"):
        importlib.reload(impact.joints)


@each_later
def test_no_name_is_hidden_by_a_module_that_is_loaded_later(package: ModuleType) -> None:
    """Loading `package.module` puts the module into the package, in the place of a function of the same name."""
    modules = {each.name for each in pkgutil.iter_modules(package.__path__)}
    assert {name for name in package.__all__ if not isinstance(getattr(package, name), ModuleType)}.isdisjoint(modules)


@each_later
def test_makers_of_documentation_find_every_name_and_the_list_of_them(package: ModuleType) -> None:
    assert {"__all__", *package.__all__} <= set(dir(package))


@each_later
def test_star_and_from_imports_find_every_name(package: ModuleType) -> None:
    found: dict[str, object] = {}
    exec(f"from {package.__name__} import *", found)
    assert set(package.__all__) <= set(found)
    exec(f"from {package.__name__} import {', '.join(package.__all__)}", found)


def loaded_by(code: str) -> set[str]:
    """Return the modules that a program loads on top of numpy."""
    program = f"import sys, numpy; before = set(sys.modules)\n{code}\nprint(*sorted(set(sys.modules) - before))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


@pytest.mark.parametrize("package", COMPUTING, ids=lambda each: each.__name__)
def test_an_import_loads_no_module_of_the_package(package: ModuleType) -> None:
    loaded = loaded_by(f"import {package.__name__}")
    inside = {name for name in loaded if name.startswith("hrsafety.") and not name.startswith("hrsafety._")}
    assert inside == {package.__name__, "hrsafety.errors"}


def test_a_run_loads_what_it_needs() -> None:
    loaded = loaded_by(
        "from hrsafety import navigation as nav\n"
        "scene = nav.Scenario(start=(3.9, 0.6), goal=(0, 0.6), obstacles=[nav.Disc(center=(2, 1.4), radius=0.1)])\n"
        "nav.evaluate(scene, nav.VirtualForceField())"
    )
    assert {"hrsafety.navigation.simulation", "hrsafety.navigation.laws.force_laws"} <= loaded
    for part in ("crowd", "gains", "metrics", "tracking"):
        assert not [name for name in loaded if name.startswith(f"hrsafety.navigation.{part}.")]
    # Those take longer than the run, and are for files, notebooks and errors.
    assert loaded.isdisjoint({"csv", "difflib", "html", "json", "pathlib", "tempfile", "urllib", "zipfile"})


def test_modules_and_names_below_are_found_before_anything_is_loaded() -> None:
    for asked in ("outcomes.OUTCOMES", "Camera", "tables", "InvalidParameterError", "gains.metrics.METRICS"):
        assert "hrsafety.navigation" in loaded_by(f"import hrsafety.navigation as nav; nav.{asked}")


def test_the_list_of_laws_is_whole_in_the_same_order_whichever_was_loaded_first() -> None:
    program = "import hrsafety.navigation as nav; {}; from hrsafety.navigation.laws.known import LAWS; print(*LAWS)"
    orders = set()
    for first in ("nav.FieldDStar", "nav.laws.VirtualImpedanceLaw", "nav.Khatib", "pass"):
        done = subprocess.run([sys.executable, "-c", program.format(first)], capture_output=True, text=True, check=True)
        orders.add(done.stdout)
    assert len(orders) == 1
    assert tuple(orders.pop().split()) == tuple(LAWS)
