"""Bad arguments of the impact part are refused by name; nothing else escapes."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any

import pytest

from api.impact_calls import CALLS, PARTS
from api.namespaces import public
from api.spoiled import (
    names,
    refused,
    spoiled_calls,
)
from hrsafety import InvalidParameterError, impact

# One signal of a pair is too short for the other: the error may name either.
PARTNERS = {
    "time": {"acceleration_g", "angle"},
    "acceleration_g": {"time"},
    "angle": {"time"},
    "static_force": {"static_compression"},
    "static_compression": {"static_force"},
    "drop_time": {"drop_position"},
    "drop_position": {"drop_time"},
    "voltage": {"acceleration"},
    "acceleration": {"voltage"},
}
# A whole left out leaves its numbers without a source.
NUMBERS_OF = {"manipulator": "manipulator_mass", "foam": "foam_stiffness", "head": "head_mass"}


@pytest.mark.parametrize(("name", "argument", "values"), spoiled_calls(CALLS))
def test_bad_argument_is_refused_by_name(name: str, argument: str, values: Sequence[Any]) -> None:
    function, right, _ = CALLS[name]
    for value in values:
        with refused(value) as caught:
            function(**{**right, argument: value})
        found = set(re.split(r"[\[\].]+", names(caught.value)))
        allowed = {argument} | PARTNERS.get(argument, set())
        if name == "metrics_batch" and value is None:
            allowed.add(NUMBERS_OF.get(argument, argument))
        assert found & allowed, (found, str(caught.value))


def test_right_arguments_are_accepted() -> None:
    for function, right, _ in CALLS.values():
        function(**right)


NAMES = public(impact)


def test_every_public_name_that_can_be_called_is_spoiled() -> None:
    called = {name.split(".")[0].split()[0] for name in CALLS}
    results = {name for name in NAMES if name.endswith(("Response", "Batch", "Metrics", "Gradients", "Error"))}
    returned = {name for name in NAMES if name.endswith("Fit")}
    returned |= {"PdGains", "TubeInertia", "HeadInjury", "MovingLevel", "FoamBoundary", "FoamFeasibility", "FoamMargin"}
    plain = {"ConstrainedHead", "channel_corner", "channel_filter"}  # no argument; tested with the filters
    named = {name for name in NAMES if not name.isupper() and not name[-1].isdigit()}
    assert named - results - returned - plain <= called


def test_a_boundary_needs_a_limit() -> None:
    force_only = impact.FoamLimits(peak_head_acceleration_g=None, max_compression=None, peak_contact_force=300.0)
    design = impact.design_foam(impact.MANIPULATOR_1, force_only, closing_speed=1.25)
    calls: list[Callable[[], Any]] = [
        lambda: design.lower(71.9),
        lambda: impact.FoamLimits(peak_head_acceleration_g=None, max_compression=None),
        lambda: impact.foam_stiffness_upper(
            impact.MANIPULATOR_1, damping=71.9, closing_speed=1.25, peak_head_acceleration_g=None
        ),
    ]
    for call in calls:
        with pytest.raises(InvalidParameterError) as caught:
            call()
        assert names(caught.value) == "limits"


def test_a_constrained_head_has_no_limit_of_acceleration() -> None:
    with pytest.raises(InvalidParameterError) as caught:
        impact.foam_stiffness_upper(
            impact.MANIPULATOR_1, damping=71.9, closing_speed=1.25, head=impact.ConstrainedHead()
        )
    assert names(caught.value) == "peak_head_acceleration_g"


def test_bodies_that_do_not_close_in_have_no_histories() -> None:
    with pytest.raises(InvalidParameterError) as caught:
        impact.simulate(**{**PARTS, "closing_speed": -1.0})
    assert names(caught.value) == "closing_speed"
