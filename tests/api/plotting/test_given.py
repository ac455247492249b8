"""Plain arguments of pictures are checked by name, and no picture issues warnings of NumPy."""

from __future__ import annotations

import warnings
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import navigation as nav
from hrsafety import plotting, scenarios
from hrsafety.errors import HrsafetyError, InvalidParameterError

pytest.importorskip("matplotlib")

RUN = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())


@pytest.mark.parametrize("value", [7, 1j, 0.5, object(), 2**70])
def test_a_wrong_plain_argument_is_named(value: object) -> None:
    calls = {
        "labels": lambda: plotting.paths([RUN], labels=value),
        "limits": lambda: plotting.contacts.forces_over_speed([0.1, 0.2], {"a": [1.0, 2.0]}, limits=value),
    }
    for name, call in calls.items():
        with pytest.raises(InvalidParameterError) as caught:
            call()
        assert caught.value.argument.split("[")[0] == name


@settings(max_examples=60, deadline=None)
@given(
    value=st.one_of(
        st.none(), st.text(max_size=2), st.integers(-(2**70), 2**70), st.floats(), st.complex_numbers(), st.booleans(),
        st.lists(st.floats(), max_size=3), st.dictionaries(st.text(max_size=1), st.floats(), max_size=2),
    ),
    place=st.integers(0, 8),
)  # fmt: skip
def test_pictures_answer_with_a_picture_or_an_error_of_the_package(value: object, place: int) -> None:
    calls = (
        lambda: plotting.clearances({"a": np.array([0.3, 0.5])}, title=value),
        lambda: plotting.paths([RUN], labels=value),
        lambda: plotting.contacts.forces_over_speed([0.1, 0.2], {"a": value}, limits={"limit": 100.0}),
        lambda: plotting.contacts.forces_over_speed([0.1, 0.2], {"a": [1.0, 2.0]}, limits=value),
        lambda: plotting.contacts.forces_over_speed(value, {"a": [1.0, 2.0]}, limits={"limit": 100.0}),
        lambda: plotting.contacts.contact_sensitivity({"thickness": value, "area": 1.0}),
        lambda: plotting.distances([RUN], labels=value),
        lambda: plotting.outcomes({"a": ["arrived"]}, contacts_moving=value),
        lambda: plotting.time_sequence(RUN, title=value),
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        with suppress(HrsafetyError):
            calls[place]()
