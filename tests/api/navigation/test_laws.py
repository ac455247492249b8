"""The laws as values: names of their numbers, equality, pickles, and what they refuse."""

from __future__ import annotations

import copy
import dataclasses
import math
import pickle
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from api.namespaces import public
from api.spoiled import INF, NAN, NOT_NEGATIVE, POSITIVE, WORD, names, refused, spoiled
from hrsafety import InvalidParameterError, ShapeError, scenarios
from hrsafety import navigation as nav

# Every law with something that is not its default.
LAWS: dict[str, nav.Law] = {
    "VirtualForceField": nav.VirtualForceField(attractive_gain=4.3, stabilizing="full", pass_behind=False),
    "Masoud": nav.Masoud(detour_gain=30.0),
    "GeCui": nav.GeCui(gain_ratio=0.9),
    "Khatib": nav.Khatib(repulsive_gain=0.4, form="printed"),
    "BorensteinKoren": nav.BorensteinKoren(attractive_gain=5.0, attracted_inside=False),
    "VelocityObstacle": nav.VelocityObstacle(margin=0.05, selection="time_and_risk"),
    "OptimalReciprocalCollisionAvoidance": nav.OptimalReciprocalCollisionAvoidance(horizon=3.0, reciprocal=True),
    "RapidlyExploringRandomTree": nav.RapidlyExploringRandomTree(goal_probability=0.2, draws=500, keeps_path=False),
    "FieldDStar": nav.FieldDStar(margin=0.1),
    "SocialForce": nav.SocialForce(people_weight=2.0, model=nav.crowd.SocialForce2000()),
    "DynamicWindow": nav.DynamicWindow(dist=0.3, prediction="constant_velocity"),
    "DWB": nav.DWB(max_vel_x=0.4, max_speed_xy=0.4, vx_samples=8),
    "RegulatedPurePursuit": nav.RegulatedPurePursuit(lookahead_dist=0.8, use_collision_detection=False),
    "PathIntegral": nav.PathIntegral(vx_max=0.8, batch_size=64, time_steps=20),
    "VirtualImpedanceLaw": nav.laws.VirtualImpedanceLaw(form="conventional", view=2.0),
}
C1 = scenarios.configuration("c1")
PLACE: dict[str, Any] = {"position": (3.5, 0.6), "velocity": (0.0, 0.0)}

each_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)


def same(law: nav.Law) -> Any:
    """Return a copy made by the standard library's way."""
    return replace(law)  # type: ignore[type-var]  # every law is a dataclass


def test_all_laws_of_the_package_are_here() -> None:
    kinds = {name for name, kind in public(nav).items() if isinstance(kind, type) and issubclass(kind, nav.Law)}
    # Rollouts need a robot with lidars.
    assert kinds - {"Law", "PythonLaw", "SafeNavigation", "ArcRollouts"} == set(LAWS)


# ---- values ---------------------------------------------------------------------------------


@each_law
def test_names_bounds_and_values_of_the_gains_belong_together(law: nav.Law) -> None:
    assert len(set(law.GAIN_NAMES)) == len(law.GAIN_NAMES) == len(law.gains)
    assert tuple(law.GAIN_BOUNDS) == tuple(law.GAIN_UNITS) == law.GAIN_NAMES
    assert law.gains == tuple(getattr(law, name) for name in law.GAIN_NAMES)
    for name, (low, high) in law.GAIN_BOUNDS.items():
        assert 0.0 <= low <= high < INF
        for value in (low, high):
            # Whatever a search may choose, the law takes; probabilities by pairs.
            others = {"goal_probability": 0.0, "waypoint_probability": 0.0} if "probability" in name else {}
            changed = law.replaced(**{**others, name: value})
            assert getattr(changed, name) == value
            assert changed.gains[law.GAIN_NAMES.index(name)] == value


@each_law
def test_largest_bounds_are_allowed_together(law: nav.Law) -> None:
    for side in (0, 1):
        assert law.replaced(**{name: bounds[side] for name, bounds in law.GAIN_BOUNDS.items()})


@each_law
def test_law_is_a_value(law: nav.Law) -> None:
    for again in (same(law), copy.copy(law), copy.deepcopy(law), pickle.loads(pickle.dumps(law))):
        assert again == law
        assert hash(again) == hash(law)
    assert eval(repr(law), public(nav) | {"inf": INF}) == law
    assert "_native" not in repr(law)
    first = law.GAIN_NAMES[0]
    other = law.replaced(**{first: getattr(law, first) + 0.125})
    assert other != law
    assert len({law, same(law), other}) == 2
    assert pickle.loads(pickle.dumps(other)) == other
    with pytest.raises(dataclasses.FrozenInstanceError):
        setattr(law, first, 1.0)


