"""Names of the packages: the daily ones at the top, the others one level below and still found from the top."""

from __future__ import annotations

import importlib
import pickle
from types import ModuleType

import pytest

from api.namespaces import BELOW
from hrsafety import impact, plotting, reactive
from hrsafety import navigation as nav

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


@pytest.mark.parametrize("package", PACKAGES)
def test_top_of_a_package_is_short(package: ModuleType) -> None:
    assert len(package.__all__) <= 45
    assert set(BELOW[package]) <= set(package.__all__)
    assert dir(package) == sorted(package.__all__)


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
