"""Whatever numbers a picture is given, it is drawn without a warning or refused by name."""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("matplotlib")

from hrsafety import contact, impact, plotting, reactive, standards, sweep  # needs the check above
from hrsafety import navigation as nav  # needs the check above
from hrsafety.errors import HrsafetyError, InvalidParameterError  # needs the check above
from hrsafety.navigation.metrics import wilson  # needs the check above
from hrsafety.plausibility import HrsafetyWarning  # needs the check above

NAN, INF = float("nan"), float("inf")
NUMBERS: dict[str, list[float]] = {
    "none": [],
    "one": [1.0],
    "rising": [1.0, 2.0, 3.0],
    "falling": [3.0, 2.0, 1.0],
    "constant": [1.0, 1.0, 1.0],
    "zero": [0.0, 0.0, 0.0],
    "negative": [-3.0, -2.0, -1.0],
    "unknown": [NAN, NAN, NAN],
    "partly unknown": [1.0, NAN, 3.0],
    "infinite": [INF, INF, INF],
    "partly infinite": [1.0, INF, 3.0],
    "both infinite": [-INF, 0.0, INF],
    "large": [1e300, 1e301, 1e302],
    "largest": [-1.7e308, 0.0, 1.7e308],
    "tiny": [1e-320, 2e-320, 3e-320],
    "hardly rising": [1.0, 1.0 + 3e-16, 1.0 + 6e-16],
}
OK = NUMBERS["rising"]
TABLE = np.arange(9.0).reshape(3, 3)
HIT = impact.simulate(impact.MANIPULATOR_2, impact.FOAM_1, impact.Head.minimum(), closing_speed=1.25)
PRESS = contact.Contact(robot=8.0, region=25e3).simulate(0.2)
LOADS = {"linear": {}, "logarithmic": {"log_parameter": True}}