@each_law
def test_law_does_the_same_after_a_pickle(law: nav.Law) -> None:
    for again in (pickle.loads(pickle.dumps(law)), same(law)):
        one, other = nav.simulate(C1, law), nav.simulate(C1, again)
        assert one.position.tobytes() == other.position.tobytes()
        assert one.outcome == other.outcome


def test_laws_of_different_kinds_are_not_equal() -> None:
    assert len({repr(law) for law in LAWS.values()}) == len(set(LAWS.values())) == len(LAWS)
    gains = {"attractive_gain": 3.0, "repulsive_gain": 0.5, "gain_ratio": 1.0}
    one: nav.Law = nav.Khatib().replaced(**gains)
    assert one != nav.GeCui().replaced(**gains)


# ---- what is refused ------------------------------------------------------------------------

COUNT = (1.5, "1", b"1", None, True, -1, 10**6 + 1, NAN, INF, (1,))
FLAG = (1, 0, None, "yes", NAN, ())
PROBABILITY = (*NOT_NEGATIVE, 1.0000001, 2)
RULES: dict[str, dict[str, tuple[Any, ...]]] = {
    "Masoud": dict.fromkeys(("attractive_gain", "repulsive_gain", "detour_gain"), NOT_NEGATIVE),
    "GeCui": dict.fromkeys(("attractive_gain", "repulsive_gain", "gain_ratio"), NOT_NEGATIVE),
    "Khatib": dict.fromkeys(("attractive_gain", "repulsive_gain", "gain_ratio"), NOT_NEGATIVE) | {"form": WORD},
    "BorensteinKoren": {
        "attractive_gain": NOT_NEGATIVE,
        "repulsive_gain": NOT_NEGATIVE,
        "attracted_inside": FLAG,
    },
    "VelocityObstacle": {
        "margin": NOT_NEGATIVE,
        "horizon": tuple(value for value in POSITIVE if value != INF),
        "risk_weight": NOT_NEGATIVE,
        "sector": (*NOT_NEGATIVE, math.nextafter(math.pi, 4.0), 7.0),
        "selection": WORD,
    },
    "OptimalReciprocalCollisionAvoidance": {
        "horizon": POSITIVE,
        "margin": NOT_NEGATIVE,
        "turn": NOT_NEGATIVE,
        "reach": POSITIVE,
        "reciprocal": FLAG,
    },
    "RapidlyExploringRandomTree": {
        **dict.fromkeys(("step", "room", "look_ahead"), POSITIVE),
        **dict.fromkeys(("margin", "horizon"), NOT_NEGATIVE),
        **dict.fromkeys(("goal_probability", "waypoint_probability"), PROBABILITY),
        "draws": (*COUNT, 0),
        "waypoints": COUNT,
        "safety_draws": COUNT,
        "keeps_path": FLAG,
    },
    "FieldDStar": {
        **dict.fromkeys(("resolution", "room", "look_ahead"), POSITIVE),
        **dict.fromkeys(("margin", "horizon"), NOT_NEGATIVE),
    },
    "SocialForce": {"people_weight": POSITIVE, "speed_share": (*POSITIVE, 1.1), "model": ("walker", 3, None)},
    "DynamicWindow": {
        **dict.fromkeys(("heading", "dist", "velocity"), NOT_NEGATIVE),
        **dict.fromkeys(("acceleration", "braking", "turn_acceleration", "turn_braking", "max_turn_rate"), POSITIVE),
        "prediction": WORD,
    },
    "DWB": {
        **dict.fromkeys(("max_vel_theta", "max_speed_xy", "cost_scaling_factor"), POSITIVE),
        **dict.fromkeys(("sim_time", "linear_granularity", "angular_granularity"), POSITIVE),
        **dict.fromkeys(("obstacle_scale", "path_dist_scale", "goal_dist_scale", "path_align_scale"), NOT_NEGATIVE),
        **dict.fromkeys(("goal_align_scale", "forward_point_distance", "inflation_radius"), NOT_NEGATIVE),
        **dict.fromkeys(("acc_lim_x", "acc_lim_theta", "min_speed_xy", "min_speed_theta"), NOT_NEGATIVE),
        **dict.fromkeys(("decel_lim_x", "decel_lim_y", "decel_lim_theta"), (NAN, INF, 0.1, "fast")),
        "acc_lim_y": NOT_NEGATIVE,
        **dict.fromkeys(("max_vel_x", "max_vel_y"), (NAN, INF, -0.5, "fast")),
        **dict.fromkeys(("min_vel_x", "min_vel_y"), (NAN, INF, "slow")),
        **dict.fromkeys(("vx_samples", "vy_samples", "vtheta_samples"), (*COUNT, 0, 1001)),
        "prediction": WORD,
    },
    "RegulatedPurePursuit": {
        **dict.fromkeys(("desired_linear_vel", "lookahead_dist", "lookahead_time", "cost_scaling_gain"), POSITIVE),
        **dict.fromkeys(("curvature_lookahead_dist", "rotate_to_heading_angular_vel", "max_angular_accel"), POSITIVE),
        **dict.fromkeys(("min_lookahead_dist", "approach_velocity_scaling_dist", "cost_scaling_dist"), POSITIVE),
        "max_allowed_time_to_collision_up_to_carrot": (*POSITIVE, 1e9),
        **dict.fromkeys(("rotate_to_heading_min_angle", "min_approach_linear_velocity"), NOT_NEGATIVE),
        **dict.fromkeys(("regulated_linear_scaling_min_speed", "inflation_radius"), NOT_NEGATIVE),
        "max_lookahead_dist": (NAN, 0.1),
        "regulated_linear_scaling_min_radius": POSITIVE,
        **dict.fromkeys(("use_rotate_to_heading", "use_collision_detection", "use_fixed_curvature_lookahead"), FLAG),
        **dict.fromkeys(
            (
                "use_velocity_scaled_lookahead_dist",
                "use_regulated_linear_velocity_scaling",
                "use_cost_regulated_linear_velocity_scaling",
            ),
            FLAG,
        ),
        "allow_reversing": (*FLAG, True),
        "prediction": WORD,
    },
    "PathIntegral": {
        **dict.fromkeys(("wz_max", "ax_max", "ay_max", "az_max", "vx_std", "vy_std", "wz_std"), POSITIVE),
        **dict.fromkeys(("model_dt", "temperature", "cost_scaling_factor"), POSITIVE),
        **dict.fromkeys(("vy_max", "gamma", "cost_weight", "goal_weight", "path_align_weight"), NOT_NEGATIVE),
        **dict.fromkeys(("path_follow_weight", "path_angle_weight", "prefer_forward_weight"), NOT_NEGATIVE),
        "inflation_radius": NOT_NEGATIVE,
        "vx_max": (NAN, INF, -0.5, "fast"),
        "vx_min": (NAN, -INF, "slow"),
        **dict.fromkeys(("batch_size", "time_steps"), (*COUNT, 0, 10**6)),
        "prediction": WORD,
    },
    "VirtualImpedanceLaw": {
        "form": WORD,
        **dict.fromkeys(("attraction_stiffness", "attraction_damping"), NOT_NEGATIVE),
        **dict.fromkeys(("stiffness", "damping", "safe_distance", "speed_limit", "reach"), POSITIVE),
        "view": (*POSITIVE, math.nextafter(math.pi, 4.0), 7.0),
    },
}


