"""Inertias that rigid bodies can have."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, finite, numbers
from hrsafety._display import displayed
from hrsafety.errors import ShapeError

__all__ = ["NearestInertia", "nearest_inertia"]


@displayed
class NearestInertia(NamedTuple):
    """The nearest inertia that a rigid body can have.

    Attributes
    ----------
    inertia : ndarray (3, 3)
        In kg m^2; the given one if a body can have that.
    violation : float
        By how much the given one missed that, as a share of its trace; 0 if it did not, inf without a positive trace.
    """

    inertia: Annotated[Array, "kg m^2"]
    violation: float


def nearest_inertia(inertia: object) -> NearestInertia:
    """Return the nearest inertia that a rigid body can have.

    An inertia I about the center of mass belongs to a body if S = tr(I)/2 - I, the second moments of its mass, is
    positive semidefinite. Eigenvalues of S below 0 become 0, and I' = tr(S') - S' is returned: nearest in the Frobenius
    norm of S. I' - I is positive semidefinite, so that no effective mass becomes less.

    Parameters
    ----------
    inertia : array_like (3, 3)
        Symmetric, in kg m^2.

    Returns
    -------
    NearestInertia
        The inertia, and by how much the given one missed it.

    Raises
    ------
    InvalidParameterError
        If a number is not finite or the matrix is not symmetric.

    Examples
    --------
    >>> from hrsafety import arms
    >>> arms.nearest_inertia([[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.6]]).inertia.diagonal().round(3).tolist()
    [0.3, 0.3, 0.6]
    """
    given = numbers("inertia", inertia)
    if given.shape != (3, 3):
        raise ShapeError("inertia", "(3, 3)", given.shape)
    rows, violation = _hrsafety.nearest_inertia([[finite("inertia", each) for each in row] for row in given.tolist()])
    return NearestInertia(np.array(rows), violation)