VECTORS: dict[str, Callable[[list[float]], Any]] = {
    "clearances": lambda v: plotting.clearances({"a": v}),
    "clearances of two": lambda v: plotting.clearances({"a": v, "b": OK}),
    "counts": lambda v: plotting.outcomes(
        {"a": ["arrived"] * max(len(v), 1)}, contacts_moving={"a": v}, contacts_standing={"a": v}
    ),
    "sensitivity": lambda v: plotting.contacts.contact_sensitivity({str(key): each for key, each in enumerate(v)}),
    "forces over": lambda v: plotting.contacts.forces_over_speed(v, {"a": OK[: len(v)]}),
    "forces": lambda v: plotting.contacts.forces_over_speed(OK[: len(v)], {"a": v}),
    "limits of forces": lambda v: plotting.contacts.forces_over_speed(
        OK, {"a": OK}, limits={str(key): each for key, each in enumerate(v)}, planned=v[0] if v else None
    ),
    "limits of loads": lambda v: plotting.contacts.contact_forces(
        {"a": PRESS}, limits=dict(zip("abc", v, strict=False))
    ),
    "thickness": lambda v: plotting.contacts.speed_map(v, OK, np.zeros((len(v), 3))),
    "strength": lambda v: plotting.contacts.speed_map(OK, v, np.zeros((3, len(v)))),
    "speeds": lambda v: plotting.contacts.speed_map(OK, OK, np.tile(np.resize(v or [NAN], 3), (3, 1)), wanted=1.5),
    "one speed": lambda v: plotting.contacts.speed_map(OK, OK, np.where(TABLE == 4.0, v[0] if v else 0.0, TABLE)),
    "wanted": lambda v: plotting.contacts.speed_map(OK, OK, TABLE, wanted=v[-1] if v else 4.0, own=(1.0, 1.0)),
    "own": lambda v: plotting.contacts.speed_map(OK, OK, TABLE, own=(v[-1], 1.0) if v else None),
    "distances": lambda v: plotting.contacts.speed_over_distance(
        standards.speed_over_distance(v, contact_speed=0.2, max_speed=1.0, reaction_time=0.1, deceleration=3.0)
    ),
    "damping": lambda v: plotting.impacts.foam_map(v, OK, np.zeros((3, len(v))), quantity="q"),
    "stiffness": lambda v: plotting.impacts.foam_map(OK, v, np.zeros((len(v), 3)), quantity="q"),
    "metric": lambda v: plotting.impacts.foam_map(
        OK, OK, np.tile(np.resize(v or [NAN], 3), (3, 1)), quantity="q", limit=1.5
    ),
    "limit of a metric": lambda v: plotting.impacts.foam_map(OK, OK, TABLE, quantity="q", limit=v[-1] if v else None),
    "far foam": lambda v: plotting.impacts.foam_map(
        OK, OK, TABLE, quantity="q", foams={"a": impact.Foam(stiffness=v[-1] if v else 1.0, damping=1.0)}
    ),
    **{
        f"{name} study over": lambda v, kind=kind: plotting.impact_study(v, {"a": OK[: len(v)]}, parameter="p", **kind)
        for name, kind in LOADS.items()
    },
    "study": lambda v: plotting.impact_study(OK[: len(v)], {"a": v}, parameter="p"),
    "limit of a study": lambda v: plotting.impact_study(OK, {"a": OK}, parameter="p", limit=v[-1] if v else None),
    "mark of a study": lambda v: plotting.impact_study(
        OK, {"a": OK}, parameter="p", marks={"m": (v[0], v[-1])} if v else {}
    ),
    "limits of an impact": lambda v: plotting.impact_histories(HIT, limits={"head_acceleration": v[-1] if v else 1.0}),
    "measured": lambda v: plotting.measured_impact(
        HIT, peak_head_acceleration_g=v, impact_duration=v, max_compression=v
    ),
    "density": lambda v: plotting.crowds.fundamental_diagram(v, {"a": OK[: len(v)]}),
    "speed of people": lambda v: plotting.crowds.fundamental_diagram(OK[: len(v)], {"a": v}),
    "reference": lambda v: plotting.crowds.fundamental_diagram(OK, {"a": OK}, reference=v),
    "directions": lambda v: plotting.reactive.skirt_ring(
        reactive.UltrasonicSkirt(), directions={str(key): each for key, each in enumerate(v)}
    ),
    "boundaries": lambda v: plotting.foam_boundaries(v, None, None, foams={"a": impact.FOAM_1}),
}