@pytest.mark.parametrize(("kind", "argument", "values"), spoiled(RULES))
def test_bad_values_are_refused_by_name(kind: str, argument: str, values: Sequence[Any]) -> None:
    for value in values:
        with refused(value) as caught:
            getattr(nav, kind)(**{argument: value})
        assert isinstance(caught.value, InvalidParameterError), repr(value)
        assert names(caught.value) == argument, repr(value)


@pytest.mark.parametrize("kind", RULES)
def test_rules_cover_every_argument(kind: str) -> None:
    assert {field.name for field in dataclasses.fields(getattr(nav, kind)) if field.init} == set(RULES[kind])


def test_probabilities_may_not_exceed_one_together() -> None:
    assert nav.RapidlyExploringRandomTree(goal_probability=0.4, waypoint_probability=0.6).waypoint_probability == 0.6
    with pytest.raises(InvalidParameterError) as caught:
        nav.RapidlyExploringRandomTree(goal_probability=0.5, waypoint_probability=0.6)
    assert names(caught.value) == "waypoint_probability"


def test_horizon_of_velocity_obstacles_may_be_infinite() -> None:
    assert nav.VelocityObstacle(horizon=INF) == nav.VelocityObstacle()
    assert nav.simulate(C1, nav.VelocityObstacle(horizon=INF)).outcome == "arrived"


@each_law
def test_gains_of_the_wrong_width_are_refused(law: nav.Law) -> None:
    width = len(law.gains)
    for shape in ((1, width + 1), (1, width - 1), (width,), (1, 1, width), ()):
        with pytest.raises(ShapeError) as caught:
            nav.simulate_batch([C1], law, np.ones(shape))
        assert names(caught.value) == "gains"


