"""Nested results of environments."""

from __future__ import annotations

from typing import Any

import numpy as np


def same(found: Any, expected: Any) -> None:
    """Assert that two trees of dictionaries, tuples, arrays and values are the same, bit for bit."""
    if isinstance(expected, dict):
        assert found.keys() == expected.keys()
        for name in expected:
            same(found[name], expected[name])
    elif isinstance(expected, tuple) or (isinstance(expected, np.ndarray) and expected.dtype == object):
        assert len(found) == len(expected)
        for one, other in zip(found, expected, strict=True):
            same(one, other)
    elif isinstance(expected, np.ndarray):
        np.testing.assert_array_equal(found, expected, strict=True)
    else:
        assert found == expected