def drawn(make: Callable[[], Any]) -> bool:
    """Return whether a picture is drawn, to its last pixel, and not refused; pytest makes warnings errors."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HrsafetyWarning)  # what is told of the numbers themselves
        try:
            make().savefig(io.BytesIO(), dpi=40)
        except HrsafetyError:
            return False
    return True


@pytest.mark.parametrize("name", VECTORS)
def test_numbers_are_drawn_or_refused(name: str) -> None:
    found = {kind: drawn(lambda: VECTORS[name](list(values))) for kind, values in NUMBERS.items()}  # noqa: B023  # called at once
    assert any(found.values()), name


VALUES = st.floats() | st.sampled_from([NAN, INF, -INF, 0.0, 1.7e308, -1.7e308, 5e-324, 1.0])


@settings(max_examples=60, deadline=None)
@given(name=st.sampled_from(sorted(VECTORS)), values=st.lists(VALUES, max_size=3))
def test_any_numbers_are_drawn_or_refused(name: str, values: list[float]) -> None:
    drawn(lambda: VECTORS[name](list(values)))


# ---- results --------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", NUMBERS)
def test_columns_of_sweeps_are_drawn_or_refused(kind: str) -> None:
    values = NUMBERS[kind] or [1.0]
    grid = sweep.Grid([sweep.Axis(name="a", values=OK), sweep.Axis(name="b", values=[0.0, 1.0])])

    def column(a: np.ndarray, b: np.ndarray | None = None) -> dict[str, np.ndarray]:
        return {"out": np.resize(values, len(a)), "flat": np.ones(len(a)) + 0.0 * (a if b is None else b)}

    study = sweep.FunctionStudy(function=column, results=["out", "flat"])
    plane, line = sweep.run(grid, study, threads=1), sweep.run(sweep.Grid(grid.axes[:1]), study, threads=1)
    assert drawn(lambda: plotting.sweep_map(plane, "flat"))
    for make in (plotting.sweep_map, plotting.sweep_scatter, plotting.sweep_parallel):
        drawn(lambda: make(plane, "out"))  # noqa: B023  # called at once
    drawn(lambda: plotting.sweep_lines(line, "out"))


def test_axes_of_sweeps_that_cannot_be_told_apart_are_refused() -> None:
    study = sweep.FunctionStudy(function=lambda **axes: {"out": axes["b"]}, results=["out"])
    second = sweep.Axis(name="b", values=[0.0, 1.0])
    for values in ([-1e308, 1e308], [1.0, 1.0 + 3e-16]):
        result = sweep.run(sweep.Grid([sweep.Axis(name="a", values=values), second]), study, threads=1)
        for make in (plotting.sweep_map, plotting.sweep_scatter, plotting.sweep_parallel):
            with pytest.raises(InvalidParameterError, match=r"^axis 'a' must"):
                make(result, "out")


def test_runs_of_one_period_and_runs_that_end_at_once(tmp_path: Path) -> None:
    short = nav.simulate(nav.Scenario(start=(0.0, 0.0), goal=(3.0, 0.0), time_limit=0.12), nav.VirtualForceField())
    for make in (plotting.paths, plotting.distances, plotting.energy, plotting.lyapunov, plotting.time_sequence):
        drawn(lambda: make(short))  # noqa: B023  # called at once
    plotting.animate(short, tmp_path / "short.gif", frames_per_second=2)
    leader = reactive.SoundLeader(start=(0.9, 0.0))
    inside = [reactive.Cylinder(center=(0.1, 0.0), radius=0.2)]
    touched = reactive.follow(reactive.FollowerScene(leader=leader, obstacles=inside, duration=1.0))
    with pytest.raises(InvalidParameterError, match=r"^runs\['a'\] must have a row"):
        plotting.reactive.follower_runs({"a": touched})
    with pytest.raises(InvalidParameterError, match=r"^run must have a row"):
        plotting.reactive.animate_follower(touched, tmp_path / "touched.gif")


def test_who_is_far_away_is_not_named_in_the_picture(tmp_path: Path) -> None:
    far = nav.Human(start=(9000.0, 9000.0), velocity=(1.0, 0.0))
    scene = nav.Scenario(start=(0.0, 0.0), goal=(1.0, 0.0), obstacles=[far])
    plotting.animate(nav.simulate(scene, nav.VirtualForceField()), tmp_path / "far.gif", frames_per_second=1)


@pytest.mark.parametrize("clearance", [-1e-3, 0.0, 1e-3])
def test_a_single_clearance_has_a_picture(clearance: float) -> None:
    assert drawn(lambda: plotting.clearances({"a": [clearance]}))


def test_directions_and_origins_that_are_no_places_are_refused() -> None:
    person = nav.Person(start=(0, 0), route=[(3, 0)])
    run = nav.simulate(nav.World(people=[person], time_limit=1.0))
    for more in ({"along": (INF, 0.0)}, {"along": (0.0, 0.0)}, {"origin": (1e308, -1e308)}, {"origin": (NAN, 0.0)}):
        with pytest.raises(InvalidParameterError, match=f"^{next(iter(more))}"):
            plotting.crowds.space_time(run, **more)
    assert drawn(lambda: plotting.crowds.space_time(run))


def test_shares_of_nothing_are_refused() -> None:
    assert drawn(lambda: plotting.reactive.follower_rates({"a": {"b": wilson(0, 1)}}))
    assert not drawn(lambda: plotting.reactive.follower_rates({}))