@each_law
def test_bad_gain_set_is_named(law: nav.Law) -> None:
    gains = np.array([law.gains, law.gains])
    for column, name in enumerate(law.GAIN_NAMES):
        for value in (NAN, -1.0, -INF):
            spoiled = gains.copy()
            spoiled[1, column] = value
            with pytest.raises(InvalidParameterError, match=name) as caught:
                nav.simulate_batch([C1], law, spoiled)
            assert names(caught.value) == f"gains[1].{name}"
    with pytest.raises(InvalidParameterError) as caught:
        nav.simulate_batch([C1], law, {"unknown": [1.0]})
    assert names(caught.value) == "gains"


PLANNERS = (
    "VelocityObstacle",
    "OptimalReciprocalCollisionAvoidance",
    "RapidlyExploringRandomTree",
    "FieldDStar",
    "SocialForce",
    "DynamicWindow",
    "DWB",
    "RegulatedPurePursuit",
    "PathIntegral",
    "VirtualImpedanceLaw",
)


@pytest.mark.parametrize("kind", LAWS)
def test_force_terms_are_those_of_sums_of_attraction_and_repulsion(kind: str) -> None:
    if kind not in PLANNERS:
        assert np.isfinite(nav.force_terms(LAWS[kind], C1, **PLACE).total).all()
        return
    rule = "law must be a sum of attraction and repulsion, such as VirtualForceField or Masoud, got one with the gains"
    with pytest.raises(InvalidParameterError, match=rule) as caught:
        nav.force_terms(LAWS[kind], C1, **PLACE)
    assert names(caught.value) == "law"


@pytest.mark.parametrize(
    "call",
    [
        lambda law: nav.lyapunov(law, C1, **PLACE),
        lambda law: nav.laws.force_field(law, C1, position=[PLACE["position"]]),
    ],
    ids=["lyapunov", "force_field"],
)
@pytest.mark.parametrize("kind", RULES)
def test_lyapunov_function_is_that_of_the_field_only(call: Any, kind: str) -> None:
    with pytest.raises(InvalidParameterError, match="law must be a VirtualForceField") as caught:
        call(LAWS[kind])
    assert names(caught.value) == "law"


BAD_CALLS: list[tuple[dict[str, Any], str]] = [
    ({"position": (1.0, 2.0, 3.0)}, "position"),
    ({"position": (NAN, 0.0)}, "position"),
    ({"position": "ab"}, "position"),
    ({"position": None}, "position"),
    ({"velocity": (0.0, INF)}, "velocity"),
    ({"velocity": (0.0,)}, "velocity"),
    ({"velocity": ("1", "2")}, "velocity"),
    ({"time": -1e-9}, "time"),
    ({"time": NAN}, "time"),
    ({"time": INF}, "time"),
    ({"time": "0"}, "time"),
    ({"law": None}, "law"),
    ({"law": nav.Masoud}, "law"),
    ({"law": C1}, "law"),
    ({"scenario": None}, "scenario"),
    ({"scenario": "c1"}, "scenario"),
]


@each_law
def test_command_refuses_bad_values_by_name(law: nav.Law) -> None:
    for change, argument in BAD_CALLS:
        with refused(change) as caught:
            nav.laws.command(**({"law": law, "scenario": C1} | PLACE | change))
        assert names(caught.value) == argument, repr(change)


GRIDS: list[tuple[dict[str, float], nav.Scenario]] = [
    ({"resolution": 1e-4}, C1),
    ({"resolution": 1e-300}, C1),
    ({"room": 1e9}, C1),
    ({"room": 1e300}, C1),
    ({}, replace(C1, start=(1e9, 0.0))),
    ({}, replace(C1, start=(-1e300, 0.0))),
]


@pytest.mark.parametrize(("numbers", "scene"), GRIDS)
def test_grid_that_is_too_large_is_refused(numbers: dict[str, float], scene: nav.Scenario) -> None:
    law = nav.FieldDStar(**numbers)
    calls: list[Any] = [
        lambda: nav.simulate(scene, law),
        lambda: nav.evaluate(scene, law),
        lambda: nav.laws.command(law, scene, position=scene.start, velocity=(0.0, 0.0)),
        lambda: nav.simulate_batch([C1, scene], law),
    ]
    for call in calls:
        with pytest.raises(InvalidParameterError, match="grid of at most") as caught:
            call()
        assert caught.value.argument.endswith("resolution")
